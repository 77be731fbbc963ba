/* The table of one set of kernels; included once by each of kernels_*.c.
 * Layer: sparse. */
const sl_kernels SL_KERNEL_SET = {.name = SL_KERNEL_NAME,
                                  .factor = front_factor,
                                  .update = front_update,
                                  .forward = solve_forward,
                                  .backward = solve_backward};
