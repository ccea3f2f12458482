"""Answers of steps without a solution, in one compiled call: limits hold, the task yields.

`iiwa_dnn.control.policies` says what each policy means. The step's own program came first, unless
the task yielded at the last step; then

1. the scaling factor of the task is computed, by position and velocity limits alone. If it is 1,
   the task as it is; with ``slow``, along a path, the scaled program;
2. else the softened program;
3. else the next command of a motion to rest.

With acceleration or jerk limits the command is a point on the way to the answer of that program,
within the bounds of the step; where collisions are avoided too, one from which the arm can stop
(`iiwa_dnn.control.stopping`), in the end the next command of the braking motion in hand.
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.command import NOT_SETTLED, SOLVED, RowViews, note_command
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.relaxed import (
    MOST_SYSTEMS,
    REACHED,
    Yielding,
    attained,
    largest_entry,
    largest_factor,
    nearest_within,
    note_blocking,
    scale_task,
    settled,
    soften_task,
)
from iiwa_dnn.control.state import BEFORE, DELAY, LAST, REST, WANTED, YIELDS, Q, kept_distances
from iiwa_dnn.control.stopping import (
    least_periods,
    next_velocity,
    stopping_time,
)
from iiwa_dnn.networks.integrators.base import TOLERANCE
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import row_dot, times
from iiwa_dnn.qp.layout import QPViews, copied, qp_views
from iiwa_dnn.qp.residuals import point_residuals, within
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.limits import NUMBERS, braking, constant_periods
from iiwa_dnn.schemes.program import ProgramArrays, StepProgram
from iiwa_dnn.schemes.scene import scene_views

NONE, SLOW, RELAX, STOP, _ = map(int, Action)
BRAKE = -1
"""No policy: the arm goes to rest."""

OWN, SCALED, SOFTENED, HELD, STOPPED = map(int, ProgramKind)

CREEP = 0.1
"""Scaling factor below which the task is softened, and share of a period by which the clock then
advances: an arm that rests in a singular or unreachable pose does not hold its target there."""

SINGULAR = 0.05
"""Below it a pose counts as singular: what the tip moves for each unit of joint velocity [m/rad].
There the joints would race for next to nothing."""

POSITION_GAIN = 20.0
"""Rate at which the wanted velocity falls towards a position limit [1/s]."""

HALVINGS = 4
HALVINGS_NEAR = 12
"""Shares of the way from the braking motion in hand to the wanted command that are tried, each half
of the one before: where a pair began nearer, there is but a micrometre for the motion's curve."""


def make_yielding(program: StepProgram, tol: float, dt: float, alike: bool) -> Yielding:
    """Prepare for a scheme that is laid out for a robot.

    Args:
        program: The scheme.
        tol: Tolerance of the answers.
        dt: Control period [s].
        alike: Whether the network of the steps is that of the relaxed programs.
    """
    limits: Vector = np.zeros(0)
    if program.rate_limits is not None:
        limits = program.rate_limits.numbers(program.robot)
    scenes = program.constants_of(CollisionAvoidance)
    weights = program.row_weights
    return Yielding(
        weights,
        limits,
        np.array([tol, float(MOST_SYSTEMS)]),
        np.array(scenes, dtype=np.int64).reshape(-1, 2),
        dt,
        constant_periods(dt),
        bool((limits.reshape(NUMBERS, -1)[4] < np.inf).any()),
        bool((weights == 0.0).any()),
        alike,
    )


