"""Write armstep, one library of C for the steps of all shields and controllers.

It holds the kernels that these call, all parts of the package, functions that read tables, and the
interface. An arm is its tables (`iiwa_dnn.export.arm_tables`).
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterable
from enum import IntEnum
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

from iiwa_dnn.compiling.binding import prelude
from iiwa_dnn.compiling.expressions import Use
from iiwa_dnn.compiling.kinds import WIDTH, Kind
from iiwa_dnn.compiling.library import numbered_kernels, source_of
from iiwa_dnn.compiling.readers import write_readers
from iiwa_dnn.compiling.sources import decoration
from iiwa_dnn.compiling.translator import Translator
from iiwa_dnn.naming import ACTIONS, LimitKind
from iiwa_dnn.qp.dense import all_finite
from iiwa_dnn.step import arms, asking, cycle, fitting, memory
from iiwa_dnn.step.policies import Action, ProgramKind
from iiwa_dnn.step.requests import FASTEST, Reason, Request

RELEASE = 1
"""Number of the layout of tables; another one where a release reads others."""

LAID_OUT = 512
"""Doubles in which tables are laid out."""

PACKAGE = Path(__file__).parents[1]

TEMPLATES = PACKAGE / "export" / "templates"
"""Templates of the files, in folders."""

LARGEST = 30_000
"""Largest integer of tables; the product of two fits into 32 bits."""

ROOM = 30
"""Least width of a comment that is wrapped beside code."""

WRITTEN = ("jacobian", "placements", "inertia", "fallback")
"""Arrays of a plan that steps write: tables have their shapes alone."""

_KERNELS = (
    *(memory.arm_state, memory.rest_arm, memory.halt_arm, memory.place_arm, memory.motion_of),
    *(memory.see_people, memory.see_body, memory.scale_speed, memory.follow_arm, memory.follow_of),
    *(arms.send_arm, arms.step_arm, arms.brake_arm, all_finite, cycle.sample_targets),
    *(asking.margin_of, asking.stopping_time_of, asking.separation_of, asking.torque_of),
    asking.frame_at,
    *(fitting.arm_fits, fitting.arm_scratch),
)
"""Kernels that the interface calls, by their names."""

SECTIONS = {
    "compiling": "Sine and cosine",
    "robot": "Kinematics of the arm",
    "references": "Targets of the tracked frames",
    "qp": "Quadratic programs",
    "schemes": "Program of a step: costs, tasks, limits",
    "networks": "Network that solves the program",
    "step": "Control step: answer, yielding, braking",
    "": "Parts from outside of the package",
}
"""Titles of the sections of the code, by the packages that they are translated from."""


def filled(template: Path, values: dict[str, Any]) -> str:
    """Return a template's text with values in place of their names; C is finished."""
    text = template.read_text(encoding="utf-8")
    text = re.sub(r"@(\w+)@", lambda found: str(values[found[1]]), text)
    return finished(text) if template.suffix in (".c", ".h") else text


def finished(text: str) -> str:
    """Return C with the integers of the machine and with its long lines wrapped."""
    text = re.sub(r"\bint64_t\b", "ptrdiff_t", text)
    text = re.sub(r"\bINT64_", "PTRDIFF_", text)
    return "\n".join(part for line in text.split("\n") for part in wrapped(line))


def wrapped(line: str) -> list[str]:
    """Split a line of C at `WIDTH` characters, where brackets are nested least."""
    if len(line) > WIDTH and (comment := wrapped_comment(line)):
        return comment
    lines = []
    indent = " " * (len(line) - len(line.lstrip()) + 4)
    while len(line) > WIDTH:
        depth = 0
        breaks = []
        plain = re.sub('"[^"]*"', lambda found: "_" * len(found[0]), line)
        for at, letter in enumerate(plain[:WIDTH]):
            depth += (letter in "({[") - (letter in ")}]")
            is_value = plain[at - 1 : at + 1] == "= " and depth == 0
            ends = plain[at - 1 : at + 1] == ", " or plain[at - 1] == "("
            is_operator = re.match(r" (&&|\|\||[-+*/?:]) ", plain[at : at + 4])
            if at > WIDTH // 3 and (ends or is_value or is_operator):
                breaks.append((depth, -at))
        if not breaks:
            break
        _, end = min(breaks)
        lines.append(line[:-end])
        line = indent + line[-end:].lstrip()
    return [*lines, line]


