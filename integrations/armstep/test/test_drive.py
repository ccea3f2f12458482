"""Joint states of arms beside their commands, without ROS."""

import numpy as np
import pytest
from armstep.drive import Following, Recent

DT = 4e-3
LIMITS = {"lower": np.array([-np.inf, -2.0]), "upper": np.array([np.inf, 2.0])}
START = np.array([3.0, 0.3])


def wrapped(q: np.ndarray) -> np.ndarray:
    """Return positions as an encoder of the first joint counts them, from -pi to pi."""
    return np.array([(q[0] + np.pi) % (2.0 * np.pi) - np.pi, q[1]])


def test_late_states_beyond_the_seam_of_an_encoder_are_where_the_commands_were() -> None:
    following = Following(LIMITS, 2.0 * DT, 0.1, True)
    following.begin(0.0, START, 0.0 * START)
    path = [START]
    random = np.random.default_rng(0)
    for k in range(1, 500):
        dq = np.array([0.5, np.sin(k)])
        following.command(dq)
        following.advance(k * DT, DT, DT)
        path.append(path[-1] + DT * dq)
        seen = random.integers(0, 20)
        following.see((k - seen) * DT, wrapped(path[max(k - seen - 2, 0)]))
        np.testing.assert_allclose(following.error, 0.0, atol=1e-9)
        turns = following.measured(k * DT) - path[max(k - 2, 0)]
        np.testing.assert_allclose(wrapped(turns), 0.0, atol=1e-9)
    assert path[-1][0] > np.pi


@pytest.mark.parametrize(
    ("noise", "dq", "expected"),
    [
        (2e-5, [0.0, 0.0], [0.0, 0.0]),  # exactly: noise is no motion
        (2e-5, [0.5, 0.0], [0.5, 0.0]),
        (7e-4, [0.0, 0.0], [0.0, 0.0]),  # after the longer time
        (2e-3, [0.0, 0.0], None),
    ],
)
def test_velocity_of_an_arm_that_is_not_commanded(noise: float, dq: list, expected: list) -> None:
    recent = Recent(LIMITS, 0.1)
    random = np.random.default_rng(0)
    for k in range(300):
        q = START + k * DT * np.array(dq) + noise * random.uniform(-1.0, 1.0, 2)
        recent.see(k * DT, wrapped(q))
        assert k * DT >= 0.1 or recent.velocity() is None
    if expected is None:
        assert recent.velocity() is None
    else:
        tolerance = 1e-3 * np.array(np.any(expected))
        np.testing.assert_allclose(recent.velocity(), expected, atol=float(tolerance))


def test_an_arm_that_accelerates_has_no_velocity_to_begin_with() -> None:
    recent = Recent(LIMITS, 0.1)
    for k in range(150):
        recent.see(k * DT, START + 0.5 * (k * DT) ** 2)
    assert recent.velocity() is None
