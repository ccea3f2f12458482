"""Each metric against a value worked out by hand; each reason to fail against its cause."""

from __future__ import annotations

import dataclasses
import json
import re

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_records import heart_record, make_record
from helpers_simulation import paper_robot, paper_start
from iiwa_dnn import Circle, CrossCheck, DoubleIndicator, Record, simulate
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics, orientation_error, position_error

DESIGN_KEYS = [
    "path_completed",
    "max_position_error_m",
    "mse_position_error_m2",
    "max_orientation_error_rad",
    "joint_drift_rad",
    "max_kinetic_index",
    "steps",
    "dt_s",
    "duration_s",
    "wall_time_s",
    "realtime_factor",
    "position_limit_violation_rad",
    "velocity_limit_violation_rad_s",
    "max_kkt_residual",
    "active_limit_steps",
    "network_iterations",
    "crosscheck",
    "settings",
    "versions",
]


def rotation_about(axis, angles):
    """Rodrigues' formula, (M, 3, 3); 1 − cos is written so that small angles keep their digits."""
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angles = np.asarray(angles)[:, None, None]
    return np.eye(3) + np.sin(angles) * cross + 2.0 * np.sin(angles / 2.0) ** 2 * cross @ cross


def sample(record, name, index, value):
    """Replace one entry of one array of a record."""
    array = np.array(getattr(record, name))
    array[index] = value
    return dataclasses.replace(record, **{name: array})


def check_of(tolerance=1e-6, solvers=("proxqp",)):
    return {"solvers": list(solvers), "tolerance": tolerance, "reference_tolerance": 1e-8}


def test_the_keys_are_the_designs_and_the_values_are_json():
    metrics = compute_metrics(make_record())
    assert list(metrics) == DESIGN_KEYS
    assert json.loads(json.dumps(metrics, allow_nan=False)) == metrics
    assert metrics["versions"]["iiwa_dnn"] == "0.1.0"
    assert "versions" not in metrics["settings"]


def test_position_error_is_a_distance_and_its_mean_square_is_over_axes():
    # 3-4-12 gives 13 at one of 11 samples.
    record = sample(make_record(), "position", 4, [3e-3, -4e-3, 12e-3])
    metrics = compute_metrics(record)
    assert metrics["max_position_error_m"] == pytest.approx(13e-3, rel=1e-14)
    assert metrics["mse_position_error_m2"] == pytest.approx(169e-6 / 33.0, rel=1e-14)
    np.testing.assert_array_equal(position_error(record)[4], [3e-3, -4e-3, 12e-3])


def test_the_error_is_actual_minus_desired():
    position, desired = np.arange(33.0).reshape(11, 3), np.full((11, 3), 2.0)
    record = make_record(position=position, position_desired=desired)
    np.testing.assert_array_equal(position_error(record), position - 2.0)
    assert compute_metrics(record)["mse_position_error_m2"] == np.mean((position - 2.0) ** 2)


def test_the_last_sample_counts():
    record = sample(make_record(), "position", -1, [0.0, 0.0, 2e-6])
    assert compute_metrics(record)["max_position_error_m"] == 2e-6


@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 3.0, np.pi - 1e-9])
def test_orientation_error_keeps_its_digits_near_zero_and_near_pi(angle):
    rng = np.random.default_rng(3)
    rotation_desired = rotation_about(rng.normal(size=3), rng.uniform(0.0, 3.0, 11))
    turn = rotation_about(rng.normal(size=3), np.full(11, angle))
    record = make_record(rotation=turn @ rotation_desired, rotation_desired=rotation_desired)
    np.testing.assert_allclose(orientation_error(record), angle, rtol=1e-12, atol=5e-16)
    expected = pytest.approx(angle, rel=1e-12, abs=5e-16)
    assert compute_metrics(record)["max_orientation_error_rad"] == expected


def test_joint_drift_is_from_start_to_end_only():
    record = sample(make_record(), "q", 0, 0.25)
    record = sample(record, "q", (-1, 2), -0.5)
    record = sample(record, "q", 5, 2.0)
    assert compute_metrics(record)["joint_drift_rad"] == 0.75
    assert compute_metrics(sample(record, "q", (-1, 4), 1.5))["joint_drift_rad"] == 1.25


