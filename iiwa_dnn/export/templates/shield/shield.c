/* Shield of the robot @robot@, made by iiwa_dnn @version@ from its own kernels.
 *
 * C99 and the elementary functions of a freestanding libm alone. Every function states the file that
 * it is translated from. Programs have @n@ variables and @m@ inequality rows. In this order stand:
 *
 * - Types and constants of the functions
 * - Tables: limits, gains, capsules and lengths
@map@
 * - Interface: what the header declares
 *
 * A struct whose first member is `numbers` is a record, an array of numbers by their names: `at` has
 * the first ones, the other members are arrays within it. `X_of` views an array as a record X.
 *
 * Compile it with -ffp-contract=off, and every compiler gives the same commands, to the last bit.
 */
#include "shield.h"

@code@

/* ---- Interface ---- */

@interface@

/* What a step is laid out with: tables. */
static inline control_arms_ArmPlan shield_plan(void)
{
    const control_arms_ArmPlan plan = @plan@;
    return plan;
}

static const double shield_places[] = {@places@};

static inline Vector shield_memory(const struct shield *s)
{
    const Vector memory = {(double *)s->memory, @state@};
    return memory;
}

static inline control_arms_ArmState shield_state(const struct shield *s)
{
    const control_arms_ArmPlan plan = shield_plan();
    return @arm_state@&plan, shield_memory(s));
}

void shield_init(struct shield *s)
{
    memset(s, 0, sizeof *s);
    shield_place(s, shield_places);
    shield_reset(s, NULL);
}

void shield_reset(struct shield *s, const double *q)
{
    SHIELD_ARENA;
    const control_arms_ArmPlan plan = shield_plan();
    const Vector joints = {(double *)q, q ? SHIELD_JOINTS : 0};
    @rest_arm@&plan, shield_memory(s), joints);
}

void shield_halt(struct shield *s)
{
    const control_arms_ArmPlan plan = shield_plan();
    @halt_arm@&plan, shield_memory(s));
}

void shield_place(struct shield *s, const double *centers)
{
    const control_arms_ArmPlan plan = shield_plan();
    const Matrix places = {(double *)centers, SHIELD_OBSTACLES, 3};
    @place_arm@&plan, shield_memory(s), places);
}

void shield_send(struct shield *s, const double *dq, double period)
{
    const control_arms_ArmPlan plan = shield_plan();
    const Vector sent = {(double *)dq, SHIELD_JOINTS};
    @send_arm@&plan, shield_memory(s), sent, period);
}

int shield_step(struct shield *s, const struct shield_input *given, double *dq)
{
    SHIELD_ARENA;
    const control_arms_ArmPlan plan = shield_plan();
    const struct shield before = *s;
    const control_arms_ArmInput input = {
        {(double *)given->q, SHIELD_JOINTS},
        given->request ? (int)given->kind : SHIELD_REQUEST_NONE,
        {(double *)given->request, given->kind == SHIELD_REQUEST_TWIST ? 6 : SHIELD_JOINTS},
        given->dt,
        given->elapsed,
    };
    const ptrdiff_t reason = @step_arm@&plan, shield_memory(s), &input);
    if (full || reason == SHIELD_INVALID) {
        *s = before;
        memset(dq, 0, SHIELD_JOINTS * sizeof *dq);
        return SHIELD_INVALID;
    }
    const control_arms_ArmState state = shield_state(s);
    memcpy(dq, @motion_of@&plan, &state).last.data, SHIELD_JOINTS * sizeof *dq);
    return (int)reason;
}

int shield_steps(
    struct shield *arms, ptrdiff_t count, ptrdiff_t *next, const struct shield_input *first,
    const bool *given, double *dq, double *next_q, bool *clipped, int *reasons
)
{
    const ptrdiff_t width = first->kind == SHIELD_REQUEST_TWIST ? 6 : SHIELD_JOINTS;
    int found = 0;
    for (;;) {
        const ptrdiff_t begin = __atomic_fetch_add(next, 8, __ATOMIC_RELAXED);
        for (ptrdiff_t k = begin; k < begin + 8 && k < count; k++) {
            struct shield_input own = *first;
            own.q += k * SHIELD_JOINTS;
            own.request = first->request && (!given || given[k]) ? first->request + k * width : NULL;
            reasons[k] = shield_step(arms + k, &own, dq + k * SHIELD_JOINTS);
            found = reasons[k] == SHIELD_INVALID ? SHIELD_INVALID : found;
            memcpy(next_q + k * SHIELD_JOINTS, shield_next_q(arms + k), SHIELD_JOINTS * sizeof *dq);
            clipped[k] = shield_is_clipped(arms + k);
        }
        if (begin + 8 >= count) {
            return found;
        }
    }
}

const double *shield_next_q(const struct shield *s)
{
    return shield_state(s).positions.data;
}

bool shield_is_clipped(const struct shield *s)
{
    return shield_state(s).at->is_clipped != 0.0;
}

int shield_active_limits(const struct shield *s, int *codes)
{
    const control_arms_ArmState state = shield_state(s);
    int count = 0;
    if (!shield_is_clipped(s)) {
        return 0;
    }
    for (int k = 0; k < state.reasons.size0; k++) {
        if (state.reasons.data[k] != 0.0) {
            codes[count++] = k;
        }
    }
    return count + shield_codes(state.limiting, codes + count);
}

void shield_margin(const struct shield *s, double *joint, double *distance)
{
    SHIELD_ARENA;
    const control_arms_ArmPlan plan = shield_plan();
    const double_2 found = @margin_of@&plan, shield_memory(s));
    *joint = found.at[0];
    *distance = found.at[1];
}

double shield_stopping_time(const struct shield *s)
{
    const control_arms_ArmPlan plan = shield_plan();
    return @stopping_time_of@&plan, shield_memory(s));
}
