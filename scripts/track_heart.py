"""Draw the paper's heart with the KUKA LBR iiwa 7 R800, every step checked; see --help.

As in the paper, accelerations and jerks are not limited.
"""

import sys

from iiwa_dnn.app.main import main

if __name__ == "__main__":
    paper = ("--acceleration-limit", "none", "--jerk-limit", "none")
    sys.exit(main(["track", *paper, *sys.argv[1:]]))
