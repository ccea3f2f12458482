"""The atlas: its schemes, its runs, what becomes of their numbers, and the command."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from iiwa_dnn import (
    QP,
    Configuration,
    Cost,
    DNNSolver,
    InvalidInputError,
    PositionTask,
    Scheme,
    Step,
    Target,
)
from iiwa_dnn.app.main import main
from iiwa_dnn.networks import Flow, Network
from iiwa_dnn.networks.base import difference_jacobian
from iiwa_dnn.studies import atlas, atlas_report, paper
from iiwa_dnn.studies.atlas_disturbances import DISTURBANCES, learn
from iiwa_dnn.studies.atlas_schemes import SCHEMES
from iiwa_dnn.studies.runs import paper_robot

FEW = ("projection (the paper's)", "dual", "zeroing, Euler", "primal-dual, fixed time")


def at_start() -> Configuration:
    return Configuration(paper_robot(), paper.START)


@pytest.mark.parametrize("name", SCHEMES)
def test_every_scheme_answers_the_task(name: str) -> None:
    conf = at_start()
    target = Target(conf.position, conf.rotation, [0.1, -0.05, 0.02])
    scheme, asked = SCHEMES[name](), np.array([0.1, -0.05, 0.02])
    if scheme.level == "acceleration":
        asked *= 2 * 10.2  # from rest, at the gain of the task
    qp = scheme.build_qp(conf, target, dt=1e-3)
    qp.check_values()
    x = DNNSolver(tol=1e-8).solve(qp).x
    np.testing.assert_allclose(conf.jacobian[:3] @ x[:7], asked, atol=1e-6)


@pytest.mark.parametrize("kind", sorted({*DISTURBANCES} - {"locked"}))
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


def test_a_joint_that_is_locked_stands_still_and_bounds_are_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.2)
    name = "double indicator, position only"  # six joints are enough for three rows
    cell = atlas.cell("projection, implicit Euler", name, "locked", 8, 3)
    assert max(atlas.measure(cell).values["rms_error_m"]) < 1e-3


def test_a_jacobian_is_learned_from_motions_in_all_directions() -> None:
    """Broyden's estimate gives each last motion, and of an affine map all of them after n."""
    rng = np.random.default_rng(0)
    true, believed = rng.standard_normal((2, 7, 6))
    for direction in np.linalg.qr(rng.standard_normal((7, 7)))[0]:
        moved = 1e-5 * direction
        learn(believed, moved, pin.exp6(moved @ true))
        np.testing.assert_allclose(moved @ believed, moved @ true, atol=1e-12)
    np.testing.assert_allclose(believed, true, atol=1e-6)


def test_a_network_that_diverges_is_a_number_less_and_a_reason_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.1)
    cell = atlas.cell("zeroing, fixed time", "infinity norm", "none", 4, 1)
    values = atlas.measure(cell).values
    assert values["rms_error_m"] == [None]
    assert len(values["failures"]) == 1


@dataclass(frozen=True)
class Damped(Network):
    """A network added by docs/atlas.md and docs/own_network.md alone: A^T (A x - b) damps x."""

    def state_size(self, qp: QP) -> int:
        return qp.q.size + qp.b.size

    def flow(self, qp: QP) -> Flow:
        n = qp.q.size

        def rates(s: np.ndarray) -> np.ndarray:
            over = qp.A @ s[:n] - qp.b
            gradient = qp.P @ s[:n] + qp.q + qp.A.T @ (s[n:] + over)
            return np.concatenate([np.clip(s[:n] - gradient, qp.lb, qp.ub) - s[:n], over])

        return Flow(rates, lambda s: difference_jacobian(rates, s))

    def read(self, qp: QP, state: np.ndarray, point: np.ndarray) -> tuple[float, float, float]:
        n = qp.q.size
        x, y = np.clip(state[:n], qp.lb, qp.ub), state[n:]
        g = qp.P @ x + qp.q + qp.A.T @ y
        z_box = np.where((x <= qp.lb) | (x >= qp.ub), -g, 0.0)
        point[:] = np.concatenate([x, y, z_box])
        return tuple(qp.residuals(x, y, None, z_box))

    def stable_step(self, qp: QP, state: np.ndarray | None = None) -> float:
        return 0.0


class Slow(Cost):
    """A cost added by docs/own_scheme.md alone."""

    def quadratic(self, step: Step) -> tuple[np.ndarray, np.ndarray]:
        return np.diag(np.arange(1.0, 8.0)), np.zeros(7)


def test_a_network_and_a_scheme_are_added_by_a_line_each(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.1)
    monkeypatch.setitem(SCHEMES, "slow", lambda: Scheme([Slow()], [PositionTask()]))
    monkeypatch.setitem(atlas.NETWORKS, "damped", atlas.settled(Damped()))
    assert atlas.measure(atlas.cell("damped", "slow", "none", 2, 1)).values["max_error_m"][0] < 1e-4
    monkeypatch.setitem(atlas.NETWORKS, "damped", atlas.still(Damped()))
    failures = atlas.measure(atlas.cell("damped", "slow", "none", 2, 1)).values["failures"]
    assert "knows no stable step" in failures[0]


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
        assert claim.disturbance in DISTURBANCES
        assert claim.measure in atlas.MEASURES


def test_the_command_writes_a_report_and_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.02)
    claim = atlas_report.Claim("A claim", "zeroing, Euler", "dual")
    monkeypatch.setattr(atlas_report, "CLAIMS", (claim,))
    words = ["atlas", "--out", str(tmp_path / "a"), "--seeds", "2", "--other-seeds", "1"]
    words += ["--schemes", "double indicator", "minimum velocity", "--workers", "1"]
    words += ["--evaluations", "1", "2", "4", "--networks", *FEW]
    assert main(words) == 0
    report = capsys.readouterr().out
    assert report == (tmp_path / "a" / "report.md").read_text(encoding="utf-8")
    rows = json.loads((tmp_path / "a" / "atlas.json").read_text(encoding="utf-8"))
    assert len(rows) == 4 * (2 * len(DISTURBANCES) + 2 * 2)
    assert all((f"| {name} | " in report) == (name in FEW) for name in atlas.NETWORKS)
    assert "| A claim | none | rms_residual |" in report
    assert (tmp_path / "a" / "atlas.png").stat().st_size > 10_000
    monkeypatch.setattr(atlas, "_run", None)  # nothing is computed again
    assert main([*words, "--quiet"]) == 0


def test_wrong_options_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path)]
    assert main(["atlas", *out, "--schemes", "other"]) == 2
    assert "schemes: must be of ['double indicator" in capsys.readouterr().err
    assert main(["atlas", *out, "--networks", "zeroing, Eular"]) == 2
    assert "no network 'zeroing, Eular'; did you mean: zeroing, Euler" in capsys.readouterr().err
    assert main(["atlas", *out, "--evaluations", "4", "2"]) == 2
    assert main(["atlas", *out, "--seeds", "0"]) == 2
    with pytest.raises(InvalidInputError, match="schemes"):
        atlas.cells(1, 1, (1,), ())
