"""The atlas: networks, schemes and disturbances compared at equal work, paired by seed.

Every network drives the paper's arm along a path, in a loop that grants it so many floating-point
operations a control period, a program's set-up included. All gains follow one rule: a share of the
largest step that is stable with the linearised network, the best of `SHARES` in an undisturbed run,
with one evaluation a period or with as many as the work allows.
A network, scheme, reference or disturbance of one's own is named as ``module:NAME`` or
``file.py:NAME``.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.errors import IiwaDnnError, InvalidInputError
from iiwa_dnn.networks import (
    DualNetwork,
    Network,
    NoiseSuppressingNetwork,
    PrimalDualNetwork,
    ProjectionNetwork,
    SimplifiedDualNetwork,
)
from iiwa_dnn.networks.activated import ActivatedNetwork
from iiwa_dnn.networks.activations import FixedTime, PowerSigmoid, PredefinedTime, SignBiPower
from iiwa_dnn.networks.admm import AdmmSolver
from iiwa_dnn.networks.base import kkt_product
from iiwa_dnn.networks.gradient import GradientNetwork
from iiwa_dnn.networks.integrators import ExplicitEuler, ImplicitEuler
from iiwa_dnn.networks.one_layer import OneLayerNetwork
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.networks.tracking import (
    EULER,
    FIFD,
    TAYLOR3,
    TAYLOR4,
    TAYLOR5,
    Formula,
    TrackingSolver,
)
from iiwa_dnn.networks.zeroing import ZeroingNetwork
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.qp.layout import Sizes
from iiwa_dnn.references import Circle, Heart, Lissajous, Reference
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.studies.atlas_disturbances import DISTURBANCES, DT, Disturbance
from iiwa_dnn.studies.atlas_loop import DisturbedLoop
from iiwa_dnn.studies.atlas_schemes import FREE, SCHEMES
from iiwa_dnn.studies.outside import digest, find_part
from iiwa_dnn.studies.runs import paper_robot
from iiwa_dnn.studies.sweeps import Outcome, Settings

DURATION = 0.5
"""Length of a run [s]."""

SHARES = (0.05, 0.15, 0.4, 0.95)
"""Shares of the linear limit among which every network's gain is chosen."""

PERIODS = (4e-3, 2e-3, 1e-3, 5e-4)
"""Control periods [s] against which the order of a formula is found."""

SOLVED = 1e-9
"""Residual below which a program counts as solved."""

UNLIMITED = 1e9
"""Operations a control period that allow any number of evaluations."""

PATHS: dict[str, Callable[[], Reference]] = {
    "heart": partial(Heart, period=2.0),
    "circle": partial(Circle, radius=0.05, period=2.0),
    "lissajous": partial(Lissajous, amplitudes=(0.05, 0.05, 0.02), period=2.0),
}
"""Paths by name; the seeds take them in turn."""


@dataclass(frozen=True)
class Paced(ExplicitEuler):
    """Explicit Euler by `substeps` steps, each a share of the longest that is linearly stable.

    Attributes:
        share: Share of `Flow.linear_limit`.
    """

    share: float = 0.95

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place, whatever the duration; returns the steps taken.

        Raises:
            InvalidInputError: No step is stable.
        """
        step = self.share * network.flow(qp).linear_limit(state)
        if not step > 0.0:
            raise InvalidInputError("network", "has no stable step: take `settled`", network)
        return super().advance(network, qp, state, step * (self.substeps or 1))


@dataclass(frozen=True)
class CutOff(ImplicitEuler):
    """Implicit Euler towards rest, cut off after `max_steps` linear systems."""

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place; returns the linear systems solved."""
        n, m, p = qp.sizes
        return self.settle(network, qp, state, np.empty(2 * n + m + p), 1e-12)[0]


class Entry(NamedTuple):
    """A network of the atlas.

    Attributes:
        network: The network, or what is documented in its place.
        make: Makes its solver from the evaluations a control period, the share of the linear
            limit that is its gain, and the control period [s].
        work: Operations of a program's set-up and of an evaluation, from the sizes (n, m, p).
        paced: Whether it has a gain.
    """

    network: Any
    make: Callable[[int, float, float], DNNSolver]
    work: Callable[[Sizes], tuple[float, float]]
    paced: bool = True


