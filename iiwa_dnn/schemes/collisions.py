r"""Collision avoidance: one inequality row for each pair of bodies that could meet.

For a pair at distance :math:`d`, with the unit normal :math:`n` from the first body to the second
and the nearest point :math:`x` of the second, the row is a velocity damper,

.. math::  n \cdot \dot x \;\ge\; v_o - \kappa\,(d - d_s - \varepsilon)

with the obstacle's bound on its speed :math:`v_o` and the part :math:`\varepsilon` of the distance
that a step like the last one may take although its row holds, since points move on curves. The rows
guide; a command is given only if the distance holds on the motion to rest from it
(`iiwa_dnn.control.stopping`).

Source: B. Faverjon, P. Tournassoud, "A local based approach for path planning of manipulators with
a high number of degrees of freedom", ICRA 1987.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import FileError, IiwaDnnError
from iiwa_dnn.files import one_line, read_toml
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import collision_model, unwatched_links
from iiwa_dnn.robot.obstacles import Obstacle, make_obstacles
from iiwa_dnn.schemes.parts import Checks, Limit
from iiwa_dnn.schemes.scene import (
    SPEED,
    Contact,
    Scene,
    contact_of,
    make_scene,
    place_bodies,
    scene_views,
    second_order,
)
from iiwa_dnn.schemes.step import Step, StepViews, rate_along


@compiled
def collision_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write the rows of the pairs that are nearest to being active.

    They go into G (rows, n) and h (rows,); `constants` (k,) are `Scene.constants`, and the bounds
    lb (n,) and ub (n,) stay.
    """
    dof = step.q.size
    scene = scene_views(constants, dof)
    pairs = len(scene.pairs)
    gradients = np.empty((pairs, dof))
    limits = np.empty(pairs)
    slacks = np.empty(pairs)
    placed = np.empty((len(scene.bodies), 12))
    place_bodies(scene, step.placements, placed)
    gain = min(scene.gain, step.rate)
    travel = np.empty(dof)
    for j in range(dof):
        travel[j] = abs(step.last[j]) / step.rate
    for k in range(pairs):
        contact = contact_of(scene, k, placed)
        fastest = _write_gradient(scene.moves, contact, step.jacobian, scene.dq_max, k, gradients)
        left = contact.distance - scene.least
        limits[k] = gain * left - scene.pairs[k, SPEED]
        slacks[k] = limits[k] - fastest
        if slacks[k] < 0.0:
            eps = second_order(scene.moves, scene.radii, k, travel)
            limits[k] -= gain * eps
            if left < eps and step.rate < np.inf:
                limits[k] -= (step.rate - gain) * min(eps - left, eps)
    row = 0
    for k in range(pairs):
        if pairs <= h.size or _rank(slacks, k) < h.size:
            for j in range(dof):
                G[row, j] = gradients[k, j]
            h[row] = limits[k] if slacks[k] < 0.0 else np.inf
            row += 1


@compiled
def _rank(slacks: Vector, k: int) -> int:
    """Count the pairs that are nearer to being active than a pair, by their slacks (pairs,)."""
    rank = 0
    for i in range(slacks.size):
        rank += slacks[i] < slacks[k] or (slacks[i] == slacks[k] and i < k)
    return rank


@compiled
def _write_gradient(
    moves: Matrix, contact: Contact, jacobian: Matrix, dq_max: Vector, k: int, gradients: Matrix
) -> float:
    """Write row k of the gradients (pairs, n): the rate at which a pair's distance shrinks.

    Returns:
        The largest rate that the velocity limits of the joints allow [m/s].
    """
    fastest = 0.0
    for j in range(dq_max.size):
        value = 0.0
        if moves[k, j] != 0.0:
            point = contact.second if moves[k, j] > 0.0 else contact.first
            value = rate_along(jacobian, j, point, contact.normal)
        gradients[k, j] = -moves[k, j] * value
        fastest += abs(value) * dq_max[j]
    return fastest


def tuple_of_obstacles(argument: str, value: Any) -> tuple[Obstacle, ...]:
    """Return obstacles, or the one that is given alone, as a tuple; refuse any other value."""
    obstacles = value if isinstance(value, Iterable) else (value,)
    return tuple(checks.instance(argument, obstacle, Obstacle) for obstacle in obstacles)


