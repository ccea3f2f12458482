"""The atlas: its schemes, its runs, what becomes of their numbers, and the command."""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from helpers_qp import known_qp
from iiwa_dnn import (
    QP,
    Configuration,
    Cost,
    DNNSolver,
    PositionTask,
    Scheme,
    Step,
    Target,
)
from iiwa_dnn.app.main import main
from iiwa_dnn.networks import Flow, Network
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
    qp = scheme.build_qp(conf, target, dt=1e-3)
    qp.check_values()
    x = DNNSolver(tol=1e-8).solve(qp).x
    np.testing.assert_allclose(conf.jacobian[:3] @ x[:7], asked, atol=1e-6)


@pytest.mark.parametrize("kind", sorted({*DISTURBANCES} - {"locked"}))
def test_a_zeroing_network_keeps_the_path_under_every_disturbance(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.2)
    settings = atlas.cell("zeroing, Euler", disturbance=kind, most=2, share=0.4, seeds=2)
    once, again = (atlas.measure(settings).values for _ in range(2))
    assert once["failures"] == []
    assert len(once["rms_error_m"]) == 2
    assert max(once["rms_error_m"]) < 2e-3
    assert once == again  # the seed draws all of it


def test_a_joint_that_is_locked_stands_still_and_bounds_are_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.2)
    name = atlas.of_league("double indicator", "locked")
    assert name == "double indicator, position only"  # six joints are enough for three rows
    settings = {"scheme": name, "disturbance": "locked", "seeds": 3, "paths": ["heart"]}
    cell = atlas.cell("projection, implicit Euler", **settings)
    assert max(atlas.measure(cell).values["rms_error_m"]) < 1e-3


def test_the_rows_towards_the_next_target_leave_no_floor() -> None:
    """What hid the networks' own errors, 1e-4 m, is below 1e-5 m where programs are solved."""
    values = atlas.measure(atlas.cell("projection, implicit Euler")).values
    assert values["residual"][0] < 1e-12
    assert values["rms_error_m"][0] < 1e-5


def test_a_jacobian_is_learned_from_motions_in_all_directions() -> None:
    """Broyden's estimate gives each last motion, and of an affine map all of them after n."""
    rng = np.random.default_rng(0)
    true, believed = rng.standard_normal((2, 7, 6))
    for direction in np.linalg.qr(rng.standard_normal((7, 7)))[0]:
        moved = 1e-5 * direction
        learn(believed, moved, pin.exp6(moved @ true))
        np.testing.assert_allclose(moved @ believed, moved @ true, atol=1e-12)
    np.testing.assert_allclose(believed, true, atol=1e-6)


def test_a_network_that_diverges_is_a_number_less_and_a_reason_more() -> None:
    values = atlas.measure(atlas.cell("zeroing, growing gain")).values
    assert values["residual"] == [None]
    assert values["failures"] == ["the state is not finite"]
    unpaid = atlas.measure(atlas.cell("zeroing, Euler", work=100.0)).values
    assert unpaid["rms_error_m"] == [None]
    assert "one evaluation takes" in unpaid["failures"][0]


@pytest.mark.parametrize("name", ["projection (the paper's)", "dual", "one-layer", "gradient"])
def test_the_linear_limit_is_where_steps_stop_to_come_nearer(name: str) -> None:
    network = atlas.part("network", name).network
    rng = np.random.default_rng(4)
    qp, _ = known_qp(rng, 5, 3, 0)
    qp = QP(qp.P, qp.q, A=qp.A, b=qp.b)
    rates = network.flow(qp).rates
    start = rng.standard_normal(network.state_size(qp))
    limit = network.flow(qp).linear_limit(start)  # without bounds it is the same everywhere
    for share, nearer in ((0.97, True), (1.03, False)):
        state = start
        sizes = []
        for k in range(1200):
            state = state + share * limit * rates(state)
            if k >= 600:
                sizes.append(np.linalg.norm(rates(state)))
        assert bool(sizes[-1] < max(sizes[0], 1e-9)) is nearer  # below that it is rounding


