"""Rows of collision avoidance: gradients, bounds, the theorem, policies, files."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn
from helpers_simulation import rows_of
from iiwa_dnn.robot import collision
from iiwa_dnn.robot.collision import collision_model, make_collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.scene import bounds_of_motion, second_order, write_distances
from random_motion import SLACK, Judge, obstacles_for, wander

ROBOT = iiwa_dnn.load_robot("iiwa7")
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
BALL = iiwa_dnn.Sphere([0.36, 0.16, 0.64], 0.05)


def scheme(*limits: iiwa_dnn.Limit) -> iiwa_dnn.Scheme:
    paper = iiwa_dnn.DoubleIndicator()
    return iiwa_dnn.Scheme(paper.costs, paper.tasks, [*paper.limits, *limits])


def heart(scale: float = 3.45e-3, period: float = 10.0) -> iiwa_dnn.Reference:
    path = iiwa_dnn.Heart(scale=scale, period=period)
    return path.anchored(iiwa_dnn.Configuration(ROBOT, START))


def pair_distances_at(
    avoidance: iiwa_dnn.CollisionAvoidance, robot: iiwa_dnn.Robot, q: np.ndarray
) -> np.ndarray:
    scene = avoidance.scene(robot)
    kinematics = Kinematics(robot, scene.frames)
    kinematics.update(q)
    distances = np.empty(len(scene.pairs))
    write_distances(scene.constants, robot.dof, kinematics.placements, distances)
    return distances


@pytest.mark.parametrize("name", ["iiwa7", "panda"])
def test_rows_are_the_gradients_of_the_distances(name: str) -> None:
    robot = iiwa_dnn.load_robot(name)
    avoidance = iiwa_dnn.CollisionAvoidance(obstacles_for(False), nearest=200)
    random, h, worst = np.random.default_rng(0), 1e-6, 0.0
    for _ in range(5):
        q = random.uniform(0.5 * robot.q_lower, 0.5 * robot.q_upper)
        conf = iiwa_dnn.Configuration(robot, q)
        G = scheme(avoidance).build_qp(conf, iiwa_dnn.Target(conf.position, conf.rotation)).G
        apart = pair_distances_at(avoidance, robot, q) > 1e-3
        for j, e in enumerate(np.eye(robot.dof)):
            ends = [pair_distances_at(avoidance, robot, q + s * h * e) for s in (-1.0, 1.0)]
            slope = (ends[1] - ends[0]) / (2.0 * h)
            worst = max(worst, np.abs(-G[apart, j] - slope[apart]).max())
    assert worst < 1e-5  # second differences at the kinks of boxes


def test_h_is_the_damper_without_a_control_period() -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.02, gain=4.0)
    conf = iiwa_dnn.Configuration(ROBOT, START)
    qp = scheme(avoidance).build_qp(conf, iiwa_dnn.Target(conf.position, conf.rotation))
    distances = pair_distances_at(avoidance, ROBOT, START)
    counted = np.isfinite(qp.h)
    assert counted.any()
    np.testing.assert_allclose(qp.h[counted], 4.0 * (distances - 0.02)[counted], rtol=1e-12)
    # Idle rows are those that no velocity within the limits can break.
    idle = ~counted
    assert (4.0 * (distances - 0.02) >= np.abs(qp.G) @ ROBOT.dq_max - 1e-9)[idle].all()


def test_in_a_loop_h_leaves_what_a_step_like_the_last_one_may_take() -> None:
    dt, gain, promised = 0.02, 4.0, 0.02
    last = np.array([0.3, 1.5, -0.4, 1.0, 0.5, -0.7, 0.1])

    def wall(offset: float) -> iiwa_dnn.CollisionAvoidance:
        plane = iiwa_dnn.HalfSpace([-1.0, 0.0, 0.0], offset)
        return iiwa_dnn.CollisionAvoidance([plane], self_collision=False, gain=gain)

    far = wall(-1.0)
    distances = pair_distances_at(far, ROBOT, START)
    pair = int(distances.argmin())

    def row(spare: float, dq: np.ndarray) -> tuple[np.ndarray, float]:
        """Return G and h where the pair is so much farther away than what is promised."""
        near = wall(-1.0 + distances[pair] - promised - spare)
        qp = rows_of(near, iiwa_dnn.Configuration(ROBOT, START), dt=dt, dq=dq)
        return qp.G[pair], float(qp.h[pair])

    g, still = row(0.05, np.zeros(7))
    assert still == pytest.approx(gain * 0.05, rel=1e-9)
    eps = (still - row(0.05, last)[1]) / gain
    # A wall is flat: the distance after the step is as the row says, less what the points' curves
    # take, and those may bend to either side.
    for sign in (-1.0, 1.0):
        after = pair_distances_at(far, ROBOT, START + sign * dt * last)[pair]
        assert abs(distances[pair] - sign * dt * (g @ last) - after) < eps
    # In the range that such a step could take the row asks for all of it at once.
    assert row(0.0, last)[1] == pytest.approx(-eps / dt, rel=1e-9)
    assert row(0.5 * eps, last)[1] == pytest.approx(-0.5 * eps / dt, rel=1e-9)
    assert row(eps + 5e-3, last)[1] == pytest.approx(gain * 5e-3, rel=1e-9)
    assert row(-1e-3, last)[1] == pytest.approx(-eps / dt - gain * 1e-3, rel=1e-9)


def test_no_acceleration_is_above_its_bound() -> None:
    random, joint, h = np.random.default_rng(1), 7, 1e-4
    point = np.array([0.02, -0.03, 0.06])
    for first in (0, 2):
        moves, radii = bounds_of_motion(ROBOT, first, joint, point[None])
        assert moves.tolist() == [0.0] * first + [1.0] * (joint - first)
        speed = float(np.abs(radii) @ ROBOT.dq_max)
        acceleration = second_order(moves[None], radii[None], 0, ROBOT.dq_max)
        found = []
        for _ in range(300):
            q, dq = random.uniform(-2.0, 2.0, 7), ROBOT.dq_max * random.choice([-1.0, 1.0], 7)
            place = []
            for s in (-h, 0.0, h):
                kinematics = iiwa_dnn.Configuration(ROBOT, q + s * dq)
                tip = kinematics.frame("iiwa7_link_7")
                x = tip.position + tip.rotation @ point
                if first:
                    base = kinematics.frame("iiwa7_link_2")
                    x = base.rotation.T @ (x - base.position)
                place.append(x)
            found.append([np.linalg.norm(place[2] - place[0]) / (2 * h),
                          np.linalg.norm(place[2] - 2 * place[1] + place[0]) / h**2])  # fmt: skip
        largest = np.max(found, axis=0)
        assert 0.2 * speed < largest[0] < speed
        assert 0.1 * acceleration < largest[1] < acceleration


@pytest.mark.parametrize(("name", "seed", "moving"), [("iiwa7", 2, True), ("panda", 1, False)])
def test_random_motion_never_comes_too_near(name: str, seed: int, moving: bool) -> None:
    found = wander(name, 1000, seed, moving, sampled=3)
    assert found["least_m"] >= 0.02 - SLACK
    assert found["least_between_m"] >= 0.02 - SLACK
    assert found["difference_m"] < 2e-6  # coal's own tolerance is 1e-6
    assert found["active"] > 50
    assert found["policy"] <= 15  # rows that ask for more than the joints can give


def test_the_elbow_gives_way_and_the_heart_stays() -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.03)
    unchecked = iiwa_dnn.CrossCheck(())
    free = iiwa_dnn.simulate(ROBOT, scheme(), heart(), START, dt=5e-3, check=unchecked)
    record = iiwa_dnn.simulate(ROBOT, scheme(avoidance), heart(), START, dt=5e-3)
    metrics = iiwa_dnn.compute_metrics(record)
    assert iiwa_dnn.failures(record) == []
    assert avoidance.scene(ROBOT).nearest(free.q, free.t)[0].min() < 0.01
    near = metrics["collisions"]
    assert near["first"] == "Sphere 1"
    assert 0.03 <= near["least_distance_m"] < 0.032
    assert near["missing_m"] == 0.0
    without = iiwa_dnn.compute_metrics(free)["max_position_error_m"]
    assert metrics["max_position_error_m"] < 1.1 * without
    judge = Judge(ROBOT, avoidance)
    coals = [judge.distance(q, t) for q, t in zip(record.q, record.t, strict=True)]
    np.testing.assert_allclose(record.distance, coals, atol=1e-9)


def test_rows_begin_and_end_without_chatter() -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.03)
    record = iiwa_dnn.simulate(
        ROBOT, scheme(avoidance), heart(), START, dt=1e-3, duration=4.0,
        check=iiwa_dnn.CrossCheck(()),
    )  # fmt: skip
    active = (record.row_multiplier > 0).any(axis=1).astype(int)
    assert active.any()
    assert np.abs(np.diff(active)).sum() <= 4  # on and off, not again and again
    jumps = np.abs(np.diff(record.dq, n=2, axis=0)).max()
    assert jumps < 0.01  # [rad/s] between three steps


def test_the_path_yields_where_the_arm_cannot() -> None:
    tip = iiwa_dnn.Configuration(ROBOT, START).position
    wall = iiwa_dnn.Sphere(tip + [0.05, 0.0, -0.12], 0.06)  # under the heart
    avoidance = iiwa_dnn.CollisionAvoidance([wall], self_collision=False, distance=0.01)
    line = iiwa_dnn.Line(offset=(0.0, 0.0, -0.1), period=4.0)
    path = line.anchored(iiwa_dnn.Configuration(ROBOT, START))
    for policy in ("slow", "relax"):
        record = iiwa_dnn.simulate(
            ROBOT, scheme(avoidance), path, START, dt=5e-3, duration=2.0, policy=policy
        )
        assert record.distance.min() >= 0.01
        reasons = iiwa_dnn.failures(record)
        assert any("CollisionAvoidance" in reason and "Sphere 1" in reason for reason in reasons)


def test_an_obstacle_that_comes_is_kept_away_from() -> None:
    coming = iiwa_dnn.Sphere([0.33, 0.16, 0.84], 0.05, velocity=[0.0, 0.0, -0.04])
    avoidance = iiwa_dnn.CollisionAvoidance([coming], distance=0.03)
    record = iiwa_dnn.simulate(ROBOT, scheme(avoidance), heart(), START, dt=5e-3, duration=5.0)
    assert record.distance.min() >= 0.03
    assert avoidance.scene(ROBOT).nearest(np.tile(START, (2, 1)), np.array([0.0, 5.0]))[0][1] < 0.03


def test_more_pairs_than_rows_keep_the_nearest() -> None:
    many = [iiwa_dnn.Sphere([0.36, 0.16, 0.64 + 0.3 * k], 0.05) for k in range(5)]
    few = iiwa_dnn.CollisionAvoidance(many, distance=0.03, nearest=4)
    conf = iiwa_dnn.Configuration(ROBOT, START)
    target = iiwa_dnn.Target(conf.position, conf.rotation)
    some = scheme(few).build_qp(conf, target)
    whole = scheme(iiwa_dnn.CollisionAvoidance(many, distance=0.03, nearest=99))
    qp = whole.build_qp(conf, target)
    slack = np.where(np.isfinite(qp.h), qp.h - np.abs(qp.G) @ ROBOT.dq_max, 0.0)
    chosen = np.sort(np.argsort(slack, kind="stable")[: np.isfinite(some.h).sum()])
    np.testing.assert_array_equal(some.G[np.isfinite(some.h)], qp.G[chosen])
    assert few.row_names(ROBOT) == []


def test_both_plants_record_the_distance() -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.03)
    record = iiwa_dnn.simulate(
        ROBOT, scheme(avoidance), heart(), START, dt=1e-3, duration=0.3,
        plant=iiwa_dnn.MujocoPlant(),
    )  # fmt: skip
    assert record.distance.shape == (record.steps + 1,)
    assert record.distance.min() > 0.029


def test_a_record_keeps_the_distances(tmp_path: Path) -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.03)
    record = iiwa_dnn.simulate(ROBOT, scheme(avoidance), heart(), START, dt=5e-3, duration=0.1)
    record.save(tmp_path / "record.npz")
    again = iiwa_dnn.Record.load(tmp_path / "record.npz")
    np.testing.assert_array_equal(again.distance, record.distance)
    pair = again.settings["collisions"]["pairs"][again.nearest[0]]
    assert pair == ["Sphere 1", "iiwa7_link_4"]


def points_of(shape: Any) -> np.ndarray:
    """Points of a body's surface in its own frame (k, 3) [m]."""
    if hasattr(shape, "vertices"):
        return np.array(shape.vertices())
    if hasattr(shape, "halfSide"):
        signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, 8).T
        return signs * shape.halfSide
    if not hasattr(shape, "halfLength"):
        return shape.radius * np.vstack([np.eye(3), -np.eye(3)])
    turns = np.linspace(0.0, 2.0 * np.pi, 24)
    rim = shape.radius * np.column_stack([np.cos(turns), np.sin(turns), 0.0 * turns])
    return np.vstack([rim + [0.0, 0.0, z] for z in (-shape.halfLength, shape.halfLength)])


