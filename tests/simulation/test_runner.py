"""A run that is interrupted keeps the steps that were taken, and says so."""

from typing import Any

import pytest
from numpy.testing import assert_array_equal

import iiwa_dnn as d
from helpers_simulation import run
from iiwa_dnn.errors import RunInterrupted
from iiwa_dnn.simulation import IdealPlant, runner


class Stopping(IdealPlant):
    """A plant during one of whose moves Ctrl-C is pressed."""

    def __init__(self, at: int) -> None:
        self.left = at

    def move(self, command: Any) -> Any:
        if self.left == 0:
            raise KeyboardInterrupt(15)
        self.left -= 1
        return super().move(command)


@pytest.mark.parametrize("at", [1, 1000, 1250])
@pytest.mark.parametrize("motion", ["euler", "midpoint"])
def test_an_interrupted_run_is_the_beginning_of_the_whole_one(at: int, motion: str) -> None:
    options = {"check": d.CrossCheck(("osqp",)), "motion": motion}
    whole = run(duration=0.001 * (at + 1), **options)
    with pytest.raises(RunInterrupted) as raised:
        run(duration=1.5, plant=Stopping(at), **options)
    record = raised.value.record
    assert raised.value.args == (15,)
    assert (record.steps, record.settings["status"]) == (at, "interrupted")
    for name in ("t", "q", "position", "position_desired"):
        assert_array_equal(getattr(record, name), getattr(whole, name)[:-1])
    for name in ("dq", "kkt_residual", "solution_gap", "judge"):
        assert_array_equal(getattr(record, name), getattr(whole, name)[:at])
    reasons = d.failures(record)
    assert f"ended after {at:,} of 1,500 steps: interrupted" in reasons
    assert not any("not checked" in reason for reason in reasons)


def test_steps_that_were_on_their_way_to_the_check_are_left_out(monkeypatch) -> None:
    submit = runner.CheckPool.submit

    def stop(pool: Any, *block: Any) -> None:
        if len(pool._verdicts) > 1:  # the second block
            raise KeyboardInterrupt
        submit(pool, *block)

    monkeypatch.setattr(runner.CheckPool, "submit", stop)
    with pytest.raises(RunInterrupted) as raised:
        run(duration=3.0, check=d.CrossCheck(("osqp",)))
    assert raised.value.record.steps == 1000


def test_an_interrupt_before_the_first_step_is_nothing_else() -> None:
    with pytest.raises(KeyboardInterrupt) as raised:
        run(plant=Stopping(0))
    assert type(raised.value) is KeyboardInterrupt
