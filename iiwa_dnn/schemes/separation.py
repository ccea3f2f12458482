r"""Separation from bodies of bounded speed, whose direction is not known, such as people.

A body was seen at a place with an error e, a time a ago, by a sensor that sees all within a field
around the base; who is not seen is beyond its edge. Nothing else is assumed: a body may turn, bend
and split. With the distance :math:`d_s` to keep and its speed v, a motion to rest in M periods is
agreed with if each link that moves stays

.. math::  d \;\ge\; d_s + e + v\,(a + L + M\,dt)

from the place, bounded as in `iiwa_dnn.schemes.collisions`; L is the time by which the arm is
behind. A body that comes within :math:`d_s` of a link then meets it at rest, wherever it goes and
whatever is seen later (docs/people.md). With a contact speed the time counts until no point of the
link is quicker than that.

The limit has no rows: from within a body's reach no retreat is asked. So that the arm slows down
before it has to stop, the request is scaled by the largest factor f with

.. math::  (v + \tfrac12 f w)\,(T(f) + 3\,dt) \;\le\; \sigma\,(d - d_s - e - v\,(a + L)),

where w is the speed of approach and T the time in which the joints stop.
"""

import math
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, dot, scaled, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import LinkBody, collision_model
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.robot.meetings import Watched
from iiwa_dnn.robot.obstacles import Box, Capsule, Obstacle, Sphere, names_of
from iiwa_dnn.schemes.collisions import along
from iiwa_dnn.schemes.joint_limits import MotionConstants
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.program import ProgramArrays
from iiwa_dnn.schemes.rest import Motion, displacement_after, end_displacement
from iiwa_dnn.schemes.scene import (
    Body,
    Contact,
    Pair,
    box_contact,
    height_of,
    make_pair,
    names_beside,
    second_order,
)
from iiwa_dnn.schemes.step import StepViews, axis_at, rate_along
from iiwa_dnn.schemes.tip_speed import PEAK

SHARE = 0.9
"""Part sigma of the separation into which the stop from a request has to fit."""

SPARE = 3.0
"""Periods that a stop may take longer than its shortest time."""

ROUNDS = 12
"""Bisections of the factor on a request."""

FREE_BODY = 20
"""Numbers of a `FreeBody`."""

PEOPLE_SPEED = 2.0
"""Speed of people [m/s]: that of a hand near a machine by ISO 13855; 1.6 of one who walks."""

NEAR = 1e-9
"""Distance from the base below which a direction from it is no direction [m]."""

LINEAR, CUBIC = 1.0, 1.5
"""Steepest slope of a velocity on its way to zero, times the time over the velocity."""

BEND = 6.0
"""Largest second derivative of a cubic velocity on its way to zero, times time^2 / velocity."""


class SeparationHead(Record):
    """First constants of `Separation`.

    Attributes:
        least: Distance to keep [m].
        contact_speed: Speed of a link's points up to which it may be touched [m/s].
        latency: Largest age of a frame before the next one comes [s].
        delay: Time by which the arm is behind its commands [s].
        share: Part sigma of the separation into which the stop from a request has to fit.
        field: Radius of the field about the base, within which people are seen [m].
        people_speed: Speed of people [m/s].
        age: Age of the last frame of people [s].
        people: Number of bodies of a frame of people, the last ones.
        links: Number of links.
        bodies: Number of bodies.
        link_size: Length of a `WatchedLink`.
    """

    least: float
    contact_speed: float
    latency: float
    delay: float
    share: float
    field: float
    people_speed: float
    age: float
    people: int
    links: int
    bodies: int
    link_size: int


class WatchedLink(Record):
    """A capsule of a link that a joint moves.

    Attributes:
        frame: Index of the link's frame.
        radius: Radius [m].
        a: One end of its segment in the frame [m].
        b: The other end [m].
        reach: `Pair` of the world and the capsule, (4 + 2 n,).
    """

    frame: int
    radius: float
    a: Vector = part(3)
    b: Vector = part(3)
    reach: Vector = part("reach")


