"""The report and the summary say what the metrics say, and no more than was checked."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from helpers_records import draw_only, heart_record, make_record
from iiwa_dnn import DoubleIndicator
from iiwa_dnn.errors import FileError
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import save_run, summary, write_report


@pytest.fixture(scope="module")
def record():
    return heart_record(steps=500, solvers=("proxqp", "osqp"), q_upper=[3.0] * 7)


@pytest.fixture(scope="module")
def run(record, tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    with pytest.MonkeyPatch.context() as monkeypatch:
        draw_only(monkeypatch, "path", "position_error")
        return folder, save_run(record, folder)


def rows_of(text):
    """Cells of all tables of a report, by the first of each row."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [re.split(r" (?<!\\)\| ", line.strip("| ")) for line in lines]
    return {cell[0]: cell[1:] for cell in cells}


def test_a_run_leaves_its_files_and_nothing_else(run, record):
    folder, metrics = run
    assert {"record.npz", "metrics.json", "report.md"} < {path.name for path in folder.iterdir()}
    assert len(list(folder.iterdir())) == 3 + 4
    assert json.loads((folder / "metrics.json").read_text()) == metrics
    np.testing.assert_array_equal(Record.load(folder / "record.npz").q, record.q)


def test_metrics_follow_from_the_file(run):
    folder, metrics = run
    again = compute_metrics(Record.load(folder / "record.npz"))
    wall = {"wall_time_s": metrics["wall_time_s"], "realtime_factor": metrics["realtime_factor"]}
    assert again | wall == metrics


def test_without_figures(record, tmp_path):
    save_run(record, tmp_path / "new" / "folder", plots=False)
    names = {path.name for path in (tmp_path / "new" / "folder").iterdir()}
    assert names == {"record.npz", "metrics.json", "report.md"}
    assert "Figures" not in (tmp_path / "new" / "folder" / "report.md").read_text(encoding="utf-8")


def test_the_reports_numbers_are_the_metrics(run):
    folder, metrics = run
    table = rows_of((folder / "report.md").read_text(encoding="utf-8"))
    check = metrics["crosscheck"]
    for row, value, unit in [
        ("largest position error", metrics["max_position_error_m"], "m"),
        (
            "mean squared position error, over samples and axes",
            metrics["mse_position_error_m2"],
            "m²",
        ),
        ("largest orientation error", metrics["max_orientation_error_rad"], "rad"),
        ("joint drift, start to end", metrics["joint_drift_rad"], "rad"),
        ("largest kinetic index", metrics["max_kinetic_index"], "rad²/s²"),
        ("largest KKT residual", metrics["max_kkt_residual"], ""),
        ("steps", metrics["steps"], ""),
        ("time simulated", metrics["duration_s"], "s"),
        ("wall time", metrics["wall_time_s"], "s"),
        ("own programs checked", check["kinds"]["own"], ""),
        ("steps that disagree", check["disagreements"], ""),
        ("largest gap in the solution", check["max_solution_gap"], "rad/s"),
        ("largest gap in the objective", check["max_objective_gap"], ""),
        ("largest residual of a reference", check["max_reference_residual"], ""),
    ]:
        assert float(table[row][0].replace(",", "")) == pytest.approx(value, rel=1e-5), row
        assert (table[row][1:] or [""])[0] == unit, row
    assert table["reference solver"][0] == "proxqp+osqp"
    assert table["upper joint limits [rad]"] == ["3 (all 7)"]
    assert table["scheme"] == ["name = DoubleIndicator, weight = 0.2, kinetic = identity"]
    assert table["numpy"] == [np.__version__]


def test_the_report_shows_the_figures_that_exist(run):
    folder, _ = run
    links = re.findall(
        r"!\[[^\]]+\]\(([^)]+)\)", (folder / "report.md").read_text(encoding="utf-8")
    )
    assert len(links) == 2
    assert all((folder / link).is_file() for link in links)


def verdict(record, folder):
    write_report(record, compute_metrics(record), folder)
    text = (folder / "report.md").read_text(encoding="utf-8")
    return text.split("## Verdict\n\n")[1].split("\n\n")[0]


def test_verdicts_claim_no_more_than_was_checked(tmp_path):
    assert verdict(make_record(), tmp_path) == (
        "- all 10 steps solved, within all limits and in agreement with proxqp"
    )
    assert "no reference solver was asked" in verdict(make_record(solvers=()), tmp_path)
    lag = make_record(settings={"mode": "continuous"})
    assert "lag, not judged" in verdict(lag, tmp_path)
    unsure = make_record(reference_residual=np.full((10, 1), 1e-3), settings=lag.settings)
    assert verdict(unsure, tmp_path).endswith("; 10 reference answers not to be believed")
    assert "reported and not judged" in (tmp_path / "report.md").read_text(encoding="utf-8")


def test_a_lag_is_compared_and_not_judged(tmp_path):
    metrics = compute_metrics(make_record(settings={"mode": "continuous"}))
    text = summary(metrics)
    assert "proxqp, 10 own programs compared, not judged; 0 of them it could not solve\n" in text
    assert "disagreements" not in text
    assert "tolerance" not in text
    write_report(make_record(), metrics, tmp_path)
    table = rows_of((tmp_path / "report.md").read_text(encoding="utf-8"))
    assert "steps that disagree" not in table
    assert table["own programs checked"] == ["10"]


