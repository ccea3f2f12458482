"""Torques, settled error and recovery of a run in physics: closed forms on made-up records."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from helpers_records import make_record
from iiwa_dnn.results import plots
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.plots import save_figures
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import save_run, summary

LIMITS = [100.0, 100.0, 50.0, 50.0, 50.0, 20.0, np.inf]
PUSH = {"force": [0.0, 10.0, 0.0], "start": 2.0, "duration": 0.5}


def physics_record(error: np.ndarray, push: object = None, share: float = 0.5) -> Record:
    """10 s in steps of 0.1 s whose error [m] is given, torques at a share of their limits."""
    steps = len(error) - 1
    position = np.zeros((steps + 1, 3))
    position[:, 1] = error
    torque = np.zeros((steps, 7))
    torque[3, 2], torque[4, 0], torque[5, 6] = -share * 50.0, 0.9 * share * 100.0, 1e6
    settings = {
        "torque_max": LIMITS,
        "physics": {"timestep": 1e-3, "disturbances": {"push": push}},
    }
    return make_record(steps=steps, position=position, torque=torque, settings=settings)


def error_after(last_far: float) -> np.ndarray:
    """0.1 mm, 5 mm in the first second, 3 mm from the push on up to a time [s]."""
    t = 0.1 * np.arange(101)
    error = np.where((t >= 1.95) & (t < last_far - 0.05), 3e-3, 1e-4)
    error[:4] = 5e-3
    return error


def test_nothing_of_a_run_without_torques():
    record = make_record()
    assert "physics" not in compute_metrics(record)
    assert failures(record) == []


def test_settled_error_and_torques():
    physics = compute_metrics(physics_record(error_after(2.0)))["physics"]
    assert physics["max_position_error_settled_m"] == pytest.approx(1e-4)
    assert physics["settled_after_s"] == 0.5
    assert physics["max_torque_n_m"] == pytest.approx([45.0, 0, 25.0, 0, 0, 0, 1e6])
    assert physics["torque_limit_n_m"] == [*LIMITS[:-1], None]
    assert physics["max_torque_share"] == pytest.approx(0.5)
    assert physics["push"] is None


@pytest.mark.parametrize(
    ("last_far", "recovery"), [(2.0, 0.0), (2.5, 0.0), (3.2, 0.7), (9.9, 7.4), (99.0, None)]
)
def test_recovery_counts_from_the_end_of_the_push(last_far, recovery):
    push = compute_metrics(physics_record(error_after(last_far), PUSH))["physics"]["push"]
    if recovery is None:
        assert push["recovery_s"] is None
    else:
        assert push["recovery_s"] == pytest.approx(recovery, abs=1e-9)
    assert push["max_position_error_m"] == pytest.approx(3e-3 if last_far > 2.0 else 1e-4)
    assert push["recovered_below_m"] == 1e-3


def test_a_torque_at_its_limit_is_a_failure():
    record = physics_record(error_after(2.0), share=1.0)
    (reason,) = failures(record)
    assert "joint 3" in reason
    assert "limit of 50 N m at step 3 (t = 0.3 s); 1 in all" in reason
    (short,) = failures(compute_metrics(record))
    assert short == "a joint torque reached 100% of its limit"
    assert failures(physics_record(error_after(2.0), share=0.999)) == []
    torque = np.array(record.torque)
    torque[3, 2], torque[7, 2] = 0.0, 50.0  # at the upper one
    (reason,) = failures(dataclasses.replace(record, torque=torque))
    assert "limit of 50 N m at step 7" in reason


def test_report_and_summary_show_it(tmp_path):
    record = physics_record(error_after(3.2), PUSH)
    metrics = save_run(record, tmp_path, plots=False)
    report = (tmp_path / "report.md").read_text()
    assert "| largest torque of joint 3, limit 50 | 25 | N m |" in report
    assert "| time from the push's end until back within 0.001 m | 0.7 | s |" in report
    lines = summary(metrics, [])
    assert "back within 0.001 m after 0.7 s" in lines
    assert "max 50% of a joint's limit" in lines


def test_only_a_run_with_torques_has_their_figure(tmp_path, monkeypatch):
    monkeypatch.setattr(plots, "FIGURES", {"torques": plots.FIGURES["torques"]})
    record = physics_record(error_after(3.2))
    written = [path.name for path in save_figures(record, tmp_path)]
    assert written == ["torques.png", "torques.pdf"]
    assert save_figures(make_record(), tmp_path / "without") == []


def test_the_samples_at_the_edges_count():
    """One at the time of settling, one at the start of the push, one at the recovered distance."""
    error = error_after(2.6)
    error[5], error[20], error[30] = 7e-3, 8e-3, 1e-3
    physics = compute_metrics(physics_record(error, PUSH))["physics"]
    assert physics["max_position_error_settled_m"] == 8e-3
    assert physics["push"]["max_position_error_m"] == 8e-3
    assert physics["push"]["recovery_s"] == pytest.approx(0.1)
    error[20] = 1e-4
    physics = compute_metrics(physics_record(error, PUSH))["physics"]
    assert physics["max_position_error_settled_m"] == 7e-3
    assert physics["push"]["max_position_error_m"] == 3e-3
