"""Controllers of armstep: halt, sent commands, a new start, copies, refusals, many at once.

That steps have Python's bits is in tests/export/test_export.py.
"""

import copy
import functools
import pickle
from typing import Any

import armstep
import numpy as np
import pytest

from export_settings import drawing, with_limits
from iiwa_dnn import AccelerationLimits, Configuration, Target, export
from iiwa_dnn.export.folder import take_exported_kinematics

SMOOTH = with_limits(AccelerationLimits(1.0))


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> armstep.Tables:
    controller, q0 = drawing(SMOOTH)
    path = tmp_path_factory.mktemp("tables") / "a_drawing.json"
    return armstep.load_tables(export.tables(controller, path, q0=q0))


@pytest.fixture(scope="module")
def make(tables: armstep.Tables) -> Any:
    return functools.partial(armstep.Controller, tables)


def steps(controller: Any, q: np.ndarray, first: int, count: int) -> list[np.ndarray]:
    """Take steps of an arm that follows; return the commands."""
    found = []
    for k in range(first, first + count):
        command = controller.step(q, k * 1e-3)
        found.append(command.dq)
        q = command.next_q
    return found


def test_halt_send_and_reset_are_pythons(make: Any) -> None:
    here, q0 = drawing(SMOOTH)
    here.anchor(Configuration(here.robot, q0))
    take_exported_kinematics(here)
    there = make()
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


def test_targets_may_be_arguments(make: Any) -> None:
    here, q0 = drawing(SMOOTH)
    here.anchor(Configuration(here.robot, q0))
    take_exported_kinematics(here)
    there = make()
    pose = Configuration(here.robot, q0)
    place = pose.position + 0.01
    for k in range(50):
        target = armstep.make_target(place, pose.rotation, (0.0, 0.0, 0.01))
        wanted = Target(place, pose.rotation, (0.0, 0.0, 0.01))
        assert target.tobytes() == wanted.data.tobytes()
        command = here.step(q0, k * 1e-3, wanted)
        assert there.step(q0, k * 1e-3, target).dq.tobytes() == command.dq.tobytes()


def test_copies_and_pickles_carry_the_state(make: Any) -> None:
    controller = make()
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
def test_wrong_input_is_an_error_and_changes_nothing(make: Any, wrong: dict[str, Any]) -> None:
    controller = make()
    q = drawing(SMOOTH)[1]
    steps(controller, q, 0, 5)
    before = controller.save().tobytes()
    with pytest.raises(ValueError, match="must be"):
        controller.step(**{"q": q, "t": 0.005, **wrong})
    with pytest.raises(ValueError, match="must be"):
        controller.send(np.zeros(7), -1.0)
    assert controller.save().tobytes() == before


def test_many_are_answered_as_each_alone(tables: armstep.Tables) -> None:
    many, alone = armstep.Controllers(tables, 70, threads=2), armstep.Controller(tables)
    q = drawing()[1]
    for k in range(60):
        given = {} if k % 2 else {"target": alone.targets(k * 1e-3)}
        command = alone.step(q, k * 1e-3, **given)
        tiled = {name: np.tile(value, (70, 1, 1)) for name, value in given.items()}
        found = many.step(np.tile(q, (70, 1)), k * 1e-3, **tiled)
        assert found.dq.tobytes() == 70 * command.dq.tobytes()
        assert found.next_q.tobytes() == 70 * command.next_q.tobytes()
        assert (found.reason == command.action).all()
        assert found.active_limits(69) == command.active_limits
        q = command.next_q
    many.halt(np.arange(70) < 35)
    for k in range(60, 90):
        expected = alone.step(q, k * 1e-3)
        found = many.step(np.tile(q, (70, 1)), k * 1e-3)
        assert found.dq[69].tobytes() == expected.dq.tobytes()
        q = expected.next_q
    assert np.abs(found.dq[0]).max() < np.abs(found.dq[69]).max()


def test_it_says_what_it_is(tables: armstep.Tables, make: Any) -> None:
    assert tables.frame_names == (drawing()[0].robot.tip,)
    controller = make()
    command = controller.step(drawing()[1], 0.0)
    assert (command.ok, command.action) == (True, armstep.Action.NONE)
    assert (command.program, command.fraction) == (armstep.Program.NOMINAL, 1.0)
    assert controller.path_lag == 0.0
    with pytest.raises(armstep.TablesError, match="has tables of a controller, not of a shield"):
        armstep.Shield(tables)


def test_without_a_reference_each_step_needs_a_target(tmp_path: Any) -> None:
    made, q0 = drawing()
    made.reference = None
    controller = armstep.Controller(export.tables(made, tmp_path / "free.json", q0=q0))
    with pytest.raises(armstep.InputError, match="there is no reference"):
        controller.step(q0, 0.0)
    with pytest.raises(armstep.InputError, match="there is no reference"):
        controller.targets(0.0)
