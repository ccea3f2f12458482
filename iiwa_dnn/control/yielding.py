"""Answers of steps without a solution, in one compiled call: limits hold, the task yields.

`iiwa_dnn.control.policies` says what each policy means. With acceleration or jerk limits a command
goes on a straight line towards the velocity that the softened program asks for. Where collisions
are avoided too, a command is given only if it is stoppable (`iiwa_dnn.control.stopping`); if not,
one nearer to the braking motion in hand is, and in the end that motion itself.

A step ends after `ATTEMPTS` programs: its own or one more for a stopped arm, the others of
`relaxed.BUDGET` linear systems.
"""

import math

import numpy as np
from numba import types

from iiwa_dnn.control.command import (
    NOT_SETTLED,
    PAST,
    PLACEMENT,
    ROW_VIEWS,
    SOLVED,
    RowViews,
    row_views,
)
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.relaxed import (
    REACHED,
    YIELDING,
    Yielding,
    enter_factor,
    enter_violation,
    held_rows,
    inside,
    nearest_within,
    note_blocking,
    on_rows,
)
from iiwa_dnn.control.state import BEFORE, LAST, REST, WANTED, Q
from iiwa_dnn.control.stopping import (
    INSTANT,
    STOP_TIME,
    Instant,
    enter_stopping_time,
    has_jerk,
    least_periods,
    next_velocity,
    stopping_time,
)
from iiwa_dnn.networks.integrators.base import TOLERANCE, enter_answer
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.compiling import VECTOR, Signature
from iiwa_dnn.qp.dense import row_dot
from iiwa_dnn.qp.layout import QP_VIEWS, QPViews, compiled, qp_views
from iiwa_dnn.qp.residuals import point_residuals, within
from iiwa_dnn.schemes.motion_limits import braking
from iiwa_dnn.schemes.program import ProgramArrays

ATTEMPTS = 16
"""Programs at most: the step's own with a budget of its own, five passes of the scaled one, then
three times the step's own from its last state and from a cold start, and the softened one, with
each part of `relaxed.TRIES` and the nearest point that gives all, or the nearest command's."""

NONE = int(Action.NONE)
FALLBACK = int(Action.FALLBACK)
SLOW = int(Action.SLOW)
RELAX = int(Action.RELAX)
STOP = int(Action.STOP)
NOTHING = -1
"""No action: another way has to be tried."""

CREEP = 0.1
"""Share of a period by which a slowed clock always advances: an arm that rests in a singular or
unreachable pose does not hold its target there."""

FEASIBLE = 1.0 - 1e-9
"""Scaling factor above which the step's own program has a solution."""

NEARLY = 0.5
"""Share of the task velocity from which on it is worth looking whether all of it can be had."""

SINGULAR = 0.05
"""Below it a pose counts as singular: what the tip moves for each unit of joint velocity [m/rad].
There the joints would race for next to nothing; ``slow`` goes slower in proportion."""

STUCK = 1e-3
"""A scaling factor below it is none: the task yields as with ``relax``, and the clock creeps on."""

LESS = (1.0, 0.99)
"""Shares of the scaled task that are asked for: at the very edge of what is feasible the
multipliers may grow without bound, where a little less has room enough."""

TOWARDS = (1.0, 0.5, 0.25, 0.125)
"""Shares of the way from the braking motion in hand to the wanted command that are tried."""


APPROACH = Signature(
    types.int64, ROW_VIEWS, QP_VIEWS, INSTANT, YIELDING, VECTOR, types.int64, types.boolean
)
"""Types of `approach`, which is compiled only where it is needed."""

enter_approach = APPROACH.enter


@compiled
def _yield_at_once(
    views: RowViews,
    qp: QPViews,
    q: Vector,
    yielding: Yielding,
    state: Vector,
    action: int,
    yields: bool,
) -> int:
    """Answer a step without acceleration limits; arguments and result as those of `yield_step`."""
    taken = NOTHING
    if action == SLOW and _is_path(views.targets):
        taken = _slow(views, qp, yielding, state, yields)
        if taken == NOTHING:
            taken = _relax(views, qp, q, yielding, state, CREEP, yields)
    elif action != STOP:
        taken = _relax(views, qp, q, yielding, state, 1.0, yields)
    elif yields and _answered(views, qp, yielding, state):
        _clear_blocking(views)
        taken = NONE
    if taken == NOTHING:
        _stop(views)
        _note_residuals(views, qp)
        taken = STOP
    return taken


