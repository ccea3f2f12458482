"""The record: shapes, immutability, and a file that comes back bit for bit or not at all."""

from __future__ import annotations

import dataclasses
import io
import json
import time
import zipfile

import numpy as np
import pytest

from helpers_records import heart_record, make_record, make_settings
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import percent
from iiwa_dnn.results.record import COLUMNS, Record, cut
from iiwa_dnn.results.table import save_csv

ARRAYS = [
    field.name
    for field in dataclasses.fields(Record)
    if field.name not in ("settings", "wall_time_s") and field.default is not None
]
OPTIONAL = {
    "ddq", "torque", "bound_multiplier", "bound_kind", "clipped", "action", "fraction", "blocking",
    "row_multiplier", "blocking_rows", "distance", "nearest", "kind", "excess", "judge",
    "level_residual", "frame_position", "frame_rotation", "frame_position_desired",
    "frame_rotation_desired",
}  # fmt: skip
ROWS = [{"part": "CollisionAvoidance", "row": 1 + i} for i in range(3)]


@pytest.fixture
def heart() -> Record:
    gap = np.full((40, 2), 1e-9)
    gap[3, 0], gap[4, 1], gap[5] = np.nan, np.inf, np.nan
    record = heart_record(steps=40, solvers=("proxqp", "osqp"), noise=0.01)
    return dataclasses.replace(record, solution_gap=gap)


@pytest.mark.parametrize("solvers", [(), ("proxqp",), ("proxqp", "osqp")])
@pytest.mark.parametrize("steps", [0, 1, 40])
def test_round_trip(tmp_path, steps, solvers):
    record = make_record(steps=steps, solvers=solvers)
    record.save(tmp_path / "record.npz")
    loaded = Record.load(tmp_path / "record.npz")
    for name in ARRAYS:
        before, after = getattr(record, name), getattr(loaded, name)
        assert before.dtype == after.dtype
        np.testing.assert_array_equal(before, after, strict=True)
    assert loaded.settings == record.settings
    assert loaded.wall_time_s is None
    assert (loaded.steps, loaded.dof, loaded.references) == (steps, 7, len(solvers))


def test_torques_are_in_the_file_where_there_are_any(tmp_path):
    torque = np.arange(70.0).reshape(10, 7)
    record = make_record(torque=torque, settings={"torque_max": [176.0, *[np.inf] * 6]})
    record.save(tmp_path / "record.npz")
    loaded = Record.load(tmp_path / "record.npz")
    np.testing.assert_array_equal(loaded.torque, torque, strict=True)
    assert loaded.settings["torque_max"] == [176.0, *[None] * 6]
    with pytest.raises(ValueError, match="read-only"):
        loaded.torque[0] = 0.0
    make_record().save(tmp_path / "without.npz")
    assert Record.load(tmp_path / "without.npz").torque is None
    with np.load(tmp_path / "without.npz") as stored:
        assert "torque" not in stored.files


@pytest.mark.parametrize(
    ("torque", "settings", "words"),
    [
        (np.zeros((11, 7)), {"torque_max": [1.0] * 7}, r"torque: shape \(11, 7\)"),
        (np.zeros((10, 7)), {}, "'torque_max' is missing"),
        (np.zeros((10, 7)), {"torque_max": [1.0] * 6}, "7 limits"),
    ],
)
def test_wrong_torques(torque, settings, words):
    with pytest.raises(InvalidInputError, match=words):
        make_record(torque=torque, settings=settings)


