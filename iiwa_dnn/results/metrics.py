"""The numbers that sum up a run, and the reasons why it failed: pure functions of its record."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.files import plain
from iiwa_dnn.results.incidents import incident_failures, incident_metrics
from iiwa_dnn.results.record import FloatArray, Record
from iiwa_dnn.results.torques import physics_failures, physics_metrics

# Rounding of the integrator may carry a joint this far past a limit that the QP kept exactly.
LIMIT_SLACK = 1e-9

BoolArray = NDArray[np.bool_]


def position_error(record: Record) -> FloatArray:
    """Tip position minus desired tip position [m], (N+1, 3)."""
    return record.position - record.position_desired


def orientation_error(record: Record) -> FloatArray:
    """Angle between the tip's orientation and the desired one [rad], (N+1,), in [0, π].

    With R_e = R_desiredᵀ R the angle is atan2(‖vee((R_e − R_eᵀ)/2)‖, (tr R_e − 1)/2). The usual
    arccos of the second argument alone cannot tell angles below 1e-8 rad from zero.
    """
    relative = np.swapaxes(record.rotation_desired, 1, 2) @ record.rotation
    skew = 0.5 * (relative - np.swapaxes(relative, 1, 2))
    sine = np.linalg.norm(skew[:, [2, 0, 1], [1, 2, 0]], axis=1)
    cosine = 0.5 * (np.trace(relative, axis1=1, axis2=2) - 1.0)
    angle: FloatArray = np.arctan2(sine, cosine)
    return angle


def position_limit_excess(record: Record) -> FloatArray:
    """How far each joint is outside its position limits [rad], (N+1, n); 0 inside."""
    lower = _limits(record, "q_lower", -np.inf)
    upper = _limits(record, "q_upper", np.inf)
    # np.maximum, unlike max(), lets a NaN through.
    excess: FloatArray = np.maximum(np.maximum(lower - record.q, record.q - upper), 0.0)
    return excess


def velocity_limit_excess(record: Record) -> FloatArray:
    """How far each joint's speed is above its limit [rad/s], (N, n); 0 below."""
    excess: FloatArray = np.maximum(np.abs(record.dq) - _limits(record, "dq_max", np.inf), 0.0)
    return excess


@np.errstate(over="ignore", invalid="ignore")  # an overflow reads None
def compute_metrics(record: Record) -> dict[str, Any]:
    """Sum up a run in plain JSON types, as metrics.json holds them.

    The mean squared error ``mse_position_error_m2`` is the mean over the N+1 samples *and* the
    three axes, which is what the paper's MSE most likely is: a third of the mean squared distance.
    ``duration_s`` is the time simulated; what was asked for is ``settings["duration"]``. A run in
    physics also has ``physics`` (`iiwa_dnn.results.torques.physics_metrics`), one in which a bound
    or a policy acted ``incidents`` (`iiwa_dnn.results.incidents.incident_metrics`).

    Args:
        record: The run.

    Returns:
        The metrics, units in their names. A number that does not exist is None: an overflow, an
        unknown wall time, a maximum over no steps.
    """
    error = position_error(record)
    duration = float(record.t[-1] - record.t[0])
    wall = record.wall_time_s
    settings = {key: value for key, value in record.settings.items() if key != "versions"}
    metrics: dict[str, Any] = plain(
        {
            "max_position_error_m": np.linalg.norm(error, axis=1).max(),
            "mse_position_error_m2": np.mean(error**2),
            "max_orientation_error_rad": orientation_error(record).max(),
            "joint_drift_rad": np.abs(record.q[-1] - record.q[0]).max(),
            "max_kinetic_index": _max(record.kinetic_index),
            "steps": record.steps,
            "dt_s": record.settings["dt"],
            "duration_s": duration,
            "wall_time_s": wall,
            "realtime_factor": duration / wall if wall else None,
            "position_limit_violation_rad": position_limit_excess(record).max(),
            "velocity_limit_violation_rad_s": velocity_limit_excess(record).max(initial=0.0),
            "max_kkt_residual": _max(record.kkt_residual),
            "crosscheck": _crosscheck(record),
            **physics_metrics(record),
            **incident_metrics(record),
            "settings": settings,
            "versions": record.settings.get("versions", {}),
        }
    )
    return metrics


