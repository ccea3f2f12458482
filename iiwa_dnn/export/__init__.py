"""Export of a controller as C99: one file that runs without Python, and its way back."""

from iiwa_dnn.export.folder import c99
from iiwa_dnn.export.load import ExportedCommand, ExportedController, load

__all__ = ["ExportedCommand", "ExportedController", "c99", "load"]
