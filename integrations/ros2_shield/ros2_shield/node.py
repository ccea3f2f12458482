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
from geometry_msgs.msg import PoseArray, PoseStamped, TwistStamped
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NEWEST = QoSProfile(depth=1)
"""Reliable and volatile; of requests the last message alone counts."""

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
    "record": "",
    "people_radii": [0.0],  # [m]
    "body_names": [""],
}
"""Parameters and their defaults."""

RANGE = FloatingPointRange(from_value=1e-3, to_value=10.0)


UNIT = 1e-3
"""Distance from 1 of the square of a quaternion's length up to which it counts as rounding."""


class RefusedError(Exception):
    """A message or a parameter that cannot be used; the text says why."""


@dataclass
class Newest:
    """The newest message of a kind."""

    kind: str  # words for it
    problem: str  # reason why the message does not count, or nothing
    value: dict[str, Any] = field(default_factory=dict)  # its numbers (k,) by their name
    stamp: int = 0  # its own [ns], 0 without one
    time: float = -np.inf  # of its stamp, by the clock of the periods [s]
    end: float = -np.inf  # of a trajectory, which lasts

    def is_recent(self, now: float, timeout: float) -> bool:
        """Test whether the message is not too old at a time [s]."""
        return abs(now - self.time) <= timeout

    def fault(self, now: float, timeout: float) -> str:
        """Return why the message does not count at a time [s], or nothing."""
        counts = self.end > -np.inf or self.is_recent(now, timeout)
        return self.problem or ("" if counts else f"{self.kind} timed out")


def _rotation(w: float, x: float, y: float, z: float) -> Any:
    """Return the rotation (3, 3) of a quaternion."""
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 / (w * w + x * x + y * y + z * z) * (w * K + K @ K)


