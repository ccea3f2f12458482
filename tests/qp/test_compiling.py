"""Functions that are entered by their address, and the clock of the compiler."""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numba import config, njit, types

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot
from iiwa_dnn import DoubleIndicator, Robot, simulate
from iiwa_dnn.qp import compiling
from iiwa_dnn.qp.compiling import VECTOR, Signature, Watch, borrowed, outlived
from iiwa_dnn.qp.layout import QP_VIEWS, QPViews, Vector, compiled, qp_views


@compiled
def _first_and_sum(values: Vector, count: int, factor: float) -> tuple[int, float]:
    """Return the first value, cut to an integer, and the scaled sum of `count` values."""
    total = 0.0
    for i in range(count):
        total += values[i]
    return int(values[0]), factor * total


_SUM = Signature(types.Tuple([types.int64, types.float64]), VECTOR, types.int64, types.float64)
_enter = _SUM.enter


@compiled
def _twice(address: int, values: Vector) -> float:
    """Enter the function with arguments of other types than its own."""
    first, total = _enter(address, values, np.int32(values.size), 2)
    return first + total


def test_a_function_entered_by_its_address_answers_as_if_it_were_called() -> None:
    values = np.array([3.7, 1.0, -2.5])
    for _ in range(2):
        assert _twice(_SUM.address(_first_and_sum), values) == 3 + 2.0 * 2.2


_COST = Signature(types.float64, QP_VIEWS, VECTOR)


@compiled
def _linear_cost(qp: QPViews, x: Vector) -> float:
    """Return q x."""
    total = 0.0
    for i in range(x.size):
        total += qp.q[i] * x[i]
    return total


@compiled
def _bound_cost(qp: QPViews, x: Vector) -> float:
    """Return ub x."""
    total = 0.0
    for i in range(x.size):
        total += qp.ub[i] * x[i]
    return total


_enter_cost = _COST.enter


@compiled
def _cost_at(address: int, data: Vector, x: Vector) -> float:
    """Enter one of several functions of one signature."""
    return _enter_cost(address, qp_views(data, 2, 0, 0), x)


def test_functions_of_one_signature_take_the_views_of_a_program() -> None:
    data = np.array([1.0, 0.0, 0.0, 1.0, 3.0, 4.0, -1.0, -1.0, 5.0, 6.0])
    x = np.array([1.0, 2.0])
    assert _cost_at(_COST.address(_linear_cost), data, x) == 11.0
    assert _cost_at(_COST.address(_bound_cost), data, x) == 17.0


@compiled
def _sum_of_borrowed(n: int) -> tuple[float, Vector]:
    """Add up a borrowed view after an array was made that would take its memory, were it free."""
    owner = np.zeros(n)
    view = borrowed(owner)
    for i in range(n):
        view[i] = 1.0
    other = np.zeros(n)
    total = 0.0
    for i in range(n):
        other[i] = 2.0
        total += view[i]
    outlived(owner)
    return total, other


@pytest.mark.parametrize("n", [8, 100, 1000])
def test_the_owner_of_a_borrowed_view_lives_until_it_is_said_to_be_outlived(n: int) -> None:
    total, other = _sum_of_borrowed(n)
    assert total == n
    np.testing.assert_array_equal(other, 2.0)


@pytest.mark.skipif(config.DISABLE_JIT, reason="nothing has a type then")
def test_a_function_of_another_type_is_refused() -> None:
    with pytest.raises(TypeError, match="float64"):
        _SUM.address(compiled(lambda values, count, factor: values[0]))
    with pytest.raises(TypeError, match="not compiled"):
        _SUM.address(len)


def test_compiling_is_said_once_and_timed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = iter([1.0, 4.0, 10.0, 10.5])
    monkeypatch.setattr(_twice.py_func, "__module__", "iiwa_dnn.control.step")
    monkeypatch.setattr(compiling, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    monkeypatch.setattr("iiwa_dnn.qp.compiling.event.register", lambda *_: None)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    watch, own = Watch(), SimpleNamespace(data={"dispatcher": _twice})
    for begins in (True, True, False, False, True, False):  # one inside another, and one more
        (watch.on_start if begins else watch.on_end)(own)
    assert watch.seconds == 3.5
    assert capsys.readouterr().err == compiling.NOTICE + "\n"


def test_functions_without_a_module_compile() -> None:
    made: dict[str, Any] = {}
    exec("def double(x):\n    return 2 * x", {"__name__": None}, made)
    assert njit(made["double"])(21) == 42


def test_compiling_is_not_wall_time_of_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    ask = DoubleIndicator.program

    def program(self: DoubleIndicator, robot: Robot) -> object:
        compiling.WATCH.seconds += 1000.0
        return ask(self, robot)

    monkeypatch.setattr(DoubleIndicator, "program", program)
    record = simulate(paper_robot(), DoubleIndicator(), heart(), PAPER_Q0, dt=1e-4, duration=1e-3)
    assert record.wall_time_s is not None
    assert record.wall_time_s < -900.0
