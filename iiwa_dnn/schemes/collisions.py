r"""Collision avoidance: two inequality rows for each pair of bodies that could meet.

For a pair at distance :math:`d`, with the unit normal :math:`n` from the first body to the second,
each end :math:`x` of the second body's segment gives one row. The end is :math:`\eta \ge 0` farther
away along the normal than the nearest point. The row is a velocity damper,

.. math::  n \cdot \dot x \;\ge\; v_o - \kappa\,(d + \eta - d_s - \mu - \varepsilon)

with the obstacle's bound on its speed :math:`v_o`, `CLEARANCE` :math:`\mu`, and the part
:math:`\varepsilon` of the distance that a step like the last one may take although its row holds,
since points move on curves. The rows guide; a command is given only if the distance holds on the
motion to rest from it (`iiwa_dnn.control.stopping`).

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
from iiwa_dnn.errors import FileError, IiwaDnnError, InvalidInputError
from iiwa_dnn.files import one_line, read_toml
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import dot
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.robot.obstacles import Obstacle, make_obstacles
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.scene import (
    Body,
    Contact,
    Pair,
    Scene,
    SceneViews,
    contact_of,
    ends_of,
    height_of,
    make_scene,
    place_bodies,
    scene_views,
    second_order,
)
from iiwa_dnn.schemes.step import Step, StepViews, rate_along

ENDS = 2
"""Rows of a pair, one for each end of the segment of its second body."""

CLEARANCE = 1e-6
"""Distance beyond the least at which a pair comes to rest [m]. Paths along an obstacle are curved:
an arm
that rests at the least distance itself could not stop from any of them, and would stay there."""

MEET = np.inf
"""Distance that marks a pair that meets without a normal: the arm is stopped."""


@compiled
def collision_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write the rows of the ends that are nearest to being active.

    They go into G (rows, n) and h (rows,); `constants` (k,) are `Scene.constants`, and the bounds
    lb (n,) and ub (n,) stay.
    """
    dof = step.q.size
    scene = scene_views(constants, dof)
    candidates = ENDS * len(scene.pairs)
    gradients = np.zeros((candidates, dof))
    limits = np.empty(candidates)
    slacks = np.empty(candidates)
    slacks[:] = np.inf
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, step.placements, placed)
    for k in range(len(scene.pairs)):
        _write_ends(step, scene, placed, k, gradients, limits, slacks)
    G[:] = 0.0
    h[:] = np.inf
    row = 0
    for k in range(candidates):
        if slacks[k] < 0.0 and _rank(slacks, k) < h.size:
            if candidates <= h.size:
                row = k
            for j in range(dof):
                G[row, j] = gradients[k, j]
            h[row] = limits[k]
            row += 1


@compiled
def _write_ends(
    step: StepViews,
    scene: SceneViews,
    placed: Matrix,
    k: int,
    gradients: Matrix,
    limits: Vector,
    slacks: Vector,
) -> None:
    """Write gradients (c, n), right-hand sides (c,) and slacks (c,) of both ends of pair k.

    A pair that is too far away for any velocity within the limits is left out.
    """
    contact = contact_of(scene, k, placed)
    pair = Pair.of(scene.pairs[k])
    kept = kept_distance(scene, contact, step.least[scene.head.first + k])
    step.least[scene.head.first + k] = kept
    least = min(kept, scene.head.least)
    gain = min(scene.head.gain, step.rate)
    speed = Body.of(scene.bodies[pair.first]).speed
    travel = np.empty(step.q.size)
    most = speed - gain * (contact.distance - least - CLEARANCE)
    for j in range(step.q.size):
        travel[j] = abs(step.last[j]) / step.rate
        most += abs(pair.radii[j]) * scene.dq_max[j]
    if most <= 0.0:
        return
    ends = ends_of(scene, placed, pair.second)
    is_point = Body.of(scene.bodies[pair.second]).half[2] == 0.0
    eps = second_order(pair, travel)
    for at in range(1 if is_point else ENDS):
        if pair.still == at + 1:
            continue
        row = ENDS * k + at
        left = contact.distance + height_of(ends[at], contact) - least - CLEARANCE
        limits[row] = gain * left - speed
        fastest = 0.0
        for j in range(step.q.size):
            if pair.support[j] != 0.0:
                rate = rate_along(step.jacobian, j, ends[at], contact.normal)
                gradients[row, j] = -pair.support[j] * rate
                fastest += abs(rate) * scene.dq_max[j]
        slacks[row] = limits[row] - fastest
        limits[row] -= gain * eps
        if left < eps and step.rate < np.inf:
            limits[row] -= (step.rate - gain) * min(eps - left, eps)
        if least < scene.head.least:
            limits[row] = max(limits[row], -speed)


@compiled
def kept_distance(scene: SceneViews, contact: Contact, kept: float) -> float:
    """Compute the distance that a pair has to keep from now on [m], `MEET` if it has no normal.

    It is the scene's, but for a pair that begins nearer: until that is beyond, it is `CLEARANCE`
    less than where it began. (Were it where the pair has been farthest, a pair could not come back
    from the greatest distance that its link admits, and would hold the arm there.)

    Args:
        scene: The scene.
        contact: The pair's contact.
        kept: The distance that it has to keep so far [m]; 0 at the beginning.
    """
    if dot(contact.normal, contact.normal) == 0.0:
        return MEET
    if contact.distance >= scene.head.least + CLEARANCE:
        return scene.head.least
    if kept == 0.0 or kept == MEET:
        return (
            contact.distance - CLEARANCE
            if contact.distance < scene.head.least
            else scene.head.least
        )
    return kept


