"""A shield as a package of its own: the commands of `Shields`, in Python without this package."""

import copy
import multiprocessing
import pickle
import platform
import re
import shutil
import subprocess
import sys
import threading
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_export import needs, packaged, run
from iiwa_dnn import (
    InvalidInputError,
    MissingDependencyError,
    NotFoundError,
    Shield,
    Shields,
    Sphere,
    export,
    load_robot,
)

pytestmark = needs("gcc")

DT = 1e-3
LONGEST = 3e-3
SMOOTH = load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
BALL = Sphere([0.36, 0.16, 0.64], 0.05)
SETTINGS: dict[str, Any] = {
    "dt": DT,
    "obstacles": [BALL],
    "timeout": 0.02,
    "longest_period": LONGEST,
    "delay": 4.3e-3,
}


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    shield = Shield(SMOOTH, **SETTINGS)
    return packaged(shield, tmp_path_factory.mktemp("project"), "a_shield", START)


def tiled(own: dict[str, np.ndarray], count: int) -> dict[str, np.ndarray]:
    return {name: np.tile(value, (count, 1)) for name, value in own.items()}


def test_each_kind_of_request_has_the_bits_of_shields(package: Any) -> None:
    random = np.random.default_rng(0)
    here = Shields(SMOOTH, 1, **SETTINGS)
    there = package.Shield()
    many = package.Shields(65, threads=2)
    q = START.copy()
    seen = set()
    for k in range(1200):
        if k % 30 == 0:
            kind = ["dq", "twist", "position"][k // 30 % 3]
            own = {kind: random.standard_normal(6 if kind == "twist" else 7)}
            if kind == "position":
                own = {kind: q + 0.3 * own[kind]}
        told: dict[str, float] = [{}, {"dt": 2.0 * DT}, {"elapsed": 0.7 * DT}][k % 3]
        given = own if k % 120 < 60 else {}
        expected = here.step(q[np.newaxis], **tiled(given, 1), **told)
        found = there.step(q, **given, **told)
        batch = many.step(np.tile(q, (65, 1)), **tiled(given, 65), **told)
        assert found.dq.tobytes() == expected.dq[0].tobytes()
        assert found.next_q.tobytes() == expected.next_q[0].tobytes()
        assert (found.clipped, found.reason) == (expected.clipped[0], expected.reason[0])
        assert batch.dq.tobytes() == 65 * found.dq.tobytes()
        assert found.active_limits == expected.active_limits(0)
        assert found.margin == here.margin(0)
        assert found.stopping_time == here.stopping_time(0)
        seen.update(found.active_limits)
        q = found.next_q + (0.05 if k == 500 else 0.0)
    assert len(seen) > 15


def test_halt_reset_and_send(package: Any) -> None:
    shield = package.Shield()
    first = [shield.step(START, dq=np.full(7, 0.2)).dq for _ in range(50)]
    shield.halt()
    for _ in range(300):
        command = shield.step(START, dq=np.full(7, 0.2))
    assert not command.dq.any()
    assert command.active_limits[0] == "halted"
    shield.reset()
    again = [shield.step(START, dq=np.full(7, 0.2)).dq for _ in range(50)]
    np.testing.assert_array_equal(first, again)
    shield.reset(START)
    assert shield.step(START + 0.01, dq=np.zeros(7), dt=DT).next_q == pytest.approx(START)
    # Somebody else sends what the shield would have: the next command is the same.
    other = package.Shield()
    shield.reset()
    shield.step(START, dq=np.full(7, 0.2))
    other.step(START, dq=np.full(7, 0.2))
    sent = shield.step(START).dq
    other.send(sent)
    assert shield.step(START).dq.tobytes() == other.step(START).dq.tobytes()


def test_obstacles_are_where_they_are_said_to_be(package: Any) -> None:
    far = package.Shield().step(START, obstacles=[[3.0, 3.0, 3.0]])
    beside = [[0.36, 0.18, 0.64]]  # nearer than the links of the wrist are to each other
    near = package.Shield().step(START, obstacles=beside)
    assert far.margin.distance > near.margin.distance
    places = np.array([[[3.0, 3.0, 3.0]], beside])
    shields = package.Shields(2)
    shields.step(np.tile(START, (2, 1)), obstacles=places)
    assert [shields.margin(i) for i in range(2)] == [far.margin, near.margin]


def test_other_types_of_numbers_are_computed_in_float64(package: Any) -> None:
    wide = np.zeros((7, 3), np.float32)
    wide[:, 1] = START
    command = package.Shield().step(wide[:, 1], [0] * 7)
    same = package.Shield().step(START.astype(np.float32).astype(float), np.zeros(7))
    assert command.dq.dtype == np.float64
    assert command.next_q.tobytes() == same.next_q.tobytes()


@pytest.mark.parametrize(
    "own",
    [
        {"q": START[:6]},
        {"q": np.full(7, np.nan)},
        {"q": np.full(7, 1e300)},
        {"dq": np.zeros((1, 7))},
        {"dq": ["a"] * 7},
        {"dq": START, "twist": np.zeros(6)},
        {"dt": 0.0},
        {"dt": DT, "elapsed": DT},
        {"obstacles": [[0.0, 0.0, np.inf]]},
        {"obstacles": np.zeros((2, 3))},
    ],
)
def test_wrong_input_is_an_error_and_changes_nothing(package: Any, own: dict[str, Any]) -> None:
    shield = package.Shield()
    shield.step(START, dq=np.ones(7))
    before = pickle.dumps(shield)
    with pytest.raises(ValueError, match=r"must|pass|are two"):
        shield.step(**{"q": START, **own})
    assert pickle.dumps(shield) == before


def _run(shield: Any) -> bytes:
    q = START
    for _ in range(30):
        command = shield.step(q, twist=np.array([0.0, 0.1, 0.1, 0.0, 0.2, 0.0]))
        q = command.next_q
    return bytes(command.dq.tobytes())


def test_copies_pickles_forks_and_threads_carry_the_state(package: Any) -> None:
    shield = package.Shield()
    _run(shield)
    others = [copy.copy(shield), copy.deepcopy(shield), pickle.loads(pickle.dumps(shield))]
    with multiprocessing.get_context("fork").Pool(1) as pool:
        forked = pool.apply(_run, [shield])
    expected = _run(shield)
    assert [*map(_run, others), forked] == [expected] * 4
    errors: list[bool] = []

    def ask() -> None:
        errors.extend(bool(np.abs(shield.step(START).dq).max() > 10.0) for _ in range(200))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len(errors) == 800
    assert not any(errors)


def test_it_says_what_it_is(package: Any) -> None:
    assert tuple(SMOOTH.joint_names) == package.JOINT_NAMES
    np.testing.assert_array_equal(package.LIMITS["jerk"], SMOOTH.dddq_max)
    assert (package.DT, package.LONGEST_PERIOD, package.OBSTACLES) == (DT, LONGEST, 1)
    assert package.Shield().step(START, dq=np.ones(7)).active_limits


def test_a_library_that_is_missing_or_another_is_said_in_a_line(tmp_path: Path) -> None:
    project = export.python(Shield(SMOOTH, DT), tmp_path, "lonely")
    command = [sys.executable, "-c", "import lonely"]
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    assert "ImportError: lonely has no library for linux" in done.stderr
    (tmp_path / "lonely" / "_library.bin").write_bytes(b"no library")
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    assert "ImportError: lonely's library is none for this machine" in done.stderr
    text = (tmp_path / "lonely" / "lonely.c").read_text(encoding="utf-8")
    flags = ["-std=c99", "-O0", "-shared", "-fPIC", "-I", tmp_path / "lonely"]
    for changed, said in (
        (re.sub(r"UINT64_C\(0x\w+", "UINT64_C(0x1", text), "library is of another version"),
        (text.replace(".velocity = {", ".velocity = {0.5 + ", 1), "tables do not load: status 2"),
    ):
        assert changed != text
        (tmp_path / "other.c").write_text(changed)
        sources = [tmp_path / "other.c", tmp_path / "lonely" / "armstep.c"]
        run("gcc", *flags, *sources, "-o", tmp_path / "lonely" / "_library.bin", "-lm")
        done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
        assert f"ImportError: lonely's {said}" in done.stderr


def test_its_wheel_runs_its_own_vectors_without_this_package(tmp_path: Path) -> None:
    pytest.importorskip("hatchling")
    project = export.python(Shield(SMOOTH, DT, [BALL]), tmp_path / "project", "alone", q0=START)
    # A repository around that ignores the project's folder would leave the package out.
    (tmp_path / ".git").mkdir()
    (tmp_path / ".gitignore").write_text("/alone/", encoding="utf-8")
    run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", cwd=project)
    [wheel] = (project / "dist").glob("alone-0.1.0-py3-none-*.whl")
    assert wheel.stat().st_size < 400_000
    with zipfile.ZipFile(wheel) as own:
        own.extractall(tmp_path / "site")
    shutil.rmtree(project)
    said = run(
        sys.executable,
        "-I",
        "-c",
        f"""
import sys; sys.path[:0] = [{str(tmp_path / "site")!r}]
from alone.__main__ import run
assert run() == 0
assert "iiwa_dnn" not in sys.modules and "pinocchio" not in sys.modules
""",
    )
    assert "500 steps, 0 differ" in said


@pytest.mark.parametrize("name", ["a-b", "class", "A", "", "1a", "double"])
def test_a_name_that_is_none_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="name: must be"):
        export.python(Shield(SMOOTH, DT), tmp_path, name)


