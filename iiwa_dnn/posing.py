r"""Inverse kinematics of a pose, by QPs with the tasks and limits of a control step.

Each iteration linearizes the pose of the tip and the distances of all pairs of bodies at the
posture :math:`q`, and asks for the step :math:`\Delta q` of

.. math::

    \min_{\Delta q} \tfrac12 \|J \Delta q - e\|^2 + \tfrac12 \lambda \|D^{-1} \Delta q\|^2
    \quad \text{s.t.} \quad q_{lower} - q \le \Delta q \le q_{upper} - q,
    \quad -\nabla d_i^T \Delta q \le d_i - d_s

with the pose error :math:`e`, position [m] over rotation vector [rad], and no joint by more than
half its unit: :math:`D_{ii}` is 1 rad for a joint that turns, and the larger of 1 m and a tenth of
its range for one that slides. The damping is :math:`\lambda = \mu \|e\|^2`, with :math:`\mu = 0.1`
unless a step did not make the error smaller: it is taken back, and :math:`\mu` rises until one
does. Near a posture that has the pose the damping vanishes and the convergence is quadratic;
elsewhere the end is a posture whose pose is the nearest one around. Where no start leads to the
pose, the ends go on with orientation errors weighed a hundredth, and then none: the position comes
first. The multipliers there name the active limits.

Sources: T. Sugihara, "Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt
method", IEEE Trans. Robotics 27(5), 2011, for the damping; D. W. Marquardt, "An algorithm for
least-squares estimation of nonlinear parameters", J. SIAM 11(2), 1963, for its change.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import LimitKind, active_limits, describe
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Vector
from iiwa_dnn.qp.layout import IntVector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.obstacles import Obstacle
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    JointCouplingTask,
    JointLimits,
    Limit,
    PoseTask,
    Scheme,
)
from iiwa_dnn.schemes.collisions import ENDS
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.step.requests import TWIST

_STEP = 0.5
"""Largest change of a joint in an iteration, as a part of its scale (`_units`)."""

_MOST = 100
"""Largest number of iterations from one start."""

_DAMPING = 0.1
"""Least ratio mu of the damping to the squared error."""

_STILL = 1e-7
"""Relative change of the error that ends the iterations away from the pose."""

_ACTS = 1e-3
"""Least ratio of a multiplier to the error for which a limit counts as active."""

REACHED = 1e-4
"""Distance [m] and angle [rad] from a pose of a chunk up to which it counts as reached."""

_CLOSE = 1e-6
"""The same that its search ends at."""

_UNIT_WITHIN = 0.01
"""Difference of a quaternion's norm from 1 that is forgiven: rounding to few digits."""

_SECOND = 1e-2
"""Weight of the orientation error if the pose is not reached [m/rad]."""

Poses = ArrayLike | Mapping[str, ArrayLike]
"""Poses of one frame, or those of several by their names."""


@dataclass(frozen=True)
class PoseSolution:
    """Answer of `solve_pose`.

    Attributes:
        q: Joint positions [rad] whose pose is the target's, (n,); None if none was found.
        nearest: Configuration at `q`; if none was found, the one nearest to the target's position,
            and with the least orientation error there.
        position_error: Distance of `nearest` from the target [m].
        orientation_error: Angle between the orientations of `nearest` and of the target [rad].
        active_limits: Limits and obstacles that keep `nearest` from the target, in words. If empty
            though no posture was found, its links are too short, its joints too few, or it is
            folded another way.
    """

    q: Vector | None
    nearest: Configuration
    position_error: float
    orientation_error: float
    active_limits: tuple[str, ...]

    @property
    def found(self) -> bool:
        """Test whether there is a posture."""
        return self.q is not None


class _Point(NamedTuple):
    """Iterate of the search for a posture.

    Attributes:
        q: Joint positions [rad], (n,).
        qp: Program of a step at `q`. The first six equality rows are the tip's Jacobian, linear
            over angular, and the error from the tip to the goal, position [m] over rotation vector
            [rad]; the angular rows are multiplied by the weight of the orientation. Of several
            frames there are six rows each.
        missing: Merit of the iterate: squared norm of the pose error, plus the violations of
            distances [m] and of mimic couplings [rad].
        far: Largest of the position error [m], the weighted angle [rad], and these violations.
    """

    q: Vector
    qp: QP
    missing: float
    far: float


