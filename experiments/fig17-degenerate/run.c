/* Figure 17: the paper's degenerate graph, its whole spectrum, and the eigenvector that the paper meant. */
#include "support/csv.h"
#include "support/main.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = 4, NODES = 2 * N, SWEEPS = 60 };

static const double equal = 1e-9; /* eigenvalues nearer than this are the same: the graph's lie 0.7 apart */
static const double printed[NODES] = {0, -1, 1, 0, 0, 0, 0, 0}, corrected[NODES] = {0, -1, 0, 1, 0, 0, 0, 0};

/* Where the nodes are drawn: V1 left, V2 its mirror image; 1 - 5 and 3 - 7 cross the axis. */
static const double place[N][2] = {{-0.55, 1.0}, {-2.1, 0.0}, {-0.55, -1.0}, {-1.05, 0.0}};

/* L = A - D of the graph, and its halves A' + A'' - D and A' - A'' - D. */
typedef struct matrices {
    double whole[NODES * NODES], symmetric[N * N], antisymmetric[N * N];
} matrices;

static sl_status matrices_create(const sl_theorem_graph *g, matrices *m)
{
    if (g->pairs != N || g->fixed != 0) {
        return SL_INTERNAL;
    }
    memset(m, 0, sizeof *m);
    for (int32_t i = 0; i < NODES; i++) {
        for (int32_t p = g->graph.first[i]; p < g->graph.first[i + 1]; p++) {
            m->whole[i * NODES + g->graph.adj[p]] += 1.0;
            m->whole[i * NODES + i] -= 1.0;
        }
    }
    for (int32_t i = 0; i < N; i++) {
        for (int32_t j = 0; j < N; j++) {
            const double inner = m->whole[i * NODES + j], across = m->whole[i * NODES + N + j];
            m->symmetric[i * N + j] = inner + across;
            m->antisymmetric[i * N + j] = inner - across;
        }
    }
    return SL_OK;
}

/* Eigenvalues of a small symmetric matrix, descending, by cyclic Jacobi rotations: none of the program's solvers. A is
 * destroyed. */
static void eigenvalues(int32_t n, double *A, double *lambda)
{
    for (int32_t sweep = 0; sweep < SWEEPS; sweep++) {
        for (int32_t p = 0; p < n; p++) {
            for (int32_t q = p + 1; q < n; q++) {
                const double off = A[p * n + q], theta = off != 0.0 ? 0.5 * (A[q * n + q] - A[p * n + p]) / off : 0.0;
                const double t = off != 0.0 ? copysign(1.0, theta) / (fabs(theta) + hypot(theta, 1.0)) : 0.0;
                const double c = 1.0 / hypot(t, 1.0), s = t * c;
                for (int32_t k = 0; k < n; k++) {
                    const double a = A[k * n + p], b = A[k * n + q];
                    A[k * n + p] = c * a - s * b;
                    A[k * n + q] = s * a + c * b;
                }
                for (int32_t k = 0; k < n; k++) {
                    const double a = A[p * n + k], b = A[q * n + k];
                    A[p * n + k] = c * a - s * b;
                    A[q * n + k] = s * a + c * b;
                }
            }
        }
    }
    for (int32_t i = 0; i < n; i++) {
        int32_t at = i;
        for (; at > 0 && lambda[at - 1] < A[i * n + i]; at--) {
            lambda[at] = lambda[at - 1];
        }
        lambda[at] = A[i * n + i];
    }
}

static int32_t multiplicity(int32_t n, const double *lambda, double value)
{
    int32_t count = 0;
    for (int32_t k = 0; k < n; k++) {
        count += fabs(lambda[k] - value) < equal;
    }
    return count;
}

static void multiply(const double *A, const double v[NODES], double out[NODES])
{
    for (int32_t i = 0; i < NODES; i++) {
        out[i] = 0.0;
        for (int32_t j = 0; j < NODES; j++) {
            out[i] += A[i * NODES + j] * v[j];
        }
    }
}

/* |L v - q v| / |v| with Rayleigh's quotient q: 0 for an eigenvector. */
static double residual(const double *L, const double v[NODES])
{
    double Lv[NODES], q = 0.0, square = 0.0, sum = 0.0;
    multiply(L, v, Lv);
    for (int32_t i = 0; i < NODES; i++) {
        q += v[i] * Lv[i];
        square += v[i] * v[i];
    }
    for (int32_t i = 0; i < NODES; i++) {
        const double r = Lv[i] - q / square * v[i];
        sum += r * r;
    }
    return sqrt(sum / square);
}

/* v + v mirrored, or with sign -1 v - v mirrored: half their sum is v. */
static void part(const double v[NODES], double sign, double out[NODES])
{
    for (int32_t i = 0; i < NODES; i++) {
        out[i] = v[i] + sign * v[(i + N) % NODES];
    }
}

/* nodes.csv: a vector's value at every node of every panel; edges.csv: the graph once. */
static sl_status write_nodes(exp_run *run, const double *const vector[], int32_t panels)
{
    sl_writer *w = NULL;
    sl_status status = SL_OK;
    SL_TRY(exp_csv_open(run, "nodes.csv", "panel,node,x,y,half,value", &w));
    for (int32_t k = 0; k < panels; k++) {
        for (int32_t i = 0; i < NODES; i++) {
            const double *p = place[i % N];
            sl_writer_format(w, "%d,%d,%g,%g,%d,%g\n", k, i + 1, i < N ? p[0] : -p[0], p[1], 1 + i / N, vector[k][i]);
        }
    }
    SL_TRY(exp_csv_close(run, &w));
cleanup:
    sl_writer_abandon(w);
    return status;
}

