"""The closed loop: its bookkeeping, determinism, limits, drift, lag, and how it stops."""

import json
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, dh_pose, rotation_angle
from helpers_simulation import UNCHECKED, heart, paper_robot, paper_start, run
from iiwa_dnn.simulation import NOISE_ENTRIES, gaussian_noise
from iiwa_dnn.simulation.estimation import NoiseModel
from iiwa_dnn.step.policies import Action

UNLIMITED = paper_robot().with_limits(acceleration=np.inf)  # white noise is beyond any limit
OPTIONS = {
    "plain": {},
    "noisy": {"noise": 0.01, "filter_window": 10, "seed": 3, "robot": UNLIMITED},
    "midpoint": {"motion": "midpoint"},
    "rk4": {"motion": "rk4", "noise": 0.01, "robot": UNLIMITED},
    "continuous": {"mode": "continuous", "dt": 1e-4, "duration": 0.01},
}


@pytest.fixture(scope="module", params=list(OPTIONS))
def record(request: pytest.FixtureRequest) -> d.Record:
    return run(**{"check": d.CrossCheck(("proxqp", "osqp"))} | OPTIONS[request.param])


def drift(record: d.Record) -> float:
    return float(np.abs(record.q[-1] - record.q[0]).max())


def position_error(record: d.Record) -> np.ndarray:
    """Distance to the desired position [m], (N+1,), the position by the DH formula."""
    return np.linalg.norm(dh_pose(record.q)[0] - record.position_desired, axis=1)


def test_a_record_is_the_motion_that_its_velocities_make(record: d.Record) -> None:
    dt = record.settings["dt"]
    np.testing.assert_array_equal(record.q[0], PAPER_Q0)
    np.testing.assert_array_equal(record.q[1:], record.q[:-1] + dt * record.dq)
    np.testing.assert_allclose(np.diff(record.t), dt, rtol=1e-9)
    assert record.steps == round(record.settings["duration"] / dt)
    position, rotation = dh_pose(record.q)
    np.testing.assert_allclose(record.position, position, rtol=0, atol=1e-12)
    assert rotation_angle(record.rotation, rotation).max() < 1e-12
    desired = [heart().at(t).position for t in record.t]
    np.testing.assert_allclose(record.position_desired, desired, rtol=0, atol=1e-15)
    assert rotation_angle(record.rotation_desired, rotation[0]).max() < 1e-12


def test_every_step_was_checked_by_every_reference(record: d.Record) -> None:
    assert record.settings["check"]["solvers"] == ["proxqp", "osqp"]
    assert (record.reference_residual <= 1e-8).all()
    assert np.isfinite(record.solution_gap).all()
    assert np.isfinite(record.objective_gap).all()
    if record.settings["mode"] == "converged":
        assert record.crosscheck_gap.max() <= 1e-6
        assert record.kkt_residual.max() <= 1e-9
    else:
        assert record.crosscheck_gap.max() > 1e-6  # the lag
    assert d.failures(record) == []


