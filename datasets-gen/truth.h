/* What is known of a generated mesh, as a JSON file beside it.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_TRUTH_H
#define SL_GENERATORS_TRUTH_H

#include "generators.h"

enum { GEN_TRUTH_SCHEMA = 1 };

/* Builds the mesh and compares what the mesh room finds with what the generator's author declared: genus, components,
 * borders, nothing to repair. report (nullable) is the caller's. SL_CHECK_FAILED (diag says what differs),
 * SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status gen_truth_check(const sl_generator *generator, const sl_generated *mesh,
                                       sl_repair_report *report, sl_diag *diag);

/* Writes the truth, atomically; path "-" is standard output. One line a field and a map:
 *
 *   {"schema": 1, "name", "what", "seed" (text: 64 bits), "scale", "vertices", "facets", "triangles", "quads", "ngons",
 *    "genus", "components", "borders",
 *    "more_mirrors": the group has mirrors that are not listed,
 *    "symmetries": [{"name", "mirror", "exact", "matrix": 3 rows of 4, "fixed_facets": [...], "facet": [image of each],
 *                    "vertex": [image of each]}],
 *    "near": [{"name", "matrix"}]}
 *
 * SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status gen_truth_write(const char *path, const sl_generator *generator, const sl_generated *mesh,
                                       const sl_repair_report *report, uint64_t seed, int32_t scale, sl_diag *diag);

#endif