@compiled
def _clear_blocking(views: RowViews) -> None:
    """Note that nothing stands in the way."""
    for k in range(views.blocking.size):
        views.blocking[k] = 0.0


@compiled
def _note_crossed(views: RowViews, qp: QPViews) -> bool:
    """Note the bounds that contradict each other; return whether there are any."""
    crossed = False
    for i in range(qp.q.size):
        if qp.lb[i] > qp.ub[i]:
            if not crossed:
                _clear_blocking(views)
            crossed = True
            views.blocking[i] = 1.0
    return crossed


@compiled
def _name_blocking(views: RowViews, qp: QPViews, yielding: Yielding, q: Vector) -> bool:
    """Note what stands in the way of the task as it is, or which limits contradict each other.

    Returns:
        Whether the program at joint positions q (dof,) has a solution.
    """
    n = qp.q.size
    m = qp.h.size
    point = np.empty(2 * n + 2 + m + qp.b.size)
    factor: float = enter_factor(yielding.factor, qp, yielding, point)
    note_blocking(point, n, m, 1, views.blocking)
    if not factor >= 0.0:
        limits = np.empty(2 * n + m + held_rows(yielding.weights))
        if not enter_violation(yielding.violation, qp, yielding, q, limits):
            note_blocking(limits, n, m, 0, views.blocking)
    return factor >= FEASIBLE


@compiled
def _is_finite(views: RowViews, qp: QPViews) -> bool:
    """Test whether a program has no NaN, and only finite task velocities."""
    wrong = 0
    for k in range(views.program.size):
        wrong += views.program[k] != views.program[k]
    for j in range(qp.b.size):
        wrong += not abs(qp.b[j]) < np.inf
    return wrong == 0


@compiled
def _is_path(targets: Matrix) -> bool:
    """Test whether a target (k, 18) has a velocity."""
    for k in range(targets.shape[0]):
        for i in range(12, 18):
            if targets[k, i] != 0.0:
                return True
    return False


@compiled
def _answered(views: RowViews, qp: QPViews, yielding: Yielding, state: Vector) -> bool:
    """Let the network answer a program from its last state or, if need be, from a cold start."""
    tried = state.copy()
    settings = yielding.settings
    total = 0.0
    for _ in range(2):
        systems, time, primal, dual, gap = enter_answer(
            yielding.answer, qp, 0, settings, tried, views.point
        )
        total += systems
        if within(primal, dual, gap, settings[TOLERANCE]):
            for i in range(tried.size):
                state[i] = tried[i]
            views.figures[0] = total
            views.figures[1] = time
            views.figures[2] = primal
            views.figures[3] = dual
            views.figures[4] = gap
            views.decision[1] = 1.0
            views.decision[2] = SOLVED
            return True
        for i in range(tried.size):
            tried[i] = 0.0
    return False


@compiled
def _judge(views: RowViews, qp: QPViews, fraction: float, status: int) -> None:
    """Note the residuals of a decided answer, how far the clock advances, and a status."""
    views.figures[0] = 0.0
    views.figures[1] = 0.0
    _note_residuals(views, qp)
    views.decision[1] = fraction
    views.decision[2] = status


@compiled
def _note_residuals(views: RowViews, qp: QPViews) -> None:
    """Note the residuals of the answer that is taken."""
    views.figures[2], views.figures[3], views.figures[4] = point_residuals(qp, views.point)


