"""Names of limits and actions, the same in commands, errors, records, reports and pages."""

from collections.abc import Iterable, Mapping
from enum import IntEnum
from typing import Any


class LimitKind(IntEnum):
    """Kinds of limits that bound a joint's velocity; their codes in commands and records."""

    POSITION = 1
    VELOCITY = 2
    ACCELERATION = 3
    JERK = 4
    POSITION_DEPENDENT_VELOCITY = 5
    """A velocity limit that is zero before a position limit, and counts in its place."""
    OTHER = 6
    """The first of a scheme's limits; the others have the codes after it."""


KINDS = ("position", "velocity", "acceleration", "jerk", "position-dependent velocity")
"""Words for the kinds of limits, in the order of their codes."""

RATE_LIMITS = KINDS[LimitKind.ACCELERATION - 1 : LimitKind.JERK]
"""Words for the limits of rates of a velocity."""

ACTIONS = {2: "slow", 3: "relax", 4: "stop", 5: "euler"}
"""Actions at a step in place of the network's answer by their codes in commands and records."""

DONE = {
    "slow": "slowed",
    "relax": "relaxed",
    "stop": "stopped",
    "euler": "taken by Euler's method",
}
"""Participles of the actions: a step is slowed."""


def limit_kinds(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the limits that may bound a joint in a run, by their codes from 1."""
    return [*KINDS, *(f"bound of {name}" for name in settings.get("bounding", ()))]


def active_limits(
    settings: Mapping[str, Any], codes: Iterable[int], rows: Iterable[float]
) -> list[dict[str, Any]]:
    """Return a description of each acting bound and row, for `describe`; rates come last.

    Limits of acceleration and jerk most often follow from another one, which is named before them.

    Args:
        settings: Settings of the run, with its inequality rows and the limits with bounds.
        codes: Code of the limit that each joint's active bound comes from, negative for a lower
            bound, 0 for none, (n,).
        rows: Other than 0 for each inequality row that acts, (m,); above 1, the pair that the row
            belongs to is that of this number among the settings' pairs, from 2.
    """
    words = limit_kinds(settings)
    names = settings.get("joints", ())
    found: list[dict[str, Any]] = []
    for j, code in enumerate(codes):
        if code:
            side = "upper" if code > 0 else "lower"
            bound = {"joint": j + 1, "side": side, "limit": words[abs(int(code)) - 1]}
            found.append(bound | {"name": names[j]} if names else bound)
    for row, acts in zip(settings.get("rows") or (), rows, strict=True):
        if acts > 1:
            row = {"part": row["part"], "about": settings["pairs"][int(acts) - 2]}
        if acts and row not in found:
            found.append(row)
    return sorted(found, key=lambda limit: limit.get("limit") in RATE_LIMITS)


def describe(limit: Mapping[str, Any]) -> str:
    """Name a bound, ``panda_joint4 lower velocity limit``, or a row, ``row 3 of TipSpeedLimit``.

    A row that belongs to another pair from step to step goes by the pair.
    """
    if "part" in limit:
        about = f" ({limit['about']})" if "about" in limit else ""
        row = f"row {limit['row']} of " if "row" in limit else ""
        return f"{row}{limit['part']}{about}"
    end = " limit" if limit["limit"] in KINDS else ""
    joint = limit.get("name", f"joint {limit['joint']}")
    return f"{joint} {limit['side']} {limit['limit']}{end}"


def short_names(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the joints without the words that all of them have in common."""
    names = [name.replace("_", " ").split() for name in settings["joints"]]
    common = set(names[0]).intersection(*names) if len(names) > 1 else set()
    return [" ".join(word for word in name if word not in common) for name in names]


def unguarded(pairs: Iterable[str]) -> str:
    """Report pairs of links that may meet and that no collision row keeps apart everywhere."""
    return f"these links may meet, and are not kept apart everywhere: {', '.join(pairs)}"


def unwatched(links: Iterable[str]) -> str:
    """Report links that no collision row keeps clear, and the reason."""
    return f"nothing keeps these links clear, they have no <collision> geometry: {', '.join(links)}"