def test_what_happened_is_in_the_file_where_anything_did(tmp_path):
    optional = {field.name for field in dataclasses.fields(Record) if field.default is None}
    assert optional == OPTIONAL | {"wall_time_s"}
    happened = {
        "bound_multiplier": np.linspace(-1.0, 1.0, 70).reshape(10, 7),
        "bound_kind": 3 * np.eye(10, 7, dtype=np.int8),
        "ddq": np.linspace(-3.0, 3.0, 70).reshape(10, 7),
        "clipped": np.eye(10, 7, dtype=np.int8),
        "action": np.arange(10, dtype=np.int8) % 5,
        "fraction": np.linspace(0.0, 1.0, 10),
        "blocking": -2 * np.eye(10, 7, dtype=np.int8),
        "row_multiplier": np.linspace(0.0, 1.0, 30).reshape(10, 3),
        "blocking_rows": np.eye(10, 3, dtype=np.int8),
        "level_residual": np.linspace(0.0, 1.0, 20).reshape(10, 2),
        "frame_position": np.linspace(0.0, 1.0, 66).reshape(11, 2, 3),
    }
    make_record(**happened, settings={"rows": ROWS}).save(tmp_path / "record.npz")
    loaded = Record.load(tmp_path / "record.npz")
    assert loaded.settings["rows"] == ROWS
    for name, array in happened.items():
        np.testing.assert_array_equal(getattr(loaded, name), array, strict=True)
    make_record().save(tmp_path / "without.npz")
    with np.load(tmp_path / "without.npz") as stored:
        assert not OPTIONAL & set(stored.files)
    for name, array in happened.items():
        with pytest.raises(InvalidInputError, match=rf"^{name}: shape"):
            make_record(**{name: array[:-1]}, settings={"rows": ROWS})


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (None, r"settings\['rows'\]: must name 3"),
        (ROWS[:2], r"settings\['rows'\]: must name 3"),
        ([*ROWS[:2], {"part": "x", "row": 0}], r"settings\['rows'\]: must name 3"),
        ([*ROWS[:2], {"row": 1}], "settings: 'part' is missing"),
        ([*ROWS[:2], "row 3"], "settings: "),
        (3, "settings"),
    ],
)
def test_wrong_names_of_rows(rows, words):
    for name, array in (
        ("row_multiplier", np.zeros((10, 3))),
        ("blocking_rows", np.zeros((10, 3), int)),
    ):
        with pytest.raises(InvalidInputError, match=words):
            make_record(**{name: array}, settings={"rows": rows})


def test_multipliers_of_rows_without_names_are_refused_and_names_alone_are_not():
    with pytest.raises(InvalidInputError, match=r"settings\['rows'\]: must name 3"):
        make_record(row_multiplier=np.zeros((10, 3)))
    assert make_record(settings={"rows": ROWS}).row_multiplier is None
    with pytest.raises(InvalidInputError, match=r"blocking_rows: shape \(10, 2\), .* \(N, m\)"):
        make_record(
            row_multiplier=np.zeros((10, 3)),
            blocking_rows=np.zeros((10, 2), int),
            settings={"rows": ROWS},
        )


def test_a_record_prints_one_line():
    position = np.zeros((11, 3))
    position[4] = [3e-3, -4e-3, 12e-3]
    record = make_record(position=position, settings={"status": "stopped\nat step 3"})
    assert (
        repr(record)
        == str(record)
        == ("Record(iiwa7, 10 steps of 0.1 s, stopped at step 3, position error max 0.013 m)")
    )
    assert "\n" not in repr(make_record(steps=0))
    stuck = make_record(action=np.full(10, 2), fraction=np.full(10, 1e-5))
    assert "completed, path completed 0.0 %, position error" in repr(stuck)
    assert stuck.path_time == pytest.approx(1e-5)


def test_a_csv_file_holds_every_digit(heart, tmp_path):
    save_csv(heart, tmp_path / "heart.csv")
    head = (tmp_path / "heart.csv").read_text().splitlines()[0].split(",")
    assert head[:2] + head[8:9] + head[15:21] == [
        "t", "q1", "dq1", "x", "y", "z", "x_desired", "y_desired", "z_desired",
    ]  # fmt: skip
    assert len(set(head)) == len(head)
    table = np.genfromtxt(tmp_path / "heart.csv", delimiter=",", names=True)
    for name, values in {
        "t": heart.t, "q7": heart.q[:, 6], "y": heart.position[:, 1],
        "z_desired": heart.position_desired[:, 2], "rotation6": heart.rotation[:, 1, 2],
    }.items():  # fmt: skip
        np.testing.assert_array_equal(table[name], values)
    np.testing.assert_array_equal(table["dq3"], [*heart.dq[:, 2], np.nan])
    np.testing.assert_array_equal(table["kkt_residual"], [*heart.kkt_residual, np.nan])
    np.testing.assert_array_equal(table["solution_gap1"], [*heart.solution_gap[:, 0], np.nan])
    # Nothing of the record is left out.
    arrays = [getattr(heart, name) for name in COLUMNS]
    assert len(head) == sum(array[:1].size for array in arrays if array is not None)


def test_a_csv_file_of_a_run_without_steps_has_its_start(tmp_path):
    save_csv(make_record(steps=0), tmp_path / "none.csv")
    assert len((tmp_path / "none.csv").read_text().splitlines()) == 2


def test_a_share_below_one_is_never_shown_as_all_of_it():
    assert [percent(share) for share in (0.0, 0.1234, 0.99999, 1.0)] == [
        "0.0 %", "12.3 %", "99.9 %", "100.0 %",
    ]  # fmt: skip


