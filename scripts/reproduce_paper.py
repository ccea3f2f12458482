"""Run every experiment of the paper and put each number beside the paper's; see --help."""

import sys

from iiwa_dnn.paper_cli import reproduce_paper

if __name__ == "__main__":
    sys.exit(reproduce_paper())
