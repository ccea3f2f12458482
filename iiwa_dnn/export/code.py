"""A controller as C code: the kernels that it reaches, its tables, the texts of the templates."""

from __future__ import annotations

import inspect
import re
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.compiling.binding import prelude
from iiwa_dnn.compiling.expressions import Value
from iiwa_dnn.compiling.library import Entry, source_of
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.compiling.sources import Module, TranslationError, c_name
from iiwa_dnn.compiling.translator import Function, Translator
from iiwa_dnn.control import shield as shields
from iiwa_dnn.control.command import log_of
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.cycle import ControlPlan, PathColumn, sample_targets, take_step
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics
from iiwa_dnn.schemes.limits import constant_periods
from iiwa_dnn.schemes.program import Column
from iiwa_dnn.schemes.step import TARGET_SIZE

_PACKAGE = Path(__file__).parents[1]

WIDTH = 120
"""Letters of a line of C at most."""

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

_ARENA = "    bool full = false;\n    struct arena arena = controller_arena(c, &full);\n"


def filled(template: str, values: dict[str, Any]) -> str:
    """Return a template with values in the places of their names."""
    text = (_PACKAGE / "export" / "templates" / template).read_text(encoding="utf-8")
    text = re.sub(r"@(\w+)@", lambda found: str(values[found[1]]), text)
    if not template.endswith((".c", ".h")):
        return text
    text = re.sub(r"\bint64_t\b", "ptrdiff_t", text).replace("INT64_", "PTRDIFF_")
    return "\n".join(part for line in text.split("\n") for part in wrapped(line))


def wrapped(line: str) -> list[str]:
    """Break a line of C that is too long, each time where it is nested least."""
    lines = []
    indent = " " * (len(line) - len(line.lstrip()) + 4)
    while len(line) > WIDTH:
        depth = 0
        breaks = []
        for at, letter in enumerate(line[:WIDTH]):
            depth += (letter in "({[") - (letter in ")}]")
            is_operator = re.match(r" (&&|\|\||[-+*/?:]) ", line[at : at + 4])
            if at > WIDTH // 3 and (line[at - 1 : at + 1] in (", ", "= ") or is_operator):
                breaks.append((depth, -at))
        if not breaks:
            break
        _, end = min(breaks)
        lines.append(line[:-end])
        line = indent + line[-end:].lstrip()
    return [*lines, line]


def code_of(controller: Controller, shield: shields.Shield | None = None) -> dict[str, Any]:
    """Translate a controller whose scheme is anchored, and the shield whose controller it is.

    Returns:
        Texts by the names of their places in the templates.

    Raises:
        InvalidInputError: A part of it is no kernel, or has no translation; it is named.
    """
    step = controller.control_layout
    robot = controller.robot
    program = step.program
    refused: list[object] = [block.part for block in program.refreshed]
    if not step.has_network:
        refused.append(controller.solver.network)
    if refused:
        name = type(refused[0]).__name__
        raise InvalidInputError(
            "controller", f"{name} answers in Python, as obstacles that move do", refused[0]
        )
    model = model_tables(robot, program.kinematics.frame_ids, program.needs_inertia)
    code = _Code(program.needs_inertia)
    lengths = _lengths(controller, shield is not None)
    texts: dict[str, Any] = {
        "plan": code.initializer("plan", code.numbered(step.plan)),
        "model": code.initializer("model", model),
        "take_step": code.kernel(take_step),
        "log_of": code.kernel(log_of),
        "kinematics": code.kernel(write_kinematics),
        "target_function": "",
        "shield_function": "",
        "shield_declaration": "",
    }
    if step.samples:
        sample = {
            "sample": code.kernel(sample_targets),
            "pairs": len(program.pairs),
            "motion": step.width,
        }
        texts["target_function"] = filled("target.c", sample)
    if shield is not None:
        texts["shield_function"] = filled("shield.c", _shield_texts(code, shield))
        texts["shield_declaration"] = filled("shield.h", {"timeout": shield.settings.timeout})
    return {
        **texts,
        **dict(zip("nmp", program.sizes, strict=True)),
        "pairs": len(program.pairs),
        "robot": robot.name,
        "version": version("iiwa-dnn"),
        "dof": robot.dof,
        "width": lengths["log"],
        "motion": lengths["motion_state"],
        "state": lengths["state"],
        "frames": len(program.target_frames),
        "frame_names": ", ".join(program.target_frames),
        "joint_names": ", ".join(robot.joint_names),
        "dt": repr(controller.dt),
        "code": code.text(),
        "map": "\n".join(f" * - {title}" for title in _SECTIONS.values()),
        "fields": "\n".join(f"    double {name}[{k}];" for name, k in lengths.items() if k),
        "size": 8 * sum(lengths.values()),
        "actions": "\n".join(f"#define CONTROLLER_{each.name} {each.value}" for each in Action),
        "has_reference": step.samples,
    }


def _shield_texts(code: _Code, shield: shields.Shield) -> dict[str, Any]:
    """Return the texts of a shield's own step."""
    kernels = {
        "take_request": code.kernel(shields.take_request),
        "come_nearer": code.kernel(shields.come_nearer),
    }
    pairs = len(shield.controller().program.pairs)
    return {
        **kernels,
        "arena": _ARENA * any("&arena" in call for call in kernels.values()),
        "settings": code.initializer("shield_settings", shield.settings),
        "limits": code.initializer("shield_motion", shield.motion),
        "periods": code.initializer("shield_periods", constant_periods(shield.dt)),
        "pairs": pairs,
        "motion": MotionState.width(shield.robot.dof, pairs),
        "flags": shields.Flags.width(),
    }