def solve_pose(
    robot: Robot,
    target: Target,
    q0: ArrayLike | None = None,
    *,
    orientation: Literal["so3", "none"] = "so3",
    obstacles: Sequence[Obstacle] | CollisionAvoidance = (),
    starts: int = 20,
    seed: int = 0,
    tol: float = 1e-9,
) -> PoseSolution:
    """Find joint positions within the limits at which the tip has a pose, or a position alone.

    Of those that several starts lead to, it is the one nearest to `q0`. The first start is `q0`
    itself, the others are drawn at random within the limits. Of a pose that none of them leads to,
    as most are for an arm of five joints, the position comes first.

    Args:
        robot: The robot, n joints.
        target: The pose of the tip; its velocity does not matter.
        q0: Joint positions [rad], (n,); None takes the robot's start posture.
        orientation: ``"so3"``, or ``"none"`` to leave it free.
        obstacles: Obstacles that the arm keeps clear of, where they are at time 0, and it keeps
            clear of itself then too. A `CollisionAvoidance` says the distance; without obstacles
            nothing is watched.
        starts: Number of starts.
        seed: Seed of the random starts.
        tol: Largest error of the pose [m], [rad].

    Raises:
        InvalidInputError: An argument is out of range; the message names it.
    """
    checks.instance("target", target, Target)
    home = checks.instance("robot", robot, Robot).start_posture()
    begin = home if q0 is None else checks.finite_array("q0", q0, (robot.dof,))
    checks.integer("starts", starts, 1)
    checks.positive("tol", tol)
    weight = float(checks.one_of("orientation", orientation, ("so3", "none")) == "so3")
    program = _program(robot, obstacles)
    solver = DNNSolver(tol=1e-12)
    goal = np.concatenate([target.data[:12], np.zeros(6)])[np.newaxis]
    random = np.random.default_rng(checks.integer("seed", seed, 0))
    postures = [np.clip(begin, robot.q_lower, robot.q_upper), *robot.draw(random, starts - 1)]
    descend = partial(_descend, program, solver, goal, tol)
    ends = [descend(posture, weight) for posture in postures]
    found = [end for end in ends if end.far <= tol]
    if not found and weight > 0.0:
        weight = _SECOND
        ends = [descend(descend(end.q, weight).q, 0.0) for end in ends]
        ends = [_at(program, end.q, goal, weight) for end in ends]
    best = min(ends, key=lambda end: end.missing)
    if found:
        best = min(found, key=lambda end: float(np.linalg.norm(end.q - begin)))
    error = _at(program, best.q, goal, 1.0).qp.b
    return PoseSolution(
        best.q if found else None,
        Configuration(robot, best.q),
        math.hypot(*error[:3]),
        math.hypot(*error[3:6]),
        () if found else _active_limits(program, solver, best, weight),
    )


class PoseChunk(NamedTuple):
    """Joint positions of timed poses, as `solve_poses` finds them.

    Attributes:
        times: Times of the poses that are reached [s], (k,).
        positions: Their joint positions [rad], (k, n).
        places: Their numbers among all poses, (k,).
        left_out: Number of each pose that is left out, and why.
    """

    times: Vector
    positions: Matrix
    places: IntVector
    left_out: dict[int, str]


