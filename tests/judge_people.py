"""A judge of people beside arms: ``python tests/judge_people.py SEED STEPS``.

People are capsules whose ends an attacker steers at a bounded speed; a sensor sees them late, with
errors, and loses frames. Distances are taken every 0.1 ms, with kinematics and a distance of
segments of the judge's own. A contact in motion is a link that moves while a body is nearer than
promised.
"""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Set
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numba import njit

import iiwa_dnn
from iiwa_dnn.robot.collision import collision_model
from iiwa_dnn.schemes.separation import Separation

MODES = (
    "pursuit",
    "dodge",
    "random",
    "intercept",
    "beyond",
    "hover",
    "near",
    "crossing",
    "leave",
)
PURSUIT, DODGE, RANDOM, INTERCEPT, BEYOND, HOVER, NEAR, CROSSING, LEAVE = range(len(MODES))

SAMPLE = 1e-4
"""Time between two judged distances [s]."""

ROUNDING = 1e-9
"""Distance that rounding may cost [m]."""

NO_SHARE = 1e9
"""Part of the separation into which a stop has to fit by which no request is scaled."""

FASTEST = 3.0
"""Bound on the distance of a point of an arm from a joint's axis [m]."""


class Skeleton(NamedTuple):
    """Capsules of an arm, for kinematics of the judge's own."""

    offsets: Any  # of the joints, (n, 4, 4)
    axes: Any  # (n, 3)
    slides: Any  # (n,)
    parents: Any  # joint that carries each capsule, (L,)
    radii: Any  # [m], (L,)
    ends: Any  # in the joint's frame [m], (L, 2, 3)


def skeleton_of(robot: iiwa_dnn.Robot) -> Skeleton:
    """Return the capsules of the links that joints move."""
    model = robot.model
    carried = [
        (model.frames[robot.frame_id(link)], shape)
        for link, shape in collision_model(robot).capsules
        if model.frames[robot.frame_id(link)].parentJoint
    ]
    axes = np.reshape([model.joints[j + 1].createData().S for j in range(robot.dof)], (-1, 2, 3))
    return Skeleton(
        np.array([model.jointPlacements[j + 1].homogeneous for j in range(robot.dof)]),
        axes.sum(axis=1),
        np.abs(axes[:, 0]).any(axis=1),
        np.array([frame.parentJoint - 1 for frame, _ in carried]),
        np.array([each.radius for _, each in carried]),
        np.array([[f.placement.act(np.array(x)) for x in (c.a, c.b)] for f, c in carried]),
    )


@njit(cache=True)
def place(arm: Skeleton, q: Any, out: Any) -> None:
    """Write the ends of all capsules, (L, 2, 3): turns by Rodrigues' formula, one by one."""
    turn = np.eye(3)
    origin = np.zeros(3)
    last = np.empty((3, 3))
    own = np.empty((3, 3))
    for j in range(q.size):
        offset = arm.offsets[j]
        axis = arm.axes[j]
        for i in range(3):
            origin[i] += _dot(turn[i], offset[:3, 3])
        last[:] = turn
        _multiply(last, offset[:3, :3], turn)
        if arm.slides[j]:
            for i in range(3):
                origin[i] += q[j] * _dot(turn[i], axis)
        else:
            sine, versine = np.sin(q[j]), 1.0 - np.cos(q[j])
            for i in range(3):
                for k in range(3):
                    own[i, k] = versine * axis[i] * axis[k]
                own[i, i] += 1.0 - versine
                after, before = (i + 1) % 3, (i + 2) % 3
                own[i, after] -= sine * axis[before]
                own[i, before] += sine * axis[after]
            last[:] = turn
            _multiply(last, own, turn)
        for k in range(arm.parents.size):
            if arm.parents[k] == j:
                for at in range(2):
                    for i in range(3):
                        out[k, at, i] = origin[i] + _dot(turn[i], arm.ends[k, at])


