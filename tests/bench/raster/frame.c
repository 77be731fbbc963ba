/* A frame of 1280 x 800 with depth, Gouraud light and a filtered checkerboard: ours against llvmpipe, in turns. Both
 * keep the mesh; a frame is from the new camera to the pixels in memory. CPU time of the process: medians of the turns,
 * ratios turn by turn. Then what a frame costs as JPEG.
 *   frame [--runs R] [--max-triangles N] [--lp-threads T] [--csv FILE]                                               */
#define _POSIX_C_SOURCE 200809L
#include "base/memory.h"
#include "bench/raster/frame_pipe.h"
#include "image/jpeg.h"
#include "render/frame_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_RUNS = 1000 };

typedef struct options {
    int32_t runs, most;
    const char *threads, *csv;
} options;

typedef struct torus {
    int32_t nv, nt, *tri;
    double *xyz, *uv;
    float *packed; /* PIPE_FLOATS a vertex: position, normal, UV */
} torus;

/* Milliseconds of the turns, and what llvmpipe takes in times ours. */
typedef struct turns {
    double pipe[MOST_RUNS], ours[MOST_RUNS], plain[MOST_RUNS], jpeg[MOST_RUNS];
    double times[MOST_RUNS], plain_times[MOST_RUNS];
} turns;

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* A bumpy torus of n x n quads. */
static torus make_torus(int32_t n)
{
    const double turn = 6.283185307179586;
    torus m = {.nv = n * n, .nt = 2 * n * n};
    m.tri = sl_alloc(m.nt, 3 * sizeof *m.tri);
    m.xyz = sl_alloc(m.nv, 3 * sizeof *m.xyz);
    m.uv = sl_alloc(m.nt, 6 * sizeof *m.uv);
    m.packed = sl_calloc(m.nv, PIPE_FLOATS * sizeof *m.packed);
    if (m.tri == NULL || m.xyz == NULL || m.uv == NULL || m.packed == NULL) {
        exit(1);
    }
    for (int32_t v = 0; v < m.nv; v++) {
        const double a = turn * (v % n) / n, b = turn * (v / n) / n;
        const double r = 0.4 + 0.05 * sin(3.0 * a + b) + 0.03 * cos(2.0 * b) + 0.02 * sin(17.0 * a) * cos(13.0 * b);
        const double p[3] = {(1.0 + r * cos(b)) * cos(a), r * sin(b), (1.0 + r * cos(b)) * sin(a)};
        const double up[3] = {cos(b) * cos(a), sin(b), cos(b) * sin(a)};
        for (int k = 0; k < 3; k++) {
            m.xyz[3 * v + k] = p[k];
            m.packed[PIPE_FLOATS * v + k] = (float)p[k];
            m.packed[PIPE_FLOATS * v + 3 + k] = (float)up[k];
        }
        m.packed[PIPE_FLOATS * v + 6] = (float)(v % n) / (float)n;
        m.packed[PIPE_FLOATS * v + 7] = (float)(v / n) / (float)n;
    }
    for (int32_t q = 0; q < m.nv; q++) {
        const int32_t right = q / n * n + (q + 1) % n, below = (q / n + 1) % n * n + q % n;
        const int32_t across = (q / n + 1) % n * n + (q + 1) % n;
        const int32_t six[6] = {q, below, across, q, across, right};
        memcpy(m.tri + 6 * q, six, sizeof six);
        for (int k = 0; k < 6; k++) {
            const bool east = k == 2 || k >= 4, south = k == 1 || k == 2 || k == 4;
            m.uv[12 * q + 2 * k] = (double)(q % n + east) / n;
            m.uv[12 * q + 2 * k + 1] = (double)(q / n + south) / n;
        }
    }
    return m;
}

static void free_torus(torus *m)
{
    sl_free(m->tri);
    sl_free(m->xyz);
    sl_free(m->uv);
    sl_free(m->packed);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int32_t count)
{
    qsort(values, (size_t)count, sizeof *values, compare);
    return values[count / 2];
}