@compiled
def _slow(views: RowViews, qp: QPViews, yielding: Yielding, state: Vector, yields: bool) -> int:
    """Go along the path, slower; return the action, or `NOTHING` where that has no sense."""
    n = qp.q.size
    m = qp.h.size
    point = np.empty(2 * n + 2 + m + qp.b.size)
    factor = enter_factor(yielding.factor, qp, yielding, point)
    if factor >= FEASIBLE and _answered(views, qp, yielding, state):
        return NONE if yields else FALLBACK
    share = _brake(qp, point)
    if not share * factor >= STUCK:
        return NOTHING
    note_blocking(point, n, m, 1, views.blocking)
    asked = qp.b.copy()
    for less in LESS:
        for j in range(qp.b.size):
            # Not s b: this right-hand side has a solution to the last bit.
            qp.b[j] = asked[j]
            if yielding.weights[j] > 0.0:
                qp.b[j] = less * share * row_dot(qp.A, j, point[:n])
        if _answered(views, qp, yielding, state):
            views.decision[1] = less * share * factor
            return SLOW
    for j in range(qp.b.size):
        qp.b[j] = asked[j]
    return NOTHING


@compiled
def _brake(qp: QPViews, point: Vector) -> float:
    """Compute the share of a velocity to take where joints race and the tip hardly moves.

    The velocity (n,) begins `point`. An arm that may not rest is not braked.
    """
    joints = 0.0
    for i in range(qp.q.size):
        joints += point[i] * point[i]
        if qp.lb[i] > 0.0 or qp.ub[i] < 0.0:
            return 1.0
    for j in range(qp.h.size):
        if qp.h[j] < 0.0:
            return 1.0
    tip = 0.0
    for j in range(qp.b.size):
        tip += row_dot(qp.A, j, point[: qp.q.size]) ** 2
    if tip >= SINGULAR * SINGULAR * joints:
        return 1.0
    return math.sqrt(tip / joints) / SINGULAR


@compiled
def _relax(
    views: RowViews,
    qp: QPViews,
    q: Vector,
    yielding: Yielding,
    state: Vector,
    fraction: float,
    yields: bool,
) -> int:
    """Violate the task least; the clock advances by a fraction of the period.

    Returns:
        The action, or `NOTHING` if the limits contradict each other.
    """
    n = qp.q.size
    m = qp.h.size
    point = np.empty(2 * n + m + held_rows(yielding.weights))
    found = enter_violation(yielding.violation, qp, yielding, q, point)
    may_hold = found and fraction == 1.0 and _has_solution(qp, yielding, point)
    if may_hold and _answered(views, qp, yielding, state):
        return NONE if yields else FALLBACK
    note_blocking(point, n, m, 0, views.blocking)
    if not found:
        return NOTHING
    _take(views, qp, point, fraction)
    return RELAX if fraction == 1.0 else SLOW


@compiled
def _has_solution(qp: QPViews, yielding: Yielding, point: Vector) -> bool:
    """Test whether a step's program has a solution, from the softened program's, (n,) or more."""
    n = qp.q.size
    x = point[:n].copy()
    if on_rows(qp, x) and inside(qp, x):
        return True
    if _attained(qp, yielding.weights, point) < NEARLY:
        return False
    scaled = np.empty(2 * n + 2 + qp.h.size + qp.b.size)
    factor: float = enter_factor(yielding.factor, qp, yielding, scaled)
    return factor >= FEASIBLE


@compiled
def _take(views: RowViews, qp: QPViews, x: Vector, fraction: float) -> None:
    """Take a velocity (n,) as the solution of the program that asks for what it gives."""
    n = qp.q.size
    for k in range(views.point.size):
        views.point[k] = x[k] if k < n else 0.0
    for i in range(n):
        qp.q[i] = -row_dot(qp.P, i, x)
        qp.lb[i] = min(qp.lb[i], x[i])
        qp.ub[i] = max(qp.ub[i], x[i])
    for j in range(qp.h.size):
        value = row_dot(qp.G, j, x)
        if value > qp.h[j] + REACHED:  # a row that asked for more than can be had
            qp.h[j] = value
    for j in range(qp.b.size):
        qp.b[j] = row_dot(qp.A, j, x)
    _judge(views, qp, fraction, SOLVED)


