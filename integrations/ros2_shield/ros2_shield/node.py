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
from functools import partial
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

REST = 1e-9
"""Velocity of a joint at rest [rad/s]: at a position limit it may back off by rounding."""

REPORT = 0.1
"""Period of the diagnostics [s]."""

PARAMETERS: dict[str, tuple[Any, str]] = {
    "shield": ("", "name of the package that iiwa-dnn exported"),
    "command": (("velocity", "position", "trajectory"), "what is sent"),
    "pacing": (("joint_states", "timer"), "what begins a period"),
    "base_frame": ("base_link", "frame of the twists that are accepted"),
    "timeout": (0.1, "age up to which requests and joint states count [s]"),
}
"""Default, or choices of which the first is it, and meaning of each parameter."""

TIMEOUTS = FloatingPointRange(from_value=1e-3, to_value=10.0)


class RefusedError(Exception):
    """A message or a parameter that cannot be used; the text says why."""


@dataclass
class Cycle:
    """Values that one period leaves for the next."""

    time: float = 0.0  # of the last command [s]
    command: Any = None  # the last one
    measured: Any = np.nan  # joint positions (1, n) [rad]
    seen: float = 0.0  # time of the last joint states [s]
    fault: str = "no joint states"  # why measured positions do not count
    request: dict[str, Any] = field(default_factory=dict)  # the last one
    counts: tuple[float, float] = (0.0, 0.0)  # from when until when it counts [s]
    refused: str = "no request"  # why it does not count
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
        self._own = {name: self._parameter(name, *each) for name, each in PARAMETERS.items()}
        try:
            self._package = package = importlib.import_module(self._own["shield"])
        except (ImportError, ValueError) as error:
            raise RefusedError(f"parameter shield: {self._own['shield']!r}: {error}") from error
        if self._own["command"] == "velocity" and package.LONGEST_PERIOD is None:
            raise RefusedError("parameter command: velocity needs a shield with a longest_period")
        self._longest = package.LONGEST_PERIOD or package.DT
        # Of one arm: it brakes at joint positions that are not finite, where `Shield` raises.
        self._shields = package.Shields(1)
        self._cycle = Cycle()
        takers = {
            "~/delta_twist_cmds": (TwistStamped, "twist", self._twist),
            "~/velocity_cmds": (Float64MultiArray, "dq", self._velocities),
            "~/position_cmds": (JointTrajectory, "position", self._positions),
        }
        for topic, (message, kind, numbers) in takers.items():
            self.create_subscription(message, topic, partial(self._take, kind, numbers), NEWEST)
        self.create_subscription(JointState, "/joint_states", self._on_joint_states, NEWEST)
        is_trajectory = self._own["command"] == "trajectory"
        sent = JointTrajectory if is_trajectory else Float64MultiArray
        self._commands = self.create_publisher(sent, "~/commands", NEWEST)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.create_service(Trigger, "~/halt", self._on_halt)
        self.create_service(Trigger, "~/reset", self._on_reset)
        self.create_timer(package.DT, self._on_timer)
        self.create_timer(REPORT, self._report)

    def _parameter(self, name: str, default: Any, text: str) -> Any:
        """Declare a parameter that is set at the start alone; return its value."""
        about = ParameterDescriptor(description=text, read_only=True)
        if isinstance(default, float):
            about.floating_point_range = [TIMEOUTS]
        if not isinstance(default, tuple):
            return self.declare_parameter(name, default, about).value
        value = self.declare_parameter(name, default[0], about).value
        if value not in default:
            raise RefusedError(f"parameter {name}: {value!r} is none of {default}")
        return value

    # ---- Requests

    def _take(self, kind: str, numbers: Any, message: Any) -> None:
        """Keep a request of a kind, or the reason why it is none."""
        now = self._now()
        stamp = seconds(message.header.stamp) if hasattr(message, "header") else 0.0
        age = now - stamp if stamp else 0.0
        timeout = self._own["timeout"]
        try:
            if abs(age) > timeout:
                raise RefusedError(f"request stamped {age:.3g} s ago")
            self._cycle.request = {kind: np.array([numbers(message)])}
            self._cycle.counts = (now, now + timeout - max(age, 0.0))
            self._cycle.refused = ""
        except RefusedError as error:
            self._cycle.refused = str(error)

    def _twist(self, message: TwistStamped) -> list[float]:
        frame = message.header.frame_id
        if frame not in ("", self._own["base_frame"]):
            raise RefusedError(f"request in frame {frame!r}, not {self._own['base_frame']!r}")
        linear, angular = message.twist.linear, message.twist.angular
        return [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]

    def _velocities(self, message: Float64MultiArray) -> Any:
        count = len(self._package.JOINT_NAMES)
        if len(message.data) != count:
            raise RefusedError(f"request of {len(message.data)} velocities, not {count}")
        return message.data

    def _positions(self, message: JointTrajectory) -> list[float]:
        if len(message.points) != 1:
            raise RefusedError(f"trajectory of {len(message.points)} points, not one")
        return self._ordered(message.joint_names, message.points[0].positions)

    def _ordered(self, names: Any, positions: Any) -> list[float]:
        """Return positions in the order of the shield's joints, by their names."""
        found = dict(zip(names, positions, strict=False))
        missing = [each for each in self._package.JOINT_NAMES if each not in found]
        if missing:
            raise RefusedError(f"joint {missing[0]!r} is missing")
        return [found[each] for each in self._package.JOINT_NAMES]

    # ---- Periods

    def _now(self) -> float:
        return float(self.get_clock().now().nanoseconds * 1e-9)

    def _on_joint_states(self, message: JointState) -> None:
        cycle = self._cycle
        cycle.seen = self._now()
        cycle.fault = ""
        try:
            cycle.measured = np.array([self._ordered(message.name, message.position)])
        except RefusedError as error:
            cycle.fault = str(error)
        if self._own["pacing"] == "joint_states":
            self._step(seconds(message.header.stamp) or cycle.seen, cycle.measured)

    def _on_timer(self) -> None:
        """Begin a period of the node's clock, or one that joint states fail to begin."""
        cycle = self._cycle
        now = self._now()
        age = now - cycle.seen
        is_paced = self._own["pacing"] == "timer"
        dt = self._package.DT
        patience = max(self._longest - dt, 1.5 * dt)
        if age > (self._own["timeout"] if is_paced else patience):
            cycle.fault = "joint states are silent"
        elif not is_paced:
            return
        moved = 0.0 if cycle.command is None else age * cycle.command.dq
        self._step(now, cycle.measured + moved)

    def _step(self, now: float, q: Any) -> None:
        """Send the command of a period that begins at a time [s], at positions q (1, n) [rad]."""
        cycle = self._cycle
        elapsed = now - cycle.time
        if cycle.command is None:
            elapsed = self._package.DT
            if cycle.fault or not np.isfinite(q).all():
                return
        if -self._longest < elapsed < LEAST:  # the timer has begun this period
            return
        cycle.time = now
        cycle.longest = max(cycle.longest, elapsed)
        said = cycle.reason
        if not 0.0 < elapsed <= self._longest * (1.0 + 1e-6):
            cycle.refused = f"period of {elapsed:.6g} s"
            elapsed = self._package.DT  # of a clock that jumps; positions are measured anew
        cycle.reason = self._why_none()
        request = {"dq": np.zeros_like(q)} if cycle.reason else dict(cycle.request)
        if self._own["command"] == "velocity":
            request["elapsed"] = elapsed
        else:
            request["dt"] = self._package.DT
        cycle.command = self._shields.step(np.nan * q if cycle.fault else q, **request)
        code = cycle.command.reason[0]
        if not cycle.reason and 0 < code <= self._package.Reason.Q_NOT_FINITE:
            cycle.reason = self._shields.active_limits(0)[0]
        self._send(cycle.command)
        if cycle.reason != said:
            self._report()

    def _why_none(self) -> str:
        """Return why no request counts now, or nothing."""
        cycle = self._cycle
        begin, end = cycle.counts
        if not cycle.refused and not begin <= self._now() <= end:
            cycle.refused = "request timed out"
        return cycle.fault or cycle.refused

    def _send(self, command: Any) -> None:
        """Publish a command in the form of the parameter."""
        kind = self._own["command"]
        if kind != "trajectory":
            numbers = command.dq if kind == "velocity" else command.next_q
            self._commands.publish(Float64MultiArray(data=numbers[0].tolist()))
            return
        point = JointTrajectoryPoint(positions=command.next_q[0].tolist())
        point.time_from_start.nanosec = round(1e9 * self._package.DT)
        message = JointTrajectory(joint_names=self._package.JOINT_NAMES, points=[point])
        self._commands.publish(message)

    # ---- Halt, reset, state

    def _on_halt(self, _: Any, response: Any) -> Any:
        self._shields.halt()
        response.success = True
        response.message = "brakes until ~/reset"
        return response

    def _on_reset(self, _: Any, response: Any) -> Any:
        """Forget a halt and the request, if the arm is at rest."""
        response.success = self._is_at_rest()
        response.message = "waits for requests" if response.success else "moves: ~/halt first"
        if response.success:
            self._shields.reset()
            self._cycle = Cycle()
        return response

    def _is_at_rest(self) -> bool:
        """Test whether the last command was one to rest, or there was none."""
        command = self._cycle.command
        return command is None or bool(np.abs(command.dq).max() <= REST)

    def come_to_rest(self, executor: Any) -> str:
        """Brake within the limits; return why that was not possible, or nothing."""
        self._shields.halt()
        end = time.monotonic() + 1.0 + 2.0 * self._shields.stopping_time(0)
        while not self._is_at_rest() and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.01)
        return "" if self._is_at_rest() else f"velocities left: {self._cycle.command.dq.round(4)}"

    def _report(self) -> None:
        cycle = self._cycle
        status = DiagnosticStatus(name=f"{self.get_name()}: {self._own['shield']}")
        if cycle.command is None:
            status.level = DiagnosticStatus.STALE
            status.message = cycle.fault
        else:
            limits = self._shields.active_limits(0)
            margin = self._shields.margin(0)
            status.level = DiagnosticStatus.WARN if limits else DiagnosticStatus.OK
            status.level = DiagnosticStatus.ERROR if cycle.reason else status.level
            status.message = cycle.reason or (limits[0] if limits else "follows the request")
            values = {
                "active limits": "; ".join(limits),
                "margin of joints [rad]": f"{margin.joint:.6g}",
                "margin of distances [m]": f"{margin.distance:.6g}",
                "stopping time [s]": f"{self._shields.stopping_time(0):.6g}",
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
