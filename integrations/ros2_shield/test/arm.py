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
SILENCE = {"is_silent": True, "patience": 0.02}
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

    def __init__(self, package):
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

    def on_velocity(self, message):
        self.dq = np.array(message.data)
        self.times.append(time.perf_counter())
        self.log.append([0.0, *message.data])

    def on_position(self, message):
        q = np.array(message.points[0].positions)
        if not self.times:  # commands before the discovery are not seen
            self.start = self.q = q
        self.dq = (q - self.q) / self.dt
        self.q = q
        self.times.append(time.perf_counter())
        self.log.append([self.dt, *self.dq])

    def on_state(self, message):
        self.words.add(message.status[0].message)

    def publish(self, message):
        self.publishers_of[type(message)].publish(message)

    def velocity(self, size):
        return Float64MultiArray(data=[size] * len(self.names))

    def show(self, t=None, q=None, names=None):
        """Publish joint states, in another order than the shield's and with a joint more."""
        message = JointState(name=["finger", *(names or self.names)[::-1]])
        message.position = [0.0, *(self.q if q is None else q)[::-1].tolist()]
        message.header.stamp = stamp(t or self.t + self.jump)
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


def hostile(random, arm):
    """Return a request that should not be fulfilled, or None for silence."""
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
    return messages[random.choice(8, p=[0.25, 0.15, 0.2, *5 * [0.08]])]


def drive(arm, seconds):
    """Ask hostile requests for a time of the arm's clock, at 100 Hz, and be a bad sensor at times.

    The node has to say each reason, and to go on after it.
    """
    random = np.random.default_rng(0)
    nan = np.full(len(arm.names), np.nan)
    faults = (*8 * [{}], {"q": nan}, {"names": ["x", *arm.names[1:]]}, SILENCE)
    end = arm.t + seconds
    due = held = arm.t
    moving = 0
    while arm.t < end:
        if arm.t >= held:
            request = hostile(random, arm)
            fault = faults[random.integers(len(faults))]
            held = arm.t + random.choice([0.03, 0.1, 0.2])
            if not fault and random.random() < 0.1:
                arm.jump += random.choice([-50.0, 50.0])
        is_due = arm.t >= due
        due = arm.t + EVERY if is_due else due
        dropped = (random.random() < 0.05) * random.integers(1, 3)
        is_answered = arm.turn(request if is_due else None, 1 + dropped, **fault)
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


def waiting(arm, seconds):
    """Drive the node by a clock that waits for it."""
    arm.create_subscription(Float64MultiArray, "/shield/commands", arm.on_velocity, 1000)
    arm.ask(None, until=lambda: arm.times, patience=0.2)
    drive(arm, seconds)
    check_services(arm)
    print("stop", flush=True)  # the node is ended now, in motion
    arm.ask(None, until=arm.rests, patience=0.5)
    assert arm.rests(), f"the node left the arm moving: {arm.dq}"


def timed(arm, seconds):
    """Ask by the machine's clock; measure periods, and from rest the time until an answer."""
    arm.create_subscription(JointTrajectory, "/shield/commands", arm.on_position, 1000)

    def wait(seconds, request=None, until=lambda: False):
        due = time.perf_counter()
        end = due + seconds
        while time.perf_counter() < end and not until():
            rclpy.spin_once(arm, timeout_sec=0.001)
            if time.perf_counter() >= due:
                due += arm.dt
                arm.show(t=time.time())
                if request is not None:
                    arm.publish(request)

    random = np.random.default_rng(0)
    latencies = []
    wait(PATIENCE, until=lambda: len(arm.log) > 20)
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        wait(random.choice([0.1, 0.4]), hostile(random, arm))
        wait(1.0, arm.velocity(0.0), lambda: np.abs(arm.log[-20:])[:, 1:].max() < 1e-9)
        arm.publish(arm.velocity(0.1 * random.choice([-1.0, 1.0])))
        asked = time.perf_counter()
        wait(0.1, until=lambda: not arm.rests())
        if not arm.rests():
            latencies.append(time.perf_counter() - asked)
    for words, times in (("period", np.diff(arm.times)), ("request to command", latencies)):
        p50, p99 = 1e3 * np.percentile(times, [50, 99])
        print(f"{words}: {len(times)}, p50 {p50:.2f} ms, p99 {p99:.2f} ms", flush=True)
    print("stop", flush=True)


if __name__ == "__main__":
    name, file, seconds, mode = sys.argv[1:]
    rclpy.init()
    arm = Arm(importlib.import_module(name))
    {"waiting": waiting, "timed": timed}[mode](arm, float(seconds))
    np.savez(file, start=arm.start, log=arm.log)
