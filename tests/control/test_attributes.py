"""An attribute that can be set holds, or is refused by name; so does a part, in each object."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from iiwa_dnn import export
from iiwa_dnn.schemes.parts import Limit
from judge_distances import swinging

DT = 2e-3
ROBOT = d.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
ACCELERATED = d.load_robot("iiwa7").with_limits(acceleration=10.0)
START = np.array(ROBOT.start_posture())
BALL = d.Sphere([0.36, 0.16, 0.64], 0.05)
TWIST = [0.1, 0.0, 0.0, 0.0, 0.0, 0.0]


class Slow(Limit):
    """At most 0.1 rad/s, in numpy."""

    def bounds(self, step: Any) -> tuple[np.ndarray, np.ndarray]:
        return np.full(step.q.size, -0.1), np.full(step.q.size, 0.1)


class SlowRows(Limit):
    """The same as rows."""

    rows = 14

    def inequalities(self, step: Any) -> tuple[np.ndarray, np.ndarray]:
        return np.vstack([np.eye(7), -np.eye(7)]), np.full(14, 0.1)


class Wall(Limit):
    """The tip stays on its side of a plane across x, in numpy, by the frame that it asks for."""

    rows = 1

    def inequalities(self, step: Any) -> tuple[np.ndarray, np.ndarray]:
        tip = step.frame()
        return tip.jacobian[:1], np.array([5.0 * (0.45 - tip.position[0])])


def values(random: np.random.Generator) -> list[Any]:
    """Return values of any kind, some of which an attribute may have."""
    return [
        float(random.choice([0.0, -1.0, 1e-3, 4e-3, 0.05, np.nan, np.inf])),
        int(random.integers(-1, 4000)),
        None,
        True,
        ROBOT.with_limits(velocity=0.05),
        d.load_robot("ur5"),
        d.DoubleIndicator(orientation="none"),
        d.DoubleIndicator(extra_limits=(d.AccelerationLimits([1.0, 2.0]),)),
        (d.JointLimits(), d.AccelerationLimits(5.0)),
        (),
        [Slow()],
        "slow",
        "continuous",
        "iiwa7_link_5",
        np.zeros(4000),
        d.Sphere([1.0, 0.0, 0.5], 0.1),
        d.DNNSolver(tol=1e-8),
        object(),
    ]


def public(made: Any) -> list[str]:
    """List the public attributes of an object, and one that it has not."""
    return [name for name in dir(made) if not name.startswith("_")] + ["timeuot"]


def shield_step(shield: d.Shield, k: int) -> np.ndarray:
    own: dict[str, Any] = {"twist": TWIST, "frame": "iiwa7_link_5"} if k % 2 else {"dq": np.ones(7)}
    return shield.step(START, **own).dq


def shields_step(shields: d.Shields, k: int) -> np.ndarray:
    q = np.tile(START, (shields.count, 1))
    return shields.step(q, np.ones(q.shape)).dq


def controller_step(controller: d.Controller, k: int) -> np.ndarray:
    pose = d.Configuration(controller.robot, controller.robot.start_posture())
    return controller.step(pose.q, k * DT, d.Target(pose.position, pose.rotation)).dq


MADE: dict[str, Any] = {
    "shield": (lambda: d.Shield(ROBOT, DT, [BALL]), shield_step),
    "shields": (lambda: d.Shields(ROBOT, 3, dt=DT, obstacles=[BALL]), shields_step),
    "controller": (lambda: d.Controller(ROBOT, d.DoubleIndicator(), dt=DT), controller_step),
}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("seed", range(3))
def test_a_fuzz_over_all_attributes_ends_in_errors_of_the_package(name: str, seed: int) -> None:
    """A shield's delay and the number of shields ended the process."""
    make, step = MADE[name]
    random = np.random.default_rng(seed)
    made = make()
    for k in range(150):
        attribute = random.choice(public(made))
        value = random.choice(np.array([*values(random), None], dtype=object))
        before = vars(made).get(attribute)
        try:
            setattr(made, attribute, value)
            assert name == "controller" or attribute in ("limits", "threads")
        except (d.IiwaDnnError, AttributeError):
            assert vars(made).get(attribute) is before
        if k % 10 == 0:
            made = pickle.loads(pickle.dumps(copy.deepcopy(made)))
        try:
            assert np.isfinite(step(made, k)).all()
        except d.IiwaDnnError:
            assert name == "controller"


