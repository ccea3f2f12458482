/* Rigorous bound on the distance of a command from the exact solution of its program, made by
 * iiwa_dnn @version@ from its own compiled code.
 *
 * On request only: nothing in controller.c calls it. Every product and sum is counted with its
 * rounding, fused or not, so -ffp-contract=fast is allowed, and -ffast-math is not.
 */
#include "controller.h"

#include <math.h>
#include <stdbool.h>

/* Places in the row. */
#define AT_POINT @at_point@
#define AT_DQ @at_dq@

@bound_code@

double controller_bound(const struct controller *c)
{
    double point[@point_size@];
    int active[@active_size@];
    const struct qp_views qp = qp_views(c->row, @n@, @m@, @p@);
    if (c->steps == 0.0) {
        return INFINITY;
    }
    for (int k = 0; k < @point_size@; k++) {
        point[k] = c->row[AT_POINT + k];
    }
    /* The command itself, whatever the answer was. */
    for (int i = 0; i < CONTROLLER_DOF; i++) {
        point[i] = c->row[AT_DQ + i];
    }
    return prove_point(&qp, point, active).item0;
}
