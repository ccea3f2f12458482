"""The numbers that sum up a run: pure functions of its record."""

from collections.abc import Callable, Mapping
from functools import partial
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.files import plain
from iiwa_dnn.naming import KINDS, bound_name, bound_words, in_the_way, joint_name
from iiwa_dnn.results.record import RATES, FloatArray, Record

PROOF = "proof"
"""Name of the proof among a run's reference solvers."""

PROGRAMS = ("own", "scaled", "softened", "held", "stopped")
"""Kinds of a step by their codes in `Record.kind`."""

_HELD = PROGRAMS.index("held")
_STOPPED = PROGRAMS.index("stopped")

EXCESS_TOLERANCE = 1e-9
"""Excess of a command over the bounds and rows of its own step that is rounding."""

BOUNDS = "bounds"
"""Name of what judges a command beside its step's own bounds and rows."""

_SLOW = 2
ACTIONS = {_SLOW: "slow", 3: "relax", 4: "stop", 5: "euler"}
"""Codes in `Record.action`; 0 is the network's own answer."""

SETTLED_AFTER = 0.5
"""Time until an arm in physics has settled [s]; it starts at rest, its weight unknown."""

FAR = 1e-3
"""Distance between tip and path at the start of a run [m] from which on it is worth a word."""

RECOVERED_BELOW = 1e-3
"""Largest distance to the path of a tip that has recovered from a push [m]."""

_AT_LIMIT = 1.0 - 1e-9
_VELOCITY = 1 + KINDS.index("velocity")

BoolArray = NDArray[np.bool_]
Codes = NDArray[Any]


def position_error(record: Record) -> FloatArray:
    """Compute the tip position minus the desired tip position [m], (N+1, 3)."""
    return record.position - record.position_desired


def orientation_error(record: Record) -> FloatArray:
    """Compute the angle between the tip's orientation and the desired one [rad], (N+1,)."""
    return rotation_angle(record.rotation, record.rotation_desired)


def frame_errors(record: Record) -> tuple[FloatArray, FloatArray]:
    """Compute distances [m] and angles [rad] of the f further frames to their targets, (N+1, f)."""
    offset = record.frame_position - record.frame_position_desired
    angle = rotation_angle(record.frame_rotation, record.frame_rotation_desired)
    return np.linalg.norm(offset, axis=2), angle


def rotation_angle(rotation: FloatArray, desired: FloatArray) -> FloatArray:
    """Compute the angle between two orientations (..., 3, 3) [rad], (...), in [0, π].

    With R_e = R_desiredᵀ R the angle is atan2(‖vee((R_e − R_eᵀ)/2)‖, (tr R_e − 1)/2). The usual
    arccos of the second argument alone is the same for all angles below 1e-8 rad.
    """
    relative = np.swapaxes(desired, -1, -2) @ rotation
    skew = 0.5 * (relative - np.swapaxes(relative, -1, -2))
    sine = np.linalg.norm(skew[..., [2, 0, 1], [1, 2, 0]], axis=-1)
    cosine = 0.5 * (np.trace(relative, axis1=-1, axis2=-2) - 1.0)
    angle: FloatArray = np.arctan2(sine, cosine)
    return angle


def limits(record: Record, key: str, unlimited: float = np.inf) -> FloatArray:
    """Return a limit of each joint out of the settings, (n,); None there stands for no limit."""
    values = record.settings[key]
    return np.array([unlimited if value is None else value for value in values], dtype=float)


def _rate_excess(record: Record, order: int) -> FloatArray:
    """Compute the excess of each joint's acceleration or jerk over its limit, (N, n).

    Finite differences of the commands, from rest, less the rounding that they carry on; the order
    is 1 for the acceleration [rad/s^2], 2 for the jerk [rad/s^3].
    """
    dt = record.settings["dt"]
    from_rest = np.vstack([np.zeros((order, record.dof)), record.dq])
    rates = np.diff(from_rest, order, axis=0) / dt**order
    rounding = 8.0 * np.finfo(float).eps * np.abs(record.dq).max(initial=1.0) * (2.0 / dt) ** order
    excess: FloatArray = np.abs(rates) - (limits(record, RATES[order - 1]) + rounding)
    return excess


class JointLimit(NamedTuple):
    """A limit on every joint that a run is judged by.

    Attributes:
        kind: Limited quantity.
        setting: Name of the limit in the settings of a record, which may lack it.
        metric: Name of the largest excess among the metrics.
        unit: Unit of the excess.
        excess: Computes the excess at each step or sample, (N, n) or (N+1, n).
    """

    kind: str
    setting: str
    metric: str
    unit: str
    excess: Callable[[Record], FloatArray]


