"""A page in the browser that replays a record; served by viser, which comes with extra ``view``."""

from iiwa_dnn.app.viewer.playback import Playback
from iiwa_dnn.app.viewer.replay import ReplayPanel
from iiwa_dnn.app.viewer.server import close_server, open_server
from iiwa_dnn.app.viewer.stage import Stage

__all__ = ["Playback", "ReplayPanel", "Stage", "close_server", "open_server"]
