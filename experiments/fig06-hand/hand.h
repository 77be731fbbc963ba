/* One hand of Figure 6: pose, spectrum, pictures, rules.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_HAND_H
#define SL_EXPERIMENTS_HAND_H

#include "support/claims.h"
#include "support/spectrum.h"

enum { HAND_VECTORS = 30, HAND_RULES = 3, HAND_MOST_POSES = 16 };

/* What is done to the hand before it is cut. */
typedef enum hand_move { HAND_AS_IT_IS, HAND_ROLLED, HAND_TWISTED } hand_move;

typedef struct hand_pose {
    const char *tag;     /* in file names: "hand" */
    const char *title;   /* in claims: "hand fist" */
    const char *heading; /* HTML */
    hand_move move;
    double from;    /* rolled: from this share of its length (0 = wrist, 1 = fingertips) on */
    double degrees; /* ... by so much towards the palm, or twisted about the arm */
    bool sheet;     /* with all vectors as pictures */
    bool quick;     /* part of --quick */
} hand_pose;

/* What a rule does with a hand. */
typedef struct hand_choice {
    int32_t vector; /* first cut, -1 = by components */
    int32_t charts; /* in the end */
    double seam;    /* in the end, over the diagonal */
    double share;   /* front and back apart by the first cut, in [1/2, 1] */
} hand_choice;

typedef struct hand_work {
    const hand_pose *pose;
    exp_mesh input;
    double *xyz; /* in its pose */
    exp_spectrum s;
    int32_t passing; /* vectors */
    hand_choice choice[HAND_RULES];
} hand_work;

extern const char *const hand_rule_title[HAND_RULES]; /* HTML, in the order of sl_cut_rule */

/* pose.c: moves the vertices; fingers along y, palm towards z. xyz: nv x 3, out. */
void hand_move_into(const sl_polygons *rest, const hand_pose *pose, double *xyz);

/* spectrum.c: loads the mesh, takes the pose, computes the spectrum. */
SL_NODISCARD sl_status hand_compute(exp_run *run, const exp_source *source, const hand_pose *pose, hand_work *w);
void hand_clear(hand_work *w);

/* Writes tag.csv: vector, lambda, parts, passes, seam. */
SL_NODISCARD sl_status hand_write_csv(exp_run *run, const hand_work *w);

/* rules.c: what each rule takes, by the candidates and by running the segmentation; pictures of the cuts for a sheet.
 */
SL_NODISCARD sl_status hand_rules(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w);

/* From where a hand in that pose looks best; from its edge, so that palm and back are both seen. */
sl_view hand_view(const hand_pose *pose, bool edge);

/* show.c: the whole part of the page, or only what the table of poses needs. */
SL_NODISCARD sl_status hand_show(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source,
                                 const hand_pose *pose, hand_work *w);

#endif
