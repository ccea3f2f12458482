"""A stand-in for pylibfranka whose robot answers at once, loses commands and judges the others.

It judges by the words of libfranka's documentation alone: finite differences of what it was sent or
went on with itself, against the limits of include/franka/rate_limiting.h and of the FR3's URDF.
"""

from types import SimpleNamespace
from typing import Any

import numpy as np

DT = 1e-3
LOWER = np.array([-2.7501, -1.7918, -2.9065, -3.0481, -2.8101, 0.54092, -3.0196])
UPPER = np.array([2.7501, 1.7918, 2.9065, -0.1458, 2.8101, 4.5205, 3.0196])
FASTEST = np.array([2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26])
OFFSET = np.array([0.30, 0.20, 0.20, 0.30, 0.35, 0.35, 0.35])
DECELERATION = np.array([6.0, 2.585, 3.5, 4.0, 17.0, 5.5, 17.0])


class ControlException(RuntimeError):  # noqa: N818
    """An error of libfranka."""


class JointVelocities:
    def __init__(self, dq: list[float]) -> None:
        self.dq = dq
        self.motion_finished = False


class Duration:
    def __init__(self, cycles: int) -> None:
        self.cycles = cycles

    def to_sec(self) -> float:
        return DT * self.cycles


class Arm:
    """A robot at `q` that loses the commands of some cycles, counted from 1.

    Attributes:
        lost: Number of cycles that are lost from a command on, by its number.
        fails: Number of the command at which the robot aborts; None: it does not.
    """

    def __init__(self, q: np.ndarray) -> None:
        self.q = q
        self.dq = np.zeros(7)
        self.ddq = np.zeros(7)
        self.lost: dict[int, int] = {}
        self.fails: int | None = None
        self.finished = False
        self.broken: list[str] = []
        self.count = 0
        self.cycles = 0

    def state(self) -> Any:
        single = np.float32  # as on the wire
        return SimpleNamespace(
            q=self.q.astype(single).astype(float).tolist(),
            q_d=self.q.astype(single).astype(float).tolist(),
            dq_d=self.dq.astype(single).astype(float).tolist(),
            ddq_d=self.ddq.astype(single).astype(float).tolist(),
        )

    def read_once(self) -> Any:
        return self.state()

    def start_joint_velocity_control(self, mode: Any) -> "Arm":
        return self

    def readOnce(self) -> tuple[Any, Duration]:  # noqa: N802
        if self.fails is not None and self.count >= self.fails:
            raise ControlException('libfranka: Move command aborted!\n["test_reflex"]')
        cycles, self.cycles = self.cycles, 0
        return self.state(), Duration(cycles)

    def writeOnce(self, command: JointVelocities) -> None:  # noqa: N802
        self.finished = command.motion_finished
        self.count += 1
        lost = self.lost.get(self.count, 0)
        for _ in range(lost):
            self.step(self.dq + DT * self.ddq)
        if not lost:
            self.step(np.array(command.dq))

    def step(self, dq: np.ndarray) -> None:
        ddq = (dq - self.dq) / DT
        jerk = (ddq - self.ddq) / DT
        up = ramp(UPPER - self.q)
        down = ramp(self.q - LOWER)
        for name, excess in (
            ("velocity", np.maximum(dq - up, -down - dq)),
            ("acceleration", np.abs(ddq) - 10.0),
            ("jerk", np.abs(jerk) - 5000.0),
        ):
            if excess.max() >= 0.0:
                self.broken.append(f"{name} of joint {excess.argmax() + 1} by {excess.max():g}")
        self.q = self.q + DT * dq
        self.dq = dq
        self.ddq = ddq
        self.cycles += 1


def ramp(distance: np.ndarray) -> np.ndarray:
    """Velocity limits at a distance from the position limits, as libfranka computes them."""
    slope = np.sqrt(np.maximum(2.0 * DECELERATION * distance, 0.0))
    return np.minimum(FASTEST, np.maximum(slope - OFFSET, 0.0)) - DT


def module(arm: Arm) -> Any:
    """Make the module for one arm."""
    return SimpleNamespace(
        JointVelocities=JointVelocities,
        Robot=lambda host, realtime: arm,
        RealtimeConfig=SimpleNamespace(kIgnore=1),
        ControllerMode=SimpleNamespace(JointImpedance=0),
    )
