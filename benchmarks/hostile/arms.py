"""Arms as data, and their kinematics and torques in numpy, for all samples of a path at once."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FOLDER = Path(__file__).with_name("arms")
"""A JSON file for each arm; benchmarks/write_arms.py writes them."""

GRAVITY = np.array([0.0, 0.0, -9.81])  # [m/s^2]


class Places(NamedTuple):
    """Where the n joints of an arm are at k samples: (n, k, 3, 3) and (n, k, 3) [m]."""

    rotations: Array
    origins: Array


class Arm:
    """An arm of n revolute joints, as its file describes it.

    Attributes:
        data: The file's content; a contender gets it too.
        dof: Number of joints n.
        limits: Rows lower, upper [rad], velocity, acceleration, jerk [rad/s^k], torque [N m].
        start: Joint positions at the start [rad], (n,).
    """

    def __init__(self, name: str) -> None:
        """Read the arm's file."""
        self.data: dict[str, Any] = json.loads((FOLDER / f"{name}.json").read_text("utf-8"))
        joints = self.data["joints"]
        self.dof = len(joints)
        rows = ("lower", "upper", "velocity", "acceleration", "jerk", "torque")
        self.limits = np.array([[joint[row] for joint in joints] for row in rows])
        self.start = np.array(self.data["start"])
        for row in ("origin", "turn", "axis", "mass", "center", "inertia"):
            setattr(self, f"_{row}", np.array([joint[row] for joint in joints]))
        capsules = self.data["capsules"]
        self._of = np.array([capsule["joint"] for capsule in capsules])
        self._ends = np.array([[capsule["a"], capsule["b"]] for capsule in capsules])
        self._radii = np.array([capsule["radius"] for capsule in capsules])

    def places(self, q: Array) -> Places:
        """Compute where the joints are at joint positions (k, n) [rad]."""
        turn = np.broadcast_to(np.eye(3), (len(q), 3, 3))
        place = np.zeros((len(q), 3))
        rotations, origins = [], []
        for i in range(self.dof):
            place = place + turn @ self._origin[i]
            turn = turn @ self._turn[i] @ _spin(self._axis[i], q[:, i])
            rotations.append(turn)
            origins.append(place)
        return Places(np.array(rotations), np.array(origins))

    def tip(self, q: Array) -> Array:
        """Compute the position of the tip [m], (k, 3), at joint positions (k, n) [rad]."""
        at = self.places(q)
        place: Array = at.origins[-1] + at.rotations[-1] @ np.array(self.data["tip"])
        return place

    def distances(self, q: Array, centers: Array, radii: Array) -> Array:
        """Compute the distances (k, c, s) [m] of c capsules from s spheres.

        Args:
            q: Joint positions [rad], (k, n).
            centers: Of the spheres at each sample [m], (k, s, 3).
            radii: Of the spheres [m], (s,).
        """
        at = self.places(q)
        found = np.empty((len(q), len(self._of), len(radii)))
        for c, joint in enumerate(self._of):
            a, b = (at.origins[joint] + at.rotations[joint] @ end for end in self._ends[c])
            along = (b - a)[:, np.newaxis]
            length = np.maximum((along**2).sum(-1), 1e-12)
            from_a = centers - a[:, np.newaxis]
            t = np.clip((from_a * along).sum(-1) / length, 0.0, 1.0)
            gap = np.linalg.norm(from_a - t[..., np.newaxis] * along, axis=-1)
            found[:, c] = gap - radii - self._radii[c]
        return found

    def moving(self, dq: Array) -> Array:
        """Bound the speed of each capsule's points [m/s], (k, c), by the joints below it."""
        below = np.cumsum(np.abs(dq), axis=1)[:, self._of]
        reach: float = self.data["reach"]
        return reach * below

    def torques(self, q: Array, dq: Array, ddq: Array, payload: float) -> Array:
        """Compute joint torques [N m], (k, n), with a point mass at the tip [kg] (Newton-Euler)."""
        at = self.places(q)
        axes = [at.rotations[i] @ self._axis[i] for i in range(self.dof)]
        turning = np.zeros((len(q), 3))
        change = np.zeros((len(q), 3))
        rate = np.tile(-GRAVITY, (len(q), 1))
        arms, forces, moments = [], [], []
        before = np.zeros((len(q), 3))
        for i, axis in enumerate(axes):
            arm = at.origins[i] - before
            before = at.origins[i]
            rate = rate + np.cross(change, arm) + np.cross(turning, np.cross(turning, arm))
            spin = axis * dq[:, i : i + 1]
            change = change + axis * ddq[:, i : i + 1] + np.cross(turning, spin)
            turning = turning + spin
            mass, center = self._mass[i], self._center[i]
            inertia = self._inertia[i]
            if i == self.dof - 1 and payload > 0.0:
                mass, center, inertia = _with_payload(
                    mass, center, inertia, payload, self.data["tip"]
                )
            turn = at.rotations[i]
            lever = turn @ center
            about = turn @ inertia @ turn.transpose(0, 2, 1)
            falls = rate + np.cross(change, lever) + np.cross(turning, np.cross(turning, lever))
            whirl = (about @ turning[..., np.newaxis])[..., 0]
            forces.append(mass * falls)
            moment = (about @ change[..., np.newaxis])[..., 0] + np.cross(turning, whirl)
            moments.append(moment + np.cross(lever, forces[-1]))
            arms.append(arm)
        torques = np.empty(q.shape)
        force = np.zeros((len(q), 3))
        moment = np.zeros((len(q), 3))
        for i in reversed(range(self.dof)):
            if i < self.dof - 1:
                moment = moment + np.cross(arms[i + 1], force)
            force = force + forces[i]
            moment = moment + moments[i]
            torques[:, i] = (axes[i] * moment).sum(-1)
        return torques


