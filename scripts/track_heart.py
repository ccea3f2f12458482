"""Draw the paper's heart with the KUKA LBR iiwa 7 R800, every step checked; see --help."""

import sys

from iiwa_dnn.app.track import track_heart

if __name__ == "__main__":
    sys.exit(track_heart())
