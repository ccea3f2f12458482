"""Robots: a Pinocchio model with its tip frame and its limits, loaded from a URDF file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.arms import ARMS


@dataclass(frozen=True, eq=False, repr=False)
class Robot:
    """A robot arm: what the rest of the package needs to know of it, and nothing that changes.

    The limits are this object's own: :meth:`with_limits` replaces them and leaves ``model`` alone.
    Angles are in [rad]; a prismatic joint counts in [m].

    Attributes:
        name: Name of the robot, from its URDF.
        model: The Pinocchio model; each of its n joints has one coordinate. Treat as read-only.
        tip: Name of the frame that follows references.
        q_lower: Lower joint position limits [rad], shape (n,); -inf where there is none.
        q_upper: Upper joint position limits [rad], shape (n,); inf where there is none.
        dq_max: Joint velocity limits [rad/s], shape (n,); inf where there is none.
        locked: Names of the URDF's joints that were frozen on loading.
        path: The URDF file, where the robot came from one.
        tip_id: Pinocchio's index of the tip frame.
        limits: ``q_lower``, ``q_upper`` and ``dq_max`` as the rows of one array, shape (3, n), for
            compiled code; do not write into it (`Configuration.arrays` says why it could be).

    Raises:
        NotFoundError: If the model has no frame ``tip``.
        InvalidInputError: If no joint moves the tip, or a limit is not acceptable.
    """

    name: str
    model: pin.Model
    tip: str
    q_lower: NDArray[np.float64]
    q_upper: NDArray[np.float64]
    dq_max: NDArray[np.float64]
    locked: tuple[str, ...] = ()
    path: Path | None = None
    tip_id: int = field(init=False)
    limits: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        tip_id = _frame_id(self.model, self.tip)
        if self.model.frames[tip_id].parentJoint == 0:
            raise InvalidInputError("tip", f"no joint moves frame {self.tip!r}", self.tip)
        object.__setattr__(self, "tip_id", tip_id)
        for name in ("q_lower", "q_upper", "dq_max"):
            object.__setattr__(self, name, _limit(name, getattr(self, name), self.dof))
        _check_order("q_lower", self.q_lower, self.q_upper)
        _check_positive("dq_max", self.dq_max)
        limits = np.stack([self.q_lower, self.q_upper, self.dq_max])
        object.__setattr__(self, "limits", limits)

    @property
    def dof(self) -> int:
        """Number of joints, n."""
        return int(self.model.nv)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the n joints, in the order of q."""
        return tuple(self.model.names)[1:]

    def frame_id(self, name: str) -> int:
        """Return Pinocchio's index of a frame.

        Raises:
            NotFoundError: The robot has no frame of that name; the error lists those near to it.
        """
        return _frame_id(self.model, name)

    def with_limits(
        self,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
    ) -> Robot:
        """The same robot with other limits; those not given stay as they are.

        Args:
            lower: Lower joint position limits [rad], one number for all joints or shape (n,);
                -inf for none.
            upper: Upper joint position limits [rad], likewise; inf for none.
            velocity: Joint velocity limits [rad/s], likewise, above zero; inf for none.

        Returns:
            A new robot; this one is unchanged.

        Raises:
            InvalidInputError: If a limit is not a number, has a wrong length, is not below its
                upper counterpart or, for ``velocity``, is not above zero.
        """
        q_lower = self.q_lower if lower is None else _limit("lower", lower, self.dof)
        q_upper = self.q_upper if upper is None else _limit("upper", upper, self.dof)
        dq_max = self.dq_max if velocity is None else _limit("velocity", velocity, self.dof)
        _check_order("upper" if lower is None else "lower", q_lower, q_upper)
        _check_positive("velocity", dq_max)
        return replace(self, q_lower=q_lower, q_upper=q_upper, dq_max=dq_max)

    def __repr__(self) -> str:
        locked = f", locked: {', '.join(self.locked)}" if self.locked else ""
        return f"<Robot {self.name}: {self.dof} joints, tip {self.tip}{locked}>"

    def __reduce__(self) -> tuple[object, ...]:
        # numpy forgets on pickling that an array is read-only; the constructor does not.
        return Robot, tuple(getattr(self, f.name) for f in fields(self) if f.init)


def available_robots() -> tuple[str, ...]:
    """Names of the robots that come with the package, for :func:`load_robot`.

    It knows those of `iiwa_dnn.robot.arms` too, whose files are in another package.
    """
    files = _robots_folder().glob("*/*.urdf")
    return tuple(sorted(file.stem for file in files if file.parent.name == file.stem))


