"""Damaged files for every reader: only the package's own errors may come back."""

import traceback
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.references import Waypoints
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
CASES = 320


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


READERS = {"urdf": (load_robot, URDF), "csv": (Waypoints.from_csv, CSV)}


# What a reader warns of, a number too large for example, is no error of its own.
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("kind", READERS)
def test_damaged_files_are_read_or_refused_and_nothing_else(kind: str, tmp_path: Path) -> None:
    read, whole = READERS[kind]
    outcomes: Counter[str] = Counter()
    for number in range(CASES):
        path = tmp_path / f"case.{kind}"  # there to look at, should the process itself crash
        path.write_bytes(text_case(whole, np.random.default_rng([number, 7])))
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
