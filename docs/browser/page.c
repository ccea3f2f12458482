/* An exported controller and an arm that follows every command, for the page to call. */
#include <stddef.h>

#include "controller.h"

static struct controller c;

double q[CONTROLLER_DOF];                /* joint positions [rad] */
double dq[CONTROLLER_DOF];               /* last command [rad/s] */
double target[18 * CONTROLLER_FRAMES];   /* last target */

/* Begin at rest, at the joint positions that are in q. */
void begin(void)
{
    controller_init(&c);
}

/* Take a step towards the reference at time t [s], or towards the target as it is; return its action. */
int step(double t, int along)
{
    if (along)
        controller_target(&c, t, target);
    int action = controller_step(&c, q, target, dq);
    for (int i = 0; i < CONTROLLER_DOF; i++)
        q[i] += CONTROLLER_DT * dq[i];
    return action;
}

