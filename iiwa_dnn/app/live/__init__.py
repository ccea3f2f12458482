"""Live control in the browser: the controller follows a target that a person drags."""

from iiwa_dnn.app.live.follower import Follower, FollowerState
from iiwa_dnn.app.live.page import Page
from iiwa_dnn.app.live.panel import LivePanel

__all__ = ["Follower", "FollowerState", "LivePanel", "Page"]
