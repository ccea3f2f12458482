static int take_step(struct shield *own, const double *row, double *dq)
{
    const struct shield_input given = {
        row, (enum shield_request)(int)row[@dof@], row + @dof@ + 2, row[@dof@ + 1], 0.0,
    };
    return shield_step(own, &given, dq);
}
