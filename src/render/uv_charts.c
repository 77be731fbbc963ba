#include "render/uv_charts.h"
#include "base/memory.h"
#include "render/stage_internal.h"

#include <math.h>

enum { NOT_SEEN = -2 };

static bool has_uv(const sl_mesh *mesh, const double *uv, int32_t f)
{
    bool finite = true;
    for (int64_t i = 2 * (int64_t)mesh->face_first[f]; i < 2 * (int64_t)mesh->face_first[f + 1]; i++) {
        finite = finite && isfinite(uv[i]);
    }
    return finite;
}

/* Gives all facets that hang together with queue[0] its number. */
static void flood(const sl_scene *scene, int32_t number, int32_t *chart, int32_t *queue)
{
    const sl_mesh *mesh = scene->mesh;
    int32_t begin = 0, end = 1;
    chart[queue[0]] = number;
    while (begin < end) {
        const int32_t f = queue[begin++];
        for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
            const int32_t other = sl_opposite(mesh, h);
            if (other >= 0 && chart[mesh->face[other]] == NOT_SEEN && !sl_is_seam(scene, h)) {
                chart[mesh->face[other]] = number;
                queue[end++] = mesh->face[other];
            }
        }
    }
}

sl_status sl_uv_charts(const sl_mesh *mesh, const double *corner_uv, int32_t *chart, int32_t *count)
{
    sl_scene scene = sl_scene_default();
    scene.mesh = mesh;
    scene.corner_uv = corner_uv;
    *count = 0;
    int32_t *queue = sl_alloc(mesh->nf, sizeof *queue);
    if (queue == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        chart[f] = has_uv(mesh, corner_uv, f) ? NOT_SEEN : -1;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (chart[f] == NOT_SEEN) {
            queue[0] = f;
            flood(&scene, (*count)++, chart, queue);
        }
    }
    sl_free(queue);
    return SL_OK;
}
