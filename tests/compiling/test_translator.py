"""Each construct of the subset: Python's own bits, and refusals by file and line."""

import importlib.util
import re
import shutil
from copy import deepcopy
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from iiwa_dnn.compiling.build import build
from iiwa_dnn.compiling.sources import TranslationError
from iiwa_dnn.compiling.translator import Translator

HEAD = """
import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

Vector = Matrix = IntVector = IntMatrix = np.ndarray
Pair = tuple[float, float]


def compiled(function):
    return function


released = entry = compiled


class Kind(IntEnum):
    FIRST = 3
    SECOND = 4


class Views(NamedTuple):
    data: Vector
    rows: Matrix
    rate: float


FIRST, SECOND = map(int, Kind)
LOW, HIGH = range(2)
TABLE = (0.5, 0.25, 2.0)
LIMIT = np.finfo(float).eps
LARGE = 10.0 ** 3
"""

KERNELS = (
    HEAD
    + '''
@compiled
def arithmetic(a: float, b: float, i: int, j: int) -> tuple[float, float, float, float]:
    """Compute with numbers of both kinds."""
    return a + b * -a - (a - b) / b, a % b, i / j, a * a - (b - (a - b))


@compiled
def whole(i: int, j: int) -> tuple[int, int, int, int]:
    return i // j, i % j, min(i, j), max(i, j)


@compiled
def functions(a: float, b: float) -> tuple[float, float, float, float, float, float, float]:
    return (
        np.sqrt(abs(a)) + math.sqrt(abs(b)),
        math.sin(a) * math.cos(b) + math.log(1.0 + a * a),
        math.atan2(a, b),
        math.copysign(a, b),
        float(math.ceil(a) - math.floor(b)),
        min(min(a, b), 0.5) + max(max(a, b), -0.5),
        math.tanh(a) + math.exp(b),
    )


@compiled
def decisions(a: float, b: float, i: int) -> int:
    found = 0
    if -1.0 < a <= 1.0 and not b > 0.0 or i == 2:
        found += 1
    elif i > 3:
        found -= 2
    else:
        found = 10 if a < b else 20
    found += a < b
    return -found


@compiled
def loops(values: Vector, n: int) -> float:
    total = 0.0
    for i in range(n):
        if values[i] < -1.0:
            continue
        if values[i] > 2.0:
            break
        total += values[i]
    for i in range(1, n):
        n -= 1  # the range is that of its beginning
        total *= 1.0 + 1e-3 * values[i]
    ends = (1.0, -1.0)
    for i in range(len(TABLE)):
        for k in range(2):
            total *= TABLE[i] + 0.1 * ends[k]
    while total > 1.0:
        total = total / 3
    for _ in range(2):
        for _ in range(3):
            total += 0.1
    return total


@compiled
def arrays(values: Vector, rows: Matrix, counts: IntVector) -> None:
    own = np.empty((2, values.size))
    other = np.zeros(values.size)
    kept = values.copy()
    own[:] = 0.5
    own[0] = -0.0
    for i in range(values.size):
        own[0, i] += values[i]
    for i in range(rows.shape[0]):
        own[1, i] *= 0.25
        rows[i, 0] += own[1, i] + len(rows)
    grid = kept[: 2 * (kept.size // 2)].reshape(2, kept.size // 2)
    second = own[1]
    part = second[1 : values.size]
    for i in range(part.size):
        values[i] = part[i] - other[i] + grid[0, 0] + rows.size
    counts[2] = counts[0] - counts[1]


@compiled
def precedence(a: float, b: float, i: int, j: int) -> tuple[float, float, float, float]:
    less = a < b
    both = (not less) == (b < a)
    c = a - (b - (a + b)) * -(-a) / (b * (a / (b + 3.0) + 0.1))
    d = (a if less else b if both else -a) * (2 * i - (i - j)) + i // 2 * 2
    e = -(a + b) * (a - b) - (-1) * (i * (j - i)) if less or both and not i > j else 0
    return c, d, e, (1 if less else i) + j


@compiled
def scopes(a: float, n: int) -> float:
    """Write variables in branches, loops: in both, in one that goes on, in loops of their own."""
    if a > 0.0:
        new = a
        this = 2
    elif a < -1.0:
        return -1.0
    else:
        new = 2.0 * a
        this = 3
    total = new * this
    for i in range(n):
        part = i * a
        if part > 1.0:
            break
        elif part < -0.5:
            part = -part
        total += part
    for k in range(n):
        part = k - a
        other = part
        for i in range(n):
            other = other * 0.5 + part
        if k == 1:
            continue
        total += other
    return total


@compiled
def tick(counts: IntVector) -> int:
    counts[0] += 1
    return counts[0]


@compiled
def once(counts: IntVector) -> bool:
    return 0 < tick(counts) < 10


@compiled
def views_of(data: Vector, n: int) -> Views:
    return Views(data[:n], data[n:].reshape((data.size - n) // n, n), 2.0)


@compiled
def change(views: Views, factor: float) -> Pair:
    for i in range(views.data.size):
        views.data[i] *= factor
        views.rows[0, i] -= views.rate
    return views.data[0], views.rows[0, 0]


@compiled
def shift(views: Views) -> None:
    fill(views.data)


@compiled
def fill(values: Vector) -> None:
    values[0] += 1.0


@compiled
def aliased(data: Vector, other: Vector, views: Views) -> float:
    """Write the data by another name, a row of views by two others; the other array is read."""
    flags = data
    flags[0] = 3.0
    own = views_of(data, data.size // 2)
    made = Views(other, views.rows, 0.5)
    rows = made.rows
    rows[0][0] = made.data[0] + own.rate
    return flags[0]


@compiled
def behind(data: Vector, n: int) -> float:
    """Write through a view that another kernel returns."""
    part = views_of(data, n).rows
    fill(part[0])
    return data[n]


@released
def views(data: Vector, n: int) -> float:
    own = views_of(data, n)
    a, _ = change(own, 1.5)
    _, b = change(views_of(data, n), 0.5)
    shift(own)
    x = a
    y = a
    x += change(own, 1.0)[HIGH]
    return x + y * b


@compiled
def constants(a: float) -> float:
    sum = SECOND + FIRST + LOW
    other = LARGE if a < np.inf else -np.inf
    return a * TABLE[1] + LIMIT + sum + other


@entry
def enter(address: int, views: Views, factor: float) -> Pair:
    """Enter a function like `change`."""


@compiled
def scratch(n: int) -> float:
    large = np.zeros((n, n))
    total = 0.0
    for i in range(n):
        row = np.empty(n)
        for k in range(n):
            row[k] = 1.0 / (i + 1)
            large[i, k] = row[k]
        total += large[i, n - 1]
    return total
'''
)


