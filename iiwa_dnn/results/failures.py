"""Reasons why a run is not a success, from its metrics."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from iiwa_dnn.files import percent
from iiwa_dnn.naming import DONE, KINDS, describe
from iiwa_dnn.results.metrics import GAPS, JOINT_LIMITS, PROGRAMS, compute_metrics
from iiwa_dnn.results.record import Record

LIMIT_SLACK = 1e-9
"""Excess over a limit [rad, rad/s, m] that is forgiven: rounding of the motion's integration."""

_ABRUPT = 1e-4
"""Speed [m/s, rad/s] or distance [m] of a path's start from which on it does not begin at rest at
the tip."""


def failures(run: Record | Mapping[str, Any]) -> list[str]:
    """List the reasons why a run is not a success; its exit code is then 1.

    A run fails if it did not complete its path, if a step broke a limit, or if joints exceeded a
    limit of the robot that its scheme does not mention (`unlimited`). In converged mode it also
    fails if a step was not solved or had no solution, or if a reference solver disagreed, was not
    accurate enough to judge, or was not asked.

    Args:
        run: The record, or its metrics.

    Returns:
        The reasons, the gravest first; empty if there is none.
    """
    if not isinstance(run, Mapping):
        return failures(compute_metrics(run))
    check = run["crosscheck"]
    judged = [*_policies(run), *_unsolved(run)] if run["settings"]["mode"] == "converged" else []
    reasons = [
        *unlimited(run, named=False),
        *_incomplete(run),
        *judged,
        *_crosscheck(check, run["steps"]),
        *_broken_limits(run),
    ]
    others = any(steps for kind, steps in check["kinds"].items() if kind != PROGRAMS[0])
    if not reasons and others:
        return [f"not all commands are the nominal program's: {command_kinds(check)}"]
    return reasons


def unlimited(metrics: Mapping[str, Any], named: bool) -> Iterator[str]:
    """Report each limit of the robot that joints exceeded because the run's was wider, or none.

    Args:
        metrics: The metrics.
        named: True: only limits that the run's scheme or settings replace, by a wider one or by
            "none"; False: only limits that they do not mention. Position and velocity limits are
            always mentioned.
    """
    units = dict(JOINT_LIMITS.values())
    for quantity, found in metrics["beyond_robot"].items():
        if found["named"] == named:
            most = found["limited"]
            was = "not limited" if most is None else f"limited to {_show(most)}"
            unit = units[quantity.split()[-1]]
            yield (
                f"{quantity} was {was}: up to {_show(found['largest'])} {unit} at "
                f"{found['joint']}, the robot's limit is {_show(found['limit'])}; {_at(found)}"
            )


def command_kinds(check: Mapping[str, Any]) -> str:
    """Count the commands by kind of program, as ``736 nominal, 9,264 relaxed``.

    The counts are of steps that were checked: the references check the solution of the program, the
    step's own bounds a rate-limited command.
    """
    kinds = check["kinds"].items()
    return ", ".join(f"{steps:,} {kind.replace('_', '-')}" for kind, steps in kinds if steps)


def qps_checked(metrics: Mapping[str, Any]) -> str:
    """State how many programs the references judged, ``9 of 10 QPs verified by proxqp``."""
    check = metrics["crosscheck"]
    checked = check["steps_checked"]
    if not checked:
        return "no QPs checked"
    is_right = check["judged"] and not (check["disagreements"] or check["reference_failures"])
    verb = "verified by" if is_right else "compared with"
    judges = " or ".join(check["judged_by"]) or check["solver"]
    kinds = "" if check["kinds"][PROGRAMS[0]] == checked else f": {command_kinds(check)}"
    lag = "" if check["judged"] else ", not judged"
    return f"{checked:,} of {metrics['steps']:,} QPs {verb} {judges}{kinds}{lag}"


def completed(metrics: Mapping[str, Any]) -> str:
    """State the completed part of the path; of a run that is shorter, that of its duration."""
    part = percent(metrics["path_completed"])
    asked = metrics["settings"]["duration"]
    whole = metrics["settings"].get("path_duration") or asked
    return part if whole <= asked else f"{part} of the {asked:g} s asked for, of {whole:g} s"


def _show(value: float | None) -> str:
    """Format a number in three digits; None stands for one that was not finite."""
    return "not a number" if value is None else f"{value:.3g}"


def _at(found: Mapping[str, Any]) -> str:
    """Name the step and the time of an event in the metrics."""
    return f"step {found['step']} (t = {found['time_s']:.6g} s)"


def counted(steps: int) -> str:
    """Format a number of steps, ``1 step`` or ``1,000 steps``."""
    return f"{steps:,} step" if steps == 1 else f"{steps:,} steps"


