"""Each metric against a value worked out by hand; each reason to fail against its cause."""

from __future__ import annotations

import dataclasses
import json
import re

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_records import make_record
from helpers_simulation import paper_robot, paper_start
from iiwa_dnn import Circle, CrossCheck, DoubleIndicator, Record, simulate
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics, orientation_error, position_error

KEYS = {
    "path_completed", "max_position_error_m", "mse_position_error_m2", "max_orientation_error_rad",
    "joint_drift_rad", "max_kinetic_index", "steps", "dt_s", "duration_s", "wall_time_s",
    "realtime_factor", "position_limit_violation_rad", "velocity_limit_violation_rad_s",
    "max_kkt_residual", "crosscheck", "settings", "versions",
}  # fmt: skip
ROWS = [
    {"part": "Obstacle", "row": 1},
    {"part": "CollisionAvoidance", "row": 1},
    {"part": "CollisionAvoidance", "row": 2},
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


def slowed(fraction, **changes):
    """A run whose clock went on by these fractions of a control period."""
    action = np.where(np.asarray(fraction) < 1.0, 2, 0)
    return make_record(action=action, fraction=fraction, **changes)


def test_the_keys_are_there_and_the_values_are_json():
    metrics = compute_metrics(make_record())
    assert set(metrics) >= KEYS
    assert json.loads(json.dumps(metrics, allow_nan=False)) == metrics
    assert metrics["versions"]["iiwa_dnn"] == "0.1.0"
    assert "versions" not in metrics["settings"]
    assert failures(make_record()) == failures(metrics) == []
    for wrong in (None, {}, "run"):
        with pytest.raises(InvalidInputError, match="must be a record or its metrics"):
            failures(wrong)


def test_position_error_is_a_distance_and_its_mean_square_is_over_axes():
    # 3-4-12 gives 13 at one of 11 samples.
    record = sample(make_record(), "position", -1, [3e-3, -4e-3, 12e-3])
    metrics = compute_metrics(record)
    assert metrics["max_position_error_m"] == pytest.approx(13e-3, rel=1e-14)
    assert metrics["mse_position_error_m2"] == pytest.approx(169e-6 / 33.0, rel=1e-14)
    np.testing.assert_array_equal(position_error(record)[-1], [3e-3, -4e-3, 12e-3])


@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 3.0, np.pi - 1e-9])
def test_orientation_error_keeps_its_digits_near_zero_and_near_pi(angle):
    rng = np.random.default_rng(3)
    rotation_desired = rotation_about(rng.normal(size=3), rng.uniform(0.0, 3.0, 11))
    turn = rotation_about(rng.normal(size=3), angle * np.linspace(0.0, 1.0, 11))
    record = make_record(rotation=turn @ rotation_desired, rotation_desired=rotation_desired)
    expected = angle * np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(orientation_error(record), expected, rtol=1e-12, atol=5e-16)
    largest = pytest.approx(angle, rel=1e-12, abs=5e-16)
    assert compute_metrics(record)["max_orientation_error_rad"] == largest


def test_drift_times_and_kinetic_index():
    record = sample(sample(make_record(), "q", 0, 0.25), "q", (-1, 2), -0.5)
    record = sample(sample(record, "q", 5, 2.0), "kinetic_index", 7, 0.0454)
    metrics = compute_metrics(dataclasses.replace(record, t=5.0 + record.t))
    assert metrics["joint_drift_rad"] == 0.75  # from start to end only
    assert metrics["max_kinetic_index"] == 0.0454
    assert (metrics["steps"], metrics["dt_s"], metrics["wall_time_s"]) == (10, 0.1, 0.5)
    assert metrics["duration_s"] == pytest.approx(1.0)
    assert metrics["realtime_factor"] == pytest.approx(2.0)
    unknown = compute_metrics(dataclasses.replace(make_record(), wall_time_s=None))
    assert unknown["wall_time_s"] is unknown["realtime_factor"] is None


