"""cbfpy: barriers for joint limits, and for capsules beside spheres."""

import sys

sys.path.pop(0)  # this file has the library's name
import jax
import jax.numpy as jnp
import numpy as np
from cbfpy import CBF, CBFConfig

from benchmarks.hostile.serve import serve, velocity_of

jax.config.update("jax_enable_x64", True)

GAIN = 10.0
"""Rate at which a barrier may be approached [1/s]."""


class Arm(CBFConfig):
    """An arm whose joint velocities are the control input."""

    def __init__(self, setup):
        """Take the arm and the spheres, which stand still."""
        joints, capsules = setup["arm"]["joints"], setup["arm"]["capsules"]
        self.places, self.turns, self.axes = (
            jnp.array([joint[name] for joint in joints]) for name in ("origin", "turn", "axis")
        )
        self.of = [capsule["joint"] for capsule in capsules]
        self.ends = jnp.array([[capsule["a"], capsule["b"]] for capsule in capsules])
        self.radii = np.array([capsule["radius"] for capsule in capsules])
        self.spheres = jnp.array(setup["spheres"]).reshape(-1, 3)
        self.sizes = jnp.array(setup["radii"])
        self.distance = setup["distance"]
        self.lower, self.upper, velocity = setup["limits"][:3]
        n = len(joints)
        super().__init__(n=n, m=n, u_min=-velocity, u_max=velocity, solver_tol=1e-6)

    def f(self, z):
        """Return the drift of the positions."""
        return jnp.zeros_like(z)

    def g(self, z):
        """Return how velocities move the positions."""
        return jnp.eye(z.size)

    def alpha(self, h):
        """Return the least rate of a barrier, less its sign."""
        return GAIN * h

    def h_1(self, z):
        """Return the barriers: distances from the joint limits, and of capsules from spheres."""
        turn, place = jnp.eye(3), jnp.zeros(3)
        placed = []
        for i in range(z.size):
            place = place + turn @ self.places[i]
            x, y, w = self.axes[i]
            cross = jnp.array([[0.0, -w, y], [w, 0.0, -x], [-y, x, 0.0]])
            spin = jnp.eye(3) + jnp.sin(z[i]) * cross + (1.0 - jnp.cos(z[i])) * cross @ cross
            turn = turn @ self.turns[i] @ spin
            placed.append((turn, place))
        rows = [z - self.lower, self.upper - z]
        for k, joint in enumerate(self.of if len(self.spheres) else []):
            turn, place = placed[joint]
            a, b = (place + turn @ end for end in self.ends[k])
            along = b - a
            length = jnp.maximum(along @ along, 1e-12)
            t = jnp.clip((self.spheres - a) @ along / length, 0.0, 1.0)
            gap = jnp.linalg.norm(self.spheres - a - t[:, None] * along, axis=1)
            rows.append(gap - self.radii[k] - self.sizes - self.distance)
        return jnp.concatenate(rows)


def make(setup):
    """Return the filter; the first call, which compiles, is not timed."""
    cbf = CBF.from_config(Arm(setup))
    velocity = setup["limits"][2]
    cbf.safety_filter(jnp.array(setup["arm"]["start"]), jnp.zeros(len(velocity)))

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(velocity_of(request, state, dt)), -velocity, velocity)
        return cbf.safety_filter(jnp.array(state["q"]), jnp.array(dq)).block_until_ready()

    return act


serve(make)
