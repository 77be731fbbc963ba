/* Brute force: every invariant of mesh.h and every number of the repair report, found again by other means. Quadratic.
 */
#ifndef SL_TEST_MESH_CHECK_H
#define SL_TEST_MESH_CHECK_H

#include "mesh/mesh_fixtures.h"

enum { CHECK_CORNERS = 1200 };

/* Union-find with the parity of the path to the root. */
typedef struct dsu {
    int32_t n, parent[CHECK_CORNERS];
    int32_t odd[CHECK_CORNERS]; /* parity against the parent */
} dsu;

static inline void dsu_init(dsu *d, int32_t n)
{
    assert_true(n <= CHECK_CORNERS);
    d->n = n;
    for (int32_t i = 0; i < n; i++) {
        d->parent[i] = i;
        d->odd[i] = 0;
    }
}

static inline int32_t dsu_root(const dsu *d, int32_t i, int32_t *odd)
{
    *odd = 0;
    while (d->parent[i] != i) {
        *odd ^= d->odd[i];
        i = d->parent[i];
    }
    return i;
}

/* False when a and b were joined already with the other parity. */
static inline bool dsu_join(dsu *d, int32_t a, int32_t b, int32_t odd)
{
    int32_t x, y;
    const int32_t ra = dsu_root(d, a, &x), rb = dsu_root(d, b, &y);
    if (ra == rb) {
        return (x ^ y) == odd;
    }
    d->parent[ra] = rb;
    d->odd[ra] = x ^ y ^ odd;
    return true;
}

static inline bool dsu_same(const dsu *d, int32_t a, int32_t b)
{
    int32_t x, y;
    return dsu_root(d, a, &x) == dsu_root(d, b, &y);
}

static inline int32_t dsu_classes(const dsu *d, const bool *counts)
{
    int32_t n = 0;
    for (int32_t i = 0; i < d->n; i++) {
        bool any = false;
        for (int32_t j = 0; j < d->n && !any; j++) {
            any = counts[j] && dsu_same(d, i, j);
        }
        n += d->parent[i] == i && any;
    }
    return n;
}

static inline int32_t corner_face(const soup *s, int32_t c)
{
    int32_t f = 0;
    while (s->first[f + 1] <= c) {
        f++;
    }
    return f;
}

static inline int32_t corner_after(const soup *s, int32_t c)
{
    const int32_t f = corner_face(s, c);
    return c + 1 < s->first[f + 1] ? c + 1 : s->first[f];
}

/* Do input corners c and d start the same undirected edge? */
static inline bool same_edge(const soup *s, int32_t c, int32_t d)
{
    const int32_t a = s->index[c], b = s->index[corner_after(s, c)], x = s->index[d], y = s->index[corner_after(s, d)];
    return (a == x && b == y) || (a == y && b == x);
}

static inline bool isolated(const sl_mesh *m, int32_t f)
{
    return (m->face_flags[f] & (SL_FACE_DUPLICATE | SL_FACE_DEGENERATE)) != 0;
}

static inline bool listed(const int32_t *list, int32_t n, int32_t value)
{
    int32_t found = 0;
    for (int32_t i = 0; i < n; i++) {
        found += list[i] == value;
        assert_true(i == 0 || list[i - 1] < list[i]);
    }
    assert_true(found <= 1);
    return found == 1;
}

