#include <stdlib.h>

/* A kernel takes memory from an arena and gives it back where it returns. What does not fit comes
 * from the heap. */
struct block { struct block *next; };
struct arena { char *top, *end; struct block *blocks; };

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
}

