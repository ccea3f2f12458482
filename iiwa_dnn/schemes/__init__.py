"""Redundancy-resolution schemes: each turns a configuration and a target into a QP."""

from iiwa_dnn.schemes.base import Scheme, VelocityProgram, compiled_program, identity
from iiwa_dnn.schemes.double_indicator import DoubleIndicator
from iiwa_dnn.schemes.pseudo_inverse import PseudoInverse

__all__ = [
    "DoubleIndicator",
    "PseudoInverse",
    "Scheme",
    "VelocityProgram",
    "compiled_program",
    "identity",
]
