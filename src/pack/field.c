#include "pack/field.h"

#include "base/memory.h"

#include <string.h>

sl_status sl_field_init(int32_t width, int32_t height, sl_field *out)
{
    *out = (sl_field){.capacity = ((int64_t)width + 2) * height};
    out->sum = sl_alloc(out->capacity, sizeof *out->sum);
    return out->sum != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

void sl_field_clear(sl_field *field)
{
    sl_free(field->sum);
    *field = (sl_field){0};
}

void sl_field_begin(sl_field *field, const int32_t low[2], const int32_t size[2])
{
    for (int i = 0; i < 2; i++) {
        field->low[i] = low[i];
        field->size[i] = size[i];
    }
    field->stride = size[0] + 2;
    SL_ASSERT((int64_t)field->stride * size[1] <= field->capacity);
    memset(field->sum, 0, (size_t)((int64_t)field->stride * size[1]) * sizeof *field->sum);
}

/* Until they are summed, rows hold where weights begin and end, one place to the right. */
void sl_field_add(sl_field *field, const sl_mask *mask, int32_t x, int32_t y, int32_t weight)
{
    x -= field->low[0];
    y -= field->low[1];
    if (x >= field->size[0] || y >= field->size[1] || x + mask->width <= 0 || y + mask->height <= 0) {
        return;
    }
    for (int32_t r = 0; r < mask->count; r++) {
        const int32_t at = y + mask->run[r].row, left = x + mask->run[r].left, right = left + mask->run[r].length;
        if (at >= 0 && at < field->size[1] && left < field->size[0] && right > 0) {
            int32_t *row = field->sum + (int64_t)at * field->stride + 1;
            row[left > 0 ? left : 0] += weight;
            row[right < field->size[0] ? right : field->size[0]] -= weight;
        }
    }
}

void sl_field_sum(sl_field *field)
{
    for (int32_t y = 0; y < field->size[1]; y++) {
        int32_t *row = field->sum + (int64_t)y * field->stride, weight = 0, sum = 0;
        for (int32_t x = 1; x <= field->size[0]; x++) {
            weight += row[x];
            sum += weight;
            row[x] = sum;
        }
    }
}

void sl_field_coarsen(const sl_field *fine, int32_t factor, sl_field *coarse)
{
    const int32_t size[2] = {fine->size[0] / factor, fine->size[1] / factor};
    sl_field_begin(coarse, fine->low, size);
    for (int32_t y = 0; y < size[1] * factor; y++) {
        const int32_t *from = fine->sum + (int64_t)y * fine->stride;
        int32_t *to = coarse->sum + (int64_t)(y / factor) * coarse->stride;
        for (int32_t x = 0; x <= size[0]; x++) {
            to[x] += from[x * factor];
        }
    }
}

int64_t sl_field_cost(const sl_field *field, const sl_mask *mask, int32_t x, int32_t y, int64_t bound)
{
    const int32_t *corner = field->sum + (int64_t)(y - field->low[1]) * field->stride + (x - field->low[0]);
    int64_t cost = 0;
    for (int32_t r = 0; r < mask->count && cost < bound; r++) {
        const int32_t *row = corner + (int64_t)mask->run[r].row * field->stride + mask->run[r].left;
        cost += row[mask->run[r].length] - row[0];
    }
    return cost;
}
