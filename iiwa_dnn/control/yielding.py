"""Answers of steps without a solution, in one compiled call: limits hold, the task yields.

`iiwa_dnn.control.policies` says what each policy means. The step's own program came first; then

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
from iiwa_dnn.control.command import NOT_SETTLED, SOLVED, RowViews, row_views
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.relaxed import (
    ALMOST,
    Yielding,
    attained,
    nearest_within,
    note_blocking,
    retreat_factor,
    scale_task,
    scaling_factor,
    settled_again,
    soften_task,
)
from iiwa_dnn.control.state import BEFORE, LAST, REST, WANTED, Q
from iiwa_dnn.control.stopping import (
    Instant,
    enter_stopping_time,
    has_jerk,
    least_periods,
    next_velocity,
    stopping_time,
)
from iiwa_dnn.networks.integrators.base import BUDGET, TOLERANCE, enter_answer
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import row_dot
from iiwa_dnn.qp.layout import QPViews, qp_views
from iiwa_dnn.qp.residuals import point_residuals, within
from iiwa_dnn.schemes.limits import braking
from iiwa_dnn.schemes.program import ProgramArrays

ATTEMPTS = 13
"""Programs at most: the step's own with a budget of its own; from a last state and from a cold
start the search of the scaling factor, the task as it is, the scaled and the softened program; the
search of the retreat's factor; the points nearest to two commands, and the step's own once more."""

NONE = int(Action.NONE)
SLOW = int(Action.SLOW)
RELAX = int(Action.RELAX)
STOP = int(Action.STOP)
BRAKE = -1
"""No policy: the arm goes to rest."""

OWN = int(ProgramKind.OWN)
SCALED = int(ProgramKind.SCALED)
SOFTENED = int(ProgramKind.SOFTENED)
HELD = int(ProgramKind.HELD)
STOPPED = int(ProgramKind.STOPPED)

CREEP = 0.1
"""Scaling factor below which the task is softened, and share of a period by which the clock then
advances: an arm that rests in a singular or unreachable pose does not hold its target there."""

NEAR = 5.0
"""Linear systems for the step's own program from the answer within wider bounds: where its own
bounds leave room for the task, that is near."""

FEASIBLE = 1.0 - 1e-9
"""Scaling factor above which the step's own program has a solution."""

SINGULAR = 0.05
"""Below it a pose counts as singular: what the tip moves for each unit of joint velocity [m/rad].
There the joints would race for next to nothing."""

POSITION_GAIN = 20.0
"""Rate at which the wanted velocity falls towards a position limit [1/s]."""

REACHED = 1e-9
"""Difference of two velocities that is rounding [rad/s], or of a row's right-hand side from 0."""

TOWARDS = (1.0, 0.5, 0.25, 0.125)
"""Shares of the way from the braking motion in hand to the wanted command that are tried."""


def with_limits(yielding: Yielding) -> Yielding:
    """Return `yielding` with what the limits of braking need, compiled if it has any."""
    if len(yielding.scenes):
        yielding = yielding._replace(stop=enter_stopping_time.address(stopping_time))
    return yielding


