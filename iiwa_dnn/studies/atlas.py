"""The atlas: networks, schemes and disturbances compared at equal compute, paired by seed.

Every network drives the paper's arm along a heart, in a loop that gives it so many evaluations a
control period: right-hand sides, or linear systems where it solves them. Each one's time constant
is as short as its discretisation is stable with, so that none is slowed down by a choice of ours.
A network of one's own is one line in `NETWORKS`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, product
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.errors import IiwaDnnError, InvalidInputError, NotFoundError
from iiwa_dnn.networks import (
    DualNetwork,
    Network,
    PrimalDualNetwork,
    ProjectionNetwork,
    SimplifiedDualNetwork,
)
from iiwa_dnn.networks.activated import ActivatedNetwork
from iiwa_dnn.networks.activations import FixedTime, PowerSigmoid, PredefinedTime, SignBiPower
from iiwa_dnn.networks.admm import AdmmSolver
from iiwa_dnn.networks.gradient import GradientNetwork
from iiwa_dnn.networks.integrators import SAFETY, ExplicitEuler, ImplicitEuler
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
from iiwa_dnn.studies.atlas_disturbances import DISTURBANCES, DT
from iiwa_dnn.studies.atlas_loop import DisturbedLoop
from iiwa_dnn.studies.atlas_schemes import SCHEMES
from iiwa_dnn.studies.runs import paper_robot
from iiwa_dnn.studies.sweeps import Outcome

DURATION = 0.5
"""Length of a run [s]."""


@dataclass(frozen=True)
class Paced(ExplicitEuler):
    """Explicit Euler by `substeps` steps, each as long as the network is stable with.

    Attributes:
        base: Network whose stable step is taken; None takes that of the network itself.
    """

    base: Network | None = None

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place, whatever the duration; returns the steps taken.

        Raises:
            InvalidInputError: The network knows no stable step.
        """
        step = SAFETY * (self.base or network).stable_step(qp, state)
        if not step > 0.0:
            raise InvalidInputError("network", "knows no stable step: take `settled`", network)
        rates = network.flow(qp).rates
        count = self.substeps or 1
        for _ in range(count):
            state += step * rates(state)
        return count


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
        make: Makes its solver from the evaluations a control period.
        systems: Whether an evaluation solves a linear system.
    """

    make: Callable[[int], DNNSolver]
    systems: bool = False


def still(network: Network, systems: bool = False) -> Entry:
    """Return the entry of a network for a program that stands still."""
    return Entry(lambda count: DNNSolver(network, follower=Paced(count)), systems)


def settled(network: Network) -> Entry:
    """Return the entry of a network that is integrated implicitly towards rest."""
    return Entry(lambda count: DNNSolver(network, follower=CutOff(max_steps=count)), systems=True)


def activated(network: Network, activation: Any) -> Entry:
    """Return the entry of an activated network, with the steps of the network itself."""
    whole = ActivatedNetwork(network=network, activation=activation)
    systems = isinstance(network, SimplifiedDualNetwork)
    return Entry(lambda count: DNNSolver(whole, follower=Paced(count, base=network)), systems)


def zeroing(gain: float, formula: Formula = EULER, **options: Any) -> Entry:
    """Return the entry of a zeroing network with a gain tau / rho."""

    def make(count: int) -> DNNSolver:
        network = ZeroingNetwork(rho=DT / count / gain, **options)
        return TrackingSolver(network, formula, count)

    return Entry(make, systems=True)


NETWORKS: dict[str, Entry] = {
    "projection (the paper's)": still(ProjectionNetwork()),
    "projection, bounds by multipliers only": still(ProjectionNetwork(primal_projection=False)),
    "one-layer": still(OneLayerNetwork(corrected=False)),
    "one-layer, corrected": still(OneLayerNetwork()),
    "dual": still(DualNetwork()),
    "simplified dual": still(SimplifiedDualNetwork(), systems=True),
    "primal-dual": still(PrimalDualNetwork()),
    "gradient": still(GradientNetwork()),
    "dual, finite time": activated(DualNetwork(), SignBiPower()),
    "dual, fixed time": activated(DualNetwork(), FixedTime()),
    "primal-dual, fixed time": activated(PrimalDualNetwork(), FixedTime()),
    "simplified dual, predefined time": activated(SimplifiedDualNetwork(), PredefinedTime()),
    "zeroing, Euler": zeroing(1.0),
    "zeroing, Taylor 3": zeroing(0.24, TAYLOR3),
    "zeroing, FIFD": zeroing(0.59, FIFD),
    "zeroing, Taylor 4": zeroing(0.074, TAYLOR4),
    "zeroing, Taylor 5": zeroing(0.16, TAYLOR5),
    "zeroing, power-sigmoid": zeroing(0.3, activation=PowerSigmoid()),
    "zeroing, sign-bi-power": zeroing(0.3, activation=SignBiPower()),
    "zeroing, fixed time": zeroing(0.3, activation=FixedTime()),
    "zeroing, predefined time": zeroing(0.1, activation=PredefinedTime()),
    "zeroing, noise-tolerant": zeroing(0.5, integral=0.25),
    "zeroing, growing gain": zeroing(0.05, growth=0.5),
    "zeroing, smooth": zeroing(1.0, form="smooth"),
    "projection, implicit Euler": settled(ProjectionNetwork(primal_projection=False)),
    "ADMM (OSQP)": Entry(AdmmSolver, systems=True),
}
"""Networks of the atlas by name, and the yardstick."""

MEASURES = ("rms_error_m", "max_error_m", "rms_residual", "advance_us")


def cell(
    network: str, scheme: str, disturbance: str, evaluations: int, seeds: int
) -> dict[str, Any]:
    """Return the settings of one cell: all seeds of a combination, one where there is no chance."""
    names = {"network": network, "scheme": scheme, "disturbance": disturbance}
    return {**names, "evaluations": evaluations, "seeds": 1 if disturbance == "none" else seeds}


def cells(
    seeds: int,
    others: int,
    evaluations: Sequence[int],
    schemes: Sequence[str] = tuple(SCHEMES),
    networks: Sequence[str] = (),
) -> list[dict[str, Any]]:
    """List the cells: every network with every scheme and disturbance, and the budgets.

    Args:
        seeds: Runs of each cell with chance in it, with the first scheme.
        others: Runs of each cell with chance in it, with another scheme or budget.
        evaluations: Evaluations a control period: all of them with the first scheme, undisturbed
            and with white noise; the middle one with everything.
        schemes: Names of the schemes.
        networks: Names of the networks; none: all.

    Raises:
        InvalidInputError: A scheme is not one of `SCHEMES`, or there is none.
        NotFoundError: A network is not one of `NETWORKS`.
    """
    if not schemes or not set(schemes) <= SCHEMES.keys():
        raise InvalidInputError("schemes", f"must be of {list(SCHEMES)}, not {list(schemes)}")
    networks = networks or tuple(NETWORKS)
    for name in networks:
        if name not in NETWORKS:
            raise NotFoundError("network", name, NETWORKS)
    middle = evaluations[len(evaluations) // 2]
    by_scheme = [
        [
            cell(network, scheme, kind, middle, seeds if scheme == schemes[0] else others)
            for network, kind in product(networks, DISTURBANCES)
        ]
        for scheme in schemes
    ]
    budgets = [
        cell(network, schemes[0], kind, count, others)
        for network, kind, count in product(networks, ("none", "white"), evaluations)
        if count != middle
    ]
    return [*by_scheme[0], *budgets, *chain(*by_scheme[1:])]


def measure(settings: Mapping[str, Any]) -> Outcome:
    """Carry out the runs of one cell.

    Returns:
        For each of `MEASURES` a list with a number for each seed, None where the run failed: the
        tool's position error over the second half of the run [m], its largest value, the KKT
        residual of the answers over that half, and the time of an answer [us]; ``failures``, the
        reasons.
    """
    runs = []
    failures = []
    for seed in range(settings["seeds"]):
        try:
            with np.errstate(all="ignore"):  # a network that diverges ends its run
                runs.append(_run(settings, seed))
        except (IiwaDnnError, np.linalg.LinAlgError) as error:
            runs.append(dict.fromkeys(MEASURES))
            failures.append(str(error))
    values: dict[str, Any] = {name: [run[name] for run in runs] for name in MEASURES}
    return Outcome({**values, "failures": sorted(set(failures))})


def _run(settings: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Drive the arm once."""
    steps = round(DURATION / DT)
    robot = paper_robot()
    scheme = SCHEMES[settings["scheme"]]()
    solver = NETWORKS[settings["network"]].make(settings["evaluations"])
    draw = DISTURBANCES[settings["disturbance"]]
    disturbance = draw(robot, np.random.default_rng(seed), steps)
    loop = DisturbedLoop(scheme.program(robot), solver, disturbance, steps)
    taken = [loop.step(k) for k in range(steps)]
    errors, residuals, seconds = np.array(taken).T
    half = slice(steps // 2, None)
    return {
        "rms_error_m": float(np.sqrt(np.mean(errors[half] ** 2))),
        "max_error_m": float(errors[half].max()),
        "rms_residual": float(np.sqrt(np.mean(residuals[half] ** 2))),
        "advance_us": 1e6 * float(seconds.sum()) / steps,
    }
