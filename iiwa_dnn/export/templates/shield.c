
int shield_step(struct controller *c, const double *q, const double *request, double *dq)
{
@arena@    const control_shield_ShieldSettings settings = @settings@;
    const schemes_limits_MotionNumbers limits = @limits@;
    const schemes_limits_Periods periods = @periods@;
    const Vector joints = {(double *)q, CONTROLLER_DOF};
    const Vector asked = {request ? (double *)request : c->request, CONTROLLER_DOF};
    const Vector aim = {c->aim, CONTROLLER_DOF};
    const Vector numbers = {c->motion_state, @motion@};
    const control_state_MotionState motion = control_state_MotionState_of(numbers, CONTROLLER_DOF, @pairs@);
    const Vector flags = {c->flags, @flags@};
    const control_shield_ShieldState kept = {
        {c->positions, CONTROLLER_DOF}, {c->request, CONTROLLER_DOF}, control_shield_Flags_of(flags)
    };
    if (!controller_is_finite(q, CONTROLLER_DOF)) {
        memset(dq, 0, sizeof(double) * CONTROLLER_DOF);
        return CONTROLLER_INVALID;
    }
    const bool repeated = @take_request@joints, asked, request != NULL, &kept, &settings);
    @come_nearer@&kept, motion.last, motion.before, &limits, &periods, false, repeated, aim);
    memset(c->state, 0, sizeof c->state);
    memcpy(c->state, c->aim, sizeof c->request);
    const int action = controller_step(c, c->positions, c->aim, dq);
    motion.at->yields = 0.0;
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        c->positions[i] += CONTROLLER_DT * dq[i];
    }
    return action;
}

void shield_halt(struct controller *c)
{
    const Vector flags = {c->flags, @flags@};
    control_shield_Flags_of(flags).at->reason = control_shield_Reason_HALTED;
}
