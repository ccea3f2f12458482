"""Tables of a controller or a shield: all that the core has to know of an arm, as C and as JSON."""

from __future__ import annotations

import inspect
import json
import struct
from collections.abc import Sequence
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.compiling.expressions import Use
from iiwa_dnn.compiling.library import Entry
from iiwa_dnn.compiling.sources import Module, TranslationError, c_name
from iiwa_dnn.compiling.translator import Function, Translator
from iiwa_dnn.control.command import SINGULAR
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.news import separation_in
from iiwa_dnn.control.paths import by_frame
from iiwa_dnn.control.requests import REASONS
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.core import (
    PACKAGE,
    RELEASE,
    SECTIONS,
    TEMPLATES,
    core,
    filled,
    finished,
    used_prelude,
)
from iiwa_dnn.export.flat import Flat
from iiwa_dnn.export.nodes import Node, PartNumber, path_constants, program_constants, robot_labels
from iiwa_dnn.naming import active_limits, describe, limit_kinds
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Reference
from iiwa_dnn.robot.obstacles import names_of
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.joint_limits import motion_constants
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.program import ProgramArrays
from iiwa_dnn.schemes.separation import Separation
from iiwa_dnn.step.fitting import arm_scratch
from iiwa_dnn.step.plan import Paths
from iiwa_dnn.step.requests import TWIST, Reason

STEPS = 200
"""Recorded steps that tables in JSON hold."""

REQUESTS = ("", "dq", "twist", "position")
"""Arguments of a shield's step by the kinds of requests."""

STATE = 1
"""Numbers of an arm's memory before its state: the mark of its tables."""

_OFFSET = 0xCBF29CE484222325
_PRIME = 0x100000001B3
_BITS = (1 << 64) - 1


def _seen(rule: Separation) -> tuple[int, dict[str, list[float]]]:
    """Return the number of people of a frame, and the half-extents [m] of each named body."""
    named = zip(rule.names, rule.bodies, strict=False)
    return rule.people, {name: body.box.half_extents.tolist() for name, body in named}


