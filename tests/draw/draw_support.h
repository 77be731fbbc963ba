/* Scenes for the tests of this folder. */
#ifndef SL_TEST_DRAW_SUPPORT_H
#define SL_TEST_DRAW_SUPPORT_H

#include "support/test_support.h"

#include "base/memory.h"
#include "draw/visibility.h"

#include <math.h>

/* A whole picture's buffer; free with sl_free. */
static inline uint64_t *draw_all(const sl_screen *screen)
{
    uint64_t *zid = sl_alloc((int64_t)screen->width * screen->height, sizeof *zid);
    assert_non_null(zid);
    sl_visibility window = {0, 0, screen->width, screen->height, zid};
    sl_visibility_draw(screen, &window);
    return zid;
}

/* Triangles of three own vertices each, corners uniform in the box [-1, 1]^3 scaled by `size` around random centres. */
static inline void random_soup(test_rng *rng, int32_t nt, double size, double *xyz, int32_t *tri)
{
    for (int32_t t = 0; t < nt; t++) {
        double centre[3];
        for (int k = 0; k < 3; k++) {
            centre[k] = test_uniform(rng, -1.0, 1.0);
        }
        for (int k = 0; k < 9; k++) {
            xyz[9 * t + k] = centre[k % 3] + size * test_uniform(rng, -1.0, 1.0);
        }
        for (int k = 0; k < 3; k++) {
            tri[3 * t + k] = 3 * t + k;
        }
    }
}

static inline sl_camera random_camera(test_rng *rng, int32_t count, const double *xyz, double aspect)
{
    sl_view view = sl_view_default();
    view.azimuth = test_uniform(rng, 0.0, 360.0);
    view.elevation = test_uniform(rng, -80.0, 80.0);
    view.fov = test_index(rng, 3) == 0 ? 0.0 : test_uniform(rng, 10.0, 90.0);
    sl_camera camera;
    assert_int_equal(sl_camera_frame(&view, aspect, count, NULL, xyz, &camera), SL_OK);
    return camera;
}

#endif
