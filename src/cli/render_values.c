/* seamlab render: the numbers and colours it lays over the facets. */
#include "base/memory.h"
#include "cli/render_scene.h"
#include "geom/vec3.h"
#include "mesh/facet_graph.h"
#include "mesh/topology.h"
#include "seamcost/seamcost.h"
#include "spectral/spectrum.h"
#include "symmetry/symmetry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double most_stretch = 1e6;       /* of a triangle that has collapsed */
static const double shown_share = 0.98;       /* of the facets lie inside the scale */
static const double least_range = 1.2;        /* an isometric map is not blown up to the whole scale */
static const double triangulated_quads = 0.9; /* share of pairs from which on `--pair auto` pairs */
static const uint8_t side_rgb[3][3] = {{120, 164, 206}, {232, 178, 108}, {196, 196, 194}};
static const uint8_t axis_rgb[3] = {176, 24, 92};
static const double axis_width = 3.0; /* pixels */

/* Legs of a triangle in its own plane: the first along x. False without area. */
static bool flat_legs(const sl_mesh *m, const int32_t *corner, double *length, double *along, double *height)
{
    double a[3], b[3];
    const double *p = m->xyz + 3 * (int64_t)m->origin[corner[0]];
    sl_vec3_sub(m->xyz + 3 * (int64_t)m->origin[corner[1]], p, a);
    sl_vec3_sub(m->xyz + 3 * (int64_t)m->origin[corner[2]], p, b);
    *length = sl_vec3_norm(a);
    *along = *length > 0.0 ? sl_vec3_dot(a, b) / *length : 0.0;
    *height = sqrt(fmax(sl_vec3_dot(b, b) - *along * *along, 0.0));
    return *length > 0.0 && *height > 1e-9 * *length;
}

/* Area in space, area in UV and, with the map scaled by `scale`, max(s1, 1/s2) of one triangle. */
static double triangle_stretch(const cli_scene *s, int32_t t, double scale, double *area, double *uv_area)
{
    const int32_t *corner = s->triangulation->corner + 3 * (int64_t)t;
    const double *u0 = s->corner_uv + 2 * (int64_t)corner[0], *u1 = s->corner_uv + 2 * (int64_t)corner[1],
                 *u2 = s->corner_uv + 2 * (int64_t)corner[2];
    double length, along, height;
    const bool usable = flat_legs(s->mesh, corner, &length, &along, &height);
    *area = usable ? 0.5 * length * height : 0.0;
    const double a[2] = {u1[0] - u0[0], u1[1] - u0[1]}, b[2] = {u2[0] - u0[0], u2[1] - u0[1]};
    *uv_area = 0.5 * fabs(a[0] * b[1] - a[1] * b[0]);
    if (!usable || !isfinite(*uv_area)) {
        *area = *uv_area = 0.0;
        return (double)NAN;
    }
    double sum = 0.0, x[2], y[2];
    for (int k = 0; k < 2; k++) {
        x[k] = scale * a[k] / length;
        y[k] = (scale * b[k] - x[k] * along) / height;
        sum += x[k] * x[k] + y[k] * y[k];
    }
    const double det = fabs(x[0] * y[1] - x[1] * y[0]);
    const double root = sqrt(fmax(sum * sum - 4.0 * det * det, 0.0));
    const double s1 = sqrt(0.5 * (sum + root)), s2 = s1 > 0.0 ? det / s1 : 0.0;
    return fmin(fmax(s1, s2 > 0.0 ? 1.0 / s2 : most_stretch), most_stretch);
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The value that the given share of the finite values lies below. */
static sl_status quantile(const double *value, int32_t n, double share, double *out)
{
    double *sorted = sl_alloc(n, sizeof *sorted);
    int32_t count = 0;
    if (sorted == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < n; i++) {
        if (isfinite(value[i])) {
            sorted[count++] = value[i];
        }
    }
    qsort(sorted, (size_t)count, sizeof *sorted, compare_doubles);
    *out = count > 0 ? sorted[(int32_t)(share * (count - 1))] : 1.0;
    sl_free(sorted);
    return SL_OK;
}

sl_status cli_show_stretch(cli_scene *s)
{
    const sl_triangulation *tri = s->triangulation;
    double area = 0.0, uv_area = 0.0, high = 1.0, a, u;
    s->facet_value = sl_alloc(s->mesh->nf, sizeof *s->facet_value);
    if (s->facet_value == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t < tri->nt; t++) {
        (void)triangle_stretch(s, t, 1.0, &a, &u);
        area += a;
        uv_area += u;
    }
    const double scale = uv_area > 0.0 ? sqrt(area / uv_area) : 1.0;
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        double sum = 0.0, weight = 0.0;
        for (int32_t t = tri->first[f]; t < tri->first[f + 1]; t++) {
            const double stretch = triangle_stretch(s, t, scale, &a, &u);
            sum += a > 0.0 ? a * stretch : 0.0;
            weight += a;
        }
        s->facet_value[f] = weight > 0.0 ? sum / weight : (double)NAN;
    }
    const sl_status status = quantile(s->facet_value, s->mesh->nf, shown_share, &high);
    s->scene.facet_value = s->facet_value;
    s->scene.map = SL_COLORMAP_HEAT;
    s->scene.value_lo = 1.0;
    s->scene.value_hi = fmax(high, least_range);
    s->value_name = "stretch max(s1, 1/s2)";
    return status;
}

