/* Auto-sew: neighbouring charts are merged, the most intertwined first, while the merged chart stays valid. */
#include "segment/sew_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BATCH_MIN 8        /* merges tried at a time: independent of the number of threads */
#define BATCH_SHARE 16     /* or this share of the charts */
#define DIGITS 1e9         /* shares are told apart to */
#define ATTEMPTS_A_CHART 8 /* bound on merges tried, for each chart at the start */

/* Two charts with a common seam. */
typedef struct pair {
    int32_t a, b;  /* numbers of charts, a < b */
    double length; /* of the common seam */
    double share;  /* of the smaller perimeter, to nine digits */
    double weight; /* of all perimeters, to nine digits: between pairs of the same share, as where charts cap others */
} pair;

/* A merge that failed, by the charts' stamps. */
typedef struct refusal {
    int32_t a, b;
} refusal;

typedef struct sew_state {
    sl_sewing sewing;
    sl_mesh *work;
    sl_job_list *charts;
    uint8_t *sewable;
    int32_t *chart_of; /* nf */
    int32_t *stamp;    /* charts: changes with every merge; -1 = merged into another */
    double *perimeter; /* charts */
    uint8_t *busy;     /* charts taken by the batch */
    int32_t next_stamp;
    pair *pairs;
    int64_t npairs, pair_capacity;
    refusal *refused; /* sorted */
    int64_t nrefused, refused_capacity;
    pair *batch;
    sl_chart_job *job; /* the batch's results */
    int32_t nbatch, batch_size;
} sew_state;

static void sew_state_clear(sew_state *s)
{
    for (int32_t k = 0; s->job != NULL && k < s->batch_size; k++) {
        sl_chart_job_clear(&s->job[k]);
    }
    sl_free(s->sewable);
    sl_free(s->chart_of);
    sl_free(s->stamp);
    sl_free(s->perimeter);
    sl_free(s->busy);
    sl_free(s->pairs);
    sl_free(s->refused);
    sl_free(s->batch);
    sl_free(s->job);
}

static int by_charts(const void *x, const void *y)
{
    const pair *p = x, *q = y;
    return p->a != q->a ? (p->a > q->a) - (p->a < q->a) : (p->b > q->b) - (p->b < q->b);
}

static int by_share(const void *x, const void *y)
{
    const pair *p = x, *q = y;
    if (p->share != q->share) {
        return p->share < q->share ? 1 : -1;
    }
    return p->weight != q->weight ? (p->weight < q->weight) - (p->weight > q->weight) : by_charts(x, y);
}

static int by_stamps(const void *x, const void *y)
{
    const refusal *p = x, *q = y;
    return p->a != q->a ? (p->a > q->a) - (p->a < q->a) : (p->b > q->b) - (p->b < q->b);
}

static refusal make_refusal(const sew_state *s, const pair *p)
{
    const int32_t a = s->stamp[p->a], b = s->stamp[p->b];
    return a < b ? (refusal){a, b} : (refusal){b, a};
}

static bool was_refused(const sew_state *s, const pair *p)
{
    const refusal key = make_refusal(s, p);
    return s->nrefused > 0 && bsearch(&key, s->refused, (size_t)s->nrefused, sizeof key, by_stamps) != NULL;
}

/* While pairs are collected an edge is one entry and `share` holds its halfedge number: lengths are then summed in a
 * fixed order, whatever qsort does with equal elements. */
static int by_charts_then_halfedge(const void *x, const void *y)
{
    const int order = by_charts(x, y);
    const double p = ((const pair *)x)->share, q = ((const pair *)y)->share;
    return order != 0 ? order : (p > q) - (p < q);
}

/* So that equal ones compare as equal, whatever the order in which they were summed. */
static double to_nine_digits(double x)
{
    return rint(DIGITS * x) / DIGITS;
}

