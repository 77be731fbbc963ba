#include "param/regions_internal.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

static const double pi = 3.14159265358979323846;
static const double excess_tolerance = 1e-9; /* [rad]; sums are compensated, so far above rounding */

/* Root of node x; halves the path on the way. */
static int32_t find_root(int32_t *parent, int32_t x)
{
    while (parent[x] != x) {
        parent[x] = parent[parent[x]];
        x = parent[x];
    }
    return x;
}

/* Nodes 0 .. nt - 1 are triangles, nt + s is sector s; the smallest node of a set is its root. */
static void join_all(const sl_patch *patch, const sl_sectors *sectors, int32_t *parent)
{
    for (int32_t i = 0; i < patch->nt + sectors->count; i++) {
        parent[i] = i;
    }
    for (int32_t s = 0; s < sectors->count; s++) {
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            const int32_t a = find_root(parent, patch->nt + s), b = find_root(parent, sectors->corner[p] / 3);
            parent[a > b ? a : b] = a > b ? b : a;
        }
    }
}

static void number(sl_regions *regions, const sl_patch *patch, const sl_sectors *sectors, int32_t *parent)
{
    int32_t count = 0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t root = find_root(parent, t);
        regions->of_triangle[t] = root == t ? count++ : regions->of_triangle[root];
    }
    for (int32_t s = 0; s < sectors->count; s++) { /* a sector has corners, so its root is a triangle */
        regions->of_sector[s] = regions->of_triangle[find_root(parent, patch->nt + s)];
    }
    regions->count = count;
}

/* The sector of most corners in every region without a free corner and without one that is taken twice. */
static void choose_dependent(sl_regions *regions, const sl_patch *patch, const sl_sectors *sectors, int32_t *taken)
{
    memset(taken, 0, 3 * (size_t)patch->nt * sizeof *taken);
    for (int32_t p = 0; p < sectors->first[sectors->count]; p++) {
        taken[sectors->corner[p]]++;
    }
    for (int32_t r = 0; r < regions->count; r++) {
        regions->dependent[r] = INT32_MAX; /* none yet */
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t r = regions->of_triangle[c / 3];
        regions->triangles[r] += c % 3 == 0;
        regions->free[r] += taken[c] == 0;
        regions->dependent[r] = taken[c] != 1 ? -1 : regions->dependent[r];
    }
    for (int32_t s = 0; s < sectors->count; s++) {
        int32_t *best = &regions->dependent[regions->of_sector[s]];
        const int32_t size = sectors->first[s + 1] - sectors->first[s];
        if (*best == INT32_MAX || (*best >= 0 && size > sectors->first[*best + 1] - sectors->first[*best])) {
            *best = s;
        }
    }
}

sl_status sl_regions_init(sl_regions *regions, const sl_patch *patch, const sl_sectors *sectors)
{
    sl_status status = SL_OUT_OF_MEMORY;
    const int64_t nt = patch->nt;
    *regions = (sl_regions){0};
    int32_t *scratch = nt + sectors->count <= INT32_MAX ? sl_alloc(3 * nt + sectors->count, sizeof *scratch) : NULL;
    regions->of_triangle = sl_alloc(nt, sizeof(int32_t));
    regions->of_sector = sl_alloc(sectors->count, sizeof(int32_t));
    if (scratch == NULL || regions->of_triangle == NULL || regions->of_sector == NULL) {
        goto cleanup;
    }
    join_all(patch, sectors, scratch);
    number(regions, patch, sectors, scratch);
    regions->triangles = sl_calloc(regions->count, sizeof(int32_t));
    regions->free = sl_calloc(regions->count, sizeof(int32_t));
    regions->dependent = sl_calloc(regions->count, sizeof(int32_t));
    regions->excess = sl_calloc(2 * (int64_t)regions->count, sizeof(double));
    if (regions->triangles == NULL || regions->free == NULL || regions->dependent == NULL || regions->excess == NULL) {
        goto cleanup;
    }
    choose_dependent(regions, patch, sectors, scratch);
    sl_regions_sum(regions, sectors->count, sectors->theta);
    status = SL_OK;
cleanup:
    sl_free(scratch);
    if (status != SL_OK) {
        sl_regions_clear(regions);
    }
    return status;
}

void sl_regions_clear(sl_regions *regions)
{
    sl_free(regions->of_triangle);
    sl_free(regions->of_sector);
    sl_free(regions->triangles);
    sl_free(regions->free);
    sl_free(regions->dependent);
    sl_free(regions->excess);
    *regions = (sl_regions){0};
}

/* Compensated sums (Neumaier 1974): excess[count + r] carries what was lost. */
static void add(double *sum, double *lost, double x)
{
    const double s = *sum + x;
    *lost += fabs(*sum) >= fabs(x) ? (*sum - s) + x : (x - s) + *sum;
    *sum = s;
}

void sl_regions_sum(sl_regions *regions, int32_t count, const double *theta)
{
    double *sum = regions->excess, *lost = &regions->excess[regions->count];
    for (int32_t r = 0; r < regions->count; r++) {
        sum[r] = -pi * regions->triangles[r];
        lost[r] = fma(-pi, regions->triangles[r], -sum[r]);
    }
    for (int32_t s = 0; s < count; s++) {
        const int32_t r = regions->of_sector[s];
        add(&sum[r], &lost[r], theta[s]);
    }
    for (int32_t r = 0; r < regions->count; r++) {
        sum[r] += lost[r];
    }
}

int32_t sl_regions_contradicted(const sl_regions *regions)
{
    for (int32_t r = 0; r < regions->count; r++) {
        if (regions->dependent[r] >= 0 && !(fabs(regions->excess[r]) <= excess_tolerance)) {
            return r;
        }
    }
    return -1;
}
