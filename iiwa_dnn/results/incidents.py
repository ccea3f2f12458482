"""What went otherwise than planned in a run, counted: from its record alone.

Bounds that acted, commands that were clipped on their way out, steps at which a policy or the
reference solver took the network's place.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.results.record import Record

ACTIONS = {1: "fallback", 2: "slow", 3: "relax", 4: "stop"}
"""Codes in `Record.action`; 0 is the network's own answer."""

Codes = NDArray[Any]

_AT_LIMIT = 1.0 - 1e-9


def incident_metrics(record: Record) -> dict[str, Any]:
    """Count what happened.

    Args:
        record: The run.

    Returns:
        ``{"incidents": {...}}``: ``clipped_steps``; of each code of ``ACTIONS`` the steps; the
        ``path_time_s`` that the reference's clock reached; the ``first`` step at which the
        network's answer was not taken; ``blocking`` and ``active_bounds``, lists with joint, side,
        kind of limit, steps and time. Empty for a run without incidents.
    """
    arrays = (record.bound_multiplier, record.clipped, record.action)
    if all(array is None for array in arrays):
        return {}
    steps, dt = record.steps, float(record.settings["dt"])
    action = np.zeros(steps, np.int8) if record.action is None else record.action
    clipped = record.clipped
    fraction = np.ones(steps) if record.fraction is None else record.fraction
    taken = np.flatnonzero(action)
    return {
        "incidents": {
            "clipped_steps": 0 if clipped is None else int(clipped.any(axis=1).sum()),
            **{f"{name}_steps": int((action == code).sum()) for code, name in ACTIONS.items()},
            "path_time_s": dt * float(fraction.sum()),
            "first": _first(record, int(taken[0])) if taken.size else None,
            "blocking": _blocking(record),
            "active_bounds": _active(record),
        }
    }


def incident_failures(metrics: Mapping[str, Any]) -> list[str]:
    """Say at how many steps the network's answer was not taken, and what was in the way.

    Args:
        metrics: The metrics of the run.

    Returns:
        The reasons; empty where it was always taken. Clipping and active bounds are no failures.
    """
    incidents = metrics.get("incidents")
    if incidents is None or incidents["first"] is None:
        return []
    first, reasons = incidents["first"], []
    where = f"the first at step {first['step']} (t = {first['time_s']:.6g} s)"
    if incidents["fallback_steps"]:
        count = _count(incidents["fallback_steps"])
        reasons.append(f"{count} answered by the reference: the network did not settle")
    without = sum(incidents[f"{name}_steps"] for name in ("slow", "relax", "stop"))
    if without:
        did = ", ".join(
            f"{incidents[f'{name}_steps']:,} {word}"
            for name, word in (("slow", "slowed"), ("relax", "relaxed"), ("stop", "stopped"))
            if incidents[f"{name}_steps"]
        )
        blocks = sorted(incidents["blocking"], key=lambda bound: -bound["steps"])
        names = ", ".join(describe(bound) for bound in blocks[:3]) or "no bound, a singular pose"
        reasons.append(
            f"{_count(without)} without a solution ({did}), {where}; in the way: {names}"
        )
    if incidents["slow_steps"]:
        reached, asked = incidents["path_time_s"], metrics["duration_s"]
        reasons.append(f"slowed: path time {reached:.6g} s after {asked:.6g} s")
    return reasons


def describe(bound: Mapping[str, Any]) -> str:
    """A bound in words, as ``joint 1 lower position limit``."""
    return f"joint {bound['joint']} {bound['side']} {bound['limit']} limit"


def _first(record: Record, step: int) -> dict[str, Any]:
    assert record.action is not None
    return {
        "step": step,
        "time_s": float(record.t[step]),
        "action": ACTIONS.get(int(record.action[step]), "unknown"),
    }


def _blocking(record: Record) -> list[dict[str, Any]]:
    """The bounds that stood in the way of a solution."""
    codes = record.blocking
    return [] if codes is None else _bounds(record, np.sign(codes), np.abs(codes) == 2)


def _active(record: Record) -> list[dict[str, Any]]:
    """The bounds that acted, how long, and what they cost."""
    multiplier = record.bound_multiplier
    if multiplier is None:
        return []
    fastest = np.array([np.inf if v is None else v for v in record.settings["dq_max"]], float)
    # A bound is the velocity limit itself, or the tighter one near a position limit.
    at_velocity = np.abs(record.dq_solver) >= _AT_LIMIT * fastest
    bounds = _bounds(record, np.sign(multiplier), at_velocity)
    for bound in bounds:
        column = multiplier[:, bound["joint"] - 1]
        held = column[np.sign(column) == (1 if bound["side"] == "upper" else -1)]
        bound["max_multiplier"] = float(np.abs(held).max())
        bound["mean_multiplier"] = float(np.abs(held).mean())
    return bounds


def _bounds(record: Record, sides: Codes, at_velocity: Codes) -> list[dict[str, Any]]:
    """For each joint, side and kind of limit: at how many steps, for how long, from when."""
    dt, found = float(record.settings["dt"]), []
    for joint in range(record.dof):
        for side, sign in (("lower", -1), ("upper", 1)):
            for limit, kind in (("position", ~at_velocity), ("velocity", at_velocity)):
                steps = np.flatnonzero((sides[:, joint] == sign) & kind[:, joint])
                if steps.size:
                    found.append(
                        {
                            "joint": joint + 1,
                            "side": side,
                            "limit": limit,
                            "steps": int(steps.size),
                            "time_s": dt * steps.size,
                            "first_s": float(record.t[steps[0]]),
                        }
                    )
    return found


def _count(steps: int) -> str:
    return f"{steps:,} step" if steps == 1 else f"{steps:,} steps"
