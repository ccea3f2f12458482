/* Exported shields and an arm that follows every command, for the page to call. */
#include <stddef.h>

#include "scenes.h"

static struct armstep own;
static double memory[SCENES_MEMORY];
static double scratch[SCENES_SCRATCH];
static int codes[SCENES_LIMITS];

double q[SCENES_JOINTS];       /* joint positions [rad] */
double dq[SCENES_JOINTS];      /* last command [rad/s] */
double target[18];             /* position of the handle, and no more */
double request[SCENES_JOINTS]; /* twist [m/s, rad/s], joint velocities [rad/s] or positions [rad] */
double ball[3];                /* center of the ball [m] */
double seen[7];                /* ends and radius of the person that a camera saw [m] */
double sample[SCENES_JOINTS];  /* of a stream of joint positions [rad] */

/* Begin with the tables of a number at rest, at the joint positions that are in q. */
void begin(int number)
{
    armstep_load(&own, scenes[number]);
    armstep_begin(&own, memory, scratch);
    armstep_rest(&own, memory, scratch, q);
}

/* Say who is in `seen`, as a camera saw it so long ago [s]. */
void see(double age)
{
    armstep_people(&own, memory, &seen, 1, age);
}

/* Follow the stream whose next sample is of this time [s], with a lead of 0, 1 or 2 samples. */
void follow(double time, int lead)
{
    armstep_follow(&own, memory, &time, sample, 1, ARMSTEP_STREAM + lead);
}

/* Take a step towards a request of a kind; return whether the command is another one. */
int step(int kind)
{
    const double *const asked = kind == ARMSTEP_REQUEST_NONE ? NULL : request;
    const struct armstep_input input = {q, kind, asked, 0.0, 0.0, 0.0};
    if (own.tables->obstacles > 0)
        armstep_place(&own, memory, ball);
    armstep_step(&own, memory, scratch, &input, dq);
    for (int i = 0; i < SCENES_JOINTS; i++)
        q[i] += own.tables->dt * dq[i];
    return armstep_is_clipped(&own, memory);
}

/* Count what keeps the last command from the request. */
int count_limits(void)
{
    return armstep_active_limits(&own, memory, codes);
}

/* Name one of them. */
const char *limit_name(int i)
{
    return armstep_limit_name(own.tables, codes[i]);
}

/* Return the time of the motion to rest from the last command [s]. */
double stopping_time(void)
{
    return armstep_stopping_time(&own, memory, scratch);
}

/* Return the separation from the person beyond the one to keep [m]. */
double separation(void)
{
    return armstep_separation(&own, memory, scratch);
}

/* Return the least part of a torque limit that the last command leaves. */
double torque(void)
{
    return armstep_torque(&own, memory, scratch);
}
