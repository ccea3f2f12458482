"""The reasons why a run is not a success, in plain words: from its record or its metrics."""

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import percent
from iiwa_dnn.naming import describe, joint_name
from iiwa_dnn.results.markdown import number
from iiwa_dnn.results.metrics import (
    BOUNDS,
    EXCESS_TOLERANCE,
    FAR,
    JOINT_LIMITS,
    PROOF,
    compute_metrics,
    limits,
    start_distance,
)
from iiwa_dnn.results.record import Record

LIMIT_SLACK = 1e-9
"""Excess over a limit [rad, rad/s, m] that is forgiven: rounding of the motion's integration."""

INFEASIBLE = "no joint velocity inside the limits fulfils the task"
"""Beginning of a reason: a program of the continuous mode was shown to have no solution."""

_DONE = {"slow": "slowed", "relax": "relaxed", "stop": "stopped"}

_NOISY = {
    "jerk": (math.sqrt(6.0), 2, "dddq_max", "rad/s^3"),
    "acceleration": (math.sqrt(2.0), 1, "ddq_max", "rad/s^2"),
}
"""Of a limit: factor of gain times noise over a power of the period, the power, setting, unit."""

_show = partial(number, form=".3g", unknown="not a number")


def failures(run: Record | Mapping[str, Any]) -> list[str]:
    """List the reasons why a run is not a success; its exit code is then 1.

    A run fails if it did not complete its path, if a step was not solved, had no solution or broke
    a limit, and, in converged mode, if a reference disagreed, gave no answer to be believed, or was
    not asked.

    Args:
        run: The record, or its metrics. From the record the reasons also name joint and step.

    Returns:
        The reasons, the gravest first; empty if there is none.

    Raises:
        InvalidInputError: `run` is neither.
    """
    record = run if isinstance(run, Record) else None
    if record is None and not (isinstance(run, Mapping) and "settings" in run):
        raise InvalidInputError("run", f"must be a record or its metrics, not {run!r:.80}", run)
    metrics: Mapping[str, Any] = compute_metrics(run) if isinstance(run, Record) else run
    is_finite = metrics["max_position_error_m"] is not None
    return [
        *_path_completed(metrics),
        *_early_end(metrics),
        *_infeasible(metrics["settings"]),
        *_policies(metrics, record),
        *([] if is_finite else ["the tip position is not finite at every step"]),
        *_unsolved(metrics, record),
        *_crosscheck(metrics["crosscheck"], metrics["steps"]),
        *_other_programs(metrics["crosscheck"]),
        *_broken_limits(metrics, record),
        *_too_near(metrics.get("collisions")),
        *_torques(metrics, record),
    ]


def _path_completed(metrics: Mapping[str, Any]) -> list[str]:
    """Report an incomplete path as ``path completed 12.3 %``; a completed one has no line."""
    fraction = metrics.get("path_completed", 1.0)  # older metrics lack it
    return [f"path completed {percent(fraction)}"] if fraction < 1.0 else []


def _early_end(metrics: Mapping[str, Any]) -> list[str]:
    settings = metrics["settings"]
    if settings["status"] == "completed":
        return []
    planned = round(settings["duration"] / settings["dt"])
    return [f"ended after {metrics['steps']:,} of {planned:,} steps: {settings['status']}"]


def _infeasible(settings: Mapping[str, Any]) -> list[str]:
    """Report a step of the continuous mode whose program was shown to have no solution."""
    step = settings.get("infeasible_step")
    if step is None:
        return []
    where = f"step {step} (t = {step * settings['dt']:g} s)"
    return [f"{INFEASIBLE}, as at {where}: the path is too quick, or out of reach"]


