/* A control loop with an arm that follows every command: cc example.c shield.c -lm */
#include "shield.h"

#include <stdio.h>

int main(void)
{
    struct shield s;
    double q[SHIELD_JOINTS] = {@q0@}; /* where the encoders are read */
    double request[SHIELD_JOINTS] = {0.1}; /* rad/s, where requests come from */
    double dq[SHIELD_JOINTS];
    shield_init(&s);
    for (int k = 0; k < 1000; k++) {
        const struct shield_input given = {q, SHIELD_REQUEST_VELOCITY, request, 0.0, 0.0};
        shield_step(&s, &given, dq);
        for (int i = 0; i < SHIELD_JOINTS; i++) {
            q[i] += SHIELD_DT * dq[i]; /* where the command goes to the arm */
        }
    }
    for (int i = 0; i < SHIELD_JOINTS; i++) {
        printf("q[%d] = %.6f rad\n", i, q[i]);
    }
    return 0;
}
