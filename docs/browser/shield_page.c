/* An exported shield and an arm that follows every command, for the page to call. */
#include "arm.h"

static struct armstep own;
static double memory[ARM_MEMORY];
static double scratch[ARM_SCRATCH];
static int codes[ARM_LIMITS];

double q[ARM_JOINTS];       /* joint positions [rad] */
double dq[ARM_JOINTS];      /* last command [rad/s] */
double target[18];          /* position of the handle that pulls at the tip, and no more */
double twist[6];            /* request [m/s, rad/s] */
double ball[3];             /* center of the ball [m] */

/* Begin at rest, at the joint positions that are in q. */
void begin(void)
{
    armstep_load(&own, &arm);
    armstep_begin(&own, memory, scratch);
    armstep_rest(&own, memory, scratch, q);
}

/* Take a step; return whether the command is another one than the request. */
int step(void)
{
    const struct armstep_input input = {q, ARMSTEP_REQUEST_TWIST, twist, 0.0, 0.0, 0.0};
    armstep_place(&own, memory, ball);
    armstep_step(&own, memory, scratch, &input, dq);
    for (int i = 0; i < ARM_JOINTS; i++)
        q[i] += arm.dt * dq[i];
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
    return armstep_limit_name(&arm, codes[i]);
}

/* Return the time of the motion to rest from the last command [s]. */
double stopping_time(void)
{
    return armstep_stopping_time(&own, memory, scratch);
}
