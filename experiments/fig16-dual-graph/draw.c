#include "figure.h"

#include "image/png.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 900, HEIGHT = 680 };

static const uint8_t black[3] = {20, 22, 25}, grey[3] = {112, 118, 126}, green[3] = {22, 140, 70};
static const uint8_t blue[3] = {38, 92, 200}, red[3] = {205, 45, 40}, pale[3] = {178, 183, 190};
static const double thin = 1.3, thick = 2.6, thicker = 4.2, dot = 5.0;

void symmetric_graph_clear(symmetric_graph *g)
{
    sl_free(g->image);
    sl_free(g->side);
    *g = (symmetric_graph){0};
}

/* The exact mirror whose axis has most edges, NULL = none. (The graph alone has another one: top to bottom.) */
static const sl_symmetry_map *main_mirror(const sl_symmetry *s)
{
    const sl_symmetry_map *best = NULL;
    for (int32_t k = 0; k < s->nmap; k++) {
        const sl_symmetry_map *map = &s->map[k];
        if (map->kind == SL_SYMMETRY_EXACT && map->order == 2 && map->reverses && map->separates &&
            (best == NULL || map->axis_edges > best->axis_edges)) {
            best = map;
        }
    }
    return best;
}

/* Do facets f and g share an edge? */
static bool adjacent(const sl_mesh *mesh, int32_t f, int32_t g)
{
    for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
        if (mesh->twin[h] >= 0 && mesh->face[mesh->twin[h]] == g) {
            return true;
        }
    }
    return false;
}

static void count_edges(const sl_mesh *mesh, symmetric_graph *g)
{
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] > h) {
            const int32_t a = mesh->face[h], b = mesh->face[mesh->twin[h]];
            const bool crossing = g->side[a] != g->side[b];
            g->crossing += crossing;
            g->inner += !crossing;
            g->off_diagonal += crossing && g->image[a] != b;
            g->broken += !crossing && !adjacent(mesh, g->image[a], g->image[b]);
        }
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        g->pairs += g->image[f] != f;
    }
    g->pairs /= 2;
}

sl_status symmetric_graph_create(const sl_mesh *mesh, const sl_context *context, symmetric_graph *g)
{
    sl_status status = SL_OK;
    sl_symmetry *symmetry = NULL;
    const sl_symmetry_def def = sl_symmetry_default();
    g->image = sl_alloc(mesh->nf, sizeof *g->image);
    g->side = sl_alloc(mesh->nf, sizeof *g->side);
    if (g->image == NULL || g->side == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_symmetry_find(mesh, NULL, &def, context, &symmetry));
    const sl_symmetry_map *mirror = main_mirror(symmetry);
    if (mirror == NULL) {
        SL_TRY(SL_INTERNAL);
    }
    SL_TRY(sl_symmetry_sides(mesh, symmetry, mirror, g->side));
    for (int32_t f = 0; f < mesh->nf; f++) {
        g->image[f] = sl_symmetry_image(mesh, symmetry, mirror, f);
    }
    g->axis_edges = mirror->axis_edges;
    count_edges(mesh, g);
cleanup:
    sl_symmetry_free(symmetry);
    if (status != SL_OK) {
        symmetric_graph_clear(g);
    }
    return status;
}

/* Every facet divided from its centre to the middles of its edges: part h lies at corner h, and runs from there to the
 * middle of edge h, the centre, and the middle of the edge before. The dual graph is in its edges. */
