"""Nearest points of a segment and a convex hull, compiled: the cores of capsules and obstacles.

A point is a tuple (x, y, z) [m], which compiled code keeps in registers.
"""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import Triple, compiled

Indices = NDArray[np.int64]

ROUNDS = 60
"""Most points that the iteration of `hull_points` adds; it needs about six."""


@compiled
def point_of(points: Matrix, row: int) -> Triple:
    """Return a row of an array (k, 3)."""
    return points[row, 0], points[row, 1], points[row, 2]


@compiled
def dot(a: Triple, b: Triple) -> float:
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def difference(a: Triple, b: Triple) -> Triple:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@compiled
def moved(a: Triple, s: float, direction: Triple) -> Triple:
    """Return a + s direction."""
    return a[0] + s * direction[0], a[1] + s * direction[1], a[2] + s * direction[2]


@compiled
def segment_points(a: Triple, b: Triple, c: Triple, d: Triple) -> tuple[Triple, Triple]:
    """Return the nearest points of the segments from a to b and from c to d; equal ends: a point.

    Source: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.9, for the case
    distinction.
    """
    u = difference(b, a)
    v = difference(d, c)
    r = difference(a, c)
    uu = dot(u, u)
    vv = dot(v, v)
    uv = dot(u, v)
    ur = dot(u, r)
    vr = dot(v, r)
    across = uu * vv - uv * uv
    s = 0.0
    t = 0.0
    if uu > 0.0:
        s = _clipped((uv * vr - ur * vv) / across if across > 0.0 else -ur / uu)
    if vv > 0.0:
        t = _clipped((uv * s + vr) / vv)
    if uu > 0.0:
        s = _clipped((uv * t - ur) / uu)
    x = moved(a, s, u)
    y = moved(c, t, v)
    if uu * vv > 0.0 and across <= 1e-8 * uu * vv:
        # Of nearly parallel segments the ends are tried too: the formula cannot tell them apart.
        for end in (0.0, 1.0):
            x_end = moved(a, end, u)
            y_end = moved(c, _clipped((uv * end + vr) / vv), v)
            if _squared_distance(x_end, y_end) < _squared_distance(x, y):
                x = x_end
                y = y_end
    return x, y


@compiled
def _clipped(value: float) -> float:
    return min(max(value, 0.0), 1.0)


@compiled
def _squared_distance(a: Triple, b: Triple) -> float:
    side = difference(a, b)
    return dot(side, side)


@compiled
def hull_points(a: Triple, b: Triple, hull: Matrix) -> tuple[Triple, Triple]:
    """Return the nearest points of the segment from a to b and of a hull of corners (k, 3) [m].

    They are equal if the two overlap. The point of the difference nearest to the origin is looked
    for among simplices of its corners.

    Source: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the
    distance between complex objects in three-dimensional space", IEEE J. Robotics and Automation
    4(2), 1988; here the nearest face of a simplex is found by trying all of them.
    """
    simplex = np.empty((4, 3))
    members = np.zeros((4, 2), np.int64)  # index of each corner's end and corner of the hull
    weights = np.zeros(4)
    size = 1
    weights[0] = 1.0
    nearest = difference(a, point_of(hull, 0))
    _set_row(simplex, 0, nearest)
    squared = dot(nearest, nearest)
    for _ in range(ROUNDS):
        end = 1 if dot(nearest, b) < dot(nearest, a) else 0
        segment_end = b if end else a
        corner = _farthest(hull, nearest)
        newest = point_of(hull, corner)
        gap = dot(nearest, segment_end) - dot(nearest, newest)
        if not gap < squared * (1.0 - 1e-13) - 1e-18 or size == 4:
            break
        if _is_member(members, size, end, corner):
            break
        members[size, 0] = end
        members[size, 1] = corner
        _set_row(simplex, size, difference(segment_end, newest))
        least = _nearest_face(simplex, size + 1, weights)
        size = _without_idle_corners(simplex, members, weights, size + 1)
        if not least < squared:
            break
        nearest = _combined(simplex, weights, size)
        squared = dot(nearest, nearest)
    x = (0.0, 0.0, 0.0)
    y = (0.0, 0.0, 0.0)
    for k in range(size):
        x = moved(x, weights[k], b if members[k, 0] else a)
        y = moved(y, weights[k], point_of(hull, members[k, 1]))
    return x, y


