"""Export a controller or a shield: as C99 that runs without Python, or as a Python package."""

from iiwa_dnn.export.folder import c99, python
from iiwa_dnn.export.load import ExportedCommand, ExportedController, load

__all__ = ["ExportedCommand", "ExportedController", "c99", "load", "python"]
