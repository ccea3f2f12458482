"""A controller as C code: the kernels that it reaches, its tables, the texts of the templates."""

from __future__ import annotations

import copy
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
from iiwa_dnn.compiling.library import Entry, scratch_peak, source_of
from iiwa_dnn.compiling.sources import KERNELS, TranslationError, decoration
from iiwa_dnn.compiling.translator import Function, Translator
from iiwa_dnn.control import shield as shields
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.relaxed import BUDGET
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.control.state import DELAY, ROWS, YIELDS
from iiwa_dnn.control.step import StepPlan, sample_targets, take_step
from iiwa_dnn.control.yielding import ATTEMPTS
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators.base import BUDGET as OWN_BUDGET, enter_answer
from iiwa_dnn.networks.integrators.implicit import settle
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix
from iiwa_dnn.qp.program import QP
from iiwa_dnn.references import Target
from iiwa_dnn.robot.kinematics_kernel import ModelTables, model_tables, write_kinematics
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.scene import move_centers
from iiwa_dnn.schemes.step import TARGET_SIZE

HOSTILE = 200
"""Steps in which the need of memory is measured."""

MARGIN = 2
"""Factor by which a controller has more."""

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
    _check(controller)
    step = controller.control_step
    robot = controller.robot
    program = step.program
    model = model_tables(robot, program.kinematics.frame_ids, program.needs_inertia)
    code = _Code()
    centers = _centers(controller)
    if len(centers):
        code.fields["constants"] = "c->constants"
    if program.needs_inertia:
        code.fields["inertia"] = "c->inertia"
    lengths = _lengths(controller, model)
    texts: dict[str, Any] = {
        "plan": code.value("plan", code.numbered(step.plan)),
        "model": code.value("model", model),
        "take_step": code.kernel(take_step),
        "kinematics": code.kernel(write_kinematics),
        "start": "",
        "move": "",
        "target_function": "",
        "shield_function": "",
        "shield_declaration": "",
    }
    if step.samples:
        sample = {"sample": code.kernel(sample_targets), "delay": DELAY}
        texts["target_function"] = filled("target.c", sample)
    if len(centers):
        lengths["constants"] = step.plan.arrays.constants.size
        start = code.table("start", step.plan.arrays.constants)
        texts["start"] = f"    memcpy(c->constants, {start}, sizeof c->constants);\n"
        moving = {"centers": code.value("centers", centers), "move": code.kernel(move_centers)}
        texts["move"] = filled("move.c", moving)
    if shield is not None:
        lengths |= {"positions": robot.dof, "wish": robot.dof, "flags": 4, "aim": TARGET_SIZE}
        texts["start"] += f"    c->flags[{shields.REASON}] = {shields.NO_WISH}.0;\n"
        texts["shield_function"] = filled("shield.c", _shield_texts(code, shield))
        texts["shield_declaration"] = filled("shield.h", {"timeout": shield.settings[1]})
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
        "fields": "\n".join(f"    double {name}[{k}];" for name, k in lengths.items() if k),
        "size": 8 * sum(lengths.values()),
        "actions": "\n".join(f"#define CONTROLLER_{each.name} {each.value}" for each in Action),
        "has_reference": step.samples,
    }


def _shield_texts(code: _Code, shield: Shield) -> dict[str, object]:
    """Return the texts of a shield's own step."""
    return {
        "settings": code.value("of_shield", shield.settings),
        "limits": code.value("motion", shield.motion),
        "take_positions": code.kernel(shields.take_positions),
        "take_wish": code.kernel(shields.take_wish),
        "approach": code.kernel(shields.approach),
        "rows": ROWS,
        "yields": YIELDS,
        "reason": shields.REASON,
        "halted": f"{shields.HALTED}.0",
    }


def _lengths(controller: Controller, model: ModelTables) -> dict[str, int]:
    """Count the numbers of each field of the struct."""
    step = controller.control_step
    program = step.program
    dof = controller.robot.dof
    qp = QP.from_data(np.zeros(program.data_size), program.sizes)
    return {
        "row": step.layout.width,
        "past": ROWS * dof,
        "following": ROWS * dof,
        "state": controller.solver.network.state_size(qp),
        "relaxed": step.relaxed.size,
        "jacobian": 6 * dof,
        "placements": 12 * controller.robot.model.nframes,
        "inertia": dof * dof * program.needs_inertia,
        "steps": 1,
        "scratch": MARGIN * _scratch(controller, model) // 8,
    }


