/* HTTP and WebSocket by civetweb. */
#include "view/server_internal.h"

#include "base/memory.h"

#include <civetweb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 1, BINARY = 2, CLOSE = 8, MESSAGES_A_SECOND = 400, BURST = 800 };

void sl_view_log(sl_view_server *server, const char *what, const char *why)
{
    char line[512];
    if (server->def.log != NULL) {
        snprintf(line, sizeof line, "%s: %s", what, why);
        server->def.log(server->def.log_user, line);
    }
}

static void plain_answer(struct mg_connection *connection, const char *status, const char *text)
{
    mg_printf(connection,
              "HTTP/1.1 %s\r\nContent-Type: text/plain\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
              "Connection: close\r\n\r\n%s",
              status, strlen(text), text);
}

static bool has_token(const sl_view_server *server, const struct mg_request_info *info)
{
    char token[SL_GUARD_TOKEN + 1];
    const char *query = info->query_string;
    return query != NULL && mg_get_var(query, strlen(query), "token", token, sizeof token) > 0 &&
           sl_guard_same(token, server->token);
}

static void file_answer(const sl_view_server *server, struct mg_connection *connection, const sl_page_file *file)
{
    mg_printf(connection,
              "HTTP/1.1 200 OK\r\nContent-Type: %s\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
              "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nX-Frame-Options: DENY\r\n"
              "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: "
              "data:; connect-src ws://127.0.0.1:%d ws://localhost:%d\r\nConnection: close\r\n\r\n",
              file->type, file->size, (int)server->port, (int)server->port);
    mg_write(connection, file->data, file->size);
}

/* Every request that is no WebSocket. */
static int on_request(struct mg_connection *connection, void *user)
{
    sl_view_server *server = user;
    const struct mg_request_info *info = mg_get_request_info(connection);
    const char *path = info->local_uri != NULL ? info->local_uri : "";
    if (!sl_guard_host(mg_get_header(connection, "Host"), server->port)) {
        sl_view_log(server, "refused", "a request for another host");
        plain_answer(connection, "403 Forbidden", "This server answers to 127.0.0.1 alone.\n");
        return 403;
    }
    if (strcmp(info->request_method, "GET") != 0) {
        plain_answer(connection, "405 Method Not Allowed", "Only GET.\n");
        return 405;
    }
    const bool front = strcmp(path, "/") == 0;
    if (front && !has_token(server, info)) {
        sl_view_log(server, "refused", "a request without the token");
        plain_answer(connection, "403 Forbidden",
                     "Open the whole address that seamlab printed: its token is missing.\n");
        return 403;
    }
    for (int32_t k = 0; k < sl_page_file_count; k++) {
        if (strcmp(path, sl_page_files[k].path) == 0) {
            file_answer(server, connection, &sl_page_files[k]);
            return 200;
        }
    }
    plain_answer(connection, "404 Not Found", "Nothing here.\n");
    return 404;
}

/* 0 lets it in. */
static int on_connect(const struct mg_connection *connection, void *user)
{
    sl_view_server *server = user;
    const char *why = NULL;
    if (!sl_guard_host(mg_get_header(connection, "Host"), server->port)) {
        why = "a socket for another host";
    } else if (!sl_guard_origin(mg_get_header(connection, "Origin"), server->port)) {
        why = "a socket from another page";
    } else if (!has_token(server, mg_get_request_info(connection))) {
        why = "a socket without the token";
    }
    if (why != NULL) {
        sl_view_log(server, "refused", why);
    }
    return why != NULL;
}

static void on_ready(struct mg_connection *connection, void *user)
{
    sl_view_server *server = user;
    bool room = false;
    mtx_lock(&server->lock);
    for (int k = 0; k < SL_VIEW_CLIENTS && !room; k++) {
        if (server->client[k].connection == NULL) {
            server->client[k] = (sl_view_client){connection, ++server->clients_so_far,
                                                 sl_guard_bucket_full(MESSAGES_A_SECOND, BURST, sl_view_now())};
            room = true;
        }
    }
    cnd_signal(&server->wake);
    mtx_unlock(&server->lock);
    if (!room) {
        sl_view_log(server, "refused", "too many pages at once");
        mg_websocket_write(connection, CLOSE, "", 0);
    }
}

/* Of what only the newest counts, an older one that still waits is replaced. */
static bool replaces(const sl_message *a, const sl_message *b)
{
    return a->kind == b->kind && a->pane == b->pane &&
           (a->kind == SL_MESSAGE_LOOK || a->kind == SL_MESSAGE_AT || a->kind == SL_MESSAGE_DRAG);
}

/* Takes the message over. false: the queue is full. */
static bool enqueue(sl_view_server *server, uint64_t client, sl_message *message)
{
    for (int32_t k = server->queued - 1; k >= 0 && server->queue[k].client == client; k--) {
        if (replaces(&server->queue[k].message, message)) {
            sl_message_clear(&server->queue[k].message);
            server->queue[k].message = *message;
            return true;
        }
        if (message->kind != SL_MESSAGE_LOOK && message->kind != SL_MESSAGE_AT) {
            break; /* actions keep their order among each other */
        }
    }
    if (server->queued == SL_VIEW_QUEUE) {
        return false;
    }
    server->queue[server->queued++] = (sl_view_entry){client, *message};
    return true;
}

