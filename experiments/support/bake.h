/* A texture painted through a session's UVs, texel by texel, and the model wearing it.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_BAKE_H
#define SL_EXPERIMENTS_BAKE_H

#include "support/run.h"

/* The colour of a point: its facet, its page UV, its place in the normalised mesh. */
typedef void exp_paint_fn(void *user, int32_t facet, const double uv[2], const double xyz[3], uint8_t rgb[3]);

/* size x size texels, row 0 at v = 1. Facets of copies are not painted: they show what is painted on others. Every
 * triangle is painted a texel beyond its edges. *out owned by the caller. */
SL_NODISCARD sl_status exp_bake(const sl_session *session, int32_t size, exp_paint_fn *paint, void *user,
                                sl_image **out);

/* Model and atlas with the texture. */
SL_NODISCARD sl_status exp_draw_textured(exp_run *run, const sl_session *session, const sl_image *texture,
                                         const sl_view *view, const sl_picture *picture, const char *file);

#endif
