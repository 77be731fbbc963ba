/* The orientation of most triangles, and which have another or none, kept up to date while vertices move. */
#include "overlap/edge_raster_internal.h"

#include "base/memory.h"

#include <string.h>

static int8_t most_of(const sl_edge_raster *r)
{
    return r->positive >= r->negative ? 1 : -1;
}

static sl_status push(sl_edge_raster *r, int32_t t)
{
    if (r->odds == r->odd_capacity) {
        const sl_status status = sl_reserve((void **)&r->odd, &r->odd_capacity, r->odds + 1, sizeof *r->odd);
        if (status != SL_OK) {
            return status;
        }
    }
    if (r->odd_place != NULL) {
        r->odd_place[t] = (int32_t)r->odds;
    }
    r->odd[r->odds++] = t;
    return SL_OK;
}

static void take_out(sl_edge_raster *r, int32_t t)
{
    const int32_t place = r->odd_place[t], last = r->odd[--r->odds];
    r->odd[place] = last;
    r->odd_place[last] = place;
    r->odd_place[t] = -1;
}

/* The list from the signs. The places of what was in it are taken back first, so that no pass over all is needed. */
static sl_status list_odd(sl_edge_raster *r)
{
    for (int64_t k = 0; k < r->odds && r->odd_place != NULL; k++) {
        r->odd_place[r->odd[k]] = -1;
    }
    r->odds = 0;
    r->most = most_of(r);
    const int32_t count = r->nt - (r->most > 0 ? r->positive : r->negative);
    sl_status status = SL_OK;
    for (int32_t t = 0; t < r->nt && r->odds < count && status == SL_OK; t++) {
        status = r->sign[t] != r->most ? push(r, t) : SL_OK;
    }
    if (status != SL_OK) {
        sl_free(r->odd_place);
        r->odd_place = NULL;
    }
    return status;
}

sl_status sl_edge_signs_count(sl_edge_raster *r)
{
    r->positive = r->negative = 0;
    for (int32_t t = 0; t < r->nt; t++) {
        r->positive += r->sign[t] > 0;
        r->negative += r->sign[t] < 0;
    }
    return list_odd(r);
}

sl_status sl_edge_signs_prepare(sl_edge_raster *r)
{
    if (r->odd_place != NULL) {
        return SL_OK;
    }
    r->odd_place = sl_alloc(r->nt, sizeof *r->odd_place);
    if (r->odd_place == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(r->odd_place, -1, (size_t)r->nt * sizeof *r->odd_place);
    for (int64_t k = 0; k < r->odds; k++) {
        r->odd_place[r->odd[k]] = (int32_t)k;
    }
    return SL_OK;
}

sl_status sl_edge_signs_update(sl_edge_raster *r, int32_t t)
{
    const int8_t before = r->sign[t];
    r->kernels.orient(t, (int64_t)t + 1, r->corner, r->position, r->sign);
    const int8_t after = r->sign[t];
    if (before == after) {
        return SL_OK;
    }
    r->positive += (after > 0) - (before > 0);
    r->negative += (after < 0) - (before < 0);
    if (after == r->most) {
        take_out(r, t);
        return SL_OK;
    }
    return r->odd_place[t] < 0 ? push(r, t) : SL_OK;
}

sl_status sl_edge_signs_settle(sl_edge_raster *r)
{
    return most_of(r) != r->most ? list_odd(r) : SL_OK;
}
