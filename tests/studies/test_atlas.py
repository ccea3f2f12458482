"""The atlas: its schemes, its runs, what becomes of their numbers, and the command."""

import json
from pathlib import Path

import numpy as np
import pytest

from iiwa_dnn import Configuration, DNNSolver, InvalidInputError, Target
from iiwa_dnn.app.main import main
from iiwa_dnn.studies import atlas, atlas_report, paper
from iiwa_dnn.studies.atlas_schemes import SCHEMES
from iiwa_dnn.studies.runs import paper_robot

FEW = ("projection (the paper's)", "dual", "zeroing, Euler", "primal-dual, fixed time")


def at_start() -> Configuration:
    return Configuration(paper_robot(), paper.START)


@pytest.mark.parametrize("name", SCHEMES)
def test_every_scheme_answers_the_task(name: str) -> None:
    conf = at_start()
    target = Target(conf.position, conf.rotation, [0.1, -0.05, 0.02])
    qp = SCHEMES[name]().build_qp(conf, target)
    qp.check_values()
    x = DNNSolver(tol=1e-8).solve(qp).x
    np.testing.assert_allclose(conf.jacobian[:3] @ x[:7], [0.1, -0.05, 0.02], atol=1e-6)


@pytest.mark.parametrize("kind", atlas.DISTURBANCES)
def test_a_zeroing_network_keeps_the_path_under_every_disturbance(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.2)
    settings = atlas.cell("zeroing, Euler", "double indicator", kind, 2, 2)
    once, again = (atlas.measure(settings).values for _ in range(2))
    assert once["failures"] == []
    assert len(once["rms_error_m"]) == (1 if kind == "none" else 2)
    assert max(once["rms_error_m"]) < 2e-3
    assert once["rms_error_m"] == again["rms_error_m"]  # the seed draws all of it


def test_a_network_that_diverges_is_a_number_less_and_a_reason_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.1)
    cell = atlas.cell("zeroing, fixed time", "infinity norm", "none", 4, 1)
    values = atlas.measure(cell).values
    assert values["rms_error_m"] == [None]
    assert len(values["failures"]) == 1


def row(network: str, values: list[float | None], kind: str = "none") -> dict:
    cell = atlas.cell(network, "double indicator", kind, 4, len(values))
    result = dict.fromkeys(atlas.MEASURES, values) | {"failures": []}
    return atlas_report.tabulate([{**cell, "seeds": len(values)}], [result])[0]


@pytest.mark.parametrize(
    ("better", "worse", "verdict"),
    [
        ([1.0, 1.1, 1.0], [2.0, 2.2, 2.1], "holds"),
        ([2.0, 2.2, 2.1], [1.0, 1.1, 1.0], "does not hold"),
        ([1.0, 2.0, 3.0], [2.0, 1.0, 3.1], "undecided"),
        ([1.0], [1.5], "holds"),
        ([None], [1.5], "does not hold"),
        ([1.0, 1.0], [None, 1.5], "holds"),
    ],
)
def test_verdicts_are_computed_by_pairs(better: list, worse: list, verdict: str) -> None:
    rows = [row("a", better), row("b", worse)]
    assert atlas_report.judge(rows, atlas_report.Claim("", "a", "b"))["verdict"] == verdict


def test_every_claim_names_what_is_in_the_atlas() -> None:
    for claim in atlas_report.CLAIMS:
        assert {claim.better, claim.worse} <= set(atlas.NETWORKS)
        assert claim.disturbance in atlas.DISTURBANCES
        assert claim.measure in atlas.MEASURES


def test_the_command_writes_a_report_and_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.02)
    claim = atlas_report.Claim("A claim", "zeroing, Euler", "dual")
    monkeypatch.setattr(atlas_report, "CLAIMS", (claim,))
    for name in set(atlas.NETWORKS) - set(FEW):
        monkeypatch.delitem(atlas.NETWORKS, name)
    words = ["atlas", "--out", str(tmp_path / "a"), "--seeds", "2", "--other-seeds", "1"]
    words += ["--schemes", "double indicator", "minimum velocity", "--workers", "1"]
    words += ["--evaluations", "1", "2", "4"]
    assert main(words) == 0
    report = capsys.readouterr().out
    assert report == (tmp_path / "a" / "report.md").read_text(encoding="utf-8")
    rows = json.loads((tmp_path / "a" / "atlas.json").read_text(encoding="utf-8"))
    assert len(rows) == 4 * (2 * 7 + 2 * 2)
    assert all(f"| {name} | " in report for name in FEW)
    assert "| A claim | none | rms_residual |" in report
    assert (tmp_path / "a" / "atlas.png").stat().st_size > 10_000
    monkeypatch.setattr(atlas, "_run", None)  # nothing is computed again
    assert main([*words, "--quiet"]) == 0


def test_wrong_options_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path)]
    assert main(["atlas", *out, "--schemes", "other"]) == 2
    assert "schemes: must be of double indicator" in capsys.readouterr().err
    assert main(["atlas", *out, "--evaluations", "4", "2"]) == 2
    assert main(["atlas", *out, "--seeds", "0"]) == 2
    with pytest.raises(InvalidInputError, match="schemes"):
        atlas.cells(1, 1, (1,), ())
