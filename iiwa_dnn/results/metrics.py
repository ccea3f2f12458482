"""Metrics of a run: pure functions of its record."""

from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Array, instance
from iiwa_dnn.files import plain
from iiwa_dnn.naming import ACTIONS, active_limits
from iiwa_dnn.results.record import OWN_LIMITS, RATES, Record

PROGRAMS = ("nominal", "scaled", "relaxed", "rate_limited", "stopped")
"""Kinds of a step by their codes in `Record.kind`."""

*_, _RATE_LIMITED, _STOPPED = range(len(PROGRAMS))

EXCESS_TOLERANCE = 1e-9
"""Excess of a command over the bounds and rows of its own step that is rounding."""

STOP = {name: code for code, name in ACTIONS.items()}["stop"]
"""Code of the action of a policy that stops the arm."""

BOUNDS = "bounds"
"""Name of the check of a command by its step's own bounds and rows."""

SETTLED_AFTER = 0.5
"""Time until an arm in physics has settled [s]; it starts at rest, its weight unknown."""

JOINT_LIMITS = {
    "position_limit_violation_rad": ("position", "rad"),
    "velocity_limit_violation_rad_s": ("velocity", "rad/s"),
    "acceleration_limit_violation_rad_s2": ("acceleration", "rad/s²"),
    "jerk_limit_violation_rad_s3": ("jerk", "rad/s³"),
}
"""Metrics of the excess over the joints' limits: the limited quantity, and the unit."""

GAPS = {
    "solution_gap": "the gap to {solver} is {gap} rad/s",
    "objective_gap": "the objective differs from that of {solver} by {gap} of its terms",
    "feasibility_gap": "a bound or row is violated by {gap} of its terms",
}
"""Gaps of a cross-check, each at most the tolerance, and the words for one that is not."""

_AT_LIMIT = 1.0 - 1e-9


def position_error(record: Record) -> Array:
    """Compute the tip position minus the desired tip position [m], (N+1, 3)."""
    return record.position - record.position_desired


def orientation_error(record: Record) -> Array:
    """Compute the angle between the tip's orientation and the desired one [rad], (N+1,)."""
    return rotation_angle(record.rotation, record.rotation_desired)


def frame_errors(record: Record) -> tuple[Array, Array]:
    """Compute distances [m] and angles [rad] of the f further frames to their targets, (N+1, f)."""
    offset = record.frame_position - record.frame_position_desired
    angle = rotation_angle(record.frame_rotation, record.frame_rotation_desired)
    return np.linalg.norm(offset, axis=2), angle


def rotation_angle(rotation: Array, desired: Array) -> Array:
    """Compute the angle between two orientations (..., 3, 3) [rad], (...), in [0, π].

    With R_e = R_desiredᵀ R the angle is atan2(‖vee((R_e − R_eᵀ)/2)‖, (tr R_e − 1)/2). The usual
    arccos of the second argument alone is the same for all angles below 1e-8 rad.
    """
    relative = np.swapaxes(desired, -1, -2) @ rotation
    skew = 0.5 * (relative - np.swapaxes(relative, -1, -2))
    sine = np.linalg.norm(skew[..., [2, 0, 1], [1, 2, 0]], axis=-1)
    cosine = 0.5 * (np.trace(relative, axis1=-1, axis2=-2) - 1.0)
    angle: Array = np.arctan2(sine, cosine)
    return angle


def limits(record: Record, key: str, unlimited: float = np.inf) -> Array:
    """Return the limits of the joints under a key of the settings, (n,).

    `unlimited` stands for a joint without a limit, which is None in the settings.
    """
    values = record.settings.get(key) or [None] * record.dof
    return np.array([unlimited if value is None else value for value in values], dtype=float)