@pytest.mark.parametrize("name", sorted(atlas.NETWORKS))
def test_work_grows_with_the_program_and_buys_evaluations(name: str) -> None:
    entry = atlas.part("network", name)
    setup, each = entry.work((7, 0, 6))
    assert setup >= 0.0
    assert each > 0.0
    larger = entry.work((14, 0, 12))
    assert larger[0] + larger[1] > 3.9 * (setup + each)
    assert atlas.evaluations_within(entry, (7, 0, 6), setup + 3.5 * each) == 3


def test_work_is_that_of_the_arrays_that_are_multiplied() -> None:
    """Counted by hand for n = 2, p = 1: two operations for each entry of each product."""
    sizes = (2, 0, 1)
    assert atlas.NETWORKS["one-layer"].work(sizes) == (0.0, 2 * (4 + 2 + 2))
    assert atlas.NETWORKS["one-layer, corrected"].work(sizes) == (0.0, 4 * (4 + 2 + 2))
    assert atlas.NETWORKS["dual"].work(sizes)[1] == 2 * 3 * 3
    assert atlas.NETWORKS["zeroing, Euler"].work(sizes)[1] == 32 + 18 + 18


@dataclass(frozen=True)
class Damped(Network):
    """A network added by docs/atlas.md and docs/own_network.md alone: A^T (A x - b) damps x."""

    def state_size(self, qp: QP) -> int:
        return qp.q.size + qp.b.size

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        n = qp.q.size

        def rates(s: np.ndarray) -> np.ndarray:
            over = qp.A @ s[:n] - qp.b
            gradient = qp.P @ s[:n] + qp.q + qp.A.T @ (s[n:] + over)
            return np.concatenate([np.clip(s[:n] - gradient, qp.lb, qp.ub) - s[:n], over])

        return Flow(rates)


class Slow(Cost):
    """A cost added by docs/own_scheme.md alone."""

    def quadratic(self, step: Step) -> tuple[np.ndarray, np.ndarray]:
        return np.diag(np.arange(1.0, 8.0)), np.zeros(7)


def test_a_network_and_a_scheme_are_added_by_a_line_each(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.1)
    monkeypatch.setitem(SCHEMES, "slow", lambda: Scheme([Slow()], [PositionTask()]))
    monkeypatch.setitem(atlas.NETWORKS, "damped", atlas.settled(Damped()))
    values = atlas.measure(atlas.cell("damped", scheme="slow")).values
    assert values["rms_error_m"][0] < 1e-4


OUTSIDE = """
from dataclasses import dataclass
import numpy as np
from iiwa_dnn import Circle, DoubleIndicator, ProjectionNetwork
from iiwa_dnn.studies.atlas_disturbances import Disturbance

@dataclass(frozen=True, kw_only=True)
class Slow(ProjectionNetwork):
    def flow(self, qp, rate=None):
        inner = super().flow(qp)
        return inner._replace(rates=lambda state: 0.5 * inner.rates(state))

def scheme():
    return DoubleIndicator(weight=0.5)

small = Circle(radius=0.01, period=2.0)

class Push(Disturbance):
    def hold(self, k, velocity):
        velocity += 1e-3
"""


def test_parts_of_ones_own_come_from_files_and_from_modules(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.02)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "atlas_parts.py").write_text(OUTSIDE, encoding="utf-8")
    words = ["atlas", "--out", "a", "--seeds", "2", "--workers", "1", "--work", "3e3"]
    words += ["--networks", "dual", "atlas_parts:Slow", "atlas_parts.py:Slow"]
    words += ["--schemes", "atlas_parts:scheme"]
    words += ["--disturbances", "none", "atlas_parts:Push"]
    assert main(words) == 0
    report = capsys.readouterr().out
    rows = json.loads((tmp_path / "a" / "atlas.json").read_text(encoding="utf-8"))
    both = [row for row in rows if "Slow" in row["network"]]
    assert both[0]["residual"] == both[2]["residual"], "by either way the same"
    assert both[0]["residual"] != both[1]["residual"], "the push acts"
    assert both[0]["files"][0] == both[2]["files"][0]
    assert "| atlas_parts:Slow |" in report
    assert "# atlas_parts:Slow" in (tmp_path / "a" / "cards.md").read_text(encoding="utf-8")
    before = atlas.cell("atlas_parts.py:Slow")
    (tmp_path / "atlas_parts.py").write_text(OUTSIDE + "# changed", encoding="utf-8")
    assert atlas.cell("atlas_parts.py:Slow") != before, "a changed file makes new cells"


