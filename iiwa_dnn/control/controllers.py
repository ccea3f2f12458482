"""Controllers of many arms in one call, for vector environments and fleets."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.arm_layout import ArmLayout
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.many import ManyArms
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix
from iiwa_dnn.qp.layout import IntVector
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes.periods import stated_periods
from iiwa_dnn.schemes.step import TARGET_SIZE
from iiwa_dnn.step.memory import ArmInput, motion_of
from iiwa_dnn.step.requests import Request


class ControllersCommand(NamedTuple):
    """Decisions of one step of N controllers.

    Attributes:
        dq: Joint velocities [rad/s], (N, n).
        next_q: Joint positions at the end of the period [rad], (N, n).
        action: `Action` of each policy, (N,); -1 for an arm that brakes, since its joint positions
            or targets are not finite.
        controllers: The controllers.
    """

    dq: Matrix
    next_q: Matrix
    action: IntVector
    controllers: Controllers

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name the active limits of the last command of arm i."""
        return self.controllers.active_limits(i)


class Controllers(ManyArms):
    """Controllers of N arms of one kind, whose steps are one call.

    Each arm is answered as by a `Controller` whose kinematics are those of the exported C
    (`write_kinematics`), to the last bit, on its own clock of the paths.
    """

    def __init__(
        self, controller: Controller, count: int = 1, *, threads: int | None = None
    ) -> None:
        """Take a controller and a number of arms.

        Args:
            controller: Controller, whose scheme, settings and reference all arms have; a scheme
                without a home takes the robot's start posture.
            count: Number of arms.
            threads: Threads of a step; None: as many as there are processors.

        Raises:
            InvalidInputError: The step of many arms would call a part or network in Python; the
                message names it.
        """
        own = copy.deepcopy(checks.instance("controller", controller, Controller))
        own.reset()
        own.warm_up(own.robot.start_posture())
        self._begin(own, count, threads)

    @property
    def _layout(self) -> ArmLayout:
        return self._made.arm_layout  # type: ignore[no-any-return]

    def step(
        self,
        q: ArrayLike,
        t: float,
        targets: ArrayLike | None = None,
        *,
        people: ArrayLike | Sequence[Any] | None = None,
        obstacles: Mapping[str, Any] | None = None,
        age: float | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> ControllersCommand:
        """Compute the commands for joint positions at a time, and count them as sent.

        Args:
            q: Measured joint positions [rad], (N, n).
            t: Time [s]; each arm's paths are sampled at t less what a policy has slowed them.
            targets: Targets of the k tracked frames of each arm, as `Controller.targets` returns
                them, (N, k, 18), in place of the paths'.
            people: A frame of people, as for `Shields.step`.
            obstacles: Or the place of each body with a speed that was seen, by its name.
            age: Time since they were seen [s]; None: the latency.
            dt: Period for which the commands will be held [s].
            elapsed: Time since the last step [s].

        Raises:
            InvalidInputError: An array has a wrong shape, a period is wrong, or targets are needed
                since the paths are in Python; no arm has then taken a step.
        """
        made = self._made
        measured = checks.array("q", q, (self.count, self.robot.dof))
        stated_periods(self.dt, self.longest_period, dt, elapsed)
        layout = self._layout
        asked: Matrix = np.zeros((self.count, 0, TARGET_SIZE))
        if targets is not None:
            frames = len(layout.step.program.target_frames)
            asked = checks.array("targets", targets, (self.count, frames, TARGET_SIZE))
        elif not layout.step.samples:
            raise InvalidInputError("targets", "are needed: the controller has no compiled path")
        inputs = ArmInput(
            measured.ravel(),
            Request.NONE,
            asked.ravel(),
            dt or 0.0,
            elapsed or 0.0,
            checks.finite("t", t),
        )
        actions = np.full(self.count, Request.NONE, dtype=np.int64)
        with made._lock:
            if "start" not in made._warned:
                made.warn_of_start(Configuration(self.robot, measured[0]), t, targets is None)
            if people is not None or obstacles is not None:
                self._see(people, obstacles, age)
            self._take_steps(inputs, actions)
            arms = layout.state(self._memories)
            dq = motion_of(layout.plan, arms).last.copy()
            return ControllersCommand(dq, arms.positions.copy(), actions, self)