def wrapped_comment(line: str) -> list[str]:
    """Split a line whose end is a comment with enough room; return nothing for another one."""
    begins = re.match(r"(?! *\*/)( *)(?=\* )|(?:(?!/\*).)*(?=/\* (?!.*\*/.))", line)
    at = begins.end() if begins else WIDTH
    if at > WIDTH - ROOM:
        return []
    star = " " * (line[at] == "/") + "* "
    first, *others = textwrap.wrap(line[at:], WIDTH - at, subsequent_indent=star)
    return [line[:at] + first, *(" " * at + own for own in others)]


def members(prefix: str, kind: type[IntEnum]) -> str:
    """Write the members of an enumeration in C, with a prefix before their names."""
    return "\n".join(f"    {prefix}_{own.name} = {own.value}," for own in kind)


class Core(NamedTuple):
    """The library.

    Attributes:
        header: Text of ``armstep.h``.
        code: Text of ``armstep.c``.
        parts: Number of each part by its name.
        plan: Type of the plan that tables hold.
    """

    header: str
    code: str
    parts: dict[str, int]
    plan: Kind


@cache
def core() -> Core:
    """Write the library; once in a process."""
    translator = Translator(PACKAGE, Use.CORE)
    package = translator.package
    for module, node in package.kernels():
        if module.c_name(node.name) in numbered_kernels():
            translator.function(module, node)
    calls = {}
    for kernel in map(source_of, _KERNELS):
        module = package.module(kernel.__module__)
        own = translator.function(module, module.names[kernel.__name__])
        calls[kernel.__name__] = f"{own.name}({'arena, ' * own.uses_arena}"
    plan, state = (_kind(translator, own) for own in (memory.ArmPlan, memory.ArmState))
    readers: dict[str, str] = {}
    write_readers(plan, WRITTEN, readers)
    code = translator.text(SECTIONS)
    values = _words(translator) | calls | {"width": _width(state)}
    folder = TEMPLATES / "core"
    text = [
        filled(folder / "head.c", values),
        filled(folder / "guard.c", values),
        *used_prelude(code),
        filled(folder / "arena.c", values | {"instead": "arena->start"}),
        finished(code),
        "/* ---- Tables: how they are read ---- */",
        filled(folder / "reader.c", values),
        *map(finished, readers.values()),
        "/* ---- Interface ---- */",
        filled(folder / "interface.c", values),
    ]
    header = filled(folder / "armstep.h", values)
    return Core(header, "\n\n".join(text), translator.numbers, plan)


def used_prelude(code: str) -> list[str]:
    """Return the parts of what kernels share that a text of C needs."""
    shared = prelude("kernels.h").split("\n\n")
    found = [re.match(r"static inline \S+ \*?(\w+)\(", each) for each in shared]
    own = [e for e, name in zip(shared, found, strict=True) if not name or name[1] in code]
    return [*map(finished, own)]


def _kind(translator: Translator, own: type) -> Kind:
    """Return the type of a class in C."""
    module = translator.package.module(own.__module__)
    return translator.kinds.of(module, module.names[own.__name__])


def _width(state: Kind) -> str:
    """Write the number of numbers of a state, whose sizes `plan` has."""
    counts = [f"{n} * plan->sizes.{size}" for size, n in state.sizes.items() if size]
    return " + ".join([str(state.sizes[""]), *counts])


def _words(translator: Translator) -> dict[str, Any]:
    """Return the texts of enumerations and names."""
    entries = [own for own in translator.functions.values() if decoration(own.node) == "entry"]
    names = sorted(own.entry_name for own in entries)
    actions = [json.dumps(ACTIONS.get(k, "")) for k in range(1 + max(Action))]
    return {
        "release": RELEASE,
        "version": version("iiwa-dnn"),
        "map": _listed(f" * - {title}" for title in [*SECTIONS.values()][:-1]),
        "requests": members("ARMSTEP_REQUEST", Request),
        "reasons": members("ARMSTEP_REASON", Reason),
        "actions": members("ARMSTEP_ACTION", Action),
        "programs": members("ARMSTEP_PROGRAM", ProgramKind),
        "entries": _listed(f"    {name} = {n}," for n, name in enumerate(names, 1)),
        "parts": _listed(f"    ARMSTEP_PART_{own} = {n}," for own, n in translator.numbers.items()),
        "part_names": _listed(f'    "{own}",' for own in translator.numbers),
        "laid_out": LAID_OUT,
        "largest": LARGEST,
        "acceleration": int(LimitKind.ACCELERATION),
        "jerk": int(LimitKind.JERK),
        "fastest": int(FASTEST),
        "action_names": ", ".join(actions),
        "action_count": len(actions),
    }


def _listed(lines: Iterable[str]) -> str:
    return "\n".join(lines)
