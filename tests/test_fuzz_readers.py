"""Damaged files for every reader: only the package's own errors may come back."""

from __future__ import annotations

import io
import tempfile
import traceback
import zipfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from helpers_records import make_record
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.references import Waypoints
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import summary
from iiwa_dnn.robot import load_robot

ROOT = Path(__file__).parents[1]

CSV = b"t,x,y,z\n0,0,0,0\n0.5,0.1,-0.05,0\n1,0.2,0,1e-3\n2.5,0.1,0.1,0\n"
SMALL_URDF = b"""<?xml version="1.0"?>
<robot name="small"><link name="a"/><link name="b"/><link name="c"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/>
<origin xyz="0 0 1" rpy="0 0 0"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="2"/></joint>
<joint name="two" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.3" effort="1" velocity="1"/></joint></robot>
"""

# What breaks readers: no numbers, huge ones, other encodings, markup, a bomb.
TOKENS = [
    b"nan", b"-inf", b"1e999", b"-1e308", b"5e-324", b"0", b"-1", b"9" * 400, b"0x1p3", b"1_0",
    b"", b" ", b"\0", b"\xff", b"\xfe\xff", b"\xef\xbb\xbf", b"\r", b"\n" * 3, b",", b";", b'"',
    b"<", b">", b"&", b"]]>", b"<!--", b"<robot>", b"</robot>", b"<link/>", b"<joint/>",
    b'<mimic joint="one"/>', b"continuous", b"floating", b"planar", b"fixed", b"t,x,y,z\n",
    b'<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]>', b"&b;", b"&#0;",
    b'<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]>',
    b"<?xml version='1.0' encoding='x'?>", b"'",
    b'<mesh filename="package://none/missing.stl"/>', b'<mesh filename="/dev/zero"/>',
    b"null", b"true", b"{}", b"[]", b"[[[[", b'{"a": 1}', b"1e400", b'"\\ud800"', b"-0.0",
]  # fmt: skip

Rng = np.random.Generator
CASES = 1200


def mutated(content: bytes, rng: Rng) -> bytes:
    """A few random changes: bytes flipped, cut out, doubled, replaced by a token, the end lost."""
    data = bytearray(content)
    for _ in range(1 + int(rng.geometric(0.4))):
        start = int(rng.integers(len(data) + 1))
        stop = min(len(data), start + int(rng.geometric(0.1)))
        kind = int(rng.integers(6))
        if kind == 0 and start < len(data):
            data[start] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            del data[start:stop]
        elif kind == 2:
            data[start:start] = data[start:stop] * int(rng.integers(1, 50))
        elif kind == 3:
            data[start:stop] = TOKENS[int(rng.integers(len(TOKENS)))]
        elif kind == 4:
            data[start:start] = TOKENS[int(rng.integers(len(TOKENS)))]
        elif rng.random() < 0.3:
            del data[start:]
    return bytes(data)


def number_replaced(content: bytes, rng: Rng) -> bytes:
    """One quoted value or field replaced by a token: the rest stays well formed."""
    marks = [i for i, byte in enumerate(content) if byte in b'",\n ']
    i = int(rng.integers(len(marks) - 1))
    token = TOKENS[int(rng.integers(len(TOKENS)))]
    return content[: marks[i] + 1] + token + content[marks[i + 1] :]


def text_case(seeds: list[bytes], rng: Rng) -> bytes:
    content = seeds[int(rng.integers(len(seeds)))]
    return (mutated if rng.random() < 0.5 else number_replaced)(content, rng)


def repacked(content: bytes, rng: Rng) -> bytes:
    """An archive whose check sums are right and whose members are not."""
    target = io.BytesIO()
    packing = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)[int(rng.integers(2))]
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(target, "w", packing) as new:
        names = old.namelist()
        victim = names[int(rng.integers(len(names)))]
        for name in names:
            data = old.read(name)
            if name == victim:
                kind = int(rng.integers(4))
                if kind == 0:
                    continue
                if kind == 1:
                    data = mutated(data[:128], rng) + data[128:]  # the head: type, order, shape
                else:
                    data = npy(other_array(np.load(io.BytesIO(data)), rng))
            new.writestr(name, data)
    return target.getvalue()


