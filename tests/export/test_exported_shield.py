"""A shield in C: the same commands, to the last bit where the kinematics have no part in them."""

from pathlib import Path

import numpy as np
import pytest

from helpers_export import run
from iiwa_dnn import (
    InvalidInputError,
    Robot,
    Shield,
    Sphere,
    export,
    load_robot,
    robot_from_dh,
)

DT = 1e-3
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
PLAIN = load_robot("iiwa7")
SMOOTH = PLAIN.with_limits(acceleration=10.0, jerk=500.0)
BALL = Sphere([0.36, 0.16, 0.64], 0.05)


@pytest.mark.parametrize("robot", [PLAIN, PLAIN.with_limits(acceleration=10.0), SMOOTH])
@pytest.mark.parametrize(("obstacles", "apart"), [(None, 0.0), ([BALL], 1e-9)])
def test_the_c_of_a_shield_gives_its_commands(
    robot: Robot, obstacles: list[Sphere] | None, apart: float, tmp_path: Path
) -> None:
    """Requests are held, jump, time out, are no numbers; then comes a halt."""
    shield = Shield(robot, DT, obstacles, timeout=0.02)
    export.c99(shield, tmp_path)
    exported = export.load(tmp_path)
    random = np.random.default_rng(0)
    q = START
    request: np.ndarray | None = None
    for k in range(1500):
        if k % 40 == 0:
            request = random.standard_normal(7) * np.exp(random.standard_normal())
        elif k % 120 == 1:
            request = None
        elif k % 250 == 2:
            request = np.full(7, np.nan)
        command = shield.step(q, request)
        found = exported.shield_step(q, request)
        np.testing.assert_allclose(found.dq, command.dq, rtol=0.0, atol=apart)
        assert found.action == command.command.action
        q = q + DT * command.dq
        if k == 700:
            q = q + 0.05  # further than the tracking error
        if k == 1000:
            shield.halt()
            exported.shield_halt()
    assert not found.dq.any()


def test_the_example_asks_the_shield(tmp_path: Path) -> None:
    export.c99(Shield(SMOOTH, DT), tmp_path, START)
    run("make", "example", "CFLAGS=-O0", cwd=tmp_path)
    turned = float(run(tmp_path / "example").split()[2]) - START[0]
    assert turned == pytest.approx(0.1, abs=2e-3)  # 0.1 rad/s for 1 s, less the time to start
    assert "request" in (tmp_path / "README.md").read_text(encoding="utf-8")


def test_a_shield_of_many_joints_stays_within_its_memory(tmp_path: Path) -> None:
    """The velocities of 20 joints were written beyond an array for 18."""
    robot = robot_from_dh([(0.1, 0.0, 0.0, 0.0)] * 20, lower=-2.0, upper=2.0, velocity=1.0)
    shield = Shield(robot.with_limits(acceleration=10.0), DT)
    export.c99(shield, tmp_path)
    exported = export.load(tmp_path)
    q = np.zeros(20)
    for k in range(200):
        request = np.sin(np.arange(20.0) + 0.1 * k)
        command = shield.step(q, request)
        np.testing.assert_array_equal(exported.shield_step(q, request).dq, command.dq)
        q = command.next_q


@pytest.mark.parametrize("settings", [{"longest_period": 2e-3}, {"delay": 0.01}])
def test_what_c_does_not_have_yet_is_refused(settings: dict[str, float], tmp_path: Path) -> None:
    with pytest.raises(
        InvalidInputError, match="controller: with longest_period or delay has no C"
    ):
        export.c99(Shield(SMOOTH, DT, **settings), tmp_path)
