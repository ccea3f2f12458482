"""A simulated arm and hostile requests, for a shield's node: ``arm.py NAME FILE SECONDS [timed]``.

It runs in the environment of the node. The arm's clock waits for the node's commands, so that the
judge's verdict does not depend on the machine; a period lasts one control period, or several where
joint states are dropped, and the last command is held throughout. FILE gets periods and commands.
With ``timed`` the node's timer sets the pace by the machine's clock, and FILE gets the positions.
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
TOPICS = {
    Clock: "/clock",
    JointState: "/joint_states",
    TwistStamped: "/shield/delta_twist_cmds",
    Float64MultiArray: "/shield/velocity_cmds",
    JointTrajectory: "/shield/position_cmds",
}


def stamp(t):
    whole = int(t)
    return Time(sec=whole, nanosec=int((t - whole) * 1e9))


class Arm(Node):
    """An ideal arm, and whoever asks for motion."""

    def __init__(self, package, is_timed):
        super().__init__("arm")
        self.names = list(package.JOINT_NAMES)
        self.dt = package.DT
        self.limits = package.LIMITS
        self.q = np.array(START)
        self.dq = np.zeros(len(START))
        self.t = 100.0
        self.log = []  # periods [s] and velocities [rad/s]; timed: times [s] and positions [rad]
        self.latencies = []
        self.words = set()  # of the diagnostics
        self.answers = 0
        self.logged = 0
        self.publishers_of = {kind: self.create_publisher(kind, TOPICS[kind], 1) for kind in TOPICS}
        kind = JointTrajectory if is_timed else Float64MultiArray
        take = self.on_position if is_timed else self.on_velocity
        self.create_subscription(kind, "/shield/commands", take, 1000)
        self.create_subscription(DiagnosticArray, "/diagnostics", self.on_state, 10)

    def on_velocity(self, message):
        self.dq = np.array(message.data)
        self.answers += 1

    def on_position(self, message):
        self.q = np.array(message.points[0].positions)
        self.log.append((time.perf_counter(), *self.q))

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
        message.header.stamp = stamp(self.t if t is None else t)
        self.publish(message)

    def advance(self, periods=1):
        """Hold the last command for some periods."""
        elapsed = periods * self.dt
        self.q = self.q + elapsed * self.dq
        self.t += elapsed
        if self.answers == self.logged and self.log:  # the command before is held on
            self.log[-1][0] += elapsed
        else:
            self.log.append([elapsed, *self.dq])
        self.logged = self.answers
        self.publish(Clock(clock=stamp(self.t)))

    def is_answered(self, patience):
        """Wait for a command; return whether one came."""
        before = self.answers
        begin = time.perf_counter()
        while self.answers == before and time.perf_counter() - begin < patience:
            rclpy.spin_once(self, timeout_sec=0.01)
        self.latencies.append(time.perf_counter() - begin)
        return self.answers > before

    def step(self, periods=1, **shown):
        """Hold the last command, publish joint states, await the next command."""
        self.advance(periods)
        self.show(**shown)
        assert self.is_answered(PATIENCE), f"no command at {self.t} s"

    def ask(self, request, steps=100, until=lambda: False, **shown):
        """Publish a request at each of some steps, or until something is true."""
        self.words.clear()
        for _ in range(steps):
            self.publish(request)
            self.step(**shown)
            if until():
                return

    def says(self, words):
        """Test whether the arm is at rest and the node has said why."""
        return not self.dq.any() and words in ";".join(self.words)


def hostile(random, arm):
    """Return a request that should not be fulfilled, or None for silence."""
    n = len(arm.names)
    kind = random.choice(["velocity", "jump", "position", "twist", "bad", "silence"])
    message = None
    if kind in ("velocity", "jump"):
        asked = (10.0 if kind == "jump" else 1.0) * arm.limits["velocity"] * random.normal(size=n)
        message = Float64MultiArray(data=asked.tolist())
    elif kind == "twist":
        message = TwistStamped()
        for vector in (message.twist.linear, message.twist.angular):
            vector.x, vector.y, vector.z = random.normal(size=3).tolist()
    elif kind == "position":
        span = arm.limits["upper"] - arm.limits["lower"]
        goal = arm.limits["lower"] + span * random.uniform(-0.2, 1.2, n)
        points = [JointTrajectoryPoint(positions=goal.tolist())]
        message = JointTrajectory(joint_names=arm.names, points=points)
    elif kind == "bad":
        point = JointTrajectoryPoint()
        wrong = (
            Float64MultiArray(data=[np.nan] * n),
            Float64MultiArray(data=[1.0] * (n - 1)),
            JointTrajectory(joint_names=arm.names[1:], points=[point]),
            JointTrajectory(joint_names=arm.names, points=[point] * 2),
        )
        message = wrong[random.integers(len(wrong))]
    return message


def drive(arm, seconds, random):
    """Ask hostile requests for a time of the arm's clock."""
    end = arm.t + seconds
    due = held = arm.t
    request = None
    while arm.t < end:
        if arm.t >= held:
            request = hostile(random, arm)
            held = arm.t + random.choice([0.02, 0.1, 0.4, 1.0])
        if arm.t >= due and request is not None:
            due = arm.t + EVERY
            if hasattr(request, "header"):
                request.header.stamp = stamp(arm.t - random.choice([0.0, 0.01, 0.2]))
            arm.publish(request)
        arm.step(1 + (random.random() < 0.05) * random.integers(1, 3))


