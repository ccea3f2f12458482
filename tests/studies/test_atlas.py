"""The atlas: its schemes, its runs, what becomes of their numbers, and the command."""

import json

import numpy as np
import pytest

from helpers_qp import known_qp
from iiwa_dnn import QP, Configuration, DNNSolver, Target
from iiwa_dnn.app.main import main
from iiwa_dnn.studies import atlas, atlas_report, paper
from iiwa_dnn.studies.runs import paper_robot

CLAIMS = atlas_report.CLAIMS
FEW = ("projection (the paper's)", "dual", "zeroing, Euler", "primal-dual, fixed time")


@pytest.mark.parametrize("name", atlas.SCHEMES)
def test_every_scheme_answers_the_task(name: str) -> None:
    robot = paper_robot()
    conf = Configuration(robot, paper.START)
    asked = [0.1, -0.05, 0.02]
    target = Target(conf.position, conf.rotation, asked)
    scheme = atlas.SCHEMES[name](robot)
    x = DNNSolver(tol=1e-8).solve(scheme.build_qp(conf, target, dt=1e-3)).x
    np.testing.assert_allclose(conf.jacobian[:3] @ x[:7], asked, atol=1e-6)


@pytest.mark.parametrize("kind", atlas.NOISES)
def test_networks_keep_the_path_under_every_disturbance(kind, monkeypatch) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.2)
    for name, most in (("zeroing, Euler", 2), ("dual", None)):  # whose state holds no x
        cell = atlas.Cell(name, disturbance=kind, most=most, fraction=0.4, seeds=2)
        once, again = (atlas.measure(cell) for _ in range(2))
        assert once["failures"] == []
        assert len(once["rms_error_m"]) == 2
        assert max(once["rms_error_m"]) < 2e-3
        assert once == again  # the seed draws all of it
        quiet = atlas.measure(atlas.Cell(name, most=most, fraction=0.4))
        assert (once["residual"][:1] == quiet["residual"]) == (kind == "none")


def test_disturbances_are_as_large_as_they_are_said_to_be() -> None:
    times = 2e-3 * np.arange(250.0)
    drawn = {kind: noise(np.random.default_rng(3), times) for kind, noise in atlas.NOISES.items()}
    rates = {kind: drawn[kind] / 2e-3 for kind in ("constant", "ramp", "sinusoid")}
    direction = rates["constant"][0]
    np.testing.assert_allclose(rates["constant"], np.tile(direction, (250, 1)), rtol=1e-12)
    np.testing.assert_allclose(rates["ramp"], np.outer(times, direction), rtol=1e-9, atol=1e-15)
    wave = np.sin(2.0 * np.pi * 5.0 * times)
    np.testing.assert_allclose(rates["sinusoid"], np.outer(wave, direction), atol=1e-12)
    assert 0.5 < np.linalg.norm(direction[:7]) < 1.6
    assert drawn["white"].std() == pytest.approx(0.01, rel=0.05)
    # As large as the white one at last, and correlated by a factor e over 50 ms, 25 periods.
    long = atlas.NOISES["coloured"](np.random.default_rng(3), 2e-3 * np.arange(5000.0))[500:]
    assert long.std() == pytest.approx(0.01, rel=0.05)
    assert np.mean(long[25:] * long[:-25]) == pytest.approx(1e-4 / np.e, rel=0.1)
    assert drawn["measurement"].std() == pytest.approx(1e-4, rel=0.05)
    assert not drawn["none"].any()


def test_a_network_that_diverges_is_a_number_less_and_a_reason_more() -> None:
    solved = atlas.measure(atlas.Cell("projection, implicit Euler"))
    assert solved["residual"][0] < 1e-12
    assert solved["rms_error_m"][0] < 1e-5  # the rows of now left 1e-4 m, not those of the next
    values = atlas.measure(atlas.Cell("zeroing, growing gain"))
    assert values["residual"] == [None]
    assert "the network diverged" in values["failures"][0]
    # A residual whose square is beyond all floats ended a whole league in a traceback.
    values = atlas.measure(atlas.Cell("dual, finite time", "minimum kinetic energy", "ramp"))
    assert values["failures"][0].startswith("the network diverged: a residual is ")
    unpaid = atlas.measure(atlas.Cell("zeroing, Euler", work=100.0))
    assert unpaid["rms_error_m"] == [None]
    assert "one evaluation takes" in unpaid["failures"][0]


@pytest.mark.parametrize("name", ["projection (the paper's)", "dual", "one-layer", "gradient"])
def test_the_linear_limit_is_where_steps_stop_to_come_nearer(name: str) -> None:
    network = atlas.entry_of(name).network
    rng = np.random.default_rng(4)
    qp, _ = known_qp(rng, 5, 3, 0)
    qp = QP(qp.P, qp.q, A=qp.A, b=qp.b)
    rates = network.flow(qp).rates
    start = rng.standard_normal(network.state_size(qp))
    limit = network.flow(qp).linear_limit(start)  # without bounds it is the same everywhere
    for fraction, nearer in ((0.97, True), (1.03, False)):
        state = start
        sizes = []
        for k in range(1200):
            state = state + fraction * limit * rates(state)
            if k >= 600:
                sizes.append(np.linalg.norm(rates(state)))
        assert bool(sizes[-1] < max(sizes[0], 1e-9)) is nearer  # below that it is rounding