@compiled
def _stop(views: RowViews) -> None:
    """Take no velocity as the answer; the iterations of what failed stay, and why it failed."""
    for k in range(views.point.size):
        views.point[k] = 0.0
    if views.decision[2] < NOT_SETTLED:
        views.figures[0] = 0.0
        views.figures[1] = 0.0
        views.decision[2] = NOT_SETTLED
    views.decision[1] = 0.0


@compiled
def _follow(instant: Instant, wanted: Vector, rest: float) -> None:
    """Note for the next step which velocity is wanted (dof,) and how long braking takes then."""
    for i in range(instant.q.size):
        instant.following[WANTED, i] = wanted[i]
    instant.following[REST, 0] = rest


@compiled
def _braking_command(qp: QPViews, instant: Instant, yielding: Yielding, dq: Vector) -> float:
    """Write the next command (dof,) of the braking motion in hand, or of the quickest one.

    Returns:
        Periods that are left afterwards; 0 if the motion was not in hand.
    """
    limits = yielding.limits
    periods = instant.rest
    if periods == 0.0:
        periods = least_periods(instant.last, instant.before, limits, yielding.dt)
    cubic = has_jerk(limits)
    for i in range(dq.size):
        dq[i] = 0.0
        if periods < np.inf:
            dq[i] = next_velocity(instant.last[i], instant.before[i], periods, cubic)
        if instant.rest == 0.0:
            dq[i] = min(max(dq[i], qp.lb[i]), qp.ub[i])
    return max(instant.rest - 1.0, 0.0)


@compiled
def approach(
    views: RowViews,
    qp: QPViews,
    instant: Instant,
    yielding: Yielding,
    state: Vector,
    action: int,
    yields: bool,
) -> int:
    """Go towards the wanted velocity within acceleration limits, or brake.

    Args:
        views: The step's row.
        qp: The program in it.
        instant: What else is known.
        yielding: Weights, limits and settings of the relaxed programs.
        state: The network's state, (size,), advanced where its answer is taken.
        action: Action that the policy asks for: `SLOW`, `RELAX` or `STOP`.
        yields: Whether the task yielded at the last step.

    Returns:
        The action that was taken.
    """
    n = qp.q.size
    dof = instant.q.size
    if action == STOP and not yields:
        return _halt(views, qp, instant, yielding)
    held = held_rows(yielding.weights)
    wanted = np.empty(2 * n + qp.h.size + held)
    found = enter_violation(yielding.violation, qp, yielding, instant.q, wanted)
    note_blocking(wanted, n, qp.h.size, 0, views.blocking)
    if found and _fits(views, qp, instant, yielding, state, wanted):
        _clear_blocking(views)
        return NONE if yields else FALLBACK
    if action == STOP:
        return _halt(views, qp, instant, yielding)
    if not found:
        for i in range(n):
            wanted[i] = 0.0
    x = wanted[:n].copy()
    _step_within(qp, instant, yielding, x, held > 0)
    rest = 0.0
    if yielding.stop != 0:
        rest = enter_stopping_time(yielding.stop, instant, yielding, x[:dof])
        if rest < 0.0:
            rest = _slow_down(qp, instant, yielding, wanted, x)
    _follow(instant, wanted, rest)
    _note_missing(views, wanted, x[:dof])
    fraction = 1.0 if action == RELAX else max(_attained(qp, yielding.weights, x), CREEP)
    _take(views, qp, x, fraction)
    return action


@compiled
def _halt(views: RowViews, qp: QPViews, instant: Instant, yielding: Yielding) -> int:
    """Take the next command of a motion to rest as the answer; return `STOP`."""
    _stop(views)
    braked = views.point[: instant.q.size]
    _follow(instant, braked, _braking_command(qp, instant, yielding, braked))
    _note_residuals(views, qp)
    return STOP


@compiled
def _note_missing(views: RowViews, wanted: Vector, dq: Vector) -> None:
    """Note the joints whose command dq (dof,) is short of the wanted velocity, (dof,) or more."""
    for i in range(dq.size):
        missing = wanted[i] - dq[i]
        if abs(missing) > REACHED:
            views.blocking[i] = math.copysign(1.0, missing)


