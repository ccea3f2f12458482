"""A simulated arm and hostile requests, for a shield's node: ``arm.py NAME FILE SECONDS MODE``.

It runs in the environment of the node. ``waiting``: the arm's clock waits for the node's commands,
velocities, so that a judge's verdict does not depend on the machine; a period lasts one control
period, or several where joint states are dropped. ``timed``: the node's timer sets the pace by the
machine's clock, and the arm takes positions. FILE gets the start, and periods and velocities.
"""

import importlib
import sys
import time

import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TwistStamped
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

PATIENCE = 20.0  # for an answer of the node [s]
START = (-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0)
EVERY = 0.01  # period of requests [s]
SILENCE = {"is_silent": True, "patience": 0.15}
REASONS = (
    "request not finite",
    "request of 6 velocities, not 7",
    "is missing",
    "trajectory of 2 points, not one",
    "request in frame 'camera', not 'base_link'",
    "request stamped",
    "request timed out",
    "q not finite",
    "joint states are silent",
    "period of",
)
TOPICS = {
    Clock: "/clock",
    JointState: "/joint_states",
    TwistStamped: "/shield/delta_twist_cmds",
    Float64MultiArray: "/shield/velocity_cmds",
    JointTrajectory: "/shield/position_cmds",
}


def stamp(t):
    return Time(sec=int(t), nanosec=int(t % 1.0 * 1e9))


class Arm(Node):
    """An ideal arm, and whoever asks for motion."""

    def __init__(self, package, is_timed):
        super().__init__("arm")
        self.names = list(package.JOINT_NAMES)
        self.dt = package.DT
        self.limits = package.LIMITS
        self.start = self.q = np.array(START)
        self.dq = np.zeros(len(START))
        self.t = 1000.0
        self.jump = 0.0  # of the clocks
        self.log = []  # periods [s] and velocities [rad/s]
        self.times = []  # of the commands [s]
        self.words = set()  # of the diagnostics
        self.publishers_of = {kind: self.create_publisher(kind, TOPICS[kind], 1) for kind in TOPICS}
        self.create_subscription(DiagnosticArray, "/diagnostics", self.on_state, 10)
        kind = JointTrajectory if is_timed else Float64MultiArray
        take = self.on_position if is_timed else self.on_velocity
        self.create_subscription(kind, "/shield/commands", take, 1000)

    def on_velocity(self, message):
        self.dq = np.array(message.data)
        self.times.append(time.perf_counter())
        self.log.append([0.0, *message.data])

    def on_position(self, message):
        goal = np.array(message.points[0].positions)
        if not self.times:  # commands before the discovery are not seen
            self.start = self.q = goal
        self.on_velocity(Float64MultiArray(data=((goal - self.q) / self.dt).tolist()))

    def on_state(self, message):
        self.words.add(message.status[0].message)

    def publish(self, message):
        self.publishers_of[type(message)].publish(message)

    def velocity(self, size):
        return Float64MultiArray(data=[size] * len(self.names))

    def show(self, q=None, names=None):
        """Publish joint states, in another order than the shield's and with a joint more."""
        message = JointState(name=["finger", *(names or self.names)[::-1]])
        message.position = [0.0, *(self.q if q is None else q)[::-1].tolist()]
        message.header.stamp = stamp(self.t + self.jump)
        self.publish(message)

    def turn(self, request=None, periods=1, patience=PATIENCE, is_silent=False, **shown):
        """Hold the last command for some periods, publish, wait; return whether the next came."""
        if request is not None:
            self.publish(request)
        elapsed = periods * self.dt
        self.q = self.q + elapsed * self.dq
        self.t += elapsed
        if self.log:
            self.log[-1][0] += elapsed
        self.publish(Clock(clock=stamp(self.t + self.jump)))
        if not is_silent:
            self.show(**shown)
        before = len(self.times)
        end = time.perf_counter() + patience
        while len(self.times) == before and time.perf_counter() < end:
            rclpy.spin_once(self, timeout_sec=0.01)
        return len(self.times) > before

    def ask(self, request, turns=200, until=lambda: False, **options):
        """Publish a request in each of some turns, or until something is true."""
        for _ in range(turns):
            self.turn(request, **options)
            if until():
                return

    def rests(self):
        return np.abs(self.dq).max() < 1e-9


def shuffled(random, deck):
    """Draw from a deck that is shuffled again and again."""
    while True:
        yield from (deck[k] for k in random.permutation(len(deck)))


