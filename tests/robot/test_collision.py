"""Collision geometry: capsules around the shapes of the URDF, the pairs that may meet."""

import warnings
from collections import Counter
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any

import coal
import numpy as np
import pinocchio as pin
import pytest
import tomli_w

import iiwa_dnn
from iiwa_dnn.robot import collision
from iiwa_dnn.robot.arms import robots_folder
from iiwa_dnn.robot.collision import (
    collision_model,
    link_model,
    make_collision_model,
    unwatched_links,
)
from iiwa_dnn.robot.fitting import fit_bodies
from iiwa_dnn.robot.shapes import read_shapes

BALL = iiwa_dnn.Sphere([0.36, 0.16, 0.64], 0.05)


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
@pytest.mark.parametrize("name", ["iiwa7", "iiwa7_dual", "fr3", "panda", "ur5", "xarm7", "so101"])
def test_capsules_hold_the_shapes_of_the_urdf_and_are_not_much_larger(name: str, make: Any) -> None:
    robot = iiwa_dnn.load_robot(name)
    assert unwatched_links(robot) == ()
    model = make(robot)
    folders = [str(folder) for folder in robot.path.parents]
    shapes = pin.buildGeomFromUrdfString(
        robot.model, robot.urdf, pin.GeometryType.COLLISION, package_dirs=folders
    )
    links: dict[str, list[np.ndarray]] = {}
    meshes = set()
    for shape in shapes.geometryObjects:
        frame = robot.model.frames[shape.parentFrame]
        place = frame.placement.actInv(shape.placement)
        points = points_of(shape.geometry) @ place.rotation.T + place.translation
        links.setdefault(frame.name, []).append(points)
        if hasattr(shape.geometry, "vertices"):
            meshes.add(frame.name)
    for link, parts in links.items():
        points = np.vstack(parts)
        away, volumes = [], []
        for capsule in (each.shape for each in model.capsules if each.link == link):
            a = np.array(capsule.a)
            axis = np.array(capsule.b) - a
            along = np.clip((points - a) @ axis / max(axis @ axis, 1e-12), 0.0, 1.0)
            away.append(np.linalg.norm(points - a - along[:, None] * axis, axis=1) - capsule.radius)
            length = float(np.linalg.norm(axis)) + 4.0 / 3.0 * capsule.radius
            volumes.append(np.pi * capsule.radius**2 * length)
        assert np.min(away, axis=0).max() < 3e-5
        if link in meshes:
            assert min(volumes) < 4.0 * np.prod(np.ptp(points, axis=0))


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


ROD = """<origin xyz="0.1 0 0" rpy="0 1.5708 0"/>
<geometry><cylinder radius="{}" length="0.2"/></geometry>"""
DRAWN = f"<visual>{ROD.format(0.03)}</visual>"
COVER = f"<collision>{ROD.format(0.04)}</collision>"
MASS = """<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial>"""
BALL_OF_P2 = "<collision><geometry><sphere radius='0.02'/></geometry></collision>"


@pytest.mark.parametrize(
    ("gap", "joint_1", "reason"),
    [
        (0.01, 1.0, None),  # near without a touch, at the end of the range of joint 1
        (-0.01, 1.0, None),
        (0.03, 1.0, "never"),
        (0.01, "start", None),
        (-1.0, 1.0, "always"),
    ],
)
def test_a_pair_is_watched_if_it_may_come_near(gap, joint_1, reason, tmp_path) -> None:
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
    watched = [{model.bodies[i].link for i in pair[:2]} for pair in model.pairs(robot)]
    assert ({"base", "p2"} in watched) == (reason is None)
    still = robot.with_limits(*(robot.start_posture() + [[-0.01], [0.01]]))  # it never comes near
    assert make_collision_model(still).pairs(robot) == []


