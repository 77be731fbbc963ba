/* A WebSocket client, just enough of RFC 6455 to talk to the page's server on this machine. */
#ifndef SL_TESTS_WS_CLIENT_H
#define SL_TESTS_WS_CLIENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WS_TEXT = 1, WS_BINARY = 2, WS_CLOSE = 8 };

typedef struct ws_client {
    int fd;
    bool closed; /* the server hung up, or was silent for ten seconds */
} ws_client;

/* A connection to 127.0.0.1; -1 = none. */
int ws_connect(int32_t port);

/* Sends a whole HTTP request, reads the head of the answer; its status, 0 = none. */
int ws_ask(int fd, const char *request);

/* Upgrades to a WebSocket; false: not let in. origin: NULL = as the server's own page. */
bool ws_open(ws_client *client, int32_t port, const char *token, const char *origin);
void ws_close(ws_client *client);

/* Texts of less than 64 KiB. */
bool ws_say_bytes(ws_client *client, const char *data, size_t size);
bool ws_say(ws_client *client, const char *text);

/* The next message, terminated: its kind, 0 when there is none any more. *data (free) and *size; data may be NULL. */
int ws_hear(ws_client *client, char **data, size_t *size);

#endif
