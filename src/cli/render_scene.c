/* seamlab render: from a mesh file to a scene. */
#include "cli/render_scene.h"
#include "atlas/seams.h"
#include "atlas/sidecar.h"
#include "base/memory.h"
#include "image/jpeg.h"
#include "overlap/coverage.h"
#include "render/chart_colors.h"
#include "render/uv_charts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint8_t line_rgb[3] = {38, 96, 214}, dot_rgb[3] = {250, 204, 32}, rim_rgb[3] = {40, 34, 0};
static const double line_width = 3.6, dot_radius = 5.5, rim_radius = 7.0; /* pixels */

/* UVs by halfedge, charts, and what the sidecar says of copies. */
static sl_status lay_uv(cli_run *run, cli_scene *s, const char *path)
{
    char sidecar[4096];
    sl_diag diag = sl_diag_none();
    const sl_mesh *m = s->mesh;
    s->corner_uv = sl_alloc(m->nh, 2 * sizeof *s->corner_uv);
    s->chart = sl_alloc(m->nf, sizeof *s->chart);
    if (s->corner_uv == NULL || s->chart == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        memcpy(s->corner_uv + 2 * (int64_t)h, s->file->corner_uv + 2 * (int64_t)sl_input_corner(m, h),
               2 * sizeof *s->corner_uv);
    }
    s->scene.corner_uv = s->corner_uv;
    sl_sidecar_path(path, sidecar, sizeof sidecar);
    const sl_status status = sl_sidecar_read(sidecar, m->nf, &s->sharing, &diag);
    s->shared = status == SL_OK;
    if (!s->shared) {
        if (status != SL_IO) {
            cli_note(run, "note: the sidecar is not used: %s", diag.reason);
        }
        return sl_uv_charts(m, s->corner_uv, s->chart, &s->charts);
    }
    memcpy(s->chart, s->sharing.face_chart, (size_t)m->nf * sizeof *s->chart);
    s->charts = s->sharing.nchart;
    return SL_OK;
}

/* Copies have the colours of what they copy. */
static sl_status color_charts(cli_scene *s)
{
    sl_status status = SL_OK;
    int32_t *shown = sl_alloc(s->mesh->nf, sizeof *shown);
    s->facet_rgb = sl_alloc(s->mesh->nf, 3);
    if (shown == NULL || s->facet_rgb == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        const int32_t c = s->chart[f];
        shown[f] = s->shared && s->sharing.copy_of[c] >= 0 ? s->sharing.copy_of[c] : c;
    }
    SL_TRY(sl_chart_colors(s->mesh, shown, s->facet_rgb));
    s->scene.facet_rgb = s->facet_rgb;
cleanup:
    sl_free(shown);
    return status;
}

/* Triangles that have UVs and are not meant to lie on others; UVs moved into the unit square, one scale for both axes.
 */
static int32_t drawn_triangles(const cli_scene *s, int32_t *tri, int32_t *which, double *uv)
{
    double lo[2] = {INFINITY, INFINITY}, extent = 0.0;
    int32_t count = 0;
    for (int32_t t = 0; t < s->triangulation->nt; t++) {
        const int32_t *corner = s->triangulation->corner + 3 * (int64_t)t;
        const int32_t chart = s->chart[s->mesh->face[corner[0]]];
        if (chart < 0 || (s->shared && s->sharing.copy_of[chart] >= 0)) {
            continue;
        }
        memcpy(tri + 3 * (int64_t)count, corner, 3 * sizeof *tri);
        which[count++] = t;
    }
    for (int64_t i = 0; i < 3 * (int64_t)count; i++) {
        for (int k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], s->corner_uv[2 * (int64_t)tri[i] + k]);
        }
    }
    for (int64_t i = 0; i < 3 * (int64_t)count; i++) {
        for (int k = 0; k < 2; k++) {
            extent = fmax(extent, s->corner_uv[2 * (int64_t)tri[i] + k] - lo[k]);
        }
    }
    for (int64_t i = 0; i < 3 * (int64_t)count; i++) {
        for (int k = 0; k < 2; k++) {
            const int64_t at = 2 * (int64_t)tri[i] + k;
            uv[at] = extent > 0.0 && isfinite(extent) ? (s->corner_uv[at] - lo[k]) / extent : 0.0;
        }
    }
    return count;
}

