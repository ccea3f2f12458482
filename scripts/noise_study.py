"""Compare what helps against noise and other disturbances; see --help."""

import sys

from iiwa_dnn.noise_cli import study_noise

if __name__ == "__main__":
    sys.exit(study_noise())
