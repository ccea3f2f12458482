"""Draw a circle with a Franka arm (FR3): joint velocities at 1 kHz through libfranka.

The arm begins where it stands, keeps the maker's limits and comes to rest at the end, and at
Ctrl-C. It was tried on franka-sim, a server of the robot's protocol, never on an arm: see
docs/real_arm.md before the first day.
"""

import gc
import signal
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

    It then keeps its acceleration, and the next command is a jump of the acceleration for it.
    """
    acceleration = 0.75 * robot.ddq_max
    velocity = robot.dq_max - LOST * DT * acceleration
    return robot.with_limits(
        velocity=velocity, acceleration=acceleration, jerk=0.24 * robot.dddq_max
    )


def make_controller(robot, q, radius, period):
    """Return a controller for a circle of this radius [m] and period [s] from q (7,) [rad]."""
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


def main(
    host: tyro.conf.Positional[str],
    duration: float = 10.0,
    radius: float = 0.02,
    period: float = 5.0,
):
    """Draw a circle and come to rest.

    Args:
        host: address of the robot's controller
        duration: length of the motion [s]
        radius: radius of the circle [m]
        period: time of one round [s]
    """
    import pylibfranka as franka

    arm = franka.Robot(host, franka.RealtimeConfig.kIgnore)
    q = np.array(arm.read_once().q)
    controller = make_controller(with_reserve(iiwa_dnn.load_robot("fr3")), q, radius, period)
    signal.signal(signal.SIGINT, lambda *_: controller.halt())
    gc.disable()  # a collection takes many periods
    motion = arm.start_joint_velocity_control(franka.ControllerMode.JointImpedance)
    state, _ = motion.readOnce()
    t = 0.0
    late = 0
    while True:
        command = controller.step(np.array(state.q_d), t)
        velocities = franka.JointVelocities(command.dq.tolist())
        velocities.motion_finished = t > 0.0 and not command.dq.any()  # at rest
        motion.writeOnce(velocities)
        if velocities.motion_finished:
            break
        state, elapsed = motion.readOnce()
        t += elapsed.to_sec()
        if t >= duration:
            controller.halt()
        last = np.array(state.dq_d)
        if np.abs(last - command.dq).max() > ROUNDING:  # the arm went on without the command
            controller.send(last - DT * np.array(state.ddq_d))
            controller.send(last)
            late += 1
    print(f"{t:.3f} s, {late} commands came too late")


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
