"""Robots: a Pinocchio model with its tip frame and its limits."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.robot.arms import STARTS

SINGULAR = 0.05
"""Smallest singular value of the tip's Jacobian below which a posture is no start."""

_LIMITS = {
    "q_lower": "lower",
    "q_upper": "upper",
    "dq_max": "velocity",
    "ddq_max": "acceleration",
    "dddq_max": "jerk",
}
"""Limits of a robot, and the arguments of `Robot.with_limits` that set them."""


class Mimic(NamedTuple):
    """A joint that follows another: q = multiplier q_leader + offset [rad]; see URDF's <mimic>."""

    joint: str
    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True, eq=False, repr=False)
class Robot:
    """A robot arm: model, tip and limits, none of which changes.

    Angles are in [rad]; a prismatic joint counts in [m].

    Attributes:
        name: Name of the robot, from its URDF.
        model: The Pinocchio model; each of its n joints has one coordinate. Treat as read-only.
        tip: Name of the frame that follows references.
        q_lower: Lower joint position limits [rad], (n,); -inf where there is none.
        q_upper: Upper joint position limits [rad], (n,); inf where there is none.
        dq_max: Joint velocity limits [rad/s], (n,); inf where there is none.
        locked: Names of the URDF's joints that were frozen on loading.
        path: The URDF file, where the robot came from one; it is read once, on loading.
        q_locked: Positions at which the joints of ``locked`` are frozen [rad], one each.
        ddq_max: Joint acceleration limits [rad/s^2], (n,); inf where there is none.
        dddq_max: Joint jerk limits [rad/s^3], (n,); inf where there is none.
        mobile: Whether the first three joints are a mobile base, which the file does not have.
        mimics: Joints between base and tip that follow others; schemes hold them to it.
        urdf: Text of the URDF as it was read: includes, xacro and MJCF expanded.
        ramps: Offset o [rad/s] and deceleration D [rad/s^2] of velocity limits that shrink to
            sqrt(2 D d) - o at a distance d from a position limit, (2, n); D is inf where a joint
            has none.
        tip_id: Pinocchio's index of the tip frame.
        limits: ``q_lower``, ``q_upper``, ``dq_max``, (3, n), for compiled code; not protected.

    Raises:
        NotFoundError: If the model has no frame ``tip``.
        InvalidInputError: If no joint moves the tip, or a limit is not acceptable.
    """

    name: str
    model: pin.Model
    tip: str
    q_lower: checks.Array
    q_upper: checks.Array
    dq_max: checks.Array
    locked: tuple[str, ...] = ()
    path: Path | None = None
    q_locked: tuple[float, ...] = ()
    ddq_max: checks.Array = field(default_factory=lambda: np.array(np.inf))
    dddq_max: checks.Array = field(default_factory=lambda: np.array(np.inf))
    mobile: bool = False
    mimics: tuple[Mimic, ...] = ()
    urdf: str | None = None
    ramps: checks.Array = field(default_factory=lambda: np.array([[0.0], [np.inf]]))
    tip_id: int = field(init=False)
    limits: checks.Array = field(init=False)

    def __post_init__(self) -> None:
        tip_id = self.frame_id(self.tip)
        if self.model.frames[tip_id].parentJoint == 0:
            raise InvalidInputError("tip", f"no joint moves frame {self.tip!r}", self.tip)
        object.__setattr__(self, "tip_id", tip_id)
        for name in _LIMITS:
            object.__setattr__(self, name, _limit(name, getattr(self, name), self.dof))
        ramps: checks.Array = np.array(np.broadcast_to(self.ramps, (2, self.dof)), dtype=float)
        if not ((ramps[0] >= 0.0) & (ramps[1] > 0.0)).all():
            problem = "must have offsets of at least 0 and decelerations above 0"
            raise InvalidInputError("ramps", problem, self.ramps)
        ramps.setflags(write=False)
        object.__setattr__(self, "ramps", ramps)
        object.__setattr__(self, "limits", np.stack([self.q_lower, self.q_upper, self.dq_max]))
        for i in np.flatnonzero(self.q_lower >= self.q_upper):
            lower, upper = self.limits[:2, i]
            problem = f"joint {i + 1}: lower limit {lower:g} is not below upper limit {upper:g}"
            raise InvalidInputError("q_lower", problem, (self.q_lower, self.q_upper))
        for name in ("dq_max", "ddq_max", "dddq_max"):
            limit = getattr(self, name)
            for i in np.flatnonzero(limit <= 0.0):
                raise InvalidInputError(name, f"joint {i + 1}: {limit[i]:g} is not above 0", limit)

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
        return tuple(self._frame_ids)

    @cached_property
    def _frame_ids(self) -> dict[str, int]:
        """Pinocchio's index of each frame: the link's, where a joint has the same name."""
        frames = list(enumerate(self.model.frames))[1:]
        ids: dict[str, int] = {}
        for index, frame in sorted(frames, key=lambda each: each[1].type != pin.FrameType.BODY):
            ids.setdefault(frame.name, index)
        return ids

    @cached_property
    def moves(self) -> checks.Array:
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
        index = self._frame_ids.get(str(name))
        if index is None:
            raise NotFoundError("frame", str(name), self.frame_names)
        return index

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
        values = zip(_LIMITS, (lower, upper, velocity, acceleration, jerk), strict=True)
        changed: dict[str, Any] = {name: value for name, value in values if value is not None}
        try:
            return replace(self, **changed)
        except InvalidInputError as error:
            crossed = error.argument == "q_lower" and lower is None
            argument = "upper" if crossed else _LIMITS[error.argument]
            raise InvalidInputError(argument, error.problem, error.value) from None

    def outside(self, q: ArrayLike) -> str:
        """Name the first joint of q (n,) [rad] that is off its limits, in words; "" if none is.

        A distance of 1e-9 beyond a limit is forgiven: a run may end there, and the next one begin.
        """
        q = np.asarray(q)
        for i in np.flatnonzero((q < self.q_lower - 1e-9) | (q > self.q_upper + 1e-9)):
            limits = f"{self.q_lower[i]:g} and {self.q_upper[i]:g} rad"
            return f"must be within {limits}: joint {i + 1} is at {q[i]:g}"
        return ""

    def with_tool(self, tool: pin.SE3 | ArrayLike, name: str = "tool") -> Robot:
        """Return the same robot with a frame fixed to its tip, which becomes the tip.

        Args:
            tool: Pose of the tool in the tip's frame: a Pinocchio SE3, or x, y, z [m] and roll,
                pitch, yaw [rad] as in a URDF's ``<origin>``, (6,).
            name: Name of the frame, which is none of the robot's.

        Raises:
            InvalidInputError: If the pose is neither, or not finite, or the name is taken.
        """
        if name in self.frame_names:
            raise InvalidInputError("tool", f"the robot has a frame {name!r} already", name)
        if not isinstance(tool, pin.SE3):
            xyz_rpy = checks.finite_array("tool", tool, (6,)).copy()
            tool = pin.SE3(pin.rpy.rpyToMatrix(xyz_rpy[3:]), xyz_rpy[:3])
        tip = self.model.frames[self.tip_id]
        pose = tip.placement * tool
        model = self.model.copy()
        model.addFrame(pin.Frame(name, tip.parentJoint, self.tip_id, pose, pin.FrameType.OP_FRAME))
        return replace(self, model=model, tip=name)

    def start_posture(self) -> checks.Array:
        """Choose joint positions (n,) [rad] to start from, inside the limits and not singular.

        A robot of a known name and number of joints starts from its known posture
        (`iiwa_dnn.robot.arms.STARTS`), if that is inside its limits. Any other starts from the
        middle of its joints' ranges, if the smallest singular value of the tip's Jacobian is at
        least `SINGULAR` there; else from that of 200 postures, drawn with a fixed seed from the
        inner 60 % of the ranges, where it is largest. Fewer than six joints are judged by the rows
        of position. Singular values that are 0 in every posture, as a planar arm has, do not count.

        Source of the criterion: C. A. Klein, B. E. Blaho, "Dexterity measures for the design and
        control of kinematically redundant manipulators", Int. J. Robotics Research 6(2), 1987. It
        mixes [m/rad] with [rad/rad] here, and collisions are not considered.
        """
        known = np.array(STARTS.get(self.name, ()))
        fits = known.size == self.dof and not self.mimics
        if fits and (self.q_lower < known).all() and (known < self.q_upper).all():
            return known
        drawn = np.random.default_rng(0).uniform(0.2, 0.8, (200, self.dof))
        postures = self._inside(np.vstack([np.full(self.dof, 0.5), drawn]))
        smallest = self._smallest_singular_values(postures)
        best = 0 if smallest[0] >= SINGULAR else int(smallest.argmax())
        return np.array(postures[best])

    def draw(self, random: np.random.Generator, count: int) -> checks.Array:
        """Draw joint positions inside the limits, evenly, (count, n) [rad]."""
        return self._inside(random.uniform(0.0, 1.0, (count, self.dof)))

    def _inside(self, ratios: checks.Array) -> checks.Array:
        """Return postures at ratios of the joints' ranges, (k, n) [rad], mimics at their leaders.

        In place of an infinite limit there is one 2 pi from 0, or from the other limit.
        """
        nearest = np.clip(0.0, self.q_lower, self.q_upper)
        lower = np.maximum(self.q_lower, nearest - 2.0 * np.pi)
        upper = np.minimum(self.q_upper, nearest + 2.0 * np.pi)
        postures: checks.Array = lower + (upper - lower) * ratios
        for mimic in self.mimics:
            j = self.joint_names.index(mimic.joint)
            followed = postures[:, self.joint_names.index(mimic.leader)]
            position = mimic.multiplier * followed + mimic.offset
            postures[:, j] = np.clip(position, lower[j], upper[j])
        return postures

    def _smallest_singular_values(self, postures: checks.Array) -> checks.Array:
        """Compute the smallest singular value of the tip's Jacobian in each posture (k, n), (k,).

        If it is 0 in every posture, as a planar arm's is, the next larger one counts; if all are,
        the result is infinite.
        """
        data = self.model.createData()
        jacobians = [
            pin.computeFrameJacobian(self.model, data, q, self.tip_id, pin.LOCAL_WORLD_ALIGNED)
            for q in postures
        ]
        rows = 6 if self.dof >= 6 else 3
        judged = np.reshape(jacobians, (-1, 6, self.dof))[:, :rows]
        values = np.linalg.svd(judged, compute_uv=False)
        values = values[:, values.max(axis=0) > 1e-9]
        smallest: checks.Array = values.min(axis=1, initial=np.inf)
        return smallest

    def __repr__(self) -> str:
        locked = f", locked: {', '.join(self.locked)}" if self.locked else ""
        return f"<Robot {self.name}: {self.dof} joints, tip {self.tip}{locked}>"

    def __reduce__(self) -> tuple[object, ...]:
        # numpy forgets on pickling that an array is read-only; the constructor does not.
        return Robot, tuple(getattr(self, f.name) for f in fields(self) if f.init)


def file_of(robot: Robot) -> Path:
    """Return the URDF file of a robot, or raise an InvalidInputError if it comes from none."""
    if robot.path is None:
        raise InvalidInputError("robot", "must come from a URDF file", robot)
    return robot.path


def urdf_of(robot: Robot) -> str:
    """Return the text of a robot's URDF, or raise an InvalidInputError if it has none."""
    file_of(robot)
    if robot.urdf is None:
        raise InvalidInputError("robot", "must be loaded from a URDF file", robot)
    return robot.urdf


def _limit(argument: str, value: ArrayLike, size: int) -> checks.Array:
    """Return one limit per joint, read-only, from a number or one per joint."""
    try:
        array = np.array(np.broadcast_to(np.asarray(value, dtype=np.float64), (size,)))
    except (TypeError, ValueError) as error:
        raise InvalidInputError(argument, f"must be one number or {size}", value) from error
    if np.isnan(array).any():
        raise InvalidInputError(argument, "must not be NaN", value)
    array.setflags(write=False)
    return array
