"""A simulated arm and hostile requests, for a shield's node: ``arm.py TABLES FILE SECONDS MODE``.

It runs in the environment of the node. ``simulated``: /clock waits for the node's commands,
velocities, so that a judge's verdict does not depend on the machine; a period lasts one control
period, or several. ``timed``: both go by the machine's clock, and the arm takes positions and shows
them late. ``near`` and ``remote``: simulated, no faults but those of a bad network of the latter.
``moving``: simulated, of an arm that moves before the node begins. ``people``: simulated, beside a
person who approaches, and is seen over a bad network. FILE gets the start, periods and velocities,
and where the person was.
"""

import sys
import time

import armstep
import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped, TwistStamped
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

PATIENCE = 20.0  # for an answer of the node [s]
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
GOOD = ("velocities", "positions", "twist")
LATE = 10  # periods by which a timed arm shows its positions late
TOPICS = {
    Clock: "/clock",
    JointState: "/joint_states",
    TwistStamped: "/shield/delta_twist_cmds",
    Float64MultiArray: "/shield/velocity_cmds",
    JointTrajectory: "/shield/position_cmds",
}
FRAME = 8  # periods between two frames of people
HOME = np.array([2.2, 0.3, 0.6])  # of a person [m]
NEAR = np.array([0.45, 0.15, 0.6])  # where the person goes [m]
WALK = 1.6  # [m/s]
TRAJECTORIES = "/shield/joint_trajectory"
POSES = "/shield/pose_target_cmds"


