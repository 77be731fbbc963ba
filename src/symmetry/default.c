#include "symmetry/symmetry.h"

sl_symmetry_def sl_symmetry_default(void)
{
    return (sl_symmetry_def){.exact = 1e-6, .near = 1e-2, .most = SL_SYMMETRY_MOST};
}