/* Corners, coordinates, counts. */
static inline void check_correspondence(const soup *s, const sl_mesh *m, const sl_repair_report *r)
{
    assert_int_equal(m->nf, s->nf);
    assert_int_equal(m->nh, s->first[s->nf]);
    assert_true(m->nv >= s->nv);
    int32_t used = 0, degrees[3] = {0};
    bool seen[SOUP_VERTICES] = {false};
    for (int32_t h = 0; h < m->nh; h++) {
        assert_int_equal(m->face[h], corner_face(s, h));
        assert_in_range(m->origin[h], 0, m->nv - 1);
        assert_int_equal(m->input_vertex[m->origin[h]], s->index[sl_input_corner(m, h)]);
        assert_int_equal(sl_next(m, sl_prev(m, h)), h);
        used += !seen[s->index[h]];
        seen[s->index[h]] = true;
    }
    for (int32_t v = 0; v < m->nv; v++) {
        assert_true(v >= s->nv || m->input_vertex[v] == v);
        for (int k = 0; k < 3; k++) {
            const double x = (s->xyz[3 * m->input_vertex[v] + k] - m->centre[k]) * m->scale;
            assert_true(!seen[m->input_vertex[v]] || m->xyz[3 * v + k] == x);
            assert_true(fabs(m->xyz[3 * v + k]) <= 0.5);
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        assert_int_equal(m->face_first[f], s->first[f]);
        degrees[sl_degree(m, f) > 4 ? 2 : sl_degree(m, f) - 3]++;
    }
    assert_int_equal(r->vertices, s->nv);
    assert_int_equal(r->faces, s->nf);
    assert_int_equal(r->unused_vertices, s->nv - used);
    assert_int_equal(r->triangles, degrees[0]);
    assert_int_equal(r->quads, degrees[1]);
    assert_int_equal(r->ngons, degrees[2]);
}

/* Zero vector area; exact where the coordinates are small whole numbers. */
static inline bool zero_area(const soup *s, int32_t f)
{
    double n[3] = {0.0, 0.0, 0.0}, reach = 0.0;
    for (int32_t c = s->first[f]; c < s->first[f + 1]; c++) {
        for (int k = 0; k < 3; k++) {
            reach = fmax(reach, fabs(s->xyz[3 * s->index[c] + k]));
        }
    }
    const int e = reach > 0.0 ? -ilogb(reach) : 0; /* against overflow of the products */
    for (int32_t c = s->first[f]; c < s->first[f + 1]; c++) {
        const double *p = s->xyz + 3 * s->index[c], *q = s->xyz + 3 * s->index[corner_after(s, c)];
        for (int k = 0; k < 3; k++) {
            n[k] += ldexp(p[(k + 1) % 3], e) * ldexp(q[(k + 2) % 3], e) -
                    ldexp(p[(k + 2) % 3], e) * ldexp(q[(k + 1) % 3], e);
        }
    }
    return n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0;
}

static inline bool contains(const soup *s, int32_t f, int32_t vertex)
{
    for (int32_t c = s->first[f]; c < s->first[f + 1]; c++) {
        if (s->index[c] == vertex) {
            return true;
        }
    }
    return false;
}

static inline bool same_vertices(const soup *s, int32_t f, int32_t g)
{
    bool same = s->first[f + 1] - s->first[f] == s->first[g + 1] - s->first[g];
    for (int32_t c = s->first[f]; c < s->first[f + 1] && same; c++) {
        same = contains(s, g, s->index[c]);
    }
    return same;
}

static inline void check_isolated(const soup *s, const sl_mesh *m, const sl_repair_report *r)
{
    int32_t flags[8] = {0};
    for (int32_t f = 0; f < m->nf; f++) {
        bool repeats = false, again = false;
        for (int32_t c = s->first[f]; c < s->first[f + 1]; c++) {
            for (int32_t d = s->first[f]; d < c; d++) {
                repeats = repeats || s->index[c] == s->index[d];
            }
        }
        const bool degenerate = repeats || zero_area(s, f);
        for (int32_t g = 0; g < f && !degenerate; g++) {
            again = again || (!isolated(m, g) && same_vertices(s, f, g));
        }
        assert_int_equal((m->face_flags[f] & SL_FACE_DEGENERATE) != 0, degenerate);
        assert_int_equal((m->face_flags[f] & SL_FACE_DUPLICATE) != 0, again);
        assert_int_equal(listed(r->degenerate, r->degenerate_faces, f), degenerate);
        assert_int_equal(listed(r->duplicate, r->duplicate_faces, f), again);
        assert_int_equal(listed(r->reversed, r->reversed_faces, f), (m->face_flags[f] & SL_FACE_REVERSED) != 0);
        assert_true(!isolated(m, f) || (m->face_flags[f] & SL_FACE_REVERSED) == 0);
        flags[m->face_flags[f] & 7]++;
    }
    assert_int_equal(r->degenerate_faces, flags[SL_FACE_DEGENERATE]);
    assert_int_equal(r->duplicate_faces, flags[SL_FACE_DUPLICATE]);
    assert_int_equal(r->reversed_faces, flags[SL_FACE_REVERSED]);
    assert_int_equal(r->isolated_faces, flags[SL_FACE_DEGENERATE] + flags[SL_FACE_DUPLICATE]);
}

/* The halfedge that runs along the edge of input corner c. */
static inline int32_t halfedge_of_corner(const sl_mesh *m, int32_t c)
{
    const int32_t f = m->face[c], first = m->face_first[f], d = sl_degree(m, f);
    return (m->face_flags[f] & SL_FACE_REVERSED) != 0 ? first + d - 1 - (c - first) : c;
}

/* Gluing: an edge is glued iff two facets of the surface share it, but for the cuts of one-sided components. */
static inline void check_twins(const soup *s, const sl_mesh *m, const sl_repair_report *r)
{
    int32_t unglued = 0, nonmanifold = 0;
    static dsu faces;
    static bool odd_face[CHECK_CORNERS], all[CHECK_CORNERS];
    dsu_init(&faces, m->nf);
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t t = m->twin[h];
        assert_int_equal(m->sew[h], -1);
        assert_true(t >= -1 && t < m->nh && t != h);
        assert_true(t < 0 || (m->twin[t] == h && m->origin[t] == sl_target(m, h) && m->origin[h] == sl_target(m, t)));
    }
    for (int32_t f = 0; f < m->nf; f++) {
        odd_face[f] = false;
        all[f] = !isolated(m, f);
    }
    for (int32_t c = 0; c < m->nh; c++) {
        const int32_t h = halfedge_of_corner(m, c);
        int32_t others = 0, other = -1;
        bool first = true;
        for (int32_t d = 0; d < m->nh && !isolated(m, m->face[c]); d++) {
            if (d != c && !isolated(m, m->face[d]) && same_edge(s, c, d)) {
                others++;
                other = d;
                first = first && d > c;
            }
        }
        if (others != 1) {
            assert_int_equal(m->twin[h], -1);
            nonmanifold += others > 1 && first;
            continue;
        }
        assert_true(m->twin[h] < 0 || m->twin[h] == halfedge_of_corner(m, other));
        unglued += m->twin[h] < 0 && first;
        if (!dsu_join(&faces, m->face[c], m->face[other], s->index[c] == s->index[other])) {
            odd_face[m->face[c]] = true;
        }
    }
    assert_int_equal(nonmanifold, r->nonmanifold_edges);
    assert_int_equal(unglued, r->one_sided_cuts);
    assert_int_equal(dsu_classes(&faces, all), r->components);
    assert_int_equal(dsu_classes(&faces, odd_face), r->one_sided_components);
    for (int32_t e = 0; e < nonmanifold; e++) {
        int32_t uses = 0;
        for (int32_t c = 0; c < m->nh; c++) {
            const int32_t a = s->index[c], b = s->index[corner_after(s, c)];
            uses += !isolated(m, m->face[c]) && ((a == r->nonmanifold[2 * e] && b == r->nonmanifold[2 * e + 1]) ||
                                                 (b == r->nonmanifold[2 * e] && a == r->nonmanifold[2 * e + 1]));
        }
        assert_true(uses >= 3);
    }
}

