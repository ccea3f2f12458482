"""cbfpy's filter of joint velocities: barriers for joint limits, and for capsules beside spheres.

It answers lines ``{"q": [...], "dq": [...]}`` on standard input; the first argument is the scene.
"""

import json
import os
import sys
import time
from typing import Any

import jax
import jax.numpy as jnp
from cbfpy import CBF, CBFConfig

jax.config.update("jax_enable_x64", True)


class Arm(CBFConfig):
    """An arm whose joint velocities are the control input."""

    def __init__(self, scene: dict[str, Any]) -> None:
        """Take the scene."""
        self.scene = {name: jnp.array(value) for name, value in scene.items()}
        self.joints = scene["joints"]  # of the capsules
        n = len(scene["velocity"])
        fastest = self.scene["velocity"]
        super().__init__(n=n, m=n, u_min=-fastest, u_max=fastest, solver_tol=1e-6)

    def f(self, z: jax.Array) -> jax.Array:
        """Return the drift of the positions."""
        return jnp.zeros_like(z)

    def g(self, z: jax.Array) -> jax.Array:
        """Return how velocities move the positions."""
        return jnp.eye(z.size)

    def alpha(self, h: jax.Array) -> jax.Array:
        """Return the least rate of a barrier, less its sign."""
        return 10.0 * h

    def h_1(self, z: jax.Array) -> jax.Array:
        """Return the barriers: distances from the joint limits, and of capsules from spheres."""
        scene = self.scene
        turn, place = jnp.eye(3), jnp.zeros(3)
        placed = []
        for i in range(z.size):
            place = place + turn @ scene["places"][i]
            x, y, w = scene["axes"][i]
            cross = jnp.array([[0.0, -w, y], [w, 0.0, -x], [-y, x, 0.0]])
            spin = jnp.eye(3) + jnp.sin(z[i]) * cross + (1.0 - jnp.cos(z[i])) * cross @ cross
            turn = turn @ scene["turns"][i] @ spin
            placed.append((turn, place))
        rows = [z - scene["lower"], scene["upper"] - z]
        for k, joint in enumerate(self.joints):
            turn, place = placed[joint - 1]
            a, b = place + turn @ scene["a"][k], place + turn @ scene["b"][k]
            along = b - a
            length = jnp.maximum(along @ along, 1e-12)
            t = jnp.clip((scene["balls"] - a) @ along / length, 0.0, 1.0)
            gap = jnp.linalg.norm(scene["balls"] - a - t[:, None] * along, axis=1)
            rows.append(gap - scene["radii"][k] - scene["distance"])
        return jnp.concatenate(rows)


if __name__ == "__main__":
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    cbf = CBF.from_config(Arm(json.loads(sys.argv[1])))
    for line in sys.stdin:
        asked = json.loads(line)
        q, dq = jnp.array(asked["q"]), jnp.array(asked["dq"])
        began = time.perf_counter()
        answer = cbf.safety_filter(q, dq).block_until_ready()
        seconds = time.perf_counter() - began
        print(json.dumps({"dq": answer.tolist(), "seconds": seconds}), file=answers, flush=True)
