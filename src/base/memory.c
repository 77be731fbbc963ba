#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Bytes of count elements, at least 1; SIZE_MAX when that is no size. */
static size_t byte_count(int64_t count, size_t size)
{
    if (count < 0 || (size > 0 && (uint64_t)count > (uint64_t)PTRDIFF_MAX / size)) {
        return SIZE_MAX;
    }
    const size_t bytes = (size_t)count * size;
    return bytes > 0 ? bytes : 1;
}

void *sl_alloc(int64_t count, size_t size)
{
    const size_t bytes = byte_count(count, size);
    return bytes != SIZE_MAX ? malloc(bytes) : NULL;
}

void *sl_calloc(int64_t count, size_t size)
{
    const size_t bytes = byte_count(count, size);
    return bytes != SIZE_MAX ? calloc(1, bytes) : NULL;
}

void *sl_realloc(void *memory, int64_t count, size_t size)
{
    const size_t bytes = byte_count(count, size);
    return bytes != SIZE_MAX ? realloc(memory, bytes) : NULL;
}

void *sl_copy(const void *source, int64_t count, size_t size)
{
    void *copy = sl_alloc(count, size);
    if (copy != NULL && count > 0) {
        memcpy(copy, source, (size_t)count * size);
    }
    return copy;
}

void sl_free(void *memory)
{
    free(memory);
}

sl_status sl_reserve(void **array, int64_t *capacity, int64_t need, size_t size)
{
    if (need <= *capacity) {
        return SL_OK;
    }
    int64_t grown = *capacity + *capacity / 2 + 16;
    grown = grown > need ? grown : need;
    void *memory = sl_realloc(*array, grown, size);
    if (memory == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *array = memory;
    *capacity = grown;
    return SL_OK;
}

sl_status sl_mul_size(int64_t a, int64_t b, int64_t *out)
{
    SL_ASSERT(a >= 0 && b >= 0);
    if (b != 0 && a > INT64_MAX / b) {
        return SL_OUT_OF_MEMORY;
    }
    *out = a * b;
    return SL_OK;
}

sl_status sl_add_size(int64_t a, int64_t b, int64_t *out)
{
    SL_ASSERT(a >= 0 && b >= 0);
    if (a > INT64_MAX - b) {
        return SL_OUT_OF_MEMORY;
    }
    *out = a + b;
    return SL_OK;
}

typedef struct arena_block {
    struct arena_block *next;
    size_t used, size;
    max_align_t data[];
} arena_block;

struct sl_arena {
    arena_block *head;
};

static const size_t first_block_bytes = 1u << 16;

sl_status sl_arena_create(sl_arena **out)
{
    *out = sl_calloc(1, sizeof **out);
    return *out != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

void *sl_arena_alloc(sl_arena *arena, int64_t count, size_t size)
{
    const size_t wanted = byte_count(count, size);
    if (wanted > PTRDIFF_MAX / 2) {
        return NULL;
    }
    const size_t bytes = (wanted + 15) / 16 * 16;
    if (arena->head == NULL || arena->head->size - arena->head->used < bytes) {
        size_t room = arena->head != NULL ? 2 * arena->head->size : first_block_bytes;
        room = room > bytes ? room : bytes;
        arena_block *block = malloc(sizeof *block + room);
        if (block == NULL) {
            return NULL;
        }
        *block = (arena_block){arena->head, 0, room};
        arena->head = block;
    }
    void *memory = (char *)arena->head->data + arena->head->used;
    arena->head->used += bytes;
    return memory;
}

void sl_arena_free(sl_arena *arena)
{
    if (arena == NULL) {
        return;
    }
    for (arena_block *b = arena->head; b != NULL;) {
        arena_block *next = b->next;
        free(b);
        b = next;
    }
    free(arena);
}
