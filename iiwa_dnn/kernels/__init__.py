"""The control step compiled with numba: its program, the network's answer, the robot's motion.

The mathematics stands in `iiwa_dnn.schemes`; programs are laid out as in `iiwa_dnn.qp.layout`.
"""

from __future__ import annotations

from iiwa_dnn.kernels.control import control_step
from iiwa_dnn.kernels.motion import clip_command, move, window_mean
from iiwa_dnn.kernels.program import (
    block_map,
    orientation_rows,
    project_on_range,
    rotation_log,
    velocity_bounds,
    velocity_program,
)

__all__ = [
    "block_map",
    "clip_command",
    "control_step",
    "move",
    "orientation_rows",
    "project_on_range",
    "rotation_log",
    "velocity_bounds",
    "velocity_program",
    "window_mean",
]
