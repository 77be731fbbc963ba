#include "view/scene.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "image/colormap.h"
#include "render/chart_colors.h"

#include <math.h>
#include <string.h>

static const uint8_t seam_rgb[3] = {20, 22, 26}, line_rgb[3] = {30, 96, 220}, red_rgb[3] = {214, 40, 40},
                     plain_rgb[3] = {206, 208, 212};

struct sl_scene_view {
    const sl_session *session;
    sl_frame *frame[SL_PANES];
    sl_shown shown;
    double centre[3], radius; /* of the model */
    int32_t nt, *facet_of;    /* nt: facet of a triangle */
    int32_t *first_use;       /* nh: the triangle corner that shows a halfedge's origin */
    double *flat;             /* 9 nt: UVs as positions */
    double *corner_uv;        /* 6 nt */
    uint8_t *rgb, *facet_rgb; /* 3 nt, 3 nf */
    uint8_t *red;             /* nf */
    int32_t *pairs;           /* vertex pairs of lines, 2 nh */
    int32_t reds;
    sl_image *texture; /* NULL = none */
};

static void bounds(sl_scene_view *v, const sl_mesh *mesh)
{
    double lo[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int32_t i = 0; i < mesh->nv; i++) {
        for (int k = 0; k < 3; k++) {
            lo[k] = fmin(lo[k], mesh->xyz[3 * (int64_t)i + k]);
            hi[k] = fmax(hi[k], mesh->xyz[3 * (int64_t)i + k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        v->centre[k] = 0.5 * (lo[k] + hi[k]);
    }
    v->radius = fmax(0.5 * sl_vec3_distance(lo, hi), 1e-9);
}

static sl_status make_frames(sl_scene_view *v, const sl_mesh *mesh, const sl_triangulation *triangulation)
{
    sl_status status = SL_OK;
    int32_t *tri = sl_alloc(3 * (int64_t)v->nt, sizeof *tri);
    if (tri == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * v->nt; c++) {
        tri[c] = mesh->origin[triangulation->corner[c]];
    }
    const sl_frame_def space = {mesh->nv, v->nt, mesh->xyz, tri, v->corner_uv, v->rgb};
    SL_TRY(sl_frame_create(&space, &v->frame[SL_PANE_3D]));
    for (int32_t c = 0; c < 3 * v->nt; c++) {
        tri[c] = c;
    }
    const sl_frame_def flat = {3 * v->nt, v->nt, v->flat, tri, v->corner_uv, v->rgb};
    SL_TRY(sl_frame_create(&flat, &v->frame[SL_PANE_UV]));
cleanup:
    sl_free(tri);
    return status;
}

sl_status sl_scene_view_create(const sl_session *session, sl_scene_view **out)
{
    sl_status status = SL_OK;
    const sl_mesh *mesh = sl_session_mesh(session);
    const sl_triangulation *triangulation = sl_session_triangulation(session);
    sl_scene_view *v = sl_calloc(1, sizeof *v);
    *out = NULL;
    if (v == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    v->session = session;
    v->nt = triangulation->nt;
    v->facet_of = sl_alloc(v->nt, sizeof *v->facet_of);
    v->first_use = sl_alloc(mesh->nh, sizeof *v->first_use);
    v->flat = sl_calloc(9 * (int64_t)v->nt, sizeof *v->flat);
    v->corner_uv = sl_calloc(6 * (int64_t)v->nt, sizeof *v->corner_uv);
    v->rgb = sl_calloc(3 * (int64_t)v->nt, sizeof *v->rgb);
    v->facet_rgb = sl_calloc(3 * (int64_t)mesh->nf, sizeof *v->facet_rgb);
    v->red = sl_calloc(mesh->nf, sizeof *v->red);
    v->pairs = sl_alloc(2 * (int64_t)mesh->nh, sizeof *v->pairs);
    if (v->facet_of == NULL || v->first_use == NULL || v->flat == NULL || v->corner_uv == NULL || v->rgb == NULL ||
        v->facet_rgb == NULL || v->red == NULL || v->pairs == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        for (int32_t t = triangulation->first[f]; t < triangulation->first[f + 1]; t++) {
            v->facet_of[t] = f;
        }
    }
    for (int32_t c = 3 * v->nt - 1; c >= 0; c--) {
        v->first_use[triangulation->corner[c]] = c;
    }
    bounds(v, mesh);
    SL_TRY(make_frames(v, mesh, triangulation));
cleanup:
    if (status != SL_OK) {
        sl_scene_view_free(v);
        v = NULL;
    }
    *out = v;
    return status;
}

void sl_scene_view_free(sl_scene_view *view)
{
    if (view == NULL) {
        return;
    }
    sl_frame_free(view->frame[SL_PANE_3D]);
    sl_frame_free(view->frame[SL_PANE_UV]);
    sl_free(view->facet_of);
    sl_free(view->first_use);
    sl_free(view->flat);
    sl_free(view->corner_uv);
    sl_free(view->rgb);
    sl_free(view->facet_rgb);
    sl_free(view->red);
    sl_free(view->pairs);
    sl_image_free(view->texture);
    sl_free(view);
}

static sl_status color_facets(sl_scene_view *v, const sl_mesh *mesh, sl_shown shown)
{
    const double *stretch = sl_session_stretch(v->session);
    for (int32_t f = 0; f < mesh->nf; f++) {
        uint8_t *rgb = v->facet_rgb + 3 * (int64_t)f;
        memcpy(rgb, plain_rgb, 3);
        if (shown == SL_SHOW_STRETCH) {
            sl_colormap_sample(SL_COLORMAP_HEAT, fmin(stretch[f] - 1.0, 1.0), rgb);
        }
    }
    if (shown == SL_SHOW_TEXTURE) {
        memset(v->facet_rgb, 255, 3 * (size_t)mesh->nf);
    }
    if (shown == SL_SHOW_CHECKER || shown == SL_SHOW_CHARTS) {
        const sl_status status = sl_chart_colors(mesh, sl_session_face_chart(v->session), v->facet_rgb);
        if (status != SL_OK) {
            return status;
        }
    }
    for (int32_t t = 0; t < v->nt; t++) {
        const int32_t f = v->facet_of[t];
        memcpy(v->rgb + 3 * (int64_t)t, v->red[f] != 0 ? red_rgb : v->facet_rgb + 3 * (int64_t)f, 3);
    }
    return SL_OK;
}

static void take_uvs(sl_scene_view *v, const sl_triangulation *triangulation)
{
    const double *uv = sl_session_corner_uv(v->session);
    for (int32_t c = 0; c < 3 * v->nt; c++) {
        const double *p = uv + 2 * (int64_t)triangulation->corner[c];
        v->flat[3 * (int64_t)c] = v->corner_uv[2 * (int64_t)c] = p[0];
        v->flat[3 * (int64_t)c + 1] = v->corner_uv[2 * (int64_t)c + 1] = p[1];
    }
}

/* A line of both panes: vertices in space, triangle corners in UV space. */
static sl_status set_lines(sl_scene_view *v, int32_t layer, const int32_t *halfedge, int32_t count,
                           const uint8_t rgb[3], double width)
{
    const sl_mesh *mesh = sl_session_mesh(v->session);
    for (int32_t k = 0; k < count; k++) {
        v->pairs[2 * (int64_t)k] = mesh->origin[halfedge[k]];
        v->pairs[2 * (int64_t)k + 1] = sl_target(mesh, halfedge[k]);
    }
    sl_status status = sl_frame_set_lines(v->frame[SL_PANE_3D], layer, count, v->pairs, rgb, width);
    for (int32_t k = 0; k < count; k++) {
        v->pairs[2 * (int64_t)k] = v->first_use[halfedge[k]];
        v->pairs[2 * (int64_t)k + 1] = v->first_use[sl_next(mesh, halfedge[k])];
    }
    return status == SL_OK ? sl_frame_set_lines(v->frame[SL_PANE_UV], layer, count, v->pairs, rgb, width) : status;
}

/* Every side of a seam, and the mesh's own border. */
static sl_status seam_lines(sl_scene_view *v)
{
    const sl_mesh *mesh = sl_session_mesh(v->session);
    int32_t *halfedge = sl_alloc(mesh->nh, sizeof *halfedge), count = 0;
    if (halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] < 0) {
            halfedge[count++] = h;
        }
    }
    const sl_status status = set_lines(v, 0, halfedge, count, seam_rgb, 1.6);
    sl_free(halfedge);
    return status;
}

static sl_status straight_lines(sl_scene_view *v)
{
    sl_status status = SL_OK;
    const sl_mesh *mesh = sl_session_mesh(v->session);
    int32_t *halfedge = sl_alloc(mesh->nh, sizeof *halfedge), *own = NULL, count = 0;
    if (halfedge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < sl_session_constraints(v->session); k++) {
        int32_t n = 0;
        SL_TRY(sl_session_constraint_edges(v->session, k, &own, &n));
        for (int32_t i = 0; i < n && count < mesh->nh; i++) {
            halfedge[count++] = own[i];
        }
        sl_free(own);
        own = NULL;
    }
    SL_TRY(set_lines(v, 1, halfedge, count, line_rgb, 3.0));
cleanup:
    sl_free(own);
    sl_free(halfedge);
    return status;
}

sl_status sl_scene_view_update(sl_scene_view *view, sl_shown shown, const sl_context *context)
{
    sl_status status = SL_OK;
    const sl_mesh *mesh = sl_session_mesh(view->session);
    view->shown = shown;
    SL_TRY(sl_session_page_red(view->session, context, view->red, &view->reds));
    take_uvs(view, sl_session_triangulation(view->session));
    SL_TRY(color_facets(view, mesh, shown));
    for (int pane = 0; pane < SL_PANES; pane++) {
        sl_frame_set_colors(view->frame[pane], view->rgb);
        SL_TRY(sl_frame_set_uv(view->frame[pane], view->corner_uv));
    }
    sl_frame_set_positions(view->frame[SL_PANE_UV], view->flat);
    SL_TRY(seam_lines(view));
    SL_TRY(straight_lines(view));
cleanup:
    return status;
}

/* An eye on a sphere about the model, far enough to see all of it at zoom 1. */
static sl_camera space_camera(const sl_scene_view *v, const sl_look *look)
{
    static const double field = 24.0 * 3.14159265358979323846 / 180.0;
    const double a = look->azimuth * 3.14159265358979323846 / 180.0,
                 e = look->elevation * 3.14159265358979323846 / 180.0;
    const double aspect = (double)look->width / look->height, narrow = fmin(aspect, 1.0);
    const double distance = v->radius / (sin(0.5 * field) * narrow) / look->zoom;
    sl_camera camera = {.centre = {0.5, 0.5}, .focal = 0.5 / tan(0.5 * field), .perspective = true};
    camera.forward[0] = -sin(a) * cos(e);
    camera.forward[1] = -sin(e);
    camera.forward[2] = -cos(a) * cos(e);
    camera.right[0] = cos(a);
    camera.right[2] = -sin(a);
    camera.up[0] = -sin(a) * sin(e);
    camera.up[1] = cos(e);
    camera.up[2] = -cos(a) * sin(e);
    for (int k = 0; k < 3; k++) {
        camera.eye[k] = v->centre[k] - distance * camera.forward[k] -
                        v->radius * (look->x * camera.right[k] + look->y * camera.up[k]);
    }
    camera.near_depth = fmax(distance - 1.5 * v->radius, 1e-3 * distance);
    return camera;
}

sl_camera sl_scene_view_camera(const sl_scene_view *view, sl_pane pane, const sl_look *look)
{
    const double aspect = (double)look->width / look->height;
    const double span = 1.06 / (fmin(aspect, 1.0) * look->zoom);
    return pane == SL_PANE_3D ? space_camera(view, look)
                              : sl_camera_plan(look->x - 0.5 * span * aspect, look->y - 0.5 * span, span, aspect);
}

void sl_scene_view_set_texture(sl_scene_view *view, sl_image *image)
{
    sl_image_free(view->texture);
    view->texture = image;
}

/* The picture's colour at a UV, between its four nearest texels. */
static void sample(const sl_image *image, const double uv[2], double rgb[3])
{
    const double x = (uv[0] - floor(uv[0])) * image->width - 0.5,
                 y = (1.0 - (uv[1] - floor(uv[1]))) * image->height - 0.5;
    const double fx = x - floor(x), fy = y - floor(y);
    const int32_t x0 = (int32_t)floor(x), y0 = (int32_t)floor(y);
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int k = 0; k < 4; k++) {
        const int32_t i = (x0 + (k & 1) + image->width) % image->width,
                      j = (y0 + (k >> 1) + image->height) % image->height;
        const double weight = ((k & 1) != 0 ? fx : 1.0 - fx) * ((k >> 1) != 0 ? fy : 1.0 - fy);
        const uint8_t *p = sl_image_pixel(image, i, j);
        for (int c = 0; c < 3; c++) {
            rgb[c] += weight * p[c];
        }
    }
}

/* A frame whose surface is white under its light, to be coloured. */
typedef struct painting {
    const sl_scene_view *view;
    const sl_look *look;
    sl_pane pane;
    sl_camera camera;
    uint8_t *rgba;
} painting;

/* The UV of a pixel; false: it shows nothing of the picture. */
static bool pixel_uv(const painting *p, int32_t x, int32_t y, double uv[2])
{
    const sl_frame_hit hit = sl_frame_pick(p->view->frame[p->pane], x, y);
    uv[0] = uv[1] = 0.0;
    if (hit.triangle >= 0) {
        const double *corner = p->view->corner_uv + 6 * (int64_t)hit.triangle;
        for (int k = 0; k < 3; k++) {
            uv[0] += hit.bary[k] * corner[2 * k];
            uv[1] += hit.bary[k] * corner[2 * k + 1];
        }
        return true;
    }
    if (p->pane == SL_PANE_UV) { /* the page behind the charts */
        double origin[3], direction[3];
        sl_camera_ray(&p->camera, p->look->width, p->look->height, x + 0.5, y + 0.5, origin, direction);
        uv[0] = p->camera.eye[0] + origin[0];
        uv[1] = p->camera.eye[1] + origin[1];
        return uv[0] >= 0.0 && uv[0] <= 1.0 && uv[1] >= 0.0 && uv[1] <= 1.0;
    }
    return false;
}

/* Light times colour: with encoded values, too, since the encoding is nearly a power. */
static void paint_rows(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const painting *p = user;
    (void)chunk;
    for (int32_t y = (int32_t)begin; y < end; y++) {
        for (int32_t x = 0; x < p->look->width; x++) {
            uint8_t *pixel = p->rgba + 4 * ((int64_t)y * p->look->width + x);
            double uv[2], rgb[3];
            if (pixel_uv(p, x, y, uv)) {
                sample(p->view->texture, uv, rgb);
                for (int c = 0; c < 3; c++) {
                    pixel[c] = (uint8_t)(pixel[c] * rgb[c] / 255.0 + 0.5);
                }
            }
        }
    }
}

sl_status sl_scene_view_draw(sl_scene_view *view, sl_pane pane, const sl_look *look, const sl_context *context,
                             uint8_t *rgba)
{
    painting p = {view, look, pane, sl_scene_view_camera(view, pane, look), rgba};
    sl_frame_style style = sl_frame_style_default();
    style.checks = view->shown == SL_SHOW_CHECKER ? 48.0 : 0.0;
    style.lit = pane == SL_PANE_3D;
    const sl_status status =
        sl_frame_draw(view->frame[pane], &p.camera, &style, look->width, look->height, context, rgba);
    if (status == SL_OK && view->shown == SL_SHOW_TEXTURE && view->texture != NULL) {
        sl_parallel_for(context, look->height, 16, paint_rows, &p);
    }
    return status;
}

/* Distance of a point from the line between two others, in the first `dim` coordinates. */
static double segment_distance(const double *p, const double *a, const double *b, int dim)
{
    double along = 0.0, length = 0.0, square = 0.0;
    for (int k = 0; k < dim; k++) {
        along += (p[k] - a[k]) * (b[k] - a[k]);
        length += (b[k] - a[k]) * (b[k] - a[k]);
    }
    const double s = length > 0.0 ? fmin(fmax(along / length, 0.0), 1.0) : 0.0;
    for (int k = 0; k < dim; k++) {
        const double d = p[k] - a[k] - s * (b[k] - a[k]);
        square += d * d;
    }
    return sqrt(square);
}

sl_scene_hit sl_scene_view_pick(const sl_scene_view *view, sl_pane pane, int32_t x, int32_t y)
{
    const sl_frame_hit hit = sl_frame_pick(view->frame[pane], x, y);
    const sl_mesh *mesh = sl_session_mesh(view->session);
    const sl_triangulation *triangulation = sl_session_triangulation(view->session);
    sl_scene_hit out = {.facet = -1, .corner = -1, .side = -1};
    double p[3] = {0.0, 0.0, 0.0}, side = HUGE_VAL, corner = HUGE_VAL;
    if (hit.triangle < 0) {
        return out;
    }
    out.facet = view->facet_of[hit.triangle];
    for (int k = 0; k < 3; k++) {
        const int32_t h = triangulation->corner[3 * hit.triangle + k];
        const double *uv = sl_session_corner_uv(view->session) + 2 * (int64_t)h;
        for (int i = 0; i < 3; i++) {
            p[i] += hit.bary[k] * mesh->xyz[3 * (int64_t)mesh->origin[h] + i];
        }
        out.uv[0] += hit.bary[k] * uv[0];
        out.uv[1] += hit.bary[k] * uv[1];
    }
    for (int32_t h = mesh->face_first[out.facet]; h < mesh->face_first[out.facet + 1]; h++) {
        const double *a = mesh->xyz + 3 * (int64_t)mesh->origin[h], *b = mesh->xyz + 3 * (int64_t)sl_target(mesh, h);
        const double to_side = segment_distance(p, a, b, 3), to_corner = sl_vec3_distance(p, a);
        if (to_side < side) {
            side = to_side;
            out.side = h;
        }
        if (to_corner < corner) {
            corner = to_corner;
            out.corner = h;
        }
    }
    return out;
}

int32_t sl_scene_view_red(const sl_scene_view *view)
{
    return view->reds;
}
