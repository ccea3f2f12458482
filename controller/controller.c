/* Velocity controller of the robot iiwa7, made by iiwa_dnn 0.1.0 from its own kernels.
 *
 * C99 and libm's elementary functions alone. Every function states the file that it is translated
 * from. Programs have 7 variables, 0 inequality rows, 6 equality rows.
 */
#include "controller.h"

/* What kernels share: arrays, Python's arithmetic, and what a kernel does with its arena. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct { double *data; ptrdiff_t size0; } Vector;
typedef struct { double *data; ptrdiff_t size0, size1; } Matrix;
typedef struct { double *data; ptrdiff_t size0, size1, size2; } Cube;
typedef struct { ptrdiff_t *data; ptrdiff_t size0; } IntVector;
typedef struct { ptrdiff_t *data; ptrdiff_t size0, size1; } IntMatrix;

/* min and max return the first of equal numbers, and the first beside a NaN, as Python's do.
 * Quotient and remainder are rounded down. */

static inline double double_min(double a, double b) { return b < a ? b : a; }

static inline double double_max(double a, double b) { return b > a ? b : a; }

static inline ptrdiff_t int_min(ptrdiff_t a, ptrdiff_t b) { return b < a ? b : a; }

static inline ptrdiff_t int_quotient(ptrdiff_t a, ptrdiff_t b)
{
    return a / b - (a % b != 0 && (a < 0) != (b < 0));
}

static inline ptrdiff_t int_remainder(ptrdiff_t a, ptrdiff_t b)
{
    return a % b + ((a % b != 0 && (a < 0) != (b < 0)) ? b : 0);
}

struct arena;
static inline void *arena_empty(struct arena *arena, ptrdiff_t count);

static inline void *arena_zeros(struct arena *arena, ptrdiff_t count)
{
    return memset(arena_empty(arena, count), 0, 8 * (size_t)count);
}

static inline void *arena_copy(struct arena *arena, const void *from, ptrdiff_t count)
{
    return memcpy(arena_empty(arena, count), from, 8 * (size_t)count);
}


/* What kernels need for themselves stands in the controller. If it ever were too little, no memory
 * but this would be written, and the step would be refused. */
struct arena { char *top, *start, *end; bool *full; };

static inline void *arena_empty(struct arena *arena, ptrdiff_t count)
{
    const ptrdiff_t bytes = 8 * count;
    char *taken = arena->top;
    if (arena->end - taken < bytes) {
        *arena->full = true;
        taken = arena->start;
    }
    arena->top = taken + bytes;
    return taken;
}

static inline struct arena controller_arena(struct controller *c, bool *full)
{
    char *start = (char *)c->scratch;
    const struct arena arena = {start, start, start + sizeof c->scratch, full};
    return arena;
}

