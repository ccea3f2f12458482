/* Velocity controller of the robot @robot@, made by iiwa_dnn @version@ from its own compiled code.
 *
 * All angles in rad, lengths in m, times in s. See README.md beside this file.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#ifdef __cplusplus
extern "C" {
#endif

#ifndef CONTROLLER_API
#define CONTROLLER_API
#endif

#define CONTROLLER_DOF @dof@           /* joints: @joint_names@ */
#define CONTROLLER_FRAMES @frames@        /* tracked frames: @frame_names@ */
#define CONTROLLER_DT @dt@         /* control period [s] */
#define CONTROLLER_SIZE @size@      /* bytes of struct controller */
#define CONTROLLER_LIMITS @limit_count@    /* codes of limits */
#define CONTROLLER_DIGEST "@digest@" /* of the code and its tables */

/* Actions that controller_step returns. */
enum controller_action {
    CONTROLLER_INVALID = -1, /* q or target is not finite: dq is zero, the state stays */
@actions@
};

/* Code among the active limits of a relaxed program that no limit is active in; further codes are bounds and rows. */
#define CONTROLLER_SINGULAR 1

/* Programs that a step answers. */
enum controller_program {
@programs@
};

/* All memory of a controller; its fields are the controller's own. Copies are controllers of their own. */
struct controller {
@fields@
};

/* Begin at rest, or anew: commands, a halt and the delay of the path's clock are forgotten. */
CONTROLLER_API void controller_init(struct controller *c);

/* Brake at every step from now on, until controller_init. */
CONTROLLER_API void controller_halt(struct controller *c);

/* Count a velocity dq (CONTROLLER_DOF) as sent for a period, in place of a step's command; the path's clock goes
 * on by a fraction of the period, from 0 to 1, which is not checked; neither is dq. */
CONTROLLER_API void controller_send(struct controller *c, const double *dq, double fraction);

/* Compute the command dq (CONTROLLER_DOF) [rad/s] for measured joint positions q [rad].
 *
 * The target has 18 numbers a frame: position (3) [m], rotation row by row (9), linear velocity (3)
 * [m/s] and angular velocity (3) [rad/s], along the axes of the robot's base. Returns 0 if the
 * command does all that the tasks ask, else an action.
 */
CONTROLLER_API int controller_step(struct controller *c, const double *q, const double *target, double *dq);
@target_declaration@
/* Joint positions at the end of the last command's period (CONTROLLER_DOF). */
CONTROLLER_API const double *controller_next_q(const struct controller *c);

/* Fraction of the last period by which the path's clock went on, in [0, 1]. */
CONTROLLER_API double controller_fraction(const struct controller *c);

/* Time by which the path's clock is behind [s]. */
CONTROLLER_API double controller_path_lag(const struct controller *c);

/* Program that the last step answered, of enum controller_program. */
CONTROLLER_API int controller_program(const struct controller *c);

/* Write codes (CONTROLLER_LIMITS) of what keeps the last command from the tasks; return their number. */
CONTROLLER_API int controller_active_limits(const struct controller *c, int *codes);

/* Name a reason, a joint's bound or a row by its code. */
CONTROLLER_API const char *controller_limit_name(int code);

/* Name an action. */
CONTROLLER_API const char *controller_action_name(int action);

/* CONTROLLER_DIGEST of the compiled code. */
CONTROLLER_API const char *controller_digest(void);

#ifdef __cplusplus
}
#endif

#endif
