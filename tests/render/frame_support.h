/* A frame to try things on. */
#ifndef SL_TESTS_FRAME_SUPPORT_H
#define SL_TESTS_FRAME_SUPPORT_H

#include "render/render_support.h"

#include "render/frame.h"

enum { SIDE = 150 };

/* A frame of the torus with colours and UVs. */
typedef struct torus_frame {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    int32_t *tri;
    double *uv;
    uint8_t *rgb;
    sl_frame *frame;
    sl_camera camera;
} torus_frame;

static inline torus_frame open_torus(double azimuth)
{
    torus_frame t = {.mesh = torus(40, 23)};
    assert_int_equal(sl_triangulation_create(t.mesh, &t.triangulation), SL_OK);
    const int32_t nt = t.triangulation->nt;
    t.tri = sl_alloc(nt, 3 * sizeof *t.tri);
    t.uv = sl_alloc(nt, 6 * sizeof *t.uv);
    t.rgb = sl_alloc(nt, 3);
    for (int32_t i = 0; i < 3 * nt; i++) {
        const double *p = t.mesh->xyz + 3 * t.mesh->origin[t.triangulation->corner[i]];
        t.tri[i] = t.mesh->origin[t.triangulation->corner[i]];
        t.uv[2 * i] = 0.4 * p[0] + 0.3 * p[1];
        t.uv[2 * i + 1] = 0.5 * p[2] - 0.2 * p[1];
        t.rgb[i] = (uint8_t)(90 + 37 * i % 130);
    }
    const sl_frame_def def = {t.mesh->nv, nt, t.mesh->xyz, t.tri, t.uv, t.rgb};
    assert_int_equal(sl_frame_create(&def, &t.frame), SL_OK);
    sl_view view = sl_view_default();
    view.azimuth = azimuth;
    assert_int_equal(sl_camera_frame(&view, 1.3, t.mesh->nv, NULL, t.mesh->xyz, &t.camera), SL_OK);
    return t;
}

static inline void close_torus(torus_frame *t)
{
    sl_frame_free(t->frame);
    sl_free(t->tri);
    sl_free(t->uv);
    sl_free(t->rgb);
    sl_triangulation_free(t->triangulation);
    sl_mesh_free(t->mesh);
}

#endif
