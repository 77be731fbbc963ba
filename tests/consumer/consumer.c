/* A user's program: unwraps a pyramid through the installed library. */
#include <seamlab.h>

#include <stdio.h>

int main(void)
{
    const double xyz[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.4, 0.9};
    const int32_t first[] = {0, 4, 7, 10, 13, 16};
    const int32_t index[] = {3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    const sl_polygons pyramid = {5, 5, xyz, first, index};
    const sl_atlas_def def = sl_atlas_default();
    sl_diag diag = sl_diag_none();
    sl_atlas *atlas = NULL;
    const sl_status status = sl_unwrap(&pyramid, &def, NULL, &atlas, &diag);
    if (status != SL_OK || !atlas->check.passed) {
        printf("%s: %s\n", sl_status_name(status), diag.reason);
        return 1;
    }
    printf("%d charts, fill %.2f\n", atlas->segmentation->nchart, atlas->pack.fill);
    sl_atlas_free(atlas);
    return 0;
}
