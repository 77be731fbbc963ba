/* Sessions killed (kill -9) at random moments: the log reopens and has lost at most the action under way.
 *   killed TIMES SEED */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "edit/script.h"
#include "edit_support.h"
#include "sheet.h"

static void complain(int trial, const char *what)
{
    fprintf(stderr, "trial %d: %s\n", trial, what);
    exit(1);
}

/* Random actions for ever, logged; tells the state's hash after each on the pipe. */
static void edit_for_ever(const sheet *t, const char *log, uint64_t seed, int out)
{
    sl_session *s = open_polygons(&t->polygons, "{\"do\":\"open\"}", NULL);
    test_rng rng = test_rng_seed(seed);
    if (sl_session_log_to(s, log, "sheet", NULL) != SL_OK) {
        exit(1);
    }
    for (;;) {
        sl_action a = edit_random_action(s, &rng);
        const sl_status status = sl_session_apply(s, &a, NULL, NULL);
        const uint64_t hash = sl_session_hash(s);
        sl_action_clear(&a);
        if (status == SL_OK && write(out, &hash, sizeof hash) != (ssize_t)sizeof hash) {
            exit(1);
        }
    }
}

typedef struct told {
    int count;
    uint64_t *hash;
    int trial;
} told;

/* After action i of the log the state must be what the child told, if it came to tell. */
static bool compare(void *user, const sl_session *s, const sl_script *script, int32_t index)
{
    const told *t = user;
    (void)script;
    if (index > 0 && index <= t->count && sl_session_hash(s) != t->hash[index - 1]) {
        complain(t->trial, "an action of the log leads elsewhere than it did");
    }
    return true;
}

static int one_trial(const sheet *t, int trial, test_rng *rng, const char *log)
{
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) {
        complain(trial, "no pipe");
    }
    const uint64_t seed = test_bits(rng);
    const pid_t child = fork();
    if (child == 0) {
        close(pipe_ends[0]);
        edit_for_ever(t, log, seed, pipe_ends[1]);
    }
    close(pipe_ends[1]);
    const struct timespec wait = {0, 20000000 + test_index(rng, 60000000)};
    uint64_t first;
    told heard = {.trial = trial, .hash = calloc(100000, sizeof first)};
    if (read(pipe_ends[0], &heard.hash[heard.count++], sizeof first) != (ssize_t)sizeof first) { /* it is under way */
        complain(trial, "the child said nothing");
    }
    nanosleep(&wait, NULL);
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    while (heard.count < 100000 &&
           read(pipe_ends[0], &heard.hash[heard.count], sizeof first) == (ssize_t)sizeof first) {
        heard.count++;
    }
    close(pipe_ends[0]);
    sl_script script;
    sl_session *s = NULL;
    sl_diag diag = sl_diag_none();
    const sl_atlas_def def = small_def();
    if (sl_script_read(log, true, &script, &diag) != SL_OK) {
        complain(trial, diag.reason);
    }
    if (script.count - 1 < heard.count || script.count - 1 > heard.count + 1) {
        complain(trial, "more than the action under way is missing, or one too many is there");
    }
    if (sl_script_run(&script, -1, &t->polygons, NULL, &def, compare, &heard, NULL, &s, &diag) != SL_OK) {
        complain(trial, diag.reason);
    }
    const int count = script.count;
    sl_session_free(s);
    sl_script_clear(&script);
    free(heard.hash);
    return count;
}

int main(int argc, char **argv)
{
    const int times = argc > 1 ? atoi(argv[1]) : 20;
    test_rng rng = test_rng_seed(argc > 2 ? strtoull(argv[2], NULL, 10) : 1);
    sheet t;
    char log[512];
    int64_t actions = 0;
    sheet_make(&t);
    snprintf(log, sizeof log, "%s", test_scratch("killed.jsonl"));
    for (int trial = 0; trial < times; trial++) {
        actions += one_trial(&t, trial, &rng, log);
    }
    printf("%d sessions killed, %lld actions in their logs, none lost\n", times, (long long)actions);
    return 0;
}
