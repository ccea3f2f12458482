/* A control loop with an arm that follows every command: cc example.c armstep.c @name@.c -lm */
#include "@name@.h"

#include <stdio.h>

static struct armstep laid_out;
static double memory[@NAME@_MEMORY];
static double scratch[@NAME@_SCRATCH];
static const double target[ARMSTEP_TARGET * @NAME@_FRAMES] = {@target@};

int main(void)
{
    double q[@NAME@_JOINTS] = {@q0@}; /* where the encoders are read */
    double dq[@NAME@_JOINTS];
    (void)target;
    if (armstep_load(&laid_out, &@name@) != ARMSTEP_OK) {
        return 1;
    }
    armstep_begin(&laid_out, memory, scratch);
    for (int k = 0; k < 1000; k++) {
        const struct armstep_input input = {q, ARMSTEP_REQUEST_NONE, @request_of_step@, k * @name@.dt, 0.0, 0.0};
        const int action = armstep_step(&laid_out, memory, scratch, &input, dq);
        if (action != 0) {
            printf("step %d: action %d\n", k, action);
        }
        for (int i = 0; i < @NAME@_JOINTS; i++) {
            q[i] += @name@.dt * dq[i]; /* where the command goes to the arm */
        }
    }
    for (int i = 0; i < @NAME@_JOINTS; i++) {
        printf("q[%d] = %.6f rad\n", i, q[i]);
    }
    return 0;
}
