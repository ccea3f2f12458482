/* Velocity controller of the robot @robot@, made by iiwa_dnn @version@ from its own compiled code.
 *
 * All angles in rad, lengths in m, times in s. See README.md beside this file.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#ifdef __cplusplus
extern "C" {
#endif

#define CONTROLLER_DOF @dof@           /* joints */
#define CONTROLLER_FRAMES @frames@        /* tracked frames: @frame_names@ */
#define CONTROLLER_DT @dt@         /* control period [s] */
#define CONTROLLER_SIZE @size@      /* bytes of struct controller */

/* Actions that controller_step returns. */
@actions@
#define CONTROLLER_INVALID -1      /* q or target is not finite: dq is zero, nothing else changes */

/* All memory of a controller; its fields are the controller's own. */
struct controller {
@fields@
};

/* Begin at rest. */
void controller_init(struct controller *c);

/* Compute the command dq (CONTROLLER_DOF) [rad/s] for measured joint positions q [rad].
 *
 * The target has 18 numbers a frame: position (3) [m], rotation row by row (9), linear velocity (3)
 * [m/s] and angular velocity (3) [rad/s], along the axes of the robot's base. Returns 0 if the
 * command does all that the tasks ask, else an action.
 */
int controller_step(struct controller *c, const double *q, const double *target, double *dq);
@target_declaration@
#ifdef __cplusplus
}
#endif

#endif
