/* Velocity controller of the robot @robot@, made by iiwa_dnn @version@ from its own compiled code.
 *
 * C99 and libm's elementary functions alone. Every function states the file that it is translated
 * from; sizes are constants here: n = @n@ variables, m = @m@ inequality rows, p = @p@ equality rows.
 */
#include "controller.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Places in the row, and the action that the policy asks for at a step without a solution. */
#define AT_TARGETS @at_targets@
#define AT_DECISION @at_decision@
#define AT_DQ @at_dq@
#define POLICY @policy@

/* The size that the header states. */
typedef char controller_size[sizeof(struct controller) == CONTROLLER_SIZE ? 1 : -1];

@code@

@kinematics@

/* Assigned, and not initialized: compilers would keep a copy of that in memory. */
static struct program_arrays controller_arrays(struct controller *c)
{
    struct program_arrays arrays;
@arrays@
    return arrays;
}

static struct yielding controller_yielding(void)
{
    struct yielding yielding;
@yielding@
    return yielding;
}
@move_function@
static bool all_finite(const double *values, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum += values[i] * 0.0;
    }
    return sum == 0.0;
}

void controller_init(struct controller *c)
{
    const struct controller zero = {0};
    *c = zero;
@start@}

int controller_step(struct controller *c, const double *q, const double *target, double *dq)
{
    if (!all_finite(q, CONTROLLER_DOF) || !all_finite(target, 18 * CONTROLLER_FRAMES)) {
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            dq[i] = 0.0;
        }
        return CONTROLLER_INVALID;
    }
    const struct program_arrays arrays = controller_arrays(c);
    const struct yielding yielding = controller_yielding();
    const double t = c->steps * CONTROLLER_DT;
    const struct pair clock = {{t, c->delay}};
    int action = 0;
    kinematics(q, c->jacobian, c->placements@inertia@);
    for (int i = 0; i < 18 * CONTROLLER_FRAMES; i++) {
        c->row[AT_TARGETS + i] = target[i];
    }
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        c->past[i] = q[i];
    }
@move@    const bool solved = control_step(
        c->row, &arrays, c->past, c->following, c->state, clock, false, c->yields == 0.0)@guard@;
    if (!solved) {
@cold@        action = yield_step(
            c->row, &arrays, c->past, c->following, @state@, &yielding, c->relaxed, POLICY);
        c->yields = c->row[AT_DECISION + 3] > 0.0 && c->row[AT_DECISION + 3] < 4.0;
    }
    if (action != 0) {
        c->delay += CONTROLLER_DT * (1.0 - c->row[AT_DECISION + 1]);
    }
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        dq[i] = c->row[AT_DQ + i];
    }
    for (int i = 0; i < @past_size@; i++) {
        c->past[i] = c->following[i];
    }
    c->steps += 1.0;
    return action;
}
@target_function@