@np.errstate(invalid="ignore")  # of commands that are not finite
def joint_rates(record: Record, quantity: str) -> tuple[Array, float]:
    """Compute the joints' accelerations [rad/s^2] or jerks [rad/s^3], and their error by rounding.

    Args:
        record: The run.
        quantity: One of `RATES`.

    Returns:
        Finite differences of the commands, from rest, (N, n), and a bound on their error by
        rounding.
    """
    order = 1 + list(RATES).index(quantity)
    dt = record.settings["dt"]
    commands = record.sent if len(record.sent) else record.dq
    from_rest = np.vstack([np.zeros((order, record.dof)), commands])
    rounding = 8.0 * np.finfo(float).eps * np.abs(commands).max(initial=1.0) * (2.0 / dt) ** order
    return np.diff(from_rest, order, axis=0) / dt**order, rounding


@np.errstate(invalid="ignore")
def _rate_excess(record: Record, quantity: str, limit: Array) -> Array:
    """Compute the excess of the joints' accelerations or jerks over a limit (n,), (N, n)."""
    rates, rounding = joint_rates(record, quantity)
    return np.abs(rates) - (limit + rounding)


def _excesses(record: Record) -> dict[str, Array]:
    """Compute how far each joint is beyond each limit of the run, by the names of the metrics.

    Positions have a row for each sample, (N+1, n), rates one for each step, (N, n).
    """
    below = limits(record, "q_lower", -np.inf) - record.q
    above = record.q - limits(record, "q_upper")
    found = {
        "position_limit_violation_rad": np.maximum(
            below, above
        ),  # unlike max(), lets a NaN through
        "velocity_limit_violation_rad_s": np.abs(record.dq) - limits(record, "dq_max"),
    }
    for name, (quantity, _) in list(JOINT_LIMITS.items())[2:]:
        limit = limits(record, RATES[quantity])
        if np.isfinite(limit).any():
            found[name] = _rate_excess(record, quantity, limit)
    return found


@np.errstate(invalid="ignore")
def beyond_robot(record: Record) -> dict[str, dict[str, Any]]:
    """Find the largest excess over each of the robot's own limits that the run did not keep.

    The keys are quantities of `OWN_LIMITS` whose limit in the run was wider than the robot's and
    that exceeded the robot's. ``limited`` is the run's limit, None without one; ``named`` is False
    if neither the scheme nor the user mentions a limit of that kind.
    """
    found = {}
    for quantity, setting in OWN_LIMITS.items():
        sign = -1.0 if setting == "q_lower" else 1.0
        own = sign * limits(record, f"robot_{setting}", sign * np.inf)
        kept = sign * limits(record, setting, sign * np.inf)
        limit = np.where(own < kept, own, np.inf)
        if quantity in RATES:
            excess = _rate_excess(record, quantity, limit)
        else:
            reached = np.abs(record.dq) if quantity == "velocity" else sign * record.q
            excess = reached - limit
        if worst := _worst(record, excess):
            joint = record.settings["joints"].index(worst["joint"])
            found[quantity] = worst | {
                "largest": sign * (own[joint] + excess[worst["step"], joint]),
                "limit": sign * own[joint],
                "limited": sign * kept[joint],
                "named": setting in record.settings,
            }
    return found