def _policies(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    """Name the steps without the network's answer; clipping and active bounds are no failures."""
    incidents = metrics.get("incidents")
    if incidents is None or incidents["first"] is None:
        return []
    if metrics["settings"]["mode"] == "continuous":  # it has no policies, and its status says why
        return []
    first = incidents["first"]
    at = f", the first at step {first['step']} (t = {first['time_s']:.6g} s)"
    reasons = []
    done = {word: incidents[f"{name}_steps"] for name, word in _DONE.items()}
    if any(done.values()):
        counts = ", ".join(f"{steps:,} {word}" for word, steps in done.items() if steps)
        steps = _count(sum(done.values()))
        against = ", ".join(map(describe, first.get("against", ())))  # older metrics lack it
        at += f", against {against}" if against else ""
        often = "most often " if sum(done.values()) > 1 else ""
        reasons.append(
            f"{steps} without a solution ({counts}){at}; "
            f"{often}in the way: {_blocking(metrics)}{_far_start(record)}"
        )
    return [*reasons, *_slowed(metrics), *_noise(metrics)]


def _slowed(metrics: Mapping[str, Any]) -> list[str]:
    """State how far a slowed path came, and what would have sufficed."""
    incidents = metrics["incidents"]
    if not incidents["slow_steps"]:
        return []
    path_time = number(incidents["path_time_s"])
    took = number(metrics["duration_s"])
    needed = _needed(metrics)
    off = _off_path(incidents)
    remedy = _remedy(incidents)
    return [f"slowed: path time {path_time} s after {took} s{needed}{off}{remedy}"]


def _needed(metrics: Mapping[str, Any]) -> str:
    """State what would have sufficed, 2 % and more above it; nothing if that is not known."""
    needed = metrics["incidents"].get("needed")  # older metrics lack it
    if needed is None:
        return ""
    part = "" if metrics.get("path_completed", 1.0) == 1.0 else "what was drawn "
    ratio = np.ceil(10.0 * 1.02 * needed["speed_ratio"]) / 10.0
    time = np.ceil(10.0 * needed["time_s"]) / 10.0
    return (
        f"; {part}needs {ratio:g} times the joints' speed, "
        f"most of all {needed['name']}'s, or {ratio:g} times as long a time "
        f"({_slower(metrics['settings'].get('reference'), ratio)}); "
        f"slowed as here it ends after about {time:g} s (--duration {time:g})"
    )


def _slower(reference: object, ratio: float) -> str:
    """Return the option that makes a path take so many times as long."""
    if isinstance(reference, Mapping) and "period" in reference:
        period = ratio * reference["period"]
        return f"--period {period:g} --duration {period:g}"
    return f"--stretch {ratio:g} times as large"


def _off_path(incidents: Mapping[str, Any]) -> str:
    """Name the row that was longest in the way, and how far it kept the tip from the path."""
    off = incidents.get("off_path_m")  # older metrics lack it
    if off is None:
        return ""
    row = max(incidents["blocking_rows"], key=lambda row: row["steps"])
    never = ", which no longer time mends" if off > FAR else ""
    return f"; {describe(row)} kept the tip up to {_show(off)} m off the path{never}"


def _remedy(incidents: Mapping[str, Any]) -> str:
    """State what helps if a row of collision avoidance was in the way of most slowed steps."""
    rows = incidents.get("blocking_rows", ())  # older metrics lack it
    steps = [row["steps"] for row in rows if row.get("part") == "CollisionAvoidance"]
    if 2 * max(steps, default=0) <= incidents["slow_steps"]:
        return ""
    return (
        "; move the obstacle or the path, keep less distance, "
        "or take the policy relax, which is in time and leaves the path"
    )


def _noise(metrics: Mapping[str, Any]) -> list[str]:
    """State how much jerk or acceleration the feedback of measurement noise asks for.

    Nothing if that is at most a tenth of the limit, or another kind of limit was more often in the
    way. The standard deviations are those of docs/noise.md.
    """
    settings = metrics["settings"]
    gain = _gain(settings)
    blocks = metrics["incidents"]["blocking"]
    unfiltered = settings.get("noise_at") == "measurement" and settings.get("estimator") is None
    if not (unfiltered and gain and blocks):
        return []
    kind = max(blocks, key=lambda limit: limit["steps"])["limit"]
    if kind not in _NOISY:
        return []
    factor, order, setting, unit = _NOISY[kind]
    asked = factor * gain * settings["noise"] / settings["dt"] ** order
    limits_set = [limit for limit in settings.get(setting, ()) if limit is not None]
    least = min(limits_set, default=math.inf)
    if asked <= 0.1 * least:
        return []
    return [
        f"the measurement noise of {settings['noise']:g} rad asks for a {kind} of {_show(asked)} "
        f"{unit} (standard deviation), the limit is {least:g}: lower the gain, take a longer "
        "period, or filter the measurement (docs/noise.md)"
    ]


def _gain(settings: Mapping[str, Any]) -> float:
    """Return the largest feedback gain of a run's tasks [1/s], 0 if its scheme does not say it."""
    scheme = settings.get("scheme")
    if not isinstance(scheme, Mapping):
        return 0.0
    rate = 1.0 / float(settings["dt"])
    gains = [0.0]
    for task in scheme.get("tasks", [scheme]):
        gain = task.get("gain", task.get("position_gain", 0.0))
        if task.get("tracking") == "next":
            gain = task.get("next_gain") or rate
        gains.append(min(float(gain), rate))
    return max(gains)


def _blocking(metrics: Mapping[str, Any]) -> str:
    """Name the three limits that were longest in the way of a solution."""
    incidents = metrics["incidents"]
    blocks = [*incidents.get("blocking_rows", ()), *incidents["blocking"]]
    blocks.sort(key=lambda limit: -limit["steps"])
    if blocks:
        return ", ".join(map(describe, blocks[:3]))
    own = " or ".join(metrics["settings"].get("own_tasks", ()))
    return "no bound, a singular pose" + (f" or {own} against other tasks" if own else "")


def _far_start(record: Record | None) -> str:
    """State a distance between tip and path at the start that is worth a word."""
    distance = 0.0 if record is None else start_distance(record)
    return f"; the path begins {_show(distance)} m from the tip" if distance > FAR else ""


def _unsolved(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    worst = metrics["max_kkt_residual"]
    tolerance = metrics["settings"]["tol"]
    if metrics["settings"]["mode"] != "converged" or not metrics["steps"]:
        return []
    if worst is not None and worst <= tolerance:
        return []
    if record is None:
        return [f"largest KKT residual {_show(worst)}, tolerance {_show(tolerance)}"]
    steps = np.flatnonzero(~(record.kkt_residual <= tolerance))
    residual = _show(record.kkt_residual[steps[0]])
    return [
        f"{_at(record, steps[0])}: KKT residual {residual}, tolerance {_show(tolerance)}; "
        f"{_count(len(steps))} unsolved in all"
    ]


def _crosscheck(check: Mapping[str, Any], steps: int) -> list[str]:
    reasons = []
    first = check["first_disagreement"]
    if first is not None:
        said = f"{first['solver']} differs by {_show(first['gap'])} rad/s"
        disagree = " disagrees" if check["disagreements"] == 1 else " disagree"
        if first["solver"] == PROOF:
            said = f"proven within {_show(first['gap'])} rad/s of the exact solution alone"
            disagree = ""
        tolerance = check["tolerance"]
        if first["solver"] == BOUNDS:
            said = f"the command is {_show(first['gap'])} outside of its bounds and rows"
            tolerance = EXCESS_TOLERANCE
        reasons.append(
            f"step {first['step']} (t = {first['time_s']:.6g} s): {said}, tolerance "
            f"{_show(tolerance)}; {_count(check['disagreements'])}{disagree} in all"
        )
    if not check["judged"]:  # in continuous mode the gap is a lag
        return reasons
    if check["reference_failures"] and check["solver"] == PROOF:
        reasons.append(f"{_count(check['reference_failures'])} not proven")
    elif check["reference_failures"]:
        missing = check["reference_failures"]
        answers = "answer" if missing == 1 else "answers"
        reasons.append(
            f"{missing:,} reference {answers} missing or not accurate enough to judge by "
            f"({check['solver']}); the check 'proof' needs no other solver"
        )
    missing = steps - check["steps_checked"] - check["kinds"]["stopped"]
    if missing:
        reasons.append(f"{_count(missing)} of {steps:,} not checked")
    return reasons


def programs_checked(check: Mapping[str, Any], separator: str = ", ") -> str:
    """State which programs were checked, ``736 own, 9,264 softened programs checked``."""
    kinds = check["kinds"]
    answered = [f"{kinds[kind]:,} {kind}" for kind in ("own", "scaled", "softened") if kinds[kind]]
    parts = [f"{', '.join(answered) or 'no'} programs checked"]
    if kinds["held"]:
        parts.append(f"{kinds['held']:,} held back, checked for their bounds alone")
    if kinds["stopped"]:
        parts.append(f"{kinds['stopped']:,} stopped, with nothing to check")
    return separator.join(parts)


def _other_programs(check: Mapping[str, Any]) -> list[str]:
    """State what was checked where it is not each step's own program."""
    others = [kind for kind, steps in check["kinds"].items() if steps and kind != "own"]
    return [programs_checked(check)] if others and check["judged"] else []


def _broken_limits(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    reasons = []
    for limit in JOINT_LIMITS:
        worst = metrics.get(limit.metric, 0.0)  # few schemes have all of them
        if worst is None:
            reasons.append(f"a joint {limit.kind} is not finite")
        elif worst > LIMIT_SLACK:
            where = ""
            if record is not None:
                excess = limit.excess(record)
                step, joint = np.unravel_index(int(excess.argmax()), excess.shape)
                where = f"; {joint_name(metrics['settings'], int(joint))} at {_at(record, step)}"
            reasons.append(f"joint {limit.kind} limit broken by {_show(worst)} {limit.unit}{where}")
    return reasons


def _too_near(collisions: Mapping[str, Any] | None) -> list[str]:
    if collisions is None or collisions["missing_m"] <= LIMIT_SLACK:
        return []
    text = "{second} and {first} came as near as {least_distance_m:.6g} m at t = {time_s:.6g} s"
    start = "; begin farther away: another start posture" if collisions["time_s"] == 0.0 else ""
    return [f"{text}, allowed {{allowed_m:.6g}} m{start}".format_map(collisions)]


def _torques(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    physics = metrics.get("physics")
    if physics is None or physics["max_torque_share"] < 1.0:
        return []
    if record is None or record.torque is None:
        return [f"a joint torque reached {physics['max_torque_share']:.0%} of its limit"]
    reasons = []
    limit = limits(record, "torque_max")
    reached = ~(np.abs(record.torque) < limit)
    for joint in np.flatnonzero(reached.any(axis=0)):
        steps = np.flatnonzero(reached[:, joint])
        reasons.append(
            f"{joint_name(metrics['settings'], joint)}: torque reached its limit of "
            f"{limit[joint]:g} N m at "
            f"{_at(record, steps[0])}; {steps.size:,} in all"
        )
    return reasons


def _at(record: Record, step: np.integer[Any] | int) -> str:
    return f"step {int(step)} (t = {record.t[step]:.6g} s)"


def _count(steps: int) -> str:
    return f"{steps:,} step" if steps == 1 else f"{steps:,} steps"