def still(network: Network) -> Entry:
    """Return the entry of a network for a program that stands still."""
    return Entry(
        network,
        lambda count, share, dt: DNNSolver(network, follower=Paced(count, share=share)),
        network.work,
    )


def settled(network: Network) -> Entry:
    """Return the entry of a network that is integrated implicitly towards rest."""
    return Entry(
        network,
        lambda count, share, dt: DNNSolver(network, follower=CutOff(max_steps=count)),
        _condensed,
        paced=False,
    )


def zeroing(formula: Formula = EULER, **options: Any) -> Entry:
    """Return the entry of a zeroing network, its gain a share of the formula's limit."""
    return follows(ZeroingNetwork(**options), formula)


def follows(network: Network, formula: Formula = EULER) -> Entry:
    """Return the entry of a network that follows a program that moves."""

    def make(count: int, share: float, dt: float) -> DNNSolver:
        rho = dt / count / (share * formula.limit)
        return TrackingSolver(replace(network, rho=rho), formula=formula, substeps=count)

    return Entry(network, make, network.work)


def _condensed(sizes: Sizes) -> tuple[float, float]:
    """Count the operations of an implicit step: the condensed matrix, its factors, residuals."""
    n, m, p = sizes
    return 0.0, 2.0 * n**2 * (m + p) + n**3 / 3.0 + 2.0 * n**2 + 2.0 * kkt_product(sizes)


def _factorised(sizes: Sizes) -> tuple[float, float]:
    """Count the operations of ADMM: one factorisation a program, one substitution an iteration."""
    size = sizes[0] + sum(sizes)
    return size**3 / 3.0, 2.0 * size**2


def _activated(network: Network, activation: Any) -> Entry:
    return still(ActivatedNetwork(network=network, activation=activation))


NETWORKS: dict[str, Entry] = {
    "projection (the paper's)": still(ProjectionNetwork()),
    "projection, bounds by multipliers only": still(ProjectionNetwork(primal_projection=False)),
    "one-layer": still(OneLayerNetwork(corrected=False)),
    "one-layer, corrected": still(OneLayerNetwork()),
    "dual": still(DualNetwork()),
    "simplified dual": still(SimplifiedDualNetwork()),
    "primal-dual": still(PrimalDualNetwork()),
    "gradient": still(GradientNetwork()),
    "dual, finite time": _activated(DualNetwork(), SignBiPower()),
    "dual, fixed time": _activated(DualNetwork(), FixedTime()),
    "primal-dual, fixed time": _activated(PrimalDualNetwork(), FixedTime()),
    "simplified dual, predefined time": _activated(SimplifiedDualNetwork(), PredefinedTime()),
    "zeroing, Euler": zeroing(),
    "zeroing, Taylor 3": zeroing(TAYLOR3),
    "zeroing, FIFD": zeroing(FIFD),
    "zeroing, Taylor 4": zeroing(TAYLOR4),
    "zeroing, Taylor 5": zeroing(TAYLOR5),
    "zeroing, power-sigmoid": zeroing(activation=PowerSigmoid()),
    "zeroing, sign-bi-power": zeroing(activation=SignBiPower()),
    "zeroing, fixed time": zeroing(activation=FixedTime()),
    "zeroing, predefined time": zeroing(activation=PredefinedTime()),
    "zeroing, noise-tolerant": zeroing(integral=0.25),
    "zeroing, growing gain": zeroing(growth=0.5),
    "zeroing, smooth": zeroing(form="smooth"),
    "noise-suppressing": follows(NoiseSuppressingNetwork(form="projected")),
    "projection, implicit Euler": settled(ProjectionNetwork(primal_projection=False)),
    "ADMM (OSQP)": Entry(
        AdmmSolver, lambda count, share, dt: AdmmSolver(substeps=count), _factorised, paced=False
    ),
}
"""Networks of the atlas by name, and the yardstick."""

MEASURES = ("residual", "rms_error_m")


PARTS: dict[str, tuple[Mapping[str, Any], tuple[type[Any], ...]]] = {
    "network": (NETWORKS, (Entry, Network)),
    "scheme": (SCHEMES, (Scheme,)),
    "disturbance": (DISTURBANCES, (Disturbance,)),
    "reference": (PATHS, (Reference,)),
}
"""Parts of the atlas by kind: those that it knows by name, and the classes of one from outside."""


