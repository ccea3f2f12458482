"""Export as C99, one file that runs without Python, and of a shield as a package of its own."""

from iiwa_dnn.export.folder import c99, python
from iiwa_dnn.export.load import ExportedCommand, ExportedController, load

__all__ = ["ExportedCommand", "ExportedController", "c99", "load", "python"]
