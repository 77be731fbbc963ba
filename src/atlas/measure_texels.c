/* The texels of an atlas: what is covered, and what more than once. */
#include "atlas/measure_internal.h"

#include "base/memory.h"
#include "overlap/coverage.h"

#include <math.h>

/* Moves the UVs' bounding square to [0, 1]^2. */
static void fit_bounding_square(sl_atlas_view *view)
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int64_t i = 0; i < 3 * (int64_t)view->nt; i++) {
        for (int k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], view->uv[2 * i + k]);
            hi[k] = fmax(hi[k], view->uv[2 * i + k]);
        }
    }
    const double side = fmax(hi[0] - lo[0], hi[1] - lo[1]);
    for (int64_t i = 0; i < 3 * (int64_t)view->nt && side > 0.0; i++) {
        for (int k = 0; k < 2; k++) {
            view->uv[2 * i + k] = (view->uv[2 * i + k] - lo[k]) / side;
        }
    }
}

/* Texel box of a chart, one texel wider than its UVs. */
static void texel_box(const sl_atlas_view *view, int32_t chart, int32_t resolution, int32_t lo[2], int32_t hi[2])
{
    double a[2] = {1.0, 1.0}, b[2] = {0.0, 0.0};
    for (int64_t i = 3 * (int64_t)view->chart_first[chart]; i < 3 * (int64_t)view->chart_first[chart + 1]; i++) {
        for (int k = 0; k < 2; k++) {
            a[k] = fmin(a[k], view->uv[2 * i + k]);
            b[k] = fmax(b[k], view->uv[2 * i + k]);
        }
    }
    for (int k = 0; k < 2; k++) {
        lo[k] = (int32_t)fmax(0.0, floor(a[k] * resolution) - 1.0);
        hi[k] = (int32_t)fmin(resolution - 1.0, ceil(b[k] * resolution) + 1.0);
    }
}

/* What is known of a texel. */
enum { SEEN = 1, INSIDE = 2, ACROSS = 4, SHARED = 8 };

/* The texels as charts are laid on them one after another. */
typedef struct texel_map {
    int32_t side;
    uint8_t *seen;    /* side^2 */
    int32_t *owner;   /* side^2: chart of the table that came first; NULL without a table */
    sl_coverage *own; /* the chart at hand, emptied again over its box */
} texel_map;

static void texel_map_clear(texel_map *map)
{
    sl_free(map->seen);
    sl_free(map->owner);
    sl_coverage_free(map->own);
}

static sl_status texel_map_create(texel_map *map, bool owners)
{
    const int64_t texels = (int64_t)map->side * map->side;
    map->seen = sl_calloc(texels, sizeof *map->seen);
    map->owner = owners ? sl_alloc(texels, sizeof *map->owner) : NULL;
    if (map->seen == NULL || (owners && map->owner == NULL)) {
        return SL_OUT_OF_MEMORY;
    }
    return sl_coverage_create(map->side, map->side, &map->own);
}

/* The chart of the table that a chart found belongs to, and what that copies; both -1 without a table. */
static void table_entry(const sl_atlas_view *view, const int32_t *first_face, int32_t chart, int32_t *label,
                        int32_t *source)
{
    *label = view->table != NULL ? view->table->face_chart[first_face[chart]] : -1;
    *source = *label >= 0 ? view->table->copy_of[*label] : -1;
}

/* Adds the chart just drawn into map->own. label, source: see table_entry. */
static void add_chart(const sl_atlas_view *view, int32_t chart, int32_t label, int32_t source, texel_map *map)
{
    int32_t lo[2], hi[2];
    texel_box(view, chart, map->side, lo, hi);
    for (int32_t y = lo[1]; y <= hi[1]; y++) {
        for (int32_t x = lo[0]; x <= hi[0]; x++) {
            const int64_t i = (int64_t)y * map->side + x;
            if (map->own->count[i] == 0) {
                continue;
            }
            const bool met = map->seen[i] != 0, meant = met && source >= 0 && map->owner[i] == source;
            if (map->owner != NULL && !met) {
                map->owner[i] = label;
            }
            map->seen[i] |= (uint8_t)((map->own->count[i] > 1 ? INSIDE : 0) | (met && !meant ? ACROSS : 0) |
                                      (meant ? SHARED : 0) | SEEN);
            map->own->count[i] = 0;
        }
    }
}

static void sum_texels(const texel_map *map, sl_atlas_measure *out)
{
    int64_t covered = 0, inside = 0, across = 0, shared = 0;
    const int64_t n = (int64_t)map->side * map->side;
    for (int64_t i = 0; i < n; i++) {
        covered += (map->seen[i] & SEEN) != 0;
        inside += (map->seen[i] & INSIDE) != 0;
        across += (map->seen[i] & ACROSS) != 0;
        shared += (map->seen[i] & SHARED) != 0;
    }
    out->fill = (double)covered / (double)n;
    out->overlap_inside = covered > 0 ? (double)inside / (double)covered : 0.0;
    out->overlap_across = covered > 0 ? (double)across / (double)covered : 0.0;
    out->shared = covered > 0 ? (double)shared / (double)covered : 0.0;
}

/* The first facet of each chart; owned by the caller. */
static int32_t *first_faces(const sl_atlas_view *view)
{
    int32_t *first = sl_alloc(view->charts, sizeof *first);
    for (int32_t f = view->polygons->nf - 1; first != NULL && f >= 0; f--) {
        first[view->face_chart[f]] = f;
    }
    return first;
}

sl_status sl_atlas_view_texels(sl_atlas_view *view, const sl_context *context, sl_atlas_measure *out)
{
    texel_map map = {.side = out->resolution};
    int32_t largest = 0, *tri = NULL, *first_face = first_faces(view);
    sl_status status = SL_OUT_OF_MEMORY;
    fit_bounding_square(view);
    for (int32_t c = 0; c < view->charts; c++) {
        const int32_t count = view->chart_first[c + 1] - view->chart_first[c];
        largest = count > largest ? count : largest;
    }
    tri = sl_alloc(3 * (int64_t)largest, sizeof *tri);
    if (first_face == NULL || tri == NULL) {
        goto cleanup;
    }
    for (int32_t i = 0; i < 3 * largest; i++) {
        tri[i] = i;
    }
    SL_TRY(texel_map_create(&map, view->table != NULL));
    for (int copies = 0; copies < 2; copies++) {
        for (int32_t c = 0; c < view->charts; c++) {
            int32_t label, source;
            table_entry(view, first_face, c, &label, &source);
            if ((source >= 0) == (copies == 1)) {
                SL_TRY(sl_coverage_add(map.own, view->uv + 6 * (int64_t)view->chart_first[c],
                                       view->chart_first[c + 1] - view->chart_first[c], tri, context));
                add_chart(view, c, label, source, &map);
                out->copies += copies;
            }
        }
    }
    sum_texels(&map, out);
cleanup:
    texel_map_clear(&map);
    sl_free(first_face);
    sl_free(tri);
    return status;
}
