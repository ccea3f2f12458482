
void controller_target(struct controller *c, double t, double *target)
{
    bool full = false;
    struct arena arena = controller_arena(c, &full);
    const control_step_StepPlan plan = controller_plan(c);
    const Matrix targets = {target, CONTROLLER_FRAMES, 18};
    @sample@&plan.arrays, t - c->past[@delay@ * CONTROLLER_DOF], targets);
}
