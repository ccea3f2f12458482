"""The reasons why a run is not a success, in plain words, from its metrics."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import percent
from iiwa_dnn.naming import describe
from iiwa_dnn.results.metrics import (
    BOUNDS,
    EXCESS_TOLERANCE,
    FAR,
    JOINT_LIMITS,
    PROOF,
    compute_metrics,
)
from iiwa_dnn.results.record import Record

LIMIT_SLACK = 1e-9
"""Excess over a limit [rad, rad/s, m] that is forgiven: rounding of the motion's integration."""

INFEASIBLE = "no joint velocity inside the limits fulfils the task"
"""Beginning of a reason: a program of the continuous mode was shown to have no solution."""

_DONE = {"slow": "slowed", "relax": "relaxed", "stop": "stopped"}


def failures(run: Record | Mapping[str, Any]) -> list[str]:
    """List the reasons why a run is not a success; its exit code is then 1.

    A run fails if it did not complete its path, if a step was not solved, had no solution or broke
    a limit, and, in converged mode, if a reference disagreed, gave no answer to be believed, or was
    not asked.

    Args:
        run: The record, or its metrics.

    Returns:
        The reasons, the gravest first; empty if there is none.

    Raises:
        InvalidInputError: `run` is neither.
    """
    if isinstance(run, Record):
        return failures(compute_metrics(run))
    if not hasattr(run, "get") or "settings" not in run:
        raise InvalidInputError("run", f"must be a record or its metrics, not {run!r:.80}", run)
    settings = run["settings"]
    return [
        *_incomplete(run),
        *(_policies(run, run["incidents"]) if "incidents" in run else ()),
        *(_unsolved(run) if settings["mode"] == "converged" else ()),
        *_crosscheck(run["crosscheck"], run["steps"]),
        *_broken_limits(run),
        *_physics(run.get("physics", {})),
    ]


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


def completed(metrics: Mapping[str, Any]) -> str:
    """State the completed part of the path, or of the time of it that was asked for."""
    settings = metrics["settings"]
    part = percent(metrics["path_completed"])
    asked = settings["duration"]
    if (settings.get("path_duration") or 0.0) <= asked:
        return part
    return f"{part} of the {asked:g} s asked for, the path takes {settings['path_duration']:g} s"


def _show(value: float | None) -> str:
    return "not a number" if value is None else f"{value:.3g}"


def _at(found: Mapping[str, Any]) -> str:
    return f"step {found['step']} (t = {found['time_s']:.6g} s)"


def _count(steps: int) -> str:
    return f"{steps:,} step" if steps == 1 else f"{steps:,} steps"


def _named(limits: Sequence[Mapping[str, Any]]) -> str:
    """Name three limits, and count the others."""
    others = f" and {len(limits) - 3} more" if len(limits) > 3 else ""
    return ", ".join(map(describe, limits[:3])) + others


def _incomplete(metrics: Mapping[str, Any]) -> Iterator[str]:
    """Report an incomplete path, an early end, and a program without a solution."""
    settings = metrics["settings"]
    if metrics["path_completed"] < 1.0:
        yield f"path completed {completed(metrics)}"
    if settings["status"] != "completed":
        planned = round(settings["duration"] / settings["dt"])
        yield f"ended after {metrics['steps']:,} of {planned:,} steps: {settings['status']}"
    step = settings.get("infeasible_step")
    if step is not None:
        where = _at({"step": step, "time_s": step * settings["dt"]})
        yield f"{INFEASIBLE}, as at {where}: the path is too quick, or out of reach"
    if metrics["max_position_error_m"] is None:
        yield "the tip position is not finite at every step"


def _policies(metrics: Mapping[str, Any], incidents: Mapping[str, Any]) -> Iterator[str]:
    """Name the steps without the network's answer; clipping and active bounds are no failures."""
    done = {word: incidents[f"{name}_steps"] for name, word in _DONE.items()}
    if metrics["settings"]["mode"] != "converged" or not any(done.values()):
        return
    first = incidents["first"]
    counts = ", ".join(f"{steps:,} {word}" for word, steps in done.items() if steps)
    text = f"{_count(sum(done.values()))} without a solution ({counts}), the first at {_at(first)}"
    if first["against"]:
        text += f", against {_named(first['against'])}"
    text += f"; most often in the way: {_in_the_way(metrics)}"
    if done["relaxed"]:
        text += f"; position error up to {_show(metrics['max_position_error_m'])} m"
    if (metrics["start_distance_m"] or 0.0) > FAR:
        text += f"; the path begins {_show(metrics['start_distance_m'])} m from the tip"
    yield text
    if done["slowed"]:
        clock = f"{incidents['path_time_s']:.4g} s of the path in {metrics['duration_s']:.4g} s"
        off = incidents["off_path_m"]
        aside = "" if off is None else f"; rows kept the tip up to {_show(off)} m off the path"
        yield f"slowed: {clock}{_needed(metrics)}{aside}"


