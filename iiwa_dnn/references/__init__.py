"""References: paths of a frame, with exact linear and angular velocities."""

from iiwa_dnn.references.base import Reference
from iiwa_dnn.references.circle import Circle
from iiwa_dnn.references.heart import Heart
from iiwa_dnn.references.line import Line
from iiwa_dnn.references.lissajous import Lissajous
from iiwa_dnn.references.moving_target import MovingTarget
from iiwa_dnn.references.still import Still
from iiwa_dnn.references.targets import Target, Targets
from iiwa_dnn.references.turning import Cone, OnSurface, Tilting
from iiwa_dnn.references.waypoints import Waypoints

__all__ = [
    "Circle",
    "Cone",
    "Heart",
    "Line",
    "Lissajous",
    "MovingTarget",
    "OnSurface",
    "Reference",
    "Still",
    "Target",
    "Targets",
    "Tilting",
    "Waypoints",
]