static void sum_pairs(sew_state *s)
{
    int64_t n = 0;
    double all = 0.0;
    for (int64_t c = 0; c < s->charts->count; c++) {
        all += s->perimeter[c];
    }
    for (int64_t k = 0; k < s->npairs; k++) {
        if (n > 0 && by_charts(&s->pairs[n - 1], &s->pairs[k]) == 0) {
            s->pairs[n - 1].length += s->pairs[k].length;
        } else {
            s->pairs[n++] = s->pairs[k];
        }
    }
    s->npairs = n;
    for (int64_t k = 0; k < n; k++) {
        const double smaller = fmin(s->perimeter[s->pairs[k].a], s->perimeter[s->pairs[k].b]);
        s->pairs[k].share = smaller > 0.0 ? to_nine_digits(s->pairs[k].length / smaller) : 0.0;
        s->pairs[k].weight = all > 0.0 ? to_nine_digits(s->pairs[k].length / all) : 0.0;
    }
}

/* All pairs of charts with a seam that may be sewn, the largest share of the smaller perimeter first. */
static sl_status collect_pairs(sew_state *s)
{
    sl_status status = SL_OK;
    const sl_mesh *m = s->work;
    s->npairs = 0;
    memset(s->perimeter, 0, (size_t)s->charts->count * sizeof *s->perimeter);
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t a = s->chart_of[m->face[h]];
        if (a < 0) { /* the facet copies another's UVs and has no chart */
            continue;
        }
        const double length = m->twin[h] < 0 ? sl_mesh_edge_length(m, h) : 0.0;
        s->perimeter[a] += length;
        const int32_t b = m->sew[h] >= 0 ? s->chart_of[m->face[m->sew[h]]] : a;
        if (a < b && s->sewable[h]) {
            SL_TRY(sl_reserve((void **)&s->pairs, &s->pair_capacity, s->npairs + 1, sizeof *s->pairs));
            s->pairs[s->npairs++] = (pair){a, b, length, (double)h, 0.0};
        }
    }
    if (s->npairs > 0) {
        qsort(s->pairs, (size_t)s->npairs, sizeof *s->pairs, by_charts_then_halfedge);
        sum_pairs(s);
        qsort(s->pairs, (size_t)s->npairs, sizeof *s->pairs, by_share);
    }
cleanup:
    return status;
}

/* The best pairs that share no chart and were not refused before. */
static void choose_batch(sew_state *s)
{
    memset(s->busy, 0, (size_t)s->charts->count);
    s->nbatch = 0;
    for (int64_t k = 0; k < s->npairs && s->nbatch < s->batch_size; k++) {
        const pair *p = &s->pairs[k];
        if (!s->busy[p->a] && !s->busy[p->b] && !was_refused(s, p)) {
            s->busy[p->a] = s->busy[p->b] = 1;
            s->batch[s->nbatch++] = *p;
        }
    }
}

static void merge_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const sew_state *s = user;
    for (int64_t k = begin; k < end; k++) {
        const pair *p = &s->batch[k];
        sl_merge_charts(&s->sewing, &s->charts->job[p->a], &s->charts->job[p->b], &s->job[k]);
    }
}

/* b becomes part of a. */
static void accept(sew_state *s, const pair *p, sl_chart_job *merged)
{
    sl_sew_list(s->work, &merged->joined);
    for (int32_t k = 0; k < merged->count; k++) {
        s->chart_of[merged->face[k]] = p->a;
    }
    sl_chart_job_clear(&s->charts->job[p->a]);
    sl_chart_job_clear(&s->charts->job[p->b]);
    s->charts->job[p->a] = *merged;
    *merged = (sl_chart_job){0};
    s->stamp[p->a] = s->next_stamp++;
    s->stamp[p->b] = -1;
}

static sl_status harvest_batch(sew_state *s, int32_t *merges)
{
    sl_status status = SL_OK;
    for (int32_t k = 0; k < s->nbatch; k++) {
        SL_TRY(s->job[k].status);
    }
    for (int32_t k = 0; k < s->nbatch; k++) {
        if (s->job[k].done) {
            accept(s, &s->batch[k], &s->job[k]);
            (*merges)++;
        } else {
            SL_TRY(sl_reserve((void **)&s->refused, &s->refused_capacity, s->nrefused + 1, sizeof *s->refused));
            s->refused[s->nrefused++] = make_refusal(s, &s->batch[k]);
            sl_chart_job_clear(&s->job[k]);
        }
    }
    if (s->nrefused > 0) {
        qsort(s->refused, (size_t)s->nrefused, sizeof *s->refused, by_stamps);
    }
cleanup:
    return status;
}