def test_work_is_that_of_the_arrays_that_are_multiplied() -> None:
    """Counted by hand for n = 2, p = 1: two operations for each entry of each product."""
    sizes = (2, 0, 1)
    assert atlas.NETWORKS["one-layer, corrected"].work(sizes) == (0.0, 4 * (4 + 2 + 2))
    assert atlas.NETWORKS["dual"].work(sizes)[1] == 2 * 3 * 3
    entry = atlas.NETWORKS["zeroing, Euler"]
    setup, each = entry.work(sizes)
    assert each == 32 + 18 + 18
    assert atlas.evaluations_within(entry, sizes, setup + 3.5 * each) == 3
    for entry in atlas.NETWORKS.values():
        assert sum(entry.work((14, 0, 12))) > 3.9 * sum(entry.work((7, 0, 6)))


OUTSIDE = """
from dataclasses import dataclass
import numpy as np
from iiwa_dnn import ProjectionNetwork

@dataclass(frozen=True, kw_only=True)
class Slow(ProjectionNetwork):
    def flow(self, qp, rate=None):
        inner = super().flow(qp)
        return inner._replace(rates=lambda state: 0.5 * inner.rates(state))

class Short(Slow):
    def flow(self, qp, rate=None):
        return super().flow(qp)._replace(rates=lambda state: state[:2])

class Faulty(Slow):
    def flow(self, qp, rate=None):
        return super().flow(qp)._replace(rates=lambda state: 1 / 0)
"""


def test_a_network_of_ones_own_comes_from_a_file_or_a_module(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.setattr(atlas, "DURATION", 0.02)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "atlas_parts.py").write_text(OUTSIDE, encoding="utf-8")
    words = ["atlas", "--out", "a", "--seeds", "2", "--workers", "1", "--work", "3e3"]
    # Undisturbed runs are there unasked: without them it ended in an IndexError.
    words += ["--disturbances", "white"]
    words += ["--networks", "dual", "atlas_parts:Slow", "atlas_parts.py:Slow"]
    assert main(words) == 0
    report = capsys.readouterr().out
    rows = json.loads((tmp_path / "a" / "atlas.json").read_text(encoding="utf-8"))
    assert {row["disturbance"] for row in rows} == {"none", "white"}
    both = [row for row in rows if "Slow" in row["network"]]
    assert both[0]["residual"] == both[2]["residual"], "by either way the same"
    assert both[0]["source"] == both[2]["source"] != ""
    assert "| atlas_parts:Slow " in report
    words += ["atlas_parts:Short", "atlas_parts:Faulty"]
    assert main([*words, "--overwrite"]) == 1  # the others' rows are there all the same
    report = " ".join(capsys.readouterr().out.split())
    assert all(row in json.loads((tmp_path / "a" / "atlas.json").read_text()) for row in rows)
    assert "| atlas_parts:Short | white | rates of Short: has shape (2,), not (27,) |" in report
    assert "| atlas_parts:Faulty | none | ZeroDivisionError: division by zero |" in report
    assert main([*words, "-q"]) == 1
    assert "rates of Short: has shape (2,), not (27,)\nZero" in capsys.readouterr().err
    other = tmp_path / "my-own" / "my-parts.py"
    other.parent.mkdir()
    other.write_text(OUTSIDE, encoding="utf-8")
    assert atlas.Cell(f"{other}:Slow").source == atlas.Cell("my-own/my-parts.py:Slow").source
    before = atlas.Cell("atlas_parts.py:Slow")
    (tmp_path / "atlas_parts.py").write_text(OUTSIDE + "# changed", encoding="utf-8")
    assert atlas.Cell("atlas_parts.py:Slow") != before, "a changed file makes new cells"


def row(network: str, values: list[float | None], kind: str = "none", **changes: object) -> dict:
    cell = atlas.Cell(network, disturbance=kind, seeds=len(values), **changes)
    result = dict.fromkeys(atlas.MEASURES, values) | {"failures": [], "taken": [1, 100.0]}
    return atlas_report.tabulate([cell], [result])[0] | {"seeds": len(values)}


@pytest.mark.parametrize(
    ("better", "worse", "verdict"),
    [
        ([1.0, 1.1, 1.0], [2.0, 2.2, 2.1], "holds"),
        ([2.0, 2.2, 2.1], [1.0, 1.1, 1.0], "does not hold"),
        ([1.0, 2.0, 3.0], [2.0, 1.0, 3.1], "tie"),
        ([1.0, 2.0, 3.0], [1.01, 2.02, 3.03], "tie"),  # within the margin, though always smaller
        ([1e-15, 1e-14], [1e-13, 1e-12], "tie"),  # all of them solved
        ([None], [1.5], "does not hold"),
        ([1.0, 1.0], [None, 1.5], "holds"),
    ],
)
def test_verdicts_are_computed_by_pairs(better: list, worse: list, verdict: str) -> None:
    rows = [row("dual", better), row("gradient", worse)]
    assert atlas_report.judge(rows, atlas_report.Claim("", "dual", "gradient"))[-1] == verdict


