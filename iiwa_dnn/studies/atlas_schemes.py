"""The schemes of the atlas: those of the package and of the literature, for the paper's arm."""

from collections.abc import Callable

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

SCHEMES: dict[str, Callable[[], Scheme]] = {
    "double indicator": lambda: DoubleIndicator(home=START),
    "double indicator, block rows": lambda: DoubleIndicator(orientation="block", home=START),
    "double indicator, position only": lambda: DoubleIndicator(orientation="none", home=START),
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
    "resolved acceleration": literature.resolved_acceleration,
    "minimum torque": literature.minimum_torque,
}
"""Schemes by name; the first is the default."""