def test_the_gap_is_the_largest_over_the_solvers(heart):
    # NaN of one solver does not hide the other's answer; inf (no answer) shows.
    np.testing.assert_array_equal(heart.crosscheck_gap[2:6], [1e-9, 1e-9, np.inf, np.nan])
    assert np.isnan(make_record(solvers=()).crosscheck_gap).all()


def test_the_file_is_what_the_design_says(heart, tmp_path):
    heart.save(tmp_path / "record.npz")
    with np.load(tmp_path / "record.npz", allow_pickle=False) as stored:
        assert set(stored.files) == {*ARRAYS, "settings"}
        assert json.loads(str(stored["settings"])) == heart.settings
        np.testing.assert_array_equal(stored["crosscheck_gap"], heart.crosscheck_gap)


def test_the_same_record_gives_the_same_bytes(heart, tmp_path, monkeypatch):
    heart.save(tmp_path / "a.npz")
    monkeypatch.setattr(time, "time", lambda: 2e9)
    shuffled = dict(reversed(heart.settings.items()))
    dataclasses.replace(heart, settings=shuffled, wall_time_s=1e3).save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.npz") as archive:
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {info.compress_type for info in archive.infolist()} == {zipfile.ZIP_STORED}


def test_a_record_does_not_change_with_what_it_was_made_of():
    q, settings = np.zeros((11, 7)), {"dt": 0.1, "scheme": {"weight": 0.2}}
    record = make_record(q=q, settings=settings)
    q[:] = 1.0
    settings["scheme"]["weight"] = 1.0
    assert not record.q.any()
    assert record.settings["scheme"] == {"weight": 0.2}
    with pytest.raises(ValueError, match="read-only"):
        record.q[0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        record.q = q


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("dq", np.zeros((9, 7)), r"shape \(9, 7\), expected \(N, n\) = \(10, 7\)"),
        ("q", np.zeros((11, 6)), r"dq: shape \(10, 7\), expected \(N, n\) = \(10, 6\)"),
        ("rotation", np.zeros((11, 9)), "2 dimensions, expected 3"),
        ("rotation_desired", np.zeros((11, 3, 2)), r"\(N\+1, 3, 3\)"),
        ("kkt_residual", np.zeros(11), "kkt_residual"),
        ("t", np.zeros(11), "increasing"),
        ("t", np.full(11, np.nan), "increasing"),
        ("t", np.zeros(0), "t"),
        ("position", np.full((11, 3), "x"), "numbers"),
        ("iterations", np.full(10, 0.5), "iterations"),
        ("solution_gap", np.zeros((10, 2)), "objective_gap"),
    ],
)
def test_wrong_arrays(name, value, words):
    with pytest.raises(InvalidInputError, match=words):
        make_record(**{name: value})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"q_lower": [0.0] * 6}, "7 limits"),
        ({"mode": "fast"}, "mode"),
        ({"dt": 0.0}, "dt"),
        ({"duration": 1e300, "dt": 1e-300}, "duration"),
        ({"robot": 3}, "robot"),
        ({"q_lower": ["a"] * 7}, "settings"),
        ({"q_lower": [10**400] * 7}, "settings"),
        ({"dt": 10**400}, "settings"),
        ({"tol": float("nan")}, "settings"),
        ({"seed": {1}}, "JSON"),
        ({"check": {"solvers": [], "tolerance": 1e-6, "reference_tolerance": 1e-8}}, "1 solver"),
        ({"check": {"solvers": ["proxqp"]}}, "'tolerance' is missing"),
    ],
)
def test_wrong_settings(change, words):
    with pytest.raises(InvalidInputError, match=words):
        make_record(settings=change)


def test_missing_settings():
    settings = make_settings()
    del settings["status"]
    with pytest.raises(InvalidInputError, match="'status' is missing"):
        dataclasses.replace(make_record(), settings=settings)


def test_an_infinite_limit_is_none_and_survives(tmp_path):
    record = make_record(settings={"q_upper": [np.inf] * 7, "dq_max": np.full(7, 1.5)})
    assert record.settings["q_upper"] == [None] * 7
    record.save(tmp_path / "x")
    assert Record.load(tmp_path / "x").settings == record.settings


def rewritten(path, **changes):
    """Write the record at `path` again with arrays changed, or left out where None."""
    with np.load(path) as stored:
        arrays = dict(stored) | changes
    np.savez(path.with_suffix(""), **{k: v for k, v in arrays.items() if v is not None})


