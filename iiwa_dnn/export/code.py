"""Translate the step of a controller or a shield to C, and make the texts of the templates."""

from __future__ import annotations

import hashlib
import inspect
import json
import re
from collections.abc import Mapping, Sequence
from enum import IntEnum
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.compiling.binding import prelude
from iiwa_dnn.compiling.expressions import Rank, Value, array, number
from iiwa_dnn.compiling.kinds import FLOAT, INT, WIDTH, Kind, commented
from iiwa_dnn.compiling.library import Entry, source_of
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.compiling.sources import Module, TranslationError, c_name
from iiwa_dnn.compiling.translator import Function, Translator
from iiwa_dnn.control.arms import (
    ArmState,
    arm_state,
    halt_arm,
    margin_of,
    motion_of,
    place_arm,
    rest_arm,
    send_arm,
    step_arm,
    stopping_time_of,
)
from iiwa_dnn.control.command import SINGULAR, log_of
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.cycle import sample_targets, take_step
from iiwa_dnn.control.paths import by_frame
from iiwa_dnn.control.plan import ControlPlan, PathColumn, Paths
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.requests import REASONS, Reason, Request
from iiwa_dnn.control.shield import Shield, called_parts
from iiwa_dnn.control.state import count_as_sent
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.tables import (
    Node,
    about_members,
    braced,
    constant,
    function_table,
    path_constants,
    program_constants,
    robot_labels,
    rows_of,
)
from iiwa_dnn.naming import ACTIONS, LimitKind, active_limits, describe, limit_kinds
from iiwa_dnn.references import Reference
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.program import Column, ProgramArrays

_PACKAGE = Path(__file__).parents[1]

TEMPLATES = _PACKAGE / "export" / "templates"
"""Templates of the files, in folders."""

PARTS = TEMPLATES / "parts"
"""Templates of what stands within files."""

_SECTIONS = {
    "compiling": "Sine and cosine",
    "robot": "Kinematics of the arm",
    "references": "Targets of the tracked frames",
    "qp": "Quadratic programs",
    "schemes": "Program of a step: costs, tasks, limits",
    "networks": "Network that solves the program",
    "control": "Control step: answer, yielding, braking",
    "": "Parts from outside of the package",
}
"""Titles of the sections of the code, by the packages that they are translated from."""


def filled(template: Path, values: dict[str, Any]) -> str:
    """Return a template's text with values in place of their names; long lines of C are wrapped."""
    text = template.read_text(encoding="utf-8")
    text = re.sub(r"@(\w+)@", lambda found: str(values[found[1]]), text)
    if template.suffix not in (".c", ".h"):
        return text
    text = re.sub(r"\bint64_t\b", "ptrdiff_t", text).replace("INT64_", "PTRDIFF_")
    return "\n".join(part for line in text.split("\n") for part in wrapped(line))


def wrapped(line: str) -> list[str]:
    """Split a line of C at `WIDTH` characters, where brackets are nested least."""
    lines = []
    indent = " " * (len(line) - len(line.lstrip()) + 4)
    while len(line) > WIDTH:
        depth = 0
        breaks = []
        for at, letter in enumerate(line[:WIDTH]):
            depth += (letter in "({[") - (letter in ")}]")
            is_value = line[at - 1 : at + 1] == "= " and depth == 0
            ends = line[at - 1 : at + 1] == ", " or line[at - 1] == "("
            is_operator = re.match(r" (&&|\|\||[-+*/?:]) ", line[at : at + 4])
            if at > WIDTH // 3 and (ends or is_value or is_operator):
                breaks.append((depth, -at))
        if not breaks:
            break
        _, end = min(breaks)
        lines.append(line[:-end])
        line = indent + line[-end:].lstrip()
    return [*lines, line]