def solve_poses(
    robot: Robot, times: Vector, poses: Poses, q0: Vector, frame: str | None
) -> PoseChunk:
    """Find joint positions for timed poses in turn, each from those of the one before.

    Two kinds of poses are left out: those from which the frame stays more than `REACHED` away, but
    for the orientation of an arm of less than six joints; and those to which a joint would have to
    move faster than its velocity limit since the last pose that was not, as beside a singular one.

    Args:
        robot: The robot, n joints.
        times: Time of each pose [s], (m,), rising.
        poses: Position [m] of each, (m, 3), or also its quaternion w, x, y, z, (m, 7), or a
            homogeneous matrix, (m, 4, 4); or a mapping of the names of several frames to theirs.
            One that is not finite has NaN as joint positions.
        q0: Joint positions before them [rad], (n,).
        frame: Name of the frame of one; None stands for the tip.

    Raises:
        InvalidInputError: The poses have another shape, or are no rotations.
        NotFoundError: The robot has no frame of that name.
    """
    named = _by_frame(robot, poses, frame)
    frames = sorted(named, key=lambda name: name != robot.tip)  # the tip first, as of a program
    found_goals = [_goals(times.size, named[name]) for name in frames]
    goals = np.stack([each for each, _ in found_goals], axis=1)
    weight = np.array([own for _, own in found_goals])
    program = _program(robot, (), frames)
    descend = partial(_descend, program, DNNSolver(tol=1e-12))
    q = np.clip(q0, robot.q_lower, robot.q_upper)
    last = -np.inf
    found: dict[int, Vector] = {}
    left_out: dict[int, str] = {}
    for k, (t, goal) in enumerate(zip(times.tolist(), goals, strict=True)):
        if not np.isfinite(goal).all():
            found[k] = np.full(robot.dof, np.nan)
            continue
        end = descend(goal, _CLOSE, q, weight)
        if robot.dof < TWIST * len(goal) and end.far > _CLOSE:
            near = descend(goal, _CLOSE, end.q, _SECOND * weight)
            end = descend(goal, _CLOSE, near.q, 0.0 * weight)
        ratio = np.abs(end.q - q) / ((t - last) * robot.dq_max)
        if end.far > REACHED:
            limits = _active_limits(program, DNNSolver(tol=1e-12), end, weight)
            left_out[k] = ", ".join(["out of reach", *limits])
        elif ratio.max() > 1.0:
            left_out[k] = f"joint {1 + int(ratio.argmax())} too fast, as beside a singular posture"
        else:
            found[k] = q = end.q
            last = t
    places = np.array([*found], dtype=np.int64)
    positions = np.array([*found.values()]).reshape(-1, robot.dof)
    return PoseChunk(times[places], positions, places, left_out)


def _by_frame(robot: Robot, poses: Poses, frame: str | None) -> Mapping[str, ArrayLike]:
    """Return the poses of each frame by its name."""
    if not isinstance(poses, Mapping):
        return {frame or robot.tip: poses}
    if frame is not None or not poses:
        raise InvalidInputError("frame", "is stated by poses of several frames", frame)
    return poses


def _goals(count: int, poses: ArrayLike) -> tuple[Matrix, float]:
    """Return targets (m, 18), or NaN, of m poses, and the weight of their orientations."""
    shapes = {2: (count, 7), 3: (count, 4, 4)}
    shape = (count, 3) if np.shape(poses)[1:] == (3,) else shapes.get(np.ndim(poses), (count, 7))
    own = checks.array("poses", poses, shape)
    goals = np.full((count, len(Target(np.zeros(3)).data)), np.nan)
    for k in np.flatnonzero(np.isfinite(own.reshape(count, -1)).all(axis=1)):
        goals[k] = _goal(own[k]).data
    return goals, float(shape[1] != 3)


def _goal(pose: Vector | Matrix) -> Target:
    """Return a position (3,), with a quaternion w, x, y, z (7,), or a matrix (4, 4) as a target."""
    if pose.ndim == 2:
        return Target(pose[:3, 3], pose[:3, :3])
    if pose.size == 3:
        return Target(pose)
    w, x, y, z = pose[3:]
    if not abs(math.hypot(w, x, y, z) - 1.0) <= _UNIT_WITHIN:
        raise InvalidInputError("poses", "must have quaternions w, x, y, z of norm 1", pose)
    return Target(pose[:3], pin.Quaternion(w, x, y, z).normalized().matrix())


def _program(
    robot: Robot,
    obstacles: Sequence[Obstacle] | CollisionAvoidance,
    frames: Sequence[str | None] = (None,),
) -> ProgramLayout:
    """Lay out the program of an iteration, in which velocities are changes of the joints."""
    slowed = robot.with_limits(velocity=_STEP * _units(robot))
    limits: list[Limit] = [JointLimits(gain=1.0)]
    if not isinstance(obstacles, CollisionAvoidance) and obstacles != ():
        obstacles = CollisionAvoidance(obstacles)
    if isinstance(obstacles, CollisionAvoidance):
        rows = ENDS * len(obstacles.scene(slowed).pairs)
        limits.append(replace(obstacles, gain=1.0, nearest=rows))
    tasks = [PoseTask(gain=1.0, frame=frame) for frame in frames]
    return Scheme([], tasks, limits).program(slowed)