def _scratch(controller: Controller, model: ModelTables) -> int:
    """Measure the bytes that kernels take for themselves in steps of all kinds.

    What a kernel takes depends on sizes alone. So steps are taken in random postures towards random
    targets, near and out of reach, at which every kernel of a step without a solution is entered.
    """
    twin = copy.copy(controller)
    own = twin.program.kinematics
    random = np.random.default_rng(0)
    scratch_peak()
    for k, q in enumerate(twin.robot.draw(random, HOSTILE)):
        write_kinematics(model, q, own.jacobian, own.placements, own.inertia)
        here = twin.program.placement[9:]
        goal = here + random.choice([0.1, 2.0]) * random.uniform(-1.0, 1.0, 3)
        target = Target(goal, linear_velocity=random.uniform(-1.0, 1.0, 3))
        twin.step(q, k * twin.dt, dict.fromkeys(twin.program.target_frames, target))
    return scratch_peak()


def _check(controller: Controller) -> None:
    """Raise an InvalidInputError that names what of a controller is not compiled."""
    for block in controller.program.refreshed:
        moves = isinstance(block.part, CollisionAvoidance) and not block.part.copies
        _require(moves, "scheme", block.part, "is written with numpy, which is not exported")
    problem = "has no compiled answer: take the projection network with the default integrators"
    problem += ", or in continuous mode a compiled network and ExplicitEuler with substeps"
    _require(controller.control_step.has_network, "solver", controller.solver, problem)


def _require(holds: bool, argument: str, part: object, problem: str) -> None:
    if not holds:
        raise InvalidInputError(argument, f"{type(part).__name__} {problem}", part)


class _Code:
    """Translation of the kernels that a controller reaches, and its tables.

    Attributes:
        fields: Arrays of the plan that live in the struct, by their names.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.fields = {"jacobian": "c->jacobian", "placements": "c->placements"}
        self.fields["inertia"] = "NULL"
        self._translator = Translator(_PACKAGE)
        self._translator.parts = []
        self._numbers = {0: 0}

    def numbered(self, plan: StepPlan) -> StepPlan:
        """Return a plan with the numbers of parts in place of their addresses."""
        arrays = plan.arrays
        table: IntMatrix = arrays.table.copy()
        network = table[1 + table[0, 4]]
        # `settle` does not enter the rates of a network.
        settles = network[1] == enter_answer.address(settle)
        network[2] = 0 if settles else self._part(int(network[2]))
        for row in table[1:]:
            row[1] = self._part(int(row[1]))
        return plan._replace(arrays=arrays._replace(table=table))

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

    def _translated(self, function: Any) -> Function:
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
        """Return the initializer of a named tuple, a number, or an array, which becomes a table.

        Members of named tuples that do not live in the struct are constants of the kernels.
        """
        if isinstance(own, np.ndarray):
            data = self.fields.get(name) or self.table(name, own)
            return f"{{{', '.join([data, *map(str, own.shape)])}}}"
        if not isinstance(own, tuple):
            return number_text(own)
        items: dict[str, Any] = own._asdict()  # type: ignore[attr-defined]
        values = {each: self.value(each, item) for each, item in items.items()}
        plain = [each for each in items if "c->" not in values[each]]
        tag = f"{type(own).__module__.rpartition('.')[2]}_{type(own).__name__}"
        self._translator.constants[tag] = {each: values[each] for each in plain}
        return f"{{{', '.join(values.values())}}}"

    def table(self, name: str, values: Any) -> str:
        """Write a table of constants; return its place."""
        if not values.size:
            return "NULL"
        kind = "ptrdiff_t" if values.dtype.kind == "i" else "double"
        numbers = ", ".join(map(number_text, values.ravel().tolist()))
        tag = f"table_{name}"
        self._translator.tables[tag] = f"static const {kind} {tag}[] = {{{numbers}}};"
        return f"({kind} *){tag}"

    def text(self) -> str:
        """Return structs, tables and functions, and before them those of C's own that they call."""
        text = self._translator.text()
        shared = prelude("kernels.h").split("\n\n")
        found = [re.match(r"static inline \S+ \*?(\w+)\(", each) for each in shared]
        used = [e for e, own in zip(shared, found, strict=True) if not own or own[1] in text]
        whole = "\n\n".join([*used, filled("arena.c", {}), text])
        return re.sub(r"\bint64_t\b", "ptrdiff_t", whole)  # half as long on a microcontroller


def _centers(controller: Controller) -> Matrix:
    """Return the obstacles that move as `move_centers` takes them, (k, 7)."""
    rows: list[Vector] = []
    for block in controller.program.blocks:
        if isinstance(block.part, CollisionAvoidance):
            scene = block.part.scene(controller.robot)
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
