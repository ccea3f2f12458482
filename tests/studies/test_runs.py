"""One run from plain settings: what is run is what was asked, and its numbers are the record's."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from helpers_records import make_record
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.results.metrics import compute_metrics, position_error
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, Scope, lap_drift, measure

SHORT = HeartRun(duration=3e-3)


def test_the_defaults_are_the_papers() -> None:
    asked = SHORT.run().settings
    assert asked["mode"] == "continuous"
    assert asked["scheme"]["orientation"] == "block"
    assert asked["scheme"]["weight"] == 0.2
    assert asked["scheme"]["home"] == asked["q0"] == list(paper.START)
    assert asked["q_upper"] == [2.5] * 7
    assert (asked["dt"], asked["motion"], asked["rho"]) == (1e-4, "euler", 9e-5)
    assert asked["reference"]["name"] == "heart"
    assert asked["check"]["solvers"] == []
    assert asked["ddq_max"] == asked["dddq_max"] == [None] * 7  # said, and not the robot's
    assert asked["robot_ddq_max"][0] == 8.65


def test_every_setting_reaches_the_run() -> None:
    run = replace(
        SHORT, weight=0.7, mode="converged", orientation="so3", kinetic="inertia", noise=0.02,
        noise_at="measurement", filter_window=3, seed=5, dt=2e-4, duration=4e-3, motion="midpoint",
    )  # fmt: skip
    asked = run.run().settings
    for name in ("mode", "noise", "noise_at", "filter_window", "seed", "dt", "duration", "motion"):
        assert asked[name] == getattr(run, name), name
    for name in ("weight", "orientation", "kinetic"):
        assert asked["scheme"][name] == getattr(run, name), name
    baseline = replace(SHORT, baseline=True, mode="converged").run()
    assert baseline.settings["scheme"]["name"] == "pseudo-inverse"
    np.testing.assert_array_equal(replace(SHORT, substeps=3).run().iterations, 3)
    np.testing.assert_array_equal(SHORT.run().iterations, 8)
    implicit = measure(replace(SHORT, substeps="implicit"))
    assert implicit["max_kkt_residual"] != measure(SHORT)["max_kkt_residual"]


def test_what_the_paper_leaves_out_reaches_the_run() -> None:
    quiet = SHORT.run()
    run = replace(
        SHORT, scale=1e-3, period=5.0, limit_gain=0.5, orientation_gain=3.0, velocity=0.25,
    )  # fmt: skip
    asked = run.run().settings
    assert asked["reference"] == {"name": "heart", "scale": 1e-3, "period": 5.0}
    assert asked["scheme"]["limit_gain"] == 0.5
    assert asked["scheme"]["orientation_gain"] == 3.0
    assert asked["dq_max"] == [0.25] * 7
    # A quarter of a lap on, the heart moves at once, and begins where the arm is.
    shifted = replace(SHORT, phase=0.25).run()
    np.testing.assert_allclose(shifted.position_desired[0], shifted.position[0], atol=1e-15)
    velocity = np.diff(shifted.position_desired[:2], axis=0)[0] / 1e-4
    rate = 2.0 * np.pi / 10.0
    slope = -13.0 - 6.0  # of 13 cos p - 5 cos 2p - 2 cos 3p - cos 4p at a quarter of a turn
    np.testing.assert_allclose(velocity, [0.0, 3.45e-3 * rate * slope, 0.0], atol=1e-5)
    # A drawn state of the network moves the joints in the first step; a fresh one does not.
    assert not quiet.dq[0].any()
    begun = [replace(SHORT, start=0.1, seed=seed).run().dq[0] for seed in (1, 1, 2)]
    np.testing.assert_array_equal(begun[0], begun[1])
    assert np.abs(begun[0]).max() > 1e-3
    assert np.abs(begun[0] - begun[2]).max() > 1e-3


def test_the_numbers_are_those_of_the_record() -> None:
    run = replace(SHORT, noise=0.01)
    values = measure(run)
    metrics = compute_metrics(run.run())
    for name in set(values) & set(metrics):
        assert values[name] == metrics[name], name
    assert values["status"] == "completed"
    error = position_error(run.run())
    assert values["max_axis_error_m"] == np.abs(error).max()
    assert values["time_of_max_error_s"] == 1e-4 * np.linalg.norm(error, axis=1).argmax()
    assert values["max_kinetic_index_times_dt"] == metrics["max_kinetic_index"] * 1e-4


def test_drift_after_each_lap_of_a_made_up_record() -> None:
    q = np.zeros((26, 7))
    q[10, 1], q[20, 3], q[25, 0] = 0.3, -0.5, 9.0
    found = lap_drift(make_record(steps=25, q=q, t=0.1 * np.arange(26)), period=1.0)
    assert found == [0.3, 0.5]


@pytest.mark.parametrize("bad", [{"seeds": 1}, {"laps": 0}, {"weights": (0.3,)}], ids=str)
def test_a_bad_size_is_named(bad: dict[str, Any]) -> None:
    with pytest.raises(InvalidInputError, match=f"^{next(iter(bad))}: "):
        Scope(**bad)
