#include <math.h>

#include "base/memory.h"
#include "mesh/pair_internal.h"

enum {
    ROUNDS = 200, /* messages reach so many facets; spot's strips need about 100 */
};

static const double damping = 0.5;     /* share of the old message kept: without it even rings oscillate */
static const double settled = 0x1p-20; /* largest change of a message at which the rounds end */

/* A pair is worth 1, plus a quad's shape by its squared defect: one bad quad is worse than two mediocre ones. */
static double weight_of(double score)
{
    return score > 0.0 ? 2.0 - (1.0 - score) * (1.0 - score) : 0.0;
}

/* The best that facet f's edges other than h offer, 0 = stay alone. */
static double best_other(const sl_mesh *m, const double *score, const double *message, int32_t h)
{
    const int32_t f = m->face[h];
    double best = 0.0;
    for (int32_t x = m->face_first[f]; x < m->face_first[f + 1]; x++) {
        if (x != h && score[x] > 0.0) {
            best = fmax(best, message[m->twin[x]]);
        }
    }
    return best;
}

/* One synchronous round; returns the largest change. */
static double pass_messages(const sl_mesh *m, const double *score, const double *old, double *message)
{
    double change = 0.0;
    for (int32_t h = 0; h < m->nh; h++) {
        if (score[h] > 0.0) {
            const double fresh = weight_of(score[h]) - best_other(m, score, old, h);
            message[h] = damping * old[h] + (1.0 - damping) * fresh;
            change = fmax(change, fabs(message[h] - old[h]));
        }
    }
    return change;
}

sl_status sl_pair_beliefs(const sl_mesh *mesh, const double *score, double *belief)
{
    double *message = sl_calloc(mesh->nh, sizeof *message), *fresh = sl_calloc(mesh->nh, sizeof *fresh);
    if (message == NULL || fresh == NULL) {
        sl_free(message);
        sl_free(fresh);
        return SL_OUT_OF_MEMORY;
    }
    double change = HUGE_VAL;
    for (int round = 0; round < ROUNDS && change > settled; round++) {
        change = pass_messages(mesh, score, message, fresh);
        double *t = message;
        message = fresh;
        fresh = t;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        belief[h] = score[h] > 0.0 ? message[h] + message[mesh->twin[h]] - weight_of(score[h]) : -HUGE_VAL;
    }
    sl_free(message);
    sl_free(fresh);
    return SL_OK;
}