def _in_the_way(metrics: Mapping[str, Any]) -> str:
    """Name the limits that were longest in the way of a solution."""
    incidents = metrics["incidents"]
    blocks = [*incidents["blocking_rows"], *incidents["blocking"]]
    if blocks:
        return _named(sorted(blocks, key=lambda limit: -limit["steps"]))
    own = " or ".join(metrics["settings"].get("own_tasks") or ())
    return "no bound, a singular pose" + (f" or {own} against other tasks" if own else "")


def _needed(metrics: Mapping[str, Any]) -> str:
    """State the speed that would have sufficed, and 2 %; nothing if that is not known."""
    needed = metrics["incidents"]["needed"]
    if needed is None:
        return ""
    ratio = np.ceil(10.0 * 1.02 * needed["speed_ratio"]) / 10.0
    period = (metrics["settings"].get("reference") or {}).get("period")
    option = "--stretch" if period is None else f"--period {ratio * period:g}"
    text = f"; at its own speed it asks {ratio:g} times as much of {needed['name']} as its limit"
    text += f": give it {ratio:g} times the time ({option})"
    if metrics["path_completed"] < 1.0:
        text += f"; slowed as here, the path takes about {needed['time_s']:.3g} s"
    return text


def _unsolved(metrics: Mapping[str, Any]) -> Iterator[str]:
    first = metrics["unsolved"]
    if first is not None:
        tolerance = _show(metrics["settings"]["tol"])
        yield (
            f"{_at(first)}: KKT residual {_show(first['residual'])}, tolerance {tolerance}; "
            f"{_count(first['steps'])} unsolved in all"
        )


def _crosscheck(check: Mapping[str, Any], steps: int) -> Iterator[str]:
    """Report disagreements, and what the references could not judge."""
    first = check["first_disagreement"]
    if first is not None:
        count = _count(check["disagreements"])
        yield f"{_at(first)}: {_disagreement(check, first)}; {count} in all"
    if not check["judged"]:  # in continuous mode the gap is a lag
        return
    missing = check["reference_failures"]
    if missing and check["solver"] == PROOF:
        yield f"{_count(missing)} not proven"
    elif missing:
        yield (
            f"reference answers missing or not accurate enough to judge by: {missing:,} "
            f"({check['solver']}); the check 'proof' needs no other solver"
        )
    unchecked = steps - check["steps_checked"] - check["kinds"]["stopped"]
    if unchecked:
        yield f"{_count(unchecked)} of {steps:,} not checked"
    if any(count and kind != "own" for kind, count in check["kinds"].items()):
        yield programs_checked(check)


def _disagreement(check: Mapping[str, Any], first: Mapping[str, Any]) -> str:
    """State by whom and by how much a step is found wrong."""
    gap = _show(first["gap"])
    if first["solver"] == BOUNDS:
        return f"the command is {gap} outside of its bounds and rows, tolerance {EXCESS_TOLERANCE}"
    tolerance = f"tolerance {_show(check['tolerance'])}"
    if first["solver"] == PROOF:
        return f"proven within {gap} rad/s of the exact solution alone, {tolerance}"
    return f"{first['solver']} differs by {gap} rad/s, {tolerance}"


def _broken_limits(metrics: Mapping[str, Any]) -> Iterator[str]:
    for limit in JOINT_LIMITS:
        worst = metrics.get(limit.metric, 0.0)  # few schemes have all of them
        if worst is None:
            yield f"a joint {limit.kind} is not finite"
        elif worst > LIMIT_SLACK:
            where = metrics["violations"][limit.metric]
            broken = f"joint {limit.kind} limit broken by {_show(worst)} {limit.unit}"
            yield f"{broken}; {where['joint']} at {_at(where)}"
    near = metrics.get("collisions")
    if near is not None and near["missing_m"] > LIMIT_SLACK:
        start = "; begin farther away: another start posture" if near["time_s"] == 0.0 else ""
        yield (
            f"{near['second']} and {near['first']} came as near as "
            f"{near['least_distance_m']:.6g} m at t = {near['time_s']:.6g} s, "
            f"allowed {near['allowed_m']:.6g} m{start}"
        )


def _physics(physics: Mapping[str, Any]) -> Iterator[str]:
    for reached in physics.get("torque_limit_reached", ()):
        yield (
            f"{reached['joint']}: torque reached its limit of {reached['limit_n_m']:g} N m at "
            f"{_at(reached)}; {reached['steps']:,} in all"
        )
