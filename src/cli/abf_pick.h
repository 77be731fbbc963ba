/* `seamlab abf`: the chart that is flattened, and the constraints asked of it, by input vertices.
 * Layer: cli. */
#ifndef SL_CLI_ABF_PICK_H
#define SL_CLI_ABF_PICK_H

#include "atlas/atlas.h"
#include "cli/cli.h"
#include "param/constraints.h"

/* Where the chart comes from. */
typedef struct abf_source {
    const char *file, *seams; /* seams: nullable */
    int32_t chart;            /* -1 = not said */
} abf_source;

/* The chart and what it was taken from; abf_chart_clear. Zero-initialised = empty. */
typedef struct abf_pick {
    sl_patch *patch;
    int32_t *name; /* nv: the input vertex of a patch vertex */
    int32_t chart, charts;
    int32_t facets; /* of the whole mesh */
    sl_meshfile *file;
    sl_mesh *mesh; /* NULL where `atlas` holds it */
    sl_atlas *atlas;
} abf_pick;

/* A mesh that is one disk is taken as it is; any other is cut, by the seams given or by `unwrap`, and the chart asked
 * for, else the largest, is taken; a note says so. Returns the exit code. */
int abf_pick_chart(cli_run *run, const abf_source *source, abf_pick *pick);

void abf_pick_clear(abf_pick *pick);

/* The constraint options as given. */
typedef struct abf_asked {
    cli_list angle, straight, right, rectangle, pin;
} abf_asked;

/* The same in terms of the patch. */
typedef struct abf_constraints {
    int32_t count, pins;
    sl_constraint *item;
    char (*text)[80]; /* count: how it was asked for */
    sl_pin *pin;
    int32_t *vertex; /* what the items point into */
} abf_constraints;

/* A vertex is an input number V, or V/F where the chart has several copies of it: the one at facet F. Along a path the
 * copies follow from the edges; a path of two vertices is the shortest way between them, and a note tells it. Returns
 * the exit code. */
int abf_constraints_read(cli_run *run, const abf_pick *pick, const abf_asked *asked, abf_constraints *out);

/* The shortest way along edges between two vertices of a patch, both included: vertex has room for nv of them. */
SL_NODISCARD sl_status abf_shortest_path(const sl_patch *patch, int32_t from, int32_t to, int32_t *vertex,
                                         int32_t *count);

void abf_constraints_clear(abf_constraints *constraints);

#endif
