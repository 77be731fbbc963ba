/* Candidates for automorphisms: what their first facets look like. */
#include "symmetry/finder_internal.h"
#include "symmetry/rigid.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <stdlib.h>

enum { BINS = 16384 }; /* of distances, at most: each far wider than the tolerance of exact maps */

static const double INVOLUTION = 0.05;       /* trace of a patch's isometry against that of an involution's */
static const double EXACT_INVOLUTION = 1e-6; /* where the patch fits exactly: a milliradian */

int64_t sl_finder_possibilities(const sl_finder *f)
{
    const sl_cells *c = f->search->cells;
    const int32_t begin = c->component[f->component], end = c->component[f->component + 1];
    int64_t corners = 0;
    for (int32_t j = begin; j < end; j++) {
        corners += c->color[j] == c->color[begin] ? c->first[j + 1] - c->first[j] : 0;
    }
    return 2 * corners;
}

static const double *corner_point(const sl_finder *f, int32_t h)
{
    return &f->search->cells->xyz[3 * (int64_t)f->search->cells->point[h]];
}

/* Points at distances from the centre that few others have. A histogram of the distances, each bin looked at with both
 * neighbours, tells which; of equally rare ones those farther out. */
sl_status sl_finder_choose_landmarks(sl_finder *f)
{
    const sl_cells *c = f->search->cells;
    const int32_t base = sl_cells_base(c, f->component), corners = sl_cells_corners(c, f->component);
    const int32_t bins = corners < BINS ? corners : BINS;
    const double size = c->size[f->component]; /* no distance exceeds it */
    const double scale = size > 0.0 ? bins / size : 0.0;
    int32_t *count = sl_calloc((int64_t)bins + 2, sizeof *count), bin[SL_LANDMARKS];
    if (count == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t next = c->point[base]; /* points are numbered as they are met */
    for (int32_t h = base; h < base + corners; h++) {
        if (c->point[h] == next) {
            count[1 + (int32_t)(c->radius[h] * scale)]++;
            next++;
        }
    }
    for (f->landmarks = 0; f->landmarks < SL_LANDMARKS; f->landmarks++) {
        int32_t rarest = 0, fewest = SL_LOOK_ALIKES + 1;
        for (int32_t b = bins; b > 0; b--) {
            const int32_t n = count[b - 1] + count[b] + count[b + 1];
            bool taken = count[b] == 0;
            for (int32_t i = 0; i < f->landmarks; i++) {
                taken = taken || abs(bin[i] - b) <= 1;
            }
            if (!taken && n < fewest) {
                fewest = n;
                rarest = b;
            }
        }
        if (rarest == 0) {
            break;
        }
        bin[f->landmarks] = rarest;
        f->landmark[f->landmarks].count = 0;
    }
    next = c->point[base];
    for (int32_t h = base; h < base + corners; h++) {
        if (c->point[h] != next) {
            continue;
        }
        const int32_t b = 1 + (int32_t)(c->radius[h] * scale);
        for (int32_t i = 0; i < f->landmarks; i++) {
            if (abs(bin[i] - b) <= 1) {
                sl_landmark *mark = &f->landmark[i];
                mark->alike[mark->count++] = next;
                mark->point = bin[i] == b ? next : mark->point;
            }
        }
        next++;
    }
    sl_free(count);
    return SL_OK;
}

/* Does T send every landmark to a point, as exactly as a patch of that radius can tell? */
static bool keeps_landmarks(const sl_finder *f, const double T[12], double radius)
{
    const sl_cells *c = f->search->cells;
    const double size = c->size[f->component];
    const double allowed = f->tolerance[SL_SYMMETRY_EXACT] * (1.0 + (radius > 0.0 ? size / radius : 0.0));
    for (int32_t i = 0; i < f->landmarks; i++) {
        const sl_landmark *mark = &f->landmark[i];
        double p[3];
        sl_rigid_apply(T, &c->xyz[3 * (int64_t)mark->point], p);
        bool found = false;
        for (int32_t k = 0; k < mark->count && !found; k++) {
            found = sl_vec3_distance(&c->xyz[3 * (int64_t)mark->alike[k]], p) <= allowed;
        }
        if (!found) {
            return false;
        }
    }
    return true;
}

/* Distance of the last corner of the patch from the first: about its radius. */
static double patch_radius(const sl_finder *f, int32_t patch)
{
    const sl_cells *c = f->search->cells;
    const int32_t begin = c->component[f->component], end = c->component[f->component + 1];
    const int32_t last = c->first[end - begin > patch ? begin + patch : end] - 1;
    return sl_vec3_distance(corner_point(f, c->first[begin]), corner_point(f, last));
}

static double determinant(const double T[12])
{
    return T[0] * (T[5] * T[10] - T[6] * T[9]) - T[1] * (T[4] * T[10] - T[6] * T[8]) +
           T[2] * (T[4] * T[9] - T[5] * T[8]);
}

/* I - M = 2 n n' for a mirror: its longest row, for which no axis is special. */
static void find_normal(const double T[12], double normal[3])
{
    double longest = 0.0;
    for (int i = 0; i < 3; i++) {
        const double row[3] = {(i == 0) - T[4 * i], (i == 1) - T[4 * i + 1], (i == 2) - T[4 * i + 2]};
        const double norm = sl_vec3_norm(row);
        for (int k = 0; k < 3 && norm > longest; k++) {
            normal[k] = row[k] / norm;
        }
        longest = fmax(longest, norm);
    }
}

/* Level and looks from the isometry that fits the patch just walked. */
static void look_at(const sl_finder *f, sl_candidate *c, int32_t patch)
{
    double T[12];
    const double distance =
        sl_symmetry_fit(f->search->cells, f->component, f->component, patch, c->reverses, f->search->image, T);
    while (c->level < SL_SYMMETRY_TOPOLOGICAL && distance > f->tolerance[c->level]) {
        c->level++;
    }
    if (c->level == SL_SYMMETRY_EXACT && !keeps_landmarks(f, T, patch_radius(f, patch))) {
        c->level = SL_SYMMETRY_NEAR;
    }
    const double tolerance = c->level == SL_SYMMETRY_EXACT ? EXACT_INVOLUTION : INVOLUTION;
    const bool reflects = determinant(T) < 0.0;
    c->trace = T[0] + T[5] + T[10];
    if (reflects && fabs(c->trace - 1.0) < tolerance) {
        c->looks = SL_LOOKS_MIRROR;
    } else if (fabs(c->trace - (reflects ? -3.0 : -1.0)) < tolerance) {
        c->looks = SL_LOOKS_INVOLUTION;
    } else {
        c->looks = reflects ? SL_LOOKS_OTHER : SL_LOOKS_ROTATION;
    }
    if (c->level == SL_SYMMETRY_TOPOLOGICAL) {
        c->looks = c->reverses ? SL_LOOKS_MIRROR : SL_LOOKS_OTHER;
    }
    find_normal(T, c->normal);
    c->along = fmax(fabs(c->normal[0]), fmax(fabs(c->normal[1]), fabs(c->normal[2])));
}

/* Adds the map that sends the first corner to `corner` if its first facets fit. */
static sl_status consider(sl_finder *f, int32_t corner, bool reverses, sl_symmetry_kind least, sl_symmetry_kind level,
                          int32_t patch)
{
    const sl_cells *cells = f->search->cells;
    float worst;
    if (!sl_symmetry_walk(cells, f->component, corner, reverses, patch, (float)f->tolerance[level], f->search->image,
                          &worst, &f->work)) {
        return SL_OK;
    }
    sl_candidate c = {.corner = corner, .reverses = reverses, .level = SL_SYMMETRY_EXACT};
    look_at(f, &c, patch);
    if (c.level < least || c.level > level) { /* had its turn, or will */
        return SL_OK;
    }
    sl_status status = sl_reserve((void **)&f->list, &f->capacity, f->count + 1, sizeof *f->list);
    if (status == SL_OK) {
        f->list[f->count++] = c;
    }
    return status;
}

/* All candidates of the levels least .. level. */
sl_status sl_finder_gather(sl_finder *f, sl_symmetry_kind least, sl_symmetry_kind level, int32_t patch, int64_t most)
{
    sl_status status = SL_OK;
    const sl_cells *c = f->search->cells;
    const int32_t begin = c->component[f->component], end = c->component[f->component + 1], base = c->first[begin];
    const float tolerance = (float)f->tolerance[level];
    const int64_t stop = f->work + f->allowed;
    int64_t kept = 0;
    for (int64_t i = 0; i < f->count; i++) { /* those that went back */
        if (!f->list[i].tried) {
            f->list[kept++] = f->list[i];
        }
    }
    f->count = kept;
    for (int32_t j = begin; j < end; j++) {
        if (c->color[j] != c->color[begin]) {
            continue;
        }
        for (int32_t h = c->first[j]; h < c->first[j + 1]; h++) {
            if (fabsf(c->radius[h] - c->radius[base]) > tolerance) {
                continue;
            }
            if (f->count >= kept + most || f->work > stop) {
                f->cut = true;
                return SL_OK;
            }
            if (h != base) {
                SL_TRY(consider(f, h, false, least, level, patch));
            }
            SL_TRY(consider(f, h, true, least, level, patch));
        }
    }
cleanup:
    return status;
}
