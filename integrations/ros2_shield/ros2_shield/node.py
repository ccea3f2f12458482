"""A ROS 2 node between requests and an arm's controllers, around an exported shield.

The shield is a package that ``iiwa-dnn export --python NAME`` made. docs/integrations.md has the
topics and parameters.
"""

import gc
import importlib
import signal
import sys
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TwistStamped
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NEWEST = QoSProfile(depth=1)
"""Reliable and volatile, as joint_state_broadcaster publishes; the last message alone counts."""

LEAST = 1e-6
"""Shortest period that a shield is told [s]."""

PARAMETERS: dict[str, tuple[Any, str, tuple[float, float] | None]] = {
    "shield": ("", "name of the package that iiwa-dnn exported", None),
    "command": ("velocity", "what is sent: velocity, position or trajectory", None),
    "pacing": ("joint_states", "what begins a period: joint_states or timer", None),
    "base_frame": ("base_link", "frame of the twists that are accepted", None),
    "timeout": (0.1, "age up to which a request counts [s]", (1e-3, 10.0)),
    "delay": (0.0, "time by which the drives are behind their commands [s]", (0.0, 1.0)),
    "longest_period": (0.0, "longest period to reckon with [s]; 0: the shield's", (0.0, 1.0)),
    "report_rate": (10.0, "rate of the diagnostics [1/s]", (0.1, 100.0)),
}
"""Default, meaning and range of each parameter."""

CHOICES = {"command": ("velocity", "position", "trajectory"), "pacing": ("joint_states", "timer")}


class RefusedError(Exception):
    """A message or a parameter that cannot be used; the text says why."""


@dataclass
class Request:
    """The request that counts: its kind and numbers, none of them for a reason."""

    kind: str = ""
    numbers: Any = None
    reason: str = "no request"
    times: tuple[float, ...] = ()  # of its stamp and its arrival [s]


@dataclass
class Cycle:
    """What one period leaves for the next."""

    time: float = 0.0  # of the last command [s]
    command: Any = None  # the last one
    sent: list[tuple[float, Any]] = field(default_factory=list)  # periods [s], velocities [rad/s]
    measured: Any = None  # joint positions since then [rad]
    seen: float = 0.0  # time of the last joint states [s]
    fault: str = "no joint states"
    request: Request = field(default_factory=Request)
    reason: str = ""  # why the arm brakes
    longest: float = 0.0  # longest period since the last report [s]


def seconds(stamp: Any) -> float:
    """Return the time of a stamp [s]."""
    return Time.from_msg(stamp).nanoseconds * 1e-9


