"""Export a controller or a shield: as C99, or as tables in JSON."""

from iiwa_dnn.export.folder import c99, tables

__all__ = ["c99", "tables"]