/* Share of the pixels that are background in one and not in the other: are the same things drawn? */
static double unlike(const uint8_t *ours, const uint8_t *theirs)
{
    int64_t count = 0;
    for (int32_t y = 0; y < PIPE_HEIGHT; y++) {
        for (int32_t x = 0; x < PIPE_WIDTH; x++) {
            const uint8_t *a = ours + 4 * (y * PIPE_WIDTH + x);
            const uint8_t *b = theirs + 4 * ((PIPE_HEIGHT - 1 - y) * PIPE_WIDTH + x);
            count += (a[0] == 246) != (b[0] == 246);
        }
    }
    return (double)count / ((double)PIPE_WIDTH * PIPE_HEIGHT);
}

static bool take_turn(const pipe *p, const torus *m, sl_frame *frame, bool cull, int32_t k, sl_image *const picture[2],
                      turns *took)
{
    sl_view view = sl_view_default();
    sl_camera camera;
    sl_frame_style style = sl_frame_style_default();
    uint8_t *jpeg = NULL;
    int64_t size = 0;
    view.azimuth += 0.01 * k;
    style.cull = cull;
    if (sl_camera_frame(&view, (double)PIPE_WIDTH / PIPE_HEIGHT, m->nv, NULL, m->xyz, &camera) != SL_OK) {
        return false;
    }
    double at[5] = {cpu_ms()};
    bool good = pipe_draw(p, &camera, cull, picture[1]->pixels);
    at[1] = cpu_ms();
    frame->kernels =
        sl_frame_kernels_at(1) != NULL ? sl_frame_kernels_at(1) : sl_frame_kernels_at(0); /* without AVX2 */
    good = good && sl_frame_draw(frame, &camera, &style, PIPE_WIDTH, PIPE_HEIGHT, NULL, picture[0]->pixels) == SL_OK;
    at[2] = cpu_ms();
    frame->kernels = sl_frame_kernels_best();
    good = good && sl_frame_draw(frame, &camera, &style, PIPE_WIDTH, PIPE_HEIGHT, NULL, picture[0]->pixels) == SL_OK;
    at[3] = cpu_ms();
    good = good && sl_jpeg_encode(picture[0], SL_JPEG_QUALITY, false, &jpeg, &size) == SL_OK;
    at[4] = cpu_ms();
    took->pipe[k] = at[1] - at[0];
    took->plain[k] = at[2] - at[1];
    took->ours[k] = at[3] - at[2];
    took->jpeg[k] = at[4] - at[3];
    took->times[k] = took->pipe[k] / took->ours[k];
    took->plain_times[k] = took->pipe[k] / took->plain[k];
    sl_free(jpeg);
    return good;
}

static void report(const torus *m, bool cull, int32_t runs, turns *t, double unlike_share, FILE *csv)
{
    const double theirs = median(t->pipe, runs), ours = median(t->ours, runs), plain = median(t->plain, runs);
    const double jpeg = median(t->jpeg, runs), times = median(t->times, runs);
    const double plain_times = median(t->plain_times, runs), rate = 1e3 / (ours + jpeg);
    printf("%9d  %-6s  %8.2f  %8.2f  %8.2f  %5.2f  %8.2f  %6.2f  %9.1f  %10.6f\n", m->nt, cull ? "yes" : "no", theirs,
           ours, plain, times, plain_times, jpeg, rate, unlike_share);
    if (csv != NULL) {
        fprintf(csv, "%d,%d,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.6f\n", m->nt, cull, theirs, ours, plain, times,
                plain_times, jpeg, rate, unlike_share);
    }
}