def _module(path: Path, name: str) -> ModuleType:
    spec: Any = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module", params=["0", "1"])
def both(request: Any, tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Any]:
    """The kernels above as Python and as a library, plain and checked."""
    folder = tmp_path_factory.mktemp("kernels") / "package"
    folder.mkdir()
    (folder / "own.py").write_text(KERNELS)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IIWA_DNN_CHECKED", request.param)
        return _module(folder / "own.py", "nominal"), _module(build(folder), "_kernels")


RNG = np.random.default_rng(0)
NUMBERS = [0.0, -0.0, 0.3, -1.7, 2.5, 1e-300, -7.25, 1e17]
CALLS: list[tuple[Any, ...]] = [
    *(("arithmetic", a, b, *ij) for a in NUMBERS for b in (0.7, -3.1) for ij in ((7, -3), (-7, 2))),
    *(("functions", a, b) for a in NUMBERS[:-1] for b in (0.7, -3.1, -0.0)),
    *(("functions", *RNG.standard_normal(2).tolist()) for _ in range(500)),
    *(("decisions", a, b, i) for a in NUMBERS for b in (0.5, -0.5) for i in (0, 2, 3, 9)),
    *(("loops", 2.0 * RNG.standard_normal(n), n) for n in range(1, 9)),
    *(("arrays", RNG.random(n), RNG.random((2, 4)), np.arange(3)) for n in (3, 4, 7)),
    *(("views", RNG.random(3 * n), n) for n in (1, 2, 5)),
    *(("precedence", a, b, *ij) for a in NUMBERS for b in (0.7, -3.1) for ij in ((7, 2), (-3, 2))),
    *(("scopes", a, n) for a in NUMBERS for n in (0, 1, 3)),
    *(("once", np.array([k, 0])) for k in (-5, 3, 9)),
    *(("whole", i, j) for i in (7, -7, 0) for j in (3, -2, 1)),
    ("constants", 0.3),
    ("behind", RNG.random(6), 2),
    *(("scratch", n) for n in (1, 50, 300)),
]


