/* What one solver leaves to the next. */
#include "param/stretch_internal.h"

#include "base/memory.h"

#include <string.h>

struct sl_stretch_workspace {
    sl_stretch_store store;
};

sl_status sl_stretch_workspace_create(sl_stretch_workspace **out)
{
    *out = sl_calloc(1, sizeof **out);
    if (*out == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    (*out)->store.shared = true;
    return SL_OK;
}

static void clear_system(sl_stretch_store *store)
{
    sl_stretch_system_clear(&store->system);
    sl_stretch_freedom_clear(&store->freedom);
    sl_free(store->tri);
    sl_free(store->xyz);
    store->tri = NULL;
    store->xyz = NULL;
    store->nt = 0;
}

static void clear_store(sl_stretch_store *store)
{
    clear_system(store);
    sl_stretch_rest_clear(&store->rest);
    sl_free(store->block);
    store->block = NULL;
    store->capacity = 0;
}

void sl_stretch_workspace_free(sl_stretch_workspace *workspace)
{
    if (workspace != NULL) {
        SL_ASSERT(!workspace->store.lent);
        clear_store(&workspace->store);
        sl_free(workspace);
    }
}

sl_stretch_store *sl_stretch_store_borrow(sl_stretch_workspace *workspace, sl_stretch_store *own)
{
    if (workspace == NULL || workspace->store.lent) {
        return own;
    }
    workspace->store.lent = true;
    return &workspace->store;
}

void sl_stretch_store_return(sl_stretch_workspace *workspace, sl_stretch_store *store)
{
    if (workspace != NULL && store == &workspace->store) {
        store->lent = false;
    } else {
        clear_store(store);
    }
}

/* Are two arrays, each perhaps absent, the same? */
static bool is_same(const void *a, const void *b, size_t size)
{
    return a == NULL || b == NULL ? a == b : memcmp(a, b, size) == 0;
}

static bool fits(const sl_stretch_store *store, const sl_patch *patch, const sl_stretch_freedom *freedom)
{
    const sl_stretch_freedom *had = &store->freedom;
    return store->system.H != NULL && store->tri != NULL && store->nt == patch->nt && had->nv == freedom->nv &&
           had->unknowns == freedom->unknowns && had->block == freedom->block &&
           is_same(had->unknown, freedom->unknown, 2 * (size_t)freedom->nv * sizeof *freedom->unknown) &&
           memcmp(store->tri, patch->tri, 3 * (size_t)patch->nt * sizeof *patch->tri) == 0 &&
           memcmp(store->xyz, patch->xyz, 3 * (size_t)patch->nv * sizeof *patch->xyz) == 0;
}

/* What the system was made for (the points decide on the order of elimination, and so on the last bits). Without room
 * to note it, it is not used again. */
static void note(sl_stretch_store *store, const sl_patch *patch, const sl_stretch_freedom *freedom)
{
    store->nt = patch->nt;
    store->tri = sl_copy(patch->tri, 3 * (int64_t)patch->nt, sizeof *patch->tri);
    store->xyz = sl_copy(patch->xyz, 3 * (int64_t)patch->nv, sizeof *patch->xyz);
    store->freedom = (sl_stretch_freedom){.nv = freedom->nv, .unknowns = freedom->unknowns, .block = freedom->block};
    if (freedom->unknown != NULL) {
        store->freedom.unknown = sl_copy(freedom->unknown, 2 * (int64_t)freedom->nv, sizeof *freedom->unknown);
    }
    if (store->xyz == NULL || (freedom->unknown != NULL && store->freedom.unknown == NULL)) {
        sl_free(store->tri);
        store->tri = NULL;
    }
}

sl_status sl_stretch_store_system(sl_stretch_store *store, const sl_patch *patch, const sl_stretch_freedom *freedom)
{
    if (fits(store, patch, freedom)) {
        return SL_OK;
    }
    clear_system(store);
    const sl_status status = sl_stretch_system_init(patch, freedom, &store->system);
    if (status == SL_OK && store->shared) {
        note(store, patch, freedom);
    }
    return status;
}