static sl_status write_edges(exp_run *run, const sl_graph *g)
{
    sl_writer *w = NULL;
    sl_status status = SL_OK;
    SL_TRY(exp_csv_open(run, "edges.csv", "across,x,y,dx,dy", &w));
    for (int32_t i = 0; i < NODES; i++) {
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const int32_t j = g->adj[p];
            const double x = i < N ? place[i % N][0] : -place[i % N][0], u = j < N ? place[j % N][0] : -place[j % N][0];
            if (i < j) {
                sl_writer_format(w, "%d,%g,%g,%g,%g\n", (i < N) != (j < N), x, place[i % N][1], u - x,
                                 place[j % N][1] - place[i % N][1]);
            }
        }
    }
    SL_TRY(exp_csv_close(run, &w));
cleanup:
    sl_writer_abandon(w);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(
        page,
        "<p>The appendix builds a graph whose two half spectra overlap, so that a solver may return an eigenvector "
        "that "
        "is neither symmetric nor antisymmetric. It prints (0,&nbsp;&minus;1,&nbsp;1,&nbsp;0,&nbsp;&hellip;): that is "
        "no "
        "eigenvector at all, <i>L</i> sends it to "
        "(&minus;1,&nbsp;3,&nbsp;&minus;4,&nbsp;1,&nbsp;0,&nbsp;0,&nbsp;1,&nbsp;0). "
        "(0,&nbsp;&minus;1,&nbsp;0,&nbsp;1,&nbsp;0,&nbsp;&hellip;) is one, for &minus;2, and it is what was meant: "
        "half the sum "
        "of a symmetric and an antisymmetric one of the same eigenvalue. That antisymmetric vector is 0 on both edges "
        "of the "
        "axis, so its seam does not contain the axis: the claim that all of them do needs <i>v</i>&nbsp;&ne;&nbsp;0 "
        "there.</p>\n");
}

/* The spectrum of L beside those of its halves, each value once. */
static void spectrum_table(exp_page *page, exp_claims *claims, matrices *m)
{
    double whole[NODES], symmetric[N], antisymmetric[N];
    int32_t overlaps = 0, mismatches = 0;
    eigenvalues(NODES, m->whole, whole);
    eigenvalues(N, m->symmetric, symmetric);
    eigenvalues(N, m->antisymmetric, antisymmetric);
    exp_page_table_begin(page,
                         "eigenvalue of L = A &minus; D|times|of A&prime; + A&Prime; &minus; D|of A&prime; &minus; "
                         "A&Prime; &minus; D|");
    for (int32_t k = 0; k < NODES; k++) {
        if (k > 0 && fabs(whole[k] - whole[k - 1]) < equal) {
            continue;
        }
        const int32_t times = multiplicity(NODES, whole, whole[k]), s = multiplicity(N, symmetric, whole[k]),
                      a = multiplicity(N, antisymmetric, whole[k]);
        overlaps += s > 0 && a > 0;
        mismatches += times != s + a;
        exp_page_row_begin(page, times != s + a);
        exp_page_cell(page, "%.6f", fabs(whole[k]) < equal ? 0.0 : whole[k]);
        exp_page_cell(page, "%d", times);
        exp_page_cell(page, "%d", s);
        exp_page_cell(page, "%d", a);
        exp_page_cell(page, "%s", s > 0 && a > 0 ? "common: any mixture is an eigenvector" : "");
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
    exp_claims_measure(claims, "graph", "eigenvalues that both halves have", overlaps);
    exp_claims_measure(claims, "graph", "eigenvalues that the halves do not account for", mismatches);
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    sl_theorem_graph *graph = NULL;
    matrices m;
    double image[NODES], symmetric[NODES], antisymmetric[NODES];
    static const double nothing[NODES] = {0};
    const double *const panel[] = {nothing, printed, image, symmetric, antisymmetric, corrected};
    SL_TRY(sl_theorem_figure17(&graph));
    SL_TRY(matrices_create(graph, &m));
    multiply(m.whole, printed, image);
    part(corrected, 1.0, symmetric);
    part(corrected, -1.0, antisymmetric);
    exp_claims_measure(claims, "graph", "residual of the printed vector", residual(m.whole, printed));
    exp_claims_measure(claims, "graph", "residual of the corrected vector", residual(m.whole, corrected));
    exp_claims_measure(claims, "graph", "residual of its symmetric part", residual(m.whole, symmetric));
    exp_claims_measure(claims, "graph", "residual of its antisymmetric part", residual(m.whole, antisymmetric));
    exp_claims_measure(claims, "graph", "antisymmetric part on the axis",
                       fmax(fabs(antisymmetric[0]), fabs(antisymmetric[2])));
    SL_TRY(write_nodes(run, panel, (int32_t)SL_COUNTOF(panel)));
    SL_TRY(write_edges(run, &graph->graph));
    introduce(page);
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(
        page, "", "graph.svg", "the graph, the printed vector and its image, the corrected vector and its parts",
        "The graph (<i>A&prime;</i> grey, <i>A&Prime;</i> green, <i>V</i><sup>1</sup> blue, <i>V</i><sup>2</sup> "
        "red); the vector as printed and what <i>L</i> makes of it; the corrected one (bottom right) as half the sum "
        "of its symmetric and antisymmetric parts, all three of eigenvalue &minus;2.");
    exp_page_html(page, "</div>\n");
    spectrum_table(page, claims, &m);
cleanup:
    sl_theorem_graph_free(graph);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig17-degenerate", "Figure 17: a degenerate graph", NULL, EXPECTED_CSV, show);
}
