
/* Write the targets (18 CONTROLLER_FRAMES) of the reference at time t [s], less the delay of the path's clock. */
CONTROLLER_API void controller_target(struct controller *c, double t, double *target);

