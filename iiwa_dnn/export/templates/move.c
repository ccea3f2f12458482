    const Matrix centers = @centers@;
    @move@(&arena, plan.arrays.constants, centers, t);
