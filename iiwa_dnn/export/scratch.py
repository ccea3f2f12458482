"""Memory that the kernels of an exported step take for themselves."""

import copy

import numpy as np

from iiwa_dnn.compiling.library import scratch_peak
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.references import Target
from iiwa_dnn.robot.kinematics_kernel import ModelTables, write_kinematics

HOSTILE = 200
"""Steps in which the need is measured."""

MARGIN = 2
"""Factor by which a controller has more."""


def scratch_size(controller: Controller, model: ModelTables) -> int:
    """Return for how many numbers an exported controller has room beside its state.

    What a kernel takes depends on sizes alone. So steps are taken in random postures towards random
    targets, near and out of reach, at which every kernel of a step without a solution is entered.
    """
    twin = copy.copy(controller)
    robot = twin.robot
    program = twin.program
    random = np.random.default_rng(0)
    scratch_peak()
    for k, q in enumerate(robot.draw(random, HOSTILE)):
        kinematics = program.kinematics
        write_kinematics(model, q, kinematics.jacobian, kinematics.placements, kinematics.inertia)
        goals = random.uniform(-1.0, 1.0, (len(program.target_frames), 3)) * random.choice([0.1, 2])
        goals += program.placement[9:]
        targets = {
            name: Target(goal, linear_velocity=random.uniform(-1.0, 1.0, 3))
            for name, goal in zip(program.target_frames, goals, strict=True)
        }
        twin.step(q, k * twin.dt, targets)
    return MARGIN * scratch_peak() // 8
