"""A third paper's runs: noise-suppressing neural dynamics on a UR5 beside a dual network.

    python scripts/noise_suppressing.py [duration [their joints as CSV, t and q1 ... q6
                                                   [their recorded postures, q1 ... q6]]]

Both networks as ODEs beside the arm's, as the authors' published programs have them: no feedback of
the tool's position, bounds of 0.5 rad/s, gains of 1e3, constant noise of 5 in both networks' rates.
docs/papers.md has the figures, and what the programs say otherwise than the paper.
"""

import sys
from collections.abc import Callable

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

import iiwa_dnn
from iiwa_dnn.networks import DualNetwork, NoiseSuppressingNetwork

Array = NDArray[np.float64]
Rates = Callable[[float, Array], Array]

START = np.array([0.0, 0.25, 0.0, 0.5, -0.25, 0.0]) * np.pi
"""Joint positions at the start [rad]."""
RECORDED = np.array(
    [
        3.06147011763390,
        4.91919437438584,
        1.15856762876936,
        -1.76838518750552,
        1.865185438670004,
        2.6527,
    ]
)
"""Start of the recorded postures [rad], which the program has as a comment."""
SHIFT = np.array([0.0, 0.5 * np.pi, 0.0, 0.5 * np.pi, 0.0, 0.0])
"""Offset of the recorded postures [rad]."""
LARGER = 10.0 / 3.0
"""Size of the recorded path in units of the program's."""
TABLE = [
    [0.0, 0.5 * np.pi, 0.089459, 0.0],
    [-0.425, 0.0, 0.0, 0.0],
    [-0.39225, 0.0, 0.0, 0.0],
    [0.0, 0.5 * np.pi, 0.10915, 0.0],
    [0.0, -0.5 * np.pi, 0.09465, 0.0],
    [0.0, 0.0, 0.0823, 0.0],
]
"""Denavit-Hartenberg parameters of the UR5: a [m], alpha [rad], d [m], theta [rad]."""
GAIN = 1e3
"""gamma and eta [1/s], and the dual network's gamma."""
NOISE = 5.0
"""Constant noise in the rate of the residual [1/s]."""
STEP = 5e-4
"""Step of the integration [s], half of the networks' time constant."""


def path(t: float) -> Array:
    """Return displacement [m], velocity [m/s] and acceleration [m/s^2] of the target, (3, 3)."""
    slow = 4.0 / 3.0
    a, b, c = 0.012, 0.03, -0.018
    return np.array(
        [
            [a * np.cos(2 * t) + b * np.cos(slow * t), a * np.sin(2 * t) + c * np.sin(slow * t), 0],
            [
                -2 * a * np.sin(2 * t) - slow * b * np.sin(slow * t),
                2 * a * np.cos(2 * t) + slow * c * np.cos(slow * t),
                0.0,
            ],
            [
                -4 * a * np.cos(2 * t) - slow**2 * b * np.cos(slow * t),
                -4 * a * np.sin(2 * t) - slow**2 * c * np.sin(slow * t),
                0.0,
            ],
        ]
    )


class Arm:
    """The UR5's tip, its start posture and the size of its path."""

    def __init__(self, start: Array = START, scale: float = 1.0) -> None:
        """Build the arm from its table."""
        self.start = start
        self.scale = scale
        self.model = iiwa_dnn.robot_from_dh(TABLE, name="ur5").model
        self.data = self.model.createData()
        self.frame = self.model.getFrameId("link_6")

    def position(self, q: Array) -> Array:
        """Return the tip's position [m], (3,)."""
        pin.framesForwardKinematics(self.model, self.data, q)
        return self.data.oMf[self.frame].translation.copy()

    def rows(self, q: Array, dq: Array) -> tuple[Array, Array]:
        """Return the position rows of the Jacobian and their rate, (3, 6) both."""
        pin.computeJointJacobiansTimeVariation(self.model, self.data, q, dq)
        pin.updateFramePlacements(self.model, self.data)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        jacobian = pin.getFrameJacobian(self.model, self.data, self.frame, axes)
        rate = pin.getFrameJacobianTimeVariation(self.model, self.data, self.frame, axes)
        return jacobian[:3].copy(), rate[:3].copy()


def program(arm: Arm, q: Array, dq: Array, t: float) -> tuple[iiwa_dnn.QP, iiwa_dnn.QP]:
    """Return the program of least joint velocity at a time, and its rate [1/s]."""
    jacobian, change = arm.rows(q, dq)
    _, velocity, acceleration = arm.scale * path(t)
    ends = {"lb": np.full(6, -0.5), "ub": np.full(6, 0.5)}
    still = {"lb": np.zeros(6), "ub": np.zeros(6)}
    qp = iiwa_dnn.QP(np.eye(6), np.zeros(6), A=jacobian, b=velocity, **ends)
    return qp, iiwa_dnn.QP(np.zeros((6, 6)), np.zeros(6), A=change, b=acceleration, **still)