def stamp(ns):
    return Time(sec=ns // 10**9, nanosec=ns % 10**9)


class Arm(Node):
    """An ideal arm, and whoever asks for motion."""

    def __init__(self, tables, mode):
        super().__init__("arm")
        self.is_remote = mode in ("remote", "people", "bodies")
        self.on_its_way = []  # messages and the times of their arrival
        self.random = np.random.default_rng(0)
        self.names = list(tables.joint_names)
        self.dt = tables.dt
        self.limits = tables.limits
        self.is_timed = mode == "timed"
        self.path = [START]
        self.dq = np.zeros(len(START))
        self.t = 1000.0
        self.speed = 0.2  # that is requested for checks [rad/s]
        self.log = []  # periods [s] and velocities [rad/s]
        self.times = []  # of the commands [s]
        self.said = [""]  # by the diagnostics
        topics = TOPICS | {PoseArray: f"/shield/{'bodies' if mode == 'bodies' else 'people'}"}
        self.publishers_of = {kind: self.create_publisher(kind, topics[kind], 1) for kind in topics}
        self.trajectories = self.create_publisher(JointTrajectory, TRAJECTORIES, 1)
        self.poses = self.create_publisher(PoseStamped, POSES, 1)
        self.shield = None  # of the same tables, for its kinematics
        names = ("halt", "reset")  # found long before they are called: the arm would time out
        self.services_of = {each: self.create_client(Trigger, f"/shield/{each}") for each in names}
        self.create_subscription(DiagnosticArray, "/diagnostics", self.on_state, 10)
        # The node receives states of both reliabilities.
        if not self.is_timed:
            states = (JointState, TOPICS[JointState], qos_profile_sensor_data)
            self.publishers_of[JointState] = self.create_publisher(*states)
        kind = JointTrajectory if self.is_timed else Float64MultiArray
        self.create_subscription(kind, "/shield/commands", self.on_command, 1000)

    def on_state(self, message):
        self.said.append(message.status[0].message)

    def on_command(self, message):
        if self.is_timed:
            goal = np.array(message.points[0].positions)
            # Commands before the discovery are not seen.
            self.path.append(self.path[-1] if self.times else goal)
            self.dq = (goal - self.path[-1]) / self.dt
            self.path.append(goal)
        else:
            self.dq = np.array(message.data)
        self.times.append(time.perf_counter())
        self.log.append([self.dt * self.is_timed, *self.dq])

    def publish(self, message):
        """Publish a message; over the network of a remote arm late, unordered, twice or not."""
        is_far = self.is_remote and not isinstance(message, Clock)
        copies = self.random.choice([0, 1, 2], p=[0.2, 0.7, 0.1]) if is_far else 1
        for _ in range(copies):
            is_late = is_far and self.random.random() < 0.7
            self.on_its_way.append((self.t + is_late * self.random.uniform(0.04, 0.12), message))
        arrived = [each for each in self.on_its_way if each[0] <= self.t]
        self.on_its_way = [each for each in self.on_its_way if each[0] > self.t]
        for _, each in sorted(arrived, key=lambda pair: pair[0]):
            self.publishers_of[type(each)].publish(each)

    def now(self):
        """Return the time of the clock [ns]."""
        return time.time_ns() if self.is_timed else round(1e9 * self.t)

    def velocity(self, size):
        return Float64MultiArray(data=[size] * len(self.names))

    def show(self, q=None, names=None, at=None):
        """Publish joint states, in another order than the shield's and with a joint more."""
        message = JointState(name=["finger", *(names or self.names)[::-1]])
        shown = self.path[-min(1 + LATE * self.is_timed, len(self.path))]
        message.position = [0.0, *(shown if q is None else q)[::-1].tolist()]
        message.header.stamp = stamp(self.now() if at is None else at)
        self.publish(message)
        self.publish(JointState(name=["gripper"], position=[0.0]))  # of its own, on this topic

    def wait(self, until, patience=PATIENCE):
        end = time.perf_counter() + patience
        while not until() and time.perf_counter() < end:
            rclpy.spin_once(self, timeout_sec=0.01)
        return until()

    def turn(self, request=None, periods=1, patience=PATIENCE, is_silent=False, **shown):
        """Hold the last command for some periods, publish, wait for the next command."""
        self.t = round(self.t + periods * self.dt, 9)  # /clock has nanoseconds
        if request is not None:
            self.publish(request)
        if not self.is_timed:
            self.path.append(self.path[-1] + periods * self.dt * self.dq)
            for row in self.log[-1:]:
                row[0] += periods * self.dt
            self.publish(Clock(clock=stamp(self.now())))
        if not is_silent:
            self.show(**shown)
        before = len(self.times)
        return self.wait(lambda: len(self.times) > before, patience)

    def ask(self, request, turns=50, until=lambda: False, **options):
        """Publish a request in each of some turns, or until something is true."""
        for _ in range(turns):
            self.turn(request, **options)
            if until():
                return

    def start(self, request):
        """Ask for a motion, and check that the arm moves, if not at once on a busy machine."""
        self.ask(request)
        self.ask(request, 400, lambda: not self.rests())
        assert not self.rests(), self.said[-1]

    def rests(self):
        return np.abs(self.dq).max() < 1e-9


def cases(random, arm):
    """Return requests, and arguments of a turn that shows wrong joint states.

    Their names are the reasons, if any, that the node has to say.
    """
    n = len(arm.names)
    asked = random.choice([1.0, 10.0]) * arm.limits["velocity"] * random.normal(size=n)
    goal = random.uniform(1.2 * arm.limits["lower"], 1.2 * arm.limits["upper"])
    points = [JointTrajectoryPoint(positions=goal.tolist())]
    twists = [TwistStamped() for _ in range(3)]
    twists[1].header.frame_id = "camera"
    twists[2].header.stamp = stamp(arm.now() - 10**9)
    for twist in twists:
        for vector in (twist.twist.linear, twist.twist.angular):
            vector.x, vector.y, vector.z = random.normal(size=3).tolist()
    good = arm.velocity(arm.speed)
    return {
        "velocities": (Float64MultiArray(data=asked.tolist()), {}),
        "positions": (JointTrajectory(joint_names=arm.names, points=points), {}),
        "twist": (twists[0], {}),
        "request in frame 'camera', not 'base_link'": (twists[1], {}),
        "request stamped in the past": (twists[2], {}),
        "request not finite": (arm.velocity(np.nan), {}),
        "request of 6 velocities, not 7": (Float64MultiArray(data=[1.0] * (n - 1)), {}),
        "request without joint": (JointTrajectory(joint_names=["x"], points=points), {}),
        "request of 0 points, not one": (JointTrajectory(joint_names=arm.names), {}),
        "request timed out": (None, {}),
        "joint states not finite": (good, {"q": np.full(n, np.nan)}),
        "joint states without joint": (good, {"names": ["x", *arm.names[1:]]}),
        "joint states with a joint twice": (good, {"names": [*arm.names[1:], arm.names[1]]}),
        "joint states timed out": (good, {"is_silent": True}),
        "joint states stamped in the past": (good, {"at": arm.now()}),  # it freezes
        "joint states stamped in the future": (good, {"at": arm.now() + 3600 * 10**9}),
    }


def drive(arm, seconds):
    """Ask hostile requests in each period, and be a bad sensor at times."""
    random = np.random.default_rng(0)
    held = arm.t
    moving = 0
    while len(arm.times) < seconds / arm.dt:
        # No clock says how long a period was in which it has jumped, and the longest one is stated.
        periods = random.choice([1, 2, 3], p=[0.95, 0.025, 0.025])
        if arm.t >= held:
            jump = random.choice([0.0, 50.0], p=[0.9, 0.1])
            periods = 1 if jump else periods
            arm.t += jump
            name = random.choice([*6 * GOOD, *cases(random, arm)])
            request, shown = cases(random, arm)[name]
            held = arm.t + (0.6 if "timed out" in name else random.choice([0.03, 0.1]))
        assert arm.turn(request, periods, **shown), f"no command at {arm.t} s"
        moving += not arm.rests()
    assert moving > 0.3 * len(arm.times), "does not go on after a fault"
    assert arm.is_timed or any("period not within" in words for words in arm.said)


def rove(arm, seconds):
    """Ask for velocities that change twice a second, for a number of seconds."""
    random = np.random.default_rng(0)
    end = arm.t + seconds
    while arm.t < end:
        asked = random.choice([-1.0, 1.0], 7) * random.uniform(0.3, 3.0) * arm.limits["velocity"]
        arm.ask(Float64MultiArray(data=asked.tolist()), 125)
    assert not any("does not follow" in words for words in arm.said)


def visit(arm, seconds):
    """Let a person come until the arm has rested for a while, and go, for a number of seconds.

    Frames come late, unordered, twice or not; some have no meaning. Return the person's places
    before and after each period, and the arm's positions and velocities in it, (k, 6 + 2 n).
    """
    random = np.random.default_rng(1)
    place, goal = HOME, NEAR
    places = []
    rested = 0
    moves = [0, 0]  # periods in motion with the person there, and gone
    end = arm.t + seconds
    while arm.t < end:
        if len(places) % 60 == 0:
            signs = random.choice([-1.0, 1.0], 7)
            request = Float64MultiArray(data=(0.5 * signs * arm.limits["velocity"]).tolist())
        if len(places) % FRAME == 0:
            x, y, z = place.tolist()
            frame = PoseArray(poses=[Pose(position=Point(x=x, y=y, z=z))])
            frame.header.stamp = stamp(arm.now())
            arm.publish(random.choice([frame, frame, *nonsense(arm)], p=[0.4, 0.4] + 4 * [0.05]))
        held = [*arm.path[-1], *arm.dq]
        assert arm.turn(request)
        way = goal - place
        step = min(WALK * arm.dt, np.linalg.norm(way))
        last, place = place, place + step * way / max(np.linalg.norm(way), 1e-9)
        places.append([*last, *place, *held])
        rested = rested + 1 if arm.rests() else 0
        is_gone = int(goal is HOME and step == 0.0)
        moves[is_gone] += not arm.rests()
        if rested > 100 and goal is NEAR:
            goal = HOME
        elif is_gone and random.random() < 0.005:
            goal = NEAR
    assert min(moves) > 100, moves
    arm.ask(request, 1000, arm.rests)
    assert arm.rests(), "goes on without news of people"
    assert any("separation" in words for words in arm.said), set(arm.said)
    return places


def nonsense(arm):
    """Return frames of people that are none: nobody there, if they counted."""
    frames = [PoseArray() for _ in range(4)]
    now = arm.now()
    for frame, at in zip(frames, (0, now + 10**9, now, now), strict=True):
        frame.header.stamp = stamp(at)
    frames[2].poses = [Pose(position=Point(x=np.nan))]  # of a body that has a name: unseen
    frames[3].header.frame_id = "camera"
    return frames


def begin_in_motion(arm):
    """Check that a node waits for an arm to move steadily, and brakes from its velocity."""
    steady = 0.3 * arm.limits["velocity"] * np.sign(-START - 1e-3)
    waits = False
    for k in range(2000):
        arm.dq = steady * (-1.0) ** (k // 10)
        arm.turn(patience=0.02)
        waits = waits or any(words.startswith("waits until") for words in arm.said)
        if waits and k > 100 and k % 20 == 19:
            break
    assert waits
    assert not arm.times
    arm.dq = steady
    arm.wait(lambda: False, 1.0)  # the node may be some ticks behind
    arm.ask(None, 150, lambda: arm.times, patience=0.3)
    arm.ask(None, 200, arm.rests)
    assert arm.rests()
    arm.log[:0] = 2 * [[arm.dt, *steady]]


def check_reasons(arm):
    """Check that a moving arm comes to rest for each reason, which is said, and goes on."""
    random = np.random.default_rng(0)
    for words in cases(random, arm):
        arm.speed = -arm.speed
        arm.start(arm.velocity(arm.speed))
        request, shown = cases(random, arm)[words]
        if words not in GOOD:
            arm.ask(request, 200, arm.rests, **shown)
            assert arm.rests(), words
            assert arm.wait(lambda words=words: words in arm.said[-1]), arm.said[-1]


def call(arm, name):
    """Call a service of the node while the arm goes on; return whether it succeeded."""
    client = arm.services_of[name]
    assert client.wait_for_service(PATIENCE)
    future = client.call_async(Trigger.Request())
    while not future.done():
        arm.ask(arm.velocity(0.2), 1)
    return future.result().success


def follow(arm, ways, seconds):
    """Ask for a trajectory of displacements (m, n) [rad] that lasts some seconds, and wait longer.

    Return the times since then [s], and displacements.
    """
    begun = arm.t
    start = arm.path[-1]
    points = []
    for k, way in enumerate(ways, 1):
        point = JointTrajectoryPoint(positions=(start + way).tolist())
        point.time_from_start.nanosec = round(1e9 * k * seconds / len(ways)) % 10**9
        point.time_from_start.sec = round(1e9 * k * seconds / len(ways)) // 10**9
        points.append(point)
    message = JointTrajectory(joint_names=arm.names, points=points)
    message.header.stamp = stamp(arm.now())
    arm.trajectories.publish(message)
    first = len(arm.path)
    times = []
    while arm.t < begun + seconds + 1.0:
        arm.turn()
        times.append(arm.t - begun)
    return np.array(times), np.array(arm.path[first:]) - start


def check_trajectory(arm):
    """Check that a trajectory is followed without lag, and that one that is left is ended."""
    arm.ask(arm.velocity(0.0), 200, arm.rests)
    arm.ask(arm.velocity(0.0), 50)
    signs = -np.sign(arm.path[-1] + 1e-3)

    def way(t):
        u = np.clip(np.atleast_1d(t) / 1.5, 0.0, 1.0)[:, np.newaxis]
        return 0.3 * signs * u**3 * (10.0 - 15.0 * u + 6.0 * u * u)

    times, ways = follow(arm, way(0.1 * np.arange(1, 16)), 1.5)
    off = np.abs(ways - way(times - 2.0 * arm.dt)).max()
    print(f"trajectory: {1e3 * off:.2f} mrad off", flush=True)
    assert off < 0.01
    np.testing.assert_allclose(ways[-1], 0.3 * signs, atol=1e-6)
    _, ways = follow(arm, -np.outer([0.5, 1.0], signs), 0.05)  # too quick
    assert arm.wait(lambda: arm.said[-1].startswith("trajectory left: constraints."))
    assert arm.rests()
    arm.start(arm.velocity(0.2))


def check_poses(arm):
    """Check that poses at 30 Hz are followed a sample late, and one out of reach is refused."""
    arm.ask(arm.velocity(0.0), 200, arm.rests)
    arm.ask(arm.velocity(0.0), 50)
    place, rotation, _ = arm.shield.frame_at(arm.path[-1])
    w = 0.5 * np.sqrt(max(1.0 + np.trace(rotation), 1e-9))
    x, y, z = (rotation - rotation.T)[[2, 0, 1], [1, 2, 0]] / (4.0 * w)
    begun = arm.t
    sent = 0.0

    def goal(t):
        return place + np.array([0.0, 0.0, 0.03 * np.sin(2.0 * max(t, 0.0)) ** 2])

    off = []
    while arm.t < begun + 3.0:
        if arm.t - begun >= sent:
            message = PoseStamped()
            message.header.stamp = stamp(arm.now())
            here = message.pose.position
            here.x, here.y, here.z = goal(arm.t - begun).tolist()
            turn = message.pose.orientation
            turn.x, turn.y, turn.z, turn.w = map(float, (x, y, z, w))
            arm.poses.publish(message)
            sent += 1.0 / 30.0
        arm.turn()
        tip = arm.shield.frame_at(arm.path[-1])[0]
        off.append(np.linalg.norm(tip - goal(arm.t - begun - 1.0 / 30.0 - 2.0 * arm.dt)))
    print(f"poses: {1e3 * np.median(off):.2f} mm off, at most {1e3 * max(off):.2f}", flush=True)
    assert np.median(off) < 2e-3
    assert max(off) < 6e-3
    message.pose.position.x = 3.0
    message.header.stamp = stamp(arm.now())
    arm.poses.publish(message)
    arm.ask(None, 200, lambda: arm.said[-1] == "request of a pose out of reach")
    assert arm.said[-1] == "request of a pose out of reach"
    arm.ask(None, 200, arm.rests)
    assert arm.rests()
    arm.start(arm.velocity(0.2))


def check_held(arm):
    """Check that a halted arm waits for a reset, and one that does not follow its commands.

    A moving one is not reset.
    """
    request = arm.velocity(0.2)
    random = np.random.default_rng(0)
    for words in ("halted", "does not follow its commands"):
        arm.start(request)
        assert not call(arm, "reset")
        if words == "halted":
            assert call(arm, "halt")
        stuck = arm.path[-1]
        for _ in range(2000 * (words != "halted")):
            arm.turn(request, q=stuck + 2e-5 * random.standard_normal(len(stuck)))
            if words in arm.said[-1]:
                break
        arm.ask(request, 200, arm.rests)
        arm.ask(request)
        assert arm.rests(), words
        assert words in arm.said[-1]
        assert call(arm, "reset")
        arm.start(request)


def check_clock(arm):
    """Check that an arm comes to rest while its clock stands still, and goes on."""
    request = arm.velocity(-0.2)
    for _ in range(2):
        arm.start(request)
        assert arm.wait(arm.rests)
        assert arm.wait(lambda: arm.said[-1] == "clock stands still")
    arm.start(request)
    arm.t -= 50.0
    arm.turn(request)


def measure(arm, count):
    """Print periods, and from rest the time until a request is answered, of a number of them."""
    latencies = []
    for k in range(count):
        arm.ask(arm.velocity(0.0), 200, arm.rests)
        asked = time.perf_counter()
        arm.ask(arm.velocity(0.1 * (-1.0) ** k), 20, lambda: not arm.rests())
        latencies.append(time.perf_counter() - asked)
    for words, times in (("period", np.diff(arm.times)), ("request to command", latencies)):
        p50, p99 = 1e3 * np.percentile(times, [50, 99])
        print(f"{words}: {len(times)}, p50 {p50:.2f} ms, p99 {p99:.2f} ms", flush=True)


if __name__ == "__main__":
    name, file, seconds, mode = sys.argv[1:]
    rclpy.init()
    arm = Arm(armstep.load_tables(name), mode)
    arm.shield = armstep.Shield(name)
    if mode == "moving":
        begin_in_motion(arm)
    else:
        arm.ask(None, 200, lambda: arm.times, patience=0.1)
        arm.wait(lambda: False, 0.2)  # for the commands of earlier ticks
        arm.log = arm.log[-1:]
    if mode in ("near", "remote"):
        rove(arm, float(seconds))
    places = visit(arm, 4.0 * float(seconds)) if mode in ("people", "bodies") else []
    if mode in ("simulated", "timed"):
        drive(arm, float(seconds))
        check_reasons(arm)
        if mode == "simulated":
            check_trajectory(arm)
            check_poses(arm)
        check_held(arm)
    np.savez(file, start=arm.path[0], log=arm.log, places=places)
    if mode == "simulated":
        check_clock(arm)
    if arm.is_timed:
        measure(arm, int(4 * float(seconds)))
        arm.ask(arm.velocity(0.2))
    print("stop", flush=True)  # the node is ended now, in motion, its clock stands still
    assert arm.wait(arm.rests), f"the node left the arm moving: {arm.dq}"
