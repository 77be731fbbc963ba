/* Overlap counts, ours and llvmpipe's stencil increment in turn on the same triangles; and what else the overlap room
 * does, timed. Processor time of the process, all threads.
 *   overlap [--runs R] [--max-triangles N] [--lp-threads T] [--csv FILE] */
#define _POSIX_C_SOURCE 200809L
#include "base/memory.h"
#include "overlap/certificate.h"
#include "overlap/edge_raster.h"
#include "overlap/exact.h"
#include "overlap/stencil.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    MOST_RUNS = 99,
    FRAMES = 4, /* drawn in one turn, their mean counts: frames follow frames */
};

typedef struct options {
    int32_t runs, most, threads;
    const char *csv;
} options;

typedef struct scene {
    const char *kind;
    int32_t nv, nt, nb;
    double *uv;
    float *narrow;
    int32_t *tri, *border;
} scene;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *value, int32_t n)
{
    qsort(value, (size_t)n, sizeof *value, compare);
    return n % 2 == 1 ? value[n / 2] : 0.5 * (value[n / 2 - 1] + value[n / 2]);
}

static uint64_t next_bits(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static double uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(next_bits(state) >> 11) * 0x1p-53;
}

/* Room for a scene. */
static void scene_create(scene *s, const char *kind, int32_t nv, int32_t nt, int32_t nb)
{
    *s = (scene){kind,
                 nv,
                 nt,
                 nb,
                 sl_alloc(nv, 2 * sizeof(double)),
                 sl_alloc(nv, 2 * sizeof(float)),
                 sl_alloc(nt, 3 * sizeof(int32_t)),
                 sl_alloc(nb, 2 * sizeof(int32_t))};
    if (s->uv == NULL || s->narrow == NULL || s->tri == NULL || s->border == NULL) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
}

static void scene_clear(scene *s)
{
    sl_free(s->uv);
    sl_free(s->narrow);
    sl_free(s->tri);
    sl_free(s->border);
}

static void narrow(scene *s)
{
    for (int64_t i = 0; i < 2 * (int64_t)s->nv; i++) {
        s->narrow[i] = (float)s->uv[i];
    }
}

/* One chart of about n triangles: a curved grid with vertices off their places by up to a fifth of an edge, numbered
 * along it; border pairs included. */
static void make_mesh(scene *s, int32_t n)
{
    uint64_t seed = 0x5ea1;
    const int32_t side = (int32_t)lround(sqrt(0.5 * n)), row = side + 1;
    scene_create(s, "mesh", row * row, 2 * side * side, 4 * side);
    for (int32_t v = 0; v < s->nv; v++) {
        const double x = (v % row + uniform(&seed, -0.2, 0.2)) / side,
                     y = ((double)(v / row) + uniform(&seed, -0.2, 0.2)) / side;
        s->uv[2 * v] = 0.5 + 0.42 * (2.0 * x - 1.0) + 0.05 * sin(7.0 * y + 0.4);
        s->uv[2 * v + 1] = 0.5 + 0.42 * (2.0 * y - 1.0) + 0.05 * cos(6.0 * x + 1.1);
    }
    for (int32_t q = 0; q < side * side; q++) {
        const int32_t a = q / side * row + q % side, corner[6] = {a, a + 1, a + row + 1, a, a + row + 1, a + row};
        memcpy(s->tri + 6 * (int64_t)q, corner, sizeof corner);
    }
    for (int32_t k = 0; k < side; k++) {
        const int32_t top = side * row, pair[8] = {k,       k + 1,         top + k,        top + k + 1,
                                                   k * row, (k + 1) * row, k * row + side, (k + 1) * row + side};
        memcpy(s->border + 8 * (int64_t)k, pair, sizeof pair);
    }
    narrow(s);
}