def suppressing(arm: Arm, noise: float) -> tuple[Array, Rates]:
    """Return initial state [q | x | y | w | integrals] and rates of arm and network."""
    network = NoiseSuppressingNetwork(rho=1.0, integral=GAIN, proportional=GAIN, noise=noise)

    def rates(t: float, s: Array) -> Array:
        qp, change = program(arm, s[:6], s[6:12], t)
        return np.concatenate([s[6:12], network.flow(qp, change).rates(s[6:])])

    return np.concatenate([arm.start, np.zeros(6), np.full(15, 1e-3), np.zeros(21)]), rates


def dual(arm: Arm, noise: float) -> tuple[Array, Rates]:
    """Return initial state [q | u] and rates of arm and dual network."""
    network = DualNetwork()

    def rates(t: float, s: Array) -> Array:
        qp, _ = program(arm, s[:6], np.zeros(6), t)
        point = np.empty(15)
        network.read(qp, s[6:], point)
        x = np.concatenate([qp.A.T, np.eye(6)], axis=1) @ s[6:]
        return np.concatenate([x, GAIN * network.rates(qp, s[6:]) + noise])

    return np.concatenate([arm.start, np.zeros(9)]), rates


Maker = Callable[[Arm, float], tuple[Array, Rates]]


def run(
    make: Maker, noise: float, duration: float, arm: Arm | None = None
) -> tuple[Array, Array, Array]:
    """Integrate arm and network by RK4; return times [s], joints [rad], errors of the tool [m]."""
    arm = arm or Arm()
    state, rates = make(arm, noise)
    origin = arm.position(arm.start) - arm.scale * path(0.0)[0]
    every = round(0.05 / STEP)
    times = []
    joints = []
    errors = []
    for k in range(round(duration / STEP) + 1):
        t = k * STEP
        if k % every == 0:
            times.append(t)
            joints.append(state[:6])
            wanted = origin + arm.scale * path(t)[0]
            errors.append(np.linalg.norm(arm.position(state[:6]) - wanted))
        first = rates(t, state)
        second = rates(t + 0.5 * STEP, state + 0.5 * STEP * first)
        third = rates(t + 0.5 * STEP, state + 0.5 * STEP * second)
        fourth = rates(t + STEP, state + STEP * third)
        state = state + STEP / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    return np.array(times), np.array(joints), np.array(errors)


def nearest(times: Array, q: Array, postures: Array) -> Array:
    """Return the largest joint difference [rad] of postures (k, n) to the nearest point of a run.

    The run, q (steps, n) [rad] at times (steps,) [s], is interpolated to 50 us.
    """
    path = CubicSpline(times, q)(np.arange(times[0], times[-1], 5e-5))
    return np.array([np.abs(path - posture).max(axis=1).min() for posture in postures])


def main() -> None:
    """Print the tool's errors of both networks, with equal noise and with the programs' own."""
    duration = float(sys.argv[1]) if len(sys.argv) > 1 else 20.0
    cases = [
        ("noise-suppressing, no noise", suppressing, 0.0),
        ("noise-suppressing, noise of 5", suppressing, NOISE),
        ("dual, no noise", dual, 0.0),
        ("dual, noise of 5", dual, NOISE),
        ("dual, noise of 5 times gamma, as in the program", dual, GAIN * NOISE),
    ]
    for name, make, noise in cases:
        times, q, errors = run(make, noise, duration)
        print(f"{name}: largest error {errors.max():.3g} m, at the end {errors[-1]:.3g} m")
        if len(sys.argv) > 2 and make is suppressing and noise:
            theirs = np.loadtxt(sys.argv[2], delimiter=",")
            found = [np.interp(times, theirs[:, 0], joint) for joint in theirs.T[1:7]]
            print(f"  joints beside theirs: {np.abs(q - np.transpose(found)).max():.3g} rad")
    if len(sys.argv) > 3:
        theirs = np.loadtxt(sys.argv[3])[:, :6] - SHIFT
        times, q, errors = run(suppressing, NOISE, duration, Arm(RECORDED, LARGER))
        away = nearest(times, q, theirs)
        print(f"recorded: error {errors.max():.3g} m, joints at most {away.max():.3g} rad away")


if __name__ == "__main__":
    main()
