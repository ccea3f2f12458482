"""A controller as C code: what is translated of it, and the texts of its templates."""

from collections.abc import Mapping
from importlib.metadata import version
from importlib.resources import files
from types import MappingProxyType
from typing import Any

import numpy as np

from iiwa_dnn.control.command import PLACEMENT
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.relaxed import BUDGET
from iiwa_dnn.control.step import ControlStep, control_step, sample_targets
from iiwa_dnn.control.yielding import ATTEMPTS, BRAKE, guard_step, yield_step
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.kinematics import kinematics_code
from iiwa_dnn.export.translator import Translator
from iiwa_dnn.export.values import BOOL, DOUBLE, Array, Known, Tuple, Value, integer
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators.base import BUDGET as OWN_BUDGET
from iiwa_dnn.networks.projection import is_projection
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.program import StepProgram
from iiwa_dnn.schemes.step import TARGET_SIZE

_DOUBLE = 8
"""Bytes of a number."""

_GUARD = "\n            && guard_step(&arrays, c->past, c->following, &yielding)"
"""Condition on a command where braking has to keep clear of obstacles."""

_FIELDS = {
    "row": "program, answer, figures, placement, q, dq, targets",
    "past": "joint positions, last command, the one before, and a wanted one",
    "following": "the same for the next step",
    "state": "of the network",
    "relaxed": "of the networks of relaxed programs",
    "jacobian": "joint Jacobian, row by row",
    "placements": "of the frames",
    "inertia": "joint-space inertia matrix",
    "constants": "of the parts: obstacles that move are among them",
    "steps": "steps since controller_init",
    "delay": "time by which the reference's clock is behind [s]",
    "yields": "1 if the task yielded at the last step",
}
"""Numbers of the struct in C, in their order; those of length 0 are left out."""


def filled(template: str, values: Mapping[str, object]) -> str:
    """Return a template with values in the places of their names."""
    text = (files("iiwa_dnn.export") / "templates" / template).read_text(encoding="utf-8")
    for name, value in values.items():
        text = text.replace(f"@{name}@", str(value))
    return text


def code_of(controller: Controller) -> dict[str, Any]:
    """Translate a controller whose scheme is anchored.

    Returns:
        Texts by the names of their places in the templates.

    Raises:
        InvalidInputError: A part of it is not compiled, or has no translation; it is named.
    """
    step = controller.control_step
    check(controller, step)
    robot = controller.robot
    program = step.program
    n, m, p = program.sizes
    is_warm = is_projection(controller.solver.network)
    motions = _motions(program)
    lengths = _lengths(controller, len(motions) > 0)
    translator = Translator()
    arrays, arrays_set = _arrays(translator, step, motions)
    yielding, yielding_set = _handed(translator, "yielding", step.yielding, {"dt": "CONTROLLER_DT"})
    _translate_step(translator, controller, lengths, arrays, yielding)
    columns = step.layout.columns
    places = {f"at_{name}": columns[name].start for name in ("decision", "dq", "point", "targets")}
    return {
        **places,
        "robot": robot.name,
        "version": version("iiwa-dnn"),
        "dof": robot.dof,
        "n": n,
        "m": m,
        "p": p,
        "frames": len(program.target_frames),
        "frame_names": ", ".join(program.target_frames),
        "joint_names": ", ".join(robot.joint_names),
        "dt": repr(controller.dt),
        "systems": _systems(controller),
        "fields": _fields(lengths),
        "past_size": lengths["past"],
        "size": _DOUBLE * sum(lengths.values()),
        "actions": _actions(),
        "policy": _action(controller),
        "cold": f"    double cold[{3 * n + m + p}] = {{0}};\n" * (not is_warm),
        "state": "c->state" if is_warm else "cold",
        "guard": _GUARD * bool(step.yielding.stop),
        "point_size": 2 * n + m + p,
        "arrays": arrays_set,
        "yielding": yielding_set,
        "move_function": _move_function(translator, motions, lengths["constants"]),
        "move": "    move_obstacles(c->constants, t);\n" * bool(motions),
        "start": "    start_constants(c->constants);\n" * bool(motions),
        "code": translator.text(),
        "kinematics": kinematics_code(robot, program.kinematics.frame_ids, program.needs_inertia),
        "inertia": ", c->inertia" * program.needs_inertia,
        "has_reference": step.samples,
    }


