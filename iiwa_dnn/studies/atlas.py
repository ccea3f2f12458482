"""The atlas: networks, schemes and noises compared at equal work, paired by seed.

Every network drives the paper's arm along a path in continuous mode, and is granted so many
floating-point operations a control period, a program's set-up included. All gains follow one rule:
a fraction of the largest step that is stable with the linearised network, the best of `FRACTIONS`
in an undisturbed run, with one evaluation a period or with as many as the work allows. A network of
one's own is named as ``module:NAME`` or, in a file of the current folder, as ``file.py:NAME``.
"""

import hashlib
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import partial
from importlib import import_module
from itertools import product
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from scipy.signal import lfilter

from iiwa_dnn import (
    QP,
    ActivatedNetwork,
    Circle,
    Configuration,
    CrossCheck,
    DNNSolver,
    DoubleIndicator,
    DualNetwork,
    ExplicitEuler,
    GradientNetwork,
    Heart,
    IiwaDnnError,
    ImplicitEuler,
    InvalidInputError,
    JointLimits,
    KineticEnergy,
    Lissajous,
    Manipulability,
    Network,
    NotFoundError,
    OneLayerNetwork,
    OrientationTask,
    PositionTask,
    PrimalDualNetwork,
    ProjectionNetwork,
    PseudoInverse,
    Reference,
    Robot,
    Scheme,
    SimplifiedDualNetwork,
    TrackingSolver,
    ZeroingNetwork,
    checks,
    load_robot,
    simulate,
)
from iiwa_dnn.files import one_line
from iiwa_dnn.networks import NoiseSuppressingNetwork
from iiwa_dnn.networks.activations import SIGN_BI_POWER, FixedTime, PowerSigmoid, PredefinedTime
from iiwa_dnn.networks.admm import AdmmIteration
from iiwa_dnn.networks.base import kkt_product
from iiwa_dnn.networks.tracking import EULER, FIFD, TAYLOR3, TAYLOR4, TAYLOR5, Formula
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import Sizes
from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.schemes import literature
from iiwa_dnn.studies.runs import paper_robot

ARMS: dict[str, Callable[[], Robot]] = {
    "iiwa7": paper_robot,
    "iiwa7 at a bound": partial(paper_robot, (0.1, *(np.inf,) * 6)),
    "fr3": partial(load_robot, "fr3"),
}
"""Arms by name: the paper's; the same, its first joint limited to 0.1 rad/s, which the paths reach
in more than half of their steps; another."""

DT = 2e-3
"""Control period [s]."""

DURATION = 0.5
"""Length of a run [s]."""

FRACTIONS = (0.05, 0.15, 0.4, 0.95)
"""Fractions of the linear limit among which every network's gain is chosen."""

PERIODS = (4e-3, 2e-3, 1e-3, 5e-4)
"""Control periods [s] against which the order of a formula is found."""

SOLVED = 1e-9
"""Residual below which a program counts as solved."""

UNLIMITED = 1e9
"""Operations a control period that allow any number of evaluations."""

PATHS: tuple[Callable[[], Reference], ...] = (
    partial(Heart, period=2.0),
    partial(Circle, radius=0.05, period=2.0, begin=0.0),
    partial(Lissajous, amplitudes=(0.05, 0.05, 0.02), period=2.0, begin=0.0),
)
"""Paths; the seeds take them in turn. At full speed at once: a soft start outlasts the run."""

_TASKS = [PositionTask(), OrientationTask()]

SCHEMES: dict[str, Callable[[Robot], Scheme]] = {
    "double indicator": lambda robot: DoubleIndicator(),
    "double indicator, the paper's rows": lambda robot: DoubleIndicator(orientation="block"),
    "double indicator, position only": lambda robot: DoubleIndicator(orientation="none"),
    "minimum velocity": lambda robot: Scheme([KineticEnergy()], _TASKS, [JointLimits()]),
    "minimum kinetic energy": lambda robot: Scheme(
        [KineticEnergy(kinetic="inertia")], _TASKS, [JointLimits()]
    ),
    "infinity norm": lambda robot: literature.bi_criteria(robot, 0.0),
    "bi-criteria": literature.bi_criteria,
    "manipulability": lambda robot: Scheme(
        [KineticEnergy(), Manipulability()], _TASKS, [JointLimits()]
    ),
    "soft rotation": lambda robot: Scheme(
        [KineticEnergy(weight=0.01)], [PositionTask(), OrientationTask(weight=1.0)], [JointLimits()]
    ),
    "pseudo-inverse": lambda robot: PseudoInverse(),
}
"""Schemes by name; the first is the league's."""

