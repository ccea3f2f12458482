/* Velocity controller of the robot @robot@, made by iiwa_dnn @version@ from its own kernels.
 *
 * C99 and libm's elementary functions alone. Every function states the file that it is translated
 * from. Programs have @n@ variables, @m@ inequality rows, @p@ equality rows. In this order stand:
 *
 * - Types and constants of the functions
 * - Tables: limits, gains, capsules and lengths
@map@
 * - Interface: what the header declares
 *
 * A struct whose first member is `numbers` is a record, an array of numbers by their names: `at` has
 * the first ones, the other members are arrays within it. `X_of` views an array as a record X.
 */
#include "controller.h"

@code@

/* ---- Interface ---- */

@interface@

/* What a step is laid out with; tables, and the kinematics in the controller. */
static inline control_plan_ControlPlan controller_plan(struct controller *c)
{
    (void)c;
    const control_plan_ControlPlan plan = @plan@;
    return plan;
}

static inline control_state_MotionState controller_motion(const struct controller *c)
{
    const Vector numbers = {(double *)c->motion_state, @motion@};
    return control_state_MotionState_of(numbers, CONTROLLER_DOF, @pairs@);
}

static inline control_command_StepLog controller_log(const struct controller *c)
{
    const control_plan_ControlPlan plan = controller_plan((struct controller *)c);
    const Vector numbers = {(double *)c->log, @width@};
    return @log_of@numbers, &plan.arrays.sizes);
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

void controller_halt(struct controller *c)
{
    controller_motion(c).at->halts = 1.0;
}

void controller_send(struct controller *c, const double *dq, double fraction)
{
    const control_state_MotionState motion = controller_motion(c);
    const Vector sent = {(double *)dq, CONTROLLER_DOF};
    @count_as_sent@&motion, sent, CONTROLLER_DT);
    motion.at->path_lag += CONTROLLER_DT * (1.0 - fraction);
    c->steps[0] += 1.0;
}

int controller_step(struct controller *c, const double *q, const double *target, double *dq)
{
    CONTROLLER_ARENA;
    const control_plan_ControlPlan plan = controller_plan(c);
    const robot_kinematics_kernel_ModelTables model = @model@;
    const control_command_StepLog log = controller_log(c);
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
    @write_kinematics@&model, joints, plan.arrays.jacobian, plan.arrays.placements, plan.arrays.inertia);
    const ptrdiff_t action =
        @take_step@log.numbers, &plan, joints, motion_state, next_motion_state, state, t);
    if (full || action == CONTROLLER_INVALID) {
        memset(dq, 0, sizeof(double) * CONTROLLER_DOF);
        return CONTROLLER_INVALID;
    }
    memcpy(dq, log.dq.data, sizeof(double) * CONTROLLER_DOF);
    memcpy(c->motion_state, c->next_motion_state, sizeof c->motion_state);
    c->steps[0] += 1.0;
    c->action[0] = (double)action;
    return (int)action;
}
@target_function@
const double *controller_next_q(const struct controller *c)
{
    return controller_log(c).next_q.data;
}

double controller_fraction(const struct controller *c)
{
    return controller_log(c).at->fraction;
}

double controller_path_lag(const struct controller *c)
{
    return controller_motion(c).at->path_lag;
}

int controller_program(const struct controller *c)
{
    return (int)controller_log(c).at->kind;
}

int controller_active_limits(const struct controller *c, int *codes)
{
    const int count = controller_codes(controller_log(c).limiting, codes);
    if (count == 0 && controller_program(c) == CONTROLLER_RELAXED) {
        codes[0] = CONTROLLER_SINGULAR;
        return 1;
    }
    return count;
}

const char *controller_action_name(int action)
{
    static const char *const names[] = {@action_names@};
    return action >= 0 && action < @action_count@ ? names[action] : "invalid";
}
