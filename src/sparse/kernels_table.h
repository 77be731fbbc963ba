/* The table of one set of kernels; included once by each of kernels_*.c.
 * Layer: sparse. */
const sl_kernels SL_KERNEL_SET = {.name = SL_KERNEL_NAME,
                                  .open = front_open,
                                  .columns = front_columns,
                                  .trail = front_trail,
                                  .close = front_close,
                                  .update = front_update,
                                  .forward = solve_forward,
                                  .backward = solve_backward};
