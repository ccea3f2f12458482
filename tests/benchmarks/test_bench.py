"""The benchmark: its streams are what they say, its peers answer right, its script writes."""

import json

import numpy as np
import pytest

from benchmarks import measurement, peers, streams
from benchmarks.cli import bench_solvers
from benchmarks.peers import PEERS, Network, Peer
from benchmarks.report import verdict
from helpers_qp import known_qp
from iiwa_dnn import DNNSolver


def test_drifting_programs_are_slow_feasible_and_have_three_to_five_active_bounds() -> None:
    programs, x = streams.drifting(1500)
    counts = [streams.active_at_limits(qp, at) for qp, at in zip(programs, x, strict=True)]
    assert set(counts) == {3, 4, 5}
    assert np.abs(np.diff(x, axis=0)).max() < 0.02
    solver = DNNSolver()
    for qp, at in zip(programs[::50], x[::50], strict=True):
        np.testing.assert_allclose(solver.solve(qp).x, at, atol=1e-6)


def test_the_large_heart_lies_at_its_limit_for_over_a_third_of_its_steps() -> None:
    programs, solver = streams.heart(500, 10.0 / 500, 0.008), DNNSolver()  # all of its 10 s
    at_limit = [streams.active_at_limits(qp, solver.solve(qp).x, 1e-6) > 0 for qp in programs]
    assert sum(at_limit) > len(programs) / 3
    idle = streams.heart(50, 1e-4)
    assert all(streams.active_at_limits(qp, solver.solve(qp).x, 1e-3) == 0 for qp in idle)


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
@pytest.mark.parametrize("warm", [False, True])
def test_every_peer_is_asked_and_read_rightly(peer: type[Peer], warm: bool) -> None:
    rng = np.random.default_rng(0)
    asked = peer(warm)
    for _ in range(3):
        qp, x = known_qp(rng, 7, 2, 2, inequalities=4)
        answer = asked.solve(asked.convert(qp))
        point = asked.point(qp, answer)
        np.testing.assert_allclose(point[0], x, atol=1e-6)
        assert qp.residuals(*point).largest < 1e-6  # multipliers and their signs too


def test_what_fails_is_counted_and_not_averaged() -> None:
    class Liar(Network):
        name = "liar"

        def point(self, qp, answer):
            return answer.x + 1.0, answer.y, answer.z, answer.z_box

    class Mute(Network):
        name = "mute"

        def solve(self, given):
            raise ValueError("no")

    rng = np.random.default_rng(1)
    stream = streams.Stream("s", "a", [known_qp(rng, 4, 1, 1)[0] for _ in range(60)], True)
    rows = measurement.measure_stream(stream, (Network, Liar, Mute))
    assert [row["failed"] for row in rows] == [0, 60, 60]
    assert rows[0]["worst_residual"] <= 1e-9
    assert rows[1]["worst_residual"] is None
    made = [{"solver": "us", "median_us": 2.0, "failed": 0},
            {"solver": "wrong", "median_us": 0.5, "failed": 1},
            {"solver": "right", "median_us": 4.0, "failed": 0}]  # fmt: skip
    assert verdict(made) == "iiwa_dnn takes 0.50 times what the quickest peer takes, right."


def test_the_script_writes_its_report(tmp_path, capsys, monkeypatch) -> None:
    some = PEERS[:3]  # each of them answers above
    monkeypatch.setattr(peers, "PEERS", some)
    arguments = ["--steps", "60", "--cold", "50", "--out", str(tmp_path)]
    assert bench_solvers([*arguments, "--quiet"]) == 0
    for name in ("report.md", "results.json", "times.png", "times.pdf"):
        assert (tmp_path / name).stat().st_size > 1000, name
    results = json.loads((tmp_path / "results.json").read_text())
    assert [stream["name"] for stream in results["streams"]][:2] == [
        "heart, limits idle",
        "heart, at a limit",
    ]
    for stream in results["streams"]:
        assert stream["rows"][0]["solver"] == "iiwa_dnn"
        assert stream["rows"][0]["failed"] == 0
        assert len(stream["rows"]) == len(some)
    assert [row["recognised"] for row in results["known"]] == [500, 50, 10]
    report = (tmp_path / "report.md").read_text()
    assert "known by construction" in report
    assert str(tmp_path / "report.md") in capsys.readouterr().out


def test_bad_arguments_are_refused_in_one_line(tmp_path, capsys) -> None:
    assert bench_solvers(["--steps", "3", "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith("bench_solvers: error: --steps")
