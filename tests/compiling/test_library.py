"""The package's library: functions entered by address, and the bits of whole steps."""

import ctypes
import traceback
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numba
import numpy as np
import pytest

import iiwa_dnn
from helpers_kinematics import PAPER_Q0
from helpers_physics import run_python
from helpers_simulation import heart, paper_robot
from iiwa_dnn.compiling.library import _LIBRARY
from iiwa_dnn.export.folder import run
from iiwa_dnn.networks.integrators.implicit import solve
from iiwa_dnn.references.base import enter_path
from iiwa_dnn.references.shapes import heart_path
from iiwa_dnn.schemes.parts import enter_limit
from iiwa_dnn.step.policies import Action


def _limit(step: Any, constants: Any, G: Any, h: Any, lb: Any, ub: Any) -> None:
    """Keep the first joint's velocity below a number by a row, and the second's by a bound."""
    G[0, 0] = 1.0
    h[0] = constants[0] - step.q[0]
    ub[1] = min(ub[1], constants[1] * step.jacobian[1, 5])


_D, _I = numba.types.float64, numba.types.int64
_P = numba.types.CPointer(_D)


@numba.cfunc(
    numba.void(_D, _D, *3 * (_P, _I), *5 * (_P, _I, _I), *7 * (_P, _I), _P, _I, _I, *3 * (_P, _I))
)
def _flat(
    t, rate, q, n, last, n1, before, n2, jacobian, n3, six, placements, frames, twelve,
    support, m1, m2, inertia, i1, i2, targets, k, eighteen, least, pairs,
    lower_kind, n4, upper_kind, n5, row_pair, m3, velocity, n6, acceleration, n7, constants, count,
    G, rows, width, h, h1, lb, l1, ub, u1,
):  # fmt: skip
    G[0] = 1.0
    h[0] = constants[0] - q[0]
    ub[1] = min(ub[1], constants[1] * jacobian[6 + 5])


class Own(iiwa_dnn.Limit):
    """The limit by a function."""

    rows = 1

    def __init__(self, kernel: Any) -> None:
        self.kernel = kernel

    def constants(self, robot: iiwa_dnn.Robot) -> np.ndarray:
        return np.array([0.7, 0.3])


def _commands(limit: iiwa_dnn.Limit, steps: int = 20) -> np.ndarray:
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=[limit])
    controller = iiwa_dnn.Controller(paper_robot(), scheme, heart(), dt=1e-3)
    return run(controller, np.array(PAPER_Q0), steps)[:, -8:-1]


class Numpy(iiwa_dnn.Limit):
    """The limit by methods in numpy."""

    rows = 1

    def inequalities(self, step: iiwa_dnn.Step) -> tuple[np.ndarray, np.ndarray]:
        return np.eye(1, 7), np.array([0.7 - step.q[0]])

    def bounds(self, step: iiwa_dnn.Step) -> tuple[np.ndarray, np.ndarray]:
        upper = np.full(7, np.inf)
        upper[1] = 0.3 * step.frame().jacobian[5, 1]
        return np.full(7, -np.inf), upper


def test_a_function_of_ones_own_enters_in_any_form() -> None:
    expected = _commands(Numpy())
    pointer = ctypes.cast(_flat.address, ctypes.CFUNCTYPE(None))
    for kernel in (_limit, _flat, _flat.address, pointer):
        np.testing.assert_array_equal(_commands(Own(kernel)), expected)


def test_an_error_in_ones_own_function_comes_with_its_traceback() -> None:
    def fails(step: Any, constants: Any, G: Any, h: Any, lb: Any, ub: Any) -> None:
        raise ValueError("out of reach")

    with pytest.raises(ValueError, match="out of reach") as caught:
        _commands(Own(fails))
    names = [frame.name for frame in traceback.extract_tb(caught.value.__traceback__)]
    assert names[-1] == "fails"
    assert "step" in names
    assert len(_commands(Own(_limit), 2)) == 2  # and nothing of it stays


@pytest.mark.parametrize("wrong", [heart_path, solve, 1.5, None, 0, -1])
def test_what_has_other_types_is_refused(wrong: object) -> None:
    with pytest.raises(TypeError):
        enter_limit.address(wrong)


def test_kernels_that_can_be_entered_are_numbered_and_others_are_not() -> None:
    numbers = [own for own in _LIBRARY.numbers.values() if own]
    assert sorted(numbers) == [*range(1, 1 + len(numbers))]
    own = _LIBRARY.numbers["references_shapes_heart_path"]
    assert enter_path.address(iiwa_dnn.Heart.path) == own
    assert _LIBRARY.numbers["networks_integrators_implicit_solve"]
    assert not _LIBRARY.numbers["step_cycle_take_step"]


def test_a_path_is_entered_from_python_and_by_two_threads() -> None:
    path = iiwa_dnn.Heart()
    expected = path.at(3.0).data
    found: list[np.ndarray] = []

    def enter() -> None:
        for _ in range(1000):
            target = np.array(path.base)
            enter_path(enter_path.address(path.path), 3.0, path.constants, target)
            found.append(target)

    with ThreadPoolExecutor() as pool:
        for _ in range(2):
            pool.submit(enter)
    assert len(found) == 2000
    assert all(target.tobytes() == expected.tobytes() for target in found)


RUNS = """
import sys; sys.path.insert(0, "tests")
from export_settings import SETTINGS
from iiwa_dnn.compiling.library import INTERPRETED
from iiwa_dnn.export.folder import run
from iiwa_dnn.step.policies import Action
assert INTERPRETED == FLAG
for name, make in SETTINGS.items():
    for row in run(*make(), 720):
        print(name, *row.tolist())
"""


@pytest.mark.long
def test_whole_steps_have_the_same_bits_interpreted() -> None:
    results = []
    for flag in ("0", "1"):
        done = run_python(RUNS.replace("FLAG", flag), IIWA_DNN_INTERPRETED=flag)
        assert done.returncode == 0, done.stderr
        results.append(done.stdout.splitlines())
    assert results[0] == results[1]
    actions = {float(line.split()[-1]) for line in results[0]}
    assert actions == {Action.NONE, Action.SLOW, Action.RELAX, Action.STOP}
