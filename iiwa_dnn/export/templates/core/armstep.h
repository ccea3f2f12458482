/* armstep: the joint velocities of one control step, within limits, for shields and controllers of any arm.
 *
 * Made by iiwa_dnn @version@ from its own kernels: one library for all arms. An arm is its tables, numbers and
 * integers that an export writes as C or as JSON. All memory is the caller's; there is no global state, no
 * allocation, no recursion. Sizes are in doubles, angles in rad, lengths in m, times in s.
 */
#ifndef ARMSTEP_H
#define ARMSTEP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef ARMSTEP_API
#define ARMSTEP_API
#endif

enum {
    ARMSTEP_RELEASE = @release@, /* of the layout of tables */
    ARMSTEP_TARGET = 18, /* numbers of a target: position, rotation row by row, linear and angular velocity */
    ARMSTEP_FASTEST = @fastest@, /* largest velocity that counts as sent [rad/s] */
    ARMSTEP_LONGEST = 1000, /* longest period that a step states, or a command is sent for [s] */
    ARMSTEP_SAVED = 2 /* doubles that a saved arm has beside its memory */
};

/* What tables are of. */
enum armstep_kind {
    ARMSTEP_SHIELD = 1, /* any request for a motion in, the command closest to it that keeps every limit out */
    ARMSTEP_CONTROLLER = 2 /* targets of frames in, the command that its scheme answers */
};

enum armstep_status {
    ARMSTEP_OK = 0,
    ARMSTEP_OTHER_RELEASE, /* tables of another release */
    ARMSTEP_DAMAGED, /* tables, or a saved arm, whose numbers have another digest */
    ARMSTEP_UNFIT, /* tables whose sizes or indices do not belong together */
    ARMSTEP_ARITHMETIC, /* NaN, subnormal numbers or products are not those of IEEE 754 */
    ARMSTEP_OTHER_TABLES, /* memory that was not begun, or belongs to other tables */
    ARMSTEP_WRONG_KIND, /* what a shield alone has, or a controller */
    ARMSTEP_NOT_FINITE /* an argument */
};

/* Kinds of a shield's request. */
enum armstep_request {
@requests@
};

/* Reasons beside limits for another command than is asked: results of a shield's step, and codes of active limits,
 * whose words armstep_limit_name has. */
enum armstep_reason {
    ARMSTEP_INVALID = -1, /* the step is refused; of a controller too */
@reasons@
};

/* Results of a controller's step: 0 if the command does all that the tasks ask. */
enum armstep_action {
@actions@
};

/* Programs that a controller's step answers. */
enum armstep_program {
@programs@
};

/* Kinds of parts. */
enum armstep_entry {
@entries@
};

/* Parts that tables name. Their numbers change from release to release. */
enum armstep_part {
@parts@
    ARMSTEP_PARTS, /* from here on: parts of a user's own */
};

/* A part of a user's own, translated beside its tables. */
struct armstep_own {
    const char *name;
    enum armstep_entry entry;
    void (*function)(void);
};

/* An arm's tables: constant, shared by any number of arms and threads. */
struct armstep_tables {
    uint64_t digest; /* of numbers, integers and names of parts */
    int release; /* ARMSTEP_RELEASE */
    enum armstep_kind kind;
    const char *name;
    const char *const *joint_names; /* (joints) */
    ptrdiff_t joints;
    const char *const *frame_names; /* (frames): of a shield's twists, or of a controller's targets */
    ptrdiff_t frames;
    const char *const *obstacle_names; /* (obstacles): those that armstep_place moves */
    ptrdiff_t obstacles;
    const char *const *limit_names; /* (limits), by the codes of armstep_active_limits */
    ptrdiff_t limits;
    ptrdiff_t first_row; /* code of the first row */
    const double *lower, *upper, *velocity, *acceleration, *jerk; /* what commands keep, (joints) each; INFINITY: none */
    double dt; /* control period */
    double longest; /* longest one where periods vary; 0: they do not */
    double delay; /* time by which a shield's arm is behind its commands */
    ptrdiff_t memory; /* doubles of an arm */
    ptrdiff_t scratch; /* doubles that a call takes for itself */
    const double *numbers;
    ptrdiff_t number_count;
    const ptrdiff_t *integers;
    ptrdiff_t integer_count;
    const ptrdiff_t *parts; /* places of the integers that number parts */
    ptrdiff_t part_count;
    const struct armstep_own *own; /* the user's own parts, or NULL */
    ptrdiff_t own_count;
};

/* Tables laid out for steps of any number of arms; not changed after armstep_load. */
struct armstep {
    const struct armstep_tables *tables;
    double laid_out[@laid_out@];
};

