"""Kernels of the desk alone: a step by kinematics that Pinocchio computed, and loops over arms."""

from __future__ import annotations

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled, released
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import IntVector, copied
from iiwa_dnn.schemes.program import ProgramArrays
from iiwa_dnn.step.arms import finish_arm, step_arm
from iiwa_dnn.step.asking import margin_of, separation_of, torque_of
from iiwa_dnn.step.inputs import begin_step
from iiwa_dnn.step.memory import ArmInput, ArmPlan, arm_state
from iiwa_dnn.step.requests import Request


@compiled
def step_measured(
    plan: ArmPlan,
    memory: Vector,
    next_memory: Vector,
    q: Vector,
    targets: Vector,
    clock: Vector3,
    data: Vector,
    network: Vector,
) -> int:
    """Take a step of a controller whose kinematics at the measured positions are known.

    Args:
        plan: Layout of the step, with the kinematics.
        memory: The arm's memory, (k,).
        next_memory: That after the step, (k,), overwritten.
        q: Measured joint positions [rad], (n,).
        targets: Targets of the tracked frames, (18 frames,); or none: those of the paths.
        clock: The time, and `dt` and `elapsed` of `ArmInput` [s].
        data: The log of the control step, overwritten, (width,).
        network: State of the network, (size,).

    Returns:
        The `Action` that was taken, or `INVALID`.
    """
    t, dt, elapsed = clock
    copied(next_memory, memory)
    inputs = ArmInput(q, Request.NONE, targets, dt, elapsed, t)
    begin_step(plan, next_memory, inputs)
    return finish_step(plan, next_memory, inputs, data, network)


@compiled
def finish_step(
    plan: ArmPlan, memory: Vector, inputs: ArmInput, data: Vector, network: Vector
) -> int:
    """Finish a step (`finish_arm`) by the constants of its program, which stay as they are.

    Args:
        plan: Layout of the step, with the kinematics at the arm's positions.
        memory: The arm's memory after `begin_step`, (k,), overwritten.
        inputs: The inputs of the step.
        data: The log of the control step, overwritten, (width,).
        network: State of the network, (size,), of a controller's solver; empty: that in the memory.

    Returns:
        What `finish_arm` returns.
    """
    arm = arm_state(plan, memory)
    base = plan.step.arrays
    arrays = ProgramArrays(
        base.sizes,
        base.table,
        base.constants.copy(),
        base.jacobian,
        base.placements,
        base.support,
        base.inertia,
        base.tip,
    )
    return finish_arm(plan, arm, inputs, arrays, data, network if network.size > 0 else arm.network)


@released
def write_margins(
    plan: ArmPlan,
    memories: Matrix,
    joint: Vector,
    distance: Vector,
    separation: Vector,
    torque: Vector,
) -> None:
    """Write the `Margin` of each of N arms, whose memories are (N, k), to four arrays (N,)."""
    for k in range(len(memories)):
        joint[k], distance[k] = margin_of(plan, memories[k])
        separation[k], _, _ = separation_of(plan, memories[k])
        torque[k] = torque_of(plan, memories[k])


@released
def step_arms(
    plan: ArmPlan, memories: Matrix, inputs: ArmInput, kinds: IntVector, first: int, last: int
) -> None:
    """Take a step of the arms from number `first` to the one before `last`.

    Args:
        plan: Layout of the step.
        memories: Memories of all N arms, (N, k).
        inputs: Inputs of all arms: the positions (N n,) and requests (N n,) or (N 6,) of one arm
            after those of another; `kind` does not count.
        kinds: `Request` of each arm's new request, (N,); overwritten by what `step_arm` returns.
        first: Number of the first arm.
        last: Number after that of the last arm.
    """
    n = plan.sizes.n
    width = inputs.request.size // len(memories)
    for k in range(first, last):
        q = inputs.q[k * n : (k + 1) * n]
        request = inputs.request[k * width : (k + 1) * width]
        own = ArmInput(q, kinds[k], request, inputs.dt, inputs.elapsed, inputs.t)
        kinds[k] = step_arm(plan, memories[k], own)
