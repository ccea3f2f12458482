"""Live control in the browser: the controller follows a target that a person drags."""

from iiwa_dnn.live.follower import Follower, FollowerState
from iiwa_dnn.live.page import Page
from iiwa_dnn.live.panel import LivePanel

__all__ = ["Follower", "FollowerState", "LivePanel", "Page"]