def test_an_orientation_that_no_task_holds_is_called_free(tmp_path):
    scheme = DoubleIndicator(orientation="none")
    metrics = compute_metrics(make_record(settings={"scheme": scheme.settings()}))
    write_report(make_record(), metrics, tmp_path)
    for text in (summary(metrics), (tmp_path / "report.md").read_text(encoding="utf-8")):
        assert "rad (orientation free)" in text.replace(" | ", " ")
    held = compute_metrics(make_record(settings={"scheme": DoubleIndicator().settings()}))
    assert "orientation free" not in summary(held)


def test_a_failed_run_lists_every_reason(tmp_path):
    record = make_record(q=np.full((11, 7), 2.6), solution_gap=np.full((10, 1), 1e-3))
    reasons = failures(record)
    assert len(reasons) == 2
    assert verdict(record, tmp_path) == "\n".join(f"- {reason}" for reason in reasons)


def test_cells_do_not_break_the_table(tmp_path):
    record = make_record(settings={"status": "a | b\nc", "motion": "x|y", "status_code": None})
    write_report(record, compute_metrics(record), tmp_path)
    table = rows_of((tmp_path / "report.md").read_text(encoding="utf-8"))
    assert table["status"] == ["a \\| b c"]
    assert table["status code"] == ["none"]


def test_summary_is_short_aligned_and_true(run):
    _, metrics = run
    lines = summary(metrics).splitlines()
    assert 9 <= len(lines) <= 12
    assert summary(metrics).isascii()
    assert all(len(line) <= 100 for line in lines)
    names = [line[:19].strip() for line in lines]
    assert names[0] == "run"
    assert names[-1] == "verdict"
    assert all(line[19] != " " and line[18] == " " for line in lines)
    text = summary(metrics)
    assert f"max {metrics['max_position_error_m']:.4g} m," in text
    assert "500 own programs checked, 0 disagreements, 0 failures" in text
    assert lines[-1].endswith("in agreement with proxqp+osqp")


def test_a_proven_run_says_so(tmp_path):
    record = make_record(
        solvers=("proof",),
        solution_gap=np.full((10, 1), 3e-12),
        objective_gap=np.full((10, 1), np.nan),
        reference_residual=np.zeros((10, 1)),
    )
    metrics = compute_metrics(record)
    line = "10 answers proven within 3e-12 rad/s of the exact solution, 0 not proven"
    assert f"cross-check        {line}\n" in summary(metrics)
    assert summary(metrics).endswith("all 10 steps solved, within all limits and proven")
    text = write_report(record, metrics, tmp_path).read_text(encoding="utf-8")
    assert f"{line}." in text
    assert "| answers proven | 10 |" in text
    assert "reference solver |" not in text


def test_summary_of_odd_runs():
    nothing = make_record(steps=0, settings={"duration": 1.0, "status": "interrupted"})
    text = summary(compute_metrics(nothing))
    assert "unknown" in text
    assert text.endswith("ended after 0 of 10 steps: interrupted")
    assert "not asked for" in summary(compute_metrics(make_record(solvers=())))
    broken = make_record(q=np.full((11, 7), 2.6))
    text = summary(compute_metrics(broken), failures(broken))
    assert text.endswith("joint 1 at step 0 (t = 0 s)")
    inertia = make_record(settings={"scheme": {"kinetic": "inertia"}})
    assert re.search(r"kinetic index +max 0 J\n", summary(compute_metrics(inertia)))
    assert re.search(
        r"kinetic index +max 0 *\n", summary(compute_metrics(make_record(settings={"scheme": "x"})))
    )