def check(controller: Controller, step: ControlStep) -> None:
    """Raise an InvalidInputError that names what of a controller is not compiled."""
    program = step.program
    for block in program.refreshed:
        if block.part.copies:
            problem = f"{type(block.part).__name__} is written with numpy, which is not exported"
            raise InvalidInputError("scheme", problem)
        _check_motion(block.part)
    network = controller.solver.network
    if type(network).initial_state is not Network.initial_state:
        problem = f"{type(network).__name__} starts from a state of its own, which is not exported"
        raise InvalidInputError("network", problem, network)
    if not step.has_network:
        problem = "has no compiled answer: take the projection network with the default integrators"
        problem += ", or in continuous mode a compiled network and ExplicitEuler with substeps"
        raise InvalidInputError("solver", problem, controller.solver)


def _check_motion(part: Any) -> None:
    """Raise an InvalidInputError unless a limit moves by the velocities of obstacles alone."""
    if not isinstance(part, CollisionAvoidance):
        problem = f"{type(part).__name__} moves by numpy, which is not exported"
        raise InvalidInputError("scheme", problem, part)


def _motions(program: StepProgram) -> list[tuple[int, Vector, Vector]]:
    """List the obstacles that move.

    Returns:
        For each the index of its centre among the constants of all parts, the centre at time 0 [m],
        (3,), and its velocity [m/s], (3,).
    """
    found = []
    for block in program.blocks:
        if isinstance(block.part, CollisionAvoidance):
            for obstacle, own in block.part.scene(program.robot).moving:
                velocity = np.array(obstacle.velocity)
                center = block.part.scene(program.robot).constants[own]
                found.append((block.start + own.start, center, velocity))
    return found


def _lengths(controller: Controller, moves: bool) -> dict[str, int]:
    """Count the numbers of each field of the struct; `moves` says that constants change."""
    step = controller.control_step
    program = step.program
    dof = controller.robot.dof
    qp = QP.from_data(np.zeros(program.data_size), program.sizes)
    return {
        "row": step.layout.width,
        "past": 5 * dof,
        "following": 5 * dof,
        "state": controller.solver.network.state_size(qp),
        "jacobian": 6 * dof,
        "placements": PLACEMENT * controller.robot.model.nframes,
        "inertia": dof * dof * program.needs_inertia,
        "constants": step.arrays.constants.size * moves,
        "relaxed": step.relaxed_size,
        "steps": 1,
        "delay": 1,
        "yields": 1,
    }


def _fields(lengths: dict[str, int]) -> str:
    """Declare the fields of the struct."""
    lines = []
    for name, length in lengths.items():
        size = f"[{length}]" if length > 1 else ""
        if length:
            lines.append(f"    double {name}{size};  /* {_FIELDS[name]} */")
    return "\n".join(lines)


def _translate_step(
    translator: Translator,
    controller: Controller,
    lengths: dict[str, int],
    arrays: Value,
    yielding: Value,
) -> None:
    """Translate the functions of a control step for the lengths of the struct's fields."""
    step = controller.control_step
    program = step.program
    dof = controller.robot.dof
    clock = Value(Tuple(DOUBLE, 2), "clock")
    translator.define(clock.kind)
    row = _array("row", lengths["row"])
    past = _array("past", 5, dof)
    following = _array("following", 5, dof)
    targets = _array("targets", len(program.target_frames), TARGET_SIZE)
    t = Value(DOUBLE, "t")
    own = [_array("state", lengths["state"]), clock, Value(BOOL, "samples"), Value(BOOL, "asks")]
    translator.function(control_step, [row, arrays, past, following, *own])
    n, m, p = program.sizes
    relaxed = _array("relaxed", lengths["relaxed"])
    own = [_array("state", 3 * n + m + p), yielding, relaxed, integer(_action(controller))]
    translator.function(yield_step, [row, arrays, past, following, *own])
    if step.yielding.stop:
        translator.function(guard_step, [arrays, past, following, yielding])
    if step.samples:
        translator.function(sample_targets, [arrays, t, targets])