def test_broken_limits_name_joint_and_time_and_rounding_is_forgiven():
    inside = sample(make_record(), "q", (2, 3), -2.5)
    assert compute_metrics(inside)["position_limit_violation_rad"] == 0.0
    assert failures(sample(inside, "q", (3, 5), 2.5 + 1e-12)) == []
    record = sample(sample(inside, "q", (3, 5), 2.6), "q", (4, 5), -2.55)
    record = sample(record, "dq", (2, 0), -2.0)
    assert failures(record) == [
        "joint position limit broken by 0.1 rad; joint 6 at step 3 (t = 0.3 s)",
        "joint velocity limit broken by 0.5 rad/s; joint 1 at step 2 (t = 0.2 s)",
    ]
    unlimited = {"q_lower": [-np.inf] * 7, "q_upper": [np.inf] * 7}
    free = make_record(q=record.q, settings=unlimited)
    assert compute_metrics(free)["position_limit_violation_rad"] == 0.0


def test_acceleration_and_jerk_are_judged_where_the_scheme_limits_them():
    rng = np.random.default_rng(1)
    dq = rng.uniform(-1.0, 1.0, (10, 7))
    padded = np.vstack([np.zeros((2, 7)), dq])
    most = [np.abs(np.diff(padded, order, axis=0)).max(axis=0) / 0.1**order for order in (1, 2)]
    free = make_record(dq=dq, settings={"ddq_max": [None] * 7, "dddq_max": [None] * 7})
    assert compute_metrics(free)["jerk_limit_violation_rad_s3"] == 0.0
    at_limit = make_record(dq=dq, settings={"ddq_max": most[0], "dddq_max": most[1]})
    assert failures(at_limit) == []
    broken = make_record(dq=dq, settings={"ddq_max": most[0] - 0.5, "dddq_max": most[1] - 3.0})
    acceleration, jerk = failures(broken)
    assert acceleration.startswith("joint acceleration limit broken by 0.5 rad/s²; joint ")
    assert jerk.startswith("joint jerk limit broken by 3 rad/s³; joint ")


