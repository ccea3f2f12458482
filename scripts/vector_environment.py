"""A vector environment of Gymnasium whose actions, joint velocities, pass shields: 64 SO-101s.

`Shielded` wraps any vector environment that has `joints` (N, n) [rad] and resets in the same step.
"""

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorActionWrapper, VectorEnv

import iiwa_dnn

DT = 0.02  # [s]


class Reach(VectorEnv):
    """Arms that move as commanded, in episodes of 4 s."""

    metadata = {"autoreset_mode": AutoresetMode.SAME_STEP}  # noqa: RUF012

    def __init__(self, start, count):
        """Take the posture (n,) [rad] to start from, and the number of arms."""
        self.num_envs = count
        self.start = np.tile(start, (count, 1))
        box = gymnasium.spaces.Box(-np.inf, np.inf, self.start.shape)
        self.observation_space = self.action_space = box

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.joints = self.start.copy()
        self.age = np.random.default_rng(seed).integers(0, 200, self.num_envs)
        return self.joints.copy(), {}

    def step(self, actions):
        self.joints = self.joints + DT * actions
        self.age += 1
        over = self.age >= 200
        self.joints[over] = self.start[over]
        self.age[over] = 0
        return self.joints.copy(), -np.abs(self.joints).max(axis=1), 0 * over, over, {}


class Shielded(VectorActionWrapper):
    """A vector environment whose actions pass shields of its period."""

    def __init__(self, env, shields):
        super().__init__(env)
        self.shields = shields

    def reset(self, **options):
        self.shields.reset()
        return super().reset(**options)

    def actions(self, actions):
        return self.shields.step(self.unwrapped.joints, actions).dq

    def step(self, actions):
        found = super().step(actions)
        self.shields.reset((found[2] | found[3]).astype(bool))  # episodes that have ended
        return found


def make(count):
    """Return the environment."""
    robot = iiwa_dnn.load_robot("so101").with_limits(acceleration=10.0, jerk=200.0)
    return Shielded(Reach(robot.start_posture(), count), iiwa_dnn.Shields(robot, count, dt=DT))


if __name__ == "__main__":
    env = make(64)
    random = np.random.default_rng(0)
    env.reset(seed=0)
    ended = sum(env.step(random.normal(0.0, 10.0, (64, 5)))[3].sum() for _ in range(300))
    print(f"{64 * 300} steps, {ended} episodes")
