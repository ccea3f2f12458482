"""The schemes of the atlas: those of the package and of the literature, for the paper's arm."""

from collections.abc import Callable
from typing import Any

from iiwa_dnn.schemes import (
    DoubleIndicator,
    JointLimits,
    KineticEnergy,
    Manipulability,
    OrientationTask,
    PositionTask,
    PseudoInverse,
    Scheme,
    literature,
)
from iiwa_dnn.studies.paper import START
from iiwa_dnn.studies.runs import paper_robot

_TASKS = [PositionTask(), OrientationTask()]

FREE = "double indicator, position only"
"""Scheme that leaves the orientation free."""

_AHEAD: dict[str, Any] = {"home": START, "tracking": "next", "next_gain": 10.2}

SCHEMES: dict[str, Callable[[], Scheme]] = {
    "double indicator": lambda: DoubleIndicator(**_AHEAD),
    "double indicator, the paper's rows": lambda: DoubleIndicator(orientation="block", home=START),
    FREE: lambda: DoubleIndicator(orientation="none", **_AHEAD),
    "minimum velocity": literature.minimum_velocity_norm,
    "minimum kinetic energy": lambda: Scheme(
        [KineticEnergy(kinetic="inertia")], _TASKS, [JointLimits()]
    ),
    "minimum acceleration": literature.minimum_acceleration_norm,
    "infinity norm": lambda: literature.infinity_norm(paper_robot()),
    "bi-criteria": lambda: literature.bi_criteria(paper_robot()),
    "manipulability": lambda: Scheme([KineticEnergy(), Manipulability()], _TASKS, [JointLimits()]),
    "soft rotation": lambda: Scheme(
        [KineticEnergy(weight=0.01)], [PositionTask(), OrientationTask(weight=1.0)], [JointLimits()]
    ),
    "pseudo-inverse": PseudoInverse,
}
"""Schemes by name; the first is the default. The double indicator's rows ask for the target one
period ahead, so that the joints' Euler steps leave no floor that hides a network's own error."""
