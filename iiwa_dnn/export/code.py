"""A controller as C code: what is translated of it, and the numbers of its templates."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from importlib.resources import files
from typing import Any, NamedTuple

from iiwa_dnn.control.cascade import Priorities, resolve_program
from iiwa_dnn.control.command import PLACEMENT
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.relaxed import BUDGET, Yielding
from iiwa_dnn.control.step import ANSWER, ControlStep, control_step, sample_targets
from iiwa_dnn.control.yielding import ATTEMPTS, guard_step, yield_step
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.kinematics import kinematics_code
from iiwa_dnn.export.translator import Translator
from iiwa_dnn.export.values import BOOL, DOUBLE, INT, Array, Known, Tuple, Value, integer
from iiwa_dnn.networks.integrators.base import BUDGET as OWN_BUDGET
from iiwa_dnn.qp.layout import Sizes, qp_views
from iiwa_dnn.qp.proof import prove_point
from iiwa_dnn.schemes.foreign import ForeignProgram
from iiwa_dnn.schemes.program import ProgramArrays, write_program
from iiwa_dnn.schemes.step import TARGET_SIZE

_DOUBLE = 8
"""Bytes of a number."""


GUARD = "\n            && guard_step(&arrays, c->past, c->following, &yielding)"
"""Condition on a command where braking has to keep clear of obstacles."""


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
    row = _array("row", step.layout.width)
    past = _array("past", 5, dof)
    following = _array("following", 5, dof)
    network = _array("state", state)
    targets = _array("targets", len(program.target_frames), TARGET_SIZE)
    data = _array("data", program.data_size)
    t = Value(DOUBLE, "t")
    arguments = [row, arrays, _array("q", dof), past, following, network, clock, integer(ANSWER)]
    translator.function(control_step, arguments)
    yielding = _yielding(translator, step)
    further = [integer(_action(controller)), Value(BOOL, "yields")]
    translator.function(yield_step, [row, arrays, past, following, network, yielding, *further])
    translator.function(write_program, [data, arrays, past, targets, t])
    if step.yielding.stop:
        translator.function(guard_step, [arrays, past, following, yielding])
    has_reference = step.samples
    if has_reference:
        translator.function(sample_targets, [arrays, t, targets])
    frames = len(program.target_frames)
    columns = step.layout.columns
    sizes = {
        "width": step.layout.width,
        "past": 5 * dof,
        "state": state,
        "jacobian": 6 * dof,
        "placements": PLACEMENT * robot.model.nframes,
    }
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
        "systems": _own_budget(step) + (ATTEMPTS - 1) * BUDGET + _levels_budget(controller),
        "size": _DOUBLE * (sum(sizes.values()) + 5 * dof + 3),
        "actions": _actions(),
        "policy": _action(controller).value,
        "at_decision": columns["decision"].start,
        "guard": GUARD * bool(step.yielding.stop),
        "at_dq": columns["dq"].start,
        "at_point": columns["point"].start,
        "point_size": 2 * n + m + p,
        "active_size": n + m,
        "at_targets": columns["targets"].start,
        **_levels(translator, controller),
        "code": translator.text(),
        "bound_code": _bound(program.sizes, program.data_size),
        "kinematics": kinematics_code(robot, program.kinematics.frame_ids),
    }
    return Code({name: str(value) for name, value in values.items()}, has_reference)


def _bound(sizes: Sizes, data_size: int) -> str:
    """Translate the proof of an answer, as a text of its own."""
    n, m, p = sizes
    translator = Translator()
    views = translator.function(qp_views, [_array("data", data_size), *map(integer, sizes)])
    assert views is not None
    active = Value(Array(INT, (n + m,)), "active")
    point = _array("point", 2 * n + m + p)
    translator.function(prove_point, [Value(views.result, "qp", pointer=True), point, active])
    return translator.text()


def check(controller: Controller, step: ControlStep) -> None:
    """Raise an InvalidInputError that names what of a controller is not compiled."""
    program = step.program
    if program.accelerates:
        raise InvalidInputError("scheme", "is of the acceleration level, which is not exported")
    for block in getattr(program, "numpy_blocks", ()):
        name = type(block.part).__name__
        raise InvalidInputError("scheme", f"{name} is written with numpy, which is not exported")
    if isinstance(program, ForeignProgram):
        raise InvalidInputError("scheme", "is no Scheme of parts that are compiled")
    if program.needs_inertia:
        raise InvalidInputError("scheme", "has a cost of the inertia matrix, which is not exported")
    if program.moving:
        raise InvalidInputError("scheme", "has obstacles that move, which are not exported")
    if controller.estimator is not None:
        raise InvalidInputError("estimator", "is not exported: hand the estimated positions over")
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


def _own_budget(step: ControlStep) -> int:
    """Return the largest number of linear systems that the step's own program may take."""
    entry = step.program.table[1 + step.program.table[0, 4]]
    budget = step.program.constants[entry[4] + OWN_BUDGET]
    return int(budget)


def _levels_budget(controller: Controller) -> int:
    """Return the largest number of linear systems that the levels of priority may take."""
    own = controller.priorities
    return 2 * own.numbers.size * int(own.settings[OWN_BUDGET])


def _action(controller: Controller) -> Action:
    """Return the action that a controller's policy asks for at a step without a solution."""
    if controller.mode == "continuous":
        return Action.STOP
    return {"slow": Action.SLOW, "relax": Action.RELAX}.get(controller.policy, Action.STOP)


def _yielding(translator: Translator, step: ControlStep) -> Value:
    """Return what relaxed programs need beside a step's own."""
    own = step.yielding
    values = [
        translator.table("row_weights", own.weights),
        translator.table("elastic_rows", own.elastic),
        translator.table("motion_constants", own.limits),
        translator.table("relaxed_settings", own.settings),
        translator.table("scenes", own.scenes),
        Value(DOUBLE, "dt"),
        *(Value(Known("int", address)) for address in own[-5:]),
    ]
    return Value(translator.named_tuple(Yielding, values), "yielding", pointer=True)


def _levels(translator: Translator, controller: Controller) -> dict[str, str]:
    """Translate the levels of priority; texts for the places of their call, empty without any."""
    own = controller.priorities
    count = own.numbers.size
    if not count:
        return {"levels_function": "", "resolve": ""}
    n, m, p = controller.program.sizes
    values = [
        translator.table("level_numbers", own.numbers),
        translator.table("level_of_rows", own.rows),
        _array("data", *own.data.shape),
        _array("x", *own.x.shape),
        _array("missing", *own.missing.shape),
        translator.table("level_settings", own.settings),
        Value(DOUBLE, "tol"),
        Value(Known("int", own.answer)),
    ]
    levels = Value(translator.named_tuple(Priorities, values), "priorities", pointer=True)
    data = _array("data", controller.program.data_size)
    translator.function(resolve_program, [data, *map(integer, (n, m, p)), levels])
    text = (files("iiwa_dnn.export") / "templates" / "levels.c").read_text(encoding="utf-8")
    sizes = {"data": own.data.size, "x": own.x.size, "missing": own.missing.size}
    for name, size in {**sizes, "n": n, "m": m, "p": p}.items():
        text = text.replace(f"@{name}@", str(size))
    return {
        "levels_function": text.replace("@tol@", repr(own.tol)),
        "resolve": "    resolve_levels(c->row);\n",
    }


def _array(name: str, *shape: int) -> Value:
    return Value(Array(DOUBLE, shape), name)


def _actions() -> str:
    lines = [f"#define CONTROLLER_{action.name} {action.value}" for action in Action]
    return "\n".join(lines[: Action.EULER])