static const double paired_enough = 0.9; /* share of triangles in pairs from which a mesh counts as quads */

/* Values in [0, 1] for the facets to come. */
static sl_status begin_shares(cli_scene *s, const char *name)
{
    s->facet_value = sl_alloc(s->mesh->nf, sizeof *s->facet_value);
    s->scene.facet_value = s->facet_value;
    s->scene.map = SL_COLORMAP_SEQUENTIAL;
    s->scene.value_lo = 0.0;
    s->scene.value_hi = 1.0;
    s->value_name = name;
    return s->facet_value != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status cli_show_visibility(cli_run *run, cli_scene *s)
{
    const sl_ambient_def def = sl_ambient_default();
    const sl_status status = begin_shares(s, "ambient visibility");
    return status == SL_OK ? sl_ambient_compute(s->mesh, &def, &run->context, s->facet_value) : status;
}

/* The mean weight of a facet's edges. */
sl_status cli_show_seam_cost(cli_run *run, cli_scene *s)
{
    sl_status status = SL_OK;
    double fraction;
    const sl_mesh *m = s->mesh;
    sl_seam_cost_def def = sl_seam_cost_default();
    double *weight = sl_alloc(m->nh, sizeof *weight);
    int32_t *partner = sl_alloc(m->nf, sizeof *partner);
    SL_TRY(weight != NULL && partner != NULL ? begin_shares(s, "what a seam costs, over its length")
                                             : SL_OUT_OF_MEMORY);
    SL_TRY(sl_pair_triangles(m, partner, &fraction));
    def.partner = fraction >= paired_enough ? partner : NULL;
    SL_TRY(sl_seam_cost_compute(m, &def, &run->context, weight));
    for (int32_t f = 0; f < m->nf; f++) {
        double sum = 0.0;
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            sum += weight[h];
        }
        s->facet_value[f] = sum / sl_degree(m, f);
    }
cleanup:
    sl_free(weight);
    sl_free(partner);
    return status;
}

/* Facets of the component with the most of them, ascending. face: nf. */
static sl_status largest_component(const sl_mesh *mesh, int32_t *face, int32_t *count)
{
    int32_t components = 0, best = 0;
    sl_status status = SL_OK;
    int32_t *label = sl_alloc(mesh->nf, sizeof *label), *size = sl_calloc(mesh->nf, sizeof *size);
    *count = 0;
    SL_TRY(label != NULL && size != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_mesh_components(mesh, label, &components));
    for (int32_t f = 0; f < mesh->nf; f++) {
        size[label[f]]++;
    }
    for (int32_t c = 1; c < components; c++) {
        best = size[c] > size[best] ? c : best;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (label[f] == best) {
            face[(*count)++] = f;
        }
    }
cleanup:
    sl_free(label);
    sl_free(size);
    return status;
}

