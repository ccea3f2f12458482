"""The growth of a sub-step against the closed form and against the network itself."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot
from iiwa_dnn import QP, Configuration, DoubleIndicator, ProjectionNetwork
from iiwa_dnn.studies.stability import amplification, network_matrix


def paper_qp(orientation: str) -> QP:
    conf = Configuration(paper_robot(), PAPER_Q0)
    return DoubleIndicator(orientation=orientation).build_qp(conf, heart().at(0.0))


@pytest.mark.parametrize("orientation", ["block", "so3"])
def test_eigenvalues_are_those_of_the_closed_form(orientation: str) -> None:
    """For P = I: one pair for each singular value, and -1 where no row reaches."""
    qp = paper_qp(orientation)
    sigma = np.linalg.svd(qp.A, compute_uv=False).astype(complex)
    root = np.sqrt(0.25 - sigma**2)
    expected = np.concatenate([-0.5 + root, -0.5 - root, -np.ones(7 - qp.b.size)])
    found = np.linalg.eigvals(network_matrix(qp))
    distance = np.abs(found[:, None] - expected[None, :])
    assert distance.min(axis=1).max() < 1e-7
    assert distance.min(axis=0).max() < 1e-7


def test_the_matrix_is_the_networks_own() -> None:
    qp = paper_qp("block")
    network, rng = ProjectionNetwork(), np.random.default_rng(0)
    free = qp.q.size + qp.b.size
    state, step = 1e-3 * rng.standard_normal((2, network.state_size(qp)))
    state[free:], step[free:] = 0.0, 0.0
    change = network.rates(qp, state + step) - network.rates(qp, state)
    np.testing.assert_allclose(change[:free], network_matrix(qp) @ step[:free], atol=1e-12)


def test_a_step_is_stable_up_to_the_largest_singular_value() -> None:
    qp = paper_qp("block")
    limit = 1.0 / np.linalg.norm(qp.A, 2) ** 2
    assert amplification(qp, 0.999 * limit) < 1.0 < amplification(qp, 1.001 * limit)
    assert limit == pytest.approx(ProjectionNetwork().stable_step(qp, np.zeros(28)), rel=1e-9)