def test_times_and_kinetic_index():
    metrics = compute_metrics(sample(make_record(), "kinetic_index", 7, 0.0454))
    assert metrics["max_kinetic_index"] == 0.0454
    assert (metrics["steps"], metrics["dt_s"]) == (10, 0.1)
    assert metrics["duration_s"] == pytest.approx(1.0)
    assert metrics["wall_time_s"] == 0.5
    assert metrics["realtime_factor"] == pytest.approx(2.0)
    unknown = compute_metrics(dataclasses.replace(make_record(), wall_time_s=None))
    assert unknown["wall_time_s"] is unknown["realtime_factor"] is None


def test_limits():
    inside = sample(make_record(), "q", (2, 3), -2.5)
    assert compute_metrics(inside)["position_limit_violation_rad"] == 0.0
    low = sample(inside, "q", (2, 3), -2.75)
    assert compute_metrics(low)["position_limit_violation_rad"] == 0.25
    high = sample(low, "q", (10, 6), 3.0)
    assert compute_metrics(high)["position_limit_violation_rad"] == 0.5
    fast = sample(make_record(), "dq", (9, 1), -1.75)
    assert compute_metrics(fast)["velocity_limit_violation_rad_s"] == 0.25
    unlimited = make_record(q=high.q, settings={"q_lower": [-np.inf] * 7, "q_upper": [np.inf] * 7})
    assert compute_metrics(unlimited)["position_limit_violation_rad"] == 0.0


def test_crosscheck_counts_only_what_is_believed():
    record = make_record(steps=6, solvers=("proxqp", "osqp"))
    gap = np.full((6, 2), 1e-9)
    objective, residual = np.full((6, 2), 1e-11), np.full((6, 2), 1e-10)
    gap[1, 1] = 2e-6  # disagrees
    gap[2, 0], residual[2, 0], objective[2, 0] = 5.0, 1e-3, 7.0  # inaccurate: not believed
    gap[3, 1], residual[3, 1], objective[3, 1] = np.inf, np.inf, np.inf  # no answer
    gap[4, 0], residual[4, 0], objective[4, 0] = np.nan, np.nan, np.nan  # not asked
    record = dataclasses.replace(
        record, solution_gap=gap, objective_gap=objective, reference_residual=residual
    )
    assert compute_metrics(record)["crosscheck"] == {
        "solver": "proxqp+osqp",
        "steps_checked": 5,
        "kinds": {"own": 5, "scaled": 0, "softened": 0, "held": 0, "stopped": 0},
        "disagreements": 1,
        "reference_failures": 2,
        "max_solution_gap": 2e-6,
        "max_objective_gap": 1e-11,
        "max_reference_residual": 1e-3,
        "max_excess": 0.0,
        "judged": True,
        "tolerance": 1e-6,
        "first_disagreement": {
            "step": 1,
            "time_s": pytest.approx(0.1),
            "solver": "osqp",
            "gap": 2e-6,
        },
    }
    assert failures(record) == [
        "step 1 (t = 0.1 s): osqp differs by 2e-06 rad/s, tolerance 1e-06; 1 step disagrees in all",
        "2 reference answers missing or not accurate enough to judge by (proxqp+osqp); "
        "the check 'proof' needs no other solver",
        "1 step of 6 not checked",
    ]
    assert failures(compute_metrics(record)) == failures(record)


def test_the_solver_that_differs_most_is_named():
    gap = np.array([[3e-6, 9e-6]])
    record = make_record(steps=1, solvers=("proxqp", "osqp"), solution_gap=gap)
    assert compute_metrics(record)["crosscheck"]["first_disagreement"]["solver"] == "osqp"
    assert compute_metrics(record)["crosscheck"]["disagreements"] == 1


