/* The shadow that a scene throws on the ground it stands on, as a map made once: soft, and softer the farther away what
 * throws it.
 * Layer: draw. */
#ifndef SL_DRAW_GROUND_H
#define SL_DRAW_GROUND_H

#include "draw/light.h"

typedef struct sl_ground sl_ground; /* opaque; independent of the rig once made */

/* The plane through `point`, perpendicular to the rig's up axis. strength in [0, 1]: how much of the light's loss is
 * shown. SL_OUT_OF_MEMORY. Deterministic for any number of threads. */
SL_NODISCARD sl_status sl_ground_create(const sl_light_rig *rig, const double point[3], double strength,
                                        const sl_context *context, sl_ground **out);

void sl_ground_free(sl_ground *ground); /* NULL is a no-op */

/* Factor in [0, 1] on the colour of the ground where the ray from `origin` meets it: 1 where there is no shadow, where
 * the ray misses the plane or comes from below. */
float sl_ground_seen(const sl_ground *ground, const double origin[3], const double direction[3]);

#endif
