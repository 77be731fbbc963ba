/* From a scene's arrays to what the shading pass reads. */
#include "base/memory.h"
#include "image/color.h"
#include "render/chart_colors.h"
#include "render/normals.h"
#include "render/stage_internal.h"

#include <math.h>
#include <string.h>

/* Coarse meshes are modelled: they have creases. Dense ones are mostly scans, whose noise must not be taken for
 * creases, and their facets are so small that a real edge stays sharp without being split. */
static const double coarse_crease = 40.0, dense_crease = 75.0; /* degrees */
static const double coarse_facets = 4000.0, dense_facets = 60000.0;
static const double same_uv = 1e-9; /* closer UVs are one */

/* Corners without UVs are alike: what has none is not all seams. */
static bool uv_equal(const double *a, const double *b)
{
    const bool none_a = isnan(a[0]) || isnan(a[1]), none_b = isnan(b[0]) || isnan(b[1]);
    if (none_a || none_b) {
        return none_a && none_b;
    }
    return fabs(a[0] - b[0]) <= same_uv && fabs(a[1] - b[1]) <= same_uv;
}

bool sl_is_seam(const sl_scene *s, int32_t h)
{
    const sl_mesh *m = s->mesh;
    const int32_t other = sl_opposite(m, h);
    if (other < 0) {
        return false;
    }
    if (m->sew[h] >= 0 || (s->chart != NULL && s->chart[m->face[h]] != s->chart[m->face[other]])) {
        return true;
    }
    if (s->corner_uv == NULL) {
        return false;
    }
    const double *uv = s->corner_uv;
    return !uv_equal(uv + 2 * (int64_t)h, uv + 2 * (int64_t)sl_next(m, other)) ||
           !uv_equal(uv + 2 * (int64_t)sl_next(m, h), uv + 2 * (int64_t)other);
}

static sl_status collect_seams(const sl_scene *s, sl_dressing *d)
{
    int64_t capacity = 0;
    for (int32_t h = 0; h < s->mesh->nh && s->seams; h++) {
        if (h < sl_opposite(s->mesh, h) && sl_is_seam(s, h)) {
            const sl_status status = sl_reserve((void **)&d->seam, &capacity, d->seams + 1, sizeof *d->seam);
            if (status != SL_OK) {
                return status;
            }
            d->seam[d->seams++] = h;
        }
    }
    return SL_OK;
}

static sl_status index_triangles(const sl_scene *s, sl_dressing *d)
{
    const sl_triangulation *tri = s->triangulation;
    d->nt = tri->nt;
    d->triangle_vertex = sl_alloc(tri->nt, 3 * sizeof *d->triangle_vertex);
    d->triangle_facet = sl_alloc(tri->nt, sizeof *d->triangle_facet);
    if (d->triangle_vertex == NULL || d->triangle_facet == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        for (int32_t t = tri->first[f]; t < tri->first[f + 1]; t++) {
            d->triangle_facet[t] = f;
            for (int64_t k = 3 * (int64_t)t; k < 3 * (int64_t)t + 3; k++) {
                d->triangle_vertex[k] = s->mesh->origin[tri->corner[k]];
            }
        }
    }
    return SL_OK;
}

/* The light that each byte of a picture stands for. */
static void byte_table(float linear[256])
{
    for (int i = 0; i < 256; i++) {
        linear[i] = (float)sl_srgb_to_linear(i / 255.0);
    }
}