/* Each component keeps the winding that the larger part of its area has. */
static inline void check_majority(const sl_mesh *m)
{
    static dsu faces;
    dsu_init(&faces, m->nf);
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] >= 0) {
            dsu_join(&faces, m->face[h], m->face[m->twin[h]], 0);
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        double kept = 0.0;
        for (int32_t g = 0; g < m->nf; g++) {
            if (dsu_same(&faces, f, g)) {
                kept += (m->face_flags[g] & SL_FACE_REVERSED) != 0 ? -sl_mesh_face_area(m, g) : sl_mesh_face_area(m, g);
            }
        }
        assert_true(kept >= -1e-12);
    }
}

/* One fan a vertex, and the bowties: corners of a vertex that no edge of the input joins. */
static inline int32_t check_fans(const soup *s, const sl_mesh *m, const sl_repair_report *r)
{
    static dsu fans, joined;
    static bool surface[CHECK_CORNERS], all[CHECK_CORNERS];
    dsu_init(&fans, m->nh);
    dsu_init(&joined, m->nh);
    for (int32_t h = 0; h < m->nh; h++) {
        surface[h] = !isolated(m, m->face[h]);
        all[h] = true;
        if (m->twin[h] >= 0) {
            dsu_join(&fans, h, sl_next(m, m->twin[h]), 0);
        }
        for (int32_t g = 0; g < h && surface[h]; g++) {
            const int32_t a[2] = {h, sl_next(m, h)}, b[2] = {g, sl_next(m, g)};
            for (int k = 0; k < 4 && surface[g]; k++) {
                const bool ends = m->input_vertex[m->origin[a[k / 2]]] == m->input_vertex[m->origin[b[k % 2]]];
                const bool rest = m->input_vertex[m->origin[a[1 - k / 2]]] == m->input_vertex[m->origin[b[1 - k % 2]]];
                if (ends && rest) {
                    dsu_join(&joined, a[k / 2], b[k % 2], 0);
                }
            }
        }
    }
    for (int32_t h = 0; h < m->nh; h++) {
        for (int32_t g = 0; g < h; g++) {
            assert_int_equal(m->origin[g] == m->origin[h], dsu_same(&fans, g, h));
        }
    }
    assert_int_equal(dsu_classes(&fans, all), m->nv - r->unused_vertices);
    for (int32_t v = 0; v < s->nv; v++) {
        bool bowtie = false;
        for (int32_t h = 0; h < m->nh; h++) {
            for (int32_t g = 0; g < h && surface[h]; g++) {
                bowtie = bowtie || (surface[g] && m->input_vertex[m->origin[g]] == v &&
                                    m->input_vertex[m->origin[h]] == v && !dsu_same(&joined, g, h));
            }
        }
        assert_int_equal(listed(r->bowtie, r->bowtie_vertices, v), bowtie);
    }
    return dsu_classes(&fans, surface);
}

