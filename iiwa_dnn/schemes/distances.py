"""Nearest points of a segment and a box, compiled: the cores of capsules and obstacles.

A point is a tuple (x, y, z) [m], which compiled code keeps in registers. The segment is a + s u, s
in [0, 1]; the box has half-extents h about the origin, along the axes. It may be flat: without
extents it is a point, with one a segment.
"""

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.layout import Triple

ROUNDS = 60
"""Most steps of the search along the segment; it needs about six."""


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
def beyond(x: Triple, half: Triple) -> Triple:
    """Return the way to a point from the nearest one of a box."""
    i = x[0] - min(max(x[0], -half[0]), half[0])
    j = x[1] - min(max(x[1], -half[1]), half[1])
    k = x[2] - min(max(x[2], -half[2]), half[2])
    return i, j, k


@compiled
def nearest_parameter(a: Triple, u: Triple, half: Triple) -> float:
    """Compute the s in [0, 1] of the point of a segment that is nearest to a box.

    Half the derivative of the squared distance grows with s: its root is found by regula falsi,
    every third step of which halves.
    """
    low = 0.0
    high = 1.0
    below = dot(u, beyond(a, half))
    above = dot(u, beyond(moved(a, 1.0, u), half))
    if below >= 0.0:
        return low
    if above <= 0.0:
        return high
    for k in range(ROUNDS):
        share = 0.5 if k % 3 == 2 else below / (below - above)
        middle = low + share * (high - low)
        slope = dot(u, beyond(moved(a, middle, u), half))
        if slope == 0.0 or not low < middle < high:
            return middle
        if slope < 0.0:
            low = middle
            below = slope
        else:
            high = middle
            above = slope
    return 0.5 * (low + high)


@compiled
def depth(x: Triple, half: Triple) -> tuple[float, Triple]:
    """Compute how far a point is from leaving a box by its nearest face, negative inside.

    Returns:
        The distance from the face, and the normal out of it, (3,).
    """
    found = -1e300
    normal = (0.0, 0.0, 1.0)
    for i in range(3):
        if abs(x[i]) - half[i] > found:
            found = abs(x[i]) - half[i]
            sign = 1.0 if x[i] >= 0.0 else -1.0
            normal = (sign * (i == 0), sign * (i == 1), sign * (i == 2))
    return found, normal