JOINT_LIMITS = (
    JointLimit(
        "position",
        "q_upper",
        "position_limit_violation_rad",
        "rad",
        # np.maximum, unlike max(), lets a NaN through.
        lambda record: np.maximum(
            limits(record, "q_lower", -np.inf) - record.q, record.q - limits(record, "q_upper")
        ),
    ),
    JointLimit(
        "velocity",
        "dq_max",
        "velocity_limit_violation_rad_s",
        "rad/s",
        lambda record: np.abs(record.dq) - limits(record, "dq_max"),
    ),
    JointLimit(
        "acceleration",
        "ddq_max",
        "acceleration_limit_violation_rad_s2",
        "rad/s²",
        partial(_rate_excess, order=1),
    ),
    JointLimit(
        "jerk",
        "dddq_max",
        "jerk_limit_violation_rad_s3",
        "rad/s³",
        partial(_rate_excess, order=2),
    ),
)


class Metric(NamedTuple):
    """A number that sums up a run.

    Attributes:
        key: Name in metrics.json, with its unit.
        quantity: Name in a report; empty: not in the report.
        unit: Unit in a report.
        compute: Computes it from the record; None if it does not exist.
    """

    key: str
    quantity: str
    unit: str
    compute: Callable[[Record], Any]


METRICS = (
    Metric("path_completed", "path completed", "", lambda record: record.path_completed),
    Metric("start_distance_m", "", "m", lambda record: _distance(record)[0]),
    Metric("max_position_error_m", "largest position error", "m", lambda r: _distance(r).max()),
    Metric(
        "mse_position_error_m2",
        "mean squared position error",
        "m²",
        lambda record: np.mean(position_error(record) ** 2),
    ),
    Metric(
        "max_orientation_error_rad",
        "largest orientation error",
        "rad",
        lambda record: orientation_error(record).max(),
    ),
    Metric(
        "joint_drift_rad",
        "joint drift, start to end",
        "rad",
        lambda record: np.abs(record.q[-1] - record.q[0]).max(),
    ),
    Metric(
        "max_kinetic_index",
        "largest kinetic index",
        "rad²/s²",
        lambda record: _max(record.kinetic_index),
    ),
    Metric("steps", "", "", lambda record: record.steps),
    Metric("dt_s", "", "s", lambda record: record.settings["dt"]),
    Metric("duration_s", "", "s", lambda record: float(record.t[-1] - record.t[0])),
    Metric("wall_time_s", "wall time", "s", lambda record: record.wall_time_s),
    Metric(
        "realtime_factor",
        "time simulated / wall time",
        "",
        lambda r: (r.t[-1] - r.t[0]) / r.wall_time_s if r.wall_time_s else None,
    ),
    Metric("max_kkt_residual", "largest KKT residual", "", lambda r: _max(r.kkt_residual)),
    Metric(
        "active_limit_steps",
        "steps with an active bound or row",
        "",
        lambda record: _active(record).sum(),
    ),
)
"""The numbers that every run has, but for the excess over `JOINT_LIMITS`."""


def compute_metrics(record: Record) -> dict[str, Any]:
    """Sum up a run in plain JSON types, as metrics.json holds them.

    ``path_completed`` is the fraction of the path's time that the reference's clock covered. Below
    1 the errors say little: they are measured against the slowed target. The path's time is that of
    the path once, or the run's if it is shorter. The mean squared error
    ``mse_position_error_m2`` is the mean over the N+1 samples *and* the three axes, which is most
    likely the paper's MSE: a third of the mean squared distance. ``duration_s`` is the time
    simulated; ``settings["duration"]`` was asked for. ``violations`` says of each broken limit
    where its excess is largest, ``unsolved`` of the answers above the tolerance which is the first.
    A run in physics also has ``physics`` (torques, settled error, recovery from a push), one that
    tracks several frames ``frames`` (largest errors of those beside the first), a run in which a
    bound, an inequality row, a policy or clipping acted ``incidents``, one that avoids collisions
    ``collisions`` (the nearest pair, and by how much it came nearer than it may).

    Args:
        record: The run.

    Returns:
        The metrics, units in their names. A number that does not exist is None: an overflow, an
        unknown wall time, a maximum over no steps.
    """
    checks.instance("record", record, Record)
    settings = record.settings
    broken = {
        limit.metric: limit.excess(record) for limit in JOINT_LIMITS if limit.setting in settings
    }
    metrics: dict[str, Any] = plain(
        {
            **{metric.key: metric.compute(record) for metric in METRICS},
            **{name: excess.max(initial=0.0) for name, excess in broken.items()},
            "violations": {name: _worst(record, excess) for name, excess in broken.items()},
            "unsolved": _unsolved(record),
            "network_iterations": {
                "mean": record.iterations.mean() if record.steps else None,
                "max": _max(record.iterations),
            },
            "crosscheck": _crosscheck(record),
            **_physics(record),
            **_incidents(record),
            **_frames(record),
            **_collisions(record),
            "settings": {key: value for key, value in settings.items() if key != "versions"},
            "versions": settings.get("versions", {}),
        }
    )
    return metrics


