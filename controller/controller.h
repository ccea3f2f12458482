/* Velocity controller of the robot iiwa7, made by iiwa_dnn 0.1.0 from its own compiled code.
 *
 * All angles in rad, lengths in m, times in s. See README.md beside this file.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#ifdef __cplusplus
extern "C" {
#endif

#define CONTROLLER_DOF 7           /* joints */
#define CONTROLLER_FRAMES 1        /* tracked frames: iiwa7_flange */
#define CONTROLLER_DT 0.001         /* control period [s] */
#define CONTROLLER_SYSTEMS 1600    /* linear systems of a step, at most */
#define CONTROLLER_SIZE 15304      /* bytes of struct controller */

/* Actions that controller_step returns. */
#define CONTROLLER_NONE 0
#define CONTROLLER_SLOW 2
#define CONTROLLER_RELAX 3
#define CONTROLLER_STOP 4
#define CONTROLLER_EULER 5
#define CONTROLLER_INVALID -1      /* q or target is not finite: dq is zero, nothing else changes */

/* All memory of a controller; its fields are the controller's own. */
struct controller {
    double row[226];
    double past[56];
    double following[56];
    double state[27];
    double relaxed[57];
    double jacobian[42];
    double placements[216];
    double steps[1];
    double scratch[1232];
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

/* Write the targets (18 CONTROLLER_FRAMES) of the reference at time t [s].
 *
 * The reference: {"iiwa7_flange": {"name": "heart", "scale": 0.00345, "period": 10.0}}.
 */
void controller_target(struct controller *c, double t, double *target);

#ifdef __cplusplus
}
#endif

#endif
