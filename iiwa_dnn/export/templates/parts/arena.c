/* What kernels need for themselves comes from one array. If it ever were too little, no memory but
 * this would be written, and the step would be refused. */
struct arena { char *top, *start, *end; bool *full; };

static inline void *arena_empty(struct arena *arena, int64_t count)
{
    const int64_t bytes = 8 * count;
    char *taken = arena->top;
    if (arena->end - taken < bytes) {
        *arena->full = true;
        taken = arena->start;
    }
    arena->top = taken + bytes;
    return taken;
}

static inline void arena_leave(struct arena *arena, const struct arena *mark)
{
    arena->top = mark->top;
}