/* Border loops by looking for the next border halfedge by its vertex; Euler's formula for the genus. */
static inline void check_topology(const sl_mesh *m, const sl_repair_report *r, int32_t vertices)
{
    static bool seen[CHECK_CORNERS];
    int32_t loops = 0, edges = 0, faces = 0;
    for (int32_t h = 0; h < m->nh; h++) {
        seen[h] = m->twin[h] >= 0 || isolated(m, m->face[h]);
        edges += !isolated(m, m->face[h]) && m->twin[h] < h;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        faces += !isolated(m, f);
    }
    for (int32_t h = 0; h < m->nh; h++) {
        loops += !seen[h];
        for (int32_t b = h; !seen[b];) {
            seen[b] = true;
            int32_t next = -1;
            for (int32_t g = 0; g < m->nh; g++) {
                if (m->twin[g] < 0 && m->origin[g] == sl_target(m, b)) {
                    assert_int_equal(next, -1);
                    next = g;
                }
            }
            assert_true(next >= 0);
            b = next;
        }
    }
    assert_int_equal(loops, r->border_loops);
    assert_true(r->genus >= 0);
    assert_int_equal(vertices - edges + faces, 2 * r->components - 2 * r->genus - loops);
}

static inline void check_mesh(const soup *s, const sl_mesh *m, const sl_repair_report *r)
{
    check_correspondence(s, m, r);
    check_isolated(s, m, r);
    check_twins(s, m, r);
    check_majority(m);
    check_topology(m, r, check_fans(s, m, r));
}

#endif