/* What frames cost and lose as JPEG: of the picture drawn last. */
static bool report_jpeg(const sl_image *image, int32_t runs)
{
    static const int32_t qualities[] = {75, 85, 90, 95};
    printf("\njpeg of a frame    quality  chroma      ms       kB  PSNR dB\n");
    for (int32_t i = 0; i < 2 * (int32_t)SL_COUNTOF(qualities); i++) {
        double took[MOST_RUNS], sum = 0.0;
        uint8_t *data = NULL;
        int64_t size = 0;
        sl_image *back = NULL;
        for (int32_t k = 0; k < runs; k++) {
            sl_free(data);
            const double start = cpu_ms();
            if (sl_jpeg_encode(image, qualities[i / 2], i % 2 != 0, &data, &size) != SL_OK) {
                return false;
            }
            took[k] = cpu_ms() - start;
        }
        if (sl_jpeg_decode("frame", data, size, &back, NULL) != SL_OK) {
            return false;
        }
        for (int64_t p = 0; p < 3 * (int64_t)PIPE_WIDTH * PIPE_HEIGHT; p++) {
            const double d = (double)back->pixels[p] - image->pixels[p / 3 * 4 + p % 3];
            sum += d * d;
        }
        printf("%26d  %6s  %6.2f  %7.1f  %7.1f\n", qualities[i / 2], i % 2 != 0 ? "4:4:4" : "4:2:0", median(took, runs),
               (double)size / 1e3, 10.0 * log10(255.0 * 255.0 * 3.0 * PIPE_WIDTH * PIPE_HEIGHT / sum));
        sl_image_free(back);
        sl_free(data);
    }
    return true;
}

static bool race(pipe *p, int32_t side, const options *o, bool jpeg, FILE *csv)
{
    static turns took;
    torus m = make_torus(side);
    const sl_frame_def def = {m.nv, m.nt, m.xyz, m.tri, m.uv, NULL};
    sl_frame *frame = NULL;
    sl_image *picture[2] = {NULL, NULL};
    pipe_load(p, m.nv, m.packed, m.nt, m.tri);
    bool good = sl_frame_create(&def, &frame) == SL_OK &&
                sl_image_create(PIPE_WIDTH, PIPE_HEIGHT, 4, &picture[0]) == SL_OK &&
                sl_image_create(PIPE_WIDTH, PIPE_HEIGHT, 4, &picture[1]) == SL_OK;
    for (int cull = 0; cull < 2 && good; cull++) {
        for (int32_t k = 0; k < o->runs && good; k++) {
            good = take_turn(p, &m, frame, cull != 0, k, picture, &took);
        }
        if (good) {
            report(&m, cull != 0, o->runs, &took, unlike(picture[0]->pixels, picture[1]->pixels), csv);
        }
    }
    good = good && (!jpeg || report_jpeg(picture[0], o->runs));
    sl_image_free(picture[0]);
    sl_image_free(picture[1]);
    sl_frame_free(frame);
    free_torus(&m);
    return good;
}

static int32_t number(const char *text, int32_t least, int32_t most)
{
    const long value = strtol(text, NULL, 10);
    return value < least ? least : value > most ? most : (int32_t)value;
}

int main(int argc, char **argv)
{
    static const int32_t sides[] = {93, 186, 373, 745};
    options o = {.runs = 25, .most = INT32_MAX, .threads = "0"};
    pipe p = {0};
    for (int k = 1; k + 1 < argc; k += 2) {
        o.runs = strcmp(argv[k], "--runs") == 0 ? number(argv[k + 1], 1, MOST_RUNS) : o.runs;
        o.most = strcmp(argv[k], "--max-triangles") == 0 ? number(argv[k + 1], 1, INT32_MAX) : o.most;
        o.threads = strcmp(argv[k], "--lp-threads") == 0 ? argv[k + 1] : o.threads;
        o.csv = strcmp(argv[k], "--csv") == 0 ? argv[k + 1] : o.csv;
    }
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", o.threads, 1);
    if (!pipe_open(&p)) {
        fprintf(stderr, "no OpenGL ES 3 without a display here\n");
        return 77;
    }
    FILE *csv = o.csv != NULL ? fopen(o.csv, "w") : NULL;
    if (csv != NULL) {
        fprintf(csv, "triangles,culled,llvmpipe,ours,plain,times,plain_times,jpeg,frames_a_second,unlike\n");
    }
    printf("%s; ours: %s\n", (const char *)glGetString(GL_RENDERER), sl_frame_kernels_best()->name);
    printf("triangles  culled  llvmpipe      ours     plain  times     plain    jpeg  frames/s     unlike\n");
    bool good = true;
    for (size_t k = 0; k < SL_COUNTOF(sides) && good; k++) {
        if (2 * sides[k] * sides[k] <= o.most) {
            good = race(&p, sides[k], &o, sides[k] == 186, csv);
        }
    }
    if (csv != NULL) {
        fclose(csv);
    }
    return good ? 0 : 1;
}
