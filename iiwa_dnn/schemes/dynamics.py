"""Torques of a robot and its payload as a kernel: the recursive Newton-Euler algorithm.

Vectors are along the axes of each link's own frame, whose z axis is that of its joint. Source: J.
Y. S. Luh, M. W. Walker, R. P. C. Paul, "On-line computational scheme for mechanical manipulators",
J. Dynamic Systems, Measurement, and Control 102 (1980). Tests compare Pinocchio's.
"""

import numpy as np

from iiwa_dnn.checks import Array, Matrix, Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import sin_cos
from iiwa_dnn.references.rotations import combined, cross, dot, triple
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.robot.kinematics_kernel import PrincipalAxes, model_tables
from iiwa_dnn.robot.payload import Payload
from iiwa_dnn.robot.robot import Robot

LINK = 28
"""Length of a `Link`."""

SHIFTS = 9
"""Wrenches of a payload's shifts in its box: 3 are linear in the shift, 6 in products of two."""


class Mass(Record):
    """A rigid body: mass [kg], centre of mass [m] and inertia about it, by columns [kg m^2]."""

    mass: float
    center: Array = part(3)
    inertia: Matrix = part(3, 3)


class Link(Record):
    """A joint with the link that it carries.

    Attributes:
        parent: Number of the joint that carries it, from 1; 0: the world.
        slides: 1 for a joint that slides along its z axis, 0 for one that turns about it.
        armature: Inertia of its motor [kg m^2].
        placement: Placement at 0 in the frame of its parent.
        body: The link.
    """

    parent: int
    slides: float
    armature: float
    placement: Placement = part(Placement)
    body: Mass = part(Mass)


class Dynamics(Record):
    """Masses of a robot of n joints.

    Attributes:
        carrier: Number of the joint, from 1, that carries the payload.
        gravity: Acceleration of gravity [m/s^2], (3,).
        payload: The payload for each kilogram of it, in the frame of its joint.
        spread: Half the edges of the box that its centre is in, by rows [m], (3, 3).
        links: `Link` of each joint, (n, 28).
    """

    carrier: int
    gravity: Array = part(3)
    payload: Mass = part(Mass)
    spread: Matrix = part(3, 3)
    links: Matrix = part("n", LINK)


class LinkMotion(Record):
    """Motion of a link along its own axes: rates, their change, and the acceleration of its origin.

    Gravity counts as an acceleration upwards. `axes` are those of the link in its parent's frame,
    and `origin` is its place there.
    """

    rate: Array = part(3)
    change: Array = part(3)
    linear: Array = part(3)
    axes: Matrix = part(3, 3)
    origin: Array = part(3)


class Wrench(Record):
    """Force and moment about a link's origin along its axes."""

    force: Array = part(3)
    moment: Array = part(3)


def dynamics_of(robot: Robot) -> Dynamics:
    """Return the masses of a robot and its payload; without one, of a payload of no mass."""
    held = robot.payload or Payload(robot.tip, np.zeros(2), np.zeros((2, 3)), np.zeros((3, 3)))
    tables = model_tables(robot, [robot.frame_id(held.frame)], dynamics=True)
    links = []
    for j, numbers in enumerate(tables.bodies):
        axes, center = _pose(PrincipalAxes.of(numbers).placement)
        moments = PrincipalAxes.of(numbers).roots[3:] ** 2
        body = Mass.make(
            mass=float(numbers[12] ** 2), center=center, inertia=(axes * moments) @ axes.T
        )
        link = Link.make(
            parent=tables.parents[j],
            slides=tables.slides[j],
            armature=tables.armature[j],
            placement=Placement.of(tables.joints[j]),
            body=body,
        )
        links.append(link.numbers)
    turn, origin = _pose(Placement.of(tables.offsets[0]))
    payload = Mass.make(
        mass=1.0,
        center=origin + turn @ held.center.mean(axis=0),
        inertia=turn @ held.inertia @ turn.T,
    )
    return Dynamics.make(
        carrier=tables.carriers[0],
        gravity=np.array(robot.model.gravity.linear),
        payload=payload,
        spread=0.5 * np.diff(held.center, axis=0).T * turn.T,
        links=np.array(links),
    )


