"""Files of tables: what is loaded, what is refused, parts of a user's own, recorded steps."""

import json
import os
import pickle
import random
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import armstep
import numpy as np
import pytest
from armstep import __main__ as command, _library, tables as own_tables

from export_settings import drawing, with_limits
from helpers_export import run
from hostile_arms import START, hostile_steps, make_shield
from iiwa_dnn import AccelerationLimits, Limit, Robot, Shield, Shields, export
from iiwa_dnn.export import core
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.step import policies, requests


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("tables")
    controller, q0 = drawing(with_limits(AccelerationLimits(1.0)))
    return {
        "shield": export.tables(make_shield(), folder / "shield.json", q0=START),
        "controller": export.tables(controller, folder / "controller.json", q0=q0),
    }


def test_codes_and_sizes_are_those_of_the_library() -> None:
    for here, there in (
        (armstep.Reason, requests.Reason),
        (armstep.Action, policies.Action),
        (armstep.Program, policies.ProgramKind),
    ):
        assert {e.name: e.value for e in here} == {e.name: e.value for e in there}
    assert own_tables.RELEASE == core.RELEASE
    assert _library.LAID_OUT == core.LAID_OUT + 1


def test_hostile_steps_have_the_bits_of_shields(files: dict[str, Path]) -> None:
    here, there = Shields(make_shield(), 2), armstep.Shields(files["shield"], 2)
    q = np.tile(START, (2, 1))
    for own in hostile_steps(q, 300, 4):
        expected, found = here.step(**own), there.step(**own)
        for a, b in zip(expected[:4], found[:4], strict=True):
            assert np.array_equal(a, b)
        q[:] = expected.next_q