def hostile(random, arm, kind):
    """Return a request of a kind that should not be fulfilled, or None for silence."""
    n = len(arm.names)
    asked = random.choice([1.0, 10.0]) * arm.limits["velocity"] * random.normal(size=n)
    twist = TwistStamped()
    twist.header.frame_id = random.choice(["", "base_link", "camera"])
    twist.header.stamp = stamp(arm.t + arm.jump - random.choice([0.0, 0.01, 0.2]))
    for vector in (twist.twist.linear, twist.twist.angular):
        vector.x, vector.y, vector.z = random.normal(size=3).tolist()
    goal = random.uniform(1.2 * arm.limits["lower"], 1.2 * arm.limits["upper"])
    points = [JointTrajectoryPoint(positions=goal.tolist())]
    messages = (
        Float64MultiArray(data=asked.tolist()),
        JointTrajectory(joint_names=arm.names, points=points),
        twist,
        Float64MultiArray(data=[np.nan] * n),
        Float64MultiArray(data=[1.0] * (n - 1)),
        JointTrajectory(joint_names=arm.names[1:], points=points),
        JointTrajectory(joint_names=arm.names, points=2 * points),
        None,
    )
    return messages[kind]


def drive(arm, seconds):
    """Ask hostile requests for a time of the arm's clock, at 100 Hz, and be a bad sensor at times.

    The node has to say each reason, and to go on after it.
    """
    random = np.random.default_rng(0)
    nan = np.full(len(arm.names), np.nan)
    wrong = [{"q": nan}, {"names": ["x", *arm.names[1:]]}, SILENCE]
    faults = shuffled(random, [*8 * [{}], *wrong])
    kinds = shuffled(random, [0, 0, 0, 1, 1, 2, 2, 3, 4, 5, 6, 7])
    end = arm.t + seconds
    due = held = arm.t
    moving = 0
    is_answered = True
    while arm.t < end:
        has_jumped = False
        if arm.t >= held:
            request = hostile(random, arm, next(kinds))
            fault = next(faults)
            held = arm.t + random.choice([0.03, 0.1, 0.2])
            has_jumped = not fault and is_answered and random.random() < 0.1
            arm.jump += has_jumped * random.choice([-50.0, 50.0])
        # No clock says how long a period was in which it has jumped, and the longest one is stated.
        dropped = random.choice([0, 1, 2], p=[0.95, 0.025, 0.025])
        periods = 1 if fault or has_jumped or not is_answered else 1 + dropped
        is_due = arm.t >= due
        due = arm.t + EVERY if is_due else due
        is_answered = arm.turn(request if is_due else None, periods, **fault)
        assert is_answered or fault is SILENCE, f"no command at {arm.t} s"
        moving += not arm.rests()
    assert moving > 0.5 * len(arm.times), "does not go on after a fault"
    reasons = ";".join(arm.words)
    assert not [each for each in REASONS if each not in reasons], reasons


def call(arm, name):
    """Call a service of the node while the arm goes on; return whether it succeeded."""
    client = arm.create_client(Trigger, f"/shield/{name}")
    assert client.wait_for_service(PATIENCE)
    future = client.call_async(Trigger.Request())
    while not future.done():
        arm.ask(arm.velocity(0.2), 1)
    return future.result().success


def check_services(arm):
    """Check that a moving arm is not reset, and that a halted one waits for a reset."""
    request = arm.velocity(0.2)
    arm.ask(request)
    assert not call(arm, "reset")
    assert call(arm, "halt")
    arm.ask(request)
    assert arm.rests()
    assert call(arm, "reset")
    arm.ask(request, 100)
    assert not arm.rests()
    assert "halted" in arm.words


def measure(arm, seconds):
    """Ask hostile requests; measure periods, and from rest the time until an answer."""
    random = np.random.default_rng(0)
    latencies = []
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        arm.ask(hostile(random, arm, random.integers(8)), random.choice([25, 100]))
        arm.ask(arm.velocity(0.0), until=arm.rests)
        asked = time.perf_counter()
        arm.ask(arm.velocity(0.1 * random.choice([-1.0, 1.0])), 20, lambda: not arm.rests())
        if not arm.rests():
            latencies.append(time.perf_counter() - asked)
    for words, times in (("period", np.diff(arm.times)), ("request to command", latencies)):
        p50, p99 = 1e3 * np.percentile(times, [50, 99])
        print(f"{words}: {len(times)}, p50 {p50:.2f} ms, p99 {p99:.2f} ms", flush=True)


if __name__ == "__main__":
    name, file, seconds, mode = sys.argv[1:]
    rclpy.init()
    arm = Arm(importlib.import_module(name), mode == "timed")
    arm.ask(None, until=lambda: arm.times, patience=0.2)
    if mode == "timed":
        measure(arm, float(seconds))
    else:
        drive(arm, float(seconds))
        check_services(arm)
    print("stop", flush=True)  # the node is ended now, in motion
    arm.ask(None, until=arm.rests, patience=0.5)
    assert arm.rests(), f"the node left the arm moving: {arm.dq}"
    np.savez(file, start=arm.start, log=arm.log)
