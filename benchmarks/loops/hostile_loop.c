/* An exported controller under hostile targets, judged without its own code.
 *
 * ./hostile_loop steps seed q1 ... qn dqmax1 ... dqmaxn prints steps with each action, steps whose
 * input was refused, steps that broke a velocity limit, the most linear systems of a step, and the
 * longest step [us]. The arm follows each command; every 2,000 steps it begins anew. Targets jump
 * every 20 to 400 steps: nearby, far out of reach, turned over, moving, and now and then no number.
 */
#define _POSIX_C_SOURCE 199309L
#include "controller.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

extern long controller_systems; /* counted by code that the benchmark puts into controller.c */

static uint64_t state;

static double draw(double from, double to)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return from + (to - from) * ((double)(state >> 11) / 9007199254740992.0);
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e6 * (double)time.tv_sec + 1e-3 * (double)time.tv_nsec;
}

/* Draw a rotation of any angle, row by row, from a quaternion. */
static void draw_rotation(double *r)
{
    double a[4];
    double square = 0.0;
    do {
        square = 0.0;
        for (int i = 0; i < 4; i++) {
            a[i] = draw(-1.0, 1.0);
            square += a[i] * a[i];
        }
    } while (square > 1.0 || square < 1e-3);
    const double s = 2.0 / square;
    r[0] = 1.0 - s * (a[2] * a[2] + a[3] * a[3]);
    r[1] = s * (a[1] * a[2] - a[0] * a[3]);
    r[2] = s * (a[1] * a[3] + a[0] * a[2]);
    r[3] = s * (a[1] * a[2] + a[0] * a[3]);
    r[4] = 1.0 - s * (a[1] * a[1] + a[3] * a[3]);
    r[5] = s * (a[2] * a[3] - a[0] * a[1]);
    r[6] = s * (a[1] * a[3] - a[0] * a[2]);
    r[7] = s * (a[2] * a[3] + a[0] * a[1]);
    r[8] = 1.0 - s * (a[1] * a[1] + a[2] * a[2]);
}

static void draw_target(double *target)
{
    const double kind = draw(0.0, 1.0);
    const double far = kind < 0.4 ? 0.05 : kind < 0.8 ? 0.6 : 3.0;
    for (int i = 0; i < 3; i++) {
        target[i] += draw(-far, far);
        if (!(fabs(target[i]) < 2.0 * far + 1.0)) {
            target[i] = draw(-1.0, 1.0);
        }
    }
    if (draw(0.0, 1.0) < 0.3) {
        draw_rotation(target + 3);
    }
    for (int i = 12; i < 18; i++) {
        target[i] = draw(0.0, 1.0) < 0.3 ? draw(-1.0, 1.0) : 0.0;
    }
    if (draw(0.0, 1.0) < 0.01) {
        target[0] = draw(0.0, 1.0) < 0.5 ? NAN : 1e300;
    }
}

int main(int count, char **words)
{
    static struct controller c;
    double q[CONTROLLER_DOF];
    double dq[CONTROLLER_DOF];
    double target[18 * CONTROLLER_FRAMES];
    long actions[8] = {0};
    long refused = 0;
    long broken = 0;
    long most = 0;
    double longest = 0.0;
    long left = 0;
    if (count != 3 + 2 * CONTROLLER_DOF) {
        return 2;
    }
    const long steps = atol(words[1]);
    state = 88172645463325252u + (uint64_t)atol(words[2]);
    for (long k = 0; k < steps; k++) {
        if (k % 2000 == 0) {
            controller_init(&c);
            for (int i = 0; i < CONTROLLER_DOF; i++) {
                q[i] = atof(words[3 + i]);
            }
            controller_target(&c, 0.0, target);
        }
        if (left-- <= 0) {
            for (int f = 0; f < CONTROLLER_FRAMES; f++) {
                draw_target(target + 18 * f);
            }
            left = (long)draw(20.0, 400.0);
        }
        controller_systems = 0;
        const double began = now();
        const int action = controller_step(&c, q, target, dq);
        longest = fmax(longest, now() - began);
        most = controller_systems > most ? controller_systems : most;
        if (action == CONTROLLER_INVALID) {
            refused++;
        } else {
            actions[action]++;
        }
        int within = 1;
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            within = within && fabs(dq[i]) <= atof(words[3 + CONTROLLER_DOF + i]) * (1.0 + 1e-12);
            q[i] += CONTROLLER_DT * dq[i];
        }
        broken += !within;
    }
    for (int i = 0; i <= 4; i++) {
        printf("%ld ", actions[i]);
    }
    printf("%ld %ld %ld %.1f\n", refused, broken, most, longest);
    return 0;
}