@pytest.mark.parametrize("name", ["q", "dq", "position"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_is_no_success(name, value):
    record = sample(make_record(settings={"mode": "continuous"}), name, 5, value)
    json.dumps(compute_metrics(record), allow_nan=False)
    assert "not finite" in failures(record)[0]


def test_crosscheck_counts_only_what_is_believed():
    record = make_record(steps=6, solvers=("proxqp", "osqp"))
    gap = np.full((6, 2), 1e-9)
    objective, residual = np.full((6, 2), 1e-11), np.full((6, 2), 1e-10)
    gap[0], residual[0] = 1e-6, 1e-8  # at their tolerances
    gap[1] = 3e-6, 9e-6  # disagree
    gap[2, 0], residual[2, 0], objective[2, 0] = 5.0, 1e-3, 7.0  # inaccurate: not believed
    gap[3, 1], residual[3, 1], objective[3, 1] = np.inf, np.inf, np.inf  # no answer
    gap[4, 0], residual[4, 0], objective[4, 0] = np.nan, np.nan, np.nan  # not asked
    record = dataclasses.replace(
        record, solution_gap=gap, objective_gap=objective, reference_residual=residual
    )
    found = compute_metrics(record)["crosscheck"]
    assert found.pop("first_disagreement") == {
        "step": 1, "time_s": pytest.approx(0.1), "solver": "osqp", "gap": 9e-6,
    }  # fmt: skip
    assert found == {
        "solver": "proxqp+osqp",
        "steps_checked": 5,
        "kinds": {"own": 5, "scaled": 0, "softened": 0, "held": 0, "stopped": 0},
        "judged_by": {},
        "disagreements": 1,
        "reference_failures": 2,
        "max_solution_gap": 9e-6,
        "max_objective_gap": 1e-11,
        "max_reference_residual": 1e-3,
        "max_excess": 0.0,
        "judged": True,
        "tolerance": 1e-6,
    }
    assert failures(record) == [
        "step 1 (t = 0.1 s): osqp differs by 9e-06 rad/s, tolerance 1e-06; 1 step in all",
        "reference answers missing or not accurate enough to judge by: 2 (proxqp+osqp); "
        "the check 'proof' needs no other solver",
        "1 step of 6 not checked",
    ]


def test_in_continuous_mode_the_gap_is_a_lag_and_not_judged():
    record = make_record(solution_gap=np.full((10, 1), 0.1), settings={"mode": "continuous"})
    check = compute_metrics(record)["crosscheck"]
    assert (check["judged"], check["disagreements"]) == (False, 0)
    assert check["first_disagreement"] is None
    assert check["max_solution_gap"] == 0.1
    assert failures(dataclasses.replace(record, kkt_residual=np.full(10, 0.3))) == []


def test_proofs_are_counted_and_what_is_not_proven_is_a_failure():
    bounds, residual = np.full((10, 1), 1e-12), np.zeros((10, 1))
    fields = {
        "solvers": ("proof",), "solution_gap": bounds, "reference_residual": residual,
        "objective_gap": np.full((10, 1), np.nan),
    }  # fmt: skip
    check = compute_metrics(make_record(**fields))["crosscheck"]
    assert (check["proven"], check["reference_failures"], check["steps_checked"]) == (10, 0, 10)
    assert failures(make_record(**fields)) == []
    bounds[3] = residual[3] = np.inf
    bounds[5] = 1e-3
    check = compute_metrics(make_record(**fields))["crosscheck"]
    assert (check["proven"], check["reference_failures"], check["disagreements"]) == (9, 1, 1)
    assert failures(make_record(**fields)) == [
        "step 5 (t = 0.5 s): proven within 0.001 rad/s of the exact solution alone, "
        "tolerance 1e-06; 1 step in all",
        "1 step not proven",
    ]


def test_a_wrong_answer_that_is_not_a_number_is_a_disagreement():
    record = sample(make_record(), "solution_gap", 3, np.nan)  # its residual is finite
    check = compute_metrics(record)["crosscheck"]
    assert (check["steps_checked"], check["disagreements"]) == (10, 1)
    assert "step 3 (t = 0.3 s): proxqp differs by not a number rad/s" in failures(record)[0]


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
    nobody = compute_metrics(make_record(solvers=(), kind=KINDS))["crosscheck"]
    assert nobody["kinds"] == {"own": 0, "scaled": 0, "softened": 0, "held": 3, "stopped": 1}
    assert (nobody["solver"], nobody["steps_checked"], nobody["judged"]) == ("none", 0, False)
    assert nobody["max_solution_gap"] is nobody["max_reference_residual"] is None
    assert failures(make_record(solvers=())) == []


@pytest.mark.parametrize("value", [1.1e-9, 0.3, np.nan])
def test_a_command_outside_of_its_steps_bounds_disagrees(value):
    excess = np.zeros(10)
    excess[2], excess[6], excess[9] = 1e-9, value, 1.0  # the last is of a stopped step
    record = make_record(kind=KINDS, excess=excess)
    check = compute_metrics(record)["crosscheck"]
    assert check["disagreements"] == 1
    assert check["first_disagreement"]["solver"] == "bounds"
    assert "step 6 (t = 0.6 s): the command is " in failures(record)[0]
    assert "tolerance 1e-09; 1 step in all" in failures(record)[0]
    both = dataclasses.replace(record, solution_gap=np.where(np.arange(10) == 2, 1e-3, 0)[:, None])
    assert compute_metrics(both)["crosscheck"]["disagreements"] == 2
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
        bound_multiplier=multiplier, row_multiplier=rows,
        iterations=np.arange(10), settings={"rows": ROWS},
    )  # fmt: skip
    metrics = compute_metrics(record)
    assert metrics["active_limit_steps"] == 5
    assert metrics["network_iterations"] == {"mean": 4.5, "max": 9}
    assert compute_metrics(make_record())["active_limit_steps"] == 0


@pytest.mark.parametrize("value", [2.3456e-9, np.nan, np.inf])
def test_an_unsolved_step(value):
    residual = np.full(10, 1e-9)  # at the tolerance: solved
    residual[[4, 6]] = value, 1.0
    shown = "2.35e-09" if value < 1.0 else "not a number"
    assert failures(make_record(kkt_residual=residual)) == [
        f"step 4 (t = 0.4 s): KKT residual {shown}, tolerance 1e-09; 2 steps unsolved in all"
    ]


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


def test_the_policies_are_named_with_their_steps():
    action = np.array([0, 0, 0, 2, 3, 4, 2, 0, 0, 0])
    assert failures(make_record(action=action, fraction=np.ones(10))) == [
        "4 steps without a solution (2 slowed, 1 relaxed, 1 stopped), the first at step 3 "
        "(t = 0.3 s); most often in the way: no bound, a singular pose; position error up to 0 m",
        "slowed: 1 s of the path in 1 s",
    ]
    blocking = np.zeros((10, 7), int)
    for joint in range(5):
        blocking[: 8 - joint, joint] = 1
    reason, clock = failures(slowed([1.0 / 3.0] * 8 + [1.0] * 2, blocking=blocking))[1:3]
    limits = "joint 1 upper position limit, joint 2 upper position limit, "
    limits += "joint 3 upper position limit and 2 more"
    assert reason.endswith(f"against {limits}; most often in the way: {limits}")
    assert clock == "slowed: 0.4667 s of the path in 1 s"


@pytest.mark.parametrize(
    ("fraction", "part", "words"),
    [
        (np.zeros(10), 0.0, "path completed 0.0 %"),  # a start on a singular pose
        (np.full(10, 0.25), 0.25, "path completed 25.0 %"),
        ([1.0] * 9 + [0.99999], 0.999999, "path completed 99.9 %"),
    ],
)
def test_a_path_that_is_not_completed_is_the_first_reason(fraction, part, words):
    record = slowed(fraction)
    assert compute_metrics(record)["path_completed"] == pytest.approx(part)
    assert failures(record)[0] == words
    shorter = slowed(fraction, settings={"path_duration": 10.0})
    assert failures(shorter)[0] == f"{words} of the 1 s asked for, the path takes 10 s"
    # Of 9.6 steps ten were asked for: a duration is rounded to whole steps.
    assert compute_metrics(make_record(settings={"duration": 0.96}))["path_completed"] == 1.0


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
    said = re.search(
        r"asks ([\d.]+) times as much of iiwa7_joint_(\d) as its limit: give it \1 times the time "
        r"\(--period ([\d.]+)\); slowed as here, the path takes about ([\d.]+) s",
        failures(slow)[2],
    )
    ratio = float(said[1])
    assert float(said[3]) == pytest.approx(3.0 * ratio)
    assert 0.0 <= ratio - 1.02 * needed["speed_ratio"] < 0.1 + 1e-9
    assert int(said[2]) == needed["joint"]
    assert failures(run_at(0.05 * ratio)) == []
    assert failures(run_at(0.05, 3.0 * ratio, 3.0 * ratio)) == []
    assert failures(run_at(0.05 * ratio * 0.9)) != []
    later = run_at(0.05, float(said[4]))
    assert later.path_time == pytest.approx(3.0, rel=0.1)
    assert later.path_completed > 0.9  # of one round
    assert "path takes" not in failures(run_at(0.05, 1.2 * float(said[4])))[1]


def test_what_would_suffice_is_not_said_of_other_limits():
    fraction = [0.5] * 4 + [1.0] * 6
    fast = np.zeros((10, 7), int)
    fast[:4, 3] = 2
    dq = 0.9 * np.eye(7)[[3] * 10]  # of 1.5 rad/s, at half the path's speed: 1.2, and 2 % more
    record = slowed(fraction, blocking=fast, dq_solver=dq)
    file = dataclasses.replace(record, settings=record.settings | {"reference": {"name": "file"}})
    assert "give it 1.3 times the time (--stretch)" in failures(file)[2]
    away = np.zeros((11, 3))
    away[:3, 0] = 0.1  # slowed on the way to a path that begins elsewhere
    assert "give it" not in failures(slowed(fraction, blocking=fast, position=away))[2]
    fast[2, 1] = 1  # a position limit: speed alone does not help
    assert "give it" not in failures(slowed(fraction, blocking=fast))[2]
    assert "give it" not in failures(slowed(fraction))[2]


def test_active_rows_are_counted_with_their_multipliers():
    multiplier = np.zeros((10, 3))
    multiplier[4:6, 1] = 0.1, 0.3
    multiplier[7, 1], multiplier[9, 2] = 0.2, 1e-12
    record = make_record(row_multiplier=multiplier, settings={"rows": ROWS})
    incidents = compute_metrics(record)["incidents"]
    first, second = incidents["active_rows"]
    assert first == {
        "part": "CollisionAvoidance", "row": 1, "steps": 3, "time_s": pytest.approx(0.3),
        "first_s": pytest.approx(0.4), "max_multiplier": 0.3,
        "mean_multiplier": pytest.approx(0.2),
    }  # fmt: skip
    assert (second["row"], second["steps"], second["max_multiplier"]) == (2, 1, 1e-12)
    assert incidents["blocking_rows"] == incidents["active_bounds"] == []
    assert failures(record) == []


def test_rows_in_the_way_are_named():
    blocking, rows = np.zeros((10, 7), int), np.zeros((10, 3), int)
    blocking[2, 4], rows[2:9, 0], rows[5:9, 2] = -1, 1, 1
    names = [f"arm_{letter}" for letter in "abcdefg"]
    record = slowed(
        [1.0] * 2 + [0.5] * 7 + [1.0],
        blocking=blocking, blocking_rows=rows, settings={"rows": ROWS, "joints": names},
    )  # fmt: skip
    found = compute_metrics(record)["incidents"]["blocking_rows"]
    first = {"steps": 7, "time_s": pytest.approx(0.7), "first_s": pytest.approx(0.2)}
    assert found[0] == {"part": "Obstacle", "row": 1, **first}
    assert failures(record)[1] == (
        "7 steps without a solution (7 slowed), the first at step 2 (t = 0.2 s), against "
        "arm_e lower position limit, row 1 of Obstacle; most often in the way: "
        "row 1 of Obstacle, row 2 of CollisionAvoidance, arm_e lower position limit"
    )
    kept = "rows kept the tip up to {} m off the path"
    off = sample(record, "position", 9, [0.0, 0.04, 0.0])
    assert failures(off)[2].endswith(kept.format(0.04))
    off = sample(record, "position", 10, [0.0, 0.04, 0.0])  # when no row was in the way
    assert failures(off)[2].endswith(kept.format(0))
    away = sample(record, "position_desired", 0, record.position[0] + [0.0, 0.3, 0.4])
    assert failures(away)[1] == failures(record)[1] + "; the path begins 0.5 m from the tip"


def test_each_kind_of_bound_has_its_own_multipliers():
    """A joint at its upper position limit first, at its velocity limit later, and slower."""
    multiplier, dq = np.zeros((10, 7)), np.zeros((10, 7))
    multiplier[1:3, 0], multiplier[6:9, 0], dq[6:9, 0] = 0.5, 0.25, 1.5
    multiplier[:, 2], dq[:, 2] = -0.5, -1.2  # slower than the limit of 1.5 rad/s
    found = compute_metrics(make_record(bound_multiplier=multiplier, dq_solver=dq))["incidents"]
    named = [
        (bound["joint"], bound["limit"], bound["side"], bound["steps"], bound["max_multiplier"])
        for bound in found["active_bounds"]
    ]
    assert named == [
        (1, "position", "upper", 2, 0.5),
        (1, "velocity", "upper", 3, 0.25),
        (3, "position", "lower", 10, 0.5),
    ]


def test_clipped_steps_and_bounds_in_the_way():
    clipped, blocking = np.zeros((10, 7), int), np.zeros((10, 7), int)
    clipped[2:5, 3] = clipped[4, 1] = 1
    blocking[6, 0], blocking[7, 0], blocking[7, 6] = 2, 1, -1
    record = make_record(clipped=clipped, blocking=blocking, action=np.eye(10, dtype=int)[6] * 9)
    incidents = compute_metrics(record)["incidents"]
    assert incidents["clipped_steps"] == 3
    assert incidents["first"] == {
        "step": 6, "time_s": pytest.approx(0.6), "action": "unknown",
        "against": [{"joint": 1, "side": "upper", "limit": "velocity"}],
    }  # fmt: skip
    assert [(b["joint"], b["side"], b["limit"], b["first_s"]) for b in incidents["blocking"]] == [
        (1, "upper", "position", pytest.approx(0.7)),
        (1, "upper", "velocity", pytest.approx(0.6)),
        (7, "lower", "position", pytest.approx(0.7)),
    ]


def test_the_nearest_pair_is_named():
    distance = np.full(11, 0.05)
    distance[4] = 0.015
    pairs = {"pairs": [["Ball", "link_7"], ["Box", "link_4"]], "distance": 0.02}
    record = make_record(
        distance=distance,
        nearest=np.where(np.arange(11) == 4, 1, 0),
        settings={"collisions": pairs},
    )
    found = compute_metrics(record)["collisions"]
    assert (found["first"], found["second"], found["time_s"]) == ("Box", "link_4", 0.4)
    assert found["missing_m"] == pytest.approx(0.005)
    words = "link_4 and Box came as near as 0.015 m at t = 0.4 s, allowed 0.02 m"
    assert failures(record) == [words]


LIMITS = [100.0, 100.0, 50.0, 50.0, 50.0, 20.0, np.inf]
PUSH = {"force": [0.0, 10.0, 0.0], "start": 2.0, "duration": 0.5}


def physics_record(far: list[float], push: object = None, share: float = 0.5) -> Record:
    """10 s in steps of 0.1 s with 3 mm of error at some times [s], torques below their limits."""
    position, torque = np.zeros((101, 3)), np.zeros((100, 7))
    position[:4, 1], position[4:, 1] = 5e-3, 1e-4
    position[np.rint(10.0 * np.array(far)).astype(int), 1] = 3e-3
    torque[3, 2], torque[4, 0], torque[5, 6] = -share * 50.0, 0.9 * share * 100.0, 1e6
    physics = {"timestep": 1e-3, "disturbances": {"push": push}}
    settings = {"torque_max": LIMITS, "physics": physics}
    return make_record(steps=100, position=position, torque=torque, settings=settings)


def test_settled_error_and_torques():
    assert "physics" not in compute_metrics(make_record())
    physics = compute_metrics(physics_record([]))["physics"]
    assert physics["max_position_error_settled_m"] == pytest.approx(1e-4)
    assert physics["max_torque_n_m"] == pytest.approx([45.0, 0, 25.0, 0, 0, 0, 1e6])
    assert physics["torque_limit_n_m"] == [*LIMITS[:-1], None]
    assert physics["max_torque_share"] == pytest.approx(0.5)
    assert physics["push"] is None
    # The sample at the time of settling counts.
    assert compute_metrics(physics_record([0.5]))["physics"]["max_position_error_settled_m"] == 3e-3


@pytest.mark.parametrize(
    ("far", "largest", "recovery"),
    [([2.0, 2.4], 3e-3, 0.0), ([2.7], 3e-3, 0.3), ([2.7, 4.0], 3e-3, 1.6), ([10.0], 3e-3, None)],
)
def test_the_recovery_from_a_push(far, largest, recovery):
    push = compute_metrics(physics_record(far, PUSH))["physics"]["push"]
    assert push["max_position_error_m"] == largest
    assert push["recovery_s"] == (recovery if recovery is None else pytest.approx(recovery))
    assert push["recovered_below_m"] == 1e-3


def test_a_torque_at_its_limit_is_a_failure():
    (reason,) = failures(physics_record([], share=1.0))
    assert reason == "joint 3: torque reached its limit of 50 N m at step 3 (t = 0.3 s); 1 in all"
    assert failures(physics_record([], share=0.999)) == []
