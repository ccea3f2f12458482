"""Every command keeps acceleration and jerk limits, whatever asked for it; the path yields."""

import numpy as np
import pytest

import hostile
import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import UNCHECKED, driven, heart, paper_robot, paper_start, run
from iiwa_dnn.schemes.tasks import ROTATION_LENGTH
from iiwa_dnn.step.policies import Action, Policy, ProgramKind
from judge_limits import Breach, breaches

JERK = 500.0
LIMITS = (d.AccelerationLimits(), d.JerkLimits(JERK))
LIMITED = d.DoubleIndicator(extra_limits=LIMITS)


def judged(q: np.ndarray, dt: float = 1e-3, jerk: float = JERK) -> list[Breach]:
    """What the judge says of joint positions of the paper's robot."""
    robot = paper_robot()
    return breaches(q, dt, robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, jerk)


@pytest.mark.parametrize("kind", hostile.STREAMS)
def test_hostile_targets_break_no_limit(kind: str) -> None:
    """And no arm stands for longer than 0.5 s before a target within its reach."""
    robot, dt = paper_robot(), 4e-3
    stream = hostile.streams(robot, np.random.default_rng(5))[kind]
    controller = d.Controller(robot, LIMITED, dt=dt)
    path, commands = driven(controller, PAPER_Q0, 600, stream)
    frozen = 0.0
    for command in commands:
        assert (command.qp.ub >= command.qp.lb).all()
        left = np.linalg.norm(command.log.placement[9:] - command.targets[0, :3])
        stands = np.abs(command.dq).max() < 1e-4
        within = np.linalg.norm(command.targets[0, :3]) < 1.5
        frozen = frozen + dt if stands and within and left > 1e-3 else 0.0
        assert frozen <= 0.5
    assert judged(path, dt) == []


@pytest.mark.parametrize("limits", [LIMITS, LIMITS[:1]])
def test_a_jump_is_made_good_without_swinging(limits: tuple[d.Limit, ...]) -> None:
    start = paper_start()
    controller = d.Controller(paper_robot(), d.DoubleIndicator(extra_limits=limits))
    target = d.Target(start.position + [0.0, -0.05, 0.0], start.rotation)
    path, commands = driven(controller, start.q, 1501, target)
    places = np.array([command.log.placement[9:] for command in commands])
    distance = np.linalg.norm(places - target.position, axis=1)
    assert judged(path, jerk=JERK if len(limits) == 2 else np.inf) == []
    assert distance[-1] < 1e-6
    assert np.diff(distance).max() < 1e-6  # it never moves away
    assert commands[-1].kind is ProgramKind.NOMINAL


def test_near_a_singular_pose_a_path_that_fits_is_caught_up_with() -> None:
    """A circle begins at full speed. Damped for good, it was 0.2 % too slow in all 600 steps."""
    robot, home = paper_robot(), paper_robot().start_posture()
    home[3] = -0.25
    start = d.Configuration(robot, home)
    tasks = [d.PositionTask(gain=5.0), d.OrientationTask(gain=5.0)]
    limits = [d.JointLimits(gain=10.0), d.AccelerationLimits(10.0), d.JerkLimits(300.0)]
    circle = d.Circle(radius=0.02, period=4.0, begin=0.0).anchored(start)
    scheme = d.Scheme([d.KineticEnergy()], tasks, limits)
    _, commands = driven(d.Controller(robot, scheme, circle, dt=2e-3), home, 200)
    actions = [command.action for command in commands]
    weighted = np.repeat([1.0, ROTATION_LENGTH], 3)[:, np.newaxis] * start.jacobian
    assert np.linalg.svd(weighted, compute_uv=False)[-1] < 0.05
    assert Action.SLOW in actions[:50]
    assert set(actions[50:]) == {Action.NONE}


@pytest.mark.parametrize("limits", [(), (d.AccelerationLimits(10.0), d.JerkLimits(300.0))])
def test_a_joint_at_its_velocity_limit_leaves_no_path_slowed_that_fits(limits) -> None:
    """The other joints do what joint 1 cannot; it was 0.2 % too slow in all 600 steps."""
    home = paper_robot().start_posture()
    fastest = paper_robot().dq_max.copy()
    fastest[0] = 0.02
    robot = paper_robot().with_limits(velocity=fastest)
    circle = d.Circle(radius=0.05, period=4.0, begin=0.0).anchored(d.Configuration(robot, home))
    scheme = d.DoubleIndicator(orientation="so3", home=home, extra_limits=limits)
    _, commands = driven(d.Controller(robot, scheme, circle, dt=2e-3), home, 300)
    assert np.mean([abs(command.dq[0]) > 0.02 - 1e-6 for command in commands[100:]]) > 0.5
    assert {command.action for command in commands[100:]} == {Action.NONE}


def test_a_path_beside_position_limits_is_braked_for_in_time() -> None:
    """A velocity wanted up to the limits themselves cost 0.61 s of the path in place of 0.51 s."""
    robot = paper_robot().with_limits(lower=-2.5, upper=2.5)
    scheme = d.DoubleIndicator(extra_limits=(d.AccelerationLimits(10.0),))
    path = d.Heart(scale=0.02, period=6.0).anchored(paper_start())
    controller = d.Controller(robot, scheme, path, dt=2e-3)
    driven(controller, PAPER_Q0, 4000)
    assert controller.path_lag < 0.55


