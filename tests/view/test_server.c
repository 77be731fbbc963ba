#define _POSIX_C_SOURCE 200809L
/* The server by a client of its own: who gets in, what is answered, what a hostile page can do (nothing). */
#include "support/test_support.h"
#include "view/server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
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

/* A WebSocket client, just enough of RFC 6455, and what it has heard. */
typedef struct client {
    int fd;
    int texts, frames, refused, states;
    bool closed;
} client;

static int connect_to(const house *h)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)sl_view_port(h->server))};
    const struct timeval patience = {.tv_sec = 10};
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    assert_true(fd >= 0);
    assert_int_equal(connect(fd, (const struct sockaddr *)&address, sizeof address), 0);
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return fd;
}

/* Sends a request, reads the head of the answer; its status. */
static int ask(int fd, const char *request)
{
    char head[4096];
    size_t n = 0;
    if (send(fd, request, strlen(request), MSG_NOSIGNAL) < 0) {
        return 0;
    }
    while (n + 1 < sizeof head && recv(fd, head + n, 1, 0) == 1) {
        n++;
        if (n >= 4 && memcmp(head + n - 4, "\r\n\r\n", 4) == 0) {
            break;
        }
    }
    head[n] = '\0';
    return n > 12 ? atoi(head + 9) : 0;
}

/* false: it was not let in. */
static bool enter(const house *h, client *c, const char *token, const char *origin)
{
    char request[1024], own[64];
    const int port = (int)sl_view_port(h->server);
    snprintf(own, sizeof own, "http://127.0.0.1:%d", port);
    snprintf(request, sizeof request,
             "GET /session?token=%s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nOrigin: %s\r\nUpgrade: websocket\r\n"
             "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
             token != NULL ? token : strstr(sl_view_url(h->server), "token=") + 6, port, origin != NULL ? origin : own);
    *c = (client){.fd = connect_to(h)};
    if (ask(c->fd, request) == 101) {
        return true;
    }
    close(c->fd);
    return false;
}

static bool say_bytes(client *c, const char *data, size_t size)
{
    unsigned char head[8] = {0x81, 0};
    size_t length = 2;
    head[1] = (unsigned char)(0x80 | (size < 126 ? size : 126));
    if (size >= 126) {
        head[2] = (unsigned char)(size >> 8);
        head[3] = (unsigned char)size;
        length = 4;
    }
    unsigned char zeros[4] = {0}; /* a mask that changes nothing */
    return send(c->fd, head, length, MSG_NOSIGNAL) == (ssize_t)length && send(c->fd, zeros, 4, MSG_NOSIGNAL) == 4 &&
           send(c->fd, data, size, MSG_NOSIGNAL) == (ssize_t)size;
}

static void say(client *c, const char *text)
{
    say_bytes(c, text, strlen(text));
}

static bool receive(client *c, unsigned char *data, size_t size)
{
    for (size_t n = 0; n < size;) {
        const ssize_t got = recv(c->fd, data + n, size - n, 0);
        if (got <= 0) {
            c->closed = true;
            return false;
        }
        n += (size_t)got;
    }
    return true;
}

/* One frame from the server. */
static void hear(client *c)
{
    unsigned char head[2], more[8];
    if (!receive(c, head, 2)) {
        return;
    }
    size_t size = head[1] & 127;
    const size_t wide = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (wide > 0 && !receive(c, more, wide)) {
        return;
    }
    size = wide > 0 ? 0 : size;
    for (size_t k = 0; k < wide; k++) {
        size = 256 * size + more[k];
    }
    unsigned char *data = calloc(size + 1, 1);
    assert_non_null(data);
    if (receive(c, data, size)) {
        const int kind = head[0] & 15;
        c->frames += kind == 2;
        c->texts += kind == 1;
        c->refused += kind == 1 && strstr((char *)data, "\"refused\"") != NULL;
        c->states += kind == 1 && strstr((char *)data, "\"t\":\"state\"") != NULL;
        c->closed = c->closed || kind == 8;
    }
    free(data);
}

/* Until the counter is there; false: the server fell silent, or hung up. */
static bool hears(client *c, const int *counter, int wanted)
{
    while (*counter < wanted && !c->closed) {
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
    const int fd = connect_to(h), code = ask(fd, request);
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
    close(c.fd);
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
        say_bytes(&c, noise, (size_t)length);
    }
    assert_true(hears(&c, &c.refused, 150));
    say(&c, "{\"t\":\"do\",\"line\":{\"do\":\"cut-chart\",\"facet\":999999}}");
    say(&c, "{\"t\":\"do\",\"line\":{\"do\":\"sew\",\"at\":[0,1,0],\"length\":1}}");
    say(&c, "{\"t\":\"arc\",\"at\":[2000000000,1,0]}");
    say(&c, "{\"t\":\"at\",\"pane\":\"uv\",\"x\":4096,\"y\":4096}");
    assert_true(hears(&c, &c.refused, 202));
    close(c.fd);
    assert_true(sl_session_hash(h->session) == hash);
}

static void who_says_too_much_is_cut_off(void **state)
{
    house *h = *state;
    client c;
    bool open = true;
    assert_true(enter(h, &c, NULL, NULL));
    for (int k = 0; k < 20000 && open; k++) {
        open = say_bytes(&c, "{\"t\":\"let-go\"}", 14);
    }
    while (!c.closed) { /* what was said before it was closed, at most ten seconds of silence */
        hear(&c);
    }
    close(c.fd);
    assert_true(enter(h, &c, NULL, NULL)); /* the others do not notice */
    assert_true(hears(&c, &c.states, 1));
    close(c.fd);
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
            close(c[k].fd);
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
