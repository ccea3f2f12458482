"""Joint positions as encoders and callers give them: turns, offsets, noise, wrong places, units."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from judge_limits import breaches

ROBOT = d.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
START = np.array(ROBOT.start_posture())


@pytest.fixture(scope="module")
def endless(tmp_path_factory: pytest.TempPathFactory) -> d.Robot:
    """An arm whose first joint is continuous, its second a slide without limits."""
    text = '<robot name="r"><link name="n0"/><link name="n1"/><link name="n2"/><link name="n3"/>'
    kinds = (("continuous", "0 0 1"), ("prismatic", "0 0 1"), ("revolute", "0 1 0"))
    for i, (kind, axis) in enumerate(kinds):
        text += (
            f'<joint name="j{i}" type="{kind}"><parent link="n{i}"/><child link="n{i + 1}"/>'
            f'<origin xyz="0.3 0 0.1"/><axis xyz="{axis}"/>'
            '<limit effort="1" velocity="1" lower="-2" upper="2"/></joint>'
        )
    path: Path = tmp_path_factory.mktemp("endless") / "r.urdf"
    path.write_text(text + "</robot>", encoding="utf-8")
    robot = d.load_robot(path).with_limits(acceleration=5.0, jerk=100.0)
    return robot.with_limits(lower=[-np.inf, -np.inf, -2.0], upper=[np.inf, np.inf, 2.0])


def wrapped(q: np.ndarray) -> np.ndarray:
    """Return what an encoder that counts from -pi to pi says of the first joint."""
    return np.array([(q[0] + np.pi) % (2.0 * np.pi) - np.pi, *q[1:]])


@pytest.mark.parametrize("noise", [0.0, 1e-4])
@pytest.mark.parametrize("goal", [np.pi, -np.pi])
def test_an_endless_joint_holds_a_position_at_its_encoders_seam(
    endless: d.Robot, noise: float, goal: float
) -> None:
    """It turned round and round, 4.5 times in 30 s."""
    random = np.random.default_rng(0)
    shield = d.Shield(endless, 2e-3)
    q = np.array([3.0 * np.sign(goal), 0.3, 0.3])
    path = [q]
    for _ in range(3000):
        command = shield.step(
            wrapped(q + noise * random.standard_normal(3)), position=[goal, 0.3, 0.3]
        )
        assert command.reasons == ()
        q = q + 2e-3 * command.dq
        path.append(q)
    assert abs(q[0] - goal) < 2.0 * noise + 1e-9
    assert np.ptp(path, axis=0)[0] < 0.15


@pytest.mark.parametrize("lead", [None, 1])
def test_an_endless_joint_follows_samples_on_the_nearest_turn(
    endless: d.Robot, lead: int | None
) -> None:
    """As a requested position is: it turned back once about."""
    shield = d.Shield(endless, 2e-3)
    q = np.zeros(endless.dof)
    while q[0] < 3.6:
        q = shield.step(wrapped(q), np.eye(endless.dof)[0]).next_q
    start = q
    points = wrapped(start) + np.linspace(0.0, 0.1, 5)[:, np.newaxis] * np.eye(endless.dof)[0]
    times = np.linspace(0.3, 1.5, 5)
    if lead is None:
        shield.follow(shield.time + times, points)
    for k in range(1500):
        asked = {} if lead is None or k % 10 else {"position": points[-1], "lead": lead}
        q = shield.step(wrapped(q), **asked).next_q
    np.testing.assert_allclose(q[0], start[0] + 0.1, atol=1e-6)


def test_an_endless_joint_turns_on_through_its_seam(endless: d.Robot) -> None:
    shield = d.Shield(endless, 5e-3)
    q = np.array([3.0, 0.0, 0.0])
    path = [q]
    for _ in range(3000):
        command = shield.step(wrapped(q), [0.9, 0.0, 0.0])
        assert command.reasons == ()
        q = q + 5e-3 * command.dq
        path.append(q)
    assert q[0] > 15.0
    assert breaches(np.array(path), 5e-3, *endless.limits) == []
    for _ in range(600):  # then to the nearest of all turns
        q = q + 5e-3 * shield.step(wrapped(q), position=[-3.0, 0.0, 0.0]).dq
    assert abs(wrapped(q)[0] + 3.0) < 1e-9
    assert abs(q[0] - path[-1][0]) < np.pi + 0.5


def test_what_counts_its_turns_goes_through_them(endless: d.Robot) -> None:
    """A request of a turn more is a turn, and a slide has none."""
    shield = d.Shield(endless, 5e-3)
    q = np.zeros(3)
    goal = np.array([2.0 * np.pi, 2.0 * np.pi, 0.3])
    for _ in range(3000):
        q = q + 5e-3 * shield.step(q, position=goal).dq
    np.testing.assert_allclose(q, goal, atol=1e-9)
    jumped = q + [0.0, 2.0 * np.pi, 0.0]
    assert "resynchronised to measured positions" in shield.step(jumped).reasons


@pytest.mark.parametrize("dt", [1e-3, 1.0 / 30.0])
@pytest.mark.parametrize(
    ("offset", "noise"), [(1e-3, 0.0), (-5e-3, 0.0), (0.0, 1e-4), (3e-3, 1e-4)]
)
def test_a_request_for_the_measured_positions_holds_the_arm(
    dt: float, offset: float, noise: float
) -> None:
    """It drifted at up to 0.23 rad/s, and no reason said why."""
    random = np.random.default_rng(1)
    shield = d.Shield(ROBOT, dt)
    shield.step(START, np.zeros(7))
    q = START
    for _ in range(int(3.0 / dt)):
        measured = q - offset + noise * random.standard_normal(7)
        q = q + dt * shield.step(measured, position=measured).dq
    assert np.abs(q - START).max() < 1e-9


@pytest.mark.parametrize("offset", [0.0, 2e-3])
def test_a_position_is_reached_beside_noise_to_the_offset_of_the_encoders(offset: float) -> None:
    random = np.random.default_rng(2)
    shield = d.Shield(ROBOT, 2e-3)
    shield.step(START, np.zeros(7))
    goal = START + 0.2 * np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    path = [START]
    for _ in range(1500):
        measured = path[-1] - offset + 1e-4 * random.standard_normal(7)
        path.append(path[-1] + 2e-3 * shield.step(measured, position=goal).dq)
    assert np.abs(path[-1] - goal).max() < offset + 3e-4
    assert breaches(np.array(path), 2e-3, *ROBOT.limits) == []


OUTSIDE = [
    ("so101", 1.0 / 30.0, {"acceleration": 10.0, "jerk": 200.0}, 3.0),
    ("iiwa7", 1e-3, {"acceleration": 10.0, "jerk": 500.0}, 1.0),
    ("iiwa7", 1e-3, {"acceleration": 10.0}, 1.0),
    ("iiwa7", 1e-2, {}, 1.0),
    ("fr3", 2e-3, {}, 0.5),
]


def outside(name: str, limits: dict[str, float], degrees: float, side: int) -> Any:
    """Return a robot, and a start whose second joint is so far outside of its range."""
    robot = d.load_robot(name).with_limits(**limits)
    start = np.array(robot.start_posture())
    start[1] = robot.limits[side, 1] + (2 * side - 1) * np.radians(degrees)
    return robot, start


@pytest.mark.parametrize(("name", "dt", "limits", "degrees"), OUTSIDE)
@pytest.mark.parametrize("request_of", ["stay", "rest", "silence", "controller"])
@pytest.mark.parametrize("side", [0, 1])
def test_a_joint_from_outside_of_its_range_comes_to_rest_at_its_limit(
    name: str, dt: float, limits: dict[str, float], degrees: float, request_of: str, side: int
) -> None:
    """Three degrees outside ended 8.7 degrees inside."""
    robot, start = outside(name, limits, degrees, side)
    requests: dict[str, dict[str, Any]] = {"stay": {"position": start}, "rest": {"dq": 0.0 * start}}
    path = [start]
    own = d.schemes.own_rate_limits(robot)
    scheme = d.DoubleIndicator(orientation="none", extra_limits=own, home=tuple(start))
    pose = d.Configuration(robot, start)
    target = d.Target(pose.position, pose.rotation)
    shield, controller = d.Shield(robot, dt), d.Controller(robot, scheme, dt=dt)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for k in range(int(3.0 / dt)):
            if request_of == "controller":
                command: Any = controller.step(path[-1], k * dt, target)
            else:
                command = shield.step(path[-1], **requests.get(request_of, {}))
            path.append(path[-1] + dt * command.dq)
    found = np.array(path)
    inside = (1 - 2 * side) * (found[:, 1] - robot.limits[side, 1])
    rest = 0.3 * min(robot.dddq_max[1], 1e3) * dt**3  # where a joint at its limit rests
    shift = robot.position_dependent_velocity
    edge = 0.5 * shift[0, 1] ** 2 / shift[1, 1] if np.isfinite(shift[1, 1]) else 0.0
    assert inside.max() < edge + rest + 2e-3
    assert inside[-1] > -1e-3
    free = robot.with_limits(
        lower=np.minimum(robot.q_lower, start), upper=np.maximum(robot.q_upper, start)
    )
    assert breaches(found, dt, *free.limits) == []


@pytest.mark.parametrize(
    ("words", "robot", "settings"),
    [
        ("joint 1 has a velocity limit of 98", ROBOT.with_limits(velocity=98.0), {}),
        ("has a position limit of 170", ROBOT.with_limits(lower=-170.0, upper=170.0), {}),
        ("timeout of 100 s is long: is it in ms", ROBOT, {"timeout": 100.0}),
        ("delay of 10 s is long: is it in ms", ROBOT, {"delay": 10.0, "dt": 0.05}),
        ("distance of 20 m is long: is it in mm", ROBOT, {"obstacles": [], "distance": 20.0}),
        ("way to Sphere 1 of 640", ROBOT, {"obstacles": [d.Sphere([400.0, 0.0, 500.0], 50.0)]}),
        ("payload's center of 100 m is", ROBOT.with_payload(0.1, [0.0, 0.0, 100.0]), {}),
        ("tool in mm", ROBOT.with_tool([0.0, 0.0, 120.0, 0.0, 0.0, 0.0]), {}),
    ],
)
def test_settings_in_other_units_are_noticed(words: str, robot: d.Robot, settings: Any) -> None:
    shield = d.Shield(robot, **settings)
    with pytest.warns(UserWarning, match=words):
        shield.step(START)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shield.step(START)
        d.Shield(ROBOT, timeout=np.inf).step(START)


def test_positions_requested_in_degrees_are_noticed_once() -> None:
    shield = d.Shield(ROBOT)
    with pytest.warns(UserWarning, match=r"requested posture .* are the positions in degrees\?"):
        shield.step(START, position=np.degrees(START + 0.1))
    many = d.Shields(ROBOT, 2)
    with pytest.warns(UserWarning, match=r"start posture .* are the positions in degrees\?"):
        many.step(np.degrees([START, START]), np.zeros((2, 7)))
    with pytest.warns(UserWarning, match=r"requested posture .* are the positions in degrees\?"):
        many.step([START, START], position=np.degrees([START, START]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        many.step([START, START], position=np.degrees([START, START]))
        shield.step(START, position=np.degrees(START))
        d.Shield(ROBOT).step(START, position=START + 3.0)  # beyond the limits, but no degrees