@compiled
def yield_step(
    views: RowViews,
    arrays: ProgramArrays,
    past: Matrix,
    following: Matrix,
    yielding: Yielding,
    relaxed: Vector,
    action: int,
) -> int:
    """Answer a step for which the network has no answer, or whose task yielded at the last step.

    Args:
        views: The row, with the step's own program and what it was built at.
        arrays: Arrays of the loop; the kinematics are at the joint positions of `past`.
        past: `ControllerState.past`, (8 + k, dof).
        following: The same for the next step, with the last commands; the rest is overwritten.
        yielding: Weights, limits and settings of the relaxed programs.
        relaxed: States of the networks of relaxed programs, (`relaxed_size`,), advanced.
        action: Action that the policy asks for; `BRAKE`: the arm goes to rest, whatever has a
            solution.

    Returns:
        The action that was taken.
    """
    table = arrays.table
    dof = table[0, 3]
    qp = qp_views(views.program, table[0, 0], table[0, 1], table[0, 2])
    data = views.program.copy()
    own = qp_views(data, table[0, 0], table[0, 1], table[0, 2])
    kind = STOPPED
    factor = 0.0
    rest = 0.0
    if action != BRAKE:
        _widen_bounds(qp, yielding.limits, past[Q])
        found, factor = _answer_relaxed(views, qp, yielding, relaxed, action)
        kind = int(found)
    x = views.point[: qp.q.size].copy()
    limits = QPViews(qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, own.lb, own.ub)
    if kind != STOPPED:
        _step(limits, past, following, yielding, views.figures, x)
        rest = _make_stoppable(limits, arrays, past, following, yielding, views, x)
        missing = _note_missing(views, x[:dof])
        primal, dual, gap = point_residuals(limits, views.point)
        if missing > 0:
            kind = STOPPED if action == STOP else HELD
        elif factor == 1.0 and within(primal, dual, gap, yielding.settings[TOLERANCE]):
            kind = OWN
            copied(qp.lb, own.lb)
            copied(qp.ub, own.ub)
    if kind == STOPPED:
        copied(views.program, data)
        rest = _brake(own, arrays, past, yielding, views, x)
        _go_along(past, following)
        views.point[:] = 0.0
        copied(views.point, x)
    views.figures[2], views.figures[3], views.figures[4] = point_residuals(qp, views.point)
    _note_decision(views, own, yielding, x, kind, factor, action)
    following[REST, 0] = rest
    following[DELAY, 0] += yielding.dt * (1.0 - views.decision[1])
    following[YIELDS, 0] = kind != OWN and action != BRAKE
    note_command(views, following, x, yielding.dt)
    return int(views.decision[0])


@compiled
def _note_decision(
    views: RowViews,
    own: QPViews,
    yielding: Yielding,
    x: Vector,
    kind: int,
    factor: float,
    action: int,
) -> None:
    """Note the action, how far the reference's clock advances, status and kind of the program.

    Args:
        views: The step's row.
        own: The step's own program.
        yielding: Weights of its task rows, and whose the network is.
        x: The command, (n,).
        kind: Kind of the program that was answered.
        factor: Scaling factor of the task in it.
        action: Action that the policy asks for.
    """
    taken = STOP
    fraction = 0.0
    if kind <= SCALED:
        taken = NONE if factor == 1.0 else SLOW
        fraction = factor
    elif kind != STOPPED:
        taken = action if kind == HELD or _is_path(views.targets) else RELAX
        fraction = 1.0
        if taken == SLOW:
            fraction = max(attained(own.b, own.A, yielding.weights, x), CREEP)
    views.decision[0] = taken
    views.decision[1] = fraction
    if taken == STOP:
        views.decision[2] = max(views.decision[2], float(NOT_SETTLED))
    elif kind != OWN or yielding.alike:
        views.decision[2] = SOLVED
    elif views.decision[2] >= NOT_SETTLED:  # the answer is not that of the network that failed
        views.figures[2] = np.inf
    views.decision[3] = kind


@compiled
def _widen_bounds(qp: QPViews, limits: Vector, q: Vector) -> None:
    """Replace bounds that acceleration limits have narrowed by those of position and velocity."""
    dof = limits.size // NUMBERS
    for i in range(dof):
        fastest = limits[2 * dof + i]
        qp.lb[i] = min(max(POSITION_GAIN * (limits[i] - q[i]), -fastest), fastest)
        qp.ub[i] = min(max(POSITION_GAIN * (limits[dof + i] - q[i]), -fastest), fastest)


@compiled
def _answer_relaxed(
    views: RowViews, qp: QPViews, yielding: Yielding, relaxed: Vector, action: int
) -> tuple[float, float]:
    """Turn a step's program into the first relaxed one that has a solution, and answer it.

    Returns:
        Its kind, and the scaling factor of the task in it.
    """
    n = qp.q.size
    m = qp.h.size
    point = np.empty(2 * n + 2 + m + qp.b.size)
    size = 3 * n + 3 + m + qp.b.size
    factor = largest_factor(qp, yielding, relaxed[:size], point, views.figures, False)
    note_blocking(point, n, m, 1, views.blocking)
    follows = action == SLOW and _is_path(views.targets) and not _races(qp, point[:n])
    if factor == 1.0 or (follows and factor >= CREEP):
        asked = qp.b.copy()
        scale_task(qp, yielding.weights, factor)
        if settled(qp, yielding.settings, relaxed[size:], views.point, views.figures):
            return SCALED, factor
        copied(qp.b, asked)
    if action == STOP:
        return STOPPED, 0.0
    retreat = 1.0
    if factor < 0.0:
        retreat = largest_factor(qp, yielding, np.zeros(size), point, views.figures, True)
        retreat = max(retreat, 0.0)  # what cannot be said to retreat may come no nearer
    soften_task(qp, yielding.weights, retreat)
    found = settled(qp, yielding.settings, relaxed[size:], views.point, views.figures)
    note_blocking(views.point, n, m, 0, views.blocking)
    return SOFTENED if found else STOPPED, 0.0


