"""Dynamic neural networks: ODEs whose equilibria are the KKT points of a quadratic program."""

from iiwa_dnn.networks.projection import ProjectionNetwork

__all__ = ["ProjectionNetwork"]