def touching_links(robot: iiwa_dnn.Robot, postures: np.ndarray) -> Counter[frozenset[str]]:
    """Count the postures (k, n) in which links that no joint joins touch by their own shapes."""
    shapes = read_shapes(robot, pin.GeometryType.COLLISION)
    parents = robot.model.parents
    pairs = []
    for i, k in combinations(range(shapes.ngeoms), 2):
        first, second = (shapes.geometryObjects[each] for each in (i, k))
        a, b = first.parentJoint, second.parentJoint
        if a != b and parents[a] != b and parents[b] != a:
            names = (robot.model.frames[each.parentFrame].name for each in (first, second))
            pairs.append(frozenset(names))
            shapes.addCollisionPair(pin.CollisionPair(i, k))
    data, scratch = robot.model.createData(), pin.GeometryData(shapes)
    found: Counter[frozenset[str]] = Counter()
    for q in postures:
        pin.computeCollisions(robot.model, data, shapes, scratch, q, False)
        results = zip(pairs, scratch.collisionResults, strict=True)
        found.update({pair for pair, result in results if result.isCollision()})
    return found


@pytest.mark.parametrize("name", sorted(robots_folder().iterdir()), ids=lambda each: each.name)
def test_pairs_that_touch_are_watched_or_told(name: Path) -> None:
    """The links' own shapes judge the file of a named arm, in postures that no search had."""
    robot = iiwa_dnn.load_robot(name.name)
    model = collision_model(robot)
    touched = touching_links(robot, robot.draw(np.random.default_rng(7), 400))
    touched |= touching_links(robot, robot.start_posture()[np.newaxis])
    reasons = {frozenset(links): why for *links, why in model.left_out}
    watched = {frozenset(model.bodies[i].link for i in pair[:2]) for pair in model.pairs(robot)}
    told = {frozenset(pair) for pair in model.unguarded}
    always = {pair for pair, count in touched.items() if count > 360}
    assert always == {pair for pair, why in reasons.items() if why == "always"}
    assert touched.keys() - always <= watched | told
    assert not watched & {pair for pair, why in reasons.items() if pair not in told}


CAPSULE = {"link": "p1", "a": [0, 0, 0], "b": [0, 0, 0.1], "radius": 0.1}


@pytest.mark.parametrize(
    ("capsule", "pair", "said"),
    [
        ({"radius": -0.1}, ["p1", "p2", "never"], "radius: must be a finite number above 0"),
        ({"b": [0, 1]}, ["p1", "p2", "never"], r"b: must have shape \(3,\)"),
        ({"radus": 0.1}, ["p1", "p2", "never"], "argument 'radus'"),
        ({}, ["p1", "p2"], "left_out: must have two links and a reason in each entry"),
        ({"link": "q1"}, ["p1", "p2", "never"], "^no frame 'q1'; there are: base, p1"),
        ({}, ["p1", "q2", "never"], "^no frame 'q2'; there are: base, p1"),
    ],
)
def test_a_fault_of_a_geometry_file_is_named(capsule, pair, said, tmp_path) -> None:
    robot = arm_of(tmp_path)
    content = {"left_out": [pair], "capsule": [CAPSULE | capsule]}
    (tmp_path / "arm.collisions.toml").write_text(tomli_w.dumps(content))
    with pytest.raises(iiwa_dnn.errors.IiwaDnnError, match=said) as caught:
        collision_model(robot).pairs(robot)
    assert "\n" not in str(caught.value)


def mesh_of(name: str) -> str:
    return f"<collision><geometry><mesh filename='package://{name}'/></geometry></collision>"


@pytest.mark.parametrize("mesh", ["gone.stl", "text.stl", "part.step"])
def test_a_damaged_mesh_is_named_and_a_folder_is_asked_for_if_it_is_missing(mesh, tmp_path) -> None:
    if mesh != "gone.stl":
        (tmp_path / mesh).write_text("hello")
    said = rf"read \((Mesh package://|Could not load resource .*){mesh}.*\)"
    with pytest.raises(iiwa_dnn.errors.FileError, match=said) as caught:
        collision_model(arm_of(tmp_path, p1=mesh_of(mesh)))
    assert "\n" not in str(caught.value)
    assert ("ROS_PACKAGE_PATH" in str(caught.value)) == (mesh == "gone.stl")


PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face {}
property list uchar int vertex_indices
end_header
0 0 0
0.1 0 0
0 0.1 0
{}"""
NO_TRIANGLES = {
    "some.ply": PLY.format(0, "").encode(),
    "points.obj": b"# points\n" + 5 * b"v 0 0 0\nv 1 0 0\n",
    "text.stl": b"solid a\nendsolid a\n",
    "none.stl": bytes(84),
}


@pytest.mark.parametrize(("name", "data"), NO_TRIANGLES.items(), ids=NO_TRIANGLES)
def test_a_mesh_without_triangles_is_left_out_and_said_and_the_others_are_watched(
    name: str, data: bytes, tmp_path
) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / name).write_bytes(data)
    (tmp_path / "whole.ply").write_text(PLY.format(1, "3 0 1 2\n"))
    twice = mesh_of(f"parts/{name}") + mesh_of("whole.ply")
    robot = arm_of(tmp_path, p1=COVER, p2=twice, p3=mesh_of(f"parts/{name}"))
    said = f"the mesh .*parts/{name} of p2, p3 has no triangles: it is left out$"
    with pytest.warns(UserWarning, match=said):
        model = make_collision_model(robot, samples=9)
    assert {capsule.link for capsule in model.capsules} == {"p1", "p2"}


def test_a_mesh_whose_vertices_are_no_numbers_is_named(tmp_path) -> None:
    (tmp_path / "torn.ply").write_text(PLY.format(1, "3 0 1 2\n").replace("0.1 0 0", "nan 0 0"))
    with pytest.raises(
        iiwa_dnn.errors.FileError, match=r"link 'p1': the mesh .*torn\.ply has vert"
    ):
        make_collision_model(arm_of(tmp_path, p1=mesh_of("torn.ply")), samples=9)


def solid_of(shape: str) -> str:
    return f"<collision><geometry><{shape}/></geometry></collision>"


@pytest.mark.parametrize(
    "shape", ["sphere radius='-0.1'", "cylinder radius='-0.1' length='1'", "box size='1 -1 1'"]
)
def test_a_solid_with_a_negative_size_is_refused(shape: str, tmp_path) -> None:
    robot = arm_of(tmp_path, p1=COVER, p2=solid_of(shape))
    kind = shape.partition(" ")[0]
    with pytest.raises(
        iiwa_dnn.errors.FileError, match=f"link 'p2': a {kind} has a negative size$"
    ):
        make_collision_model(robot, samples=9)


def test_a_solid_without_a_size_is_left_out_and_said(tmp_path) -> None:
    robot = arm_of(tmp_path, p1=COVER, p2=solid_of("sphere radius='0'"))
    with pytest.warns(UserWarning, match="a sphere of p2 has no size: left out$"):
        model = make_collision_model(robot, samples=9)
    assert {capsule.link for capsule in model.capsules} == {"p1"}


@pytest.mark.parametrize("version", ["", "version='1.0'", "version='1.1'", "version='1.2'"])
def test_a_capsule_of_a_file_is_a_shape_whatever_its_version(version: str, tmp_path) -> None:
    rod = "<collision><geometry><capsule radius='0.03' length='0.2'/></geometry></collision>"
    path = Path(arm_of(tmp_path, p1=rod).path or "")
    path.write_text(path.read_text().replace("<robot ", f"<robot {version} "))
    ((link, capsule),) = make_collision_model(iiwa_dnn.load_robot(path, "flange"), 9).capsules
    assert (link, capsule.radius) == ("p1", 0.03)
    np.testing.assert_allclose(np.abs([capsule.a, capsule.b]), [[0, 0, 0.1]] * 2, atol=1e-12)


def test_pairs_that_take_long_are_said(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(collision, "process_time", iter([0.0, 1.9, 0.0, 2.5]).__next__)
    robot = arm_of(tmp_path, p1=COVER)
    assert collision_model(robot) is collision_model(robot)  # once
    said = f"^capsules and pairs of arm took 2.5 s; .* beside {robot.path}$"
    with pytest.warns(UserWarning, match=said):
        collision_model(robot.with_limits(upper=0.5))


def test_a_file_counts_within_the_position_limits_of_the_urdf(tmp_path) -> None:
    robot = arm_of(tmp_path, base=COVER, p3=COVER)
    made = collision_model(robot)
    assert ("base", "p3", "never") in made.left_out
    made.save(tmp_path / "arm.collisions.toml")
    assert link_model(robot.with_limits(lower=-0.5)).left_out == made.left_out
    wide = link_model(robot.with_limits(lower=-2.5, upper=2.5))  # the arm folds back
    assert [(wide.bodies[a].link, wide.bodies[b].link) for a, b, _ in wide.watched or ()] == [
        ("base", "p3")
    ]


def test_a_controller_warns_of_links_that_no_row_watches(tmp_path, monkeypatch) -> None:
    # Look for pairs that may meet in few postures: this is about the links.
    monkeypatch.setattr(collision, "make_collision_model", partial(make_collision_model, samples=9))
    robot = arm_of(tmp_path, p1=MASS, p2=MASS + COVER, p3=MASS + DRAWN)
    avoidance = iiwa_dnn.CollisionAvoidance([BALL])
    still = iiwa_dnn.FixedPose().anchored(iiwa_dnn.Configuration(robot, np.zeros(3)))
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
    ("name", "links"),
    [("ur5", ("forearm_link", "wrist_2_link")), ("iiwa7", ("iiwa7_link_5", "iiwa7_link_7"))],
)
def test_a_close_pair_moves_and_its_shapes_do_not_touch(name, links) -> None:
    """Bodies of a wrist overlap before its links touch: a shield lets them, and no further."""
    robot = iiwa_dnn.load_robot(name).with_limits(acceleration=10.0)
    random = np.random.default_rng(1)
    start = robot.start_posture()
    goals = [
        q for q in robot.draw(random, 2000) if frozenset(links) in touching_links(robot, q[None])
    ]
    assert len(goals) > 10
    for goal in goals[:4]:
        shield = iiwa_dnn.Shield(robot, 0.01, obstacles=[])
        path = [start]
        bent = np.where(np.arange(robot.dof) < robot.dof - 3, start, goal)
        for _ in range(600):
            path.append(path[-1] + 0.01 * shield.step(path[-1], position=bent).dq)
        assert not touching_links(robot, np.array(path[::5]))[frozenset(links)]
        assert np.abs(path[-1] - start).max() > 0.3


BALL_BESIDE = """<collision><origin xyz='0.55 0.2 0'/><geometry><sphere radius='0.05'/></geometry>
</collision>"""
BALL_FAR = BALL_BESIDE.replace("0.55 0.2", "0.85 0.3")
WALL = """<collision><origin xyz='0.3 0.5 0'/><geometry><box size='2 0.04 1.6'/></geometry>
</collision>"""


def srdf(folder: Path, *pairs: str) -> None:
    """Write an SRDF file beside `arm_of` that disables pairs of links."""
    lines = "".join(
        "<disable_collisions link1='{}' link2='{}' reason='{}'/>".format(*each.split())
        for each in pairs
    )
    (folder / "arm.srdf").write_text(f"<robot name='arm'>{lines}</robot>")


@pytest.mark.filterwarnings("ignore:capsules and pairs")
def test_an_srdf_file_is_believed_unless_the_shapes_meet(tmp_path) -> None:
    robot = arm_of(tmp_path, base=BALL_BESIDE + BALL_FAR, p1=COVER, p2=BALL_OF_P2, p3=BALL_OF_P2)
    assert make_collision_model(robot).left_out == (
        ("base", "p1", "adjacent"),
        ("p1", "p2", "adjacent"),
        ("p1", "p3", "never"),
        ("p2", "p3", "adjacent"),
    )
    srdf(tmp_path, "p2 base User", "p3 p1 Never")
    model = make_collision_model(robot)
    assert ("base", "p2", "may meet, disabled: User") in model.left_out
    assert ("p1", "p3", "never") in model.left_out
    assert model.unguarded == [("base", "p2")]
    said = "these links may meet, and are not kept apart everywhere: base and p2$"
    limited = robot.with_limits(acceleration=10.0)
    with pytest.warns(UserWarning, match=said):
        iiwa_dnn.Shield(limited, obstacles=[])
    given = iiwa_dnn.CollisionAvoidance(may_touch=[("p2", "base")])
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=(iiwa_dnn.CollisionAvoidance(),))
    with pytest.warns(UserWarning, match=said):
        iiwa_dnn.Controller(robot, scheme)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        iiwa_dnn.Shield(limited, obstacles=given)
        iiwa_dnn.Shield(limited)
    srdf(tmp_path, "p2 base User", "p3 base User")
    alone = arm_of(tmp_path, base=BALL_BESIDE + BALL_FAR, p2=BALL_OF_P2)
    with pytest.raises(
        iiwa_dnn.InvalidInputError,
        match=f"no pair is watched; {said}",
    ):
        iiwa_dnn.Shield(alone.with_limits(acceleration=10.0), obstacles=[])
    (tmp_path / "arm.srdf").write_text("<robot>")
    with pytest.raises(iiwa_dnn.errors.FileError, match=r"arm.srdf: .*no element"):
        make_collision_model(robot)


@pytest.mark.filterwarnings("ignore:capsules and pairs")
def test_a_table_that_is_a_link_is_kept_as_one_that_is_an_obstacle(tmp_path) -> None:
    box = iiwa_dnn.Box([0.3, 0.5, 0.0], [1.0, 0.02, 0.8])
    one = arm_of(tmp_path, base=WALL, p2=COVER, p3=COVER)
    table = iiwa_dnn.CollisionAvoidance().scene(one)
    (tmp_path / "b").mkdir()
    other = arm_of(tmp_path / "b", p2=COVER, p3=COVER)
    obstacle = iiwa_dnn.CollisionAvoidance([box], self_collision=False).scene(other)
    assert table.pairs == [("base", "p3")]  # p2 never comes near
    assert obstacle.pairs[-1] == ("Box 1", "p3")
    postures = one.draw(np.random.default_rng(0), 50)
    found = [scene.distances(postures, np.zeros(50)) for scene in (table, obstacle)]
    np.testing.assert_allclose(found[0][:, 0], found[1][:, -1], atol=1e-5)


@pytest.mark.parametrize("size", [(1.0, 0.8, 0.02), (0.6, 0.1, 0.1), (0.3, 0.3, 0.3)])
def test_capsules_of_a_cut_shape_hold_all_of_it(size) -> None:
    """Points drawn inside of a box, far from its corners too, are in one of its capsules."""
    *capsules, box = fit_bodies([(coal.Box(*size), pin.SE3.Identity())])
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (2000, 3)) * size
    away = []
    for body in capsules:
        a, b = body.ends
        along = np.clip((points - a) @ (b - a) / max((b - a) @ (b - a), 1e-12), 0.0, 1.0)
        away.append(np.linalg.norm(points - a - along[:, None] * (b - a), axis=1) - body.radius)
    assert np.min(away, axis=0).max() < 1e-9
    sphere = 4.0 / 3.0 * np.pi * (np.linalg.norm(size) / 2.0) ** 3
    assert sum(body.volume for body in capsules) <= sphere * (1.0 + 1e-6)
    assert sorted(2.0 * box.box.half_extents) == pytest.approx(sorted(size))
