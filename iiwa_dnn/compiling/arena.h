#include <stdlib.h>

/* A kernel takes memory from an arena and gives it back where it returns. What does not fit comes
 * from the heap. `used` counts both, in bytes. */
struct block { struct block *next; };
struct arena { char *top, *end; struct block *blocks; size_t used; };
static _Thread_local size_t arena_peak;

static void *arena_more(struct arena *arena, size_t bytes)
{
    struct block *block = malloc(64 + bytes);
    if (!block) abort();
    block->next = arena->blocks;
    arena->blocks = block;
    return (char *)block + 64;
}

static inline void *arena_empty(struct arena *arena, int64_t count)
{
    const size_t bytes = (8 * (size_t)count + 15) & ~(size_t)15;
    arena->used += bytes;
    if (arena->used > arena_peak) arena_peak = arena->used;
    if ((size_t)(arena->end - arena->top) < bytes) return arena_more(arena, bytes);
    arena->top += bytes;
    return arena->top - bytes;
}

static void arena_free(struct arena *arena, const struct block *last)
{
    while (arena->blocks != last) {
        struct block *block = arena->blocks;
        arena->blocks = block->next;
        free(block);
    }
}

static inline void arena_leave(struct arena *arena, const struct arena *mark)
{
    if (arena->blocks != mark->blocks) arena_free(arena, mark->blocks);
    arena->top = mark->top;
    arena->used = mark->used;
}

