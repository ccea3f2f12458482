"""Robots: a Pinocchio model with its tip frame and its limits."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, InvalidInputError, NotFoundError
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.payload import Payload, make_payload
from iiwa_dnn.robot.start import best_start
from iiwa_dnn.robot.tools import Tool, ToolShapes, make_tool
from iiwa_dnn.robot.urdf import read_geometry

_NO_LIMIT = 1e300
"""Value above which a limit of Pinocchio's means none [rad, rad/s]."""

_LIMITS = ("lower", "upper", "velocity", "acceleration", "jerk")
"""Rows of `Robot.limits`, and the arguments of `Robot.with_limits`."""

_CANDIDATES = 200
_MIDDLE = (0.2, 0.8)
"""Random postures among which the start of an unknown arm is chosen, and the part of the range of
each joint in which they are."""


@dataclass(frozen=True, eq=False, repr=False)
class Robot:
    """A robot arm: model, tip and limits, none of which changes.

    Angles are in [rad]; a prismatic joint counts in [m].

    Attributes:
        name: Name of the robot, from its URDF.
        model: The Pinocchio model; each of its n joints has one coordinate. Treat as read-only.
        tip: Name of the frame that follows references.
        limits: Lower and upper joint positions [rad], velocities [rad/s], accelerations
            [rad/s^2] and jerks [rad/s^3], (5, n); infinite where there is no limit. For compiled
            code, so not protected; `q_lower` and so on are its rows, read-only.
        position_dependent_velocity: Offset o [rad/s] and deceleration D [rad/s^2] of velocity
            limits that shrink to sqrt(2 D d) - o at a distance d from a position limit, (2, n); D
            is inf where a joint has none.
        locked: Names of the URDF's joints that were frozen on loading.
        q_locked: Positions at which the joints of ``locked`` are frozen [rad], one each.
        path: The URDF file, where the robot came from one; it is read once, on loading.
        urdf: Text of the URDF as it was read.
        tools: Tools and held objects at the tip, the innermost first.
        payload: Body of uncertain mass that a frame carries, for `TorqueLimits`; None: there is
            none.
        tip_id: Pinocchio's index of the tip frame.

    Raises:
        NotFoundError: If the model has no frame ``tip``.
        InvalidInputError: If no joint moves the tip, or a limit is not acceptable.
    """

    name: str
    model: pin.Model
    tip: str
    limits: checks.Array
    position_dependent_velocity: checks.Array
    locked: tuple[str, ...] = ()
    q_locked: tuple[float, ...] = ()
    path: Path | None = None
    urdf: str | None = None
    tools: tuple[Tool, ...] = ()
    payload: Payload | None = None
    tip_id: int = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "tip_id", self.frame_id(self.tip))
        object.__setattr__(self, "limits", checks.read_only(self.limits))
        if self.model.frames[self.tip_id].parentJoint == 0:
            raise InvalidInputError("tip", f"no joint moves frame {self.tip!r}", self.tip)
        for joint, (lower, upper, *rates) in zip(self.joint_names, self.limits.T, strict=True):
            if not lower < upper:
                problem = f"joint {joint!r}: lower limit {lower:g} is not below {upper:g}"
                raise InvalidInputError("lower", problem, self.limits)
            for name, rate in zip(_LIMITS[2:], rates, strict=True):
                if not rate > 0.0:
                    problem = f"joint {joint!r}: {rate:g} is not above 0"
                    raise InvalidInputError(name, problem, self.limits)

    @property
    def q_lower(self) -> checks.Array:
        """Lower joint position limits [rad], (n,); -inf where there is none."""
        return checks.read_only(self.limits[0])

    @property
    def q_upper(self) -> checks.Array:
        """Upper joint position limits [rad], (n,); inf where there is none."""
        return checks.read_only(self.limits[1])

    @property
    def dq_max(self) -> checks.Array:
        """Joint velocity limits [rad/s], (n,); inf where there is none."""
        return checks.read_only(self.limits[2])

    @property
    def ddq_max(self) -> checks.Array:
        """Joint acceleration limits [rad/s^2], (n,); inf where there is none."""
        return checks.read_only(self.limits[3])

    @property
    def dddq_max(self) -> checks.Array:
        """Joint jerk limits [rad/s^3], (n,); inf where there is none."""
        return checks.read_only(self.limits[4])

    @property
    def dof(self) -> int:
        """Number of joints, n."""
        return int(self.model.nv)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the n joints, in the order of q."""
        return tuple(self.model.names)[1:]

    @property
    def frame_names(self) -> tuple[str, ...]:
        """Names of all frames, each once: the links, then the joints."""
        return frame_names(self.model)

    @property
    def reach(self) -> float:
        """Distance of the tip from the base that the links' lengths allow at most [m]."""
        tip = self.model.frames[self.tip_id]
        own = float(np.linalg.norm(tip.placement.translation))
        return sum(self.lengths[self.support[self.tip_id] > 0.0].tolist(), own)

    @cached_property
    def lengths(self) -> checks.Array:
        """Largest distance of each joint's frame from that of the joint before it [m], (n,)."""
        offsets = [place.translation for place in list(self.model.jointPlacements)[1:]]
        lengths = np.array([np.linalg.norm(offset) for offset in offsets])
        slides = list(self.slides)
        lengths[slides] += np.abs(self.limits[:2, slides]).max(axis=0)
        return checks.read_only(lengths)

    @cached_property
    def slides(self) -> tuple[int, ...]:
        """Numbers from 0 of the joints that slide."""
        joints = enumerate(list(self.model.joints)[1:])
        return tuple(i for i, joint in joints if "JointModelP" in joint.shortname())

    @cached_property
    def support(self) -> checks.Array:
        """Joints that move each frame, (frames, n), by Pinocchio's index of the frame: 1 or 0.

        For compiled code, so not protected.
        """
        joints = np.zeros((self.model.njoints, self.dof))
        for joint, support in enumerate(self.model.supports):
            joints[joint, [self.model.idx_vs[each] for each in list(support)[1:]]] = 1.0
        return joints[[frame.parentJoint for frame in self.model.frames]]

    def frame_id(self, name: str) -> int:
        """Return Pinocchio's index of a frame: the link's, where a joint has the same name.

        Raises:
            NotFoundError: If there is no such frame; the error lists those of similar names.
        """
        return frame_id(self.model, name)

    def with_limits(
        self,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        jerk: ArrayLike | None = None,
    ) -> Robot:
        """Return the same robot with other limits; those not given stay as they are.

        Args:
            lower: Lower joint position limits [rad], one number or (n,); -inf for none.
            upper: Upper joint position limits [rad], one number or (n,); inf for none.
            velocity: Joint velocity limits [rad/s], one number or (n,), above 0; inf for none.
            acceleration: Joint acceleration limits [rad/s^2], likewise.
            jerk: Joint jerk limits [rad/s^3], likewise.

        Raises:
            InvalidInputError: If a limit is not a number, has a wrong length, is not below its
                upper counterpart or, for a rate, is not above zero.
        """
        limits = self.limits.copy()
        given = (lower, upper, velocity, acceleration, jerk)
        for name, row, value in zip(_LIMITS, limits, given, strict=True):
            if value is not None:
                row[:] = checks.array(name, value, np.shape(value) and row.shape)
        return replace(self, limits=limits)

    def outside(self, q: ArrayLike) -> str:
        """Describe the first joint of q (n,) [rad] that is beyond its limits; "" if none is.

        An excess of 1e-9 is allowed: a run may end there, and the next one begin. If they are
        `in_degrees`, the text asks about the unit.
        """
        hint = "; are the positions in degrees?" * self.in_degrees(q)
        for i, (lower, upper, each) in enumerate(
            zip(*self.limits[:2], np.asarray(q), strict=True), 1
        ):
            if not lower - 1e-9 <= each <= upper + 1e-9:
                return f"is not between {lower:g} and {upper:g} rad: joint {i} is at {each:g}{hint}"
        return ""

    def in_degrees(self, q: ArrayLike) -> bool:
        """Test whether positions q (n,) beyond a turn would be within the limits in degrees."""
        turns = np.radians(q)
        fit = (turns >= self.q_lower) & (turns <= self.q_upper)
        return bool(fit.all() and np.abs(q).max() > 2.0 * np.pi)

    def with_tool(
        self, tool: pin.SE3 | ArrayLike, name: str = "tool", tool_shapes: ToolShapes = None
    ) -> Robot:
        """Return the same robot with a tool or a held object, whose frame becomes the tip.

        Distances are kept of its shapes as of a link that goes by its name. It has no mass.

        Args:
            tool: Pose of the tool in the tip's frame, the flange: a Pinocchio SE3, or x, y, z [m]
                and roll, pitch, yaw [rad] as in a URDF's ``<origin>``, (6,).
            name: Name of the tool and of its frame, which is none of the robot's.
            tool_shapes: Shapes of the tool in the frame of the flange: a `Sphere`, `Capsule` or
                `Box`, or several; [] for none. None: a capsule from the flange to the tool's tip
                stands for it, and a warning says so where distances are watched.

        Raises:
            InvalidInputError: If the pose is neither, or not finite, or the name is taken, or a
                shape is another one or moves.
        """
        if checks.instance("name", name, str) in self.frame_names:
            raise InvalidInputError("tool", f"the robot has a frame {name!r} already", name)
        if not isinstance(tool, pin.SE3):
            xyz_rpy = checks.finite_array("tool", tool, (6,)).copy()
            tool = pin.SE3(pin.rpy.rpyToMatrix(xyz_rpy[3:]), xyz_rpy[:3])
        checks.finite_array("tool", tool.homogeneous, (4, 4))
        tip = self.model.frames[self.tip_id]
        pose = tip.placement * tool
        model = self.model.copy()
        model.addFrame(pin.Frame(name, tip.parentJoint, self.tip_id, pose, pin.FrameType.OP_FRAME))
        fixed = make_tool(name, self.tip, tool.copy(), tool_shapes)
        return replace(self, model=model, tip=name, tools=(*self.tools, fixed))

    def with_payload(
        self,
        mass: ArrayLike,
        center: ArrayLike = (0.0, 0.0, 0.0),
        inertia: ArrayLike | None = None,
    ) -> Robot:
        """Return the same robot with a payload at the tip, in place of the one that it carries.

        `TorqueLimits` hold for every mass in the range, so it may be grasped and released in motion
        if the range begins at 0. It has no shape: `with_tool` states one.

        Args:
            mass: Its mass, or the smallest and the largest one [kg], (2,).
            center: Its centre of mass in the frame of the tip [m], (3,); or the ends of a box that
                the centre, or without `inertia` all of the body, is in, (2, 3).
            inertia: Its inertia about the centre along the axes of that frame, at the largest mass
                and in proportion to it at others [kg m^2], (3, 3); None: a point mass.

        Raises:
            InvalidInputError: The range, the centre or the inertia is none.
        """
        return replace(self, payload=make_payload(self.tip, mass, center, inertia))

    def with_armature(self, armature: ArrayLike | None = None) -> Robot:
        """Return the same robot with other rotor inertias, seen through the gears.

        Args:
            armature: Inertia that each joint has beside the links' [kg m^2], one number or (n,);
                None: that which its maker states (`iiwa_dnn.robot.arms`).

        Raises:
            InvalidInputError: It is negative, no number or of a wrong length, or none is known.
        """
        if armature is None:
            armature = self.stated("armature")
            if len(armature) == 0:
                raise InvalidInputError("armature", f"none is published of {self.name}")
        own = checks.finite_array("armature", armature, np.shape(armature) and (self.dof,))
        if (own < 0.0).any():
            raise InvalidInputError("armature", "must not be negative", armature)
        model = self.model.copy()
        model.armature = np.full(self.dof, own)
        return replace(self, model=model)

    def stated(self, name: str) -> tuple[float, ...]:
        """Return what its maker states of the motors, (n,); () if nothing, or joints are held.

        Args:
            name: ``"effort"``, ``"armature"`` or ``"friction"`` of `iiwa_dnn.robot.arms.Arm`.
        """
        stated: tuple[float, ...] = getattr(ARMS[self.name], name) if self.name in ARMS else ()
        return stated if len(stated) == self.dof else ()

    @property
    def friction(self) -> checks.Array:
        """Bounds on the torque that friction takes from each joint [N m], (n,); 0 if unknown."""
        return np.array(self.stated("friction") or np.zeros(self.dof))

    def with_gravity(self, gravity: ArrayLike) -> Robot:
        """Return the same robot in other gravity, as on a wall, a ceiling or a tilted base.

        Args:
            gravity: Acceleration of gravity along the axes of the base [m/s^2], (3,).

        Raises:
            InvalidInputError: It has another shape or is not finite.
        """
        model = self.model.copy()
        model.gravity.linear = checks.finite_array("gravity", gravity, (3,)).copy()
        return replace(self, model=model)

    def start_posture(self) -> checks.Array:
        """Return joint positions (n,) [rad] to start from, inside the limits.

        For an arm of `iiwa_dnn.robot.arms.ARMS` they are its start there; a joint that is outside
        its limits there starts a twentieth of its range inside the nearer limit. For any other
        robot they are the best of random postures (`best_start`), each joint in the middle of its
        range.
        """
        start = np.array(ARMS[self.name].start if self.name in ARMS else ())
        if start.size != self.dof:
            return self._best_start.copy()
        inside = (self.q_lower < start) & (start < self.q_upper)
        return np.where(inside, start, np.clip(start, *self._inside(np.array([[0.05], [0.95]]))))

    @cached_property
    def _best_start(self) -> checks.Array:
        ratios = np.random.default_rng(0).uniform(*_MIDDLE, (_CANDIDATES, self.dof))
        shapes = pin.GeometryModel()
        with suppress(FileError):  # a mesh is missing
            if self.path is not None:
                kind = pin.GeometryType.COLLISION
                shapes = read_geometry(self.model, self.path, str(self.urdf), kind)
        return best_start(self.model, self.tip_id, self.reach, shapes, self._inside(ratios))

    def draw(self, random: np.random.Generator, count: int) -> checks.Array:
        """Draw joint positions evenly within the limits, at most 2 pi from 0, (count, n) [rad]."""
        return self._inside(random.uniform(0.0, 1.0, (count, self.dof)))

    def _inside(self, ratios: checks.Array) -> checks.Array:
        """Return postures (..., n) [rad] at ratios (..., n) of the ranges, cut to 2 pi each way.

        A limit, finite or not, that is more than 2 pi from 0, or from the limit nearest to 0 where
        0 is outside of the range, counts as 2 pi from there.
        """
        nearest = np.clip(0.0, self.q_lower, self.q_upper)
        lower = np.maximum(self.q_lower, nearest - 2.0 * np.pi)
        upper = np.minimum(self.q_upper, nearest + 2.0 * np.pi)
        return np.array(lower + (upper - lower) * ratios)

    def __repr__(self) -> str:
        locked = f", locked: {', '.join(self.locked)}" if self.locked else ""
        return f"<Robot {self.name}: {self.dof} joints, tip {self.tip}{locked}>"


def model_limits(model: pin.Model) -> checks.Array:
    """Return a model's lower and upper positions [rad] and velocities [rad/s], (3, n).

    Where there is no limit, or a number too large to be one, it is infinite.
    """
    limits = np.array([model.lowerPositionLimit, model.upperPositionLimit, model.velocityLimit])
    limits[np.abs(limits) > _NO_LIMIT] *= np.inf
    limits[2, limits[2] == 0.0] = np.inf
    return limits


def frame_names(model: pin.Model) -> tuple[str, ...]:
    """List the names of a model's frames, each once: the links, then the joints."""
    frames = sorted(list(model.frames)[1:], key=lambda each: each.type != pin.FrameType.BODY)
    return tuple(dict.fromkeys(frame.name for frame in frames))


def frame_id(model: pin.Model, name: str) -> int:
    """Return Pinocchio's index of a frame: the link's, where a joint has the same name.

    Raises:
        NotFoundError: If there is no such frame; the error lists those of similar names.
    """
    if str(name) not in frame_names(model):
        raise NotFoundError("frame", str(name), frame_names(model))
    is_link = model.existFrame(name, pin.FrameType.BODY)
    return int(model.getFrameId(name, pin.FrameType.BODY) if is_link else model.getFrameId(name))
