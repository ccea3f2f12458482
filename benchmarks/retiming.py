"""Path times: through `retime`, and of the policy `slow` alone, beside toppra's optimum.

    python -m benchmarks.retiming

`slow` alone keeps the velocity limits and has no look-ahead: the reference asks for more than the
arm can do all along, and the time is that at which its clock has gone round. Its accelerations are
what they are; the optimum beside it is that of the velocity limits alone.
"""

import numpy as np

import iiwa_dnn
from iiwa_dnn import Circle, Heart, Line, Lissajous, Reference, Tilting
from iiwa_dnn.results.markdown import markdown_table

ACCELERATION = np.array([8.65, 5.44, 5.69, 11.01, 11.78, 13.76, 13.17])
"""Drake's, derived for the iiwa 7; KUKA publishes none [rad/s^2]."""

DT = 1e-3  # [s]
HURRY = 0.2  # period that nobody can follow [s]
UNLIMITED = 1e4  # [rad/s^2]


def paths(period: float) -> dict[str, Reference]:
    """Five closed paths that take a period [s]."""
    return {
        "heart": Heart(period=period),
        "circle": Circle(period=period),
        "line, there and back": Line(period=period),
        "figure of eight": Lissajous(period=period),
        "tilting circle": Tilting(Circle(period=period)),
    }


def main() -> None:
    """Print the table."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    q0 = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q0)
    scheme = iiwa_dnn.DoubleIndicator(tracking="next")
    rows = []
    for (name, calm), hurried in zip(paths(10.0).items(), paths(HURRY).values(), strict=True):
        unchecked = {"check": iiwa_dnn.CrossCheck(()), "dt": DT}
        record = iiwa_dnn.simulate(robot, scheme, calm.anchored(start), q0, **unchecked)
        timed = iiwa_dnn.retime(record, ACCELERATION, points=500)
        best = iiwa_dnn.retime(record, ACCELERATION, points=2000, dt=1e-4)
        bare = iiwa_dnn.retime(record, UNLIMITED, points=2000, dt=1e-4)
        slow = iiwa_dnn.simulate(
            robot, scheme, hurried.anchored(start), q0, duration=4.0, **unchecked
        )
        share = np.ones(slow.steps) if slow.fraction is None else slow.fraction
        rounds = int(np.searchsorted(np.cumsum(share) * DT, HURRY - 1e-9)) + 1
        jumps = np.diff(slow.dq[:rounds], axis=0, prepend=0.0) / DT
        rows.append(
            (
                name,
                f"{best.t[-1]:.3f}",
                f"{timed.t[-1]:.3f}",
                f"{np.abs(timed.ddq / ACCELERATION).max():.3f}",
                f"{bare.t[-1]:.3f}",
                f"{rounds * DT:.3f}",
                f"{np.abs(jumps / ACCELERATION).max():.0f}",
            )
        )
    head = (
        "path",
        "optimum s",
        "`retime` s",
        "of the acceleration limit",
        "optimum of the velocity limits s",
        "`slow` alone s",
        "times the acceleration limit",
    )
    print(markdown_table(head, rows))


if __name__ == "__main__":
    main()
