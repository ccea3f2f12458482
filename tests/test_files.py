"""Files are the old one or the whole new one."""

import os

import numpy as np
import pytest

from iiwa_dnn.errors import FileError
from iiwa_dnn.files import plain, write_atomically, write_json


@pytest.mark.parametrize("error", [KeyboardInterrupt(), OSError(28, "full")])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, error):
    path = tmp_path / "file"
    path.write_bytes(b"old")

    def write(file):
        file.write(b"half of the ne")
        raise error

    with pytest.raises(FileError if isinstance(error, OSError) else type(error)):
        write_atomically(path, write)
    assert path.read_bytes() == b"old"
    assert [found.name for found in tmp_path.iterdir()] == ["file"]


def test_the_new_name_appears_only_with_the_whole_content(tmp_path, monkeypatch):
    path = tmp_path / "file"
    synced = []

    def fsync(descriptor):
        synced.append(os.fstat(descriptor).st_size)
        assert not path.exists()

    monkeypatch.setattr(os, "fsync", fsync)
    write_atomically(path, lambda file: file.write(b"all of it"))
    assert synced == [9]
    assert path.read_bytes() == b"all of it"
    assert list(tmp_path.iterdir()) == [path]


def test_an_unwritable_place_is_a_file_error_in_one_line(tmp_path):
    (tmp_path / "file").touch()
    for place in (tmp_path / "missing" / "x", tmp_path / "file" / "x", tmp_path):
        with pytest.raises(FileError) as caught:
            write_atomically(place, lambda file: file.write(b"x"))
        assert caught.value.path == str(place)
        assert "\n" not in str(caught.value)
    assert [found.name for found in tmp_path.iterdir()] == ["file"]
    assert not list(tmp_path.parent.glob(".*.tmp"))


def test_json_holds_plain_types_and_nothing_that_json_has_not(tmp_path):
    value = {"a": np.array([[1.0, np.inf]]), "b": (np.int64(3), np.float64(0.5), np.bool_(True))}
    assert plain(value) == {"a": [[1.0, None]], "b": [3, 0.5, True]}
    assert type(plain(np.float64(0.5))) is float
    assert plain({1: float("nan"), "x": None}) == {"1": None, "x": None}
    with pytest.raises(TypeError, match="set"):
        plain({"a": {1, 2}})
    with pytest.raises(ValueError, match="JSON"):
        write_json(tmp_path / "x.json", float("nan"))
    assert not list(tmp_path.iterdir())
