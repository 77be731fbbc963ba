/* Whether positive angles can satisfy the linear constraints, as far as sums over sectors and regions tell. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "param/regions_internal.h"
#include "param/sectors_flow_internal.h"

static const double pi = 3.14159265358979323846;
static const double degrees = 57.29577951308232;
static const double least_room = 1e-6; /* [rad] an angle must be able to stay away from 0 and pi by this much */

enum { LISTED = 6 }; /* vertices and constraints that a message names at most */

static int32_t name_of(const int32_t *name, int32_t v)
{
    return name != NULL ? name[v] : v;
}

/* A sector of k triangles holds an angle in (0, k pi). */
static sl_status check_sectors(const sl_sector_table *table, const int32_t *name, sl_diag *diag)
{
    for (int32_t s = 0; s < table->view.count; s++) {
        const int32_t k = table->view.first[s + 1] - table->view.first[s];
        const double theta = table->view.theta[s];
        if (theta >= least_room && theta <= k * (pi - least_room)) {
            continue;
        }
        sl_diag_reason(diag, "the sector of %d triangle%s at vertex %d cannot be %.6g degrees wide", k,
                       k == 1 ? "" : "s", name_of(name, table->vertex[s]), theta * degrees);
        if (table->origin[s] >= 0) {
            sl_diag_hint(diag, "it comes from constraint %d; lead the line along other edges or refine the mesh there",
                         table->origin[s] + 1);
        }
        if (diag != NULL) {
            diag->element = table->vertex[s];
        }
        return SL_INFEASIBLE;
    }
    return SL_OK;
}

/* Is sector s one of those to be listed? */
typedef bool member_fn(const void *user, int32_t s);

/* " 3, 17, 20, ..." of the vertices of the sectors that are members, those that somebody prescribed first, and of the
 * constraints they come from. Returns the first vertex. */
static int32_t list_members(const sl_sector_table *table, member_fn *member, const void *user, const int32_t *name,
                            char *vertices, char *origins, size_t size)
{
    const int32_t count = table->view.count;
    int32_t listed = 0, first = -1, last = -1, origins_listed = 0;
    size_t at = 0, to = 0;
    vertices[0] = origins[0] = '\0';
    for (int64_t i = 0; i < 2 * (int64_t)count && listed <= LISTED; i++) {
        const int32_t s = (int32_t)(i % count), v = table->vertex[s];
        const bool prescribed = table->origin[s] >= 0;
        if (prescribed != (i < count) || !member(user, s)) {
            continue;
        }
        first = first < 0 ? v : first;
        const char *comma = listed > 0 ? "," : "";
        at += (size_t)(listed < LISTED ? snprintf(&vertices[at], size - at, "%s %d", comma, name_of(name, v))
                                       : snprintf(&vertices[at], size - at, ", ..."));
        listed++;
        if (prescribed && table->origin[s] != last && origins_listed < LISTED) {
            last = table->origin[s];
            to += (size_t)snprintf(&origins[to], size - to, "%s %d", origins_listed++ > 0 ? "," : "", last + 1);
        }
    }
    return first;
}

/* Sectors that prescribe something in one region. */
typedef struct region_members {
    const sl_sector_table *table;
    const sl_regions *regions;
    int32_t region;
} region_members;

static bool in_region(const void *user, int32_t s)
{
    const region_members *m = user;
    return m->regions->of_sector[s] == m->region && m->table->origin[s] >= 0;
}

static sl_status refuse_region(const sl_sector_table *table, const sl_regions *regions, int32_t r, const int32_t *name,
                               sl_diag *diag)
{
    char vertices[96], origins[96];
    const double excess = regions->excess[r] * degrees;
    const region_members members = {table, regions, r};
    const int32_t first = list_members(table, in_region, &members, name, vertices, origins, sizeof vertices);
    if (regions->free[r] == 0) {
        sl_diag_reason(diag, "the angles around a region of %d triangles are %.6g degrees too %s (vertices%s)",
                       regions->triangles[r], fabs(excess), excess > 0.0 ? "large" : "small", vertices);
    } else {
        sl_diag_reason(diag,
                       "the angles around a region of %d triangles leave %.6g degrees for the %d angles that are free "
                       "(vertices%s)",
                       regions->triangles[r], -excess, regions->free[r], vertices);
    }
    sl_diag_hint(diag, "by Gauss-Bonnet the turns of a region's border add up to 360 degrees; constraints%s take part",
                 origins);
    if (diag != NULL && first >= 0) {
        diag->element = first;
    }
    return SL_INFEASIBLE;
}

static bool in_cut(const void *user, int32_t s)
{
    const sl_sector_cut *cut = user;
    return cut->in_cut[s] != 0;
}

static sl_status refuse_cut(const sl_sector_table *table, const sl_sector_cut *cut, const int32_t *name, sl_diag *diag)
{
    char vertices[96], origins[96];
    const int32_t first = list_members(table, in_cut, cut, name, vertices, origins, sizeof vertices);
    sl_diag_reason(diag,
                   cut->starved ? "%d sectors ask for %.6g degrees together, their %d triangles have %.6g (vertices%s)"
                                : "%d sectors hold %.6g degrees together, the %d triangles that lie in no other have "
                                  "%.6g (vertices%s)",
                   cut->sectors, cut->asked * degrees, cut->triangles, cut->held * degrees, vertices);
    if (origins[0] != '\0') {
        sl_diag_hint(diag, "constraints%s compete; ask for less there or refine the mesh", origins);
    } else {
        sl_diag_hint(diag, "no constraint takes part: the mesh itself has no such angles; refine it there");
    }
    if (diag != NULL) {
        diag->element = first;
    }
    return SL_INFEASIBLE;
}

/* Sectors that are possible one by one but not together. */
static sl_status check_together(const sl_patch *patch, const sl_sector_table *table, const int32_t *name, sl_diag *diag)
{
    sl_sector_cut cut;
    sl_status status = sl_sectors_cut(patch, &table->view, least_room, &cut);
    if (status == SL_OK && cut.found) {
        status = refuse_cut(table, &cut, name, diag);
        sl_free(cut.in_cut);
    }
    return status;
}

sl_status sl_sectors_feasible(const sl_patch *patch, const sl_sector_table *table, const int32_t *name, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_regions regions = {0};
    SL_TRY(sl_sectors_check(patch, &table->view, NULL));
    SL_TRY(check_sectors(table, name, diag));
    SL_TRY(sl_regions_init(&regions, patch, &table->view));
    const int32_t contradicted = sl_regions_contradicted(&regions);
    if (contradicted >= 0) {
        SL_TRY(refuse_region(table, &regions, contradicted, name, diag));
    }
    for (int32_t r = 0; r < regions.count; r++) {
        const double left = -regions.excess[r], free = regions.free[r];
        if (free > 0.0 && (left < free * least_room || left > free * (pi - least_room))) {
            SL_TRY(refuse_region(table, &regions, r, name, diag));
        }
    }
    SL_TRY(check_together(patch, table, name, diag));
cleanup:
    sl_regions_clear(&regions);
    return status;
}