@compiled
def _fits(
    views: RowViews,
    qp: QPViews,
    instant: Instant,
    yielding: Yielding,
    state: Vector,
    wanted: Vector,
) -> bool:
    """Let the network answer a program that the wanted velocity (n,) shows to have a solution."""
    if not _has_solution(qp, yielding, wanted) or not _answered(views, qp, yielding, state):
        return False
    rest = 0.0
    if yielding.stop != 0:
        dq = views.point[: instant.q.size]
        rest = enter_stopping_time(yielding.stop, instant, yielding, dq)
    if rest < 0.0:
        return False
    _follow(instant, wanted, rest)
    return True


@compiled
def _step_within(
    qp: QPViews, instant: Instant, yielding: Yielding, x: Vector, together: bool
) -> None:
    """Replace the wanted velocity x (n,) by the next command within the limits on the way to it.

    Joints that follow others have to go with them, `together`, on a straight line.
    """
    dof = instant.q.size
    if together:
        _step_straight(qp, instant, yielding, x[:dof])
    else:
        _step_towards(qp, instant, yielding, x[:dof])
    nearest_within(qp, x, yielding)


@compiled
def _step_towards(qp: QPViews, instant: Instant, yielding: Yielding, dq: Vector) -> None:
    """Replace the wanted velocity dq (dof,) by the next command of joints that hurry to it.

    Each joint goes as quickly as its limits allow, without passing a velocity that goes on changing
    as it has done since the last step.
    """
    dof = dq.size
    limits = yielding.limits
    for i in range(dof):
        aim = dq[i]
        most = limits[3 * dof + i] * yielding.dt
        change = min(max(aim - instant.wanted[i], -most), most)
        behind = instant.last[i] - (aim - change)
        rate = limits[4 * dof + i]
        dq[i] = aim + braking(behind, qp.lb[i] - aim, qp.ub[i] - aim, rate, yielding.dt)
        dq[i] = min(max(dq[i], qp.lb[i]), qp.ub[i])


@compiled
def _step_straight(qp: QPViews, instant: Instant, yielding: Yielding, dq: Vector) -> None:
    """Replace the wanted velocity dq (dof,) by the next command on the straight line to it."""
    dof = dq.size
    now = np.empty(dof)
    before = np.empty(dof)
    for i in range(dof):
        now[i] = instant.last[i] - dq[i]
        before[i] = instant.before[i] - dq[i]
    periods = least_periods(now, before, yielding.limits, yielding.dt)
    cubic = has_jerk(yielding.limits)
    for i in range(dof):
        if periods < np.inf:
            dq[i] += next_velocity(now[i], before[i], periods, cubic)
        dq[i] = min(max(dq[i], qp.lb[i]), qp.ub[i])


@compiled
def _slow_down(
    qp: QPViews, instant: Instant, yielding: Yielding, wanted: Vector, x: Vector
) -> float:
    """Write a stoppable command into x (n,), on the way from the braking motion to the wanted one.

    Returns:
        Periods until it rests.
    """
    dof = instant.q.size
    straight = wanted[: x.size].copy()
    _step_within(qp, instant, yielding, straight, True)
    braking_command = np.empty(dof)
    left = _braking_command(qp, instant, yielding, braking_command)
    for share in TOWARDS:
        for i in range(dof):
            x[i] = braking_command[i] + share * (straight[i] - braking_command[i])
        rest: float = enter_stopping_time(yielding.stop, instant, yielding, x[:dof])
        if rest >= 0.0:
            return rest
    if held_rows(yielding.weights) == 0 and _go_away(qp, instant.last, x[:dof]):
        rest = enter_stopping_time(yielding.stop, instant, yielding, x[:dof])
        if rest >= 0.0:
            return rest
    for i in range(dof):
        x[i] = braking_command[i]
    return left