/* Read tables, which have to outlast `arm`; check this machine's arithmetic and all that they say of themselves. */
ARMSTEP_API enum armstep_status armstep_load(struct armstep *arm, const struct armstep_tables *tables);

/* Begin an arm in `memory` (tables->memory), at rest where the first step measures it, with the obstacles where
 * the tables say. `scratch` (tables->scratch) keeps nothing between calls: arms of one thread may share it. */
ARMSTEP_API void armstep_begin(const struct armstep *arm, double *memory, double *scratch);

/* Stand at q (joints), or at what is measured next (NULL). Requests, commands and a halt are forgotten. */
ARMSTEP_API enum armstep_status armstep_rest(
    const struct armstep *arm, double *memory, double *scratch, const double *q
);

/* Brake at every step from now on, whatever is asked, until armstep_rest. */
ARMSTEP_API enum armstep_status armstep_halt(const struct armstep *arm, double *memory);

/* Let a shield's requests use a part of the joints' velocity limits, from 0 (rest) to 1, until the next call. */
ARMSTEP_API enum armstep_status armstep_scale_speed(const struct armstep *arm, double *memory, double scale);

/* Count dq (joints) as sent for a period above 0, in place of a step's command. The clock of a controller's
 * reference goes on by a fraction of it, from 0 to 1. Limits are not checked, but ARMSTEP_FASTEST. */
ARMSTEP_API enum armstep_status armstep_send(
    const struct armstep *arm, double *memory, const double *dq, double period, double fraction
);

/* Say where the centres of the obstacles are at the end of the last step, (obstacles, 3). If one is not finite, all stay where they are, and
 * the arm brakes until they are placed again. */
ARMSTEP_API enum armstep_status armstep_place(const struct armstep *arm, double *memory, const double *centers);

/* Say where all people in an arm's field are, as a sensor saw them `age` ago: both ends and the radius, with the error
 * of the place, of `count` capsules. 0 of them is nobody in the field. What has no meaning (numbers that are not finite,
 * too many, older than the last frame) is ARMSTEP_NOT_FINITE and no frame: all bodies grow older, and the arm comes to
 * rest by itself. */
ARMSTEP_API enum armstep_status armstep_people(
    const struct armstep *arm, double *memory, const double capsules[][7], ptrdiff_t count, double age
);

/* Say where one body with a speed is, by its number among those with a name: half-extents, axes one a row, center
 * (15). ARMSTEP_WRONG_KIND: there is none of this number. */
ARMSTEP_API enum armstep_status armstep_body(
    const struct armstep *arm, double *memory, ptrdiff_t number, const double *box, double age
);

/* What a chunk of samples keeps where they are too quick: their times, or their path, later. A stream of single samples
 * is continued beyond the last one by ARMSTEP_STREAM plus 0, 1 or 2 samples: the arm is 2, 1 or 0 of them late. */
enum armstep_mode { ARMSTEP_KEEP_TIME = 0, ARMSTEP_KEEP_PATH = 1, ARMSTEP_STREAM = 2 };

/* Let a shield's arm follow `count` joint positions (count, joints) from their times on, which rise: those of a chunk on
 * the arm's clock (armstep_time), of a stream on any. Steps then need no request; another one ends it. A new chunk
 * replaces the rest of the last from its first time on, and ends at rest. ARMSTEP_NOT_FINITE: times do not rise, or
 * there are more samples than the tables have room for. Numbers that are not finite brake the arm. */
ARMSTEP_API enum armstep_status armstep_follow(
    const struct armstep *arm, double *memory, const double *times, const double *positions, ptrdiff_t count, int mode
);

/* What a step is given. Fields that are left out are zero. */
struct armstep_input {
    const double *q; /* measured joint positions (joints); NULL: they could not be read, and the arm brakes */
    int kind; /* of a shield's request, enum armstep_request */
    const double *request; /* joint velocities or positions (joints), a twist (6): linear, then angular velocity;
                            * or a controller's targets (frames, 18). NULL: no new one; those of the reference */
    double t; /* time of a controller's reference and obstacles */
    double dt; /* period for which the command will be held; 0: not stated */
    double elapsed; /* or the time since the last step; needs tables->longest; both at least 1e-9, at most 1e3 */
};

/* Compute the command dq (joints) [rad/s], and advance the arm by it.
 *
 * Returns the first reason of a shield, or the action of a controller. Without a new request a shield's last one
 * counts, until it is too old. An argument without a meaning is a shield's reason. ARMSTEP_INVALID: an argument of a
 * controller has no meaning, or a user's own part takes more than the scratch. The command is then the next one of the
 * motion to rest, never a jump. For memory that was not begun, or is of other tables, dq is 0.
 */