@njit(cache=True)
def _dot(a: Any, b: Any) -> float:
    """Return the product of two vectors (3,)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True)
def _multiply(A: Any, B: Any, out: Any) -> None:
    """Write the product of two matrices (3, 3)."""
    for i in range(3):
        for k in range(3):
            out[i, k] = A[i, 0] * B[0, k] + A[i, 1] * B[1, k] + A[i, 2] * B[2, k]


@njit(cache=True)
def ball_and_segment(x: Any, p: Any, u: Any, uu: float) -> tuple[float, float]:
    """Return the squared distance of a point from the segment p + t u, and the t."""
    t = 0.0
    for i in range(3):
        t += u[i] * (x[i] - p[i])
    t = min(max(t / uu, 0.0), 1.0) if uu > 0.0 else 0.0
    found = 0.0
    for i in range(3):
        found += (x[i] - p[i] - t * u[i]) ** 2
    return found, t


@njit(cache=True)
def apart(p: Any, q: Any) -> tuple[float, float]:
    """Return the distance of segments p and q (2, 3) [m], and the place on p in [0, 1].

    The least of five: that of the lines, if it is on both segments, and those of the four ends.
    """
    u = p[1] - p[0]
    v = q[1] - q[0]
    uu = uv = vv = uw = vw = 0.0
    for i in range(3):
        w = p[0, i] - q[0, i]
        uu += u[i] * u[i]
        uv += u[i] * v[i]
        vv += v[i] * v[i]
        uw += u[i] * w
        vw += v[i] * w
    best = 1e300
    at = 0.0
    for k in range(2):
        found, _ = ball_and_segment(p[k], q[0], v, vv)
        if found < best:
            best = found
            at = float(k)
        found, t = ball_and_segment(q[k], p[0], u, uu)
        if found < best:
            best = found
            at = t
    det = uu * vv - uv * uv
    if det > 1e-12 * uu * vv:
        s = (uv * vw - vv * uw) / det
        t = (uu * vw - uv * uw) / det
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            found = 0.0
            for i in range(3):
                found += (p[0, i] - q[0, i] + s * u[i] - t * v[i]) ** 2
            if found < best:
                best = found
                at = s
    return np.sqrt(best), at


@dataclass
class Scene:
    """People, their sensor, and what the shields are told of them, for N arms."""

    robot: iiwa_dnn.Robot
    count: int
    dt: float = 1e-3
    people: int = 1
    radius: float = 0.06
    speed: float = 1.6
    error: float = 0.03
    distance: float = 0.02
    rate: float = 30.0
    latency: float = 0.1
    lost: float = 0.0
    reach: float = np.inf  # of the field [m]
    contact_speed: float = 0.0
    modes: tuple[int, ...] = tuple(range(len(MODES)))
    requests: str = "dq"
    lies: Set[str] = frozenset()
    """What the shield is not told: ``age``, ``error``, ``speed``, ``missing``, ``field``; ``still``
    is that people move; ``""`` is nothing: requests are not scaled, as beside the others."""

    @property
    def every(self) -> int:
        """Steps between two frames."""
        return max(1, round(1.0 / self.rate / self.dt))

    @property
    def late(self) -> int:
        """Steps until a frame arrives."""
        return round(self.latency / self.dt)


class Verdict(NamedTuple):
    """What became of N arms over T steps."""

    steps: int
    contacts: int
    touching: int  # steps
    least: float  # of links in motion [m]
    moving: float  # share of steps
    tail: Any  # share of the last quarter, (N,)
    trapped: int  # arms that rest in the last quarter, though a frame says that all have left
    tip: float  # mean speed of the last capsule's end [m/s]
    rates: tuple[float, float]  # acceleration and jerk, in units of their limits
    quickest: float  # point of a link that is touched [m/s]
    refused: float  # share of steps whose command is not the request's

    @property
    def line(self) -> str:
        """The verdict in a line."""
        return (
            f"{self.steps} steps: {self.contacts} contacts in motion ({self.touching} steps), "
            f"least {1e3 * self.least:.3f} mm, moving {self.moving:.3f}, trapped "
            f"{self.trapped} of {self.tail.size}, tip {self.tip:.3f} m/s, rates "
            f"{self.rates[0]:.6f} {self.rates[1]:.6f}, touched at {self.quickest:.3f} m/s"
        )


@njit(cache=True)
def move_people(arm, mode, leaves, q, dq, ends, home, k, own, out) -> float:  # type: ignore
    """Move the ends (P, 2, 3) of all bodies of one arm by a period; return the least distance."""
    dt, radius, speed, near, phase = own
    links = np.empty(arm.ends.shape)
    ahead = np.empty(arm.ends.shape)
    place(arm, q, links)
    place(arm, q + dt * dq, ahead)
    moves = np.abs(dq).max() > 0.0
    least_of_all = 1e300
    for p in range(len(ends)):
        least = 1e300
        aim = np.zeros(3)
        for link in range(arm.parents.size):
            d, at = apart(links[link], ends[p])
            if d - arm.radii[link] < least:
                least = d - arm.radii[link]
                aim = ahead[link, 0] + at * (ahead[link, 1] - ahead[link, 0])
        least -= radius
        least_of_all = min(least_of_all, least)
        sign = 1.0
        if mode == INTERCEPT:
            lead = 0.5 * min(1.0, max(least, 0.0) / speed)
            aim = links[-1, 1] + lead / dt * (ahead[-1, 1] - links[-1, 1])
        elif mode == CROSSING:
            angle = p + 0.3 * k * dt
            aim = np.array([0.5 * np.cos(angle), 0.5 * np.sin(angle), 0.5])
        wave = np.sin(7.0 * k * dt + p + phase)
        limit = near + speed * (0.15 + 0.1 * np.sin(3.0 * k * dt))
        retreats = (mode == DODGE and not moves) or (mode == RANDOM and wave < -0.3)
        if retreats or (mode == HOVER and least < limit):
            sign = -1.0
        elif mode == NEAR and least < near + 0.02:
            sign = 0.0
        for at in range(2):
            target = home[p, at] if leaves else aim
            gap = target - ends[p, at]
            length = np.sqrt((gap * gap).sum())
            way = speed * dt * (1.0 if leaves else sign)
            way = min(way, length)
            out[p, at] = ends[p, at] + way / max(length, 1e-12) * gap
    return least_of_all


@njit(cache=True)
def judge(arm, q, dq, begun, ended, own, least) -> Any:  # type: ignore
    """Judge one period of one arm: the least distance of links in motion, and of touched ones the
    quickest point [m/s]. Links whose points are slow count as at rest."""
    dt, radius, speed, distance, contact_speed = own
    links = np.empty(arm.ends.shape)
    ahead = np.empty(arm.ends.shape)
    bodies = begun.copy()
    quickest = 0.0
    found = 1e300
    bound = (FASTEST * np.abs(dq).sum() + speed) * dt
    samples = max(1, int(np.ceil(dt / SAMPLE - 1e-9)))
    turns = 0.0
    moves = np.zeros(arm.parents.size, dtype=np.bool_)
    for link in range(moves.size):
        moves[link] = np.abs(dq[: arm.parents[link] + 1]).max() > 0.0
    place(arm, q, links)
    close = False
    for link in range(moves.size):
        for p in range(len(bodies)):
            d = apart(links[link], bodies[p])[0] - arm.radii[link] - radius
            close = close or (moves[link] and d - bound < max(distance, least))
    for s in range(samples + 1 if close else 0):
        f = s / samples
        place(arm, q + f * dt * dq, links)
        if contact_speed > 0.0:
            place(arm, q + (f * dt + 1e-6) * dq, ahead)
        bodies = begun + f * (ended - begun)
        for link in range(moves.size):
            for p in range(len(bodies) if moves[link] else 0):
                d = apart(links[link], bodies[p])[0] - arm.radii[link] - radius
                if contact_speed > 0.0 and d < distance - ROUNDING:
                    turns = np.abs(dq[: arm.parents[link] + 1]).sum()
                    fastest = 0.0
                    for at in range(2):
                        step = ahead[link, at] - links[link, at]
                        fastest = max(fastest, np.sqrt((step * step).sum()) / 1e-6)
                    fastest += turns * arm.radii[link]
                    quickest = max(quickest, fastest)
                    if fastest <= contact_speed * (1.0 + 1e-6):
                        continue
                found = min(found, d)
    return found, quickest


@njit(cache=True)
def play(arm, mode, leaves, q, dq, ends, home, k, of_people, of_judge, least, out) -> None:  # type: ignore
    """Judge and move all arms; `out` (N, 3) has the judged distance, speed, and least distance."""
    for i in range(len(q)):
        begun = ends[i].copy()
        dt, radius, speed, near, phase = of_people
        own = (dt, radius, speed, near, phase + i)
        out[i, 2] = move_people(
            arm, mode[i], leaves[i], q[i], dq[i], begun, home[i], k, own, ends[i]
        )
        out[i, 0] = 1e300
        if np.abs(dq[i]).max() > 0.0:
            found, quickest = judge(arm, q[i], dq[i], begun, ends[i], of_judge, least)
            out[i, 0] = found
            out[i, 1] = quickest


def _unit(v: Any) -> Any:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


class Attack:
    """People who approach N arms, and the frames of a sensor."""

    def __init__(self, scene: Scene, random: Any) -> None:
        self.scene = scene
        self.random = random
        shape = (scene.count, scene.people, 3)
        away = 2.5 if np.isinf(scene.reach) else scene.reach + 0.6
        start = _unit(random.standard_normal(shape))
        start[..., 2] = np.abs(start[..., 2])
        other = away * start + 0.25 * _unit(random.standard_normal(shape))
        self.ends = np.stack([away * start, other], axis=2)
        self.home = self.ends.copy()
        self.mode = np.array(scene.modes)[np.arange(scene.count) % len(scene.modes)]
        self.leaves = np.zeros(scene.count, dtype=bool)
        self.rested = np.zeros(scene.count)
        self.on_way: deque[tuple[int, Any, Any, Any]] = deque()

    def note(self, moves: Any, least: Any) -> None:
        """Leave an arm that rests, and come back to it later; after LEAVE never."""
        scene = self.scene
        self.rested = np.where(moves, 0.0, self.rested + scene.dt)
        self.leaves |= (self.rested > 0.7) & (least < 0.15)
        back = self.leaves & self.have_left(self.ends)
        self.leaves &= ~(back & (self.mode != LEAVE) & (self.random.random(scene.count) < 2e-3))

    def have_left(self, ends: Any) -> Any:
        """Test for each arm whether all bodies with these ends (N, P, 2, 3) [m] are at home."""
        return np.abs(ends - self.home).max(axis=(1, 2, 3)) < 0.05 + self.scene.error

    def look(self, k: int) -> tuple[int, Any, Any, Any] | None:
        """Take a frame if one is due; return the one that arrives: step, ends, seen, arms."""
        scene = self.scene
        if k % scene.every == 0:
            shape = (scene.count, scene.people, 3)
            error = scene.error * _unit(self.random.standard_normal(shape))
            outward = scene.error * _unit(self.ends[:, :, 0])
            first = np.where(self.random.random(shape[:2])[..., None] < 0.5, error, outward)
            other = scene.error * _unit(self.random.standard_normal(shape))
            second = np.where(self.random.random(shape[:2])[..., None] < 0.5, other, first)
            seen = np.ones(shape[:2], dtype=bool)
            for at in np.ndindex(*shape[:2]):
                seen[at] = apart(self.ends[at], np.zeros((2, 3)))[0] - scene.radius <= scene.reach
            came = self.random.random(scene.count) >= scene.lost
            self.on_way.append((k, self.ends + np.stack([first, second], axis=2), seen, came))
        if self.on_way and self.on_way[0][0] + scene.late <= k:
            return self.on_way.popleft()
        return None


def run(scene: Scene, steps: int, seed: int, drive: Any) -> Verdict:
    """Drive N arms for a number of steps and judge each of them.

    `drive(k, q, request, frame)` returns commands (N, n) and whether they differ from requests.
    """
    random = np.random.default_rng(seed)
    robot = scene.robot
    N, n, dt = scene.count, robot.dof, scene.dt
    arm = skeleton_of(robot)
    attack = Attack(scene, random)
    q = np.tile(robot.start_posture(), (N, 1))
    lower, upper = np.maximum(robot.q_lower, -3.0), np.minimum(robot.q_upper, 3.0)
    goal = q.copy()
    request = np.zeros((N, n))
    last = np.zeros((N, n))
    before = np.zeros((N, n))
    touching = np.zeros(N, dtype=bool)
    out = np.zeros((N, 3))
    near = scene.distance + scene.error + scene.speed * (scene.late + scene.every) * dt
    of_people = (dt, scene.radius, scene.speed, near, float(seed))
    of_judge = (dt, scene.radius, scene.speed, scene.distance, scene.contact_speed)
    least, quickest, tip = 1e300, 0.0, 0.0
    contacts = touched = moving = refused = 0
    tail = np.zeros(N)
    told = np.zeros(N, dtype=bool)
    accel, jerk = 0.0, 0.0
    tips = np.empty((2, *arm.ends.shape))
    for k in range(steps):
        if k % max(1, round(0.033 / dt)) == 0:
            new = (random.random(N) < 0.02) | (np.abs(goal - q).max(axis=1) < 0.05)
            drawn = lower + random.uniform(0.05, 0.95, (N, n)) * (upper - lower)
            goal = np.where(new[:, None], drawn, goal)
            gap = goal - q
            most = (np.abs(gap) / robot.dq_max).max(axis=1, keepdims=True)
            request = gap / np.maximum(most, 1e-9) * np.minimum(1.0, 6.0 * most)
        frame = attack.look(k)
        dq, differs = drive(k, q, goal if scene.requests == "position" else request, frame)
        ends, home, leaves = attack.ends, attack.home, attack.leaves
        own = (attack.mode, leaves, q, dq, ends, home, k, of_people, of_judge)
        play(arm, *own, min(least, 1.0), out)
        moves = (dq != 0.0).any(axis=1)
        attack.note(moves, out[:, 2])
        moving += int(moves.sum())
        refused += int(np.sum(differs))
        tail += moves & (k >= 0.75 * steps)
        if frame is not None and k >= 0.75 * steps:
            told |= frame[3] & attack.have_left(frame[1])
        least = min(least, float(out[:, 0].min()))
        quickest = max(quickest, float(out[:, 1].max()))
        hit = out[:, 0] < scene.distance - ROUNDING
        touched += int(hit.sum())
        contacts += int((hit & ~touching).sum())
        touching = hit
        accel = max(accel, float((np.abs(dq - last) / (robot.ddq_max * dt)).max()))
        change = np.abs(dq - 2.0 * last + before)
        jerk = max(jerk, float((change / (robot.dddq_max * dt * dt)).max()))
        for i in range(N):
            place(arm, q[i], tips[0])
            place(arm, q[i] + dt * dq[i], tips[1])
            tip += float(np.linalg.norm(tips[1, -1, 1] - tips[0, -1, 1]))
        before, last, q = last, dq, q + dt * dq
    total = N * steps
    trapped = int((told & (tail == 0.0)).sum())
    of_tail = tail / (steps - int(np.ceil(0.75 * steps)))
    rates = (accel, jerk)
    share = (moving / total, of_tail, trapped, tip / (total * dt))
    return Verdict(total, contacts, touched, least, *share, rates, quickest, refused / total)


def today(scene: Scene) -> Any:
    """Return the drive of shields that know moving obstacles alone: spheres at the ends."""
    grown = scene.radius + scene.error + scene.speed * (scene.late + scene.every + 1) * scene.dt
    velocity = [scene.speed, 0.0, 0.0]
    obstacles = [
        iiwa_dnn.Sphere([3.0 + i, 0.0, 0.5], grown, velocity=velocity)
        for i in range(2 * scene.people)
    ]
    shields = iiwa_dnn.Shields(
        scene.robot,
        scene.count,
        dt=scene.dt,
        obstacles=obstacles,
        distance=scene.distance,
        threads=1,
    )
    seen: list[Any] = [None]

    def drive(k: int, q: Any, request: Any, frame: Any) -> tuple[Any, Any]:
        if frame is not None:
            seen[0] = frame[1].reshape(scene.count, -1, 3)
        command = shields.step(q, request, obstacles=seen[0])
        return command.dq, command.clipped

    return drive


def told(scene: Scene, **settings: Any) -> Any:
    """Return the drive of shields that are told of people by frames, but for the scene's lies."""
    lies = scene.lies
    speed = (0.8 if "speed" in lies else 1.0) * (1e-9 if "still" in lies else 1.0) * scene.speed
    kept: dict[str, Any] = {
        "dt": scene.dt,
        "distance": scene.distance,
        "people": scene.people,
        "field": scene.reach if np.isfinite(scene.reach) and "field" not in lies else 1e3,
        "people_speed": speed,
        "latency": 0.0 if "age" in lies else (scene.late + scene.every) * scene.dt,
        "contact_speed": scene.contact_speed,
        "obstacles": [],
    }
    shield = iiwa_dnn.Shield(scene.robot, **(kept | settings))
    if lies:  # no smooth motion hides them
        shield.limits = tuple(
            replace(part, share=NO_SHARE) if isinstance(part, Separation) else part
            for part in shield.limits
        )
    shields = iiwa_dnn.Shields(shield, scene.count, threads=1)
    radius = scene.radius + (0.0 if "error" in lies else scene.error)
    memory: dict[int, Any] = {}

    def drive(k: int, q: Any, request: Any, frame: Any) -> tuple[Any, Any]:
        people: Any = None
        age = 0.0
        if frame is not None:
            at, ends, seen, came = frame
            age = (k - at) * scene.dt
            people = []
            for own, there, arrived in zip(ends, seen, came, strict=True):
                capsules = np.concatenate([own.reshape(-1, 6), np.full((len(own), 1), radius)], 1)
                people.append(capsules[there] if arrived else None)
        if "missing" in lies and k % 1000 < 500:
            people = [[]] * scene.count
            age = 0.0
        if "age" in lies:
            memory.update({i: own for i, own in enumerate(people or []) if own is not None})
            people = [memory.get(i) for i in range(scene.count)]
            age = 0.0
        command = shields.step(q, **{scene.requests: request}, people=people, age=age)
        return command.dq, command.clipped

    return drive


if __name__ == "__main__":
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
    scene = Scene(robot, 64)
    print(run(scene, int(sys.argv[2]), int(sys.argv[1]), told(scene)).line)
