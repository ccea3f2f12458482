"""The numbers that sum up a run: pure functions of its record."""

from collections.abc import Mapping
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.files import plain
from iiwa_dnn.results.record import RATES, FloatArray, Record

ACTIONS = {1: "fallback", 2: "slow", 3: "relax", 4: "stop", 5: "euler"}
"""Codes in `Record.action`; 0 is the network's own answer."""

SETTLED_AFTER = 0.5
"""Time until an arm in physics has settled [s]; it starts at rest, its weight unknown."""

RECOVERED_BELOW = 1e-3
"""Largest distance to the path of a tip that has recovered from a push [m]."""

_AT_LIMIT = 1.0 - 1e-9

BoolArray = NDArray[np.bool_]
Codes = NDArray[Any]


def position_error(record: Record) -> FloatArray:
    """Compute the tip position minus the desired tip position [m], (N+1, 3)."""
    return record.position - record.position_desired


def orientation_error(record: Record) -> FloatArray:
    """Compute the angle between the tip's orientation and the desired one [rad], (N+1,)."""
    return rotation_angle(record.rotation, record.rotation_desired)


def rotation_angle(rotation: FloatArray, desired: FloatArray) -> FloatArray:
    """Compute the angle between two orientations (..., 3, 3) [rad], (...), in [0, π].

    With R_e = R_desiredᵀ R the angle is atan2(‖vee((R_e − R_eᵀ)/2)‖, (tr R_e − 1)/2). The usual
    arccos of the second argument alone cannot tell angles below 1e-8 rad from zero.
    """
    relative = np.swapaxes(desired, -1, -2) @ rotation
    skew = 0.5 * (relative - np.swapaxes(relative, -1, -2))
    sine = np.linalg.norm(skew[..., [2, 0, 1], [1, 2, 0]], axis=-1)
    cosine = 0.5 * (np.trace(relative, axis1=-1, axis2=-2) - 1.0)
    angle: FloatArray = np.arctan2(sine, cosine)
    return angle


def position_limit_excess(record: Record) -> FloatArray:
    """Compute the distance of each joint beyond its position limits [rad], (N+1, n); 0 inside."""
    lower, upper = limits(record, "q_lower", -np.inf), limits(record, "q_upper")
    # np.maximum, unlike max(), lets a NaN through.
    excess: FloatArray = np.maximum(np.maximum(lower - record.q, record.q - upper), 0.0)
    return excess


def velocity_limit_excess(record: Record) -> FloatArray:
    """Compute the excess of each joint's speed over its limit [rad/s], (N, n); 0 below."""
    excess: FloatArray = np.maximum(np.abs(record.dq) - limits(record, "dq_max"), 0.0)
    return excess


def rate_limit_excess(record: Record, order: int) -> FloatArray:
    """Compute the excess of each joint's acceleration or jerk over its limit, (N, n); 0 below.

    Finite differences of the commands, from rest, less the rounding that they carry on; the order
    is 1 for the acceleration [rad/s^2], 2 for the jerk [rad/s^3].
    """
    dt, still = record.settings["dt"], np.zeros((order, record.q.shape[1]))
    rates = np.diff(np.vstack([still, record.dq]), order, axis=0) / dt**order
    rounding = 8.0 * np.finfo(float).eps * np.abs(record.dq).max(initial=1.0) * (2.0 / dt) ** order
    allowed = limits(record, RATES[order - 1]) + rounding
    excess: FloatArray = np.maximum(np.abs(rates) - allowed, 0.0)
    return excess


def limits(record: Record, key: str, unlimited: float = np.inf) -> FloatArray:
    """Return a limit of each joint out of the settings, (n,); None there stands for no limit."""
    values = record.settings[key]
    return np.array([unlimited if value is None else value for value in values], dtype=float)


