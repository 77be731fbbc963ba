/* What `seamlab render` shows: a mesh file and the arrays made from it.
 * Layer: cli. */
#ifndef SL_CLI_RENDER_SCENE_H
#define SL_CLI_RENDER_SCENE_H

#include "atlas/measure.h"
#include "cli/cli.h"
#include "render/scene.h"

/* The words of --show. */
typedef struct cli_show {
    bool seams, checker, overlap, stretch, charts, constraints, symmetry, visibility, seamcost;
    int32_t eigenvector; /* 0 = none */
} cli_show;

typedef struct cli_scene_options {
    const char *path;
    const char *texture;     /* a picture's file, or NULL */
    const char *constraints; /* a file of edges, or NULL */
    double tiles, checks;
    int32_t resolution; /* texels a side, for overlap */
    double wire;
    bool charts_if_uv; /* charts, where there are UVs and no texture */
    cli_show show;
} cli_scene_options;

/* Everything the scene borrows; owned. */
typedef struct cli_scene {
    sl_meshfile *file;
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    sl_sharing_table sharing;
    bool shared; /* a sidecar says which charts are copies */
    double *corner_uv, *facet_value, *corner_value;
    int32_t *chart, charts;
    uint8_t *facet_rgb, *facet_flag;
    sl_image *texture;
    int32_t *axis, axes;  /* halfedges on axes of symmetry */
    int32_t *line, lines; /* halfedges of constraints */
    int32_t *dot, dots;   /* vertices at their ends */
    sl_edge_layer edge_layer[2];
    sl_dot_layer dot_layer[2];
    const char *value_name;
    char name[64];
    sl_scene scene;
} cli_scene;

/* Reads "seams,checker,eigenvector=3". False after a message on stderr. */
bool cli_show_parse(const char *words, cli_show *show);

/* Reads a camera: "front", "back", "left", "right", "top", "bottom", or "azimuth,elevation[,field of view]". */
bool cli_camera_parse(const char *text, sl_view *view);

/* Reads the file and makes what is to be shown. Returns the exit code; cleared by the caller in any case. */
int cli_scene_open(cli_run *run, const cli_scene_options *options, cli_scene *scene);
void cli_scene_clear(cli_scene *scene);

/* The parts; each fills its arrays and points scene->scene at them. */
SL_NODISCARD sl_status cli_show_stretch(cli_scene *scene);
SL_NODISCARD sl_status cli_show_visibility(cli_run *run, cli_scene *scene);
SL_NODISCARD sl_status cli_show_seam_cost(cli_run *run, cli_scene *scene);
SL_NODISCARD sl_status cli_show_eigenvector(cli_run *run, cli_scene *scene, int32_t k, sl_diag *diag);
SL_NODISCARD sl_status cli_show_symmetry(cli_run *run, cli_scene *scene);
SL_NODISCARD sl_status cli_show_overlap(cli_run *run, cli_scene *scene, int32_t resolution);
SL_NODISCARD sl_status cli_show_constraints(cli_scene *scene, const char *path, sl_diag *diag);

#endif