def failures(run: Record | Mapping[str, Any]) -> list[str]:
    """Say in plain words why a run is not a success; its exit code is then 1.

    A run fails if it ended early, if a step was not solved, had no solution or broke a limit, and,
    in converged mode, if a reference disagreed, gave no answer to be believed, or was not asked.

    Args:
        run: The record, or its metrics. From the record the reasons also say which joint and when.

    Returns:
        The reasons, the gravest first; empty if there is none.
    """
    record = run if isinstance(run, Record) else None
    metrics: Mapping[str, Any] = compute_metrics(run) if isinstance(run, Record) else run
    return [
        *_early_end(metrics),
        *incident_failures(metrics),
        *_unsolved(metrics, record),
        *_crosscheck_failures(metrics["crosscheck"], metrics["steps"]),
        *_broken_limits(metrics, record),
        *physics_failures(metrics, record),
    ]


def _limits(record: Record, key: str, unlimited: float) -> FloatArray:
    """A limit of each joint, (n,); settings hold None where there is no limit."""
    values = record.settings[key]
    return np.array([unlimited if value is None else value for value in values], dtype=float)


def _max(values: FloatArray) -> float | None:
    """Largest value (NaN if there is one), None if there are no values."""
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
        "first_disagreement": _first(record, disagrees),
    }


def _first(record: Record, disagrees: BoolArray) -> dict[str, Any] | None:
    """The first step that disagrees, and there the solver that differs most."""
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


def _early_end(metrics: Mapping[str, Any]) -> list[str]:
    settings = metrics["settings"]
    if settings["status"] == "completed":
        return []
    planned = round(settings["duration"] / settings["dt"])
    return [f"ended after {metrics['steps']:,} of {planned:,} steps: {settings['status']}"]


def _unsolved(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    reasons = []
    if metrics["max_position_error_m"] is None:
        reasons.append("the tip position is not finite at every step")
    worst, tolerance = metrics["max_kkt_residual"], metrics["settings"]["tol"]
    if metrics["settings"]["mode"] != "converged" or not metrics["steps"]:
        return reasons
    if worst is not None and worst <= tolerance:
        return reasons
    if record is None:
        return [*reasons, f"largest KKT residual {_show(worst)}, tolerance {_show(tolerance)}"]
    steps = np.flatnonzero(~(record.kkt_residual <= tolerance))
    reasons.append(
        f"{_at(record, steps[0])}: KKT residual {_show(record.kkt_residual[steps[0]])}, "
        f"tolerance {_show(tolerance)}; {_count(len(steps))} unsolved in all"
    )
    return reasons


def _crosscheck_failures(check: Mapping[str, Any], steps: int) -> list[str]:
    reasons = []
    first = check["first_disagreement"]
    if first is not None:
        disagree = "disagrees" if check["disagreements"] == 1 else "disagree"
        reasons.append(
            f"step {first['step']} (t = {first['time_s']:.6g} s): {first['solver']} differs by "
            f"{_show(first['gap'])} rad/s, tolerance {_show(check['tolerance'])}; "
            f"{_count(check['disagreements'])} {disagree} in all"
        )
    # What is not judged cannot fail: in continuous mode the gap is a lag.
    if check["judged"] and check["reference_failures"]:
        reasons.append(
            f"{check['reference_failures']:,} reference answers missing or not accurate enough "
            f"to judge by ({check['solver']})"
        )
    if check["judged"] and check["steps_checked"] < steps:
        reasons.append(f"only {check['steps_checked']:,} of {_count(steps)} were checked")
    return reasons


def _broken_limits(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    reasons = []
    for kind, key, unit in (
        ("position", "position_limit_violation_rad", "rad"),
        ("velocity", "velocity_limit_violation_rad_s", "rad/s"),
    ):
        worst = metrics[key]
        if worst is None:
            reasons.append(f"a joint {kind} is not finite")
        elif worst > LIMIT_SLACK:
            where = f"; {_worst_joint(record, kind)}" if record is not None else ""
            reasons.append(f"joint {kind} limit broken by {_show(worst)} {unit}{where}")
    return reasons


def _worst_joint(record: Record, kind: str) -> str:
    excess = position_limit_excess(record) if kind == "position" else velocity_limit_excess(record)
    step, joint = np.unravel_index(int(excess.argmax()), excess.shape)
    return f"joint {joint + 1} at {_at(record, step)}"


def _at(record: Record, step: np.integer[Any] | int) -> str:
    return f"step {int(step)} (t = {record.t[step]:.6g} s)"


def _count(steps: int) -> str:
    return f"{steps:,} step" if steps == 1 else f"{steps:,} steps"


def _show(value: float | None) -> str:
    return "not a number" if value is None else f"{value:.3g}"
