#define _POSIX_C_SOURCE 200809L
#include "support/ws_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

int ws_connect(int32_t port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    const struct timeval patience = {.tv_sec = 10};
    const int at_once = 1, fd = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (fd >= 0 && connect(fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        close(fd);
        return -1;
    }
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    return fd;
}

int ws_ask(int fd, const char *request)
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

bool ws_open(ws_client *client, int32_t port, const char *token, const char *origin)
{
    char request[1024], own[64];
    snprintf(own, sizeof own, "http://127.0.0.1:%d", (int)port);
    snprintf(request, sizeof request,
             "GET /session?token=%s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nOrigin: %s\r\nUpgrade: websocket\r\n"
             "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
             token, (int)port, origin != NULL ? origin : own);
    *client = (ws_client){.fd = ws_connect(port)};
    if (client->fd < 0) {
        return false;
    }
    if (ws_ask(client->fd, request) == 101) {
        return true;
    }
    close(client->fd);
    return false;
}

void ws_close(ws_client *client)
{
    close(client->fd);
    client->closed = true;
}

bool ws_say_bytes(ws_client *client, const char *data, size_t size)
{
    unsigned char *packet = malloc(size + 8);
    size_t length = 2;
    if (packet == NULL) {
        return false;
    }
    packet[0] = 0x81;
    packet[1] = (unsigned char)(0x80 | (size < 126 ? size : 126));
    if (size >= 126) {
        packet[2] = (unsigned char)(size >> 8);
        packet[3] = (unsigned char)size;
        length = 4;
    }
    memset(packet + length, 0, 4); /* a mask that changes nothing */
    memcpy(packet + length + 4, data, size);
    length += 4 + size;
    const bool sent = send(client->fd, packet, length, MSG_NOSIGNAL) == (ssize_t)length;
    free(packet);
    return sent;
}

bool ws_say(ws_client *client, const char *text)
{
    return ws_say_bytes(client, text, strlen(text));
}

static bool receive(ws_client *client, void *data, size_t size)
{
    for (size_t n = 0; n < size;) {
        const ssize_t got = recv(client->fd, (char *)data + n, size - n, 0);
        if (got <= 0) {
            client->closed = true;
            return false;
        }
        n += (size_t)got;
    }
    return true;
}

int ws_hear(ws_client *client, char **data, size_t *size)
{
    unsigned char head[2], more[8];
    if (data != NULL) {
        *data = NULL;
    }
    if (!receive(client, head, 2)) {
        return 0;
    }
    size_t length = head[1] & 127;
    const size_t wide = length == 126 ? 2 : length == 127 ? 8 : 0;
    if (wide > 0 && !receive(client, more, wide)) {
        return 0;
    }
    length = wide > 0 ? 0 : length;
    for (size_t k = 0; k < wide; k++) {
        length = 256 * length + more[k];
    }
    char *text = length < (size_t)1 << 28 ? calloc(length + 1, 1) : NULL;
    if (text == NULL || !receive(client, text, length)) {
        free(text);
        return 0;
    }
    client->closed = client->closed || (head[0] & 15) == WS_CLOSE;
    if (size != NULL) {
        *size = length;
    }
    if (data != NULL) {
        *data = text;
    } else {
        free(text);
    }
    return head[0] & 15;
}
