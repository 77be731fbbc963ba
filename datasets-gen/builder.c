#include "builder.h"

#include "base/memory.h"

int32_t gen_vertex(gen_builder *b, double x, double y, double z)
{
    if (b->failed || b->nv >= INT32_MAX / 3 ||
        sl_reserve((void **)&b->xyz, &b->xyz_capacity, 3 * (b->nv + 1), sizeof *b->xyz) != SL_OK) {
        b->failed = true;
        return 0;
    }
    b->xyz[3 * b->nv] = x;
    b->xyz[3 * b->nv + 1] = y;
    b->xyz[3 * b->nv + 2] = z;
    return (int32_t)b->nv++;
}

void gen_facet(gen_builder *b, int32_t n, const int32_t *corner)
{
    if (b->failed || b->nc > INT32_MAX - n ||
        sl_reserve((void **)&b->first, &b->first_capacity, b->nf + 2, sizeof *b->first) != SL_OK ||
        sl_reserve((void **)&b->index, &b->index_capacity, b->nc + n, sizeof *b->index) != SL_OK) {
        b->failed = true;
        return;
    }
    b->first[b->nf++] = (int32_t)b->nc;
    for (int32_t k = 0; k < n; k++) {
        b->index[b->nc++] = corner[k];
    }
    b->first[b->nf] = (int32_t)b->nc;
}

void gen_triangle(gen_builder *b, int32_t i, int32_t j, int32_t k)
{
    gen_facet(b, 3, (int32_t[]){i, j, k});
}

void gen_quad(gen_builder *b, int32_t i, int32_t j, int32_t k, int32_t l)
{
    gen_facet(b, 4, (int32_t[]){i, j, k, l});
}

sl_status gen_finish(gen_builder *b, sl_generated **out)
{
    *out = NULL;
    sl_generated *mesh = b->failed ? NULL : sl_alloc(1, sizeof *mesh);
    if (mesh == NULL) {
        gen_clear(b);
        return SL_OUT_OF_MEMORY;
    }
    *mesh = (sl_generated){
        .nv = (int32_t)b->nv, .nf = (int32_t)b->nf, .xyz = b->xyz, .face_first = b->first, .index = b->index};
    *b = (gen_builder){0};
    *out = mesh;
    return SL_OK;
}

void gen_clear(gen_builder *b)
{
    sl_free(b->xyz);
    sl_free(b->first);
    sl_free(b->index);
    *b = (gen_builder){0};
}
