/* Compares the @kind@ with the Python package: ./compare vectors.csv */
#include "@kind@.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

#define STEPS @steps@
#define COLUMNS @columns@
#ifndef ROUNDS
#define ROUNDS 20 /* of which the time is the mean */
#endif

/* Largest difference of a command in units of the velocity limits. */
#define TOLERANCE @tolerance@

static double rows[STEPS][COLUMNS];
static const double velocity_limits[@dof@] = {@velocity_limits@};

static int read_rows(const char *path)
{
    FILE *file = fopen(path, "r");
    int letter = 0;
    int count = 0;
    if (file == NULL) {
        return 0;
    }
    while (letter != '\n' && letter != EOF) {
        letter = fgetc(file);
    }
    for (int i = 0; i < STEPS * COLUMNS; i++) {
        count += fscanf(file, "%lf%*[,\n]", &rows[i / COLUMNS][i % COLUMNS]) == 1;
    }
    fclose(file);
    return count == STEPS * COLUMNS;
}

@call@
/* Goes through all steps once; returns how many commands differ. */
static int run(struct @kind@ *own)
{
    int differing = 0;
    @kind@_init(own);
    for (int k = 0; k < STEPS; k++) {
        const double *expected = rows[k] + COLUMNS - 1 - @dof@;
        double dq[@dof@];
        int differs = take_step(own, rows[k], dq) != (int)expected[@dof@];
        for (int i = 0; i < @dof@; i++) {
            differs += !(fabs(dq[i] - expected[i]) <= TOLERANCE * velocity_limits[i]);
        }
        differing += differs != 0;
    }
    return differing;
}

int main(int count, char **words)
{
    static struct @kind@ own;
    if (!read_rows(count > 1 ? words[1] : "vectors.csv")) {
        fprintf(stderr, "vectors.csv: cannot be read\n");
        return 2;
    }
    const int differing = run(&own);
    const clock_t began = clock();
    for (int k = 0; k < ROUNDS; k++) {
        run(&own);
    }
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    printf("%d steps: %d commands differ from Python's", STEPS, differing);
    printf(" by more than %g of the velocity limits", TOLERANCE);
    printf("; %.2f us a step\n", 1e6 * seconds / (ROUNDS * STEPS));
    return differing != 0;
}
