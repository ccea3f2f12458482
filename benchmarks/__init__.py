"""Programs to measure solvers with, and the measurements: read by scripts, not by the package."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent.parent / "tests"))  # the judges and their cases