def npy(array: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.save(file, array, allow_pickle=True)
    return file.getvalue()


def other_array(array: np.ndarray, rng: Rng) -> np.ndarray:
    """The same array with other values, type or shape; settings with other contents."""
    if array.dtype.kind == "U":  # whole or lost: nobody edits the settings of a record
        return np.array(str(array)[: int(rng.integers(len(str(array))))])
    kind = int(rng.integers(6))
    if kind == 0 and array.size:
        array = array.astype(np.float64)
        bad = (np.nan, np.inf, -np.inf, 1e308, -1.0)
        array.flat[int(rng.integers(array.size))] = bad[int(rng.integers(5))]
        return array
    if kind == 1:
        return array[..., :-1] if array.ndim and array.shape[-1] else array
    if kind == 2:
        return array.astype(("U5", "c16", "f2", "i1", "?", "S3")[int(rng.integers(6))])
    if kind == 3:
        return np.array([{"pickled": True}], dtype=object)
    if kind == 4:
        return array[np.newaxis]
    return np.concatenate([array, array]) if array.ndim else array


def read_record(path: Path) -> None:
    """A record that is taken for one has metrics and a verdict, too."""
    record = Record.load(path)
    metrics = compute_metrics(record)
    text = summary(metrics) + repr(record)
    assert "\n" not in repr(record), text


def _seeds() -> dict[str, tuple[Callable[[Path], object], Callable[[Rng], bytes], str]]:
    """Reader, source of damaged files and their ending, by name."""
    urdfs = [SMALL_URDF, (ROOT / "robots/iiwa7/iiwa7.urdf").read_bytes()]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "record.npz"
        happened = {
            "action": [2, 0, 3],
            "fraction": [0.5, 1.0, 1.0],
            "row_multiplier": np.eye(3, 2),
            "blocking_rows": np.eye(3, 2, dtype=np.int8),
        }
        rows = [{"part": "Obstacle", "row": 1}, {"part": "Obstacle", "row": 2}]
        make_record(steps=3, **happened, settings={"rows": rows}).save(path)
        record = path.read_bytes()
    return {
        "urdf": (load_robot, lambda rng: text_case(urdfs, rng), ".urdf"),
        "csv": (Waypoints.from_csv, lambda rng: text_case([CSV], rng), ".csv"),
        "npz": (read_record, lambda rng: mutated(record, rng), ".npz"),
        "npz, settings": (read_record, lambda rng: repacked(record, rng), ".npz"),
    }


SOURCES = _seeds()


def case(number: int, folder: Path) -> tuple[str, str]:
    """Read the damaged file of this number.

    Returns:
        The reader's name, and "read", "refused" or the trace of what should not have come.
    """
    name = list(SOURCES)[number % len(SOURCES)]
    reader, source, ending = SOURCES[name]
    path = folder / f"case{ending}"  # there to look at, should the process itself crash
    path.write_bytes(source(np.random.default_rng([number, 7])))
    try:
        reader(path)
    except IiwaDnnError as error:
        return name, "refused" if str(error) else "an error without a word"
    except Exception:
        return name, traceback.format_exc()
    return name, "read"


# What a reader warns of, a number too large for example, is no error of its own.
@pytest.mark.filterwarnings("default")
def test_damaged_files_are_read_or_refused_and_nothing_else(tmp_path: Path) -> None:
    counts = Counter(case(number, tmp_path) for number in range(CASES))
    broken = [(name, outcome) for name, outcome in counts if outcome not in ("read", "refused")]
    assert not broken, "\n".join(f"{name}: {outcome}" for name, outcome in broken)
    # The damage is neither so small nor so large that one of the two never happens.
    for name in SOURCES:
        assert counts[name, "refused"] > CASES / 40
        if name != "npz":  # its check sums notice nearly everything
            assert counts[name, "read"] > CASES / 200