@compiled
def _is_path(targets: Matrix) -> bool:
    """Test whether a target (k, 18) has a velocity."""
    fastest = 0.0
    for k in range(targets.shape[0]):
        fastest = max(fastest, largest_entry(targets[k, 12:]))
    return fastest > 0.0


@compiled
def _races(qp: QPViews, x: Vector) -> bool:
    """Test whether joints of the velocity x (n,) race while the tip hardly moves."""
    tip = 0.0
    for j in range(qp.b.size):
        tip = max(tip, abs(row_dot(qp.A, j, x)))
    return tip < SINGULAR * largest_entry(x)


@compiled
def _note_missing(views: RowViews, dq: Vector) -> int:
    """Note the joints whose command dq (dof,) is short of the answer; return how many are."""
    count = 0
    for i in range(dq.size):
        missing = views.point[i] - dq[i]
        if abs(missing) > REACHED:
            views.blocking[i] = math.copysign(1.0, missing)
            count += 1
    return count


@compiled
def _step(
    limits: QPViews,
    past: Matrix,
    following: Matrix,
    yielding: Yielding,
    figures: Vector,
    x: Vector,
) -> None:
    """Turn a wanted velocity x (n,) into the next command on the way to it.

    Args:
        limits: The program that was answered, with the bounds of the step.
        past: `ControllerState.past`, (8 + k, dof).
        following: `ControllerState.following`, (8 + k, dof): the wanted velocity is noted.
        yielding: Weights, limits and settings.
        figures: Figures of the answer, (5,), as of `settled`.
        x: The velocity, overwritten.
    """
    if yielding.limits.size == 0:
        return
    copied(following[WANTED], x[: past.shape[1]])
    # Joints that follow others have to go with them, on a straight line.
    if yielding.coupled:
        _step_straight(past, yielding, x)
    else:
        _step_towards(limits, past, yielding, x)
    nearest_within(limits, x, yielding, figures)


@compiled
def _step_towards(limits: QPViews, past: Matrix, yielding: Yielding, x: Vector) -> None:
    """Replace the wanted velocity x (n,) by the next command of joints that hurry to it.

    Each joint goes as quickly as its limits allow, without passing a velocity that goes on changing
    as it has done since the last step.
    """
    dof = past.shape[1]
    for i in range(dof):
        most = yielding.limits[3 * dof + i] * yielding.periods.dt
        change = min(max(x[i] - past[WANTED, i], -most), most)
        behind = past[LAST, i] - (x[i] - change)
        rate = yielding.limits[4 * dof + i]
        x[i] += braking(behind, limits.lb[i] - x[i], limits.ub[i] - x[i], rate, yielding.periods)


@compiled
def _step_straight(past: Matrix, yielding: Yielding, x: Vector) -> None:
    """Replace the wanted velocity x (n,) by the next command on the straight line to it."""
    dof = past.shape[1]
    now = np.empty(dof)
    before = np.empty(dof)
    for i in range(dof):
        now[i] = past[LAST, i] - x[i]
        before[i] = past[BEFORE, i] - x[i]
    periods = least_periods(now, before, yielding.limits, yielding.periods.dt, yielding.cubic)
    for i in range(dof):
        if periods < np.inf:
            x[i] += next_velocity(now[i], before[i], periods, yielding.cubic)


@compiled
def _make_stoppable(
    limits: QPViews,
    arrays: ProgramArrays,
    past: Matrix,
    following: Matrix,
    yielding: Yielding,
    views: RowViews,
    x: Vector,
) -> float:
    """Bring a command x (n,) nearer to the braking motion in hand until the arm can stop from it.

    Returns:
        Periods until it rests; 0 where none is asked for.
    """
    dof = past.shape[1]
    rest = stopping_time(arrays, past, views.least, yielding, x[:dof])
    if rest >= 0.0:
        return rest
    wanted = views.point[: x.size].copy()
    if yielding.limits.size:
        _step_straight(past, yielding, wanted)
        nearest_within(limits, wanted, yielding, views.figures)
    brake = np.zeros(x.size)
    left = _brake(limits, arrays, past, yielding, views, brake)
    share = 1.0
    for _ in range(HALVINGS_NEAR if _is_near(arrays, yielding, views.least) else HALVINGS):
        for i in range(dof):
            x[i] = brake[i] + share * (wanted[i] - brake[i])
        rest = stopping_time(arrays, past, views.least, yielding, x[:dof])
        if rest >= 0.0:
            return rest
        share *= 0.5
    copied(x, brake)
    _go_along(past, following)
    return left


