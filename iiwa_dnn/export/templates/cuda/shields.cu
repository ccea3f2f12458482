/* Shields of many arms of the robot @robot@ on a GPU, one thread an arm: shield.c and kernels over a grid.
 *
 * Compile it by NVRTC with -fmad=false --std=c++20 --device-as-default-execution-space: the commands are
 * then those of the CPU, to the last bit. Number i of arm k of `count` stands at arms[i * count + k], so
 * neighbours' numbers lie together. A step works on a copy in the memory of its thread, where they do too.
 */
#ifdef __CUDACC_RTC__ /* which has no headers */
#define INFINITY __builtin_bit_cast(double, 0x7ff0000000000000ll)
#define PTRDIFF_MAX 0x7fffffffffffffffll
#define PTRDIFF_MIN (-PTRDIFF_MAX - 1)
#define __atomic_fetch_add(next, more, order) atomicAdd((unsigned long long *)(next), more)
#else
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#endif

@shield@

/* ---- Kernels over a grid ---- */

#define GRID_ARM ((ptrdiff_t)blockIdx.x * blockDim.x + threadIdx.x)
#define GRID_NUMBERS ((ptrdiff_t)(sizeof(struct shield) / sizeof(double)))

static void grid_read(struct shield *own, const double *arms, ptrdiff_t count, ptrdiff_t k)
{
#pragma unroll 8
    for (ptrdiff_t i = 0; i < GRID_NUMBERS; i++) {
        own->memory[i] = arms[i * count + k];
    }
}

static void grid_write(const struct shield *own, double *arms, ptrdiff_t count, ptrdiff_t k)
{
#pragma unroll 8
    for (ptrdiff_t i = 0; i < GRID_NUMBERS; i++) {
        arms[i * count + k] = own->memory[i];
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

/* Take a step of each arm, as shield_step.
 *
 * q, dq and next_q are (count, SHIELD_JOINTS), requests (count, SHIELD_JOINTS) or (count, 6); NULL: none.
 * `given` (count) says which arms have a new request; NULL: all. The obstacles of arm k begin at
 * places[k * stride]; NULL: they are where they were. Where they are not finite, they stay there, and the
 * arm brakes as for a request that is not.
 */
extern "C" __global__ void grid_step(
    double *arms, ptrdiff_t count, const double *q, int kind, const double *requests, const bool *given,
    const double *places, ptrdiff_t stride, double dt, double elapsed,
    double *dq, double *next_q, bool *clipped, int *reasons
)
{
    const double wrong[] = {INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0};
    const ptrdiff_t width = kind == SHIELD_REQUEST_TWIST ? 6 : SHIELD_JOINTS;
    const ptrdiff_t k = GRID_ARM;
    struct shield own;
    if (k >= count) {
        return;
    }
    grid_read(&own, arms, count, k);
    struct shield_input input = {q + k * SHIELD_JOINTS, (enum shield_request)kind, NULL, dt, elapsed};
    if (requests && (!given || given[k])) {
        input.request = requests + k * width;
    }
    if (places && grid_is_finite(places + k * stride, 3 * SHIELD_OBSTACLES)) {
        shield_place(&own, places + k * stride);
    } else if (places) {
        input.kind = SHIELD_REQUEST_TWIST;
        input.request = wrong;
    }
    reasons[k] = shield_step(&own, &input, dq + k * SHIELD_JOINTS);
    memcpy(next_q + k * SHIELD_JOINTS, shield_next_q(&own), SHIELD_JOINTS * sizeof *dq);
    clipped[k] = shield_is_clipped(&own);
    grid_write(&own, arms, count, k);
}

/* Let the arms of a mask (count), NULL: all, stand at q (count, SHIELD_JOINTS), or at what is measured next
 * (NULL); or let them brake until then. */
extern "C" __global__ void grid_rest(
    double *arms, ptrdiff_t count, const bool *mask, const double *q, bool halts
)
{
    const ptrdiff_t k = GRID_ARM;
    struct shield own;
    if (k >= count || (mask && !mask[k])) {
        return;
    }
    grid_read(&own, arms, count, k);
    if (halts) {
        shield_halt(&own);
    } else {
        shield_reset(&own, q ? q + k * SHIELD_JOINTS : NULL);
    }
    grid_write(&own, arms, count, k);
}
