/* Automorphisms of one component: candidates, ranked by what their geometry looks like, and walked. */
#include "symmetry/rigid.h"
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum {
    FEW = 512,           /* halfedges and orientations that are all tried at once */
    LEAST = 4,           /* automorphisms listed, however large */
    MANY = 8192,         /* candidates of exact geometry, at most */
    SOME = 256,          /* candidates of other geometry, where there are more than FEW */
    PATCH = 64,          /* cells a candidate is looked at first; */
    WIDE_PATCH = 256,    /* where geometry is not exact */
    FREE_WORK = 1 << 20, /* corners that may be walked in vain, beside */
    FREE_ROUNDS = 4      /* this many times those of the component */
};

static const double ROUNDING = 4e-7;   /* of distances kept as floats, over the diagonal */
static const double INVOLUTION = 0.05; /* trace of a patch's isometry against that of an involution's */

static const double TIE = 1e-9; /* of cosines and traces: the first candidate wins */

/* What a patch looks like. */
enum { LOOKS_MIRROR, LOOKS_INVOLUTION, LOOKS_OTHER };

typedef struct candidate {
    int32_t corner;
    bool reverses, tried;
    uint8_t level, looks;   /* level: an sl_symmetry_kind */
    double trace;           /* of its isometry: the smaller the angle, the larger */
    double normal[3], near; /* of a mirror; largest |cosine| to the normals of mirrors found */
} candidate;

typedef struct finder {
    sl_symmetry_search *search;
    int32_t component, cap, found;
    double tolerance[3]; /* of distances, by kind */
    candidate *list;
    int64_t count, capacity;
    int64_t work, allowed;
    bool cut; /* something was left out */
} finder;

static void look_at(const finder *f, candidate *c, int32_t patch)
{
    double T[12];
    const double distance =
        sl_symmetry_fit(f->search->cells, f->component, f->component, patch, c->reverses, f->search->image, T);
    while (c->level < SL_SYMMETRY_TOPOLOGICAL && distance > f->tolerance[c->level]) {
        c->level++;
    }
    const double trace = T[0] + T[5] + T[10];
    const double det =
        T[0] * (T[5] * T[10] - T[6] * T[9]) - T[1] * (T[4] * T[10] - T[6] * T[8]) + T[2] * (T[4] * T[9] - T[5] * T[8]);
    c->trace = trace;
    const bool mirror = det < 0.0 && fabs(trace - 1.0) < INVOLUTION;
    const bool involution = fabs(trace - (det < 0.0 ? -3.0 : -1.0)) < INVOLUTION;
    c->looks = mirror ? LOOKS_MIRROR : involution ? LOOKS_INVOLUTION : LOOKS_OTHER;
    if (c->level == SL_SYMMETRY_TOPOLOGICAL) {
        c->looks = c->reverses ? LOOKS_MIRROR : LOOKS_OTHER;
    }
    /* I - M = 2 n n' for a mirror: its longest row, for which no axis is special */
    double longest = 0.0;
    for (int i = 0; i < 3; i++) {
        const double row[3] = {(i == 0) - T[4 * i], (i == 1) - T[4 * i + 1], (i == 2) - T[4 * i + 2]};
        const double norm = sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        for (int k = 0; k < 3 && norm > longest; k++) {
            c->normal[k] = row[k] / norm;
        }
        longest = fmax(longest, norm);
    }
    /* the first mirror is one along an axis of the model's */
    const double *n = c->normal;
    c->near = -fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
}

