/* Compares the @kind@ with the Python package: ./compare vectors.csv */
#include "@name@.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

#define STEPS @steps@
#define COLUMNS @columns@
#define REQUEST @request@ /* numbers of a request, or of targets */
#ifndef ROUNDS
#define ROUNDS 20 /* of which the time is the mean */
#endif

/* Largest difference of a command in units of the velocity limits. */
#define TOLERANCE @tolerance@

/* A row: time, joint positions, kind of the request, stated period, request; command and result. */
static double rows[STEPS][COLUMNS];
static struct armstep laid_out;
static double memory[@NAME@_MEMORY];
static double scratch[@NAME@_SCRATCH];

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

/* Goes through all steps once; returns how many commands differ. */
static int run(void)
{
    int differing = 0;
    armstep_begin(&laid_out, memory, scratch);
    for (int k = 0; k < STEPS; k++) {
        const double *said = rows[k] + 1 + @NAME@_JOINTS;
        const double *expected = said + 2 + REQUEST;
        const struct armstep_input input = {rows[k] + 1, (int)said[0], said + 2, rows[k][0], said[1], 0.0};
        double dq[@NAME@_JOINTS];
        int differs = armstep_step(&laid_out, memory, scratch, &input, dq) != (int)expected[@NAME@_JOINTS];
        for (int i = 0; i < @NAME@_JOINTS; i++) {
            const double most = @name@.velocity[i] < HUGE_VAL ? @name@.velocity[i] : 1.0;
            differs += !(fabs(dq[i] - expected[i]) <= TOLERANCE * most);
        }
        differing += differs != 0;
    }
    return differing;
}

int main(int count, char **words)
{
    const enum armstep_status status = armstep_load(&laid_out, &@name@);
    if (status != ARMSTEP_OK) {
        fprintf(stderr, "the tables do not load: %d\n", (int)status);
        return 2;
    }
    if (!read_rows(count > 1 ? words[1] : "vectors.csv")) {
        fprintf(stderr, "vectors.csv: cannot be read\n");
        return 2;
    }
    const int differing = run();
    const clock_t began = clock();
    for (int k = 0; k < ROUNDS; k++) {
        run();
    }
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    printf("%d steps: %d commands differ from Python's", STEPS, differing);
    printf(" by more than %g of the velocity limits", TOLERANCE);
    printf("; %.2f us a step\n", 1e6 * seconds / (ROUNDS * STEPS));
    return differing != 0;
}
