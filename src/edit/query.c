/* What is there to be seen. */
#include "edit/session_internal.h"

#include "base/memory.h"
#include "overlap/exact.h"

#include <math.h>
#include <string.h>

int64_t sl_session_revision(const sl_session *s)
{
    return s->revision;
}

const sl_mesh *sl_session_mesh(const sl_session *s)
{
    return s->mesh;
}

const sl_triangulation *sl_session_triangulation(const sl_session *s)
{
    return s->base->triangulation;
}

const double *sl_session_corner_uv(const sl_session *s)
{
    return s->corner_uv;
}

const int32_t *sl_session_face_chart(const sl_session *s)
{
    return s->face_chart;
}

const uint8_t *sl_session_red(const sl_session *s)
{
    return s->red;
}

const double *sl_session_stretch(const sl_session *s)
{
    return s->stretch;
}

int32_t sl_session_slots(const sl_session *s)
{
    return s->slots;
}

static void find_box(const sl_session *s, int32_t index, double low[2], double high[2])
{
    const sl_edit_chart *chart = s->slot[index].chart;
    for (int k = 0; k < 2; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (int32_t i = 0; i < chart->nface; i++) {
        const int32_t f = chart->face[i];
        for (int64_t h = s->mesh->face_first[f]; h < s->mesh->face_first[f + 1]; h++) {
            for (int k = 0; k < 2; k++) {
                low[k] = fmin(low[k], s->corner_uv[2 * h + k]);
                high[k] = fmax(high[k], s->corner_uv[2 * h + k]);
            }
        }
    }
}

void sl_session_chart_info(const sl_session *s, int32_t index, sl_session_chart *out)
{
    const sl_edit_slot *slot = &s->slot[index];
    const sl_edit_chart *chart = slot->chart;
    *out = (sl_session_chart){.copy_of = -1};
    if (chart == NULL) {
        return;
    }
    *out = (sl_session_chart){.faces = chart->nface,
                              .face = chart->face,
                              .copy_of = slot->copy_of,
                              .mirrored = slot->mirrored,
                              .method = chart->flat.method,
                              .minimised = chart->flat.stretch_minimised,
                              .embedded = chart->flat.certificate.embedded,
                              .red = chart->nred,
                              .distortion = chart->flat.distortion,
                              .iterations = chart->iterations,
                              .scale = slot->scale,
                              .angle = slot->angle};
    memcpy(out->offset, slot->offset, sizeof out->offset);
    for (int32_t i = 0; i < s->wishes->count; i++) {
        out->constraints += s->face_chart[s->mesh->face[s->wishes->wish[i]->corner[0]]] == index;
    }
    find_box(s, index, out->low, out->high);
}

int32_t sl_session_constraints(const sl_session *s)
{
    return s->wishes->count;
}

void sl_session_constraint_at(const sl_session *s, int32_t index, sl_session_constraint *out)
{
    const sl_edit_wish *w = s->wishes->wish[index];
    *out = (sl_session_constraint){.id = w->id,
                                   .kind = w->kind,
                                   .count = w->count,
                                   .corner = w->corner,
                                   .degrees = w->degrees,
                                   .slot = s->face_chart[s->mesh->face[w->corner[0]]]};
    memcpy(out->uv, w->uv, sizeof out->uv);
}

/* The edge between the vertices of two corners of a chart, -1 = none: looked for in the fan of the first. */
static int32_t edge_between(const sl_mesh *mesh, int32_t a, int32_t b)
{
    int32_t g = a;
    while (mesh->twin[g] >= 0) { /* clockwise to the border, or once round */
        g = sl_next(mesh, mesh->twin[g]);
        if (g == a) {
            break;
        }
    }
    const int32_t start = g;
    do {
        if (sl_target(mesh, g) == mesh->origin[b]) {
            return g;
        }
        if (mesh->origin[sl_prev(mesh, g)] == mesh->origin[b]) {
            return sl_prev(mesh, g);
        }
        g = mesh->twin[sl_prev(mesh, g)];
    } while (g >= 0 && g != start);
    return -1;
}

sl_status sl_session_constraint_edges(const sl_session *s, int32_t index, int32_t **halfedge, int32_t *count)
{
    const sl_edit_wish *w = s->wishes->wish[index];
    *count = 0;
    *halfedge = sl_alloc(w->count, sizeof **halfedge);
    if (*halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k + 1 < w->count && w->kind == SL_ACTION_STRAIGHTEN; k++) {
        const int32_t h = edge_between(s->mesh, w->corner[k], w->corner[k + 1]);
        if (h >= 0) {
            (*halfedge)[(*count)++] = h;
        }
    }
    return SL_OK;
}

const int32_t *sl_session_changed(const sl_session *s, int32_t *count)
{
    *count = s->changes;
    return s->changed;
}

int32_t sl_session_notes(const sl_session *s)
{
    return s->notes;
}

const char *sl_session_note(const sl_session *s, int32_t index)
{
    return s->note[index];
}

/* Angle from the edge towards next to the edge towards prev, counter-clockwise, in [0, 2 pi). */
static double corner_angle(const sl_session *s, int32_t h, bool mirrored)
{
    const double *p = s->corner_uv + 2 * (int64_t)h, *a = s->corner_uv + 2 * (int64_t)sl_next(s->mesh, h);
    const double *b = s->corner_uv + 2 * (int64_t)sl_prev(s->mesh, h);
    const double x[2] = {a[0] - p[0], a[1] - p[1]}, y[2] = {b[0] - p[0], b[1] - p[1]};
    const double cross = x[0] * y[1] - x[1] * y[0];
    const double angle = atan2(mirrored ? -cross : cross, x[0] * y[0] + x[1] * y[1]);
    return angle < 0.0 ? angle + 2.0 * acos(-1.0) : angle;
}

double sl_session_planar_angle(const sl_session *s, int32_t halfedge)
{
    const sl_mesh *mesh = s->mesh;
    const bool mirrored = s->slot[s->face_chart[mesh->face[halfedge]]].mirrored;
    double sum = 0.0;
    int32_t g = halfedge;
    do { /* clockwise to the border */
        if (mesh->twin[g] < 0) {
            break;
        }
        g = sl_next(mesh, mesh->twin[g]);
    } while (g != halfedge);
    if (mesh->twin[g] >= 0) {
        return NAN;
    }
    for (; g >= 0; g = mesh->twin[sl_prev(mesh, g)]) {
        sum += corner_angle(s, g, mirrored);
    }
    return sum * (180.0 / acos(-1.0));
}

/* Marks slots whose boxes meet another's; copies are left out. box: 4 a slot. */
static void find_meeting(const sl_session *s, const double *box, uint8_t *meets)
{
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart == NULL || s->slot[i].copy_of >= 0) {
            continue;
        }
        meets[i] |= s->slot[i].chart->nred > 0;
        for (int32_t j = 0; j < i; j++) {
            const double *a = box + 4 * (int64_t)i, *b = box + 4 * (int64_t)j;
            if (s->slot[j].chart != NULL && s->slot[j].copy_of < 0 && a[0] < b[2] && b[0] < a[2] && a[1] < b[3] &&
                b[1] < a[3]) {
                meets[i] = meets[j] = 1;
            }
        }
    }
}

