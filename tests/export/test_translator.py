"""The translator: what C computes is what Python computes, and what it does not know it refuses."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from helpers_export import both, needs, translated
from iiwa_dnn.errors import InvalidInputError

pytestmark = needs("gcc")

TABLE = np.array([2.0, 3.0, 5.0])
LIMIT = 4
PARTS = (0.5, 2.0)
SCALE = -1.5


class Two(NamedTuple):
    """A row and its length."""

    row: np.ndarray
    length: float


def _norm(x: np.ndarray) -> float:
    total = 0.0
    for i in range(x.size):
        total += x[i] * x[i]
    return math.sqrt(total)


def _pair(x: np.ndarray, k: int) -> tuple[float, float]:
    return x[k], x[k + 1]


def _count(x: np.ndarray) -> int:
    found = 0
    for i in range(x.size):
        if x[i] > 2.5:
            found += 1
    return found


def _two(rows: np.ndarray, k: int) -> Two:
    return Two(rows[k], _norm(rows[k]))


def integers(x: np.ndarray, out: np.ndarray) -> None:
    """Divide, shift and round as Python does, with negative numbers too."""
    for i in range(-7, 8):
        j = int(x[0]) + i
        out[i + 7] = j // 3 + 10.0 * (j % 3) + 100.0 * (j % -3) + 1000.0 * (j // -2)
        out[15 + i + 7] = (i * 0.7) % 2.0 + 10.0 * ((i * 0.7) % -2.0)
    out[30] = 1 << 4
    out[31] = 37 >> 2 & 1
    out[32] = int(x[1])
    out[33] = int(-x[1])
    out[34] = int(x[0]) / 2
    for i in range(9, -1, -3):
        out[35] += 2.0 * i


def conditions(x: np.ndarray, out: np.ndarray) -> None:
    """Compare with and without numbers that are none."""
    nan = x[1] - x[1] if x[0] > 100.0 else np.nan
    out[0] = min(nan, 1.0)
    out[1] = min(1.0, nan)
    out[2] = max(nan, 1.0, 2.0)
    out[3] = 1.0 if not nan > 0.0 else 2.0
    out[4] = 1.0 if 0.0 < x[0] <= x[1] else 2.0
    out[5] = 1.0 if x[0] > 0.0 or (x[1] > 5.0 and x[0] < 0.0) else 2.0
    out[6] = SCALE
    out[7] = -np.inf if x[0] > 0.0 else np.inf
    if x[0] > x[1]:
        last = 1.0
    elif x[0] == 3.0:
        last = 2.0
    else:
        last = 3.0
    out[8] = last
    k = 0
    while True and k < 10:
        k += 1
        if k == 2:
            continue
        if k > LIMIT:
            break
        out[9] += k


def arrays(x: np.ndarray, rows: np.ndarray, out: np.ndarray) -> None:
    """Slice, reshape, copy, swap and allocate."""
    first = x[:3]
    second = x[3:]
    first, second = second, first
    out[0] = first[0]
    out[1] = second[0]
    work = np.zeros((2, 3))
    work[1][2] = 4.0
    flat = np.empty(4)
    for i in range(flat.size):
        flat[i] = TABLE[i % TABLE.size]
    before = x.copy()
    x[0] = 100.0
    out[2] = before[0] + work[1, 2] + work[0, 0] + len(rows)
    for k in range(rows.shape[0]):
        own = _two(rows, k)
        out[3 + k] = own.length + own.row[1]
    a, b = _pair(flat, 2)
    out[6] = a - (b - 1.0)
    out[7] = rows[1, 1:][0] + rows[1:][0, 0]
    left = (a, b, 1.0)
    for i in range(3):
        out[8] += left[i]
    for end in PARTS:
        for other in (first[0], end):
            out[9] = 10.0 * out[9] + other
    out[12], out[13] = _pair(first, 1)
    for _ in range(_count(TABLE)):
        out[14] += 1.0
    square = x.reshape(2, 3)
    out[10] = square[1, 2]
    c = d = a**2 + b**3
    out[11] = c + d


def functions(x: np.ndarray, out: np.ndarray) -> None:
    """Call C's library."""
    out[0] = np.sin(x[0]) + np.cos(x[1])
    out[1] = np.arctan2(x[0], x[1]) + math.copysign(2.0, -x[0])
    out[2] = np.floor(-x[0]) + np.ceil(x[0]) + abs(-x[1])
    out[3] = np.pi / (x[0] - (x[1] - x[2])) / x[2] - -x[0]


