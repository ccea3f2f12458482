"""Tables of times that pages quote."""

import sys

import pytest

from benchmarks import public_call, rates


def test_public_calls_are_timed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["benchmarks.public_call", "3"])
    public_call.main()
    row = capsys.readouterr().out.splitlines()[-1].strip("| ").split(" | ")
    assert row[0] == "3"
    own, daqp, piqp = (float(v) for v in row[1:4])
    assert float(row[4]) == pytest.approx(own / daqp, abs=0.02)
    assert float(row[5]) == pytest.approx(own / piqp, abs=0.02)


def test_every_kind_of_step_is_timed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(rates, "STEPS", 40)
    monkeypatch.setattr(rates, "FIRST", 10)
    rates.main()
    rows = [line.strip("| ").split(" | ") for line in capsys.readouterr().out.splitlines()[2:]]
    assert len(rows) == 9
    assert all(0.0 < float(median) <= float(p99) for _, median, p99 in rows)