def part(kind: str, name: str) -> Any:
    """Return a part by its name or from outside, made anew where a class or a function makes it.

    A disturbance is returned as its class, a network as its `Entry`.

    Raises:
        InvalidInputError: There is no such part in the file; and as of `find_part`.
        NotFoundError: There is no part of that name.
    """
    known, wanted = PARTS[kind]
    found = find_part(kind, name, known)
    if kind == "disturbance":
        fits = isinstance(found, type) and issubclass(found, wanted)
    else:
        if callable(found) and not isinstance(found, wanted):
            found = found()
        fits = isinstance(found, wanted)
    if not fits:
        raise InvalidInputError(kind, f"{name} is no {wanted[-1].__name__}: {found!r}", found)
    return still(found) if isinstance(found, Network) else found


def cell(network: str, **changes: Any) -> dict[str, Any]:
    """Return the settings of one cell, all runs of a combination, with some of them changed.

    They are the network's name; ``scheme`` and ``disturbance``, names; ``work``, operations a
    control period, and ``most``, evaluations at most; ``share`` of the linear limit; ``seeds``, a
    number; ``paths``, names that the seeds take in turn; ``dt`` [s]; and a hash of every file from
    outside, so that a cell is computed anew after a change of it.
    """
    settings = {
        "network": network,
        "scheme": next(iter(SCHEMES)),
        "disturbance": "none",
        "work": 10_000.0,
        "most": None,
        "share": SHARES[-1],
        "seeds": 1,
        "paths": list(PATHS),
        "dt": DT,
        **changes,
    }
    if settings["disturbance"] == "none":  # only the paths differ
        settings["seeds"] = min(settings["seeds"], len(settings["paths"]))
    names = [network, settings["scheme"], settings["disturbance"], *settings["paths"]]
    return {**settings, "files": [digest(name) for name in names if ":" in name]}


