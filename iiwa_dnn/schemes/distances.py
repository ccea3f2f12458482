"""Nearest points of a segment and a convex hull, compiled: the cores of capsules and obstacles."""

import numpy as np

from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.layout import compiled

ROUNDS = 60
"""Most points that the iteration of `hull_points` adds; it needs about six."""


@compiled
def segment_points(s: Vector, a: int, o: Vector, c: int, ends: int, out: Vector, at: int) -> None:
    """Write the nearest points of two segments into `out`, first of the first, (6,) from `at`.

    The first segment goes from s[a : a + 3] to s[a + 3 : a + 6]; the second is the point
    o[c : c + 3] where `ends` is 1, else it goes on to o[c + 3 : c + 6].

    Source: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.9, for the case
    distinction.
    """
    last = c + 3 * (ends - 1)
    uu, vv, uv, ur, vr = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        u, v, r = s[a + 3 + i] - s[a + i], o[last + i] - o[c + i], s[a + i] - o[c + i]
        uu += u * u
        vv += v * v
        uv += u * v
        ur += u * r
        vr += v * r
    across, least = uu * vv - uv * uv, np.inf
    # Of nearly parallel segments the ends are tried too: the formula cannot tell them apart.
    for trial in range(3 if across <= 1e-8 * uu * vv and uu * vv > 0.0 else 1):
        first, second = 1.0 * (trial == 2), 0.0
        if trial == 0 and uu > 0.0:
            first = (uv * vr - ur * vv) / across if across > 0.0 else -ur / uu
            first = min(max(first, 0.0), 1.0)
        if vv > 0.0:
            second = min(max((uv * first + vr) / vv, 0.0), 1.0)
        if uu > 0.0 and trial == 0:
            first = min(max((uv * second - ur) / uu, 0.0), 1.0)
        squared = 0.0
        for i in range(3):
            x = s[a + i] + first * (s[a + 3 + i] - s[a + i])
            y = o[c + i] + second * (o[last + i] - o[c + i])
            squared += (x - y) * (x - y)
        if squared < least:
            least = squared
            for i in range(3):
                out[at + i] = s[a + i] + first * (s[a + 3 + i] - s[a + i])
                out[at + 3 + i] = o[c + i] + second * (o[last + i] - o[c + i])


@compiled
def hull_points(s: Vector, a: int, o: Vector, c: int, count: int, out: Vector, at: int) -> None:
    """Write the nearest points of a segment and a convex hull into `out`, (6,) from `at`.

    The segment is that of `segment_points`; the hull is that of `count` points from o[c] on. The
    point of their difference nearest to the origin is looked for among simplices of its corners.
    If the two overlap, both points are equal.

    Source: E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast procedure for computing the
    distance between complex objects in three-dimensional space", IEEE J. Robotics and Automation
    4(2), 1988; here the nearest face of a simplex is found by trying all of them.
    """
    w, ends, corners = np.zeros(12), np.zeros(4, np.int64), np.zeros(4, np.int64)
    best, trial = np.zeros(4), np.zeros(4)
    nearest, size, squared = np.empty(3), 1, 0.0
    for i in range(3):
        w[i] = nearest[i] = s[a + i] - o[c + i]
        squared += nearest[i] * nearest[i]
    best[0] = 1.0
    for _ in range(ROUNDS):
        # The corner of the difference that is farthest back along the nearest point.
        end, corner, low, high = 0, 0, np.inf, -np.inf
        for e in range(2):
            value = 0.0
            for i in range(3):
                value += nearest[i] * s[a + 3 * e + i]
            if value < low:
                low, end = value, e
        for k in range(count):
            value = 0.0
            for i in range(3):
                value += nearest[i] * o[c + 3 * k + i]
            if value > high:
                high, corner = value, k
        if not low - high < squared * (1.0 - 1e-13) - 1e-18 or size == 4:
            break
        known = False
        for k in range(size):
            known = known or (ends[k] == end and corners[k] == corner)
        if known:
            break
        ends[size], corners[size] = end, corner
        for i in range(3):
            w[3 * size + i] = s[a + 3 * end + i] - o[c + 3 * corner + i]
        size += 1
        least = _nearest_face(w, size, best, trial)
        kept = 0
        for k in range(size):
            if best[k] > 0.0:
                best[kept], ends[kept], corners[kept] = best[k], ends[k], corners[k]
                for i in range(3):
                    w[3 * kept + i] = w[3 * k + i]
                kept += 1
        size = kept
        if not least < squared:
            break
        squared = 0.0
        for i in range(3):
            nearest[i] = 0.0
            for k in range(size):
                nearest[i] += best[k] * w[3 * k + i]
            squared += nearest[i] * nearest[i]
    for i in range(3):
        out[at + i] = out[at + 3 + i] = 0.0
        for k in range(size):
            out[at + i] += best[k] * s[a + 3 * ends[k] + i]
            out[at + 3 + i] += best[k] * o[c + 3 * corners[k] + i]


@compiled
def _nearest_face(w: Vector, size: int, best: Vector, trial: Vector) -> float:
    """Write the weights of the point of a simplex nearest to the origin into `best`, (size,).

    Of each face that has the newest corner, the last of `w`, the nearest point of its plane is
    computed; it counts where all weights are positive.

    Returns:
        The squared distance of the point.
    """
    least, newest = np.inf, size - 1
    system, rhs = np.empty(9), np.empty(3)
    for face in range(1 << newest):
        # Weights of the other corners k: minimise |w_new + sum t_k (w_k - w_new)|^2.
        count = 0
        members = np.empty(3, np.int64)
        for k in range(newest):
            if face >> k & 1:
                members[count] = k
                count += 1
        for r in range(count):
            rhs[r] = 0.0
            for i in range(3):
                side = w[3 * members[r] + i] - w[3 * newest + i]
                rhs[r] -= side * w[3 * newest + i]
            for k in range(count):
                value = 0.0
                for i in range(3):
                    side = w[3 * members[r] + i] - w[3 * newest + i]
                    value += side * (w[3 * members[k] + i] - w[3 * newest + i])
                system[3 * r + k] = value
        if not _solve(system, rhs, count):
            continue
        rest = 1.0
        for k in range(4):
            trial[k] = 0.0
        for r in range(count):
            trial[members[r]] = rhs[r]
            rest -= rhs[r]
        trial[newest] = rest
        inside = rest > 0.0
        for r in range(count):
            inside = inside and rhs[r] > 0.0
        if not inside:
            continue
        squared = 0.0
        for i in range(3):
            value = 0.0
            for k in range(size):
                value += trial[k] * w[3 * k + i]
            squared += value * value
        if squared < least:
            least = squared
            for k in range(size):
                best[k] = trial[k]
    return least


@compiled
def _solve(system: Vector, rhs: Vector, count: int) -> bool:
    """Solve a symmetric positive definite system of up to three equations in place."""
    for k in range(count):
        pivot = system[4 * k]
        if not pivot > 1e-14:
            return False
        for r in range(k + 1, count):
            factor = system[3 * r + k] / pivot
            for i in range(k, count):
                system[3 * r + i] -= factor * system[3 * k + i]
            rhs[r] -= factor * rhs[k]
    for k in range(count - 1, -1, -1):
        for i in range(k + 1, count):
            rhs[k] -= system[3 * k + i] * rhs[i]
        rhs[k] /= system[4 * k]
    return True
