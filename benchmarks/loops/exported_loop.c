/* The times of an exported controller's steps in closed loop with an arm that follows every command.
 *
 * ./exported_loop steps q1 ... qn prints median, p99 and p99.9 of a step [us].
 */
#define _POSIX_C_SOURCE 199309L
#include "controller.h"

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
    static struct controller c;
    double q[CONTROLLER_DOF];
    double dq[CONTROLLER_DOF];
    double target[18 * CONTROLLER_FRAMES];
    const size_t steps = (size_t)atol(words[1]);
    double *times = malloc(steps * sizeof *times);
    if (times == NULL || count != 2 + CONTROLLER_DOF) {
        return 2;
    }
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        q[i] = atof(words[2 + i]);
    }
    controller_init(&c);
    for (size_t k = 0; k < steps; k++) {
        controller_target(&c, (double)k * CONTROLLER_DT, target);
        const double began = now();
        controller_step(&c, q, target, dq);
        times[k] = now() - began;
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            q[i] += CONTROLLER_DT * dq[i];
        }
    }
    qsort(times, steps, sizeof *times, compare);
    printf("%.4f %.4f %.4f\n", times[steps / 2], times[steps * 99 / 100], times[steps * 999 / 1000]);
    free(times);
    return 0;
}