sl_status cli_show_overlap(cli_run *run, cli_scene *s, int32_t resolution)
{
    sl_status status = SL_OK;
    sl_coverage *coverage = NULL;
    const int32_t nt = s->triangulation->nt;
    int32_t *tri = sl_alloc(nt, 3 * sizeof *tri), *which = sl_alloc(nt, sizeof *which), red_count = 0;
    double *uv = sl_calloc(s->mesh->nh, 2 * sizeof *uv);
    uint8_t *red = sl_calloc(nt, 1);
    s->facet_flag = sl_calloc(s->mesh->nf, 1);
    if (tri == NULL || which == NULL || uv == NULL || red == NULL || s->facet_flag == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    const int32_t count = drawn_triangles(s, tri, which, uv);
    SL_TRY(sl_coverage_create(resolution, resolution, &coverage));
    SL_TRY(sl_coverage_add(coverage, uv, count, tri, &run->context));
    SL_TRY(sl_coverage_red_triangles(coverage, uv, count, tri, red));
    for (int32_t i = 0; i < count; i++) {
        s->facet_flag[s->mesh->face[tri[3 * (int64_t)i]]] |= red[i];
        red_count += red[i];
    }
    cli_note(run, "%d of %d triangles overlap at %d^2 texels", red_count, count, resolution);
    s->scene.facet_flag = s->facet_flag;
cleanup:
    sl_coverage_free(coverage);
    sl_free(tri);
    sl_free(which);
    sl_free(uv);
    sl_free(red);
    return status;
}

static int compare_edges(const void *a, const void *b)
{
    const int32_t *x = a, *y = b;
    return x[0] != y[0] ? (x[0] > y[0]) - (x[0] < y[0]) : (x[1] > y[1]) - (x[1] < y[1]);
}

/* Halfedges whose input vertices are an edge of the list; marks how many of its edges end at each input vertex. */
static sl_status find_lines(cli_scene *s, int32_t *edge, int32_t count)
{
    const sl_mesh *m = s->mesh;
    s->line = sl_alloc(m->nh, sizeof *s->line);
    if (s->line == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        const int32_t a = edge[2 * i], b = edge[2 * i + 1];
        edge[2 * i] = a < b ? a : b;
        edge[2 * i + 1] = a < b ? b : a;
    }
    qsort(edge, (size_t)count, 2 * sizeof *edge, compare_edges);
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t a = m->input_vertex[m->origin[h]], b = m->input_vertex[sl_target(m, h)];
        const int32_t key[2] = {a < b ? a : b, a < b ? b : a};
        if (h > sl_opposite(m, h) && bsearch(key, edge, (size_t)count, sizeof key, compare_edges) != NULL) {
            s->line[s->lines++] = h;
        }
    }
    return SL_OK;
}

/* Vertices where not exactly two constrained edges meet: ends and crossings. */
static sl_status find_dots(cli_scene *s)
{
    const sl_mesh *m = s->mesh;
    int32_t *degree = sl_calloc(m->nv, sizeof *degree);
    s->dot = sl_alloc(m->nv, sizeof *s->dot);
    if (degree == NULL || s->dot == NULL) {
        sl_free(degree);
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < s->lines; i++) {
        degree[m->origin[s->line[i]]]++;
        degree[sl_target(m, s->line[i])]++;
    }
    for (int32_t v = 0; v < m->nv; v++) {
        if (degree[v] != 0 && degree[v] != 2) {
            s->dot[s->dots++] = v;
        }
    }
    sl_free(degree);
    return SL_OK;
}

sl_status cli_show_constraints(cli_scene *s, const char *path, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t *edge = NULL, count = 0;
    SL_TRY(sl_seams_read_edges(path, &edge, &count, diag));
    SL_TRY(find_lines(s, edge, count));
    SL_TRY(find_dots(s));
    if (s->lines == 0) {
        sl_diag_reason(diag, "none of the %d edges in %s is an edge of the mesh", count, path);
        SL_TRY(SL_BAD_INPUT);
    }
    s->edge_layer[s->scene.edge_layers++] =
        (sl_edge_layer){s->lines, s->line, {line_rgb[0], line_rgb[1], line_rgb[2]}, line_width};
    s->dot_layer[0] = (sl_dot_layer){s->dots, s->dot, {rim_rgb[0], rim_rgb[1], rim_rgb[2]}, rim_radius};
    s->dot_layer[1] = (sl_dot_layer){s->dots, s->dot, {dot_rgb[0], dot_rgb[1], dot_rgb[2]}, dot_radius};
    s->scene.dot_layer = s->dot_layer;
    s->scene.dot_layers = 2;
cleanup:
    sl_free(edge);
    return status;
}