@compiled
def _is_near(arrays: ProgramArrays, yielding: Yielding, least: Vector) -> bool:
    """Test whether a pair keeps less than the least distance of its scene, `least` (pairs,) [m]."""
    found = False
    for k in range(len(yielding.scenes)):
        own = arrays.constants[yielding.scenes[k, 0] : yielding.scenes[k, 1]]
        scene = scene_views(own, arrays.jacobian.shape[0])
        for i in range(len(scene.pairs)):
            found = found or least[scene.head.first + i] < scene.head.least
    return found


@compiled
def _go_along(past: Matrix, following: Matrix) -> None:
    """Let pairs keep the distances for which a braking motion in hand was verified."""
    if past[REST, 0] > 0.0:
        copied(kept_distances(following), kept_distances(past))


@compiled
def _brake(
    limits: QPViews,
    arrays: ProgramArrays,
    past: Matrix,
    yielding: Yielding,
    views: RowViews,
    dq: Vector,
) -> float:
    """Write the next command (n,) of the braking motion in hand, or of the quickest one.

    It is zero without acceleration limits. The quickest one keeps the bounds as far as they do not
    lead away from rest; no row asks it for motion.

    Returns:
        Periods that are left afterwards; 0 if no motion is in hand.
    """
    dq[:] = 0.0
    if yielding.limits.size == 0:
        return 0.0
    rest: float = past[REST, 0]
    dof = past.shape[1]
    dt = yielding.periods.dt
    periods = rest
    if rest == 0.0:
        periods = least_periods(past[LAST], past[BEFORE], yielding.limits, dt, yielding.cubic)
    if periods < np.inf:
        _slow_down(past, yielding, periods, dq)
    if rest > 0.0 and not yielding.periods.vary:
        return max(rest - 1.0, 0.0)
    lb = limits.lb.copy()
    ub = limits.ub.copy()
    # Where periods vary, the motion in hand is fitted anew: bounds that any period keeps go first.
    for i in range(dq.size if periods < np.inf and rest == 0.0 else 0):
        lb[i] = min(lb[i], max(dq[i], 0.0))
        ub[i] = max(ub[i], min(dq[i], 0.0))
    # Joints that follow others go on to, as they brake.
    rates = np.zeros(limits.b.size)
    idle = np.empty(limits.h.size)
    idle[:] = np.inf
    times(limits.A, dq, rates)
    braking = QPViews(limits.P, limits.q, limits.G, idle, limits.A, rates, lb, ub)
    nearest_within(braking, dq, yielding, views.figures)
    if rest > 0.0:
        return max(rest - 1.0, 0.0)
    return max(stopping_time(arrays, past, views.least, yielding, dq[:dof]), 0.0)


@compiled
def _slow_down(past: Matrix, yielding: Yielding, periods: float, dq: Vector) -> None:
    """Write the next command (n,) on the straight way to rest in so many periods."""
    dof = past.shape[1]
    for i in range(dof):
        last = past[LAST, i]
        fastest = max(yielding.limits[2 * dof + i], abs(last))
        change = yielding.limits[3 * dof + i] * yielding.periods.dt
        dq[i] = next_velocity(last, past[BEFORE, i], periods, yielding.cubic)
        # Where the control period has changed, the curve has too.
        dq[i] = min(max(dq[i], last - change), last + change)
        dq[i] = min(max(dq[i], -fastest), fastest)


@compiled
def guard_step(arrays: ProgramArrays, past: Matrix, following: Matrix, yielding: Yielding) -> bool:
    """Test whether the command that `following` holds is stoppable, and note its way to rest.

    Args:
        arrays: Arrays of the loop.
        past: `ControllerState.past`, (8 + k, dof).
        following: `ControllerState.following`, (8 + k, dof).
        yielding: Limits and scenes.
    """
    rest = stopping_time(arrays, past, kept_distances(following), yielding, following[LAST])
    following[REST, 0] = max(rest, 0.0)
    return rest >= 0.0
