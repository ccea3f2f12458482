"""References: paths of a frame, with exact linear and angular velocities."""

from iiwa_dnn.references.base import Motion as Motion
from iiwa_dnn.references.base import Reference as Reference
from iiwa_dnn.references.moving_target import MovingTarget as MovingTarget
from iiwa_dnn.references.shapes import Circle as Circle
from iiwa_dnn.references.shapes import Heart as Heart
from iiwa_dnn.references.shapes import Line as Line
from iiwa_dnn.references.shapes import Lissajous as Lissajous
from iiwa_dnn.references.shapes import Still as Still
from iiwa_dnn.references.targets import Target as Target
from iiwa_dnn.references.targets import Targets as Targets
from iiwa_dnn.references.turning import Cone as Cone
from iiwa_dnn.references.turning import OnSurface as OnSurface
from iiwa_dnn.references.turning import Tilting as Tilting
from iiwa_dnn.references.waypoints import Waypoints as Waypoints