def test_in_continuous_mode_the_gap_is_a_lag_and_not_judged():
    record = make_record(solution_gap=np.full((10, 1), 0.1), settings={"mode": "continuous"})
    check = compute_metrics(record)["crosscheck"]
    assert (check["judged"], check["disagreements"], check["first_disagreement"]) == (
        False,
        0,
        None,
    )
    assert check["max_solution_gap"] == 0.1
    assert failures(dataclasses.replace(record, kkt_residual=np.full(10, 0.3))) == []


def test_proofs_are_counted_and_what_is_not_proven_is_a_failure():
    bounds = np.full((10, 1), 1e-12)
    residual = np.zeros((10, 1))
    fields = {
        "solvers": ("proof",), "solution_gap": bounds, "reference_residual": residual,
        "objective_gap": np.full((10, 1), np.nan),
    }  # fmt: skip
    record = make_record(**fields)
    check = compute_metrics(record)["crosscheck"]
    assert (check["proven"], check["reference_failures"], check["steps_checked"]) == (10, 0, 10)
    assert check["max_solution_gap"] == 1e-12
    assert failures(record) == []
    bounds[3] = residual[3] = np.inf
    bounds[5] = 1e-3
    record = make_record(**fields)
    check = compute_metrics(record)["crosscheck"]
    assert (check["proven"], check["reference_failures"], check["disagreements"]) == (9, 1, 1)
    assert failures(record) == [
        "step 5 (t = 0.5 s): proven within 0.001 rad/s of the exact solution alone, "
        "tolerance 1e-06; 1 step in all",
        "1 step not proven",
    ]


def test_without_a_check():
    metrics = compute_metrics(make_record(solvers=()))
    check = metrics["crosscheck"]
    assert (check["solver"], check["steps_checked"], check["judged"]) == ("none", 0, False)
    assert check["max_solution_gap"] is check["max_reference_residual"] is None
    assert failures(metrics) == []


def test_a_tolerance_of_1e_18_is_failed_and_said_so():
    record = heart_record(steps=1000, check=check_of(1e-18), q_upper=[3.0] * 7)
    gap = np.full((1000, 1), 3.14e-15)
    gap[:17] = gap[500] = 0.0
    record = dataclasses.replace(record, solution_gap=gap)
    assert failures(record) == [
        "step 17 (t = 0.17 s): proxqp differs by 3.14e-15 rad/s, tolerance 1e-18; "
        "982 steps disagree in all"
    ]


def test_a_wrong_answer_that_is_not_a_number_is_a_disagreement():
    record = sample(make_record(), "solution_gap", 3, np.nan)  # its residual is finite
    check = compute_metrics(record)["crosscheck"]
    assert (check["steps_checked"], check["disagreements"]) == (10, 1)
    assert check["first_disagreement"]["step"] == 3
    assert check["first_disagreement"]["gap"] is None
    assert failures(record)


@pytest.mark.parametrize("value", [2e-9, np.nan, np.inf])
def test_an_unsolved_step(value):
    record = sample(make_record(), "kkt_residual", [4, 6], value)
    shown = {2e-9: "2e-09"}.get(value, str(value))
    assert failures(record) == [
        f"step 4 (t = 0.4 s): KKT residual {shown}, tolerance 1e-09; 2 steps unsolved in all"
    ]
    assert len(failures(compute_metrics(record))) == 1


def test_a_residual_at_its_tolerance_is_solved():
    assert failures(sample(make_record(), "kkt_residual", 4, 1e-9)) == []


def test_a_broken_limit_names_joint_and_time():
    record = sample(make_record(), "q", (3, 5), 2.6)
    record = sample(record, "dq", (2, 0), -2.0)
    assert failures(record) == [
        "joint position limit broken by 0.1 rad; joint 6 at step 3 (t = 0.3 s)",
        "joint velocity limit broken by 0.5 rad/s; joint 1 at step 2 (t = 0.2 s)",
    ]
    assert failures(compute_metrics(record)) == [
        "joint position limit broken by 0.1 rad",
        "joint velocity limit broken by 0.5 rad/s",
    ]