def _distance(record: Record) -> FloatArray:
    """Compute the distance of the tip from its target [m], (N+1,)."""
    distance: FloatArray = np.linalg.norm(position_error(record), axis=1)
    return distance


def _max(values: NDArray[Any]) -> Any:
    """Return the largest value (NaN if there is one), None of no values."""
    return values.max() if values.size else None


def _first(record: Record, acts: BoolArray) -> dict[str, Any] | None:
    """Count steps (N,), and name the first of them."""
    steps = np.flatnonzero(acts)
    if not steps.size:
        return None
    return {"steps": steps.size, "step": steps[0], "time_s": record.t[steps[0]]}


def _unsolved(record: Record) -> dict[str, Any] | None:
    """Count the answers above the tolerance, and name the first of them."""
    first = _first(record, ~(record.kkt_residual <= record.settings["tol"]))
    return first and first | {"residual": record.kkt_residual[first["step"]]}


def _worst(record: Record, excess: FloatArray) -> dict[str, Any] | None:
    """Name the joint and the step of the largest excess (k, n) above zero."""
    if not excess.max(initial=0.0) > 0.0:
        return None
    step, joint = np.unravel_index(int(excess.argmax()), excess.shape)
    return {
        "joint": joint_name(record.settings, int(joint)),
        "step": step,
        "time_s": record.t[step],
    }


def _active(record: Record) -> BoolArray:
    """Test for each step whether a bound or an inequality row was active, (N,)."""
    multipliers = [record.filled(name) for name in ("bound_multiplier", "row_multiplier")]
    return np.asarray(np.hstack(multipliers).any(axis=1))


def _crosscheck(record: Record) -> dict[str, Any]:
    """Count and size the differences to the reference solvers.

    An answer is believed only if the reference's own residual is within its tolerance; the gaps
    of the others are counted as `reference_failures` and enter no maximum. A command outside of the
    bounds and rows of its own step disagrees whatever the references say; of a stopped step there
    is nothing to check.
    """
    check = record.settings["check"]
    kind = record.filled("kind")
    gap = record.solution_gap
    residual = record.reference_residual
    converged = record.settings["mode"] == "converged"
    # A residual without a gap is an answer too: the network's own was then not a number.
    asked = ~(np.isnan(gap) & np.isnan(residual)) & (kind != _STOPPED)[:, np.newaxis]
    believed = asked & (residual <= check["reference_tolerance"]) & ~np.isinf(gap)
    # Not `gap > tolerance`, which a NaN would pass.
    differs = believed & ~(gap <= check["tolerance"]) & converged
    excess = record.filled("excess")
    outside = ~(excess <= EXCESS_TOLERANCE) & (kind != _STOPPED) & converged
    disagrees = differs.any(axis=1) | outside
    checked = asked.all(axis=1) & (record.references > 0)
    proofs = [name == PROOF for name in check["solvers"]]
    first = _first(record, disagrees)
    return {
        "solver": "+".join(check["solvers"]) or "none",
        **({"proven": believed[:, proofs].sum()} if any(proofs) else {}),
        "steps_checked": checked.sum(),
        "kinds": {
            name: ((kind == code) & (checked | (code >= _HELD))).sum()
            for code, name in enumerate(PROGRAMS)
        },
        "judged_by": _judged_by(record, asked),
        "disagreements": disagrees.sum(),
        "reference_failures": (asked & ~believed).sum(),
        "max_solution_gap": _max(gap[believed]),
        "max_objective_gap": _max(record.objective_gap[believed]),
        "max_reference_residual": _max(residual[np.isfinite(residual)]),
        "max_excess": _max(excess),
        "judged": converged and record.references > 0,
        "tolerance": check["tolerance"],
        "first_disagreement": first and _who(record, first, differs, outside),
    }


