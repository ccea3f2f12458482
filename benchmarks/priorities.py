"""Strict priorities beside a lexicographic solution by DAQP, in random and singular poses.

    python -m benchmarks.priorities [poses of each kind]

Three levels, position, orientation and two joints, contradict each other in every pose. A pose is
solved where every level's residual, and what the step's own command leaves of it, is within 1e-8 of
the other solver's. The other way there: DAQP, level by level, in coordinates of the null space of
all rows and limits that the levels above hold. Singular poses have joints 2, 4 or 6 at zero, half
of them 0.1 to 1e-6 rad off it, and their targets lie outwards. Directions of singular values below
1e-9 are left out in both.
"""

import sys
from collections.abc import Iterator
from typing import NamedTuple

import daqp
import numpy as np

from iiwa_dnn.control.cascade import HELD, SMALLEST, Cascade
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import (
    JointLimits,
    KineticEnergy,
    OrientationTask,
    PositionTask,
    PostureTask,
    Scheme,
)
from iiwa_dnn.studies.runs import paper_robot

ROBOT = paper_robot()
SCHEME = Scheme(
    [KineticEnergy()],
    [
        PositionTask(priority=1),
        OrientationTask(priority=2),
        PostureTask({"iiwa7_joint_1": 0.5, "iiwa7_joint_3": -0.4}, priority=3),
    ],
    [JointLimits()],
)
PRIORITIES = SCHEME.program(ROBOT).priorities
SINGULAR = ((3,), (3, 5), (5,), (1,), (1, 3, 5))
"""Joints that are at zero, counted from 0."""

KINDS = {
    "random, targets 3 cm off": (0.03, 0.03, False),
    "random, targets 8 cm off": (0.08, 0.03, False),
    "random, targets 8 cm and far turned": (0.08, 0.3, False),
    "singular, targets 3 cm off": (0.03, 0.03, True),
    "singular, targets 8 cm off": (0.08, 0.03, True),
    "singular, targets 8 cm and far turned": (0.08, 0.3, True),
    "singular, targets 50 cm off": (0.5, 0.03, True),
}


class Compared(NamedTuple):
    """One pose.

    Attributes:
        gap: Largest difference of a level's residual; nan where the other solver has none.
        expected: Residual of each level by the other solver.
        solved: Whether every level and the step's own program are solved.
    """

    gap: float
    expected: Vector
    solved: bool


def lexicographic(qp: QP, priorities: Vector) -> Vector | None:
    """Find the residual of each level of a program with DAQP; None where it gives up."""
    x = np.clip(np.zeros(qp.lb.size), qp.lb, qp.ub)
    eye = np.eye(x.size)
    limits = np.vstack([eye, -eye, qp.G])
    ends = np.concatenate([qp.ub, -qp.lb, qp.h])
    held = np.zeros(len(ends), dtype=bool)
    rows = np.zeros((0, x.size))
    levels = range(1, int(priorities.max()) + 1)
    for level in levels:
        A = qp.A[priorities == level]
        b = qp.b[priorities == level]
        free = _null_space(limits[held])
        basis = free @ _null_space(rows @ free)
        if basis.shape[1]:
            left, sizes, right = np.linalg.svd(A @ basis, full_matrices=False)
            E = left * (sizes * (sizes > SMALLEST)) @ right
            rest = ends - limits @ x
            u, _, flag, info = daqp.solve(
                E.T @ E,
                E.T @ (A @ x - b),
                limits[~held] @ basis,
                rest[~held],
                primal_tol=1e-13,
                dual_tol=1e-14,
            )
            if flag != 1:
                return None
            x = x + basis @ u
            held[~held] = np.abs(info["lam"]) > HELD
        rows = np.vstack([rows, A])
    found = [np.linalg.norm((qp.A @ x - qp.b)[priorities == k]) for k in levels]
    return np.array(found)


def _null_space(rows: Matrix) -> Matrix:
    _, sizes, right = np.linalg.svd(rows)
    kept: Matrix = right[int((sizes > SMALLEST).sum()) :].T
    return kept


def compare(qp: QP, priorities: Vector, tol: float = 1e-9) -> Compared:
    """Compare both ways on one program, which is overwritten."""
    A = qp.A.copy()
    b = qp.b.copy()
    expected = lexicographic(qp, priorities)
    cascade = Cascade(priorities, qp.sizes, tol)
    cascade.resolve(qp)
    found = DNNSolver(tol=tol).solve(qp)
    if expected is None:
        return Compared(np.nan, np.zeros(0), found.found)
    gaps = []
    for level, residual in zip(cascade.levels, expected, strict=True):
        attained = np.linalg.norm((A @ found.x - b)[level.own])
        gaps += [np.linalg.norm(level.missing) - residual, attained - residual]
    return Compared(float(np.abs(gaps).max()), expected, found.found)


def programs(count: int, apart: float, turned: float, singular: bool) -> Iterator[QP]:
    """Yield programs of poses with targets `apart` [m] and `turned` [rad] away from them."""
    rng = np.random.default_rng(11)
    for i in range(count):
        q = rng.uniform(0.8 * ROBOT.q_lower, 0.8 * ROBOT.q_upper)
        if singular:
            q[list(SINGULAR[i % 5])] = 10.0 ** -rng.integers(1, 7) if i % 2 else 0.0
        conf = Configuration(ROBOT, q)
        place = conf.position + rng.uniform(-apart, apart, 3)
        if singular and 3 in SINGULAR[i % 5]:  # outwards of an arm that is stretched
            place = conf.position + apart * conf.position / np.linalg.norm(conf.position)
        rotation = Configuration(ROBOT, q + rng.uniform(-turned, turned, 7)).rotation
        yield SCHEME.build_qp(conf, Target(place, rotation))


def main(count: int = 1000) -> None:
    """Print the table."""
    lines = []
    for name, kind in KINDS.items():
        compared = [compare(qp, PRIORITIES) for qp in programs(count, *kind)]
        gaps = np.array([each.gap for each in compared])
        known = [each.expected for each in compared if each.expected.size]
        conflicts = (np.array(known) > 1e-3).sum(axis=0)
        lines.append(
            (
                name,
                f"{sum(each.solved for each in compared)} of {count}",
                f"{(gaps <= 1e-8).sum()} of {len(known)}",
                f"{np.nanmax(gaps):.1e}",
                " / ".join(map(str, conflicts)),
            )
        )
    head = ("poses", "solved", "equal to 1e-8", "largest difference", "conflicts by level")
    print(markdown_table(head, lines))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
