"""The core: tables as C and as JSON, several arms in one program, refusals, mutated tables."""

import ast
import ctypes
import json
import re
import struct
import subprocess
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_settings import drawing, with_limits
from helpers_export import WARNINGS, compiled_core, needs, run, use_armstep
from hostile_arms import DT, ROBOT, START, make_shield
from iiwa_dnn import (
    AccelerationLimits,
    Configuration,
    Controller,
    DoubleIndicator,
    InvalidInputError,
    JerkLimits,
    Limit,
    Robot,
    Shield,
    Shields,
    Sphere,
    export,
    step,
)
from iiwa_dnn.compiling.library import Entry
from iiwa_dnn.export.arm_tables import STATE
from iiwa_dnn.export.core import LAID_OUT, core
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.schemes import CollisionAvoidance
from iiwa_dnn.schemes.parts import enter_limit
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.step import arms, fitting
from iiwa_dnn.step.memory import arm_state, motion_of
from iiwa_dnn.step.requests import Reason
from judge_limits import breaches

pytestmark = needs("gcc")

OK, OTHER_RELEASE, DAMAGED, UNFIT, ARITHMETIC, OTHER_TABLES, WRONG_KIND, NOT_FINITE = range(8)
INVALID = -1
SANITIZERS = "address,undefined,float-cast-overflow"
SANITIZED = ("-O1", f"-fsanitize={SANITIZERS}", "-fno-sanitize-recover=all")


NAMED = ("joint", "frame", "obstacle", "limit")
COUNTED = ("number", "integer", "part", "own")


class Tables(ctypes.Structure):
    """`struct armstep_tables`, from JSON."""

    _fields_ = (
        ("digest", ctypes.c_uint64),
        ("release", ctypes.c_int),
        ("kind", ctypes.c_int),
        ("name", ctypes.c_void_p),
        *((f"{own}{end}", ctypes.c_ssize_t) for own in NAMED for end in ("_names", "s")),
        ("first_row", ctypes.c_ssize_t),
        ("robot", ctypes.c_void_p * 5),
        *((word, ctypes.c_double) for word in ("dt", "longest", "delay")),
        ("memory", ctypes.c_ssize_t),
        ("scratch", ctypes.c_ssize_t),
        *((f"{own}{end}", ctypes.c_ssize_t) for own in COUNTED for end in ("s", "_count")),
    )


def flat(tree: Any) -> Iterator[Any]:
    """List the leaves of a tree of JSON in their order."""
    if isinstance(tree, dict | list):
        for own in tree.values() if isinstance(tree, dict) else tree:
            yield from flat(own)
    else:
        yield tree


class Arm:
    """An arm of the library, from tables in JSON."""

    def __init__(self, text: str, library: Any) -> None:
        own = json.loads(text)
        integers = [*flat(own["integers"])]
        parts = [k for k, each in enumerate(integers) if isinstance(each, str)]
        self.tables = Tables()
        for k in parts:
            integers[k] = library.armstep_part_number(
                ctypes.byref(self.tables), integers[k].encode()
            )
        self.kept = (
            np.array([*map(float, flat(own["numbers"]))]),
            np.array(integers, np.intp),
            np.array(parts, np.intp),
        )
        counts = {f"{word}s": len(own[f"{word}_names"]) for word in NAMED}
        words = ("dt", "longest", "delay", "memory", "scratch", "release", "first_row")
        self.tables = Tables(**counts, **{word: own[word] for word in words})
        self.tables.digest = int(own["digest"], 16)
        self.tables.kind = 1 + ["shield", "controller"].index(own["kind"])
        for word, array in zip(("number", "integer", "part"), self.kept, strict=True):
            setattr(self.tables, f"{word}s", array.ctypes.data)
            setattr(self.tables, f"{word}_count", array.size)
        self._library = library
        self._arm = (ctypes.c_double * (LAID_OUT + 1))()
        self.memory = np.zeros(own["memory"])
        self.scratch = np.zeros(own["scratch"])
        self.n = self.tables.joints
        self.status = library.armstep_load(self._arm, ctypes.byref(self.tables))

    def call(self, name: str, *given: Any) -> Any:
        """Call a function with the arm and its memory; arrays are pointers."""
        all_given = [each.ctypes if isinstance(each, np.ndarray) else each for each in given]
        return getattr(self._library, f"armstep_{name}")(self._arm, self.memory.ctypes, *all_given)

    def begin(self) -> None:
        self.call("begin", self.scratch)

    def step(
        self, q: Vector | None, kind: int = 0, request: Vector | None = None, **own: float
    ) -> Any:
        """Take a step; return its result and its command."""
        dq = np.full(self.n, 77.0)
        asked = None if request is None else request.ctypes.data
        given = use_armstep()._library.Input(
            None if q is None else q.ctypes.data,
            kind,
            asked,
            *(own.get(k, 0.0) for k in ("t", "dt", "elapsed")),
        )
        return self.call("step", self.scratch, ctypes.byref(given), dq), dq


