"""Draw the paper's heart with the KUKA LBR iiwa 7 R800, every step checked; see --help.

As in the paper, all joints have position limits of 2.5 rad, accelerations and jerks none.
"""

import sys

from iiwa_dnn.app.main import main

if __name__ == "__main__":
    limits = ("--joint-limit", "2.5", "--acceleration-limit", "none", "--jerk-limit", "none")
    sys.exit(main(["track", *limits, *sys.argv[1:]]))
