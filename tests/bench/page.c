/* How fast the page is: frames while orbiting, updates while an angle is dragged, the time to the first picture. A
 * client without a browser talks to the server as the page does; milliseconds from asking to having the frames.
 *
 *     page [--frames N] [--csv FILE]
 */
#define _POSIX_C_SOURCE 200809L
#include "generators.h"
#include "support/ws_client.h"
#include "view/server.h"

#include <cblas.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>
#include <time.h>

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

typedef struct house {
    sl_session *session;
    sl_view_server *server;
    sl_generated *mesh;
    thrd_t thread;
    atomic_bool stop;
    ws_client client;
    double first_picture;
} house;

static bool on_stop(void *user)
{
    return atomic_load(&((house *)user)->stop);
}

static int serve(void *user)
{
    return sl_view_serve(((house *)user)->server) == SL_OK ? 0 : 1;
}

static void look(house *h, const char *pane, double azimuth, int width, int height)
{
    char text[256];
    const bool space = strcmp(pane, "3d") == 0;
    snprintf(text, sizeof text,
             "{\"t\":\"look\",\"pane\":\"%s\",\"w\":%d,\"h\":%d,\"azimuth\":%.3f,\"elevation\":20,\"zoom\":1,\"x\":%s,"
             "\"y\":%s}",
             pane, width, height, azimuth, space ? "0" : "0.5", space ? "0" : "0.5");
    ws_say(&h->client, text);
}

/* Waits for so many frames (and a state, if asked for), each answered as the page does. */
static bool wait_frames(house *h, int wanted, bool state)
{
    while ((wanted > 0 || state) && !h->client.closed) {
        char *data = NULL;
        size_t size = 0;
        const int kind = ws_hear(&h->client, &data, &size);
        if (kind == WS_BINARY && size > 20) {
            wanted--;
            ws_say(&h->client, strstr(data + 2, "\"pane\":\"3d\"") != NULL ? "{\"t\":\"seen\",\"pane\":\"3d\"}"
                                                                           : "{\"t\":\"seen\",\"pane\":\"uv\"}");
        }
        if (kind == WS_TEXT && strstr(data, "\"t\":\"state\"") != NULL) {
            state = false;
        }
        if (kind == WS_TEXT && strstr(data, "\"refused\"") != NULL) {
            fprintf(stderr, "refused: %s\n", data);
            free(data);
            return false;
        }
        free(data);
    }
    return !h->client.closed;
}

static bool open_house(house *h, const char *model, int32_t scale, const sl_context *context)
{
    const sl_generator *generator = sl_generator_find(model);
    const sl_action open = sl_action_default(SL_ACTION_OPEN);
    sl_polygons polygons;
    sl_diag diag = sl_diag_none();
    *h = (house){0};
    if (generator == NULL || generator->make(1, scale, &h->mesh) != SL_OK) {
        return false;
    }
    const double start = now_ms();
    sl_generated_polygons(h->mesh, &polygons);
    const sl_view_def def = {.title = model, .stop = on_stop, .stop_user = h};
    if (sl_session_create(&polygons, NULL, &open, NULL, context, &h->session, &diag) != SL_OK ||
        sl_view_open(h->session, NULL, &def, context, &h->server, &diag) != SL_OK ||
        thrd_create(&h->thread, serve, h) != thrd_success ||
        !ws_open(&h->client, sl_view_port(h->server), strstr(sl_view_url(h->server), "token=") + 6, NULL)) {
        return false;
    }
    look(h, "3d", 35.0, 640, 640);
    const bool seen = wait_frames(h, 1, false);
    h->first_picture = now_ms() - start;
    return seen;
}

