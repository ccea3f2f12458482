
/* Resolve the levels of priority of the program that begins a row. */
static void resolve_levels(double *row)
{
    double data[@data@];
    double x[@x@];
    double missing[@missing@];
    struct priorities priorities;
@assignments@
    resolve_program(row, @n@, @m@, @p@, &priorities);
}
