"""Measure the control loop beside Pink's, its start-up and its memory; see --help."""

import sys

from iiwa_dnn.benchmarks.loop_cli import bench_loop

if __name__ == "__main__":
    sys.exit(bench_loop())
