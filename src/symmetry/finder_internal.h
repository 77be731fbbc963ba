/* Candidates for automorphisms of one component.
 * Layer: symmetry, private. */
#ifndef SL_SYMMETRY_FINDER_INTERNAL_H
#define SL_SYMMETRY_FINDER_INTERNAL_H

#include "symmetry/symmetry_internal.h"

enum {
    SL_LANDMARKS = 8,   /* points that an exact map must send to points */
    SL_LOOK_ALIKES = 96 /* points as far from the centre as one of them, at most */
};

/* What the isometry of a candidate's first facets looks like. */
typedef enum sl_looks { SL_LOOKS_MIRROR, SL_LOOKS_ROTATION, SL_LOOKS_INVOLUTION, SL_LOOKS_OTHER } sl_looks;

/* The map that sends the first corner to `corner`. */
typedef struct sl_candidate {
    int32_t corner;
    bool reverses, tried;
    uint8_t level, looks; /* an sl_symmetry_kind, as far as is known; sl_looks */
    double trace;         /* of the isometry: the smaller the angle, the larger */
    double normal[3];     /* of a mirror */
    double along, near;   /* largest |cosine| to the axes of the model, to the normals of mirrors found */
} sl_candidate;

typedef struct sl_landmark {
    int32_t point, count; /* count: of the points about as far from the centre */
    int32_t alike[SL_LOOK_ALIKES];
} sl_landmark;

typedef struct sl_finder {
    sl_symmetry_search *search;
    int32_t component, cap, found;
    double tolerance[3]; /* of distances, by kind */
    sl_candidate *list;
    int64_t count, capacity;
    int64_t work, allowed; /* corners walked in vain; how many more may be, each time */
    sl_landmark landmark[SL_LANDMARKS];
    int32_t landmarks;
    int32_t mirrors, rotations; /* found, by their looks */
    bool cut;                   /* something was left out */
} sl_finder;

/* Halfedges and orientations of the first corner's colour. */
int64_t sl_finder_possibilities(const sl_finder *finder);

/* Chooses landmarks. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_finder_choose_landmarks(sl_finder *finder);

/* Appends candidates whose first `patch` facets fit and look like the levels least .. level, at most `most`. Those of
 * before that were not tried stay. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_finder_gather(sl_finder *finder, sl_symmetry_kind least, sl_symmetry_kind level,
                                        int32_t patch, int64_t most);

#endif
