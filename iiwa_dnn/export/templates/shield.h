
/* Compute the safe command dq (CONTROLLER_DOF) [rad/s] for a wish [rad/s], each CONTROLLER_DT seconds.
 *
 * Without a new wish (NULL) the last one counts, for @timeout@ s. Without any, or if it is not
 * finite, the arm brakes and stays. Returns an action, as controller_step does.
 */
int shield_step(struct controller *c, const double *q, const double *wish, double *dq);

/* Brake from now on, whatever is wished for. */
void shield_halt(struct controller *c);
