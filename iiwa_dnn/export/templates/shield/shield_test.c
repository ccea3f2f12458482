/* Compares the shield with the Python package, to the last bit: ./shield_test vectors.csv */
#include "shield.h"

#include <stdio.h>
#include <string.h>

#define STEPS @steps@
#define COLUMNS (2 * SHIELD_JOINTS + @request@ + 3)

static double rows[STEPS][COLUMNS];

static int read_rows(const char *path)
{
    FILE *file = fopen(path, "r");
    int count = 0;
    if (file == NULL) {
        return 0;
    }
    while (fgetc(file) != '\n') {
        if (feof(file)) {
            break;
        }
    }
    for (int i = 0; i < STEPS * COLUMNS; i++) {
        count += fscanf(file, "%lf%*[,\n]", &rows[i / COLUMNS][i % COLUMNS]) == 1;
    }
    fclose(file);
    return count == STEPS * COLUMNS;
}

int main(int count, char **words)
{
    static struct shield s;
    double dq[SHIELD_JOINTS];
    int differing = 0;
    if (!read_rows(count > 1 ? words[1] : "vectors.csv")) {
        fprintf(stderr, "vectors.csv: cannot be read\n");
        return 2;
    }
    shield_init(&s);
    for (int k = 0; k < STEPS; k++) {
        const double *data = rows[k];
        const struct shield_input given = {
            data, (enum shield_request)(int)data[SHIELD_JOINTS], data + SHIELD_JOINTS + 2,
            data[SHIELD_JOINTS + 1], 0.0,
        };
        const double *expected = given.request + @request@;
        const int reason = shield_step(&s, &given, dq);
        differing += memcmp(dq, expected, sizeof dq) != 0 || reason != (int)expected[SHIELD_JOINTS];
    }
    printf("%d steps: %d commands differ from Python's\n", STEPS, differing);
    return differing != 0;
}
