/* Pictures of a chart with constraints. */
#include "support/sheet.h"

#include <math.h>
#include <string.h>

static const uint8_t blue[3] = {36, 86, 200}, yellow[3] = {244, 194, 13}, purple[3] = {168, 92, 200};
static const uint8_t chart_rgb[3] = {205, 222, 238}, other_rgb[3] = {226, 226, 224};
static const double line_width = 4.0, border_width = 1.8, dot_radius = 7.0, checks = 24.0;

/* What a scene borrows. */
typedef struct drawing {
    double *corner_uv;
    uint8_t *rgb;
    int32_t *halfedge, *dot, *border, halfedges, dots, borders;
} drawing;

static void clear(drawing *d)
{
    sl_free(d->corner_uv);
    sl_free(d->rgb);
    sl_free(d->halfedge);
    sl_free(d->dot);
    sl_free(d->border);
}

static void place_uv(const exp_sheet *sheet, const double *uv, const double window[3], double *corner_uv)
{
    const sl_patch *p = sheet->patch;
    for (int64_t h = 0; h < 2 * (int64_t)sheet->mesh->nh; h++) {
        corner_uv[h] = NAN;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        for (int k = 0; k < 2; k++) {
            corner_uv[2 * (int64_t)p->corner[c] + k] = (uv[2 * (int64_t)p->tri[c] + k] - window[k]) / window[2];
        }
    }
}

/* Mesh halfedge of the patch edge a b, -1 = none. */
static int32_t edge_between(const exp_sheet *sheet, int32_t a, int32_t b)
{
    const sl_patch *p = sheet->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t from = p->tri[c], to = p->tri[sl_corner_next(c)];
        if (((from == a && to == b) || (from == b && to == a)) && exp_sheet_is_edge(sheet, c)) {
            return p->corner[c];
        }
    }
    return -1;
}

static int32_t corner_at(const sl_patch *p, int32_t v)
{
    return p->corner[p->outgoing[v]];
}

static sl_status collect(const exp_sheet *sheet, const exp_wish *wish, drawing *d)
{
    int32_t room = 1;
    for (int32_t k = 0; k < wish->count; k++) {
        room += wish->item[k].count;
    }
    d->halfedge = sl_alloc(room, sizeof *d->halfedge);
    d->dot = sl_alloc(room, sizeof *d->dot);
    d->border = sl_alloc(3 * (int64_t)sheet->patch->nt, sizeof *d->border);
    if (d->halfedge == NULL || d->dot == NULL || d->border == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * sheet->patch->nt; c++) {
        if (sheet->patch->twin[c] < 0) {
            d->border[d->borders++] = sheet->patch->corner[c];
        }
    }
    for (int32_t k = 0; k < wish->count; k++) {
        const sl_constraint *c = &wish->item[k];
        for (int32_t i = 0; c->kind == SL_CONSTRAINT_STRAIGHT && i + 1 < c->count; i++) {
            const int32_t h = edge_between(sheet, c->vertex[i], c->vertex[i + 1]);
            if (h >= 0) {
                d->halfedge[d->halfedges++] = h;
            }
        }
        for (int32_t i = 0; c->kind != SL_CONSTRAINT_STRAIGHT && i < c->count; i++) {
            d->dot[d->dots++] = sheet->mesh->origin[corner_at(sheet->patch, c->vertex[i])];
        }
    }
    return SL_OK;
}

static void color(const exp_sheet *sheet, const uint8_t *tint, uint8_t *rgb)
{
    const sl_segmentation *seg = sheet->segmentation;
    for (int32_t f = 0; f < sheet->mesh->nf; f++) {
        const uint8_t *from = seg->face_chart[f] != sheet->chart ? other_rgb
                              : tint != NULL && tint[f] != 0     ? purple
                                                                 : chart_rgb;
        memcpy(rgb + 3 * (int64_t)f, from, 3);
    }
}

sl_status exp_sheet_draw(exp_run *run, const exp_sheet *sheet, const double *uv, const exp_wish *wish,
                         const exp_drawing *what)
{
    sl_status status = SL_OK;
    sl_image *image = NULL;
    drawing d = {0};
    char path[EXP_PATH];
    double around[3];
    exp_sheet_window(sheet, uv, around);
    d.corner_uv = sl_alloc(2 * (int64_t)sheet->mesh->nh, sizeof *d.corner_uv);
    d.rgb = sl_alloc(sheet->mesh->nf, 3 * sizeof *d.rgb);
    SL_TRY(d.corner_uv != NULL && d.rgb != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    place_uv(sheet, uv, what->window != NULL ? what->window : around, d.corner_uv);
    color(sheet, what->tint, d.rgb);
    SL_TRY(collect(sheet, wish, &d));
    const sl_edge_layer layers[] = {{d.borders, d.border, {0, 0, 0}, border_width},
                                    {d.halfedges, d.halfedge, {blue[0], blue[1], blue[2]}, line_width}};
    const sl_dot_layer dots = {
        d.dots, d.dot, {yellow[0], yellow[1], yellow[2]}, what->radius > 0.0 ? what->radius : dot_radius};
    sl_scene scene = sl_scene_default();
    scene.mesh = sheet->mesh;
    scene.triangulation = sheet->triangulation;
    scene.corner_uv = d.corner_uv;
    scene.facet_rgb = d.rgb;
    scene.checks = checks;
    scene.seams = false; /* they would be drawn between all facets without UVs */
    scene.edge_layers = d.halfedges > 0 ? 2 : 1;
    scene.edge_layer = layers;
    scene.dot_layers = d.dots > 0;
    scene.dot_layer = &dots;
    scene.wire = 0.18;
    const sl_picture picture = exp_picture(run, what->width, what->height);
    const sl_view view = exp_view_of(sheet->name);
    if (what->model) {
        SL_TRY(sl_render_pair(&scene, &view, &picture, &run->context, &image, &run->diag));
    } else {
        SL_TRY(sl_render_uv(&scene, &picture, &run->context, &image, &run->diag));
    }
    SL_TRY(exp_path(run, what->file, path));
    status = sl_png_write(path, image, &run->diag);
cleanup:
    sl_image_free(image);
    clear(&d);
    return status;
}
