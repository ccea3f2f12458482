"""Ranges of the ablation's unstable rows: the same run from starts that differ by 1e-12 rad.

``python -m benchmarks.ablation_ranges`` prints the rows of docs/paper.md, in about two minutes.
"""

import numpy as np

from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, total_variation

UNSTABLE = (("block", 1), ("block", 2), ("block", 4), ("block", 7), ("so3", 1), ("so3", 2))
STARTS = 10  # the first is the paper's own
PERTURBATION = 1e-12  # [rad]


def main() -> None:
    """Print largest errors, drift, total variation and kinetic index of each row."""
    rng = np.random.default_rng(0)
    start = paper.START
    for orientation, substeps in UNSTABLE:
        rows = []
        for i in range(STARTS):
            shift = PERTURBATION * rng.standard_normal(7) if i else np.zeros(7)
            paper.START = tuple((np.array(start) + shift).tolist())  # of scheme and path alike
            record = HeartRun(orientation=orientation, substeps=substeps).run()
            values = compute_metrics(record)
            names = ("max_position_error_m", "max_orientation_error_rad", "joint_drift_rad")
            rows.append([*map(values.get, names), total_variation(record)])
            rows[-1].append(values["max_kinetic_index"])
        ends = zip(np.min(rows, axis=0), np.max(rows, axis=0), strict=True)
        cells = (" – ".join(dict.fromkeys((f"{low:.3g}", f"{high:.3g}"))) for low, high in ends)
        print(f"| {orientation} | none | {substeps} | no | {' | '.join(cells)} |", flush=True)
    paper.START = start


if __name__ == "__main__":
    main()
