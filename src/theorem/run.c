/* The check over thousands of random graphs, in parallel. */
#include "base/memory.h"
#include "theorem/families_internal.h"

#include <string.h>

/* Graphs between two looks at progress: short enough for Ctrl-C, long enough to share. */
enum { SMALL_BATCH = 256, LARGE_BATCH = 8, LARGE_ONE_IN = 100 };

static const sl_theorem_family table[] = {
    {"planar", "patches of quads and triangles, mirrored at a border or along a row of fixed facets", sl_make_planar},
    {"strip", "long strips, mirrored at an end or along their length", sl_make_strip},
    {"tree", "two copies of a tree, joined here and there", sl_make_tree},
    {"sparse", "two copies of a random graph, connected or not", sl_make_sparse},
    {"grid", "grids, cylinders and tori: degenerate spectra, two mirrors that commute", sl_make_grid},
    {"fixed", "nodes fixed by the mirror between two connected halves", sl_make_fixed},
    {"lobes", "halves that fall apart into lobes, joined by fixed nodes; copies among them", sl_make_lobes},
    {"switched", "A'' not diagonal as given, but for another choice of halves", sl_make_switched},
    {"crossed", "any A'': random edges across", sl_make_crossed},
    {"turned", "half turns and exchanged coordinates of grids and tori: no choice of halves", sl_make_turned},
    {"commuting", "random graphs under D2: two mirrors that commute", sl_make_commuting},
    {"dihedral", "random graphs under D3, D4 and D5: two mirrors that do not", sl_make_dihedral},
};

const sl_theorem_family *sl_theorem_families(int32_t *count)
{
    *count = (int32_t)SL_COUNTOF(table);
    return table;
}

sl_theorem_run_def sl_theorem_run_default(void)
{
    return (sl_theorem_run_def){.graphs = 10000,
                                .seed = 1,
                                .least = 8,
                                .most = 192,
                                .large = 4096,
                                .check = sl_theorem_default(),
                                .undecided_share = 1e-3};
}

bool sl_theorem_signs_suffice(int64_t signs, int64_t undecided, int64_t most_undecided, double share)
{
    return (double)(undecided - most_undecided) <= share * (double)signs;
}

/* The last hundredth of the graphs is large. */
static int32_t small_graphs(const sl_theorem_run_def *def)
{
    return def->graphs - def->graphs / LARGE_ONE_IN;
}

/* Takes the first edge within half 1 away. */
static sl_status break_graph(sl_theorem_graph **graph)
{
    const sl_theorem_graph *g = *graph;
    sl_edges edges = {.pairs = g->pairs, .fixed = g->fixed};
    bool broken = false;
    for (int32_t i = 0; i < g->graph.n; i++) {
        for (int32_t p = g->graph.first[i]; p < g->graph.first[i + 1]; p++) {
            const int32_t j = g->graph.adj[p];
            if (j > i && !broken && j < g->pairs) {
                broken = true;
            } else if (j > i) {
                sl_edges_add(&edges, i, j);
            }
        }
    }
    sl_theorem_graph *out = NULL;
    const sl_status status = sl_edges_finish(&edges, &out);
    if (status == SL_OK) {
        sl_theorem_graph_free(*graph);
        *graph = out;
    }
    return status;
}

sl_status sl_theorem_graph_of(const sl_theorem_run_def *def, int32_t index, int32_t *family, sl_theorem_graph **out)
{
    sl_rng mix = sl_rng_seed(def->seed ^ ((uint64_t)index * UINT64_C(0xd1342543de82ef95)));
    sl_rng rng = sl_rng_seed(sl_rng_bits(&mix));
    const bool large = index >= small_graphs(def);
    const int32_t families = (int32_t)SL_COUNTOF(table);
    const int32_t least = large ? def->most + 1 : def->least, most = large ? def->large : def->most;
    const int32_t nodes = least + (most > least ? sl_rng_index(&rng, most - least + 1) : 0);
    *family = index % families;
    sl_status status = table[*family].make(&rng, nodes, out);
    if (status == SL_OK && index == 0 && def->check.sabotage == SL_THEOREM_BREAK_GRAPH) {
        status = break_graph(out);
    }
    return status;
}

/* One batch: graphs [first, first + count). */
typedef struct batch {
    const sl_theorem_run_def *def;
    int32_t first;
    int32_t *family;
    sl_theorem_result *result;
    sl_status *status;
} batch;

