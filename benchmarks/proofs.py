"""Soundness of proofs: bounds beside the true errors, which exact whole numbers give.

``python -m benchmarks proof`` proves answers to programs of many kinds and judges each finite bound
by `benchmarks.exact`, which shares no code with the proof: no bound may be below the true error.
Every third answer is moved by 1e-16 to 1, and every sixth has the multipliers of another. With
``--runs STEPS`` it proves every step of whole runs instead, and times the proofs.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from benchmarks import exact, programs
from benchmarks.export_settings import SETTINGS, drawing
from benchmarks.foreign import ARMS, recorded
from benchmarks.report import tabulate
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.proof import prove
from iiwa_dnn.qp.solution import Solution
from iiwa_dnn.references import Circle, Heart
from iiwa_dnn.robot import Configuration, load_robot

Answers = Iterator[tuple[QP, Solution]]

_COLUMNS = {
    "kind": "{name}",
    "programs": "{programs:,}",
    "proven": "{proven:.1%}",
    "by the curvature alone": "{weak:.1%}",
    "bound below the true error": "{violations}",
    "not judged": "{unjudged}",
    "median of bound / error": "{ratio:.3g}",
}


class Row(NamedTuple):
    """Count of one kind of programs.

    Attributes:
        name: Name of the kind.
        programs: Number of programs.
        proven: Share with a finite bound.
        weak: Share with a finite bound and no proven active set.
        violations: Number of bounds below the true error.
        unjudged: Number of finite bounds without an exact solution to judge them by.
        ratio: Median of the bound over the true error, where that is not zero.
    """

    name: str
    programs: int
    proven: float
    weak: float
    violations: int
    unjudged: int
    ratio: float


def whole_numbers(rng: np.random.Generator) -> QP:
    """A program of small whole numbers around a point: rows repeat, multipliers vanish."""
    n = int(rng.integers(1, 4))
    m = int(rng.integers(0, 4))
    p = int(rng.integers(0, 2))
    numbers = rng.integers(-2, 3, (2 * n + m + p + 2, n)).astype(float)
    choices = rng.integers(0, 2, (4, max(n, m)))
    root = numbers[:n]
    A = numbers[n : n + p]
    G = numbers[n + p : n + p + m]
    x = numbers[-1]
    P = root @ root.T + np.eye(n) * choices[3, 0]
    return QP(
        P, numbers[-2], G, G @ x + choices[0, :m], A, A @ x, x - choices[1, :n], x + choices[2, :n]
    )


def small(rng: np.random.Generator) -> QP:
    """A program of 2 or 3 variables with three inequality rows and bounds."""
    n = int(rng.integers(2, 4))
    numbers = rng.standard_normal((n + 6, n))
    root = numbers[:n]
    size = np.abs(numbers[-2])
    return QP(
        root @ root.T,
        3.0 * numbers[-1],
        numbers[n : n + 3],
        numbers[-3:, 0] + 1.0,
        lb=-size,
        ub=size,
    )


RANDOM: dict[str, tuple[Callable[[np.random.Generator], QP], float]] = {
    "whole numbers, 1 to 3 variables": (whole_numbers, 0.65),
    "random, 2 or 3 variables": (small, 0.3),
    "strictly convex, 2 to 7 variables": (
        lambda rng: programs.strictly_convex(rng, int(rng.integers(2, 8)))[0],
        0.05,
    ),
    "degenerate vertices, 2 to 30 variables": (programs.degenerate, 5e-4),
    **{
        f"badly scaled: {name}": (lambda rng, name=name: programs.badly_scaled(rng, name), 1e-4)
        for name in programs.SCALINGS
    },
}
"""Kinds of random programs, and their shares of all."""


def random_answers(make: Callable[[np.random.Generator], QP], count: int, seed: int) -> Answers:
    """Answer random programs, most of them well."""
    before: Solution | None = None
    solver = DNNSolver()
    for k in range(count):
        rng = np.random.default_rng([26, seed, k])
        qp = make(rng)
        solver.reset()
        solution = solver.solve(qp)
        point = solution.point
        if k % 3 == 2:
            point = point + 10.0 ** rng.uniform(-16.0, 0.0) * rng.standard_normal(point.size)
        if k % 6 == 4 and before is not None and before.point.size == point.size:
            point = np.concatenate([point[: qp.q.size], before.point[qp.q.size :]])
        before = solution
        yield qp, solution._replace(point=point)


def arms_answers(name: str, count: int) -> Answers:
    """Answer the programs of a controller in closed loop."""
    controller, q0 = SETTINGS[name]()
    controller.anchor(Configuration(controller.robot, q0))
    q = q0.copy()
    for k in range(count):
        command = controller.step(q, k * controller.dt)
        yield command.qp, command.solution
        q = q + controller.dt * command.dq


def recorded_answers(arm: str, count: int) -> Answers:
    """Answer the programs that Pink builds for an arm."""
    solver = DNNSolver()
    for _, problem in recorded(arm, count):
        qp = QP.from_qpsolvers(problem)
        yield qp, solver.solve(qp)


def judge(name: str, answers: Answers) -> Row:
    """Prove answers, and judge every finite bound."""
    count = 0
    proven = 0
    weak = 0
    violations = 0
    unjudged = 0
    ratios = []
    for qp, solution in answers:
        count += 1
        proof = prove(qp, solution)
        if not proof.bound < np.inf:
            continue
        proven += 1
        weak += bool(proof.reason)
        x = exact.exact_solution(qp, exact.face_of(qp, proof.active))
        if x is None:
            unjudged += 1
            continue
        error = exact.distance(solution.x, x)
        violations += error > Fraction(proof.bound)
        if error:
            ratios.append(float(Fraction(proof.bound) / error))
    median = float(np.median(ratios)) if ratios else np.nan
    return Row(name, count, proven / count, weak / count, violations, unjudged, median)


class Run(NamedTuple):
    """Proofs of a whole run.

    Attributes:
        name: Name of the run.
        steps: Number of steps.
        proven: Number of answers with a finite bound.
        largest: Largest of the finite bounds [rad/s].
        prove: Time of a proof, in blocks of 1,000 [us].
        solve: Time of a solve, one after another, warm [us].
    """

    name: str
    steps: int
    proven: int
    largest: float
    prove: float
    solve: float


_RUNS = {
    "run": "{name}",
    "steps": "{steps:,}",
    "proven": "{proven:,}",
    "largest bound [rad/s]": "{largest:.1e}",
    "proof [us]": "{prove:.1f}",
    "solve [us]": "{solve:.1f}",
}


def runs(steps: int) -> Iterator[Run]:
    """Prove every step of whole runs of controllers, and time the proofs."""
    at_limit = load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    made = {
        "heart": drawing(),
        "circle": drawing(path=Circle()),
        "obstacle": SETTINGS["collisions with itself, a box, a floor"](),
        "two arms": SETTINGS["two arms"](),
        "acceleration and jerk limits": SETTINGS["acceleration and jerk"](),
        "at the limit": drawing(robot=at_limit, path=Heart(scale=0.008)),
        "velocity limits active": SETTINGS["velocity limits active"](),
        "block form of the paper": SETTINGS["block form"](),
    }
    for name, (controller, q0) in made.items():
        controller.anchor(Configuration(controller.robot, q0))
        q = q0.copy()
        commands = []
        for k in range(steps):
            commands.append(controller.step(q, k * controller.dt))
            q = q + controller.dt * commands[-1].dq
        qps = [command.qp for command in commands]
        data = np.stack([qp.data for qp in qps])
        points = np.stack([command.solution.point for command in commands])
        bounds = CrossCheck(("proof",)).check_block(data, qps[0].sizes, points).solution_gap[:, 0]
        finite = bounds[bounds < np.inf]
        yield Run(
            name,
            steps,
            finite.size,
            float(finite.max(initial=0.0)),
            _quietest(
                lambda data=data, points=points, sizes=qps[0].sizes: _blocks(data, sizes, points)
            )
            / steps,
            _quietest(lambda qps=qps: _solved(qps)) / steps,
        )


def _blocks(data: np.ndarray, sizes: tuple[int, int, int], points: np.ndarray) -> None:
    check = CrossCheck(("proof",))
    for first in range(0, len(data), 1000):
        block = slice(first, first + 1000)
        check.check_block(data[block], sizes, points[block])


def _solved(qps: list[QP]) -> None:
    solver = DNNSolver()
    for qp in qps:
        solver.solve(qp)


def _quietest(call: Callable[[], None]) -> float:
    """Return the least time of five calls [us]."""
    times = []
    for _ in range(5):
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return 1e6 * min(times)


def bench_proof(arguments: list[str], prog: str) -> int:
    """Print a row for each kind; return 1 if a bound was below the true error, else 0."""
    parser = argparse.ArgumentParser(description=__doc__, prog=prog)
    parser.add_argument("--programs", type=int, default=1_000_000, help="number of random programs")
    parser.add_argument("--steps", type=int, default=1000, help="programs of each controller")
    parser.add_argument("--seed", type=int, default=0, help="seed of the random programs")
    parser.add_argument("--runs", type=int, default=0, help="steps of each whole run; nothing else")
    given = parser.parse_args(arguments)
    if given.runs:
        print(tabulate(_RUNS, [run._asdict() for run in runs(given.runs)]))
        return 0
    kinds: list[tuple[str, Answers]] = [
        *((f"arm: {name}", arms_answers(name, given.steps)) for name in SETTINGS),
        *((f"Pink's, {arm}", recorded_answers(arm, given.steps)) for arm in ARMS),
        *(
            (name, random_answers(make, max(1, round(share * given.programs)), given.seed))
            for name, (make, share) in RANDOM.items()
        ),
    ]
    rows = []
    for name, answers in kinds:
        rows.append(judge(name, answers))
        print(rows[-1], flush=True)
    print(tabulate(_COLUMNS, [row._asdict() for row in rows]))
    total = sum(row.programs for row in rows)
    violations = sum(row.violations for row in rows)
    print(f"{total:,} programs, {violations} bounds below the true error")
    return int(violations > 0)
