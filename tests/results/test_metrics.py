"""Each metric against a value worked out by hand; each reason to fail against its cause."""

import dataclasses
import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from helpers_records import make_record
from iiwa_dnn import Record
from iiwa_dnn.results.failures import failures, unlimited
from iiwa_dnn.results.metrics import PROGRAMS, compute_metrics, orientation_error, position_error

ROWS = [
    {"part": "Obstacle", "row": 1},
    {"part": "CollisionAvoidance", "row": 1},
    {"part": "CollisionAvoidance", "row": 2},
]
KINDS = np.array([0, 0, 1, 2, 2, 2, 3, 3, 3, 4])


def sample(record, name, index, value):
    """Replace one entry of one array of a record."""
    array = np.array(getattr(record, name))
    array[index] = value
    return dataclasses.replace(record, **{name: array})


def slowed(fraction, **changes):
    """A run whose clock went on by these fractions of a control period."""
    action = np.where(np.asarray(fraction) < 1.0, 2, 0)
    return make_record(action=action, fraction=fraction, **changes)


def check_of(**changes):
    return compute_metrics(make_record(**changes))["crosscheck"]


def test_the_values_are_json():
    metrics = compute_metrics(make_record())
    assert json.loads(json.dumps(metrics, allow_nan=False)) == metrics
    assert metrics["versions"]["iiwa_dnn"] == "0.1.0"
    assert "versions" not in metrics["settings"]
    assert failures(make_record()) == failures(metrics) == []


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
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    rotation_desired = Rotation.random(11, rng).as_matrix()
    expected = angle * np.linspace(0.0, 1.0, 11)
    turn = Rotation.from_rotvec(expected[:, None] * axis).as_matrix()
    record = make_record(rotation=turn @ rotation_desired, rotation_desired=rotation_desired)
    np.testing.assert_allclose(orientation_error(record), expected, rtol=1e-12, atol=5e-16)
    largest = pytest.approx(angle, rel=1e-12, abs=5e-16)
    assert compute_metrics(record)["max_orientation_error_rad"] == largest


def test_drift_times_work_and_kinetic_index():
    record = sample(sample(make_record(), "q", 0, 0.25), "q", (-1, 2), -0.5)
    record = sample(sample(record, "q", 5, 2.0), "kinetic_index", 7, 0.0454)
    metrics = compute_metrics(
        dataclasses.replace(record, t=5.0 + record.t, iterations=np.arange(10))
    )
    assert metrics["joint_drift_rad"] == 0.75  # from start to end only
    assert metrics["max_kinetic_index"] == 0.0454
    assert (metrics["steps"], metrics["dt_s"], metrics["wall_time_s"]) == (10, 0.1, 0.5)
    assert metrics["duration_s"] == pytest.approx(1.0)
    assert metrics["realtime_factor"] == pytest.approx(2.0)
    assert metrics["network_iterations"] == {"mean": 4.5, "max": 9}
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
    degrees = sample(make_record(), "q", (3, 5), 90.0)
    assert failures(degrees)[0].endswith("at step 3 (t = 0.3 s); are positions in degrees?")
    unlimited = {"q_lower": [-np.inf] * 7, "q_upper": [np.inf] * 7}
    free = make_record(q=record.q, settings=unlimited)
    assert compute_metrics(free)["position_limit_violation_rad"] == 0.0