def test_acceleration_and_jerk_are_judged_where_the_scheme_limits_them():
    record, n = make_record(), 7
    dt, dq = record.settings["dt"], np.array(record.dq)
    rates = {"ddq_max": [None] * n, "dddq_max": [None] * n}
    free = dataclasses.replace(record, settings=record.settings | rates)
    assert compute_metrics(free)["jerk_limit_violation_rad_s3"] == 0.0
    padded = np.vstack([np.zeros((2, n)), dq])
    most = [np.abs(np.diff(padded, order, axis=0)).max(axis=0) / dt**order for order in (1, 2)]
    rates = {"ddq_max": most[0].tolist(), "dddq_max": most[1].tolist()}
    at_limit = dataclasses.replace(record, settings=record.settings | rates)
    assert failures(at_limit) == []
    rates = {"ddq_max": (most[0] - 0.5).tolist(), "dddq_max": (most[1] - 3.0).tolist()}
    broken = dataclasses.replace(record, settings=record.settings | rates)
    acceleration, jerk = failures(broken)
    assert acceleration.startswith("joint acceleration limit broken by 0.5 rad/s^2; joint ")
    assert jerk.startswith("joint jerk limit broken by 3 rad/s^3; joint ")
    assert failures(compute_metrics(broken))[1] == "joint jerk limit broken by 3 rad/s^3"


def test_rounding_at_a_limit_is_forgiven():
    assert failures(sample(make_record(), "q", (3, 5), 2.5 + 1e-12)) == []
    assert failures(sample(make_record(), "q", (3, 5), 2.5 + 1e-8))


