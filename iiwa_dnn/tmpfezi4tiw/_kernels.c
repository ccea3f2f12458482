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
typedef struct { double *data; int64_t size0, size1, size2; } Cube;
typedef struct { int64_t *data; int64_t size0; } IntVector;
typedef struct { int64_t *data; int64_t size0, size1; } IntMatrix;

/* min and max return the first of equal numbers, and the first beside a NaN, as Python's do.
 * Quotient and remainder are rounded down. */

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
 * from the heap. `used` counts both, in bytes. */
struct block { struct block *next; };
struct arena { char *top, *end; struct block *blocks; size_t used; };
static _Thread_local size_t arena_peak;

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
    arena->used += bytes;
    if (arena->used > arena_peak) arena_peak = arena->used;
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
    arena->used = mark->used;
}


typedef struct { int64_t at[9]; } int_9;
/* Parts of a row, for a program of sizes n, m, p, dof joints and k tracked frames. */
typedef struct {
    Vector program;
    Vector point;
    Vector figures;
    Vector placement;
    Matrix past;
    Vector dq;
    Vector decision;
    Matrix bounds;
    Vector blocking;
    Matrix targets;
} command_RowViews;
/* The eight parts of a program of n variables, m inequality and p equality rows, as views. */
typedef struct {
    Matrix P;
    Vector q;
    Matrix G;
    Vector h;
    Matrix A;
    Vector b;
    Vector lb;
    Vector ub;
} layout_QPViews;
/* Constants with which the relaxed programs of a scheme are written and answered. */
typedef struct {
    Vector weights;
    Vector limits;
    Vector settings;
    IntMatrix scenes;
    double dt;
    int64_t stop;
    bool cubic;
    bool coupled;
} relaxed_Yielding;
typedef struct { double at[5]; } double_5;
/* Condensed matrix of a program with R = p + m + 2n rows [A; G; I; -I], and scratch. */
typedef struct {
    Vector active;
    Vector counted;
    Matrix gram;
    Matrix K;
    Vector values;
} implicit_steps_Condensed;
typedef struct { double at[3]; } double_3;
typedef struct { double at[2]; } double_2;
typedef struct { int64_t at[4]; } int_4;
/* One instant of a control loop of n joints, as compiled parts read it. */
typedef struct {
    double t;
    double rate;
    Vector q;
    Vector last;
    Vector before;
    Matrix jacobian;
    Matrix placements;
    Matrix moves;
    Matrix inertia;
    Matrix targets;
} step_StepViews;
/* Commanded positions and the wish that counts, which a step overwrites. */
typedef struct {
    Vector positions;
    Vector wish;
    Vector flags;
} shield_ShieldState;
typedef struct { double at[4]; } double_4;
/* Arrays with which compiled code writes programs. */
typedef struct {
    IntMatrix table;
    Vector constants;
    Matrix jacobian;
    Matrix placements;
    Matrix moves;
    Matrix inertia;
    double rate;
} program_ProgramArrays;
/* Layout of a control step. */
typedef struct {
    program_ProgramArrays arrays;
    relaxed_Yielding yielding;
    int64_t policy;
    bool shares_state;
} step_StepPlan;
/* A motion to rest, or to a wanted velocity that is taken off. */
typedef struct {
    Vector first;
    Vector bend;
    double periods;
    bool cubic;
} stopping_Motion;
/* Constants of a scene of b bodies and k pairs, as views. */
typedef struct {
    double least;
    double gain;
    Vector dq_max;
    Matrix bodies;
    Matrix pairs;
    Matrix moves;
    Matrix radii;
} scene_SceneViews;
/* Nearest points of a pair's cores. */
typedef struct {
    double_3 second;
    double_3 first;
    double_3 normal;
    double distance;
} scene_Contact;
typedef struct { double_3 at[2]; } double_3_2;
typedef struct { int64_t at[3]; } int_3;
/* Tables of a robot of n joints, each of which turns about its z axis or slides along it. */
typedef struct {
    IntVector parents;
    Matrix joints;
    Matrix kinds;
    IntMatrix frames;
    Matrix offsets;
    Matrix bodies;
    Matrix supports;
    Vector armature;
} kinematics_kernel_ModelTables;
static const double yielding_TOWARDS[] = {1.0, 0.5, 0.25, 0.125};
static const int64_t kinematics_kernel_CYCLE[] = {0, 1, 2, 0, 1};
static inline int_9 control_command_row_ends(struct arena *arena, int64_t n, int64_t m, int64_t p, int64_t dof);
static inline command_RowViews control_command_row_views(struct arena *arena, Vector row, int64_t n, int64_t m, int64_t p, int64_t dof);
static void control_relaxed_copied(struct arena *arena, Vector out, Vector values);
static double control_relaxed_largest_entry(struct arena *arena, Vector values);
static bool control_relaxed_settled(struct arena *arena, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector point, Vector figures, double tolerances);
static double_5 integrators_implicit_settle(struct arena *arena, const layout_QPViews *qp, int64_t rates, Vector constants, Vector s, Vector point);
static double networks_projection_field(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates);
static void qp_dense_times(struct arena *arena, Matrix rows, Vector x, Vector out);
static double qp_dense_row_dot(struct arena *arena, Matrix rows, int64_t j, Vector x);
static void networks_projection_add_transposed(struct arena *arena, const layout_QPViews *qp, double factor, Vector s, Vector out);
static void qp_dense_add_row(struct arena *arena, Vector out, double factor, Matrix rows, int64_t j);
static void networks_projection_write_slacks(struct arena *arena, const layout_QPViews *qp, Vector x, Vector slacks);
static void networks_projection_rows_times(struct arena *arena, const layout_QPViews *qp, Vector x, Vector values);
static double qp_layout_larger(struct arena *arena, double largest, double value);
static double_3 qp_residuals_kkt_point(struct arena *arena, const layout_QPViews *qp, Vector s, Vector point);
static double_3 qp_residuals_point_residuals(struct arena *arena, const layout_QPViews *qp, Vector point);
static bool qp_residuals_within(struct arena *arena, double primal, double dual, double gap, double tol);
static void networks_projection_mark_active(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, Vector active);
static inline bool integrators_implicit_steps_linear_step(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, double step, const implicit_steps_Condensed *matrix, Vector new);
static void integrators_implicit_steps_build_condensed(struct arena *arena, const layout_QPViews *qp, double step, const implicit_steps_Condensed *matrix);
static void integrators_implicit_steps_count_rows(struct arena *arena, const implicit_steps_Condensed *matrix, Matrix rows, int64_t first);
static void qp_dense_add_outer(struct arena *arena, Matrix out, double factor, Matrix rows, int64_t j);
static bool qp_dense_cholesky_factor(struct arena *arena, Matrix K);
static void qp_dense_factor_solve(struct arena *arena, Matrix K, Vector rhs, Vector out);
static void integrators_implicit_steps_copy_into(struct arena *arena, Vector out, Vector values);
static int64_t integrators_implicit_steps_backward_euler(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, double tol, int64_t max_newton, const implicit_steps_Condensed *matrix);
static void integrators_implicit_steps_multipliers(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector new, Vector active);
static double integrators_implicit_steps_descent(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, Vector descent);
static double integrators_implicit_steps_line_search(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector change, Vector direction, Vector descent);
static double_2 integrators_implicit_steps_slope(struct arena *arena, int64_t n, int64_t p, Vector s, double step, Vector slacks, Vector change, double length);
static double control_relaxed_largest_factor(struct arena *arena, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector point, Vector figures, bool retreats);
static int64_t control_relaxed_data_size(struct arena *arena, int64_t n, int64_t m, int64_t p);
static inline layout_QPViews qp_layout_qp_views(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p);
static int_4 qp_layout_offsets(struct arena *arena, int64_t n, int64_t m, int64_t p);
static void control_relaxed_copy_cost(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other);
static void control_relaxed_copy_limits(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other);
static void control_relaxed_scale_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double factor);
static void control_relaxed_soften_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double retreat);
static void control_relaxed_move_into_cost(struct arena *arena, const layout_QPViews *qp, int64_t j, double square, double shrink);
static void control_relaxed_note_blocking(struct arena *arena, Vector point, int64_t n, int64_t m, int64_t extra, Vector blocking);
static bool control_relaxed_nearest_within(struct arena *arena, const layout_QPViews *qp, Vector x, const relaxed_Yielding *yielding, Vector figures);
static double control_relaxed_attained(struct arena *arena, Vector b, Matrix A, Vector weights, Vector x);
static void control_shield_wished_velocity(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void control_shield_take_positions(struct arena *arena, Vector q, const shield_ShieldState *state, Vector settings);
static bool control_shield_take_wish(struct arena *arena, Vector wish, bool given, const shield_ShieldState *state, Vector settings);
static bool qp_dense_all_finite(struct arena *arena, Vector data, int64_t start, int64_t end);
static void control_shield_approach(struct arena *arena, const shield_ShieldState *state, Matrix past, Vector limits, double dt, bool reaches, bool held, Vector dq);
static double_2 schemes_limits_joint_bounds(struct arena *arena, double last, double before, double above, double below, double_4 rates, double dt);
static double_2 schemes_limits_jerk_bounds(struct arena *arena, double last, double before, double above, double below, double_4 rates, double dt);
static double schemes_limits_approach(struct arena *arena, double room);
static double schemes_limits_ceiling(struct arena *arena, double lb, double ub, double distance, double last, double dt, double_2 braking_limits);
static double schemes_limits_highest(struct arena *arena, double v, double last, double dt, double J, double A);
static double schemes_limits_stopping_distance(struct arena *arena, double v, double a, double J, double A);
static double schemes_limits_easing(struct arena *arena, double room, double dt);
static double_2 schemes_limits_acceleration_bounds(struct arena *arena, double last, double above, double below, double_4 rates, double dt);
static double schemes_limits_braking(struct arena *arena, double last, double lb, double ub, double jerk, double dt);
static int64_t control_step_take_step(struct arena *arena, Vector row, const step_StepPlan *plan, Matrix past, Matrix following, Vector state, Vector relaxed, double t, bool samples);
static void control_step_sample_targets(struct arena *arena, const program_ProgramArrays *arrays, double t, Matrix targets);
static void references_base_enter_path(struct arena *arena, int64_t address, double t, Vector constants, Vector target);
static void references_rotations_set_mean_twist(struct arena *arena, Vector now, Vector then, double dt);
static double references_rotations_dot(struct arena *arena, double_3 u, double_3 v);
static double_3 references_rotations_row_of(struct arena *arena, Vector target, int64_t i);
static void references_rotations_rotation_log(struct arena *arena, Matrix R, Vector out);
static void schemes_program_assemble(struct arena *arena, Vector data, const program_ProgramArrays *arrays, Matrix past, Matrix targets, double t);
static void schemes_parts_enter_cost(struct arena *arena, int64_t address, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_parts_enter_task(struct arena *arena, int64_t address, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_program_add_soft(struct arena *arena, const layout_QPViews *qp, Matrix A, Vector b, double weight);
static void schemes_parts_enter_limit(struct arena *arena, int64_t address, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static void control_step_note_instant(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past);
static bool control_step_answer(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Vector state);
static double_5 integrators_base_enter_answer(struct arena *arena, int64_t address, const layout_QPViews *qp, int64_t rates, Vector constants, Vector state, Vector point);
static int64_t control_step_status_of(struct arena *arena, double primal, double dual, double gap, Vector own, Vector state);
static bool control_yielding_guard_step(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, Matrix following, const relaxed_Yielding *yielding);
static double control_yielding_periods_to_rest(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector x);
static double control_stopping_enter_stopping_time(struct arena *arena, int64_t address, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector dq);
static int64_t control_yielding_yield_step(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past, Matrix following, Vector state, const relaxed_Yielding *yielding, Vector relaxed, int64_t action);
static void control_yielding_widen_bounds(struct arena *arena, const layout_QPViews *qp, Vector limits, Vector q);
static double_2 control_yielding_answer_relaxed(struct arena *arena, const command_RowViews *views, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector relaxed, int64_t action);
static bool control_yielding_is_path(struct arena *arena, Matrix targets);
static bool control_yielding_races(struct arena *arena, const layout_QPViews *qp, Vector x);
static void control_yielding_step(struct arena *arena, const layout_QPViews *limits, Matrix past, Matrix following, const relaxed_Yielding *yielding, Vector figures, Vector x);
static void control_yielding_step_straight(struct arena *arena, Matrix past, const relaxed_Yielding *yielding, Vector x);
static double control_stopping_least_periods(struct arena *arena, Vector x, Vector before, Vector limits, double dt, bool cubic);
static bool control_stopping_within_rates(struct arena *arena, double x, double before, double periods, double accel, double jerk);
static double control_stopping_bend_of(struct arena *arena, double x, double before, double periods);
static double control_stopping_next_velocity(struct arena *arena, double x, double before, double periods, bool cubic);
static double control_stopping_velocity_at(struct arena *arena, double x, double b, double u, bool cubic);
static void control_yielding_step_towards(struct arena *arena, const layout_QPViews *limits, Matrix past, const relaxed_Yielding *yielding, Vector x);
static double control_yielding_make_stoppable(struct arena *arena, const layout_QPViews *limits, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, const command_RowViews *views, Vector x);
static double control_yielding_brake(struct arena *arena, const layout_QPViews *limits, Matrix past, const relaxed_Yielding *yielding, Vector dq);
static bool control_yielding_go_away(struct arena *arena, const layout_QPViews *limits, Vector last, Vector dq);
static int64_t control_yielding_note_missing(struct arena *arena, const command_RowViews *views, Vector dq);
static void control_yielding_note_decision(struct arena *arena, const command_RowViews *views, const layout_QPViews *own, Vector weights, Vector x, int64_t kind, double factor, int64_t action);
static double control_stopping_way_along(struct arena *arena, const stopping_Motion *motion, double x, double b, double count, double dt);
static double control_stopping_least_way(struct arena *arena, const stopping_Motion *motion, double x, double b, double dt);
static bool control_stopping_is_straight(struct arena *arena, const stopping_Motion *motion);
static bool control_stopping_keeps_joint_limits(struct arena *arena, const stopping_Motion *motion, Vector q, Vector limits, double dt);
static bool control_stopping_keeps_ramp(struct arena *arena, const stopping_Motion *motion, Vector q, Vector limits, double dt, int64_t i);
static bool control_stopping_keeps_distances(struct arena *arena, const stopping_Motion *motion, const program_ProgramArrays *arrays, Vector constants, double dt);
static scene_SceneViews schemes_scene_scene_views(struct arena *arena, Vector constants, int64_t dof);
static void schemes_scene_place_bodies(struct arena *arena, const scene_SceneViews *scene, Matrix placements, Matrix placed);
static scene_Contact schemes_scene_contact_of(struct arena *arena, const scene_SceneViews *scene, int64_t k, Matrix placed);
static double_3 schemes_step_vector_at(struct arena *arena, Vector array, int64_t start);
static double_3_2 schemes_scene_ends_of(struct arena *arena, const scene_SceneViews *scene, Matrix placed, int64_t body);
static double_3 references_rotations_combined(struct arena *arena, double a, double_3 u, double b, double_3 v);
static double_3 schemes_step_seen_from(struct arena *arena, Vector placement, double_3 v);
static double schemes_scene_nearest_parameter(struct arena *arena, double_3 a, double_3 u, double_3 half);
static double_3 schemes_scene_beyond(struct arena *arena, double_3 x, double_3 half);
static double_4 schemes_scene_depth(struct arena *arena, double_3 x, double_3 half);
static double_3 schemes_step_axis_at(struct arena *arena, Vector placement, double_3 axis);
static double_3 references_rotations_scaled(struct arena *arena, double a, double_3 u);
static double_3 references_rotations_added(struct arena *arena, double_3 u, double_3 v);
static double schemes_scene_second_order(struct arena *arena, Matrix moves, Matrix radii, int64_t k, Vector travel);
static double_2 control_stopping_along(struct arena *arena, const stopping_Motion *motion, Matrix jacobian, Matrix moves, int64_t k, double_3 point, double_3 normal);
static double schemes_step_rate_along(struct arena *arena, Matrix jacobian, int64_t j, double_3 point, double_3 normal);
static double_3 schemes_step_point_rate(struct arena *arena, Matrix jacobian, int64_t j, double_3 point);
static double_3 references_rotations_cross(struct arena *arena, double_3 u, double_3 v);
static double control_stopping_stopping_time(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector dq);
static void networks_base_enter_rates(struct arena *arena, int64_t address, const layout_QPViews *qp, Vector constants, Vector state, Vector rates);
static double_5 integrators_base_answer_program(struct arena *arena, Vector data, int_3 sizes, int64_t address, int64_t rates, Vector constants, Vector state, Vector point);
static double_5 integrators_explicit_follow(struct arena *arena, const layout_QPViews *qp, int64_t rates, Vector constants, Vector state, Vector point);
static double networks_projection_stable_step(struct arena *arena, const layout_QPViews *qp, Vector active);
static double_2 qp_dense_extreme_eigenvalues(struct arena *arena, Matrix K);
static void qp_dense_rotate(struct arena *arena, Matrix K, int64_t i, int64_t k);
static int64_t integrators_implicit_step_program(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector s, double step);
static void networks_projection_projection_rates(struct arena *arena, const layout_QPViews *qp, Vector constants, Vector state, Vector rates);
static bool qp_dense_is_convex(struct arena *arena, Matrix P, Matrix K);
static bool qp_program_well_formed(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p);
static double_3 qp_residuals_residuals_of(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector point);
static double_3 qp_residuals_point_of_state(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector s, Vector point);
static double_2 references_rotations_coefficients(struct arena *arena, double square);
static double_3 references_rotations_rotated(struct arena *arena, double_3 vector, double_3 v);
static double_3 references_rotations_left_jacobian(struct arena *arena, double_3 vector, double_3 v);
static double_3 references_rotations_column_of(struct arena *arena, Vector target, int64_t j);
static void references_rotations_turn_target(struct arena *arena, Vector target, double_3 vector, double_3 rate);
static void references_shapes_heart_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_shapes_circle_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_shapes_line_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_shapes_lissajous_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_shapes_still_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_turning_cone_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_turning_tilting_path(struct arena *arena, double t, Vector constants, Vector target);
static void references_waypoints_waypoints_path(struct arena *arena, double t, Vector constants, Vector target);
static double_3 references_waypoints_piece(struct arena *arena, double t, Vector constants);
static double_3 references_waypoints_cubic(struct arena *arena, Vector constants, int64_t at, double x);
static double_3 references_waypoints_triple(struct arena *arena, Vector constants, int64_t at);
static double_3 references_waypoints_slope(struct arena *arena, Vector constants, int64_t at, double x);
static void robot_kinematics_kernel_write_kinematics(struct arena *arena, const kinematics_kernel_ModelTables *model, Vector q, Matrix jacobian, Matrix placements, Matrix inertia);
static void robot_kinematics_kernel_compose(struct arena *arena, Vector first, Vector second, Vector product);
static void robot_kinematics_kernel_write_twist(struct arena *arena, Vector placement, Vector kind, Vector twist);
static void robot_kinematics_kernel_write_inertia(struct arena *arena, const kinematics_kernel_ModelTables *model, Matrix placed, Matrix jacobian, Matrix inertia);
static void schemes_collisions_collision_rows(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static double schemes_collisions_write_gradient(struct arena *arena, Matrix moves, const scene_Contact *contact, Matrix jacobian, Vector dq_max, int64_t k, Matrix gradients);
static int64_t schemes_collisions_rank(struct arena *arena, Vector slacks, int64_t k);
static void schemes_costs_add_kinetic_energy(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_costs_add_cyclic_motion(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_limits_joint_limits(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static double schemes_limits_ramp_speed(struct arena *arena, double distance, double offset, double deceleration);
static void schemes_limits_motion_limits(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static void schemes_limits_tip_speed_bounds(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static void schemes_parts_copy_cost(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_parts_copy_task(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_parts_copy_limit(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static void schemes_scene_move_centers(struct arena *arena, Vector constants, Matrix centers, double t);
static void schemes_scene_write_distances(struct arena *arena, Vector constants, int64_t dof, Matrix placements, Vector distances);
static void schemes_step_write_velocity(struct arena *arena, const step_StepViews *step, Vector constants, double_3 point, double_3 axis, Vector row);
static void schemes_step_write_spin(struct arena *arena, const step_StepViews *step, Vector constants, double_3 axis, Vector row);
static void schemes_tasks_position_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_rotation_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_block_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_project_on_range(struct arena *arena, Vector placement, Vector b);
static void schemes_tasks_pose_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_held_pose_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_axis_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_remote_center_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_tasks_joint_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
/* Compute the columns at which all parts of a row but the last end, in their order.
 *
 * iiwa_dnn/control/command.py: row_ends */
static inline int_9 control_command_row_ends(struct arena *arena, int64_t n, int64_t m, int64_t p, int64_t dof)
{
    (void)arena;
    int64_t at_point;
    int64_t at_figures;
    int64_t at_placement;
    int64_t at_past;
    int64_t at_dq;
    int64_t at_decision;
    int64_t at_bounds;
    int64_t at_blocking;
    int64_t at_targets;
    #line 72 "iiwa_dnn/control/command.py"
    #line 73 "iiwa_dnn/control/command.py"
    at_point = ((((n + m) + p) * (n + 1)) + (2 * n));
    #line 74 "iiwa_dnn/control/command.py"
    at_figures = (((at_point + (2 * n)) + m) + p);
    #line 75 "iiwa_dnn/control/command.py"
    at_placement = (at_figures + 5);
    #line 76 "iiwa_dnn/control/command.py"
    at_past = (at_placement + 12);
    #line 77 "iiwa_dnn/control/command.py"
    at_dq = (at_past + (3 * dof));
    #line 78 "iiwa_dnn/control/command.py"
    at_decision = (at_dq + dof);
    #line 79 "iiwa_dnn/control/command.py"
    at_bounds = (at_decision + 4);
    #line 80 "iiwa_dnn/control/command.py"
    at_blocking = (at_bounds + (2 * dof));
    #line 81 "iiwa_dnn/control/command.py"
    at_targets = ((at_blocking + n) + m);
    #line 82 "iiwa_dnn/control/command.py"
    return ((int_9){{at_point, at_figures, at_placement, at_past, at_dq, at_decision, at_bounds, at_blocking, at_targets}});
}

/* Make the views of a row, (width,).
 *
 * iiwa_dnn/control/command.py: row_views */
static inline command_RowViews control_command_row_views(struct arena *arena, Vector row, int64_t n, int64_t m, int64_t p, int64_t dof)
{
    int_9 ends;
    #line 97 "iiwa_dnn/control/command.py"
    #line 98 "iiwa_dnn/control/command.py"
    ends = control_command_row_ends(arena, n, m, p, dof);
    #line 99 "iiwa_dnn/control/command.py"
    return ((command_RowViews){((Vector){row.data, ends.at[0] - 0}), ((Vector){row.data + ends.at[0], ends.at[1] - ends.at[0]}), ((Vector){row.data + ends.at[1], ends.at[2] - ends.at[1]}), ((Vector){row.data + ends.at[2], ends.at[3] - ends.at[2]}), ((Matrix){((Vector){row.data + ends.at[3], ends.at[4] - ends.at[3]}).data, 3, dof}), ((Vector){row.data + ends.at[4], ends.at[5] - ends.at[4]}), ((Vector){row.data + ends.at[5], ends.at[6] - ends.at[5]}), ((Matrix){((Vector){row.data + ends.at[6], ends.at[7] - ends.at[6]}).data, 2, dof}), ((Vector){row.data + ends.at[7], ends.at[8] - ends.at[7]}), ((Matrix){((Vector){row.data + ends.at[8], row.size0 - ends.at[8]}).data, int_quotient(((row.size0) - ends.at[8]), 18), 18})});
}

/* Write values (k,) into the first k of `out`.
 *
 * iiwa_dnn/control/relaxed.py: copied */
static void control_relaxed_copied(struct arena *arena, Vector out, Vector values)
{
    (void)arena;
    #line 125 "iiwa_dnn/control/relaxed.py"
    #line 126 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = (values.size0); i < end_i; i++) {
        #line 127 "iiwa_dnn/control/relaxed.py"
        out.data[i] = values.data[i];
    }
    return;
}

/* Return the largest absolute value of an array (k,).
 *
 * iiwa_dnn/control/relaxed.py: largest_entry */
static double control_relaxed_largest_entry(struct arena *arena, Vector values)
{
    (void)arena;
    double largest;
    #line 132 "iiwa_dnn/control/relaxed.py"
    #line 133 "iiwa_dnn/control/relaxed.py"
    largest = 0.0;
    #line 134 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = (values.size0); i < end_i; i++) {
        #line 135 "iiwa_dnn/control/relaxed.py"
        largest = double_max(largest, fabs(values.data[i]));
    }
    #line 136 "iiwa_dnn/control/relaxed.py"
    return largest;
}

/* Settle the network from its last state or, if need be, from a cold start.
 *
 * Args:
 *     qp: The program.
 *     yielding: How the network settles.
 *     state: Its state, (size,), advanced; where it does not settle, cold again.
 *     point: The point that the state stands for, (2 n + m + p,), overwritten.
 *     figures: Figures of the step's answer, (5,): the linear systems are added to the first, the
 *         others are overwritten.
 *     tolerances: Residual, in tolerances, up to which the program counts as solved.
 *
 * Returns:
 *     Whether the point is the program's solution.
 *
 * iiwa_dnn/control/relaxed.py: settled */
static bool control_relaxed_settled(struct arena *arena, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector point, Vector figures, double tolerances)
{
    Vector settings;
    double systems;
    double time;
    double primal;
    double dual;
    double gap;
    #line 148 "iiwa_dnn/control/relaxed.py"
    #line 162 "iiwa_dnn/control/relaxed.py"
    settings = (*yielding).settings;
    #line 163 "iiwa_dnn/control/relaxed.py"
    for (int64_t _ = 0, end__ = 2; _ < end__; _++) {
        #line 164 "iiwa_dnn/control/relaxed.py"
        const double_5 own_5 = integrators_implicit_settle(arena, &(*qp), 0, settings, state, point);
        systems = own_5.at[0];
        time = own_5.at[1];
        primal = own_5.at[2];
        dual = own_5.at[3];
        gap = own_5.at[4];
        #line 165 "iiwa_dnn/control/relaxed.py"
        figures.data[0] += systems;
        #line 166 "iiwa_dnn/control/relaxed.py"
        figures.data[1] = time;
        #line 167 "iiwa_dnn/control/relaxed.py"
        if (qp_residuals_within(arena, primal, dual, gap, (tolerances * settings.data[0]))) {
            #line 168 "iiwa_dnn/control/relaxed.py"
            return true;
        }
        #line 169 "iiwa_dnn/control/relaxed.py"
        for (int64_t own_k = 0, own_end = ((Vector){state.data, state.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){state.data, state.size0 - 0}).data[own_k] = 0.0;
    }
    #line 170 "iiwa_dnn/control/relaxed.py"
    return false;
}

/* Advance `s` (size,) in place until the residuals of `point` (size,) are small enough.
 *
 * A compiled answer (`enter_answer`), of the projection network alone: `rates` is not used.
 *
 * Returns:
 *     ``(systems, time, primal, dual, gap)``: linear systems solved, network time that passed
 *     [rho], and the residuals of `point`.
 *
 * iiwa_dnn/networks/integrators/implicit.py: settle */
static double_5 integrators_implicit_settle(struct arena *arena, const layout_QPViews *qp, int64_t rates, Vector constants, Vector s, Vector point)
{
    (void)rates;
    double tol;
    int64_t budget;
    int64_t n;
    int64_t rows;
    implicit_steps_Condensed matrix;
    Vector now;
    Vector then;
    Vector new;
    double step;
    int64_t systems;
    double time;
    int64_t stuck;
    double rate;
    double smallest;
    double primal;
    double dual;
    double gap;
    double new_rate;
    int64_t taken;
    const struct arena mark = *arena;
    #line 135 "iiwa_dnn/networks/integrators/implicit.py"
    #line 143 "iiwa_dnn/networks/integrators/implicit.py"
    tol = constants.data[0];
    #line 144 "iiwa_dnn/networks/integrators/implicit.py"
    budget = (int64_t)(constants.data[1]);
    #line 145 "iiwa_dnn/networks/integrators/implicit.py"
    n = ((*qp).q.size0);
    #line 146 "iiwa_dnn/networks/integrators/implicit.py"
    rows = ((s.size0) - n);
    #line 147 "iiwa_dnn/networks/integrators/implicit.py"
    matrix = ((implicit_steps_Condensed){((Vector){arena_empty(arena, rows), rows}), ((Vector){arena_zeros(arena, (rows - (2 * n))), (rows - (2 * n))}), ((Matrix){arena_zeros(arena, n * n), n, n}), ((Matrix){arena_empty(arena, n * n), n, n}), ((Vector){arena_empty(arena, rows), rows})});
    #line 150 "iiwa_dnn/networks/integrators/implicit.py"
    now = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    #line 151 "iiwa_dnn/networks/integrators/implicit.py"
    then = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    #line 152 "iiwa_dnn/networks/integrators/implicit.py"
    new = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    #line 153 "iiwa_dnn/networks/integrators/implicit.py"
    step = 30.0;
    #line 154 "iiwa_dnn/networks/integrators/implicit.py"
    systems = 0;
    #line 155 "iiwa_dnn/networks/integrators/implicit.py"
    time = 0.0;
    #line 156 "iiwa_dnn/networks/integrators/implicit.py"
    stuck = 0;
    #line 157 "iiwa_dnn/networks/integrators/implicit.py"
    rate = networks_projection_field(arena, &(*qp), s, now);
    #line 158 "iiwa_dnn/networks/integrators/implicit.py"
    smallest = INFINITY;
    #line 159 "iiwa_dnn/networks/integrators/implicit.py"
    while (systems < budget) {
        #line 160 "iiwa_dnn/networks/integrators/implicit.py"
        stuck += 1;
        #line 161 "iiwa_dnn/networks/integrators/implicit.py"
        if (rate <= (0.5 * smallest)) {
            #line 162 "iiwa_dnn/networks/integrators/implicit.py"
            smallest = rate;
            #line 163 "iiwa_dnn/networks/integrators/implicit.py"
            stuck = 0;
        }
        #line 164 "iiwa_dnn/networks/integrators/implicit.py"
        if (!(rate > tol)) {
            #line 165 "iiwa_dnn/networks/integrators/implicit.py"
            const double_3 own_41 = qp_residuals_kkt_point(arena, &(*qp), s, point);
            primal = own_41.at[0];
            dual = own_41.at[1];
            gap = own_41.at[2];
            #line 166 "iiwa_dnn/networks/integrators/implicit.py"
            if (qp_residuals_within(arena, primal, dual, gap, tol)) {
                #line 167 "iiwa_dnn/networks/integrators/implicit.py"
                const double_5 own_result = ((double_5){{systems, time, primal, dual, gap}});
                arena_leave(arena, &mark);
                return own_result;
            }
        }
        #line 168 "iiwa_dnn/networks/integrators/implicit.py"
        networks_projection_mark_active(arena, &(*qp), s, now, matrix.active);
        #line 169 "iiwa_dnn/networks/integrators/implicit.py"
        systems += 1;
        #line 170 "iiwa_dnn/networks/integrators/implicit.py"
        if (integrators_implicit_steps_linear_step(arena, &(*qp), s, now, 100000000.0, &matrix, new)) {
            #line 171 "iiwa_dnn/networks/integrators/implicit.py"
            new_rate = networks_projection_field(arena, &(*qp), new, then);
            #line 172 "iiwa_dnn/networks/integrators/implicit.py"
            if (new_rate < (0.5 * rate)) {
                #line 173 "iiwa_dnn/networks/integrators/implicit.py"
                integrators_implicit_steps_copy_into(arena, s, new);
                #line 174 "iiwa_dnn/networks/integrators/implicit.py"
                integrators_implicit_steps_copy_into(arena, now, then);
                #line 175 "iiwa_dnn/networks/integrators/implicit.py"
                rate = new_rate;
                #line 176 "iiwa_dnn/networks/integrators/implicit.py"
                time += 100000000.0;
                #line 177 "iiwa_dnn/networks/integrators/implicit.py"
                continue;
            }
        }
        #line 178 "iiwa_dnn/networks/integrators/implicit.py"
        if (stuck > 15) {
            #line 179 "iiwa_dnn/networks/integrators/implicit.py"
            break;
        }
        #line 180 "iiwa_dnn/networks/integrators/implicit.py"
        taken = integrators_implicit_steps_backward_euler(arena, &(*qp), s, step, new, (0.1 * rate), int_min(50, (budget - systems)), &matrix);
        #line 183 "iiwa_dnn/networks/integrators/implicit.py"
        if (taken < 0) {
            #line 184 "iiwa_dnn/networks/integrators/implicit.py"
            step *= 0.1;
            #line 185 "iiwa_dnn/networks/integrators/implicit.py"
            continue;
        }
        #line 186 "iiwa_dnn/networks/integrators/implicit.py"
        systems += taken;
        #line 187 "iiwa_dnn/networks/integrators/implicit.py"
        time += step;
        #line 188 "iiwa_dnn/networks/integrators/implicit.py"
        integrators_implicit_steps_copy_into(arena, s, new);
        #line 189 "iiwa_dnn/networks/integrators/implicit.py"
        rate = networks_projection_field(arena, &(*qp), s, now);
        #line 190 "iiwa_dnn/networks/integrators/implicit.py"
        if (step < 100000000.0) {
            #line 191 "iiwa_dnn/networks/integrators/implicit.py"
            step *= 10.0;
        }
    }
    #line 192 "iiwa_dnn/networks/integrators/implicit.py"
    const double_3 own_106 = qp_residuals_kkt_point(arena, &(*qp), s, point);
    primal = own_106.at[0];
    dual = own_106.at[1];
    gap = own_106.at[2];
    #line 193 "iiwa_dnn/networks/integrators/implicit.py"
    const double_5 own_result = ((double_5){{systems, time, primal, dual, gap}});
    arena_leave(arena, &mark);
    return own_result;
}

/* Write rho ds/dt at a state, both (size,), without the projection of x on its bounds.
 *
 * Returns:
 *     The largest absolute rate: zero exactly at a KKT point, NaN if one is NaN.
 *
 * iiwa_dnn/networks/projection.py: field */
static double networks_projection_field(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates)
{
    int64_t n;
    double largest;
    #line 81 "iiwa_dnn/networks/projection.py"
    #line 86 "iiwa_dnn/networks/projection.py"
    n = ((*qp).q.size0);
    #line 87 "iiwa_dnn/networks/projection.py"
    qp_dense_times(arena, (*qp).P, s, rates);
    #line 88 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 89 "iiwa_dnn/networks/projection.py"
        rates.data[i] = ((-(*qp).q.data[i]) - rates.data[i]);
    }
    #line 90 "iiwa_dnn/networks/projection.py"
    networks_projection_add_transposed(arena, &(*qp), (-1.0), s, rates);
    #line 91 "iiwa_dnn/networks/projection.py"
    networks_projection_write_slacks(arena, &(*qp), s, ((Vector){rates.data + n, rates.size0 - n}));
    #line 92 "iiwa_dnn/networks/projection.py"
    for (int64_t k = (n + ((*qp).b.size0)), end_k = (s.size0); k < end_k; k++) {
        #line 93 "iiwa_dnn/networks/projection.py"
        if (!((s.data[k] + rates.data[k]) > 0.0)) {
            #line 94 "iiwa_dnn/networks/projection.py"
            rates.data[k] = (-s.data[k]);
        }
    }
    #line 95 "iiwa_dnn/networks/projection.py"
    largest = 0.0;
    #line 96 "iiwa_dnn/networks/projection.py"
    for (int64_t k = 0, end_k = (s.size0); k < end_k; k++) {
        #line 97 "iiwa_dnn/networks/projection.py"
        largest = qp_layout_larger(arena, largest, fabs(rates.data[k]));
    }
    #line 98 "iiwa_dnn/networks/projection.py"
    return largest;
}

/* Write the product of a matrix (k, n) and the first n entries of x into the first k of `out`.
 *
 * Two sums at once do not wait for each other; each is that of `row_dot`.
 *
 * iiwa_dnn/qp/dense.py: times */
static void qp_dense_times(struct arena *arena, Matrix rows, Vector x, Vector out)
{
    double one;
    double two;
    #line 28 "iiwa_dnn/qp/dense.py"
    #line 32 "iiwa_dnn/qp/dense.py"
    for (int64_t pair = 0, end_pair = int_quotient(rows.size0, 2); pair < end_pair; pair++) {
        #line 33 "iiwa_dnn/qp/dense.py"
        one = 0.0;
        #line 34 "iiwa_dnn/qp/dense.py"
        two = 0.0;
        #line 35 "iiwa_dnn/qp/dense.py"
        for (int64_t k = 0, end_k = rows.size1; k < end_k; k++) {
            #line 36 "iiwa_dnn/qp/dense.py"
            one += (rows.data[(2 * pair) * rows.size1 + k] * x.data[k]);
            #line 37 "iiwa_dnn/qp/dense.py"
            two += (rows.data[((2 * pair) + 1) * rows.size1 + k] * x.data[k]);
        }
        #line 38 "iiwa_dnn/qp/dense.py"
        out.data[(2 * pair)] = one;
        #line 39 "iiwa_dnn/qp/dense.py"
        out.data[((2 * pair) + 1)] = two;
    }
    #line 40 "iiwa_dnn/qp/dense.py"
    for (int64_t j = (int_quotient(rows.size0, 2) * 2), end_j = rows.size0; j < end_j; j++) {
        #line 41 "iiwa_dnn/qp/dense.py"
        out.data[j] = qp_dense_row_dot(arena, rows, j, x);
    }
    return;
}

/* Compute the product of row j of a matrix (k, n) and the first n entries of x.
 *
 * iiwa_dnn/qp/dense.py: row_dot */
static double qp_dense_row_dot(struct arena *arena, Matrix rows, int64_t j, Vector x)
{
    (void)arena;
    double value;
    #line 19 "iiwa_dnn/qp/dense.py"
    #line 20 "iiwa_dnn/qp/dense.py"
    value = 0.0;
    #line 21 "iiwa_dnn/qp/dense.py"
    for (int64_t k = 0, end_k = rows.size1; k < end_k; k++) {
        #line 22 "iiwa_dnn/qp/dense.py"
        value += (rows.data[j * rows.size1 + k] * x.data[k]);
    }
    #line 23 "iiwa_dnn/qp/dense.py"
    return value;
}

/* Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,).
 *
 * iiwa_dnn/networks/projection.py: add_transposed */
static void networks_projection_add_transposed(struct arena *arena, const layout_QPViews *qp, double factor, Vector s, Vector out)
{
    int64_t n;
    int64_t p;
    int64_t at_z;
    int64_t at_u;
    #line 49 "iiwa_dnn/networks/projection.py"
    #line 50 "iiwa_dnn/networks/projection.py"
    n = ((*qp).q.size0);
    #line 51 "iiwa_dnn/networks/projection.py"
    p = ((*qp).b.size0);
    #line 52 "iiwa_dnn/networks/projection.py"
    at_z = (n + p);
    #line 53 "iiwa_dnn/networks/projection.py"
    at_u = (at_z + ((*qp).h.size0));
    #line 54 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 55 "iiwa_dnn/networks/projection.py"
        out.data[i] += (factor * (s.data[(at_u + i)] - s.data[((at_u + n) + i)]));
    }
    #line 56 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = p; j < end_j; j++) {
        #line 57 "iiwa_dnn/networks/projection.py"
        qp_dense_add_row(arena, out, (factor * s.data[(n + j)]), (*qp).A, j);
    }
    #line 58 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 59 "iiwa_dnn/networks/projection.py"
        if (s.data[(at_z + j)] != 0.0) {
            #line 60 "iiwa_dnn/networks/projection.py"
            qp_dense_add_row(arena, out, (factor * s.data[(at_z + j)]), (*qp).G, j);
        }
    }
    return;
}

/* Add a multiple of row j of a matrix (k, n) to the first n entries of `out`.
 *
 * iiwa_dnn/qp/dense.py: add_row */
static void qp_dense_add_row(struct arena *arena, Vector out, double factor, Matrix rows, int64_t j)
{
    (void)arena;
    #line 46 "iiwa_dnn/qp/dense.py"
    #line 47 "iiwa_dnn/qp/dense.py"
    for (int64_t k = 0, end_k = rows.size1; k < end_k; k++) {
        #line 48 "iiwa_dnn/qp/dense.py"
        out.data[k] += (factor * rows.data[j * rows.size1 + k]);
    }
    return;
}

/* Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n).
 *
 * iiwa_dnn/networks/projection.py: write_slacks */
static void networks_projection_write_slacks(struct arena *arena, const layout_QPViews *qp, Vector x, Vector slacks)
{
    int64_t n;
    int64_t p;
    int64_t first;
    #line 65 "iiwa_dnn/networks/projection.py"
    #line 66 "iiwa_dnn/networks/projection.py"
    n = ((*qp).q.size0);
    #line 67 "iiwa_dnn/networks/projection.py"
    p = ((*qp).b.size0);
    #line 68 "iiwa_dnn/networks/projection.py"
    first = (p + ((*qp).h.size0));
    #line 69 "iiwa_dnn/networks/projection.py"
    networks_projection_rows_times(arena, &(*qp), x, slacks);
    #line 70 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = p; j < end_j; j++) {
        #line 71 "iiwa_dnn/networks/projection.py"
        slacks.data[j] -= (*qp).b.data[j];
    }
    #line 72 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 73 "iiwa_dnn/networks/projection.py"
        slacks.data[(p + j)] -= (*qp).h.data[j];
    }
    #line 74 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 75 "iiwa_dnn/networks/projection.py"
        slacks.data[(first + i)] -= (*qp).ub.data[i];
        #line 76 "iiwa_dnn/networks/projection.py"
        slacks.data[((first + n) + i)] += (*qp).lb.data[i];
    }
    return;
}

/* Write [A; G; I; -I] x into `values`, of size p + m + 2n.
 *
 * iiwa_dnn/networks/projection.py: rows_times */
static void networks_projection_rows_times(struct arena *arena, const layout_QPViews *qp, Vector x, Vector values)
{
    int64_t n;
    int64_t p;
    int64_t first;
    #line 36 "iiwa_dnn/networks/projection.py"
    #line 37 "iiwa_dnn/networks/projection.py"
    n = ((*qp).q.size0);
    #line 38 "iiwa_dnn/networks/projection.py"
    p = ((*qp).b.size0);
    #line 39 "iiwa_dnn/networks/projection.py"
    first = (p + ((*qp).h.size0));
    #line 40 "iiwa_dnn/networks/projection.py"
    qp_dense_times(arena, (*qp).A, x, values);
    #line 41 "iiwa_dnn/networks/projection.py"
    qp_dense_times(arena, (*qp).G, x, ((Vector){values.data + p, values.size0 - p}));
    #line 42 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 43 "iiwa_dnn/networks/projection.py"
        values.data[(first + i)] = x.data[i];
        #line 44 "iiwa_dnn/networks/projection.py"
        values.data[((first + n) + i)] = (-x.data[i]);
    }
    return;
}

/* Return the larger of two numbers; unlike with max(), a NaN once seen stays.
 *
 * iiwa_dnn/qp/layout.py: larger */
static double qp_layout_larger(struct arena *arena, double largest, double value)
{
    (void)arena;
    #line 97 "iiwa_dnn/qp/layout.py"
    #line 98 "iiwa_dnn/qp/layout.py"
    return (((value > largest) || (value != value)) ? value : largest);
}

/* Write the point [x | y | z | z_box] of a state [x | y | z | ...] into `point`.
 *
 * x is put inside its bounds and z made nonnegative. z_box is the part of x minus the gradient
 * P x + q + A^T y + G^T z that the projection on the bounds cuts off: at an equilibrium u - l and
 * the part of the multiplier that the primal projection carries.
 *
 * Returns:
 *     ``(primal, dual, gap)`` of the point as it is handed out.
 *
 * iiwa_dnn/qp/residuals.py: kkt_point */
static double_3 qp_residuals_kkt_point(struct arena *arena, const layout_QPViews *qp, Vector s, Vector point)
{
    int64_t n;
    int64_t p;
    int64_t m;
    int64_t at_z;
    int64_t at_box;
    Vector descent;
    double above;
    double below;
    #line 57 "iiwa_dnn/qp/residuals.py"
    #line 66 "iiwa_dnn/qp/residuals.py"
    n = ((*qp).q.size0);
    #line 67 "iiwa_dnn/qp/residuals.py"
    p = ((*qp).b.size0);
    #line 68 "iiwa_dnn/qp/residuals.py"
    m = ((*qp).h.size0);
    #line 69 "iiwa_dnn/qp/residuals.py"
    at_z = (n + p);
    #line 70 "iiwa_dnn/qp/residuals.py"
    at_box = (at_z + m);
    #line 71 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 72 "iiwa_dnn/qp/residuals.py"
        point.data[i] = double_min(double_max(s.data[i], (*qp).lb.data[i]), (*qp).ub.data[i]);
    }
    #line 73 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = p; j < end_j; j++) {
        #line 74 "iiwa_dnn/qp/residuals.py"
        point.data[(n + j)] = s.data[(n + j)];
    }
    #line 75 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = m; j < end_j; j++) {
        #line 76 "iiwa_dnn/qp/residuals.py"
        point.data[(at_z + j)] = double_max(s.data[(at_z + j)], 0.0);
    }
    #line 77 "iiwa_dnn/qp/residuals.py"
    descent = ((Vector){point.data + at_box, point.size0 - at_box});
    #line 78 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 79 "iiwa_dnn/qp/residuals.py"
        descent.data[i] = ((-(*qp).q.data[i]) - qp_dense_row_dot(arena, (*qp).P, i, point));
    }
    #line 80 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = p; j < end_j; j++) {
        #line 81 "iiwa_dnn/qp/residuals.py"
        qp_dense_add_row(arena, descent, (-point.data[(n + j)]), (*qp).A, j);
    }
    #line 82 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = m; j < end_j; j++) {
        #line 83 "iiwa_dnn/qp/residuals.py"
        if (point.data[(at_z + j)] != 0.0) {
            #line 84 "iiwa_dnn/qp/residuals.py"
            qp_dense_add_row(arena, descent, (-point.data[(at_z + j)]), (*qp).G, j);
        }
    }
    #line 85 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 87 "iiwa_dnn/qp/residuals.py"
        above = ((point.data[i] - (*qp).ub.data[i]) + descent.data[i]);
        #line 88 "iiwa_dnn/qp/residuals.py"
        below = ((point.data[i] - (*qp).lb.data[i]) + descent.data[i]);
        #line 89 "iiwa_dnn/qp/residuals.py"
        if (above > 0.0) {
            #line 90 "iiwa_dnn/qp/residuals.py"
            descent.data[i] = above;
        }
        else {
            #line 91 "iiwa_dnn/qp/residuals.py"
            if (below < 0.0) {
                #line 92 "iiwa_dnn/qp/residuals.py"
                descent.data[i] = below;
            }
            else {
                #line 94 "iiwa_dnn/qp/residuals.py"
                descent.data[i] = 0.0;
            }
        }
    }
    #line 95 "iiwa_dnn/qp/residuals.py"
    return qp_residuals_point_residuals(arena, &(*qp), point);
}

/* Compute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them.
 *
 * iiwa_dnn/qp/residuals.py: point_residuals */
static double_3 qp_residuals_point_residuals(struct arena *arena, const layout_QPViews *qp, Vector point)
{
    int64_t n;
    int64_t p;
    int64_t at_z;
    int64_t at_box;
    double primal;
    double dual;
    double gap;
    Vector gradient;
    double x;
    double multiplier;
    double value;
    double y;
    double z;
    const struct arena mark = *arena;
    #line 12 "iiwa_dnn/qp/residuals.py"
    #line 13 "iiwa_dnn/qp/residuals.py"
    n = ((*qp).q.size0);
    #line 14 "iiwa_dnn/qp/residuals.py"
    p = ((*qp).b.size0);
    #line 15 "iiwa_dnn/qp/residuals.py"
    at_z = (n + p);
    #line 16 "iiwa_dnn/qp/residuals.py"
    at_box = (at_z + ((*qp).h.size0));
    #line 17 "iiwa_dnn/qp/residuals.py"
    primal = 0.0;
    #line 18 "iiwa_dnn/qp/residuals.py"
    dual = 0.0;
    #line 19 "iiwa_dnn/qp/residuals.py"
    gap = 0.0;
    #line 20 "iiwa_dnn/qp/residuals.py"
    gradient = ((Vector){arena_empty(arena, n), n});
    #line 21 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 22 "iiwa_dnn/qp/residuals.py"
        x = point.data[i];
        #line 23 "iiwa_dnn/qp/residuals.py"
        multiplier = point.data[(at_box + i)];
        #line 24 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, (x - (*qp).ub.data[i]));
        #line 25 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, ((*qp).lb.data[i] - x));
        #line 26 "iiwa_dnn/qp/residuals.py"
        value = ((*qp).q.data[i] + qp_dense_row_dot(arena, (*qp).P, i, point));
        #line 27 "iiwa_dnn/qp/residuals.py"
        gap += (x * value);
        #line 28 "iiwa_dnn/qp/residuals.py"
        gradient.data[i] = (value + multiplier);
        #line 29 "iiwa_dnn/qp/residuals.py"
        if ((multiplier > 0.0) && ((*qp).ub.data[i] < INFINITY)) {
            #line 30 "iiwa_dnn/qp/residuals.py"
            gap += ((*qp).ub.data[i] * multiplier);
        }
        else {
            #line 31 "iiwa_dnn/qp/residuals.py"
            if ((multiplier < 0.0) && ((*qp).lb.data[i] > (-INFINITY))) {
                #line 32 "iiwa_dnn/qp/residuals.py"
                gap += ((*qp).lb.data[i] * multiplier);
            }
        }
    }
    #line 33 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = p; j < end_j; j++) {
        #line 34 "iiwa_dnn/qp/residuals.py"
        y = point.data[(n + j)];
        #line 35 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, fabs((qp_dense_row_dot(arena, (*qp).A, j, point) - (*qp).b.data[j])));
        #line 36 "iiwa_dnn/qp/residuals.py"
        gap += ((*qp).b.data[j] * y);
        #line 37 "iiwa_dnn/qp/residuals.py"
        qp_dense_add_row(arena, gradient, y, (*qp).A, j);
    }
    #line 38 "iiwa_dnn/qp/residuals.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 39 "iiwa_dnn/qp/residuals.py"
        z = point.data[(at_z + j)];
        #line 40 "iiwa_dnn/qp/residuals.py"
        primal = qp_layout_larger(arena, primal, (qp_dense_row_dot(arena, (*qp).G, j, point) - (*qp).h.data[j]));
        #line 41 "iiwa_dnn/qp/residuals.py"
        if (z != 0.0) {
            #line 42 "iiwa_dnn/qp/residuals.py"
            gap += ((*qp).h.data[j] * z);
            #line 43 "iiwa_dnn/qp/residuals.py"
            qp_dense_add_row(arena, gradient, z, (*qp).G, j);
        }
    }
    #line 44 "iiwa_dnn/qp/residuals.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 45 "iiwa_dnn/qp/residuals.py"
        dual = qp_layout_larger(arena, dual, fabs(gradient.data[i]));
    }
    #line 46 "iiwa_dnn/qp/residuals.py"
    const double_3 own_result = ((double_3){{primal, dual, fabs(gap)}});
    arena_leave(arena, &mark);
    return own_result;
}

/* Check that no residual is above the tolerance, and none NaN.
 *
 * iiwa_dnn/qp/residuals.py: within */
static bool qp_residuals_within(struct arena *arena, double primal, double dual, double gap, double tol)
{
    (void)arena;
    #line 106 "iiwa_dnn/qp/residuals.py"
    #line 107 "iiwa_dnn/qp/residuals.py"
    return ((primal <= tol) && (dual <= tol) && (gap <= tol));
}

/* Mark the rows [A; G; I; -I] that are active by 1, others by 0, (p + m + 2n,).
 *
 * Equalities are active, inequalities where mu + Omega x - chi > 0. A multiplier that is not
 * active decays: it and its rate add up to zero exactly.
 *
 * iiwa_dnn/networks/projection.py: mark_active */
static void networks_projection_mark_active(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, Vector active)
{
    (void)arena;
    int64_t n;
    #line 103 "iiwa_dnn/networks/projection.py"
    #line 108 "iiwa_dnn/networks/projection.py"
    n = ((*qp).q.size0);
    #line 109 "iiwa_dnn/networks/projection.py"
    for (int64_t k = 0, end_k = (active.size0); k < end_k; k++) {
        #line 110 "iiwa_dnn/networks/projection.py"
        active.data[k] = (((k < ((*qp).b.size0)) || ((s.data[(n + k)] + rates.data[(n + k)]) > 0.0)) ? 1.0 : 0.0);
    }
    return;
}

/* Write the state after a linearly implicit step [rho] into `new`, like `s` (3n + m + p,).
 *
 * `rates` and `matrix.active` are those at s.
 *
 * Returns:
 *     False if K is not positive definite to working precision; `new` is then meaningless.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: linear_step */
static inline bool integrators_implicit_steps_linear_step(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, double step, const implicit_steps_Condensed *matrix, Vector new)
{
    int64_t n;
    Vector active;
    Vector values;
    double decay;
    #line 91 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 98 "iiwa_dnn/networks/integrators/implicit_steps.py"
    n = ((*qp).q.size0);
    #line 99 "iiwa_dnn/networks/integrators/implicit_steps.py"
    active = (*matrix).active;
    #line 100 "iiwa_dnn/networks/integrators/implicit_steps.py"
    values = (*matrix).values;
    #line 101 "iiwa_dnn/networks/integrators/implicit_steps.py"
    integrators_implicit_steps_build_condensed(arena, &(*qp), step, &(*matrix));
    #line 102 "iiwa_dnn/networks/integrators/implicit_steps.py"
    if (!qp_dense_cholesky_factor(arena, (*matrix).K)) {
        #line 103 "iiwa_dnn/networks/integrators/implicit_steps.py"
        return false;
    }
    #line 105 "iiwa_dnn/networks/integrators/implicit_steps.py"
    decay = ((double)step / (1.0 + step));
    #line 106 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 107 "iiwa_dnn/networks/integrators/implicit_steps.py"
        values.data[i] = rates.data[i];
    }
    #line 108 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0, end_k = (active.size0); k < end_k; k++) {
        #line 109 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new.data[(n + k)] = (rates.data[(n + k)] * ((active.data[k] != 0.0) ? step : decay));
    }
    #line 110 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_add_transposed(arena, &(*qp), (-1.0), new, values);
    #line 111 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_factor_solve(arena, (*matrix).K, values, new);
    #line 112 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_rows_times(arena, &(*qp), new, values);
    #line 113 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0, end_k = (active.size0); k < end_k; k++) {
        #line 114 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new.data[(n + k)] += ((step * active.data[k]) * values.data[k]);
    }
    #line 115 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0, end_k = (s.size0); k < end_k; k++) {
        #line 116 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new.data[k] += s.data[k];
    }
    #line 117 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return true;
}

/* Write the condensed matrix of the active set for a step [rho] into `matrix.K`.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: build_condensed */
static void integrators_implicit_steps_build_condensed(struct arena *arena, const layout_QPViews *qp, double step, const implicit_steps_Condensed *matrix)
{
    int64_t n;
    int64_t first;
    double bounds;
    #line 65 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 66 "iiwa_dnn/networks/integrators/implicit_steps.py"
    n = ((*qp).q.size0);
    #line 67 "iiwa_dnn/networks/integrators/implicit_steps.py"
    first = ((*matrix).counted.size0);
    #line 68 "iiwa_dnn/networks/integrators/implicit_steps.py"
    integrators_implicit_steps_count_rows(arena, &(*matrix), (*qp).A, 0);
    #line 69 "iiwa_dnn/networks/integrators/implicit_steps.py"
    integrators_implicit_steps_count_rows(arena, &(*matrix), (*qp).G, ((*qp).b.size0));
    #line 70 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 71 "iiwa_dnn/networks/integrators/implicit_steps.py"
        for (int64_t k = i, end_k = n; k < end_k; k++) {
            #line 72 "iiwa_dnn/networks/integrators/implicit_steps.py"
            (*matrix).K.data[i * (*matrix).K.size1 + k] = ((*qp).P.data[i * (*qp).P.size1 + k] + (step * (*matrix).gram.data[i * (*matrix).gram.size1 + k]));
        }
        #line 73 "iiwa_dnn/networks/integrators/implicit_steps.py"
        bounds = ((*matrix).active.data[(first + i)] + (*matrix).active.data[((first + n) + i)]);
        #line 74 "iiwa_dnn/networks/integrators/implicit_steps.py"
        (*matrix).K.data[i * (*matrix).K.size1 + i] += (((double)1.0 / step) + (step * bounds));
    }
    return;
}

/* Add active rows (k, n) to `gram`, and take off others: few change between two steps.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _count_rows */
static void integrators_implicit_steps_count_rows(struct arena *arena, const implicit_steps_Condensed *matrix, Matrix rows, int64_t first)
{
    double change;
    #line 79 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 80 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t j = 0, end_j = rows.size0; j < end_j; j++) {
        #line 81 "iiwa_dnn/networks/integrators/implicit_steps.py"
        change = ((*matrix).active.data[(first + j)] - (*matrix).counted.data[(first + j)]);
        #line 82 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (change != 0.0) {
            #line 83 "iiwa_dnn/networks/integrators/implicit_steps.py"
            qp_dense_add_outer(arena, (*matrix).gram, change, rows, j);
            #line 84 "iiwa_dnn/networks/integrators/implicit_steps.py"
            (*matrix).counted.data[(first + j)] += change;
        }
    }
    return;
}

/* Add factor v v^T to the upper half of `out` (n, n), v being row j of a matrix (k, n).
 *
 * iiwa_dnn/qp/dense.py: add_outer */
static void qp_dense_add_outer(struct arena *arena, Matrix out, double factor, Matrix rows, int64_t j)
{
    (void)arena;
    double scaled;
    #line 53 "iiwa_dnn/qp/dense.py"
    #line 54 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0, end_i = rows.size1; i < end_i; i++) {
        #line 55 "iiwa_dnn/qp/dense.py"
        scaled = (factor * rows.data[j * rows.size1 + i]);
        #line 56 "iiwa_dnn/qp/dense.py"
        for (int64_t k = i, end_k = rows.size1; k < end_k; k++) {
            #line 57 "iiwa_dnn/qp/dense.py"
            out.data[i * out.size1 + k] += (scaled * rows.data[j * rows.size1 + k]);
        }
    }
    return;
}

/* Overwrite the upper half of K (n, n) by R with K = R^T R, its diagonal inverted.
 *
 * Returns:
 *     False if K is not positive definite to working precision; its content is then meaningless.
 *
 * iiwa_dnn/qp/dense.py: cholesky_factor */
static bool qp_dense_cholesky_factor(struct arena *arena, Matrix K)
{
    (void)arena;
    int64_t size;
    double one;
    double two;
    double last;
    #line 62 "iiwa_dnn/qp/dense.py"
    #line 67 "iiwa_dnn/qp/dense.py"
    size = K.size0;
    #line 68 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0, end_i = size; i < end_i; i++) {
        #line 69 "iiwa_dnn/qp/dense.py"
        for (int64_t pair = 0, end_pair = int_quotient(i, 2); pair < end_pair; pair++) {
            #line 70 "iiwa_dnn/qp/dense.py"
            one = K.data[(2 * pair) * K.size1 + i];
            #line 71 "iiwa_dnn/qp/dense.py"
            two = K.data[((2 * pair) + 1) * K.size1 + i];
            #line 72 "iiwa_dnn/qp/dense.py"
            for (int64_t k = i, end_k = size; k < end_k; k++) {
                #line 73 "iiwa_dnn/qp/dense.py"
                K.data[i * K.size1 + k] = ((K.data[i * K.size1 + k] - (one * K.data[(2 * pair) * K.size1 + k])) - (two * K.data[((2 * pair) + 1) * K.size1 + k]));
            }
        }
        #line 74 "iiwa_dnn/qp/dense.py"
        if (int_remainder(i, 2) == 1) {
            #line 75 "iiwa_dnn/qp/dense.py"
            last = K.data[(i - 1) * K.size1 + i];
            #line 76 "iiwa_dnn/qp/dense.py"
            for (int64_t k = i, end_k = size; k < end_k; k++) {
                #line 77 "iiwa_dnn/qp/dense.py"
                K.data[i * K.size1 + k] -= (last * K.data[(i - 1) * K.size1 + k]);
            }
        }
        #line 78 "iiwa_dnn/qp/dense.py"
        if (!(K.data[i * K.size1 + i] > 0.0)) {
            #line 79 "iiwa_dnn/qp/dense.py"
            return false;
        }
        #line 80 "iiwa_dnn/qp/dense.py"
        K.data[i * K.size1 + i] = ((double)1.0 / sqrt(K.data[i * K.size1 + i]));
        #line 81 "iiwa_dnn/qp/dense.py"
        for (int64_t k = (i + 1), end_k = size; k < end_k; k++) {
            #line 82 "iiwa_dnn/qp/dense.py"
            K.data[i * K.size1 + k] *= K.data[i * K.size1 + i];
        }
    }
    #line 83 "iiwa_dnn/qp/dense.py"
    return true;
}

/* Solve with the factor that `cholesky_factor` left in K (n, n), into the first n of `out`.
 *
 * iiwa_dnn/qp/dense.py: factor_solve */
static void qp_dense_factor_solve(struct arena *arena, Matrix K, Vector rhs, Vector out)
{
    (void)arena;
    int64_t size;
    int64_t row;
    #line 88 "iiwa_dnn/qp/dense.py"
    #line 89 "iiwa_dnn/qp/dense.py"
    size = K.size0;
    #line 90 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0, end_i = size; i < end_i; i++) {
        #line 91 "iiwa_dnn/qp/dense.py"
        out.data[i] = rhs.data[i];
    }
    #line 92 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0, end_i = size; i < end_i; i++) {
        #line 93 "iiwa_dnn/qp/dense.py"
        out.data[i] *= K.data[i * K.size1 + i];
        #line 94 "iiwa_dnn/qp/dense.py"
        for (int64_t k = (i + 1), end_k = size; k < end_k; k++) {
            #line 95 "iiwa_dnn/qp/dense.py"
            out.data[k] -= (out.data[i] * K.data[i * K.size1 + k]);
        }
    }
    #line 96 "iiwa_dnn/qp/dense.py"
    for (int64_t back = 0, end_back = size; back < end_back; back++) {
        #line 97 "iiwa_dnn/qp/dense.py"
        row = ((size - 1) - back);
        #line 98 "iiwa_dnn/qp/dense.py"
        for (int64_t k = (row + 1), end_k = size; k < end_k; k++) {
            #line 99 "iiwa_dnn/qp/dense.py"
            out.data[row] -= (K.data[row * K.size1 + k] * out.data[k]);
        }
        #line 100 "iiwa_dnn/qp/dense.py"
        out.data[row] *= K.data[row * K.size1 + row];
    }
    return;
}

/* Copy all values (k,) into the first entries of `out`.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: copy_into */
static void integrators_implicit_steps_copy_into(struct arena *arena, Vector out, Vector values)
{
    (void)arena;
    #line 122 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 123 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0, end_k = (values.size0); k < end_k; k++) {
        #line 124 "iiwa_dnn/networks/integrators/implicit_steps.py"
        out.data[k] = values.data[k];
    }
    return;
}

/* Solve new = s + step F(new) for `new` (3n + m + p,), the iteration starting at s.
 *
 * The iteration stops after its first round if the gradient is at most `tol` or lost in rounding,
 * and after `max_newton` rounds.
 *
 * Returns:
 *     Newton iterations, or -1 if a matrix was not positive definite to working precision.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: backward_euler */
static int64_t integrators_implicit_steps_backward_euler(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, double tol, int64_t max_newton, const implicit_steps_Condensed *matrix)
{
    int64_t n;
    Vector descent;
    Vector direction;
    Vector slacks;
    double largest;
    double floor;
    int64_t taken;
    double size;
    double length;
    const struct arena mark = *arena;
    #line 137 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 145 "iiwa_dnn/networks/integrators/implicit_steps.py"
    n = ((*qp).q.size0);
    #line 146 "iiwa_dnn/networks/integrators/implicit_steps.py"
    descent = ((Vector){arena_empty(arena, n), n});
    #line 147 "iiwa_dnn/networks/integrators/implicit_steps.py"
    direction = ((Vector){arena_empty(arena, n), n});
    #line 148 "iiwa_dnn/networks/integrators/implicit_steps.py"
    slacks = ((Vector){arena_empty(arena, ((*matrix).values.size0)), ((*matrix).values.size0)});
    #line 149 "iiwa_dnn/networks/integrators/implicit_steps.py"
    integrators_implicit_steps_copy_into(arena, new, s);
    #line 151 "iiwa_dnn/networks/integrators/implicit_steps.py"
    largest = 1.0;
    #line 152 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 153 "iiwa_dnn/networks/integrators/implicit_steps.py"
        largest = double_max(largest, fabs(new.data[i]));
    }
    #line 154 "iiwa_dnn/networks/integrators/implicit_steps.py"
    floor = ((1e-15 * step) * largest);
    #line 155 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_write_slacks(arena, &(*qp), new, slacks);
    #line 156 "iiwa_dnn/networks/integrators/implicit_steps.py"
    taken = 0;
    #line 157 "iiwa_dnn/networks/integrators/implicit_steps.py"
    while (taken < max_newton) {
        #line 158 "iiwa_dnn/networks/integrators/implicit_steps.py"
        integrators_implicit_steps_multipliers(arena, &(*qp), s, step, slacks, new, (*matrix).active);
        #line 159 "iiwa_dnn/networks/integrators/implicit_steps.py"
        size = integrators_implicit_steps_descent(arena, &(*qp), s, step, new, descent);
        #line 160 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if ((taken > 0) && (!(size > double_max(tol, floor)))) {
            #line 161 "iiwa_dnn/networks/integrators/implicit_steps.py"
            break;
        }
        #line 162 "iiwa_dnn/networks/integrators/implicit_steps.py"
        integrators_implicit_steps_build_condensed(arena, &(*qp), step, &(*matrix));
        #line 163 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (!qp_dense_cholesky_factor(arena, (*matrix).K)) {
            #line 164 "iiwa_dnn/networks/integrators/implicit_steps.py"
            const int64_t own_result = (-1);
            arena_leave(arena, &mark);
            return own_result;
        }
        #line 165 "iiwa_dnn/networks/integrators/implicit_steps.py"
        taken += 1;
        #line 166 "iiwa_dnn/networks/integrators/implicit_steps.py"
        qp_dense_factor_solve(arena, (*matrix).K, descent, direction);
        #line 167 "iiwa_dnn/networks/integrators/implicit_steps.py"
        networks_projection_rows_times(arena, &(*qp), direction, (*matrix).values);
        #line 168 "iiwa_dnn/networks/integrators/implicit_steps.py"
        length = integrators_implicit_steps_line_search(arena, &(*qp), s, step, slacks, (*matrix).values, direction, descent);
        #line 169 "iiwa_dnn/networks/integrators/implicit_steps.py"
        for (int64_t i = 0, end_i = n; i < end_i; i++) {
            #line 170 "iiwa_dnn/networks/integrators/implicit_steps.py"
            new.data[i] += (length * direction.data[i]);
        }
        #line 171 "iiwa_dnn/networks/integrators/implicit_steps.py"
        for (int64_t k = 0, end_k = (slacks.size0); k < end_k; k++) {
            #line 172 "iiwa_dnn/networks/integrators/implicit_steps.py"
            slacks.data[k] += (length * (*matrix).values.data[k]);
        }
    }
    #line 174 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_write_slacks(arena, &(*qp), new, slacks);
    #line 175 "iiwa_dnn/networks/integrators/implicit_steps.py"
    integrators_implicit_steps_multipliers(arena, &(*qp), s, step, slacks, new, (*matrix).active);
    #line 176 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const int64_t own_result = taken;
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the multipliers after a step to x with these slacks, and mark those that are active.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _multipliers */
static void integrators_implicit_steps_multipliers(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector new, Vector active)
{
    (void)arena;
    int64_t n;
    int64_t p;
    double keep;
    double moving;
    double kept;
    bool is_active;
    #line 183 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 184 "iiwa_dnn/networks/integrators/implicit_steps.py"
    n = ((*qp).q.size0);
    #line 185 "iiwa_dnn/networks/integrators/implicit_steps.py"
    p = ((*qp).b.size0);
    #line 186 "iiwa_dnn/networks/integrators/implicit_steps.py"
    keep = ((double)1.0 / (1.0 + step));
    #line 187 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = 0, end_k = (active.size0); k < end_k; k++) {
        #line 188 "iiwa_dnn/networks/integrators/implicit_steps.py"
        moving = (s.data[(n + k)] + (step * slacks.data[k]));
        #line 189 "iiwa_dnn/networks/integrators/implicit_steps.py"
        kept = (s.data[(n + k)] * keep);
        #line 190 "iiwa_dnn/networks/integrators/implicit_steps.py"
        is_active = ((k < p) || (moving > kept));
        #line 191 "iiwa_dnn/networks/integrators/implicit_steps.py"
        active.data[k] = ((is_active) ? 1.0 : 0.0);
        #line 192 "iiwa_dnn/networks/integrators/implicit_steps.py"
        new.data[(n + k)] = ((is_active) ? moving : kept);
    }
    return;
}

/* Write minus the gradient of the step's convex function; returns its largest entry.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _descent */
static double integrators_implicit_steps_descent(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, Vector descent)
{
    double size;
    #line 197 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 198 "iiwa_dnn/networks/integrators/implicit_steps.py"
    size = 0.0;
    #line 199 "iiwa_dnn/networks/integrators/implicit_steps.py"
    qp_dense_times(arena, (*qp).P, new, descent);
    #line 200 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
        #line 201 "iiwa_dnn/networks/integrators/implicit_steps.py"
        descent.data[i] = (-(descent.data[i] + ((*qp).q.data[i] + ((double)(new.data[i] - s.data[i]) / step))));
    }
    #line 202 "iiwa_dnn/networks/integrators/implicit_steps.py"
    networks_projection_add_transposed(arena, &(*qp), (-1.0), new, descent);
    #line 203 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
        #line 204 "iiwa_dnn/networks/integrators/implicit_steps.py"
        size = qp_layout_larger(arena, size, fabs(descent.data[i]));
    }
    #line 205 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return size;
}

/* Minimize the step's convex function along the Newton `direction`, to `SLOPE`.
 *
 * Its derivative is continuous, increasing and piecewise linear, so a Newton iteration kept
 * inside a bracket ends at the root. `change` is [A; G; I; -I] direction.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _line_search */
static double integrators_implicit_steps_line_search(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector change, Vector direction, Vector descent)
{
    int64_t n;
    int64_t p;
    double start;
    double shortest;
    double slope;
    double second;
    double constant;
    double curvature;
    double low;
    double high;
    double length;
    #line 218 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 223 "iiwa_dnn/networks/integrators/implicit_steps.py"
    n = ((*qp).q.size0);
    #line 224 "iiwa_dnn/networks/integrators/implicit_steps.py"
    p = ((*qp).b.size0);
    #line 225 "iiwa_dnn/networks/integrators/implicit_steps.py"
    start = 0.0;
    #line 226 "iiwa_dnn/networks/integrators/implicit_steps.py"
    shortest = 0.0;
    #line 227 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 228 "iiwa_dnn/networks/integrators/implicit_steps.py"
        start -= (descent.data[i] * direction.data[i]);
        #line 229 "iiwa_dnn/networks/integrators/implicit_steps.py"
        shortest += (direction.data[i] * direction.data[i]);
    }
    #line 231 "iiwa_dnn/networks/integrators/implicit_steps.py"
    const double_2 own_17 = integrators_implicit_steps_slope(arena, n, p, s, step, slacks, change, 0.0);
    slope = own_17.at[0];
    second = own_17.at[1];
    #line 232 "iiwa_dnn/networks/integrators/implicit_steps.py"
    constant = (start - slope);
    #line 233 "iiwa_dnn/networks/integrators/implicit_steps.py"
    curvature = double_max(((-start) - second), ((double)shortest / step));
    #line 234 "iiwa_dnn/networks/integrators/implicit_steps.py"
    low = 0.0;
    #line 235 "iiwa_dnn/networks/integrators/implicit_steps.py"
    high = INFINITY;
    #line 236 "iiwa_dnn/networks/integrators/implicit_steps.py"
    length = 1.0;
    #line 237 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t _ = 0, end__ = 50; _ < end__; _++) {
        #line 238 "iiwa_dnn/networks/integrators/implicit_steps.py"
        const double_2 own_32 = integrators_implicit_steps_slope(arena, n, p, s, step, slacks, change, length);
        slope = own_32.at[0];
        second = own_32.at[1];
        #line 239 "iiwa_dnn/networks/integrators/implicit_steps.py"
        slope = ((slope + constant) + (length * curvature));
        #line 240 "iiwa_dnn/networks/integrators/implicit_steps.py"
        second += curvature;
        #line 241 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (fabs(slope) <= (0.3 * fabs(start))) {
            #line 242 "iiwa_dnn/networks/integrators/implicit_steps.py"
            break;
        }
        #line 243 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (slope > 0.0) {
            #line 244 "iiwa_dnn/networks/integrators/implicit_steps.py"
            high = length;
        }
        else {
            #line 246 "iiwa_dnn/networks/integrators/implicit_steps.py"
            low = length;
        }
        #line 247 "iiwa_dnn/networks/integrators/implicit_steps.py"
        length -= ((double)slope / second);
        #line 248 "iiwa_dnn/networks/integrators/implicit_steps.py"
        if (!(low < length && length < high)) {
            #line 249 "iiwa_dnn/networks/integrators/implicit_steps.py"
            length = ((high < INFINITY) ? (0.5 * (low + high)) : (2.0 * low));
        }
    }
    #line 250 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return length;
}

/* Sum slope and curvature of the inequalities' part of the step's function at a length.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _slope */
static double_2 integrators_implicit_steps_slope(struct arena *arena, int64_t n, int64_t p, Vector s, double step, Vector slacks, Vector change, double length)
{
    (void)arena;
    double keep;
    double slope;
    double second;
    double rate;
    double moving;
    double kept;
    bool is_active;
    #line 257 "iiwa_dnn/networks/integrators/implicit_steps.py"
    #line 258 "iiwa_dnn/networks/integrators/implicit_steps.py"
    keep = ((double)1.0 / (1.0 + step));
    #line 259 "iiwa_dnn/networks/integrators/implicit_steps.py"
    slope = 0.0;
    #line 260 "iiwa_dnn/networks/integrators/implicit_steps.py"
    second = 0.0;
    #line 261 "iiwa_dnn/networks/integrators/implicit_steps.py"
    for (int64_t k = p, end_k = (slacks.size0); k < end_k; k++) {
        #line 262 "iiwa_dnn/networks/integrators/implicit_steps.py"
        rate = change.data[k];
        #line 263 "iiwa_dnn/networks/integrators/implicit_steps.py"
        moving = (s.data[(n + k)] + (step * (slacks.data[k] + (length * rate))));
        #line 264 "iiwa_dnn/networks/integrators/implicit_steps.py"
        kept = (s.data[(n + k)] * keep);
        #line 265 "iiwa_dnn/networks/integrators/implicit_steps.py"
        is_active = (moving > kept);
        #line 266 "iiwa_dnn/networks/integrators/implicit_steps.py"
        slope += (((is_active) ? moving : kept) * rate);
        #line 267 "iiwa_dnn/networks/integrators/implicit_steps.py"
        second += ((is_active) ? ((step * rate) * rate) : 0.0);
    }
    #line 268 "iiwa_dnn/networks/integrators/implicit_steps.py"
    return ((double_2){{slope, second}});
}

/* Compute the largest factor of what a program asks for that its limits allow.
 *
 * Args:
 *     qp: The step's program, of n variables, m inequality and p equality rows.
 *     yielding: Which rows are the task's, and how the network settles.
 *     state: State of the network that solves it, (3 n + 3 + m + p,), advanced.
 *     point: Point of the program with the factor as the last variable, (2 n + 2 + m + p,),
 *         overwritten.
 *     figures: Figures of the step's answer, (5,), as of `settled`.
 *     retreats: Whether the factor is that of the negative right-hand sides h, without the task;
 *         else it is the scaling factor of the task.
 *
 * Returns:
 *     1, or `ALMOST` the factor in [0, 1]; -1 if not even 0 is feasible, or the network does not
 *     settle.
 *
 * iiwa_dnn/control/relaxed.py: largest_factor */
static double control_relaxed_largest_factor(struct arena *arena, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector point, Vector figures, bool retreats)
{
    int64_t n;
    Vector data;
    layout_QPViews wider;
    double longest;
    double factor;
    const struct arena mark = *arena;
    #line 177 "iiwa_dnn/control/relaxed.py"
    #line 193 "iiwa_dnn/control/relaxed.py"
    n = ((*qp).q.size0);
    #line 194 "iiwa_dnn/control/relaxed.py"
    data = ((Vector){arena_zeros(arena, control_relaxed_data_size(arena, (n + 1), ((*qp).h.size0), ((*qp).b.size0))), control_relaxed_data_size(arena, (n + 1), ((*qp).h.size0), ((*qp).b.size0))});
    #line 195 "iiwa_dnn/control/relaxed.py"
    wider = qp_layout_qp_views(arena, data, (n + 1), ((*qp).h.size0), ((*qp).b.size0));
    #line 196 "iiwa_dnn/control/relaxed.py"
    control_relaxed_copy_cost(arena, &(*qp), &wider);
    #line 197 "iiwa_dnn/control/relaxed.py"
    control_relaxed_copy_limits(arena, &(*qp), &wider);
    #line 198 "iiwa_dnn/control/relaxed.py"
    longest = control_relaxed_largest_entry(arena, (*qp).b);
    #line 199 "iiwa_dnn/control/relaxed.py"
    if ((retreats) || (longest == 0.0)) {
        #line 200 "iiwa_dnn/control/relaxed.py"
        longest = 1.0;
    }
    #line 201 "iiwa_dnn/control/relaxed.py"
    wider.q.data[n] = (-1.0);
    #line 202 "iiwa_dnn/control/relaxed.py"
    wider.ub.data[n] = longest;
    #line 203 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 204 "iiwa_dnn/control/relaxed.py"
        if ((retreats) && ((*qp).h.data[j] < 0.0)) {
            #line 205 "iiwa_dnn/control/relaxed.py"
            wider.G.data[j * wider.G.size1 + n] = (-(*qp).h.data[j]);
            #line 206 "iiwa_dnn/control/relaxed.py"
            wider.h.data[j] = 0.0;
        }
    }
    #line 207 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        #line 208 "iiwa_dnn/control/relaxed.py"
        if ((*yielding).weights.data[j] == 0.0) {
            #line 209 "iiwa_dnn/control/relaxed.py"
            control_relaxed_copied(arena, ((Vector){wider.A.data + j * wider.A.size1, wider.A.size1}), ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1}));
            #line 210 "iiwa_dnn/control/relaxed.py"
            wider.b.data[j] = (*qp).b.data[j];
        }
        else {
            #line 211 "iiwa_dnn/control/relaxed.py"
            if (!retreats) {
                #line 212 "iiwa_dnn/control/relaxed.py"
                control_relaxed_copied(arena, ((Vector){wider.A.data + j * wider.A.size1, wider.A.size1}), ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1}));
                #line 213 "iiwa_dnn/control/relaxed.py"
                wider.A.data[j * wider.A.size1 + n] = ((double)(-(*qp).b.data[j]) / longest);
            }
        }
    }
    #line 214 "iiwa_dnn/control/relaxed.py"
    if (!control_relaxed_settled(arena, &wider, &(*yielding), state, point, figures, 10.0)) {
        #line 215 "iiwa_dnn/control/relaxed.py"
        const double own_result = (-1.0);
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 216 "iiwa_dnn/control/relaxed.py"
    factor = double_max(((double)point.data[n] / longest), 0.0);
    #line 217 "iiwa_dnn/control/relaxed.py"
    const double own_result = ((factor >= 0.999999999) ? 1.0 : (0.999 * factor));
    arena_leave(arena, &mark);
    return own_result;
}

/* Count the numbers of a program, `QP.data`.
 *
 * iiwa_dnn/control/relaxed.py: data_size */
static int64_t control_relaxed_data_size(struct arena *arena, int64_t n, int64_t m, int64_t p)
{
    (void)arena;
    #line 244 "iiwa_dnn/control/relaxed.py"
    #line 245 "iiwa_dnn/control/relaxed.py"
    return ((((n + m) + p) * (n + 1)) + (2 * n));
}

/* Make the views of a program's flat array, `QP.data` (size,), which has to outlive them.
 *
 * iiwa_dnn/qp/layout.py: qp_views */
static inline layout_QPViews qp_layout_qp_views(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p)
{
    int64_t at_q;
    int64_t at_G;
    int64_t at_A;
    int64_t at_lb;
    int64_t at_h;
    int64_t at_b;
    #line 79 "iiwa_dnn/qp/layout.py"
    #line 80 "iiwa_dnn/qp/layout.py"
    const int_4 own_2 = qp_layout_offsets(arena, n, m, p);
    at_q = own_2.at[0];
    at_G = own_2.at[1];
    at_A = own_2.at[2];
    at_lb = own_2.at[3];
    #line 81 "iiwa_dnn/qp/layout.py"
    at_h = (at_G + (m * n));
    #line 82 "iiwa_dnn/qp/layout.py"
    at_b = (at_A + (p * n));
    #line 83 "iiwa_dnn/qp/layout.py"
    return ((layout_QPViews){((Matrix){((Vector){data.data, at_q - 0}).data, n, n}), ((Vector){data.data + at_q, at_G - at_q}), ((Matrix){((Vector){data.data + at_G, at_h - at_G}).data, m, n}), ((Vector){data.data + at_h, at_A - at_h}), ((Matrix){((Vector){data.data + at_A, at_b - at_A}).data, p, n}), ((Vector){data.data + at_b, at_lb - at_b}), ((Vector){data.data + at_lb, (at_lb + n) - at_lb}), ((Vector){data.data + (at_lb + n), (at_lb + (2 * n)) - (at_lb + n)})});
}

/* Compute ``(at_q, at_G, at_A, at_lb)``, the beginnings of the parts of `QP.data`.
 *
 * iiwa_dnn/qp/layout.py: offsets */
static int_4 qp_layout_offsets(struct arena *arena, int64_t n, int64_t m, int64_t p)
{
    (void)arena;
    int64_t at_q;
    int64_t at_G;
    int64_t at_A;
    #line 39 "iiwa_dnn/qp/layout.py"
    #line 40 "iiwa_dnn/qp/layout.py"
    at_q = (n * n);
    #line 41 "iiwa_dnn/qp/layout.py"
    at_G = (at_q + n);
    #line 42 "iiwa_dnn/qp/layout.py"
    at_A = ((at_G + (m * n)) + m);
    #line 43 "iiwa_dnn/qp/layout.py"
    return ((int_4){{at_q, at_G, at_A, ((at_A + (p * n)) + p)}});
}

/* Write w times the cost into a program that has more variables.
 *
 * iiwa_dnn/control/relaxed.py: _copy_cost */
static void control_relaxed_copy_cost(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other)
{
    int64_t n;
    double largest;
    double weight;
    #line 222 "iiwa_dnn/control/relaxed.py"
    #line 223 "iiwa_dnn/control/relaxed.py"
    n = ((*qp).q.size0);
    #line 224 "iiwa_dnn/control/relaxed.py"
    largest = double_max(control_relaxed_largest_entry(arena, (*qp).q), control_relaxed_largest_entry(arena, ((Vector){(*qp).P.data, (n * n)})));
    #line 225 "iiwa_dnn/control/relaxed.py"
    weight = ((double)1e-05 / double_max(largest, 1e-300));
    #line 226 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 227 "iiwa_dnn/control/relaxed.py"
        (*other).q.data[i] = (weight * (*qp).q.data[i]);
        #line 228 "iiwa_dnn/control/relaxed.py"
        for (int64_t k = 0, end_k = n; k < end_k; k++) {
            #line 229 "iiwa_dnn/control/relaxed.py"
            (*other).P.data[i * (*other).P.size1 + k] = (weight * (*qp).P.data[i * (*qp).P.size1 + k]);
        }
    }
    return;
}

/* Write bounds and inequality rows into a program that may have more variables.
 *
 * iiwa_dnn/control/relaxed.py: _copy_limits */
static void control_relaxed_copy_limits(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other)
{
    #line 234 "iiwa_dnn/control/relaxed.py"
    #line 235 "iiwa_dnn/control/relaxed.py"
    control_relaxed_copied(arena, (*other).lb, (*qp).lb);
    #line 236 "iiwa_dnn/control/relaxed.py"
    control_relaxed_copied(arena, (*other).ub, (*qp).ub);
    #line 237 "iiwa_dnn/control/relaxed.py"
    control_relaxed_copied(arena, (*other).h, (*qp).h);
    #line 238 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 239 "iiwa_dnn/control/relaxed.py"
        control_relaxed_copied(arena, ((Vector){(*other).G.data + j * (*other).G.size1, (*other).G.size1}), ((Vector){(*qp).G.data + j * (*qp).G.size1, (*qp).G.size1}));
    }
    return;
}

/* Turn a step's program, with task rows of some weights (p,), into the scaled one.
 *
 * iiwa_dnn/control/relaxed.py: scale_task */
static void control_relaxed_scale_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double factor)
{
    (void)arena;
    #line 250 "iiwa_dnn/control/relaxed.py"
    #line 251 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        #line 252 "iiwa_dnn/control/relaxed.py"
        if (weights.data[j] > 0.0) {
            #line 253 "iiwa_dnn/control/relaxed.py"
            (*qp).b.data[j] *= factor;
        }
    }
    return;
}

/* Turn a step's program, with weights (p,) of its rows, into the softened one.
 *
 * Its tau is `retreat`.
 *
 * iiwa_dnn/control/relaxed.py: soften_task */
static void control_relaxed_soften_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double retreat)
{
    int64_t n;
    double shrink;
    double drift;
    #line 258 "iiwa_dnn/control/relaxed.py"
    #line 262 "iiwa_dnn/control/relaxed.py"
    n = ((*qp).q.size0);
    #line 263 "iiwa_dnn/control/relaxed.py"
    shrink = ((double)10.0 / double_max(10.0, control_relaxed_largest_entry(arena, (*qp).b)));
    #line 264 "iiwa_dnn/control/relaxed.py"
    drift = ((double)0.02 / double_max(control_relaxed_largest_entry(arena, (*qp).q), 1.0));
    #line 265 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 266 "iiwa_dnn/control/relaxed.py"
        (*qp).q.data[i] *= ((0.05 * 0.05) * drift);
        #line 267 "iiwa_dnn/control/relaxed.py"
        for (int64_t k = 0, end_k = n; k < end_k; k++) {
            #line 268 "iiwa_dnn/control/relaxed.py"
            (*qp).P.data[i * (*qp).P.size1 + k] *= 0.0001;
        }
        #line 269 "iiwa_dnn/control/relaxed.py"
        (*qp).P.data[i * (*qp).P.size1 + i] += (0.05 * 0.05);
    }
    #line 270 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        #line 271 "iiwa_dnn/control/relaxed.py"
        if (weights.data[j] > 0.0) {
            #line 272 "iiwa_dnn/control/relaxed.py"
            control_relaxed_move_into_cost(arena, &(*qp), j, (weights.data[j] * weights.data[j]), shrink);
        }
    }
    #line 273 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 274 "iiwa_dnn/control/relaxed.py"
        if ((*qp).h.data[j] < 0.0) {
            #line 275 "iiwa_dnn/control/relaxed.py"
            (*qp).h.data[j] *= retreat;
        }
    }
    return;
}

/* Move equality row j into the cost, with the square of its weight; its b is shrunk.
 *
 * iiwa_dnn/control/relaxed.py: _move_into_cost */
static void control_relaxed_move_into_cost(struct arena *arena, const layout_QPViews *qp, int64_t j, double square, double shrink)
{
    (void)arena;
    int64_t n;
    double rhs;
    #line 280 "iiwa_dnn/control/relaxed.py"
    #line 281 "iiwa_dnn/control/relaxed.py"
    n = ((*qp).q.size0);
    #line 282 "iiwa_dnn/control/relaxed.py"
    rhs = ((square * shrink) * (*qp).b.data[j]);
    #line 283 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 284 "iiwa_dnn/control/relaxed.py"
        (*qp).q.data[i] -= (rhs * (*qp).A.data[j * (*qp).A.size1 + i]);
        #line 285 "iiwa_dnn/control/relaxed.py"
        for (int64_t k = 0, end_k = n; k < end_k; k++) {
            #line 286 "iiwa_dnn/control/relaxed.py"
            (*qp).P.data[i * (*qp).P.size1 + k] += ((square * (*qp).A.data[j * (*qp).A.size1 + i]) * (*qp).A.data[j * (*qp).A.size1 + k]);
        }
    }
    #line 287 "iiwa_dnn/control/relaxed.py"
    for (int64_t own_k = 0, own_end = ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1 - 0}).data[own_k] = 0.0;
    #line 288 "iiwa_dnn/control/relaxed.py"
    (*qp).b.data[j] = 0.0;
    return;
}

/* Note which bounds and rows stand in the way of a program.
 *
 * Args:
 *     point: Its solution, ``[x | y | z | z_box]`` with `extra` more variables than n.
 *     n: Number of the step's variables.
 *     m: Number of inequality rows.
 *     extra: Number of further variables.
 *     blocking: For each variable the sign of its bound's multiplier, and for each row 1 where its
 *         multiplier counts, (n + m,), overwritten.
 *
 * iiwa_dnn/control/relaxed.py: note_blocking */
static void control_relaxed_note_blocking(struct arena *arena, Vector point, int64_t n, int64_t m, int64_t extra, Vector blocking)
{
    int64_t start;
    Vector multipliers;
    double least;
    double value;
    #line 293 "iiwa_dnn/control/relaxed.py"
    #line 303 "iiwa_dnn/control/relaxed.py"
    start = ((((point.size0) - n) - extra) - m);
    #line 304 "iiwa_dnn/control/relaxed.py"
    multipliers = ((Vector){point.data + start, ((start + m) + n) - start});
    #line 305 "iiwa_dnn/control/relaxed.py"
    least = (0.0001 * control_relaxed_largest_entry(arena, multipliers));
    #line 306 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = (n + m); i < end_i; i++) {
        #line 307 "iiwa_dnn/control/relaxed.py"
        value = multipliers.data[((i < n) ? (m + i) : (i - n))];
        #line 308 "iiwa_dnn/control/relaxed.py"
        blocking.data[i] = 0.0;
        #line 309 "iiwa_dnn/control/relaxed.py"
        if (fabs(value) > least) {
            #line 310 "iiwa_dnn/control/relaxed.py"
            blocking.data[i] = copysign(1.0, value);
        }
    }
    return;
}

/* Move x (n,) into the bounds of a program, and on to the nearest point within its rows too.
 *
 * The figures (5,) are those of `settled`.
 *
 * Returns:
 *     False if the inequality rows contradict the bounds: x is then within the bounds.
 *
 * iiwa_dnn/control/relaxed.py: nearest_within */
static bool control_relaxed_nearest_within(struct arena *arena, const layout_QPViews *qp, Vector x, const relaxed_Yielding *yielding, Vector figures)
{
    int64_t n;
    int64_t m;
    int64_t outside;
    Vector data;
    layout_QPViews nearest;
    Vector point;
    bool found;
    const struct arena mark = *arena;
    #line 315 "iiwa_dnn/control/relaxed.py"
    #line 322 "iiwa_dnn/control/relaxed.py"
    n = (x.size0);
    #line 323 "iiwa_dnn/control/relaxed.py"
    m = ((*qp).h.size0);
    #line 324 "iiwa_dnn/control/relaxed.py"
    outside = 0;
    #line 325 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 326 "iiwa_dnn/control/relaxed.py"
        x.data[i] = double_min(double_max(x.data[i], (*qp).lb.data[i]), (*qp).ub.data[i]);
    }
    #line 327 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = m; j < end_j; j++) {
        #line 328 "iiwa_dnn/control/relaxed.py"
        outside += (qp_dense_row_dot(arena, (*qp).G, j, x) > (*qp).h.data[j]);
    }
    #line 329 "iiwa_dnn/control/relaxed.py"
    if (outside == 0) {
        #line 330 "iiwa_dnn/control/relaxed.py"
        const bool own_result = true;
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 331 "iiwa_dnn/control/relaxed.py"
    data = ((Vector){arena_zeros(arena, control_relaxed_data_size(arena, n, m, 0)), control_relaxed_data_size(arena, n, m, 0)});
    #line 332 "iiwa_dnn/control/relaxed.py"
    nearest = qp_layout_qp_views(arena, data, n, m, 0);
    #line 333 "iiwa_dnn/control/relaxed.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 334 "iiwa_dnn/control/relaxed.py"
        nearest.P.data[i * nearest.P.size1 + i] = 1.0;
        #line 335 "iiwa_dnn/control/relaxed.py"
        nearest.q.data[i] = (-x.data[i]);
    }
    #line 336 "iiwa_dnn/control/relaxed.py"
    control_relaxed_copy_limits(arena, &(*qp), &nearest);
    #line 337 "iiwa_dnn/control/relaxed.py"
    point = ((Vector){arena_empty(arena, ((2 * n) + m)), ((2 * n) + m)});
    #line 338 "iiwa_dnn/control/relaxed.py"
    found = control_relaxed_settled(arena, &nearest, &(*yielding), ((Vector){arena_zeros(arena, ((3 * n) + m)), ((3 * n) + m)}), point, figures, 1.0);
    #line 339 "iiwa_dnn/control/relaxed.py"
    if (found) {
        #line 340 "iiwa_dnn/control/relaxed.py"
        control_relaxed_copied(arena, x, ((Vector){point.data, n - 0}));
    }
    #line 341 "iiwa_dnn/control/relaxed.py"
    const bool own_result = found;
    arena_leave(arena, &mark);
    return own_result;
}

/* Compute the share of a task velocity b (p,) that joint velocities x (n,) give, at most 1.
 *
 * iiwa_dnn/control/relaxed.py: attained */
static double control_relaxed_attained(struct arena *arena, Vector b, Matrix A, Vector weights, Vector x)
{
    double asked;
    double given;
    double rhs;
    #line 346 "iiwa_dnn/control/relaxed.py"
    #line 347 "iiwa_dnn/control/relaxed.py"
    asked = 0.0;
    #line 348 "iiwa_dnn/control/relaxed.py"
    given = 0.0;
    #line 349 "iiwa_dnn/control/relaxed.py"
    for (int64_t j = 0, end_j = (b.size0); j < end_j; j++) {
        #line 350 "iiwa_dnn/control/relaxed.py"
        rhs = ((weights.data[j] * weights.data[j]) * b.data[j]);
        #line 351 "iiwa_dnn/control/relaxed.py"
        asked += (rhs * b.data[j]);
        #line 352 "iiwa_dnn/control/relaxed.py"
        given += (rhs * qp_dense_row_dot(arena, A, j, x));
    }
    #line 353 "iiwa_dnn/control/relaxed.py"
    return ((asked > 0.0) ? double_min(((double)given / asked), 1.0) : 1.0);
}

/* Write A = I and b = w; the first numbers of the target (18,) are the velocity w (n,).
 *
 * iiwa_dnn/control/shield.py: wished_velocity */
static void control_shield_wished_velocity(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    (void)arena;
    (void)step;
    (void)constants;
    #line 82 "iiwa_dnn/control/shield.py"
    #line 83 "iiwa_dnn/control/shield.py"
    for (int64_t i = 0, end_i = (b.size0); i < end_i; i++) {
        #line 84 "iiwa_dnn/control/shield.py"
        A.data[i * A.size1 + i] = 1.0;
        #line 85 "iiwa_dnn/control/shield.py"
        b.data[i] = target.data[i];
    }
    return;
}

/* Take measured positions q (n,) [rad] over at the first step, or if they are far.
 *
 * The settings (3,) are control period [s], timeout [s] and tracking error [rad].
 *
 * iiwa_dnn/control/shield.py: take_positions */
static void control_shield_take_positions(struct arena *arena, Vector q, const shield_ShieldState *state, Vector settings)
{
    int64_t far;
    #line 119 "iiwa_dnn/control/shield.py"
    #line 123 "iiwa_dnn/control/shield.py"
    far = 0;
    #line 124 "iiwa_dnn/control/shield.py"
    for (int64_t i = 0, end_i = (q.size0); i < end_i; i++) {
        #line 125 "iiwa_dnn/control/shield.py"
        far += (!(fabs((q.data[i] - (*state).positions.data[i])) <= settings.data[2]));
    }
    #line 126 "iiwa_dnn/control/shield.py"
    (*state).flags.data[3] = 0.0;
    #line 127 "iiwa_dnn/control/shield.py"
    if ((far > 0) || ((*state).flags.data[2] == 0.0)) {
        #line 128 "iiwa_dnn/control/shield.py"
        (*state).flags.data[3] = (*state).flags.data[2];
        #line 129 "iiwa_dnn/control/shield.py"
        (*state).flags.data[2] = 1.0;
        #line 130 "iiwa_dnn/control/shield.py"
        control_relaxed_copied(arena, (*state).positions, q);
    }
    return;
}

/* Take a wish (k,) over if one is given, else the last one, or one to rest for a reason.
 *
 * The settings are those of `take_positions`.
 *
 * Returns:
 *     Whether the wish that counts is that of the last step.
 *
 * iiwa_dnn/control/shield.py: take_wish */
static bool control_shield_take_wish(struct arena *arena, Vector wish, bool given, const shield_ShieldState *state, Vector settings)
{
    Vector flags;
    int64_t other;
    double now;
    #line 135 "iiwa_dnn/control/shield.py"
    #line 142 "iiwa_dnn/control/shield.py"
    flags = (*state).flags;
    #line 143 "iiwa_dnn/control/shield.py"
    flags.data[0] += settings.data[0];
    #line 144 "iiwa_dnn/control/shield.py"
    if ((given) && (flags.data[1] != 4)) {
        #line 145 "iiwa_dnn/control/shield.py"
        flags.data[0] = 0.0;
        #line 146 "iiwa_dnn/control/shield.py"
        flags.data[1] = ((qp_dense_all_finite(arena, wish, 0, (wish.size0))) ? 0.0 : 3);
    }
    #line 147 "iiwa_dnn/control/shield.py"
    if ((flags.data[1] == 0.0) && (flags.data[0] > (settings.data[1] + (0.5 * settings.data[0])))) {
        #line 148 "iiwa_dnn/control/shield.py"
        flags.data[1] = 2;
    }
    #line 149 "iiwa_dnn/control/shield.py"
    other = 0;
    #line 150 "iiwa_dnn/control/shield.py"
    for (int64_t i = 0, end_i = (wish.size0); i < end_i; i++) {
        #line 151 "iiwa_dnn/control/shield.py"
        now = ((flags.data[1] == 0.0) ? wish.data[i] : 0.0);
        #line 152 "iiwa_dnn/control/shield.py"
        other += (now != (*state).wish.data[i]);
        #line 153 "iiwa_dnn/control/shield.py"
        (*state).wish.data[i] = now;
    }
    #line 154 "iiwa_dnn/control/shield.py"
    return (other == 0);
}

/* Check that data[start:end] of (k,) is finite: NaN and infinity times zero are NaN.
 *
 * iiwa_dnn/qp/dense.py: all_finite */
static bool qp_dense_all_finite(struct arena *arena, Vector data, int64_t start, int64_t end)
{
    (void)arena;
    double total;
    #line 162 "iiwa_dnn/qp/dense.py"
    #line 163 "iiwa_dnn/qp/dense.py"
    total = 0.0;
    #line 164 "iiwa_dnn/qp/dense.py"
    for (int64_t k = start, end_k = end; k < end_k; k++) {
        #line 165 "iiwa_dnn/qp/dense.py"
        total += (data.data[k] * 0.0);
    }
    #line 166 "iiwa_dnn/qp/dense.py"
    return (total == 0.0);
}

/* Write the next velocities dq (n,) [rad/s] on the quickest way to the wish that counts.
 *
 * Those on the way to positions are the quickest ones from which all joints can still rest there.
 * A joint that jerk limits keep from its velocity in this step, or that is asked for the same one
 * as in the last step, does not pass it.
 *
 * Args:
 *     state: The wish, and where the joints are.
 *     past: `ControllerState.past`, (8, n).
 *     limits: `MotionLimits.constants`, (6 n,).
 *     dt: Control period [s].
 *     reaches: Whether the wish is one for positions.
 *     held: Whether it is that of the last step.
 *     dq: The velocities, overwritten.
 *
 * iiwa_dnn/control/shield.py: approach */
static void control_shield_approach(struct arena *arena, const shield_ShieldState *state, Matrix past, Vector limits, double dt, bool reaches, bool held, Vector dq)
{
    int64_t n;
    double wish;
    double above;
    double below;
    double left;
    double_4 rates;
    double lower;
    double upper;
    #line 167 "iiwa_dnn/control/shield.py"
    #line 182 "iiwa_dnn/control/shield.py"
    n = (dq.size0);
    #line 183 "iiwa_dnn/control/shield.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 184 "iiwa_dnn/control/shield.py"
        wish = (*state).wish.data[i];
        #line 185 "iiwa_dnn/control/shield.py"
        above = (limits.data[(n + i)] - (*state).positions.data[i]);
        #line 186 "iiwa_dnn/control/shield.py"
        below = ((*state).positions.data[i] - limits.data[i]);
        #line 187 "iiwa_dnn/control/shield.py"
        if (reaches) {
            #line 188 "iiwa_dnn/control/shield.py"
            left = (wish - (*state).positions.data[i]);
            #line 189 "iiwa_dnn/control/shield.py"
            above = ((left >= 0.0) ? left : INFINITY);
            #line 190 "iiwa_dnn/control/shield.py"
            below = ((left < 0.0) ? (-left) : INFINITY);
            #line 191 "iiwa_dnn/control/shield.py"
            wish = ((double)left / dt);
        }
        #line 192 "iiwa_dnn/control/shield.py"
        wish = double_min(double_max(wish, (-1000.0)), 1000.0);
        #line 193 "iiwa_dnn/control/shield.py"
        rates = ((double_4){{limits.data[((2 * n) + i)], limits.data[((3 * n) + i)], limits.data[((4 * n) + i)], limits.data[((5 * n) + i)]}});
        #line 194 "iiwa_dnn/control/shield.py"
        const double_2 own_26 = schemes_limits_joint_bounds(arena, past.data[1 * past.size1 + i], past.data[2 * past.size1 + i], above, below, rates, dt);
        lower = own_26.at[0];
        upper = own_26.at[1];
        #line 195 "iiwa_dnn/control/shield.py"
        if (reaches) {
            #line 196 "iiwa_dnn/control/shield.py"
            wish = double_min(double_max(wish, lower), upper);
        }
        else {
            #line 197 "iiwa_dnn/control/shield.py"
            if ((held) || (wish < lower) || (wish > upper)) {
                #line 198 "iiwa_dnn/control/shield.py"
                wish += schemes_limits_braking(arena, (past.data[1 * past.size1 + i] - wish), (-INFINITY), INFINITY, limits.data[((4 * n) + i)], dt);
            }
        }
        #line 199 "iiwa_dnn/control/shield.py"
        dq.data[i] = wish;
    }
    return;
}

/* Compute lower and upper bound of one joint's next command [rad/s], never the wrong way round.
 *
 * Jerk and acceleration are within their limits at both, whatever the state is.
 *
 * Args:
 *     last: Last command [rad/s].
 *     before: Command before it [rad/s].
 *     above: Distance to the upper position limit [rad].
 *     below: Distance to the lower position limit [rad].
 *     rates: Its limits.
 *     dt: Control period [s].
 *
 * iiwa_dnn/schemes/limits.py: joint_bounds */
static double_2 schemes_limits_joint_bounds(struct arena *arena, double last, double before, double above, double below, double_4 rates, double dt)
{
    double accel;
    double jerk;
    double lower;
    double upper;
    double command;
    #line 334 "iiwa_dnn/schemes/limits.py"
    #line 346 "iiwa_dnn/schemes/limits.py"
    const double_4 own_2 = rates;
    accel = own_2.at[1];
    jerk = own_2.at[2];
    #line 347 "iiwa_dnn/schemes/limits.py"
    if (jerk < INFINITY) {
        #line 348 "iiwa_dnn/schemes/limits.py"
        const double_2 own_7 = schemes_limits_jerk_bounds(arena, last, before, above, below, rates, dt);
        lower = own_7.at[0];
        upper = own_7.at[1];
    }
    else {
        #line 349 "iiwa_dnn/schemes/limits.py"
        if (accel < INFINITY) {
            #line 350 "iiwa_dnn/schemes/limits.py"
            const double_2 own_14 = schemes_limits_acceleration_bounds(arena, last, above, below, rates, dt);
            lower = own_14.at[0];
            upper = own_14.at[1];
        }
        else {
            #line 352 "iiwa_dnn/schemes/limits.py"
            return ((double_2){{(-INFINITY), INFINITY}});
        }
    }
    #line 353 "iiwa_dnn/schemes/limits.py"
    if (lower <= upper) {
        #line 354 "iiwa_dnn/schemes/limits.py"
        return ((double_2){{lower, upper}});
    }
    #line 357 "iiwa_dnn/schemes/limits.py"
    command = (0.5 * (lower + upper));
    #line 358 "iiwa_dnn/schemes/limits.py"
    if (above < 0.0) {
        #line 359 "iiwa_dnn/schemes/limits.py"
        command = lower;
    }
    else {
        #line 360 "iiwa_dnn/schemes/limits.py"
        if (below < 0.0) {
            #line 361 "iiwa_dnn/schemes/limits.py"
            command = upper;
        }
    }
    #line 362 "iiwa_dnn/schemes/limits.py"
    return ((double_2){{command, command}});
}

/* Compute `joint_bounds` where the jerk is limited.
 *
 * iiwa_dnn/schemes/limits.py: _jerk_bounds */
static double_2 schemes_limits_jerk_bounds(struct arena *arena, double last, double before, double above, double below, double_4 rates, double dt)
{
    double fastest;
    double accel;
    double jerk;
    double deceleration;
    double middle;
    double change;
    double first;
    double final;
    double unit;
    double lb;
    double ub;
    double margin;
    double limit;
    double upper;
    double lower;
    double rest;
    double eased;
    #line 386 "iiwa_dnn/schemes/limits.py"
    #line 387 "iiwa_dnn/schemes/limits.py"
    const double_4 own_2 = rates;
    fastest = own_2.at[0];
    accel = own_2.at[1];
    jerk = own_2.at[2];
    deceleration = own_2.at[3];
    #line 389 "iiwa_dnn/schemes/limits.py"
    middle = ((2.0 * last) - before);
    #line 390 "iiwa_dnn/schemes/limits.py"
    change = ((jerk * dt) * dt);
    #line 391 "iiwa_dnn/schemes/limits.py"
    first = double_min(double_max((last - (accel * dt)), (middle - change)), (middle + change));
    #line 392 "iiwa_dnn/schemes/limits.py"
    final = double_min(double_max((last + (accel * dt)), (middle - change)), (middle + change));
    #line 393 "iiwa_dnn/schemes/limits.py"
    jerk = double_min(jerk, ((double)double_min(((double)deceleration / dt), ((double)fastest / (dt * dt))) / 8.0));
    #line 394 "iiwa_dnn/schemes/limits.py"
    unit = ((jerk * dt) * dt);
    #line 395 "iiwa_dnn/schemes/limits.py"
    lb = double_min(double_max((last - (unit * schemes_limits_approach(arena, ((double)(last + fastest) / unit)))), first), final);
    #line 396 "iiwa_dnn/schemes/limits.py"
    ub = double_min(double_max((last + (unit * schemes_limits_approach(arena, ((double)(fastest - last) / unit)))), first), final);
    #line 397 "iiwa_dnn/schemes/limits.py"
    if (lb > ub) {
        #line 398 "iiwa_dnn/schemes/limits.py"
        lb = (0.5 * (lb + ub));
        #line 399 "iiwa_dnn/schemes/limits.py"
        ub = lb;
    }
    #line 400 "iiwa_dnn/schemes/limits.py"
    margin = ((0.2 * unit) * dt);
    #line 401 "iiwa_dnn/schemes/limits.py"
    limit = (deceleration - (jerk * dt));
    #line 402 "iiwa_dnn/schemes/limits.py"
    upper = schemes_limits_ceiling(arena, lb, ub, (above - margin), last, dt, ((double_2){{jerk, limit}}));
    #line 403 "iiwa_dnn/schemes/limits.py"
    lower = (-schemes_limits_ceiling(arena, (-ub), (-lb), (below - margin), (-last), dt, ((double_2){{jerk, limit}})));
    #line 404 "iiwa_dnn/schemes/limits.py"
    if ((lower < upper) && (double_max(fabs(last), fabs((last - before))) < unit)) {
        #line 407 "iiwa_dnn/schemes/limits.py"
        rest = ((0.25 * unit) * dt);
        #line 408 "iiwa_dnn/schemes/limits.py"
        eased = double_max(double_min(upper, double_max(schemes_limits_easing(arena, (above - rest), dt), lb)), lower);
        #line 409 "iiwa_dnn/schemes/limits.py"
        lower = double_min(double_max(lower, double_min((-schemes_limits_easing(arena, (below - rest), dt)), ub)), eased);
        #line 410 "iiwa_dnn/schemes/limits.py"
        upper = eased;
    }
    #line 411 "iiwa_dnn/schemes/limits.py"
    return ((double_2){{lower, upper}});
}

/* Compute the largest x for which x + (x - 1) + (x - 2) + ... down to 0 is within `room`.
 *
 * iiwa_dnn/schemes/limits.py: approach */
static double schemes_limits_approach(struct arena *arena, double room)
{
    (void)arena;
    int64_t m;
    #line 434 "iiwa_dnn/schemes/limits.py"
    #line 435 "iiwa_dnn/schemes/limits.py"
    if ((!(room > 0.0)) || (room == INFINITY)) {
        #line 436 "iiwa_dnn/schemes/limits.py"
        return room;
    }
    #line 437 "iiwa_dnn/schemes/limits.py"
    m = (int64_t)floor((0.5 * (sqrt((1.0 + (8.0 * room))) - 1.0)));
    #line 438 "iiwa_dnn/schemes/limits.py"
    return (((double)room / (m + 1.0)) + (0.5 * m));
}

/* Compute the largest command in [lb, ub] whose highest position is within `distance`, else lb.
 *
 * The limits are those of jerk [rad/s^3] and acceleration [rad/s^2] on the way to rest.
 *
 * iiwa_dnn/schemes/limits.py: _ceiling */
static double schemes_limits_ceiling(struct arena *arena, double lb, double ub, double distance, double last, double dt, double_2 braking_limits)
{
    double J;
    double A;
    double middle;
    #line 482 "iiwa_dnn/schemes/limits.py"
    #line 486 "iiwa_dnn/schemes/limits.py"
    const double_2 own_2 = braking_limits;
    J = own_2.at[0];
    A = own_2.at[1];
    #line 487 "iiwa_dnn/schemes/limits.py"
    if (schemes_limits_highest(arena, ub, last, dt, J, A) <= distance) {
        #line 488 "iiwa_dnn/schemes/limits.py"
        return ub;
    }
    #line 489 "iiwa_dnn/schemes/limits.py"
    for (int64_t _ = 0, end__ = 20; _ < end__; _++) {
        #line 490 "iiwa_dnn/schemes/limits.py"
        middle = (0.5 * (lb + ub));
        #line 491 "iiwa_dnn/schemes/limits.py"
        if (schemes_limits_highest(arena, middle, last, dt, J, A) <= distance) {
            #line 492 "iiwa_dnn/schemes/limits.py"
            lb = middle;
        }
        else {
            #line 494 "iiwa_dnn/schemes/limits.py"
            ub = middle;
        }
    }
    #line 495 "iiwa_dnn/schemes/limits.py"
    return lb;
}

/* Compute the highest position of the way to rest after command v, from that before it.
 *
 * iiwa_dnn/schemes/limits.py: highest */
static double schemes_limits_highest(struct arena *arena, double v, double last, double dt, double J, double A)
{
    double a;
    double mean;
    double start;
    double T;
    #line 461 "iiwa_dnn/schemes/limits.py"
    #line 462 "iiwa_dnn/schemes/limits.py"
    a = ((double)(v - last) / dt);
    #line 463 "iiwa_dnn/schemes/limits.py"
    mean = (0.5 * (v + last));
    #line 464 "iiwa_dnn/schemes/limits.py"
    start = ((double)((dt * dt) * a) / 6.0);
    #line 465 "iiwa_dnn/schemes/limits.py"
    if ((mean + ((double)((0.5 * a) * fabs(a)) / J)) >= 0.0) {
        #line 466 "iiwa_dnn/schemes/limits.py"
        return (start + double_max(0.0, schemes_limits_stopping_distance(arena, mean, a, J, A)));
    }
    #line 467 "iiwa_dnn/schemes/limits.py"
    if (mean <= 0.0) {
        #line 468 "iiwa_dnn/schemes/limits.py"
        return start;
    }
    #line 469 "iiwa_dnn/schemes/limits.py"
    T = ((double)(-(a + sqrt(double_max(((a * a) - ((2.0 * J) * mean)), 0.0)))) / J);
    #line 470 "iiwa_dnn/schemes/limits.py"
    return (start + (T * (mean + (T * ((0.5 * a) + ((double)(J * T) / 6.0))))));
}

/* Compute the way of a spline from velocity v and acceleration a to rest.
 *
 * The joint does not turn round: v >= -a |a| / (2 J). It brakes at A, or at -a where that is more.
 *
 * iiwa_dnn/schemes/limits.py: stopping_distance */
static double schemes_limits_stopping_distance(struct arena *arena, double v, double a, double J, double A)
{
    (void)arena;
    double deepest;
    double square;
    double d;
    double T;
    double way;
    double h;
    #line 443 "iiwa_dnn/schemes/limits.py"
    #line 447 "iiwa_dnn/schemes/limits.py"
    deepest = double_max(A, (-a));
    #line 448 "iiwa_dnn/schemes/limits.py"
    square = double_max(((J * v) + ((0.5 * a) * a)), 0.0);
    #line 449 "iiwa_dnn/schemes/limits.py"
    d = double_min(sqrt(square), deepest);
    #line 450 "iiwa_dnn/schemes/limits.py"
    T = ((double)(a + d) / J);
    #line 451 "iiwa_dnn/schemes/limits.py"
    way = ((T * (v + (T * ((0.5 * a) - ((double)(J * T) / 6.0))))) + ((double)((d * d) * d) / ((6.0 * J) * J)));
    #line 452 "iiwa_dnn/schemes/limits.py"
    if (square > (d * d)) {
        #line 453 "iiwa_dnn/schemes/limits.py"
        v += ((double)(0.5 * ((a * a) - (d * d))) / J);
        #line 454 "iiwa_dnn/schemes/limits.py"
        h = ((double)((0.5 * d) * d) / J);
        #line 455 "iiwa_dnn/schemes/limits.py"
        way += ((double)((v - h) * (v + h)) / (2.0 * d));
    }
    #line 456 "iiwa_dnn/schemes/limits.py"
    return way;
}

/* Compute the velocity [rad/s] of the way over `room` [rad]; what is rounding is not gone.
 *
 * iiwa_dnn/schemes/limits.py: _easing */
static double schemes_limits_easing(struct arena *arena, double room, double dt)
{
    (void)arena;
    #line 416 "iiwa_dnn/schemes/limits.py"
    #line 417 "iiwa_dnn/schemes/limits.py"
    if (fabs(room) <= 2e-14) {
        #line 418 "iiwa_dnn/schemes/limits.py"
        return 0.0;
    }
    #line 419 "iiwa_dnn/schemes/limits.py"
    return ((double)(0.5 * room) / dt);
}

/* Compute `joint_bounds` where no jerk is limited.
 *
 * iiwa_dnn/schemes/limits.py: _acceleration_bounds */
static double_2 schemes_limits_acceleration_bounds(struct arena *arena, double last, double above, double below, double_4 rates, double dt)
{
    double fastest;
    double accel;
    double deceleration;
    double first;
    double final;
    double unit;
    double upper;
    double lower;
    #line 369 "iiwa_dnn/schemes/limits.py"
    #line 370 "iiwa_dnn/schemes/limits.py"
    const double_4 own_2 = rates;
    fastest = own_2.at[0];
    accel = own_2.at[1];
    deceleration = own_2.at[3];
    #line 371 "iiwa_dnn/schemes/limits.py"
    first = (last - (accel * dt));
    #line 372 "iiwa_dnn/schemes/limits.py"
    final = (last + (accel * dt));
    #line 373 "iiwa_dnn/schemes/limits.py"
    unit = (deceleration * dt);
    #line 374 "iiwa_dnn/schemes/limits.py"
    above -= double_min(double_max(above, 0.0), 2e-14);
    #line 375 "iiwa_dnn/schemes/limits.py"
    below -= double_min(double_max(below, 0.0), 2e-14);
    #line 377 "iiwa_dnn/schemes/limits.py"
    upper = double_min(double_max((unit * schemes_limits_approach(arena, ((double)above / (unit * dt)))), (-fastest)), fastest);
    #line 378 "iiwa_dnn/schemes/limits.py"
    lower = double_min(double_max(((-unit) * schemes_limits_approach(arena, ((double)below / (unit * dt)))), (-fastest)), fastest);
    #line 379 "iiwa_dnn/schemes/limits.py"
    return ((double_2){{double_min(double_max(lower, first), final), double_min(double_max(upper, first), final)}});
}

/* Compute the command in [lb, ub] that comes to rest quickest, without turning round.
 *
 * iiwa_dnn/schemes/limits.py: braking */
static double schemes_limits_braking(struct arena *arena, double last, double lb, double ub, double jerk, double dt)
{
    double wanted;
    double unit;
    #line 424 "iiwa_dnn/schemes/limits.py"
    #line 425 "iiwa_dnn/schemes/limits.py"
    wanted = 0.0;
    #line 426 "iiwa_dnn/schemes/limits.py"
    unit = ((jerk * dt) * dt);
    #line 427 "iiwa_dnn/schemes/limits.py"
    if ((jerk < INFINITY) && (last != 0.0)) {
        #line 428 "iiwa_dnn/schemes/limits.py"
        wanted = (last - copysign((unit * schemes_limits_approach(arena, ((double)fabs(last) / unit))), last));
    }
    #line 429 "iiwa_dnn/schemes/limits.py"
    return double_min(double_max(wanted, lb), ub);
}

/* Take a control step: its own program, or what the policy asks for.
 *
 * The network is not asked if the task yielded at the last step, or the arm brakes.
 *
 * Args:
 *     row: The row, (width,), with the targets unless they are sampled.
 *     plan: What the step is laid out with.
 *     past: `ControllerState.past`, (8, dof); the kinematics are at its joint positions.
 *     following: The same for the next step, overwritten.
 *     state: The network's state, (size,), advanced.
 *     relaxed: States of the networks of relaxed programs, (`relaxed_size`,), advanced.
 *     t: Time [s].
 *     samples: Whether the references are asked for the targets.
 *
 * Returns:
 *     The action that was taken, or `INVALID`.
 *
 * iiwa_dnn/control/step.py: take_step */
static int64_t control_step_take_step(struct arena *arena, Vector row, const step_StepPlan *plan, Matrix past, Matrix following, Vector state, Vector relaxed, double t, bool samples)
{
    program_ProgramArrays arrays;
    IntMatrix table;
    command_RowViews views;
    bool halted;
    int64_t first;
    Vector own;
    int64_t policy;
    const struct arena mark = *arena;
    #line 221 "iiwa_dnn/control/step.py"
    #line 238 "iiwa_dnn/control/step.py"
    arrays = (*plan).arrays;
    #line 239 "iiwa_dnn/control/step.py"
    table = arrays.table;
    #line 240 "iiwa_dnn/control/step.py"
    views = control_command_row_views(arena, row, table.data[0], table.data[1], table.data[2], table.data[3]);
    #line 241 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, ((Vector){following.data, (following.size0 * following.size1)}), ((Vector){past.data, (past.size0 * past.size1)}));
    #line 242 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, ((Vector){following.data + 2 * following.size1, following.size1}), ((Vector){past.data + 1 * past.size1, past.size1}));
    #line 243 "iiwa_dnn/control/step.py"
    following.data[4 * following.size1] = 0.0;
    #line 244 "iiwa_dnn/control/step.py"
    following.data[6 * following.size1] = 0.0;
    #line 245 "iiwa_dnn/control/step.py"
    if (samples) {
        #line 246 "iiwa_dnn/control/step.py"
        control_step_sample_targets(arena, &arrays, (t - past.data[5 * past.size1]), views.targets);
    }
    #line 247 "iiwa_dnn/control/step.py"
    schemes_program_assemble(arena, views.program, &arrays, past, views.targets, t);
    #line 248 "iiwa_dnn/control/step.py"
    control_step_note_instant(arena, &views, &arrays, past);
    #line 249 "iiwa_dnn/control/step.py"
    halted = (past.data[7 * past.size1] != 0.0);
    #line 250 "iiwa_dnn/control/step.py"
    if ((past.data[6 * past.size1] == 0.0) && (!halted) && (control_step_answer(arena, &views, &arrays, state))) {
        #line 251 "iiwa_dnn/control/step.py"
        control_relaxed_copied(arena, ((Vector){following.data + 1 * following.size1, following.size1}), views.dq);
        #line 252 "iiwa_dnn/control/step.py"
        if (control_yielding_guard_step(arena, &arrays, past, following, &(*plan).yielding)) {
            #line 253 "iiwa_dnn/control/step.py"
            const int64_t own_result = 0;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 254 "iiwa_dnn/control/step.py"
    first = ((row.size0) - (views.targets.size0 * views.targets.size1));
    #line 255 "iiwa_dnn/control/step.py"
    if ((!qp_dense_all_finite(arena, ((Vector){past.data, past.size1}), 0, table.data[3])) || (!qp_dense_all_finite(arena, row, first, (row.size0)))) {
        #line 256 "iiwa_dnn/control/step.py"
        const int64_t own_result = -1;
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 257 "iiwa_dnn/control/step.py"
    own = ((Vector){arena_zeros(arena, (((3 * table.data[0]) + table.data[1]) + table.data[2])), (((3 * table.data[0]) + table.data[1]) + table.data[2])});
    #line 258 "iiwa_dnn/control/step.py"
    if ((*plan).shares_state) {
        #line 259 "iiwa_dnn/control/step.py"
        own = state;
    }
    #line 260 "iiwa_dnn/control/step.py"
    policy = ((halted) ? -1 : (*plan).policy);
    #line 261 "iiwa_dnn/control/step.py"
    const int64_t own_result = control_yielding_yield_step(arena, &views, &arrays, past, following, own, &(*plan).yielding, relaxed, policy);
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the targets (k, 18) of all paths at time t [s]; the constants begin with their base.
 *
 * iiwa_dnn/control/step.py: sample_targets */
static void control_step_sample_targets(struct arena *arena, const program_ProgramArrays *arrays, double t, Matrix targets)
{
    IntMatrix table;
    int64_t first;
    double period;
    Vector own;
    Vector target;
    Vector move;
    Vector then;
    const struct arena mark = *arena;
    #line 328 "iiwa_dnn/control/step.py"
    #line 329 "iiwa_dnn/control/step.py"
    table = (*arrays).table;
    #line 330 "iiwa_dnn/control/step.py"
    first = (2 + table.data[4]);
    #line 331 "iiwa_dnn/control/step.py"
    period = ((double)1.0 / (*arrays).rate);
    #line 332 "iiwa_dnn/control/step.py"
    for (int64_t k = first, end_k = table.size0; k < end_k; k++) {
        #line 333 "iiwa_dnn/control/step.py"
        own = ((Vector){(*arrays).constants.data + table.data[k * table.size1 + 4], table.data[k * table.size1 + 5] - table.data[k * table.size1 + 4]});
        #line 334 "iiwa_dnn/control/step.py"
        target = ((Vector){targets.data + (k - first) * targets.size1, targets.size1});
        #line 335 "iiwa_dnn/control/step.py"
        move = ((Vector){own.data + (target.size0), own.size0 - (target.size0)});
        #line 336 "iiwa_dnn/control/step.py"
        for (int64_t i = 0, end_i = (target.size0); i < end_i; i++) {
            #line 337 "iiwa_dnn/control/step.py"
            target.data[i] = own.data[i];
        }
        #line 338 "iiwa_dnn/control/step.py"
        references_base_enter_path(arena, table.data[k * table.size1 + 1], t, move, target);
        #line 339 "iiwa_dnn/control/step.py"
        if (table.data[k * table.size1 + 2] != 0) {
            #line 340 "iiwa_dnn/control/step.py"
            then = ((Vector){arena_empty(arena, (target.size0)), (target.size0)});
            #line 341 "iiwa_dnn/control/step.py"
            for (int64_t i = 0, end_i = (target.size0); i < end_i; i++) {
                #line 342 "iiwa_dnn/control/step.py"
                then.data[i] = own.data[i];
            }
            #line 343 "iiwa_dnn/control/step.py"
            references_base_enter_path(arena, table.data[k * table.size1 + 1], (t + period), move, then);
            #line 344 "iiwa_dnn/control/step.py"
            references_rotations_set_mean_twist(arena, target, then, period);
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Enter a path's function at an address; it moves the target (18,) at time t [s]. */
static void references_base_enter_path(struct arena *arena, int64_t address, double t, Vector constants, Vector target)
{
    if (address > 0) return ((void (*)(struct arena *, double , Vector , Vector ))(intptr_t)address)(arena, t, constants, target);
    return ((void (*)(double, double *, int64_t, double *, int64_t))(intptr_t)-address)(t, constants.data, constants.size0, target.data, target.size0);
}

/* Set the twist of a target (18,) to the mean one towards another, a period dt [s] later.
 *
 * iiwa_dnn/references/rotations.py: set_mean_twist */
static void references_rotations_set_mean_twist(struct arena *arena, Vector now, Vector then, double dt)
{
    Matrix relative;
    Vector turn;
    const struct arena mark = *arena;
    #line 150 "iiwa_dnn/references/rotations.py"
    #line 151 "iiwa_dnn/references/rotations.py"
    relative = ((Matrix){arena_empty(arena, 3 * 3), 3, 3});
    #line 152 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 153 "iiwa_dnn/references/rotations.py"
        for (int64_t j = 0, end_j = 3; j < end_j; j++) {
            #line 154 "iiwa_dnn/references/rotations.py"
            relative.data[i * relative.size1 + j] = references_rotations_dot(arena, references_rotations_row_of(arena, then, i), references_rotations_row_of(arena, now, j));
        }
    }
    #line 155 "iiwa_dnn/references/rotations.py"
    turn = ((Vector){arena_empty(arena, 3), 3});
    #line 156 "iiwa_dnn/references/rotations.py"
    references_rotations_rotation_log(arena, relative, turn);
    #line 157 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 158 "iiwa_dnn/references/rotations.py"
        now.data[(12 + i)] = ((double)(then.data[i] - now.data[i]) / dt);
        #line 159 "iiwa_dnn/references/rotations.py"
        now.data[(15 + i)] = ((double)turn.data[i] / dt);
    }
    arena_leave(arena, &mark);
    return;
}

/* Compute the scalar product u . v.
 *
 * iiwa_dnn/references/rotations.py: dot */
static double references_rotations_dot(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    #line 44 "iiwa_dnn/references/rotations.py"
    #line 45 "iiwa_dnn/references/rotations.py"
    return (((u.at[0] * v.at[0]) + (u.at[1] * v.at[1])) + (u.at[2] * v.at[2]));
}

/* Return the i-th row of the rotation of `Target.data` (18,).
 *
 * iiwa_dnn/references/rotations.py: row_of */
static double_3 references_rotations_row_of(struct arena *arena, Vector target, int64_t i)
{
    (void)arena;
    #line 97 "iiwa_dnn/references/rotations.py"
    #line 98 "iiwa_dnn/references/rotations.py"
    return ((double_3){{target.data[(3 + (3 * i))], target.data[(4 + (3 * i))], target.data[(5 + (3 * i))]}});
}

/* Write the rotation vector of R (3, 3), of length at most pi [rad], into `out` (3,).
 *
 * Through the unit quaternion's largest component, so that it is accurate near 0 and near pi.
 *
 * iiwa_dnn/references/rotations.py: rotation_log */
static void references_rotations_rotation_log(struct arena *arena, Matrix R, Vector out)
{
    (void)arena;
    double trace;
    double w;
    int64_t i;
    int64_t j;
    int64_t k;
    double largest;
    double sign;
    double sine;
    double scale;
    #line 116 "iiwa_dnn/references/rotations.py"
    #line 120 "iiwa_dnn/references/rotations.py"
    trace = ((R.data[0] + R.data[1 * R.size1 + 1]) + R.data[2 * R.size1 + 2]);
    #line 121 "iiwa_dnn/references/rotations.py"
    if (trace > 0.0) {
        #line 122 "iiwa_dnn/references/rotations.py"
        w = (0.5 * sqrt((1.0 + trace)));
        #line 123 "iiwa_dnn/references/rotations.py"
        out.data[0] = ((double)(R.data[2 * R.size1 + 1] - R.data[1 * R.size1 + 2]) / (4.0 * w));
        #line 124 "iiwa_dnn/references/rotations.py"
        out.data[1] = ((double)(R.data[2] - R.data[2 * R.size1]) / (4.0 * w));
        #line 125 "iiwa_dnn/references/rotations.py"
        out.data[2] = ((double)(R.data[1 * R.size1] - R.data[1]) / (4.0 * w));
    }
    else {
        #line 127 "iiwa_dnn/references/rotations.py"
        i = 0;
        #line 128 "iiwa_dnn/references/rotations.py"
        if (R.data[1 * R.size1 + 1] > R.data[0]) {
            #line 129 "iiwa_dnn/references/rotations.py"
            i = 1;
        }
        #line 130 "iiwa_dnn/references/rotations.py"
        if (R.data[2 * R.size1 + 2] > R.data[i * R.size1 + i]) {
            #line 131 "iiwa_dnn/references/rotations.py"
            i = 2;
        }
        #line 132 "iiwa_dnn/references/rotations.py"
        j = int_remainder((i + 1), 3);
        #line 133 "iiwa_dnn/references/rotations.py"
        k = int_remainder((i + 2), 3);
        #line 134 "iiwa_dnn/references/rotations.py"
        largest = (0.5 * sqrt(double_max((((1.0 + R.data[i * R.size1 + i]) - R.data[j * R.size1 + j]) - R.data[k * R.size1 + k]), 0.0)));
        #line 135 "iiwa_dnn/references/rotations.py"
        w = ((double)(R.data[k * R.size1 + j] - R.data[j * R.size1 + k]) / (4.0 * largest));
        #line 136 "iiwa_dnn/references/rotations.py"
        sign = ((w >= 0.0) ? 1.0 : (-1.0));
        #line 137 "iiwa_dnn/references/rotations.py"
        w *= sign;
        #line 138 "iiwa_dnn/references/rotations.py"
        out.data[i] = (sign * largest);
        #line 139 "iiwa_dnn/references/rotations.py"
        out.data[j] = ((double)(sign * (R.data[i * R.size1 + j] + R.data[j * R.size1 + i])) / (4.0 * largest));
        #line 140 "iiwa_dnn/references/rotations.py"
        out.data[k] = ((double)(sign * (R.data[i * R.size1 + k] + R.data[k * R.size1 + i])) / (4.0 * largest));
    }
    #line 141 "iiwa_dnn/references/rotations.py"
    sine = sqrt((((out.data[0] * out.data[0]) + (out.data[1] * out.data[1])) + (out.data[2] * out.data[2])));
    #line 143 "iiwa_dnn/references/rotations.py"
    scale = ((sine > 1e-12) ? ((double)(2.0 * atan2(sine, w)) / sine) : 2.0);
    #line 144 "iiwa_dnn/references/rotations.py"
    for (int64_t axis = 0, end_axis = 3; axis < end_axis; axis++) {
        #line 145 "iiwa_dnn/references/rotations.py"
        out.data[axis] *= scale;
    }
    return;
}

/* Write the rows of all parts into a program.
 *
 * Args:
 *     data: The program, `QP.data`, (size,), overwritten.
 *     arrays: `StepProgram.arrays`.
 *     past: Joint positions [rad], last command and the one before [rad/s], (3 or more, dof).
 *     targets: Targets of the tracked frames, (k, 18).
 *     t: Time [s].
 *
 * iiwa_dnn/schemes/program.py: assemble */
static void schemes_program_assemble(struct arena *arena, Vector data, const program_ProgramArrays *arrays, Matrix past, Matrix targets, double t)
{
    IntMatrix table;
    Vector constants;
    step_StepViews step;
    layout_QPViews qp;
    int64_t kind;
    int64_t address;
    int64_t first;
    int64_t rows;
    Vector own;
    Vector target;
    Matrix A;
    Vector b;
    Matrix G;
    const struct arena mark = *arena;
    #line 460 "iiwa_dnn/schemes/program.py"
    #line 469 "iiwa_dnn/schemes/program.py"
    table = (*arrays).table;
    #line 470 "iiwa_dnn/schemes/program.py"
    constants = (*arrays).constants;
    #line 471 "iiwa_dnn/schemes/program.py"
    step = ((step_StepViews){t, (*arrays).rate, ((Vector){past.data, past.size1}), ((Vector){past.data + 1 * past.size1, past.size1}), ((Vector){past.data + 2 * past.size1, past.size1}), (*arrays).jacobian, (*arrays).placements, (*arrays).moves, (*arrays).inertia, targets});
    #line 483 "iiwa_dnn/schemes/program.py"
    qp = qp_layout_qp_views(arena, data, table.data[0], table.data[1], table.data[2]);
    #line 484 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0, own_end = ((Vector){data.data, data.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){data.data, data.size0 - 0}).data[own_k] = 0.0;
    #line 485 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0, own_end = ((Vector){qp.lb.data, qp.lb.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){qp.lb.data, qp.lb.size0 - 0}).data[own_k] = (-INFINITY);
    #line 486 "iiwa_dnn/schemes/program.py"
    for (int64_t own_k = 0, own_end = ((Vector){qp.ub.data, qp.ub.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){qp.ub.data, qp.ub.size0 - 0}).data[own_k] = INFINITY;
    #line 487 "iiwa_dnn/schemes/program.py"
    for (int64_t k = 1, end_k = (1 + table.data[4]); k < end_k; k++) {
        #line 488 "iiwa_dnn/schemes/program.py"
        kind = table.data[k * table.size1];
        #line 489 "iiwa_dnn/schemes/program.py"
        address = table.data[k * table.size1 + 1];
        #line 490 "iiwa_dnn/schemes/program.py"
        first = table.data[k * table.size1 + 2];
        #line 491 "iiwa_dnn/schemes/program.py"
        rows = table.data[k * table.size1 + 3];
        #line 492 "iiwa_dnn/schemes/program.py"
        own = ((Vector){constants.data + table.data[k * table.size1 + 4], table.data[k * table.size1 + 5] - table.data[k * table.size1 + 4]});
        #line 493 "iiwa_dnn/schemes/program.py"
        target = ((Vector){step.targets.data + table.data[k * table.size1 + 6] * step.targets.size1, step.targets.size1});
        #line 494 "iiwa_dnn/schemes/program.py"
        if (kind == 0) {
            #line 495 "iiwa_dnn/schemes/program.py"
            schemes_parts_enter_cost(arena, address, &step, own, qp.P, qp.q);
        }
        else {
            #line 496 "iiwa_dnn/schemes/program.py"
            if (kind == 1) {
                #line 497 "iiwa_dnn/schemes/program.py"
                A = ((Matrix){qp.A.data + first * qp.A.size1, (first + rows) - first, qp.A.size1});
                #line 498 "iiwa_dnn/schemes/program.py"
                schemes_parts_enter_task(arena, address, &step, own, target, A, ((Vector){qp.b.data + first, (first + rows) - first}));
            }
            else {
                #line 499 "iiwa_dnn/schemes/program.py"
                if (kind == 2) {
                    #line 500 "iiwa_dnn/schemes/program.py"
                    A = ((Matrix){arena_zeros(arena, rows * (qp.q.size0)), rows, (qp.q.size0)});
                    #line 501 "iiwa_dnn/schemes/program.py"
                    b = ((Vector){arena_zeros(arena, rows), rows});
                    #line 502 "iiwa_dnn/schemes/program.py"
                    schemes_parts_enter_task(arena, address, &step, own, target, A, b);
                    #line 503 "iiwa_dnn/schemes/program.py"
                    schemes_program_add_soft(arena, &qp, A, b, constants.data[table.data[k * table.size1 + 5]]);
                }
                else {
                    #line 505 "iiwa_dnn/schemes/program.py"
                    G = ((Matrix){qp.G.data + first * qp.G.size1, (first + rows) - first, qp.G.size1});
                    #line 506 "iiwa_dnn/schemes/program.py"
                    schemes_parts_enter_limit(arena, address, &step, own, G, ((Vector){qp.h.data + first, (first + rows) - first}), qp.lb, qp.ub);
                }
            }
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Enter a cost's kernel, with constants (k,), P (n, n) and the cost vector q (n,). */
static void schemes_parts_enter_cost(struct arena *arena, int64_t address, const step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    if (address > 0) return ((void (*)(struct arena *, const step_StepViews *, Vector , Matrix , Vector ))(intptr_t)address)(arena, step, constants, P, q);
    return ((void (*)(double, double, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t))(intptr_t)-address)((*step).t, (*step).rate, (*step).q.data, (*step).q.size0, (*step).last.data, (*step).last.size0, (*step).before.data, (*step).before.size0, (*step).jacobian.data, (*step).jacobian.size0, (*step).jacobian.size1, (*step).placements.data, (*step).placements.size0, (*step).placements.size1, (*step).moves.data, (*step).moves.size0, (*step).moves.size1, (*step).inertia.data, (*step).inertia.size0, (*step).inertia.size1, (*step).targets.data, (*step).targets.size0, (*step).targets.size1, constants.data, constants.size0, P.data, P.size0, P.size1, q.data, q.size0);
}

/* Enter a task's kernel, with constants (k,), target (18,), A (rows, n), b (rows,). */
static void schemes_parts_enter_task(struct arena *arena, int64_t address, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    if (address > 0) return ((void (*)(struct arena *, const step_StepViews *, Vector , Vector , Matrix , Vector ))(intptr_t)address)(arena, step, constants, target, A, b);
    return ((void (*)(double, double, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t))(intptr_t)-address)((*step).t, (*step).rate, (*step).q.data, (*step).q.size0, (*step).last.data, (*step).last.size0, (*step).before.data, (*step).before.size0, (*step).jacobian.data, (*step).jacobian.size0, (*step).jacobian.size1, (*step).placements.data, (*step).placements.size0, (*step).placements.size1, (*step).moves.data, (*step).moves.size0, (*step).moves.size1, (*step).inertia.data, (*step).inertia.size0, (*step).inertia.size1, (*step).targets.data, (*step).targets.size0, (*step).targets.size1, constants.data, constants.size0, target.data, target.size0, A.data, A.size0, A.size1, b.data, b.size0);
}

/* Add weight A^T A to P and -weight A^T b to q, for rows A (rows, n) and b (rows,).
 *
 * iiwa_dnn/schemes/program.py: _add_soft */
static void schemes_program_add_soft(struct arena *arena, const layout_QPViews *qp, Matrix A, Vector b, double weight)
{
    (void)arena;
    double scaled;
    #line 511 "iiwa_dnn/schemes/program.py"
    #line 512 "iiwa_dnn/schemes/program.py"
    for (int64_t k = 0, end_k = (b.size0); k < end_k; k++) {
        #line 513 "iiwa_dnn/schemes/program.py"
        for (int64_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
            #line 514 "iiwa_dnn/schemes/program.py"
            scaled = (weight * A.data[k * A.size1 + i]);
            #line 515 "iiwa_dnn/schemes/program.py"
            (*qp).q.data[i] -= (scaled * b.data[k]);
            #line 516 "iiwa_dnn/schemes/program.py"
            for (int64_t j = 0, end_j = ((*qp).q.size0); j < end_j; j++) {
                #line 517 "iiwa_dnn/schemes/program.py"
                (*qp).P.data[i * (*qp).P.size1 + j] += (scaled * A.data[k * A.size1 + j]);
            }
        }
    }
    return;
}

/* Enter a limit's kernel, with constants (k,), G (rows, n), h (rows,), lb and ub (n,). */
static void schemes_parts_enter_limit(struct arena *arena, int64_t address, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    if (address > 0) return ((void (*)(struct arena *, const step_StepViews *, Vector , Matrix , Vector , Vector , Vector ))(intptr_t)address)(arena, step, constants, G, h, lb, ub);
    return ((void (*)(double, double, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t))(intptr_t)-address)((*step).t, (*step).rate, (*step).q.data, (*step).q.size0, (*step).last.data, (*step).last.size0, (*step).before.data, (*step).before.size0, (*step).jacobian.data, (*step).jacobian.size0, (*step).jacobian.size1, (*step).placements.data, (*step).placements.size0, (*step).placements.size1, (*step).moves.data, (*step).moves.size0, (*step).moves.size1, (*step).inertia.data, (*step).inertia.size0, (*step).inertia.size1, (*step).targets.data, (*step).targets.size0, (*step).targets.size1, constants.data, constants.size0, G.data, G.size0, G.size1, h.data, h.size0, lb.data, lb.size0, ub.data, ub.size0);
}

/* Note what the program in a row was built at, and that it is not answered yet.
 *
 * iiwa_dnn/control/step.py: _note_instant */
static void control_step_note_instant(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past)
{
    IntMatrix table;
    int64_t dof;
    layout_QPViews qp;
    #line 266 "iiwa_dnn/control/step.py"
    #line 267 "iiwa_dnn/control/step.py"
    table = (*arrays).table;
    #line 268 "iiwa_dnn/control/step.py"
    dof = table.data[3];
    #line 269 "iiwa_dnn/control/step.py"
    qp = qp_layout_qp_views(arena, (*views).program, table.data[0], table.data[1], table.data[2]);
    #line 270 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, ((Vector){(*views).past.data, (3 * dof)}), ((Vector){((Matrix){past.data, 3 - 0, past.size1}).data, (3 * dof)}));
    #line 271 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, ((Vector){(*views).bounds.data, (*views).bounds.size1}), ((Vector){qp.lb.data, dof - 0}));
    #line 272 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, ((Vector){(*views).bounds.data + 1 * (*views).bounds.size1, (*views).bounds.size1}), ((Vector){qp.ub.data, dof - 0}));
    #line 273 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, (*views).placement, ((Vector){(*arrays).placements.data + table.data[5] * (*arrays).placements.size1, (*arrays).placements.size1}));
    #line 274 "iiwa_dnn/control/step.py"
    for (int64_t own_k = 0, own_end = ((Vector){(*views).figures.data, (*views).figures.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).figures.data, (*views).figures.size0 - 0}).data[own_k] = 0.0;
    #line 275 "iiwa_dnn/control/step.py"
    for (int64_t own_k = 0, own_end = ((Vector){(*views).decision.data, (*views).decision.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).decision.data, (*views).decision.size0 - 0}).data[own_k] = 0.0;
    #line 276 "iiwa_dnn/control/step.py"
    for (int64_t own_k = 0, own_end = ((Vector){(*views).blocking.data, (*views).blocking.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).blocking.data, (*views).blocking.size0 - 0}).data[own_k] = 0.0;
    return;
}

/* Ask the network for the answer to the program in a row, and note it.
 *
 * Returns:
 *     False if it did not settle or diverged; its state (size,) is then as it was.
 *
 * iiwa_dnn/control/step.py: _answer */
static bool control_step_answer(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Vector state)
{
    IntMatrix table;
    IntVector entry;
    Vector own;
    layout_QPViews qp;
    Vector before;
    double iterations;
    double time;
    double primal;
    double dual;
    double gap;
    const struct arena mark = *arena;
    #line 281 "iiwa_dnn/control/step.py"
    #line 286 "iiwa_dnn/control/step.py"
    table = (*arrays).table;
    #line 287 "iiwa_dnn/control/step.py"
    entry = ((IntVector){table.data + (1 + table.data[4]) * table.size1, table.size1});
    #line 288 "iiwa_dnn/control/step.py"
    own = ((Vector){(*arrays).constants.data + entry.data[4], entry.data[5] - entry.data[4]});
    #line 289 "iiwa_dnn/control/step.py"
    qp = qp_layout_qp_views(arena, (*views).program, table.data[0], table.data[1], table.data[2]);
    #line 290 "iiwa_dnn/control/step.py"
    before = ((Vector){arena_copy(arena, state.data, state.size0), state.size0});
    #line 291 "iiwa_dnn/control/step.py"
    const double_5 own_12 = integrators_base_enter_answer(arena, entry.data[1], &qp, entry.data[2], own, state, (*views).point);
    iterations = own_12.at[0];
    time = own_12.at[1];
    primal = own_12.at[2];
    dual = own_12.at[3];
    gap = own_12.at[4];
    #line 294 "iiwa_dnn/control/step.py"
    (*views).figures.data[0] = iterations;
    #line 295 "iiwa_dnn/control/step.py"
    (*views).figures.data[1] = time;
    #line 296 "iiwa_dnn/control/step.py"
    (*views).figures.data[2] = primal;
    #line 297 "iiwa_dnn/control/step.py"
    (*views).figures.data[3] = dual;
    #line 298 "iiwa_dnn/control/step.py"
    (*views).figures.data[4] = gap;
    #line 299 "iiwa_dnn/control/step.py"
    (*views).decision.data[1] = 1.0;
    #line 300 "iiwa_dnn/control/step.py"
    (*views).decision.data[2] = control_step_status_of(arena, primal, dual, gap, own, state);
    #line 301 "iiwa_dnn/control/step.py"
    if ((*views).decision.data[2] >= 2) {
        #line 302 "iiwa_dnn/control/step.py"
        control_relaxed_copied(arena, state, before);
        #line 303 "iiwa_dnn/control/step.py"
        const bool own_result = false;
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 304 "iiwa_dnn/control/step.py"
    control_relaxed_copied(arena, (*views).dq, ((Vector){(*views).point.data, ((*views).dq.size0) - 0}));
    #line 305 "iiwa_dnn/control/step.py"
    const bool own_result = true;
    arena_leave(arena, &mark);
    return own_result;
}

/* Enter a compiled answer at an address.
 *
 * It advances the state (size,), by a time or until it has settled, writes the point
 * (2n + m + p,) that it stands for, and returns what `Answered` holds. `rates` is the address of
 * the network's function, and the constants are (k,). */
static double_5 integrators_base_enter_answer(struct arena *arena, int64_t address, const layout_QPViews *qp, int64_t rates, Vector constants, Vector state, Vector point)
{
    if (address > 0) return ((double_5 (*)(struct arena *, const layout_QPViews *, int64_t , Vector , Vector , Vector ))(intptr_t)address)(arena, qp, rates, constants, state, point);
    double_5 numbers = {{0.0}};
    ((void (*)(double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *))(intptr_t)-address)((*qp).P.data, (*qp).P.size0, (*qp).P.size1, (*qp).q.data, (*qp).q.size0, (*qp).G.data, (*qp).G.size0, (*qp).G.size1, (*qp).h.data, (*qp).h.size0, (*qp).A.data, (*qp).A.size0, (*qp).A.size1, (*qp).b.data, (*qp).b.size0, (*qp).lb.data, (*qp).lb.size0, (*qp).ub.data, (*qp).ub.size0, rates, constants.data, constants.size0, state.data, state.size0, point.data, point.size0, numbers.at);
    return numbers;
}

/* Judge an answer by its residuals; one that was advanced by its state (size,) too.
 *
 * The point of an infinite state is finite, since it is clipped to the bounds. `own` are the
 * constants of the network.
 *
 * iiwa_dnn/control/step.py: status_of */
static int64_t control_step_status_of(struct arena *arena, double primal, double dual, double gap, Vector own, Vector state)
{
    double size;
    #line 310 "iiwa_dnn/control/step.py"
    #line 315 "iiwa_dnn/control/step.py"
    size = ((primal + dual) + gap);
    #line 316 "iiwa_dnn/control/step.py"
    if (own.data[2] > 0.0) {
        #line 317 "iiwa_dnn/control/step.py"
        for (int64_t i = 0, end_i = (state.size0); i < end_i; i++) {
            #line 318 "iiwa_dnn/control/step.py"
            size += fabs(state.data[i]);
        }
    }
    #line 319 "iiwa_dnn/control/step.py"
    if (!(size < INFINITY)) {
        #line 320 "iiwa_dnn/control/step.py"
        return 3;
    }
    #line 321 "iiwa_dnn/control/step.py"
    if (own.data[2] > 0.0) {
        #line 322 "iiwa_dnn/control/step.py"
        return 1;
    }
    #line 323 "iiwa_dnn/control/step.py"
    return ((qp_residuals_within(arena, primal, dual, gap, own.data[0])) ? 0 : 2);
}

/* Test whether the command that `following` holds is stoppable, and note its way to rest.
 *
 * Args:
 *     arrays: Arrays of the loop.
 *     past: `ControllerState.past`, (8, dof).
 *     following: `ControllerState.following`, (8, dof).
 *     yielding: Limits and scenes.
 *
 * iiwa_dnn/control/yielding.py: guard_step */
static bool control_yielding_guard_step(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, Matrix following, const relaxed_Yielding *yielding)
{
    double rest;
    #line 458 "iiwa_dnn/control/yielding.py"
    #line 466 "iiwa_dnn/control/yielding.py"
    rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){following.data + 1 * following.size1, following.size1}));
    #line 467 "iiwa_dnn/control/yielding.py"
    following.data[4 * following.size1] = double_max(rest, 0.0);
    #line 468 "iiwa_dnn/control/yielding.py"
    return (rest >= 0.0);
}

/* Compute `stopping_time` of a command x (dof,); 0 if no distance is kept.
 *
 * iiwa_dnn/control/yielding.py: _periods_to_rest */
static double control_yielding_periods_to_rest(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector x)
{
    double rest;
    #line 175 "iiwa_dnn/control/yielding.py"
    #line 176 "iiwa_dnn/control/yielding.py"
    rest = 0.0;
    #line 177 "iiwa_dnn/control/yielding.py"
    if ((*yielding).stop) {
        #line 178 "iiwa_dnn/control/yielding.py"
        rest = control_stopping_enter_stopping_time(arena, (*yielding).stop, &(*arrays), past, &(*yielding), x);
    }
    #line 179 "iiwa_dnn/control/yielding.py"
    return rest;
}

/* Enter `stopping_time` at an address: controllers without scenes are exported without it. */
static double control_stopping_enter_stopping_time(struct arena *arena, int64_t address, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector dq)
{
    if (address > 0) return ((double (*)(struct arena *, const program_ProgramArrays *, Matrix , const relaxed_Yielding *, Vector ))(intptr_t)address)(arena, arrays, past, yielding, dq);
    return ((double (*)(int64_t *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double *, int64_t, int64_t, double, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, int64_t *, int64_t, int64_t, double, int64_t, bool, bool, double *, int64_t))(intptr_t)-address)((*arrays).table.data, (*arrays).table.size0, (*arrays).table.size1, (*arrays).constants.data, (*arrays).constants.size0, (*arrays).jacobian.data, (*arrays).jacobian.size0, (*arrays).jacobian.size1, (*arrays).placements.data, (*arrays).placements.size0, (*arrays).placements.size1, (*arrays).moves.data, (*arrays).moves.size0, (*arrays).moves.size1, (*arrays).inertia.data, (*arrays).inertia.size0, (*arrays).inertia.size1, (*arrays).rate, past.data, past.size0, past.size1, (*yielding).weights.data, (*yielding).weights.size0, (*yielding).limits.data, (*yielding).limits.size0, (*yielding).settings.data, (*yielding).settings.size0, (*yielding).scenes.data, (*yielding).scenes.size0, (*yielding).scenes.size1, (*yielding).dt, (*yielding).stop, (*yielding).cubic, (*yielding).coupled, dq.data, dq.size0);
}

/* Answer a step for which the network has no answer, or whose task yielded at the last step.
 *
 * Args:
 *     views: The row, with the step's own program and what it was built at.
 *     arrays: Arrays of the loop; the kinematics are at the joint positions of `past`.
 *     past: `ControllerState.past`, (8, dof).
 *     following: The same for the next step, with the last commands; the rest is overwritten.
 *     state: The network's state, (size,), advanced.
 *     yielding: Weights, limits and settings of the relaxed programs.
 *     relaxed: States of the networks of relaxed programs, (`relaxed_size`,), advanced.
 *     action: Action that the policy asks for; `BRAKE`: the arm goes to rest, whatever has a
 *         solution.
 *
 * Returns:
 *     The action that was taken.
 *
 * iiwa_dnn/control/yielding.py: yield_step */
static int64_t control_yielding_yield_step(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past, Matrix following, Vector state, const relaxed_Yielding *yielding, Vector relaxed, int64_t action)
{
    IntMatrix table;
    int64_t dof;
    layout_QPViews qp;
    Vector data;
    layout_QPViews own;
    int64_t kind;
    double factor;
    double rest;
    double found;
    Vector x;
    layout_QPViews limits;
    int64_t missing;
    double primal;
    double dual;
    double gap;
    const struct arena mark = *arena;
    #line 117 "iiwa_dnn/control/yielding.py"
    #line 133 "iiwa_dnn/control/yielding.py"
    table = (*arrays).table;
    #line 134 "iiwa_dnn/control/yielding.py"
    dof = table.data[3];
    #line 135 "iiwa_dnn/control/yielding.py"
    qp = qp_layout_qp_views(arena, (*views).program, table.data[0], table.data[1], table.data[2]);
    #line 136 "iiwa_dnn/control/yielding.py"
    data = ((Vector){arena_copy(arena, (*views).program.data, (*views).program.size0), (*views).program.size0});
    #line 137 "iiwa_dnn/control/yielding.py"
    own = qp_layout_qp_views(arena, data, table.data[0], table.data[1], table.data[2]);
    #line 138 "iiwa_dnn/control/yielding.py"
    kind = 4;
    #line 139 "iiwa_dnn/control/yielding.py"
    factor = 0.0;
    #line 140 "iiwa_dnn/control/yielding.py"
    rest = 0.0;
    #line 141 "iiwa_dnn/control/yielding.py"
    if (action != -1) {
        #line 142 "iiwa_dnn/control/yielding.py"
        control_yielding_widen_bounds(arena, &qp, (*yielding).limits, ((Vector){past.data, past.size1}));
        #line 143 "iiwa_dnn/control/yielding.py"
        const double_2 own_21 = control_yielding_answer_relaxed(arena, &(*views), &qp, &(*yielding), state, relaxed, action);
        found = own_21.at[0];
        factor = own_21.at[1];
        #line 144 "iiwa_dnn/control/yielding.py"
        kind = (int64_t)(found);
    }
    #line 145 "iiwa_dnn/control/yielding.py"
    x = ((Vector){arena_copy(arena, ((Vector){(*views).point.data, (qp.q.size0) - 0}).data, ((Vector){(*views).point.data, (qp.q.size0) - 0}).size0), ((Vector){(*views).point.data, (qp.q.size0) - 0}).size0});
    #line 146 "iiwa_dnn/control/yielding.py"
    limits = ((layout_QPViews){qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, own.lb, own.ub});
    #line 147 "iiwa_dnn/control/yielding.py"
    if (kind != 4) {
        #line 148 "iiwa_dnn/control/yielding.py"
        control_yielding_step(arena, &limits, past, following, &(*yielding), (*views).figures, x);
        #line 149 "iiwa_dnn/control/yielding.py"
        rest = control_yielding_make_stoppable(arena, &limits, &(*arrays), past, &(*yielding), &(*views), x);
        #line 150 "iiwa_dnn/control/yielding.py"
        missing = control_yielding_note_missing(arena, &(*views), ((Vector){x.data, dof - 0}));
        #line 151 "iiwa_dnn/control/yielding.py"
        const double_3 own_40 = qp_residuals_point_residuals(arena, &limits, (*views).point);
        primal = own_40.at[0];
        dual = own_40.at[1];
        gap = own_40.at[2];
        #line 152 "iiwa_dnn/control/yielding.py"
        if (missing > 0) {
            #line 153 "iiwa_dnn/control/yielding.py"
            kind = ((action == 4) ? 4 : 3);
        }
        else {
            #line 154 "iiwa_dnn/control/yielding.py"
            if ((factor == 1.0) && (qp_residuals_within(arena, primal, dual, gap, (*yielding).settings.data[0]))) {
                #line 155 "iiwa_dnn/control/yielding.py"
                kind = 0;
                #line 156 "iiwa_dnn/control/yielding.py"
                control_relaxed_copied(arena, qp.lb, own.lb);
                #line 157 "iiwa_dnn/control/yielding.py"
                control_relaxed_copied(arena, qp.ub, own.ub);
            }
        }
    }
    #line 158 "iiwa_dnn/control/yielding.py"
    if (kind == 4) {
        #line 159 "iiwa_dnn/control/yielding.py"
        control_relaxed_copied(arena, (*views).program, data);
        #line 160 "iiwa_dnn/control/yielding.py"
        rest = control_yielding_brake(arena, &own, past, &(*yielding), x);
        #line 161 "iiwa_dnn/control/yielding.py"
        for (int64_t own_k = 0, own_end = ((Vector){(*views).point.data, (*views).point.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).point.data, (*views).point.size0 - 0}).data[own_k] = 0.0;
        #line 162 "iiwa_dnn/control/yielding.py"
        control_relaxed_copied(arena, (*views).point, x);
    }
    #line 163 "iiwa_dnn/control/yielding.py"
    control_yielding_note_decision(arena, &(*views), &own, (*yielding).weights, x, kind, factor, action);
    #line 164 "iiwa_dnn/control/yielding.py"
    const double_3 own_76 = qp_residuals_point_residuals(arena, &qp, (*views).point);
    (*views).figures.data[2] = own_76.at[0];
    (*views).figures.data[3] = own_76.at[1];
    (*views).figures.data[4] = own_76.at[2];
    #line 165 "iiwa_dnn/control/yielding.py"
    following.data[4 * following.size1] = rest;
    #line 166 "iiwa_dnn/control/yielding.py"
    following.data[5 * following.size1] += ((*yielding).dt * (1.0 - (*views).decision.data[1]));
    #line 167 "iiwa_dnn/control/yielding.py"
    following.data[6 * following.size1] = (0 < kind && kind < 4);
    #line 168 "iiwa_dnn/control/yielding.py"
    control_relaxed_copied(arena, (*views).dq, ((Vector){x.data, dof - 0}));
    #line 169 "iiwa_dnn/control/yielding.py"
    control_relaxed_copied(arena, ((Vector){following.data + 1 * following.size1, following.size1}), ((Vector){x.data, dof - 0}));
    #line 170 "iiwa_dnn/control/yielding.py"
    const int64_t own_result = (int64_t)((*views).decision.data[0]);
    arena_leave(arena, &mark);
    return own_result;
}

/* Replace bounds that acceleration limits have narrowed by those of position and velocity.
 *
 * iiwa_dnn/control/yielding.py: _widen_bounds */
static void control_yielding_widen_bounds(struct arena *arena, const layout_QPViews *qp, Vector limits, Vector q)
{
    (void)arena;
    int64_t dof;
    double fastest;
    #line 221 "iiwa_dnn/control/yielding.py"
    #line 222 "iiwa_dnn/control/yielding.py"
    dof = int_quotient((limits.size0), 6);
    #line 223 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = dof; i < end_i; i++) {
        #line 224 "iiwa_dnn/control/yielding.py"
        fastest = limits.data[((2 * dof) + i)];
        #line 225 "iiwa_dnn/control/yielding.py"
        (*qp).lb.data[i] = double_min(double_max((20.0 * (limits.data[i] - q.data[i])), (-fastest)), fastest);
        #line 226 "iiwa_dnn/control/yielding.py"
        (*qp).ub.data[i] = double_min(double_max((20.0 * (limits.data[(dof + i)] - q.data[i])), (-fastest)), fastest);
    }
    return;
}

/* Turn a step's program into the first relaxed one that has a solution, and answer it.
 *
 * Returns:
 *     Its kind, and the scaling factor of the task in it.
 *
 * iiwa_dnn/control/yielding.py: _answer_relaxed */
static double_2 control_yielding_answer_relaxed(struct arena *arena, const command_RowViews *views, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector relaxed, int64_t action)
{
    int64_t n;
    int64_t m;
    Vector point;
    int64_t size;
    double factor;
    bool follows;
    Vector asked;
    double retreat;
    bool found;
    const struct arena mark = *arena;
    #line 238 "iiwa_dnn/control/yielding.py"
    #line 243 "iiwa_dnn/control/yielding.py"
    n = ((*qp).q.size0);
    #line 244 "iiwa_dnn/control/yielding.py"
    m = ((*qp).h.size0);
    #line 245 "iiwa_dnn/control/yielding.py"
    point = ((Vector){arena_empty(arena, ((((2 * n) + 2) + m) + ((*qp).b.size0))), ((((2 * n) + 2) + m) + ((*qp).b.size0))});
    #line 246 "iiwa_dnn/control/yielding.py"
    size = ((((3 * n) + 3) + m) + ((*qp).b.size0));
    #line 247 "iiwa_dnn/control/yielding.py"
    factor = control_relaxed_largest_factor(arena, &(*qp), &(*yielding), ((Vector){relaxed.data, size - 0}), point, (*views).figures, false);
    #line 248 "iiwa_dnn/control/yielding.py"
    control_relaxed_note_blocking(arena, point, n, m, 1, (*views).blocking);
    #line 249 "iiwa_dnn/control/yielding.py"
    follows = ((action == 2) && (control_yielding_is_path(arena, (*views).targets)) && (!control_yielding_races(arena, &(*qp), ((Vector){point.data, n - 0}))));
    #line 250 "iiwa_dnn/control/yielding.py"
    if ((factor == 1.0) || ((follows) && (factor >= 0.1))) {
        #line 251 "iiwa_dnn/control/yielding.py"
        asked = ((Vector){arena_copy(arena, (*qp).b.data, (*qp).b.size0), (*qp).b.size0});
        #line 252 "iiwa_dnn/control/yielding.py"
        control_relaxed_scale_task(arena, &(*qp), (*yielding).weights, factor);
        #line 253 "iiwa_dnn/control/yielding.py"
        if (control_relaxed_settled(arena, &(*qp), &(*yielding), state, (*views).point, (*views).figures, 1.0)) {
            #line 254 "iiwa_dnn/control/yielding.py"
            const double_2 own_result = ((double_2){{1, factor}});
            arena_leave(arena, &mark);
            return own_result;
        }
        #line 255 "iiwa_dnn/control/yielding.py"
        control_relaxed_copied(arena, (*qp).b, asked);
    }
    #line 256 "iiwa_dnn/control/yielding.py"
    if (action == 4) {
        #line 257 "iiwa_dnn/control/yielding.py"
        const double_2 own_result = ((double_2){{4, 0.0}});
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 258 "iiwa_dnn/control/yielding.py"
    retreat = 1.0;
    #line 259 "iiwa_dnn/control/yielding.py"
    if (factor < 0.0) {
        #line 260 "iiwa_dnn/control/yielding.py"
        retreat = control_relaxed_largest_factor(arena, &(*qp), &(*yielding), ((Vector){arena_zeros(arena, size), size}), point, (*views).figures, true);
    }
    #line 261 "iiwa_dnn/control/yielding.py"
    if (retreat < 0.0) {
        #line 262 "iiwa_dnn/control/yielding.py"
        control_relaxed_note_blocking(arena, point, n, m, 1, (*views).blocking);
        #line 263 "iiwa_dnn/control/yielding.py"
        const double_2 own_result = ((double_2){{4, 0.0}});
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 264 "iiwa_dnn/control/yielding.py"
    control_relaxed_soften_task(arena, &(*qp), (*yielding).weights, retreat);
    #line 265 "iiwa_dnn/control/yielding.py"
    found = control_relaxed_settled(arena, &(*qp), &(*yielding), ((Vector){relaxed.data + size, relaxed.size0 - size}), (*views).point, (*views).figures, 1.0);
    #line 266 "iiwa_dnn/control/yielding.py"
    control_relaxed_note_blocking(arena, (*views).point, n, m, 0, (*views).blocking);
    #line 267 "iiwa_dnn/control/yielding.py"
    const double_2 own_result = ((double_2){{((found) ? 2 : 4), 0.0}});
    arena_leave(arena, &mark);
    return own_result;
}

/* Test whether a target (k, 18) has a velocity.
 *
 * iiwa_dnn/control/yielding.py: _is_path */
static bool control_yielding_is_path(struct arena *arena, Matrix targets)
{
    double fastest;
    #line 272 "iiwa_dnn/control/yielding.py"
    #line 273 "iiwa_dnn/control/yielding.py"
    fastest = 0.0;
    #line 274 "iiwa_dnn/control/yielding.py"
    for (int64_t k = 0, end_k = targets.size0; k < end_k; k++) {
        #line 275 "iiwa_dnn/control/yielding.py"
        fastest = double_max(fastest, control_relaxed_largest_entry(arena, ((Vector){targets.data + k * targets.size1 + 12, targets.size1 - 12})));
    }
    #line 276 "iiwa_dnn/control/yielding.py"
    return (fastest > 0.0);
}

/* Test whether joints of the velocity x (n,) race while the tip hardly moves.
 *
 * iiwa_dnn/control/yielding.py: _races */
static bool control_yielding_races(struct arena *arena, const layout_QPViews *qp, Vector x)
{
    double tip;
    #line 281 "iiwa_dnn/control/yielding.py"
    #line 282 "iiwa_dnn/control/yielding.py"
    tip = 0.0;
    #line 283 "iiwa_dnn/control/yielding.py"
    for (int64_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        #line 284 "iiwa_dnn/control/yielding.py"
        tip = double_max(tip, fabs(qp_dense_row_dot(arena, (*qp).A, j, x)));
    }
    #line 285 "iiwa_dnn/control/yielding.py"
    return (tip < (0.05 * control_relaxed_largest_entry(arena, x)));
}

/* Turn a wanted velocity x (n,) into the next command on the way to it.
 *
 * Args:
 *     limits: The program that was answered, with the bounds of the step.
 *     past: `ControllerState.past`, (8, dof).
 *     following: `ControllerState.following`, (8, dof): the wanted velocity is noted.
 *     yielding: Weights, limits and settings.
 *     figures: Figures of the answer, (5,), as of `settled`.
 *     x: The velocity, overwritten.
 *
 * iiwa_dnn/control/yielding.py: _step */
static void control_yielding_step(struct arena *arena, const layout_QPViews *limits, Matrix past, Matrix following, const relaxed_Yielding *yielding, Vector figures, Vector x)
{
    #line 309 "iiwa_dnn/control/yielding.py"
    #line 319 "iiwa_dnn/control/yielding.py"
    if (((*yielding).limits.size0) == 0) {
        #line 320 "iiwa_dnn/control/yielding.py"
        return;
    }
    #line 321 "iiwa_dnn/control/yielding.py"
    control_relaxed_copied(arena, ((Vector){following.data + 3 * following.size1, following.size1}), ((Vector){x.data, past.size1 - 0}));
    #line 323 "iiwa_dnn/control/yielding.py"
    if ((*yielding).coupled) {
        #line 324 "iiwa_dnn/control/yielding.py"
        control_yielding_step_straight(arena, past, &(*yielding), x);
    }
    else {
        #line 326 "iiwa_dnn/control/yielding.py"
        control_yielding_step_towards(arena, &(*limits), past, &(*yielding), x);
    }
    #line 327 "iiwa_dnn/control/yielding.py"
    control_relaxed_nearest_within(arena, &(*limits), x, &(*yielding), figures);
    return;
}

/* Replace the wanted velocity x (n,) by the next command on the straight line to it.
 *
 * iiwa_dnn/control/yielding.py: _step_straight */
static void control_yielding_step_straight(struct arena *arena, Matrix past, const relaxed_Yielding *yielding, Vector x)
{
    int64_t dof;
    Vector now;
    Vector before;
    double periods;
    const struct arena mark = *arena;
    #line 348 "iiwa_dnn/control/yielding.py"
    #line 349 "iiwa_dnn/control/yielding.py"
    dof = past.size1;
    #line 350 "iiwa_dnn/control/yielding.py"
    now = ((Vector){arena_empty(arena, dof), dof});
    #line 351 "iiwa_dnn/control/yielding.py"
    before = ((Vector){arena_empty(arena, dof), dof});
    #line 352 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = dof; i < end_i; i++) {
        #line 353 "iiwa_dnn/control/yielding.py"
        now.data[i] = (past.data[1 * past.size1 + i] - x.data[i]);
        #line 354 "iiwa_dnn/control/yielding.py"
        before.data[i] = (past.data[2 * past.size1 + i] - x.data[i]);
    }
    #line 355 "iiwa_dnn/control/yielding.py"
    periods = control_stopping_least_periods(arena, now, before, (*yielding).limits, (*yielding).dt, (*yielding).cubic);
    #line 356 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = dof; i < end_i; i++) {
        #line 357 "iiwa_dnn/control/yielding.py"
        if (periods < INFINITY) {
            #line 358 "iiwa_dnn/control/yielding.py"
            x.data[i] += control_stopping_next_velocity(arena, now.data[i], before.data[i], periods, (*yielding).cubic);
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Compute the number of periods in which velocities go to zero together.
 *
 * It is the least one, or with a jerk limit one that is found from below in steps of a tenth.
 *
 * Args:
 *     x: Velocities of now [rad/s], (n,).
 *     before: Velocities of the period before [rad/s], (n,).
 *     limits: Constants of the acceleration and jerk limits, (6 n,).
 *     dt: Control period [s].
 *     cubic: Whether a jerk is limited.
 *
 * Returns:
 *     M, 0 at rest; inf if no number is enough.
 *
 * iiwa_dnn/control/stopping.py: least_periods */
static double control_stopping_least_periods(struct arena *arena, Vector x, Vector before, Vector limits, double dt, bool cubic)
{
    Vector accelerations;
    Vector jerks;
    double periods;
    int64_t fewest;
    int64_t i;
    #line 109 "iiwa_dnn/control/stopping.py"
    #line 123 "iiwa_dnn/control/stopping.py"
    accelerations = ((Vector){limits.data + (3 * (x.size0)), (4 * (x.size0)) - (3 * (x.size0))});
    #line 124 "iiwa_dnn/control/stopping.py"
    jerks = ((Vector){limits.data + (4 * (x.size0)), (5 * (x.size0)) - (4 * (x.size0))});
    #line 125 "iiwa_dnn/control/stopping.py"
    periods = 0.0;
    #line 126 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0, end_i = (x.size0); i < end_i; i++) {
        #line 127 "iiwa_dnn/control/stopping.py"
        fewest = (int64_t)ceil((((double)fabs(x.data[i]) / (accelerations.data[i] * dt)) * (1.0 - 1e-09)));
        #line 128 "iiwa_dnn/control/stopping.py"
        periods = double_max(periods, fewest);
    }
    #line 129 "iiwa_dnn/control/stopping.py"
    i = 0;
    #line 130 "iiwa_dnn/control/stopping.py"
    while ((cubic) && (i < (x.size0))) {
        #line 131 "iiwa_dnn/control/stopping.py"
        if (periods > 1000000.0) {
            #line 132 "iiwa_dnn/control/stopping.py"
            return INFINITY;
        }
        #line 133 "iiwa_dnn/control/stopping.py"
        if (control_stopping_within_rates(arena, x.data[i], before.data[i], periods, (accelerations.data[i] * dt), ((jerks.data[i] * dt) * dt))) {
            #line 134 "iiwa_dnn/control/stopping.py"
            i += 1;
        }
        else {
            #line 136 "iiwa_dnn/control/stopping.py"
            periods = double_max(1.0, (int64_t)ceil((1.1 * periods)));
            #line 137 "iiwa_dnn/control/stopping.py"
            i = 0;
        }
    }
    #line 138 "iiwa_dnn/control/stopping.py"
    return periods;
}

/* Test whether a cubic keeps its limits per period of acceleration and jerk [rad/s].
 *
 * iiwa_dnn/control/stopping.py: within_rates */
static bool control_stopping_within_rates(struct arena *arena, double x, double before, double periods, double accel, double jerk)
{
    double b;
    double u;
    double largest;
    double most;
    double turn;
    double at;
    double steepest;
    #line 143 "iiwa_dnn/control/stopping.py"
    #line 144 "iiwa_dnn/control/stopping.py"
    if (periods < 0.5) {
        #line 145 "iiwa_dnn/control/stopping.py"
        return ((x == 0.0) && (before == 0.0));
    }
    #line 146 "iiwa_dnn/control/stopping.py"
    b = control_stopping_bend_of(arena, x, before, periods);
    #line 147 "iiwa_dnn/control/stopping.py"
    u = ((double)1.0 / periods);
    #line 149 "iiwa_dnn/control/stopping.py"
    largest = double_max(fabs(((6.0 * x) + (4.0 * b))), fabs(((x * (6.0 - (12.0 * u))) + (b * (2.0 - (6.0 * u))))));
    #line 150 "iiwa_dnn/control/stopping.py"
    largest = double_max(largest, fabs(((x * (3.0 - (2.0 * u))) + (b * (1.0 - u)))));
    #line 151 "iiwa_dnn/control/stopping.py"
    if (((largest * u) * u) > (jerk * (1.0 + 1e-09))) {
        #line 152 "iiwa_dnn/control/stopping.py"
        return false;
    }
    #line 153 "iiwa_dnn/control/stopping.py"
    most = (accel * (1.0 + 1e-09));
    #line 154 "iiwa_dnn/control/stopping.py"
    turn = ((12.0 * x) + (6.0 * b));
    #line 155 "iiwa_dnn/control/stopping.py"
    at = ((turn != 0.0) ? ((double)((6.0 * x) + (4.0 * b)) / turn) : 0.0);
    #line 156 "iiwa_dnn/control/stopping.py"
    steepest = (fabs((((((-6.0) * x) * at) * (1.0 - at)) + ((b * (1.0 - at)) * (1.0 - (3.0 * at))))) * u);
    #line 157 "iiwa_dnn/control/stopping.py"
    if ((u <= at && at < 1.0) && (steepest > most)) {
        #line 158 "iiwa_dnn/control/stopping.py"
        return false;
    }
    #line 159 "iiwa_dnn/control/stopping.py"
    return (fabs((control_stopping_next_velocity(arena, x, before, periods, true) - x)) <= most);
}

/* Compute b of the cubic through x now and x before, which ends after so many periods.
 *
 * iiwa_dnn/control/stopping.py: bend_of */
static double control_stopping_bend_of(struct arena *arena, double x, double before, double periods)
{
    (void)arena;
    double u;
    #line 84 "iiwa_dnn/control/stopping.py"
    #line 85 "iiwa_dnn/control/stopping.py"
    u = ((double)1.0 / periods);
    #line 86 "iiwa_dnn/control/stopping.py"
    return ((double)((x * ((1.0 - ((3.0 * u) * u)) - (((2.0 * u) * u) * u))) - before) / ((u * (1.0 + u)) * (1.0 + u)));
}

/* Compute the velocity after the first of so many periods on the way to zero [rad/s].
 *
 * iiwa_dnn/control/stopping.py: next_velocity */
static double control_stopping_next_velocity(struct arena *arena, double x, double before, double periods, bool cubic)
{
    double b;
    #line 100 "iiwa_dnn/control/stopping.py"
    #line 101 "iiwa_dnn/control/stopping.py"
    if (periods < 1.5) {
        #line 102 "iiwa_dnn/control/stopping.py"
        return 0.0;
    }
    #line 103 "iiwa_dnn/control/stopping.py"
    b = ((cubic) ? control_stopping_bend_of(arena, x, before, periods) : 0.0);
    #line 104 "iiwa_dnn/control/stopping.py"
    return control_stopping_velocity_at(arena, x, b, ((double)1.0 / periods), cubic);
}

/* Compute the velocity [rad/s] at a part u of the periods of a motion that begins with x.
 *
 * iiwa_dnn/control/stopping.py: velocity_at */
static double control_stopping_velocity_at(struct arena *arena, double x, double b, double u, bool cubic)
{
    (void)arena;
    double left;
    #line 91 "iiwa_dnn/control/stopping.py"
    #line 92 "iiwa_dnn/control/stopping.py"
    left = (1.0 - u);
    #line 93 "iiwa_dnn/control/stopping.py"
    if (!cubic) {
        #line 94 "iiwa_dnn/control/stopping.py"
        return (x * left);
    }
    #line 95 "iiwa_dnn/control/stopping.py"
    return ((left * left) * ((x * (1.0 + (2.0 * u))) + (b * u)));
}

/* Replace the wanted velocity x (n,) by the next command of joints that hurry to it.
 *
 * Each joint goes as quickly as its limits allow, without passing a velocity that goes on changing
 * as it has done since the last step.
 *
 * iiwa_dnn/control/yielding.py: _step_towards */
static void control_yielding_step_towards(struct arena *arena, const layout_QPViews *limits, Matrix past, const relaxed_Yielding *yielding, Vector x)
{
    int64_t dof;
    double most;
    double change;
    double behind;
    double rate;
    #line 332 "iiwa_dnn/control/yielding.py"
    #line 337 "iiwa_dnn/control/yielding.py"
    dof = past.size1;
    #line 338 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = dof; i < end_i; i++) {
        #line 339 "iiwa_dnn/control/yielding.py"
        most = ((*yielding).limits.data[((3 * dof) + i)] * (*yielding).dt);
        #line 340 "iiwa_dnn/control/yielding.py"
        change = double_min(double_max((x.data[i] - past.data[3 * past.size1 + i]), (-most)), most);
        #line 341 "iiwa_dnn/control/yielding.py"
        behind = (past.data[1 * past.size1 + i] - (x.data[i] - change));
        #line 342 "iiwa_dnn/control/yielding.py"
        rate = (*yielding).limits.data[((4 * dof) + i)];
        #line 343 "iiwa_dnn/control/yielding.py"
        x.data[i] += schemes_limits_braking(arena, behind, ((*limits).lb.data[i] - x.data[i]), ((*limits).ub.data[i] - x.data[i]), rate, (*yielding).dt);
    }
    return;
}

/* Bring a command x (n,) nearer to the braking motion in hand until the arm can stop from it.
 *
 * Returns:
 *     Periods until it rests; 0 where none is asked for.
 *
 * iiwa_dnn/control/yielding.py: _make_stoppable */
static double control_yielding_make_stoppable(struct arena *arena, const layout_QPViews *limits, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, const command_RowViews *views, Vector x)
{
    int64_t dof;
    double rest;
    Vector wanted;
    Vector brake;
    double left;
    const struct arena mark = *arena;
    #line 370 "iiwa_dnn/control/yielding.py"
    #line 375 "iiwa_dnn/control/yielding.py"
    dof = past.size1;
    #line 376 "iiwa_dnn/control/yielding.py"
    rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){x.data, dof - 0}));
    #line 377 "iiwa_dnn/control/yielding.py"
    if (rest >= 0.0) {
        #line 378 "iiwa_dnn/control/yielding.py"
        const double own_result = rest;
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 379 "iiwa_dnn/control/yielding.py"
    wanted = ((Vector){arena_copy(arena, ((Vector){(*views).point.data, (x.size0) - 0}).data, ((Vector){(*views).point.data, (x.size0) - 0}).size0), ((Vector){(*views).point.data, (x.size0) - 0}).size0});
    #line 380 "iiwa_dnn/control/yielding.py"
    if (((*yielding).limits.size0)) {
        #line 381 "iiwa_dnn/control/yielding.py"
        control_yielding_step_straight(arena, past, &(*yielding), wanted);
        #line 382 "iiwa_dnn/control/yielding.py"
        control_relaxed_nearest_within(arena, &(*limits), wanted, &(*yielding), (*views).figures);
    }
    #line 383 "iiwa_dnn/control/yielding.py"
    brake = ((Vector){arena_zeros(arena, (x.size0)), (x.size0)});
    #line 384 "iiwa_dnn/control/yielding.py"
    left = control_yielding_brake(arena, &(*limits), past, &(*yielding), brake);
    #line 385 "iiwa_dnn/control/yielding.py"
    for (int64_t k = 0, end_k = ((Vector){(double *)yielding_TOWARDS, 4}).size0; k < end_k; k++) {
        #line 386 "iiwa_dnn/control/yielding.py"
        for (int64_t i = 0, end_i = dof; i < end_i; i++) {
            #line 387 "iiwa_dnn/control/yielding.py"
            x.data[i] = (brake.data[i] + (((Vector){(double *)yielding_TOWARDS, 4}).data[k] * (wanted.data[i] - brake.data[i])));
        }
        #line 388 "iiwa_dnn/control/yielding.py"
        rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){x.data, dof - 0}));
        #line 389 "iiwa_dnn/control/yielding.py"
        if (rest >= 0.0) {
            #line 390 "iiwa_dnn/control/yielding.py"
            const double own_result = rest;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 391 "iiwa_dnn/control/yielding.py"
    if ((!(*yielding).coupled) && (control_yielding_go_away(arena, &(*limits), ((Vector){past.data + 1 * past.size1, past.size1}), ((Vector){x.data, dof - 0})))) {
        #line 392 "iiwa_dnn/control/yielding.py"
        rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){x.data, dof - 0}));
        #line 393 "iiwa_dnn/control/yielding.py"
        if (rest >= 0.0) {
            #line 394 "iiwa_dnn/control/yielding.py"
            const double own_result = rest;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 395 "iiwa_dnn/control/yielding.py"
    control_relaxed_copied(arena, x, brake);
    #line 396 "iiwa_dnn/control/yielding.py"
    const double own_result = left;
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the next command (n,) of the braking motion in hand, or of the quickest one.
 *
 * It is zero without acceleration limits.
 *
 * Returns:
 *     Periods that are left afterwards; 0 if the motion was not in hand.
 *
 * iiwa_dnn/control/yielding.py: _brake */
static double control_yielding_brake(struct arena *arena, const layout_QPViews *limits, Matrix past, const relaxed_Yielding *yielding, Vector dq)
{
    double rest;
    double periods;
    #line 432 "iiwa_dnn/control/yielding.py"
    #line 439 "iiwa_dnn/control/yielding.py"
    for (int64_t own_k = 0, own_end = ((Vector){dq.data, dq.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){dq.data, dq.size0 - 0}).data[own_k] = 0.0;
    #line 440 "iiwa_dnn/control/yielding.py"
    if (((*yielding).limits.size0) == 0) {
        #line 441 "iiwa_dnn/control/yielding.py"
        return 0.0;
    }
    #line 442 "iiwa_dnn/control/yielding.py"
    rest = past.data[4 * past.size1];
    #line 443 "iiwa_dnn/control/yielding.py"
    periods = rest;
    #line 444 "iiwa_dnn/control/yielding.py"
    if (rest == 0.0) {
        #line 445 "iiwa_dnn/control/yielding.py"
        periods = control_stopping_least_periods(arena, ((Vector){past.data + 1 * past.size1, past.size1}), ((Vector){past.data + 2 * past.size1, past.size1}), (*yielding).limits, (*yielding).dt, (*yielding).cubic);
    }
    #line 448 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = past.size1; i < end_i; i++) {
        #line 449 "iiwa_dnn/control/yielding.py"
        if (periods < INFINITY) {
            #line 450 "iiwa_dnn/control/yielding.py"
            dq.data[i] = control_stopping_next_velocity(arena, past.data[1 * past.size1 + i], past.data[2 * past.size1 + i], periods, (*yielding).cubic);
        }
        #line 451 "iiwa_dnn/control/yielding.py"
        if (rest == 0.0) {
            #line 452 "iiwa_dnn/control/yielding.py"
            dq.data[i] = double_min(double_max(dq.data[i], (*limits).lb.data[i]), (*limits).ub.data[i]);
        }
    }
    #line 453 "iiwa_dnn/control/yielding.py"
    return double_max((rest - 1.0), 0.0);
}

/* Write the command dq (dof,) that goes straight away from what is too near.
 *
 * A row stands for the nearest point of a link. Where the link lies along an obstacle, what the
 * softened program asks for may lead another of its points nearer, and would hold the arm there.
 * The arm sets off along the rows' gradients, and goes on in the direction of its last command.
 *
 * Returns:
 *     False if no row asks for a retreat, or the bounds allow none in that direction.
 *
 * iiwa_dnn/control/yielding.py: _go_away */
static bool control_yielding_go_away(struct arena *arena, const layout_QPViews *limits, Vector last, Vector dq)
{
    bool rests;
    int64_t near;
    double least;
    double most;
    #line 401 "iiwa_dnn/control/yielding.py"
    #line 410 "iiwa_dnn/control/yielding.py"
    rests = (control_relaxed_largest_entry(arena, last) == 0.0);
    #line 411 "iiwa_dnn/control/yielding.py"
    near = 0;
    #line 412 "iiwa_dnn/control/yielding.py"
    control_relaxed_copied(arena, dq, last);
    #line 413 "iiwa_dnn/control/yielding.py"
    for (int64_t j = 0, end_j = ((*limits).h.size0); j < end_j; j++) {
        #line 414 "iiwa_dnn/control/yielding.py"
        if ((*limits).h.data[j] < (-1e-09)) {
            #line 415 "iiwa_dnn/control/yielding.py"
            near += 1;
            #line 416 "iiwa_dnn/control/yielding.py"
            qp_dense_add_row(arena, dq, ((-1.0) * rests), (*limits).G, j);
        }
    }
    #line 417 "iiwa_dnn/control/yielding.py"
    least = 0.0;
    #line 418 "iiwa_dnn/control/yielding.py"
    most = INFINITY;
    #line 419 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = (dq.size0); i < end_i; i++) {
        #line 420 "iiwa_dnn/control/yielding.py"
        if (dq.data[i] != 0.0) {
            #line 421 "iiwa_dnn/control/yielding.py"
            least = double_max(least, double_min(((double)(*limits).lb.data[i] / dq.data[i]), ((double)(*limits).ub.data[i] / dq.data[i])));
            #line 422 "iiwa_dnn/control/yielding.py"
            most = double_min(most, double_max(((double)(*limits).lb.data[i] / dq.data[i]), ((double)(*limits).ub.data[i] / dq.data[i])));
        }
    }
    #line 423 "iiwa_dnn/control/yielding.py"
    if ((near == 0) || (!(least <= most && most < INFINITY))) {
        #line 424 "iiwa_dnn/control/yielding.py"
        return false;
    }
    #line 425 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = (dq.size0); i < end_i; i++) {
        #line 426 "iiwa_dnn/control/yielding.py"
        dq.data[i] *= most;
    }
    #line 427 "iiwa_dnn/control/yielding.py"
    return true;
}

/* Note the joints whose command dq (dof,) is short of the answer; return how many are.
 *
 * iiwa_dnn/control/yielding.py: _note_missing */
static int64_t control_yielding_note_missing(struct arena *arena, const command_RowViews *views, Vector dq)
{
    (void)arena;
    int64_t count;
    double missing;
    #line 290 "iiwa_dnn/control/yielding.py"
    #line 291 "iiwa_dnn/control/yielding.py"
    count = 0;
    #line 292 "iiwa_dnn/control/yielding.py"
    for (int64_t i = 0, end_i = (dq.size0); i < end_i; i++) {
        #line 293 "iiwa_dnn/control/yielding.py"
        missing = ((*views).point.data[i] - dq.data[i]);
        #line 294 "iiwa_dnn/control/yielding.py"
        if (fabs(missing) > 1e-09) {
            #line 295 "iiwa_dnn/control/yielding.py"
            (*views).blocking.data[i] = copysign(1.0, missing);
            #line 296 "iiwa_dnn/control/yielding.py"
            count += 1;
        }
    }
    #line 297 "iiwa_dnn/control/yielding.py"
    return count;
}

/* Note the action, how far the reference's clock advances, status and kind of the program.
 *
 * Args:
 *     views: The step's row.
 *     own: The step's own program.
 *     weights: Weights of its task rows, (p,).
 *     x: The command, (n,).
 *     kind: Kind of the program that was answered.
 *     factor: Scaling factor of the task in it.
 *     action: Action that the policy asks for.
 *
 * iiwa_dnn/control/yielding.py: _note_decision */
static void control_yielding_note_decision(struct arena *arena, const command_RowViews *views, const layout_QPViews *own, Vector weights, Vector x, int64_t kind, double factor, int64_t action)
{
    int64_t taken;
    double fraction;
    #line 192 "iiwa_dnn/control/yielding.py"
    #line 203 "iiwa_dnn/control/yielding.py"
    taken = 4;
    #line 204 "iiwa_dnn/control/yielding.py"
    fraction = 0.0;
    #line 205 "iiwa_dnn/control/yielding.py"
    if (kind <= 1) {
        #line 206 "iiwa_dnn/control/yielding.py"
        taken = ((factor == 1.0) ? 0 : 2);
        #line 207 "iiwa_dnn/control/yielding.py"
        fraction = factor;
    }
    else {
        #line 208 "iiwa_dnn/control/yielding.py"
        if (kind != 4) {
            #line 209 "iiwa_dnn/control/yielding.py"
            taken = (((kind == 3) || (control_yielding_is_path(arena, (*views).targets))) ? action : 3);
            #line 210 "iiwa_dnn/control/yielding.py"
            fraction = 1.0;
            #line 211 "iiwa_dnn/control/yielding.py"
            if (taken == 2) {
                #line 212 "iiwa_dnn/control/yielding.py"
                fraction = double_max(control_relaxed_attained(arena, (*own).b, (*own).A, weights, x), 0.1);
            }
        }
    }
    #line 213 "iiwa_dnn/control/yielding.py"
    (*views).decision.data[0] = taken;
    #line 214 "iiwa_dnn/control/yielding.py"
    (*views).decision.data[1] = fraction;
    #line 215 "iiwa_dnn/control/yielding.py"
    (*views).decision.data[2] = ((taken == 4) ? double_max((*views).decision.data[2], (double)(2)) : 0);
    #line 216 "iiwa_dnn/control/yielding.py"
    (*views).decision.data[3] = kind;
    return;
}

/* Sum the velocities of a motion with x and b over its first `count` periods of dt [s].
 *
 * iiwa_dnn/control/stopping.py: way_along */
static double control_stopping_way_along(struct arena *arena, const stopping_Motion *motion, double x, double b, double count, double dt)
{
    (void)arena;
    double M;
    double first;
    double second;
    double third;
    #line 164 "iiwa_dnn/control/stopping.py"
    #line 165 "iiwa_dnn/control/stopping.py"
    M = double_max((*motion).periods, 1.0);
    #line 166 "iiwa_dnn/control/stopping.py"
    first = ((double)((0.5 * count) * (count - 1.0)) / M);
    #line 167 "iiwa_dnn/control/stopping.py"
    if (!(*motion).cubic) {
        #line 168 "iiwa_dnn/control/stopping.py"
        return ((dt * x) * (count - first));
    }
    #line 169 "iiwa_dnn/control/stopping.py"
    second = ((double)(first * ((2.0 * count) - 1.0)) / (3.0 * M));
    #line 170 "iiwa_dnn/control/stopping.py"
    third = ((double)(first * first) / M);
    #line 171 "iiwa_dnn/control/stopping.py"
    return (dt * ((x * ((count - (3.0 * second)) + (2.0 * third))) + (b * ((first - (2.0 * second)) + third))));
}

/* Compute the least way along a motion with x and b; at its start the way is zero.
 *
 * iiwa_dnn/control/stopping.py: least_way */
static double control_stopping_least_way(struct arena *arena, const stopping_Motion *motion, double x, double b, double dt)
{
    double M;
    double least;
    double turn;
    #line 176 "iiwa_dnn/control/stopping.py"
    #line 177 "iiwa_dnn/control/stopping.py"
    M = (*motion).periods;
    #line 178 "iiwa_dnn/control/stopping.py"
    least = double_min(0.0, control_stopping_way_along(arena, &(*motion), x, b, M, dt));
    #line 179 "iiwa_dnn/control/stopping.py"
    turn = ((2.0 * x) + b);
    #line 180 "iiwa_dnn/control/stopping.py"
    if (((*motion).cubic) && ((x * turn) < 0.0)) {
        #line 181 "iiwa_dnn/control/stopping.py"
        least = double_min(least, control_stopping_way_along(arena, &(*motion), x, b, double_min((int64_t)ceil((((double)(-x) / turn) * M)), M), dt));
    }
    #line 182 "iiwa_dnn/control/stopping.py"
    return least;
}

/* Test whether the joints go straight on to where they rest.
 *
 * Their velocities keep direction and sign where b is c times the first one with c >= -3.
 *
 * iiwa_dnn/control/stopping.py: is_straight */
static bool control_stopping_is_straight(struct arena *arena, const stopping_Motion *motion)
{
    (void)arena;
    double fastest;
    double factor;
    double lacking;
    #line 187 "iiwa_dnn/control/stopping.py"
    #line 191 "iiwa_dnn/control/stopping.py"
    fastest = 0.0;
    #line 192 "iiwa_dnn/control/stopping.py"
    factor = 0.0;
    #line 193 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0, end_i = ((*motion).first.size0); i < end_i; i++) {
        #line 194 "iiwa_dnn/control/stopping.py"
        if (fabs((*motion).first.data[i]) > fastest) {
            #line 195 "iiwa_dnn/control/stopping.py"
            fastest = fabs((*motion).first.data[i]);
            #line 196 "iiwa_dnn/control/stopping.py"
            factor = ((double)(*motion).bend.data[i] / (*motion).first.data[i]);
        }
    }
    #line 197 "iiwa_dnn/control/stopping.py"
    lacking = 0.0;
    #line 198 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0, end_i = ((*motion).first.size0); i < end_i; i++) {
        #line 199 "iiwa_dnn/control/stopping.py"
        lacking = double_max(lacking, fabs(((*motion).bend.data[i] - (factor * (*motion).first.data[i]))));
    }
    #line 200 "iiwa_dnn/control/stopping.py"
    return ((fastest > 0.0) && (factor >= (-3.0)) && (lacking <= (1e-12 * fastest)));
}

/* Test whether joints at q (n,) [rad] keep position and velocity limits on a motion to rest.
 *
 * iiwa_dnn/control/stopping.py: keeps_joint_limits */
static bool control_stopping_keeps_joint_limits(struct arena *arena, const stopping_Motion *motion, Vector q, Vector limits, double dt)
{
    int64_t n;
    double x;
    double b;
    double top;
    double bottom;
    double steepest;
    double u;
    double fastest;
    #line 205 "iiwa_dnn/control/stopping.py"
    #line 206 "iiwa_dnn/control/stopping.py"
    n = (q.size0);
    #line 207 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 208 "iiwa_dnn/control/stopping.py"
        x = (*motion).first.data[i];
        #line 209 "iiwa_dnn/control/stopping.py"
        b = (*motion).bend.data[i];
        #line 210 "iiwa_dnn/control/stopping.py"
        top = (q.data[i] - control_stopping_least_way(arena, &(*motion), (-x), (-b), dt));
        #line 211 "iiwa_dnn/control/stopping.py"
        bottom = (q.data[i] + control_stopping_least_way(arena, &(*motion), x, b, dt));
        #line 213 "iiwa_dnn/control/stopping.py"
        if ((top > double_max(limits.data[(n + i)], q.data[i])) || (bottom < double_min(limits.data[i], q.data[i]))) {
            #line 214 "iiwa_dnn/control/stopping.py"
            return false;
        }
        #line 215 "iiwa_dnn/control/stopping.py"
        steepest = ((6.0 * x) + (3.0 * b));
        #line 216 "iiwa_dnn/control/stopping.py"
        u = ((steepest != 0.0) ? ((double)b / steepest) : 0.0);
        #line 217 "iiwa_dnn/control/stopping.py"
        fastest = (limits.data[((2 * n) + i)] * (1.0 + 1e-09));
        #line 218 "iiwa_dnn/control/stopping.py"
        if ((0.0 < u && u < 1.0) && (fabs(control_stopping_velocity_at(arena, x, b, u, true)) > fastest)) {
            #line 219 "iiwa_dnn/control/stopping.py"
            return false;
        }
        #line 220 "iiwa_dnn/control/stopping.py"
        if ((limits.data[((5 * n) + i)] < limits.data[((3 * n) + i)]) && (!control_stopping_keeps_ramp(arena, &(*motion), q, limits, dt, i))) {
            #line 221 "iiwa_dnn/control/stopping.py"
            return false;
        }
    }
    #line 222 "iiwa_dnn/control/stopping.py"
    return true;
}

/* Test whether joint i of those at q (n,) [rad] has room to brake all along a motion to rest.
 *
 * Its velocity limit shrinks towards its position limits: elsewhere it may brake harder than its
 * deceleration, there not later.
 *
 * iiwa_dnn/control/stopping.py: keeps_ramp */
static bool control_stopping_keeps_ramp(struct arena *arena, const stopping_Motion *motion, Vector q, Vector limits, double dt, int64_t i)
{
    int64_t n;
    double at;
    double x;
    double left;
    #line 227 "iiwa_dnn/control/stopping.py"
    #line 232 "iiwa_dnn/control/stopping.py"
    n = (q.size0);
    #line 233 "iiwa_dnn/control/stopping.py"
    at = q.data[i];
    #line 234 "iiwa_dnn/control/stopping.py"
    for (int64_t k = 0, end_k = (int64_t)((*motion).periods); k < end_k; k++) {
        #line 235 "iiwa_dnn/control/stopping.py"
        x = control_stopping_velocity_at(arena, (*motion).first.data[i], (*motion).bend.data[i], ((double)k / (*motion).periods), (*motion).cubic);
        #line 236 "iiwa_dnn/control/stopping.py"
        left = ((x > 0.0) ? (limits.data[(n + i)] - at) : (at - limits.data[i]));
        #line 237 "iiwa_dnn/control/stopping.py"
        if ((x * x) > (((2.0 * limits.data[((5 * n) + i)]) * double_max(left, 0.0)) * (1.0 + 1e-09))) {
            #line 238 "iiwa_dnn/control/stopping.py"
            return false;
        }
        #line 239 "iiwa_dnn/control/stopping.py"
        at += (dt * x);
    }
    #line 240 "iiwa_dnn/control/stopping.py"
    return true;
}

/* Test whether all pairs of a scene keep their distance on a motion to rest.
 *
 * A pair that is too near, or that a moving obstacle comes too near while the arm brakes, must not
 * come nearer by the arm's own motion.
 *
 * Args:
 *     motion: The motion.
 *     arrays: Arrays of the loop, with the kinematics at its beginning.
 *     constants: `Scene.constants`, (k,).
 *     dt: Control period [s].
 *
 * iiwa_dnn/control/stopping.py: keeps_distances */
static bool control_stopping_keeps_distances(struct arena *arena, const stopping_Motion *motion, const program_ProgramArrays *arrays, Vector constants, double dt)
{
    int64_t n;
    scene_SceneViews scene;
    Matrix placed;
    bool straight;
    double M;
    Vector travel;
    scene_Contact contact;
    double left;
    double most;
    double change;
    double lacking;
    double_3_2 ends;
    double_3 end;
    double x;
    double bend;
    double way;
    double least;
    double height;
    const struct arena mark = *arena;
    #line 245 "iiwa_dnn/control/stopping.py"
    #line 256 "iiwa_dnn/control/stopping.py"
    n = ((*motion).first.size0);
    #line 257 "iiwa_dnn/control/stopping.py"
    scene = schemes_scene_scene_views(arena, constants, n);
    #line 258 "iiwa_dnn/control/stopping.py"
    placed = ((Matrix){arena_empty(arena, scene.bodies.size0 * 12), scene.bodies.size0, 12});
    #line 259 "iiwa_dnn/control/stopping.py"
    schemes_scene_place_bodies(arena, &scene, (*arrays).placements, placed);
    #line 260 "iiwa_dnn/control/stopping.py"
    straight = control_stopping_is_straight(arena, &(*motion));
    #line 261 "iiwa_dnn/control/stopping.py"
    M = (*motion).periods;
    #line 262 "iiwa_dnn/control/stopping.py"
    travel = ((Vector){arena_empty(arena, n), n});
    #line 263 "iiwa_dnn/control/stopping.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 264 "iiwa_dnn/control/stopping.py"
        travel.data[i] = control_stopping_way_along(arena, &(*motion), fabs((*motion).first.data[i]), fabs((*motion).bend.data[i]), M, dt);
    }
    #line 265 "iiwa_dnn/control/stopping.py"
    for (int64_t k = 0, end_k = scene.pairs.size0; k < end_k; k++) {
        #line 266 "iiwa_dnn/control/stopping.py"
        contact = schemes_scene_contact_of(arena, &scene, k, placed);
        #line 267 "iiwa_dnn/control/stopping.py"
        left = (contact.distance - ((scene.pairs.data[k * scene.pairs.size1] * dt) * M));
        #line 268 "iiwa_dnn/control/stopping.py"
        most = 0.0;
        #line 269 "iiwa_dnn/control/stopping.py"
        for (int64_t i = 0, end_i = n; i < end_i; i++) {
            #line 270 "iiwa_dnn/control/stopping.py"
            most += (fabs(scene.radii.data[k * scene.radii.size1 + i]) * travel.data[i]);
        }
        #line 271 "iiwa_dnn/control/stopping.py"
        if ((left - most) >= scene.least) {
            #line 272 "iiwa_dnn/control/stopping.py"
            continue;
        }
        #line 273 "iiwa_dnn/control/stopping.py"
        change = INFINITY;
        #line 274 "iiwa_dnn/control/stopping.py"
        lacking = (0.5 * schemes_scene_second_order(arena, scene.moves, scene.radii, k, travel));
        #line 275 "iiwa_dnn/control/stopping.py"
        ends = schemes_scene_ends_of(arena, &scene, placed, (int64_t)(scene.pairs.data[k * scene.pairs.size1 + 1]));
        #line 276 "iiwa_dnn/control/stopping.py"
        for (int64_t at = 0, end_at = 2; at < end_at; at++) {
            #line 277 "iiwa_dnn/control/stopping.py"
            end = ends.at[at];
            #line 278 "iiwa_dnn/control/stopping.py"
            const double_2 own_47 = control_stopping_along(arena, &(*motion), (*arrays).jacobian, scene.moves, k, end, contact.normal);
            x = own_47.at[0];
            bend = own_47.at[1];
            #line 279 "iiwa_dnn/control/stopping.py"
            way = control_stopping_way_along(arena, &(*motion), x, bend, M, dt);
            #line 280 "iiwa_dnn/control/stopping.py"
            least = double_min(0.0, (way - lacking));
            #line 281 "iiwa_dnn/control/stopping.py"
            if (!straight) {
                #line 282 "iiwa_dnn/control/stopping.py"
                least = (control_stopping_least_way(arena, &(*motion), x, bend, dt) - lacking);
            }
            #line 284 "iiwa_dnn/control/stopping.py"
            height = double_max(0.0, references_rotations_dot(arena, references_rotations_combined(arena, 1.0, end, (-1.0), contact.second), contact.normal));
            #line 285 "iiwa_dnn/control/stopping.py"
            change = double_min(change, (height + least));
        }
        #line 286 "iiwa_dnn/control/stopping.py"
        if ((left + change) < double_min(scene.least, left)) {
            #line 287 "iiwa_dnn/control/stopping.py"
            const bool own_result = false;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 288 "iiwa_dnn/control/stopping.py"
    const bool own_result = true;
    arena_leave(arena, &mark);
    return own_result;
}

/* Make the views of a scene's constants (k,) for a robot of `dof` joints.
 *
 * iiwa_dnn/schemes/scene.py: scene_views */
static scene_SceneViews schemes_scene_scene_views(struct arena *arena, Vector constants, int64_t dof)
{
    (void)arena;
    int64_t bodies;
    int64_t pairs;
    int64_t at_bodies;
    int64_t at_pairs;
    int64_t at_moves;
    int64_t at_radii;
    #line 282 "iiwa_dnn/schemes/scene.py"
    #line 283 "iiwa_dnn/schemes/scene.py"
    bodies = (int64_t)(constants.data[2]);
    #line 284 "iiwa_dnn/schemes/scene.py"
    pairs = (int64_t)(constants.data[3]);
    #line 285 "iiwa_dnn/schemes/scene.py"
    at_bodies = (4 + dof);
    #line 286 "iiwa_dnn/schemes/scene.py"
    at_pairs = (at_bodies + (16 * bodies));
    #line 287 "iiwa_dnn/schemes/scene.py"
    at_moves = (at_pairs + (4 * pairs));
    #line 288 "iiwa_dnn/schemes/scene.py"
    at_radii = (at_moves + (dof * pairs));
    #line 289 "iiwa_dnn/schemes/scene.py"
    return ((scene_SceneViews){constants.data[0], constants.data[1], ((Vector){constants.data + 4, at_bodies - 4}), ((Matrix){((Vector){constants.data + at_bodies, at_pairs - at_bodies}).data, bodies, 16}), ((Matrix){((Vector){constants.data + at_pairs, at_moves - at_pairs}).data, pairs, 4}), ((Matrix){((Vector){constants.data + at_moves, at_radii - at_moves}).data, pairs, dof}), ((Matrix){((Vector){constants.data + at_radii, (at_radii + (dof * pairs)) - at_radii}).data, pairs, dof})});
}

/* Write the placements of all bodies in the world, (b, 12), for those of frames (k, 12).
 *
 * iiwa_dnn/schemes/scene.py: place_bodies */
static void schemes_scene_place_bodies(struct arena *arena, const scene_SceneViews *scene, Matrix placements, Matrix placed)
{
    (void)arena;
    Vector frame;
    double value;
    #line 315 "iiwa_dnn/schemes/scene.py"
    #line 316 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0, end_k = (*scene).bodies.size0; k < end_k; k++) {
        #line 317 "iiwa_dnn/schemes/scene.py"
        frame = ((Vector){placements.data + (int64_t)((*scene).bodies.data[k * (*scene).bodies.size1]) * placements.size1, placements.size1});
        #line 318 "iiwa_dnn/schemes/scene.py"
        for (int64_t i = 0, end_i = 12; i < end_i; i++) {
            #line 319 "iiwa_dnn/schemes/scene.py"
            value = ((i >= 9) ? frame.data[(9 + int_remainder(i, 3))] : 0.0);
            #line 320 "iiwa_dnn/schemes/scene.py"
            for (int64_t j = 0, end_j = 3; j < end_j; j++) {
                #line 321 "iiwa_dnn/schemes/scene.py"
                value += (frame.data[((3 * j) + int_remainder(i, 3))] * (*scene).bodies.data[k * (*scene).bodies.size1 + (((4 + i) - int_remainder(i, 3)) + j)]);
            }
            #line 322 "iiwa_dnn/schemes/scene.py"
            placed.data[k * placed.size1 + i] = value;
        }
    }
    return;
}

/* Compute the contact of pair k, for the placements of all bodies (b, 12).
 *
 * iiwa_dnn/schemes/scene.py: contact_of */
static scene_Contact schemes_scene_contact_of(struct arena *arena, const scene_SceneViews *scene, int64_t k, Matrix placed)
{
    int64_t first;
    Vector base;
    double_3 half;
    double_3 a;
    double_3 b;
    double_3 way;
    double_3 start;
    double_3 along;
    double s;
    double_3 nearest;
    double_3 side;
    double core;
    double_3 normal;
    double x;
    double y;
    double z;
    double_3 outward;
    double_3 point;
    double_3 other;
    #line 336 "iiwa_dnn/schemes/scene.py"
    #line 337 "iiwa_dnn/schemes/scene.py"
    first = (int64_t)((*scene).pairs.data[k * (*scene).pairs.size1 + 2]);
    #line 338 "iiwa_dnn/schemes/scene.py"
    base = ((Vector){placed.data + first * placed.size1, placed.size1});
    #line 339 "iiwa_dnn/schemes/scene.py"
    half = schemes_step_vector_at(arena, ((Vector){(*scene).bodies.data + first * (*scene).bodies.size1, (*scene).bodies.size1}), 1);
    #line 340 "iiwa_dnn/schemes/scene.py"
    const double_3_2 own_8 = schemes_scene_ends_of(arena, &(*scene), placed, (int64_t)((*scene).pairs.data[k * (*scene).pairs.size1 + 1]));
    a = own_8.at[0];
    b = own_8.at[1];
    #line 341 "iiwa_dnn/schemes/scene.py"
    way = references_rotations_combined(arena, 1.0, b, (-1.0), a);
    #line 342 "iiwa_dnn/schemes/scene.py"
    start = schemes_step_seen_from(arena, base, references_rotations_combined(arena, 1.0, a, (-1.0), schemes_step_vector_at(arena, base, 9)));
    #line 343 "iiwa_dnn/schemes/scene.py"
    along = schemes_step_seen_from(arena, base, way);
    #line 344 "iiwa_dnn/schemes/scene.py"
    s = schemes_scene_nearest_parameter(arena, start, along, half);
    #line 345 "iiwa_dnn/schemes/scene.py"
    nearest = references_rotations_combined(arena, 1.0, start, s, along);
    #line 346 "iiwa_dnn/schemes/scene.py"
    side = schemes_scene_beyond(arena, nearest, half);
    #line 347 "iiwa_dnn/schemes/scene.py"
    core = sqrt(references_rotations_dot(arena, side, side));
    #line 348 "iiwa_dnn/schemes/scene.py"
    if (core > 1e-09) {
        #line 349 "iiwa_dnn/schemes/scene.py"
        normal = ((double_3){{((double)side.at[0] / core), ((double)side.at[1] / core), ((double)side.at[2] / core)}});
    }
    else {
        #line 351 "iiwa_dnn/schemes/scene.py"
        const double_4 own_31 = schemes_scene_depth(arena, nearest, half);
        core = own_31.at[0];
        x = own_31.at[1];
        y = own_31.at[2];
        z = own_31.at[3];
        #line 352 "iiwa_dnn/schemes/scene.py"
        normal = ((double_3){{x, y, z}});
    }
    #line 353 "iiwa_dnn/schemes/scene.py"
    outward = schemes_step_axis_at(arena, base, normal);
    #line 354 "iiwa_dnn/schemes/scene.py"
    point = references_rotations_combined(arena, 1.0, a, s, way);
    #line 355 "iiwa_dnn/schemes/scene.py"
    other = references_rotations_combined(arena, 1.0, point, (-core), outward);
    #line 356 "iiwa_dnn/schemes/scene.py"
    return ((scene_Contact){point, other, outward, (core - (*scene).pairs.data[k * (*scene).pairs.size1 + 3])});
}

/* Return three numbers of an array (k,), from an index on.
 *
 * iiwa_dnn/schemes/step.py: vector_at */
static double_3 schemes_step_vector_at(struct arena *arena, Vector array, int64_t start)
{
    (void)arena;
    #line 134 "iiwa_dnn/schemes/step.py"
    #line 135 "iiwa_dnn/schemes/step.py"
    return ((double_3){{array.data[start], array.data[(start + 1)], array.data[(start + 2)]}});
}

/* Return the ends of a segment among the bodies in the world [m], (3,) each.
 *
 * iiwa_dnn/schemes/scene.py: ends_of */
static double_3_2 schemes_scene_ends_of(struct arena *arena, const scene_SceneViews *scene, Matrix placed, int64_t body)
{
    double_3 center;
    double_3 axis;
    double half;
    #line 327 "iiwa_dnn/schemes/scene.py"
    #line 328 "iiwa_dnn/schemes/scene.py"
    center = schemes_step_vector_at(arena, ((Vector){placed.data + body * placed.size1, placed.size1}), 9);
    #line 329 "iiwa_dnn/schemes/scene.py"
    axis = schemes_step_vector_at(arena, ((Vector){placed.data + body * placed.size1, placed.size1}), 6);
    #line 330 "iiwa_dnn/schemes/scene.py"
    half = (*scene).bodies.data[body * (*scene).bodies.size1 + 3];
    #line 331 "iiwa_dnn/schemes/scene.py"
    return ((double_3_2){{references_rotations_combined(arena, 1.0, center, (-half), axis), references_rotations_combined(arena, 1.0, center, half, axis)}});
}

/* Compute a u + b v.
 *
 * iiwa_dnn/references/rotations.py: combined */
static double_3 references_rotations_combined(struct arena *arena, double a, double_3 u, double b, double_3 v)
{
    (void)arena;
    #line 62 "iiwa_dnn/references/rotations.py"
    #line 63 "iiwa_dnn/references/rotations.py"
    return ((double_3){{((a * u.at[0]) + (b * v.at[0])), ((a * u.at[1]) + (b * v.at[1])), ((a * u.at[2]) + (b * v.at[2]))}});
}

/* Turn a vector (3,) of the world into the coordinates of a placement (12,).
 *
 * iiwa_dnn/schemes/step.py: seen_from */
static double_3 schemes_step_seen_from(struct arena *arena, Vector placement, double_3 v)
{
    double x;
    double y;
    #line 147 "iiwa_dnn/schemes/step.py"
    #line 148 "iiwa_dnn/schemes/step.py"
    x = references_rotations_dot(arena, schemes_step_vector_at(arena, placement, 0), v);
    #line 149 "iiwa_dnn/schemes/step.py"
    y = references_rotations_dot(arena, schemes_step_vector_at(arena, placement, 3), v);
    #line 150 "iiwa_dnn/schemes/step.py"
    return ((double_3){{x, y, references_rotations_dot(arena, schemes_step_vector_at(arena, placement, 6), v)}});
}

/* Compute the s in [0, 1] of the point of a segment that is nearest to a box.
 *
 * Half the derivative of the squared distance grows with s: its root is found by regula falsi,
 * every third step of which halves.
 *
 * iiwa_dnn/schemes/scene.py: nearest_parameter */
static double schemes_scene_nearest_parameter(struct arena *arena, double_3 a, double_3 u, double_3 half)
{
    double low;
    double high;
    double below;
    double above;
    double share;
    double middle;
    double slope;
    #line 413 "iiwa_dnn/schemes/scene.py"
    #line 418 "iiwa_dnn/schemes/scene.py"
    low = 0.0;
    #line 419 "iiwa_dnn/schemes/scene.py"
    high = 1.0;
    #line 420 "iiwa_dnn/schemes/scene.py"
    below = references_rotations_dot(arena, u, schemes_scene_beyond(arena, a, half));
    #line 421 "iiwa_dnn/schemes/scene.py"
    above = references_rotations_dot(arena, u, schemes_scene_beyond(arena, references_rotations_combined(arena, 1.0, a, 1.0, u), half));
    #line 422 "iiwa_dnn/schemes/scene.py"
    if (below >= 0.0) {
        #line 423 "iiwa_dnn/schemes/scene.py"
        return low;
    }
    #line 424 "iiwa_dnn/schemes/scene.py"
    if (above <= 0.0) {
        #line 425 "iiwa_dnn/schemes/scene.py"
        return high;
    }
    #line 426 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0, end_k = 60; k < end_k; k++) {
        #line 427 "iiwa_dnn/schemes/scene.py"
        share = ((int_remainder(k, 3) == 2) ? 0.5 : ((double)below / (below - above)));
        #line 428 "iiwa_dnn/schemes/scene.py"
        middle = (low + (share * (high - low)));
        #line 429 "iiwa_dnn/schemes/scene.py"
        slope = references_rotations_dot(arena, u, schemes_scene_beyond(arena, references_rotations_combined(arena, 1.0, a, middle, u), half));
        #line 430 "iiwa_dnn/schemes/scene.py"
        if ((slope == 0.0) || (!(low < middle && middle < high))) {
            #line 431 "iiwa_dnn/schemes/scene.py"
            return middle;
        }
        #line 432 "iiwa_dnn/schemes/scene.py"
        if (slope < 0.0) {
            #line 433 "iiwa_dnn/schemes/scene.py"
            low = middle;
            #line 434 "iiwa_dnn/schemes/scene.py"
            below = slope;
        }
        else {
            #line 436 "iiwa_dnn/schemes/scene.py"
            high = middle;
            #line 437 "iiwa_dnn/schemes/scene.py"
            above = slope;
        }
    }
    #line 438 "iiwa_dnn/schemes/scene.py"
    return (0.5 * (low + high));
}

/* Return the way to a point from the nearest one of a box.
 *
 * iiwa_dnn/schemes/scene.py: beyond */
static double_3 schemes_scene_beyond(struct arena *arena, double_3 x, double_3 half)
{
    (void)arena;
    #line 403 "iiwa_dnn/schemes/scene.py"
    #line 404 "iiwa_dnn/schemes/scene.py"
    return ((double_3){{(x.at[0] - double_min(double_max(x.at[0], (-half.at[0])), half.at[0])), (x.at[1] - double_min(double_max(x.at[1], (-half.at[1])), half.at[1])), (x.at[2] - double_min(double_max(x.at[2], (-half.at[2])), half.at[2]))}});
}

/* Compute how far a point is from leaving a box by its nearest face, negative inside.
 *
 * Returns:
 *     The distance from the face, and the three components of the normal out of it.
 *
 * iiwa_dnn/schemes/scene.py: depth */
static double_4 schemes_scene_depth(struct arena *arena, double_3 x, double_3 half)
{
    (void)arena;
    double found;
    int64_t axis;
    double sign;
    #line 443 "iiwa_dnn/schemes/scene.py"
    #line 448 "iiwa_dnn/schemes/scene.py"
    found = (-1e+300);
    #line 449 "iiwa_dnn/schemes/scene.py"
    axis = 2;
    #line 450 "iiwa_dnn/schemes/scene.py"
    sign = 1.0;
    #line 451 "iiwa_dnn/schemes/scene.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 452 "iiwa_dnn/schemes/scene.py"
        if ((fabs(x.at[i]) - half.at[i]) > found) {
            #line 453 "iiwa_dnn/schemes/scene.py"
            found = (fabs(x.at[i]) - half.at[i]);
            #line 454 "iiwa_dnn/schemes/scene.py"
            sign = ((x.at[i] >= 0.0) ? 1.0 : (-1.0));
            #line 455 "iiwa_dnn/schemes/scene.py"
            axis = i;
        }
    }
    #line 456 "iiwa_dnn/schemes/scene.py"
    return ((double_4){{found, (sign * (axis == 0)), (sign * (axis == 1)), (sign * (axis == 2))}});
}

/* Turn a direction in a frame's own coordinates, by its placement (12,), into the world's.
 *
 * iiwa_dnn/schemes/step.py: axis_at */
static double_3 schemes_step_axis_at(struct arena *arena, Vector placement, double_3 axis)
{
    double_3 x;
    #line 140 "iiwa_dnn/schemes/step.py"
    #line 141 "iiwa_dnn/schemes/step.py"
    x = references_rotations_scaled(arena, axis.at[0], schemes_step_vector_at(arena, placement, 0));
    #line 142 "iiwa_dnn/schemes/step.py"
    return references_rotations_added(arena, x, references_rotations_combined(arena, axis.at[1], schemes_step_vector_at(arena, placement, 3), axis.at[2], schemes_step_vector_at(arena, placement, 6)));
}

/* Compute a u.
 *
 * iiwa_dnn/references/rotations.py: scaled */
static double_3 references_rotations_scaled(struct arena *arena, double a, double_3 u)
{
    (void)arena;
    #line 56 "iiwa_dnn/references/rotations.py"
    #line 57 "iiwa_dnn/references/rotations.py"
    return ((double_3){{(a * u.at[0]), (a * u.at[1]), (a * u.at[2])}});
}

/* Compute u + v.
 *
 * iiwa_dnn/references/rotations.py: added */
static double_3 references_rotations_added(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    #line 68 "iiwa_dnn/references/rotations.py"
    #line 69 "iiwa_dnn/references/rotations.py"
    return ((double_3){{(u.at[0] + v.at[0]), (u.at[1] + v.at[1]), (u.at[2] + v.at[2])}});
}

/* Compute B [m] for pair k, whose joints travel by `travel` (n,) [rad].
 *
 * Args:
 *     moves: `SceneViews.moves`, (pairs, n).
 *     radii: `SceneViews.radii`, (pairs, n).
 *     k: Index of the pair.
 *     travel: Way of each joint, at least 0, (n,) [rad].
 *
 * iiwa_dnn/schemes/scene.py: second_order */
static double schemes_scene_second_order(struct arena *arena, Matrix moves, Matrix radii, int64_t k, Vector travel)
{
    (void)arena;
    int64_t n;
    double B;
    double turning;
    int64_t j;
    #line 378 "iiwa_dnn/schemes/scene.py"
    #line 386 "iiwa_dnn/schemes/scene.py"
    n = (travel.size0);
    #line 387 "iiwa_dnn/schemes/scene.py"
    B = 0.0;
    #line 388 "iiwa_dnn/schemes/scene.py"
    turning = 0.0;
    #line 389 "iiwa_dnn/schemes/scene.py"
    for (int64_t step = 0, end_step = (2 * n); step < end_step; step++) {
        #line 390 "iiwa_dnn/schemes/scene.py"
        j = ((step < n) ? ((n - 1) - step) : (step - n));
        #line 391 "iiwa_dnn/schemes/scene.py"
        if ((moves.data[k * moves.size1 + j] == 0.0) || ((moves.data[k * moves.size1 + j] < 0.0) != (step < n))) {
            #line 392 "iiwa_dnn/schemes/scene.py"
            continue;
        }
        #line 393 "iiwa_dnn/schemes/scene.py"
        if (radii.data[k * radii.size1 + j] < 0.0) {
            #line 394 "iiwa_dnn/schemes/scene.py"
            B += ((2.0 * travel.data[j]) * turning);
        }
        else {
            #line 396 "iiwa_dnn/schemes/scene.py"
            B += ((travel.data[j] * radii.data[k * radii.size1 + j]) * ((2.0 * turning) + travel.data[j]));
            #line 397 "iiwa_dnn/schemes/scene.py"
            turning += travel.data[j];
        }
    }
    #line 398 "iiwa_dnn/schemes/scene.py"
    return B;
}

/* Compute first velocity and b along a normal (3,) of a point (3,) of pair k's second body.
 *
 * iiwa_dnn/control/stopping.py: _along */
static double_2 control_stopping_along(struct arena *arena, const stopping_Motion *motion, Matrix jacobian, Matrix moves, int64_t k, double_3 point, double_3 normal)
{
    double x;
    double b;
    double rate;
    #line 295 "iiwa_dnn/control/stopping.py"
    #line 296 "iiwa_dnn/control/stopping.py"
    x = 0.0;
    #line 297 "iiwa_dnn/control/stopping.py"
    b = 0.0;
    #line 298 "iiwa_dnn/control/stopping.py"
    for (int64_t j = 0, end_j = ((*motion).first.size0); j < end_j; j++) {
        #line 299 "iiwa_dnn/control/stopping.py"
        if (moves.data[k * moves.size1 + j] != 0.0) {
            #line 300 "iiwa_dnn/control/stopping.py"
            rate = (moves.data[k * moves.size1 + j] * schemes_step_rate_along(arena, jacobian, j, point, normal));
            #line 301 "iiwa_dnn/control/stopping.py"
            x += (rate * (*motion).first.data[j]);
            #line 302 "iiwa_dnn/control/stopping.py"
            b += (rate * (*motion).bend.data[j]);
        }
    }
    #line 303 "iiwa_dnn/control/stopping.py"
    return ((double_2){{x, b}});
}

/* Compute the velocity along a normal (3,) of a point (3,) [m] that joint j moves [m/rad].
 *
 * iiwa_dnn/schemes/step.py: rate_along */
static double schemes_step_rate_along(struct arena *arena, Matrix jacobian, int64_t j, double_3 point, double_3 normal)
{
    #line 165 "iiwa_dnn/schemes/step.py"
    #line 166 "iiwa_dnn/schemes/step.py"
    return references_rotations_dot(arena, normal, schemes_step_point_rate(arena, jacobian, j, point));
}

/* Compute the velocity (3,) of a point (3,) [m] that joint j moves [m/rad].
 *
 * A joint with angular velocity w and velocity v of the world's origin moves it with v + w x p.
 *
 * iiwa_dnn/schemes/step.py: point_rate */
static double_3 schemes_step_point_rate(struct arena *arena, Matrix jacobian, int64_t j, double_3 point)
{
    double_3 turned;
    #line 155 "iiwa_dnn/schemes/step.py"
    #line 159 "iiwa_dnn/schemes/step.py"
    turned = references_rotations_cross(arena, schemes_step_vector_at(arena, ((Vector){jacobian.data + j * jacobian.size1, jacobian.size1}), 3), point);
    #line 160 "iiwa_dnn/schemes/step.py"
    return references_rotations_added(arena, schemes_step_vector_at(arena, ((Vector){jacobian.data + j * jacobian.size1, jacobian.size1}), 0), turned);
}

/* Compute the cross product u x v.
 *
 * iiwa_dnn/references/rotations.py: cross */
static double_3 references_rotations_cross(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    #line 50 "iiwa_dnn/references/rotations.py"
    #line 51 "iiwa_dnn/references/rotations.py"
    return ((double_3){{((u.at[1] * v.at[2]) - (u.at[2] * v.at[1])), ((u.at[2] * v.at[0]) - (u.at[0] * v.at[2])), ((u.at[0] * v.at[1]) - (u.at[1] * v.at[0]))}});
}

/* Compute the periods of the motion to rest from a command.
 *
 * Args:
 *     arrays: Arrays of the loop; the kinematics are at the joint positions of `past`.
 *     past: `ControllerState.past`, (8, dof).
 *     yielding: Limits and scenes.
 *     dq: The command [rad/s], (dof,).
 *
 * Returns:
 *     M; -1 if the motion breaks a limit, or brings a pair too near.
 *
 * iiwa_dnn/control/stopping.py: stopping_time */
static double control_stopping_stopping_time(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector dq)
{
    Vector limits;
    Vector bend;
    double periods;
    stopping_Motion motion;
    Vector scene;
    const struct arena mark = *arena;
    #line 316 "iiwa_dnn/control/stopping.py"
    #line 327 "iiwa_dnn/control/stopping.py"
    limits = (*yielding).limits;
    #line 328 "iiwa_dnn/control/stopping.py"
    bend = ((Vector){arena_zeros(arena, (dq.size0)), (dq.size0)});
    #line 329 "iiwa_dnn/control/stopping.py"
    periods = 1.0;
    #line 330 "iiwa_dnn/control/stopping.py"
    if ((limits.size0)) {
        #line 331 "iiwa_dnn/control/stopping.py"
        periods = control_stopping_least_periods(arena, dq, ((Vector){past.data + 1 * past.size1, past.size1}), limits, (*yielding).dt, (*yielding).cubic);
    }
    #line 332 "iiwa_dnn/control/stopping.py"
    if (periods == INFINITY) {
        #line 333 "iiwa_dnn/control/stopping.py"
        const double own_result = (-1.0);
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 334 "iiwa_dnn/control/stopping.py"
    if (((*yielding).cubic) && (periods > 0.0)) {
        #line 335 "iiwa_dnn/control/stopping.py"
        for (int64_t i = 0, end_i = (dq.size0); i < end_i; i++) {
            #line 336 "iiwa_dnn/control/stopping.py"
            bend.data[i] = control_stopping_bend_of(arena, dq.data[i], past.data[1 * past.size1 + i], periods);
        }
    }
    #line 337 "iiwa_dnn/control/stopping.py"
    motion = ((stopping_Motion){dq, bend, periods, (*yielding).cubic});
    #line 338 "iiwa_dnn/control/stopping.py"
    if (((limits.size0)) && (!control_stopping_keeps_joint_limits(arena, &motion, ((Vector){past.data, past.size1}), limits, (*yielding).dt))) {
        #line 339 "iiwa_dnn/control/stopping.py"
        const double own_result = (-1.0);
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 340 "iiwa_dnn/control/stopping.py"
    for (int64_t k = 0, end_k = (*yielding).scenes.size0; k < end_k; k++) {
        #line 341 "iiwa_dnn/control/stopping.py"
        scene = ((Vector){(*arrays).constants.data + (*yielding).scenes.data[k * (*yielding).scenes.size1], (*yielding).scenes.data[k * (*yielding).scenes.size1 + 1] - (*yielding).scenes.data[k * (*yielding).scenes.size1]});
        #line 342 "iiwa_dnn/control/stopping.py"
        if (!control_stopping_keeps_distances(arena, &motion, &(*arrays), scene, (*yielding).dt)) {
            #line 343 "iiwa_dnn/control/stopping.py"
            const double own_result = (-1.0);
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 344 "iiwa_dnn/control/stopping.py"
    const double own_result = periods;
    arena_leave(arena, &mark);
    return own_result;
}

/* Enter a network's function, `Rates`, of states (size,) and constants (k,), at an address. */
static void networks_base_enter_rates(struct arena *arena, int64_t address, const layout_QPViews *qp, Vector constants, Vector state, Vector rates)
{
    if (address > 0) return ((void (*)(struct arena *, const layout_QPViews *, Vector , Vector , Vector ))(intptr_t)address)(arena, qp, constants, state, rates);
    return ((void (*)(double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t, double *, int64_t))(intptr_t)-address)((*qp).P.data, (*qp).P.size0, (*qp).P.size1, (*qp).q.data, (*qp).q.size0, (*qp).G.data, (*qp).G.size0, (*qp).G.size1, (*qp).h.data, (*qp).h.size0, (*qp).A.data, (*qp).A.size0, (*qp).A.size1, (*qp).b.data, (*qp).b.size0, (*qp).lb.data, (*qp).lb.size0, (*qp).ub.data, (*qp).ub.size0, constants.data, constants.size0, state.data, state.size0, rates.data, rates.size0);
}

/* Enter the compiled answer at an address.
 *
 * The program is `QP.data` with its sizes (n, m, p); constants (k,), state (size,) and point
 * (2n + m + p,) are those of `enter_answer`, and so is the address `rates`, which is 0 for an
 * answer that does not use the network's function.
 *
 * iiwa_dnn/networks/integrators/base.py: answer_program */
static double_5 integrators_base_answer_program(struct arena *arena, Vector data, int_3 sizes, int64_t address, int64_t rates, Vector constants, Vector state, Vector point)
{
    int64_t n;
    int64_t m;
    int64_t p;
    layout_QPViews qp;
    double_5 settled;
    #line 70 "iiwa_dnn/networks/integrators/base.py"
    #line 76 "iiwa_dnn/networks/integrators/base.py"
    const int_3 own_2 = sizes;
    n = own_2.at[0];
    m = own_2.at[1];
    p = own_2.at[2];
    #line 77 "iiwa_dnn/networks/integrators/base.py"
    qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 78 "iiwa_dnn/networks/integrators/base.py"
    settled = integrators_base_enter_answer(arena, address, &qp, rates, constants, state, point);
    #line 79 "iiwa_dnn/networks/integrators/base.py"
    return settled;
}

/* Advance the network by its time with explicit steps; a compiled answer (`enter_answer`).
 *
 * It reads constants (k,), advances the state (size,) and writes the point (2n + m + p,).
 *
 * Returns:
 *     Sub-steps, 0 if none are stable; time [rho]; and the residuals of the point.
 *
 * iiwa_dnn/networks/integrators/explicit.py: follow */
static double_5 integrators_explicit_follow(struct arena *arena, const layout_QPViews *qp, int64_t rates, Vector constants, Vector state, Vector point)
{
    double duration;
    int64_t count;
    Vector own;
    Vector values;
    Vector active;
    double stable;
    double step;
    double primal;
    double dual;
    double gap;
    const struct arena mark = *arena;
    #line 69 "iiwa_dnn/networks/integrators/explicit.py"
    #line 76 "iiwa_dnn/networks/integrators/explicit.py"
    duration = constants.data[2];
    #line 77 "iiwa_dnn/networks/integrators/explicit.py"
    count = (int64_t)(constants.data[3]);
    #line 78 "iiwa_dnn/networks/integrators/explicit.py"
    own = ((Vector){constants.data + 4, constants.size0 - 4});
    #line 79 "iiwa_dnn/networks/integrators/explicit.py"
    values = ((Vector){arena_empty(arena, (state.size0)), (state.size0)});
    #line 80 "iiwa_dnn/networks/integrators/explicit.py"
    if (count == 0) {
        #line 81 "iiwa_dnn/networks/integrators/explicit.py"
        active = ((Vector){arena_empty(arena, ((state.size0) - ((*qp).q.size0))), ((state.size0) - ((*qp).q.size0))});
        #line 82 "iiwa_dnn/networks/integrators/explicit.py"
        networks_base_enter_rates(arena, rates, &(*qp), own, state, values);
        #line 83 "iiwa_dnn/networks/integrators/explicit.py"
        networks_projection_mark_active(arena, &(*qp), state, values, active);
        #line 84 "iiwa_dnn/networks/integrators/explicit.py"
        stable = (0.95 * networks_projection_stable_step(arena, &(*qp), active));
        #line 85 "iiwa_dnn/networks/integrators/explicit.py"
        if (!(stable > 0.0)) {
            #line 86 "iiwa_dnn/networks/integrators/explicit.py"
            const double_5 own_result = ((double_5){{0, 0.0, INFINITY, INFINITY, INFINITY}});
            arena_leave(arena, &mark);
            return own_result;
        }
        #line 87 "iiwa_dnn/networks/integrators/explicit.py"
        count = int_max(1, (int64_t)(ceil(((double)duration / stable))));
    }
    #line 88 "iiwa_dnn/networks/integrators/explicit.py"
    step = ((double)duration / count);
    #line 89 "iiwa_dnn/networks/integrators/explicit.py"
    for (int64_t _ = 0, end__ = count; _ < end__; _++) {
        #line 90 "iiwa_dnn/networks/integrators/explicit.py"
        networks_base_enter_rates(arena, rates, &(*qp), own, state, values);
        #line 91 "iiwa_dnn/networks/integrators/explicit.py"
        for (int64_t i = 0, end_i = (state.size0); i < end_i; i++) {
            #line 92 "iiwa_dnn/networks/integrators/explicit.py"
            state.data[i] += (step * values.data[i]);
        }
    }
    #line 93 "iiwa_dnn/networks/integrators/explicit.py"
    const double_3 own_42 = qp_residuals_kkt_point(arena, &(*qp), state, point);
    primal = own_42.at[0];
    dual = own_42.at[1];
    gap = own_42.at[2];
    #line 94 "iiwa_dnn/networks/integrators/explicit.py"
    const double_5 own_result = ((double_5){{count, duration, primal, dual, gap}});
    arena_leave(arena, &mark);
    return own_result;
}

/* Compute the bound of `ProjectionNetwork.stable_step` for an active set (p + m + 2n,).
 *
 * iiwa_dnn/networks/projection.py: stable_step */
static double networks_projection_stable_step(struct arena *arena, const layout_QPViews *qp, Vector active)
{
    int64_t n;
    int64_t p;
    int64_t first;
    Matrix K;
    double coupling;
    double smallest;
    double largest;
    double bound;
    const struct arena mark = *arena;
    #line 124 "iiwa_dnn/networks/projection.py"
    #line 125 "iiwa_dnn/networks/projection.py"
    n = ((*qp).q.size0);
    #line 126 "iiwa_dnn/networks/projection.py"
    p = ((*qp).b.size0);
    #line 127 "iiwa_dnn/networks/projection.py"
    first = (p + ((*qp).h.size0));
    #line 128 "iiwa_dnn/networks/projection.py"
    K = ((Matrix){arena_zeros(arena, n * n), n, n});
    #line 129 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = p; j < end_j; j++) {
        #line 130 "iiwa_dnn/networks/projection.py"
        qp_dense_add_outer(arena, K, active.data[j], (*qp).A, j);
    }
    #line 131 "iiwa_dnn/networks/projection.py"
    for (int64_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        #line 132 "iiwa_dnn/networks/projection.py"
        qp_dense_add_outer(arena, K, active.data[(p + j)], (*qp).G, j);
    }
    #line 133 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 134 "iiwa_dnn/networks/projection.py"
        K.data[i * K.size1 + i] += (active.data[(first + i)] + active.data[((first + n) + i)]);
        #line 135 "iiwa_dnn/networks/projection.py"
        for (int64_t k = 0, end_k = i; k < end_k; k++) {
            #line 136 "iiwa_dnn/networks/projection.py"
            K.data[i * K.size1 + k] = K.data[k * K.size1 + i];
        }
    }
    #line 137 "iiwa_dnn/networks/projection.py"
    const double_2 own_30 = qp_dense_extreme_eigenvalues(arena, K);
    coupling = own_30.at[1];
    #line 138 "iiwa_dnn/networks/projection.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 139 "iiwa_dnn/networks/projection.py"
        for (int64_t k = 0, end_k = n; k < end_k; k++) {
            #line 140 "iiwa_dnn/networks/projection.py"
            K.data[i * K.size1 + k] = (*qp).P.data[i * (*qp).P.size1 + k];
        }
    }
    #line 141 "iiwa_dnn/networks/projection.py"
    const double_2 own_41 = qp_dense_extreme_eigenvalues(arena, K);
    smallest = own_41.at[0];
    largest = own_41.at[1];
    #line 143 "iiwa_dnn/networks/projection.py"
    bound = ((double)2.0 / double_max(largest, 1.0));
    #line 144 "iiwa_dnn/networks/projection.py"
    const double own_result = ((coupling > 0.0) ? double_min(bound, ((double)double_max(smallest, 0.0) / coupling)) : bound);
    arena_leave(arena, &mark);
    return own_result;
}

/* Compute the smallest and the largest eigenvalue of K (n, n), which is overwritten.
 *
 * Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5) on
 * both halves of K: for seven joints one call of LAPACK costs more than all of them.
 *
 * iiwa_dnn/qp/dense.py: extreme_eigenvalues */
static double_2 qp_dense_extreme_eigenvalues(struct arena *arena, Matrix K)
{
    int64_t n;
    double smallest;
    double largest;
    #line 105 "iiwa_dnn/qp/dense.py"
    #line 110 "iiwa_dnn/qp/dense.py"
    n = K.size0;
    #line 111 "iiwa_dnn/qp/dense.py"
    for (int64_t _ = 0, end__ = 20; _ < end__; _++) {
        #line 112 "iiwa_dnn/qp/dense.py"
        for (int64_t i = 1, end_i = n; i < end_i; i++) {
            #line 113 "iiwa_dnn/qp/dense.py"
            for (int64_t k = 0, end_k = i; k < end_k; k++) {
                #line 115 "iiwa_dnn/qp/dense.py"
                if (fabs(K.data[i * K.size1 + k]) > (1e-13 * (fabs(K.data[i * K.size1 + i]) + fabs(K.data[k * K.size1 + k])))) {
                    #line 116 "iiwa_dnn/qp/dense.py"
                    qp_dense_rotate(arena, K, i, k);
                }
            }
        }
    }
    #line 117 "iiwa_dnn/qp/dense.py"
    smallest = K.data[0];
    #line 118 "iiwa_dnn/qp/dense.py"
    largest = K.data[0];
    #line 119 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 1, end_i = n; i < end_i; i++) {
        #line 120 "iiwa_dnn/qp/dense.py"
        smallest = double_min(smallest, K.data[i * K.size1 + i]);
        #line 121 "iiwa_dnn/qp/dense.py"
        largest = qp_layout_larger(arena, largest, K.data[i * K.size1 + i]);
    }
    #line 122 "iiwa_dnn/qp/dense.py"
    return ((double_2){{smallest, largest}});
}

/* Make the entries (i, k) and (k, i) of a symmetric matrix zero by a Jacobi rotation.
 *
 * iiwa_dnn/qp/dense.py: _rotate */
static void qp_dense_rotate(struct arena *arena, Matrix K, int64_t i, int64_t k)
{
    (void)arena;
    double theta;
    double t;
    double c;
    double s;
    double one;
    #line 127 "iiwa_dnn/qp/dense.py"
    #line 128 "iiwa_dnn/qp/dense.py"
    theta = ((double)(0.5 * (K.data[i * K.size1 + i] - K.data[k * K.size1 + k])) / K.data[i * K.size1 + k]);
    #line 129 "iiwa_dnn/qp/dense.py"
    t = copysign(((double)1.0 / (fabs(theta) + sqrt(((theta * theta) + 1.0)))), theta);
    #line 130 "iiwa_dnn/qp/dense.py"
    c = ((double)1.0 / sqrt(((t * t) + 1.0)));
    #line 131 "iiwa_dnn/qp/dense.py"
    s = (t * c);
    #line 132 "iiwa_dnn/qp/dense.py"
    for (int64_t j = 0, end_j = K.size0; j < end_j; j++) {
        #line 133 "iiwa_dnn/qp/dense.py"
        one = K.data[j * K.size1 + k];
        #line 134 "iiwa_dnn/qp/dense.py"
        K.data[j * K.size1 + k] = ((c * one) - (s * K.data[j * K.size1 + i]));
        #line 135 "iiwa_dnn/qp/dense.py"
        K.data[j * K.size1 + i] = ((s * one) + (c * K.data[j * K.size1 + i]));
    }
    #line 136 "iiwa_dnn/qp/dense.py"
    for (int64_t j = 0, end_j = K.size0; j < end_j; j++) {
        #line 137 "iiwa_dnn/qp/dense.py"
        one = K.data[k * K.size1 + j];
        #line 138 "iiwa_dnn/qp/dense.py"
        K.data[k * K.size1 + j] = ((c * one) - (s * K.data[i * K.size1 + j]));
        #line 139 "iiwa_dnn/qp/dense.py"
        K.data[i * K.size1 + j] = ((s * one) + (c * K.data[i * K.size1 + j]));
    }
    return;
}

/* Advance a state `s` (size,) in place by one backward Euler step of a program, `QP.data`.
 *
 * Returns:
 *     Linear systems solved, or -1 if one could not be.
 *
 * iiwa_dnn/networks/integrators/implicit.py: step_program */
static int64_t integrators_implicit_step_program(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector s, double step)
{
    int64_t rows;
    implicit_steps_Condensed matrix;
    Vector new;
    int64_t systems;
    const struct arena mark = *arena;
    #line 117 "iiwa_dnn/networks/integrators/implicit.py"
    #line 122 "iiwa_dnn/networks/integrators/implicit.py"
    rows = ((s.size0) - n);
    #line 123 "iiwa_dnn/networks/integrators/implicit.py"
    matrix = ((implicit_steps_Condensed){((Vector){arena_empty(arena, rows), rows}), ((Vector){arena_zeros(arena, (m + p)), (m + p)}), ((Matrix){arena_zeros(arena, n * n), n, n}), ((Matrix){arena_empty(arena, n * n), n, n}), ((Vector){arena_empty(arena, rows), rows})});
    #line 126 "iiwa_dnn/networks/integrators/implicit.py"
    new = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    #line 127 "iiwa_dnn/networks/integrators/implicit.py"
    systems = integrators_implicit_steps_backward_euler(arena, (layout_QPViews[1]){qp_layout_qp_views(arena, data, n, m, p)}, s, step, new, 1e-12, (2 * 50), &matrix);
    #line 128 "iiwa_dnn/networks/integrators/implicit.py"
    if (systems >= 0) {
        #line 129 "iiwa_dnn/networks/integrators/implicit.py"
        integrators_implicit_steps_copy_into(arena, s, new);
    }
    #line 130 "iiwa_dnn/networks/integrators/implicit.py"
    const int64_t own_result = systems;
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the rates (size,); `constants` (1,) is [1] if x goes through its bounds, else [0].
 *
 * iiwa_dnn/networks/projection.py: projection_rates */
static void networks_projection_projection_rates(struct arena *arena, const layout_QPViews *qp, Vector constants, Vector state, Vector rates)
{
    #line 115 "iiwa_dnn/networks/projection.py"
    #line 116 "iiwa_dnn/networks/projection.py"
    networks_projection_field(arena, &(*qp), state, rates);
    #line 117 "iiwa_dnn/networks/projection.py"
    if (constants.data[0] != 0.0) {
        #line 118 "iiwa_dnn/networks/projection.py"
        for (int64_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
            #line 119 "iiwa_dnn/networks/projection.py"
            rates.data[i] = (double_min(double_max((state.data[i] + rates.data[i]), (*qp).lb.data[i]), (*qp).ub.data[i]) - state.data[i]);
        }
    }
    return;
}

/* Check that P (n, n) is symmetric and positive semidefinite to `ROUNDING` of its scale.
 *
 * K (n, n) is scratch.
 *
 * iiwa_dnn/qp/dense.py: is_convex */
static bool qp_dense_is_convex(struct arena *arena, Matrix P, Matrix K)
{
    double largest;
    double asymmetry;
    #line 144 "iiwa_dnn/qp/dense.py"
    #line 148 "iiwa_dnn/qp/dense.py"
    largest = 0.0;
    #line 149 "iiwa_dnn/qp/dense.py"
    asymmetry = 0.0;
    #line 150 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0, end_i = P.size0; i < end_i; i++) {
        #line 151 "iiwa_dnn/qp/dense.py"
        for (int64_t k = 0, end_k = P.size0; k < end_k; k++) {
            #line 152 "iiwa_dnn/qp/dense.py"
            K.data[i * K.size1 + k] = P.data[i * P.size1 + k];
            #line 153 "iiwa_dnn/qp/dense.py"
            largest = qp_layout_larger(arena, largest, fabs(P.data[i * P.size1 + k]));
            #line 154 "iiwa_dnn/qp/dense.py"
            asymmetry = qp_layout_larger(arena, asymmetry, fabs((P.data[i * P.size1 + k] - P.data[k * P.size1 + i])));
        }
    }
    #line 155 "iiwa_dnn/qp/dense.py"
    for (int64_t i = 0, end_i = P.size0; i < end_i; i++) {
        #line 156 "iiwa_dnn/qp/dense.py"
        K.data[i * K.size1 + i] += ((1e-05 * largest) + 1e-300);
    }
    #line 157 "iiwa_dnn/qp/dense.py"
    return ((asymmetry <= (1e-05 * largest)) && (qp_dense_cholesky_factor(arena, K)));
}

/* Check in one pass over the numbers that `QP.check_values` would find nothing.
 *
 * iiwa_dnn/qp/program.py: _well_formed */
static bool qp_program_well_formed(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p)
{
    int64_t at_h;
    int64_t at_A;
    int64_t at_lb;
    layout_QPViews qp;
    const struct arena mark = *arena;
    #line 235 "iiwa_dnn/qp/program.py"
    #line 236 "iiwa_dnn/qp/program.py"
    at_h = (((n * n) + n) + (m * n));
    #line 237 "iiwa_dnn/qp/program.py"
    at_A = (at_h + m);
    #line 238 "iiwa_dnn/qp/program.py"
    at_lb = ((data.size0) - (2 * n));
    #line 239 "iiwa_dnn/qp/program.py"
    if (!((qp_dense_all_finite(arena, data, 0, at_h)) && (qp_dense_all_finite(arena, data, at_A, at_lb)))) {
        #line 240 "iiwa_dnn/qp/program.py"
        const bool own_result = false;
        arena_leave(arena, &mark);
        return own_result;
    }
    #line 241 "iiwa_dnn/qp/program.py"
    qp = qp_layout_qp_views(arena, data, n, m, p);
    #line 242 "iiwa_dnn/qp/program.py"
    for (int64_t j = 0, end_j = m; j < end_j; j++) {
        #line 243 "iiwa_dnn/qp/program.py"
        if (!(qp.h.data[j] > (-INFINITY))) {
            #line 244 "iiwa_dnn/qp/program.py"
            const bool own_result = false;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 245 "iiwa_dnn/qp/program.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 246 "iiwa_dnn/qp/program.py"
        if (!((qp.lb.data[i] <= qp.ub.data[i]) && (qp.lb.data[i] < INFINITY) && (qp.ub.data[i] > (-INFINITY)))) {
            #line 247 "iiwa_dnn/qp/program.py"
            const bool own_result = false;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    #line 248 "iiwa_dnn/qp/program.py"
    const bool own_result = qp_dense_is_convex(arena, qp.P, ((Matrix){arena_empty(arena, n * n), n, n}));
    arena_leave(arena, &mark);
    return own_result;
}

/* Compute `point_residuals` of a point (2n + m + p,), for a program's flat array, `QP.data`.
 *
 * iiwa_dnn/qp/residuals.py: residuals_of */
static double_3 qp_residuals_residuals_of(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector point)
{
    #line 51 "iiwa_dnn/qp/residuals.py"
    #line 52 "iiwa_dnn/qp/residuals.py"
    return qp_residuals_point_residuals(arena, (layout_QPViews[1]){qp_layout_qp_views(arena, data, n, m, p)}, point);
}

/* Write the `kkt_point` (2n + m + p,) of a state, for a program's flat array, `QP.data`.
 *
 * iiwa_dnn/qp/residuals.py: point_of_state */
static double_3 qp_residuals_point_of_state(struct arena *arena, Vector data, int64_t n, int64_t m, int64_t p, Vector s, Vector point)
{
    #line 100 "iiwa_dnn/qp/residuals.py"
    #line 101 "iiwa_dnn/qp/residuals.py"
    return qp_residuals_kkt_point(arena, (layout_QPViews[1]){qp_layout_qp_views(arena, data, n, m, p)}, s, point);
}

/* Compute a and b at a squared angle.
 *
 * iiwa_dnn/references/rotations.py: coefficients */
static double_2 references_rotations_coefficients(struct arena *arena, double square)
{
    (void)arena;
    double angle;
    double sine;
    double versine;
    double a;
    double b;
    int64_t k;
    #line 27 "iiwa_dnn/references/rotations.py"
    #line 28 "iiwa_dnn/references/rotations.py"
    if (square > 1.0) {
        #line 29 "iiwa_dnn/references/rotations.py"
        angle = sqrt(square);
        #line 30 "iiwa_dnn/references/rotations.py"
        sine = sin((0.5 * angle));
        #line 31 "iiwa_dnn/references/rotations.py"
        versine = ((2.0 * sine) * sine);
        #line 32 "iiwa_dnn/references/rotations.py"
        return ((double_2){{((double)versine / square), ((double)(angle - sin(angle)) / (square * angle))}});
    }
    #line 33 "iiwa_dnn/references/rotations.py"
    a = 1.0;
    #line 34 "iiwa_dnn/references/rotations.py"
    b = 1.0;
    #line 35 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0, end_i = 10; i < end_i; i++) {
        #line 36 "iiwa_dnn/references/rotations.py"
        k = (10 - i);
        #line 37 "iiwa_dnn/references/rotations.py"
        a = (1.0 - ((double)(a * square) / (((2.0 * k) + 1.0) * ((2.0 * k) + 2.0))));
        #line 38 "iiwa_dnn/references/rotations.py"
        b = (1.0 - ((double)(b * square) / (((2.0 * k) + 2.0) * ((2.0 * k) + 3.0))));
    }
    #line 39 "iiwa_dnn/references/rotations.py"
    return ((double_2){{(0.5 * a), ((double)b / 6.0)}});
}

/* Compute exp[vector] v.
 *
 * iiwa_dnn/references/rotations.py: rotated */
static double_3 references_rotations_rotated(struct arena *arena, double_3 vector, double_3 v)
{
    double square;
    double a;
    double b;
    double_3 once;
    #line 74 "iiwa_dnn/references/rotations.py"
    #line 75 "iiwa_dnn/references/rotations.py"
    square = references_rotations_dot(arena, vector, vector);
    #line 76 "iiwa_dnn/references/rotations.py"
    const double_2 own_4 = references_rotations_coefficients(arena, square);
    a = own_4.at[0];
    b = own_4.at[1];
    #line 77 "iiwa_dnn/references/rotations.py"
    once = references_rotations_cross(arena, vector, v);
    #line 78 "iiwa_dnn/references/rotations.py"
    return references_rotations_added(arena, v, references_rotations_combined(arena, (1.0 - (b * square)), once, a, references_rotations_cross(arena, vector, once)));
}

/* Compute J(vector) v: the angular velocity of a rotation vector with the rate v.
 *
 * iiwa_dnn/references/rotations.py: left_jacobian */
static double_3 references_rotations_left_jacobian(struct arena *arena, double_3 vector, double_3 v)
{
    double a;
    double b;
    double_3 once;
    #line 83 "iiwa_dnn/references/rotations.py"
    #line 84 "iiwa_dnn/references/rotations.py"
    const double_2 own_2 = references_rotations_coefficients(arena, references_rotations_dot(arena, vector, vector));
    a = own_2.at[0];
    b = own_2.at[1];
    #line 85 "iiwa_dnn/references/rotations.py"
    once = references_rotations_cross(arena, vector, v);
    #line 86 "iiwa_dnn/references/rotations.py"
    return references_rotations_added(arena, v, references_rotations_combined(arena, a, once, b, references_rotations_cross(arena, vector, once)));
}

/* Return the j-th axis of a target's frame, of `Target.data` (18,).
 *
 * iiwa_dnn/references/rotations.py: column_of */
static double_3 references_rotations_column_of(struct arena *arena, Vector target, int64_t j)
{
    (void)arena;
    #line 91 "iiwa_dnn/references/rotations.py"
    #line 92 "iiwa_dnn/references/rotations.py"
    return ((double_3){{target.data[(3 + j)], target.data[(6 + j)], target.data[(9 + j)]}});
}

/* Turn a target, `Target.data` (18,), by a rotation vector with a rate; its position stays.
 *
 * iiwa_dnn/references/rotations.py: turn_target */
static void references_rotations_turn_target(struct arena *arena, Vector target, double_3 vector, double_3 rate)
{
    double_3 column;
    double_3 before;
    double_3 after;
    #line 103 "iiwa_dnn/references/rotations.py"
    #line 104 "iiwa_dnn/references/rotations.py"
    for (int64_t j = 0, end_j = 3; j < end_j; j++) {
        #line 105 "iiwa_dnn/references/rotations.py"
        column = references_rotations_rotated(arena, vector, references_rotations_column_of(arena, target, j));
        #line 106 "iiwa_dnn/references/rotations.py"
        for (int64_t i = 0, end_i = 3; i < end_i; i++) {
            #line 107 "iiwa_dnn/references/rotations.py"
            target.data[((3 + (3 * i)) + j)] = column.at[i];
        }
    }
    #line 108 "iiwa_dnn/references/rotations.py"
    before = references_rotations_rotated(arena, vector, ((double_3){{target.data[15], target.data[16], target.data[17]}}));
    #line 109 "iiwa_dnn/references/rotations.py"
    after = references_rotations_added(arena, references_rotations_left_jacobian(arena, vector, rate), before);
    #line 110 "iiwa_dnn/references/rotations.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 111 "iiwa_dnn/references/rotations.py"
        target.data[(15 + i)] = after.at[i];
    }
    return;
}

/* Move a target along `Heart`; constants: scale [m], rate [rad/s].
 *
 * iiwa_dnn/references/shapes.py: heart_path */
static void references_shapes_heart_path(struct arena *arena, double t, Vector constants, Vector target)
{
    (void)arena;
    double scale;
    double rate;
    double p;
    double s1;
    double c1;
    double y;
    double slope;
    #line 20 "iiwa_dnn/references/shapes.py"
    #line 21 "iiwa_dnn/references/shapes.py"
    scale = constants.data[0];
    #line 22 "iiwa_dnn/references/shapes.py"
    rate = constants.data[1];
    #line 23 "iiwa_dnn/references/shapes.py"
    p = (rate * t);
    #line 24 "iiwa_dnn/references/shapes.py"
    s1 = sin(p);
    #line 25 "iiwa_dnn/references/shapes.py"
    c1 = cos(p);
    #line 26 "iiwa_dnn/references/shapes.py"
    y = (((((13.0 * c1) - (5.0 * cos((2.0 * p)))) - (2.0 * cos((3.0 * p)))) - cos((4.0 * p))) - 5.0);
    #line 27 "iiwa_dnn/references/shapes.py"
    slope = (((((-13.0) * s1) + (10.0 * sin((2.0 * p)))) + (6.0 * sin((3.0 * p)))) + (4.0 * sin((4.0 * p))));
    #line 30 "iiwa_dnn/references/shapes.py"
    target.data[0] += ((((scale * 16.0) * s1) * s1) * s1);
    #line 31 "iiwa_dnn/references/shapes.py"
    target.data[1] += (scale * y);
    #line 32 "iiwa_dnn/references/shapes.py"
    target.data[12] += (((((rate * scale) * 48.0) * s1) * s1) * c1);
    #line 33 "iiwa_dnn/references/shapes.py"
    target.data[13] += ((rate * scale) * slope);
    return;
}

/* Move a target along `Circle`; constants: radius [m], rate [rad/s], two axes (3,).
 *
 * iiwa_dnn/references/shapes.py: circle_path */
static void references_shapes_circle_path(struct arena *arena, double t, Vector constants, Vector target)
{
    (void)arena;
    double radius;
    double rate;
    double p;
    double sine;
    double along_u;
    double along_v;
    double u;
    double v;
    #line 70 "iiwa_dnn/references/shapes.py"
    #line 71 "iiwa_dnn/references/shapes.py"
    radius = constants.data[0];
    #line 72 "iiwa_dnn/references/shapes.py"
    rate = constants.data[1];
    #line 73 "iiwa_dnn/references/shapes.py"
    p = (rate * t);
    #line 75 "iiwa_dnn/references/shapes.py"
    sine = sin((0.5 * p));
    #line 76 "iiwa_dnn/references/shapes.py"
    along_u = (((-2.0) * sine) * sine);
    #line 77 "iiwa_dnn/references/shapes.py"
    along_v = sin(p);
    #line 78 "iiwa_dnn/references/shapes.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 79 "iiwa_dnn/references/shapes.py"
        u = constants.data[(2 + i)];
        #line 80 "iiwa_dnn/references/shapes.py"
        v = constants.data[(5 + i)];
        #line 81 "iiwa_dnn/references/shapes.py"
        target.data[i] += (radius * ((along_u * u) + (along_v * v)));
        #line 82 "iiwa_dnn/references/shapes.py"
        target.data[(12 + i)] += ((rate * radius) * ((cos(p) * v) - (along_v * u)));
    }
    return;
}

/* Move a target along `Line`; constants: rate [rad/s], offset (3,) [m].
 *
 * iiwa_dnn/references/shapes.py: line_path */
static void references_shapes_line_path(struct arena *arena, double t, Vector constants, Vector target)
{
    (void)arena;
    double rate;
    double p;
    double sine;
    double fraction;
    double speed;
    #line 124 "iiwa_dnn/references/shapes.py"
    #line 125 "iiwa_dnn/references/shapes.py"
    rate = constants.data[0];
    #line 126 "iiwa_dnn/references/shapes.py"
    p = (rate * t);
    #line 128 "iiwa_dnn/references/shapes.py"
    sine = sin((0.5 * p));
    #line 129 "iiwa_dnn/references/shapes.py"
    fraction = (sine * sine);
    #line 130 "iiwa_dnn/references/shapes.py"
    speed = ((0.5 * rate) * sin(p));
    #line 131 "iiwa_dnn/references/shapes.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 132 "iiwa_dnn/references/shapes.py"
        target.data[i] += (fraction * constants.data[(1 + i)]);
        #line 133 "iiwa_dnn/references/shapes.py"
        target.data[(12 + i)] += (speed * constants.data[(1 + i)]);
    }
    return;
}

/* Move a target along `Lissajous`; constants: amplitudes, rates and phases, (3,) each.
 *
 * iiwa_dnn/references/shapes.py: lissajous_path */
static void references_shapes_lissajous_path(struct arena *arena, double t, Vector constants, Vector target)
{
    (void)arena;
    double amplitude;
    double rate;
    double phase;
    double angle;
    #line 163 "iiwa_dnn/references/shapes.py"
    #line 164 "iiwa_dnn/references/shapes.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 165 "iiwa_dnn/references/shapes.py"
        amplitude = constants.data[i];
        #line 166 "iiwa_dnn/references/shapes.py"
        rate = constants.data[(3 + i)];
        #line 167 "iiwa_dnn/references/shapes.py"
        phase = constants.data[(6 + i)];
        #line 168 "iiwa_dnn/references/shapes.py"
        angle = ((rate * t) + phase);
        #line 169 "iiwa_dnn/references/shapes.py"
        target.data[i] += (amplitude * (sin(angle) - sin(phase)));
        #line 170 "iiwa_dnn/references/shapes.py"
        target.data[(12 + i)] += ((amplitude * rate) * cos(angle));
    }
    return;
}

/* Leave the target as it is.
 *
 * iiwa_dnn/references/shapes.py: still_path */
static void references_shapes_still_path(struct arena *arena, double t, Vector constants, Vector target)
{
    (void)arena;
    (void)t;
    (void)constants;
    (void)target;
    #line 212 "iiwa_dnn/references/shapes.py"
    return;
}

/* Turn a target along `Cone`; constants: angle [rad], rate [rad/s].
 *
 * iiwa_dnn/references/turning.py: cone_path */
static void references_turning_cone_path(struct arena *arena, double t, Vector constants, Vector target)
{
    double angle;
    double rate;
    double p;
    double_3 u;
    double_3 v;
    double_3 tilt;
    double speed;
    #line 33 "iiwa_dnn/references/turning.py"
    #line 34 "iiwa_dnn/references/turning.py"
    angle = constants.data[0];
    #line 35 "iiwa_dnn/references/turning.py"
    rate = constants.data[1];
    #line 36 "iiwa_dnn/references/turning.py"
    p = (rate * t);
    #line 37 "iiwa_dnn/references/turning.py"
    references_rotations_turn_target(arena, target, references_rotations_scaled(arena, (-angle), references_rotations_column_of(arena, target, 0)), ((double_3){{0.0, 0.0, 0.0}}));
    #line 39 "iiwa_dnn/references/turning.py"
    u = references_rotations_column_of(arena, target, 0);
    #line 40 "iiwa_dnn/references/turning.py"
    v = references_rotations_column_of(arena, target, 1);
    #line 41 "iiwa_dnn/references/turning.py"
    tilt = references_rotations_combined(arena, (angle * cos(p)), u, (angle * sin(p)), v);
    #line 42 "iiwa_dnn/references/turning.py"
    speed = (angle * rate);
    #line 43 "iiwa_dnn/references/turning.py"
    references_rotations_turn_target(arena, target, tilt, references_rotations_combined(arena, (speed * cos(p)), v, ((-speed) * sin(p)), u));
    return;
}

/* Move a target along `Tilting`; constants: number of the path, angle, rate, axis (3,).
 *
 * iiwa_dnn/references/turning.py: tilting_path */
static void references_turning_tilting_path(struct arena *arena, double t, Vector constants, Vector target)
{
    int64_t kind;
    Vector along;
    double rate;
    double_3 axis;
    double tilt;
    double speed;
    #line 75 "iiwa_dnn/references/turning.py"
    #line 76 "iiwa_dnn/references/turning.py"
    kind = (int64_t)(constants.data[0]);
    #line 77 "iiwa_dnn/references/turning.py"
    along = ((Vector){constants.data + 6, constants.size0 - 6});
    #line 78 "iiwa_dnn/references/turning.py"
    if (kind == 1) {
        #line 79 "iiwa_dnn/references/turning.py"
        references_shapes_heart_path(arena, t, along, target);
    }
    else {
        #line 80 "iiwa_dnn/references/turning.py"
        if (kind == 2) {
            #line 81 "iiwa_dnn/references/turning.py"
            references_shapes_circle_path(arena, t, along, target);
        }
        else {
            #line 82 "iiwa_dnn/references/turning.py"
            if (kind == 3) {
                #line 83 "iiwa_dnn/references/turning.py"
                references_shapes_line_path(arena, t, along, target);
            }
            else {
                #line 84 "iiwa_dnn/references/turning.py"
                if (kind == 4) {
                    #line 85 "iiwa_dnn/references/turning.py"
                    references_shapes_lissajous_path(arena, t, along, target);
                }
                else {
                    #line 86 "iiwa_dnn/references/turning.py"
                    if (kind == 5) {
                        #line 87 "iiwa_dnn/references/turning.py"
                        references_waypoints_waypoints_path(arena, t, along, target);
                    }
                }
            }
        }
    }
    #line 88 "iiwa_dnn/references/turning.py"
    rate = constants.data[2];
    #line 89 "iiwa_dnn/references/turning.py"
    axis = ((double_3){{constants.data[3], constants.data[4], constants.data[5]}});
    #line 90 "iiwa_dnn/references/turning.py"
    tilt = (constants.data[1] * sin((rate * t)));
    #line 91 "iiwa_dnn/references/turning.py"
    speed = ((constants.data[1] * rate) * cos((rate * t)));
    #line 92 "iiwa_dnn/references/turning.py"
    references_rotations_turn_target(arena, target, references_rotations_scaled(arena, tilt, axis), references_rotations_scaled(arena, speed, axis));
    return;
}

/* Move a target along `Waypoints`, see the comment above for the constants (c,).
 *
 * iiwa_dnn/references/waypoints.py: waypoints_path */
static void references_waypoints_waypoints_path(struct arena *arena, double t, Vector constants, Vector target)
{
    double piece;
    double x;
    double moves;
    int64_t at;
    double_3 moved;
    double_3 velocity;
    double_3 rate;
    #line 78 "iiwa_dnn/references/waypoints.py"
    #line 79 "iiwa_dnn/references/waypoints.py"
    const double_3 own_2 = references_waypoints_piece(arena, t, constants);
    piece = own_2.at[0];
    x = own_2.at[1];
    moves = own_2.at[2];
    #line 80 "iiwa_dnn/references/waypoints.py"
    at = ((3 + (int64_t)(constants.data[1])) + (24 * (int64_t)(piece)));
    #line 81 "iiwa_dnn/references/waypoints.py"
    moved = references_rotations_added(arena, references_waypoints_cubic(arena, constants, at, x), references_waypoints_triple(arena, constants, (at + 9)));
    #line 82 "iiwa_dnn/references/waypoints.py"
    velocity = references_waypoints_slope(arena, constants, at, x);
    #line 83 "iiwa_dnn/references/waypoints.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 84 "iiwa_dnn/references/waypoints.py"
        target.data[i] += moved.at[i];
        #line 85 "iiwa_dnn/references/waypoints.py"
        target.data[(12 + i)] += (moves * velocity.at[i]);
    }
    #line 86 "iiwa_dnn/references/waypoints.py"
    references_rotations_turn_target(arena, target, references_waypoints_triple(arena, constants, (at + 21)), ((double_3){{0.0, 0.0, 0.0}}));
    #line 87 "iiwa_dnn/references/waypoints.py"
    rate = references_rotations_scaled(arena, moves, references_waypoints_slope(arena, constants, (at + 12), x));
    #line 88 "iiwa_dnn/references/waypoints.py"
    references_rotations_turn_target(arena, target, references_waypoints_cubic(arena, constants, (at + 12), x), rate);
    return;
}

/* Find the piece at a time, the time since it began, and 0.0 if the path is at rest, or 1.0.
 *
 * iiwa_dnn/references/waypoints.py: _piece */
static double_3 references_waypoints_piece(struct arena *arena, double t, Vector constants)
{
    (void)arena;
    bool closed;
    int64_t pieces;
    double end;
    double inside;
    int64_t low;
    int64_t high;
    int64_t middle;
    double moves;
    #line 40 "iiwa_dnn/references/waypoints.py"
    #line 41 "iiwa_dnn/references/waypoints.py"
    closed = (constants.data[0] != 0.0);
    #line 42 "iiwa_dnn/references/waypoints.py"
    pieces = (int64_t)(constants.data[1]);
    #line 43 "iiwa_dnn/references/waypoints.py"
    end = constants.data[(2 + pieces)];
    #line 44 "iiwa_dnn/references/waypoints.py"
    inside = ((closed) ? double_remainder(t, end) : double_min(double_max(t, 0.0), end));
    #line 45 "iiwa_dnn/references/waypoints.py"
    low = 0;
    #line 46 "iiwa_dnn/references/waypoints.py"
    high = (pieces - 1);
    #line 47 "iiwa_dnn/references/waypoints.py"
    while (low < high) {
        #line 48 "iiwa_dnn/references/waypoints.py"
        middle = int_quotient(((low + high) + 1), 2);
        #line 49 "iiwa_dnn/references/waypoints.py"
        if (constants.data[(2 + middle)] <= inside) {
            #line 50 "iiwa_dnn/references/waypoints.py"
            low = middle;
        }
        else {
            #line 52 "iiwa_dnn/references/waypoints.py"
            high = (middle - 1);
        }
    }
    #line 53 "iiwa_dnn/references/waypoints.py"
    moves = (((closed) || (inside == t)) ? 1.0 : 0.0);
    #line 54 "iiwa_dnn/references/waypoints.py"
    return ((double_3){{low, (inside - constants.data[(2 + low)]), moves}});
}

/* Compute a x^3 + b x^2 + c x of coefficients (3, 3).
 *
 * iiwa_dnn/references/waypoints.py: _cubic */
static double_3 references_waypoints_cubic(struct arena *arena, Vector constants, int64_t at, double x)
{
    double_3 first;
    #line 64 "iiwa_dnn/references/waypoints.py"
    #line 65 "iiwa_dnn/references/waypoints.py"
    first = references_rotations_combined(arena, x, references_waypoints_triple(arena, constants, at), 1.0, references_waypoints_triple(arena, constants, (at + 3)));
    #line 66 "iiwa_dnn/references/waypoints.py"
    return references_rotations_scaled(arena, x, references_rotations_combined(arena, x, first, 1.0, references_waypoints_triple(arena, constants, (at + 6))));
}

/* 
 *
 * iiwa_dnn/references/waypoints.py: _triple */
static double_3 references_waypoints_triple(struct arena *arena, Vector constants, int64_t at)
{
    (void)arena;
    #line 59 "iiwa_dnn/references/waypoints.py"
    return ((double_3){{constants.data[at], constants.data[(at + 1)], constants.data[(at + 2)]}});
}

/* Compute the derivative of `_cubic` by x.
 *
 * iiwa_dnn/references/waypoints.py: _slope */
static double_3 references_waypoints_slope(struct arena *arena, Vector constants, int64_t at, double x)
{
    double_3 first;
    #line 71 "iiwa_dnn/references/waypoints.py"
    #line 72 "iiwa_dnn/references/waypoints.py"
    first = references_rotations_combined(arena, (3.0 * x), references_waypoints_triple(arena, constants, at), 2.0, references_waypoints_triple(arena, constants, (at + 3)));
    #line 73 "iiwa_dnn/references/waypoints.py"
    return references_rotations_combined(arena, x, first, 1.0, references_waypoints_triple(arena, constants, (at + 6)));
}

/* Write the kinematics at joint positions q (n,) [rad or m], as `Kinematics` holds them.
 *
 * Args:
 *     model: The robot's tables.
 *     q: Joint positions, (n,).
 *     jacobian: Joint Jacobian, (n, 6), overwritten.
 *     placements: Frame placements by frame index, (frames, 12): rows of the model's frames.
 *     inertia: Joint-space inertia matrix [kg m^2], (n, n), overwritten if the model has bodies.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: write_kinematics */
static void robot_kinematics_kernel_write_kinematics(struct arena *arena, const kinematics_kernel_ModelTables *model, Vector q, Matrix jacobian, Matrix placements, Matrix inertia)
{
    Matrix placed;
    Vector start;
    Vector motion;
    double angle;
    Vector carrier;
    const struct arena mark = *arena;
    #line 103 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 112 "iiwa_dnn/robot/kinematics_kernel.py"
    placed = ((Matrix){arena_zeros(arena, ((q.size0) + 1) * 12), ((q.size0) + 1), 12});
    #line 113 "iiwa_dnn/robot/kinematics_kernel.py"
    start = ((Vector){arena_empty(arena, 12), 12});
    #line 114 "iiwa_dnn/robot/kinematics_kernel.py"
    motion = ((Vector){arena_zeros(arena, 12), 12});
    #line 115 "iiwa_dnn/robot/kinematics_kernel.py"
    motion.data[8] = 1.0;
    #line 116 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 117 "iiwa_dnn/robot/kinematics_kernel.py"
        placed.data[(4 * i)] = 1.0;
    }
    #line 118 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t j = 0, end_j = (q.size0); j < end_j; j++) {
        #line 119 "iiwa_dnn/robot/kinematics_kernel.py"
        angle = ((*model).kinds.data[j * (*model).kinds.size1 + 1] * q.data[j]);
        #line 120 "iiwa_dnn/robot/kinematics_kernel.py"
        motion.data[0] = cos(angle);
        #line 121 "iiwa_dnn/robot/kinematics_kernel.py"
        motion.data[1] = sin(angle);
        #line 122 "iiwa_dnn/robot/kinematics_kernel.py"
        motion.data[3] = (-motion.data[1]);
        #line 123 "iiwa_dnn/robot/kinematics_kernel.py"
        motion.data[4] = motion.data[0];
        #line 124 "iiwa_dnn/robot/kinematics_kernel.py"
        motion.data[11] = ((*model).kinds.data[j * (*model).kinds.size1] * q.data[j]);
        #line 125 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_compose(arena, ((Vector){placed.data + (*model).parents.data[j] * placed.size1, placed.size1}), ((Vector){(*model).joints.data + j * (*model).joints.size1, (*model).joints.size1}), start);
        #line 126 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_compose(arena, start, motion, ((Vector){placed.data + (j + 1) * placed.size1, placed.size1}));
        #line 127 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_write_twist(arena, ((Vector){placed.data + (j + 1) * placed.size1, placed.size1}), ((Vector){(*model).kinds.data + j * (*model).kinds.size1, (*model).kinds.size1}), ((Vector){jacobian.data + j * jacobian.size1, jacobian.size1}));
    }
    #line 128 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t k = 0, end_k = (*model).frames.size0; k < end_k; k++) {
        #line 129 "iiwa_dnn/robot/kinematics_kernel.py"
        carrier = ((Vector){placed.data + (*model).frames.data[k * (*model).frames.size1 + 1] * placed.size1, placed.size1});
        #line 130 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_compose(arena, carrier, ((Vector){(*model).offsets.data + k * (*model).offsets.size1, (*model).offsets.size1}), ((Vector){placements.data + (*model).frames.data[k * (*model).frames.size1] * placements.size1, placements.size1}));
    }
    #line 131 "iiwa_dnn/robot/kinematics_kernel.py"
    if ((*model).bodies.size0 > 0) {
        #line 132 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_write_inertia(arena, &(*model), placed, jacobian, inertia);
    }
    arena_leave(arena, &mark);
    return;
}

/* Write the product (12,) of two placements (12,).
 *
 * iiwa_dnn/robot/kinematics_kernel.py: compose */
static void robot_kinematics_kernel_compose(struct arena *arena, Vector first, Vector second, Vector product)
{
    (void)arena;
    #line 137 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 138 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t k = 0, end_k = 4; k < end_k; k++) {
        #line 139 "iiwa_dnn/robot/kinematics_kernel.py"
        for (int64_t i = 0, end_i = 3; i < end_i; i++) {
            #line 140 "iiwa_dnn/robot/kinematics_kernel.py"
            product.data[((3 * k) + i)] = (((first.data[i] * second.data[(3 * k)]) + (first.data[(3 + i)] * second.data[((3 * k) + 1)])) + (first.data[(6 + i)] * second.data[((3 * k) + 2)]));
        }
    }
    #line 145 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 146 "iiwa_dnn/robot/kinematics_kernel.py"
        product.data[(9 + i)] += first.data[(9 + i)];
    }
    return;
}

/* Write a joint's twist (6,) about the world's origin from its placement (12,), kind (2,).
 *
 * iiwa_dnn/robot/kinematics_kernel.py: _write_twist */
static void robot_kinematics_kernel_write_twist(struct arena *arena, Vector placement, Vector kind, Vector twist)
{
    (void)arena;
    Vector axis;
    Vector position;
    double moment;
    #line 151 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 152 "iiwa_dnn/robot/kinematics_kernel.py"
    axis = ((Vector){placement.data + 6, 9 - 6});
    #line 153 "iiwa_dnn/robot/kinematics_kernel.py"
    position = ((Vector){placement.data + 9, placement.size0 - 9});
    #line 154 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 155 "iiwa_dnn/robot/kinematics_kernel.py"
        twist.data[(3 + i)] = (kind.data[1] * axis.data[i]);
        #line 156 "iiwa_dnn/robot/kinematics_kernel.py"
        moment = (position.data[((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)]] * axis.data[((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)]]);
        #line 157 "iiwa_dnn/robot/kinematics_kernel.py"
        moment -= (position.data[((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)]] * axis.data[((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)]]);
        #line 158 "iiwa_dnn/robot/kinematics_kernel.py"
        twist.data[i] = ((kind.data[0] * axis.data[i]) + (kind.data[1] * moment));
    }
    return;
}

/* Write the inertia matrix (n, n) out of the joints' placements (n + 1, 12) and twists (n, 6).
 *
 * Each body adds the products of what its joints move it by, times the roots of mass and moments.
 *
 * iiwa_dnn/robot/kinematics_kernel.py: _write_inertia */
static void robot_kinematics_kernel_write_inertia(struct arena *arena, const kinematics_kernel_ModelTables *model, Matrix placed, Matrix jacobian, Matrix inertia)
{
    int64_t n;
    Vector own;
    Matrix moved;
    double factor;
    double along;
    double turned;
    const struct arena mark = *arena;
    #line 163 "iiwa_dnn/robot/kinematics_kernel.py"
    #line 167 "iiwa_dnn/robot/kinematics_kernel.py"
    n = inertia.size0;
    #line 168 "iiwa_dnn/robot/kinematics_kernel.py"
    own = ((Vector){arena_empty(arena, 12), 12});
    #line 169 "iiwa_dnn/robot/kinematics_kernel.py"
    moved = ((Matrix){arena_empty(arena, n * 6), n, 6});
    #line 170 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 171 "iiwa_dnn/robot/kinematics_kernel.py"
        for (int64_t j = 0, end_j = n; j < end_j; j++) {
            #line 172 "iiwa_dnn/robot/kinematics_kernel.py"
            inertia.data[i * inertia.size1 + j] = ((i == j) ? (*model).armature.data[i] : 0.0);
        }
    }
    #line 173 "iiwa_dnn/robot/kinematics_kernel.py"
    for (int64_t body = 0, end_body = n; body < end_body; body++) {
        #line 174 "iiwa_dnn/robot/kinematics_kernel.py"
        robot_kinematics_kernel_compose(arena, ((Vector){placed.data + (body + 1) * placed.size1, placed.size1}), ((Vector){(*model).bodies.data + body * (*model).bodies.size1, 12 - 0}), own);
        #line 175 "iiwa_dnn/robot/kinematics_kernel.py"
        for (int64_t j = 0, end_j = n; j < end_j; j++) {
            #line 176 "iiwa_dnn/robot/kinematics_kernel.py"
            factor = ((*model).supports.data[body * (*model).supports.size1 + j] * (*model).bodies.data[body * (*model).bodies.size1 + 12]);
            #line 177 "iiwa_dnn/robot/kinematics_kernel.py"
            for (int64_t i = 0, end_i = 3; i < end_i; i++) {
                #line 178 "iiwa_dnn/robot/kinematics_kernel.py"
                along = 0.0;
                #line 179 "iiwa_dnn/robot/kinematics_kernel.py"
                for (int64_t k = 0, end_k = 3; k < end_k; k++) {
                    #line 180 "iiwa_dnn/robot/kinematics_kernel.py"
                    along += (own.data[((3 * i) + k)] * jacobian.data[j * jacobian.size1 + (3 + k)]);
                }
                #line 181 "iiwa_dnn/robot/kinematics_kernel.py"
                moved.data[j * moved.size1 + (3 + i)] = (((*model).supports.data[body * (*model).supports.size1 + j] * (*model).bodies.data[body * (*model).bodies.size1 + (13 + i)]) * along);
                #line 182 "iiwa_dnn/robot/kinematics_kernel.py"
                turned = (jacobian.data[j * jacobian.size1 + (3 + ((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)])] * own.data[(9 + ((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)])]);
                #line 183 "iiwa_dnn/robot/kinematics_kernel.py"
                turned -= (jacobian.data[j * jacobian.size1 + (3 + ((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)])] * own.data[(9 + ((IntVector){(int64_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)])]);
                #line 184 "iiwa_dnn/robot/kinematics_kernel.py"
                moved.data[j * moved.size1 + i] = (factor * (jacobian.data[j * jacobian.size1 + i] + turned));
            }
        }
        #line 185 "iiwa_dnn/robot/kinematics_kernel.py"
        for (int64_t i = 0, end_i = n; i < end_i; i++) {
            #line 186 "iiwa_dnn/robot/kinematics_kernel.py"
            for (int64_t j = 0, end_j = n; j < end_j; j++) {
                #line 187 "iiwa_dnn/robot/kinematics_kernel.py"
                for (int64_t k = 0, end_k = 6; k < end_k; k++) {
                    #line 188 "iiwa_dnn/robot/kinematics_kernel.py"
                    inertia.data[i * inertia.size1 + j] += (moved.data[i * moved.size1 + k] * moved.data[j * moved.size1 + k]);
                }
            }
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Write the rows of the pairs that are nearest to being active.
 *
 * They go into G (rows, n) and h (rows,); `constants` (k,) are `Scene.constants`, and the bounds
 * lb (n,) and ub (n,) stay.
 *
 * iiwa_dnn/schemes/collisions.py: collision_rows */
static void schemes_collisions_collision_rows(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)lb;
    (void)ub;
    int64_t dof;
    scene_SceneViews scene;
    int64_t pairs;
    Matrix gradients;
    Vector limits;
    Vector slacks;
    Matrix placed;
    double gain;
    Vector travel;
    scene_Contact contact;
    double fastest;
    double left;
    double eps;
    int64_t row;
    const struct arena mark = *arena;
    #line 53 "iiwa_dnn/schemes/collisions.py"
    #line 58 "iiwa_dnn/schemes/collisions.py"
    dof = ((*step).q.size0);
    #line 59 "iiwa_dnn/schemes/collisions.py"
    scene = schemes_scene_scene_views(arena, constants, dof);
    #line 60 "iiwa_dnn/schemes/collisions.py"
    pairs = scene.pairs.size0;
    #line 61 "iiwa_dnn/schemes/collisions.py"
    gradients = ((Matrix){arena_empty(arena, pairs * dof), pairs, dof});
    #line 62 "iiwa_dnn/schemes/collisions.py"
    limits = ((Vector){arena_empty(arena, pairs), pairs});
    #line 63 "iiwa_dnn/schemes/collisions.py"
    slacks = ((Vector){arena_empty(arena, pairs), pairs});
    #line 64 "iiwa_dnn/schemes/collisions.py"
    placed = ((Matrix){arena_empty(arena, scene.bodies.size0 * 12), scene.bodies.size0, 12});
    #line 65 "iiwa_dnn/schemes/collisions.py"
    schemes_scene_place_bodies(arena, &scene, (*step).placements, placed);
    #line 66 "iiwa_dnn/schemes/collisions.py"
    gain = double_min(scene.gain, (*step).rate);
    #line 67 "iiwa_dnn/schemes/collisions.py"
    travel = ((Vector){arena_empty(arena, dof), dof});
    #line 68 "iiwa_dnn/schemes/collisions.py"
    for (int64_t j = 0, end_j = dof; j < end_j; j++) {
        #line 69 "iiwa_dnn/schemes/collisions.py"
        travel.data[j] = ((double)fabs((*step).last.data[j]) / (*step).rate);
    }
    #line 70 "iiwa_dnn/schemes/collisions.py"
    for (int64_t k = 0, end_k = pairs; k < end_k; k++) {
        #line 71 "iiwa_dnn/schemes/collisions.py"
        contact = schemes_scene_contact_of(arena, &scene, k, placed);
        #line 72 "iiwa_dnn/schemes/collisions.py"
        fastest = schemes_collisions_write_gradient(arena, scene.moves, &contact, (*step).jacobian, scene.dq_max, k, gradients);
        #line 73 "iiwa_dnn/schemes/collisions.py"
        left = (contact.distance - scene.least);
        #line 74 "iiwa_dnn/schemes/collisions.py"
        limits.data[k] = ((gain * left) - scene.pairs.data[k * scene.pairs.size1]);
        #line 75 "iiwa_dnn/schemes/collisions.py"
        slacks.data[k] = (limits.data[k] - fastest);
        #line 76 "iiwa_dnn/schemes/collisions.py"
        if (slacks.data[k] < 0.0) {
            #line 77 "iiwa_dnn/schemes/collisions.py"
            eps = schemes_scene_second_order(arena, scene.moves, scene.radii, k, travel);
            #line 78 "iiwa_dnn/schemes/collisions.py"
            limits.data[k] -= (gain * eps);
            #line 79 "iiwa_dnn/schemes/collisions.py"
            if ((left < eps) && ((*step).rate < INFINITY)) {
                #line 80 "iiwa_dnn/schemes/collisions.py"
                limits.data[k] -= (((*step).rate - gain) * double_min((eps - left), eps));
            }
        }
    }
    #line 81 "iiwa_dnn/schemes/collisions.py"
    row = 0;
    #line 82 "iiwa_dnn/schemes/collisions.py"
    for (int64_t k = 0, end_k = pairs; k < end_k; k++) {
        #line 83 "iiwa_dnn/schemes/collisions.py"
        if ((pairs <= (h.size0)) || (schemes_collisions_rank(arena, slacks, k) < (h.size0))) {
            #line 84 "iiwa_dnn/schemes/collisions.py"
            for (int64_t j = 0, end_j = dof; j < end_j; j++) {
                #line 85 "iiwa_dnn/schemes/collisions.py"
                G.data[row * G.size1 + j] = gradients.data[k * gradients.size1 + j];
            }
            #line 86 "iiwa_dnn/schemes/collisions.py"
            h.data[row] = ((slacks.data[k] < 0.0) ? limits.data[k] : INFINITY);
            #line 87 "iiwa_dnn/schemes/collisions.py"
            row += 1;
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Write row k of the gradients (pairs, n): the rate at which a pair's distance shrinks.
 *
 * Returns:
 *     The largest rate that the velocity limits of the joints allow [m/s].
 *
 * iiwa_dnn/schemes/collisions.py: _write_gradient */
static double schemes_collisions_write_gradient(struct arena *arena, Matrix moves, const scene_Contact *contact, Matrix jacobian, Vector dq_max, int64_t k, Matrix gradients)
{
    double fastest;
    double value;
    double_3 point;
    #line 103 "iiwa_dnn/schemes/collisions.py"
    #line 108 "iiwa_dnn/schemes/collisions.py"
    fastest = 0.0;
    #line 109 "iiwa_dnn/schemes/collisions.py"
    for (int64_t j = 0, end_j = (dq_max.size0); j < end_j; j++) {
        #line 110 "iiwa_dnn/schemes/collisions.py"
        value = 0.0;
        #line 111 "iiwa_dnn/schemes/collisions.py"
        if (moves.data[k * moves.size1 + j] != 0.0) {
            #line 112 "iiwa_dnn/schemes/collisions.py"
            point = ((moves.data[k * moves.size1 + j] > 0.0) ? (*contact).second : (*contact).first);
            #line 113 "iiwa_dnn/schemes/collisions.py"
            value = schemes_step_rate_along(arena, jacobian, j, point, (*contact).normal);
        }
        #line 114 "iiwa_dnn/schemes/collisions.py"
        gradients.data[k * gradients.size1 + j] = ((-moves.data[k * moves.size1 + j]) * value);
        #line 115 "iiwa_dnn/schemes/collisions.py"
        fastest += (fabs(value) * dq_max.data[j]);
    }
    #line 116 "iiwa_dnn/schemes/collisions.py"
    return fastest;
}

/* Count the pairs that are nearer to being active than a pair, by their slacks (pairs,).
 *
 * iiwa_dnn/schemes/collisions.py: _rank */
static int64_t schemes_collisions_rank(struct arena *arena, Vector slacks, int64_t k)
{
    (void)arena;
    int64_t rank;
    #line 92 "iiwa_dnn/schemes/collisions.py"
    #line 93 "iiwa_dnn/schemes/collisions.py"
    rank = 0;
    #line 94 "iiwa_dnn/schemes/collisions.py"
    for (int64_t i = 0, end_i = (slacks.size0); i < end_i; i++) {
        #line 95 "iiwa_dnn/schemes/collisions.py"
        rank += ((slacks.data[i] < slacks.data[k]) || ((slacks.data[i] == slacks.data[k]) && (i < k)));
    }
    #line 96 "iiwa_dnn/schemes/collisions.py"
    return rank;
}

/* Add w G(q) to P; the constants are those of `KineticEnergy`.
 *
 * iiwa_dnn/schemes/costs.py: add_kinetic_energy */
static void schemes_costs_add_kinetic_energy(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    (void)q;
    double weight;
    #line 40 "iiwa_dnn/schemes/costs.py"
    #line 41 "iiwa_dnn/schemes/costs.py"
    weight = constants.data[0];
    #line 42 "iiwa_dnn/schemes/costs.py"
    for (int64_t i = 0, end_i = ((*step).q.size0); i < end_i; i++) {
        #line 43 "iiwa_dnn/schemes/costs.py"
        if (constants.data[1] == 0.0) {
            #line 44 "iiwa_dnn/schemes/costs.py"
            P.data[i * P.size1 + i] += weight;
        }
        else {
            #line 46 "iiwa_dnn/schemes/costs.py"
            for (int64_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
                #line 47 "iiwa_dnn/schemes/costs.py"
                P.data[i * P.size1 + j] += (weight * (*step).inertia.data[i * (*step).inertia.size1 + j]);
            }
        }
    }
    return;
}

/* Add w I to P and w m (q - home) to the linear term; constants of `CyclicMotion`.
 *
 * iiwa_dnn/schemes/costs.py: add_cyclic_motion */
static void schemes_costs_add_cyclic_motion(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    double weight;
    double gain;
    #line 75 "iiwa_dnn/schemes/costs.py"
    #line 76 "iiwa_dnn/schemes/costs.py"
    weight = constants.data[0];
    #line 77 "iiwa_dnn/schemes/costs.py"
    gain = constants.data[1];
    #line 78 "iiwa_dnn/schemes/costs.py"
    for (int64_t i = 0, end_i = ((*step).q.size0); i < end_i; i++) {
        #line 79 "iiwa_dnn/schemes/costs.py"
        P.data[i * P.size1 + i] += weight;
        #line 80 "iiwa_dnn/schemes/costs.py"
        q.data[i] += ((weight * gain) * ((*step).q.data[i] - constants.data[(2 + i)]));
    }
    return;
}

/* Tighten the bounds to those of `JointLimits`, whose constants these are.
 *
 * iiwa_dnn/schemes/limits.py: joint_limits */
static void schemes_limits_joint_limits(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)G;
    (void)h;
    int64_t dof;
    double gain;
    Matrix limits;
    double above;
    double below;
    double fastest;
    double up;
    double down;
    #line 89 "iiwa_dnn/schemes/limits.py"
    #line 90 "iiwa_dnn/schemes/limits.py"
    dof = ((*step).q.size0);
    #line 91 "iiwa_dnn/schemes/limits.py"
    gain = double_min(constants.data[0], (*step).rate);
    #line 92 "iiwa_dnn/schemes/limits.py"
    limits = ((Matrix){((Vector){constants.data + 1, constants.size0 - 1}).data, 5, dof});
    #line 93 "iiwa_dnn/schemes/limits.py"
    for (int64_t i = 0, end_i = dof; i < end_i; i++) {
        #line 94 "iiwa_dnn/schemes/limits.py"
        above = (limits.data[1 * limits.size1 + i] - (*step).q.data[i]);
        #line 95 "iiwa_dnn/schemes/limits.py"
        below = ((*step).q.data[i] - limits.data[i]);
        #line 96 "iiwa_dnn/schemes/limits.py"
        fastest = limits.data[2 * limits.size1 + i];
        #line 97 "iiwa_dnn/schemes/limits.py"
        up = double_min(fastest, schemes_limits_ramp_speed(arena, above, limits.data[3 * limits.size1 + i], limits.data[4 * limits.size1 + i]));
        #line 98 "iiwa_dnn/schemes/limits.py"
        down = double_min(fastest, schemes_limits_ramp_speed(arena, below, limits.data[3 * limits.size1 + i], limits.data[4 * limits.size1 + i]));
        #line 99 "iiwa_dnn/schemes/limits.py"
        lb.data[i] = double_max(lb.data[i], double_min(double_max(((-gain) * below), (-down)), up));
        #line 100 "iiwa_dnn/schemes/limits.py"
        ub.data[i] = double_min(ub.data[i], double_min(double_max((gain * above), (-down)), up));
    }
    return;
}

/* Compute the speed that a ramp allows at a distance from a position limit [rad/s].
 *
 * Args:
 *     distance: The distance [rad].
 *     offset: Offset of the ramp [rad/s].
 *     deceleration: Deceleration along the ramp [rad/s^2]; inf for a joint without one.
 *
 * iiwa_dnn/schemes/limits.py: ramp_speed */
static double schemes_limits_ramp_speed(struct arena *arena, double distance, double offset, double deceleration)
{
    (void)arena;
    #line 105 "iiwa_dnn/schemes/limits.py"
    #line 112 "iiwa_dnn/schemes/limits.py"
    if (!(deceleration < INFINITY)) {
        #line 113 "iiwa_dnn/schemes/limits.py"
        return INFINITY;
    }
    #line 114 "iiwa_dnn/schemes/limits.py"
    return double_max((sqrt(((2.0 * deceleration) * double_max(distance, 0.0))) - offset), 0.0);
}

/* Put the bounds of the joints inside those of `MotionLimits`, whose constants these are.
 *
 * Bounds of other limits give way where they contradict: the position and velocity limits are
 * kept by these bounds too. Without a control period there are none.
 *
 * iiwa_dnn/schemes/limits.py: motion_limits */
static void schemes_limits_motion_limits(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)G;
    (void)h;
    Matrix limits;
    double dt;
    double above;
    double below;
    double_4 rates;
    double lower;
    double upper;
    #line 215 "iiwa_dnn/schemes/limits.py"
    #line 220 "iiwa_dnn/schemes/limits.py"
    if (!((*step).rate < INFINITY)) {
        #line 221 "iiwa_dnn/schemes/limits.py"
        return;
    }
    #line 222 "iiwa_dnn/schemes/limits.py"
    limits = ((Matrix){constants.data, 6, ((*step).q.size0)});
    #line 223 "iiwa_dnn/schemes/limits.py"
    dt = ((double)1.0 / (*step).rate);
    #line 224 "iiwa_dnn/schemes/limits.py"
    for (int64_t i = 0, end_i = ((*step).q.size0); i < end_i; i++) {
        #line 225 "iiwa_dnn/schemes/limits.py"
        above = (limits.data[1 * limits.size1 + i] - (*step).q.data[i]);
        #line 226 "iiwa_dnn/schemes/limits.py"
        below = ((*step).q.data[i] - limits.data[i]);
        #line 227 "iiwa_dnn/schemes/limits.py"
        rates = ((double_4){{limits.data[2 * limits.size1 + i], limits.data[3 * limits.size1 + i], limits.data[4 * limits.size1 + i], limits.data[5 * limits.size1 + i]}});
        #line 228 "iiwa_dnn/schemes/limits.py"
        const double_2 own_18 = schemes_limits_joint_bounds(arena, (*step).last.data[i], (*step).before.data[i], above, below, rates, dt);
        lower = own_18.at[0];
        upper = own_18.at[1];
        #line 229 "iiwa_dnn/schemes/limits.py"
        lb.data[i] = double_min(double_max(lb.data[i], lower), upper);
        #line 230 "iiwa_dnn/schemes/limits.py"
        ub.data[i] = double_min(double_max(ub.data[i], lower), upper);
    }
    return;
}

/* Tighten the bounds to those of `TipSpeedLimit`, whose constants these are.
 *
 * iiwa_dnn/schemes/limits.py: tip_speed_bounds */
static void schemes_limits_tip_speed_bounds(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    (void)G;
    (void)h;
    int64_t frame;
    double gain;
    double_3 point;
    double_3 velocity;
    double share;
    double speed;
    double_3 direction;
    Vector along;
    double total;
    double growth;
    const struct arena mark = *arena;
    #line 502 "iiwa_dnn/schemes/limits.py"
    #line 503 "iiwa_dnn/schemes/limits.py"
    frame = (int64_t)(constants.data[0]);
    #line 504 "iiwa_dnn/schemes/limits.py"
    gain = double_min(constants.data[2], (*step).rate);
    #line 505 "iiwa_dnn/schemes/limits.py"
    point = schemes_step_vector_at(arena, ((Vector){(*step).placements.data + frame * (*step).placements.size1, (*step).placements.size1}), 9);
    #line 506 "iiwa_dnn/schemes/limits.py"
    velocity = ((double_3){{0.0, 0.0, 0.0}});
    #line 507 "iiwa_dnn/schemes/limits.py"
    for (int64_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        #line 508 "iiwa_dnn/schemes/limits.py"
        share = ((*step).last.data[j] * (*step).moves.data[frame * (*step).moves.size1 + j]);
        #line 509 "iiwa_dnn/schemes/limits.py"
        velocity = references_rotations_combined(arena, 1.0, velocity, share, schemes_step_point_rate(arena, (*step).jacobian, j, point));
    }
    #line 510 "iiwa_dnn/schemes/limits.py"
    speed = sqrt(references_rotations_dot(arena, velocity, velocity));
    #line 511 "iiwa_dnn/schemes/limits.py"
    if (!((speed > 0.0) && ((*step).rate < INFINITY))) {
        #line 512 "iiwa_dnn/schemes/limits.py"
        arena_leave(arena, &mark);
        return;
    }
    #line 513 "iiwa_dnn/schemes/limits.py"
    direction = references_rotations_scaled(arena, ((double)1.0 / speed), velocity);
    #line 514 "iiwa_dnn/schemes/limits.py"
    along = ((Vector){arena_empty(arena, ((*step).q.size0)), ((*step).q.size0)});
    #line 515 "iiwa_dnn/schemes/limits.py"
    total = 0.0;
    #line 516 "iiwa_dnn/schemes/limits.py"
    for (int64_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        #line 517 "iiwa_dnn/schemes/limits.py"
        along.data[j] = ((*step).moves.data[frame * (*step).moves.size1 + j] * schemes_step_rate_along(arena, (*step).jacobian, j, point, direction));
        #line 518 "iiwa_dnn/schemes/limits.py"
        total += fabs(along.data[j]);
    }
    #line 519 "iiwa_dnn/schemes/limits.py"
    growth = ((double)(((double)gain / (*step).rate) * (constants.data[1] - speed)) / total);
    #line 520 "iiwa_dnn/schemes/limits.py"
    for (int64_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        #line 521 "iiwa_dnn/schemes/limits.py"
        if (along.data[j] > 1e-06) {
            #line 522 "iiwa_dnn/schemes/limits.py"
            ub.data[j] = double_max(double_min(ub.data[j], ((*step).last.data[j] + growth)), lb.data[j]);
        }
        else {
            #line 523 "iiwa_dnn/schemes/limits.py"
            if (along.data[j] < (-1e-06)) {
                #line 524 "iiwa_dnn/schemes/limits.py"
                lb.data[j] = double_min(double_max(lb.data[j], ((*step).last.data[j] - growth)), ub.data[j]);
            }
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Add P and q from the constants.
 *
 * iiwa_dnn/schemes/parts.py: copy_cost */
static void schemes_parts_copy_cost(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    (void)step;
    int64_t n;
    #line 215 "iiwa_dnn/schemes/parts.py"
    #line 216 "iiwa_dnn/schemes/parts.py"
    n = (q.size0);
    #line 217 "iiwa_dnn/schemes/parts.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 218 "iiwa_dnn/schemes/parts.py"
        q.data[i] += constants.data[((n * n) + i)];
        #line 219 "iiwa_dnn/schemes/parts.py"
        for (int64_t k = 0, end_k = n; k < end_k; k++) {
            #line 220 "iiwa_dnn/schemes/parts.py"
            P.data[i * P.size1 + k] += constants.data[((n * i) + k)];
        }
    }
    return;
}

/* Write A and b from the constants.
 *
 * iiwa_dnn/schemes/parts.py: copy_task */
static void schemes_parts_copy_task(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    (void)arena;
    (void)step;
    (void)target;
    int64_t n;
    #line 225 "iiwa_dnn/schemes/parts.py"
    #line 226 "iiwa_dnn/schemes/parts.py"
    n = A.size1;
    #line 227 "iiwa_dnn/schemes/parts.py"
    for (int64_t j = 0, end_j = (b.size0); j < end_j; j++) {
        #line 228 "iiwa_dnn/schemes/parts.py"
        b.data[j] = constants.data[((n * (b.size0)) + j)];
        #line 229 "iiwa_dnn/schemes/parts.py"
        for (int64_t i = 0, end_i = n; i < end_i; i++) {
            #line 230 "iiwa_dnn/schemes/parts.py"
            A.data[j * A.size1 + i] = constants.data[((n * j) + i)];
        }
    }
    return;
}

/* Write G and h, and tighten lb and ub, from the constants.
 *
 * iiwa_dnn/schemes/parts.py: copy_limit */
static void schemes_parts_copy_limit(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    int64_t n;
    int64_t first;
    #line 237 "iiwa_dnn/schemes/parts.py"
    #line 238 "iiwa_dnn/schemes/parts.py"
    schemes_parts_copy_task(arena, &(*step), constants, h, G, h);
    #line 239 "iiwa_dnn/schemes/parts.py"
    n = (lb.size0);
    #line 240 "iiwa_dnn/schemes/parts.py"
    first = ((h.size0) * (n + 1));
    #line 241 "iiwa_dnn/schemes/parts.py"
    for (int64_t i = 0, end_i = n; i < end_i; i++) {
        #line 242 "iiwa_dnn/schemes/parts.py"
        lb.data[i] = double_max(lb.data[i], constants.data[(first + i)]);
        #line 243 "iiwa_dnn/schemes/parts.py"
        ub.data[i] = double_min(ub.data[i], constants.data[((first + n) + i)]);
    }
    return;
}

/* Write the centres of moving obstacles at time t [s] into the constants (k,).
 *
 * Each row of the centers (obstacles, 7) has the first of a centre's indices, the centre at time 0
 * [m], and its velocity [m/s].
 *
 * iiwa_dnn/schemes/scene.py: move_centers */
static void schemes_scene_move_centers(struct arena *arena, Vector constants, Matrix centers, double t)
{
    (void)arena;
    int64_t first;
    #line 302 "iiwa_dnn/schemes/scene.py"
    #line 307 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0, end_k = centers.size0; k < end_k; k++) {
        #line 308 "iiwa_dnn/schemes/scene.py"
        first = (int64_t)(centers.data[k * centers.size1]);
        #line 309 "iiwa_dnn/schemes/scene.py"
        for (int64_t i = 0, end_i = 3; i < end_i; i++) {
            #line 310 "iiwa_dnn/schemes/scene.py"
            constants.data[(first + i)] = (centers.data[k * centers.size1 + (1 + i)] + (t * centers.data[k * centers.size1 + (4 + i)]));
        }
    }
    return;
}

/* Write the distance of each pair [m].
 *
 * Args:
 *     constants: `Scene.constants`, (k,).
 *     dof: Number of the robot's joints.
 *     placements: `Kinematics.placements`, (frames, 12).
 *     distances: The distances, (pairs,), overwritten.
 *
 * iiwa_dnn/schemes/scene.py: write_distances */
static void schemes_scene_write_distances(struct arena *arena, Vector constants, int64_t dof, Matrix placements, Vector distances)
{
    scene_SceneViews scene;
    Matrix placed;
    const struct arena mark = *arena;
    #line 361 "iiwa_dnn/schemes/scene.py"
    #line 369 "iiwa_dnn/schemes/scene.py"
    scene = schemes_scene_scene_views(arena, constants, dof);
    #line 370 "iiwa_dnn/schemes/scene.py"
    placed = ((Matrix){arena_empty(arena, scene.bodies.size0 * 12), scene.bodies.size0, 12});
    #line 371 "iiwa_dnn/schemes/scene.py"
    schemes_scene_place_bodies(arena, &scene, placements, placed);
    #line 372 "iiwa_dnn/schemes/scene.py"
    for (int64_t k = 0, end_k = (distances.size0); k < end_k; k++) {
        #line 373 "iiwa_dnn/schemes/scene.py"
        distances.data[k] = schemes_scene_contact_of(arena, &scene, k, placed).distance;
    }
    arena_leave(arena, &mark);
    return;
}

/* Write the velocity along an axis of a frame's point as seen from its base, a row (n,).
 *
 * iiwa_dnn/schemes/step.py: write_velocity */
static void schemes_step_write_velocity(struct arena *arena, const step_StepViews *step, Vector constants, double_3 point, double_3 axis, Vector row)
{
    int64_t frame;
    int64_t base;
    double sign;
    #line 173 "iiwa_dnn/schemes/step.py"
    #line 174 "iiwa_dnn/schemes/step.py"
    frame = (int64_t)(constants.data[0]);
    #line 175 "iiwa_dnn/schemes/step.py"
    base = (int64_t)(constants.data[2]);
    #line 176 "iiwa_dnn/schemes/step.py"
    for (int64_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        #line 177 "iiwa_dnn/schemes/step.py"
        sign = ((*step).moves.data[frame * (*step).moves.size1 + j] - (*step).moves.data[base * (*step).moves.size1 + j]);
        #line 178 "iiwa_dnn/schemes/step.py"
        row.data[j] = (sign * schemes_step_rate_along(arena, (*step).jacobian, j, point, axis));
    }
    return;
}

/* Write the angular velocity about an axis of a frame as seen from its base, a row (n,).
 *
 * iiwa_dnn/schemes/step.py: write_spin */
static void schemes_step_write_spin(struct arena *arena, const step_StepViews *step, Vector constants, double_3 axis, Vector row)
{
    int64_t frame;
    int64_t base;
    double sign;
    #line 183 "iiwa_dnn/schemes/step.py"
    #line 184 "iiwa_dnn/schemes/step.py"
    frame = (int64_t)(constants.data[0]);
    #line 185 "iiwa_dnn/schemes/step.py"
    base = (int64_t)(constants.data[2]);
    #line 186 "iiwa_dnn/schemes/step.py"
    for (int64_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        #line 187 "iiwa_dnn/schemes/step.py"
        sign = ((*step).moves.data[frame * (*step).moves.size1 + j] - (*step).moves.data[base * (*step).moves.size1 + j]);
        #line 188 "iiwa_dnn/schemes/step.py"
        row.data[j] = (sign * references_rotations_dot(arena, axis, schemes_step_vector_at(arena, ((Vector){(*step).jacobian.data + j * (*step).jacobian.size1, (*step).jacobian.size1}), 3)));
    }
    return;
}

/* Write the rows of a frame's position as seen from its base, three.
 *
 * iiwa_dnn/schemes/tasks.py: position_rows */
static void schemes_tasks_position_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    double gain;
    Vector base;
    double_3 point;
    double_3 offset;
    double_3 axis;
    #line 65 "iiwa_dnn/schemes/tasks.py"
    #line 66 "iiwa_dnn/schemes/tasks.py"
    gain = double_min(constants.data[1], (*step).rate);
    #line 67 "iiwa_dnn/schemes/tasks.py"
    base = ((Vector){(*step).placements.data + (int64_t)(constants.data[2]) * (*step).placements.size1, (*step).placements.size1});
    #line 68 "iiwa_dnn/schemes/tasks.py"
    point = schemes_step_vector_at(arena, ((Vector){(*step).placements.data + (int64_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1}), 9);
    #line 69 "iiwa_dnn/schemes/tasks.py"
    offset = references_rotations_combined(arena, 1.0, point, (-1.0), schemes_step_vector_at(arena, base, 9));
    #line 70 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 71 "iiwa_dnn/schemes/tasks.py"
        axis = schemes_step_vector_at(arena, base, (3 * i));
        #line 72 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = (target.data[(12 + i)] + (gain * (target.data[i] - references_rotations_dot(arena, axis, offset))));
        #line 73 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_velocity(arena, &(*step), constants, point, axis, ((Vector){A.data + i * A.size1, A.size1}));
    }
    return;
}

/* Write the rows of a frame's orientation as seen from its base, three.
 *
 * iiwa_dnn/schemes/tasks.py: rotation_rows */
static void schemes_tasks_rotation_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    double gain;
    Vector base;
    Vector placement;
    Matrix missing;
    Vector error;
    double_3 seen;
    const struct arena mark = *arena;
    #line 78 "iiwa_dnn/schemes/tasks.py"
    #line 79 "iiwa_dnn/schemes/tasks.py"
    gain = double_min(constants.data[1], (*step).rate);
    #line 80 "iiwa_dnn/schemes/tasks.py"
    base = ((Vector){(*step).placements.data + (int64_t)(constants.data[2]) * (*step).placements.size1, (*step).placements.size1});
    #line 81 "iiwa_dnn/schemes/tasks.py"
    placement = ((Vector){(*step).placements.data + (int64_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1});
    #line 82 "iiwa_dnn/schemes/tasks.py"
    missing = ((Matrix){arena_empty(arena, 3 * 3), 3, 3});
    #line 83 "iiwa_dnn/schemes/tasks.py"
    error = ((Vector){arena_empty(arena, 3), 3});
    #line 84 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 85 "iiwa_dnn/schemes/tasks.py"
        for (int64_t k = 0, end_k = 3; k < end_k; k++) {
            #line 86 "iiwa_dnn/schemes/tasks.py"
            seen = schemes_step_seen_from(arena, placement, schemes_step_vector_at(arena, base, (3 * k)));
            #line 87 "iiwa_dnn/schemes/tasks.py"
            missing.data[i * missing.size1 + k] = references_rotations_dot(arena, references_rotations_row_of(arena, target, i), seen);
        }
    }
    #line 88 "iiwa_dnn/schemes/tasks.py"
    references_rotations_rotation_log(arena, missing, error);
    #line 89 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 3; i < end_i; i++) {
        #line 90 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = (target.data[(15 + i)] + (gain * error.data[i]));
        #line 91 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_spin(arena, &(*step), constants, schemes_step_vector_at(arena, base, (3 * i)), ((Vector){A.data + i * A.size1, A.size1}));
    }
    arena_leave(arena, &mark);
    return;
}

/* Write the rows of `OrientationTask` in the form ``block``, four.
 *
 * iiwa_dnn/schemes/tasks.py: block_rows */
static void schemes_tasks_block_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    double gain;
    Vector placement;
    double_3 unit;
    double_3 here;
    double_3 there;
    #line 96 "iiwa_dnn/schemes/tasks.py"
    #line 97 "iiwa_dnn/schemes/tasks.py"
    gain = double_min(constants.data[1], (*step).rate);
    #line 98 "iiwa_dnn/schemes/tasks.py"
    placement = ((Vector){(*step).placements.data + (int64_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1});
    #line 99 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 4; i < end_i; i++) {
        #line 100 "iiwa_dnn/schemes/tasks.py"
        unit = ((i < 2) ? ((double_3){{1.0, 0.0, 0.0}}) : ((double_3){{0.0, 1.0, 0.0}}));
        #line 101 "iiwa_dnn/schemes/tasks.py"
        here = schemes_step_vector_at(arena, placement, (3 * int_remainder(i, 2)));
        #line 102 "iiwa_dnn/schemes/tasks.py"
        there = references_rotations_column_of(arena, target, int_remainder(i, 2));
        #line 103 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = (gain * references_rotations_dot(arena, unit, references_rotations_combined(arena, 1.0, there, (-1.0), here)));
        #line 104 "iiwa_dnn/schemes/tasks.py"
        b.data[i] += references_rotations_dot(arena, references_rotations_cross(arena, there, unit), schemes_step_vector_at(arena, target, 15));
        #line 105 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_spin(arena, &(*step), constants, references_rotations_cross(arena, here, unit), ((Vector){A.data + i * A.size1, A.size1}));
    }
    #line 106 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_project_on_range(arena, placement, b);
    return;
}

/* Replace b (4,) by its projection on the range of W of a frame's placement (12,).
 *
 * iiwa_dnn/schemes/tasks.py: project_on_range */
static void schemes_tasks_project_on_range(struct arena *arena, Vector placement, Vector b)
{
    double row;
    double column;
    Vector normal;
    double first;
    double second;
    double along;
    const struct arena mark = *arena;
    #line 111 "iiwa_dnn/schemes/tasks.py"
    #line 112 "iiwa_dnn/schemes/tasks.py"
    row = sqrt(((placement.data[2] * placement.data[2]) + (placement.data[5] * placement.data[5])));
    #line 113 "iiwa_dnn/schemes/tasks.py"
    column = sqrt(((placement.data[6] * placement.data[6]) + (placement.data[7] * placement.data[7])));
    #line 114 "iiwa_dnn/schemes/tasks.py"
    normal = ((Vector){arena_empty(arena, 4), 4});
    #line 115 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 4; i < end_i; i++) {
        #line 116 "iiwa_dnn/schemes/tasks.py"
        if (row > 1e-09) {
            #line 117 "iiwa_dnn/schemes/tasks.py"
            first = ((i < 2) ? placement.data[7] : (-placement.data[6]));
            #line 118 "iiwa_dnn/schemes/tasks.py"
            second = ((int_remainder(i, 2) == 0) ? (-placement.data[5]) : placement.data[2]);
            #line 119 "iiwa_dnn/schemes/tasks.py"
            normal.data[i] = ((double)(first * second) / (row * column));
        }
        else {
            #line 121 "iiwa_dnn/schemes/tasks.py"
            first = ((i < 2) ? (-placement.data[((int_remainder(i, 2) * 3) + 1)]) : placement.data[(int_remainder(i, 2) * 3)]);
            #line 122 "iiwa_dnn/schemes/tasks.py"
            normal.data[i] = ((double)first / sqrt(2.0));
        }
    }
    #line 123 "iiwa_dnn/schemes/tasks.py"
    along = ((((normal.data[0] * b.data[0]) + (normal.data[1] * b.data[1])) + (normal.data[2] * b.data[2])) + (normal.data[3] * b.data[3]));
    #line 124 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 4; i < end_i; i++) {
        #line 125 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = ((row > 1e-09) ? (b.data[i] - (along * normal.data[i])) : (along * normal.data[i]));
    }
    arena_leave(arena, &mark);
    return;
}

/* Write the rows of a frame's position and orientation as seen from its base, six.
 *
 * iiwa_dnn/schemes/tasks.py: pose_rows */
static void schemes_tasks_pose_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    #line 130 "iiwa_dnn/schemes/tasks.py"
    #line 131 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_position_rows(arena, &(*step), constants, target, ((Matrix){A.data, 3 - 0, A.size1}), ((Vector){b.data, 3 - 0}));
    #line 132 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_rotation_rows(arena, &(*step), constants, target, ((Matrix){A.data + 3 * A.size1, A.size0 - 3, A.size1}), ((Vector){b.data + 3, b.size0 - 3}));
    return;
}

/* Write the rows of a pose that is among the constants, six.
 *
 * iiwa_dnn/schemes/tasks.py: held_pose_rows */
static void schemes_tasks_held_pose_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    (void)target;
    #line 139 "iiwa_dnn/schemes/tasks.py"
    #line 140 "iiwa_dnn/schemes/tasks.py"
    schemes_tasks_pose_rows(arena, &(*step), constants, ((Vector){constants.data + 3, constants.size0 - 3}), A, b);
    return;
}

/* Write the rows of `AxisTask`, two.
 *
 * iiwa_dnn/schemes/tasks.py: axis_rows */
static void schemes_tasks_axis_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    Vector placement;
    double_3 axis;
    double_3 spin;
    double_3 wanted;
    double_3 here;
    double_3 turn;
    double sine;
    double angle;
    double factor;
    double_3 rate;
    double_3 normal;
    #line 321 "iiwa_dnn/schemes/tasks.py"
    #line 322 "iiwa_dnn/schemes/tasks.py"
    placement = ((Vector){(*step).placements.data + (int64_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1});
    #line 323 "iiwa_dnn/schemes/tasks.py"
    axis = schemes_step_vector_at(arena, constants, 3);
    #line 324 "iiwa_dnn/schemes/tasks.py"
    spin = ((double_3){{0.0, 0.0, 0.0}});
    #line 325 "iiwa_dnn/schemes/tasks.py"
    wanted = schemes_step_vector_at(arena, constants, (3 + 9));
    #line 326 "iiwa_dnn/schemes/tasks.py"
    if (references_rotations_dot(arena, wanted, wanted) == 0.0) {
        #line 327 "iiwa_dnn/schemes/tasks.py"
        spin = schemes_step_vector_at(arena, target, 15);
        #line 328 "iiwa_dnn/schemes/tasks.py"
        wanted = ((double_3){{references_rotations_dot(arena, references_rotations_row_of(arena, target, 0), axis), references_rotations_dot(arena, references_rotations_row_of(arena, target, 1), axis), references_rotations_dot(arena, references_rotations_row_of(arena, target, 2), axis)}});
    }
    #line 333 "iiwa_dnn/schemes/tasks.py"
    here = schemes_step_axis_at(arena, placement, axis);
    #line 334 "iiwa_dnn/schemes/tasks.py"
    turn = references_rotations_cross(arena, here, wanted);
    #line 335 "iiwa_dnn/schemes/tasks.py"
    sine = sqrt(references_rotations_dot(arena, turn, turn));
    #line 336 "iiwa_dnn/schemes/tasks.py"
    angle = atan2(sine, references_rotations_dot(arena, here, wanted));
    #line 337 "iiwa_dnn/schemes/tasks.py"
    factor = ((sine > 1e-12) ? ((double)angle / sine) : 1.0);
    #line 338 "iiwa_dnn/schemes/tasks.py"
    rate = references_rotations_combined(arena, 1.0, spin, (double_min(constants.data[1], (*step).rate) * factor), turn);
    #line 339 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 2; i < end_i; i++) {
        #line 340 "iiwa_dnn/schemes/tasks.py"
        normal = schemes_step_axis_at(arena, placement, schemes_step_vector_at(arena, constants, ((3 + 3) + (3 * i))));
        #line 341 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = references_rotations_dot(arena, normal, rate);
        #line 342 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_spin(arena, &(*step), constants, normal, ((Vector){A.data + i * A.size1, A.size1}));
    }
    return;
}

/* Write the rows of `RemoteCenterTask`, two.
 *
 * iiwa_dnn/schemes/tasks.py: remote_center_rows */
static void schemes_tasks_remote_center_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    (void)target;
    Vector placement;
    Vector carrier;
    double_3 point;
    double_3 offset;
    double_3 normal;
    #line 380 "iiwa_dnn/schemes/tasks.py"
    #line 381 "iiwa_dnn/schemes/tasks.py"
    placement = ((Vector){(*step).placements.data + (int64_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1});
    #line 382 "iiwa_dnn/schemes/tasks.py"
    carrier = ((Vector){(*step).placements.data + (int64_t)(constants.data[2]) * (*step).placements.size1, (*step).placements.size1});
    #line 383 "iiwa_dnn/schemes/tasks.py"
    point = references_rotations_added(arena, schemes_step_vector_at(arena, carrier, 9), schemes_step_vector_at(arena, constants, (3 + 6)));
    #line 384 "iiwa_dnn/schemes/tasks.py"
    offset = references_rotations_combined(arena, 1.0, point, (-1.0), schemes_step_vector_at(arena, placement, 9));
    #line 385 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = 2; i < end_i; i++) {
        #line 386 "iiwa_dnn/schemes/tasks.py"
        normal = schemes_step_axis_at(arena, placement, schemes_step_vector_at(arena, constants, (3 + (3 * i))));
        #line 387 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = (double_min(constants.data[1], (*step).rate) * references_rotations_dot(arena, normal, offset));
        #line 388 "iiwa_dnn/schemes/tasks.py"
        schemes_step_write_velocity(arena, &(*step), constants, point, normal, ((Vector){A.data + i * A.size1, A.size1}));
    }
    return;
}

/* Write the rows of a task of joints: its constants are gain, C (rows, dof) and c (rows,).
 *
 * iiwa_dnn/schemes/tasks.py: joint_rows */
static void schemes_tasks_joint_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    (void)arena;
    (void)target;
    int64_t dof;
    double gain;
    double missing;
    #line 441 "iiwa_dnn/schemes/tasks.py"
    #line 442 "iiwa_dnn/schemes/tasks.py"
    dof = ((*step).q.size0);
    #line 443 "iiwa_dnn/schemes/tasks.py"
    gain = double_min(constants.data[0], (*step).rate);
    #line 444 "iiwa_dnn/schemes/tasks.py"
    for (int64_t i = 0, end_i = (b.size0); i < end_i; i++) {
        #line 445 "iiwa_dnn/schemes/tasks.py"
        missing = constants.data[((1 + (dof * (b.size0))) + i)];
        #line 446 "iiwa_dnn/schemes/tasks.py"
        for (int64_t j = 0, end_j = dof; j < end_j; j++) {
            #line 447 "iiwa_dnn/schemes/tasks.py"
            A.data[i * A.size1 + j] = constants.data[((1 + (dof * i)) + j)];
            #line 448 "iiwa_dnn/schemes/tasks.py"
            missing -= (A.data[i * A.size1 + j] * (*step).q.data[j]);
        }
        #line 449 "iiwa_dnn/schemes/tasks.py"
        b.data[i] = (gain * missing);
    }
    return;
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

struct kernel { const char *name; void *address; const char *code; };

/* Return the bytes that kernels of this thread have taken at once at most, since the last call. */
static PyObject *scratch_peak(PyObject *self, PyObject *none)
{
    const size_t peak = arena_peak;
    arena_peak = 0;
    return PyLong_FromSize_t(peak);
}

static PyObject *py_control_command_row_ends(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    int64_t a_dof;
    if (!counted("control_command_row_ends", count, 4) || !read_int(given[0], &a_n) || !read_int(given[1], &a_m) || !read_int(given[2], &a_p) || !read_int(given[3], &a_dof)) return NULL;
    int_9 result;
    result = control_command_row_ends(arena_here(), a_n, a_m, a_p, a_dof);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNNNNNN)", PyLong_FromLongLong(result.at[0]), PyLong_FromLongLong(result.at[1]), PyLong_FromLongLong(result.at[2]), PyLong_FromLongLong(result.at[3]), PyLong_FromLongLong(result.at[4]), PyLong_FromLongLong(result.at[5]), PyLong_FromLongLong(result.at[6]), PyLong_FromLongLong(result.at[7]), PyLong_FromLongLong(result.at[8]));
}
static PyObject *py_control_relaxed_copied(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_out;
    Vector a_values;
    if (!counted("control_relaxed_copied", count, 2) || !((a_out.data = read_doubles(given[0], 1, &a_out.size0, true))) || !((a_values.data = read_doubles(given[1], 1, &a_values.size0, false)))) return NULL;

    control_relaxed_copied(arena_here(), a_out, a_values);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_largest_entry(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_values;
    if (!counted("control_relaxed_largest_entry", count, 1) || !((a_values.data = read_doubles(given[0], 1, &a_values.size0, false)))) return NULL;
    double result;
    result = control_relaxed_largest_entry(arena_here(), a_values);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_relaxed_settled(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    relaxed_Yielding a_yielding;
    Vector a_state;
    Vector a_point;
    Vector a_figures;
    double a_tolerances;
    if (!counted("control_relaxed_settled", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[1], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[1], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[1], 7), &a_yielding.coupled) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, true))) || !((a_point.data = read_doubles(given[3], 1, &a_point.size0, true))) || !((a_figures.data = read_doubles(given[4], 1, &a_figures.size0, true))) || !read_double(given[5], &a_tolerances)) return NULL;
    bool result;
    result = control_relaxed_settled(arena_here(), &a_qp, &a_yielding, a_state, a_point, a_figures, a_tolerances);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_integrators_implicit_settle(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    int64_t a_rates;
    Vector a_constants;
    Vector a_s;
    Vector a_point;
    if (!counted("integrators_implicit_settle", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[1], &a_rates) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_s.data = read_doubles(given[3], 1, &a_s.size0, true))) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, true)))) return NULL;
    double_5 result;
    result = integrators_implicit_settle(arena_here(), &a_qp, a_rates, a_constants, a_s, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_networks_projection_field(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    Vector a_rates;
    if (!counted("networks_projection_field", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_rates.data = read_doubles(given[2], 1, &a_rates.size0, true)))) return NULL;
    double result;
    result = networks_projection_field(arena_here(), &a_qp, a_s, a_rates);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_dense_times(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_rows;
    Vector a_x;
    Vector a_out;
    if (!counted("qp_dense_times", count, 3) || !((a_rows.data = read_doubles(given[0], 2, &a_rows.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, false))) || !((a_out.data = read_doubles(given[2], 1, &a_out.size0, true)))) return NULL;

    qp_dense_times(arena_here(), a_rows, a_x, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_row_dot(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_rows;
    int64_t a_j;
    Vector a_x;
    if (!counted("qp_dense_row_dot", count, 3) || !((a_rows.data = read_doubles(given[0], 2, &a_rows.size0, false))) || !read_int(given[1], &a_j) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, false)))) return NULL;
    double result;
    result = qp_dense_row_dot(arena_here(), a_rows, a_j, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_projection_add_transposed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    double a_factor;
    Vector a_s;
    Vector a_out;
    if (!counted("networks_projection_add_transposed", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_double(given[1], &a_factor) || !((a_s.data = read_doubles(given[2], 1, &a_s.size0, false))) || !((a_out.data = read_doubles(given[3], 1, &a_out.size0, true)))) return NULL;

    networks_projection_add_transposed(arena_here(), &a_qp, a_factor, a_s, a_out);
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

    qp_dense_add_row(arena_here(), a_out, a_factor, a_rows, a_j);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_write_slacks(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_x;
    Vector a_slacks;
    if (!counted("networks_projection_write_slacks", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, false))) || !((a_slacks.data = read_doubles(given[2], 1, &a_slacks.size0, true)))) return NULL;

    networks_projection_write_slacks(arena_here(), &a_qp, a_x, a_slacks);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_networks_projection_rows_times(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_x;
    Vector a_values;
    if (!counted("networks_projection_rows_times", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, false))) || !((a_values.data = read_doubles(given[2], 1, &a_values.size0, true)))) return NULL;

    networks_projection_rows_times(arena_here(), &a_qp, a_x, a_values);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_layout_larger(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_largest;
    double a_value;
    if (!counted("qp_layout_larger", count, 2) || !read_double(given[0], &a_largest) || !read_double(given[1], &a_value)) return NULL;
    double result;
    result = qp_layout_larger(arena_here(), a_largest, a_value);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_residuals_kkt_point(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    Vector a_point;
    if (!counted("qp_residuals_kkt_point", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_point.data = read_doubles(given[2], 1, &a_point.size0, true)))) return NULL;
    double_3 result;
    result = qp_residuals_kkt_point(arena_here(), &a_qp, a_s, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_qp_residuals_point_residuals(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_point;
    if (!counted("qp_residuals_point_residuals", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_point.data = read_doubles(given[1], 1, &a_point.size0, false)))) return NULL;
    double_3 result;
    result = qp_residuals_point_residuals(arena_here(), &a_qp, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_qp_residuals_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_primal;
    double a_dual;
    double a_gap;
    double a_tol;
    if (!counted("qp_residuals_within", count, 4) || !read_double(given[0], &a_primal) || !read_double(given[1], &a_dual) || !read_double(given[2], &a_gap) || !read_double(given[3], &a_tol)) return NULL;
    bool result;
    result = qp_residuals_within(arena_here(), a_primal, a_dual, a_gap, a_tol);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_networks_projection_mark_active(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    Vector a_rates;
    Vector a_active;
    if (!counted("networks_projection_mark_active", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_rates.data = read_doubles(given[2], 1, &a_rates.size0, false))) || !((a_active.data = read_doubles(given[3], 1, &a_active.size0, true)))) return NULL;

    networks_projection_mark_active(arena_here(), &a_qp, a_s, a_rates, a_active);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_implicit_steps_linear_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    Vector a_rates;
    double a_step;
    implicit_steps_Condensed a_matrix;
    Vector a_new;
    if (!counted("integrators_implicit_steps_linear_step", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !((a_rates.data = read_doubles(given[2], 1, &a_rates.size0, false))) || !read_double(given[3], &a_step) || !is_tuple(given[4], 5) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[4], 0), 1, &a_matrix.active.size0, false))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[4], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[4], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[4], 3), 2, &a_matrix.K.size0, true))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[4], 4), 1, &a_matrix.values.size0, false))) || !((a_new.data = read_doubles(given[5], 1, &a_new.size0, true)))) return NULL;
    bool result;
    result = integrators_implicit_steps_linear_step(arena_here(), &a_qp, a_s, a_rates, a_step, &a_matrix, a_new);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_integrators_implicit_steps_build_condensed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    double a_step;
    implicit_steps_Condensed a_matrix;
    if (!counted("integrators_implicit_steps_build_condensed", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_double(given[1], &a_step) || !is_tuple(given[2], 5) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_matrix.active.size0, false))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[2], 3), 2, &a_matrix.K.size0, true))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[2], 4), 1, &a_matrix.values.size0, false)))) return NULL;

    integrators_implicit_steps_build_condensed(arena_here(), &a_qp, a_step, &a_matrix);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_implicit_steps_count_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    implicit_steps_Condensed a_matrix;
    Matrix a_rows;
    int64_t a_first;
    if (!counted("integrators_implicit_steps_count_rows", count, 3) || !is_tuple(given[0], 5) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_matrix.active.size0, false))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_matrix.K.size0, false))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_matrix.values.size0, false))) || !((a_rows.data = read_doubles(given[1], 2, &a_rows.size0, false))) || !read_int(given[2], &a_first)) return NULL;

    integrators_implicit_steps_count_rows(arena_here(), &a_matrix, a_rows, a_first);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_add_outer(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_out;
    double a_factor;
    Matrix a_rows;
    int64_t a_j;
    if (!counted("qp_dense_add_outer", count, 4) || !((a_out.data = read_doubles(given[0], 2, &a_out.size0, true))) || !read_double(given[1], &a_factor) || !((a_rows.data = read_doubles(given[2], 2, &a_rows.size0, false))) || !read_int(given[3], &a_j)) return NULL;

    qp_dense_add_outer(arena_here(), a_out, a_factor, a_rows, a_j);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_cholesky_factor(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    if (!counted("qp_dense_cholesky_factor", count, 1) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, true)))) return NULL;
    bool result;
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

    qp_dense_factor_solve(arena_here(), a_K, a_rhs, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_implicit_steps_copy_into(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_out;
    Vector a_values;
    if (!counted("integrators_implicit_steps_copy_into", count, 2) || !((a_out.data = read_doubles(given[0], 1, &a_out.size0, true))) || !((a_values.data = read_doubles(given[1], 1, &a_values.size0, false)))) return NULL;

    integrators_implicit_steps_copy_into(arena_here(), a_out, a_values);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_implicit_steps_backward_euler(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    double a_step;
    Vector a_new;
    double a_tol;
    int64_t a_max_newton;
    implicit_steps_Condensed a_matrix;
    if (!counted("integrators_implicit_steps_backward_euler", count, 7) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !read_double(given[2], &a_step) || !((a_new.data = read_doubles(given[3], 1, &a_new.size0, true))) || !read_double(given[4], &a_tol) || !read_int(given[5], &a_max_newton) || !is_tuple(given[6], 5) || !((a_matrix.active.data = read_doubles(PyTuple_GET_ITEM(given[6], 0), 1, &a_matrix.active.size0, true))) || !((a_matrix.counted.data = read_doubles(PyTuple_GET_ITEM(given[6], 1), 1, &a_matrix.counted.size0, true))) || !((a_matrix.gram.data = read_doubles(PyTuple_GET_ITEM(given[6], 2), 2, &a_matrix.gram.size0, true))) || !((a_matrix.K.data = read_doubles(PyTuple_GET_ITEM(given[6], 3), 2, &a_matrix.K.size0, true))) || !((a_matrix.values.data = read_doubles(PyTuple_GET_ITEM(given[6], 4), 1, &a_matrix.values.size0, true)))) return NULL;
    int64_t result;
    result = integrators_implicit_steps_backward_euler(arena_here(), &a_qp, a_s, a_step, a_new, a_tol, a_max_newton, &a_matrix);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_integrators_implicit_steps_multipliers(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    double a_step;
    Vector a_slacks;
    Vector a_new;
    Vector a_active;
    if (!counted("integrators_implicit_steps_multipliers", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !read_double(given[2], &a_step) || !((a_slacks.data = read_doubles(given[3], 1, &a_slacks.size0, false))) || !((a_new.data = read_doubles(given[4], 1, &a_new.size0, true))) || !((a_active.data = read_doubles(given[5], 1, &a_active.size0, true)))) return NULL;

    integrators_implicit_steps_multipliers(arena_here(), &a_qp, a_s, a_step, a_slacks, a_new, a_active);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_implicit_steps_descent(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    double a_step;
    Vector a_new;
    Vector a_descent;
    if (!counted("integrators_implicit_steps_descent", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !read_double(given[2], &a_step) || !((a_new.data = read_doubles(given[3], 1, &a_new.size0, false))) || !((a_descent.data = read_doubles(given[4], 1, &a_descent.size0, true)))) return NULL;
    double result;
    result = integrators_implicit_steps_descent(arena_here(), &a_qp, a_s, a_step, a_new, a_descent);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_integrators_implicit_steps_line_search(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_s;
    double a_step;
    Vector a_slacks;
    Vector a_change;
    Vector a_direction;
    Vector a_descent;
    if (!counted("integrators_implicit_steps_line_search", count, 7) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_s.data = read_doubles(given[1], 1, &a_s.size0, false))) || !read_double(given[2], &a_step) || !((a_slacks.data = read_doubles(given[3], 1, &a_slacks.size0, false))) || !((a_change.data = read_doubles(given[4], 1, &a_change.size0, false))) || !((a_direction.data = read_doubles(given[5], 1, &a_direction.size0, false))) || !((a_descent.data = read_doubles(given[6], 1, &a_descent.size0, false)))) return NULL;
    double result;
    result = integrators_implicit_steps_line_search(arena_here(), &a_qp, a_s, a_step, a_slacks, a_change, a_direction, a_descent);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_integrators_implicit_steps_slope(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_n;
    int64_t a_p;
    Vector a_s;
    double a_step;
    Vector a_slacks;
    Vector a_change;
    double a_length;
    if (!counted("integrators_implicit_steps_slope", count, 7) || !read_int(given[0], &a_n) || !read_int(given[1], &a_p) || !((a_s.data = read_doubles(given[2], 1, &a_s.size0, false))) || !read_double(given[3], &a_step) || !((a_slacks.data = read_doubles(given[4], 1, &a_slacks.size0, false))) || !((a_change.data = read_doubles(given[5], 1, &a_change.size0, false))) || !read_double(given[6], &a_length)) return NULL;
    double_2 result;
    result = integrators_implicit_steps_slope(arena_here(), a_n, a_p, a_s, a_step, a_slacks, a_change, a_length);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_control_relaxed_largest_factor(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    relaxed_Yielding a_yielding;
    Vector a_state;
    Vector a_point;
    Vector a_figures;
    bool a_retreats;
    if (!counted("control_relaxed_largest_factor", count, 6) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[1], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[1], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[1], 7), &a_yielding.coupled) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, true))) || !((a_point.data = read_doubles(given[3], 1, &a_point.size0, true))) || !((a_figures.data = read_doubles(given[4], 1, &a_figures.size0, true))) || !read_bool(given[5], &a_retreats)) return NULL;
    double result;
    result = control_relaxed_largest_factor(arena_here(), &a_qp, &a_yielding, a_state, a_point, a_figures, a_retreats);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_relaxed_data_size(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("control_relaxed_data_size", count, 3) || !read_int(given[0], &a_n) || !read_int(given[1], &a_m) || !read_int(given[2], &a_p)) return NULL;
    int64_t result;
    result = control_relaxed_data_size(arena_here(), a_n, a_m, a_p);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_qp_layout_offsets(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("qp_layout_offsets", count, 3) || !read_int(given[0], &a_n) || !read_int(given[1], &a_m) || !read_int(given[2], &a_p)) return NULL;
    int_4 result;
    result = qp_layout_offsets(arena_here(), a_n, a_m, a_p);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyLong_FromLongLong(result.at[0]), PyLong_FromLongLong(result.at[1]), PyLong_FromLongLong(result.at[2]), PyLong_FromLongLong(result.at[3]));
}
static PyObject *py_control_relaxed_copy_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    layout_QPViews a_other;
    if (!counted("control_relaxed_copy_cost", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_other.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_other.P.size0, true))) || !((a_other.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_other.q.size0, true))) || !((a_other.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_other.G.size0, false))) || !((a_other.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_other.h.size0, false))) || !((a_other.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_other.A.size0, false))) || !((a_other.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_other.b.size0, false))) || !((a_other.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_other.lb.size0, false))) || !((a_other.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_other.ub.size0, false)))) return NULL;

    control_relaxed_copy_cost(arena_here(), &a_qp, &a_other);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_copy_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    layout_QPViews a_other;
    if (!counted("control_relaxed_copy_limits", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[1], 8) || !((a_other.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_other.P.size0, false))) || !((a_other.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_other.q.size0, false))) || !((a_other.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_other.G.size0, false))) || !((a_other.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_other.h.size0, true))) || !((a_other.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_other.A.size0, false))) || !((a_other.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_other.b.size0, false))) || !((a_other.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_other.lb.size0, true))) || !((a_other.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_other.ub.size0, true)))) return NULL;

    control_relaxed_copy_limits(arena_here(), &a_qp, &a_other);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_scale_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_weights;
    double a_factor;
    if (!counted("control_relaxed_scale_task", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, true))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_weights.data = read_doubles(given[1], 1, &a_weights.size0, false))) || !read_double(given[2], &a_factor)) return NULL;

    control_relaxed_scale_task(arena_here(), &a_qp, a_weights, a_factor);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_soften_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_weights;
    double a_retreat;
    if (!counted("control_relaxed_soften_task", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, true))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, true))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, true))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, true))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, true))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_weights.data = read_doubles(given[1], 1, &a_weights.size0, false))) || !read_double(given[2], &a_retreat)) return NULL;

    control_relaxed_soften_task(arena_here(), &a_qp, a_weights, a_retreat);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_move_into_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    int64_t a_j;
    double a_square;
    double a_shrink;
    if (!counted("control_relaxed_move_into_cost", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, true))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, true))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, true))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, true))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[1], &a_j) || !read_double(given[2], &a_square) || !read_double(given[3], &a_shrink)) return NULL;

    control_relaxed_move_into_cost(arena_here(), &a_qp, a_j, a_square, a_shrink);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_note_blocking(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_point;
    int64_t a_n;
    int64_t a_m;
    int64_t a_extra;
    Vector a_blocking;
    if (!counted("control_relaxed_note_blocking", count, 5) || !((a_point.data = read_doubles(given[0], 1, &a_point.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_extra) || !((a_blocking.data = read_doubles(given[4], 1, &a_blocking.size0, true)))) return NULL;

    control_relaxed_note_blocking(arena_here(), a_point, a_n, a_m, a_extra, a_blocking);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_relaxed_nearest_within(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_x;
    relaxed_Yielding a_yielding;
    Vector a_figures;
    if (!counted("control_relaxed_nearest_within", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, true))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[2], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.coupled) || !((a_figures.data = read_doubles(given[3], 1, &a_figures.size0, true)))) return NULL;
    bool result;
    result = control_relaxed_nearest_within(arena_here(), &a_qp, a_x, &a_yielding, a_figures);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_relaxed_attained(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_b;
    Matrix a_A;
    Vector a_weights;
    Vector a_x;
    if (!counted("control_relaxed_attained", count, 4) || !((a_b.data = read_doubles(given[0], 1, &a_b.size0, false))) || !((a_A.data = read_doubles(given[1], 2, &a_A.size0, false))) || !((a_weights.data = read_doubles(given[2], 1, &a_weights.size0, false))) || !((a_x.data = read_doubles(given[3], 1, &a_x.size0, false)))) return NULL;
    double result;
    result = control_relaxed_attained(arena_here(), a_b, a_A, a_weights, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_shield_wished_velocity(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("control_shield_wished_velocity", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    control_shield_wished_velocity(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_shield_take_positions(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_q;
    shield_ShieldState a_state;
    Vector a_settings;
    if (!counted("control_shield_take_positions", count, 3) || !((a_q.data = read_doubles(given[0], 1, &a_q.size0, false))) || !is_tuple(given[1], 3) || !((a_state.positions.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_state.positions.size0, true))) || !((a_state.wish.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_state.wish.size0, false))) || !((a_state.flags.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_state.flags.size0, true))) || !((a_settings.data = read_doubles(given[2], 1, &a_settings.size0, false)))) return NULL;

    control_shield_take_positions(arena_here(), a_q, &a_state, a_settings);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_shield_take_wish(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_wish;
    bool a_given;
    shield_ShieldState a_state;
    Vector a_settings;
    if (!counted("control_shield_take_wish", count, 4) || !((a_wish.data = read_doubles(given[0], 1, &a_wish.size0, false))) || !read_bool(given[1], &a_given) || !is_tuple(given[2], 3) || !((a_state.positions.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_state.positions.size0, false))) || !((a_state.wish.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_state.wish.size0, true))) || !((a_state.flags.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_state.flags.size0, false))) || !((a_settings.data = read_doubles(given[3], 1, &a_settings.size0, false)))) return NULL;
    bool result;
    result = control_shield_take_wish(arena_here(), a_wish, a_given, &a_state, a_settings);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_dense_all_finite(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_start;
    int64_t a_end;
    if (!counted("qp_dense_all_finite", count, 3) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_start) || !read_int(given[2], &a_end)) return NULL;
    bool result;
    result = qp_dense_all_finite(arena_here(), a_data, a_start, a_end);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_shield_approach(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    shield_ShieldState a_state;
    Matrix a_past;
    Vector a_limits;
    double a_dt;
    bool a_reaches;
    bool a_held;
    Vector a_dq;
    if (!counted("control_shield_approach", count, 7) || !is_tuple(given[0], 3) || !((a_state.positions.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_state.positions.size0, false))) || !((a_state.wish.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_state.wish.size0, false))) || !((a_state.flags.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_state.flags.size0, false))) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !((a_limits.data = read_doubles(given[2], 1, &a_limits.size0, false))) || !read_double(given[3], &a_dt) || !read_bool(given[4], &a_reaches) || !read_bool(given[5], &a_held) || !((a_dq.data = read_doubles(given[6], 1, &a_dq.size0, true)))) return NULL;

    control_shield_approach(arena_here(), &a_state, a_past, a_limits, a_dt, a_reaches, a_held, a_dq);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_limits_joint_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_before;
    double a_above;
    double a_below;
    double_4 a_rates;
    double a_dt;
    if (!counted("schemes_limits_joint_bounds", count, 6) || !read_double(given[0], &a_last) || !read_double(given[1], &a_before) || !read_double(given[2], &a_above) || !read_double(given[3], &a_below) || !is_tuple(given[4], 4) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_rates.at[0]) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_rates.at[1]) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_rates.at[2]) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_rates.at[3]) || !read_double(given[5], &a_dt)) return NULL;
    double_2 result;
    result = schemes_limits_joint_bounds(arena_here(), a_last, a_before, a_above, a_below, a_rates, a_dt);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_schemes_limits_jerk_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_before;
    double a_above;
    double a_below;
    double_4 a_rates;
    double a_dt;
    if (!counted("schemes_limits_jerk_bounds", count, 6) || !read_double(given[0], &a_last) || !read_double(given[1], &a_before) || !read_double(given[2], &a_above) || !read_double(given[3], &a_below) || !is_tuple(given[4], 4) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_rates.at[0]) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_rates.at[1]) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_rates.at[2]) || !read_double(PyTuple_GET_ITEM(given[4], 3), &a_rates.at[3]) || !read_double(given[5], &a_dt)) return NULL;
    double_2 result;
    result = schemes_limits_jerk_bounds(arena_here(), a_last, a_before, a_above, a_below, a_rates, a_dt);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_schemes_limits_approach(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_room;
    if (!counted("schemes_limits_approach", count, 1) || !read_double(given[0], &a_room)) return NULL;
    double result;
    result = schemes_limits_approach(arena_here(), a_room);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_limits_ceiling(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_lb;
    double a_ub;
    double a_distance;
    double a_last;
    double a_dt;
    double_2 a_braking_limits;
    if (!counted("schemes_limits_ceiling", count, 6) || !read_double(given[0], &a_lb) || !read_double(given[1], &a_ub) || !read_double(given[2], &a_distance) || !read_double(given[3], &a_last) || !read_double(given[4], &a_dt) || !is_tuple(given[5], 2) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_braking_limits.at[0]) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_braking_limits.at[1])) return NULL;
    double result;
    result = schemes_limits_ceiling(arena_here(), a_lb, a_ub, a_distance, a_last, a_dt, a_braking_limits);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_limits_highest(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_v;
    double a_last;
    double a_dt;
    double a_J;
    double a_A;
    if (!counted("schemes_limits_highest", count, 5) || !read_double(given[0], &a_v) || !read_double(given[1], &a_last) || !read_double(given[2], &a_dt) || !read_double(given[3], &a_J) || !read_double(given[4], &a_A)) return NULL;
    double result;
    result = schemes_limits_highest(arena_here(), a_v, a_last, a_dt, a_J, a_A);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_limits_stopping_distance(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_v;
    double a_a;
    double a_J;
    double a_A;
    if (!counted("schemes_limits_stopping_distance", count, 4) || !read_double(given[0], &a_v) || !read_double(given[1], &a_a) || !read_double(given[2], &a_J) || !read_double(given[3], &a_A)) return NULL;
    double result;
    result = schemes_limits_stopping_distance(arena_here(), a_v, a_a, a_J, a_A);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_limits_easing(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_room;
    double a_dt;
    if (!counted("schemes_limits_easing", count, 2) || !read_double(given[0], &a_room) || !read_double(given[1], &a_dt)) return NULL;
    double result;
    result = schemes_limits_easing(arena_here(), a_room, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_limits_acceleration_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_above;
    double a_below;
    double_4 a_rates;
    double a_dt;
    if (!counted("schemes_limits_acceleration_bounds", count, 5) || !read_double(given[0], &a_last) || !read_double(given[1], &a_above) || !read_double(given[2], &a_below) || !is_tuple(given[3], 4) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_rates.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_rates.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_rates.at[2]) || !read_double(PyTuple_GET_ITEM(given[3], 3), &a_rates.at[3]) || !read_double(given[4], &a_dt)) return NULL;
    double_2 result;
    result = schemes_limits_acceleration_bounds(arena_here(), a_last, a_above, a_below, a_rates, a_dt);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_schemes_limits_braking(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_last;
    double a_lb;
    double a_ub;
    double a_jerk;
    double a_dt;
    if (!counted("schemes_limits_braking", count, 5) || !read_double(given[0], &a_last) || !read_double(given[1], &a_lb) || !read_double(given[2], &a_ub) || !read_double(given[3], &a_jerk) || !read_double(given[4], &a_dt)) return NULL;
    double result;
    result = schemes_limits_braking(arena_here(), a_last, a_lb, a_ub, a_jerk, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_step_take_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_row;
    step_StepPlan a_plan;
    Matrix a_past;
    Matrix a_following;
    Vector a_state;
    Vector a_relaxed;
    double a_t;
    bool a_samples;
    if (!counted("control_step_take_step", count, 8) || !((a_row.data = read_doubles(given[0], 1, &a_row.size0, false))) || !is_tuple(given[1], 4) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 7) || !((a_plan.arrays.table.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), 2, &a_plan.arrays.table.size0, false))) || !((a_plan.arrays.constants.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), 1, &a_plan.arrays.constants.size0, false))) || !((a_plan.arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), 2, &a_plan.arrays.jacobian.size0, false))) || !((a_plan.arrays.placements.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 3), 2, &a_plan.arrays.placements.size0, false))) || !((a_plan.arrays.moves.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 4), 2, &a_plan.arrays.moves.size0, false))) || !((a_plan.arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 5), 2, &a_plan.arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 6), &a_plan.arrays.rate) || !is_tuple(PyTuple_GET_ITEM(given[1], 1), 8) || !((a_plan.yielding.weights.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 0), 1, &a_plan.yielding.weights.size0, false))) || !((a_plan.yielding.limits.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 1), 1, &a_plan.yielding.limits.size0, false))) || !((a_plan.yielding.settings.data = read_doubles(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 2), 1, &a_plan.yielding.settings.size0, false))) || !((a_plan.yielding.scenes.data = read_ints(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 3), 2, &a_plan.yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 4), &a_plan.yielding.dt) || !read_int(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 5), &a_plan.yielding.stop) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 6), &a_plan.yielding.cubic) || !read_bool(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 7), &a_plan.yielding.coupled) || !read_int(PyTuple_GET_ITEM(given[1], 2), &a_plan.policy) || !read_bool(PyTuple_GET_ITEM(given[1], 3), &a_plan.shares_state) || !((a_past.data = read_doubles(given[2], 2, &a_past.size0, false))) || !((a_following.data = read_doubles(given[3], 2, &a_following.size0, true))) || !((a_state.data = read_doubles(given[4], 1, &a_state.size0, true))) || !((a_relaxed.data = read_doubles(given[5], 1, &a_relaxed.size0, false))) || !read_double(given[6], &a_t) || !read_bool(given[7], &a_samples)) return NULL;
    int64_t result;
    result = control_step_take_step(arena_here(), a_row, &a_plan, a_past, a_following, a_state, a_relaxed, a_t, a_samples);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_step_sample_targets(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    program_ProgramArrays a_arrays;
    double a_t;
    Matrix a_targets;
    if (!counted("control_step_sample_targets", count, 3) || !is_tuple(given[0], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_arrays.rate) || !read_double(given[1], &a_t) || !((a_targets.data = read_doubles(given[2], 2, &a_targets.size0, false)))) return NULL;

    control_step_sample_targets(arena_here(), &a_arrays, a_t, a_targets);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_base_enter_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_base_enter_path", count, 4) || !read_int(given[0], &a_address) || !read_double(given[1], &a_t) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[3], 1, &a_target.size0, false)))) return NULL;

    references_base_enter_path(arena_here(), a_address, a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_rotations_set_mean_twist(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_now;
    Vector a_then;
    double a_dt;
    if (!counted("references_rotations_set_mean_twist", count, 3) || !((a_now.data = read_doubles(given[0], 1, &a_now.size0, true))) || !((a_then.data = read_doubles(given[1], 1, &a_then.size0, false))) || !read_double(given[2], &a_dt)) return NULL;

    references_rotations_set_mean_twist(arena_here(), a_now, a_then, a_dt);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_rotations_dot(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_u;
    double_3 a_v;
    if (!counted("references_rotations_dot", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_u.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double result;
    result = references_rotations_dot(arena_here(), a_u, a_v);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_references_rotations_row_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_target;
    int64_t a_i;
    if (!counted("references_rotations_row_of", count, 2) || !((a_target.data = read_doubles(given[0], 1, &a_target.size0, false))) || !read_int(given[1], &a_i)) return NULL;
    double_3 result;
    result = references_rotations_row_of(arena_here(), a_target, a_i);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_rotation_log(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_R;
    Vector a_out;
    if (!counted("references_rotations_rotation_log", count, 2) || !((a_R.data = read_doubles(given[0], 2, &a_R.size0, false))) || !((a_out.data = read_doubles(given[1], 1, &a_out.size0, true)))) return NULL;

    references_rotations_rotation_log(arena_here(), a_R, a_out);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_program_assemble(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    program_ProgramArrays a_arrays;
    Matrix a_past;
    Matrix a_targets;
    double a_t;
    if (!counted("schemes_program_assemble", count, 5) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, true))) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[2], 2, &a_past.size0, false))) || !((a_targets.data = read_doubles(given[3], 2, &a_targets.size0, false))) || !read_double(given[4], &a_t)) return NULL;

    schemes_program_assemble(arena_here(), a_data, &a_arrays, a_past, a_targets, a_t);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_enter_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_parts_enter_cost", count, 5) || !read_int(given[0], &a_address) || !is_tuple(given[1], 10) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[1], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[3], 2, &a_P.size0, false))) || !((a_q.data = read_doubles(given[4], 1, &a_q.size0, false)))) return NULL;

    schemes_parts_enter_cost(arena_here(), a_address, &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_enter_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_parts_enter_task", count, 6) || !read_int(given[0], &a_address) || !is_tuple(given[1], 10) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[1], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[3], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[4], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[5], 1, &a_b.size0, false)))) return NULL;

    schemes_parts_enter_task(arena_here(), a_address, &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_program_add_soft(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Matrix a_A;
    Vector a_b;
    double a_weight;
    if (!counted("schemes_program_add_soft", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, true))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, true))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_A.data = read_doubles(given[1], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[2], 1, &a_b.size0, false))) || !read_double(given[3], &a_weight)) return NULL;

    schemes_program_add_soft(arena_here(), &a_qp, a_A, a_b, a_weight);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_enter_limit(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_parts_enter_limit", count, 7) || !read_int(given[0], &a_address) || !is_tuple(given[1], 10) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[1], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[3], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[4], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[5], 1, &a_lb.size0, false))) || !((a_ub.data = read_doubles(given[6], 1, &a_ub.size0, false)))) return NULL;

    schemes_parts_enter_limit(arena_here(), a_address, &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_step_note_instant(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    command_RowViews a_views;
    program_ProgramArrays a_arrays;
    Matrix a_past;
    if (!counted("control_step_note_instant", count, 3) || !is_tuple(given[0], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_views.program.size0, false))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_views.point.size0, false))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_views.figures.size0, true))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_views.placement.size0, true))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_views.dq.size0, false))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_views.decision.size0, true))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_views.blocking.size0, true))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_views.targets.size0, false))) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[2], 2, &a_past.size0, false)))) return NULL;

    control_step_note_instant(arena_here(), &a_views, &a_arrays, a_past);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_step_answer(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    command_RowViews a_views;
    program_ProgramArrays a_arrays;
    Vector a_state;
    if (!counted("control_step_answer", count, 3) || !is_tuple(given[0], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_views.program.size0, false))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_views.point.size0, false))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_views.figures.size0, true))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_views.placement.size0, false))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_views.dq.size0, true))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_views.decision.size0, true))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_views.blocking.size0, false))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_views.targets.size0, false))) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, true)))) return NULL;
    bool result;
    result = control_step_answer(arena_here(), &a_views, &a_arrays, a_state);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_integrators_base_enter_answer(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    layout_QPViews a_qp;
    int64_t a_rates;
    Vector a_constants;
    Vector a_state;
    Vector a_point;
    if (!counted("integrators_base_enter_answer", count, 6) || !read_int(given[0], &a_address) || !is_tuple(given[1], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[2], &a_rates) || !((a_constants.data = read_doubles(given[3], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[4], 1, &a_state.size0, false))) || !((a_point.data = read_doubles(given[5], 1, &a_point.size0, false)))) return NULL;
    double_5 result;
    result = integrators_base_enter_answer(arena_here(), a_address, &a_qp, a_rates, a_constants, a_state, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_control_step_status_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_primal;
    double a_dual;
    double a_gap;
    Vector a_own;
    Vector a_state;
    if (!counted("control_step_status_of", count, 5) || !read_double(given[0], &a_primal) || !read_double(given[1], &a_dual) || !read_double(given[2], &a_gap) || !((a_own.data = read_doubles(given[3], 1, &a_own.size0, false))) || !((a_state.data = read_doubles(given[4], 1, &a_state.size0, false)))) return NULL;
    int64_t result;
    result = control_step_status_of(arena_here(), a_primal, a_dual, a_gap, a_own, a_state);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_yielding_guard_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    program_ProgramArrays a_arrays;
    Matrix a_past;
    Matrix a_following;
    relaxed_Yielding a_yielding;
    if (!counted("control_yielding_guard_step", count, 4) || !is_tuple(given[0], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !((a_following.data = read_doubles(given[2], 2, &a_following.size0, true))) || !is_tuple(given[3], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[3], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[3], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[3], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[3], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[3], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[3], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[3], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[3], 7), &a_yielding.coupled)) return NULL;
    bool result;
    result = control_yielding_guard_step(arena_here(), &a_arrays, a_past, a_following, &a_yielding);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_yielding_periods_to_rest(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    program_ProgramArrays a_arrays;
    Matrix a_past;
    relaxed_Yielding a_yielding;
    Vector a_x;
    if (!counted("control_yielding_periods_to_rest", count, 4) || !is_tuple(given[0], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[2], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.coupled) || !((a_x.data = read_doubles(given[3], 1, &a_x.size0, false)))) return NULL;
    double result;
    result = control_yielding_periods_to_rest(arena_here(), &a_arrays, a_past, &a_yielding, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_enter_stopping_time(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    program_ProgramArrays a_arrays;
    Matrix a_past;
    relaxed_Yielding a_yielding;
    Vector a_dq;
    if (!counted("control_stopping_enter_stopping_time", count, 5) || !read_int(given[0], &a_address) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[2], 2, &a_past.size0, false))) || !is_tuple(given[3], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[3], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[3], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[3], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[3], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[3], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[3], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[3], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[3], 7), &a_yielding.coupled) || !((a_dq.data = read_doubles(given[4], 1, &a_dq.size0, false)))) return NULL;
    double result;
    result = control_stopping_enter_stopping_time(arena_here(), a_address, &a_arrays, a_past, &a_yielding, a_dq);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_yielding_yield_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    command_RowViews a_views;
    program_ProgramArrays a_arrays;
    Matrix a_past;
    Matrix a_following;
    Vector a_state;
    relaxed_Yielding a_yielding;
    Vector a_relaxed;
    int64_t a_action;
    if (!counted("control_yielding_yield_step", count, 8) || !is_tuple(given[0], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_views.program.size0, true))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_views.point.size0, true))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_views.figures.size0, true))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_views.placement.size0, false))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_views.dq.size0, true))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_views.decision.size0, true))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_views.blocking.size0, true))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_views.targets.size0, false))) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[2], 2, &a_past.size0, false))) || !((a_following.data = read_doubles(given[3], 2, &a_following.size0, true))) || !((a_state.data = read_doubles(given[4], 1, &a_state.size0, true))) || !is_tuple(given[5], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[5], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[5], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[5], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[5], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[5], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[5], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[5], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[5], 7), &a_yielding.coupled) || !((a_relaxed.data = read_doubles(given[6], 1, &a_relaxed.size0, false))) || !read_int(given[7], &a_action)) return NULL;
    int64_t result;
    result = control_yielding_yield_step(arena_here(), &a_views, &a_arrays, a_past, a_following, a_state, &a_yielding, a_relaxed, a_action);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_yielding_widen_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_limits;
    Vector a_q;
    if (!counted("control_yielding_widen_bounds", count, 3) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, true))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, true))) || !((a_limits.data = read_doubles(given[1], 1, &a_limits.size0, false))) || !((a_q.data = read_doubles(given[2], 1, &a_q.size0, false)))) return NULL;

    control_yielding_widen_bounds(arena_here(), &a_qp, a_limits, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_yielding_answer_relaxed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    command_RowViews a_views;
    layout_QPViews a_qp;
    relaxed_Yielding a_yielding;
    Vector a_state;
    Vector a_relaxed;
    int64_t a_action;
    if (!counted("control_yielding_answer_relaxed", count, 6) || !is_tuple(given[0], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_views.program.size0, false))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_views.point.size0, true))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_views.figures.size0, true))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_views.placement.size0, false))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_views.dq.size0, false))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_views.decision.size0, false))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_views.blocking.size0, true))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_views.targets.size0, false))) || !is_tuple(given[1], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_qp.P.size0, true))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_qp.q.size0, true))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_qp.h.size0, true))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_qp.A.size0, true))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_qp.b.size0, true))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_qp.ub.size0, false))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[2], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.coupled) || !((a_state.data = read_doubles(given[3], 1, &a_state.size0, true))) || !((a_relaxed.data = read_doubles(given[4], 1, &a_relaxed.size0, false))) || !read_int(given[5], &a_action)) return NULL;
    double_2 result;
    result = control_yielding_answer_relaxed(arena_here(), &a_views, &a_qp, &a_yielding, a_state, a_relaxed, a_action);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_control_yielding_is_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_targets;
    if (!counted("control_yielding_is_path", count, 1) || !((a_targets.data = read_doubles(given[0], 2, &a_targets.size0, false)))) return NULL;
    bool result;
    result = control_yielding_is_path(arena_here(), a_targets);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_yielding_races(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_x;
    if (!counted("control_yielding_races", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_x.data = read_doubles(given[1], 1, &a_x.size0, false)))) return NULL;
    bool result;
    result = control_yielding_races(arena_here(), &a_qp, a_x);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_yielding_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_limits;
    Matrix a_past;
    Matrix a_following;
    relaxed_Yielding a_yielding;
    Vector a_figures;
    Vector a_x;
    if (!counted("control_yielding_step", count, 6) || !is_tuple(given[0], 8) || !((a_limits.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_limits.P.size0, false))) || !((a_limits.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_limits.q.size0, false))) || !((a_limits.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_limits.G.size0, false))) || !((a_limits.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_limits.h.size0, false))) || !((a_limits.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_limits.A.size0, false))) || !((a_limits.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_limits.b.size0, false))) || !((a_limits.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_limits.lb.size0, false))) || !((a_limits.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_limits.ub.size0, false))) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !((a_following.data = read_doubles(given[2], 2, &a_following.size0, false))) || !is_tuple(given[3], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[3], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[3], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[3], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[3], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[3], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[3], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[3], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[3], 7), &a_yielding.coupled) || !((a_figures.data = read_doubles(given[4], 1, &a_figures.size0, true))) || !((a_x.data = read_doubles(given[5], 1, &a_x.size0, true)))) return NULL;

    control_yielding_step(arena_here(), &a_limits, a_past, a_following, &a_yielding, a_figures, a_x);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_yielding_step_straight(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_past;
    relaxed_Yielding a_yielding;
    Vector a_x;
    if (!counted("control_yielding_step_straight", count, 3) || !((a_past.data = read_doubles(given[0], 2, &a_past.size0, false))) || !is_tuple(given[1], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[1], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[1], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[1], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[1], 7), &a_yielding.coupled) || !((a_x.data = read_doubles(given[2], 1, &a_x.size0, true)))) return NULL;

    control_yielding_step_straight(arena_here(), a_past, &a_yielding, a_x);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_stopping_least_periods(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_x;
    Vector a_before;
    Vector a_limits;
    double a_dt;
    bool a_cubic;
    if (!counted("control_stopping_least_periods", count, 5) || !((a_x.data = read_doubles(given[0], 1, &a_x.size0, false))) || !((a_before.data = read_doubles(given[1], 1, &a_before.size0, false))) || !((a_limits.data = read_doubles(given[2], 1, &a_limits.size0, false))) || !read_double(given[3], &a_dt) || !read_bool(given[4], &a_cubic)) return NULL;
    double result;
    result = control_stopping_least_periods(arena_here(), a_x, a_before, a_limits, a_dt, a_cubic);
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
    if (!counted("control_stopping_within_rates", count, 5) || !read_double(given[0], &a_x) || !read_double(given[1], &a_before) || !read_double(given[2], &a_periods) || !read_double(given[3], &a_accel) || !read_double(given[4], &a_jerk)) return NULL;
    bool result;
    result = control_stopping_within_rates(arena_here(), a_x, a_before, a_periods, a_accel, a_jerk);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_bend_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_x;
    double a_before;
    double a_periods;
    if (!counted("control_stopping_bend_of", count, 3) || !read_double(given[0], &a_x) || !read_double(given[1], &a_before) || !read_double(given[2], &a_periods)) return NULL;
    double result;
    result = control_stopping_bend_of(arena_here(), a_x, a_before, a_periods);
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
    result = control_stopping_next_velocity(arena_here(), a_x, a_before, a_periods, a_cubic);
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
    result = control_stopping_velocity_at(arena_here(), a_x, a_b, a_u, a_cubic);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_yielding_step_towards(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_limits;
    Matrix a_past;
    relaxed_Yielding a_yielding;
    Vector a_x;
    if (!counted("control_yielding_step_towards", count, 4) || !is_tuple(given[0], 8) || !((a_limits.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_limits.P.size0, false))) || !((a_limits.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_limits.q.size0, false))) || !((a_limits.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_limits.G.size0, false))) || !((a_limits.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_limits.h.size0, false))) || !((a_limits.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_limits.A.size0, false))) || !((a_limits.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_limits.b.size0, false))) || !((a_limits.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_limits.lb.size0, false))) || !((a_limits.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_limits.ub.size0, false))) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[2], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.coupled) || !((a_x.data = read_doubles(given[3], 1, &a_x.size0, true)))) return NULL;

    control_yielding_step_towards(arena_here(), &a_limits, a_past, &a_yielding, a_x);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_yielding_make_stoppable(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_limits;
    program_ProgramArrays a_arrays;
    Matrix a_past;
    relaxed_Yielding a_yielding;
    command_RowViews a_views;
    Vector a_x;
    if (!counted("control_yielding_make_stoppable", count, 6) || !is_tuple(given[0], 8) || !((a_limits.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_limits.P.size0, false))) || !((a_limits.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_limits.q.size0, false))) || !((a_limits.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_limits.G.size0, false))) || !((a_limits.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_limits.h.size0, false))) || !((a_limits.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_limits.A.size0, false))) || !((a_limits.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_limits.b.size0, false))) || !((a_limits.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_limits.lb.size0, false))) || !((a_limits.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_limits.ub.size0, false))) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[2], 2, &a_past.size0, false))) || !is_tuple(given[3], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[3], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[3], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[3], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[3], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[3], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[3], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[3], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[3], 7), &a_yielding.coupled) || !is_tuple(given[4], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[4], 0), 1, &a_views.program.size0, false))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[4], 1), 1, &a_views.point.size0, false))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[4], 2), 1, &a_views.figures.size0, true))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[4], 3), 1, &a_views.placement.size0, false))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[4], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[4], 5), 1, &a_views.dq.size0, false))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[4], 6), 1, &a_views.decision.size0, false))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[4], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[4], 8), 1, &a_views.blocking.size0, false))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[4], 9), 2, &a_views.targets.size0, false))) || !((a_x.data = read_doubles(given[5], 1, &a_x.size0, true)))) return NULL;
    double result;
    result = control_yielding_make_stoppable(arena_here(), &a_limits, &a_arrays, a_past, &a_yielding, &a_views, a_x);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_yielding_brake(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_limits;
    Matrix a_past;
    relaxed_Yielding a_yielding;
    Vector a_dq;
    if (!counted("control_yielding_brake", count, 4) || !is_tuple(given[0], 8) || !((a_limits.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_limits.P.size0, false))) || !((a_limits.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_limits.q.size0, false))) || !((a_limits.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_limits.G.size0, false))) || !((a_limits.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_limits.h.size0, false))) || !((a_limits.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_limits.A.size0, false))) || !((a_limits.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_limits.b.size0, false))) || !((a_limits.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_limits.lb.size0, false))) || !((a_limits.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_limits.ub.size0, false))) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[2], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.coupled) || !((a_dq.data = read_doubles(given[3], 1, &a_dq.size0, true)))) return NULL;
    double result;
    result = control_yielding_brake(arena_here(), &a_limits, a_past, &a_yielding, a_dq);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_yielding_go_away(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_limits;
    Vector a_last;
    Vector a_dq;
    if (!counted("control_yielding_go_away", count, 3) || !is_tuple(given[0], 8) || !((a_limits.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_limits.P.size0, false))) || !((a_limits.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_limits.q.size0, false))) || !((a_limits.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_limits.G.size0, false))) || !((a_limits.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_limits.h.size0, false))) || !((a_limits.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_limits.A.size0, false))) || !((a_limits.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_limits.b.size0, false))) || !((a_limits.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_limits.lb.size0, false))) || !((a_limits.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_limits.ub.size0, false))) || !((a_last.data = read_doubles(given[1], 1, &a_last.size0, false))) || !((a_dq.data = read_doubles(given[2], 1, &a_dq.size0, true)))) return NULL;
    bool result;
    result = control_yielding_go_away(arena_here(), &a_limits, a_last, a_dq);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_yielding_note_missing(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    command_RowViews a_views;
    Vector a_dq;
    if (!counted("control_yielding_note_missing", count, 2) || !is_tuple(given[0], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_views.program.size0, false))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_views.point.size0, false))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_views.figures.size0, false))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_views.placement.size0, false))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_views.dq.size0, false))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_views.decision.size0, false))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_views.blocking.size0, true))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_views.targets.size0, false))) || !((a_dq.data = read_doubles(given[1], 1, &a_dq.size0, false)))) return NULL;
    int64_t result;
    result = control_yielding_note_missing(arena_here(), &a_views, a_dq);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_control_yielding_note_decision(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    command_RowViews a_views;
    layout_QPViews a_own;
    Vector a_weights;
    Vector a_x;
    int64_t a_kind;
    double a_factor;
    int64_t a_action;
    if (!counted("control_yielding_note_decision", count, 7) || !is_tuple(given[0], 10) || !((a_views.program.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_views.program.size0, false))) || !((a_views.point.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_views.point.size0, false))) || !((a_views.figures.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_views.figures.size0, false))) || !((a_views.placement.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_views.placement.size0, false))) || !((a_views.past.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_views.past.size0, false))) || !((a_views.dq.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_views.dq.size0, false))) || !((a_views.decision.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_views.decision.size0, true))) || !((a_views.bounds.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_views.bounds.size0, false))) || !((a_views.blocking.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 1, &a_views.blocking.size0, false))) || !((a_views.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_views.targets.size0, false))) || !is_tuple(given[1], 8) || !((a_own.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_own.P.size0, false))) || !((a_own.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_own.q.size0, false))) || !((a_own.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_own.G.size0, false))) || !((a_own.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_own.h.size0, false))) || !((a_own.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_own.A.size0, false))) || !((a_own.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_own.b.size0, false))) || !((a_own.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_own.lb.size0, false))) || !((a_own.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_own.ub.size0, false))) || !((a_weights.data = read_doubles(given[2], 1, &a_weights.size0, false))) || !((a_x.data = read_doubles(given[3], 1, &a_x.size0, false))) || !read_int(given[4], &a_kind) || !read_double(given[5], &a_factor) || !read_int(given[6], &a_action)) return NULL;

    control_yielding_note_decision(arena_here(), &a_views, &a_own, a_weights, a_x, a_kind, a_factor, a_action);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_control_stopping_way_along(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    double a_x;
    double a_b;
    double a_count;
    double a_dt;
    if (!counted("control_stopping_way_along", count, 5) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_double(given[1], &a_x) || !read_double(given[2], &a_b) || !read_double(given[3], &a_count) || !read_double(given[4], &a_dt)) return NULL;
    double result;
    result = control_stopping_way_along(arena_here(), &a_motion, a_x, a_b, a_count, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_least_way(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    double a_x;
    double a_b;
    double a_dt;
    if (!counted("control_stopping_least_way", count, 4) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !read_double(given[1], &a_x) || !read_double(given[2], &a_b) || !read_double(given[3], &a_dt)) return NULL;
    double result;
    result = control_stopping_least_way(arena_here(), &a_motion, a_x, a_b, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_is_straight(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    if (!counted("control_stopping_is_straight", count, 1) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic)) return NULL;
    bool result;
    result = control_stopping_is_straight(arena_here(), &a_motion);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_keeps_joint_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    Vector a_q;
    Vector a_limits;
    double a_dt;
    if (!counted("control_stopping_keeps_joint_limits", count, 4) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_limits.data = read_doubles(given[2], 1, &a_limits.size0, false))) || !read_double(given[3], &a_dt)) return NULL;
    bool result;
    result = control_stopping_keeps_joint_limits(arena_here(), &a_motion, a_q, a_limits, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_keeps_ramp(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    Vector a_q;
    Vector a_limits;
    double a_dt;
    int64_t a_i;
    if (!counted("control_stopping_keeps_ramp", count, 5) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_limits.data = read_doubles(given[2], 1, &a_limits.size0, false))) || !read_double(given[3], &a_dt) || !read_int(given[4], &a_i)) return NULL;
    bool result;
    result = control_stopping_keeps_ramp(arena_here(), &a_motion, a_q, a_limits, a_dt, a_i);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_control_stopping_keeps_distances(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    program_ProgramArrays a_arrays;
    Vector a_constants;
    double a_dt;
    if (!counted("control_stopping_keeps_distances", count, 4) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !is_tuple(given[1], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[1], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[1], 6), &a_arrays.rate) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !read_double(given[3], &a_dt)) return NULL;
    bool result;
    result = control_stopping_keeps_distances(arena_here(), &a_motion, &a_arrays, a_constants, a_dt);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_schemes_scene_place_bodies(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    scene_SceneViews a_scene;
    Matrix a_placements;
    Matrix a_placed;
    if (!counted("schemes_scene_place_bodies", count, 3) || !is_tuple(given[0], 7) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_scene.least) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_scene.gain) || !((a_scene.dq_max.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_scene.dq_max.size0, false))) || !((a_scene.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_scene.bodies.size0, false))) || !((a_scene.pairs.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_scene.pairs.size0, false))) || !((a_scene.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_scene.moves.size0, false))) || !((a_scene.radii.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_scene.radii.size0, false))) || !((a_placements.data = read_doubles(given[1], 2, &a_placements.size0, false))) || !((a_placed.data = read_doubles(given[2], 2, &a_placed.size0, true)))) return NULL;

    schemes_scene_place_bodies(arena_here(), &a_scene, a_placements, a_placed);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_step_vector_at(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_array;
    int64_t a_start;
    if (!counted("schemes_step_vector_at", count, 2) || !((a_array.data = read_doubles(given[0], 1, &a_array.size0, false))) || !read_int(given[1], &a_start)) return NULL;
    double_3 result;
    result = schemes_step_vector_at(arena_here(), a_array, a_start);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_ends_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    scene_SceneViews a_scene;
    Matrix a_placed;
    int64_t a_body;
    if (!counted("schemes_scene_ends_of", count, 3) || !is_tuple(given[0], 7) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_scene.least) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_scene.gain) || !((a_scene.dq_max.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_scene.dq_max.size0, false))) || !((a_scene.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_scene.bodies.size0, false))) || !((a_scene.pairs.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_scene.pairs.size0, false))) || !((a_scene.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_scene.moves.size0, false))) || !((a_scene.radii.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_scene.radii.size0, false))) || !((a_placed.data = read_doubles(given[1], 2, &a_placed.size0, false))) || !read_int(given[2], &a_body)) return NULL;
    double_3_2 result;
    result = schemes_scene_ends_of(arena_here(), &a_scene, a_placed, a_body);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0].at[0]), PyFloat_FromDouble(result.at[0].at[1]), PyFloat_FromDouble(result.at[0].at[2])), Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[1].at[0]), PyFloat_FromDouble(result.at[1].at[1]), PyFloat_FromDouble(result.at[1].at[2])));
}
static PyObject *py_references_rotations_combined(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_a;
    double_3 a_u;
    double a_b;
    double_3 a_v;
    if (!counted("references_rotations_combined", count, 4) || !read_double(given[0], &a_a) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_u.at[2]) || !read_double(given[2], &a_b) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_v.at[2])) return NULL;
    double_3 result;
    result = references_rotations_combined(arena_here(), a_a, a_u, a_b, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_step_seen_from(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_placement;
    double_3 a_v;
    if (!counted("schemes_step_seen_from", count, 2) || !((a_placement.data = read_doubles(given[0], 1, &a_placement.size0, false))) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    result = schemes_step_seen_from(arena_here(), a_placement, a_v);
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
    result = schemes_scene_nearest_parameter(arena_here(), a_a, a_u, a_half);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_scene_beyond(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_x;
    double_3 a_half;
    if (!counted("schemes_scene_beyond", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_x.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_x.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_x.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_half.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_half.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_half.at[2])) return NULL;
    double_3 result;
    result = schemes_scene_beyond(arena_here(), a_x, a_half);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_depth(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_x;
    double_3 a_half;
    if (!counted("schemes_scene_depth", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_x.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_x.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_x.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_half.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_half.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_half.at[2])) return NULL;
    double_4 result;
    result = schemes_scene_depth(arena_here(), a_x, a_half);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]));
}
static PyObject *py_schemes_step_axis_at(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_placement;
    double_3 a_axis;
    if (!counted("schemes_step_axis_at", count, 2) || !((a_placement.data = read_doubles(given[0], 1, &a_placement.size0, false))) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_axis.at[2])) return NULL;
    double_3 result;
    result = schemes_step_axis_at(arena_here(), a_placement, a_axis);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_scaled(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_a;
    double_3 a_u;
    if (!counted("references_rotations_scaled", count, 2) || !read_double(given[0], &a_a) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_u.at[2])) return NULL;
    double_3 result;
    result = references_rotations_scaled(arena_here(), a_a, a_u);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_added(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_u;
    double_3 a_v;
    if (!counted("references_rotations_added", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_u.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    result = references_rotations_added(arena_here(), a_u, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_schemes_scene_second_order(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_moves;
    Matrix a_radii;
    int64_t a_k;
    Vector a_travel;
    if (!counted("schemes_scene_second_order", count, 4) || !((a_moves.data = read_doubles(given[0], 2, &a_moves.size0, false))) || !((a_radii.data = read_doubles(given[1], 2, &a_radii.size0, false))) || !read_int(given[2], &a_k) || !((a_travel.data = read_doubles(given[3], 1, &a_travel.size0, false)))) return NULL;
    double result;
    result = schemes_scene_second_order(arena_here(), a_moves, a_radii, a_k, a_travel);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_control_stopping_along(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    stopping_Motion a_motion;
    Matrix a_jacobian;
    Matrix a_moves;
    int64_t a_k;
    double_3 a_point;
    double_3 a_normal;
    if (!counted("control_stopping_along", count, 6) || !is_tuple(given[0], 4) || !((a_motion.first.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 1, &a_motion.first.size0, false))) || !((a_motion.bend.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_motion.bend.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_motion.periods) || !read_bool(PyTuple_GET_ITEM(given[0], 3), &a_motion.cubic) || !((a_jacobian.data = read_doubles(given[1], 2, &a_jacobian.size0, false))) || !((a_moves.data = read_doubles(given[2], 2, &a_moves.size0, false))) || !read_int(given[3], &a_k) || !is_tuple(given[4], 3) || !read_double(PyTuple_GET_ITEM(given[4], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[4], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[4], 2), &a_point.at[2]) || !is_tuple(given[5], 3) || !read_double(PyTuple_GET_ITEM(given[5], 0), &a_normal.at[0]) || !read_double(PyTuple_GET_ITEM(given[5], 1), &a_normal.at[1]) || !read_double(PyTuple_GET_ITEM(given[5], 2), &a_normal.at[2])) return NULL;
    double_2 result;
    result = control_stopping_along(arena_here(), &a_motion, a_jacobian, a_moves, a_k, a_point, a_normal);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_schemes_step_rate_along(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_jacobian;
    int64_t a_j;
    double_3 a_point;
    double_3 a_normal;
    if (!counted("schemes_step_rate_along", count, 4) || !((a_jacobian.data = read_doubles(given[0], 2, &a_jacobian.size0, false))) || !read_int(given[1], &a_j) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_point.at[2]) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_normal.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_normal.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_normal.at[2])) return NULL;
    double result;
    result = schemes_step_rate_along(arena_here(), a_jacobian, a_j, a_point, a_normal);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_step_point_rate(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_jacobian;
    int64_t a_j;
    double_3 a_point;
    if (!counted("schemes_step_point_rate", count, 3) || !((a_jacobian.data = read_doubles(given[0], 2, &a_jacobian.size0, false))) || !read_int(given[1], &a_j) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_point.at[2])) return NULL;
    double_3 result;
    result = schemes_step_point_rate(arena_here(), a_jacobian, a_j, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_cross(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_u;
    double_3 a_v;
    if (!counted("references_rotations_cross", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_u.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_u.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_u.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    result = references_rotations_cross(arena_here(), a_u, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_control_stopping_stopping_time(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    program_ProgramArrays a_arrays;
    Matrix a_past;
    relaxed_Yielding a_yielding;
    Vector a_dq;
    if (!counted("control_stopping_stopping_time", count, 4) || !is_tuple(given[0], 7) || !((a_arrays.table.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 2, &a_arrays.table.size0, false))) || !((a_arrays.constants.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_arrays.constants.size0, false))) || !((a_arrays.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_arrays.jacobian.size0, false))) || !((a_arrays.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 2, &a_arrays.placements.size0, false))) || !((a_arrays.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_arrays.moves.size0, false))) || !((a_arrays.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_arrays.inertia.size0, false))) || !read_double(PyTuple_GET_ITEM(given[0], 6), &a_arrays.rate) || !((a_past.data = read_doubles(given[1], 2, &a_past.size0, false))) || !is_tuple(given[2], 8) || !((a_yielding.weights.data = read_doubles(PyTuple_GET_ITEM(given[2], 0), 1, &a_yielding.weights.size0, false))) || !((a_yielding.limits.data = read_doubles(PyTuple_GET_ITEM(given[2], 1), 1, &a_yielding.limits.size0, false))) || !((a_yielding.settings.data = read_doubles(PyTuple_GET_ITEM(given[2], 2), 1, &a_yielding.settings.size0, false))) || !((a_yielding.scenes.data = read_ints(PyTuple_GET_ITEM(given[2], 3), 2, &a_yielding.scenes.size0, false))) || !read_double(PyTuple_GET_ITEM(given[2], 4), &a_yielding.dt) || !read_int(PyTuple_GET_ITEM(given[2], 5), &a_yielding.stop) || !read_bool(PyTuple_GET_ITEM(given[2], 6), &a_yielding.cubic) || !read_bool(PyTuple_GET_ITEM(given[2], 7), &a_yielding.coupled) || !((a_dq.data = read_doubles(given[3], 1, &a_dq.size0, false)))) return NULL;
    double result;
    result = control_stopping_stopping_time(arena_here(), &a_arrays, a_past, &a_yielding, a_dq);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_networks_base_enter_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    int64_t a_address;
    layout_QPViews a_qp;
    Vector a_constants;
    Vector a_state;
    Vector a_rates;
    if (!counted("networks_base_enter_rates", count, 5) || !read_int(given[0], &a_address) || !is_tuple(given[1], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[1], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[1], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[1], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[1], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[1], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[1], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[1], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[1], 7), 1, &a_qp.ub.size0, false))) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[3], 1, &a_state.size0, false))) || !((a_rates.data = read_doubles(given[4], 1, &a_rates.size0, false)))) return NULL;

    networks_base_enter_rates(arena_here(), a_address, &a_qp, a_constants, a_state, a_rates);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_base_answer_program(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int_3 a_sizes;
    int64_t a_address;
    int64_t a_rates;
    Vector a_constants;
    Vector a_state;
    Vector a_point;
    if (!counted("integrators_base_answer_program", count, 7) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !is_tuple(given[1], 3) || !read_int(PyTuple_GET_ITEM(given[1], 0), &a_sizes.at[0]) || !read_int(PyTuple_GET_ITEM(given[1], 1), &a_sizes.at[1]) || !read_int(PyTuple_GET_ITEM(given[1], 2), &a_sizes.at[2]) || !read_int(given[2], &a_address) || !read_int(given[3], &a_rates) || !((a_constants.data = read_doubles(given[4], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[5], 1, &a_state.size0, false))) || !((a_point.data = read_doubles(given[6], 1, &a_point.size0, false)))) return NULL;
    double_5 result;
    Py_BEGIN_ALLOW_THREADS result = integrators_base_answer_program(arena_here(), a_data, a_sizes, a_address, a_rates, a_constants, a_state, a_point); Py_END_ALLOW_THREADS
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_integrators_explicit_follow(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    int64_t a_rates;
    Vector a_constants;
    Vector a_state;
    Vector a_point;
    if (!counted("integrators_explicit_follow", count, 5) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !read_int(given[1], &a_rates) || !((a_constants.data = read_doubles(given[2], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[3], 1, &a_state.size0, true))) || !((a_point.data = read_doubles(given[4], 1, &a_point.size0, true)))) return NULL;
    double_5 result;
    result = integrators_explicit_follow(arena_here(), &a_qp, a_rates, a_constants, a_state, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNNNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]), PyFloat_FromDouble(result.at[3]), PyFloat_FromDouble(result.at[4]));
}
static PyObject *py_networks_projection_stable_step(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_active;
    if (!counted("networks_projection_stable_step", count, 2) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_active.data = read_doubles(given[1], 1, &a_active.size0, false)))) return NULL;
    double result;
    result = networks_projection_stable_step(arena_here(), &a_qp, a_active);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_qp_dense_extreme_eigenvalues(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    if (!counted("qp_dense_extreme_eigenvalues", count, 1) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, true)))) return NULL;
    double_2 result;
    result = qp_dense_extreme_eigenvalues(arena_here(), a_K);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_qp_dense_rotate(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_K;
    int64_t a_i;
    int64_t a_k;
    if (!counted("qp_dense_rotate", count, 3) || !((a_K.data = read_doubles(given[0], 2, &a_K.size0, true))) || !read_int(given[1], &a_i) || !read_int(given[2], &a_k)) return NULL;

    qp_dense_rotate(arena_here(), a_K, a_i, a_k);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_integrators_implicit_step_program(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    Vector a_s;
    double a_step;
    if (!counted("integrators_implicit_step_program", count, 6) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p) || !((a_s.data = read_doubles(given[4], 1, &a_s.size0, true))) || !read_double(given[5], &a_step)) return NULL;
    int64_t result;
    result = integrators_implicit_step_program(arena_here(), a_data, a_n, a_m, a_p, a_s, a_step);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_networks_projection_projection_rates(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    layout_QPViews a_qp;
    Vector a_constants;
    Vector a_state;
    Vector a_rates;
    if (!counted("networks_projection_projection_rates", count, 4) || !is_tuple(given[0], 8) || !((a_qp.P.data = read_doubles(PyTuple_GET_ITEM(given[0], 0), 2, &a_qp.P.size0, false))) || !((a_qp.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 1, &a_qp.q.size0, false))) || !((a_qp.G.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_qp.G.size0, false))) || !((a_qp.h.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_qp.h.size0, false))) || !((a_qp.A.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_qp.A.size0, false))) || !((a_qp.b.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 1, &a_qp.b.size0, false))) || !((a_qp.lb.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 1, &a_qp.lb.size0, false))) || !((a_qp.ub.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_qp.ub.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_state.data = read_doubles(given[2], 1, &a_state.size0, false))) || !((a_rates.data = read_doubles(given[3], 1, &a_rates.size0, true)))) return NULL;

    networks_projection_projection_rates(arena_here(), &a_qp, a_constants, a_state, a_rates);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_qp_dense_is_convex(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_P;
    Matrix a_K;
    if (!counted("qp_dense_is_convex", count, 2) || !((a_P.data = read_doubles(given[0], 2, &a_P.size0, false))) || !((a_K.data = read_doubles(given[1], 2, &a_K.size0, true)))) return NULL;
    bool result;
    result = qp_dense_is_convex(arena_here(), a_P, a_K);
    if (failed && raise_failure()) return NULL;
    return PyBool_FromLong(result);
}
static PyObject *py_qp_program_well_formed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    if (!counted("qp_program_well_formed", count, 4) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p)) return NULL;
    bool result;
    result = qp_program_well_formed(arena_here(), a_data, a_n, a_m, a_p);
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
    result = qp_residuals_residuals_of(arena_here(), a_data, a_n, a_m, a_p, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_qp_residuals_point_of_state(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_data;
    int64_t a_n;
    int64_t a_m;
    int64_t a_p;
    Vector a_s;
    Vector a_point;
    if (!counted("qp_residuals_point_of_state", count, 6) || !((a_data.data = read_doubles(given[0], 1, &a_data.size0, false))) || !read_int(given[1], &a_n) || !read_int(given[2], &a_m) || !read_int(given[3], &a_p) || !((a_s.data = read_doubles(given[4], 1, &a_s.size0, false))) || !((a_point.data = read_doubles(given[5], 1, &a_point.size0, true)))) return NULL;
    double_3 result;
    result = qp_residuals_point_of_state(arena_here(), a_data, a_n, a_m, a_p, a_s, a_point);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_coefficients(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_square;
    if (!counted("references_rotations_coefficients", count, 1) || !read_double(given[0], &a_square)) return NULL;
    double_2 result;
    result = references_rotations_coefficients(arena_here(), a_square);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]));
}
static PyObject *py_references_rotations_rotated(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_vector;
    double_3 a_v;
    if (!counted("references_rotations_rotated", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_vector.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_vector.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_vector.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    result = references_rotations_rotated(arena_here(), a_vector, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_left_jacobian(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double_3 a_vector;
    double_3 a_v;
    if (!counted("references_rotations_left_jacobian", count, 2) || !is_tuple(given[0], 3) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_vector.at[0]) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_vector.at[1]) || !read_double(PyTuple_GET_ITEM(given[0], 2), &a_vector.at[2]) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_v.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_v.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_v.at[2])) return NULL;
    double_3 result;
    result = references_rotations_left_jacobian(arena_here(), a_vector, a_v);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_column_of(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_target;
    int64_t a_j;
    if (!counted("references_rotations_column_of", count, 2) || !((a_target.data = read_doubles(given[0], 1, &a_target.size0, false))) || !read_int(given[1], &a_j)) return NULL;
    double_3 result;
    result = references_rotations_column_of(arena_here(), a_target, a_j);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_rotations_turn_target(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_target;
    double_3 a_vector;
    double_3 a_rate;
    if (!counted("references_rotations_turn_target", count, 3) || !((a_target.data = read_doubles(given[0], 1, &a_target.size0, true))) || !is_tuple(given[1], 3) || !read_double(PyTuple_GET_ITEM(given[1], 0), &a_vector.at[0]) || !read_double(PyTuple_GET_ITEM(given[1], 1), &a_vector.at[1]) || !read_double(PyTuple_GET_ITEM(given[1], 2), &a_vector.at[2]) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_rate.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_rate.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_rate.at[2])) return NULL;

    references_rotations_turn_target(arena_here(), a_target, a_vector, a_rate);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_heart_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_shapes_heart_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_shapes_heart_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_circle_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_shapes_circle_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_shapes_circle_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_line_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_shapes_line_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_shapes_line_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_lissajous_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_shapes_lissajous_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_shapes_lissajous_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_shapes_still_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_shapes_still_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false)))) return NULL;

    references_shapes_still_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_turning_cone_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_turning_cone_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_turning_cone_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_turning_tilting_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_turning_tilting_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_turning_tilting_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_waypoints_waypoints_path(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    Vector a_target;
    if (!counted("references_waypoints_waypoints_path", count, 3) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, true)))) return NULL;

    references_waypoints_waypoints_path(arena_here(), a_t, a_constants, a_target);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_references_waypoints_piece(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_t;
    Vector a_constants;
    if (!counted("references_waypoints_piece", count, 2) || !read_double(given[0], &a_t) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false)))) return NULL;
    double_3 result;
    result = references_waypoints_piece(arena_here(), a_t, a_constants);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_waypoints_cubic(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    int64_t a_at;
    double a_x;
    if (!counted("references_waypoints_cubic", count, 3) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !read_int(given[1], &a_at) || !read_double(given[2], &a_x)) return NULL;
    double_3 result;
    result = references_waypoints_cubic(arena_here(), a_constants, a_at, a_x);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_waypoints_triple(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    int64_t a_at;
    if (!counted("references_waypoints_triple", count, 2) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !read_int(given[1], &a_at)) return NULL;
    double_3 result;
    result = references_waypoints_triple(arena_here(), a_constants, a_at);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_references_waypoints_slope(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    int64_t a_at;
    double a_x;
    if (!counted("references_waypoints_slope", count, 3) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !read_int(given[1], &a_at) || !read_double(given[2], &a_x)) return NULL;
    double_3 result;
    result = references_waypoints_slope(arena_here(), a_constants, a_at, a_x);
    if (failed && raise_failure()) return NULL;
    return Py_BuildValue("(NNN)", PyFloat_FromDouble(result.at[0]), PyFloat_FromDouble(result.at[1]), PyFloat_FromDouble(result.at[2]));
}
static PyObject *py_robot_kinematics_kernel_write_kinematics(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    kinematics_kernel_ModelTables a_model;
    Vector a_q;
    Matrix a_jacobian;
    Matrix a_placements;
    Matrix a_inertia;
    if (!counted("robot_kinematics_kernel_write_kinematics", count, 5) || !is_tuple(given[0], 8) || !((a_model.parents.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 1, &a_model.parents.size0, false))) || !((a_model.joints.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 2, &a_model.joints.size0, false))) || !((a_model.kinds.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_model.kinds.size0, false))) || !((a_model.frames.data = read_ints(PyTuple_GET_ITEM(given[0], 3), 2, &a_model.frames.size0, false))) || !((a_model.offsets.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_model.offsets.size0, false))) || !((a_model.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_model.bodies.size0, false))) || !((a_model.supports.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_model.supports.size0, false))) || !((a_model.armature.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_model.armature.size0, false))) || !((a_q.data = read_doubles(given[1], 1, &a_q.size0, false))) || !((a_jacobian.data = read_doubles(given[2], 2, &a_jacobian.size0, false))) || !((a_placements.data = read_doubles(given[3], 2, &a_placements.size0, false))) || !((a_inertia.data = read_doubles(given[4], 2, &a_inertia.size0, true)))) return NULL;

    robot_kinematics_kernel_write_kinematics(arena_here(), &a_model, a_q, a_jacobian, a_placements, a_inertia);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_compose(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_first;
    Vector a_second;
    Vector a_product;
    if (!counted("robot_kinematics_kernel_compose", count, 3) || !((a_first.data = read_doubles(given[0], 1, &a_first.size0, false))) || !((a_second.data = read_doubles(given[1], 1, &a_second.size0, false))) || !((a_product.data = read_doubles(given[2], 1, &a_product.size0, true)))) return NULL;

    robot_kinematics_kernel_compose(arena_here(), a_first, a_second, a_product);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_write_twist(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_placement;
    Vector a_kind;
    Vector a_twist;
    if (!counted("robot_kinematics_kernel_write_twist", count, 3) || !((a_placement.data = read_doubles(given[0], 1, &a_placement.size0, false))) || !((a_kind.data = read_doubles(given[1], 1, &a_kind.size0, false))) || !((a_twist.data = read_doubles(given[2], 1, &a_twist.size0, true)))) return NULL;

    robot_kinematics_kernel_write_twist(arena_here(), a_placement, a_kind, a_twist);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_robot_kinematics_kernel_write_inertia(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    kinematics_kernel_ModelTables a_model;
    Matrix a_placed;
    Matrix a_jacobian;
    Matrix a_inertia;
    if (!counted("robot_kinematics_kernel_write_inertia", count, 4) || !is_tuple(given[0], 8) || !((a_model.parents.data = read_ints(PyTuple_GET_ITEM(given[0], 0), 1, &a_model.parents.size0, false))) || !((a_model.joints.data = read_doubles(PyTuple_GET_ITEM(given[0], 1), 2, &a_model.joints.size0, false))) || !((a_model.kinds.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 2, &a_model.kinds.size0, false))) || !((a_model.frames.data = read_ints(PyTuple_GET_ITEM(given[0], 3), 2, &a_model.frames.size0, false))) || !((a_model.offsets.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 2, &a_model.offsets.size0, false))) || !((a_model.bodies.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_model.bodies.size0, false))) || !((a_model.supports.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_model.supports.size0, false))) || !((a_model.armature.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 1, &a_model.armature.size0, false))) || !((a_placed.data = read_doubles(given[1], 2, &a_placed.size0, false))) || !((a_jacobian.data = read_doubles(given[2], 2, &a_jacobian.size0, false))) || !((a_inertia.data = read_doubles(given[3], 2, &a_inertia.size0, true)))) return NULL;

    robot_kinematics_kernel_write_inertia(arena_here(), &a_model, a_placed, a_jacobian, a_inertia);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_collisions_collision_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_collisions_collision_rows", count, 6) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, true))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, true))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, false))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, false)))) return NULL;

    schemes_collisions_collision_rows(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_collisions_write_gradient(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Matrix a_moves;
    scene_Contact a_contact;
    Matrix a_jacobian;
    Vector a_dq_max;
    int64_t a_k;
    Matrix a_gradients;
    if (!counted("schemes_collisions_write_gradient", count, 6) || !((a_moves.data = read_doubles(given[0], 2, &a_moves.size0, false))) || !is_tuple(given[1], 4) || !is_tuple(PyTuple_GET_ITEM(given[1], 0), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 0), &a_contact.second.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 1), &a_contact.second.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 0), 2), &a_contact.second.at[2]) || !is_tuple(PyTuple_GET_ITEM(given[1], 1), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 0), &a_contact.first.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 1), &a_contact.first.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 1), 2), &a_contact.first.at[2]) || !is_tuple(PyTuple_GET_ITEM(given[1], 2), 3) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 2), 0), &a_contact.normal.at[0]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 2), 1), &a_contact.normal.at[1]) || !read_double(PyTuple_GET_ITEM(PyTuple_GET_ITEM(given[1], 2), 2), &a_contact.normal.at[2]) || !read_double(PyTuple_GET_ITEM(given[1], 3), &a_contact.distance) || !((a_jacobian.data = read_doubles(given[2], 2, &a_jacobian.size0, false))) || !((a_dq_max.data = read_doubles(given[3], 1, &a_dq_max.size0, false))) || !read_int(given[4], &a_k) || !((a_gradients.data = read_doubles(given[5], 2, &a_gradients.size0, true)))) return NULL;
    double result;
    result = schemes_collisions_write_gradient(arena_here(), a_moves, &a_contact, a_jacobian, a_dq_max, a_k, a_gradients);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_collisions_rank(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_slacks;
    int64_t a_k;
    if (!counted("schemes_collisions_rank", count, 2) || !((a_slacks.data = read_doubles(given[0], 1, &a_slacks.size0, false))) || !read_int(given[1], &a_k)) return NULL;
    int64_t result;
    result = schemes_collisions_rank(arena_here(), a_slacks, a_k);
    if (failed && raise_failure()) return NULL;
    return PyLong_FromLongLong(result);
}
static PyObject *py_schemes_costs_add_kinetic_energy(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_costs_add_kinetic_energy", count, 4) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, false)))) return NULL;

    schemes_costs_add_kinetic_energy(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_costs_add_cyclic_motion(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_costs_add_cyclic_motion", count, 4) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, true)))) return NULL;

    schemes_costs_add_cyclic_motion(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_limits_joint_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_limits_joint_limits", count, 6) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    schemes_limits_joint_limits(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_limits_ramp_speed(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    double a_distance;
    double a_offset;
    double a_deceleration;
    if (!counted("schemes_limits_ramp_speed", count, 3) || !read_double(given[0], &a_distance) || !read_double(given[1], &a_offset) || !read_double(given[2], &a_deceleration)) return NULL;
    double result;
    result = schemes_limits_ramp_speed(arena_here(), a_distance, a_offset, a_deceleration);
    if (failed && raise_failure()) return NULL;
    return PyFloat_FromDouble(result);
}
static PyObject *py_schemes_limits_motion_limits(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_limits_motion_limits", count, 6) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    schemes_limits_motion_limits(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_limits_tip_speed_bounds(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_limits_tip_speed_bounds", count, 6) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, false))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, false))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    schemes_limits_tip_speed_bounds(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_cost(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_P;
    Vector a_q;
    if (!counted("schemes_parts_copy_cost", count, 4) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_P.data = read_doubles(given[2], 2, &a_P.size0, true))) || !((a_q.data = read_doubles(given[3], 1, &a_q.size0, true)))) return NULL;

    schemes_parts_copy_cost(arena_here(), &a_step, a_constants, a_P, a_q);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_task(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_parts_copy_task", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_parts_copy_task(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_parts_copy_limit(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Matrix a_G;
    Vector a_h;
    Vector a_lb;
    Vector a_ub;
    if (!counted("schemes_parts_copy_limit", count, 6) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_G.data = read_doubles(given[2], 2, &a_G.size0, true))) || !((a_h.data = read_doubles(given[3], 1, &a_h.size0, true))) || !((a_lb.data = read_doubles(given[4], 1, &a_lb.size0, true))) || !((a_ub.data = read_doubles(given[5], 1, &a_ub.size0, true)))) return NULL;

    schemes_parts_copy_limit(arena_here(), &a_step, a_constants, a_G, a_h, a_lb, a_ub);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_scene_move_centers(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    Matrix a_centers;
    double a_t;
    if (!counted("schemes_scene_move_centers", count, 3) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, true))) || !((a_centers.data = read_doubles(given[1], 2, &a_centers.size0, false))) || !read_double(given[2], &a_t)) return NULL;

    schemes_scene_move_centers(arena_here(), a_constants, a_centers, a_t);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_scene_write_distances(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_constants;
    int64_t a_dof;
    Matrix a_placements;
    Vector a_distances;
    if (!counted("schemes_scene_write_distances", count, 4) || !((a_constants.data = read_doubles(given[0], 1, &a_constants.size0, false))) || !read_int(given[1], &a_dof) || !((a_placements.data = read_doubles(given[2], 2, &a_placements.size0, false))) || !((a_distances.data = read_doubles(given[3], 1, &a_distances.size0, true)))) return NULL;

    schemes_scene_write_distances(arena_here(), a_constants, a_dof, a_placements, a_distances);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_step_write_velocity(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    double_3 a_point;
    double_3 a_axis;
    Vector a_row;
    if (!counted("schemes_step_write_velocity", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_point.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_point.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_point.at[2]) || !is_tuple(given[3], 3) || !read_double(PyTuple_GET_ITEM(given[3], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[3], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[3], 2), &a_axis.at[2]) || !((a_row.data = read_doubles(given[4], 1, &a_row.size0, true)))) return NULL;

    schemes_step_write_velocity(arena_here(), &a_step, a_constants, a_point, a_axis, a_row);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_step_write_spin(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    double_3 a_axis;
    Vector a_row;
    if (!counted("schemes_step_write_spin", count, 4) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !is_tuple(given[2], 3) || !read_double(PyTuple_GET_ITEM(given[2], 0), &a_axis.at[0]) || !read_double(PyTuple_GET_ITEM(given[2], 1), &a_axis.at[1]) || !read_double(PyTuple_GET_ITEM(given[2], 2), &a_axis.at[2]) || !((a_row.data = read_doubles(given[3], 1, &a_row.size0, true)))) return NULL;

    schemes_step_write_spin(arena_here(), &a_step, a_constants, a_axis, a_row);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_position_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_position_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_position_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_rotation_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_rotation_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_rotation_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_block_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_block_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_block_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_project_on_range(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    Vector a_placement;
    Vector a_b;
    if (!counted("schemes_tasks_project_on_range", count, 2) || !((a_placement.data = read_doubles(given[0], 1, &a_placement.size0, false))) || !((a_b.data = read_doubles(given[1], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_project_on_range(arena_here(), a_placement, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_pose_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_pose_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, false)))) return NULL;

    schemes_tasks_pose_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_held_pose_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_held_pose_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, false)))) return NULL;

    schemes_tasks_held_pose_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_axis_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_axis_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_axis_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_remote_center_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_remote_center_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, false))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_remote_center_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyObject *py_schemes_tasks_joint_rows(PyObject *self, PyObject *const *given, Py_ssize_t count)
{
    step_StepViews a_step;
    Vector a_constants;
    Vector a_target;
    Matrix a_A;
    Vector a_b;
    if (!counted("schemes_tasks_joint_rows", count, 5) || !is_tuple(given[0], 10) || !read_double(PyTuple_GET_ITEM(given[0], 0), &a_step.t) || !read_double(PyTuple_GET_ITEM(given[0], 1), &a_step.rate) || !((a_step.q.data = read_doubles(PyTuple_GET_ITEM(given[0], 2), 1, &a_step.q.size0, false))) || !((a_step.last.data = read_doubles(PyTuple_GET_ITEM(given[0], 3), 1, &a_step.last.size0, false))) || !((a_step.before.data = read_doubles(PyTuple_GET_ITEM(given[0], 4), 1, &a_step.before.size0, false))) || !((a_step.jacobian.data = read_doubles(PyTuple_GET_ITEM(given[0], 5), 2, &a_step.jacobian.size0, false))) || !((a_step.placements.data = read_doubles(PyTuple_GET_ITEM(given[0], 6), 2, &a_step.placements.size0, false))) || !((a_step.moves.data = read_doubles(PyTuple_GET_ITEM(given[0], 7), 2, &a_step.moves.size0, false))) || !((a_step.inertia.data = read_doubles(PyTuple_GET_ITEM(given[0], 8), 2, &a_step.inertia.size0, false))) || !((a_step.targets.data = read_doubles(PyTuple_GET_ITEM(given[0], 9), 2, &a_step.targets.size0, false))) || !((a_constants.data = read_doubles(given[1], 1, &a_constants.size0, false))) || !((a_target.data = read_doubles(given[2], 1, &a_target.size0, false))) || !((a_A.data = read_doubles(given[3], 2, &a_A.size0, true))) || !((a_b.data = read_doubles(given[4], 1, &a_b.size0, true)))) return NULL;

    schemes_tasks_joint_rows(arena_here(), &a_step, a_constants, a_target, a_A, a_b);
    if (failed && raise_failure()) return NULL;
    return Py_NewRef(Py_None);
}
static PyMethodDef methods[] = {
    {"scratch_peak", scratch_peak, METH_NOARGS, NULL},
    {"control_command_row_ends", (PyCFunction)(void (*)(void))py_control_command_row_ends, METH_FASTCALL, "control_command_row_ends(n, m, p, dof)\n--\n\nCompute the columns at which all parts of a row but the last end, in their order."},
    {"control_relaxed_copied", (PyCFunction)(void (*)(void))py_control_relaxed_copied, METH_FASTCALL, "control_relaxed_copied(out, values)\n--\n\nWrite values (k,) into the first k of `out`."},
    {"control_relaxed_largest_entry", (PyCFunction)(void (*)(void))py_control_relaxed_largest_entry, METH_FASTCALL, "control_relaxed_largest_entry(values)\n--\n\nReturn the largest absolute value of an array (k,)."},
    {"control_relaxed_settled", (PyCFunction)(void (*)(void))py_control_relaxed_settled, METH_FASTCALL, "control_relaxed_settled(qp, yielding, state, point, figures, tolerances)\n--\n\nSettle the network from its last state or, if need be, from a cold start."},
    {"integrators_implicit_settle", (PyCFunction)(void (*)(void))py_integrators_implicit_settle, METH_FASTCALL, "integrators_implicit_settle(qp, rates, constants, s, point)\n--\n\nAdvance `s` (size,) in place until the residuals of `point` (size,) are small enough."},
    {"networks_projection_field", (PyCFunction)(void (*)(void))py_networks_projection_field, METH_FASTCALL, "networks_projection_field(qp, s, rates)\n--\n\nWrite rho ds/dt at a state, both (size,), without the projection of x on its bounds."},
    {"qp_dense_times", (PyCFunction)(void (*)(void))py_qp_dense_times, METH_FASTCALL, "qp_dense_times(rows, x, out)\n--\n\nWrite the product of a matrix (k, n) and the first n entries of x into the first k of `out`."},
    {"qp_dense_row_dot", (PyCFunction)(void (*)(void))py_qp_dense_row_dot, METH_FASTCALL, "qp_dense_row_dot(rows, j, x)\n--\n\nCompute the product of row j of a matrix (k, n) and the first n entries of x."},
    {"networks_projection_add_transposed", (PyCFunction)(void (*)(void))py_networks_projection_add_transposed, METH_FASTCALL, "networks_projection_add_transposed(qp, factor, s, out)\n--\n\nAdd factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,)."},
    {"qp_dense_add_row", (PyCFunction)(void (*)(void))py_qp_dense_add_row, METH_FASTCALL, "qp_dense_add_row(out, factor, rows, j)\n--\n\nAdd a multiple of row j of a matrix (k, n) to the first n entries of `out`."},
    {"networks_projection_write_slacks", (PyCFunction)(void (*)(void))py_networks_projection_write_slacks, METH_FASTCALL, "networks_projection_write_slacks(qp, x, slacks)\n--\n\nWrite A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."},
    {"networks_projection_rows_times", (PyCFunction)(void (*)(void))py_networks_projection_rows_times, METH_FASTCALL, "networks_projection_rows_times(qp, x, values)\n--\n\nWrite [A; G; I; -I] x into `values`, of size p + m + 2n."},
    {"qp_layout_larger", (PyCFunction)(void (*)(void))py_qp_layout_larger, METH_FASTCALL, "qp_layout_larger(largest, value)\n--\n\nReturn the larger of two numbers; unlike with max(), a NaN once seen stays."},
    {"qp_residuals_kkt_point", (PyCFunction)(void (*)(void))py_qp_residuals_kkt_point, METH_FASTCALL, "qp_residuals_kkt_point(qp, s, point)\n--\n\nWrite the point [x | y | z | z_box] of a state [x | y | z | ...] into `point`."},
    {"qp_residuals_point_residuals", (PyCFunction)(void (*)(void))py_qp_residuals_point_residuals, METH_FASTCALL, "qp_residuals_point_residuals(qp, point)\n--\n\nCompute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them."},
    {"qp_residuals_within", (PyCFunction)(void (*)(void))py_qp_residuals_within, METH_FASTCALL, "qp_residuals_within(primal, dual, gap, tol)\n--\n\nCheck that no residual is above the tolerance, and none NaN."},
    {"networks_projection_mark_active", (PyCFunction)(void (*)(void))py_networks_projection_mark_active, METH_FASTCALL, "networks_projection_mark_active(qp, s, rates, active)\n--\n\nMark the rows [A; G; I; -I] that are active by 1, others by 0, (p + m + 2n,)."},
    {"integrators_implicit_steps_linear_step", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_linear_step, METH_FASTCALL, "integrators_implicit_steps_linear_step(qp, s, rates, step, matrix, new)\n--\n\nWrite the state after a linearly implicit step [rho] into `new`, like `s` (3n + m + p,)."},
    {"integrators_implicit_steps_build_condensed", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_build_condensed, METH_FASTCALL, "integrators_implicit_steps_build_condensed(qp, step, matrix)\n--\n\nWrite the condensed matrix of the active set for a step [rho] into `matrix.K`."},
    {"integrators_implicit_steps_count_rows", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_count_rows, METH_FASTCALL, "integrators_implicit_steps_count_rows(matrix, rows, first)\n--\n\nAdd active rows (k, n) to `gram`, and take off others: few change between two steps."},
    {"qp_dense_add_outer", (PyCFunction)(void (*)(void))py_qp_dense_add_outer, METH_FASTCALL, "qp_dense_add_outer(out, factor, rows, j)\n--\n\nAdd factor v v^T to the upper half of `out` (n, n), v being row j of a matrix (k, n)."},
    {"qp_dense_cholesky_factor", (PyCFunction)(void (*)(void))py_qp_dense_cholesky_factor, METH_FASTCALL, "qp_dense_cholesky_factor(K)\n--\n\nOverwrite the upper half of K (n, n) by R with K = R^T R, its diagonal inverted."},
    {"qp_dense_factor_solve", (PyCFunction)(void (*)(void))py_qp_dense_factor_solve, METH_FASTCALL, "qp_dense_factor_solve(K, rhs, out)\n--\n\nSolve with the factor that `cholesky_factor` left in K (n, n), into the first n of `out`."},
    {"integrators_implicit_steps_copy_into", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_copy_into, METH_FASTCALL, "integrators_implicit_steps_copy_into(out, values)\n--\n\nCopy all values (k,) into the first entries of `out`."},
    {"integrators_implicit_steps_backward_euler", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_backward_euler, METH_FASTCALL, "integrators_implicit_steps_backward_euler(qp, s, step, new, tol, max_newton, matrix)\n--\n\nSolve new = s + step F(new) for `new` (3n + m + p,), the iteration starting at s."},
    {"integrators_implicit_steps_multipliers", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_multipliers, METH_FASTCALL, "integrators_implicit_steps_multipliers(qp, s, step, slacks, new, active)\n--\n\nWrite the multipliers after a step to x with these slacks, and mark those that are active."},
    {"integrators_implicit_steps_descent", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_descent, METH_FASTCALL, "integrators_implicit_steps_descent(qp, s, step, new, descent)\n--\n\nWrite minus the gradient of the step's convex function; returns its largest entry."},
    {"integrators_implicit_steps_line_search", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_line_search, METH_FASTCALL, "integrators_implicit_steps_line_search(qp, s, step, slacks, change, direction, descent)\n--\n\nMinimize the step's convex function along the Newton `direction`, to `SLOPE`."},
    {"integrators_implicit_steps_slope", (PyCFunction)(void (*)(void))py_integrators_implicit_steps_slope, METH_FASTCALL, "integrators_implicit_steps_slope(n, p, s, step, slacks, change, length)\n--\n\nSum slope and curvature of the inequalities' part of the step's function at a length."},
    {"control_relaxed_largest_factor", (PyCFunction)(void (*)(void))py_control_relaxed_largest_factor, METH_FASTCALL, "control_relaxed_largest_factor(qp, yielding, state, point, figures, retreats)\n--\n\nCompute the largest factor of what a program asks for that its limits allow."},
    {"control_relaxed_data_size", (PyCFunction)(void (*)(void))py_control_relaxed_data_size, METH_FASTCALL, "control_relaxed_data_size(n, m, p)\n--\n\nCount the numbers of a program, `QP.data`."},
    {"qp_layout_offsets", (PyCFunction)(void (*)(void))py_qp_layout_offsets, METH_FASTCALL, "qp_layout_offsets(n, m, p)\n--\n\nCompute ``(at_q, at_G, at_A, at_lb)``, the beginnings of the parts of `QP.data`."},
    {"control_relaxed_copy_cost", (PyCFunction)(void (*)(void))py_control_relaxed_copy_cost, METH_FASTCALL, "control_relaxed_copy_cost(qp, other)\n--\n\nWrite w times the cost into a program that has more variables."},
    {"control_relaxed_copy_limits", (PyCFunction)(void (*)(void))py_control_relaxed_copy_limits, METH_FASTCALL, "control_relaxed_copy_limits(qp, other)\n--\n\nWrite bounds and inequality rows into a program that may have more variables."},
    {"control_relaxed_scale_task", (PyCFunction)(void (*)(void))py_control_relaxed_scale_task, METH_FASTCALL, "control_relaxed_scale_task(qp, weights, factor)\n--\n\nTurn a step's program, with task rows of some weights (p,), into the scaled one."},
    {"control_relaxed_soften_task", (PyCFunction)(void (*)(void))py_control_relaxed_soften_task, METH_FASTCALL, "control_relaxed_soften_task(qp, weights, retreat)\n--\n\nTurn a step's program, with weights (p,) of its rows, into the softened one."},
    {"control_relaxed_move_into_cost", (PyCFunction)(void (*)(void))py_control_relaxed_move_into_cost, METH_FASTCALL, "control_relaxed_move_into_cost(qp, j, square, shrink)\n--\n\nMove equality row j into the cost, with the square of its weight; its b is shrunk."},
    {"control_relaxed_note_blocking", (PyCFunction)(void (*)(void))py_control_relaxed_note_blocking, METH_FASTCALL, "control_relaxed_note_blocking(point, n, m, extra, blocking)\n--\n\nNote which bounds and rows stand in the way of a program."},
    {"control_relaxed_nearest_within", (PyCFunction)(void (*)(void))py_control_relaxed_nearest_within, METH_FASTCALL, "control_relaxed_nearest_within(qp, x, yielding, figures)\n--\n\nMove x (n,) into the bounds of a program, and on to the nearest point within its rows too."},
    {"control_relaxed_attained", (PyCFunction)(void (*)(void))py_control_relaxed_attained, METH_FASTCALL, "control_relaxed_attained(b, A, weights, x)\n--\n\nCompute the share of a task velocity b (p,) that joint velocities x (n,) give, at most 1."},
    {"control_shield_wished_velocity", (PyCFunction)(void (*)(void))py_control_shield_wished_velocity, METH_FASTCALL, "control_shield_wished_velocity(step, constants, target, A, b)\n--\n\nWrite A = I and b = w; the first numbers of the target (18,) are the velocity w (n,)."},
    {"control_shield_take_positions", (PyCFunction)(void (*)(void))py_control_shield_take_positions, METH_FASTCALL, "control_shield_take_positions(q, state, settings)\n--\n\nTake measured positions q (n,) [rad] over at the first step, or if they are far."},
    {"control_shield_take_wish", (PyCFunction)(void (*)(void))py_control_shield_take_wish, METH_FASTCALL, "control_shield_take_wish(wish, given, state, settings)\n--\n\nTake a wish (k,) over if one is given, else the last one, or one to rest for a reason."},
    {"qp_dense_all_finite", (PyCFunction)(void (*)(void))py_qp_dense_all_finite, METH_FASTCALL, "qp_dense_all_finite(data, start, end)\n--\n\nCheck that data[start:end] of (k,) is finite: NaN and infinity times zero are NaN."},
    {"control_shield_approach", (PyCFunction)(void (*)(void))py_control_shield_approach, METH_FASTCALL, "control_shield_approach(state, past, limits, dt, reaches, held, dq)\n--\n\nWrite the next velocities dq (n,) [rad/s] on the quickest way to the wish that counts."},
    {"schemes_limits_joint_bounds", (PyCFunction)(void (*)(void))py_schemes_limits_joint_bounds, METH_FASTCALL, "schemes_limits_joint_bounds(last, before, above, below, rates, dt)\n--\n\nCompute lower and upper bound of one joint's next command [rad/s], never the wrong way round."},
    {"schemes_limits_jerk_bounds", (PyCFunction)(void (*)(void))py_schemes_limits_jerk_bounds, METH_FASTCALL, "schemes_limits_jerk_bounds(last, before, above, below, rates, dt)\n--\n\nCompute `joint_bounds` where the jerk is limited."},
    {"schemes_limits_approach", (PyCFunction)(void (*)(void))py_schemes_limits_approach, METH_FASTCALL, "schemes_limits_approach(room)\n--\n\nCompute the largest x for which x + (x - 1) + (x - 2) + ... down to 0 is within `room`."},
    {"schemes_limits_ceiling", (PyCFunction)(void (*)(void))py_schemes_limits_ceiling, METH_FASTCALL, "schemes_limits_ceiling(lb, ub, distance, last, dt, braking_limits)\n--\n\nCompute the largest command in [lb, ub] whose highest position is within `distance`, else lb."},
    {"schemes_limits_highest", (PyCFunction)(void (*)(void))py_schemes_limits_highest, METH_FASTCALL, "schemes_limits_highest(v, last, dt, J, A)\n--\n\nCompute the highest position of the way to rest after command v, from that before it."},
    {"schemes_limits_stopping_distance", (PyCFunction)(void (*)(void))py_schemes_limits_stopping_distance, METH_FASTCALL, "schemes_limits_stopping_distance(v, a, J, A)\n--\n\nCompute the way of a spline from velocity v and acceleration a to rest."},
    {"schemes_limits_easing", (PyCFunction)(void (*)(void))py_schemes_limits_easing, METH_FASTCALL, "schemes_limits_easing(room, dt)\n--\n\nCompute the velocity [rad/s] of the way over `room` [rad]; what is rounding is not gone."},
    {"schemes_limits_acceleration_bounds", (PyCFunction)(void (*)(void))py_schemes_limits_acceleration_bounds, METH_FASTCALL, "schemes_limits_acceleration_bounds(last, above, below, rates, dt)\n--\n\nCompute `joint_bounds` where no jerk is limited."},
    {"schemes_limits_braking", (PyCFunction)(void (*)(void))py_schemes_limits_braking, METH_FASTCALL, "schemes_limits_braking(last, lb, ub, jerk, dt)\n--\n\nCompute the command in [lb, ub] that comes to rest quickest, without turning round."},
    {"control_step_take_step", (PyCFunction)(void (*)(void))py_control_step_take_step, METH_FASTCALL, "control_step_take_step(row, plan, past, following, state, relaxed, t, samples)\n--\n\nTake a control step: its own program, or what the policy asks for."},
    {"control_step_sample_targets", (PyCFunction)(void (*)(void))py_control_step_sample_targets, METH_FASTCALL, "control_step_sample_targets(arrays, t, targets)\n--\n\nWrite the targets (k, 18) of all paths at time t [s]; the constants begin with their base."},
    {"references_base_enter_path", (PyCFunction)(void (*)(void))py_references_base_enter_path, METH_FASTCALL, "references_base_enter_path(address, t, constants, target)\n--\n\nEnter a path's function at an address; it moves the target (18,) at time t [s]."},
    {"references_rotations_set_mean_twist", (PyCFunction)(void (*)(void))py_references_rotations_set_mean_twist, METH_FASTCALL, "references_rotations_set_mean_twist(now, then, dt)\n--\n\nSet the twist of a target (18,) to the mean one towards another, a period dt [s] later."},
    {"references_rotations_dot", (PyCFunction)(void (*)(void))py_references_rotations_dot, METH_FASTCALL, "references_rotations_dot(u, v)\n--\n\nCompute the scalar product u . v."},
    {"references_rotations_row_of", (PyCFunction)(void (*)(void))py_references_rotations_row_of, METH_FASTCALL, "references_rotations_row_of(target, i)\n--\n\nReturn the i-th row of the rotation of `Target.data` (18,)."},
    {"references_rotations_rotation_log", (PyCFunction)(void (*)(void))py_references_rotations_rotation_log, METH_FASTCALL, "references_rotations_rotation_log(R, out)\n--\n\nWrite the rotation vector of R (3, 3), of length at most pi [rad], into `out` (3,)."},
    {"schemes_program_assemble", (PyCFunction)(void (*)(void))py_schemes_program_assemble, METH_FASTCALL, "schemes_program_assemble(data, arrays, past, targets, t)\n--\n\nWrite the rows of all parts into a program."},
    {"schemes_parts_enter_cost", (PyCFunction)(void (*)(void))py_schemes_parts_enter_cost, METH_FASTCALL, "schemes_parts_enter_cost(address, step, constants, P, q)\n--\n\nEnter a cost's kernel, with constants (k,), P (n, n) and the cost vector q (n,)."},
    {"schemes_parts_enter_task", (PyCFunction)(void (*)(void))py_schemes_parts_enter_task, METH_FASTCALL, "schemes_parts_enter_task(address, step, constants, target, A, b)\n--\n\nEnter a task's kernel, with constants (k,), target (18,), A (rows, n), b (rows,)."},
    {"schemes_program_add_soft", (PyCFunction)(void (*)(void))py_schemes_program_add_soft, METH_FASTCALL, "schemes_program_add_soft(qp, A, b, weight)\n--\n\nAdd weight A^T A to P and -weight A^T b to q, for rows A (rows, n) and b (rows,)."},
    {"schemes_parts_enter_limit", (PyCFunction)(void (*)(void))py_schemes_parts_enter_limit, METH_FASTCALL, "schemes_parts_enter_limit(address, step, constants, G, h, lb, ub)\n--\n\nEnter a limit's kernel, with constants (k,), G (rows, n), h (rows,), lb and ub (n,)."},
    {"control_step_note_instant", (PyCFunction)(void (*)(void))py_control_step_note_instant, METH_FASTCALL, "control_step_note_instant(views, arrays, past)\n--\n\nNote what the program in a row was built at, and that it is not answered yet."},
    {"control_step_answer", (PyCFunction)(void (*)(void))py_control_step_answer, METH_FASTCALL, "control_step_answer(views, arrays, state)\n--\n\nAsk the network for the answer to the program in a row, and note it."},
    {"integrators_base_enter_answer", (PyCFunction)(void (*)(void))py_integrators_base_enter_answer, METH_FASTCALL, "integrators_base_enter_answer(address, qp, rates, constants, state, point)\n--\n\nEnter a compiled answer at an address."},
    {"control_step_status_of", (PyCFunction)(void (*)(void))py_control_step_status_of, METH_FASTCALL, "control_step_status_of(primal, dual, gap, own, state)\n--\n\nJudge an answer by its residuals; one that was advanced by its state (size,) too."},
    {"control_yielding_guard_step", (PyCFunction)(void (*)(void))py_control_yielding_guard_step, METH_FASTCALL, "control_yielding_guard_step(arrays, past, following, yielding)\n--\n\nTest whether the command that `following` holds is stoppable, and note its way to rest."},
    {"control_yielding_periods_to_rest", (PyCFunction)(void (*)(void))py_control_yielding_periods_to_rest, METH_FASTCALL, "control_yielding_periods_to_rest(arrays, past, yielding, x)\n--\n\nCompute `stopping_time` of a command x (dof,); 0 if no distance is kept."},
    {"control_stopping_enter_stopping_time", (PyCFunction)(void (*)(void))py_control_stopping_enter_stopping_time, METH_FASTCALL, "control_stopping_enter_stopping_time(address, arrays, past, yielding, dq)\n--\n\nEnter `stopping_time` at an address: controllers without scenes are exported without it."},
    {"control_yielding_yield_step", (PyCFunction)(void (*)(void))py_control_yielding_yield_step, METH_FASTCALL, "control_yielding_yield_step(views, arrays, past, following, state, yielding, relaxed, action)\n--\n\nAnswer a step for which the network has no answer, or whose task yielded at the last step."},
    {"control_yielding_widen_bounds", (PyCFunction)(void (*)(void))py_control_yielding_widen_bounds, METH_FASTCALL, "control_yielding_widen_bounds(qp, limits, q)\n--\n\nReplace bounds that acceleration limits have narrowed by those of position and velocity."},
    {"control_yielding_answer_relaxed", (PyCFunction)(void (*)(void))py_control_yielding_answer_relaxed, METH_FASTCALL, "control_yielding_answer_relaxed(views, qp, yielding, state, relaxed, action)\n--\n\nTurn a step's program into the first relaxed one that has a solution, and answer it."},
    {"control_yielding_is_path", (PyCFunction)(void (*)(void))py_control_yielding_is_path, METH_FASTCALL, "control_yielding_is_path(targets)\n--\n\nTest whether a target (k, 18) has a velocity."},
    {"control_yielding_races", (PyCFunction)(void (*)(void))py_control_yielding_races, METH_FASTCALL, "control_yielding_races(qp, x)\n--\n\nTest whether joints of the velocity x (n,) race while the tip hardly moves."},
    {"control_yielding_step", (PyCFunction)(void (*)(void))py_control_yielding_step, METH_FASTCALL, "control_yielding_step(limits, past, following, yielding, figures, x)\n--\n\nTurn a wanted velocity x (n,) into the next command on the way to it."},
    {"control_yielding_step_straight", (PyCFunction)(void (*)(void))py_control_yielding_step_straight, METH_FASTCALL, "control_yielding_step_straight(past, yielding, x)\n--\n\nReplace the wanted velocity x (n,) by the next command on the straight line to it."},
    {"control_stopping_least_periods", (PyCFunction)(void (*)(void))py_control_stopping_least_periods, METH_FASTCALL, "control_stopping_least_periods(x, before, limits, dt, cubic)\n--\n\nCompute the number of periods in which velocities go to zero together."},
    {"control_stopping_within_rates", (PyCFunction)(void (*)(void))py_control_stopping_within_rates, METH_FASTCALL, "control_stopping_within_rates(x, before, periods, accel, jerk)\n--\n\nTest whether a cubic keeps its limits per period of acceleration and jerk [rad/s]."},
    {"control_stopping_bend_of", (PyCFunction)(void (*)(void))py_control_stopping_bend_of, METH_FASTCALL, "control_stopping_bend_of(x, before, periods)\n--\n\nCompute b of the cubic through x now and x before, which ends after so many periods."},
    {"control_stopping_next_velocity", (PyCFunction)(void (*)(void))py_control_stopping_next_velocity, METH_FASTCALL, "control_stopping_next_velocity(x, before, periods, cubic)\n--\n\nCompute the velocity after the first of so many periods on the way to zero [rad/s]."},
    {"control_stopping_velocity_at", (PyCFunction)(void (*)(void))py_control_stopping_velocity_at, METH_FASTCALL, "control_stopping_velocity_at(x, b, u, cubic)\n--\n\nCompute the velocity [rad/s] at a part u of the periods of a motion that begins with x."},
    {"control_yielding_step_towards", (PyCFunction)(void (*)(void))py_control_yielding_step_towards, METH_FASTCALL, "control_yielding_step_towards(limits, past, yielding, x)\n--\n\nReplace the wanted velocity x (n,) by the next command of joints that hurry to it."},
    {"control_yielding_make_stoppable", (PyCFunction)(void (*)(void))py_control_yielding_make_stoppable, METH_FASTCALL, "control_yielding_make_stoppable(limits, arrays, past, yielding, views, x)\n--\n\nBring a command x (n,) nearer to the braking motion in hand until the arm can stop from it."},
    {"control_yielding_brake", (PyCFunction)(void (*)(void))py_control_yielding_brake, METH_FASTCALL, "control_yielding_brake(limits, past, yielding, dq)\n--\n\nWrite the next command (n,) of the braking motion in hand, or of the quickest one."},
    {"control_yielding_go_away", (PyCFunction)(void (*)(void))py_control_yielding_go_away, METH_FASTCALL, "control_yielding_go_away(limits, last, dq)\n--\n\nWrite the command dq (dof,) that goes straight away from what is too near."},
    {"control_yielding_note_missing", (PyCFunction)(void (*)(void))py_control_yielding_note_missing, METH_FASTCALL, "control_yielding_note_missing(views, dq)\n--\n\nNote the joints whose command dq (dof,) is short of the answer; return how many are."},
    {"control_yielding_note_decision", (PyCFunction)(void (*)(void))py_control_yielding_note_decision, METH_FASTCALL, "control_yielding_note_decision(views, own, weights, x, kind, factor, action)\n--\n\nNote the action, how far the reference's clock advances, status and kind of the program."},
    {"control_stopping_way_along", (PyCFunction)(void (*)(void))py_control_stopping_way_along, METH_FASTCALL, "control_stopping_way_along(motion, x, b, count, dt)\n--\n\nSum the velocities of a motion with x and b over its first `count` periods of dt [s]."},
    {"control_stopping_least_way", (PyCFunction)(void (*)(void))py_control_stopping_least_way, METH_FASTCALL, "control_stopping_least_way(motion, x, b, dt)\n--\n\nCompute the least way along a motion with x and b; at its start the way is zero."},
    {"control_stopping_is_straight", (PyCFunction)(void (*)(void))py_control_stopping_is_straight, METH_FASTCALL, "control_stopping_is_straight(motion)\n--\n\nTest whether the joints go straight on to where they rest."},
    {"control_stopping_keeps_joint_limits", (PyCFunction)(void (*)(void))py_control_stopping_keeps_joint_limits, METH_FASTCALL, "control_stopping_keeps_joint_limits(motion, q, limits, dt)\n--\n\nTest whether joints at q (n,) [rad] keep position and velocity limits on a motion to rest."},
    {"control_stopping_keeps_ramp", (PyCFunction)(void (*)(void))py_control_stopping_keeps_ramp, METH_FASTCALL, "control_stopping_keeps_ramp(motion, q, limits, dt, i)\n--\n\nTest whether joint i of those at q (n,) [rad] has room to brake all along a motion to rest."},
    {"control_stopping_keeps_distances", (PyCFunction)(void (*)(void))py_control_stopping_keeps_distances, METH_FASTCALL, "control_stopping_keeps_distances(motion, arrays, constants, dt)\n--\n\nTest whether all pairs of a scene keep their distance on a motion to rest."},
    {"schemes_scene_place_bodies", (PyCFunction)(void (*)(void))py_schemes_scene_place_bodies, METH_FASTCALL, "schemes_scene_place_bodies(scene, placements, placed)\n--\n\nWrite the placements of all bodies in the world, (b, 12), for those of frames (k, 12)."},
    {"schemes_step_vector_at", (PyCFunction)(void (*)(void))py_schemes_step_vector_at, METH_FASTCALL, "schemes_step_vector_at(array, start)\n--\n\nReturn three numbers of an array (k,), from an index on."},
    {"schemes_scene_ends_of", (PyCFunction)(void (*)(void))py_schemes_scene_ends_of, METH_FASTCALL, "schemes_scene_ends_of(scene, placed, body)\n--\n\nReturn the ends of a segment among the bodies in the world [m], (3,) each."},
    {"references_rotations_combined", (PyCFunction)(void (*)(void))py_references_rotations_combined, METH_FASTCALL, "references_rotations_combined(a, u, b, v)\n--\n\nCompute a u + b v."},
    {"schemes_step_seen_from", (PyCFunction)(void (*)(void))py_schemes_step_seen_from, METH_FASTCALL, "schemes_step_seen_from(placement, v)\n--\n\nTurn a vector (3,) of the world into the coordinates of a placement (12,)."},
    {"schemes_scene_nearest_parameter", (PyCFunction)(void (*)(void))py_schemes_scene_nearest_parameter, METH_FASTCALL, "schemes_scene_nearest_parameter(a, u, half)\n--\n\nCompute the s in [0, 1] of the point of a segment that is nearest to a box."},
    {"schemes_scene_beyond", (PyCFunction)(void (*)(void))py_schemes_scene_beyond, METH_FASTCALL, "schemes_scene_beyond(x, half)\n--\n\nReturn the way to a point from the nearest one of a box."},
    {"schemes_scene_depth", (PyCFunction)(void (*)(void))py_schemes_scene_depth, METH_FASTCALL, "schemes_scene_depth(x, half)\n--\n\nCompute how far a point is from leaving a box by its nearest face, negative inside."},
    {"schemes_step_axis_at", (PyCFunction)(void (*)(void))py_schemes_step_axis_at, METH_FASTCALL, "schemes_step_axis_at(placement, axis)\n--\n\nTurn a direction in a frame's own coordinates, by its placement (12,), into the world's."},
    {"references_rotations_scaled", (PyCFunction)(void (*)(void))py_references_rotations_scaled, METH_FASTCALL, "references_rotations_scaled(a, u)\n--\n\nCompute a u."},
    {"references_rotations_added", (PyCFunction)(void (*)(void))py_references_rotations_added, METH_FASTCALL, "references_rotations_added(u, v)\n--\n\nCompute u + v."},
    {"schemes_scene_second_order", (PyCFunction)(void (*)(void))py_schemes_scene_second_order, METH_FASTCALL, "schemes_scene_second_order(moves, radii, k, travel)\n--\n\nCompute B [m] for pair k, whose joints travel by `travel` (n,) [rad]."},
    {"control_stopping_along", (PyCFunction)(void (*)(void))py_control_stopping_along, METH_FASTCALL, "control_stopping_along(motion, jacobian, moves, k, point, normal)\n--\n\nCompute first velocity and b along a normal (3,) of a point (3,) of pair k's second body."},
    {"schemes_step_rate_along", (PyCFunction)(void (*)(void))py_schemes_step_rate_along, METH_FASTCALL, "schemes_step_rate_along(jacobian, j, point, normal)\n--\n\nCompute the velocity along a normal (3,) of a point (3,) [m] that joint j moves [m/rad]."},
    {"schemes_step_point_rate", (PyCFunction)(void (*)(void))py_schemes_step_point_rate, METH_FASTCALL, "schemes_step_point_rate(jacobian, j, point)\n--\n\nCompute the velocity (3,) of a point (3,) [m] that joint j moves [m/rad]."},
    {"references_rotations_cross", (PyCFunction)(void (*)(void))py_references_rotations_cross, METH_FASTCALL, "references_rotations_cross(u, v)\n--\n\nCompute the cross product u x v."},
    {"control_stopping_stopping_time", (PyCFunction)(void (*)(void))py_control_stopping_stopping_time, METH_FASTCALL, "control_stopping_stopping_time(arrays, past, yielding, dq)\n--\n\nCompute the periods of the motion to rest from a command."},
    {"networks_base_enter_rates", (PyCFunction)(void (*)(void))py_networks_base_enter_rates, METH_FASTCALL, "networks_base_enter_rates(address, qp, constants, state, rates)\n--\n\nEnter a network's function, `Rates`, of states (size,) and constants (k,), at an address."},
    {"integrators_base_answer_program", (PyCFunction)(void (*)(void))py_integrators_base_answer_program, METH_FASTCALL, "integrators_base_answer_program(data, sizes, address, rates, constants, state, point)\n--\n\nEnter the compiled answer at an address."},
    {"integrators_explicit_follow", (PyCFunction)(void (*)(void))py_integrators_explicit_follow, METH_FASTCALL, "integrators_explicit_follow(qp, rates, constants, state, point)\n--\n\nAdvance the network by its time with explicit steps; a compiled answer (`enter_answer`)."},
    {"networks_projection_stable_step", (PyCFunction)(void (*)(void))py_networks_projection_stable_step, METH_FASTCALL, "networks_projection_stable_step(qp, active)\n--\n\nCompute the bound of `ProjectionNetwork.stable_step` for an active set (p + m + 2n,)."},
    {"qp_dense_extreme_eigenvalues", (PyCFunction)(void (*)(void))py_qp_dense_extreme_eigenvalues, METH_FASTCALL, "qp_dense_extreme_eigenvalues(K)\n--\n\nCompute the smallest and the largest eigenvalue of K (n, n), which is overwritten."},
    {"qp_dense_rotate", (PyCFunction)(void (*)(void))py_qp_dense_rotate, METH_FASTCALL, "qp_dense_rotate(K, i, k)\n--\n\nMake the entries (i, k) and (k, i) of a symmetric matrix zero by a Jacobi rotation."},
    {"integrators_implicit_step_program", (PyCFunction)(void (*)(void))py_integrators_implicit_step_program, METH_FASTCALL, "integrators_implicit_step_program(data, n, m, p, s, step)\n--\n\nAdvance a state `s` (size,) in place by one backward Euler step of a program, `QP.data`."},
    {"networks_projection_projection_rates", (PyCFunction)(void (*)(void))py_networks_projection_projection_rates, METH_FASTCALL, "networks_projection_projection_rates(qp, constants, state, rates)\n--\n\nWrite the rates (size,); `constants` (1,) is [1] if x goes through its bounds, else [0]."},
    {"qp_dense_is_convex", (PyCFunction)(void (*)(void))py_qp_dense_is_convex, METH_FASTCALL, "qp_dense_is_convex(P, K)\n--\n\nCheck that P (n, n) is symmetric and positive semidefinite to `ROUNDING` of its scale."},
    {"qp_program_well_formed", (PyCFunction)(void (*)(void))py_qp_program_well_formed, METH_FASTCALL, "qp_program_well_formed(data, n, m, p)\n--\n\nCheck in one pass over the numbers that `QP.check_values` would find nothing."},
    {"qp_residuals_residuals_of", (PyCFunction)(void (*)(void))py_qp_residuals_residuals_of, METH_FASTCALL, "qp_residuals_residuals_of(data, n, m, p, point)\n--\n\nCompute `point_residuals` of a point (2n + m + p,), for a program's flat array, `QP.data`."},
    {"qp_residuals_point_of_state", (PyCFunction)(void (*)(void))py_qp_residuals_point_of_state, METH_FASTCALL, "qp_residuals_point_of_state(data, n, m, p, s, point)\n--\n\nWrite the `kkt_point` (2n + m + p,) of a state, for a program's flat array, `QP.data`."},
    {"references_rotations_coefficients", (PyCFunction)(void (*)(void))py_references_rotations_coefficients, METH_FASTCALL, "references_rotations_coefficients(square)\n--\n\nCompute a and b at a squared angle."},
    {"references_rotations_rotated", (PyCFunction)(void (*)(void))py_references_rotations_rotated, METH_FASTCALL, "references_rotations_rotated(vector, v)\n--\n\nCompute exp[vector] v."},
    {"references_rotations_left_jacobian", (PyCFunction)(void (*)(void))py_references_rotations_left_jacobian, METH_FASTCALL, "references_rotations_left_jacobian(vector, v)\n--\n\nCompute J(vector) v: the angular velocity of a rotation vector with the rate v."},
    {"references_rotations_column_of", (PyCFunction)(void (*)(void))py_references_rotations_column_of, METH_FASTCALL, "references_rotations_column_of(target, j)\n--\n\nReturn the j-th axis of a target's frame, of `Target.data` (18,)."},
    {"references_rotations_turn_target", (PyCFunction)(void (*)(void))py_references_rotations_turn_target, METH_FASTCALL, "references_rotations_turn_target(target, vector, rate)\n--\n\nTurn a target, `Target.data` (18,), by a rotation vector with a rate; its position stays."},
    {"references_shapes_heart_path", (PyCFunction)(void (*)(void))py_references_shapes_heart_path, METH_FASTCALL, "references_shapes_heart_path(t, constants, target)\n--\n\nMove a target along `Heart`; constants: scale [m], rate [rad/s]."},
    {"references_shapes_circle_path", (PyCFunction)(void (*)(void))py_references_shapes_circle_path, METH_FASTCALL, "references_shapes_circle_path(t, constants, target)\n--\n\nMove a target along `Circle`; constants: radius [m], rate [rad/s], two axes (3,)."},
    {"references_shapes_line_path", (PyCFunction)(void (*)(void))py_references_shapes_line_path, METH_FASTCALL, "references_shapes_line_path(t, constants, target)\n--\n\nMove a target along `Line`; constants: rate [rad/s], offset (3,) [m]."},
    {"references_shapes_lissajous_path", (PyCFunction)(void (*)(void))py_references_shapes_lissajous_path, METH_FASTCALL, "references_shapes_lissajous_path(t, constants, target)\n--\n\nMove a target along `Lissajous`; constants: amplitudes, rates and phases, (3,) each."},
    {"references_shapes_still_path", (PyCFunction)(void (*)(void))py_references_shapes_still_path, METH_FASTCALL, "references_shapes_still_path(t, constants, target)\n--\n\nLeave the target as it is."},
    {"references_turning_cone_path", (PyCFunction)(void (*)(void))py_references_turning_cone_path, METH_FASTCALL, "references_turning_cone_path(t, constants, target)\n--\n\nTurn a target along `Cone`; constants: angle [rad], rate [rad/s]."},
    {"references_turning_tilting_path", (PyCFunction)(void (*)(void))py_references_turning_tilting_path, METH_FASTCALL, "references_turning_tilting_path(t, constants, target)\n--\n\nMove a target along `Tilting`; constants: number of the path, angle, rate, axis (3,)."},
    {"references_waypoints_waypoints_path", (PyCFunction)(void (*)(void))py_references_waypoints_waypoints_path, METH_FASTCALL, "references_waypoints_waypoints_path(t, constants, target)\n--\n\nMove a target along `Waypoints`, see the comment above for the constants (c,)."},
    {"references_waypoints_piece", (PyCFunction)(void (*)(void))py_references_waypoints_piece, METH_FASTCALL, "references_waypoints_piece(t, constants)\n--\n\nFind the piece at a time, the time since it began, and 0.0 if the path is at rest, or 1.0."},
    {"references_waypoints_cubic", (PyCFunction)(void (*)(void))py_references_waypoints_cubic, METH_FASTCALL, "references_waypoints_cubic(constants, at, x)\n--\n\nCompute a x^3 + b x^2 + c x of coefficients (3, 3)."},
    {"references_waypoints_triple", (PyCFunction)(void (*)(void))py_references_waypoints_triple, METH_FASTCALL, "references_waypoints_triple(constants, at)\n--\n\n"},
    {"references_waypoints_slope", (PyCFunction)(void (*)(void))py_references_waypoints_slope, METH_FASTCALL, "references_waypoints_slope(constants, at, x)\n--\n\nCompute the derivative of `_cubic` by x."},
    {"robot_kinematics_kernel_write_kinematics", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_write_kinematics, METH_FASTCALL, "robot_kinematics_kernel_write_kinematics(model, q, jacobian, placements, inertia)\n--\n\nWrite the kinematics at joint positions q (n,) [rad or m], as `Kinematics` holds them."},
    {"robot_kinematics_kernel_compose", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_compose, METH_FASTCALL, "robot_kinematics_kernel_compose(first, second, product)\n--\n\nWrite the product (12,) of two placements (12,)."},
    {"robot_kinematics_kernel_write_twist", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_write_twist, METH_FASTCALL, "robot_kinematics_kernel_write_twist(placement, kind, twist)\n--\n\nWrite a joint's twist (6,) about the world's origin from its placement (12,), kind (2,)."},
    {"robot_kinematics_kernel_write_inertia", (PyCFunction)(void (*)(void))py_robot_kinematics_kernel_write_inertia, METH_FASTCALL, "robot_kinematics_kernel_write_inertia(model, placed, jacobian, inertia)\n--\n\nWrite the inertia matrix (n, n) out of the joints' placements (n + 1, 12) and twists (n, 6)."},
    {"schemes_collisions_collision_rows", (PyCFunction)(void (*)(void))py_schemes_collisions_collision_rows, METH_FASTCALL, "schemes_collisions_collision_rows(step, constants, G, h, lb, ub)\n--\n\nWrite the rows of the pairs that are nearest to being active."},
    {"schemes_collisions_write_gradient", (PyCFunction)(void (*)(void))py_schemes_collisions_write_gradient, METH_FASTCALL, "schemes_collisions_write_gradient(moves, contact, jacobian, dq_max, k, gradients)\n--\n\nWrite row k of the gradients (pairs, n): the rate at which a pair's distance shrinks."},
    {"schemes_collisions_rank", (PyCFunction)(void (*)(void))py_schemes_collisions_rank, METH_FASTCALL, "schemes_collisions_rank(slacks, k)\n--\n\nCount the pairs that are nearer to being active than a pair, by their slacks (pairs,)."},
    {"schemes_costs_add_kinetic_energy", (PyCFunction)(void (*)(void))py_schemes_costs_add_kinetic_energy, METH_FASTCALL, "schemes_costs_add_kinetic_energy(step, constants, P, q)\n--\n\nAdd w G(q) to P; the constants are those of `KineticEnergy`."},
    {"schemes_costs_add_cyclic_motion", (PyCFunction)(void (*)(void))py_schemes_costs_add_cyclic_motion, METH_FASTCALL, "schemes_costs_add_cyclic_motion(step, constants, P, q)\n--\n\nAdd w I to P and w m (q - home) to the linear term; constants of `CyclicMotion`."},
    {"schemes_limits_joint_limits", (PyCFunction)(void (*)(void))py_schemes_limits_joint_limits, METH_FASTCALL, "schemes_limits_joint_limits(step, constants, G, h, lb, ub)\n--\n\nTighten the bounds to those of `JointLimits`, whose constants these are."},
    {"schemes_limits_ramp_speed", (PyCFunction)(void (*)(void))py_schemes_limits_ramp_speed, METH_FASTCALL, "schemes_limits_ramp_speed(distance, offset, deceleration)\n--\n\nCompute the speed that a ramp allows at a distance from a position limit [rad/s]."},
    {"schemes_limits_motion_limits", (PyCFunction)(void (*)(void))py_schemes_limits_motion_limits, METH_FASTCALL, "schemes_limits_motion_limits(step, constants, G, h, lb, ub)\n--\n\nPut the bounds of the joints inside those of `MotionLimits`, whose constants these are."},
    {"schemes_limits_tip_speed_bounds", (PyCFunction)(void (*)(void))py_schemes_limits_tip_speed_bounds, METH_FASTCALL, "schemes_limits_tip_speed_bounds(step, constants, G, h, lb, ub)\n--\n\nTighten the bounds to those of `TipSpeedLimit`, whose constants these are."},
    {"schemes_parts_copy_cost", (PyCFunction)(void (*)(void))py_schemes_parts_copy_cost, METH_FASTCALL, "schemes_parts_copy_cost(step, constants, P, q)\n--\n\nAdd P and q from the constants."},
    {"schemes_parts_copy_task", (PyCFunction)(void (*)(void))py_schemes_parts_copy_task, METH_FASTCALL, "schemes_parts_copy_task(step, constants, target, A, b)\n--\n\nWrite A and b from the constants."},
    {"schemes_parts_copy_limit", (PyCFunction)(void (*)(void))py_schemes_parts_copy_limit, METH_FASTCALL, "schemes_parts_copy_limit(step, constants, G, h, lb, ub)\n--\n\nWrite G and h, and tighten lb and ub, from the constants."},
    {"schemes_scene_move_centers", (PyCFunction)(void (*)(void))py_schemes_scene_move_centers, METH_FASTCALL, "schemes_scene_move_centers(constants, centers, t)\n--\n\nWrite the centres of moving obstacles at time t [s] into the constants (k,)."},
    {"schemes_scene_write_distances", (PyCFunction)(void (*)(void))py_schemes_scene_write_distances, METH_FASTCALL, "schemes_scene_write_distances(constants, dof, placements, distances)\n--\n\nWrite the distance of each pair [m]."},
    {"schemes_step_write_velocity", (PyCFunction)(void (*)(void))py_schemes_step_write_velocity, METH_FASTCALL, "schemes_step_write_velocity(step, constants, point, axis, row)\n--\n\nWrite the velocity along an axis of a frame's point as seen from its base, a row (n,)."},
    {"schemes_step_write_spin", (PyCFunction)(void (*)(void))py_schemes_step_write_spin, METH_FASTCALL, "schemes_step_write_spin(step, constants, axis, row)\n--\n\nWrite the angular velocity about an axis of a frame as seen from its base, a row (n,)."},
    {"schemes_tasks_position_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_position_rows, METH_FASTCALL, "schemes_tasks_position_rows(step, constants, target, A, b)\n--\n\nWrite the rows of a frame's position as seen from its base, three."},
    {"schemes_tasks_rotation_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_rotation_rows, METH_FASTCALL, "schemes_tasks_rotation_rows(step, constants, target, A, b)\n--\n\nWrite the rows of a frame's orientation as seen from its base, three."},
    {"schemes_tasks_block_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_block_rows, METH_FASTCALL, "schemes_tasks_block_rows(step, constants, target, A, b)\n--\n\nWrite the rows of `OrientationTask` in the form ``block``, four."},
    {"schemes_tasks_project_on_range", (PyCFunction)(void (*)(void))py_schemes_tasks_project_on_range, METH_FASTCALL, "schemes_tasks_project_on_range(placement, b)\n--\n\nReplace b (4,) by its projection on the range of W of a frame's placement (12,)."},
    {"schemes_tasks_pose_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_pose_rows, METH_FASTCALL, "schemes_tasks_pose_rows(step, constants, target, A, b)\n--\n\nWrite the rows of a frame's position and orientation as seen from its base, six."},
    {"schemes_tasks_held_pose_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_held_pose_rows, METH_FASTCALL, "schemes_tasks_held_pose_rows(step, constants, target, A, b)\n--\n\nWrite the rows of a pose that is among the constants, six."},
    {"schemes_tasks_axis_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_axis_rows, METH_FASTCALL, "schemes_tasks_axis_rows(step, constants, target, A, b)\n--\n\nWrite the rows of `AxisTask`, two."},
    {"schemes_tasks_remote_center_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_remote_center_rows, METH_FASTCALL, "schemes_tasks_remote_center_rows(step, constants, target, A, b)\n--\n\nWrite the rows of `RemoteCenterTask`, two."},
    {"schemes_tasks_joint_rows", (PyCFunction)(void (*)(void))py_schemes_tasks_joint_rows, METH_FASTCALL, "schemes_tasks_joint_rows(step, constants, target, A, b)\n--\n\nWrite the rows of a task of joints: its constants are gain, C (rows, dof) and c (rows,)."},
    {NULL, NULL, 0, NULL}
};
static const struct kernel kernels[] = {
    {"control_command_row_ends", (void *)control_command_row_ends, "iiii:(iiiiiiiii)"},
    {"control_command_row_views", (void *)control_command_row_views, "viiii:<vvvvmvvmvm>"},
    {"control_relaxed_copied", (void *)control_relaxed_copied, "vv:n"},
    {"control_relaxed_largest_entry", (void *)control_relaxed_largest_entry, "v:d"},
    {"control_relaxed_settled", (void *)control_relaxed_settled, "<mvmvmvvv><vvvMdibb>vvvd:b"},
    {"integrators_implicit_settle", (void *)integrators_implicit_settle, "<mvmvmvvv>ivvv:(ddddd)"},
    {"networks_projection_field", (void *)networks_projection_field, "<mvmvmvvv>vv:d"},
    {"qp_dense_times", (void *)qp_dense_times, "mvv:n"},
    {"qp_dense_row_dot", (void *)qp_dense_row_dot, "miv:d"},
    {"networks_projection_add_transposed", (void *)networks_projection_add_transposed, "<mvmvmvvv>dvv:n"},
    {"qp_dense_add_row", (void *)qp_dense_add_row, "vdmi:n"},
    {"networks_projection_write_slacks", (void *)networks_projection_write_slacks, "<mvmvmvvv>vv:n"},
    {"networks_projection_rows_times", (void *)networks_projection_rows_times, "<mvmvmvvv>vv:n"},
    {"qp_layout_larger", (void *)qp_layout_larger, "dd:d"},
    {"qp_residuals_kkt_point", (void *)qp_residuals_kkt_point, "<mvmvmvvv>vv:(ddd)"},
    {"qp_residuals_point_residuals", (void *)qp_residuals_point_residuals, "<mvmvmvvv>v:(ddd)"},
    {"qp_residuals_within", (void *)qp_residuals_within, "dddd:b"},
    {"networks_projection_mark_active", (void *)networks_projection_mark_active, "<mvmvmvvv>vvv:n"},
    {"integrators_implicit_steps_linear_step", (void *)integrators_implicit_steps_linear_step, "<mvmvmvvv>vvd<vvmmv>v:b"},
    {"integrators_implicit_steps_build_condensed", (void *)integrators_implicit_steps_build_condensed, "<mvmvmvvv>d<vvmmv>:n"},
    {"integrators_implicit_steps_count_rows", (void *)integrators_implicit_steps_count_rows, "<vvmmv>mi:n"},
    {"qp_dense_add_outer", (void *)qp_dense_add_outer, "mdmi:n"},
    {"qp_dense_cholesky_factor", (void *)qp_dense_cholesky_factor, "m:b"},
    {"qp_dense_factor_solve", (void *)qp_dense_factor_solve, "mvv:n"},
    {"integrators_implicit_steps_copy_into", (void *)integrators_implicit_steps_copy_into, "vv:n"},
    {"integrators_implicit_steps_backward_euler", (void *)integrators_implicit_steps_backward_euler, "<mvmvmvvv>vdvdi<vvmmv>:i"},
    {"integrators_implicit_steps_multipliers", (void *)integrators_implicit_steps_multipliers, "<mvmvmvvv>vdvvv:n"},
    {"integrators_implicit_steps_descent", (void *)integrators_implicit_steps_descent, "<mvmvmvvv>vdvv:d"},
    {"integrators_implicit_steps_line_search", (void *)integrators_implicit_steps_line_search, "<mvmvmvvv>vdvvvv:d"},
    {"integrators_implicit_steps_slope", (void *)integrators_implicit_steps_slope, "iivdvvd:(dd)"},
    {"control_relaxed_largest_factor", (void *)control_relaxed_largest_factor, "<mvmvmvvv><vvvMdibb>vvvb:d"},
    {"control_relaxed_data_size", (void *)control_relaxed_data_size, "iii:i"},
    {"qp_layout_qp_views", (void *)qp_layout_qp_views, "viii:<mvmvmvvv>"},
    {"qp_layout_offsets", (void *)qp_layout_offsets, "iii:(iiii)"},
    {"control_relaxed_copy_cost", (void *)control_relaxed_copy_cost, "<mvmvmvvv><mvmvmvvv>:n"},
    {"control_relaxed_copy_limits", (void *)control_relaxed_copy_limits, "<mvmvmvvv><mvmvmvvv>:n"},
    {"control_relaxed_scale_task", (void *)control_relaxed_scale_task, "<mvmvmvvv>vd:n"},
    {"control_relaxed_soften_task", (void *)control_relaxed_soften_task, "<mvmvmvvv>vd:n"},
    {"control_relaxed_move_into_cost", (void *)control_relaxed_move_into_cost, "<mvmvmvvv>idd:n"},
    {"control_relaxed_note_blocking", (void *)control_relaxed_note_blocking, "viiiv:n"},
    {"control_relaxed_nearest_within", (void *)control_relaxed_nearest_within, "<mvmvmvvv>v<vvvMdibb>v:b"},
    {"control_relaxed_attained", (void *)control_relaxed_attained, "vmvv:d"},
    {"control_shield_wished_velocity", (void *)control_shield_wished_velocity, "<ddvvvmmmmm>vvmv:n"},
    {"control_shield_take_positions", (void *)control_shield_take_positions, "v<vvv>v:n"},
    {"control_shield_take_wish", (void *)control_shield_take_wish, "vb<vvv>v:b"},
    {"qp_dense_all_finite", (void *)qp_dense_all_finite, "vii:b"},
    {"control_shield_approach", (void *)control_shield_approach, "<vvv>mvdbbv:n"},
    {"schemes_limits_joint_bounds", (void *)schemes_limits_joint_bounds, "dddd(dddd)d:(dd)"},
    {"schemes_limits_jerk_bounds", (void *)schemes_limits_jerk_bounds, "dddd(dddd)d:(dd)"},
    {"schemes_limits_approach", (void *)schemes_limits_approach, "d:d"},
    {"schemes_limits_ceiling", (void *)schemes_limits_ceiling, "ddddd(dd):d"},
    {"schemes_limits_highest", (void *)schemes_limits_highest, "ddddd:d"},
    {"schemes_limits_stopping_distance", (void *)schemes_limits_stopping_distance, "dddd:d"},
    {"schemes_limits_easing", (void *)schemes_limits_easing, "dd:d"},
    {"schemes_limits_acceleration_bounds", (void *)schemes_limits_acceleration_bounds, "ddd(dddd)d:(dd)"},
    {"schemes_limits_braking", (void *)schemes_limits_braking, "ddddd:d"},
    {"control_step_take_step", (void *)control_step_take_step, "v<<Mvmmmmd><vvvMdibb>ib>mmvvdb:i"},
    {"control_step_sample_targets", (void *)control_step_sample_targets, "<Mvmmmmd>dm:n"},
    {"references_base_enter_path", NULL, "idvv:n"},
    {"references_rotations_set_mean_twist", (void *)references_rotations_set_mean_twist, "vvd:n"},
    {"references_rotations_dot", (void *)references_rotations_dot, "(ddd)(ddd):d"},
    {"references_rotations_row_of", (void *)references_rotations_row_of, "vi:(ddd)"},
    {"references_rotations_rotation_log", (void *)references_rotations_rotation_log, "mv:n"},
    {"schemes_program_assemble", (void *)schemes_program_assemble, "v<Mvmmmmd>mmd:n"},
    {"schemes_parts_enter_cost", NULL, "i<ddvvvmmmmm>vmv:n"},
    {"schemes_parts_enter_task", NULL, "i<ddvvvmmmmm>vvmv:n"},
    {"schemes_program_add_soft", (void *)schemes_program_add_soft, "<mvmvmvvv>mvd:n"},
    {"schemes_parts_enter_limit", NULL, "i<ddvvvmmmmm>vmvvv:n"},
    {"control_step_note_instant", (void *)control_step_note_instant, "<vvvvmvvmvm><Mvmmmmd>m:n"},
    {"control_step_answer", (void *)control_step_answer, "<vvvvmvvmvm><Mvmmmmd>v:b"},
    {"integrators_base_enter_answer", NULL, "i<mvmvmvvv>ivvv:(ddddd)"},
    {"control_step_status_of", (void *)control_step_status_of, "dddvv:i"},
    {"control_yielding_guard_step", (void *)control_yielding_guard_step, "<Mvmmmmd>mm<vvvMdibb>:b"},
    {"control_yielding_periods_to_rest", (void *)control_yielding_periods_to_rest, "<Mvmmmmd>m<vvvMdibb>v:d"},
    {"control_stopping_enter_stopping_time", NULL, "i<Mvmmmmd>m<vvvMdibb>v:d"},
    {"control_yielding_yield_step", (void *)control_yielding_yield_step, "<vvvvmvvmvm><Mvmmmmd>mmv<vvvMdibb>vi:i"},
    {"control_yielding_widen_bounds", (void *)control_yielding_widen_bounds, "<mvmvmvvv>vv:n"},
    {"control_yielding_answer_relaxed", (void *)control_yielding_answer_relaxed, "<vvvvmvvmvm><mvmvmvvv><vvvMdibb>vvi:(dd)"},
    {"control_yielding_is_path", (void *)control_yielding_is_path, "m:b"},
    {"control_yielding_races", (void *)control_yielding_races, "<mvmvmvvv>v:b"},
    {"control_yielding_step", (void *)control_yielding_step, "<mvmvmvvv>mm<vvvMdibb>vv:n"},
    {"control_yielding_step_straight", (void *)control_yielding_step_straight, "m<vvvMdibb>v:n"},
    {"control_stopping_least_periods", (void *)control_stopping_least_periods, "vvvdb:d"},
    {"control_stopping_within_rates", (void *)control_stopping_within_rates, "ddddd:b"},
    {"control_stopping_bend_of", (void *)control_stopping_bend_of, "ddd:d"},
    {"control_stopping_next_velocity", (void *)control_stopping_next_velocity, "dddb:d"},
    {"control_stopping_velocity_at", (void *)control_stopping_velocity_at, "dddb:d"},
    {"control_yielding_step_towards", (void *)control_yielding_step_towards, "<mvmvmvvv>m<vvvMdibb>v:n"},
    {"control_yielding_make_stoppable", (void *)control_yielding_make_stoppable, "<mvmvmvvv><Mvmmmmd>m<vvvMdibb><vvvvmvvmvm>v:d"},
    {"control_yielding_brake", (void *)control_yielding_brake, "<mvmvmvvv>m<vvvMdibb>v:d"},
    {"control_yielding_go_away", (void *)control_yielding_go_away, "<mvmvmvvv>vv:b"},
    {"control_yielding_note_missing", (void *)control_yielding_note_missing, "<vvvvmvvmvm>v:i"},
    {"control_yielding_note_decision", (void *)control_yielding_note_decision, "<vvvvmvvmvm><mvmvmvvv>vvidi:n"},
    {"control_stopping_way_along", (void *)control_stopping_way_along, "<vvdb>dddd:d"},
    {"control_stopping_least_way", (void *)control_stopping_least_way, "<vvdb>ddd:d"},
    {"control_stopping_is_straight", (void *)control_stopping_is_straight, "<vvdb>:b"},
    {"control_stopping_keeps_joint_limits", (void *)control_stopping_keeps_joint_limits, "<vvdb>vvd:b"},
    {"control_stopping_keeps_ramp", (void *)control_stopping_keeps_ramp, "<vvdb>vvdi:b"},
    {"control_stopping_keeps_distances", (void *)control_stopping_keeps_distances, "<vvdb><Mvmmmmd>vd:b"},
    {"schemes_scene_scene_views", (void *)schemes_scene_scene_views, "vi:<ddvmmmm>"},
    {"schemes_scene_place_bodies", (void *)schemes_scene_place_bodies, "<ddvmmmm>mm:n"},
    {"schemes_scene_contact_of", (void *)schemes_scene_contact_of, "<ddvmmmm>im:<(ddd)(ddd)(ddd)d>"},
    {"schemes_step_vector_at", (void *)schemes_step_vector_at, "vi:(ddd)"},
    {"schemes_scene_ends_of", (void *)schemes_scene_ends_of, "<ddvmmmm>mi:((ddd)(ddd))"},
    {"references_rotations_combined", (void *)references_rotations_combined, "d(ddd)d(ddd):(ddd)"},
    {"schemes_step_seen_from", (void *)schemes_step_seen_from, "v(ddd):(ddd)"},
    {"schemes_scene_nearest_parameter", (void *)schemes_scene_nearest_parameter, "(ddd)(ddd)(ddd):d"},
    {"schemes_scene_beyond", (void *)schemes_scene_beyond, "(ddd)(ddd):(ddd)"},
    {"schemes_scene_depth", (void *)schemes_scene_depth, "(ddd)(ddd):(dddd)"},
    {"schemes_step_axis_at", (void *)schemes_step_axis_at, "v(ddd):(ddd)"},
    {"references_rotations_scaled", (void *)references_rotations_scaled, "d(ddd):(ddd)"},
    {"references_rotations_added", (void *)references_rotations_added, "(ddd)(ddd):(ddd)"},
    {"schemes_scene_second_order", (void *)schemes_scene_second_order, "mmiv:d"},
    {"control_stopping_along", (void *)control_stopping_along, "<vvdb>mmi(ddd)(ddd):(dd)"},
    {"schemes_step_rate_along", (void *)schemes_step_rate_along, "mi(ddd)(ddd):d"},
    {"schemes_step_point_rate", (void *)schemes_step_point_rate, "mi(ddd):(ddd)"},
    {"references_rotations_cross", (void *)references_rotations_cross, "(ddd)(ddd):(ddd)"},
    {"control_stopping_stopping_time", (void *)control_stopping_stopping_time, "<Mvmmmmd>m<vvvMdibb>v:d"},
    {"networks_base_enter_rates", NULL, "i<mvmvmvvv>vvv:n"},
    {"integrators_base_answer_program", (void *)integrators_base_answer_program, "v(iii)iivvv:(ddddd)"},
    {"integrators_explicit_follow", (void *)integrators_explicit_follow, "<mvmvmvvv>ivvv:(ddddd)"},
    {"networks_projection_stable_step", (void *)networks_projection_stable_step, "<mvmvmvvv>v:d"},
    {"qp_dense_extreme_eigenvalues", (void *)qp_dense_extreme_eigenvalues, "m:(dd)"},
    {"qp_dense_rotate", (void *)qp_dense_rotate, "mii:n"},
    {"integrators_implicit_step_program", (void *)integrators_implicit_step_program, "viiivd:i"},
    {"networks_projection_projection_rates", (void *)networks_projection_projection_rates, "<mvmvmvvv>vvv:n"},
    {"qp_dense_is_convex", (void *)qp_dense_is_convex, "mm:b"},
    {"qp_program_well_formed", (void *)qp_program_well_formed, "viii:b"},
    {"qp_residuals_residuals_of", (void *)qp_residuals_residuals_of, "viiiv:(ddd)"},
    {"qp_residuals_point_of_state", (void *)qp_residuals_point_of_state, "viiivv:(ddd)"},
    {"references_rotations_coefficients", (void *)references_rotations_coefficients, "d:(dd)"},
    {"references_rotations_rotated", (void *)references_rotations_rotated, "(ddd)(ddd):(ddd)"},
    {"references_rotations_left_jacobian", (void *)references_rotations_left_jacobian, "(ddd)(ddd):(ddd)"},
    {"references_rotations_column_of", (void *)references_rotations_column_of, "vi:(ddd)"},
    {"references_rotations_turn_target", (void *)references_rotations_turn_target, "v(ddd)(ddd):n"},
    {"references_shapes_heart_path", (void *)references_shapes_heart_path, "dvv:n"},
    {"references_shapes_circle_path", (void *)references_shapes_circle_path, "dvv:n"},
    {"references_shapes_line_path", (void *)references_shapes_line_path, "dvv:n"},
    {"references_shapes_lissajous_path", (void *)references_shapes_lissajous_path, "dvv:n"},
    {"references_shapes_still_path", (void *)references_shapes_still_path, "dvv:n"},
    {"references_turning_cone_path", (void *)references_turning_cone_path, "dvv:n"},
    {"references_turning_tilting_path", (void *)references_turning_tilting_path, "dvv:n"},
    {"references_waypoints_waypoints_path", (void *)references_waypoints_waypoints_path, "dvv:n"},
    {"references_waypoints_piece", (void *)references_waypoints_piece, "dv:(ddd)"},
    {"references_waypoints_cubic", (void *)references_waypoints_cubic, "vid:(ddd)"},
    {"references_waypoints_triple", (void *)references_waypoints_triple, "vi:(ddd)"},
    {"references_waypoints_slope", (void *)references_waypoints_slope, "vid:(ddd)"},
    {"robot_kinematics_kernel_write_kinematics", (void *)robot_kinematics_kernel_write_kinematics, "<VmmMmmmv>vmmm:n"},
    {"robot_kinematics_kernel_compose", (void *)robot_kinematics_kernel_compose, "vvv:n"},
    {"robot_kinematics_kernel_write_twist", (void *)robot_kinematics_kernel_write_twist, "vvv:n"},
    {"robot_kinematics_kernel_write_inertia", (void *)robot_kinematics_kernel_write_inertia, "<VmmMmmmv>mmm:n"},
    {"schemes_collisions_collision_rows", (void *)schemes_collisions_collision_rows, "<ddvvvmmmmm>vmvvv:n"},
    {"schemes_collisions_write_gradient", (void *)schemes_collisions_write_gradient, "m<(ddd)(ddd)(ddd)d>mvim:d"},
    {"schemes_collisions_rank", (void *)schemes_collisions_rank, "vi:i"},
    {"schemes_costs_add_kinetic_energy", (void *)schemes_costs_add_kinetic_energy, "<ddvvvmmmmm>vmv:n"},
    {"schemes_costs_add_cyclic_motion", (void *)schemes_costs_add_cyclic_motion, "<ddvvvmmmmm>vmv:n"},
    {"schemes_limits_joint_limits", (void *)schemes_limits_joint_limits, "<ddvvvmmmmm>vmvvv:n"},
    {"schemes_limits_ramp_speed", (void *)schemes_limits_ramp_speed, "ddd:d"},
    {"schemes_limits_motion_limits", (void *)schemes_limits_motion_limits, "<ddvvvmmmmm>vmvvv:n"},
    {"schemes_limits_tip_speed_bounds", (void *)schemes_limits_tip_speed_bounds, "<ddvvvmmmmm>vmvvv:n"},
    {"schemes_parts_copy_cost", (void *)schemes_parts_copy_cost, "<ddvvvmmmmm>vmv:n"},
    {"schemes_parts_copy_task", (void *)schemes_parts_copy_task, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_parts_copy_limit", (void *)schemes_parts_copy_limit, "<ddvvvmmmmm>vmvvv:n"},
    {"schemes_scene_move_centers", (void *)schemes_scene_move_centers, "vmd:n"},
    {"schemes_scene_write_distances", (void *)schemes_scene_write_distances, "vimv:n"},
    {"schemes_step_write_velocity", (void *)schemes_step_write_velocity, "<ddvvvmmmmm>v(ddd)(ddd)v:n"},
    {"schemes_step_write_spin", (void *)schemes_step_write_spin, "<ddvvvmmmmm>v(ddd)v:n"},
    {"schemes_tasks_position_rows", (void *)schemes_tasks_position_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_rotation_rows", (void *)schemes_tasks_rotation_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_block_rows", (void *)schemes_tasks_block_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_project_on_range", (void *)schemes_tasks_project_on_range, "vv:n"},
    {"schemes_tasks_pose_rows", (void *)schemes_tasks_pose_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_held_pose_rows", (void *)schemes_tasks_held_pose_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_axis_rows", (void *)schemes_tasks_axis_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_remote_center_rows", (void *)schemes_tasks_remote_center_rows, "<ddvvvmmmmm>vvmv:n"},
    {"schemes_tasks_joint_rows", (void *)schemes_tasks_joint_rows, "<ddvvvmmmmm>vvmv:n"},
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
    PyModuleDef_HEAD_INIT, "iiwa_dnn._kernels", "The package's kernels.", -1, methods,
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

