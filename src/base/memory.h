/* Checked allocation: counts times sizes that cannot overflow, and an arena for what dies together.
 * Layer: base. */
#ifndef SL_BASE_MEMORY_H
#define SL_BASE_MEMORY_H

#include "base/status.h"

/* count elements of size bytes, uninitialised; NULL when count < 0, the product overflows or memory is out. A count of
 * 0 gives a unique non-NULL pointer, so NULL always means failure. Free with sl_free. */
SL_NODISCARD void *sl_alloc(int64_t count, size_t size);

/* As sl_alloc, zeroed. */
SL_NODISCARD void *sl_calloc(int64_t count, size_t size);

/* Grows or shrinks memory from sl_alloc; on failure NULL is returned and the old memory stands. */
SL_NODISCARD void *sl_realloc(void *memory, int64_t count, size_t size);

/* A copy of count elements; NULL on failure. source may be NULL only if count is 0. */
SL_NODISCARD void *sl_copy(const void *source, int64_t count, size_t size);

void sl_free(void *memory); /* NULL is a no-op */

/* Makes room for at least `need` elements in *array of *capacity elements, growing by half at least. On failure the
 * array is unchanged. Amortised O(1) an element. */
SL_NODISCARD sl_status sl_reserve(void **array, int64_t *capacity, int64_t need, size_t size);

/* *out = a * b or a + b; SL_OUT_OF_MEMORY when that does not fit. */
SL_NODISCARD sl_status sl_mul_size(int64_t a, int64_t b, int64_t *out);
SL_NODISCARD sl_status sl_add_size(int64_t a, int64_t b, int64_t *out);

/* Bump allocator: everything dies together. */
typedef struct sl_arena sl_arena;

SL_NODISCARD sl_status sl_arena_create(sl_arena **out);

/* count elements of size bytes, aligned to 16, uninitialised; NULL on failure. Lives until sl_arena_free. */
SL_NODISCARD void *sl_arena_alloc(sl_arena *arena, int64_t count, size_t size);

void sl_arena_free(sl_arena *arena); /* NULL is a no-op */

#endif
