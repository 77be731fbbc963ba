#include "mesh/patch.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/corner_table_internal.h"
#include "mesh/edge_groups_internal.h"
#include "mesh/patch_internal.h"

static sl_corner_table table_of(const sl_patch *p)
{
    return (sl_corner_table){.nf = p->nt, .nh = 3 * p->nt, .twin = p->twin};
}

sl_status sl_patch_allocate(int64_t nt, sl_patch **out)
{
    if (nt < 0 || 3 * nt > INT32_MAX) {
        return SL_OUT_OF_MEMORY;
    }
    sl_patch *p = sl_calloc(1, sizeof *p);
    if (p == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    p->nt = (int32_t)nt;
    p->tri = sl_alloc(3 * nt, sizeof *p->tri);
    p->twin = sl_alloc(3 * nt, sizeof *p->twin);
    p->corner = sl_alloc(3 * nt, sizeof *p->corner);
    p->facet = sl_alloc(nt, sizeof *p->facet);
    if (p->tri == NULL || p->twin == NULL || p->corner == NULL || p->facet == NULL) {
        sl_patch_free(p);
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        p->twin[c] = -1;
    }
    *out = p;
    return SL_OK;
}

static sl_status count_topology(sl_patch *p)
{
    const sl_corner_table table = table_of(p);
    uint8_t *seen = sl_calloc(3 * (int64_t)p->nt, sizeof *seen);
    if (seen == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t edges = 0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        edges += p->twin[c] < c; /* borders, and each inner edge once */
    }
    p->loops = sl_table_count_loops(&table, seen);
    p->euler = p->nv - edges + p->nt;
    sl_free(seen);
    return SL_OK;
}

sl_status sl_patch_finish(sl_patch *p, const double *xyz)
{
    const sl_corner_table table = table_of(p);
    int32_t *fan = sl_alloc(3 * (int64_t)p->nt, sizeof *fan);
    if (fan == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    p->nv = sl_table_label_fans(&table, fan);
    p->xyz = sl_alloc(3 * (int64_t)p->nv, sizeof *p->xyz);
    p->outgoing = sl_alloc(p->nv, sizeof *p->outgoing);
    p->border = sl_calloc(p->nv, sizeof *p->border);
    if (p->xyz == NULL || p->outgoing == NULL || p->border == NULL) {
        sl_free(fan);
        return SL_OUT_OF_MEMORY;
    }
    /* Backwards: the first corner has the last word, but for the border halfedge, of which a fan has one at most. */
    for (int32_t c = 3 * p->nt - 1; c >= 0; c--) {
        const int32_t v = fan[c];
        if (p->border[v] == 0) {
            p->outgoing[v] = c;
        }
        p->border[v] |= p->twin[c] < 0;
        for (int k = 0; k < 3; k++) {
            p->xyz[3 * (int64_t)v + k] = xyz[3 * (int64_t)p->tri[c] + k];
        }
    }
    sl_free(p->tri);
    p->tri = fan;
    return count_topology(p);
}

/* Are the triangles' corners three different vertices in range? */
static bool triangles_are_sound(int32_t nv, int32_t nt, const int32_t *tri)
{
    for (int32_t t = 0; t < nt; t++) {
        const int32_t a = tri[3 * t], b = tri[3 * t + 1], c = tri[3 * t + 2];
        if (a < 0 || a >= nv || b < 0 || b >= nv || c < 0 || c >= nv || a == b || b == c || c == a) {
            return false;
        }
    }
    return true;
}

/* Glues the triangles of p along equal edges. */
static sl_status glue(int32_t nv, sl_patch *p)
{
    sl_status status = SL_OK;
    const int32_t n = 3 * p->nt;
    sl_edge_groups groups = {0};
    int32_t *to = sl_alloc(n, sizeof *to);
    SL_TRY(to != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < n; c++) {
        to[c] = p->tri[sl_corner_next(c)];
    }
    SL_TRY(sl_edge_groups_init(nv, n, p->tri, to, &groups));
    sl_edge_cursor cursor = {0};
    sl_edge_group group;
    while (sl_edge_groups_next(&groups, &cursor, &group)) {
        const int32_t x = sl_edge_group_halfedge(&group, 0), y = sl_edge_group_halfedge(&group, group.count - 1);
        if (group.count > 2 || (x != y && p->tri[x] == p->tri[y])) {
            status = SL_BAD_INPUT;
            goto cleanup;
        }
        if (x != y) {
            p->twin[x] = y;
            p->twin[y] = x;
        }
    }
cleanup:
    sl_edge_groups_clear(&groups);
    sl_free(to);
    return status;
}

sl_status sl_patch_from_triangles(int32_t nv, const double *xyz, int32_t nt, const int32_t *tri, sl_patch **out)
{
    sl_status status = SL_OK;
    sl_patch *p = NULL;
    SL_TRY(triangles_are_sound(nv, nt, tri) ? SL_OK : SL_BAD_INPUT);
    SL_TRY(sl_patch_allocate(nt, &p));
    for (int32_t c = 0; c < 3 * nt; c++) {
        p->tri[c] = tri[c];
        p->corner[c] = c;
        p->facet[c / 3] = c / 3;
    }
    SL_TRY(glue(nv, p));
    SL_TRY(sl_patch_finish(p, xyz));
    *out = p;
    p = NULL;
cleanup:
    sl_patch_free(p);
    return status;
}

void sl_patch_free(sl_patch *patch)
{
    if (patch == NULL) {
        return;
    }
    sl_free(patch->xyz);
    sl_free(patch->tri);
    sl_free(patch->twin);
    sl_free(patch->corner);
    sl_free(patch->facet);
    sl_free(patch->outgoing);
    sl_free(patch->border);
    sl_free(patch);
}

double sl_patch_triangle_area(const sl_patch *patch, int32_t t)
{
    const double *p = patch->xyz + 3 * (int64_t)patch->tri[3 * t];
    double a[3], b[3], c[3];
    sl_vec3_sub(patch->xyz + 3 * (int64_t)patch->tri[3 * t + 1], p, a);
    sl_vec3_sub(patch->xyz + 3 * (int64_t)patch->tri[3 * t + 2], p, b);
    sl_vec3_cross(a, b, c);
    return 0.5 * sl_vec3_norm(c);
}

sl_status sl_patch_border(const sl_patch *patch, int32_t **first, int32_t **halfedge)
{
    const sl_corner_table table = table_of(patch);
    int32_t border = 0;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        border += patch->twin[c] < 0;
    }
    uint8_t *seen = sl_calloc(3 * (int64_t)patch->nt, sizeof *seen);
    int32_t *begin = sl_alloc((int64_t)patch->loops + 1, sizeof *begin), *run = sl_alloc(border, sizeof *run);
    if (seen == NULL || begin == NULL || run == NULL) {
        sl_free(seen);
        sl_free(begin);
        sl_free(run);
        return SL_OUT_OF_MEMORY;
    }
    int32_t loops = 0, n = 0;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        if (patch->twin[c] >= 0 || seen[c] != 0) {
            continue;
        }
        begin[loops++] = n;
        for (int32_t b = c; seen[b] == 0; b = sl_table_border_next(&table, b)) {
            seen[b] = 1;
            run[n++] = b;
        }
    }
    begin[loops] = n;
    sl_free(seen);
    *first = begin;
    *halfedge = run;
    return SL_OK;
}

sl_status sl_patch_border_edges(const sl_patch *patch, int32_t *count, int32_t **edge)
{
    int32_t *first = NULL, *halfedge = NULL;
    const sl_status status = sl_patch_border(patch, &first, &halfedge);
    if (status != SL_OK) {
        return status;
    }
    const int32_t n = first[patch->loops];
    int32_t *pairs = sl_alloc(2 * (int64_t)n, sizeof *pairs);
    for (int32_t b = 0; b < n && pairs != NULL; b++) {
        pairs[2 * (int64_t)b] = patch->tri[halfedge[b]];
        pairs[2 * (int64_t)b + 1] = patch->tri[sl_corner_next(halfedge[b])];
    }
    sl_free(first);
    sl_free(halfedge);
    if (pairs == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *count = n;
    *edge = pairs;
    return SL_OK;
}