@pytest.mark.parametrize("motion", ["euler", "midpoint"])
def test_a_run_of_several_blocks_has_no_seams(motion: str) -> None:
    reference = heart(period=2.0)
    options = {"noise": 1e-3, "filter_window": 5, "seed": 7}
    record = run(reference=reference, duration=1.1, motion=motion, **options)
    noisy = record.dq_solver + gaussian_noise(1e-3, 1100, 7, seed=7)
    filtered = [noisy[max(0, k - 4) : k + 1].mean(axis=0) for k in range(1100)]
    np.testing.assert_allclose(record.dq, filtered, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(record.q[1:], record.q[:-1] + 1e-3 * record.dq)
    np.testing.assert_allclose(record.position, dh_pose(record.q)[0], rtol=0, atol=1e-12)
    desired = [reference.at(t).position for t in record.t]
    np.testing.assert_allclose(record.position_desired, desired, rtol=0, atol=1e-14)
    np.testing.assert_allclose(record.kinetic_index, (record.dq**2).sum(axis=1), rtol=1e-12)
    assert position_error(record).max() < 1e-3


def test_settings_say_what_was_asked_and_with_what() -> None:
    options = {"noise": 0.001, "filter_window": 4, "seed": 11}
    settings = run(
        d.DoubleIndicator(weight=0.3, kinetic="inertia"),
        robot=paper_robot().with_limits(velocity=1.0),
        solver=d.DNNSolver(tol=1e-8),
        check=d.CrossCheck(("osqp",), tolerance=1e-5),
        **options,
    ).settings
    expected = {
        "robot": "iiwa7", "tip": paper_robot().tip, "q_lower": [-2.5] * 7, "dq_max": [1.0] * 7,
        "q0": list(PAPER_Q0), "dt": 1e-3, "duration": 0.05, "mode": "converged", "motion": "euler",
        "tol": 1e-8, "status": "completed",
    }  # fmt: skip
    assert (expected | options).items() <= settings.items()
    scheme = {"weight": 0.3, "kinetic": "inertia", "home": list(PAPER_Q0)}
    assert scheme.items() <= settings["scheme"].items()
    assert settings["reference"] == {"name": "heart", "scale": 3.45e-3, "period": 10.0}
    check = {"solvers": ["osqp"], "second": ["proxqp"], "tolerance": 1e-5}
    assert check.items() <= settings["check"].items()
    assert settings["network"]["name"] == "ProjectionNetwork"
    assert {"iiwa-dnn", "numpy", "pin", "qpsolvers"} <= set(settings["versions"])
    json.dumps(settings, allow_nan=False)


@pytest.mark.parametrize("solvers", [(), ("osqp",)], ids=["none", "osqp"])
@pytest.mark.parametrize("case", list(OPTIONS))
def test_the_same_call_saves_the_same_bytes(case, solvers, tmp_path) -> None:
    for name in ("one", "two"):
        run(**{"check": d.CrossCheck(solvers), "duration": 0.02} | OPTIONS[case]).save(
            tmp_path / name
        )
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


def test_settings_are_taken_by_name_or_as_one_object() -> None:
    names = {"dt": 1e-3, "duration": 0.02, "noise": 1e-3, "seed": 4, "check": UNCHECKED}
    settings = d.RunSettings(**names | {"seed": 5})
    one = d.simulate(paper_robot(), d.DoubleIndicator(), heart(), PAPER_Q0, settings, seed=4)
    other = d.simulate(paper_robot(), d.DoubleIndicator(), heart(), PAPER_Q0, **names)
    np.testing.assert_array_equal(one.q, other.q)
    assert one.settings == other.settings


def test_cyclic_motion_comes_back_and_minimum_energy_drifts() -> None:
    # One whole heart, drawn in 2 s.
    whole = {"reference": heart(period=2.0), "duration": None}
    cyclic = run(d.DoubleIndicator(weight=0.2), **whole)
    energy = run(d.DoubleIndicator(weight=1.0), **whole)
    assert drift(cyclic) < 5e-4
    assert drift(energy) > 5e-3
    for record in (cyclic, energy):
        assert position_error(record).max() < 1e-4
    # With G = I and no limit near, minimum energy is the pseudo-inverse.
    baseline = run(d.PseudoInverse(), **whole)
    np.testing.assert_allclose(energy.q, baseline.q, rtol=0, atol=1e-6)


def test_a_network_that_diverges_is_called_that() -> None:
    solver = d.DNNSolver(
        d.PrimalDualNetwork(rho=1e-5), advance_integrator=d.ExplicitEuler(substeps=1)
    )
    circle = d.Circle(0.05, period=1.0).anchored(paper_start())
    record = run(reference=circle, solver=solver, mode="continuous", duration=0.2)
    reasons = d.failures(record)
    assert len(reasons) == 3  # accelerations, the path, and why it ended
    assert "the network diverged: take a smaller dt" in reasons[2]


def test_a_joint_that_meets_its_limit_stays_inside_and_the_tip_on_its_path() -> None:
    # Without it, joint 1 would go to -2.48 rad.
    lower = np.full(7, -2.5)
    lower[0] = -2.42
    robot = UNLIMITED.with_limits(lower=lower)
    options = {"reference": heart(period=2.0), "duration": 1.0, "check": d.CrossCheck()}
    assert run(**options).q[:, 0].min() < -2.47
    record = run(robot=robot, **options)
    assert record.q[:, 0].min() >= -2.42
    assert np.count_nonzero(record.q[:, 0] < -2.42 + 1e-4) > 100
    metrics = d.compute_metrics(record)
    assert metrics["position_limit_violation_rad"] == 0.0
    assert metrics["velocity_limit_violation_rad_s"] == 0.0
    assert d.failures(record) == []
    assert position_error(record).max() < 1e-4


def test_a_start_outside_the_limits_is_brought_back() -> None:
    upper = np.full(7, 2.5)
    upper[0] = PAPER_Q0[0] - 0.02
    robot = paper_robot().with_limits(upper=upper)
    with pytest.warns(UserWarning, match=r"^the start posture .* joint 1 is at -2.357"):
        record = run(robot=robot, duration=0.5, check=d.CrossCheck())
    excess = record.q[:, 0] - upper[0]
    assert (np.diff(excess) < 1e-12).all()
    # Like exp(-kappa t), kappa = 20 / s.
    np.testing.assert_allclose(excess, 0.02 * np.exp(-20.0 * record.t), rtol=0, atol=2e-4)
    assert record.settings["status"] == "completed"
    assert any("position limit" in reason for reason in d.failures(record))


def test_the_continuous_network_lags_as_much_as_the_papers() -> None:
    paper = 5.59e-5  # m, Table I at weight 0.2, over 10 s
    record = run(d.DoubleIndicator(orientation="block"), mode="continuous", dt=1e-4, duration=0.5)
    assert paper / 3.0 < position_error(record).max() < 3.0 * paper
    settled = run(d.DoubleIndicator(orientation="block"), dt=1e-4, duration=0.1)
    assert position_error(settled).max() < 0.05 * position_error(record)[:1001].max()
    assert d.failures(record) == []


@pytest.mark.parametrize("motion", ["euler", "rk4"])
@pytest.mark.parametrize("entry", [None, *NOISE_ENTRIES])
def test_a_run_that_is_stopped_ends_at_rest_and_is_recorded_as_it_was(entry, motion) -> None:
    # Too slow for the heart: from some step on, no velocity within the limits fulfils the task.
    noise = {} if entry is None else {"noise": 1e-4, "noise_at": entry}
    record = run(
        robot=paper_robot().with_limits(velocity=0.15),
        reference=heart(period=2.0),
        duration=1.0,
        motion=motion,
        policy="stop",
        check=d.CrossCheck(),
        **noise,
    )
    last = record.steps - 1
    assert 0 < last < 999
    assert record.settings["status"].startswith(f"stopped at step {last} ")
    assert any(f"step {last} " in reason for reason in d.failures(record))
    np.testing.assert_array_equal(record.q[1:], record.q[:-1] + 1e-3 * record.dq)
    np.testing.assert_allclose(record.position, dh_pose(record.q)[0], rtol=0, atol=1e-12)
    np.testing.assert_allclose(record.kinetic_index, (record.dq**2).sum(axis=1), rtol=1e-12)
    if entry is None:
        assert not record.dq[last].any()
        assert record.dq[last - 1].any()
        assert record.kkt_residual[last] > 1e-9
        assert (record.kkt_residual[:last] <= 1e-9).all()
        np.testing.assert_array_equal(record.reference_residual[last], [np.inf])


def test_a_stage_without_a_solution_is_recorded() -> None:
    # Such a step is an Euler step; the record said nothing of it, and the run passed for a success.
    robot = paper_robot().with_limits(velocity=0.15)
    record = run(robot=robot, reference=heart(period=2.0), duration=0.05, motion="rk4")
    first = int(np.flatnonzero(record.action)[0])
    assert record.action[first] == Action.EULER
    assert d.compute_metrics(record)["incidents"]["euler_steps"] == 1
    assert d.failures(record)
    qp = d.DoubleIndicator(home=PAPER_Q0).build_qp(
        d.Configuration(robot, record.q[first]), heart(period=2.0).at(record.t[first])
    )
    np.testing.assert_allclose(qp.A @ record.dq[first], qp.b, rtol=0, atol=1e-8)


def test_an_estimator_is_told_of_the_velocity_that_the_joints_get() -> None:
    window = {"noise": 0.01, "filter_window": 50, "duration": 1.0, "seed": 1}
    errors = [
        position_error(run(estimator=estimator, **window)).max()
        for estimator in (None, NoiseModel(velocity=0.01, measurement=1e-5))
    ]
    assert errors[1] < 1.2 * errors[0] < 1e-3


def test_a_path_that_begins_elsewhere_is_warned_of() -> None:
    with pytest.warns(UserWarning, match=r"begins 0\.\d+ m and .* rad from.*anchored"):
        run(reference=d.Heart(), duration=0.002)
    start = paper_start()
    points = start.position + [[0.1, 0.0, -0.1], [0.1, 0.05, -0.1]]
    turns = np.tile(pin.Quaternion(start.rotation).coeffs()[[3, 0, 1, 2]], (2, 1))
    path = d.Waypoints([0.0, 0.2], points, quaternions=turns)
    with pytest.warns(UserWarning, match=r"begins 0\.141 m.*solve_pose"):
        run(reference=path)
    posture = d.solve_pose(paper_robot(), path.at(0.0), start.q).q
    options: Any = {"dt": 1e-3, "duration": 0.05, "check": UNCHECKED}
    record = d.simulate(paper_robot(), d.DoubleIndicator(), path, posture, **options)
    assert np.linalg.norm(record.position - record.position_desired, axis=1).max() < 1e-3


@pytest.mark.parametrize(
    ("path", "reason"),
    [(d.Circle(period=2.0, begin=0.0), "the path at speed"), (d.Line(period=0.1), "more time")],
)
def test_a_path_at_speed_is_told_from_one_that_is_too_quick(path: Any, reason: str) -> None:
    """Both ask for too much in the first step."""
    start = paper_start()
    scheme = d.DoubleIndicator(extra_limits=(d.AccelerationLimits(),), sample="end")
    robot = paper_robot().with_limits(acceleration=0.05)
    anchored = path.anchored(start)
    record = d.simulate(robot, scheme, anchored, start.q, dt=5e-3, duration=0.02, policy="slow")
    assert d.compute_metrics(record)["incidents"]["first"]["step"] == 0
    assert reason in d.failures(record)[1]
