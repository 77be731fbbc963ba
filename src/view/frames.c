/* Frames: a quick one while something moves, a sharp one when it rests. */
#include "view/server_internal.h"
#include "view/state.h"

#include "base/memory.h"
#include "image/jpeg.h"
#include "image/png.h"

enum { QUALITY = 82 };

static const double rest = 0.18; /* seconds without a movement */

static sl_status draw(sl_view_server *server, sl_view_page *page, sl_pane pane, bool sharp)
{
    sl_status status = SL_OK;
    uint8_t *data = NULL;
    int64_t size = 0;
    const sl_look *look = &page->look[pane];
    const int64_t bytes = 4 * (int64_t)look->width * look->height;
    if (bytes > server->rgba_size) {
        sl_free(server->rgba);
        server->rgba = sl_alloc(bytes, 1);
        server->rgba_size = server->rgba != NULL ? bytes : 0;
    }
    if (server->rgba == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_scene_view_draw(server->scene, pane, look, server->outer, server->rgba));
    server->drawn[pane] = page->id;
    const sl_image image = {look->width, look->height, 4, server->rgba};
    SL_TRY(sharp ? sl_png_encode(&image, &data, &size) : sl_jpeg_encode(&image, QUALITY, false, &data, &size));
    const sl_camera camera = sl_scene_view_camera(server->scene, pane, look);
    sl_view_send_frame(server, page->id, sl_state_frame(pane, look, &camera, sharp), data, size);
cleanup:
    sl_free(data);
    return status;
}

static bool due(const sl_view_page *page, int pane, bool *sharp)
{
    const bool resting = page->look[pane].still || sl_view_now() - page->moved[pane] > rest;
    if (!page->looks[pane] || page->flying[pane]) {
        return false;
    }
    *sharp = !page->stale[pane] && resting && !page->sharp[pane];
    return page->stale[pane] || *sharp;
}

bool sl_view_send_frames(sl_view_server *server)
{
    bool any = false;
    for (int k = 0; k < SL_VIEW_CLIENTS; k++) {
        sl_view_page *page = &server->page[k];
        for (int pane = 0; pane < SL_PANES && page->id != 0; pane++) {
            bool sharp = false;
            if (!due(page, pane, &sharp)) {
                continue;
            }
            page->stale[pane] = false;
            page->sharp[pane] = sharp;
            page->flying[pane] = true;
            any = true;
            if (draw(server, page, (sl_pane)pane, sharp) != SL_OK) {
                sl_view_log(server, "frame", "out of memory");
                page->flying[pane] = false;
            }
        }
    }
    return any;
}
