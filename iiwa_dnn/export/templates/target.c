
void controller_target(struct controller *c, double t, double *target)
{
    const struct program_arrays arrays = controller_arrays(c);
    sample_targets(&arrays, t - c->delay, target);
}
