#ifndef @KIND@_SCRATCH
#define @KIND@_SCRATCH @scratch@ /* numbers that a step takes for itself, on the stack */
#elif @KIND@_SCRATCH < 5 * @scratch@ / 8
#error "@KIND@_SCRATCH is too small for a step"
#endif

/* Memory that kernels take from the stack; if it ever were too little, the step is refused. */
#define @KIND@_ARENA \
    double scratch[@KIND@_SCRATCH]; \
    bool full = false; \
    struct arena arena = {(char *)scratch, (char *)scratch, (char *)(scratch + @KIND@_SCRATCH), &full}

/* Write the codes of limits: of each joint the lower and the upper bound of each kind, then the rows, which belong to
 * one pair of bodies, or by their kind to another from step to step. Limits of rates, which most often follow from
 * others, come last. */
static inline int @kind@_codes(Vector limiting, int *codes)
{
    int count = 0;
    for (int of_rates = 0; of_rates < 2; of_rates++) {
        for (int k = 0; k < (int)limiting.size0; k++) {
            const int kind = (int)limiting.data[k], size = kind > 0 ? kind : -kind;
            const int row = k - @n@;
            const bool is_rate = k < @dof@ && (size == @acceleration@ || size == @jerk@);
            if (kind == 0 || is_rate != (of_rates == 1) || (k >= @dof@ && row < 0)) {
                continue;
            }
            int code = @reason_count@ + @sides@ * k + 2 * size - 2 + (kind > 0);
            if (row >= 0) {
                code = @reason_count@ + @sides@ * @dof@ + (kind > 1 ? @m@ + kind - 2 : row);
            }
            bool is_new = true;
            for (int i = 0; i < count; i++) {
                is_new = is_new && codes[i] != code;
            }
            if (is_new) {
                codes[count++] = code;
            }
        }
    }
    return count;
}

const char *@kind@_limit_name(int code)
{
    static const char *const names[@KIND@_LIMITS] = {
@names@
    };
    return code >= 0 && code < @KIND@_LIMITS ? names[code] : "";
}

const char *@kind@_digest(void)
{
    return @KIND@_DIGEST;
}
