"""Arguments: rotations that were rounded, and arrays that hide some of their numbers."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import iiwa_dnn as d

TURNS = Rotation.random(50, random_state=1).as_matrix()


@pytest.mark.parametrize("digits", [3, 4, 6, 8])
def test_a_rounded_rotation_is_taken_as_the_nearest_one(digits: int) -> None:
    for turn in TURNS:
        rounded = turn.round(digits)
        found = d.Target([0.4, 0.0, 0.4], rounded).rotation
        np.testing.assert_allclose(found @ found.T, np.eye(3), atol=1e-15)
        # scipy's is nearest in another norm, so they differ by the rounding's square.
        expected = Rotation.from_matrix(rounded).as_matrix()
        np.testing.assert_allclose(found, expected, atol=2.0 * 10.0 ** (-2 * digits) + 1e-15)
        # The nearest one: no small turn brings it nearer.
        for axis in np.eye(3):
            for angle in (-1e-2 * 10.0**-digits, 1e-2 * 10.0**-digits):
                other = Rotation.from_rotvec(angle * axis).as_matrix() @ found
                assert np.linalg.norm(other - rounded) > np.linalg.norm(found - rounded) - 1e-16


def test_a_rotation_keeps_its_bits() -> None:
    for turn in TURNS:
        np.testing.assert_array_equal(d.Target([0.4, 0.0, 0.4], turn).rotation, turn)


@pytest.mark.parametrize(
    ("matrix", "found"),
    [
        (1.005 * np.eye(3), "off the identity by 0.01, the determinant is 1"),
        (np.diag([1.0, 1.0, -1.0]), "off the identity by 0, the determinant is -1"),
        (TURNS[0].round(2), "off the identity by 0.0"),
        (np.zeros((3, 3)), "off the identity by 1, the determinant is 0"),
    ],
)
def test_what_is_far_from_a_rotation_is_refused_with_its_distance(matrix, found: str) -> None:
    with pytest.raises(d.InvalidInputError, match=f"^rotation: is not a rotation matrix.*{found}"):
        d.Target([0.4, 0.0, 0.4], matrix)


HIDDEN = np.ma.array([1.0, 0.0, 0.0], mask=[False, True, False])
ARM = d.robot_from_dh(np.full((3, 4), 0.3))

MASKED = {
    "a vector": (lambda: d.Configuration(ARM, HIDDEN), "q"),
    "an element": (lambda: d.Configuration(ARM, [0.0, np.ma.masked, 0.0]), "q"),
    "limits": (lambda: ARM.with_limits(velocity=HIDDEN), "velocity"),
    "a row of a rotation": (lambda: d.Target(HIDDEN.data, [HIDDEN, *np.eye(3)[1:]]), "rotation"),
    "a row of a table": (lambda: d.robot_from_dh([np.ma.masked_equal([0, 0, 1, 0], 1)]), "table"),
    "points": (lambda: d.Waypoints([0, 1, 2], [*np.eye(3)[:2], HIDDEN]), "points"),
    "a program": (lambda: d.QP(np.eye(3), HIDDEN), "q"),
    "rows of a program": (lambda: d.QP([HIDDEN, *np.eye(3)[1:]], np.zeros(3)), "P"),
}


@pytest.mark.parametrize(("call", "named"), MASKED.values(), ids=MASKED.keys())
def test_masked_numbers_are_refused(call: Callable[[], object], named: str) -> None:
    with pytest.raises(d.InvalidInputError, match="masked") as caught:
        call()
    assert caught.value.argument == named


def test_an_array_that_hides_nothing_is_taken() -> None:
    shown = np.ma.array([1.0, 2.0, 3.0], mask=False)
    np.testing.assert_array_equal(d.Configuration(ARM, shown).q, [1.0, 2.0, 3.0])
    assert d.QP(np.eye(3), shown).q.tolist() == [1.0, 2.0, 3.0]
