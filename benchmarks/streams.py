"""Streams of programs: one control step after another, or one random program after another."""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import QP, Matrix, Vector
from iiwa_dnn.references import Heart
from iiwa_dnn.robot import Configuration, load_robot
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import simulate
from iiwa_dnn.studies import paper
from tests.programs import strictly_convex

Programs = list[QP]


class Stream(NamedTuple):
    """Programs to be solved one after the other.

    Attributes:
        name: What the report calls it.
        about: What it is, in one sentence.
        programs: All of one shape if `warm`.
        warm: Whether a solver may start from its last answer.
    """

    name: str
    about: str
    programs: Programs
    warm: bool


def heart(count: int, dt: float, scale: float | None = None, first: int = 0) -> Programs:
    """The programs of consecutive control steps of the paper's heart, from its start.

    Args:
        count: Number of steps.
        dt: Control period [s].
        scale: Of the heart; None takes the default run's.
        first: Step of the first program.
    """
    robot = load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    start = Configuration(robot, paper.START)
    reference = (Heart() if scale is None else Heart(scale=scale)).anchored(start)
    scheme = DoubleIndicator(orientation="so3", home=tuple(paper.START))
    record = simulate(
        robot, scheme, reference, paper.START, dt=dt, duration=count * dt, check=CrossCheck(())
    )
    return [
        scheme.build_qp(Configuration(robot, q), reference.at(float(t)))
        for q, t in zip(record.q[first:count], record.t[first:count], strict=True)
    ]


def active_at_limits(qp: QP, x: Vector, distance: float = 1e-9) -> int:
    """Count the bounds that x (n,) lies against."""
    return int(((x - qp.lb < distance) | (qp.ub - x < distance)).sum())


def drifting(count: int, seed: int = 0) -> tuple[Programs, Matrix]:
    """Programs of 7 variables and 3 equalities that vary slowly, with three to five active bounds.

    Smooth signals are cut off at the bounds: what is left is x, what was cut is the multiplier.
    Three signals are always beyond a bound, two never, two come and go.

    Returns:
        The programs, and the x (count, 7) that solve them.
    """
    rng = np.random.default_rng([8, seed])
    n = 7
    p = 3
    root = rng.standard_normal((n, n))
    P = root @ root.T / n + 0.3 * np.eye(n)
    centre = np.array([1.8, -1.8, 1.8, 1.0, -1.0, 0.0, 0.0])
    swing = np.array([0.5, 0.5, 0.5, 0.5, 0.5, 0.8, 0.8])
    phase = rng.uniform(0.0, 2.0 * np.pi, (2, n))
    rate = rng.uniform(0.004, 0.012, (2, n))
    rows = rng.standard_normal((2, p, n))
    slow = rng.uniform(0.002, 0.006, p)
    solutions = np.empty((count, n))
    programs = []
    for k in range(count):
        signal = centre + swing * 0.5 * np.sin(rate * k + phase).sum(axis=0)
        x = np.clip(signal, -1.0, 1.0)
        A = rows[0] + 0.3 * np.sin(slow * k)[:, None] * rows[1]
        q = -(P @ x + A.T @ np.sin(slow * k + 1.0) + (signal - x))
        programs.append(QP(P, q, A=A, b=A @ x, lb=np.full(n, -1.0), ub=np.ones(n)))
        solutions[k] = x
    return programs, solutions


def random(count: int, n: int, seed: int = 0) -> Programs:
    """Unrelated programs with n variables, equalities, inequalities and bounds."""
    seeds = range(count)
    return [
        strictly_convex(np.random.default_rng([9, seed, n, k]), n, 1e4, False)[0] for k in seeds
    ]


def all_streams(steps: int, cold: int) -> list[Stream]:
    """The streams of the report.

    Args:
        steps: Programs of each warm stream.
        cold: Random programs of each size.
    """
    # The whole heart, so that the time at the limit is in it; longer steps would miss the heart.
    whole = max(steps, 2000)
    streams = [
        Stream(
            "heart, limits idle",
            f"the first {steps} control steps of the default run, 1e-4 s apart",
            heart(steps, 1e-4),
            True,
        ),
        Stream(
            "heart, at a limit",
            f"the heart at scale 0.008, {steps} of the {whole} steps of its 10 s: joint 1 lies "
            "against its limit of 2.5 rad for over a third of them",
            heart(whole, 10.0 / whole, 0.008, whole - steps),
            True,
        ),
        Stream(
            "drifting",
            f"{steps} seeded programs of 7 variables and 3 equalities that vary slowly, three to "
            "five bounds active",
            drifting(steps)[0],
            True,
        ),
    ]
    for n in (7, 14, 30, 50):
        about = (
            f"{cold} seeded dense programs of {n} variables, up to {n // 2} equalities and "
            f"{2 * n} inequalities, bounds, condition up to 1e4, each from a cold start"
        )
        streams.append(Stream(f"random, n = {n}", about, random(cold, n), False))
    return streams
