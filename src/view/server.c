#include "view/server_internal.h"
#include "view/state.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/jpeg.h"

#include <civetweb.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

double sl_view_now(void)
{
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Work on the session tells all pages how far it is, at most ten times a second, and hears their "stop". */
static bool on_progress(void *user, const char *stage, double fraction)
{
    sl_view_server *server = user;
    const double now = sl_view_now();
    if (now - server->told > 0.1) {
        server->told = now;
        sl_view_send_text(server, 0, sl_state_progress(stage, fraction));
    }
    return !atomic_load(&server->cancel) && !(server->def.stop != NULL && server->def.stop(server->def.stop_user));
}

sl_status sl_view_open(sl_session *session, const sl_meshfile *file, const sl_view_def *def, const sl_context *context,
                       sl_view_server **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_view_server *server = sl_calloc(1, sizeof *server);
    *out = NULL;
    if (server == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    server->session = session;
    server->file = file;
    server->def = *def;
    server->outer = context;
    server->context = sl_quiet_context(context);
    server->context.progress = on_progress;
    server->context.progress_user = server;
    server->locks = mtx_init(&server->lock, mtx_plain) == thrd_success && cnd_init(&server->wake) == thrd_success;
    if (!server->locks) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_guard_token(server->token));
    SL_TRY(sl_scene_view_create(session, &server->scene));
    SL_TRY(sl_scene_view_update(server->scene, server->shown, context));
    SL_TRY(sl_view_listen(server, diag));
    snprintf(server->url, sizeof server->url, "http://127.0.0.1:%d/?token=%s", (int)server->port, server->token);
cleanup:
    if (status != SL_OK) {
        sl_view_close(server);
        server = NULL;
    }
    *out = server;
    return status;
}

const char *sl_view_url(const sl_view_server *server)
{
    return server->url;
}

int32_t sl_view_port(const sl_view_server *server)
{
    return server->port;
}

/* Waits for messages, at most a twentieth of a second. Takes them all, and learns which pages there are. */
static int32_t take_messages(sl_view_server *server, sl_view_entry *entries, bool wait)
{
    mtx_lock(&server->lock);
    if (server->queued == 0 && wait) {
        struct timespec until;
        timespec_get(&until, TIME_UTC);
        until.tv_nsec += 50000000;
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        cnd_timedwait(&server->wake, &server->lock, &until);
    }
    const int32_t count = server->queued;
    memcpy(entries, server->queue, (size_t)count * sizeof *entries);
    server->queued = 0;
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        const uint64_t id = server->client[k].connection != NULL ? server->client[k].id : 0;
        if (server->page[k].id != id) {
            server->page[k] = (sl_view_page){.id = id};
        }
    }
    mtx_unlock(&server->lock);
    return count;
}

/* New pages are told what there is. */
static void greet(sl_view_server *server)
{
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        sl_view_page *page = &server->page[k];
        if (page->id != 0 && !page->greeted) {
            page->greeted = true;
            sl_view_send_text(server, page->id, sl_state_said(server->def.title));
            sl_view_send_text(
                server, page->id,
                sl_state_text(server->session, server->scene, server->def.output != NULL, server->textured));
        }
    }
}

/* Reads the texture again when its file was written; what cannot be read (half written) stays as it was. */
static void follow_texture(sl_view_server *server)
{
    sl_diag diag = sl_diag_none();
    sl_image *image = NULL;
    const double now = sl_view_now();
    if (server->def.texture == NULL || now - server->texture_asked < 0.3) {
        return;
    }
    server->texture_asked = now;
    const int64_t written = sl_file_written(server->def.texture);
    if (written < 0 || (server->textured && written == server->texture_written)) {
        return;
    }
    if (sl_picture_read(server->def.texture, &image, &diag) == SL_OK) {
        server->texture_written = written;
        server->textured = true;
        sl_scene_view_set_texture(server->scene, image);
        sl_view_changed(server);
    }
}

sl_status sl_view_serve(sl_view_server *server)
{
    sl_view_entry *entries = sl_alloc(SL_VIEW_QUEUE, sizeof *entries);
    bool busy = false;
    if (entries == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    while (server->def.stop == NULL || !server->def.stop(server->def.stop_user)) {
        const int32_t count = take_messages(server, entries, !busy);
        greet(server);
        follow_texture(server);
        for (int32_t k = 0; k < count; k++) {
            sl_view_answer(server, &entries[k]);
            sl_message_clear(&entries[k].message);
        }
        busy = sl_view_send_frames(server);
    }
    sl_free(entries);
    return SL_OK;
}

void sl_view_close(sl_view_server *server)
{
    if (server == NULL) {
        return;
    }
    if (server->http != NULL) {
        mg_stop(server->http); /* its threads are gone after this */
        mg_exit_library();
    }
    for (int32_t k = 0; k < server->queued; k++) {
        sl_message_clear(&server->queue[k].message);
    }
    sl_scene_view_free(server->scene);
    sl_free(server->rgba);
    if (server->locks) {
        mtx_destroy(&server->lock);
        cnd_destroy(&server->wake);
    }
    sl_free(server);
}
