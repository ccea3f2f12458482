/* Mutated tables and hostile steps: ./core_fuzz ROUNDS STEPS SEED, to be compiled with sanitizers.
 *
 * In each round the tables of one arm, with up to three numbers, integers or ends changed, are loaded: as they are,
 * which their digest forbids, and with the digest that they would need. Before, each number in turn is one beyond all
 * integers. The tables themselves take hostile steps.
 */
#include "left.h"
#include "right.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t state;

static uint64_t draw(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

static double between(double low, double high)
{
    return low + (high - low) * (double)(draw() >> 11) / 9007199254740992.0;
}

static double hostile(double usual)
{
    static const double wild[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 5e-324, 0.0, -1.0};
    return draw() % 50 == 0 ? wild[draw() % 8] : usual;
}

static long steps(const struct armstep *arm, double *memory, double *scratch, long count)
{
    const ptrdiff_t n = arm->tables->joints;
    double q[64], request[512], dq[64];
    long found = 0;
    armstep_begin(arm, memory, scratch);
    for (long k = 0; k < count; k++) {
        for (ptrdiff_t i = 0; i < n && i < 64; i++) {
            q[i] = hostile(k == 0 ? between(-1.0, 1.0) : armstep_next_q(arm, memory)[i]);
        }
        for (int i = 0; i < 512; i++) {
            request[i] = hostile(between(-2.0, 2.0));
        }
        struct armstep_input input = {q, (int)(draw() % 6) - 1, draw() % 3 ? request : NULL, 1e-3 * (double)k, 0.0, 0.0};
        input.dt = draw() % 20 ? 0.0 : hostile(arm->tables->dt);
        input.elapsed = draw() % 20 ? 0.0 : hostile(arm->tables->dt);
        found += armstep_step(arm, memory, scratch, &input, dq) == ARMSTEP_INVALID;
        for (ptrdiff_t i = 0; i < n; i++) {
            if (!(fabs(dq[i]) <= 4.0)) {
                printf("step %ld commands %g rad/s\n", k, dq[i]);
                exit(1);
            }
        }
        if (draw() % 100 == 0) {
            armstep_send(arm, memory, request, hostile(1e-3), 1.0);
            armstep_place(arm, memory, request);
            armstep_rest(arm, memory, scratch, draw() % 2 ? q : NULL);
        }
        if (draw() % 300 == 0) {
            armstep_halt(arm, memory);
        }
        (void)armstep_stopping_time(arm, memory, scratch);
    }
    return found;
}

static void forge(const struct armstep_tables *usual)
{
    static struct armstep arm;
    struct armstep_tables own = *usual;
    const size_t size = sizeof(double) * (size_t)own.number_count;
    double *numbers = malloc(size);
    memcpy(numbers, usual->numbers, size);
    own.numbers = numbers;
    for (ptrdiff_t i = 0; i < own.number_count; i++) {
        numbers[i] = 1e300;
        own.digest = armstep_digest(&own);
        (void)armstep_load(&arm, &own);
        numbers[i] = usual->numbers[i];
    }
    free(numbers);
}

int main(int count, char **words)
{
    static const struct armstep_tables *const all[] = {&left, &right};
    const long rounds = count > 1 ? atol(words[1]) : 1000;
    const long most = count > 2 ? atol(words[2]) : 20;
    long loaded = 0, invalid = 0;
    state = count > 3 ? (uint64_t)atoll(words[3]) : 88172645463325252ULL;
    forge(&left);
    forge(&right);
    for (long round = 0; round < rounds; round++) {
        static struct armstep arm;
        struct armstep_tables own = *all[round % 2];
        ptrdiff_t *integers = malloc(sizeof *integers * (size_t)own.integer_count);
        double *numbers = malloc(sizeof *numbers * (size_t)own.number_count);
        memcpy(integers, own.integers, sizeof *integers * (size_t)own.integer_count);
        memcpy(numbers, own.numbers, sizeof *numbers * (size_t)own.number_count);
        for (uint64_t k = 0; k <= draw() % 3; k++) {
            ptrdiff_t *place = integers + draw() % (uint64_t)own.integer_count;
            switch (draw() % 6) {
            case 0:
                *place = (ptrdiff_t)draw();
                break;
            case 1:
                *place = (ptrdiff_t)(draw() % 2000);
                break;
            case 2:
                *place = -(ptrdiff_t)(draw() % 9);
                break;
            case 3:
                *place += draw() % 2 ? 1 : -1;
                break;
            case 4:
                own.integer_count -= (ptrdiff_t)(draw() % (uint64_t)own.integer_count);
                break;
            default:
                numbers[draw() % (uint64_t)own.number_count] = hostile(between(-9.0, 9.0));
                break;
            }
        }
        own.integers = integers;
        own.numbers = numbers;
        const bool is_same = memcmp(integers, all[round % 2]->integers, sizeof *integers * (size_t)own.integer_count) == 0
            && memcmp(numbers, all[round % 2]->numbers, sizeof *numbers * (size_t)own.number_count) == 0
            && own.integer_count == all[round % 2]->integer_count;
        if (!is_same && armstep_load(&arm, &own) == ARMSTEP_OK) {
            printf("changed tables are loaded\n");
            return 1;
        }
        own.digest = armstep_digest(&own);
        loaded += armstep_load(&arm, &own) == ARMSTEP_OK;
        free(integers);
        free(numbers);
    }
    for (int k = 0; k < 2; k++) {
        static struct armstep arm;
        double *memory = malloc(sizeof *memory * (size_t)all[k]->memory);
        double *scratch = malloc(sizeof *scratch * (size_t)all[k]->scratch);
        if (armstep_load(&arm, all[k]) != ARMSTEP_OK) {
            return 1;
        }
        invalid += steps(&arm, memory, scratch, most);
        free(memory);
        free(scratch);
    }
    printf("%ld of %ld fit, %ld of %ld steps invalid\n", loaded, rounds, invalid, 2 * most);
    return invalid > most;
}
