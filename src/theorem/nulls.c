/* Null spaces of L and its blocks, known beforehand. */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <math.h>

/* One vector a group: weight[i] on the rows of group[i] >= 0, scaled to length 1. */
static sl_status null_space_fill(int32_t n, const int32_t *group, const double *weight, int32_t groups,
                                 sl_null_space *out)
{
    int64_t entries = 0;
    sl_status status = sl_mul_size(n, groups, &entries);
    double *square = sl_calloc(groups, sizeof *square);
    out->basis = status == SL_OK ? sl_calloc(entries, sizeof *out->basis) : NULL;
    out->count = groups;
    SL_TRY(square != NULL && out->basis != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < n; i++) {
        if (group[i] >= 0) {
            square[group[i]] += weight[i] * weight[i];
        }
    }
    for (int32_t i = 0; i < n; i++) {
        if (group[i] >= 0) {
            out->basis[(int64_t)n * group[i] + i] = weight[i] / sqrt(square[group[i]]);
        }
    }
cleanup:
    sl_free(square);
    return status;
}

/* Components of the graph; orbits of them under the mirror, numbered anew; blocks of T that touch no axis. Returns how
 * many. */
static int32_t group_rows(const sl_theorem_graph *graph, const sl_half *half, sl_block_kind kind, int32_t n,
                          int32_t *group, double *weight, int32_t *number)
{
    int32_t groups = 0;
    if (kind == SL_BLOCK_ANTISYMMETRIC) {
        for (int32_t c = 0; c < half->components; c++) {
            number[c] = half->balanced[c] ? 0 : -1;
        }
        for (int32_t i = 0; i < n; i++) {
            const bool touches = half->axis[i] > 0 || half->spokes[i] > 0;
            number[half->component[i]] = touches ? -1 : number[half->component[i]];
        }
        for (int32_t c = 0; c < half->components; c++) {
            number[c] = number[c] == 0 ? groups++ : -1;
        }
        for (int32_t i = 0; i < n; i++) {
            group[i] = number[half->component[i]];
            weight[i] = half->turn[i];
        }
        return groups;
    }
    for (int32_t c = 0; c < half->graph_parts; c++) {
        number[c] = -1;
    }
    for (int32_t i = 0; i < n; i++) { /* a pair's node of half 1 stands for both */
        const int32_t node = kind == SL_BLOCK_WHOLE || i < graph->pairs ? i : i + graph->pairs;
        const int32_t part = half->part[node];
        if (number[part] < 0) {
            number[part] = groups++;
            if (kind == SL_BLOCK_SYMMETRIC) {
                number[half->part[sl_theorem_image(graph, node)]] = number[part];
            }
        }
        group[i] = number[part];
        weight[i] = kind == SL_BLOCK_SYMMETRIC && i < graph->pairs ? sqrt(2.0) : 1.0;
    }
    return groups;
}

sl_status sl_null_space_create(const sl_theorem_graph *graph, const sl_half *half, sl_block_kind kind,
                               sl_null_space *out)
{
    const int32_t fixed = kind == SL_BLOCK_ANTISYMMETRIC ? 0 : graph->fixed;
    const int32_t n = (kind == SL_BLOCK_WHOLE ? 2 : 1) * graph->pairs + fixed;
    int32_t *group = sl_alloc(n, sizeof *group);
    int32_t *number = sl_alloc((int64_t)half->graph_parts + half->components, sizeof *number);
    double *weight = sl_alloc(n, sizeof *weight);
    sl_status status = SL_OK;
    *out = (sl_null_space){0};
    SL_TRY(group != NULL && number != NULL && weight != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(null_space_fill(n, group, weight, group_rows(graph, half, kind, n, group, weight, number), out));
cleanup:
    sl_free(group);
    sl_free(number);
    sl_free(weight);
    return status;
}
