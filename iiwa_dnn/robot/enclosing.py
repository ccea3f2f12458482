"""The smallest capsule around a set of points, for links that are drawn with meshes."""

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]


def enclosing_capsule(points: _Array) -> tuple[_Array, _Array, float]:
    """Fit a capsule of small volume that holds every one of some points (k, 3) [m].

    The axis begins along each principal direction in turn and is then moved by Nelder and Mead's
    simplex method; for an axis and a radius the shortest segment is known in closed form, so the
    capsule holds all points whatever the method reached.

    Returns:
        Ends of the segment, (3,) each, equal for a sphere, and the radius [m].
    """
    from scipy.optimize import minimize  # slow to import

    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    axes = np.linalg.svd(points - middle, full_matrices=False)[2]
    found = []
    for axis in axes:
        start = np.concatenate([middle, axis, [1.0]])
        scale = np.array([0.01, 0.01, 0.01, 0.1, 0.1, 0.1, 0.02])
        simplex = np.vstack([start, start + np.diag(scale)])
        options = {"initial_simplex": simplex, "maxfev": 4000, "xatol": 1e-6, "fatol": 1e-9}
        best = minimize(lambda x: _volume(*_capsule(points, x)), start, (), "Nelder-Mead",
                        options=options)  # fmt: skip
        found.append(_capsule(points, best.x))
    a, b, radius = min(found, key=lambda capsule: _volume(*capsule))
    return a, b, radius


def _capsule(points: _Array, x: _Array) -> tuple[_Array, _Array, float]:
    """Capsule along an axis: x holds a point, a direction and the radius over the least one."""
    origin, axis = x[:3], x[3:6] / np.linalg.norm(x[3:6])
    along = (points - origin) @ axis
    across = np.linalg.norm(points - origin - along[:, np.newaxis] * axis, axis=1)
    radius = float(across.max() * max(x[6], 1.0)) + 1e-9
    cap = np.sqrt(radius**2 - across**2)
    low, high = float((along + cap).min()), float((along - cap).max())
    if low > high:  # any point between them is the middle of a sphere that holds all
        low = high = 0.5 * (low + high)
    return origin + low * axis, origin + high * axis, radius


def _volume(a: _Array, b: _Array, radius: float) -> float:
    return float(np.pi * radius**2 * (np.linalg.norm(b - a) + 4.0 / 3.0 * radius))