static sl_status divide(const sl_mesh *mesh, sl_mesh **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    const int32_t nv = mesh->nv + mesh->nf + mesh->nh;
    double *xyz = sl_calloc(3 * (int64_t)nv, sizeof *xyz);
    int32_t *first = sl_alloc((int64_t)mesh->nh + 1, sizeof *first),
            *index = sl_alloc(4 * (int64_t)mesh->nh, sizeof *index);
    if (xyz == NULL || first == NULL || index == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    memcpy(xyz, mesh->xyz, 3 * (size_t)mesh->nv * sizeof *xyz);
    for (int32_t f = 0; f < mesh->nf; f++) {
        sl_mesh_face_centroid(mesh, f, xyz + 3 * (int64_t)(mesh->nv + f));
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t o = mesh->twin[h], p = sl_prev(mesh, h), e = mesh->nv + mesh->nf;
        for (int k = 0; k < 3; k++) {
            xyz[3 * (int64_t)(e + h) + k] =
                0.5 * (mesh->xyz[3 * (int64_t)mesh->origin[h] + k] + mesh->xyz[3 * (int64_t)sl_target(mesh, h) + k]);
        }
        first[h] = 4 * h;
        index[4 * h] = mesh->origin[h];
        index[4 * h + 1] = e + (o >= 0 && o < h ? o : h);
        index[4 * h + 2] = mesh->nv + mesh->face[h];
        index[4 * h + 3] = e + (mesh->twin[p] >= 0 && mesh->twin[p] < p ? mesh->twin[p] : p);
    }
    first[mesh->nh] = 4 * mesh->nh;
    const sl_polygons polygons = {nv, mesh->nh, xyz, first, index};
    SL_TRY(sl_mesh_build(&polygons, out, NULL, diag));
cleanup:
    sl_free(xyz);
    sl_free(first);
    sl_free(index);
    return status;
}

/* What is drawn: lists of the divided mesh's halfedges and vertices. */
typedef struct lists {
    int32_t *wire, *inner, *crossing, *first, *second; /* nh, nh, nh, nf, nf */
    int32_t wires, inners, crossings, firsts, seconds;
} lists;

static sl_status lists_create(const sl_mesh *mesh, const sl_mesh *divided, const symmetric_graph *g, lists *l)
{
    *l = (lists){sl_alloc(mesh->nh, sizeof *l->wire),
                 sl_alloc(mesh->nh, sizeof *l->inner),
                 sl_alloc(mesh->nh, sizeof *l->crossing),
                 sl_alloc(mesh->nf, sizeof *l->first),
                 sl_alloc(mesh->nf, sizeof *l->second),
                 0,
                 0,
                 0,
                 0,
                 0};
    if (l->wire == NULL || l->inner == NULL || l->crossing == NULL || l->first == NULL || l->second == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t f = mesh->face[h], o = mesh->twin[h];
        l->wire[l->wires++] = 4 * h;
        if (o >= 0 && g->side[f] != g->side[mesh->face[o]]) {
            l->crossing[l->crossings++] = 4 * h + 1;
        } else if (o >= 0) {
            l->inner[l->inners++] = 4 * h + 1;
        }
        if (h == mesh->face_first[f]) {
            const int32_t centre = divided->origin[4 * h + 2];
            if (g->side[f] == 1) {
                l->first[l->firsts++] = centre;
            } else {
                l->second[l->seconds++] = centre;
            }
        }
    }
    return SL_OK;
}

static void lists_clear(lists *l)
{
    sl_free(l->wire);
    sl_free(l->inner);
    sl_free(l->crossing);
    sl_free(l->first);
    sl_free(l->second);
}

static sl_edge_layer edges(int32_t count, const int32_t *halfedge, const uint8_t rgb[3], double width)
{
    return (sl_edge_layer){count, halfedge, {rgb[0], rgb[1], rgb[2]}, width};
}

static sl_dot_layer dots(int32_t count, const int32_t *vertex, const uint8_t rgb[3])
{
    return (sl_dot_layer){count, vertex, {rgb[0], rgb[1], rgb[2]}, dot};
}

static sl_status render(exp_run *run, const sl_mesh *divided, const lists *l, bool symmetry, const char *file)
{
    sl_status status = SL_OK;
    sl_triangulation *triangulation = NULL;
    sl_image *image = NULL;
    char path[EXP_PATH];
    const sl_edge_layer layer[] = {
        edges(l->wires, l->wire, pale, thin), edges(l->inners, l->inner, symmetry ? grey : black, thick),
        edges(l->crossings, l->crossing, symmetry ? green : black, symmetry ? thicker : thick)};
    const sl_dot_layer dot_layer[] = {dots(l->firsts, l->first, symmetry ? blue : black),
                                      dots(l->seconds, l->second, symmetry ? red : black)};
    sl_scene scene = sl_scene_default();
    sl_view view = sl_view_default();
    const sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    uint8_t *rgb = sl_alloc(divided->nf, 3);
    if (rgb == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    memset(rgb, 240, 3 * (size_t)divided->nf);
    view.azimuth = 14.0;
    view.elevation = 52.0;
    SL_TRY(sl_triangulation_create(divided, &triangulation));
    scene.mesh = divided;
    scene.triangulation = triangulation;
    scene.facet_rgb = rgb;
    scene.seams = false;
    scene.edge_layers = (int32_t)SL_COUNTOF(layer);
    scene.edge_layer = layer;
    scene.dot_layers = (int32_t)SL_COUNTOF(dot_layer);
    scene.dot_layer = dot_layer;
    SL_TRY(exp_path(run, file, path));
    SL_TRY(sl_render_3d(&scene, &view, &picture, &run->context, &image, &run->diag));
    SL_TRY(sl_png_write(path, image, &run->diag));
cleanup:
    sl_image_free(image);
    sl_triangulation_free(triangulation);
    sl_free(rgb);
    return status;
}

sl_status draw_graph(exp_run *run, const sl_mesh *mesh, const symmetric_graph *g, bool symmetry, const char *file)
{
    sl_status status = SL_OK;
    sl_mesh *divided = NULL;
    lists l = {0};
    SL_TRY(divide(mesh, &divided, &run->diag));
    SL_TRY(lists_create(mesh, divided, g, &l));
    SL_TRY(render(run, divided, &l, symmetry, file));
cleanup:
    lists_clear(&l);
    sl_mesh_free(divided);
    return status;
}