/* Edges that the caller had cut before stay, axes too, and with protect_first those of the first cuts. */
static void mark_sewable(sew_state *s, const sl_mesh *original, const uint8_t *first_cut, bool protect)
{
    for (int32_t h = 0; h < s->work->nh; h++) {
        const bool stays = first_cut[h] == SL_CUT_AXIS || (protect && first_cut[h] != 0);
        s->sewable[h] = original->twin[h] >= 0 && s->work->sew[h] >= 0 && !stays;
    }
}

static sl_status sew_state_create(sew_state *s)
{
    const int64_t n = s->charts->count;
    s->batch_size = (int32_t)(n / BATCH_SHARE > BATCH_MIN ? n / BATCH_SHARE : BATCH_MIN);
    s->sewable = sl_alloc(s->work->nh, sizeof *s->sewable);
    s->chart_of = sl_alloc(s->work->nf, sizeof *s->chart_of);
    s->stamp = sl_alloc(n, sizeof *s->stamp);
    s->perimeter = sl_alloc(n, sizeof *s->perimeter);
    s->busy = sl_alloc(n, sizeof *s->busy);
    s->batch = sl_alloc(s->batch_size, sizeof *s->batch);
    s->job = sl_calloc(s->batch_size, sizeof *s->job);
    if (s->sewable == NULL || s->chart_of == NULL || s->stamp == NULL || s->perimeter == NULL || s->busy == NULL ||
        s->batch == NULL || s->job == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(s->chart_of, 0xff, (size_t)s->work->nf * sizeof *s->chart_of);
    for (int32_t c = 0; c < n; c++) {
        s->stamp[c] = s->next_stamp++;
        for (int32_t k = 0; k < s->charts->job[c].count; k++) {
            s->chart_of[s->charts->job[c].face[k]] = c;
        }
    }
    return SL_OK;
}

/* Drops the places of charts that were merged into others. */
static void compact(sl_job_list *charts)
{
    int64_t n = 0;
    for (int64_t k = 0; k < charts->count; k++) {
        if (charts->job[k].face != NULL) {
            const sl_chart_job job = charts->job[k];
            charts->job[k] = (sl_chart_job){0};
            charts->job[n++] = job;
        }
    }
    charts->count = n;
}

sl_status sl_sew_charts(sl_mesh *work, const sl_mesh *original, const sl_triangulation *triangulation,
                        const uint8_t *first_cut, const sl_segment_def *def, const sl_context *context,
                        sl_job_list *charts, int32_t *merges)
{
    sl_status status = SL_OK;
    const sl_context quiet = sl_quiet_context(context);
    const int64_t limit = ATTEMPTS_A_CHART * charts->count;
    sew_state s = {.work = work, .charts = charts};
    *merges = 0;
    SL_TRY(sew_state_create(&s));
    mark_sewable(&s, original, first_cut, def->protect_first);
    s.sewing = (sl_sewing){work, triangulation, s.sewable, def->flatten, &quiet};
    s.sewing.flatten.max_stretch = fmin(def->sew_stretch, def->flatten.max_stretch);
    for (int64_t attempts = 0; attempts < limit; attempts += s.nbatch) {
        SL_TRY(sl_report_progress(context, "sew", (double)attempts / (double)limit));
        SL_TRY(collect_pairs(&s));
        choose_batch(&s);
        if (s.nbatch == 0) {
            break;
        }
        sl_parallel_for(context, s.nbatch, 1, merge_range, &s);
        SL_TRY(harvest_batch(&s, merges));
    }
    compact(charts);
cleanup:
    sew_state_clear(&s);
    return status;
}