@pytest.mark.parametrize("name", sorted({str(call[0]) for call in CALLS}))
def test_the_library_has_the_bits_of_python(both: tuple[Any, Any], name: str) -> None:
    python, library = both
    for _, *arguments in [call for call in CALLS if call[0] == name]:
        ours, theirs = deepcopy(arguments), deepcopy(arguments)
        expected = getattr(python, name)(*ours)
        found = getattr(library, f"own_{name}")(*theirs)
        assert np.array(found).tobytes() == np.array(expected).tobytes(), arguments
        for mine, other in zip(ours, theirs, strict=True):
            assert np.asarray(mine).tobytes() == np.asarray(other).tobytes()


def test_named_tuples_come_from_python_too(both: tuple[Any, Any]) -> None:
    python, library = both
    one, other = (python.Views(np.arange(2.0), np.ones((1, 2)), 0.5) for _ in range(2))
    assert library.own_change(one, 3.0) == python.change(other, 3.0)
    np.testing.assert_array_equal(one.data, other.data)


WRONG: list[tuple[Any, ...]] = [
    (np.zeros(3),),
    (np.zeros(3), 2, 1),
    (np.zeros((3, 1)), 3),
    (np.zeros(3, dtype=np.float32), 3),
    (np.zeros(6)[::2], 3),
    ([0.0, 1.0], 2),
    (np.zeros(3), 2.5),
]


@pytest.mark.parametrize("arguments", WRONG)
def test_wrong_arguments_are_errors(both: tuple[Any, Any], arguments: tuple[Any, ...]) -> None:
    with pytest.raises(TypeError):
        both[1].own_loops(*arguments)


def test_a_closed_array_is_read_and_never_written(both: tuple[Any, Any]) -> None:
    closed = np.ones(4)
    closed.flags.writeable = False
    assert both[1].own_loops(closed, 4) == both[0].loops(closed, 4)
    views = both[0].Views(closed, np.ones((1, 2)), 0.5)
    for name, *arguments in (
        ("arrays", closed, np.ones((2, 4)), np.arange(3)),
        ("fill", closed),
        ("shift", views),
        ("change", views, 1.0),
        ("aliased", closed, np.ones(2), views),
        ("aliased", np.ones(2), np.ones(2), both[0].Views(np.ones(2), closed.reshape(2, 2), 0.5)),
        ("behind", closed, 2),
    ):
        with pytest.raises(TypeError, match="is read-only"):
            getattr(both[1], f"own_{name}")(*arguments)
    assert closed.tolist() == [1.0] * 4
    assert both[1].own_aliased(np.ones(2), closed, views) == 3.0  # which it reads alone