@compiled
def _rank(slacks: Vector, k: int) -> int:
    """Count the candidates (c,) that are nearer to being active than one of them."""
    rank = 0
    for i in range(slacks.size):
        rank += slacks[i] < slacks[k] or (slacks[i] == slacks[k] and i < k)
    return rank


def tuple_of_obstacles(argument: str, value: Any) -> tuple[Obstacle, ...]:
    """Return obstacles, or the one that is given alone, as a tuple; refuse any other value."""
    obstacles = value if isinstance(value, Iterable) else (value,)
    return tuple(checks.instance(argument, obstacle, Obstacle) for obstacle in obstacles)


def pairs_of_names(argument: str, value: Any) -> tuple[tuple[str, str], ...]:
    """Return pairs of names as tuples; refuse any other value."""
    pairs = value if isinstance(value, list | tuple) else [value]
    if not all(
        isinstance(pair, list | tuple) and [*map(type, pair)] == [str, str] for pair in pairs
    ):
        raise InvalidInputError(argument, f"must be pairs of names, not {value!r}", value)
    return tuple(map(tuple, pairs))


@dataclass(frozen=True, eq=False)
class CollisionAvoidance(Limit):
    """Rows that keep the links away from obstacles and from each other.

    No pair comes nearer than `distance`, between steps neither, as long as the arm begins at rest
    and follows the command, `JointLimits` are among the limits, obstacles stand still, and no more
    than `nearest` rows matter at once. A pair that begins nearer comes no nearer than it began,
    until it is beyond; it is not asked to retreat. One that no joint moves is left out.

    Attributes:
        obstacles: The obstacles.
        self_collision: Whether pairs of links are watched too.
        distance: Least distance [m], above 0.
        gain: Largest rate at which a distance shrinks towards `distance` [1/s], above 0.
        nearest: Most rows; of more, those that are nearest to being active count.
        left_out: Pairs that are not watched: the names of a link and of what it may meet, as in
            `Scene.pairs`.
    """

    kernel = staticmethod(collision_rows)
    _checks: ClassVar[checks.Checks] = {
        "obstacles": tuple_of_obstacles,
        "self_collision": partial(checks.one_of, choices=(True, False)),
        "distance": checks.positive,
        "gain": checks.positive,
        "nearest": partial(checks.integer, least=1),
        "left_out": pairs_of_names,
    }
    obstacles: Sequence[Obstacle] = ()
    self_collision: bool = True
    distance: float = 0.02
    gain: float = 20.0
    nearest: int = 48
    left_out: Sequence[tuple[str, str]] = ()

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> CollisionAvoidance:
        """Read parameters, and a table ``[[obstacle]]`` for each obstacle, from a file.

        Raises:
            FileError: It cannot be read, or something in it is wrong; the message says what.
        """
        tables = read_toml(path)
        parameters = [name for name in cls._checks if name != "obstacles"]
        try:
            checks.known("key", tables, ["obstacle", *parameters])
            return cls(make_obstacles(tables.pop("obstacle", [])), **tables)
        except IiwaDnnError as error:
            raise FileError(path, one_line(error)) from error

    @lru_cache(maxsize=8)  # noqa: B019  few parts, few robots
    def scene(self, robot: Robot) -> Scene:
        """Return bodies and pairs for a robot; raises what `make_scene` does."""
        distances = (self.distance, self.gain)
        return make_scene(robot, self.obstacles, self.self_collision, distances, self.left_out)

    def pairs(self, robot: Robot) -> list[tuple[str, float]]:
        """Return the names in words and the least distance [m] of each watched pair."""
        return [(f"{b} and {a}", self.distance) for a, b in self.scene(robot).pairs]

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows: two for each pair, at most `nearest`."""
        return min(self.nearest, ENDS * len(self.scene(robot).pairs))

    def row_names(self, robot: Robot) -> list[str]:
        """Return the pair of each row; none where rows change their pair."""
        names = [name for name, _ in self.pairs(robot) for _ in range(ENDS)]
        return names if len(names) <= self.nearest else []

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the links whose placements the rows need."""
        return self.scene(robot).frames

    def constants(self, robot: Robot) -> Vector:
        """Return `Scene.constants`, (k,)."""
        return self.scene(robot).constants

    @property
    def refreshes(self) -> bool:
        """Test whether an obstacle moves."""
        return any(obstacle.speed for obstacle in self.obstacles)

    def refresh(self, step: Step, constants: Vector) -> None:
        """Update the moving obstacles among the constants, (k,), to the time of a step."""
        self.scene(step.robot).move(constants, step.t)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return super().settings() | {"obstacles": [each.settings() for each in self.obstacles]}

    def overview(self, robot: Robot) -> dict[str, Any]:
        """Return a record's settings: least distance, obstacles, pairs, unwatched links.

        ``left_out`` has the pairs that no row watches, each with the reason, as in
        `CollisionModel`, ``"given"``, or ``"no joint moves it"``.
        """
        scene = self.scene(robot)
        of_links = collision_model(robot).left_out if self.self_collision else ()
        return {
            "distance": self.distance,
            "obstacles": self.settings()["obstacles"],
            "pairs": scene.pairs,
            "left_out": (*of_links, *scene.left_out),
            "unwatched": unwatched_links(robot),
        }


def avoidance_of(scheme: object) -> CollisionAvoidance | None:
    """Return the first `CollisionAvoidance` among the limits of a scheme."""
    limits = getattr(scheme, "limits", ())
    return next((part for part in limits if isinstance(part, CollisionAvoidance)), None)
