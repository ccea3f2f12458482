"""The reasons why a run is not a success, in plain words, from its metrics."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from iiwa_dnn.files import percent
from iiwa_dnn.naming import describe
from iiwa_dnn.results.metrics import (
    BOUNDS,
    EXCESS_TOLERANCE,
    JOINT_LIMITS,
    compute_metrics,
)
from iiwa_dnn.results.record import Record

LIMIT_SLACK = 1e-9
"""Excess over a limit [rad, rad/s, m] that is forgiven: rounding of the motion's integration."""

_DONE = {"slow_steps": "slowed", "relax_steps": "relaxed", "stop_steps": "stopped"}


def failures(run: Record | Mapping[str, Any]) -> list[str]:
    """List the reasons why a run is not a success; its exit code is then 1.

    A run fails if it did not complete its path, if a step was not solved, had no solution or broke
    a limit, and, in converged mode, if a reference disagreed, gave no answer to be believed, or was
    not asked.

    Args:
        run: The record, or its metrics.

    Returns:
        The reasons, the gravest first; empty if there is none.
    """
    if isinstance(run, Record):
        return failures(compute_metrics(run))
    converged = run["settings"]["mode"] == "converged"
    check = run["crosscheck"]
    reasons = [
        *_incomplete(run),
        *(_policies(run) if converged else ()),
        *(_unsolved(run) if converged else ()),
        *_crosscheck(check, run["steps"]),
        *_broken_limits(run),
    ]
    if not reasons and any(steps for kind, steps in check["kinds"].items() if kind != "own"):
        return [programs_checked(check)]
    return reasons


def programs_checked(check: Mapping[str, Any]) -> str:
    """State which programs were checked, ``736 own, 9,264 softened programs checked``.

    Of a step held back the command is checked for its bounds alone, of a stopped step nothing is.
    """
    kinds = dict(check["kinds"])
    stopped = kinds.pop("stopped")
    answered = ", ".join(f"{steps:,} {kind}" for kind, steps in kinds.items() if steps)
    return f"{answered or 'no'} programs checked" + (f", {stopped:,} stopped" if stopped else "")


def completed(metrics: Mapping[str, Any]) -> str:
    """State the completed part of the path, or of the time of it that was asked for."""
    part = percent(metrics["path_completed"])
    asked = metrics["settings"]["duration"]
    whole = metrics["settings"].get("path_duration") or asked
    return part if whole <= asked else f"{part} of the {asked:g} s asked for, of {whole:g} s"


def _show(value: float | None) -> str:
    return "not a number" if value is None else f"{value:.3g}"


def _at(found: Mapping[str, Any]) -> str:
    return f"step {found['step']} (t = {found['time_s']:.6g} s)"


def counted(steps: int) -> str:
    """Count steps in words, ``1 step`` or ``1,000 steps``."""
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
        yield (
            f"no joint velocity inside the limits fulfils the task, as at {where}: the path is "
            "too quick, or out of reach"
        )
    if metrics["max_position_error_m"] is None:
        yield "the tip position is not finite at every step"


def _policies(metrics: Mapping[str, Any]) -> Iterator[str]:
    """Name the steps without the network's answer; clipping and active bounds are no failures."""
    incidents = metrics.get("incidents", {})
    done = {word: incidents[name] for name, word in _DONE.items() if incidents.get(name)}
    if not done:
        return
    counts = ", ".join(f"{steps:,} {word}" for word, steps in done.items())
    first = _at(incidents["first"])
    pose = "no bound, a singular pose or tasks against each other"
    parts = [
        f"{counted(sum(done.values()))} without a solution ({counts}), the first at {first}",
        f"most often in the way: {_named(incidents['blocking']) or pose}",
    ]
    if "slowed" in done and incidents["path_time_s"]:
        pace = metrics["duration_s"] / incidents["path_time_s"]
        parts.append(f"give the path {_show(pace)} times the time (--period, --stretch) or more")
    yield "; ".join(parts)


def _unsolved(metrics: Mapping[str, Any]) -> Iterator[str]:
    first = metrics["unsolved"]
    if first is not None:
        tolerance = _show(metrics["settings"]["tol"])
        yield (
            f"{_at(first)}: KKT residual {_show(first['residual'])}, tolerance {tolerance}; "
            f"{counted(first['steps'])} unsolved in all"
        )


def _crosscheck(check: Mapping[str, Any], steps: int) -> Iterator[str]:
    """Report disagreements, and what the references could not judge."""
    first = check["first_disagreement"]
    if first is not None:
        count = counted(check["disagreements"])
        yield f"{_at(first)}: {_disagreement(check, first)}; {count} in all"
    if not check["judged"]:  # in continuous mode the gap is a lag
        return
    missing = check["reference_failures"]
    if missing:
        yield (
            f"reference answers missing or not accurate enough to judge by: {missing:,} "
            f"({check['solver']}); the check 'proof' needs no other solver"
        )
    unchecked = steps - check["steps_checked"] - check["kinds"]["stopped"]
    if unchecked:
        yield f"{counted(unchecked)} of {steps:,} not checked"


def _disagreement(check: Mapping[str, Any], first: Mapping[str, Any]) -> str:
    """State by whom and by how much a step is found wrong."""
    gap = _show(first["gap"])
    if first["solver"] == BOUNDS:
        return f"the command is {gap} outside of its bounds and rows, tolerance {EXCESS_TOLERANCE}"
    return f"{first['solver']} differs by {gap} rad/s, tolerance {_show(check['tolerance'])}"


def _broken_limits(metrics: Mapping[str, Any]) -> Iterator[str]:
    """Report limits of the joints, the distance and the torques that were not kept."""
    for name, (kind, unit) in JOINT_LIMITS.items():
        worst = metrics.get(name, 0.0)  # few schemes have all of them
        if worst is None:
            yield f"a joint {kind} is not finite"
        elif worst > LIMIT_SLACK:
            where = metrics["violations"][name]
            broken = f"joint {kind} limit broken by {_show(worst)} {unit}"
            yield f"{broken}; {where['joint']} at {_at(where)}"
    near = metrics.get("collisions")
    if near is not None and near["missing_m"] > LIMIT_SLACK:
        start = "; begin farther away: another start posture" if near["time_s"] == 0.0 else ""
        yield (
            f"{near['second']} and {near['first']} came as near as "
            f"{near['least_distance_m']:.6g} m at t = {near['time_s']:.6g} s, "
            f"allowed {near['allowed_m']:.6g} m{start}"
        )
    reached = metrics.get("physics", {}).get("torque_limit_reached")
    if reached is not None:
        by = f"{', '.join(reached['joints'])}, first at {_at(reached)}"
        yield f"torque limit reached by {by}; {counted(reached['steps'])}"