AHEAD = ("double indicator", "double indicator, position only")
"""Schemes whose rows ask for the target one period ahead, so that the joints' Euler steps leave no
floor that hides a network's own error."""


def _along(course: Callable[[Vector], Vector]) -> Callable[[np.random.Generator, Vector], Matrix]:
    """Return a function that draws a noise of this time course in a random direction."""

    def draw(rng: np.random.Generator, times: Vector) -> Matrix:
        direction = rng.standard_normal(STATES) / np.sqrt(7.0)
        return np.asarray((times[1] - times[0]) * np.outer(course(times), direction))

    return draw


STATES = 100
"""Number of states that a noise is drawn for; no network has more."""

KEPT = float(np.exp(-DT / 0.05))
"""Correlation of the coloured noise from period to period: 1 / e over 50 ms."""

NOISES: dict[str, Callable[[np.random.Generator, Vector], Matrix]] = {
    "none": _along(np.zeros_like),
    "constant": _along(np.ones_like),
    "ramp": _along(lambda times: times),
    "sinusoid": _along(lambda times: np.sin(10.0 * np.pi * times)),
    "white": lambda rng, times: 0.01 * rng.standard_normal((times.size, STATES)),
    "coloured": lambda rng, times: (
        lfilter(
            [0.01 * np.sqrt(1.0 - KEPT**2)],
            [1.0, -KEPT],
            rng.standard_normal((times.size, STATES)).T,
        ).T
    ),
    "measurement": lambda rng, times: 1e-4 * rng.standard_normal((times.size, 7)),
}
"""Noise of each period, drawn for the times of a run [s], by the name of a disturbance.

All but the last are added to x in the network's state, before each period's answer is read, or to
all states of a network that computes x from them: constant 1 rad/s^2, ramp 1 rad/s^3, sinusoid
1 rad/s^2 of 5 Hz, along a direction that the seed draws; white, 0.01 rad/s a period (the paper's);
coloured, the same, correlated by `KEPT`.
Measurement: 1e-4 rad on the joint positions.
"""


def disturbed(solver: DNNSolver, noise: Matrix) -> DNNSolver:
    """Return a solver that adds a row of noise (steps, k) [unit of x] to the state at each step."""
    rows = iter(noise)
    kind: Any = type(solver)

    class Disturbed(kind):  # type: ignore[misc]
        """The solver, which adds a row of the noise before each advance."""

        def _advanced(self, qp: QP, state: Vector, *taken: Any) -> Any:
            width = 7 if self.network.carries_x else state.size
            state[:width] += next(rows)[:width]
            return super()._advanced(qp, state, *taken)

    settings = {each.name: getattr(solver, each.name) for each in fields(solver) if each.init}
    return Disturbed(**settings)


@dataclass(frozen=True)
class Paced(ExplicitEuler):
    """Explicit Euler by `substeps` steps, each a fraction of the longest that is linearly stable.

    Attributes:
        fraction: Fraction of `Flow.linear_limit`.
    """

    fraction: float = 0.95

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place by `substeps` steps; return their number.

        The duration is ignored.

        Raises:
            InvalidInputError: No step is stable.
        """
        step = self.fraction * network.flow(qp).linear_limit(state)
        if not step > 0.0:
            raise InvalidInputError(
                "network", "no explicit step is stable; `implicit` would integrate it implicitly"
            )
        return super().advance(network, qp, state, step * (self.substeps or 1))


@dataclass(frozen=True)
class CutOff(ImplicitEuler):
    """Implicit Euler towards the equilibrium, cut off after `max_steps` linear solves."""

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place; return the number of linear solves."""
        n, m, p = qp.sizes
        return self.solve(network, qp, state, np.empty(2 * n + m + p), 1e-12)[0]


class Entry(NamedTuple):
    """A network of the atlas.

    Attributes:
        network: The network.
        make: Makes its solver from the evaluations a control period, the gain as a fraction of the
            linear limit, and the control period [s].
        work: Operations of a program's set-up and of an evaluation, from the sizes (n, m, p).
        paced: Whether the network has a gain to be chosen.
    """

    network: Any
    make: Callable[[int, float, float], DNNSolver]
    work: Callable[[Sizes], tuple[float, float]]
    paced: bool = True


def constant(network: Network) -> Entry:
    """Return the entry of a network that takes each program as constant, by explicit Euler."""
    return Entry(
        network,
        lambda count, fraction, dt: DNNSolver(
            network, advance_integrator=Paced(count, fraction=fraction)
        ),
        network.work,
    )


