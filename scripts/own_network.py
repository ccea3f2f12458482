"""A network of one's own: an ODE whose equilibria are the solutions of a quadratic program.

One sees that it draws the same heart as the paper's network. This one is Xia and Wang's saddle flow
with the projection on the bounds, and for each row one multiplier (y of A x = b, z of G x <= h):

    rho dx/dt = -x + proj(x - (P x + q + A^T y + G^T z))
    rho dy/dt = A x - b,    rho dz/dt = -z + max(z + G x - h, 0)
"""

import sys
from dataclasses import dataclass

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.networks.base import Flow

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]


@dataclass(frozen=True)
class SaddleNetwork(iiwa_dnn.Network):
    """The saddle flow with n + p + m states; `rho` [s] is inherited."""

    def flow(self, qp, rate=None):
        _, m, p = qp.sizes
        rows = np.vstack([qp.A, qp.G])
        H = np.block([[qp.P, rows.T], [-rows, np.zeros((p + m, p + m))]])
        c = np.concatenate([qp.q, qp.b, qp.h])
        lower = np.concatenate([qp.lb, np.full(p, -np.inf), np.zeros(m)])
        upper = np.concatenate([qp.ub, np.full(p + m, np.inf)])

        def rates(s):
            return np.clip(s - H @ s - c, lower, upper) - s

        def jacobian(s):  # for the implicit integrator
            aim = s - H @ s - c
            return np.where(((aim > lower) & (aim < upper))[:, None], -H, -np.eye(c.size))

        return Flow(rates, jacobian)


def main(steps: tyro.conf.Positional[int] = 300):
    """Compare both networks over the heart's first steps; 1 where they differ."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, START))
    velocities = []
    for network in (iiwa_dnn.ProjectionNetwork(), SaddleNetwork()):
        solver = iiwa_dnn.DNNSolver(network)
        scheme = iiwa_dnn.DoubleIndicator()
        options = {"dt": 1e-3, "duration": 1e-3 * steps, "solver": solver}
        record = iiwa_dnn.simulate(robot, scheme, heart, START, **options)
        velocities.append(record.dq)
        error = iiwa_dnn.compute_metrics(record)["max_position_error_m"]
        failures = iiwa_dnn.failures(record)
        print(f"{type(network).__name__}: largest error {error:.3e} m, failures {failures}")
    difference = np.abs(velocities[0] - velocities[1]).max()
    print(f"largest difference of the joint velocities {difference:.1e} rad/s")
    return int(difference > 1e-7)


if __name__ == "__main__":
    sys.exit(run_script(main))
