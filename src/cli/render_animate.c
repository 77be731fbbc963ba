#include "cli/render_animate.h"

#include "base/memory.h"
#include "base/text.h"
#include "mesh/topology.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    SIDE = 480,       /* pixels of a view */
    MAX_STATES = 40,  /* shown; of more splits several are made at a time */
    MOST_FRAMES = 8,  /* of a state */
    LEAST_FRAMES = 3, /* likewise */
    ALL_FRAMES = 96,  /* about as many for all states */
    END_FRAMES = 24,  /* of the finished atlas */
    FRAME_MS = 90,
    END_MS = 2000,
    MAX_CHAIN = 64 /* copies of copies followed */
};

typedef struct animation {
    const sl_atlas *atlas;
    const sl_context *context;
    sl_mesh *work;        /* a copy of the mesh, cut state by state */
    int32_t *time;        /* nh: state in which an edge is cut first, -1 = not on the way */
    int32_t *chart, *old; /* nf: pieces of this state and of the one before */
    int32_t charts, olds;
    int32_t *color, *old_color; /* by chart: number of its colour */
    int32_t colors;             /* used so far */
    int32_t *owner;             /* by chart: final chart it lies in, -1 = in several */
    uint8_t *rgb;               /* 3 nf */
    double *uv;                 /* 2 nh */
    sl_apng *apng;
    sl_image *canvas;
} animation;

static void animation_clear(animation *a)
{
    sl_mesh_free(a->work);
    sl_free(a->time);
    sl_free(a->chart);
    sl_free(a->old);
    sl_free(a->color);
    sl_free(a->old_color);
    sl_free(a->owner);
    sl_free(a->rgb);
    sl_free(a->uv);
    sl_apng_free(a->apng);
    sl_image_free(a->canvas);
}

static sl_status animation_init(animation *a)
{
    const sl_mesh *m = a->atlas->mesh;
    sl_status status = SL_OK;
    a->time = sl_alloc(m->nh, sizeof *a->time);
    a->chart = sl_calloc(m->nf, sizeof *a->chart);
    a->old = sl_calloc(m->nf, sizeof *a->old);
    a->color = sl_calloc(m->nf, sizeof *a->color);
    a->old_color = sl_calloc(m->nf, sizeof *a->old_color);
    a->owner = sl_alloc(m->nf, sizeof *a->owner);
    a->rgb = sl_alloc(m->nf, 3);
    a->uv = sl_alloc(m->nh, 2 * sizeof *a->uv);
    if (a->time == NULL || a->chart == NULL || a->old == NULL || a->color == NULL || a->old_color == NULL ||
        a->owner == NULL || a->rgb == NULL || a->uv == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_image_create(2 * SIDE, SIDE, 3, &a->canvas));
    SL_TRY(sl_apng_create(0, &a->apng));
    SL_TRY(sl_mesh_copy(m, &a->work));
    for (int32_t h = 0; h < m->nh; h++) {
        sl_mesh_sew_edge(a->work, h);
    }
cleanup:
    return status;
}

/* The edge that the edge of h copies; h where it copies none. */
static int32_t copied_edge(const sl_mesh *m, const sl_segmentation *s, int32_t h)
{
    const int32_t from = s->source[h], to = s->source[sl_next(m, h)];
    if (from < 0 || to < 0) {
        return h;
    }
    return to == sl_next(m, from) ? from : to;
}

/* When each edge is cut; those of copies when what they copy is. */
static void find_times(animation *a)
{
    const sl_mesh *m = a->atlas->mesh;
    const sl_segmentation *s = a->atlas->segmentation;
    for (int32_t h = 0; h < m->nh; h++) {
        int32_t time = s->cut_after[h], at = h;
        for (int32_t n = 0; time < 0 && s->source != NULL && n < MAX_CHAIN; n++) {
            const int32_t next = copied_edge(m, s, at);
            if (next == at) {
                break;
            }
            at = next;
            time = s->cut_after[at];
        }
        a->time[h] = time;
    }
}