def _capped(x: float, count: int) -> float:
    if x > 1.0:
        count = LIMIT
    return x * count if count == LIMIT else -x


def parameters(x: np.ndarray, out: np.ndarray) -> None:
    """Call a function with a known number, which it changes."""
    out[0] = _capped(x[0], 2)
    out[1] = _capped(-x[0], 2)
    free = x[1]
    out[2] = free


@pytest.mark.parametrize(
    ("function", "sizes"),
    [(integers, (2, 36)), (conditions, (2, 10)), (functions, (3, 4)), (parameters, (2, 3))],
    ids=lambda each: getattr(each, "__name__", ""),
)
def test_c_computes_what_python_does(function, sizes: tuple[int, ...], tmp_path: Path) -> None:
    x = np.array([3.0, 4.25, 0.3])[: sizes[0]]
    ours, theirs = both(function, tmp_path, x, np.zeros(sizes[1]))
    np.testing.assert_array_equal(ours[1], theirs[1])
    assert np.abs(ours[1][np.isfinite(ours[1])]).max() > 0.0


def test_arrays_are_pythons(tmp_path: Path) -> None:
    x = np.arange(6.0) + 1.0
    rows = np.arange(9.0).reshape(3, 3)
    ours, theirs = both(arrays, tmp_path, x, rows, np.zeros(15))
    for own, other in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(own, other)
    assert (ours[2] != 0.0).all()


def test_a_pointer_is_const_where_nobody_writes() -> None:
    text = translated(functions, (3,), (4,))
    assert "functions(const double *x, double *out)" in text
    assert "/* Call C's library." in text


def _calls_itself(x: np.ndarray) -> None:
    _calls_itself(x)


def _allocates_unknown(x: np.ndarray) -> None:
    work = np.empty(int(x[0]))
    x[0] = work[0]


def _takes_a_column(x: np.ndarray) -> None:
    x[0] = x[::2][1]


def _multiplies_arrays(x: np.ndarray) -> None:
    x[0] = x @ x


def _adds_arrays(x: np.ndarray) -> None:
    y = x + x
    x[0] = y[0]


def _uses_a_list(x: np.ndarray) -> None:
    y = [1.0, 2.0]
    x[0] = y[0]


def _calls_numpy(x: np.ndarray) -> None:
    x[0] = np.linalg.norm(x)


def _changes_its_type(x: np.ndarray) -> None:
    y = 1
    y = x[0]
    x[1] = y


def _returns_its_own_array(x: np.ndarray) -> None:
    y = _own(x)
    x[0] = y[0]


def _own(x: np.ndarray) -> np.ndarray:
    y = np.empty(x.size)
    return y


def _raises(x: np.ndarray) -> None:
    if x[0] > 0.0:
        raise ValueError


def _changes_its_loop(x: np.ndarray) -> None:
    for i in range(3):
        i += 1
        x[i] = 0.0


def _does_not_know(x: np.ndarray) -> None:
    x[0] = no_such_name  # noqa: F821


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (_calls_itself, "`_calls_itself(x)` calls itself"),
        (_allocates_unknown, "`work` has a size that is not known"),
        (_takes_a_column, "`::2` is a slice with a step"),
        (_multiplies_arrays, "`x` is no number"),
        (_adds_arrays, "`x` is no number"),
        (_uses_a_list, "[1.0, 2.0]"),
        (_calls_numpy, "np.linalg.norm(x)"),
        (_changes_its_type, "`y` was an integer before"),
        (_returns_its_own_array, "cannot be returned"),
        (_raises, "raise ValueError"),
        (_changes_its_loop, "`for i in range(3):` changes its own range"),
        (_does_not_know, "`no_such_name` is not known"),
    ],
    ids=lambda each: getattr(each, "__name__", ""),
)
def test_what_it_does_not_know_it_refuses_by_file_and_line(function, words: str) -> None:
    with pytest.raises(InvalidInputError, match=re.escape(words)) as caught:
        translated(function, (4,))
    first = function.__code__.co_firstlineno
    place = re.search(r"test_translator\.py:(\d+): ", str(caught.value))
    assert place is not None
    assert first <= int(place[1]) <= first + 20