class Tables:
    """Tables of one arm.

    Attributes:
        kind: ``"shield"`` or ``"controller"``.
        program: Layout of the program that a step answers.
        kept: Names of the limits.
        frames: Frame of a shield's twists, or the tracked frames of a controller.
        obstacles: Names of the obstacles that can be placed.
        bodies: Half-extents of the box of each body with a speed [m], by its name.
        people: Largest number of bodies that a frame of people shows.
        limit_names: Names of reasons and limits by their codes.
        first_row: Code of the first row.
        memory: Numbers of an arm's memory.
        scratch: Numbers that a call takes for itself.
        periods: ``dt``, ``longest`` and ``delay`` [s].
        own: Parts from outside of the package.
        flat: All numbers and integers.
    """

    def __init__(self, made: Controller | Shield, frame: str | None) -> None:
        """Take a shield, with twists of a frame, or a controller whose scheme is anchored.

        Raises:
            InvalidInputError: A part of the controller is no kernel, or has no translation; the
                part is named.
            NotFoundError: There is no such frame.
        """
        source = made if isinstance(made, Shield) else made.scheme
        self.kept = ", ".join(each.title for each in source.limits) or "none"
        self.own = OwnParts()
        avoidance = avoidance_of(source)
        self._scene = avoidance and {
            "distance": avoidance.distance,
            "obstacles": avoidance.settings()["obstacles"],
        }
        self.people, self.bodies = _seen(separation_in(source.limits) or Separation())
        reasons = [*REASONS]
        if isinstance(made, Shield):
            self.kind = "shield"
            self.frames: Sequence[str] = [frame or made.robot.tip]
            layout = made.layout(self.frames[0])
            paths: list[Reference] = []
        else:
            self.kind = "controller"
            layout = made.arm_layout
            self.frames = layout.step.program.target_frames
            paths = [*by_frame(made.reference, made.robot.tip).values()]
            reasons[Reason.SINGULAR] = SINGULAR
        if layout.called:
            problem = f"are in Python, which C cannot call: {', '.join(layout.called)}"
            raise InvalidInputError("parts", problem, layout.called)
        plan = layout.plan
        settings = plan.settings
        self.program = layout.step.program
        moved = avoidance.obstacles if avoidance and plan.sizes.obstacles else ()
        self.obstacles = names_of(moved)
        bounds, rows = limit_words(self.program)
        self.limit_names = [*reasons, *bounds, *rows]
        self.first_row = len(reasons) + len(bounds)
        self.memory = STATE + layout.memory.size
        self.scratch = self.memory + arm_scratch(plan)
        self.periods = {name: float(getattr(settings, name)) for name in ("dt", "longest", "delay")}
        robot = self.program.robot
        labels = robot_labels(robot, self.program.kinematics.frame_ids)
        nodes = {
            (ProgramArrays, "constants"): program_constants(self.program, labels),
            (Paths, "constants"): path_constants(paths, labels),
        }
        self.flat = Flat(self.own.part, nodes, labels)
        self.flat.add("plan", core().plan, plan)
        self.flat.add_numbers("places", layout.state(layout.memory).obstacles)

    @property
    def has_reference(self) -> bool:
        """Test whether a controller has paths from which it samples targets."""
        return "paths" in self.flat.named["plan"].value["step"].value

    @property
    def limits(self) -> dict[str, np.ndarray[Any, Any]]:
        """Limits of the joints that commands keep, by their names; inf for none."""
        own = motion_constants(self.program.arrays)
        names = ("lower", "upper", "velocity", "acceleration", "jerk")
        return {name: np.array(getattr(own, name)) for name in names}

    @cached_property
    def digest(self) -> int:
        """FNV-1a of 64 bits over the numbers, the integers, and the names of parts."""
        digest = _OFFSET
        for letter in b"".join(
            [*map(_bytes_of_float, self.flat.numbers), *map(_bytes, self.flat.integers)]
        ):
            digest = ((digest ^ letter) * _PRIME) & _BITS
        return digest

    def _step(self, row: Vector) -> dict[str, Any]:
        """Return a recorded step: arguments by their names, the command and its result."""
        n = self.program.robot.dof
        t, *numbers, result = Node.of(row, {}).plain
        kind, period = numbers[n : n + 2]
        asked = numbers[n + 2 : -n]
        given = {"q": numbers[:n], **({"dt": period} if period else {})}
        if self.kind == "controller":
            given |= {"t": t, "target": asked}
        elif request := REQUESTS[int(kind)]:
            given[request] = asked[: TWIST if request == "twist" else n]
        return {"given": given, "dq": numbers[-n:], "result": int(result)}

    def json(self, name: str, rows: Matrix, tolerance: float) -> str:
        """Write the tables as JSON, with recorded steps.

        Args:
            name: Name of the tables.
            rows: Recorded steps, of which those up to `STEPS` are written.
            tolerance: Largest difference of a command in units of the velocity limits.
        """
        robot = self.program.robot
        own = {
            "release": RELEASE,
            "digest": f"{self.digest:016x}",
            "kind": self.kind,
            "name": name,
            "joint_names": [*robot.joint_names],
            "frame_names": [*self.frames],
            "obstacle_names": self.obstacles,
            "bodies": self.bodies,
            "people": self.people,
            "limit_names": self.limit_names,
            "first_row": self.first_row,
            "has_reference": self.has_reference,
            "limits": {k: Node.of(own, {}).plain for k, own in self.limits.items()},
            **self.periods,
            "memory": self.memory,
            "scratch": self.scratch,
            "own": self.own.names,
            "robot": {
                "robot": robot.name,
                "joints": [*robot.joint_names],
                "locked": dict(zip(robot.locked, robot.q_locked, strict=True)),
                "tip": robot.tip,
                "tools": [tool.settings() for tool in robot.tools],
            },
            "scene": self._scene,
            "numbers": Node(self.flat.named).plain,
            "integers": Node(self.flat.worded).plain,
        }
        own["checksum"] = sha256(json.dumps(own).encode()).hexdigest()[:16]
        lines = ",\n  ".join(json.dumps(self._step(row)) for row in rows[:STEPS])
        vectors = f'{{"tolerance": {tolerance!r}, "steps": [\n  {lines}\n ]}}'
        return f'{json.dumps(own, indent=1)[:-2]},\n "vectors": {vectors}\n}}\n'


