"""State of a motion that is kept from one control step to the next."""

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Vector


class MotionState(Record):
    """State of the motion of n joints, kept from one control step to the next.

    Attributes:
        stopping_periods: Control periods that the stored stopping motion takes from the last
            command to rest; 0 if no stopping motion is stored.
        path_lag: Time by which the reference's clock is behind the time of the loop [s].
        spacing: Period by which `last` - `before` is divided for the acceleration [s]; 0 before
            the first step.
        yields: Whether a policy replaced the nominal program at the last step.
        halts: Whether the arm brakes at this step, even if the nominal program has a solution.
        q: Joint positions of the step [rad], (n,).
        last: Last command [rad/s], (n,).
        before: Command before the last one [rad/s], (n,).
        wanted: Answer of the last fallback program, before rate limits [rad/s], (n,).
        least: Distance that each watched pair has to keep [m], (pairs,); 0 before the first step.
    """

    stopping_periods: float
    path_lag: float
    spacing: float
    yields: bool
    halts: bool
    q: Vector = part("joints")
    last: Vector = part("joints")
    before: Vector = part("joints")
    wanted: Vector = part("joints")
    least: Vector = part("pairs")


@compiled
def change_spacing(motion: MotionState, dt: float) -> None:
    """Convert the state to a control period of dt [s]; acceleration and time to rest stay.

    Overwrites `before`, `stopping_periods` and `spacing`; before the first step only `spacing`.
    """
    if motion.spacing > 0.0 and dt != motion.spacing:
        ratio = dt / motion.spacing
        for i in range(motion.last.size):
            motion.before[i] = motion.last[i] - ratio * (motion.last[i] - motion.before[i])
        motion.stopping_periods = motion.stopping_periods / ratio
    motion.spacing = dt


@compiled
def count_as_sent(motion: MotionState, dq: Vector, dt: float) -> None:
    """Write a velocity dq (n,) [rad/s] to `last`, and the last command to `before`.

    Sets `stopping_periods` to 0, and `spacing` to dt [s] if it is 0.
    """
    for i in range(motion.last.size):
        motion.before[i] = motion.last[i]
        motion.last[i] = dq[i]
    motion.stopping_periods = 0.0
    motion.spacing = motion.spacing if motion.spacing > 0.0 else dt
