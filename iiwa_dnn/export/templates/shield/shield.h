/* Shield of the robot @robot@, made by iiwa_dnn @version@ from its own kernels: any request for a
 * motion in, the command closest to it that keeps every limit out.
 *
 * All angles in rad, lengths in m, times in s. See README.md beside this file.
 */
#ifndef SHIELD_H
#define SHIELD_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef SHIELD_API
#define SHIELD_API
#endif

#define SHIELD_JOINTS @dof@            /* joints: @joint_names@ */
#define SHIELD_FRAME "@frame@"         /* frame of twists */
#define SHIELD_DT @dt@                 /* control period [s] */
#define SHIELD_LONGEST_PERIOD @longest@ /* longest one where periods vary [s]; 0: they do not */
#define SHIELD_DELAY @delay@           /* time by which the arm is behind its commands [s] */
#define SHIELD_OBSTACLES @obstacles@   /* obstacles: @obstacle_names@ */
#define SHIELD_LIMITS @limit_count@    /* codes of reasons and limits */
#define SHIELD_DIGEST "@digest@"       /* of the code and its tables */

/* Kinds of a request. */
enum shield_request {
@requests@
};

/* Reasons beside limits for another command than the request; those to rest come first. */
enum shield_reason {
    SHIELD_INVALID = -1, /* a period is invalid: nothing is changed, dq is 0 whatever the limits */
@reasons@
};

/* All memory of an arm. Copies are arms of their own. */
struct shield {
    double memory[@memory@];
};

/* What a step is given. Fields that are left out are zero: no new request, no stated period. */
struct shield_input {
    const double *q;          /* measured joint positions (SHIELD_JOINTS) */
    enum shield_request kind;
    const double *request;    /* (SHIELD_JOINTS) or, for a twist, (6): linear, then angular velocity */
    double dt;                /* period for which the command will be held */
    double elapsed;           /* or the time since the last step; needs SHIELD_LONGEST_PERIOD */
};

/* Begin, with the obstacles where they were when the code was made. */
SHIELD_API void shield_init(struct shield *s);

/* Stand at q (SHIELD_JOINTS), or at what is measured next (NULL). Requests and a halt are forgotten. */
SHIELD_API void shield_reset(struct shield *s, const double *q);

/* Brake from now on, whatever is requested, until shield_reset. */
SHIELD_API void shield_halt(struct shield *s);

/* Say where the obstacles' centres are (3 SHIELD_OBSTACLES). */
SHIELD_API void shield_place(struct shield *s, const double *centers);

/* Count a velocity dq (SHIELD_JOINTS) as sent for a period above 0, in place of a step's command;
 * neither is checked. */
SHIELD_API void shield_send(struct shield *s, const double *dq, double period);

/* Compute the command dq (SHIELD_JOINTS) [rad/s]; return the first reason beside limits.
 *
 * Without a new request the last one counts, for @timeout@ s. Without any the arm brakes and stays.
 */
SHIELD_API int shield_step(struct shield *s, const struct shield_input *given, double *dq);

/* Take steps of `count` arms, in blocks: threads that share `next`, 0 at first, share the arms.
 *
 * q, dq and next_q are (count, SHIELD_JOINTS), requests (count, SHIELD_JOINTS) or (count, 6). `given`
 * (count) says which arms have a new request; NULL: all. Returns SHIELD_INVALID or 0.
 */
SHIELD_API int shield_steps(
    struct shield *arms, ptrdiff_t count, ptrdiff_t *next, const struct shield_input *first,
    const bool *given, double *dq, double *next_q, bool *clipped, int *reasons
);

/* Joint positions at the end of the last command's period (SHIELD_JOINTS). */
SHIELD_API const double *shield_next_q(const struct shield *s);

/* Whether the last command was another one than the request. */
SHIELD_API bool shield_is_clipped(const struct shield *s);

/* Write codes (SHIELD_LIMITS) of what keeps the last command from the request; return their number. */
SHIELD_API int shield_active_limits(const struct shield *s, int *codes);

/* Name a reason, a joint's bound or a row by its code. */
SHIELD_API const char *shield_limit_name(int code);

/* Distances where the last command begins: of a joint from its position limits [rad], and of the
 * nearest pair less the least one [m], INFINITY where none is watched. */
SHIELD_API void shield_margin(const struct shield *s, double *joint, double *distance);

/* Time of the motion to rest from the last command [s]. */
SHIELD_API double shield_stopping_time(const struct shield *s);

/* SHIELD_DIGEST of the compiled code. */
SHIELD_API const char *shield_digest(void);

#ifdef __cplusplus
}
#endif

#endif
