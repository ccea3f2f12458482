"""The growth of a sub-step against the closed form and against the network itself."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot
from iiwa_dnn import QP, Configuration, DoubleIndicator, ProjectionNetwork
from iiwa_dnn.studies.runs import amplification


def paper_qp(orientation: str) -> QP:
    conf = Configuration(paper_robot(), PAPER_Q0)
    return DoubleIndicator(orientation=orientation).build_qp(conf, heart().at(0.0))


@pytest.mark.parametrize("orientation", ["block", "so3"])
@pytest.mark.parametrize("step", [0.01, 0.1, 0.14, 0.3, 2.0, 5.0])
def test_the_growth_is_that_of_the_closed_form(orientation: str, step: float) -> None:
    """For P = I: one pair of eigenvalues for each singular value, and -1 where no row reaches."""
    qp = paper_qp(orientation)
    sigma = np.linalg.svd(qp.A, compute_uv=False)
    root = np.sqrt(0.25 - sigma[sigma > 1e-6].astype(complex) ** 2)
    eigenvalues = np.concatenate([-0.5 + root, -0.5 - root, -np.ones(7)])
    expected = np.abs(1.0 + step * eigenvalues).max()
    assert amplification(qp, step) == pytest.approx(expected, rel=1e-9)


def test_an_error_grows_as_said() -> None:
    """Many explicit steps of the network itself, from a state without active bounds."""
    qp = paper_qp("so3")
    network, rng = ProjectionNetwork(primal_projection=False), np.random.default_rng(0)
    for step, grows in ((0.2, False), (0.4, True)):
        error = 1e-9 * rng.standard_normal(network.state_size(qp))
        error[qp.q.size + qp.b.size :] = 0.0
        sizes = []
        for _ in range(6000):
            change = network.rates(qp, error) - network.rates(qp, np.zeros(error.size))
            error = error + step * change
            sizes.append(np.linalg.norm(error))
            error /= 1e9 * sizes[-1]
        growth = np.exp(np.mean(np.log(1e9 * np.array(sizes[3000:]))))
        assert (growth > 1.0) == grows
        assert growth == pytest.approx(amplification(qp, step), rel=1e-3)


def test_a_step_is_stable_up_to_the_largest_singular_value() -> None:
    qp = paper_qp("block")
    limit = 1.0 / np.linalg.norm(qp.A, 2) ** 2
    assert amplification(qp, 0.999 * limit) < 1.0 < amplification(qp, 1.001 * limit)
    assert limit == pytest.approx(ProjectionNetwork().stable_step(qp, np.zeros(28)), rel=1e-9)
