r"""Collision avoidance: two inequality rows for each pair of bodies that could meet.

For a pair at distance :math:`d`, with the unit normal :math:`n` from the first body to the second,
each end :math:`x` of the second body's segment has one row. Along the normal the end is
:math:`\eta \ge 0` farther away than the nearest point. The row is a velocity damper,

.. math::  n \cdot \dot x \;\ge\; v_o - \kappa\,(d + \eta - d_s - \mu - \varepsilon)

with the speed :math:`v_o` of the obstacle, `CLEARANCE` :math:`\mu`, and a bound
:math:`\varepsilon` on the distance that a step like the last one loses although its row holds, as
points move on curves. The rows keep the distance to first order; what guarantees it is the stopping
motion that is verified for each command (`iiwa_dnn.step.stopping`).

Source: B. Faverjon, P. Tournassoud, "A local based approach for path planning of manipulators with
a high number of degrees of freedom", ICRA 1987.
"""

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
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
from iiwa_dnn.schemes.rest import Motion, displacement_after, end_displacement
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
"""Distance beyond the least one at which a pair comes to rest [m]. Points move along an obstacle on
curves: from the least distance itself, no stopping motion would keep it, and the arm could not
leave."""

MEET = np.inf
"""Distance to keep that marks a pair which overlaps without a normal: the arm is stopped."""


@compiled
def collision_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write G (rows, n) and h (rows,) of the ends of pairs whose rows have the least slack.

    `constants` are `Scene.constants`. Writes G, h and, by `kept_distance`, step.least; if there are
    more ends than rows, step.row_pair too. lb and ub stay.
    """
    dof = step.q.size
    scene = scene_views(constants)
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
            else:
                step.row_pair[scene.head.row + row] = 1 + scene.head.first + k // ENDS
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
    """Write the candidate rows of both ends of pair k, the numbers 2 k and 2 k + 1 of c candidates.

    They are not written for a pair so far away that no velocity within the limits breaks its rows.
    Writes step.least at the pair, gradients, limits and slacks.

    Args:
        step: The instant.
        scene: The scene, b bodies.
        placed: Placements of the bodies, (b, 12).
        k: Index of the pair in the scene.
        gradients: Rows of G, (c, n).
        limits: Right-hand sides h, (c,).
        slacks: Least slack of each row within the velocity limits, (c,).
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
        most += abs(pair.radii[j]) * step.velocity_limits[j]
    if most <= 0.0:
        return
    ends = ends_of(scene, placed, pair.second)
    is_point = Body.of(scene.bodies[pair.second]).half[2] == 0.0
    eps = second_order(pair, travel)
    for at in range(1 if is_point else ENDS):
        if pair.unmoved_end == at + 1:
            continue
        row = ENDS * k + at
        left = contact.distance + height_of(ends[at], contact) - least - CLEARANCE
        limits[row] = gain * left - speed
        fastest = 0.0
        for j in range(step.q.size):
            if pair.support[j] != 0.0:
                rate = rate_along(step.jacobian, j, ends[at], contact.normal)
                gradients[row, j] = -pair.support[j] * rate
                fastest += abs(rate) * step.velocity_limits[j]
        slacks[row] = limits[row] - fastest
        limits[row] -= gain * eps
        if left < eps and step.rate < np.inf:
            limits[row] -= (step.rate - gain) * min(eps - left, eps)
        if least < scene.head.least:
            limits[row] = max(limits[row], -speed)


