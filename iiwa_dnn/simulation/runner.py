"""Simulation of a run: controller, plant, noise and check in one loop."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from functools import cache
from typing import Any

from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.paths import References, beyond_reach, by_frame
from iiwa_dnn.errors import RunInterrupted
from iiwa_dnn.qp.check_pool import CheckPool
from iiwa_dnn.results.record import OWN_LIMITS, RATES, Record
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.robot import model_limits
from iiwa_dnn.schemes import Scheme, TorqueLimits
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.joint_limits import RateLimits
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.simulation.loop import Loop
from iiwa_dnn.simulation.motion import MOTIONS, check_motion
from iiwa_dnn.simulation.noise import SignalChain
from iiwa_dnn.simulation.recorder import Recorder
from iiwa_dnn.simulation.settings import RunSettings
from iiwa_dnn.step.log import log_of

COMPLETED = "completed"

BLOCK = 1000
"""Steps between two hand-overs to the record and to the check."""

_PACKAGES = ("iiwa-dnn", "numpy", "pin", "qpsolvers", "proxsuite", "osqp")


@cache  # reading them takes as long as a hundred steps
def _versions() -> dict[str, str]:
    """Return the versions of the packages that a run depends on."""
    from importlib.metadata import version  # a slow import

    return {name: version(name) for name in _PACKAGES}


def simulate(
    robot: Robot,
    scheme: Scheme,
    reference: References,
    q0: ArrayLike,
    settings: RunSettings | None = None,
    *,
    progress: Callable[[int], object] = lambda steps: None,
    **changes: Any,
) -> Record:
    """Simulate a robot that follows a reference, each step's program solved and checked.

    The settings of the run are a `RunSettings`, or its attributes by their names, as in
    ``simulate(robot, scheme, reference, q0, dt=1e-3, duration=10.0)``. The same seed gives the same
    record, bit for bit, but for the last digits of the gap to ProxQP, which does not repeat itself.

    Args:
        robot: The robot, n joints, with the limits that the scheme keeps.
        scheme: Builds the programs; if it has no home, `q0` becomes it.
        reference: Path of the tip, or paths by frame name; anchored by the caller.
        q0: Joint positions at the start [rad], (n,).
        settings: Settings of the run.
        progress: Called with 0 when the arguments are found to be right, then now and then with the
            number of steps taken since the last call.
        changes: Attributes of the settings that differ.

    Returns:
        The record of the run, of every step, or of those until a policy or the plant ended it.

    Raises:
        InvalidInputError: An argument is out of range; the message names it.
        NotFoundError: There is no setting of a name; the error lists those of similar names.
        RunInterrupted: Ctrl-C was pressed; it has the record of the steps that were taken.
    """
    began = time.perf_counter()
    start = Configuration(robot, q0)
    checks.known("setting of a run", changes, [each.name for each in fields(RunSettings)])
    run = replace(settings, **changes) if settings else RunSettings(**changes)
    controller = Controller(
        robot,
        scheme,
        reference,
        dt=run.dt,
        mode=run.mode,
        policy=run.policy,
        solver=run.solver,
    )
    controller.solver.reset()
    steps = run.steps(reference)
    controller.anchor(start)
    controller.warn_of_start(start, 0.0, own=True)
    plant = run.plant
    one_clock = run.mode == "continuous" or not plant.exact
    check_motion(run.motion, one_clock, controller.scheme.sample == "end")
    chain = SignalChain(run, (steps, robot.dof))
    entries = {
        **_settings(controller, start, run.duration_of(reference)),
        **chain.settings,
        "motion": run.motion if plant.exact else "physics",
        "seed": run.seed,
        "check": run.check.settings(),
        **plant.start(robot, start.q, controller.dt, run.seed),
    }
    loop = Loop(controller, plant, chain, MOTIONS[run.motion], start.q)
    recorder = Recorder(steps, controller, loop.q)
    progress(0)
    stages = MOTIONS[run.motion].stages
    pool = CheckPool(run.check, steps * stages)
    interrupt = _take_steps(steps, loop, recorder, pool, progress)
    agreement = pool.finish().worst_of(stages)
    columns = recorder.finish(len(agreement.judge))  # without what was on its way to the check
    avoidance = avoidance_of(controller.scheme)
    if avoidance is not None:
        nearest = avoidance.scene(robot).nearest(columns["q"], columns["t"])
        columns |= dict(zip(("distance", "nearest"), nearest, strict=True))
    record = Record(
        **columns,
        **agreement._asdict(),
        settings={
            **entries,
            "status": "interrupted" if interrupt else _status(recorder, controller, loop.fault),
            "infeasible_step": recorder.infeasible,
        },
        wall_time_s=time.perf_counter() - began,
    )
    if interrupt is None:
        return record
    raise RunInterrupted(*interrupt.args, record=record) if record.steps else interrupt


def _take_steps(
    steps: int,
    loop: Loop,
    recorder: Recorder,
    pool: CheckPool,
    progress: Callable[[int], object],
) -> KeyboardInterrupt | None:
    """Take the steps of a run; return the KeyboardInterrupt that cut it short, or None."""
    layout = recorder.layout

    def hand_over() -> None:
        """Pass the steps that were taken on to the record and to the check."""
        rows = recorder.flush()
        logs = log_of(rows, layout.sizes)
        pool.submit(logs.program, layout.qp_sizes, logs.point)

    try:
        for first in range(0, steps, BLOCK):
            taken = loop.run(first, min(BLOCK, steps - first), recorder.observe)
            hand_over()
            progress(taken)
            if recorder.last_step is not None:
                break
    except KeyboardInterrupt as interrupt:
        if recorder.outcomes:
            hand_over()
        return interrupt
    return None


def _settings(controller: Controller, start: Configuration, duration: float) -> dict[str, Any]:
    """Return the settings that a record keeps of controller, start and duration [s] of a run."""
    robot = controller.robot
    solver = controller.solver
    program = controller.program
    integrator = (
        solver.solve_integrator if controller.mode == "converged" else solver.advance_integrator
    )
    paths = by_frame(controller.reference, "").values()
    rates = program.joint_limits
    kept = dict(zip(RATES, (rates.acceleration, rates.jerk), strict=True))
    own = [*model_limits(robot.model), *robot.limits[3:]]
    limits: dict[str, Any] = {
        RATES[named.quantity]: kept[named.quantity]
        for named in controller.scheme.limits
        if isinstance(named, RateLimits)
    }
    for limit in controller.scheme.limits:
        if isinstance(limit, TorqueLimits):
            limits["demand_max"] = limit.largest(robot)
    if (avoidance := avoidance_of(controller.scheme)) is not None:
        limits["collisions"] = avoidance.overview(robot)
    return {
        "dt": controller.dt,
        "duration": duration,
        "path_duration": max((path.duration for path in paths), default=duration),
        "mode": controller.mode,
        "policy": controller.policy,
        "versions": _versions(),
        "robot": robot.name,
        "joints": robot.joint_names,
        "locked": dict(zip(robot.locked, robot.q_locked, strict=True)) or None,
        "tip": program.target_frames[0],
        "tools": [tool.settings() for tool in robot.tools],
        "frames": list(program.target_frames[1:]),
        "q_lower": robot.q_lower,
        "q_upper": robot.q_upper,
        "dq_max": robot.dq_max,
        **{f"robot_{name}": limit for name, limit in zip(OWN_LIMITS.values(), own, strict=True)},
        **limits,
        "beyond_reach": beyond_reach(controller.reference, robot),
        "start_speed": max((abs(path.at(0.0).data[12:]).max() for path in paths), default=0.0),
        "q0": start.q,
        "tol": solver.tol,
        "most_linear_solves": controller.control_layout.most_solves,
        "rho": solver.network.rho,
        "network": solver.network.settings(),
        "integrator": integrator.settings(),
        "scheme": controller.scheme.settings(),
        "reference": _reference_settings(controller.reference),
        **LimitNames(program).settings,
    }


def _status(recorder: Recorder, controller: Controller, fault: str | None) -> str:
    """Describe the end of a run."""
    k = recorder.last_step
    if k is None:
        return COMPLETED
    diverged = "the network diverged: take a smaller dt, larger rho or more substeps"
    reason = fault or (diverged if controller.mode == "continuous" else "no solution")
    return f"stopped at step {k} (t = {k * controller.dt:g} s): {reason}"


def _reference_settings(reference: References | None) -> dict[str, Any]:
    """Return name and parameters of a reference, or of each frame's."""
    if not isinstance(reference, Mapping):
        return {} if reference is None else reference.settings()
    return {"name": "frames"} | {name: path.settings() for name, path in reference.items()}
