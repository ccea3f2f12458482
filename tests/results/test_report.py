"""The report and the summary say what the metrics say, and no more than was checked."""

import re

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_records import heart_record, make_record
from iiwa_dnn.results.report import markdown_table, report, save_run, summary, verdict
from iiwa_dnn.studies.paper import published

KIND = np.array([0, 0, 1, 2, 2, 2, 3, 3, 3, 4])
KINDS = "2 nominal, 1 scaled, 3 relaxed, 3 rate-limited, 1 stopped"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    record = heart_record(steps=500, solvers=("proxqp", "osqp"), q_upper=[3.0] * 7)
    heart = {"robot": "iiwa7", "scheme": {"weight": 0.2}, "reference": d.Heart().settings()}
    return record, folder, save_run(record, folder / "new", paper=published(heart))


def rows_of(text):
    """Cells of all tables of a report, by the first of each row."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [re.split(r" (?<!\\)\| ", line.strip("| ")) for line in lines]
    return {cell[0]: cell[1:] for cell in cells}


def test_the_reports_numbers_are_the_metrics(run):
    _, folder, metrics = run
    text = (folder / "new" / "report.md").read_text(encoding="utf-8")
    table = rows_of(text)
    check = metrics["crosscheck"]
    for row, name, unit in [
        ("mean squared position error per axis", "mse_position_error_m2", "m²"),
        ("largest orientation error", "max_orientation_error_rad", "rad"),
        ("largest kinetic index", "max_kinetic_index", "rad²/s² (J with kinetic = inertia)"),
        ("wall time", "wall_time_s", "s"),
    ]:
        assert float(table[row][0]) == pytest.approx(metrics[name], rel=1e-3), row
        assert table[row][1] == unit, row
    gap = check["max_solution_gap"]
    assert float(table["largest gap to the reference"][0]) == pytest.approx(gap, rel=1e-3)
    beside = f"{metrics['max_position_error_m']:.4g} (the paper's 5.59e-05)"
    assert table["largest position error"] == [beside, "m"]
    assert table["joint drift, start to end"][0].endswith(" (the paper's 0.0174)")
    assert published({"robot": "panda", "scheme": {}, "reference": {}}) == {}
    heart = {"robot": "iiwa7", "scheme": {"weight": 0.2}, "reference": d.Heart().settings()}
    assert published(heart)
    assert published(heart | {"motion": "physics"}) == published(heart | {"noise": 0.01}) == {}
    assert table["cross-check"][0] == "500 of 500 QPs verified by proxqp or osqp"
    assert table["q_upper"] == ["3 (all 7)"]
    assert table["scheme"] == ["name = DoubleIndicator, weight = 0.2, kinetic = identity"]
    assert re.search(r"- date: \d{4}-\d\d-\d\d \d\d:\d\d UTC\n", text)
    assert f"numpy {np.__version__}" in text
    links = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text)
    assert links == ["overview.png", "convergence.png"]


def test_the_summary_has_the_reports_rows_in_ascii(run):
    _, folder, metrics = run
    text = summary(metrics)
    assert text.isascii()
    assert all(line == line.rstrip() and len(line) < 120 for line in text.splitlines())
    lines = dict(re.split(r"  +", line, maxsplit=1) for line in text.splitlines())
    table = rows_of((folder / "new" / "report.md").read_text(encoding="utf-8"))
    for name in ("largest KKT residual", "largest orientation error", "wall time"):
        assert lines[name] == " ".join(table[name]).strip()
    assert next(iter(lines)) == "verdict"
    assert lines["verdict"].endswith("in agreement with proxqp or osqp")


@pytest.mark.parametrize(
    ("changes", "row", "said"),
    [
        ({}, "10 of 10 QPs verified by proxqp",
         "all 10 steps solved, within all limits and in agreement with proxqp"),
        # Where another solver stood in, row and verdict name it.
        ({"judge": [[1]] * 3 + [[0]] * 7}, "10 of 10 QPs verified by proxqp or osqp",
         "all 10 steps solved, within all limits and in agreement with proxqp or osqp"),
        ({"solvers": ()}, "no QPs checked",
         "completed within all limits; not judged by a reference"),
        ({"settings": {"mode": "continuous"}}, "10 of 10 QPs compared with proxqp, not judged",
         "completed within all limits; not judged by a reference"),
        ({"kind": KIND}, f"9 of 10 QPs verified by proxqp: {KINDS}",
         f"not all commands are the nominal program's: {KINDS}"),
        ({"steps": 1}, "1 of 1 QPs verified by proxqp",
         "all 1 step solved, within all limits and in agreement with proxqp"),
    ],
)  # fmt: skip
def test_verdicts_claim_no_more_than_was_checked(changes, row, said, tmp_path):
    record = make_record(**changes)
    text = report(d.compute_metrics(record))
    assert rows_of(text)["cross-check"] == [row]
    assert f"- {said}\n" in text
    assert said in summary(d.compute_metrics(record))


def test_what_was_not_limited_comes_first_and_no_row_is_of_a_limit_that_is_not_there():
    dq = np.zeros((10, 7))
    dq[4:, 2] = 0.5
    own = {"robot_ddq_max": [2.0] * 7, "robot_dddq_max": [None] * 7, "dddq_max": [None] * 7}
    said = "acceleration was not limited: up to 5 rad/s² at joint 3, the robot's limit is 2;"
    failed = summary(d.compute_metrics(make_record(dq=dq, settings=own))).splitlines()
    assert re.match(rf"verdict +{said.replace('²', '.2')}", failed[0])
    assert "within all" not in failed[1]
    metrics = d.compute_metrics(make_record(dq=dq, settings=own | {"ddq_max": [None] * 7}))
    first, second = verdict(metrics)
    assert first.startswith(said)
    assert second == "all 10 steps solved, within all other limits and in agreement with proxqp"
    text = report(metrics)
    assert f"- {first}\n- {second}\n" in text
    assert {row for row in rows_of(text) if row.endswith("limit violation")} == {
        "position limit violation",
        "velocity limit violation",
    }


def test_a_failed_run_lists_every_reason(tmp_path):
    record = make_record(q=np.full((11, 7), 2.6), solution_gap=np.full((10, 1), 1e-3))
    reasons = d.failures(record)
    assert len(reasons) == 2
    assert "\n".join(f"- {reason}" for reason in reasons) in report(d.compute_metrics(record))
    stuck = make_record(action=np.full(10, 2), fraction=np.zeros(10))
    assert re.match(r"verdict +path completed 0.0 %\n", summary(d.compute_metrics(stuck)))


def test_active_and_limiting_limits_have_rows(tmp_path):
    rows = [{"part": "CollisionAvoidance", "row": 1 + i} for i in range(9)]
    multiplier, limiting = np.zeros((10, 9)), np.zeros((10, 9), int)
    multiplier[:6, 2], limiting[8] = np.linspace(0.4, 0.1, 6), 1
    record = make_record(
        row_multiplier=multiplier,
        limiting_rows=limiting,
        action=np.eye(10, dtype=int)[8] * 3,
        settings={"rows": rows},
    )
    table = rows_of(report(d.compute_metrics(record)))
    assert table["row 3 of CollisionAvoidance active"][0] == "6 steps, from 0 s on"
    assert table["row 2 of CollisionAvoidance leaves no solution"][0] == "1 step, from 0.8 s on"
    assert table["steps relaxed"][0] == "1"
    assert "steps slowed" not in table


def test_cells_do_not_break_a_table(tmp_path):
    record = make_record(settings={"status": "a | b\nc", "motion": "x|y", "left": None})
    table = rows_of(report(d.compute_metrics(record)))
    assert table["status"] == ["a \\| b c"]
    assert "left" not in table
    assert markdown_table(("a", "b"), [("1", "-2")]) == "| a | b |\n|:---|:---|\n| 1 | -2 |"
