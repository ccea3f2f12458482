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
    found = rates.cases()
    some = {name: found[name] for name in ("the heart", "a limit active", "jumps")}
    assert len(found) == 24
    monkeypatch.setattr(rates, "cases", lambda: some)
    rates.main(40)
    lines = capsys.readouterr().out.splitlines()[2:]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    assert [row[0] for row in rows] == [*some, "only the clock"]
    for _, _, *words in rows:
        times = [float(word) for word in words]
        assert 0.0 <= times[0] <= times[1] <= times[2] <= times[3]