@compiled
def kept_distance(scene: SceneViews, contact: Contact, kept: float) -> float:
    """Compute the distance that a pair has to keep from now on [m]; `MEET` if it has no normal.

    It is the least distance of the scene. A pair that begins nearer than that has to keep the
    distance with which it began, less `CLEARANCE`, until it is beyond the scene's. (If it had to
    keep the largest distance so far, a pair at the end of its link's range could not come back.)

    Args:
        scene: The scene.
        contact: The pair's contact.
        kept: Distance that the pair had to keep so far [m]; 0 at the beginning.
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
    """Return the place of candidate k in ascending order of the slacks (c,), from 0.

    Of equal slacks the one with the lower index comes first, so that no two share a place.
    """
    rank = 0
    for i in range(slacks.size):
        rank += slacks[i] < slacks[k] or (i < k and slacks[i] == slacks[k])
    return rank


@compiled
def keeps_distances(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether all pairs of a scene surely keep their distance on a motion to rest.

    The test is by bounds: False may be returned for a motion that would keep all of them.
    If a pair is nearer than the distance that it has to keep, or a moving obstacle may bring it
    that near while the arm brakes, the motion of the arm must not reduce its distance.

    Args:
        step: The instant at which the motion begins. In its `least`, 0 stands for the distance of
            the scene.
        constants: Numbers of the scene, `Scene.constants`, (k,).
        motion: The motion, of n joints.
    """
    n = motion.first.size
    scene = scene_views(constants)
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, step.placements, placed)
    M = motion.periods
    travel = np.empty(n)
    for i in range(n):
        travel[i] = displacement_after(motion, abs(motion.first[i]), abs(motion.coefficient[i]), M)
    for k in range(len(scene.pairs)):
        contact = contact_of(scene, k, placed)
        pair = Pair.of(scene.pairs[k])
        left = contact.distance - Body.of(scene.bodies[pair.first]).speed * motion.period * M
        most = 0.0
        for i in range(n):
            most += abs(pair.radii[i]) * travel[i]
        own = step.least[scene.head.first + k]
        kept = own if own != 0.0 else scene.head.least
        if left - most >= kept:
            continue
        change = np.inf
        remainder = 0.5 * second_order(pair, travel)
        ends = ends_of(scene, placed, pair.second)
        for at in range(2):
            end = ends[at]
            if pair.unmoved_end == at + 1:
                continue
            x, coefficient = along(motion, step.jacobian, pair, end, contact.normal)
            displacement = end_displacement(motion, x, coefficient)
            change = min(change, height_of(end, contact) + min(displacement - remainder, 0.0))
        if left + change < min(kept, left):
            return False
    return True


@compiled
def along(
    motion: Motion, jacobian: Matrix, pair: Pair, point: Vector3, normal: Vector3
) -> tuple[float, float]:
    """Compute the velocity of a point along a normal (3,), relative to the pair's first body.

    Args:
        motion: A motion of n joints to rest.
        jacobian: Joint Jacobian, `Kinematics.jacobian`, (n, 6).
        pair: The pair; the point is of its second body.
        point: Position of the point [m], (3,).
        normal: Unit normal from the first to the second body, (3,).

    Returns:
        Its first velocity and its coefficient b [m/s].
    """
    x = 0.0
    b = 0.0
    for j in range(motion.first.size):
        if pair.support[j] != 0.0:
            rate = pair.support[j] * rate_along(jacobian, j, point, normal)
            x += rate * motion.first[j]
            b += rate * motion.coefficient[j]
    return x, b


def tuple_of_obstacles(argument: str, value: Any) -> tuple[Obstacle, ...]:
    """Return one obstacle or several as a tuple; refuse any other value."""
    obstacles = value if isinstance(value, Iterable) else (value,)
    found = tuple(checks.instance(argument, obstacle, Obstacle) for obstacle in obstacles)
    for obstacle in found:
        if obstacle.is_free:
            problem = f"go in a direction that is not known: {obstacle!r}; a Shield takes it"
            raise InvalidInputError(argument, problem, value)
    return found


def pairs_of_names(argument: str, value: Any) -> tuple[tuple[str, str], ...]:
    """Return a list of pairs of names as a tuple of tuples; refuse any other value."""
    pairs = value if isinstance(value, list | tuple) else [value]
    if not all(
        isinstance(pair, list | tuple) and [*map(type, pair)] == [str, str] for pair in pairs
    ):
        raise InvalidInputError(argument, f"must be pairs of names, not {value!r}", value)
    return tuple(map(tuple, pairs))


