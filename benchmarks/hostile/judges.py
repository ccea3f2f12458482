"""What a run is worth: limits, distances, torques, lag; all from the path, in numpy."""

from typing import NamedTuple

import numpy as np

from benchmarks.hostile.arms import Arm, Array

ROUNDING = 1e-4
"""Relative excess over a limit of rates, and over one of positions [rad], that counts as broken: a
solver's tolerance costs less."""

DISTANCE = 0.02
"""Distance to keep from spheres [m]; from a person it is to be at rest when it touches."""

AT_REST = 1e-3
"""Speed of a point that counts as at rest [m/s]."""

LONGEST_LAG = 0.5  # [s]

SILENCE = 0.6
CREEP = 0.01
"""Time without a request after which an arm is to be at rest [s], and the part of a velocity limit
up to which it is."""


class Run(NamedTuple):
    """A run of k steps of n joints.

    Attributes:
        q: Joint positions at the steps [rad], (k + 1, n).
        dq: Velocities that were carried out [rad/s], (k, n).
        wanted: Velocities that were asked for, within their limits [rad/s], (k, n); or NaN.
        desired: Positions of an admissible motion [rad], (k + 1, n), or of size 0.
        periods: Control periods [s], (k,).
        centers: Of spheres, or of the person, at the steps [m], (k + 1, s, 3).
        radii: Their radii [m], (s,).
        seconds: Time of each call [s], (k,).
        problem: Why the contender stopped answering; "" if it did not.
    """

    q: Array
    dq: Array
    wanted: Array
    desired: Array
    periods: Array
    centers: Array
    radii: Array
    seconds: Array
    problem: str


class Score(NamedTuple):
    """Scores of a run; a ratio above 1 is a limit that is broken.

    Attributes:
        position: Largest excess over a position limit [rad].
        velocity: Largest part of a velocity limit.
        acceleration: Largest part of an acceleration limit.
        jerk: Largest part of a jerk limit.
        torque: Largest part of a torque limit.
        nearest: Least distance from a sphere [m]; inf without any.
        contacts: Steps in which a capsule moves while a person touches it.
        unasked: Steps in which the arm moves though nothing has been asked for `SILENCE`.
        lag: Time by which an admissible motion is late [ms]; NaN for others.
        amplitude: Part of its amplitude that is left, at that lag.
        error: Root of its mean squared error at no lag [mrad].
        away: Mean distance from the requested velocities, as a part of the velocity limits.
        frozen: Share of steps at rest while something is asked for.
        p50: Median of the time of a call [us].
        p99: Its 99th percentile [us].
        problem: As of `Run`.
    """

    position: float
    velocity: float
    acceleration: float
    jerk: float
    torque: float
    nearest: float
    contacts: int
    unasked: int
    lag: float
    amplitude: float
    error: float
    away: float
    frozen: float
    p50: float
    p99: float
    problem: str

    def broken(self, has_person: bool, has_payload: bool) -> list[str]:
        """Name what is broken."""
        found = ["position"] * (self.position > ROUNDING)
        for name in ("velocity", "acceleration", "jerk"):
            found += [name] * (getattr(self, name) > 1.0 + ROUNDING)
        found += ["torque"] * (has_payload and self.torque > 1.0 + ROUNDING)
        found += ["distance"] * (not has_person and self.nearest < DISTANCE - ROUNDING)
        found += ["contact"] * (self.contacts > 0)
        found += ["unasked motion"] * (self.unasked > 0)
        return found + ["no answer"] * bool(self.problem)


def judge(arm: Arm, run: Run, has_person: bool, payload: float) -> Score:
    """Judge a run."""
    lower, upper, velocity, acceleration, jerk, torque = arm.limits
    dt = run.periods[:, np.newaxis]
    ddq = np.diff(run.dq, axis=0, prepend=np.zeros((1, arm.dof))) / dt
    dddq = np.diff(ddq, axis=0, prepend=np.zeros((1, arm.dof))) / dt
    before = np.vstack([np.zeros((1, arm.dof)), run.dq[:-1]])
    needed = arm.torques(run.q[:-1], before, ddq, payload)
    nearest, contacts = np.inf, 0
    if run.radii.size:
        gaps = arm.distances(run.q, run.centers, run.radii)
        halves = [0.5 * (each[1:] + each[:-1]) for each in (run.q, run.centers)]
        between = arm.distances(halves[0], halves[1], run.radii)
        nearest = float(min(gaps.min(), between.min(initial=np.inf)))
        if has_person:
            touching = gaps[:-1].min(axis=-1) <= 0.0
            contacts = int((touching & (arm.moving(run.dq) > AT_REST)).any(axis=1).sum())
    lag, amplitude, error = (
        follows(run) if run.desired.size and not run.problem else (np.nan, np.nan, np.nan)
    )
    asked = np.isfinite(run.wanted).all(axis=1)
    away = np.abs(run.dq - run.wanted)[asked] / velocity
    moving = asked & (np.abs(np.nan_to_num(run.wanted)) > 0.02 * velocity).any(axis=1)
    still = (np.abs(run.dq) < 1e-4 * velocity).all(axis=1)
    time = np.cumsum(run.periods)
    heard = np.maximum.accumulate(np.where(asked, time, 0.0))
    creeps = (np.abs(run.dq) > CREEP * velocity).any(axis=1)
    unasked = int((creeps & (time - heard > SILENCE)).sum())
    return Score(
        float(np.maximum(run.q - upper, lower - run.q).max()),
        float((np.abs(run.dq) / velocity).max()),
        float((np.abs(ddq) / acceleration).max()),
        float((np.abs(dddq) / jerk).max()),
        float((np.abs(needed) / torque).max()),
        nearest,
        contacts,
        unasked,
        lag,
        amplitude,
        error,
        float(away.mean()) if away.size else np.nan,
        float(still[moving].mean()) if moving.any() else 0.0,
        1e6 * float(np.median(run.seconds)),
        1e6 * float(np.quantile(run.seconds, 0.99)),
        run.problem,
    )


def follows(run: Run) -> tuple[float, float, float]:
    """Return lag [ms], amplitude and error [mrad] of a path that ought to be `run.desired`.

    The lag is the shift, between samples too, at which the path is most like it; the amplitude
    is that of the least squares there.
    """
    dt = float(run.periods.mean())
    most = min(int(LONGEST_LAG / dt), len(run.q) // 2)
    given = _swing(run.q[most:])
    errors = np.array(
        [_unlike(given, _swing(run.desired[most - k : len(run.q) - k])) for k in range(most)]
    )
    best = int(errors.argmin())
    shift = 0.0
    if 0 < best < most - 1:
        low, mid, high = errors[best - 1 : best + 2]
        shift = 0.5 * (low - high) / max(low - 2.0 * mid + high, 1e-300)
    late = _swing(run.desired[most - best : len(run.q) - best])
    amplitude = float((given * late).sum() / max((late**2).sum(), 1e-300))
    whole = np.sqrt(np.mean((run.q - run.desired) ** 2))
    return 1e3 * dt * (best + shift), amplitude, 1e3 * float(whole)


def _swing(q: Array) -> Array:
    """Return positions (k, n) without their mean."""
    return q - q.mean(axis=0)


def _unlike(a: Array, b: Array) -> float:
    """Return 1 less the correlation of two swings (k, n), whatever their amplitudes."""
    return 1.0 - float((a * b).sum() / max(np.linalg.norm(a) * np.linalg.norm(b), 1e-300))
