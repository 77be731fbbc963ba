/* How far apart charts lie: the proof of a margin.
 * Layer: pack. */
#ifndef SL_PACK_CLEARANCE_H
#define SL_PACK_CLEARANCE_H

#include "pack/pack.h"

/* The least distance between the outlines of two charts as they stand (chart->uv are positions on one page), or limit
 * where none are nearer than that. Charts one inside the other, without their outlines meeting, are as far apart as
 * these. limit > 0. SL_BAD_INPUT (UV not finite), SL_OUT_OF_MEMORY. A grid of buckets; O(edges) for outlines of short
 * edges. */
SL_NODISCARD sl_status sl_pack_clearance(int32_t count, const sl_pack_chart *charts, double limit, double *out);

#endif