def compute_metrics(record: Record) -> dict[str, Any]:
    """Sum up a run in plain JSON types, as metrics.json holds them.

    ``path_completed`` is the fraction of the path's time that the reference's clock covered. Below
    1 the errors say little: they are measured against the slowed target. The path's time is that of
    the path once, or the run's if it is shorter. The mean squared error
    ``mse_position_error_m2`` is the mean over the N+1 samples *and* the three axes, which is most
    likely the paper's MSE: a third of the mean squared distance. ``duration_s`` is the time
    simulated; ``settings["duration"]`` was asked for. ``violations`` says of each broken limit
    where its excess is largest, ``beyond_robot`` how far joints went that nothing kept within the
    robot's own limits, ``unsolved`` of the answers above the tolerance which is the first,
    ``incidents`` which bounds, inequality rows and policies acted, and for how many steps. A run in
    physics also has ``physics`` (torques, settled error), one with `TorqueLimits` ``demand`` (what
    the commands take of them), one that tracks several frames ``frames`` (largest errors of those
    beside the first), one that avoids collisions ``collisions`` (the nearest pair, and by how much
    it came nearer than it may).

    Args:
        record: The run.

    Returns:
        The metrics, units in their names. A number that does not exist is None: an overflow, an
        unknown wall time, a maximum over no steps.
    """
    instance("record", record, Record)
    settings = record.settings
    error = position_error(record)
    distance = np.linalg.norm(error, axis=1)
    duration = float(record.t[-1] - record.t[0])
    excesses = _excesses(record)
    metrics: dict[str, Any] = plain(
        {
            "path_completed": record.path_completed,
            "start_distance_m": distance[0],
            "beyond_reach_m": settings.get("beyond_reach", 0.0),
            "max_position_error_m": distance.max(),
            "mse_position_error_m2": np.mean(error**2),
            "max_orientation_error_rad": orientation_error(record).max(),
            "joint_drift_rad": np.abs(record.q[-1] - record.q[0]).max(),
            "max_kinetic_index": _max(record.kinetic_index),
            "steps": record.steps,
            "dt_s": settings["dt"],
            "duration_s": duration,
            "wall_time_s": record.wall_time_s,
            "realtime_factor": duration / record.wall_time_s if record.wall_time_s else None,
            "max_kkt_residual": _max(record.kkt_residual),
            "active_limit_steps": _active(record).any(axis=1).sum(),
            **{name: excess.max(initial=0.0) for name, excess in excesses.items()},
            "violations": {name: _worst(record, excess) for name, excess in excesses.items()},
            "beyond_robot": beyond_robot(record),
            "unsolved": _unsolved(record),
            "network_iterations": {
                "mean": record.iterations.mean() if record.steps else None,
                "max": _max(record.iterations),
            },
            "crosscheck": _crosscheck(record),
            "incidents": _incidents(record),
            **{
                name: sum_up(record)
                for name, (column, sum_up) in FURTHER.items()
                if len(getattr(record, column))
            },
            "settings": {key: value for key, value in settings.items() if key != "versions"},
            "versions": settings.get("versions", {}),
        }
    )
    return metrics


def _max(values: NDArray[Any]) -> Any:
    """Return the largest value (NaN if there is one), None of no values."""
    return values.max() if values.size else None


def _first(record: Record, acts: Any) -> dict[str, Any] | None:
    """Return number and first of the steps at which `acts` (N,) is true; None if at none."""
    steps = np.flatnonzero(acts)
    if not steps.size:
        return None
    return {"steps": steps.size, "step": steps[0], "time_s": record.t[steps[0]]}


def _unsolved(record: Record) -> dict[str, Any] | None:
    """Count the steps with a KKT residual above the tolerance, and give the first, or None."""
    first = _first(record, ~(record.kkt_residual <= record.settings["tol"]))
    return first and first | {"residual": record.kkt_residual[first["step"]]}


def _worst(record: Record, excess: Array) -> dict[str, Any] | None:
    """Return joint and step of the largest excess of an array (k, n); None if none is above 0."""
    if not excess.max(initial=0.0) > 0.0:
        return None
    step, joint = np.unravel_index(int(excess.argmax()), excess.shape)
    return {"joint": record.settings["joints"][joint], "step": step, "time_s": record.t[step]}


def _active(record: Record) -> Array:
    """Return the multipliers of the n bounds and the m inequality rows, (N, n + m)."""
    return np.hstack([record.filled(name) for name in ("bound_multiplier", "row_multiplier")])


