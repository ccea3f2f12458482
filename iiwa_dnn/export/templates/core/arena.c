/* What kernels need for themselves comes from the caller's scratch. If it ever were too little, no memory but
 * this would be written, and the step would be refused. */
struct arena {
    char *top, *start, *end;
    bool full;
    const struct armstep_tables *tables;
};

static inline void *arena_empty(struct arena *arena, int64_t count)
{
    char *taken = arena->top;
    if (count < 0 || count > (arena->end - taken) / 8) {
        arena->full = true;
        return @instead@;
    }
    arena->top = taken + 8 * count;
    return taken;
}

static inline void arena_leave(struct arena *arena, const struct arena *mark)
{
    arena->top = mark->top;
}

/* Find a part of a user's own by its number; NULL: there is none of this kind. */
static inline const struct armstep_own *own_part_of(struct arena *arena, int64_t number, enum armstep_entry entry)
{
    const struct armstep_tables *tables = arena->tables;
    const int64_t k = number - ARMSTEP_PARTS;
    return k >= 0 && k < tables->own_count && tables->own[k].entry == entry ? tables->own + k : NULL;
}