def controller_code(controller: Controller) -> dict[str, Any]:
    """Translate a controller whose scheme is anchored.

    Returns:
        Texts by their names in the templates.

    Raises:
        InvalidInputError: A part of the controller is no kernel, or has no translation; the part
            is named.
    """
    step = controller.control_layout
    robot = controller.robot
    program = step.program
    refused: list[object] = [program.parts[k] for k in program.refreshed]
    if not step.has_network:
        refused.append(controller.solver.network)
    if refused:
        name = type(refused[0]).__name__
        raise InvalidInputError(
            "controller", f"{name} answers in Python, as obstacles that move do", refused[0]
        )
    model = model_tables(robot, program.kinematics.frame_ids, program.needs_inertia)
    places = {own: f"c->{own}" for own in ("jacobian", "placements", "fallback")}
    places["inertia"] = "c->inertia" if program.needs_inertia else "NULL"
    references = [*by_frame(controller.reference, robot.tip).values()]
    code = _Code(program, references, places, folds=True)
    lengths = _lengths(controller)
    n, m, p = program.sizes
    texts: dict[str, Any] = {
        "plan": _nested(code.initializer("plan", code.numbered(step.given))),
        "model": _nested(code.initializer("model", model)),
        **code.kernels(take_step, log_of, write_kinematics, count_as_sent),
        "target_function": "",
        "target_declaration": "\n",
    }
    if step.plan.samples:
        sample = {"sample": code.kernel(sample_targets)}
        texts["target_function"] = filled(PARTS / "target.c", sample)
        texts["target_declaration"] = filled(PARTS / "target.h", {})
    texts |= {
        "pairs": len(program.pairs),
        "width": lengths["log"],
        "motion": lengths["motion_state"],
        "state": lengths["state"],
        "frames": len(program.target_frames),
        "frame_names": ", ".join(program.target_frames),
        "fields": "\n".join(f"    double {name}[{k}];" for name, k in lengths.items() if k),
        "size": 8 * sum(lengths.values()),
        "memory": sum(lengths.values()),
        "scratch": 8 * n * (n + m + p + 10),  # twice what the package's kernels take
        "has_reference": step.plan.samples,
        "actions": _members("CONTROLLER", Action),
        "programs": _members("CONTROLLER", ProgramKind),
        "action_names": ", ".join(json.dumps(ACTIONS.get(k, "")) for k in range(1 + max(Action))),
        "action_count": 1 + max(Action),
    }
    return _about("controller", controller, texts, code, ("", SINGULAR), program)


def _nested(initializer: str) -> str:
    """Indent the lines of an initializer after the first, as in a function."""
    return initializer.replace("\n", "\n    ")


def _members(prefix: str, kind: type[IntEnum]) -> str:
    """Write the members of an enumeration in C, with a prefix before their names."""
    return "\n".join(f"    {prefix}_{own.name} = {own.value}," for own in kind)


def _about(
    kind: str,
    made: Controller | Shield,
    texts: dict[str, Any],
    code: _Code,
    reasons: Sequence[str],
    program: ProgramLayout,
) -> dict[str, Any]:
    """Add the texts about the robot, the limits and the code to those of a controller or shield.

    Args:
        kind: ``"controller"`` or ``"shield"``.
        made: The controller or shield.
        texts: The other texts.
        code: The translation.
        reasons: Names of the reasons, whose codes come before those of limits.
        program: Layout of the program that a step answers.
    """
    names = [json.dumps(name) for name in [*reasons, *limit_words(program)]]
    limits = made.limits if isinstance(made, Shield) else made.scheme.limits
    robot = made.robot
    n, m, p = program.sizes
    texts = texts | {
        "kind": kind,
        "KIND": kind.upper(),
        "robot": robot.name,
        "version": version("iiwa-dnn"),
        "dof": robot.dof,
        "n": n,
        "m": m,
        "p": p,
        "kept": ", ".join(each.title for each in limits) or "none",
        "watched": len(program.pairs) or "none, not even links",
        "joint_names": ", ".join(robot.joint_names),
        "dt": repr(made.dt),
        "code": code.text(),
        "map": "\n".join(f" * - {title}" for title in _SECTIONS.values()),
        "reason_count": len(reasons),
        "sides": 2 * len(limit_kinds(LimitNames(program).settings)),
        "acceleration": int(LimitKind.ACCELERATION),
        "jerk": int(LimitKind.JERK),
        "limit_count": len(names),
        "names": ",\n".join(f"        {name}" for name in names),
    }
    texts["interface"] = filled(PARTS / "interface.c", texts)
    own = repr(sorted((name, str(value)) for name, value in texts.items()))
    return texts | {"digest": hashlib.sha256(own.encode()).hexdigest()[:16]}


