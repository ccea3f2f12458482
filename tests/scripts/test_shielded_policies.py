"""The shield under random policies, through Gymnasium and in the form of LeRobot's processors."""

from typing import Any

import gymnasium
import numpy as np

import iiwa_dnn
from judge_limits import breaches
from scripts.shielded_policies import ShieldedActions, ShieldStep

ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
Q0 = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])


class Arm(gymnasium.Env):
    """An arm that follows every velocity [rad/s]."""

    action_space = gymnasium.spaces.Box(-5.0, 5.0, (7,), np.float64)
    observation_space = gymnasium.spaces.Box(-np.pi, np.pi, (7,), np.float64)

    def reset(self, **options: Any) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(**options)
        self.q = Q0
        return self.q, {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        self.q = self.q + 0.01 * action
        return self.q, 0.0, False, False, {}


def check(path: list[np.ndarray], dt: float, clipped: int) -> None:
    assert breaches(np.array(path), dt, *ROBOT.limits) == []
    assert clipped > 0
    assert np.ptp(path, axis=0).min() > 0.1  # and they move


def test_random_actions_of_an_environment_break_no_limit() -> None:
    env = ShieldedActions(Arm(), iiwa_dnn.Shield(ROBOT, 0.01, []), lambda env: env.q)
    env.action_space.seed(0)
    path = [env.reset()[0]]
    for _ in range(400):
        path.append(env.step(env.action_space.sample())[0])
    check(path, 0.01, env.clipped)


def test_chunks_that_jump_break_no_limit_and_leave_what_is_no_joint() -> None:
    """Goals at 10 Hz for an arm at 50 Hz."""
    keys = [f"{name}.pos" for name in ROBOT.joint_names]
    step = ShieldStep(iiwa_dnn.Shield(ROBOT, 0.02, []), list(ROBOT.joint_names))
    random = np.random.default_rng(0)
    path = [Q0]
    for k in range(400):
        if k % 5 == 0:
            goal = np.degrees(Q0 + random.uniform(-0.5, 0.5, 7))
        seen = dict(zip(keys, np.degrees(path[-1]), strict=True))
        asked = dict(zip(keys, goal, strict=True)) | {"gripper.pos": 40.0}
        made = step({"observation": seen, "action": asked, "reward": 1.0})
        assert made["action"]["gripper.pos"] == 40.0
        assert made["reward"] == 1.0
        path.append(np.radians([made["action"][key] for key in keys]))
    check(path, 0.02, step.clipped)
