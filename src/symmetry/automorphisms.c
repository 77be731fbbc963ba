/* Automorphisms of one component: candidates walked in the order of what they look like. */
#include "symmetry/finder_internal.h"

#include "base/memory.h"

#include <math.h>

enum {
    SIMPLE = 16,         /* halfedges and orientations that need no landmarks */
    FEW = 512,           /* halfedges and orientations that are all candidates */
    MANY = 8192,         /* candidates that look exact, at most, where there are more than FEW */
    SOME = 256,          /* others */
    PATCH = 64,          /* cells a candidate is looked at first; */
    WIDE_PATCH = 256,    /* where it need not be exact */
    LEAST = 4,           /* automorphisms listed, however large */
    MIRRORS_FIRST = 3,   /* far from one another, */
    MIRRORS_NEXT = 4,    /* and near to those */
    FREE_WORK = 1 << 20, /* corners that may be walked in vain, beside */
    FREE_ROUNDS = 4      /* this many times those of the component */
};

static const double ROUNDING = 4e-7; /* of distances kept as floats, over the diagonal */
static const double TIE = 1e-6;      /* of cosines and traces: the first candidate wins */

/* Where a candidate stands by its looks: three mirrors, a rotation, mirrors, all else. Three mirrors at right angles
 * and the rotation of the smallest angle generate the symmetries of a solid of revolution. */
static int32_t turn_of(const sl_finder *f, const sl_candidate *c)
{
    switch (c->looks) {
    case SL_LOOKS_MIRROR:
        return f->mirrors < MIRRORS_FIRST ? 0 : 2;
    case SL_LOOKS_ROTATION:
        return f->rotations == 0 ? 1 : 4;
    case SL_LOOKS_INVOLUTION:
        return 3;
    default:
        return 5;
    }
}

/* Is a to be tried before b? By level, by looks; of mirrors the one farthest from those found (or nearest: the mirrors
 * beside the first ones), of others the one of the smallest angle. */
static bool before(const sl_finder *f, const sl_candidate *a, const sl_candidate *b)
{
    if (a->level != b->level) {
        return a->level < b->level;
    }
    const int32_t turn = turn_of(f, a), other = turn_of(f, b);
    if (turn != other) {
        return turn < other;
    }
    if (a->level == SL_SYMMETRY_TOPOLOGICAL || a->looks == SL_LOOKS_INVOLUTION) {
        return false;
    }
    if (a->looks != SL_LOOKS_MIRROR) {
        return a->trace > b->trace + TIE;
    }
    const bool nearest = f->mirrors >= MIRRORS_FIRST && f->mirrors < MIRRORS_FIRST + MIRRORS_NEXT;
    if (fabs(a->near - b->near) > TIE) {
        return nearest == (a->near > b->near);
    }
    return a->along > b->along + TIE;
}

static void note_map(sl_finder *f, const sl_candidate *map)
{
    f->found++;
    f->mirrors += map->looks == SL_LOOKS_MIRROR;
    f->rotations += map->looks == SL_LOOKS_ROTATION;
    for (int64_t i = 0; i < f->count && map->looks == SL_LOOKS_MIRROR; i++) {
        sl_candidate *c = &f->list[i];
        const double *n = c->normal, *m = map->normal;
        c->near = fmax(c->near, fabs(n[0] * m[0] + n[1] * m[1] + n[2] * m[2]));
    }
}

/* The next candidate of a level up to `level`, NULL = none. */
static sl_candidate *next_candidate(const sl_finder *f, sl_symmetry_kind level)
{
    sl_candidate *best = NULL;
    for (int64_t i = 0; i < f->count; i++) {
        sl_candidate *c = &f->list[i];
        if (!c->tried && c->level <= level && (best == NULL || before(f, c, best))) {
            best = c;
        }
    }
    return best;
}

/* Walks the candidates up to `level`. One that is not what its first facets looked like goes back to the next level. */
static sl_status try_all(sl_finder *f, sl_symmetry_kind level)
{
    sl_status status = SL_OK;
    const int64_t stop = f->work + f->allowed;
    for (sl_candidate *c = next_candidate(f, level); c != NULL; c = next_candidate(f, level)) {
        if (f->found >= f->cap || f->work > stop) {
            f->cut = true;
            break;
        }
        SL_TRY(sl_report_progress(f->search->context, "symmetry", 0.5));
        bool added = false;
        int64_t work = 0;
        SL_TRY(sl_symmetry_try(f->search, f->component, f->component, c->corner, c->reverses,
                               (float)f->tolerance[c->level], (sl_symmetry_kind)c->level, &work, &added));
        if (added) {
            note_map(f, c);
        } else {
            f->work += work;
        }
        c->tried = added || c->level == SL_SYMMETRY_TOPOLOGICAL;
        c->level += !c->tried;
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

/* How many maps the component may have: as many as fit into its share of def->corners, by components or by corners. */
static int32_t most_maps(const sl_symmetry_search *search, int32_t component)
{
    const sl_symmetry_def *def = search->def;
    const int64_t equal = def->corners / search->searched / sl_cells_corners(search->cells, component);
    const int64_t fair = def->corners / search->searched_corners;
    int64_t most = equal > fair ? equal : fair;
    most = most > LEAST ? most : LEAST;
    return most < def->most ? (int32_t)most : def->most;
}

sl_status sl_symmetry_automorphisms(sl_symmetry_search *search, int32_t component)
{
    sl_status status = SL_OK;
    const sl_cells *cells = search->cells;
    const sl_symmetry_def *def = search->def;
    const int64_t corners = sl_cells_corners(cells, component);
    const int32_t first = search->out->nmap;
    sl_finder f = {.search = search, .component = component};
    f.cap = most_maps(search, component);
    f.tolerance[SL_SYMMETRY_EXACT] = (2.0 * def->exact + ROUNDING) * cells->size[component];
    f.tolerance[SL_SYMMETRY_NEAR] = (2.0 * def->near + ROUNDING) * cells->size[component];
    f.tolerance[SL_SYMMETRY_TOPOLOGICAL] = INFINITY;
    f.allowed = FREE_ROUNDS * corners + FREE_WORK;
    const int64_t possibilities = sl_finder_possibilities(&f);
    const bool few = possibilities <= FEW;
    if (possibilities > SIMPLE) {
        SL_TRY(sl_finder_choose_landmarks(&f));
    }
    for (sl_symmetry_kind k = SL_SYMMETRY_EXACT; k <= SL_SYMMETRY_TOPOLOGICAL; k++) {
        const bool exact = k == SL_SYMMETRY_EXACT;
        if (few && exact) {
            SL_TRY(sl_finder_gather(&f, SL_SYMMETRY_EXACT, SL_SYMMETRY_TOPOLOGICAL, WIDE_PATCH, FEW));
        } else if (!few && f.found < f.cap) {
            SL_TRY(sl_finder_gather(&f, k, k, exact ? PATCH : WIDE_PATCH, exact ? MANY : SOME));
        }
        SL_TRY(try_all(&f, k));
        f.cut = f.cut || (!few && f.found >= f.cap && k < SL_SYMMETRY_TOPOLOGICAL);
    }
    search->out->truncated = search->out->truncated || f.cut;
    if (search->out->nmap > first) {
        sort_maps(search->out->map + first, search->out->nmap - first);
    }
cleanup:
    sl_free(f.list);
    return status;
}
