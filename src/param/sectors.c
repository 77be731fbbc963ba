#include "param/sectors.h"

#include <math.h>

#include "base/memory.h"

static const double full_turn = 6.283185307179586476925287;

static void count_interior(const sl_patch *patch, int32_t *sectors, int32_t *corners)
{
    *sectors = *corners = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        *sectors += patch->border[v] == 0;
    }
    for (int64_t c = 0; c < 3 * (int64_t)patch->nt; c++) {
        *corners += patch->border[patch->tri[c]] == 0;
    }
}

sl_status sl_sectors_interior(const sl_patch *patch, sl_sector_table *out)
{
    sl_status status = SL_OK;
    sl_sector_table table = {0};
    int32_t count, corners;
    count_interior(patch, &count, &corners);
    table.first = sl_alloc((int64_t)count + 1, sizeof *table.first);
    table.corner = sl_alloc(corners, sizeof *table.corner);
    table.theta = sl_alloc(count, sizeof *table.theta);
    table.vertex = sl_alloc(count, sizeof *table.vertex);
    table.origin = sl_alloc(count, sizeof *table.origin);
    if (table.first == NULL || table.corner == NULL || table.theta == NULL || table.vertex == NULL ||
        table.origin == NULL) {
        sl_sectors_clear(&table);
        return SL_OUT_OF_MEMORY;
    }
    int32_t s = 0, p = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] != 0) {
            continue;
        }
        table.first[s] = p;
        table.vertex[s] = v;
        table.origin[s] = -1;
        table.theta[s++] = full_turn;
        const int32_t start = patch->outgoing[v];
        int32_t c = start;
        do {
            table.corner[p++] = c;
            c = sl_corner_rotate(patch, c);
        } while (c != start && c >= 0 && p < corners);
    }
    table.first[s] = p;
    table.view = (sl_sectors){count, table.first, table.corner, table.theta};
    *out = table;
    return status;
}

void sl_sectors_clear(sl_sector_table *table)
{
    sl_free(table->first);
    sl_free(table->corner);
    sl_free(table->theta);
    sl_free(table->vertex);
    sl_free(table->origin);
    *table = (sl_sector_table){0};
}

sl_status sl_sectors_check(const sl_patch *patch, const sl_sectors *sectors, int32_t *bad_sector)
{
    for (int32_t s = 0; s < sectors->count; s++) {
        const int32_t begin = sectors->first[s], end = sectors->first[s + 1];
        sl_status status = begin == end ? SL_INFEASIBLE : SL_OK;
        if (begin < 0 || end < begin || !isfinite(sectors->theta[s])) {
            status = SL_BAD_INPUT;
        }
        for (int32_t p = begin; p < end && status == SL_OK; p++) {
            if (sectors->corner[p] < 0 || sectors->corner[p] / 3 >= patch->nt) {
                status = SL_BAD_INPUT;
            }
        }
        if (status != SL_OK) {
            if (bad_sector != NULL) {
                *bad_sector = s;
            }
            return status;
        }
    }
    return SL_OK;
}
