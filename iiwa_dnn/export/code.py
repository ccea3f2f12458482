"""A controller as C code: the kernels that it reaches, its tables, the texts of the templates."""

from __future__ import annotations

import inspect
import re
from ast import FunctionDef
from collections.abc import Mapping
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.compiling.binding import prelude
from iiwa_dnn.compiling.expressions import number_text
from iiwa_dnn.compiling.library import Entry, source_of
from iiwa_dnn.compiling.sources import KERNELS, TranslationError, decoration
from iiwa_dnn.compiling.translator import Made, Translator
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.relaxed import BUDGET
from iiwa_dnn.control.shield import (
    HALTED,
    NO_WISH,
    REASON,
    Shield,
    approach,
    take_positions,
    take_wish,
)
from iiwa_dnn.control.state import DELAY, ROWS, YIELDS
from iiwa_dnn.control.step import ControlStep, sample_targets, take_step
from iiwa_dnn.control.yielding import ATTEMPTS
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.kernels import move_centers
from iiwa_dnn.export.scratch import scratch_size
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators.base import BUDGET as OWN_BUDGET, enter_answer
from iiwa_dnn.networks.integrators.implicit import settle
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix
from iiwa_dnn.qp.program import QP
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.step import TARGET_SIZE

_PACKAGE = Path(__file__).parents[1]


def filled(template: str, values: Mapping[str, object]) -> str:
    """Return a template with values in the places of their names."""
    text = (files("iiwa_dnn.export") / "templates" / template).read_text(encoding="utf-8")
    return re.sub(r"@(\w+)@", lambda found: str(values[found[1]]), text)


def code_of(controller: Controller, shield: Shield | None = None) -> dict[str, Any]:
    """Translate a controller whose scheme is anchored, and the shield whose controller it is.

    Returns:
        Texts by the names of their places in the templates.

    Raises:
        InvalidInputError: A part of it is no kernel, or has no translation; it is named.
    """
    step = controller.control_step
    _check(controller, step)
    robot = controller.robot
    program = step.program
    code = _Code(step)
    model = model_tables(robot, program.kinematics.frame_ids, program.needs_inertia)
    texts = {
        "plan": code.value("plan", code.plan),
        "model": code.value("model", model),
        "take_step": code.kernel(take_step),
        "kinematics": code.kernel(write_kinematics),
        "start": "",
        "move": "",
        "target_function": "",
        "shield_function": "" if shield is None else _shield_function(code, shield),
    }
    if step.samples:
        texts["target_function"] = filled(
            "target.c", {"sample": code.kernel(sample_targets), "delay": DELAY}
        )
    lengths = _lengths(controller)
    if len(code.centers):
        lengths["constants"] = step.plan.arrays.constants.size
        start = code.table("start", step.plan.arrays.constants)
        texts["start"] = f"    memcpy(c->constants, {start}, sizeof c->constants);\n"
        call = f"{code.kernel(move_centers)}(&arena, plan.arrays.constants, centers, t);"
        centers = code.value("centers", code.centers)
        texts["move"] = f"    const matrix centers = {centers};\n    {call}\n"
    if shield is not None:
        lengths |= {"positions": robot.dof, "wish": robot.dof, "flags": 4, "aim": TARGET_SIZE}
        texts["start"] += f"    c->flags[{REASON}] = {NO_WISH}.0;\n"
    lengths["scratch"] = scratch_size(controller, model)
    return {
        **texts,
        **dict(zip("nmp", program.sizes, strict=True)),
        **{f"at_{name}": step.layout.columns[name].start for name in ("dq", "targets")},
        "robot": robot.name,
        "version": version("iiwa-dnn"),
        "dof": robot.dof,
        "rows": ROWS,
        "width": lengths["row"],
        "state": lengths["state"],
        "relaxed": lengths["relaxed"],
        "frames": len(program.target_frames),
        "frame_names": ", ".join(program.target_frames),
        "joint_names": ", ".join(robot.joint_names),
        "dt": repr(controller.dt),
        "systems": _systems(controller),
        "code": code.text(),
        "fields": "\n".join(f"    double {name}[{size}];" for name, size in lengths.items()),
        "size": 8 * sum(lengths.values()),
        "actions": "\n".join(f"#define CONTROLLER_{each.name} {each.value}" for each in Action),
        "has_reference": step.samples,
    }


def _shield_function(code: _Code, shield: Shield) -> str:
    """Return the text of a shield's own step."""
    values = {
        "settings": code.value("of_shield", shield.settings),
        "limits": code.value("motion", shield.motion),
        "take_positions": code.kernel(take_positions),
        "take_wish": code.kernel(take_wish),
        "approach": code.kernel(approach),
        "rows": ROWS,
        "yields": YIELDS,
        "reason": REASON,
        "halted": f"{HALTED}.0",
    }
    return filled("shield.c", values)


def _lengths(controller: Controller) -> dict[str, int]:
    """Count the numbers of each field of the struct."""
    step = controller.control_step
    program = step.program
    dof = controller.robot.dof
    qp = QP.from_data(np.zeros(program.data_size), program.sizes)
    lengths = {
        "row": step.layout.width,
        "past": ROWS * dof,
        "following": ROWS * dof,
        "state": controller.solver.network.state_size(qp),
        "relaxed": step.relaxed_size,
        "jacobian": 6 * dof,
        "placements": 12 * controller.robot.model.nframes,
        "steps": 1,
    }
    if program.needs_inertia:
        lengths["inertia"] = dof * dof
    return lengths