def _units(robot: Robot) -> Vector:
    """Return the scale of each joint's step, (n,): 1 rad; if prismatic, max(1 m, range / 10)."""
    slides = np.isin(np.arange(robot.dof), list(robot.slides))
    return np.where(slides, np.maximum(1.0, 0.1 * (robot.q_upper - robot.q_lower)), 1.0)


def _descend(
    program: ProgramLayout,
    solver: DNNSolver,
    goal: Matrix,
    tol: float,
    start: Vector,
    weight: float | Vector,
) -> _Point:
    """Iterate from a start (n,) [rad] until the goal (1, 18) is reached or the error stalls."""
    damping = _DAMPING
    point = _at(program, start, goal, weight)
    for _ in range(_MOST):
        if point.far <= tol:
            break
        step = _solve(program, solver, point, damping)
        if not step.found:
            break
        trial = _at(program, np.clip(point.q + step.x, *program.robot.limits[:2]), goal, weight)
        gained = point.missing - trial.missing
        if gained > 0.0:
            damping = max(0.2 * damping, _DAMPING)
            point = trial
        else:
            damping *= 8.0
        if abs(gained) <= _STILL * point.missing:
            break
    return point


def _at(program: ProgramLayout, q: Vector, goal: Matrix, weight: float | Vector) -> _Point:
    """Evaluate the iterate at q (n,) [rad] for k goals (k, 18), with weights of orientations."""
    qp = program.qp_at(q, 0.0 * q, 0.0 * q, goal, np.inf)
    rows = TWIST * len(goal)
    scale = _scale(program, weight)
    qp.A[:rows] *= scale[:, np.newaxis]
    qp.b[:rows] *= scale
    error = qp.b[:rows]
    linkage = qp.b[rows:]
    linkage /= JointCouplingTask.gain  # of a step, as the pose
    violations = np.concatenate([np.abs(linkage), np.maximum(-qp.h, 0.0)])
    missing = float(error @ error + violations.sum())
    far = max(np.linalg.norm(error.reshape(-1, 3), axis=1).max(), violations.max(initial=0.0))
    return _Point(q, qp, missing, far)


def _solve(program: ProgramLayout, solver: DNNSolver, point: _Point, damping: float) -> Solution:
    """Solve for the step of an iteration; `damping` is mu, the ratio to the squared pose error."""
    qp = point.qp
    rows = TWIST * len(program.target_frames)
    jacobian = qp.A[:rows]
    error = qp.b[:rows]
    weights = (_STEP / program.robot.dq_max) ** 2
    P = jacobian.T @ jacobian + damping * float(error @ error) * np.diag(weights)
    return solver.solve(
        QP(P, -error @ jacobian, qp.G, qp.h, qp.A[rows:], qp.b[rows:], qp.lb, qp.ub)
    )


def _scale(program: ProgramLayout, weight: float | Vector) -> Vector:
    """Return a factor of each row of the frames' poses, from the weights of their orientations."""
    scale = np.ones((len(program.target_frames), TWIST))
    scale[:, 3:] = np.reshape(weight, (-1, 1))
    return scale.reshape(-1)


def _active_limits(
    program: ProgramLayout, solver: DNNSolver, point: _Point, weight: float | Vector
) -> tuple[str, ...]:
    """Name the limits whose multipliers are active at an iterate that misses the goal.

    Velocity limits are left out: in this program they limit the step of an iteration, not a
    posture.
    """
    step = _solve(program, solver, point, _DAMPING)
    scale = _scale(program, weight)
    least = _ACTS * float(np.linalg.norm(scale * point.qp.b[: scale.size]))
    lower, upper, pairs = program.kinds
    codes = np.where(step.z_box > 0.0, upper, -lower) * (np.abs(step.z_box) > least)
    codes[np.abs(codes) == LimitKind.VELOCITY] = 0
    rows = (step.z > least) * (1.0 + pairs)
    return tuple(map(describe, active_limits(LimitNames(program).settings, codes, rows)))
