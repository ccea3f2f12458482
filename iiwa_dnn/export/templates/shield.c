
int shield_step(struct controller *c, const double *q, const double *wish, double *dq)
{
@arena@    const Vector settings = @settings@;
    const Vector limits = @limits@;
    const schemes_limits_Periods periods = @periods@;
    const Vector joints = {(double *)q, CONTROLLER_DOF};
    const Vector asked = {wish ? (double *)wish : c->wish, CONTROLLER_DOF};
    const Vector aim = {c->aim, CONTROLLER_DOF};
    const Matrix past = {c->past, @rows@, CONTROLLER_DOF};
    const control_shield_ShieldState kept = {
        {c->positions, CONTROLLER_DOF}, {c->wish, CONTROLLER_DOF}, {c->flags, @flags@}
    };
    if (!controller_is_finite(q, CONTROLLER_DOF)) {
        memset(dq, 0, sizeof(double) * CONTROLLER_DOF);
        return CONTROLLER_INVALID;
    }
    @take_positions@joints, &kept, settings);
    const bool held = @take_wish@asked, wish != NULL, &kept, settings);
    @come_nearer@&kept, past, limits, &periods, false, held, aim);
    memset(c->state, 0, sizeof c->state);
    memcpy(c->state, c->aim, sizeof c->wish);
    const int action = controller_step(c, c->positions, c->aim, dq);
    c->past[@yields@ * CONTROLLER_DOF] = 0.0;
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        c->positions[i] += CONTROLLER_DT * dq[i];
    }
    return action;
}

void shield_halt(struct controller *c)
{
    c->flags[@reason@] = @halted@;
}