def _lengths(controller: Controller, shielded: bool) -> dict[str, int]:
    """Count the numbers of each field of the struct."""
    step = controller.control_layout
    dof = controller.robot.dof
    n, m, p = step.program.sizes
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
        "scratch": 8 * n * (n + m + p + 10),  # twice what the package's kernels take
        "positions": dof * shielded,
        "request": dof * shielded,
        "flags": shields.Flags.width() * shielded,
        "aim": TARGET_SIZE * len(step.program.target_frames) * shielded,
    }


class _Code:
    """Translation of the kernels that a controller reaches, and its tables."""

    def __init__(self, needs_inertia: bool) -> None:
        """Begin with nothing."""
        self._fields = {
            "jacobian": "c->jacobian",
            "placements": "c->placements",
            "inertia": "c->inertia" if needs_inertia else "NULL",
            "fallback": "c->fallback",
        }
        self._translator = Translator(_PACKAGE)
        self._parts: list[Function] = []
        self._translator.parts = self._parts
        self._numbers = {0: 0}

    def numbered(self, plan: ControlPlan) -> ControlPlan:
        """Return a plan with the numbers of parts in place of their addresses."""
        blocks = plan.arrays.table.copy()
        blocks[:, Column.ADDRESS] = [*map(self._part, blocks[:, Column.ADDRESS].tolist())]
        paths = plan.paths.table.copy()
        paths[:, PathColumn.ADDRESS] = [*map(self._part, paths[:, PathColumn.ADDRESS].tolist())]
        network = plan.network._replace(
            rates=self._part(plan.network.rates), address=self._part(plan.network.address)
        )
        arrays = plan.arrays._replace(table=blocks)
        return plan._replace(arrays=arrays, network=network, paths=plan.paths._replace(table=paths))

    def _part(self, address: int) -> int:
        """Translate the function at an address, once; return its number."""
        if address not in self._numbers:
            like = Function(self._translator, *self._found(Entry.prototypes[address]))
            self._parts.append(self._translated(Entry.functions[address], like))
            self._numbers[address] = len(self._parts)
        return self._numbers[address]

    def kernel(self, kernel: Any) -> str:
        """Translate a kernel; return how a call of it in C begins."""
        own = self._translated(source_of(kernel))
        return f"{own.name}({'&arena, ' * own.uses_arena}"

    def _found(self, function: Any) -> tuple[Module, Any]:
        """Return the module of a function of the package or of a user's, and its definition."""
        own = function.__module__.startswith("iiwa_dnn.")
        file = None if own else Path(inspect.getfile(function))
        module = self._translator.package.module(function.__module__, file)
        return module, module.names[function.__qualname__]

    def _translated(self, function: Any, like: Function | None = None) -> Function:
        """Translate a function, or raise an InvalidInputError."""
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

    def initializer(self, path: str, own: Any) -> str:
        """Return the initializer of a named tuple, a number or an array, by its path in C."""
        own = self._value(path, own)
        return own.initializer if isinstance(own, Value) else own

    def _value(self, path: str, own: Any) -> Value | str:
        """Write what does not live in the struct as a constant; return its place or initializer."""
        field = self._fields.get(path.rpartition(".")[2])
        if field:
            return f"{{{', '.join([field, *map(str, own.shape)])}}}"
        if isinstance(own, np.ndarray):
            # In C no array is empty.
            numbers = (own if own.size else np.zeros(1, own.dtype)).ravel().tolist()
            table = self._translator.constant(path.replace(".", "_"), numbers, own.shape)
            is_record = isinstance(own, Record)
            sizes = map(str, getattr(own, "sizes", ()))
            return f"{_tag(own)}_of({', '.join([table.text, *sizes])})" if is_record else table
        if not isinstance(own, tuple):
            return self._translator.constant(path.replace(".", "_"), own)
        items: dict[str, Any] = own._asdict()  # type: ignore[attr-defined]
        values = {each: self._value(f"{path}.{each}", item) for each, item in items.items()}
        constants = {each: item for each, item in values.items() if isinstance(item, Value)}
        tag = _tag(own)
        plan = self._translator.plan
        plan[tag] = {} if plan.get(tag, constants) != constants else constants
        lines = [
            f"    .{each} = {item.initializer if isinstance(item, Value) else item},"
            for each, item in values.items()
        ]
        return "\n".join(["{", *lines, "}"]).replace("\n", "\n    ")

    def text(self) -> str:
        """Return structs, tables and functions, and before them those of C's own that they call."""
        text = self._translator.text(_SECTIONS)
        shared = prelude("kernels.h").split("\n\n")
        found = [re.match(r"static inline \S+ \*?(\w+)\(", each) for each in shared]
        used = [e for e, own in zip(shared, found, strict=True) if not own or own[1] in text]
        return "\n\n".join([*used, filled("arena.c", {}), text])


def _tag(own: Any) -> str:
    """Return the name in C of the type of a named tuple or record."""
    return c_name(type(own).__module__, type(own).__name__)
