"""Export a controller or a shield: as C99, as tables in JSON, or as a Python package."""

from iiwa_dnn.export.folder import c99, python, tables
from iiwa_dnn.export.load import ExportedCommand, ExportedController, load

__all__ = ["ExportedCommand", "ExportedController", "c99", "load", "python", "tables"]