class FreeBody(Record):
    """A body of bounded speed where it was seen last: a box that is grown by a radius.

    Attributes:
        is_there: Whether it is anywhere.
        speed: Bound on its speed [m/s].
        error: Bound on the error of its place [m].
        radius: Radius [m].
        age: Time since it was there [s]; inf: it was not seen yet.
        half: Half-extents of the box [m].
        place: Axes and centre of the box.
    """

    is_there: bool
    speed: float
    error: float
    radius: float
    age: float
    half: Vector = part(3)
    place: Placement = part(Placement)


class SeparationViews(NamedTuple):
    """Constants of `Separation` as views.

    Attributes:
        head: Settings.
        links: A `WatchedLink` in each row.
        bodies: A `FreeBody` in each row.
    """

    head: SeparationHead
    links: Matrix
    bodies: Matrix


class LinkPlace(NamedTuple):
    """A capsule of a link in the world.

    Attributes:
        a: One end of its segment [m], (3,).
        b: The other end [m], (3,).
        center: Their middle [m], (3,).
        size: Radius of a ball about it that holds the capsule [m].
    """

    a: Vector3
    b: Vector3
    center: Vector3
    size: float


class Approach(NamedTuple):
    """Request of the joints, as the links it moves approach bodies.

    Attributes:
        time: Time in which the joints stop from the whole request [s].
        spare: Time that a stop may take longer [s].
        slow: Part of the request at which a link's points are not quicker than the contact speed.
        is_cubic: Whether a jerk is limited.
    """

    time: float
    spare: float
    slow: float
    is_cubic: bool


@compiled
def separation_views(constants: Vector) -> SeparationViews:
    """Return views of the constants (k,) of `Separation`."""
    at_links = SeparationHead.width()
    head = SeparationHead.of(constants[:at_links])
    at_bodies = at_links + head.links * head.link_size
    return SeparationViews(
        head,
        constants[at_links:at_bodies].reshape(head.links, head.link_size),
        constants[at_bodies:].reshape(head.bodies, FreeBody.width()),
    )


@compiled
def separation_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Leave the program of a step as it is: `Separation` has no rows and no bounds."""


@compiled
def place_link(placements: Matrix, link: WatchedLink) -> LinkPlace:
    """Place a link's capsule in the world, by the placements of frames (frames, 12)."""
    frame = Placement.of(placements[link.frame])
    base = triple(frame.position)
    a = combined(1.0, base, 1.0, axis_at(frame, triple(link.a)))
    b = combined(1.0, base, 1.0, axis_at(frame, triple(link.b)))
    path = combined(0.5, b, -0.5, a)
    size = math.sqrt(dot(path, path)) + link.radius
    return LinkPlace(a, b, combined(0.5, a, 0.5, b), size)


@compiled
def least_distance(here: LinkPlace, body: FreeBody) -> float:
    """Return a lower bound on the distance of a link from a body, by balls about both [m]."""
    path = combined(1.0, here.center, -1.0, triple(body.place.position))
    half = triple(body.half)
    return math.sqrt(dot(path, path)) - math.sqrt(dot(half, half)) - body.radius - here.size


@compiled
def body_contact(here: LinkPlace, link: WatchedLink, body: FreeBody) -> Contact:
    """Compute nearest points and distance of a link and a body, with their radii."""
    contact = box_contact(body.place, triple(body.half), here.a, here.b)
    return Contact(contact.second, contact.normal, contact.distance - link.radius - body.radius)


