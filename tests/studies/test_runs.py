"""One run from plain settings: what is run is what was asked, and its numbers are the record's."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from helpers_records import make_record
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import FULL, QUICK, HeartRun, Scope, lap_drift, measure, total_variation

SHORT = HeartRun(duration=3e-3, keep_record=True)


def test_the_defaults_are_the_papers() -> None:
    record = measure(replace(HeartRun(), duration=1e-3, keep_record=True).settings()).record
    assert record is not None
    asked = record.settings
    assert asked["mode"] == "continuous"
    assert asked["scheme"]["orientation"] == "block"
    assert asked["scheme"]["weight"] == 0.2
    assert asked["scheme"]["home"] == asked["q0"] == list(paper.START)
    assert asked["q_upper"] == [2.5] * 7
    assert (asked["dt"], asked["motion"], asked["rho"]) == (1e-4, "euler", 9e-5)
    assert asked["reference"]["name"] == "heart"
    assert asked["check"]["solvers"] == []
    assert HeartRun().duration == 10.0


def test_every_setting_reaches_the_run() -> None:
    run = replace(
        SHORT, weight=0.7, mode="converged", orientation="so3", kinetic="inertia", noise=0.02,
        noise_at="measurement", filter_window=3, seed=5, dt=2e-4, duration=4e-3, motion="midpoint",
    )  # fmt: skip
    record = measure(run.settings()).record
    assert record is not None
    asked = record.settings
    for name in ("mode", "noise", "noise_at", "filter_window", "seed", "dt", "duration", "motion"):
        assert asked[name] == getattr(run, name), name
    for name in ("weight", "orientation", "kinetic"):
        assert asked["scheme"][name] == getattr(run, name), name
    assert record.steps == 20


def test_the_baseline_and_the_sub_steps_reach_the_run() -> None:
    baseline = measure(replace(SHORT, baseline=True, mode="converged").settings()).record
    assert baseline is not None
    assert baseline.settings["scheme"]["name"] == "pseudo-inverse"
    three = measure(replace(SHORT, substeps=3).settings()).record
    assert three is not None
    np.testing.assert_array_equal(three.iterations, 3)
    computed = measure(SHORT.settings())
    assert computed.record is not None
    np.testing.assert_array_equal(computed.record.iterations, 8)
    implicit = measure(replace(SHORT, substeps="implicit").settings())
    assert implicit.values["amplification"] is None
    assert implicit.values["max_kkt_residual"] != computed.values["max_kkt_residual"]


def test_the_numbers_are_those_of_the_record() -> None:
    outcome = measure(replace(SHORT, noise=0.01).settings())
    assert outcome.record is not None
    metrics = compute_metrics(outcome.record)
    for name in set(outcome.values) & set(metrics) - {"wall_time_s"}:
        assert outcome.values[name] == metrics[name], name
    assert outcome.values["status"] == "completed"
    assert measure(replace(SHORT, keep_record=False).settings()).record is None


def test_settings_are_json_and_runs_that_cannot_differ_share_them() -> None:
    assert json.loads(json.dumps(SHORT.settings())) == SHORT.settings()
    assert HeartRun(**SHORT.settings()) == SHORT
    still = replace(SHORT, seed=3, noise_at="network")
    assert still.settings() == SHORT.settings()
    noisy = replace(SHORT, noise=0.01)
    assert replace(noisy, seed=3).settings() != noisy.settings()
    assert replace(noisy, noise_at="network").settings() != noisy.settings()


def test_growth_of_a_sub_step_tells_seven_from_eight() -> None:
    growth = {k: measure(replace(SHORT, substeps=k).settings()).values for k in (7, 8)}
    assert growth[7]["amplification"] > 1.0 > growth[8]["amplification"]


def test_total_variation_of_made_up_records() -> None:
    dq = np.zeros((10, 7))
    dq[:, 2] = np.linspace(0.0, 0.9, 10)  # a ramp: its height
    dq[:, 4] = 0.1 * (-1.0) ** np.arange(10)  # chatter: twice its height, nine times
    assert total_variation(make_record(dq=dq)) == pytest.approx(1.8)
    assert total_variation(make_record(steps=1)) == 0.0


def test_drift_after_each_lap_of_a_made_up_record() -> None:
    q = np.zeros((26, 7))
    q[10, 1], q[20, 3], q[25, 0] = 0.3, -0.5, 9.0
    found = lap_drift(make_record(steps=25, q=q, t=0.1 * np.arange(26)), period=1.0)
    assert found == [0.3, 0.5]


def test_the_scopes() -> None:
    assert (FULL.duration, FULL.seeds, FULL.laps) == (10.0, 100, 10)
    assert (QUICK.duration, QUICK.seeds) == (1.0, 5)
    for bad, name in (
        ({"seeds": 1}, "seeds"),
        ({"laps": 0}, "laps"),
        ({"duration": 0.0}, "duration"),
    ):
        with pytest.raises(InvalidInputError, match=f"^{name}: "):
            Scope(**bad)