def _judged_by(record: Record, asked: BoolArray) -> dict[str, int]:
    """Count the answers that each solver judged: those asked for, and the second ones."""
    check = record.settings["check"]
    counts: dict[str, int] = {}
    pairs = zip(check["solvers"], check.get("second", check["solvers"]), strict=True)
    for i, pair in enumerate(pairs if len(record.judge) else ()):
        for code, solver in enumerate(pair):
            judged = int((asked[:, i] & (record.judge[:, i] == code)).sum())
            counts[solver] = counts.get(solver, 0) + judged
    return {solver: count for solver, count in counts.items() if count}


def _who(
    record: Record, first: dict[str, Any], differs: BoolArray, outside: BoolArray
) -> dict[str, Any]:
    """Name the solver that differs most at the first step that disagrees, or its bounds."""
    step = first["step"]
    found = {"step": step, "time_s": first["time_s"]}
    if outside[step]:
        return found | {"solver": BOUNDS, "gap": record.excess[step]}
    gap = record.solution_gap[step]
    solver = int(np.argmax(np.where(differs[step], gap, -np.inf)))
    return found | {"solver": record.settings["check"]["solvers"][solver], "gap": gap[solver]}


def _physics(record: Record) -> dict[str, Any]:
    """Sum up torques, settled error and recovery from a push."""
    if not len(record.torque):
        return {}
    distance = _distance(record)
    torque = np.abs(record.torque)
    limit = limits(record, "torque_max")
    reached = [_first(record, ~(torque[:, i] < limit[i])) for i in range(record.dof)]
    physics = {
        "settled_after_s": SETTLED_AFTER,
        "max_position_error_settled_m": _max(distance[record.t >= record.t[0] + SETTLED_AFTER]),
        "max_torque_n_m": torque.max(axis=0),
        "torque_limit_n_m": record.settings["torque_max"],
        "max_torque_share": (torque.max(axis=0) / limit).max(),
        "torque_limit_reached": [
            {"joint": joint_name(record.settings, i), "limit_n_m": limit[i], **first}
            for i, first in enumerate(reached)
            if first is not None
        ],
        "push": _push(record, distance),
    }
    return {"physics": physics}


def _push(record: Record, distance: FloatArray) -> dict[str, Any] | None:
    """Measure the recovery from a push; its time is None where the tip never came back for good."""
    push = (record.settings.get("physics") or {}).get("disturbances", {}).get("push")
    if push is None:
        return None
    end = push["start"] + push["duration"]
    far = record.t[(record.t >= end) & ~(distance <= RECOVERED_BELOW)]
    # The first sample after the last one that is too far away.
    recovered = record.t[(record.t >= end) & (record.t > max([*far[-1:], -np.inf]))]
    return {
        **push,
        "max_position_error_m": _max(distance[record.t >= push["start"]]),
        "recovered_below_m": RECOVERED_BELOW,
        "recovery_s": max(0.0, recovered[0] - end) if recovered.size else None,
    }


def _frames(record: Record) -> dict[str, Any]:
    """Sum up the errors of the tracked frames beside the first."""
    if not len(record.frame_position):
        return {}
    largest = [errors.max(axis=0) for errors in frame_errors(record)]
    frames = {
        name: {"max_position_error_m": distance, "max_orientation_error_rad": angle}
        for name, distance, angle in zip(record.settings["frames"], *largest, strict=True)
    }
    return {"frames": frames}


def _collisions(record: Record) -> dict[str, Any]:
    """Name the nearest pair of a run, and the distance by which it was too near."""
    if not len(record.distance):
        return {}
    least = int(record.distance.argmin())
    stated = record.settings["collisions"]
    first, second = stated["pairs"][int(record.nearest[least])]
    found = {
        "least_distance_m": record.distance[least],
        "first": first,
        "second": second,
        "time_s": record.t[least],
        "allowed_m": stated["distance"],
        "missing_m": max(0.0, stated["distance"] - float(record.distance[least])),
    }
    return {"collisions": found}


