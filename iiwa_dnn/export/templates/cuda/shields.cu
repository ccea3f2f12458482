/* Shields of many arms on a GPU, one thread an arm: armstep.c, and kernels over a grid.
 *
 * Compile it by NVRTC with -fmad=false --std=c++20 --device-as-default-execution-space: the commands are
 * then those of the CPU, to the last bit; with the sizes of an arm, GRID_JOINTS, GRID_OBSTACLES, GRID_MEMORY and
 * GRID_SCRATCH, as macros. Number i of arm k of `count` stands at arms[i * count + k], so neighbours' numbers lie
 * together. A step works on a copy in the memory of its thread, where they do too.
 */
#ifdef __CUDACC_RTC__ /* which has no headers */
#define INFINITY __builtin_bit_cast(double, 0x7ff0000000000000ll)
#define PTRDIFF_MAX 0x7fffffffffffffffll
#define PTRDIFF_MIN (-PTRDIFF_MAX - 1)
#define NAN __builtin_bit_cast(double, 0x7ff8000000000000ll)
#define DBL_MAX 0x1.fffffffffffffp+1023
#define DBL_MIN 0x1p-1022
#define UINT64_C(number) number##ull
typedef unsigned long long uint64_t;
#else
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#endif

@sources@

/* ---- Kernels over a grid ---- */

#define GRID_ARM ((ptrdiff_t)blockIdx.x * blockDim.x + threadIdx.x)

/* Lay tables out, whose arrays are on the GPU. */
extern "C" __global__ void grid_load(
    struct armstep *arm, struct armstep_tables *tables, const double *numbers, const ptrdiff_t *integers,
    const ptrdiff_t *parts, int *status
)
{
    tables->numbers = numbers;
    tables->integers = integers;
    tables->parts = parts;
    *status = armstep_load(arm, tables);
}

static void grid_read(double *own, const double *arms, ptrdiff_t count, ptrdiff_t k)
{
#pragma unroll 8
    for (ptrdiff_t i = 0; i < GRID_MEMORY; i++) {
        own[i] = arms[i * count + k];
    }
}

static void grid_write(const double *own, double *arms, ptrdiff_t count, ptrdiff_t k)
{
#pragma unroll 8
    for (ptrdiff_t i = 0; i < GRID_MEMORY; i++) {
        arms[i * count + k] = own[i];
    }
}

static bool grid_is_finite(const double *numbers, ptrdiff_t count)
{
    for (ptrdiff_t i = 0; i < count; i++) {
        if (!(fabs(numbers[i]) < INFINITY)) {
            return false;
        }
    }
    return true;
}

/* Take a step of each arm, as armstep_step.
 *
 * q, dq and next_q are (count, GRID_JOINTS), requests (count, GRID_JOINTS) or (count, 6); NULL: none.
 * `given` (count) says which arms have a new request; NULL: all. The obstacles of arm k begin at
 * places[k * stride]; NULL: they are where they were. Where they are not finite, they stay there, and the
 * arm brakes as for a request that is not.
 */
extern "C" __global__ void grid_step(
    const struct armstep *arm, double *arms, ptrdiff_t count, const double *q, int kind, const double *requests,
    const bool *given, const double *places, ptrdiff_t stride, double dt, double elapsed,
    double *dq, double *next_q, bool *clipped, int *reasons
)
{
    const double wrong[] = {INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0};
    const ptrdiff_t width = kind == ARMSTEP_REQUEST_TWIST ? 6 : GRID_JOINTS;
    const ptrdiff_t k = GRID_ARM;
    double own[GRID_MEMORY];
    double scratch[GRID_SCRATCH];
    if (k >= count) {
        return;
    }
    grid_read(own, arms, count, k);
    struct armstep_input input = {q + k * GRID_JOINTS, kind, NULL, 0.0, dt, elapsed};
    if (requests && (!given || given[k])) {
        input.request = requests + k * width;
    }
    if (places && grid_is_finite(places + k * stride, 3 * GRID_OBSTACLES)) {
        armstep_place(arm, own, places + k * stride);
    } else if (places) {
        input.kind = ARMSTEP_REQUEST_TWIST;
        input.request = wrong;
    }
    reasons[k] = armstep_step(arm, own, scratch, &input, dq + k * GRID_JOINTS);
    memcpy(next_q + k * GRID_JOINTS, armstep_next_q(arm, own), GRID_JOINTS * sizeof *dq);
    clipped[k] = armstep_is_clipped(arm, own);
    grid_write(own, arms, count, k);
}

/* Let the arms of a mask (count), NULL: all, stand at q (count, GRID_JOINTS), or at what is measured next
 * (NULL); or let them brake until then. */
extern "C" __global__ void grid_rest(
    const struct armstep *arm, double *arms, ptrdiff_t count, const bool *mask, const double *q, bool halts
)
{
    const ptrdiff_t k = GRID_ARM;
    double own[GRID_MEMORY];
    double scratch[GRID_SCRATCH];
    if (k >= count || (mask && !mask[k])) {
        return;
    }
    grid_read(own, arms, count, k);
    if (halts) {
        armstep_halt(arm, own);
    } else {
        armstep_rest(arm, own, scratch, q ? q + k * GRID_JOINTS : NULL);
    }
    grid_write(own, arms, count, k);
}