def test_one_wheel_serves_the_platforms_that_are_compiled_for(tmp_path: Path) -> None:
    """As `platforms` leaves them; here gcc stands for zig, and this machine for all."""
    pytest.importorskip("hatchling")
    project = export.python(Shield(SMOOTH, DT), tmp_path / "project", "fat", q0=START)
    package = project / "fat"
    name = f"_library_linux_{platform.machine()}.bin"
    flags = ["-std=c99", "-O1", "-shared", "-fPIC"]
    run("gcc", *flags, *package.glob("*.c"), "-o", package / name, "-lm")
    run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", cwd=project)
    [wheel] = (project / "dist").glob("fat-0.1.0-py3-none-any.whl")
    with zipfile.ZipFile(wheel) as own:
        assert f"fat/{name}" in own.namelist()
    said = run(sys.executable, "-m", "fat", cwd=project)
    assert "500 steps, 0 differ" in said


def test_platforms_are_known_and_need_zig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(NotFoundError, match="amiga"):
        export.python(Shield(SMOOTH, DT), tmp_path, "fat", platforms=["amiga"])
    monkeypatch.setattr("iiwa_dnn.export.folder.find_spec", lambda name: None)
    with pytest.raises(MissingDependencyError, match="pip install ziglang"):
        export.python(Shield(SMOOTH, DT), tmp_path, "fat", platforms=["all"])
