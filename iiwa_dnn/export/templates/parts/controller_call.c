static int take_step(struct controller *own, const double *row, double *dq)
{
    return controller_step(own, row + 1, row + 1 + CONTROLLER_DOF, dq);
}