@pytest.mark.parametrize("kind", ["shield", "controller"])
def test_recorded_steps_are_repeated_and_can_differ(
    kind: str, files: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main(["check", str(files[kind])]) == 0
    assert "200 steps, 0 differ from iiwa_dnn's" in capsys.readouterr().out
    members = json.loads(files[kind].read_text(encoding="utf-8"))
    members["vectors"]["steps"][60]["dq"][-2] += 1e-6
    other = tmp_path / "other.json"
    other.write_text(json.dumps(members), encoding="utf-8")
    assert command.main(["check", str(other)]) == 1
    assert "200 steps, 1 differ" in capsys.readouterr().out
    del members["vectors"]
    other.write_text(json.dumps(members), encoding="utf-8")
    assert command.main(["check", str(other)]) == 2
    assert capsys.readouterr().err == f"{other}: holds no recorded steps: KeyError('vectors')\n"
    assert command.main([]) == 2


def test_the_command_runs_without_iiwa_dnn(files: dict[str, Path]) -> None:
    folder = Path(armstep.__file__).parents[1]
    lines = f"""
import sys; sys.path.insert(0, {str(folder)!r})
from armstep.__main__ import main
assert main(["check", {str(files["shield"])!r}]) == 0
assert not {{"iiwa_dnn", "pinocchio", "scipy"}} & {{*sys.modules}}
"""
    assert "0 differ" in run(sys.executable, "-I", "-c", lines)


def changed(text: str, seal: bool, *path: Any, value: Any = None) -> str:
    """Change a member of a file; with `seal`, its checksum too."""
    members = json.loads(text)
    place = members
    for key in path[:-1]:
        place = place[key]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    del members["vectors"]
    if seal:
        members["checksum"] = own_tables.checksum(members)
    return json.dumps(members)


VELOCITY = ("numbers", "plan", "step", "arrays", "constants", "motion_limits", "velocity", 3)
TABLE = ("integers", "plan", "step", "arrays", "table", "rows", 1, "address")


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (("release",), 2, "has tables of release 2; this armstep reads 1"),
        (("release",), None, "is damaged: KeyError('release')"),
        (("dt",), 0.0, "is damaged: its sizes do not belong together"),
        (("digest",), "xyz", "is damaged: ValueError"),
        (VELOCITY, 9.0, "is damaged: its numbers have another digest"),
        (VELOCITY, "fast", "is damaged: ValueError"),
        (TABLE, "schemes_parts_no_such", "'schemes_parts_no_such' is no part of this release"),
        (TABLE, "schemes_parts_copy_limit", "is damaged: its numbers have another digest"),
        (("joint_names",), ["a"] * 6, "is damaged: its sizes do not belong together"),
        (("obstacle_names",), [], "is damaged: its sizes do not belong together"),
        (("limits", "jerk"), [1.0], "is damaged: its sizes do not belong together"),
        (("memory",), 100, "is damaged: its sizes do not belong together"),
        (("scratch",), 10**9, "is damaged: its sizes do not belong together"),
        (("kind",), "arm", "is damaged: ValueError"),
        (("own",), ["mine"], "has parts of a user's own: compile shield_own.c, and pass own="),
    ],
)
def test_what_is_no_table_is_refused_in_a_line(
    path: Any, value: Any, words: str, files: dict[str, Path], tmp_path: Path
) -> None:
    text = files["shield"].read_text(encoding="utf-8")
    other = tmp_path / "other.json"
    for seal, expected in ((True, words), (False, "is damaged: its checksum is another one")):
        other.write_text(changed(text, seal, *path, value=value), encoding="utf-8")
        with pytest.raises(armstep.TablesError) as caught:
            armstep.Shield(other)
        said = str(caught.value)
        assert said.startswith(f"{other}: ")
        assert "\n" not in said
        assert (expected if path != ("release",) else words) in said


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is damaged: JSONDecodeError"),
        ("[" * 100_000, "is damaged: RecursionError"),
        ("[]", "is damaged: TypeError"),
        ('{"release": 1', "is damaged: JSONDecodeError"),
        (None, "cannot be read: No such file or directory"),
    ],
)
def test_what_is_no_json_is_refused_in_a_line(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "none.json"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(armstep.TablesError, match=words):
        armstep.load_tables(path)


def mutants(text: str, count: int) -> Iterator[str]:
    """Change numbers, words and structure of a file; the checksum is right."""
    draw = random.Random(0)
    values = [0, -1, 1, 7, 29_999, 10**30, 1e300, "inf", "nan", "", None, [], {}, True]
    for _ in range(count):
        members = json.loads(text)
        for _ in range(draw.choice([1, 1, 2, 5])):
            place: Any = members
            while True:
                keys = [*place] if isinstance(place, dict) else [*range(len(place))]
                if not keys:
                    break
                key = draw.choice(keys)
                if not isinstance(place[key], dict | list) or draw.random() < 0.05:
                    place[key] = draw.choice([*values, place[keys[0]]])
                    break
                place = place[key]
        members["checksum"] = own_tables.checksum(members)
        yield members


def test_mutated_tables_load_or_are_refused(files: dict[str, Path]) -> None:
    """Of most the digest is another one; it is computed anew, as who made them would."""
    loaded = 0
    for path in files.values():
        members = json.loads(path.read_text(encoding="utf-8"))
        del members["vectors"]
        for mutant in mutants(json.dumps(members), 150):
            try:
                made = own_tables.Tables(mutant)
            except (LookupError, TypeError, ValueError, OverflowError, AttributeError):
                continue
            loaded += 1
            assert pickle.loads(pickle.dumps(made)).digest == made.digest
    assert loaded > 0


def tight(step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector) -> None:
    """Keep the fourth joint slow."""
    lb[3] = max(lb[3], -constants[0])
    ub[3] = min(ub[3], constants[0])


class Tight(Limit):
    """A limit of a user's own."""

    kernel = staticmethod(tight)

    def constants(self, robot: Robot) -> Vector:
        return np.array([0.01])


def test_parts_of_a_users_own_are_compiled_beside_the_file(tmp_path: Path) -> None:
    controller, q0 = drawing(with_limits(Tight()))
    path = export.tables(controller, tmp_path / "mine.json", q0=q0)
    assert sorted(each.name for each in tmp_path.iterdir()) == [
        "armstep.h",
        "mine.json",
        "mine_own.c",
    ]
    own = tmp_path / "mine_own.so"
    run("gcc", "-std=c99", "-O1", "-shared", "-fPIC", tmp_path / "mine_own.c", "-o", own)
    assert command.main(["check", str(path), str(own)]) == 0
    arm = armstep.Controller(path, own=own)
    assert pickle.loads(pickle.dumps(arm)).tables.digest == arm.tables.digest
    for wrong, words in (
        (None, "compile mine_own.c, and pass own="),
        (tmp_path / "none.so", "own: .*none.so"),
        (os.environ["ARMSTEP_LIBRARY"], "own: .*mine_own"),
    ):
        with pytest.raises(armstep.TablesError, match=words):
            armstep.Controller(path, own=wrong)
    text = (tmp_path / "mine_own.c").read_text(encoding="utf-8")
    (tmp_path / "other.c").write_text(text.replace('{"', '{"other_'), encoding="utf-8")
    run("gcc", "-std=c99", "-O1", "-shared", "-fPIC", tmp_path / "other.c", "-o", own)
    with pytest.raises(armstep.TablesError, match=r"has other parts than .*tight"):
        armstep.Controller(path, own=f"{tmp_path}/./mine_own.so")


def test_a_library_that_is_missing_is_said_in_a_line(tmp_path: Path) -> None:
    (tmp_path / "none.bin").write_bytes(b"no library")
    folder = Path(armstep.__file__).parents[1]
    for place in (tmp_path / "none.bin", tmp_path / "no_file.bin"):
        done = subprocess.run(
            [sys.executable, "-c", "import armstep"],
            cwd=folder,
            env=os.environ | {"ARMSTEP_LIBRARY": str(place)},
            capture_output=True,
            text=True,
            check=False,
        )
        words = "armstep.errors.LibraryError: no library for this machine: pip install "
        assert done.stderr.splitlines()[-1].startswith(words)


def test_a_shield_of_another_frame_takes_its_twists(tmp_path: Path) -> None:
    shield = Shield(make_shield().robot, 1e-3)
    path = export.tables(shield, tmp_path / "elbow.json", frame="iiwa7_link_4", q0=START)
    assert armstep.Shield(path).tables.frame_names == ("iiwa7_link_4",)
    assert command.main(["check", str(path)]) == 0