def implicit(network: Network) -> Entry:
    """Return the entry of a network whose equilibrium implicit Euler steps approach."""
    return Entry(
        network,
        lambda count, fraction, dt: DNNSolver(network, advance_integrator=CutOff(max_steps=count)),
        _condensed,
        paced=False,
    )


def iterated(network: Network) -> Entry:
    """Return the entry of an iterative method, each iteration an explicit Euler step of rho."""

    def make(count: int, fraction: float, dt: float) -> DNNSolver:
        return DNNSolver(
            replace(network, rho=dt / count), advance_integrator=ExplicitEuler(substeps=count)
        )

    return Entry(network, make, network.work, paced=False)


def zeroing(formula: Formula = EULER, **options: Any) -> Entry:
    """Return the entry of a zeroing network, its gain a fraction of the formula's limit."""
    return moving(ZeroingNetwork(**options), formula)


def moving(network: Network, formula: Formula = EULER) -> Entry:
    """Return the entry of a network that uses the program's rate of change (`TrackingSolver`)."""

    def make(count: int, fraction: float, dt: float) -> DNNSolver:
        rho = dt / count / (fraction * formula.limit)
        return TrackingSolver(replace(network, rho=rho), formula=formula, substeps=count)

    return Entry(network, make, network.work)


def _condensed(sizes: Sizes) -> tuple[float, float]:
    """Count the operations of an implicit step: the condensed matrix, its factors, residuals."""
    n, m, p = sizes
    return 0.0, 2.0 * n**2 * (m + p) + n**3 / 3.0 + 2.0 * n**2 + 2.0 * kkt_product(sizes)


def _activated(network: Network, activation: Any) -> Entry:
    return constant(ActivatedNetwork(network=network, activation=activation))


NETWORKS: dict[str, Entry] = {
    "projection (the paper's)": constant(ProjectionNetwork()),
    "projection, bounds by multipliers only": constant(ProjectionNetwork(primal_projection=False)),
    "one-layer": constant(OneLayerNetwork(corrected=False)),
    "one-layer, corrected": constant(OneLayerNetwork()),
    "dual": constant(DualNetwork()),
    "simplified dual": constant(SimplifiedDualNetwork()),
    "primal-dual": constant(PrimalDualNetwork()),
    "gradient": constant(GradientNetwork()),
    "dual, finite time": _activated(DualNetwork(), SIGN_BI_POWER),
    "dual, fixed time": _activated(DualNetwork(), FixedTime()),
    "primal-dual, fixed time": _activated(PrimalDualNetwork(), FixedTime()),
    "simplified dual, predefined time": _activated(SimplifiedDualNetwork(), PredefinedTime()),
    "zeroing, Euler": zeroing(),
    "zeroing, Taylor 3": zeroing(TAYLOR3),
    "zeroing, FIFD": zeroing(FIFD),
    "zeroing, Taylor 4": zeroing(TAYLOR4),
    "zeroing, Taylor 5": zeroing(TAYLOR5),
    "zeroing, power-sigmoid": zeroing(activation=PowerSigmoid()),
    "zeroing, sign-bi-power": zeroing(activation=SIGN_BI_POWER),
    "zeroing, fixed time": zeroing(activation=FixedTime()),
    "zeroing, predefined time": zeroing(activation=PredefinedTime()),
    "zeroing, noise-tolerant": zeroing(integral=0.25),
    "zeroing, growing gain": zeroing(growth=0.5),
    "zeroing, smooth": zeroing(form="smooth"),
    "noise-suppressing": moving(NoiseSuppressingNetwork(form="projected")),
    "projection, implicit Euler": implicit(ProjectionNetwork(primal_projection=False)),
    "ADMM (OSQP)": iterated(AdmmIteration()),
}
"""Networks of the atlas by name, and the yardstick."""

MEASURES = ("residual", "rms_error_m")


def entry_of(name: str) -> Entry:
    """Return the entry of a network of the atlas, or of a user's ``module:NAME``.

    Raises:
        InvalidInputError: The module cannot be imported, or it has no network of that name.
        NotFoundError: There is no network of that name.
    """
    if name in NETWORKS:
        return NETWORKS[name]
    if ":" not in name:
        raise NotFoundError("network", name, NETWORKS)
    try:
        found = getattr(_imported(name), name.rpartition(":")[2])
        found = found() if isinstance(found, type) else found
    except Exception as error:  # whatever the file of others raises
        problem = f"{name} cannot be had in {Path.cwd()}: {one_line(error)}"
        raise InvalidInputError("network", problem) from error
    if not isinstance(found, Entry | Network):
        raise InvalidInputError("network", f"{name} is no Network: {found!r}", found)
    return constant(found) if isinstance(found, Network) else found


