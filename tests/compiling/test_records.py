"""Records: numbers by their names, the same in Python and in C."""

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from iiwa_dnn.compiling.build import build
from iiwa_dnn.compiling.sources import TranslationError
from iiwa_dnn.compiling.translator import Translator

SOURCE = '''
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.records import Record, part

Vector = np.ndarray
Matrix = np.ndarray


def compiled(function):
    return function


entry = compiled


class Mode(IntEnum):
    """Modes of a motion."""

    SLOW = 3
    FAST = 5


class Motion(Record):
    """State of a motion."""

    time: float
    new: float
    position: Vector = part()
    axis: Vector = part(3)
    velocity: Vector = part()


class Stats(Record):
    """Statistics of a solver."""

    count: float
    size: float


class Plan(NamedTuple):
    """A motion and its period."""

    motion: Motion
    dt: float


@compiled
def advance(motion: Motion, dt: float) -> float:
    motion.time += dt
    motion.new = 2 * motion.time
    for i in range(motion.position.size):
        motion.position[i] += dt * motion.velocity[i]
    motion.axis[:] = motion.new
    return motion.position[0] * motion.axis[2]


@compiled
def within(plan: Plan) -> float:
    motion = plan.motion
    before = motion.time
    return advance(motion, plan.dt) - before + plan.motion.time


@compiled
def largest(motion: Motion) -> float:
    found = -np.inf
    for i in range(motion.numbers.size):
        found = max(found, motion.numbers[i])
    return found


@compiled
def count_up(values: Vector, start: int) -> float:
    stats = Stats.of(values[start : start + 2])
    stats.count += Stats.width() / 2
    return share(stats)


@compiled
def share(stats: Stats) -> float:
    return stats.count / stats.size


@compiled
def mode_of(mode: int) -> int:
    return mode + Mode.SLOW if mode != Mode.FAST else Mode.FAST


@compiled
def any_of(values: Vector) -> float:
    return Stats.of(values).size


class Log(Record):
    """Log of a step."""

    action: int
    is_late: bool
    fraction: float
    command: Vector = part("joints")
    stats: Stats = part(Stats)
    rows: Vector = part("rows")
    targets: Matrix = part("frames", 3)
    limits: Vector = part("joints")


@compiled
def log_of(numbers: Vector, joints: int, rows: int, frames: int) -> Log:
    return Log.of(numbers, joints, rows, frames)


@compiled
def fill(numbers: Vector, joints: int, rows: int, frames: int) -> float:
    log = log_of(numbers, joints, rows, frames)
    log.action = Mode.FAST
    log.is_late = log.action == Mode.FAST and not log.is_late
    log.fraction += log.action // 2
    log.stats.size = 4.0
    count_in(log.stats)
    for i in range(joints):
        log.limits[i] = log.command[i] + i
    log.rows[:] = log.stats.size
    log.targets[frames - 1, 1] = -1.0
    return log.rows[log.action - 5] if log.is_late else 0.0


@compiled
def count_in(stats: Stats) -> None:
    stats.count += 1


class Large(NamedTuple):
    """A plan of many numbers."""

MEMBERS


@compiled
def last_of(large: Large) -> float:
    return large.x44


@entry
def enter(address: int, plan: Plan, stats: Stats) -> float:
    """Enter a kernel with records."""
'''.replace("MEMBERS", "\n".join(f"    x{i}: float" for i in range(45)))


def _module(path: Path, name: str) -> ModuleType:
    spec: Any = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _package(folder: Path) -> Path:
    (folder / "package").mkdir()
    (folder / "package" / "own.py").write_text(SOURCE)
    return folder / "package"