@pytest.mark.parametrize("name", ["shield", "shields"])
def test_attributes_that_are_set_once_stay(name: str) -> None:
    make, step = MADE[name]
    made, twin = make(), make()
    for attribute in ("robot", "dt", "delay", "settings", "count", "frame", "timeuot"):
        with pytest.raises(d.InvalidInputError, match=f"^{attribute}: cannot be set, as"):
            setattr(made, attribute, ROBOT)
        np.testing.assert_array_equal(step(made, 0), step(twin, 0))
    if name == "shield":
        with pytest.raises(ValueError, match="read-only"):
            made.settings.delay = 0.05


def test_what_a_command_shows_of_a_shield_is_its_own() -> None:
    shield = d.Shield(ROBOT, DT)
    command = shield.step(START, np.full(7, 0.5))
    margin = command.margin
    for name in ("memory", "layout"):
        with pytest.raises(AttributeError):
            setattr(command, name, np.zeros(2))
    for array in (command.memory, command.state.numbers, ROBOT.limits):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 9.0
    command.dq[:] = command.next_q[:] = 9.0
    assert command.margin == margin
    twin = d.Shield(ROBOT, DT)
    twin.step(START, np.full(7, 0.5))
    answers = [each.step(START, np.full(7, 0.5)).dq for each in (shield, twin)]
    np.testing.assert_array_equal(*answers)


def test_the_threads_of_shields_may_be_set() -> None:
    shields = d.Shields(ROBOT, 3, dt=DT)
    shields.threads = 2
    assert shields.threads == 2
    with pytest.raises(d.InvalidInputError, match="threads: must be a whole number"):
        shields.threads = 0


@pytest.mark.parametrize(
    ("attribute", "value"),
    [
        ("dt", 1.0),
        ("longest_period", 1e-4),
        ("robot", d.load_robot("ur5")),
        ("scheme", d.DoubleIndicator(extra_limits=(d.AccelerationLimits([1.0, 2.0]),))),
    ],
)
def test_settings_of_a_controller_that_do_not_fit_each_other_are_refused(
    attribute: str, value: Any
) -> None:
    """They were taken, and each later step failed while the arm moved on."""
    scheme = d.DoubleIndicator(extra_limits=(d.AccelerationLimits([1.0] * 7),))
    controller = d.Controller(ROBOT, scheme, dt=DT, longest_period=2.0 * DT)
    first = controller_step(controller, 0)
    before = getattr(controller, attribute)
    with pytest.raises(d.InvalidInputError):
        setattr(controller, attribute, value)
    assert getattr(controller, attribute) is before
    assert controller_step(controller, 1).shape == first.shape


# ---- Parts in Python


def driven(
    shield: d.Shield, start: np.ndarray = START, steps: int = 600, **request: Any
) -> np.ndarray:
    path = [start]
    for _ in range(steps):
        path.append(path[-1] + DT * shield.step(path[-1], **request).dq)
    return np.array(path)


@pytest.mark.parametrize("limit", [Slow(), SlowRows()])
@pytest.mark.parametrize("robot", [ACCELERATED, ROBOT, d.load_robot("panda")])
def test_a_limit_in_numpy_holds_in_a_shield(robot: d.Robot, limit: Limit) -> None:
    """It was never called: 1 rad/s went for 0.1; later the jerk limits let 0.105 go."""
    shield = d.Shield(robot, DT)
    shield.limits += (limit,)
    start = np.array(robot.start_posture())
    for request in ({"dq": np.ones(7)}, {"position": start + 0.3}, {"twist": TWIST}):
        speeds = np.abs(np.diff(driven(shield, start, **request), axis=0)) / DT
        assert 0.09 < speeds.max() <= 0.1 + 1e-9
        shield.reset()


