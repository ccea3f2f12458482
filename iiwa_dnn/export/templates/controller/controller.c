/* Velocity controller of the robot @robot@, made by iiwa_dnn @version@ from its own kernels.
 *
 * C99 and libm's elementary functions alone. Every function states the file that it is translated
 * from. Programs have @n@ variables, @m@ inequality rows, @p@ equality rows. In this order stand:
 *
@map@
 * - Interface: `controller_step` and what the header declares beside it
 */
#include "controller.h"

@code@

/* ---- Interface ---- */

static inline struct arena controller_arena(struct controller *c, bool *full)
{
    char *start = (char *)c->scratch;
    const struct arena arena = {start, start, start + sizeof c->scratch, full};
    return arena;
}

/* What a step is laid out with; tables, and the kinematics in the controller. */
static inline control_cycle_ControlPlan controller_plan(struct controller *c)
{
    (void)c;
    const control_cycle_ControlPlan plan = @plan@;
    return plan;
}

static bool controller_is_finite(const double *x, int count)
{
    for (int i = 0; i < count; i++) {
        if (!(fabs(x[i]) < INFINITY)) {
            return false;
        }
    }
    return true;
}

void controller_init(struct controller *c)
{
    memset(c, 0, sizeof *c);
}

int controller_step(struct controller *c, const double *q, const double *target, double *dq)
{
    bool full = false;
    struct arena arena = controller_arena(c, &full);
    const control_cycle_ControlPlan plan = controller_plan(c);
    const robot_kinematics_kernel_ModelTables model = @model@;
    const Vector data = {c->log, @width@};
    const control_command_StepLog log = @log_of@data, &plan.arrays.sizes);
    const Vector motion_state = {c->motion_state, @motion@};
    const Vector next_motion_state = {c->next_motion_state, @motion@};
    const Vector state = {c->state, @state@};
    const Vector joints = {(double *)q, CONTROLLER_DOF};
    const double t = c->steps[0] * CONTROLLER_DT;
    if (!controller_is_finite(q, CONTROLLER_DOF) || !controller_is_finite(target, 18 * CONTROLLER_FRAMES)) {
        memset(dq, 0, sizeof(double) * CONTROLLER_DOF);
        return CONTROLLER_INVALID;
    }
    memcpy(log.targets.data, target, sizeof(double) * 18 * CONTROLLER_FRAMES);
    @kinematics@&model, joints, plan.arrays.jacobian, plan.arrays.placements, plan.arrays.inertia);
    const ptrdiff_t action = @take_step@data, &plan, joints, motion_state, next_motion_state, state, t);
    if (full || action == CONTROLLER_INVALID) {
        memset(dq, 0, sizeof(double) * CONTROLLER_DOF);
        return CONTROLLER_INVALID;
    }
    memcpy(dq, log.dq.data, sizeof(double) * CONTROLLER_DOF);
    memcpy(c->motion_state, c->next_motion_state, sizeof c->motion_state);
    c->steps[0] += 1.0;
    return (int)action;
}
@target_function@
