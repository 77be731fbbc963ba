/* The best preset beside the paper's on the generated models, at the L2 that the paper's reaches.
 *
 *     generated OUT.csv [model...]
 *
 * No symmetry is used, nothing protected, seams weigh their length alone. OUT.csv gets a row a preset and model; on
 * stdout stand both and what is worse. */
#include "atlas/atlas.h"
#include "atlas/measure.h"
#include "base/memory.h"
#include "generators.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { RESOLUTION = 1024 };
static const double ANGLE = 1.2;         /* target where the paper's is not above it anyway */
static const double SLACK = 1e-4;        /* of a target */
static const double LEAST_BUDGET = 1e-6; /* a flat atlas of the paper's leaves no stretch to aim at */

typedef struct outcome {
    sl_atlas_measure measure;
    double seconds;
    int32_t pieces, failed, missed;
    bool proven;
} outcome;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static sl_atlas_def paper_def(void)
{
    sl_atlas_def def = sl_atlas_default();
    def.best = false;
    def.segment = sl_segment_paper();
    def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    def.segment.test_halves = false;
    def.pack.resolution = RESOLUTION;
    return def;
}

static sl_atlas_def best_def(const sl_atlas_measure *paper)
{
    sl_atlas_def def = sl_atlas_default();
    def.best = true;
    def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    def.optimize = sl_optimize_default();
    def.optimize.weights = sl_seam_cost_none();
    def.optimize.protect = SL_PROTECT_NONE;
    def.optimize.empty_cost = 0.0;
    def.optimize.effort = 0.0;
    def.optimize.target_stretch = fmax(paper->global.l2, 1.0 + LEAST_BUDGET);
    def.optimize.target_angle = fmax(paper->global.angle_mean, ANGLE);
    def.pack.resolution = RESOLUTION;
    return def;
}

static sl_status unwrap(const sl_polygons *polygons, const sl_atlas_def *def, outcome *out)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    const double start = cpu_seconds();
    SL_TRY(sl_unwrap(polygons, def, NULL, &atlas, NULL));
    *out = (outcome){.seconds = cpu_seconds() - start,
                     .pieces = atlas->optimized.pieces,
                     .failed = atlas->optimized.failed,
                     .missed = atlas->optimized.missed,
                     .proven = atlas->check.passed};
    SL_TRY(sl_measure_atlas(polygons, atlas->input_corner_uv, RESOLUTION, NULL, &out->measure, NULL));
cleanup:
    sl_atlas_free(atlas);
    return status;
}

static void print_row(FILE *csv, const char *preset, const char *name, const outcome *o)
{
    const sl_atlas_measure *m = &o->measure;
    fprintf(csv, "%s,%s,%.2f,%d,%d,%d,%.4f,%d,%.4f,%.4f,%.4f,%d,%d,%d,%d\n", preset, name, o->seconds, m->triangles,
            m->charts, m->charts10, m->seam_length, m->global.flipped, m->global.angle_mean, m->global.l2, m->fill,
            o->pieces, o->failed, o->missed, o->proven);
    fflush(csv);
}

/* Returns whether the best one is worse in something. */
static bool compare(const char *name, const outcome *paper, const outcome *best)
{
    const sl_atlas_measure *p = &paper->measure, *b = &best->measure;
    const bool charts = b->charts > p->charts, seams = b->seam_length > p->seam_length * (1.0 + SLACK);
    const bool missed = b->global.l2 > fmax(p->global.l2, 1.0 + LEAST_BUDGET) + SLACK;
    const bool invalid = !best->proven || b->global.flipped > 0;
    printf("%-14s paper %3d/%7.3f/%.4f/%.3f  best %3d/%7.3f/%.4f/%.3f %7.2f s%s%s%s%s%s\n", name, p->charts,
           p->seam_length, p->global.l2, p->global.angle_mean, b->charts, b->seam_length, b->global.l2,
           b->global.angle_mean, best->seconds, charts ? " MORE CHARTS" : "", seams ? " LONGER SEAMS" : "",
           missed ? " L2 MISSED" : "", invalid ? " NOT PROVEN" : "", best->failed > 0 ? " FAILED PIECES" : "");
    fflush(stdout);
    return charts || seams || missed || invalid || best->failed > 0;
}

static sl_status run(const sl_generator *g, FILE *csv, bool *worse)
{
    sl_status status = SL_OK;
    sl_generated *made = NULL;
    sl_polygons polygons;
    outcome paper, best;
    SL_TRY(g->make(1, 1, &made));
    sl_generated_polygons(made, &polygons);
    const sl_atlas_def paper_way = paper_def();
    SL_TRY(unwrap(&polygons, &paper_way, &paper));
    print_row(csv, "paper", g->name, &paper);
    const sl_atlas_def best_way = best_def(&paper.measure);
    SL_TRY(unwrap(&polygons, &best_way, &best));
    print_row(csv, "best", g->name, &best);
    *worse = compare(g->name, &paper, &best);
cleanup:
    sl_generated_free(made);
    return status;
}

int main(int argc, char **argv)
{
    FILE *csv = argc > 1 ? fopen(argv[1], "w") : NULL;
    if (csv == NULL) {
        fprintf(stderr, "usage: generated OUT.csv [model...]\n");
        return 2;
    }
    fprintf(csv, "preset,model,user,tri,charts,charts10,seamLen,flip,angMean,L2,pack,pieces,failed,missed,proven\n");
    int32_t count, models = 0, losses = 0;
    int code = 0;
    const sl_generator *g = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        bool wanted = argc == 2, worse = false;
        for (int a = 2; a < argc; a++) {
            wanted = wanted || strcmp(argv[a], g[k].name) == 0;
        }
        const sl_status status = wanted ? run(&g[k], csv, &worse) : SL_OK;
        if (status != SL_OK) {
            fprintf(stderr, "%s: %s\n", g[k].name, sl_status_name(status));
            code = 1;
        }
        models += wanted;
        losses += worse;
    }
    printf("%d models, %d where something is worse\n", models, losses);
    fclose(csv);
    return code;
}