def _check(controller: Controller, step: ControlStep) -> None:
    """Raise an InvalidInputError that names what of a controller is not compiled."""
    for block in step.program.refreshed:
        if block.part.copies or not isinstance(block.part, CollisionAvoidance):
            problem = f"{type(block.part).__name__} is written with numpy, which is not exported"
            raise InvalidInputError("scheme", problem, block.part)
    network = controller.solver.network
    if type(network).initial_state is not Network.initial_state:
        problem = f"{type(network).__name__} starts from a state of its own, which is not exported"
        raise InvalidInputError("network", problem, network)
    if not step.has_network:
        problem = "has no compiled answer: take the projection network with the default integrators"
        problem += ", or in continuous mode a compiled network and ExplicitEuler with substeps"
        raise InvalidInputError("solver", problem, controller.solver)


class _Code:
    """Translation of the kernels that a controller reaches, and its tables.

    Attributes:
        plan: The plan of its step, with the numbers of parts in place of their addresses.
        centers: Obstacles that move, `move_centers`, (k, 7).
    """

    def __init__(self, step: ControlStep) -> None:
        """Translate the parts that a step enters by their addresses."""
        self._translator = Translator(_PACKAGE)
        self._translator.parts = []
        self._tables: list[str] = []
        self._numbers = {0: 0}
        arrays = step.plan.arrays
        table: IntMatrix = arrays.table.copy()
        network = table[1 + table[0, 4]]
        # `settle` does not enter the rates of a network.
        settles = network[1] == enter_answer.address(settle)
        network[2] = 0 if settles else self._part(int(network[2]))
        for row in table[1:]:
            row[1] = self._part(int(row[1]))
        yielding = step.plan.yielding
        self.plan = step.plan._replace(
            arrays=arrays._replace(table=table),
            yielding=yielding._replace(stop=self._part(yielding.stop)),
        )
        self.centers = _centers(step)
        self._fields = {"jacobian": "c->jacobian", "placements": "c->placements"}
        self._fields["inertia"] = "c->inertia" if step.program.needs_inertia else "NULL"
        if len(self.centers):
            self._fields["constants"] = "c->constants"

    def _part(self, address: int) -> int:
        """Translate the function at an address, once; return its number."""
        if address not in self._numbers:
            made = self._translated(Entry.functions[address])
            assert self._translator.parts is not None
            self._translator.parts.append(made)
            self._numbers[address] = len(self._numbers)
        return self._numbers[address]

    def kernel(self, kernel: Any) -> str:
        """Translate a kernel; return its name in C."""
        return self._translated(source_of(kernel)).name

    def _translated(self, function: Any) -> Made:
        """Translate a function of the package or of a user's, or raise an InvalidInputError."""
        name = getattr(function, "__name__", repr(function))
        try:
            own = function.__module__.startswith("iiwa_dnn.")
            file = None if own else Path(inspect.getfile(function))
            module = self._translator.package.module(function.__module__, file)
            node = module.names[name]
            if not isinstance(node, FunctionDef) or decoration(node) not in KERNELS:
                raise TranslationError(f"{name} is no kernel")
            return self._translator.function(module, node)
        except (AttributeError, KeyError, OSError, TypeError, TranslationError) as error:
            raise InvalidInputError("controller", f"{name} cannot be exported: {error}") from error

    def value(self, name: str, own: Any) -> str:
        """Return the initializer of a named tuple, a number, or an array, which becomes a table."""
        if isinstance(own, np.ndarray):
            data = self._fields.get(name) or self.table(name, own)
            shape = own.shape if data != "NULL" or own.ndim == 1 else (0, 0)
            return f"{{{', '.join([data, *map(str, shape)])}}}"
        if isinstance(own, tuple):
            members = zip(own._fields, own, strict=True)  # type: ignore[attr-defined]
            return f"{{{', '.join(self.value(*each) for each in members)}}}"
        return number_text(own)

    def table(self, name: str, values: Vector | IntMatrix) -> str:
        """Write a table of constants; return its place."""
        if not values.size:
            return "NULL"
        kind = "ptrdiff_t" if values.dtype.kind == "i" else "double"
        numbers = ", ".join(map(number_text, values.ravel().tolist()))
        tag = f"table_{name}"
        self._tables.append(f"static const {kind} {tag}[] = {{{numbers}}};")
        return f"({kind} *){tag}"

    def text(self) -> str:
        """Return structs, tables and functions, and before them those of C's own that they call."""
        text = self._translator.text()
        shared = prelude("kernels.h").split("\n\n")
        found = [re.match(r"static inline \S+ \*?(\w+)\(", each) for each in shared]
        used = [e for e, own in zip(shared, found, strict=True) if not own or own[1] in text]
        whole = "\n\n".join([*used, filled("arena.c", {}), text, *self._tables])
        return re.sub(r"\bint64_t\b", "ptrdiff_t", whole)  # half as long on a microcontroller


def _centers(step: ControlStep) -> Matrix:
    """Return the obstacles that move as `move_centers` takes them, (k, 7)."""
    rows: list[Vector] = []
    for block in step.program.blocks:
        if isinstance(block.part, CollisionAvoidance):
            scene = block.part.scene(step.program.robot)
            for obstacle, part in scene.moving:
                first = block.start + part.start
                rows.append(np.array([first, *scene.constants[part], *obstacle.velocity]))
    return np.reshape(rows, (-1, 7))


def _systems(controller: Controller) -> int:
    """Return the largest number of linear systems that a step may take."""
    program = controller.program
    entry = program.table[1 + program.table[0, 4]]
    own = int(program.constants[entry[4] + OWN_BUDGET])
    return own + (ATTEMPTS - 1) * BUDGET