@pytest.fixture(scope="module")
def library() -> Any:
    made = ctypes.CDLL(str(compiled_core(("-std=c99", "-O1", "-fPIC", "-shared"))))
    made.armstep_next_q.restype = ctypes.POINTER(ctypes.c_double)
    return made


@pytest.fixture(scope="module")
def text(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("json") / "arm.json"
    return export.tables(make_shield(), path).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def tracking_text(tmp_path_factory: pytest.TempPathFactory) -> str:
    smooth = with_limits(AccelerationLimits(1.0), JerkLimits(50.0))
    path = tmp_path_factory.mktemp("json") / "arm.json"
    return export.tables(drawing(smooth)[0], path, q0=drawing()[1]).read_text(encoding="utf-8")


def test_the_room_of_the_step_is_what_goes_to_a_robot() -> None:
    code = core().code
    functions = {
        f"step_{path.stem}_{node.name.lstrip('_')}"
        for path in Path(step.__path__[0]).glob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef)
    }
    there = {name.replace("__", "_") for name in re.findall(r"\b(step_\w+)\(", code)}
    assert len(functions) > 150
    assert functions <= there
    assert not re.search(r"\b(control|posing)_\w+\(", code)


def test_tables_in_json_give_the_bits_of_shields(text: str, library: Any) -> None:
    arm, shields = Arm(text, library), Shields(make_shield(), 1)
    assert arm.status == OK
    assert not json.loads(text)["integers"]["plan"]["step"]["arrays"]["table"]["rows"][0]["rest"]
    arm.begin()
    random = np.random.default_rng(3)
    q = START.copy()
    for k in range(400):
        request = random.standard_normal(7) if k % 20 == 0 else None
        expected = shields.step(q[np.newaxis], None if request is None else request[np.newaxis])
        result, dq = arm.step(q, 1, request)
        assert dq.tobytes() == expected.dq[0].tobytes()
        assert result == expected.reason[0]
        q = expected.next_q[0]


def exported(made: Any, folder: Path, library: Any, **settings: Any) -> Arm:
    """Return an arm of the library that has begun, by the tables of a shield or a controller."""
    path = export.tables(made, folder / "arm.json", **settings)
    arm = Arm(path.read_text(encoding="utf-8"), library)
    assert arm.status == OK
    arm.begin()
    return arm


