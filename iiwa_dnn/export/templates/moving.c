
/* Begin with the constants of all parts. */
static void start_constants(double *constants)
{
    for (int k = 0; k < @size@; k++) {
        constants[k] = arrays_constants[k];
    }
}

/* Put the obstacles that move where they are at a time [s]. */
static void move_obstacles(double *constants, double t)
{
@calls@
}
