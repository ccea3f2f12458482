"""Draw the paper's heart with the KUKA LBR iiwa 7 R800, every step checked; see --help."""

import sys

from iiwa_dnn.app.main import main

if __name__ == "__main__":
    sys.exit(main(["track", *sys.argv[1:]]))
