"""A pose that is held."""

from dataclasses import dataclass
from typing import Any, ClassVar

from iiwa_dnn.checks import positive
from iiwa_dnn.references.base import Array, Reference


def _path(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Add nothing to targets (k, 18) in `out`; see `Reference.path`."""


@dataclass(frozen=True, eq=False)
class Still(Reference):
    """A pose to go to and to hold: ``Still().anchored(pose)``.

    Attributes:
        period: Length of a run that is given none [s], above 0.
    """

    name: ClassVar[str] = "still"
    path: ClassVar[Any] = staticmethod(_path)
    period: float = 10.0

    def __post_init__(self) -> None:
        """Check the period; raises InvalidInputError."""
        self._set(period=positive("period", self.period))
