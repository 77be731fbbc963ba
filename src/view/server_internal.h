/* The server's parts. The network's threads put messages into the queue and touch nothing else; one thread owns the
 * session, draws, and writes to the pages.
 * Layer: view. */
#ifndef SL_VIEW_SERVER_INTERNAL_H
#define SL_VIEW_SERVER_INTERNAL_H

#include "view/guard.h"
#include "view/message.h"
#include "view/scene.h"
#include "view/server.h"

#include <stdatomic.h>
#include <threads.h>

enum { SL_VIEW_CLIENTS = 8, SL_VIEW_QUEUE = 256 };

/* A connection, as the network's threads know it; guarded by the lock. */
typedef struct sl_view_client {
    struct mg_connection *connection; /* NULL: free */
    uint64_t id;
    sl_guard_bucket bucket;
} sl_view_client;

/* The same page, as the session's thread knows it; nobody else touches it. */
typedef struct sl_view_page {
    uint64_t id; /* 0: free */
    bool greeted;
    sl_look look[SL_PANES];
    bool looks[SL_PANES];   /* it has said how */
    bool stale[SL_PANES];   /* a frame is due */
    bool sharp[SL_PANES];   /* the last one was a sharp one of what it looks at now */
    bool flying[SL_PANES];  /* a frame was sent and not seen yet */
    double moved[SL_PANES]; /* when it last looked elsewhere [s] */
} sl_view_page;

typedef struct sl_view_entry {
    uint64_t client;
    sl_message message;
} sl_view_entry;

struct sl_view_server {
    sl_session *session;
    const sl_meshfile *file;
    sl_view_def def;
    sl_context context; /* of work on the session: tells the pages how far it is */
    const sl_context *outer;
    sl_scene_view *scene;
    sl_shown shown;
    bool textured;           /* a texture is there */
    int64_t texture_written; /* when its file was */
    double texture_asked;    /* when that was looked at [s] */
    struct mg_context *http;
    int32_t port;
    char token[SL_GUARD_TOKEN], url[128];
    uint8_t *rgba;
    int64_t rgba_size;
    uint64_t drawn[SL_PANES]; /* the client whose frame was drawn last: what can be picked from */
    double told;              /* when progress was told last [s] */

    sl_view_page page[SL_VIEW_CLIENTS];

    mtx_t lock;
    cnd_t wake;
    bool locks; /* they were made */
    sl_view_client client[SL_VIEW_CLIENTS];
    uint64_t clients_so_far;
    int32_t queued;
    sl_view_entry queue[SL_VIEW_QUEUE];
    atomic_bool cancel;
};

double sl_view_now(void); /* seconds */

/* network.c */
SL_NODISCARD sl_status sl_view_listen(sl_view_server *server, sl_diag *diag);
void sl_view_send_text(sl_view_server *server, uint64_t client, char *text); /* 0 = to all; takes the text (free) */
void sl_view_send_frame(sl_view_server *server, uint64_t client, char *head, const uint8_t *data, int64_t size);
void sl_view_log(sl_view_server *server, const char *what, const char *why);

/* answer.c: one message, on the session's thread. */
void sl_view_answer(sl_view_server *server, sl_view_entry *entry);
void sl_view_tell_state(sl_view_server *server);
void sl_view_changed(sl_view_server *server); /* pictures and state are told anew */

/* frames.c: sends what is due; returns whether anything was. */
bool sl_view_send_frames(sl_view_server *server);

/* page_files.c, made at build time from page/. */
typedef struct sl_page_file {
    const char *path, *type;
    const unsigned char *data;
    size_t size;
} sl_page_file;
extern const sl_page_file sl_page_files[];
extern const int32_t sl_page_file_count;

#endif