def _crosscheck(record: Record) -> dict[str, Any]:
    """Count and size the differences to the reference solvers.

    A reference's answer is believed only if its own residual is within its tolerance; the others
    are counted as `reference_failures` and enter no maximum. The network's answer disagrees if one
    of `GAPS` is above the tolerance. A command outside of the bounds and rows of its own step
    disagrees whatever the references say; of a stopped step there is nothing to check.
    """
    check = record.settings["check"]
    kind = record.filled("kind")
    gap = record.solution_gap
    residual = record.reference_residual
    converged = record.settings["mode"] == "converged"
    # A residual without a gap is an answer too: the network's own was then not a number.
    asked = ~(np.isnan(gap) & np.isnan(residual)) & (kind != _STOPPED)[:, np.newaxis]
    believed = asked & (residual <= check["reference_tolerance"]) & ~np.isinf(gap)
    excess = record.filled("excess")
    gaps = np.hstack([*(getattr(record, name) for name in GAPS), excess[:, np.newaxis]])
    # Not `gap > tolerance`, which a NaN would pass.
    outside = ~(excess <= EXCESS_TOLERANCE) & (kind != _STOPPED)
    beyond = np.tile(believed, len(GAPS)) & ~(gaps[:, :-1] <= check["tolerance"])
    disagrees = np.column_stack([beyond, outside]) & converged
    checked = asked.all(axis=1) & bool(check["solvers"])
    first = _first(record, disagrees.any(axis=1))
    if first is not None:
        step = first["step"]
        worst = int(np.where(disagrees[step], gaps[step], -np.inf).argmax())
        judges = _judges(check)[record.filled("judge")[step], range(len(check["solvers"]))]
        named = [
            judge if judge == solver else f"{judge} (for {solver})"
            for judge, solver in zip(judges, check["solvers"], strict=True)
        ]
        pairs = [(name, solver) for name in GAPS for solver in named]
        quantity, solver = [*pairs, ("solution_gap", BOUNDS)][worst]
        first |= {
            "quantity": quantity,
            "solver": solver,
            "gap": gaps[step, worst],
            "tolerance": EXCESS_TOLERANCE if solver == BOUNDS else check["tolerance"],
        }
    return {
        "solver": "+".join(check["solvers"]) or "none",
        "steps_checked": checked.sum(),
        "kinds": {
            name: ((kind == code) & (checked | (code >= _RATE_LIMITED))).sum()
            for code, name in enumerate(PROGRAMS)
        },
        "judged_by": _judged_by(record, asked),
        "disagreements": disagrees.any(axis=1).sum(),
        "reference_failures": (asked & ~believed).sum(),
        **{f"max_{name}": _max(getattr(record, name)[believed]) for name in GAPS},
        "max_reference_residual": _max(residual[np.isfinite(residual)]),
        "judged": converged and bool(check["solvers"]),
        "tolerance": check["tolerance"],
        "first_disagreement": first,
    }


def _judged_by(record: Record, asked: NDArray[np.bool_]) -> dict[str, int]:
    """Count the solutions that each judge judged, by its name; see `Record.judge`."""
    judge = np.where(asked, record.filled("judge"), -1)
    counts: Counter[str] = Counter()
    for code, names in enumerate(_judges(record.settings["check"])):
        counts += Counter(dict(zip(names, (judge == code).sum(axis=0).tolist(), strict=True)))
    return dict(counts)  # a sum has no counts of zero


def _judges(check: Mapping[str, Any]) -> NDArray[np.object_]:
    """Return the names of the judges by their codes in `Record.judge`, (3, k)."""
    proofs = ["proof"] * len(check["solvers"])
    return np.array([check["solvers"], check["second"], proofs], dtype=object)


def _physics(record: Record) -> dict[str, Any]:
    """Summarize the torques, and the position error after `SETTLED_AFTER`."""
    distance = np.linalg.norm(position_error(record), axis=1)
    torque = np.abs(record.torque)
    limit = limits(record, "torque_max")
    reached = ~(torque < limit)
    names = np.array(record.settings["joints"])[reached.any(axis=0)]
    first = _first(record, reached.any(axis=1))
    return {
        "settled_after_s": SETTLED_AFTER,
        "max_position_error_settled_m": _max(distance[record.t >= record.t[0] + SETTLED_AFTER]),
        "max_torque_n_m": torque.max(axis=0),
        "max_torque_fraction": (torque.max(axis=0) / limit).max(),
        "torque_limit_reached": first and first | {"joints": names},
    }


