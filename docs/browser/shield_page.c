/* An exported shield and an arm that follows every command, for the page to call. */
#include "shield.h"

static struct shield s;
static int codes[SHIELD_LIMITS];

double q[SHIELD_JOINTS];    /* joint positions [rad] */
double dq[SHIELD_JOINTS];   /* last command [rad/s] */
double target[18];          /* position of the handle that pulls at the tip, and no more */
double twist[6];            /* request [m/s, rad/s] */
double ball[3];             /* center of the ball [m] */

/* Begin at rest, at the joint positions that are in q. */
void begin(void)
{
    shield_init(&s);
    shield_reset(&s, q);
}

/* Take a step; return whether the command is another one than the request. */
int step(void)
{
    const struct shield_input given = {q, SHIELD_REQUEST_TWIST, twist, 0.0, 0.0};
    shield_place(&s, ball);
    shield_step(&s, &given, dq);
    for (int i = 0; i < SHIELD_JOINTS; i++)
        q[i] += SHIELD_DT * dq[i];
    return shield_is_clipped(&s);
}

/* Count what keeps the last command from the request. */
int count_limits(void)
{
    return shield_active_limits(&s, codes);
}

/* Name one of them. */
const char *limit_name(int i)
{
    return shield_limit_name(codes[i]);
}

/* Return the time of the motion to rest from the last command [s]. */
double stopping_time(void)
{
    return shield_stopping_time(&s);
}
