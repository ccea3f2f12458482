"""A shield in C: the same commands as in Python, to the last bit, from every compiler."""

from pathlib import Path

import numpy as np
import pytest

from helpers_export import WARNINGS, needs, run
from iiwa_dnn import Shield, Sphere, export, load_robot, robot_from_dh

SMOOTH = load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
BALL = Sphere([0.36, 0.16, 0.64], 0.05)
SAME = "500 steps: 0 commands differ from Python's by more than 0 "

pytestmark = needs("gcc", "make")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    shield = Shield(SMOOTH, 1e-3, [BALL], timeout=0.02, delay=4e-3)
    return export.c99(shield, tmp_path_factory.mktemp("shield"), START)


@pytest.mark.parametrize(
    ("compiler", "flags", "runner"),
    [
        ("gcc", "-O0", ()),
        ("gcc", "-O3 -march=native", ()),
        ("gcc", "-O2 -std=gnu17 -march=native", ()),  # which contracts, but where it is forbidden
        ("gcc", "-O1 -fsanitize=address,undefined -fno-sanitize-recover=all", ()),
        pytest.param("clang", "-O2 -march=native", (), marks=needs("clang")),
        pytest.param(
            "aarch64-linux-gnu-gcc",
            "-O2 -static",
            ("qemu-aarch64",),
            marks=needs("aarch64-linux-gnu-gcc", "qemu-aarch64"),
        ),
    ],
)
def test_every_compiler_gives_the_bits_of_python(
    folder: Path, tmp_path: Path, compiler: str, flags: str, runner: tuple[str, ...]
) -> None:
    program = tmp_path / "test"
    sources = [folder / name for name in ("compare.c", "armstep.c", "iiwa7.c")]
    own = [*WARNINGS, "-DROUNDS=1", *flags.split()]
    run(compiler, *own, *sources, "-o", program, "-lm")
    assert run(*runner, program, folder / "vectors.csv").startswith(SAME)


def test_another_command_is_found(folder: Path, tmp_path: Path) -> None:
    lines = (folder / "vectors.csv").read_text(encoding="utf-8").splitlines()
    cells = lines[9].split(",")
    cells[-2] = repr(float(np.nextafter(float(cells[-2]), 10.0)))
    (tmp_path / "vectors.csv").write_text("\n".join([*lines[:9], ",".join(cells), *lines[10:], ""]))
    run("make", "compare", "CFLAGS=-O0 -DROUNDS=1", cwd=folder)
    with pytest.raises(AssertionError, match="500 steps: 1 commands differ"):
        run(folder / "compare", tmp_path / "vectors.csv")


def test_the_vectors_have_all_kinds_and_reasons(folder: Path) -> None:
    rows = np.loadtxt(folder / "vectors.csv", delimiter=",", skiprows=1)
    assert {*rows[:, 8]} == {0.0, 1.0, 2.0, 3.0}
    assert {2.0, 3.0, 6.0} <= {*rows[:, -1]}  # too old, not finite, resynchronised
    assert np.abs(rows[:, -8:-1]).max() > 0.1


def test_the_library_needs_no_elementary_function(folder: Path, tmp_path: Path) -> None:
    """But for the angle of an orientation, and the remainder of an angle along a path."""
    made = tmp_path / "armstep.o"
    run("gcc", "-O2", "-fno-math-errno", "-c", folder / "armstep.c", "-o", made)
    wanted = {line.split()[-1] for line in run("nm", "-u", made).splitlines()}
    wanted -= {"_GLOBAL_OFFSET_TABLE_", "__stack_chk_fail"}
    assert wanted == {"memcpy", "memset", "atan2", "fmod"}


def test_it_compiles_as_cpp_and_no_line_is_long(folder: Path, tmp_path: Path) -> None:
    for name in ("armstep.c", "iiwa7.c"):
        run("g++", "-std=c++17", "-Wall", "-fsyntax-only", "-x", "c++", folder / name)
        text = (folder / name).read_text(encoding="utf-8")
        assert max(map(len, text.splitlines())) <= 120


def test_the_example_asks_the_shield(tmp_path: Path) -> None:
    export.c99(Shield(SMOOTH, 1e-3), tmp_path, START)
    run("make", "example", "CFLAGS=-O0", cwd=tmp_path)
    turned = float(run(tmp_path / "example").split()[2]) - START[0]
    assert turned == pytest.approx(0.1, abs=2e-3)  # 0.1 rad/s for 1 s, less the time to start


def test_a_shield_of_many_joints_stays_within_its_memory(tmp_path: Path) -> None:
    """The velocities of 20 joints were written beyond an array for 18."""
    robot = robot_from_dh([(0.1, 0.0, 0.0, 0.0)] * 20, lower=-2.0, upper=2.0, velocity=1.0)
    export.c99(Shield(robot.with_limits(acceleration=10.0), 1e-3), tmp_path)
    said = run("make", "CFLAGS=-O1 -fsanitize=address", "LDFLAGS=-fsanitize=address", cwd=tmp_path)
    assert SAME in said
