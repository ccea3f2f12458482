/* What kernels share: arrays, Python's arithmetic, and memory for what a kernel makes for itself. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct { double *data; int64_t size0; } vector;
typedef struct { double *data; int64_t size0, size1; } matrix;
typedef struct { double *data; int64_t size0, size1, size2; } cube;
typedef struct { int64_t *data; int64_t size0; } int_vector;
typedef struct { int64_t *data; int64_t size0, size1; } int_matrix;

/* min and max return the first of equal numbers, and the first beside a NaN, as Python's do. */
static inline double double_min(double a, double b) { return b < a ? b : a; }
static inline double double_max(double a, double b) { return b > a ? b : a; }
static inline int64_t int_min(int64_t a, int64_t b) { return b < a ? b : a; }
static inline int64_t int_max(int64_t a, int64_t b) { return b > a ? b : a; }

/* Quotient and remainder are rounded down. */
static inline int64_t int_quotient(int64_t a, int64_t b)
{
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

static inline int64_t int_remainder(int64_t a, int64_t b)
{
    return a % b + ((a % b != 0 && (a < 0) != (b < 0)) ? b : 0);
}

static inline double double_remainder(double a, double b)
{
    const double left = fmod(a, b);
    if (left == 0.0) return copysign(0.0, b);
    return (left < 0.0) != (b < 0.0) ? left + b : left;
}

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

static inline void *arena_take(struct arena *arena, int64_t count)
{
    const size_t bytes = (8 * (size_t)count + 15) & ~(size_t)15;
    if ((size_t)(arena->end - arena->top) < bytes) return arena_more(arena, bytes);
    arena->top += bytes;
    return arena->top - bytes;
}

static inline void *arena_zeros(struct arena *arena, int64_t count)
{
    return memset(arena_take(arena, count), 0, 8 * (size_t)count);
}

static inline void *arena_copy(struct arena *arena, const void *from, int64_t count)
{
    return memcpy(arena_take(arena, count), from, 8 * (size_t)count);
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

