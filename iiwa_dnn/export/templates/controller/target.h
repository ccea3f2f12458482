
/* Write the targets (18 CONTROLLER_FRAMES) of the reference at time t [s]. */
void controller_target(struct controller *c, double t, double *target);