def bound_kinds(settings: Mapping[str, Any]) -> tuple[str, str]:
    """Name the bounds of a run's joints, those below the velocity limit and those at it.

    A bound may be another limit's than `JointLimits`; the settings list those under ``bounding``.
    """
    among = settings.get("bounding", ["JointLimits"])
    own = "bound of " + " or ".join(name for name in among if name != "JointLimits")
    if "JointLimits" not in among:
        return own, own
    return ("position" if len(among) == 1 else f"position limit or {own}"), "velocity"


def compute_metrics(record: Record) -> dict[str, Any]:
    """Sum up a run in plain JSON types, as metrics.json holds them.

    ``path_completed`` is the share of the asked path time that the reference's clock covered. Below
    1 the errors say little: they are measured against the slowed target. The mean squared error
    ``mse_position_error_m2`` is the mean over the N+1 samples *and* the three axes, which is most
    likely the paper's MSE: a third of the mean squared distance. ``duration_s`` is the time
    simulated; ``settings["duration"]`` was asked for. A run in physics also has ``physics``
    (torques, settled error, recovery from a push), one that tracks several frames ``frames``
    (largest errors of those beside the first), one with priorities ``level_residual`` (the largest
    of each level), a run in which a bound, an inequality row, a policy
    or clipping acted ``incidents``, one that avoids collisions ``collisions`` (the nearest pair,
    and by how much it came nearer than it may).

    Args:
        record: The run.

    Returns:
        The metrics, units in their names. A number that does not exist is None: an overflow, an
        unknown wall time, a maximum over no steps.
    """
    error = position_error(checks.instance("record", record, Record))
    duration = float(record.t[-1] - record.t[0])
    wall, settings = record.wall_time_s, record.settings
    metrics: dict[str, Any] = plain(
        {
            "path_completed": record.path_completed,
            "max_position_error_m": np.linalg.norm(error, axis=1).max(),
            "mse_position_error_m2": np.mean(error**2),
            "max_orientation_error_rad": orientation_error(record).max(),
            "joint_drift_rad": np.abs(record.q[-1] - record.q[0]).max(),
            "max_kinetic_index": _max(record.kinetic_index),
            "steps": record.steps,
            "dt_s": settings["dt"],
            "duration_s": duration,
            "wall_time_s": wall,
            "realtime_factor": duration / wall if wall else None,
            "position_limit_violation_rad": position_limit_excess(record).max(),
            "velocity_limit_violation_rad_s": velocity_limit_excess(record).max(initial=0.0),
            **_rate_limits(record),
            "max_kkt_residual": _max(record.kkt_residual),
            "crosscheck": _crosscheck(record),
            **_physics(record, np.linalg.norm(error, axis=1)),
            **_incidents(record),
            **_frames(record),
            **_collisions(record),
            "settings": {key: value for key, value in settings.items() if key != "versions"},
            "versions": settings.get("versions", {}),
        }
    )
    return metrics


def frame_errors(record: Record) -> tuple[FloatArray, FloatArray]:
    """Compute distances [m] and angles [rad] of the f further frames to their targets, (N+1, f)."""
    place, wanted = record.frame_position, record.frame_position_desired
    turn, desired = record.frame_rotation, record.frame_rotation_desired
    if place is None or wanted is None or turn is None or desired is None:
        return np.zeros((len(record.t), 0)), np.zeros((len(record.t), 0))
    return np.linalg.norm(place - wanted, axis=2), rotation_angle(turn, desired)


def _frames(record: Record) -> dict[str, Any]:
    """Largest errors of the tracked frames beside the first, and residuals of the levels."""
    found: dict[str, Any] = {}
    if record.frame_position is not None:
        worst = (errors.max(axis=0) for errors in frame_errors(record))
        found["frames"] = {
            name: {"max_position_error_m": distance, "max_orientation_error_rad": angle}
            for name, distance, angle in zip(record.settings["frames"], *worst, strict=True)
        }
    if record.level_residual is not None and record.steps:
        found["level_residual"] = record.level_residual.max(axis=0)
    return found