def test_acceleration_and_jerk_are_judged_where_the_scheme_limits_them():
    rng = np.random.default_rng(1)
    dq = rng.uniform(-1.0, 1.0, (10, 7))
    padded = np.vstack([np.zeros((2, 7)), dq])
    most = [np.abs(np.diff(padded, order, axis=0)).max(axis=0) / 0.1**order for order in (1, 2)]
    for settings in ({"ddq_max": [None] * 7, "dddq_max": [None] * 7}, {}):
        free = compute_metrics(make_record(dq=dq, settings=settings))
        assert not {"acceleration_limit_violation_rad_s2", "jerk_limit_violation_rad_s3"} & {*free}
    at_once = make_record(dq=np.ones((10, 7)), settings={"ddq_max": [9.0] * 7})  # from rest
    assert failures(at_once)[0].startswith("joint acceleration limit broken by 1 rad/s²")
    at_limit = make_record(dq=dq, settings={"ddq_max": most[0], "dddq_max": most[1]})
    assert failures(at_limit) == []
    broken = make_record(dq=dq, settings={"ddq_max": most[0] - 0.5, "dddq_max": most[1] - 3.0})
    acceleration, jerk = failures(broken)
    assert acceleration.startswith("joint acceleration limit broken by 0.5 rad/s²; joint ")
    assert jerk.startswith("joint jerk limit broken by 3 rad/s³; joint ")


def beyond(own, **limits):
    """Failures and `beyond_robot` of a run whose joint 3 has 5 rad/s² and 50 rad/s³, from rest."""
    dq = np.zeros((10, 7))
    dq[4:, 2] = 0.5
    settings = {f"robot_{name}": [None, None, most, *[None] * 4] for name, most in own.items()}
    limits = {name: [most] * 7 for name, most in limits.items()}
    metrics = compute_metrics(make_record(dq=dq, settings=settings | limits))
    return failures(metrics), metrics["beyond_robot"]


def test_what_went_beyond_the_robots_own_limits_is_named_by_how_far():
    rates = {"ddq_max": 2.0, "dddq_max": 60.0}
    said = "acceleration was not limited: up to 5 rad/s² at joint 3, the robot's limit is 2; step 4"
    reasons, found = beyond(rates)
    assert [reason[: len(said)] for reason in reasons] == [said]
    assert list(found) == ["acceleration"]  # the jerk is below its limit
    assert found["acceleration"].pop("largest") == pytest.approx(5.0, rel=1e-12)
    where = {"joint": "joint 3", "step": 4, "time_s": pytest.approx(0.4)}
    assert found["acceleration"] == where | {"limit": 2.0, "limited": None, "named": False}
    both = beyond({"ddq_max": 2.0, "dddq_max": 40.0})[0]
    assert both[1].startswith("jerk was not limited: up to 50 rad/s³ at joint 3, ")
    # A scheme that names a larger limit, or none, said so; that is no failure.
    for limit in (None, 5.5):
        reasons, found = beyond(rates, ddq_max=limit)
        assert reasons == []
        assert found["acceleration"]["named"]
        assert found["acceleration"]["limited"] == limit
    assert beyond({"ddq_max": None}) == ([], {})
    assert beyond({}) == ([], {})
    assert beyond({"ddq_max": 5.0, "dddq_max": 50.0}) == ([], {})
    reasons, found = beyond(rates, ddq_max=1.0)  # one that is kept, or broken, is the scheme's
    assert reasons[0].startswith("joint acceleration limit broken by 4 rad/s²")
    assert found == {}


def test_positions_and_velocities_beyond_the_robots_own_limits_are_named_and_no_failure():
    own = {"robot_q_lower": [-2.0] * 7, "robot_q_upper": [2.1] * 7, "robot_dq_max": [1.0] * 7}
    still = make_record(q=np.zeros((11, 7)), settings=own)
    assert compute_metrics(still)["beyond_robot"] == {}
    moved = sample(sample(sample(still, "q", (3, 5), 2.2), "q", (4, 1), -2.25), "dq", (2, 0), -1.2)
    metrics = compute_metrics(moved)
    assert failures(metrics) == []
    assert [reason.split("; ")[0] for reason in unlimited(metrics, named=True)] == [
        "lower position was limited to -2.5: up to -2.25 rad at joint 2, the robot's limit is -2",
        "upper position was limited to 2.5: up to 2.2 rad at joint 6, the robot's limit is 2.1",
        "velocity was limited to 1.5: up to 1.2 rad/s at joint 1, the robot's limit is 1",
    ]
    # Limits that are no wider than the robot's are the run's, kept or broken.
    kept = {name.removeprefix("robot_"): limit for name, limit in own.items()}
    broken = compute_metrics(make_record(q=moved.q, dq=moved.dq, settings=own | kept))
    assert broken["beyond_robot"] == {}
    assert [reason[:14] for reason in failures(broken)] == ["joint position", "joint velocity"]
    none = {"q_lower": [None] * 7}
    free = compute_metrics(make_record(q=moved.q, settings=own | none))
    assert free["beyond_robot"]["lower position"]["limited"] is None


