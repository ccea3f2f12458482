"""Hostile steps of many arms on two devices: ``python tests/hostile_arms.py ARMS STEPS``."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import iiwa_dnn

DT = 1e-3
ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
BALL = iiwa_dnn.Sphere([0.36, 0.16, 0.64], 0.05)
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])


def make_shield(with_obstacles: bool = True) -> iiwa_dnn.Shield:
    """Return the shield of an arm beside a ball and itself, or of one that watches nothing."""
    return iiwa_dnn.Shield(ROBOT, DT, [BALL] if with_obstacles else (), timeout=0.02)


def hostile_steps(q: Any, steps: int, seed: int) -> Iterator[dict[str, Any]]:
    """Draw arguments of `Shields.step` for N arms whose joint positions q (N, n) are kept up.

    Velocities, twists and positions jump, change their signs, are held, fall silent, or are no
    numbers; so are a few of the measured positions, but the first.
    """
    random = np.random.default_rng(seed)
    count, dof = q.shape
    kinds = ("dq", "twist", "position")
    for k in range(steps):
        if k % 25 == 0:
            kind = kinds[k // 25 % 3]
            shape = (count, 6 if kind == "twist" else dof)
            request = random.standard_normal(shape) * random.choice([0.1, 1.0, 10.0], (count, 1))
            if kind == "position":
                request = q + 0.2 * request
        if k % 7 == 3:
            request = -request if kind != "position" else request
        asked = request.copy()
        asked[random.random(count) < 0.002] = np.nan
        measured = q.copy()
        measured[random.random(count) < 0.002 * (k > 0), 0] = np.inf
        silent = random.random(count) < (0.9 if k // 50 % 4 == 3 else 0.05)
        yield {"q": measured, kind: asked, "given": ~silent}


def compare(
    cpu: Any, gpu: Any, steps: int, put: Callable[[Any], Any], get: Callable[[Any], Any]
) -> tuple[int, Any]:
    """Drive arms on both devices in closed loop.

    Args:
        cpu: Shields on the CPU.
        gpu: As many on the GPU.
        steps: Number of steps.
        put: Copies an array to the GPU.
        get: Copies one back.

    Returns:
        Number of commands that differ in a bit, a position, a flag or a reason, and the joint
        positions [rad], (steps + 1, N, n).
    """
    q = np.tile(START, (cpu.count, 1))
    path = [q.copy()]
    differing = 0
    for own in hostile_steps(q, steps, 0):
        expected = cpu.step(**own)
        found = gpu.step(**{name: put(value) for name, value in own.items()})
        differs = np.zeros(cpu.count, dtype=bool)
        for a, b in zip(expected[:4], map(get, found[:4]), strict=True):
            pair = [each.reshape(cpu.count, -1).view(np.uint8) for each in (a, b)]
            differs |= (pair[0] != pair[1]).any(axis=1)
        differing += int(differs.sum())
        q[:] = expected.next_q
        path.append(q.copy())
    return differing, np.array(path)


def main() -> int:
    """Compare arms of a grid on the CPU with single shields."""
    from helpers_cuda import on_grid, to_device

    count, steps = map(int, sys.argv[1:3])
    with tempfile.TemporaryDirectory() as folder:
        shields_of = on_grid(make_shield(), Path(folder), "-O2")
        shields = shields_of(count), shields_of(count, device="cuda")
        differing, path = compare(*shields, steps, to_device, np.array)
    print(f"{count} arms, {steps} steps: {differing} commands differ")
    return differing + (np.ptp(path) == 0.0)


if __name__ == "__main__":
    sys.exit(main())
