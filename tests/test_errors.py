"""The package's errors: one tree, each with its evidence, wherever it is raised."""

import copy
import pickle
from collections.abc import Callable

import pytest

import iiwa_dnn as d
from iiwa_dnn.errors import MissingDependencyError

ERRORS = (
    d.InvalidInputError("gain", "must be above 0", -1.0),
    d.NotFoundError("robot", "iiwa8", ("iiwa7", "panda")),
    d.FileError("run/record.npz", "no such file"),
    d.NoSolutionError("step 3 has no solution"),
    MissingDependencyError("mujoco", "pip install 'iiwa-dnn[sim]'"),
)


@pytest.mark.parametrize("again", [lambda e: pickle.loads(pickle.dumps(e)), copy.copy])
@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_an_error_survives_another_process(
    error: d.IiwaDnnError, again: Callable[[d.IiwaDnnError], d.IiwaDnnError]
) -> None:
    other = again(error)
    assert type(other) is type(error)
    assert str(other) == str(error)
    assert vars(other) == vars(error)
