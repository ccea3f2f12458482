"""The heart under encoder noise, a drive's delay and limits on acceleration and jerk, at 500 Hz.

``python -m benchmarks.encoders`` prints the table of docs/noise.md: with and without the
controller's estimator, over the heart and before a target that rests.
"""

import numpy as np

import iiwa_dnn
from iiwa_dnn.control.estimation import JointEstimator, NoiseModel
from iiwa_dnn.results.markdown import markdown_table

DT = 2e-3
"""Control period [s]."""

NOISE = 1e-4
"""Standard deviation of the encoders' noise [rad]."""

GAIN = 9.5
"""Feedback gain [1/s]; up to 9.8 1/s the loop with these limits is stable."""

ACCELERATION = 10.0
JERK = 100.0
"""Limits of every joint [rad/s^2], [rad/s^3]."""

Q0 = (-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0)

CASES: dict[str, tuple[float, NoiseModel | None]] = {
    "exact encoders": (0.0, None),
    "noise": (NOISE, None),
    "noise, estimator": (NOISE, NoiseModel(velocity=1e-3, measurement=NOISE)),
    "noise, estimator told of the delay": (
        NOISE,
        NoiseModel(velocity=1e-3, measurement=NOISE, delay=1),
    ),
}


def measure(
    reference: iiwa_dnn.Reference, noise: float, model: NoiseModel | None, duration: float
) -> list[str]:
    """Let the arm follow a reference; return the cells of a row of the table."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    robot = robot.with_limits(acceleration=ACCELERATION, jerk=JERK)
    limits = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits())
    scheme = iiwa_dnn.DoubleIndicator(
        position_gain=GAIN, orientation_gain=GAIN, extra_limits=limits
    )
    reference = reference.anchored(iiwa_dnn.Configuration(robot, Q0))
    controller = iiwa_dnn.Controller(robot, scheme, reference, dt=DT)
    estimator = JointEstimator(model or NoiseModel(), DT)
    delay = model.delay if model else 0
    random = np.random.default_rng(0)
    steps = round(duration / DT)
    q = np.array(Q0)
    sent = np.zeros((steps + 2, robot.dof))  # the drives carry out what was sent a period ago
    errors = np.empty(steps)
    slowed = 0
    cannot = 0
    for k in range(steps):
        seen = q + noise * random.standard_normal(robot.dof)
        if model is not None:
            seen = estimator.update(seen)
        command = controller.step(seen, (k + delay) * DT)
        if model is not None:
            estimator.predict(command.dq)
        slowed += not command.ok
        cannot += not (command.ok or command.limited)
        sent[k + 2] = command.dq
        q = q + DT * sent[k + 1]
        wanted = reference.at((k + 1) * DT).position
        errors[k] = np.linalg.norm(iiwa_dnn.Configuration(robot, q).position - wanted)
    jerk = np.diff(sent, 2, axis=0) / DT**2
    late = errors[steps // 10 :]
    return [
        f"{late.max():.2e}",
        f"{np.sqrt(np.mean(late**2)):.2e}",
        f"{slowed:,} of {steps:,}",
        f"{cannot:,}",
        f"{controller.delay:.4f}",
        f"{np.sqrt(np.mean(jerk**2)):.1f}",
    ]


def main() -> None:
    """Measure all cases and print the table."""
    references: dict[str, tuple[iiwa_dnn.Reference, float]] = {
        "heart": (iiwa_dnn.Heart(period=10.0), 10.0),
        "rest": (iiwa_dnn.Still(), 5.0),
    }
    rows = [
        [path, case, *measure(reference, noise, model, duration)]
        for path, (reference, duration) in references.items()
        for case, (noise, model) in CASES.items()
    ]
    head = ["path", "case", "largest error m", "mean error m", "steps not ok"]
    print(markdown_table([*head, "neither", "delay s", "jerk rad/s³"], rows))


if __name__ == "__main__":
    main()
