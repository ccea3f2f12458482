/* A checked build: an index outside of its array ends the call from Python, with an IndexError. */
#include <setjmp.h>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wclobbered" /* arguments are not changed after setjmp */
#endif

static _Thread_local jmp_buf *checked_exit;

static inline int64_t checked_index(int64_t index, int64_t size, const char *file, int line)
{
    if (index >= 0 && index < size) return index;
    PyErr_Format(PyExc_IndexError, "%s:%d: index %lld is none of an axis of %lld", file, line,
        (long long)index, (long long)size);
    longjmp(*checked_exit, 1);
}

static inline int64_t checked_shape(int64_t size, int64_t asked, int64_t first, const char *file, int line)
{
    if (asked == size) return first;
    PyErr_Format(PyExc_ValueError, "%s:%d: %lld elements are reshaped to %lld", file, line,
        (long long)size, (long long)asked);
    longjmp(*checked_exit, 1);
}

#define checked(index, size) checked_index(index, size, __FILE__, __LINE__)
#define shaped(size, asked, first) checked_shape(size, asked, first, __FILE__, __LINE__)
#define BEGIN_CHECKED \
    jmp_buf here; \
    jmp_buf *const outer = checked_exit; \
    const struct arena before = *arena_here(); \
    checked_exit = &here; \
    if (setjmp(here)) { \
        checked_exit = outer; \
        arena_leave(arena_here(), &before); \
        return NULL; \
    }
#define END_CHECKED checked_exit = outer;
