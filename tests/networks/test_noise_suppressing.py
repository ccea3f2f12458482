"""The noise-suppressing network beside the equations of its authors' program, and its promise."""

import numpy as np

from iiwa_dnn import QP
from iiwa_dnn.networks import NoiseSuppressingNetwork
from iiwa_dnn.networks.kkt_residual import EPSILON

GAMMA, ETA = 30.0, 20.0


def programs_rates(qp: QP, rate: QP, state: np.ndarray) -> np.ndarray:
    """Equation (12) with M, N, H of (11), block by block, as the authors' program has it."""
    n, p, k = 4, 2, 8
    x, y, mu = np.split(state[: n + p + k], [n, n + p])
    summed = state[n + p + k :]
    C, ends = np.vstack([np.eye(n), -np.eye(n)]), np.concatenate([qp.ub, -qp.lb])
    slack = ends - C @ x
    root = np.sqrt(slack**2 + mu**2 + EPSILON**2)
    first, second = np.diag(slack / root), np.diag(mu / root)
    one, none = np.eye(k), np.zeros
    M = np.block([
        [qp.P, qp.A.T, C.T],
        [qp.A, none((p, p)), none((p, k))],
        [(first - one) @ C, none((k, p)), one - second],
    ])  # fmt: skip
    N = np.block([
        [rate.P, rate.A.T, none((n, k))],
        [rate.A, none((p, p + k))],
        [none((k, n + p + k))],
    ])  # fmt: skip
    error = np.concatenate([
        qp.P @ x + qp.q + qp.A.T @ y + C.T @ mu, qp.A @ x - qp.b, slack + mu - root
    ])  # fmt: skip
    moved = N @ state[: n + p + k] + np.concatenate([rate.q, -rate.b, none(k)])
    wanted = -moved - ETA * np.clip(error, -1.0, 1.0)
    wanted += -GAMMA * np.clip(error + ETA * np.clip(summed, -1.0, 1.0), -1.0, 1.0)
    return np.concatenate([np.linalg.solve(M, wanted), error])


def test_rates_are_those_of_the_authors_equations() -> None:
    rng = np.random.default_rng(0)
    network = NoiseSuppressingNetwork(rho=1.0, integral=GAMMA, proportional=ETA)
    for _ in range(20):
        qp, rate = (
            QP(np.diag(P), rng.standard_normal(4), None, None,
               rng.standard_normal((2, 4)), rng.standard_normal(2), lb, ub)
            for P, lb, ub in (
                (rng.uniform(0.5, 2.0, 4), -rng.uniform(0.5, 1.0, 4), rng.uniform(0.5, 1.0, 4)),
                (rng.standard_normal(4), np.zeros(4), np.zeros(4)),
            )
        )  # fmt: skip
        state = 0.3 * rng.standard_normal(network.state_size(qp))
        found = network.flow(qp, rate).rates(state)
        expected = programs_rates(qp, rate, state)
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