@pytest.fixture(scope="module", params=["0", "1"])
def both(request: Any, tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Any]:
    """The kernels above as Python and as a library, plain and checked."""
    folder = _package(tmp_path_factory.mktemp("records"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IIWA_DNN_CHECKED", request.param)
        return _module(folder / "own.py", "nominal"), _module(build(folder), "_kernels")


def _motion(python: Any, n: int = 2) -> Any:
    return python.Motion.of(np.random.default_rng(n).standard_normal(5 + 2 * n))


def test_members_lie_in_the_array_one_after_another(both: tuple[Any, Any]) -> None:
    python, _ = both
    motion = python.Motion.of(np.arange(9.0))
    assert (motion.time, motion.new, motion.sizes) == (0.0, 1.0, (2,))
    parts = [motion.position.tolist(), motion.axis.tolist(), motion.velocity.tolist()]
    assert parts == [[2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0]]
    motion.velocity[1] = -1.0
    motion.new = -2.0
    assert motion.numbers.tolist() == [0.0, -2.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, -1.0]
    assert python.Motion.zeros(4).velocity.shape == (4,)


def test_a_record_is_made_of_all_its_members_and_no_others(both: tuple[Any, Any]) -> None:
    python, _ = both
    given = {"time": 1, "new": 2, "position": [3, 4], "axis": [5, 6, 7], "velocity": [8, 9]}
    made = python.Motion.make(**given)
    assert made.numbers.tolist() == [1, 2, 3, 4, 5, 6, 7, 8, 9]
    made.position += 1.0
    made.axis = [7.0, 6.0, 5.0]
    assert made.numbers.tolist() == [1, 2, 4, 5, 7, 6, 5, 8, 9]
    for wrong in (given | {"lost": 1.0}, {"time": 1.0}):
        with pytest.raises(TypeError, match="Motion has the members time, new, position, axis"):
            python.Motion.make(**wrong)
    for wrong in (given | {"axis": [1, 2]}, given | {"position": [1, 2, 3]}):
        with pytest.raises(ValueError, match="broadcast"):
            python.Motion.make(**wrong)


@pytest.mark.parametrize("n", [1, 2, 7])
def test_c_reads_and_writes_what_python_does(both: tuple[Any, Any], n: int) -> None:
    python, library = both
    one, other = _motion(python, n), _motion(python, n)
    assert library.own_advance(one, 0.1) == python.advance(other, 0.1)
    assert one.tobytes() == other.tobytes()
    assert other.time == other.new / 2
    assert library.own_within((one, 0.3)) == python.within(python.Plan(other, 0.3))
    assert one.tobytes() == other.tobytes()
    assert library.own_largest(one) == max(other.numbers)


def test_a_kernel_views_a_part_of_an_array_as_a_record(both: tuple[Any, Any]) -> None:
    for kernel in (both[0].count_up, both[1].own_count_up):
        values = np.array([9.0, 1.0, 4.0, 9.0])
        assert kernel(values, 1) == 0.5
        assert values.tolist() == [9.0, 2.0, 4.0, 9.0]


def test_sizes_of_several_names_are_stated(both: tuple[Any, Any]) -> None:
    python, library = both
    sizes = (4, 2, 3)
    width = python.Log.width(*sizes)
    assert width == 3 + 2 + 2 * 4 + 2 + 3 * 3
    arrays = [np.arange(float(width)), np.arange(float(width))]
    for kernel, numbers in zip((python.fill, library.own_fill), arrays, strict=True):
        numbers[1] = 0.0
        assert kernel(numbers, *sizes) == 4.0
    assert arrays[0].tobytes() == arrays[1].tobytes()
    log = python.Log.of(arrays[1], *sizes)
    assert (log.action, log.is_late, log.fraction) == (5, True, 4.0)
    assert (log.stats.count, log.stats.size, log.sizes) == (8.0, 4.0, sizes)
    assert log.command.tolist() == [3.0, 4.0, 5.0, 6.0]
    assert log.limits.tolist() == [3.0, 5.0, 7.0, 9.0]
    assert log.targets.shape == (3, 3)
    assert log.targets[2, 1] == -1.0
    assert log.duplicate().targets.tolist() == log.targets.tolist()
    with pytest.raises(ValueError, match="is no Log"):
        python.Log.of(arrays[0], 4, 2, 2)


def test_rows_are_records_along_their_last_axis(both: tuple[Any, Any]) -> None:
    python, _ = both
    sizes = (1, 2, 1)
    rows = np.arange(2.0 * python.Log.width(*sizes)).reshape(2, -1)
    logs = python.Log.of(rows, *sizes)
    assert logs.action.tolist() == [0, 12]
    assert logs.stats.size.tolist() == [5.0, 17.0]
    assert logs.targets.shape == (2, 1, 3)
    for row, log in zip(rows, logs.targets, strict=True):
        assert python.Log.of(row, *sizes).targets.tolist() == log.tolist()


@pytest.mark.parametrize("size", [0, 4, 6, 8])
def test_an_array_of_another_size_is_no_such_record(both: tuple[Any, Any], size: int) -> None:
    python, library = both
    with pytest.raises(ValueError, match="is no Motion"):
        python.Motion.of(np.zeros(size))
    with pytest.raises(ValueError, match=f"an array of {size} numbers is no own_Motion"):
        library.own_largest(np.zeros(size))
    with pytest.raises(ValueError, match="numbers is no own_Motion"):
        library.own_within((np.zeros(size), 0.5))
    with pytest.raises(ValueError, match="is no own_Stats"):
        library.own_share(np.zeros(size))


def test_a_checked_build_refuses_a_view_of_another_size(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("IIWA_DNN_CHECKED", "1")
    library = _module(build(_package(tmp_path)), "_kernels")
    assert library.own_any_of(np.arange(2.0)) == 1.0
    for size in (0, 1, 3):
        with pytest.raises(ValueError, match=rf"own\.py:\d+: {size} elements are reshaped to 2"):
            library.own_any_of(np.zeros(size))
    with pytest.raises(ValueError, match=r"own\.py:\d+: 23 elements are reshaped to 24"):
        library.own_fill(np.zeros(23), 4, 2, 3)


def test_a_closed_record_is_read_and_never_written(both: tuple[Any, Any]) -> None:
    python, library = both
    closed = _motion(python)
    before = closed.tobytes()
    closed.flags.writeable = False
    assert library.own_largest(closed) == python.largest(closed)
    for call in (lambda: library.own_advance(closed, 0.1), lambda: library.own_within((closed, 1))):
        with pytest.raises(TypeError, match="is read-only"):
            call()
    values = np.ones(4)
    values.flags.writeable = False
    with pytest.raises(TypeError, match="is read-only"):
        library.own_count_up(values, 0)
    assert closed.tobytes() == before


def test_enumerations_stay_enumerations(both: tuple[Any, Any], tmp_path: Path) -> None:
    python, library = both
    for mode in (3, 4, 5):
        assert library.own_mode_of(mode) == python.mode_of(mode)
    translator = Translator(_package(tmp_path))
    translator.all()
    text = translator.text()
    for line in (
        "    own_Mode_FAST = 5,\n} own_Mode;",
        "mode != own_Mode_FAST ? mode + own_Mode_SLOW : own_Mode_FAST;",
        "motion->at->time += dt;",
        "motion->at->new_ = 2.0 * motion->at->time;",
        "    double size;\n} own_Stats_numbers;",
        "    own_Motion motion;\n    double dt;\n} own_Plan;",
    ):
        assert line in text


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("motion.lost = 1.0", "has no translation: 'lost'"),
        ("motion.axis = motion.position", "is no number of a record"),
    ],
)
def test_what_is_no_number_of_a_record_is_not_written(
    tmp_path: Path, body: str, message: str
) -> None:
    folder = _package(tmp_path)
    source = f"{SOURCE}\n\n@compiled\ndef f(motion: Motion) -> None:\n    {body}\n"
    (folder / "own.py").write_text(source)
    with pytest.raises(TranslationError, match=message):
        Translator(folder).all()


def test_a_large_tuple_is_read_anew_where_it_is_another(both: tuple[Any, Any]) -> None:
    _, library = both
    first, second = (tuple(float(i + k) for i in range(45)) for k in (0, 1))
    for large in (first, first, second, first):
        assert library.own_last_of(large) == large[-1]
    for k in range(100):  # a freed one leaves its place to the next
        assert library.own_last_of((0.0,) * 44 + (float(k),)) == k
    with pytest.raises(TypeError, match="must be real number"):
        library.own_last_of((0.0,) * 44 + ("",))
    assert library.own_last_of(first) == 44.0
