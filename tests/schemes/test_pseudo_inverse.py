"""The baseline against numpy's pseudo-inverse, least squares, and its own program."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from helpers_kinematics import Array
from helpers_simulation import near_target, paper_robot, paper_start, solve_by
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import PseudoInverse

POSTURES = np.random.default_rng(41).uniform(-2.0, 2.0, (10, 7))


def consistent(q: Array, seed: int) -> tuple[Configuration, object]:
    """A configuration and a target without a pose error, which the block's rows can fulfil."""
    conf = Configuration(paper_robot(), q)
    target = near_target(q, seed)
    return conf, type(target)(
        conf.position, conf.rotation, target.linear_velocity, target.angular_velocity
    )


@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
@pytest.mark.parametrize("q", POSTURES)
def test_velocity_is_the_pseudo_inverse_times_the_task(q: Array, orientation: str) -> None:
    conf, target = Configuration(paper_robot(), q), near_target(q, seed=1, size=0.01)
    scheme = PseudoInverse(orientation=orientation)
    qp = scheme.build_qp(conf, target)
    velocity = scheme.velocity(conf, target)
    np.testing.assert_allclose(
        velocity, np.linalg.pinv(qp.A, rcond=1e-10) @ qp.b, rtol=1e-9, atol=1e-12
    )
    # LAPACK's complete orthogonal factorisation, another algorithm than numpy's.
    other = scipy.linalg.lstsq(qp.A, qp.b, cond=1e-10, lapack_driver="gelsy")[0]
    np.testing.assert_allclose(velocity, other, rtol=1e-7, atol=1e-10)


@pytest.mark.parametrize("q", POSTURES)
def test_closed_form_with_independent_rows(q: Array) -> None:
    conf, target = Configuration(paper_robot(), q), near_target(q, seed=2, size=0.01)
    scheme = PseudoInverse(orientation="none", position_gain=2.0)
    jacobian = conf.jacobian[:3]
    task = target.linear_velocity + 2.0 * (target.position - conf.position)
    expected = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T, task)
    np.testing.assert_allclose(scheme.velocity(conf, target), expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
def test_its_program_solved_by_the_network_is_the_pseudo_inverse(orientation: str) -> None:
    scheme = PseudoInverse(orientation=orientation)
    for seed, q in enumerate(POSTURES):
        conf, target = consistent(q, seed)
        answer = DNNSolver().solve(scheme.build_qp(conf, target))
        assert answer.found
        np.testing.assert_allclose(answer.x, scheme.velocity(conf, target), rtol=0, atol=1e-7)


@pytest.mark.parametrize("solver", ["proxqp", "osqp"])
def test_its_program_solved_by_others(solver: str) -> None:
    conf, target = paper_start(), near_target(paper_start().q, seed=3, size=0.01)
    qp = PseudoInverse().build_qp(conf, target)
    velocity = PseudoInverse().velocity(conf, target)
    np.testing.assert_allclose(velocity, solve_by(solver, qp), rtol=0, atol=1e-8)


def test_it_knows_no_limits_and_no_home() -> None:
    conf = paper_start()
    qp = PseudoInverse().build_qp(conf, near_target(conf.q, seed=4))
    assert np.isinf(qp.lb).all()
    assert np.isinf(qp.ub).all()
    np.testing.assert_array_equal(qp.P, np.eye(7))
    np.testing.assert_array_equal(qp.q, np.zeros(7))
    assert PseudoInverse().anchored(conf) == PseudoInverse()


def test_kinetic_index_is_the_squared_norm() -> None:
    dq = np.random.default_rng(42).normal(size=7)
    index = PseudoInverse().kinetic_index(paper_start(), dq)
    assert index == pytest.approx(np.linalg.norm(dq) ** 2, rel=1e-14)


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        *[("position_gain", bad) for bad in (-1.0, np.nan, np.inf, None, "high")],
        *[("orientation_gain", bad) for bad in (-1.0, np.nan, np.inf, None, "high")],
        ("orientation", "euler"),
    ],
)
def test_a_bad_parameter_is_named(argument: str, value: object) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{argument}\b") as caught:
        PseudoInverse(**{argument: value})
    assert caught.value.argument == argument


def test_settings_make_the_scheme_again() -> None:
    scheme = PseudoInverse(position_gain=3.0, orientation="block")
    settings = scheme.settings()
    assert settings.pop("name") == "pseudo-inverse"
    assert PseudoInverse(**settings) == scheme


def test_the_gains_are_the_papers_unless_others_are_given() -> None:
    scheme = PseudoInverse()
    assert (scheme.position_gain, scheme.orientation_gain) == (10.2, 10.2)
