"""Drive a Franka arm (FR3) at 1 kHz through libfranka: a circle, or what a slow policy asks for.

The arm begins where it stands, keeps the maker's limits and comes to rest at the end, and at
Ctrl-C. Requests come as JSON, one a UDP packet: {"dq": [...]}, {"twist": [...]} or
{"position": [...]}, in rad/s, m/s and rad/s, or rad; they pass the shield of `make_shield`, an
exported package. It was tried on franka-sim, a server of the robot's protocol, never on an arm: see
docs/real_arm.md before the first day.
"""

import dataclasses
import gc
import json
import signal
import socket
import sys

import numpy as np
import tyro

import iiwa_dnn

DT = 1e-3
"""Control period of the robot [s]."""

LOST = 5
"""Commands in a row that may come too late without a limit being broken."""

ROUNDING = 1e-5
"""Difference of two velocities that are equal in single precision, as they are sent [rad/s]."""


def with_reserve(robot):
    """Return the robot with limits that also hold if the arm goes on without a command.

    It then keeps its acceleration, and the next command is a jump of the acceleration for it. A
    velocity limit that shrinks towards a position limit shrinks meanwhile.
    """
    lost = LOST * DT  # [s]
    acceleration = 0.75 * robot.ddq_max
    offset, deceleration = robot.position_dependent_velocity
    shrinking = np.where(np.isfinite(deceleration), deceleration, 0.0)
    offset = offset + lost * (acceleration + shrinking)
    robot = dataclasses.replace(robot, position_dependent_velocity=np.array([offset, deceleration]))
    velocity = robot.dq_max - lost * acceleration
    return robot.with_limits(
        velocity=velocity, acceleration=acceleration, jerk=0.24 * robot.dddq_max
    )


def make_controller(q, radius, period):
    """Return a controller for a circle of this radius [m] and period [s] from q (7,) [rad]."""
    robot = with_reserve(iiwa_dnn.load_robot("fr3"))
    limits = (
        iiwa_dnn.AccelerationLimits(),
        iiwa_dnn.JerkLimits(),
        iiwa_dnn.TipSpeedLimit(2.5),  # [m/s]; the robot's own is 3, of the measured motion
    )
    gains = {"position_gain": 100.0, "orientation_gain": 100.0}  # [1/s]
    scheme = iiwa_dnn.DoubleIndicator(**gains, extra_limits=limits)
    circle = iiwa_dnn.Circle(radius, period).anchored(iiwa_dnn.Configuration(robot, q))
    controller = iiwa_dnn.Controller(robot, scheme, circle.feed_forward(DT), dt=DT)
    controller.warm_up(q)
    return controller


def make_shield():
    """Return a shield to export for requests to an FR3."""
    # The robot judges where the arm is; where commands are lost, it is not where they lead.
    robot = with_reserve(iiwa_dnn.load_robot("fr3"))
    shield = iiwa_dnn.Shield(robot, dt=DT, obstacles=[], tracking_error=1e-3)
    shield.limits += (iiwa_dnn.TipSpeedLimit(2.5),)  # [m/s]
    return shield


class Requests:
    """The newest request that came by UDP, at "127.0.0.1:5005" say; "5005" is the same."""

    def __init__(self, address):
        """Listen at an address."""
        self.refused = 0
        place, _, port = address.rpartition(":")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((place or "127.0.0.1", int(port)))
        self._socket.setblocking(False)

    def newest(self):
        """Return the request as an argument of a shield's step; nothing: there is no new one."""
        found = None
        try:
            while True:
                found = self._socket.recv(4096)
        except BlockingIOError:
            pass
        if found is None:
            return {}
        try:
            ((kind, numbers),) = json.loads(found).items()
            size = {"dq": 7, "twist": 6, "position": 7}[kind]
            return {kind: np.array(numbers, dtype=float).reshape(size)}
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            if not self.refused:
                print(f"refused, later ones are counted: {found!r}: {error!r}", file=sys.stderr)
            self.refused += 1
            return {"dq": np.full(7, np.nan)}  # the arm brakes


def main(
    host: tyro.conf.Positional[str],
    duration: float = 10.0,
    radius: float = 0.02,
    period: float = 5.0,
    requests: str = "",
    shield: str = "fr3_shield.json",
):
    """Draw a circle, or follow requests, and come to rest.

    Args:
        host: address of the robot's controller
        duration: length of the motion [s]
        radius: radius of the circle [m]
        period: time of one round [s]
        requests: address and port of requests by UDP, in place of a circle
        shield: tables of the shield that requests pass
    """
    import pylibfranka as franka

    arm = franka.Robot(host, franka.RealtimeConfig.kIgnore)
    q = np.array(arm.read_once().q)
    source = Requests(requests) if requests else None
    if source:
        import armstep

        driver = armstep.Shield(shield)
    else:
        driver = make_controller(q, radius, period)
    ended = []

    def end(*_):
        ended.append(True)
        driver.halt()

    signal.signal(signal.SIGINT, end)
    gc.disable()  # a collection takes many periods
    motion = arm.start_joint_velocity_control(franka.ControllerMode.JointImpedance)
    state, _ = motion.readOnce()
    t = 0.0
    late = 0
    while True:
        if source:
            command = driver.step(np.array(state.q), **source.newest())
        else:
            command = driver.step(np.array(state.q_d), t)
        velocities = franka.JointVelocities(command.dq.tolist())
        velocities.motion_finished = bool(ended) and not command.dq.any()  # at rest
        motion.writeOnce(velocities)
        if velocities.motion_finished:
            break
        state, elapsed = motion.readOnce()
        t += elapsed.to_sec()
        if not (t < duration or ended):  # also where the duration is no number
            end()
        last = np.array(state.dq_d)
        if np.abs(last - command.dq).max() > ROUNDING:  # the arm went on without the command
            driver.send(last - DT * np.array(state.ddq_d))
            driver.send(last)
            late += 1
    refused = f", {source.refused} requests refused" if source else ""
    print(f"{t:.3f} s, {late} commands came too late{refused}")


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
