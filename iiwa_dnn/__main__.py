"""``python -m iiwa_dnn``: the command line."""

import sys

from iiwa_dnn.app.main import main

sys.exit(main())