def _incomplete(metrics: Mapping[str, Any]) -> Iterator[str]:
    """Report an incomplete path, an early end, and a program without a solution."""
    settings = metrics["settings"]
    if metrics["path_completed"] < 1.0:
        yield f"path completed {completed(metrics)}"
    if away := metrics.get("beyond_reach_m"):
        yield f"the path leads {away:.3g} m beyond the arm's reach: are its positions in metres?"
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
    """Report the steps at which a policy acted, and the limits that left no solution."""
    incidents = metrics["incidents"]
    done = {
        word: incidents[f"{action}_steps"]
        for action, word in DONE.items()
        if action != "euler" and incidents[f"{action}_steps"]
    }
    if not done:
        return
    counts = ", ".join(f"{steps:,} {word}" for word, steps in done.items())
    unexplained = incidents["unexplained_steps"]
    limits = [limit for limit in incidents["limiting"][:3] if limit["steps"] >= unexplained]
    limiting = ", ".join(map(describe, limits)) or (
        "no bound, but a singular posture, a path out of reach or conflicting tasks; another start "
        "(--q0) may help"
    )
    kind = limits[0].get("limit") if limits else None
    yield (
        f"{counted(sum(done.values()))} without a solution ({counts}), the first at "
        f"{_at(incidents['first'])}; limited most often by {limiting}{_advice(metrics, kind)}"
    )


def _advice(metrics: Mapping[str, Any], kind: str | None) -> str:
    """Return advice for a path on which limits of this kind left no solution most often."""
    if kind not in KINDS[1:4]:
        return ""
    incidents = metrics["incidents"]
    advice = "; more time for the path (--period, --stretch) may help"
    if kind == "velocity":
        return advice
    start = max(metrics["settings"].get("start_speed", 1.0), metrics["start_distance_m"] or 0.0)
    if incidents["first"]["step"] == 0 and start > _ABRUPT:
        advice = "; the arm starts at rest, the path at speed or elsewhere (heart, line: at rest)"
    leaves = "; each joint is limited by itself, so the tip leaves the path" + advice
    return leaves if incidents["slow_steps"] else advice


def _unsolved(metrics: Mapping[str, Any]) -> Iterator[str]:
    """Report the steps whose KKT residual is above the tolerance."""
    first = metrics["unsolved"]
    if first is not None:
        tolerance = _show(metrics["settings"]["tol"])
        said = f"KKT residual {_show(first['residual'])}, tolerance {tolerance}"
        if first["residual"] is None:
            said = "the network has no answer, a fallback program took its place"
        yield f"{_at(first)}: {said}; {counted(first['steps'])} unsolved in all"


def _crosscheck(check: Mapping[str, Any], steps: int) -> Iterator[str]:
    """Report disagreements, and steps that the references could not judge."""
    first = check["first_disagreement"]
    if first is not None:
        said = GAPS[first["quantity"]].format(solver=first["solver"], gap=_show(first["gap"]))
        tolerance = _show(first["tolerance"])
        yield (
            f"{_at(first)}: {said}, tolerance {tolerance}; {counted(check['disagreements'])} in all"
        )
    if not check["judged"]:  # in continuous mode the gap is a lag
        return
    if check["reference_failures"]:
        yield (
            "reference answers missing or not accurate enough to judge by: "
            f"{check['reference_failures']:,} ({check['solver']}); the check 'proof' needs no "
            "other solver"
        )
    unchecked = steps - check["steps_checked"] - check["kinds"]["stopped"]
    if unchecked:
        yield f"{counted(unchecked)} of {steps:,} not checked"


def _broken_limits(metrics: Mapping[str, Any]) -> Iterator[str]:
    """Report limits of the joints, the distance and the torques that were not kept."""
    for name, (kind, unit) in JOINT_LIMITS.items():
        worst = metrics.get(name, 0.0)  # few schemes have all of them
        if worst is None:
            yield f"a joint {kind} is not finite"
        elif worst > LIMIT_SLACK:
            where = metrics["violations"][name]
            degrees = "; are positions in degrees?" * (kind == "position" and worst > 2.0 * math.pi)
            yield (
                f"joint {kind} limit broken by {_show(worst)} {unit}; {where['joint']} at "
                f"{_at(where)}{degrees}"
            )
    near = metrics.get("collisions")
    if near is not None and near["missing_m"] > LIMIT_SLACK:
        yield (
            f"{near['second']} and {near['first']} came as near as {near['least_distance_m']:.6g} "
            f"m at t = {near['time_s']:.6g} s, allowed {near['allowed_m']:.6g} m"
        )
    most = metrics.get("demand")
    if most is not None and most["max_fraction"] > 1.0 + LIMIT_SLACK:
        yield f"{most['joint']} needs {most['max_fraction']:.6g} of its torque, at {_at(most)}"
    reached = metrics.get("physics", {}).get("torque_limit_reached")
    if reached is not None:
        yield (
            f"torque limit reached by {', '.join(reached['joints'])}, first at {_at(reached)}; "
            f"{counted(reached['steps'])}"
        )