static inline void arena_leave(struct arena *arena, const struct arena *mark)
{
    arena->top = mark->top;
}


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
typedef struct { double at[3]; } double_3;
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
typedef struct { double at[5]; } double_5;
/* Condensed matrix of a program with R = p + m + 2n rows [A; G; I; -I], and scratch. */
typedef struct {
    Vector active;
    Vector counted;
    Matrix gram;
    Matrix K;
    Vector values;
} implicit_steps_Condensed;
typedef struct { double at[2]; } double_2;
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
/* Constants with which the relaxed programs of a scheme are written and answered. */
typedef struct {
    Vector weights;
    Vector limits;
    Vector settings;
    IntMatrix scenes;
    double dt;
    ptrdiff_t stop;
    bool cubic;
    bool coupled;
} relaxed_Yielding;
/* Layout of a control step. */
typedef struct {
    program_ProgramArrays arrays;
    relaxed_Yielding yielding;
    ptrdiff_t policy;
    bool shares_state;
} step_StepPlan;
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
typedef struct { ptrdiff_t at[9]; } int_9;
typedef struct { ptrdiff_t at[4]; } int_4;
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
static const ptrdiff_t table_table[] = {7, 0, 6, 7, 5, 17, 0, 0, 1, 0, 0, 0, 2, 0, 0, 2, 0, 0, 2, 11, 0, 1, 3, 0, 3, 11, 14, 0, 1, 4, 3, 3, 14, 17, 0, 3, 5, 0, 0, 17, 53, 0, 0, 6, 0, 0, 53, 58, 0, 0, 7, 0, 0, 58, 78, 0};
static const double table_constants[] = {0.2, 0.0, 0.8, 10.2, -2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0, 17.0, 10.2, 0.0, 17.0, 10.2, 0.0, 20.0, -2.9670597283903604, -2.0943951023931953, -2.9670597283903604, -2.0943951023931953, -2.9670597283903604, -2.0943951023931953, -3.0543261909900767, 2.9670597283903604, 2.0943951023931953, 2.9670597283903604, 2.0943951023931953, 2.9670597283903604, 2.0943951023931953, 3.0543261909900767, 1.710422666954443, 1.710422666954443, 1.7453292519943295, 2.2689280275926285, 2.443460952792061, 3.141592653589793, 3.141592653589793, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, 1e-09, 1000.0, 0.0, 0.0, 1.0, 0.37314465933828456, 0.3887169064348377, 0.30120610113710655, 0.6852638097061545, 0.7179818655642182, 0.12212924231293693, 0.7026803364948753, -0.6958825750471477, 0.14828279215471996, 0.19145196737160058, -0.01579501398149058, -0.9813748833768207, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.00345, 0.6283185307179586};
static const double table_moves[] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
static const double table_weights[] = {1.0, 1.0, 1.0, 0.5, 0.5, 0.5};
static const double table_settings[] = {1e-09, 60.0};
static const ptrdiff_t table_parents[] = {0, 1, 2, 3, 4, 5, 6};
static const double table_joints[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.1475, 1.0, 0.0, 0.0, 0.0, 2.220446049250313e-16, -1.0, 0.0, 1.0, 2.220446049250313e-16, 0.0, 0.0, 0.1925, 1.0, 0.0, 0.0, 0.0, 2.220446049250313e-16, 1.0, 0.0, -1.0, 2.220446049250313e-16, 0.0, -0.2075, 4.6074255521943994e-17, 1.0, 0.0, 0.0, 0.0, 2.220446049250313e-16, 1.0, 0.0, -1.0, 2.220446049250313e-16, 0.0, 0.0, 0.1925, 1.0, 0.0, 0.0, 0.0, 2.220446049250313e-16, -1.0, 0.0, 1.0, 2.220446049250313e-16, 0.0, 0.2075, 4.6074255521943994e-17, 1.0, 0.0, 0.0, 0.0, 2.220446049250313e-16, -1.0, 0.0, 1.0, 2.220446049250313e-16, 0.0, 0.0, 0.1925, 1.0, 0.0, 0.0, 0.0, 2.220446049250313e-16, 1.0, 0.0, -1.0, 2.220446049250313e-16, 0.0, -0.091, 2.020605904817785e-17};
static const double table_kinds[] = {0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0};
static const ptrdiff_t table_frames[] = {17, 7, 0, 0};
static const double table_offsets[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.035, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
static const double table_armature[] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
static const double yielding_TOWARDS[] = {1.0, 0.5, 0.25, 0.125};
static const ptrdiff_t kinematics_kernel_CYCLE[] = {0, 1, 2, 0, 1};
static void schemes_costs_add_kinetic_energy(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_costs_add_cyclic_motion(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_tasks_position_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static double_3 schemes_step_vector_at(struct arena *arena, Vector array, ptrdiff_t start);
static double_3 references_rotations_combined(struct arena *arena, double a, double_3 u, double b, double_3 v);
static double references_rotations_dot(struct arena *arena, double_3 u, double_3 v);
static void schemes_step_write_velocity(struct arena *arena, const step_StepViews *step, Vector constants, double_3 point, double_3 axis, Vector row);
static double schemes_step_rate_along(struct arena *arena, Matrix jacobian, ptrdiff_t j, double_3 point, double_3 normal);
static double_3 schemes_step_point_rate(struct arena *arena, Matrix jacobian, ptrdiff_t j, double_3 point);
static double_3 references_rotations_cross(struct arena *arena, double_3 u, double_3 v);
static double_3 references_rotations_added(struct arena *arena, double_3 u, double_3 v);
static void schemes_tasks_rotation_rows(struct arena *arena, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static double_3 schemes_step_seen_from(struct arena *arena, Vector placement, double_3 v);
static double_3 references_rotations_row_of(struct arena *arena, Vector target, ptrdiff_t i);
static void references_rotations_rotation_log(struct arena *arena, Matrix R, Vector out);
static void schemes_step_write_spin(struct arena *arena, const step_StepViews *step, Vector constants, double_3 axis, Vector row);
static void schemes_limits_joint_limits(struct arena *arena, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static double schemes_limits_ramp_speed(struct arena *arena, double distance, double offset, double deceleration);
static double_5 integrators_implicit_settle(struct arena *arena, const layout_QPViews *qp, ptrdiff_t rates, Vector constants, Vector s, Vector point);
static double networks_projection_field(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates);
static void qp_dense_times(struct arena *arena, Matrix rows, Vector x, Vector out);
static double qp_dense_row_dot(struct arena *arena, Matrix rows, ptrdiff_t j, Vector x);
static void networks_projection_add_transposed(struct arena *arena, const layout_QPViews *qp, double factor, Vector s, Vector out);
static void qp_dense_add_row(struct arena *arena, Vector out, double factor, Matrix rows, ptrdiff_t j);
static void networks_projection_write_slacks(struct arena *arena, const layout_QPViews *qp, Vector x, Vector slacks);
static void networks_projection_rows_times(struct arena *arena, const layout_QPViews *qp, Vector x, Vector values);
static double qp_layout_larger(struct arena *arena, double largest, double value);
static double_3 qp_residuals_kkt_point(struct arena *arena, const layout_QPViews *qp, Vector s, Vector point);
static double_3 qp_residuals_point_residuals(struct arena *arena, const layout_QPViews *qp, Vector point);
static bool qp_residuals_within(struct arena *arena, double primal, double dual, double gap, double tol);
static void networks_projection_mark_active(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, Vector active);
static bool integrators_implicit_steps_linear_step(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, double step, const implicit_steps_Condensed *matrix, Vector new);
static void integrators_implicit_steps_build_condensed(struct arena *arena, const layout_QPViews *qp, double step, const implicit_steps_Condensed *matrix);
static void integrators_implicit_steps_count_rows(struct arena *arena, const implicit_steps_Condensed *matrix, Matrix rows, ptrdiff_t first);
static void qp_dense_add_outer(struct arena *arena, Matrix out, double factor, Matrix rows, ptrdiff_t j);
static bool qp_dense_cholesky_factor(struct arena *arena, Matrix K);
static void qp_dense_factor_solve(struct arena *arena, Matrix K, Vector rhs, Vector out);
static void integrators_implicit_steps_copy_into(struct arena *arena, Vector out, Vector values);
static ptrdiff_t integrators_implicit_steps_backward_euler(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, double tol, ptrdiff_t max_newton, const implicit_steps_Condensed *matrix);
static void integrators_implicit_steps_multipliers(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector new, Vector active);
static double integrators_implicit_steps_descent(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, Vector descent);
static double integrators_implicit_steps_line_search(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector change, Vector direction, Vector descent);
static double_2 integrators_implicit_steps_slope(struct arena *arena, ptrdiff_t n, ptrdiff_t p, Vector s, double step, Vector slacks, Vector change, double length);
static void references_shapes_heart_path(struct arena *arena, double t, Vector constants, Vector target);
static ptrdiff_t control_step_take_step(struct arena *arena, Vector row, const step_StepPlan *plan, Matrix past, Matrix following, Vector state, Vector relaxed, double t, bool samples);
static command_RowViews control_command_row_views(struct arena *arena, Vector row, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p, ptrdiff_t dof);
static int_9 control_command_row_ends(struct arena *arena, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p, ptrdiff_t dof);
static void control_relaxed_copied(struct arena *arena, Vector out, Vector values);
static void control_step_sample_targets(struct arena *arena, const program_ProgramArrays *arrays, double t, Matrix targets);
static void references_base_enter_path(struct arena *arena, ptrdiff_t address, double t, Vector constants, Vector target);
static void references_rotations_set_mean_twist(struct arena *arena, Vector now, Vector then, double dt);
static void schemes_program_assemble(struct arena *arena, Vector data, const program_ProgramArrays *arrays, Matrix past, Matrix targets, double t);
static layout_QPViews qp_layout_qp_views(struct arena *arena, Vector data, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p);
static int_4 qp_layout_offsets(struct arena *arena, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p);
static void schemes_parts_enter_cost(struct arena *arena, ptrdiff_t address, const step_StepViews *step, Vector constants, Matrix P, Vector q);
static void schemes_parts_enter_task(struct arena *arena, ptrdiff_t address, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b);
static void schemes_program_add_soft(struct arena *arena, const layout_QPViews *qp, Matrix A, Vector b, double weight);
static void schemes_parts_enter_limit(struct arena *arena, ptrdiff_t address, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub);
static void control_step_note_instant(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past);
static bool control_step_answer(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Vector state);
static double_5 integrators_base_enter_answer(struct arena *arena, ptrdiff_t address, const layout_QPViews *qp, ptrdiff_t rates, Vector constants, Vector state, Vector point);
static ptrdiff_t control_step_status_of(struct arena *arena, double primal, double dual, double gap, Vector own, Vector state);
static bool control_yielding_guard_step(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, Matrix following, const relaxed_Yielding *yielding);
static double control_yielding_periods_to_rest(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector x);
static double control_stopping_enter_stopping_time(struct arena *arena, ptrdiff_t address, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector dq);
static bool qp_dense_all_finite(struct arena *arena, Vector data, ptrdiff_t start, ptrdiff_t end);
static ptrdiff_t control_yielding_yield_step(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past, Matrix following, Vector state, const relaxed_Yielding *yielding, Vector relaxed, ptrdiff_t action);
static void control_yielding_widen_bounds(struct arena *arena, const layout_QPViews *qp, Vector limits, Vector q);
static double_2 control_yielding_answer_relaxed(struct arena *arena, const command_RowViews *views, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector relaxed, ptrdiff_t action);
static double control_relaxed_largest_factor(struct arena *arena, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector point, Vector figures, bool retreats);
static ptrdiff_t control_relaxed_data_size(struct arena *arena, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p);
static void control_relaxed_copy_cost(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other);
static double control_relaxed_largest_entry(struct arena *arena, Vector values);
static void control_relaxed_copy_limits(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other);
static bool control_relaxed_settled(struct arena *arena, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector point, Vector figures, double tolerances);
static void control_relaxed_note_blocking(struct arena *arena, Vector point, ptrdiff_t n, ptrdiff_t m, ptrdiff_t extra, Vector blocking);
static bool control_yielding_is_path(struct arena *arena, Matrix targets);
static bool control_yielding_races(struct arena *arena, const layout_QPViews *qp, Vector x);
static void control_relaxed_scale_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double factor);
static void control_relaxed_soften_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double retreat);
static void control_relaxed_move_into_cost(struct arena *arena, const layout_QPViews *qp, ptrdiff_t j, double square, double shrink);
static void control_yielding_step(struct arena *arena, const layout_QPViews *limits, Matrix past, Matrix following, const relaxed_Yielding *yielding, Vector figures, Vector x);
static void control_yielding_step_straight(struct arena *arena, Matrix past, const relaxed_Yielding *yielding, Vector x);
static double control_stopping_least_periods(struct arena *arena, Vector x, Vector before, Vector limits, double dt, bool cubic);
static bool control_stopping_within_rates(struct arena *arena, double x, double before, double periods, double accel, double jerk);
static double control_stopping_bend_of(struct arena *arena, double x, double before, double periods);
static double control_stopping_next_velocity(struct arena *arena, double x, double before, double periods, bool cubic);
static double control_stopping_velocity_at(struct arena *arena, double x, double b, double u, bool cubic);
static void control_yielding_step_towards(struct arena *arena, const layout_QPViews *limits, Matrix past, const relaxed_Yielding *yielding, Vector x);
static double schemes_limits_braking(struct arena *arena, double last, double lb, double ub, double jerk, double dt);
static double schemes_limits_approach(struct arena *arena, double room);
static bool control_relaxed_nearest_within(struct arena *arena, const layout_QPViews *qp, Vector x, const relaxed_Yielding *yielding, Vector figures);
static double control_yielding_make_stoppable(struct arena *arena, const layout_QPViews *limits, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, const command_RowViews *views, Vector x);
static double control_yielding_brake(struct arena *arena, const layout_QPViews *limits, Matrix past, const relaxed_Yielding *yielding, Vector dq);
static bool control_yielding_go_away(struct arena *arena, const layout_QPViews *limits, Vector last, Vector dq);
static ptrdiff_t control_yielding_note_missing(struct arena *arena, const command_RowViews *views, Vector dq);
static void control_yielding_note_decision(struct arena *arena, const command_RowViews *views, const layout_QPViews *own, Vector weights, Vector x, ptrdiff_t kind, double factor, ptrdiff_t action);
static double control_relaxed_attained(struct arena *arena, Vector b, Matrix A, Vector weights, Vector x);
static void robot_kinematics_kernel_write_kinematics(struct arena *arena, const kinematics_kernel_ModelTables *model, Vector q, Matrix jacobian, Matrix placements, Matrix inertia);
static void robot_kinematics_kernel_compose(struct arena *arena, Vector first, Vector second, Vector product);
static void robot_kinematics_kernel_write_twist(struct arena *arena, Vector placement, Vector kind, Vector twist);
static void robot_kinematics_kernel_write_inertia(struct arena *arena, const kinematics_kernel_ModelTables *model, Matrix placed, Matrix jacobian, Matrix inertia);
/* Add w G(q) to P; the constants are those of `KineticEnergy`.
 *
 * iiwa_dnn/schemes/costs.py: add_kinetic_energy */
static void schemes_costs_add_kinetic_energy(struct arena *arena, const step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    (void)arena;
    (void)q;
    double weight;
    weight = constants.data[0];
    for (ptrdiff_t i = 0, end_i = ((*step).q.size0); i < end_i; i++) {
        if (constants.data[1] == 0.0) {
            P.data[i * P.size1 + i] += weight;
        }
        else {
            for (ptrdiff_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
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
    weight = constants.data[0];
    gain = constants.data[1];
    for (ptrdiff_t i = 0, end_i = ((*step).q.size0); i < end_i; i++) {
        P.data[i * P.size1 + i] += weight;
        q.data[i] += ((weight * gain) * ((*step).q.data[i] - constants.data[(2 + i)]));
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
    gain = double_min(constants.data[1], (*step).rate);
    base = ((Vector){(*step).placements.data + (ptrdiff_t)(constants.data[2]) * (*step).placements.size1, (*step).placements.size1});
    point = schemes_step_vector_at(arena, ((Vector){(*step).placements.data + (ptrdiff_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1}), 9);
    offset = references_rotations_combined(arena, 1.0, point, (-1.0), schemes_step_vector_at(arena, base, 9));
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        axis = schemes_step_vector_at(arena, base, (3 * i));
        b.data[i] = (target.data[(12 + i)] + (gain * (target.data[i] - references_rotations_dot(arena, axis, offset))));
        schemes_step_write_velocity(arena, &(*step), constants, point, axis, ((Vector){A.data + i * A.size1, A.size1}));
    }
    return;
}

/* Return three numbers of an array (k,), from an index on.
 *
 * iiwa_dnn/schemes/step.py: vector_at */
static double_3 schemes_step_vector_at(struct arena *arena, Vector array, ptrdiff_t start)
{
    (void)arena;
    return ((double_3){{array.data[start], array.data[(start + 1)], array.data[(start + 2)]}});
}

/* Compute a u + b v.
 *
 * iiwa_dnn/references/rotations.py: combined */
static double_3 references_rotations_combined(struct arena *arena, double a, double_3 u, double b, double_3 v)
{
    (void)arena;
    return ((double_3){{((a * u.at[0]) + (b * v.at[0])), ((a * u.at[1]) + (b * v.at[1])), ((a * u.at[2]) + (b * v.at[2]))}});
}

/* Compute the scalar product u . v.
 *
 * iiwa_dnn/references/rotations.py: dot */
static double references_rotations_dot(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    return (((u.at[0] * v.at[0]) + (u.at[1] * v.at[1])) + (u.at[2] * v.at[2]));
}

/* Write the velocity along an axis of a frame's point as seen from its base, a row (n,).
 *
 * iiwa_dnn/schemes/step.py: write_velocity */
static void schemes_step_write_velocity(struct arena *arena, const step_StepViews *step, Vector constants, double_3 point, double_3 axis, Vector row)
{
    ptrdiff_t frame;
    ptrdiff_t base;
    double sign;
    frame = (ptrdiff_t)(constants.data[0]);
    base = (ptrdiff_t)(constants.data[2]);
    for (ptrdiff_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        sign = ((*step).moves.data[frame * (*step).moves.size1 + j] - (*step).moves.data[base * (*step).moves.size1 + j]);
        row.data[j] = (sign * schemes_step_rate_along(arena, (*step).jacobian, j, point, axis));
    }
    return;
}

/* Compute the velocity along a normal (3,) of a point (3,) [m] that joint j moves [m/rad].
 *
 * iiwa_dnn/schemes/step.py: rate_along */
static double schemes_step_rate_along(struct arena *arena, Matrix jacobian, ptrdiff_t j, double_3 point, double_3 normal)
{
    return references_rotations_dot(arena, normal, schemes_step_point_rate(arena, jacobian, j, point));
}

/* Compute the velocity (3,) of a point (3,) [m] that joint j moves [m/rad].
 *
 * A joint with angular velocity w and velocity v of the world's origin moves it with v + w x p.
 *
 * iiwa_dnn/schemes/step.py: point_rate */
static double_3 schemes_step_point_rate(struct arena *arena, Matrix jacobian, ptrdiff_t j, double_3 point)
{
    double_3 turned;
    turned = references_rotations_cross(arena, schemes_step_vector_at(arena, ((Vector){jacobian.data + j * jacobian.size1, jacobian.size1}), 3), point);
    return references_rotations_added(arena, schemes_step_vector_at(arena, ((Vector){jacobian.data + j * jacobian.size1, jacobian.size1}), 0), turned);
}

/* Compute the cross product u x v.
 *
 * iiwa_dnn/references/rotations.py: cross */
static double_3 references_rotations_cross(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    return ((double_3){{((u.at[1] * v.at[2]) - (u.at[2] * v.at[1])), ((u.at[2] * v.at[0]) - (u.at[0] * v.at[2])), ((u.at[0] * v.at[1]) - (u.at[1] * v.at[0]))}});
}

/* Compute u + v.
 *
 * iiwa_dnn/references/rotations.py: added */
static double_3 references_rotations_added(struct arena *arena, double_3 u, double_3 v)
{
    (void)arena;
    return ((double_3){{(u.at[0] + v.at[0]), (u.at[1] + v.at[1]), (u.at[2] + v.at[2])}});
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
    gain = double_min(constants.data[1], (*step).rate);
    base = ((Vector){(*step).placements.data + (ptrdiff_t)(constants.data[2]) * (*step).placements.size1, (*step).placements.size1});
    placement = ((Vector){(*step).placements.data + (ptrdiff_t)(constants.data[0]) * (*step).placements.size1, (*step).placements.size1});
    missing = ((Matrix){arena_empty(arena, 3 * 3), 3, 3});
    error = ((Vector){arena_empty(arena, 3), 3});
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        for (ptrdiff_t k = 0, end_k = 3; k < end_k; k++) {
            seen = schemes_step_seen_from(arena, placement, schemes_step_vector_at(arena, base, (3 * k)));
            missing.data[i * missing.size1 + k] = references_rotations_dot(arena, references_rotations_row_of(arena, target, i), seen);
        }
    }
    references_rotations_rotation_log(arena, missing, error);
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        b.data[i] = (target.data[(15 + i)] + (gain * error.data[i]));
        schemes_step_write_spin(arena, &(*step), constants, schemes_step_vector_at(arena, base, (3 * i)), ((Vector){A.data + i * A.size1, A.size1}));
    }
    arena_leave(arena, &mark);
    return;
}

/* Turn a vector (3,) of the world into the coordinates of a placement (12,).
 *
 * iiwa_dnn/schemes/step.py: seen_from */
static double_3 schemes_step_seen_from(struct arena *arena, Vector placement, double_3 v)
{
    double x;
    double y;
    x = references_rotations_dot(arena, schemes_step_vector_at(arena, placement, 0), v);
    y = references_rotations_dot(arena, schemes_step_vector_at(arena, placement, 3), v);
    return ((double_3){{x, y, references_rotations_dot(arena, schemes_step_vector_at(arena, placement, 6), v)}});
}

/* Return the i-th row of the rotation of `Target.data` (18,).
 *
 * iiwa_dnn/references/rotations.py: row_of */
static double_3 references_rotations_row_of(struct arena *arena, Vector target, ptrdiff_t i)
{
    (void)arena;
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
    ptrdiff_t i;
    ptrdiff_t j;
    ptrdiff_t k;
    double largest;
    double sign;
    double sine;
    double scale;
    trace = ((R.data[0] + R.data[1 * R.size1 + 1]) + R.data[2 * R.size1 + 2]);
    if (trace > 0.0) {
        w = (0.5 * sqrt((1.0 + trace)));
        out.data[0] = ((double)(R.data[2 * R.size1 + 1] - R.data[1 * R.size1 + 2]) / (4.0 * w));
        out.data[1] = ((double)(R.data[2] - R.data[2 * R.size1]) / (4.0 * w));
        out.data[2] = ((double)(R.data[1 * R.size1] - R.data[1]) / (4.0 * w));
    }
    else {
        i = 0;
        if (R.data[1 * R.size1 + 1] > R.data[0]) {
            i = 1;
        }
        if (R.data[2 * R.size1 + 2] > R.data[i * R.size1 + i]) {
            i = 2;
        }
        j = int_remainder((i + 1), 3);
        k = int_remainder((i + 2), 3);
        largest = (0.5 * sqrt(double_max((((1.0 + R.data[i * R.size1 + i]) - R.data[j * R.size1 + j]) - R.data[k * R.size1 + k]), 0.0)));
        w = ((double)(R.data[k * R.size1 + j] - R.data[j * R.size1 + k]) / (4.0 * largest));
        sign = ((w >= 0.0) ? 1.0 : (-1.0));
        w *= sign;
        out.data[i] = (sign * largest);
        out.data[j] = ((double)(sign * (R.data[i * R.size1 + j] + R.data[j * R.size1 + i])) / (4.0 * largest));
        out.data[k] = ((double)(sign * (R.data[i * R.size1 + k] + R.data[k * R.size1 + i])) / (4.0 * largest));
    }
    sine = sqrt((((out.data[0] * out.data[0]) + (out.data[1] * out.data[1])) + (out.data[2] * out.data[2])));
    scale = ((sine > 1e-12) ? ((double)(2.0 * atan2(sine, w)) / sine) : 2.0);
    for (ptrdiff_t axis = 0, end_axis = 3; axis < end_axis; axis++) {
        out.data[axis] *= scale;
    }
    return;
}

/* Write the angular velocity about an axis of a frame as seen from its base, a row (n,).
 *
 * iiwa_dnn/schemes/step.py: write_spin */
static void schemes_step_write_spin(struct arena *arena, const step_StepViews *step, Vector constants, double_3 axis, Vector row)
{
    ptrdiff_t frame;
    ptrdiff_t base;
    double sign;
    frame = (ptrdiff_t)(constants.data[0]);
    base = (ptrdiff_t)(constants.data[2]);
    for (ptrdiff_t j = 0, end_j = ((*step).q.size0); j < end_j; j++) {
        sign = ((*step).moves.data[frame * (*step).moves.size1 + j] - (*step).moves.data[base * (*step).moves.size1 + j]);
        row.data[j] = (sign * references_rotations_dot(arena, axis, schemes_step_vector_at(arena, ((Vector){(*step).jacobian.data + j * (*step).jacobian.size1, (*step).jacobian.size1}), 3)));
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
    ptrdiff_t dof;
    double gain;
    Matrix limits;
    double above;
    double below;
    double fastest;
    double up;
    double down;
    dof = ((*step).q.size0);
    gain = double_min(constants.data[0], (*step).rate);
    limits = ((Matrix){((Vector){constants.data + 1, constants.size0 - 1}).data, 5, dof});
    for (ptrdiff_t i = 0, end_i = dof; i < end_i; i++) {
        above = (limits.data[1 * limits.size1 + i] - (*step).q.data[i]);
        below = ((*step).q.data[i] - limits.data[i]);
        fastest = limits.data[2 * limits.size1 + i];
        up = double_min(fastest, schemes_limits_ramp_speed(arena, above, limits.data[3 * limits.size1 + i], limits.data[4 * limits.size1 + i]));
        down = double_min(fastest, schemes_limits_ramp_speed(arena, below, limits.data[3 * limits.size1 + i], limits.data[4 * limits.size1 + i]));
        lb.data[i] = double_max(lb.data[i], double_min(double_max(((-gain) * below), (-down)), up));
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
    if (!(deceleration < INFINITY)) {
        return INFINITY;
    }
    return double_max((sqrt(((2.0 * deceleration) * double_max(distance, 0.0))) - offset), 0.0);
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
static double_5 integrators_implicit_settle(struct arena *arena, const layout_QPViews *qp, ptrdiff_t rates, Vector constants, Vector s, Vector point)
{
    (void)rates;
    double tol;
    ptrdiff_t budget;
    ptrdiff_t n;
    ptrdiff_t rows;
    implicit_steps_Condensed matrix;
    Vector now;
    Vector then;
    Vector new;
    double step;
    ptrdiff_t systems;
    double time;
    ptrdiff_t stuck;
    double rate;
    double smallest;
    double primal;
    double dual;
    double gap;
    double new_rate;
    ptrdiff_t taken;
    const struct arena mark = *arena;
    tol = constants.data[0];
    budget = (ptrdiff_t)(constants.data[1]);
    n = ((*qp).q.size0);
    rows = ((s.size0) - n);
    matrix = ((implicit_steps_Condensed){((Vector){arena_empty(arena, rows), rows}), ((Vector){arena_zeros(arena, (rows - (2 * n))), (rows - (2 * n))}), ((Matrix){arena_zeros(arena, n * n), n, n}), ((Matrix){arena_empty(arena, n * n), n, n}), ((Vector){arena_empty(arena, rows), rows})});
    now = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    then = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    new = ((Vector){arena_empty(arena, (s.size0)), (s.size0)});
    step = 30.0;
    systems = 0;
    time = 0.0;
    stuck = 0;
    rate = networks_projection_field(arena, &(*qp), s, now);
    smallest = INFINITY;
    while (systems < budget) {
        stuck += 1;
        if (rate <= (0.5 * smallest)) {
            smallest = rate;
            stuck = 0;
        }
        if (!(rate > tol)) {
            const double_3 own_19 = qp_residuals_kkt_point(arena, &(*qp), s, point);
            primal = own_19.at[0];
            dual = own_19.at[1];
            gap = own_19.at[2];
            if (qp_residuals_within(arena, primal, dual, gap, tol)) {
                const double_5 own_result = ((double_5){{systems, time, primal, dual, gap}});
                arena_leave(arena, &mark);
                return own_result;
            }
        }
        networks_projection_mark_active(arena, &(*qp), s, now, matrix.active);
        systems += 1;
        if (integrators_implicit_steps_linear_step(arena, &(*qp), s, now, 100000000.0, &matrix, new)) {
            new_rate = networks_projection_field(arena, &(*qp), new, then);
            if (new_rate < (0.5 * rate)) {
                integrators_implicit_steps_copy_into(arena, s, new);
                integrators_implicit_steps_copy_into(arena, now, then);
                rate = new_rate;
                time += 100000000.0;
                continue;
            }
        }
        if (stuck > 15) {
            break;
        }
        taken = integrators_implicit_steps_backward_euler(arena, &(*qp), s, step, new, (0.1 * rate), int_min(50, (budget - systems)), &matrix);
        if (taken < 0) {
            step *= 0.1;
            continue;
        }
        systems += taken;
        time += step;
        integrators_implicit_steps_copy_into(arena, s, new);
        rate = networks_projection_field(arena, &(*qp), s, now);
        if (step < 100000000.0) {
            step *= 10.0;
        }
    }
    const double_3 own_59 = qp_residuals_kkt_point(arena, &(*qp), s, point);
    primal = own_59.at[0];
    dual = own_59.at[1];
    gap = own_59.at[2];
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
    ptrdiff_t n;
    double largest;
    n = ((*qp).q.size0);
    qp_dense_times(arena, (*qp).P, s, rates);
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        rates.data[i] = ((-(*qp).q.data[i]) - rates.data[i]);
    }
    networks_projection_add_transposed(arena, &(*qp), (-1.0), s, rates);
    networks_projection_write_slacks(arena, &(*qp), s, ((Vector){rates.data + n, rates.size0 - n}));
    for (ptrdiff_t k = (n + ((*qp).b.size0)), end_k = (s.size0); k < end_k; k++) {
        if (!((s.data[k] + rates.data[k]) > 0.0)) {
            rates.data[k] = (-s.data[k]);
        }
    }
    largest = 0.0;
    for (ptrdiff_t k = 0, end_k = (s.size0); k < end_k; k++) {
        largest = qp_layout_larger(arena, largest, fabs(rates.data[k]));
    }
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
    for (ptrdiff_t pair = 0, end_pair = int_quotient(rows.size0, 2); pair < end_pair; pair++) {
        one = 0.0;
        two = 0.0;
        for (ptrdiff_t k = 0, end_k = rows.size1; k < end_k; k++) {
            one += (rows.data[(2 * pair) * rows.size1 + k] * x.data[k]);
            two += (rows.data[((2 * pair) + 1) * rows.size1 + k] * x.data[k]);
        }
        out.data[(2 * pair)] = one;
        out.data[((2 * pair) + 1)] = two;
    }
    for (ptrdiff_t j = (int_quotient(rows.size0, 2) * 2), end_j = rows.size0; j < end_j; j++) {
        out.data[j] = qp_dense_row_dot(arena, rows, j, x);
    }
    return;
}

/* Compute the product of row j of a matrix (k, n) and the first n entries of x.
 *
 * iiwa_dnn/qp/dense.py: row_dot */
static double qp_dense_row_dot(struct arena *arena, Matrix rows, ptrdiff_t j, Vector x)
{
    (void)arena;
    double value;
    value = 0.0;
    for (ptrdiff_t k = 0, end_k = rows.size1; k < end_k; k++) {
        value += (rows.data[j * rows.size1 + k] * x.data[k]);
    }
    return value;
}

/* Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,).
 *
 * iiwa_dnn/networks/projection.py: add_transposed */
static void networks_projection_add_transposed(struct arena *arena, const layout_QPViews *qp, double factor, Vector s, Vector out)
{
    ptrdiff_t n;
    ptrdiff_t p;
    ptrdiff_t at_z;
    ptrdiff_t at_u;
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    at_z = (n + p);
    at_u = (at_z + ((*qp).h.size0));
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        out.data[i] += (factor * (s.data[(at_u + i)] - s.data[((at_u + n) + i)]));
    }
    for (ptrdiff_t j = 0, end_j = p; j < end_j; j++) {
        qp_dense_add_row(arena, out, (factor * s.data[(n + j)]), (*qp).A, j);
    }
    for (ptrdiff_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        if (s.data[(at_z + j)] != 0.0) {
            qp_dense_add_row(arena, out, (factor * s.data[(at_z + j)]), (*qp).G, j);
        }
    }
    return;
}

/* Add a multiple of row j of a matrix (k, n) to the first n entries of `out`.
 *
 * iiwa_dnn/qp/dense.py: add_row */
static void qp_dense_add_row(struct arena *arena, Vector out, double factor, Matrix rows, ptrdiff_t j)
{
    (void)arena;
    for (ptrdiff_t k = 0, end_k = rows.size1; k < end_k; k++) {
        out.data[k] += (factor * rows.data[j * rows.size1 + k]);
    }
    return;
}

/* Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n).
 *
 * iiwa_dnn/networks/projection.py: write_slacks */
static void networks_projection_write_slacks(struct arena *arena, const layout_QPViews *qp, Vector x, Vector slacks)
{
    ptrdiff_t n;
    ptrdiff_t p;
    ptrdiff_t first;
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    first = (p + ((*qp).h.size0));
    networks_projection_rows_times(arena, &(*qp), x, slacks);
    for (ptrdiff_t j = 0, end_j = p; j < end_j; j++) {
        slacks.data[j] -= (*qp).b.data[j];
    }
    for (ptrdiff_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        slacks.data[(p + j)] -= (*qp).h.data[j];
    }
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        slacks.data[(first + i)] -= (*qp).ub.data[i];
        slacks.data[((first + n) + i)] += (*qp).lb.data[i];
    }
    return;
}

/* Write [A; G; I; -I] x into `values`, of size p + m + 2n.
 *
 * iiwa_dnn/networks/projection.py: rows_times */
static void networks_projection_rows_times(struct arena *arena, const layout_QPViews *qp, Vector x, Vector values)
{
    ptrdiff_t n;
    ptrdiff_t p;
    ptrdiff_t first;
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    first = (p + ((*qp).h.size0));
    qp_dense_times(arena, (*qp).A, x, values);
    qp_dense_times(arena, (*qp).G, x, ((Vector){values.data + p, values.size0 - p}));
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        values.data[(first + i)] = x.data[i];
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
    ptrdiff_t n;
    ptrdiff_t p;
    ptrdiff_t m;
    ptrdiff_t at_z;
    ptrdiff_t at_box;
    Vector descent;
    double above;
    double below;
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    m = ((*qp).h.size0);
    at_z = (n + p);
    at_box = (at_z + m);
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        point.data[i] = double_min(double_max(s.data[i], (*qp).lb.data[i]), (*qp).ub.data[i]);
    }
    for (ptrdiff_t j = 0, end_j = p; j < end_j; j++) {
        point.data[(n + j)] = s.data[(n + j)];
    }
    for (ptrdiff_t j = 0, end_j = m; j < end_j; j++) {
        point.data[(at_z + j)] = double_max(s.data[(at_z + j)], 0.0);
    }
    descent = ((Vector){point.data + at_box, point.size0 - at_box});
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        descent.data[i] = ((-(*qp).q.data[i]) - qp_dense_row_dot(arena, (*qp).P, i, point));
    }
    for (ptrdiff_t j = 0, end_j = p; j < end_j; j++) {
        qp_dense_add_row(arena, descent, (-point.data[(n + j)]), (*qp).A, j);
    }
    for (ptrdiff_t j = 0, end_j = m; j < end_j; j++) {
        if (point.data[(at_z + j)] != 0.0) {
            qp_dense_add_row(arena, descent, (-point.data[(at_z + j)]), (*qp).G, j);
        }
    }
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        above = ((point.data[i] - (*qp).ub.data[i]) + descent.data[i]);
        below = ((point.data[i] - (*qp).lb.data[i]) + descent.data[i]);
        if (above > 0.0) {
            descent.data[i] = above;
        }
        else {
            if (below < 0.0) {
                descent.data[i] = below;
            }
            else {
                descent.data[i] = 0.0;
            }
        }
    }
    return qp_residuals_point_residuals(arena, &(*qp), point);
}

/* Compute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them.
 *
 * iiwa_dnn/qp/residuals.py: point_residuals */
static double_3 qp_residuals_point_residuals(struct arena *arena, const layout_QPViews *qp, Vector point)
{
    ptrdiff_t n;
    ptrdiff_t p;
    ptrdiff_t at_z;
    ptrdiff_t at_box;
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
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    at_z = (n + p);
    at_box = (at_z + ((*qp).h.size0));
    primal = 0.0;
    dual = 0.0;
    gap = 0.0;
    gradient = ((Vector){arena_empty(arena, n), n});
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        x = point.data[i];
        multiplier = point.data[(at_box + i)];
        primal = qp_layout_larger(arena, primal, (x - (*qp).ub.data[i]));
        primal = qp_layout_larger(arena, primal, ((*qp).lb.data[i] - x));
        value = ((*qp).q.data[i] + qp_dense_row_dot(arena, (*qp).P, i, point));
        gap += (x * value);
        gradient.data[i] = (value + multiplier);
        if ((multiplier > 0.0) && ((*qp).ub.data[i] < INFINITY)) {
            gap += ((*qp).ub.data[i] * multiplier);
        }
        else {
            if ((multiplier < 0.0) && ((*qp).lb.data[i] > (-INFINITY))) {
                gap += ((*qp).lb.data[i] * multiplier);
            }
        }
    }
    for (ptrdiff_t j = 0, end_j = p; j < end_j; j++) {
        y = point.data[(n + j)];
        primal = qp_layout_larger(arena, primal, fabs((qp_dense_row_dot(arena, (*qp).A, j, point) - (*qp).b.data[j])));
        gap += ((*qp).b.data[j] * y);
        qp_dense_add_row(arena, gradient, y, (*qp).A, j);
    }
    for (ptrdiff_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        z = point.data[(at_z + j)];
        primal = qp_layout_larger(arena, primal, (qp_dense_row_dot(arena, (*qp).G, j, point) - (*qp).h.data[j]));
        if (z != 0.0) {
            gap += ((*qp).h.data[j] * z);
            qp_dense_add_row(arena, gradient, z, (*qp).G, j);
        }
    }
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        dual = qp_layout_larger(arena, dual, fabs(gradient.data[i]));
    }
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
    ptrdiff_t n;
    n = ((*qp).q.size0);
    for (ptrdiff_t k = 0, end_k = (active.size0); k < end_k; k++) {
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
static bool integrators_implicit_steps_linear_step(struct arena *arena, const layout_QPViews *qp, Vector s, Vector rates, double step, const implicit_steps_Condensed *matrix, Vector new)
{
    ptrdiff_t n;
    Vector active;
    Vector values;
    double decay;
    n = ((*qp).q.size0);
    active = (*matrix).active;
    values = (*matrix).values;
    integrators_implicit_steps_build_condensed(arena, &(*qp), step, &(*matrix));
    if (!qp_dense_cholesky_factor(arena, (*matrix).K)) {
        return false;
    }
    decay = ((double)step / (1.0 + step));
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        values.data[i] = rates.data[i];
    }
    for (ptrdiff_t k = 0, end_k = (active.size0); k < end_k; k++) {
        new.data[(n + k)] = (rates.data[(n + k)] * ((active.data[k] != 0.0) ? step : decay));
    }
    networks_projection_add_transposed(arena, &(*qp), (-1.0), new, values);
    qp_dense_factor_solve(arena, (*matrix).K, values, new);
    networks_projection_rows_times(arena, &(*qp), new, values);
    for (ptrdiff_t k = 0, end_k = (active.size0); k < end_k; k++) {
        new.data[(n + k)] += ((step * active.data[k]) * values.data[k]);
    }
    for (ptrdiff_t k = 0, end_k = (s.size0); k < end_k; k++) {
        new.data[k] += s.data[k];
    }
    return true;
}

/* Write the condensed matrix of the active set for a step [rho] into `matrix.K`.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: build_condensed */
static void integrators_implicit_steps_build_condensed(struct arena *arena, const layout_QPViews *qp, double step, const implicit_steps_Condensed *matrix)
{
    ptrdiff_t n;
    ptrdiff_t first;
    double bounds;
    n = ((*qp).q.size0);
    first = ((*matrix).counted.size0);
    integrators_implicit_steps_count_rows(arena, &(*matrix), (*qp).A, 0);
    integrators_implicit_steps_count_rows(arena, &(*matrix), (*qp).G, ((*qp).b.size0));
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        for (ptrdiff_t k = i, end_k = n; k < end_k; k++) {
            (*matrix).K.data[i * (*matrix).K.size1 + k] = ((*qp).P.data[i * (*qp).P.size1 + k] + (step * (*matrix).gram.data[i * (*matrix).gram.size1 + k]));
        }
        bounds = ((*matrix).active.data[(first + i)] + (*matrix).active.data[((first + n) + i)]);
        (*matrix).K.data[i * (*matrix).K.size1 + i] += (((double)1.0 / step) + (step * bounds));
    }
    return;
}