def test_ties_share_their_ranks_and_failures_have_none() -> None:
    names = ["dual", "gradient", "one-layer", "primal-dual"]
    values = [[1.0, 1.2, 1.1], [30.0, 36.0, 33.0], [1.2, 1.0, 1.1], [None, 1.0, 1.0]]
    rows = [
        row(name, numbers, kind)
        for kind in ("none", "white")
        for name, numbers in zip(names, values, strict=True)
    ]
    ranks = {"dual": "1–2", "one-layer": "1–2", "gradient": "3", "primal-dual": "–"}
    assert atlas_report.ranks(rows) == ranks


def test_each_networks_gain_is_the_best_of_the_same_fractions() -> None:
    size = atlas.Size(["dual", "ADMM (OSQP)"], disturbances=["none"], work=1e4)
    cells = atlas.gain_cells(size)
    pairs = [(fraction, most) for fraction in atlas.FRACTIONS for most in (None, 1)]
    assert [(cell.fraction, cell.most) for cell in cells] == [*pairs, (atlas.FRACTIONS[-1], None)]
    residuals = [[3.0], [5.0], [2.0], [1.0], [None], [4.0], [4.0], [4.0], [None]]
    found = atlas.best_gains(cells, [{"residual": residual} for residual in residuals])
    assert found["dual"] == {"fraction": atlas.FRACTIONS[1], "most": 1}
    assert found["ADMM (OSQP)"] == {"fraction": atlas.FRACTIONS[-1], "most": None}
    solved = [[1e-15], [1e-16], [2e-15], [1e-14], [None], [4.0], [1e-12], [1e-17], [None]]
    found = atlas.best_gains(cells, [{"residual": residual} for residual in solved])
    assert found["dual"] == {"fraction": atlas.FRACTIONS[-1], "most": None}, (
        "rounding decides nothing"
    )


def test_every_seed_disturbs_a_run_and_those_without_differ_by_their_paths_alone() -> None:
    size = atlas.Size(["dual"], list(atlas.SCHEMES)[:2], ["white"], seeds=9)
    cells = atlas.cells(size, {"dual": {"fraction": 0.4, "most": None}})
    seeds = [(cell.scheme, cell.disturbance, cell.seeds) for cell in cells]
    first, second = size.schemes
    assert seeds == [(first, "none", 3), (first, "white", 9), (second, "none", 3)]


def test_formulas_have_their_orders_against_the_control_period() -> None:
    cells = [
        atlas.Cell(f"zeroing, {name}", work=atlas.UNLIMITED, most=1, dt=dt, fraction=0.4)
        for name in ("Euler", "Taylor 3")
        for dt in atlas.PERIODS[1:]
    ]
    rows = atlas_report.tabulate(cells, [atlas.measure(cell) for cell in cells])
    slopes = [float(line[-1]) for line in atlas_report.orders(rows)]
    np.testing.assert_allclose(slopes, [2.0, 3.0], atol=0.15)


def test_the_command_writes_a_report_and_goes_on_where_it_was(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(atlas, "DURATION", 0.02)
    claim = atlas_report.Claim("A claim", "zeroing, Euler", "dual")
    monkeypatch.setattr(atlas_report, "CLAIMS", (claim,))
    words = ["atlas", "--out", str(tmp_path / "a"), "--seeds", "2", "--workers", "1"]
    words += ["--schemes", "double indicator", "minimum velocity", "--networks", *FEW]
    kinds = ["none", "white"]
    words += ["--disturbances", *kinds]
    assert main(words) == 0
    report = capsys.readouterr().out
    assert report.strip() == (tmp_path / "a" / "report.md").read_text(encoding="utf-8").strip()
    rows = json.loads((tmp_path / "a" / "atlas.json").read_text(encoding="utf-8"))
    assert len(rows) == len(FEW) * (len(kinds) + 1) + len(atlas.PERIODS)
    assert all((f"| {name} " in report) == (name in FEW) for name in atlas.NETWORKS)
    assert "| A claim " in report
    for claim in CLAIMS:
        assert {claim.better, claim.worse} <= set(atlas.NETWORKS)
        assert claim.disturbance in atlas.NOISES
    for name in ("league", "errors", "verdicts", "orders", "schemes"):
        latex = (tmp_path / "a" / f"{name}.tex").read_text(encoding="utf-8")
        assert r"\toprule" in latex
        assert latex.count(r"\\") == {"verdicts": 2, "orders": 2}.get(name, 1 + len(FEW))
    monkeypatch.setattr(atlas, "_run", None)  # nothing is computed again
    assert main([*words, "--quiet"]) == 0