def _rate_limits(record: Record) -> dict[str, Any]:
    """Largest excess over acceleration and jerk limits of a scheme that has them."""
    names = ("acceleration_limit_violation_rad_s2", "jerk_limit_violation_rad_s3")
    return {
        name: rate_limit_excess(record, order).max(initial=0.0)
        for order, name in enumerate(names, start=1)
        if RATES[order - 1] in record.settings
    }


def _max(values: FloatArray) -> float | None:
    """Return the largest value (NaN if there is one), None of no values."""
    return float(values.max()) if values.size else None


def _crosscheck(record: Record) -> dict[str, Any]:
    """Count and size the differences to the reference solvers.

    An answer is believed only if the reference's own residual is within its tolerance; the gaps
    of the others are counted as `reference_failures` and enter no maximum.
    """
    check = record.settings["check"]
    gap, residual = record.solution_gap, record.reference_residual
    # A residual without a gap is an answer too: the network's own was then not a number.
    asked = ~(np.isnan(gap) & np.isnan(residual))
    believed = asked & (residual <= check["reference_tolerance"]) & ~np.isinf(gap)
    judged = record.settings["mode"] == "converged" and record.references > 0
    # Not `gap > tolerance`, which a NaN would pass.
    disagrees = believed & ~(gap <= check["tolerance"]) & judged
    return {
        "solver": "+".join(check["solvers"]) or "none",
        "steps_checked": int(asked.all(axis=1).sum()) if record.references else 0,
        "disagreements": int(disagrees.any(axis=1).sum()),
        "reference_failures": int((asked & ~believed).sum()),
        "max_solution_gap": _max(gap[believed]),
        "max_objective_gap": _max(record.objective_gap[believed]),
        "max_reference_residual": _max(residual[np.isfinite(residual)]),
        "judged": judged,
        "tolerance": check["tolerance"],
        "first_disagreement": _first_disagreement(record, disagrees),
    }


def _first_disagreement(record: Record, disagrees: BoolArray) -> dict[str, Any] | None:
    """Name the first step that disagrees, and the solver that differs most there."""
    steps = np.flatnonzero(disagrees.any(axis=1))
    if not steps.size:
        return None
    step = int(steps[0])
    solver = int(np.argmax(np.where(disagrees[step], record.solution_gap[step], -np.inf)))
    return {
        "step": step,
        "time_s": float(record.t[step]),
        "solver": record.settings["check"]["solvers"][solver],
        "gap": float(record.solution_gap[step, solver]),
    }


def _physics(record: Record, distance: FloatArray) -> dict[str, Any]:
    """Sum up torques, settled error and recovery, given the distance to the path [m], (N+1,)."""
    if record.torque is None:
        return {}
    largest = np.abs(record.torque).max(axis=0, initial=0.0)
    physics = {
        "settled_after_s": SETTLED_AFTER,
        "max_position_error_settled_m": _max(distance[record.t >= record.t[0] + SETTLED_AFTER]),
        "max_torque_n_m": largest,
        "torque_limit_n_m": record.settings["torque_max"],
        "max_torque_share": (largest / limits(record, "torque_max")).max(),
        "push": _push(record, distance),
    }
    return {"physics": physics}


def _push(record: Record, distance: FloatArray) -> dict[str, Any] | None:
    """Measure the recovery from a push; its time is None where the tip never came back for good."""
    push = record.settings.get("physics", {}).get("disturbances", {}).get("push")
    if push is None:
        return None
    end = push["start"] + push["duration"]
    after = record.t >= end
    far = record.t[after & ~(distance <= RECOVERED_BELOW)]
    # The first sample after the last one that is too far away.
    recovered = record.t[after & (record.t > (far[-1] if far.size else -np.inf))]
    return {
        **push,
        "max_position_error_m": _max(distance[record.t >= push["start"]]),
        "recovered_below_m": RECOVERED_BELOW,
        "recovery_s": max(0.0, recovered[0] - end) if recovered.size else None,
    }


