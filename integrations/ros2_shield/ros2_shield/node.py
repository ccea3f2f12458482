"""A ROS 2 node between requests and an arm's controllers, around an exported shield.

The shield is a file of tables that ``iiwa-dnn export --tables FILE`` wrote. docs/integrations.md
has the topics and parameters.
"""

import gc
import signal
import sys
import time
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import armstep
import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TwistStamped
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import ParameterException
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

REST = 1e-9
"""Velocity of a joint at rest [rad/s]: at a position limit it may back off by rounding."""

FORGOTTEN = 1.0
"""Time constant with which a velocity-controlled arm's following error is forgotten [s]."""

REPORT = 0.1
"""Period of the diagnostics [s]."""

COMMANDS = ("velocity", "position", "trajectory")
"""Values of the parameter `command`."""

PARAMETERS = {
    "shield": "",
    "command": "velocity",
    "base_frame": "base_link",
    "timeout": 0.1,  # [s]
    "following_error": 0.1,  # [rad]
}
"""Parameters and their defaults."""

RANGE = FloatingPointRange(from_value=1e-3, to_value=10.0)


class RefusedError(Exception):
    """A message or a parameter that cannot be used; the text says why."""


@dataclass
class Newest:
    """The newest message of a kind."""

    kind: str  # words for it
    problem: str  # reason why the message does not count, or nothing
    value: dict[str, Any] = field(default_factory=dict)  # its numbers (1, k) by their name
    time: float = 0.0  # of its arrival, by the clock of the periods [s]
    age: float = 0.0  # that it had then by its stamp [s]

    def fault(self, now: float, timeout: float) -> str:
        """Return why the message does not count at a time [s], or nothing."""
        is_recent = 0.0 <= now - self.time <= timeout - self.age
        return self.problem or ("" if is_recent else f"{self.kind} timed out")


