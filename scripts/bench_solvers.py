"""Measure the network as a QP solver beside DAQP, quadprog, PIQP, ProxQP and OSQP; see --help."""

import sys

from iiwa_dnn.benchmarks.cli import bench_solvers

if __name__ == "__main__":
    sys.exit(bench_solvers())
