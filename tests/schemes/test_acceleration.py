"""The acceleration level: rows by differences, closed form, energy, order, limits, both loops."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from helpers_simulation import UNCHECKED, heart, paper_robot, paper_start
from iiwa_dnn import (
    AccelerationLimits,
    Circle,
    Configuration,
    Controller,
    CyclicMotion,
    DNNSolver,
    InvalidInputError,
    JointLimits,
    KineticEnergy,
    OrientationTask,
    PositionTask,
    Record,
    Scheme,
    Target,
    simulate,
)
from iiwa_dnn.control.policies import Action
from iiwa_dnn.schemes import Cost, Limit, Task
from iiwa_dnn.schemes.acceleration import JointAcceleration, JointTorque
from iiwa_dnn.schemes.literature import minimum_torque, resolved_acceleration

ROBOT, START = paper_robot(), paper_start()
DELTA = 10.2


def scheme(*costs: Cost, limits: tuple[Limit, ...] = (), tasks: tuple[Task, ...] = ()) -> Scheme:
    return Scheme(
        costs or (JointAcceleration(damping=0.0),), tasks or (PositionTask(), OrientationTask()),
        limits, level="acceleration",
    )  # fmt: skip


def drive(what: Scheme, **options: object) -> Record:
    options = {"dt": 1e-2, "duration": 1.0, "check": UNCHECKED} | options
    return simulate(ROBOT, what, heart(), START.q, **options)


def moving(rng: np.random.Generator) -> tuple[Configuration, np.ndarray, Target, np.ndarray]:
    conf = Configuration(ROBOT, START.q + 0.2 * rng.standard_normal(7))
    near = Configuration(ROBOT, conf.q + 0.02 * rng.standard_normal(7))
    target = Target(near.position, near.rotation, *(0.1 * rng.standard_normal((2, 3))))
    return conf, 0.3 * rng.standard_normal(7), target, rng.standard_normal(6)


def test_rows_ask_for_a_critically_damped_error_and_the_answer_is_the_pseudo_inverse() -> None:
    rng, h = np.random.default_rng(0), 1e-6
    for _ in range(5):
        conf, dq, target, wanted = moving(rng)
        qp = scheme().build_qp(conf, target, 1e-3, dq, wanted)
        J = conf.jacobian
        ahead, behind = (Configuration(ROBOT, conf.q + s * h * dq).jacobian for s in (1, -1))
        drift = (ahead - behind) @ dq / (2 * h)
        turn = pin.log3(target.rotation @ conf.rotation.T)
        error = np.concatenate([target.position - conf.position, turn])
        twist = target.data[12:]
        b = wanted - drift + 2 * DELTA * (twist - J @ dq) + DELTA**2 * error
        np.testing.assert_allclose(qp.A, J, atol=1e-12)
        np.testing.assert_allclose(qp.b, b, atol=1e-6)
        x = DNNSolver().solve(qp).x
        np.testing.assert_allclose(x, np.linalg.pinv(J) @ b, atol=1e-6)


def test_least_torque_by_its_closed_form() -> None:
    conf, dq, target, wanted = moving(np.random.default_rng(1))
    qp = scheme(JointTorque()).build_qp(conf, target, 1e-3, dq, wanted)
    x = DNNSolver(tol=1e-8).solve(qp).x
    data, M = ROBOT.model.createData(), np.array(conf.inertia)
    h = pin.rnea(ROBOT.model, data, conf.q, dq, np.zeros(7))
    # Least norm of tau on the rows J M^-1 tau = b + J M^-1 h.
    rows = qp.A @ np.linalg.inv(M)
    tau = np.linalg.pinv(rows) @ (qp.b + rows @ h)
    np.testing.assert_allclose(pin.rnea(ROBOT.model, data, conf.q, dq, x), tau, atol=1e-5)


def test_without_tasks_the_energy_of_the_velocity_dies_out_as_the_damping_says() -> None:
    """Each period takes the share lambda dt of the velocity; only the start is in motion."""
    what = scheme(JointAcceleration(damping=4.0), tasks=(PositionTask(weight=0.0),))
    loop, dq, still = Controller(ROBOT, what, dt=1e-2), 0.1 * np.arange(1.0, 8.0), heart().at(0.0)
    command = loop.step(START.q, 0.0, still, dq)
    for k in range(1, 20):
        np.testing.assert_allclose(command.dq, dq * 0.96**k, rtol=1e-9)
        command = loop.step(START.q, 1e-2 * k, still)


@pytest.mark.parametrize(("motion", "order"), [("euler", 1), ("midpoint", 2), ("rk4", 4)])
def test_the_error_of_the_path_is_of_the_order_of_the_motion(motion: str, order: int) -> None:
    largest = [
        np.abs((r := drive(scheme(), dt=dt, motion=motion)).position - r.position_desired).max()
        for dt in (4e-2, 2e-2)
    ]
    assert np.log2(largest[0] / largest[1]) == pytest.approx(order, abs=0.3)


def test_the_record_knows_the_accelerations_and_double_integrates_them() -> None:
    record = drive(resolved_acceleration())
    assert record.ddq is not None
    dt, velocity = 1e-2, np.vstack([np.zeros(7), record.dq_solver])
    np.testing.assert_allclose(np.diff(velocity, axis=0), dt * record.ddq, atol=1e-14)
    np.testing.assert_allclose(record.dq, 0.5 * (velocity[1:] + velocity[:-1]), atol=1e-14)
    np.testing.assert_allclose(np.diff(record.q, axis=0), dt * record.dq, atol=1e-14)
    assert record.settings["scheme"]["level"] == "acceleration"


@pytest.mark.parametrize("make", [resolved_acceleration, minimum_torque])
def test_draws_the_heart_inside_its_limits(make) -> None:
    record = simulate(ROBOT, make(), heart(), START.q, dt=5e-3, duration=10.0)
    error = np.linalg.norm(record.position - record.position_desired, axis=1)
    assert error.max() < 3e-6
    assert np.abs(record.q).max() <= 2.5
    assert np.nanmax(record.crosscheck_gap) < 1e-6  # ProxQP was asked the same


def test_limits_hold_exactly_at_any_gain_of_theirs() -> None:
    """A circle that joint 2 cannot follow: the task yields, no limit does."""
    tight = ROBOT.with_limits(lower=START.q - 0.2, upper=START.q + 0.2, velocity=0.5)
    limits = (JointLimits(gain=1000.0), AccelerationLimits(2.0))
    path = Circle(radius=0.2, period=4.0).anchored(START)
    what = scheme(JointAcceleration(), limits=limits)
    options = {"dt": 5e-3, "duration": 4.0, "check": UNCHECKED, "policy": "relax"}
    record = simulate(tight, what, path, START.q, **options)
    assert (record.action == Action.RELAX).sum() > 100
    assert (record.q <= tight.q_upper + 1e-12).all()
    assert (record.q >= tight.q_lower - 1e-12).all()
    assert (record.q > tight.q_upper - 1e-3).any()
    assert np.abs(record.dq_solver).max() <= 0.5 + 1e-12
    assert np.abs(record.ddq).max() <= 2.0 + 1e-9
    assert record.settings["status"] == "completed"


def test_stop_brakes_within_the_limits() -> None:
    tight = ROBOT.with_limits(lower=START.q - 0.05, upper=START.q + 0.05)
    what = scheme(JointAcceleration(), limits=(JointLimits(), AccelerationLimits(1.0)))
    path = Circle(radius=0.2, period=4.0).anchored(START)
    options = {"dt": 5e-3, "duration": 4.0, "check": UNCHECKED, "policy": "stop"}
    record = simulate(tight, what, path, START.q, **options)
    assert "stopped" in record.settings["status"]
    assert np.abs(record.dq_solver[-1]).max() < 1e-12
    assert np.abs(record.ddq).max() <= 1.0 + 1e-9


def test_slow_says_that_it_acts_as_relax() -> None:
    weak = ROBOT.with_limits(acceleration=0.05)
    limited = scheme(limits=(JointLimits(), AccelerationLimits()))
    controller = Controller(weak, limited, heart(), dt=1e-3)
    with pytest.warns(UserWarning, match="'slow' acts as 'relax'"):
        command = controller.step(START.q, 0.0)
    assert command.action is Action.RELAX
    assert controller.delay == 0.0


def test_a_robots_loop_gets_the_same_commands_and_may_measure_velocities() -> None:
    record, loop = drive(resolved_acceleration()), Controller(
        ROBOT, resolved_acceleration(), heart(), dt=1e-2
    )  # fmt: skip
    for k in range(20):
        before = np.zeros(7) if k == 0 else record.dq_solver[k - 1]
        command = loop.step(record.q[k], 1e-2 * k, dq=before if k % 2 else None)
        np.testing.assert_allclose(command.dq, record.dq_solver[k], atol=1e-9)
        np.testing.assert_allclose(command.solution.x, record.ddq[k], atol=1e-8)
    with pytest.raises(InvalidInputError, match="dq: is for schemes of the acceleration"):
        Controller(ROBOT, Scheme([KineticEnergy()]), heart()).step(START.q, 0.0, dq=np.zeros(7))


def test_an_arm_with_mass_follows() -> None:
    from iiwa_dnn import MujocoPlant

    record = drive(resolved_acceleration(), dt=1e-3, duration=0.5, plant=MujocoPlant())
    assert np.linalg.norm(record.position - record.position_desired, axis=1).max() < 1e-4
    assert record.ddq is not None
    assert record.torque is not None


@pytest.mark.parametrize(
    ("build", "word"),
    [
        (lambda: Scheme(level="jerk"), "level"),
        (lambda: scheme(CyclicMotion()).program(ROBOT), "costs"),
        (lambda: scheme(tasks=(OrientationTask(form="block"),)).program(ROBOT), "tasks"),
        (lambda: scheme(tasks=(PositionTask(tracking="next"),)).program(ROBOT), "tasks"),
        (lambda: scheme().build_qp(START, heart().at(0.0)), "dt"),
        (lambda: drive(scheme(), noise=0.1), "scheme"),
        (lambda: JointAcceleration(damping=-1.0), "damping"),
        (lambda: JointTorque(weight=-1.0), "weight"),
    ],
)
def test_what_has_no_meaning_is_named(build, word: str) -> None:
    with pytest.raises(InvalidInputError, match=word):
        build()
