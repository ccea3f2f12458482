"""``export``: the controller of a run as C99."""

import sys

import numpy as np

from iiwa_dnn.app.command_line import print_lines
from iiwa_dnn.app.folders import claim_folder, save_settings
from iiwa_dnn.app.options import ExportOptions
from iiwa_dnn.app.track import arm, beyond_data_sheet, refuse_set, simulation
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.export import c99

_OUTSIDE = ("filter_window", "motion")
"""Options that change what is around a controller in a run."""


def run(options: ExportOptions) -> int:
    """Write the folder and print what is in it; return 0."""
    for name in _OUTSIDE:
        refuse_set(options, name, "is no part of a controller and is not exported")
    robot, q0 = arm(options)
    robot, scheme, reference, q0 = simulation(options, robot, q0).run.args
    controller = Controller(
        robot, scheme, reference, dt=options.dt, mode=options.mode, policy=options.policy
    )
    folder = claim_folder(options)
    c99(controller, folder, q0)
    save_settings(options, folder)
    if beyond := beyond_data_sheet(options, np.array([robot.q_lower, robot.q_upper])):
        print(beyond, file=sys.stderr)
    lines = (folder / "controller.c").read_text(encoding="utf-8").count("\n")
    print_lines(options, f"written to {folder}: {lines} lines of C; to test them: make -C {folder}")
    return 0