ARMSTEP_API int armstep_step(
    const struct armstep *arm, double *memory, double *scratch, const struct armstep_input *input, double *dq
);

/* Steps of many arms: arrays with a row for each. */
struct armstep_batch {
    double *memory; /* of the first arm */
    ptrdiff_t stride; /* from one arm's to the next */
    struct armstep_input input; /* of the first arm; requests have 6 numbers for twists, else (joints); targets (frames, 18) */
    const bool *given; /* which arms have a new request, or targets; NULL: all */
    double *dq, *next_q; /* (joints) */
    bool *clipped;
    int *reasons; /* results of armstep_step */
};

/* Take the steps of the arms `first` to `last` - 1 of a batch; threads take ranges and scratch of their own.
 * Returns the number of those that were refused. */
ARMSTEP_API ptrdiff_t armstep_steps(
    const struct armstep *arm, const struct armstep_batch *batch, double *scratch, ptrdiff_t first, ptrdiff_t last
);

/* Write the targets (frames, 18) of a controller's reference at time t, less the lag of the path. */
ARMSTEP_API enum armstep_status armstep_targets(
    const struct armstep *arm, const double *memory, double *scratch, double t, double *targets
);

/* Copy an arm, with digests, into `saved` (tables->memory + ARMSTEP_SAVED); take it back, if it is one of these
 * tables and undamaged. It then goes on from the command after which it was saved: an arm that has moved or braked
 * since then is to be begun anew. */
ARMSTEP_API enum armstep_status armstep_save(const struct armstep *arm, const double *memory, double *saved);
ARMSTEP_API enum armstep_status armstep_restore(const struct armstep *arm, double *memory, const double *saved);

/* Of the last step of an arm that has begun: */

/* joint positions at the end of its period (joints); */
ARMSTEP_API const double *armstep_next_q(const struct armstep *arm, const double *memory);

/* whether its command is another one than the request, or than the tasks ask; */
ARMSTEP_API bool armstep_is_clipped(const struct armstep *arm, const double *memory);

/* codes (limits) of what keeps it from that, and their number; */
ARMSTEP_API int armstep_active_limits(const struct armstep *arm, const double *memory, int *codes);

/* distances of a shield where it begins, of a joint from its position limits and of the nearest pair less the
 * least one, INFINITY where none is watched; */
ARMSTEP_API enum armstep_status armstep_margin(
    const struct armstep *arm, const double *memory, double *scratch, double *joint, double *distance
);

/* the time of the next step on the clock of chunks; */
ARMSTEP_API double armstep_time(const struct armstep *arm, const double *memory);

/* the time by which the clock of a chunk is behind, and the positions (joints) that are followed, at the end of the
 * period; NULL: nothing is followed; */
ARMSTEP_API const double *armstep_followed(const struct armstep *arm, const double *memory, double *late);

/* the axes, one a row, and the position (12) of the frame of a shield's twists at joint positions q (joints), and
 * its Jacobian, linear over angular (6, joints); */
ARMSTEP_API enum armstep_status armstep_frame(
    const struct armstep *arm, double *scratch, const double *q, double *placement, double *jacobian
);

/* the least separation of an arm's links from people, less the one to keep, INFINITY without; */
ARMSTEP_API double armstep_separation(const struct armstep *arm, const double *memory, double *scratch);

/* the least part of a torque limit that its command leaves, with either payload, INFINITY without; */
ARMSTEP_API double armstep_torque(const struct armstep *arm, const double *memory, double *scratch);

/* time of a shield's motion to rest from its command; */
ARMSTEP_API double armstep_stopping_time(const struct armstep *arm, const double *memory, double *scratch);

/* the program that a controller answered, the fraction of the period by which its path's clock goes on, and the
 * time by which that is behind. */
ARMSTEP_API enum armstep_program armstep_program_of(const struct armstep *arm, const double *memory);
ARMSTEP_API double armstep_fraction(const struct armstep *arm, const double *memory);
ARMSTEP_API double armstep_path_lag(const struct armstep *arm, const double *memory);

/* Name a reason or a limit by its code; an action; a part by its number, "" for none; and find a part by its name, 0 for none. */
ARMSTEP_API const char *armstep_limit_name(const struct armstep_tables *tables, int code);
ARMSTEP_API const char *armstep_action_name(int action);
ARMSTEP_API const char *armstep_part_name(const struct armstep_tables *tables, ptrdiff_t number);
ARMSTEP_API int armstep_part_number(const struct armstep_tables *tables, const char *name);

/* Digest of numbers, integers and names of parts, FNV-1a of 64 bits. */
ARMSTEP_API uint64_t armstep_digest(const struct armstep_tables *tables);

#ifdef __cplusplus
}
#endif

#endif
