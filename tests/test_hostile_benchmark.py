"""The judges of benchmarks/hostile find each break that is planted, and agree with other judges."""

from pathlib import Path
from typing import Any

import coal
import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn
from benchmarks.hostile import contenders
from benchmarks.hostile.__main__ import main
from benchmarks.hostile.arms import FOLDER, Arm, urdf
from benchmarks.hostile.contenders import ADAPTERS, Contender, drive, setup_of
from benchmarks.hostile.families import FAMILIES, smooth
from benchmarks.hostile.judges import Run, judge

ARMS = sorted(file.stem for file in FOLDER.glob("*.json"))
DT = 2e-3
STEPS = 400


def admissible(arm: Arm) -> Run:
    """Return a run that breaks nothing, and follows what is desired."""
    at = smooth(arm, np.random.default_rng(3))
    desired = np.array([at(DT * k) for k in range(STEPS + 1)])
    dq = np.diff(desired, axis=0) / DT
    far = np.full((STEPS + 1, 1, 3), 9.0)
    periods, seconds = np.full(STEPS, DT), np.full(STEPS, 1e-5)
    return Run(desired, dq, dq, desired, periods, far, np.array([0.1]), seconds, "")


def integrated(run: Run, dq: Any) -> Run:
    q = run.q[0] + np.vstack([np.zeros(dq.shape[1]), np.cumsum(DT * dq, axis=0)])
    return run._replace(q=q, dq=dq)


