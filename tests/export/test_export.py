"""Exported controllers: C's commands are Python's, and the code keeps the promises of its page."""

import importlib
import re
import shutil
from inspect import cleandoc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from export_settings import SETTINGS, drawing, with_limits
from helpers_export import WARNINGS, in_armstep, needs, run
from hostile_arms import START, make_shield
from iiwa_dnn import DoubleIndicator
from iiwa_dnn.compiling.kinds import attributes
from iiwa_dnn.compiling.sources import Package
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.export import c99
from iiwa_dnn.export.folder import run as run_controller, take_exported_kinematics
from iiwa_dnn.schemes.joint_limits import MotionConstants
from iiwa_dnn.studies.runs import paper_robot
from judge_distances import swinging

pytestmark = needs("gcc")


@pytest.fixture(scope="module")
def heart(tmp_path_factory: pytest.TempPathFactory) -> Path:
    controller, q0 = drawing()
    return c99(controller, tmp_path_factory.mktemp("heart"), q0)


def code_of(folder: Path) -> list[Path]:
    """List the files of a folder that go into a program."""
    return [each for each in folder.glob("*.c") if each.stem not in ("compare", "example")]


REACHING = ("inertia, velocity limits active", "collisions with balls")
"""Controllers whose limits become active."""

UNTOUCHED = 12345.678
"""Number in scratch that no step writes."""

STEPS = 2000
"""Steps until what a controller is there for has come and gone."""


@pytest.mark.filterwarnings("ignore:.* apart at the start")
@pytest.mark.parametrize("name", SETTINGS)
def test_commands_have_pythons_bits_in_closed_loop(name: str, tmp_path: Path) -> None:
    """Pinocchio's own kinematics have other last digits: tests/robot/test_kinematics_kernel.py.

    Less scratch than there is, five eighths of it, is enough.
    """
    controller, q0 = SETTINGS[name]()
    there = in_armstep(controller, tmp_path, q0)
    scratch = there._buffers.scratch
    scratch[:] = UNTOUCHED
    controller.anchor(iiwa_dnn.Configuration(controller.robot, q0))
    take_exported_kinematics(controller)
    dt = controller.dt
    q = q0.copy()
    limited = 0
    actions = set()
    for k in range(STEPS):
        targets = there.targets(k * dt)
        command = controller.step(q, k * dt)
        found = there.step(q, k * dt)
        assert targets.tobytes() == command.targets.tobytes()
        assert command.data.tobytes() in scratch.tobytes()  # the log of the step
        assert found.dq.tobytes() == command.dq.tobytes()
        assert found.next_q.tobytes() == command.next_q.tobytes()
        said = (found.action, found.program, found.fraction, there.path_lag)
        assert said == (command.action, command.kind, command.fraction, controller.path_lag)
        if k % 10 == 0:
            limits = [own for own in command.active_limits if own not in command.conditions]
            assert [*found.active_limits] == limits
            limited += bool(limits)
        actions.add(found.action)
        q = command.next_q
    assert np.flatnonzero(scratch != UNTOUCHED).max() < 5 * scratch.size // 8
    assert np.abs(q - q0).max() > 1e-4
    assert limited > 5 or name not in REACHING
    assert len(actions) > 1 or not name.startswith(("without", "yielding", "collisions with balls"))


TIP = iiwa_dnn.Configuration(paper_robot(), START).position
MOVING = iiwa_dnn.CollisionAvoidance(
    [
        iiwa_dnn.Sphere(TIP + [0.05, 0.35, 0.0], 0.06, velocity=[0.0, -0.1, 0.0]),
        iiwa_dnn.Sphere(TIP + [0.3, -0.5, 0.0], 0.05),
    ]
)
SMOOTH = (iiwa_dnn.AccelerationLimits(10.0), iiwa_dnn.JerkLimits(500.0))
VARYING: dict[str, Any] = {"longest_period": 4e-3}
HOSTILE: dict[str, dict[str, Any]] = {
    "constant": {"scheme": with_limits(*SMOOTH)},
    "varying": {"scheme": with_limits(*SMOOTH), **VARYING},
    "moving": {"scheme": with_limits(MOVING, *SMOOTH)},
    "moving, without rates": {"scheme": with_limits(MOVING), "policy": "relax"},
    "varying and moving": {"scheme": with_limits(MOVING, *SMOOTH), **VARYING},
    "continuous": {"mode": "continuous", "scheme": with_limits(MOVING)},
    "continuous and varying": {"mode": "continuous", **VARYING},
}


