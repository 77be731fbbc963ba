/* What every experiment is started with: [--quick] OUTDIR [CORPUS_FOLDER] [--add NAME=FILE]..., and the meshes it
 * runs on.
 * Layer: experiments (public headers and datasets-gen only). */
#ifndef SL_EXPERIMENTS_RUN_H
#define SL_EXPERIMENTS_RUN_H

#include "draw/camera.h"
#include "seamlab.h"

enum { EXP_MAX_MESHES = 256, EXP_PATH = 1024, EXP_MAX_FAILURES = 256, EXP_MAX_ADDED = 32 };

/* A model, or a method on it, that failed: see exp_failed. */
typedef struct exp_failure {
    char name[96], reason[512];
} exp_failure;

/* An atlas of another tool: --add NAME=FILE. */
typedef struct exp_added {
    char name[48]; /* of the tool */
    char path[EXP_PATH];
} exp_added;

typedef struct exp_run {
    bool quick;
    const char *out;    /* folder to write into */
    const char *corpus; /* folder of meshes, NULL = none */
    sl_thread_pool *pool;
    sl_context context;
    sl_diag diag;
    int32_t failed; /* may be more than are kept */
    exp_failure failure[EXP_MAX_FAILURES];
    int32_t added;
    exp_added add[EXP_MAX_ADDED];
} exp_run;

/* Parses the command line and starts the workers; false (and a line on stderr) when it is wrong. */
bool exp_begin(exp_run *run, int argc, char **argv);

/* Prints what went wrong, stops the workers; the exit code: 0, or 1 on a failure or a violated claim. */
int exp_end(exp_run *run, sl_status status, int32_t violated);

/* OUT/name into path. SL_IO when it is too long. */
SL_NODISCARD sl_status exp_path(const exp_run *run, const char *name, char path[EXP_PATH]);

/* CPU seconds of the whole process. */
double exp_cpu_seconds(void);

/* A mesh by name, before it is loaded. */
typedef struct exp_source {
    char name[64]; /* without extension */
    char path[EXP_PATH];
    bool generated;
} exp_source;

/* All generated meshes, then the corpus folder's in alphabetical order. source: EXP_MAX_MESHES. Returns how many. */
int32_t exp_list_sources(const exp_run *run, exp_source *source);

/* A loaded mesh; the polygons are borrowed from what owns them. */
typedef struct exp_mesh {
    sl_polygons polygons;
    struct sl_generated *generated;
    sl_meshfile *file;
} exp_mesh;

/* A file that cannot be read is SL_BAD_INPUT, too: the mesh is at fault, not the experiment. Cleared by exp_mesh_clear,
 * also after failure. */
SL_NODISCARD sl_status exp_mesh_load(const exp_source *source, exp_mesh *mesh, sl_diag *diag);
void exp_mesh_clear(exp_mesh *mesh);

/* From where that mesh looks best. */
sl_view exp_view_of(const char *name);

#endif