def test_of_an_arm_with_masses_the_commands_are_judged():
    sent = np.zeros((10, 7))
    moved = sent.copy()
    moved[5, 1] = 0.9  # a push
    own = {"robot_ddq_max": [5.0] * 7, "ddq_max": [5.0] * 7}
    assert failures(make_record(dq=moved, sent=sent, settings=own)) == []
    assert failures(make_record(dq=sent, sent=moved, settings=own))
    assert failures(make_record(dq=moved, settings=own))


@pytest.mark.parametrize("name", ["q", "dq", "position"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_is_no_success(name, value):
    record = sample(make_record(settings={"mode": "continuous"}), name, 5, value)
    json.dumps(compute_metrics(record), allow_nan=False)
    assert "not finite" in failures(record)[0]


def test_crosscheck_counts_only_what_is_believed():
    gap = np.full((6, 2), 1e-9)
    objective, residual = np.full((6, 2), 1e-11), np.full((6, 2), 1e-10)
    gap[0], residual[0] = 1e-6, 1e-8  # at their tolerances
    gap[1] = 3e-6, 9e-6  # disagree
    gap[2, 0], residual[2, 0], objective[2, 0] = 5.0, 1e-3, 7.0  # inaccurate: not believed
    gap[3, 1], residual[3, 1], objective[3, 1] = np.inf, np.inf, np.inf  # no answer
    gap[4, 0], residual[4, 0], objective[4, 0] = np.nan, np.nan, np.nan  # not asked
    record = make_record(
        steps=6, solvers=("proxqp", "osqp"), judge=[[0, 0], [0, 1], [1, 0], [-1, 0], *[[0, 0]] * 2],
        solution_gap=gap, objective_gap=objective, reference_residual=residual,
    )  # fmt: skip
    assert compute_metrics(record)["crosscheck"] == {
        "solver": "proxqp+osqp",
        "steps_checked": 5,
        "kinds": dict(zip(PROGRAMS, (5, 0, 0, 0, 0), strict=True)),
        "judged_by": {"proxqp": 4, "osqp": 6},
        "disagreements": 1,
        "reference_failures": 2,
        "max_solution_gap": 9e-6,
        "max_objective_gap": 1e-11,
        "max_feasibility_gap": 1e-11,
        "max_reference_residual": 1e-3,
        "judged": True,
        "tolerance": 1e-6,
        "first_disagreement": {
            "steps": 1, "step": 1, "time_s": pytest.approx(0.1), "quantity": "solution_gap",
            "solver": "proxqp (for osqp)", "gap": 9e-6, "tolerance": 1e-6,
        },
    }  # fmt: skip
    assert failures(record) == [
        "step 1 (t = 0.1 s): the gap to proxqp (for osqp) is 9e-06 rad/s, tolerance 1e-06; "
        "1 step in all",
        "reference answers missing or not accurate enough to judge by: 2 (proxqp+osqp); "
        "the check 'proof' needs no other solver",
        "1 step of 6 not checked",
    ]
    proven = compute_metrics(dataclasses.replace(record, judge=np.full((6, 2), 2, dtype=np.int8)))[
        "crosscheck"
    ]
    assert proven["first_disagreement"]["solver"] == "proof (for osqp)"
    nobody = check_of(solvers=(), kind=KINDS)
    assert nobody["kinds"] == dict(zip(PROGRAMS, (0, 0, 0, 3, 1), strict=True))
    assert (nobody["solver"], nobody["steps_checked"], nobody["judged"]) == ("none", 0, False)
    assert nobody["max_solution_gap"] is nobody["max_reference_residual"] is None
    assert failures(make_record(solvers=())) == []


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("objective_gap", "the objective differs from that of osqp by 2e-06 of its terms"),
        ("feasibility_gap", "a bound or row is violated by 2e-06 of its terms"),
    ],
)
def test_each_of_the_three_gaps_is_judged(name, said):
    record = sample(make_record(solvers=("proxqp", "osqp")), name, (4, 1), 2e-6)
    check = compute_metrics(record)["crosscheck"]
    assert (check["disagreements"], check[f"max_{name}"]) == (1, 2e-6)
    assert (check["first_disagreement"]["quantity"], check["max_solution_gap"]) == (name, 1e-9)
    assert failures(record) == [f"step 4 (t = 0.4 s): {said}, tolerance 1e-06; 1 step in all"]
    not_believed = sample(record, "reference_residual", (4, 1), 1e-3)
    assert compute_metrics(not_believed)["crosscheck"]["disagreements"] == 0
    nothing = sample(record, name, (4, 1), np.nan)
    assert "by not a number of its terms" in failures(nothing)[0]


