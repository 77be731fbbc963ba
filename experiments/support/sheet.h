/* A chart of a model and what users do to it: lines along its edges, angles at its border; solved, measured, drawn.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_SHEET_H
#define SL_EXPERIMENTS_SHEET_H

#include "param/abf_chart.h"
#include "support/claims.h"
#include "support/main.h"
#include "support/pictures.h"

typedef struct exp_sheet {
    char name[64];
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    sl_segmentation *segmentation;
    int32_t chart;
    sl_patch *patch;
    sl_graph graph; /* of the patch's vertices over polygon edges */
} exp_sheet;

/* A chart of a generated model, cut into at most `charts` by the rule of `--preset fast` (0 = as many as it takes).
 * chart: its number, -1 = the largest. SL_BAD_INPUT, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status exp_sheet_open(exp_run *run, const char *model, int32_t charts, int32_t chart, exp_sheet *sheet);
void exp_sheet_close(exp_sheet *sheet);

/* Is halfedge c of the patch an edge of a polygon (and no diagonal of one)? */
bool exp_sheet_is_edge(const exp_sheet *sheet, int32_t c);

/* Constraints under construction; the vertices are owned. */
typedef struct exp_wish {
    int32_t count;
    sl_constraint item[64];
} exp_wish;

void exp_wish_clear(exp_wish *wish);

/* The shortest path of polygon edges from a to b that keeps inside but for its ends and has two triangles on each side
 * of every vertex. cross: it may pass through other lines' vertices. SL_INFEASIBLE: there is none. */
SL_NODISCARD sl_status exp_wish_path(const exp_sheet *sheet, int32_t a, int32_t b, bool cross, exp_wish *wish);

/* The line of quads' edges that leaves border vertex v: straight on through vertices of four edges, until the border.
 * false: it ends at another vertex, or has fewer than three vertices. */
bool exp_wish_loop(const exp_sheet *sheet, int32_t v, exp_wish *wish, sl_status *status);

/* An angle at a vertex; SL_CONSTRAINT_RIGHT where angle is 0. */
SL_NODISCARD sl_status exp_wish_angle(exp_wish *wish, int32_t v, double angle);

/* Removes the last constraint. */
void exp_wish_drop(exp_wish *wish);

/* Does the chart take the constraints in one go, and not overlap with them? As a user would see at once. */
SL_NODISCARD sl_status exp_wish_good(exp_run *run, const exp_sheet *sheet, const exp_wish *wish, bool *good);

/* How a line lies to those before it. */
typedef enum exp_line_mode {
    EXP_LINE_APART, /* it meets none */
    EXP_LINE_CROSS, /* it crosses the first */
    EXP_LINE_STOP   /* it ends on the first */
} exp_line_mode;

/* The first line in a fixed order of tries that the chart takes. SL_INFEASIBLE: none. */
SL_NODISCARD sl_status exp_wish_line(exp_run *run, const exp_sheet *sheet, const int32_t *border, int32_t count,
                                     exp_line_mode mode, exp_wish *wish);

/* Border vertices in order, counter-clockwise; *vertex is owned (sl_free). */
SL_NODISCARD sl_status exp_sheet_border(const exp_sheet *sheet, int32_t **vertex, int32_t *count);

/* The border vertex, of at least four triangles, where the chart with these angles is widest open inside: between two
 * limbs. -1 = none. */
int32_t exp_sheet_widest(const exp_sheet *sheet, const double *alpha);

/* How a solve ended. */
typedef struct exp_solution {
    sl_abf_chart_info info;
    sl_distortion distortion;
    double line, angle; /* worst of the constraints: off the line over the size; off the angle [rad] */
    int32_t crossings;  /* of the border with itself */
    double cpu;         /* seconds */
} exp_solution;

/* The chart held in hand with these constraints. table must outlive it. */
SL_NODISCARD sl_status exp_sheet_solve(exp_run *run, const exp_sheet *sheet, const exp_wish *wish,
                                       sl_sector_table *table, sl_abf_chart **out, exp_solution *solution);

/* Measures what a chart in hand shows. */
SL_NODISCARD sl_status exp_sheet_measure(const exp_sheet *sheet, const exp_wish *wish, const sl_sector_table *table,
                                         const sl_abf_chart *chart, exp_solution *solution);

/* The columns "iterations|max |grad||..." and a row of them; claims are held against `name`. */
void exp_solution_header(exp_page *page, const char *first);
void exp_solution_row(exp_page *page, exp_claims *claims, const char *name, const char *what, const exp_wish *wish,
                      const exp_solution *solution);

/* Where a layout is drawn: window = {left, bottom, side} in uv; NULL = around it. tint: facets (nf of the mesh) in
 * purple, nullable. */
typedef struct exp_drawing {
    const double *window;
    const uint8_t *tint;
    int32_t width, height;
    bool model;    /* the model beside it */
    double radius; /* of the dots, pixels; 0 = as usual */
    const char *file;
} exp_drawing;

/* The chart with its lines blue, its prescribed vertices yellow. */
SL_NODISCARD sl_status exp_sheet_draw(exp_run *run, const exp_sheet *sheet, const double *uv, const exp_wish *wish,
                                      const exp_drawing *drawing);

/* The window that holds a layout. */
void exp_sheet_window(const exp_sheet *sheet, const double *uv, double window[3]);

/* Two pictures of a chart beside one another: free, and with constraints. */
SL_NODISCARD sl_status exp_show_pair(exp_run *run, exp_page *page, const exp_sheet *sheet, const exp_wish *wish,
                                     const char *stem, const double *before, const double *after, const char *caption);

/* One line after the other drawn on a chart: step 0 is free, step k has one line more, in its mode. */
typedef struct exp_lines {
    const char *what[4];
    exp_line_mode mode[4]; /* of step 0: any */
    const char *caption;   /* of the last picture */
} exp_lines;

/* A table of the four steps on the model's largest chart, and it before and after. */
SL_NODISCARD sl_status exp_show_lines(exp_run *run, exp_page *page, exp_claims *claims, const char *model,
                                      const exp_lines *lines);

#endif