def _demand(record: Record) -> dict[str, Any]:
    """Tell how much of the limits of torques the commands take, and where most."""
    part = record.demand / limits(record, "demand_max")
    step, joint = np.unravel_index(part.argmax(), part.shape)
    return {
        "max_fraction": part[step, joint],
        "joint": record.settings["joints"][joint],
        "step": step,
        "time_s": record.t[step],
    }


def _frames(record: Record) -> dict[str, Any]:
    """Return the largest errors of each tracked frame but the first, by its name."""
    largest = [errors.max(axis=0) for errors in frame_errors(record)]
    return {
        name: {"max_position_error_m": distance, "max_orientation_error_rad": angle}
        for name, distance, angle in zip(record.settings["frames"], *largest, strict=True)
    }


def _collisions(record: Record) -> dict[str, Any]:
    """Describe the nearest pair of bodies in a run; ``missing_m`` is how much too near it was.

    ``at_stop`` names the pair that was nearest when a policy first stopped the arm.
    """
    least = int(record.distance.argmin())
    stated = record.settings["collisions"]
    first, second = stated["pairs"][record.nearest[least]]
    stops = np.flatnonzero(record.filled("action") == STOP)
    pair = stated["pairs"][record.nearest[stops[0]]] if stops.size else ()
    return {
        "least_distance_m": record.distance[least],
        "first": first,
        "second": second,
        "time_s": record.t[least],
        "allowed_m": stated["distance"],
        "missing_m": max(0.0, stated["distance"] - float(record.distance[least])),
        "at_stop": " and ".join(reversed(pair)) or None,
    }


def _incidents(record: Record) -> dict[str, Any]:
    """Count steps with clipped commands, with each action of a policy, and with each limit.

    ``active`` are limits that bound a solution, ``limiting`` those that left none.
    """
    multipliers = _active(record)
    action = record.filled("action")
    clipped = record.filled("clipped").any(axis=1)
    kinds = np.abs(record.bound_kind)
    if not len(kinds):
        # A bound is the velocity limit itself, or the tighter one near a position limit.
        kinds = 1 + (np.abs(record.dq_solver) >= _AT_LIMIT * limits(record, "dq_max"))
    acting = np.sign(multipliers).astype(int)
    acting[:, : record.dof] *= kinds
    acting[:, record.dof :] *= 1 + record.filled("row_pair")
    limiting = np.hstack([record.filled(name) for name in ("limiting", "limiting_rows")])
    return {
        "clipped_steps": clipped.sum(),
        **{f"{name}_steps": (action == code).sum() for code, name in ACTIONS.items()},
        "unexplained_steps": ((action != 0) & ~limiting.any(axis=1)).sum(),
        "path_time_s": record.path_time,
        "first": _first(record, action != 0),
        "limiting": _limits(record, limiting),
        "active": _limits(record, acting),
    }


def _limits(record: Record, codes: NDArray[Any]) -> list[Mapping[str, Any]]:
    """Count the steps at which each limit acts, most steps first.

    `codes` (N, n + m) are those of `Record.limiting` for bounds, and of `Record.limiting_rows`.
    """
    found = []
    for column, one in zip(codes.T, np.eye(codes.shape[1], dtype=int), strict=True):
        for code in np.unique(column[column != 0]):
            limits = active_limits(
                record.settings, code * one[: record.dof], code * one[record.dof :]
            )
            # A pair may have any row, and more than one.
            acts = column == code
            if "part" in limits[0] and code > 1:
                acts = (codes[:, record.dof :] == code).any(axis=1)
            limit = limits[0] | (_first(record, acts) or {})
            if limit not in found:
                found.append(limit)
    return sorted(found, key=lambda limit: (-limit["steps"], "joint" in limit))


FURTHER: dict[str, tuple[str, Callable[[Record], dict[str, Any]]]] = {
    "physics": ("torque", _physics),
    "demand": ("demand", _demand),
    "frames": ("frame_position", _frames),
    "collisions": ("distance", _collisions),
}
"""Metrics of runs with certain columns only: the column, and the function that computes them."""