class ShieldNode(Node):
    """Keep an arm within its limits whatever is requested."""

    def __init__(self, **options: Any) -> None:
        """Read the parameters, load the shield, subscribe and advertise.

        Raises:
            RefusedError: A parameter has no such value, or the shield does not fit to it.
        """
        super().__init__("shield", **options)
        own = {name: self._parameter(name, *each) for name, each in PARAMETERS.items()}
        try:
            package = importlib.import_module(own["shield"])
        except (ImportError, ValueError) as error:
            raise RefusedError(f"parameter shield: {own['shield']!r}: {error}") from error
        self._shield = package.Shield()
        self._joints = package.JOINT_NAMES
        self._dt = package.DT
        self._varies = package.LONGEST_PERIOD is not None
        self._longest = own["longest_period"] or package.LONGEST_PERIOD or package.DT
        if own["command"] == "velocity" and self._longest > (package.LONGEST_PERIOD or 0.0):
            known = f"the shield is made for {package.LONGEST_PERIOD or 'constant periods'}"
            raise RefusedError(f"parameter longest_period: {self._longest} s, but {known}")
        self._patience = max(self._longest - self._dt, 1.5 * self._dt)
        self._own = own
        self._cycle = Cycle()
        self._columns: dict[tuple[str, ...], list[int]] = {}
        self._subscribe()
        kind = JointTrajectory if own["command"] == "trajectory" else Float64MultiArray
        self._commands = self.create_publisher(kind, "~/commands", NEWEST)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.create_service(Trigger, "~/halt", self._on_halt)
        self.create_service(Trigger, "~/reset", self._on_reset)
        self.create_timer(self._dt, self._on_timer)
        self.create_timer(1.0 / own["report_rate"], self._report)

    def _parameter(self, name: str, default: Any, text: str, span: Any) -> Any:
        """Declare a parameter that is set at the start alone; return its value."""
        about = ParameterDescriptor(description=text, read_only=True)
        if span:
            lowest, highest = span
            about.floating_point_range = [FloatingPointRange(from_value=lowest, to_value=highest)]
        value = self.declare_parameter(name, default, about).value
        if name in CHOICES and value not in CHOICES[name]:
            raise RefusedError(f"parameter {name}: {value!r} is none of {CHOICES[name]}")
        return value

    def _subscribe(self) -> None:
        """Subscribe to the joint states and to each kind of request."""
        takers = {
            "~/delta_twist_cmds": (TwistStamped, self._twist),
            "~/velocity_cmds": (Float64MultiArray, self._velocity),
            "~/position_cmds": (JointTrajectory, self._position),
        }
        for topic, (kind, take) in takers.items():
            self.create_subscription(kind, topic, self._taking(take), NEWEST)
        self.create_subscription(JointState, "/joint_states", self._on_joint_states, NEWEST)

    # ---- Requests

    def _taking(self, take: Any) -> Any:
        """Return a callback that keeps a request, or the reason why it is none."""

        def callback(message: Any) -> None:
            now = self._now()
            stamp = seconds(message.header.stamp) if hasattr(message, "header") else 0.0
            try:
                kind, numbers = take(message)
                if not np.isfinite(numbers).all():
                    raise RefusedError("request not finite")
                times = (stamp, now) if stamp else (now,)
                self._cycle.request = Request(kind, numbers, "", times)
            except RefusedError as error:
                self._cycle.request = Request(reason=str(error))

        return callback

    def _twist(self, message: TwistStamped) -> tuple[str, Any]:
        frame = message.header.frame_id
        if frame not in ("", self._own["base_frame"]):
            raise RefusedError(f"request in frame {frame!r}, not {self._own['base_frame']!r}")
        linear, angular = message.twist.linear, message.twist.angular
        numbers = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
        return "twist", np.array(numbers)

    def _velocity(self, message: Float64MultiArray) -> tuple[str, Any]:
        count = len(self._joints)
        if len(message.data) != count:
            raise RefusedError(f"request of {len(message.data)} velocities, not {count}")
        return "dq", np.array(message.data)

    def _position(self, message: JointTrajectory) -> tuple[str, Any]:
        if len(message.points) != 1:
            raise RefusedError(f"trajectory of {len(message.points)} points, not one")
        return "position", self._ordered(message.joint_names, message.points[0].positions)

    def _ordered(self, names: Any, positions: Any) -> Any:
        """Return positions in the order of the shield's joints, by their names."""
        key = tuple(names)
        if key not in self._columns:
            missing = [each for each in self._joints if each not in key]
            if missing:
                raise RefusedError(f"joint {missing[0]!r} is missing")
            self._columns[key] = [key.index(each) for each in self._joints]
        if len(positions) != len(key):
            raise RefusedError(f"{len(positions)} positions of {len(key)} joints")
        return np.array(positions)[self._columns[key]]

    def _asked(self, now: float) -> tuple[dict[str, Any], str]:
        """Return the request that counts at a time [s], or the reason why the arm brakes."""
        request = self._cycle.request
        ages = [now - each for each in request.times]
        if request.times and max(ages) > self._own["timeout"]:
            self._cycle.request = request = Request(reason="request timed out")
        elif request.times and min(ages) < -self._own["timeout"]:
            self._cycle.request = request = Request(reason="request from the future")
        if request.reason:
            return {"dq": np.zeros(len(self._joints))}, request.reason
        return {request.kind: request.numbers}, ""

    # ---- Periods

    def _now(self) -> float:
        return float(self.get_clock().now().nanoseconds * 1e-9)

    def _on_joint_states(self, message: JointState) -> None:
        cycle = self._cycle
        cycle.seen = self._now()
        cycle.fault = ""
        try:
            measured = self._ordered(message.name, message.position)
            if not np.isfinite(measured).all():
                raise RefusedError("joint positions not finite")
            cycle.measured = measured
        except RefusedError as error:
            cycle.fault = str(error)
        if self._own["pacing"] == "joint_states":
            self._step(seconds(message.header.stamp) or cycle.seen)

    def _on_timer(self) -> None:
        """Begin a period of the node's clock, or one that joint states fail to begin."""
        cycle = self._cycle
        now = self._now()
        is_paced = self._own["pacing"] == "timer"
        if now - cycle.seen > (self._own["timeout"] if is_paced else self._patience):
            cycle.fault = "joint states are silent"
            is_paced = True
        if is_paced:
            self._step(now)

    def _step(self, now: float) -> None:
        """Send the command of a period that begins at a time [s]."""
        cycle = self._cycle
        if cycle.command is None and (cycle.fault or cycle.measured is None):
            return
        shield = self._shield
        elapsed = now - cycle.time if cycle.command else self._dt
        cycle.longest = max(cycle.longest, elapsed)
        if cycle.fault:
            cycle.request = Request(reason=cycle.fault)
        elif not 0.0 < elapsed <= self._longest * (1.0 + 1e-6):
            cycle.request = Request(reason=f"period of {elapsed:.6g} s")
        said = cycle.reason
        request, cycle.reason = self._asked(now)
        if self._own["command"] == "velocity":
            elapsed = min(max(elapsed, LEAST), self._longest)
            request["elapsed"] = elapsed
        else:
            elapsed = self._dt
            if self._varies:
                request["dt"] = elapsed
        cycle.command = shield.step(self._positions(elapsed), **request)
        cycle.measured = None
        cycle.time = now
        self._send(cycle.command)
        if cycle.reason != said:
            self._report()

    def _positions(self, elapsed: float) -> Any:
        """Return measured positions with the way that is still to come, or the commanded ones."""
        cycle = self._cycle
        if cycle.command is None:
            return cycle.measured
        last = cycle.command.dq
        cycle.sent = [(elapsed, last), *cycle.sent]
        way = 0.0 * last
        left = self._own["delay"]
        for k, (period, dq) in enumerate(cycle.sent):
            if left <= 0.0:
                del cycle.sent[k:]
                break
            way += min(left, period) * dq
            left -= period
        if cycle.measured is None:
            return cycle.command.next_q + (elapsed - self._dt) * last
        return cycle.measured + way

    def _send(self, command: Any) -> None:
        """Publish a command in the form of the parameter."""
        kind = self._own["command"]
        if kind != "trajectory":
            numbers = command.dq if kind == "velocity" else command.next_q
            self._commands.publish(Float64MultiArray(data=numbers.tolist()))
            return
        point = JointTrajectoryPoint(positions=command.next_q.tolist())
        point.time_from_start.nanosec = round(1e9 * self._dt)
        message = JointTrajectory(joint_names=self._joints, points=[point])
        self._commands.publish(message)

    # ---- Halt, reset, state

    def _on_halt(self, _: Any, response: Any) -> Any:
        self._shield.halt()
        response.success = True
        response.message = "brakes until ~/reset"
        return response

    def _on_reset(self, _: Any, response: Any) -> Any:
        """Forget a halt and the request, if the arm is at rest."""
        response.success = self.is_at_rest
        response.message = (
            "waits for requests" if self.is_at_rest else "the arm moves: ~/halt first"
        )
        if self.is_at_rest:
            self._shield.reset()
            self._cycle = Cycle()
        return response

    @property
    def is_at_rest(self) -> bool:
        """Test whether the last command was zero, or there was none."""
        return self._cycle.command is None or not self._cycle.command.dq.any()

    def come_to_rest(self, executor: Any) -> str:
        """Brake within the limits; return why that was not possible, or nothing."""
        self._shield.halt()
        end = time.monotonic() + 1.0
        if not self.is_at_rest:
            end += 2.0 * self._cycle.command.stopping_time
        while not self.is_at_rest and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.01)
        return "" if self.is_at_rest else f"velocities left: {self._cycle.command.dq.round(4)}"

    def _report(self) -> None:
        cycle = self._cycle
        status = DiagnosticStatus(name=f"{self.get_name()}: {self._own['shield']}")
        command = cycle.command
        if command is None:
            status.level = DiagnosticStatus.STALE
            status.message = cycle.fault
        else:
            limits = command.active_limits
            status.level = (
                DiagnosticStatus.ERROR
                if cycle.reason
                else DiagnosticStatus.WARN
                if limits
                else DiagnosticStatus.OK
            )
            status.message = cycle.reason or (limits[0] if limits else "follows the request")
            values = {
                "active limits": "; ".join(limits),
                "margin of joints [rad]": f"{command.margin.joint:.6g}",
                "margin of distances [m]": f"{command.margin.distance:.6g}",
                "stopping time [s]": f"{command.stopping_time:.6g}",
                "longest period [s]": f"{cycle.longest:.6g}",
            }
            status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
        cycle.longest = 0.0
        message = DiagnosticArray(status=[status])
        message.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(message)


def main(args: list[str] | None = None) -> int:
    """Run the node until SIGINT or SIGTERM, and bring the arm to rest."""
    # ROS's own handlers would close the node before it has sent a stopping motion.
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    signals: list[int] = []
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, lambda number, _: signals.append(number))
    try:
        node = ShieldNode()
    except RefusedError as error:
        print(error, file=sys.stderr)
        return 2
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    gc.freeze()  # a collection of all that was imported takes many periods
    try:
        while not signals:
            executor.spin_once(timeout_sec=0.1)
    finally:
        problem = node.come_to_rest(executor)
    node.get_logger().info(f"not at rest, {problem}" if problem else "at rest")
    rclpy.shutdown()
    return int(bool(problem))


if __name__ == "__main__":
    sys.exit(main())