@dataclass(frozen=True, eq=False)
class CollisionAvoidance(Limit):
    """Rows that keep the links away from obstacles and from each other.

    No pair comes nearer than `distance`, between steps neither, as long as none is nearer at the
    start, the arm follows the command, `JointLimits` are among the limits, obstacles keep to their
    speed, and no more than `nearest` pairs are so near that their rows matter. A pair that is too
    near is asked to retreat.

    Attributes:
        obstacles: The obstacles.
        self_collision: Whether pairs of links are watched too.
        distance: Least distance [m], above 0.
        gain: Largest rate at which a distance shrinks towards `distance` [1/s], above 0.
        nearest: Most rows; with more pairs, those that are nearest to being active have them.
    """

    kernel = staticmethod(collision_rows)
    _checks: ClassVar[Checks] = {
        "obstacles": tuple_of_obstacles,
        "distance": checks.positive,
        "gain": checks.positive,
        "nearest": partial(checks.integer, least=1),
    }
    obstacles: Sequence[Obstacle] = ()
    self_collision: bool = True
    distance: float = 0.02
    gain: float = 20.0
    nearest: int = 24

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> CollisionAvoidance:
        """Read parameters, and a table ``[[obstacle]]`` for each obstacle, from a file.

        Raises:
            FileError: It cannot be read, or something in it is wrong; the message says what.
        """
        tables = read_toml(path)
        try:
            return cls(make_obstacles(tables.pop("obstacle", [])), **tables)
        except (IiwaDnnError, TypeError, ValueError, AttributeError) as error:
            text = one_line(error).replace(f"{cls.__name__}.__init__() ", "")
            raise FileError(path, text) from error

    @lru_cache(maxsize=8)  # noqa: B019  few parts, few robots
    def scene(self, robot: Robot) -> Scene:
        """Return bodies and pairs for a robot; raises what `make_scene` does."""
        return make_scene(robot, self.obstacles, self.self_collision, self.distance, self.gain)

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows: that of the pairs, at most `nearest`."""
        return min(self.nearest, len(self.scene(robot).pairs))

    def row_names(self, robot: Robot) -> list[str]:
        """Return the pair of each row; none where rows change their pair."""
        pairs = self.scene(robot).pairs
        return [f"{b} and {a}" for a, b in pairs] if len(pairs) <= self.nearest else []

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the links whose placements the rows need."""
        return self.scene(robot).frames

    def constants(self, robot: Robot) -> Vector:
        """Return `Scene.constants`, (k,)."""
        return self.scene(robot).constants

    @property
    def refreshes(self) -> bool:
        """Test whether an obstacle moves."""
        return any(obstacle.moves for obstacle in self.obstacles)

    def refresh(self, step: Step, constants: Vector) -> None:
        """Put the moving obstacles in the constants, (k,), where they are at a step's time."""
        self.scene(step.robot).move(constants, step.t)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return super().settings() | {"obstacles": [each.settings() for each in self.obstacles]}


def avoidance_of(scheme: object) -> CollisionAvoidance | None:
    """Return the first `CollisionAvoidance` among the limits of a scheme."""
    limits = getattr(scheme, "limits", ())
    return next((part for part in limits if isinstance(part, CollisionAvoidance)), None)


def collision_settings(scheme: object, robot: Robot) -> dict[str, Any]:
    """Return a record's settings ``collisions``: least distance, obstacles, pairs, unwatched links.

    ``left_out`` has the pairs of links that no row watches, each with the reason, as in
    `CollisionModel`. If the scheme does not avoid collisions, there are none of all these.
    """
    part = avoidance_of(scheme)
    if part is None:
        return {}
    return {
        "collisions": {
            "distance": part.distance,
            "obstacles": part.settings()["obstacles"],
            "pairs": part.scene(robot).pairs,
            "left_out": collision_model(robot).left_out if part.self_collision else (),
            "unwatched": unwatched_links(robot),
        }
    }


def collision_arrays(scheme: object, robot: Robot, q: Matrix, t: Vector) -> dict[str, Any]:
    """Return a record's arrays ``distance`` and ``nearest`` where a scheme avoids collisions.

    q (k, n) [rad] are the joint positions at times t (k,) [s].
    """
    part = avoidance_of(scheme)
    if part is None:
        return {}
    return dict(zip(("distance", "nearest"), part.scene(robot).nearest(q, t), strict=True))
