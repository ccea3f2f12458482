/* Steps of an exported controller or shield (-DSHIELD), one after another, as a robot takes them. */
#include "controller.h"
#include <stddef.h>

enum { SILENCE, VELOCITIES, POSITIONS }; /* kinds of a shield's wishes */

static struct controller c;

void begin(void) { controller_init(&c); }

/* Take steps from positions q (CONTROLLER_DOF); write those after each (steps, CONTROLLER_DOF). */
void take(int steps, double *q, const double *wishes, int width, const int *kinds, double *path) {
    for (int k = 0; k < steps; k++, wishes += width, path += CONTROLLER_DOF) {
        double dq[CONTROLLER_DOF];
#ifdef SHIELD
        double wish[CONTROLLER_DOF];
        for (int i = 0; i < CONTROLLER_DOF; i++)
            wish[i] = kinds[k] == POSITIONS ? (wishes[i] - q[i]) / CONTROLLER_DT : wishes[i];
        shield_step(&c, q, kinds[k] == SILENCE ? NULL : wish, dq);
#else
        controller_step(&c, q, wishes, dq);
#endif
        for (int i = 0; i < CONTROLLER_DOF; i++)
            path[i] = q[i] += CONTROLLER_DT * dq[i];
    }
}
