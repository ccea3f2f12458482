"""Kinematics written independently of the package, and derivatives by finite differences."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

# The standard DH table of the KUKA LBR iiwa 7 R800; every a is 0, alpha counts quarter turns.
IIWA7_D = (0.340, 0.0, 0.400, 0.0, 0.400, 0.0, 0.126)
IIWA7_ALPHA = (-1, 1, 1, -1, -1, 1, 0)

# Estimates for its links 0 to 7: mass, centre of mass, (ixx, iyy, izz), (ixz, iyz).
IIWA7_INERTIALS = [
    (4.8663, (-0.0129, 0, 0.0701), (0.017916, 0.022378, 0.021363), (0.000769, 0)),
    (3.4004, (0, -0.0347, 0.1235), (0.021479, 0.020496, 0.007576), (0, 0.003820)),
    (3.4296, (0, 0.0344, 0.0679), (0.021434, 0.020428, 0.007659), (0, 0.003563)),
    (3.9940, (0, 0.0296, 0.1040), (0.031518, 0.029925, 0.009556), (0, -0.006122)),
    (3.4296, (0, -0.0344, 0.0679), (0.021434, 0.020428, 0.007659), (0, -0.003563)),
    (2.1299, (0, -0.0214, 0.0529), (0.012651, 0.010922, 0.005610), (0, 0.003879)),
    (2.3116, (0, 0.0003, 0.0026), (0.006407, 0.006160, 0.004455), (0, 0.000313)),
    (0.3387, (0, -0.0002, 0.0103), (0.000250, 0.000245, 0.000405), (0, 0)),
]

# The paper's theta(0).
PAPER_Q0 = (-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0)


def dh_pose(q: ArrayLike) -> tuple[Array, Array]:
    """Position [m] and rotation of the iiwa 7's flange at q (..., 7), by the standard DH formula.

    Each joint adds Rot_z(q) Trans_z(d) Rot_x(alpha).
    """
    q = np.asarray(q, dtype=np.float64)
    position = np.zeros(3)
    rotation = np.eye(3)
    for d, sine, angle in zip(IIWA7_D, IIWA7_ALPHA, np.moveaxis(q, -1, 0), strict=True):
        cosine = 1 - abs(sine)
        quarter = np.array([[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]])
        position = position + d * rotation[..., 2]
        rotation = rotation @ Rotation.from_euler("z", angle).as_matrix() @ quarter
    return position, rotation


def rotation_angle(a: ArrayLike, b: ArrayLike) -> Array:
    """Angle between orientations [rad]: ||A - B||_F = 2 sqrt(2) sin(angle / 2)."""
    distance = np.linalg.norm(np.subtract(a, b), axis=(-2, -1))
    return 2.0 * np.arcsin(np.minimum(distance / np.sqrt(8.0), 1.0))


def finite_difference(
    function: Callable[[Array], ArrayLike], x: ArrayLike, step: float = 1e-6
) -> Array:
    """Derivative (..., n) of an array-valued function at x (n,) by central differences."""
    x = np.asarray(x, dtype=np.float64)
    columns = [
        (np.asarray(function(x + e)) - np.asarray(function(x - e))) / (2.0 * step)
        for e in step * np.eye(len(x))
    ]
    return np.stack(columns, axis=-1)


def pose_jacobian(
    pose: Callable[[Array], tuple[Array, Array]], q: ArrayLike, step: float = 1e-6
) -> Array:
    """Jacobian (6, n) of position and rotation by central differences: linear rows first."""
    rotation = pose(np.asarray(q, dtype=np.float64))[1]
    linear = finite_difference(lambda x: pose(x)[0], q, step)
    # dR/dq_i R' is the cross-product matrix of the angular velocity that joint i gives.
    spin = np.einsum("abi,cb->aci", finite_difference(lambda x: pose(x)[1], q, step), rotation)
    angular = 0.5 * np.stack(
        [spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]]
    )
    return np.vstack([linear, angular])


def example_urdf(name: str) -> Path:
    """Path of a URDF in the package example-robot-data; skips the test if it is not installed."""
    path = Path(pin.__file__).parents[4] / "share" / "example-robot-data" / "robots" / name
    if not path.is_file():
        pytest.skip(f"needs the package example-robot-data, which has no {name} here")
    return path