/* Add active rows (k, n) to `gram`, and take off others: few change between two steps.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _count_rows */
static void integrators_implicit_steps_count_rows(struct arena *arena, const implicit_steps_Condensed *matrix, Matrix rows, ptrdiff_t first)
{
    double change;
    for (ptrdiff_t j = 0, end_j = rows.size0; j < end_j; j++) {
        change = ((*matrix).active.data[(first + j)] - (*matrix).counted.data[(first + j)]);
        if (change != 0.0) {
            qp_dense_add_outer(arena, (*matrix).gram, change, rows, j);
            (*matrix).counted.data[(first + j)] += change;
        }
    }
    return;
}

/* Add factor v v^T to the upper half of `out` (n, n), v being row j of a matrix (k, n).
 *
 * iiwa_dnn/qp/dense.py: add_outer */
static void qp_dense_add_outer(struct arena *arena, Matrix out, double factor, Matrix rows, ptrdiff_t j)
{
    (void)arena;
    double scaled;
    for (ptrdiff_t i = 0, end_i = rows.size1; i < end_i; i++) {
        scaled = (factor * rows.data[j * rows.size1 + i]);
        for (ptrdiff_t k = i, end_k = rows.size1; k < end_k; k++) {
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
    ptrdiff_t size;
    double one;
    double two;
    double last;
    size = K.size0;
    for (ptrdiff_t i = 0, end_i = size; i < end_i; i++) {
        for (ptrdiff_t pair = 0, end_pair = int_quotient(i, 2); pair < end_pair; pair++) {
            one = K.data[(2 * pair) * K.size1 + i];
            two = K.data[((2 * pair) + 1) * K.size1 + i];
            for (ptrdiff_t k = i, end_k = size; k < end_k; k++) {
                K.data[i * K.size1 + k] = ((K.data[i * K.size1 + k] - (one * K.data[(2 * pair) * K.size1 + k])) - (two * K.data[((2 * pair) + 1) * K.size1 + k]));
            }
        }
        if (int_remainder(i, 2) == 1) {
            last = K.data[(i - 1) * K.size1 + i];
            for (ptrdiff_t k = i, end_k = size; k < end_k; k++) {
                K.data[i * K.size1 + k] -= (last * K.data[(i - 1) * K.size1 + k]);
            }
        }
        if (!(K.data[i * K.size1 + i] > 0.0)) {
            return false;
        }
        K.data[i * K.size1 + i] = ((double)1.0 / sqrt(K.data[i * K.size1 + i]));
        for (ptrdiff_t k = (i + 1), end_k = size; k < end_k; k++) {
            K.data[i * K.size1 + k] *= K.data[i * K.size1 + i];
        }
    }
    return true;
}

/* Solve with the factor that `cholesky_factor` left in K (n, n), into the first n of `out`.
 *
 * iiwa_dnn/qp/dense.py: factor_solve */
static void qp_dense_factor_solve(struct arena *arena, Matrix K, Vector rhs, Vector out)
{
    (void)arena;
    ptrdiff_t size;
    ptrdiff_t row;
    size = K.size0;
    for (ptrdiff_t i = 0, end_i = size; i < end_i; i++) {
        out.data[i] = rhs.data[i];
    }
    for (ptrdiff_t i = 0, end_i = size; i < end_i; i++) {
        out.data[i] *= K.data[i * K.size1 + i];
        for (ptrdiff_t k = (i + 1), end_k = size; k < end_k; k++) {
            out.data[k] -= (out.data[i] * K.data[i * K.size1 + k]);
        }
    }
    for (ptrdiff_t back = 0, end_back = size; back < end_back; back++) {
        row = ((size - 1) - back);
        for (ptrdiff_t k = (row + 1), end_k = size; k < end_k; k++) {
            out.data[row] -= (K.data[row * K.size1 + k] * out.data[k]);
        }
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
    for (ptrdiff_t k = 0, end_k = (values.size0); k < end_k; k++) {
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
static ptrdiff_t integrators_implicit_steps_backward_euler(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector new, double tol, ptrdiff_t max_newton, const implicit_steps_Condensed *matrix)
{
    ptrdiff_t n;
    Vector descent;
    Vector direction;
    Vector slacks;
    double largest;
    double floor;
    ptrdiff_t taken;
    double size;
    double length;
    const struct arena mark = *arena;
    n = ((*qp).q.size0);
    descent = ((Vector){arena_empty(arena, n), n});
    direction = ((Vector){arena_empty(arena, n), n});
    slacks = ((Vector){arena_empty(arena, ((*matrix).values.size0)), ((*matrix).values.size0)});
    integrators_implicit_steps_copy_into(arena, new, s);
    largest = 1.0;
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        largest = double_max(largest, fabs(new.data[i]));
    }
    floor = ((1e-15 * step) * largest);
    networks_projection_write_slacks(arena, &(*qp), new, slacks);
    taken = 0;
    while (taken < max_newton) {
        integrators_implicit_steps_multipliers(arena, &(*qp), s, step, slacks, new, (*matrix).active);
        size = integrators_implicit_steps_descent(arena, &(*qp), s, step, new, descent);
        if ((taken > 0) && (!(size > double_max(tol, floor)))) {
            break;
        }
        integrators_implicit_steps_build_condensed(arena, &(*qp), step, &(*matrix));
        if (!qp_dense_cholesky_factor(arena, (*matrix).K)) {
            const ptrdiff_t own_result = (-1);
            arena_leave(arena, &mark);
            return own_result;
        }
        taken += 1;
        qp_dense_factor_solve(arena, (*matrix).K, descent, direction);
        networks_projection_rows_times(arena, &(*qp), direction, (*matrix).values);
        length = integrators_implicit_steps_line_search(arena, &(*qp), s, step, slacks, (*matrix).values, direction, descent);
        for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
            new.data[i] += (length * direction.data[i]);
        }
        for (ptrdiff_t k = 0, end_k = (slacks.size0); k < end_k; k++) {
            slacks.data[k] += (length * (*matrix).values.data[k]);
        }
    }
    networks_projection_write_slacks(arena, &(*qp), new, slacks);
    integrators_implicit_steps_multipliers(arena, &(*qp), s, step, slacks, new, (*matrix).active);
    const ptrdiff_t own_result = taken;
    arena_leave(arena, &mark);
    return own_result;
}

/* Write the multipliers after a step to x with these slacks, and mark those that are active.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _multipliers */
static void integrators_implicit_steps_multipliers(struct arena *arena, const layout_QPViews *qp, Vector s, double step, Vector slacks, Vector new, Vector active)
{
    (void)arena;
    ptrdiff_t n;
    ptrdiff_t p;
    double keep;
    double moving;
    double kept;
    bool is_active;
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    keep = ((double)1.0 / (1.0 + step));
    for (ptrdiff_t k = 0, end_k = (active.size0); k < end_k; k++) {
        moving = (s.data[(n + k)] + (step * slacks.data[k]));
        kept = (s.data[(n + k)] * keep);
        is_active = ((k < p) || (moving > kept));
        active.data[k] = ((is_active) ? 1.0 : 0.0);
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
    size = 0.0;
    qp_dense_times(arena, (*qp).P, new, descent);
    for (ptrdiff_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
        descent.data[i] = (-(descent.data[i] + ((*qp).q.data[i] + ((double)(new.data[i] - s.data[i]) / step))));
    }
    networks_projection_add_transposed(arena, &(*qp), (-1.0), new, descent);
    for (ptrdiff_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
        size = qp_layout_larger(arena, size, fabs(descent.data[i]));
    }
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
    ptrdiff_t n;
    ptrdiff_t p;
    double start;
    double shortest;
    double slope;
    double second;
    double constant;
    double curvature;
    double low;
    double high;
    double length;
    n = ((*qp).q.size0);
    p = ((*qp).b.size0);
    start = 0.0;
    shortest = 0.0;
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        start -= (descent.data[i] * direction.data[i]);
        shortest += (direction.data[i] * direction.data[i]);
    }
    const double_2 own_8 = integrators_implicit_steps_slope(arena, n, p, s, step, slacks, change, 0.0);
    slope = own_8.at[0];
    second = own_8.at[1];
    constant = (start - slope);
    curvature = double_max(((-start) - second), ((double)shortest / step));
    low = 0.0;
    high = INFINITY;
    length = 1.0;
    for (ptrdiff_t _ = 0, end__ = 50; _ < end__; _++) {
        const double_2 own_16 = integrators_implicit_steps_slope(arena, n, p, s, step, slacks, change, length);
        slope = own_16.at[0];
        second = own_16.at[1];
        slope = ((slope + constant) + (length * curvature));
        second += curvature;
        if (fabs(slope) <= (0.3 * fabs(start))) {
            break;
        }
        if (slope > 0.0) {
            high = length;
        }
        else {
            low = length;
        }
        length -= ((double)slope / second);
        if (!(low < length && length < high)) {
            length = ((high < INFINITY) ? (0.5 * (low + high)) : (2.0 * low));
        }
    }
    return length;
}

/* Sum slope and curvature of the inequalities' part of the step's function at a length.
 *
 * iiwa_dnn/networks/integrators/implicit_steps.py: _slope */
static double_2 integrators_implicit_steps_slope(struct arena *arena, ptrdiff_t n, ptrdiff_t p, Vector s, double step, Vector slacks, Vector change, double length)
{
    (void)arena;
    double keep;
    double slope;
    double second;
    double rate;
    double moving;
    double kept;
    bool is_active;
    keep = ((double)1.0 / (1.0 + step));
    slope = 0.0;
    second = 0.0;
    for (ptrdiff_t k = p, end_k = (slacks.size0); k < end_k; k++) {
        rate = change.data[k];
        moving = (s.data[(n + k)] + (step * (slacks.data[k] + (length * rate))));
        kept = (s.data[(n + k)] * keep);
        is_active = (moving > kept);
        slope += (((is_active) ? moving : kept) * rate);
        second += ((is_active) ? ((step * rate) * rate) : 0.0);
    }
    return ((double_2){{slope, second}});
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
    scale = constants.data[0];
    rate = constants.data[1];
    p = (rate * t);
    s1 = sin(p);
    c1 = cos(p);
    y = (((((13.0 * c1) - (5.0 * cos((2.0 * p)))) - (2.0 * cos((3.0 * p)))) - cos((4.0 * p))) - 5.0);
    slope = (((((-13.0) * s1) + (10.0 * sin((2.0 * p)))) + (6.0 * sin((3.0 * p)))) + (4.0 * sin((4.0 * p))));
    target.data[0] += ((((scale * 16.0) * s1) * s1) * s1);
    target.data[1] += (scale * y);
    target.data[12] += (((((rate * scale) * 48.0) * s1) * s1) * c1);
    target.data[13] += ((rate * scale) * slope);
    return;
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
static ptrdiff_t control_step_take_step(struct arena *arena, Vector row, const step_StepPlan *plan, Matrix past, Matrix following, Vector state, Vector relaxed, double t, bool samples)
{
    program_ProgramArrays arrays;
    IntMatrix table;
    command_RowViews views;
    bool halted;
    ptrdiff_t first;
    Vector own;
    ptrdiff_t policy;
    const struct arena mark = *arena;
    arrays = (*plan).arrays;
    table = ((IntMatrix){(ptrdiff_t *)table_table, 8, 7});
    views = control_command_row_views(arena, row, table.data[0], table.data[1], table.data[2], table.data[3]);
    control_relaxed_copied(arena, ((Vector){following.data, (following.size0 * following.size1)}), ((Vector){past.data, (past.size0 * past.size1)}));
    control_relaxed_copied(arena, ((Vector){following.data + 2 * following.size1, following.size1}), ((Vector){past.data + 1 * past.size1, past.size1}));
    following.data[4 * following.size1] = 0.0;
    following.data[6 * following.size1] = 0.0;
    if (samples) {
        control_step_sample_targets(arena, &arrays, (t - past.data[5 * past.size1]), views.targets);
    }
    schemes_program_assemble(arena, views.program, &arrays, past, views.targets, t);
    control_step_note_instant(arena, &views, &arrays, past);
    halted = (past.data[7 * past.size1] != 0.0);
    if ((past.data[6 * past.size1] == 0.0) && (!halted) && (control_step_answer(arena, &views, &arrays, state))) {
        control_relaxed_copied(arena, ((Vector){following.data + 1 * following.size1, following.size1}), views.dq);
        if (control_yielding_guard_step(arena, &arrays, past, following, &((relaxed_Yielding){{(double *)table_weights, 6}, {NULL, 0}, {(double *)table_settings, 2}, {NULL, 0, 2}, 0.001, 0, false, false}))) {
            const ptrdiff_t own_result = 0;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    first = ((row.size0) - (views.targets.size0 * views.targets.size1));
    if ((!qp_dense_all_finite(arena, ((Vector){past.data, past.size1}), 0, table.data[3])) || (!qp_dense_all_finite(arena, row, first, (row.size0)))) {
        const ptrdiff_t own_result = -1;
        arena_leave(arena, &mark);
        return own_result;
    }
    own = ((Vector){arena_zeros(arena, (((3 * table.data[0]) + table.data[1]) + table.data[2])), (((3 * table.data[0]) + table.data[1]) + table.data[2])});
    if (((bool)true)) {
        own = state;
    }
    policy = ((halted) ? -1 : ((ptrdiff_t)2));
    const ptrdiff_t own_result = control_yielding_yield_step(arena, &views, &arrays, past, following, own, &((relaxed_Yielding){{(double *)table_weights, 6}, {NULL, 0}, {(double *)table_settings, 2}, {NULL, 0, 2}, 0.001, 0, false, false}), relaxed, policy);
    arena_leave(arena, &mark);
    return own_result;
}

/* Make the views of a row, (width,).
 *
 * iiwa_dnn/control/command.py: row_views */
static command_RowViews control_command_row_views(struct arena *arena, Vector row, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p, ptrdiff_t dof)
{
    int_9 ends;
    ends = control_command_row_ends(arena, n, m, p, dof);
    return ((command_RowViews){((Vector){row.data, ends.at[0] - 0}), ((Vector){row.data + ends.at[0], ends.at[1] - ends.at[0]}), ((Vector){row.data + ends.at[1], ends.at[2] - ends.at[1]}), ((Vector){row.data + ends.at[2], ends.at[3] - ends.at[2]}), ((Matrix){((Vector){row.data + ends.at[3], ends.at[4] - ends.at[3]}).data, 3, dof}), ((Vector){row.data + ends.at[4], ends.at[5] - ends.at[4]}), ((Vector){row.data + ends.at[5], ends.at[6] - ends.at[5]}), ((Matrix){((Vector){row.data + ends.at[6], ends.at[7] - ends.at[6]}).data, 2, dof}), ((Vector){row.data + ends.at[7], ends.at[8] - ends.at[7]}), ((Matrix){((Vector){row.data + ends.at[8], row.size0 - ends.at[8]}).data, int_quotient(((row.size0) - ends.at[8]), 18), 18})});
}

/* Compute the columns at which all parts of a row but the last end, in their order.
 *
 * iiwa_dnn/control/command.py: row_ends */
static int_9 control_command_row_ends(struct arena *arena, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p, ptrdiff_t dof)
{
    (void)arena;
    ptrdiff_t at_point;
    ptrdiff_t at_figures;
    ptrdiff_t at_placement;
    ptrdiff_t at_past;
    ptrdiff_t at_dq;
    ptrdiff_t at_decision;
    ptrdiff_t at_bounds;
    ptrdiff_t at_blocking;
    ptrdiff_t at_targets;
    at_point = ((((n + m) + p) * (n + 1)) + (2 * n));
    at_figures = (((at_point + (2 * n)) + m) + p);
    at_placement = (at_figures + 5);
    at_past = (at_placement + 12);
    at_dq = (at_past + (3 * dof));
    at_decision = (at_dq + dof);
    at_bounds = (at_decision + 4);
    at_blocking = (at_bounds + (2 * dof));
    at_targets = ((at_blocking + n) + m);
    return ((int_9){{at_point, at_figures, at_placement, at_past, at_dq, at_decision, at_bounds, at_blocking, at_targets}});
}

/* Write values (k,) into the first k of `out`.
 *
 * iiwa_dnn/control/relaxed.py: copied */
static void control_relaxed_copied(struct arena *arena, Vector out, Vector values)
{
    (void)arena;
    for (ptrdiff_t i = 0, end_i = (values.size0); i < end_i; i++) {
        out.data[i] = values.data[i];
    }
    return;
}

/* Write the targets (k, 18) of all paths at time t [s]; the constants begin with their base.
 *
 * iiwa_dnn/control/step.py: sample_targets */
static void control_step_sample_targets(struct arena *arena, const program_ProgramArrays *arrays, double t, Matrix targets)
{
    (void)arrays;
    IntMatrix table;
    ptrdiff_t first;
    double period;
    Vector own;
    Vector target;
    Vector base;
    Vector move;
    Vector then;
    const struct arena mark = *arena;
    table = ((IntMatrix){(ptrdiff_t *)table_table, 8, 7});
    first = (2 + table.data[4]);
    period = ((double)1.0 / ((double)1000.0));
    for (ptrdiff_t k = first, end_k = table.size0; k < end_k; k++) {
        own = ((Vector){((Vector){(double *)table_constants, 78}).data + table.data[k * table.size1 + 4], table.data[k * table.size1 + 5] - table.data[k * table.size1 + 4]});
        target = ((Vector){targets.data + (k - first) * targets.size1, targets.size1});
        base = ((Vector){own.data, (target.size0) - 0});
        move = ((Vector){own.data + (target.size0), own.size0 - (target.size0)});
        control_relaxed_copied(arena, target, base);
        references_base_enter_path(arena, table.data[k * table.size1 + 1], t, move, target);
        if (table.data[k * table.size1 + 2] != 0) {
            then = ((Vector){arena_copy(arena, base.data, base.size0), base.size0});
            references_base_enter_path(arena, table.data[k * table.size1 + 1], (t + period), move, then);
            references_rotations_set_mean_twist(arena, target, then, period);
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Enter a path's function at an address; it moves the target (18,) at time t [s]. */
static void references_base_enter_path(struct arena *arena, ptrdiff_t address, double t, Vector constants, Vector target)
{
    if (address == 7) references_shapes_heart_path(arena, t, constants, target);
}

/* Set the twist of a target (18,) to the mean one towards another, a period dt [s] later.
 *
 * iiwa_dnn/references/rotations.py: set_mean_twist */
static void references_rotations_set_mean_twist(struct arena *arena, Vector now, Vector then, double dt)
{
    Matrix relative;
    Vector turn;
    const struct arena mark = *arena;
    relative = ((Matrix){arena_empty(arena, 3 * 3), 3, 3});
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        for (ptrdiff_t j = 0, end_j = 3; j < end_j; j++) {
            relative.data[i * relative.size1 + j] = references_rotations_dot(arena, references_rotations_row_of(arena, then, i), references_rotations_row_of(arena, now, j));
        }
    }
    turn = ((Vector){arena_empty(arena, 3), 3});
    references_rotations_rotation_log(arena, relative, turn);
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        now.data[(12 + i)] = ((double)(then.data[i] - now.data[i]) / dt);
        now.data[(15 + i)] = ((double)turn.data[i] / dt);
    }
    arena_leave(arena, &mark);
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
    ptrdiff_t kind;
    ptrdiff_t address;
    ptrdiff_t first;
    ptrdiff_t rows;
    Vector own;
    Vector target;
    Matrix A;
    Vector b;
    Matrix G;
    const struct arena mark = *arena;
    table = ((IntMatrix){(ptrdiff_t *)table_table, 8, 7});
    constants = ((Vector){(double *)table_constants, 78});
    step = ((step_StepViews){t, ((double)1000.0), ((Vector){past.data, past.size1}), ((Vector){past.data + 1 * past.size1, past.size1}), ((Vector){past.data + 2 * past.size1, past.size1}), (*arrays).jacobian, (*arrays).placements, ((Matrix){(double *)table_moves, 18, 7}), ((Matrix){NULL, 7, 7}), targets});
    qp = qp_layout_qp_views(arena, data, table.data[0], table.data[1], table.data[2]);
    for (ptrdiff_t own_k = 0, own_end = ((Vector){data.data, data.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){data.data, data.size0 - 0}).data[own_k] = 0.0;
    for (ptrdiff_t own_k = 0, own_end = ((Vector){qp.lb.data, qp.lb.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){qp.lb.data, qp.lb.size0 - 0}).data[own_k] = (-INFINITY);
    for (ptrdiff_t own_k = 0, own_end = ((Vector){qp.ub.data, qp.ub.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){qp.ub.data, qp.ub.size0 - 0}).data[own_k] = INFINITY;
    for (ptrdiff_t k = 1, end_k = (1 + table.data[4]); k < end_k; k++) {
        kind = table.data[k * table.size1];
        address = table.data[k * table.size1 + 1];
        first = table.data[k * table.size1 + 2];
        rows = table.data[k * table.size1 + 3];
        own = ((Vector){constants.data + table.data[k * table.size1 + 4], table.data[k * table.size1 + 5] - table.data[k * table.size1 + 4]});
        target = ((Vector){step.targets.data + table.data[k * table.size1 + 6] * step.targets.size1, step.targets.size1});
        if (kind == 0) {
            schemes_parts_enter_cost(arena, address, &step, own, qp.P, qp.q);
        }
        else {
            if (kind == 1) {
                A = ((Matrix){qp.A.data + first * qp.A.size1, (first + rows) - first, qp.A.size1});
                schemes_parts_enter_task(arena, address, &step, own, target, A, ((Vector){qp.b.data + first, (first + rows) - first}));
            }
            else {
                if (kind == 2) {
                    A = ((Matrix){arena_zeros(arena, rows * (qp.q.size0)), rows, (qp.q.size0)});
                    b = ((Vector){arena_zeros(arena, rows), rows});
                    schemes_parts_enter_task(arena, address, &step, own, target, A, b);
                    schemes_program_add_soft(arena, &qp, A, b, constants.data[table.data[k * table.size1 + 5]]);
                }
                else {
                    G = ((Matrix){qp.G.data + first * qp.G.size1, (first + rows) - first, qp.G.size1});
                    schemes_parts_enter_limit(arena, address, &step, own, G, ((Vector){qp.h.data + first, (first + rows) - first}), qp.lb, qp.ub);
                }
            }
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* Make the views of a program's flat array, `QP.data` (size,), which has to outlive them.
 *
 * iiwa_dnn/qp/layout.py: qp_views */
static layout_QPViews qp_layout_qp_views(struct arena *arena, Vector data, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p)
{
    ptrdiff_t at_q;
    ptrdiff_t at_G;
    ptrdiff_t at_A;
    ptrdiff_t at_lb;
    ptrdiff_t at_h;
    ptrdiff_t at_b;
    const int_4 own_0 = qp_layout_offsets(arena, n, m, p);
    at_q = own_0.at[0];
    at_G = own_0.at[1];
    at_A = own_0.at[2];
    at_lb = own_0.at[3];
    at_h = (at_G + (m * n));
    at_b = (at_A + (p * n));
    return ((layout_QPViews){((Matrix){((Vector){data.data, at_q - 0}).data, n, n}), ((Vector){data.data + at_q, at_G - at_q}), ((Matrix){((Vector){data.data + at_G, at_h - at_G}).data, m, n}), ((Vector){data.data + at_h, at_A - at_h}), ((Matrix){((Vector){data.data + at_A, at_b - at_A}).data, p, n}), ((Vector){data.data + at_b, at_lb - at_b}), ((Vector){data.data + at_lb, (at_lb + n) - at_lb}), ((Vector){data.data + (at_lb + n), (at_lb + (2 * n)) - (at_lb + n)})});
}

/* Compute ``(at_q, at_G, at_A, at_lb)``, the beginnings of the parts of `QP.data`.
 *
 * iiwa_dnn/qp/layout.py: offsets */
static int_4 qp_layout_offsets(struct arena *arena, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p)
{
    (void)arena;
    ptrdiff_t at_q;
    ptrdiff_t at_G;
    ptrdiff_t at_A;
    at_q = (n * n);
    at_G = (at_q + n);
    at_A = ((at_G + (m * n)) + m);
    return ((int_4){{at_q, at_G, at_A, ((at_A + (p * n)) + p)}});
}

/* Enter a cost's kernel, with constants (k,), P (n, n) and the cost vector q (n,). */
static void schemes_parts_enter_cost(struct arena *arena, ptrdiff_t address, const step_StepViews *step, Vector constants, Matrix P, Vector q)
{
    if (address == 1) schemes_costs_add_kinetic_energy(arena, step, constants, P, q);
    if (address == 2) schemes_costs_add_cyclic_motion(arena, step, constants, P, q);
}

/* Enter a task's kernel, with constants (k,), target (18,), A (rows, n), b (rows,). */
static void schemes_parts_enter_task(struct arena *arena, ptrdiff_t address, const step_StepViews *step, Vector constants, Vector target, Matrix A, Vector b)
{
    if (address == 3) schemes_tasks_position_rows(arena, step, constants, target, A, b);
    if (address == 4) schemes_tasks_rotation_rows(arena, step, constants, target, A, b);
}

/* Add weight A^T A to P and -weight A^T b to q, for rows A (rows, n) and b (rows,).
 *
 * iiwa_dnn/schemes/program.py: _add_soft */
static void schemes_program_add_soft(struct arena *arena, const layout_QPViews *qp, Matrix A, Vector b, double weight)
{
    (void)arena;
    double scaled;
    for (ptrdiff_t k = 0, end_k = (b.size0); k < end_k; k++) {
        for (ptrdiff_t i = 0, end_i = ((*qp).q.size0); i < end_i; i++) {
            scaled = (weight * A.data[k * A.size1 + i]);
            (*qp).q.data[i] -= (scaled * b.data[k]);
            for (ptrdiff_t j = 0, end_j = ((*qp).q.size0); j < end_j; j++) {
                (*qp).P.data[i * (*qp).P.size1 + j] += (scaled * A.data[k * A.size1 + j]);
            }
        }
    }
    return;
}

/* Enter a limit's kernel, with constants (k,), G (rows, n), h (rows,), lb and ub (n,). */
static void schemes_parts_enter_limit(struct arena *arena, ptrdiff_t address, const step_StepViews *step, Vector constants, Matrix G, Vector h, Vector lb, Vector ub)
{
    if (address == 5) schemes_limits_joint_limits(arena, step, constants, G, h, lb, ub);
}

/* Note what the program in a row was built at, and that it is not answered yet.
 *
 * iiwa_dnn/control/step.py: _note_instant */
static void control_step_note_instant(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past)
{
    IntMatrix table;
    ptrdiff_t dof;
    layout_QPViews qp;
    table = ((IntMatrix){(ptrdiff_t *)table_table, 8, 7});
    dof = table.data[3];
    qp = qp_layout_qp_views(arena, (*views).program, table.data[0], table.data[1], table.data[2]);
    control_relaxed_copied(arena, ((Vector){(*views).past.data, (3 * dof)}), ((Vector){((Matrix){past.data, 3 - 0, past.size1}).data, (3 * dof)}));
    control_relaxed_copied(arena, ((Vector){(*views).bounds.data, (*views).bounds.size1}), ((Vector){qp.lb.data, dof - 0}));
    control_relaxed_copied(arena, ((Vector){(*views).bounds.data + 1 * (*views).bounds.size1, (*views).bounds.size1}), ((Vector){qp.ub.data, dof - 0}));
    control_relaxed_copied(arena, (*views).placement, ((Vector){(*arrays).placements.data + table.data[5] * (*arrays).placements.size1, (*arrays).placements.size1}));
    for (ptrdiff_t own_k = 0, own_end = ((Vector){(*views).figures.data, (*views).figures.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).figures.data, (*views).figures.size0 - 0}).data[own_k] = 0.0;
    for (ptrdiff_t own_k = 0, own_end = ((Vector){(*views).decision.data, (*views).decision.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).decision.data, (*views).decision.size0 - 0}).data[own_k] = 0.0;
    for (ptrdiff_t own_k = 0, own_end = ((Vector){(*views).blocking.data, (*views).blocking.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).blocking.data, (*views).blocking.size0 - 0}).data[own_k] = 0.0;
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
    (void)arrays;
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
    table = ((IntMatrix){(ptrdiff_t *)table_table, 8, 7});
    entry = ((IntVector){table.data + (1 + table.data[4]) * table.size1, table.size1});
    own = ((Vector){((Vector){(double *)table_constants, 78}).data + entry.data[4], entry.data[5] - entry.data[4]});
    qp = qp_layout_qp_views(arena, (*views).program, table.data[0], table.data[1], table.data[2]);
    before = ((Vector){arena_copy(arena, state.data, state.size0), state.size0});
    const double_5 own_5 = integrators_base_enter_answer(arena, entry.data[1], &qp, entry.data[2], own, state, (*views).point);
    iterations = own_5.at[0];
    time = own_5.at[1];
    primal = own_5.at[2];
    dual = own_5.at[3];
    gap = own_5.at[4];
    (*views).figures.data[0] = iterations;
    (*views).figures.data[1] = time;
    (*views).figures.data[2] = primal;
    (*views).figures.data[3] = dual;
    (*views).figures.data[4] = gap;
    (*views).decision.data[1] = 1.0;
    (*views).decision.data[2] = control_step_status_of(arena, primal, dual, gap, own, state);
    if ((*views).decision.data[2] >= 2) {
        control_relaxed_copied(arena, state, before);
        const bool own_result = false;
        arena_leave(arena, &mark);
        return own_result;
    }
    control_relaxed_copied(arena, (*views).dq, ((Vector){(*views).point.data, ((*views).dq.size0) - 0}));
    const bool own_result = true;
    arena_leave(arena, &mark);
    return own_result;
}

/* Enter a compiled answer at an address.
 *
 * It advances the state (size,), by a time or until it has settled, writes the point
 * (2n + m + p,) that it stands for, and returns what `Answered` holds. `rates` is the address of
 * the network's function, and the constants are (k,). */
static double_5 integrators_base_enter_answer(struct arena *arena, ptrdiff_t address, const layout_QPViews *qp, ptrdiff_t rates, Vector constants, Vector state, Vector point)
{
    if (address == 6) return integrators_implicit_settle(arena, qp, rates, constants, state, point);
    const double_5 none = {0};
    return none;
}

/* Judge an answer by its residuals; one that was advanced by its state (size,) too.
 *
 * The point of an infinite state is finite, since it is clipped to the bounds. `own` are the
 * constants of the network.
 *
 * iiwa_dnn/control/step.py: status_of */
static ptrdiff_t control_step_status_of(struct arena *arena, double primal, double dual, double gap, Vector own, Vector state)
{
    double size;
    size = ((primal + dual) + gap);
    if (own.data[2] > 0.0) {
        for (ptrdiff_t i = 0, end_i = (state.size0); i < end_i; i++) {
            size += fabs(state.data[i]);
        }
    }
    if (!(size < INFINITY)) {
        return 3;
    }
    if (own.data[2] > 0.0) {
        return 1;
    }
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
    rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){following.data + 1 * following.size1, following.size1}));
    following.data[4 * following.size1] = double_max(rest, 0.0);
    return (rest >= 0.0);
}

/* Compute `stopping_time` of a command x (dof,); 0 if no distance is kept.
 *
 * iiwa_dnn/control/yielding.py: _periods_to_rest */
static double control_yielding_periods_to_rest(struct arena *arena, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector x)
{
    double rest;
    rest = 0.0;
    if (((ptrdiff_t)0)) {
        rest = control_stopping_enter_stopping_time(arena, ((ptrdiff_t)0), &(*arrays), past, &(*yielding), x);
    }
    return rest;
}

/* Enter `stopping_time` at an address: controllers without scenes are exported without it. */
static double control_stopping_enter_stopping_time(struct arena *arena, ptrdiff_t address, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, Vector dq)
{
    (void)arena;
    (void)address;
    (void)arrays;
    (void)past;
    (void)yielding;
    (void)dq;
    const double none = {0};
    return none;
}

/* Check that data[start:end] of (k,) is finite: NaN and infinity times zero are NaN.
 *
 * iiwa_dnn/qp/dense.py: all_finite */
static bool qp_dense_all_finite(struct arena *arena, Vector data, ptrdiff_t start, ptrdiff_t end)
{
    (void)arena;
    double total;
    total = 0.0;
    for (ptrdiff_t k = start, end_k = end; k < end_k; k++) {
        total += (data.data[k] * 0.0);
    }
    return (total == 0.0);
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
static ptrdiff_t control_yielding_yield_step(struct arena *arena, const command_RowViews *views, const program_ProgramArrays *arrays, Matrix past, Matrix following, Vector state, const relaxed_Yielding *yielding, Vector relaxed, ptrdiff_t action)
{
    IntMatrix table;
    ptrdiff_t dof;
    layout_QPViews qp;
    Vector data;
    layout_QPViews own;
    ptrdiff_t kind;
    double factor;
    double rest;
    double found;
    Vector x;
    layout_QPViews limits;
    ptrdiff_t missing;
    double primal;
    double dual;
    double gap;
    const struct arena mark = *arena;
    table = ((IntMatrix){(ptrdiff_t *)table_table, 8, 7});
    dof = table.data[3];
    qp = qp_layout_qp_views(arena, (*views).program, table.data[0], table.data[1], table.data[2]);
    data = ((Vector){arena_copy(arena, (*views).program.data, (*views).program.size0), (*views).program.size0});
    own = qp_layout_qp_views(arena, data, table.data[0], table.data[1], table.data[2]);
    kind = 4;
    factor = 0.0;
    rest = 0.0;
    if (action != -1) {
        control_yielding_widen_bounds(arena, &qp, ((Vector){NULL, 0}), ((Vector){past.data, past.size1}));
        const double_2 own_9 = control_yielding_answer_relaxed(arena, &(*views), &qp, &(*yielding), state, relaxed, action);
        found = own_9.at[0];
        factor = own_9.at[1];
        kind = (ptrdiff_t)(found);
    }
    x = ((Vector){arena_copy(arena, ((Vector){(*views).point.data, (qp.q.size0) - 0}).data, ((Vector){(*views).point.data, (qp.q.size0) - 0}).size0), ((Vector){(*views).point.data, (qp.q.size0) - 0}).size0});
    limits = ((layout_QPViews){qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, own.lb, own.ub});
    if (kind != 4) {
        control_yielding_step(arena, &limits, past, following, &(*yielding), (*views).figures, x);
        rest = control_yielding_make_stoppable(arena, &limits, &(*arrays), past, &(*yielding), &(*views), x);
        missing = control_yielding_note_missing(arena, &(*views), ((Vector){x.data, dof - 0}));
        const double_3 own_20 = qp_residuals_point_residuals(arena, &limits, (*views).point);
        primal = own_20.at[0];
        dual = own_20.at[1];
        gap = own_20.at[2];
        if (missing > 0) {
            kind = ((action == 4) ? 4 : 3);
        }
        else {
            if ((factor == 1.0) && (qp_residuals_within(arena, primal, dual, gap, ((Vector){(double *)table_settings, 2}).data[0]))) {
                kind = 0;
                control_relaxed_copied(arena, qp.lb, own.lb);
                control_relaxed_copied(arena, qp.ub, own.ub);
            }
        }
    }
    if (kind == 4) {
        control_relaxed_copied(arena, (*views).program, data);
        rest = control_yielding_brake(arena, &own, past, &(*yielding), x);
        for (ptrdiff_t own_k = 0, own_end = ((Vector){(*views).point.data, (*views).point.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*views).point.data, (*views).point.size0 - 0}).data[own_k] = 0.0;
        control_relaxed_copied(arena, (*views).point, x);
    }
    control_yielding_note_decision(arena, &(*views), &own, ((Vector){(double *)table_weights, 6}), x, kind, factor, action);
    const double_3 own_43 = qp_residuals_point_residuals(arena, &qp, (*views).point);
    (*views).figures.data[2] = own_43.at[0];
    (*views).figures.data[3] = own_43.at[1];
    (*views).figures.data[4] = own_43.at[2];
    following.data[4 * following.size1] = rest;
    following.data[5 * following.size1] += (((double)0.001) * (1.0 - (*views).decision.data[1]));
    following.data[6 * following.size1] = (0 < kind && kind < 4);
    control_relaxed_copied(arena, (*views).dq, ((Vector){x.data, dof - 0}));
    control_relaxed_copied(arena, ((Vector){following.data + 1 * following.size1, following.size1}), ((Vector){x.data, dof - 0}));
    const ptrdiff_t own_result = (ptrdiff_t)((*views).decision.data[0]);
    arena_leave(arena, &mark);
    return own_result;
}

/* Replace bounds that acceleration limits have narrowed by those of position and velocity.
 *
 * iiwa_dnn/control/yielding.py: _widen_bounds */
static void control_yielding_widen_bounds(struct arena *arena, const layout_QPViews *qp, Vector limits, Vector q)
{
    (void)arena;
    ptrdiff_t dof;
    double fastest;
    dof = int_quotient((limits.size0), 6);
    for (ptrdiff_t i = 0, end_i = dof; i < end_i; i++) {
        fastest = limits.data[((2 * dof) + i)];
        (*qp).lb.data[i] = double_min(double_max((20.0 * (limits.data[i] - q.data[i])), (-fastest)), fastest);
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
static double_2 control_yielding_answer_relaxed(struct arena *arena, const command_RowViews *views, const layout_QPViews *qp, const relaxed_Yielding *yielding, Vector state, Vector relaxed, ptrdiff_t action)
{
    ptrdiff_t n;
    ptrdiff_t m;
    Vector point;
    ptrdiff_t size;
    double factor;
    bool follows;
    Vector asked;
    double retreat;
    bool found;
    const struct arena mark = *arena;
    n = ((*qp).q.size0);
    m = ((*qp).h.size0);
    point = ((Vector){arena_empty(arena, ((((2 * n) + 2) + m) + ((*qp).b.size0))), ((((2 * n) + 2) + m) + ((*qp).b.size0))});
    size = ((((3 * n) + 3) + m) + ((*qp).b.size0));
    factor = control_relaxed_largest_factor(arena, &(*qp), &(*yielding), ((Vector){relaxed.data, size - 0}), point, (*views).figures, false);
    control_relaxed_note_blocking(arena, point, n, m, 1, (*views).blocking);
    follows = ((action == 2) && (control_yielding_is_path(arena, (*views).targets)) && (!control_yielding_races(arena, &(*qp), ((Vector){point.data, n - 0}))));
    if ((factor == 1.0) || ((follows) && (factor >= 0.1))) {
        asked = ((Vector){arena_copy(arena, (*qp).b.data, (*qp).b.size0), (*qp).b.size0});
        control_relaxed_scale_task(arena, &(*qp), ((Vector){(double *)table_weights, 6}), factor);
        if (control_relaxed_settled(arena, &(*qp), &(*yielding), state, (*views).point, (*views).figures, 1.0)) {
            const double_2 own_result = ((double_2){{1, factor}});
            arena_leave(arena, &mark);
            return own_result;
        }
        control_relaxed_copied(arena, (*qp).b, asked);
    }
    if (action == 4) {
        const double_2 own_result = ((double_2){{4, 0.0}});
        arena_leave(arena, &mark);
        return own_result;
    }
    retreat = 1.0;
    if (factor < 0.0) {
        retreat = control_relaxed_largest_factor(arena, &(*qp), &(*yielding), ((Vector){arena_zeros(arena, size), size}), point, (*views).figures, true);
    }
    if (retreat < 0.0) {
        control_relaxed_note_blocking(arena, point, n, m, 1, (*views).blocking);
        const double_2 own_result = ((double_2){{4, 0.0}});
        arena_leave(arena, &mark);
        return own_result;
    }
    control_relaxed_soften_task(arena, &(*qp), ((Vector){(double *)table_weights, 6}), retreat);
    found = control_relaxed_settled(arena, &(*qp), &(*yielding), ((Vector){relaxed.data + size, relaxed.size0 - size}), (*views).point, (*views).figures, 1.0);
    control_relaxed_note_blocking(arena, (*views).point, n, m, 0, (*views).blocking);
    const double_2 own_result = ((double_2){{((found) ? 2 : 4), 0.0}});
    arena_leave(arena, &mark);
    return own_result;
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
    ptrdiff_t n;
    Vector data;
    layout_QPViews wider;
    double longest;
    double factor;
    const struct arena mark = *arena;
    n = ((*qp).q.size0);
    data = ((Vector){arena_zeros(arena, control_relaxed_data_size(arena, (n + 1), ((*qp).h.size0), ((*qp).b.size0))), control_relaxed_data_size(arena, (n + 1), ((*qp).h.size0), ((*qp).b.size0))});
    wider = qp_layout_qp_views(arena, data, (n + 1), ((*qp).h.size0), ((*qp).b.size0));
    control_relaxed_copy_cost(arena, &(*qp), &wider);
    control_relaxed_copy_limits(arena, &(*qp), &wider);
    longest = control_relaxed_largest_entry(arena, (*qp).b);
    if ((retreats) || (longest == 0.0)) {
        longest = 1.0;
    }
    wider.q.data[n] = (-1.0);
    wider.ub.data[n] = longest;
    for (ptrdiff_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        if ((retreats) && ((*qp).h.data[j] < 0.0)) {
            wider.G.data[j * wider.G.size1 + n] = (-(*qp).h.data[j]);
            wider.h.data[j] = 0.0;
        }
    }
    for (ptrdiff_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        if (((Vector){(double *)table_weights, 6}).data[j] == 0.0) {
            control_relaxed_copied(arena, ((Vector){wider.A.data + j * wider.A.size1, wider.A.size1}), ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1}));
            wider.b.data[j] = (*qp).b.data[j];
        }
        else {
            if (!retreats) {
                control_relaxed_copied(arena, ((Vector){wider.A.data + j * wider.A.size1, wider.A.size1}), ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1}));
                wider.A.data[j * wider.A.size1 + n] = ((double)(-(*qp).b.data[j]) / longest);
            }
        }
    }
    if (!control_relaxed_settled(arena, &wider, &(*yielding), state, point, figures, 10.0)) {
        const double own_result = (-1.0);
        arena_leave(arena, &mark);
        return own_result;
    }
    factor = double_max(((double)point.data[n] / longest), 0.0);
    const double own_result = ((factor >= 0.999999999) ? 1.0 : (0.999 * factor));
    arena_leave(arena, &mark);
    return own_result;
}

/* Count the numbers of a program, `QP.data`.
 *
 * iiwa_dnn/control/relaxed.py: data_size */
static ptrdiff_t control_relaxed_data_size(struct arena *arena, ptrdiff_t n, ptrdiff_t m, ptrdiff_t p)
{
    (void)arena;
    return ((((n + m) + p) * (n + 1)) + (2 * n));
}

/* Write w times the cost into a program that has more variables.
 *
 * iiwa_dnn/control/relaxed.py: _copy_cost */
static void control_relaxed_copy_cost(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other)
{
    ptrdiff_t n;
    double largest;
    double weight;
    n = ((*qp).q.size0);
    largest = double_max(control_relaxed_largest_entry(arena, (*qp).q), control_relaxed_largest_entry(arena, ((Vector){(*qp).P.data, (n * n)})));
    weight = ((double)1e-05 / double_max(largest, 1e-300));
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        (*other).q.data[i] = (weight * (*qp).q.data[i]);
        for (ptrdiff_t k = 0, end_k = n; k < end_k; k++) {
            (*other).P.data[i * (*other).P.size1 + k] = (weight * (*qp).P.data[i * (*qp).P.size1 + k]);
        }
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
    largest = 0.0;
    for (ptrdiff_t i = 0, end_i = (values.size0); i < end_i; i++) {
        largest = double_max(largest, fabs(values.data[i]));
    }
    return largest;
}

/* Write bounds and inequality rows into a program that may have more variables.
 *
 * iiwa_dnn/control/relaxed.py: _copy_limits */
static void control_relaxed_copy_limits(struct arena *arena, const layout_QPViews *qp, const layout_QPViews *other)
{
    control_relaxed_copied(arena, (*other).lb, (*qp).lb);
    control_relaxed_copied(arena, (*other).ub, (*qp).ub);
    control_relaxed_copied(arena, (*other).h, (*qp).h);
    for (ptrdiff_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        control_relaxed_copied(arena, ((Vector){(*other).G.data + j * (*other).G.size1, (*other).G.size1}), ((Vector){(*qp).G.data + j * (*qp).G.size1, (*qp).G.size1}));
    }
    return;
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
    (void)yielding;
    Vector settings;
    double systems;
    double time;
    double primal;
    double dual;
    double gap;
    settings = ((Vector){(double *)table_settings, 2});
    for (ptrdiff_t _ = 0, end__ = 2; _ < end__; _++) {
        const double_5 own_1 = integrators_implicit_settle(arena, &(*qp), 0, settings, state, point);
        systems = own_1.at[0];
        time = own_1.at[1];
        primal = own_1.at[2];
        dual = own_1.at[3];
        gap = own_1.at[4];
        figures.data[0] += systems;
        figures.data[1] = time;
        if (qp_residuals_within(arena, primal, dual, gap, (tolerances * settings.data[0]))) {
            return true;
        }
        for (ptrdiff_t own_k = 0, own_end = ((Vector){state.data, state.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){state.data, state.size0 - 0}).data[own_k] = 0.0;
    }
    return false;
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
static void control_relaxed_note_blocking(struct arena *arena, Vector point, ptrdiff_t n, ptrdiff_t m, ptrdiff_t extra, Vector blocking)
{
    ptrdiff_t start;
    Vector multipliers;
    double least;
    double value;
    start = ((((point.size0) - n) - extra) - m);
    multipliers = ((Vector){point.data + start, ((start + m) + n) - start});
    least = (0.0001 * control_relaxed_largest_entry(arena, multipliers));
    for (ptrdiff_t i = 0, end_i = (n + m); i < end_i; i++) {
        value = multipliers.data[((i < n) ? (m + i) : (i - n))];
        blocking.data[i] = 0.0;
        if (fabs(value) > least) {
            blocking.data[i] = copysign(1.0, value);
        }
    }
    return;
}

/* Test whether a target (k, 18) has a velocity.
 *
 * iiwa_dnn/control/yielding.py: _is_path */
static bool control_yielding_is_path(struct arena *arena, Matrix targets)
{
    double fastest;
    fastest = 0.0;
    for (ptrdiff_t k = 0, end_k = targets.size0; k < end_k; k++) {
        fastest = double_max(fastest, control_relaxed_largest_entry(arena, ((Vector){targets.data + k * targets.size1 + 12, targets.size1 - 12})));
    }
    return (fastest > 0.0);
}

/* Test whether joints of the velocity x (n,) race while the tip hardly moves.
 *
 * iiwa_dnn/control/yielding.py: _races */
static bool control_yielding_races(struct arena *arena, const layout_QPViews *qp, Vector x)
{
    double tip;
    tip = 0.0;
    for (ptrdiff_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        tip = double_max(tip, fabs(qp_dense_row_dot(arena, (*qp).A, j, x)));
    }
    return (tip < (0.05 * control_relaxed_largest_entry(arena, x)));
}

/* Turn a step's program, with task rows of some weights (p,), into the scaled one.
 *
 * iiwa_dnn/control/relaxed.py: scale_task */
static void control_relaxed_scale_task(struct arena *arena, const layout_QPViews *qp, Vector weights, double factor)
{
    (void)arena;
    for (ptrdiff_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        if (weights.data[j] > 0.0) {
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
    ptrdiff_t n;
    double shrink;
    double drift;
    n = ((*qp).q.size0);
    shrink = ((double)10.0 / double_max(10.0, control_relaxed_largest_entry(arena, (*qp).b)));
    drift = ((double)0.02 / double_max(control_relaxed_largest_entry(arena, (*qp).q), 1.0));
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        (*qp).q.data[i] *= ((0.05 * 0.05) * drift);
        for (ptrdiff_t k = 0, end_k = n; k < end_k; k++) {
            (*qp).P.data[i * (*qp).P.size1 + k] *= 0.0001;
        }
        (*qp).P.data[i * (*qp).P.size1 + i] += (0.05 * 0.05);
    }
    for (ptrdiff_t j = 0, end_j = ((*qp).b.size0); j < end_j; j++) {
        if (weights.data[j] > 0.0) {
            control_relaxed_move_into_cost(arena, &(*qp), j, (weights.data[j] * weights.data[j]), shrink);
        }
    }
    for (ptrdiff_t j = 0, end_j = ((*qp).h.size0); j < end_j; j++) {
        if ((*qp).h.data[j] < 0.0) {
            (*qp).h.data[j] *= retreat;
        }
    }
    return;
}

/* Move equality row j into the cost, with the square of its weight; its b is shrunk.
 *
 * iiwa_dnn/control/relaxed.py: _move_into_cost */
static void control_relaxed_move_into_cost(struct arena *arena, const layout_QPViews *qp, ptrdiff_t j, double square, double shrink)
{
    (void)arena;
    ptrdiff_t n;
    double rhs;
    n = ((*qp).q.size0);
    rhs = ((square * shrink) * (*qp).b.data[j]);
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        (*qp).q.data[i] -= (rhs * (*qp).A.data[j * (*qp).A.size1 + i]);
        for (ptrdiff_t k = 0, end_k = n; k < end_k; k++) {
            (*qp).P.data[i * (*qp).P.size1 + k] += ((square * (*qp).A.data[j * (*qp).A.size1 + i]) * (*qp).A.data[j * (*qp).A.size1 + k]);
        }
    }
    for (ptrdiff_t own_k = 0, own_end = ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1 - 0}).size0; own_k < own_end; own_k++) ((Vector){(*qp).A.data + j * (*qp).A.size1, (*qp).A.size1 - 0}).data[own_k] = 0.0;
    (*qp).b.data[j] = 0.0;
    return;
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
    if ((((Vector){NULL, 0}).size0) == 0) {
        return;
    }
    control_relaxed_copied(arena, ((Vector){following.data + 3 * following.size1, following.size1}), ((Vector){x.data, past.size1 - 0}));
    if (((bool)false)) {
        control_yielding_step_straight(arena, past, &(*yielding), x);
    }
    else {
        control_yielding_step_towards(arena, &(*limits), past, &(*yielding), x);
    }
    control_relaxed_nearest_within(arena, &(*limits), x, &(*yielding), figures);
    return;
}

/* Replace the wanted velocity x (n,) by the next command on the straight line to it.
 *
 * iiwa_dnn/control/yielding.py: _step_straight */
static void control_yielding_step_straight(struct arena *arena, Matrix past, const relaxed_Yielding *yielding, Vector x)
{
    (void)yielding;
    ptrdiff_t dof;
    Vector now;
    Vector before;
    double periods;
    const struct arena mark = *arena;
    dof = past.size1;
    now = ((Vector){arena_empty(arena, dof), dof});
    before = ((Vector){arena_empty(arena, dof), dof});
    for (ptrdiff_t i = 0, end_i = dof; i < end_i; i++) {
        now.data[i] = (past.data[1 * past.size1 + i] - x.data[i]);
        before.data[i] = (past.data[2 * past.size1 + i] - x.data[i]);
    }
    periods = control_stopping_least_periods(arena, now, before, ((Vector){NULL, 0}), ((double)0.001), ((bool)false));
    for (ptrdiff_t i = 0, end_i = dof; i < end_i; i++) {
        if (periods < INFINITY) {
            x.data[i] += control_stopping_next_velocity(arena, now.data[i], before.data[i], periods, ((bool)false));
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
    ptrdiff_t fewest;
    ptrdiff_t i;
    accelerations = ((Vector){limits.data + (3 * (x.size0)), (4 * (x.size0)) - (3 * (x.size0))});
    jerks = ((Vector){limits.data + (4 * (x.size0)), (5 * (x.size0)) - (4 * (x.size0))});
    periods = 0.0;
    for (ptrdiff_t i = 0, end_i = (x.size0); i < end_i; i++) {
        fewest = (ptrdiff_t)ceil((((double)fabs(x.data[i]) / (accelerations.data[i] * dt)) * (1.0 - 1e-09)));
        periods = double_max(periods, fewest);
    }
    i = 0;
    while ((cubic) && (i < (x.size0))) {
        if (periods > 1000000.0) {
            return INFINITY;
        }
        if (control_stopping_within_rates(arena, x.data[i], before.data[i], periods, (accelerations.data[i] * dt), ((jerks.data[i] * dt) * dt))) {
            i += 1;
        }
        else {
            periods = double_max(1.0, (ptrdiff_t)ceil((1.1 * periods)));
            i = 0;
        }
    }
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
    if (periods < 0.5) {
        return ((x == 0.0) && (before == 0.0));
    }
    b = control_stopping_bend_of(arena, x, before, periods);
    u = ((double)1.0 / periods);
    largest = double_max(fabs(((6.0 * x) + (4.0 * b))), fabs(((x * (6.0 - (12.0 * u))) + (b * (2.0 - (6.0 * u))))));
    largest = double_max(largest, fabs(((x * (3.0 - (2.0 * u))) + (b * (1.0 - u)))));
    if (((largest * u) * u) > (jerk * (1.0 + 1e-09))) {
        return false;
    }
    most = (accel * (1.0 + 1e-09));
    turn = ((12.0 * x) + (6.0 * b));
    at = ((turn != 0.0) ? ((double)((6.0 * x) + (4.0 * b)) / turn) : 0.0);
    steepest = (fabs((((((-6.0) * x) * at) * (1.0 - at)) + ((b * (1.0 - at)) * (1.0 - (3.0 * at))))) * u);
    if ((u <= at && at < 1.0) && (steepest > most)) {
        return false;
    }
    return (fabs((control_stopping_next_velocity(arena, x, before, periods, true) - x)) <= most);
}

/* Compute b of the cubic through x now and x before, which ends after so many periods.
 *
 * iiwa_dnn/control/stopping.py: bend_of */
static double control_stopping_bend_of(struct arena *arena, double x, double before, double periods)
{
    (void)arena;
    double u;
    u = ((double)1.0 / periods);
    return ((double)((x * ((1.0 - ((3.0 * u) * u)) - (((2.0 * u) * u) * u))) - before) / ((u * (1.0 + u)) * (1.0 + u)));
}

/* Compute the velocity after the first of so many periods on the way to zero [rad/s].
 *
 * iiwa_dnn/control/stopping.py: next_velocity */
static double control_stopping_next_velocity(struct arena *arena, double x, double before, double periods, bool cubic)
{
    double b;
    if (periods < 1.5) {
        return 0.0;
    }
    b = ((cubic) ? control_stopping_bend_of(arena, x, before, periods) : 0.0);
    return control_stopping_velocity_at(arena, x, b, ((double)1.0 / periods), cubic);
}

/* Compute the velocity [rad/s] at a part u of the periods of a motion that begins with x.
 *
 * iiwa_dnn/control/stopping.py: velocity_at */
static double control_stopping_velocity_at(struct arena *arena, double x, double b, double u, bool cubic)
{
    (void)arena;
    double left;
    left = (1.0 - u);
    if (!cubic) {
        return (x * left);
    }
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
    (void)yielding;
    ptrdiff_t dof;
    double most;
    double change;
    double behind;
    double rate;
    dof = past.size1;
    for (ptrdiff_t i = 0, end_i = dof; i < end_i; i++) {
        most = (((Vector){NULL, 0}).data[((3 * dof) + i)] * ((double)0.001));
        change = double_min(double_max((x.data[i] - past.data[3 * past.size1 + i]), (-most)), most);
        behind = (past.data[1 * past.size1 + i] - (x.data[i] - change));
        rate = ((Vector){NULL, 0}).data[((4 * dof) + i)];
        x.data[i] += schemes_limits_braking(arena, behind, ((*limits).lb.data[i] - x.data[i]), ((*limits).ub.data[i] - x.data[i]), rate, ((double)0.001));
    }
    return;
}

/* Compute the command in [lb, ub] that comes to rest quickest, without turning round.
 *
 * iiwa_dnn/schemes/limits.py: braking */
static double schemes_limits_braking(struct arena *arena, double last, double lb, double ub, double jerk, double dt)
{
    double wanted;
    double unit;
    wanted = 0.0;
    unit = ((jerk * dt) * dt);
    if ((jerk < INFINITY) && (last != 0.0)) {
        wanted = (last - copysign((unit * schemes_limits_approach(arena, ((double)fabs(last) / unit))), last));
    }
    return double_min(double_max(wanted, lb), ub);
}

/* Compute the largest x for which x + (x - 1) + (x - 2) + ... down to 0 is within `room`.
 *
 * iiwa_dnn/schemes/limits.py: approach */
static double schemes_limits_approach(struct arena *arena, double room)
{
    (void)arena;
    ptrdiff_t m;
    if ((!(room > 0.0)) || (room == INFINITY)) {
        return room;
    }
    m = (ptrdiff_t)floor((0.5 * (sqrt((1.0 + (8.0 * room))) - 1.0)));
    return (((double)room / (m + 1.0)) + (0.5 * m));
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
    ptrdiff_t n;
    ptrdiff_t m;
    ptrdiff_t outside;
    Vector data;
    layout_QPViews nearest;
    Vector point;
    bool found;
    const struct arena mark = *arena;
    n = (x.size0);
    m = ((*qp).h.size0);
    outside = 0;
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        x.data[i] = double_min(double_max(x.data[i], (*qp).lb.data[i]), (*qp).ub.data[i]);
    }
    for (ptrdiff_t j = 0, end_j = m; j < end_j; j++) {
        outside += (qp_dense_row_dot(arena, (*qp).G, j, x) > (*qp).h.data[j]);
    }
    if (outside == 0) {
        const bool own_result = true;
        arena_leave(arena, &mark);
        return own_result;
    }
    data = ((Vector){arena_zeros(arena, control_relaxed_data_size(arena, n, m, 0)), control_relaxed_data_size(arena, n, m, 0)});
    nearest = qp_layout_qp_views(arena, data, n, m, 0);
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        nearest.P.data[i * nearest.P.size1 + i] = 1.0;
        nearest.q.data[i] = (-x.data[i]);
    }
    control_relaxed_copy_limits(arena, &(*qp), &nearest);
    point = ((Vector){arena_empty(arena, ((2 * n) + m)), ((2 * n) + m)});
    found = control_relaxed_settled(arena, &nearest, &(*yielding), ((Vector){arena_zeros(arena, ((3 * n) + m)), ((3 * n) + m)}), point, figures, 1.0);
    if (found) {
        control_relaxed_copied(arena, x, ((Vector){point.data, n - 0}));
    }
    const bool own_result = found;
    arena_leave(arena, &mark);
    return own_result;
}

/* Bring a command x (n,) nearer to the braking motion in hand until the arm can stop from it.
 *
 * Returns:
 *     Periods until it rests; 0 where none is asked for.
 *
 * iiwa_dnn/control/yielding.py: _make_stoppable */
static double control_yielding_make_stoppable(struct arena *arena, const layout_QPViews *limits, const program_ProgramArrays *arrays, Matrix past, const relaxed_Yielding *yielding, const command_RowViews *views, Vector x)
{
    ptrdiff_t dof;
    double rest;
    Vector wanted;
    Vector brake;
    double left;
    const struct arena mark = *arena;
    dof = past.size1;
    rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){x.data, dof - 0}));
    if (rest >= 0.0) {
        const double own_result = rest;
        arena_leave(arena, &mark);
        return own_result;
    }
    wanted = ((Vector){arena_copy(arena, ((Vector){(*views).point.data, (x.size0) - 0}).data, ((Vector){(*views).point.data, (x.size0) - 0}).size0), ((Vector){(*views).point.data, (x.size0) - 0}).size0});
    if ((((Vector){NULL, 0}).size0)) {
        control_yielding_step_straight(arena, past, &(*yielding), wanted);
        control_relaxed_nearest_within(arena, &(*limits), wanted, &(*yielding), (*views).figures);
    }
    brake = ((Vector){arena_zeros(arena, (x.size0)), (x.size0)});
    left = control_yielding_brake(arena, &(*limits), past, &(*yielding), brake);
    for (ptrdiff_t k = 0, end_k = ((Vector){(double *)yielding_TOWARDS, 4}).size0; k < end_k; k++) {
        for (ptrdiff_t i = 0, end_i = dof; i < end_i; i++) {
            x.data[i] = (brake.data[i] + (((Vector){(double *)yielding_TOWARDS, 4}).data[k] * (wanted.data[i] - brake.data[i])));
        }
        rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){x.data, dof - 0}));
        if (rest >= 0.0) {
            const double own_result = rest;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    if ((!((bool)false)) && (control_yielding_go_away(arena, &(*limits), ((Vector){past.data + 1 * past.size1, past.size1}), ((Vector){x.data, dof - 0})))) {
        rest = control_yielding_periods_to_rest(arena, &(*arrays), past, &(*yielding), ((Vector){x.data, dof - 0}));
        if (rest >= 0.0) {
            const double own_result = rest;
            arena_leave(arena, &mark);
            return own_result;
        }
    }
    control_relaxed_copied(arena, x, brake);
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
    (void)yielding;
    double rest;
    double periods;
    for (ptrdiff_t own_k = 0, own_end = ((Vector){dq.data, dq.size0 - 0}).size0; own_k < own_end; own_k++) ((Vector){dq.data, dq.size0 - 0}).data[own_k] = 0.0;
    if ((((Vector){NULL, 0}).size0) == 0) {
        return 0.0;
    }
    rest = past.data[4 * past.size1];
    periods = rest;
    if (rest == 0.0) {
        periods = control_stopping_least_periods(arena, ((Vector){past.data + 1 * past.size1, past.size1}), ((Vector){past.data + 2 * past.size1, past.size1}), ((Vector){NULL, 0}), ((double)0.001), ((bool)false));
    }
    for (ptrdiff_t i = 0, end_i = past.size1; i < end_i; i++) {
        if (periods < INFINITY) {
            dq.data[i] = control_stopping_next_velocity(arena, past.data[1 * past.size1 + i], past.data[2 * past.size1 + i], periods, ((bool)false));
        }
        if (rest == 0.0) {
            dq.data[i] = double_min(double_max(dq.data[i], (*limits).lb.data[i]), (*limits).ub.data[i]);
        }
    }
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
    ptrdiff_t near;
    double least;
    double most;
    rests = (control_relaxed_largest_entry(arena, last) == 0.0);
    near = 0;
    control_relaxed_copied(arena, dq, last);
    for (ptrdiff_t j = 0, end_j = ((*limits).h.size0); j < end_j; j++) {
        if ((*limits).h.data[j] < (-1e-09)) {
            near += 1;
            qp_dense_add_row(arena, dq, ((-1.0) * rests), (*limits).G, j);
        }
    }
    least = 0.0;
    most = INFINITY;
    for (ptrdiff_t i = 0, end_i = (dq.size0); i < end_i; i++) {
        if (dq.data[i] != 0.0) {
            least = double_max(least, double_min(((double)(*limits).lb.data[i] / dq.data[i]), ((double)(*limits).ub.data[i] / dq.data[i])));
            most = double_min(most, double_max(((double)(*limits).lb.data[i] / dq.data[i]), ((double)(*limits).ub.data[i] / dq.data[i])));
        }
    }
    if ((near == 0) || (!(least <= most && most < INFINITY))) {
        return false;
    }
    for (ptrdiff_t i = 0, end_i = (dq.size0); i < end_i; i++) {
        dq.data[i] *= most;
    }
    return true;
}

/* Note the joints whose command dq (dof,) is short of the answer; return how many are.
 *
 * iiwa_dnn/control/yielding.py: _note_missing */
static ptrdiff_t control_yielding_note_missing(struct arena *arena, const command_RowViews *views, Vector dq)
{
    (void)arena;
    ptrdiff_t count;
    double missing;
    count = 0;
    for (ptrdiff_t i = 0, end_i = (dq.size0); i < end_i; i++) {
        missing = ((*views).point.data[i] - dq.data[i]);
        if (fabs(missing) > 1e-09) {
            (*views).blocking.data[i] = copysign(1.0, missing);
            count += 1;
        }
    }
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
static void control_yielding_note_decision(struct arena *arena, const command_RowViews *views, const layout_QPViews *own, Vector weights, Vector x, ptrdiff_t kind, double factor, ptrdiff_t action)
{
    ptrdiff_t taken;
    double fraction;
    taken = 4;
    fraction = 0.0;
    if (kind <= 1) {
        taken = ((factor == 1.0) ? 0 : 2);
        fraction = factor;
    }
    else {
        if (kind != 4) {
            taken = (((kind == 3) || (control_yielding_is_path(arena, (*views).targets))) ? action : 3);
            fraction = 1.0;
            if (taken == 2) {
                fraction = double_max(control_relaxed_attained(arena, (*own).b, (*own).A, weights, x), 0.1);
            }
        }
    }
    (*views).decision.data[0] = taken;
    (*views).decision.data[1] = fraction;
    (*views).decision.data[2] = ((taken == 4) ? double_max((*views).decision.data[2], (double)(2)) : 0);
    (*views).decision.data[3] = kind;
    return;
}

/* Compute the share of a task velocity b (p,) that joint velocities x (n,) give, at most 1.
 *
 * iiwa_dnn/control/relaxed.py: attained */
static double control_relaxed_attained(struct arena *arena, Vector b, Matrix A, Vector weights, Vector x)
{
    double asked;
    double given;
    double rhs;
    asked = 0.0;
    given = 0.0;
    for (ptrdiff_t j = 0, end_j = (b.size0); j < end_j; j++) {
        rhs = ((weights.data[j] * weights.data[j]) * b.data[j]);
        asked += (rhs * b.data[j]);
        given += (rhs * qp_dense_row_dot(arena, A, j, x));
    }
    return ((asked > 0.0) ? double_min(((double)given / asked), 1.0) : 1.0);
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
    placed = ((Matrix){arena_zeros(arena, ((q.size0) + 1) * 12), ((q.size0) + 1), 12});
    start = ((Vector){arena_empty(arena, 12), 12});
    motion = ((Vector){arena_zeros(arena, 12), 12});
    motion.data[8] = 1.0;
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        placed.data[(4 * i)] = 1.0;
    }
    for (ptrdiff_t j = 0, end_j = (q.size0); j < end_j; j++) {
        angle = (((Matrix){(double *)table_kinds, 7, 2}).data[j * ((Matrix){(double *)table_kinds, 7, 2}).size1 + 1] * q.data[j]);
        motion.data[0] = cos(angle);
        motion.data[1] = sin(angle);
        motion.data[3] = (-motion.data[1]);
        motion.data[4] = motion.data[0];
        motion.data[11] = (((Matrix){(double *)table_kinds, 7, 2}).data[j * ((Matrix){(double *)table_kinds, 7, 2}).size1] * q.data[j]);
        robot_kinematics_kernel_compose(arena, ((Vector){placed.data + ((IntVector){(ptrdiff_t *)table_parents, 7}).data[j] * placed.size1, placed.size1}), ((Vector){((Matrix){(double *)table_joints, 7, 12}).data + j * ((Matrix){(double *)table_joints, 7, 12}).size1, ((Matrix){(double *)table_joints, 7, 12}).size1}), start);
        robot_kinematics_kernel_compose(arena, start, motion, ((Vector){placed.data + (j + 1) * placed.size1, placed.size1}));
        robot_kinematics_kernel_write_twist(arena, ((Vector){placed.data + (j + 1) * placed.size1, placed.size1}), ((Vector){((Matrix){(double *)table_kinds, 7, 2}).data + j * ((Matrix){(double *)table_kinds, 7, 2}).size1, ((Matrix){(double *)table_kinds, 7, 2}).size1}), ((Vector){jacobian.data + j * jacobian.size1, jacobian.size1}));
    }
    for (ptrdiff_t k = 0, end_k = ((IntMatrix){(ptrdiff_t *)table_frames, 2, 2}).size0; k < end_k; k++) {
        carrier = ((Vector){placed.data + ((IntMatrix){(ptrdiff_t *)table_frames, 2, 2}).data[k * ((IntMatrix){(ptrdiff_t *)table_frames, 2, 2}).size1 + 1] * placed.size1, placed.size1});
        robot_kinematics_kernel_compose(arena, carrier, ((Vector){((Matrix){(double *)table_offsets, 2, 12}).data + k * ((Matrix){(double *)table_offsets, 2, 12}).size1, ((Matrix){(double *)table_offsets, 2, 12}).size1}), ((Vector){placements.data + ((IntMatrix){(ptrdiff_t *)table_frames, 2, 2}).data[k * ((IntMatrix){(ptrdiff_t *)table_frames, 2, 2}).size1] * placements.size1, placements.size1}));
    }
    if (((Matrix){NULL, 0, 16}).size0 > 0) {
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
    for (ptrdiff_t k = 0, end_k = 4; k < end_k; k++) {
        for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
            product.data[((3 * k) + i)] = (((first.data[i] * second.data[(3 * k)]) + (first.data[(3 + i)] * second.data[((3 * k) + 1)])) + (first.data[(6 + i)] * second.data[((3 * k) + 2)]));
        }
    }
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
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
    axis = ((Vector){placement.data + 6, 9 - 6});
    position = ((Vector){placement.data + 9, placement.size0 - 9});
    for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
        twist.data[(3 + i)] = (kind.data[1] * axis.data[i]);
        moment = (position.data[((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)]] * axis.data[((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)]]);
        moment -= (position.data[((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)]] * axis.data[((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)]]);
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
    (void)model;
    ptrdiff_t n;
    Vector own;
    Matrix moved;
    double factor;
    double along;
    double turned;
    const struct arena mark = *arena;
    n = inertia.size0;
    own = ((Vector){arena_empty(arena, 12), 12});
    moved = ((Matrix){arena_empty(arena, n * 6), n, 6});
    for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
        for (ptrdiff_t j = 0, end_j = n; j < end_j; j++) {
            inertia.data[i * inertia.size1 + j] = ((i == j) ? ((Vector){(double *)table_armature, 7}).data[i] : 0.0);
        }
    }
    for (ptrdiff_t body = 0, end_body = n; body < end_body; body++) {
        robot_kinematics_kernel_compose(arena, ((Vector){placed.data + (body + 1) * placed.size1, placed.size1}), ((Vector){((Matrix){NULL, 0, 16}).data + body * ((Matrix){NULL, 0, 16}).size1, 12 - 0}), own);
        for (ptrdiff_t j = 0, end_j = n; j < end_j; j++) {
            factor = (((Matrix){NULL, 0, 7}).data[body * ((Matrix){NULL, 0, 7}).size1 + j] * ((Matrix){NULL, 0, 16}).data[body * ((Matrix){NULL, 0, 16}).size1 + 12]);
            for (ptrdiff_t i = 0, end_i = 3; i < end_i; i++) {
                along = 0.0;
                for (ptrdiff_t k = 0, end_k = 3; k < end_k; k++) {
                    along += (own.data[((3 * i) + k)] * jacobian.data[j * jacobian.size1 + (3 + k)]);
                }
                moved.data[j * moved.size1 + (3 + i)] = ((((Matrix){NULL, 0, 7}).data[body * ((Matrix){NULL, 0, 7}).size1 + j] * ((Matrix){NULL, 0, 16}).data[body * ((Matrix){NULL, 0, 16}).size1 + (13 + i)]) * along);
                turned = (jacobian.data[j * jacobian.size1 + (3 + ((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)])] * own.data[(9 + ((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)])]);
                turned -= (jacobian.data[j * jacobian.size1 + (3 + ((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 2)])] * own.data[(9 + ((IntVector){(ptrdiff_t *)kinematics_kernel_CYCLE, 5}).data[(i + 1)])]);
                moved.data[j * moved.size1 + i] = (factor * (jacobian.data[j * jacobian.size1 + i] + turned));
            }
        }
        for (ptrdiff_t i = 0, end_i = n; i < end_i; i++) {
            for (ptrdiff_t j = 0, end_j = n; j < end_j; j++) {
                for (ptrdiff_t k = 0, end_k = 6; k < end_k; k++) {
                    inertia.data[i * inertia.size1 + j] += (moved.data[i * moved.size1 + k] * moved.data[j * moved.size1 + k]);
                }
            }
        }
    }
    arena_leave(arena, &mark);
    return;
}

/* What a step is laid out with; tables, and the kinematics in the controller. */
static inline step_StepPlan controller_plan(struct controller *c)
{
    (void)c;
    const step_StepPlan plan = {{{(ptrdiff_t *)table_table, 8, 7}, {(double *)table_constants, 78}, {c->jacobian, 7, 6}, {c->placements, 18, 12}, {(double *)table_moves, 18, 7}, {NULL, 7, 7}, 1000.0}, {{(double *)table_weights, 6}, {NULL, 0}, {(double *)table_settings, 2}, {NULL, 0, 2}, 0.001, 0, false, false}, 2, true};
    return plan;
}

void controller_init(struct controller *c)
{
    memset(c, 0, sizeof *c);
}

int controller_step(struct controller *c, const double *q, const double *target, double *dq)
{
    bool full = false;
    struct arena arena = controller_arena(c, &full);
    const step_StepPlan plan = controller_plan(c);
    const kinematics_kernel_ModelTables model = {{(ptrdiff_t *)table_parents, 7}, {(double *)table_joints, 7, 12}, {(double *)table_kinds, 7, 2}, {(ptrdiff_t *)table_frames, 2, 2}, {(double *)table_offsets, 2, 12}, {NULL, 0, 16}, {NULL, 0, 7}, {(double *)table_armature, 7}};
    const Vector row = {c->row, 226};
    const Matrix past = {c->past, 8, CONTROLLER_DOF};
    const Matrix following = {c->following, 8, CONTROLLER_DOF};
    const Vector state = {c->state, 27};
    const Vector relaxed = {c->relaxed, 57};
    const Vector joints = {c->past, CONTROLLER_DOF};
    const double t = c->steps[0] * CONTROLLER_DT;
    memcpy(c->past, q, sizeof(double) * CONTROLLER_DOF);
    memcpy(c->row + 208, target, sizeof(double) * 18 * CONTROLLER_FRAMES);
    robot_kinematics_kernel_write_kinematics(&arena, &model, joints, plan.arrays.jacobian, plan.arrays.placements, plan.arrays.inertia);
    const ptrdiff_t action = control_step_take_step(&arena, row, &plan, past, following, state, relaxed, t, false);
    if (full || action == CONTROLLER_INVALID) {
        memset(dq, 0, sizeof(double) * CONTROLLER_DOF);
        return CONTROLLER_INVALID;
    }
    memcpy(dq, c->row + 176, sizeof(double) * CONTROLLER_DOF);
    memcpy(c->past, c->following, sizeof c->past);
    c->steps[0] += 1.0;
    return (int)action;
}

void controller_target(struct controller *c, double t, double *target)
{
    bool full = false;
    struct arena arena = controller_arena(c, &full);
    const step_StepPlan plan = controller_plan(c);
    const Matrix targets = {target, CONTROLLER_FRAMES, 18};
    control_step_sample_targets(&arena, &plan.arrays, t - c->past[5 * CONTROLLER_DOF], targets);
}