def test_in_continuous_mode_the_gap_is_a_lag_and_not_judged():
    excess = np.full(10, 0.3)
    lag = {"solution_gap": np.full((10, 1), 0.1), "excess": excess, "kkt_residual": excess}
    record = make_record(**lag, settings={"mode": "continuous"})
    check = compute_metrics(record)["crosscheck"]
    assert (check["judged"], check["disagreements"]) == (False, 0)
    assert check["first_disagreement"] is None
    assert check["max_solution_gap"] == 0.1
    assert failures(record) == []


def test_what_is_not_proven_and_what_is_not_a_number_are_failures():
    bounds, residual = np.full((10, 1), 1e-12), np.zeros((10, 1))
    bounds[3] = residual[3] = np.inf
    bounds[5] = 1e-3
    record = make_record(solvers=("proof",), solution_gap=bounds, reference_residual=residual)
    check = compute_metrics(record)["crosscheck"]
    assert check["steps_checked"] == 10
    assert (check["reference_failures"], check["disagreements"]) == (1, 1)
    wrong, missing = failures(record)
    assert wrong.startswith("step 5 (t = 0.5 s): the gap to proof is 0.001 rad/s, tolerance 1e-06")
    assert "to judge by: 1 (proof)" in missing
    record = sample(make_record(), "solution_gap", 3, np.nan)  # its residual is finite
    assert compute_metrics(record)["crosscheck"]["disagreements"] == 1
    assert "step 3 (t = 0.3 s): the gap to proxqp is not a number rad/s" in failures(record)[0]


def test_each_kind_of_program_is_counted_and_a_stopped_step_has_nothing_to_check():
    gap = np.full((10, 1), 1e-9)
    gap[9] = 1.0  # of the stopped step: nobody is to be asked there
    check = check_of(kind=KINDS, solution_gap=gap)
    assert check["kinds"] == {
        "nominal": 2,
        "scaled": 1,
        "relaxed": 3,
        "rate_limited": 3,
        "stopped": 1,
    }
    assert (check["steps_checked"], check["disagreements"]) == (9, 0)
    said = "not all commands are the nominal program's: "
    said += "2 nominal, 1 scaled, 3 relaxed, 3 rate-limited, 1 stopped"
    assert failures(make_record(kind=KINDS)) == [said]
    gap[7] = 1e-3  # the velocity that was wanted at a rate-limited step
    wrong = check_of(kind=KINDS, solution_gap=gap)
    assert (wrong["disagreements"], wrong["first_disagreement"]["step"]) == (1, 7)


