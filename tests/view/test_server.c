#define _POSIX_C_SOURCE 200809L
/* The server by a client of its own: who gets in, what is answered, what a hostile page can do (nothing). */
#include "support/test_support.h"
#include "support/ws_client.h"
#include "view/server.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>
#include <time.h>
#include <unistd.h>

enum { SIDE = 9 };

/* A bent sheet of quads. */
static void make_sheet(double *xyz, int32_t *first, int32_t *index)
{
    int32_t nf = 0;
    for (int32_t i = 0; i <= SIDE; i++) {
        for (int32_t j = 0; j <= SIDE; j++) {
            double *p = xyz + 3 * (i * (SIDE + 1) + j);
            p[0] = i;
            p[1] = j;
            p[2] = 0.04 * i * i - 0.03 * i * j;
        }
    }
    for (int32_t i = 0; i < SIDE; i++) {
        for (int32_t j = 0; j < SIDE; j++) {
            const int32_t v = i * (SIDE + 1) + j;
            const int32_t corner[4] = {v, v + SIDE + 1, v + SIDE + 2, v + 1};
            memcpy(index + 4 * nf, corner, sizeof corner);
            nf++;
            first[nf] = 4 * nf;
        }
    }
}

/* A server on a thread of its own. */
typedef struct house {
    sl_session *session;
    sl_view_server *server;
    thrd_t thread;
    atomic_bool stop;
    atomic_int refused;
} house;

static bool on_stop(void *user)
{
    return atomic_load(&((house *)user)->stop);
}

static void on_log(void *user, const char *line)
{
    (void)line;
    atomic_fetch_add(&((house *)user)->refused, 1);
}

static int serve(void *user)
{
    return sl_view_serve(((house *)user)->server) == SL_OK ? 0 : 1;
}

static int open_house(void **state)
{
    static double xyz[3 * (SIDE + 1) * (SIDE + 1)];
    static int32_t first[SIDE * SIDE + 1], index[4 * SIDE * SIDE];
    house *h = calloc(1, sizeof *h);
    sl_diag diag = sl_diag_none();
    make_sheet(xyz, first, index);
    const sl_polygons sheet = {(SIDE + 1) * (SIDE + 1), SIDE * SIDE, xyz, first, index};
    const sl_action open = sl_action_default(SL_ACTION_OPEN);
    if (h == NULL || sl_session_create(&sheet, NULL, &open, NULL, NULL, &h->session, &diag) != SL_OK) {
        return -1;
    }
    const sl_view_def def = {.title = "sheet", .stop = on_stop, .stop_user = h, .log = on_log, .log_user = h};
    if (sl_view_open(h->session, NULL, &def, NULL, &h->server, &diag) != SL_OK) {
        return -1;
    }
    *state = h;
    return thrd_create(&h->thread, serve, h) == thrd_success ? 0 : -1;
}

static int close_house(void **state)
{
    house *h = *state;
    int code = 0;
    atomic_store(&h->stop, true);
    thrd_join(h->thread, &code);
    sl_view_close(h->server);
    sl_session_free(h->session);
    free(h);
    return code;
}

/* A client, and what it has heard. */
typedef struct client {
    ws_client socket;
    int texts, frames, refused, states;
} client;

static bool enter(const house *h, client *c, const char *token, const char *origin)
{
    const char *own = strstr(sl_view_url(h->server), "token=") + 6;
    *c = (client){0};
    return ws_open(&c->socket, sl_view_port(h->server), token != NULL ? token : own, origin);
}

static void say(client *c, const char *text)
{
    ws_say(&c->socket, text);
}

static void hear(client *c)
{
    char *data = NULL;
    const int kind = ws_hear(&c->socket, &data, NULL);
    c->frames += kind == WS_BINARY;
    c->texts += kind == WS_TEXT;
    c->refused += kind == WS_TEXT && strstr(data, "\"refused\"") != NULL;
    c->states += kind == WS_TEXT && strstr(data, "\"t\":\"state\"") != NULL;
    free(data);
}

/* Until the counter is there; false: the server fell silent, or hung up. */
static bool hears(client *c, const int *counter, int wanted)
{
    while (*counter < wanted && !c->socket.closed) {
        hear(c);
    }
    return *counter >= wanted;
}

static void strangers_stay_outside(void **state)
{
    house *h = *state;
    client c;
    const int before = atomic_load(&h->refused);
    assert_false(enter(h, &c, "00000000000000000000000000000000", NULL));
    assert_false(enter(h, &c, "", NULL));
    assert_false(enter(h, &c, NULL, "http://evil.example"));
    assert_false(enter(h, &c, NULL, "null"));
    assert_true(atomic_load(&h->refused) >= before + 4);
}

static int answer_to(const house *h, const char *request)
{
    const int fd = ws_connect(sl_view_port(h->server)), code = ws_ask(fd, request);
    close(fd);
    return code;
}

static void pages_are_given_to_this_machine_with_the_token(void **state)
{
    house *h = *state;
    char request[512];
    const char *token = strstr(sl_view_url(h->server), "token=") + 6;
    const int port = (int)sl_view_port(h->server);
    snprintf(request, sizeof request, "GET /?token=%s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n", token, port);
    assert_int_equal(answer_to(h, request), 200);
    snprintf(request, sizeof request, "GET / HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n", port);
    assert_int_equal(answer_to(h, request), 403);
    snprintf(request, sizeof request, "GET /?token=%s HTTP/1.1\r\nHost: evil.example:%d\r\n\r\n", token, port);
    assert_int_equal(answer_to(h, request), 403);
    snprintf(request, sizeof request, "GET /main.js HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n", port);
    assert_int_equal(answer_to(h, request), 200);
    snprintf(request, sizeof request, "GET /../../etc/passwd HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n", port);
    assert_int_not_equal(answer_to(h, request), 200);
    snprintf(request, sizeof request, "POST /?token=%s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nContent-Length: 0\r\n\r\n",
             token, port);
    assert_int_equal(answer_to(h, request), 405);
}

