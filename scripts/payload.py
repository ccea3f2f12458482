"""An FR3 that may hold 0 to 2 kg: torques within the motors' at every step and until it rests.

Hostile requests, with the payload stated and not. The torques are Pinocchio's inverse dynamics with
the payload in the hand, as fractions of the limits in the URDF.
"""

import numpy as np
import pinocchio as pin

import iiwa_dnn

DT = 1e-3  # [s]
MASS = 2.0  # [kg]
CENTER = np.array([0.0, 0.0, 0.15])  # in the frame of the flange [m]


def run(steps, is_limited):
    """Return the largest torque of a run as a fraction of its limit, and the path (N, n) [rad]."""
    robot = iiwa_dnn.load_robot("fr3")
    held = robot.with_payload((0.0, MASS), CENTER) if is_limited else robot
    shield = iiwa_dnn.Shield(held, DT)  # with the torque limits of an arm that has a payload
    model = robot.model.copy()
    flange = model.frames[robot.tip_id]
    point = pin.Inertia(MASS, flange.placement.act(CENTER), np.zeros((3, 3)))
    model.appendBodyToJoint(flange.parentJoint, point, pin.SE3.Identity())
    data = model.createData()
    random = np.random.default_rng(0)
    q = robot.start_posture()
    path, largest, last = [q], 0.0, np.zeros(robot.dof)
    for k in range(steps):
        if k % 300 == 0:
            request = 3.0 * random.normal(size=robot.dof)
        dq = shield.step(q, request).dq
        torque = pin.rnea(model, data, q, last, (dq - last) / DT)
        largest = max(largest, np.abs(torque / model.effortLimit).max())
        q, last = q + DT * dq, dq  # here the drives take dq
        path.append(q)
    return largest, np.array(path)


if __name__ == "__main__":
    for is_limited in (False, True):
        largest, _ = run(6000, is_limited)
        print(f"payload stated {is_limited}: at most {largest:.3f} of the torque limits")