def load_robot(
    name_or_path: str | os.PathLike[str],
    tip: str | None = None,
    locked: Iterable[str] = (),
) -> Robot:
    """Load a robot by its name or from a URDF file.

    Limits are the URDF's. A joint whose ``<limit>`` gives neither ``lower`` nor ``upper`` has no
    position limit, and a ``velocity`` of 0 stands for "not given": no velocity limit.

    Args:
        name_or_path: A name out of :func:`available_robots` or `iiwa_dnn.robot.arms.ARMS`, or the
            path of a URDF file: a :class:`~pathlib.Path`, or a string that ends in ``.urdf`` or
            has a separator in it.
        tip: Frame that is to follow references. Default: that of the name (`iiwa_dnn.robot.arms`),
            or the link at the end of the chain, for a robot that has only one end.
        locked: Names of joints to freeze, each at its zero position or at the limit nearest to it;
            an arm loaded by name has the joints of its gripper frozen besides.

    Returns:
        The robot.

    Raises:
        NotFoundError: If there is no such robot, frame or joint; the error lists those that exist.
        FileError: If the file cannot be read, is not a URDF, or its limits make no sense.
        InvalidInputError: If the robot has several ends and no ``tip`` is given, or a joint that is
            left free has more or less than one coordinate, or follows another joint.
        MissingDependencyError: If the arm of that name is in a package that is not installed.
    """
    arm = ARMS.get(name_or_path) if isinstance(name_or_path, str) else None
    path = _find(name_or_path) if arm is None else arm.path
    text, joints = urdf.read(path)
    chosen = (locked,) if isinstance(locked, str) else tuple(locked)
    frozen = tuple(dict.fromkeys((*(arm.locked if arm is not None else ()), *chosen)))
    full = urdf.build_model(path, text)
    # Not the locked model: Pinocchio's reduction loses which frame a locked joint hangs on.
    if tip is None:
        tip = _default_tip(full) if arm is None else arm.tip
    model = urdf.lock(full, frozen)
    urdf.check_one_coordinate_each(model, joints)
    # By the name it was asked for: the URDFs call some of these arms otherwise.
    name = model.name if arm is None else str(name_or_path)
    robot = Robot(name, model, tip, *urdf.limits(path, model, joints), frozen, path)
    urdf.check_no_mimic(model, robot.tip_id, joints)
    return robot


def _robots_folder() -> Path:
    """The robots' folder: beside this module in an installed wheel, above it in the repository."""
    here = Path(__file__).resolve().parents[1]
    inside = here / "robots"
    return inside if inside.is_dir() else here.parent / "robots"


def _find(name_or_path: str | os.PathLike[str]) -> Path:
    if not isinstance(name_or_path, str | os.PathLike):
        raise InvalidInputError("name_or_path", "must be a robot's name or a path", name_or_path)
    text = os.fspath(name_or_path)
    has_separator = any(s in text for s in (os.sep, os.altsep, "/") if s)
    if isinstance(name_or_path, os.PathLike) or text.endswith(".urdf") or has_separator:
        return Path(text)
    available = available_robots()
    if text not in available:
        raise NotFoundError("robot", text, (*available, *ARMS))
    return _robots_folder() / text / f"{text}.urdf"


def _frame_id(model: pin.Model, name: str) -> int:
    names = [frame.name for frame in model.frames]
    if name not in names:
        # Links first: they are what one mostly means.
        bodies = [frame.name for frame in model.frames if frame.type == pin.FrameType.BODY]
        raise NotFoundError("frame", name, dict.fromkeys(bodies + names[1:]))
    if names.count(name) > 1:  # a link and a joint may share a name
        return int(model.getFrameId(name, pin.FrameType.BODY))
    return names.index(name)


def _default_tip(model: pin.Model) -> str:
    parents = {frame.parentFrame for frame in model.frames}
    ends = [
        frame.name
        for index, frame in enumerate(model.frames)
        if frame.type == pin.FrameType.BODY and index not in parents
    ]
    if len(ends) != 1:
        raise InvalidInputError("tip", f"is needed: the robot has several ends: {', '.join(ends)}")
    return str(ends[0])


def _limit(argument: str, value: ArrayLike, size: int) -> NDArray[np.float64]:
    """A read-only array of one limit per joint, out of a number or one per joint."""
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(argument, "must be numbers", value) from error
    if array.ndim == 0:
        array = np.full(size, array)
    if array.shape != (size,):
        raise InvalidInputError(argument, f"must be one number or {size}, not {array.shape}", value)
    if np.isnan(array).any():
        raise InvalidInputError(argument, "must not be NaN", value)
    array.setflags(write=False)
    return array


def _check_order(argument: str, lower: NDArray[np.float64], upper: NDArray[np.float64]) -> None:
    for i in np.flatnonzero(lower >= upper):
        problem = f"joint {i + 1}: lower limit {lower[i]:g} is not below upper limit {upper[i]:g}"
        raise InvalidInputError(argument, problem, (lower, upper))


def _check_positive(argument: str, velocity: NDArray[np.float64]) -> None:
    for i in np.flatnonzero(velocity <= 0.0):
        problem = f"joint {i + 1}: {velocity[i]:g} is not above 0"
        raise InvalidInputError(argument, problem, velocity)
