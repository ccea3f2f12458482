/* What kernels share: arrays, Python's arithmetic, and what a kernel does with its arena. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct { double *data; int64_t size0; } Vector;
typedef struct { double *data; int64_t size0, size1; } Matrix;
typedef struct { int64_t *data; int64_t size0; } IntVector;
typedef struct { int64_t *data; int64_t size0, size1; } IntMatrix;

/* min and max return the first of equal numbers, and the first beside a NaN, as Python's do.
 * Quotient and remainder are rounded down. A float beyond all integers becomes the last of them. */

static inline double double_min(double a, double b) { return b < a ? b : a; }

static inline double double_max(double a, double b) { return b > a ? b : a; }

static inline int64_t int_min(int64_t a, int64_t b) { return b < a ? b : a; }

static inline int64_t int_max(int64_t a, int64_t b) { return b > a ? b : a; }

static inline int64_t int_quotient(int64_t a, int64_t b)
{
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

static inline int64_t int_remainder(int64_t a, int64_t b)
{
    return a % b + ((a % b != 0 && (a < 0) != (b < 0)) ? b : 0);
}

static inline int64_t int_of(double a)
{
    if (!(a < (double)INT64_MAX)) return INT64_MAX;
    return a > (double)INT64_MIN ? (int64_t)a : INT64_MIN;
}

static inline int64_t int_floor(double a) { return int_of(floor(a)); }

static inline int64_t int_ceil(double a) { return int_of(ceil(a)); }

static inline double double_remainder(double a, double b)
{
    const double left = fmod(a, b);
    if (left == 0.0) return copysign(0.0, b);
    return (left < 0.0) != (b < 0.0) ? left + b : left;
}

struct arena;
static inline void *arena_empty(struct arena *arena, int64_t count);

static inline void *arena_zeros(struct arena *arena, int64_t count)
{
    return memset(arena_empty(arena, count), 0, 8 * (size_t)count);
}

static inline void *arena_copy(struct arena *arena, const void *from, int64_t count)
{
    return memcpy(arena_empty(arena, count), from, 8 * (size_t)count);
}