class ShieldNode(Node):
    """Keep an arm within its limits whatever is requested.

    Periods are those of a timer by a steady clock or, with `use_sim_time`, by /clock. A
    `armstep.Drive` decides when to begin and to brake.
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
        self._takes_velocity = self._set["command"] == "velocity"
        try:
            shield: Any = armstep.Shield(self._set["shield"])
        except armstep.ArmstepError as error:
            raise RefusedError(f"parameter shield: {error}") from error
        self._recorded: Any = None
        if self._set["record"]:
            self._recorded = shield = armstep.recorded(shield, self._set["record"])
        self._radii = np.array(self._set["people_radii"], float)
        if self._radii.size == 0 or not (self._radii >= 0.0).all():
            raise RefusedError(f"parameter people_radii: {self._radii} are no radii")
        if self._radii.any() and not shield.tables.people:
            raise RefusedError("parameter people_radii: the shield has no people")
        self._bodies = [name for name in self._set["body_names"] if name]
        if unknown := {*self._bodies} - {*shield.tables.bodies}:
            raise RefusedError(f"parameter body_names: the shield has no body {sorted(unknown)}")
        if self._recorded and (self._radii.any() or self._bodies):
            raise RefusedError("parameter record: a recording keeps no frames of people")
        about = (self._takes_velocity, self._set["timeout"], self._set["following_error"])
        try:
            self._drive = armstep.Drive(shield, *about)
        except armstep.InputError as error:
            raise RefusedError(f"parameter command: {error}") from error
        self._tables = tables = shield.tables
        self._tolerances = {
            kind: np.array([self._tolerance(f"{name}.{kind}") for name in tables.joint_names])
            for kind in ("trajectory", "goal")
        }
        self._goal_time = self._tolerance("goal_time")
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        is_simulated = self.get_parameter("use_sim_time").value
        self._pace = self.get_clock() if is_simulated else steady
        self._states = Newest("joint states", "no joint states")
        self._request = Newest("request", "no request")
        # Frames, until a period takes them: of all people, and of bodies that are named.
        self._people, self._named = Newest("people", ""), Newest("bodies", "")
        self._began = (0.0, time.monotonic())  # the last period, by its clock and a steady one [s]
        self._is_stalled = False  # whether /clock stands still
        for topic, message, read in (
            ("~/delta_twist_cmds", TwistStamped, self._twist),
            ("~/velocity_cmds", Float64MultiArray, self._velocities),
            ("~/position_cmds", JointTrajectory, self._positions),
        ):
            take = partial(self._take, self._request, read)
            self.create_subscription(message, topic, take, NEWEST)
        trajectories = (JointTrajectory, "~/joint_trajectory", self._on_trajectory, NEWEST)
        self.create_subscription(*trajectories)
        self.create_subscription(PoseStamped, "~/pose_target_cmds", self._on_pose, NEWEST)
        # Best effort receives what is reliable, too; another's states do not displace the arm's.
        states = (JointState, "/joint_states", self._on_states, qos_profile_sensor_data)
        self.create_subscription(*states)
        for topic, seen, read, is_told in (
            ("~/people", self._people, self._capsules, self._radii.any()),
            ("~/bodies", self._named, self._places, self._bodies),
        ):
            if is_told:
                take = partial(self._see, seen, read)
                self.create_subscription(PoseArray, topic, take, qos_profile_sensor_data)
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

    # ---- Messages

    def _take(self, newest: Newest, read: Any, message: Any) -> bool:
        """Keep the numbers of a message, or the reason why it does not count.

        One that is not stamped later than the newest is passed over; return whether it counts.
        """
        now = self._now()
        stamp = Time.from_msg(message.header.stamp) if hasattr(message, "header") else Time()
        is_late = 0 < stamp.nanoseconds <= newest.stamp
        if is_late and newest.is_recent(now, self._set["timeout"]):
            return False
        try:
            age = self._age(stamp)
            value = {name: np.array(numbers, float) for name, numbers in read(message).items()}
            if not all(np.isfinite(each).all() for each in value.values()):
                raise RefusedError("not finite")
        except (RefusedError, armstep.InputError) as error:
            newest.problem = f"{newest.kind} {error}"
            return False
        newest.problem = ""
        newest.value = value
        newest.end = -np.inf
        newest.stamp, newest.time = stamp.nanoseconds, now - age
        return True

    def _now(self) -> float:
        return float(self._pace.now().nanoseconds * 1e-9)

    def _seconds_since(self, stamp: Time) -> float:
        return float((self.get_clock().now() - stamp).nanoseconds * 1e-9)

    def _age(self, stamp: Time) -> float:
        """Return the age of a message by its stamp [s], 0 without one.

        One that is ahead is of the next period at most: it came before the clock's tick.
        """
        if stamp.nanoseconds == 0:
            return 0.0
        age = self._seconds_since(stamp)
        if abs(age) > self._set["timeout"]:
            raise RefusedError(f"stamped in the {'past' if age > 0.0 else 'future'}")
        return max(age, -self._tables.dt)

    def _twist(self, message: TwistStamped) -> dict[str, Any]:
        frame = message.header.frame_id
        if frame not in ("", self._set["base_frame"]):
            raise RefusedError(f"in frame {frame!r}, not {self._set['base_frame']!r}")
        linear, angular = message.twist.linear, message.twist.angular
        return {"twist": [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]}

    def _velocities(self, message: Float64MultiArray) -> dict[str, Any]:
        count = len(self._tables.joint_names)
        if len(message.data) != count:
            raise RefusedError(f"of {len(message.data)} velocities, not {count}")
        return {"dq": message.data}

    def _positions(self, message: JointTrajectory) -> dict[str, Any]:
        if len(message.points) != 1:
            raise RefusedError(f"of {len(message.points)} points, not one")
        return {
            "position": self._drive.joints.ordered(message.joint_names, message.points[0].positions)
        }

    def _on_trajectory(self, message: JointTrajectory) -> None:
        """Take a trajectory, from its stamp on, without one from now; one without points ends."""
        own = self._request
        stamp = Time.from_msg(message.header.stamp)
        begin = self._now()
        if stamp.nanoseconds:
            begin -= float((self.get_clock().now() - stamp).nanoseconds * 1e-9)
        order = self._drive.joints.ordered
        try:
            rows = [order(message.joint_names, each.positions) for each in message.points]
        except armstep.InputError as error:
            own.problem = f"trajectory {error}"
            return
        after = [Duration.from_msg(each.time_from_start).nanoseconds for each in message.points]
        times = begin + 1e-9 * np.array(after, float)
        own.problem = "" if rows else "no request"
        own.value = {"times": times, "positions": np.array(rows)}
        own.end = times[-1] if rows else -np.inf

    def _on_pose(self, message: PoseStamped) -> None:
        """Take a pose of the shield's frame as the next sample of a stream of joint positions."""
        own = self._request
        if self._take(own, self._pose, message):
            own.value = {**own.value, "time": own.time, "lead": 1}

    def _pose(self, message: PoseStamped) -> dict[str, Any]:
        frame = message.header.frame_id
        if frame not in ("", self._set["base_frame"]):
            raise RefusedError(f"in frame {frame!r}, not {self._set['base_frame']!r}")
        command = self._drive.command
        if command is None or not self._drive.has_begun:
            raise RefusedError("of a pose before the arm begins")
        place, turn = message.pose.position, message.pose.orientation
        x, y, z, w = quaternion = np.array([turn.x, turn.y, turn.z, turn.w])
        if not abs(np.linalg.norm(quaternion) - 1.0) <= 0.01:
            raise RefusedError("with an orientation whose norm is not 1")
        s = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        rotation = np.eye(3) + 2.0 / (quaternion @ quaternion) * (w * s + s @ s)
        # From the last sample on, as other postures have the pose, too.
        goes_on = "time" in self._request.value and not self._request.problem
        begin = self._request.value["position"] if goes_on else command.next_q
        q = self._drive.shield.solve_pose([place.x, place.y, place.z], rotation, begin)
        if q is None:
            raise RefusedError("of a pose out of reach")
        return {"position": q}

    def _tolerance(self, name: str) -> float:
        """Return a tolerance as of a JointTrajectoryController; 0: there is none.

        Raises:
            RefusedError: It is negative.
        """
        about = ParameterDescriptor(read_only=True)
        found = self.declare_parameter(f"constraints.{name}", 0.0, about).value
        if not found >= 0.0:
            raise RefusedError(f"parameter constraints.{name}: {found} is negative")
        return float(found)

    def _watch(self, now: float) -> None:
        """End a trajectory that a fault ends, or that a joint leaves by more than its tolerance."""
        own = self._request
        deviation = self._drive.deviation
        if own.problem or own.end == -np.inf or not self._drive.has_begun:
            return
        if self._drive.fault:
            own.problem = f"trajectory ended: {self._drive.fault}"
        elif deviation is not None:
            is_over = self._goal_time > 0.0 and now > own.end + self._goal_time
            kind = "goal" if is_over else "trajectory"
            tolerance = self._tolerances[kind]
            off = np.abs(deviation) * (tolerance > 0.0) - tolerance
            if off.max() > 0.0:
                name = self._tables.joint_names[int(off.argmax())]
                own.problem = f"trajectory left: constraints.{name}.{kind}"

    def _measured(self, message: JointState) -> dict[str, Any]:
        return {"q": self._drive.joints.ordered(message.name, message.position)}

    def _on_states(self, message: JointState) -> None:
        """Take joint states, unless they are those of others."""
        is_others = set(message.name).isdisjoint(self._tables.joint_names)
        if not is_others and self._take(self._states, self._measured, message):
            self._drive.see(self._states.time, self._states.value["q"])
            if self._recorded:
                self._recorded.measured = self._states.value["q"]

    def _see(self, seen: Newest, read: Any, message: PoseArray) -> None:
        """Keep a frame of people or bodies for the next period, unless a newer one came.

        What has no meaning is no frame: the last one grows older, and the arm rests in time.
        """
        stamp = Time.from_msg(message.header.stamp)
        if 0 < stamp.nanoseconds <= seen.stamp:
            return
        try:
            if stamp.nanoseconds == 0:
                raise RefusedError("without a stamp")
            if self._seconds_since(stamp) < -self._tables.dt:
                raise RefusedError("stamped in the future")
            if message.header.frame_id not in ("", self._set["base_frame"]):
                raise RefusedError(f"in frame {message.header.frame_id!r}")
            poses = [(each.position, each.orientation) for each in message.poses]
            rows = [[p.x, p.y, p.z, o.w, o.x, o.y, o.z] for p, o in poses]
            seen.value = {"stamp": stamp, **read(np.array(rows).reshape(-1, 7))}
            seen.stamp, seen.problem = stamp.nanoseconds, ""
        except RefusedError as error:
            seen.problem = f"frame of {seen.kind} {error}"

    def _capsules(self, poses: Any) -> dict[str, Any]:
        """Return all people at poses (k, 7) as balls, of the radii of the parameter."""
        places = poses[:, :3]
        if not np.isfinite(places).all():
            raise RefusedError("not finite")
        radii = self._radii[np.minimum(np.arange(len(poses)), len(self._radii) - 1)]
        return {"people": np.column_stack([places, places, radii])}

    def _places(self, poses: Any) -> dict[str, Any]:
        """Return center and rotation of each body that was seen; NaN is one that was not."""
        if len(poses) != len(self._bodies):
            raise RefusedError(f"of {len(poses)} poses, not {len(self._bodies)}")
        found = {}
        for name, (*center, w, x, y, z) in zip(self._bodies, poses, strict=True):
            if np.isfinite(center).all():
                if not abs(w * w + x * x + y * y + z * z - 1.0) < UNIT:
                    raise RefusedError("whose orientation is none")
                found[name] = (center, _rotation(w, x, y, z))
        return {"bodies": found}

    # ---- Periods

    def _on_timer(self) -> None:
        """Begin a period of the clock, unless the timer makes up for one that was late."""
        self._is_stalled = False
        now = self._now()
        elapsed = now - self._began[0]
        if not 0.0 <= elapsed < 0.5 * self._tables.dt:
            self._step(now, elapsed)

    def _on_watch(self) -> None:
        """Begin a period while /clock stands still: the arm may not."""
        age = time.monotonic() - self._began[1]
        self._is_stalled = self._is_stalled or age > self._set["timeout"]
        if self._is_stalled and self._drive.has_begun:
            self._step(self._now(), self._tables.dt, "clock stands still")

    def _step(self, now: float, elapsed: float, fault: str = "") -> None:
        """Send the command of a period.

        Args:
            now: Time at which it begins, read once: the periods add up to the clock's [s].
            elapsed: Time since the last one began [s].
            fault: Reason to brake.
        """
        timeout = self._set["timeout"]
        self._began = (now, time.monotonic())
        before = self._drive.fault
        reasons = (fault, *(each.fault(now, timeout) for each in (self._states, self._request)))
        for each in (self._people, self._named):
            if each.value and self._drive.has_begun:
                age = self._seconds_since(each.value.pop("stamp"))
                self._drive.shield.see(age=max(age, 0.0), **each.value)  # or before the tick
                each.value = {}
        command = self._drive.step(now, elapsed, self._request.value, *reasons)
        if command is not None:
            self._send(command)
        self._watch(now)
        if self._drive.fault != before:
            self._report()

    def _send(self, command: Any) -> None:
        """Publish a command in the form of the parameter."""
        numbers = (command.dq if self._takes_velocity else command.next_q).tolist()
        if self._set["command"] != "trajectory":
            self._commands.publish(Float64MultiArray(data=numbers))
            return
        point = JointTrajectoryPoint(positions=numbers)
        point.time_from_start.nanosec = round(1e9 * self._tables.dt)
        message = JointTrajectory(joint_names=[*self._tables.joint_names], points=[point])
        self._commands.publish(message)

    # ---- Halt, reset, state

    def _on_halt(self, _: Any, response: Any) -> Any:
        self._drive.hold("halted")
        response.success = True
        response.message = "brakes until ~/reset"
        return response

    def _on_reset(self, _: Any, response: Any) -> Any:
        """Forget why the arm is held and the request, if it is at rest."""
        response.success = self._drive.is_at_rest
        response.message = "waits for requests" if response.success else "moves: ~/halt first"
        if response.success:
            self._drive.reset()
            self._request.problem = "no request"
            for each in (self._people, self._named):  # seen anew
                each.value, each.stamp, each.problem = {}, 0, ""
        return response

    def come_to_rest(self, executor: Any) -> str:
        """Brake within the limits; return why that was not possible, or nothing."""
        drive = self._drive
        drive.hold("the node ends")
        stopping = drive.command.stopping_time if drive.command is not None else 0.0
        end = time.monotonic() + 1.0 + self._set["timeout"] + 2.0 * stopping
        while not drive.is_at_rest and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.01)
        if self._recorded:
            self._recorded.close()
        return "" if drive.is_at_rest else f"velocities left: {drive.command.dq.round(4)}"

    def _report(self) -> None:
        """Publish whether and why the arm brakes, and how far it is from its limits."""
        status = DiagnosticStatus(name=f"{self.get_name()}: {self._tables.name}")
        status.level = DiagnosticStatus.STALE
        status.message = fault = self._drive.fault
        command = self._drive.command
        if command is not None:
            limits = command.active_limits
            margin = command.margin
            status.level = DiagnosticStatus.WARN if limits else DiagnosticStatus.OK
            status.level = DiagnosticStatus.ERROR if fault else status.level
            status.message = fault or (limits[0] if limits else "follows the request")
            values = {
                "active limits": "; ".join(limits),
                "margin of joints [rad]": f"{margin.joint:.6g}",
                "margin of distances [m]": f"{margin.distance:.6g}",
                "margin of separation [m]": f"{margin.separation:.6g}",
                "margin of torques": f"{margin.torque:.6g}",
                "people": "; ".join(filter(None, (self._people.problem, self._named.problem))),
                "stopping time [s]": f"{command.stopping_time:.6g}",
                "longest period [s]": f"{self._drive.worst:.6g}",
            }
            status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
        self._drive.worst = 0.0
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