/* The second mirror by itself: the graph renumbered by it. */
static sl_status check_second(const sl_theorem_graph *graph, const sl_theorem_def *def, sl_theorem_result *result)
{
    sl_theorem_graph *other = NULL;
    sl_theorem_result more;
    sl_status status = SL_OK;
    SL_TRY(sl_theorem_graph_from_mirror(&graph->graph, graph->second, NULL, &other));
    SL_TRY(sl_theorem_check(other, def, NULL, &more));
    sl_theorem_add(result, &more);
    result->graphs--;
    result->nodes -= more.nodes;
cleanup:
    sl_theorem_graph_free(other);
    return status;
}

static sl_status check_graph(const sl_theorem_run_def *def, int32_t index, int32_t *family, sl_theorem_result *result)
{
    sl_theorem_graph *graph = NULL;
    sl_theorem_def check = def->check;
    sl_status status = SL_OK;
    check.sabotage = index == 0 ? check.sabotage : SL_THEOREM_BREAK_NONE;
    SL_TRY(sl_theorem_graph_of(def, index, family, &graph));
    SL_TRY(sl_theorem_check(graph, &check, NULL, result));
    if (graph->second != NULL) {
        SL_TRY(check_second(graph, &check, result));
    }
cleanup:
    sl_theorem_graph_free(graph);
    return status;
}

static void run_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    batch *b = user;
    (void)chunk;
    for (int64_t k = begin; k < end; k++) {
        b->status[k] = check_graph(b->def, b->first + (int32_t)k, &b->family[k], &b->result[k]);
    }
}

/* Sums in the order of the graphs. */
static sl_status add_batch(const batch *b, int32_t count, sl_theorem_run *run)
{
    for (int32_t k = 0; k < count; k++) {
        if (b->status[k] != SL_OK) {
            return b->status[k];
        }
        sl_theorem_add(&run->family[b->family[k]], &b->result[k]);
        sl_theorem_add(&run->total, &b->result[k]);
        if (run->violated < 0 && b->result[k].failed != SL_THEOREM_STATEMENTS) {
            run->violated = b->first + k;
            run->evidence = b->result[k];
        }
    }
    return SL_OK;
}

static void judge_signs(const sl_theorem_run_def *def, sl_theorem_run *run)
{
    for (int32_t k = 0; k < SL_THEOREM_STATEMENTS; k++) {
        run->signs += run->total.tally[k].signs;
        run->signs_undecided += run->total.tally[k].signs_undecided;
    }
    run->decided =
        sl_theorem_signs_suffice(run->signs, run->signs_undecided, run->total.most_undecided, def->undecided_share);
}

sl_status sl_theorem_run_all(const sl_theorem_run_def *def, const sl_context *context, sl_theorem_run **out)
{
    batch b = {.def = def};
    sl_status status = SL_OK;
    sl_theorem_run *run = sl_calloc(1, sizeof *run);
    *out = NULL;
    b.family = sl_alloc(SMALL_BATCH, sizeof *b.family);
    b.result = sl_alloc(SMALL_BATCH, sizeof *b.result);
    b.status = sl_alloc(SMALL_BATCH, sizeof *b.status);
    SL_TRY(run != NULL && b.family != NULL && b.result != NULL && b.status != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    run->families = (int32_t)SL_COUNTOF(table);
    run->violated = -1;
    run->family = sl_calloc(run->families, sizeof *run->family);
    SL_TRY(run->family != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_theorem_check_figure17(&run->total));
    const int32_t small = small_graphs(def);
    for (b.first = 0; b.first < def->graphs;) {
        const bool large = b.first >= small;
        const int32_t end = large ? def->graphs : small, most = large ? LARGE_BATCH : SMALL_BATCH;
        const int32_t count = end - b.first < most ? end - b.first : most;
        SL_TRY(sl_report_progress(context, large ? "large" : "graphs", (double)b.first / def->graphs));
        sl_parallel_for(context, count, 1, run_chunk, &b);
        SL_TRY(add_batch(&b, count, run));
        b.first += count;
    }
    judge_signs(def, run);
    *out = run;
    run = NULL;
cleanup:
    sl_theorem_run_free(run);
    sl_free(b.family);
    sl_free(b.result);
    sl_free(b.status);
    return status;
}

void sl_theorem_run_free(sl_theorem_run *run)
{
    if (run == NULL) {
        return;
    }
    sl_free(run->family);
    sl_free(run);
}
