/* Compares the controller with the Python package: ./test_controller vectors.csv */
#include "controller.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

#define STEPS @steps@
#define COLUMNS (1 + 2 * CONTROLLER_DOF + 18 * CONTROLLER_FRAMES + 1)
#ifndef ROUNDS
#define ROUNDS 200 /* of which the time is the mean */
#endif

/* Ten times the tolerance to which the network converges: now and then one of two ways to compute takes
 * a step of it more. Elsewhere commands differ by rounding. */
#define TOLERANCE @tolerance@

static double rows[STEPS][COLUMNS];
static const double velocity_limits[CONTROLLER_DOF] = {@velocity_limits@};

static int read_rows(const char *path)
{
    FILE *file = fopen(path, "r");
    int letter = 0;
    if (file == NULL) {
        return 0;
    }
    while (letter != '\n' && letter != EOF) {
        letter = fgetc(file);
    }
    int count = 0;
    for (int i = 0; i < STEPS * COLUMNS; i++) {
        count += fscanf(file, "%lf%*[,\n]", &rows[i / COLUMNS][i % COLUMNS]) == 1;
    }
    fclose(file);
    return count == STEPS * COLUMNS;
}

/* Goes through all steps once; returns how many actions differ. */
static int run(struct controller *c, double *largest)
{
    double dq[CONTROLLER_DOF];
    int differing = 0;
    controller_init(c);
    for (int k = 0; k < STEPS; k++) {
        const double *q = rows[k] + 1;
        const double *target = q + CONTROLLER_DOF;
        const double *expected = target + 18 * CONTROLLER_FRAMES;
        const int action = controller_step(c, q, target, dq);
        differing += action != (int)expected[CONTROLLER_DOF];
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            const double difference = fabs(dq[i] - expected[i]) / velocity_limits[i];
            *largest = difference > *largest ? difference : *largest;
        }
    }
    return differing;
}

int main(int count, char **words)
{
    static struct controller c;
    double largest = 0.0;
    if (!read_rows(count > 1 ? words[1] : "vectors.csv")) {
        fprintf(stderr, "vectors.csv: cannot be read\n");
        return 2;
    }
    const int differing = run(&c, &largest);
    const clock_t began = clock();
    for (int k = 0; k < ROUNDS; k++) {
        run(&c, &largest);
    }
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    printf("%d steps: largest difference of a command %.2g of the velocity limits, ", STEPS, largest);
    printf("%d actions differ; %.2f us a step\n", differing, 1e6 * seconds / (ROUNDS * STEPS));
    if (largest <= TOLERANCE && differing == 0) {
        return 0;
    }
    fprintf(stderr, "FAILED: a command differs by more than %g, or an action does\n", TOLERANCE);
    return 1;
}
