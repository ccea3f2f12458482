"""Replay a run in the browser, or drive the arm live; see --help."""

import sys

from iiwa_dnn.view_cli import view

if __name__ == "__main__":
    sys.exit(view())