@pytest.mark.parametrize("policy", ["slow", "relax", "stop"])
def test_a_path_that_is_too_quick(policy: Policy) -> None:
    robot, start = paper_robot(), paper_start()
    limited = d.DoubleIndicator(extra_limits=LIMITS[:1])
    fast = d.Heart(scale=0.02, period=6.0).anchored(start)
    record = d.simulate(
        robot, limited, fast, start.q, dt=1e-3, duration=2.0, policy=policy, check=UNCHECKED
    )
    assert judged(record.q, jerk=np.inf) == []
    assert record.action is not None
    if policy == "stop":
        assert record.settings["status"].startswith("stopped")
        assert (record.dq[-1] == 0.0).all()
        assert np.abs(record.dq).max() > 0.01  # it was moving, and braked
        assert d.failures(record)
    else:
        assert record.settings["status"] == "completed"
        expected = Action.SLOW if policy == "slow" else Action.RELAX
        assert set(np.unique(record.action)) <= {Action.NONE, expected}
    if policy == "slow":
        assert record.fraction is not None
        assert 0.1 <= record.fraction.min() < 1.0


@pytest.mark.parametrize(
    "options",
    [
        {"motion": "rk4"},
        {"motion": "midpoint"},
        {"noise": 0.3},
        {"noise": 0.3, "filter_window": 5},
        {"noise": 1e-3, "noise_at": "measurement"},
        {"noise": 0.1, "noise_at": "network"},
        {"noise": np.tile(0.1 + 0.5 * np.sin(0.018 * np.arange(300))[:, np.newaxis], 7)},
        {"mode": "continuous"},
    ],
)
def test_commands_that_something_alters_keep_the_limits(options: dict[str, object]) -> None:
    record: d.Record = run(LIMITED, heart(1.0), duration=0.3, **options)
    assert judged(record.q) == []
    metrics = d.compute_metrics(record)
    assert metrics["acceleration_limit_violation_rad_s2"] == 0.0
    assert metrics["jerk_limit_violation_rad_s3"] == 0.0
    assert np.abs(record.dq).max() > 0.0


@pytest.mark.parametrize("limits", [(), LIMITS[:1]], ids=["none", "acceleration"])
def test_a_stopped_arm_goes_on_where_the_task_has_a_solution_again(limits) -> None:
    start = paper_start()
    scheme = d.DoubleIndicator(extra_limits=limits)
    controller = d.Controller(paper_robot(), scheme, policy="stop")
    far = d.Target(start.position + [0.5, 0.0, 0.0], start.rotation)
    for k in range(3):
        command = controller.step(start.q, 1e-3 * k, far)
        assert command.action is Action.STOP
        assert not command.dq.any()
        assert "limited by joint" in repr(command)
        np.testing.assert_array_equal([command.qp.lb, command.qp.ub], command.bounds)
    near = d.Target(start.position + [1e-5, 0.0, 0.0], start.rotation)
    again = [controller.step(start.q, 3e-3, near), controller.step(start.q, 4e-3, near)]
    for command in again:
        assert command.ok
        velocity = start.jacobian[:3] @ command.dq
        np.testing.assert_allclose(velocity, [10.2e-5, 0.0, 0.0], atol=1e-8)


@pytest.mark.filterwarnings("ignore:.*off their JointCouplingTask")
def test_joints_that_follow_others_brake_within_their_acceleration() -> None:
    """The nearest command that keeps the relation passed the limit by the network's tolerance."""
    robot = d.load_robot("xarm7").with_limits(acceleration=3.0, jerk=np.inf)
    q = np.array(robot.start_posture())
    fifth, sixth = robot.joint_names[4:6]
    relation = d.JointCouplingTask({sixth: 1.0, fifth: -0.5}, offset=q[5] - 0.5 * q[4] + 1e-5)
    tasks = [d.PositionTask(weight=1.0), relation]
    scheme = d.Scheme([d.KineticEnergy()], tasks, [d.JointLimits(), d.AccelerationLimits()])
    far = d.Target(np.array([1.0, -1.0, 2.0]))
    for policy in ("slow", "relax"):
        made = d.Controller(robot, scheme, dt=1e-3, policy=policy)
        path = [q]
        for k in range(150):
            if k == 50:
                made.halt()
            path.append(made.step(path[-1], k * 1e-3, far).next_q)
        assert np.abs(np.diff(path, axis=0)).max() > 4e-5
        assert breaches(np.array(path), 1e-3, *robot.limits) == []


def test_an_arm_that_retreats_contradict_by_less_than_rounding_turns_its_wrist() -> None:
    """Two pairs ask for rates of -1e-10 and -3e-9 m/s, and not both can be had."""
    robot = d.load_robot("ur5").with_limits(acceleration=12.65833663)
    q = np.array([2.53302831846189, 0.937016385900153, 2.5292710037728128])
    q = np.append(q, [-2.0157959554906455, -1.665795739180214, -4.604778754789702])
    for joint in range(3, 6):
        shield = d.Shield(robot, 1e-3, [], 0.02)
        now = q
        for _ in range(200):
            now = shield.step(now, 0.2 * np.eye(6)[joint]).next_q
        assert now[joint] - q[joint] == pytest.approx(0.2 * (0.2 - 0.5 * 0.2 / 12.658), rel=0.02)
        np.testing.assert_allclose(now[:3], q[:3], atol=1e-7)