@pytest.mark.parametrize(
    "change",
    [
        {"dq": None},
        {"settings": None},
        {"crosscheck_gap": None},
        {"dq": np.zeros((3, 7))},
        {"settings": np.array("not json")},
        {"settings": np.array("[1]")},
        {"settings": np.array("{}")},
        {"crosscheck_gap": np.full(40, 1e-12)},
        {"q": np.full((41, 7), "x")},
    ],
)
def test_a_file_that_is_not_a_record(heart, tmp_path, change):
    path = tmp_path / "record.npz"
    heart.save(path)
    rewritten(path, **change)
    with pytest.raises(FileError) as caught:
        Record.load(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)


def test_every_truncation_and_any_flipped_byte_is_noticed(heart, tmp_path):
    path = tmp_path / "record.npz"
    heart.save(path)
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    for length in (0, 1, 10, *rng.integers(0, len(whole), 60)):
        path.write_bytes(whole[:length])
        with pytest.raises(FileError):
            Record.load(path)
    for place in rng.integers(0, len(whole), 200):
        damaged = bytearray(whole)
        damaged[place] ^= 0xFF
        path.write_bytes(damaged)
        try:
            loaded = Record.load(path)
        except FileError as error:
            assert "\n" not in str(error)  # noqa: PT017 - not every byte of a zip file matters
        else:
            for name in ARRAYS:
                np.testing.assert_array_equal(getattr(loaded, name), getattr(heart, name))


def test_pickles_and_other_files_are_refused(heart, tmp_path):
    path = tmp_path / "record.npz"
    heart.save(path)
    rewritten(path, q=np.array([object()], dtype=object))
    with pytest.raises(FileError, match=r"pickle|allow"):
        Record.load(path)
    np.save(tmp_path / "one.npy", np.zeros(3))
    with pytest.raises(FileError, match="archive"):
        Record.load(tmp_path / "one.npy")
    (tmp_path / "text").write_text("hello")
    with pytest.raises(FileError):
        Record.load(tmp_path / "text")
    with pytest.raises(FileError, match="No such file"):
        Record.load(tmp_path / "missing")
    with pytest.raises(FileError):
        Record.load(tmp_path)


def test_a_save_that_fails_leaves_the_old_record(heart, tmp_path, monkeypatch):
    path = tmp_path / "record.npz"
    heart.save(path)
    old = path.read_bytes()

    def full(file: io.BufferedWriter, **arrays: np.ndarray) -> None:
        file.write(b"PK")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(FileError, match="No space left"):
        make_record().save(path)
    assert path.read_bytes() == old
    assert list(tmp_path.iterdir()) == [path]


def test_save_into_no_folder(tmp_path):
    with pytest.raises(FileError, match="cannot be written"):
        make_record().save(tmp_path / "missing" / "record.npz")
    assert not list(tmp_path.iterdir())


def test_a_protected_array_is_taken_as_it_is_and_an_open_one_is_copied() -> None:
    record = make_record()
    again = dataclasses.replace(record)
    assert again.q is record.q
    whole = np.array(record.q)
    view = whole[:]
    view.setflags(write=False)  # but `whole` can still be written into
    copied = dataclasses.replace(record, q=view)
    whole[:] = 0.0
    np.testing.assert_array_equal(copied.q, record.q)


def test_columns_of_a_run_are_allocated_cut_and_taken_without_a_copy(tmp_path) -> None:
    sizes = {"n": 7, "k": 1, "m": 3, "l": 2, "f": 1}
    arrays = {name: column.allocate(20, **sizes) for name, column in COLUMNS.items()}
    assert (arrays["fraction"] == 1.0).all()
    arrays["t"][:] = 0.1 * np.arange(21)
    taken = cut(arrays, 10)
    rows = {"rows": ROWS, "torque_max": [1.0] * 7}
    near = {"collisions": {"pairs": [["a", "b"]], "distance": 0.1}}
    record = Record(**taken, settings=make_settings() | rows | near)
    assert record.steps == 10
    assert all(getattr(record, name) is array for name, array in taken.items())
    record.save(tmp_path / "record.npz")
    with np.load(tmp_path / "record.npz") as stored:
        assert set(stored.files) == {*COLUMNS, "crosscheck_gap", "settings"}


def test_every_column_is_documented() -> None:
    documentation = Record.__doc__ or ""
    assert all(f"{name}: {column.meaning}" in documentation for name, column in COLUMNS.items())