/* Adds the map that sends the first corner to `corner` if its first facets fit. */
static sl_status consider(finder *f, int32_t corner, bool reverses, sl_symmetry_kind least, sl_symmetry_kind level,
                          int32_t patch)
{
    const sl_cells *cells = f->search->cells;
    float worst;
    if (!sl_symmetry_walk(cells, f->component, corner, reverses, patch, (float)f->tolerance[level], f->search->image,
                          &worst, &f->work)) {
        return SL_OK;
    }
    candidate c = {.corner = corner, .reverses = reverses, .level = SL_SYMMETRY_EXACT};
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
static sl_status gather(finder *f, sl_symmetry_kind least, sl_symmetry_kind level, int32_t patch, int64_t most)
{
    sl_status status = SL_OK;
    const sl_cells *c = f->search->cells;
    const int32_t begin = c->component[f->component], end = c->component[f->component + 1], base = c->first[begin];
    const float tolerance = (float)f->tolerance[level];
    const int64_t stop = f->work + f->allowed;
    f->count = 0;
    for (int32_t j = begin; j < end; j++) {
        if (c->color[j] != c->color[begin]) {
            continue;
        }
        for (int32_t h = c->first[j]; h < c->first[j + 1]; h++) {
            if (fabsf(c->radius[h] - c->radius[base]) > tolerance) {
                continue;
            }
            if (f->count >= most || f->work > stop) {
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

/* Is a to be tried before b? By level, by looks; of mirrors the one farthest from those found, of others the one of the
 * smallest angle: in a cyclic group it generates the rest. */
static bool before(const candidate *a, const candidate *b)
{
    if (a->level != b->level) {
        return a->level < b->level;
    }
    if (a->looks != b->looks) {
        return a->looks < b->looks;
    }
    if (a->level == SL_SYMMETRY_TOPOLOGICAL || a->looks == LOOKS_INVOLUTION) {
        return false;
    }
    return a->looks == LOOKS_MIRROR ? a->near < b->near - TIE : a->trace > b->trace + TIE;
}

static void note_mirror(finder *f, const double normal[3])
{
    for (int64_t i = 0; i < f->count; i++) {
        candidate *c = &f->list[i];
        const double *n = c->normal;
        c->near = fmax(c->near, fabs(n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2]));
    }
}

static sl_status try_all(finder *f)
{
    sl_status status = SL_OK;
    const int64_t stop = f->work + f->allowed;
    for (int64_t left = f->count; left > 0; left--) {
        candidate *best = NULL;
        for (int64_t i = 0; i < f->count; i++) {
            candidate *c = &f->list[i];
            best = !c->tried && (best == NULL || before(c, best)) ? c : best;
        }
        if (f->found >= f->cap || f->work > stop) {
            f->cut = true;
            break;
        }
        SL_TRY(sl_report_progress(f->search->context, "symmetry", 0.5));
        bool added = false;
        int64_t work = 0;
        best->tried = true;
        SL_TRY(sl_symmetry_try(f->search, f->component, f->component, best->corner, best->reverses, INFINITY,
                               SL_SYMMETRY_TOPOLOGICAL, &work, &added));
        f->found += added;
        f->work += added ? 0 : work;
        if (added && best->looks == LOOKS_MIRROR) {
            note_mirror(f, best->normal);
        }
    }
cleanup:
    return status;
}

/* Exact before near before topological, mirrors before others. */
static int32_t sort_key(const sl_symmetry_map *map)
{
    const int32_t what = map->order != 2 ? 3 : !map->reverses ? 2 : map->separates ? 0 : 1;
    return 4 * (int32_t)map->kind + what;
}

static void sort_maps(sl_symmetry_map *map, int32_t count)
{
    for (int32_t i = 1; i < count; i++) {
        const sl_symmetry_map moved = map[i];
        int32_t k = i;
        for (; k > 0 && sort_key(&map[k - 1]) > sort_key(&moved); k--) {
            map[k] = map[k - 1];
        }
        map[k] = moved;
    }
}

/* Halfedges and orientations of the first corner's colour. */
static int64_t count_candidates(const sl_cells *c, int32_t component)
{
    int64_t corners = 0;
    for (int32_t j = c->component[component]; j < c->component[component + 1]; j++) {
        corners += c->color[j] == c->color[c->component[component]] ? c->first[j + 1] - c->first[j] : 0;
    }
    return 2 * corners;
}

sl_status sl_symmetry_automorphisms(sl_symmetry_search *search, int32_t component)
{
    sl_status status = SL_OK;
    const sl_cells *cells = search->cells;
    const sl_symmetry_def *def = search->def;
    const int64_t corners = sl_cells_corners(cells, component), fit = def->corners / corners;
    const int32_t first = search->out->nmap;
    finder f = {.search = search, .component = component};
    f.cap = fit < def->most ? (int32_t)(fit > LEAST ? fit : LEAST) : def->most;
    f.cap = f.cap < def->most ? f.cap : def->most;
    f.tolerance[SL_SYMMETRY_EXACT] = (2.0 * def->exact + ROUNDING) * cells->size[component];
    f.tolerance[SL_SYMMETRY_NEAR] = (2.0 * def->near + ROUNDING) * cells->size[component];
    f.tolerance[SL_SYMMETRY_TOPOLOGICAL] = INFINITY;
    f.allowed = FREE_ROUNDS * corners + FREE_WORK;
    if (count_candidates(cells, component) <= FEW) {
        SL_TRY(gather(&f, SL_SYMMETRY_EXACT, SL_SYMMETRY_TOPOLOGICAL, WIDE_PATCH, FEW));
        SL_TRY(try_all(&f));
    } else {
        for (sl_symmetry_kind k = SL_SYMMETRY_EXACT; k <= SL_SYMMETRY_TOPOLOGICAL && f.found < f.cap; k++) {
            const bool exact = k == SL_SYMMETRY_EXACT;
            SL_TRY(gather(&f, k, k, exact ? PATCH : WIDE_PATCH, exact ? MANY : SOME));
            SL_TRY(try_all(&f));
            f.cut = f.cut || (f.found >= f.cap && k < SL_SYMMETRY_TOPOLOGICAL);
        }
    }
    search->out->truncated = search->out->truncated || f.cut;
    sort_maps(search->out->map + first, search->out->nmap - first);
cleanup:
    sl_free(f.list);
    return status;
}
