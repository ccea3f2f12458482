"""Chunks of a policy that jump, at 30 Hz, through a shield to a Franka arm: address and seconds.

Half of the goals are near, half are far away; the shield goes on where the arm went without it.
"""

import gc
import sys

import numpy as np
import pylibfranka

import iiwa_dnn
from scripts.franka import DT, ROUNDING, with_room

CHUNK = 33
"""Cycles between two goals."""


def main(host: str, seconds: float) -> None:
    """Follow random goals for so many seconds, and come to rest."""
    arm = pylibfranka.Robot(host, pylibfranka.RealtimeConfig.kIgnore)
    home = np.array(arm.read_once().q)
    robot = with_room(iiwa_dnn.load_robot("fr3"))
    shield = iiwa_dnn.Shield(robot, DT, [], tracking_error=1e-4)
    random = np.random.default_rng(0)
    gc.disable()
    motion = arm.start_joint_velocity_control(pylibfranka.ControllerMode.JointImpedance)
    state, _ = motion.readOnce()
    goal = home
    late = clipped = 0
    for k in range(10**9):
        if k % CHUNK == 0:
            goal = home + random.choice([0.05, 1.0]) * random.uniform(-1.0, 1.0, 7)
        command = shield.step(np.array(state.q_d), position=goal)
        clipped += command.clipped
        velocities = pylibfranka.JointVelocities(command.dq.tolist())
        velocities.motion_finished = k * DT > seconds and not command.dq.any()
        motion.writeOnce(velocities)
        if velocities.motion_finished:
            break
        state, _ = motion.readOnce()
        if k * DT > seconds:
            shield.halt()
        last = np.array(state.dq_d)
        if np.abs(last - command.dq).max() > ROUNDING:
            shield.controller().send(last - DT * np.array(state.ddq_d))
            shield.controller().send(last)
            late += 1
        if k % 10_000 == 0:
            print(f"{k * DT:.0f} s, {clipped} clipped, {late} came too late", flush=True)
    print(f"at rest after {k * DT:.3f} s, {clipped} clipped, {late} commands came too late")


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
