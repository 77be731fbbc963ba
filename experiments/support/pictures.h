/* Pictures of an experiment, written as PNG into its folder.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_PICTURES_H
#define SL_EXPERIMENTS_PICTURES_H

#include "render/render.h"
#include "support/run.h"

/* Size and light of a picture; --quick takes fewer lights. */
sl_picture exp_picture(const exp_run *run, int32_t width, int32_t height);

/* Charts in their colours and seams, without UVs. face_chart: nf. */
SL_NODISCARD sl_status exp_draw_charts(exp_run *run, const sl_mesh *mesh, const sl_triangulation *triangulation,
                                       const int32_t *face_chart, const sl_view *view, const sl_picture *picture,
                                       const char *file);

/* Model and atlas side by side. */
SL_NODISCARD sl_status exp_draw_atlas(exp_run *run, const sl_atlas *atlas, const sl_view *view,
                                      const sl_picture *picture, const char *file);

/* A value per facet (NaN = grey), smoothed over the corners, diverging about 0, and edges as black lines over it. */
SL_NODISCARD sl_status exp_draw_values(exp_run *run, const sl_mesh *mesh, const sl_triangulation *triangulation,
                                       const double *facet_value, const int32_t *edge, int32_t edges,
                                       const sl_view *view, const sl_picture *picture, const char *file);

#endif
