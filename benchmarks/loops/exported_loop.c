/* The times of an exported controller's steps in closed loop with an arm that follows every command.
 *
 * ./exported_loop steps q1 ... qn prints median, p99 and p99.9 of a step [us].
 */
#define _POSIX_C_SOURCE 199309L
#include "arm.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e6 * (double)time.tv_sec + 1e-3 * (double)time.tv_nsec;
}

static int compare(const void *one, const void *other)
{
    const double a = *(const double *)one;
    const double b = *(const double *)other;
    return (a > b) - (a < b);
}

int main(int count, char **words)
{
    static struct armstep own;
    static double memory[ARM_MEMORY], scratch[ARM_SCRATCH];
    double q[ARM_JOINTS];
    double dq[ARM_JOINTS];
    double target[ARMSTEP_TARGET * ARM_FRAMES];
    const size_t steps = (size_t)atol(words[1]);
    double *times = malloc(steps * sizeof *times);
    if (times == NULL || count != 2 + ARM_JOINTS) {
        return 2;
    }
    for (int i = 0; i < ARM_JOINTS; i++) {
        q[i] = atof(words[2 + i]);
    }
    if (armstep_load(&own, &arm) != ARMSTEP_OK) {
        return 2;
    }
    armstep_begin(&own, memory, scratch);
    for (size_t k = 0; k < steps; k++) {
        const double t = (double)k * arm.dt;
        const struct armstep_input input = {q, ARMSTEP_REQUEST_NONE, target, t, 0.0, 0.0};
        armstep_targets(&own, memory, scratch, t, target);
        const double began = now();
        armstep_step(&own, memory, scratch, &input, dq);
        times[k] = now() - began;
        for (int i = 0; i < ARM_JOINTS; i++) {
            q[i] += arm.dt * dq[i];
        }
    }
    qsort(times, steps, sizeof *times, compare);
    printf("%.4f %.4f %.4f\n", times[steps / 2], times[steps * 99 / 100], times[steps * 999 / 1000]);
    free(times);
    return 0;
}
