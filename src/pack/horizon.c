#include "pack/pack_internal.h"

#include <math.h>

/* How low a profile can sink at column x. */
static double resting_height(const sl_horizon *horizon, const sl_profile *profile, int32_t x)
{
    double y = 0.0;
    for (int32_t j = 0; j < profile->columns; j++) {
        y = fmax(y, horizon->height[x + j] - profile->low[j]);
    }
    return y;
}

/* Area between the skyline and the profile's underside. */
static double lost_area(const sl_horizon *horizon, const sl_profile *profile, int32_t x, double y)
{
    double lost = 0.0;
    for (int32_t j = 0; j < profile->columns; j++) {
        lost += y + profile->low[j] - horizon->height[x + j];
    }
    return lost * horizon->cell;
}

bool sl_horizon_find(const sl_horizon *horizon, const sl_profile *profile, int32_t *x, double *y, double *cost)
{
    bool found = false;
    const double area = fmax(1.0, profile->height * profile->columns * horizon->cell);
    for (int32_t column = 0; column + profile->columns <= horizon->columns; column++) {
        const double rest = resting_height(horizon, profile, column);
        if (rest + profile->height > horizon->side) {
            continue;
        }
        /* the top decides; what is buried under the chart counts in the measure of the chart itself */
        const double here =
            rest + profile->height + profile->height * (lost_area(horizon, profile, column, rest) / area);
        if (!found || here < *cost) {
            found = true;
            *x = column;
            *y = rest;
            *cost = here;
        }
    }
    return found;
}

void sl_horizon_put(sl_horizon *horizon, const sl_profile *profile, int32_t x, double y)
{
    for (int32_t j = 0; j < profile->columns; j++) {
        horizon->height[x + j] = fmax(horizon->height[x + j], y + profile->high[j]);
    }
}
