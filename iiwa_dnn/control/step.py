"""A whole control step in one compiled call: targets, program and the network's answer.

For seven joints the way into compiled code is a large part of the cost of a call, so a control loop
enters it once a step.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numba import typeof, types
from numba.core.dispatcher import Dispatcher

from iiwa_dnn.control.command import PLACEMENT, RowLayout, row_views
from iiwa_dnn.control.state import BEFORE, LAST, WANTED, Q
from iiwa_dnn.networks.integrators.base import BUDGET, DURATION, TOLERANCE, enter_answer
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Matrix, Status, Vector
from iiwa_dnn.qp.compiling import VECTOR, Signature, borrowed
from iiwa_dnn.qp.layout import compiled, qp_views
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.references import Reference
from iiwa_dnn.references.rotations import set_mean_twist
from iiwa_dnn.schemes.program import StepProgram, Table, assemble, step_views

FEASIBLE_BUDGET = 60.0
"""Linear systems after which a program with acceleration or jerk limits counts as infeasible."""

SAMPLE, WRITE, ANSWER = range(3)
"""Where a control step begins: at the targets, at the program, at the answer."""


class LoopArrays(NamedTuple):
    """Arrays of a control loop that stay the same from step to step.

    Attributes:
        table: Table of the program, a row for the network, a row for each reference.
        constants: Their constants, (k,).
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        dt: Control period [s].
    """

    table: Table
    constants: Vector
    jacobian: Matrix
    placements: Matrix
    dt: float


class ControlStep:
    """A control step laid out for a scheme, references and a network.

    Attributes:
        program: The scheme laid out for the robot.
        layout: Columns of the rows that are written.
        version: Version of the solver's parameters.
        arrays: Arrays that stay the same from step to step.
        has_network: Whether the network is compiled.
        begin: Stage at which the compiled step begins: `SAMPLE` if all references are compiled
            and the whole program is, else a later one.
        run: `control_step`, entered without looking at the types of its arguments again.
    """

    def __init__(
        self,
        program: StepProgram,
        references: Mapping[str, Reference],
        solver: DNNSolver,
        dt: float,
        converged: bool,
    ) -> None:
        """Lay a control step out.

        Args:
            program: The scheme laid out for the robot.
            references: Reference of each tracked frame, or none.
            solver: The network that answers the programs.
            dt: Control period [s].
            converged: Whether the network settles at every step.
        """
        self.program = program
        self.version = solver.version
        status = Status.SOLVED if converged else Status.ADVANCED
        frames = program.target_frames
        self.layout = RowLayout(program.sizes, program.robot.dof, len(frames), status)
        entries: list[list[int]] = []
        constants: list[Vector] = []
        answer = None
        # A subclass that solves in a way of its own is asked, not bypassed.
        if type(solver) is DNNSolver and not program.accelerates:
            answer = solver.compiled_answer(program.sizes, 0.0 if converged else dt)
        self.has_network = answer is not None
        if answer is None:
            entries.append([0, 0, 0, 0, 0, 0])
        else:
            own = answer.constants
            if program.rate_limits is not None:
                # A program that a few systems do not solve most likely has no solution.
                own[BUDGET] = min(own[BUDGET], FEASIBLE_BUDGET)
            entries.append([0, answer.address, answer.rates, 0, 0, own.size])
            constants.append(own)
        ahead = [name in program.ahead for name in frames]
        paths = [references[name] for name in frames if name in references]
        compiled_paths = len(paths) == len(frames) and all(path.compiled for path in paths)
        self.begin = SAMPLE if compiled_paths else WRITE
        if compiled_paths:
            start = sum(array.size for array in constants)
            for path, next_one in zip(paths, ahead, strict=True):
                own = np.concatenate([path.base, path.constants])
                address = PATH.address(path.compiled)
                entries.append([int(next_one), address, 0, 0, start, start + own.size])
                constants.append(own)
                start += own.size
        program.extend(entries, np.concatenate([np.zeros(0), *constants]))
        if not program.is_compiled:
            self.begin = ANSWER
        kinematics = program.kinematics
        self.arrays = LoopArrays(
            program.table, program.constants, kinematics.jacobian, kinematics.placements, dt
        )
        self.run = self._entry()

    def _entry(self) -> Any:
        """Compile the control step for the types of its arguments."""
        if not isinstance(control_step, Dispatcher):
            return control_step
        vector = types.float64[::1]
        matrix = types.float64[:, ::1]
        arguments = (vector, typeof(self.arrays), matrix, matrix, vector)
        return control_step.compile((*arguments, types.float64, types.float64, types.int64))


PATH = Signature(types.void, types.float64, VECTOR, VECTOR)
_enter_path = PATH.enter


@compiled
def control_step(
    row: Vector,
    arrays: LoopArrays,
    past: Matrix,
    following: Matrix,
    state: Vector,
    t: float,
    delay: float,
    begin: int,
) -> bool:
    """Write targets, program and answer of one control step into a row.

    Args:
        row: The row, (width,); what comes before `begin` is in it already.
        arrays: Arrays of the loop.
        past: `ControllerState.past`, (4, dof).
        following: `ControllerState.following`, (4, dof), overwritten.
        state: The network's state, (size,), advanced.
        t: Time [s].
        delay: Time by which the reference's clock is behind [s].
        begin: `SAMPLE`, `WRITE` or `ANSWER`.

    Returns:
        False if the network did not settle or diverged; `state` is then as it was.
    """
    row = borrowed(row)
    past = borrowed(past)
    table = borrowed(arrays.table)
    constants = borrowed(arrays.constants)
    jacobian = borrowed(arrays.jacobian)
    placements = borrowed(arrays.placements)
    n = table[0, 0]
    m = table[0, 1]
    p = table[0, 2]
    dof = table[0, 3]
    network = 1 + table[0, 6]
    views = row_views(row, n, m, p, dof)
    qp = qp_views(views.program, n, m, p)
    if begin == SAMPLE:
        for k in range(network + 1, table.shape[0]):
            own = constants[table[k, 4] : table[k, 5]]
            target = views.targets[k - network - 1]
            _sample(table[k, 1], own, t - delay, target)
            if table[k, 0] != 0:
                then = np.empty(target.size)
                _sample(table[k, 1], own, t - delay + arrays.dt, then)
                set_mean_twist(target, then, arrays.dt)
    if begin <= WRITE:
        clock = (t, 1.0 / arrays.dt)
        step = step_views(
            table,
            constants,
            past,
            jacobian,
            placements,
            views.targets,
            clock,
        )
        assemble(step, table, constants, qp)
    own = constants[table[network, 4] : table[network, 5]]
    address = table[network, 1]
    rates = table[network, 2]
    before = state.copy()
    iterations, time, primal, dual, gap = enter_answer(address, qp, rates, own, state, views.point)
    succeeded = primal + dual + gap < np.inf
    if own[DURATION] == 0.0:
        succeeded = within(primal, dual, gap, own[TOLERANCE])
    if not succeeded:
        for i in range(state.size):
            state[i] = before[i]
        return False
    views.figures[0] = iterations
    views.figures[1] = time
    views.figures[2] = primal
    views.figures[3] = dual
    views.figures[4] = gap
    for i in range(PLACEMENT):
        views.placement[i] = placements[table[0, 7], i]
    for i in range(dof):
        views.q[i] = past[Q, i]
        views.dq[i] = views.point[i]
        following[BEFORE, i] = past[LAST, i]
        following[LAST, i] = views.point[i]
        following[WANTED, i] = past[WANTED, i]
    return True


@compiled
def _sample(address: int, constants: Vector, t: float, target: Vector) -> None:
    """Write the target (18,) of a path at time t [s]; the constants begin with its base."""
    for i in range(target.size):
        target[i] = constants[i]
    _enter_path(address, t, constants[target.size :], target)
