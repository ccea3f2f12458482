"""The paper's heart by a program of its own: NumPy alone, nothing of the package.

``python benchmarks/independent.py`` prints what `iiwa_dnn.studies.runs.measure` measures, as JSON.
The arm is written out of the data sheet's lengths, the network as the paper prints it, with the
four rows of the rotation's block as they are, and one explicit Euler step of both a time.
"""

import argparse
import json
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

OFFSETS = (0.1475, 0.1925, 0.2075, 0.1925, 0.2075, 0.1925, 0.091)
FLANGE = 0.035
AXES = ("z", "y", "z", "-y", "z", "y", "z")
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
SPEED = np.radians([98.0, 98.0, 100.0, 130.0, 140.0, 180.0, 180.0])
JOINT_LIMIT = 2.5
DT = 1e-4
RHO = 9e-5
GAIN = 10.2  # m and delta of the paper
UNITS = {"x": np.eye(3)[0], "y": np.eye(3)[1], "z": np.eye(3)[2], "-y": -np.eye(3)[1]}


def turn(axis: Array, angle: float) -> Array:
    """Rodrigues' rotation."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def kinematics(q: Array) -> tuple[Array, Array, Array, Array]:
    """Position, rotation, Jacobian of the position (3, 7), joint axes in the world (7, 3)."""
    position, rotation = np.zeros(3), np.eye(3)
    origins, axes = [], []
    for offset, name, angle in zip(OFFSETS, AXES, q, strict=True):
        position = position + rotation[:, 2] * offset
        axes.append(rotation @ UNITS[name])
        origins.append(position)
        rotation = rotation @ turn(UNITS[name], angle)
    position = position + rotation[:, 2] * FLANGE
    axes = np.array(axes)
    return position, rotation, np.cross(axes, position - np.array(origins)).T, axes


def heart(scale: float, rate: float, t: float) -> tuple[Array, Array]:
    """Displacement and velocity of the heart at time t."""
    phases = rate * t * np.arange(1, 5)
    s, c = np.sin(phases), np.cos(phases)
    y = c @ [13, -5, -2, -1] - 5
    slope = s @ [-13, 10, 6, 4]
    place = scale * np.array([16 * s[0] ** 3, y, 0.0])
    return place, scale * rate * np.array([48 * s[0] ** 2 * c[0], slope, 0.0])


def block(rotation: Array, axes: Array) -> tuple[Array, Array]:
    """The paper's r (4,) and its Jacobian (4, 7)."""
    rates = np.cross(axes[:, None, :], rotation.T[None, :, :])  # of each column, by each joint
    return rotation[:2, :2].ravel(), np.array(
        [rates[:, column, row] for row in (0, 1) for column in (0, 1)]
    )


def advance(
    state: Array, rows: Array, rhs: Array, eta: Array, bounds: tuple[Array, Array], step: float
) -> None:
    """One Euler step of the network, of length `step` in units of rho, in place."""
    lower, upper = bounds
    m = rhs.size
    x, nu, above, below = state[:7], state[7 : 7 + m], state[7 + m : 14 + m], state[14 + m :]
    gradient = x + eta + rows.T @ nu + above - below
    change = np.concatenate(
        [
            np.clip(x - gradient, lower, upper) - x,
            rows @ x - rhs,
            np.maximum(above + x - upper, 0.0) - above,
            np.maximum(below + lower - x, 0.0) - below,
        ]
    )
    state += step * change


def run(given: argparse.Namespace) -> dict[str, float]:
    """Carry out a run; return its numbers."""
    rate = 2.0 * np.pi / given.period
    shift = given.phase * given.period
    q = START.copy()
    origin, upright, *_ = kinematics(q)
    origin = origin - heart(given.scale, rate, shift)[0]
    wanted = upright[:2, :2].ravel()
    limit = np.minimum(SPEED, given.velocity)
    rows = {"block": 7, "none": 3}[given.orientation]
    state = np.zeros(21 + rows)
    state += given.start * np.random.default_rng(given.seed).standard_normal(state.size)
    steps = round(given.duration / DT)
    errors = np.zeros((steps + 1, 3))
    index = 0.0
    for k in range(steps + 1):
        position, rotation, jacobian, axes = kinematics(q)
        place, velocity = heart(given.scale, rate, k * DT + shift)
        errors[k] = position - origin - place
        if k == steps:
            break
        matrix, rhs = jacobian, velocity - GAIN * errors[k]
        if given.orientation == "block":
            r, block_jacobian = block(rotation, axes)
            matrix = np.vstack([matrix, block_jacobian])
            rhs = np.concatenate([rhs, -given.orientation_gain * (r - wanted)])
        eta = (1.0 - given.weight) * GAIN * (q - START)
        lower = np.maximum(-limit, given.limit_gain * (-JOINT_LIMIT - q))
        upper = np.minimum(limit, given.limit_gain * (JOINT_LIMIT - q))
        for _ in range(given.substeps):
            advance(state, matrix, rhs, eta, (lower, upper), DT / RHO / given.substeps)
        command = np.clip(state[:7], lower, upper)
        index = max(index, command @ command)
        q = q + DT * command
    size = np.linalg.norm(errors, axis=1)
    return {
        "max_position_error_m": size.max(),
        "max_axis_error_m": np.abs(errors).max(),
        "time_of_max_error_s": DT * float(size.argmax()),
        "mse_position_error_m2": np.mean(errors**2),
        "joint_drift_rad": np.abs(q - START).max(),
        "max_kinetic_index_times_dt": index * DT,
    }


def main(words: Sequence[str] | None = None) -> None:
    """Print the numbers of a run."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, value in {
        "weight": 0.2, "scale": 3.45e-3, "period": 10.0, "phase": 0.0, "start": 0.0,
        "substeps": 8, "limit_gain": 20.0, "orientation_gain": 10.2, "velocity": np.inf,
        "duration": 10.0, "seed": 0,
    }.items():  # fmt: skip
        parser.add_argument(f"--{name}", type=type(value), default=value)
    parser.add_argument("--orientation", choices=("block", "none"), default="block")
    print(json.dumps(run(parser.parse_args(words)), indent=2))


if __name__ == "__main__":
    main()
