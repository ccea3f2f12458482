/* The times of an exported controller's steps in closed loop with an arm that follows every command.
 *
 * ./exported_loop steps q1 ... qn prints median, p99, p99.9 and largest time [us] of a step, then the
 * same of a loop that does nothing between two readings of the clock.
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

static void print_times(double *times, size_t count)
{
    qsort(times, count, sizeof *times, compare);
    const size_t places[] = {count / 2, count * 99 / 100, count * 999 / 1000, count - 1};
    for (size_t i = 0; i < 4; i++) {
        printf("%.4f ", times[places[i]]);
    }
}

int main(int count, char **words)
{
    static struct controller c;
    double q[CONTROLLER_DOF];
    double dq[CONTROLLER_DOF];
    double target[18 * CONTROLLER_FRAMES];
    const size_t steps = (size_t)atol(words[1]);
    double *times = malloc(2 * steps * sizeof *times);
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
    for (size_t k = 0; k < steps; k++) {
        const double began = now();
        times[steps + k] = now() - began;
    }
    print_times(times, steps);
    print_times(times + steps, steps);
    free(times);
    return 0;
}
