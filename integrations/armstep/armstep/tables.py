"""Tables of an arm, from the JSON that ``iiwa_dnn.export.tables`` writes."""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path as _Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armstep._library import LAID_OUT, LIMITS, NAMED, ONE, OwnPart, TablesStruct
from armstep.errors import InputError, TablesError

Array = NDArray[np.float64]
Path = str | os.PathLike[str]

RELEASE = 1
"""Layout of tables that this release reads."""

KINDS = ("shield", "controller")
"""What tables are of, by their number from 1 on."""

LINE = 8
"""Doubles of a cache line: the memories of arms begin at whole ones."""

STATUS = {
    2: "its numbers have another digest",
    3: "its sizes do not belong together",
    4: "this machine's arithmetic is not that of IEEE 754",
}
"""Words for what `armstep_load` refuses."""


class Fixed:
    """Base of objects whose public attributes are set once: memory is laid out by them."""

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise InputError(f"{name}: is fixed when the object is made")
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> None:
        raise InputError(f"{name}: cannot be deleted")


class Tables(Fixed):
    """All that a step has to know of an arm; `load_tables` reads them from a file.

    Attributes:
        name: Name of the file without its ending.
        kind: ``"shield"`` or ``"controller"``.
        joint_names: Names of the joints, whose order is that of all arrays.
        frame_names: Frame of a shield's twists, or the tracked frames of a controller.
        obstacle_names: Names of the obstacles that can be placed.
        bodies: Half-extents [m] of bodies with a speed, by their names.
        people: Largest number of bodies that a frame of people shows.
        limit_names: Names of reasons and limits by their codes.
        limits: Limits of the joints, (n,) each: lower, upper [rad], velocity, acceleration,
            jerk [rad/s, ...].
        dt: Control period [s].
        longest_period: Longest control period where periods vary [s]; None: they do not.
        delay: Time by which the arm is behind its commands [s].
        digest: Digest of all numbers, by which two tables are told apart.
        has_reference: Whether a controller samples its targets where none are given.
        memory: Doubles of an arm.
        scratch: Doubles that a call takes for itself.
        members: The members of the file, but the recorded steps.
    """

    name: str
    kind: str
    joint_names: tuple[str, ...]
    frame_names: tuple[str, ...]
    obstacle_names: tuple[str, ...]
    bodies: Mapping[str, list[float]]
    people: int
    limit_names: tuple[str, ...]
    limits: Mapping[str, Array]
    dt: float
    longest_period: float | None
    delay: float
    digest: str
    has_reference: bool
    memory: int
    scratch: int
    members: Mapping[str, Any]
    arm: Any

    def __init__(self, members: Mapping[str, Any], own: str | None = None) -> None:
        """Check the members of a file, and lay them out in C.

        Args:
            members: The file's members; recorded steps are not kept.
            own: Library of the parts of a user's own.

        Raises:
            TablesError: They are of another release, or damaged; or the library has other parts.
            LookupError, OverflowError, RecursionError, TypeError, ValueError: So they are.
        """
        if members["release"] != RELEASE:
            found = members["release"]
            raise TablesError(f"has tables of release {found!r}; this armstep reads {RELEASE}")
        kept = {key: value for key, value in members.items() if key != "vectors"}
        if members["checksum"] != checksum(kept):
            raise TablesError("is damaged: its checksum is another one")
        arm = (ctypes.c_double * LAID_OUT)()
        vars(self).update(_attributes(members), members=kept, arm=arm)
        self._own = own
        struct = TablesStruct(
            digest=int(self.digest, 16),
            release=RELEASE,
            kind=1 + KINDS.index(self.kind),
            **{f"{word}s": len(members[f"{word}_names"]) for word in NAMED},
            **{word: members[word] for word in ("first_row", "dt", "longest", "delay")},
            **{word: members[word] for word in ("memory", "scratch")},
        )
        parts = _own_parts(self.name, members["own"], own)
        struct.own, struct.own_count = ctypes.addressof(parts), len(parts)
        self._kept = struct, parts, _arrays(struct, members)  # what C points to
        status = ONE.armstep_load(arm, ctypes.byref(struct))
        sizes = {each.size for each in self.limits.values()}
        if status or sizes != {len(self.joint_names)} or not 0.0 < self.dt < np.inf:
            raise TablesError(f"is damaged: {STATUS.get(status, STATUS[3])}")

    def __reduce__(self) -> Any:
        return Tables, (self.members, self._own)

    def __deepcopy__(self, memo: Any) -> Tables:
        return self


