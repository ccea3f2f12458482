"""The record: shapes, immutability, and a file that comes back bit for bit or not at all."""

import dataclasses
import io
import json

import numpy as np
import pytest

from helpers_records import heart_record, make_record
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.record import COLUMNS, OPTIONAL, Record

ROWS = [{"part": "CollisionAvoidance", "row": 1 + i} for i in range(3)]
NEAR = {"pairs": [["a", "b"], ["a", "c"]], "distance": 0.02}


@pytest.fixture
def heart() -> Record:
    gap = np.full((40, 2), 1e-9)
    gap[3, 0], gap[4, 1], gap[5] = np.nan, np.inf, np.nan
    record = heart_record(steps=40, solvers=("proxqp", "osqp"), noise=0.01)
    return dataclasses.replace(record, solution_gap=gap)


def full_record() -> Record:
    """A run that has every column, each entry another number."""
    sizes = {"n": 7, "k": 1, "m": 3, "f": 2}
    arrays = {}
    for name in OPTIONAL - {"nearest"}:
        array = COLUMNS[name].allocate(10, **sizes)
        arrays[name] = np.arange(array.size).reshape(array.shape).astype(array.dtype) % 3
    settings = {"rows": ROWS, "torque_max": [176.0, *[np.inf] * 6], "collisions": NEAR}
    settings["frames"] = ["elbow", "wrist"]
    return make_record(**arrays, nearest=np.arange(11) % 2, settings=settings)


@pytest.mark.parametrize("steps", [0, 1, 40])
@pytest.mark.parametrize("solvers", [(), ("proxqp",), ("proxqp", "osqp")])
def test_round_trip(tmp_path, steps, solvers):
    records = [make_record(steps=steps, solvers=solvers)]
    if steps == 40:
        records += [full_record(), heart_record(steps=40, solvers=solvers)]
    for record in records:
        record.save(tmp_path / "record.npz")
        loaded = Record.load(tmp_path / "record.npz")
        for name in (*COLUMNS, "crosscheck_gap"):
            np.testing.assert_array_equal(
                getattr(loaded, name), getattr(record, name), strict=True, err_msg=name
            )
        assert loaded.settings == record.settings
        assert loaded.wall_time_s is None
        assert (loaded.steps, loaded.dof) == (record.steps, 7)


def test_columns_that_a_run_lacks_have_the_length_zero(tmp_path):
    record = make_record(settings={"rows": ROWS})
    for name in OPTIONAL:
        array = getattr(record, name)
        assert len(array) == 0
        assert array.ndim == len(COLUMNS[name].shape)
    assert record.filled("clipped").shape == (10, 7)
    assert record.filled("row_multiplier").shape == (10, 3)
    assert (record.filled("fraction") == 1.0).all()
    assert full_record().settings["torque_max"] == [176.0, *[None] * 6]


def test_copies_are_not_stored(heart, tmp_path):
    heart.save(tmp_path / "a.npz")
    turning = np.array(heart.rotation_desired)
    turning[7] = np.diag([-1.0, -1.0, 1.0])
    other = dataclasses.replace(heart, rotation_desired=turning, dq_solver=heart.dq + 1e-3)
    other.save(tmp_path / "b.npz")
    lengths = []
    for name in ("a", "b"):
        with np.load(tmp_path / f"{name}.npz", allow_pickle=False) as stored:
            assert set(stored.files) == {*COLUMNS, "crosscheck_gap", "settings"}
            assert json.loads(str(stored["settings"])) == heart.settings
            lengths.append((len(stored["dq_solver"]), len(stored["rotation_desired"])))
    assert lengths == [(0, 1), (40, 41)]
    np.testing.assert_array_equal(Record.load(tmp_path / "b.npz").rotation_desired, turning)


def test_a_record_does_not_change_with_what_it_was_made_of():
    q, settings = np.zeros((11, 7)), {"dt": 0.1, "scheme": {"weight": 0.2}}
    record = make_record(q=q, settings=settings)
    q[:] = 1.0
    settings["scheme"]["weight"] = 1.0
    assert not record.q.any()
    assert record.settings["scheme"] == {"weight": 0.2}
    with pytest.raises(ValueError, match="read-only"):
        record.q[0] = 1.0


def test_a_record_prints_one_line():
    position = np.zeros((11, 3))
    position[4] = [3e-3, -4e-3, 12e-3]
    record = make_record(position=position, settings={"status": "stopped at step 3"})
    assert repr(record) == (
        "Record(iiwa7, 10 steps of 0.1 s, stopped at step 3, 100.0 % of the path asked for, "
        "position error max 0.013 m)"
    )
    stuck = make_record(action=np.full(10, 2), fraction=np.full(10, 1e-5))
    assert "completed, 0.0 % of the path asked for, position error" in repr(stuck)
    assert stuck.path_time == pytest.approx(1e-5)


def test_the_gap_is_the_largest_over_the_solvers(heart):
    # NaN of one solver does not hide the other's answer; inf (no answer) shows.
    np.testing.assert_array_equal(heart.crosscheck_gap[2:6], [1e-9, 1e-9, np.inf, np.nan])
    assert np.isnan(make_record(solvers=()).crosscheck_gap).all()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"dq": np.zeros((9, 7))}, r"shape \(9, 7\), expected numbers \(N, n\) = \(10, 7\)"),
        ({"q": np.zeros((11, 6))}, r"dq: .* \(10, 7\), expected numbers \(N, n\) = \(10, 6\)"),
        ({"rotation_desired": np.zeros((11, 3, 2))}, r"\(N\+1, 3, 3\)"),
        ({"kkt_residual": []}, "kkt_residual: .* shape"),
        ({"t": np.zeros(11)}, "increasing"),
        ({"t": np.full(11, np.nan)}, "increasing"),
        ({"position": np.full((11, 3), "x")}, "numbers"),
        ({"iterations": np.full(10, 0.5)}, "iterations"),
        ({"solution_gap": np.zeros((10, 2))}, "objective_gap"),
    ],
)  # fmt: skip
def test_refusals(changes, words):
    with pytest.raises(InvalidInputError, match=words):
        make_record(**changes)


def test_a_file_that_is_not_a_record_is_told_in_one_line(heart, tmp_path):
    heart.save(tmp_path / "old.npz")
    with np.load(tmp_path / "old.npz") as stored:
        arrays = dict(stored)
    np.savez(tmp_path / "bare.npz", **(arrays | {"settings": np.array("{}")}))
    del arrays["kind"]
    np.savez(tmp_path / "old.npz", **arrays)
    np.save(tmp_path / "one.npy", np.zeros(3))
    for name, words in {
        "old.npz": "kind is not a file in the archive",
        "bare.npz": "as a record",
        "one.npy": "not a zip file",
        "missing": "No such",
        "": "read",
    }.items():
        with pytest.raises(FileError, match=words) as caught:
            Record.load(tmp_path / name)
        assert "\n" not in str(caught.value)
        assert str(tmp_path / name) in str(caught.value)


def test_a_record_of_the_last_version_is_read(heart, tmp_path):
    heart.save(tmp_path / "last.npz")
    with np.load(tmp_path / "last.npz") as stored:
        arrays = dict(stored)
    del arrays["row_pair"]
    arrays["limiting_rows"] = arrays["limiting_rows"].astype(np.int8)
    np.savez(tmp_path / "last.npz", **arrays)
    loaded = Record.load(tmp_path / "last.npz")
    assert not len(loaded.row_pair)
    assert compute_metrics(loaded)["incidents"] == compute_metrics(heart)["incidents"]
    np.testing.assert_array_equal(loaded.dq, heart.dq)


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