def _spin(axis: Array, angle: Array) -> Array:
    """Return the rotations (k, 3, 3) about an axis (3,) by angles (k,) [rad] (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned = np.sin(angle)[:, np.newaxis, np.newaxis] * cross
    rest: Array = np.eye(3) + turned + (1.0 - np.cos(angle))[:, None, None] * (cross @ cross)
    return rest


def _with_payload(
    mass: float, center: Array, inertia: Array, payload: float, at: list[float]
) -> tuple[float, Array, Array]:
    """Add a point mass to a body: its mass, centre and inertia about the new centre."""
    whole = mass + payload
    common = (mass * center + payload * np.array(at)) / whole
    for part, place in ((mass, center), (payload, np.array(at))):
        off = place - common
        inertia = inertia + part * (off @ off * np.eye(3) - np.outer(off, off))
    return whole, common, inertia


def urdf(data: dict[str, Any]) -> str:
    """Write an arm's data as a URDF, for contenders that read one."""
    links = ['<robot name="arm"><link name="link0"/>']
    for i, joint in enumerate(data["joints"], 1):
        inertia = np.array(joint["inertia"])
        names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        entries = inertia[np.triu_indices(3)]
        about = " ".join(
            f'{name}="{float(value)!r}"' for name, value in zip(names, entries, strict=True)
        )
        links.append(
            f'<link name="link{i}"><inertial><origin xyz="{_words(joint["center"])}"/>'
            f'<mass value="{joint["mass"]}"/><inertia {about}/></inertial></link>'
            f'<joint name="{joint["name"]}" type="revolute"><parent link="link{i - 1}"/>'
            f'<child link="link{i}"/><origin xyz="{_words(joint["origin"])}" '
            f'rpy="{_words(_rpy(np.array(joint["turn"])))}"/><axis xyz="{_words(joint["axis"])}"/>'
            f'<limit lower="{joint["lower"]}" upper="{joint["upper"]}" '
            f'velocity="{joint["velocity"]}" effort="{joint["torque"]}" '
            f'acceleration="{joint["acceleration"]}" jerk="{joint["jerk"]}"/></joint>'
        )
    last = len(data["joints"])
    links.append(
        f'<link name="tip"/><joint name="to_tip" type="fixed"><parent link="link{last}"/>'
        f'<child link="tip"/><origin xyz="{_words(data["tip"])}"/></joint></robot>'
    )
    return "".join(links)


def _words(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)


def _rpy(turn: Array) -> tuple[float, float, float]:
    """Return roll, pitch and yaw [rad] of a rotation (3, 3), as a URDF has them."""
    pitch = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    if np.hypot(turn[0, 0], turn[1, 0]) < 1e-9:
        return 0.0, float(pitch), float(np.arctan2(-turn[0, 1], turn[1, 1]))
    return (
        float(np.arctan2(turn[2, 1], turn[2, 2])),
        float(pitch),
        float(np.arctan2(turn[1, 0], turn[0, 0])),
    )