@compiled
def keeps_separation(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether all links surely keep away from all bodies on a motion to rest.

    A body may be anywhere that it can have reached; the test knows no pair that began nearer. A
    link that does not move keeps away from all. `constants` are those of `Separation`.
    """
    n = motion.first.size
    own = separation_views(constants)
    head = own.head
    travel = np.empty(n)
    for i in range(n):
        x = abs(motion.first[i])
        travel[i] = displacement_after(motion, x, abs(motion.coefficient[i]), motion.periods)
    for k in range(head.links):
        link = WatchedLink.of(own.links[k])
        pair = Pair.of(link.reach)
        late = head.delay + motion.period * quick_periods(motion, link, head.contact_speed)
        if late == head.delay:
            continue
        here = place_link(step.placements, link)
        most = 0.0
        for i in range(n):
            most += abs(pair.radii[i]) * travel[i]
        bend = 0.5 * second_order(pair, travel)
        if not _stays_in_field(step, head, link, here, motion, late, most, bend):
            return False
        for number in range(head.bodies):
            body = FreeBody.of(own.bodies[number])
            needed = head.least + body.error + body.speed * (body.age + late)
            if not body.is_there or least_distance(here, body) - most >= needed:
                continue
            contact = body_contact(here, link, body)
            left = contact.distance - needed
            if left < most and left + _change(step, pair, here, contact, motion, bend) < 0.0:
                return False
    return True


@compiled
def _change(
    step: StepViews, pair: Pair, here: LinkPlace, contact: Contact, motion: Motion, bend: float
) -> float:
    """Bound the change of a link's distance along a motion to rest from below [m], 0 at most.

    `bend` is a bound on what is of second order in the displacements [m].
    """
    change = 0.0
    for at in range(2):
        end = here.a if at == 0 else here.b
        x, b = along(motion, step.jacobian, pair, end, contact.normal)
        displacement = min(end_displacement(motion, x, b) - bend, 0.0)
        change = min(change, height_of(end, contact) + displacement)
    return change


@compiled
def quick_periods(motion: Motion, link: WatchedLink, contact_speed: float) -> float:
    """Count the periods of a motion to rest after which a link is slow until it rests.

    Slow is a link none of whose points is quicker than `contact_speed` [m/s]; if that is 0, one
    that no joint moves. Each joint counts with the link's largest distance from its axis.
    """
    if _fastest_point(motion, link, -1.0) <= contact_speed:
        return 0.0
    M = motion.periods
    if contact_speed == 0.0 or motion.varies:
        return M
    low = math.ceil(M / 3.0) if motion.cubic else 0  # from here on each term falls
    high = int(M)
    if _fastest_point(motion, link, low / M) <= contact_speed:
        return float(low)
    while high - low > 1:
        middle = (low + high) // 2
        if _fastest_point(motion, link, middle / M) <= contact_speed:
            high = middle
        else:
            low = middle
    return float(high)


@compiled
def _fastest_point(motion: Motion, link: WatchedLink, u: float) -> float:
    """Bound the speed of a link's points at the part u of a motion to rest [m/s].

    If u is negative, that along the whole motion.
    """
    pair = Pair.of(link.reach)
    of_first = 1.0
    of_coefficient = PEAK
    if u >= 0.0:
        left = 1.0 - u
        of_first = left * left * (1.0 + 2.0 * u) if motion.cubic else left
        of_coefficient = u * left * left
    speed = 0.0
    for i in range(motion.first.size):
        rate = of_first * abs(motion.first[i])
        if motion.cubic:
            rate += of_coefficient * abs(motion.coefficient[i])
        speed += reach_of(pair, link.radius, i) * rate
    return speed


@compiled
def reach_of(pair: Pair, radius: float, i: int) -> float:
    """Return the largest distance of a link's surface from the axis of joint i [m].

    It is 1 for a prismatic joint, and 0 for one that does not move the link.
    """
    if pair.support[i] == 0.0:
        return 0.0
    reach: float = pair.radii[i]
    return 1.0 if reach < 0.0 else reach + radius


@compiled
def _stays_in_field(
    step: StepViews,
    head: SeparationHead,
    link: WatchedLink,
    here: LinkPlace,
    motion: Motion,
    late: float,
    most: float,
    bend: float,
) -> bool:
    """Test whether a link keeps away from all who may be beyond the edge of the field.

    Args:
        step: The instant.
        head: Settings.
        link: The link.
        here: Its place.
        motion: The motion to rest.
        late: Time by which people may have moved more than the age of the frame says [s].
        most: Bound on the displacement of the link [m].
        bend: Bound on the difference of a displacement from the linear one [m].
    """
    if head.field == np.inf:
        return True
    room = head.field - head.least - link.radius - head.people_speed * (head.age + late)
    for at in range(2):
        end = here.a if at == 0 else here.b
        out = math.sqrt(dot(end, end))
        if out + most <= room:
            continue
        if not out <= room:
            return False
        # |y + u| <= |y| + n . u + |u|^2 / (2 |y|) with n along y.
        pair = Pair.of(link.reach)
        x, b = along(motion, step.jacobian, pair, end, scaled(1.0 / max(out, NEAR), end))
        outward = bend - min(end_displacement(motion, -x, -b), 0.0)
        outward += 0.5 * most * most / max(out, NEAR)
        if out + min(outward, most) > room:
            return False
    return True


@compiled
def separation_factor(
    constants: Vector, arrays: ProgramArrays, limits: MotionConstants, dq: Vector, dt: float
) -> float:
    """Compute the largest factor of a request from which the arm can stop (see the module).

    Args:
        constants: Constants of `Separation`, (k,).
        arrays: Kinematics of the step.
        limits: Limits of the joints.
        dq: The requested velocities [rad/s], (n,).
        dt: Control period [s].
    """
    own = separation_views(constants)
    head = own.head
    time = 0.0
    is_cubic = False
    for i in range(dq.size):
        speed = abs(dq[i])
        slope = CUBIC if limits.jerk[i] < np.inf else LINEAR
        is_cubic = is_cubic or limits.jerk[i] < np.inf
        time = max(time, slope * speed / limits.acceleration[i])
        time = max(time, math.sqrt(BEND * speed / limits.jerk[i]))
    factor = 1.0
    for k in range(head.links):
        link = WatchedLink.of(own.links[k])
        pair = Pair.of(link.reach)
        most = 0.0
        for i in range(dq.size):
            most += reach_of(pair, link.radius, i) * abs(dq[i])
        if most == 0.0:
            continue
        here = place_link(arrays.placements, link)
        request = Approach(time, SPARE * dt, head.contact_speed / most, is_cubic)
        speed = head.people_speed
        room, rate = _way_to_edge(head, link, here, arrays.jacobian, dq)
        factor = _stoppable(request, speed, rate, head.share * room, factor)
        for number in range(head.bodies):
            body = FreeBody.of(own.bodies[number])
            if not body.is_there:
                continue
            needed = head.least + body.error
            needed += body.speed * (max(body.age, head.latency) + head.delay)
            room = head.share * (least_distance(here, body) - needed)
            if _stops_within(request, body.speed, most, room, 1.0):
                continue
            contact = body_contact(here, link, body)
            rate = 0.0
            for i in range(dq.size):
                own_rate = rate_along(arrays.jacobian, i, contact.second, contact.normal)
                rate -= pair.support[i] * own_rate * dq[i]
            room = head.share * (contact.distance - needed)
            factor = _stoppable(request, body.speed, max(rate, 0.0), room, factor)
    return factor


@compiled
def _way_to_edge(
    head: SeparationHead, link: WatchedLink, here: LinkPlace, jacobian: Matrix, dq: Vector
) -> tuple[float, float]:
    """Return how far a link is from people beyond the edge of the field [m], and how fast [m/s].

    Args:
        head: Settings.
        link: The link.
        here: Its place.
        jacobian: `Kinematics.jacobian`, (n, 6).
        dq: The requested velocities [rad/s], (n,).
    """
    if head.field == np.inf:
        return np.inf, 0.0
    room = np.inf
    fastest = 0.0
    pair = Pair.of(link.reach)
    needed = head.least + head.people_speed * (max(head.age, head.latency) + head.delay)
    for at in range(2):
        end = here.a if at == 0 else here.b
        out = math.sqrt(dot(end, end))
        room = min(room, head.field - out - link.radius - needed)
        outward = scaled(1.0 / max(out, NEAR), end)
        rate = 0.0
        for i in range(dq.size):
            rate += pair.support[i] * rate_along(jacobian, i, end, outward) * dq[i]
        fastest = max(fastest, rate)
    return room, fastest


@compiled
def _stops_within(request: Approach, speed: float, rate: float, room: float, factor: float) -> bool:
    """Test whether a part of a request is slow enough for a body.

    Args:
        request: The request.
        speed: Speed of the body [m/s].
        rate: Speed at which the whole request approaches it [m/s].
        room: Way in which the stop has to fit [m].
        factor: The part.
    """
    if factor <= request.slow:
        return True
    shorter = math.sqrt(factor) if request.is_cubic else factor
    time = request.time * shorter * (1.0 - request.slow / factor) + request.spare
    return (speed + 0.5 * factor * rate) * time <= room


@compiled
def _stoppable(request: Approach, speed: float, rate: float, room: float, most: float) -> float:
    """Return the largest part of a request, at most `most`, that `_stops_within` admits."""
    if _stops_within(request, speed, rate, room, most):
        return most
    low = min(request.slow, most)
    high = most
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        if _stops_within(request, speed, rate, room, middle):
            low = middle
        else:
            high = middle
    return low


@compiled
def nearest_body(constants: Vector, placements: Matrix) -> Vector3:
    """Find the link and the body whose separation is least, after what bodies may have moved.

    Args:
        constants: Constants of `Separation`, (k,).
        placements: `Kinematics.placements`, (frames, 12).

    Returns:
        The separation less the one to keep [m]; inf if there is no body; the numbers of the link
        and of the body. After the bodies comes the edge of the field.
    """
    own = separation_views(constants)
    head = own.head
    found = np.inf
    nearest = 0
    body_found = 0
    nothing = np.zeros(0)
    for k in range(head.links):
        link = WatchedLink.of(own.links[k])
        here = place_link(placements, link)
        room, _ = _way_to_edge(head, link, here, np.zeros((0, 6)), nothing)
        room += head.people_speed * max(head.latency - head.age, 0.0)
        if room < found:
            found = room
            nearest = k
            body_found = head.bodies
        for number in range(head.bodies):
            body = FreeBody.of(own.bodies[number])
            if not body.is_there:
                continue
            needed = head.least + body.error + body.speed * (body.age + head.delay)
            if least_distance(here, body) - needed < found:
                room = body_contact(here, link, body).distance - needed
                if room < found:
                    found = room
                    nearest = k
                    body_found = number
    return found, float(nearest), float(body_found)


def free_bodies(argument: str, value: Any) -> tuple[Obstacle, ...]:
    """Return bodies of bounded speed as a tuple; refuse any other value."""
    for body in value:
        if not isinstance(body, Sphere | Capsule | Box) or not body.is_free:
            problem = f"must be a Sphere, Capsule or Box with a speed each, not {body!r}"
            raise InvalidInputError(argument, problem, value)
    return tuple(value)


@dataclass(frozen=True)
class Separation(Limit):
    """Separation from bodies of bounded speed, kept until rest (see the module).

    A `Shield` makes it; a `Controller` has it among its scheme's limits, and its path slows down
    when the test fails. Each step states where bodies were seen.

    Attributes:
        bodies: Bodies with a speed, that are seen one by one.
        people: Largest number of bodies that a sensor's frame shows.
        people_speed: Bound on their speed [m/s].
        field: Radius about the base within which the sensor sees all of them [m]; inf without.
        latency: Largest age of a frame before the next one comes [s]; it is for a smooth motion.
        contact_speed: Speed of a link's points up to which it may be touched [m/s].
        distance: Distance to keep [m].
        delay: Time by which the arm is behind its commands [s].
        share: Part of the separation into which the stop from a request has to fit; the promise
            does not depend on it.
    """

    kernel = staticmethod(separation_rows)
    rest_kernel = staticmethod(keeps_separation)
    _checks: ClassVar[checks.Checks] = {
        "bodies": free_bodies,
        "people_speed": checks.positive,
        "latency": checks.not_negative,
        "contact_speed": checks.not_negative,
        "distance": checks.positive,
        "delay": checks.not_negative,
        "share": checks.positive,
    }
    bodies: tuple[Obstacle, ...] = ()
    people: int = 0
    people_speed: float = PEOPLE_SPEED
    field: float = np.inf
    latency: float = 0.0
    contact_speed: float = 0.0
    distance: float = 0.02
    delay: float = 0.0
    share: float = SHARE

    @property
    def names(self) -> list[str]:
        """Names of the bodies, as those of obstacles, then of the people in a frame."""
        return names_of(self.bodies) + [f"person {k}" for k in range(1, 1 + self.people)]

    def links(self, robot: Robot) -> list[LinkBody]:
        """Return the capsules of the links that a joint moves."""
        return [
            each
            for each in collision_model(robot).capsules
            if robot.support[robot.frame_id(each.link)].any()
        ]

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of the links whose placements the kernel reads."""
        return tuple(dict.fromkeys(each.link for each in self.links(robot)))

    def words(self, robot: Robot, link: int, number: int, age: float) -> str:
        """Name a link and a body that it keeps away from, or a body that was seen long ago.

        Args:
            robot: The robot.
            link: Number of the link.
            number: Number of the body; after the bodies comes the edge of the field.
            age: Age of what was seen [s].
        """
        name = [*self.names, "edge of the field"][number]
        if age > self.latency:
            seen = name if number < len(self.bodies) else "people"
            return f"age of {seen} {age:.2f} s" if age < np.inf else f"no frame of {seen} yet"
        return f"separation of {self.links(robot)[link].link} from {name}"

    def constants(self, robot: Robot) -> Vector:
        """Return `SeparationHead`, links and bodies, none of which was seen yet, (k,)."""
        links = [self._watched(robot, each) for each in self.links(robot)]
        if not links:
            raise InvalidInputError("people", "need links with <collision> geometry", robot.name)
        names_beside([each.link for each in collision_model(robot).bodies], self.bodies)
        seen = [(body, body.speed, body.error) for body in self.bodies]
        rows = [_unseen(body, *own) for body, *own in seen]
        rows += [_unseen(None, self.people_speed, 0.0)] * self.people
        head = SeparationHead.make(
            least=self.distance,
            contact_speed=self.contact_speed,
            latency=self.latency,
            delay=self.delay,
            share=self.share,
            field=self.field,
            people_speed=self.people_speed,
            age=np.inf,
            people=self.people,
            links=len(links),
            bodies=len(rows),
            link_size=links[0].size,
        )
        return np.concatenate([head, *links, *rows])

    def _watched(self, robot: Robot, body: LinkBody) -> WatchedLink:
        """Return the `WatchedLink` of a link's capsule."""
        frame = robot.frame_id(body.link)
        center, rotation, half = body.shape.box
        radius = body.shape.thickness
        place = {"half": half, "axes": rotation.T, "center": center}
        own = Body.make(frame=frame, radius=radius, speed=0.0, **place)
        reach = make_pair(robot, [Body.zeros(), own], Watched(0, 1), 0.0).numbers
        along = half[2] * rotation[:, 2]
        ends = {"a": center - along, "b": center + along}
        return WatchedLink.make(frame=frame, radius=radius, reach=reach, **ends)


def _unseen(body: Obstacle | None, speed: float, error: float) -> FreeBody:
    """Return the `FreeBody` of a body that was not seen yet; of None, one that is nowhere."""
    own = FreeBody.zeros()
    own.is_there = body is not None
    own.speed = speed
    own.error = error
    own.age = np.inf
    own.place.axes = np.eye(3)
    if body is not None:
        own.radius = body.thickness
        own.half = body.box.half_extents
    return own
