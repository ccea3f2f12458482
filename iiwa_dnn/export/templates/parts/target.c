
void controller_target(struct controller *c, double t, double *target)
{
    CONTROLLER_ARENA;
    const control_plan_ControlPlan plan = controller_plan(c);
    const Matrix targets = {target, CONTROLLER_FRAMES, 18};
    @sample@&plan.paths, t - controller_path_lag(c), CONTROLLER_DT, targets);
}
