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

/* Write the codes of limits: of each joint the lower and the upper bound of each kind, then the rows. */
static inline int @kind@_codes(Vector limiting, int *codes)
{
    int count = 0;
    for (int k = 0; k < (int)limiting.size0; k++) {
        const int kind = (int)limiting.data[k];
        if (k >= @n@ && kind != 0) {
            codes[count++] = @reason_count@ + @sides@ * @dof@ + k - @n@;
        } else if (k < @dof@ && kind != 0) {
            codes[count++] = @reason_count@ + @sides@ * k + 2 * (kind > 0 ? kind : -kind) - 2 + (kind > 0);
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