class Size(NamedTuple):
    """Size of a league.

    Attributes:
        networks: Names of the networks.
        schemes: Names of the schemes.
        disturbances: Names of the disturbances.
        paths: Names of the paths.
        work: Operations a control period; the middle one with everything, the others with the
            first scheme, undisturbed and with white noise.
        seeds: Runs of each cell with chance in it, with the first scheme.
        others: Runs of each such cell with another scheme or budget.
    """

    networks: Sequence[str]
    schemes: Sequence[str]
    disturbances: Sequence[str]
    paths: Sequence[str]
    work: Sequence[float]
    seeds: int
    others: int

    @property
    def middle(self) -> float:
        """The budget with which everything is run."""
        return self.work[len(self.work) // 2]

    def check(self) -> None:
        """Check that all parts are there; raises NotFoundError or InvalidInputError."""
        parts = (self.networks, self.schemes, self.disturbances, self.paths)
        for kind, names in zip(PARTS, parts, strict=True):
            for name in names:
                part(kind, name)


def gain_cells(size: Size) -> list[dict[str, Any]]:
    """List the cells of the search for gains, undisturbed, with the first scheme.

    They are every share with one evaluation a period and with all that the work allows.
    """
    common = {"scheme": size.schemes[0], "work": size.middle, "paths": list(size.paths)[:1]}
    return [
        cell(network, share=share, most=most, **common)
        for network in size.networks
        for share, most in product(SHARES, (None, 1))
        if part("network", network).paced or (share == SHARES[-1] and most is None)
    ]


def best_gains(
    cells: Iterable[Settings], results: Iterable[Mapping[str, Any]]
) -> dict[str, dict[str, Any]]:
    """Choose each network's ``share`` and ``most``: those with the smallest residual.

    Of those that solve the program, and of equals, it is the largest share with all evaluations.
    """
    best: dict[str, tuple[float, float, bool]] = {}
    gains = {}
    for settings, result in zip(cells, results, strict=True):
        name = settings["network"]
        residual = result["residual"][0]
        found = np.inf if residual is None else max(residual, SOLVED)
        key = (found, -settings["share"], settings["most"] is not None)
        if name not in best or key < best[name]:
            best[name] = key
            gains[name] = {"share": settings["share"], "most": settings["most"]}
    return gains


def of_league(scheme: str, disturbance: str) -> str:
    """Return the scheme of a league's column: where a joint is locked, the orientation is free.

    Six joints cannot hold it on the path, so that the program would have no solution.
    """
    locked = disturbance == "locked" and scheme == next(iter(SCHEMES))
    return FREE if locked else scheme


def cells(size: Size, gains: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """List the cells of a league whose gains are known.

    Every network with every disturbance, each scheme in turn; the other budgets; and the control
    periods for the zeroing networks.
    """
    first = size.schemes[0]
    pairs = [(scheme, kind) for scheme in size.schemes for kind in size.disturbances]

    def more(network: str, **changes: Any) -> dict[str, Any]:
        return cell(
            network,
            **{
                "scheme": first,
                "work": size.middle,
                **gains[network],
                "seeds": size.others,
                "paths": list(size.paths),
                **changes,
            },
        )

    found = [
        more(
            network,
            scheme=of_league(scheme, kind),
            disturbance=kind,
            seeds=size.seeds if scheme == first else size.others,
        )
        for network, (scheme, kind) in product(size.networks, pairs)
    ]
    found += [
        more(network, disturbance=kind, work=work)
        for network, kind, work in product(size.networks, ("none", "white"), size.work)
        if work != size.middle and kind in size.disturbances
    ]
    found += [
        more(network, dt=dt, work=UNLIMITED, most=1, seeds=1)
        for network, dt in product(size.networks, PERIODS)
        if isinstance(part("network", network).network, ZeroingNetwork)
    ]
    unique = {repr(settings): settings for settings in found}
    return list(unique.values())


def measure(settings: Settings) -> Outcome:
    """Carry out the runs of one cell.

    Returns:
        For each of `MEASURES` a list with a number for each seed, None where the run failed: the
        root mean squares, over the second half of the run, of the answers' KKT residual and of the
        tool's position error [m]. ``failures``, the reasons; ``taken``, the evaluations a control
        period and their operations.
    """
    runs: list[dict[str, Any]] = []
    failures = []
    for seed in range(settings["seeds"]):
        try:
            with np.errstate(all="ignore"):  # a network that diverges ends its run
                runs.append(_run(settings, seed))
        except (IiwaDnnError, np.linalg.LinAlgError) as error:
            runs.append(dict.fromkeys(MEASURES))
            failures.append(str(error))
    values: dict[str, Any] = {name: [run[name] for run in runs] for name in MEASURES}
    taken = next((run["taken"] for run in runs if "taken" in run), None)
    return Outcome({**values, "taken": taken, "failures": sorted(set(failures))})


def evaluations_within(entry: Entry, sizes: Sizes, work: float) -> int:
    """Count the evaluations that a number of operations a control period allows.

    Raises:
        InvalidInputError: Not even one is possible.
    """
    setup, each = entry.work(sizes)
    count = int((work - setup) // each)
    if count < 1:
        raise InvalidInputError("work", f"one evaluation takes {setup + each:.0f} operations")
    return count


def _run(settings: Settings, seed: int) -> dict[str, Any]:
    """Drive the arm once."""
    dt = settings["dt"]
    steps = round(DURATION / dt)
    robot = paper_robot()
    scheme = part("scheme", settings["scheme"])
    reference = part("reference", settings["paths"][seed % len(settings["paths"])])
    program = scheme.program(robot)
    entry = part("network", settings["network"])
    count = evaluations_within(entry, program.sizes, settings["work"])
    if settings["most"] is not None:
        count = min(count, settings["most"])
    solver = entry.make(count, settings["share"], dt)
    draw = part("disturbance", settings["disturbance"])
    disturbance = draw(robot, np.random.default_rng(seed), steps, dt)
    loop = DisturbedLoop(program, solver, disturbance, reference, steps, dt)
    taken = [loop.step(k) for k in range(steps)]
    errors, residuals = np.array(taken).T
    half = slice(steps // 2, None)
    if not np.isfinite(residuals[half]).all():
        raise IiwaDnnError("the residual is not finite")
    setup, each = entry.work(program.sizes)
    return {
        "residual": float(np.sqrt(np.mean(residuals[half] ** 2))),
        "rms_error_m": float(np.sqrt(np.mean(errors[half] ** 2))),
        "taken": [count, setup + count * each],
    }
