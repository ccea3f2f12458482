"""The shield under a learned policy: as a Gymnasium wrapper, and as a step of LeRobot's processors.

Both are to be copied. ``python scripts/shielded_policies.py`` drives them by random policies, and
prints how many of their actions the shield has changed.
"""

from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np

import iiwa_dnn
from iiwa_dnn.qp import Vector

Q0 = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])


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
        """Return the nearest safe joint velocity [rad/s], (n,)."""
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
        """Return a transition with the nearest safe action."""
        changed = dict(transition)
        goal = np.radians([transition["action"][key] for key in self._keys])
        q = np.radians([transition["observation"][key] for key in self._keys])
        command = self.shield.step(q, position=goal)
        self.clipped += command.clipped
        following = np.degrees(command.command.past[0] + self.shield.dt * command.dq)
        safe = zip(self._keys, following.tolist(), strict=True)
        changed["action"] = transition["action"] | dict(safe)
        return changed

    def reset(self) -> None:
        """Begin an episode, in which the arm stands."""
        self.shield.reset()

    def transform_features(self, features: dict[str, Any]) -> dict[str, Any]:
        """Return the features as they are."""
        return features


class Arm(gymnasium.Env[Vector, Vector]):
    """An arm that follows every velocity [rad/s]."""

    def __init__(self, robot: iiwa_dnn.Robot, dt: float) -> None:
        """Take a robot and its control period [s]."""
        self.dt = dt
        self.q = Q0
        shape = (robot.dof,)
        self.observation_space = gymnasium.spaces.Box(-np.pi, np.pi, shape, np.float64)
        self.action_space = gymnasium.spaces.Box(-5.0, 5.0, shape, np.float64)

    def reset(self, **options: Any) -> tuple[Vector, dict[str, Any]]:
        """Stand at the start."""
        super().reset(**options)
        self.q = Q0
        return self.q, {}

    def step(self, action: Vector) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """Move for one period."""
        self.q = self.q + self.dt * action
        return self.q, 0.0, False, False, {}


def run_gymnasium(robot: iiwa_dnn.Robot, steps: int) -> tuple[list[Vector], int]:
    """Drive the wrapped arm by random actions; return its positions [rad] and actions changed."""
    shield = iiwa_dnn.Shield(robot, 0.01, [])
    arm = ShieldedActions(Arm(robot, 0.01), shield, lambda env: env.get_wrapper_attr("q"))
    arm.action_space.seed(0)
    q, _ = arm.reset()
    path = [q]
    for _ in range(steps):
        q, *_ = arm.step(arm.action_space.sample())
        path.append(q)
    return path, arm.clipped


def run_chunks(robot: iiwa_dnn.Robot, steps: int) -> tuple[list[Vector], int]:
    """Drive an arm at 50 Hz by goals that jump ten times a second, as `run_gymnasium`."""
    names = list(robot.joint_names)
    step = ShieldStep(iiwa_dnn.Shield(robot, 0.02, []), names)
    random = np.random.default_rng(0)
    path = [Q0]
    goal = Q0
    for k in range(steps):
        if k % 5 == 0:
            goal = Q0 + random.uniform(-0.5, 0.5, robot.dof)
        seen = {f"{name}.pos": x for name, x in zip(names, np.degrees(path[-1]), strict=True)}
        asked = {f"{name}.pos": x for name, x in zip(names, np.degrees(goal), strict=True)}
        made = step({"observation": seen, "action": asked | {"gripper.pos": 40.0}})
        path.append(np.radians([made["action"][f"{name}.pos"] for name in names]))
    return path, step.clipped


def main() -> None:
    """Print how many actions the shield has changed."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
    for run in (run_gymnasium, run_chunks):
        path, clipped = run(robot, 500)
        print(f"{run.__name__}: {clipped} of {len(path) - 1} actions changed")


if __name__ == "__main__":
    main()
