
/* Compute the safe command dq (CONTROLLER_DOF) [rad/s] for a request [rad/s], each CONTROLLER_DT seconds.
 *
 * Without a new request (NULL) the last one counts, for @timeout@ s. Without any, or if it is not
 * finite, the arm brakes and stays. Returns an action, as controller_step does.
 */
int shield_step(struct controller *c, const double *q, const double *request, double *dq);

/* Brake from now on, whatever is requested. */
void shield_halt(struct controller *c);
