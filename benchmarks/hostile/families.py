"""Families of requests, by seed: what a joystick, a policy or a broken network may ask for.

A request is ``{"velocity": dq}`` or ``{"position": q}``, (n,), or None where nothing is heard;
``{"chunk": (times, positions)}`` stands beside a policy's position, for who takes it.
"""

from collections.abc import Callable, Iterator
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from benchmarks.hostile.arms import Arm, Array

SMOOTH = 0.5
"""Share of the limits of velocity and acceleration that an admissible motion takes up at most."""

WALK = 1.6
"""Speed of a person [m/s] (ISO 13855)."""

FRAME = 1.0 / 30.0
"""Period of a policy's samples and of a camera's frames [s]."""

Requests = Iterator[dict[str, Any] | None]


class Family(NamedTuple):
    """Requests of a kind, and what else is the matter.

    Attributes:
        about: What it is.
        requests: Yields a request a step, of an arm at a control period [s].
        admissible: Whether the requests keep all limits: lag and amplitude are then judged.
        spheres: Number of spheres beside the arm.
        person: Whether a sphere pursues the arm at `WALK`.
        payload: Whether the arm holds its rated payload.
        jitter: Largest relative change of a control period, which is stated.
        late: Periods by which the arm is behind its commands, which is stated.
        source: A public thread in which it was asked of filters.
    """

    about: str
    requests: Callable[[Arm, np.random.Generator, float], Requests]
    admissible: bool = False
    spheres: int = 0
    person: bool = False
    payload: bool = False
    jitter: float = 0.0
    late: int = 0
    source: str = ""


def smooth(arm: Arm, random: np.random.Generator) -> Callable[[float], Array]:
    """Draw a motion about the start that keeps the limits: two swings of each joint, from rest."""
    lower, upper, velocity, acceleration = arm.limits[:4]
    room = 0.8 * np.minimum(np.minimum(arm.start - lower, upper - arm.start), 1.0)
    rate = random.uniform(1.5, 4.0, (2, arm.dof))  # [rad/s]
    most = np.minimum(
        room, SMOOTH * np.minimum(velocity / rate, acceleration / rate**2).min(axis=0)
    )
    size = 0.3 * most * random.uniform(0.5, 1.0, (2, arm.dof))

    def at(t: float) -> Array:
        u = min(t / 0.8, 1.0)
        begun = u**3 * (10.0 - 15.0 * u + 6.0 * u**2)
        place: Array = arm.start + begun * (size * np.sin(rate * t)).sum(axis=0)
        return place

    return at


def jumps(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Ask for velocities that jump every 50 ms, a tenth to ten times what is admitted."""
    while True:
        size = random.choice([0.1, 1.0, 10.0])
        dq = size * arm.limits[2] * random.uniform(-1.0, 1.0, arm.dof)
        for _ in range(max(1, round(0.05 / dt))):
            yield {"velocity": dq}


def flips(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Ask for the largest velocities, and in the next period for the opposite."""
    sign = random.choice([-1.0, 1.0], arm.dof)
    while True:
        sign = -sign
        yield {"velocity": sign * arm.limits[2]}


def pressing(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Press each joint against one of its position limits for seconds, then against the other."""
    while True:
        sign = random.choice([-1.0, 1.0], arm.dof)
        for _ in range(round(1.5 / dt)):
            yield {"velocity": sign * arm.limits[2]}


def outside(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Ask for postures of which half are outside the position limits."""
    lower, upper = arm.limits[:2]
    while True:
        q = random.uniform(1.5 * lower, 1.5 * upper)
        for _ in range(round(0.3 / dt)):
            yield {"position": q}


def broken(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Mix numbers that are none, huge ones and silence into velocities."""
    for request in jumps(arm, random, dt):
        kind = random.integers(20)
        if kind == 0:
            request = {"velocity": np.full(arm.dof, random.choice([np.nan, np.inf, -np.inf]))}
        elif kind == 1:
            request = {"velocity": 1e300 * random.standard_normal(arm.dof)}
        yield None if kind == 2 else request


def silence(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Ask for such velocities for a second, then for nothing any more."""
    yield from islice(jumps(arm, random, dt), round(1.0 / dt))
    while True:
        yield None


def teleoperation(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Ask for the velocities of a motion that keeps the limits."""
    at = smooth(arm, random)
    t = 0.0
    while True:
        yield {"velocity": (at(t + dt) - at(t)) / dt}
        t += dt


def policy(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Give positions of such a motion at 30 Hz, each held until the next, with the chunk."""
    at = smooth(arm, random)
    step = 0
    while True:
        frame = int(step * dt / FRAME + 1e-9)
        times = FRAME * (frame + np.arange(16))
        chunk = (times, np.array([at(t) for t in times]))
        yield {"position": at(frame * FRAME), "chunk": chunk}
        step += 1


def seams(arm: Arm, random: np.random.Generator, dt: float) -> Requests:
    """Give such positions in chunks of half a second that do not fit together, a fifth lost."""
    at = smooth(arm, random)
    step = 0
    off = np.zeros(arm.dof)
    last = -1
    while True:
        t = step * dt
        frame = int(t / FRAME + 1e-9)
        if frame // 15 != last:
            last = frame // 15
            off = 0.04 * random.uniform(-1.0, 1.0, arm.dof)
        lost = random.random() < 0.2
        yield None if lost else {"position": at(frame * FRAME) + off}
        step += 1


FAMILIES = {
    "jumps": Family("velocities that jump, up to ten times too quick", jumps),
    "flips": Family("the largest velocity, of another sign in each period", flips),
    "pressing": Family("each joint pressed against its position limits", pressing),
    "outside": Family("postures outside the position limits", outside),
    "broken": Family("no numbers, huge numbers, silence", broken),
    "silence": Family("jumps, then nothing", silence),
    "jitter": Family("jumps, periods 0.5 to 1.5 as long", jumps, jitter=0.5),
    "late arm": Family("jumps, the arm 5 periods behind", jumps, late=5),
    "spheres": Family("jumps among three spheres", jumps, spheres=3),
    "person": Family("jumps, a person at 1.6 m/s", jumps, person=True),
    "payload": Family("jumps of postures, the rated payload held", outside, payload=True),
    "teleoperation": Family(
        "velocities that keep the limits", teleoperation, True, source="IsaacTeleop #727"
    ),
    "policy": Family("positions at 30 Hz that keep them", policy, True, source="lerobot #4241"),
    "seams": Family("chunks that do not fit together, a fifth lost", seams, source="openpi #393"),
}
"""Families by their name."""