def load_tables(path: Path, own: Path | None = None) -> Tables:
    """Read the tables of an arm.

    Args:
        path: File that ``iiwa_dnn.export.tables`` wrote.
        own: Library of the parts of a user's own, if the arm has such.

    Raises:
        TablesError: The file cannot be read, is damaged, or is of another release; or the parts of
            a user's own are none of it.
    """
    try:
        members = json.loads(_Path(path).read_text(encoding="utf-8"))
        return Tables(members, None if own is None else os.fspath(own))
    except TablesError as error:
        raise TablesError(f"{path}: {error}") from None
    except OSError as error:
        raise TablesError(f"{path}: cannot be read: {error.strerror}") from None
    except (LookupError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise TablesError(f"{path}: is damaged: {error!r}") from None


def checksum(members: Mapping[str, Any]) -> str:
    """Return the digest of all members of a file but itself and the recorded steps."""
    text = json.dumps({key: value for key, value in members.items() if key != "checksum"})
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _attributes(members: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of tables."""
    own = {word: members[word] for word in ("name", "kind", "dt", "delay", "digest", "scratch")}
    own |= {f"{word}_names": tuple(members[f"{word}_names"]) for word in NAMED}
    limits = {word: np.array(members["limits"][word], np.float64) for word in LIMITS}
    for each in limits.values():
        each.setflags(write=False)
    own["limits"] = MappingProxyType(limits)
    own["memory"] = -(-members["memory"] // LINE) * LINE
    own["longest_period"] = members["longest"] or None
    own |= {"bodies": members.get("bodies", {}), "people": members.get("people", 0)}
    own["has_reference"] = bool(members["has_reference"])
    return own


def _leaves(tree: Any, found: list[Any]) -> list[Any]:
    """Append the leaves of a tree of JSON in their order."""
    for each in tree.values() if isinstance(tree, dict) else tree:
        if isinstance(each, (dict, list)):
            _leaves(each, found)
        else:
            found.append(each)
    return found


def _arrays(struct: TablesStruct, members: Mapping[str, Any]) -> list[NDArray[Any]]:
    """Point to the numbers, the integers, and the places of those that number parts."""
    integers = _leaves(members["integers"], [])
    places = [k for k, each in enumerate(integers) if isinstance(each, str)]
    for k in places:
        name = integers[k]
        integers[k] = ONE.armstep_part_number(ctypes.byref(struct), name.encode())
        if not integers[k]:
            raise TablesError(f"is damaged: {name!r} is no part of this release")
    arrays: list[NDArray[Any]] = [
        np.array([*map(float, _leaves(members["numbers"], []))]),
        np.array(integers, np.intp),
        np.array(places, np.intp),
    ]
    for word, array in zip(("number", "integer", "part"), arrays, strict=True):
        setattr(struct, f"{word}s", array.ctypes.data)
        setattr(struct, f"{word}_count", array.size)
    return arrays


def _own_parts(name: str, names: list[str], own: str | None) -> Any:
    """Return the parts of a user's own, of which a library has to have those by `names`."""
    kind: Any = OwnPart * len(names)
    if not names:
        return kind()
    if own is None:
        raise TablesError(f"has parts of a user's own: compile {name}_own.c, and pass own=")
    try:
        parts = kind.in_dll(ctypes.CDLL(own), f"{name}_own")
    except (OSError, ValueError) as error:
        raise TablesError(f"own: {error}") from None
    # The library's array ends with a part without a name: what is behind it is not read.
    if not all(each.name == word.encode() for each, word in zip(parts, names, strict=True)):
        raise TablesError(f"own: {own} has other parts than {', '.join(names)}")
    return parts
