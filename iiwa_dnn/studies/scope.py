"""How much of the experiments is run: all of them in full, or a quick look."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from iiwa_dnn.checks import positive
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.studies import paper


@dataclass(frozen=True)
class Scope:
    """Sizes of the experiments.

    Attributes:
        duration: Length of each run [s]; the heart takes 10 s.
        seeds: Number of noises in Table II, two or more.
        laps: Number of hearts drawn to see the drift add up.
        laps_dt: Control period of those laps [s]; they are integrated by the midpoint rule.
        dt: Control period of everything else [s].
    """

    duration: float = 10.0
    seeds: int = 100
    laps: int = 10
    laps_dt: float = 1e-3
    dt: float = paper.DT

    def __post_init__(self) -> None:
        """Check the sizes; raises InvalidInputError naming the one that is wrong."""
        for name in ("duration", "laps_dt", "dt"):
            positive(name, getattr(self, name))
        for name, least in (("seeds", 2), ("laps", 1)):
            if getattr(self, name) < least:
                problem = f"must be at least {least}, not {getattr(self, name)}"
                raise InvalidInputError(name, problem, getattr(self, name))

    def to_json(self) -> dict[str, Any]:
        """The sizes by their names."""
        return asdict(self)


FULL = Scope()
"""The paper's experiments at full length, over 100 seeds."""

QUICK = Scope(duration=1.0, seeds=5, laps=2, laps_dt=1e-2)
"""The same with the first second of each run: to see that all works, not to compare with."""
