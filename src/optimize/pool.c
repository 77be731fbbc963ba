/* The candidates of all charts: made for new charts, guessed at, probed. */
#include "optimize/cut_internal.h"

#include "base/memory.h"

#include <string.h>

static const int32_t SMALL = 1000; /* triangles of a chart that costs no more than surroundings */
static const int32_t PROBE_STEPS = 4;

void sl_opt_pool_clear(sl_opt_pool *p)
{
    for (int64_t k = 0; k < p->count; k++) {
        sl_opt_trial_clear(&p->trial[k]);
    }
    sl_free(p->trial);
    sl_free(p->stamp);
    sl_free(p->parted);
}

void sl_opt_pool_drop(sl_opt_pool *p, int64_t k)
{
    sl_opt_trial_clear(&p->trial[k]);
    p->count--;
    memmove(p->trial + k, p->trial + k + 1, (size_t)(p->count - k) * sizeof *p->trial);
    memmove(p->stamp + k, p->stamp + k + 1, (size_t)(p->count - k) * sizeof *p->stamp);
}

static int32_t chart_of_stamp(const sl_opt_state *state, int32_t stamp)
{
    for (int32_t c = 0; c < state->nchart; c++) {
        if (state->chart[c].stamp == stamp) {
            return c;
        }
    }
    return -1;
}

static sl_status add_candidates(const sl_opt_state *state, int32_t c, sl_opt_pool *p)
{
    sl_status status = SL_OK;
    sl_opt_trial *list = NULL;
    int32_t count = 0;
    SL_TRY(sl_opt_candidates(state, c, &list, &count));
    SL_TRY(sl_reserve((void **)&p->trial, &p->capacity, p->count + count + 1, sizeof *p->trial));
    SL_TRY(sl_reserve((void **)&p->stamp, &p->stamp_capacity, p->count + count + 1, sizeof *p->stamp));
    for (int32_t k = 0; k < count; k++) {
        if (list[k].nedge > 0) {
            p->stamp[p->count] = state->chart[c].stamp;
            p->trial[p->count++] = list[k];
            list[k] = (sl_opt_trial){0};
        }
    }
cleanup:
    for (int32_t k = 0; list != NULL && k < count; k++) {
        sl_opt_trial_clear(&list[k]);
    }
    sl_free(list);
    return status;
}

typedef struct probing {
    const sl_opt_state *state;
    sl_opt_trial **trial;
} probing;

static void guess_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const probing *p = user;
    for (int64_t k = begin; k < end; k++) {
        p->trial[k]->status = sl_opt_trial_guess(p->state, p->trial[k]);
    }
}

static void probe_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const probing *p = user;
    for (int64_t k = begin; k < end; k++) {
        sl_opt_trial *trial = p->trial[k];
        trial->probed = true;
        trial->status = sl_opt_trial_make(p->state, trial);
        if (trial->status == SL_OK) {
            trial->status = sl_opt_trial_probe(p->state, PROBE_STEPS, trial);
        }
    }
}

/* Runs the trials side by side. */
static sl_status run_trials(const sl_opt_state *state, sl_opt_trial **list, int64_t count, sl_chunk_fn *range)
{
    sl_status status = SL_OK;
    probing all = {state, list};
    sl_parallel_for(state->context, count, 1, range, &all);
    for (int64_t k = 0; k < count; k++) {
        SL_TRY(list[k]->status);
    }
cleanup:
    return status;
}

sl_status sl_opt_probe_all(const sl_opt_state *state, sl_opt_trial **list, int64_t count)
{
    return run_trials(state, list, count, probe_range);
}

sl_status sl_opt_pool_refresh(sl_opt_state *state, sl_opt_pool *p)
{
    sl_status status = SL_OK;
    for (int64_t k = p->count; k-- > 0;) {
        const int32_t c = chart_of_stamp(state, p->stamp[k]);
        if (c < 0) {
            sl_opt_pool_drop(p, k);
        } else {
            p->trial[k].old[0] = c;
        }
    }
    const int64_t first = p->count;
    for (int32_t c = 0; c < state->nchart; c++) {
        if (state->chart[c].stamp >= p->next_stamp) {
            SL_TRY(add_candidates(state, c, p));
        }
    }
    p->next_stamp = state->next_stamp;
    state->info.trials += (int32_t)(p->count - first);
    sl_opt_trial **fresh = sl_alloc(p->count - first, sizeof *fresh);
    SL_TRY(fresh == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int64_t k = first; k < p->count; k++) {
        fresh[k - first] = &p->trial[k];
    }
    int64_t small = 0;
    for (int64_t k = 0; k < p->count - first; k++) {
        sl_opt_trial *trial = fresh[k];
        if (state->chart[trial->old[0]].patch->nt < SMALL) {
            fresh[k] = fresh[small];
            fresh[small++] = trial;
        }
    }
    status = run_trials(state, fresh, small, probe_range);
    status = status == SL_OK ? run_trials(state, fresh + small, p->count - first - small, guess_range) : status;
    sl_free(fresh);
cleanup:
    return status;
}

sl_status sl_opt_pool_add_parting(const sl_opt_state *state, int32_t c, sl_opt_pool *p)
{
    sl_status status = SL_OK;
    const int32_t stamp = state->chart[c].stamp;
    for (int64_t k = 0; k < p->nparted; k++) {
        if (p->parted[k] == stamp) {
            return SL_OK;
        }
    }
    SL_TRY(sl_reserve((void **)&p->parted, &p->parted_capacity, p->nparted + 1, sizeof *p->parted));
    SL_TRY(sl_reserve((void **)&p->trial, &p->capacity, p->count + 1, sizeof *p->trial));
    SL_TRY(sl_reserve((void **)&p->stamp, &p->stamp_capacity, p->count + 1, sizeof *p->stamp));
    p->parted[p->nparted++] = p->stamp[p->count] = stamp;
    SL_TRY(sl_opt_part(state, c, &p->trial[p->count++]));
    p->trial[p->count - 1].probed = true;
cleanup:
    return status;
}
