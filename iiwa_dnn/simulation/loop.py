"""The control loop: read, decide, alter, move."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.qp import Vector
from iiwa_dnn.simulation.motion import Method
from iiwa_dnn.simulation.noise import SignalChain
from iiwa_dnn.simulation.plants import Plant
from iiwa_dnn.step.policies import Action


class Outcome(NamedTuple):
    """Outcome of one step of the loop.

    Attributes:
        commands: The controller's commands, one for each stage of the motion.
        velocity: Velocity that the controller answered, the mean of the stages [rad/s], (n,).
        dq: Velocity that moved the robot [rad/s], (n,).
        q: True joint positions after the step [rad], (n,).
        placement: Placement of the first tracked frame before the step, of the true arm, (12,).
        action: Action in place of the network's answer.
        clipped: 1 for each joint whose command was clipped, (n,); None if no command may be.
        sent: Command to a plant that is not `Plant.exact` [rad/s], (n,); None for an exact one.
        torque: Largest joint torques of the step [N m], (n,); None for a plant without motors.
        ends: Whether the run ends before this step: a policy or the plant stopped it.
    """

    commands: Sequence[Command]
    velocity: Vector
    dq: Vector
    q: Vector
    placement: Vector
    action: Action = Action.NONE
    clipped: NDArray[np.int8] | None = None
    sent: Vector | None = None
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
        fault: Reason for which the plant ended the run; None while it moves.
    """

    def __init__(
        self, controller: Controller, plant: Plant, chain: SignalChain, method: Method, q0: Vector
    ) -> None:
        """Keep the parts of the loop.

        Args:
            controller: The controller.
            plant: The plant, started.
            chain: Noise, filter and estimator between controller and plant.
            method: Method that integrates the motion of a plant that moves as commanded.
            q0: True joint positions at the start [rad], (n,).
        """
        self.controller = controller
        self.plant = plant
        self.q = q0
        self.fault: str | None = None
        self._chain = chain
        self._method = method
        self._misled = chain.misleads or not plant.exact

    def run(self, first: int, steps: int, observe: Observer) -> int:
        """Take `steps` steps from number `first`, or until one ends the run; return how many."""
        for k in range(first, first + steps):
            outcome = self.step(k)
            observe(k, outcome)
            if outcome.ends:
                return k - first + 1
        return steps

    def step(self, k: int) -> Outcome:
        """Take step k, from time k dt to (k + 1) dt."""
        controller = self.controller
        t = k * controller.dt
        seen = self._chain.see(k, self.plant.read())
        clipped = None
        if self._chain.alters or self._method.stages > 1:
            commands, velocity, action = self._ask(seen, t)
            dq = velocity
            if self._chain.alters:
                dq, clipped = self._alter(k, t, commands[0], velocity)
            dq = dq * controller.is_clear(self.q, dq)
            controller.send(dq, commands[0].fraction)
        else:
            commands = [controller.step(seen, t)]
            velocity = commands[0].dq
            action = commands[0].action
            dq = velocity
        placement = controller.placement(self.q) if self._misled else commands[0].log.placement
        sent = None if self.plant.exact else dq
        return self._move(
            dq, Outcome(commands, velocity, dq, self.q, placement, action, clipped, sent)
        )

    def _ask(self, q: Vector, t: float) -> tuple[list[Command], Vector, Action]:
        """Compute the commands of all stages of a step; return them, their mean, and the action.

        If one of them has no solution, the mean is the first stage's command: an Euler step.
        """
        commands: list[Command] = []

        def velocity(q: Vector, time: float) -> Vector:
            command = self.controller.compute(q, time)
            commands.append(command)
            return command.dq

        mean = self._method.step(velocity, q, t, self.controller.dt)
        if all(command.action is Action.NONE for command in commands):
            return commands, mean, Action.NONE
        first = commands[0]
        return [first] * len(commands), first.dq, first.action or Action.EULER

    def _alter(
        self, k: int, t: float, command: Command, velocity: Vector
    ) -> tuple[Vector, NDArray[np.int8]]:
        """Add noise to a velocity, filter and clip it; return it, and which joints were clipped."""
        qp = command.limits
        if self._misled:
            qp = self.controller.program_at(self.q, command.targets, t)
        return self._chain.act(k, velocity, qp, self.controller)

    def _move(self, dq: Vector, planned: Outcome) -> Outcome:
        """Move the plant by a command (n,) [rad/s]; end the run if a policy has stopped the arm."""
        command = planned.commands[0]
        if planned.action is Action.STOP:
            self.controller.halt()
            if not command.dq.any():
                return planned._replace(dq=np.zeros_like(dq), ends=True)
        moved = self.plant.move(dq)
        self.fault = moved.fault
        if moved.fault is not None:
            return planned._replace(dq=np.zeros_like(dq), torque=moved.torque, ends=True)
        if not self.plant.exact:  # of an arm with mass the mean velocity of the period
            dq = (moved.q - self.q) / self.controller.dt
        self.q = moved.q
        return planned._replace(dq=dq, q=moved.q, torque=moved.torque)