def _pose(placement: Placement) -> tuple[Array, Array]:
    """Return rotation matrix (3, 3) and position [m] (3,) of a placement."""
    return np.array(placement.axes).T, np.array(placement.position)


@compiled
def write_torques(
    arm: Dynamics,
    gravity: float,
    q: Array,
    v: Array,
    a: Array,
    torque: Array,
    slope: Array,
    doubt: Array,
) -> None:
    """Write the torques of the joints, or the forces of sliding ones: those of M(q) a + h(q, v).

    Args:
        arm: The masses.
        gravity: 1, or 0 for torques without gravity.
        q: Joint positions [rad], (n,).
        v: Joint velocities [rad/s], (n,).
        a: Joint accelerations [rad/s^2], (n,).
        torque: Torques without the payload [N m], (n,), overwritten.
        slope: Torques for each kilogram of the payload [N m/kg], (n,), overwritten.
        doubt: Bound on what each of these is more or less with the payload's centre, or its matter,
            anywhere in its box [N m/kg], (n,), overwritten.
    """
    n = q.size
    motions = np.zeros((n + 1, LinkMotion.width()))
    own = np.zeros((n + 1, Wrench.width()))
    held = np.zeros((n + 1, Wrench.width()))
    count = 0
    for i in range(3):
        if dot(triple(arm.spread[i]), triple(arm.spread[i])) > 0.0:
            count = SHIFTS
    shifts = np.zeros(((n + 1) * count, Wrench.width()))
    world = 0  # the place of the base
    base = LinkMotion.of(motions[world])
    for i in range(3):
        base.linear[i] = -gravity * arm.gravity[i]
    for j in range(n):
        link = Link.of(arm.links[j])
        here = LinkMotion.of(motions[j + 1])
        _move(link, LinkMotion.of(motions[link.parent]), (q[j], v[j], a[j]), here)
        _accelerate(link.body, here, Wrench.of(own[j + 1]))
    carrier = LinkMotion.of(motions[arm.carrier])
    _accelerate(arm.payload, carrier, Wrench.of(held[arm.carrier]))
    if count > 0:
        first = arm.carrier * count
        _shift(arm, carrier, triple(Wrench.of(held[arm.carrier]).force), shifts[first:])
    for k in range(n):
        j = n - 1 - k
        link = Link.of(arm.links[j])
        here = LinkMotion.of(motions[j + 1])
        of_link = Wrench.of(own[j + 1])
        of_payload = Wrench.of(held[j + 1])
        torque[j] = link.armature * a[j] + _along(link, of_link)
        slope[j] = _along(link, of_payload)
        doubt[j] = 0.0
        _pass_on(here, of_link, Wrench.of(own[link.parent]))
        _pass_on(here, of_payload, Wrench.of(held[link.parent]))
        for i in range(count):
            shift = Wrench.of(shifts[(j + 1) * count + i])
            doubt[j] += abs(_along(link, shift))
            _pass_on(here, shift, Wrench.of(shifts[link.parent * count + i]))


@compiled
def _move(link: Link, below: LinkMotion, joint: Vector3, here: LinkMotion) -> None:
    """Write the motion of a link, from that of its parent and of the joint between them.

    `joint` is the joint's position, velocity and acceleration.
    """
    q, v, a = joint
    slides = link.slides
    turns = 1.0 - slides
    sine, cosine = sin_cos(turns * q)
    for i in range(3):
        x = link.placement.axes[0, i]
        y = link.placement.axes[1, i]
        z = link.placement.axes[2, i]
        here.axes[0, i] = x * cosine + y * sine
        here.axes[1, i] = y * cosine - x * sine
        here.axes[2, i] = z
        here.origin[i] = link.placement.position[i] + z * (slides * q)
    rate = triple(below.rate)
    change = triple(below.change)
    offset = triple(here.origin)
    swing = combined(1.0, cross(change, offset), 1.0, cross(rate, cross(rate, offset)))
    linear = combined(1.0, triple(below.linear), 1.0, swing)
    for i in range(3):
        axis = triple(here.axes[i])
        here.rate[i] = dot(axis, rate)
        here.change[i] = dot(axis, change)
        here.linear[i] = dot(axis, linear)
    own = (0.0, 0.0, 1.0)
    across = cross(triple(here.rate), own)
    spin = combined(turns * v, across, turns * a, own)
    slip = combined(2.0 * slides * v, across, slides * a, own)
    for i in range(3):
        here.rate[i] += turns * v * own[i]
        here.change[i] += spin[i]
        here.linear[i] += slip[i]