REFUSED = [
    ("def f(a) -> None:\n    pass", "`a` has no annotation"),
    ("def f(a: tuple[int, float]) -> None:\n    pass", "`tuple[int, float]` is no type"),
    ("def f(a: float, *, b: float) -> float:\n    return b", "name 'b' is not defined"),
    ("def f(a: int) -> int:\n    return a**2", "`return a ** 2` has no translation"),
    ("def f() -> None:\n    g()\n@compiled\ndef g(a: float) -> None:\n    pass", "argument 2 is"),
    ("def f(a: float) -> float:\n    return np.sin(a)", "has no translation: 'np.sin'"),
    ("def f(a: Matrix) -> None:\n    a = a[:, 0]", "has gaps between its rows"),
    ("def f(a: Vector) -> None:\n    a = a[::2]", "has gaps between its rows"),
    ("def f(n: int) -> int:\n    for i in range(n):\n        pass\n    return i", "name 'i' is"),
    ("def f(n: int) -> None:\n    for i in range(n):\n        i = 0", "writes another variable"),
    ("def f(n: int) -> None:\n    for n in range(3):\n        pass", "writes another variable"),
    ("def f(n: int) -> None:\n    for i in range(n, 0, -1):\n        pass", "has a step"),
    ("def f(a: float) -> None:\n    for x in (a, a):\n        pass", "has no translation"),
    ("def f(a: float) -> None:\n    with a:\n        pass", "`with a:` has no translation"),
    ("def f(a: Vector) -> float:\n    return a[-1]", "counts from the end"),
    ("def f(a: float) -> float:\n    if a > 0.0:\n        return a", "may end without a result"),
    ("def f(n: int) -> int:\n    for i in range(n):\n        return i", "may end without a result"),
    (
        "def f(a: float) -> float:\n    if a > 0.0:\n        b = a\n    return b",
        "is not assigned on",
    ),
    (
        "def f(n: int) -> int:\n    while n > 0:\n        n -= 1\n        b = n\n    return b",
        "not as",
    ),
    ("def f(n: int) -> int:\n    b += n\n    return n", "is not assigned on"),
    (
        "def f(a: IntVector) -> bool:\n    return a[0] > 0 and 0 < g(a) < 2\n"
        "@compiled\ndef g(a: IntVector) -> int:\n    return a[1]",
        "is needed twice",
    ),
]
BY_THE_COMPILER = [
    "def f(a: int) -> None:\n    a = 0.5",
    "def f(a: float) -> None:\n    b = 1.0; b = (a, a)",
    "def f(a: Vector) -> None:\n    a = a + a",
    "def f(a: Vector) -> Vector:\n    return 1.0",
    "def f(a: Matrix) -> float:\n    return g(a)\n@compiled\ndef g(a: Vector) -> None:\n    pass",
]


def _write(folder: Path, source: str) -> Path:
    """Write a package of one kernel."""
    (folder / "package").mkdir()
    (folder / "package" / "own.py").write_text(f"{HEAD}\n\n@compiled\n{source}\n")
    return folder / "package"


@pytest.mark.parametrize(("source", "message"), REFUSED)
def test_what_is_no_kernel_is_refused_by_file_and_line(
    tmp_path: Path, source: str, message: str
) -> None:
    with pytest.raises(TranslationError, match=re.escape(message)) as caught:
        Translator(_write(tmp_path, source)).all()
    assert re.fullmatch(r"package/own\.py:\d+: `[^`]+` (?!.*own\.py).*", str(caught.value))


def test_tables_go_by_the_full_names_of_their_modules(tmp_path: Path) -> None:
    package = tmp_path / "package"
    for name, number in (("one", 1.0), ("two", 2.0)):
        (package / name).mkdir(parents=True)
        source = f"TOWARDS = ({number}, 3.0)\n\n@compiled\ndef f(i: int) -> float:\n    "
        (package / name / "own.py").write_text(f"{HEAD}\n{source}return TOWARDS[i]\n")
    library = _module(build(package), "_kernels")
    assert (library.one_own_f(0), library.two_own_f(0)) == (1.0, 2.0)


@pytest.mark.parametrize("source", BY_THE_COMPILER)
def test_types_that_do_not_fit_are_refused_by_the_compiler(tmp_path: Path, source: str) -> None:
    line = HEAD.count("\n") + 5
    with pytest.raises(RuntimeError, match=rf"package/own\.py:{line}:\d+: error: "):
        build(_write(tmp_path, source))