static sl_status color_facets(const sl_scene *s, sl_dressing *d)
{
    if (s->facet_rgb == NULL && s->chart == NULL) {
        return SL_OK;
    }
    sl_status status = SL_OK;
    const uint8_t *from = s->facet_rgb;
    uint8_t *made = NULL;
    if (from == NULL) {
        made = sl_alloc(s->mesh->nf, 3);
        if (made == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        SL_TRY(sl_chart_colors(s->mesh, s->chart, made));
        from = made;
    }
    d->facet_rgb = sl_alloc(s->mesh->nf, 3 * sizeof *d->facet_rgb);
    if (d->facet_rgb == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    float linear[256];
    byte_table(linear);
    for (int64_t i = 0; i < 3 * (int64_t)s->mesh->nf; i++) {
        d->facet_rgb[i] = linear[from[i]];
    }
cleanup:
    sl_free(made);
    return status;
}

static void set_range(const sl_scene *s, sl_dressing *d)
{
    d->value_lo = s->value_lo;
    d->value_hi = s->value_hi;
    if (s->value_lo < s->value_hi) {
        return;
    }
    double lo = INFINITY, hi = -INFINITY;
    for (int32_t h = 0; h < s->mesh->nh; h++) {
        if (isfinite(d->value[h])) {
            lo = fmin(lo, d->value[h]);
            hi = fmax(hi, d->value[h]);
        }
    }
    if (s->map == SL_COLORMAP_DIVERGING) {
        hi = fmax(fabs(lo), fabs(hi));
        lo = -hi;
    }
    const bool usable = lo < hi && isfinite(hi - lo);
    d->value_lo = usable ? lo : isfinite(lo) ? lo - 0.5 : 0.0;
    d->value_hi = usable ? hi : isfinite(lo) ? lo + 0.5 : 1.0;
}

static sl_status set_values(const sl_scene *s, sl_dressing *d)
{
    if (s->corner_value == NULL && s->facet_value == NULL) {
        return SL_OK;
    }
    d->value = sl_alloc(s->mesh->nh, sizeof *d->value);
    if (d->value == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < s->mesh->nh; h++) {
        d->value[h] = s->corner_value != NULL ? s->corner_value[h] : s->facet_value[s->mesh->face[h]];
    }
    set_range(s, d);
    sl_colormap_table(s->map, SL_MAP_COLORS, d->map_rgb);
    return SL_OK;
}

static sl_status make_texture(const sl_scene *s, sl_dressing *d)
{
    float linear[256];
    if (s->texture == NULL || s->corner_uv == NULL) {
        return SL_OK;
    }
    byte_table(linear);
    return sl_texture_create(s->texture->width, s->texture->height, s->texture->channels, s->texture->pixels, linear,
                             &d->texture);
}

static double crease_degrees(int32_t facets)
{
    const double t = fmin(log(fmax(facets / coarse_facets, 1.0)) / log(dense_facets / coarse_facets), 1.0);
    return coarse_crease + t * (dense_crease - coarse_crease);
}

sl_status sl_dress(const sl_scene *scene, bool smooth, sl_dressing *dressing)
{
    sl_status status = SL_OK;
    *dressing = (sl_dressing){0};
    SL_TRY(index_triangles(scene, dressing));
    SL_TRY(color_facets(scene, dressing));
    SL_TRY(set_values(scene, dressing));
    SL_TRY(make_texture(scene, dressing));
    SL_TRY(collect_seams(scene, dressing));
    if (smooth) {
        dressing->normal = sl_alloc(scene->mesh->nh, 3 * sizeof *dressing->normal);
        if (dressing->normal == NULL) {
            status = SL_OUT_OF_MEMORY;
            goto cleanup;
        }
        SL_TRY(sl_corner_normals(scene->mesh, crease_degrees(scene->mesh->nf), dressing->normal));
    }
cleanup:
    if (status != SL_OK) {
        sl_undress(dressing);
    }
    return status;
}

void sl_undress(sl_dressing *d)
{
    sl_free(d->triangle_vertex);
    sl_free(d->triangle_facet);
    sl_free(d->normal);
    sl_free(d->facet_rgb);
    sl_texture_free(d->texture);
    sl_free(d->value);
    sl_free(d->seam);
    *d = (sl_dressing){0};
}

sl_material sl_dressed_material(const sl_scene *scene, const sl_dressing *d)
{
    sl_material m = sl_material_default();
    m.corner = scene->triangulation->corner;
    m.facet = d->triangle_facet;
    m.normal = d->normal;
    m.facet_rgb = d->facet_rgb;
    m.value = d->value;
    m.value_lo = d->value_lo;
    m.value_hi = d->value_hi;
    m.map_rgb = d->map_rgb;
    m.map_count = SL_MAP_COLORS;
    m.contour = scene->zero_line && scene->corner_value != NULL ? 0.0 : (double)NAN;
    m.uv = scene->checker || d->texture != NULL ? scene->corner_uv : NULL;
    m.checks = scene->checker ? scene->checks : 0.0;
    m.texture = d->texture;
    m.tiles = scene->tiles;
    m.flag = scene->facet_flag;
    return m;
}
