/* Whether positive angles can satisfy the linear constraints, as far as sums over sectors and regions tell. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "param/regions_internal.h"

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

/* " 3, 17, 20, ..." of the vertices and of the constraints that prescribe something in region r. */
static void list_region(const sl_sector_table *table, const sl_regions *regions, int32_t r, const int32_t *name,
                        char *vertices, char *origins, size_t size)
{
    int32_t listed = 0, last = -1, origins_listed = 0;
    size_t at = 0, to = 0;
    vertices[0] = origins[0] = '\0';
    for (int32_t s = 0; s < table->view.count && listed <= LISTED; s++) {
        if (regions->of_sector[s] != r || table->origin[s] < 0) {
            continue;
        }
        const char *comma = listed > 0 ? "," : "";
        at += (size_t)(listed < LISTED
                           ? snprintf(&vertices[at], size - at, "%s %d", comma, name_of(name, table->vertex[s]))
                           : snprintf(&vertices[at], size - at, ", ..."));
        listed++;
        if (table->origin[s] != last && origins_listed < LISTED) {
            last = table->origin[s];
            to += (size_t)snprintf(&origins[to], size - to, "%s %d", origins_listed++ > 0 ? "," : "", last + 1);
        }
    }
}

static sl_status refuse_region(const sl_sector_table *table, const sl_regions *regions, int32_t r, const int32_t *name,
                               sl_diag *diag)
{
    char vertices[96], origins[96];
    const double excess = regions->excess[r] * degrees;
    list_region(table, regions, r, name, vertices, origins, sizeof vertices);
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
    for (int32_t s = 0; s < table->view.count && diag != NULL; s++) {
        if (regions->of_sector[s] == r && table->origin[s] >= 0) {
            diag->element = table->vertex[s];
            break;
        }
    }
    return SL_INFEASIBLE;
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
cleanup:
    sl_regions_clear(&regions);
    return status;
}
