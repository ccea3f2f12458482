"""A controller as a package of its own: halt, sent commands, a new start, copies, refusals.

That its steps have Python's bits is in test_export.py.
"""

import copy
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from export_settings import drawing, with_limits
from helpers_export import QUICK, needs, packaged
from iiwa_dnn import AccelerationLimits, Configuration, Target
from iiwa_dnn.export.folder import take_exported_kinematics

pytestmark = needs("gcc")

SMOOTH = with_limits(AccelerationLimits(1.0))


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    controller, q0 = drawing(SMOOTH)
    return packaged(controller, tmp_path_factory.mktemp("project"), "a_drawing", q0, QUICK)


def steps(controller: Any, q: np.ndarray, first: int, count: int) -> list[np.ndarray]:
    """Take steps of an arm that follows; return the commands."""
    found = []
    for k in range(first, first + count):
        command = controller.step(q, k * 1e-3)
        found.append(command.dq)
        q = command.next_q
    return found


def test_halt_send_and_reset_are_pythons(package: Any) -> None:
    here, q0 = drawing(SMOOTH)
    here.anchor(Configuration(here.robot, q0))
    take_exported_kinematics(here)
    there = package.Controller()
    runs = []
    for made in (here, there):
        q = np.array(q0)
        run = steps(made, q, 0, 300)
        q = q + 1e-3 * np.sum(run, axis=0)
        for fraction in (1.0, 0.25):
            made.send(0.9 * run[-1], fraction)
            q = q + 0.9e-3 * run[-1]
        run += steps(made, q, 302, 100)
        assert made.path_lag >= 0.75e-3
        made.halt()
        run += steps(made, q + 1e-3 * np.sum(run[300:], axis=0), 402, 400)
        runs.append(run)
    np.testing.assert_array_equal(*runs)
    assert np.abs(runs[0][399]).max() > 1e-3
    assert not runs[0][-1].any()
    there.reset()
    np.testing.assert_array_equal(steps(there, q0, 0, 50), runs[1][:50])


def test_targets_may_be_arguments(package: Any) -> None:
    here, q0 = drawing(SMOOTH)
    here.anchor(Configuration(here.robot, q0))
    take_exported_kinematics(here)
    there = package.Controller()
    pose = Configuration(here.robot, q0)
    place = pose.position + 0.01
    for k in range(50):
        target = package.make_target(place, pose.rotation, (0.0, 0.0, 0.01))
        wanted = Target(place, pose.rotation, (0.0, 0.0, 0.01))
        assert target.tobytes() == wanted.data.tobytes()
        command = here.step(q0, k * 1e-3, wanted)
        assert there.step(q0, k * 1e-3, target).dq.tobytes() == command.dq.tobytes()


def test_copies_and_pickles_carry_the_state(package: Any) -> None:
    controller = package.Controller()
    q = drawing(SMOOTH)[1]
    steps(controller, q, 0, 50)
    others = [copy.copy(controller), copy.deepcopy(controller)]
    others.append(pickle.loads(pickle.dumps(controller)))
    expected = steps(controller, q, 50, 50)
    for other in others:
        np.testing.assert_array_equal(steps(other, q, 50, 50), expected)


@pytest.mark.parametrize(
    "wrong",
    [
        {"q": np.zeros(6)},
        {"q": np.full(7, np.nan)},
        {"t": np.inf},
        {"target": np.zeros(17)},
        {"target": np.full(18, np.nan)},
    ],
)
def test_wrong_input_is_an_error_and_changes_nothing(package: Any, wrong: dict[str, Any]) -> None:
    controller = package.Controller()
    q = drawing(SMOOTH)[1]
    steps(controller, q, 0, 5)
    before = pickle.dumps(controller)
    with pytest.raises(ValueError, match="must be"):
        controller.step(**{"q": q, "t": 0.005, **wrong})
    with pytest.raises(ValueError, match="must be"):
        controller.send(np.zeros(7), -1.0)
    assert pickle.dumps(controller) == before


def test_it_runs_its_own_vectors(package: Any) -> None:
    project = Path(package.__file__).parents[1]
    command = [sys.executable, "-m", "a_drawing"]
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=True)
    assert "500 steps, 0 differ" in done.stdout
    assert package.Action.SLOW == 2
    assert (drawing()[0].robot.tip,) == package.FRAMES