/* Values of facets as values of corners: the mean over the facets around the vertex. facet_value: NaN = none. */
static sl_status spread(cli_scene *s, const double *facet_value)
{
    const sl_mesh *m = s->mesh;
    double *sum = sl_calloc(m->nv, sizeof *sum);
    int32_t *count = sl_calloc(m->nv, sizeof *count);
    s->corner_value = sl_alloc(m->nh, sizeof *s->corner_value);
    const bool room = sum != NULL && count != NULL && s->corner_value != NULL;
    for (int32_t h = 0; room && h < m->nh; h++) {
        if (isfinite(facet_value[m->face[h]])) {
            sum[m->origin[h]] += facet_value[m->face[h]];
            count[m->origin[h]]++;
        }
    }
    for (int32_t h = 0; room && h < m->nh; h++) {
        const int32_t v = m->origin[h];
        s->corner_value[h] = isfinite(facet_value[m->face[h]]) ? sum[v] / count[v] : (double)NAN;
    }
    sl_free(sum);
    sl_free(count);
    s->scene.corner_value = s->corner_value;
    return room ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status cli_show_eigenvector(cli_run *run, cli_scene *s, int32_t k, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t count = 0;
    sl_facet_graph *graph = NULL;
    sl_spectrum *spectrum = NULL;
    double *value = NULL;
    int32_t *face = sl_alloc(s->mesh->nf, sizeof *face);
    SL_TRY(face != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(largest_component(s->mesh, face, &count));
    SL_TRY(sl_facet_graph_create(s->mesh, face, count, NULL, &graph));
    SL_TRY(sl_spectrum_compute(graph, k + 1, &run->context, &spectrum));
    if (k >= spectrum->count) {
        sl_diag_reason(diag, "there is no eigenvector %d: the largest component has %d facets", k, count);
        SL_TRY(SL_BAD_INPUT);
    }
    value = sl_alloc(s->mesh->nf, sizeof *value);
    SL_TRY(value != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        value[f] = (double)NAN;
    }
    for (int32_t i = 0; i < count; i++) {
        value[face[i]] = spectrum->vectors[(int64_t)k * spectrum->n + graph->node[i]];
    }
    SL_TRY(spread(s, value));
    s->scene.map = SL_COLORMAP_DIVERGING;
    s->scene.zero_line = true;
    snprintf(s->name, sizeof s->name, "eigenvector %d, lambda %.4g", k, spectrum->lambda[k]);
    s->value_name = s->name;
cleanup:
    sl_spectrum_free(spectrum);
    sl_facet_graph_free(graph);
    sl_free(face);
    sl_free(value);
    return status;
}

/* Sides and axis of one component's mirror. side: nf, scratch. */
static sl_status paint_mirror(cli_scene *s, const sl_symmetry *symmetry, const sl_symmetry_map *map, uint8_t *side)
{
    const sl_status status = sl_symmetry_sides(s->mesh, symmetry, map, side);
    for (int32_t f = 0; status == SL_OK && f < s->mesh->nf; f++) {
        if (side[f] < 2) {
            memcpy(s->facet_rgb + 3 * (int64_t)f, side_rgb[side[f]], 3);
        }
    }
    for (int32_t h = 0; status == SL_OK && h < s->mesh->nh; h++) {
        if (side[s->mesh->face[h]] < 2 && h < sl_opposite(s->mesh, h) &&
            sl_symmetry_on_axis(s->mesh, symmetry, map, h)) {
            s->axis[s->axes++] = h;
        }
    }
    return status;
}

/* Where the connectivity has no mirror: the sides of the plane that nearly is one. */
static sl_status paint_near(cli_run *run, cli_scene *s, bool *found)
{
    const sl_mesh *m = s->mesh;
    sl_near_mirror mirror;
    const sl_symmetry_def def = sl_symmetry_default();
    const sl_status status = sl_symmetry_near(m, &def, &run->context, NULL, &mirror);
    *found = status == SL_OK && mirror.found;
    for (int32_t f = 0; *found && f < m->nf; f++) {
        double height = 0.0;
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            height += sl_vec3_dot(mirror.normal, m->xyz + 3 * (int64_t)m->origin[h]) - mirror.offset;
        }
        memcpy(s->facet_rgb + 3 * (int64_t)f, side_rgb[height > 0.0], 3);
    }
    return status;
}

/* The first mirror of each component that has one. */
static sl_status paint_mirrors(cli_scene *s, const sl_symmetry *symmetry, uint8_t *side, bool *found)
{
    int32_t done = -1;
    for (int32_t i = 0; i < symmetry->nmap; i++) {
        const sl_symmetry_map *map = &symmetry->map[i];
        if (map->from != map->to || map->from == done || !map->reverses || !map->separates ||
            map->kind == SL_SYMMETRY_TOPOLOGICAL) {
            continue;
        }
        const sl_status status = paint_mirror(s, symmetry, map, side);
        if (status != SL_OK) {
            return status;
        }
        done = map->from;
        *found = true;
    }
    return SL_OK;
}

sl_status cli_show_symmetry(cli_run *run, cli_scene *s)
{
    sl_status status = SL_OK;
    sl_symmetry_def def = sl_symmetry_default();
    sl_symmetry *symmetry = NULL;
    double paired = 0.0;
    bool found = false;
    int32_t *partner = sl_alloc(s->mesh->nf, sizeof *partner);
    uint8_t *side = sl_alloc(s->mesh->nf, 1);
    s->axis = sl_alloc(s->mesh->nh, sizeof *s->axis);
    s->facet_rgb = sl_alloc(s->mesh->nf, 3);
    if (partner == NULL || side == NULL || s->axis == NULL || s->facet_rgb == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        memcpy(s->facet_rgb + 3 * (int64_t)f, side_rgb[2], 3);
    }
    def.mirrors_only = true;
    def.of_copies = true;
    SL_TRY(sl_pair_triangles(s->mesh, partner, &paired));
    SL_TRY(sl_symmetry_find(s->mesh, paired >= triangulated_quads ? partner : NULL, &def, &run->context, &symmetry));
    SL_TRY(paint_mirrors(s, symmetry, side, &found));
    if (!found) {
        SL_TRY(paint_near(run, s, &found));
        cli_note(run, found ? "note: only a near symmetry: the plane is shown, no axis of edges"
                            : "note: no symmetry was found");
    }
    s->scene.facet_rgb = s->facet_rgb;
    s->edge_layer[s->scene.edge_layers++] =
        (sl_edge_layer){s->axes, s->axis, {axis_rgb[0], axis_rgb[1], axis_rgb[2]}, axis_width};
cleanup:
    sl_symmetry_free(symmetry);
    sl_free(partner);
    sl_free(side);
    return status;
}