def check_faults(arm):
    """Check each fault: the arm brakes, the node says why, and goes on afterwards."""
    request = arm.velocity(0.3)
    elsewhere = TwistStamped()
    elsewhere.header.frame_id = "camera"
    faults = {
        "joint positions not finite": (request, {"q": np.full(len(arm.names), np.nan)}),
        f"joint {arm.names[0]!r} is missing": (request, {"names": ["x", *arm.names[1:]]}),
        "request in frame 'camera', not 'base_link'": (elsewhere, {}),
    }
    for words, (asked, shown) in faults.items():
        arm.ask(asked, 400, lambda words=words: arm.says(words), **shown)
        assert arm.says(words), (words, arm.words)
        arm.ask(request)
        assert arm.dq.any(), f"does not go on after: {words}"
    for _ in range(400):  # without joint states the node's timer goes on
        arm.advance()
        arm.is_answered(0.05)
        if arm.says("joint states are silent"):
            break
    assert arm.says("joint states are silent"), arm.words
    arm.step()
    arm.t += 50.0
    arm.ask(request, 1)
    arm.ask(arm.velocity(np.nan), 400, lambda: arm.says("not finite"))
    assert arm.says("not finite"), arm.words


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
    arm.ask(request, 200)
    assert not arm.dq.any()
    assert call(arm, "reset")
    arm.ask(request)
    assert arm.dq.any()


def percentiles(words, times):
    p50, p99 = 1e3 * np.percentile(times, [50, 99])
    print(f"{words}: {len(times)}, p50 {p50:.2f} ms, p99 {p99:.2f} ms", flush=True)


def waiting(arm, file, seconds):
    """Drive the node by a clock that waits for it, check faults and services."""
    end = time.monotonic() + PATIENCE
    found = False
    while not found and time.monotonic() < end:
        arm.advance()
        arm.show()
        found = arm.is_answered(0.2)
    arm.log.clear()
    arm.latencies.clear()
    start = arm.q
    drive(arm, seconds, np.random.default_rng(0))
    percentiles("joint states to command", arm.latencies)
    check_faults(arm)
    check_services(arm)
    print("stop", flush=True)  # the node is ended now, in motion
    end = time.monotonic() + PATIENCE
    while arm.dq.any() and time.monotonic() < end:
        arm.advance()
        arm.show()
        arm.is_answered(0.5)
    assert not arm.dq.any(), "the node left the arm moving"
    np.savez(file, start=start, log=arm.log)


def timed(arm, file, seconds):
    """Let the node's timer pace; the arm takes positions."""
    log = arm.log

    def wait(until, request=None):
        due = time.perf_counter()
        while not until():
            rclpy.spin_once(arm, timeout_sec=0.002)
            if time.perf_counter() >= due:
                due += arm.dt
                arm.show(t=time.time())
                if request is not None:
                    arm.publish(request)

    wait(lambda: log)
    random = np.random.default_rng(0)
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds:
        held = time.perf_counter() + random.choice([0.1, 0.4])
        asked = random.choice([2.0, 20.0]) * random.normal(size=len(arm.names))
        request = Float64MultiArray(data=asked.tolist())
        wait(lambda held=held: time.perf_counter() > held, request)
    percentiles("period", np.diff(np.array(log)[:, 0]))
    latencies = []
    for k in range(20):  # from rest: the time until the commanded positions change
        wait(lambda: len(log) > 50 and log[-1][1:] == log[-20][1:])
        rest = log[-1][1:]
        begin = time.perf_counter()
        arm.publish(arm.velocity(0.1 * (-1.0) ** k))
        wait(lambda rest=rest: log[-1][1:] != rest)
        latencies.append(time.perf_counter() - begin)
    percentiles("request to command", latencies)
    np.savez(file, path=np.array(log)[:, 1:])


if __name__ == "__main__":
    name, file, seconds, *rest = sys.argv[1:]
    rclpy.init()
    run = timed if rest else waiting
    run(Arm(importlib.import_module(name), bool(rest)), file, float(seconds))
