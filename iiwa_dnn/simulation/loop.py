"""The control loop: read, decide, alter, move. Whoever wants to know observes its outcomes."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
from iiwa_dnn.qp import Vector
from iiwa_dnn.simulation.chain import SignalChain
from iiwa_dnn.simulation.motion import MOTIONS, Motion
from iiwa_dnn.simulation.plants.base import Plant


class Outcome(NamedTuple):
    """One step of the loop.

    Attributes:
        commands: The controller's commands, one for each stage of the motion.
        velocity: Velocity that the controller answered, the mean of the stages [rad/s], (n,).
        dq: Velocity that moved the robot [rad/s], (n,).
        q: True joint positions after the step [rad], (n,).
        action: Action in place of the network's answer.
        clipped: 1 for each joint whose command was clipped, (n,); None if no command may be.
        torque: Largest joint torques of the step [N m], (n,); None for a plant without motors.
        ends: Whether the run ends before this step: a policy or the plant stopped it.
    """

    commands: Sequence[Command]
    velocity: Vector
    dq: Vector
    q: Vector
    action: Action = Action.NONE
    clipped: NDArray[np.int8] | None = None
    torque: Vector | None = None
    ends: bool = False


Observer = Callable[[int, Outcome], object]


class Loop:
    """A controller and the plant that it moves, one control period after the other.

    Step k: the joints are read, the controller answers at that reading and time k dt (and at the
    stages between), noise and filter act on the velocity, and the plant follows the result for dt.
    An altered command is clipped to the limits at the true joint positions, as by a drive that
    watches its own limits. At a step without a solution a policy decides; it is an Euler step,
    whatever the motion.

    Attributes:
        controller: The controller.
        plant: The plant, started.
        q: True joint positions [rad], (n,).
    """

    def __init__(
        self,
        controller: Controller,
        plant: Plant,
        motion: Motion = "euler",
        chain: SignalChain | None = None,
    ) -> None:
        """Bring the parts together; the plant begins where it is.

        Args:
            controller: The controller.
            plant: The plant, started.
            motion: Method that integrates the motion of a plant that moves as it is told.
            chain: Noise and filters between controller and plant; None: none.
        """
        self.controller = controller
        self.plant = plant
        self.q = plant.q
        self._motion = MOTIONS[motion]
        self._chain = chain
        self._yielded = False  # the last step was a policy's
        self._alters = chain is not None and chain.alters
        self._plain = motion == "euler" and not self._alters
        self._misled = not plant.exact or (chain is not None and chain.misleads)

    def run(self, steps: int, observers: Sequence[Observer], first: int = 0) -> int:
        """Take steps until one of them ends the run; return how many were taken."""
        for k in range(first, first + steps):
            outcome = self.step(k)
            for observe in observers:
                observe(k, outcome)
            if outcome.ends:
                return k - first + 1
        return steps

    def step(self, k: int) -> Outcome:
        """Take step k."""
        controller = self.controller
        plant = self.plant
        t = k * controller.dt
        seen = self.q
        if self._misled:
            reading = plant.read()
            seen = reading if self._chain is None else self._chain.see(k, reading)
        if not self._plain:
            return self._general_step(k, t, seen)
        command = controller.step(seen, t)
        dq = command.dq
        if self._misled:
            self._show_true_pose(command)
        self._yielded = command.action is not Action.NONE
        if self._yielded or not plant.exact:
            return self._moved((command,), dq, dq)
        plant.move(dq)
        self.q = plant.q
        return Outcome((command,), dq, dq, self.q)

    def _general_step(self, k: int, t: float, seen: Vector) -> Outcome:
        """Take a step of several stages, or with an altered command."""
        controller = self.controller
        dt = controller.dt
        commands: list[Command] = []

        def ask(q: Vector, time: float) -> Vector:
            command = controller.compute(q, time)
            commands.append(command)
            return command.dq

        velocity = self._motion.step(ask, seen, t, dt)
        if self._misled:
            self._show_true_pose(commands[0])
        self._yielded = any(command.action is not Action.NONE for command in commands)
        if self._yielded:
            # If only a later stage has no solution, the answer at its start will do.
            commands = [commands[0]] * len(commands)
            velocity = commands[0].dq
        command, clipped = self._altered(k, t, commands[0], velocity)
        controller.send(command, commands[0].fraction)
        return self._moved(commands, velocity, command)._replace(clipped=clipped)

    def _altered(
        self, k: int, t: float, command: Command, velocity: Vector
    ) -> tuple[Vector, NDArray[np.int8] | None]:
        """Return a velocity after noise and filters, and the joints that were clipped."""
        if not self._alters or self._chain is None:
            return velocity, None
        qp = command.qp
        if self._misled:
            qp = self.controller.program_at(self.q, command.targets, t)
        return self._chain.act(k, velocity, qp, self.controller)

    def _moved(
        self,
        commands: Sequence[Command],
        velocity: Vector,
        dq: Vector,
    ) -> Outcome:
        """Let the plant follow a command, unless a policy has stopped the run."""
        action = Action.NONE
        if self._yielded:
            action = commands[0].action or Action.EULER
        torque = None
        ends = False
        before = self.q
        if action is Action.STOP:
            self.controller.halt(commands[0])
            ends = not commands[0].dq.any()
        if not ends:
            self.plant.move(dq)
            self.q = self.plant.q
            torque = self.plant.torque
            ends = self.plant.fault is not None
            # Of an arm with mass the mean velocity of the period.
            dq = dq if self.plant.exact else (self.q - before) / self.controller.dt
        if ends:
            dq = np.zeros_like(dq)
            self.q = before
        return Outcome(
            commands,
            velocity,
            dq,
            self.q,
            action,
            torque=torque,
            ends=ends,
        )

    def _show_true_pose(self, command: Command) -> None:
        """Put the frame's true placement into the row of a command that was misled."""
        command.placement[:] = self.controller.placement(self.q)