def _imported(name: str) -> ModuleType:
    """Import the module of a user's network, named as module:NAME or FILE.py:NAME."""
    location = Path(name.rpartition(":")[0])
    is_file = location.suffix == ".py"
    folder = str(location.resolve().parent if is_file else Path.cwd())
    if folder not in sys.path:
        sys.path.append(folder)
    return import_module(location.stem if is_file else location.name)


@dataclass(frozen=True)
class Cell:
    """A combination of settings, whose runs differ by their seed.

    Attributes:
        network: Name of the network.
        scheme: Name of the scheme.
        disturbance: Name of the disturbance.
        work: Operations a control period.
        most: Evaluations a control period at most; None: as many as the work allows.
        fraction: Fraction of the linear limit.
        seeds: Number of runs.
        dt: Control period [s].
        arm: Name of the arm.
        source: Hash of the file of a user's network, so that a changed one is computed anew.
    """

    network: str
    scheme: str = next(iter(SCHEMES))
    disturbance: str = "none"
    work: float = 10_000.0
    most: int | None = None
    fraction: float = FRACTIONS[-1]
    seeds: int = 1
    dt: float = DT
    arm: str = next(iter(ARMS))
    source: str = field(default="", init=False)

    def __post_init__(self) -> None:
        """Limit undisturbed runs to one a path; hash the file of a user's network."""
        if self.disturbance == "none":
            object.__setattr__(self, "seeds", min(self.seeds, len(PATHS)))
        if ":" in self.network:
            entry_of(self.network)  # raises an error if there is no such network
            file = Path(str(_imported(self.network).__file__))
            digest = hashlib.sha256(file.read_bytes()).hexdigest()
            object.__setattr__(self, "source", digest[:24])


@dataclass(frozen=True)
class Size:
    """Size of a league.

    Attributes:
        networks: Names of the networks.
        schemes: Names of the schemes; the first is the league's, the others run undisturbed.
        disturbances: Names of the disturbances, ``none`` among them.
        work: Operations a control period.
        seeds: Runs of each disturbed cell, two or more, so that there is an interval.
        arm: Name of the arm.
    """

    networks: Sequence[str] = tuple(NETWORKS)
    schemes: Sequence[str] = tuple(SCHEMES)[:1]
    disturbances: Sequence[str] = tuple(NOISES)
    work: float = 1e4
    seeds: int = 5
    arm: str = next(iter(ARMS))

    def __post_init__(self) -> None:
        """Check names and numbers, and add the undisturbed runs, by which gains are chosen.

        Raises:
            NotFoundError: There is no network of a name.
            InvalidInputError: There is no arm, scheme or disturbance of a name, a number is out of
                range, or a network from outside is none.
        """
        checks.one_of("arm", self.arm, tuple(ARMS))
        for name in self.schemes:
            checks.one_of("schemes", name, tuple(SCHEMES))
        for name in self.disturbances:
            checks.one_of("disturbances", name, tuple(NOISES))
        for name in self.networks:
            entry_of(name)
        checks.positive("work", self.work)
        checks.integer("seeds", self.seeds, 2)
        kinds = tuple(dict.fromkeys(("none", *self.disturbances)))
        object.__setattr__(self, "disturbances", kinds)


def gain_cells(size: Size) -> list[Cell]:
    """List the cells of the search for gains, undisturbed, with the first scheme.

    They are every fraction with one evaluation a period and with all that the work allows.
    """
    return [
        Cell(network, size.schemes[0], arm=size.arm, work=size.work, fraction=fraction, most=most)
        for network in size.networks
        for fraction, most in product(FRACTIONS, (None, 1))
        if entry_of(network).paced or (fraction == FRACTIONS[-1] and most is None)
    ]


def best_gains(
    cells: Iterable[Cell], results: Iterable[Mapping[str, Any]]
) -> dict[str, dict[str, Any]]:
    """Choose each network's ``fraction`` and ``most`` with the smallest residual.

    Residuals below `SOLVED` are equal. Among equals the largest fraction wins, then the one with
    all evaluations.
    """
    ranked: dict[str, list[tuple[float, float, bool, Cell]]] = {}
    for cell, result in zip(cells, results, strict=True):
        residual = result["residual"][0]
        found = np.inf if residual is None else max(residual, SOLVED)
        ranked.setdefault(cell.network, []).append(
            (found, -cell.fraction, cell.most is not None, cell)
        )
    best = {network: min(own)[-1] for network, own in ranked.items()}
    return {
        network: {"fraction": cell.fraction, "most": cell.most} for network, cell in best.items()
    }


