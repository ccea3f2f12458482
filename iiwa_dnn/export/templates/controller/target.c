
void controller_target(struct controller *c, double t, double *target)
{
    bool full = false;
    struct arena arena = controller_arena(c, &full);
    const control_cycle_ControlPlan plan = controller_plan(c);
    const Matrix targets = {target, CONTROLLER_FRAMES, 18};
    const Vector numbers = {c->motion_state, @motion@};
    const control_state_MotionState motion = control_state_MotionState_of(numbers, CONTROLLER_DOF, @pairs@);
    @sample@&plan.paths, t - motion.at->path_lag, CONTROLLER_DT, targets);
}
