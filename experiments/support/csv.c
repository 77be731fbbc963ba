#include "support/csv.h"

sl_status exp_csv_open(exp_run *run, const char *name, const char *header, sl_writer **csv)
{
    char path[EXP_PATH];
    sl_status status = exp_path(run, name, path);
    if (status == SL_OK) {
        status = sl_writer_create(path, csv, &run->diag);
    }
    if (status == SL_OK) {
        sl_writer_text(*csv, header);
        sl_writer_text(*csv, "\n");
    }
    return status;
}

void exp_csv_numbers(sl_writer *csv, const double *value, int32_t count)
{
    for (int32_t k = 0; k < count; k++) {
        sl_writer_text(csv, ",");
        sl_writer_double(csv, value[k]);
    }
}

sl_status exp_csv_close(exp_run *run, sl_writer **csv)
{
    const sl_status status = sl_writer_commit(*csv, &run->diag);
    *csv = NULL;
    return status;
}