static const char look_3d[] =
    "{\"t\":\"look\",\"pane\":\"3d\",\"w\":320,\"h\":200,\"azimuth\":35,\"elevation\":20,\"zoom\":1,"
    "\"x\":0,\"y\":0}",
                  look_uv[] = "{\"t\":\"look\",\"pane\":\"uv\",\"w\":200,\"h\":200,\"zoom\":1,\"x\":0.5,\"y\":0.5}";

static void a_page_sees_edits_and_takes_them_back(void **state)
{
    house *h = *state;
    client c;
    assert_true(enter(h, &c, NULL, NULL));
    assert_true(hears(&c, &c.states, 1));
    const uint64_t hash = sl_session_hash(h->session);
    say(&c, look_3d);
    say(&c, look_uv);
    assert_true(hears(&c, &c.frames, 2));
    say(&c, "{\"t\":\"seen\",\"pane\":\"3d\"}");
    say(&c, "{\"t\":\"at\",\"pane\":\"3d\",\"x\":160,\"y\":100}");
    say(&c, "{\"t\":\"do\",\"line\":{\"do\":\"cut-chart\",\"facet\":0}}");
    assert_true(hears(&c, &c.states, 2));
    say(&c, "{\"t\":\"drag\",\"line\":{\"do\":\"move\",\"facet\":0,\"by\":[0.5,0]}}");
    assert_true(hears(&c, &c.states, 3));
    say(&c, "{\"t\":\"let-go\"}");
    assert_true(hears(&c, &c.states, 4));
    say(&c, "{\"t\":\"goto\",\"step\":0}");
    assert_true(hears(&c, &c.states, 5));
    say(&c, "{\"t\":\"save\"}"); /* nowhere to */
    assert_true(hears(&c, &c.refused, 1));
    ws_close(&c.socket);
    thrd_sleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    assert_true(sl_session_hash(h->session) == hash);
}

static void hostile_messages_are_answered_and_change_nothing(void **state)
{
    house *h = *state;
    client c;
    test_rng rng = test_rng_seed(5);
    assert_true(enter(h, &c, NULL, NULL));
    const uint64_t hash = sl_session_hash(h->session);
    for (int k = 0; k < 200; k++) {
        char noise[400];
        const int32_t length = test_index(&rng, sizeof noise);
        for (int32_t i = 0; i < length; i++) {
            noise[i] = (char)test_bits(&rng);
        }
        ws_say_bytes(&c.socket, noise, (size_t)length);
    }
    assert_true(hears(&c, &c.refused, 150));
    say(&c, "{\"t\":\"do\",\"line\":{\"do\":\"cut-chart\",\"facet\":999999}}");
    say(&c, "{\"t\":\"do\",\"line\":{\"do\":\"sew\",\"at\":[0,1,0],\"length\":1}}");
    say(&c, "{\"t\":\"arc\",\"at\":[2000000000,1,0]}");
    say(&c, "{\"t\":\"at\",\"pane\":\"uv\",\"x\":4096,\"y\":4096}");
    assert_true(hears(&c, &c.refused, 202));
    ws_close(&c.socket);
    assert_true(sl_session_hash(h->session) == hash);
}

static void who_says_too_much_is_cut_off(void **state)
{
    house *h = *state;
    client c;
    bool open = true;
    assert_true(enter(h, &c, NULL, NULL));
    for (int k = 0; k < 20000 && open; k++) {
        open = ws_say_bytes(&c.socket, "{\"t\":\"let-go\"}", 14);
    }
    while (!c.socket.closed) { /* what was said before it was closed, at most ten seconds of silence */
        hear(&c);
    }
    ws_close(&c.socket);
    assert_true(enter(h, &c, NULL, NULL)); /* the others do not notice */
    assert_true(hears(&c, &c.states, 1));
    ws_close(&c.socket);
}

static void no_more_pages_than_there_is_room_for(void **state)
{
    house *h = *state;
    client c[12];
    int in = 0;
    bool there[12];
    for (int k = 0; k < 10; k++) {
        there[k] = enter(h, &c[k], NULL, NULL);
    }
    for (int k = 0; k < 10; k++) {
        in += there[k] && hears(&c[k], &c[k].states, 1);
    }
    assert_int_equal(in, 8);
    for (int k = 0; k < 10; k++) {
        if (there[k]) {
            ws_close(&c[k].socket);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(strangers_stay_outside, open_house, close_house),
        cmocka_unit_test_setup_teardown(pages_are_given_to_this_machine_with_the_token, open_house, close_house),
        cmocka_unit_test_setup_teardown(a_page_sees_edits_and_takes_them_back, open_house, close_house),
        cmocka_unit_test_setup_teardown(hostile_messages_are_answered_and_change_nothing, open_house, close_house),
        cmocka_unit_test_setup_teardown(who_says_too_much_is_cut_off, open_house, close_house),
        cmocka_unit_test_setup_teardown(no_more_pages_than_there_is_room_for, open_house, close_house),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