@compiled
def _accelerate(body: Mass, motion: LinkMotion, wrench: Wrench) -> None:
    """Write the wrench that gives a body the motion of its link."""
    rate = triple(motion.rate)
    change = triple(motion.change)
    center = triple(body.center)
    swing = combined(1.0, cross(change, center), 1.0, cross(rate, cross(rate, center)))
    force = combined(body.mass, triple(motion.linear), body.mass, swing)
    momentum = _times(body.inertia, rate)
    spin = combined(1.0, _times(body.inertia, change), 1.0, cross(rate, momentum))
    moment = combined(1.0, spin, 1.0, cross(center, force))
    for i in range(3):
        wrench.force[i] = force[i]
        wrench.moment[i] = moment[i]


@compiled
def _shift(arm: Dynamics, motion: LinkMotion, force: Vector3, shifts: Matrix) -> None:
    """Write the wrenches of a kilogram's shifts by half the edges of its box, and by two of them.

    Shifted by s, the acceleration of a point changes by A s, so its force, and the moment of that
    by c x A s + s x (f + A s); all matter in the box is a mean of such points.

    Args:
        arm: The masses.
        motion: Motion of the link that carries the payload.
        force: Force f on a kilogram at the centre c of the box [N/kg].
        shifts: `Wrench` of each shift, (9 or more, 6), of which 9 are overwritten.
    """
    rate = triple(motion.rate)
    change = triple(motion.change)
    center = triple(arm.payload.center)
    row = 3
    for i in range(3):
        edge = triple(arm.spread[i])
        gain = combined(1.0, cross(change, edge), 1.0, cross(rate, cross(rate, edge)))
        moment = combined(1.0, cross(center, gain), 1.0, cross(edge, force))
        for k in range(3):
            shifts[i, k] = gain[k]
            shifts[i, 3 + k] = moment[k]
        for j in range(i + 1):
            other = triple(arm.spread[j])
            moment = cross(other, gain)
            if j < i:
                moment = combined(1.0, moment, 1.0, cross(edge, triple(shifts[j])))
            for k in range(3):
                shifts[row, k] = 0.0
                shifts[row, 3 + k] = moment[k]
            row += 1


@compiled
def _times(A: Matrix, v: Vector3) -> Vector3:
    """Multiply a symmetric matrix (3, 3) by a vector."""
    product = (0.0, 0.0, 0.0)
    for i in range(3):
        product = combined(1.0, product, v[i], triple(A[i]))
    return product


@compiled
def _along(link: Link, wrench: Wrench) -> float:
    """Compute the part of a wrench that the joint's motor bears."""
    slides: float = link.slides
    axis = (0.0, 0.0, 1.0)
    force = dot(axis, triple(wrench.force))
    return slides * force + (1.0 - slides) * dot(axis, triple(wrench.moment))


@compiled
def _pass_on(here: LinkMotion, wrench: Wrench, below: Wrench) -> None:
    """Add a wrench of a link to that of its parent."""
    force = (0.0, 0.0, 0.0)
    moment = (0.0, 0.0, 0.0)
    for i in range(3):
        axis = triple(here.axes[i])
        force = combined(1.0, force, wrench.force[i], axis)
        moment = combined(1.0, moment, wrench.moment[i], axis)
    moment = combined(1.0, moment, 1.0, cross(triple(here.origin), force))
    for i in range(3):
        below.force[i] += force[i]
        below.moment[i] += moment[i]