def stated(random: np.random.Generator, controller: iiwa_dnn.Controller) -> dict[str, float]:
    """Draw a period: that of the command, of the last one, or none."""
    longest = controller.longest_period
    if longest is None:
        return {"dt": controller.dt * random.uniform(0.3, 1.0)} if random.random() < 0.1 else {}
    period = random.uniform(0.1, 1.1) * longest
    return ({"dt": period}, {"elapsed": period}, {})[random.integers(3)]


@pytest.mark.filterwarnings("ignore:a period of .* the longest", "ignore:in continuous mode")
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_steps_have_pythons_bits(name: str, tmp_path: Path) -> None:
    """Positions jump, targets are far away, periods are stated in all ways, velocities are sent."""
    here, q0 = drawing(**HOSTILE[name])
    there = in_armstep(here, tmp_path, q0)
    pose = iiwa_dnn.Configuration(here.robot, q0)
    here.anchor(pose)
    take_exported_kinematics(here)
    random = np.random.default_rng(3)
    q = q0.copy()
    t = 0.0
    differing = 0
    actions = set()
    lags = set()
    sent = np.zeros(7)
    for k in range(5000):
        period = stated(random, here)
        q = q + 1e-3 * random.standard_normal(7) * (random.random() < 0.005)
        far = iiwa_dnn.Target(pose.position + 0.3 * random.standard_normal(3), pose.rotation)
        target = far if k // 100 % 5 == 4 else None
        if k % 1000 == 700:
            for each in (here, there):
                each.send(sent, 0.5)
        if k == 4900:
            here.halt()
            there.halt()
        command = here.step(q, t, target, **period)
        found = there.step(q, t, None if target is None else target.data, **period)
        said = (found.action, found.program, found.fraction, there.path_lag)
        differing += found.dq.tobytes() != command.dq.tobytes()
        differing += found.next_q.tobytes() != command.next_q.tobytes()
        differing += said != (command.action, command.kind, command.fraction, here.path_lag)
        actions.add(found.action)
        lags.add(there.path_lag)
        sent = 0.9 * command.dq
        q = command.next_q
        t += max(period.values(), default=here.dt)
    assert differing == 0
    assert len(actions) > 1
    assert len(lags) > 5
    assert not found.dq.any()
    assert importlib.import_module("armstep.__main__").main(["check", f"{tmp_path}/arm.json"]) == 0


def test_obstacles_are_placed_beside_a_controller(tmp_path: Path) -> None:
    """A ball that comes to its place at the first step is one that was always there."""
    scheme, away = (
        with_limits(iiwa_dnn.CollisionAvoidance([iiwa_dnn.Sphere(place, 0.05)]), *SMOOTH)
        for place in ([0.36, 0.16, 0.64], [5.0, 0.0, 0.0])
    )
    path = iiwa_dnn.Line((0.0, -0.2, 0.3), period=2.0)
    here, q0 = drawing(scheme, path)
    there = in_armstep(drawing(away, path)[0], tmp_path, q0)
    here.anchor(iiwa_dnn.Configuration(here.robot, q0))
    take_exported_kinematics(here)
    q = q0
    limited = 0
    for k in range(1000):
        command = here.step(q, k * here.dt)
        places = [[0.36, 0.16, 0.64]] if k % 100 == 0 else None
        found = there.step(q, k * here.dt, obstacles=places)
        assert found.dq.tobytes() == command.dq.tobytes()
        limited += any("Sphere 1" in own for own in found.active_limits)
        q = command.next_q
    assert limited > 10


SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
ON_ARM = needs("aarch64-linux-gnu-gcc", "qemu-aarch64")


@pytest.mark.parametrize(
    ("compiler", "flags", "runner"),
    [
        ("gcc", SANITIZERS, ()),  # ends at undefined behaviour
        pytest.param("aarch64-linux-gnu-gcc", ("-static",), ("qemu-aarch64",), marks=ON_ARM),
    ],
)
def test_the_folder_passes_its_own_test_which_can_fail(
    heart: Path, compiler: str, flags: tuple[str, ...], runner: tuple[str, ...], tmp_path: Path
) -> None:
    program = (*runner, tmp_path / "compare")
    sources = [heart / "compare.c", *code_of(heart)]
    run(compiler, *WARNINGS, "-O0", "-DROUNDS=1", *flags, "-o", program[-1], *sources, "-lm")
    said = run(*program, heart / "vectors.csv")
    assert said.startswith("500 steps: 0 commands differ")
    lines = (heart / "vectors.csv").read_text(encoding="utf-8").splitlines()
    cells = lines[-1].split(",")
    cells[-2] = repr(float(cells[-2]) + 1e-6)
    (tmp_path / "vectors.csv").write_text("\n".join([*lines[:-1], ",".join(cells), ""]))
    with pytest.raises(AssertionError, match="500 steps: 1 commands differ"):
        run(*program, tmp_path / "vectors.csv")


