"""What a run in physics came to, beyond what every run is measured by; from its record alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from iiwa_dnn.results.record import FloatArray, Record

SETTLED_AFTER = 0.5
"""From here on [s] the arm is taken to have settled; it starts at rest, its weight unknown."""

RECOVERED_BELOW = 1e-3
"""A push is recovered from once the tip stays this close to its path [m]."""


def physics_metrics(record: Record) -> dict[str, Any]:
    """Sum up torques, settled error and recovery.

    Args:
        record: The run.

    Returns:
        ``{"physics": {...}}``, units in the names; empty for a run without torques. ``recovery_s``
        counts from the push's end and is None where the tip never came back for good.
    """
    if record.torque is None:
        return {}
    error = _distance(record)
    largest = np.abs(record.torque).max(axis=0, initial=0.0)
    settled = error[record.t >= record.t[0] + SETTLED_AFTER]
    return {
        "physics": {
            "settled_after_s": SETTLED_AFTER,
            "max_position_error_settled_m": settled.max() if settled.size else None,
            "max_torque_n_m": largest,
            "torque_limit_n_m": record.settings["torque_max"],
            "max_torque_share": (largest / _limits(record)).max(),
            "push": _push(record, error),
        }
    }


def physics_failures(metrics: Mapping[str, Any], record: Record | None) -> list[str]:
    """Say which joints' torque reached its limit, and when first.

    Args:
        metrics: The metrics of the run.
        record: Its record, where there is one to say more by.

    Returns:
        The reasons; empty for a run without torques.
    """
    physics = metrics.get("physics")
    if physics is None or physics["max_torque_share"] < 1.0:
        return []
    if record is None or record.torque is None:
        return [f"a joint torque reached {physics['max_torque_share']:.0%} of its limit"]
    limit = _limits(record)
    reached = ~(np.abs(record.torque) < limit)
    reasons = []
    for joint in np.flatnonzero(reached.any(axis=0)):
        steps = np.flatnonzero(reached[:, joint])
        reasons.append(
            f"joint {joint + 1} torque reached its limit of {limit[joint]:g} N m at step "
            f"{steps[0]} (t = {record.t[steps[0]]:.6g} s); {steps.size:,} in all"
        )
    return reasons


def _push(record: Record, error: FloatArray) -> dict[str, Any] | None:
    push = record.settings.get("physics", {}).get("disturbances", {}).get("push")
    if push is None:
        return None
    end = push["start"] + push["duration"]
    since, after = error[record.t >= push["start"]], record.t >= end
    far = record.t[after & ~(error <= RECOVERED_BELOW)]
    # The first sample after the last one that is too far away.
    recovered = record.t[after & (record.t > (far[-1] if far.size else -np.inf))]
    return {
        **push,
        "max_position_error_m": since.max() if since.size else None,
        "recovered_below_m": RECOVERED_BELOW,
        "recovery_s": max(0.0, recovered[0] - end) if recovered.size else None,
    }


def _limits(record: Record) -> FloatArray:
    values = record.settings["torque_max"]
    return np.array([np.inf if value is None else value for value in values])


def _distance(record: Record) -> FloatArray:
    distance: FloatArray = np.linalg.norm(record.position - record.position_desired, axis=1)
    return distance