static sl_view_client *client_of(sl_view_server *server, const struct mg_connection *connection)
{
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        if (server->client[k].connection == connection) {
            return &server->client[k];
        }
    }
    return NULL;
}

static int on_data(struct mg_connection *connection, int flags, char *data, size_t size, void *user)
{
    sl_view_server *server = user;
    sl_message message = {0};
    sl_diag diag = sl_diag_none();
    const char *why = NULL;
    if ((flags & 15) == CLOSE) {
        return 0;
    }
    if ((flags & 15) != TEXT || (flags & 128) == 0) {
        return 1; /* pings are answered by civetweb; whole texts are all that is understood */
    }
    const sl_status status = sl_message_parse(data, (int64_t)size, &message, &diag);
    mtx_lock(&server->lock);
    sl_view_client *client = client_of(server, connection);
    const bool slow_enough = client != NULL && sl_guard_take(&client->bucket, sl_view_now());
    if (client == NULL || !slow_enough) {
        why = client == NULL ? "" : "too many messages a second";
    } else if (status != SL_OK) {
        why = diag.reason;
    } else if (message.kind == SL_MESSAGE_STOP) {
        atomic_store(&server->cancel, true);
    } else if (enqueue(server, client->id, &message)) {
        message = (sl_message){0};
    } else {
        why = "too much is waiting";
    }
    cnd_signal(&server->wake);
    mtx_unlock(&server->lock);
    sl_message_clear(&message);
    if (why != NULL && why[0] != '\0') {
        char text[256];
        const int length =
            snprintf(text, sizeof text, "{\"t\":\"refused\",\"why\":\"the message was not understood\"}");
        sl_view_log(server, "message refused", why);
        mg_websocket_write(connection, TEXT, text, (size_t)length);
    }
    return client != NULL && slow_enough;
}

static void on_close(const struct mg_connection *connection, void *user)
{
    sl_view_server *server = user;
    mtx_lock(&server->lock);
    sl_view_client *client = client_of(server, connection);
    if (client != NULL) {
        client->connection = NULL;
    }
    mtx_unlock(&server->lock);
}

sl_status sl_view_listen(sl_view_server *server, sl_diag *diag)
{
    char ports[32];
    struct mg_server_port port[2];
    snprintf(ports, sizeof ports, "127.0.0.1:%d", (int)server->def.port);
    const char *options[] = {"listening_ports",
                             ports,
                             "num_threads",
                             "12",
                             "request_timeout_ms",
                             "10000",
                             "websocket_timeout_ms",
                             "3600000",
                             "enable_directory_listing",
                             "no",
                             "decode_url",
                             "yes",
                             "tcp_nodelay",
                             "1",
                             NULL};
    const struct mg_callbacks callbacks = {0};
    mg_init_library(MG_FEATURES_WEBSOCKET);
    server->http = mg_start(&callbacks, server, options);
    if (server->http == NULL || mg_get_server_ports(server->http, 2, port) < 1) {
        sl_diag_reason(diag, "cannot listen on 127.0.0.1:%d; is another program there? --port 0 takes any free one",
                       (int)server->def.port);
        return SL_IO;
    }
    server->port = port[0].port;
    mg_set_request_handler(server->http, "/", on_request, server);
    mg_set_websocket_handler(server->http, "/session", on_connect, on_ready, on_data, on_close, server);
    return SL_OK;
}

/* The lock is held while writing, so that the connection cannot go away meanwhile. */
static void send_all(sl_view_server *server, uint64_t client, int opcode, const char *data, size_t size)
{
    mtx_lock(&server->lock);
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        sl_view_client *c = &server->client[k];
        if (c->connection != NULL && (client == 0 || c->id == client)) {
            mg_websocket_write(c->connection, opcode, data, size);
        }
    }
    mtx_unlock(&server->lock);
}

void sl_view_send_text(sl_view_server *server, uint64_t client, char *text)
{
    if (text != NULL) {
        send_all(server, client, TEXT, text, strlen(text));
    }
    free(text);
}

/* Two bytes of length, low first, the head, the picture. */
void sl_view_send_frame(sl_view_server *server, uint64_t client, char *head, const uint8_t *data, int64_t size)
{
    const size_t length = head != NULL ? strlen(head) : 0;
    char *packet = sl_alloc((int64_t)length + size + 2, 1);
    if (packet != NULL && head != NULL) {
        packet[0] = (char)(length & 255);
        packet[1] = (char)(length >> 8);
        memcpy(packet + 2, head, length);
        memcpy(packet + 2 + length, data, (size_t)size);
        send_all(server, client, BINARY, packet, length + (size_t)size + 2);
    }
    sl_free(packet);
    free(head);
}