class ShieldNode(Node):
    """Keep an arm within its limits whatever is requested.

    Periods are those of a timer by a steady clock or, with `use_sim_time`, by /clock. `_step`
    alone computes a command and decides whether to brake.
    """

    def __init__(self) -> None:
        """Read the parameters, load the shield, subscribe and advertise.

        Raises:
            RefusedError: A parameter has no such value, or the shield does not fit to it.
        """
        super().__init__("shield")
        self._set: dict[str, Any] = {}
        for name, default in PARAMETERS.items():
            about = ParameterDescriptor(read_only=True)
            if isinstance(default, float):
                about.floating_point_range = [RANGE]
            self._set[name] = self.declare_parameter(name, default, about).value
        if self._set["command"] not in COMMANDS:
            raise RefusedError(f"parameter command: {self._set['command']!r} is none of {COMMANDS}")
        try:
            # Of one arm: it brakes at joint positions that are not finite, where `Shield` raises.
            self._shields = armstep.Shields(self._set["shield"], 1)
        except armstep.ArmstepError as error:
            raise RefusedError(f"parameter shield: {error}") from error
        self._tables = tables = self._shields.tables
        self._takes_velocity = self._set["command"] == "velocity"
        if self._takes_velocity and tables.longest_period is None:
            raise RefusedError("parameter command: velocity needs a shield with a longest_period")
        if not self._takes_velocity and tables.delay:
            raise RefusedError("parameter command: positions need a shield without a delay")
        self._longest = tables.longest_period or self._set["timeout"]
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        is_simulated = self.get_parameter("use_sim_time").value
        self._pace = self.get_clock() if is_simulated else steady
        self._states = Newest("joint states", "no joint states")
        self._request = Newest("request", "no request")
        self._fault = "no joint states"  # why the arm brakes
        self._began = (0.0, time.monotonic())  # the last period, by its clock and a steady one [s]
        self._is_stalled = False  # whether /clock stands still
        self._worst = 0.0  # longest period since the last report [s]
        self._restart()
        for topic, message, *taker in (
            ("/joint_states", JointState, self._states, "q", self._joints),
            ("~/delta_twist_cmds", TwistStamped, self._request, "twist", self._twist),
            ("~/velocity_cmds", Float64MultiArray, self._request, "dq", self._velocities),
            ("~/position_cmds", JointTrajectory, self._request, "position", self._positions),
        ):
            self.create_subscription(message, topic, partial(self._take, *taker), NEWEST)
        is_trajectory = self._set["command"] == "trajectory"
        sent = JointTrajectory if is_trajectory else Float64MultiArray
        self._commands = self.create_publisher(sent, "~/commands", NEWEST)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.create_service(Trigger, "~/halt", self._on_halt)
        self.create_service(Trigger, "~/reset", self._on_reset)
        self.create_timer(tables.dt, self._on_timer, clock=self._pace)
        self.create_timer(REPORT, self._report, clock=steady)
        if is_simulated:
            self.create_timer(tables.dt, self._on_watch, clock=steady)

    def _restart(self) -> None:
        """Forget commands, the request and why the arm is held."""
        self._shields.reset()
        self._request.problem = "no request"
        self._held = ""  # why the arm brakes until ~/reset
        self._command: Any = None  # the last one
        self._seen: Any = None  # joint positions of the last period (1, n) [rad]
        self._due: Any = None  # those to which the commands lead (1, n) [rad]

    # ---- Messages

    def _take(self, newest: Newest, name: str, numbers: Any, message: Any) -> None:
        """Keep the numbers of a message, or the reason why it does not count."""
        try:
            age = self._age(message)
            value = np.array([numbers(message)], dtype=float)
            if not np.isfinite(value).all():
                raise RefusedError("not finite")
        except RefusedError as error:
            newest.problem = f"{newest.kind} {error}"
            return
        newest.problem = ""
        newest.value = {name: value}
        newest.time, newest.age = self._now(), age

    def _now(self) -> float:
        return float(self._pace.now().nanoseconds * 1e-9)

    def _age(self, message: Any) -> float:
        """Return the age of a message by its stamp [s], 0 without one."""
        stamp = Time.from_msg(message.header.stamp) if hasattr(message, "header") else Time()
        if stamp.nanoseconds == 0:
            return 0.0
        age = float((self.get_clock().now() - stamp).nanoseconds * 1e-9)
        if abs(age) > self._set["timeout"]:
            raise RefusedError(f"stamped in the {'past' if age > 0.0 else 'future'}")
        return max(age, 0.0)

    def _twist(self, message: TwistStamped) -> list[float]:
        frame = message.header.frame_id
        if frame not in ("", self._set["base_frame"]):
            raise RefusedError(f"in frame {frame!r}, not {self._set['base_frame']!r}")
        linear, angular = message.twist.linear, message.twist.angular
        return [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]

    def _velocities(self, message: Float64MultiArray) -> Any:
        count = len(self._tables.joint_names)
        if len(message.data) != count:
            raise RefusedError(f"of {len(message.data)} velocities, not {count}")
        return message.data

    def _positions(self, message: JointTrajectory) -> list[float]:
        if len(message.points) != 1:
            raise RefusedError(f"of {len(message.points)} points, not one")
        positions = message.points[0].positions
        return self._joints(JointState(name=message.joint_names, position=positions))

    def _joints(self, message: JointState) -> list[float]:
        """Return positions [rad] in the order of the shield's joints, by their names."""
        found = dict(zip(message.name, message.position, strict=False))
        if len(found) != len(message.name):
            raise RefusedError("with a joint twice, or without positions")
        for each in self._tables.joint_names:
            if each not in found:
                raise RefusedError(f"without joint {each!r}")
        return [found[each] for each in self._tables.joint_names]

    # ---- Periods

    def _on_timer(self) -> None:
        """Begin a period of the clock, unless the timer makes up for one that was late."""
        self._is_stalled = False
        elapsed = self._now() - self._began[0]
        if not 0.0 <= elapsed < 0.5 * self._tables.dt:
            self._step(elapsed)

    def _on_watch(self) -> None:
        """Begin a period while /clock stands still: the arm may not."""
        age = time.monotonic() - self._began[1]
        self._is_stalled = self._is_stalled or age > self._set["timeout"]
        if self._is_stalled:
            self._step(self._tables.dt, "clock stands still")

    def _step(self, elapsed: float, fault: str = "") -> None:
        """Send the command of a period.

        Args:
            elapsed: Time since the last period began [s].
            fault: Reason to brake.
        """
        now = self._now()
        timeout = self._set["timeout"]
        self._began = (now, time.monotonic())
        is_first = self._command is None
        if not is_first and not 0.0 < elapsed <= self._longest:
            fault = fault or f"period not within {self._longest:g} s"
        if is_first or not 0.0 < elapsed <= timeout:
            elapsed = self._tables.dt
        self._worst = max(self._worst, elapsed)
        blind = self._states.fault(now, timeout)
        q = self._told(now, elapsed, blind)
        before = self._fault
        self._fault = self._held or fault or blind or self._request.fault(now, timeout)
        if not (is_first and blind):
            request = {"dq": np.zeros_like(q)} if self._fault else self._request.value
            period = {"elapsed": elapsed} if self._takes_velocity else {"dt": self._tables.dt}
            self._command = self._shields.step(q, **request, **period)
            self._send(self._command)
        if self._fault != before:
            self._report()

    def _told(self, now: float, elapsed: float, blind: str) -> Any:
        """Return the joint positions (1, n) [rad] for the shield; hold an arm that does not follow.

        Commanded positions never jump, so they are told as measured ones: the shield is then never
        resynchronised.
        """
        measured = self._states.value.get("q")
        command = self._command
        if command is None:
            self._seen = self._due = measured
            return measured
        q = measured + (now - self._states.time) * command.dq
        self._due = self._due + elapsed * command.dq if self._takes_velocity else command.next_q
        if not blind and measured is not self._seen:
            self._seen = measured
            error = np.abs(self._due - q)[0]
            self._due = self._due + min(elapsed / FORGOTTEN, 1.0) * (q - self._due)
            if error.max() > self._set["following_error"]:
                name = self._tables.joint_names[error.argmax()]
                self._held = self._held or f"joint {name!r} does not follow its commands"
        if not self._takes_velocity:
            return command.next_q
        return np.nan * q if blind else q

    def _send(self, command: Any) -> None:
        """Publish a command in the form of the parameter."""
        numbers = (command.dq if self._takes_velocity else command.next_q)[0].tolist()
        if self._set["command"] != "trajectory":
            self._commands.publish(Float64MultiArray(data=numbers))
            return
        point = JointTrajectoryPoint(positions=numbers)
        point.time_from_start.nanosec = round(1e9 * self._tables.dt)
        message = JointTrajectory(joint_names=[*self._tables.joint_names], points=[point])
        self._commands.publish(message)

    # ---- Halt, reset, state

    def _on_halt(self, _: Any, response: Any) -> Any:
        self._held = "halted"
        response.success = True
        response.message = "brakes until ~/reset"
        return response

    def _on_reset(self, _: Any, response: Any) -> Any:
        """Forget why the arm is held and the request, if it is at rest."""
        response.success = self._is_at_rest()
        response.message = "waits for requests" if response.success else "moves: ~/halt first"
        if response.success:
            self._restart()
        return response

    def _is_at_rest(self) -> bool:
        """Test whether the last command was one to rest, or there was none."""
        return self._command is None or bool(np.abs(self._command.dq).max() <= REST)

    def come_to_rest(self, executor: Any) -> str:
        """Brake within the limits; return why that was not possible, or nothing."""
        self._held = "the node ends"
        duration = 1.0 + self._set["timeout"] + 2.0 * self._shields.stopping_time(0)
        end = time.monotonic() + duration
        while not self._is_at_rest() and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.01)
        return "" if self._is_at_rest() else f"velocities left: {self._command.dq.round(4)}"

    def _report(self) -> None:
        """Publish whether and why the arm brakes, and how far it is from its limits."""
        status = DiagnosticStatus(name=f"{self.get_name()}: {self._tables.name}")
        status.level = DiagnosticStatus.STALE
        status.message = self._fault
        if self._command is not None:
            limits = self._shields.active_limits(0)
            margin = self._shields.margin(0)
            status.level = DiagnosticStatus.WARN if limits else DiagnosticStatus.OK
            status.level = DiagnosticStatus.ERROR if self._fault else status.level
            status.message = self._fault or (limits[0] if limits else "follows the request")
            values = {
                "active limits": "; ".join(limits),
                "margin of joints [rad]": f"{margin.joint:.6g}",
                "margin of distances [m]": f"{margin.distance:.6g}",
                "stopping time [s]": f"{self._shields.stopping_time(0):.6g}",
                "longest period [s]": f"{self._worst:.6g}",
            }
            status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
        self._worst = 0.0
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
    except (ParameterException, RefusedError) as error:
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
