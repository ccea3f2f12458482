/* Written by iiwa_dnn.compiling from the package's kernels. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#define NPY_NO_DEPRECATED_API NPY_1_7_API_VERSION
#include <numpy/arrayobject.h>

/* What kernels share: arrays, Python's arithmetic, and what a kernel does with its arena. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct { double *data; int64_t size0; } Vector;
typedef struct { double *data; int64_t size0, size1; } Matrix;
typedef struct { int64_t *data; int64_t size0; } IntVector;
typedef struct { int64_t *data; int64_t size0, size1; } IntMatrix;

/* min and max return the first of equal numbers, and the first beside a NaN, as Python's do.
 * Quotient and remainder are rounded down. A float beyond all integers becomes the last of them. */

static inline double double_min(double a, double b) { return b < a ? b : a; }

static inline double double_max(double a, double b) { return b > a ? b : a; }

static inline int64_t int_min(int64_t a, int64_t b) { return b < a ? b : a; }

static inline int64_t int_max(int64_t a, int64_t b) { return b > a ? b : a; }

static inline int64_t int_quotient(int64_t a, int64_t b)
{
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

static inline int64_t int_remainder(int64_t a, int64_t b)
{
    return a % b + ((a % b != 0 && (a < 0) != (b < 0)) ? b : 0);
}

static inline int64_t int_of(double a)
{
    if (!(a < (double)INT64_MAX)) return INT64_MAX;
    return a > (double)INT64_MIN ? (int64_t)a : INT64_MIN;
}

static inline int64_t int_floor(double a) { return int_of(floor(a)); }

static inline int64_t int_ceil(double a) { return int_of(ceil(a)); }

static inline double double_remainder(double a, double b)
{
    const double left = fmod(a, b);
    if (left == 0.0) return copysign(0.0, b);
    return (left < 0.0) != (b < 0.0) ? left + b : left;
}

struct arena;
static inline void *arena_empty(struct arena *arena, int64_t count);

static inline void *arena_zeros(struct arena *arena, int64_t count)
{
    return memset(arena_empty(arena, count), 0, 8 * (size_t)count);
}

static inline void *arena_copy(struct arena *arena, const void *from, int64_t count)
{
    return memcpy(arena_empty(arena, count), from, 8 * (size_t)count);
}

#include <stdlib.h>

/* A kernel takes memory from an arena and gives it back where it returns. What does not fit comes
 * from the heap. */
struct block { struct block *next; };
struct arena { char *top, *end; struct block *blocks; };

static void *arena_more(struct arena *arena, size_t bytes)
{
    struct block *block = malloc(64 + bytes);
    if (!block) abort();
    block->next = arena->blocks;
    arena->blocks = block;
    return (char *)block + 64;
}

static inline void *arena_empty(struct arena *arena, int64_t count)
{
    const size_t bytes = (8 * (size_t)count + 15) & ~(size_t)15;
    if ((size_t)(arena->end - arena->top) < bytes) return arena_more(arena, bytes);
    arena->top += bytes;
    return arena->top - bytes;
}

static void arena_free(struct arena *arena, const struct block *last)
{
    while (arena->blocks != last) {
        struct block *block = arena->blocks;
        arena->blocks = block->next;
        free(block);
    }
}

static inline void arena_leave(struct arena *arena, const struct arena *mark)
{
    if (arena->blocks != mark->blocks) arena_free(arena, mark->blocks);
    arena->top = mark->top;
}



typedef struct { double at[2]; } double_2;

typedef struct {
    double time; /* Time since the arm's first step [s]. */
    double period; /* Time for which the last command is held [s]. */
    double age; /* Time since the last request came [s]. */
    double reason; /* `Reason` for which the request is replaced by zero velocity; `NONE`: it counts. */
    double kind; /* `Request` of the last request. */
    /* `Request` that the last step answered; `NONE`: the positions are not known, and no step was taken. */
    double answered;
    double has_begun; /* Whether joint positions are known. */
    double is_repeated; /* Whether the request is that of the step before. */
    double is_clipped; /* Whether the last command differs from the request. */
} control_arms_ArmState_numbers;

/* State of an arm between steps, with the results of the last step. */
typedef struct {
    Vector numbers;
    control_arms_ArmState_numbers *at;
    Vector positions; /* Commanded joint positions [rad], (n,). */
    Vector request; /* The request that counts, (max(n, 6),); zero without one. */
    Vector reasons; /* 1 for each `Reason` of the last step, else 0. */
    Vector motion; /* `MotionState`. */
    Vector network; /* State of the network that answers twists. */
    Vector fallback; /* States of the networks of fallback programs, for requests of joints. */
    Vector twist_fallback; /* The same for twists. */
    Matrix obstacles; /* Centres that the obstacles had, or would have had, at time 0 [m], (k, 3). */
    Vector limiting; /* Active bounds and rows of the last step, as in `StepLog`, (n + m,). */
    /* A `SentCommand` for each command of the last `delay` seconds, the last first, (k (1 + n),). */
    Vector sent;
} control_arms_ArmState;

static inline control_arms_ArmState control_arms_ArmState_of(Vector numbers, int64_t n, int64_t request, int64_t motion, int64_t network, int64_t fallback, int64_t obstacles, int64_t limiting, int64_t sent)
{
    const control_arms_ArmState own = {
        numbers,
        (control_arms_ArmState_numbers *)numbers.data,
        {numbers.data + 9, n},
        {numbers.data + 9 + n, request},
        {numbers.data + 9 + n + request, 10},
        {numbers.data + 19 + n + request, motion},
        {numbers.data + 19 + n + request + motion, network},
        {numbers.data + 19 + n + request + motion + network, fallback},
        {numbers.data + 19 + n + request + motion + network + fallback, fallback},
        {numbers.data + 19 + n + request + motion + network + 2 * fallback, obstacles, 3},
        {numbers.data + 19 + n + request + motion + network + 2 * fallback + 3 * obstacles, limiting},
        {numbers.data + 19 + n + request + motion + network + 2 * fallback + 3 * obstacles + limiting, sent}
    };
    return own;
}

/* Tables of a robot of n joints, each of which turns about its z axis or slides along it. */
typedef struct {
    IntVector parents; /* For each joint the number of the one that carries it, from 1; 0: the world, (n,). */
    Matrix joints; /* `Placement` of each joint at 0 in the frame of its parent, (n, 12). */
    Vector slides; /* 1 for a joint that slides, 0 for one that turns, (n,). */
    IntVector frames; /* For each frame its row among the placements, (k,). */
    IntVector carriers; /* For each frame the joint that carries it, (k,). */
    Matrix offsets; /* `Placement` of each frame in its joint's, (k, 12). */
    Matrix bodies; /* `PrincipalAxes` of what each joint carries, (n, 18); none without the inertia matrix. */
    Matrix supports; /* 1 where joint j moves body i, else 0, (n, n); none with them. */
    Vector armature; /* Inertia of the motors [kg m^2], (n,). */
} robot_kinematics_kernel_ModelTables;

/* Sizes of a scheme's programs, of the robot and of its targets. */
typedef struct {
    int64_t n; /* Number of variables. */
    int64_t m; /* Number of inequality rows. */
    int64_t p; /* Number of equality rows. */
    int64_t joints; /* Number of joints. */
    int64_t pairs; /* Number of watched pairs. */
    int64_t frames; /* Number of tracked frames. */
} schemes_program_ProgramSizes;

/* Arrays from which `assemble` writes programs; it changes none of them. */
typedef struct {
    schemes_program_ProgramSizes sizes; /* Sizes of the programs. */
    IntMatrix table; /* A row for each part, (parts, 7), by `Column`. */
    Vector constants; /* Constants of all parts, (k,). */
    Matrix jacobian; /* `Kinematics.jacobian`, (dof, 6). */
    Matrix placements; /* `Kinematics.placements`, (frames, 12). */
    Matrix support; /* `Robot.support`, (frames, dof). */
    Matrix inertia; /* `Kinematics.inertia`, (dof, dof). */
    int64_t tip; /* Index of the first tracked frame. */
} schemes_program_ProgramArrays;

typedef struct {
    double tolerance; /* Tolerance of the residuals. */
    double budget; /* Largest number of linear solves. */
    double duration; /* Time to advance [rho]; 0 to solve. */
    double substeps; /* Number of explicit sub-steps; 0 for as many as stability needs. */
} networks_integrators_base_AnswerSettings_numbers;

/* Settings of a compiled answer. */
typedef struct {
    Vector numbers;
    networks_integrators_base_AnswerSettings_numbers *at;
    Vector network; /* Constants of the network, (k,). */
} networks_integrators_base_AnswerSettings;

static inline networks_integrators_base_AnswerSettings networks_integrators_base_AnswerSettings_of(Vector numbers, int64_t constants)
{
    const networks_integrators_base_AnswerSettings own = {
        numbers,
        (networks_integrators_base_AnswerSettings_numbers *)numbers.data,
        {numbers.data + 4, constants}
    };
    return own;
}

/* A compiled function that solves programs of one shape or advances a network on them. */
typedef struct {
    int64_t address; /* Address of a function of the type `enter_answer`. */
    int64_t rates; /* Address of the network's compiled function. */
    networks_integrators_base_AnswerSettings settings; /* Its settings. */
} networks_integrators_base_CompiledAnswer;

/* Compiled paths of the tracked frames. */
typedef struct {
    IntMatrix table; /* A row for each of k paths, (k, 4), with the columns of `PathColumn`. */
    Vector constants; /* Base target and constants of each path, one path after another, (size,). */
} control_cycle_Paths;

typedef struct {
    double dt; /* Period by which a change of the command is divided for its acceleration [s]. */
    double hold; /* Longest time for which the command may be held [s]. */
    double longest; /* Longest period of a later step [s]. */
    double fraction; /* Factor for distances to position limits. */
} schemes_rate_limits_MotionConstants_numbers;

/* Constants of `MotionLimits` for n joints, as its kernel reads them. */
typedef struct {
    Vector numbers;
    schemes_rate_limits_MotionConstants_numbers *at;
    /* Lower position limits [rad], (n,); of a joint with a position-dependent velocity limit, the position at
     * which that is zero. */
    Vector lower;
    Vector upper; /* Upper position limits [rad], (n,), in the same way. */
    Vector velocity; /* Largest velocities [rad/s], (n,); inf for none, as for all others. */
    Vector acceleration; /* Largest accelerations [rad/s^2], (n,). */
    Vector jerk; /* Largest jerks [rad/s^3], (n,). */
    Vector deceleration; /* Decelerations with which the joints brake before position limits [rad/s^2], (n,). */
    Vector slope; /* Deceleration D of each position-dependent velocity limit [rad/s^2], (n,). */
    Vector lag; /* Offset o of each position-dependent velocity limit over D [s], (n,). */
} schemes_rate_limits_MotionConstants;

static inline schemes_rate_limits_MotionConstants schemes_rate_limits_MotionConstants_of(Vector numbers, int64_t n)
{
    const schemes_rate_limits_MotionConstants own = {
        numbers,
        (schemes_rate_limits_MotionConstants_numbers *)numbers.data,
        {numbers.data + 4, n},
        {numbers.data + 4 + n, n},
        {numbers.data + 4 + 2 * n, n},
        {numbers.data + 4 + 3 * n, n},
        {numbers.data + 4 + 4 * n, n},
        {numbers.data + 4 + 5 * n, n},
        {numbers.data + 4 + 6 * n, n},
        {numbers.data + 4 + 7 * n, n}
    };
    return own;
}

/* Constants of the fallback programs and stopping motions of a scheme. */
typedef struct {
    Vector weights; /* Weight of each equality row, (p,); 0 for a row of coupled joints. */
    /* Limits of the joints on a stopping motion; for no joints if the scheme has neither acceleration nor jerk
     * limits. */
    schemes_rate_limits_MotionConstants limits;
    double tolerance; /* Tolerance of the residuals of an answer. */
    int64_t rates; /* Index of the scheme's part with acceleration and jerk limits; -1 if it has none. */
    IntVector scenes; /* Indices of the scheme's parts that avoid collisions, (scenes,). */
    bool cubic; /* Whether the jerk of a joint is limited. */
    bool coupled; /* Whether joints are coupled by a hard `JointCouplingTask`. */
    bool alike; /* Whether the network of the nominal program is compiled, as for fallback programs. */
} control_fallback_Yielding;

/* Periods for which the bounds of a step are computed. */
typedef struct {
    double dt; /* Period by which a change of the command is divided for its acceleration [s]. */
    double expected; /* Time for which the command is expected to be held [s]. */
    double hold; /* Longest time for which it may be held [s]. */
    double longest; /* Longest period of a later step [s]. */
    /* Factor for distances to position limits: dt / T where periods are not stated but may last T, else 1. */
    double fraction;
    bool vary; /* Whether periods differ from step to step. */
    bool exceeded; /* Whether the stated period is above the longest. */
} schemes_periods_Periods;

/* Constants, settings and work arrays of a control step, as compiled code reads them. */
typedef struct {
    schemes_program_ProgramArrays arrays; /* Arrays from which the nominal program is assembled. */
    /* Function that answers the nominal program, with its settings. */
    networks_integrators_base_CompiledAnswer network;
    control_cycle_Paths paths; /* Paths of the tracked frames. */
    control_fallback_Yielding yielding; /* Constants of the fallback programs and stopping motions. */
    /* Network states of the fallback programs, (`fallback_size`,), their warm starts; changed by steps. */
    Vector fallback;
    int64_t policy; /* Action of the policy at a step without a solution; `BRAKE` in continuous mode. */
    bool samples; /* Whether a step samples its targets from `paths`; else they are in its log. */
    schemes_periods_Periods timing; /* Periods of the step. */
} control_cycle_ControlPlan;

typedef struct {
    double dt; /* Control period [s]. */
    double longest; /* Longest control period where periods vary [s]; 0: they are constant. */
    double timeout; /* Age above which a request no longer counts [s]. */
    /* Difference of measured and commanded positions above which the arm is resynchronised to the measured ones
     * [rad]. */
    double tracking_error;
    double delay; /* Time by which the arm is behind its commands [s]. */
} control_arms_ArmSettings_numbers;

/* Settings of a shield. */
typedef struct {
    Vector numbers;
    control_arms_ArmSettings_numbers *at;
} control_arms_ArmSettings;

static inline control_arms_ArmSettings control_arms_ArmSettings_of(Vector numbers)
{
    const control_arms_ArmSettings own = {
        numbers,
        (control_arms_ArmSettings_numbers *)numbers.data
    };
    return own;
}

/* Sizes of the parts of `ArmState`, in the order of their names there. */
typedef struct {
    int64_t n;
    int64_t request;
    int64_t motion;
    int64_t network;
    int64_t fallback;
    int64_t obstacles;
    int64_t limiting;
    int64_t sent;
} control_arms_ArmSizes;

/* Layout and settings of the steps of a shield's arms. */
typedef struct {
    robot_kinematics_kernel_ModelTables robot; /* Tables of the robot, n joints. */
    control_cycle_ControlPlan step; /* Layout of the control step. */
    int64_t request; /* Number of the program's block that holds the request. */
    int64_t scene; /* Number of the program's block that holds the watched pairs; -1: none are watched. */
    int64_t width; /* Length of the log of a step. */
    schemes_rate_limits_MotionConstants motion; /* Limits of the joints' motion. */
    double fastest; /* Largest entry of a twist [m/s], [rad/s]; a larger twist is scaled down to it. */
    Vector lower; /* Lower position limits [rad], (n,). */
    Vector upper; /* Upper position limits [rad], (n,). */
    Matrix velocities; /* Velocities of the obstacles [m/s], (k, 3). */
    control_arms_ArmSettings settings; /* Settings of the shield. */
    control_arms_ArmSizes sizes; /* Sizes of `ArmState`. */
} control_arms_ArmPlan;

typedef struct {
    /* Control periods that the stored stopping motion takes from the last command to rest; 0 if no stopping
     * motion is stored. */
    double stopping_periods;
    double path_lag; /* Time by which the reference's clock is behind the time of the loop [s]. */
    /* Period by which `last` - `before` is divided for the acceleration [s]; 0 before the first step. */
    double spacing;
    double yields; /* Whether a policy replaced the nominal program at the last step. */
    double halts; /* Whether the arm brakes at this step, even if the nominal program has a solution. */
} control_state_MotionState_numbers;

/* State of the motion of n joints, kept from one control step to the next. */
typedef struct {
    Vector numbers;
    control_state_MotionState_numbers *at;
    Vector q; /* Joint positions of the step [rad], (n,). */
    Vector last; /* Last command [rad/s], (n,). */
    Vector before; /* Command before the last one [rad/s], (n,). */
    Vector wanted; /* Answer of the last fallback program, before rate limits [rad/s], (n,). */
    Vector least; /* Distance that each watched pair has to keep [m], (pairs,); 0 before the first step. */
} control_state_MotionState;

static inline control_state_MotionState control_state_MotionState_of(Vector numbers, int64_t joints, int64_t pairs)
{
    const control_state_MotionState own = {
        numbers,
        (control_state_MotionState_numbers *)numbers.data,
        {numbers.data + 5, joints},
        {numbers.data + 5 + joints, joints},
        {numbers.data + 5 + 2 * joints, joints},
        {numbers.data + 5 + 3 * joints, joints},
        {numbers.data + 5 + 4 * joints, pairs}
    };
    return own;
}

/* Reasons, other than limits, for a command that differs from the request. */
typedef enum {
    control_requests_Reason_NONE = 0,
    control_requests_Reason_NO_REQUEST = 1,
    control_requests_Reason_TIMED_OUT = 2,
    control_requests_Reason_NOT_FINITE = 3,
    control_requests_Reason_HALTED = 4,
    control_requests_Reason_Q_NOT_FINITE = 5,
    control_requests_Reason_RESYNCHRONISED = 6,
    control_requests_Reason_CUT = 7,
    control_requests_Reason_PERIOD_EXCEEDED = 8,
    control_requests_Reason_SINGULAR = 9,
} control_requests_Reason;

typedef struct {
    double period; /* Time for which the command is held [s]; 0: no command was sent. */
} control_arms_SentCommand_numbers;

/* Command that was sent to n joints, and may not show in the measured positions yet. */
typedef struct {
    Vector numbers;
    control_arms_SentCommand_numbers *at;
    Vector dq; /* Joint velocity [rad/s], (n,). */
} control_arms_SentCommand;

static inline control_arms_SentCommand control_arms_SentCommand_of(Vector numbers, int64_t n)
{
    const control_arms_SentCommand own = {
        numbers,
        (control_arms_SentCommand_numbers *)numbers.data,
        {numbers.data + 1, n}
    };
    return own;
}

/* Inputs of a step. */
typedef struct {
    Vector q; /* Measured joint positions [rad], (n,). */
    int64_t kind; /* Kind of the new request; `Request.NONE`: there is none. */
    Vector request; /* Numbers of the new request, at least (n,) or (6,). */
    double dt; /* Period for which the command will be held [s]; 0: not stated. */
    double elapsed; /* Time since the last step [s]; 0: not stated. */
} control_arms_ArmInput;

/* Kinds of a request: the quantity that it states. */
typedef enum {
    control_requests_Request_NONE = 0,
    control_requests_Request_VELOCITY = 1,
    control_requests_Request_TWIST = 2,
    control_requests_Request_POSITION = 3,
} control_requests_Request;

/* Placement of a frame in the world: its three axes, then its position [m]. */
typedef struct {
    Vector numbers;
    Matrix axes;
    Vector position;
} robot_kinematics_Placement;

static inline robot_kinematics_Placement robot_kinematics_Placement_of(Vector numbers)
{
    const robot_kinematics_Placement own = {
        numbers,
        {numbers.data, 3, 3},
        {numbers.data + 9, 3}
    };
    return own;
}

/* Linear velocity of the world's origin, and angular velocity, along the world's axes. */
typedef struct {
    Vector numbers;
    Vector linear;
    Vector angular;
} robot_kinematics_Twist;

static inline robot_kinematics_Twist robot_kinematics_Twist_of(Vector numbers)
{
    const robot_kinematics_Twist own = {
        numbers,
        {numbers.data, 3},
        {numbers.data + 3, 3}
    };
    return own;
}

/* Placement of a body's principal axes in the frame of its joint, and roots of its inertia. */
typedef struct {
    Vector numbers;
    robot_kinematics_Placement placement;
    Vector roots;
} robot_kinematics_kernel_PrincipalAxes;

static inline robot_kinematics_kernel_PrincipalAxes robot_kinematics_kernel_PrincipalAxes_of(Vector numbers)
{
    const robot_kinematics_kernel_PrincipalAxes own = {
        numbers,
        robot_kinematics_Placement_of((Vector){numbers.data, 12}),
        {numbers.data + 12, 6}
    };
    return own;
}

typedef struct {
    double least; /* Least distance [m]. */
    double gain; /* Largest rate at which a distance shrinks towards it [1/s]. */
    double bodies; /* Number of bodies. */
    double pairs; /* Number of pairs. */
    double pair_size; /* Length of a `Pair`. */
    double first; /* Index of the first pair of this scene among those of all scenes of a scheme. */
} schemes_scene_SceneHead_numbers;

/* First constants of a scene: its settings, and the sizes of the tables that follow. */
typedef struct {
    Vector numbers;
    schemes_scene_SceneHead_numbers *at;
} schemes_scene_SceneHead;

static inline schemes_scene_SceneHead schemes_scene_SceneHead_of(Vector numbers)
{
    const schemes_scene_SceneHead own = {
        numbers,
        (schemes_scene_SceneHead_numbers *)numbers.data
    };
    return own;
}

/* Constants of a scene of b bodies and k pairs, as views. */
typedef struct {
    schemes_scene_SceneHead head; /* Settings of the scene. */
    Vector dq_max; /* Velocity limits of the joints [rad/s], (n,). */
    Matrix bodies; /* A `Body` in each row, (b, 17). */
    Matrix pairs; /* A `Pair` in each row, (k, 3 + 2 n). */
} schemes_scene_SceneViews;

typedef struct {
    double frame; /* Index of the frame; 0 is the world. */
    double radius; /* Radius by which the box is grown [m]. */
    double speed; /* Speed [m/s]. */
} schemes_scene_Body_numbers;

/* A box with a radius, in a frame of the robot. */
typedef struct {
    Vector numbers;
    schemes_scene_Body_numbers *at;
    Vector half; /* Half-extents [m]; a segment lies along the third axis. */
    Matrix axes; /* The box's axes in the frame, one a row. */
    Vector center; /* Its centre in the frame [m]. */
} schemes_scene_Body;

static inline schemes_scene_Body schemes_scene_Body_of(Vector numbers)
{
    const schemes_scene_Body own = {
        numbers,
        (schemes_scene_Body_numbers *)numbers.data,
        {numbers.data + 3, 3},
        {numbers.data + 6, 3, 3},
        {numbers.data + 15, 3}
    };
    return own;
}

/* Columns of the table of parts. */
typedef enum {
    schemes_program_Column_KIND = 0,
    schemes_program_Column_ADDRESS = 1,
    schemes_program_Column_FIRST = 2,
    schemes_program_Column_ROWS = 3,
    schemes_program_Column_START = 4,
    schemes_program_Column_STOP = 5,
    schemes_program_Column_TARGET = 6,
} schemes_program_Column;

typedef struct {
    double iterations; /* Linear solves, or steps taken. */
    double time; /* Network time that passed [rho]. */
    double primal; /* Primal residual. */
    double dual; /* Dual residual. */
    double gap; /* Duality gap. */
} networks_integrators_base_SolveStats_numbers;

/* Statistics of a solve. */
typedef struct {
    Vector numbers;
    networks_integrators_base_SolveStats_numbers *at;
} networks_integrators_base_SolveStats;

static inline networks_integrators_base_SolveStats networks_integrators_base_SolveStats_of(Vector numbers)
{
    const networks_integrators_base_SolveStats own = {
        numbers,
        (networks_integrators_base_SolveStats_numbers *)numbers.data
    };
    return own;
}

typedef struct {
    double fraction; /* Fraction of the period by which the reference's clock advances. */
    double status; /* Index of the answer's status in `STATUSES`. */
    double kind; /* `ProgramKind` of the program that was answered. */
} control_command_StepLog_numbers;

/* Log of one control step of dof joints. */
typedef struct {
    Vector numbers;
    control_command_StepLog_numbers *at;
    networks_integrators_base_SolveStats stats; /* Iterations, network time and residuals of the answer. */
    Vector placement; /* Placement of the first tracked frame, (12,). */
    Vector q; /* Joint positions at which the program was built [rad], (dof,). */
    Vector last; /* Command of the step before [rad/s], (dof,). */
    Vector before; /* Command of the step before `last` [rad/s], (dof,). */
    Vector dq; /* Command of this step [rad/s], (dof,). */
    Vector next_q; /* Joint positions at the end of the period, q + dt dq [rad], (dof,). */
    /* Lower bounds of the nominal program [rad/s], (dof,). If a fallback program was answered, its bounds may
     * be wider. */
    Vector lower;
    Vector upper; /* Upper bounds of the nominal program [rad/s], (dof,). */
    Vector lower_kind; /* `LimitKind` of each lower bound of `program`, (dof,). */
    Vector upper_kind; /* `LimitKind` of each upper bound of `program`, (dof,). */
    Vector program; /* The program that was answered, `QP.data`, (size,). */
    Vector point; /* The primal-dual answer, `Solution.point`, (2 n + m + p,). */
    /* For each variable the `LimitKind` of the bound that limits it, negative for a lower bound, or 0; then for
     * each inequality row 1 if it limits, else 0, (n + m,). */
    Vector limiting;
    Vector least; /* Distance that each watched pair has to keep [m], (pairs,), as in `MotionState`. */
    Matrix targets; /* Targets of the tracked frames, (k, 18). */
} control_command_StepLog;

static inline control_command_StepLog control_command_StepLog_of(Vector numbers, int64_t joints, int64_t program, int64_t point, int64_t sides, int64_t pairs, int64_t frames)
{
    const control_command_StepLog own = {
        numbers,
        (control_command_StepLog_numbers *)numbers.data,
        networks_integrators_base_SolveStats_of((Vector){numbers.data + 3, 5}),
        {numbers.data + 8, 12},
        {numbers.data + 20, joints},
        {numbers.data + 20 + joints, joints},
        {numbers.data + 20 + 2 * joints, joints},
        {numbers.data + 20 + 3 * joints, joints},
        {numbers.data + 20 + 4 * joints, joints},
        {numbers.data + 20 + 5 * joints, joints},
        {numbers.data + 20 + 6 * joints, joints},
        {numbers.data + 20 + 7 * joints, joints},
        {numbers.data + 20 + 8 * joints, joints},
        {numbers.data + 20 + 9 * joints, program},
        {numbers.data + 20 + 9 * joints + program, point},
        {numbers.data + 20 + 9 * joints + program + point, sides},
        {numbers.data + 20 + 9 * joints + program + point + sides, pairs},
        {numbers.data + 20 + 9 * joints + program + point + sides + pairs, frames, 18}
    };
    return own;
}

typedef struct { int64_t at[6]; } int_6;

typedef struct {
    double frame; /* Index of the frame whose twist is requested. */
    double is_twist; /* Whether the request is a twist; else it is joint velocities. */
} control_requests_RequestConstants_numbers;

/* Request of a step as the constants of its cost. */
typedef struct {
    Vector numbers;
    control_requests_RequestConstants_numbers *at;
    Vector velocity; /* The requested joint velocities [rad/s] or twist [m/s], [rad/s], (max(n, 6),). */
} control_requests_RequestConstants;

static inline control_requests_RequestConstants control_requests_RequestConstants_of(Vector numbers, int64_t request)
{
    const control_requests_RequestConstants own = {
        numbers,
        (control_requests_RequestConstants_numbers *)numbers.data,
        {numbers.data + 2, request}
    };
    return own;
}

/* Limits of one joint on the derivatives of its position; inf for none. */
typedef struct {
    double velocity; /* Largest velocity [rad/s]. */
    double acceleration; /* Largest acceleration [rad/s^2]. */
    double jerk; /* Largest jerk [rad/s^3]. */
    double deceleration; /* Deceleration with which the joint brakes before its position limits [rad/s^2]. */
    double slope; /* Deceleration D of the position-dependent velocity limit [rad/s^2]. */
    double lag; /* Offset o of that limit, divided by D [s]; 0 for a joint without such a limit. */
} schemes_profiles_Rates;

typedef struct { double at[4]; } double_4;

typedef struct { double at[3]; } double_3;

/* Kinds of limits that bound a joint's velocity; their codes in commands and records. */
typedef enum {
    naming_LimitKind_POSITION = 1,
    naming_LimitKind_VELOCITY = 2,
    naming_LimitKind_ACCELERATION = 3,
    naming_LimitKind_JERK = 4,
    naming_LimitKind_POSITION_DEPENDENT_VELOCITY = 5,
    naming_LimitKind_OTHER = 6,
} naming_LimitKind;

/* Columns of `Paths.table`: function address, feed-forward flag, slice of the constants. */
typedef enum {
    control_cycle_PathColumn_ADDRESS = 0,
    control_cycle_PathColumn_FEED_FORWARD = 1,
    control_cycle_PathColumn_START = 2,
    control_cycle_PathColumn_STOP = 3,
} control_cycle_PathColumn;

/* Desired pose and twist of a frame along the world's axes, as compiled code reads them. */
typedef struct {
    Vector numbers;
    Vector position;
    Matrix rotation;
    Vector linear_velocity;
    Vector angular_velocity;
} references_targets_TargetData;

static inline references_targets_TargetData references_targets_TargetData_of(Vector numbers)
{
    const references_targets_TargetData own = {
        numbers,
        {numbers.data, 3},
        {numbers.data + 3, 3, 3},
        {numbers.data + 12, 3},
        {numbers.data + 15, 3}
    };
    return own;
}

/* One instant of a control loop of n joints, as the kernels of parts read it. */
typedef struct {
    double t; /* Time [s]. */
    double rate; /* Inverse of the control period [1/s]; inf outside of a loop. */
    Vector q; /* Joint positions [rad], (n,). */
    Vector last; /* Last command [rad/s], (n,). */
    Vector before; /* Command before the last one [rad/s], (n,). */
    Matrix jacobian; /* Joint Jacobian, `Kinematics.jacobian`, (n, 6). */
    Matrix placements; /* Frame placements by frame index, `Kinematics.placements`, (frames, 12). */
    Matrix support; /* 1 where a joint moves a frame, else 0, `Robot.support`, (frames, n). */
    Matrix inertia; /* Joint-space inertia matrix [kg m^2], (n, n), current if a cost needs it. */
    Matrix targets; /* Targets of the tracked frames, `Target.data` each, (k, 18). */
    /* Distance that each watched pair has to keep [m], (pairs,), updated by `CollisionAvoidance`
     * (`collisions.kept_distance`). */
    Vector least;
    /* `LimitKind` of each joint's lower bound, (n,). Where a kernel tightens a bound and writes no kind, the
     * bound goes by the name of its limit. */
    Vector lower_kind;
    Vector upper_kind; /* The same for the upper bounds, (n,). */
} schemes_step_StepViews;

/* The eight parts of a program of n variables, m inequality and p equality rows, as views. */
typedef struct {
    Matrix P; /* Cost matrix, (n, n). */
    Vector q; /* Cost vector, (n,). */
    Matrix G; /* Inequality rows, (m, n). */
    Vector h; /* Inequality right-hand side, (m,). */
    Matrix A; /* Equality rows, (p, n). */
    Vector b; /* Equality right-hand side, (p,). */
    Vector lb; /* Lower bounds, (n,). */
    Vector ub; /* Upper bounds, (n,). */
} qp_layout_QPViews;

typedef struct { int64_t at[4]; } int_4;

/* Kinds of parts, in the order of the rows of the table. */
typedef enum {
    schemes_program_BlockKind_COST = 0,
    schemes_program_BlockKind_TASK = 1,
    schemes_program_BlockKind_SOFT_TASK = 2,
    schemes_program_BlockKind_LIMIT = 3,
} schemes_program_BlockKind;

typedef struct { double at[5]; } double_5;

/* Motion of n joints to rest, all at once (see the module). */
typedef struct {
    Vector first; /* Velocities x_0 at the start [rad/s], (n,). */
    Vector coefficient; /* Coefficients b of the cubics [rad/s], (n,); 0 if velocities are linear in time. */
    double periods; /* Number M of control periods until rest. */
    bool cubic; /* Whether the velocities are cubic in time, else linear. */
    bool varies; /* Whether control periods may be shorter than the longest one. */
    bool skips; /* Whether a velocity may be held for no time at all. */
} control_stopping_Motion;

/* Nearest points of a pair. */
typedef struct {
    double_3 second; /* Nearest point on the segment of the second body, without its radius [m], (3,). */
    /* Unit normal from the first to the second body, (3,); zero where the first one is a segment or a point and
     * touches the segment. */
    double_3 normal;
    double distance; /* Distance of the bodies with their radii [m], negative where they overlap. */
} schemes_scene_Contact;

typedef struct {
    double second; /* Index of the second body, a segment. */
    double first; /* Index of the first body, any box. */
    double unmoved_end; /* 1 or 2 for the end of the segment that no joint moves along the normal, else 0. */
} schemes_scene_Pair_numbers;

/* Two bodies that may meet, of a robot with n joints. */
typedef struct {
    Vector numbers;
    schemes_scene_Pair_numbers *at;
    /* For each joint 1 if it moves the second body alone, -1 if it moves the first alone, else 0, (n,). */
    Vector support;
    /* For each joint the largest distance of the second body from its axis [m], -1 for a prismatic joint, 0 for
     * one that moves neither alone, (n,). */
    Vector radii;
} schemes_scene_Pair;

static inline schemes_scene_Pair schemes_scene_Pair_of(Vector numbers, int64_t n)
{
    const schemes_scene_Pair own = {
        numbers,
        (schemes_scene_Pair_numbers *)numbers.data,
        {numbers.data + 3, n},
        {numbers.data + 3 + n, n}
    };
    return own;
}

typedef struct { double_3 at[2]; } double_3_2;

/* Condensed matrix of a program with R = p + m + 2n rows [A; G; I; -I], and scratch. */
typedef struct {
    Vector active; /* 1 for each row that is active, as equalities are, else 0, (R,). */
    Vector counted; /* 1 for each row of [A; G] whose product is in `gram`, (p + m,). */
    Matrix gram; /* Products of the counted rows, (n, n). */
    Matrix K; /* Upper half of the condensed matrix, or its factor, (n, n). */
    Vector values; /* Values of all rows, (R,). */
    Vector spans; /* Where the entries of the rows of G are (`write_spans`), (2m,). */
} networks_integrators_implicit_steps_Condensed;

typedef struct { int64_t at[3]; } int_3;

typedef struct {
    double projects;
} networks_projection_ProjectionConstants_numbers;

/* Constant of a projection network: whether x is projected on its bounds. */
typedef struct {
    Vector numbers;
    networks_projection_ProjectionConstants_numbers *at;
} networks_projection_ProjectionConstants;

static inline networks_projection_ProjectionConstants networks_projection_ProjectionConstants_of(Vector numbers)
{
    const networks_projection_ProjectionConstants own = {
        numbers,
        (networks_projection_ProjectionConstants_numbers *)numbers.data
    };
    return own;
}

typedef struct {
    double scale;
    double rate;
} references_shapes_HeartConstants_numbers;

/* Scale [m] and angular rate [rad/s] of a heart. */
typedef struct {
    Vector numbers;
    references_shapes_HeartConstants_numbers *at;
} references_shapes_HeartConstants;

static inline references_shapes_HeartConstants references_shapes_HeartConstants_of(Vector numbers)
{
    const references_shapes_HeartConstants own = {
        numbers,
        (references_shapes_HeartConstants_numbers *)numbers.data
    };
    return own;
}

typedef struct {
    double begin; /* Length of the soft start [s]. */
} references_shapes_LissajousConstants_numbers;

/* Constants of a path that is a sine and a cosine on each axis. */
typedef struct {
    Vector numbers;
    references_shapes_LissajousConstants_numbers *at;
    Vector rates; /* Angular rates [rad/s]. */
    Vector sines; /* Amplitudes of the sines [m]. */
    Vector cosines; /* Amplitudes of the cosines [m]. */
} references_shapes_LissajousConstants;

static inline references_shapes_LissajousConstants references_shapes_LissajousConstants_of(Vector numbers)
{
    const references_shapes_LissajousConstants own = {
        numbers,
        (references_shapes_LissajousConstants_numbers *)numbers.data,
        {numbers.data + 1, 3},
        {numbers.data + 4, 3},
        {numbers.data + 7, 3}
    };
    return own;
}

typedef struct {
    double begin;
    double angle;
    double rate;
} references_turning_ConeConstants_numbers;

/* Soft start [s], angle [rad] and angular rate [rad/s] of a cone. */
typedef struct {
    Vector numbers;
    references_turning_ConeConstants_numbers *at;
} references_turning_ConeConstants;

static inline references_turning_ConeConstants references_turning_ConeConstants_of(Vector numbers)
{
    const references_turning_ConeConstants own = {
        numbers,
        (references_turning_ConeConstants_numbers *)numbers.data
    };
    return own;
}

typedef struct {
    double along;
    double begin;
    double angle;
    double rate;
} references_turning_TiltingConstants_numbers;

/* Path (`Along`), soft start [s], and angle [rad], rate [rad/s] and axis of the tilt. */
typedef struct {
    Vector numbers;
    references_turning_TiltingConstants_numbers *at;
    Vector axis;
} references_turning_TiltingConstants;

static inline references_turning_TiltingConstants references_turning_TiltingConstants_of(Vector numbers)
{
    const references_turning_TiltingConstants own = {
        numbers,
        (references_turning_TiltingConstants_numbers *)numbers.data,
        {numbers.data + 4, 3}
    };
    return own;
}

/* Functions of the paths that a tool can tilt along. */
typedef enum {
    references_turning_Along_FIXED = 0,
    references_turning_Along_HEART = 1,
    references_turning_Along_LISSAJOUS = 2,
    references_turning_Along_WAYPOINTS = 3,
} references_turning_Along;

typedef struct {
    double period;
    double duration;
} references_waypoints_WaypointsConstants_numbers;

/* Period [s], inf for an open path, and duration [s], before the pieces one after another. */
typedef struct {
    Vector numbers;
    references_waypoints_WaypointsConstants_numbers *at;
    Vector pieces;
} references_waypoints_WaypointsConstants;

static inline references_waypoints_WaypointsConstants references_waypoints_WaypointsConstants_of(Vector numbers, int64_t pieces)
{
    const references_waypoints_WaypointsConstants own = {
        numbers,
        (references_waypoints_WaypointsConstants_numbers *)numbers.data,
        {numbers.data + 2, pieces}
    };
    return own;
}

typedef struct {
    double start;
} references_waypoints_Piece_numbers;

/* Start of a piece [s], and coefficients of its cubics, each of `PoseNumbers`. */
typedef struct {
    Vector numbers;
    references_waypoints_Piece_numbers *at;
    Vector third;
    Vector second;
    Vector first;
    Vector offset;
} references_waypoints_Piece;

static inline references_waypoints_Piece references_waypoints_Piece_of(Vector numbers)
{
    const references_waypoints_Piece own = {
        numbers,
        (references_waypoints_Piece_numbers *)numbers.data,
        {numbers.data + 1, 7},
        {numbers.data + 8, 7},
        {numbers.data + 15, 7},
        {numbers.data + 22, 7}
    };
    return own;
}

typedef struct {
    double scalar;
} references_waypoints_PoseNumbers_numbers;

/* Displacement [m], and scalar and vector part of a quaternion of any length but 0. */
typedef struct {
    Vector numbers;
    references_waypoints_PoseNumbers_numbers *at;
    Vector move;
    Vector vector;
} references_waypoints_PoseNumbers;

static inline references_waypoints_PoseNumbers references_waypoints_PoseNumbers_of(Vector numbers)
{
    const references_waypoints_PoseNumbers own = {
        numbers,
        (references_waypoints_PoseNumbers_numbers *)numbers.data,
        {numbers.data + 1, 3},
        {numbers.data + 4, 3}
    };
    return own;
}

typedef struct {
    double weight;
    double is_inertia;
} schemes_costs_KineticConstants_numbers;

/* Constants of `KineticEnergy`: its weight, and whether G is the inertia matrix. */
typedef struct {
    Vector numbers;
    schemes_costs_KineticConstants_numbers *at;
} schemes_costs_KineticConstants;

static inline schemes_costs_KineticConstants schemes_costs_KineticConstants_of(Vector numbers)
{
    const schemes_costs_KineticConstants own = {
        numbers,
        (schemes_costs_KineticConstants_numbers *)numbers.data
    };
    return own;
}

typedef struct {
    double weight;
    double gain;
} schemes_costs_CyclicConstants_numbers;

/* Constants of `CyclicMotion`: its weight, gain m [1/s] and home [rad], (n,). */
typedef struct {
    Vector numbers;
    schemes_costs_CyclicConstants_numbers *at;
    Vector home;
} schemes_costs_CyclicConstants;

static inline schemes_costs_CyclicConstants schemes_costs_CyclicConstants_of(Vector numbers, int64_t n)
{
    const schemes_costs_CyclicConstants own = {
        numbers,
        (schemes_costs_CyclicConstants_numbers *)numbers.data,
        {numbers.data + 2, n}
    };
    return own;
}

typedef struct {
    double gain; /* kappa [1/s]. */
} schemes_joint_limits_PositionConstants_numbers;

/* Constants of `JointLimits` for n joints, as its kernel reads them. */
typedef struct {
    Vector numbers;
    schemes_joint_limits_PositionConstants_numbers *at;
    Vector lower; /* Lower position limits [rad], (n,). */
    Vector upper; /* Upper position limits [rad], (n,). */
    Vector velocity; /* Velocity limits [rad/s], (n,). */
    Vector offset; /* Offsets o of the position-dependent velocity limits [rad/s], (n,). */
    Vector slope; /* Decelerations D of these limits [rad/s^2], (n,); inf for a joint without one. */
} schemes_joint_limits_PositionConstants;

static inline schemes_joint_limits_PositionConstants schemes_joint_limits_PositionConstants_of(Vector numbers, int64_t n)
{
    const schemes_joint_limits_PositionConstants own = {
        numbers,
        (schemes_joint_limits_PositionConstants_numbers *)numbers.data,
        {numbers.data + 1, n},
        {numbers.data + 1 + n, n},
        {numbers.data + 1 + 2 * n, n},
        {numbers.data + 1 + 3 * n, n},
        {numbers.data + 1 + 4 * n, n}
    };
    return own;
}

typedef struct {
    double frame; /* Index of the frame. */
    double gain; /* Rate at which the error decays [1/s]. */
    double relative_to; /* Index of the base frame, relative to which the frame moves; 0: the world. */
} schemes_step_FrameConstants_numbers;

/* First constants of each task of a frame. */
typedef struct {
    Vector numbers;
    schemes_step_FrameConstants_numbers *at;
} schemes_step_FrameConstants;

static inline schemes_step_FrameConstants schemes_step_FrameConstants_of(Vector numbers)
{
    const schemes_step_FrameConstants own = {
        numbers,
        (schemes_step_FrameConstants_numbers *)numbers.data
    };
    return own;
}

/* Constants of `RelativePoseTask`: those of a frame, and its desired pose at rest. */
typedef struct {
    Vector numbers;
    schemes_step_FrameConstants task;
    references_targets_TargetData pose;
} schemes_tasks_HeldPoseConstants;

static inline schemes_tasks_HeldPoseConstants schemes_tasks_HeldPoseConstants_of(Vector numbers)
{
    const schemes_tasks_HeldPoseConstants own = {
        numbers,
        schemes_step_FrameConstants_of((Vector){numbers.data, 3}),
        references_targets_TargetData_of((Vector){numbers.data + 3, 18})
    };
    return own;
}

/* Constants of `AxisTask`. */
typedef struct {
    Vector numbers;
    schemes_step_FrameConstants task; /* Frame and gain. */
    Vector axis; /* The axis in the frame's own coordinates. */
    Matrix normals; /* Two directions normal to it and to each other. */
    Vector direction; /* Desired direction in the world; zero: the axis as the target's rotation turns it. */
} schemes_tasks_AxisConstants;

static inline schemes_tasks_AxisConstants schemes_tasks_AxisConstants_of(Vector numbers)
{
    const schemes_tasks_AxisConstants own = {
        numbers,
        schemes_step_FrameConstants_of((Vector){numbers.data, 3}),
        {numbers.data + 3, 3},
        {numbers.data + 6, 2, 3},
        {numbers.data + 12, 3}
    };
    return own;
}

/* Constants of `RemoteCenterTask`. */
typedef struct {
    Vector numbers;
    schemes_step_FrameConstants task; /* Frame, gain, and the frame that carries the point as base frame. */
    Matrix normals; /* Two directions normal to the shaft and to each other. */
    Vector point; /* The point relative to the origin of the base frame [m]. */
} schemes_tasks_RemoteCenterConstants;

static inline schemes_tasks_RemoteCenterConstants schemes_tasks_RemoteCenterConstants_of(Vector numbers)
{
    const schemes_tasks_RemoteCenterConstants own = {
        numbers,
        schemes_step_FrameConstants_of((Vector){numbers.data, 3}),
        {numbers.data + 3, 2, 3},
        {numbers.data + 9, 3}
    };
    return own;
}

typedef struct {
    double gain; /* Rate at which the error decays [1/s]. */
} schemes_tasks_JointConstants_numbers;

/* Constants of a task of joints, whose rows are C dq = gain (c - C q). */
typedef struct {
    Vector numbers;
    schemes_tasks_JointConstants_numbers *at;
    Vector offsets; /* c [rad], (rows,). */
    Vector coefficients; /* C, row by row, (rows * n,). */
} schemes_tasks_JointConstants;

static inline schemes_tasks_JointConstants schemes_tasks_JointConstants_of(Vector numbers, int64_t rows, int64_t entries)
{
    const schemes_tasks_JointConstants own = {
        numbers,
        (schemes_tasks_JointConstants_numbers *)numbers.data,
        {numbers.data + 1, rows},
        {numbers.data + 1 + rows, entries}
    };
    return own;
}

typedef struct {
    double frame;
    double limit;
    double gain;
} schemes_tip_speed_TipSpeedConstants_numbers;

/* Constants of `TipSpeedLimit`: index of the frame, limit V [m/s] and gain [1/s]. */
typedef struct {
    Vector numbers;
    schemes_tip_speed_TipSpeedConstants_numbers *at;
} schemes_tip_speed_TipSpeedConstants;

static inline schemes_tip_speed_TipSpeedConstants schemes_tip_speed_TipSpeedConstants_of(Vector numbers)
{
    const schemes_tip_speed_TipSpeedConstants own = {
        numbers,
        (schemes_tip_speed_TipSpeedConstants_numbers *)numbers.data
    };
    return own;
}
/* Angle [rad] beyond which the reduction is coarser, and joint positions are refused. */
static const double compiling_trigonometry_LARGEST = 1048576.0;

/* Angle [rad] above which rounding exceeds a turn: it counts as 0. */
static const double compiling_trigonometry_FARTHEST = 1125899906842624.0;

static const double compiling_trigonometry_TURN = 6.283185307179586;

/* Number that rounds others to integers where it is added and taken away. */
static const double compiling_trigonometry_SHIFT = 6755399441055744.0;

static const double compiling_trigonometry_QUARTERS = 0.6366197723675814;

/* Parts of pi/2; the first three have 33 bits, so that products with 20 more are exact. */
static const double compiling_trigonometry_HALF_PI[] = {1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21, 8.4784276603689e-32};

/* Polynomial in z = r^2 for (sin r - r) / r^3, |r| <= pi/4. */
static const double compiling_trigonometry_SINE[] = {-0.16666666666666632, 0.008333333333322448, -0.0001984126982982999, 2.7557313698474682e-06, -2.5050759016479128e-08, 1.5896842475120903e-10};

/* Polynomial in z = r^2 for (cos r - 1 + z/2) / z^2. */
static const double compiling_trigonometry_COSINE[] = {0.0416666666666666, -0.0013888888888874417, 2.480158728964162e-05, -2.755731439330701e-07, 2.087572831504225e-09, -1.1359887227604265e-11};

/* Relative excess over the longest period that counts as rounding. */
static const double schemes_periods_SLACK = 1e-09;

static const int64_t control_requests_TWIST = 6; /* Numbers of a twist. */

/* Result of a step whose time, targets or joint positions are invalid, so no command is given. */
static const int64_t control_cycle_INVALID = -1;

/* Axes, so that those after one are the next two. */
static const int64_t robot_kinematics_kernel_CYCLE[] = {0, 1, 2, 0, 1};

/* Axis that a joint turns about or slides along: z. */
static const int64_t robot_kinematics_kernel_AXIS = 2;

static const int64_t control_yielding_NONE = 0;

/* Largest request, in units of the largest velocity of the joints; a larger one is cut to it. */
static const double control_requests_CUT = 100.0;

/* Velocity limit of a joint without one [rad/s], where requests are cut. */
static const double control_requests_FASTEST = 10000.0;

/* Least number of periods in which the usable jerk builds up the full deceleration. */
static const double schemes_profiles_JERK_PERIODS = 8.0;

/* Distance that is kept free at a position limit, in units of J' dt^3; 1 / sqrt(27) is needed. */
static const double schemes_viability_MARGIN = 0.2;

/* Number of decelerations B that are tried below a position-dependent velocity limit. */
static const int64_t schemes_viability_LEVELS = 15;

/* Bisection steps for the command whose stopping path ends at a position limit. */
static const int64_t schemes_viability_HALVINGS = 20;

static const double schemes_viability_LOWER = 0.7; /* Ratio of each B to the one before. */

/* Offset of the rest position of a joint at a limit, in units of J' dt^3, slightly above `MARGIN`. */
static const double schemes_viability_REST = 0.25;

/* Distance that counts as rounding of a position while a joint brakes [rad]. */
static const double schemes_profiles_ROUNDING = 2e-14;

/* Fraction of the remaining distance that a joint almost at rest covers in a period. */
static const double schemes_profiles_EASE = 0.5;

/* Velocity up to which a joint is at rest [rad/s]; in units of J dt^2 a smaller one may be 0. */
static const double schemes_profiles_AT_REST = 1e-100;

static const int64_t control_command_SOLVED = 0;

static const int64_t control_yielding_NOMINAL = 0;

/* Distance to keep that marks a pair which overlaps without a normal: the arm is stopped. */
static const double schemes_collisions_MEET = INFINITY;

static const int64_t control_command_NOT_FINITE = 3;

static const int64_t control_command_ADVANCED = 1;

/* Negative eigenvalues of P that pass as rounding, relative to n times its largest entry. They are those of
 * a product J^T J in double precision; of single precision they are refused. A residual of n variables
 * passes as rounding at n times as much, relative to the sum of its absolute terms. */
static const double qp_dense_ROUNDING = 4e-15;

/* Largest coefficient of a row, a column or the cost below which it is slight. */
static const double qp_residuals_SLIGHT = 0.001;

static const int64_t control_command_NOT_CONVERGED = 2;

/* Relative excess over a limit that counts as rounding. */
static const double control_stopping_SLACK = 1e-12;

/* Number of periods above which no motion to rest is searched for. */
static const double control_stopping_LONGEST = 1000000.0;

/* Factor between successive numbers of periods that `least_periods` tries. */
static const double control_stopping_GROWTH = 1.1;

/* Bound on how far varying periods lower a displacement to rest, as a part of |b| dt; the largest over all
 * signs of velocity and acceleration is 0.169 (docs/theory_limits.md). */
static const double control_stopping_UNEVEN = 0.175;

/* Largest number of steps of the search along a segment; about six are needed. */
static const int64_t schemes_scene_ROUNDS = 60;

/* Distance of two boxes, without their radii, below which they touch [m]. */
static const double schemes_scene_MET = 1e-09;

/* Terms of a product from which on it is summed in `PARTS`; those of one arm are fewer. */
static const int64_t qp_dense_LONG = 16;

/* Sums, of each fourth term, that a processor forms at once; rows that one pass takes off. */
static const int64_t qp_dense_PARTS = 4;

static const int64_t control_yielding_BRAKE = -1; /* Code of no policy: the arm brakes to rest. */

static const int64_t control_yielding_STOPPED = 4;

/* Velocity bound per distance to a position limit in fallback programs [1/s]. */
static const double control_yielding_POSITION_GAIN = 20.0;

/* Weight w of the nominal cost in the search of a factor, if its largest entry is one. */
static const double control_fallback_PENALTY = 1e-05;

/* Lower bound on the tolerance of the search for tau: if a link can hardly retreat, its row is nearly zero,
 * and full accuracy would exceed the budget of linear solves. */
static const double control_fallback_RETREAT = 1e-07;

/* Length of the first backward Euler step [rho]. */
static const double networks_integrators_implicit_SHORTEST = 30.0;

/* Largest coefficient of a row above which a program is scaled first, curvature above which steps are
 * longer, and largest entry of a cost in scaled units, at first. */
static const double networks_integrators_scaling_LARGE = 1000.0;

/* Longest implicit step of a network that converges [rho]. */
static const double networks_integrators_pseudo_transient_LONGEST = 100000000.0;

/* Mark of a row where the condensed matrix is no factor for a linearly implicit step. */
static const double networks_integrators_implicit_UNKNOWN = -1.0;

/* Rounds in which the smallest rate so far is not halved, before the end: there is no solution, or rounding
 * keeps the residuals above the tolerance. */
static const int64_t networks_integrators_implicit_STALLED = 15;

/* Slope at which a line search may end, relative to that at its start. */
static const double networks_integrators_implicit_steps_SLOPE = 0.5;

/* Newton iterations of one backward Euler step of `solve`, half as many as one of `advance`. */
static const int64_t networks_integrators_implicit_MAX_NEWTON = 50;

/* Growth of that length from round to round. */
static const double networks_integrators_implicit_GROWTH = 10.0;

/* Linear solves after which a program counts as one without a solution. */
static const int64_t control_fallback_MAX_LINEAR_SOLVES = 60;

/* Factor above which the unscaled task counts as feasible. */
static const double control_fallback_FEASIBLE = 0.999999999;

/* Part of the largest feasible factor that is used: multipliers may be unbounded at the largest. */
static const double control_fallback_ALMOST = 0.999;

/* Multiplier, relative to the largest, above which a bound or row counts as limiting. */
static const double control_fallback_LIMITING = 0.0001;

static const int64_t control_yielding_SLOW = 2;

/* Tip motion for a unit of joint velocity [m/rad] below which a pose counts as singular. */
static const double control_yielding_SINGULAR = 0.05;

/* Scaling factor below which the task is relaxed, and least fraction of a period by which the clock then
 * advances, so that the target leaves a singular or unreachable pose. */
static const double control_yielding_CREEP = 0.1;

static const int64_t control_yielding_SCALED = 1;

static const int64_t control_yielding_STOP = 4;

/* Largest task velocity in the relaxed program [m/s]; a larger one is scaled down to it. */
static const double control_fallback_FASTEST = 10.0;

/* Largest speed of the drift v_0 down the gradient of the cost [rad/s]. Without the drift, an arm pulled
 * beyond its reach stays fully stretched, and leaves that posture too late. */
static const double control_fallback_DRIFT = 0.02;

static const double control_fallback_DAMPING = 0.05; /* Lambda of the relaxed program [m/rad]. */

/* Epsilon: weight of the nominal cost in the relaxed program. */
static const double control_fallback_BLEND = 0.0001;

static const int64_t control_yielding_RELAXED = 2;

/* Difference of joint velocities, or of rates of equality rows, that is rounding [rad/s]. */
static const double control_fallback_REACHED = 1e-09;

/* Factor between successive numbers of periods that `stretched` tries. */
static const double control_stopping_STRETCH = 1.01;

/* Numbers of blends of the stopping motion with a command that are tried, each with half the command's part
 * of the one before; HALVINGS_NEAR if a pair keeps less than its scene's distance. */
static const int64_t control_yielding_HALVINGS_NEAR = 12;

static const int64_t control_yielding_HALVINGS = 4;

static const int64_t control_yielding_RATE_LIMITED = 3;

static const int64_t control_yielding_RELAX = 3;

/* Damping lambda of a twist's program [m/rad], which limits joint velocities near a singular pose. */
static const double control_requests_DAMPING = 0.02;

/* Relative error above which a twist that only the damping limits is reported as not fulfilled. */
static const double control_requests_SHORT = 0.02;

/* Weight of the error perpendicular to a twist, relative to the error along it. */
static const double control_requests_SIDEWAYS = 10.0;

/* Fraction of the computed stable step that is used: the bound itself is only marginally stable. */
static const double networks_integrators_explicit_SAFETY = 0.95;

/* Largest number of sub-steps that stability may ask for in one `advance`. */
static const int64_t networks_integrators_explicit_MOST = 1000000;

static const double networks_integrators_scaling_SQRT2 = 1.4142135623730951;

/* Factor that splits a number into two halves of its digits. */
static const double qp_certificates_SPLIT = 134217729.0;

/* Absolute term of a product below which digits may be lost to underflow. */
static const double qp_certificates_UNDERFLOW = 1e-270;

static const double qp_certificates_TINY = 1.1830521861667747e-271; /* Bound on the underflow of a term. */

static const double qp_certificates_EPS = 2.220446049250313e-16;

/* Difference of P_ij and P_ji that passes, relative to sqrt(P_ii P_jj), which no entry of a semidefinite
 * matrix exceeds: a matrix that was computed in single precision has it. The symmetric part of P is what
 * the program means. */
static const double qp_dense_ASYMMETRY = 1e-05;

/* Distance [m] and angle [rad] below which a target is at its goal: rounding has no direction. */
static const double references_moving_target_ARRIVED = 1e-12;

/* Rows of a pair, one for each end of the segment of its second body. */
static const int64_t schemes_collisions_ENDS = 2;

/* Distance beyond the least one at which a pair comes to rest [m]. Points move along an obstacle on curves:
 * from the least distance itself, no stopping motion would keep it, and the arm could not leave. */
static const double schemes_collisions_CLEARANCE = 1e-06;

/* Sine of the angle between the tool's axis and the vertical up to which they are parallel. */
static const double schemes_tasks_VERTICAL = 1e-09;

/* Lever of a joint that counts as rounding, as where its axis goes through the tip [m]. */
static const double schemes_tip_speed_NEGLIGIBLE = 1e-06;

/* Compute sine and cosine of an angle [rad].
 *
 * From `LARGEST` on, whole turns are subtracted as one product: the error is at most that of an
 * angle which is off by one unit in its last place. From `FARTHEST` on, the angle counts as 0.
 * Infinity and NaN give NaN.
 *
 * iiwa_dnn/compiling/trigonometry.py: sin_cos */
static inline double_2 compiling_trigonometry_sin_cos(struct arena *arena, double angle)
{
    (void)arena;
    #line 53 "iiwa_dnn/compiling/trigonometry.py"
    #line 59 "iiwa_dnn/compiling/trigonometry.py"
    double x = angle;
    #line 60 "iiwa_dnn/compiling/trigonometry.py"
    if (!(fabs(x) < compiling_trigonometry_LARGEST)) {
        #line 61 "iiwa_dnn/compiling/trigonometry.py"
        x = fabs(x) < compiling_trigonometry_FARTHEST ? x - compiling_trigonometry_TURN * (x / compiling_trigonometry_TURN + compiling_trigonometry_SHIFT - compiling_trigonometry_SHIFT) : x - x;
    }
    #line 62 "iiwa_dnn/compiling/trigonometry.py"
    const double k = x * compiling_trigonometry_QUARTERS + compiling_trigonometry_SHIFT - compiling_trigonometry_SHIFT;
    #line 63 "iiwa_dnn/compiling/trigonometry.py"
    const double first = x - k * compiling_trigonometry_HALF_PI[0];
    #line 64 "iiwa_dnn/compiling/trigonometry.py"
    const double w = k * compiling_trigonometry_HALF_PI[1];
    #line 65 "iiwa_dnn/compiling/trigonometry.py"
    const double near = first - w;
    #line 66 "iiwa_dnn/compiling/trigonometry.py"
    const double v = near - first;
    #line 67 "iiwa_dnn/compiling/trigonometry.py"
    const double rest = first - (near - v) - (w + v);
    #line 68 "iiwa_dnn/compiling/trigonometry.py"
    const double tail = rest - k * compiling_trigonometry_HALF_PI[2] - k * compiling_trigonometry_HALF_PI[3];
    #line 69 "iiwa_dnn/compiling/trigonometry.py"
    const double r = near + tail;
    #line 70 "iiwa_dnn/compiling/trigonometry.py"
    const double low = near - r + tail;
    #line 71 "iiwa_dnn/compiling/trigonometry.py"
    const double z = r * r;
    #line 72 "iiwa_dnn/compiling/trigonometry.py"
    double p = compiling_trigonometry_SINE[3] + z * (compiling_trigonometry_SINE[4] + z * compiling_trigonometry_SINE[5]);
    #line 73 "iiwa_dnn/compiling/trigonometry.py"
    p = compiling_trigonometry_SINE[0] + z * (compiling_trigonometry_SINE[1] + z * (compiling_trigonometry_SINE[2] + z * p));
    #line 74 "iiwa_dnn/compiling/trigonometry.py"
    const double sine = r + (r * (z * p) + low * (1.0 - 0.5 * z));
    #line 75 "iiwa_dnn/compiling/trigonometry.py"
    p = compiling_trigonometry_COSINE[3] + z * (compiling_trigonometry_COSINE[4] + z * compiling_trigonometry_COSINE[5]);
    #line 76 "iiwa_dnn/compiling/trigonometry.py"
    p = compiling_trigonometry_COSINE[0] + z * (compiling_trigonometry_COSINE[1] + z * (compiling_trigonometry_COSINE[2] + z * p));
    #line 77 "iiwa_dnn/compiling/trigonometry.py"
    const double one = 1.0 - 0.5 * z;
    #line 78 "iiwa_dnn/compiling/trigonometry.py"
    const double cosine = one + (1.0 - one - 0.5 * z + (z * (z * p) - r * low));
    #line 79 "iiwa_dnn/compiling/trigonometry.py"
    const int64_t quadrant = int_remainder(int_of(k), 4);
    #line 80 "iiwa_dnn/compiling/trigonometry.py"
    if (quadrant == 1) {
        #line 81 "iiwa_dnn/compiling/trigonometry.py"
        return (double_2){{cosine, -sine}};
    }
    #line 82 "iiwa_dnn/compiling/trigonometry.py"
    if (quadrant == 2) {
        #line 83 "iiwa_dnn/compiling/trigonometry.py"
        return (double_2){{-sine, -cosine}};
    }
    #line 84 "iiwa_dnn/compiling/trigonometry.py"
    if (quadrant == 3) {
        #line 85 "iiwa_dnn/compiling/trigonometry.py"
        return (double_2){{-cosine, sine}};
    }
    #line 86 "iiwa_dnn/compiling/trigonometry.py"
    return (double_2){{sine, cosine}};
}

/* Compute the sine of an angle [rad] with the bits of `sin_cos`.
 *
 * iiwa_dnn/compiling/trigonometry.py: sin */
static inline double compiling_trigonometry_sin(struct arena *arena, double angle)
{
    #line 91 "iiwa_dnn/compiling/trigonometry.py"
    #line 92 "iiwa_dnn/compiling/trigonometry.py"
    const double_2 own_1 = compiling_trigonometry_sin_cos(arena, angle);
    return own_1.at[0];
}

/* View the memory (k,) of an arm as its state.
 *
 * iiwa_dnn/control/arms.py: arm_state */
static inline control_arms_ArmState control_arms_arm_state(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory)
{
    (void)arena;
    #line 190 "iiwa_dnn/control/arms.py"
    #line 191 "iiwa_dnn/control/arms.py"
    return control_arms_ArmState_of(memory, plan->sizes.n, plan->sizes.request, plan->sizes.motion, plan->sizes.network, plan->sizes.fallback, plan->sizes.obstacles, plan->sizes.limiting, plan->sizes.sent);
}

/* View the state of an arm's motion.
 *
 * iiwa_dnn/control/arms.py: motion_of */
static inline control_state_MotionState control_arms_motion_of(struct arena *arena, const control_arms_ArmPlan *plan, const control_arms_ArmState *arm)
{
    (void)arena;
    #line 206 "iiwa_dnn/control/arms.py"
    #line 207 "iiwa_dnn/control/arms.py"
    const schemes_program_ProgramSizes sizes = plan->step.arrays.sizes;
    #line 208 "iiwa_dnn/control/arms.py"
    return control_state_MotionState_of(arm->motion, sizes.joints, sizes.pairs);
}

/* Write values (k,) into the first k of `out`.
 *
 * iiwa_dnn/qp/layout.py: copied */
static inline void qp_layout_copied(struct arena *arena, Vector out, Vector values)
{
    (void)arena;
    #line 95 "iiwa_dnn/qp/layout.py"
    #line 96 "iiwa_dnn/qp/layout.py"
    for (int64_t k = 0; k < values.size0; k++) {
        #line 97 "iiwa_dnn/qp/layout.py"
        out.data[k] = values.data[k];
    }
}

/* Reset an arm to rest at joint positions q (n,) [rad]; its obstacles stay where they are.
 *
 * If q is empty, the arm begins at the positions that the next step measures.
 *
 * iiwa_dnn/control/arms.py: rest_arm */
static inline void control_arms_rest_arm(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory, Vector q)
{
    const struct arena mark = *arena;
    #line 213 "iiwa_dnn/control/arms.py"
    #line 217 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 218 "iiwa_dnn/control/arms.py"
    const Matrix centers = {(double *)arena_copy(arena, arm.obstacles.data, arm.obstacles.size0 * arm.obstacles.size1), arm.obstacles.size0, arm.obstacles.size1};
    #line 219 "iiwa_dnn/control/arms.py"
    for (int64_t own_k = 0; own_k < memory.size0; own_k++) {
        memory.data[own_k] = 0.0;
    }
    #line 220 "iiwa_dnn/control/arms.py"
    for (int64_t k = 0; k < centers.size0; k++) {
        #line 221 "iiwa_dnn/control/arms.py"
        qp_layout_copied(arena, (Vector){arm.obstacles.data + k * arm.obstacles.size1, arm.obstacles.size1}, (Vector){centers.data + k * centers.size1, centers.size1});
    }
    #line 222 "iiwa_dnn/control/arms.py"
    arm.at->period = plan->settings.at->dt;
    #line 223 "iiwa_dnn/control/arms.py"
    arm.at->reason = (double)control_requests_Reason_NO_REQUEST;
    #line 224 "iiwa_dnn/control/arms.py"
    if (q.size0 > 0) {
        #line 225 "iiwa_dnn/control/arms.py"
        arm.at->has_begun = true;
        #line 226 "iiwa_dnn/control/arms.py"
        qp_layout_copied(arena, arm.positions, q);
    }
    arena_leave(arena, &mark);
}

/* Place the centres of an arm's obstacles, (k, 3) [m], at the present time.
 *
 * iiwa_dnn/control/arms.py: place_arm */
static inline void control_arms_place_arm(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory, Matrix centers)
{
    #line 231 "iiwa_dnn/control/arms.py"
    #line 232 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 233 "iiwa_dnn/control/arms.py"
    for (int64_t k = 0, end_k = arm.obstacles.size0; k < end_k; k++) {
        #line 234 "iiwa_dnn/control/arms.py"
        for (int64_t i = 0; i < 3; i++) {
            #line 235 "iiwa_dnn/control/arms.py"
            arm.obstacles.data[k * arm.obstacles.size1 + i] = centers.data[k * centers.size1 + i] - arm.at->time * plan->velocities.data[k * plan->velocities.size1 + i];
        }
    }
}

/* Make an arm brake at each step, whatever is requested, until `rest_arm`.
 *
 * iiwa_dnn/control/arms.py: halt_arm */
static inline void control_arms_halt_arm(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory)
{
    #line 240 "iiwa_dnn/control/arms.py"
    #line 241 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 242 "iiwa_dnn/control/arms.py"
    arm.at->reason = (double)control_requests_Reason_HALTED;
}

/* Write a velocity dq (n,) [rad/s] to `last`, and the last command to `before`.
 *
 * Sets `stopping_periods` to 0, and `spacing` to dt [s] if it is 0.
 *
 * iiwa_dnn/control/state.py: count_as_sent */
static inline void control_state_count_as_sent(struct arena *arena, const control_state_MotionState *motion, Vector dq, double dt)
{
    (void)arena;
    #line 58 "iiwa_dnn/control/state.py"
    #line 62 "iiwa_dnn/control/state.py"
    for (int64_t i = 0, end_i = motion->last.size0; i < end_i; i++) {
        #line 63 "iiwa_dnn/control/state.py"
        motion->before.data[i] = motion->last.data[i];
        #line 64 "iiwa_dnn/control/state.py"
        motion->last.data[i] = dq.data[i];
    }
    #line 65 "iiwa_dnn/control/state.py"
    motion->at->stopping_periods = 0.0;
    #line 66 "iiwa_dnn/control/state.py"
    motion->at->spacing = motion->at->spacing > 0.0 ? motion->at->spacing : dt;
}

/* View the command that was sent k commands before the last one.
 *
 * iiwa_dnn/control/arms.py: _sent_command */
static inline control_arms_SentCommand control_arms_sent_command(struct arena *arena, const control_arms_ArmState *arm, int64_t k)
{
    (void)arena;
    #line 347 "iiwa_dnn/control/arms.py"
    #line 348 "iiwa_dnn/control/arms.py"
    const int64_t width = 1 + arm->positions.size0;
    #line 349 "iiwa_dnn/control/arms.py"
    return control_arms_SentCommand_of((Vector){arm->sent.data + k * width, (k + 1) * width - k * width}, int_max(0, ((k + 1) * width - k * width - (1)) / 1));
}

/* Note a command dq (n,) [rad/s] as the last one that was sent.
 *
 * If the two before it last no longer than a control period [s] together, they become one with
 * their mean velocity: so a bounded number of commands covers the delay.
 *
 * iiwa_dnn/control/arms.py: _note_sent */
static inline void control_arms_note_sent(struct arena *arena, const control_arms_ArmState *arm, double period, Vector dq)
{
    #line 366 "iiwa_dnn/control/arms.py"
    #line 371 "iiwa_dnn/control/arms.py"
    const control_arms_SentCommand last = control_arms_sent_command(arena, arm, 0);
    #line 372 "iiwa_dnn/control/arms.py"
    const control_arms_SentCommand before = control_arms_sent_command(arena, arm, 1);
    #line 373 "iiwa_dnn/control/arms.py"
    const double both = last.at->period + before.at->period;
    #line 374 "iiwa_dnn/control/arms.py"
    if (double_min(last.at->period, before.at->period) > 0.0 && both <= period) {
        #line 375 "iiwa_dnn/control/arms.py"
        for (int64_t i = 0; i < dq.size0; i++) {
            #line 376 "iiwa_dnn/control/arms.py"
            const double displacement = last.at->period * last.dq.data[i] + before.at->period * before.dq.data[i];
            #line 377 "iiwa_dnn/control/arms.py"
            before.dq.data[i] = displacement / both;
        }
        #line 378 "iiwa_dnn/control/arms.py"
        before.at->period = both;
    } else {
        #line 380 "iiwa_dnn/control/arms.py"
        const int64_t width = 1 + dq.size0;
        #line 381 "iiwa_dnn/control/arms.py"
        for (int64_t k = 0, end_k = arm->sent.size0 - width; k < end_k; k++) {
            #line 382 "iiwa_dnn/control/arms.py"
            const int64_t place = arm->sent.size0 - 1 - k;
            #line 383 "iiwa_dnn/control/arms.py"
            arm->sent.data[place] = arm->sent.data[place - width];
        }
    }
    #line 384 "iiwa_dnn/control/arms.py"
    last.at->period = arm->at->period;
    #line 385 "iiwa_dnn/control/arms.py"
    qp_layout_copied(arena, last.dq, dq);
}

/* Advance the commanded positions and the time by the last command's period.
 *
 * iiwa_dnn/control/arms.py: _advance */
static inline void control_arms_advance(struct arena *arena, const control_arms_ArmState *arm, const control_arms_ArmSettings *settings, const control_state_MotionState *motion)
{
    #line 453 "iiwa_dnn/control/arms.py"
    #line 454 "iiwa_dnn/control/arms.py"
    if (arm->sent.size0 > 0) {
        #line 455 "iiwa_dnn/control/arms.py"
        control_arms_note_sent(arena, arm, settings->at->dt, motion->last);
    }
    #line 456 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0, end_i = arm->positions.size0; i < end_i; i++) {
        #line 457 "iiwa_dnn/control/arms.py"
        arm->positions.data[i] += arm->at->period * motion->last.data[i];
    }
    #line 458 "iiwa_dnn/control/arms.py"
    arm->at->time += arm->at->period;
}

/* Count a velocity dq (n,) [rad/s] as sent for a period [s], in place of a step's command.
 *
 * iiwa_dnn/control/arms.py: send_arm */
static inline void control_arms_send_arm(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory, Vector dq, double period)
{
    #line 247 "iiwa_dnn/control/arms.py"
    #line 248 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 249 "iiwa_dnn/control/arms.py"
    const control_state_MotionState motion = control_arms_motion_of(arena, plan, &arm);
    #line 250 "iiwa_dnn/control/arms.py"
    control_state_count_as_sent(arena, &motion, dq, period);
    #line 251 "iiwa_dnn/control/arms.py"
    arm.at->age += arm.at->period;
    #line 252 "iiwa_dnn/control/arms.py"
    arm.at->period = period;
    #line 253 "iiwa_dnn/control/arms.py"
    control_arms_advance(arena, &arm, &plan->settings, &motion);
}

/* Return the periods of a loop whose period [s] is constant.
 *
 * iiwa_dnn/schemes/periods.py: constant_periods */
static inline schemes_periods_Periods schemes_periods_constant_periods(struct arena *arena, double dt)
{
    (void)arena;
    #line 44 "iiwa_dnn/schemes/periods.py"
    #line 45 "iiwa_dnn/schemes/periods.py"
    return (schemes_periods_Periods){dt, dt, dt, dt, 1.0, false, false};
}

/* Return the periods of a step, all in [s], as `stated_periods` without its checks.
 *
 * `longest` is 0 where periods are constant; of `dt` and `elapsed`, 0 is one that is not stated.
 *
 * iiwa_dnn/schemes/periods.py: periods_of */
static inline schemes_periods_Periods schemes_periods_periods_of(struct arena *arena, double nominal, double longest, double dt, double elapsed)
{
    #line 50 "iiwa_dnn/schemes/periods.py"
    #line 54 "iiwa_dnn/schemes/periods.py"
    const double hold = dt > 0.0 ? dt : nominal;
    #line 55 "iiwa_dnn/schemes/periods.py"
    if (longest == 0.0) {
        #line 56 "iiwa_dnn/schemes/periods.py"
        return schemes_periods_constant_periods(arena, hold);
    }
    #line 57 "iiwa_dnn/schemes/periods.py"
    const bool exceeded = double_max(dt, elapsed) > longest * (1.0 + schemes_periods_SLACK);
    #line 58 "iiwa_dnn/schemes/periods.py"
    if (dt > 0.0) {
        #line 59 "iiwa_dnn/schemes/periods.py"
        return (schemes_periods_Periods){dt, dt, dt, longest, 1.0, true, exceeded};
    }
    #line 60 "iiwa_dnn/schemes/periods.py"
    if (elapsed > 0.0) {
        #line 61 "iiwa_dnn/schemes/periods.py"
        return (schemes_periods_Periods){elapsed, nominal, longest, longest, 1.0, true, exceeded};
    }
    #line 62 "iiwa_dnn/schemes/periods.py"
    return (schemes_periods_Periods){nominal, nominal, nominal, nominal, nominal / longest, true, false};
}

/* Correct positions and time for a last command that was held for `elapsed` [s].
 *
 * iiwa_dnn/control/arms.py: _correct_last_period */
static inline void control_arms_correct_last_period(struct arena *arena, const control_arms_ArmState *arm, const control_state_MotionState *motion, double elapsed)
{
    #line 311 "iiwa_dnn/control/arms.py"
    #line 312 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0, end_i = motion->last.size0; i < end_i; i++) {
        #line 313 "iiwa_dnn/control/arms.py"
        arm->positions.data[i] += (elapsed - arm->at->period) * motion->last.data[i];
    }
    #line 314 "iiwa_dnn/control/arms.py"
    arm->at->time = arm->at->time + elapsed - arm->at->period;
    #line 315 "iiwa_dnn/control/arms.py"
    arm->at->period = elapsed;
    #line 316 "iiwa_dnn/control/arms.py"
    if (arm->sent.size0 > 0) {
        #line 317 "iiwa_dnn/control/arms.py"
        const control_arms_SentCommand last = control_arms_sent_command(arena, arm, 0);
        #line 318 "iiwa_dnn/control/arms.py"
        last.at->period = elapsed;
    }
}

/* Add the displacement by the commands of the last `delay` [s] to positions q (n,) [rad].
 *
 * iiwa_dnn/control/arms.py: _add_pending */
static inline void control_arms_add_pending(struct arena *arena, const control_arms_ArmState *arm, double delay, Vector q)
{
    #line 354 "iiwa_dnn/control/arms.py"
    #line 355 "iiwa_dnn/control/arms.py"
    double age = 0.0;
    #line 356 "iiwa_dnn/control/arms.py"
    for (int64_t k = 0, end_k = int_quotient(arm->sent.size0, 1 + q.size0); k < end_k; k++) {
        #line 357 "iiwa_dnn/control/arms.py"
        const control_arms_SentCommand command = control_arms_sent_command(arena, arm, k);
        #line 358 "iiwa_dnn/control/arms.py"
        const double pending = double_min(double_max(delay - age, 0.0), command.at->period);
        #line 359 "iiwa_dnn/control/arms.py"
        for (int64_t i = 0; i < q.size0; i++) {
            #line 360 "iiwa_dnn/control/arms.py"
            q.data[i] += pending * command.dq.data[i];
        }
        #line 361 "iiwa_dnn/control/arms.py"
        age += command.at->period;
    }
}

/* Set the commanded positions to the measured ones, where these count.
 *
 * They count at the first step; where they differ by more than the tracking error; and where
 * periods vary and none is stated, since the time for which the last command was held is then
 * unknown. The displacement that the delay still hides is added to them.
 *
 * iiwa_dnn/control/arms.py: _update_positions */
static inline void control_arms_update_positions(struct arena *arena, const control_arms_ArmState *arm, const control_arms_ArmSettings *settings, const control_arms_ArmInput *inputs)
{
    const struct arena mark = *arena;
    #line 323 "iiwa_dnn/control/arms.py"
    #line 329 "iiwa_dnn/control/arms.py"
    const Vector q = {(double *)arena_copy(arena, inputs->q.data, arm->positions.size0), arm->positions.size0};
    #line 330 "iiwa_dnn/control/arms.py"
    control_arms_add_pending(arena, arm, settings->at->delay, q);
    #line 331 "iiwa_dnn/control/arms.py"
    int64_t far = 0;
    #line 332 "iiwa_dnn/control/arms.py"
    int64_t beyond = 0;
    #line 333 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0; i < q.size0; i++) {
        #line 334 "iiwa_dnn/control/arms.py"
        far += !(fabs(q.data[i] - arm->positions.data[i]) <= settings->at->tracking_error);
        #line 335 "iiwa_dnn/control/arms.py"
        beyond += !(fabs(q.data[i]) <= compiling_trigonometry_LARGEST);
    }
    #line 336 "iiwa_dnn/control/arms.py"
    const bool unstated = settings->at->longest > 0.0 && double_max(inputs->dt, inputs->elapsed) == 0.0;
    #line 337 "iiwa_dnn/control/arms.py"
    if (beyond > 0) {
        #line 338 "iiwa_dnn/control/arms.py"
        arm->reasons.data[control_requests_Reason_Q_NOT_FINITE] = 1.0;
    } else {
        #line 339 "iiwa_dnn/control/arms.py"
        if (far > 0 || unstated || !(arm->at->has_begun != 0.0)) {
            #line 340 "iiwa_dnn/control/arms.py"
            arm->reasons.data[control_requests_Reason_RESYNCHRONISED] = arm->at->has_begun != 0.0 && !unstated ? 1.0 : 0.0;
            #line 341 "iiwa_dnn/control/arms.py"
            arm->at->has_begun = true;
            #line 342 "iiwa_dnn/control/arms.py"
            qp_layout_copied(arena, arm->positions, q);
        }
    }
    arena_leave(arena, &mark);
}

/* Check that the entries data[start:end] of an array (k,) are finite.
 *
 * iiwa_dnn/qp/dense.py: all_finite */
static inline bool qp_dense_all_finite(struct arena *arena, Vector data, int64_t start, int64_t end)
{
    (void)arena;
    #line 241 "iiwa_dnn/qp/dense.py"
    #line 242 "iiwa_dnn/qp/dense.py"
    int64_t wrong = 0;
    #line 243 "iiwa_dnn/qp/dense.py"
    for (int64_t k = start; k < end; k++) {
        #line 244 "iiwa_dnn/qp/dense.py"
        wrong += fabs(data.data[k]) < INFINITY ? 0 : 1;
    }
    #line 245 "iiwa_dnn/qp/dense.py"
    return wrong == 0;
}

/* Count the entries of an array (n,) that differ from those of another, (n,) or longer.
 *
 * iiwa_dnn/control/arms.py: differing */
static inline int64_t control_arms_differing(struct arena *arena, Vector values, Vector others)
{
    (void)arena;
    #line 412 "iiwa_dnn/control/arms.py"
    #line 413 "iiwa_dnn/control/arms.py"
    int64_t count = 0;
    #line 414 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0; i < values.size0; i++) {
        #line 415 "iiwa_dnn/control/arms.py"
        count += values.data[i] != others.data[i];
    }
    #line 416 "iiwa_dnn/control/arms.py"
    return count;
}

/* Set the request that counts: the new one, else the last one, or zero for a `Reason`.
 *
 * iiwa_dnn/control/arms.py: _update_request */
static inline void control_arms_update_request(struct arena *arena, const control_arms_ArmState *arm, const control_arms_ArmSettings *settings, const control_arms_ArmInput *inputs)
{
    const struct arena mark = *arena;
    #line 390 "iiwa_dnn/control/arms.py"
    #line 391 "iiwa_dnn/control/arms.py"
    int64_t count = 0;
    #line 392 "iiwa_dnn/control/arms.py"
    if (inputs->kind != control_requests_Request_NONE) {
        #line 393 "iiwa_dnn/control/arms.py"
        arm->at->kind = (double)inputs->kind;
        #line 394 "iiwa_dnn/control/arms.py"
        count = inputs->kind == control_requests_Request_TWIST ? control_requests_TWIST : arm->positions.size0;
    }
    #line 395 "iiwa_dnn/control/arms.py"
    arm->at->age += arm->at->period;
    #line 396 "iiwa_dnn/control/arms.py"
    if (count > 0 && (int64_t)arm->at->reason != control_requests_Reason_HALTED) {
        #line 397 "iiwa_dnn/control/arms.py"
        arm->at->age = 0.0;
        #line 398 "iiwa_dnn/control/arms.py"
        const bool finite = qp_dense_all_finite(arena, inputs->request, 0, count);
        #line 399 "iiwa_dnn/control/arms.py"
        arm->at->reason = (double)(finite ? control_requests_Reason_NONE : control_requests_Reason_NOT_FINITE);
    }
    #line 400 "iiwa_dnn/control/arms.py"
    if ((int64_t)arm->at->reason == control_requests_Reason_NONE && arm->at->age > settings->at->timeout + 0.5 * arm->at->period) {
        #line 401 "iiwa_dnn/control/arms.py"
        arm->at->reason = (double)control_requests_Reason_TIMED_OUT;
    }
    #line 402 "iiwa_dnn/control/arms.py"
    const Vector before = {(double *)arena_copy(arena, arm->request.data, arm->request.size0), arm->request.size0};
    #line 403 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0, end_i = arm->request.size0; i < end_i; i++) {
        #line 404 "iiwa_dnn/control/arms.py"
        const double now = i < count ? inputs->request.data[i] : before.data[i];
        #line 405 "iiwa_dnn/control/arms.py"
        arm->request.data[i] = (int64_t)arm->at->reason == control_requests_Reason_NONE ? now : 0.0;
    }
    #line 406 "iiwa_dnn/control/arms.py"
    const bool known = arm->reasons.data[control_requests_Reason_Q_NOT_FINITE] == 0.0;
    #line 407 "iiwa_dnn/control/arms.py"
    arm->at->is_repeated = known && control_arms_differing(arena, arm->request, before) == 0;
    arena_leave(arena, &mark);
}

/* Take the inputs of a step into an arm's state: the part of a step before the kinematics.
 *
 * Returns:
 *     False if a stated period is not valid: nothing is then changed.
 *
 * iiwa_dnn/control/arms.py: begin_step */
static inline bool control_arms_begin_step(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory, const control_arms_ArmInput *inputs)
{
    #line 280 "iiwa_dnn/control/arms.py"
    #line 285 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 286 "iiwa_dnn/control/arms.py"
    const control_arms_ArmSettings settings = plan->settings;
    #line 287 "iiwa_dnn/control/arms.py"
    const double stated = double_max(inputs->dt, inputs->elapsed);
    #line 288 "iiwa_dnn/control/arms.py"
    const bool fits = stated < INFINITY && double_min(inputs->dt, inputs->elapsed) == 0.0;
    #line 289 "iiwa_dnn/control/arms.py"
    if (!fits || (inputs->elapsed > 0.0 && settings.at->longest == 0.0)) {
        #line 290 "iiwa_dnn/control/arms.py"
        return false;
    }
    #line 291 "iiwa_dnn/control/arms.py"
    const schemes_periods_Periods periods = schemes_periods_periods_of(arena, settings.at->dt, settings.at->longest, inputs->dt, inputs->elapsed);
    #line 292 "iiwa_dnn/control/arms.py"
    if (inputs->elapsed > 0.0) {
        #line 293 "iiwa_dnn/control/arms.py"
        const control_state_MotionState own_1 = control_arms_motion_of(arena, plan, &arm);
        control_arms_correct_last_period(arena, &arm, &own_1, inputs->elapsed);
    }
    #line 294 "iiwa_dnn/control/arms.py"
    for (int64_t own_k = 0; own_k < arm.reasons.size0; own_k++) {
        arm.reasons.data[own_k] = 0.0;
    }
    #line 295 "iiwa_dnn/control/arms.py"
    arm.reasons.data[control_requests_Reason_PERIOD_EXCEEDED] = periods.exceeded ? 1.0 : 0.0;
    #line 296 "iiwa_dnn/control/arms.py"
    control_arms_update_positions(arena, &arm, &settings, inputs);
    #line 297 "iiwa_dnn/control/arms.py"
    control_arms_update_request(arena, &arm, &settings, inputs);
    #line 298 "iiwa_dnn/control/arms.py"
    if ((int64_t)arm.at->reason != control_requests_Reason_NONE) {
        #line 299 "iiwa_dnn/control/arms.py"
        arm.reasons.data[(int64_t)arm.at->reason] = 1.0;
    }
    #line 300 "iiwa_dnn/control/arms.py"
    arm.at->period = periods.expected;
    #line 301 "iiwa_dnn/control/arms.py"
    arm.at->answered = (double)control_requests_Request_VELOCITY;
    #line 302 "iiwa_dnn/control/arms.py"
    if ((int64_t)arm.at->reason == control_requests_Reason_NONE && arm.reasons.data[control_requests_Reason_Q_NOT_FINITE] == 0.0) {
        #line 303 "iiwa_dnn/control/arms.py"
        arm.at->answered = (double)(int64_t)arm.at->kind;
    }
    #line 304 "iiwa_dnn/control/arms.py"
    if (!(arm.at->has_begun != 0.0)) {
        #line 305 "iiwa_dnn/control/arms.py"
        arm.at->answered = (double)control_requests_Request_NONE;
    }
    #line 306 "iiwa_dnn/control/arms.py"
    return true;
}

/* Write a vector (3,), given along the axes of a frame (3, 3), along the world's.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: _turn_into */
static inline void robot_kinematics_kernel_turn_into(struct arena *arena, Matrix axes, Vector v, Vector turned)
{
    (void)arena;
    #line 162 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 163 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 164 "iiwa_dnn/robot/kinematics_kernel.py"
        turned.data[i] = axes.data[i] * v.data[0] + axes.data[axes.size1 + i] * v.data[1] + axes.data[2 * axes.size1 + i] * v.data[2];
    }
}

/* Write the product of two placements.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: compose */
static inline void robot_kinematics_kernel_compose(struct arena *arena, const robot_kinematics_Placement *first, const robot_kinematics_Placement *second, const robot_kinematics_Placement *product)
{
    #line 152 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 153 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t k = 0; k < 3; k++) {
        #line 154 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_turn_into(arena, first->axes, (Vector){second->axes.data + k * second->axes.size1, second->axes.size1}, (Vector){product->axes.data + k * product->axes.size1, product->axes.size1});
    }
    #line 155 "iiwa_dnn/robot/kinematics_kernel.py"
    robot_kinematics_kernel_turn_into(arena, first->axes, second->position, product->position);
    #line 156 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 157 "iiwa_dnn/robot/kinematics_kernel.py"
        product->position.data[i] += first->position.data[i];
    }
}

/* Write the placement of a joint at position q, out of that at 0.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: _move */
static inline void robot_kinematics_kernel_move(struct arena *arena, const robot_kinematics_Placement *start, double slides, double q, const robot_kinematics_Placement *moved)
{
    #line 169 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 170 "iiwa_dnn/robot/kinematics_kernel.py"
    const double_2 own_1 = compiling_trigonometry_sin_cos(arena, (1.0 - slides) * q);
    const double sine = own_1.at[0];
    const double cosine = own_1.at[1];
    #line 171 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 172 "iiwa_dnn/robot/kinematics_kernel.py"
        const double x = start->axes.data[i];
        #line 173 "iiwa_dnn/robot/kinematics_kernel.py"
        const double y = start->axes.data[start->axes.size1 + i];
        #line 174 "iiwa_dnn/robot/kinematics_kernel.py"
        const double z = start->axes.data[2 * start->axes.size1 + i];
        #line 175 "iiwa_dnn/robot/kinematics_kernel.py"
        moved->axes.data[i] = x * cosine + y * sine;
        #line 176 "iiwa_dnn/robot/kinematics_kernel.py"
        moved->axes.data[moved->axes.size1 + i] = y * cosine - x * sine;
        #line 177 "iiwa_dnn/robot/kinematics_kernel.py"
        moved->axes.data[2 * moved->axes.size1 + i] = z;
        #line 178 "iiwa_dnn/robot/kinematics_kernel.py"
        moved->position.data[i] = start->position.data[i] + z * (slides * q);
    }
}

/* Write the twist about the world's origin of sliding along (1) or turning about (0) an axis.
 *
 * The axis is one of a placement, by its number.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: _write_twist */
static inline void robot_kinematics_kernel_write_twist(struct arena *arena, const robot_kinematics_Placement *placement, int64_t axis, double slides, const robot_kinematics_Twist *twist)
{
    (void)arena;
    #line 183 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 187 "iiwa_dnn/robot/kinematics_kernel.py"
    const double turns = 1.0 - slides;
    #line 188 "iiwa_dnn/robot/kinematics_kernel.py"
    const Vector direction = {placement->axes.data + axis * placement->axes.size1, placement->axes.size1};
    #line 189 "iiwa_dnn/robot/kinematics_kernel.py"
    const Vector position = placement->position;
    #line 190 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 191 "iiwa_dnn/robot/kinematics_kernel.py"
        twist->angular.data[i] = turns * direction.data[i];
        #line 192 "iiwa_dnn/robot/kinematics_kernel.py"
        double moment = position.data[robot_kinematics_kernel_CYCLE[i + 1]] * direction.data[robot_kinematics_kernel_CYCLE[i + 2]];
        #line 193 "iiwa_dnn/robot/kinematics_kernel.py"
        moment -= position.data[robot_kinematics_kernel_CYCLE[i + 2]] * direction.data[robot_kinematics_kernel_CYCLE[i + 1]];
        #line 194 "iiwa_dnn/robot/kinematics_kernel.py"
        twist->linear.data[i] = slides * direction.data[i] + turns * moment;
    }
}

/* Write the inertia matrix (n, n) out of the joints' placements (n + 1, 12) and twists (n, 6).
 *
 * Each body adds the products of its joints' velocities along and about its principal axes, times
 * mass and moments. No joint after the body's own moves it.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: _write_inertia */
static inline void robot_kinematics_kernel_write_inertia(struct arena *arena, const robot_kinematics_kernel_ModelTables *model, Matrix placed, Matrix jacobian, Matrix inertia)
{
    const struct arena mark = *arena;
    #line 199 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 204 "iiwa_dnn/robot/kinematics_kernel.py"
    const int64_t n = inertia.size0;
    #line 205 "iiwa_dnn/robot/kinematics_kernel.py"
    const int64_t own_1 = 12;
    const robot_kinematics_Placement own = robot_kinematics_Placement_of((Vector){(double *)arena_empty(arena, own_1), own_1});
    #line 206 "iiwa_dnn/robot/kinematics_kernel.py"
    const int64_t own_2 = 6;
    const robot_kinematics_Twist line = robot_kinematics_Twist_of((Vector){(double *)arena_empty(arena, own_2), own_2});
    #line 207 "iiwa_dnn/robot/kinematics_kernel.py"
    const Vector speeds = {(double *)arena_empty(arena, n), n};
    #line 208 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0; i < n; i++) {
        #line 209 "iiwa_dnn/robot/kinematics_kernel.py"
        for (int64_t j = 0; j < n; j++) {
            #line 210 "iiwa_dnn/robot/kinematics_kernel.py"
            inertia.data[i * inertia.size1 + j] = i == j ? model->armature.data[i] : 0.0;
        }
    }
    #line 211 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t body = 0; body < n; body++) {
        #line 212 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_kernel_PrincipalAxes principal = robot_kinematics_kernel_PrincipalAxes_of((Vector){model->bodies.data + body * model->bodies.size1, model->bodies.size1});
        #line 213 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Placement own_3 = robot_kinematics_Placement_of((Vector){placed.data + (body + 1) * placed.size1, placed.size1});
        robot_kinematics_kernel_compose(arena, &own_3, &principal.placement, &own);
        #line 214 "iiwa_dnn/robot/kinematics_kernel.py"
        for (int64_t k = 0, end_k = principal.roots.size0; k < end_k; k++) {
            #line 215 "iiwa_dnn/robot/kinematics_kernel.py"
            const double along = k < 3 ? 1.0 : 0.0;
            #line 216 "iiwa_dnn/robot/kinematics_kernel.py"
            robot_kinematics_kernel_write_twist(arena, &own, int_remainder(k, 3), 1.0 - along, &line);
            #line 217 "iiwa_dnn/robot/kinematics_kernel.py"
            for (int64_t j = 0; j < body + 1; j++) {
                #line 218 "iiwa_dnn/robot/kinematics_kernel.py"
                const robot_kinematics_Twist twist = robot_kinematics_Twist_of((Vector){jacobian.data + j * jacobian.size1, jacobian.size1});
                #line 219 "iiwa_dnn/robot/kinematics_kernel.py"
                double speed = 0.0;
                #line 220 "iiwa_dnn/robot/kinematics_kernel.py"
                for (int64_t i = 0; i < 3; i++) {
                    #line 221 "iiwa_dnn/robot/kinematics_kernel.py"
                    speed += line.angular.data[i] * twist.linear.data[i] + line.linear.data[i] * twist.angular.data[i];
                }
                #line 222 "iiwa_dnn/robot/kinematics_kernel.py"
                speeds.data[j] = model->supports.data[body * model->supports.size1 + j] * principal.roots.data[k] * speed;
            }
            #line 223 "iiwa_dnn/robot/kinematics_kernel.py"
            for (int64_t i = 0; i < body + 1; i++) {
                #line 224 "iiwa_dnn/robot/kinematics_kernel.py"
                for (int64_t j = 0; j < body + 1; j++) {
                    #line 225 "iiwa_dnn/robot/kinematics_kernel.py"
                    inertia.data[i * inertia.size1 + j] += speeds.data[i] * speeds.data[j];
                }
            }
        }
    }
    arena_leave(arena, &mark);
}

/* Write the kinematics at joint positions q (n,) [rad or m], as `Kinematics` holds them.
 *
 * Args:
 *     model: The robot's tables.
 *     q: Joint positions, (n,).
 *     jacobian: Joint Jacobian, (n, 6), overwritten.
 *     placements: Frame placements by frame index, (frames, 12); the rows of `model.frames` are
 *         overwritten.
 *     inertia: Joint-space inertia matrix [kg m^2], (n, n), overwritten if the model has bodies.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: write_kinematics */
static inline void robot_kinematics_kernel_write_kinematics(struct arena *arena, const robot_kinematics_kernel_ModelTables *model, Vector q, Matrix jacobian, Matrix placements, Matrix inertia)
{
    const struct arena mark = *arena;
    #line 121 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 131 "iiwa_dnn/robot/kinematics_kernel.py"
    const int64_t own_1 = 12;
    const Matrix placed = {(double *)arena_zeros(arena, (q.size0 + 1) * own_1), q.size0 + 1, own_1};
    #line 132 "iiwa_dnn/robot/kinematics_kernel.py"
    const robot_kinematics_Placement world = robot_kinematics_Placement_of((Vector){placed.data, placed.size1});
    #line 133 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 134 "iiwa_dnn/robot/kinematics_kernel.py"
        world.axes.data[i * world.axes.size1 + i] = 1.0;
    }
    #line 135 "iiwa_dnn/robot/kinematics_kernel.py"
    const int64_t own_2 = 12;
    const robot_kinematics_Placement start = robot_kinematics_Placement_of((Vector){(double *)arena_empty(arena, own_2), own_2});
    #line 136 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t j = 0; j < q.size0; j++) {
        #line 137 "iiwa_dnn/robot/kinematics_kernel.py"
        const double slides = model->slides.data[j];
        #line 138 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Placement here = robot_kinematics_Placement_of((Vector){placed.data + (j + 1) * placed.size1, placed.size1});
        #line 139 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Placement own_3 = robot_kinematics_Placement_of((Vector){placed.data + model->parents.data[j] * placed.size1, placed.size1});
        const robot_kinematics_Placement own_4 = robot_kinematics_Placement_of((Vector){model->joints.data + j * model->joints.size1, model->joints.size1});
        robot_kinematics_kernel_compose(arena, &own_3, &own_4, &start);
        #line 140 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_move(arena, &start, slides, q.data[j], &here);
        #line 141 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Twist own_5 = robot_kinematics_Twist_of((Vector){jacobian.data + j * jacobian.size1, jacobian.size1});
        robot_kinematics_kernel_write_twist(arena, &here, robot_kinematics_kernel_AXIS, slides, &own_5);
    }
    #line 142 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t k = 0, end_k = model->frames.size0; k < end_k; k++) {
        #line 143 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Placement carrier = robot_kinematics_Placement_of((Vector){placed.data + model->carriers.data[k] * placed.size1, placed.size1});
        #line 144 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Placement frame = robot_kinematics_Placement_of((Vector){placements.data + model->frames.data[k] * placements.size1, placements.size1});
        #line 145 "iiwa_dnn/robot/kinematics_kernel.py"
        const robot_kinematics_Placement own_6 = robot_kinematics_Placement_of((Vector){model->offsets.data + k * model->offsets.size1, model->offsets.size1});
        robot_kinematics_kernel_compose(arena, &carrier, &own_6, &frame);
    }
    #line 146 "iiwa_dnn/robot/kinematics_kernel.py"
    if (model->bodies.size0 > 0) {
        #line 147 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_write_inertia(arena, model, placed, jacobian, inertia);
    }
    arena_leave(arena, &mark);
}

/* Return views of a scene's constants (k,), for a robot with `dof` joints.
 *
 * iiwa_dnn/schemes/scene.py: scene_views */
static inline schemes_scene_SceneViews schemes_scene_scene_views(struct arena *arena, Vector constants, int64_t dof)
{
    (void)arena;
    #line 368 "iiwa_dnn/schemes/scene.py"
    #line 369 "iiwa_dnn/schemes/scene.py"
    const int64_t at_speeds = 6;
    #line 370 "iiwa_dnn/schemes/scene.py"
    const schemes_scene_SceneHead head = schemes_scene_SceneHead_of((Vector){constants.data, at_speeds});
    #line 371 "iiwa_dnn/schemes/scene.py"
    const int64_t at_bodies = at_speeds + dof;
    #line 372 "iiwa_dnn/schemes/scene.py"
    const int64_t at_pairs = at_bodies + 18 * (int64_t)head.at->bodies;
    #line 373 "iiwa_dnn/schemes/scene.py"
    const int64_t own_1 = 18;
    return (schemes_scene_SceneViews){head, {constants.data + at_speeds, at_bodies - at_speeds}, {constants.data + at_bodies, (int64_t)head.at->bodies, own_1}, {constants.data + at_pairs, (int64_t)head.at->pairs, (int64_t)head.at->pair_size}};
}

/* Write the centres of the obstacles at time t [s] into the constants (k,) of a scene.
 *
 * iiwa_dnn/control/arms.py: _place_obstacles */
static inline void control_arms_place_obstacles(struct arena *arena, const control_arms_ArmPlan *plan, const control_arms_ArmState *arm, double t, Vector constants)
{
    #line 536 "iiwa_dnn/control/arms.py"
    #line 537 "iiwa_dnn/control/arms.py"
    const Matrix bodies = schemes_scene_scene_views(arena, constants, arm->positions.size0).bodies;
    #line 538 "iiwa_dnn/control/arms.py"
    const int64_t first = bodies.size0 - arm->obstacles.size0;
    #line 539 "iiwa_dnn/control/arms.py"
    for (int64_t k = 0, end_k = arm->obstacles.size0; k < end_k; k++) {
        #line 540 "iiwa_dnn/control/arms.py"
        const schemes_scene_Body body = schemes_scene_Body_of((Vector){bodies.data + (first + k) * bodies.size1, bodies.size1});
        #line 541 "iiwa_dnn/control/arms.py"
        for (int64_t i = 0, end_i = body.center.size0; i < end_i; i++) {
            #line 542 "iiwa_dnn/control/arms.py"
            body.center.data[i] = arm->obstacles.data[k * arm->obstacles.size1 + i] + t * plan->velocities.data[k * plan->velocities.size1 + i];
        }
    }
}

/* Return the constants of part k, a view.
 *
 * iiwa_dnn/schemes/program.py: block_constants */
static inline Vector schemes_program_block_constants(struct arena *arena, const schemes_program_ProgramArrays *arrays, int64_t k)
{
    (void)arena;
    #line 106 "iiwa_dnn/schemes/program.py"
    #line 107 "iiwa_dnn/schemes/program.py"
    const int64_t start = arrays->table.data[k * arrays->table.size1 + schemes_program_Column_START];
    #line 108 "iiwa_dnn/schemes/program.py"
    return (Vector){arrays->constants.data + start, arrays->table.data[k * arrays->table.size1 + schemes_program_Column_STOP] - start};
}

/* Convert the state to a control period of dt [s]; acceleration and time to rest stay.
 *
 * Overwrites `before`, `stopping_periods` and `spacing`; before the first step only `spacing`.
 *
 * iiwa_dnn/control/state.py: change_spacing */
static inline void control_state_change_spacing(struct arena *arena, const control_state_MotionState *motion, double dt)
{
    (void)arena;
    #line 44 "iiwa_dnn/control/state.py"
    #line 48 "iiwa_dnn/control/state.py"
    if (motion->at->spacing > 0.0 && dt != motion->at->spacing) {
        #line 49 "iiwa_dnn/control/state.py"
        const double ratio = dt / motion->at->spacing;
        #line 50 "iiwa_dnn/control/state.py"
        for (int64_t i = 0, end_i = motion->last.size0; i < end_i; i++) {
            #line 51 "iiwa_dnn/control/state.py"
            motion->before.data[i] = motion->last.data[i] - ratio * (motion->last.data[i] - motion->before.data[i]);
        }
        #line 52 "iiwa_dnn/control/state.py"
        motion->at->stopping_periods = motion->at->stopping_periods / ratio;
    }
    #line 53 "iiwa_dnn/control/state.py"
    motion->at->spacing = dt;
}

/* Count the numbers of a program, `QP.data`.
 *
 * iiwa_dnn/qp/layout.py: data_size */
static inline int64_t qp_layout_data_size(struct arena *arena, int64_t n, int64_t m, int64_t p)
{
    (void)arena;
    #line 37 "iiwa_dnn/qp/layout.py"
    #line 38 "iiwa_dnn/qp/layout.py"
    return (n + m + p) * (n + 1) + 2 * n;
}

/* Return ``(joints, program, point, sides, pairs, frames)``, the sizes of a `StepLog`.
 *
 * iiwa_dnn/control/command.py: log_sizes */
static inline int_6 control_command_log_sizes(struct arena *arena, const schemes_program_ProgramSizes *sizes)
{
    #line 87 "iiwa_dnn/control/command.py"
    #line 88 "iiwa_dnn/control/command.py"
    const int64_t program = qp_layout_data_size(arena, sizes->n, sizes->m, sizes->p);
    #line 89 "iiwa_dnn/control/command.py"
    const int64_t sides = sizes->n + sizes->m;
    #line 90 "iiwa_dnn/control/command.py"
    const int64_t point = sides + sizes->n + sizes->p;
    #line 91 "iiwa_dnn/control/command.py"
    return (int_6){{sizes->joints, program, point, sides, sizes->pairs, sizes->frames}};
}

/* View the numbers of a step log, (width,), as a `StepLog`.
 *
 * iiwa_dnn/control/command.py: log_of */
static inline control_command_StepLog control_command_log_of(struct arena *arena, Vector data, const schemes_program_ProgramSizes *sizes)
{
    #line 96 "iiwa_dnn/control/command.py"
    #line 97 "iiwa_dnn/control/command.py"
    const int_6 own_1 = control_command_log_sizes(arena, sizes);
    const int64_t joints = own_1.at[0];
    const int64_t program = own_1.at[1];
    const int64_t point = own_1.at[2];
    const int64_t sides = own_1.at[3];
    const int64_t pairs = own_1.at[4];
    const int64_t frames = own_1.at[5];
    #line 98 "iiwa_dnn/control/command.py"
    return control_command_StepLog_of(data, joints, program, point, sides, pairs, frames);
}

/* Return the larger of two numbers; unlike with max(), a NaN once seen stays.
 *
 * iiwa_dnn/qp/layout.py: larger */
static inline double qp_layout_larger(struct arena *arena, double largest, double value)
{
    (void)arena;
    #line 102 "iiwa_dnn/qp/layout.py"
    #line 103 "iiwa_dnn/qp/layout.py"
    return value > largest || value != value ? value : largest;
}

/* Return the largest absolute value of an array (k,); NaN if one is NaN.
 *
 * iiwa_dnn/qp/dense.py: largest_entry */
static inline double qp_dense_largest_entry(struct arena *arena, Vector values)
{
    #line 59 "iiwa_dnn/qp/dense.py"
    #line 60 "iiwa_dnn/qp/dense.py"
    double largest = 0.0;
    #line 61 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < values.size0; i++) {
        #line 62 "iiwa_dnn/qp/dense.py"
        largest = qp_layout_larger(arena, largest, fabs(values.data[i]));
    }
    #line 63 "iiwa_dnn/qp/dense.py"
    return largest;
}

/* Return the rate limits of joint i.
 *
 * iiwa_dnn/schemes/rate_limits.py: joint_rates */
static inline schemes_profiles_Rates schemes_rate_limits_joint_rates(struct arena *arena, const schemes_rate_limits_MotionConstants *limits, int64_t i)
{
    (void)arena;
    #line 142 "iiwa_dnn/schemes/rate_limits.py"
    #line 143 "iiwa_dnn/schemes/rate_limits.py"
    return (schemes_profiles_Rates){limits->velocity.data[i], limits->acceleration.data[i], limits->jerk.data[i], limits->deceleration.data[i], limits->slope.data[i], limits->lag.data[i]};
}

/* Compute the jerk J' [rad/s^3] of stopping paths, for a control period [s].
 *
 * It is at most the jerk limit, and so small that the deceleration takes `JERK_PERIODS` periods to
 * build up.
 *
 * iiwa_dnn/schemes/profiles.py: usable_jerk */
static inline double schemes_profiles_usable_jerk(struct arena *arena, const schemes_profiles_Rates *rates, double period)
{
    (void)arena;
    #line 62 "iiwa_dnn/schemes/profiles.py"
    #line 67 "iiwa_dnn/schemes/profiles.py"
    const double steepest = double_min(rates->deceleration / period, rates->velocity / (period * period));
    #line 68 "iiwa_dnn/schemes/profiles.py"
    return double_min(rates->jerk, steepest / schemes_profiles_JERK_PERIODS);
}

/* Compute the largest speed from which a joint can brake within a distance.
 *
 * Units make the deceleration and the period 1: the speed falls by 1 a period, and the joint
 * travels x + (x - 1) + (x - 2) + ... > 0 from the speed x. Where periods vary, the law is
 * x + x^2 / 2, which is at least that sum for periods of any length up to 1.
 *
 * Args:
 *     distance: The distance; below 0 it is returned itself.
 *     vary: Whether periods vary.
 *
 * iiwa_dnn/schemes/profiles.py: approach */
static inline double schemes_profiles_approach(struct arena *arena, double distance, bool vary)
{
    (void)arena;
    #line 73 "iiwa_dnn/schemes/profiles.py"
    #line 83 "iiwa_dnn/schemes/profiles.py"
    if (!(distance > 0.0) || distance == INFINITY) {
        #line 84 "iiwa_dnn/schemes/profiles.py"
        return distance;
    }
    #line 85 "iiwa_dnn/schemes/profiles.py"
    if (vary) {
        #line 86 "iiwa_dnn/schemes/profiles.py"
        return 2.0 * distance / (sqrt(1.0 + 2.0 * distance) + 1.0);
    }
    #line 87 "iiwa_dnn/schemes/profiles.py"
    const int64_t m = int_floor(0.5 * (sqrt(1.0 + 8.0 * distance) - 1.0));
    #line 88 "iiwa_dnn/schemes/profiles.py"
    return distance / ((double)m + 1.0) + 0.5 * (double)m;
}

/* Compute the distance [rad] in which a spline comes to rest.
 *
 * Args:
 *     v: Velocity [rad/s], at least -a |a| / (2 J), so that the joint does not turn round.
 *     a: Acceleration [rad/s^2].
 *     J: Jerk [rad/s^3].
 *     A: Deceleration at which it brakes [rad/s^2]; -a where that is more.
 *
 * iiwa_dnn/schemes/profiles.py: stopping_distance */
static inline double schemes_profiles_stopping_distance(struct arena *arena, double v, double a, double J, double A)
{
    (void)arena;
    #line 93 "iiwa_dnn/schemes/profiles.py"
    #line 101 "iiwa_dnn/schemes/profiles.py"
    const double deepest = double_max(A, -a);
    #line 102 "iiwa_dnn/schemes/profiles.py"
    const double square = double_max(J * v + 0.5 * a * a, 0.0);
    #line 103 "iiwa_dnn/schemes/profiles.py"
    const double d = double_min(sqrt(square), deepest);
    #line 104 "iiwa_dnn/schemes/profiles.py"
    const double T = (a + d) / J;
    #line 105 "iiwa_dnn/schemes/profiles.py"
    double distance = T * (v + T * (0.5 * a - J * T / 6.0)) + d * d * d / (6.0 * J * J);
    #line 106 "iiwa_dnn/schemes/profiles.py"
    if (square > d * d) {
        #line 107 "iiwa_dnn/schemes/profiles.py"
        v += 0.5 * (a * a - d * d) / J;
        #line 108 "iiwa_dnn/schemes/profiles.py"
        const double h = 0.5 * d * d / J;
        #line 109 "iiwa_dnn/schemes/profiles.py"
        distance += (v - h) * (v + h) / (2.0 * d);
    }
    #line 110 "iiwa_dnn/schemes/profiles.py"
    return distance;
}

/* Compute how far the stopping path after command v goes beyond the present position [rad].
 *
 * Args:
 *     v: Command [rad/s].
 *     last: The command before it [rad/s].
 *     periods: Periods of the step.
 *     profile: Jerk J [rad/s^3]; deceleration A [rad/s^2]; and the largest deceleration that the
 *         joint is taken to have at present [rad/s^2], inf for the one that it has.
 *
 * iiwa_dnn/schemes/profiles.py: highest */
static inline double schemes_profiles_highest(struct arena *arena, double v, double last, const schemes_periods_Periods *periods, double_3 profile)
{
    #line 115 "iiwa_dnn/schemes/profiles.py"
    #line 124 "iiwa_dnn/schemes/profiles.py"
    const double_3 own_1 = profile;
    const double J = own_1.at[0];
    const double A = own_1.at[1];
    const double most = own_1.at[2];
    #line 125 "iiwa_dnn/schemes/profiles.py"
    last = double_min(last, v + most * periods->dt);
    #line 126 "iiwa_dnn/schemes/profiles.py"
    const double dt = periods->dt;
    #line 127 "iiwa_dnn/schemes/profiles.py"
    const double a = (v - last) / dt;
    #line 128 "iiwa_dnn/schemes/profiles.py"
    double start = dt * dt * a / 6.0;
    #line 129 "iiwa_dnn/schemes/profiles.py"
    double speed = 0.5 * (v + last);
    #line 130 "iiwa_dnn/schemes/profiles.py"
    if (periods->vary) {
        #line 131 "iiwa_dnn/schemes/profiles.py"
        speed = v;
        #line 132 "iiwa_dnn/schemes/profiles.py"
        start = periods->hold * v;
        #line 133 "iiwa_dnn/schemes/profiles.py"
        if (periods->hold >= periods->longest) {
            #line 135 "iiwa_dnn/schemes/profiles.py"
            const double growth = double_max(a, 0.0);
            #line 136 "iiwa_dnn/schemes/profiles.py"
            start = periods->hold * double_max(v + 0.5 * growth * growth / J, 0.0);
        }
    }
    #line 137 "iiwa_dnn/schemes/profiles.py"
    if (speed + 0.5 * a * fabs(a) / J >= 0.0) {
        #line 138 "iiwa_dnn/schemes/profiles.py"
        return start + double_max(0.0, schemes_profiles_stopping_distance(arena, speed, a, J, A));
    }
    #line 139 "iiwa_dnn/schemes/profiles.py"
    if (speed <= 0.0) {
        #line 140 "iiwa_dnn/schemes/profiles.py"
        return start;
    }
    #line 141 "iiwa_dnn/schemes/profiles.py"
    const double T = -(a + sqrt(double_max(a * a - 2.0 * J * speed, 0.0))) / J;
    #line 142 "iiwa_dnn/schemes/profiles.py"
    return start + T * (speed + T * (0.5 * a + J * T / 6.0));
}

/* Compute the largest command in [lb, ub] whose stopping path stays up to `end` [rad].
 *
 * It is lb if there is none. `end` is relative to the present position; `last`, `periods` and
 * `profile` are those of `highest`.
 *
 * iiwa_dnn/schemes/viability.py: _ceiling */
static inline double schemes_viability_ceiling(struct arena *arena, double lb, double ub, double end, double last, const schemes_periods_Periods *periods, double_3 profile)
{
    #line 227 "iiwa_dnn/schemes/viability.py"
    #line 232 "iiwa_dnn/schemes/viability.py"
    if (schemes_profiles_highest(arena, ub, last, periods, profile) <= end) {
        #line 233 "iiwa_dnn/schemes/viability.py"
        return ub;
    }
    #line 234 "iiwa_dnn/schemes/viability.py"
    for (int64_t _ = 0; _ < schemes_viability_HALVINGS; _++) {
        #line 235 "iiwa_dnn/schemes/viability.py"
        const double middle = 0.5 * (lb + ub);
        #line 236 "iiwa_dnn/schemes/viability.py"
        if (schemes_profiles_highest(arena, middle, last, periods, profile) <= end) {
            #line 237 "iiwa_dnn/schemes/viability.py"
            lb = middle;
        } else {
            #line 239 "iiwa_dnn/schemes/viability.py"
            ub = middle;
        }
    }
    #line 240 "iiwa_dnn/schemes/viability.py"
    return lb;
}

/* Compute the largest command in [lb, ub] below a position-dependent velocity limit.
 *
 * It is lb if there is none. The stopping paths are those of `LEVELS` decelerations B, each of
 * which ends before the point at which the limit is zero, as the head of this file says.
 *
 * Args:
 *     lb: Lower bound [rad/s].
 *     ub: Upper bound [rad/s].
 *     distance: Distance to that point [rad].
 *     last: Last command [rad/s].
 *     rates: Limits of the joint.
 *     periods: Periods of the step.
 *
 * iiwa_dnn/schemes/viability.py: _ceiling_below_velocity_limit */
static inline double schemes_viability_ceiling_below_velocity_limit(struct arena *arena, double lb, double ub, double distance, double last, const schemes_profiles_Rates *rates, const schemes_periods_Periods *periods)
{
    #line 247 "iiwa_dnn/schemes/viability.py"
    #line 261 "iiwa_dnn/schemes/viability.py"
    const schemes_periods_Periods own = {periods->dt, periods->expected, periods->hold, periods->longest, periods->fraction, true, periods->exceeded};
    #line 270 "iiwa_dnn/schemes/viability.py"
    double deceleration = rates->deceleration;
    #line 271 "iiwa_dnn/schemes/viability.py"
    const double J = schemes_profiles_usable_jerk(arena, rates, periods->longest);
    #line 272 "iiwa_dnn/schemes/viability.py"
    for (int64_t level = 0; level < schemes_viability_LEVELS; level++) {
        #line 273 "iiwa_dnn/schemes/viability.py"
        const double A = double_min(deceleration, rates->acceleration - J * periods->longest);
        #line 274 "iiwa_dnn/schemes/viability.py"
        const double end = distance - 0.5 * rates->lag * rates->lag * rates->slope * A / (rates->slope - A);
        #line 276 "iiwa_dnn/schemes/viability.py"
        const double_3 profile = {{J, A, A}};
        #line 277 "iiwa_dnn/schemes/viability.py"
        if (level == 0 || schemes_profiles_highest(arena, lb, last, &own, profile) <= end) {
            #line 278 "iiwa_dnn/schemes/viability.py"
            lb = schemes_viability_ceiling(arena, lb, ub, end, last, &own, profile);
        }
        #line 279 "iiwa_dnn/schemes/viability.py"
        deceleration *= schemes_viability_LOWER;
    }
    #line 280 "iiwa_dnn/schemes/viability.py"
    return lb;
}

/* Compute the velocity [rad/s] that covers `EASE` of a distance [rad] in the time `hold` [s].
 *
 * It is 0 where the distance is rounding.
 *
 * iiwa_dnn/schemes/profiles.py: easing */
static inline double schemes_profiles_easing(struct arena *arena, double distance, double hold)
{
    (void)arena;
    #line 195 "iiwa_dnn/schemes/profiles.py"
    #line 199 "iiwa_dnn/schemes/profiles.py"
    if (fabs(distance) <= schemes_profiles_ROUNDING) {
        #line 200 "iiwa_dnn/schemes/profiles.py"
        return 0.0;
    }
    #line 201 "iiwa_dnn/schemes/profiles.py"
    return schemes_profiles_EASE * distance / hold;
}

/* Return the `LimitKind` of a bound: velocity, acceleration, or else `other`.
 *
 * Args:
 *     bound: The bound [rad/s].
 *     speed: Bound of the velocity limit [rad/s].
 *     quickest: Bound of the acceleration limit [rad/s].
 *     other: `LimitKind` of a bound that is neither.
 *
 * iiwa_dnn/schemes/viability.py: _rate_kind */
static inline double schemes_viability_rate_kind(struct arena *arena, double bound, double speed, double quickest, double other)
{
    (void)arena;
    #line 105 "iiwa_dnn/schemes/viability.py"
    #line 113 "iiwa_dnn/schemes/viability.py"
    if (bound == speed) {
        #line 114 "iiwa_dnn/schemes/viability.py"
        return (double)naming_LimitKind_VELOCITY;
    }
    #line 115 "iiwa_dnn/schemes/viability.py"
    return bound == quickest ? (double)naming_LimitKind_ACCELERATION : other;
}

/* Return the `LimitKind` of the limit by which a joint brakes before the end of its range.
 *
 * iiwa_dnn/schemes/viability.py: _position_kind */
static inline double schemes_viability_position_kind(struct arena *arena, const schemes_profiles_Rates *rates)
{
    (void)arena;
    #line 99 "iiwa_dnn/schemes/viability.py"
    #line 100 "iiwa_dnn/schemes/viability.py"
    return (double)(rates->lag > 0.0 ? naming_LimitKind_POSITION_DEPENDENT_VELOCITY : naming_LimitKind_POSITION);
}

/* Compute `joint_bounds` of a joint with a jerk limit.
 *
 * iiwa_dnn/schemes/viability.py: _jerk_bounds */
static inline double_4 schemes_viability_jerk_bounds(struct arena *arena, double last, double before, double above, double below, const schemes_profiles_Rates *rates, const schemes_periods_Periods *periods)
{
    #line 169 "iiwa_dnn/schemes/viability.py"
    #line 170 "iiwa_dnn/schemes/viability.py"
    const double fastest = rates->velocity;
    #line 171 "iiwa_dnn/schemes/viability.py"
    const double accel = rates->acceleration;
    #line 172 "iiwa_dnn/schemes/viability.py"
    const double dt = periods->dt;
    #line 173 "iiwa_dnn/schemes/viability.py"
    const double longest = periods->longest;
    #line 174 "iiwa_dnn/schemes/viability.py"
    const double slowest = last - accel * dt;
    #line 175 "iiwa_dnn/schemes/viability.py"
    const double quickest = last + accel * dt;
    #line 178 "iiwa_dnn/schemes/viability.py"
    const double bottom = double_min(-fastest, quickest);
    #line 179 "iiwa_dnn/schemes/viability.py"
    const double top = double_max(fastest, slowest);
    #line 180 "iiwa_dnn/schemes/viability.py"
    const double middle = double_min(double_max(2.0 * last - before, slowest), quickest);
    #line 181 "iiwa_dnn/schemes/viability.py"
    const double change = rates->jerk * dt * dt;
    #line 182 "iiwa_dnn/schemes/viability.py"
    const double first = double_min(double_max(double_max(slowest, middle - change), bottom), top);
    #line 183 "iiwa_dnn/schemes/viability.py"
    const double final = double_min(double_max(double_min(quickest, middle + change), bottom), top);
    #line 184 "iiwa_dnn/schemes/viability.py"
    const double jerk = schemes_profiles_usable_jerk(arena, rates, longest);
    #line 185 "iiwa_dnn/schemes/viability.py"
    const double unit = jerk * dt * dt;
    #line 186 "iiwa_dnn/schemes/viability.py"
    const bool vary = periods->vary || rates->lag > 0.0;
    #line 187 "iiwa_dnn/schemes/viability.py"
    const double down = last - unit * schemes_profiles_approach(arena, (last + fastest) / unit, vary);
    #line 188 "iiwa_dnn/schemes/viability.py"
    const double up = last + unit * schemes_profiles_approach(arena, (fastest - last) / unit, vary);
    #line 189 "iiwa_dnn/schemes/viability.py"
    double lb = double_min(double_max(down, first), final);
    #line 190 "iiwa_dnn/schemes/viability.py"
    double ub = double_min(double_max(up, first), final);
    #line 191 "iiwa_dnn/schemes/viability.py"
    if (lb > ub) {
        #line 192 "iiwa_dnn/schemes/viability.py"
        lb = 0.5 * (lb + ub);
        #line 193 "iiwa_dnn/schemes/viability.py"
        ub = lb;
    }
    #line 194 "iiwa_dnn/schemes/viability.py"
    const double_3 profile = {{jerk, double_min(rates->deceleration, accel - jerk * longest), INFINITY}};
    #line 195 "iiwa_dnn/schemes/viability.py"
    const double margin = periods->vary ? 0.0 : schemes_viability_MARGIN * unit * dt;
    #line 196 "iiwa_dnn/schemes/viability.py"
    double lower;
    double upper;
    if (rates->lag > 0.0) {
        #line 197 "iiwa_dnn/schemes/viability.py"
        upper = schemes_viability_ceiling_below_velocity_limit(arena, lb, ub, above, last, rates, periods);
        #line 198 "iiwa_dnn/schemes/viability.py"
        lower = -schemes_viability_ceiling_below_velocity_limit(arena, -ub, -lb, below, -last, rates, periods);
    } else {
        #line 200 "iiwa_dnn/schemes/viability.py"
        upper = schemes_viability_ceiling(arena, lb, ub, above - margin, last, periods, profile);
        #line 201 "iiwa_dnn/schemes/viability.py"
        lower = -schemes_viability_ceiling(arena, -ub, -lb, below - margin, -last, periods, profile);
    }
    #line 202 "iiwa_dnn/schemes/viability.py"
    if (lower < upper && double_max(fabs(last), fabs(last - before)) < unit) {
        #line 205 "iiwa_dnn/schemes/viability.py"
        const double rest = periods->vary ? 0.0 : schemes_viability_REST * unit * dt;
        #line 206 "iiwa_dnn/schemes/viability.py"
        const double eased = double_max(double_min(upper, double_max(schemes_profiles_easing(arena, above - rest, periods->hold), lb)), lower);
        #line 207 "iiwa_dnn/schemes/viability.py"
        lower = double_min(double_max(lower, double_min(-schemes_profiles_easing(arena, below - rest, periods->hold), ub)), eased);
        #line 208 "iiwa_dnn/schemes/viability.py"
        upper = eased;
    }
    #line 209 "iiwa_dnn/schemes/viability.py"
    double lower_kind = schemes_viability_rate_kind(arena, lb, down, slowest, (double)naming_LimitKind_JERK);
    #line 210 "iiwa_dnn/schemes/viability.py"
    double upper_kind = schemes_viability_rate_kind(arena, ub, up, quickest, (double)naming_LimitKind_JERK);
    #line 211 "iiwa_dnn/schemes/viability.py"
    if (lower != lb) {
        #line 212 "iiwa_dnn/schemes/viability.py"
        lower_kind = schemes_viability_position_kind(arena, rates);
    }
    #line 213 "iiwa_dnn/schemes/viability.py"
    if (upper != ub) {
        #line 214 "iiwa_dnn/schemes/viability.py"
        upper_kind = schemes_viability_position_kind(arena, rates);
    }
    #line 215 "iiwa_dnn/schemes/viability.py"
    return (double_4){{lower, upper, lower_kind, upper_kind}};
}

/* Compute the largest velocity [rad/s] below a position-dependent velocity limit.
 *
 * Args:
 *     distance: Distance to the position at which that limit is zero [rad].
 *     rates: Limits of the joint, which brakes with at most its acceleration limit.
 *     hold: Time for which the velocity may be held before the joint brakes [s].
 *
 * iiwa_dnn/schemes/viability.py: _speed_within */
static inline double schemes_viability_speed_within(struct arena *arena, double distance, const schemes_profiles_Rates *rates, double hold)
{
    #line 145 "iiwa_dnn/schemes/viability.py"
    #line 152 "iiwa_dnn/schemes/viability.py"
    const double accel = rates->acceleration;
    #line 153 "iiwa_dnn/schemes/viability.py"
    const double slope = rates->slope;
    #line 154 "iiwa_dnn/schemes/viability.py"
    const double lag = rates->lag;
    #line 155 "iiwa_dnn/schemes/viability.py"
    double unit = slope * (hold + lag);
    #line 156 "iiwa_dnn/schemes/viability.py"
    double speed = unit * schemes_profiles_approach(arena, distance / (unit * (hold + lag)), true);
    #line 158 "iiwa_dnn/schemes/viability.py"
    const double turn = slope > accel ? accel * lag * slope / (slope - accel) : INFINITY;
    #line 159 "iiwa_dnn/schemes/viability.py"
    if (speed > turn) {
        #line 160 "iiwa_dnn/schemes/viability.py"
        unit = accel * hold;
        #line 161 "iiwa_dnn/schemes/viability.py"
        speed = unit * schemes_profiles_approach(arena, (distance - 0.5 * turn * lag) / (unit * hold), true);
    }
    #line 162 "iiwa_dnn/schemes/viability.py"
    return speed;
}

/* Compute `joint_bounds` of a joint with an acceleration limit and no jerk limit.
 *
 * iiwa_dnn/schemes/viability.py: _acceleration_bounds */
static inline double_4 schemes_viability_acceleration_bounds(struct arena *arena, double last, double above, double below, const schemes_profiles_Rates *rates, const schemes_periods_Periods *periods)
{
    #line 122 "iiwa_dnn/schemes/viability.py"
    #line 123 "iiwa_dnn/schemes/viability.py"
    const double fastest = rates->velocity;
    #line 124 "iiwa_dnn/schemes/viability.py"
    const double first = last - rates->acceleration * periods->dt;
    #line 125 "iiwa_dnn/schemes/viability.py"
    const double final = last + rates->acceleration * periods->dt;
    #line 126 "iiwa_dnn/schemes/viability.py"
    above -= double_min(double_max(above, 0.0), schemes_profiles_ROUNDING);
    #line 127 "iiwa_dnn/schemes/viability.py"
    below -= double_min(double_max(below, 0.0), schemes_profiles_ROUNDING);
    #line 129 "iiwa_dnn/schemes/viability.py"
    double lower;
    double upper;
    if (rates->lag > 0.0) {
        #line 130 "iiwa_dnn/schemes/viability.py"
        upper = schemes_viability_speed_within(arena, above, rates, periods->hold);
        #line 131 "iiwa_dnn/schemes/viability.py"
        lower = -schemes_viability_speed_within(arena, below, rates, periods->hold);
    } else {
        #line 133 "iiwa_dnn/schemes/viability.py"
        const double unit = rates->deceleration * periods->hold;
        #line 134 "iiwa_dnn/schemes/viability.py"
        upper = unit * schemes_profiles_approach(arena, above / (unit * periods->hold), periods->vary);
        #line 135 "iiwa_dnn/schemes/viability.py"
        lower = -unit * schemes_profiles_approach(arena, below / (unit * periods->hold), periods->vary);
    }
    #line 136 "iiwa_dnn/schemes/viability.py"
    lower = double_min(double_max(double_min(double_max(lower, -fastest), fastest), first), final);
    #line 137 "iiwa_dnn/schemes/viability.py"
    upper = double_min(double_max(double_min(double_max(upper, -fastest), fastest), first), final);
    #line 138 "iiwa_dnn/schemes/viability.py"
    const double position = schemes_viability_position_kind(arena, rates);
    #line 139 "iiwa_dnn/schemes/viability.py"
    const double lower_kind = schemes_viability_rate_kind(arena, lower, -fastest, first, position);
    #line 140 "iiwa_dnn/schemes/viability.py"
    return (double_4){{lower, upper, lower_kind, schemes_viability_rate_kind(arena, upper, fastest, final, position)}};
}

/* Compute the bounds of one joint's next command and their kinds, with lower <= upper.
 *
 * Between the bounds acceleration and jerk are within their limits, whatever the state is.
 *
 * Args:
 *     last: Last command [rad/s].
 *     before: Command before it [rad/s].
 *     above: Distance to the upper position limit [rad].
 *     below: Distance to the lower position limit [rad].
 *     rates: Limits of the joint.
 *     periods: Periods of the step.
 *
 * Returns:
 *     Lower and upper bound [rad/s], and the `LimitKind` of each; -inf and inf for a joint without
 *     acceleration and jerk limits.
 *
 * iiwa_dnn/schemes/viability.py: joint_bounds */
static inline double_4 schemes_viability_joint_bounds(struct arena *arena, double last, double before, double above, double below, const schemes_profiles_Rates *rates, const schemes_periods_Periods *periods)
{
    #line 61 "iiwa_dnn/schemes/viability.py"
    #line 77 "iiwa_dnn/schemes/viability.py"
    above *= periods->fraction;
    #line 78 "iiwa_dnn/schemes/viability.py"
    below *= periods->fraction;
    #line 79 "iiwa_dnn/schemes/viability.py"
    double high_kind;
    double low_kind;
    double lower;
    double upper;
    if (rates->jerk < INFINITY) {
        #line 80 "iiwa_dnn/schemes/viability.py"
        const double_4 own_1 = schemes_viability_jerk_bounds(arena, last, before, above, below, rates, periods);
        lower = own_1.at[0];
        upper = own_1.at[1];
        low_kind = own_1.at[2];
        high_kind = own_1.at[3];
    } else {
        #line 81 "iiwa_dnn/schemes/viability.py"
        if (rates->acceleration < INFINITY) {
            #line 82 "iiwa_dnn/schemes/viability.py"
            const double_4 own_2 = schemes_viability_acceleration_bounds(arena, last, above, below, rates, periods);
            lower = own_2.at[0];
            upper = own_2.at[1];
            low_kind = own_2.at[2];
            high_kind = own_2.at[3];
        } else {
            #line 84 "iiwa_dnn/schemes/viability.py"
            return (double_4){{-INFINITY, INFINITY, (double)naming_LimitKind_VELOCITY, (double)naming_LimitKind_VELOCITY}};
        }
    }
    #line 85 "iiwa_dnn/schemes/viability.py"
    if (lower <= upper) {
        #line 86 "iiwa_dnn/schemes/viability.py"
        return (double_4){{lower, upper, low_kind, high_kind}};
    }
    #line 89 "iiwa_dnn/schemes/viability.py"
    double command = 0.5 * (lower + upper);
    #line 90 "iiwa_dnn/schemes/viability.py"
    if (above < 0.0) {
        #line 91 "iiwa_dnn/schemes/viability.py"
        command = lower;
    } else {
        #line 92 "iiwa_dnn/schemes/viability.py"
        if (below < 0.0) {
            #line 93 "iiwa_dnn/schemes/viability.py"
            command = upper;
        }
    }
    #line 94 "iiwa_dnn/schemes/viability.py"
    return (double_4){{command, command, low_kind, high_kind}};
}

/* Compute the command [rad/s] with which a joint comes to rest exactly at a position.
 *
 * Near the position that is `easing`, if the jerk and acceleration limits admit it in this period
 * and in the next one; else it is the wanted velocity.
 *
 * Args:
 *     last: Last command [rad/s].
 *     before: Command before it [rad/s].
 *     left: Position less the present one [rad].
 *     wanted: Velocity towards the position, within all limits [rad/s].
 *     rates: Limits of the joint.
 *     periods: Periods of the step.
 *
 * iiwa_dnn/schemes/profiles.py: arriving */
static inline double schemes_profiles_arriving(struct arena *arena, double last, double before, double left, double wanted, const schemes_profiles_Rates *rates, const schemes_periods_Periods *periods)
{
    #line 169 "iiwa_dnn/schemes/profiles.py"
    #line 182 "iiwa_dnn/schemes/profiles.py"
    const double accel = rates->acceleration;
    #line 183 "iiwa_dnn/schemes/profiles.py"
    const double jerk = rates->jerk;
    #line 184 "iiwa_dnn/schemes/profiles.py"
    const double dt = periods->dt;
    #line 185 "iiwa_dnn/schemes/profiles.py"
    const double eased = schemes_profiles_easing(arena, left, periods->hold);
    #line 186 "iiwa_dnn/schemes/profiles.py"
    const double turn = double_max(fabs(eased - 2.0 * last + before), fabs((schemes_profiles_EASE + 1.0) * eased - last));
    #line 187 "iiwa_dnn/schemes/profiles.py"
    const double most = double_min(jerk * dt * dt, accel * dt);
    #line 188 "iiwa_dnn/schemes/profiles.py"
    if (jerk < INFINITY && double_max(turn, fabs(eased)) <= most && fabs(eased - last) <= accel * dt) {
        #line 189 "iiwa_dnn/schemes/profiles.py"
        return eased;
    }
    #line 190 "iiwa_dnn/schemes/profiles.py"
    return wanted;
}

/* Compute the command in [lb, ub] [rad/s] with which a joint comes to rest soonest.
 *
 * The joint does not turn round, unless the bounds make it.
 *
 * Args:
 *     last: Last command [rad/s].
 *     lb: Lower bound [rad/s].
 *     ub: Upper bound [rad/s].
 *     jerk: Jerk limit [rad/s^3]; inf for none.
 *     periods: Periods of the step.
 *
 * iiwa_dnn/schemes/profiles.py: braking */
static inline double schemes_profiles_braking(struct arena *arena, double last, double lb, double ub, double jerk, const schemes_periods_Periods *periods)
{
    #line 147 "iiwa_dnn/schemes/profiles.py"
    #line 158 "iiwa_dnn/schemes/profiles.py"
    double wanted = 0.0;
    #line 159 "iiwa_dnn/schemes/profiles.py"
    const double unit = jerk * periods->dt * periods->dt;
    #line 160 "iiwa_dnn/schemes/profiles.py"
    if (jerk < INFINITY && fabs(last) > schemes_profiles_AT_REST) {
        #line 161 "iiwa_dnn/schemes/profiles.py"
        wanted = last - copysign(unit * schemes_profiles_approach(arena, fabs(last) / unit, periods->vary), last);
    }
    #line 162 "iiwa_dnn/schemes/profiles.py"
    return double_min(double_max(wanted, lb), ub);
}

/* Write the next velocities dq (n,) [rad/s] of the joints on their way to the request.
 *
 * For requested positions each joint takes the largest velocity from which it can still come to
 * rest there. A joint that cannot reach its requested velocity in this step because of a jerk
 * limit, or whose request is that of the step before, approaches it without overshoot.
 *
 * Args:
 *     arm: The arm, with its request.
 *     motion: The last commands.
 *     limits: Limits of the joints.
 *     periods: Periods of the step.
 *     dq: The velocities, or longer, overwritten.
 *
 * iiwa_dnn/control/arms.py: approach_request */
static inline void control_arms_approach_request(struct arena *arena, const control_arms_ArmState *arm, const control_state_MotionState *motion, const schemes_rate_limits_MotionConstants *limits, const schemes_periods_Periods *periods, Vector dq)
{
    #line 549 "iiwa_dnn/control/arms.py"
    #line 562 "iiwa_dnn/control/arms.py"
    const bool reaches = (int64_t)arm->at->answered == control_requests_Request_POSITION;
    #line 563 "iiwa_dnn/control/arms.py"
    const bool brakes = arm->reasons.data[control_requests_Reason_Q_NOT_FINITE] != 0.0;
    #line 564 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0, end_i = arm->positions.size0; i < end_i; i++) {
        #line 565 "iiwa_dnn/control/arms.py"
        const double last = motion->last.data[i];
        #line 566 "iiwa_dnn/control/arms.py"
        const double before = motion->before.data[i];
        #line 567 "iiwa_dnn/control/arms.py"
        double wanted = brakes ? 0.0 : arm->request.data[i];
        #line 568 "iiwa_dnn/control/arms.py"
        const double left = wanted - arm->positions.data[i];
        #line 569 "iiwa_dnn/control/arms.py"
        double above = limits->upper.data[i] - arm->positions.data[i];
        #line 570 "iiwa_dnn/control/arms.py"
        double below = arm->positions.data[i] - limits->lower.data[i];
        #line 571 "iiwa_dnn/control/arms.py"
        schemes_profiles_Rates rates = schemes_rate_limits_joint_rates(arena, limits, i);
        #line 572 "iiwa_dnn/control/arms.py"
        const double most = control_requests_CUT * double_min(rates.velocity, control_requests_FASTEST);
        #line 573 "iiwa_dnn/control/arms.py"
        if (reaches) {
            #line 574 "iiwa_dnn/control/arms.py"
            above = left >= 0.0 ? left : INFINITY;
            #line 575 "iiwa_dnn/control/arms.py"
            below = left < 0.0 ? -left : INFINITY;
            #line 576 "iiwa_dnn/control/arms.py"
            const double accel = rates.acceleration;
            #line 577 "iiwa_dnn/control/arms.py"
            rates = (schemes_profiles_Rates){rates.velocity, accel, rates.jerk, accel, INFINITY, 0.0};
            #line 578 "iiwa_dnn/control/arms.py"
            wanted = double_min(double_max(left / periods->hold, -most), most);
        } else {
            #line 579 "iiwa_dnn/control/arms.py"
            if (fabs(wanted) > most) {
                #line 580 "iiwa_dnn/control/arms.py"
                wanted = copysign(most, wanted);
                #line 581 "iiwa_dnn/control/arms.py"
                arm->reasons.data[control_requests_Reason_CUT] = 1.0;
            }
        }
        #line 582 "iiwa_dnn/control/arms.py"
        const double_4 own_1 = schemes_viability_joint_bounds(arena, last, before, above, below, &rates, periods);
        const double lower = own_1.at[0];
        const double upper = own_1.at[1];
        #line 583 "iiwa_dnn/control/arms.py"
        if (reaches) {
            #line 584 "iiwa_dnn/control/arms.py"
            wanted = double_min(double_max(wanted, lower), upper);
            #line 585 "iiwa_dnn/control/arms.py"
            wanted = schemes_profiles_arriving(arena, last, before, left, wanted, &rates, periods);
        } else {
            #line 586 "iiwa_dnn/control/arms.py"
            if (arm->at->is_repeated != 0.0 || wanted < lower || wanted > upper) {
                #line 587 "iiwa_dnn/control/arms.py"
                wanted += schemes_profiles_braking(arena, last - wanted, -INFINITY, INFINITY, limits->jerk.data[i], periods);
            }
        }
        #line 588 "iiwa_dnn/control/arms.py"
        dq.data[i] = wanted;
    }
}

/* Move `target`, which is at the path's origin, to time t [s] by the function at `address`.
 *
 * The path's constants are (c,). */
static inline void references_base_enter_path(struct arena *arena, int64_t address, double t, Vector constants, const references_targets_TargetData *target)
{
    if (address > 0) return ((void (*)(struct arena *, double , Vector , const references_targets_TargetData *))(intptr_t)address)(arena, t, constants, target);
    return ((void (*)(double, double *, int64_t, double *, int64_t))(intptr_t)-address)(t, constants.data, constants.size0, target->numbers.data, target->numbers.size0);
}

/* Compute the scalar product u . v.
 *
 * iiwa_dnn/references/rotations.py: dot */
static inline double references_rotations_dot(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    #line 15 "iiwa_dnn/references/rotations.py"
    #line 16 "iiwa_dnn/references/rotations.py"
    return u.at[0] * v.at[0] + u.at[1] * v.at[1] + u.at[2] * v.at[2];
}

/* Return the components of a vector (3,).
 *
 * iiwa_dnn/references/rotations.py: triple */
static inline double_3 references_rotations_triple(struct arena *arena, Vector v)
{
    (void)arena;
    #line 39 "iiwa_dnn/references/rotations.py"
    #line 40 "iiwa_dnn/references/rotations.py"
    return (double_3){{v.data[0], v.data[1], v.data[2]}};
}

/* Write the rotation vector of R (3, 3), of length at most pi [rad], into `out` (3,).
 *
 * The unit quaternion is computed first, from a large component, so that the vector is accurate
 * near an angle of 0 and near one of pi.
 *
 * iiwa_dnn/references/rotations.py: rotation_log */
static inline void references_rotations_rotation_log(struct arena *arena, Matrix R, Vector out)
{
    #line 89 "iiwa_dnn/references/rotations.py"
    #line 94 "iiwa_dnn/references/rotations.py"
    double trace = 0.0;
    #line 95 "iiwa_dnn/references/rotations.py"
    int64_t i = 0;
    #line 96 "iiwa_dnn/references/rotations.py"
    for (int64_t axis = 0; axis < 3; axis++) {
        #line 97 "iiwa_dnn/references/rotations.py"
        trace += R.data[axis * R.size1 + axis];
        #line 98 "iiwa_dnn/references/rotations.py"
        if (R.data[axis * R.size1 + axis] > R.data[i * R.size1 + i]) {
            #line 99 "iiwa_dnn/references/rotations.py"
            i = axis;
        }
    }
    #line 100 "iiwa_dnn/references/rotations.py"
    double w;
    if (trace > 0.0) {
        #line 101 "iiwa_dnn/references/rotations.py"
        w = 0.5 * sqrt(1.0 + trace);
        #line 102 "iiwa_dnn/references/rotations.py"
        for (int64_t axis = 0; axis < 3; axis++) {
            #line 103 "iiwa_dnn/references/rotations.py"
            const int64_t j = int_remainder(axis + 1, 3);
            #line 104 "iiwa_dnn/references/rotations.py"
            const int64_t k = int_remainder(axis + 2, 3);
            #line 105 "iiwa_dnn/references/rotations.py"
            out.data[axis] = (R.data[k * R.size1 + j] - R.data[j * R.size1 + k]) / (4.0 * w);
        }
    } else {
        #line 107 "iiwa_dnn/references/rotations.py"
        const int64_t j = int_remainder(i + 1, 3);
        #line 108 "iiwa_dnn/references/rotations.py"
        const int64_t k = int_remainder(i + 2, 3);
        #line 109 "iiwa_dnn/references/rotations.py"
        const double largest = 0.5 * sqrt(double_max(1.0 + R.data[i * R.size1 + i] - R.data[j * R.size1 + j] - R.data[k * R.size1 + k], 0.0));
        #line 110 "iiwa_dnn/references/rotations.py"
        w = (R.data[k * R.size1 + j] - R.data[j * R.size1 + k]) / (4.0 * largest);
        #line 111 "iiwa_dnn/references/rotations.py"
        const double sign = w >= 0.0 ? 1.0 : -1.0;
        #line 112 "iiwa_dnn/references/rotations.py"
        w *= sign;
        #line 113 "iiwa_dnn/references/rotations.py"
        out.data[i] = sign * largest;
        #line 114 "iiwa_dnn/references/rotations.py"
        out.data[j] = sign * (R.data[i * R.size1 + j] + R.data[j * R.size1 + i]) / (4.0 * largest);
        #line 115 "iiwa_dnn/references/rotations.py"
        out.data[k] = sign * (R.data[i * R.size1 + k] + R.data[k * R.size1 + i]) / (4.0 * largest);
    }
    #line 116 "iiwa_dnn/references/rotations.py"
    const double sine = sqrt(references_rotations_dot(arena, references_rotations_triple(arena, out), references_rotations_triple(arena, out)));
    #line 118 "iiwa_dnn/references/rotations.py"
    const double scale = sine > 1e-12 ? 2.0 * atan2(sine, w) / sine : 2.0;
    #line 119 "iiwa_dnn/references/rotations.py"
    for (int64_t axis = 0; axis < 3; axis++) {
        #line 120 "iiwa_dnn/references/rotations.py"
        out.data[axis] *= scale;
    }
}

/* Set the twist of a target `now` to the mean one over dt [s], to a target `then`.
 *
 * iiwa_dnn/references/rotations.py: set_mean_twist */
static inline void references_rotations_set_mean_twist(struct arena *arena, const references_targets_TargetData *now, const references_targets_TargetData *then, double dt)
{
    const struct arena mark = *arena;
    #line 125 "iiwa_dnn/references/rotations.py"
    #line 126 "iiwa_dnn/references/rotations.py"
    const Matrix relative = {(double *)arena_empty(arena, 3 * 3), 3, 3};
    #line 127 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 128 "iiwa_dnn/references/rotations.py"
        for (int64_t j = 0; j < 3; j++) {
            #line 129 "iiwa_dnn/references/rotations.py"
            relative.data[i * relative.size1 + j] = references_rotations_dot(arena, references_rotations_triple(arena, (Vector){then->rotation.data + i * then->rotation.size1, then->rotation.size1}), references_rotations_triple(arena, (Vector){now->rotation.data + j * now->rotation.size1, now->rotation.size1}));
        }
    }
    #line 130 "iiwa_dnn/references/rotations.py"
    const Vector turn = {(double *)arena_empty(arena, 3), 3};
    #line 131 "iiwa_dnn/references/rotations.py"
    references_rotations_rotation_log(arena, relative, turn);
    #line 132 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 133 "iiwa_dnn/references/rotations.py"
        now->linear_velocity.data[i] = (then->position.data[i] - now->position.data[i]) / dt;
        #line 134 "iiwa_dnn/references/rotations.py"
        now->angular_velocity.data[i] = turn.data[i] / dt;
    }
    arena_leave(arena, &mark);
}

/* Sample all paths at time t [s] into `targets` (k, 18), which is overwritten.
 *
 * With feed-forward, the velocity of a target is the mean one over the period of dt [s].
 *
 * iiwa_dnn/control/cycle.py: sample_targets */
static inline void control_cycle_sample_targets(struct arena *arena, const control_cycle_Paths *paths, double t, double dt, Matrix targets)
{
    const struct arena mark = *arena;
    #line 415 "iiwa_dnn/control/cycle.py"
    #line 419 "iiwa_dnn/control/cycle.py"
    for (int64_t k = 0, end_k = paths->table.size0; k < end_k; k++) {
        #line 420 "iiwa_dnn/control/cycle.py"
        const IntVector entry = {paths->table.data + k * paths->table.size1, paths->table.size1};
        #line 421 "iiwa_dnn/control/cycle.py"
        const int64_t address = entry.data[control_cycle_PathColumn_ADDRESS];
        #line 422 "iiwa_dnn/control/cycle.py"
        const Vector own = {paths->constants.data + entry.data[control_cycle_PathColumn_START], entry.data[control_cycle_PathColumn_STOP] - entry.data[control_cycle_PathColumn_START]};
        #line 423 "iiwa_dnn/control/cycle.py"
        const references_targets_TargetData target = references_targets_TargetData_of((Vector){targets.data + k * targets.size1, targets.size1});
        #line 424 "iiwa_dnn/control/cycle.py"
        const int64_t own_1 = 18;
        const Vector base = {own.data, own_1};
        #line 425 "iiwa_dnn/control/cycle.py"
        const int64_t own_2 = 18;
        const Vector move = {own.data + 18, own.size0 - own_2};
        #line 426 "iiwa_dnn/control/cycle.py"
        qp_layout_copied(arena, target.numbers, base);
        #line 427 "iiwa_dnn/control/cycle.py"
        references_base_enter_path(arena, address, t, move, &target);
        #line 428 "iiwa_dnn/control/cycle.py"
        if (entry.data[control_cycle_PathColumn_FEED_FORWARD] != 0) {
            #line 429 "iiwa_dnn/control/cycle.py"
            const references_targets_TargetData then = references_targets_TargetData_of((Vector){(double *)arena_copy(arena, base.data, base.size0), base.size0});
            #line 430 "iiwa_dnn/control/cycle.py"
            references_base_enter_path(arena, address, t + dt, move, &then);
            #line 431 "iiwa_dnn/control/cycle.py"
            references_rotations_set_mean_twist(arena, &target, &then, dt);
        }
    }
    arena_leave(arena, &mark);
}

/* Test whether t [s], q (n,) [rad] and the targets, from data[targets] on, are valid.
 *
 * iiwa_dnn/control/cycle.py: _is_valid */
static inline bool control_cycle_is_valid(struct arena *arena, double t, Vector q, Vector data, int64_t targets)
{
    #line 339 "iiwa_dnn/control/cycle.py"
    #line 340 "iiwa_dnn/control/cycle.py"
    for (int64_t i = 0; i < q.size0; i++) {
        #line 341 "iiwa_dnn/control/cycle.py"
        if (!(fabs(q.data[i]) <= compiling_trigonometry_LARGEST)) {
            #line 342 "iiwa_dnn/control/cycle.py"
            return false;
        }
    }
    #line 343 "iiwa_dnn/control/cycle.py"
    return isfinite(t) && qp_dense_all_finite(arena, data, targets, data.size0);
}

/* Write the periods of a step to the first four numbers of `limits`.
 *
 * iiwa_dnn/schemes/rate_limits.py: state_periods */
static inline void schemes_rate_limits_state_periods(struct arena *arena, const schemes_rate_limits_MotionConstants *limits, const schemes_periods_Periods *periods)
{
    (void)arena;
    #line 155 "iiwa_dnn/schemes/rate_limits.py"
    #line 156 "iiwa_dnn/schemes/rate_limits.py"
    limits->at->dt = periods->dt;
    #line 157 "iiwa_dnn/schemes/rate_limits.py"
    limits->at->hold = periods->hold;
    #line 158 "iiwa_dnn/schemes/rate_limits.py"
    limits->at->longest = periods->longest;
    #line 159 "iiwa_dnn/schemes/rate_limits.py"
    limits->at->fraction = periods->fraction;
}

/* Compute ``(at_q, at_G, at_A, at_lb)``, the beginnings of the parts of `QP.data`.
 *
 * iiwa_dnn/qp/layout.py: offsets */
static inline int_4 qp_layout_offsets(struct arena *arena, int64_t n, int64_t m, int64_t p)
{
    (void)arena;
    #line 43 "iiwa_dnn/qp/layout.py"
    #line 44 "iiwa_dnn/qp/layout.py"
    const int64_t at_q = n * n;
    #line 45 "iiwa_dnn/qp/layout.py"
    const int64_t at_G = at_q + n;
    #line 46 "iiwa_dnn/qp/layout.py"
    const int64_t at_A = at_G + m * n + m;
    #line 47 "iiwa_dnn/qp/layout.py"
    return (int_4){{at_q, at_G, at_A, at_A + p * n + p}};
}

/* Make the views of a program's flat array, `QP.data` (size,), which has to outlive them.
 *
 * iiwa_dnn/qp/layout.py: qp_views */
static inline qp_layout_QPViews qp_layout_qp_views(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p)
{
    #line 76 "iiwa_dnn/qp/layout.py"
    #line 77 "iiwa_dnn/qp/layout.py"
    const int_4 own_1 = qp_layout_offsets(arena, n, m, p);
    const int64_t at_q = own_1.at[0];
    const int64_t at_G = own_1.at[1];
    const int64_t at_A = own_1.at[2];
    const int64_t at_lb = own_1.at[3];
    #line 78 "iiwa_dnn/qp/layout.py"
    const int64_t at_h = at_G + m * n;
    #line 79 "iiwa_dnn/qp/layout.py"
    const int64_t at_b = at_A + p * n;
    #line 80 "iiwa_dnn/qp/layout.py"
    const int64_t at_ub = at_lb + n;
    #line 81 "iiwa_dnn/qp/layout.py"
    return (qp_layout_QPViews){{data.data, n, n}, {data.data + at_q, at_G - at_q}, {data.data + at_G, m, n}, {data.data + at_h, at_A - at_h}, {data.data + at_A, p, n}, {data.data + at_b, at_lb - at_b}, {data.data + at_lb, at_ub - at_lb}, {data.data + at_ub, at_ub + n - at_ub}};
}

/* Return views of the matrices and vectors in a program's `QP.data` (size,).
 *
 * iiwa_dnn/schemes/program.py: program_views */
static inline qp_layout_QPViews schemes_program_program_views(struct arena *arena, Vector data, const schemes_program_ProgramSizes *sizes)
{
    #line 100 "iiwa_dnn/schemes/program.py"
    #line 101 "iiwa_dnn/schemes/program.py"
    return qp_layout_qp_views(arena, data, sizes->n, sizes->m, sizes->p);
}

/* Call a cost's kernel by its address; it adds to P (n, n) and the cost vector q (n,). */
static inline void schemes_parts_enter_cost(struct arena *arena, int64_t address, const schemes_step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    if (address > 0) return ((void (*)(struct arena *, const schemes_step_StepViews *, Vector , Matrix , Vector ))(intptr_t)address)(arena, step, constants, P, q);
    return ((void (*)(double, double, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t))(intptr_t)-address)(step->t, step->rate, step->q.data, step->q.size0, step->last.data, step->last.size0, step->before.data, step->before.size0, step->jacobian.data, step->jacobian.size0, step->jacobian.size1, step->placements.data, step->placements.size0, step->placements.size1, step->support.data, step->support.size0, step->support.size1, step->inertia.data, step->inertia.size0, step->inertia.size1, step->targets.data, step->targets.size0, step->targets.size1, step->least.data, step->least.size0, step->lower_kind.data, step->lower_kind.size0, step->upper_kind.data, step->upper_kind.size0, constants.data, constants.size0, P.data, P.size0, P.size1, q.data, q.size0);
}

/* Call a task's kernel by its address; it writes A (rows, n) and b (rows,). */
static inline void schemes_parts_enter_task(struct arena *arena, int64_t address, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    if (address > 0) return ((void (*)(struct arena *, const schemes_step_StepViews *, Vector , const references_targets_TargetData *, Matrix , Vector ))(intptr_t)address)(arena, step, constants, target, A, b);
    return ((void (*)(double, double, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t))(intptr_t)-address)(step->t, step->rate, step->q.data, step->q.size0, step->last.data, step->last.size0, step->before.data, step->before.size0, step->jacobian.data, step->jacobian.size0, step->jacobian.size1, step->placements.data, step->placements.size0, step->placements.size1, step->support.data, step->support.size0, step->support.size1, step->inertia.data, step->inertia.size0, step->inertia.size1, step->targets.data, step->targets.size0, step->targets.size1, step->least.data, step->least.size0, step->lower_kind.data, step->lower_kind.size0, step->upper_kind.data, step->upper_kind.size0, constants.data, constants.size0, target->numbers.data, target->numbers.size0, A.data, A.size0, A.size1, b.data, b.size0);
}

/* Add the cost weight / 2 |A x - b|^2 to P (n, n) and q (n,), for A (rows, n) and b (rows,).
 *
 * iiwa_dnn/schemes/program.py: add_soft */
static inline void schemes_program_add_soft(struct arena *arena, Matrix P, Vector q, Matrix A, Vector b, double weight)
{
    (void)arena;
    #line 179 "iiwa_dnn/schemes/program.py"
    #line 180 "iiwa_dnn/schemes/program.py"
    for (int64_t k = 0; k < b.size0; k++) {
        #line 181 "iiwa_dnn/schemes/program.py"
        for (int64_t i = 0; i < q.size0; i++) {
            #line 182 "iiwa_dnn/schemes/program.py"
            const double scaled = weight * A.data[k * A.size1 + i];
            #line 183 "iiwa_dnn/schemes/program.py"
            q.data[i] -= scaled * b.data[k];
            #line 184 "iiwa_dnn/schemes/program.py"
            for (int64_t j = 0; j < q.size0; j++) {
                #line 185 "iiwa_dnn/schemes/program.py"
                P.data[i * P.size1 + j] += scaled * A.data[k * A.size1 + j];
            }
        }
    }
}

/* Call a limit's kernel by its address; it writes G (rows, n), h (rows,), lb and ub (n,). */
static inline void schemes_parts_enter_limit(struct arena *arena, int64_t address, const schemes_step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    if (address > 0) return ((void (*)(struct arena *, const schemes_step_StepViews *, Vector , Matrix , Vector , Vector , Vector ))(intptr_t)address)(arena, step, constants, G, h, lb, ub);
    return ((void (*)(double, double, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t))(intptr_t)-address)(step->t, step->rate, step->q.data, step->q.size0, step->last.data, step->last.size0, step->before.data, step->before.size0, step->jacobian.data, step->jacobian.size0, step->jacobian.size1, step->placements.data, step->placements.size0, step->placements.size1, step->support.data, step->support.size0, step->support.size1, step->inertia.data, step->inertia.size0, step->inertia.size1, step->targets.data, step->targets.size0, step->targets.size1, step->least.data, step->least.size0, step->lower_kind.data, step->lower_kind.size0, step->upper_kind.data, step->upper_kind.size0, constants.data, constants.size0, G.data, G.size0, G.size1, h.data, h.size0, lb.data, lb.size0, ub.data, ub.size0);
}

/* Set the kinds of those bounds that a limit has left as they were back to the earlier ones.
 *
 * Writes kinds.
 *
 * Args:
 *     bounds: Bounds after the limit's kernel, (n,).
 *     before: Bounds before it, (n,).
 *     kinds: `LimitKind` of each bound after it, (joints,).
 *     others: `LimitKind` of each bound before it, (joints,).
 *
 * iiwa_dnn/schemes/program.py: _keep_kinds */
static inline void schemes_program_keep_kinds(struct arena *arena, Vector bounds, Vector before, Vector kinds, Vector others)
{
    (void)arena;
    #line 162 "iiwa_dnn/schemes/program.py"
    #line 172 "iiwa_dnn/schemes/program.py"
    for (int64_t i = 0; i < kinds.size0; i++) {
        #line 173 "iiwa_dnn/schemes/program.py"
        if (bounds.data[i] == before.data[i]) {
            #line 174 "iiwa_dnn/schemes/program.py"
            kinds.data[i] = others.data[i];
        }
    }
}

/* Assemble the program of one instant.
 *
 * Writes data, step.least, step.lower_kind and step.upper_kind.
 *
 * Args:
 *     data: The program, `QP.data`, (size,), overwritten.
 *     arrays: `ProgramLayout.arrays`.
 *     step: The instant. `least` is updated to the distances that pairs have to keep from now on,
 *         and the kinds of the bounds are overwritten.
 *
 * iiwa_dnn/schemes/program.py: assemble */
static inline void schemes_program_assemble(struct arena *arena, Vector data, const schemes_program_ProgramArrays *arrays, const schemes_step_StepViews *step)
{
    const struct arena mark = *arena;
    #line 113 "iiwa_dnn/schemes/program.py"
    #line 123 "iiwa_dnn/schemes/program.py"
    int64_t code = int_of((double)naming_LimitKind_OTHER);
    #line 124 "iiwa_dnn/schemes/program.py"
    const qp_layout_QPViews qp = schemes_program_program_views(arena, data, &arrays->sizes);
    #line 125 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0; own_k < data.size0; own_k++) {
        data.data[own_k] = 0.0;
    }
    #line 126 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0; own_k < qp.lb.size0; own_k++) {
        qp.lb.data[own_k] = -INFINITY;
    }
    #line 127 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0; own_k < qp.ub.size0; own_k++) {
        qp.ub.data[own_k] = INFINITY;
    }
    #line 128 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0; own_k < step->lower_kind.size0; own_k++) {
        step->lower_kind.data[own_k] = 0.0;
    }
    #line 129 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0; own_k < step->upper_kind.size0; own_k++) {
        step->upper_kind.data[own_k] = 0.0;
    }
    #line 130 "iiwa_dnn/schemes/program.py"
    for (int64_t k = 0, end_k = arrays->table.size0; k < end_k; k++) {
        #line 131 "iiwa_dnn/schemes/program.py"
        const IntVector entry = {arrays->table.data + k * arrays->table.size1, arrays->table.size1};
        #line 132 "iiwa_dnn/schemes/program.py"
        const int64_t kind = entry.data[schemes_program_Column_KIND];
        #line 133 "iiwa_dnn/schemes/program.py"
        const int64_t address = entry.data[schemes_program_Column_ADDRESS];
        #line 134 "iiwa_dnn/schemes/program.py"
        const int64_t first = entry.data[schemes_program_Column_FIRST];
        #line 135 "iiwa_dnn/schemes/program.py"
        const int64_t end = first + entry.data[schemes_program_Column_ROWS];
        #line 136 "iiwa_dnn/schemes/program.py"
        const Vector own = schemes_program_block_constants(arena, arrays, k);
        #line 137 "iiwa_dnn/schemes/program.py"
        const references_targets_TargetData target = references_targets_TargetData_of((Vector){step->targets.data + entry.data[schemes_program_Column_TARGET] * step->targets.size1, step->targets.size1});
        #line 138 "iiwa_dnn/schemes/program.py"
        if (kind == schemes_program_BlockKind_COST) {
            #line 139 "iiwa_dnn/schemes/program.py"
            schemes_parts_enter_cost(arena, address, step, own, qp.P, qp.q);
        } else {
            #line 140 "iiwa_dnn/schemes/program.py"
            if (kind == schemes_program_BlockKind_TASK) {
                #line 141 "iiwa_dnn/schemes/program.py"
                schemes_parts_enter_task(arena, address, step, own, &target, (Matrix){qp.A.data + first * qp.A.size1, end - first, qp.A.size1}, (Vector){qp.b.data + first, end - first});
            } else {
                #line 142 "iiwa_dnn/schemes/program.py"
                if (kind == schemes_program_BlockKind_SOFT_TASK) {
                    #line 143 "iiwa_dnn/schemes/program.py"
                    const Matrix A = {(double *)arena_zeros(arena, (end - first) * qp.q.size0), end - first, qp.q.size0};
                    #line 144 "iiwa_dnn/schemes/program.py"
                    const Vector b = {(double *)arena_zeros(arena, end - first), end - first};
                    #line 145 "iiwa_dnn/schemes/program.py"
                    schemes_parts_enter_task(arena, address, step, own, &target, A, b);
                    #line 146 "iiwa_dnn/schemes/program.py"
                    schemes_program_add_soft(arena, qp.P, qp.q, A, b, arrays->constants.data[entry.data[schemes_program_Column_STOP]]);
                } else {
                    #line 148 "iiwa_dnn/schemes/program.py"
                    const Vector lower = {(double *)arena_copy(arena, qp.lb.data, qp.lb.size0), qp.lb.size0};
                    #line 149 "iiwa_dnn/schemes/program.py"
                    const Vector upper = {(double *)arena_copy(arena, qp.ub.data, qp.ub.size0), qp.ub.size0};
                    #line 150 "iiwa_dnn/schemes/program.py"
                    const Vector lower_kind = {(double *)arena_copy(arena, step->lower_kind.data, step->lower_kind.size0), step->lower_kind.size0};
                    #line 151 "iiwa_dnn/schemes/program.py"
                    const Vector upper_kind = {(double *)arena_copy(arena, step->upper_kind.data, step->upper_kind.size0), step->upper_kind.size0};
                    #line 152 "iiwa_dnn/schemes/program.py"
                    for (int64_t own_k = 0; own_k < step->lower_kind.size0; own_k++) {
                        step->lower_kind.data[own_k] = (double)code;
                    }
                    #line 153 "iiwa_dnn/schemes/program.py"
                    for (int64_t own_k = 0; own_k < step->upper_kind.size0; own_k++) {
                        step->upper_kind.data[own_k] = (double)code;
                    }
                    #line 154 "iiwa_dnn/schemes/program.py"
                    code += 1;
                    #line 155 "iiwa_dnn/schemes/program.py"
                    schemes_parts_enter_limit(arena, address, step, own, (Matrix){qp.G.data + first * qp.G.size1, end - first, qp.G.size1}, (Vector){qp.h.data + first, end - first}, qp.lb, qp.ub);
                    #line 156 "iiwa_dnn/schemes/program.py"
                    schemes_program_keep_kinds(arena, qp.lb, lower, step->lower_kind, lower_kind);
                    #line 157 "iiwa_dnn/schemes/program.py"
                    schemes_program_keep_kinds(arena, qp.ub, upper, step->upper_kind, upper_kind);
                }
            }
        }
    }
    arena_leave(arena, &mark);
}

/* Write the state and bounds of a step's nominal program into its log, and reset its answer.
 *
 * iiwa_dnn/control/cycle.py: _note_instant */
static inline void control_cycle_note_instant(struct arena *arena, const control_command_StepLog *log, const schemes_program_ProgramArrays *arrays, const control_state_MotionState *motion_state, const control_state_MotionState *next_motion_state)
{
    #line 350 "iiwa_dnn/control/cycle.py"
    #line 351 "iiwa_dnn/control/cycle.py"
    const qp_layout_QPViews qp = schemes_program_program_views(arena, log->program, &arrays->sizes);
    #line 352 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->q, motion_state->q);
    #line 353 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->last, motion_state->last);
    #line 354 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->before, motion_state->before);
    #line 355 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->lower, (Vector){qp.lb.data, log->lower.size0});
    #line 356 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->upper, (Vector){qp.ub.data, log->upper.size0});
    #line 357 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->placement, (Vector){arrays->placements.data + arrays->tip * arrays->placements.size1, arrays->placements.size1});
    #line 358 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, log->least, next_motion_state->least);
    #line 359 "iiwa_dnn/control/cycle.py"
    for (int64_t own_k = 0; own_k < log->stats.numbers.size0; own_k++) {
        log->stats.numbers.data[own_k] = 0.0;
    }
    #line 360 "iiwa_dnn/control/cycle.py"
    for (int64_t own_k = 0; own_k < log->limiting.size0; own_k++) {
        log->limiting.data[own_k] = 0.0;
    }
    #line 361 "iiwa_dnn/control/cycle.py"
    log->at->fraction = 0.0;
    #line 362 "iiwa_dnn/control/cycle.py"
    log->at->status = (double)control_command_SOLVED;
    #line 363 "iiwa_dnn/control/cycle.py"
    log->at->kind = (double)control_yielding_NOMINAL;
}

/* Call the function of a `CompiledAnswer` by its address, to answer a program.
 *
 * The state (size,) is advanced in place, by a time or until the network has converged, and its
 * point (2n + m + p,) is written.
 *
 * Args:
 *     address: Address of the function.
 *     qp: The program.
 *     rates: Address of the network's compiled function; 0 to solve.
 *     settings: Tolerance, budget and time.
 *     state: The state.
 *     point: The point, overwritten.
 *
 * Returns:
 *     ``(iterations, network_time, primal, dual, gap)``, as `Progress`. */
static inline double_5 networks_integrators_base_enter_answer(struct arena *arena, int64_t address, const qp_layout_QPViews *qp, int64_t rates, const networks_integrators_base_AnswerSettings *settings, Vector state, Vector point)
{
    if (address > 0) return ((double_5 (*)(struct arena *, const qp_layout_QPViews *, int64_t , const networks_integrators_base_AnswerSettings *, Vector , Vector ))(intptr_t)address)(arena, qp, rates, settings, state, point);
    double_5 numbers = {{0.0}};
    ((void (*)(double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *))(intptr_t)-address)(qp->P.data, qp->P.size0, qp->P.size1, qp->q.data, qp->q.size0, qp->G.data, qp->G.size0, qp->G.size1, qp->h.data, qp->h.size0, qp->A.data, qp->A.size0, qp->A.size1, qp->b.data, qp->b.size0, qp->lb.data, qp->lb.size0, qp->ub.data, qp->ub.size0, rates, settings->numbers.data, settings->numbers.size0, state.data, state.size0, point.data, point.size0, numbers.at);
    return numbers;
}

/* Check that no residual is above the tolerance, and none NaN.
 *
 * iiwa_dnn/qp/residuals.py: within */
static inline bool qp_residuals_within(struct arena *arena, double primal, double dual, double gap, double tol)
{
    (void)arena;
    #line 110 "iiwa_dnn/qp/residuals.py"
    #line 111 "iiwa_dnn/qp/residuals.py"
    return primal <= tol && dual <= tol && gap <= tol;
}

/* Multiply row or column j of a matrix (k, n) by the first entries of x.
 *
 * Returns:
 *     The product, the sum of its absolute terms, and the largest absolute entry.
 *
 * iiwa_dnn/qp/residuals.py: product_terms */
static inline double_3 qp_residuals_product_terms(struct arena *arena, Matrix rows, int64_t j, Vector x, bool is_column)
{
    #line 128 "iiwa_dnn/qp/residuals.py"
    #line 133 "iiwa_dnn/qp/residuals.py"
    double value = 0.0;
    #line 134 "iiwa_dnn/qp/residuals.py"
    double size = 0.0;
    #line 135 "iiwa_dnn/qp/residuals.py"
    double largest = 0.0;
    #line 136 "iiwa_dnn/qp/residuals.py"
    for (int64_t k = 0, end_k = is_column ? rows.size0 : rows.size1; k < end_k; k++) {
        #line 137 "iiwa_dnn/qp/residuals.py"
        const double entry = is_column ? rows.data[k * rows.size1 + j] : rows.data[j * rows.size1 + k];
        #line 138 "iiwa_dnn/qp/residuals.py"
        value += entry * x.data[k];
        #line 139 "iiwa_dnn/qp/residuals.py"
        size += fabs(entry * x.data[k]);
        #line 140 "iiwa_dnn/qp/residuals.py"
        largest = qp_layout_larger(arena, largest, fabs(entry));
    }
    #line 141 "iiwa_dnn/qp/residuals.py"
    return (double_3){{value, size, largest}};
}

/* Return the weight of an absolute tolerance: the largest coefficient, 1 from `SLIGHT` on.
 *
 * iiwa_dnn/qp/residuals.py: weight_of */
static inline double qp_residuals_weight_of(struct arena *arena, double largest)
{
    (void)arena;
    #line 116 "iiwa_dnn/qp/residuals.py"
    #line 117 "iiwa_dnn/qp/residuals.py"
    return largest < qp_residuals_SLIGHT ? largest : 1.0;
}

/* Compute the largest absolute entry of P and q; NaN if one is NaN.
 *
 * iiwa_dnn/qp/residuals.py: cost_size */
static inline double qp_residuals_cost_size(struct arena *arena, const qp_layout_QPViews *qp)
{
    #line 122 "iiwa_dnn/qp/residuals.py"
    #line 123 "iiwa_dnn/qp/residuals.py"
    return qp_layout_larger(arena, qp_dense_largest_entry(arena, (Vector){qp->P.data, qp->P.size0 * qp->P.size1}), qp_dense_largest_entry(arena, qp->q));
}

/* Check the dual residual and the gap of a point by the rule of acceptance.
 *
 * `gap` and `size` are what the rows contribute to the gap and to the sum of its absolute terms.
 *
 * iiwa_dnn/qp/residuals.py: _cost_is_small_enough */
static inline bool qp_residuals_cost_is_small_enough(struct arena *arena, const qp_layout_QPViews *qp, Vector point, double eps_abs, double relative, double gap, double size)
{
    #line 190 "iiwa_dnn/qp/residuals.py"
    #line 194 "iiwa_dnn/qp/residuals.py"
    const int64_t n = qp->q.size0;
    #line 195 "iiwa_dnn/qp/residuals.py"
    const int64_t at_z = n + qp->b.size0;
    #line 196 "iiwa_dnn/qp/residuals.py"
    const int64_t at_box = at_z + qp->h.size0;
    #line 197 "iiwa_dnn/qp/residuals.py"
    const double cost = qp_residuals_cost_size(arena, qp);
    #line 198 "iiwa_dnn/qp/residuals.py"
    const double weight = cost > 0.0 ? qp_residuals_weight_of(arena, cost) : 1.0;
    #line 199 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 200 "iiwa_dnn/qp/residuals.py"
        const double multiplier = point.data[at_box + i];
        #line 201 "iiwa_dnn/qp/residuals.py"
        const double bound = multiplier > 0.0 ? qp->ub.data[i] : qp->lb.data[i];
        #line 202 "iiwa_dnn/qp/residuals.py"
        const double term = multiplier != 0.0 && fabs(bound) < INFINITY ? bound * multiplier : 0.0;
        #line 203 "iiwa_dnn/qp/residuals.py"
        const double_3 own_1 = qp_residuals_product_terms(arena, qp->P, i, point, false);
        double value = own_1.at[0];
        double of_P = own_1.at[1];
        double largest = own_1.at[2];
        #line 204 "iiwa_dnn/qp/residuals.py"
        const double_3 own_2 = qp_residuals_product_terms(arena, qp->A, i, (Vector){point.data + n, point.size0 - n}, true);
        const double in_A = own_2.at[0];
        const double of_A = own_2.at[1];
        const double largest_A = own_2.at[2];
        #line 205 "iiwa_dnn/qp/residuals.py"
        const double_3 own_3 = qp_residuals_product_terms(arena, qp->G, i, (Vector){point.data + at_z, point.size0 - at_z}, true);
        const double in_G = own_3.at[0];
        const double of_G = own_3.at[1];
        const double largest_G = own_3.at[2];
        #line 206 "iiwa_dnn/qp/residuals.py"
        value += qp->q.data[i];
        #line 207 "iiwa_dnn/qp/residuals.py"
        of_P += fabs(qp->q.data[i]);
        #line 208 "iiwa_dnn/qp/residuals.py"
        gap += point.data[i] * value + term;
        #line 209 "iiwa_dnn/qp/residuals.py"
        size += fabs(point.data[i]) * of_P + fabs(term);
        #line 210 "iiwa_dnn/qp/residuals.py"
        largest = double_max(double_max(largest, fabs(qp->q.data[i])) / weight, double_max(largest_A, largest_G));
        #line 211 "iiwa_dnn/qp/residuals.py"
        const double allowed = double_max(eps_abs * weight * qp_residuals_weight_of(arena, largest), relative * (of_P + of_A + of_G + fabs(multiplier)));
        #line 214 "iiwa_dnn/qp/residuals.py"
        if (!(fabs(value + in_A + in_G + multiplier) <= allowed)) {
            #line 215 "iiwa_dnn/qp/residuals.py"
            return false;
        }
    }
    #line 216 "iiwa_dnn/qp/residuals.py"
    return fabs(gap) <= double_max(eps_abs * weight, relative * size);
}

/* Check a point [x | y | z | z_box] by the rule of acceptance, entry by entry.
 *
 * iiwa_dnn/qp/residuals.py: is_small_enough */
static inline bool qp_residuals_is_small_enough(struct arena *arena, const qp_layout_QPViews *qp, Vector point, double eps_abs, double eps_rel)
{
    #line 161 "iiwa_dnn/qp/residuals.py"
    #line 162 "iiwa_dnn/qp/residuals.py"
    const int64_t n = qp->q.size0;
    #line 163 "iiwa_dnn/qp/residuals.py"
    const int64_t p = qp->b.size0;
    #line 164 "iiwa_dnn/qp/residuals.py"
    const double relative = double_max(eps_rel, qp_dense_ROUNDING * (double)n);
    #line 165 "iiwa_dnn/qp/residuals.py"
    double gap = 0.0;
    #line 166 "iiwa_dnn/qp/residuals.py"
    double size = 0.0;
    #line 167 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = p + qp->h.size0; j < end_j; j++) {
        #line 168 "iiwa_dnn/qp/residuals.py"
        const double limit = j < p ? qp->b.data[j] : qp->h.data[j - p];
        #line 169 "iiwa_dnn/qp/residuals.py"
        if (limit < INFINITY) {
            #line 170 "iiwa_dnn/qp/residuals.py"
            const double_3 own_1 = qp_residuals_product_terms(arena, j < p ? qp->A : qp->G, j < p ? j : j - p, point, false);
            const double value = own_1.at[0];
            const double of_row = own_1.at[1];
            const double largest = own_1.at[2];
            #line 173 "iiwa_dnn/qp/residuals.py"
            const double excess = j < p ? fabs(value - limit) : value - limit;
            #line 174 "iiwa_dnn/qp/residuals.py"
            if (!(excess <= double_max(eps_abs * qp_residuals_weight_of(arena, largest), relative * (of_row + fabs(limit))))) {
                #line 175 "iiwa_dnn/qp/residuals.py"
                return false;
            }
            #line 176 "iiwa_dnn/qp/residuals.py"
            gap += limit * point.data[n + j];
            #line 177 "iiwa_dnn/qp/residuals.py"
            size += fabs(limit * point.data[n + j]);
        }
    }
    #line 178 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 179 "iiwa_dnn/qp/residuals.py"
        const double nearest = double_min(double_max(point.data[i], qp->lb.data[i]), qp->ub.data[i]);
        #line 180 "iiwa_dnn/qp/residuals.py"
        const double allowed = double_max(eps_abs, relative * (fabs(point.data[i]) + fabs(nearest)));
        #line 181 "iiwa_dnn/qp/residuals.py"
        if (!(fabs(point.data[i] - nearest) <= allowed)) {
            #line 182 "iiwa_dnn/qp/residuals.py"
            return false;
        }
    }
    #line 183 "iiwa_dnn/qp/residuals.py"
    return qp_residuals_cost_is_small_enough(arena, qp, point, eps_abs, relative, gap, size);
}

/* Return the status of an answer, its index in `STATUSES`, from its residuals.
 *
 * A point (2n + m + p,) whose residuals are above the tolerance by rounding alone is an answer.
 *
 * If the network was advanced by a duration, its state (size,) has to be finite too: the point of
 * an infinite state may be finite, since it is clipped to the bounds.
 *
 * iiwa_dnn/control/cycle.py: status_of */
static inline int64_t control_cycle_status_of(struct arena *arena, const qp_layout_QPViews *qp, Vector point, const networks_integrators_base_SolveStats *stats, const networks_integrators_base_AnswerSettings *settings, Vector state)
{
    #line 392 "iiwa_dnn/control/cycle.py"
    #line 399 "iiwa_dnn/control/cycle.py"
    double size = stats->at->primal + stats->at->dual + stats->at->gap;
    #line 400 "iiwa_dnn/control/cycle.py"
    if (settings->at->duration > 0.0) {
        #line 401 "iiwa_dnn/control/cycle.py"
        for (int64_t i = 0; i < state.size0; i++) {
            #line 402 "iiwa_dnn/control/cycle.py"
            size += fabs(state.data[i]);
        }
    }
    #line 403 "iiwa_dnn/control/cycle.py"
    if (!(size < INFINITY)) {
        #line 404 "iiwa_dnn/control/cycle.py"
        return control_command_NOT_FINITE;
    }
    #line 405 "iiwa_dnn/control/cycle.py"
    if (settings->at->duration > 0.0) {
        #line 406 "iiwa_dnn/control/cycle.py"
        return control_command_ADVANCED;
    }
    #line 407 "iiwa_dnn/control/cycle.py"
    const double tol = settings->at->tolerance;
    #line 408 "iiwa_dnn/control/cycle.py"
    if (qp_residuals_within(arena, stats->at->primal, stats->at->dual, stats->at->gap, tol) || qp_residuals_is_small_enough(arena, qp, point, tol, 0.0)) {
        #line 409 "iiwa_dnn/control/cycle.py"
        return control_command_SOLVED;
    }
    #line 410 "iiwa_dnn/control/cycle.py"
    return control_command_NOT_CONVERGED;
}

/* Answer the program of a log by the network, and write point, stats and status into the log.
 *
 * Returns:
 *     True if the network converged or, in continuous mode, was advanced; `state` (size,) is then
 *     overwritten, else unchanged.
 *
 * iiwa_dnn/control/cycle.py: _answer */
static inline bool control_cycle_answer(struct arena *arena, const control_command_StepLog *log, const schemes_program_ProgramArrays *arrays, const networks_integrators_base_CompiledAnswer *network, Vector state)
{
    const struct arena mark = *arena;
    #line 368 "iiwa_dnn/control/cycle.py"
    #line 374 "iiwa_dnn/control/cycle.py"
    const qp_layout_QPViews qp = schemes_program_program_views(arena, log->program, &arrays->sizes);
    #line 375 "iiwa_dnn/control/cycle.py"
    const Vector before = {(double *)arena_copy(arena, state.data, state.size0), state.size0};
    #line 376 "iiwa_dnn/control/cycle.py"
    const networks_integrators_base_SolveStats stats = log->stats;
    #line 377 "iiwa_dnn/control/cycle.py"
    const double_5 own_1 = networks_integrators_base_enter_answer(arena, network->address, &qp, network->rates, &network->settings, state, log->point);
    stats.at->iterations = own_1.at[0];
    stats.at->time = own_1.at[1];
    stats.at->primal = own_1.at[2];
    stats.at->dual = own_1.at[3];
    stats.at->gap = own_1.at[4];
    #line 380 "iiwa_dnn/control/cycle.py"
    log->at->fraction = 1.0;
    #line 381 "iiwa_dnn/control/cycle.py"
    log->at->status = (double)control_cycle_status_of(arena, &qp, log->point, &stats, &network->settings, state);
    #line 382 "iiwa_dnn/control/cycle.py"
    if ((int64_t)log->at->status >= control_command_NOT_CONVERGED) {
        #line 383 "iiwa_dnn/control/cycle.py"
        qp_layout_copied(arena, state, before);
        #line 384 "iiwa_dnn/control/cycle.py"
        arena_leave(arena, &mark);
        return false;
    }
    #line 385 "iiwa_dnn/control/cycle.py"
    arena_leave(arena, &mark);
    return true;
}

/* Write the command of a step into its log and the next state.
 *
 * Args:
 *     log: The step's log; `dq` and `next_q` are overwritten.
 *     next_motion_state: State for the next step; `last` is overwritten.
 *     dq: The command [rad/s], (dof,); further entries are ignored.
 *     dt: Control period [s].
 *
 * iiwa_dnn/control/command.py: note_command */
static inline void control_command_note_command(struct arena *arena, const control_command_StepLog *log, const control_state_MotionState *next_motion_state, Vector dq, double dt)
{
    (void)arena;
    #line 103 "iiwa_dnn/control/command.py"
    #line 111 "iiwa_dnn/control/command.py"
    for (int64_t i = 0, end_i = log->dq.size0; i < end_i; i++) {
        #line 112 "iiwa_dnn/control/command.py"
        log->dq.data[i] = dq.data[i];
        #line 113 "iiwa_dnn/control/command.py"
        next_motion_state->last.data[i] = dq.data[i];
        #line 114 "iiwa_dnn/control/command.py"
        log->next_q.data[i] = log->q.data[i] + dt * dq.data[i];
    }
}

/* Compute the coefficient b of a cubic that reaches zero after a number of periods [rad/s].
 *
 * Args:
 *     x: Velocity at the start [rad/s].
 *     before: Velocity one period earlier [rad/s]; the cubic goes through it or, if `vary`, its
 *         tangent at the start does.
 *     periods: Number M of periods until zero, above 0.
 *     vary: Whether periods vary.
 *
 * iiwa_dnn/control/stopping.py: cubic_coefficient */
static inline double control_stopping_cubic_coefficient(struct arena *arena, double x, double before, double periods, bool vary)
{
    (void)arena;
    #line 100 "iiwa_dnn/control/stopping.py"
    #line 109 "iiwa_dnn/control/stopping.py"
    if (vary) {
        #line 110 "iiwa_dnn/control/stopping.py"
        return periods * (x - before);
    }
    #line 111 "iiwa_dnn/control/stopping.py"
    const double u = 1.0 / periods;
    #line 112 "iiwa_dnn/control/stopping.py"
    return (x * (1.0 - 3.0 * u * u - 2.0 * u * u * u) - before) / (u * (1.0 + u) * (1.0 + u));
}

/* Compute the velocity [rad/s] at the fraction u of a motion to rest from x, coefficient b.
 *
 * iiwa_dnn/control/stopping.py: velocity_at */
static inline double control_stopping_velocity_at(struct arena *arena, double x, double b, double u, bool cubic)
{
    (void)arena;
    #line 117 "iiwa_dnn/control/stopping.py"
    #line 118 "iiwa_dnn/control/stopping.py"
    const double left = 1.0 - u;
    #line 119 "iiwa_dnn/control/stopping.py"
    if (!cubic) {
        #line 120 "iiwa_dnn/control/stopping.py"
        return x * left;
    }
    #line 121 "iiwa_dnn/control/stopping.py"
    return left * left * (x * (1.0 + 2.0 * u) + b * u);
}

/* Compute the velocity after the first period of a motion to rest [rad/s].
 *
 * Args:
 *     x: Velocity at the start [rad/s].
 *     before: Velocity one period earlier [rad/s].
 *     periods: Number of periods until rest.
 *     cubic: Whether the velocities are cubic in time, else linear.
 *
 * iiwa_dnn/control/stopping.py: next_velocity */
static inline double control_stopping_next_velocity(struct arena *arena, double x, double before, double periods, bool cubic)
{
    #line 126 "iiwa_dnn/control/stopping.py"
    #line 134 "iiwa_dnn/control/stopping.py"
    if (periods <= 1.0) {
        #line 135 "iiwa_dnn/control/stopping.py"
        return 0.0;
    }
    #line 136 "iiwa_dnn/control/stopping.py"
    const double b = cubic ? control_stopping_cubic_coefficient(arena, x, before, periods, false) : 0.0;
    #line 137 "iiwa_dnn/control/stopping.py"
    return control_stopping_velocity_at(arena, x, b, 1.0 / periods, cubic);
}

/* Test whether the cubic motion of a joint to rest keeps its acceleration and jerk limits.
 *
 * Args:
 *     x: Present velocity [rad/s].
 *     before: Velocity one period earlier [rad/s].
 *     periods: Number of periods until rest.
 *     accel: Largest change of velocity in a period [rad/s].
 *     jerk: Largest change of that change in a period [rad/s].
 *     vary: Whether the later periods may be shorter.
 *
 * iiwa_dnn/control/stopping.py: within_rates */
static inline bool control_stopping_within_rates(struct arena *arena, double x, double before, double periods, double accel, double jerk, bool vary)
{
    #line 212 "iiwa_dnn/control/stopping.py"
    #line 222 "iiwa_dnn/control/stopping.py"
    if (periods < 0.5) {
        #line 223 "iiwa_dnn/control/stopping.py"
        return x == 0.0 && before == 0.0;
    }
    #line 224 "iiwa_dnn/control/stopping.py"
    const double b = control_stopping_cubic_coefficient(arena, x, before, periods, vary);
    #line 225 "iiwa_dnn/control/stopping.py"
    const double u = 1.0 / periods;
    #line 226 "iiwa_dnn/control/stopping.py"
    const double end = vary ? 0.0 : u;
    #line 228 "iiwa_dnn/control/stopping.py"
    double largest = double_max(fabs(6.0 * x + 4.0 * b), fabs(x * (6.0 - 12.0 * end) + b * (2.0 - 6.0 * end)));
    #line 229 "iiwa_dnn/control/stopping.py"
    largest = double_max(largest, fabs(x * (3.0 - 2.0 * u) + b * (1.0 - u)));
    #line 230 "iiwa_dnn/control/stopping.py"
    if (largest * u * u > jerk * (1.0 + control_stopping_SLACK)) {
        #line 231 "iiwa_dnn/control/stopping.py"
        return false;
    }
    #line 232 "iiwa_dnn/control/stopping.py"
    const double most = accel * (1.0 + control_stopping_SLACK);
    #line 233 "iiwa_dnn/control/stopping.py"
    const double turn = 12.0 * x + 6.0 * b;
    #line 234 "iiwa_dnn/control/stopping.py"
    const double at = turn != 0.0 ? (6.0 * x + 4.0 * b) / turn : 0.0;
    #line 235 "iiwa_dnn/control/stopping.py"
    const double steepest = fabs(-6.0 * x * at * (1.0 - at) + b * (1.0 - at) * (1.0 - 3.0 * at)) * u;
    #line 236 "iiwa_dnn/control/stopping.py"
    if ((end <= at && at < 1.0) && steepest > most) {
        #line 237 "iiwa_dnn/control/stopping.py"
        return false;
    }
    #line 238 "iiwa_dnn/control/stopping.py"
    return fabs(control_stopping_next_velocity(arena, x, before, periods, true) - x) <= most;
}

/* Compute the number of periods in which all joints can come to rest together.
 *
 * Without a jerk limit it is the least number. With one, the number is raised by a tenth and
 * rounded up until every joint keeps its limits, so it may be larger than the least.
 *
 * Args:
 *     x: Present velocities [rad/s], (n,).
 *     before: Velocities one period earlier [rad/s], (n,).
 *     limits: Limits of the joints, of which acceleration and jerk are read.
 *     dt: Control period [s].
 *     cubic: Whether a jerk is limited.
 *     vary: Whether the later periods may be shorter.
 *
 * Returns:
 *     Number M of periods, 0 at rest; inf if it would be above `LONGEST`.
 *
 * iiwa_dnn/control/stopping.py: least_periods */
static inline double control_stopping_least_periods(struct arena *arena, Vector x, Vector before, const schemes_rate_limits_MotionConstants *limits, double dt, bool cubic, bool vary)
{
    #line 144 "iiwa_dnn/control/stopping.py"
    #line 160 "iiwa_dnn/control/stopping.py"
    const Vector accelerations = limits->acceleration;
    #line 161 "iiwa_dnn/control/stopping.py"
    const Vector jerks = limits->jerk;
    #line 162 "iiwa_dnn/control/stopping.py"
    double periods = 0.0;
    #line 163 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0; i < x.size0; i++) {
        #line 164 "iiwa_dnn/control/stopping.py"
        const int64_t fewest = int_ceil(fabs(x.data[i]) / (accelerations.data[i] * dt) * (1.0 - control_stopping_SLACK));
        #line 165 "iiwa_dnn/control/stopping.py"
        periods = double_max(periods, (double)fewest);
    }
    #line 166 "iiwa_dnn/control/stopping.py"
    int64_t i = 0;
    #line 167 "iiwa_dnn/control/stopping.py"
    while (cubic && i < x.size0) {
        #line 168 "iiwa_dnn/control/stopping.py"
        if (periods > control_stopping_LONGEST) {
            #line 169 "iiwa_dnn/control/stopping.py"
            return INFINITY;
        }
        #line 170 "iiwa_dnn/control/stopping.py"
        const double jerk = jerks.data[i] * dt * dt;
        #line 171 "iiwa_dnn/control/stopping.py"
        if (control_stopping_within_rates(arena, x.data[i], before.data[i], periods, accelerations.data[i] * dt, jerk, vary)) {
            #line 172 "iiwa_dnn/control/stopping.py"
            i += 1;
        } else {
            #line 174 "iiwa_dnn/control/stopping.py"
            periods = double_max(1.0, (double)int_ceil(control_stopping_GROWTH * periods));
            #line 175 "iiwa_dnn/control/stopping.py"
            i = 0;
        }
    }
    #line 176 "iiwa_dnn/control/stopping.py"
    return periods;
}

/* Compute the coefficient of each joint's motion to rest, as `cubic_coefficient`.
 *
 * Args:
 *     dq: The command that the motion begins with [rad/s], (dof,).
 *     before: The command before it [rad/s], (dof,).
 *     periods: Periods until rest.
 *     vary: Whether periods vary.
 *     coefficient: The coefficients, (dof,), overwritten.
 *
 * iiwa_dnn/control/stopping.py: write_cubic_coefficients */
static inline void control_stopping_write_cubic_coefficients(struct arena *arena, Vector dq, Vector before, double periods, bool vary, Vector coefficient)
{
    #line 415 "iiwa_dnn/control/stopping.py"
    #line 424 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0; i < dq.size0; i++) {
        #line 425 "iiwa_dnn/control/stopping.py"
        coefficient.data[i] = control_stopping_cubic_coefficient(arena, dq.data[i], before.data[i], periods, vary);
    }
}

/* Compute the displacement over the first `count` periods of a motion to rest [rad].
 *
 * `motion` states the number of periods and the kind of curve; x and b [rad/s] are a joint's
 * first velocity and coefficient, or in [m/s] those of a point, for a displacement in [m].
 *
 * iiwa_dnn/control/stopping.py: displacement_after */
static inline double control_stopping_displacement_after(struct arena *arena, const control_stopping_Motion *motion, double x, double b, double count, double dt)
{
    (void)arena;
    #line 243 "iiwa_dnn/control/stopping.py"
    #line 248 "iiwa_dnn/control/stopping.py"
    const double M = double_max(motion->periods, 1.0);
    #line 249 "iiwa_dnn/control/stopping.py"
    const double first = 0.5 * count * (count - 1.0) / M;
    #line 250 "iiwa_dnn/control/stopping.py"
    if (!motion->cubic) {
        #line 251 "iiwa_dnn/control/stopping.py"
        return dt * x * (count - first);
    }
    #line 252 "iiwa_dnn/control/stopping.py"
    const double second = first * (2.0 * count - 1.0) / (3.0 * M);
    #line 253 "iiwa_dnn/control/stopping.py"
    const double third = first * first / M;
    #line 254 "iiwa_dnn/control/stopping.py"
    return dt * (x * (count - 3.0 * second + 2.0 * third) + b * (first - 2.0 * second + third));
}

/* Compute the least displacement along a motion to rest, at most 0, its value at the start.
 *
 * Arguments and unit are those of `displacement_after`.
 *
 * iiwa_dnn/control/stopping.py: least_displacement */
static inline double control_stopping_least_displacement(struct arena *arena, const control_stopping_Motion *motion, double x, double b, double dt)
{
    #line 259 "iiwa_dnn/control/stopping.py"
    #line 263 "iiwa_dnn/control/stopping.py"
    const double M = motion->periods;
    #line 264 "iiwa_dnn/control/stopping.py"
    double least = double_min(0.0, control_stopping_displacement_after(arena, motion, x, b, M, dt));
    #line 265 "iiwa_dnn/control/stopping.py"
    const double turn = 2.0 * x + b;
    #line 266 "iiwa_dnn/control/stopping.py"
    if (motion->cubic && x * turn < 0.0) {
        #line 267 "iiwa_dnn/control/stopping.py"
        least = double_min(least, control_stopping_displacement_after(arena, motion, x, b, double_min((double)int_ceil(-x / turn * M), M), dt));
    }
    #line 268 "iiwa_dnn/control/stopping.py"
    return least;
}

/* Compute the displacement with which a limit on a joint or a distance is tested.
 *
 * If the motion starts fast enough in the positive direction, with x >= max(b / 3 M, 0), it is the
 * displacement at rest; else the least along the motion. If periods vary, a bound on their effect
 * is subtracted. Arguments and unit are those of `displacement_after`.
 *
 * iiwa_dnn/control/stopping.py: end_displacement */
static inline double control_stopping_end_displacement(struct arena *arena, const control_stopping_Motion *motion, double x, double b, double dt)
{
    #line 273 "iiwa_dnn/control/stopping.py"
    #line 279 "iiwa_dnn/control/stopping.py"
    double displacement = control_stopping_displacement_after(arena, motion, x, b, motion->periods, dt);
    #line 280 "iiwa_dnn/control/stopping.py"
    if (x < double_max(b / (3.0 * motion->periods), 0.0)) {
        #line 281 "iiwa_dnn/control/stopping.py"
        displacement = control_stopping_least_displacement(arena, motion, x, b, dt);
    }
    #line 282 "iiwa_dnn/control/stopping.py"
    if (motion->skips && x > 0.0 && 2.0 * x + b < 0.0) {
        #line 283 "iiwa_dnn/control/stopping.py"
        displacement += control_stopping_least_displacement(arena, motion, -x, -b, dt);
    }
    #line 284 "iiwa_dnn/control/stopping.py"
    return motion->varies ? displacement - control_stopping_UNEVEN * dt * fabs(b) : displacement;
}

/* Test whether joint i keeps its position-dependent velocity limit on a motion to rest.
 *
 * The joints are at q (n,) [rad]; `dt` is the control period [s].
 *
 * iiwa_dnn/control/stopping.py: keeps_varying_limit */
static inline bool control_stopping_keeps_varying_limit(struct arena *arena, const control_stopping_Motion *motion, Vector q, const schemes_rate_limits_MotionConstants *limits, double dt, int64_t i)
{
    #line 314 "iiwa_dnn/control/stopping.py"
    #line 318 "iiwa_dnn/control/stopping.py"
    double at = q.data[i];
    #line 319 "iiwa_dnn/control/stopping.py"
    for (int64_t k = 0, end_k = int_of(motion->periods); k < end_k; k++) {
        #line 320 "iiwa_dnn/control/stopping.py"
        const double x = control_stopping_velocity_at(arena, motion->first.data[i], motion->coefficient.data[i], (double)k / motion->periods, motion->cubic);
        #line 321 "iiwa_dnn/control/stopping.py"
        double left = x > 0.0 ? limits->upper.data[i] - at : at - limits->lower.data[i];
        #line 322 "iiwa_dnn/control/stopping.py"
        if (motion->varies) {
            #line 323 "iiwa_dnn/control/stopping.py"
            left -= dt * fabs(x);
        }
        #line 324 "iiwa_dnn/control/stopping.py"
        const double needed = x * x / (2.0 * limits->slope.data[i]) + fabs(x) * limits->lag.data[i];
        #line 325 "iiwa_dnn/control/stopping.py"
        if (needed > double_max(left, 0.0) * (1.0 + control_stopping_SLACK)) {
            #line 326 "iiwa_dnn/control/stopping.py"
            return false;
        }
        #line 327 "iiwa_dnn/control/stopping.py"
        at += dt * x;
    }
    #line 328 "iiwa_dnn/control/stopping.py"
    return true;
}

/* Test whether joints at q (n,) [rad] keep position and velocity limits on a motion to rest.
 *
 * A joint outside its position limits must not move further out. `dt` is the control period [s].
 *
 * iiwa_dnn/control/stopping.py: keeps_joint_limits */
static inline bool control_stopping_keeps_joint_limits(struct arena *arena, const control_stopping_Motion *motion, Vector q, const schemes_rate_limits_MotionConstants *limits, double dt)
{
    #line 289 "iiwa_dnn/control/stopping.py"
    #line 293 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0; i < q.size0; i++) {
        #line 294 "iiwa_dnn/control/stopping.py"
        const double x = motion->first.data[i];
        #line 295 "iiwa_dnn/control/stopping.py"
        const double b = motion->coefficient.data[i];
        #line 296 "iiwa_dnn/control/stopping.py"
        const double top = q.data[i] - double_min(control_stopping_end_displacement(arena, motion, -x, -b, dt), 0.0);
        #line 297 "iiwa_dnn/control/stopping.py"
        const double bottom = q.data[i] + double_min(control_stopping_end_displacement(arena, motion, x, b, dt), 0.0);
        #line 298 "iiwa_dnn/control/stopping.py"
        if (top > double_max(limits->upper.data[i], q.data[i]) || bottom < double_min(limits->lower.data[i], q.data[i])) {
            #line 299 "iiwa_dnn/control/stopping.py"
            return false;
        }
        #line 300 "iiwa_dnn/control/stopping.py"
        const double steepest = 6.0 * x + 3.0 * b;
        #line 301 "iiwa_dnn/control/stopping.py"
        const double u = steepest != 0.0 ? b / steepest : 0.0;
        #line 302 "iiwa_dnn/control/stopping.py"
        const double fastest = limits->velocity.data[i] * (1.0 + control_stopping_SLACK);
        #line 303 "iiwa_dnn/control/stopping.py"
        if ((0.0 < u && u < 1.0) && fabs(control_stopping_velocity_at(arena, x, b, u, true)) > fastest) {
            #line 304 "iiwa_dnn/control/stopping.py"
            return false;
        }
        #line 305 "iiwa_dnn/control/stopping.py"
        if (limits->lag.data[i] > 0.0 && !control_stopping_keeps_varying_limit(arena, motion, q, limits, dt, i)) {
            #line 306 "iiwa_dnn/control/stopping.py"
            return false;
        }
    }
    #line 307 "iiwa_dnn/control/stopping.py"
    return true;
}

/* Write the placements of all bodies in the world.
 *
 * Args:
 *     scene: The scene, b bodies.
 *     placements: `Kinematics.placements`, (frames, 12).
 *     placed: A `Placement` in each row, (b, 12), overwritten.
 *
 * iiwa_dnn/schemes/scene.py: place_bodies */
static inline void schemes_scene_place_bodies(struct arena *arena, const schemes_scene_SceneViews *scene, Matrix placements, Matrix placed)
{
    (void)arena;
    #line 383 "iiwa_dnn/schemes/scene.py"
    #line 390 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0, end_k = scene->bodies.size0; k < end_k; k++) {
        #line 391 "iiwa_dnn/schemes/scene.py"
        const schemes_scene_Body body = schemes_scene_Body_of((Vector){scene->bodies.data + k * scene->bodies.size1, scene->bodies.size1});
        #line 392 "iiwa_dnn/schemes/scene.py"
        const robot_kinematics_Placement frame = robot_kinematics_Placement_of((Vector){placements.data + (int64_t)body.at->frame * placements.size1, placements.size1});
        #line 393 "iiwa_dnn/schemes/scene.py"
        const robot_kinematics_Placement here = robot_kinematics_Placement_of((Vector){placed.data + k * placed.size1, placed.size1});
        #line 394 "iiwa_dnn/schemes/scene.py"
        for (int64_t i = 0; i < 3; i++) {
            #line 395 "iiwa_dnn/schemes/scene.py"
            here.position.data[i] = frame.position.data[i];
            #line 396 "iiwa_dnn/schemes/scene.py"
            for (int64_t j = 0; j < 3; j++) {
                #line 397 "iiwa_dnn/schemes/scene.py"
                here.position.data[i] += frame.axes.data[j * frame.axes.size1 + i] * body.center.data[j];
                #line 398 "iiwa_dnn/schemes/scene.py"
                here.axes.data[j * here.axes.size1 + i] = 0.0;
                #line 399 "iiwa_dnn/schemes/scene.py"
                for (int64_t axis = 0; axis < 3; axis++) {
                    #line 400 "iiwa_dnn/schemes/scene.py"
                    here.axes.data[j * here.axes.size1 + i] += frame.axes.data[axis * frame.axes.size1 + i] * body.axes.data[j * body.axes.size1 + axis];
                }
            }
        }
    }
}

/* Compute a u + b v.
 *
 * iiwa_dnn/references/rotations.py: combined */
static inline double_3 references_rotations_combined(struct arena *arena, double a, double_3 u, double b, double_3 v)
{
    (void)arena;
    #line 33 "iiwa_dnn/references/rotations.py"
    #line 34 "iiwa_dnn/references/rotations.py"
    return (double_3){{a * u.at[0] + b * v.at[0], a * u.at[1] + b * v.at[1], a * u.at[2] + b * v.at[2]}};
}

/* Compute the two ends of a body's segment in the world [m].
 *
 * Args:
 *     scene: The scene, b bodies.
 *     placed: Placements of the bodies, (b, 12).
 *     body: Index of the body.
 *
 * iiwa_dnn/schemes/scene.py: ends_of */
static inline double_3_2 schemes_scene_ends_of(struct arena *arena, const schemes_scene_SceneViews *scene, Matrix placed, int64_t body)
{
    #line 405 "iiwa_dnn/schemes/scene.py"
    #line 412 "iiwa_dnn/schemes/scene.py"
    const robot_kinematics_Placement place = robot_kinematics_Placement_of((Vector){placed.data + body * placed.size1, placed.size1});
    #line 413 "iiwa_dnn/schemes/scene.py"
    const double_3 center = references_rotations_triple(arena, place.position);
    #line 414 "iiwa_dnn/schemes/scene.py"
    const double_3 axis = references_rotations_triple(arena, (Vector){place.axes.data + 2 * place.axes.size1, place.axes.size1});
    #line 415 "iiwa_dnn/schemes/scene.py"
    const Vector own_1 = schemes_scene_Body_of((Vector){scene->bodies.data + body * scene->bodies.size1, scene->bodies.size1}).half;
    const double half = own_1.data[2];
    #line 416 "iiwa_dnn/schemes/scene.py"
    return (double_3_2){{references_rotations_combined(arena, 1.0, center, -half, axis), references_rotations_combined(arena, 1.0, center, half, axis)}};
}

/* Rotate a vector (3,) from the world's coordinates into those of a placed frame.
 *
 * iiwa_dnn/schemes/step.py: seen_from */
static inline double_3 schemes_step_seen_from(struct arena *arena, const robot_kinematics_Placement *placement, double_3 v)
{
    #line 161 "iiwa_dnn/schemes/step.py"
    #line 162 "iiwa_dnn/schemes/step.py"
    const double x = references_rotations_dot(arena, references_rotations_triple(arena, (Vector){placement->axes.data, placement->axes.size1}), v);
    #line 163 "iiwa_dnn/schemes/step.py"
    const double y = references_rotations_dot(arena, references_rotations_triple(arena, (Vector){placement->axes.data + placement->axes.size1, placement->axes.size1}), v);
    #line 164 "iiwa_dnn/schemes/step.py"
    return (double_3){{x, y, references_rotations_dot(arena, references_rotations_triple(arena, (Vector){placement->axes.data + 2 * placement->axes.size1, placement->axes.size1}), v)}};
}

/* Return the vector to a point x (3,) from the nearest point of a box of half-extents (3,).
 *
 * iiwa_dnn/schemes/scene.py: beyond */
static inline double_3 schemes_scene_beyond(struct arena *arena, double_3 x, double_3 half)
{
    (void)arena;
    #line 526 "iiwa_dnn/schemes/scene.py"
    #line 527 "iiwa_dnn/schemes/scene.py"
    return (double_3){{x.at[0] - double_min(double_max(x.at[0], -half.at[0]), half.at[0]), x.at[1] - double_min(double_max(x.at[1], -half.at[1]), half.at[1]), x.at[2] - double_min(double_max(x.at[2], -half.at[2]), half.at[2])}};
}

/* Compute the s in [0, 1] of the point a + s u of a segment that is nearest to a box.
 *
 * Half the derivative of the squared distance grows with s. Its root is found by regula falsi with
 * a bisection at each third step.
 *
 * Args:
 *     a: One end in the coordinates of the box [m], (3,).
 *     u: Vector to the other end [m], (3,).
 *     half: Half-extents of the box [m], (3,).
 *
 * iiwa_dnn/schemes/scene.py: nearest_parameter */
static inline double schemes_scene_nearest_parameter(struct arena *arena, double_3 a, double_3 u, double_3 half)
{
    #line 536 "iiwa_dnn/schemes/scene.py"
    #line 546 "iiwa_dnn/schemes/scene.py"
    double low = 0.0;
    #line 547 "iiwa_dnn/schemes/scene.py"
    double high = 1.0;
    #line 548 "iiwa_dnn/schemes/scene.py"
    double below = references_rotations_dot(arena, u, schemes_scene_beyond(arena, a, half));
    #line 549 "iiwa_dnn/schemes/scene.py"
    double above = references_rotations_dot(arena, u, schemes_scene_beyond(arena, references_rotations_combined(arena, 1.0, a, 1.0, u), half));
    #line 550 "iiwa_dnn/schemes/scene.py"
    if (below >= 0.0) {
        #line 551 "iiwa_dnn/schemes/scene.py"
        return low;
    }
    #line 552 "iiwa_dnn/schemes/scene.py"
    if (above <= 0.0) {
        #line 553 "iiwa_dnn/schemes/scene.py"
        return high;
    }
    #line 554 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0; k < schemes_scene_ROUNDS; k++) {
        #line 555 "iiwa_dnn/schemes/scene.py"
        const double fraction = int_remainder(k, 3) == 2 ? 0.5 : below / (below - above);
        #line 556 "iiwa_dnn/schemes/scene.py"
        const double middle = low + fraction * (high - low);
        #line 557 "iiwa_dnn/schemes/scene.py"
        const double slope = references_rotations_dot(arena, u, schemes_scene_beyond(arena, references_rotations_combined(arena, 1.0, a, middle, u), half));
        #line 558 "iiwa_dnn/schemes/scene.py"
        if (slope == 0.0 || !(low < middle && middle < high)) {
            #line 559 "iiwa_dnn/schemes/scene.py"
            return middle;
        }
        #line 560 "iiwa_dnn/schemes/scene.py"
        if (slope < 0.0) {
            #line 561 "iiwa_dnn/schemes/scene.py"
            low = middle;
            #line 562 "iiwa_dnn/schemes/scene.py"
            below = slope;
        } else {
            #line 564 "iiwa_dnn/schemes/scene.py"
            high = middle;
            #line 565 "iiwa_dnn/schemes/scene.py"
            above = slope;
        }
    }
    #line 566 "iiwa_dnn/schemes/scene.py"
    return 0.5 * (low + high);
}

/* Compute the signed distance of a point x (3,) to the nearest face of a box, negative inside.
 *
 * Returns:
 *     The distance along the outer normal of the face [m], and the normal's components.
 *
 * iiwa_dnn/schemes/scene.py: depth */
static inline double_4 schemes_scene_depth(struct arena *arena, double_3 x, double_3 half)
{
    (void)arena;
    #line 571 "iiwa_dnn/schemes/scene.py"
    #line 576 "iiwa_dnn/schemes/scene.py"
    double found = -1e+300;
    #line 577 "iiwa_dnn/schemes/scene.py"
    int64_t axis = 2;
    #line 578 "iiwa_dnn/schemes/scene.py"
    double sign = 1.0;
    #line 579 "iiwa_dnn/schemes/scene.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 580 "iiwa_dnn/schemes/scene.py"
        if (fabs(x.at[i]) - half.at[i] > found) {
            #line 581 "iiwa_dnn/schemes/scene.py"
            found = fabs(x.at[i]) - half.at[i];
            #line 582 "iiwa_dnn/schemes/scene.py"
            sign = x.at[i] >= 0.0 ? 1.0 : -1.0;
            #line 583 "iiwa_dnn/schemes/scene.py"
            axis = i;
        }
    }
    #line 584 "iiwa_dnn/schemes/scene.py"
    return (double_4){{found, sign * (axis == 0), sign * (axis == 1), sign * (axis == 2)}};
}

/* Compute a u.
 *
 * iiwa_dnn/references/rotations.py: scaled */
static inline double_3 references_rotations_scaled(struct arena *arena, double a, double_3 u)
{
    (void)arena;
    #line 27 "iiwa_dnn/references/rotations.py"
    #line 28 "iiwa_dnn/references/rotations.py"
    return (double_3){{a * u.at[0], a * u.at[1], a * u.at[2]}};
}

/* Rotate a vector (3,) from the coordinates of a placed frame into the world's.
 *
 * iiwa_dnn/schemes/step.py: axis_at */
static inline double_3 schemes_step_axis_at(struct arena *arena, const robot_kinematics_Placement *placement, double_3 axis)
{
    #line 153 "iiwa_dnn/schemes/step.py"
    #line 154 "iiwa_dnn/schemes/step.py"
    const double_3 x = references_rotations_scaled(arena, axis.at[0], references_rotations_triple(arena, (Vector){placement->axes.data, placement->axes.size1}));
    #line 155 "iiwa_dnn/schemes/step.py"
    const double_3 y = references_rotations_triple(arena, (Vector){placement->axes.data + placement->axes.size1, placement->axes.size1});
    #line 156 "iiwa_dnn/schemes/step.py"
    return references_rotations_combined(arena, 1.0, x, 1.0, references_rotations_combined(arena, axis.at[1], y, axis.at[2], references_rotations_triple(arena, (Vector){placement->axes.data + 2 * placement->axes.size1, placement->axes.size1})));
}

/* Compute the nearest points and the distance of pair k.
 *
 * Args:
 *     scene: The scene, b bodies.
 *     k: Index of the pair.
 *     placed: Placements of the bodies, (b, 12).
 *
 * iiwa_dnn/schemes/scene.py: contact_of */
static inline schemes_scene_Contact schemes_scene_contact_of(struct arena *arena, const schemes_scene_SceneViews *scene, int64_t k, Matrix placed)
{
    #line 421 "iiwa_dnn/schemes/scene.py"
    #line 428 "iiwa_dnn/schemes/scene.py"
    const schemes_scene_Pair pair = schemes_scene_Pair_of((Vector){scene->pairs.data + k * scene->pairs.size1, scene->pairs.size1}, int_max(0, (scene->pairs.size1 - (3)) / 2));
    #line 429 "iiwa_dnn/schemes/scene.py"
    const schemes_scene_Body first = schemes_scene_Body_of((Vector){scene->bodies.data + (int64_t)pair.at->first * scene->bodies.size1, scene->bodies.size1});
    #line 430 "iiwa_dnn/schemes/scene.py"
    const robot_kinematics_Placement base = robot_kinematics_Placement_of((Vector){placed.data + (int64_t)pair.at->first * placed.size1, placed.size1});
    #line 431 "iiwa_dnn/schemes/scene.py"
    const double_3 half = references_rotations_triple(arena, first.half);
    #line 432 "iiwa_dnn/schemes/scene.py"
    const double_3_2 own_1 = schemes_scene_ends_of(arena, scene, placed, (int64_t)pair.at->second);
    const double_3 a = own_1.at[0];
    const double_3 b = own_1.at[1];
    #line 433 "iiwa_dnn/schemes/scene.py"
    const double_3 path = references_rotations_combined(arena, 1.0, b, -1.0, a);
    #line 434 "iiwa_dnn/schemes/scene.py"
    const double_3 start = schemes_step_seen_from(arena, &base, references_rotations_combined(arena, 1.0, a, -1.0, references_rotations_triple(arena, base.position)));
    #line 435 "iiwa_dnn/schemes/scene.py"
    const double_3 along = schemes_step_seen_from(arena, &base, path);
    #line 436 "iiwa_dnn/schemes/scene.py"
    const double s = schemes_scene_nearest_parameter(arena, start, along, half);
    #line 437 "iiwa_dnn/schemes/scene.py"
    const double_3 nearest = references_rotations_combined(arena, 1.0, start, s, along);
    #line 438 "iiwa_dnn/schemes/scene.py"
    const double_3 side = schemes_scene_beyond(arena, nearest, half);
    #line 439 "iiwa_dnn/schemes/scene.py"
    double core = sqrt(references_rotations_dot(arena, side, side));
    #line 440 "iiwa_dnn/schemes/scene.py"
    double_3 normal;
    if (core > schemes_scene_MET) {
        #line 441 "iiwa_dnn/schemes/scene.py"
        normal = (double_3){{side.at[0] / core, side.at[1] / core, side.at[2] / core}};
    } else {
        #line 443 "iiwa_dnn/schemes/scene.py"
        const double_4 own_2 = schemes_scene_depth(arena, nearest, half);
        core = own_2.at[0];
        const double x = own_2.at[1];
        const double y = own_2.at[2];
        const double z = own_2.at[3];
        #line 444 "iiwa_dnn/schemes/scene.py"
        const double flat = half.at[0] == 0.0 ? 0.0 : 1.0;
        #line 445 "iiwa_dnn/schemes/scene.py"
        normal = (double_3){{flat * x, flat * y, flat * z}};
    }
    #line 446 "iiwa_dnn/schemes/scene.py"
    const double_3 outward = schemes_step_axis_at(arena, &base, normal);
    #line 447 "iiwa_dnn/schemes/scene.py"
    const double radius = first.at->radius + schemes_scene_Body_of((Vector){scene->bodies.data + (int64_t)pair.at->second * scene->bodies.size1, scene->bodies.size1}).at->radius;
    #line 448 "iiwa_dnn/schemes/scene.py"
    return (schemes_scene_Contact){references_rotations_combined(arena, 1.0, a, s, path), outward, core - radius};
}

/* Compute B of a pair [m], a bound on the curvature of its motion.
 *
 * Args:
 *     pair: The pair.
 *     travel: Displacement of each joint, at least 0 [rad], (n,).
 *
 * iiwa_dnn/schemes/scene.py: second_order */
static inline double schemes_scene_second_order(struct arena *arena, const schemes_scene_Pair *pair, Vector travel)
{
    (void)arena;
    #line 503 "iiwa_dnn/schemes/scene.py"
    #line 509 "iiwa_dnn/schemes/scene.py"
    const int64_t n = travel.size0;
    #line 510 "iiwa_dnn/schemes/scene.py"
    double B = 0.0;
    #line 511 "iiwa_dnn/schemes/scene.py"
    double turning = 0.0;
    #line 512 "iiwa_dnn/schemes/scene.py"
    for (int64_t step = 0; step < 2 * n; step++) {
        #line 513 "iiwa_dnn/schemes/scene.py"
        const int64_t j = step < n ? n - 1 - step : step - n;
        #line 514 "iiwa_dnn/schemes/scene.py"
        if (pair->support.data[j] == 0.0 || (pair->support.data[j] < 0.0) != (step < n)) {
            #line 515 "iiwa_dnn/schemes/scene.py"
            continue;
        }
        #line 516 "iiwa_dnn/schemes/scene.py"
        if (pair->radii.data[j] < 0.0) {
            #line 517 "iiwa_dnn/schemes/scene.py"
            B += 2.0 * travel.data[j] * turning;
        } else {
            #line 519 "iiwa_dnn/schemes/scene.py"
            B += travel.data[j] * pair->radii.data[j] * (2.0 * turning + travel.data[j]);
            #line 520 "iiwa_dnn/schemes/scene.py"
            turning += travel.data[j];
        }
    }
    #line 521 "iiwa_dnn/schemes/scene.py"
    return B;
}

/* Compute the cross product u x v.
 *
 * iiwa_dnn/references/rotations.py: cross */
static inline double_3 references_rotations_cross(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    #line 21 "iiwa_dnn/references/rotations.py"
    #line 22 "iiwa_dnn/references/rotations.py"
    return (double_3){{u.at[1] * v.at[2] - u.at[2] * v.at[1], u.at[2] * v.at[0] - u.at[0] * v.at[2], u.at[0] * v.at[1] - u.at[1] * v.at[0]}};
}

/* Compute the velocity (3,) of a point p (3,) [m] for each unit of velocity of joint j [m/rad].
 *
 * It is v + w x p, with the joint's twist: v of the world's origin, and w.
 *
 * iiwa_dnn/schemes/step.py: point_rate */
static inline double_3 schemes_step_point_rate(struct arena *arena, Matrix jacobian, int64_t j, double_3 point)
{
    #line 169 "iiwa_dnn/schemes/step.py"
    #line 173 "iiwa_dnn/schemes/step.py"
    const robot_kinematics_Twist twist = robot_kinematics_Twist_of((Vector){jacobian.data + j * jacobian.size1, jacobian.size1});
    #line 174 "iiwa_dnn/schemes/step.py"
    return references_rotations_combined(arena, 1.0, references_rotations_triple(arena, twist.linear), 1.0, references_rotations_cross(arena, references_rotations_triple(arena, twist.angular), point));
}

/* Compute the velocity of a point (3,) [m] along a normal (3,) for joint j alone [m/rad].
 *
 * iiwa_dnn/schemes/step.py: rate_along */
static inline double schemes_step_rate_along(struct arena *arena, Matrix jacobian, int64_t j, double_3 point, double_3 normal)
{
    #line 179 "iiwa_dnn/schemes/step.py"
    #line 180 "iiwa_dnn/schemes/step.py"
    return references_rotations_dot(arena, normal, schemes_step_point_rate(arena, jacobian, j, point));
}

/* Compute the velocity of a point along a normal (3,), relative to the pair's first body.
 *
 * Args:
 *     motion: A motion of n joints to rest.
 *     jacobian: Joint Jacobian, `Kinematics.jacobian`, (n, 6).
 *     pair: The pair; the point is of its second body.
 *     point: Position of the point [m], (3,).
 *     normal: Unit normal from the first to the second body, (3,).
 *
 * Returns:
 *     Its first velocity and its coefficient b [m/s].
 *
 * iiwa_dnn/control/stopping.py: _along */
static inline double_2 control_stopping_along(struct arena *arena, const control_stopping_Motion *motion, Matrix jacobian, const schemes_scene_Pair *pair, double_3 point, double_3 normal)
{
    #line 389 "iiwa_dnn/control/stopping.py"
    #line 401 "iiwa_dnn/control/stopping.py"
    double x = 0.0;
    #line 402 "iiwa_dnn/control/stopping.py"
    double b = 0.0;
    #line 403 "iiwa_dnn/control/stopping.py"
    for (int64_t j = 0, end_j = motion->first.size0; j < end_j; j++) {
        #line 404 "iiwa_dnn/control/stopping.py"
        if (pair->support.data[j] != 0.0) {
            #line 405 "iiwa_dnn/control/stopping.py"
            const double rate = pair->support.data[j] * schemes_step_rate_along(arena, jacobian, j, point, normal);
            #line 406 "iiwa_dnn/control/stopping.py"
            x += rate * motion->first.data[j];
            #line 407 "iiwa_dnn/control/stopping.py"
            b += rate * motion->coefficient.data[j];
        }
    }
    #line 408 "iiwa_dnn/control/stopping.py"
    return (double_2){{x, b}};
}

/* Compute how much farther away than the nearest point an end of the segment is [m].
 *
 * It is measured along the normal, and at least 0 whatever rounding does.
 *
 * iiwa_dnn/schemes/scene.py: height_of */
static inline double schemes_scene_height_of(struct arena *arena, double_3 end, const schemes_scene_Contact *contact)
{
    #line 453 "iiwa_dnn/schemes/scene.py"
    #line 457 "iiwa_dnn/schemes/scene.py"
    return double_max(0.0, references_rotations_dot(arena, references_rotations_combined(arena, 1.0, end, -1.0, contact->second), contact->normal));
}

/* Test whether all pairs of a scene surely keep their distance on a motion to rest.
 *
 * The test is by bounds: False may be returned for a motion that would keep all of them.
 * If a pair is nearer than the distance that it has to keep, or a moving obstacle may bring it
 * that near while the arm brakes, the motion of the arm must not reduce its distance.
 *
 * Args:
 *     motion: The motion, of n joints.
 *     arrays: Arrays of the scheme's programs, with the kinematics at the start of the motion.
 *     constants: Numbers of the scene, `Scene.constants`, (k,).
 *     least: Distance that each watched pair of all scenes has to keep [m], (pairs,); 0 stands for
 *         that of the scene.
 *     dt: Control period [s].
 *
 * iiwa_dnn/control/stopping.py: keeps_distances */
static inline bool control_stopping_keeps_distances(struct arena *arena, const control_stopping_Motion *motion, const schemes_program_ProgramArrays *arrays, Vector constants, Vector least, double dt)
{
    const struct arena mark = *arena;
    #line 335 "iiwa_dnn/control/stopping.py"
    #line 349 "iiwa_dnn/control/stopping.py"
    const int64_t n = motion->first.size0;
    #line 350 "iiwa_dnn/control/stopping.py"
    const schemes_scene_SceneViews scene = schemes_scene_scene_views(arena, constants, n);
    #line 351 "iiwa_dnn/control/stopping.py"
    const int64_t own_1 = scene.bodies.size0;
    const int64_t own_2 = 12;
    const Matrix placed = {(double *)arena_empty(arena, own_1 * own_2), own_1, own_2};
    #line 352 "iiwa_dnn/control/stopping.py"
    schemes_scene_place_bodies(arena, &scene, arrays->placements, placed);
    #line 353 "iiwa_dnn/control/stopping.py"
    const double M = motion->periods;
    #line 354 "iiwa_dnn/control/stopping.py"
    const Vector travel = {(double *)arena_empty(arena, n), n};
    #line 355 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0; i < n; i++) {
        #line 356 "iiwa_dnn/control/stopping.py"
        travel.data[i] = control_stopping_displacement_after(arena, motion, fabs(motion->first.data[i]), fabs(motion->coefficient.data[i]), M, dt);
    }
    #line 359 "iiwa_dnn/control/stopping.py"
    for (int64_t k = 0, end_k = scene.pairs.size0; k < end_k; k++) {
        #line 360 "iiwa_dnn/control/stopping.py"
        const schemes_scene_Contact contact = schemes_scene_contact_of(arena, &scene, k, placed);
        #line 361 "iiwa_dnn/control/stopping.py"
        const schemes_scene_Pair pair = schemes_scene_Pair_of((Vector){scene.pairs.data + k * scene.pairs.size1, scene.pairs.size1}, int_max(0, (scene.pairs.size1 - (3)) / 2));
        #line 362 "iiwa_dnn/control/stopping.py"
        const double left = contact.distance - schemes_scene_Body_of((Vector){scene.bodies.data + (int64_t)pair.at->first * scene.bodies.size1, scene.bodies.size1}).at->speed * dt * M;
        #line 363 "iiwa_dnn/control/stopping.py"
        double most = 0.0;
        #line 364 "iiwa_dnn/control/stopping.py"
        for (int64_t i = 0; i < n; i++) {
            #line 365 "iiwa_dnn/control/stopping.py"
            most += fabs(pair.radii.data[i]) * travel.data[i];
        }
        #line 366 "iiwa_dnn/control/stopping.py"
        const double own = least.data[(int64_t)scene.head.at->first + k];
        #line 367 "iiwa_dnn/control/stopping.py"
        const double kept = own != 0.0 ? own : scene.head.at->least;
        #line 368 "iiwa_dnn/control/stopping.py"
        if (left - most >= kept) {
            #line 369 "iiwa_dnn/control/stopping.py"
            continue;
        }
        #line 370 "iiwa_dnn/control/stopping.py"
        double change = INFINITY;
        #line 371 "iiwa_dnn/control/stopping.py"
        const double remainder = 0.5 * schemes_scene_second_order(arena, &pair, travel);
        #line 372 "iiwa_dnn/control/stopping.py"
        const double_3_2 ends = schemes_scene_ends_of(arena, &scene, placed, (int64_t)pair.at->second);
        #line 373 "iiwa_dnn/control/stopping.py"
        for (int64_t at = 0; at < 2; at++) {
            #line 374 "iiwa_dnn/control/stopping.py"
            const double_3 end = ends.at[at];
            #line 375 "iiwa_dnn/control/stopping.py"
            if ((int64_t)pair.at->unmoved_end == at + 1) {
                #line 376 "iiwa_dnn/control/stopping.py"
                continue;
            }
            #line 377 "iiwa_dnn/control/stopping.py"
            const double_2 own_3 = control_stopping_along(arena, motion, arrays->jacobian, &pair, end, contact.normal);
            const double x = own_3.at[0];
            const double coefficient = own_3.at[1];
            #line 378 "iiwa_dnn/control/stopping.py"
            const double displacement = control_stopping_end_displacement(arena, motion, x, coefficient, dt);
            #line 379 "iiwa_dnn/control/stopping.py"
            change = double_min(change, schemes_scene_height_of(arena, end, &contact) + double_min(displacement - remainder, 0.0));
        }
        #line 380 "iiwa_dnn/control/stopping.py"
        if (left + change < double_min(kept, left)) {
            #line 381 "iiwa_dnn/control/stopping.py"
            arena_leave(arena, &mark);
            return false;
        }
    }
    #line 382 "iiwa_dnn/control/stopping.py"
    arena_leave(arena, &mark);
    return true;
}

/* Compute the number of control periods of the stopping motion after a command.
 *
 * Args:
 *     arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
 *     motion_state: State of the motion, with the joint positions and the last command.
 *     least: Distance that each watched pair has to keep [m], (pairs,).
 *     yielding: Limits of the joints, and the scheme's collision avoidance.
 *     timing: Periods of the step.
 *     dq: The command, held for one period before the joints stop [rad/s], (dof,).
 *
 * Returns:
 *     Number of periods of `timing.dt` until rest; -1.0 if the motion breaks a limit of a joint or
 *     a distance; 0.0 if the scheme does not avoid collisions, so that no test is needed.
 *
 * iiwa_dnn/control/stopping.py: stopping_time */
static inline double control_stopping_stopping_time(struct arena *arena, const schemes_program_ProgramArrays *arrays, const control_state_MotionState *motion_state, Vector least, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, Vector dq)
{
    const struct arena mark = *arena;
    #line 437 "iiwa_dnn/control/stopping.py"
    #line 451 "iiwa_dnn/control/stopping.py"
    if (yielding->scenes.size0 == 0) {
        #line 452 "iiwa_dnn/control/stopping.py"
        arena_leave(arena, &mark);
        return 0.0;
    }
    #line 453 "iiwa_dnn/control/stopping.py"
    const schemes_rate_limits_MotionConstants limits = yielding->limits;
    #line 454 "iiwa_dnn/control/stopping.py"
    double dt = timing->longest;
    #line 455 "iiwa_dnn/control/stopping.py"
    const double ratio = dt / timing->dt;
    #line 456 "iiwa_dnn/control/stopping.py"
    const bool vary = timing->vary;
    #line 457 "iiwa_dnn/control/stopping.py"
    const Vector before = {(double *)arena_copy(arena, motion_state->last.data, motion_state->last.size0), motion_state->last.size0};
    #line 458 "iiwa_dnn/control/stopping.py"
    const Vector coefficient = {(double *)arena_zeros(arena, dq.size0), dq.size0};
    #line 459 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0, end_i = vary ? dq.size0 : 0; i < end_i; i++) {
        #line 460 "iiwa_dnn/control/stopping.py"
        before.data[i] = dq.data[i] - ratio * (dq.data[i] - before.data[i]);
    }
    #line 461 "iiwa_dnn/control/stopping.py"
    const bool support = limits.lower.size0 > 0;
    #line 462 "iiwa_dnn/control/stopping.py"
    const double periods = support ? control_stopping_least_periods(arena, dq, before, &limits, dt, yielding->cubic, vary) : 1.0;
    #line 463 "iiwa_dnn/control/stopping.py"
    if (periods == INFINITY) {
        #line 464 "iiwa_dnn/control/stopping.py"
        arena_leave(arena, &mark);
        return -1.0;
    }
    #line 465 "iiwa_dnn/control/stopping.py"
    if (yielding->cubic && periods > 0.0) {
        #line 466 "iiwa_dnn/control/stopping.py"
        control_stopping_write_cubic_coefficients(arena, dq, before, periods, vary, coefficient);
    }
    #line 468 "iiwa_dnn/control/stopping.py"
    const double fraction = timing->fraction;
    #line 469 "iiwa_dnn/control/stopping.py"
    const control_stopping_Motion motion = {dq, coefficient, periods + vary, yielding->cubic, vary, fraction < 1.0};
    #line 470 "iiwa_dnn/control/stopping.py"
    dt = dt / fraction;
    #line 471 "iiwa_dnn/control/stopping.py"
    if (support && !control_stopping_keeps_joint_limits(arena, &motion, motion_state->q, &limits, dt)) {
        #line 472 "iiwa_dnn/control/stopping.py"
        arena_leave(arena, &mark);
        return -1.0;
    }
    #line 473 "iiwa_dnn/control/stopping.py"
    for (int64_t k = 0, end_k = yielding->scenes.size0; k < end_k; k++) {
        #line 474 "iiwa_dnn/control/stopping.py"
        const Vector scene = schemes_program_block_constants(arena, arrays, yielding->scenes.data[k]);
        #line 475 "iiwa_dnn/control/stopping.py"
        if (!control_stopping_keeps_distances(arena, &motion, arrays, scene, least, dt)) {
            #line 476 "iiwa_dnn/control/stopping.py"
            arena_leave(arena, &mark);
            return -1.0;
        }
    }
    #line 477 "iiwa_dnn/control/stopping.py"
    const double own_result = periods * ratio;
    arena_leave(arena, &mark);
    return own_result;
}

/* Test whether the arm can stop after a step's command without breaking a limit or distance.
 *
 * Args:
 *     arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
 *     motion_state: State of the motion.
 *     next_motion_state: State for the next step, with the command in `last`; `stopping_periods`
 *         is overwritten.
 *     yielding: Limits of the joints, and the scheme's collision avoidance.
 *     timing: Periods of the step.
 *
 * iiwa_dnn/control/yielding.py: guard_step */
static inline bool control_yielding_guard_step(struct arena *arena, const schemes_program_ProgramArrays *arrays, const control_state_MotionState *motion_state, const control_state_MotionState *next_motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing)
{
    #line 564 "iiwa_dnn/control/yielding.py"
    #line 574 "iiwa_dnn/control/yielding.py"
    const double rest = control_stopping_stopping_time(arena, arrays, motion_state, next_motion_state->least, yielding, timing, next_motion_state->last);
    #line 577 "iiwa_dnn/control/yielding.py"
    next_motion_state->at->stopping_periods = double_max(rest, 0.0);
    #line 578 "iiwa_dnn/control/yielding.py"
    return rest >= 0.0;
}

/* Compute `dot` in `PARTS` sums, which are added at last.
 *
 * iiwa_dnn/qp/dense.py: _long_dot */
static inline double qp_dense_long_dot(struct arena *arena, double start, Vector a, Vector b)
{
    (void)arena;
    #line 40 "iiwa_dnn/qp/dense.py"
    #line 41 "iiwa_dnn/qp/dense.py"
    double one = start;
    #line 42 "iiwa_dnn/qp/dense.py"
    double two = 0.0;
    #line 43 "iiwa_dnn/qp/dense.py"
    double three = 0.0;
    #line 44 "iiwa_dnn/qp/dense.py"
    double four = 0.0;
    #line 45 "iiwa_dnn/qp/dense.py"
    for (int64_t part = 0, end_part = int_quotient(a.size0, qp_dense_PARTS); part < end_part; part++) {
        #line 46 "iiwa_dnn/qp/dense.py"
        const int64_t i = qp_dense_PARTS * part;
        #line 47 "iiwa_dnn/qp/dense.py"
        one += a.data[i] * b.data[i];
        #line 48 "iiwa_dnn/qp/dense.py"
        two += a.data[i + 1] * b.data[i + 1];
        #line 49 "iiwa_dnn/qp/dense.py"
        three += a.data[i + 2] * b.data[i + 2];
        #line 50 "iiwa_dnn/qp/dense.py"
        four += a.data[i + 3] * b.data[i + 3];
    }
    #line 51 "iiwa_dnn/qp/dense.py"
    double value = one + two + (three + four);
    #line 52 "iiwa_dnn/qp/dense.py"
    for (int64_t k = a.size0 - int_remainder(a.size0, qp_dense_PARTS); k < a.size0; k++) {
        #line 53 "iiwa_dnn/qp/dense.py"
        value += a.data[k] * b.data[k];
    }
    #line 54 "iiwa_dnn/qp/dense.py"
    return value;
}

/* Add the product of a vector (k,) and the first k entries of another one to a number.
 *
 * iiwa_dnn/qp/dense.py: dot */
static inline double qp_dense_dot(struct arena *arena, double start, Vector a, Vector b)
{
    #line 29 "iiwa_dnn/qp/dense.py"
    #line 30 "iiwa_dnn/qp/dense.py"
    if (a.size0 >= qp_dense_LONG) {
        #line 31 "iiwa_dnn/qp/dense.py"
        return qp_dense_long_dot(arena, start, a, b);
    }
    #line 32 "iiwa_dnn/qp/dense.py"
    double value = start;
    #line 33 "iiwa_dnn/qp/dense.py"
    for (int64_t k = 0; k < a.size0; k++) {
        #line 34 "iiwa_dnn/qp/dense.py"
        value += a.data[k] * b.data[k];
    }
    #line 35 "iiwa_dnn/qp/dense.py"
    return value;
}

/* Compute the product of row j of a matrix (k, n) and the first n entries of x.
 *
 * iiwa_dnn/qp/dense.py: row_dot */
static inline double qp_dense_row_dot(struct arena *arena, Matrix rows, int64_t j, Vector x)
{
    #line 68 "iiwa_dnn/qp/dense.py"
    #line 69 "iiwa_dnn/qp/dense.py"
    return qp_dense_dot(arena, 0.0, (Vector){rows.data + j * rows.size1, rows.size1}, (Vector){x.data, rows.size1});
}

/* Test whether a bound or row with this multiplier and slack is active.
 *
 * It is if the multiplier's size |z| is above the tolerance, and slack times min(|z|, 1) is not.
 *
 * iiwa_dnn/control/command.py: is_active */
static inline bool control_command_is_active(struct arena *arena, double multiplier, double slack, double tolerance)
{
    (void)arena;
    #line 141 "iiwa_dnn/control/command.py"
    #line 145 "iiwa_dnn/control/command.py"
    const double size = fabs(multiplier);
    #line 146 "iiwa_dnn/control/command.py"
    return size > tolerance && slack <= tolerance / double_min(size, 1.0);
}

/* Find the active bounds and inequality rows at the answer of a program (`is_active`).
 *
 * Args:
 *     log: The step's log, with the answer in `point`; `limiting` (n + m,) is overwritten.
 *     qp: The program, n variables and m inequality rows.
 *     tolerance: Tolerance of the answer.
 *
 * iiwa_dnn/control/command.py: note_active */
static inline void control_command_note_active(struct arena *arena, const control_command_StepLog *log, const qp_layout_QPViews *qp, double tolerance)
{
    #line 119 "iiwa_dnn/control/command.py"
    #line 126 "iiwa_dnn/control/command.py"
    const int64_t n = qp->q.size0;
    #line 127 "iiwa_dnn/control/command.py"
    const Vector of_rows = {log->point.data + (n + qp->b.size0), log->point.size0 - (n + qp->b.size0)};
    #line 128 "iiwa_dnn/control/command.py"
    for (int64_t own_k = 0; own_k < log->limiting.size0; own_k++) {
        log->limiting.data[own_k] = 0.0;
    }
    #line 129 "iiwa_dnn/control/command.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 130 "iiwa_dnn/control/command.py"
        const double slack = of_rows.data[j] == 0.0 ? INFINITY : qp->h.data[j] - qp_dense_row_dot(arena, qp->G, j, log->point);
        #line 131 "iiwa_dnn/control/command.py"
        log->limiting.data[n + j] = control_command_is_active(arena, of_rows.data[j], slack, tolerance) ? 1.0 : 0.0;
    }
    #line 132 "iiwa_dnn/control/command.py"
    for (int64_t i = 0, end_i = log->dq.size0; i < end_i; i++) {
        #line 133 "iiwa_dnn/control/command.py"
        const double multiplier = of_rows.data[qp->h.size0 + i];
        #line 134 "iiwa_dnn/control/command.py"
        const double nearest = multiplier > 0.0 ? qp->ub.data[i] : qp->lb.data[i];
        #line 135 "iiwa_dnn/control/command.py"
        if (control_command_is_active(arena, multiplier, fabs(nearest - log->point.data[i]), tolerance)) {
            #line 136 "iiwa_dnn/control/command.py"
            log->limiting.data[i] = multiplier > 0.0 ? log->upper_kind.data[i] : -log->lower_kind.data[i];
        }
    }
}

/* Replace the joints' bounds in a program by those of position and velocity limits alone.
 *
 * Overwrites the first entries of qp.lb and qp.ub [rad/s], and their kinds in the log; nothing
 * without acceleration or jerk limits.
 *
 * iiwa_dnn/control/yielding.py: _widen_bounds */
static inline void control_yielding_widen_bounds(struct arena *arena, const control_command_StepLog *log, const qp_layout_QPViews *qp, const schemes_rate_limits_MotionConstants *limits)
{
    (void)arena;
    #line 240 "iiwa_dnn/control/yielding.py"
    #line 245 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = limits->velocity.size0; i < end_i; i++) {
        #line 246 "iiwa_dnn/control/yielding.py"
        const double fastest = limits->velocity.data[i];
        #line 247 "iiwa_dnn/control/yielding.py"
        qp->lb.data[i] = double_min(double_max(control_yielding_POSITION_GAIN * (limits->lower.data[i] - log->q.data[i]), -fastest), fastest);
        #line 248 "iiwa_dnn/control/yielding.py"
        qp->ub.data[i] = double_min(double_max(control_yielding_POSITION_GAIN * (limits->upper.data[i] - log->q.data[i]), -fastest), fastest);
        #line 249 "iiwa_dnn/control/yielding.py"
        log->lower_kind.data[i] = (double)(qp->lb.data[i] > -fastest ? naming_LimitKind_POSITION : naming_LimitKind_VELOCITY);
        #line 250 "iiwa_dnn/control/yielding.py"
        log->upper_kind.data[i] = (double)(qp->ub.data[i] < fastest ? naming_LimitKind_POSITION : naming_LimitKind_VELOCITY);
    }
}

/* Write the cost of a program times w / max(its largest entry, w) into `other`.
 *
 * The first n entries of other.q and other.P are overwritten; `other` has more variables.
 *
 * iiwa_dnn/control/fallback.py: _copy_cost */
static inline void control_fallback_copy_cost(struct arena *arena, const qp_layout_QPViews *qp, const qp_layout_QPViews *other)
{
    #line 218 "iiwa_dnn/control/fallback.py"
    #line 222 "iiwa_dnn/control/fallback.py"
    const int64_t n = qp->q.size0;
    #line 223 "iiwa_dnn/control/fallback.py"
    const double weight = control_fallback_PENALTY / double_max(qp_residuals_cost_size(arena, qp), control_fallback_PENALTY);
    #line 224 "iiwa_dnn/control/fallback.py"
    for (int64_t i = 0; i < n; i++) {
        #line 225 "iiwa_dnn/control/fallback.py"
        other->q.data[i] = weight * qp->q.data[i];
        #line 226 "iiwa_dnn/control/fallback.py"
        for (int64_t k = 0; k < n; k++) {
            #line 227 "iiwa_dnn/control/fallback.py"
            other->P.data[i * other->P.size1 + k] = weight * qp->P.data[i * qp->P.size1 + k];
        }
    }
}

/* Copy bounds and inequality rows into `other`, which may have more variables.
 *
 * The first n entries of other.lb, other.ub and the rows of other.G are overwritten, and other.h.
 *
 * iiwa_dnn/control/fallback.py: _copy_limits */
static inline void control_fallback_copy_limits(struct arena *arena, const qp_layout_QPViews *qp, const qp_layout_QPViews *other)
{
    #line 232 "iiwa_dnn/control/fallback.py"
    #line 236 "iiwa_dnn/control/fallback.py"
    qp_layout_copied(arena, other->lb, qp->lb);
    #line 237 "iiwa_dnn/control/fallback.py"
    qp_layout_copied(arena, other->ub, qp->ub);
    #line 238 "iiwa_dnn/control/fallback.py"
    qp_layout_copied(arena, other->h, qp->h);
    #line 239 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 240 "iiwa_dnn/control/fallback.py"
        qp_layout_copied(arena, (Vector){other->G.data + j * other->G.size1, other->G.size1}, (Vector){qp->G.data + j * qp->G.size1, qp->G.size1});
    }
}

/* Return the largest right-hand side that a factor scales, as the unit of the added variable.
 *
 * It is the largest |b_j| for the scaling factor; for a retreat the largest -h_j and |b_j| of
 * rows with the weight 0, of `weights` (p,). If none is above 0, it is 1.
 *
 * iiwa_dnn/control/fallback.py: _longest_asked */
static inline double control_fallback_longest_asked(struct arena *arena, const qp_layout_QPViews *qp, Vector weights, bool retreats)
{
    (void)arena;
    #line 202 "iiwa_dnn/control/fallback.py"
    #line 207 "iiwa_dnn/control/fallback.py"
    double longest = 0.0;
    #line 208 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->b.size0; j < end_j; j++) {
        #line 209 "iiwa_dnn/control/fallback.py"
        if (!retreats || weights.data[j] == 0.0) {
            #line 210 "iiwa_dnn/control/fallback.py"
            longest = double_max(longest, fabs(qp->b.data[j]));
        }
    }
    #line 211 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 212 "iiwa_dnn/control/fallback.py"
        longest = retreats ? double_max(longest, -qp->h.data[j]) : longest;
    }
    #line 213 "iiwa_dnn/control/fallback.py"
    return longest > 0.0 ? longest : 1.0;
}

/* Write where the entries of each row of G (m, n) begin, and then where they end, (2m,).
 *
 * Rows of one entry, as limits written as rows have, then cost next to nothing.
 *
 * iiwa_dnn/networks/projection.py: write_spans */
static inline void networks_projection_write_spans(struct arena *arena, const qp_layout_QPViews *qp, Vector spans)
{
    (void)arena;
    #line 45 "iiwa_dnn/networks/projection.py"
    #line 49 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 50 "iiwa_dnn/networks/projection.py"
    const int64_t m = qp->h.size0;
    #line 51 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0; j < m; j++) {
        #line 52 "iiwa_dnn/networks/projection.py"
        int64_t begin = 0;
        #line 53 "iiwa_dnn/networks/projection.py"
        int64_t end = n;
        #line 54 "iiwa_dnn/networks/projection.py"
        while (begin < n && qp->G.data[j * qp->G.size1 + begin] == 0.0) {
            #line 55 "iiwa_dnn/networks/projection.py"
            begin += 1;
        }
        #line 56 "iiwa_dnn/networks/projection.py"
        while (end > begin && qp->G.data[j * qp->G.size1 + (end - 1)] == 0.0) {
            #line 57 "iiwa_dnn/networks/projection.py"
            end -= 1;
        }
        #line 58 "iiwa_dnn/networks/projection.py"
        spans.data[j] = (double)begin;
        #line 59 "iiwa_dnn/networks/projection.py"
        spans.data[m + j] = (double)end;
    }
}

/* Return the longest implicit step [rho]: `LONGEST`, longer for a curvature above `LARGE`.
 *
 * A step of length h leaves the fraction 1 / (1 + h / c) of an error of a multiplier, c being the
 * curvature of the cost along its row.
 *
 * iiwa_dnn/networks/integrators/implicit.py: _longest_step */
static inline double networks_integrators_implicit_longest_step(struct arena *arena, const qp_layout_QPViews *qp)
{
    (void)arena;
    #line 223 "iiwa_dnn/networks/integrators/implicit.py"
    #line 228 "iiwa_dnn/networks/integrators/implicit.py"
    double largest = networks_integrators_scaling_LARGE;
    #line 229 "iiwa_dnn/networks/integrators/implicit.py"
    for (int64_t i = 0, end_i = qp->q.size0; i < end_i; i++) {
        #line 230 "iiwa_dnn/networks/integrators/implicit.py"
        largest = double_max(largest, qp->P.data[i * qp->P.size1 + i]);
    }
    #line 231 "iiwa_dnn/networks/integrators/implicit.py"
    return networks_integrators_pseudo_transient_LONGEST * (largest / networks_integrators_scaling_LARGE);
}

/* Write the product of a matrix (k, n) and the first n entries of x into k entries of `out`.
 *
 * iiwa_dnn/qp/dense.py: times */
static inline void qp_dense_times(struct arena *arena, Matrix rows, Vector x, Vector out)
{
    #line 74 "iiwa_dnn/qp/dense.py"
    #line 75 "iiwa_dnn/qp/dense.py"
    for (int64_t j = 0; j < rows.size0; j++) {
        #line 76 "iiwa_dnn/qp/dense.py"
        out.data[j] = qp_dense_row_dot(arena, rows, j, x);
    }
}

/* Add a multiple of a vector (k,) to the first k entries of `out`.
 *
 * iiwa_dnn/qp/dense.py: add_multiple */
static inline void qp_dense_add_multiple(struct arena *arena, Vector out, double factor, Vector values)
{
    (void)arena;
    #line 81 "iiwa_dnn/qp/dense.py"
    #line 82 "iiwa_dnn/qp/dense.py"
    for (int64_t k = 0; k < values.size0; k++) {
        #line 83 "iiwa_dnn/qp/dense.py"
        out.data[k] += factor * values.data[k];
    }
}

/* Add a multiple of row j of a matrix (k, n) to the first n entries of `out`.
 *
 * iiwa_dnn/qp/dense.py: add_row */
static inline void qp_dense_add_row(struct arena *arena, Vector out, double factor, Matrix rows, int64_t j)
{
    #line 88 "iiwa_dnn/qp/dense.py"
    #line 89 "iiwa_dnn/qp/dense.py"
    qp_dense_add_multiple(arena, out, factor, (Vector){rows.data + j * rows.size1, rows.size1});
}

/* Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,).
 *
 * iiwa_dnn/networks/projection.py: add_transposed */
static inline void networks_projection_add_transposed(struct arena *arena, const qp_layout_QPViews *qp, Vector spans, double factor, Vector s, Vector out)
{
    #line 80 "iiwa_dnn/networks/projection.py"
    #line 81 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 82 "iiwa_dnn/networks/projection.py"
    const int64_t m = qp->h.size0;
    #line 83 "iiwa_dnn/networks/projection.py"
    const int64_t p = qp->b.size0;
    #line 84 "iiwa_dnn/networks/projection.py"
    const int64_t at_z = n + p;
    #line 85 "iiwa_dnn/networks/projection.py"
    const int64_t at_u = at_z + m;
    #line 86 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0; i < n; i++) {
        #line 87 "iiwa_dnn/networks/projection.py"
        out.data[i] += factor * (s.data[at_u + i] - s.data[at_u + n + i]);
    }
    #line 88 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0; j < p; j++) {
        #line 89 "iiwa_dnn/networks/projection.py"
        qp_dense_add_row(arena, out, factor * s.data[n + j], qp->A, j);
    }
    #line 90 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0; j < m; j++) {
        #line 91 "iiwa_dnn/networks/projection.py"
        if (s.data[at_z + j] != 0.0) {
            #line 92 "iiwa_dnn/networks/projection.py"
            const int64_t begin = int_of(spans.data[j]);
            #line 93 "iiwa_dnn/networks/projection.py"
            const int64_t own_1 = int_of(spans.data[m + j]);
            qp_dense_add_multiple(arena, (Vector){out.data + begin, out.size0 - begin}, factor * s.data[at_z + j], (Vector){qp->G.data + j * qp->G.size1 + begin, own_1 - begin});
        }
    }
}

/* Write [A; G; I; -I] x into `values`, of size p + m + 2n.
 *
 * iiwa_dnn/networks/projection.py: rows_times */
static inline void networks_projection_rows_times(struct arena *arena, const qp_layout_QPViews *qp, Vector spans, Vector x, Vector values)
{
    #line 64 "iiwa_dnn/networks/projection.py"
    #line 65 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 66 "iiwa_dnn/networks/projection.py"
    const int64_t m = qp->h.size0;
    #line 67 "iiwa_dnn/networks/projection.py"
    const int64_t p = qp->b.size0;
    #line 68 "iiwa_dnn/networks/projection.py"
    const int64_t first = p + m;
    #line 69 "iiwa_dnn/networks/projection.py"
    qp_dense_times(arena, qp->A, x, values);
    #line 70 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0; j < m; j++) {
        #line 71 "iiwa_dnn/networks/projection.py"
        const int64_t begin = int_of(spans.data[j]);
        #line 72 "iiwa_dnn/networks/projection.py"
        const int64_t own_1 = int_of(spans.data[m + j]);
        values.data[p + j] = qp_dense_dot(arena, 0.0, (Vector){qp->G.data + j * qp->G.size1 + begin, own_1 - begin}, (Vector){x.data + begin, x.size0 - begin});
    }
    #line 73 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0; i < n; i++) {
        #line 74 "iiwa_dnn/networks/projection.py"
        values.data[first + i] = x.data[i];
        #line 75 "iiwa_dnn/networks/projection.py"
        values.data[first + n + i] = -x.data[i];
    }
}

/* Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n).
 *
 * iiwa_dnn/networks/projection.py: write_slacks */
static inline void networks_projection_write_slacks(struct arena *arena, const qp_layout_QPViews *qp, Vector spans, Vector x, Vector slacks)
{
    #line 98 "iiwa_dnn/networks/projection.py"
    #line 99 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 100 "iiwa_dnn/networks/projection.py"
    const int64_t p = qp->b.size0;
    #line 101 "iiwa_dnn/networks/projection.py"
    const int64_t first = p + qp->h.size0;
    #line 102 "iiwa_dnn/networks/projection.py"
    networks_projection_rows_times(arena, qp, spans, x, slacks);
    #line 103 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0; j < p; j++) {
        #line 104 "iiwa_dnn/networks/projection.py"
        slacks.data[j] -= qp->b.data[j];
    }
    #line 105 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 106 "iiwa_dnn/networks/projection.py"
        slacks.data[p + j] -= qp->h.data[j];
    }
    #line 107 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0; i < n; i++) {
        #line 108 "iiwa_dnn/networks/projection.py"
        slacks.data[first + i] -= qp->ub.data[i];
        #line 109 "iiwa_dnn/networks/projection.py"
        slacks.data[first + n + i] += qp->lb.data[i];
    }
}

/* Write rho ds/dt at a state, both (size,), without the projection of x on its bounds.
 *
 * `spans` (2m,) are those of `write_spans`.
 *
 * Returns:
 *     The largest absolute rate: zero exactly at a KKT point, NaN if one is NaN.
 *
 * iiwa_dnn/networks/projection.py: unprojected_rates */
static inline double networks_projection_unprojected_rates(struct arena *arena, const qp_layout_QPViews *qp, Vector spans, Vector s, Vector rates)
{
    #line 114 "iiwa_dnn/networks/projection.py"
    #line 121 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 122 "iiwa_dnn/networks/projection.py"
    qp_dense_times(arena, qp->P, s, rates);
    #line 123 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0; i < n; i++) {
        #line 124 "iiwa_dnn/networks/projection.py"
        rates.data[i] = -qp->q.data[i] - rates.data[i];
    }
    #line 125 "iiwa_dnn/networks/projection.py"
    networks_projection_add_transposed(arena, qp, spans, -1.0, s, rates);
    #line 126 "iiwa_dnn/networks/projection.py"
    networks_projection_write_slacks(arena, qp, spans, s, (Vector){rates.data + n, rates.size0 - n});
    #line 127 "iiwa_dnn/networks/projection.py"
    for (int64_t k = n + qp->b.size0; k < s.size0; k++) {
        #line 128 "iiwa_dnn/networks/projection.py"
        if (!(s.data[k] + rates.data[k] > 0.0)) {
            #line 129 "iiwa_dnn/networks/projection.py"
            rates.data[k] = -s.data[k];
        }
    }
    #line 130 "iiwa_dnn/networks/projection.py"
    return qp_dense_largest_entry(arena, rates);
}

/* Compute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them.
 *
 * iiwa_dnn/qp/residuals.py: point_residuals */
static inline double_3 qp_residuals_point_residuals(struct arena *arena, const qp_layout_QPViews *qp, Vector point)
{
    const struct arena mark = *arena;
    #line 28 "iiwa_dnn/qp/residuals.py"
    #line 29 "iiwa_dnn/qp/residuals.py"
    const int64_t n = qp->q.size0;
    #line 30 "iiwa_dnn/qp/residuals.py"
    const int64_t p = qp->b.size0;
    #line 31 "iiwa_dnn/qp/residuals.py"
    const int64_t at_z = n + p;
    #line 32 "iiwa_dnn/qp/residuals.py"
    const int64_t at_box = at_z + qp->h.size0;
    #line 33 "iiwa_dnn/qp/residuals.py"
    double primal = 0.0;
    #line 34 "iiwa_dnn/qp/residuals.py"
    double dual = 0.0;
    #line 35 "iiwa_dnn/qp/residuals.py"
    double gap = 0.0;
    #line 36 "iiwa_dnn/qp/residuals.py"
    const Vector gradient = {(double *)arena_empty(arena, n), n};
    #line 37 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 38 "iiwa_dnn/qp/residuals.py"
        const double x = point.data[i];
        #line 39 "iiwa_dnn/qp/residuals.py"
        const double multiplier = point.data[at_box + i];
        #line 40 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, x - qp->ub.data[i]);
        #line 41 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, qp->lb.data[i] - x);
        #line 42 "iiwa_dnn/qp/residuals.py"
        const double value = qp->q.data[i] + qp_dense_row_dot(arena, qp->P, i, point);
        #line 43 "iiwa_dnn/qp/residuals.py"
        gap += x * value;
        #line 44 "iiwa_dnn/qp/residuals.py"
        gradient.data[i] = value + multiplier;
        #line 45 "iiwa_dnn/qp/residuals.py"
        const double bound = multiplier > 0.0 ? qp->ub.data[i] : qp->lb.data[i];
        #line 46 "iiwa_dnn/qp/residuals.py"
        if (multiplier != 0.0 && fabs(bound) < INFINITY) {
            #line 47 "iiwa_dnn/qp/residuals.py"
            gap += bound * multiplier;
        }
    }
    #line 48 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0; j < p; j++) {
        #line 49 "iiwa_dnn/qp/residuals.py"
        const double y = point.data[n + j];
        #line 50 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, fabs(qp_dense_row_dot(arena, qp->A, j, point) - qp->b.data[j]));
        #line 51 "iiwa_dnn/qp/residuals.py"
        gap += qp->b.data[j] * y;
        #line 52 "iiwa_dnn/qp/residuals.py"
        qp_dense_add_row(arena, gradient, y, qp->A, j);
    }
    #line 53 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 54 "iiwa_dnn/qp/residuals.py"
        const double z = point.data[at_z + j];
        #line 55 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, qp_dense_row_dot(arena, qp->G, j, point) - qp->h.data[j]);
        #line 56 "iiwa_dnn/qp/residuals.py"
        if (z != 0.0) {
            #line 57 "iiwa_dnn/qp/residuals.py"
            gap += qp->h.data[j] * z;
            #line 58 "iiwa_dnn/qp/residuals.py"
            qp_dense_add_row(arena, gradient, z, qp->G, j);
        }
    }
    #line 59 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 60 "iiwa_dnn/qp/residuals.py"
        dual = qp_layout_larger(arena, dual, fabs(gradient.data[i]));
    }
    #line 61 "iiwa_dnn/qp/residuals.py"
    const double_3 own_result = {{primal, dual, fabs(gap)}};
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the point [x | y | z | z_box] of a state [x | y | z | ...] into `point`.
 *
 * x is put inside its bounds, and z is made nonnegative, and zero where a row has no limit. z_box
 * is the part of x minus the gradient P x + q + A^T y + G^T z that the projection on the bounds
 * cuts off: at an equilibrium u - l and the part of the multiplier that the primal projection
 * carries.
 *
 * Returns:
 *     ``(primal, dual, gap)`` of the point as it is handed out.
 *
 * iiwa_dnn/qp/residuals.py: kkt_point */
static inline double_3 qp_residuals_kkt_point(struct arena *arena, const qp_layout_QPViews *qp, Vector s, Vector point)
{
    #line 72 "iiwa_dnn/qp/residuals.py"
    #line 82 "iiwa_dnn/qp/residuals.py"
    const int64_t n = qp->q.size0;
    #line 83 "iiwa_dnn/qp/residuals.py"
    const int64_t p = qp->b.size0;
    #line 84 "iiwa_dnn/qp/residuals.py"
    const int64_t m = qp->h.size0;
    #line 85 "iiwa_dnn/qp/residuals.py"
    const int64_t at_z = n + p;
    #line 86 "iiwa_dnn/qp/residuals.py"
    const int64_t at_box = at_z + m;
    #line 87 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 88 "iiwa_dnn/qp/residuals.py"
        point.data[i] = double_min(double_max(s.data[i], qp->lb.data[i]), qp->ub.data[i]);
    }
    #line 89 "iiwa_dnn/qp/residuals.py"
    qp_layout_copied(arena, (Vector){point.data + n, point.size0 - n}, (Vector){s.data + n, at_z - n});
    #line 90 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0; j < m; j++) {
        #line 91 "iiwa_dnn/qp/residuals.py"
        point.data[at_z + j] = qp->h.data[j] < INFINITY ? double_max(s.data[at_z + j], 0.0) : 0.0;
    }
    #line 92 "iiwa_dnn/qp/residuals.py"
    const Vector descent = {point.data + at_box, point.size0 - at_box};
    #line 93 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 94 "iiwa_dnn/qp/residuals.py"
        descent.data[i] = -qp->q.data[i] - qp_dense_row_dot(arena, qp->P, i, point);
    }
    #line 95 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0; j < p; j++) {
        #line 96 "iiwa_dnn/qp/residuals.py"
        qp_dense_add_row(arena, descent, -point.data[n + j], qp->A, j);
    }
    #line 97 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0; j < m; j++) {
        #line 98 "iiwa_dnn/qp/residuals.py"
        if (point.data[at_z + j] != 0.0) {
            #line 99 "iiwa_dnn/qp/residuals.py"
            qp_dense_add_row(arena, descent, -point.data[at_z + j], qp->G, j);
        }
    }
    #line 100 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0; i < n; i++) {
        #line 102 "iiwa_dnn/qp/residuals.py"
        const double above = point.data[i] - qp->ub.data[i] + descent.data[i];
        #line 103 "iiwa_dnn/qp/residuals.py"
        const double below = point.data[i] - qp->lb.data[i] + descent.data[i];
        #line 104 "iiwa_dnn/qp/residuals.py"
        descent.data[i] = double_max(above, 0.0) + double_min(below, 0.0);
    }
    #line 105 "iiwa_dnn/qp/residuals.py"
    return qp_residuals_point_residuals(arena, qp, point);
}

/* Mark the rows [A; G; I; -I] that are active by 1, others by 0, (p + m + 2n,).
 *
 * Equalities are active, inequalities where mu + Omega x - chi > 0. A multiplier that is not
 * active decays: it and its rate add up to zero exactly.
 *
 * Returns:
 *     Number of rows whose mark has changed.
 *
 * iiwa_dnn/networks/projection.py: mark_active */
static inline int64_t networks_projection_mark_active(struct arena *arena, const qp_layout_QPViews *qp, Vector s, Vector rates, Vector active)
{
    (void)arena;
    #line 135 "iiwa_dnn/networks/projection.py"
    #line 143 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 144 "iiwa_dnn/networks/projection.py"
    int64_t changed = 0;
    #line 145 "iiwa_dnn/networks/projection.py"
    for (int64_t k = 0; k < active.size0; k++) {
        #line 146 "iiwa_dnn/networks/projection.py"
        const double now = k < qp->b.size0 || s.data[n + k] + rates.data[n + k] > 0.0 ? 1.0 : 0.0;
        #line 147 "iiwa_dnn/networks/projection.py"
        changed += now != active.data[k] ? 1 : 0;
        #line 148 "iiwa_dnn/networks/projection.py"
        active.data[k] = now;
    }
    #line 149 "iiwa_dnn/networks/projection.py"
    return changed;
}

/* Add factor v v^T to the upper half of `out` (n, n).
 *
 * The entries of v are 0 but for a row (k,) that stands at `start`.
 *
 * iiwa_dnn/qp/dense.py: add_outer */
static inline void qp_dense_add_outer(struct arena *arena, Matrix out, double factor, Vector row, int64_t start)
{
    #line 101 "iiwa_dnn/qp/dense.py"
    #line 105 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < row.size0; i++) {
        #line 106 "iiwa_dnn/qp/dense.py"
        qp_dense_add_multiple(arena, (Vector){out.data + (start + i) * out.size1 + (start + i), out.size1 - (start + i)}, factor * row.data[i], (Vector){row.data + i, row.size0 - i});
    }
}

/* Add the product of row j of [A; G] to `gram` if it became active; subtract it if it left.
 *
 * Its entries (k,) stand at `start`. Few rows change between two steps.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _count_row */
static inline void networks_integrators_implicit_steps_count_row(struct arena *arena, const networks_integrators_implicit_steps_Condensed *matrix, int64_t j, Vector row, int64_t start)
{
    #line 98 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 102 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const double change = matrix->active.data[j] - matrix->counted.data[j];
    #line 103 "iiwa_dnn/networks/integrators/implicit_steps.py"
    if (change != 0.0) {
        #line 104 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_add_outer(arena, matrix->gram, change, row, start);
        #line 105 "iiwa_dnn/networks/integrators/implicit_steps.py"
        matrix->counted.data[j] += change;
    }
}

/* Write the sum of a vector (k,) and a multiple of another one into `out` (k,).
 *
 * iiwa_dnn/qp/dense.py: weighted_sum */
static inline void qp_dense_weighted_sum(struct arena *arena, Vector a, double factor, Vector b, Vector out)
{
    (void)arena;
    #line 94 "iiwa_dnn/qp/dense.py"
    #line 95 "iiwa_dnn/qp/dense.py"
    for (int64_t k = 0; k < a.size0; k++) {
        #line 96 "iiwa_dnn/qp/dense.py"
        out.data[k] = a.data[k] + factor * b.data[k];
    }
}

/* Write the condensed matrix of the active set for a step [rho] into `matrix.K`.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: build_condensed */
static inline void networks_integrators_implicit_steps_build_condensed(struct arena *arena, const qp_layout_QPViews *qp, double step, const networks_integrators_implicit_steps_Condensed *matrix)
{
    #line 80 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 81 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t n = qp->q.size0;
    #line 82 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t first = matrix->counted.size0;
    #line 83 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t p = qp->b.size0;
    #line 84 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t m = qp->h.size0;
    #line 85 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t j = 0; j < p; j++) {
        #line 86 "iiwa_dnn/networks/integrators/implicit_steps.py"
        networks_integrators_implicit_steps_count_row(arena, matrix, j, (Vector){qp->A.data + j * qp->A.size1, qp->A.size1}, 0);
    }
    #line 87 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t j = 0; j < m; j++) {
        #line 88 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const int64_t begin = int_of(matrix->spans.data[j]);
        #line 89 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const int64_t own_1 = int_of(matrix->spans.data[m + j]);
        networks_integrators_implicit_steps_count_row(arena, matrix, p + j, (Vector){qp->G.data + j * qp->G.size1 + begin, own_1 - begin}, begin);
    }
    #line 90 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0; i < n; i++) {
        #line 91 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_weighted_sum(arena, (Vector){qp->P.data + i * qp->P.size1 + i, qp->P.size1 - i}, step, (Vector){matrix->gram.data + i * matrix->gram.size1 + i, matrix->gram.size1 - i}, (Vector){matrix->K.data + i * matrix->K.size1 + i, matrix->K.size1 - i});
        #line 92 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double bounds = matrix->active.data[first + i] + matrix->active.data[first + n + i];
        #line 93 "iiwa_dnn/networks/integrators/implicit_steps.py"
        matrix->K.data[i * matrix->K.size1 + i] += 1.0 / step + step * bounds;
    }
}

/* Overwrite the upper half of K (n, n) by R with K = R^T R, its diagonal inverted.
 *
 * Returns:
 *     False if K is not positive definite to working precision; its content is then meaningless.
 *
 * iiwa_dnn/qp/dense.py: cholesky_factor */
static inline bool qp_dense_cholesky_factor(struct arena *arena, Matrix K)
{
    (void)arena;
    #line 111 "iiwa_dnn/qp/dense.py"
    #line 116 "iiwa_dnn/qp/dense.py"
    const int64_t size = K.size0;
    #line 117 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < size; i++) {
        #line 118 "iiwa_dnn/qp/dense.py"
        for (int64_t part = 0, end_part = int_quotient(i, qp_dense_PARTS); part < end_part; part++) {
            #line 119 "iiwa_dnn/qp/dense.py"
            const int64_t j = qp_dense_PARTS * part;
            #line 120 "iiwa_dnn/qp/dense.py"
            const double one = K.data[j * K.size1 + i];
            #line 121 "iiwa_dnn/qp/dense.py"
            const double two = K.data[(j + 1) * K.size1 + i];
            #line 122 "iiwa_dnn/qp/dense.py"
            const double three = K.data[(j + 2) * K.size1 + i];
            #line 123 "iiwa_dnn/qp/dense.py"
            const double four = K.data[(j + 3) * K.size1 + i];
            #line 124 "iiwa_dnn/qp/dense.py"
            for (int64_t k = i; k < size; k++) {
                #line 125 "iiwa_dnn/qp/dense.py"
                K.data[i * K.size1 + k] = K.data[i * K.size1 + k] - one * K.data[j * K.size1 + k] - two * K.data[(j + 1) * K.size1 + k];
                #line 126 "iiwa_dnn/qp/dense.py"
                K.data[i * K.size1 + k] = K.data[i * K.size1 + k] - three * K.data[(j + 2) * K.size1 + k] - four * K.data[(j + 3) * K.size1 + k];
            }
        }
        #line 127 "iiwa_dnn/qp/dense.py"
        for (int64_t last = i - int_remainder(i, qp_dense_PARTS); last < i; last++) {
            #line 128 "iiwa_dnn/qp/dense.py"
            const double factor = K.data[last * K.size1 + i];
            #line 129 "iiwa_dnn/qp/dense.py"
            for (int64_t k = i; k < size; k++) {
                #line 130 "iiwa_dnn/qp/dense.py"
                K.data[i * K.size1 + k] -= factor * K.data[last * K.size1 + k];
            }
        }
        #line 131 "iiwa_dnn/qp/dense.py"
        if (!(K.data[i * K.size1 + i] > 0.0)) {
            #line 132 "iiwa_dnn/qp/dense.py"
            return false;
        }
        #line 133 "iiwa_dnn/qp/dense.py"
        K.data[i * K.size1 + i] = 1.0 / sqrt(K.data[i * K.size1 + i]);
        #line 134 "iiwa_dnn/qp/dense.py"
        for (int64_t k = i + 1; k < size; k++) {
            #line 135 "iiwa_dnn/qp/dense.py"
            K.data[i * K.size1 + k] *= K.data[i * K.size1 + i];
        }
    }
    #line 136 "iiwa_dnn/qp/dense.py"
    return true;
}

/* Solve with the factor that `cholesky_factor` left in K (n, n), into the first n of `out`.
 *
 * iiwa_dnn/qp/dense.py: factor_solve */
static inline void qp_dense_factor_solve(struct arena *arena, Matrix K, Vector rhs, Vector out)
{
    #line 141 "iiwa_dnn/qp/dense.py"
    #line 142 "iiwa_dnn/qp/dense.py"
    const int64_t size = K.size0;
    #line 143 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < size; i++) {
        #line 144 "iiwa_dnn/qp/dense.py"
        out.data[i] = rhs.data[i];
    }
    #line 145 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < size; i++) {
        #line 146 "iiwa_dnn/qp/dense.py"
        out.data[i] *= K.data[i * K.size1 + i];
        #line 147 "iiwa_dnn/qp/dense.py"
        for (int64_t k = i + 1; k < size; k++) {
            #line 148 "iiwa_dnn/qp/dense.py"
            out.data[k] -= out.data[i] * K.data[i * K.size1 + k];
        }
    }
    #line 149 "iiwa_dnn/qp/dense.py"
    for (int64_t back = 0; back < size; back++) {
        #line 150 "iiwa_dnn/qp/dense.py"
        const int64_t row = size - 1 - back;
        #line 151 "iiwa_dnn/qp/dense.py"
        const double value = qp_dense_dot(arena, -out.data[row], (Vector){K.data + row * K.size1 + (row + 1), K.size1 - (row + 1)}, (Vector){out.data + (row + 1), size - (row + 1)});
        #line 152 "iiwa_dnn/qp/dense.py"
        out.data[row] = (0.0 - value) * K.data[row * K.size1 + row];
    }
}

/* Write the state after a linearly implicit step [rho] into `new`, like `s` (3n + m + p,).
 *
 * `rates` and `matrix.active` are those at s. If `is_factored`, `matrix.K` holds the factor.
 *
 * Returns:
 *     False if K is not positive definite to working precision; `new` is then meaningless.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: linear_step */
static inline bool networks_integrators_implicit_steps_linear_step(struct arena *arena, const qp_layout_QPViews *qp, Vector s, Vector rates, double step, const networks_integrators_implicit_steps_Condensed *matrix, bool is_factored, Vector new_)
{
    #line 118 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 125 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t n = qp->q.size0;
    #line 126 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector active = matrix->active;
    #line 127 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector values = matrix->values;
    #line 128 "iiwa_dnn/networks/integrators/implicit_steps.py"
    if (!is_factored) {
        #line 129 "iiwa_dnn/networks/integrators/implicit_steps.py"
        networks_integrators_implicit_steps_build_condensed(arena, qp, step, matrix);
        #line 130 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (!qp_dense_cholesky_factor(arena, matrix->K)) {
            #line 131 "iiwa_dnn/networks/integrators/implicit_steps.py"
            return false;
        }
    }
    #line 133 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const double decay = step / (1.0 + step);
    #line 134 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_layout_copied(arena, values, (Vector){rates.data, n});
    #line 135 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0; k < active.size0; k++) {
        #line 136 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new_.data[n + k] = rates.data[n + k] * (active.data[k] != 0.0 ? step : decay);
    }
    #line 137 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_add_transposed(arena, qp, matrix->spans, -1.0, new_, values);
    #line 138 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_factor_solve(arena, matrix->K, values, new_);
    #line 139 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_rows_times(arena, qp, matrix->spans, new_, values);
    #line 140 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0; k < active.size0; k++) {
        #line 141 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new_.data[n + k] += step * active.data[k] * values.data[k];
    }
    #line 142 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_add_multiple(arena, new_, 1.0, s);
    #line 143 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return true;
}

/* Write the multipliers after a step to an x with these slacks; mark the active rows.
 *
 * Returns:
 *     Number of rows that became active or ceased to be.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _multipliers */
static inline int64_t networks_integrators_implicit_steps_multipliers(struct arena *arena, const qp_layout_QPViews *qp, Vector s, double step, Vector slacks, Vector new_, Vector active)
{
    (void)arena;
    #line 217 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 222 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t n = qp->q.size0;
    #line 223 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t p = qp->b.size0;
    #line 224 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const double keep = 1.0 / (1.0 + step);
    #line 225 "iiwa_dnn/networks/integrators/implicit_steps.py"
    int64_t changed = 0;
    #line 226 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0; k < active.size0; k++) {
        #line 227 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double moving = s.data[n + k] + step * slacks.data[k];
        #line 228 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double kept = s.data[n + k] * keep;
        #line 229 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const bool is_active = k < p || moving > kept;
        #line 230 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double now = is_active ? 1.0 : 0.0;
        #line 231 "iiwa_dnn/networks/integrators/implicit_steps.py"
        changed += now != active.data[k] ? 1 : 0;
        #line 232 "iiwa_dnn/networks/integrators/implicit_steps.py"
        active.data[k] = now;
        #line 233 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new_.data[n + k] = is_active ? moving : kept;
    }
    #line 234 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return changed;
}

/* Write minus the gradient (n,) of the function that a step minimizes at `new`.
 *
 * `cost` (n,) is the gradient without the rows' part.
 *
 * Returns:
 *     The largest absolute entry.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _descent */
static inline double networks_integrators_implicit_steps_descent(struct arena *arena, const qp_layout_QPViews *qp, Vector spans, Vector cost, Vector new_, Vector descent)
{
    #line 239 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 246 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = qp->q.size0; i < end_i; i++) {
        #line 247 "iiwa_dnn/networks/integrators/implicit_steps.py"
        descent.data[i] = -cost.data[i];
    }
    #line 248 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_add_transposed(arena, qp, spans, -1.0, new_, descent);
    #line 249 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return qp_dense_largest_entry(arena, descent);
}

/* Sum the rows' part of slope and curvature of a step's function at a step length.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _slope */
static inline double_2 networks_integrators_implicit_steps_slope(struct arena *arena, Vector multipliers, double step, int64_t p, Vector slacks, Vector change, double length)
{
    (void)arena;
    #line 304 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 305 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const double keep = 1.0 / (1.0 + step);
    #line 306 "iiwa_dnn/networks/integrators/implicit_steps.py"
    double slope = 0.0;
    #line 307 "iiwa_dnn/networks/integrators/implicit_steps.py"
    double second = 0.0;
    #line 308 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0; k < slacks.size0; k++) {
        #line 309 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double rate = change.data[k];
        #line 310 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double moving = multipliers.data[k] + step * (slacks.data[k] + length * rate);
        #line 311 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double kept = multipliers.data[k] * keep;
        #line 312 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const bool is_active = k < p || moving > kept;
        #line 313 "iiwa_dnn/networks/integrators/implicit_steps.py"
        slope += (is_active ? moving : kept) * rate;
        #line 314 "iiwa_dnn/networks/integrators/implicit_steps.py"
        second += is_active ? step * rate * rate : 0.0;
    }
    #line 315 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return (double_2){{slope, second}};
}

/* Minimize the function of a step along a direction that is downhill, to `SLOPE`.
 *
 * The derivative along the direction is continuous, increasing and piecewise linear, so a Newton
 * iteration kept inside a bracket ends at the root.
 *
 * Args:
 *     multipliers: Multipliers at the start of the step, (p + m + 2n,).
 *     step: Length of the step [rho].
 *     p: Number of equality rows, the first ones.
 *     slacks: Slacks of the rows, (p + m + 2n,).
 *     change: Rates of the slacks, [A; G; I; -I] direction, (p + m + 2n,).
 *     fall: Minus the slope at the start.
 *     rate: Slope of the cost at the start.
 *     curvature: Curvature of the cost along the direction.
 *
 * Returns:
 *     The step length.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _line_search */
static inline double networks_integrators_implicit_steps_line_search(struct arena *arena, Vector multipliers, double step, int64_t p, Vector slacks, Vector change, double fall, double rate, double curvature)
{
    #line 263 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 281 "iiwa_dnn/networks/integrators/implicit_steps.py"
    double low = 0.0;
    #line 282 "iiwa_dnn/networks/integrators/implicit_steps.py"
    double high = INFINITY;
    #line 283 "iiwa_dnn/networks/integrators/implicit_steps.py"
    double length = 1.0;
    #line 284 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t _ = 0; _ < 50; _++) {
        #line 285 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double_2 own_1 = networks_integrators_implicit_steps_slope(arena, multipliers, step, p, slacks, change, length);
        double slope = own_1.at[0];
        double second = own_1.at[1];
        #line 286 "iiwa_dnn/networks/integrators/implicit_steps.py"
        slope += rate + length * curvature;
        #line 287 "iiwa_dnn/networks/integrators/implicit_steps.py"
        second += curvature;
        #line 288 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (fabs(slope) <= networks_integrators_implicit_steps_SLOPE * fall) {
            #line 289 "iiwa_dnn/networks/integrators/implicit_steps.py"
            break;
        }
        #line 290 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (slope > 0.0) {
            #line 291 "iiwa_dnn/networks/integrators/implicit_steps.py"
            high = length;
        } else {
            #line 293 "iiwa_dnn/networks/integrators/implicit_steps.py"
            low = length;
        }
        #line 294 "iiwa_dnn/networks/integrators/implicit_steps.py"
        length -= slope / second;
        #line 295 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (!(low < length && length < high)) {
            #line 296 "iiwa_dnn/networks/integrators/implicit_steps.py"
            length = high < INFINITY ? 0.5 * (low + high) : 2.0 * low;
        }
    }
    #line 297 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return length;
}

/* Solve new = s + step F(new) for `new` (3n + m + p,).
 *
 * The iteration starts at s, and first goes towards the x that `new` holds before, if that is
 * downhill. After at least one linear solve, it stops as soon as the gradient of the step's own
 * minimisation is at most `tol` or lost in rounding; at the latest after `max_newton` of them.
 *
 * Returns:
 *     Linear solves; minus their number if the last matrix was not positive definite to working
 *     precision.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: backward_euler */
static inline int64_t networks_integrators_implicit_steps_backward_euler(struct arena *arena, const qp_layout_QPViews *qp, Vector s, double step, Vector new_, double tol, int64_t max_newton, const networks_integrators_implicit_steps_Condensed *matrix)
{
    const struct arena mark = *arena;
    #line 156 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 166 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t n = qp->q.size0;
    #line 167 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector cost = {(double *)arena_empty(arena, n), n};
    #line 168 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector curved = {(double *)arena_empty(arena, n), n};
    #line 169 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector direction = {(double *)arena_empty(arena, n), n};
    #line 170 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector descent = {(double *)arena_empty(arena, n), n};
    #line 171 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const Vector slacks = {(double *)arena_empty(arena, matrix->values.size0), matrix->values.size0};
    #line 172 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_weighted_sum(arena, (Vector){new_.data, n}, -1.0, (Vector){s.data, n}, direction);
    #line 173 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_layout_copied(arena, new_, s);
    #line 174 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_times(arena, qp->P, new_, cost);
    #line 175 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_add_multiple(arena, cost, 1.0, qp->q);
    #line 176 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_write_slacks(arena, qp, matrix->spans, new_, slacks);
    #line 177 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_integrators_implicit_steps_multipliers(arena, qp, s, step, slacks, new_, matrix->active);
    #line 178 "iiwa_dnn/networks/integrators/implicit_steps.py"
    double size = networks_integrators_implicit_steps_descent(arena, qp, matrix->spans, cost, new_, descent);
    #line 179 "iiwa_dnn/networks/integrators/implicit_steps.py"
    bool is_known = qp_dense_dot(arena, 0.0, direction, descent) > 0.0;
    #line 180 "iiwa_dnn/networks/integrators/implicit_steps.py"
    int64_t taken = 0;
    #line 181 "iiwa_dnn/networks/integrators/implicit_steps.py"
    while (taken < max_newton) {
        #line 182 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (!is_known) {
            #line 183 "iiwa_dnn/networks/integrators/implicit_steps.py"
            networks_integrators_implicit_steps_build_condensed(arena, qp, step, matrix);
            #line 184 "iiwa_dnn/networks/integrators/implicit_steps.py"
            taken += 1;
            #line 185 "iiwa_dnn/networks/integrators/implicit_steps.py"
            if (!qp_dense_cholesky_factor(arena, matrix->K)) {
                #line 186 "iiwa_dnn/networks/integrators/implicit_steps.py"
                arena_leave(arena, &mark);
                return -taken;
            }
            #line 187 "iiwa_dnn/networks/integrators/implicit_steps.py"
            qp_dense_factor_solve(arena, matrix->K, descent, direction);
        }
        #line 188 "iiwa_dnn/networks/integrators/implicit_steps.py"
        is_known = false;
        #line 189 "iiwa_dnn/networks/integrators/implicit_steps.py"
        networks_projection_rows_times(arena, qp, matrix->spans, direction, matrix->values);
        #line 190 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_times(arena, qp->P, direction, curved);
        #line 191 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_add_multiple(arena, curved, 1.0 / step, direction);
        #line 192 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double length = networks_integrators_implicit_steps_line_search(arena, (Vector){s.data + n, s.size0 - n}, step, qp->b.size0, slacks, matrix->values, qp_dense_dot(arena, 0.0, direction, descent), qp_dense_dot(arena, 0.0, direction, cost), qp_dense_dot(arena, 0.0, direction, curved));
        #line 202 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_add_multiple(arena, new_, length, direction);
        #line 203 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_add_multiple(arena, cost, length, curved);
        #line 204 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_add_multiple(arena, slacks, length, matrix->values);
        #line 205 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const int64_t changed = networks_integrators_implicit_steps_multipliers(arena, qp, s, step, slacks, new_, matrix->active);
        #line 206 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double last = size;
        #line 207 "iiwa_dnn/networks/integrators/implicit_steps.py"
        size = networks_integrators_implicit_steps_descent(arena, qp, matrix->spans, cost, new_, descent);
        #line 208 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (taken > 0 && (!(size > tol) || (changed == 0 && size > 0.5 * last))) {
            #line 209 "iiwa_dnn/networks/integrators/implicit_steps.py"
            break;
        }
    }
    #line 210 "iiwa_dnn/networks/integrators/implicit_steps.py"
    arena_leave(arena, &mark);
    return taken;
}

/* Advance a state `s` (size,) until the residuals of its point are at most `tol`.
 *
 * The state is advanced in place, the point (2n + m + p,) is overwritten. After `budget` linear
 * solves, or where the residuals stall, the last state is kept.
 *
 * Returns:
 *     ``(linear_solves, time, primal, dual, gap)``: linear solves, network time that passed
 *     [rho], and the residuals of `point`.
 *
 * iiwa_dnn/networks/integrators/implicit.py: solve_within */
static inline double_5 networks_integrators_implicit_solve_within(struct arena *arena, const qp_layout_QPViews *qp, double tol, int64_t budget, Vector s, Vector point)
{
    const struct arena mark = *arena;
    #line 149 "iiwa_dnn/networks/integrators/implicit.py"
    #line 158 "iiwa_dnn/networks/integrators/implicit.py"
    const int64_t n = qp->q.size0;
    #line 159 "iiwa_dnn/networks/integrators/implicit.py"
    const int64_t rows = s.size0 - n;
    #line 160 "iiwa_dnn/networks/integrators/implicit.py"
    const Vector spans = {(double *)arena_empty(arena, 2 * qp->h.size0), 2 * qp->h.size0};
    #line 161 "iiwa_dnn/networks/integrators/implicit.py"
    networks_projection_write_spans(arena, qp, spans);
    #line 162 "iiwa_dnn/networks/integrators/implicit.py"
    const networks_integrators_implicit_steps_Condensed matrix = {{(double *)arena_empty(arena, rows), rows}, {(double *)arena_zeros(arena, rows - 2 * n), rows - 2 * n}, {(double *)arena_zeros(arena, n * n), n, n}, {(double *)arena_empty(arena, n * n), n, n}, {(double *)arena_empty(arena, rows), rows}, spans};
    #line 170 "iiwa_dnn/networks/integrators/implicit.py"
    const Vector now = {(double *)arena_empty(arena, s.size0), s.size0};
    #line 171 "iiwa_dnn/networks/integrators/implicit.py"
    const Vector then = {(double *)arena_empty(arena, s.size0), s.size0};
    #line 172 "iiwa_dnn/networks/integrators/implicit.py"
    const Vector new_ = {(double *)arena_copy(arena, s.data, s.size0), s.size0};
    #line 173 "iiwa_dnn/networks/integrators/implicit.py"
    double step = networks_integrators_implicit_SHORTEST;
    #line 174 "iiwa_dnn/networks/integrators/implicit.py"
    int64_t linear_solves = 0;
    #line 175 "iiwa_dnn/networks/integrators/implicit.py"
    double time = 0.0;
    #line 176 "iiwa_dnn/networks/integrators/implicit.py"
    int64_t stalled = 0;
    #line 177 "iiwa_dnn/networks/integrators/implicit.py"
    const double longest = networks_integrators_implicit_longest_step(arena, qp);
    #line 178 "iiwa_dnn/networks/integrators/implicit.py"
    for (int64_t own_k = 0; own_k < matrix.active.size0; own_k++) {
        matrix.active.data[own_k] = networks_integrators_implicit_UNKNOWN;
    }
    #line 179 "iiwa_dnn/networks/integrators/implicit.py"
    double rate = networks_projection_unprojected_rates(arena, qp, spans, s, now);
    #line 180 "iiwa_dnn/networks/integrators/implicit.py"
    double smallest = INFINITY;
    #line 181 "iiwa_dnn/networks/integrators/implicit.py"
    while (linear_solves < budget) {
        #line 182 "iiwa_dnn/networks/integrators/implicit.py"
        stalled += 1;
        #line 183 "iiwa_dnn/networks/integrators/implicit.py"
        if (rate < 0.5 * smallest) {
            #line 184 "iiwa_dnn/networks/integrators/implicit.py"
            smallest = rate;
            #line 185 "iiwa_dnn/networks/integrators/implicit.py"
            stalled = 0;
        }
        #line 186 "iiwa_dnn/networks/integrators/implicit.py"
        if (!(rate > tol)) {
            #line 187 "iiwa_dnn/networks/integrators/implicit.py"
            const double_3 own_1 = qp_residuals_kkt_point(arena, qp, s, point);
            const double primal = own_1.at[0];
            const double dual = own_1.at[1];
            const double gap = own_1.at[2];
            #line 188 "iiwa_dnn/networks/integrators/implicit.py"
            if (qp_residuals_within(arena, primal, dual, gap, tol)) {
                #line 189 "iiwa_dnn/networks/integrators/implicit.py"
                const double_5 own_result = {{(double)linear_solves, time, primal, dual, gap}};
                arena_leave(arena, &mark);
                return own_result;
            }
        }
        #line 190 "iiwa_dnn/networks/integrators/implicit.py"
        const int64_t changed = networks_projection_mark_active(arena, qp, s, now, matrix.active);
        #line 191 "iiwa_dnn/networks/integrators/implicit.py"
        linear_solves += 1;
        #line 192 "iiwa_dnn/networks/integrators/implicit.py"
        if (networks_integrators_implicit_steps_linear_step(arena, qp, s, now, longest, &matrix, changed == 0, new_)) {
            #line 193 "iiwa_dnn/networks/integrators/implicit.py"
            const double new_rate = networks_projection_unprojected_rates(arena, qp, spans, new_, then);
            #line 194 "iiwa_dnn/networks/integrators/implicit.py"
            if (new_rate < 0.5 * rate) {
                #line 195 "iiwa_dnn/networks/integrators/implicit.py"
                qp_layout_copied(arena, s, new_);
                #line 196 "iiwa_dnn/networks/integrators/implicit.py"
                qp_layout_copied(arena, now, then);
                #line 197 "iiwa_dnn/networks/integrators/implicit.py"
                rate = new_rate;
                #line 198 "iiwa_dnn/networks/integrators/implicit.py"
                time += longest;
                #line 199 "iiwa_dnn/networks/integrators/implicit.py"
                continue;
            }
        }
        #line 200 "iiwa_dnn/networks/integrators/implicit.py"
        if (stalled > 0) {
            #line 201 "iiwa_dnn/networks/integrators/implicit.py"
            qp_residuals_kkt_point(arena, qp, s, point);
            #line 202 "iiwa_dnn/networks/integrators/implicit.py"
            if (stalled > networks_integrators_implicit_STALLED || qp_residuals_is_small_enough(arena, qp, point, tol, 0.0)) {
                #line 203 "iiwa_dnn/networks/integrators/implicit.py"
                break;
            }
        }
        #line 204 "iiwa_dnn/networks/integrators/implicit.py"
        const int64_t taken = networks_integrators_implicit_steps_backward_euler(arena, qp, s, step, new_, 0.1 * rate, int_min(networks_integrators_implicit_MAX_NEWTON, budget - linear_solves), &matrix);
        #line 207 "iiwa_dnn/networks/integrators/implicit.py"
        for (int64_t own_k = 0; own_k < matrix.active.size0; own_k++) {
            matrix.active.data[own_k] = networks_integrators_implicit_UNKNOWN;
        }
        #line 208 "iiwa_dnn/networks/integrators/implicit.py"
        linear_solves += int_max(taken, -taken);
        #line 209 "iiwa_dnn/networks/integrators/implicit.py"
        if (taken < 0) {
            #line 210 "iiwa_dnn/networks/integrators/implicit.py"
            step *= 0.1;
            #line 211 "iiwa_dnn/networks/integrators/implicit.py"
            continue;
        }
        #line 212 "iiwa_dnn/networks/integrators/implicit.py"
        time += step;
        #line 213 "iiwa_dnn/networks/integrators/implicit.py"
        qp_layout_copied(arena, s, new_);
        #line 214 "iiwa_dnn/networks/integrators/implicit.py"
        rate = networks_projection_unprojected_rates(arena, qp, spans, s, now);
        #line 215 "iiwa_dnn/networks/integrators/implicit.py"
        if (step < longest) {
            #line 216 "iiwa_dnn/networks/integrators/implicit.py"
            step *= networks_integrators_implicit_GROWTH;
        }
    }
    #line 217 "iiwa_dnn/networks/integrators/implicit.py"
    const double_3 own_2 = qp_residuals_kkt_point(arena, qp, s, point);
    const double primal = own_2.at[0];
    const double dual = own_2.at[1];
    const double gap = own_2.at[2];
    #line 218 "iiwa_dnn/networks/integrators/implicit.py"
    const double_5 own_result = {{(double)linear_solves, time, primal, dual, gap}};
    arena_leave(arena, &mark);
    return own_result;
}

/* Solve a program by the network from a given state and, if that fails, from a cold start.
 *
 * Args:
 *     qp: The program, of n variables, m inequality and p equality rows.
 *     tol: Tolerance of the residuals.
 *     state: State of the network, (3 n + m + p,), overwritten by the converged one, or by zeros
 *         if both tries fail.
 *     point: Primal-dual point [x | y | z | z_box], (2 n + m + p,), overwritten.
 *     stats: Statistics of a step: linear solves are added to `iterations`, and `time` is
 *         overwritten.
 *
 * Returns:
 *     True if the residuals of `point` are within the tolerance, or above it by rounding alone.
 *
 * iiwa_dnn/control/fallback.py: solve_warm */
static inline bool control_fallback_solve_warm(struct arena *arena, const qp_layout_QPViews *qp, double tol, Vector state, Vector point, const networks_integrators_base_SolveStats *stats)
{
    #line 128 "iiwa_dnn/control/fallback.py"
    #line 142 "iiwa_dnn/control/fallback.py"
    for (int64_t _ = 0; _ < 2; _++) {
        #line 143 "iiwa_dnn/control/fallback.py"
        const double_5 own_1 = networks_integrators_implicit_solve_within(arena, qp, tol, control_fallback_MAX_LINEAR_SOLVES, state, point);
        const double linear_solves = own_1.at[0];
        const double time = own_1.at[1];
        const double primal = own_1.at[2];
        const double dual = own_1.at[3];
        const double gap = own_1.at[4];
        #line 146 "iiwa_dnn/control/fallback.py"
        stats->at->iterations += linear_solves;
        #line 147 "iiwa_dnn/control/fallback.py"
        stats->at->time = time;
        #line 148 "iiwa_dnn/control/fallback.py"
        if (qp_residuals_within(arena, primal, dual, gap, tol) || qp_residuals_is_small_enough(arena, qp, point, tol, 0.0)) {
            #line 149 "iiwa_dnn/control/fallback.py"
            return true;
        }
        #line 150 "iiwa_dnn/control/fallback.py"
        for (int64_t own_k = 0; own_k < state.size0; own_k++) {
            state.data[own_k] = 0.0;
        }
    }
    #line 151 "iiwa_dnn/control/fallback.py"
    return false;
}

/* Compute the largest feasible scaling factor s of the task, or tau of a retreat.
 *
 * Args:
 *     qp: The nominal program, of n variables, m inequality and p equality rows.
 *     yielding: Weights of the task rows, and the tolerance.
 *     state: State of the network, (3 n + 3 + m + p,), overwritten as in `solve_warm`.
 *     point: Primal-dual point of the program with one more variable, the last of x,
 *         (2 n + 2 + m + p,), overwritten.
 *     stats: Statistics of a step, updated as in `solve_warm`.
 *     retreats: If True, compute tau, by which negative entries of h and the right-hand sides of
 *         coupled joints are scaled, without the task rows; if False, compute s.
 *
 * Returns:
 *     1.0 if the factor is 1 up to rounding, else `ALMOST` times the factor; -1.0 if 0 is
 *     infeasible, or the network does not converge.
 *
 * iiwa_dnn/control/fallback.py: largest_factor */
static inline double control_fallback_largest_factor(struct arena *arena, const qp_layout_QPViews *qp, const control_fallback_Yielding *yielding, Vector state, Vector point, const networks_integrators_base_SolveStats *stats, bool retreats)
{
    const struct arena mark = *arena;
    #line 158 "iiwa_dnn/control/fallback.py"
    #line 174 "iiwa_dnn/control/fallback.py"
    const int64_t n = qp->q.size0;
    #line 175 "iiwa_dnn/control/fallback.py"
    const int64_t own_1 = qp_layout_data_size(arena, n + 1, qp->h.size0, qp->b.size0);
    const Vector data = {(double *)arena_zeros(arena, own_1), own_1};
    #line 176 "iiwa_dnn/control/fallback.py"
    const qp_layout_QPViews wider = qp_layout_qp_views(arena, data, n + 1, qp->h.size0, qp->b.size0);
    #line 177 "iiwa_dnn/control/fallback.py"
    control_fallback_copy_cost(arena, qp, &wider);
    #line 178 "iiwa_dnn/control/fallback.py"
    control_fallback_copy_limits(arena, qp, &wider);
    #line 179 "iiwa_dnn/control/fallback.py"
    const double longest = control_fallback_longest_asked(arena, qp, yielding->weights, retreats);
    #line 180 "iiwa_dnn/control/fallback.py"
    wider.q.data[n] = -1.0;
    #line 181 "iiwa_dnn/control/fallback.py"
    wider.ub.data[n] = longest;
    #line 182 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 183 "iiwa_dnn/control/fallback.py"
        if (retreats && qp->h.data[j] < 0.0) {
            #line 184 "iiwa_dnn/control/fallback.py"
            wider.G.data[j * wider.G.size1 + n] = -qp->h.data[j] / longest;
            #line 185 "iiwa_dnn/control/fallback.py"
            wider.h.data[j] = 0.0;
        }
    }
    #line 186 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->b.size0; j < end_j; j++) {
        #line 187 "iiwa_dnn/control/fallback.py"
        if (yielding->weights.data[j] == 0.0 || !retreats) {
            #line 188 "iiwa_dnn/control/fallback.py"
            qp_layout_copied(arena, (Vector){wider.A.data + j * wider.A.size1, wider.A.size1}, (Vector){qp->A.data + j * qp->A.size1, qp->A.size1});
        }
        #line 189 "iiwa_dnn/control/fallback.py"
        if ((yielding->weights.data[j] == 0.0) == retreats) {
            #line 190 "iiwa_dnn/control/fallback.py"
            wider.A.data[j * wider.A.size1 + n] = -qp->b.data[j] / longest;
        } else {
            #line 191 "iiwa_dnn/control/fallback.py"
            if (!retreats) {
                #line 192 "iiwa_dnn/control/fallback.py"
                wider.b.data[j] = qp->b.data[j];
            }
        }
    }
    #line 193 "iiwa_dnn/control/fallback.py"
    const double tol = retreats ? double_max(yielding->tolerance, control_fallback_RETREAT) : yielding->tolerance;
    #line 194 "iiwa_dnn/control/fallback.py"
    if (!control_fallback_solve_warm(arena, &wider, tol, state, point, stats)) {
        #line 195 "iiwa_dnn/control/fallback.py"
        arena_leave(arena, &mark);
        return -1.0;
    }
    #line 196 "iiwa_dnn/control/fallback.py"
    const double factor = double_max(point.data[n] / longest, 0.0);
    #line 197 "iiwa_dnn/control/fallback.py"
    const double own_result = factor >= control_fallback_FEASIBLE ? 1.0 : control_fallback_ALMOST * factor;
    arena_leave(arena, &mark);
    return own_result;
}

/* Find the bounds and inequality rows whose multipliers are not negligible.
 *
 * A multiplier counts if it is above `LIMITING` times the largest of all.
 *
 * Args:
 *     point: Solution [x | y | z | z_box] of a program with n + extra variables, m inequality and
 *         p equality rows, (2 n + 2 extra + m + p,).
 *     n: Number of variables of the nominal program.
 *     m: Number of inequality rows.
 *     extra: Number of variables after the first n; their bounds are ignored.
 *     limiting: For each of n variables the sign 1 or -1 of its bound's multiplier if that counts,
 *         else 0; then for each row 1 if its multiplier counts, else 0, (n + m,), overwritten.
 *
 * iiwa_dnn/control/fallback.py: note_limiting */
static inline void control_fallback_note_limiting(struct arena *arena, Vector point, int64_t n, int64_t m, int64_t extra, Vector limiting)
{
    #line 283 "iiwa_dnn/control/fallback.py"
    #line 296 "iiwa_dnn/control/fallback.py"
    const int64_t start = point.size0 - n - extra - m;
    #line 297 "iiwa_dnn/control/fallback.py"
    const Vector multipliers = {point.data + start, start + m + n - start};
    #line 298 "iiwa_dnn/control/fallback.py"
    const double least = control_fallback_LIMITING * qp_dense_largest_entry(arena, multipliers);
    #line 299 "iiwa_dnn/control/fallback.py"
    for (int64_t i = 0; i < n + m; i++) {
        #line 300 "iiwa_dnn/control/fallback.py"
        const double value = multipliers.data[i < n ? m + i : i - n];
        #line 301 "iiwa_dnn/control/fallback.py"
        limiting.data[i] = fabs(value) > least ? copysign(1.0, value) : 0.0;
    }
}

/* Test whether any of the targets (k, 18) moves, by a linear or angular velocity.
 *
 * iiwa_dnn/control/yielding.py: _is_path */
static inline bool control_yielding_is_path(struct arena *arena, Matrix targets)
{
    #line 298 "iiwa_dnn/control/yielding.py"
    #line 299 "iiwa_dnn/control/yielding.py"
    double fastest = 0.0;
    #line 300 "iiwa_dnn/control/yielding.py"
    for (int64_t k = 0; k < targets.size0; k++) {
        #line 301 "iiwa_dnn/control/yielding.py"
        const references_targets_TargetData target = references_targets_TargetData_of((Vector){targets.data + k * targets.size1, targets.size1});
        #line 302 "iiwa_dnn/control/yielding.py"
        fastest = double_max(fastest, qp_dense_largest_entry(arena, target.linear_velocity));
        #line 303 "iiwa_dnn/control/yielding.py"
        fastest = double_max(fastest, qp_dense_largest_entry(arena, target.angular_velocity));
    }
    #line 304 "iiwa_dnn/control/yielding.py"
    return fastest > 0.0;
}

/* Test whether joint velocities x (n,) are large while the rates A x of the task are small.
 *
 * iiwa_dnn/control/yielding.py: _races */
static inline bool control_yielding_races(struct arena *arena, const qp_layout_QPViews *qp, Vector x)
{
    #line 309 "iiwa_dnn/control/yielding.py"
    #line 310 "iiwa_dnn/control/yielding.py"
    double tip = 0.0;
    #line 311 "iiwa_dnn/control/yielding.py"
    for (int64_t j = 0, end_j = qp->b.size0; j < end_j; j++) {
        #line 312 "iiwa_dnn/control/yielding.py"
        tip = double_max(tip, fabs(qp_dense_row_dot(arena, qp->A, j, x)));
    }
    #line 313 "iiwa_dnn/control/yielding.py"
    return tip < control_yielding_SINGULAR * qp_dense_largest_entry(arena, x);
}

/* Multiply the entries of qp.b with a positive weight, of `weights` (p,), by a factor.
 *
 * iiwa_dnn/control/fallback.py: scale_task */
static inline void control_fallback_scale_task(struct arena *arena, const qp_layout_QPViews *qp, Vector weights, double factor)
{
    (void)arena;
    #line 245 "iiwa_dnn/control/fallback.py"
    #line 246 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->b.size0; j < end_j; j++) {
        #line 247 "iiwa_dnn/control/fallback.py"
        if (weights.data[j] > 0.0) {
            #line 248 "iiwa_dnn/control/fallback.py"
            qp->b.data[j] *= factor;
        }
    }
}

/* Turn a nominal program into the relaxed program of this module, in place.
 *
 * Args:
 *     qp: The program, of p equality rows; P, q, h, A and b are overwritten.
 *     weights: Weights of the equality rows, (p,); 0 for a row of coupled joints.
 *     retreat: Factor tau of negative entries of h and of the right-hand sides of coupled joints.
 *
 * iiwa_dnn/control/fallback.py: relax_task */
static inline void control_fallback_relax_task(struct arena *arena, const qp_layout_QPViews *qp, Vector weights, double retreat)
{
    #line 253 "iiwa_dnn/control/fallback.py"
    #line 260 "iiwa_dnn/control/fallback.py"
    const int64_t n = qp->q.size0;
    #line 261 "iiwa_dnn/control/fallback.py"
    const double shrink = control_fallback_FASTEST / double_max(control_fallback_FASTEST, qp_dense_largest_entry(arena, qp->b));
    #line 262 "iiwa_dnn/control/fallback.py"
    const double drift = control_fallback_DRIFT / double_max(qp_dense_largest_entry(arena, qp->q), 1.0);
    #line 263 "iiwa_dnn/control/fallback.py"
    for (int64_t i = 0, end_i = qp_dense_largest_entry(arena, weights) > 0.0 ? n : 0; i < end_i; i++) {
        #line 264 "iiwa_dnn/control/fallback.py"
        qp->q.data[i] *= control_fallback_DAMPING * control_fallback_DAMPING * drift;
        #line 265 "iiwa_dnn/control/fallback.py"
        for (int64_t k = 0; k < n; k++) {
            #line 266 "iiwa_dnn/control/fallback.py"
            qp->P.data[i * qp->P.size1 + k] *= control_fallback_BLEND;
        }
        #line 267 "iiwa_dnn/control/fallback.py"
        qp->P.data[i * qp->P.size1 + i] += control_fallback_DAMPING * control_fallback_DAMPING;
    }
    #line 268 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->b.size0; j < end_j; j++) {
        #line 269 "iiwa_dnn/control/fallback.py"
        if (weights.data[j] > 0.0) {
            #line 270 "iiwa_dnn/control/fallback.py"
            qp->b.data[j] *= shrink;
            #line 271 "iiwa_dnn/control/fallback.py"
            schemes_program_add_soft(arena, qp->P, qp->q, (Matrix){qp->A.data + j * qp->A.size1, j + 1 - j, qp->A.size1}, (Vector){qp->b.data + j, j + 1 - j}, weights.data[j] * weights.data[j]);
            #line 272 "iiwa_dnn/control/fallback.py"
            for (int64_t own_k = 0; own_k < qp->A.size1; own_k++) {
                (qp->A.data + j * qp->A.size1)[own_k] = 0.0;
            }
            #line 273 "iiwa_dnn/control/fallback.py"
            qp->b.data[j] = 0.0;
        } else {
            #line 275 "iiwa_dnn/control/fallback.py"
            qp->b.data[j] *= retreat;
        }
    }
    #line 276 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 277 "iiwa_dnn/control/fallback.py"
        if (qp->h.data[j] < 0.0) {
            #line 278 "iiwa_dnn/control/fallback.py"
            qp->h.data[j] *= retreat;
        }
    }
}

/* Turn a program into the first fallback program that has a solution, and solve it.
 *
 * Args:
 *     log: The step's log; point, limiting and stats are overwritten.
 *     qp: The program with widened bounds, overwritten by the fallback program.
 *     yielding: Constants of the fallback programs.
 *     fallback: Network states of the fallback programs, (`fallback_size`,), overwritten.
 *     action: Action of the policy.
 *
 * Returns:
 *     `SCALED`, `RELAXED` or, if no program has a solution, `STOPPED`; and the scaling factor of
 *     the task, 0 unless `SCALED`.
 *
 * iiwa_dnn/control/yielding.py: _answer_fallback */
static inline double_2 control_yielding_answer_fallback(struct arena *arena, const control_command_StepLog *log, const qp_layout_QPViews *qp, const control_fallback_Yielding *yielding, Vector fallback, int64_t action)
{
    const struct arena mark = *arena;
    #line 257 "iiwa_dnn/control/yielding.py"
    #line 270 "iiwa_dnn/control/yielding.py"
    const int64_t n = qp->q.size0;
    #line 271 "iiwa_dnn/control/yielding.py"
    const int64_t m = qp->h.size0;
    #line 272 "iiwa_dnn/control/yielding.py"
    const double tol = yielding->tolerance;
    #line 273 "iiwa_dnn/control/yielding.py"
    const Vector point = {(double *)arena_empty(arena, 2 * n + 2 + m + qp->b.size0), 2 * n + 2 + m + qp->b.size0};
    #line 274 "iiwa_dnn/control/yielding.py"
    const int64_t size = 3 * n + 3 + m + qp->b.size0;
    #line 275 "iiwa_dnn/control/yielding.py"
    const double factor = control_fallback_largest_factor(arena, qp, yielding, (Vector){fallback.data, size}, point, &log->stats, false);
    #line 276 "iiwa_dnn/control/yielding.py"
    control_fallback_note_limiting(arena, point, n, m, 1, log->limiting);
    #line 277 "iiwa_dnn/control/yielding.py"
    const bool follows = action == control_yielding_SLOW && control_yielding_is_path(arena, log->targets) && !control_yielding_races(arena, qp, (Vector){point.data, n});
    #line 278 "iiwa_dnn/control/yielding.py"
    if (factor == 1.0 || (follows && factor >= control_yielding_CREEP)) {
        #line 279 "iiwa_dnn/control/yielding.py"
        const Vector asked = {(double *)arena_copy(arena, qp->b.data, qp->b.size0), qp->b.size0};
        #line 280 "iiwa_dnn/control/yielding.py"
        control_fallback_scale_task(arena, qp, yielding->weights, factor);
        #line 281 "iiwa_dnn/control/yielding.py"
        if (control_fallback_solve_warm(arena, qp, tol, (Vector){fallback.data + size, fallback.size0 - size}, log->point, &log->stats)) {
            #line 282 "iiwa_dnn/control/yielding.py"
            const double_2 own_result = {{(double)control_yielding_SCALED, factor}};
            arena_leave(arena, &mark);
            return own_result;
        }
        #line 283 "iiwa_dnn/control/yielding.py"
        qp_layout_copied(arena, qp->b, asked);
    }
    #line 284 "iiwa_dnn/control/yielding.py"
    if (action == control_yielding_STOP) {
        #line 285 "iiwa_dnn/control/yielding.py"
        const double_2 own_result = {{(double)control_yielding_STOPPED, 0.0}};
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 286 "iiwa_dnn/control/yielding.py"
    double retreat = 1.0;
    #line 287 "iiwa_dnn/control/yielding.py"
    if (factor < 0.0) {
        #line 288 "iiwa_dnn/control/yielding.py"
        retreat = control_fallback_largest_factor(arena, qp, yielding, (Vector){(double *)arena_zeros(arena, size), size}, point, &log->stats, true);
        #line 289 "iiwa_dnn/control/yielding.py"
        retreat = double_max(retreat, 0.0);
    }
    #line 290 "iiwa_dnn/control/yielding.py"
    control_fallback_relax_task(arena, qp, yielding->weights, retreat);
    #line 291 "iiwa_dnn/control/yielding.py"
    const bool found = control_fallback_solve_warm(arena, qp, tol, (Vector){fallback.data + size, fallback.size0 - size}, log->point, &log->stats);
    #line 292 "iiwa_dnn/control/yielding.py"
    control_fallback_note_limiting(arena, log->point, n, m, 0, log->limiting);
    #line 293 "iiwa_dnn/control/yielding.py"
    const double_2 own_result = {{(double)(found ? control_yielding_RELAXED : control_yielding_STOPPED), 0.0}};
    arena_leave(arena, &mark);
    return own_result;
}

/* Replace the wanted velocity x (n,) [rad/s] by the next command on a straight line to it.
 *
 * All joints reach it together; if no number of periods is enough, x stays.
 *
 * iiwa_dnn/control/yielding.py: _approach_together */
static inline void control_yielding_approach_together(struct arena *arena, const control_state_MotionState *motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, Vector x)
{
    const struct arena mark = *arena;
    #line 388 "iiwa_dnn/control/yielding.py"
    #line 392 "iiwa_dnn/control/yielding.py"
    const int64_t dof = motion_state->q.size0;
    #line 393 "iiwa_dnn/control/yielding.py"
    const Vector now = {(double *)arena_empty(arena, dof), dof};
    #line 394 "iiwa_dnn/control/yielding.py"
    const Vector before = {(double *)arena_empty(arena, dof), dof};
    #line 395 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0; i < dof; i++) {
        #line 396 "iiwa_dnn/control/yielding.py"
        now.data[i] = motion_state->last.data[i] - x.data[i];
        #line 397 "iiwa_dnn/control/yielding.py"
        before.data[i] = motion_state->before.data[i] - x.data[i];
    }
    #line 398 "iiwa_dnn/control/yielding.py"
    const double dt = timing->dt;
    #line 399 "iiwa_dnn/control/yielding.py"
    const double periods = control_stopping_least_periods(arena, now, before, &yielding->limits, dt, yielding->cubic, false);
    #line 400 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0; i < dof; i++) {
        #line 401 "iiwa_dnn/control/yielding.py"
        if (periods < INFINITY) {
            #line 402 "iiwa_dnn/control/yielding.py"
            x.data[i] += control_stopping_next_velocity(arena, now.data[i], before.data[i], periods, yielding->cubic);
        }
    }
    arena_leave(arena, &mark);
}

/* Replace the wanted velocity x (n,) [rad/s] by the next command, joint by joint.
 *
 * Each joint approaches its wanted velocity as quickly as its limits allow. It does not overshoot
 * a wanted velocity that keeps changing as since the last step (`motion_state.wanted`). Bounds are
 * those of the program `limits`.
 *
 * iiwa_dnn/control/yielding.py: _approach_each */
static inline void control_yielding_approach_each(struct arena *arena, const qp_layout_QPViews *limits, const control_state_MotionState *motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, Vector x)
{
    #line 369 "iiwa_dnn/control/yielding.py"
    #line 375 "iiwa_dnn/control/yielding.py"
    const int64_t dof = motion_state->q.size0;
    #line 376 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0; i < dof; i++) {
        #line 377 "iiwa_dnn/control/yielding.py"
        const double most = yielding->limits.acceleration.data[i] * timing->dt;
        #line 378 "iiwa_dnn/control/yielding.py"
        const double change = double_min(double_max(x.data[i] - motion_state->wanted.data[i], -most), most);
        #line 379 "iiwa_dnn/control/yielding.py"
        const double behind = motion_state->last.data[i] - (x.data[i] - change);
        #line 380 "iiwa_dnn/control/yielding.py"
        const double rate = yielding->limits.jerk.data[i];
        #line 381 "iiwa_dnn/control/yielding.py"
        x.data[i] += schemes_profiles_braking(arena, behind, limits->lb.data[i] - x.data[i], limits->ub.data[i] - x.data[i], rate, timing);
    }
}

/* Return b_j, or if the bounds do not admit A_j x = b_j, the rate A_j x of the given x (n,).
 *
 * The rate is clipped to the values that A_j takes within the bounds.
 *
 * iiwa_dnn/control/fallback.py: _rate_within */
static inline double control_fallback_rate_within(struct arena *arena, const qp_layout_QPViews *qp, int64_t j, Vector x)
{
    #line 365 "iiwa_dnn/control/fallback.py"
    #line 369 "iiwa_dnn/control/fallback.py"
    double lowest = 0.0;
    #line 370 "iiwa_dnn/control/fallback.py"
    double highest = 0.0;
    #line 371 "iiwa_dnn/control/fallback.py"
    for (int64_t i = 0; i < x.size0; i++) {
        #line 372 "iiwa_dnn/control/fallback.py"
        if (qp->A.data[j * qp->A.size1 + i] != 0.0) {
            #line 373 "iiwa_dnn/control/fallback.py"
            lowest += double_min(qp->A.data[j * qp->A.size1 + i] * qp->lb.data[i], qp->A.data[j * qp->A.size1 + i] * qp->ub.data[i]);
            #line 374 "iiwa_dnn/control/fallback.py"
            highest += double_max(qp->A.data[j * qp->A.size1 + i] * qp->lb.data[i], qp->A.data[j * qp->A.size1 + i] * qp->ub.data[i]);
        }
    }
    #line 375 "iiwa_dnn/control/fallback.py"
    double rate = qp->b.data[j];
    #line 376 "iiwa_dnn/control/fallback.py"
    if (!(lowest - control_fallback_REACHED <= rate && rate <= highest + control_fallback_REACHED)) {
        #line 377 "iiwa_dnn/control/fallback.py"
        rate = double_min(double_max(qp_dense_row_dot(arena, qp->A, j, x), lowest), highest);
    }
    #line 378 "iiwa_dnn/control/fallback.py"
    return rate;
}

/* Project x (n,) on bounds, inequality rows and rows of coupled joints, and overwrite it.
 *
 * Only the first `equalities` equality rows are looked at. `stats` is updated as in `solve_warm`.
 *
 * Returns:
 *     True if the projection converged. If it did not, x stays, or with equality rows is the last
 *     finite iterate.
 *
 * iiwa_dnn/control/fallback.py: _move_within */
static inline bool control_fallback_move_within(struct arena *arena, const qp_layout_QPViews *qp, Vector x, const control_fallback_Yielding *yielding, const networks_integrators_base_SolveStats *stats, int64_t equalities)
{
    const struct arena mark = *arena;
    #line 334 "iiwa_dnn/control/fallback.py"
    #line 342 "iiwa_dnn/control/fallback.py"
    const int64_t n = x.size0;
    #line 343 "iiwa_dnn/control/fallback.py"
    const int64_t m = qp->h.size0;
    #line 344 "iiwa_dnn/control/fallback.py"
    const int64_t own_1 = qp_layout_data_size(arena, n, m, equalities);
    const Vector data = {(double *)arena_zeros(arena, own_1), own_1};
    #line 345 "iiwa_dnn/control/fallback.py"
    const qp_layout_QPViews nearest = qp_layout_qp_views(arena, data, n, m, equalities);
    #line 346 "iiwa_dnn/control/fallback.py"
    for (int64_t i = 0; i < n; i++) {
        #line 347 "iiwa_dnn/control/fallback.py"
        nearest.P.data[i * nearest.P.size1 + i] = 1.0;
        #line 348 "iiwa_dnn/control/fallback.py"
        nearest.q.data[i] = -x.data[i];
    }
    #line 349 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0; j < equalities; j++) {
        #line 350 "iiwa_dnn/control/fallback.py"
        if (yielding->weights.data[j] == 0.0) {
            #line 351 "iiwa_dnn/control/fallback.py"
            qp_layout_copied(arena, (Vector){nearest.A.data + j * nearest.A.size1, nearest.A.size1}, (Vector){qp->A.data + j * qp->A.size1, qp->A.size1});
            #line 352 "iiwa_dnn/control/fallback.py"
            nearest.b.data[j] = control_fallback_rate_within(arena, qp, j, x);
        }
    }
    #line 353 "iiwa_dnn/control/fallback.py"
    control_fallback_copy_limits(arena, qp, &nearest);
    #line 354 "iiwa_dnn/control/fallback.py"
    const Vector point = {(double *)arena_empty(arena, 2 * n + m + equalities), 2 * n + m + equalities};
    #line 355 "iiwa_dnn/control/fallback.py"
    const Vector state = {(double *)arena_zeros(arena, 3 * n + m + equalities), 3 * n + m + equalities};
    #line 356 "iiwa_dnn/control/fallback.py"
    const bool found = control_fallback_solve_warm(arena, &nearest, yielding->tolerance, state, point, stats);
    #line 358 "iiwa_dnn/control/fallback.py"
    if (found || (equalities > 0 && qp_dense_all_finite(arena, point, 0, n))) {
        #line 359 "iiwa_dnn/control/fallback.py"
        qp_layout_copied(arena, x, (Vector){point.data, n});
    }
    #line 360 "iiwa_dnn/control/fallback.py"
    arena_leave(arena, &mark);
    return found;
}

/* Project x on the bounds of a program and, if that violates inequality rows, on these too.
 *
 * Rows of coupled joints, the equality rows of weight 0, are kept as well if the other limits
 * allow it; rows of tasks do not count.
 *
 * Args:
 *     qp: The program.
 *     x: Velocities, (n,), overwritten by the projection.
 *     yielding: Weights, which tell the rows of coupled joints, and the tolerance.
 *     stats: Statistics of a step, updated as in `solve_warm`.
 *
 * Returns:
 *     False if no point within bounds and inequality rows was found.
 *
 * iiwa_dnn/control/fallback.py: nearest_within */
static inline bool control_fallback_nearest_within(struct arena *arena, const qp_layout_QPViews *qp, Vector x, const control_fallback_Yielding *yielding, const networks_integrators_base_SolveStats *stats)
{
    #line 306 "iiwa_dnn/control/fallback.py"
    #line 320 "iiwa_dnn/control/fallback.py"
    if (yielding->coupled && control_fallback_move_within(arena, qp, x, yielding, stats, qp->b.size0)) {
        #line 321 "iiwa_dnn/control/fallback.py"
        return true;
    }
    #line 322 "iiwa_dnn/control/fallback.py"
    int64_t outside = 0;
    #line 323 "iiwa_dnn/control/fallback.py"
    for (int64_t i = 0; i < x.size0; i++) {
        #line 324 "iiwa_dnn/control/fallback.py"
        x.data[i] = double_min(double_max(x.data[i], qp->lb.data[i]), qp->ub.data[i]);
    }
    #line 325 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 326 "iiwa_dnn/control/fallback.py"
        outside += qp_dense_row_dot(arena, qp->G, j, x) > qp->h.data[j];
    }
    #line 327 "iiwa_dnn/control/fallback.py"
    return outside == 0 || control_fallback_move_within(arena, qp, x, yielding, stats, 0);
}

/* Replace the answer x of a fallback program by the next command towards it, within limits.
 *
 * Without acceleration and jerk limits nothing changes.
 *
 * Args:
 *     limits: The program that was answered, with the nominal bounds.
 *     motion_state: State of the motion.
 *     next_motion_state: State for the next step; the answer is written to `wanted`.
 *     yielding: Constants of the fallback programs, with the rate limits.
 *     timing: Periods of the step.
 *     stats: Statistics of the step, updated as in `solve_warm`.
 *     x: The answer, overwritten by the command [rad/s], (n,).
 *
 * iiwa_dnn/control/yielding.py: _approach_answer */
static inline void control_yielding_approach_answer(struct arena *arena, const qp_layout_QPViews *limits, const control_state_MotionState *motion_state, const control_state_MotionState *next_motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, const networks_integrators_base_SolveStats *stats, Vector x)
{
    #line 341 "iiwa_dnn/control/yielding.py"
    #line 354 "iiwa_dnn/control/yielding.py"
    if (yielding->limits.velocity.size0 == 0) {
        #line 355 "iiwa_dnn/control/yielding.py"
        return;
    }
    #line 356 "iiwa_dnn/control/yielding.py"
    qp_layout_copied(arena, next_motion_state->wanted, (Vector){x.data, motion_state->q.size0});
    #line 358 "iiwa_dnn/control/yielding.py"
    if (yielding->coupled) {
        #line 359 "iiwa_dnn/control/yielding.py"
        control_yielding_approach_together(arena, motion_state, yielding, timing, x);
    } else {
        #line 361 "iiwa_dnn/control/yielding.py"
        control_yielding_approach_each(arena, limits, motion_state, yielding, timing, x);
    }
    #line 362 "iiwa_dnn/control/yielding.py"
    control_fallback_nearest_within(arena, limits, x, yielding, stats);
}

/* Raise the number of periods of a motion to rest until its next period keeps the rate limits.
 *
 * Args:
 *     x: Present velocities [rad/s], (n,).
 *     before: Velocities one period earlier [rad/s], (n,).
 *     limits: Limits of the joints, of which acceleration and jerk are read.
 *     dt: Control period [s].
 *     periods: Number of periods to begin with.
 *
 * Returns:
 *     Number of periods, not rounded; at least `LONGEST` if no smaller one was found.
 *
 * iiwa_dnn/control/stopping.py: stretched */
static inline double control_stopping_stretched(struct arena *arena, Vector x, Vector before, const schemes_rate_limits_MotionConstants *limits, double dt, double periods)
{
    #line 183 "iiwa_dnn/control/stopping.py"
    #line 195 "iiwa_dnn/control/stopping.py"
    int64_t i = 0;
    #line 196 "iiwa_dnn/control/stopping.py"
    while (i < x.size0 && periods < control_stopping_LONGEST) {
        #line 197 "iiwa_dnn/control/stopping.py"
        const double change = control_stopping_next_velocity(arena, x.data[i], before.data[i], periods, true) - x.data[i];
        #line 198 "iiwa_dnn/control/stopping.py"
        const double jerk = fabs(change - x.data[i] + before.data[i]) / dt;
        #line 199 "iiwa_dnn/control/stopping.py"
        const double fraction = double_max(fabs(change) / limits->acceleration.data[i], jerk / limits->jerk.data[i]);
        #line 200 "iiwa_dnn/control/stopping.py"
        if (fraction <= dt * (1.0 + control_stopping_SLACK)) {
            #line 201 "iiwa_dnn/control/stopping.py"
            i += 1;
        } else {
            #line 203 "iiwa_dnn/control/stopping.py"
            periods *= control_stopping_STRETCH;
            #line 204 "iiwa_dnn/control/stopping.py"
            i = 0;
        }
    }
    #line 205 "iiwa_dnn/control/stopping.py"
    return periods;
}

/* Compute the next command of a motion that comes to rest after a number of periods.
 *
 * The command dq [rad/s], (n,), is overwritten, within velocity and acceleration limits.
 *
 * iiwa_dnn/control/yielding.py: _slow_down */
static inline void control_yielding_slow_down(struct arena *arena, const control_state_MotionState *motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, double periods, Vector dq)
{
    #line 541 "iiwa_dnn/control/yielding.py"
    #line 545 "iiwa_dnn/control/yielding.py"
    const int64_t dof = motion_state->q.size0;
    #line 546 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0; i < dof; i++) {
        #line 547 "iiwa_dnn/control/yielding.py"
        const double last = motion_state->last.data[i];
        #line 548 "iiwa_dnn/control/yielding.py"
        const double fastest = double_max(yielding->limits.velocity.data[i], fabs(last));
        #line 549 "iiwa_dnn/control/yielding.py"
        const double change = yielding->limits.acceleration.data[i] * timing->dt;
        #line 550 "iiwa_dnn/control/yielding.py"
        dq.data[i] = control_stopping_next_velocity(arena, last, motion_state->before.data[i], periods, yielding->cubic);
        #line 552 "iiwa_dnn/control/yielding.py"
        dq.data[i] = double_min(double_max(dq.data[i], last - change), last + change);
        #line 553 "iiwa_dnn/control/yielding.py"
        dq.data[i] = double_min(double_max(dq.data[i], -fastest), fastest);
    }
}

/* Compute the next command of the stored stopping motion or, if none is stored, of a new one.
 *
 * Without acceleration and jerk limits the command is zero. A new motion takes the number of
 * periods of `least_periods`; its command keeps the bounds, widened so that it may go to rest, and
 * the inequality rows are ignored.
 *
 * Args:
 *     limits: A program with the nominal bounds.
 *     arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
 *     motion_state: State of the motion.
 *     yielding: Constants of the fallback programs and stopping motions.
 *     timing: Periods of the step.
 *     log: The step's log; its stats are updated.
 *     dq: The command [rad/s], (n,), overwritten.
 *
 * Returns:
 *     Periods until rest after the command; 0 if no stopping motion from it is verified.
 *
 * iiwa_dnn/control/yielding.py: _brake */
static inline double control_yielding_brake(struct arena *arena, const qp_layout_QPViews *limits, const schemes_program_ProgramArrays *arrays, const control_state_MotionState *motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, const control_command_StepLog *log, Vector dq)
{
    const struct arena mark = *arena;
    #line 487 "iiwa_dnn/control/yielding.py"
    #line 505 "iiwa_dnn/control/yielding.py"
    for (int64_t own_k = 0; own_k < dq.size0; own_k++) {
        dq.data[own_k] = 0.0;
    }
    #line 506 "iiwa_dnn/control/yielding.py"
    if (yielding->limits.velocity.size0 == 0) {
        #line 507 "iiwa_dnn/control/yielding.py"
        arena_leave(arena, &mark);
        return 0.0;
    }
    #line 508 "iiwa_dnn/control/yielding.py"
    const double rest = motion_state->at->stopping_periods;
    #line 509 "iiwa_dnn/control/yielding.py"
    const int64_t dof = motion_state->q.size0;
    #line 510 "iiwa_dnn/control/yielding.py"
    const double dt = timing->dt;
    #line 511 "iiwa_dnn/control/yielding.py"
    double periods = rest;
    #line 512 "iiwa_dnn/control/yielding.py"
    const Vector last = motion_state->last;
    #line 513 "iiwa_dnn/control/yielding.py"
    const Vector before = motion_state->before;
    #line 514 "iiwa_dnn/control/yielding.py"
    if (rest == 0.0) {
        #line 515 "iiwa_dnn/control/yielding.py"
        periods = control_stopping_least_periods(arena, last, before, &yielding->limits, dt, yielding->cubic, false);
    } else {
        #line 516 "iiwa_dnn/control/yielding.py"
        if (yielding->cubic && timing->vary) {
            #line 517 "iiwa_dnn/control/yielding.py"
            periods = control_stopping_stretched(arena, last, before, &yielding->limits, dt, rest);
        }
    }
    #line 518 "iiwa_dnn/control/yielding.py"
    if (periods < INFINITY) {
        #line 519 "iiwa_dnn/control/yielding.py"
        control_yielding_slow_down(arena, motion_state, yielding, timing, periods, dq);
    }
    #line 520 "iiwa_dnn/control/yielding.py"
    if (rest > 0.0) {
        #line 521 "iiwa_dnn/control/yielding.py"
        const double own_result = double_max(periods - 1.0, 0.0);
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 522 "iiwa_dnn/control/yielding.py"
    const Vector lb = {(double *)arena_copy(arena, limits->lb.data, limits->lb.size0), limits->lb.size0};
    #line 523 "iiwa_dnn/control/yielding.py"
    const Vector ub = {(double *)arena_copy(arena, limits->ub.data, limits->ub.size0), limits->ub.size0};
    #line 524 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = periods < INFINITY ? dq.size0 : 0; i < end_i; i++) {
        #line 525 "iiwa_dnn/control/yielding.py"
        lb.data[i] = double_min(lb.data[i], double_max(dq.data[i], 0.0));
        #line 526 "iiwa_dnn/control/yielding.py"
        ub.data[i] = double_max(ub.data[i], double_min(dq.data[i], 0.0));
    }
    #line 528 "iiwa_dnn/control/yielding.py"
    const Vector rates = {(double *)arena_zeros(arena, limits->b.size0), limits->b.size0};
    #line 529 "iiwa_dnn/control/yielding.py"
    const Vector idle = {(double *)arena_empty(arena, limits->h.size0), limits->h.size0};
    #line 530 "iiwa_dnn/control/yielding.py"
    for (int64_t own_k = 0; own_k < idle.size0; own_k++) {
        idle.data[own_k] = INFINITY;
    }
    #line 531 "iiwa_dnn/control/yielding.py"
    qp_dense_times(arena, limits->A, dq, rates);
    #line 532 "iiwa_dnn/control/yielding.py"
    const qp_layout_QPViews braking = {limits->P, limits->q, limits->G, idle, limits->A, rates, lb, ub};
    #line 533 "iiwa_dnn/control/yielding.py"
    control_fallback_nearest_within(arena, &braking, dq, yielding, &log->stats);
    #line 534 "iiwa_dnn/control/yielding.py"
    const double own_result = double_max(control_stopping_stopping_time(arena, arrays, motion_state, log->least, yielding, timing, (Vector){dq.data, dof}), 0.0);
    arena_leave(arena, &mark);
    return own_result;
}

/* Test whether the distance that a pair has to keep, of `least` (pairs,) [m], is reduced.
 *
 * It is if it is below the least distance of the pair's scene.
 *
 * iiwa_dnn/control/yielding.py: _is_near */
static inline bool control_yielding_is_near(struct arena *arena, const schemes_program_ProgramArrays *arrays, const control_fallback_Yielding *yielding, Vector least)
{
    #line 457 "iiwa_dnn/control/yielding.py"
    #line 461 "iiwa_dnn/control/yielding.py"
    bool found = false;
    #line 462 "iiwa_dnn/control/yielding.py"
    for (int64_t k = 0, end_k = yielding->scenes.size0; k < end_k; k++) {
        #line 463 "iiwa_dnn/control/yielding.py"
        const Vector own = schemes_program_block_constants(arena, arrays, yielding->scenes.data[k]);
        #line 464 "iiwa_dnn/control/yielding.py"
        const schemes_scene_SceneViews scene = schemes_scene_scene_views(arena, own, arrays->sizes.joints);
        #line 465 "iiwa_dnn/control/yielding.py"
        for (int64_t i = 0, end_i = scene.pairs.size0; i < end_i; i++) {
            #line 466 "iiwa_dnn/control/yielding.py"
            found = found || least.data[(int64_t)scene.head.at->first + i] < scene.head.at->least;
        }
    }
    #line 467 "iiwa_dnn/control/yielding.py"
    return found;
}

/* If a stopping motion is stored, copy its verified distances `least` to the next state.
 *
 * iiwa_dnn/control/yielding.py: _keep_verified_distances */
static inline void control_yielding_keep_verified_distances(struct arena *arena, const control_state_MotionState *motion_state, const control_state_MotionState *next_motion_state)
{
    #line 472 "iiwa_dnn/control/yielding.py"
    #line 473 "iiwa_dnn/control/yielding.py"
    if (motion_state->at->stopping_periods > 0.0) {
        #line 474 "iiwa_dnn/control/yielding.py"
        qp_layout_copied(arena, next_motion_state->least, motion_state->least);
    }
}

/* Blend a command towards the stored stopping motion until the arm can stop after it.
 *
 * Args:
 *     limits: The program that was answered, with the nominal bounds.
 *     arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
 *     motion_state: State of the motion, with the stored stopping motion.
 *     next_motion_state: State for the next step; `least` is overwritten if the stopping motion
 *         itself is taken.
 *     yielding: Constants of the fallback programs and stopping motions.
 *     timing: Periods of the step.
 *     log: The step's log, with the answer; its stats are updated.
 *     x: The command, overwritten [rad/s], (n,).
 *
 * Returns:
 *     Periods until the arm rests after the command; 0 if no stopping motion has to be verified.
 *
 * iiwa_dnn/control/yielding.py: _make_stoppable */
static inline double control_yielding_make_stoppable(struct arena *arena, const qp_layout_QPViews *limits, const schemes_program_ProgramArrays *arrays, const control_state_MotionState *motion_state, const control_state_MotionState *next_motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, const control_command_StepLog *log, Vector x)
{
    const struct arena mark = *arena;
    #line 416 "iiwa_dnn/control/yielding.py"
    #line 432 "iiwa_dnn/control/yielding.py"
    const int64_t dof = motion_state->q.size0;
    #line 433 "iiwa_dnn/control/yielding.py"
    double rest = control_stopping_stopping_time(arena, arrays, motion_state, log->least, yielding, timing, (Vector){x.data, dof});
    #line 434 "iiwa_dnn/control/yielding.py"
    if (rest >= 0.0) {
        #line 435 "iiwa_dnn/control/yielding.py"
        arena_leave(arena, &mark);
        return rest;
    }
    #line 436 "iiwa_dnn/control/yielding.py"
    const Vector wanted = {(double *)arena_copy(arena, log->point.data, x.size0), x.size0};
    #line 437 "iiwa_dnn/control/yielding.py"
    if (yielding->limits.velocity.size0 > 0) {
        #line 438 "iiwa_dnn/control/yielding.py"
        control_yielding_approach_together(arena, motion_state, yielding, timing, wanted);
        #line 439 "iiwa_dnn/control/yielding.py"
        control_fallback_nearest_within(arena, limits, wanted, yielding, &log->stats);
    }
    #line 440 "iiwa_dnn/control/yielding.py"
    const Vector brake = {(double *)arena_zeros(arena, x.size0), x.size0};
    #line 441 "iiwa_dnn/control/yielding.py"
    const double left = control_yielding_brake(arena, limits, arrays, motion_state, yielding, timing, log, brake);
    #line 442 "iiwa_dnn/control/yielding.py"
    double fraction = 1.0;
    #line 443 "iiwa_dnn/control/yielding.py"
    for (int64_t _ = 0, end__ = control_yielding_is_near(arena, arrays, yielding, log->least) ? control_yielding_HALVINGS_NEAR : control_yielding_HALVINGS; _ < end__; _++) {
        #line 444 "iiwa_dnn/control/yielding.py"
        for (int64_t i = 0; i < dof; i++) {
            #line 445 "iiwa_dnn/control/yielding.py"
            x.data[i] = brake.data[i] + fraction * (wanted.data[i] - brake.data[i]);
        }
        #line 446 "iiwa_dnn/control/yielding.py"
        rest = control_stopping_stopping_time(arena, arrays, motion_state, log->least, yielding, timing, (Vector){x.data, dof});
        #line 447 "iiwa_dnn/control/yielding.py"
        if (rest >= 0.0) {
            #line 448 "iiwa_dnn/control/yielding.py"
            arena_leave(arena, &mark);
            return rest;
        }
        #line 449 "iiwa_dnn/control/yielding.py"
        fraction *= 0.5;
    }
    #line 450 "iiwa_dnn/control/yielding.py"
    qp_layout_copied(arena, x, brake);
    #line 451 "iiwa_dnn/control/yielding.py"
    control_yielding_keep_verified_distances(arena, motion_state, next_motion_state);
    #line 452 "iiwa_dnn/control/yielding.py"
    arena_leave(arena, &mark);
    return left;
}

/* Count the joints whose command dq (dof,) [rad/s] differs from the answer in log.point.
 *
 * For each, log.limiting becomes the sign of the answer minus the command.
 *
 * iiwa_dnn/control/yielding.py: _note_missing */
static inline int64_t control_yielding_note_missing(struct arena *arena, const control_command_StepLog *log, Vector dq)
{
    (void)arena;
    #line 318 "iiwa_dnn/control/yielding.py"
    #line 322 "iiwa_dnn/control/yielding.py"
    int64_t count = 0;
    #line 323 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0; i < dq.size0; i++) {
        #line 324 "iiwa_dnn/control/yielding.py"
        const double missing = log->point.data[i] - dq.data[i];
        #line 325 "iiwa_dnn/control/yielding.py"
        if (fabs(missing) > control_fallback_REACHED) {
            #line 326 "iiwa_dnn/control/yielding.py"
            log->limiting.data[i] = copysign(1.0, missing);
            #line 327 "iiwa_dnn/control/yielding.py"
            count += 1;
        }
    }
    #line 328 "iiwa_dnn/control/yielding.py"
    return count;
}

/* Multiply the signs of the joints in log.limiting by the `LimitKind` of their bounds.
 *
 * A positive sign takes `upper_kind` (dof,), another `lower_kind` (dof,).
 *
 * iiwa_dnn/control/yielding.py: _note_kinds */
static inline void control_yielding_note_kinds(struct arena *arena, const control_command_StepLog *log, Vector lower_kind, Vector upper_kind)
{
    (void)arena;
    #line 183 "iiwa_dnn/control/yielding.py"
    #line 187 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0; i < lower_kind.size0; i++) {
        #line 188 "iiwa_dnn/control/yielding.py"
        log->limiting.data[i] *= log->limiting.data[i] > 0.0 ? upper_kind.data[i] : lower_kind.data[i];
    }
}

/* Compute the fraction of a task velocity b (p,) that joint velocities x (n,) reach.
 *
 * It is b^T W^2 A x / (b^T W^2 b), at most 1, with A (p, n) and W = diag(weights); 1 if W b = 0.
 *
 * iiwa_dnn/control/fallback.py: attained */
static inline double control_fallback_attained(struct arena *arena, Vector b, Matrix A, Vector weights, Vector x)
{
    #line 383 "iiwa_dnn/control/fallback.py"
    #line 387 "iiwa_dnn/control/fallback.py"
    double asked = 0.0;
    #line 388 "iiwa_dnn/control/fallback.py"
    double given = 0.0;
    #line 389 "iiwa_dnn/control/fallback.py"
    for (int64_t j = 0; j < b.size0; j++) {
        #line 390 "iiwa_dnn/control/fallback.py"
        const double rhs = weights.data[j] * weights.data[j] * b.data[j];
        #line 391 "iiwa_dnn/control/fallback.py"
        asked += rhs * b.data[j];
        #line 392 "iiwa_dnn/control/fallback.py"
        given += rhs * qp_dense_row_dot(arena, A, j, x);
    }
    #line 393 "iiwa_dnn/control/fallback.py"
    return asked > 0.0 ? double_min(given / asked, 1.0) : 1.0;
}

/* Write fraction, kind and status of a step into its log, and find the action that was taken.
 *
 * Args:
 *     log: The step's log; fraction, kind and status are overwritten. If the network of the
 *         nominal program failed and is not compiled, the primal residual of a nominal answer is
 *         set to inf.
 *     nominal: The nominal program.
 *     yielding: Weights of its equality rows, and whether its network is compiled.
 *     x: The command, with slack variables if any, (n,).
 *     kind: `ProgramKind` of the program that was answered.
 *     factor: Scaling factor of the task in the program.
 *     action: Action of the policy, or `BRAKE`.
 *
 * Returns:
 *     The action that was taken: `NONE`, `SLOW`, `RELAX` or `STOP`.
 *
 * iiwa_dnn/control/yielding.py: _note_decision */
static inline int64_t control_yielding_note_decision(struct arena *arena, const control_command_StepLog *log, const qp_layout_QPViews *nominal, const control_fallback_Yielding *yielding, Vector x, int64_t kind, double factor, int64_t action)
{
    #line 201 "iiwa_dnn/control/yielding.py"
    #line 217 "iiwa_dnn/control/yielding.py"
    int64_t taken = control_yielding_STOP;
    #line 218 "iiwa_dnn/control/yielding.py"
    double fraction = 0.0;
    #line 219 "iiwa_dnn/control/yielding.py"
    if (kind <= control_yielding_SCALED) {
        #line 220 "iiwa_dnn/control/yielding.py"
        taken = factor == 1.0 ? control_yielding_NONE : control_yielding_SLOW;
        #line 221 "iiwa_dnn/control/yielding.py"
        fraction = factor;
    } else {
        #line 222 "iiwa_dnn/control/yielding.py"
        if (kind != control_yielding_STOPPED) {
            #line 223 "iiwa_dnn/control/yielding.py"
            taken = kind == control_yielding_RATE_LIMITED || control_yielding_is_path(arena, log->targets) ? action : control_yielding_RELAX;
            #line 224 "iiwa_dnn/control/yielding.py"
            fraction = 1.0;
            #line 225 "iiwa_dnn/control/yielding.py"
            if (taken == control_yielding_SLOW) {
                #line 226 "iiwa_dnn/control/yielding.py"
                fraction = double_max(control_fallback_attained(arena, nominal->b, nominal->A, yielding->weights, x), control_yielding_CREEP);
            }
        }
    }
    #line 227 "iiwa_dnn/control/yielding.py"
    log->at->fraction = fraction;
    #line 228 "iiwa_dnn/control/yielding.py"
    log->at->kind = (double)kind;
    #line 229 "iiwa_dnn/control/yielding.py"
    if (taken == control_yielding_STOP) {
        #line 230 "iiwa_dnn/control/yielding.py"
        log->at->status = (double)int_max((int64_t)log->at->status, control_command_NOT_CONVERGED);
    } else {
        #line 231 "iiwa_dnn/control/yielding.py"
        if (kind != control_yielding_NOMINAL || yielding->alike) {
            #line 232 "iiwa_dnn/control/yielding.py"
            log->at->status = (double)control_command_SOLVED;
        } else {
            #line 233 "iiwa_dnn/control/yielding.py"
            if ((int64_t)log->at->status >= control_command_NOT_CONVERGED) {
                #line 234 "iiwa_dnn/control/yielding.py"
                log->stats.at->primal = INFINITY;
            }
        }
    }
    #line 235 "iiwa_dnn/control/yielding.py"
    return taken;
}

/* Compute the command of a step without a nominal answer, by a fallback program or by braking.
 *
 * Called if the network has no answer or an unsafe one, if a policy acted at the last step, or if
 * the arm is halted.
 *
 * Args:
 *     log: The step's log, with the nominal program and its joint positions; program, answer and
 *         command are overwritten.
 *     arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
 *     motion_state: State of the motion.
 *     next_motion_state: State for the next step, overwritten.
 *     yielding: Constants of the fallback programs and stopping motions.
 *     timing: Periods of the step.
 *     fallback: Network states of the fallback programs, (`fallback_size`,), overwritten.
 *     action: Action of the policy, or `BRAKE` to brake even if a program has a solution.
 *
 * Returns:
 *     The action that was taken.
 *
 * iiwa_dnn/control/yielding.py: yield_step */
static inline int64_t control_yielding_yield_step(struct arena *arena, const control_command_StepLog *log, const schemes_program_ProgramArrays *arrays, const control_state_MotionState *motion_state, const control_state_MotionState *next_motion_state, const control_fallback_Yielding *yielding, const schemes_periods_Periods *timing, Vector fallback, int64_t action)
{
    const struct arena mark = *arena;
    #line 113 "iiwa_dnn/control/yielding.py"
    #line 132 "iiwa_dnn/control/yielding.py"
    const qp_layout_QPViews qp = schemes_program_program_views(arena, log->program, &arrays->sizes);
    #line 133 "iiwa_dnn/control/yielding.py"
    const Vector data = {(double *)arena_copy(arena, log->program.data, log->program.size0), log->program.size0};
    #line 134 "iiwa_dnn/control/yielding.py"
    const qp_layout_QPViews nominal = schemes_program_program_views(arena, data, &arrays->sizes);
    #line 135 "iiwa_dnn/control/yielding.py"
    const Vector lower_kind = {(double *)arena_copy(arena, log->lower_kind.data, log->lower_kind.size0), log->lower_kind.size0};
    #line 136 "iiwa_dnn/control/yielding.py"
    const Vector upper_kind = {(double *)arena_copy(arena, log->upper_kind.data, log->upper_kind.size0), log->upper_kind.size0};
    #line 137 "iiwa_dnn/control/yielding.py"
    int64_t kind = control_yielding_STOPPED;
    #line 138 "iiwa_dnn/control/yielding.py"
    double factor = 0.0;
    #line 139 "iiwa_dnn/control/yielding.py"
    double rest = 0.0;
    #line 140 "iiwa_dnn/control/yielding.py"
    if (action != control_yielding_BRAKE) {
        #line 141 "iiwa_dnn/control/yielding.py"
        control_yielding_widen_bounds(arena, log, &qp, &yielding->limits);
        #line 142 "iiwa_dnn/control/yielding.py"
        const double_2 own_1 = control_yielding_answer_fallback(arena, log, &qp, yielding, fallback, action);
        const double found = own_1.at[0];
        factor = own_1.at[1];
        #line 143 "iiwa_dnn/control/yielding.py"
        kind = int_of(found);
    }
    #line 144 "iiwa_dnn/control/yielding.py"
    const Vector x = {(double *)arena_copy(arena, log->point.data, qp.q.size0), qp.q.size0};
    #line 145 "iiwa_dnn/control/yielding.py"
    const qp_layout_QPViews limits = {qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, nominal.lb, nominal.ub};
    #line 146 "iiwa_dnn/control/yielding.py"
    if (kind != control_yielding_STOPPED) {
        #line 147 "iiwa_dnn/control/yielding.py"
        control_yielding_approach_answer(arena, &limits, motion_state, next_motion_state, yielding, timing, &log->stats, x);
        #line 148 "iiwa_dnn/control/yielding.py"
        rest = control_yielding_make_stoppable(arena, &limits, arrays, motion_state, next_motion_state, yielding, timing, log, x);
        #line 151 "iiwa_dnn/control/yielding.py"
        const int64_t missing = control_yielding_note_missing(arena, log, (Vector){x.data, arrays->sizes.joints});
        #line 152 "iiwa_dnn/control/yielding.py"
        const double_3 own_2 = qp_residuals_point_residuals(arena, &limits, log->point);
        const double primal = own_2.at[0];
        const double dual = own_2.at[1];
        const double gap = own_2.at[2];
        #line 153 "iiwa_dnn/control/yielding.py"
        if (missing > 0) {
            #line 154 "iiwa_dnn/control/yielding.py"
            kind = action == control_yielding_STOP ? control_yielding_STOPPED : control_yielding_RATE_LIMITED;
        } else {
            #line 155 "iiwa_dnn/control/yielding.py"
            if (factor == 1.0 && qp_residuals_within(arena, primal, dual, gap, yielding->tolerance)) {
                #line 156 "iiwa_dnn/control/yielding.py"
                kind = control_yielding_NOMINAL;
                #line 157 "iiwa_dnn/control/yielding.py"
                qp_layout_copied(arena, qp.lb, nominal.lb);
                #line 158 "iiwa_dnn/control/yielding.py"
                qp_layout_copied(arena, qp.ub, nominal.ub);
                #line 159 "iiwa_dnn/control/yielding.py"
                qp_layout_copied(arena, log->lower_kind, lower_kind);
                #line 160 "iiwa_dnn/control/yielding.py"
                qp_layout_copied(arena, log->upper_kind, upper_kind);
            }
        }
    }
    #line 161 "iiwa_dnn/control/yielding.py"
    control_yielding_note_kinds(arena, log, lower_kind, upper_kind);
    #line 162 "iiwa_dnn/control/yielding.py"
    if (kind == control_yielding_STOPPED) {
        #line 163 "iiwa_dnn/control/yielding.py"
        qp_layout_copied(arena, log->program, data);
        #line 164 "iiwa_dnn/control/yielding.py"
        qp_layout_copied(arena, log->lower_kind, lower_kind);
        #line 165 "iiwa_dnn/control/yielding.py"
        qp_layout_copied(arena, log->upper_kind, upper_kind);
        #line 166 "iiwa_dnn/control/yielding.py"
        rest = control_yielding_brake(arena, &nominal, arrays, motion_state, yielding, timing, log, x);
        #line 167 "iiwa_dnn/control/yielding.py"
        control_yielding_keep_verified_distances(arena, motion_state, next_motion_state);
        #line 168 "iiwa_dnn/control/yielding.py"
        for (int64_t own_k = 0; own_k < log->point.size0; own_k++) {
            log->point.data[own_k] = 0.0;
        }
        #line 169 "iiwa_dnn/control/yielding.py"
        qp_layout_copied(arena, log->point, x);
    }
    #line 170 "iiwa_dnn/control/yielding.py"
    const double_3 own_3 = qp_residuals_point_residuals(arena, &qp, log->point);
    log->stats.at->primal = own_3.at[0];
    log->stats.at->dual = own_3.at[1];
    log->stats.at->gap = own_3.at[2];
    #line 171 "iiwa_dnn/control/yielding.py"
    const int64_t taken = control_yielding_note_decision(arena, log, &nominal, yielding, x, kind, factor, action);
    #line 172 "iiwa_dnn/control/yielding.py"
    if (taken == control_yielding_NONE) {
        #line 173 "iiwa_dnn/control/yielding.py"
        control_command_note_active(arena, log, &qp, yielding->tolerance);
    }
    #line 174 "iiwa_dnn/control/yielding.py"
    next_motion_state->at->stopping_periods = rest;
    #line 175 "iiwa_dnn/control/yielding.py"
    next_motion_state->at->path_lag += timing->expected * (1.0 - log->at->fraction);
    #line 176 "iiwa_dnn/control/yielding.py"
    next_motion_state->at->yields = kind != control_yielding_NOMINAL && action != control_yielding_BRAKE;
    #line 177 "iiwa_dnn/control/yielding.py"
    control_command_note_command(arena, log, next_motion_state, x, timing->expected);
    #line 178 "iiwa_dnn/control/yielding.py"
    arena_leave(arena, &mark);
    return taken;
}

/* Take a control step: answer the nominal program, else a fallback program, else brake.
 *
 * If a policy acted at the last step, or the arm is halted, the nominal program is not answered.
 * If targets or time are not finite, or joint positions beyond 2^20 rad, nothing but the sampled
 * targets is written.
 *
 * Args:
 *     data: The step's log, (width,), overwritten; with the targets unless they are sampled.
 *     plan: Constants, settings and work arrays; network states of fallback programs are changed.
 *     q: Joint positions of the kinematics [rad], (dof,).
 *     numbers: Numbers of the `MotionState`, (k,); q is written to it, and it is converted to the
 *         step's period (`change_spacing`).
 *     next_numbers: Numbers of the next `MotionState`, (k,), overwritten.
 *     state: State of the network, (size,), overwritten if the network has an answer.
 *     t: Time [s].
 *
 * Returns:
 *     The action that was taken, or `INVALID`.
 *
 * iiwa_dnn/control/cycle.py: take_step */
static inline int64_t control_cycle_take_step(struct arena *arena, Vector data, const control_cycle_ControlPlan *plan, Vector q, Vector numbers, Vector next_numbers, Vector state, double t)
{
    #line 271 "iiwa_dnn/control/cycle.py"
    #line 290 "iiwa_dnn/control/cycle.py"
    const schemes_program_ProgramArrays arrays = plan->arrays;
    #line 291 "iiwa_dnn/control/cycle.py"
    const schemes_periods_Periods timing = plan->timing;
    #line 292 "iiwa_dnn/control/cycle.py"
    const schemes_program_ProgramSizes sizes = arrays.sizes;
    #line 293 "iiwa_dnn/control/cycle.py"
    const control_command_StepLog log = control_command_log_of(arena, data, &sizes);
    #line 294 "iiwa_dnn/control/cycle.py"
    const control_state_MotionState motion_state = control_state_MotionState_of(numbers, sizes.joints, sizes.pairs);
    #line 295 "iiwa_dnn/control/cycle.py"
    const control_state_MotionState next_motion_state = control_state_MotionState_of(next_numbers, sizes.joints, sizes.pairs);
    #line 296 "iiwa_dnn/control/cycle.py"
    if (plan->samples) {
        #line 297 "iiwa_dnn/control/cycle.py"
        control_cycle_sample_targets(arena, &plan->paths, t - motion_state.at->path_lag, timing.expected, log.targets);
    }
    #line 298 "iiwa_dnn/control/cycle.py"
    if (!control_cycle_is_valid(arena, t, q, data, data.size0 - log.targets.size0 * log.targets.size1)) {
        #line 299 "iiwa_dnn/control/cycle.py"
        return control_cycle_INVALID;
    }
    #line 300 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, motion_state.q, q);
    #line 301 "iiwa_dnn/control/cycle.py"
    control_state_change_spacing(arena, &motion_state, timing.dt);
    #line 302 "iiwa_dnn/control/cycle.py"
    if (timing.vary && plan->yielding.rates >= 0) {
        #line 303 "iiwa_dnn/control/cycle.py"
        const schemes_rate_limits_MotionConstants own_1 = schemes_rate_limits_MotionConstants_of(schemes_program_block_constants(arena, &arrays, plan->yielding.rates), int_max(0, (schemes_program_block_constants(arena, &arrays, plan->yielding.rates).size0 - (4)) / 8));
        schemes_rate_limits_state_periods(arena, &own_1, &timing);
    }
    #line 304 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, next_numbers, numbers);
    #line 305 "iiwa_dnn/control/cycle.py"
    qp_layout_copied(arena, next_motion_state.before, motion_state.last);
    #line 306 "iiwa_dnn/control/cycle.py"
    next_motion_state.at->stopping_periods = 0.0;
    #line 307 "iiwa_dnn/control/cycle.py"
    next_motion_state.at->yields = false;
    #line 308 "iiwa_dnn/control/cycle.py"
    const schemes_step_StepViews step = {t, 1.0 / timing.expected, q, motion_state.last, motion_state.before, arrays.jacobian, arrays.placements, arrays.support, arrays.inertia, log.targets, next_motion_state.least, log.lower_kind, log.upper_kind};
    #line 323 "iiwa_dnn/control/cycle.py"
    schemes_program_assemble(arena, log.program, &arrays, &step);
    #line 324 "iiwa_dnn/control/cycle.py"
    control_cycle_note_instant(arena, &log, &arrays, &motion_state, &next_motion_state);
    #line 325 "iiwa_dnn/control/cycle.py"
    const bool halted = motion_state.at->halts != 0.0 || qp_dense_largest_entry(arena, log.least) == schemes_collisions_MEET;
    #line 326 "iiwa_dnn/control/cycle.py"
    if (!(motion_state.at->yields != 0.0) && !halted && control_cycle_answer(arena, &log, &arrays, &plan->network, state)) {
        #line 327 "iiwa_dnn/control/cycle.py"
        control_command_note_command(arena, &log, &next_motion_state, log.point, timing.expected);
        #line 328 "iiwa_dnn/control/cycle.py"
        if (control_yielding_guard_step(arena, &arrays, &motion_state, &next_motion_state, &plan->yielding, &timing)) {
            #line 329 "iiwa_dnn/control/cycle.py"
            const qp_layout_QPViews own_2 = schemes_program_program_views(arena, log.program, &sizes);
            control_command_note_active(arena, &log, &own_2, plan->yielding.tolerance);
            #line 330 "iiwa_dnn/control/cycle.py"
            return control_yielding_NONE;
        }
    }
    #line 331 "iiwa_dnn/control/cycle.py"
    const int64_t policy = halted ? control_yielding_BRAKE : plan->policy;
    #line 332 "iiwa_dnn/control/cycle.py"
    return control_yielding_yield_step(arena, &log, &arrays, &motion_state, &next_motion_state, &plan->yielding, &timing, plan->fallback, policy);
}

/* Test whether even without limits a twist v (6,) is missed by more than `SHORT` |v|.
 *
 * The error is |W (J x - v)| at the unconstrained minimum x of the twist's program `qp`, whose P
 * is (W J)^T W J + DAMPING^2 I.
 *
 * iiwa_dnn/control/requests.py: falls_short */
static inline bool control_requests_falls_short(struct arena *arena, const qp_layout_QPViews *qp, Vector twist)
{
    const struct arena mark = *arena;
    #line 189 "iiwa_dnn/control/requests.py"
    #line 194 "iiwa_dnn/control/requests.py"
    const int64_t n = qp->q.size0;
    #line 195 "iiwa_dnn/control/requests.py"
    const Matrix K = {(double *)arena_copy(arena, qp->P.data, qp->P.size0 * qp->P.size1), qp->P.size0, qp->P.size1};
    #line 196 "iiwa_dnn/control/requests.py"
    const Vector x = {(double *)arena_zeros(arena, n), n};
    #line 197 "iiwa_dnn/control/requests.py"
    if (qp_dense_cholesky_factor(arena, K)) {
        #line 198 "iiwa_dnn/control/requests.py"
        qp_dense_factor_solve(arena, K, qp->q, x);
    }
    #line 199 "iiwa_dnn/control/requests.py"
    double square = 0.0;
    #line 200 "iiwa_dnn/control/requests.py"
    for (int64_t i = 0; i < control_requests_TWIST; i++) {
        #line 201 "iiwa_dnn/control/requests.py"
        square += twist.data[i] * twist.data[i];
    }
    #line 202 "iiwa_dnn/control/requests.py"
    double missing = square;
    #line 203 "iiwa_dnn/control/requests.py"
    for (int64_t i = 0; i < n; i++) {
        #line 204 "iiwa_dnn/control/requests.py"
        missing -= x.data[i] * (qp->q.data[i] + control_requests_DAMPING * control_requests_DAMPING * x.data[i]);
    }
    #line 205 "iiwa_dnn/control/requests.py"
    const bool own_result = missing > control_requests_SHORT * control_requests_SHORT * square;
    arena_leave(arena, &mark);
    return own_result;
}

/* Return the first `Reason` of an arm's last step, by their codes; `NONE`: there is none.
 *
 * iiwa_dnn/control/arms.py: first_reason */
static inline int64_t control_arms_first_reason(struct arena *arena, const control_arms_ArmState *arm)
{
    (void)arena;
    #line 463 "iiwa_dnn/control/arms.py"
    #line 464 "iiwa_dnn/control/arms.py"
    for (int64_t k = 0, end_k = arm->reasons.size0; k < end_k; k++) {
        #line 465 "iiwa_dnn/control/arms.py"
        if (arm->reasons.data[k] != 0.0) {
            #line 466 "iiwa_dnn/control/arms.py"
            return k;
        }
    }
    #line 467 "iiwa_dnn/control/arms.py"
    return control_requests_Reason_NONE;
}

/* Note the active bounds and rows of a step, and whether its command differs from the request.
 *
 * A command for a twist or for positions differs if a limit is active or there is a `Reason`.
 *
 * iiwa_dnn/control/arms.py: _note_limits */
static inline void control_arms_note_limits(struct arena *arena, const control_arms_ArmState *arm, const control_command_StepLog *log)
{
    #line 593 "iiwa_dnn/control/arms.py"
    #line 597 "iiwa_dnn/control/arms.py"
    qp_layout_copied(arena, arm->limiting, log->limiting);
    #line 598 "iiwa_dnn/control/arms.py"
    const int64_t reason = control_arms_first_reason(arena, arm);
    #line 599 "iiwa_dnn/control/arms.py"
    arm->at->is_clipped = qp_dense_largest_entry(arena, log->limiting) > 0.0 || reason != control_requests_Reason_NONE;
    #line 600 "iiwa_dnn/control/arms.py"
    if ((int64_t)arm->at->answered == control_requests_Request_VELOCITY && reason == control_requests_Reason_NONE) {
        #line 601 "iiwa_dnn/control/arms.py"
        arm->at->is_clipped = control_arms_differing(arena, log->dq, arm->request) > 0;
    }
}

/* Answer the request of an arm by a control step, and keep its results; return the action.
 *
 * iiwa_dnn/control/arms.py: _answer */
static inline int64_t control_arms_answer(struct arena *arena, const control_arms_ArmPlan *plan, const control_arms_ArmState *arm, const control_arms_ArmInput *inputs, Matrix jacobian, Matrix placements, Vector data)
{
    const struct arena mark = *arena;
    #line 479 "iiwa_dnn/control/arms.py"
    #line 480 "iiwa_dnn/control/arms.py"
    const schemes_periods_Periods timing = schemes_periods_periods_of(arena, plan->settings.at->dt, plan->settings.at->longest, inputs->dt, inputs->elapsed);
    #line 481 "iiwa_dnn/control/arms.py"
    const schemes_program_ProgramArrays base = plan->step.arrays;
    #line 482 "iiwa_dnn/control/arms.py"
    const schemes_program_ProgramArrays arrays = {base.sizes, base.table, {(double *)arena_copy(arena, base.constants.data, base.constants.size0), base.constants.size0}, jacobian, placements, base.support, base.inertia, base.tip};
    #line 492 "iiwa_dnn/control/arms.py"
    if (plan->scene >= 0) {
        #line 493 "iiwa_dnn/control/arms.py"
        control_arms_place_obstacles(arena, plan, arm, arm->at->time, schemes_program_block_constants(arena, &arrays, plan->scene));
    }
    #line 494 "iiwa_dnn/control/arms.py"
    const control_state_MotionState motion = control_arms_motion_of(arena, plan, arm);
    #line 495 "iiwa_dnn/control/arms.py"
    control_state_change_spacing(arena, &motion, timing.dt);
    #line 496 "iiwa_dnn/control/arms.py"
    const control_command_StepLog log = control_command_log_of(arena, data, &base.sizes);
    #line 497 "iiwa_dnn/control/arms.py"
    for (int64_t own_k = 0; own_k < log.targets.size0 * log.targets.size1; own_k++) {
        log.targets.data[own_k] = 0.0;
    }
    #line 498 "iiwa_dnn/control/arms.py"
    const bool is_twist = (int64_t)arm->at->answered == control_requests_Request_TWIST;
    #line 499 "iiwa_dnn/control/arms.py"
    const Vector state = is_twist ? arm->network : (Vector){(double *)arena_zeros(arena, arm->network.size0), arm->network.size0};
    #line 500 "iiwa_dnn/control/arms.py"
    const control_requests_RequestConstants request = control_requests_RequestConstants_of(schemes_program_block_constants(arena, &arrays, plan->request), int_max(0, (schemes_program_block_constants(arena, &arrays, plan->request).size0 - (2)) / 1));
    #line 501 "iiwa_dnn/control/arms.py"
    request.at->is_twist = is_twist;
    #line 502 "iiwa_dnn/control/arms.py"
    if (is_twist) {
        #line 503 "iiwa_dnn/control/arms.py"
        const int64_t own_1 = 6;
        const double excess = double_max(qp_dense_largest_entry(arena, (Vector){arm->request.data, own_1}) / plan->fastest, 1.0);
        #line 504 "iiwa_dnn/control/arms.py"
        arm->reasons.data[control_requests_Reason_CUT] = excess > 1.0 ? 1.0 : 0.0;
        #line 505 "iiwa_dnn/control/arms.py"
        for (int64_t i = 0; i < control_requests_TWIST; i++) {
            #line 506 "iiwa_dnn/control/arms.py"
            request.velocity.data[i] = arm->request.data[i] / excess;
        }
    } else {
        #line 508 "iiwa_dnn/control/arms.py"
        control_arms_approach_request(arena, arm, &motion, &plan->motion, &timing, state);
        #line 509 "iiwa_dnn/control/arms.py"
        qp_layout_copied(arena, request.velocity, (Vector){state.data, arm->positions.size0});
    }
    #line 510 "iiwa_dnn/control/arms.py"
    const control_cycle_ControlPlan step = {arrays, plan->step.network, plan->step.paths, plan->step.yielding, is_twist ? arm->twist_fallback : arm->fallback, plan->step.policy, false, timing};
    #line 520 "iiwa_dnn/control/arms.py"
    const Vector next_motion_state = {(double *)arena_empty(arena, arm->motion.size0), arm->motion.size0};
    #line 521 "iiwa_dnn/control/arms.py"
    const int64_t action = control_cycle_take_step(arena, data, &step, arm->positions, arm->motion, next_motion_state, state, arm->at->time);
    #line 522 "iiwa_dnn/control/arms.py"
    if (action == control_cycle_INVALID) {
        #line 523 "iiwa_dnn/control/arms.py"
        for (int64_t own_k = 0; own_k < motion.last.size0; own_k++) {
            motion.last.data[own_k] = 0.0;
        }
        #line 524 "iiwa_dnn/control/arms.py"
        arena_leave(arena, &mark);
        return action;
    }
    #line 525 "iiwa_dnn/control/arms.py"
    qp_layout_copied(arena, arm->motion, next_motion_state);
    #line 526 "iiwa_dnn/control/arms.py"
    motion.at->yields = false;
    #line 527 "iiwa_dnn/control/arms.py"
    const qp_layout_QPViews qp = schemes_program_program_views(arena, log.program, &base.sizes);
    #line 528 "iiwa_dnn/control/arms.py"
    if (is_twist && control_requests_falls_short(arena, &qp, request.velocity)) {
        #line 529 "iiwa_dnn/control/arms.py"
        arm->reasons.data[control_requests_Reason_SINGULAR] = 1.0;
    }
    #line 530 "iiwa_dnn/control/arms.py"
    control_arms_note_limits(arena, arm, &log);
    #line 531 "iiwa_dnn/control/arms.py"
    arena_leave(arena, &mark);
    return action;
}

/* Compute the command of a step, and advance the arm by it: the part after the kinematics.
 *
 * Args:
 *     plan: Layout of the step.
 *     memory: The arm's memory after `begin_step`, (k,); the command, and positions and time after
 *         it, are written to it.
 *     inputs: The inputs of the step.
 *     jacobian: `Kinematics.jacobian` at the commanded positions, (n, 6).
 *     placements: `Kinematics.placements` there, (frames, 12).
 *     data: The log of the control step, overwritten, (width,).
 *
 * Returns:
 *     The `Action` that was taken; `NONE`, without a log, if the positions are not known;
 *     `INVALID`, with a command of 0, if they are beyond `LARGEST`.
 *
 * iiwa_dnn/control/arms.py: finish_step */
static inline int64_t control_arms_finish_step(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory, const control_arms_ArmInput *inputs, Matrix jacobian, Matrix placements, Vector data)
{
    #line 428 "iiwa_dnn/control/arms.py"
    #line 443 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 444 "iiwa_dnn/control/arms.py"
    int64_t action = control_yielding_NONE;
    #line 445 "iiwa_dnn/control/arms.py"
    if ((int64_t)arm.at->answered != control_requests_Request_NONE) {
        #line 446 "iiwa_dnn/control/arms.py"
        action = control_arms_answer(arena, plan, &arm, inputs, jacobian, placements, data);
    }
    #line 447 "iiwa_dnn/control/arms.py"
    const control_state_MotionState own_1 = control_arms_motion_of(arena, plan, &arm);
    control_arms_advance(arena, &arm, &plan->settings, &own_1);
    #line 448 "iiwa_dnn/control/arms.py"
    return action;
}

/* Take a step of a shield; its command is then the last one of `motion_of` the arm.
 *
 * If a measured position is not finite, the arm brakes along the commanded positions.
 *
 * Returns:
 *     The first `Reason` of the step; `INVALID` if a stated period is not valid: nothing is then
 *     changed.
 *
 * iiwa_dnn/control/arms.py: step_arm */
static inline int64_t control_arms_step_arm(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory, const control_arms_ArmInput *inputs)
{
    const struct arena mark = *arena;
    #line 258 "iiwa_dnn/control/arms.py"
    #line 266 "iiwa_dnn/control/arms.py"
    if (!control_arms_begin_step(arena, plan, memory, inputs)) {
        #line 267 "iiwa_dnn/control/arms.py"
        arena_leave(arena, &mark);
        return control_cycle_INVALID;
    }
    #line 268 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 269 "iiwa_dnn/control/arms.py"
    const schemes_program_ProgramArrays base = plan->step.arrays;
    #line 270 "iiwa_dnn/control/arms.py"
    const Matrix jacobian = {(double *)arena_empty(arena, arm.positions.size0 * 6), arm.positions.size0, 6};
    #line 271 "iiwa_dnn/control/arms.py"
    const Matrix placements = {(double *)arena_empty(arena, base.placements.size0 * 12), base.placements.size0, 12};
    #line 272 "iiwa_dnn/control/arms.py"
    robot_kinematics_kernel_write_kinematics(arena, &plan->robot, arm.positions, jacobian, placements, base.inertia);
    #line 273 "iiwa_dnn/control/arms.py"
    const Vector data = {(double *)arena_empty(arena, plan->width), plan->width};
    #line 274 "iiwa_dnn/control/arms.py"
    control_arms_finish_step(arena, plan, memory, inputs, jacobian, placements, data);
    #line 275 "iiwa_dnn/control/arms.py"
    const int64_t own_result = control_arms_first_reason(arena, &arm);
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the distance of each pair [m].
 *
 * Args:
 *     constants: Constants of the scene, (k,).
 *     dof: Number of joints of the robot.
 *     placements: `Kinematics.placements`, (frames, 12).
 *     distances: The distances, (pairs,), overwritten.
 *
 * iiwa_dnn/schemes/scene.py: write_distances */
static inline void schemes_scene_write_distances(struct arena *arena, Vector constants, int64_t dof, Matrix placements, Vector distances)
{
    const struct arena mark = *arena;
    #line 462 "iiwa_dnn/schemes/scene.py"
    #line 470 "iiwa_dnn/schemes/scene.py"
    const schemes_scene_SceneViews scene = schemes_scene_scene_views(arena, constants, dof);
    #line 471 "iiwa_dnn/schemes/scene.py"
    const int64_t own_1 = scene.bodies.size0;
    const int64_t own_2 = 12;
    const Matrix placed = {(double *)arena_empty(arena, own_1 * own_2), own_1, own_2};
    #line 472 "iiwa_dnn/schemes/scene.py"
    schemes_scene_place_bodies(arena, &scene, placements, placed);
    #line 473 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0; k < distances.size0; k++) {
        #line 474 "iiwa_dnn/schemes/scene.py"
        distances.data[k] = schemes_scene_contact_of(arena, &scene, k, placed).distance;
    }
    arena_leave(arena, &mark);
}

/* Compute the `Margin` of an arm at the joint positions that its last command starts from.
 *
 * iiwa_dnn/control/arms.py: margin_of */
static inline double_2 control_arms_margin_of(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory)
{
    const struct arena mark = *arena;
    #line 606 "iiwa_dnn/control/arms.py"
    #line 607 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 608 "iiwa_dnn/control/arms.py"
    const Vector q = control_arms_motion_of(arena, plan, &arm).q;
    #line 609 "iiwa_dnn/control/arms.py"
    double joint = INFINITY;
    #line 610 "iiwa_dnn/control/arms.py"
    for (int64_t i = 0; i < q.size0; i++) {
        #line 611 "iiwa_dnn/control/arms.py"
        joint = double_min(joint, double_min(q.data[i] - plan->lower.data[i], plan->upper.data[i] - q.data[i]));
    }
    #line 612 "iiwa_dnn/control/arms.py"
    double distance = INFINITY;
    #line 613 "iiwa_dnn/control/arms.py"
    if (plan->scene >= 0) {
        #line 614 "iiwa_dnn/control/arms.py"
        const schemes_program_ProgramArrays base = plan->step.arrays;
        #line 615 "iiwa_dnn/control/arms.py"
        const Matrix jacobian = {(double *)arena_empty(arena, q.size0 * 6), q.size0, 6};
        #line 616 "iiwa_dnn/control/arms.py"
        const Matrix placements = {(double *)arena_empty(arena, base.placements.size0 * 12), base.placements.size0, 12};
        #line 617 "iiwa_dnn/control/arms.py"
        robot_kinematics_kernel_write_kinematics(arena, &plan->robot, q, jacobian, placements, base.inertia);
        #line 618 "iiwa_dnn/control/arms.py"
        const Vector own_1 = schemes_program_block_constants(arena, &base, plan->scene);
        const Vector constants = {(double *)arena_copy(arena, own_1.data, own_1.size0), own_1.size0};
        #line 619 "iiwa_dnn/control/arms.py"
        control_arms_place_obstacles(arena, plan, &arm, arm.at->time - arm.at->period, constants);
        #line 620 "iiwa_dnn/control/arms.py"
        const schemes_scene_SceneViews scene = schemes_scene_scene_views(arena, constants, q.size0);
        #line 621 "iiwa_dnn/control/arms.py"
        const int64_t own_2 = scene.pairs.size0;
        const Vector distances = {(double *)arena_empty(arena, own_2), own_2};
        #line 622 "iiwa_dnn/control/arms.py"
        schemes_scene_write_distances(arena, constants, q.size0, placements, distances);
        #line 623 "iiwa_dnn/control/arms.py"
        for (int64_t k = 0; k < distances.size0; k++) {
            #line 624 "iiwa_dnn/control/arms.py"
            distance = double_min(distance, distances.data[k] - scene.head.at->least);
        }
    }
    #line 625 "iiwa_dnn/control/arms.py"
    const double_2 own_result = {{joint, distance}};
    arena_leave(arena, &mark);
    return own_result;
}

/* Compute the time of the stopping motion from an arm's last command [s].
 *
 * iiwa_dnn/control/arms.py: stopping_time_of */
static inline double control_arms_stopping_time_of(struct arena *arena, const control_arms_ArmPlan *plan, Vector memory)
{
    #line 630 "iiwa_dnn/control/arms.py"
    #line 631 "iiwa_dnn/control/arms.py"
    const control_arms_ArmState arm = control_arms_arm_state(arena, plan, memory);
    #line 632 "iiwa_dnn/control/arms.py"
    const control_state_MotionState motion = control_arms_motion_of(arena, plan, &arm);
    #line 633 "iiwa_dnn/control/arms.py"
    const bool cubic = plan->step.yielding.cubic;
    #line 634 "iiwa_dnn/control/arms.py"
    const double dt = motion.at->spacing;
    #line 635 "iiwa_dnn/control/arms.py"
    const double periods = control_stopping_least_periods(arena, motion.last, motion.before, &plan->motion, dt, cubic, false);
    #line 636 "iiwa_dnn/control/arms.py"
    return dt * double_max(periods, qp_dense_largest_entry(arena, motion.last) > 0.0 ? 1.0 : 0.0);
}

/* Take a step of the arms from number `first` to the one before `last`.
 *
 * Args:
 *     plan: Layout of the step.
 *     memories: Memories of all N arms, (N, k).
 *     inputs: Inputs of all arms: the positions (N n,) and requests (N n,) or (N 6,) of one arm
 *         after those of another; `kind` does not count.
 *     kinds: `Request` of each arm's new request, (N,).
 *     first: Number of the first arm.
 *     last: Number after that of the last arm.
 *
 * iiwa_dnn/control/arms.py: step_arms */
static inline void control_arms_step_arms(struct arena *arena, const control_arms_ArmPlan *plan, Matrix memories, const control_arms_ArmInput *inputs, IntVector kinds, int64_t first, int64_t last)
{
    #line 643 "iiwa_dnn/control/arms.py"
    #line 654 "iiwa_dnn/control/arms.py"
    const int64_t n = plan->sizes.n;
    #line 655 "iiwa_dnn/control/arms.py"
    const int64_t width = int_quotient(inputs->request.size0, memories.size0);
    #line 656 "iiwa_dnn/control/arms.py"
    for (int64_t k = first; k < last; k++) {
        #line 657 "iiwa_dnn/control/arms.py"
        const Vector q = {inputs->q.data + k * n, (k + 1) * n - k * n};
        #line 658 "iiwa_dnn/control/arms.py"
        const Vector request = {inputs->request.data + k * width, (k + 1) * width - k * width};
        #line 659 "iiwa_dnn/control/arms.py"
        const control_arms_ArmInput own = {q, kinds.data[k], request, inputs->dt, inputs->elapsed};
        #line 660 "iiwa_dnn/control/arms.py"
        control_arms_step_arm(arena, plan, (Vector){memories.data + k * memories.size1, memories.size1}, &own);
    }
}

/* Add the cost of a request (`RequestCost`) to P (n, n) and q (n,).
 *
 * iiwa_dnn/control/requests.py: add_request */
static inline void control_requests_add_request(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    const struct arena mark = *arena;
    #line 134 "iiwa_dnn/control/requests.py"
    #line 135 "iiwa_dnn/control/requests.py"
    const control_requests_RequestConstants request = control_requests_RequestConstants_of(constants, int_max(0, (constants.size0 - (2)) / 1));
    #line 136 "iiwa_dnn/control/requests.py"
    const int64_t n = q.size0;
    #line 137 "iiwa_dnn/control/requests.py"
    for (int64_t i = 0; i < n; i++) {
        #line 138 "iiwa_dnn/control/requests.py"
        P.data[i * P.size1 + i] += request.at->is_twist != 0.0 ? control_requests_DAMPING * control_requests_DAMPING : 1.0;
        #line 139 "iiwa_dnn/control/requests.py"
        q.data[i] -= request.at->is_twist != 0.0 ? 0.0 : request.velocity.data[i];
    }
    #line 140 "iiwa_dnn/control/requests.py"
    if (!(request.at->is_twist != 0.0)) {
        #line 141 "iiwa_dnn/control/requests.py"
        arena_leave(arena, &mark);
        return;
    }
    #line 142 "iiwa_dnn/control/requests.py"
    const int64_t own_1 = 6;
    const Vector v = {request.velocity.data, own_1};
    #line 143 "iiwa_dnn/control/requests.py"
    const Matrix A = {(double *)arena_empty(arena, control_requests_TWIST * n), control_requests_TWIST, n};
    #line 144 "iiwa_dnn/control/requests.py"
    const double_3 point = references_rotations_triple(arena, robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)request.at->frame * step->placements.size1, step->placements.size1}).position);
    #line 145 "iiwa_dnn/control/requests.py"
    for (int64_t j = 0; j < n; j++) {
        #line 146 "iiwa_dnn/control/requests.py"
        const double support = step->support.data[(int64_t)request.at->frame * step->support.size1 + j];
        #line 147 "iiwa_dnn/control/requests.py"
        const double_3 linear = schemes_step_point_rate(arena, step->jacobian, j, point);
        #line 148 "iiwa_dnn/control/requests.py"
        const double_3 angular = references_rotations_triple(arena, robot_kinematics_Twist_of((Vector){step->jacobian.data + j * step->jacobian.size1, step->jacobian.size1}).angular);
        #line 149 "iiwa_dnn/control/requests.py"
        for (int64_t i = 0; i < 3; i++) {
            #line 150 "iiwa_dnn/control/requests.py"
            A.data[i * A.size1 + j] = support * linear.at[i];
            #line 151 "iiwa_dnn/control/requests.py"
            A.data[(3 + i) * A.size1 + j] = support * angular.at[i];
        }
    }
    #line 152 "iiwa_dnn/control/requests.py"
    double square = 0.0;
    #line 153 "iiwa_dnn/control/requests.py"
    for (int64_t k = 0; k < control_requests_TWIST; k++) {
        #line 154 "iiwa_dnn/control/requests.py"
        square += v.data[k] * v.data[k];
    }
    #line 155 "iiwa_dnn/control/requests.py"
    for (int64_t i = 0; i < n; i++) {
        #line 156 "iiwa_dnn/control/requests.py"
        double along = 0.0;
        #line 157 "iiwa_dnn/control/requests.py"
        for (int64_t k = 0; k < control_requests_TWIST; k++) {
            #line 158 "iiwa_dnn/control/requests.py"
            along += A.data[k * A.size1 + i] * v.data[k];
        }
        #line 159 "iiwa_dnn/control/requests.py"
        const double fraction = square > 0.0 ? (1.0 - control_requests_SIDEWAYS) * along / square : 0.0;
        #line 160 "iiwa_dnn/control/requests.py"
        for (int64_t k = 0; k < control_requests_TWIST; k++) {
            #line 161 "iiwa_dnn/control/requests.py"
            A.data[k * A.size1 + i] = control_requests_SIDEWAYS * A.data[k * A.size1 + i] + fraction * v.data[k];
        }
    }
    #line 162 "iiwa_dnn/control/requests.py"
    schemes_program_add_soft(arena, P, q, A, v, 1.0);
    arena_leave(arena, &mark);
}

/* Call a network's function by its address, to write rho ds/dt at a state into `rates`.
 *
 * State and rates are (size,), the network's constants are (k,). */
static inline void networks_base_enter_rates(struct arena *arena, int64_t address, const qp_layout_QPViews *qp, Vector constants, Vector state, Vector rates)
{
    if (address > 0) return ((void (*)(struct arena *, const qp_layout_QPViews *, Vector , Vector , Vector ))(intptr_t)address)(arena, qp, constants, state, rates);
    return ((void (*)(double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t))(intptr_t)-address)(qp->P.data, qp->P.size0, qp->P.size1, qp->q.data, qp->q.size0, qp->G.data, qp->G.size0, qp->G.size1, qp->h.data, qp->h.size0, qp->A.data, qp->A.size0, qp->A.size1, qp->b.data, qp->b.size0, qp->lb.data, qp->lb.size0, qp->ub.data, qp->ub.size0, constants.data, constants.size0, state.data, state.size0, rates.data, rates.size0);
}

/* Make the entries (i, k) and (k, i) of a symmetric matrix zero by a Jacobi rotation.
 *
 * iiwa_dnn/qp/dense.py: _rotate */
static inline void qp_dense_rotate(struct arena *arena, Matrix K, int64_t i, int64_t k)
{
    (void)arena;
    #line 179 "iiwa_dnn/qp/dense.py"
    #line 180 "iiwa_dnn/qp/dense.py"
    const double theta = 0.5 * (K.data[i * K.size1 + i] - K.data[k * K.size1 + k]) / K.data[i * K.size1 + k];
    #line 181 "iiwa_dnn/qp/dense.py"
    const double t = copysign(1.0 / (fabs(theta) + sqrt(theta * theta + 1.0)), theta);
    #line 182 "iiwa_dnn/qp/dense.py"
    const double c = 1.0 / sqrt(t * t + 1.0);
    #line 183 "iiwa_dnn/qp/dense.py"
    const double s = t * c;
    #line 184 "iiwa_dnn/qp/dense.py"
    for (int64_t j = 0; j < K.size0; j++) {
        #line 185 "iiwa_dnn/qp/dense.py"
        const double one = K.data[j * K.size1 + k];
        #line 186 "iiwa_dnn/qp/dense.py"
        K.data[j * K.size1 + k] = c * one - s * K.data[j * K.size1 + i];
        #line 187 "iiwa_dnn/qp/dense.py"
        K.data[j * K.size1 + i] = s * one + c * K.data[j * K.size1 + i];
    }
    #line 188 "iiwa_dnn/qp/dense.py"
    for (int64_t j = 0; j < K.size0; j++) {
        #line 189 "iiwa_dnn/qp/dense.py"
        const double one = K.data[k * K.size1 + j];
        #line 190 "iiwa_dnn/qp/dense.py"
        K.data[k * K.size1 + j] = c * one - s * K.data[i * K.size1 + j];
        #line 191 "iiwa_dnn/qp/dense.py"
        K.data[i * K.size1 + j] = s * one + c * K.data[i * K.size1 + j];
    }
}

/* Compute the smallest and the largest eigenvalue of K (n, n), which is overwritten.
 *
 * Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5) on
 * both halves of K: for seven joints one call of LAPACK costs more than all of them.
 *
 * iiwa_dnn/qp/dense.py: extreme_eigenvalues */
static inline double_2 qp_dense_extreme_eigenvalues(struct arena *arena, Matrix K)
{
    #line 157 "iiwa_dnn/qp/dense.py"
    #line 162 "iiwa_dnn/qp/dense.py"
    const int64_t n = K.size0;
    #line 163 "iiwa_dnn/qp/dense.py"
    for (int64_t _ = 0; _ < 20; _++) {
        #line 164 "iiwa_dnn/qp/dense.py"
        for (int64_t i = 1; i < n; i++) {
            #line 165 "iiwa_dnn/qp/dense.py"
            for (int64_t k = 0; k < i; k++) {
                #line 167 "iiwa_dnn/qp/dense.py"
                if (fabs(K.data[i * K.size1 + k]) > 1e-13 * (fabs(K.data[i * K.size1 + i]) + fabs(K.data[k * K.size1 + k]))) {
                    #line 168 "iiwa_dnn/qp/dense.py"
                    qp_dense_rotate(arena, K, i, k);
                }
            }
        }
    }
    #line 169 "iiwa_dnn/qp/dense.py"
    double smallest = INFINITY;
    #line 170 "iiwa_dnn/qp/dense.py"
    double largest = -INFINITY;
    #line 171 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < n; i++) {
        #line 172 "iiwa_dnn/qp/dense.py"
        smallest = double_min(smallest, K.data[i * K.size1 + i]);
        #line 173 "iiwa_dnn/qp/dense.py"
        largest = qp_layout_larger(arena, largest, K.data[i * K.size1 + i]);
    }
    #line 174 "iiwa_dnn/qp/dense.py"
    return (double_2){{smallest, largest}};
}

/* Compute the bound of `ProjectionNetwork.stable_step` for an active set (p + m + 2n,).
 *
 * iiwa_dnn/networks/projection.py: stable_step */
static inline double networks_projection_stable_step(struct arena *arena, const qp_layout_QPViews *qp, Vector active)
{
    const struct arena mark = *arena;
    #line 171 "iiwa_dnn/networks/projection.py"
    #line 172 "iiwa_dnn/networks/projection.py"
    const int64_t n = qp->q.size0;
    #line 173 "iiwa_dnn/networks/projection.py"
    const int64_t p = qp->b.size0;
    #line 174 "iiwa_dnn/networks/projection.py"
    const int64_t first = p + qp->h.size0;
    #line 175 "iiwa_dnn/networks/projection.py"
    const Matrix K = {(double *)arena_zeros(arena, n * n), n, n};
    #line 176 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0; j < p; j++) {
        #line 177 "iiwa_dnn/networks/projection.py"
        qp_dense_add_outer(arena, K, active.data[j], (Vector){qp->A.data + j * qp->A.size1, qp->A.size1}, 0);
    }
    #line 178 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = qp->h.size0; j < end_j; j++) {
        #line 179 "iiwa_dnn/networks/projection.py"
        qp_dense_add_outer(arena, K, active.data[p + j], (Vector){qp->G.data + j * qp->G.size1, qp->G.size1}, 0);
    }
    #line 180 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0; i < n; i++) {
        #line 181 "iiwa_dnn/networks/projection.py"
        K.data[i * K.size1 + i] += active.data[first + i] + active.data[first + n + i];
        #line 182 "iiwa_dnn/networks/projection.py"
        for (int64_t k = 0; k < i; k++) {
            #line 183 "iiwa_dnn/networks/projection.py"
            K.data[i * K.size1 + k] = K.data[k * K.size1 + i];
        }
    }
    #line 184 "iiwa_dnn/networks/projection.py"
    const double_2 own_1 = qp_dense_extreme_eigenvalues(arena, K);
    const double coupling = own_1.at[1];
    #line 185 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0; i < n; i++) {
        #line 186 "iiwa_dnn/networks/projection.py"
        for (int64_t k = 0; k < n; k++) {
            #line 187 "iiwa_dnn/networks/projection.py"
            K.data[i * K.size1 + k] = qp->P.data[i * qp->P.size1 + k];
        }
    }
    #line 188 "iiwa_dnn/networks/projection.py"
    const double_2 own_2 = qp_dense_extreme_eigenvalues(arena, K);
    const double smallest = own_2.at[0];
    const double largest = own_2.at[1];
    #line 190 "iiwa_dnn/networks/projection.py"
    const double bound = 2.0 / double_max(largest, 1.0);
    #line 191 "iiwa_dnn/networks/projection.py"
    const double own_result = coupling > 0.0 ? double_min(bound, double_max(smallest, 0.0) / coupling) : bound;
    arena_leave(arena, &mark);
    return own_result;
}

/* Advance a network by a time with explicit steps, as a function of type `enter_answer`.
 *
 * The state (size,) is advanced in place, and its point (2n + m + p,) is written.
 *
 * Returns:
 *     Sub-steps, 0 if none are stable, or more than `MOST` needed; time [rho]; and the residuals
 *     of the point.
 *
 * iiwa_dnn/networks/integrators/explicit.py: advance_explicitly */
static inline double_5 networks_integrators_explicit_advance_explicitly(struct arena *arena, const qp_layout_QPViews *qp, int64_t rates, const networks_integrators_base_AnswerSettings *settings, Vector state, Vector point)
{
    const struct arena mark = *arena;
    #line 78 "iiwa_dnn/networks/integrators/explicit.py"
    #line 86 "iiwa_dnn/networks/integrators/explicit.py"
    const double duration = settings->at->duration;
    #line 87 "iiwa_dnn/networks/integrators/explicit.py"
    int64_t count = (int64_t)settings->at->substeps;
    #line 88 "iiwa_dnn/networks/integrators/explicit.py"
    const Vector values = {(double *)arena_empty(arena, state.size0), state.size0};
    #line 89 "iiwa_dnn/networks/integrators/explicit.py"
    if (count == 0) {
        #line 90 "iiwa_dnn/networks/integrators/explicit.py"
        const Vector active = {(double *)arena_empty(arena, state.size0 - qp->q.size0), state.size0 - qp->q.size0};
        #line 91 "iiwa_dnn/networks/integrators/explicit.py"
        networks_base_enter_rates(arena, rates, qp, settings->network, state, values);
        #line 92 "iiwa_dnn/networks/integrators/explicit.py"
        networks_projection_mark_active(arena, qp, state, values, active);
        #line 93 "iiwa_dnn/networks/integrators/explicit.py"
        const double stable = networks_integrators_explicit_SAFETY * networks_projection_stable_step(arena, qp, active);
        #line 94 "iiwa_dnn/networks/integrators/explicit.py"
        if (!(stable > 0.0 && duration <= (double)networks_integrators_explicit_MOST * stable)) {
            #line 95 "iiwa_dnn/networks/integrators/explicit.py"
            const double_5 own_result = {{0.0, 0.0, INFINITY, INFINITY, INFINITY}};
            arena_leave(arena, &mark);
            return own_result;
        }
        #line 96 "iiwa_dnn/networks/integrators/explicit.py"
        count = int_max(1, int_of(ceil(duration / stable)));
    }
    #line 97 "iiwa_dnn/networks/integrators/explicit.py"
    const double step = duration / (double)count;
    #line 98 "iiwa_dnn/networks/integrators/explicit.py"
    for (int64_t _ = 0; _ < count; _++) {
        #line 99 "iiwa_dnn/networks/integrators/explicit.py"
        networks_base_enter_rates(arena, rates, qp, settings->network, state, values);
        #line 100 "iiwa_dnn/networks/integrators/explicit.py"
        for (int64_t i = 0; i < state.size0; i++) {
            #line 101 "iiwa_dnn/networks/integrators/explicit.py"
            state.data[i] += step * values.data[i];
        }
    }
    #line 102 "iiwa_dnn/networks/integrators/explicit.py"
    const double_3 own_1 = qp_residuals_kkt_point(arena, qp, state, point);
    const double primal = own_1.at[0];
    const double dual = own_1.at[1];
    const double gap = own_1.at[2];
    #line 103 "iiwa_dnn/networks/integrators/explicit.py"
    const double_5 own_result = {{(double)count, duration, primal, dual, gap}};
    arena_leave(arena, &mark);
    return own_result;
}

/* Advance the projection network, without its primal projection, by one backward Euler step.
 *
 * Args:
 *     data: The program, `QP.data`.
 *     n: Number of variables.
 *     m: Number of inequality rows.
 *     p: Number of equality rows.
 *     s: State of the network, (3n + m + p,), advanced in place.
 *     step: Length of the step [rho].
 *
 * Returns:
 *     Number of linear solves; 0, with a state of NaN, if a matrix is not positive definite.
 *
 * iiwa_dnn/networks/integrators/implicit.py: step_program */
static inline int64_t networks_integrators_implicit_step_program(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector s, double step)
{
    const struct arena mark = *arena;
    #line 113 "iiwa_dnn/networks/integrators/implicit.py"
    #line 126 "iiwa_dnn/networks/integrators/implicit.py"
    const int64_t rows = s.size0 - n;
    #line 127 "iiwa_dnn/networks/integrators/implicit.py"
    const qp_layout_QPViews qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 128 "iiwa_dnn/networks/integrators/implicit.py"
    const Vector spans = {(double *)arena_empty(arena, 2 * m), 2 * m};
    #line 129 "iiwa_dnn/networks/integrators/implicit.py"
    networks_projection_write_spans(arena, &qp, spans);
    #line 130 "iiwa_dnn/networks/integrators/implicit.py"
    const networks_integrators_implicit_steps_Condensed matrix = {{(double *)arena_empty(arena, rows), rows}, {(double *)arena_zeros(arena, m + p), m + p}, {(double *)arena_zeros(arena, n * n), n, n}, {(double *)arena_empty(arena, n * n), n, n}, {(double *)arena_empty(arena, rows), rows}, spans};
    #line 133 "iiwa_dnn/networks/integrators/implicit.py"
    const Vector new_ = {(double *)arena_copy(arena, s.data, s.size0), s.size0};
    #line 134 "iiwa_dnn/networks/integrators/implicit.py"
    const int64_t linear_solves = networks_integrators_implicit_steps_backward_euler(arena, &qp, s, step, new_, 1e-12, 2 * networks_integrators_implicit_MAX_NEWTON, &matrix);
    #line 135 "iiwa_dnn/networks/integrators/implicit.py"
    if (linear_solves < 0) {
        #line 136 "iiwa_dnn/networks/integrators/implicit.py"
        for (int64_t own_k = 0; own_k < new_.size0; own_k++) {
            new_.data[own_k] = NAN;
        }
    }
    #line 137 "iiwa_dnn/networks/integrators/implicit.py"
    qp_layout_copied(arena, s, new_);
    #line 138 "iiwa_dnn/networks/integrators/implicit.py"
    const int64_t own_result = int_max(linear_solves, 0);
    arena_leave(arena, &mark);
    return own_result;
}

/* Solve by `solve_within`, as a function of type `enter_answer` for projection networks.
 *
 * iiwa_dnn/networks/integrators/implicit.py: solve */
static inline double_5 networks_integrators_implicit_solve(struct arena *arena, const qp_layout_QPViews *qp, int64_t rates, const networks_integrators_base_AnswerSettings *settings, Vector s, Vector point)
{
    (void)rates;
    #line 143 "iiwa_dnn/networks/integrators/implicit.py"
    #line 144 "iiwa_dnn/networks/integrators/implicit.py"
    return networks_integrators_implicit_solve_within(arena, qp, settings->at->tolerance, int_of(settings->at->budget), s, point);
}

/* Solve by `solve_within` for a program's flat array, `QP.data`, of sizes (n, m, p).
 *
 * iiwa_dnn/networks/integrators/implicit.py: solve_program */
static inline double_5 networks_integrators_implicit_solve_program(struct arena *arena, Vector data, int_3 sizes, Vector s, Vector point, double tol, int64_t max_linear_solves)
{
    #line 238 "iiwa_dnn/networks/integrators/implicit.py"
    #line 239 "iiwa_dnn/networks/integrators/implicit.py"
    const int_3 own_1 = sizes;
    const int64_t n = own_1.at[0];
    const int64_t m = own_1.at[1];
    const int64_t p = own_1.at[2];
    #line 240 "iiwa_dnn/networks/integrators/implicit.py"
    const qp_layout_QPViews own_2 = qp_layout_qp_views(arena, data, n, m, p);
    return networks_integrators_implicit_solve_within(arena, &own_2, tol, max_linear_solves, s, point);
}

/* Check the largest entry of a row, which `holds` where that is zero.
 *
 * iiwa_dnn/networks/integrators/scaling.py: _is_ordinary_size */
static inline bool networks_integrators_scaling_is_ordinary_size(struct arena *arena, double largest, bool holds)
{
    (void)arena;
    #line 61 "iiwa_dnn/networks/integrators/scaling.py"
    #line 62 "iiwa_dnn/networks/integrators/scaling.py"
    return (qp_residuals_SLIGHT <= largest && largest <= networks_integrators_scaling_LARGE) || (largest == 0.0 && holds);
}

/* Check that each row of `QP.data` has a largest entry from `SLIGHT` to `LARGE`.
 *
 * A row of zeros that holds is ordinary too. The cost has a largest entry from `SLIGHT` on, or
 * none but zeros; P is symmetric to the bit.
 *
 * iiwa_dnn/networks/integrators/scaling.py: is_ordinary */
static inline bool networks_integrators_scaling_is_ordinary(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p)
{
    #line 39 "iiwa_dnn/networks/integrators/scaling.py"
    #line 44 "iiwa_dnn/networks/integrators/scaling.py"
    const qp_layout_QPViews qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 45 "iiwa_dnn/networks/integrators/scaling.py"
    for (int64_t j = 0; j < p; j++) {
        #line 46 "iiwa_dnn/networks/integrators/scaling.py"
        if (!networks_integrators_scaling_is_ordinary_size(arena, qp_dense_largest_entry(arena, (Vector){qp.A.data + j * qp.A.size1, qp.A.size1}), qp.b.data[j] == 0.0)) {
            #line 47 "iiwa_dnn/networks/integrators/scaling.py"
            return false;
        }
    }
    #line 48 "iiwa_dnn/networks/integrators/scaling.py"
    for (int64_t j = 0; j < m; j++) {
        #line 49 "iiwa_dnn/networks/integrators/scaling.py"
        if (!networks_integrators_scaling_is_ordinary_size(arena, qp_dense_largest_entry(arena, (Vector){qp.G.data + j * qp.G.size1, qp.G.size1}), qp.h.data[j] >= 0.0)) {
            #line 50 "iiwa_dnn/networks/integrators/scaling.py"
            return false;
        }
    }
    #line 51 "iiwa_dnn/networks/integrators/scaling.py"
    for (int64_t i = 0; i < n; i++) {
        #line 52 "iiwa_dnn/networks/integrators/scaling.py"
        for (int64_t k = 0; k < i; k++) {
            #line 53 "iiwa_dnn/networks/integrators/scaling.py"
            if (qp.P.data[i * qp.P.size1 + k] != qp.P.data[k * qp.P.size1 + i]) {
                #line 54 "iiwa_dnn/networks/integrators/scaling.py"
                return false;
            }
        }
    }
    #line 55 "iiwa_dnn/networks/integrators/scaling.py"
    const double cost = qp_residuals_cost_size(arena, &qp);
    #line 56 "iiwa_dnn/networks/integrators/scaling.py"
    return cost >= qp_residuals_SLIGHT || cost == 0.0;
}

/* Return the power of two nearest to a size in the logarithm; 1 if it is 0.
 *
 * iiwa_dnn/networks/integrators/scaling.py: power_of_two */
static inline double networks_integrators_scaling_power_of_two(struct arena *arena, double size)
{
    (void)arena;
    #line 167 "iiwa_dnn/networks/integrators/scaling.py"
    #line 168 "iiwa_dnn/networks/integrators/scaling.py"
    double power = 1.0;
    #line 169 "iiwa_dnn/networks/integrators/scaling.py"
    while (power * networks_integrators_scaling_SQRT2 < size) {
        #line 170 "iiwa_dnn/networks/integrators/scaling.py"
        power *= 2.0;
    }
    #line 171 "iiwa_dnn/networks/integrators/scaling.py"
    while (size > 0.0 && power > size * networks_integrators_scaling_SQRT2) {
        #line 172 "iiwa_dnn/networks/integrators/scaling.py"
        power *= 0.5;
    }
    #line 173 "iiwa_dnn/networks/integrators/scaling.py"
    return power;
}

/* Balance a symmetric matrix: rows and columns in the units found have entries of at most 1.
 *
 * A row of zeros gets the unit with which its limit is 1: if it cannot hold, its multiplier is
 * seen to grow. Units are rounded to powers of two.
 *
 * Args:
 *     kkt: The matrix, whose lower half is read, (k, k).
 *     limits: Limits of the rows, (k,).
 *     rounds: Rounds, each of which takes the square root of what is left.
 *     units: Units, (k,), ones at first, overwritten.
 *
 * Source: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
 * Rutherford Appleton Laboratory, RAL-TR-2001-034.
 *
 * iiwa_dnn/networks/integrators/scaling.py: balance */
static inline void networks_integrators_scaling_balance(struct arena *arena, Matrix kkt, Vector limits, int64_t rounds, Vector units)
{
    const struct arena mark = *arena;
    #line 132 "iiwa_dnn/networks/integrators/scaling.py"
    #line 146 "iiwa_dnn/networks/integrators/scaling.py"
    const Vector sizes = {(double *)arena_empty(arena, units.size0), units.size0};
    #line 147 "iiwa_dnn/networks/integrators/scaling.py"
    for (int64_t _ = 0; _ < rounds; _++) {
        #line 148 "iiwa_dnn/networks/integrators/scaling.py"
        for (int64_t own_k = 0; own_k < sizes.size0; own_k++) {
            sizes.data[own_k] = 0.0;
        }
        #line 149 "iiwa_dnn/networks/integrators/scaling.py"
        for (int64_t i = 0; i < units.size0; i++) {
            #line 150 "iiwa_dnn/networks/integrators/scaling.py"
            for (int64_t k = 0; k < i + 1; k++) {
                #line 151 "iiwa_dnn/networks/integrators/scaling.py"
                if (kkt.data[i * kkt.size1 + k] != 0.0) {
                    #line 152 "iiwa_dnn/networks/integrators/scaling.py"
                    sizes.data[i] = double_max(sizes.data[i], fabs(kkt.data[i * kkt.size1 + k]) * units.data[k]);
                    #line 153 "iiwa_dnn/networks/integrators/scaling.py"
                    sizes.data[k] = double_max(sizes.data[k], fabs(kkt.data[i * kkt.size1 + k]) * units.data[i]);
                }
            }
        }
        #line 154 "iiwa_dnn/networks/integrators/scaling.py"
        for (int64_t i = 0; i < units.size0; i++) {
            #line 155 "iiwa_dnn/networks/integrators/scaling.py"
            const double size = units.data[i] * sizes.data[i];
            #line 156 "iiwa_dnn/networks/integrators/scaling.py"
            const double limit = fabs(limits.data[i]);
            #line 157 "iiwa_dnn/networks/integrators/scaling.py"
            if (size > 0.0) {
                #line 158 "iiwa_dnn/networks/integrators/scaling.py"
                units.data[i] /= sqrt(size);
            } else {
                #line 159 "iiwa_dnn/networks/integrators/scaling.py"
                if (limit > 0.0 && limit < INFINITY) {
                    #line 160 "iiwa_dnn/networks/integrators/scaling.py"
                    units.data[i] = 1.0 / limit;
                }
            }
        }
    }
    #line 161 "iiwa_dnn/networks/integrators/scaling.py"
    for (int64_t i = 0; i < units.size0; i++) {
        #line 162 "iiwa_dnn/networks/integrators/scaling.py"
        units.data[i] = networks_integrators_scaling_power_of_two(arena, units.data[i]);
    }
    arena_leave(arena, &mark);
}

/* Write rho ds/dt of `ProjectionNetwork` at a state s, both (size,), into `rates`.
 *
 * iiwa_dnn/networks/projection.py: projection_rates */
static inline void networks_projection_projection_rates(struct arena *arena, const qp_layout_QPViews *qp, Vector constants, Vector state, Vector rates)
{
    const struct arena mark = *arena;
    #line 160 "iiwa_dnn/networks/projection.py"
    #line 161 "iiwa_dnn/networks/projection.py"
    const Vector spans = {(double *)arena_empty(arena, 2 * qp->h.size0), 2 * qp->h.size0};
    #line 162 "iiwa_dnn/networks/projection.py"
    networks_projection_write_spans(arena, qp, spans);
    #line 163 "iiwa_dnn/networks/projection.py"
    networks_projection_unprojected_rates(arena, qp, spans, state, rates);
    #line 164 "iiwa_dnn/networks/projection.py"
    if (networks_projection_ProjectionConstants_of(constants).at->projects != 0.0) {
        #line 165 "iiwa_dnn/networks/projection.py"
        for (int64_t i = 0, end_i = qp->q.size0; i < end_i; i++) {
            #line 166 "iiwa_dnn/networks/projection.py"
            rates.data[i] = double_min(double_max(state.data[i] + rates.data[i], qp->lb.data[i]), qp->ub.data[i]) - state.data[i];
        }
    }
    arena_leave(arena, &mark);
}

/* Write the product of rows (k, n) and a vector (n,) in twice the precision, (k,).
 *
 * `rounding` (k,) becomes a bound on the error: 0 where no digit was lost, NaN where a term
 * overflows.
 *
 * iiwa_dnn/qp/certificates.py: dot_twice */
static inline void qp_certificates_dot_twice(struct arena *arena, Matrix rows, Vector vector, Vector products, Vector rounding)
{
    (void)arena;
    #line 200 "iiwa_dnn/qp/certificates.py"
    #line 205 "iiwa_dnn/qp/certificates.py"
    for (int64_t j = 0; j < rows.size0; j++) {
        #line 206 "iiwa_dnn/qp/certificates.py"
        double total = 0.0;
        #line 207 "iiwa_dnn/qp/certificates.py"
        double lost = 0.0;
        #line 208 "iiwa_dnn/qp/certificates.py"
        double loss = 0.0;
        #line 209 "iiwa_dnn/qp/certificates.py"
        for (int64_t i = 0; i < rows.size1; i++) {
            #line 210 "iiwa_dnn/qp/certificates.py"
            const double a = rows.data[j * rows.size1 + i];
            #line 211 "iiwa_dnn/qp/certificates.py"
            const double b = vector.data[i];
            #line 212 "iiwa_dnn/qp/certificates.py"
            const double term = a * b;
            #line 213 "iiwa_dnn/qp/certificates.py"
            const double a_high = qp_certificates_SPLIT * a - (qp_certificates_SPLIT * a - a);
            #line 214 "iiwa_dnn/qp/certificates.py"
            const double b_high = qp_certificates_SPLIT * b - (qp_certificates_SPLIT * b - b);
            #line 215 "iiwa_dnn/qp/certificates.py"
            double rest = term - a_high * b_high - (a - a_high) * b_high - a_high * (b - b_high);
            #line 216 "iiwa_dnn/qp/certificates.py"
            rest = (a - a_high) * (b - b_high) - rest;
            #line 217 "iiwa_dnn/qp/certificates.py"
            const double added = total + term - total;
            #line 218 "iiwa_dnn/qp/certificates.py"
            rest += total - (total + term - added) + (term - added);
            #line 219 "iiwa_dnn/qp/certificates.py"
            total += term;
            #line 220 "iiwa_dnn/qp/certificates.py"
            lost += rest;
            #line 221 "iiwa_dnn/qp/certificates.py"
            loss += fabs(rest);
            #line 222 "iiwa_dnn/qp/certificates.py"
            if (fabs(term) < qp_certificates_UNDERFLOW && a != 0.0 && b != 0.0) {
                #line 223 "iiwa_dnn/qp/certificates.py"
                loss += qp_certificates_TINY;
            }
        }
        #line 224 "iiwa_dnn/qp/certificates.py"
        products.data[j] = total + lost;
        #line 225 "iiwa_dnn/qp/certificates.py"
        const double bound = qp_certificates_EPS * (fabs(products.data[j]) + 2.0 * (double)rows.size1 * loss);
        #line 226 "iiwa_dnn/qp/certificates.py"
        rounding.data[j] = loss != 0.0 ? bound : 0.0;
    }
}

/* Check that P (n, n) is symmetric, up to `ASYMMETRY` and rounding.
 *
 * Each pair of entries may differ by `ASYMMETRY` sqrt(P_ii P_jj) plus n `ROUNDING` times the
 * largest absolute entry of P, which is given.
 *
 * iiwa_dnn/qp/dense.py: is_symmetric */
static inline bool qp_dense_is_symmetric(struct arena *arena, Matrix P, double largest)
{
    (void)arena;
    #line 196 "iiwa_dnn/qp/dense.py"
    #line 201 "iiwa_dnn/qp/dense.py"
    const double rounding = qp_dense_ROUNDING * (double)P.size0 * largest;
    #line 202 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < P.size0; i++) {
        #line 203 "iiwa_dnn/qp/dense.py"
        for (int64_t k = 0; k < i; k++) {
            #line 204 "iiwa_dnn/qp/dense.py"
            const double asymmetry = fabs(P.data[i * P.size1 + k] - P.data[k * P.size1 + i]);
            #line 205 "iiwa_dnn/qp/dense.py"
            if (!(asymmetry <= rounding)) {
                #line 206 "iiwa_dnn/qp/dense.py"
                const double size = sqrt(double_max(P.data[i * P.size1 + i], 0.0)) * sqrt(double_max(P.data[k * P.size1 + k], 0.0));
                #line 207 "iiwa_dnn/qp/dense.py"
                if (!(asymmetry <= qp_dense_ASYMMETRY * size + rounding)) {
                    #line 208 "iiwa_dnn/qp/dense.py"
                    return false;
                }
            }
        }
    }
    #line 209 "iiwa_dnn/qp/dense.py"
    return true;
}

/* Replace P (n, n) by its symmetric part if `is_symmetric`; leave any other P as it is.
 *
 * iiwa_dnn/qp/dense.py: symmetrize */
static inline void qp_dense_symmetrize(struct arena *arena, Matrix P)
{
    #line 214 "iiwa_dnn/qp/dense.py"
    #line 215 "iiwa_dnn/qp/dense.py"
    if (qp_dense_is_symmetric(arena, P, qp_dense_largest_entry(arena, (Vector){P.data, P.size0 * P.size1}))) {
        #line 216 "iiwa_dnn/qp/dense.py"
        for (int64_t i = 0; i < P.size0; i++) {
            #line 217 "iiwa_dnn/qp/dense.py"
            for (int64_t k = 0; k < i; k++) {
                #line 218 "iiwa_dnn/qp/dense.py"
                if (P.data[i * P.size1 + k] != P.data[k * P.size1 + i]) {
                    #line 219 "iiwa_dnn/qp/dense.py"
                    P.data[i * P.size1 + k] = 0.5 * P.data[i * P.size1 + k] + 0.5 * P.data[k * P.size1 + i];
                    #line 220 "iiwa_dnn/qp/dense.py"
                    P.data[k * P.size1 + i] = P.data[i * P.size1 + k];
                }
            }
        }
    }
}

/* Check that P (n, n) `is_symmetric` and positive semidefinite, up to rounding.
 *
 * Eigenvalues of the symmetric part of P may be below zero by n `ROUNDING` times its largest
 * absolute entry. K (n, n) is scratch.
 *
 * iiwa_dnn/qp/dense.py: is_convex */
static inline bool qp_dense_is_convex(struct arena *arena, Matrix P, Matrix K)
{
    #line 225 "iiwa_dnn/qp/dense.py"
    #line 230 "iiwa_dnn/qp/dense.py"
    const double largest = qp_dense_largest_entry(arena, (Vector){P.data, P.size0 * P.size1});
    #line 231 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < P.size0; i++) {
        #line 232 "iiwa_dnn/qp/dense.py"
        for (int64_t k = i; k < P.size0; k++) {
            #line 233 "iiwa_dnn/qp/dense.py"
            K.data[i * K.size1 + k] = 0.5 * (P.data[i * P.size1 + k] + P.data[k * P.size1 + i]);
        }
    }
    #line 234 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0; i < P.size0; i++) {
        #line 235 "iiwa_dnn/qp/dense.py"
        K.data[i * K.size1 + i] += qp_dense_ROUNDING * (double)P.size0 * largest + 1e-300;
    }
    #line 236 "iiwa_dnn/qp/dense.py"
    return qp_dense_is_symmetric(arena, P, largest) && qp_dense_cholesky_factor(arena, K);
}

/* Copy the fields of a program into its flat array (size,), and `symmetrize` P there.
 *
 * Returns:
 *     False if their shapes do not fit one another.
 *
 * iiwa_dnn/qp/program.py: pack */
static inline bool qp_program_pack(struct arena *arena, const qp_layout_QPViews *fields, Vector data)
{
    #line 266 "iiwa_dnn/qp/program.py"
    #line 271 "iiwa_dnn/qp/program.py"
    const int64_t n = fields->q.size0;
    #line 272 "iiwa_dnn/qp/program.py"
    const int64_t m = fields->h.size0;
    #line 273 "iiwa_dnn/qp/program.py"
    const int64_t p = fields->b.size0;
    #line 274 "iiwa_dnn/qp/program.py"
    const bool are_rows = fields->P.size0 == n && fields->G.size0 == m && fields->A.size0 == p;
    #line 275 "iiwa_dnn/qp/program.py"
    const bool are_columns = fields->P.size1 == n && fields->G.size1 == n && fields->A.size1 == n;
    #line 276 "iiwa_dnn/qp/program.py"
    const bool are_bounds = fields->lb.size0 == n && fields->ub.size0 == n;
    #line 277 "iiwa_dnn/qp/program.py"
    if (n == 0 || !(are_rows && are_columns && are_bounds)) {
        #line 278 "iiwa_dnn/qp/program.py"
        return false;
    }
    #line 279 "iiwa_dnn/qp/program.py"
    const qp_layout_QPViews qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 280 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, data, (Vector){fields->P.data, n * n});
    #line 281 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, qp.q, fields->q);
    #line 282 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, (Vector){qp.G.data, m * n}, (Vector){fields->G.data, m * n});
    #line 283 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, qp.h, fields->h);
    #line 284 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, (Vector){qp.A.data, p * n}, (Vector){fields->A.data, p * n});
    #line 285 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, qp.b, fields->b);
    #line 286 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, qp.lb, fields->lb);
    #line 287 "iiwa_dnn/qp/program.py"
    qp_layout_copied(arena, qp.ub, fields->ub);
    #line 288 "iiwa_dnn/qp/program.py"
    qp_dense_symmetrize(arena, qp.P);
    #line 289 "iiwa_dnn/qp/program.py"
    return true;
}

/* Check that `QP.check_numbers` would find nothing, in one pass over the numbers.
 *
 * iiwa_dnn/qp/program.py: has_numbers */
static inline bool qp_program_has_numbers(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p)
{
    #line 294 "iiwa_dnn/qp/program.py"
    #line 295 "iiwa_dnn/qp/program.py"
    const int_4 own_1 = qp_layout_offsets(arena, n, m, p);
    const int64_t at_A = own_1.at[2];
    const int64_t at_lb = own_1.at[3];
    #line 296 "iiwa_dnn/qp/program.py"
    bool fits = qp_dense_all_finite(arena, data, 0, at_A - m) && qp_dense_all_finite(arena, data, at_A, at_lb);
    #line 297 "iiwa_dnn/qp/program.py"
    const qp_layout_QPViews qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 298 "iiwa_dnn/qp/program.py"
    for (int64_t j = 0; j < m; j++) {
        #line 299 "iiwa_dnn/qp/program.py"
        fits = fits && qp.h.data[j] > -INFINITY;
    }
    #line 300 "iiwa_dnn/qp/program.py"
    for (int64_t i = 0; i < n; i++) {
        #line 301 "iiwa_dnn/qp/program.py"
        fits = fits && qp.lb.data[i] <= qp.ub.data[i] && qp.lb.data[i] < INFINITY && qp.ub.data[i] > -INFINITY;
    }
    #line 302 "iiwa_dnn/qp/program.py"
    return fits;
}

/* Compute `point_residuals` of a point (2n + m + p,), for a program's flat array, `QP.data`.
 *
 * iiwa_dnn/qp/residuals.py: residuals_of */
static inline double_3 qp_residuals_residuals_of(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector point)
{
    #line 66 "iiwa_dnn/qp/residuals.py"
    #line 67 "iiwa_dnn/qp/residuals.py"
    const qp_layout_QPViews own_1 = qp_layout_qp_views(arena, data, n, m, p);
    return qp_residuals_point_residuals(arena, &own_1, point);
}

/* Check a point (2n + m + p,) by the rule of acceptance, and that `QP.data` is convex.
 *
 * iiwa_dnn/qp/residuals.py: is_accepted */
static inline bool qp_residuals_is_accepted(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector point, double eps_abs, double eps_rel)
{
    const struct arena mark = *arena;
    #line 154 "iiwa_dnn/qp/residuals.py"
    #line 155 "iiwa_dnn/qp/residuals.py"
    const qp_layout_QPViews qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 156 "iiwa_dnn/qp/residuals.py"
    const bool own_result = qp_residuals_is_small_enough(arena, &qp, point, eps_abs, eps_rel) && qp_dense_is_convex(arena, qp.P, (Matrix){(double *)arena_empty(arena, n * n), n, n});
    arena_leave(arena, &mark);
    return own_result;
}

/* Compute a path's clock [s] and the clock's rate [1] at time t [s], by `SoftStart`.
 *
 * iiwa_dnn/references/base.py: soft_clock */
static inline double_2 references_base_soft_clock(struct arena *arena, double t, double begin)
{
    (void)arena;
    #line 156 "iiwa_dnn/references/base.py"
    #line 157 "iiwa_dnn/references/base.py"
    if (begin == 0.0) {
        #line 158 "iiwa_dnn/references/base.py"
        return (double_2){{t, 1.0}};
    }
    #line 159 "iiwa_dnn/references/base.py"
    if (t >= begin) {
        #line 160 "iiwa_dnn/references/base.py"
        return (double_2){{t - 0.5 * begin, 1.0}};
    }
    #line 161 "iiwa_dnn/references/base.py"
    if (t <= 0.0) {
        #line 162 "iiwa_dnn/references/base.py"
        return (double_2){{0.0, 0.0}};
    }
    #line 163 "iiwa_dnn/references/base.py"
    const double u = t / begin;
    #line 164 "iiwa_dnn/references/base.py"
    return (double_2){{t * u * u * (1.0 - 0.5 * u), u * u * (3.0 - 2.0 * u)}};
}

/* Replace a displacement (3,) by the velocity along it; return the fraction that is covered.
 *
 * Args:
 *     path: The displacement; it becomes a velocity of the fastest speed, 0 where all is covered.
 *     fastest: Largest speed [1/s].
 *     elapsed: Time since the motion began [s].
 *
 * iiwa_dnn/references/moving_target.py: _paced */
static inline double references_moving_target_paced(struct arena *arena, Vector path, double fastest, double elapsed)
{
    #line 107 "iiwa_dnn/references/moving_target.py"
    #line 114 "iiwa_dnn/references/moving_target.py"
    const double length = sqrt(references_rotations_dot(arena, references_rotations_triple(arena, path), references_rotations_triple(arena, path)));
    #line 115 "iiwa_dnn/references/moving_target.py"
    const bool arrived = length <= double_max(fastest * elapsed, references_moving_target_ARRIVED);
    #line 116 "iiwa_dnn/references/moving_target.py"
    const double velocity = arrived ? 0.0 : fastest / length;
    #line 117 "iiwa_dnn/references/moving_target.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 118 "iiwa_dnn/references/moving_target.py"
        path.data[i] *= velocity;
    }
    #line 119 "iiwa_dnn/references/moving_target.py"
    return arrived ? 1.0 : elapsed * velocity;
}

/* Rotate v by the quaternion with scalar part w and vector part u, of any length but 0.
 *
 * iiwa_dnn/references/rotations.py: rotated */
static inline double_3 references_rotations_rotated(struct arena *arena, double w, double_3 u, double_3 v)
{
    #line 51 "iiwa_dnn/references/rotations.py"
    #line 52 "iiwa_dnn/references/rotations.py"
    const double_3 once = references_rotations_cross(arena, u, v);
    #line 53 "iiwa_dnn/references/rotations.py"
    const double scale = 2.0 / (w * w + references_rotations_dot(arena, u, u));
    #line 54 "iiwa_dnn/references/rotations.py"
    return references_rotations_combined(arena, 1.0, v, scale, references_rotations_combined(arena, w, once, 1.0, references_rotations_cross(arena, u, once)));
}

/* Return the j-th column of a matrix (3, 3).
 *
 * iiwa_dnn/references/rotations.py: column_of */
static inline double_3 references_rotations_column_of(struct arena *arena, Matrix R, int64_t j)
{
    (void)arena;
    #line 45 "iiwa_dnn/references/rotations.py"
    #line 46 "iiwa_dnn/references/rotations.py"
    return (double_3){{R.data[j], R.data[R.size1 + j], R.data[2 * R.size1 + j]}};
}

/* Turn a target about the world's axes by a quaternion; its position stays.
 *
 * Args:
 *     target: The target.
 *     w: Scalar part of the quaternion, whose length may be any but 0.
 *     u: Vector part.
 *     w_rate: Rate of the scalar part [1/s].
 *     u_rate: Rate of the vector part [1/s].
 *
 * iiwa_dnn/references/rotations.py: turn_target */
static inline void references_rotations_turn_target(struct arena *arena, const references_targets_TargetData *target, double w, double_3 u, double w_rate, double_3 u_rate)
{
    #line 59 "iiwa_dnn/references/rotations.py"
    #line 68 "iiwa_dnn/references/rotations.py"
    for (int64_t j = 0; j < 3; j++) {
        #line 69 "iiwa_dnn/references/rotations.py"
        const double_3 column = references_rotations_rotated(arena, w, u, references_rotations_column_of(arena, target->rotation, j));
        #line 70 "iiwa_dnn/references/rotations.py"
        for (int64_t i = 0; i < 3; i++) {
            #line 71 "iiwa_dnn/references/rotations.py"
            target->rotation.data[i * target->rotation.size1 + j] = column.at[i];
        }
    }
    #line 72 "iiwa_dnn/references/rotations.py"
    const double_3 before = references_rotations_rotated(arena, w, u, references_rotations_triple(arena, target->angular_velocity));
    #line 73 "iiwa_dnn/references/rotations.py"
    const double_3 spin = references_rotations_combined(arena, 1.0, references_rotations_cross(arena, u, u_rate), 1.0, references_rotations_combined(arena, w, u_rate, -w_rate, u));
    #line 74 "iiwa_dnn/references/rotations.py"
    const double_3 after = references_rotations_combined(arena, 1.0, before, 2.0 / (w * w + references_rotations_dot(arena, u, u)), spin);
    #line 75 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 76 "iiwa_dnn/references/rotations.py"
        target->angular_velocity.data[i] = after.at[i];
    }
}

/* Turn a target about an axis of length 1 by an angle [rad], at a rate [rad/s].
 *
 * iiwa_dnn/references/rotations.py: turn_about */
static inline void references_rotations_turn_about(struct arena *arena, const references_targets_TargetData *target, double_3 axis, double angle, double rate)
{
    #line 81 "iiwa_dnn/references/rotations.py"
    #line 82 "iiwa_dnn/references/rotations.py"
    const double_2 own_1 = compiling_trigonometry_sin_cos(arena, 0.5 * angle);
    const double sine = own_1.at[0];
    const double cosine = own_1.at[1];
    #line 83 "iiwa_dnn/references/rotations.py"
    const double half = 0.5 * rate;
    #line 84 "iiwa_dnn/references/rotations.py"
    references_rotations_turn_target(arena, target, cosine, references_rotations_scaled(arena, sine, axis), -half * sine, references_rotations_scaled(arena, half * cosine, axis));
}

/* Move a target towards a goal at limited speed for a time, and set its twist.
 *
 * Args:
 *     target: The target, overwritten.
 *     goal: The goal.
 *     elapsed: The time [s].
 *     speed: Largest linear speed [m/s].
 *     rate: Largest angular speed [rad/s].
 *
 * iiwa_dnn/references/moving_target.py: approach */
static inline void references_moving_target_approach(struct arena *arena, const references_targets_TargetData *target, const references_targets_TargetData *goal, double elapsed, double speed, double rate)
{
    #line 84 "iiwa_dnn/references/moving_target.py"
    #line 93 "iiwa_dnn/references/moving_target.py"
    references_rotations_set_mean_twist(arena, target, goal, 1.0);
    #line 94 "iiwa_dnn/references/moving_target.py"
    const double_3 path = references_rotations_triple(arena, target->linear_velocity);
    #line 95 "iiwa_dnn/references/moving_target.py"
    const double_3 turn = references_rotations_triple(arena, target->angular_velocity);
    #line 96 "iiwa_dnn/references/moving_target.py"
    const double moved = references_moving_target_paced(arena, target->linear_velocity, speed, elapsed);
    #line 97 "iiwa_dnn/references/moving_target.py"
    const double turned = references_moving_target_paced(arena, target->angular_velocity, rate, elapsed);
    #line 98 "iiwa_dnn/references/moving_target.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 99 "iiwa_dnn/references/moving_target.py"
        target->position.data[i] += moved * path.at[i];
    }
    #line 100 "iiwa_dnn/references/moving_target.py"
    const double angle = sqrt(references_rotations_dot(arena, turn, turn));
    #line 101 "iiwa_dnn/references/moving_target.py"
    if (angle > 0.0) {
        #line 102 "iiwa_dnn/references/moving_target.py"
        references_rotations_turn_about(arena, target, references_rotations_scaled(arena, 1.0 / angle, turn), turned * angle, 0.0);
    }
}

/* Move a target, at rest at the path's origin, to time t [s] of `Heart`, in place.
 *
 * iiwa_dnn/references/shapes.py: heart_path */
static inline void references_shapes_heart_path(struct arena *arena, double t, Vector constants, const references_targets_TargetData *target)
{
    #line 29 "iiwa_dnn/references/shapes.py"
    #line 30 "iiwa_dnn/references/shapes.py"
    const references_shapes_HeartConstants own = references_shapes_HeartConstants_of(constants);
    #line 31 "iiwa_dnn/references/shapes.py"
    const double p = own.at->rate * t;
    #line 32 "iiwa_dnn/references/shapes.py"
    const double_2 own_1 = compiling_trigonometry_sin_cos(arena, p);
    const double s1 = own_1.at[0];
    const double c1 = own_1.at[1];
    #line 33 "iiwa_dnn/references/shapes.py"
    const double_2 own_2 = compiling_trigonometry_sin_cos(arena, 2.0 * p);
    const double s2 = own_2.at[0];
    const double c2 = own_2.at[1];
    #line 34 "iiwa_dnn/references/shapes.py"
    const double_2 own_3 = compiling_trigonometry_sin_cos(arena, 3.0 * p);
    const double s3 = own_3.at[0];
    const double c3 = own_3.at[1];
    #line 35 "iiwa_dnn/references/shapes.py"
    const double_2 own_4 = compiling_trigonometry_sin_cos(arena, 4.0 * p);
    const double s4 = own_4.at[0];
    const double c4 = own_4.at[1];
    #line 36 "iiwa_dnn/references/shapes.py"
    const double y = 13.0 * c1 - 5.0 * c2 - 2.0 * c3 - c4 - 5.0;
    #line 37 "iiwa_dnn/references/shapes.py"
    const double slope = -13.0 * s1 + 10.0 * s2 + 6.0 * s3 + 4.0 * s4;
    #line 38 "iiwa_dnn/references/shapes.py"
    target->position.data[0] += own.at->scale * 16.0 * s1 * s1 * s1;
    #line 39 "iiwa_dnn/references/shapes.py"
    target->position.data[1] += own.at->scale * y;
    #line 40 "iiwa_dnn/references/shapes.py"
    target->linear_velocity.data[0] += own.at->rate * own.at->scale * 48.0 * s1 * s1 * c1;
    #line 41 "iiwa_dnn/references/shapes.py"
    target->linear_velocity.data[1] += own.at->rate * own.at->scale * slope;
}

/* Move a target, at rest at the origin, to time t [s] of a `Lissajous`, `Circle` or `Line`.
 *
 * iiwa_dnn/references/shapes.py: lissajous_path */
static inline void references_shapes_lissajous_path(struct arena *arena, double t, Vector constants, const references_targets_TargetData *target)
{
    #line 96 "iiwa_dnn/references/shapes.py"
    #line 97 "iiwa_dnn/references/shapes.py"
    const references_shapes_LissajousConstants own = references_shapes_LissajousConstants_of(constants);
    #line 98 "iiwa_dnn/references/shapes.py"
    const double_2 own_1 = references_base_soft_clock(arena, t, own.at->begin);
    const double inner = own_1.at[0];
    const double pace = own_1.at[1];
    #line 99 "iiwa_dnn/references/shapes.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 100 "iiwa_dnn/references/shapes.py"
        const double p = own.rates.data[i] * inner;
        #line 102 "iiwa_dnn/references/shapes.py"
        const double half = compiling_trigonometry_sin(arena, 0.5 * p);
        #line 103 "iiwa_dnn/references/shapes.py"
        const double_2 own_2 = compiling_trigonometry_sin_cos(arena, p);
        const double sine = own_2.at[0];
        const double cosine = own_2.at[1];
        #line 104 "iiwa_dnn/references/shapes.py"
        target->position.data[i] += own.sines.data[i] * sine - 2.0 * own.cosines.data[i] * half * half;
        #line 105 "iiwa_dnn/references/shapes.py"
        const double change = own.sines.data[i] * cosine - own.cosines.data[i] * sine;
        #line 106 "iiwa_dnn/references/shapes.py"
        target->linear_velocity.data[i] += own.rates.data[i] * pace * change;
    }
}

/* Leave the target at its origin, at rest.
 *
 * iiwa_dnn/references/shapes.py: fixed_path */
static inline void references_shapes_fixed_path(struct arena *arena, double t, Vector constants, const references_targets_TargetData *target)
{
    (void)arena;
    (void)t;
    (void)constants;
    (void)target;
    #line 232 "iiwa_dnn/references/shapes.py"
}

/* Turn a target, at rest at the path's origin, to time t [s] of `Cone`, in place.
 *
 * iiwa_dnn/references/turning.py: cone_path */
static inline void references_turning_cone_path(struct arena *arena, double t, Vector constants, const references_targets_TargetData *target)
{
    #line 35 "iiwa_dnn/references/turning.py"
    #line 36 "iiwa_dnn/references/turning.py"
    const references_turning_ConeConstants own = references_turning_ConeConstants_of(constants);
    #line 37 "iiwa_dnn/references/turning.py"
    const double_2 own_1 = references_base_soft_clock(arena, t, own.at->begin);
    const double inner = own_1.at[0];
    const double pace = own_1.at[1];
    #line 38 "iiwa_dnn/references/turning.py"
    const double rate = own.at->rate * pace;
    #line 39 "iiwa_dnn/references/turning.py"
    const double p = own.at->rate * inner;
    #line 40 "iiwa_dnn/references/turning.py"
    references_rotations_turn_about(arena, target, references_rotations_column_of(arena, target->rotation, 0), -own.at->angle, 0.0);
    #line 42 "iiwa_dnn/references/turning.py"
    const double_3 u = references_rotations_column_of(arena, target->rotation, 0);
    #line 43 "iiwa_dnn/references/turning.py"
    const double_3 v = references_rotations_column_of(arena, target->rotation, 1);
    #line 44 "iiwa_dnn/references/turning.py"
    const double_2 own_2 = compiling_trigonometry_sin_cos(arena, p);
    const double sine = own_2.at[0];
    const double cosine = own_2.at[1];
    #line 45 "iiwa_dnn/references/turning.py"
    const double_2 own_3 = compiling_trigonometry_sin_cos(arena, 0.5 * own.at->angle);
    const double half = own_3.at[0];
    const double w = own_3.at[1];
    #line 46 "iiwa_dnn/references/turning.py"
    const double_3 tilt = references_rotations_combined(arena, half * cosine, u, half * sine, v);
    #line 47 "iiwa_dnn/references/turning.py"
    references_rotations_turn_target(arena, target, w, tilt, 0.0, references_rotations_combined(arena, half * rate * cosine, v, -half * rate * sine, u));
}

/* Find the index of the piece that holds a time t [s], by bisection.
 *
 * iiwa_dnn/references/waypoints.py: _piece */
static inline int64_t references_waypoints_piece(struct arena *arena, Matrix pieces, double t)
{
    (void)arena;
    #line 76 "iiwa_dnn/references/waypoints.py"
    #line 77 "iiwa_dnn/references/waypoints.py"
    int64_t low = 0;
    #line 78 "iiwa_dnn/references/waypoints.py"
    int64_t high = pieces.size0 - 1;
    #line 79 "iiwa_dnn/references/waypoints.py"
    while (low < high) {
        #line 80 "iiwa_dnn/references/waypoints.py"
        const int64_t middle = int_quotient(low + high + 1, 2);
        #line 81 "iiwa_dnn/references/waypoints.py"
        if (references_waypoints_Piece_of((Vector){pieces.data + middle * pieces.size1, pieces.size1}).at->start <= t) {
            #line 82 "iiwa_dnn/references/waypoints.py"
            low = middle;
        } else {
            #line 84 "iiwa_dnn/references/waypoints.py"
            high = middle - 1;
        }
    }
    #line 85 "iiwa_dnn/references/waypoints.py"
    return low;
}

/* Move a target, at rest at the path's origin, to time t [s] of `Waypoints`, in place.
 *
 * iiwa_dnn/references/waypoints.py: waypoints_path */
static inline void references_waypoints_waypoints_path(struct arena *arena, double t, Vector constants, const references_targets_TargetData *target)
{
    const struct arena mark = *arena;
    #line 90 "iiwa_dnn/references/waypoints.py"
    #line 91 "iiwa_dnn/references/waypoints.py"
    const references_waypoints_WaypointsConstants own = references_waypoints_WaypointsConstants_of(constants, int_max(0, (constants.size0 - (2)) / 1));
    #line 92 "iiwa_dnn/references/waypoints.py"
    const int64_t own_1 = int_quotient(own.pieces.size0, 29);
    const int64_t own_2 = 29;
    const Matrix pieces = {own.pieces.data, own_1, own_2};
    #line 93 "iiwa_dnn/references/waypoints.py"
    const bool repeats = own.at->period < INFINITY;
    #line 94 "iiwa_dnn/references/waypoints.py"
    const double inside = repeats ? double_remainder(t, own.at->period) : double_min(double_max(t, 0.0), own.at->duration);
    #line 95 "iiwa_dnn/references/waypoints.py"
    const double moves = repeats || inside == t ? 1.0 : 0.0;
    #line 96 "iiwa_dnn/references/waypoints.py"
    const references_waypoints_Piece piece = references_waypoints_Piece_of((Vector){pieces.data + references_waypoints_piece(arena, pieces, inside) * pieces.size1, pieces.size1});
    #line 97 "iiwa_dnn/references/waypoints.py"
    const double x = inside - piece.at->start;
    #line 98 "iiwa_dnn/references/waypoints.py"
    const int64_t own_3 = 7;
    const Vector values = {(double *)arena_empty(arena, own_3), own_3};
    #line 99 "iiwa_dnn/references/waypoints.py"
    const int64_t own_4 = 7;
    const Vector rates = {(double *)arena_empty(arena, own_4), own_4};
    #line 100 "iiwa_dnn/references/waypoints.py"
    for (int64_t i = 0; i < values.size0; i++) {
        #line 101 "iiwa_dnn/references/waypoints.py"
        double inner = x * piece.third.data[i] + piece.second.data[i];
        #line 102 "iiwa_dnn/references/waypoints.py"
        values.data[i] = x * (x * inner + piece.first.data[i]) + piece.offset.data[i];
        #line 103 "iiwa_dnn/references/waypoints.py"
        inner = 3.0 * x * piece.third.data[i] + 2.0 * piece.second.data[i];
        #line 104 "iiwa_dnn/references/waypoints.py"
        rates.data[i] = moves * (x * inner + piece.first.data[i]);
    }
    #line 105 "iiwa_dnn/references/waypoints.py"
    const references_waypoints_PoseNumbers pose = references_waypoints_PoseNumbers_of(values);
    #line 106 "iiwa_dnn/references/waypoints.py"
    const references_waypoints_PoseNumbers rate = references_waypoints_PoseNumbers_of(rates);
    #line 107 "iiwa_dnn/references/waypoints.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 108 "iiwa_dnn/references/waypoints.py"
        target->position.data[i] += pose.move.data[i];
        #line 109 "iiwa_dnn/references/waypoints.py"
        target->linear_velocity.data[i] += rate.move.data[i];
    }
    #line 110 "iiwa_dnn/references/waypoints.py"
    references_rotations_turn_target(arena, target, pose.at->scalar, references_rotations_triple(arena, pose.vector), rate.at->scalar, references_rotations_triple(arena, rate.vector));
    arena_leave(arena, &mark);
}

/* Move a target, at rest at the path's origin, to time t [s] of `Tilting`, in place.
 *
 * The constants are `TiltingConstants`, then those of the path along which the tool tilts.
 *
 * iiwa_dnn/references/turning.py: tilting_path */
static inline void references_turning_tilting_path(struct arena *arena, double t, Vector constants, const references_targets_TargetData *target)
{
    #line 115 "iiwa_dnn/references/turning.py"
    #line 119 "iiwa_dnn/references/turning.py"
    const int64_t own_1 = 7;
    const references_turning_TiltingConstants own = references_turning_TiltingConstants_of((Vector){constants.data, own_1});
    #line 120 "iiwa_dnn/references/turning.py"
    const int64_t own_2 = 7;
    const Vector along = {constants.data + 7, constants.size0 - own_2};
    #line 121 "iiwa_dnn/references/turning.py"
    const int64_t kind = int_of(own.at->along);
    #line 122 "iiwa_dnn/references/turning.py"
    const double_2 own_3 = references_base_soft_clock(arena, t, own.at->begin);
    const double inner = own_3.at[0];
    const double pace = own_3.at[1];
    #line 123 "iiwa_dnn/references/turning.py"
    if (kind == references_turning_Along_HEART) {
        #line 124 "iiwa_dnn/references/turning.py"
        references_shapes_heart_path(arena, inner, along, target);
    } else {
        #line 125 "iiwa_dnn/references/turning.py"
        if (kind == references_turning_Along_LISSAJOUS) {
            #line 126 "iiwa_dnn/references/turning.py"
            references_shapes_lissajous_path(arena, inner, along, target);
        } else {
            #line 127 "iiwa_dnn/references/turning.py"
            if (kind == references_turning_Along_WAYPOINTS) {
                #line 128 "iiwa_dnn/references/turning.py"
                references_waypoints_waypoints_path(arena, inner, along, target);
            }
        }
    }
    #line 129 "iiwa_dnn/references/turning.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 130 "iiwa_dnn/references/turning.py"
        target->linear_velocity.data[i] *= pace;
        #line 131 "iiwa_dnn/references/turning.py"
        target->angular_velocity.data[i] *= pace;
    }
    #line 132 "iiwa_dnn/references/turning.py"
    const double_2 own_4 = compiling_trigonometry_sin_cos(arena, own.at->rate * inner);
    const double sine = own_4.at[0];
    const double cosine = own_4.at[1];
    #line 133 "iiwa_dnn/references/turning.py"
    const double rate = own.at->angle * own.at->rate * pace * cosine;
    #line 134 "iiwa_dnn/references/turning.py"
    references_rotations_turn_about(arena, target, references_rotations_triple(arena, own.axis), own.at->angle * sine, rate);
}

/* Compute the distance that a pair has to keep from now on [m]; `MEET` if it has no normal.
 *
 * It is the least distance of the scene. A pair that begins nearer than that has to keep the
 * distance with which it began, less `CLEARANCE`, until it is beyond the scene's. (If it had to
 * keep the largest distance so far, a pair at the end of its link's range could not come back.)
 *
 * Args:
 *     scene: The scene.
 *     contact: The pair's contact.
 *     kept: Distance that the pair had to keep so far [m]; 0 at the beginning.
 *
 * iiwa_dnn/schemes/collisions.py: kept_distance */
static inline double schemes_collisions_kept_distance(struct arena *arena, const schemes_scene_SceneViews *scene, const schemes_scene_Contact *contact, double kept)
{
    #line 161 "iiwa_dnn/schemes/collisions.py"
    #line 172 "iiwa_dnn/schemes/collisions.py"
    if (references_rotations_dot(arena, contact->normal, contact->normal) == 0.0) {
        #line 173 "iiwa_dnn/schemes/collisions.py"
        return schemes_collisions_MEET;
    }
    #line 174 "iiwa_dnn/schemes/collisions.py"
    if (contact->distance >= scene->head.at->least + schemes_collisions_CLEARANCE) {
        #line 175 "iiwa_dnn/schemes/collisions.py"
        return scene->head.at->least;
    }
    #line 176 "iiwa_dnn/schemes/collisions.py"
    if (kept == 0.0 || kept == schemes_collisions_MEET) {
        #line 177 "iiwa_dnn/schemes/collisions.py"
        return contact->distance < scene->head.at->least ? contact->distance - schemes_collisions_CLEARANCE : scene->head.at->least;
    }
    #line 182 "iiwa_dnn/schemes/collisions.py"
    return kept;
}

/* Write the candidate rows of both ends of pair k, the numbers 2 k and 2 k + 1 of c candidates.
 *
 * They are not written for a pair so far away that no velocity within the limits breaks its rows.
 * Writes step.least at the pair, gradients, limits and slacks.
 *
 * Args:
 *     step: The instant.
 *     scene: The scene, b bodies.
 *     placed: Placements of the bodies, (b, 12).
 *     k: Index of the pair in the scene.
 *     gradients: Rows of G, (c, n).
 *     limits: Right-hand sides h, (c,).
 *     slacks: Least slack of each row within the velocity limits, (c,).
 *
 * iiwa_dnn/schemes/collisions.py: _write_ends */
static inline void schemes_collisions_write_ends(struct arena *arena, const schemes_step_StepViews *step, const schemes_scene_SceneViews *scene, Matrix placed, int64_t k, Matrix gradients, Vector limits, Vector slacks)
{
    const struct arena mark = *arena;
    #line 108 "iiwa_dnn/schemes/collisions.py"
    #line 122 "iiwa_dnn/schemes/collisions.py"
    const schemes_scene_Contact contact = schemes_scene_contact_of(arena, scene, k, placed);
    #line 123 "iiwa_dnn/schemes/collisions.py"
    const schemes_scene_Pair pair = schemes_scene_Pair_of((Vector){scene->pairs.data + k * scene->pairs.size1, scene->pairs.size1}, int_max(0, (scene->pairs.size1 - (3)) / 2));
    #line 124 "iiwa_dnn/schemes/collisions.py"
    const double kept = schemes_collisions_kept_distance(arena, scene, &contact, step->least.data[(int64_t)scene->head.at->first + k]);
    #line 125 "iiwa_dnn/schemes/collisions.py"
    step->least.data[(int64_t)scene->head.at->first + k] = kept;
    #line 126 "iiwa_dnn/schemes/collisions.py"
    const double least = double_min(kept, scene->head.at->least);
    #line 127 "iiwa_dnn/schemes/collisions.py"
    const double gain = double_min(scene->head.at->gain, step->rate);
    #line 128 "iiwa_dnn/schemes/collisions.py"
    const double speed = schemes_scene_Body_of((Vector){scene->bodies.data + (int64_t)pair.at->first * scene->bodies.size1, scene->bodies.size1}).at->speed;
    #line 129 "iiwa_dnn/schemes/collisions.py"
    const Vector travel = {(double *)arena_empty(arena, step->q.size0), step->q.size0};
    #line 130 "iiwa_dnn/schemes/collisions.py"
    double most = speed - gain * (contact.distance - least - schemes_collisions_CLEARANCE);
    #line 131 "iiwa_dnn/schemes/collisions.py"
    for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
        #line 132 "iiwa_dnn/schemes/collisions.py"
        travel.data[j] = fabs(step->last.data[j]) / step->rate;
        #line 133 "iiwa_dnn/schemes/collisions.py"
        most += fabs(pair.radii.data[j]) * scene->dq_max.data[j];
    }
    #line 134 "iiwa_dnn/schemes/collisions.py"
    if (most <= 0.0) {
        #line 135 "iiwa_dnn/schemes/collisions.py"
        arena_leave(arena, &mark);
        return;
    }
    #line 136 "iiwa_dnn/schemes/collisions.py"
    const double_3_2 ends = schemes_scene_ends_of(arena, scene, placed, (int64_t)pair.at->second);
    #line 137 "iiwa_dnn/schemes/collisions.py"
    const Vector own_1 = schemes_scene_Body_of((Vector){scene->bodies.data + (int64_t)pair.at->second * scene->bodies.size1, scene->bodies.size1}).half;
    const bool is_point = own_1.data[2] == 0.0;
    #line 138 "iiwa_dnn/schemes/collisions.py"
    const double eps = schemes_scene_second_order(arena, &pair, travel);
    #line 139 "iiwa_dnn/schemes/collisions.py"
    for (int64_t at = 0, end_at = is_point ? 1 : schemes_collisions_ENDS; at < end_at; at++) {
        #line 140 "iiwa_dnn/schemes/collisions.py"
        if ((int64_t)pair.at->unmoved_end == at + 1) {
            #line 141 "iiwa_dnn/schemes/collisions.py"
            continue;
        }
        #line 142 "iiwa_dnn/schemes/collisions.py"
        const int64_t row = schemes_collisions_ENDS * k + at;
        #line 143 "iiwa_dnn/schemes/collisions.py"
        const double left = contact.distance + schemes_scene_height_of(arena, ends.at[at], &contact) - least - schemes_collisions_CLEARANCE;
        #line 144 "iiwa_dnn/schemes/collisions.py"
        limits.data[row] = gain * left - speed;
        #line 145 "iiwa_dnn/schemes/collisions.py"
        double fastest = 0.0;
        #line 146 "iiwa_dnn/schemes/collisions.py"
        for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
            #line 147 "iiwa_dnn/schemes/collisions.py"
            if (pair.support.data[j] != 0.0) {
                #line 148 "iiwa_dnn/schemes/collisions.py"
                const double rate = schemes_step_rate_along(arena, step->jacobian, j, ends.at[at], contact.normal);
                #line 149 "iiwa_dnn/schemes/collisions.py"
                gradients.data[row * gradients.size1 + j] = -pair.support.data[j] * rate;
                #line 150 "iiwa_dnn/schemes/collisions.py"
                fastest += fabs(rate) * scene->dq_max.data[j];
            }
        }
        #line 151 "iiwa_dnn/schemes/collisions.py"
        slacks.data[row] = limits.data[row] - fastest;
        #line 152 "iiwa_dnn/schemes/collisions.py"
        limits.data[row] -= gain * eps;
        #line 153 "iiwa_dnn/schemes/collisions.py"
        if (left < eps && step->rate < INFINITY) {
            #line 154 "iiwa_dnn/schemes/collisions.py"
            limits.data[row] -= (step->rate - gain) * double_min(eps - left, eps);
        }
        #line 155 "iiwa_dnn/schemes/collisions.py"
        if (least < scene->head.at->least) {
            #line 156 "iiwa_dnn/schemes/collisions.py"
            limits.data[row] = double_max(limits.data[row], -speed);
        }
    }
    arena_leave(arena, &mark);
}

/* Return the place of candidate k in ascending order of the slacks (c,), from 0.
 *
 * Of equal slacks the one with the lower index comes first, so that no two share a place.
 *
 * iiwa_dnn/schemes/collisions.py: _rank */
static inline int64_t schemes_collisions_rank(struct arena *arena, Vector slacks, int64_t k)
{
    (void)arena;
    #line 187 "iiwa_dnn/schemes/collisions.py"
    #line 191 "iiwa_dnn/schemes/collisions.py"
    int64_t rank = 0;
    #line 192 "iiwa_dnn/schemes/collisions.py"
    for (int64_t i = 0; i < slacks.size0; i++) {
        #line 193 "iiwa_dnn/schemes/collisions.py"
        rank += slacks.data[i] < slacks.data[k] || (slacks.data[i] == slacks.data[k] && i < k);
    }
    #line 194 "iiwa_dnn/schemes/collisions.py"
    return rank;
}

/* Write G (rows, n) and h (rows,) of the ends of pairs whose rows have the least slack.
 *
 * `constants` are `Scene.constants`. Writes G, h and, by `kept_distance`, step.least; lb and ub
 * stay.
 *
 * iiwa_dnn/schemes/collisions.py: collision_rows */
static inline void schemes_collisions_collision_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)lb;
    (void)ub;
    const struct arena mark = *arena;
    #line 69 "iiwa_dnn/schemes/collisions.py"
    #line 74 "iiwa_dnn/schemes/collisions.py"
    const int64_t dof = step->q.size0;
    #line 75 "iiwa_dnn/schemes/collisions.py"
    const schemes_scene_SceneViews scene = schemes_scene_scene_views(arena, constants, dof);
    #line 76 "iiwa_dnn/schemes/collisions.py"
    const int64_t candidates = schemes_collisions_ENDS * scene.pairs.size0;
    #line 77 "iiwa_dnn/schemes/collisions.py"
    const Matrix gradients = {(double *)arena_zeros(arena, candidates * dof), candidates, dof};
    #line 78 "iiwa_dnn/schemes/collisions.py"
    const Vector limits = {(double *)arena_empty(arena, candidates), candidates};
    #line 79 "iiwa_dnn/schemes/collisions.py"
    const Vector slacks = {(double *)arena_empty(arena, candidates), candidates};
    #line 80 "iiwa_dnn/schemes/collisions.py"
    for (int64_t own_k = 0; own_k < slacks.size0; own_k++) {
        slacks.data[own_k] = INFINITY;
    }
    #line 81 "iiwa_dnn/schemes/collisions.py"
    const int64_t own_1 = scene.bodies.size0;
    const int64_t own_2 = 12;
    const Matrix placed = {(double *)arena_empty(arena, own_1 * own_2), own_1, own_2};
    #line 82 "iiwa_dnn/schemes/collisions.py"
    schemes_scene_place_bodies(arena, &scene, step->placements, placed);
    #line 83 "iiwa_dnn/schemes/collisions.py"
    for (int64_t k = 0, end_k = scene.pairs.size0; k < end_k; k++) {
        #line 84 "iiwa_dnn/schemes/collisions.py"
        schemes_collisions_write_ends(arena, step, &scene, placed, k, gradients, limits, slacks);
    }
    #line 85 "iiwa_dnn/schemes/collisions.py"
    for (int64_t own_k = 0; own_k < G.size0 * G.size1; own_k++) {
        G.data[own_k] = 0.0;
    }
    #line 86 "iiwa_dnn/schemes/collisions.py"
    for (int64_t own_k = 0; own_k < h.size0; own_k++) {
        h.data[own_k] = INFINITY;
    }
    #line 87 "iiwa_dnn/schemes/collisions.py"
    int64_t row = 0;
    #line 88 "iiwa_dnn/schemes/collisions.py"
    for (int64_t k = 0; k < candidates; k++) {
        #line 89 "iiwa_dnn/schemes/collisions.py"
        if (slacks.data[k] < 0.0 && schemes_collisions_rank(arena, slacks, k) < h.size0) {
            #line 90 "iiwa_dnn/schemes/collisions.py"
            if (candidates <= h.size0) {
                #line 91 "iiwa_dnn/schemes/collisions.py"
                row = k;
            }
            #line 92 "iiwa_dnn/schemes/collisions.py"
            for (int64_t j = 0; j < dof; j++) {
                #line 93 "iiwa_dnn/schemes/collisions.py"
                G.data[row * G.size1 + j] = gradients.data[k * gradients.size1 + j];
            }
            #line 94 "iiwa_dnn/schemes/collisions.py"
            h.data[row] = limits.data[k];
            #line 95 "iiwa_dnn/schemes/collisions.py"
            row += 1;
        }
    }
    arena_leave(arena, &mark);
}

/* Add w G(q) to P (n, n), for `KineticEnergy`. Writes P; q stays.
 *
 * iiwa_dnn/schemes/costs.py: add_kinetic_energy */
static inline void schemes_costs_add_kinetic_energy(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    (void)q;
    #line 42 "iiwa_dnn/schemes/costs.py"
    #line 43 "iiwa_dnn/schemes/costs.py"
    const schemes_costs_KineticConstants own = schemes_costs_KineticConstants_of(constants);
    #line 44 "iiwa_dnn/schemes/costs.py"
    for (int64_t i = 0, end_i = step->q.size0; i < end_i; i++) {
        #line 45 "iiwa_dnn/schemes/costs.py"
        if (own.at->is_inertia != 0.0) {
            #line 46 "iiwa_dnn/schemes/costs.py"
            for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
                #line 47 "iiwa_dnn/schemes/costs.py"
                P.data[i * P.size1 + j] += own.at->weight * step->inertia.data[i * step->inertia.size1 + j];
            }
        } else {
            #line 49 "iiwa_dnn/schemes/costs.py"
            P.data[i * P.size1 + i] += own.at->weight;
        }
    }
}

/* Add w I to P (n, n) and w m (q - home) to q (n,), for `CyclicMotion`. Writes P and q.
 *
 * iiwa_dnn/schemes/costs.py: add_cyclic_motion */
static inline void schemes_costs_add_cyclic_motion(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    #line 87 "iiwa_dnn/schemes/costs.py"
    #line 88 "iiwa_dnn/schemes/costs.py"
    const schemes_costs_CyclicConstants own = schemes_costs_CyclicConstants_of(constants, int_max(0, (constants.size0 - (2)) / 1));
    #line 89 "iiwa_dnn/schemes/costs.py"
    for (int64_t i = 0, end_i = step->q.size0; i < end_i; i++) {
        #line 90 "iiwa_dnn/schemes/costs.py"
        P.data[i * P.size1 + i] += own.at->weight;
        #line 91 "iiwa_dnn/schemes/costs.py"
        q.data[i] += own.at->weight * own.at->gain * (step->q.data[i] - own.home.data[i]);
    }
}

/* Compute a joint's velocity limit [rad/s] at a distance from its position limit.
 *
 * Args:
 *     distance: The distance d [rad].
 *     offset: Offset o [rad/s].
 *     deceleration: Deceleration D [rad/s^2]; inf for a joint without such a limit.
 *
 * Returns:
 *     sqrt(2 D d) - o, at least 0; inf for a joint without such a limit.
 *
 * iiwa_dnn/schemes/joint_limits.py: position_dependent_speed */
static inline double schemes_joint_limits_position_dependent_speed(struct arena *arena, double distance, double offset, double deceleration)
{
    (void)arena;
    #line 81 "iiwa_dnn/schemes/joint_limits.py"
    #line 91 "iiwa_dnn/schemes/joint_limits.py"
    if (!(deceleration < INFINITY)) {
        #line 92 "iiwa_dnn/schemes/joint_limits.py"
        return INFINITY;
    }
    #line 93 "iiwa_dnn/schemes/joint_limits.py"
    return double_max(sqrt(2.0 * deceleration * double_max(distance, 0.0)) - offset, 0.0);
}

/* Tell which limit sets a joint's bound towards one side, its `LimitKind`.
 *
 * Args:
 *     bound: The bound [rad/s], positive towards that side: ub, or -lb.
 *     speed: Velocity limit towards that side at the joint's position [rad/s].
 *     fastest: Velocity limit far from the position limits [rad/s].
 *
 * iiwa_dnn/schemes/joint_limits.py: _speed_kind */
static inline int64_t schemes_joint_limits_speed_kind(struct arena *arena, double bound, double speed, double fastest)
{
    (void)arena;
    #line 67 "iiwa_dnn/schemes/joint_limits.py"
    #line 74 "iiwa_dnn/schemes/joint_limits.py"
    if (bound < speed) {
        #line 75 "iiwa_dnn/schemes/joint_limits.py"
        return naming_LimitKind_POSITION;
    }
    #line 76 "iiwa_dnn/schemes/joint_limits.py"
    return speed < fastest ? naming_LimitKind_POSITION_DEPENDENT_VELOCITY : naming_LimitKind_VELOCITY;
}

/* Tighten the bounds lb and ub (n,) [rad/s] to those of `JointLimits`.
 *
 * `constants` are a `PositionConstants`. Writes lb, ub, step.lower_kind and step.upper_kind; G and
 * h have no rows.
 *
 * iiwa_dnn/schemes/joint_limits.py: joint_limits */
static inline void schemes_joint_limits_joint_limits(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)G;
    (void)h;
    #line 43 "iiwa_dnn/schemes/joint_limits.py"
    #line 48 "iiwa_dnn/schemes/joint_limits.py"
    const int64_t dof = step->q.size0;
    #line 49 "iiwa_dnn/schemes/joint_limits.py"
    const schemes_joint_limits_PositionConstants limits = schemes_joint_limits_PositionConstants_of(constants, int_max(0, (constants.size0 - (1)) / 5));
    #line 50 "iiwa_dnn/schemes/joint_limits.py"
    const double gain = double_min(limits.at->gain, step->rate);
    #line 51 "iiwa_dnn/schemes/joint_limits.py"
    for (int64_t i = 0; i < dof; i++) {
        #line 52 "iiwa_dnn/schemes/joint_limits.py"
        const double above = limits.upper.data[i] - step->q.data[i];
        #line 53 "iiwa_dnn/schemes/joint_limits.py"
        const double below = step->q.data[i] - limits.lower.data[i];
        #line 54 "iiwa_dnn/schemes/joint_limits.py"
        const double fastest = limits.velocity.data[i];
        #line 55 "iiwa_dnn/schemes/joint_limits.py"
        const double up = double_min(fastest, schemes_joint_limits_position_dependent_speed(arena, above, limits.offset.data[i], limits.slope.data[i]));
        #line 56 "iiwa_dnn/schemes/joint_limits.py"
        const double down = double_min(fastest, schemes_joint_limits_position_dependent_speed(arena, below, limits.offset.data[i], limits.slope.data[i]));
        #line 57 "iiwa_dnn/schemes/joint_limits.py"
        const double lower = double_min(double_max(-gain * below, -down), up);
        #line 58 "iiwa_dnn/schemes/joint_limits.py"
        const double upper = double_min(double_max(gain * above, -down), up);
        #line 59 "iiwa_dnn/schemes/joint_limits.py"
        step->lower_kind.data[i] = (double)schemes_joint_limits_speed_kind(arena, -lower, down, fastest);
        #line 60 "iiwa_dnn/schemes/joint_limits.py"
        step->upper_kind.data[i] = (double)schemes_joint_limits_speed_kind(arena, upper, up, fastest);
        #line 61 "iiwa_dnn/schemes/joint_limits.py"
        lb.data[i] = double_max(lb.data[i], lower);
        #line 62 "iiwa_dnn/schemes/joint_limits.py"
        ub.data[i] = double_min(ub.data[i], upper);
    }
}

/* Add P (n, n) and q (n,) from the constants; for a cost in numpy. Writes P and q.
 *
 * iiwa_dnn/schemes/parts.py: copy_cost */
static inline void schemes_parts_copy_cost(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    (void)step;
    #line 196 "iiwa_dnn/schemes/parts.py"
    #line 197 "iiwa_dnn/schemes/parts.py"
    const int64_t n = q.size0;
    #line 198 "iiwa_dnn/schemes/parts.py"
    for (int64_t i = 0; i < n; i++) {
        #line 199 "iiwa_dnn/schemes/parts.py"
        q.data[i] += constants.data[n * n + i];
        #line 200 "iiwa_dnn/schemes/parts.py"
        for (int64_t k = 0; k < n; k++) {
            #line 201 "iiwa_dnn/schemes/parts.py"
            P.data[i * P.size1 + k] += constants.data[n * i + k];
        }
    }
}

/* Write A (rows, n) and b (rows,) from the beginning of the constants.
 *
 * iiwa_dnn/schemes/parts.py: _copy_rows */
static inline void schemes_parts_copy_rows(struct arena *arena, Vector constants, Matrix A, Vector b)
{
    (void)arena;
    #line 212 "iiwa_dnn/schemes/parts.py"
    #line 213 "iiwa_dnn/schemes/parts.py"
    const int64_t n = A.size1;
    #line 214 "iiwa_dnn/schemes/parts.py"
    for (int64_t j = 0; j < b.size0; j++) {
        #line 215 "iiwa_dnn/schemes/parts.py"
        b.data[j] = constants.data[n * b.size0 + j];
        #line 216 "iiwa_dnn/schemes/parts.py"
        for (int64_t i = 0; i < n; i++) {
            #line 217 "iiwa_dnn/schemes/parts.py"
            A.data[j * A.size1 + i] = constants.data[n * j + i];
        }
    }
}

/* Write A (rows, n) and b (rows,) from the constants; for a task in numpy.
 *
 * iiwa_dnn/schemes/parts.py: copy_task */
static inline void schemes_parts_copy_task(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    (void)step;
    (void)target;
    #line 206 "iiwa_dnn/schemes/parts.py"
    #line 207 "iiwa_dnn/schemes/parts.py"
    schemes_parts_copy_rows(arena, constants, A, b);
}

/* Write G (rows, n) and h (rows,), and tighten lb and ub (n,); for a limit in numpy.
 *
 * The constants are the four arrays one after another.
 *
 * iiwa_dnn/schemes/parts.py: copy_limit */
static inline void schemes_parts_copy_limit(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)step;
    #line 224 "iiwa_dnn/schemes/parts.py"
    #line 228 "iiwa_dnn/schemes/parts.py"
    schemes_parts_copy_rows(arena, constants, G, h);
    #line 229 "iiwa_dnn/schemes/parts.py"
    const int64_t n = lb.size0;
    #line 230 "iiwa_dnn/schemes/parts.py"
    const int64_t first = h.size0 * (n + 1);
    #line 231 "iiwa_dnn/schemes/parts.py"
    for (int64_t i = 0; i < n; i++) {
        #line 232 "iiwa_dnn/schemes/parts.py"
        lb.data[i] = double_max(lb.data[i], constants.data[first + i]);
        #line 233 "iiwa_dnn/schemes/parts.py"
        ub.data[i] = double_min(ub.data[i], constants.data[first + n + i]);
    }
}

/* Clip the bounds lb and ub (n,) [rad/s] to those of `MotionLimits`.
 *
 * A bound of another limit that is outside of them is moved to the nearer one; they keep position
 * and velocity limits too. Without a control period there are no bounds. `constants` are a
 * `MotionConstants`. Writes lb, ub, step.lower_kind and step.upper_kind; G and h have no rows.
 *
 * iiwa_dnn/schemes/rate_limits.py: motion_limits */
static inline void schemes_rate_limits_motion_limits(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)G;
    (void)h;
    #line 166 "iiwa_dnn/schemes/rate_limits.py"
    #line 172 "iiwa_dnn/schemes/rate_limits.py"
    if (!(step->rate < INFINITY)) {
        #line 173 "iiwa_dnn/schemes/rate_limits.py"
        return;
    }
    #line 174 "iiwa_dnn/schemes/rate_limits.py"
    const schemes_rate_limits_MotionConstants limits = schemes_rate_limits_MotionConstants_of(constants, int_max(0, (constants.size0 - (4)) / 8));
    #line 175 "iiwa_dnn/schemes/rate_limits.py"
    const double dt = 1.0 / step->rate;
    #line 176 "iiwa_dnn/schemes/rate_limits.py"
    schemes_periods_Periods periods = schemes_periods_constant_periods(arena, dt);
    #line 177 "iiwa_dnn/schemes/rate_limits.py"
    if (limits.at->dt > 0.0) {
        #line 178 "iiwa_dnn/schemes/rate_limits.py"
        periods = (schemes_periods_Periods){limits.at->dt, dt, limits.at->hold, limits.at->longest, limits.at->fraction, true, false};
    }
    #line 179 "iiwa_dnn/schemes/rate_limits.py"
    for (int64_t i = 0, end_i = step->q.size0; i < end_i; i++) {
        #line 180 "iiwa_dnn/schemes/rate_limits.py"
        const double above = limits.upper.data[i] - step->q.data[i];
        #line 181 "iiwa_dnn/schemes/rate_limits.py"
        const double below = step->q.data[i] - limits.lower.data[i];
        #line 182 "iiwa_dnn/schemes/rate_limits.py"
        const schemes_profiles_Rates rates = schemes_rate_limits_joint_rates(arena, &limits, i);
        #line 183 "iiwa_dnn/schemes/rate_limits.py"
        const double_4 own_1 = schemes_viability_joint_bounds(arena, step->last.data[i], step->before.data[i], above, below, &rates, &periods);
        const double lower = own_1.at[0];
        const double upper = own_1.at[1];
        const double lower_kind = own_1.at[2];
        const double upper_kind = own_1.at[3];
        #line 186 "iiwa_dnn/schemes/rate_limits.py"
        step->lower_kind.data[i] = lb.data[i] > upper ? upper_kind : lower_kind;
        #line 187 "iiwa_dnn/schemes/rate_limits.py"
        step->upper_kind.data[i] = ub.data[i] < lower ? lower_kind : upper_kind;
        #line 188 "iiwa_dnn/schemes/rate_limits.py"
        lb.data[i] = double_min(double_max(lb.data[i], lower), upper);
        #line 189 "iiwa_dnn/schemes/rate_limits.py"
        ub.data[i] = double_min(double_max(ub.data[i], lower), upper);
    }
}

/* Update the largest rates at which a joint moves the ends of each pair along its normal.
 *
 * Args:
 *     constants: Constants of the scene, (k,).
 *     jacobian: `Kinematics.jacobian`, (n, 6).
 *     placements: `Kinematics.placements`, (frames, 12).
 *     rates: Largest rates [m/rad], (pairs, 2), raised to those of this posture.
 *
 * iiwa_dnn/schemes/scene.py: raise_end_rates */
static inline void schemes_scene_raise_end_rates(struct arena *arena, Vector constants, Matrix jacobian, Matrix placements, Matrix rates)
{
    const struct arena mark = *arena;
    #line 479 "iiwa_dnn/schemes/scene.py"
    #line 487 "iiwa_dnn/schemes/scene.py"
    const int64_t dof = jacobian.size0;
    #line 488 "iiwa_dnn/schemes/scene.py"
    const schemes_scene_SceneViews scene = schemes_scene_scene_views(arena, constants, dof);
    #line 489 "iiwa_dnn/schemes/scene.py"
    const int64_t own_1 = scene.bodies.size0;
    const int64_t own_2 = 12;
    const Matrix placed = {(double *)arena_empty(arena, own_1 * own_2), own_1, own_2};
    #line 490 "iiwa_dnn/schemes/scene.py"
    schemes_scene_place_bodies(arena, &scene, placements, placed);
    #line 491 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0, end_k = scene.pairs.size0; k < end_k; k++) {
        #line 492 "iiwa_dnn/schemes/scene.py"
        const schemes_scene_Pair pair = schemes_scene_Pair_of((Vector){scene.pairs.data + k * scene.pairs.size1, scene.pairs.size1}, int_max(0, (scene.pairs.size1 - (3)) / 2));
        #line 493 "iiwa_dnn/schemes/scene.py"
        const double_3 normal = schemes_scene_contact_of(arena, &scene, k, placed).normal;
        #line 494 "iiwa_dnn/schemes/scene.py"
        const double_3_2 ends = schemes_scene_ends_of(arena, &scene, placed, (int64_t)pair.at->second);
        #line 495 "iiwa_dnn/schemes/scene.py"
        for (int64_t at = 0; at < 2; at++) {
            #line 496 "iiwa_dnn/schemes/scene.py"
            for (int64_t j = 0; j < dof; j++) {
                #line 497 "iiwa_dnn/schemes/scene.py"
                const double rate = fabs(pair.support.data[j] * schemes_step_rate_along(arena, jacobian, j, ends.at[at], normal));
                #line 498 "iiwa_dnn/schemes/scene.py"
                rates.data[k * rates.size1 + at] = double_max(rates.data[k * rates.size1 + at], rate);
            }
        }
    }
    arena_leave(arena, &mark);
}

/* Write the Jacobian row (n,) of a point's velocity along an axis, relative to the base frame.
 *
 * Args:
 *     step: The instant.
 *     own: Frame that carries the point, and its base frame.
 *     point: The point in the world [m], (3,).
 *     axis: The axis in the world, (3,).
 *     row: The row, (n,), or longer, overwritten.
 *
 * iiwa_dnn/schemes/step.py: write_velocity */
static inline void schemes_step_write_velocity(struct arena *arena, const schemes_step_StepViews *step, const schemes_step_FrameConstants *own, double_3 point, double_3 axis, Vector row)
{
    #line 187 "iiwa_dnn/schemes/step.py"
    #line 196 "iiwa_dnn/schemes/step.py"
    for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
        #line 197 "iiwa_dnn/schemes/step.py"
        const double sign = step->support.data[(int64_t)own->at->frame * step->support.size1 + j] - step->support.data[(int64_t)own->at->relative_to * step->support.size1 + j];
        #line 198 "iiwa_dnn/schemes/step.py"
        row.data[j] = sign * schemes_step_rate_along(arena, step->jacobian, j, point, axis);
    }
}

/* Write the Jacobian row (n,) of a frame's rate about an axis (3,), relative to its base frame.
 *
 * Writes row, of which only the first n numbers if it is longer.
 *
 * iiwa_dnn/schemes/step.py: write_spin */
static inline void schemes_step_write_spin(struct arena *arena, const schemes_step_StepViews *step, const schemes_step_FrameConstants *own, double_3 axis, Vector row)
{
    #line 203 "iiwa_dnn/schemes/step.py"
    #line 207 "iiwa_dnn/schemes/step.py"
    for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
        #line 208 "iiwa_dnn/schemes/step.py"
        const double sign = step->support.data[(int64_t)own->at->frame * step->support.size1 + j] - step->support.data[(int64_t)own->at->relative_to * step->support.size1 + j];
        #line 209 "iiwa_dnn/schemes/step.py"
        row.data[j] = sign * references_rotations_dot(arena, axis, references_rotations_triple(arena, robot_kinematics_Twist_of((Vector){step->jacobian.data + j * step->jacobian.size1, step->jacobian.size1}).angular));
    }
}

/* Write A (3, n) and b (3,) of a frame's position relative to its base frame.
 *
 * `constants` begin with a `FrameConstants`.
 *
 * iiwa_dnn/schemes/tasks.py: position_rows */
static inline void schemes_tasks_position_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    #line 63 "iiwa_dnn/schemes/tasks.py"
    #line 67 "iiwa_dnn/schemes/tasks.py"
    const int64_t own_1 = 3;
    const schemes_step_FrameConstants own = schemes_step_FrameConstants_of((Vector){constants.data, own_1});
    #line 68 "iiwa_dnn/schemes/tasks.py"
    const double gain = double_min(own.at->gain, step->rate);
    #line 69 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement base = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.at->relative_to * step->placements.size1, step->placements.size1});
    #line 70 "iiwa_dnn/schemes/tasks.py"
    const double_3 point = references_rotations_triple(arena, robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.at->frame * step->placements.size1, step->placements.size1}).position);
    #line 71 "iiwa_dnn/schemes/tasks.py"
    const double_3 offset = references_rotations_combined(arena, 1.0, point, -1.0, references_rotations_triple(arena, base.position));
    #line 72 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 73 "iiwa_dnn/schemes/tasks.py"
        const double_3 axis = references_rotations_triple(arena, (Vector){base.axes.data + i * base.axes.size1, base.axes.size1});
        #line 74 "iiwa_dnn/schemes/tasks.py"
        const double missing = target->position.data[i] - references_rotations_dot(arena, axis, offset);
        #line 75 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = target->linear_velocity.data[i] + gain * missing;
        #line 76 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_velocity(arena, step, &own, point, axis, (Vector){A.data + i * A.size1, A.size1});
    }
}

/* Write A (3, n) and b (3,) of a frame's orientation relative to its base frame.
 *
 * `constants` begin with a `FrameConstants`.
 *
 * iiwa_dnn/schemes/tasks.py: rotation_rows */
static inline void schemes_tasks_rotation_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    const struct arena mark = *arena;
    #line 83 "iiwa_dnn/schemes/tasks.py"
    #line 87 "iiwa_dnn/schemes/tasks.py"
    const int64_t own_1 = 3;
    const schemes_step_FrameConstants own = schemes_step_FrameConstants_of((Vector){constants.data, own_1});
    #line 88 "iiwa_dnn/schemes/tasks.py"
    const double gain = double_min(own.at->gain, step->rate);
    #line 89 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement base = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.at->relative_to * step->placements.size1, step->placements.size1});
    #line 90 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement placement = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.at->frame * step->placements.size1, step->placements.size1});
    #line 91 "iiwa_dnn/schemes/tasks.py"
    const Matrix missing = {(double *)arena_empty(arena, 3 * 3), 3, 3};
    #line 92 "iiwa_dnn/schemes/tasks.py"
    const Vector error = {(double *)arena_empty(arena, 3), 3};
    #line 93 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 94 "iiwa_dnn/schemes/tasks.py"
        for (int64_t k = 0; k < 3; k++) {
            #line 95 "iiwa_dnn/schemes/tasks.py"
            const double_3 seen = schemes_step_seen_from(arena, &placement, references_rotations_triple(arena, (Vector){base.axes.data + k * base.axes.size1, base.axes.size1}));
            #line 96 "iiwa_dnn/schemes/tasks.py"
            missing.data[i * missing.size1 + k] = references_rotations_dot(arena, references_rotations_triple(arena, (Vector){target->rotation.data + i * target->rotation.size1, target->rotation.size1}), seen);
        }
    }
    #line 97 "iiwa_dnn/schemes/tasks.py"
    references_rotations_rotation_log(arena, missing, error);
    #line 98 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 3; i++) {
        #line 99 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = target->angular_velocity.data[i] + gain * error.data[i];
        #line 100 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_spin(arena, step, &own, references_rotations_triple(arena, (Vector){base.axes.data + i * base.axes.size1, base.axes.size1}), (Vector){A.data + i * A.size1, A.size1});
    }
    arena_leave(arena, &mark);
}

/* Project b (4,), in place, on the range of the matrix W of `OrientationTask`.
 *
 * Args:
 *     axes: Axes of the frame, one a row, (3, 3).
 *     b: The vector, overwritten.
 *
 * iiwa_dnn/schemes/tasks.py: project_on_range */
static inline void schemes_tasks_project_on_range(struct arena *arena, Matrix axes, Vector b)
{
    const struct arena mark = *arena;
    #line 123 "iiwa_dnn/schemes/tasks.py"
    #line 129 "iiwa_dnn/schemes/tasks.py"
    const double_3 own_1 = references_rotations_triple(arena, (Vector){axes.data + 2 * axes.size1, axes.size1});
    const double x = own_1.at[0];
    const double y = own_1.at[1];
    #line 130 "iiwa_dnn/schemes/tasks.py"
    const double row = sqrt(axes.data[2] * axes.data[2] + axes.data[axes.size1 + 2] * axes.data[axes.size1 + 2]);
    #line 131 "iiwa_dnn/schemes/tasks.py"
    const double column = sqrt(x * x + y * y);
    #line 132 "iiwa_dnn/schemes/tasks.py"
    const Vector normal = {(double *)arena_empty(arena, 4), 4};
    #line 133 "iiwa_dnn/schemes/tasks.py"
    double along = 0.0;
    #line 134 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 4; i++) {
        #line 135 "iiwa_dnn/schemes/tasks.py"
        double first;
        if (row > schemes_tasks_VERTICAL) {
            #line 136 "iiwa_dnn/schemes/tasks.py"
            first = i < 2 ? y : -x;
            #line 137 "iiwa_dnn/schemes/tasks.py"
            const double second = int_remainder(i, 2) == 0 ? -axes.data[axes.size1 + 2] : axes.data[2];
            #line 138 "iiwa_dnn/schemes/tasks.py"
            normal.data[i] = first * second / (row * column);
        } else {
            #line 140 "iiwa_dnn/schemes/tasks.py"
            first = i < 2 ? -axes.data[int_remainder(i, 2) * axes.size1 + 1] : axes.data[int_remainder(i, 2) * axes.size1];
            #line 141 "iiwa_dnn/schemes/tasks.py"
            normal.data[i] = first / sqrt(2.0);
        }
        #line 142 "iiwa_dnn/schemes/tasks.py"
        along += normal.data[i] * b.data[i];
    }
    #line 143 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 4; i++) {
        #line 144 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = row > schemes_tasks_VERTICAL ? b.data[i] - along * normal.data[i] : along * normal.data[i];
    }
    arena_leave(arena, &mark);
}

/* Write A (4, n) and b (4,) of an `OrientationTask` in the form ``block``.
 *
 * iiwa_dnn/schemes/tasks.py: block_rows */
static inline void schemes_tasks_block_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    #line 107 "iiwa_dnn/schemes/tasks.py"
    #line 108 "iiwa_dnn/schemes/tasks.py"
    const schemes_step_FrameConstants own = schemes_step_FrameConstants_of(constants);
    #line 109 "iiwa_dnn/schemes/tasks.py"
    const double gain = double_min(own.at->gain, step->rate);
    #line 110 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement placement = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.at->frame * step->placements.size1, step->placements.size1});
    #line 111 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 4; i++) {
        #line 112 "iiwa_dnn/schemes/tasks.py"
        const double_3 unit = i < 2 ? (double_3){{1.0, 0.0, 0.0}} : (double_3){{0.0, 1.0, 0.0}};
        #line 113 "iiwa_dnn/schemes/tasks.py"
        const double_3 here = references_rotations_triple(arena, (Vector){placement.axes.data + int_remainder(i, 2) * placement.axes.size1, placement.axes.size1});
        #line 114 "iiwa_dnn/schemes/tasks.py"
        const double_3 there = references_rotations_column_of(arena, target->rotation, int_remainder(i, 2));
        #line 115 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = gain * references_rotations_dot(arena, unit, references_rotations_combined(arena, 1.0, there, -1.0, here));
        #line 116 "iiwa_dnn/schemes/tasks.py"
        b.data[i] += references_rotations_dot(arena, references_rotations_cross(arena, there, unit), references_rotations_triple(arena, target->angular_velocity));
        #line 117 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_spin(arena, step, &own, references_rotations_cross(arena, here, unit), (Vector){A.data + i * A.size1, A.size1});
    }
    #line 118 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_project_on_range(arena, placement.axes, b);
}

/* Write A (6, n) and b (6,) of a frame's pose relative to its base frame, position first.
 *
 * iiwa_dnn/schemes/tasks.py: pose_rows */
static inline void schemes_tasks_pose_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    #line 149 "iiwa_dnn/schemes/tasks.py"
    #line 150 "iiwa_dnn/schemes/tasks.py"
    const int64_t half = int_quotient(b.size0, 2);
    #line 151 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_position_rows(arena, step, constants, target, (Matrix){A.data, half, A.size1}, (Vector){b.data, half});
    #line 152 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_rotation_rows(arena, step, constants, target, (Matrix){A.data + half * A.size1, A.size0 - half, A.size1}, (Vector){b.data + half, b.size0 - half});
}

/* Write A (6, n) and b (6,) of a `RelativePoseTask`, whose pose is among the constants.
 *
 * iiwa_dnn/schemes/tasks.py: held_pose_rows */
static inline void schemes_tasks_held_pose_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    (void)target;
    #line 166 "iiwa_dnn/schemes/tasks.py"
    #line 167 "iiwa_dnn/schemes/tasks.py"
    const references_targets_TargetData own_1 = schemes_tasks_HeldPoseConstants_of(constants).pose;
    schemes_tasks_pose_rows(arena, step, constants, &own_1, A, b);
}

/* Write A (2, n) and b (2,) of an `AxisTask`.
 *
 * iiwa_dnn/schemes/tasks.py: axis_rows */
static inline void schemes_tasks_axis_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    #line 361 "iiwa_dnn/schemes/tasks.py"
    #line 362 "iiwa_dnn/schemes/tasks.py"
    const schemes_tasks_AxisConstants own = schemes_tasks_AxisConstants_of(constants);
    #line 363 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement placement = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.task.at->frame * step->placements.size1, step->placements.size1});
    #line 364 "iiwa_dnn/schemes/tasks.py"
    const double_3 axis = references_rotations_triple(arena, own.axis);
    #line 365 "iiwa_dnn/schemes/tasks.py"
    double_3 spin = {{0.0, 0.0, 0.0}};
    #line 366 "iiwa_dnn/schemes/tasks.py"
    double_3 wanted = references_rotations_triple(arena, own.direction);
    #line 367 "iiwa_dnn/schemes/tasks.py"
    if (references_rotations_dot(arena, wanted, wanted) == 0.0) {
        #line 368 "iiwa_dnn/schemes/tasks.py"
        spin = references_rotations_triple(arena, target->angular_velocity);
        #line 369 "iiwa_dnn/schemes/tasks.py"
        const double x = references_rotations_dot(arena, references_rotations_triple(arena, (Vector){target->rotation.data, target->rotation.size1}), axis);
        #line 370 "iiwa_dnn/schemes/tasks.py"
        const double y = references_rotations_dot(arena, references_rotations_triple(arena, (Vector){target->rotation.data + target->rotation.size1, target->rotation.size1}), axis);
        #line 371 "iiwa_dnn/schemes/tasks.py"
        wanted = (double_3){{x, y, references_rotations_dot(arena, references_rotations_triple(arena, (Vector){target->rotation.data + 2 * target->rotation.size1, target->rotation.size1}), axis)}};
    }
    #line 372 "iiwa_dnn/schemes/tasks.py"
    const double_3 here = schemes_step_axis_at(arena, &placement, axis);
    #line 373 "iiwa_dnn/schemes/tasks.py"
    const double_3 turn = references_rotations_cross(arena, here, wanted);
    #line 374 "iiwa_dnn/schemes/tasks.py"
    const double sine = sqrt(references_rotations_dot(arena, turn, turn));
    #line 375 "iiwa_dnn/schemes/tasks.py"
    const double angle = atan2(sine, references_rotations_dot(arena, here, wanted));
    #line 376 "iiwa_dnn/schemes/tasks.py"
    const double factor = sine > 1e-12 ? angle / sine : 1.0;
    #line 377 "iiwa_dnn/schemes/tasks.py"
    const double_3 rate = references_rotations_combined(arena, 1.0, spin, double_min(own.task.at->gain, step->rate) * factor, turn);
    #line 378 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 2; i++) {
        #line 379 "iiwa_dnn/schemes/tasks.py"
        const double_3 normal = schemes_step_axis_at(arena, &placement, references_rotations_triple(arena, (Vector){own.normals.data + i * own.normals.size1, own.normals.size1}));
        #line 380 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = references_rotations_dot(arena, normal, rate);
        #line 381 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_spin(arena, step, &own.task, normal, (Vector){A.data + i * A.size1, A.size1});
    }
}

/* Write A (2, n) and b (2,) of a `RemoteCenterTask`.
 *
 * iiwa_dnn/schemes/tasks.py: remote_center_rows */
static inline void schemes_tasks_remote_center_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    (void)target;
    #line 440 "iiwa_dnn/schemes/tasks.py"
    #line 441 "iiwa_dnn/schemes/tasks.py"
    const schemes_tasks_RemoteCenterConstants own = schemes_tasks_RemoteCenterConstants_of(constants);
    #line 442 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement placement = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.task.at->frame * step->placements.size1, step->placements.size1});
    #line 443 "iiwa_dnn/schemes/tasks.py"
    const robot_kinematics_Placement carrier = robot_kinematics_Placement_of((Vector){step->placements.data + (int64_t)own.task.at->relative_to * step->placements.size1, step->placements.size1});
    #line 444 "iiwa_dnn/schemes/tasks.py"
    const double_3 point = references_rotations_combined(arena, 1.0, references_rotations_triple(arena, carrier.position), 1.0, references_rotations_triple(arena, own.point));
    #line 445 "iiwa_dnn/schemes/tasks.py"
    const double_3 offset = references_rotations_combined(arena, 1.0, point, -1.0, references_rotations_triple(arena, placement.position));
    #line 446 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < 2; i++) {
        #line 447 "iiwa_dnn/schemes/tasks.py"
        const double_3 normal = schemes_step_axis_at(arena, &placement, references_rotations_triple(arena, (Vector){own.normals.data + i * own.normals.size1, own.normals.size1}));
        #line 448 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = double_min(own.task.at->gain, step->rate) * references_rotations_dot(arena, normal, offset);
        #line 449 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_velocity(arena, step, &own.task, point, normal, (Vector){A.data + i * A.size1, A.size1});
    }
}

/* Write A (rows, n) and b (rows,) of a task of joints.
 *
 * iiwa_dnn/schemes/tasks.py: joint_rows */
static inline void schemes_tasks_joint_rows(struct arena *arena, const schemes_step_StepViews *step, Vector constants, const references_targets_TargetData *target, Matrix A, Vector b)
{
    (void)arena;
    (void)target;
    #line 521 "iiwa_dnn/schemes/tasks.py"
    #line 522 "iiwa_dnn/schemes/tasks.py"
    const schemes_tasks_JointConstants own = schemes_tasks_JointConstants_of(constants, b.size0, int_max(0, (constants.size0 - (1 + 1 * (b.size0))) / 1));
    #line 523 "iiwa_dnn/schemes/tasks.py"
    const Matrix C = {own.coefficients.data, b.size0, step->q.size0};
    #line 524 "iiwa_dnn/schemes/tasks.py"
    const double gain = double_min(own.at->gain, step->rate);
    #line 525 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0; i < b.size0; i++) {
        #line 526 "iiwa_dnn/schemes/tasks.py"
        double missing = own.offsets.data[i];
        #line 527 "iiwa_dnn/schemes/tasks.py"
        for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
            #line 528 "iiwa_dnn/schemes/tasks.py"
            A.data[i * A.size1 + j] = C.data[i * C.size1 + j];
            #line 529 "iiwa_dnn/schemes/tasks.py"
            missing -= A.data[i * A.size1 + j] * step->q.data[j];
        }
        #line 530 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = gain * missing;
    }
}

/* Tighten the bounds lb and ub (n,) [rad/s] to those of `TipSpeedLimit`.
 *
 * Without a control period, or for a frame at rest, they stay. `constants` are a
 * `TipSpeedConstants`. Writes lb and ub; G and h have no rows.
 *
 * iiwa_dnn/schemes/tip_speed.py: tip_speed_bounds */
static inline void schemes_tip_speed_tip_speed_bounds(struct arena *arena, const schemes_step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)G;
    (void)h;
    const struct arena mark = *arena;
    #line 35 "iiwa_dnn/schemes/tip_speed.py"
    #line 40 "iiwa_dnn/schemes/tip_speed.py"
    const schemes_tip_speed_TipSpeedConstants own = schemes_tip_speed_TipSpeedConstants_of(constants);
    #line 41 "iiwa_dnn/schemes/tip_speed.py"
    const int64_t frame = (int64_t)own.at->frame;
    #line 42 "iiwa_dnn/schemes/tip_speed.py"
    const double gain = double_min(own.at->gain, step->rate);
    #line 43 "iiwa_dnn/schemes/tip_speed.py"
    const double_3 point = references_rotations_triple(arena, robot_kinematics_Placement_of((Vector){step->placements.data + frame * step->placements.size1, step->placements.size1}).position);
    #line 44 "iiwa_dnn/schemes/tip_speed.py"
    double_3 linear = {{0.0, 0.0, 0.0}};
    #line 45 "iiwa_dnn/schemes/tip_speed.py"
    double_3 angular = {{0.0, 0.0, 0.0}};
    #line 46 "iiwa_dnn/schemes/tip_speed.py"
    double_3 change = {{0.0, 0.0, 0.0}};
    #line 47 "iiwa_dnn/schemes/tip_speed.py"
    for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
        #line 48 "iiwa_dnn/schemes/tip_speed.py"
        const double rate = step->last.data[j] * step->support.data[frame * step->support.size1 + j];
        #line 49 "iiwa_dnn/schemes/tip_speed.py"
        const robot_kinematics_Twist joint = robot_kinematics_Twist_of((Vector){step->jacobian.data + j * step->jacobian.size1, step->jacobian.size1});
        #line 50 "iiwa_dnn/schemes/tip_speed.py"
        const double_3 v = references_rotations_scaled(arena, rate, references_rotations_triple(arena, joint.linear));
        #line 51 "iiwa_dnn/schemes/tip_speed.py"
        const double_3 w = references_rotations_scaled(arena, rate, references_rotations_triple(arena, joint.angular));
        #line 53 "iiwa_dnn/schemes/tip_speed.py"
        const double_3 moved = references_rotations_combined(arena, 1.0, references_rotations_cross(arena, linear, w), 1.0, references_rotations_cross(arena, angular, v));
        #line 54 "iiwa_dnn/schemes/tip_speed.py"
        const double_3 turned = references_rotations_cross(arena, references_rotations_cross(arena, angular, w), point);
        #line 55 "iiwa_dnn/schemes/tip_speed.py"
        change = references_rotations_combined(arena, 1.0, change, 1.0, references_rotations_combined(arena, 1.0, moved, 1.0, turned));
        #line 56 "iiwa_dnn/schemes/tip_speed.py"
        linear = references_rotations_combined(arena, 1.0, linear, 1.0, v);
        #line 57 "iiwa_dnn/schemes/tip_speed.py"
        angular = references_rotations_combined(arena, 1.0, angular, 1.0, w);
    }
    #line 58 "iiwa_dnn/schemes/tip_speed.py"
    const double_3 velocity = references_rotations_combined(arena, 1.0, linear, 1.0, references_rotations_cross(arena, angular, point));
    #line 59 "iiwa_dnn/schemes/tip_speed.py"
    change = references_rotations_combined(arena, 1.0, change, 1.0, references_rotations_cross(arena, angular, velocity));
    #line 60 "iiwa_dnn/schemes/tip_speed.py"
    const double speed = sqrt(references_rotations_dot(arena, velocity, velocity));
    #line 61 "iiwa_dnn/schemes/tip_speed.py"
    if (!(speed > 0.0 && step->rate < INFINITY)) {
        #line 62 "iiwa_dnn/schemes/tip_speed.py"
        arena_leave(arena, &mark);
        return;
    }
    #line 63 "iiwa_dnn/schemes/tip_speed.py"
    const double_3 direction = references_rotations_scaled(arena, 1.0 / speed, velocity);
    #line 64 "iiwa_dnn/schemes/tip_speed.py"
    const Vector along = {(double *)arena_empty(arena, step->q.size0), step->q.size0};
    #line 65 "iiwa_dnn/schemes/tip_speed.py"
    double total = 0.0;
    #line 66 "iiwa_dnn/schemes/tip_speed.py"
    for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
        #line 67 "iiwa_dnn/schemes/tip_speed.py"
        along.data[j] = step->support.data[frame * step->support.size1 + j] * schemes_step_rate_along(arena, step->jacobian, j, point, direction);
        #line 68 "iiwa_dnn/schemes/tip_speed.py"
        total += fabs(along.data[j]);
    }
    #line 69 "iiwa_dnn/schemes/tip_speed.py"
    const double added = double_max(references_rotations_dot(arena, direction, change), 0.0);
    #line 70 "iiwa_dnn/schemes/tip_speed.py"
    const double growth = (gain * (own.at->limit - speed) - added) / (step->rate * total);
    #line 71 "iiwa_dnn/schemes/tip_speed.py"
    for (int64_t j = 0, end_j = step->q.size0; j < end_j; j++) {
        #line 72 "iiwa_dnn/schemes/tip_speed.py"
        if (along.data[j] > schemes_tip_speed_NEGLIGIBLE) {
            #line 73 "iiwa_dnn/schemes/tip_speed.py"
            ub.data[j] = double_max(double_min(ub.data[j], step->last.data[j] + growth), lb.data[j]);
        } else {
            #line 74 "iiwa_dnn/schemes/tip_speed.py"
            if (along.data[j] < -schemes_tip_speed_NEGLIGIBLE) {
                #line 75 "iiwa_dnn/schemes/tip_speed.py"
                lb.data[j] = double_min(double_max(lb.data[j], step->last.data[j] - growth), ub.data[j]);
            }
        }
    }
    arena_leave(arena, &mark);
}

/* The arena of each thread, made at its first call. */
static _Thread_local _Alignas(16) char arena_memory[1 << 18];
static _Thread_local struct arena arena_own;

static inline struct arena *arena_here(void)
{
    if (!arena_own.end) {
        arena_own.top = arena_memory;
        arena_own.end = arena_memory + sizeof arena_memory;
    }
    return &arena_own;
}

/* Set where a function of a user's, written in Python, has raised an error. */
static int64_t failed;

static int raise_failure(void)
{
    PyObject *library = PyImport_ImportModule("iiwa_dnn.compiling.library");
    PyObject *done = library ? PyObject_CallMethod(library, "raise_failure", NULL) : NULL;
    Py_XDECREF(library);
    Py_XDECREF(done);
    return done == NULL;
}

static inline bool counted(const char *name, Py_ssize_t count, Py_ssize_t expected)
{
    if (count == expected) return true;
    PyErr_Format(PyExc_TypeError, "%s takes %zd arguments, not %zd", name, expected, count);
    return false;
}

static inline void *read_array(
    PyObject *object, int axes, int type, const char *word, int64_t *size, bool writes)
{
    PyArrayObject *array = (PyArrayObject *)object;
    if (!PyArray_Check(object) || PyArray_NDIM(array) != axes || PyArray_TYPE(array) != type
        || !PyArray_IS_C_CONTIGUOUS(array) || !PyArray_ISALIGNED(array)) {
        PyErr_Format(PyExc_TypeError, "%R is no array of %s of %d axes without gaps", object, word, axes);
        return NULL;
    }
    if (writes && !PyArray_ISWRITEABLE(array)) {
        PyErr_SetString(PyExc_TypeError, "an array that is written into is read-only");
        return NULL;
    }
    for (int i = 0; i < axes; i++) size[i] = PyArray_DIM(array, i);
    return PyArray_DATA(array);
}

static inline double *read_doubles(PyObject *object, int axes, int64_t *size, bool writes)
{
    return read_array(object, axes, NPY_DOUBLE, "float64", size, writes);
}

static inline bool has_size(const char *record, int64_t size, int64_t fixed, int64_t shared)
{
    const int64_t rest = size - fixed;
    if (rest >= 0 && (shared ? rest % shared == 0 : rest == 0)) return true;
    PyErr_Format(PyExc_ValueError, "an array of %lld numbers is no %s", (long long)size, record);
    return false;
}

static inline int64_t *read_ints(PyObject *object, int axes, int64_t *size, bool writes)
{
    return read_array(object, axes, NPY_INT64, "int64", size, writes);
}

static inline bool read_double(PyObject *object, double *value)
{
    *value = PyFloat_AsDouble(object);
    return *value != -1.0 || !PyErr_Occurred();
}

static inline bool read_int(PyObject *object, int64_t *value)
{
    *value = PyLong_AsLongLong(object);
    return *value != -1 || !PyErr_Occurred();
}

static inline bool read_bool(PyObject *object, bool *value)
{
    const int is_true = PyObject_IsTrue(object);
    *value = is_true > 0;
    return is_true >= 0;
}

static inline bool is_tuple(PyObject *object, Py_ssize_t size)
{
    if (PyTuple_Check(object) && PyTuple_GET_SIZE(object) == size) return true;
    PyErr_Format(PyExc_TypeError, "%R is no tuple of %zd", object, size);
    return false;
}

/* Whether a tuple is the one that was read last: then its struct is that of then. */
static inline bool is_seen(PyObject *object, PyObject **seen, void *value, const void *kept, size_t size)
{
    if (object != *seen) return false;
    memcpy(value, kept, size);
    return true;
}

static inline bool keep(PyObject *object, PyObject **seen, const void *value, void *kept, size_t size)
{
    PyObject *before = *seen;
    memcpy(kept, value, size);
    *seen = Py_NewRef(object);
    Py_XDECREF(before);
    return true;
}


struct kernel { const char *name; void *address; const char *code; };

static PyObject *py_compiling_trigonometry_sin_cos(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_angle;
    if (!counted("compiling_trigonometry_sin_cos", count, 1) || !read_double(given[0], &a_angle)) return NULL;
    double_2 result;
    (void)self;
    result = compiling_trigonometry_sin_cos(arena_here(), a_angle);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_compiling_trigonometry_sin(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_angle;
    if (!counted("compiling_trigonometry_sin", count, 1) || !read_double(given[0], &a_angle)) return NULL;
    double result;
    (void)self;
    result = compiling_trigonometry_sin(arena_here(), a_angle);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_layout_copied(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_out;
    Vector a_values;
    if (!counted("qp_layout_copied", count, 2) || !((a_out.data = read_doubles(given[0], 1, &a_out.size0, true))) || !((a_values.data = read_doubles(given[1], 1, &a_values.size0, false)))) return NULL;

    (void)self;
    qp_layout_copied(arena_here(), a_out, a_values);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_arms_rest_arm(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    Vector a_q;
    if (!counted("control_arms_rest_arm", count, 3) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, true))) || !((a_q.data = read_doubles(given[2], 1, &a_q.size0, false)))) return NULL;

    (void)self;
    control_arms_rest_arm(arena_here(), &a_plan, a_memory, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_arms_place_arm(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    Matrix a_centers;
    if (!counted("control_arms_place_arm", count, 3) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, true))) || !((a_centers.data = read_doubles(given[2], 2, &a_centers.size0, false)))) return NULL;

    (void)self;
    control_arms_place_arm(arena_here(), &a_plan, a_memory, a_centers);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_arms_halt_arm(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    if (!counted("control_arms_halt_arm", count, 2) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, false)))) return NULL;

    (void)self;
    control_arms_halt_arm(arena_here(), &a_plan, a_memory);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_arms_send_arm(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    Vector a_dq;
    double a_period;
    if (!counted("control_arms_send_arm", count, 4) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, true))) || !((a_dq.data = read_doubles(given[2], 1, &a_dq.size0, false))) || !read_double(given[3], &a_period)) return NULL;

    (void)self;
    control_arms_send_arm(arena_here(), &a_plan, a_memory, a_dq, a_period);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_all_finite(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_start;
    int64_t a_end;
    if (!counted("qp_dense_all_finite", count, 3) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_start) || !read_int(given[2], &a_end)) return NULL;
    bool result;
    (void)self;
    result = qp_dense_all_finite(arena_here(), a_data, a_start, a_end);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_arms_differing(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_values;
    Vector a_others;
    if (!counted("control_arms_differing", count, 2) || !((a_values.data = read_doubles(given[0], 1, &a_values.size0, false))) || !((a_others.data = read_doubles(given[1], 1, &a_others.size0, false)))) return NULL;
    int64_t result;
    (void)self;
    result = control_arms_differing(arena_here(), a_values, a_others);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_arms_begin_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    control_arms_ArmInput a_inputs;
    if (!counted("control_arms_begin_step", count, 3) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, true))) || !is_tuple(given[2], 5) || !((a_inputs.q.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_inputs.q.size0, false))) || !read_int(PyTuple_GET_ITEM(given[2], 1), &a_inputs.kind) || !((a_inputs.request.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_inputs.request.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 3), &a_inputs.dt) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_inputs.elapsed)) return NULL;
    bool result;
    (void)self;
    result = control_arms_begin_step(arena_here(), &a_plan, a_memory, &a_inputs);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_robot_kinematics_kernel_turn_into(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_axes;
    Vector a_v;
    Vector a_turned;
    if (!counted("robot_kinematics_kernel_turn_into", count, 3) || !((a_axes.data = read_doubles(given[0], 2, &a_axes.size0, false))) || !((a_v.data = read_doubles(given[1], 1, &a_v.size0, false))) || !((a_turned.data = read_doubles(given[2], 1, &a_turned.size0, true)))) return NULL;

    (void)self;
    robot_kinematics_kernel_turn_into(arena_here(), a_axes, a_v, a_turned);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_compose(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_Placement a_first;
    robot_kinematics_Placement a_second;
    robot_kinematics_Placement a_product;
    if (!counted("robot_kinematics_kernel_compose", count, 3) || !((a_first.numbers.data = read_doubles(given[0], 1, &a_first.numbers.size0, false))) || !has_size("robot_kinematics_Placement", a_first.numbers.size0, 12, 0) || ((a_first = robot_kinematics_Placement_of(a_first.numbers)), false) || !((a_second.numbers.data = read_doubles(given[1], 1, &a_second.numbers.size0, false))) || !has_size("robot_kinematics_Placement", a_second.numbers.size0, 12, 0) || ((a_second = robot_kinematics_Placement_of(a_second.numbers)), false) || !((a_product.numbers.data = read_doubles(given[2], 1, &a_product.numbers.size0, true))) || !has_size("robot_kinematics_Placement", a_product.numbers.size0, 12, 0) || ((a_product = robot_kinematics_Placement_of(a_product.numbers)), false)) return NULL;

    (void)self;
    robot_kinematics_kernel_compose(arena_here(), &a_first, &a_second, &a_product);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_move(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_Placement a_start;
    double a_slides;
    double a_q;
    robot_kinematics_Placement a_moved;
    if (!counted("robot_kinematics_kernel_move", count, 4) || !((a_start.numbers.data = read_doubles(given[0], 1, &a_start.numbers.size0, false))) || !has_size("robot_kinematics_Placement", a_start.numbers.size0, 12, 0) || ((a_start = robot_kinematics_Placement_of(a_start.numbers)), false) || !read_double(given[1], &a_slides) || !read_double(given[2], &a_q) || !((a_moved.numbers.data = read_doubles(given[3], 1, &a_moved.numbers.size0, true))) || !has_size("robot_kinematics_Placement", a_moved.numbers.size0, 12, 0) || ((a_moved = robot_kinematics_Placement_of(a_moved.numbers)), false)) return NULL;

    (void)self;
    robot_kinematics_kernel_move(arena_here(), &a_start, a_slides, a_q, &a_moved);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_write_twist(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_Placement a_placement;
    int64_t a_axis;
    double a_slides;
    robot_kinematics_Twist a_twist;
    if (!counted("robot_kinematics_kernel_write_twist", count, 4) || !((a_placement.numbers.data = read_doubles(given[0], 1, &a_placement.numbers.size0, false))) || !has_size("robot_kinematics_Placement", a_placement.numbers.size0, 12, 0) || ((a_placement = robot_kinematics_Placement_of(a_placement.numbers)), false) || !read_int(given[1], &a_axis) || !read_double(given[2], &a_slides) || !((a_twist.numbers.data = read_doubles(given[3], 1, &a_twist.numbers.size0, true))) || !has_size("robot_kinematics_Twist", a_twist.numbers.size0, 6, 0) || ((a_twist = robot_kinematics_Twist_of(a_twist.numbers)), false)) return NULL;

    (void)self;
    robot_kinematics_kernel_write_twist(arena_here(), &a_placement, a_axis, a_slides, &a_twist);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_write_inertia(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_kernel_ModelTables a_model;
    Matrix a_placed;
    Matrix a_jacobian;
    Matrix a_inertia;
    if (!counted("robot_kinematics_kernel_write_inertia", count, 4) || !is_tuple(given[0], 9) || !((a_model.parents.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 1, &a_model.parents.size0, false))) || !((a_model.joints.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 2, &a_model.joints.size0, false))) || !((a_model.slides.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_model.slides.size0, false))) || !((a_model.frames.data = read_ints(PyTuple_GET_ITEM(given[0], 3), 1, &a_model.frames.size0, false))) || !((a_model.carriers.data = read_ints(PyTuple_GET_ITEM(given[0], 4), 1, &a_model.carriers.size0, false))) || !((a_model.offsets.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_model.offsets.size0, false))) || !((a_model.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_model.bodies.size0, false))) || !((a_model.supports.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_model.supports.size0, false))) || !((a_model.armature.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_model.armature.size0, false))) || !((a_placed.data = read_doubles(given[1], 2, &a_placed.size0, false))) || !((a_jacobian.data = read_doubles(given[2], 2, &a_jacobian.size0, false))) || !((a_inertia.data = read_doubles(given[3], 2, &a_inertia.size0, true)))) return NULL;

    (void)self;
    robot_kinematics_kernel_write_inertia(arena_here(), &a_model, a_placed, a_jacobian, a_inertia);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_write_kinematics(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_kernel_ModelTables a_model;
    Vector a_q;
    Matrix a_jacobian;
    Matrix a_placements;
    Matrix a_inertia;
    if (!counted("robot_kinematics_kernel_write_kinematics", count, 5) || !is_tuple(given[0], 9) || !((a_model.parents.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 1, &a_model.parents.size0, false))) || !((a_model.joints.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 2, &a_model.joints.size0, false))) || !((a_model.slides.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_model.slides.size0, false))) || !((a_model.frames.data = read_ints(PyTuple_GET_ITEM(given[0], 3), 1, &a_model.frames.size0, false))) || !((a_model.carriers.data = read_ints(PyTuple_GET_ITEM(given[0], 4), 1, &a_model.carriers.size0, false))) || !((a_model.offsets.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_model.offsets.size0, false))) || !((a_model.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_model.bodies.size0, false))) || !((a_model.supports.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_model.supports.size0, false))) || !((a_model.armature.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_model.armature.size0, false))) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_jacobian.data = read_doubles(given[2], 2, &a_jacobian.size0, true))) || !((a_placements.data = read_doubles(given[3], 2, &a_placements.size0, true))) || !((a_inertia.data = read_doubles(given[4], 2, &a_inertia.size0, true)))) return NULL;

    (void)self;
    robot_kinematics_kernel_write_kinematics(arena_here(), &a_model, a_q, a_jacobian, a_placements, a_inertia);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_layout_data_size(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("qp_layout_data_size", count, 3) || !read_int(given[0], &a_n) || !read_int(given[1], &a_m) || !read_int(given[2], &a_p)) return NULL;
    int64_t result;
    (void)self;
    result = qp_layout_data_size(arena_here(), a_n, a_m, a_p);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_command_log_sizes(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_program_ProgramSizes a_sizes;
    if (!counted("control_command_log_sizes", count, 1) || !is_tuple(given[0], 6) || !read_int(PyTuple_GET_ITEM(given[0], 0), &a_sizes.n) || !read_int(PyTuple_GET_ITEM(given[0], 1), &a_sizes.m) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_sizes.p) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_sizes.joints) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_sizes.pairs) || !read_int(PyTuple_GET_ITEM(given[0], 5), &a_sizes.frames)) return NULL;
    int_6 result;
    (void)self;
    result = control_command_log_sizes(arena_here(), &a_sizes);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNNN)", PyLong_FromLongLong(result.at[0]), PyLong_FromLongLong(result.at[1]), PyLong_FromLongLong(result.at[2]), PyLong_FromLongLong(result.at[3]), PyLong_FromLongLong(result.at[4]), PyLong_FromLongLong(result.at[5]));
}
static PyObject *py_qp_layout_larger(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_largest;
    double a_value;
    if (!counted("qp_layout_larger", count, 2) || !read_double(given[0], &a_largest) || !read_double(given[1], &a_value)) return NULL;
    double result;
    (void)self;
    result = qp_layout_larger(arena_here(), a_largest, a_value);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_dense_largest_entry(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_values;
    if (!counted("qp_dense_largest_entry", count, 1) || !((a_values.data = read_doubles(given[0], 1, &a_values.size0, false)))) return NULL;
    double result;
    (void)self;
    result = qp_dense_largest_entry(arena_here(), a_values);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_profiles_usable_jerk(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_profiles_Rates a_rates;
    double a_period;
    if (!counted("schemes_profiles_usable_jerk", count, 2) || !is_tuple(given[0], 6) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[0], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[0], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[0], 5), &a_rates.lag) || !read_double(given[1], &a_period)) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_usable_jerk(arena_here(), &a_rates, a_period);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_profiles_approach(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_distance;
    bool a_vary;
    if (!counted("schemes_profiles_approach", count, 2) || !read_double(given[0], &a_distance) || !read_bool(given[1], &a_vary)) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_approach(arena_here(), a_distance, a_vary);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_profiles_stopping_distance(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_v;
    double a_a;
    double a_J;
    double a_A;
    if (!counted("schemes_profiles_stopping_distance", count, 4) || !read_double(given[0], &a_v) || !read_double(given[1], &a_a) || !read_double(given[2], &a_J) || !read_double(given[3], &a_A)) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_stopping_distance(arena_here(), a_v, a_a, a_J, a_A);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_profiles_highest(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_v;
    double a_last;
    schemes_periods_Periods a_periods;
    double_3 a_profile;
    if (!counted("schemes_profiles_highest", count, 4) || !read_double(given[0], &a_v) || !read_double(given[1], &a_last) || !is_tuple(given[2], 7) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[2], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[2], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_periods.exceeded) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_profile.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_profile.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_profile.at[2])) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_highest(arena_here(), a_v, a_last, &a_periods, a_profile);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_viability_ceiling(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_lb;
    double a_ub;
    double a_end;
    double a_last;
    schemes_periods_Periods a_periods;
    double_3 a_profile;
    if (!counted("schemes_viability_ceiling", count, 6) || !read_double(given[0], &a_lb) || !read_double(given[1], &a_ub) || !read_double(given[2], &a_end) || !read_double(given[3], &a_last) || !is_tuple(given[4], 7) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[4], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[4], 6), &a_periods.exceeded) || !is_tuple(given[5], 3) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_profile.at[0]) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_profile.at[1]) || !read_double(PyTuple_GET_ITEM(given[5], 2), &a_profile.at[2])) return NULL;
    double result;
    (void)self;
    result = schemes_viability_ceiling(arena_here(), a_lb, a_ub, a_end, a_last, &a_periods, a_profile);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_viability_ceiling_below_velocity_limit(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_lb;
    double a_ub;
    double a_distance;
    double a_last;
    schemes_profiles_Rates a_rates;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_viability_ceiling_below_velocity_limit", count, 6) || !read_double(given[0], &a_lb) || !read_double(given[1], &a_ub) || !read_double(given[2], &a_distance) || !read_double(given[3], &a_last) || !is_tuple(given[4], 6) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[4], 5), &a_rates.lag) || !is_tuple(given[5], 7) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[5], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[5], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[5], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[5], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[5], 6), &a_periods.exceeded)) return NULL;
    double result;
    (void)self;
    result = schemes_viability_ceiling_below_velocity_limit(arena_here(), a_lb, a_ub, a_distance, a_last, &a_rates, &a_periods);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_profiles_easing(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_distance;
    double a_hold;
    if (!counted("schemes_profiles_easing", count, 2) || !read_double(given[0], &a_distance) || !read_double(given[1], &a_hold)) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_easing(arena_here(), a_distance, a_hold);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_viability_rate_kind(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_bound;
    double a_speed;
    double a_quickest;
    double a_other;
    if (!counted("schemes_viability_rate_kind", count, 4) || !read_double(given[0], &a_bound) || !read_double(given[1], &a_speed) || !read_double(given[2], &a_quickest) || !read_double(given[3], &a_other)) return NULL;
    double result;
    (void)self;
    result = schemes_viability_rate_kind(arena_here(), a_bound, a_speed, a_quickest, a_other);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_viability_position_kind(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_profiles_Rates a_rates;
    if (!counted("schemes_viability_position_kind", count, 1) || !is_tuple(given[0], 6) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[0], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[0], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[0], 5), &a_rates.lag)) return NULL;
    double result;
    (void)self;
    result = schemes_viability_position_kind(arena_here(), &a_rates);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_viability_jerk_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_before;
    double a_above;
    double a_below;
    schemes_profiles_Rates a_rates;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_viability_jerk_bounds", count, 6) || !read_double(given[0], &a_last) || !read_double(given[1], &a_before) || !read_double(given[2], &a_above) || !read_double(given[3], &a_below) || !is_tuple(given[4], 6) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[4], 5), &a_rates.lag) || !is_tuple(given[5], 7) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[5], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[5], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[5], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[5], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[5], 6), &a_periods.exceeded)) return NULL;
    double_4 result;
    (void)self;
    result = schemes_viability_jerk_bounds(arena_here(), a_last, a_before, a_above, a_below, &a_rates, &a_periods);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]));
}
static PyObject *py_schemes_viability_speed_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_distance;
    schemes_profiles_Rates a_rates;
    double a_hold;
    if (!counted("schemes_viability_speed_within", count, 3) || !read_double(given[0], &a_distance) || !is_tuple(given[1], 6) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[1], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[1], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[1], 5), &a_rates.lag) || !read_double(given[2], &a_hold)) return NULL;
    double result;
    (void)self;
    result = schemes_viability_speed_within(arena_here(), a_distance, &a_rates, a_hold);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_viability_acceleration_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_above;
    double a_below;
    schemes_profiles_Rates a_rates;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_viability_acceleration_bounds", count, 5) || !read_double(given[0], &a_last) || !read_double(given[1], &a_above) || !read_double(given[2], &a_below) || !is_tuple(given[3], 6) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[3], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[3], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[3], 5), &a_rates.lag) || !is_tuple(given[4], 7) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[4], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[4], 6), &a_periods.exceeded)) return NULL;
    double_4 result;
    (void)self;
    result = schemes_viability_acceleration_bounds(arena_here(), a_last, a_above, a_below, &a_rates, &a_periods);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]));
}
static PyObject *py_schemes_viability_joint_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_before;
    double a_above;
    double a_below;
    schemes_profiles_Rates a_rates;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_viability_joint_bounds", count, 6) || !read_double(given[0], &a_last) || !read_double(given[1], &a_before) || !read_double(given[2], &a_above) || !read_double(given[3], &a_below) || !is_tuple(given[4], 6) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[4], 5), &a_rates.lag) || !is_tuple(given[5], 7) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[5], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[5], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[5], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[5], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[5], 6), &a_periods.exceeded)) return NULL;
    double_4 result;
    (void)self;
    result = schemes_viability_joint_bounds(arena_here(), a_last, a_before, a_above, a_below, &a_rates, &a_periods);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]));
}
static PyObject *py_schemes_profiles_arriving(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_before;
    double a_left;
    double a_wanted;
    schemes_profiles_Rates a_rates;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_profiles_arriving", count, 6) || !read_double(given[0], &a_last) || !read_double(given[1], &a_before) || !read_double(given[2], &a_left) || !read_double(given[3], &a_wanted) || !is_tuple(given[4], 6) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_rates.velocity) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_rates.acceleration) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_rates.jerk) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_rates.deceleration) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_rates.slope) || !read_double(PyTuple_GET_ITEM(given[4], 5), &a_rates.lag) || !is_tuple(given[5], 7) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[5], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[5], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[5], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[5], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[5], 6), &a_periods.exceeded)) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_arriving(arena_here(), a_last, a_before, a_left, a_wanted, &a_rates, &a_periods);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_profiles_braking(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_lb;
    double a_ub;
    double a_jerk;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_profiles_braking", count, 5) || !read_double(given[0], &a_last) || !read_double(given[1], &a_lb) || !read_double(given[2], &a_ub) || !read_double(given[3], &a_jerk) || !is_tuple(given[4], 7) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[4], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[4], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[4], 6), &a_periods.exceeded)) return NULL;
    double result;
    (void)self;
    result = schemes_profiles_braking(arena_here(), a_last, a_lb, a_ub, a_jerk, &a_periods);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_references_base_enter_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_base_enter_path", count, 4) || !read_int(given[0], &a_address) || !read_double(given[1], &a_t) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[3], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_base_enter_path(arena_here(), a_address, a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_rotations_dot(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_u;
    double_3 a_v;
    if (!counted("references_rotations_dot", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_u.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double result;
    (void)self;
    result = references_rotations_dot(arena_here(), a_u, a_v);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_references_rotations_triple(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_v;
    if (!counted("references_rotations_triple", count, 1) || !((a_v.data = read_doubles(given[0], 1, &a_v.size0, false)))) return NULL;
    double_3 result;
    (void)self;
    result = references_rotations_triple(arena_here(), a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_rotation_log(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_R;
    Vector a_out;
    if (!counted("references_rotations_rotation_log", count, 2) || !((a_R.data = read_doubles(given[0], 2, &a_R.size0, false))) || !((a_out.data = read_doubles(given[1], 1, &a_out.size0, true)))) return NULL;

    (void)self;
    references_rotations_rotation_log(arena_here(), a_R, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_rotations_set_mean_twist(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    references_targets_TargetData a_now;
    references_targets_TargetData a_then;
    double a_dt;
    if (!counted("references_rotations_set_mean_twist", count, 3) || !((a_now.numbers.data = read_doubles(given[0], 1, &a_now.numbers.size0, true))) || !has_size("references_targets_TargetData", a_now.numbers.size0, 18, 0) || ((a_now = references_targets_TargetData_of(a_now.numbers)), false) || !((a_then.numbers.data = read_doubles(given[1], 1, &a_then.numbers.size0, false))) || !has_size("references_targets_TargetData", a_then.numbers.size0, 18, 0) || ((a_then = references_targets_TargetData_of(a_then.numbers)), false) || !read_double(given[2], &a_dt)) return NULL;

    (void)self;
    references_rotations_set_mean_twist(arena_here(), &a_now, &a_then, a_dt);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_cycle_sample_targets(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_cycle_Paths a_paths;
    double a_t;
    double a_dt;
    Matrix a_targets;
    if (!counted("control_cycle_sample_targets", count, 4) || !is_tuple(given[0], 2) || !((a_paths.table.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 2, &a_paths.table.size0, false))) || !((a_paths.constants.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_paths.constants.size0, false))) || !read_double(given[1], &a_t) || !read_double(given[2], &a_dt) || !((a_targets.data = read_doubles(given[3], 2, &a_targets.size0, true)))) return NULL;

    (void)self;
    control_cycle_sample_targets(arena_here(), &a_paths, a_t, a_dt, a_targets);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_cycle_is_valid(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_q;
    Vector a_data;
    int64_t a_targets;
    if (!counted("control_cycle_is_valid", count, 4) || !read_double(given[0], &a_t) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_data.data = read_doubles(given[2], 1, &a_data.size0, false))) || !read_int(given[3], &a_targets)) return NULL;
    bool result;
    (void)self;
    result = control_cycle_is_valid(arena_here(), a_t, a_q, a_data, a_targets);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_schemes_rate_limits_state_periods(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_rate_limits_MotionConstants a_limits;
    schemes_periods_Periods a_periods;
    if (!counted("schemes_rate_limits_state_periods", count, 2) || !((a_limits.numbers.data = read_doubles(given[0], 1, &a_limits.numbers.size0, true))) || !has_size("schemes_rate_limits_MotionConstants", a_limits.numbers.size0, 4, 8) || ((a_limits = schemes_rate_limits_MotionConstants_of(a_limits.numbers, (a_limits.numbers.size0 - 4) / 8)), false) || !is_tuple(given[1], 7) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_periods.dt) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_periods.expected) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_periods.hold) || !read_double(PyTuple_GET_ITEM(given[1], 3), &a_periods.longest) || !read_double(PyTuple_GET_ITEM(given[1], 4), &a_periods.fraction) || !read_bool(PyTuple_GET_ITEM(given[1], 5), &a_periods.vary) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_periods.exceeded)) return NULL;

    (void)self;
    schemes_rate_limits_state_periods(arena_here(), &a_limits, &a_periods);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_layout_offsets(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("qp_layout_offsets", count, 3) || !read_int(given[0], &a_n) || !read_int(given[1], &a_m) || !read_int(given[2], &a_p)) return NULL;
    int_4 result;
    (void)self;
    result = qp_layout_offsets(arena_here(), a_n, a_m, a_p);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyLong_FromLongLong(result.at[0]), PyLong_FromLongLong(result.at[1]), PyLong_FromLongLong(result.at[2]), PyLong_FromLongLong(result.at[3]));
}
static PyObject *py_schemes_parts_enter_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_parts_enter_cost", count, 5) || !read_int(given[0], &a_address) || !is_tuple(given[1], 13) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[1], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[1], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[1], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[1], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[3], 2, &a_P.size0, false))) || !((a_q.data = read_doubles(given[4], 1, &a_q.size0, false)))) return NULL;

    (void)self;
    schemes_parts_enter_cost(arena_here(), a_address, &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_enter_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_parts_enter_task", count, 6) || !read_int(given[0], &a_address) || !is_tuple(given[1], 13) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[1], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[1], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[1], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[1], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[3], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[4], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[5], 1, &a_b.size0, false)))) return NULL;

    (void)self;
    schemes_parts_enter_task(arena_here(), a_address, &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_program_add_soft(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_P;
    Vector a_q;
    Matrix a_A;
    Vector a_b;
    double a_weight;
    if (!counted("schemes_program_add_soft", count, 5) || !((a_P.data = read_doubles(given[0], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, true))) || !((a_A.data = read_doubles(given[2], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[3], 1, &a_b.size0, false))) || !read_double(given[4], &a_weight)) return NULL;

    (void)self;
    schemes_program_add_soft(arena_here(), a_P, a_q, a_A, a_b, a_weight);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_enter_limit(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_parts_enter_limit", count, 7) || !read_int(given[0], &a_address) || !is_tuple(given[1], 13) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[1], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[1], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[1], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[1], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[3], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[4], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[5], 1, &a_lb.size0, false))) || !((a_ub.data = read_doubles(given[6], 1, &a_ub.size0, false)))) return NULL;

    (void)self;
    schemes_parts_enter_limit(arena_here(), a_address, &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_program_keep_kinds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_bounds;
    Vector a_before;
    Vector a_kinds;
    Vector a_others;
    if (!counted("schemes_program_keep_kinds", count, 4) || !((a_bounds.data = read_doubles(given[0], 1, &a_bounds.size0, false))) || !((a_before.data = read_doubles(given[1], 1, &a_before.size0, false))) || !((a_kinds.data = read_doubles(given[2], 1, &a_kinds.size0, true))) || !((a_others.data = read_doubles(given[3], 1, &a_others.size0, false)))) return NULL;

    (void)self;
    schemes_program_keep_kinds(arena_here(), a_bounds, a_before, a_kinds, a_others);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_program_assemble(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    schemes_program_ProgramArrays a_arrays;
    schemes_step_StepViews a_step;
    if (!counted("schemes_program_assemble", count, 3) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, true))) || !is_tuple(given[1], 8) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), &a_arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), &a_arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), &a_arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 3), &a_arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 4), &a_arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 5), &a_arrays.sizes.frames) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 1), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.placements.size0, false))) || !((a_arrays.support.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.support.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(given[1], 7), &a_arrays.tip) || !is_tuple(given[2], 13) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[2], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[2], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[2], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[2], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[2], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[2], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[2], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[2], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[2], 11), 1, &a_step.lower_kind.size0, true))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[2], 12), 1, &a_step.upper_kind.size0, true)))) return NULL;

    (void)self;
    schemes_program_assemble(arena_here(), a_data, &a_arrays, &a_step);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_integrators_base_enter_answer(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    qp_layout_QPViews a_qp;
    int64_t a_rates;
    networks_integrators_base_AnswerSettings a_settings;
    Vector a_state;
    Vector a_point;
    if (!counted("networks_integrators_base_enter_answer", count, 6) || !read_int(given[0], &a_address) || !is_tuple(given[1], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[2], &a_rates) || !((a_settings.numbers.data = read_doubles(given[3], 1, &a_settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_settings.numbers.size0, 4, 1) || ((a_settings = networks_integrators_base_AnswerSettings_of(a_settings.numbers, (a_settings.numbers.size0 - 4) / 1)), false) || !((a_state.data = read_doubles(given[4], 1, &a_state.size0, false))) || !((a_point.data = read_doubles(given[5], 1, &a_point.size0, false)))) return NULL;
    double_5 result;
    (void)self;
    result = networks_integrators_base_enter_answer(arena_here(), a_address, &a_qp, a_rates, &a_settings, a_state, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_qp_residuals_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_primal;
    double a_dual;
    double a_gap;
    double a_tol;
    if (!counted("qp_residuals_within", count, 4) || !read_double(given[0], &a_primal) || !read_double(given[1], &a_dual) || !read_double(given[2], &a_gap) || !read_double(given[3], &a_tol)) return NULL;
    bool result;
    (void)self;
    result = qp_residuals_within(arena_here(), a_primal, a_dual, a_gap, a_tol);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_residuals_product_terms(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_rows;
    int64_t a_j;
    Vector a_x;
    bool a_is_column;
    if (!counted("qp_residuals_product_terms", count, 4) || !((a_rows.data = read_doubles(given[0], 2, &a_rows.size0, false))) || !read_int(given[1], &a_j) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, false))) || !read_bool(given[3], &a_is_column)) return NULL;
    double_3 result;
    (void)self;
    result = qp_residuals_product_terms(arena_here(), a_rows, a_j, a_x, a_is_column);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_qp_residuals_weight_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_largest;
    if (!counted("qp_residuals_weight_of", count, 1) || !read_double(given[0], &a_largest)) return NULL;
    double result;
    (void)self;
    result = qp_residuals_weight_of(arena_here(), a_largest);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_residuals_cost_size(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    if (!counted("qp_residuals_cost_size", count, 1) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false)))) return NULL;
    double result;
    (void)self;
    result = qp_residuals_cost_size(arena_here(), &a_qp);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_residuals_cost_is_small_enough(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_point;
    double a_eps_abs;
    double a_relative;
    double a_gap;
    double a_size;
    if (!counted("qp_residuals_cost_is_small_enough", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_point.data = read_doubles(given[1], 1, &a_point.size0, false))) || !read_double(given[2], &a_eps_abs) || !read_double(given[3], &a_relative) || !read_double(given[4], &a_gap) || !read_double(given[5], &a_size)) return NULL;
    bool result;
    (void)self;
    result = qp_residuals_cost_is_small_enough(arena_here(), &a_qp, a_point, a_eps_abs, a_relative, a_gap, a_size);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_residuals_is_small_enough(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_point;
    double a_eps_abs;
    double a_eps_rel;
    if (!counted("qp_residuals_is_small_enough", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_point.data = read_doubles(given[1], 1, &a_point.size0, false))) || !read_double(given[2], &a_eps_abs) || !read_double(given[3], &a_eps_rel)) return NULL;
    bool result;
    (void)self;
    result = qp_residuals_is_small_enough(arena_here(), &a_qp, a_point, a_eps_abs, a_eps_rel);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_cycle_status_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_point;
    networks_integrators_base_SolveStats a_stats;
    networks_integrators_base_AnswerSettings a_settings;
    Vector a_state;
    if (!counted("control_cycle_status_of", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_point.data = read_doubles(given[1], 1, &a_point.size0, false))) || !((a_stats.numbers.data = read_doubles(given[2], 1, &a_stats.numbers.size0, false))) || !has_size("networks_integrators_base_SolveStats", a_stats.numbers.size0, 5, 0) || ((a_stats = networks_integrators_base_SolveStats_of(a_stats.numbers)), false) || !((a_settings.numbers.data = read_doubles(given[3], 1, &a_settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_settings.numbers.size0, 4, 1) || ((a_settings = networks_integrators_base_AnswerSettings_of(a_settings.numbers, (a_settings.numbers.size0 - 4) / 1)), false) || !((a_state.data = read_doubles(given[4], 1, &a_state.size0, false)))) return NULL;
    int64_t result;
    (void)self;
    result = control_cycle_status_of(arena_here(), &a_qp, a_point, &a_stats, &a_settings, a_state);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_stopping_cubic_coefficient(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_x;
    double a_before;
    double a_periods;
    bool a_vary;
    if (!counted("control_stopping_cubic_coefficient", count, 4) || !read_double(given[0], &a_x) || !read_double(given[1], &a_before) || !read_double(given[2], &a_periods) || !read_bool(given[3], &a_vary)) return NULL;
    double result;
    (void)self;
    result = control_stopping_cubic_coefficient(arena_here(), a_x, a_before, a_periods, a_vary);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_velocity_at(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_x;
    double a_b;
    double a_u;
    bool a_cubic;
    if (!counted("control_stopping_velocity_at", count, 4) || !read_double(given[0], &a_x) || !read_double(given[1], &a_b) || !read_double(given[2], &a_u) || !read_bool(given[3], &a_cubic)) return NULL;
    double result;
    (void)self;
    result = control_stopping_velocity_at(arena_here(), a_x, a_b, a_u, a_cubic);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_next_velocity(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_x;
    double a_before;
    double a_periods;
    bool a_cubic;
    if (!counted("control_stopping_next_velocity", count, 4) || !read_double(given[0], &a_x) || !read_double(given[1], &a_before) || !read_double(given[2], &a_periods) || !read_bool(given[3], &a_cubic)) return NULL;
    double result;
    (void)self;
    result = control_stopping_next_velocity(arena_here(), a_x, a_before, a_periods, a_cubic);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_within_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_x;
    double a_before;
    double a_periods;
    double a_accel;
    double a_jerk;
    bool a_vary;
    if (!counted("control_stopping_within_rates", count, 6) || !read_double(given[0], &a_x) || !read_double(given[1], &a_before) || !read_double(given[2], &a_periods) || !read_double(given[3], &a_accel) || !read_double(given[4], &a_jerk) || !read_bool(given[5], &a_vary)) return NULL;
    bool result;
    (void)self;
    result = control_stopping_within_rates(arena_here(), a_x, a_before, a_periods, a_accel, a_jerk, a_vary);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_least_periods(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_x;
    Vector a_before;
    schemes_rate_limits_MotionConstants a_limits;
    double a_dt;
    bool a_cubic;
    bool a_vary;
    if (!counted("control_stopping_least_periods", count, 6) || !((a_x.data = read_doubles(given[0], 1, &a_x.size0, false))) || !((a_before.data = read_doubles(given[1], 1, &a_before.size0, false))) || !((a_limits.numbers.data = read_doubles(given[2], 1, &a_limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_limits.numbers.size0, 4, 8) || ((a_limits = schemes_rate_limits_MotionConstants_of(a_limits.numbers, (a_limits.numbers.size0 - 4) / 8)), false) || !read_double(given[3], &a_dt) || !read_bool(given[4], &a_cubic) || !read_bool(given[5], &a_vary)) return NULL;
    double result;
    (void)self;
    result = control_stopping_least_periods(arena_here(), a_x, a_before, &a_limits, a_dt, a_cubic, a_vary);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_write_cubic_coefficients(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_dq;
    Vector a_before;
    double a_periods;
    bool a_vary;
    Vector a_coefficient;
    if (!counted("control_stopping_write_cubic_coefficients", count, 5) || !((a_dq.data = read_doubles(given[0], 1, &a_dq.size0, false))) || !((a_before.data = read_doubles(given[1], 1, &a_before.size0, false))) || !read_double(given[2], &a_periods) || !read_bool(given[3], &a_vary) || !((a_coefficient.data = read_doubles(given[4], 1, &a_coefficient.size0, true)))) return NULL;

    (void)self;
    control_stopping_write_cubic_coefficients(arena_here(), a_dq, a_before, a_periods, a_vary, a_coefficient);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_stopping_displacement_after(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    double a_x;
    double a_b;
    double a_count;
    double a_dt;
    if (!counted("control_stopping_displacement_after", count, 5) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !read_double(given[1], &a_x) || !read_double(given[2], &a_b) || !read_double(given[3], &a_count) || !read_double(given[4], &a_dt)) return NULL;
    double result;
    (void)self;
    result = control_stopping_displacement_after(arena_here(), &a_motion, a_x, a_b, a_count, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_least_displacement(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    double a_x;
    double a_b;
    double a_dt;
    if (!counted("control_stopping_least_displacement", count, 4) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !read_double(given[1], &a_x) || !read_double(given[2], &a_b) || !read_double(given[3], &a_dt)) return NULL;
    double result;
    (void)self;
    result = control_stopping_least_displacement(arena_here(), &a_motion, a_x, a_b, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_end_displacement(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    double a_x;
    double a_b;
    double a_dt;
    if (!counted("control_stopping_end_displacement", count, 4) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !read_double(given[1], &a_x) || !read_double(given[2], &a_b) || !read_double(given[3], &a_dt)) return NULL;
    double result;
    (void)self;
    result = control_stopping_end_displacement(arena_here(), &a_motion, a_x, a_b, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_keeps_varying_limit(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    Vector a_q;
    schemes_rate_limits_MotionConstants a_limits;
    double a_dt;
    int64_t a_i;
    if (!counted("control_stopping_keeps_varying_limit", count, 5) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_limits.numbers.data = read_doubles(given[2], 1, &a_limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_limits.numbers.size0, 4, 8) || ((a_limits = schemes_rate_limits_MotionConstants_of(a_limits.numbers, (a_limits.numbers.size0 - 4) / 8)), false) || !read_double(given[3], &a_dt) || !read_int(given[4], &a_i)) return NULL;
    bool result;
    (void)self;
    result = control_stopping_keeps_varying_limit(arena_here(), &a_motion, a_q, &a_limits, a_dt, a_i);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_keeps_joint_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    Vector a_q;
    schemes_rate_limits_MotionConstants a_limits;
    double a_dt;
    if (!counted("control_stopping_keeps_joint_limits", count, 4) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_limits.numbers.data = read_doubles(given[2], 1, &a_limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_limits.numbers.size0, 4, 8) || ((a_limits = schemes_rate_limits_MotionConstants_of(a_limits.numbers, (a_limits.numbers.size0 - 4) / 8)), false) || !read_double(given[3], &a_dt)) return NULL;
    bool result;
    (void)self;
    result = control_stopping_keeps_joint_limits(arena_here(), &a_motion, a_q, &a_limits, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_schemes_scene_place_bodies(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_scene_SceneViews a_scene;
    Matrix a_placements;
    Matrix a_placed;
    if (!counted("schemes_scene_place_bodies", count, 3) || !is_tuple(given[0], 4) || !((a_scene.head.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_scene.head.numbers.size0, false))) || !has_size("schemes_scene_SceneHead", a_scene.head.numbers.size0, 6, 0) || ((a_scene.head = schemes_scene_SceneHead_of(a_scene.head.numbers)), false) || !((a_scene.dq_max.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_scene.dq_max.size0, false))) || !((a_scene.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_scene.bodies.size0, false))) || !((a_scene.pairs.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_scene.pairs.size0, false))) || !((a_placements.data = read_doubles(given[1], 2, &a_placements.size0, false))) || !((a_placed.data = read_doubles(given[2], 2, &a_placed.size0, true)))) return NULL;

    (void)self;
    schemes_scene_place_bodies(arena_here(), &a_scene, a_placements, a_placed);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_rotations_combined(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_a;
    double_3 a_u;
    double a_b;
    double_3 a_v;
    if (!counted("references_rotations_combined", count, 4) || !read_double(given[0], &a_a) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_u.at[2]) || !read_double(given[2], &a_b) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_v.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = references_rotations_combined(arena_here(), a_a, a_u, a_b, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_ends_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_scene_SceneViews a_scene;
    Matrix a_placed;
    int64_t a_body;
    if (!counted("schemes_scene_ends_of", count, 3) || !is_tuple(given[0], 4) || !((a_scene.head.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_scene.head.numbers.size0, false))) || !has_size("schemes_scene_SceneHead", a_scene.head.numbers.size0, 6, 0) || ((a_scene.head = schemes_scene_SceneHead_of(a_scene.head.numbers)), false) || !((a_scene.dq_max.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_scene.dq_max.size0, false))) || !((a_scene.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_scene.bodies.size0, false))) || !((a_scene.pairs.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_scene.pairs.size0, false))) || !((a_placed.data = read_doubles(given[1], 2, &a_placed.size0, false))) || !read_int(given[2], &a_body)) return NULL;
    double_3_2 result;
    (void)self;
    result = schemes_scene_ends_of(arena_here(), &a_scene, a_placed, a_body);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0].at[0]), PyFloat_FromDouble(result.at[0].at[1]), PyFloat_FromDouble(result.at[0].at[2])), Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[1].at[0]), PyFloat_FromDouble(result.at[1].at[1]), PyFloat_FromDouble(result.at[1].at[2])));
}
static PyObject *py_schemes_step_seen_from(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_Placement a_placement;
    double_3 a_v;
    if (!counted("schemes_step_seen_from", count, 2) || !((a_placement.numbers.data = read_doubles(given[0], 1, &a_placement.numbers.size0, false))) || !has_size("robot_kinematics_Placement", a_placement.numbers.size0, 12, 0) || ((a_placement = robot_kinematics_Placement_of(a_placement.numbers)), false) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = schemes_step_seen_from(arena_here(), &a_placement, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_beyond(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_x;
    double_3 a_half;
    if (!counted("schemes_scene_beyond", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_x.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_x.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_x.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_half.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_half.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_half.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = schemes_scene_beyond(arena_here(), a_x, a_half);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_nearest_parameter(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_a;
    double_3 a_u;
    double_3 a_half;
    if (!counted("schemes_scene_nearest_parameter", count, 3) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_a.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_a.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_a.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_u.at[2]) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_half.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_half.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_half.at[2])) return NULL;
    double result;
    (void)self;
    result = schemes_scene_nearest_parameter(arena_here(), a_a, a_u, a_half);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_scene_depth(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_x;
    double_3 a_half;
    if (!counted("schemes_scene_depth", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_x.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_x.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_x.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_half.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_half.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_half.at[2])) return NULL;
    double_4 result;
    (void)self;
    result = schemes_scene_depth(arena_here(), a_x, a_half);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]));
}
static PyObject *py_references_rotations_scaled(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_a;
    double_3 a_u;
    if (!counted("references_rotations_scaled", count, 2) || !read_double(given[0], &a_a) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_u.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = references_rotations_scaled(arena_here(), a_a, a_u);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_step_axis_at(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    robot_kinematics_Placement a_placement;
    double_3 a_axis;
    if (!counted("schemes_step_axis_at", count, 2) || !((a_placement.numbers.data = read_doubles(given[0], 1, &a_placement.numbers.size0, false))) || !has_size("robot_kinematics_Placement", a_placement.numbers.size0, 12, 0) || ((a_placement = robot_kinematics_Placement_of(a_placement.numbers)), false) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_axis.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = schemes_step_axis_at(arena_here(), &a_placement, a_axis);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_second_order(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_scene_Pair a_pair;
    Vector a_travel;
    if (!counted("schemes_scene_second_order", count, 2) || !((a_pair.numbers.data = read_doubles(given[0], 1, &a_pair.numbers.size0, false))) || !has_size("schemes_scene_Pair", a_pair.numbers.size0, 3, 2) || ((a_pair = schemes_scene_Pair_of(a_pair.numbers, (a_pair.numbers.size0 - 3) / 2)), false) || !((a_travel.data = read_doubles(given[1], 1, &a_travel.size0, false)))) return NULL;
    double result;
    (void)self;
    result = schemes_scene_second_order(arena_here(), &a_pair, a_travel);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_references_rotations_cross(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_u;
    double_3 a_v;
    if (!counted("references_rotations_cross", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_u.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = references_rotations_cross(arena_here(), a_u, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_step_point_rate(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_jacobian;
    int64_t a_j;
    double_3 a_point;
    if (!counted("schemes_step_point_rate", count, 3) || !((a_jacobian.data = read_doubles(given[0], 2, &a_jacobian.size0, false))) || !read_int(given[1], &a_j) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_point.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = schemes_step_point_rate(arena_here(), a_jacobian, a_j, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_step_rate_along(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_jacobian;
    int64_t a_j;
    double_3 a_point;
    double_3 a_normal;
    if (!counted("schemes_step_rate_along", count, 4) || !((a_jacobian.data = read_doubles(given[0], 2, &a_jacobian.size0, false))) || !read_int(given[1], &a_j) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_point.at[2]) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_normal.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_normal.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_normal.at[2])) return NULL;
    double result;
    (void)self;
    result = schemes_step_rate_along(arena_here(), a_jacobian, a_j, a_point, a_normal);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_along(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    Matrix a_jacobian;
    schemes_scene_Pair a_pair;
    double_3 a_point;
    double_3 a_normal;
    if (!counted("control_stopping_along", count, 5) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !((a_jacobian.data = read_doubles(given[1], 2, &a_jacobian.size0, false))) || !((a_pair.numbers.data = read_doubles(given[2], 1, &a_pair.numbers.size0, false))) || !has_size("schemes_scene_Pair", a_pair.numbers.size0, 3, 2) || ((a_pair = schemes_scene_Pair_of(a_pair.numbers, (a_pair.numbers.size0 - 3) / 2)), false) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_point.at[2]) || !is_tuple(given[4], 3) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_normal.at[0]) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_normal.at[1]) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_normal.at[2])) return NULL;
    double_2 result;
    (void)self;
    result = control_stopping_along(arena_here(), &a_motion, a_jacobian, &a_pair, a_point, a_normal);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_schemes_scene_height_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_end;
    schemes_scene_Contact a_contact;
    if (!counted("schemes_scene_height_of", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_end.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_end.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_end.at[2]) || !is_tuple(given[1], 3) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), &a_contact.second.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), &a_contact.second.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), &a_contact.second.at[2]) || !is_tuple(PyTuple_GET_ITEM(given[1], 1), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 0), &a_contact.normal.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 1), &a_contact.normal.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 2), &a_contact.normal.at[2]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_contact.distance)) return NULL;
    double result;
    (void)self;
    result = schemes_scene_height_of(arena_here(), a_end, &a_contact);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_keeps_distances(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    control_stopping_Motion a_motion;
    schemes_program_ProgramArrays a_arrays;
    Vector a_constants;
    Vector a_least;
    double a_dt;
    if (!counted("control_stopping_keeps_distances", count, 5) || !is_tuple(given[0], 6) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.coefficient.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.coefficient.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_bool(PyTuple_GET_ITEM(given[0], 4), &a_motion.varies) || !read_bool(PyTuple_GET_ITEM(given[0], 5), &a_motion.skips) || !is_tuple(given[1], 8) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), &a_arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), &a_arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), &a_arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 3), &a_arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 4), &a_arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 5), &a_arrays.sizes.frames) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 1), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.placements.size0, false))) || !((a_arrays.support.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.support.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(given[1], 7), &a_arrays.tip) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_least.data = read_doubles(given[3], 1, &a_least.size0, false))) || !read_double(given[4], &a_dt)) return NULL;
    bool result;
    (void)self;
    result = control_stopping_keeps_distances(arena_here(), &a_motion, &a_arrays, a_constants, a_least, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_dense_long_dot(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_start;
    Vector a_a;
    Vector a_b;
    if (!counted("qp_dense_long_dot", count, 3) || !read_double(given[0], &a_start) || !((a_a.data = read_doubles(given[1], 1, &a_a.size0, false))) || !((a_b.data = read_doubles(given[2], 1, &a_b.size0, false)))) return NULL;
    double result;
    (void)self;
    result = qp_dense_long_dot(arena_here(), a_start, a_a, a_b);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_dense_dot(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_start;
    Vector a_a;
    Vector a_b;
    if (!counted("qp_dense_dot", count, 3) || !read_double(given[0], &a_start) || !((a_a.data = read_doubles(given[1], 1, &a_a.size0, false))) || !((a_b.data = read_doubles(given[2], 1, &a_b.size0, false)))) return NULL;
    double result;
    (void)self;
    result = qp_dense_dot(arena_here(), a_start, a_a, a_b);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_dense_row_dot(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_rows;
    int64_t a_j;
    Vector a_x;
    if (!counted("qp_dense_row_dot", count, 3) || !((a_rows.data = read_doubles(given[0], 2, &a_rows.size0, false))) || !read_int(given[1], &a_j) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, false)))) return NULL;
    double result;
    (void)self;
    result = qp_dense_row_dot(arena_here(), a_rows, a_j, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_command_is_active(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_multiplier;
    double a_slack;
    double a_tolerance;
    if (!counted("control_command_is_active", count, 3) || !read_double(given[0], &a_multiplier) || !read_double(given[1], &a_slack) || !read_double(given[2], &a_tolerance)) return NULL;
    bool result;
    (void)self;
    result = control_command_is_active(arena_here(), a_multiplier, a_slack, a_tolerance);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_fallback_copy_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    qp_layout_QPViews a_other;
    if (!counted("control_fallback_copy_cost", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_other.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_other.P.size0, true))) || !((a_other.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_other.q.size0, true))) || !((a_other.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_other.G.size0, false))) || !((a_other.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_other.h.size0, false))) || !((a_other.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_other.A.size0, false))) || !((a_other.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_other.b.size0, false))) || !((a_other.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_other.lb.size0, false))) || !((a_other.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_other.ub.size0, false)))) return NULL;

    (void)self;
    control_fallback_copy_cost(arena_here(), &a_qp, &a_other);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_fallback_copy_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    qp_layout_QPViews a_other;
    if (!counted("control_fallback_copy_limits", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_other.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_other.P.size0, false))) || !((a_other.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_other.q.size0, false))) || !((a_other.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_other.G.size0, true))) || !((a_other.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_other.h.size0, true))) || !((a_other.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_other.A.size0, false))) || !((a_other.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_other.b.size0, false))) || !((a_other.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_other.lb.size0, true))) || !((a_other.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_other.ub.size0, true)))) return NULL;

    (void)self;
    control_fallback_copy_limits(arena_here(), &a_qp, &a_other);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_fallback_longest_asked(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_weights;
    bool a_retreats;
    if (!counted("control_fallback_longest_asked", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_weights.data = read_doubles(given[1], 1, &a_weights.size0, false))) || !read_bool(given[2], &a_retreats)) return NULL;
    double result;
    (void)self;
    result = control_fallback_longest_asked(arena_here(), &a_qp, a_weights, a_retreats);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_projection_write_spans(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_spans;
    if (!counted("networks_projection_write_spans", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_spans.data = read_doubles(given[1], 1, &a_spans.size0, true)))) return NULL;

    (void)self;
    networks_projection_write_spans(arena_here(), &a_qp, a_spans);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_integrators_implicit_longest_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    if (!counted("networks_integrators_implicit_longest_step", count, 1) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false)))) return NULL;
    double result;
    (void)self;
    result = networks_integrators_implicit_longest_step(arena_here(), &a_qp);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_dense_times(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_rows;
    Vector a_x;
    Vector a_out;
    if (!counted("qp_dense_times", count, 3) || !((a_rows.data = read_doubles(given[0], 2, &a_rows.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, false))) || !((a_out.data = read_doubles(given[2], 1, &a_out.size0, true)))) return NULL;

    (void)self;
    qp_dense_times(arena_here(), a_rows, a_x, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_add_multiple(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_out;
    double a_factor;
    Vector a_values;
    if (!counted("qp_dense_add_multiple", count, 3) || !((a_out.data = read_doubles(given[0], 1, &a_out.size0, true))) || !read_double(given[1], &a_factor) || !((a_values.data = read_doubles(given[2], 1, &a_values.size0, false)))) return NULL;

    (void)self;
    qp_dense_add_multiple(arena_here(), a_out, a_factor, a_values);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_add_row(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_out;
    double a_factor;
    Matrix a_rows;
    int64_t a_j;
    if (!counted("qp_dense_add_row", count, 4) || !((a_out.data = read_doubles(given[0], 1, &a_out.size0, true))) || !read_double(given[1], &a_factor) || !((a_rows.data = read_doubles(given[2], 2, &a_rows.size0, false))) || !read_int(given[3], &a_j)) return NULL;

    (void)self;
    qp_dense_add_row(arena_here(), a_out, a_factor, a_rows, a_j);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_add_transposed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_spans;
    double a_factor;
    Vector a_s;
    Vector a_out;
    if (!counted("networks_projection_add_transposed", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_spans.data = read_doubles(given[1], 1, &a_spans.size0, false))) || !read_double(given[2], &a_factor) || !((a_s.data = read_doubles(given[3], 1, &a_s.size0, false))) || !((a_out.data = read_doubles(given[4], 1, &a_out.size0, true)))) return NULL;

    (void)self;
    networks_projection_add_transposed(arena_here(), &a_qp, a_spans, a_factor, a_s, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_rows_times(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_spans;
    Vector a_x;
    Vector a_values;
    if (!counted("networks_projection_rows_times", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_spans.data = read_doubles(given[1], 1, &a_spans.size0, false))) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, false))) || !((a_values.data = read_doubles(given[3], 1, &a_values.size0, true)))) return NULL;

    (void)self;
    networks_projection_rows_times(arena_here(), &a_qp, a_spans, a_x, a_values);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_write_slacks(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_spans;
    Vector a_x;
    Vector a_slacks;
    if (!counted("networks_projection_write_slacks", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_spans.data = read_doubles(given[1], 1, &a_spans.size0, false))) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, false))) || !((a_slacks.data = read_doubles(given[3], 1, &a_slacks.size0, true)))) return NULL;

    (void)self;
    networks_projection_write_slacks(arena_here(), &a_qp, a_spans, a_x, a_slacks);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_unprojected_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_spans;
    Vector a_s;
    Vector a_rates;
    if (!counted("networks_projection_unprojected_rates", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_spans.data = read_doubles(given[1], 1, &a_spans.size0, false))) || !((a_s.data = read_doubles(given[2], 1, &a_s.size0, false))) || !((a_rates.data = read_doubles(given[3], 1, &a_rates.size0, true)))) return NULL;
    double result;
    (void)self;
    result = networks_projection_unprojected_rates(arena_here(), &a_qp, a_spans, a_s, a_rates);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_residuals_point_residuals(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_point;
    if (!counted("qp_residuals_point_residuals", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_point.data = read_doubles(given[1], 1, &a_point.size0, false)))) return NULL;
    double_3 result;
    (void)self;
    result = qp_residuals_point_residuals(arena_here(), &a_qp, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_qp_residuals_kkt_point(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_s;
    Vector a_point;
    if (!counted("qp_residuals_kkt_point", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_point.data = read_doubles(given[2], 1, &a_point.size0, true)))) return NULL;
    double_3 result;
    (void)self;
    result = qp_residuals_kkt_point(arena_here(), &a_qp, a_s, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_networks_projection_mark_active(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_s;
    Vector a_rates;
    Vector a_active;
    if (!counted("networks_projection_mark_active", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_rates.data = read_doubles(given[2], 1, &a_rates.size0, false))) || !((a_active.data = read_doubles(given[3], 1, &a_active.size0, true)))) return NULL;
    int64_t result;
    (void)self;
    result = networks_projection_mark_active(arena_here(), &a_qp, a_s, a_rates, a_active);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_qp_dense_add_outer(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_out;
    double a_factor;
    Vector a_row;
    int64_t a_start;
    if (!counted("qp_dense_add_outer", count, 4) || !((a_out.data = read_doubles(given[0], 2, &a_out.size0, true))) || !read_double(given[1], &a_factor) || !((a_row.data = read_doubles(given[2], 1, &a_row.size0, false))) || !read_int(given[3], &a_start)) return NULL;

    (void)self;
    qp_dense_add_outer(arena_here(), a_out, a_factor, a_row, a_start);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_integrators_implicit_steps_count_row(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    networks_integrators_implicit_steps_Condensed a_matrix;
    int64_t a_j;
    Vector a_row;
    int64_t a_start;
    if (!counted("networks_integrators_implicit_steps_count_row", count, 4) || !is_tuple(given[0], 6) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_matrix.active.size0, false))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_matrix.K.size0, false))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_matrix.values.size0, false))) || !((a_matrix.spans.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_matrix.spans.size0, false))) || !read_int(given[1], &a_j) || !((a_row.data = read_doubles(given[2], 1, &a_row.size0, false))) || !read_int(given[3], &a_start)) return NULL;

    (void)self;
    networks_integrators_implicit_steps_count_row(arena_here(), &a_matrix, a_j, a_row, a_start);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_weighted_sum(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_a;
    double a_factor;
    Vector a_b;
    Vector a_out;
    if (!counted("qp_dense_weighted_sum", count, 4) || !((a_a.data = read_doubles(given[0], 1, &a_a.size0, false))) || !read_double(given[1], &a_factor) || !((a_b.data = read_doubles(given[2], 1, &a_b.size0, false))) || !((a_out.data = read_doubles(given[3], 1, &a_out.size0, true)))) return NULL;

    (void)self;
    qp_dense_weighted_sum(arena_here(), a_a, a_factor, a_b, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_integrators_implicit_steps_build_condensed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    double a_step;
    networks_integrators_implicit_steps_Condensed a_matrix;
    if (!counted("networks_integrators_implicit_steps_build_condensed", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_double(given[1], &a_step) || !is_tuple(given[2], 6) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_matrix.active.size0, false))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[2], 3), 2, &a_matrix.K.size0, true))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[2], 4), 1, &a_matrix.values.size0, false))) || !((a_matrix.spans.data = read_doubles(PyTuple_GET_ITEM(given[2], 5), 1, &a_matrix.spans.size0, false)))) return NULL;

    (void)self;
    networks_integrators_implicit_steps_build_condensed(arena_here(), &a_qp, a_step, &a_matrix);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_cholesky_factor(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    if (!counted("qp_dense_cholesky_factor", count, 1) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, true)))) return NULL;
    bool result;
    (void)self;
    result = qp_dense_cholesky_factor(arena_here(), a_K);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_dense_factor_solve(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    Vector a_rhs;
    Vector a_out;
    if (!counted("qp_dense_factor_solve", count, 3) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, false))) || !((a_rhs.data = read_doubles(given[1], 1, &a_rhs.size0, false))) || !((a_out.data = read_doubles(given[2], 1, &a_out.size0, true)))) return NULL;

    (void)self;
    qp_dense_factor_solve(arena_here(), a_K, a_rhs, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_integrators_implicit_steps_linear_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_s;
    Vector a_rates;
    double a_step;
    networks_integrators_implicit_steps_Condensed a_matrix;
    bool a_is_factored;
    Vector a_new;
    if (!counted("networks_integrators_implicit_steps_linear_step", count, 7) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_rates.data = read_doubles(given[2], 1, &a_rates.size0, false))) || !read_double(given[3], &a_step) || !is_tuple(given[4], 6) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[4], 0), 1, &a_matrix.active.size0, false))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[4], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[4], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[4], 3), 2, &a_matrix.K.size0, true))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[4], 4), 1, &a_matrix.values.size0, true))) || !((a_matrix.spans.data = read_doubles(PyTuple_GET_ITEM(given[4], 5), 1, &a_matrix.spans.size0, false))) || !read_bool(given[5], &a_is_factored) || !((a_new.data = read_doubles(given[6], 1, &a_new.size0, true)))) return NULL;
    bool result;
    (void)self;
    result = networks_integrators_implicit_steps_linear_step(arena_here(), &a_qp, a_s, a_rates, a_step, &a_matrix, a_is_factored, a_new);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_networks_integrators_implicit_steps_multipliers(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_s;
    double a_step;
    Vector a_slacks;
    Vector a_new;
    Vector a_active;
    if (!counted("networks_integrators_implicit_steps_multipliers", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !read_double(given[2], &a_step) || !((a_slacks.data = read_doubles(given[3], 1, &a_slacks.size0, false))) || !((a_new.data = read_doubles(given[4], 1, &a_new.size0, true))) || !((a_active.data = read_doubles(given[5], 1, &a_active.size0, true)))) return NULL;
    int64_t result;
    (void)self;
    result = networks_integrators_implicit_steps_multipliers(arena_here(), &a_qp, a_s, a_step, a_slacks, a_new, a_active);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_networks_integrators_implicit_steps_descent(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_spans;
    Vector a_cost;
    Vector a_new;
    Vector a_descent;
    if (!counted("networks_integrators_implicit_steps_descent", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_spans.data = read_doubles(given[1], 1, &a_spans.size0, false))) || !((a_cost.data = read_doubles(given[2], 1, &a_cost.size0, false))) || !((a_new.data = read_doubles(given[3], 1, &a_new.size0, false))) || !((a_descent.data = read_doubles(given[4], 1, &a_descent.size0, true)))) return NULL;
    double result;
    (void)self;
    result = networks_integrators_implicit_steps_descent(arena_here(), &a_qp, a_spans, a_cost, a_new, a_descent);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_integrators_implicit_steps_slope(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_multipliers;
    double a_step;
    int64_t a_p;
    Vector a_slacks;
    Vector a_change;
    double a_length;
    if (!counted("networks_integrators_implicit_steps_slope", count, 6) || !((a_multipliers.data = read_doubles(given[0], 1, &a_multipliers.size0, false))) || !read_double(given[1], &a_step) || !read_int(given[2], &a_p) || !((a_slacks.data = read_doubles(given[3], 1, &a_slacks.size0, false))) || !((a_change.data = read_doubles(given[4], 1, &a_change.size0, false))) || !read_double(given[5], &a_length)) return NULL;
    double_2 result;
    (void)self;
    result = networks_integrators_implicit_steps_slope(arena_here(), a_multipliers, a_step, a_p, a_slacks, a_change, a_length);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_networks_integrators_implicit_steps_line_search(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_multipliers;
    double a_step;
    int64_t a_p;
    Vector a_slacks;
    Vector a_change;
    double a_fall;
    double a_rate;
    double a_curvature;
    if (!counted("networks_integrators_implicit_steps_line_search", count, 8) || !((a_multipliers.data = read_doubles(given[0], 1, &a_multipliers.size0, false))) || !read_double(given[1], &a_step) || !read_int(given[2], &a_p) || !((a_slacks.data = read_doubles(given[3], 1, &a_slacks.size0, false))) || !((a_change.data = read_doubles(given[4], 1, &a_change.size0, false))) || !read_double(given[5], &a_fall) || !read_double(given[6], &a_rate) || !read_double(given[7], &a_curvature)) return NULL;
    double result;
    (void)self;
    result = networks_integrators_implicit_steps_line_search(arena_here(), a_multipliers, a_step, a_p, a_slacks, a_change, a_fall, a_rate, a_curvature);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_integrators_implicit_steps_backward_euler(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_s;
    double a_step;
    Vector a_new;
    double a_tol;
    int64_t a_max_newton;
    networks_integrators_implicit_steps_Condensed a_matrix;
    if (!counted("networks_integrators_implicit_steps_backward_euler", count, 7) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !read_double(given[2], &a_step) || !((a_new.data = read_doubles(given[3], 1, &a_new.size0, true))) || !read_double(given[4], &a_tol) || !read_int(given[5], &a_max_newton) || !is_tuple(given[6], 6) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[6], 0), 1, &a_matrix.active.size0, true))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[6], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[6], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[6], 3), 2, &a_matrix.K.size0, true))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[6], 4), 1, &a_matrix.values.size0, true))) || !((a_matrix.spans.data = read_doubles(PyTuple_GET_ITEM(given[6], 5), 1, &a_matrix.spans.size0, false)))) return NULL;
    int64_t result;
    (void)self;
    result = networks_integrators_implicit_steps_backward_euler(arena_here(), &a_qp, a_s, a_step, a_new, a_tol, a_max_newton, &a_matrix);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_networks_integrators_implicit_solve_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    double a_tol;
    int64_t a_budget;
    Vector a_s;
    Vector a_point;
    if (!counted("networks_integrators_implicit_solve_within", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_double(given[1], &a_tol) || !read_int(given[2], &a_budget) || !((a_s.data = read_doubles(given[3], 1, &a_s.size0, true))) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, true)))) return NULL;
    double_5 result;
    (void)self;
    result = networks_integrators_implicit_solve_within(arena_here(), &a_qp, a_tol, a_budget, a_s, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_control_fallback_solve_warm(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    double a_tol;
    Vector a_state;
    Vector a_point;
    networks_integrators_base_SolveStats a_stats;
    if (!counted("control_fallback_solve_warm", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_double(given[1], &a_tol) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, true))) || !((a_point.data = read_doubles(given[3], 1, &a_point.size0, true))) || !((a_stats.numbers.data = read_doubles(given[4], 1, &a_stats.numbers.size0, true))) || !has_size("networks_integrators_base_SolveStats", a_stats.numbers.size0, 5, 0) || ((a_stats = networks_integrators_base_SolveStats_of(a_stats.numbers)), false)) return NULL;
    bool result;
    (void)self;
    result = control_fallback_solve_warm(arena_here(), &a_qp, a_tol, a_state, a_point, &a_stats);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_fallback_largest_factor(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    control_fallback_Yielding a_yielding;
    Vector a_state;
    Vector a_point;
    networks_integrators_base_SolveStats a_stats;
    bool a_retreats;
    if (!counted("control_fallback_largest_factor", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_yielding.limits.numbers.size0, 4, 8) || ((a_yielding.limits = schemes_rate_limits_MotionConstants_of(a_yielding.limits.numbers, (a_yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_yielding.tolerance) || !read_int(PyTuple_GET_ITEM(given[1], 3), &a_yielding.rates) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[1], 4), 1, &a_yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(given[1], 5), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_yielding.coupled) || !read_bool(PyTuple_GET_ITEM(given[1], 7), &a_yielding.alike) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, true))) || !((a_point.data = read_doubles(given[3], 1, &a_point.size0, true))) || !((a_stats.numbers.data = read_doubles(given[4], 1, &a_stats.numbers.size0, true))) || !has_size("networks_integrators_base_SolveStats", a_stats.numbers.size0, 5, 0) || ((a_stats = networks_integrators_base_SolveStats_of(a_stats.numbers)), false) || !read_bool(given[5], &a_retreats)) return NULL;
    double result;
    (void)self;
    result = control_fallback_largest_factor(arena_here(), &a_qp, &a_yielding, a_state, a_point, &a_stats, a_retreats);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_fallback_note_limiting(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_point;
    int64_t a_n;
    int64_t a_m;
    int64_t a_extra;
    Vector a_limiting;
    if (!counted("control_fallback_note_limiting", count, 5) || !((a_point.data = read_doubles(given[0], 1, &a_point.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_extra) || !((a_limiting.data = read_doubles(given[4], 1, &a_limiting.size0, true)))) return NULL;

    (void)self;
    control_fallback_note_limiting(arena_here(), a_point, a_n, a_m, a_extra, a_limiting);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_yielding_is_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_targets;
    if (!counted("control_yielding_is_path", count, 1) || !((a_targets.data = read_doubles(given[0], 2, &a_targets.size0, false)))) return NULL;
    bool result;
    (void)self;
    result = control_yielding_is_path(arena_here(), a_targets);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_yielding_races(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_x;
    if (!counted("control_yielding_races", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, false)))) return NULL;
    bool result;
    (void)self;
    result = control_yielding_races(arena_here(), &a_qp, a_x);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_fallback_scale_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_weights;
    double a_factor;
    if (!counted("control_fallback_scale_task", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, true))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_weights.data = read_doubles(given[1], 1, &a_weights.size0, false))) || !read_double(given[2], &a_factor)) return NULL;

    (void)self;
    control_fallback_scale_task(arena_here(), &a_qp, a_weights, a_factor);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_fallback_relax_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_weights;
    double a_retreat;
    if (!counted("control_fallback_relax_task", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, true))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, true))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, true))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, true))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, true))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_weights.data = read_doubles(given[1], 1, &a_weights.size0, false))) || !read_double(given[2], &a_retreat)) return NULL;

    (void)self;
    control_fallback_relax_task(arena_here(), &a_qp, a_weights, a_retreat);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_fallback_rate_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    int64_t a_j;
    Vector a_x;
    if (!counted("control_fallback_rate_within", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[1], &a_j) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, false)))) return NULL;
    double result;
    (void)self;
    result = control_fallback_rate_within(arena_here(), &a_qp, a_j, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_fallback_move_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_x;
    control_fallback_Yielding a_yielding;
    networks_integrators_base_SolveStats a_stats;
    int64_t a_equalities;
    if (!counted("control_fallback_move_within", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, true))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_yielding.limits.numbers.size0, 4, 8) || ((a_yielding.limits = schemes_rate_limits_MotionConstants_of(a_yielding.limits.numbers, (a_yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_yielding.tolerance) || !read_int(PyTuple_GET_ITEM(given[2], 3), &a_yielding.rates) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 4), 1, &a_yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(given[2], 5), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.coupled) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.alike) || !((a_stats.numbers.data = read_doubles(given[3], 1, &a_stats.numbers.size0, true))) || !has_size("networks_integrators_base_SolveStats", a_stats.numbers.size0, 5, 0) || ((a_stats = networks_integrators_base_SolveStats_of(a_stats.numbers)), false) || !read_int(given[4], &a_equalities)) return NULL;
    bool result;
    (void)self;
    result = control_fallback_move_within(arena_here(), &a_qp, a_x, &a_yielding, &a_stats, a_equalities);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_fallback_nearest_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_x;
    control_fallback_Yielding a_yielding;
    networks_integrators_base_SolveStats a_stats;
    if (!counted("control_fallback_nearest_within", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, true))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_yielding.limits.numbers.size0, 4, 8) || ((a_yielding.limits = schemes_rate_limits_MotionConstants_of(a_yielding.limits.numbers, (a_yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_yielding.tolerance) || !read_int(PyTuple_GET_ITEM(given[2], 3), &a_yielding.rates) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 4), 1, &a_yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(given[2], 5), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.coupled) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.alike) || !((a_stats.numbers.data = read_doubles(given[3], 1, &a_stats.numbers.size0, true))) || !has_size("networks_integrators_base_SolveStats", a_stats.numbers.size0, 5, 0) || ((a_stats = networks_integrators_base_SolveStats_of(a_stats.numbers)), false)) return NULL;
    bool result;
    (void)self;
    result = control_fallback_nearest_within(arena_here(), &a_qp, a_x, &a_yielding, &a_stats);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_stretched(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_x;
    Vector a_before;
    schemes_rate_limits_MotionConstants a_limits;
    double a_dt;
    double a_periods;
    if (!counted("control_stopping_stretched", count, 5) || !((a_x.data = read_doubles(given[0], 1, &a_x.size0, false))) || !((a_before.data = read_doubles(given[1], 1, &a_before.size0, false))) || !((a_limits.numbers.data = read_doubles(given[2], 1, &a_limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_limits.numbers.size0, 4, 8) || ((a_limits = schemes_rate_limits_MotionConstants_of(a_limits.numbers, (a_limits.numbers.size0 - 4) / 8)), false) || !read_double(given[3], &a_dt) || !read_double(given[4], &a_periods)) return NULL;
    double result;
    (void)self;
    result = control_stopping_stretched(arena_here(), a_x, a_before, &a_limits, a_dt, a_periods);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_yielding_is_near(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_program_ProgramArrays a_arrays;
    control_fallback_Yielding a_yielding;
    Vector a_least;
    if (!counted("control_yielding_is_near", count, 3) || !is_tuple(given[0], 8) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), &a_arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), &a_arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), &a_arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), &a_arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), &a_arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), &a_arrays.sizes.frames) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[0], 1), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_arrays.placements.size0, false))) || !((a_arrays.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_arrays.support.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(given[0], 7), &a_arrays.tip) || !is_tuple(given[1], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_yielding.limits.numbers.size0, 4, 8) || ((a_yielding.limits = schemes_rate_limits_MotionConstants_of(a_yielding.limits.numbers, (a_yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_yielding.tolerance) || !read_int(PyTuple_GET_ITEM(given[1], 3), &a_yielding.rates) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[1], 4), 1, &a_yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(given[1], 5), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_yielding.coupled) || !read_bool(PyTuple_GET_ITEM(given[1], 7), &a_yielding.alike) || !((a_least.data = read_doubles(given[2], 1, &a_least.size0, false)))) return NULL;
    bool result;
    (void)self;
    result = control_yielding_is_near(arena_here(), &a_arrays, &a_yielding, a_least);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_fallback_attained(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_b;
    Matrix a_A;
    Vector a_weights;
    Vector a_x;
    if (!counted("control_fallback_attained", count, 4) || !((a_b.data = read_doubles(given[0], 1, &a_b.size0, false))) || !((a_A.data = read_doubles(given[1], 2, &a_A.size0, false))) || !((a_weights.data = read_doubles(given[2], 1, &a_weights.size0, false))) || !((a_x.data = read_doubles(given[3], 1, &a_x.size0, false)))) return NULL;
    double result;
    (void)self;
    result = control_fallback_attained(arena_here(), a_b, a_A, a_weights, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_cycle_take_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_cycle_ControlPlan kept_plan;
    Vector a_data;
    control_cycle_ControlPlan a_plan;
    Vector a_q;
    Vector a_numbers;
    Vector a_next_numbers;
    Vector a_state;
    double a_t;
    if (!counted("control_cycle_take_step", count, 7) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, true))) || (!is_seen(given[1], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[1], 8) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 0), &a_plan.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 1), &a_plan.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 2), &a_plan.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 3), &a_plan.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 4), &a_plan.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 5), &a_plan.arrays.sizes.frames) || !((a_plan.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), 2, &a_plan.arrays.table.size0, false))) || !((a_plan.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), 1, &a_plan.arrays.constants.size0, true))) || !((a_plan.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 3), 2, &a_plan.arrays.jacobian.size0, false))) || !((a_plan.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 4), 2, &a_plan.arrays.placements.size0, false))) || !((a_plan.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 5), 2, &a_plan.arrays.support.size0, false))) || !((a_plan.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 6), 2, &a_plan.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 7), &a_plan.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(given[1], 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 0), &a_plan.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 1), &a_plan.network.rates) || !((a_plan.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 2), 1, &a_plan.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.network.settings.numbers.size0, 4, 1) || ((a_plan.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.network.settings.numbers, (a_plan.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(given[1], 2), 2) || !((a_plan.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 2), 0), 2, &a_plan.paths.table.size0, false))) || !((a_plan.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 2), 1), 1, &a_plan.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[1], 3), 8) || !((a_plan.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 0), 1, &a_plan.yielding.weights.size0, false))) || !((a_plan.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 1), 1, &a_plan.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.yielding.limits.numbers.size0, 4, 8) || ((a_plan.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.yielding.limits.numbers, (a_plan.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 2), &a_plan.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 3), &a_plan.yielding.rates) || !((a_plan.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 4), 1, &a_plan.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 5), &a_plan.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 6), &a_plan.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 3), 7), &a_plan.yielding.alike) || !((a_plan.fallback.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_plan.fallback.size0, true))) || !read_int(PyTuple_GET_ITEM(given[1], 5), &a_plan.policy) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_plan.samples) || !is_tuple(PyTuple_GET_ITEM(given[1], 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 0), &a_plan.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 1), &a_plan.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 2), &a_plan.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 3), &a_plan.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 4), &a_plan.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 5), &a_plan.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 7), 6), &a_plan.timing.exceeded) || !keep(given[1], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_q.data = read_doubles(given[2], 1, &a_q.size0, false))) || !((a_numbers.data = read_doubles(given[3], 1, &a_numbers.size0, true))) || !((a_next_numbers.data = read_doubles(given[4], 1, &a_next_numbers.size0, true))) || !((a_state.data = read_doubles(given[5], 1, &a_state.size0, true))) || !read_double(given[6], &a_t)) return NULL;
    int64_t result;
    (void)self;
    result = control_cycle_take_step(arena_here(), a_data, &a_plan, a_q, a_numbers, a_next_numbers, a_state, a_t);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_requests_falls_short(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_twist;
    if (!counted("control_requests_falls_short", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_twist.data = read_doubles(given[1], 1, &a_twist.size0, false)))) return NULL;
    bool result;
    (void)self;
    result = control_requests_falls_short(arena_here(), &a_qp, a_twist);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_arms_finish_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    control_arms_ArmInput a_inputs;
    Matrix a_jacobian;
    Matrix a_placements;
    Vector a_data;
    if (!counted("control_arms_finish_step", count, 6) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, true))) || !is_tuple(given[2], 5) || !((a_inputs.q.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_inputs.q.size0, false))) || !read_int(PyTuple_GET_ITEM(given[2], 1), &a_inputs.kind) || !((a_inputs.request.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_inputs.request.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 3), &a_inputs.dt) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_inputs.elapsed) || !((a_jacobian.data = read_doubles(given[3], 2, &a_jacobian.size0, false))) || !((a_placements.data = read_doubles(given[4], 2, &a_placements.size0, false))) || !((a_data.data = read_doubles(given[5], 1, &a_data.size0, true)))) return NULL;
    int64_t result;
    (void)self;
    result = control_arms_finish_step(arena_here(), &a_plan, a_memory, &a_inputs, a_jacobian, a_placements, a_data);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_arms_step_arm(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    control_arms_ArmInput a_inputs;
    if (!counted("control_arms_step_arm", count, 3) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, true))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, true))) || !is_tuple(given[2], 5) || !((a_inputs.q.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_inputs.q.size0, false))) || !read_int(PyTuple_GET_ITEM(given[2], 1), &a_inputs.kind) || !((a_inputs.request.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_inputs.request.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 3), &a_inputs.dt) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_inputs.elapsed)) return NULL;
    int64_t result;
    (void)self;
    result = control_arms_step_arm(arena_here(), &a_plan, a_memory, &a_inputs);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_schemes_scene_write_distances(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    int64_t a_dof;
    Matrix a_placements;
    Vector a_distances;
    if (!counted("schemes_scene_write_distances", count, 4) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !read_int(given[1], &a_dof) || !((a_placements.data = read_doubles(given[2], 2, &a_placements.size0, false))) || !((a_distances.data = read_doubles(given[3], 1, &a_distances.size0, true)))) return NULL;

    (void)self;
    schemes_scene_write_distances(arena_here(), a_constants, a_dof, a_placements, a_distances);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_arms_margin_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    if (!counted("control_arms_margin_of", count, 2) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, true))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, false)))) return NULL;
    double_2 result;
    (void)self;
    result = control_arms_margin_of(arena_here(), &a_plan, a_memory);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_control_arms_stopping_time_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Vector a_memory;
    if (!counted("control_arms_stopping_time_of", count, 2) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memory.data = read_doubles(given[1], 1, &a_memory.size0, false)))) return NULL;
    double result;
    (void)self;
    result = control_arms_stopping_time_of(arena_here(), &a_plan, a_memory);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_arms_step_arms(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    static PyObject *seen_plan;
    static control_arms_ArmPlan kept_plan;
    control_arms_ArmPlan a_plan;
    Matrix a_memories;
    control_arms_ArmInput a_inputs;
    IntVector a_kinds;
    int64_t a_first;
    int64_t a_last;
    if (!counted("control_arms_step_arms", count, 6) || (!is_seen(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan) && (!is_tuple(given[0], 12) || !is_tuple(PyTuple_GET_ITEM(given[0], 0), 9) || !((a_plan.robot.parents.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 0), 1, &a_plan.robot.parents.size0, false))) || !((a_plan.robot.joints.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 1), 2, &a_plan.robot.joints.size0, false))) || !((a_plan.robot.slides.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 2), 1, &a_plan.robot.slides.size0, false))) || !((a_plan.robot.frames.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 3), 1, &a_plan.robot.frames.size0, false))) || !((a_plan.robot.carriers.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 4), 1, &a_plan.robot.carriers.size0, false))) || !((a_plan.robot.offsets.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 5), 2, &a_plan.robot.offsets.size0, false))) || !((a_plan.robot.bodies.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 6), 2, &a_plan.robot.bodies.size0, false))) || !((a_plan.robot.supports.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 7), 2, &a_plan.robot.supports.size0, false))) || !((a_plan.robot.armature.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 0), 8), 1, &a_plan.robot.armature.size0, false))) || !is_tuple(PyTuple_GET_ITEM(given[0], 1), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 8) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 6) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 0), &a_plan.step.arrays.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 1), &a_plan.step.arrays.sizes.m) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 2), &a_plan.step.arrays.sizes.p) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 3), &a_plan.step.arrays.sizes.joints) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 4), &a_plan.step.arrays.sizes.pairs) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 0), 5), &a_plan.step.arrays.sizes.frames) || !((a_plan.step.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 1), 2, &a_plan.step.arrays.table.size0, false))) || !((a_plan.step.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 2), 1, &a_plan.step.arrays.constants.size0, false))) || !((a_plan.step.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 3), 2, &a_plan.step.arrays.jacobian.size0, false))) || !((a_plan.step.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 4), 2, &a_plan.step.arrays.placements.size0, false))) || !((a_plan.step.arrays.support.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 5), 2, &a_plan.step.arrays.support.size0, false))) || !((a_plan.step.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 6), 2, &a_plan.step.arrays.inertia.size0, true))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 0), 7), &a_plan.step.arrays.tip) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 3) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 0), &a_plan.step.network.address) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 1), &a_plan.step.network.rates) || !((a_plan.step.network.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 1), 2), 1, &a_plan.step.network.settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_plan.step.network.settings.numbers.size0, 4, 1) || ((a_plan.step.network.settings = networks_integrators_base_AnswerSettings_of(a_plan.step.network.settings.numbers, (a_plan.step.network.settings.numbers.size0 - 4) / 1)), false) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 2) || !((a_plan.step.paths.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 0), 2, &a_plan.step.paths.table.size0, false))) || !((a_plan.step.paths.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 2), 1), 1, &a_plan.step.paths.constants.size0, false))) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 8) || !((a_plan.step.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 0), 1, &a_plan.step.yielding.weights.size0, false))) || !((a_plan.step.yielding.limits.numbers.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 1), 1, &a_plan.step.yielding.limits.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.step.yielding.limits.numbers.size0, 4, 8) || ((a_plan.step.yielding.limits = schemes_rate_limits_MotionConstants_of(a_plan.step.yielding.limits.numbers, (a_plan.step.yielding.limits.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 2), &a_plan.step.yielding.tolerance) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 3), &a_plan.step.yielding.rates) || !((a_plan.step.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 4), 1, &a_plan.step.yielding.scenes.size0, false))) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 5), &a_plan.step.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 6), &a_plan.step.yielding.coupled) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 3), 7), &a_plan.step.yielding.alike) || !((a_plan.step.fallback.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 4), 1, &a_plan.step.fallback.size0, false))) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 5), &a_plan.step.policy) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 6), &a_plan.step.samples) || !is_tuple(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 7) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 0), &a_plan.step.timing.dt) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 1), &a_plan.step.timing.expected) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 2), &a_plan.step.timing.hold) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 3), &a_plan.step.timing.longest) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 4), &a_plan.step.timing.fraction) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 5), &a_plan.step.timing.vary) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 1), 7), 6), &a_plan.step.timing.exceeded) || !read_int(PyTuple_GET_ITEM(given[0], 2), &a_plan.request) || !read_int(PyTuple_GET_ITEM(given[0], 3), &a_plan.scene) || !read_int(PyTuple_GET_ITEM(given[0], 4), &a_plan.width) || !((a_plan.motion.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_plan.motion.numbers.size0, false))) || !has_size("schemes_rate_limits_MotionConstants", a_plan.motion.numbers.size0, 4, 8) || ((a_plan.motion = schemes_rate_limits_MotionConstants_of(a_plan.motion.numbers, (a_plan.motion.numbers.size0 - 4) / 8)), false) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_plan.fastest) || !((a_plan.lower.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_plan.lower.size0, false))) || !((a_plan.upper.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_plan.upper.size0, false))) || !((a_plan.velocities.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_plan.velocities.size0, false))) || !((a_plan.settings.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_plan.settings.numbers.size0, false))) || !has_size("control_arms_ArmSettings", a_plan.settings.numbers.size0, 5, 0) || ((a_plan.settings = control_arms_ArmSettings_of(a_plan.settings.numbers)), false) || !is_tuple(PyTuple_GET_ITEM(given[0], 11), 8) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 0), &a_plan.sizes.n) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 1), &a_plan.sizes.request) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 2), &a_plan.sizes.motion) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 3), &a_plan.sizes.network) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 4), &a_plan.sizes.fallback) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 5), &a_plan.sizes.obstacles) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 6), &a_plan.sizes.limiting) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[0], 11), 7), &a_plan.sizes.sent) || !keep(given[0], &seen_plan, &a_plan, &kept_plan, sizeof a_plan))) || !((a_memories.data = read_doubles(given[1], 2, &a_memories.size0, true))) || !is_tuple(given[2], 5) || !((a_inputs.q.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_inputs.q.size0, false))) || !read_int(PyTuple_GET_ITEM(given[2], 1), &a_inputs.kind) || !((a_inputs.request.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_inputs.request.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 3), &a_inputs.dt) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_inputs.elapsed) || !((a_kinds.data = read_ints(given[3], 1, &a_kinds.size0, false))) || !read_int(given[4], &a_first) || !read_int(given[5], &a_last)) return NULL;

    (void)self;
    Py_BEGIN_ALLOW_THREADS control_arms_step_arms(arena_here(), &a_plan, a_memories, &a_inputs, a_kinds, a_first, a_last); Py_END_ALLOW_THREADS
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_requests_add_request(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("control_requests_add_request", count, 4) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, true)))) return NULL;

    (void)self;
    control_requests_add_request(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_base_enter_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    qp_layout_QPViews a_qp;
    Vector a_constants;
    Vector a_state;
    Vector a_rates;
    if (!counted("networks_base_enter_rates", count, 5) || !read_int(given[0], &a_address) || !is_tuple(given[1], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_qp.ub.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[3], 1, &a_state.size0, false))) || !((a_rates.data = read_doubles(given[4], 1, &a_rates.size0, false)))) return NULL;

    (void)self;
    networks_base_enter_rates(arena_here(), a_address, &a_qp, a_constants, a_state, a_rates);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_rotate(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    int64_t a_i;
    int64_t a_k;
    if (!counted("qp_dense_rotate", count, 3) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, true))) || !read_int(given[1], &a_i) || !read_int(given[2], &a_k)) return NULL;

    (void)self;
    qp_dense_rotate(arena_here(), a_K, a_i, a_k);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_extreme_eigenvalues(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    if (!counted("qp_dense_extreme_eigenvalues", count, 1) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, true)))) return NULL;
    double_2 result;
    (void)self;
    result = qp_dense_extreme_eigenvalues(arena_here(), a_K);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_networks_projection_stable_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_active;
    if (!counted("networks_projection_stable_step", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_active.data = read_doubles(given[1], 1, &a_active.size0, false)))) return NULL;
    double result;
    (void)self;
    result = networks_projection_stable_step(arena_here(), &a_qp, a_active);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_integrators_explicit_advance_explicitly(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    int64_t a_rates;
    networks_integrators_base_AnswerSettings a_settings;
    Vector a_state;
    Vector a_point;
    if (!counted("networks_integrators_explicit_advance_explicitly", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[1], &a_rates) || !((a_settings.numbers.data = read_doubles(given[2], 1, &a_settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_settings.numbers.size0, 4, 1) || ((a_settings = networks_integrators_base_AnswerSettings_of(a_settings.numbers, (a_settings.numbers.size0 - 4) / 1)), false) || !((a_state.data = read_doubles(given[3], 1, &a_state.size0, true))) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, true)))) return NULL;
    double_5 result;
    (void)self;
    result = networks_integrators_explicit_advance_explicitly(arena_here(), &a_qp, a_rates, &a_settings, a_state, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_networks_integrators_implicit_step_program(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    Vector a_s;
    double a_step;
    if (!counted("networks_integrators_implicit_step_program", count, 6) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p) || !((a_s.data = read_doubles(given[4], 1, &a_s.size0, true))) || !read_double(given[5], &a_step)) return NULL;
    int64_t result;
    (void)self;
    result = networks_integrators_implicit_step_program(arena_here(), a_data, a_n, a_m, a_p, a_s, a_step);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_networks_integrators_implicit_solve(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    int64_t a_rates;
    networks_integrators_base_AnswerSettings a_settings;
    Vector a_s;
    Vector a_point;
    if (!counted("networks_integrators_implicit_solve", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[1], &a_rates) || !((a_settings.numbers.data = read_doubles(given[2], 1, &a_settings.numbers.size0, false))) || !has_size("networks_integrators_base_AnswerSettings", a_settings.numbers.size0, 4, 1) || ((a_settings = networks_integrators_base_AnswerSettings_of(a_settings.numbers, (a_settings.numbers.size0 - 4) / 1)), false) || !((a_s.data = read_doubles(given[3], 1, &a_s.size0, true))) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, true)))) return NULL;
    double_5 result;
    (void)self;
    result = networks_integrators_implicit_solve(arena_here(), &a_qp, a_rates, &a_settings, a_s, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_networks_integrators_implicit_solve_program(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int_3 a_sizes;
    Vector a_s;
    Vector a_point;
    double a_tol;
    int64_t a_max_linear_solves;
    if (!counted("networks_integrators_implicit_solve_program", count, 6) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !is_tuple(given[1], 3) || !read_int(PyTuple_GET_ITEM(given[1], 0), &a_sizes.at[0]) || !read_int(PyTuple_GET_ITEM(given[1], 1), &a_sizes.at[1]) || !read_int(PyTuple_GET_ITEM(given[1], 2), &a_sizes.at[2]) || !((a_s.data = read_doubles(given[2], 1, &a_s.size0, true))) || !((a_point.data = read_doubles(given[3], 1, &a_point.size0, true))) || !read_double(given[4], &a_tol) || !read_int(given[5], &a_max_linear_solves)) return NULL;
    double_5 result;
    (void)self;
    Py_BEGIN_ALLOW_THREADS result = networks_integrators_implicit_solve_program(arena_here(), a_data, a_sizes, a_s, a_point, a_tol, a_max_linear_solves); Py_END_ALLOW_THREADS
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_networks_integrators_scaling_is_ordinary_size(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_largest;
    bool a_holds;
    if (!counted("networks_integrators_scaling_is_ordinary_size", count, 2) || !read_double(given[0], &a_largest) || !read_bool(given[1], &a_holds)) return NULL;
    bool result;
    (void)self;
    result = networks_integrators_scaling_is_ordinary_size(arena_here(), a_largest, a_holds);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_networks_integrators_scaling_is_ordinary(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("networks_integrators_scaling_is_ordinary", count, 4) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p)) return NULL;
    bool result;
    (void)self;
    result = networks_integrators_scaling_is_ordinary(arena_here(), a_data, a_n, a_m, a_p);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_networks_integrators_scaling_power_of_two(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_size;
    if (!counted("networks_integrators_scaling_power_of_two", count, 1) || !read_double(given[0], &a_size)) return NULL;
    double result;
    (void)self;
    result = networks_integrators_scaling_power_of_two(arena_here(), a_size);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_integrators_scaling_balance(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_kkt;
    Vector a_limits;
    int64_t a_rounds;
    Vector a_units;
    if (!counted("networks_integrators_scaling_balance", count, 4) || !((a_kkt.data = read_doubles(given[0], 2, &a_kkt.size0, false))) || !((a_limits.data = read_doubles(given[1], 1, &a_limits.size0, false))) || !read_int(given[2], &a_rounds) || !((a_units.data = read_doubles(given[3], 1, &a_units.size0, true)))) return NULL;

    (void)self;
    networks_integrators_scaling_balance(arena_here(), a_kkt, a_limits, a_rounds, a_units);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_projection_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_qp;
    Vector a_constants;
    Vector a_state;
    Vector a_rates;
    if (!counted("networks_projection_projection_rates", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, false))) || !((a_rates.data = read_doubles(given[3], 1, &a_rates.size0, true)))) return NULL;

    (void)self;
    networks_projection_projection_rates(arena_here(), &a_qp, a_constants, a_state, a_rates);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_certificates_dot_twice(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_rows;
    Vector a_vector;
    Vector a_products;
    Vector a_rounding;
    if (!counted("qp_certificates_dot_twice", count, 4) || !((a_rows.data = read_doubles(given[0], 2, &a_rows.size0, false))) || !((a_vector.data = read_doubles(given[1], 1, &a_vector.size0, false))) || !((a_products.data = read_doubles(given[2], 1, &a_products.size0, true))) || !((a_rounding.data = read_doubles(given[3], 1, &a_rounding.size0, true)))) return NULL;

    (void)self;
    qp_certificates_dot_twice(arena_here(), a_rows, a_vector, a_products, a_rounding);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_is_symmetric(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_P;
    double a_largest;
    if (!counted("qp_dense_is_symmetric", count, 2) || !((a_P.data = read_doubles(given[0], 2, &a_P.size0, false))) || !read_double(given[1], &a_largest)) return NULL;
    bool result;
    (void)self;
    result = qp_dense_is_symmetric(arena_here(), a_P, a_largest);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_dense_symmetrize(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_P;
    if (!counted("qp_dense_symmetrize", count, 1) || !((a_P.data = read_doubles(given[0], 2, &a_P.size0, true)))) return NULL;

    (void)self;
    qp_dense_symmetrize(arena_here(), a_P);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_is_convex(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_P;
    Matrix a_K;
    if (!counted("qp_dense_is_convex", count, 2) || !((a_P.data = read_doubles(given[0], 2, &a_P.size0, false))) || !((a_K.data = read_doubles(given[1], 2, &a_K.size0, true)))) return NULL;
    bool result;
    (void)self;
    result = qp_dense_is_convex(arena_here(), a_P, a_K);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_program_pack(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    qp_layout_QPViews a_fields;
    Vector a_data;
    if (!counted("qp_program_pack", count, 2) || !is_tuple(given[0], 8) || !((a_fields.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_fields.P.size0, false))) || !((a_fields.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_fields.q.size0, false))) || !((a_fields.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_fields.G.size0, false))) || !((a_fields.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_fields.h.size0, false))) || !((a_fields.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_fields.A.size0, false))) || !((a_fields.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_fields.b.size0, false))) || !((a_fields.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_fields.lb.size0, false))) || !((a_fields.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_fields.ub.size0, false))) || !((a_data.data = read_doubles(given[1], 1, &a_data.size0, true)))) return NULL;
    bool result;
    (void)self;
    result = qp_program_pack(arena_here(), &a_fields, a_data);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_program_has_numbers(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("qp_program_has_numbers", count, 4) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p)) return NULL;
    bool result;
    (void)self;
    result = qp_program_has_numbers(arena_here(), a_data, a_n, a_m, a_p);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_residuals_residuals_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    Vector a_point;
    if (!counted("qp_residuals_residuals_of", count, 5) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, false)))) return NULL;
    double_3 result;
    (void)self;
    result = qp_residuals_residuals_of(arena_here(), a_data, a_n, a_m, a_p, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_qp_residuals_is_accepted(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    Vector a_point;
    double a_eps_abs;
    double a_eps_rel;
    if (!counted("qp_residuals_is_accepted", count, 7) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, false))) || !read_double(given[5], &a_eps_abs) || !read_double(given[6], &a_eps_rel)) return NULL;
    bool result;
    (void)self;
    result = qp_residuals_is_accepted(arena_here(), a_data, a_n, a_m, a_p, a_point, a_eps_abs, a_eps_rel);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_references_base_soft_clock(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    double a_begin;
    if (!counted("references_base_soft_clock", count, 2) || !read_double(given[0], &a_t) || !read_double(given[1], &a_begin)) return NULL;
    double_2 result;
    (void)self;
    result = references_base_soft_clock(arena_here(), a_t, a_begin);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_references_moving_target_paced(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_path;
    double a_fastest;
    double a_elapsed;
    if (!counted("references_moving_target_paced", count, 3) || !((a_path.data = read_doubles(given[0], 1, &a_path.size0, true))) || !read_double(given[1], &a_fastest) || !read_double(given[2], &a_elapsed)) return NULL;
    double result;
    (void)self;
    result = references_moving_target_paced(arena_here(), a_path, a_fastest, a_elapsed);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_references_rotations_rotated(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_w;
    double_3 a_u;
    double_3 a_v;
    if (!counted("references_rotations_rotated", count, 3) || !read_double(given[0], &a_w) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_u.at[2]) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_v.at[2])) return NULL;
    double_3 result;
    (void)self;
    result = references_rotations_rotated(arena_here(), a_w, a_u, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_column_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_R;
    int64_t a_j;
    if (!counted("references_rotations_column_of", count, 2) || !((a_R.data = read_doubles(given[0], 2, &a_R.size0, false))) || !read_int(given[1], &a_j)) return NULL;
    double_3 result;
    (void)self;
    result = references_rotations_column_of(arena_here(), a_R, a_j);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_turn_target(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    references_targets_TargetData a_target;
    double a_w;
    double_3 a_u;
    double a_w_rate;
    double_3 a_u_rate;
    if (!counted("references_rotations_turn_target", count, 5) || !((a_target.numbers.data = read_doubles(given[0], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !read_double(given[1], &a_w) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_u.at[2]) || !read_double(given[3], &a_w_rate) || !is_tuple(given[4], 3) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_u_rate.at[0]) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_u_rate.at[1]) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_u_rate.at[2])) return NULL;

    (void)self;
    references_rotations_turn_target(arena_here(), &a_target, a_w, a_u, a_w_rate, a_u_rate);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_rotations_turn_about(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    references_targets_TargetData a_target;
    double_3 a_axis;
    double a_angle;
    double a_rate;
    if (!counted("references_rotations_turn_about", count, 4) || !((a_target.numbers.data = read_doubles(given[0], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_axis.at[2]) || !read_double(given[2], &a_angle) || !read_double(given[3], &a_rate)) return NULL;

    (void)self;
    references_rotations_turn_about(arena_here(), &a_target, a_axis, a_angle, a_rate);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_moving_target_approach(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    references_targets_TargetData a_target;
    references_targets_TargetData a_goal;
    double a_elapsed;
    double a_speed;
    double a_rate;
    if (!counted("references_moving_target_approach", count, 5) || !((a_target.numbers.data = read_doubles(given[0], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_goal.numbers.data = read_doubles(given[1], 1, &a_goal.numbers.size0, false))) || !has_size("references_targets_TargetData", a_goal.numbers.size0, 18, 0) || ((a_goal = references_targets_TargetData_of(a_goal.numbers)), false) || !read_double(given[2], &a_elapsed) || !read_double(given[3], &a_speed) || !read_double(given[4], &a_rate)) return NULL;

    (void)self;
    references_moving_target_approach(arena_here(), &a_target, &a_goal, a_elapsed, a_speed, a_rate);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_heart_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_shapes_heart_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_shapes_heart_path(arena_here(), a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_lissajous_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_shapes_lissajous_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_shapes_lissajous_path(arena_here(), a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_fixed_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_shapes_fixed_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_shapes_fixed_path(arena_here(), a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_turning_cone_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_turning_cone_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_turning_cone_path(arena_here(), a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_waypoints_piece(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_pieces;
    double a_t;
    if (!counted("references_waypoints_piece", count, 2) || !((a_pieces.data = read_doubles(given[0], 2, &a_pieces.size0, false))) || !read_double(given[1], &a_t)) return NULL;
    int64_t result;
    (void)self;
    result = references_waypoints_piece(arena_here(), a_pieces, a_t);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_references_waypoints_waypoints_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_waypoints_waypoints_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_waypoints_waypoints_path(arena_here(), a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_turning_tilting_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    references_targets_TargetData a_target;
    if (!counted("references_turning_tilting_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, true))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false)) return NULL;

    (void)self;
    references_turning_tilting_path(arena_here(), a_t, a_constants, &a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_collisions_kept_distance(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_scene_SceneViews a_scene;
    schemes_scene_Contact a_contact;
    double a_kept;
    if (!counted("schemes_collisions_kept_distance", count, 3) || !is_tuple(given[0], 4) || !((a_scene.head.numbers.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_scene.head.numbers.size0, false))) || !has_size("schemes_scene_SceneHead", a_scene.head.numbers.size0, 6, 0) || ((a_scene.head = schemes_scene_SceneHead_of(a_scene.head.numbers)), false) || !((a_scene.dq_max.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_scene.dq_max.size0, false))) || !((a_scene.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_scene.bodies.size0, false))) || !((a_scene.pairs.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_scene.pairs.size0, false))) || !is_tuple(given[1], 3) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), &a_contact.second.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), &a_contact.second.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), &a_contact.second.at[2]) || !is_tuple(PyTuple_GET_ITEM(given[1], 1), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 0), &a_contact.normal.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 1), &a_contact.normal.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 2), &a_contact.normal.at[2]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_contact.distance) || !read_double(given[2], &a_kept)) return NULL;
    double result;
    (void)self;
    result = schemes_collisions_kept_distance(arena_here(), &a_scene, &a_contact, a_kept);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_collisions_write_ends(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    schemes_scene_SceneViews a_scene;
    Matrix a_placed;
    int64_t a_k;
    Matrix a_gradients;
    Vector a_limits;
    Vector a_slacks;
    if (!counted("schemes_collisions_write_ends", count, 7) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, true))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !is_tuple(given[1], 4) || !((a_scene.head.numbers.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_scene.head.numbers.size0, false))) || !has_size("schemes_scene_SceneHead", a_scene.head.numbers.size0, 6, 0) || ((a_scene.head = schemes_scene_SceneHead_of(a_scene.head.numbers)), false) || !((a_scene.dq_max.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_scene.dq_max.size0, false))) || !((a_scene.bodies.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_scene.bodies.size0, false))) || !((a_scene.pairs.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_scene.pairs.size0, false))) || !((a_placed.data = read_doubles(given[2], 2, &a_placed.size0, false))) || !read_int(given[3], &a_k) || !((a_gradients.data = read_doubles(given[4], 2, &a_gradients.size0, true))) || !((a_limits.data = read_doubles(given[5], 1, &a_limits.size0, true))) || !((a_slacks.data = read_doubles(given[6], 1, &a_slacks.size0, true)))) return NULL;

    (void)self;
    schemes_collisions_write_ends(arena_here(), &a_step, &a_scene, a_placed, a_k, a_gradients, a_limits, a_slacks);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_collisions_rank(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_slacks;
    int64_t a_k;
    if (!counted("schemes_collisions_rank", count, 2) || !((a_slacks.data = read_doubles(given[0], 1, &a_slacks.size0, false))) || !read_int(given[1], &a_k)) return NULL;
    int64_t result;
    (void)self;
    result = schemes_collisions_rank(arena_here(), a_slacks, a_k);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_schemes_collisions_collision_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_collisions_collision_rows", count, 6) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, true))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, true))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, true))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, false))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, false)))) return NULL;

    (void)self;
    schemes_collisions_collision_rows(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_costs_add_kinetic_energy(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_costs_add_kinetic_energy", count, 4) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, false)))) return NULL;

    (void)self;
    schemes_costs_add_kinetic_energy(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_costs_add_cyclic_motion(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_costs_add_cyclic_motion", count, 4) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, true)))) return NULL;

    (void)self;
    schemes_costs_add_cyclic_motion(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_joint_limits_position_dependent_speed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_distance;
    double a_offset;
    double a_deceleration;
    if (!counted("schemes_joint_limits_position_dependent_speed", count, 3) || !read_double(given[0], &a_distance) || !read_double(given[1], &a_offset) || !read_double(given[2], &a_deceleration)) return NULL;
    double result;
    (void)self;
    result = schemes_joint_limits_position_dependent_speed(arena_here(), a_distance, a_offset, a_deceleration);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_joint_limits_speed_kind(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_bound;
    double a_speed;
    double a_fastest;
    if (!counted("schemes_joint_limits_speed_kind", count, 3) || !read_double(given[0], &a_bound) || !read_double(given[1], &a_speed) || !read_double(given[2], &a_fastest)) return NULL;
    int64_t result;
    (void)self;
    result = schemes_joint_limits_speed_kind(arena_here(), a_bound, a_speed, a_fastest);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_schemes_joint_limits_joint_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_joint_limits_joint_limits", count, 6) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, true))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, true))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    (void)self;
    schemes_joint_limits_joint_limits(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_parts_copy_cost", count, 4) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, true)))) return NULL;

    (void)self;
    schemes_parts_copy_cost(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_parts_copy_rows", count, 3) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !((a_A.data = read_doubles(given[1], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[2], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_parts_copy_rows(arena_here(), a_constants, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_parts_copy_task", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_parts_copy_task(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_limit(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_parts_copy_limit", count, 6) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, true))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, true))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    (void)self;
    schemes_parts_copy_limit(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_rate_limits_motion_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_rate_limits_motion_limits", count, 6) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, true))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, true))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    (void)self;
    schemes_rate_limits_motion_limits(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_scene_raise_end_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    Matrix a_jacobian;
    Matrix a_placements;
    Matrix a_rates;
    if (!counted("schemes_scene_raise_end_rates", count, 4) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !((a_jacobian.data = read_doubles(given[1], 2, &a_jacobian.size0, false))) || !((a_placements.data = read_doubles(given[2], 2, &a_placements.size0, false))) || !((a_rates.data = read_doubles(given[3], 2, &a_rates.size0, true)))) return NULL;

    (void)self;
    schemes_scene_raise_end_rates(arena_here(), a_constants, a_jacobian, a_placements, a_rates);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_step_write_velocity(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    schemes_step_FrameConstants a_own;
    double_3 a_point;
    double_3 a_axis;
    Vector a_row;
    if (!counted("schemes_step_write_velocity", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_own.numbers.data = read_doubles(given[1], 1, &a_own.numbers.size0, false))) || !has_size("schemes_step_FrameConstants", a_own.numbers.size0, 3, 0) || ((a_own = schemes_step_FrameConstants_of(a_own.numbers)), false) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_point.at[2]) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_axis.at[2]) || !((a_row.data = read_doubles(given[4], 1, &a_row.size0, true)))) return NULL;

    (void)self;
    schemes_step_write_velocity(arena_here(), &a_step, &a_own, a_point, a_axis, a_row);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_step_write_spin(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    schemes_step_FrameConstants a_own;
    double_3 a_axis;
    Vector a_row;
    if (!counted("schemes_step_write_spin", count, 4) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_own.numbers.data = read_doubles(given[1], 1, &a_own.numbers.size0, false))) || !has_size("schemes_step_FrameConstants", a_own.numbers.size0, 3, 0) || ((a_own = schemes_step_FrameConstants_of(a_own.numbers)), false) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_axis.at[2]) || !((a_row.data = read_doubles(given[3], 1, &a_row.size0, true)))) return NULL;

    (void)self;
    schemes_step_write_spin(arena_here(), &a_step, &a_own, a_axis, a_row);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_position_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_position_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_position_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_rotation_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_rotation_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_rotation_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_project_on_range(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_axes;
    Vector a_b;
    if (!counted("schemes_tasks_project_on_range", count, 2) || !((a_axes.data = read_doubles(given[0], 2, &a_axes.size0, false))) || !((a_b.data = read_doubles(given[1], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_project_on_range(arena_here(), a_axes, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_block_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_block_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_block_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_pose_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_pose_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_pose_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_held_pose_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_held_pose_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_held_pose_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_axis_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_axis_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_axis_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_remote_center_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_remote_center_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_remote_center_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_joint_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    references_targets_TargetData a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_joint_rows", count, 5) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.numbers.data = read_doubles(given[2], 1, &a_target.numbers.size0, false))) || !has_size("references_targets_TargetData", a_target.numbers.size0, 18, 0) || ((a_target = references_targets_TargetData_of(a_target.numbers)), false) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    (void)self;
    schemes_tasks_joint_rows(arena_here(), &a_step, a_constants, &a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tip_speed_tip_speed_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    schemes_step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_tip_speed_tip_speed_bounds", count, 6) || !is_tuple(given[0], 13) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.support.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.support.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_step.least.data = read_doubles(PyTuple_GET_ITEM(given[0], 10), 1, &a_step.least.size0, false))) || !((a_step.lower_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 11), 1, &a_step.lower_kind.size0, false))) || !((a_step.upper_kind.data = read_doubles(PyTuple_GET_ITEM(given[0], 12), 1, &a_step.upper_kind.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    (void)self;
    schemes_tip_speed_tip_speed_bounds(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyMethodDef methods[] = {
    {"compiling_trigonometry_sin_cos", (PyCFunction)(void (*)(void))py_compiling_trigonometry_sin_cos, METH_FASTCALL, NULL},
    {"compiling_trigonometry_sin", (PyCFunction)(void (*)(void))py_compiling_trigonometry_sin, METH_FASTCALL, NULL},
    {"qp_layout_copied", (PyCFunction)(void (*)(void))py_qp_layout_copied, METH_FASTCALL, NULL},
    {"control_arms_rest_arm", (PyCFunction)(void (*)(void))py_control_arms_rest_arm, METH_FASTCALL, NULL},
    {"control_arms_place_arm", (PyCFunction)(void (*)(void))py_control_arms_place_arm, METH_FASTCALL, NULL},
    {"control_arms_halt_arm", (PyCFunction)(void (*)(void))py_control_arms_halt_arm, METH_FASTCALL, NULL},
    {"control_arms_send_arm", (PyCFunction)(void (*)(void))py_control_arms_send_arm, METH_FASTCALL, NULL},
    {"qp_dense_all_finite", (PyCFunction)(void (*)(void))py_qp_dense_all_finite, METH_FASTCALL, NULL},
    {"control_arms_differing", (PyCFunction)(void (*)(void))py_control_arms_differing, METH_FASTCALL, NULL},
    {"control_arms_begin_step", (PyCFunction)(void (*)(void))py_control_arms_begin_step, METH_FASTCALL, NULL},
    {"robot_kinematics_kernel_turn_into", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_turn_into, METH_FASTCALL, NULL},
    {"robot_kinematics_kernel_compose", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_compose, METH_FASTCALL, NULL},
    {"robot_kinematics_kernel_move", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_move, METH_FASTCALL, NULL},
    {"robot_kinematics_kernel_write_twist", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_write_twist, METH_FASTCALL, NULL},
    {"robot_kinematics_kernel_write_inertia", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_write_inertia, METH_FASTCALL, NULL},
    {"robot_kinematics_kernel_write_kinematics", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_write_kinematics, METH_FASTCALL, NULL},
    {"qp_layout_data_size", (PyCFunction)(void (*)(void))py_qp_layout_data_size, METH_FASTCALL, NULL},
    {"control_command_log_sizes", (PyCFunction)(void (*)(void))py_control_command_log_sizes, METH_FASTCALL, NULL},
    {"qp_layout_larger", (PyCFunction)(void (*)(void))py_qp_layout_larger, METH_FASTCALL, NULL},
    {"qp_dense_largest_entry", (PyCFunction)(void (*)(void))py_qp_dense_largest_entry, METH_FASTCALL, NULL},
    {"schemes_profiles_usable_jerk", (PyCFunction)(void (*)(void))py_schemes_profiles_usable_jerk, METH_FASTCALL, NULL},
    {"schemes_profiles_approach", (PyCFunction)(void (*)(void))py_schemes_profiles_approach, METH_FASTCALL, NULL},
    {"schemes_profiles_stopping_distance", (PyCFunction)(void (*)(void))py_schemes_profiles_stopping_distance, METH_FASTCALL, NULL},
    {"schemes_profiles_highest", (PyCFunction)(void (*)(void))py_schemes_profiles_highest, METH_FASTCALL, NULL},
    {"schemes_viability_ceiling", (PyCFunction)(void (*)(void))py_schemes_viability_ceiling, METH_FASTCALL, NULL},
    {"schemes_viability_ceiling_below_velocity_limit", (PyCFunction)(void (*)(void))py_schemes_viability_ceiling_below_velocity_limit, METH_FASTCALL, NULL},
    {"schemes_profiles_easing", (PyCFunction)(void (*)(void))py_schemes_profiles_easing, METH_FASTCALL, NULL},
    {"schemes_viability_rate_kind", (PyCFunction)(void (*)(void))py_schemes_viability_rate_kind, METH_FASTCALL, NULL},
    {"schemes_viability_position_kind", (PyCFunction)(void (*)(void))py_schemes_viability_position_kind, METH_FASTCALL, NULL},
    {"schemes_viability_jerk_bounds", (PyCFunction)(void (*)(void))py_schemes_viability_jerk_bounds, METH_FASTCALL, NULL},
    {"schemes_viability_speed_within", (PyCFunction)(void (*)(void))py_schemes_viability_speed_within, METH_FASTCALL, NULL},
    {"schemes_viability_acceleration_bounds", (PyCFunction)(void (*)(void))py_schemes_viability_acceleration_bounds, METH_FASTCALL, NULL},
    {"schemes_viability_joint_bounds", (PyCFunction)(void (*)(void))py_schemes_viability_joint_bounds, METH_FASTCALL, NULL},
    {"schemes_profiles_arriving", (PyCFunction)(void (*)(void))py_schemes_profiles_arriving, METH_FASTCALL, NULL},
    {"schemes_profiles_braking", (PyCFunction)(void (*)(void))py_schemes_profiles_braking, METH_FASTCALL, NULL},
    {"references_base_enter_path", (PyCFunction)(void (*)(void))py_references_base_enter_path, METH_FASTCALL, NULL},
    {"references_rotations_dot", (PyCFunction)(void (*)(void))py_references_rotations_dot, METH_FASTCALL, NULL},
    {"references_rotations_triple", (PyCFunction)(void (*)(void))py_references_rotations_triple, METH_FASTCALL, NULL},
    {"references_rotations_rotation_log", (PyCFunction)(void (*)(void))py_references_rotations_rotation_log, METH_FASTCALL, NULL},
    {"references_rotations_set_mean_twist", (PyCFunction)(void (*)(void))py_references_rotations_set_mean_twist, METH_FASTCALL, NULL},
    {"control_cycle_sample_targets", (PyCFunction)(void (*)(void))py_control_cycle_sample_targets, METH_FASTCALL, NULL},
    {"control_cycle_is_valid", (PyCFunction)(void (*)(void))py_control_cycle_is_valid, METH_FASTCALL, NULL},
    {"schemes_rate_limits_state_periods", (PyCFunction)(void (*)(void))py_schemes_rate_limits_state_periods, METH_FASTCALL, NULL},
    {"qp_layout_offsets", (PyCFunction)(void (*)(void))py_qp_layout_offsets, METH_FASTCALL, NULL},
    {"schemes_parts_enter_cost", (PyCFunction)(void (*)(void))py_schemes_parts_enter_cost, METH_FASTCALL, NULL},
    {"schemes_parts_enter_task", (PyCFunction)(void (*)(void))py_schemes_parts_enter_task, METH_FASTCALL, NULL},
    {"schemes_program_add_soft", (PyCFunction)(void (*)(void))py_schemes_program_add_soft, METH_FASTCALL, NULL},
    {"schemes_parts_enter_limit", (PyCFunction)(void (*)(void))py_schemes_parts_enter_limit, METH_FASTCALL, NULL},
    {"schemes_program_keep_kinds", (PyCFunction)(void (*)(void))py_schemes_program_keep_kinds, METH_FASTCALL, NULL},
    {"schemes_program_assemble", (PyCFunction)(void (*)(void))py_schemes_program_assemble, METH_FASTCALL, NULL},
    {"networks_integrators_base_enter_answer", (PyCFunction)(void (*)(void))py_networks_integrators_base_enter_answer, METH_FASTCALL, NULL},
    {"qp_residuals_within", (PyCFunction)(void (*)(void))py_qp_residuals_within, METH_FASTCALL, NULL},
    {"qp_residuals_product_terms", (PyCFunction)(void (*)(void))py_qp_residuals_product_terms, METH_FASTCALL, NULL},
    {"qp_residuals_weight_of", (PyCFunction)(void (*)(void))py_qp_residuals_weight_of, METH_FASTCALL, NULL},
    {"qp_residuals_cost_size", (PyCFunction)(void (*)(void))py_qp_residuals_cost_size, METH_FASTCALL, NULL},
    {"qp_residuals_cost_is_small_enough", (PyCFunction)(void (*)(void))py_qp_residuals_cost_is_small_enough, METH_FASTCALL, NULL},
    {"qp_residuals_is_small_enough", (PyCFunction)(void (*)(void))py_qp_residuals_is_small_enough, METH_FASTCALL, NULL},
    {"control_cycle_status_of", (PyCFunction)(void (*)(void))py_control_cycle_status_of, METH_FASTCALL, NULL},
    {"control_stopping_cubic_coefficient", (PyCFunction)(void (*)(void))py_control_stopping_cubic_coefficient, METH_FASTCALL, NULL},
    {"control_stopping_velocity_at", (PyCFunction)(void (*)(void))py_control_stopping_velocity_at, METH_FASTCALL, NULL},
    {"control_stopping_next_velocity", (PyCFunction)(void (*)(void))py_control_stopping_next_velocity, METH_FASTCALL, NULL},
    {"control_stopping_within_rates", (PyCFunction)(void (*)(void))py_control_stopping_within_rates, METH_FASTCALL, NULL},
    {"control_stopping_least_periods", (PyCFunction)(void (*)(void))py_control_stopping_least_periods, METH_FASTCALL, NULL},
    {"control_stopping_write_cubic_coefficients", (PyCFunction)(void (*)(void))py_control_stopping_write_cubic_coefficients, METH_FASTCALL, NULL},
    {"control_stopping_displacement_after", (PyCFunction)(void (*)(void))py_control_stopping_displacement_after, METH_FASTCALL, NULL},
    {"control_stopping_least_displacement", (PyCFunction)(void (*)(void))py_control_stopping_least_displacement, METH_FASTCALL, NULL},
    {"control_stopping_end_displacement", (PyCFunction)(void (*)(void))py_control_stopping_end_displacement, METH_FASTCALL, NULL},
    {"control_stopping_keeps_varying_limit", (PyCFunction)(void (*)(void))py_control_stopping_keeps_varying_limit, METH_FASTCALL, NULL},
    {"control_stopping_keeps_joint_limits", (PyCFunction)(void (*)(void))py_control_stopping_keeps_joint_limits, METH_FASTCALL, NULL},
    {"schemes_scene_place_bodies", (PyCFunction)(void (*)(void))py_schemes_scene_place_bodies, METH_FASTCALL, NULL},
    {"references_rotations_combined", (PyCFunction)(void (*)(void))py_references_rotations_combined, METH_FASTCALL, NULL},
    {"schemes_scene_ends_of", (PyCFunction)(void (*)(void))py_schemes_scene_ends_of, METH_FASTCALL, NULL},
    {"schemes_step_seen_from", (PyCFunction)(void (*)(void))py_schemes_step_seen_from, METH_FASTCALL, NULL},
    {"schemes_scene_beyond", (PyCFunction)(void (*)(void))py_schemes_scene_beyond, METH_FASTCALL, NULL},
    {"schemes_scene_nearest_parameter", (PyCFunction)(void (*)(void))py_schemes_scene_nearest_parameter, METH_FASTCALL, NULL},
    {"schemes_scene_depth", (PyCFunction)(void (*)(void))py_schemes_scene_depth, METH_FASTCALL, NULL},
    {"references_rotations_scaled", (PyCFunction)(void (*)(void))py_references_rotations_scaled, METH_FASTCALL, NULL},
    {"schemes_step_axis_at", (PyCFunction)(void (*)(void))py_schemes_step_axis_at, METH_FASTCALL, NULL},
    {"schemes_scene_second_order", (PyCFunction)(void (*)(void))py_schemes_scene_second_order, METH_FASTCALL, NULL},
    {"references_rotations_cross", (PyCFunction)(void (*)(void))py_references_rotations_cross, METH_FASTCALL, NULL},
    {"schemes_step_point_rate", (PyCFunction)(void (*)(void))py_schemes_step_point_rate, METH_FASTCALL, NULL},
    {"schemes_step_rate_along", (PyCFunction)(void (*)(void))py_schemes_step_rate_along, METH_FASTCALL, NULL},
    {"control_stopping_along", (PyCFunction)(void (*)(void))py_control_stopping_along, METH_FASTCALL, NULL},
    {"schemes_scene_height_of", (PyCFunction)(void (*)(void))py_schemes_scene_height_of, METH_FASTCALL, NULL},
    {"control_stopping_keeps_distances", (PyCFunction)(void (*)(void))py_control_stopping_keeps_distances, METH_FASTCALL, NULL},
    {"qp_dense_long_dot", (PyCFunction)(void (*)(void))py_qp_dense_long_dot, METH_FASTCALL, NULL},
    {"qp_dense_dot", (PyCFunction)(void (*)(void))py_qp_dense_dot, METH_FASTCALL, NULL},
    {"qp_dense_row_dot", (PyCFunction)(void (*)(void))py_qp_dense_row_dot, METH_FASTCALL, NULL},
    {"control_command_is_active", (PyCFunction)(void (*)(void))py_control_command_is_active, METH_FASTCALL, NULL},
    {"control_fallback_copy_cost", (PyCFunction)(void (*)(void))py_control_fallback_copy_cost, METH_FASTCALL, NULL},
    {"control_fallback_copy_limits", (PyCFunction)(void (*)(void))py_control_fallback_copy_limits, METH_FASTCALL, NULL},
    {"control_fallback_longest_asked", (PyCFunction)(void (*)(void))py_control_fallback_longest_asked, METH_FASTCALL, NULL},
    {"networks_projection_write_spans", (PyCFunction)(void (*)(void))py_networks_projection_write_spans, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_longest_step", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_longest_step, METH_FASTCALL, NULL},
    {"qp_dense_times", (PyCFunction)(void (*)(void))py_qp_dense_times, METH_FASTCALL, NULL},
    {"qp_dense_add_multiple", (PyCFunction)(void (*)(void))py_qp_dense_add_multiple, METH_FASTCALL, NULL},
    {"qp_dense_add_row", (PyCFunction)(void (*)(void))py_qp_dense_add_row, METH_FASTCALL, NULL},
    {"networks_projection_add_transposed", (PyCFunction)(void (*)(void))py_networks_projection_add_transposed, METH_FASTCALL, NULL},
    {"networks_projection_rows_times", (PyCFunction)(void (*)(void))py_networks_projection_rows_times, METH_FASTCALL, NULL},
    {"networks_projection_write_slacks", (PyCFunction)(void (*)(void))py_networks_projection_write_slacks, METH_FASTCALL, NULL},
    {"networks_projection_unprojected_rates", (PyCFunction)(void (*)(void))py_networks_projection_unprojected_rates, METH_FASTCALL, NULL},
    {"qp_residuals_point_residuals", (PyCFunction)(void (*)(void))py_qp_residuals_point_residuals, METH_FASTCALL, NULL},
    {"qp_residuals_kkt_point", (PyCFunction)(void (*)(void))py_qp_residuals_kkt_point, METH_FASTCALL, NULL},
    {"networks_projection_mark_active", (PyCFunction)(void (*)(void))py_networks_projection_mark_active, METH_FASTCALL, NULL},
    {"qp_dense_add_outer", (PyCFunction)(void (*)(void))py_qp_dense_add_outer, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_count_row", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_count_row, METH_FASTCALL, NULL},
    {"qp_dense_weighted_sum", (PyCFunction)(void (*)(void))py_qp_dense_weighted_sum, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_build_condensed", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_build_condensed, METH_FASTCALL, NULL},
    {"qp_dense_cholesky_factor", (PyCFunction)(void (*)(void))py_qp_dense_cholesky_factor, METH_FASTCALL, NULL},
    {"qp_dense_factor_solve", (PyCFunction)(void (*)(void))py_qp_dense_factor_solve, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_linear_step", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_linear_step, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_multipliers", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_multipliers, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_descent", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_descent, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_slope", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_slope, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_line_search", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_line_search, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_steps_backward_euler", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_steps_backward_euler, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_solve_within", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_solve_within, METH_FASTCALL, NULL},
    {"control_fallback_solve_warm", (PyCFunction)(void (*)(void))py_control_fallback_solve_warm, METH_FASTCALL, NULL},
    {"control_fallback_largest_factor", (PyCFunction)(void (*)(void))py_control_fallback_largest_factor, METH_FASTCALL, NULL},
    {"control_fallback_note_limiting", (PyCFunction)(void (*)(void))py_control_fallback_note_limiting, METH_FASTCALL, NULL},
    {"control_yielding_is_path", (PyCFunction)(void (*)(void))py_control_yielding_is_path, METH_FASTCALL, NULL},
    {"control_yielding_races", (PyCFunction)(void (*)(void))py_control_yielding_races, METH_FASTCALL, NULL},
    {"control_fallback_scale_task", (PyCFunction)(void (*)(void))py_control_fallback_scale_task, METH_FASTCALL, NULL},
    {"control_fallback_relax_task", (PyCFunction)(void (*)(void))py_control_fallback_relax_task, METH_FASTCALL, NULL},
    {"control_fallback_rate_within", (PyCFunction)(void (*)(void))py_control_fallback_rate_within, METH_FASTCALL, NULL},
    {"control_fallback_move_within", (PyCFunction)(void (*)(void))py_control_fallback_move_within, METH_FASTCALL, NULL},
    {"control_fallback_nearest_within", (PyCFunction)(void (*)(void))py_control_fallback_nearest_within, METH_FASTCALL, NULL},
    {"control_stopping_stretched", (PyCFunction)(void (*)(void))py_control_stopping_stretched, METH_FASTCALL, NULL},
    {"control_yielding_is_near", (PyCFunction)(void (*)(void))py_control_yielding_is_near, METH_FASTCALL, NULL},
    {"control_fallback_attained", (PyCFunction)(void (*)(void))py_control_fallback_attained, METH_FASTCALL, NULL},
    {"control_cycle_take_step", (PyCFunction)(void (*)(void))py_control_cycle_take_step, METH_FASTCALL, NULL},
    {"control_requests_falls_short", (PyCFunction)(void (*)(void))py_control_requests_falls_short, METH_FASTCALL, NULL},
    {"control_arms_finish_step", (PyCFunction)(void (*)(void))py_control_arms_finish_step, METH_FASTCALL, NULL},
    {"control_arms_step_arm", (PyCFunction)(void (*)(void))py_control_arms_step_arm, METH_FASTCALL, NULL},
    {"schemes_scene_write_distances", (PyCFunction)(void (*)(void))py_schemes_scene_write_distances, METH_FASTCALL, NULL},
    {"control_arms_margin_of", (PyCFunction)(void (*)(void))py_control_arms_margin_of, METH_FASTCALL, NULL},
    {"control_arms_stopping_time_of", (PyCFunction)(void (*)(void))py_control_arms_stopping_time_of, METH_FASTCALL, NULL},
    {"control_arms_step_arms", (PyCFunction)(void (*)(void))py_control_arms_step_arms, METH_FASTCALL, NULL},
    {"control_requests_add_request", (PyCFunction)(void (*)(void))py_control_requests_add_request, METH_FASTCALL, NULL},
    {"networks_base_enter_rates", (PyCFunction)(void (*)(void))py_networks_base_enter_rates, METH_FASTCALL, NULL},
    {"qp_dense_rotate", (PyCFunction)(void (*)(void))py_qp_dense_rotate, METH_FASTCALL, NULL},
    {"qp_dense_extreme_eigenvalues", (PyCFunction)(void (*)(void))py_qp_dense_extreme_eigenvalues, METH_FASTCALL, NULL},
    {"networks_projection_stable_step", (PyCFunction)(void (*)(void))py_networks_projection_stable_step, METH_FASTCALL, NULL},
    {"networks_integrators_explicit_advance_explicitly", (PyCFunction)(void (*)(void))py_networks_integrators_explicit_advance_explicitly, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_step_program", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_step_program, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_solve", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_solve, METH_FASTCALL, NULL},
    {"networks_integrators_implicit_solve_program", (PyCFunction)(void (*)(void))py_networks_integrators_implicit_solve_program, METH_FASTCALL, NULL},
    {"networks_integrators_scaling_is_ordinary_size", (PyCFunction)(void (*)(void))py_networks_integrators_scaling_is_ordinary_size, METH_FASTCALL, NULL},
    {"networks_integrators_scaling_is_ordinary", (PyCFunction)(void (*)(void))py_networks_integrators_scaling_is_ordinary, METH_FASTCALL, NULL},
    {"networks_integrators_scaling_power_of_two", (PyCFunction)(void (*)(void))py_networks_integrators_scaling_power_of_two, METH_FASTCALL, NULL},
    {"networks_integrators_scaling_balance", (PyCFunction)(void (*)(void))py_networks_integrators_scaling_balance, METH_FASTCALL, NULL},
    {"networks_projection_projection_rates", (PyCFunction)(void (*)(void))py_networks_projection_projection_rates, METH_FASTCALL, NULL},
    {"qp_certificates_dot_twice", (PyCFunction)(void (*)(void))py_qp_certificates_dot_twice, METH_FASTCALL, NULL},
    {"qp_dense_is_symmetric", (PyCFunction)(void (*)(void))py_qp_dense_is_symmetric, METH_FASTCALL, NULL},
    {"qp_dense_symmetrize", (PyCFunction)(void (*)(void))py_qp_dense_symmetrize, METH_FASTCALL, NULL},
    {"qp_dense_is_convex", (PyCFunction)(void (*)(void))py_qp_dense_is_convex, METH_FASTCALL, NULL},
    {"qp_program_pack", (PyCFunction)(void (*)(void))py_qp_program_pack, METH_FASTCALL, NULL},
    {"qp_program_has_numbers", (PyCFunction)(void (*)(void))py_qp_program_has_numbers, METH_FASTCALL, NULL},
    {"qp_residuals_residuals_of", (PyCFunction)(void (*)(void))py_qp_residuals_residuals_of, METH_FASTCALL, NULL},
    {"qp_residuals_is_accepted", (PyCFunction)(void (*)(void))py_qp_residuals_is_accepted, METH_FASTCALL, NULL},
    {"references_base_soft_clock", (PyCFunction)(void (*)(void))py_references_base_soft_clock, METH_FASTCALL, NULL},
    {"references_moving_target_paced", (PyCFunction)(void (*)(void))py_references_moving_target_paced, METH_FASTCALL, NULL},
    {"references_rotations_rotated", (PyCFunction)(void (*)(void))py_references_rotations_rotated, METH_FASTCALL, NULL},
    {"references_rotations_column_of", (PyCFunction)(void (*)(void))py_references_rotations_column_of, METH_FASTCALL, NULL},
    {"references_rotations_turn_target", (PyCFunction)(void (*)(void))py_references_rotations_turn_target, METH_FASTCALL, NULL},
    {"references_rotations_turn_about", (PyCFunction)(void (*)(void))py_references_rotations_turn_about, METH_FASTCALL, NULL},
    {"references_moving_target_approach", (PyCFunction)(void (*)(void))py_references_moving_target_approach, METH_FASTCALL, NULL},
    {"references_shapes_heart_path", (PyCFunction)(void (*)(void))py_references_shapes_heart_path, METH_FASTCALL, NULL},
    {"references_shapes_lissajous_path", (PyCFunction)(void (*)(void))py_references_shapes_lissajous_path, METH_FASTCALL, NULL},
    {"references_shapes_fixed_path", (PyCFunction)(void (*)(void))py_references_shapes_fixed_path, METH_FASTCALL, NULL},
    {"references_turning_cone_path", (PyCFunction)(void (*)(void))py_references_turning_cone_path, METH_FASTCALL, NULL},
    {"references_waypoints_piece", (PyCFunction)(void (*)(void))py_references_waypoints_piece, METH_FASTCALL, NULL},
    {"references_waypoints_waypoints_path", (PyCFunction)(void (*)(void))py_references_waypoints_waypoints_path, METH_FASTCALL, NULL},
    {"references_turning_tilting_path", (PyCFunction)(void (*)(void))py_references_turning_tilting_path, METH_FASTCALL, NULL},
    {"schemes_collisions_kept_distance", (PyCFunction)(void (*)(void))py_schemes_collisions_kept_distance, METH_FASTCALL, NULL},
    {"schemes_collisions_write_ends", (PyCFunction)(void (*)(void))py_schemes_collisions_write_ends, METH_FASTCALL, NULL},
    {"schemes_collisions_rank", (PyCFunction)(void (*)(void))py_schemes_collisions_rank, METH_FASTCALL, NULL},
    {"schemes_collisions_collision_rows", (PyCFunction)(void (*)(void))py_schemes_collisions_collision_rows, METH_FASTCALL, NULL},
    {"schemes_costs_add_kinetic_energy", (PyCFunction)(void (*)(void))py_schemes_costs_add_kinetic_energy, METH_FASTCALL, NULL},
    {"schemes_costs_add_cyclic_motion", (PyCFunction)(void (*)(void))py_schemes_costs_add_cyclic_motion, METH_FASTCALL, NULL},
    {"schemes_joint_limits_position_dependent_speed", (PyCFunction)(void (*)(void))py_schemes_joint_limits_position_dependent_speed, METH_FASTCALL, NULL},
    {"schemes_joint_limits_speed_kind", (PyCFunction)(void (*)(void))py_schemes_joint_limits_speed_kind, METH_FASTCALL, NULL},
    {"schemes_joint_limits_joint_limits", (PyCFunction)(void (*)(void))py_schemes_joint_limits_joint_limits, METH_FASTCALL, NULL},
    {"schemes_parts_copy_cost", (PyCFunction)(void (*)(void))py_schemes_parts_copy_cost, METH_FASTCALL, NULL},
    {"schemes_parts_copy_rows", (PyCFunction)(void (*)(void))py_schemes_parts_copy_rows, METH_FASTCALL, NULL},
    {"schemes_parts_copy_task", (PyCFunction)(void (*)(void))py_schemes_parts_copy_task, METH_FASTCALL, NULL},
    {"schemes_parts_copy_limit", (PyCFunction)(void (*)(void))py_schemes_parts_copy_limit, METH_FASTCALL, NULL},
    {"schemes_rate_limits_motion_limits", (PyCFunction)(void (*)(void))py_schemes_rate_limits_motion_limits, METH_FASTCALL, NULL},
    {"schemes_scene_raise_end_rates", (PyCFunction)(void (*)(void))py_schemes_scene_raise_end_rates, METH_FASTCALL, NULL},
    {"schemes_step_write_velocity", (PyCFunction)(void (*)(void))py_schemes_step_write_velocity, METH_FASTCALL, NULL},
    {"schemes_step_write_spin", (PyCFunction)(void (*)(void))py_schemes_step_write_spin, METH_FASTCALL, NULL},
    {"schemes_tasks_position_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_position_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_rotation_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_rotation_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_project_on_range", (PyCFunction)(void (*)(void))py_schemes_tasks_project_on_range, METH_FASTCALL, NULL},
    {"schemes_tasks_block_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_block_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_pose_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_pose_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_held_pose_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_held_pose_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_axis_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_axis_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_remote_center_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_remote_center_rows, METH_FASTCALL, NULL},
    {"schemes_tasks_joint_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_joint_rows, METH_FASTCALL, NULL},
    {"schemes_tip_speed_tip_speed_bounds", (PyCFunction)(void (*)(void))py_schemes_tip_speed_tip_speed_bounds, METH_FASTCALL, NULL},
    {NULL, NULL, 0, NULL}
};
static const struct kernel kernels[] = {
    {"compiling_trigonometry_sin_cos", (void *)compiling_trigonometry_sin_cos, "d:(dd)"},
    {"compiling_trigonometry_sin", (void *)compiling_trigonometry_sin, "d:d"},
    {"control_arms_arm_state", (void *)control_arms_arm_state, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v:{control_arms_ArmState}"},
    {"control_arms_motion_of", (void *)control_arms_motion_of, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>{control_arms_ArmState}:{control_state_MotionState}"},
    {"qp_layout_copied", (void *)qp_layout_copied, "vv:n"},
    {"control_arms_rest_arm", (void *)control_arms_rest_arm, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>vv:n"},
    {"control_arms_place_arm", (void *)control_arms_place_arm, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>vm:n"},
    {"control_arms_halt_arm", (void *)control_arms_halt_arm, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v:n"},
    {"control_state_count_as_sent", (void *)control_state_count_as_sent, "{control_state_MotionState}vd:n"},
    {"control_arms_sent_command", (void *)control_arms_sent_command, "{control_arms_ArmState}i:{control_arms_SentCommand}"},
    {"control_arms_note_sent", (void *)control_arms_note_sent, "{control_arms_ArmState}dv:n"},
    {"control_arms_advance", (void *)control_arms_advance, "{control_arms_ArmState}{control_arms_ArmSettings}{control_state_MotionState}:n"},
    {"control_arms_send_arm", (void *)control_arms_send_arm, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>vvd:n"},
    {"schemes_periods_constant_periods", (void *)schemes_periods_constant_periods, "d:<dddddbb>"},
    {"schemes_periods_periods_of", (void *)schemes_periods_periods_of, "dddd:<dddddbb>"},
    {"control_arms_correct_last_period", (void *)control_arms_correct_last_period, "{control_arms_ArmState}{control_state_MotionState}d:n"},
    {"control_arms_add_pending", (void *)control_arms_add_pending, "{control_arms_ArmState}dv:n"},
    {"control_arms_update_positions", (void *)control_arms_update_positions, "{control_arms_ArmState}{control_arms_ArmSettings}<vivdd>:n"},
    {"qp_dense_all_finite", (void *)qp_dense_all_finite, "vii:b"},
    {"control_arms_differing", (void *)control_arms_differing, "vv:i"},
    {"control_arms_update_request", (void *)control_arms_update_request, "{control_arms_ArmState}{control_arms_ArmSettings}<vivdd>:n"},
    {"control_arms_begin_step", (void *)control_arms_begin_step, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v<vivdd>:b"},
    {"robot_kinematics_kernel_turn_into", (void *)robot_kinematics_kernel_turn_into, "mvv:n"},
    {"robot_kinematics_kernel_compose", (void *)robot_kinematics_kernel_compose, "{robot_kinematics_Placement}{robot_kinematics_Placement}{robot_kinematics_Placement}:n"},
    {"robot_kinematics_kernel_move", (void *)robot_kinematics_kernel_move, "{robot_kinematics_Placement}dd{robot_kinematics_Placement}:n"},
    {"robot_kinematics_kernel_write_twist", (void *)robot_kinematics_kernel_write_twist, "{robot_kinematics_Placement}id{robot_kinematics_Twist}:n"},
    {"robot_kinematics_kernel_write_inertia", (void *)robot_kinematics_kernel_write_inertia, "<VmvVVmmmv>mmm:n"},
    {"robot_kinematics_kernel_write_kinematics", (void *)robot_kinematics_kernel_write_kinematics, "<VmvVVmmmv>vmmm:n"},
    {"schemes_scene_scene_views", (void *)schemes_scene_scene_views, "vi:<{schemes_scene_SceneHead}vmm>"},
    {"control_arms_place_obstacles", (void *)control_arms_place_obstacles, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>{control_arms_ArmState}dv:n"},
    {"schemes_program_block_constants", (void *)schemes_program_block_constants, "<<iiiiii>Mvmmmmi>i:v"},
    {"control_state_change_spacing", (void *)control_state_change_spacing, "{control_state_MotionState}d:n"},
    {"qp_layout_data_size", (void *)qp_layout_data_size, "iii:i"},
    {"control_command_log_sizes", (void *)control_command_log_sizes, "<iiiiii>:(iiiiii)"},
    {"control_command_log_of", (void *)control_command_log_of, "v<iiiiii>:{control_command_StepLog}"},
    {"qp_layout_larger", (void *)qp_layout_larger, "dd:d"},
    {"qp_dense_largest_entry", (void *)qp_dense_largest_entry, "v:d"},
    {"schemes_rate_limits_joint_rates", (void *)schemes_rate_limits_joint_rates, "{schemes_rate_limits_MotionConstants}i:<dddddd>"},
    {"schemes_profiles_usable_jerk", (void *)schemes_profiles_usable_jerk, "<dddddd>d:d"},
    {"schemes_profiles_approach", (void *)schemes_profiles_approach, "db:d"},
    {"schemes_profiles_stopping_distance", (void *)schemes_profiles_stopping_distance, "dddd:d"},
    {"schemes_profiles_highest", (void *)schemes_profiles_highest, "dd<dddddbb>(ddd):d"},
    {"schemes_viability_ceiling", (void *)schemes_viability_ceiling, "dddd<dddddbb>(ddd):d"},
    {"schemes_viability_ceiling_below_velocity_limit", (void *)schemes_viability_ceiling_below_velocity_limit, "dddd<dddddd><dddddbb>:d"},
    {"schemes_profiles_easing", (void *)schemes_profiles_easing, "dd:d"},
    {"schemes_viability_rate_kind", (void *)schemes_viability_rate_kind, "dddd:d"},
    {"schemes_viability_position_kind", (void *)schemes_viability_position_kind, "<dddddd>:d"},
    {"schemes_viability_jerk_bounds", (void *)schemes_viability_jerk_bounds, "dddd<dddddd><dddddbb>:(dddd)"},
    {"schemes_viability_speed_within", (void *)schemes_viability_speed_within, "d<dddddd>d:d"},
    {"schemes_viability_acceleration_bounds", (void *)schemes_viability_acceleration_bounds, "ddd<dddddd><dddddbb>:(dddd)"},
    {"schemes_viability_joint_bounds", (void *)schemes_viability_joint_bounds, "dddd<dddddd><dddddbb>:(dddd)"},
    {"schemes_profiles_arriving", (void *)schemes_profiles_arriving, "dddd<dddddd><dddddbb>:d"},
    {"schemes_profiles_braking", (void *)schemes_profiles_braking, "dddd<dddddbb>:d"},
    {"control_arms_approach_request", (void *)control_arms_approach_request, "{control_arms_ArmState}{control_state_MotionState}{schemes_rate_limits_MotionConstants}<dddddbb>v:n"},
    {"references_base_enter_path", NULL, "idv{references_targets_TargetData}:n"},
    {"references_rotations_dot", (void *)references_rotations_dot, "(ddd)(ddd):d"},
    {"references_rotations_triple", (void *)references_rotations_triple, "v:(ddd)"},
    {"references_rotations_rotation_log", (void *)references_rotations_rotation_log, "mv:n"},
    {"references_rotations_set_mean_twist", (void *)references_rotations_set_mean_twist, "{references_targets_TargetData}{references_targets_TargetData}d:n"},
    {"control_cycle_sample_targets", (void *)control_cycle_sample_targets, "<Mv>ddm:n"},
    {"control_cycle_is_valid", (void *)control_cycle_is_valid, "dvvi:b"},
    {"schemes_rate_limits_state_periods", (void *)schemes_rate_limits_state_periods, "{schemes_rate_limits_MotionConstants}<dddddbb>:n"},
    {"qp_layout_offsets", (void *)qp_layout_offsets, "iii:(iiii)"},
    {"qp_layout_qp_views", (void *)qp_layout_qp_views, "viii:<mvmvmvvv>"},
    {"schemes_program_program_views", (void *)schemes_program_program_views, "v<iiiiii>:<mvmvmvvv>"},
    {"schemes_parts_enter_cost", NULL, "i<ddvvvmmmmmvvv>vmv:n"},
    {"schemes_parts_enter_task", NULL, "i<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_program_add_soft", (void *)schemes_program_add_soft, "mvmvd:n"},
    {"schemes_parts_enter_limit", NULL, "i<ddvvvmmmmmvvv>vmvvv:n"},
    {"schemes_program_keep_kinds", (void *)schemes_program_keep_kinds, "vvvv:n"},
    {"schemes_program_assemble", (void *)schemes_program_assemble, "v<<iiiiii>Mvmmmmi><ddvvvmmmmmvvv>:n"},
    {"control_cycle_note_instant", (void *)control_cycle_note_instant, "{control_command_StepLog}<<iiiiii>Mvmmmmi>{control_state_MotionState}{control_state_MotionState}:n"},
    {"networks_integrators_base_enter_answer", NULL, "i<mvmvmvvv>i{networks_integrators_base_AnswerSettings}vv:(ddddd)"},
    {"qp_residuals_within", (void *)qp_residuals_within, "dddd:b"},
    {"qp_residuals_product_terms", (void *)qp_residuals_product_terms, "mivb:(ddd)"},
    {"qp_residuals_weight_of", (void *)qp_residuals_weight_of, "d:d"},
    {"qp_residuals_cost_size", (void *)qp_residuals_cost_size, "<mvmvmvvv>:d"},
    {"qp_residuals_cost_is_small_enough", (void *)qp_residuals_cost_is_small_enough, "<mvmvmvvv>vdddd:b"},
    {"qp_residuals_is_small_enough", (void *)qp_residuals_is_small_enough, "<mvmvmvvv>vdd:b"},
    {"control_cycle_status_of", (void *)control_cycle_status_of, "<mvmvmvvv>v{networks_integrators_base_SolveStats}{networks_integrators_base_AnswerSettings}v:i"},
    {"control_cycle_answer", (void *)control_cycle_answer, "{control_command_StepLog}<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}>v:b"},
    {"control_command_note_command", (void *)control_command_note_command, "{control_command_StepLog}{control_state_MotionState}vd:n"},
    {"control_stopping_cubic_coefficient", (void *)control_stopping_cubic_coefficient, "dddb:d"},
    {"control_stopping_velocity_at", (void *)control_stopping_velocity_at, "dddb:d"},
    {"control_stopping_next_velocity", (void *)control_stopping_next_velocity, "dddb:d"},
    {"control_stopping_within_rates", (void *)control_stopping_within_rates, "dddddb:b"},
    {"control_stopping_least_periods", (void *)control_stopping_least_periods, "vv{schemes_rate_limits_MotionConstants}dbb:d"},
    {"control_stopping_write_cubic_coefficients", (void *)control_stopping_write_cubic_coefficients, "vvdbv:n"},
    {"control_stopping_displacement_after", (void *)control_stopping_displacement_after, "<vvdbbb>dddd:d"},
    {"control_stopping_least_displacement", (void *)control_stopping_least_displacement, "<vvdbbb>ddd:d"},
    {"control_stopping_end_displacement", (void *)control_stopping_end_displacement, "<vvdbbb>ddd:d"},
    {"control_stopping_keeps_varying_limit", (void *)control_stopping_keeps_varying_limit, "<vvdbbb>v{schemes_rate_limits_MotionConstants}di:b"},
    {"control_stopping_keeps_joint_limits", (void *)control_stopping_keeps_joint_limits, "<vvdbbb>v{schemes_rate_limits_MotionConstants}d:b"},
    {"schemes_scene_place_bodies", (void *)schemes_scene_place_bodies, "<{schemes_scene_SceneHead}vmm>mm:n"},
    {"references_rotations_combined", (void *)references_rotations_combined, "d(ddd)d(ddd):(ddd)"},
    {"schemes_scene_ends_of", (void *)schemes_scene_ends_of, "<{schemes_scene_SceneHead}vmm>mi:((ddd)(ddd))"},
    {"schemes_step_seen_from", (void *)schemes_step_seen_from, "{robot_kinematics_Placement}(ddd):(ddd)"},
    {"schemes_scene_beyond", (void *)schemes_scene_beyond, "(ddd)(ddd):(ddd)"},
    {"schemes_scene_nearest_parameter", (void *)schemes_scene_nearest_parameter, "(ddd)(ddd)(ddd):d"},
    {"schemes_scene_depth", (void *)schemes_scene_depth, "(ddd)(ddd):(dddd)"},
    {"references_rotations_scaled", (void *)references_rotations_scaled, "d(ddd):(ddd)"},
    {"schemes_step_axis_at", (void *)schemes_step_axis_at, "{robot_kinematics_Placement}(ddd):(ddd)"},
    {"schemes_scene_contact_of", (void *)schemes_scene_contact_of, "<{schemes_scene_SceneHead}vmm>im:<(ddd)(ddd)d>"},
    {"schemes_scene_second_order", (void *)schemes_scene_second_order, "{schemes_scene_Pair}v:d"},
    {"references_rotations_cross", (void *)references_rotations_cross, "(ddd)(ddd):(ddd)"},
    {"schemes_step_point_rate", (void *)schemes_step_point_rate, "mi(ddd):(ddd)"},
    {"schemes_step_rate_along", (void *)schemes_step_rate_along, "mi(ddd)(ddd):d"},
    {"control_stopping_along", (void *)control_stopping_along, "<vvdbbb>m{schemes_scene_Pair}(ddd)(ddd):(dd)"},
    {"schemes_scene_height_of", (void *)schemes_scene_height_of, "(ddd)<(ddd)(ddd)d>:d"},
    {"control_stopping_keeps_distances", (void *)control_stopping_keeps_distances, "<vvdbbb><<iiiiii>Mvmmmmi>vvd:b"},
    {"control_stopping_stopping_time", (void *)control_stopping_stopping_time, "<<iiiiii>Mvmmmmi>{control_state_MotionState}v<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>v:d"},
    {"control_yielding_guard_step", (void *)control_yielding_guard_step, "<<iiiiii>Mvmmmmi>{control_state_MotionState}{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>:b"},
    {"qp_dense_long_dot", (void *)qp_dense_long_dot, "dvv:d"},
    {"qp_dense_dot", (void *)qp_dense_dot, "dvv:d"},
    {"qp_dense_row_dot", (void *)qp_dense_row_dot, "miv:d"},
    {"control_command_is_active", (void *)control_command_is_active, "ddd:b"},
    {"control_command_note_active", (void *)control_command_note_active, "{control_command_StepLog}<mvmvmvvv>d:n"},
    {"control_yielding_widen_bounds", (void *)control_yielding_widen_bounds, "{control_command_StepLog}<mvmvmvvv>{schemes_rate_limits_MotionConstants}:n"},
    {"control_fallback_copy_cost", (void *)control_fallback_copy_cost, "<mvmvmvvv><mvmvmvvv>:n"},
    {"control_fallback_copy_limits", (void *)control_fallback_copy_limits, "<mvmvmvvv><mvmvmvvv>:n"},
    {"control_fallback_longest_asked", (void *)control_fallback_longest_asked, "<mvmvmvvv>vb:d"},
    {"networks_projection_write_spans", (void *)networks_projection_write_spans, "<mvmvmvvv>v:n"},
    {"networks_integrators_implicit_longest_step", (void *)networks_integrators_implicit_longest_step, "<mvmvmvvv>:d"},
    {"qp_dense_times", (void *)qp_dense_times, "mvv:n"},
    {"qp_dense_add_multiple", (void *)qp_dense_add_multiple, "vdv:n"},
    {"qp_dense_add_row", (void *)qp_dense_add_row, "vdmi:n"},
    {"networks_projection_add_transposed", (void *)networks_projection_add_transposed, "<mvmvmvvv>vdvv:n"},
    {"networks_projection_rows_times", (void *)networks_projection_rows_times, "<mvmvmvvv>vvv:n"},
    {"networks_projection_write_slacks", (void *)networks_projection_write_slacks, "<mvmvmvvv>vvv:n"},
    {"networks_projection_unprojected_rates", (void *)networks_projection_unprojected_rates, "<mvmvmvvv>vvv:d"},
    {"qp_residuals_point_residuals", (void *)qp_residuals_point_residuals, "<mvmvmvvv>v:(ddd)"},
    {"qp_residuals_kkt_point", (void *)qp_residuals_kkt_point, "<mvmvmvvv>vv:(ddd)"},
    {"networks_projection_mark_active", (void *)networks_projection_mark_active, "<mvmvmvvv>vvv:i"},
    {"qp_dense_add_outer", (void *)qp_dense_add_outer, "mdvi:n"},
    {"networks_integrators_implicit_steps_count_row", (void *)networks_integrators_implicit_steps_count_row, "<vvmmvv>ivi:n"},
    {"qp_dense_weighted_sum", (void *)qp_dense_weighted_sum, "vdvv:n"},
    {"networks_integrators_implicit_steps_build_condensed", (void *)networks_integrators_implicit_steps_build_condensed, "<mvmvmvvv>d<vvmmvv>:n"},
    {"qp_dense_cholesky_factor", (void *)qp_dense_cholesky_factor, "m:b"},
    {"qp_dense_factor_solve", (void *)qp_dense_factor_solve, "mvv:n"},
    {"networks_integrators_implicit_steps_linear_step", (void *)networks_integrators_implicit_steps_linear_step, "<mvmvmvvv>vvd<vvmmvv>bv:b"},
    {"networks_integrators_implicit_steps_multipliers", (void *)networks_integrators_implicit_steps_multipliers, "<mvmvmvvv>vdvvv:i"},
    {"networks_integrators_implicit_steps_descent", (void *)networks_integrators_implicit_steps_descent, "<mvmvmvvv>vvvv:d"},
    {"networks_integrators_implicit_steps_slope", (void *)networks_integrators_implicit_steps_slope, "vdivvd:(dd)"},
    {"networks_integrators_implicit_steps_line_search", (void *)networks_integrators_implicit_steps_line_search, "vdivvddd:d"},
    {"networks_integrators_implicit_steps_backward_euler", (void *)networks_integrators_implicit_steps_backward_euler, "<mvmvmvvv>vdvdi<vvmmvv>:i"},
    {"networks_integrators_implicit_solve_within", (void *)networks_integrators_implicit_solve_within, "<mvmvmvvv>divv:(ddddd)"},
    {"control_fallback_solve_warm", (void *)control_fallback_solve_warm, "<mvmvmvvv>dvv{networks_integrators_base_SolveStats}:b"},
    {"control_fallback_largest_factor", (void *)control_fallback_largest_factor, "<mvmvmvvv><v{schemes_rate_limits_MotionConstants}diVbbb>vv{networks_integrators_base_SolveStats}b:d"},
    {"control_fallback_note_limiting", (void *)control_fallback_note_limiting, "viiiv:n"},
    {"control_yielding_is_path", (void *)control_yielding_is_path, "m:b"},
    {"control_yielding_races", (void *)control_yielding_races, "<mvmvmvvv>v:b"},
    {"control_fallback_scale_task", (void *)control_fallback_scale_task, "<mvmvmvvv>vd:n"},
    {"control_fallback_relax_task", (void *)control_fallback_relax_task, "<mvmvmvvv>vd:n"},
    {"control_yielding_answer_fallback", (void *)control_yielding_answer_fallback, "{control_command_StepLog}<mvmvmvvv><v{schemes_rate_limits_MotionConstants}diVbbb>vi:(dd)"},
    {"control_yielding_approach_together", (void *)control_yielding_approach_together, "{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>v:n"},
    {"control_yielding_approach_each", (void *)control_yielding_approach_each, "<mvmvmvvv>{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>v:n"},
    {"control_fallback_rate_within", (void *)control_fallback_rate_within, "<mvmvmvvv>iv:d"},
    {"control_fallback_move_within", (void *)control_fallback_move_within, "<mvmvmvvv>v<v{schemes_rate_limits_MotionConstants}diVbbb>{networks_integrators_base_SolveStats}i:b"},
    {"control_fallback_nearest_within", (void *)control_fallback_nearest_within, "<mvmvmvvv>v<v{schemes_rate_limits_MotionConstants}diVbbb>{networks_integrators_base_SolveStats}:b"},
    {"control_yielding_approach_answer", (void *)control_yielding_approach_answer, "<mvmvmvvv>{control_state_MotionState}{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>{networks_integrators_base_SolveStats}v:n"},
    {"control_stopping_stretched", (void *)control_stopping_stretched, "vv{schemes_rate_limits_MotionConstants}dd:d"},
    {"control_yielding_slow_down", (void *)control_yielding_slow_down, "{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>dv:n"},
    {"control_yielding_brake", (void *)control_yielding_brake, "<mvmvmvvv><<iiiiii>Mvmmmmi>{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>{control_command_StepLog}v:d"},
    {"control_yielding_is_near", (void *)control_yielding_is_near, "<<iiiiii>Mvmmmmi><v{schemes_rate_limits_MotionConstants}diVbbb>v:b"},
    {"control_yielding_keep_verified_distances", (void *)control_yielding_keep_verified_distances, "{control_state_MotionState}{control_state_MotionState}:n"},
    {"control_yielding_make_stoppable", (void *)control_yielding_make_stoppable, "<mvmvmvvv><<iiiiii>Mvmmmmi>{control_state_MotionState}{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>{control_command_StepLog}v:d"},
    {"control_yielding_note_missing", (void *)control_yielding_note_missing, "{control_command_StepLog}v:i"},
    {"control_yielding_note_kinds", (void *)control_yielding_note_kinds, "{control_command_StepLog}vv:n"},
    {"control_fallback_attained", (void *)control_fallback_attained, "vmvv:d"},
    {"control_yielding_note_decision", (void *)control_yielding_note_decision, "{control_command_StepLog}<mvmvmvvv><v{schemes_rate_limits_MotionConstants}diVbbb>vidi:i"},
    {"control_yielding_yield_step", (void *)control_yielding_yield_step, "{control_command_StepLog}<<iiiiii>Mvmmmmi>{control_state_MotionState}{control_state_MotionState}<v{schemes_rate_limits_MotionConstants}diVbbb><dddddbb>vi:i"},
    {"control_cycle_take_step", (void *)control_cycle_take_step, "v<<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>vvvvd:i"},
    {"control_requests_falls_short", (void *)control_requests_falls_short, "<mvmvmvvv>v:b"},
    {"control_arms_first_reason", (void *)control_arms_first_reason, "{control_arms_ArmState}:i"},
    {"control_arms_note_limits", (void *)control_arms_note_limits, "{control_arms_ArmState}{control_command_StepLog}:n"},
    {"control_arms_answer", (void *)control_arms_answer, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>{control_arms_ArmState}<vivdd>mmv:i"},
    {"control_arms_finish_step", (void *)control_arms_finish_step, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v<vivdd>mmv:i"},
    {"control_arms_step_arm", (void *)control_arms_step_arm, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v<vivdd>:i"},
    {"schemes_scene_write_distances", (void *)schemes_scene_write_distances, "vimv:n"},
    {"control_arms_margin_of", (void *)control_arms_margin_of, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v:(dd)"},
    {"control_arms_stopping_time_of", (void *)control_arms_stopping_time_of, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>v:d"},
    {"control_arms_step_arms", (void *)control_arms_step_arms, "<<VmvVVmmmv><<<iiiiii>Mvmmmmi><ii{networks_integrators_base_AnswerSettings}><Mv><v{schemes_rate_limits_MotionConstants}diVbbb>vib<dddddbb>>iii{schemes_rate_limits_MotionConstants}dvvm{control_arms_ArmSettings}<iiiiiiii>>m<vivdd>Vii:n"},
    {"control_requests_add_request", (void *)control_requests_add_request, "<ddvvvmmmmmvvv>vmv:n"},
    {"networks_base_enter_rates", NULL, "i<mvmvmvvv>vvv:n"},
    {"qp_dense_rotate", (void *)qp_dense_rotate, "mii:n"},
    {"qp_dense_extreme_eigenvalues", (void *)qp_dense_extreme_eigenvalues, "m:(dd)"},
    {"networks_projection_stable_step", (void *)networks_projection_stable_step, "<mvmvmvvv>v:d"},
    {"networks_integrators_explicit_advance_explicitly", (void *)networks_integrators_explicit_advance_explicitly, "<mvmvmvvv>i{networks_integrators_base_AnswerSettings}vv:(ddddd)"},
    {"networks_integrators_implicit_step_program", (void *)networks_integrators_implicit_step_program, "viiivd:i"},
    {"networks_integrators_implicit_solve", (void *)networks_integrators_implicit_solve, "<mvmvmvvv>i{networks_integrators_base_AnswerSettings}vv:(ddddd)"},
    {"networks_integrators_implicit_solve_program", (void *)networks_integrators_implicit_solve_program, "v(iii)vvdi:(ddddd)"},
    {"networks_integrators_scaling_is_ordinary_size", (void *)networks_integrators_scaling_is_ordinary_size, "db:b"},
    {"networks_integrators_scaling_is_ordinary", (void *)networks_integrators_scaling_is_ordinary, "viii:b"},
    {"networks_integrators_scaling_power_of_two", (void *)networks_integrators_scaling_power_of_two, "d:d"},
    {"networks_integrators_scaling_balance", (void *)networks_integrators_scaling_balance, "mviv:n"},
    {"networks_projection_projection_rates", (void *)networks_projection_projection_rates, "<mvmvmvvv>vvv:n"},
    {"qp_certificates_dot_twice", (void *)qp_certificates_dot_twice, "mvvv:n"},
    {"qp_dense_is_symmetric", (void *)qp_dense_is_symmetric, "md:b"},
    {"qp_dense_symmetrize", (void *)qp_dense_symmetrize, "m:n"},
    {"qp_dense_is_convex", (void *)qp_dense_is_convex, "mm:b"},
    {"qp_program_pack", (void *)qp_program_pack, "<mvmvmvvv>v:b"},
    {"qp_program_has_numbers", (void *)qp_program_has_numbers, "viii:b"},
    {"qp_residuals_residuals_of", (void *)qp_residuals_residuals_of, "viiiv:(ddd)"},
    {"qp_residuals_is_accepted", (void *)qp_residuals_is_accepted, "viiivdd:b"},
    {"references_base_soft_clock", (void *)references_base_soft_clock, "dd:(dd)"},
    {"references_moving_target_paced", (void *)references_moving_target_paced, "vdd:d"},
    {"references_rotations_rotated", (void *)references_rotations_rotated, "d(ddd)(ddd):(ddd)"},
    {"references_rotations_column_of", (void *)references_rotations_column_of, "mi:(ddd)"},
    {"references_rotations_turn_target", (void *)references_rotations_turn_target, "{references_targets_TargetData}d(ddd)d(ddd):n"},
    {"references_rotations_turn_about", (void *)references_rotations_turn_about, "{references_targets_TargetData}(ddd)dd:n"},
    {"references_moving_target_approach", (void *)references_moving_target_approach, "{references_targets_TargetData}{references_targets_TargetData}ddd:n"},
    {"references_shapes_heart_path", (void *)references_shapes_heart_path, "dv{references_targets_TargetData}:n"},
    {"references_shapes_lissajous_path", (void *)references_shapes_lissajous_path, "dv{references_targets_TargetData}:n"},
    {"references_shapes_fixed_path", (void *)references_shapes_fixed_path, "dv{references_targets_TargetData}:n"},
    {"references_turning_cone_path", (void *)references_turning_cone_path, "dv{references_targets_TargetData}:n"},
    {"references_waypoints_piece", (void *)references_waypoints_piece, "md:i"},
    {"references_waypoints_waypoints_path", (void *)references_waypoints_waypoints_path, "dv{references_targets_TargetData}:n"},
    {"references_turning_tilting_path", (void *)references_turning_tilting_path, "dv{references_targets_TargetData}:n"},
    {"schemes_collisions_kept_distance", (void *)schemes_collisions_kept_distance, "<{schemes_scene_SceneHead}vmm><(ddd)(ddd)d>d:d"},
    {"schemes_collisions_write_ends", (void *)schemes_collisions_write_ends, "<ddvvvmmmmmvvv><{schemes_scene_SceneHead}vmm>mimvv:n"},
    {"schemes_collisions_rank", (void *)schemes_collisions_rank, "vi:i"},
    {"schemes_collisions_collision_rows", (void *)schemes_collisions_collision_rows, "<ddvvvmmmmmvvv>vmvvv:n"},
    {"schemes_costs_add_kinetic_energy", (void *)schemes_costs_add_kinetic_energy, "<ddvvvmmmmmvvv>vmv:n"},
    {"schemes_costs_add_cyclic_motion", (void *)schemes_costs_add_cyclic_motion, "<ddvvvmmmmmvvv>vmv:n"},
    {"schemes_joint_limits_position_dependent_speed", (void *)schemes_joint_limits_position_dependent_speed, "ddd:d"},
    {"schemes_joint_limits_speed_kind", (void *)schemes_joint_limits_speed_kind, "ddd:i"},
    {"schemes_joint_limits_joint_limits", (void *)schemes_joint_limits_joint_limits, "<ddvvvmmmmmvvv>vmvvv:n"},
    {"schemes_parts_copy_cost", (void *)schemes_parts_copy_cost, "<ddvvvmmmmmvvv>vmv:n"},
    {"schemes_parts_copy_rows", (void *)schemes_parts_copy_rows, "vmv:n"},
    {"schemes_parts_copy_task", (void *)schemes_parts_copy_task, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_parts_copy_limit", (void *)schemes_parts_copy_limit, "<ddvvvmmmmmvvv>vmvvv:n"},
    {"schemes_rate_limits_motion_limits", (void *)schemes_rate_limits_motion_limits, "<ddvvvmmmmmvvv>vmvvv:n"},
    {"schemes_scene_raise_end_rates", (void *)schemes_scene_raise_end_rates, "vmmm:n"},
    {"schemes_step_write_velocity", (void *)schemes_step_write_velocity, "<ddvvvmmmmmvvv>{schemes_step_FrameConstants}(ddd)(ddd)v:n"},
    {"schemes_step_write_spin", (void *)schemes_step_write_spin, "<ddvvvmmmmmvvv>{schemes_step_FrameConstants}(ddd)v:n"},
    {"schemes_tasks_position_rows", (void *)schemes_tasks_position_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_rotation_rows", (void *)schemes_tasks_rotation_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_project_on_range", (void *)schemes_tasks_project_on_range, "mv:n"},
    {"schemes_tasks_block_rows", (void *)schemes_tasks_block_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_pose_rows", (void *)schemes_tasks_pose_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_held_pose_rows", (void *)schemes_tasks_held_pose_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_axis_rows", (void *)schemes_tasks_axis_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_remote_center_rows", (void *)schemes_tasks_remote_center_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tasks_joint_rows", (void *)schemes_tasks_joint_rows, "<ddvvvmmmmmvvv>v{references_targets_TargetData}mv:n"},
    {"schemes_tip_speed_tip_speed_bounds", (void *)schemes_tip_speed_tip_speed_bounds, "<ddvvvmmmmmvvv>vmvvv:n"},
    {NULL, NULL, NULL}
};
static int note(PyObject *module, const char *name, const struct kernel *kernel)
{
    PyObject *dict = PyObject_GetAttrString(module, name);
    PyObject *value = name[0] == 'c' ? PyUnicode_FromString(kernel->code)
                                     : PyLong_FromVoidPtr(kernel->address);
    const int done = dict && value ? PyDict_SetItemString(dict, kernel->name, value) : -1;
    Py_XDECREF(dict);
    Py_XDECREF(value);
    return done;
}

static struct PyModuleDef definition = {
    .m_base = PyModuleDef_HEAD_INIT,
    .m_name = "iiwa_dnn._kernels",
    .m_doc = "The package's kernels.",
    .m_size = -1,
    .m_methods = methods,
};

PyMODINIT_FUNC PyInit__kernels(void)
{
    import_array();
    PyObject *module = PyModule_Create(&definition);
    if (!module) return NULL;
    const struct kernel flag = {"failed", &failed, ""};
    if (PyModule_AddObject(module, "addresses", PyDict_New()) < 0
        || PyModule_AddObject(module, "codes", PyDict_New()) < 0
        || note(module, "addresses", &flag) < 0) return NULL;
    for (const struct kernel *kernel = kernels; kernel->name; kernel++) {
        if (note(module, "codes", kernel) < 0 || note(module, "addresses", kernel) < 0) return NULL;
    }
    return module;
}

