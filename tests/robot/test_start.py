"""Start postures of arms that are not known by name."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn as d

# Height of each joint over the one before, or ahead of it [m], its axis and its limits [rad].
INDUSTRIAL = [
    ("0 0 0.67", "0 0 1", -3.23, 3.23),
    ("0.312 0 0", "0 1 0", -1.05, 1.33),
    ("0 0 1.075", "0 -1 0", -2.3, 3.14),
    ("0 0 0.225", "-1 0 0", -6.28, 6.28),
    ("1.28 0 0", "0 -1 0", -2.18, 2.18),
    ("0.215 0 0", "-1 0 0", -6.28, 6.28),
]


def ball(radius: float) -> str:
    return f'<collision><geometry><sphere radius="{radius}"/></geometry></collision>'


def write_arm(path: Path, rows: list[tuple[str, str, float, float]], shapes: dict[int, str]) -> str:
    parts = [f'<link name="l0">{shapes.get(0, "")}</link>']
    for i, (xyz, axis, lower, upper) in enumerate(rows, 1):
        parts.append(
            f'<link name="l{i}">{shapes.get(i, "")}</link><joint name="j{i}" type="revolute">'
            f'<parent link="l{i - 1}"/><child link="l{i}"/><origin xyz="{xyz}"/>'
            f'<axis xyz="{axis}"/><limit lower="{lower}" upper="{upper}" velocity="2"/></joint>'
        )
    path.write_text(f'<robot name="unknown">{"".join(parts)}</robot>')
    return str(path)


def least(robot: d.Robot, q: np.ndarray, reach: float = 1.0, rows: int = 6) -> float:
    """Compute the least singular value of the Jacobian, its rows of rotation times a reach."""
    jacobian = np.array(d.Configuration(robot, q).jacobian)[:rows]
    jacobian[3:] *= reach
    return float(np.sqrt(max(0.0, np.linalg.eigvalsh(jacobian @ jacobian.T)[0])))


def test_an_unknown_arm_starts_far_from_singular_postures_and_from_its_limits(tmp_path) -> None:
    robot = d.load_robot(write_arm(tmp_path / "arm.urdf", INDUSTRIAL, {}))
    q = robot.start_posture()
    reach = 0.67 + 0.312 + 1.075 + 0.225 + 1.28 + 0.215
    others = [least(robot, other, reach) for other in robot.draw(np.random.default_rng(5), 200)]
    assert least(robot, q, reach) > 0.9 * max(others)
    assert least(robot, q, reach) > 2.5 * np.median(others)
    ranges = robot.q_upper - robot.q_lower
    assert (np.minimum(q - robot.q_lower, robot.q_upper - q) >= 0.2 * ranges).all()
    np.testing.assert_array_equal(robot.start_posture(), q)
    start = d.Configuration(robot, q)
    path = d.Circle(radius=0.1, period=6.0).anchored(start)
    assert d.failures(d.simulate(robot, d.DoubleIndicator(), path, q, dt=2e-2)) == []


def test_with_fewer_than_six_joints_the_position_counts(tmp_path) -> None:
    rows = [
        ("0 0 0.1", "1 0 0", -0.8, 0.8),
        ("0 0.1 0", "0 1 0", -1, 4),
        ("0 0 -0.2", "0 1 0", -3, 0),
    ]
    tip = '<link name="foot"/><joint name="ankle" type="fixed"><parent link="l3"/>'
    tip += '<child link="foot"/><origin xyz="0 0 -0.2"/></joint>'
    file = Path(write_arm(tmp_path / "leg.urdf", rows, {}))
    file.write_text(file.read_text().replace("</robot>", f"{tip}</robot>"))
    leg = d.load_robot(file)
    others = [least(leg, q, rows=3) for q in leg.draw(np.random.default_rng(5), 200)]
    assert least(leg, leg.start_posture(), rows=3) > 0.9 * max(others)


def test_no_posture_around_the_start_is_singular() -> None:
    quarter = np.pi / 2
    table = [
        (0.0, quarter, 0.2, 0.0),
        (0.14, 0.0, 0.0, 0.0),
        (0.13, 0.0, 0.0, 0.0),
        (0.0, quarter, 0.28, 0.0),
        (0.0, -quarter, 0.07, 0.0),
        (0.0, 0.0, 0.14, 0.0),
    ]
    robot = d.robot_from_dh(table, lower=-2.5, upper=2.5)
    q = robot.start_posture()
    path = d.Circle(radius=0.05 * robot.reach, period=10.0).anchored(d.Configuration(robot, q))
    assert d.failures(d.simulate(robot, d.DoubleIndicator(), path, q, dt=5e-2)) == []


def test_an_unknown_arm_does_not_start_in_a_collision(tmp_path) -> None:
    rows = [*[(xyz, axis, -2.8, 2.8) for xyz, axis, *_ in INDUSTRIAL[:3]], INDUSTRIAL[4]]
    bare = d.load_robot(write_arm(tmp_path / "bare.urdf", rows, {}))
    # A ball around where the tip would start; another one at the tip.
    tip = d.Configuration(bare, bare.start_posture()).position
    base = ball(0.3).replace("<geometry>", f'<origin xyz="{tip[0]} {tip[1]} {tip[2]}"/><geometry>')
    robot = d.load_robot(write_arm(tmp_path / "arm.urdf", rows, {0: base, 4: ball(0.3)}))
    there = d.Configuration(robot, robot.start_posture()).position
    assert np.linalg.norm(there - tip) > 0.6
    # Links that overlap in every posture are of no account.
    twins = d.load_robot(write_arm(tmp_path / "arm.urdf", rows, {1: ball(0.3), 2: ball(0.3)}))
    np.testing.assert_array_equal(twins.start_posture(), bare.start_posture())


TABLE = [(0.3, 0.0, 0.0, 0.0), (0.2, 0.0, 0.0, 0.0), (0.1, 0.0, 0.0, 0.0)]


@pytest.mark.parametrize("slides", [(), (1,), (1, 2, 3)])
@pytest.mark.parametrize("length", [0.0, 1.0])
def test_a_start_of_an_arm_of_any_shape(slides: tuple[int, ...], length: float) -> None:
    table = length * np.array(TABLE)
    robot = d.robot_from_dh(table, prismatic=slides)
    q = robot.start_posture()
    assert np.isfinite(q).all()
    if length and not slides:  # planar: the elbow is bent
        assert abs(np.sin(q[1])) > 0.5


def test_the_start_follows_the_limits() -> None:
    robot = dataclasses.replace(d.load_robot("iiwa7"), name="some")
    narrow = robot.with_limits(lower=0.1, upper=0.2)
    assert ((narrow.start_posture() >= 0.12) & (narrow.start_posture() <= 0.18)).all()
