"""A robot of Universal Robots behind ur_rtde's two interfaces, as its documents describe it.

servoJ tracks a goal for a time by an acceleration gain (goal - q - lookahead dq); without a next
goal the arm slows down. A goal that no joint can reach in time is a protective stop, which ends
the program; what is sent once it is released moves the arm at once.
https://www.universal-robots.com/articles/ur/programming/servoj-command
"""

from types import SimpleNamespace

import numpy as np

STEP = 2e-3  # of the controller [s]
FASTEST = 3.5  # joint speed above which it stops [rad/s]


class Robot:
    """The robot, and its clock, which the client's periods make."""

    def __init__(self, q: list[float]) -> None:
        self.q = np.array(q)
        self.dq = np.zeros(6)
        self.t = 0.0
        self.goals: list[list[float]] = []
        self.path: list[np.ndarray] = []
        self.mode = 1
        self.has_program = True
        self.is_silent = False
        self.stamp = 0.0
        self._until = 0.0
        self._period = 0.0

    def modules(self) -> dict[str, SimpleNamespace]:
        """Return ur_rtde's two modules, by their names."""

        def control(host: str, frequency: float) -> "Robot":
            self._period = 1.0 / frequency
            return self

        return {
            "rtde_control": SimpleNamespace(RTDEControlInterface=control),
            "rtde_receive": SimpleNamespace(RTDEReceiveInterface=lambda host: self),
        }

    def initPeriod(self) -> float:  # noqa: N802
        return self.t

    def waitPeriod(self, began: float) -> None:  # noqa: N802
        while self.t < began + self._period - 0.5 * STEP:
            self.t += STEP
            self._move()
            if not self.is_silent:
                self.stamp = self.t
        self.path.append(self.q)

    def _move(self) -> None:
        if self.mode == 1 and self.t <= self._until + 0.5 * STEP:
            goal = np.array(self.goals[-1])
            acceleration = self._gain * (goal - self.q - self._lookahead * self.dq)
        else:
            acceleration = -self.dq / (5.0 * STEP)
        self.dq = self.dq + STEP * acceleration
        self.q = self.q + STEP * self.dq

    def servoJ(  # noqa: N802
        self,
        q: list[float],
        speed: float,
        acceleration: float,
        time: float,
        lookahead_time: float,
        gain: float,
    ) -> bool:
        assert len(q) == 6
        assert 0.03 <= lookahead_time <= 0.2
        assert 100.0 <= gain <= 2000.0
        before = np.array(self.goals[-1]) if self.goals else self.q
        self.goals.append(q)
        self._lookahead, self._gain, self._until = lookahead_time, gain, self.t + time
        if np.abs(np.array(q) - before).max() > FASTEST * time:
            self.stop()
        return self.has_program

    def stop(self) -> None:
        """Stop protectively."""
        self.mode = 3
        self.has_program = False

    def release(self) -> None:
        """Release a protective stop, and send the program again."""
        self.mode = 1
        self.has_program = True
        self.goals.clear()

    def servoStop(self) -> bool:  # noqa: N802
        self._until = -1.0
        return True

    def isProgramRunning(self) -> bool:  # noqa: N802
        return self.has_program

    def getSafetyMode(self) -> int:  # noqa: N802
        return self.mode

    def getTimestamp(self) -> float:  # noqa: N802
        return self.stamp

    def getActualQ(self) -> list[float]:  # noqa: N802
        return self.q.tolist()