@pytest.mark.parametrize("value", [1.1e-9, 0.3, np.nan])
def test_a_command_outside_of_its_steps_bounds_disagrees(value):
    excess = np.zeros(10)
    excess[2], excess[6], excess[9] = 1e-9, value, 1.0  # the last is of a stopped step
    record = make_record(kind=KINDS, excess=excess)
    check = compute_metrics(record)["crosscheck"]
    assert check["disagreements"] == 1
    assert check["first_disagreement"]["solver"] == "bounds"
    assert "step 6 (t = 0.6 s): the gap to bounds is " in failures(record)[0]
    assert "tolerance 1e-09; 1 step in all" in failures(record)[0]
    both = dataclasses.replace(record, solution_gap=np.where(np.arange(10) == 2, 1e-3, 0)[:, None])
    assert compute_metrics(both)["crosscheck"]["disagreements"] == 2


@pytest.mark.parametrize("value", [2.3456e-9, np.nan, np.inf])
def test_an_unsolved_step(value):
    residual = np.full(10, 1e-9)  # at the tolerance: solved
    residual[[4, 6]] = value, 1.0
    said = "KKT residual 2.35e-09, tolerance 1e-09" if value < 1.0 else "the network has no answer"
    assert failures(make_record(kkt_residual=residual))[0].startswith(f"step 4 (t = 0.4 s): {said}")


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
        "(t = 0.3 s); limited most often by no bound, but a singular posture, a path out of "
        "reach or conflicting tasks; another start (--q0) may help",
    ]
    limiting = np.zeros((10, 7), int)
    for joint in range(5):
        limiting[: 8 - joint, joint] = 2
    half = slowed([0.4] * 8 + [1.0] * 2, limiting=limiting)  # 5.2 of 10 periods
    limits = "joint 1 upper velocity limit, joint 2 upper velocity limit, "
    limits += "joint 3 upper velocity limit"
    advice = "more time for the path (--period, --stretch) may help"
    assert failures(half)[1].endswith(f"limited most often by {limits}; {advice}")
    held = slowed([0.4] * 8 + [1.0] * 2, limiting=np.where(limiting, 3, 0))
    assert "; each joint is limited by itself, so the tip leaves the path" in failures(held)[1]
    assert "leaves the path" not in failures(half)[1]
    out_of_reach = slowed([0.4] * 8 + [1.0] * 2, limiting=np.minimum(limiting, 1))
    assert failures(out_of_reach)[1].endswith("joint 3 upper position limit")
    seldom = slowed([0.4] * 10, limiting=np.where(np.arange(10)[:, None] < 4, limiting, 0))
    assert "limited most often by no bound, " in failures(seldom)[1]  # of 6 steps, and limits of 4
    at_speed = slowed([0.4] * 10, limiting=2 * limiting)
    assert failures(at_speed)[1].endswith("path at speed or elsewhere (heart, line: at rest)")
    too_quick = slowed([0.4] * 10, limiting=2 * limiting, settings={"start_speed": 0.0})
    assert failures(too_quick)[1].endswith(advice)
    far = slowed([0.4] * 10, settings={"beyond_reach": 0.32})
    assert failures(far)[1].startswith("the path leads 0.32 m beyond the arm's reach")
    lag = make_record(action=action, settings={"mode": "continuous"})
    assert failures(lag) == []


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
    assert failures(shorter)[0] == f"{words} of the 1 s asked for, of 10 s"
    # Of 9.6 steps ten were asked for: a duration is rounded to whole steps.
    assert compute_metrics(make_record(settings={"duration": 0.96}))["path_completed"] == 1.0