@pytest.mark.parametrize(
    ("option", "value", "reason"),
    [
        ("--networks", "nowhere:My", "network: nowhere cannot be imported (No module"),
        ("--networks", "nowhere.py:My", "network: nowhere.py cannot be imported ("),
        ("--networks", "math:My", "no network in math 'My'"),
        ("--networks", "math:pi", "network: math:pi is no Network: 3.14"),
        ("--networks", "zeroing, Eular", "no network 'zeroing, Eular'; did you mean: 'zeroing, E"),
        ("--schemes", "other", "no scheme 'other'"),
        ("--schemes", "math:pi", "scheme: math:pi is no Scheme"),
        ("--disturbances", "math:pi", "disturbance: math:pi is no Disturbance: 3.14"),
        ("--work", "-1", "work: must be a finite number above 0"),
        ("--seeds", "0", "seeds: "),
    ],
)
def test_wrong_options_are_named(
    option: str, value: str, reason: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["atlas", "--out", str(tmp_path), option, value]) == 2
    assert reason in capsys.readouterr().err


def row(network: str, values: list[float | None], kind: str = "none", **changes: object) -> dict:
    cell = atlas.cell(network, disturbance=kind, **changes) | {"seeds": len(values)}
    result = dict.fromkeys(atlas.MEASURES, values) | {"failures": [], "taken": [1, 100.0]}
    return atlas_report.tabulate([cell], [result])[0]


@pytest.mark.parametrize(
    ("better", "worse", "verdict"),
    [
        ([1.0, 1.1, 1.0], [2.0, 2.2, 2.1], "holds"),
        ([2.0, 2.2, 2.1], [1.0, 1.1, 1.0], "does not hold"),
        ([1.0, 2.0, 3.0], [2.0, 1.0, 3.1], "tie"),
        ([1.0, 2.0, 3.0], [1.01, 2.02, 3.03], "tie"),  # within the margin, though always smaller
        ([1e-15, 1e-14], [1e-13, 1e-12], "tie"),  # all of them solved
        ([1.0], [1.5], "holds"),
        ([None], [1.5], "does not hold"),
        ([1.0, 1.0], [None, 1.5], "holds"),
    ],
)
def test_verdicts_are_computed_by_pairs(better: list, worse: list, verdict: str) -> None:
    rows = [row("dual", better), row("gradient", worse)]
    assert atlas_report.judge(rows, atlas_report.Claim("", "dual", "gradient"))[-1] == verdict


def test_ties_share_their_places_and_failures_have_none() -> None:
    names = ["dual", "gradient", "one-layer", "primal-dual"]
    values = [[1.0, 1.2, 1.1], [30.0, 36.0, 33.0], [1.2, 1.0, 1.1], [None, 1.0, 1.0]]
    rows = [
        row(name, numbers, kind)
        for kind in ("none", "white")
        for name, numbers in zip(names, values, strict=True)
    ]
    places = {"dual": "1–2", "one-layer": "1–2", "gradient": "3", "primal-dual": "–"}
    assert atlas_report.places(rows) == places


def test_each_networks_gain_is_the_best_of_the_same_shares() -> None:
    size = atlas.Size(
        ["dual", "ADMM (OSQP)"], ["double indicator"], ["none"], ["heart"], [1e4], 1, 1
    )
    cells = atlas.gain_cells(size)
    pairs = [(share, most) for share in atlas.SHARES for most in (None, 1)]
    assert [(cell["share"], cell["most"]) for cell in cells] == [*pairs, (atlas.SHARES[-1], None)]
    residuals = [[3.0], [5.0], [2.0], [1.0], [None], [4.0], [4.0], [4.0], [None]]
    found = atlas.best_gains(cells, [{"residual": residual} for residual in residuals])
    assert found["dual"] == {"share": atlas.SHARES[1], "most": 1}
    assert found["ADMM (OSQP)"] == {"share": atlas.SHARES[-1], "most": None}
    solved = [[1e-15], [1e-16], [2e-15], [1e-14], [None], [4.0], [1e-12], [1e-17], [None]]
    found = atlas.best_gains(cells, [{"residual": residual} for residual in solved])
    assert found["dual"] == {"share": atlas.SHARES[-1], "most": None}, "rounding decides nothing"