def test_nothing_is_written_where_nothing_can_be(record, tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(FileError, match="cannot be written"):
        save_run(record, tmp_path / "file")
    with pytest.raises(FileError, match="cannot be written"):
        write_report(record, compute_metrics(record), tmp_path / "missing")
    assert (tmp_path / "file").read_text() == "mine"
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_an_unfinished_path_is_the_summarys_first_line():
    stuck = make_record(action=np.full(10, 2), fraction=np.zeros(10))
    lines = summary(compute_metrics(stuck), failures(stuck)).splitlines()
    assert lines[0] == "path completed 0.0 %"
    assert lines[1].startswith("run  ")
    assert summary(compute_metrics(make_record())).startswith("run  ")


def test_active_and_blocking_rows_are_said(tmp_path):
    rows = [{"part": "CollisionAvoidance", "row": 1 + i} for i in range(4)]
    multiplier, blocking = np.zeros((10, 4)), np.zeros((10, 4), int)
    multiplier[:6, 2], blocking[8, 1] = np.linspace(0.4, 0.1, 6), 1
    record = make_record(
        row_multiplier=multiplier,
        blocking_rows=blocking,
        action=np.eye(10, dtype=int)[8] * 3,
        fraction=np.ones(10),
        settings={"rows": rows},
    )
    said = "row 3 of CollisionAvoidance active for 0.6 s, multiplier up to 0.4"
    assert f"active rows        {said}" in summary(compute_metrics(record))
    write_report(record, compute_metrics(record), tmp_path)
    report = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert f"- {said}, 0.25 on average (6 steps, from 0 s on)\n" in report
    assert "- row 2 of CollisionAvoidance in the way for 0.1 s (1 steps, from 0.8 s on)\n" in report
    assert rows_of(report)["inequality rows"] == ["CollisionAvoidance: 4"]
    assert "in the way: row 2 of CollisionAvoidance" in report


@pytest.mark.parametrize(
    ("part", "slowed"), [("CollisionAvoidance", 4), ("CollisionAvoidance", 3), ("TipSpeedLimit", 4)]
)
def test_a_remedy_is_named_where_an_obstacle_slows_most_steps(part, slowed):
    record = make_record(
        blocking_rows=np.where(np.arange(10) < slowed, 1, 0)[:, np.newaxis],
        action=np.where(np.arange(10) < 6, 2, 0),
        fraction=np.where(np.arange(10) < 6, 0.5, 1.0),
        settings={"rows": [{"part": part, "row": 1}]},
    )
    (reason,) = [text for text in failures(record) if text.startswith("slowed: ")]
    assert ("or take the policy relax" in reason) == (part == "CollisionAvoidance" and slowed > 3)


def test_network_and_integrators_are_among_the_settings(tmp_path):
    named = {
        "network": {"name": "ProjectionNetwork", "rho": 9e-5},
        "integrator": {"name": "ExplicitEuler", "substeps": None},
    }
    costs = [{"name": "KineticEnergy", "weight": 0.2}, {"name": "CyclicMotion"}]
    record = make_record(settings=named | {"scheme": {"name": "Scheme", "costs": costs}})
    write_report(record, compute_metrics(record), tmp_path)
    table = rows_of((tmp_path / "report.md").read_text(encoding="utf-8"))
    assert table["network"] == ["name = ProjectionNetwork, rho = 9e-05"]
    parts = "(name = KineticEnergy, weight = 0.2) (name = CyclicMotion)"
    assert table["scheme"] == [f"name = Scheme, costs = {parts}"]
    assert table["integrator"] == ["name = ExplicitEuler, substeps = none"]


@pytest.mark.parametrize("scheme", [{"name": "Scheme"}, {"kinetic": None}, {"kinetic": "mine"}])
def test_an_unknown_kinetic_index_has_no_unit(scheme, tmp_path):
    record = make_record(settings={"scheme": scheme})
    write_report(record, compute_metrics(record), tmp_path)
    table = rows_of((tmp_path / "report.md").read_text(encoding="utf-8"))
    assert "".join(table["largest kinetic index"][1:]) == ""
    assert re.search(r"kinetic index +max 0 *\n", summary(compute_metrics(record)))


def test_the_summary_says_what_was_checked_and_who_judged(tmp_path):
    kind = np.array([0, 0, 1, 2, 2, 2, 3, 3, 3, 4])
    record = make_record(kind=kind, judge=np.where(kind == 2, 1, 0)[:, None])
    text = summary(compute_metrics(record))
    line = "proxqp: 2 own, 1 scaled, 3 softened programs checked,"
    assert f"cross-check        {line}\n" in text
    assert "3 held back, checked for their bounds alone,\n" in text
    assert "0 failures\n                   judged by proxqp 6, osqp 3\n" in text
    write_report(record, compute_metrics(record), tmp_path)
    table = rows_of((tmp_path / "report.md").read_text(encoding="utf-8"))
    assert table["softened programs checked"] == ["3"]
    assert table["steps held back, checked for their bounds alone"] == ["3"]
    assert table["answers judged by osqp"] == ["3"]
    assert "judged by" not in summary(compute_metrics(make_record(judge=np.zeros((10, 1), int))))


def test_the_report_says_how_hard_the_run_was(tmp_path):
    integrator = {"integrator": {"name": "ImplicitEuler"}}
    record = make_record(iterations=np.arange(10), settings=integrator)
    said = "0 of 10 steps with an active limit; 4.5 linear systems a step, at most 9"
    assert f"difficulty         {said}\n" in summary(compute_metrics(record))
    write_report(record, compute_metrics(record), tmp_path)
    table = rows_of((tmp_path / "report.md").read_text(encoding="utf-8"))
    assert table["linear systems a step, most"] == ["9"]
    assert table["steps with an active bound or row"] == ["0"]


def test_pairs_that_are_watched_and_that_are_not_are_named(tmp_path):
    collisions = {
        "pairs": [["link_1", "link_3"]],
        "left_out": [["link_5", "link_7", "start"], ["link_1", "link_2", "by hand"]],
        "distance": 0.02,
    }
    record = make_record(settings={"collisions": collisions})
    text = write_report(record, compute_metrics(record), tmp_path).read_text(encoding="utf-8")
    assert "Watched pairs (1): link_1 and link_3." in text
    assert "Not watched, near each other in the start posture (1): link_5 and link_7." in text
    assert "Not watched, by hand (1): link_1 and link_2." in text
