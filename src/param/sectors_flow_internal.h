/* Whether sectors that share triangles can all have their angles at once; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_SECTORS_FLOW_INTERNAL_H
#define SL_PARAM_SECTORS_FLOW_INTERNAL_H

#include "param/sectors.h"

/* A set of sectors and of triangles that shows why not. */
typedef struct sl_sector_cut {
    bool found;
    bool starved;               /* true: the sectors ask for more than their triangles have; false: the triangles have
                                   more than the sectors, which hold all of their corners, take */
    int32_t sectors, triangles; /* how many */
    double asked, held;         /* sum of theta; pi triangles [rad] */
    uint8_t *in_cut;            /* sectors->count: 1 = in the set; owned by the caller (sl_free), NULL if not found */
} sl_sector_cut;

/**
 * Are there angles alpha >= room with g1 = 0 and g2 = 0?
 *
 *     triangle t  --alpha-->  sector s   a flow that empties every triangle (pi) and fills every sector (theta);
 *                 --alpha-->  anywhere   corners in no sector take what is left
 *
 * decided by a maximum flow in integers, so that it always ends: first the sectors are filled, then the triangles
 * emptied, which keeps the sectors full. room: what every angle keeps at least [rad], less in sectors too narrow for
 * it. Tables with a corner in two sectors are not decided: found = false.
 *
 * SL_OUT_OF_MEMORY: nothing is owned then. About O(corners) phases of O(corners) at worst, a few in practice.
 * Source: Hall 1935 and Gale 1957 (the condition), Dinic 1970 (the algorithm). */
SL_NODISCARD sl_status sl_sectors_cut(const sl_patch *patch, const sl_sectors *sectors, double room,
                                      sl_sector_cut *out);

#endif