@pytest.mark.parametrize("make", [collision_model, partial(make_collision_model, samples=9)])
@pytest.mark.parametrize("name", ["iiwa7", "iiwa7_dual", "fr3", "panda", "ur5", "xarm7", "kinova"])
def test_capsules_hold_the_shapes_of_the_urdf_and_are_not_much_larger(name: str, make: Any) -> None:
    robot = iiwa_dnn.load_robot(name)
    model = make(robot)
    folders = [str(folder) for folder in robot.path.parents]
    shapes = pin.buildGeomFromUrdfString(
        robot.model, robot.urdf, pin.GeometryType.COLLISION, package_dirs=folders
    )
    volumes: dict[str, list[float]] = {}
    for shape in shapes.geometryObjects:
        frame = robot.model.frames[shape.parentFrame]
        place = frame.placement.actInv(shape.placement)
        points = points_of(shape.geometry) @ place.rotation.T + place.translation
        away = []
        for capsule in (each for each in model.capsules if each.link == frame.name):
            a = np.array(capsule.a)
            axis = np.array(capsule.b) - a
            along = np.clip((points - a) @ axis / max(axis @ axis, 1e-12), 0.0, 1.0)
            away.append(np.linalg.norm(points - a - along[:, None] * axis, axis=1) - capsule.radius)
            length = float(np.linalg.norm(axis)) + 4.0 / 3.0 * capsule.radius
            volumes.setdefault(frame.name, []).append(np.pi * capsule.radius**2 * length)
        assert np.min(away, axis=0).max() < 3e-5
        if hasattr(shape.geometry, "vertices"):
            assert min(volumes[frame.name]) < 4.0 * np.prod(np.ptp(points, axis=0))


