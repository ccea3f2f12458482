"""Steps of robot arms within limits: joint velocities of shields and controllers.

An arm is a file of tables, which iiwa_dnn writes; this
package needs numpy alone.

    from armstep import Shield
    shield = Shield("panda.json")
    command = shield.step(q, dq)  # rad, rad/s; or twist=, position=
    command.dq, command.active_limits
"""

from armstep.arms import Decision, Decisions
from armstep.controller import Action, Command, Controller, Controllers, Program, make_target
from armstep.drive import Channel, Drive, Joints
from armstep.errors import ArmstepError, InputError, LibraryError, TablesError
from armstep.recorder import Recorded, recorded
from armstep.shield import Margin, Reason, Shield, ShieldCommand, Shields
from armstep.tables import Tables, load_tables

__all__ = [
    "Action",
    "ArmstepError",
    "Channel",
    "Command",
    "Controller",
    "Controllers",
    "Decision",
    "Decisions",
    "Drive",
    "InputError",
    "Joints",
    "LibraryError",
    "Margin",
    "Program",
    "Reason",
    "Recorded",
    "Shield",
    "ShieldCommand",
    "Shields",
    "Tables",
    "TablesError",
    "load_tables",
    "make_target",
    "recorded",
]