/* The pieces of a mesh as charts of the next state, in colours that carry on from the last. */
static sl_status label(animation *a, const sl_mesh *mesh)
{
    const sl_segmentation *s = a->atlas->segmentation;
    int32_t *swap = a->old;
    a->old = a->chart;
    a->chart = swap;
    swap = a->old_color;
    a->old_color = a->color;
    a->color = swap;
    a->olds = a->charts;
    const sl_status status = sl_mesh_components(mesh, a->chart, &a->charts);
    if (status != SL_OK) {
        return status;
    }
    for (int32_t c = 0; c < a->charts; c++) {
        a->owner[c] = -2;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        int32_t *owner = &a->owner[a->chart[f]];
        *owner = *owner == -2 || *owner == s->face_chart[f] ? s->face_chart[f] : -1;
    }
    return SL_OK;
}

/* The largest part of an old chart takes its colour; the others new ones, in the order of their numbers. */
static sl_status carry_colors(animation *a)
{
    const int32_t nf = a->atlas->mesh->nf;
    int64_t *size = sl_calloc(a->charts, sizeof *size);
    int32_t *heir = sl_alloc(a->olds > 0 ? a->olds : 1, sizeof *heir), *parent = sl_alloc(a->charts, sizeof *parent);
    if (size == NULL || heir == NULL || parent == NULL) {
        sl_free(size);
        sl_free(heir);
        sl_free(parent);
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = nf - 1; f >= 0; f--) {
        size[a->chart[f]]++;
        parent[a->chart[f]] = a->old[f]; /* of the first facet; only sewing joins several */
    }
    for (int32_t o = 0; o < a->olds; o++) {
        heir[o] = -1;
    }
    for (int32_t c = 0; c < a->charts && a->olds > 0; c++) {
        const int32_t o = parent[c];
        heir[o] = heir[o] < 0 || size[c] > size[heir[o]] ? c : heir[o];
    }
    for (int32_t c = 0; c < a->charts; c++) {
        const bool heirs = a->olds > 0 && heir[parent[c]] == c;
        a->color[c] = heirs ? a->old_color[parent[c]] : a->colors++;
    }
    sl_free(size);
    sl_free(heir);
    sl_free(parent);
    return SL_OK;
}

/* The facet whose colour facet f shows: of what it copies. */
static int32_t shown_facet(const animation *a, int32_t f)
{
    const sl_mesh *m = a->atlas->mesh;
    const sl_segmentation *s = a->atlas->segmentation;
    for (int32_t n = 0; s->source != NULL && n < MAX_CHAIN && s->source[m->face_first[f]] >= 0; n++) {
        f = m->face[s->source[m->face_first[f]]];
    }
    return f;
}

/* Facets' colours, and the UVs of charts that are finished. */
static void dress(animation *a)
{
    const sl_mesh *m = a->atlas->mesh;
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t shown = shown_facet(a, f);
        const bool finished = a->owner[a->chart[shown]] >= 0;
        sl_palette_color(a->color[a->chart[shown]], a->rgb + 3 * (int64_t)f);
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            for (int k = 0; k < 2; k++) {
                const double uv = a->atlas->corner_uv[2 * (int64_t)h + k];
                a->uv[2 * (int64_t)h + k] = finished ? uv : NAN;
            }
        }
    }
}

static sl_picture picture_of(const char *title)
{
    sl_picture p = sl_picture_default();
    p.width = p.height = SIDE;
    p.sky_lights = 0;
    p.title = title;
    return p;
}

/* The atlas so far. */
static sl_status draw_flat(animation *a, const sl_mesh *mesh)
{
    sl_scene scene = sl_scene_default();
    sl_image *image = NULL;
    const sl_picture picture = picture_of(NULL);
    scene.mesh = mesh;
    scene.triangulation = a->atlas->triangulation;
    scene.facet_rgb = a->rgb;
    scene.corner_uv = a->uv;
    scene.checker = false;
    const sl_status status = sl_render_uv(&scene, &picture, a->context, &image, NULL);
    if (status == SL_OK) {
        sl_image_paste(a->canvas, image, SIDE, 0);
    }
    sl_image_free(image);
    return status;
}

