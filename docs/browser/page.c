/* An exported controller and an arm that follows every command, for the page to call. */
#include "arm.h"

static struct armstep own;
static double memory[ARM_MEMORY];
static double scratch[ARM_SCRATCH];

double q[ARM_JOINTS];                       /* joint positions [rad] */
double dq[ARM_JOINTS];                      /* last command [rad/s] */
double target[ARMSTEP_TARGET * ARM_FRAMES]; /* last target */
double ball[3];                             /* center of the ball [m] */

/* Begin at rest, at the joint positions that are in q. */
void begin(void)
{
    armstep_load(&own, &arm);
    armstep_begin(&own, memory, scratch);
}

/* Take a step towards the reference at time t [s], or towards the target as it is; return its action. */
int step(double t, int along)
{
    if (along)
        armstep_targets(&own, memory, scratch, t, target);
    const struct armstep_input input = {q, ARMSTEP_REQUEST_NONE, target, t, 0.0, 0.0};
    armstep_place(&own, memory, ball);
    const int action = armstep_step(&own, memory, scratch, &input, dq);
    for (int i = 0; i < ARM_JOINTS; i++)
        q[i] += arm.dt * dq[i];
    return action;
}
