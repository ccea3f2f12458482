"""Layout of the control steps for a scheme, references and a network."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from iiwa_dnn.control.command import lay_out_log
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators.base import (
    AnswerSettings,
    CompiledAnswer,
    Progress,
    enter_answer,
)
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Status, Vector
from iiwa_dnn.qp.layout import QPViews, Sizes
from iiwa_dnn.references import Reference
from iiwa_dnn.references.base import FeedForward, enter_path
from iiwa_dnn.schemes.joint_limits import (
    MotionConstants,
    check_ranges,
)
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.periods import checked_longest, constant_periods
from iiwa_dnn.schemes.separation import Separation
from iiwa_dnn.step.fallback import FALLBACK_BUDGET, Yielding
from iiwa_dnn.step.plan import ControlPlan, PathColumn, Paths
from iiwa_dnn.step.yielding import BRAKE

FEASIBLE_BUDGET = 60.0
"""Largest number of linear solves for a nominal program with acceleration or jerk limits."""


class ControlLayout:
    """Layout of the control steps for a scheme, references and a network.

    Attributes:
        program: The scheme laid out for the robot.
        log_layout: Layout of the step logs.
        shape: Shape of joint positions, (dof,).
        width: Number of floats in a log.
        timing: Periods of a step where none is stated.
        varies: Whether the settings of a step depend on its period: periods vary, or the network
            advances by the period (continuous mode).
        lag: Network time of a step per control period in continuous mode; 0 if the network solves.
        plan: Constants and work arrays of a step. It has paths if all references are compiled and
            no part of the scheme reads targets in Python.
        samples: Whether it has.
        asks: Whether Python is called before a step, for targets or for parts in numpy.
        has_network: Whether the network is compiled.
    """

    def __init__(
        self,
        program: ProgramLayout,
        references: Mapping[str, Reference],
        solver: DNNSolver,
        dt: float,
        policy: int,
        longest: float | None = None,
        lags: bool = False,
    ) -> None:
        """Lay a control step out.

        Args:
            program: The scheme laid out for the robot.
            references: Reference of each tracked frame, or none.
            solver: The network that answers the programs.
            dt: Control period [s].
            policy: Action of a step without a solution.
            longest: Longest control period [s]; None: all are dt.
            lags: Whether the network advances by the period (continuous mode); a step without a
                solution then brakes.

        Raises:
            InvalidInputError: With a jerk limit, a joint's range is too short to turn round in; or
                `longest` is below `dt`.
        """
        checked_longest(longest, dt)
        self.program = program
        arrays = program.arrays
        sizes = arrays.sizes
        self.shape = (sizes.joints,)
        self.timing = constant_periods(dt)
        self.log_layout = lay_out_log(sizes, LimitNames(program))
        self.width = self.log_layout.width
        # A subclass that solves in a way of its own is asked, not bypassed.
        own = (
            solver.compiled_answer(program.sizes, lags * dt) if type(solver) is DNNSolver else None
        )
        self.has_network = own is not None
        network = own or _asked(solver, program.sizes, lags * dt)
        self.lag = network.settings.duration / dt
        self.varies = lags or longest is not None
        limits = program.joint_limits
        if limits.rated:
            # A program that a few linear solves do not solve most likely has no solution.
            network.settings.budget = min(network.settings.budget, FEASIBLE_BUDGET)
        seen = {} if program.reads_targets else references
        paths = _compiled_paths(seen, program.target_frames, dt)
        self.samples = paths is not None
        self.asks = bool(program.refreshed) | (paths is None)
        yielding = make_yielding(program, solver.tol, self.has_network)
        fallback = np.zeros(fallback_size(program.sizes))
        none = Paths(np.zeros((0, len(PathColumn)), dtype=np.int64), np.zeros(0))
        self.plan = ControlPlan(
            arrays,
            network,
            paths or none,
            yielding,
            fallback,
            BRAKE if lags else policy,
            self.timing,
        )
        check_ranges(limits, 1.0 / (longest or dt))
        if yielding.lengthens.any():
            _check_lengthening(limits, longest)
        if longest is not None:
            _check_varying(program, longest)
            # No period may carry a joint beyond its position limit.
            limits.gain = min(limits.gain, 1.0 / longest)

    @property
    def most_solves(self) -> float:
        """Largest number of linear solves of a step, for its own program and all others."""
        return float(self.plan.network.settings.budget) + FALLBACK_BUDGET


def _check_lengthening(limits: MotionConstants, longest: float | None) -> None:
    """Refuse limits whose motions to rest may have to be longer, where these cannot be.

    Raises:
        InvalidInputError: Not all accelerations are limited, or control periods vary.
    """
    if not np.isfinite(limits.acceleration).all():
        problem = "of torques need limits of all accelerations beside them: AccelerationLimits()"
        raise InvalidInputError("limits", problem, limits.acceleration)
    if longest is not None:
        problem = "is no part of what TorqueLimits promise: their control period is constant"
        raise InvalidInputError("longest_period", problem, longest)


def _check_varying(program: ProgramLayout, longest: float) -> None:
    """Refuse control periods that vary where a stop may then take longer than its test counts on.

    Raises:
        InvalidInputError: Jerks are limited beside people.
    """
    if program.joint_limits.cubic and program.places_of(Separation):
        problem = (
            "with jerk limits is no part of what is promised beside people: a stop may take longer"
            " than its test counts on; drop one, as by with_limits(jerk=numpy.inf)"
        )
        raise InvalidInputError("longest_period", problem, longest)


def _asked(solver: DNNSolver, sizes: Sizes, duration: float) -> CompiledAnswer:
    """Wrap a solver that is not compiled as a compiled answer."""
    address = enter_answer.address(partial(ask, solver, sizes))
    settings = AnswerSettings.zeros(0)
    settings.tolerance = solver.tol
    settings.budget = np.inf
    settings.duration = duration
    return CompiledAnswer(address, 0, settings)


def _compiled_paths(
    references: Mapping[str, Reference], frames: Sequence[str], dt: float
) -> Paths | None:
    """Return the compiled paths of all frames, for a control period of dt [s].

    None if a frame has no reference or one in Python, or feed-forward of another period.
    """
    seen = [references[name] for name in frames if name in references]
    paths = [path.reference if isinstance(path, FeedForward) else path for path in seen]
    if len(paths) < len(frames) or not all(path.compiled for path in paths):
        return None
    if any(isinstance(path, FeedForward) and path.dt != dt for path in seen):
        return None
    return _laid_out(paths, seen)


def _laid_out(paths: Sequence[Reference], seen: Sequence[Reference]) -> Paths:
    """Lay out compiled paths; `seen` has each path itself, or the feed-forward that wraps it."""
    constants = [np.concatenate([path.base, path.constants]) for path in paths]
    stops = np.cumsum([own.size for own in constants])
    rows = [
        (enter_path.address(path.compiled), path is not other, stop - own.size, stop)
        for path, other, own, stop in zip(paths, seen, constants, stops, strict=True)
    ]
    return Paths(np.array(rows, dtype=np.int64), np.concatenate(constants))


def ask(
    solver: DNNSolver,
    sizes: Sizes,
    qp: QPViews,
    rates: int,
    settings: AnswerSettings,
    state: Vector,
    point: Vector,
) -> Progress:
    """Answer a program by a solver that is not compiled, called back as `enter_answer`.

    `solver` keeps its own state, so `rates` and `state` are ignored. If `settings.duration` [s] is
    above 0, the solver advances by it, else it solves. `point` (2 n + m + p,) is overwritten.
    """
    program = QP.from_data(np.concatenate([part.ravel() for part in qp]), sizes)
    if settings.duration > 0.0:
        solution = solver.advance(program, settings.duration)
    else:
        solution = solver.solve(program)
    point[:] = solution.point
    finite = solution.status is not Status.NOT_FINITE
    residuals = solution.residuals if finite else (np.inf, np.inf, np.inf)
    return solution.iterations, solution.network_time, *residuals


def make_yielding(program: ProgramLayout, tol: float, alike: bool) -> Yielding:
    """Return the constants of the fallback programs of a scheme.

    Args:
        program: The scheme.
        tol: Tolerance of the residuals of an answer.
        alike: Whether the network of the nominal program is compiled.
    """
    weights = program.row_weights
    rests = [k for k, part in enumerate(program.parts) if part.rest_kernel][::-1]  # joints first
    lasting = [program.parts[k] for k in rests]
    return Yielding(
        weights,
        tol,
        np.array(rests, dtype=np.int64),
        np.array([float(isinstance(part, Limit) and part.slower_helps) for part in lasting]),
        not all(isinstance(part, Limit) and part.rows_suffice for part in lasting),
        bool((weights == 0.0).any()),
        alike,
    )


def fallback_size(sizes: Sizes) -> int:
    """Return the length of the network states of the fallback programs, one after another.

    The first is that of the search of the scaling factor, which has one variable more; the second
    that of the scaled or relaxed program. `sizes` is (n, m, p) of the nominal program.
    """
    n, m, p = sizes
    return (3 * n + 3 + m + p) + (3 * n + m + p)
