"""The atlas: networks, schemes and disturbances compared at equal compute, paired by seed.

Every network drives the paper's arm along a heart, in a loop that gives it so many evaluations a
control period: right-hand sides, or linear systems where it solves them. Each one's time constant
is as short as its discretisation is stable with, so that none is slowed down by a choice of ours.
A network of one's own is one line in `NETWORKS`.
"""

import time
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
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Heart
from iiwa_dnn.robot import Configuration
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.atlas_disturbances import (
    DISTURBANCES,
    DT,
    as_measured,
    learn,
    noise_of,
    other_arm,
    pose_of,
)
from iiwa_dnn.studies.atlas_schemes import SCHEMES
from iiwa_dnn.studies.runs import paper_robot
from iiwa_dnn.studies.sweeps import Outcome

DURATION = 0.5
"""Length of a run [s]."""

PERIOD = 2.0
"""Time of a whole heart [s]."""


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
    kind, rng = settings["disturbance"], np.random.default_rng(seed)
    robot, scheme = paper_robot(), SCHEMES[settings["scheme"]]()
    solver = NETWORKS[settings["network"]].make(settings["evaluations"])
    arm = Kinematics(other_arm(robot, rng) if kind == "parameter" else robot)
    q = np.array(paper.START)
    program = scheme.program(robot)
    past = np.zeros((3, q.size))
    steps = round(DURATION / DT)
    n, m, p = program.sizes
    data = QP.from_data(np.zeros(program.data_size), program.sizes)
    heart = Heart(period=PERIOD).anchored(Configuration(arm.robot, q))
    targets = heart.sample(DT * np.arange(steps)).data
    errors, residuals, spent = np.empty(steps), np.empty(steps), 0.0
    noise, point = noise_of(kind, rng, steps), np.empty(2 * n + m + p)
    width = q.size if solver.network.carries_x else 0
    joint, locked = int(rng.integers(q.size)), int(rng.integers(steps // 2))
    before, was = q, np.empty(0)
    believed: Matrix = np.empty((0, 6))
    for k in range(steps):
        seen = q + (1e-4 * rng.standard_normal(q.size) if kind == "measurement" else 0.0)
        arm.update(q)
        tool, target = arm.placements[arm.frame_ids[0]].copy(), targets[k].copy()
        errors[k] = np.linalg.norm(target[:3] - tool[9:])
        if not errors[k] < 1.0:
            raise IiwaDnnError(f"the tool is {errors[k]:.2g} m away")
        program.update(seen)
        past[0] = seen
        if kind == "parameter":
            as_measured(target, tool, program.placement)
        if kind == "estimated":
            if k == 0:
                believed = arm.jacobian * (1.0 + 0.1 * rng.standard_normal((q.size, 6)))
            else:
                learn(believed, q - before, pose_of(tool) * pose_of(was).inverse())
            program.kinematics.jacobian[:] = believed
            was = tool
            before = q
        wanted = heart.accelerations(k * DT) if program.accelerates else None
        program.write(data.data, target.reshape(1, -1), past, DT, k * DT, wanted)
        velocity: Vector = past[1].copy()
        if kind == "locked" and k >= locked:
            data.lb[joint] = data.ub[joint] = -velocity[joint] / DT if program.accelerates else 0.0
        began = time.perf_counter()
        answer = solver.advance(data, DT)
        spent += time.perf_counter() - began
        residuals[k], x = answer.residuals.largest, answer.x
        state = solver.warm_state(data.sizes)
        if state is None:
            raise IiwaDnnError("the state is not finite")
        if noise is not None:  # the network's rates have it too, before it is read
            state[: width or state.size] += noise[k, : width or state.size]
            residuals[k] = max(solver.network.read(data, state, point))
            x = point
        past[1] = velocity + DT * x[: q.size] if program.accelerates else x[: q.size]
        if kind == "locked" and k >= locked:
            past[1, joint] = 0.0
        q = q + DT * (0.5 * (velocity + past[1]) if program.accelerates else past[1])
    half = slice(steps // 2, None)
    return {
        "rms_error_m": float(np.sqrt(np.mean(errors[half] ** 2))),
        "max_error_m": float(errors[half].max()),
        "rms_residual": float(np.sqrt(np.mean(residuals[half] ** 2))),
        "advance_us": 1e6 * spent / steps,
    }