@pytest.mark.parametrize("longest", [None, 4e-3])
def test_positions_that_cannot_be_read_brake_within_the_limits(
    longest: float | None, library: Any, tmp_path: Path
) -> None:
    """Without a pointer to them the arm went 0.06 rad beyond a position limit."""
    shield = Shield(ROBOT, DT, tracking_error=1.0, longest_period=longest)
    arm = exported(shield, tmp_path, library)
    twin = exported(shield, tmp_path, library)
    toward = ROBOT.dq_max * np.array([1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
    path = [START]
    stated = {} if longest is None else {"elapsed": DT}
    for k in range(3000):
        q = None if k % 700 > 400 else path[-1]
        result, dq = arm.step(q, 1, toward, **stated)
        nan = np.full(7, np.nan) if q is None else q
        assert twin.step(nan, 1, toward, **stated)[1].tobytes() == dq.tobytes()
        assert (result == Reason.Q_NOT_FINITE) == (q is None)
        path.append(path[-1] + DT * dq)
    assert breaches(np.array(path), DT, *ROBOT.limits) == []
    assert np.ptp(path, axis=0).max() > 1.0


@pytest.mark.parametrize("longest", [None, 10e-3])
def test_braking_without_a_program_keeps_the_limits(longest: float | None) -> None:
    """It passed position limits, kept the last step's period, and gave NaN after `send`."""
    shield = Shield(ROBOT, DT, longest_period=longest)
    plan = shield.layout(ROBOT.tip).plan
    random = np.random.default_rng(0)
    q = START
    for _ in range(60):
        request = 4.0 * random.standard_normal(7)
        for _ in range(random.integers(20, 300)):
            stated = {} if longest is None else {"dt": random.choice([1e-4, DT, longest])}
            command = shield.step(q, request, **stated)
            q = command.next_q
        memory = command.memory.copy()
        before, last = command.log.last, command.dq
        spacing = command.state.period
        now = q.copy()
        for _ in range(3000):
            arms.brake_arm(plan, memory)
            dq = np.array(motion_of(plan, arm_state(plan, memory)).last)
            slope, was = (dq - last) / DT, (last - before) / spacing
            assert (np.abs(slope) <= ROBOT.ddq_max * (1.0 + 1e-9)).all()
            assert (np.abs(slope - was) / DT <= ROBOT.dddq_max * (1.0 + 1e-6)).all()
            before, last, spacing = last, dq, DT
            now = now + DT * dq
            assert (now >= ROBOT.q_lower - 1e-9).all()
            assert (now <= ROBOT.q_upper + 1e-9).all()
        assert not dq.any()
    shield.reset()
    shield.step(START)
    shield.send(np.full(7, 0.0105))
    memory = shield._kept.memory.copy()
    arms.brake_arm(plan, memory)
    assert np.isfinite(memory).all()


def test_a_controllers_arguments_without_a_meaning_brake_within_the_limits(
    library: Any, tmp_path: Path
) -> None:
    rates = AccelerationLimits(), JerkLimits()
    scheme = DoubleIndicator(orientation="none", extra_limits=rates)
    controller = Controller(ROBOT, scheme, dt=DT)
    arm = exported(controller, tmp_path, library, q0=START)
    far = np.zeros(18)
    far[3:12] = np.eye(3).ravel()
    path = [START]
    for k in range(4000):
        far[:3] = [2.0 * np.sin(k // 400), 2.0 * np.cos(k // 400), 0.1]
        asked = np.where(k % 400 > 250, np.nan, far)
        path.append(path[-1] + DT * arm.step(path[-1], 0, asked, t=k * DT)[1])
    assert breaches(np.array(path), DT, *ROBOT.limits) == []
    assert np.ptp(path, axis=0).max() > 0.5


def test_frames_and_bodies_without_a_meaning_are_refused(library: Any, tmp_path: Path) -> None:
    """A count of -1 was nobody, and a body's number that of a person."""
    hand = Sphere([1.5, 0.0, 0.5], 0.1, speed=1.0, name="hand")
    shield = Shield(ROBOT, DT, [hand], people=2, field=3.0)
    arm = exported(shield, tmp_path, library)
    age = ctypes.c_double(0.0)
    capsules = np.array([[1.5, 0.0, 0.0, 1.5, 0.0, 1.0, 0.2]] * 2)
    box = np.concatenate([np.full(3, 0.1), np.eye(3).ravel(), [1.5, 0.0, 0.5]])

    def people(given: Any, count: int) -> int:
        return int(arm.call("people", given, ctypes.c_ssize_t(count), age))

    def body(number: int, numbers: Vector) -> int:
        return int(arm.call("body", ctypes.c_ssize_t(number), numbers, age))

    assert people(capsules, 2) == OK
    assert people(None, 0) == OK
    assert people(capsules, -1) == people(None, 2) == people(capsules, 3) == NOT_FINITE
    assert body(0, box) == OK
    for number in (-1, 1, 2, 3):
        assert body(number, box) != OK
    for k, value in ((0, -5.0), (3, 0.0), (4, 0.5), (13, np.nan)):
        wrong = box.copy()
        wrong[k] = value
        assert body(0, wrong) == NOT_FINITE
    alone = exported(Shield(ROBOT, DT), tmp_path, library)
    assert alone.call("people", capsules, ctypes.c_ssize_t(2), age) == WRONG_KIND
    assert alone.step(START)[0] != Reason.FRAME_REFUSED


def test_sent_commands_have_a_period_and_a_fraction(library: Any, tmp_path: Path) -> None:
    arm = exported(Shield(ROBOT, DT), tmp_path, library)
    for period, fraction in ((1e308, 1.0), (0.0, 1.0), (DT, -7.0), (DT, 1.5), (DT, np.nan)):
        numbers = ctypes.c_double(period), ctypes.c_double(fraction)
        assert arm.call("send", np.zeros(7), *numbers) == NOT_FINITE
    assert arm.call("send", np.zeros(7), ctypes.c_double(DT), ctypes.c_double(1.0)) == OK


def test_tables_with_another_period_or_unknown_parts_do_not_fit(text: str, library: Any) -> None:
    def loaded(change: Any) -> int:
        arm = Arm(text, library)
        change(arm)
        arm.tables.digest = library.armstep_digest(ctypes.byref(arm.tables))
        return int(library.armstep_load(arm._arm, ctypes.byref(arm.tables)))

    library.armstep_digest.restype = ctypes.c_uint64
    assert loaded(lambda arm: None) == OK
    assert loaded(lambda arm: setattr(arm.tables, "dt", -3.0)) == UNFIT
    for number in (-1, 0, 10_000):
        for k in range(2):
            change = partial(
                lambda arm, k, n: arm.kept[1].__setitem__(arm.kept[2][k], n), k=k, n=number
            )
            assert loaded(change) == UNFIT, (k, number)


def test_tables_that_were_changed_are_refused(text: str, library: Any) -> None:
    def status(*path: Any, value: Any = None) -> int:
        own = json.loads(text)
        place = own
        for key in path[:-1]:
            place = place[key]
        assert place[path[-1]] != value
        place[path[-1]] = value
        return Arm(json.dumps(own), library).status

    arrays = ("integers", "plan", "step", "arrays")
    assert (
        status(
            "numbers",
            "plan",
            "step",
            "arrays",
            "constants",
            "motion_limits",
            "velocity",
            3,
            value=9.0,
        )
        == DAMAGED
    )
    assert (
        status(*arrays, "table", "rows", 1, "address", value="schemes_parts_copy_limit") == DAMAGED
    )
    assert status("release", value=0) == OTHER_RELEASE
    assert status("scratch", value=100) == UNFIT
    assert status("memory", value=100) == UNFIT
    assert status("obstacle_names", value=[]) == UNFIT
    assert status("joint_names", value=["a"] * 6) == UNFIT


def test_tables_have_the_limits_that_commands_keep(tmp_path: Path) -> None:
    """Those of the scheme, which may be narrower than the robot's."""
    controller, q0 = drawing(with_limits(AccelerationLimits(1.0)))
    controller.warm_up(q0)
    tables = json.loads(export.tables(controller, tmp_path / "arm.json").read_text())
    assert tables["limits"]["acceleration"] == [1.0] * 7
    assert tables["limits"]["velocity"] == controller.robot.dq_max.tolist()


FUZZ = Path(__file__).parents[1] / "core_fuzz.c"


def test_mutated_tables_and_hostile_steps_stay_within_memory(tmp_path: Path) -> None:
    """Three arms, two of one kind, in one program."""
    export.c99(make_shield(), tmp_path, START, name="left")
    controller, q0 = drawing(with_limits(CollisionAvoidance(), AccelerationLimits(1.0)))
    export.c99(controller, tmp_path, q0, name="right")
    sources = [FUZZ, *(tmp_path / f"{name}.c" for name in ("left", "right", "armstep"))]
    program = tmp_path / "fuzz"
    run("gcc", *WARNINGS, *SANITIZED, f"-I{tmp_path}", *sources, "-o", program, "-lm")
    assert " of 3000 fit" in run(program, "3000", "2000")


@pytest.mark.parametrize(
    "own",
    [
        {"kind": 7},
        {"kind": -3},
        {"elapsed": np.nan},
        {"dt": np.nan},
        {"dt": -1.0},
        {"elapsed": 1.0},
        {"dt": 5e-324},
        {"dt": 1e300},
    ],
)
def test_a_refused_step_takes_the_next_command_of_the_motion_to_rest(
    own: dict[str, Any], text: str, library: Any
) -> None:
    robot = make_shield().robot
    arm = Arm(text, library)
    arm.begin()
    commands = [np.zeros(7)] * 2
    refused = 0
    for k in range(700):
        q = np.array(arm.call("next_q")[:7]) if k else START
        wrong = own if 100 <= k < 105 or k >= 300 else {}
        result, dq = arm.step(q, **{"kind": 1, "request": np.full(7, 0.3), **wrong})
        refused += result in (Reason.UNKNOWN_KIND, Reason.PERIOD_REFUSED)
        commands.append(dq)
    rates = np.diff(commands, axis=0) / 1e-3
    assert refused == 405
    assert np.abs(commands[:300]).max() > 0.1
    assert not commands[-1].any()
    assert (np.abs(rates) <= robot.ddq_max * (1 + 1e-9)).all()
    assert (np.abs(np.diff(rates, axis=0)) <= 1e-3 * robot.dddq_max * (1 + 1e-6)).all()


def test_a_controller_that_cannot_see_brakes(tracking_text: str, library: Any) -> None:
    arm = Arm(tracking_text, library)
    arm.begin()
    q = np.array(drawing()[1])
    commands = []
    for k in range(900):
        seen = q if k < 300 else np.full(7, np.nan)
        result, dq = arm.step(seen, t=1e-3 * k)
        assert (result == INVALID) == (k >= 300)
        commands.append(dq)
        q = q + 1e-3 * dq
    rates = np.diff(commands[299:], axis=0) / 1e-3
    assert np.abs(commands[299]).max() > 5e-3
    assert not commands[-1].any()
    assert np.abs(rates).max() <= 1.0 + 1e-9
    assert np.abs(np.diff(rates, axis=0)).max() <= 1e-3 * 50.0 * (1 + 1e-6)


def test_targets_that_are_no_numbers_are_refused_and_forgotten(
    tmp_path: Path, library: Any
) -> None:
    """Without acceleration limits it stops at once."""
    controller, q0 = drawing()
    text = export.tables(controller, tmp_path / "arm.json", q0=q0).read_text(encoding="utf-8")
    arm, other = Arm(text, library), Arm(text, library)
    arm.begin()
    other.begin()
    start = np.array(q0)
    target = controller.targets(0.0).ravel()
    for k in range(20):
        wrong_q, wrong = start.copy(), target.copy()
        (wrong_q if k % 2 else wrong)[k % 7] = (np.nan, np.inf, -np.inf)[k % 3]
        result, dq = arm.step(wrong_q, request=wrong)
        assert result == INVALID
        assert not dq.any()
        expected = other.step(start, request=target)[1]
        np.testing.assert_array_equal(arm.step(start, request=target)[1], expected)


def test_memory_of_others_is_refused(text: str, tracking_text: str, library: Any) -> None:
    arm, other = Arm(text, library), Arm(tracking_text, library)
    assert arm.step(START, 1, np.ones(7))[0] == INVALID  # not begun
    assert not arm.memory.any()
    assert arm.call("halt") == arm.call("rest", arm.scratch, None) == OTHER_TABLES
    arm.begin()
    other.begin()
    arm.step(START, 1, np.ones(7))
    saved = np.zeros(arm.memory.size + 2)
    assert arm.call("save", saved) == OK
    expected = arm.step(START, 1, np.ones(7))[1]
    assert arm.call("restore", saved) == OK
    assert arm.step(START, 1, np.ones(7))[1].tobytes() == expected.tobytes()
    bent = saved.copy()
    bent[40] = np.nextafter(bent[40], np.inf)
    assert arm.call("restore", bent) == DAMAGED
    bent[0] = other.memory[0]
    assert arm.call("restore", bent) == OTHER_TABLES
    arm.memory[0] = other.memory[0]
    result, dq = arm.step(START, 1, np.ones(7))
    assert result == INVALID
    assert not dq.any()
    assert other.call("people", np.zeros(7), 1, ctypes.c_double(0.0)) == WRONG_KIND


def big(step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector) -> None:
    """Take much scratch where the arm is away from its start."""
    if step.q[0] > constants[0]:
        table = np.zeros((300, 300))
        h[0] = 5.0 + table[36, 36]
    ub[3] = min(ub[3], constants[1])


class Big(Limit):
    """Limit whose kernel takes more than the scratch."""

    kernel = staticmethod(big)
    rows = 1

    def constants(self, robot: Robot) -> Vector:
        return np.array([START[0] + 1e-3, 0.5])


def test_an_own_kernel_beyond_the_scratch_is_refused_within_memory(tmp_path: Path) -> None:
    controller, q0 = drawing(with_limits(Big(), AccelerationLimits(1.0)))
    controller.anchor(Configuration(controller.robot, q0))
    export.c99(controller, tmp_path, q0, name="big")
    with pytest.raises(InvalidInputError, match="name: must be small letters"):
        export.tables(controller, tmp_path / "Big one.json")
    (tmp_path / "compare.c").unlink()
    run("make", "example", f"CFLAGS={' '.join(SANITIZED)}", f"LDFLAGS={SANITIZED[1]}", cwd=tmp_path)
    said = run(tmp_path / "example")
    assert "action -1" in said
    last = float(said.split("q[0] = ")[1].split()[0])
    assert START[0] + 1e-3 < last < START[0] + 5e-3  # where it comes to rest


def test_fast_math_does_not_compile(tmp_path: Path) -> None:
    (tmp_path / "armstep.h").write_text(core().header, encoding="utf-8")
    (tmp_path / "armstep.c").write_text(core().code, encoding="utf-8")
    for flag in ("-ffast-math", "-Ofast", "-ffinite-math-only"):
        command = ["gcc", flag, "-fsyntax-only", tmp_path / "armstep.c"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert "infinities and NaN are needed" in done.stderr


def test_the_digest_is_fnv_1a(text: str, library: Any) -> None:
    own = json.loads(text)
    digest = 0xCBF29CE484222325
    words = [struct.pack("<d", float(each)) for each in flat(own["numbers"])]
    for each in flat(own["integers"]):
        letters = each.encode() if isinstance(each, str) else [each]
        words += [struct.pack("<q", letter) for letter in letters]
    for letter in b"".join(words):
        digest = (digest ^ letter) * 0x100000001B3 % 2**64
    assert f"{digest:016x}" == own["digest"]
    assert Arm(text, library).memory.size == own["memory"] == STATE + own["memory"] - 1


def test_plans_of_the_desk_fit_and_bent_ones_do_not() -> None:
    shield = make_shield()
    plan = shield.layout(shield.robot.tip).plan
    collisions = enter_limit.address(CollisionAvoidance.kernel)
    assert Entry.functions[collisions].__name__ == "collision_rows"
    assert fitting.arm_fits(plan, collisions, -1, -1)
    arrays = plan.step.arrays
    for row, column, value in ((0, 3, 1), (1, 4, 500), (1, 6, 10**6), (1, 7, 1), (2, 5, -1)):
        table = arrays.table.copy()
        table[row, column] = value
        bent = plan.step._replace(arrays=arrays._replace(table=table))
        assert not fitting.arm_fits(plan._replace(step=bent), collisions, -1, -1) or (
            row,
            column,
        ) == (
            0,
            3,
        )
    for name in ("frames", "parents", "carriers"):
        robot = plan.robot._replace(**{name: getattr(plan.robot, name) + 50})
        assert not fitting.arm_fits(plan._replace(robot=robot), collisions, -1, -1)
    for name in plan.sizes._fields:
        sizes = plan.sizes._replace(**{name: getattr(plan.sizes, name) + 1001})
        assert not fitting.arm_fits(plan._replace(sizes=sizes), collisions, -1, -1), name
    assert not fitting.arm_fits(plan._replace(request=1), collisions, -1, -1)
    assert not fitting.arm_fits(plan._replace(scene=0), collisions, -1, -1)