def limit_words(program: ProgramLayout) -> list[str]:
    """List the names of all limits of a program in the order of their codes.

    For each joint: the lower and the upper bound of each of `limit_kinds`; then the rows; then the
    pairs of rows that belong to others from step to step.
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
    return [*map(describe, [*bounds, *rows, *pairs])]


def shield_code(shield: Shield, frame: str) -> dict[str, Any]:
    """Translate a shield with twists of one frame; return texts as `controller_code` does."""
    layout = shield.layout(frame)
    plan, step, memory = layout[:3]
    if names := called_parts(shield, step.program):
        problem = f"are in Python, which C cannot call: {', '.join(names)}"
        raise InvalidInputError("limits", problem, names)
    written = ("jacobian", "placements", "inertia", "fallback")
    code = _Code(step.program, [], dict.fromkeys(written, "/* each arm's */ NULL"), folds=False)
    text = code.initializer("plan", plan._replace(step=code.numbered(plan.step)))
    centers = ArmState.of(memory, *plan.sizes).obstacles.ravel().tolist()
    arrays = plan.step.arrays
    n, m, _ = arrays.sizes[:3]
    taken = 8 * n * (n + m + 10) + 2 * plan.width
    taken += 2 * arrays.constants.size + 12 * (len(arrays.placements) + 4 * n) + memory.size
    avoidance = avoidance_of(shield)
    obstacles = avoidance.obstacles if avoidance else ()
    texts = {
        "plan": _nested(text),
        **code.kernels(arm_state, rest_arm, halt_arm, send_arm, step_arm),
        **code.kernels(place_arm, motion_of, margin_of, stopping_time_of),
        "frame": frame,
        "longest": repr(shield.longest_period or 0.0),
        "timeout": repr(shield.settings.timeout),
        "delay": repr(shield.delay),
        "obstacles": len(obstacles),
        "obstacle_names": ", ".join(
            f"{type(each).__name__} {k}" for k, each in enumerate(obstacles, 1)
        )
        or "none",
        "places": ", ".join(map(repr, centers or [0.0])),
        "memory": -(-memory.size // 8) * 8,  # whole cache lines
        "state": memory.size,
        "scratch": taken,
        "requests": _members("SHIELD_REQUEST", Request),
        "reasons": _members("SHIELD", Reason),
    }
    return _about("shield", shield, texts, code, REASONS, step.program)


def _lengths(controller: Controller) -> dict[str, int]:
    """Return the number of doubles in each field of the C struct of a controller."""
    step = controller.control_layout
    dof = controller.robot.dof
    return {
        "log": step.log_layout.width,
        "motion_state": step.width,
        "next_motion_state": step.width,
        "state": controller.solver.state_for(step.program.sizes).size,
        "fallback": step.plan.fallback.size,
        "jacobian": 6 * dof,
        "placements": 12 * controller.robot.model.nframes,
        "inertia": dof * dof * step.program.needs_inertia,
        "steps": 1,
        "action": 1,
    }


class _Code:
    """Translation of the kernels that a step calls, and of the tables that they read."""

    def __init__(
        self,
        program: ProgramLayout,
        paths: Sequence[Reference],
        memory: Mapping[str, str],
        folds: bool,
    ) -> None:
        """Begin without tables.

        Args:
            program: Layout of the program that a step answers.
            paths: Reference of each tracked frame, or none.
            memory: C expressions of arrays that a step writes, by their names in a plan.
            folds: Whether a plan's members are constants for the C compiler, which then drops code
                that is never reached, a third of all; only if no kernel makes another plan.
        """
        self._folds = folds
        self._memory = memory
        self._labels = robot_labels(program.robot, program.kinematics.frame_ids)
        self._named = {
            (ProgramArrays, "constants"): program_constants(program, self._labels),
            (Paths, "constants"): path_constants(paths, self._labels),
        }
        self._translator = Translator(_PACKAGE)
        self._parts: list[Function] = []
        self._translator.parts = self._parts
        self._numbers = {0: 0}

    def numbered(self, plan: ControlPlan) -> ControlPlan:
        """Translate the functions at a plan's addresses; return the plan with their numbers."""
        network = plan.network._replace(
            rates=self._part(plan.network.rates), address=self._part(plan.network.address)
        )
        arrays = self._renumbered(plan.arrays, Column)
        paths = self._renumbered(plan.paths, PathColumn)
        return plan._replace(arrays=arrays, network=network, paths=paths)

    def _renumbered(self, own: Any, columns: type[IntEnum]) -> Any:
        """Replace the addresses in a table of parts or paths by the numbers of functions."""
        address = columns["ADDRESS"]
        table = own.table.copy()
        for column in [own for own in columns if own.name in ("ADDRESS", "REST")]:
            table[:, column] = [*map(self._part, table[:, column].tolist())]
        names = [self._parts[k - 1].name for k in table[:, address].tolist()]
        self._named[type(own), "table"] = function_table(table, columns, names)
        return own._replace(table=table)

    def _part(self, address: int) -> int:
        """Translate the function at an address, once; return its number, from 1."""
        if address not in self._numbers:
            like = Function(self._translator, *self._found(Entry.prototypes[address]))
            self._parts.append(self._translated(Entry.functions[address], like))
            self._numbers[address] = len(self._parts)
        return self._numbers[address]

    def kernels(self, *kernels: Any) -> dict[str, str]:
        """Translate kernels; return the beginnings of their calls in C, by the kernels' names."""
        return {source_of(each).__name__: self.kernel(each) for each in kernels}

    def kernel(self, kernel: Any) -> str:
        """Translate a kernel; return the beginning of a call in C, up to the first argument."""
        own = self._translated(source_of(kernel))
        return f"{own.name}({'&arena, ' * own.uses_arena}"

    def _found(self, function: Any) -> tuple[Module, Any]:
        """Return the module that defines a function, and the syntax tree of the definition."""
        own = function.__module__.startswith("iiwa_dnn.")
        file = None if own else Path(inspect.getfile(function))
        module = self._translator.package.module(function.__module__, file)
        return module, module.names[function.__qualname__]

    def _translated(self, function: Any, like: Function | None = None) -> Function:
        """Translate a function; without annotations it has the types of the entry `like`.

        Raises:
            InvalidInputError: The function has no translation.
        """
        try:
            return self._translator.function(*self._found(function), like)
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

    def initializer(self, name: str, own: Any) -> str:
        """Return the C initializer of a named tuple; names of its tables begin with `name`."""
        items: dict[str, Any] = own._asdict()
        values = {field: self._value(f"{name}_{field}", own, field) for field in items}
        known = {field: own for field, own in values.items() if isinstance(own, Value)}
        tag = _tag(own)
        plan = self._translator.plan
        plan[tag] = known if self._folds and plan.get(tag, known) == known else {}
        texts = [v.initializer if isinstance(v, Value) else v for v in values.values()]
        return braced([f".{name} = {text}" for name, text in zip(items, texts, strict=True)])

    def _value(self, name: str, owner: Any, field: str) -> Value | str:
        """Return a member of a named tuple: a `Value` for a constant, else an initializer.

        Args:
            name: C name of the constant, or beginning of the names of tables.
            owner: The named tuple.
            field: Name of the member.
        """
        own = getattr(owner, field)
        if isinstance(own, tuple):
            return self.initializer(name, own)
        if not isinstance(own, np.ndarray):
            return self._translator.constant(name, own, "") if self._folds else constant(own)
        shape = [*map(number, own.shape)]
        if place := self._memory.get(field):
            return f"{{{', '.join([place, *map(str, own.shape)])}}}"
        table = array(*self._table(name, owner, field), shape)
        if not isinstance(own, Record) or own.ndim > 1:
            return table
        return f"{_tag(own)}_of({', '.join([table.text, *map(str, own.sizes)])})"

    def _table(self, name: str, owner: Any, field: str) -> tuple[Kind, Value]:
        """Write an array as a table; return the type of its numbers and a pointer to them."""
        own = getattr(owner, field)
        kind = FLOAT if own.dtype == np.float64 else INT
        if not own.size:
            name = f"no_{kind.word}s"
            self._translator.tables[name] = f"static const {kind.tag} {name}[1] = {{0}};"
            return kind, Value(kind, f"({kind.tag} *){name}", Rank.UNARY)
        rows = rows_of(owner, field)
        node = self._named.get((type(owner), field)) or Node.of(rows, self._labels, field)
        text = f"static const {node.declaration(name, kind.tag)} = {node.initializer()}"
        about = about_members(owner).get(field) or node.sentence
        self._translator.tables[name] = commented(text, about)
        # Elements of a matrix or a struct are no numbers.
        address = "&" * (isinstance(node.value, dict) or own.ndim > 1)
        return kind, Value(kind, f"({kind.tag} *){address}{name}", Rank.UNARY)

    def text(self) -> str:
        """Return the C of types, tables and functions, after the helpers that these call."""
        text = self._translator.text(_SECTIONS)
        shared = prelude("kernels.h").split("\n\n")
        found = [re.match(r"static inline \S+ \*?(\w+)\(", each) for each in shared]
        used = [e for e, own in zip(shared, found, strict=True) if not own or own[1] in text]
        return "\n\n".join([*used, filled(PARTS / "arena.c", {}), text])


def _tag(own: Any) -> str:
    """Return the C name of the type of a named tuple or a record."""
    return c_name(type(own).__module__, type(own).__name__)