def _incidents(record: Record) -> dict[str, Any]:
    """Count active bounds and rows, clipped commands, and steps that a policy decided."""
    columns = ("bound_multiplier", "row_multiplier", "clipped", "action")
    if not any(len(getattr(record, name)) for name in columns):
        return {}
    action = record.filled("action")
    kinds: Codes = record.bound_kind
    if not len(kinds):
        # A bound is the velocity limit itself, or the tighter one near a position limit.
        kinds = 1 + (np.abs(record.dq_solver) >= _AT_LIMIT * limits(record, "dq_max"))
    blocking = record.filled("blocking")
    first = _first(record, action != 0)
    slow = action == _SLOW
    return {
        "incidents": {
            "clipped_steps": record.filled("clipped").any(axis=1).sum(),
            **{f"{name}_steps": (action == code).sum() for code, name in ACTIONS.items()},
            "path_time_s": record.path_time,
            "needed": _needed(record, slow),
            "off_path_m": _off_path(record, slow),
            "first": first and _what(record, first, action),
            "blocking": _bounds(record, blocking, np.abs(blocking)),
            "blocking_rows": _rows(record, "blocking_rows"),
            "active_bounds": _bounds(
                record, record.filled("bound_multiplier"), np.abs(kinds), True
            ),
            "active_rows": _rows(record, "row_multiplier", True),
        }
    }


def _begins_far(record: Record) -> bool:
    return bool(_distance(record)[0] > FAR)


def _needed(record: Record, slow: BoolArray) -> dict[str, Any] | None:
    """Estimate the speed that would have sufficed where velocity limits alone slowed the path.

    With its velocity over the fraction of the path's speed that it had, a slowed step would have
    followed the path at its own speed. The time is that of the path once at the mean pace. What is
    left of an incomplete path may need more. A tip that begins far from the path was slowed on its
    way there, which says nothing of the path.
    """
    acting = np.abs(record.filled("blocking")[slow])
    by_velocity = (acting == _VELOCITY).any(axis=1) & np.isin(acting, (0, _VELOCITY)).all(axis=1)
    if not (slow.any() and by_velocity.all()) or record.blocking_rows.any() or _begins_far(record):
        return None
    fraction = record.filled("fraction")[slow, np.newaxis]
    ratio = (np.abs(record.dq_solver[slow]) / limits(record, "dq_max") / fraction).max(axis=0)
    joint = int(ratio.argmax())
    return {
        "joint": joint + 1,
        "name": joint_name(record.settings, joint),
        "speed_ratio": ratio[joint],
        "time_s": record.t[-1] * record.path_duration / max(record.path_time, 1e-300),
    }


def _off_path(record: Record, slow: BoolArray) -> float | None:
    """Compute the largest distance [m] to the slowed target where inequality rows slowed the path.

    A tip that begins far from the path, or that acceleration limits hold back, says nothing of it.
    """
    rows = record.filled("blocking_rows").any(axis=1)
    slowed = rows & slow & (np.abs(record.filled("blocking")) <= _VELOCITY).all(axis=1)
    if not slowed.any() or _begins_far(record):
        return None
    return float(_distance(record)[1:][slowed].max())


def _what(record: Record, first: dict[str, Any], action: Codes) -> dict[str, Any]:
    """Name the action at the first step that a policy decided, and the limits in its way."""
    step = first["step"]
    acting = [record.filled(column)[step] for column in ("blocking", "blocking_rows")]
    return {
        "step": step,
        "time_s": first["time_s"],
        "action": ACTIONS.get(int(action[step]), "unknown"),
        "against": in_the_way(record.settings, *acting),
    }


def _bounds(
    record: Record, values: Codes, kinds: Codes, sized: bool = False
) -> list[dict[str, Any]]:
    """Sum up entries (N, n) by the bound: positive ones are an upper one's, negative a lower's."""
    words = bound_words(record.settings)
    joints = record.settings.get("joints", ())
    return [
        _spell(record, bound_name(joint, sign * code, words, joints), acting, sized)
        for joint, sign, code in product(range(record.dof), (-1, 1), range(1, 1 + len(words)))
        if (acting := sign * values[:, joint] * (kinds[:, joint] == code)).max(initial=0.0) > 0.0
    ]


def _rows(record: Record, column: str, sized: bool = False) -> list[dict[str, Any]]:
    """Sum up a column of the inequality rows by the row."""
    rows = record.settings.get("rows") or ()
    return [
        _spell(record, row, values, sized)
        for row, values in zip(rows, record.filled(column).T, strict=True)
        if (values > 0).any()
    ]


def _spell(record: Record, name: Mapping[str, Any], values: Codes, sized: bool) -> dict[str, Any]:
    """Count the steps at which a limit acted, those with an entry (N,) above zero."""
    steps = np.flatnonzero(values > 0)
    time = float(record.settings["dt"]) * steps.size
    spell = {**name, "steps": steps.size, "time_s": time, "first_s": record.t[steps[0]]}
    if sized:
        multiplier = values[steps]
        spell |= {"max_multiplier": multiplier.max(), "mean_multiplier": multiplier.mean()}
    return spell
