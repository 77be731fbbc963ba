/* What a page asks for, done on the session's thread. */
#include "view/server_internal.h"
#include "view/state.h"

#include <stdio.h>

static sl_view_page *page_by_id(sl_view_server *server, uint64_t id)
{
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        if (server->page[k].id == id) {
            return &server->page[k];
        }
    }
    return NULL;
}

static void all_stale(sl_view_server *server)
{
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        for (int pane = 0; pane < SL_PANES; pane++) {
            server->page[k].stale[pane] = true;
            server->page[k].sharp[pane] = false;
            server->page[k].moved[pane] = sl_view_now();
        }
    }
}

void sl_view_tell_state(sl_view_server *server)
{
    sl_view_send_text(server, 0,
                      sl_state_text(server->session, server->scene, server->def.output != NULL, server->textured));
}

void sl_view_changed(sl_view_server *server)
{
    if (sl_scene_view_update(server->scene, server->shown, server->outer) != SL_OK) {
        sl_view_log(server, "picture", "out of memory");
    }
    all_stale(server);
    sl_view_tell_state(server);
}

static void tell_refused(sl_view_server *server, uint64_t client, sl_status status, const sl_diag *diag)
{
    sl_view_send_text(server, client, sl_state_refused(diag, status));
}

/* An action, a drag's move or its end. */
static void act(sl_view_server *server, sl_view_entry *entry)
{
    sl_diag diag = sl_diag_none();
    const sl_action *action = &entry->message.action;
    sl_status status;
    atomic_store(&server->cancel, false);
    if (entry->message.kind == SL_MESSAGE_DRAG) {
        status = sl_session_drag(server->session, action, &server->context, &diag);
    } else if (entry->message.kind == SL_MESSAGE_RELEASE) {
        status = sl_session_release(server->session, action, &server->context, &diag);
    } else {
        status = sl_session_apply(server->session, action, &server->context, &diag);
    }
    if (status != SL_OK) {
        tell_refused(server, entry->client, status, &diag);
    }
    if (status == SL_OK || entry->message.kind == SL_MESSAGE_RELEASE) {
        sl_view_changed(server);
    }
}

static void go_to(sl_view_server *server, uint64_t client, int32_t step)
{
    int32_t cursor = 0;
    const int32_t count = sl_session_history(server->session, &cursor);
    sl_diag diag = sl_diag_none();
    const int32_t wanted = step < count ? step : count;
    sl_action action = sl_action_default(wanted < cursor ? SL_ACTION_UNDO : SL_ACTION_REDO);
    action.steps = wanted < cursor ? cursor - wanted : wanted - cursor;
    if (action.steps == 0) {
        return;
    }
    const sl_status status = sl_session_apply(server->session, &action, &server->context, &diag);
    if (status != SL_OK) {
        tell_refused(server, client, status, &diag);
    }
    sl_view_changed(server);
}

static void save(sl_view_server *server, uint64_t client, bool allow_overlap)
{
    sl_diag diag = sl_diag_none();
    sl_atlas_check check;
    char text[512];
    if (server->def.output == NULL) {
        sl_diag_reason(&diag, "nowhere to save to: start with -o OUT");
        tell_refused(server, client, SL_BAD_INPUT, &diag);
        return;
    }
    atomic_store(&server->cancel, false);
    const sl_status status = sl_session_save(server->session, server->file, server->def.output, allow_overlap,
                                             &server->context, &check, &diag);
    if (status != SL_OK) {
        tell_refused(server, client, status, &diag);
        return;
    }
    snprintf(text, sizeof text, "saved to %s%s", server->def.output, check.passed ? ": proven" : ": uncertified");
    sl_view_send_text(server, client, sl_state_said(text));
}

/* Picks from the frame that this page sees; another page's may have been drawn since. */
static void tell_hit(sl_view_server *server, sl_view_page *page, const sl_message *message)
{
    const sl_pane pane = message->pane;
    if (!page->looks[pane] || message->x < 0 || message->y < 0 || message->x >= page->look[pane].width ||
        message->y >= page->look[pane].height) {
        return;
    }
    if (server->drawn[pane] != page->id || page->stale[pane]) {
        page->stale[pane] = true;
        page->flying[pane] = false;
        sl_view_send_frames(server);
    }
    const sl_scene_hit hit = sl_scene_view_pick(server->scene, pane, message->x, message->y);
    sl_view_send_text(server, page->id, sl_state_hit(server->session, pane, &hit));
}

void sl_view_answer(sl_view_server *server, sl_view_entry *entry)
{
    sl_view_page *page = page_by_id(server, entry->client);
    const sl_message *m = &entry->message;
    if (page == NULL) {
        return;
    }
    switch (m->kind) {
    case SL_MESSAGE_LOOK:
        page->look[m->pane] = m->look;
        page->looks[m->pane] = true;
        page->stale[m->pane] = true;
        page->sharp[m->pane] = false;
        page->moved[m->pane] = sl_view_now();
        break;
    case SL_MESSAGE_SEEN:
        page->flying[m->pane] = false;
        break;
    case SL_MESSAGE_AT:
        tell_hit(server, page, m);
        break;
    case SL_MESSAGE_ARC:
        sl_view_send_text(server, entry->client, sl_state_arc(server->session, m->side));
        break;
    case SL_MESSAGE_DO:
    case SL_MESSAGE_DRAG:
    case SL_MESSAGE_RELEASE:
        act(server, entry);
        break;
    case SL_MESSAGE_LET_GO:
        sl_session_cancel_drag(server->session);
        sl_view_changed(server);
        break;
    case SL_MESSAGE_GOTO:
        go_to(server, entry->client, m->step);
        break;
    case SL_MESSAGE_SHOW:
        server->shown = m->shown;
        sl_view_changed(server);
        break;
    case SL_MESSAGE_SAVE:
        save(server, entry->client, m->overlap);
        break;
    case SL_MESSAGE_STOP:
    case SL_MESSAGE_KINDS:
        break;
    }
}