@dataclass(frozen=True, eq=False)
class CollisionAvoidance(Limit):
    """Rows that keep links, tools and held objects away from obstacles and from each other.

    No pair comes nearer than `distance`, not even between steps, if the arm begins at rest and
    follows the commands, `JointLimits` are among the limits, obstacles stand still, and at most
    `nearest` rows are active at once. A pair that begins nearer than `distance` comes no nearer
    than it began, until it is beyond `distance`. A pair that no joint moves is left out.

    Attributes:
        obstacles: The obstacles.
        self_collision: Whether pairs of links are watched too.
        distance: Least distance [m], above 0.
        gain: Largest rate at which a distance shrinks towards `distance` [1/s], above 0.
        nearest: Largest number of rows; the program has those with the least slack.
        may_touch: Pairs that are not watched, each as two names of `Scene.pairs` in any order: a
            gripper and its object, ``[("tool", "Box 1")]``.
    """

    kernel = staticmethod(collision_rows)
    rest_kernel = staticmethod(keeps_distances)
    _checks: ClassVar[checks.Checks] = {
        "obstacles": tuple_of_obstacles,
        "self_collision": partial(checks.one_of, choices=(True, False)),
        "distance": checks.positive,
        "gain": checks.positive,
        "nearest": partial(checks.integer, least=1),
        "may_touch": pairs_of_names,
    }
    obstacles: Sequence[Obstacle] = ()
    self_collision: bool = True
    distance: float = 0.02
    gain: float = 20.0
    nearest: int = 48
    may_touch: Sequence[tuple[str, str]] = ()

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> "CollisionAvoidance":
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
        """Return the scene for a robot; raises the errors of `make_scene`."""
        distances = (self.distance, self.gain)
        return make_scene(robot, self.obstacles, self.self_collision, distances, self.may_touch)

    def pairs(self, robot: Robot) -> list[tuple[str, float]]:
        """Return for each watched pair its name in words and the distance it has to keep [m]."""
        return [(f"{b} and {a}", self.distance) for a, b in self.scene(robot).pairs]

    def unguarded(self, robot: Robot) -> list[str]:
        """Return in words the pairs of links that may meet, and that it does not keep apart."""
        given = {frozenset(pair) for pair in self.may_touch}
        told = collision_model(robot).unguarded if self.self_collision else ()
        return [" and ".join(pair) for pair in told if frozenset(pair) not in given]

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows: two for each pair, at most `nearest`."""
        return min(self.nearest, ENDS * len(self.scene(robot).pairs))

    def row_names(self, robot: Robot) -> list[str]:
        """Return the pair of each row; none if that changes from step to step."""
        names = [name for name, _ in self.pairs(robot) for _ in range(ENDS)]
        return names if len(names) <= self.nearest else []

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of the links whose placements the kernel reads."""
        return self.scene(robot).frames

    def constants(self, robot: Robot) -> Vector:
        """Return the constants of the scene, (k,)."""
        return self.scene(robot).constants

    @property
    def refreshes(self) -> bool:
        """Test whether an obstacle moves."""
        return any(obstacle.speed for obstacle in self.obstacles)

    def refresh(self, step: Step, constants: Vector) -> None:
        """Write the centres of moving obstacles at the time of a step to the constants, (k,)."""
        self.scene(step.robot).move(constants, step.t)

    def settings(self) -> dict[str, Any]:
        """Return the class name and the parameters, as values that JSON can hold."""
        return super().settings() | {"obstacles": [each.settings() for each in self.obstacles]}

    def overview(self, robot: Robot) -> dict[str, Any]:
        """Return the settings of a record: least distance, obstacles, pairs, unwatched links.

        ``left_out`` has the pairs that no row watches, each with its reason: that of
        `CollisionModel`, ``"may touch"``, or ``"no joint moves it"``.
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
    """Return the first `CollisionAvoidance` among the limits of a scheme; None if it has none."""
    limits = getattr(scheme, "limits", ())
    return next((part for part in limits if isinstance(part, CollisionAvoidance)), None)