def test_make_and_the_example_run_as_the_readme_says(heart: Path, tmp_path: Path) -> None:
    shutil.copytree(heart, tmp_path, dirs_exist_ok=True)
    run("make", "example", "CFLAGS=-O0", cwd=tmp_path)
    controller, q0 = drawing()
    controller.anchor(iiwa_dnn.Configuration(controller.robot, q0))
    rows = run_controller(controller, q0, 1001)
    said = run(tmp_path / "example")
    shown = [float(value) for value in re.findall(r"= (\S+) rad", said)]
    np.testing.assert_allclose(shown, rows[-1, 1:8], rtol=0, atol=1e-6)


@pytest.mark.parametrize("name", [*REACHING, "a network of one's own"])
def test_the_code_reads_as_c_by_hand(name: str, tmp_path: Path) -> None:
    controller, q0 = SETTINGS[name]()
    c99(controller, tmp_path, q0, name="arm")
    lines = [line for own in code_of(tmp_path) for line in own.read_text("utf-8").splitlines()]
    assert max(map(len, lines)) <= 120
    text = (tmp_path / "armstep.c").read_text(encoding="utf-8")
    kernels = text[text.index("/* ----") :]
    assert not re.search(r"\(\*\w+\)[.[]|&\(\*|[=(] \(\((?!\w+ \*\)&)", kernels)
    assert "        const double below = step->q.data[i] - limits->lower.data[i];\n" in kernels
    sections = [text.index(f"/* ---- {title}") for title in SECTIONS if title in text]
    assert sections == sorted(sections)
    for words in (["gcc", *WARNINGS], ["g++", "-std=c++17", "-Wall", "-Werror", "-xc++"]):
        run(*words, "-fsyntax-only", *code_of(tmp_path))


SECTIONS = ("Kinematics", "Targets", "Program", "Network", "Control step", "Tables", "Interface")


@needs("clang")
def test_clang_has_no_warning_either(heart: Path) -> None:
    run("clang", *WARNINGS, "-fsyntax-only", *heart.glob("*.c"))


def test_the_code_is_plain_c_and_its_memory_is_stated(heart: Path) -> None:
    text = (heart / "armstep.c").read_text(encoding="utf-8")
    code = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    included = {"float", "math", "stdbool", "stddef", "stdint", "string"}
    assert set(re.findall(r"#include <(\S+)\.h>", code)) == included
    assert not re.search(r"\b(malloc|free|alloca|printf|fopen|goto|setjmp|restrict)\b", code)
    assert not re.search(r"__(builtin|atomic|attribute)", code)
    for words in (
        "static inline ptrdiff_t step_cycle_take_step(struct arena *arena, Vector data,",
        "/* Tighten the bounds lb and ub (n,) [rad/s] to those of `JointLimits`; clip",
        " * iiwa_dnn/schemes/joint_limits.py: motion_limits */",
    ):
        assert words in text
    [header] = [each for each in heart.glob("*.h") if each.stem != "armstep"]
    stated = re.search(r"_MEMORY = (\d+)", header.read_text(encoding="utf-8"))
    assert stated
    assert 8 * int(stated[1]) <= 16_000
    readme = (heart / "README.md").read_text(encoding="utf-8")
    assert f"memory of an arm | 8 × {stated[1]} bytes" in readme
    assert "@" not in readme


CORTEX = ("-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard", "-mthumb")


@pytest.mark.parametrize(
    ("prefix", "flags", "most"),
    [
        ("", ("-fno-pie",), 138_000),
        pytest.param("arm-none-eabi-", CORTEX, 89_000, marks=needs("arm-none-eabi-gcc")),
    ],
)
def test_size_without_global_state(
    heart: Path, prefix: str, flags: tuple[str, ...], most: int, tmp_path: Path
) -> None:
    """Of the core, for shields and controllers of any arm."""
    made = tmp_path / "armstep.o"
    run(f"{prefix}gcc", *WARNINGS, *flags, "-Os", "-c", "-o", made, heart / "armstep.c")
    text, data, bss = map(int, run(f"{prefix}size", made).splitlines()[1].split()[:3])
    assert text <= most
    assert data == bss == 0


