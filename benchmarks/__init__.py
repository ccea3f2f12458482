"""Programs to measure solvers with, and the measurements: read by scripts, not by the package."""
