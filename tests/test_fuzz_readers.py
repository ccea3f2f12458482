"""Damaged files for every reader: only the package's own errors may come back."""

from __future__ import annotations

import io
import traceback
import zipfile
from collections import Counter
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

CSV = b"t,x,y,z\n0,0,0,0\n0.5,0.1,-0.05,0\n1,0.2,0,1e-3\n2.5,0.1,0.1,0\n"
URDF = b"""<?xml version="1.0"?>
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
    b"<", b"&", b"]]>", b"<!--", b"<robot>", b"</robot>", b"<link/>", b"<joint/>", b"t,x,y,z\n",
    b'<mimic joint="one"/>', b"continuous", b"floating", b"planar", b"fixed", b"&b;", b"&#0;",
    b'<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]>',
    b'<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]>',
    b"<?xml version='1.0' encoding='x'?>", b'<mesh filename="/dev/zero"/>',
    b"null", b"true", b"{}", b"[[[[", b'{"a": 1}', b'"\\ud800"',
]  # fmt: skip

Rng = np.random.Generator
CASES = 900


def token(rng: Rng) -> bytes:
    return TOKENS[int(rng.integers(len(TOKENS)))]


def mutated(content: bytes, rng: Rng) -> bytes:
    """A few random changes: bytes flipped, cut out, doubled, replaced by a token, the end lost."""
    data = bytearray(content)
    for _ in range(1 + int(rng.geometric(0.4))):
        start = int(rng.integers(len(data)))
        stop = start + int(rng.geometric(0.1))
        changes = (
            bytes([data[start] ^ 1 << int(rng.integers(8))]) + data[start + 1 : stop],
            data[start:stop] * int(rng.integers(50)),
            token(rng) + data[start:stop] * int(rng.integers(2)),
            token(rng),
        )
        data[start:stop] = changes[int(rng.integers(4))]
        if rng.random() < 0.05:
            del data[start:]
        data = data or bytearray(b" ")
    return bytes(data)


def text_case(content: bytes, rng: Rng) -> bytes:
    """Random changes, or one quoted value or field replaced: the rest stays well formed."""
    if rng.integers(2) == 0:
        return mutated(content, rng)
    marks = [i for i, byte in enumerate(content) if byte in b'",\n ']
    i = int(rng.integers(len(marks) - 1))
    return content[: marks[i] + 1] + token(rng) + content[marks[i + 1] :]


def repacked(content: bytes, rng: Rng) -> bytes:
    """An archive whose check sums are right and one of whose members is not, or is not there."""
    with np.load(io.BytesIO(content)) as archive:
        arrays = dict(archive)
    victim = str(rng.choice(list(arrays)))
    array = arrays.pop(victim)
    kind = int(rng.integers(4))
    target = io.BytesIO()
    if kind > 1:
        arrays[victim] = other_array(array, rng)
    np.savez(target, **arrays)
    if kind == 1:  # the head: type, order, shape
        file = io.BytesIO()
        np.save(file, array)
        data = file.getvalue()
        with zipfile.ZipFile(target, "a") as new:
            new.writestr(f"{victim}.npy", mutated(data[:128], rng) + data[128:])
    return target.getvalue()


def other_array(array: np.ndarray, rng: Rng) -> np.ndarray:
    """The same array with other values, type or shape; settings that break off."""
    if array.dtype.kind == "U":  # whole or lost: nobody edits the settings of a record
        return np.array(str(array)[: int(rng.integers(len(str(array))))])
    wrong = array.astype(np.float64)
    wrong.flat[: 1 if wrong.size else 0] = rng.choice([np.nan, np.inf, -np.inf, 1e308, -1.0])
    others = (
        wrong,
        array[..., :-1] if array.ndim else array,
        array.astype(rng.choice(["U5", "c16", "f2", "i1", "?", "S3"])),
        np.array([{"pickled": True}], dtype=object),
        array[np.newaxis],
        np.append(array, array),
    )
    return others[int(rng.integers(len(others)))]


def read_record(path: Path) -> None:
    record = Record.load(path)
    assert summary(compute_metrics(record))
    assert "\n" not in repr(record)


READERS = {
    "urdf": (load_robot, text_case),
    "csv": (Waypoints.from_csv, text_case),
    "npz": (read_record, repacked),
}


# What a reader warns of, a number too large for example, is no error of its own.
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("kind", READERS)
def test_damaged_files_are_read_or_refused_and_nothing_else(kind: str, tmp_path: Path) -> None:
    happened = {"action": [2, 0, 3], "fraction": [0.5, 1.0, 1.0], "row_multiplier": np.eye(3, 2)}
    rows = [{"part": "Obstacle", "row": 1}, {"part": "Obstacle", "row": 2}]
    make_record(steps=3, **happened, settings={"rows": rows}).save(tmp_path / "record.npz")
    seed = {"urdf": URDF, "csv": CSV, "npz": (tmp_path / "record.npz").read_bytes()}[kind]
    read, damage = READERS[kind]
    outcomes: Counter[str] = Counter()
    for number in range(CASES // len(READERS)):
        path = tmp_path / f"case.{kind}"  # there to look at, should the process itself crash
        path.write_bytes(damage(seed, np.random.default_rng([number, 7])))
        try:
            read(path)
            outcomes["read"] += 1
        except IiwaDnnError as error:
            outcomes["refused" if str(error) else "an error without a word"] += 1
        except Exception:
            outcomes[traceback.format_exc()] += 1
    # The damage is neither so small nor so large that one of the two never happens.
    assert outcomes.keys() == {"read", "refused"}, outcomes
    assert min(outcomes.values()) > 10