class _Local(iiwa_dnn.Limit):
    kernel = staticmethod(lambda step, constants, G, h, lb, ub: None)


AVOIDANCE = iiwa_dnn.CollisionAvoidance(
    [swinging(iiwa_dnn.Sphere)((0, 0, 2), 0.1, velocity=(0.1, 0, 0))]
)
DUAL = iiwa_dnn.PrimalDualNetwork()
UNSTATED = iiwa_dnn.Scheme([iiwa_dnn.Manipulability()], DoubleIndicator().tasks)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"scheme": UNSTATED}, "parts: are in Python, .* Manipulability"),
        ({"scheme": with_limits(AVOIDANCE)}, "call: CollisionAvoidance"),
        ({"solver": iiwa_dnn.DNNSolver(DUAL)}, "call: PrimalDualNetwork"),
        ({"scheme": with_limits(_Local())}, "lambda.* cannot be exported"),
    ],
)
def test_what_is_not_compiled_is_refused_by_name(
    options: dict[str, Any], words: str, tmp_path: Path
) -> None:
    with pytest.raises(InvalidInputError, match=words):
        c99(drawing(**options)[0], tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_a_kernel_as_the_page_of_schemes_shows_it_is_exported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has no annotations: its types are those with which it is entered."""
    page = (Path(__file__).parents[2] / "docs" / "schemes.md").read_text(encoding="utf-8")
    source = re.search(r"\n(from iiwa_dnn\.compiling\..*?)class CompiledClearance", page, re.DOTALL)
    assert source
    (tmp_path / "page_kernel.py").write_text(f"import math\n{source[1]}", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    limit = Page(importlib.import_module("page_kernel").clearance_row)
    controller, q0 = drawing(with_limits(limit))
    exported = in_armstep(controller, tmp_path, q0)
    controller.anchor(iiwa_dnn.Configuration(controller.robot, q0))
    take_exported_kinematics(controller)
    for k in range(50):
        command = controller.step(q0, k * controller.dt)
        assert exported.step(q0, 0.0, command.targets).dq.tobytes() == command.dq.tobytes()
    code = (tmp_path / "arm_own.c").read_text(encoding="utf-8")
    assert "h.data[0] = own.at->gain * (d - own.at->distance);" in code


class Page(iiwa_dnn.Limit):
    rows = 1

    def __init__(self, kernel: Any) -> None:
        self.kernel = kernel

    def constants(self, robot: iiwa_dnn.Robot) -> np.ndarray:
        return np.array([robot.frame_id("iiwa7_link_4"), 20.0, 0.1, 0.5, 0.5, 0.5])


def numbers_of(folder: Path, name: str, tmp_path: Path) -> list[float]:
    """Print the numbers that a table holds in C."""
    source = tmp_path / "table.c"
    source.write_text(
        f"""#include <stdio.h>
#include "arm.c"
int main(void)
{{
    const double *numbers = (const double *)&arm_numbers.plan.step.{name};
    const size_t count = sizeof arm_numbers.plan.step.{name} / sizeof *numbers;
    for (size_t k = 0; k < count; k++) printf("%.17g\\n", numbers[k]);
    return 0;
}}"""
    )
    run("gcc", "-std=c99", "-O0", f"-I{folder}", source, "-o", tmp_path / "table", "-lm")
    return [float(line) for line in run(tmp_path / "table").split()]


@pytest.mark.parametrize("name", ["other tasks", "collisions with balls", "tilting poses"])
def test_tables_have_pythons_numbers_by_their_names(name: str, tmp_path: Path) -> None:
    controller, q0 = SETTINGS[name]()
    folder = c99(controller, tmp_path, q0, name="arm")
    controller.anchor(iiwa_dnn.Configuration(controller.robot, q0))
    plan = controller.control_layout.plan
    for field, numbers in (
        ("arrays.constants", plan.arrays.constants),
        ("paths.constants", plan.paths.constants),
    ):
        found = numbers_of(folder, field, tmp_path)
        np.testing.assert_array_equal(found, numbers, field)


ROOT = Path(iiwa_dnn.__file__).parent


@pytest.mark.parametrize("kind", ["controller", "shield"])
def test_a_reviewer_finds_limits_gains_and_capsules_by_name(kind: str, tmp_path: Path) -> None:
    if kind == "shield":
        c99(make_shield(), tmp_path, START, name="arm")
    else:
        controller, q0 = SETTINGS["collisions with balls"]()
        c99(controller, tmp_path, q0, name="arm")
    whole = "".join(
        (tmp_path / f"{own}.c").read_text(encoding="utf-8") for own in ("arm", "armstep")
    )
    text = " ".join(whole.split()).replace("{ ", "{")
    limit = repr(float(paper_robot().dq_max[3]))
    about = attributes(cleandoc(MotionConstants.__doc__ or ""))
    for words in (
        f"double velocity[7]; /* {about['velocity']} */",
        ".velocity = {/* iiwa7_joint_1 */ 1.710422666954443, /* iiwa7_joint_2 */",
        f"/* iiwa7_joint_4 */ {limit},",
        "/* Sphere 1 */ {.frame = 0, .radius = 0.05, .speed = 0.0, .half = {0.0, 0.0, 0.0},",
        "/* iiwa7_link_4 */ {.frame = 9, .radius = 0.080001, .speed = 0.0, .half = {0.0, 0.0, 0.07",
        "/* Sphere 1 and iiwa7_link_4 */ {.second = 4, .first =",
        ".kind = 3 /* LIMIT */",
        f"/* {Package(ROOT).module('iiwa_dnn.schemes.viability').about['HALVINGS']} */",
    ):
        assert words in text
    # No number of a table stands without a name but in matrices.
    assert not re.search(r"static const double arm_\w+\[\d{2,}\] =", text)


class _Plain(iiwa_dnn.Heart):
    """A heart in Python."""

    def move(self, t: float, target: np.ndarray) -> None:
        super().move(t, target)


def test_a_reference_without_compiled_form_leaves_the_targets_to_the_caller(tmp_path: Path) -> None:
    controller, q0 = drawing(path=_Plain())
    folder = c99(controller, tmp_path, q0)
    assert "| references | none |" in (folder / "README.md").read_text(encoding="utf-8")
    run("gcc", *WARNINGS, "-fsyntax-only", folder / "example.c")
    exported = in_armstep(controller, tmp_path, q0)
    assert not exported.tables.has_reference
    assert exported.step(q0, 0.0, controller.targets(0.0)).ok


def test_the_controller_that_is_exported_stays_as_it_is(tmp_path: Path) -> None:
    controller, q0 = drawing()
    twin, _ = drawing()
    for k in range(5):
        controller.step(q0, k * controller.dt)
        twin.step(q0, k * controller.dt)
    c99(controller, tmp_path)
    np.testing.assert_array_equal(controller._motion.numbers, twin._motion.numbers)
    np.testing.assert_array_equal(controller.step(q0, 0.0).dq, twin.step(q0, 0.0).dq)


def test_the_folder_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    controller, q0 = drawing()
    (tmp_path / "Makefile").write_text("mine")
    with pytest.raises(FileError, match="holds other files than an export"):
        c99(controller, tmp_path, q0)
    assert [each.name for each in tmp_path.iterdir()] == ["Makefile"]
    c99(controller, tmp_path, q0, overwrite=True)
    c99(controller, tmp_path, q0)  # as an earlier export is there
    assert (tmp_path / "Makefile").read_text(encoding="utf-8") != "mine"


def test_without_a_reference_the_vectors_follow_a_figure(tmp_path: Path) -> None:
    controller, q0 = drawing()
    controller.reference = None
    folder = c99(controller, tmp_path, q0)
    rows = np.loadtxt(folder / "vectors.csv", delimiter=",", skiprows=1)
    exported = in_armstep(controller, tmp_path, q0)
    for row in rows:
        command = exported.step(row[1:8], row[0], row[10:28])
        assert command.action == row[-1]
        np.testing.assert_allclose(command.dq, row[28:35], rtol=0, atol=1e-9)
    assert np.ptp(rows[:, 10]) > 1e-3


@pytest.mark.parametrize("name", ["a-b", "class", "A", "1a", "double", "main"])
def test_a_name_that_is_none_of_c_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="name: must be"):
        c99(drawing()[0], tmp_path / "none", name=name)
