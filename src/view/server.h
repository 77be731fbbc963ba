/* The page: a session served to browsers on this machine over HTTP and WebSocket.
 * Layer: view (may include edit, render and all below). */
#ifndef SL_VIEW_SERVER_H
#define SL_VIEW_SERVER_H

#include "edit/session.h"
#include "meshio/meshfile.h"

typedef struct sl_view_def {
    int32_t port;         /* 0 = any free one */
    const char *output;   /* where "save" writes; NULL = nowhere */
    const char *texture;  /* PNG or JPEG shown on the surface, read again when it changes; NULL = none */
    const char *title;    /* what the page calls the mesh */
    bool (*stop)(void *); /* asked some times a second; true ends sl_view_serve */
    void *stop_user;
    void (*log)(void *, const char *line); /* what was refused, one line each; nullable; called from any thread */
    void *log_user;
} sl_view_def;

typedef struct sl_view_server sl_view_server; /* opaque; borrows session, file and def's strings */

/* Listens on 127.0.0.1. file: what "save" writes the UVs into. SL_IO (the port is taken; no network), SL_OUT_OF_MEMORY.
 * diag: nullable. */
SL_NODISCARD sl_status sl_view_open(sl_session *session, const sl_meshfile *file, const sl_view_def *def,
                                    const sl_context *context, sl_view_server **out, sl_diag *diag);

/* http://127.0.0.1:port/?token=... : the secret is in it. Borrowed. */
const char *sl_view_url(const sl_view_server *server);
int32_t sl_view_port(const sl_view_server *server);

/* Answers until def.stop says so. All work on the session is done here, on the calling thread. SL_OK, or what made it
 * end. */
SL_NODISCARD sl_status sl_view_serve(sl_view_server *server);

void sl_view_close(sl_view_server *server); /* NULL is a no-op */

#endif