def _incidents(record: Record) -> dict[str, Any]:
    """Count active bounds and rows, clipped commands, and steps that a policy decided."""
    arrays = (record.bound_multiplier, record.row_multiplier, record.clipped, record.action)
    if all(array is None for array in arrays):
        return {}
    action = np.zeros(record.steps, np.int8) if record.action is None else record.action
    taken, first = np.flatnonzero(action), None
    if taken.size:
        name = ACTIONS.get(int(action[taken[0]]), "unknown")
        first = {"step": int(taken[0]), "time_s": float(record.t[taken[0]]), "action": name}
    # A bound is the velocity limit itself, or the tighter one near a position limit.
    fast = np.abs(record.dq_solver) >= _AT_LIMIT * limits(record, "dq_max")
    blocking, multiplier = record.blocking, record.bound_multiplier
    blocked = [] if blocking is None else _bounds(record, blocking, np.abs(blocking) == 2)
    return {
        "incidents": {
            "clipped_steps": 0 if record.clipped is None else int(record.clipped.any(axis=1).sum()),
            **{f"{name}_steps": int((action == code).sum()) for code, name in ACTIONS.items()},
            "path_time_s": record.path_time,
            "first": first,
            "blocking": blocked,
            "blocking_rows": _rows(record, record.blocking_rows),
            "active_bounds": [] if multiplier is None else _bounds(record, multiplier, fast, True),
            "active_rows": _rows(record, record.row_multiplier, True),
        }
    }


def _collisions(record: Record) -> dict[str, Any]:
    """Name the nearest pair of a run, and the distance by which it was too near."""
    if record.distance is None or record.nearest is None:
        return {}
    least, stated = int(record.distance.argmin()), record.settings["collisions"]
    first, second = stated["pairs"][int(record.nearest[least])]
    distance, allowed = float(record.distance[least]), float(stated["distance"])
    where = {"first": first, "second": second, "time_s": float(record.t[least])}
    missing = max(0.0, allowed - distance)
    return {
        "collisions": {
            "least_distance_m": distance, **where, "allowed_m": allowed, "missing_m": missing,
        }
    }  # fmt: skip


def _bounds(
    record: Record, signed: Codes, at_velocity: BoolArray, sized: bool = False
) -> list[dict[str, Any]]:
    """List the bounds whose entries are signed: positive at an upper one, negative at a lower."""
    found = []
    sides, kinds = (("lower", -1), ("upper", 1)), enumerate(bound_kinds(record.settings))
    for joint, (side, sign), (fast, limit) in product(range(record.dof), sides, kinds):
        column = signed[:, joint]
        at = (np.sign(column) == sign) & (at_velocity[:, joint] == fast)
        name = {"joint": joint + 1, "side": side, "limit": limit}
        found += _spell(record, name, at, np.abs(column) if sized else None)
    return found


def _rows(record: Record, values: Codes | None, sized: bool = False) -> list[dict[str, Any]]:
    """List the inequality rows with a value above zero, (N, m)."""
    found: list[dict[str, Any]] = []
    if values is None:
        return found
    for row, column in zip(record.settings["rows"], values.T, strict=True):
        name = {key: row[key] for key in ("part", "row", "about") if key in row}
        found += _spell(record, name, column > 0, column if sized else None)
    return found


def _spell(
    record: Record, name: Mapping[str, Any], at: BoolArray, multiplier: Codes | None
) -> list[dict[str, Any]]:
    """Count the steps at which a bound or row acted, (N,); an empty list where it never did."""
    steps = np.flatnonzero(at)
    if not steps.size:
        return []
    time, first = float(record.settings["dt"]) * steps.size, float(record.t[steps[0]])
    spell = {**name, "steps": int(steps.size), "time_s": time, "first_s": first}
    if multiplier is not None:
        held = multiplier[at]
        spell |= {"max_multiplier": float(held.max()), "mean_multiplier": float(held.mean())}
    return [spell]