def cells(size: Size, gains: Mapping[str, Mapping[str, Any]]) -> list[Cell]:
    """List the cells of a league whose gains are known.

    They are every network with every disturbance under the first scheme, undisturbed under the
    other schemes, and every zeroing network at each of `PERIODS`.
    """
    found = []
    for network in size.networks:
        settings = {"arm": size.arm, "work": size.work, "seeds": size.seeds, **gains[network]}
        found += [Cell(network, size.schemes[0], kind, **settings) for kind in size.disturbances]
        found += [Cell(network, scheme, **settings) for scheme in size.schemes[1:]]
        if isinstance(entry_of(network).network, ZeroingNetwork):
            once = Cell(network, size.schemes[0], **settings | {"work": UNLIMITED, "most": 1})
            found += [replace(once, seeds=1, dt=dt) for dt in PERIODS]
    return found


def measure(cell: Cell) -> dict[str, Any]:
    """Carry out the runs of one cell.

    Returns:
        For each of `MEASURES` a list with a number for each seed, None where the run failed: the
        root mean squares, over the second half of the run, of the answers' KKT residual and of the
        tool's position error [m]. ``failures``, the reasons, which of a network from outside may
        be any exception; ``taken``, the evaluations a control period and their operations.
    """
    runs: list[dict[str, Any]] = []
    failures = set()
    foreign = (Exception,) if ":" in cell.network else ()
    for seed in range(cell.seeds):
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("ignore")  # a network that diverges ends its run
                runs.append(_run(cell, seed))
        except (IiwaDnnError, np.linalg.LinAlgError, *foreign) as error:
            runs.append({})
            kind = "" if isinstance(error, IiwaDnnError) else f"{type(error).__name__}: "
            failures.add(kind + one_line(error))
    values: dict[str, Any] = {name: [run.get(name) for run in runs] for name in MEASURES}
    taken = next((run["taken"] for run in runs if run), None)
    return {**values, "taken": taken, "failures": sorted(failures)}


def evaluations_within(entry: Entry, sizes: Sizes, work: float) -> int:
    """Return the number of evaluations that `work` operations a control period pay for.

    Raises:
        InvalidInputError: Not even one is possible.
    """
    setup, each = entry.work(sizes)
    count = int((work - setup) // each)
    if count < 1:
        raise InvalidInputError("work", f"one evaluation takes {setup + each:.0f} operations")
    return count


def _run(cell: Cell, seed: int) -> dict[str, Any]:
    """Carry out one run.

    Raises:
        IiwaDnnError: The network has diverged, or the tool is 1 m away from its target.
    """
    robot = ARMS[cell.arm]()
    start = robot.start_posture()
    scheme = SCHEMES[cell.scheme](robot)
    entry = entry_of(cell.network)
    sizes = scheme.program(robot).sizes
    count = evaluations_within(entry, sizes, cell.work)
    if cell.most is not None:
        count = min(count, cell.most)
    times = cell.dt * np.arange(round(DURATION / cell.dt), dtype=np.float64)
    noise = NOISES[cell.disturbance](np.random.default_rng(seed), times)
    solver = entry.make(count, cell.fraction, cell.dt)
    path = PATHS[seed % len(PATHS)]().anchored(Configuration(robot, start))
    measured: dict[str, Any] = {}
    if cell.disturbance == "measurement":
        measured = {"noise": noise, "noise_at": "measurement"}
    elif cell.disturbance != "none":
        solver = disturbed(solver, noise)
    record = simulate(
        robot,
        scheme,
        path.feed_forward(cell.dt) if cell.scheme in AHEAD else path,
        start,
        dt=cell.dt,
        duration=DURATION,
        mode="continuous",
        solver=solver,
        check=CrossCheck(()),
        **measured,
    )
    error = np.linalg.norm(position_error(record), axis=1)
    if record.settings["status"] != "completed":
        raise IiwaDnnError(record.settings["status"])
    if not error.max() < 1.0:
        raise IiwaDnnError(f"the tool is {error.max():.2g} m away")
    half = slice(record.steps // 2, record.steps)
    residual = float(np.sqrt(np.mean(record.kkt_residual[half] ** 2)))
    if not np.isfinite(residual):
        raise IiwaDnnError(f"the network diverged: a residual is {record.kkt_residual.max():.2g}")
    setup, each = entry.work(sizes)
    return {
        "residual": residual,
        "rms_error_m": float(np.sqrt(np.mean(error[half] ** 2))),
        "taken": [count, setup + count * each],
    }
