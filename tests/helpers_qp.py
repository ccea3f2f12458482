"""Quadratic programs whose solution is known by construction."""

import numpy as np

from iiwa_dnn import QP


def known_qp(
    rng: np.random.Generator,
    n: int,
    equalities: int,
    active_bounds: int,
    dependent: bool = False,
    inequalities: int = 0,
) -> tuple[QP, np.ndarray]:
    """A strictly convex QP built backwards from its KKT point, and that point's x.

    `active_bounds` bounds carry a positive multiplier; with `dependent`, the last equality row is
    a combination of the others. Half of the `inequalities` are active.
    """
    root = rng.standard_normal((n, n))
    P = root @ root.T / n + 0.1 * np.eye(n)
    A = rng.standard_normal((equalities, n))
    if dependent:
        A[-1] = rng.standard_normal(equalities - 1) @ A[:-1]
    x = rng.standard_normal(n)
    lb, ub = x - 0.01 - rng.exponential(size=n), x + 0.01 + rng.exponential(size=n)
    z_box = np.zeros(n)
    for i in rng.permutation(n)[:active_bounds]:
        z_box[i] = rng.exponential() * rng.choice([-1.0, 1.0])
    ub = np.where(z_box > 0.0, x, ub)
    lb = np.where(z_box < 0.0, x, lb)
    G = rng.standard_normal((inequalities, n))
    z = np.where(np.arange(inequalities) % 2 == 0, rng.exponential(size=inequalities), 0.0)
    h = G @ x + np.where(z > 0, 0.0, 0.01 + rng.exponential(size=inequalities))
    y = rng.standard_normal(equalities)
    q = -(P @ x + A.T @ y + G.T @ z + z_box)
    return QP(P, q, G=G, h=h, A=A, b=A @ x, lb=lb, ub=ub), x


def bounds_as_rows(qp: QP) -> tuple[np.ndarray, np.ndarray]:
    """The paper's Omega and chi, its printed sign of lb corrected (docs/errata.md)."""
    eye = np.eye(qp.q.size)
    return np.vstack([eye, -eye]), np.concatenate([qp.ub, -qp.lb])


def network_rates(qp: QP, state: np.ndarray, project: bool = True) -> np.ndarray:
    """The projection network's right-hand side, straight from the paper's equations."""
    n, p, m = qp.q.size, qp.b.size, qp.h.size
    x, y, z = state[:n], state[n : n + p], state[n + p : n + p + m]
    mu = state[n + p + m :]
    omega, chi = bounds_as_rows(qp)
    gradient = qp.P @ x + qp.q + qp.A.T @ y + qp.G.T @ z + omega.T @ mu
    aim = x - gradient
    return np.concatenate(
        [
            (np.clip(aim, qp.lb, qp.ub) if project else aim) - x,
            qp.A @ x - qp.b,
            np.maximum(z + qp.G @ x - qp.h, 0.0) - z,
            np.maximum(mu + omega @ x - chi, 0.0) - mu,
        ]
    )