static void close_house(house *h)
{
    ws_close(&h->client);
    atomic_store(&h->stop, true);
    thrd_join(h->thread, NULL);
    sl_view_close(h->server);
    sl_session_free(h->session);
    sl_generated_free(h->mesh);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void report(FILE *csv, const char *what, const char *model, int32_t triangles, double *ms, int count)
{
    qsort(ms, (size_t)count, sizeof *ms, ascending);
    const double p50 = ms[count / 2], p95 = ms[count * 95 / 100], p99 = ms[count * 99 / 100];
    printf("%-34s %-6s %8d triangles  p50 %7.1f  p95 %7.1f  p99 %7.1f ms  %6.1f a second\n", what, model,
           (int)triangles, p50, p95, p99, 1e3 / p50);
    if (csv != NULL) {
        fprintf(csv, "%s,%s,%d,%.2f,%.2f,%.2f\n", what, model, (int)triangles, p50, p95, p99);
    }
}

static int orbit(FILE *csv, const char *model, int32_t scale, int frames, const sl_context *context)
{
    house h;
    double *ms = calloc((size_t)frames, sizeof *ms);
    if (ms == NULL || !open_house(&h, model, scale, context)) {
        free(ms);
        return 1;
    }
    for (int k = 0; k < frames; k++) {
        const double start = now_ms();
        look(&h, "3d", 35.0 + 3.0 * k, 640, 640);
        if (!wait_frames(&h, 1, false)) {
            break;
        }
        ms[k] = now_ms() - start;
    }
    report(csv, "orbit; 640 x 640", model, sl_session_triangulation(h.session)->nt, ms, frames);
    free(ms);
    close_house(&h);
    return 0;
}

/* A corner on the border of the largest chart, where there is room to turn. */
static int32_t border_corner(const sl_session *session, int32_t *triangles, double *angle)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    int32_t best = -1, slot = 0, most = 0;
    for (int32_t s = 0; s < sl_session_slots(session); s++) {
        sl_session_chart chart;
        sl_session_chart_info(session, s, &chart);
        if (chart.faces > most && chart.copy_of < 0) {
            most = chart.faces;
            slot = s;
        }
    }
    for (int32_t h = 0; h < mesh->nh && best < 0; h++) {
        if (sl_session_face_chart(session)[mesh->face[h]] == slot && mesh->twin[h] < 0) {
            *angle = sl_session_planar_angle(session, h);
            best = *angle > 150.0 && *angle < 210.0 ? h : -1;
        }
    }
    *triangles = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        *triangles += sl_session_face_chart(session)[f] == slot ? sl_degree(mesh, f) - 2 : 0;
    }
    return best;
}

static int drag(FILE *csv, const char *model, int32_t scale, int frames, const sl_context *context)
{
    house h;
    int32_t triangles = 0, corner[2];
    double angle = 180.0, *ms = calloc((size_t)frames, sizeof *ms);
    if (ms == NULL || !open_house(&h, model, scale, context)) {
        free(ms);
        return 1;
    }
    const int32_t at = border_corner(h.session, &triangles, &angle);
    int done = 0;
    look(&h, "uv", 0.0, 640, 640);
    bool going = at >= 0 && wait_frames(&h, 1, false);
    sl_session_name_corner(h.session, at >= 0 ? at : 0, corner);
    for (; going && done < frames; done++) {
        char text[256];
        const double start = now_ms();
        snprintf(text, sizeof text, "{\"t\":\"drag\",\"line\":{\"do\":\"angle\",\"corner\":[%d,%d],\"degrees\":%.3f}}",
                 (int)corner[0], (int)corner[1], angle + 20.0 * sin(0.15 * done));
        ws_say(&h.client, text);
        going = wait_frames(&h, 2, true);
        ms[done] = now_ms() - start;
    }
    if (done > 0) {
        report(csv, "angle drag; both panes", model, triangles, ms, done);
    }
    report(csv, "start to first picture", model, sl_session_triangulation(h.session)->nt, &h.first_picture, 1);
    free(ms);
    close_house(&h);
    return 0;
}

int main(int argc, char **argv)
{
    int frames = 100;
    FILE *csv = NULL;
    sl_thread_pool *pool = NULL;
    for (int a = 1; a + 1 < argc; a += 2) {
        if (strcmp(argv[a], "--frames") == 0) {
            frames = atoi(argv[a + 1]);
        } else if (strcmp(argv[a], "--csv") == 0) {
            csv = fopen(argv[a + 1], "w");
        }
    }
    openblas_set_num_threads(1);
    if (frames < 1 || sl_thread_pool_create(sl_processor_count(), &pool) != SL_OK) {
        fprintf(stderr, "usage: page [--frames N] [--csv FILE]\n");
        return 2;
    }
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    if (csv != NULL) {
        fprintf(csv, "what,model,triangles,p50_ms,p95_ms,p99_ms\n");
    }
    int failed = drag(csv, "hand", 1, frames, &context);
    failed |= drag(csv, "hand", 2, frames, &context);
    failed |= orbit(csv, "rock", 3, frames, &context);
    if (csv != NULL) {
        failed |= fclose(csv) != 0;
    }
    sl_thread_pool_free(pool);
    return failed;
}