def test_limits_that_act_are_counted_and_named_the_longest_first():
    """A joint at its upper position limit first, at its velocity limit later, and slower."""
    multiplier, dq, rows = np.zeros((10, 7)), np.zeros((10, 7)), np.zeros((10, 3))
    multiplier[1:3, 0], multiplier[6:9, 0], dq[6:9, 0] = 0.5, 0.25, 1.5
    multiplier[:, 2], dq[:, 2] = -0.5, -1.2  # slower than the limit of 1.5 rad/s
    rows[4:6, 1], rows[9, 2] = 0.1, 1e-12
    record = make_record(
        bound_multiplier=multiplier, dq_solver=dq, row_multiplier=rows, settings={"rows": ROWS}
    )
    metrics = compute_metrics(record)
    assert metrics["active_limit_steps"] == 10
    active = metrics["incidents"]["active"]
    bounds = [limit for limit in active if "joint" in limit]
    assert [(b["joint"], b["limit"], b["side"], b["steps"], b["step"]) for b in bounds] == [
        (3, "position", "lower", 10, 0),
        (1, "velocity", "upper", 3, 6),
        (1, "position", "upper", 2, 1),
    ]
    time = {"time_s": pytest.approx(0.4)}
    assert active[2:4] == [{**ROWS[1], "steps": 2, "step": 4, **time}, bounds[2]]
    assert active[4] == {**ROWS[2], "steps": 1, "step": 9, "time_s": pytest.approx(0.9)}
    assert metrics["incidents"]["limiting"] == []
    assert failures(record) == []
    assert not any((compute_metrics(make_record())["incidents"] | {"path_time_s": 0}).values())


def test_clipped_steps_and_limits_limiting():
    clipped, limiting, rows = (np.zeros((10, n), int) for n in (7, 7, 3))
    clipped[2:5, 3] = clipped[4, 1] = 1
    limiting[6, 0], limiting[7, 0], limiting[2, 4], rows[2:9, 0] = 2, 1, -1, 1
    record = make_record(
        clipped=clipped, limiting=limiting, limiting_rows=rows, action=np.eye(10, dtype=int)[6] * 3,
        settings={"rows": ROWS, "joints": [f"arm_{letter}" for letter in "abcdefg"]},
    )  # fmt: skip
    incidents = compute_metrics(record)["incidents"]
    assert (incidents["clipped_steps"], incidents["relax_steps"]) == (3, 1)
    assert incidents["first"] == {"steps": 1, "step": 6, "time_s": pytest.approx(0.6)}
    assert failures(record) == [
        "1 step without a solution (1 relaxed), the first at step 6 (t = 0.6 s); limited most "
        "often by row 1 of Obstacle, arm_a upper position limit, arm_a upper velocity limit"
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
    assert found["at_stop"] is None
    action = np.where(np.arange(10) < 4, 0, 4).astype(np.int8)
    stopped = compute_metrics(dataclasses.replace(record, action=action))
    assert stopped["collisions"]["at_stop"] == "link_4 and Box"


LIMITS = [100.0, 100.0, 50.0, 50.0, 50.0, 20.0, np.inf]


def physics_record(fraction: float = 0.5) -> Record:
    """10 s in steps of 0.1 s, 5 mm off at first, torques below their limits by a factor."""
    position, torque = np.zeros((101, 3)), np.zeros((100, 7))
    position[:5, 1], position[5:, 1] = 5e-3, 1e-4
    torque[3, 2], torque[4, 0], torque[5, 6] = -fraction * 50.0, 0.9 * fraction * 100.0, 1e6
    settings = {"torque_max": LIMITS, "physics": {"timestep": 1e-3}}
    return make_record(steps=100, position=position, torque=torque, settings=settings)


def test_converged_error_and_torques():
    assert "physics" not in compute_metrics(make_record())
    physics = compute_metrics(physics_record())["physics"]
    assert physics["max_position_error_settled_m"] == pytest.approx(1e-4)
    assert physics["max_torque_n_m"] == pytest.approx([45.0, 0, 25.0, 0, 0, 0, 1e6])
    assert physics["max_torque_fraction"] == pytest.approx(0.5)
    # The sample at the time of settling counts.
    late = compute_metrics(sample(physics_record(), "position", 5, [0.0, 3e-3, 0.0]))
    assert late["physics"]["max_position_error_settled_m"] == 3e-3
    (reason,) = failures(physics_record(fraction=1.0))
    assert reason == "torque limit reached by joint 3, first at step 3 (t = 0.3 s); 1 step"
    assert failures(physics_record(fraction=0.999)) == []
