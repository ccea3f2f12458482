"""``python tests/adversarial.py STEPS``: arms driven by hostile targets, every step judged.

Each of iiwa7, panda and xarm7 takes its share of the steps at 1 kHz towards each kind of target of
`targets`, raw and through the filter, with limits on acceleration alone and with limits
on jerk too. The judge of tests/judge_limits.py takes finite differences of the joint positions.
"""

import itertools
import sys

import numpy as np

import iiwa_dnn
from judge_limits import breaches
from targets import STREAMS, drive, longest_freeze, scheme

DT = 1e-3
PIECE = 10_000
JERKS: dict[str, float | None] = {"iiwa7": 500.0, "panda": None, "xarm7": 1000.0}
"""Limits beside the robots' own [rad/s^3]; xarm7's accelerations are taken as 10 rad/s^2."""


def main(steps: int) -> int:
    """Take so many steps and print a line for each piece; returns 1 where a limit is broken."""
    done = 0
    bad = 0
    freeze = 0.0
    room = np.inf
    pieces = 0
    for seed in itertools.count():
        for name, (kind, stream), jerky, filtered in itertools.product(
            JERKS, STREAMS.items(), (False, True), (False, True)
        ):
            if done >= steps:
                print(
                    f"{done} steps, {pieces} pieces, {bad} broken limits, bounds at least "
                    f"{room:.3g} rad/s apart, longest freeze {freeze:.3g} s"
                )
                return int(bad > 0)
            robot = iiwa_dnn.load_robot(name)
            if np.isinf(robot.ddq_max).any():
                robot = robot.with_limits(acceleration=10.0)
            jerk = JERKS[name] if JERKS[name] is not None else robot.dddq_max
            rng = np.random.default_rng([seed, pieces])
            q0 = robot.start_posture()
            limits = scheme(jerk if jerky else None)
            poses = stream(robot, rng, PIECE, DT)
            driven = drive(robot, limits, poses, PIECE, DT, q0, filtered)
            found = breaches(
                driven.q,
                DT,
                robot.q_lower,
                robot.q_upper,
                robot.dq_max,
                robot.ddq_max,
                jerk if jerky else np.inf,
            )
            done += PIECE
            bad += len(found)
            pieces += 1
            frozen, end = longest_freeze(driven, DT)
            room = min(room, driven.room)
            freeze = max(freeze, frozen)
            at_limit = np.minimum(driven.q[end] - robot.q_lower, robot.q_upper - driven.q[end])
            joints = (np.flatnonzero(at_limit < 1e-3) + 1).tolist()
            actions = np.bincount(driven.actions, minlength=6).tolist()
            limit = "jerk" if jerky else "acceleration"
            stood = f"freeze {frozen:.2f} s" + (f", joints {joints} at limits" if frozen else "")
            print(
                name,
                kind,
                limit,
                "filtered" if filtered else "raw",
                actions,
                stood,
                f"error {np.median(driven.filtered):.1e} m",
                found,
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
