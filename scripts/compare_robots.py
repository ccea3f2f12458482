"""Draw the heart with every arm that is known by name, and write the table of docs/robots.md."""

import sys
from pathlib import Path

from iiwa_dnn import (
    Configuration,
    CrossCheck,
    DoubleIndicator,
    Heart,
    compute_metrics,
    failures,
    load_robot,
    simulate,
)
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.files import prepare_folder, write_text
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.studies import paper

OUT = Path("runs/robots")
DT = 1e-3
HEAD = (
    "arm",
    "joints",
    "task",
    "redundancy",
    "largest position error [m]",
    "joint drift [rad]",
    "largest gap to ProxQP [rad/s]",
    "time per step [µs]",
    "verdict",
)


def main() -> int:
    """Draw, print and write; 1 if a run failed."""
    folder = prepare_folder(OUT)
    rows = []
    failed = 0
    for name in ("iiwa7", *ARMS):
        start = load_robot(name).start_posture()
        for task, orientation, size in (("pose", "so3", 6), ("position", "none", 3)):
            row, reasons = draw(name, start, orientation)
            failed += bool(reasons)
            dof = len(start)
            rows.append((name, str(dof), task, str(dof - size), *row, reasons or "all agree"))
            print("  ".join(rows[-1]), flush=True)
    text = f"Heart of 10 s at {DT:g} s, Euler; each step checked by ProxQP, timed without it."
    write_text(folder / "report.md", f"{text}\n\n{markdown_table(HEAD, rows)}\n")
    print(f"written to {folder / 'report.md'}")
    return 1 if failed else 0


def draw(name, start, orientation):
    """Numbers of one heart as the table shows them, and what failed."""
    robot = load_robot(name)
    if name == "iiwa7":
        robot = robot.with_limits(lower=-paper.JOINT_LIMIT, upper=paper.JOINT_LIMIT)
    reference = Heart().anchored(Configuration(robot, start))
    scheme = DoubleIndicator(orientation=orientation)
    checked = simulate(robot, scheme, reference, start, dt=DT)
    timed = simulate(robot, scheme, reference, start, dt=DT, check=CrossCheck(()))
    values = compute_metrics(checked)
    per_step = compute_metrics(timed)["wall_time_s"] / timed.steps
    numbers = (
        f"{values['max_position_error_m']:.2e}",
        f"{values['joint_drift_rad']:.2e}",
        f"{values['crosscheck']['max_solution_gap']:.2e}",
        f"{1e6 * per_step:.0f}",
    )
    return numbers, "; ".join(failures(checked))


if __name__ == "__main__":
    sys.exit(run_script(main))
