"""Draw the paper's heart with an arm that has masses and motors, in MuJoCo; see --help."""

import sys

from iiwa_dnn.physics_cli import simulate_physics

if __name__ == "__main__":
    sys.exit(simulate_physics())
