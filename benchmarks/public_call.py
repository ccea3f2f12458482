"""Time of the public call on cold programs, beside DAQP and PIQP through qpsolvers.

    python -m benchmarks.public_call [VARIABLES ...]

Seeded dense programs, up to n/2 equalities and 2n inequalities, bounds, condition up to 1e3. Each
solver gets a program right after the other has had it, so that none finds its data in the cache; of
each program the shortest of its times counts, of the programs the median.
"""

import argparse
import time

import numpy as np
import qpsolvers

import iiwa_dnn
from benchmarks import programs
from iiwa_dnn.results.markdown import markdown_table

SIZES = (4, 7, 17, 33, 50, 100, 200, 400)
CALLS = {
    "iiwa_dnn": iiwa_dnn.solve_problem,
    "DAQP": lambda given: qpsolvers.solve_problem(given, "daqp", primal_tol=1e-9, dual_tol=1e-9),
    "PIQP": lambda given: qpsolvers.solve_problem(given, "piqp", eps_abs=1e-9, eps_rel=0.0),
}


def medians(n: int) -> list[float]:
    """Median times of the calls [us] on programs of n variables."""
    count = max(6, min(100, 4000 // n))
    rounds = max(3, min(20, 2000 // n))
    rngs = [np.random.default_rng([9, i]) for i in range(count)]
    given = [programs.strictly_convex(rng, n, 1e3, False)[0].to_qpsolvers() for rng in rngs]
    taken = np.empty((rounds, count, len(CALLS)))
    for r in range(rounds):
        for i, problem in enumerate(given):
            for k, call in enumerate(CALLS.values()):
                began = time.perf_counter()
                call(problem)
                taken[r, i, k] = time.perf_counter() - began
    return list(1e6 * np.median(taken.min(axis=0), axis=0))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, prog="benchmarks.public_call")
    parser.add_argument("variables", type=int, nargs="*", default=SIZES)
    rows = []
    for n in parser.parse_args().variables:
        own, *others = medians(n)
        times = [f"{value:.1f}" for value in (own, *others)]
        rows.append((str(n), *times, f"{own / others[0]:.2f}", f"{own / others[1]:.2f}"))
    head = ("n", *(f"{name} µs" for name in CALLS), "of DAQP's", "of PIQP's")
    print(markdown_table(head, rows))


if __name__ == "__main__":
    main()
