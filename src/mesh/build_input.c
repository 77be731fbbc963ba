#include <math.h>

#include "base/memory.h"
#include "mesh/build_internal.h"

static sl_status bad(sl_diag *diag, int64_t element)
{
    if (diag != NULL) {
        diag->element = element;
    }
    return SL_BAD_INPUT;
}

static sl_status check_faces(const sl_polygons *in, sl_diag *diag)
{
    for (int32_t f = 0; f < in->nf; f++) {
        const int32_t first = in->face_first[f], end = in->face_first[f + 1];
        if (end < first || (int64_t)end - first < 3) {
            sl_diag_reason(diag, "facet %d has fewer than 3 corners", f);
            sl_diag_hint(diag, "remove it, or export the mesh without loose edges");
            return bad(diag, f);
        }
        for (int32_t c = first; c < end; c++) {
            if (in->index[c] < 0 || in->index[c] >= in->nv) {
                sl_diag_reason(diag, "facet %d names vertex %d, but there are %d vertices", f, in->index[c], in->nv);
                sl_diag_hint(diag, "vertices are counted from 0 here");
                return bad(diag, f);
            }
        }
    }
    return SL_OK;
}

sl_status sl_build_check(const sl_polygons *in, sl_diag *diag)
{
    if (in->nf < 1 || in->nv < 0) {
        sl_diag_reason(diag, "the mesh has no facet");
        sl_diag_hint(diag, "only polygons can be unwrapped: points and curves are not enough");
        return bad(diag, -1);
    }
    if (in->face_first[0] != 0) {
        sl_diag_reason(diag, "the first facet starts at corner %d, not 0", in->face_first[0]);
        return bad(diag, 0);
    }
    for (int64_t i = 0; i < 3 * (int64_t)in->nv; i++) {
        if (!isfinite(in->xyz[i])) {
            sl_diag_reason(diag, "coordinate %c of vertex %d is not a finite number", "xyz"[i % 3], (int)(i / 3));
            sl_diag_hint(diag, "the program that wrote the mesh divided by zero, or a number has too many digits");
            return bad(diag, i / 3);
        }
    }
    return check_faces(in, diag);
}

/* Half of the largest extent and the centre; halves, because hi - lo may overflow. */
static double bounding_box(const sl_polygons *in, const uint8_t *used, double centre[3], double half[3])
{
    double lo[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, largest = 0.0;
    for (int64_t i = 0; i < 3 * (int64_t)in->nv; i++) {
        if (used[i / 3] != 0) {
            lo[i % 3] = fmin(lo[i % 3], in->xyz[i]);
            hi[i % 3] = fmax(hi[i % 3], in->xyz[i]);
        }
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = 0.5 * lo[k] + 0.5 * hi[k];
        half[k] = 0.5 * hi[k] - 0.5 * lo[k];
        largest = fmax(largest, half[k]);
    }
    return largest;
}

/* The power of two that brings an extent of 2 half into (1/2, 1]; the largest finite one for extents below 2^-1023. */
static double power_of_two(double half)
{
    if (half == 0.0) {
        return 1.0;
    }
    int e;
    const double mantissa = frexp(half, &e); /* half = mantissa 2^e, mantissa in [1/2, 1) */
    if (mantissa == 0.5) {
        e--;
    }
    return ldexp(1.0, -e - 1 < 1023 ? -e - 1 : 1023);
}

sl_status sl_build_normalise(sl_builder *b)
{
    const sl_polygons *in = b->input;
    sl_mesh *m = b->mesh;
    uint8_t *used = sl_calloc(in->nv, sizeof *used);
    if (used == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        used[m->origin[h]] = 1;
    }
    double half[3];
    m->scale = power_of_two(bounding_box(in, used, m->centre, half));
    for (int64_t i = 0; i < 3 * (int64_t)in->nv; i++) {
        /* A vertex of no facet may lie anywhere: it must not shrink the mesh, nor overflow here. */
        const double x = in->xyz[i] * 0.5 - m->centre[i % 3] * 0.5, h = 0.5 * half[i % 3];
        const double d = used[i / 3] != 0 ? in->xyz[i] - m->centre[i % 3] : 2.0 * fmin(fmax(x, -h), h);
        m->xyz[i] = d * m->scale;
    }
    b->report->vertices = in->nv;
    b->report->faces = in->nf;
    for (int32_t v = 0; v < in->nv; v++) {
        b->report->unused_vertices += used[v] == 0;
    }
    sl_free(used);
    return SL_OK;
}
