"""A sweep over the weight xi of the paper's scheme, with a figure.

One sees what xi trades: towards xi = 1 the joints are a hundred times further from where they began
when the heart is closed (joint drift), for a kinetic index that is smaller by 0.02 %.
Finished cells are kept in the folder, so that a sweep that was cut short goes on.
"""

import sys
from pathlib import Path

import tyro
from matplotlib.figure import Figure

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.studies.sweeps import sweep

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]
WEIGHTS = (0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 1.0)


def heart(cell):
    """Draw one heart, every step checked; a worker process runs this."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    reference = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, START))
    scheme = iiwa_dnn.DoubleIndicator(weight=cell["weight"])
    record = iiwa_dnn.simulate(robot, scheme, reference, START, dt=cell["dt"])
    values = iiwa_dnn.compute_metrics(record)
    return {
        "joint_drift_rad": values["joint_drift_rad"],
        "mean_kinetic_index": float(record.kinetic_index.mean()),
        "failures": iiwa_dnn.failures(record),
    }


def main(
    folder: tyro.conf.Positional[str] = "runs/sweep_weight", dt: tyro.conf.Positional[float] = 1e-2
):
    """Run the sweep on every core and write weight.png; 1 where a run failed."""
    cells = [{"weight": weight, "dt": dt} for weight in WEIGHTS]
    outcomes = sweep(heart, cells, Path(folder))
    drift = [values["joint_drift_rad"] for values in outcomes]
    index = [values["mean_kinetic_index"] for values in outcomes]
    figure = Figure(figsize=(5, 4), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    upper.semilogy(WEIGHTS, drift, "o-")
    lower.plot(WEIGHTS, [1e3 * value for value in index], "s-", color="C1")
    lower.ticklabel_format(useOffset=False)
    upper.set_ylabel("joint drift [rad]")
    lower.set_ylabel("mean kinetic index\n[10$^{-3}$ rad$^2$/s$^2$]")
    lower.set_xlabel(r"weight $\xi$")
    figure.savefig(Path(folder) / "weight.png", dpi=150)
    for weight, shift, energy in zip(WEIGHTS, drift, index, strict=True):
        print(f"weight {weight}: joint drift {shift:.2e} rad, kinetic index {energy:.6e} rad^2/s^2")
    return int(any(values["failures"] for values in outcomes))


if __name__ == "__main__":
    sys.exit(run_script(main))