@compiled
def _go_away(qp: QPViews, last: Vector, dq: Vector) -> bool:
    """Write the command dq (dof,) that goes straight away from what is too near.

    A row stands for the nearest point of a link. Where the link lies along an obstacle, what the
    softened program asks for may lead another of its points nearer, and would hold the arm there.
    The arm sets off along the rows' gradients, and goes on in the direction of its last command.

    Returns:
        False if no row asks for a retreat, or the bounds allow none in that direction.
    """
    moving = 0.0
    near = 0
    for j in range(qp.h.size):
        near += qp.h[j] < -REACHED
    for i in range(dq.size):
        moving += abs(last[i])
    least = 0.0
    most = np.inf
    for i in range(dq.size):
        dq[i] = last[i]
        for j in range(qp.h.size):
            if moving == 0.0 and qp.h[j] < -REACHED:
                dq[i] -= qp.G[j, i]
        if dq[i] != 0.0:
            least = max(least, min(qp.lb[i] / dq[i], qp.ub[i] / dq[i]))
            most = min(most, max(qp.lb[i] / dq[i], qp.ub[i] / dq[i]))
    if near == 0 or not least <= most < np.inf:
        return False
    for i in range(dq.size):
        dq[i] *= most
    return True


@compiled
def _attained(qp: QPViews, weights: Vector, x: Vector) -> float:
    """Compute the share of the task velocity that a velocity x (n,) gives, at most 1."""
    asked = 0.0
    given = 0.0
    for j in range(qp.b.size):
        rhs = weights[j] * weights[j] * qp.b[j]
        asked += rhs * qp.b[j]
        given += rhs * row_dot(qp.A, j, x)
    return min(given / asked, 1.0) if asked > 0.0 else 1.0


def with_limits(yielding: Yielding) -> Yielding:
    """Return `yielding` with what acceleration limits need, compiled if it has any."""
    if yielding.limits.size:
        yielding = yielding._replace(approach=APPROACH.address(approach))
    if len(yielding.scenes):
        yielding = yielding._replace(stop=STOP_TIME.address(stopping_time))
    return yielding


@compiled
def yield_step(
    row: Vector,
    arrays: ProgramArrays,
    past: Matrix,
    following: Matrix,
    state: Vector,
    yielding: Yielding,
    action: int,
    yields: bool,
) -> int:
    """Answer a step for which the network has no answer, or whose task still yields.

    Args:
        row: The row, (width,), with program and targets.
        arrays: Arrays of the loop; the kinematics are at the joint positions of `past`.
        past: `ControllerState.past`, (5, dof).
        following: `ControllerState.following`, (5, dof), overwritten.
        state: The network's state, (size,), advanced.
        yielding: Weights, limits and settings of the relaxed programs.
        action: Action that the policy asks for.
        yields: Whether the task yielded at the last step.

    Returns:
        The action that was taken.
    """
    table = arrays.table
    dof = table[0, 3]
    views = row_views(row, table[0, 0], table[0, 1], table[0, 2], dof)
    qp = qp_views(views.program, table[0, 0], table[0, 1], table[0, 2])
    for i in range(dof):
        following[WANTED, i] = past[WANTED, i]
    following[REST, 0] = 0.0
    _clear_blocking(views)
    if not _is_finite(views, qp) or _note_crossed(views, qp):
        action = STOP
        yields = False
    elif action == STOP and (yields or views.decision[2] == NOT_SETTLED):
        # Once stopped, the arm goes on where the task has a solution again.
        yields = _name_blocking(views, qp, yielding, past[Q]) and yields
    if yielding.approach != 0:
        instant = instant_of(arrays, past, following)
        taken: int = enter_approach(
            yielding.approach, views, qp, instant, yielding, state, action, yields
        )
    else:
        taken = _yield_at_once(views, qp, past[Q], yielding, state, action, yields)
    views.decision[0] = taken
    for i in range(PLACEMENT):
        views.placement[i] = arrays.placements[table[0, 5], i]
    for i in range(dof):
        for k in range(PAST):
            views.past[k, i] = past[k, i]
        views.dq[i] = views.point[i]
        following[BEFORE, i] = past[LAST, i]
        following[LAST, i] = views.point[i]
    return taken


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
def guard_step(
    arrays: ProgramArrays,
    past: Matrix,
    following: Matrix,
    yielding: Yielding,
) -> bool:
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
