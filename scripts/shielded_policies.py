"""The shield under a learned policy: as a Gymnasium wrapper, and as a step of LeRobot's processors.

Both are to be copied; tests/scripts/test_shielded_policies.py drives them by random policies.
"""

from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np

import iiwa_dnn
from iiwa_dnn.qp import Vector


class ShieldedActions(gymnasium.ActionWrapper[Any, Any, Any]):
    """Actions that are joint velocities [rad/s], made safe.

    Attributes:
        shield: The shield; its `dt` is the environment's.
        clipped: Number of actions that it has changed.
    """

    def __init__(
        self,
        env: gymnasium.Env[Any, Any],
        shield: iiwa_dnn.Shield,
        positions: Callable[[gymnasium.Env[Any, Any]], Vector],
    ) -> None:
        """Wrap an environment; `positions` returns its joint positions [rad], (n,)."""
        super().__init__(env)
        self.shield = shield
        self.clipped = 0
        self._positions = positions

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        """Begin an episode, in which the arm stands."""
        self.shield.reset()
        return super().reset(**options)

    def action(self, action: Vector) -> Vector:
        """Return the safe joint velocity [rad/s], (n,)."""
        command = self.shield.step(self._positions(self.unwrapped), action)
        self.clipped += command.clipped
        return command.dq


class ShieldStep:
    """A step after LeRobot's `RobotActionProcessorStep`: positions by joint name, in degrees.

    In a project with LeRobot derive it from that class, and register it with
    ``@ProcessorStepRegistry.register("shield")``. Keys without a joint, as a gripper's, go through.
    """

    def __init__(self, shield: iiwa_dnn.Shield, names: list[str]) -> None:
        """Take a shield whose `dt` is the control period, and the names of its joints."""
        self.shield = shield
        self.clipped = 0
        self._keys = [f"{name}.pos" for name in names]

    def __call__(self, transition: dict[str, Any]) -> dict[str, Any]:
        """Return a transition with the safe action."""
        changed = dict(transition)
        goal = np.radians([transition["action"][key] for key in self._keys])
        q = np.radians([transition["observation"][key] for key in self._keys])
        command = self.shield.step(q, position=goal)
        self.clipped += command.clipped
        following = np.degrees(command.command.next_q)
        safe = zip(self._keys, following.tolist(), strict=True)
        changed["action"] = transition["action"] | dict(safe)
        return changed

    def reset(self) -> None:
        """Begin an episode, in which the arm stands."""
        self.shield.reset()

    def transform_features(self, features: dict[str, Any]) -> dict[str, Any]:
        """Return the features as they are."""
        return features