/* The mesh's triangles, each thrown somewhere else, sharing nothing. */
static void make_soup(scene *s, const scene *mesh)
{
    uint64_t seed = 0x50f7;
    scene_create(s, "soup", 3 * mesh->nt, mesh->nt, 0);
    for (int32_t t = 0; t < mesh->nt; t++) {
        const double x = uniform(&seed, 0.05, 0.9), y = uniform(&seed, 0.05, 0.9), turn = uniform(&seed, 0.0, 6.28);
        const double *origin = mesh->uv + 2 * (int64_t)mesh->tri[3 * (int64_t)t];
        for (int k = 0; k < 3; k++) {
            const int64_t v = 3 * (int64_t)t + k;
            const double *p = mesh->uv + 2 * (int64_t)mesh->tri[v];
            const double dx = p[0] - origin[0], dy = p[1] - origin[1];
            s->tri[v] = (int32_t)v;
            s->uv[2 * v] = fmin(fmax(x + cos(turn) * dx - sin(turn) * dy, 0.0), 1.0);
            s->uv[2 * v + 1] = fmin(fmax(y + sin(turn) * dx + cos(turn) * dy, 0.0), 1.0);
        }
    }
    narrow(s);
}

static sl_edge_raster *make_raster(const scene *s, int32_t size, bool portable)
{
    const sl_edge_raster_def def = {.width = size, .height = size, .depth = 8, .portable = portable};
    sl_edge_raster *raster = NULL;
    if (sl_edge_raster_create(s->nv, s->nt, s->tri, &def, &raster) != SL_OK ||
        sl_edge_raster_draw(raster, s->uv, NULL) != SL_OK) { /* once unmeasured: pages are there, as llvmpipe's */
        fprintf(stderr, "no raster of %d\n", (int)size);
        exit(1);
    }
    return raster;
}

static double time_draw(sl_edge_raster *raster, const scene *s)
{
    const double begin = now();
    for (int k = 0; k < FRAMES; k++) {
        if (sl_edge_raster_draw(raster, s->uv, NULL) != SL_OK) {
            exit(1);
        }
    }
    return (now() - begin) / FRAMES;
}

/* Rounds of ours, ours without vectors, theirs; ratios round by round. */
static void run_size(const options *o, const scene *s, int32_t size, FILE *csv)
{
    const int64_t texels = (int64_t)size * size;
    double ours[MOST_RUNS], plain[MOST_RUNS], theirs[MOST_RUNS], ratio[MOST_RUNS], plain_ratio[MOST_RUNS];
    sl_edge_raster *raster = make_raster(s, size, false), *portable = make_raster(s, size, true);
    test_stencil *stencil = test_stencil_create(size, size, o->threads);
    uint8_t *count = sl_alloc(texels, 1);
    if (stencil == NULL || count == NULL || !test_stencil_draw(stencil, s->nv, s->narrow, s->nt, s->tri, count)) {
        fprintf(stderr, "no llvmpipe\n");
        exit(1);
    }
    for (int32_t r = 0; r < o->runs; r++) {
        ours[r] = time_draw(raster, s);
        plain[r] = time_draw(portable, s);
        const double begin = now();
        for (int k = 0; k < FRAMES; k++) {
            (void)test_stencil_draw(stencil, s->nv, s->narrow, s->nt, s->tri, count);
        }
        theirs[r] = (now() - begin) / FRAMES;
        ratio[r] = theirs[r] / ours[r];
        plain_ratio[r] = theirs[r] / plain[r];
    }
    int64_t differing = 0;
    for (int64_t i = 0; i < texels; i++) {
        differing += count[i] != sl_edge_raster_counts8(raster)[i];
    }
    const double a = median(ours, o->runs), b = median(plain, o->runs), c = median(theirs, o->runs);
    const double d = median(ratio, o->runs), e = median(plain_ratio, o->runs);
    printf("%s %8d  %5d^2  ours %8.3f ms  portable %8.3f  llvmpipe %8.2f  times %6.1f (portable %5.1f)  active %d, "
           "%lld texels differ\n",
           s->kind, s->nt, size, a, b, c, d, e, sl_edge_raster_result(raster).active_edges, (long long)differing);
    fflush(stdout);
    if (csv != NULL) {
        fprintf(csv, "%s,%d,%d,%.4f,%.4f,%.4f,%.2f,%.2f,%lld\n", s->kind, s->nt, size, a, b, c, d, e,
                (long long)differing);
    }
    sl_free(count);
    test_stencil_free(stencil);
    sl_edge_raster_free(raster);
    sl_edge_raster_free(portable);
}

