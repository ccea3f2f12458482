/* Tables of the @kind@ of the robot @robot@, made by iiwa_dnn @version@.
 *
 * Joints: @joint_names@
 * Limits kept: @kept@
 * Pairs of links and obstacles kept apart: @watched@
 *
 * In the order in which armstep.c reads them: numbers, then sizes, indices and parts.
 */
#include "@name@.h"

#include <math.h>

static const @numbers@;

static const @integers@;

typedef char @name@_has_no_gaps
    [sizeof @name@_numbers == @number_count@ * sizeof(double) && sizeof @name@_integers == @integer_count@ * sizeof(ptrdiff_t) ? 1 : -1];

static const ptrdiff_t @name@_parts[] = {@parts@};

static const char *const @name@_joint_names[] = {@joint_words@};

static const char *const @name@_frame_names[] = {@frame_words@};

static const char *const @name@_obstacle_names[] = {@obstacle_words@};

static const char *const @name@_limit_names[] = {
@limit_words@
};

static const double @name@_lower[] = @lower@;

static const double @name@_upper[] = @upper@;

static const double @name@_velocity[] = @velocity@;

static const double @name@_acceleration[] = @acceleration@;

static const double @name@_jerk[] = @jerk@;

const struct armstep_tables @name@ = {
    .digest = UINT64_C(0x@digest@),
    .release = @release@,
    .kind = ARMSTEP_@KIND@,
    .name = "@name@",
    .joint_names = @name@_joint_names,
    .joints = @joints@,
    .frame_names = @name@_frame_names,
    .frames = @frames@,
    .obstacle_names = @name@_obstacle_names,
    .obstacles = @obstacles@,
    .limit_names = @name@_limit_names,
    .limits = @limits@,
    .first_row = @first_row@,
    .lower = @name@_lower,
    .upper = @name@_upper,
    .velocity = @name@_velocity,
    .acceleration = @name@_acceleration,
    .jerk = @name@_jerk,
    .dt = @dt@,
    .longest = @longest@,
    .delay = @delay@,
    .memory = @memory@,
    .scratch = @scratch@,
    .numbers = (const double *)&@name@_numbers,
    .number_count = @number_count@,
    .integers = (const ptrdiff_t *)&@name@_integers,
    .integer_count = @integer_count@,
    .parts = @name@_parts,
    .part_count = @part_count@,
    .own = @own@,
    .own_count = @own_count@,
};