CHECKED = """def element(a: Vector, i: int) -> float:
    return a[i]

@compiled
def within_row(a: Matrix, i: int, j: int) -> None:
    a[i, j] = 1.0

@compiled
def part(a: Vector, i: int, j: int) -> float:
    total = np.zeros(1)
    for x in range(a[i:j].size):
        total[0] += a[i + x]
    return total[0]

@compiled
def whole_row(a: Matrix, i: int) -> float:
    return element(a[i], 0)

@compiled
def item(i: int) -> float:
    return (1.0, 2.0, 4.0)[i]

@compiled
def table(i: int) -> float:
    return TABLE[i]

@released
def reshaped(a: Vector, n: int) -> int:
    return fill(a.reshape(n, 2))

@compiled
def fill(a: Matrix) -> int:
    a[:] = 2.0
    return a.shape[0]
"""
INSIDE = [("element", np.arange(3.0), 2), ("within_row", np.ones((2, 3)), 1, 2), ("item", 2)]
INSIDE += [("part", np.arange(5.0), 1, 5), ("part", np.arange(5.0), 5, 5), ("table", 2)]
INSIDE += [("whole_row", np.ones((2, 3)), 1), ("reshaped", np.ones(6), 3)]
OUTSIDE = [("element", np.arange(3.0), 3), ("element", np.arange(3.0), -1), ("item", 3)]
OUTSIDE += [("within_row", np.ones((2, 3)), 0, 3), ("within_row", np.ones((2, 3)), 1, -1)]
OUTSIDE += [("part", np.arange(5.0), 1, 6), ("part", np.arange(5.0), 3, 2), ("item", -1)]
OUTSIDE += [("whole_row", np.ones((2, 3)), 2), ("table", 3), ("part", np.arange(5.0), -1, 2)]


def test_a_checked_build_refuses_an_index_outside_of_its_array(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The address sanitizer sees none of them that stays within the memory of its row."""
    monkeypatch.setenv("IIWA_DNN_CHECKED", "1")
    folder = _write(tmp_path, CHECKED)
    library = _module(build(folder), "_kernels")
    python = _module(folder / "own.py", "nominal")
    for name, *arguments in INSIDE:
        found = getattr(library, f"own_{name}")(*deepcopy(arguments))
        assert found == getattr(python, name)(*deepcopy(arguments))
    for name, *arguments in OUTSIDE:
        before = deepcopy(arguments)
        with pytest.raises(IndexError, match=r"package/own\.py:\d+: index -?\d is none"):
            getattr(library, f"own_{name}")(*arguments)
        assert all(np.array_equal(a, b) for a, b in zip(before, arguments, strict=True))
        assert library.own_element(np.arange(3.0), 1) == 1.0  # and nothing of it stays
    with pytest.raises(ValueError, match="6 elements are reshaped to 8"):
        library.own_reshaped(np.ones(6), 4)


def test_the_library_follows_its_sources(tmp_path: Path) -> None:
    folder = _write(tmp_path, "def f(a: float) -> float:\n    return a + 1.0")
    made = build(folder)
    before = made.stat().st_mtime_ns
    source = folder / "own.py"
    source.write_text(f"# A comment.\n{source.read_text()}")
    assert build(folder).stat().st_mtime_ns == before  # which no comment changes
    source.write_text(source.read_text().replace("a + 1.0", "a + 2.0"))
    build(folder)
    assert _module(made, "_kernels").own_f(1.0) == 3.0


def test_a_file_that_no_kernel_needs_is_not_translated_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A draft is compiled quickly, with the same results; both kinds take turns in one place."""
    source = "def f(a: float) -> float:\n    return a + NUMBER"
    folder = _write(tmp_path, source)
    own = folder / "own.py"
    own.write_text(f"from package.numbers import NUMBER\n{own.read_text()}")
    (folder / "numbers.py").write_text("NUMBER = 1.0\n")
    (folder / "other.py").write_text("WORD = 1\n")
    translations = []
    whole = Translator.all

    def noted(own: Translator) -> None:
        translations.append(own)
        whole(own)

    def library() -> Any:
        """Load a copy: of one path a process loads one library."""
        copy = tmp_path / f"{len(list(tmp_path.iterdir()))}.so"
        return _module(shutil.copy(build(folder), copy), "_kernels")

    monkeypatch.setattr(Translator, "all", noted)
    assert library().own_f(1.0) == 2.0
    (folder / "other.py").write_text("WORD = 2  # in no kernel\n")
    assert library().own_f(1.0) == 2.0
    assert len(translations) == 1
    (folder / "numbers.py").write_text("NUMBER = 2.0\n")
    assert library().own_f(1.0) == 3.0
    kernel = "@compiled\ndef g(a: float) -> float:\n    return -a\n"
    (folder / "other.py").write_text(f"{HEAD}\n\n{kernel}")
    assert library().other_g(1.0) == -1.0
    monkeypatch.setenv("IIWA_DNN_DRAFT", "1")
    assert library().own_f(1.0) == 3.0
    assert len(translations) == 4