/* Triangles of the slots marked: corners (mesh halfedges) and facets. Returns how many. */
static int32_t gather_triangles(const sl_session *s, const uint8_t *meets, int32_t *tri, int32_t *facet)
{
    const sl_triangulation *t = s->base->triangulation;
    int32_t n = 0;
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        for (int32_t k = t->first[f]; k < t->first[f + 1] && meets[s->face_chart[f]] != 0; k++) {
            memcpy(tri + 3 * (int64_t)n, t->corner + 3 * (int64_t)k, 3 * sizeof *tri);
            facet[n++] = f;
        }
    }
    return n;
}

sl_status sl_session_page_red(const sl_session *s, const sl_context *context, uint8_t *red, int32_t *count)
{
    sl_status status = SL_OK;
    const int32_t nt = s->base->triangulation->nt;
    int32_t *tri = sl_alloc(nt, 3 * sizeof *tri), *facet = sl_alloc(nt, sizeof *facet);
    uint8_t *meets = sl_calloc(s->slots, 1), *found = sl_calloc(nt, 1);
    double *box = sl_alloc(s->slots, 4 * sizeof *box);
    sl_exact_overlap exact = {0};
    SL_TRY(tri != NULL && facet != NULL && meets != NULL && found != NULL && box != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < s->slots; i++) {
        if (s->slot[i].chart != NULL) {
            find_box(s, i, box + 4 * (int64_t)i, box + 4 * (int64_t)i + 2);
        }
    }
    find_meeting(s, box, meets);
    const int32_t n = gather_triangles(s, meets, tri, facet);
    if (n > 0) {
        SL_TRY(sl_overlap_exact(s->corner_uv, n, tri, context, found, &exact));
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        red[f] = 0;
    }
    for (int32_t i = 0; i < n; i++) {
        red[facet[i]] |= found[i];
    }
    for (int32_t i = 0; i < s->slots; i++) { /* copies look like what they show */
        const sl_edit_slot *slot = &s->slot[i];
        for (int32_t k = 0, c = 0; slot->chart != NULL && slot->copy_of >= 0 && k < slot->chart->nface; k++) {
            red[slot->chart->face[k]] = red[s->mesh->face[slot->map->from[c]]];
            c += sl_degree(s->mesh, slot->chart->face[k]);
        }
    }
    *count = 0;
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        *count += red[f];
    }
cleanup:
    sl_free(tri);
    sl_free(facet);
    sl_free(meets);
    sl_free(found);
    sl_free(box);
    return status;
}

static uint64_t mix(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *byte = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    }
    return hash;
}

uint64_t sl_session_hash(const sl_session *s)
{
    const sl_mesh *mesh = s->mesh;
    uint64_t hash = mix(0xcbf29ce484222325u, s->corner_uv, 2 * (size_t)mesh->nh * sizeof *s->corner_uv);
    hash = mix(hash, s->face_chart, (size_t)mesh->nf * sizeof *s->face_chart);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const unsigned char bits = (unsigned char)((mesh->sew[h] >= 0 ? 1 : 0) | (s->scar[h] != 0 ? 2 : 0));
        hash = mix(hash, &bits, 1);
    }
    for (int32_t i = 0; i < s->wishes->count; i++) {
        const sl_edit_wish *w = s->wishes->wish[i];
        const int32_t head[3] = {w->id, (int32_t)w->kind, w->count};
        hash = mix(hash, head, sizeof head);
        hash = mix(hash, w->corner, (size_t)w->count * sizeof *w->corner);
        hash = mix(hash, &w->degrees, sizeof w->degrees);
        hash = mix(hash, w->uv, sizeof w->uv);
    }
    return hash;
}