@compiled
def _set_row(points: Matrix, row: int, point: Triple) -> None:
    points[row, 0] = point[0]
    points[row, 1] = point[1]
    points[row, 2] = point[2]


@compiled
def _farthest(points: Matrix, direction: Triple) -> int:
    """Find the point (k, 3) farthest along a direction."""
    farthest = 0
    largest = -np.inf
    for k in range(len(points)):
        height = dot(direction, point_of(points, k))
        if height > largest:
            largest = height
            farthest = k
    return farthest


@compiled
def _is_member(members: Indices, size: int, end: int, corner: int) -> bool:
    found = False
    for k in range(size):
        found = found or (members[k, 0] == end and members[k, 1] == corner)
    return found


@compiled
def _without_idle_corners(simplex: Matrix, members: Indices, weights: Vector, size: int) -> int:
    """Keep the corners with a weight above zero; return the new size."""
    kept = 0
    for k in range(size):
        if weights[k] > 0.0:
            weights[kept] = weights[k]
            members[kept, 0] = members[k, 0]
            members[kept, 1] = members[k, 1]
            for i in range(3):
                simplex[kept, i] = simplex[k, i]
            kept += 1
    return kept


@compiled
def _combined(points: Matrix, weights: Vector, size: int) -> Triple:
    """Return the weighted sum of the first points."""
    total = (0.0, 0.0, 0.0)
    for k in range(size):
        total = moved(total, weights[k], point_of(points, k))
    return total


@compiled
def _nearest_face(simplex: Matrix, size: int, weights: Vector) -> float:
    """Write the weights of the point of a simplex that is nearest to the origin.

    Of each face that has the newest corner, the last one, the nearest point of its plane is
    computed; it counts where all weights are positive.

    Returns:
        The squared distance of the point.
    """
    least = np.inf
    newest = size - 1
    trial = np.empty(4)
    others = np.empty(3, np.int64)
    system = np.empty((3, 3))
    rhs = np.empty(3)
    for face in range(1 << newest):
        count = _select(face, newest, others)
        _write_normal_equations(simplex, newest, others, count, system, rhs)
        if not _solve(system, rhs, count):
            continue
        if not _write_weights(rhs, others, count, newest, trial):
            continue
        point = _combined(simplex, trial, size)
        squared = dot(point, point)
        if squared < least:
            least = squared
            for k in range(size):
                weights[k] = trial[k]
    return least


@compiled
def _select(face: int, newest: int, others: Indices) -> int:
    """Write the corners of a face besides the newest: those whose bits are set; return how many."""
    count = 0
    for k in range(newest):
        if face >> k & 1:
            others[count] = k
            count += 1
    return count


@compiled
def _write_normal_equations(
    simplex: Matrix, newest: int, others: Indices, count: int, system: Matrix, rhs: Vector
) -> None:
    """Write the equations of the weights t that minimize |w_new + sum t_k (w_k - w_new)|^2."""
    new = point_of(simplex, newest)
    for r in range(count):
        side = difference(point_of(simplex, others[r]), new)
        rhs[r] = -dot(side, new)
        for c in range(count):
            system[r, c] = dot(side, difference(point_of(simplex, others[c]), new))


@compiled
def _write_weights(
    solved: Vector, others: Indices, count: int, newest: int, weights: Vector
) -> bool:
    """Write the weights of all corners of a simplex; return True if those of the face are positive.

    The newest corner has what the others leave of 1.
    """
    remaining = 1.0
    inside = True
    for k in range(newest):
        weights[k] = 0.0
    for r in range(count):
        weights[others[r]] = solved[r]
        remaining -= solved[r]
        inside = inside and solved[r] > 0.0
    weights[newest] = remaining
    return inside and remaining > 0.0


@compiled
def _solve(system: Matrix, rhs: Vector, count: int) -> bool:
    """Solve a symmetric positive definite system of up to three equations in place."""
    for k in range(count):
        if not system[k, k] > 1e-14:
            return False
        for r in range(k + 1, count):
            factor = system[r, k] / system[k, k]
            for i in range(k, count):
                system[r, i] -= factor * system[k, i]
            rhs[r] -= factor * rhs[k]
    for k in range(count - 1, -1, -1):
        for i in range(k + 1, count):
            rhs[k] -= system[k, i] * rhs[i]
        rhs[k] /= system[k, k]
    return True
