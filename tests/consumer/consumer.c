/* A user's program: reads a mesh, unwraps it, edits the atlas, takes the edit back, saves. Built against the installed
 * library.   consumer IN.obj OUT.obj */
#include <seamlab.h>

#include <stdio.h>

/* What went wrong, in words; the exit code. */
static int failed(sl_status status, const sl_diag *diag)
{
    fprintf(stderr, "%s: %s\n", sl_status_name(status), diag->reason);
    return 1;
}

/* The automatic atlas alone: one call. */
static int unwrap(const sl_polygons *polygons)
{
    const sl_atlas_def def = sl_atlas_default();
    sl_diag diag = sl_diag_none();
    sl_atlas *atlas = NULL;
    const sl_status status = sl_unwrap(polygons, &def, NULL, &atlas, &diag);
    if (status != SL_OK) {
        return failed(status, &diag);
    }
    printf("%d charts, fill %.2f, %s\n", atlas->segmentation->nchart, atlas->pack.fill,
           atlas->check.passed ? "proven" : "not valid");
    const int code = atlas->check.passed ? 0 : 1;
    sl_atlas_free(atlas);
    return code;
}

/* The same as the start of a session: two charts are sewn together, which is undone, done again, packed. */
static sl_status edit(sl_session *session, sl_diag *diag)
{
    sl_action merge = sl_action_default(SL_ACTION_MERGE), undo = sl_action_default(SL_ACTION_UNDO),
              redo = sl_action_default(SL_ACTION_REDO), pack = sl_action_default(SL_ACTION_PACK);
    const sl_action *steps[] = {&merge, &undo, &redo, &pack};
    const int32_t facets[] = {0, 1}; /* of the two charts */
    sl_status status = sl_action_set_items(&merge, 2, facets);
    for (int k = 0; k < 4 && status == SL_OK; k++) {
        status = sl_session_apply(session, steps[k], NULL, diag);
    }
    for (int32_t k = 0; k < sl_session_lines(session); k++) {
        printf("%s\n", sl_session_line(session, k)); /* what `seamlab replay` reads */
    }
    sl_action_clear(&merge);
    return status;
}

int main(int argc, char **argv)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_session *session = NULL;
    sl_polygons polygons;
    const sl_action open = sl_action_default(SL_ACTION_OPEN);
    if (argc != 3) {
        fprintf(stderr, "usage: consumer IN OUT\n");
        return 2;
    }
    sl_status status = sl_meshfile_read(argv[1], &file, &diag);
    if (status != SL_OK) {
        return failed(status, &diag);
    }
    sl_meshfile_polygons(file, &polygons);
    int code = unwrap(&polygons);
    status = sl_session_create(&polygons, NULL, &open, NULL, NULL, &session, &diag);
    status = status == SL_OK ? edit(session, &diag) : status;
    status = status == SL_OK ? sl_session_save(session, file, argv[2], false, NULL, NULL, &diag) : status;
    code = status == SL_OK ? code : failed(status, &diag);
    sl_session_free(session);
    sl_meshfile_free(file);
    return code;
}
