"""A published script carried out twice: by its recurrences, and by the package's network.

R. Singh and J. Keshavan's controller (IEEE Access 10, 2022; public code, parameters as there) for
an arm of the iiwa 14's lengths with three joints as good as locked. The recurrences below are
written from the paper's equations, entry by entry, with kinematics from DH parameters; the network
runs on Pinocchio's.
"""

from __future__ import annotations

import os

import numpy as np
import pytest

from iiwa_dnn import QP, InvalidInputError
from scripts.faulty_joints import (
    DECAY,
    DEVIATION,
    DT,
    FASTEST,
    GAIN,
    GAMMA,
    R0,
    R_INF,
    START,
    BarrierNetwork,
    by_network,
    path,
)

# Seconds that the test takes; the script's own ten by hand: IIWA_DNN_LONG=10.
DURATION = float(os.environ.get("IIWA_DNN_LONG", "0.1"))


def dh_kinematics(q: np.ndarray, dq: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tool position, Jacobian (3, 7) and its rate, from the DH parameters."""
    lengths = [0.36, 0.0, 0.42, 0.0, 0.4, 0.0, 0.126]
    twists = np.pi / 2 * np.array([-1, 1, 1, -1, -1, 1, 0])
    frame, origins, axes = np.eye(4), [np.zeros(3)], [np.array([0.0, 0.0, 1.0])]
    for angle, length, twist in zip(q, lengths, twists, strict=True):
        c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(twist), np.sin(twist)
        link = [[c, -s * ca, s * sa, 0], [s, c * ca, -c * sa, 0], [0, sa, ca, length], [0, 0, 0, 1]]
        frame = frame @ np.array(link)
        origins.append(frame[:3, 3])
        axes.append(frame[:3, 2])
    tool, J, J_dot = origins[-1], np.zeros((3, 7)), np.zeros((3, 7))
    velocities, turns = [np.zeros(3)], [np.zeros(3)]
    for k in range(7):
        velocities.append(
            sum(np.cross(axes[j], origins[k + 1] - origins[j]) * dq[j] for j in range(k + 1))
        )
        turns.append(turns[-1] + axes[k] * dq[k])
    for k in range(7):
        J[:, k] = np.cross(axes[k], tool - origins[k])
        J_dot[:, k] = np.cross(np.cross(turns[k], axes[k]), tool - origins[k]) + np.cross(
            axes[k], velocities[-1] - velocities[k]
        )
    return tool, J, J_dot


def by_recurrences(steps: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The script's y (steps, 10), tool error and error over funnel (steps, 3), sum by sum."""
    n, m = 7, 3
    y, th = [np.concatenate([np.zeros(n), np.ones(m)])], [START]
    home = dh_kinematics(START, np.zeros(n))[0] + DEVIATION
    wanted, errors, shares = home, [], []
    for i in range(steps):
        t, x, lam = i * DT, y[i][:n], y[i][n:]
        r_a, J, J_dot = dh_kinematics(th[i], x)
        shift, v_d, a_d = path(t)
        e = J @ x - v_d + GAIN * (r_a - wanted)
        e_t = J_dot @ x - a_d + GAIN * (J @ x - v_d)
        errors.append(r_a - wanted)
        wanted = home + shift  # one sample late, as in the script
        r = R0 * np.exp(-DECAY * t) + R_INF
        r_t = -DECAY * R0 * np.exp(-DECAY * t)
        shares.append(e / r)
        h, h_t, H = np.zeros(n + m), np.zeros(n + m), np.zeros((n + m, n + m))
        for k in range(n):
            eta = (x[k] + FASTEST[k]) / (2 * FASTEST[k])
            chi, d = np.log(eta / (1 - eta)), eta * (1 - eta)
            h[k] += chi / (2 * FASTEST[k] * d)
            H[k, k] += (1 + (2 * eta - 1) * chi) / (2 * FASTEST[k] * d) ** 2
        for j in range(m):
            eta = (e[j] + r) / (2 * r)
            eta_t = (2 * r * (e_t[j] + r_t) - 2 * r_t * (e[j] + r)) / (2 * r) ** 2
            chi, d = np.log(eta / (1 - eta)), eta * (1 - eta)
            second = (1 + (2 * eta - 1) * chi) / d**2
            h[n + j], h_t[n + j] = chi**2 / 2, chi * eta_t / d
            for k in range(n):
                slope = J[j, k] * chi / (2 * r * d)
                slope_t = (
                    J[j, k] / (2 * r) * second * eta_t
                    + chi / d * (J_dot[j, k] * 2 * r - J[j, k] * 2 * r_t) / (2 * r) ** 2
                )
                h[k] += lam[j] * slope
                h_t[k] += lam[j] * slope_t
                H[n + j, k] = H[k, n + j] = slope
                for c in range(n):
                    H[k, c] += lam[j] * J[j, k] * J[j, c] * second / (2 * r) ** 2
        y_dot = -np.linalg.pinv(H) @ (GAMMA * h + h_t)
        if i < 3:
            y.append(y[i] + DT * y_dot)
            th.append(th[i] + DT * x)
        else:
            y.append(1.6 * DT * y_dot + 0.6 * y[i] + 0.2 * y[i - 1] + 0.2 * y[i - 2])
            th.append(1.6 * DT * x + 0.6 * th[i] + 0.2 * th[i - 1] + 0.2 * th[i - 2])
    return np.array(y[:-1]), np.array(errors), np.array(shares)


def test_the_published_recurrences_and_the_network_agree() -> None:
    steps = round(DURATION / DT)
    y, errors, shares = by_recurrences(steps)
    states, ours = by_network(steps)
    assert np.abs(ours - errors).max() < 1e-9
    assert np.abs(states[:, :7] - y[:, :7]).max() < 1e-9
    # The claims: velocities inside their bounds, the error inside its funnel all the time, and the
    # tool approaches the path at the rate of the feedback.
    assert (np.abs(y[:, :7]) < 0.62 * FASTEST).all()
    assert (np.abs(shares) < 1.0).all()
    distance, t = np.linalg.norm(errors, axis=1), DT * np.arange(steps)
    assert (distance < 1.05 * distance[0] * np.exp(-GAIN * (t - 0.06)) + 4e-5).all()


def test_derivatives_of_the_barriers_by_finite_differences() -> None:
    rng, network = np.random.default_rng(0), BarrierNetwork(0.5, 2.0, 0.5, 1.5)
    A, move = rng.standard_normal((2, 3, 5))[:, :2]
    b, shift = 0.1 * rng.standard_normal((2, 2))

    def qp_at(t: float) -> QP:
        bounds = np.full(5, 1.0 + 0.1 * t)
        return QP(np.zeros((5, 5)), np.zeros(5), A=A + t * move, b=b + t * shift,
                  lb=-bounds, ub=bounds)  # fmt: skip

    def gradient(s: np.ndarray, t: float) -> np.ndarray:
        """Of the Lagrangian: half of the squared logits, by differences of their sum."""

        def lagrangian(s: np.ndarray) -> float:
            qp, clock = qp_at(t), s[-1] + t
            edge = 2.0 * np.exp(-1.5 * 0.5 * clock) + 0.5
            error = qp.A @ s[:5] - qp.b
            chi = np.log((s[:5] - qp.lb) / (qp.ub - s[:5]))
            psi = np.log((error + edge) / (edge - error))
            return 0.5 * chi @ chi + 0.5 * s[5:7] @ psi**2

        steps = 1e-5 * np.eye(8)[:7]
        return np.array([(lagrangian(s + d) - lagrangian(s - d)) / 2e-5 for d in steps])

    s = np.concatenate([0.2 * rng.standard_normal(5), [0.7, 1.2], [0.3]])
    ahead, behind = qp_at(1e-4).data, qp_at(-1e-4).data
    rate = QP.from_data(np.nan_to_num((ahead - behind) / 2e-4), qp_at(0.0).sizes)
    rates = network.flow(qp_at(0.0), rate).rates(s)
    # Along the rates the gradient decays at the rate 1: its own derivative is minus itself.
    h, step = gradient(s, 0.0), 1e-3
    moved = rates.copy()
    moved[-1] = 0.0
    change = (gradient(s + step * moved, step) - gradient(s - step * moved, -step)) / (2 * step)
    np.testing.assert_allclose(change, -h, atol=2e-3 * np.abs(h).max())
    assert rates[-1] == 1.0


def test_wrong_parameters_are_named() -> None:
    with pytest.raises(InvalidInputError, match="decay"):
        BarrierNetwork(decay=0.0)