def arm_of(folder: Path, **bodies: str) -> iiwa_dnn.Robot:
    """Load an arm of three joints whose links base, p1, p2, p3 consist of these elements."""
    text = f"<link name='base'>{bodies.get('base', '')}</link><link name='flange'/>"
    text += "<joint name='f' type='fixed'>"
    text += "<parent link='p3'/><child link='flange'/></joint>"
    for i, parent in enumerate(("base", "p1", "p2"), 1):
        text += (
            f"<link name='p{i}'>{bodies.get(f'p{i}', '')}</link><joint name='j{i}' type='revolute'>"
            f"<parent link='{parent}'/><child link='p{i}'/><origin xyz='0.3 0 0'/>"
            "<axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='1'/></joint>"
        )
    path = folder / "arm.urdf"
    path.write_text(f"<robot name='arm'>{text}</robot>", encoding="utf-8")
    return iiwa_dnn.load_robot(path, tip="flange")


@pytest.fixture
def few_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    """Look for pairs that may meet in few postures: these tests are about the links."""
    monkeypatch.setattr(collision, "make_collision_model", partial(make_collision_model, samples=9))


ROD = """<origin xyz="0.1 0 0" rpy="0 1.5708 0"/>
<geometry><cylinder radius="{}" length="0.2"/></geometry>"""
DRAWN = f"<visual>{ROD.format(0.03)}</visual>"
COVER = f"<collision>{ROD.format(0.04)}</collision>"
MASS = """<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial>"""


