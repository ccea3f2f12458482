"""References: paths of a frame, with exact linear and angular velocities."""

from iiwa_dnn.references.base import Reference as Reference
from iiwa_dnn.references.moving_target import MovingTarget as MovingTarget
from iiwa_dnn.references.shapes import (
    Circle as Circle,
    FixedPose as FixedPose,
    Heart as Heart,
    Line as Line,
    Lissajous as Lissajous,
)
from iiwa_dnn.references.targets import Target as Target
from iiwa_dnn.references.turning import Cone as Cone, Tilting as Tilting
from iiwa_dnn.references.waypoints import Waypoints as Waypoints
