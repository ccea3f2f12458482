/* A control loop with an arm that follows every command: cc example.c controller.c -lm */
#include "controller.h"

#include <math.h>
#include <stdio.h>

int main(void)
{
    struct controller c;
    double q[CONTROLLER_DOF] = {-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0}; /* where the encoders are read */
    double target[18 * CONTROLLER_FRAMES] = {0.37314465933828456, 0.3887169064348377, 0.30120610113710655, 0.6852638097061545, 0.7179818655642182, 0.12212924231293693, 0.7026803364948753, -0.6958825750471477, 0.14828279215471996, 0.19145196737160058, -0.01579501398149058, -0.9813748833768207, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    double dq[CONTROLLER_DOF];
    controller_init(&c);
    for (int k = 0; k < 1000; k++) {
        controller_target(&c, k * CONTROLLER_DT, target);
        const int action = controller_step(&c, q, target, dq);
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
    double far = 0.0; /* of the first frame, where the encoders were read last */
    for (int i = 0; i < 3; i++) {
        far = hypot(far, c.placements[213 + i] - target[i]);
    }
    printf("distance of iiwa7_flange from its target: %.3g m\n", far);
    return 0;
}
