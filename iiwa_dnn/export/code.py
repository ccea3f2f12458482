"""A controller as C code: what is translated of it, and the numbers of its templates."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from importlib.resources import files
from typing import Any, NamedTuple

from iiwa_dnn.control.command import PLACEMENT
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.step import ANSWER, SAMPLE, WRITE, ControlStep, control_step, sample_targets
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.kinematics import kinematics_code
from iiwa_dnn.export.translator import Translator
from iiwa_dnn.export.values import DOUBLE, Array, Tuple, Value, integer
from iiwa_dnn.networks.integrators.base import BUDGET
from iiwa_dnn.schemes.program import ProgramArrays
from iiwa_dnn.schemes.step import TARGET_SIZE

TRIES = 2
"""Times that the network is asked at a step: from its last state, and from its first one."""

_DOUBLE = 8
"""Bytes of a number."""


class Code(NamedTuple):
    """A controller in C.

    Attributes:
        values: Texts by the names of the places in the templates.
        has_reference: Whether the reference is translated too.
    """

    values: dict[str, str]
    has_reference: bool

    def fill(self, template: str, more: Mapping[str, object] | None = None) -> str:
        """Return a template with the values, and more of them, in its places."""
        folder = files("iiwa_dnn.export") / "templates"
        text = (folder / template).read_text(encoding="utf-8")
        for name, value in {**self.values, **(more or {})}.items():
            text = text.replace(f"@{name}@", str(value))
        return text


def code_of(controller: Controller) -> Code:
    """Translate a controller whose scheme is anchored.

    Raises:
        InvalidInputError: A part of it is not compiled, or has no translation; it is named.
    """
    step = controller.control_step
    check(controller, step)
    robot = controller.robot
    program = step.program
    n, m, p = program.sizes
    state = 3 * n + m + p
    translator = Translator()
    arrays = _arrays(translator, step)
    dof = robot.dof
    clock = Value(Tuple(DOUBLE, 2), "clock")
    translator.define(clock.kind)
    arguments = [
        _array("row", step.layout.width),
        arrays,
        _array("q", dof),
        _array("past", 4, dof),
        _array("following", 4, dof),
        _array("state", state),
        clock,
        integer(WRITE),
    ]
    translator.function(control_step, arguments)
    has_reference = step.begin == SAMPLE
    frames = len(program.target_frames)
    if has_reference:
        targets = _array("targets", frames, TARGET_SIZE)
        translator.function(sample_targets, [arrays, Value(DOUBLE, "t"), targets])
    columns = step.layout.columns
    sizes = {
        "width": step.layout.width,
        "past": 4 * dof,
        "state": state,
        "jacobian": 6 * dof,
        "placements": PLACEMENT * robot.model.nframes,
    }
    budget = int(step.network_constants[BUDGET])
    at_lb = (n + m + p) * (n + 1)
    values: dict[str, Any] = {
        **sizes,
        "robot": robot.name,
        "version": version("iiwa-dnn"),
        "dof": dof,
        "n": n,
        "m": m,
        "p": p,
        "frames": frames,
        "frame_names": ", ".join(program.target_frames),
        "joint_names": ", ".join(robot.joint_names),
        "dt": repr(controller.dt),
        "systems": TRIES * budget,
        "size": _DOUBLE * (sum(sizes.values()) + 4 * dof + 2),
        "actions": _actions(),
        "at_lb": at_lb,
        "at_ub": at_lb + n,
        "at_dq": columns["dq"].start,
        "at_targets": columns["targets"].start,
        "code": translator.text(),
        "kinematics": kinematics_code(robot, program.kinematics.frame_ids),
    }
    return Code({name: str(value) for name, value in values.items()}, has_reference)


def check(controller: Controller, step: ControlStep) -> None:
    """Raise an InvalidInputError that names what of a controller is not compiled."""
    program = step.program
    if program.accelerates:
        raise InvalidInputError("scheme", "is of the acceleration level, which is not exported")
    if program.priorities.any():
        raise InvalidInputError("scheme", "has tasks with priorities, which are not exported")
    for block in getattr(program, "numpy_blocks", ()):
        name = type(block.part).__name__
        raise InvalidInputError("scheme", f"{name} is written with numpy, which is not exported")
    if step.begin == ANSWER:
        raise InvalidInputError("scheme", "is no Scheme of parts that are compiled")
    if program.needs_inertia:
        raise InvalidInputError("scheme", "has a cost of the inertia matrix, which is not exported")
    if program.moving:
        raise InvalidInputError("scheme", "has obstacles that move, which are not exported")
    if not step.has_network:
        problem = "has no compiled answer: take the projection network with the default integrators"
        raise InvalidInputError("solver", problem, controller.solver)


def _arrays(translator: Translator, step: ControlStep) -> Value:
    """Return the arrays of a program, of which those that do not change are tables."""
    own = step.arrays
    values = [
        translator.table("table", own.table),
        translator.table("constants", own.constants),
        _array("jacobian", *own.jacobian.shape),
        _array("placements", *own.placements.shape),
        translator.table("moves", own.moves),
        _array("inertia", *own.inertia.shape),
        Value(DOUBLE, "rate"),
    ]
    return Value(translator.named_tuple(ProgramArrays, values), "arrays", pointer=True)


def _array(name: str, *shape: int) -> Value:
    return Value(Array(DOUBLE, shape), name)


def _actions() -> str:
    lines = [f"#define CONTROLLER_{action.name} {action.value}" for action in Action]
    return "\n".join(lines[: Action.EULER])