@pytest.mark.parametrize("limit", [Slow(), SlowRows()])
def test_a_limit_in_numpy_holds_in_a_controller(limit: Limit) -> None:
    controller = d.Controller(ROBOT, d.DoubleIndicator(extra_limits=(limit,)), dt=DT)
    pose = d.Configuration(ROBOT, START)
    target = d.Target(pose.position + [0.1, 0.1, 0.0], pose.rotation)
    q, speeds = START, []
    for k in range(600):
        command = controller.step(q, k * DT, target)
        q = command.next_q
        speeds.append(np.abs(command.dq).max())
    assert 0.09 < max(speeds) <= 0.1 + 1e-9


def test_an_arm_that_a_limit_in_numpy_finds_too_quick_slows_down() -> None:
    """No motion to rest is within the bounds at once; none may go further beyond them."""
    shield = d.Shield(ROBOT, DT)

    class Sudden(Slow):
        def bounds(self, step: Any) -> tuple[np.ndarray, np.ndarray]:
            return tuple(bound * (1.0 if step.t > 0.5 else 5.0) for bound in super().bounds(step))

    shield.limits += (Sudden(),)
    speeds = np.abs(np.diff(driven(shield, dq=np.ones(7)), axis=0)) / DT
    assert speeds[200:250].min() > 0.4
    assert (speeds[252:300].max(axis=0) <= 0.5 + 1e-9).all()
    assert 0.09 < speeds[-100:].min() <= speeds[-100:].max() <= 0.1 + 1e-9


def test_rows_in_numpy_hold_in_a_shield_by_its_own_kinematics() -> None:
    shield = d.Shield(ACCELERATED.with_limits(acceleration=np.inf), DT)
    x = [
        d.Configuration(ROBOT, q).position[0] for q in driven(shield, steps=800, twist=TWIST)[::20]
    ]
    assert max(x) > 0.5
    shield = d.Shield(ACCELERATED.with_limits(acceleration=np.inf), DT)
    shield.limits += (Wall(),)
    x = [
        d.Configuration(ROBOT, q).position[0] for q in driven(shield, steps=800, twist=TWIST)[::20]
    ]
    assert 0.44 < max(x) < 0.45 + 1e-4


def test_an_obstacle_that_moves_in_its_own_way_is_where_it_is_in_a_shield() -> None:
    """It went on at its velocity, away from where it is; judged by its own places."""
    center = d.Configuration(ROBOT, START).position + [0.0, 0.35, 0.0]
    ball = swinging(d.Sphere, rate=2.0)(center, 0.05, velocity=[0.0, -0.3, 0.0])
    shield = d.Shield(ROBOT, DT, [ball])
    scene = d.CollisionAvoidance([ball]).scene(ROBOT)
    path = driven(shield, steps=1000, dq=np.zeros(7))
    found = [scene.nearest(path[k][None], np.array([k * DT]))[0][0] for k in range(0, 1000, 20)]
    assert min(found) > 0.0
    command = shield.step(path[-1])
    own, _ = scene.nearest(command.log.q[None], np.array([1000 * DT]))
    assert command.margin.distance == pytest.approx(own[0] - 0.02, abs=1e-9)


def test_what_a_part_raises_changes_nothing_and_it_may_not_step() -> None:
    shield = d.Shield(ACCELERATED, DT)

    class Asks(Slow):
        fails = False

        def bounds(self, step: Any) -> Any:
            if self.fails:
                shield.step(START)
            return super().bounds(step)

    shield.limits += (Asks(),)
    twin = copy.deepcopy(d.Shield(ACCELERATED, DT))
    twin.limits += (Slow(),)
    for k in range(60):
        Asks.fails = k % 3 == 1
        if Asks.fails:
            for call in (shield.step, shield.reset):
                with pytest.raises(d.InvalidInputError, match="shield: is within a step"):
                    shield.step(START, np.ones(7))
                del call
            continue
        a, b = (each.step(START, np.ones(7)).dq for each in (shield, twin))
        np.testing.assert_array_equal(a, b)


def with_limits(*limits: Any) -> d.Shield:
    shield = d.Shield(ACCELERATED, DT)
    shield.limits = limits
    return shield