def test_formulas_have_their_orders_against_the_control_period() -> None:
    cells = [
        atlas.cell(f"zeroing, {name}", work=atlas.UNLIMITED, most=1, dt=dt, share=0.4)
        for name in ("Euler", "Taylor 3")
        for dt in atlas.PERIODS[1:]
    ]
    rows = atlas_report.tabulate(cells, [atlas.measure(cell).values for cell in cells])
    slopes = [float(line[-1]) for line in atlas_report.orders(rows)]
    np.testing.assert_allclose(slopes, [2.0, 3.0], atol=0.15)


def test_every_claim_names_what_is_in_the_atlas() -> None:
    for claim in atlas_report.CLAIMS:
        assert {claim.better, claim.worse} <= set(atlas.NETWORKS)
        assert claim.disturbance in DISTURBANCES


def test_a_card_counts_one_evaluation_and_has_no_infinite_time() -> None:
    name = "zeroing, power-sigmoid"
    text = atlas_report.card([row(name, [1.0])], name, {name: "1"})
    assert "a control period: evaluations 1, operations 100" in text
    assert "settles from an error of 1 not within a bounded time" in text


def test_the_command_writes_a_report_and_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.02)
    claim = atlas_report.Claim("A claim", "zeroing, Euler", "dual")
    monkeypatch.setattr(atlas_report, "CLAIMS", (claim,))
    words = ["atlas", "--out", str(tmp_path / "a"), "--seeds", "2", "--other-seeds", "1"]
    words += ["--schemes", "double indicator", "minimum velocity", "--workers", "1"]
    words += ["--work", "3e3", "1e4", "--networks", *FEW]
    kinds = ["none", "white", "locked"]
    words += ["--disturbances", *kinds]
    assert main(words) == 0
    report = capsys.readouterr().out
    assert report == (tmp_path / "a" / "report.md").read_text(encoding="utf-8")
    rows = json.loads((tmp_path / "a" / "atlas.json").read_text(encoding="utf-8"))
    assert len(rows) == len(FEW) * (2 * len(kinds) + 2) + len(atlas.PERIODS)
    assert all((f"| {name} | " in report) == (name in FEW) for name in atlas.NETWORKS)
    assert "| A claim | none | zeroing, Euler: " in report
    assert " ours " not in report
    assert ", on heart, circle in turn; errors" in report, "of three paths, as many as seeds"
    assert "A place is formed by pairs of runs with the same seed" in report
    assert (tmp_path / "a" / "atlas.png").stat().st_size > 10_000
    with (tmp_path / "a" / "league.csv").open(encoding="utf-8") as file:
        table = list(csv.reader(file))
    assert len(table) == 1 + len(FEW)
    assert table[0][1] == "network"
    with (tmp_path / "a" / "seeds.csv").open(encoding="utf-8") as file:
        medians = {line["network"]: line for line in csv.DictReader(file)}
    two = next(row for row in rows if row["disturbance"] == "white")
    residual = np.array(two["residual"])
    counts = f"{np.sum(residual <= 1e-9)}, {np.sum(residual > 1.0)}"
    assert medians[two["network"]]["white"] == f"{residual.mean():.1e} ({counts})"  # of two seeds
    with (tmp_path / "a" / "firsts.csv").open(encoding="utf-8") as file:
        (line,) = csv.DictReader(file)
    name = line["first"].rpartition(" ")[0]
    own = [
        row["residual"][0]
        for row in rows
        if (row["network"], row["scheme"], row["work"]) == (name, "minimum velocity", 1e4)
    ]
    assert len(own) == len(kinds)
    mean = np.exp(np.mean(np.log(np.maximum(own, 1e-9))))
    assert line["first"] == f"{name} {mean:.1e}"
    latex = (tmp_path / "a" / "league.tex").read_text(encoding="utf-8")
    assert latex.count(r"\\") == len(table)
    assert r"\toprule" in latex
    cards = (tmp_path / "a" / "cards.md").read_text(encoding="utf-8")
    assert "Zhang, Wang" not in cards
    assert "Y. Zhang, J. Wang, Y. Xia" in cards, "the source"
    monkeypatch.setattr(atlas, "_run", None)  # nothing is computed again
    assert main([*words, "--quiet"]) == 0