@compiled
def yield_step(
    row: Vector,
    arrays: ProgramArrays,
    past: Matrix,
    following: Matrix,
    state: Vector,
    yielding: Yielding,
    relaxed: Vector,
    action: int,
) -> int:
    """Answer a step for which the network has no answer, or whose task yielded at the last step.

    Args:
        row: The row, (width,), as `control_step` has left it.
        arrays: Arrays of the loop; the kinematics are at the joint positions of `past`.
        past: `ControllerState.past`, (5, dof).
        following: `ControllerState.following`, (5, dof), overwritten.
        state: The network's state, (size,), advanced.
        yielding: Weights, limits and settings of the relaxed programs.
        relaxed: States of the networks of relaxed programs, (`relaxed_size`,), advanced.
        action: Action that the policy asks for; `BRAKE`: the arm goes to rest, whatever has a
            solution.

    Returns:
        The action that was taken.
    """
    table = arrays.table
    dof = table[0, 3]
    views = row_views(row, table[0, 0], table[0, 1], table[0, 2], dof)
    qp = qp_views(views.program, table[0, 0], table[0, 1], table[0, 2])
    data = views.program.copy()
    own = qp_views(data, table[0, 0], table[0, 1], table[0, 2])
    instant = instant_of(arrays, past, following)
    _begin(views, instant)
    kind = STOPPED
    factor = 0.0
    rest = 0.0
    if action != BRAKE:
        _widen_bounds(qp, yielding.limits, past[Q])
        kind, factor = _answer_relaxed(views, qp, yielding, state, relaxed, action)
    if kind == SCALED and factor == 1.0:
        rest = _answer_own(views, qp, own, instant, yielding, state)
        kind = OWN if rest >= 0.0 else SCALED
    x = views.point[: qp.q.size].copy()
    if kind != STOPPED and kind != OWN:
        limits = QPViews(qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, own.lb, own.ub)
        rest = _approach(views, limits, instant, yielding, x)
        if _note_missing(views, x[:dof]) > 0:
            kind = STOPPED if action == STOP else HELD
    if kind == STOPPED:
        for k in range(data.size):
            views.program[k] = data[k]
        rest = _brake(views, own, instant, yielding, x)
    _note_crossed(views, own)
    _note_decision(views, own, yielding.weights, x, kind, factor, action)
    _note_command(views, qp, instant, x, rest)
    return int(views.decision[0])


@compiled
def _begin(views: RowViews, instant: Instant) -> None:
    """Note that nothing is in the way, and that the last step's velocity is still wanted."""
    for k in range(views.blocking.size):
        views.blocking[k] = 0.0
    for i in range(instant.q.size):
        instant.following[WANTED, i] = instant.wanted[i]


@compiled
def _answer_own(
    views: RowViews,
    qp: QPViews,
    own: QPViews,
    instant: Instant,
    yielding: Yielding,
    state: Vector,
) -> float:
    """Answer a step's own program, which has a solution within wider bounds, within its own.

    Returns:
        Periods until a braking motion from the answer rests, 0 where none is asked for; -1 if there
        is no answer, or the arm cannot stop from it: program and answer are then as before.
    """
    settings = yielding.settings.copy()
    settings[BUDGET] = NEAR
    tried = state.copy()
    point = np.empty(views.point.size)
    systems, _, primal, dual, gap = enter_answer(yielding.answer, own, 0, settings, tried, point)
    views.figures[0] += systems
    if not within(primal, dual, gap, settings[TOLERANCE]):
        return -1.0
    rest = _stopping_time(instant, yielding, point)
    if rest < 0.0:
        return rest
    for k in range(point.size):
        views.point[k] = point[k]
    for k in range(state.size):
        state[k] = tried[k]
    for i in range(qp.q.size):
        qp.lb[i] = own.lb[i]
        qp.ub[i] = own.ub[i]
    return rest