@pytest.mark.parametrize(
    ("bodies", "unwatched"),
    [
        ({"p1": MASS + COVER, "p2": COVER, "p3": MASS + COVER}, ()),
        ({"p1": MASS, "p2": MASS + COVER, "p3": DRAWN}, ("p1",)),
        ({"p2": MASS + COVER, "p3": DRAWN + MASS}, ("p3",)),
    ],
)
def test_links_without_collision_geometry_are_named(
    bodies: dict[str, str], unwatched: tuple[str, ...], tmp_path: Path, few_samples: None
) -> None:
    assert unwatched_links(arm_of(tmp_path, **bodies)) == unwatched


@pytest.mark.parametrize("name", ["fr3", "iiwa7", "iiwa7_dual"])
def test_arms_of_the_package_are_watched_whole(name: str, few_samples: None) -> None:
    assert unwatched_links(iiwa_dnn.load_robot(name)) == ()


BALL_OF_P2 = "<collision><geometry><sphere radius='0.02'/></geometry></collision>"


@pytest.mark.parametrize(
    ("gap", "joint_1", "reason"),
    [
        (0.01, 1.0, None),  # near without a touch, at the end of the range of joint 1
        (-0.01, 1.0, None),
        (0.03, 1.0, "never"),
        (0.01, "start", "start"),
        (-1.0, 1.0, "start"),
    ],
)
def test_a_pair_is_watched_if_it_may_come_near(
    gap: float, joint_1: float | str, reason: str | None, tmp_path: Path
) -> None:
    """A ball of the base, ahead of one that turns about the first joint 0.3 m away from it."""
    start = arm_of(tmp_path).start_posture()[0]
    angle = start if joint_1 == "start" else float(joint_1)
    radius = 0.02 if gap > -0.04 else 1.0
    x = 0.3 + 0.3 * np.cos(angle) - (gap + radius + 0.02) * np.sin(angle)
    y = 0.3 * np.sin(angle) + (gap + radius + 0.02) * np.cos(angle)
    base = f"<origin xyz='{x} {y} 0'/><geometry><sphere radius='{radius}'/></geometry>"
    robot = arm_of(tmp_path, base=f"<collision>{base}</collision>", p1=COVER, p2=BALL_OF_P2)
    model = make_collision_model(robot)
    reasons = {frozenset(links): why for *links, why in model.left_out}
    assert reasons.get(frozenset(("base", "p2"))) == reason
    assert reasons[frozenset(("base", "p1"))] == "adjacent"
    watched = [{model.capsules[i].link for i in pair} for pair in model.pairs(robot)]
    assert ({"base", "p2"} in watched) == (reason is None)


