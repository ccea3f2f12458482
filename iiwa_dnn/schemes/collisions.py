r"""Collision avoidance: one inequality row for each pair of bodies that could meet.

For a pair at distance :math:`d`, with the unit normal :math:`n` from the first body to the second
and the nearest point :math:`x` of the second, the row is a velocity damper,

.. math::  n \cdot \dot x \;\ge\; v_o - \kappa\,(d - d_s - \varepsilon)

with the obstacle's bound on its speed :math:`v_o` and the part :math:`\varepsilon` of the distance
that a step of dt can take although the row holds, since links turn and their points move on curves.
`docs/collisions.md` derives it, and proves that :math:`d \ge d_s` at all times.

Source: B. Faverjon, P. Tournassoud, "A local based approach for path planning of manipulators with
a high number of degrees of freedom", ICRA 1987.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields
from functools import lru_cache
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, IiwaDnnError, InvalidInputError, suggestion
from iiwa_dnn.files import one_line, read_toml
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.obstacles import Obstacle, make_obstacle
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.scene import FOUND, HEAD, PAIR, Scene, make_scene, measure
from iiwa_dnn.schemes.step import StepViews

RETREAT = 0.9
"""Largest share of the joints' velocity limits that a row asks for, so that it has a solution."""


@compiled
def collision_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write the rows of the pairs that are nearest to being active."""
    dof = step.q.size
    rows = h.size
    pairs = int(constants[5])
    width = FOUND + dof
    row = 0
    found = np.empty(pairs * width)
    measure(constants, 0, dof, step.placements, found)
    for k in range(pairs):
        _damper(constants, 0, dof, step.jacobian, k, found, step.rate)
    for k in range(pairs):
        out, before = k * width, 0
        if pairs > rows:
            slack = found[out + 15] - found[out + 16]
            for i in range(pairs):
                other = found[i * width + 15] - found[i * width + 16]
                before += other < slack or (other == slack and i < k)
        if before < rows:
            for j in range(dof):
                G[row, j] = found[out + FOUND + j]
            h[row] = found[out + 15] if found[out + 15] < found[out + 16] else np.inf
            row += 1


@compiled
def _damper(
    numbers: Vector, at: int, dof: int, jacobian: Matrix, k: int, found: Vector, rate: float
) -> None:
    """Write into a pair's part of `found` its h, the largest G x there is, and its row of G."""
    pair, out = at + int(numbers[at + 6]) + (PAIR + dof) * k, (FOUND + dof) * k
    fastest = 0.0
    for j in range(dof):
        moved, value = numbers[pair + PAIR + j], 0.0
        if moved != 0.0:
            x = out if moved > 0.0 else out + 3
            a, b, c = found[x], found[x + 1], found[x + 2]
            value = found[out + 6] * (jacobian[j, 0] + jacobian[j, 4] * c - jacobian[j, 5] * b)
            value += found[out + 7] * (jacobian[j, 1] + jacobian[j, 5] * a - jacobian[j, 3] * c)
            value += found[out + 8] * (jacobian[j, 2] + jacobian[j, 3] * b - jacobian[j, 4] * a)
        found[out + FOUND + j] = -moved * value
        fastest += abs(value) * numbers[at + HEAD + j]
    dt, speed, turn = 1.0 / rate, numbers[pair + 8], numbers[pair + 10]
    taken, strays = 0.5 * dt * dt * numbers[pair + 9], numbers[pair + 12]
    if numbers[pair + 3] == 1.0 and (found[out + 11] > 0.0 or found[out + 13] > 0.0):
        # Seen from the link, a ball's middle is a point that moves.
        turned = (turn * turn + numbers[pair + 11]) * (found[out + 9] + dt * speed)
        taken += 0.5 * dt * dt * (turned + 2.0 * turn * speed)
    else:
        lost = dt * turn * found[out + 11] - found[out + 12]
        taken += max(0.0, lost, dt * turn * found[out + 13] - found[out + 14])
    gain, distance, least = min(numbers[at + 2], rate), found[out + 10], numbers[at + 1]
    room = distance - least - taken
    approach = gain * room
    if room < 0.0 and rate < np.inf:
        approach = rate * max(room, -taken) + gain * min(room + taken, 0.0)
    limit = max(approach - strays, -RETREAT * fastest)
    # Idle from the activation on, but never where one step could reach the least distance.
    idle = max(numbers[at + 3], least + taken + dt * (speed + strays))
    if numbers[at + 3] > 0.0 and distance > idle:
        limit = np.inf
    found[out + 15], found[out + 16] = limit, fastest


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
        activation: Distance from which on a row is idle [m]; None: where no velocity within the
            limits could break it, so that a row becomes active without a jump.
        gain: Largest rate at which a distance shrinks towards `distance` [1/s], above 0.
        nearest: Most rows; with more pairs, those that are nearest to being active have them.
    """

    kernel = staticmethod(collision_rows)
    obstacles: Sequence[Obstacle] = ()
    self_collision: bool = True
    distance: float = 0.02
    activation: float | None = None
    gain: float = 20.0
    nearest: int = 24
    moves: bool = field(default=False, init=False, repr=False)

    def __post_init__(self) -> None:
        one = isinstance(self.obstacles, Obstacle) or not isinstance(self.obstacles, Iterable)
        given: tuple[object, ...] = (self.obstacles,) if one else tuple(self.obstacles)
        for number, obstacle in enumerate(given, 1):
            if not isinstance(obstacle, Obstacle):
                problem = f"number {number} must be a Sphere, Capsule, Box, ConvexMesh or HalfSpace"
                raise InvalidInputError("obstacles", f"{problem}, not {obstacle!r}", obstacle)
        self._set(obstacles=given)
        self._set(moves=any(obstacle.moves for obstacle in self.obstacles))
        checks.positive("distance", self.distance)
        checks.positive("gain", self.gain)
        checks.integer("nearest", self.nearest, 1)
        if self.activation is not None and not self.activation > self.distance:
            problem = f"must be above the distance of {self.distance:g} m"
            raise InvalidInputError("activation", problem, self.activation)

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> CollisionAvoidance:
        """Read parameters, and a table ``[[obstacle]]`` for each obstacle, from a file.

        Raises:
            FileError: It cannot be read, or something in it is wrong; the message says what.
        """
        tables, where = read_toml(path), ""
        try:
            obstacles = []
            for number, table in enumerate(tables.pop("obstacle", []), 1):
                where = f"obstacle {number}: "
                obstacles.append(make_obstacle(table))
            where, known = "", [field.name for field in fields(cls) if field.init]
            for key in tables.keys() - known:
                hint = suggestion(key, known[1:])
                raise TypeError(f"unexpected keyword argument {key!r}{hint}")
            return cls(obstacles, **tables)
        except (IiwaDnnError, TypeError, ValueError, AttributeError) as error:
            text = one_line(error).replace(f"{cls.__name__}.__init__() ", "")
            raise FileError(path, where + text) from error

    @lru_cache(maxsize=8)  # noqa: B019  few parts, few robots
    def scene(self, robot: Robot) -> Scene:
        """Return bodies and pairs for a robot; raises what `make_scene` does."""
        parameters = (self.nearest, self.distance, self.gain, self.activation or 0.0)
        return make_scene(robot, self.obstacles, self.self_collision, parameters)

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows: that of the pairs, at most `nearest`."""
        return min(self.nearest, len(self.scene(robot).pairs))

    def row_names(self, robot: Robot) -> list[str]:
        """Return the pair of each row; none where rows change their pair."""
        pairs = self.scene(robot).pairs
        named = [f"{pair.second} and {pair.first}" for pair in pairs]
        return named if len(pairs) <= self.nearest else []

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the links whose placements the rows need."""
        return self.scene(robot).frames

    def constants(self, robot: Robot) -> Vector:
        """Return `Scene.numbers`, (k,)."""
        return self.scene(robot).numbers

    def move(self, robot: Robot, constants: Vector, t: float) -> None:
        """Put the moving obstacles where they are at a time [s]."""
        self.scene(robot).move(constants, t)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        obstacles = [obstacle.settings() for obstacle in self.obstacles]
        return super().settings() | {"obstacles": obstacles}


def avoidance_of(scheme: object) -> CollisionAvoidance | None:
    """Return the first `CollisionAvoidance` among the limits of a scheme."""
    limits = getattr(scheme, "limits", ())
    return next((part for part in limits if isinstance(part, CollisionAvoidance)), None)


def stated(scheme: object, robot: Robot) -> dict[str, Any]:
    """Return a record's settings ``collisions``: the least distance, obstacles and pairs."""
    part = avoidance_of(scheme)
    if part is None:
        return {}
    obstacles = [obstacle.settings() for obstacle in part.obstacles]
    pairs = part.scene(robot).pairs
    return {"collisions": {"distance": part.distance, "obstacles": obstacles, "pairs": pairs}}


def recorded(scheme: object, robot: Robot, q: Matrix, t: Vector) -> dict[str, Any]:
    """Return a record's arrays ``distance`` and ``nearest`` where a scheme avoids collisions.

    q (k, n) [rad] are the joint positions at times t (k,) [s].
    """
    part = avoidance_of(scheme)
    if part is None:
        return {}
    return dict(zip(("distance", "nearest"), part.scene(robot).nearest(q, t), strict=True))