@pytest.mark.parametrize("name", ["q", "dq", "position"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_is_no_success(name, value):
    record = sample(make_record(settings={"mode": "continuous"}), name, 5, value)
    metrics = compute_metrics(record)
    json.dumps(metrics, allow_nan=False)
    assert failures(record) == failures(metrics) != []
    assert "not finite" in failures(record)[0]


def test_an_early_end():
    record = make_record(steps=3, settings={"duration": 1.0, "status": "step 3 has no solution"})
    assert failures(record) == [
        "path completed 30.0 %",
        "ended after 3 of 10 steps: step 3 has no solution",
    ]
    whole = make_record(settings={"infeasible_step": 3, "dt": 0.1})
    assert failures(whole)[0].endswith(
        "as at step 3 (t = 0.3 s): the path is too quick, or out of reach"
    )
    nothing = make_record(steps=0, settings={"duration": 1.0, "status": "interrupted"})
    metrics = compute_metrics(nothing)
    assert metrics["max_kinetic_index"] is metrics["max_kkt_residual"] is None
    assert metrics["velocity_limit_violation_rad_s"] == 0.0
    assert failures(metrics) == ["path completed 0.0 %", "ended after 0 of 10 steps: interrupted"]


def test_a_good_run_has_no_reasons():
    assert failures(make_record()) == failures(compute_metrics(make_record())) == []


ROWS = [
    {"part": "Obstacle", "row": 1},
    {"part": "CollisionAvoidance", "row": 1},
    {"part": "CollisionAvoidance", "row": 2},
]


def test_the_policies_are_named_with_their_steps():
    record = make_record(action=[0, 2, 3, 3, 2, 2, 4, 0, 0, 0], fraction=np.ones(10))
    (reason, slowed_down, programs) = failures(record)
    assert programs == (
        "4 own, 3 scaled, 2 softened programs checked, 1 stopped, with nothing to check"
    )
    assert reason.startswith("6 steps without a solution (3 slowed, 2 relaxed, 1 stopped), the")
    assert slowed_down == "slowed: path time 1 s after 1 s"


def test_what_would_suffice_does_and_less_does_not():
    """A circle at a third of the speed that it needs, and then at what the report says."""

    def run_at(velocity: float, duration: float = 3.0, period: float = 3.0) -> Record:
        start = paper_start()
        circle = Circle(0.02, period=period).anchored(start)
        robot = paper_robot().with_limits(velocity=velocity)
        options = {"dt": 5e-3, "duration": duration, "check": CrossCheck(())}
        return simulate(robot, DoubleIndicator(), circle, PAPER_Q0, **options)

    slow = run_at(0.05)
    needed = compute_metrics(slow)["incidents"]["needed"]
    pattern = (
        r"needs ([\d.]+) times .* iiwa7_joint_(\d)'s, or \1 times as long a time \(--period "
        r"([\d.]+) --duration \3\); .* after about ([\d.]+) s \(--duration \4\)"
    )
    reasons = failures(slow)
    said = re.search(pattern, reasons[2])
    assert float(said[3]) == pytest.approx(3.0 * float(said[1]))
    ratio = float(said[1])
    assert 0.0 <= ratio - 1.02 * needed["speed_ratio"] < 0.1 + 1e-9
    assert int(said[2]) == needed["joint"]
    assert failures(run_at(0.05 * ratio)) == []
    assert failures(run_at(0.05, 3.0 * ratio, 3.0 * ratio)) == []
    assert "what was drawn needs" in reasons[2]
    assert failures(run_at(0.05 * ratio * 0.9)) != []
    later = run_at(0.05, float(said[4]))
    assert later.path_time == pytest.approx(3.0, rel=0.1)
    assert later.path_completed > 0.9  # of one round
    assert compute_metrics(later)["incidents"]["needed"]["time_s"] == pytest.approx(
        needed["time_s"], rel=0.1
    )


def test_what_would_suffice_is_not_said_of_other_limits():
    fraction = [0.5] * 4 + [1.0] * 6
    fast = np.zeros((10, 7), int)
    fast[:4, 3] = 2
    assert "needs" in failures(slowed(fraction, blocking=fast))[2]
    away = np.zeros((11, 3))
    away[:3, 0] = 0.1  # slowed on the way to a path that begins elsewhere
    assert "needs" not in failures(slowed(fraction, blocking=fast, position=away))[2]
    fast[2, 1] = 1  # a position limit: speed alone does not help
    assert "needs" not in failures(slowed(fraction, blocking=fast))[2]
    assert "needs" not in failures(slowed(fraction))[2]


def slowed(fraction, **changes):
    """A run whose clock went on by these shares of a control period."""
    action = np.where(np.asarray(fraction) < 1.0, 2, 0)
    return make_record(action=action, fraction=fraction, **changes)


@pytest.mark.parametrize(
    ("fraction", "share", "words"),
    [
        (np.zeros(10), 0.0, "path completed 0.0 %"),  # a start on a singular pose
        (np.full(10, 0.25), 0.25, "path completed 25.0 %"),
        ([1.0] * 9 + [0.99999], 0.999999, "path completed 99.9 %"),
    ],
)
def test_a_path_that_is_not_completed_is_the_first_reason(fraction, share, words):
    record = slowed(fraction)
    assert compute_metrics(record)["path_completed"] == pytest.approx(share)
    assert failures(record)[0] == failures(compute_metrics(record))[0] == words
    assert compute_metrics(record)["max_position_error_m"] == 0.0  # to the slowed target


def test_a_completed_path():
    assert compute_metrics(make_record())["path_completed"] == 1.0
    # Of 9.6 steps ten were asked for: a duration is rounded to whole steps.
    assert compute_metrics(make_record(settings={"duration": 0.96}))["path_completed"] == 1.0
    relaxed = make_record(action=np.full(10, 3), fraction=np.ones(10))
    assert compute_metrics(relaxed)["path_completed"] == 1.0
    old = compute_metrics(make_record())
    del old["path_completed"]  # metrics of an older version
    assert failures(old) == []


def test_active_rows_are_counted_with_their_multipliers():
    multiplier = np.zeros((10, 3))
    multiplier[4:6, 1] = 0.1, 0.3
    multiplier[7, 1], multiplier[9, 2] = 0.2, 1e-12
    record = make_record(row_multiplier=multiplier, settings={"rows": ROWS})
    incidents = compute_metrics(record)["incidents"]
    assert incidents["active_rows"] == [
        {
            "part": "CollisionAvoidance", "row": 1, "steps": 3, "time_s": pytest.approx(0.3),
            "first_s": pytest.approx(0.4), "max_multiplier": 0.3,
            "mean_multiplier": pytest.approx(0.2),
        },
        {
            "part": "CollisionAvoidance", "row": 2, "steps": 1, "time_s": 0.1,
            "first_s": pytest.approx(0.9), "max_multiplier": 1e-12, "mean_multiplier": 1e-12,
        },
    ]  # fmt: skip
    assert incidents["blocking_rows"] == incidents["active_bounds"] == []
    assert failures(record) == []


def test_rows_in_the_way_are_named():
    blocking, rows = np.zeros((10, 7), int), np.zeros((10, 3), int)
    blocking[2, 4], rows[2:9, 0], rows[5:9, 2] = -1, 1, 1
    record = slowed(
        [1.0] * 2 + [0.5] * 7 + [1.0],
        blocking=blocking, blocking_rows=rows, settings={"rows": ROWS},
    )  # fmt: skip
    found = compute_metrics(record)["incidents"]["blocking_rows"]
    first = {"steps": 7, "time_s": pytest.approx(0.7), "first_s": pytest.approx(0.2)}
    assert found[0] == {"part": "Obstacle", "row": 1, **first}
    assert [row["row"] for row in found] == [1, 2]
    assert failures(record)[1] == (
        "7 steps without a solution (7 slowed), the first at step 2 (t = 0.2 s), against "
        "joint 5 lower position limit, row 1 of Obstacle; most often in the way: "
        "row 1 of Obstacle, row 2 of CollisionAvoidance, joint 5 lower position limit"
    )
    kept = "row 1 of Obstacle kept the tip up to {} m off the path"
    helps = (
        "; move the obstacle or the path, keep less distance, "
        "or take the policy relax, which is in time and leaves the path"
    )
    assert failures(record)[2].endswith(kept.format(0) + helps)
    off = sample(record, "position", 9, [0.0, 0.04, 0.0])
    assert failures(off)[2].endswith(kept.format(0.04) + ", which no longer time mends" + helps)
    off = sample(record, "position", 10, [0.0, 0.04, 0.0])  # when no row was in the way
    assert failures(off)[2].endswith(kept.format(0) + helps)
    away = sample(record, "position_desired", 0, record.position[0] + [0.0, 0.3, 0.4])
    assert failures(away)[1] == failures(record)[1] + "; the path begins 0.5 m from the tip"


def test_each_kind_of_bound_has_its_own_multipliers():
    """A joint at its upper position limit first, at its velocity limit later."""
    multiplier, dq = np.zeros((10, 7)), np.zeros((10, 7))
    multiplier[1:3, 0], multiplier[6:9, 0], dq[6:9, 0] = 0.5, 0.25, 1.5
    record = make_record(bound_multiplier=multiplier, dq_solver=dq)
    found = compute_metrics(record)["incidents"]["active_bounds"]
    assert [(bound["limit"], bound["side"], bound["steps"]) for bound in found] == [
        ("position", "upper", 2),
        ("velocity", "upper", 3),
    ]
    assert [(bound["max_multiplier"], bound["mean_multiplier"]) for bound in found] == [
        (0.5, 0.5),
        (0.25, 0.25),
    ]


def test_the_largest_turn_counts_and_time_from_the_first_sample():
    turn = rotation_about([0.0, 0.0, 1.0], np.linspace(0.0, 0.5, 11))
    metrics = compute_metrics(make_record(rotation=turn, t=5.0 + 0.1 * np.arange(11)))
    assert metrics["max_orientation_error_rad"] == pytest.approx(0.5)
    assert metrics["duration_s"] == pytest.approx(1.0)


def test_a_gap_and_a_reference_at_their_tolerance_are_within_it():
    record = make_record(
        solution_gap=np.full((10, 1), 1e-6), reference_residual=np.full((10, 1), 1e-8)
    )
    check = compute_metrics(record)["crosscheck"]
    assert (check["disagreements"], check["reference_failures"]) == (0, 0)
    assert check["max_solution_gap"] == 1e-6


def test_clipped_steps_and_bounds_in_the_way():
    clipped, blocking = np.zeros((10, 7), int), np.zeros((10, 7), int)
    clipped[2:5, 3] = clipped[4, 1] = 1
    blocking[6, 0], blocking[7, 0], blocking[7, 6] = 2, 1, -1
    record = make_record(clipped=clipped, blocking=blocking, action=np.eye(10, dtype=int)[6] * 9)
    incidents = compute_metrics(record)["incidents"]
    assert incidents["clipped_steps"] == 3
    assert incidents["first"] == {
        "step": 6,
        "time_s": pytest.approx(0.6),
        "action": "unknown",
        "against": [{"joint": 1, "side": "upper", "limit": "velocity"}],
    }
    assert incidents["blocking"] == [
        {"joint": joint, "side": side, "limit": limit, "steps": 1, "time_s": 0.1, "first_s": first}
        for joint, side, limit, first in (
            (1, "upper", "position", pytest.approx(0.7)),
            (1, "upper", "velocity", pytest.approx(0.6)),
            (7, "lower", "position", pytest.approx(0.7)),
        )
    ]


def test_a_bound_is_the_velocity_limit_only_at_that_speed():
    multiplier, dq = np.zeros((10, 7)), np.zeros((10, 7))
    multiplier[:, 2], dq[:, 2] = -0.5, -1.2  # slower than the limit of 1.5 rad/s
    record = make_record(bound_multiplier=multiplier, dq_solver=dq)
    (bound,) = compute_metrics(record)["incidents"]["active_bounds"]
    assert (bound["side"], bound["limit"], bound["max_multiplier"]) == ("lower", "position", 0.5)


def test_reasons_to_the_letter():
    residual = np.full(10, 1e-9)
    residual[[3, 8]] = 2.3456e-9, np.inf  # the others are at their tolerance, and solved
    assert failures(make_record(kkt_residual=residual)) == [
        "step 3 (t = 0.3 s): KKT residual 2.35e-09, tolerance 1e-09; 2 steps unsolved in all"
    ]
    residual[8] = 0.0
    assert failures(compute_metrics(make_record(kkt_residual=residual))) == [
        "largest KKT residual 2.35e-09, tolerance 1e-09"
    ]
    lost = sample(make_record(settings={"mode": "continuous"}), "position", 5, np.nan)
    assert failures(lost) == ["the tip position is not finite at every step"]
    nowhere = sample(make_record(), "solution_gap", 3, np.nan)
    assert "proxqp differs by not a number rad/s" in failures(nowhere)[0]
    limits = {"q_upper": [0.0] * 7}
    assert failures(sample(make_record(settings=limits), "q", (3, 5), 1e-9)) == []


def test_three_limits_in_the_way_are_named_and_digits_are_few():
    blocking = np.zeros((10, 7), int)
    for joint in range(4):
        blocking[: 8 - joint, joint] = 1
    reason, clock = failures(slowed([1.0 / 3.0] * 8 + [1.0] * 2, blocking=blocking))[1:3]
    assert reason.endswith("in the way: " + ", ".join(
        f"joint {joint} upper position limit" for joint in (1, 2, 3)
    ))  # fmt: skip
    assert clock == "slowed: path time 0.466667 s after 1 s"
    not_finite = sample(make_record(settings={"mode": "continuous"}), "q", 5, np.nan)
    assert failures(not_finite) == ["a joint position is not finite"]
    residual = np.array([0.0, 0.0, 3e-9, 5e-9, *[0.0] * 6])
    assert failures(make_record(kkt_residual=residual))[0].startswith("step 2 (t = 0.2 s): KKT r")
    assert "residual 3e-09" in failures(make_record(kkt_residual=residual))[0]


KINDS = np.array([0, 0, 1, 2, 2, 2, 3, 3, 3, 4])


def test_each_kind_of_program_is_counted_and_a_stopped_step_has_nothing_to_check():
    gap = np.full((10, 1), 1e-9)
    gap[9] = 1.0  # of the stopped step: nobody is to be asked there
    check = compute_metrics(make_record(kind=KINDS, solution_gap=gap))["crosscheck"]
    assert check["kinds"] == {"own": 2, "scaled": 1, "softened": 3, "held": 3, "stopped": 1}
    assert (check["steps_checked"], check["disagreements"]) == (9, 0)
    record = make_record(kind=KINDS)
    assert failures(record) == [
        "2 own, 1 scaled, 3 softened programs checked, "
        "3 held back, checked for their bounds alone, 1 stopped, with nothing to check"
    ]
    gap[7] = 1e-3  # the velocity that was wanted at a step held back
    wrong = compute_metrics(make_record(kind=KINDS, solution_gap=gap))["crosscheck"]
    assert (wrong["disagreements"], wrong["first_disagreement"]["step"]) == (1, 7)
    nobody = compute_metrics(make_record(solvers=(), kind=KINDS))["crosscheck"]["kinds"]
    assert nobody == {"own": 0, "scaled": 0, "softened": 0, "held": 3, "stopped": 1}


@pytest.mark.parametrize("value", [1.1e-9, 0.3, np.nan])
def test_a_command_outside_of_its_steps_bounds_disagrees(value):
    excess = np.zeros(10)
    excess[[2, 9]], excess[6] = 1e-9, value
    record = make_record(kind=KINDS, excess=excess)
    check = compute_metrics(record)["crosscheck"]
    assert check["disagreements"] == 1
    assert check["first_disagreement"]["solver"] == "bounds"
    assert "step 6 (t = 0.6 s): the command is " in failures(record)[0]
    assert "tolerance 1e-09; 1 step disagrees in all" in failures(record)[0]
    both = dataclasses.replace(record, solution_gap=np.where(excess > 0.0, 1e-3, 0.0)[:, None])
    assert compute_metrics(both)["crosscheck"]["disagreements"] == 2  # not that of step 9
    lag = make_record(excess=excess, settings={"mode": "continuous"})
    assert compute_metrics(lag)["crosscheck"]["disagreements"] == 0


def test_who_judged_is_counted():
    judge = np.array([[0, 0], [0, 1], [1, 0], [-1, 0]])
    record = make_record(steps=4, solvers=("proxqp", "osqp"), judge=judge)
    assert compute_metrics(record)["crosscheck"]["judged_by"] == {"proxqp": 3, "osqp": 4}
    alone = make_record(steps=4, judge=judge[:, :1])
    assert compute_metrics(alone)["crosscheck"]["judged_by"] == {"proxqp": 2, "osqp": 1}


def test_a_run_says_how_hard_it_was():
    multiplier, rows = np.zeros((10, 7)), np.zeros((10, 3))
    multiplier[2:4, 1], rows[3:7, 2] = -0.5, 1.0
    record = make_record(
        bound_multiplier=multiplier,
        row_multiplier=rows,
        iterations=np.arange(10),
        settings={"rows": ROWS},
    )
    metrics = compute_metrics(record)
    assert metrics["active_limit_steps"] == 5
    assert metrics["network_iterations"] == {"mean": 4.5, "max": 9}
    assert compute_metrics(make_record())["active_limit_steps"] == 0


def test_a_path_from_a_file_is_stretched():
    fast = np.zeros((10, 7), int)
    fast[:4, 3] = 2
    settings = {"reference": {"name": "waypoints"}}
    dq = 0.9 * np.eye(7)[[3] * 10]  # of 1.5 rad/s, at half the path's speed: 1.2, and 2 % more
    record = slowed([0.5] * 4 + [1.0] * 6, blocking=fast, settings=settings, dq_solver=dq)
    assert "(--stretch 1.3 times as large)" in failures(record)[2]


def test_joints_go_by_their_names():
    blocking = np.zeros((10, 7), int)
    blocking[3, 4] = -1
    names = {"joints": [f"arm_{letter}" for letter in "abcdefg"]}
    record = slowed([0.5] * 4 + [1.0] * 6, blocking=blocking, settings=names)
    assert "in the way: arm_e lower position limit" in failures(record)[1]
    broken = make_record(q=np.full((11, 7), 2.6), settings=names)
    assert failures(broken)[0].endswith("; arm_a at step 0 (t = 0 s)")
