"""Names of limits and actions, the same in commands, errors, records, reports and pages."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

KINDS = ("position", "velocity", "acceleration", "jerk")
"""Kinds of a joint's bound; the code of one in commands and records is its position here, from
1."""

POSITION_DEPENDENT = "position-dependent velocity"
"""Velocity limit that is zero before a position limit, and counts in its place."""

ACTIONS = {2: "slow", 3: "relax", 4: "stop", 5: "euler"}
"""Actions at a step in place of the network's answer by their codes in commands and records."""

DONE = {
    "slow": "slowed",
    "relax": "relaxed",
    "stop": "stopped",
    "euler": "taken by Euler's method",
}
"""Participles of the actions: a step is slowed."""


def bound_words(settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the words for a bound of each of `KINDS` in a run of these settings.

    A bound of kind 1 may come from any limit in their ``bounding``.
    """
    bounding = settings.get("bounding", ["JointLimits"])
    own = "bound of " + " or ".join(name for name in bounding if name != "JointLimits")
    if "JointLimits" not in bounding and bounding:
        return own, own, *KINDS[2:]
    return ("position" if len(bounding) <= 1 else f"position limit or {own}"), *KINDS[1:]


def bound_name(
    joint: int, code: int, words: Sequence[str], joints: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the name of a joint's bound, as `describe` takes it.

    Args:
        joint: Number of the joint, from 0.
        code: Kind of the bound, positive for an upper one, negative for a lower one.
        words: `bound_words`.
        joints: Names of the joints; none: they go by their numbers.
    """
    side = "upper" if code > 0 else "lower"
    name = {"joint": joint + 1, "side": side, "limit": words[abs(code) - 1]}
    return name | {"name": joints[joint]} if joints else name


def active_limits(
    settings: Mapping[str, Any], codes: Iterable[int], rows: Iterable[float]
) -> list[dict[str, Any]]:
    """Return the names of bounds and rows, as `describe` takes them.

    Args:
        settings: Settings of the run, with its inequality rows, and the numbers of joints whose
            velocity limit depends on the position.
        codes: Codes of the joints' bounds, 0 for none, (n,).
        rows: Other than 0 for an inequality row that is meant, (m,).
    """
    words = bound_words(settings)
    joints = settings.get("joints", ())
    position_dependent_velocity = settings.get("position_dependent_velocity", ())
    bounds = [
        bound_name(
            j,
            int(code),
            (POSITION_DEPENDENT, *words[1:]) if j in position_dependent_velocity else words,
            joints,
        )
        for j, code in enumerate(codes)
        if code
    ]
    named = settings.get("rows") or ()
    return bounds + [row for row, acts in zip(named, rows, strict=True) if acts]


def describe(limit: Mapping[str, Any]) -> str:
    """Name a bound, ``panda_joint4 lower velocity limit``, or a row, ``row 3 of TipSpeedLimit``."""
    if "row" in limit:
        about = f" ({limit['about']})" if "about" in limit else ""
        return f"row {limit['row']} of {limit['part']}{about}"
    end = " limit" if limit["limit"] in (*KINDS, POSITION_DEPENDENT) else ""
    joint = limit.get("name", f"joint {limit['joint']}")
    return f"{joint} {limit['side']} {limit['limit']}{end}"


def short_names(settings: Mapping[str, Any]) -> list[str]:
    """Return short names of the joints, without the words that all their names have in common."""
    names = [name.replace("_", " ").split() for name in settings["joints"]]
    common = set(names[0]).intersection(*names) if len(names) > 1 else set()
    return [" ".join(word for word in name if word not in common) for name in names]


def unwatched(links: Iterable[str]) -> str:
    """Report links that no collision row keeps clear, and the reason."""
    return f"nothing keeps these links clear, they have no <collision> geometry: {', '.join(links)}"
