"""Tools and held objects have bodies: distances are kept of them, or what stands for them is said.

The judge is coal: the shapes as they were stated, placed by Pinocchio's model of the bare arm.
"""

import pickle
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from helpers_export import in_armstep, needs
from iiwa_dnn.app import settings
from iiwa_dnn.app.replay import robot_of
from iiwa_dnn.qp import Matrix
from iiwa_dnn.robot import collision
from iiwa_dnn.robot.collision import (
    CLEARANCE,
    collision_model,
    link_model,
    make_collision_model,
    unwatched_links,
)
from iiwa_dnn.robot.mujoco_model import JointDynamics, compile_model
from iiwa_dnn.robot.shapes import visual_shapes
from judge_distances import SLACK, _coal

FR3 = d.load_robot("fr3")
IIWA = d.load_robot("iiwa7").with_limits(acceleration=10.0)
DOWN = [0.0, 0.0, 0.12, 0.0, 0.0, 0.0]
TILTED = [0.06, -0.04, 0.15, 0.4, -0.3, 0.5]
TABLE = d.Box([0.5, 0.0, 0.05], [0.3, 0.5, 0.05])
PEN = d.Capsule([0.0, 0.0, 0.02], [0.0, 0.0, 0.11], 0.01)
LEAST = 0.02


def distances(
    robot: d.Robot, shapes: Sequence[Any], others: Sequence[Any], path: Matrix, links: int = 0
) -> Matrix:
    """Distances of shapes at a bare arm's tip from obstacles, and from its inner links, (k, pairs).

    `links` is the number of the arm's joints whose links count.
    """
    geometry = pin.GeometryModel()
    tip = robot.model.frames[robot.tip_id]
    bodies = [(tip.parentJoint, tip.placement * _coal(each)[1], _coal(each)[0]) for each in shapes]
    bodies += [(0, _coal(each)[1], _coal(each)[0]) for each in others]
    for capsule in link_model(robot).capsules:
        frame = robot.model.frames[robot.frame_id(capsule.link)]
        if frame.parentJoint < links:
            shape, place = _coal(capsule.shape)
            bodies.append((frame.parentJoint, frame.placement * place, shape))
    for number, (joint, place, shape) in enumerate(bodies):
        geometry.addGeometryObject(pin.GeometryObject(str(number), joint, place, shape))
    for k in range(len(shapes)):
        for i in range(len(shapes), len(bodies)):
            geometry.addCollisionPair(pin.CollisionPair(i, k))
    data, scratch = robot.model.createData(), pin.GeometryData(geometry)
    found = []
    for q in path:
        pin.computeDistances(robot.model, data, geometry, scratch, q)
        found.append([each.min_distance for each in scratch.distanceResults])
    return np.array(found)


def driven(shield: d.Shield, q: Any, steps: int, **request: Any) -> Matrix:
    path = [np.array(q)]
    for _ in range(steps):
        path.append(np.array(shield.step(path[-1], **request).next_q))
    return np.array(path)


