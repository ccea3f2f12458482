/* A control loop with an arm that follows every command: cc example.c controller.c -lm */
#include "controller.h"

#include <stdio.h>

int main(void)
{
    struct controller c;
    double q[CONTROLLER_DOF] = {@q0@}; /* where the encoders are read */
    double target[18 * CONTROLLER_FRAMES] = {@target@};
    double dq[CONTROLLER_DOF];
    controller_init(&c);
    for (int k = 0; k < 1000; k++) {
@sample@        const int action = controller_step(&c, q, target, dq);
        if (action != 0) {
            printf("step %d: action %d\n", k, action);
        }
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            q[i] += CONTROLLER_DT * dq[i]; /* where the command goes to the arm */
        }
    }
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        printf("q[%d] = %.6f rad\n", i, q[i]);
    }
    return 0;
}