@compiled
def _note_decision(
    views: RowViews,
    own: QPViews,
    weights: Vector,
    x: Vector,
    kind: int,
    factor: float,
    action: int,
) -> None:
    """Note the action, how far the reference's clock advances, status and kind of the program.

    Args:
        views: The step's row.
        own: The step's own program.
        weights: Weights of its task rows, (p,).
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
            fraction = max(attained(own.b, own.A, weights, x), CREEP)
    views.decision[0] = taken
    views.decision[1] = fraction
    views.decision[2] = max(views.decision[2], float(NOT_SETTLED)) if taken == STOP else SOLVED
    views.decision[3] = kind


@compiled
def _note_command(views: RowViews, qp: QPViews, instant: Instant, x: Vector, rest: float) -> None:
    """Note the command x (n,), the answer's residuals, and what the next step has to know.

    After the command a braking motion takes `rest` periods.
    """
    views.figures[2], views.figures[3], views.figures[4] = point_residuals(qp, views.point)
    instant.following[REST, 0] = rest
    for i in range(views.dq.size):
        views.dq[i] = x[i]
        instant.following[BEFORE, i] = instant.last[i]
        instant.following[LAST, i] = x[i]


@compiled
def _widen_bounds(qp: QPViews, limits: Vector, q: Vector) -> None:
    """Replace bounds that acceleration limits have narrowed by those of position and velocity."""
    dof = q.size
    if limits.size == 0:
        return
    for i in range(dof):
        fastest = limits[2 * dof + i]
        qp.lb[i] = min(max(POSITION_GAIN * (limits[i] - q[i]), -fastest), fastest)
        qp.ub[i] = min(max(POSITION_GAIN * (limits[dof + i] - q[i]), -fastest), fastest)


@compiled
def _answer_relaxed(
    views: RowViews,
    qp: QPViews,
    yielding: Yielding,
    state: Vector,
    relaxed: Vector,
    action: int,
) -> tuple[int, float]:
    """Turn a step's program into the first relaxed one that has a solution, and answer it.

    Returns:
        Its kind, and the scaling factor of the task in it.
    """
    n = qp.q.size
    point = np.empty(2 * n + 2 + qp.h.size + qp.b.size)
    size = 3 * n + 3 + qp.h.size + qp.b.size
    factor = scaling_factor(qp, yielding, relaxed[:size], point, views.figures)
    note_blocking(point, n, qp.h.size, 1, views.blocking)
    if factor >= FEASIBLE and _answered(views, qp, yielding, state):
        return SCALED, 1.0
    on_path = action == SLOW and _is_path(views.targets)
    if on_path and factor >= CREEP and not _races(qp, point[:n]):
        asked = qp.b.copy()
        scale_task(qp, yielding.weights, ALMOST * factor)
        if _answered(views, qp, yielding, state):
            return SCALED, ALMOST * factor
        for j in range(asked.size):
            qp.b[j] = asked[j]
    if action == STOP:
        return STOPPED, 0.0
    return _answer_softened(views, qp, yielding, relaxed[size:], point), 0.0


@compiled
def _answer_softened(
    views: RowViews, qp: QPViews, yielding: Yielding, state: Vector, point: Vector
) -> int:
    """Turn a step's program into the softened one, and answer it; return its kind, or `STOPPED`.

    The point is that of `retreat_factor`, overwritten.
    """
    n = qp.q.size
    retreat = retreat_factor(qp, yielding, point, views.figures)
    if retreat < 0.0:
        note_blocking(point, n, qp.h.size, 1, views.blocking)
        return STOPPED
    soften_task(qp, yielding.weights, retreat if retreat >= FEASIBLE else ALMOST * retreat)
    found = _answered(views, qp, yielding, state)
    note_blocking(views.point, n, qp.h.size, 0, views.blocking)
    return SOFTENED if found else STOPPED


@compiled
def _answered(views: RowViews, qp: QPViews, yielding: Yielding, state: Vector) -> bool:
    """Let a network answer a program from its last state (size,) or a cold start."""
    found: bool = settled_again(qp, yielding, state, views.point, views.figures, 1.0)
    return found


@compiled
def _is_path(targets: Matrix) -> bool:
    """Test whether a target (k, 18) has a velocity."""
    for k in range(targets.shape[0]):
        for i in range(12, 18):
            if targets[k, i] != 0.0:
                return True
    return False


@compiled
def _races(qp: QPViews, x: Vector) -> bool:
    """Test whether joints of the velocity x (n,) race while the tip hardly moves."""
    joints = 0.0
    tip = 0.0
    for i in range(qp.q.size):
        joints += x[i] * x[i]
    for j in range(qp.b.size):
        speed = row_dot(qp.A, j, x)
        tip += speed * speed
    return tip < SINGULAR * SINGULAR * joints


@compiled
def _note_crossed(views: RowViews, own: QPViews) -> None:
    """Note the bounds that contradict each other, if there are any, in place of all else."""
    n = own.q.size
    crossed = 0
    for i in range(n):
        crossed += own.lb[i] > own.ub[i]
    if crossed == 0:
        return
    for k in range(views.blocking.size):
        views.blocking[k] = 1.0 if k < n and own.lb[k] > own.ub[k] else 0.0


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
def _approach(
    views: RowViews, limits: QPViews, instant: Instant, yielding: Yielding, x: Vector
) -> float:
    """Turn a wanted velocity x (n,) into the next command on the way to it.

    Args:
        views: The step's row, with the wanted velocity as its answer.
        limits: The program that was answered, with the bounds of the step.
        instant: What else is known; which velocity is wanted is noted in it.
        yielding: Weights, limits and settings.
        x: The velocity, overwritten.

    Returns:
        Periods until a braking motion from it rests; 0 where none is asked for.
    """
    if yielding.limits.size:
        for i in range(instant.q.size):
            instant.following[WANTED, i] = x[i]
        # Joints that follow others have to go with them, on a straight line.
        if _has_couplings(yielding.weights):
            _step_straight(limits, instant, yielding, x)
        else:
            _step_towards(limits, instant, yielding, x)
        nearest_within(limits, x, yielding, views.figures)
    rest = _stopping_time(instant, yielding, x)
    if rest < 0.0:
        rest = _make_stoppable(views, limits, instant, yielding, x)
    return rest


@compiled
def _has_couplings(weights: Vector) -> bool:
    """Test whether task rows of weight 0 among (p,) are limits, of joints that follow others."""
    count = 0
    for j in range(weights.size):
        count += weights[j] == 0.0
    return count > 0


@compiled
def _stopping_time(instant: Instant, yielding: Yielding, x: Vector) -> float:
    """Compute the periods of the motion to rest from a command x (n,); 0 if none is asked for.

    It is -1 if the motion breaks a limit, or brings a pair too near.
    """
    if not yielding.stop:
        return 0.0
    rest: float = enter_stopping_time(yielding.stop, instant, yielding, x[: instant.q.size])
    return rest


@compiled
def _step_towards(limits: QPViews, instant: Instant, yielding: Yielding, x: Vector) -> None:
    """Replace the wanted velocity x (n,) by the next command of joints that hurry to it.

    Each joint goes as quickly as its limits allow, without passing a velocity that goes on changing
    as it has done since the last step.
    """
    dof = instant.q.size
    for i in range(dof):
        aim = x[i]
        most = yielding.limits[3 * dof + i] * yielding.dt
        change = min(max(aim - instant.wanted[i], -most), most)
        behind = instant.last[i] - (aim - change)
        rate = yielding.limits[4 * dof + i]
        x[i] = aim + braking(behind, limits.lb[i] - aim, limits.ub[i] - aim, rate, yielding.dt)
        x[i] = min(max(x[i], limits.lb[i]), limits.ub[i])


@compiled
def _step_straight(limits: QPViews, instant: Instant, yielding: Yielding, x: Vector) -> None:
    """Replace the wanted velocity x (n,) by the next command on the straight line to it."""
    dof = instant.q.size
    now = np.empty(dof)
    before = np.empty(dof)
    for i in range(dof):
        now[i] = instant.last[i] - x[i]
        before[i] = instant.before[i] - x[i]
    periods = least_periods(now, before, yielding.limits, yielding.dt)
    cubic = has_jerk(yielding.limits)
    for i in range(dof):
        if periods < np.inf:
            x[i] += next_velocity(now[i], before[i], periods, cubic)
        x[i] = min(max(x[i], limits.lb[i]), limits.ub[i])


@compiled
def _make_stoppable(
    views: RowViews, limits: QPViews, instant: Instant, yielding: Yielding, x: Vector
) -> float:
    """Bring a command x (n,) nearer to the braking motion in hand until the arm can stop from it.

    Returns:
        Periods until it rests.
    """
    dof = instant.q.size
    wanted = views.point[: x.size].copy()
    if yielding.limits.size:
        _step_straight(limits, instant, yielding, wanted)
        nearest_within(limits, wanted, yielding, views.figures)
    brake = np.zeros(x.size)
    left = _braking_command(limits, instant, yielding, brake)
    for share in TOWARDS:
        for i in range(dof):
            x[i] = brake[i] + share * (wanted[i] - brake[i])
        rest = _stopping_time(instant, yielding, x)
        if rest >= 0.0:
            return rest
    if not _has_couplings(yielding.weights) and _go_away(limits, instant.last, x[:dof]):
        rest = _stopping_time(instant, yielding, x)
        if rest >= 0.0:
            return rest
    for i in range(dof):
        x[i] = brake[i]
    return left


@compiled
def _go_away(limits: QPViews, last: Vector, dq: Vector) -> bool:
    """Write the command dq (dof,) that goes straight away from what is too near.

    A row stands for the nearest point of a link. Where the link lies along an obstacle, what the
    softened program asks for may lead another of its points nearer, and would hold the arm there.
    The arm sets off along the rows' gradients, and goes on in the direction of its last command.

    Returns:
        False if no row asks for a retreat, or the bounds allow none in that direction.
    """
    moving = 0.0
    near = 0
    for j in range(limits.h.size):
        near += limits.h[j] < -REACHED
    for i in range(dq.size):
        moving += abs(last[i])
    least = 0.0
    most = np.inf
    for i in range(dq.size):
        dq[i] = last[i]
        for j in range(limits.h.size):
            if moving == 0.0 and limits.h[j] < -REACHED:
                dq[i] -= limits.G[j, i]
        if dq[i] != 0.0:
            least = max(least, min(limits.lb[i] / dq[i], limits.ub[i] / dq[i]))
            most = min(most, max(limits.lb[i] / dq[i], limits.ub[i] / dq[i]))
    if near == 0 or not least <= most < np.inf:
        return False
    for i in range(dq.size):
        dq[i] *= most
    return True


@compiled
def _brake(views: RowViews, own: QPViews, instant: Instant, yielding: Yielding, x: Vector) -> float:
    """Take the next command x (n,) of a motion to rest, as the answer too.

    Returns:
        Periods until it rests; 0 if the motion was not in hand.
    """
    for i in range(x.size):
        x[i] = 0.0
    rest = _braking_command(own, instant, yielding, x)
    for k in range(views.point.size):
        views.point[k] = x[k] if k < x.size else 0.0
    return rest


@compiled
def _braking_command(limits: QPViews, instant: Instant, yielding: Yielding, dq: Vector) -> float:
    """Write the next command (dof,) of the braking motion in hand, or of the quickest one.

    It is zero without acceleration limits.

    Returns:
        Periods that are left afterwards; 0 if the motion was not in hand.
    """
    if yielding.limits.size == 0:
        return 0.0
    periods = instant.rest
    if periods == 0.0:
        periods = least_periods(instant.last, instant.before, yielding.limits, yielding.dt)
    cubic = has_jerk(yielding.limits)
    for i in range(instant.q.size):
        if periods < np.inf:
            dq[i] = next_velocity(instant.last[i], instant.before[i], periods, cubic)
        if instant.rest == 0.0:
            dq[i] = min(max(dq[i], limits.lb[i]), limits.ub[i])
    return max(instant.rest - 1.0, 0.0)


@compiled
def instant_of(arrays: ProgramArrays, past: Matrix, following: Matrix) -> Instant:
    """Bring together what is known at a step.

    Args:
        arrays: Arrays of the loop.
        past: `ControllerState.past`, (5, dof).
        following: `ControllerState.following`, (5, dof).
    """
    return Instant(
        past[Q],
        past[LAST],
        past[BEFORE],
        past[WANTED],
        past[REST, 0],
        following,
        arrays.jacobian,
        arrays.placements,
        arrays.constants,
    )


@compiled
def guard_step(arrays: ProgramArrays, past: Matrix, following: Matrix, yielding: Yielding) -> bool:
    """Test whether the command that `following` holds is stoppable, and note its way to rest.

    Args:
        arrays: Arrays of the loop.
        past: `ControllerState.past`, (5, dof).
        following: `ControllerState.following`, (5, dof).
        yielding: Limits and scenes.
    """
    instant = instant_of(arrays, past, following)
    rest: float = enter_stopping_time(yielding.stop, instant, yielding, following[LAST])
    following[REST, 0] = max(rest, 0.0)
    return rest >= 0.0