def _handed(
    translator: Translator,
    name: str,
    own: Any,
    variables: dict[str, str],
    known: Mapping[str, Value] = MappingProxyType({}),
) -> tuple[Value, str]:
    """Hand a named tuple over to translated functions, in C of the same name.

    Args:
        translator: The translation.
        name: Its name.
        own: The named tuple: its arrays become tables, its integers are known.
        variables: C expressions of the fields that change.
        known: Values of fields that are none of these.

    Returns:
        The pointer to it, and the C statements that set its fields.
    """
    values = []
    for field, value in zip(own._fields, own, strict=True):
        if field in known:
            values.append(known[field])
        elif isinstance(value, int):
            values.append(Value(Known("int", value)))
        elif isinstance(value, float):
            values.append(Value(DOUBLE, field))
        elif field in variables:
            values.append(_array(field, *value.shape))
        else:
            values.append(translator.table(f"{name}_{field}", value))
    struct = translator.named_tuple(type(own), values)
    texts = {field: variables.get(field, f"{name}_{field}") for field, _ in struct.members}
    lines = [f"    {name}.{field} = {text};" for field, text in texts.items()]
    return Value(struct, name, pointer=True), "\n".join(lines)


def _arrays(
    translator: Translator, step: ControlStep, motions: list[tuple[int, Vector, Vector]]
) -> tuple[Value, str]:
    """Hand the arrays of a program over; those that do not change are tables."""
    own = step.arrays
    variables = {name: f"c->{name}" for name in ("jacobian", "placements", "inertia")}
    variables["rate"] = "1.0 / CONTROLLER_DT"
    if not step.program.needs_inertia:
        variables["inertia"] = "NULL"
    if not motions:
        return _handed(translator, "arrays", own, variables)
    content: list[float | None] = own.constants.tolist()
    for first, center, _ in motions:
        content[first : first + center.size] = [None] * center.size
    translator.table("arrays_constants", own.constants)
    variables["constants"] = "c->constants"
    constants = Value(Array(DOUBLE, (len(content),), content=tuple(content)), "constants")
    return _handed(translator, "arrays", own, variables, {"constants": constants})


def _move_function(
    translator: Translator, motions: list[tuple[int, Vector, Vector]], size: int
) -> str:
    """Translate the motion of obstacles, and write the functions that start and move them."""
    calls = []
    for first, center, velocity in motions:
        for i, (still, rate) in enumerate(zip(center.tolist(), velocity.tolist(), strict=True)):
            calls.append(f"    constants[{first + i}] = {still!r} + t * {rate!r};")
    values = {"calls": "\n".join(calls), "size": size}
    return filled("moving.c", values) if motions else ""


def _systems(controller: Controller) -> int:
    """Return the largest number of linear systems that a step may take."""
    program = controller.program
    entry = program.table[1 + program.table[0, 4]]
    own = int(program.constants[entry[4] + OWN_BUDGET])
    return own + (ATTEMPTS - 1) * BUDGET


def _action(controller: Controller) -> int:
    """Return the code of what a controller's policy asks for at a step without a solution."""
    if controller.mode == "continuous":
        return BRAKE
    return {"slow": Action.SLOW, "relax": Action.RELAX}.get(controller.policy, Action.STOP)


def _array(name: str, *shape: int) -> Value:
    return Value(Array(DOUBLE, shape), name)


def _actions() -> str:
    lines = [f"#define CONTROLLER_{action.name} {action.value}" for action in Action]
    return "\n".join(lines[: Action.EULER])
