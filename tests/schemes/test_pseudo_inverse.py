"""The baseline's program beside numpy's pseudo-inverse."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import Array
from helpers_simulation import near_target, paper_robot
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import PseudoInverse

POSTURES = np.random.default_rng(41).uniform(-2.0, 2.0, (10, 7))


@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
@pytest.mark.parametrize("q", POSTURES)
def test_the_answer_is_the_pseudo_inverse_times_the_task(q: Array, orientation: str) -> None:
    conf = Configuration(paper_robot(), q)
    near = near_target(q, seed=1)
    # Without a pose error, so that the block's dependent rows can be fulfilled.
    twist = (near.linear_velocity, near.angular_velocity)
    target = type(near)(conf.position, conf.rotation, *twist)
    qp = PseudoInverse(orientation=orientation).build_qp(conf, target)
    answer = DNNSolver().solve(qp)
    assert answer.found
    np.testing.assert_allclose(
        answer.x, np.linalg.pinv(qp.A, rcond=1e-10) @ qp.b, rtol=0, atol=1e-7
    )


def test_it_knows_no_limits_and_no_home() -> None:
    conf = Configuration(paper_robot(), POSTURES[0])
    qp = PseudoInverse().build_qp(conf, near_target(conf.q, seed=4))
    assert np.isinf(qp.lb).all()
    assert np.isinf(qp.ub).all()
    np.testing.assert_array_equal(qp.P, np.eye(7))
    np.testing.assert_array_equal(qp.q, np.zeros(7))
    assert PseudoInverse().anchored(conf) == PseudoInverse()


@pytest.mark.parametrize(
    ("argument", "value"),
    [("position_gain", -1.0), ("orientation_gain", np.inf), ("orientation", "euler")],
)
def test_a_bad_parameter_is_named(argument: str, value: object) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{argument}\b"):
        PseudoInverse(**{argument: value})
