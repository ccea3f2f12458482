r"""A published network, added from outside: an arm with three faulty joints draws a tricuspid.

One sees that the joints stay inside their bounds, three of which leave them no room, and that the
tool comes to the path at the rate of the feedback. The network is a zeroing network with prescribed
performance; its own test carries the published recurrences out beside it.

Bounds :math:`lb < x < ub` and a funnel :math:`|A x - b| < r(t) = r_0 e^{-d t} + r_\infty` become
logit transforms, :math:`\chi(v) = \ln\frac{v - lo}{hi - v}`. The program's own cost takes no part:

.. math::

    \min_x \tfrac12\|\chi(x)\|^2 \quad\text{s.t.}\quad \tfrac12\chi(A x - b)_j^2 = 0, \qquad
    \rho\,\dot s = -H^{+}\,(\nabla L + \rho\,\partial_t \nabla L), \quad s = [x; \lambda],

with :math:`\nabla L` the gradient of the Lagrangian and H its derivative in s. The constraint's
gradient vanishes where it holds, so H loses rank exactly at the solution.

Source: R. Singh, J. Keshavan, "A provably constrained neural control architecture with prescribed
performance for fault-tolerant redundant manipulators", IEEE Access 10 (2022).
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pinocchio as pin
import tyro

from iiwa_dnn import checks, load_robot
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.tracking import FIFD, TrackingSolver
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.simulation import count_steps

START = np.array([-0.2578, 0.2946, 0.5946, -0.9896, 0.4993, 0.3100, 0.8620])
FASTEST = 3.6 * np.array([1e-4, 0.1, 0.1, 0.1, 1e-4, 1e-4, 0.1])
DT = 1e-3
GAIN = 2.0
GAMMA = 100.0
DECAY = 100.0
R0 = 2.0
R_INF = 0.005
DEVIATION = np.array([-0.04, 0.035, 0.025])


class _Barrier(NamedTuple):
    """Half the squared logit, its first two derivatives, and the rates of the first two."""

    value: Vector
    slope: Vector
    curvature: Vector
    value_rate: Vector
    slope_rate: Vector


def _barrier(
    v: Vector, low: Vector, high: Vector, v_rate: Vector, low_rate: Vector, high_rate: Vector
) -> _Barrier:
    width = high - low
    width_rate = high_rate - low_rate
    share = (v - low) / width
    spread = share * (1.0 - share)
    chi = np.log(share / (1.0 - share))
    bent = (1.0 + (2.0 * share - 1.0) * chi) / spread**2
    share_rate = (width * (v_rate - low_rate) - width_rate * (v - low)) / width**2
    slope = chi / spread
    return _Barrier(
        0.5 * chi**2,
        slope / width,
        bent / width**2,
        slope * share_rate,
        bent * share_rate / width - slope * width_rate / width**2,
    )


@dataclass(frozen=True)
class BarrierNetwork(Network):
    """The network for bounds and equality rows, with n + p states and a clock.

    Attributes:
        rho: Time constant [s]; the source's gain gamma is 1 / rho.
        start: r_0, half the width that the funnel loses, in the unit of the rows.
        end: r_inf, half its width in the end.
        decay: d [1/s].
    """

    rho: float = 0.01
    start: float = 2.0
    end: float = 0.005
    decay: float = 100.0

    def __post_init__(self) -> None:
        """Check the parameters; raises InvalidInputError naming the one that is wrong."""
        super().__post_init__()
        for name in ("start", "end", "decay"):
            checks.positive(name, getattr(self, name))

    def state_size(self, qp: QP) -> int:
        """Count the states; inequality rows take no part."""
        return qp.q.size + qp.b.size + 1

    def initial_state(self, qp: QP) -> Vector:
        """Make the source's start, (state_size,): x zero, the multipliers one."""
        n = qp.q.size
        p = qp.b.size
        return np.concatenate([np.zeros(n), np.ones(p), [0.0]])

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set a program and its rate of change [1/rho] up; its multipliers are no KKT ones."""
        n, m, p = qp.sizes
        if rate is None:
            rate = QP.from_data(np.zeros(qp.data.size), qp.sizes)

        def rates(s: Vector) -> Vector:
            x = s[:n]
            multipliers = s[n : n + p]
            loss = self.start * np.exp(-self.decay * self.rho * s[-1])
            edge = np.full(p, loss + self.end)
            closing = np.full(p, -self.rho * self.decay * loss)
            still = np.zeros(n)
            inside = _barrier(x, qp.lb, qp.ub, still, rate.lb, rate.ub)
            error = qp.A @ x - qp.b
            error_rate = rate.A @ x - rate.b
            task = _barrier(error, -edge, edge, error_rate, -closing, closing)
            rows = task.slope[:, None] * qp.A
            hessian = np.diag(inside.curvature) + qp.A.T @ (
                (multipliers * task.curvature)[:, None] * qp.A
            )
            matrix = np.block([[hessian, rows.T], [rows, np.zeros((p, p))]])
            moved = task.slope_rate[:, None] * qp.A + task.slope[:, None] * rate.A
            wanted = np.concatenate(
                [
                    inside.slope + rows.T @ multipliers + inside.slope_rate + moved.T @ multipliers,
                    task.value + task.value_rate,
                ]
            )
            return np.append(-np.linalg.pinv(matrix) @ wanted, 1.0)

        return Flow(rates, unknowns=lambda s: np.concatenate([s[:n], np.zeros(p + m)]))


def path(t: float) -> np.ndarray:
    """Displacement, velocity and acceleration (3, 3) of the tilted tricuspid."""
    c = 0.03
    w = 0.2 * np.pi
    tilt = np.pi / 6
    plane = c * np.array(
        [
            [np.cos(2 * w * t) + 2 * np.cos(w * t) - 3, np.sin(2 * w * t) - 2 * np.sin(w * t)],
            [
                -2 * w * (np.sin(2 * w * t) + np.sin(w * t)),
                2 * w * (np.cos(2 * w * t) - np.cos(w * t)),
            ],
            [
                -2 * w**2 * (2 * np.cos(2 * w * t) + np.cos(w * t)),
                -2 * w**2 * (2 * np.sin(2 * w * t) - np.sin(w * t)),
            ],
        ]
    )
    return np.column_stack([plane[:, 0], np.cos(tilt) * plane[:, 1], np.sin(tilt) * plane[:, 1]])


def iiwa14() -> pin.Model:
    """The iiwa 7's model with the script's lengths."""
    model = pin.Model(load_robot("iiwa7").model)
    for i, z in enumerate([0.0, 0.36, 0.0, 0.42, 0.0, 0.4, 0.0]):
        place = model.jointPlacements[i + 1]
        place.translation = np.array([0.0, 0.0, z])
        model.jointPlacements[i + 1] = place
    tip = load_robot("iiwa7").tip_id
    model.frames[tip].placement = pin.SE3(np.eye(3), np.array([0.0, 0.0, 0.126]))
    return model


def by_network(steps: int) -> tuple[np.ndarray, np.ndarray]:
    """The same by `BarrierNetwork`, the formula of the package and Pinocchio's kinematics."""
    model = iiwa14()
    tip = load_robot("iiwa7").tip_id
    data = model.createData()
    # The script takes three Euler steps before the formula: one state more that counts nothing.
    formula = FIFD._replace(past=(*FIFD.past, 0.0))
    solver = TrackingSolver(BarrierNetwork(1 / GAMMA, R0, R_INF, DECAY), formula=formula)
    th = [START]
    states = []
    errors = []
    home = None
    wanted = None
    for i in range(steps):
        pin.computeJointJacobians(model, data, th[i])
        pin.updateFramePlacement(model, data, tip)
        J = pin.getFrameJacobian(model, data, tip, pin.LOCAL_WORLD_ALIGNED)[:3]
        r_a = data.oMf[tip].translation.copy()
        if home is None or wanted is None:
            home = wanted = r_a + DEVIATION
        shift, v_d, a_d = path(i * DT)
        qp = QP(
            np.zeros((7, 7)),
            np.zeros(7),
            A=J,
            b=v_d - GAIN * (r_a - wanted),
            lb=-FASTEST,
            ub=FASTEST,
        )
        solver.advance(qp, DT)
        x = solver.state[:7]
        pin.computeJointJacobiansTimeVariation(model, data, th[i], x)
        rate = QP.from_data(np.zeros(qp.data.size), qp.sizes)
        rate.A[:] = pin.getFrameJacobianTimeVariation(model, data, tip, pin.LOCAL_WORLD_ALIGNED)[:3]
        rate.b[:] = a_d - GAIN * (J @ x - v_d)
        solver.predict(rate.data)
        states.append(solver.state[:-1])
        errors.append(r_a - wanted)
        wanted = home + shift
        if i < 3:
            th.append(th[i] + DT * x)
        else:
            th.append(1.6 * DT * x + 0.6 * th[i] + 0.2 * th[i - 1] + 0.2 * th[i - 2])
    return np.array(states), np.array(errors)


def main(seconds: tyro.conf.Positional[float] = 10.0) -> None:
    """Run the arm and print what it does."""
    states, errors = by_network(count_steps(None, DT, seconds))
    shares = np.abs(states[:, :7] / FASTEST).max(axis=0)
    print("largest velocities, as shares of their bounds:", *shares.round(3))
    print(
        f"tool's distance from the path: {np.linalg.norm(errors[0]):.2e} m at first, "
        f"{np.linalg.norm(errors[-1]):.2e} m at the end"
    )


if __name__ == "__main__":
    sys.exit(run_script(main))