def _bytes_of_float(own: float) -> bytes:
    return struct.pack("<d", own)


def _bytes(own: int) -> bytes:
    """Return what a digest takes of an integer: 8 bytes, or 8 for each letter of a part's name."""
    if isinstance(own, PartNumber):
        return b"".join(struct.pack("<Q", letter) for letter in own.name.encode())
    return struct.pack("<q", own)


class OwnParts:
    """Parts from outside of the package, translated to C.

    Attributes:
        names: Names of the parts, in the order of their numbers.
        rows: Initializers of the parts in C.
    """

    def __init__(self) -> None:
        """Begin without parts."""
        self._translator = Translator(PACKAGE, Use.OWN)
        self._known: dict[int, PartNumber] = {}
        self.names: list[str] = []
        self.rows: list[str] = []

    def part(self, address: int) -> int:
        """Return the part at an address; 0 for none.

        Raises:
            InvalidInputError: The function there has no translation.
        """
        if address == 0:
            return 0
        if address not in self._known:
            function = Entry.functions[address]
            name = c_name(getattr(function, "__module__", ""), getattr(function, "__name__", ""))
            number = core().parts.get(name, 0) if address > 0 else 0
            known = PartNumber.of(number, name, f"ARMSTEP_PART_{name}")
            self._known[address] = known if number else self._translated(address, function)
        return self._known[address]

    def _translated(self, address: int, function: Any) -> PartNumber:
        """Translate a function; without annotations it has the types of its entry."""
        number = len(core().parts) + 1 + len(self.names)
        try:
            like = Function(self._translator, *self._found(Entry.prototypes[address]))
            own = self._translator.function(*self._found(function), like)
        except (
            AttributeError,
            KeyError,
            OSError,
            TypeError,
            ValueError,
            TranslationError,
        ) as error:
            problem = f"{function!r} cannot be exported: {error}"
            raise InvalidInputError("controller", problem) from error
        text = f"ARMSTEP_PARTS + {len(self.names)}"
        self.names.append(own.name)
        self.rows.append(f'    {{"{own.name}", {like.entry_name}, (void (*)(void)){own.name}}},')
        return PartNumber.of(number, own.name, text)

    def _found(self, function: Any) -> tuple[Module, Any]:
        """Return the module that defines a function, and the syntax tree of the definition."""
        own = function.__module__.startswith("iiwa_dnn.")
        file = None if own else Path(inspect.getfile(function))
        module = self._translator.package.module(function.__module__, file)
        return module, module.names[function.__qualname__]

    def text(self) -> str:
        """Return the C of the parts and of all that they call."""
        code = self._translator.text(SECTIONS)
        arena = filled(TEMPLATES / "core" / "arena.c", {"instead": "NULL"})
        return "\n\n".join([*used_prelude(code), arena, finished(code)])


def limit_words(program: ProgramLayout) -> tuple[list[str], list[str]]:
    """List the names of all limits of a program in the order of their codes.

    Returns:
        For each joint the lower and the upper bound of each of `limit_kinds`; and the rows, behind
        which stand the pairs of rows that belong to others from step to step.
    """
    settings: dict[str, Any] = LimitNames(program).settings
    rows = settings["rows"]
    kinds = range(1, 1 + len(limit_kinds(settings)))
    codes = [sign * kind for kind in kinds for sign in (-1, 1)]
    n = program.robot.dof
    bounds = [
        limit
        for joint in range(n)
        for code in codes
        for limit in active_limits(
            settings, code * np.eye(n, dtype=int)[joint], np.zeros(len(rows))
        )
    ]
    ones = np.eye(len(rows), dtype=int)[:1]
    pairs = [
        limit
        for number in range(2, 2 + len(settings["pairs"]))
        for one in ones
        for limit in active_limits(settings, (), number * one)
    ]
    return [*map(describe, bounds)], [*map(describe, [*rows, *pairs])]