REFUSED: dict[str, Any] = {
    "parts: are in Python: Slow": lambda: d.Shields(with_limits(d.JointLimits(), Slow()), 2),
    "parts: are in Python, which C": lambda: export.c99(with_limits(d.JointLimits(), Slow()), "x"),
    "parts: are in Python: Sphere": lambda: d.Shields(
        ROBOT, 2, dt=DT, obstacles=[swinging(d.Sphere)([2.0, 0.0, 0.0], 0.1, velocity=[0.1, 0, 0])]
    ),
    "limits: need a JointLimits": lambda: with_limits(),
    "limits: have several CollisionAvoidance": lambda: with_limits(
        d.JointLimits(), d.CollisionAvoidance([BALL]), d.CollisionAvoidance([])
    ),
    "limits: must be an iiwa_dnn.Limit": lambda: with_limits(d.JointLimits(), d.PoseTask()),
    "limits: must be a list": lambda: setattr(d.Shield(ACCELERATED, DT), "limits", 3),
    "acceleration: must have shape": lambda: with_limits(
        d.JointLimits(), d.AccelerationLimits([1.0, 2.0])
    ),
}


@pytest.mark.parametrize("words", REFUSED)
def test_a_combination_without_a_meaning_is_refused_by_name(words: str) -> None:
    with pytest.raises(d.InvalidInputError, match=f"^{words}"):
        REFUSED[words]()


def test_limits_that_are_refused_leave_those_of_before() -> None:
    shield = d.Shield(ACCELERATED, DT)
    before = shield.limits
    with pytest.raises(d.InvalidInputError):
        shield.limits = (d.JointLimits(), d.AccelerationLimits([1.0, 2.0]))
    assert shield.limits is before
    assert np.abs(driven(shield, steps=50, dq=np.ones(7))).max() > 0.0


def test_rates_of_the_limits_count_where_a_position_is_approached() -> None:
    """Those of the robot did, which may have none: the arm went beyond the request."""
    shield = d.Shield(d.load_robot("iiwa7"), DT)
    shield.limits = (d.JointLimits(), d.AccelerationLimits(2.0))
    goal = START + 0.2
    path = driven(shield, steps=1500, position=goal)
    assert (path <= goal + 1e-9).all()
    np.testing.assert_allclose(path[-1], goal, atol=1e-6)


def test_the_margins_of_many_arms_are_arrays() -> None:
    shields = d.Shields(ROBOT, 5, dt=DT, obstacles=[BALL])
    assert all(np.isnan(each).all() for each in shields.margin())  # nobody knows where they are
    q = START + 0.1 * np.random.default_rng(0).standard_normal((5, 7))
    shields.step(q, np.zeros((5, 7)))
    found = shields.margin()
    assert found.joint.shape == found.distance.shape == (5,)
    for i in range(5):
        assert (found.joint[i], found.distance[i]) == shields.margin(i)[:2]


@pytest.mark.parametrize("name", ["dt", "robot", "limits"])
def test_attributes_cannot_be_deleted(name: str) -> None:
    shield = d.Shield(ROBOT, DT)
    shields = d.Shields(shield, 2)
    controller = d.Controller(ROBOT, d.DoubleIndicator(orientation="none"), dt=DT)
    for made in (shield, shields, controller):
        with pytest.raises(d.InvalidInputError, match=f"{name}: cannot be deleted"):
            delattr(made, name)


def test_a_part_without_kernel_or_method_is_refused_by_name() -> None:
    class Misspelt(Limit):
        def bound(self, step: Any) -> tuple[np.ndarray, np.ndarray]:
            return np.zeros(7), np.zeros(7)

    shield = d.Shield(ROBOT, DT)
    before = shield.limits
    with pytest.raises(d.InvalidInputError, match="Misspelt has no kernel, and no method"):
        shield.limits = (*before, Misspelt())
    assert shield.limits == before


def test_a_chunk_for_many_arms_in_degrees_is_noticed() -> None:
    shields = d.Shields(ROBOT, 2, dt=DT, samples=8)
    shields.step(np.tile(START, (2, 1)), np.zeros((2, 7)))
    degrees = np.tile(np.degrees(START + 0.1), (2, 3, 1))
    with pytest.warns(UserWarning, match="are the positions in degrees"):
        shields.follow([0.1, 0.2, 0.3], degrees)
