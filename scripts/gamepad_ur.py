"""A gamepad drives a UR5's tool through ur_rtde: python scripts/gamepad_ur.py 192.168.1.2.

Left stick: forth and sideways; right stick: up and the turn about the vertical. A gamepad that is
unplugged lets the arm brake; Ctrl-C ends. For pip install ./integrations/armstep_drivers[ur]; its
tests run it against a robot that ur_rtde's documents describe, never an arm.
"""

import math
import os
import struct
import sys
from pathlib import Path

import numpy as np
import tyro

import iiwa_dnn

DT = 8e-3  # [s]
EVENT = struct.Struct("=IhBB")  # https://docs.kernel.org/input/joydev/joystick-api.html
AXIS, FIRST = 0x02, 0x80  # kind of event; bit of the state at the beginning
FULL = 32767.0
DEAD = 0.1  # of a stick
STICKS = (1, 0, 4, 3)  # of x, y, z and the turn, each against its axis
SPEED = np.array([0.25, 0.25, 0.25, 0.5])  # [m/s, rad/s]


class Gamepad:
    """State of a gamepad's sticks, by Linux's joystick interface."""

    def __init__(self, device):
        """Open a device, "/dev/input/js0" say."""
        self._file = os.open(device, os.O_RDONLY | os.O_NONBLOCK)
        self._axes = np.zeros(256)

    def request(self):
        """Return the twist that is asked for; nothing: the gamepad is gone."""
        try:
            while event := os.read(self._file, EVENT.size):
                _, value, kind, number = EVENT.unpack(event)
                if kind & ~FIRST == AXIS:
                    self._axes[number] = value / FULL
            return {}
        except BlockingIOError:
            sticks = -self._axes[list(STICKS)]
            x, y, z, turn = SPEED * np.where(np.abs(sticks) > DEAD, sticks, 0.0)
            return {"twist": [x, y, z, 0.0, 0.0, turn]}
        except OSError:
            return {}


def main(
    host: tyro.conf.Positional[str],
    device: str = "/dev/input/js0",
    shield: str = "ur5_shield.json",
    duration: float = math.inf,
):
    """Drive for so many seconds; the shield's tables are written if they are not there."""
    import armstep
    from armstep_drivers.ur import UR

    if not Path(shield).exists():
        robot = iiwa_dnn.load_robot("ur5").with_limits(acceleration=8.0, jerk=80.0)
        iiwa_dnn.export.tables(iiwa_dnn.Shield(robot, DT, obstacles=[]), shield)
    gamepad = Gamepad(device)
    print(f"ended: {UR(armstep.Shield(shield), host).run(gamepad.request, duration)}")


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