/* Certificate, exact test, a move of one vertex, red triangles. */
static void run_others(const options *o, scene *s)
{
    double certify[MOST_RUNS], exact[MOST_RUNS], move[MOST_RUNS], list[MOST_RUNS];
    sl_edge_raster *raster = make_raster(s, 1024, false);
    uint8_t *red = sl_alloc(s->nt, 1);
    sl_certificate certificate = {0};
    sl_exact_overlap overlap = {0};
    int32_t found = 0;
    const int32_t moved = s->nv / 2 + (int32_t)lround(sqrt(s->nv)) / 2;
    const double home = s->uv[2 * (int64_t)moved];
    bool good = red != NULL;
    for (int32_t r = 0; r < o->runs && good; r++) { /* one after another, as edits are */
        const double begin = now();
        good &= sl_certify_embedding(s->uv, s->nt, s->tri, s->nb, s->border, &certificate) == SL_OK;
        certify[r] = now() - begin;
    }
    for (int32_t r = 0; r < o->runs && good; r++) {
        const double t1 = now();
        good &= sl_overlap_exact(s->uv, s->nt, s->tri, NULL, red, &overlap) == SL_OK;
        const double t2 = now();
        s->uv[2 * (int64_t)moved] = home + 0.05;
        good &= sl_edge_raster_move(raster, s->uv, 1, &moved, NULL) == SL_OK;
        const double t3 = now();
        good &= sl_edge_raster_red_triangles(raster, s->uv, NULL, red, &found) == SL_OK;
        const double t4 = now();
        s->uv[2 * (int64_t)moved] = home;
        good &= sl_edge_raster_move(raster, s->uv, 1, &moved, NULL) == SL_OK;
        exact[r] = t2 - t1;
        move[r] = t3 - t2;
        list[r] = t4 - t3;
    }
    if (!good) {
        exit(1);
    }
    printf("%s %8d  certificate %.3f ms (%s)  exact test %.2f ms (%d red)  one vertex moved at 1024^2 %.3f ms, its %d "
           "red triangles %.3f ms\n",
           s->kind, s->nt, median(certify, o->runs), certificate.embedded ? "embedded" : "not embedded",
           median(exact, o->runs), overlap.red, median(move, o->runs), found, median(list, o->runs));
    sl_free(red);
    sl_edge_raster_free(raster);
}

static void run_scene(const options *o, const scene *s, FILE *csv)
{
    for (int32_t size = 1024; size <= 4096; size *= 2) {
        run_size(o, s, size, csv);
    }
}

static int32_t number(const char *text, int32_t low, int32_t high)
{
    const long value = strtol(text, NULL, 10);
    return value < low ? low : value > high ? high : (int32_t)value;
}

int main(int argc, char **argv)
{
    options o = {.runs = 7, .most = 1000000, .threads = 0};
    for (int k = 1; k + 1 < argc; k += 2) {
        o.runs = strcmp(argv[k], "--runs") == 0 ? number(argv[k + 1], 1, MOST_RUNS) : o.runs;
        o.most = strcmp(argv[k], "--max-triangles") == 0 ? number(argv[k + 1], 100, 100000000) : o.most;
        o.threads = strcmp(argv[k], "--lp-threads") == 0 ? number(argv[k + 1], 0, 16) : o.threads;
        o.csv = strcmp(argv[k], "--csv") == 0 ? argv[k + 1] : o.csv;
    }
    FILE *csv = o.csv != NULL ? fopen(o.csv, "w") : NULL;
    if (csv != NULL) {
        fprintf(csv, "kind,triangles,size,ours,portable,llvmpipe,times,portable_times,differing\n");
    }
    for (int32_t n = 10000; n <= o.most; n *= 10) {
        scene mesh, soup;
        make_mesh(&mesh, n);
        make_soup(&soup, &mesh);
        run_others(&o, &mesh);
        run_scene(&o, &mesh, csv);
        run_scene(&o, &soup, csv);
        scene_clear(&mesh);
        scene_clear(&soup);
    }
    if (csv != NULL) {
        fclose(csv);
    }
    return 0;
}