def spiked(run: Run, arm: Arm, row: int, part: float) -> Run:
    """Add to a velocity in the middle what breaks row `row` of the limits by a part."""
    dq = run.dq.copy()
    size = arm.limits[row] * DT ** (row - 2) * part
    dq[STEPS // 2] = (dq[STEPS // 2 - 1] if row > 2 else 0.0) + size
    return integrated(run, dq)


def beside(run: Run, arm: Arm, gap: float) -> Run:
    """Put a sphere so near to the tip's last capsule at one step."""
    centers = run.centers.copy()
    q = run.q[STEPS // 2][np.newaxis]
    at = arm.tip(q)[0]
    for _ in range(60):  # the distance falls as the sphere comes nearer
        way = arm.distances(q, at[None, None], run.radii).min() - gap
        at = at - way * np.array([0.0, 0.0, -1.0])
    centers[STEPS // 2] = at
    return run._replace(centers=centers)


def between(run: Run, arm: Arm) -> Run:
    """Let a sphere pass the arm between two steps, no nearer at either than it has to be."""
    near = beside(run, arm, 0.015).centers[STEPS // 2, 0]
    centers = run.centers.copy()
    centers[STEPS // 2 : STEPS // 2 + 2, 0] = near + np.outer([-0.2, 0.2], [1.0, 0.0, 0.0])
    return run._replace(centers=centers)


BREAKS: dict[str, Any] = {
    "velocity": lambda run, arm: spiked(run, arm, 2, 1.001),
    "acceleration": lambda run, arm: spiked(run, arm, 3, 1.01),
    "jerk": lambda run, arm: spiked(run, arm, 4, 1.5),
    "position": lambda run, arm: run._replace(q=run.q + 1e-3 + (arm.limits[1] - run.q.max(axis=0))),
    "lower position": lambda run, arm: run._replace(
        q=run.q - 1e-3 + (arm.limits[0] - run.q.min(axis=0))
    ),
    "distance": lambda run, arm: beside(run, arm, 0.018),
    "a moment's distance": between,
    "contact": lambda run, arm: beside(run, arm, -0.001),
    "torque": lambda run, arm: integrated(
        run, run.dq * np.where(np.arange(STEPS) == 200, 40, 1)[:, None]
    ),
    "unasked motion": lambda run, arm: run._replace(
        wanted=np.where(np.arange(STEPS)[:, None] < 50, run.wanted, np.nan)
    ),
}
"""Breaks of what is promised, by the last words of their names."""

FLAWS: dict[str, tuple[Any, str, float]] = {
    "late": (lambda run: run._replace(q=np.vstack([run.q[:1]] * 20 + [run.q[:-20]])), "lag", 40.0),
    "flat": (lambda run: run._replace(q=run.q[0] + 0.8 * (run.q - run.q[0])), "amplitude", 0.8),
    "elsewhere": (lambda run: run._replace(q=run.q + 0.01), "error", 10.0),
    "frozen": (lambda run: integrated(run, 0.0 * run.dq), "frozen", 1.0),
    "slow": (lambda run: run._replace(seconds=100.0 * run.seconds), "p50", 1e3),
    "slow at times": (
        lambda run: run._replace(seconds=run.seconds * (1 + 9 * (np.arange(STEPS) % 20 == 7))),
        "p99",
        100.0,
    ),
}
"""What is promised nowhere: how a run becomes so, the score that says it, and its value."""


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("planted", BREAKS)
def test_a_planted_break_is_found_and_nothing_without_one(name: str, planted: str) -> None:
    arm = Arm(name)
    clean = admissible(arm)
    has_person, has_payload = planted == "contact", planted == "torque"
    before = judge(arm, clean, has_person, 0.0)
    after = judge(arm, BREAKS[planted](clean, arm), has_person, 0.0)
    assert before.broken(has_person, has_payload) == []
    assert planted.endswith(tuple(after.broken(has_person, has_payload)))


@pytest.mark.parametrize("flaw", FLAWS)
def test_a_flaw_is_seen_in_its_score(flaw: str) -> None:
    arm = Arm(ARMS[0])
    clean = admissible(arm)
    make, score, value = FLAWS[flaw]
    before, after = (judge(arm, run, False, 0.0) for run in (clean, make(clean)))
    assert after.broken(False, False) == []
    assert getattr(after, score) == pytest.approx(value, rel=0.03)
    assert abs(before.lag) < 0.1
    assert before.amplitude == pytest.approx(1.0, abs=1e-9)
    assert before.error < 1e-9
    assert before.frozen < 0.1


@pytest.mark.parametrize("name", ARMS)
def test_kinematics_torques_and_distances_are_those_of_pinocchio_and_coal(name: str) -> None:
    arm = Arm(name)
    q, dq, ddq = np.random.default_rng(0).standard_normal((3, 5, arm.dof))
    for payload in (0.0, 2.0):
        model = pin.buildModelFromXML(urdf(arm.data))
        point = pin.Inertia(payload, np.array(arm.data["tip"]), np.zeros((3, 3)))
        model.inertias[arm.dof] = (
            model.inertias[arm.dof] + point if payload else model.inertias[arm.dof]
        )
        data = model.createData()
        expected = [pin.rnea(model, data, *each) for each in zip(q, dq, ddq, strict=True)]
        np.testing.assert_allclose(arm.torques(q, dq, ddq, payload), expected, atol=1e-10)
    robot = iiwa_dnn.load_robot(name)
    places = [iiwa_dnn.Configuration(robot, each).position for each in q]
    np.testing.assert_allclose(arm.tip(q), places, atol=1e-12)
    center = np.array([0.4, 0.2, 0.5])
    found = arm.distances(q, np.tile(center, (len(q), 1, 1)), np.array([0.07]))
    at = arm.places(q)
    for c, capsule in enumerate(arm.data["capsules"]):
        a, b = np.array(capsule["a"]), np.array(capsule["b"])
        length = np.linalg.norm(b - a)
        turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), b - a).matrix()
        shape = (
            coal.Capsule(capsule["radius"], length)
            if length > 1e-9
            else coal.Sphere(capsule["radius"])
        )
        for k in range(len(q)):
            R, p = at.rotations[capsule["joint"]][k], at.origins[capsule["joint"]][k]
            place = coal.Transform3s(R @ turn, p + R @ (0.5 * (a + b)))
            result = coal.DistanceResult()
            ball = coal.Transform3s(np.eye(3), center)
            coal.distance(shape, place, coal.Sphere(0.07), ball, coal.DistanceRequest(), result)
            if result.min_distance > 0.0:
                assert found[k, c, 0] == pytest.approx(result.min_distance, abs=1e-6)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ("1 / 0", "ZeroDivisionError"),
        ("time.sleep(9.0)", "no answer in 1 s"),
        ("np.full(7, np.nan)", "is no velocity of 7 joints"),
        ("np.zeros(6)", "is no velocity of 7 joints"),
    ],
)
def test_a_filter_of_ones_own_is_added_in_ten_lines_and_its_end_is_told(
    answer: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "import time\n"
        "import numpy as np\n"
        "from benchmarks.hostile.serve import serve\n"
        "def make(setup):\n"
        "    def act(state, request, dt):\n"
        "        return np.zeros(7) if state['t'] < 0.1 else " + answer + "\n"
        "    return act\n"
        "serve(make)\n",
        encoding="utf-8",
    )
    contender = Contender(file)
    contender.tell(setup_of(Arm("iiwa7"), DT, np.zeros((0, 3)), np.zeros(0)))
    monkeypatch.setattr(contenders, "PATIENCE", 1.0)
    run = drive(contender, Arm("iiwa7"), FAMILIES["jumps"], 0, 100)
    contender.close()
    assert words in run.problem
    assert judge(Arm("iiwa7"), run, False, 0.0).broken(False, False) == ["no answer"]


def test_what_cannot_begin_and_how_a_failure_is_played_again_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "none.py"
    file.write_text("x = 1\n", encoding="utf-8")
    about = ["--families", "jumps", "--arms", "iiwa7", "--seeds", "3", "--steps", "40"]
    monkeypatch.setattr("sys.argv", ["hostile", str(file), "clamp", *about])
    assert main() == 1
    said = capsys.readouterr().err
    assert "none could not begin: it ended without an answer" in said
    assert "clamp --families 'jumps' --arms iiwa7 --seeds 3 --steps 40" in said


def test_the_clamp_breaks_rates_and_the_shield_nothing() -> None:
    arm = Arm("iiwa7")
    for name, broken in (("clamp", {"acceleration", "jerk"}), ("shield", set())):
        contender = Contender(ADAPTERS / f"{name}.py")
        for family in ("broken", "jitter", "late arm", "silence"):
            steps = 900 if family == "silence" else 200
            run = drive(contender, arm, FAMILIES[family], 1, steps)
            assert set(judge(arm, run, False, 0.0).broken(False, False)) == broken, (name, family)
        contender.close()
