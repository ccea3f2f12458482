"""Columns of a record that a run has only where something happened."""

import numpy as np
from numpy.testing import assert_array_equal

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot, run
from iiwa_dnn.control.command import lay_out_log
from iiwa_dnn.schemes.program import ProgramSizes, program_views
from iiwa_dnn.step.log import log_of, note_active
from iiwa_dnn.step.policies import Action


def test_a_decision_is_noted_at_its_step_with_the_bound_limiting() -> None:
    """A joint that is limiting is driven at its velocity limit, to that side."""
    slow = {"robot": paper_robot().with_limits(velocity=0.15), "reference": heart(period=2.0)}
    record = run(**slow, duration=0.2)
    decided = record.action != Action.NONE
    assert 100 < decided.sum() < 200
    assert_array_equal(record.fraction < 1.0, decided)
    assert_array_equal((record.limiting != 0).any(axis=1), decided)
    step, joint = np.nonzero(record.limiting)
    assert_array_equal(record.limiting[step, joint], 2 * np.sign(record.dq[step, joint]))
    assert (np.abs(record.dq[step, joint]) > 0.998 * 0.15).all()
    stopped = run(**slow, duration=0.2, policy="stop")
    assert stopped.steps == 1 + np.flatnonzero(decided)[0]
    assert (np.abs(stopped.limiting[-1]) == 2).sum() == 1


def test_a_record_states_the_robots_rates_and_those_that_the_scheme_names() -> None:
    own = paper_robot().ddq_max.tolist()
    none = [None] * 7
    for limits, expected in (
        ((), {}),
        ((d.AccelerationLimits(),), {"ddq_max": own}),
        (
            (d.AccelerationLimits(np.inf), d.JerkLimits(9e3)),
            {"ddq_max": none, "dddq_max": [9e3] * 7},
        ),
        ((d.AccelerationLimits(np.inf),), {"ddq_max": none}),
    ):
        settings = run(d.DoubleIndicator(extra_limits=limits), duration=2e-3).settings
        assert {
            key: settings[key] for key in ("ddq_max", "dddq_max") if key in settings
        } == expected
        assert (settings["robot_ddq_max"], settings["robot_dddq_max"]) == (own, none)


def test_poses_are_those_of_the_first_stage_and_work_is_of_all() -> None:
    record = run(reference=heart(period=2.0), motion="rk4")
    assert_array_equal(record.position_desired[7], heart(period=2.0).at(record.t[7]).position)
    assert (record.iterations[1:] >= 4).all()


def test_an_active_limit_has_a_multiplier_and_no_slack() -> None:
    """Multipliers of rounding, and such as decay after the joint has left its bound, do not act."""
    rows = [[1.0, 0.0], [-1.0, 0.0], [1.0, 1.0]]
    qp = d.QP(np.eye(2), np.zeros(2), rows, [1.0, 0.0, 2.0], lb=[-1.0, -2.0], ub=[1.0, 1.5])
    layout = lay_out_log(ProgramSizes(*qp.sizes, 2, 0, 1), None)
    for x, z, z_box, active_rows, active_bounds in (
        ([1.0, 1.0], [2.0, 3.0, 1e-16], [1e-16, 1e-16], [2.0, 0.0, 0.0], [0.0, 0.0]),
        ([1.0, -2.0], [1e-9, 0.0, 40.0], [0.5, -0.1], [0.0, 0.0, 0.0], [0.5, -0.1]),
        ([0.9, 1.5 - 1e-7], [0.2, 9.0, 0.0], [5.0, 5e-3], [0.0, 0.0, 0.0], [0.0, 5e-3]),
    ):
        point = np.concatenate([x, z, z_box])
        row = np.zeros(layout.width)
        log = log_of(row, layout.sizes)
        log.program[:] = qp.data
        log.point[:] = point
        log.lower_kind[:] = log.upper_kind[:] = 2.0
        note_active(log, program_views(log.program, layout.sizes), 1e-9)
        of_bounds, of_rows = layout.multipliers(row)
        assert_array_equal(of_rows, active_rows)
        assert_array_equal(of_bounds, active_bounds)


def test_too_quick_a_path_in_continuous_mode_names_the_limits_that_the_arm_is_at() -> None:
    path = heart(period=0.4)
    scheme = d.DoubleIndicator(home=PAPER_Q0)
    options = {"mode": "continuous", "dt": 1e-3, "duration": 0.4}
    record = d.simulate(paper_robot(), scheme, path, PAPER_Q0, **options)
    active = d.compute_metrics(record)["incidents"]["active"]
    assert record.q[:, 0].min() < -2.47  # beside its limit of -2.5, and no other joint is
    assert sorted((bound["joint"], bound["side"], bound["limit"]) for bound in active) == [
        (1, "lower", "position"),
        (1, "lower", "velocity"),
        (1, "upper", "velocity"),
        (4, "lower", "velocity"),
        (4, "upper", "velocity"),
        (7, "upper", "velocity"),
    ]