static sl_status need_uv(const cli_scene *s, const cli_scene_options *o, sl_diag *diag)
{
    const cli_show *show = &o->show;
    if (s->corner_uv == NULL && (show->overlap || show->stretch || show->charts || o->texture != NULL)) {
        sl_diag_reason(diag, "%s has no UVs, which charts, overlap, stretch and textures need", o->path);
        sl_diag_hint(diag, "seamlab unwrap makes some");
        return SL_BAD_INPUT;
    }
    return SL_OK;
}

/* What --show and the options ask for, on a mesh that is built. */
static sl_status dress(cli_run *run, const cli_scene_options *o, cli_scene *s, sl_diag *diag)
{
    sl_status status = SL_OK;
    const cli_show *show = &o->show;
    if (s->file->corner_uv != NULL) {
        SL_TRY(lay_uv(run, s, o->path));
    }
    SL_TRY(need_uv(s, o, diag));
    s->scene.chart = s->shared ? s->chart : NULL;
    s->scene.edge_layer = s->edge_layer;
    if (o->texture != NULL) {
        SL_TRY(sl_picture_read(o->texture, &s->texture, diag));
        s->scene.texture = s->texture;
    }
    if (show->charts || (o->charts_if_uv && s->corner_uv != NULL && o->texture == NULL)) {
        SL_TRY(color_charts(s));
    }
    if (show->stretch) {
        SL_TRY(cli_show_stretch(s));
    }
    if (show->visibility) {
        SL_TRY(cli_show_visibility(run, s));
    }
    if (show->seamcost) {
        SL_TRY(cli_show_seam_cost(run, s));
    }
    if (show->eigenvector > 0) {
        SL_TRY(cli_show_eigenvector(run, s, show->eigenvector, diag));
    }
    if (show->symmetry) {
        SL_TRY(cli_show_symmetry(run, s));
    }
    if (show->overlap) {
        SL_TRY(cli_show_overlap(run, s, o->resolution));
    }
    if (show->constraints) {
        SL_TRY(cli_show_constraints(s, o->constraints, diag));
    }
cleanup:
    return status;
}

int cli_scene_open(cli_run *run, const cli_scene_options *o, cli_scene *s)
{
    sl_diag diag = sl_diag_none();
    sl_polygons polygons;
    sl_status status = SL_OK;
    *s = (cli_scene){.scene = sl_scene_default()};
    const int code = cli_read_mesh(run, o->path, &s->file);
    if (code != CLI_DONE) {
        return code;
    }
    sl_meshfile_polygons(s->file, &polygons);
    snprintf(diag.file, sizeof diag.file, "%s", o->path);
    SL_TRY(sl_mesh_build(&polygons, &s->mesh, NULL, &diag));
    SL_TRY(sl_triangulation_create(s->mesh, &s->triangulation));
    s->scene.mesh = s->mesh;
    s->scene.triangulation = s->triangulation;
    s->scene.checker = o->show.checker;
    s->scene.seams = o->show.seams;
    s->scene.checks = o->checks;
    s->scene.tiles = o->tiles;
    s->scene.wire = o->wire;
    SL_TRY(dress(run, o, s, &diag));
cleanup:
    return status == SL_IO ? (cli_fail(run, status, &diag), CLI_BAD_INPUT) : cli_fail(run, status, &diag);
}

void cli_scene_clear(cli_scene *s)
{
    sl_sharing_table_clear(&s->sharing);
    sl_triangulation_free(s->triangulation);
    sl_mesh_free(s->mesh);
    sl_meshfile_free(s->file);
    sl_image_free(s->texture);
    sl_free(s->corner_uv);
    sl_free(s->facet_value);
    sl_free(s->corner_value);
    sl_free(s->chart);
    sl_free(s->facet_rgb);
    sl_free(s->facet_flag);
    sl_free(s->axis);
    sl_free(s->line);
    sl_free(s->dot);
    *s = (cli_scene){0};
}
