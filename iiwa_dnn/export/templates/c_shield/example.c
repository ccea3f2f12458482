/* A control loop with an arm that follows every command: cc example.c armstep.c @name@.c -lm */
#include "@name@.h"

#include <stdio.h>

static struct armstep laid_out;
static double memory[@NAME@_MEMORY];
static double scratch[@NAME@_SCRATCH];

int main(void)
{
    double q[@NAME@_JOINTS] = {@q0@}; /* where the encoders are read */
    double request[@NAME@_JOINTS] = {0.1}; /* rad/s, where requests come from */
    double dq[@NAME@_JOINTS];
    if (armstep_load(&laid_out, &@name@) != ARMSTEP_OK) {
        return 1;
    }
    armstep_begin(&laid_out, memory, scratch);
    for (int k = 0; k < 1000; k++) {
        const struct armstep_input input = {q, ARMSTEP_REQUEST_VELOCITY, request, 0.0, 0.0, 0.0};
        armstep_step(&laid_out, memory, scratch, &input, dq);
        for (int i = 0; i < @NAME@_JOINTS; i++) {
            q[i] += @name@.dt * dq[i]; /* where the command goes to the arm */
        }
    }
    for (int i = 0; i < @NAME@_JOINTS; i++) {
        printf("q[%d] = %.6f rad\n", i, q[i]);
    }
    return 0;
}