def said(make: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        make()
    return [str(each.message) for each in caught]


def test_a_tool_without_shapes_is_kept_from_the_table_by_a_capsule_and_that_is_said() -> None:
    robot = d.load_robot("fr3", tool=DOWN)
    with pytest.warns(UserWarning, match="'tool' has no shapes: a capsule of radius 0.05 m from"):
        shield = d.Shield(robot, obstacles=[TABLE], distance=LEAST)
    path = driven(shield, robot.start_posture(), 4000, twist=[0, 0, -0.2, 0, 0, 0])
    assert d.Configuration(robot, path[-1]).position[2] < 0.2
    around = d.Capsule([0.0, 0.0, 0.05], DOWN[:3], 0.05)
    assert distances(FR3, [around], [TABLE], path[::5]).min() > LEAST - SLACK
    assert "tool and Box 1" in next(
        name for name, _ in shield.limits[-1].pairs(robot) if "tool" in name and "Box" in name
    )


@pytest.mark.parametrize("name", ["iiwa7", "fr3", "panda", "ur5"])
@pytest.mark.parametrize(
    "shape",
    [
        d.Sphere([0.03, 0.0, 0.16], 0.04),
        d.Capsule([0.0, 0.0, 0.05], [0.06, -0.04, 0.15], 0.03),
        d.Box([0.03, -0.02, 0.1], [0.08, 0.02, 0.05], pin.exp3(np.array([0.3, 0.2, 0.5])).tolist()),
    ],
    ids=lambda shape: type(shape).__name__,
)
def test_stated_shapes_are_kept_from_what_is_near(name: str, shape: Any) -> None:
    """They come as near as was asked, but for a box, around which a capsule lies."""
    bare = d.load_robot(name).with_limits(acceleration=10.0)
    robot = bare.with_tool(TILTED, tool_shapes=shape)
    q = robot.start_posture()
    ahead = d.Configuration(robot, q).frame(bare.tip)
    ball = d.Sphere(ahead.position + ahead.rotation @ [0.0, 0.0, 0.4], 0.05)
    shield = d.Shield(robot, 2e-3, [ball], LEAST)
    towards = np.concatenate([0.3 * ahead.rotation[:, 2], np.zeros(3)])
    path = driven(shield, q, 1000, twist=towards)
    least = distances(bare, [shape], [ball], path).min()
    assert LEAST - SLACK < least < LEAST + (0.08 if isinstance(shape, d.Box) else 1e-4)
    blind = d.Shield(bare.with_tool(TILTED, tool_shapes=[]), 2e-3, [ball], LEAST)
    assert distances(bare, [shape], [ball], driven(blind, q, 1000, twist=towards)).min() < 0.0


def test_a_tool_is_kept_from_the_links_of_its_own_arm() -> None:
    hook = [d.Capsule([0, 0, 0.05], [0, 0, 0.2], 0.02), d.Capsule([0, 0, 0.2], [0.3, 0, 0.2], 0.02)]
    postures = IIWA.draw(np.random.default_rng(3), 2000)
    meet = distances(IIWA, hook, [], postures, links=6).min(axis=1) < -0.01
    assert meet.sum() > 4
    nearest = []
    for shapes in (hook, []):
        held = IIWA.with_tool(DOWN, tool_shapes=shapes)
        shield = d.Shield(held, 5e-3, [])
        path = [IIWA.start_posture()[np.newaxis]]
        for goal in postures[meet][:4]:
            path.append(driven(shield, path[-1][-1], 500, position=goal))
        nearest.append(distances(IIWA, hook, [], np.concatenate(path), links=6).min())
    assert nearest[0] > LEAST - SLACK
    assert nearest[1] < 0.0


def test_no_shapes_is_a_statement_and_nothing_is_said() -> None:
    none = IIWA.with_tool(DOWN, tool_shapes=[])
    assert said(lambda: d.Shield(none, obstacles=[TABLE])) == []
    assert collision_model(none).capsules == link_model(IIWA).capsules
    turned = IIWA.with_tool(pin.SE3(pin.exp3(np.array([0, 0, 0.5])), np.zeros(3)))  # only the frame
    assert said(lambda: d.Shield(turned, obstacles=[TABLE])) == []
    assert turned.tools[0].shapes == ()
    short = IIWA.with_tool([0.0, 0.0, 0.02, 0.0, 0.0, 0.0])
    (ball,) = short.tools[0].shapes  # the capsule is no longer than the tool
    assert (ball.a, ball.b, ball.radius) == ((0.0, 0.0, 0.02), (0.0, 0.0, 0.02), 0.02)


def test_what_stands_for_a_tool_is_said_once_by_each_object() -> None:
    robot = IIWA.with_tool(DOWN).with_tool(DOWN, "second")
    avoidance = d.CollisionAvoidance([TABLE])
    scheme = d.DoubleIndicator(extra_limits=(avoidance,))
    start = d.Configuration(robot, robot.start_posture())
    path = d.Circle(radius=0.02, period=2.0).anchored(start)

    def run() -> None:
        d.simulate(robot, scheme, path, start.q, dt=1e-2, duration=0.05)

    def controller() -> None:
        made = d.Controller(robot, scheme, path)
        made.scheme = d.DoubleIndicator(extra_limits=(avoidance,))
        made.step(start.q, 0.0)

    def limits_set() -> None:
        shield = d.Shield(robot)
        shield.limits += (avoidance,)
        shield.limits += (d.TipSpeedLimit(0.25),)

    def taken_up() -> None:
        made = d.Controller(IIWA, scheme)
        made.robot = robot

    for make in (run, controller, limits_set, taken_up, lambda: d.Shields(robot, 2, obstacles=[])):
        own = [message for message in said(make) if "has no shapes" in message]
        assert [message.split()[0] for message in own] == ["'tool'", "'second'"]
    assert said(lambda: d.Shield(robot)) == []  # no distance is watched


def test_a_pair_near_in_every_posture_is_not_watched_and_said_unless_nothing_moves_it() -> None:
    tilted = d.load_robot("ur5", tool=[0.1, 0.0, 0.1, 0.0, 0.0, 0.0])
    (words,) = said(lambda: d.Shield(tilted, obstacles=[]))[1:]
    assert words.startswith("nothing keeps tool and wrist_2_link apart: in every posture")
    bare = d.load_robot("ur5")
    shapes = tilted.tools[0].shapes
    path = bare.draw(np.random.default_rng(8), 200)
    wrist = [c for c in link_model(bare).capsules if c.link == "wrist_2_link"]
    apart = distances(bare, shapes, [], path, links=6)
    order = [c for c in link_model(bare).capsules if joint_of(bare, c.link) < 6]
    assert apart[:, [order.index(c) for c in wrist]].max() <= CLEARANCE
    assert apart[:, [k for k, c in enumerate(order) if c not in wrist]].max(axis=0).min() > 0.02
    straight = IIWA.with_tool(DOWN, tool_shapes=d.Capsule([0, 0, 0], DOWN[:3], 0.03))
    assert said(lambda: d.Shield(straight, obstacles=[])) == []
    left_out = d.CollisionAvoidance([]).overview(straight)["left_out"]
    assert ("iiwa7_link_6", "tool", "no joint moves it") in left_out


def joint_of(robot: d.Robot, link: str) -> int:
    return int(robot.model.frames[robot.frame_id(link)].parentJoint)


def test_named_pairs_may_touch_and_all_others_are_watched() -> None:
    robot = FR3.with_tool(DOWN, tool_shapes=PEN)
    touching = d.CollisionAvoidance([TABLE], distance=LEAST, may_touch=[("tool", "Box 1")])
    shield = d.Shield(robot, obstacles=touching)
    path = driven(shield, robot.start_posture(), 3000, twist=[0, 0, -0.2, 0, 0, 0])
    assert distances(FR3, [PEN], [TABLE], path[-1:]).min() < 0.0
    hand = [c.shape for c in link_model(FR3).capsules if c.link == "link7"]
    frame = FR3.model.frames[FR3.tip_id].placement.inverse()
    hand = [d.Capsule(frame.act(np.array(c.a)), frame.act(np.array(c.b)), c.radius) for c in hand]
    assert LEAST - SLACK < distances(FR3, hand, [TABLE], path).min() < LEAST + 1e-3
    assert ("Box 1", "tool", "may touch") in touching.overview(robot)["left_out"]
    with pytest.raises(d.NotFoundError, match="no link or obstacle 'pen'"):
        d.Shield(robot, obstacles=d.CollisionAvoidance([TABLE], may_touch=[("pen", "Box 1")]))
    assert any(name == "tool and link5" for name, _ in touching.pairs(robot))


def test_a_held_object_is_taken_up_from_a_table_and_put_down() -> None:
    bare = IIWA.with_tool(DOWN, "gripper", tool_shapes=PEN)
    q = bare.start_posture()
    hand = d.Configuration(bare, q)
    cup = d.Sphere([0.0, 0.0, 0.03], 0.04)  # in the gripper's frame
    low = hand.position + hand.rotation @ [0.0, 0.0, 0.03]
    table = d.HalfSpace([0.0, 0.0, 1.0], low[2] - 0.04 - 0.001)  # the cup stands on it
    held = bare.with_tool([0.0, 0.0, 0.03, 0.0, 0.0, 0.0], "cup", tool_shapes=cup)
    assert (held.tip, [tool.name for tool in held.tools]) == ("cup", ["gripper", "cup"])
    shield = d.Shield(held, 2e-3, [table], LEAST)
    with pytest.warns(UserWarning, match="HalfSpace 1 and cup are 0.001 m apart at the start"):
        down = driven(shield, q, 200, twist=[0, 0, -0.1, 0, 0, 0])
    up = driven(shield, down[-1], 500, twist=[0, 0, 0.1, 0, 0, 0])
    away = driven(shield, up[-1], 800, twist=[0, 0, -0.1, 0, 0, 0])
    flange = d.load_robot("iiwa7", tool=DOWN)
    apart = [distances(flange, [cup], [table], each) for each in (down, up, away)]
    assert apart[0].min() > 0.001 - 2e-6
    assert apart[1].max() > 0.03
    assert LEAST - SLACK < apart[2].min() < LEAST + 1e-4
    empty = d.Shield(bare, 2e-3, [table], LEAST)  # put down: the cup is no longer there
    lower = driven(empty, away[-1], 500, twist=[0, 0, -0.1, 0, 0, 0])
    assert distances(flange, [cup], [table], lower).min() < 0.015


def test_each_robot_has_the_bodies_of_its_own_tools() -> None:
    one = IIWA.with_tool(DOWN, tool_shapes=PEN)
    two = one.with_tool(pin.SE3(np.eye(3), np.array([0, 0, 0.05])), "cup", tool_shapes=[PEN, PEN])
    links = len(link_model(IIWA).capsules)
    for robot, count in ((IIWA, 0), (one, 1), (two, 3), (one.with_limits(velocity=0.5), 1)):
        again = pickle.loads(pickle.dumps(robot))
        for each in (robot, again):
            names = [capsule.link for capsule in collision_model(each).capsules[links:]]
            assert names == ["tool", "cup", "cup"][:count]
            assert unwatched_links(each) == ()
    # In the frame of its flange each: the cup's body is 5 cm behind its own tip.
    last = collision_model(two).capsules[-1].shape
    np.testing.assert_allclose(last.a, np.array(PEN.a) - [0, 0, 0.05], atol=1e-12)


@pytest.mark.filterwarnings("ignore:capsules and pairs of")
def test_pairs_of_links_are_searched_once_for_all_tools(tmp_path: Path, monkeypatch) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(IIWA.urdf or "")
    made: list[d.Robot] = []

    def search(robot: d.Robot, **options: Any) -> Any:
        made.append(robot)
        return make_collision_model(robot, samples=9, **options)

    monkeypatch.setattr(collision, "make_collision_model", search)
    robot = d.load_robot(path, tip="iiwa7_flange", tool=DOWN, tool_shapes=PEN)
    held = robot.with_tool(DOWN, "cup", tool_shapes=PEN).with_limits(acceleration=1.0)
    links = [link_model(each) for each in (robot, held, d.load_robot(path, tip="iiwa7_flange"))]
    assert links[0] is links[1] is links[2]
    assert [each.tools for each in made] == [()]
    assert len(collision_model(held).capsules) == len(links[0].capsules) + 2
    assert link_model(held.with_limits(upper=0.5)) is not links[0]


def test_the_other_arm_of_two_keeps_away_from_a_tool() -> None:
    robot = d.load_robot("iiwa7_dual", tool=DOWN, tool_shapes=PEN)
    pairs = d.CollisionAvoidance([]).scene(robot).pairs
    assert {"tool", "right_iiwa7_link_7"} in map(set, pairs)
    inner = d.load_robot("fr3", "link4", FR3.joint_names[4:], DOWN, tool_shapes=PEN)
    watched = {name for pair in d.CollisionAvoidance([]).scene(inner).pairs for name in pair}
    assert "tool" in watched
    assert not {("link5", "tool"), ("link7", "tool")} & {
        *d.CollisionAvoidance([]).scene(inner).pairs
    }


def test_an_arm_without_shapes_keeps_its_tool_away_and_names_its_links(tmp_path: Path) -> None:
    text = IIWA.urdf or ""
    bare = tmp_path / "bare.urdf"
    start, *rest = text.split("<collision")
    bare.write_text(start + "".join(part.partition("</collision>")[2] for part in rest))
    robot = d.load_robot(bare, tip="iiwa7_flange", tool=DOWN, tool_shapes=PEN)
    shield = d.Shield(robot, obstacles=[TABLE])
    assert list(shield.limits[-1].scene(robot).pairs) == [("Box 1", "tool")]
    assert "iiwa7_link_7" in unwatched_links(robot)
    with pytest.warns(UserWarning, match="nothing keeps these links clear.*iiwa7_link_7"):
        shield.step(robot.start_posture())
    unknown = d.load_robot(IIWA.model, tool=DOWN, tool_shapes=PEN)
    with pytest.raises(d.InvalidInputError, match="must come from a URDF file"):
        d.Shield(unknown, obstacles=[TABLE])
    avoidance = d.CollisionAvoidance([TABLE])
    made = d.Controller(robot, d.DoubleIndicator(extra_limits=(avoidance,)))
    with pytest.raises(d.InvalidInputError, match="must come from a URDF file"):
        made.robot = unknown
    assert made.robot is robot


@needs("gcc")
def test_a_tool_goes_into_the_exported_step(tmp_path: Path) -> None:
    robot = FR3.with_tool(TILTED, tool_shapes=[PEN, d.Sphere(TILTED[:3], 0.03)])
    avoidance = d.CollisionAvoidance([TABLE], distance=LEAST)
    scheme = d.DoubleIndicator(orientation="none", extra_limits=(avoidance,))
    made = d.Controller(robot, scheme, dt=5e-3)
    exported = in_armstep(made, tmp_path)
    q = robot.start_posture()
    start = d.Configuration(robot, q)
    deep = d.Target(start.position - [0.0, 0.0, 0.6], start.rotation)
    first = made.step(q, 0.0, deep).dq
    path = [q]
    for k in range(600):
        path.append(path[-1] + 5e-3 * exported.step(path[-1], 0.0, deep.data).dq)
        if k == 0:
            np.testing.assert_allclose(path[-1], q + 5e-3 * first, atol=1e-11)
    shapes = robot.tools[0].shapes
    least = distances(FR3, shapes, [TABLE], np.array(path)).min()
    assert LEAST - SLACK < least < LEAST + 1e-3
    assert any("tool" in name and "Box 1" in name for name in exported.tables.limit_names)


def test_tools_are_drawn_and_weigh_nothing_in_physics() -> None:
    pytest.importorskip("mujoco")
    box = d.Box([0.0, 0.0, 0.05], [0.1, 0.02, 0.03])
    robot = IIWA.with_tool(DOWN, tool_shapes=[PEN, box, d.Sphere([0, 0, 0.1], 0.02)])
    model, bare = (compile_model(each, 1e-3, JointDynamics()) for each in (robot, IIWA))
    assert model.ngeom == bare.ngeom + 3
    np.testing.assert_array_equal(model.body_mass, bare.body_mass)
    np.testing.assert_array_equal(model.body_inertia, bare.body_inertia)
    shapes = visual_shapes(robot)
    assert shapes.ngeoms == visual_shapes(IIWA).ngeoms + 3
    place = shapes.geometryObjects[-2].placement
    flange = IIWA.model.frames[IIWA.tip_id].placement
    np.testing.assert_allclose(place.translation, flange.act(np.array(box.center)), atol=1e-12)
    tool = model.geom("tool_1")
    assert (tool.bodyid[0], tool.size.tolist()) == (
        model.body("iiwa7_link_7").id,
        [0.1, 0.02, 0.03],
    )


def test_tool_shapes_are_settings_of_a_run_and_of_its_record(tmp_path: Path) -> None:
    tables = {"shape": "capsule", "a": [0, 0, 0], "b": [0, 0, 0.1], "radius": 0.02}
    robot = settings.load({"name": "iiwa7", "tool": DOWN, "tool_shapes": [tables]})
    assert robot.tools[0].shapes == (d.Capsule([0, 0, 0], [0, 0, 0.1], 0.02),)
    held = robot.with_tool(TILTED, "cup", tool_shapes=[])
    start = d.Configuration(held, robot.start_posture())
    path = d.Circle(radius=0.02, period=2.0).anchored(start)
    record = d.simulate(held, d.DoubleIndicator(), path, start.q, dt=1e-2, duration=0.05)
    record.save(tmp_path / "record.npz")
    again = robot_of(d.Record.load(tmp_path / "record.npz").settings, tmp_path / "none.toml")
    assert [tool.shapes for tool in again.tools] == [tool.shapes for tool in held.tools]
    np.testing.assert_allclose(d.Configuration(again, start.q).pose, start.pose, atol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"tool_shapes": [d.HalfSpace([0, 0, 1], 0.0)]}, "must be a Sphere, Capsule or Box each"),
        ({"tool_shapes": "pen"}, "must be a Sphere, Capsule or Box each"),
        ({"tool_shapes": 0.05}, "must be a Sphere, Capsule or Box each"),
        ({"tool_shapes": d.Sphere([0, 0, 0], 0.1, velocity=[0, 0, 1])}, "no velocity of its own"),
        ({"name": "iiwa7_link_3"}, "the robot has a frame 'iiwa7_link_3' already"),
        ({"name": 3}, "name: must be"),
        ({"name": "Box 1"}, "name: must not be an obstacle's"),
    ],
)
def test_a_wrong_tool_is_refused_by_name(arguments: dict[str, Any], problem: str) -> None:
    with pytest.raises(d.InvalidInputError, match=problem) as caught:
        IIWA.with_tool(DOWN, **arguments)
    assert "\n" not in str(caught.value)


def test_shapes_without_a_tool_are_refused() -> None:
    with pytest.raises(d.InvalidInputError, match="tool_shapes: are a tool's"):
        d.load_robot("iiwa7", tool_shapes=[PEN])
