/* Velocity controller of the robot @robot@, made by iiwa_dnn @version@ from its own compiled code.
 *
 * C99 and libm's elementary functions alone. Every function states the file that it is translated
 * from; sizes are constants here: n = @n@ variables, m = @m@ inequality rows, p = @p@ equality rows.
 */
#include "controller.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* The size that the header states. */
typedef char controller_size[sizeof(struct controller) == CONTROLLER_SIZE ? 1 : -1];

@code@

@kinematics@

static struct program_arrays controller_arrays(struct controller *c)
{
    const struct program_arrays arrays = {
        .constants = constants,
        .jacobian = c->jacobian,
        .placements = c->placements,
        .moves = moves,
        .inertia = NULL,
        .rate = 1.0 / CONTROLLER_DT,
    };
    return arrays;
}

static bool all_finite(const double *values, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum += values[i] * 0.0;
    }
    return sum == 0.0;
}

static void forget_state(struct controller *c)
{
    for (int i = 0; i < @state@; i++) {
        c->state[i] = 0.0;
    }
}

/* Stop within the bounds of the step's program: a program without a solution has no better answer. */
static int step_without_solution(struct controller *c, double *dq)
{
    const double *lower = c->row + @at_lb@;
    const double *upper = c->row + @at_ub@;
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        dq[i] = lower[i] > 0.0 ? lower[i] : (upper[i] < 0.0 ? upper[i] : 0.0);
        c->following[CONTROLLER_DOF + i] = dq[i];
        c->following[2 * CONTROLLER_DOF + i] = c->past[CONTROLLER_DOF + i];
        c->following[3 * CONTROLLER_DOF + i] = dq[i];
    }
    return CONTROLLER_STOP;
}

void controller_init(struct controller *c)
{
    const struct controller zero = {0};
    *c = zero;
}

int controller_step(struct controller *c, const double *q, const double *target, double *dq)
{
    if (!all_finite(q, CONTROLLER_DOF) || !all_finite(target, 18 * CONTROLLER_FRAMES)) {
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            dq[i] = 0.0;
        }
        return CONTROLLER_INVALID;
    }
    const struct program_arrays arrays = controller_arrays(c);
    const struct pair clock = {{c->steps * CONTROLLER_DT, c->delay}};
    kinematics(q, c->jacobian, c->placements);
    for (int i = 0; i < 18 * CONTROLLER_FRAMES; i++) {
        c->row[@at_targets@ + i] = target[i];
    }
    int action = 0;
    bool solved = control_step(c->row, &arrays, q, c->past, c->following, c->state, clock, 1);
    if (!solved) {
        forget_state(c);
        solved = control_step(c->row, &arrays, q, c->past, c->following, c->state, clock, 1);
    }
    if (solved) {
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            dq[i] = c->row[@at_dq@ + i];
        }
    } else {
        forget_state(c);
        action = step_without_solution(c, dq);
    }
    for (int i = 0; i < @past@; i++) {
        c->past[i] = c->following[i];
    }
    c->steps += 1.0;
    return action;
}
@target_function@