def test_a_controller_warns_of_links_that_no_row_watches(tmp_path: Path, few_samples: None) -> None:
    robot = arm_of(tmp_path, p1=MASS, p2=COVER, p3=MASS)
    avoidance = iiwa_dnn.CollisionAvoidance([BALL])
    still = iiwa_dnn.Still().anchored(iiwa_dnn.Configuration(robot, np.zeros(3)))
    paper = iiwa_dnn.DoubleIndicator(orientation="none", extra_limits=(avoidance,))
    with pytest.warns(UserWarning, match="no <collision> geometry: p1, p3$") as caught:
        record = iiwa_dnn.simulate(robot, paper, still, np.zeros(3), dt=0.01, duration=0.02)
    assert len(caught) == 1
    assert record.settings["collisions"]["unwatched"] == ["p1", "p3"]
    assert record.settings["collisions"]["left_out"] == []
    bare = arm_of(tmp_path, p1=MASS, p2=MASS)
    with pytest.raises(iiwa_dnn.InvalidInputError, match=r"could meet; .* geometry: p1, p2$"):
        avoidance.scene(bare)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[[obstacle]]\nshape = 'ball'", "shape: must be one of sphere"),
        ("[[obstacle]]\nshape = 'sphere'\nradius = 1", "Sphere: missing"),
        ("[[obstacle]]\nshape = 'sphere'\ncenter = [0, 0]\nradius = 1", "center"),
        ("[[obstacle]]\nshape = 'Box'\ncenter = [0,0,0]\nhalf_extents = [1,1,-1]", "half_extents"),
        ("distance = -1", "distance: must be a finite number above 0"),
        ("distanz = 1", "unexpected keyword argument 'distanz'"),
        ("[[obstacle]]\nshape = 'Sphere'\nradus = 1", "unexpected keyword argument 'radus'"),
        ("obstacle = 3", "not"),
        ("x = [", "cannot be read as TOML"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "obstacles.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(iiwa_dnn.FileError, match="toml: ") as caught:
        iiwa_dnn.CollisionAvoidance.from_toml(path)
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_is_what_python_says(tmp_path: Path) -> None:
    path = tmp_path / "obstacles.toml"
    path.write_text(
        "distance = 0.03\n[[obstacle]]\nshape = 'sphere'\n"
        "center = [0.36, 0.16, 0.64]\nradius = 0.05\n"
        "[[obstacle]]\nshape = 'half_space'\nnormal = [0, 0, 2]\noffset = -0.1\n"
        "[[obstacle]]\nshape = 'capsule'\na = [1, 0, 0]\nb = [1, 1, 0]\nradius = 0.1\n"
        "velocity = [0.1, 0, 0]\n",
        encoding="utf-8",
    )
    read = iiwa_dnn.CollisionAvoidance.from_toml(path)
    assert read.obstacles[0] == BALL
    assert read.obstacles[1] == iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.1)
    assert read.obstacles[2].speed == pytest.approx(0.1)
    assert read.distance == 0.03


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda: iiwa_dnn.Sphere([0, 0, 0], 0.0), "radius"),
        (lambda: iiwa_dnn.Sphere([0, 0, 0], 1.0, velocity=[1.0, 0.0]), "velocity"),
        (lambda: iiwa_dnn.HalfSpace([0, 0, 0], 1.0), "normal"),
        (lambda: iiwa_dnn.Box([0, 0, 0], [1, 1, 1], np.diag([1, 1, -1])), "rotation"),
        (lambda: iiwa_dnn.CollisionAvoidance(["ball"]), "obstacles"),
        (lambda: iiwa_dnn.CollisionAvoidance(self_collision=False).scene(ROBOT), "obstacles"),
        (
            lambda: iiwa_dnn.CollisionAvoidance().scene(ROBOT.with_limits(velocity=np.inf)),
            "robot",
        ),
    ],
)
def test_bad_input_names_its_argument(make: Any, argument: str) -> None:
    with pytest.raises(iiwa_dnn.InvalidInputError) as caught:
        make()
    assert caught.value.argument == argument