/* Some frames of a state, the model turning on. */
static sl_status draw_turning(animation *a, const sl_mesh *mesh, const char *title, int32_t frames, double *azimuth,
                              double step)
{
    sl_status status = SL_OK;
    sl_scene scene = sl_scene_default();
    const sl_picture picture = picture_of(title);
    sl_view view = sl_view_default();
    scene.mesh = mesh;
    scene.triangulation = a->atlas->triangulation;
    scene.facet_rgb = a->rgb;
    scene.chart = a->chart;
    scene.checker = false;
    for (int32_t k = 0; k < frames; k++) {
        sl_image *image = NULL;
        view.azimuth = *azimuth;
        *azimuth += step;
        SL_TRY(sl_render_3d(&scene, &view, &picture, a->context, &image, NULL));
        sl_image_paste(a->canvas, image, 0, 0);
        sl_image_free(image);
        SL_TRY(sl_apng_add(a->apng, a->canvas, FRAME_MS));
    }
cleanup:
    return status;
}

static sl_status draw_state(animation *a, const sl_mesh *mesh, const char *title, int32_t frames, double *azimuth,
                            double step)
{
    sl_status status = SL_OK;
    SL_TRY(carry_colors(a));
    dress(a);
    SL_TRY(draw_flat(a, mesh));
    SL_TRY(draw_turning(a, mesh, title, frames, azimuth, step));
cleanup:
    return status;
}

static sl_status draw_states(animation *a)
{
    sl_status status = SL_OK;
    const sl_segmentation *s = a->atlas->segmentation;
    const int32_t states = s->nsplit + 1, stride = (states + MAX_STATES - 1) / MAX_STATES;
    const int32_t shown = (states + stride - 1) / stride, share = ALL_FRAMES / shown;
    const int32_t frames = share > MOST_FRAMES ? MOST_FRAMES : share < LEAST_FRAMES ? LEAST_FRAMES : share;
    const double step = 360.0 / (frames * shown + END_FRAMES);
    double azimuth = sl_view_default().azimuth;
    char title[96];
    for (int32_t state = 0; state < states; state += stride) {
        for (int32_t h = 0; h < a->work->nh; h++) {
            if (a->time[h] >= 0 && a->time[h] < state) {
                sl_mesh_cut_edge(a->work, h);
            }
        }
        SL_TRY(sl_report_progress(a->context, "animate", (double)state / states));
        SL_TRY(label(a, a->work));
        snprintf(title, sizeof title, "%d split%s: %d piece%s", state, sl_plural(state), a->charts,
                 sl_plural(a->charts));
        SL_TRY(draw_state(a, a->work, title, frames, &azimuth, step));
    }
    SL_TRY(label(a, a->atlas->mesh));
    if (s->merges > 0) {
        snprintf(title, sizeof title, "%d split%s, %d sewn: %d chart%s", s->nsplit, sl_plural(s->nsplit), s->merges,
                 a->charts, sl_plural(a->charts));
    } else {
        snprintf(title, sizeof title, "%d split%s: %d chart%s", s->nsplit, sl_plural(s->nsplit), a->charts,
                 sl_plural(a->charts));
    }
    SL_TRY(draw_state(a, a->atlas->mesh, title, END_FRAMES, &azimuth, step));
    SL_TRY(sl_apng_add(a->apng, a->canvas, END_MS));
cleanup:
    return status;
}

sl_status cli_animate_segmentation(const sl_atlas *atlas, const sl_context *context, sl_apng **out)
{
    sl_status status = SL_OK;
    animation a = {.atlas = atlas, .context = context};
    *out = NULL;
    SL_TRY(animation_init(&a));
    find_times(&a);
    SL_TRY(draw_states(&a));
    *out = a.apng;
    a.apng = NULL;
cleanup:
    animation_clear(&a);
    return status;
}
