/* Random sessions over the generated models: the invariants after every action, refusals that change nothing, undo and
 * redo that give the very bytes back, and the whole thing again from its lines.
 *   random_sessions ACTIONS SEED MODEL...     (ACTIONS a model; "all" = every model) */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "edit/script.h"
#include "edit_support.h"
#include "generators.h"

typedef struct tally {
    int done, refused;
    int by_kind[SL_ACTION_KINDS][2];
    double slowest;
    sl_action_kind slowest_kind;
} tally;

static void stop(const char *model, int step, const sl_action *a, const char *what)
{
    char *line = sl_action_format(a);
    fprintf(stderr, "%s, action %d, %s: %s\n", model, step, line, what);
    exit(1);
}

static double seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* One action; hash[cursor] is what the state after so many entries must be. */
static void one_action(sl_session *s, test_rng *rng, const char *model, int step, uint64_t *hash, tally *t)
{
    sl_diag diag = sl_diag_none();
    sl_action a = edit_random_action(s, rng);
    int32_t before, cursor;
    sl_session_history(s, &before);
    const uint64_t old = sl_session_hash(s);
    const double start = seconds();
    const sl_status status = sl_session_apply(s, &a, NULL, &diag);
    const double spent = seconds() - start;
    if (spent > t->slowest) {
        t->slowest = spent;
        t->slowest_kind = a.kind;
    }
    sl_session_history(s, &cursor);
    t->by_kind[a.kind][status == SL_OK]++;
    if (status != SL_OK) {
        t->refused++;
        if (status != SL_BAD_INPUT && status != SL_INFEASIBLE) {
            stop(model, step, &a, sl_status_name(status));
        }
        if (diag.reason[0] == '\0') {
            stop(model, step, &a, "refused without a reason");
        }
        if (sl_session_hash(s) != old || cursor != before) {
            stop(model, step, &a, "refused, yet the state is another");
        }
    } else {
        t->done++;
        const char *what = edit_broken(s);
        if (what != NULL) {
            stop(model, step, &a, what);
        }
        if (a.kind == SL_ACTION_UNDO || a.kind == SL_ACTION_REDO) {
            if (sl_session_hash(s) != hash[cursor]) {
                stop(model, step, &a, "the bytes of that state are others now");
            }
        } else {
            hash[cursor] = sl_session_hash(s);
        }
    }
    sl_action_clear(&a);
}

/* The lines of the session as a script, run again. */
static void replay(const sl_session *s, const sl_polygons *polygons, const sl_atlas_def *def, const char *model)
{
    size_t size = 64;
    for (int32_t i = 0; i < sl_session_lines(s); i++) {
        size += strlen(sl_session_line(s, i)) + 1;
    }
    char *text = calloc(size, 1);
    strcpy(text, "{\"seamlab\":\"session\",\"version\":1}\n");
    char *at = text + strlen(text);
    for (int32_t i = 0; i < sl_session_lines(s); i++) {
        at += sprintf(at, "%s\n", sl_session_line(s, i));
    }
    sl_script script;
    sl_session *again = NULL;
    sl_diag diag = sl_diag_none();
    sl_status status = sl_script_parse(model, text, (int64_t)strlen(text), false, &script, &diag);
    if (status == SL_OK) {
        status = sl_script_run(&script, -1, polygons, NULL, def, NULL, NULL, NULL, &again, &diag);
    }
    if (status != SL_OK || sl_session_hash(again) != sl_session_hash(s)) {
        fprintf(stderr, "%s: replayed, the session ends elsewhere: %s %s (line %lld)\n", model, sl_status_name(status),
                diag.reason, (long long)diag.line);
        exit(1);
    }
    sl_session_free(again);
    sl_script_clear(&script);
    free(text);
}

static void run_model(const char *model, int actions, uint64_t seed)
{
    sl_generated *mesh = NULL;
    sl_polygons polygons;
    sl_diag diag = sl_diag_none();
    const sl_generator *generator = sl_generator_find(model);
    if (generator == NULL || generator->make(seed, 0, &mesh) != SL_OK) {
        fprintf(stderr, "no model %s\n", model);
        exit(1);
    }
    sl_generated_polygons(mesh, &polygons);
    sl_action open = sl_action_default(SL_ACTION_OPEN);
    sl_atlas_def def = sl_atlas_default();
    def.check_resolution = 512;
    sl_session *s = NULL;
    const double start = seconds();
    sl_status status = sl_session_create(&polygons, NULL, &open, &def, NULL, &s, &diag);
    if (status != SL_OK || edit_broken(s) != NULL) {
        fprintf(stderr, "%s: not opened: %s %s\n", model, diag.reason, status == SL_OK ? edit_broken(s) : "");
        exit(1);
    }
    const double opened = seconds();
    uint64_t *hash = calloc((size_t)actions + 1, sizeof *hash);
    test_rng rng = test_rng_seed(seed ^ 0x5e551);
    tally t = {0};
    hash[0] = sl_session_hash(s);
    for (int i = 0; i < actions; i++) {
        one_action(s, &rng, model, i, hash, &t);
    }
    const double edited = seconds();
    replay(s, &polygons, &def, model);
    sl_action undo = sl_action_default(SL_ACTION_UNDO);
    int32_t cursor;
    for (sl_session_history(s, &cursor); cursor > 0; sl_session_history(s, &cursor)) {
        if (sl_session_apply(s, &undo, NULL, &diag) != SL_OK || sl_session_hash(s) != hash[cursor - 1]) {
            stop(model, cursor, &undo, "undo does not give the bytes back");
        }
    }
    printf("%-12s %6d facets: opened in %.2f s, %d done, %d refused in %.2f s, slowest %.3f s (%s)\n", model,
           polygons.nf, opened - start, t.done, t.refused, edited - opened, t.slowest, sl_action_name(t.slowest_kind));
    if (getenv("SEAMLAB_TALLY") != NULL) {
        for (int k = 0; k < SL_ACTION_KINDS; k++) {
            printf("    %-18s %d done, %d refused\n", sl_action_name((sl_action_kind)k), t.by_kind[k][1],
                   t.by_kind[k][0]);
        }
    }
    fflush(stdout);
    sl_session_free(s);
    sl_generated_free(mesh);
    free(hash);
}

int main(int argc, char **argv)
{
    const int actions = argc > 1 ? atoi(argv[1]) : 100;
    const uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    for (int i = 3; i < argc; i++) {
        if (strcmp(argv[i], "all") == 0) {
            int32_t count;
            const sl_generator *list = sl_generators(&count);
            for (int32_t k = 0; k < count; k++) {
                run_model(list[k].name, actions, seed);
            }
        } else {
            run_model(argv[i], actions, seed);
        }
    }
    return 0;
}
