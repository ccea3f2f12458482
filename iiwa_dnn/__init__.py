"""Dynamic neural networks that resolve the redundancy of robot arms, checked at every step."""

from importlib.metadata import version

from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import (
    FileError,
    IiwaDnnError,
    InvalidInputError,
    MissingDependencyError,
    NoSolutionError,
    NotFoundError,
)
from iiwa_dnn.networks import DualNetwork, Network, PrimalDualNetwork, ProjectionNetwork
from iiwa_dnn.networks.batch import BatchSolution, solve_batch
from iiwa_dnn.networks.integrators import AdaptiveRungeKutta, ExplicitEuler, ImplicitEuler
from iiwa_dnn.networks.solver import DNNSolver, solve_problem
from iiwa_dnn.qp import QP, Residuals, Solution, Status
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.references import (
    Circle,
    Cone,
    Heart,
    Line,
    Lissajous,
    MovingTarget,
    OnSurface,
    Reference,
    Target,
    Tilting,
    Waypoints,
)
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Configuration, Robot, available_robots, load_robot, robot_from_dh
from iiwa_dnn.schemes import (
    AccelerationLimits,
    AxisTask,
    CentreOfMassTask,
    Cost,
    CyclicMotion,
    DoubleIndicator,
    ElbowAngleTask,
    JerkLimits,
    JointCouplingTask,
    JointLimits,
    KineticEnergy,
    Limit,
    Manipulability,
    OrientationTask,
    PoseTask,
    PositionTask,
    PostureTask,
    PseudoInverse,
    RelativePoseTask,
    RemoteCentreTask,
    Scheme,
    Step,
    Task,
)
from iiwa_dnn.simulation import MujocoPlant, Simulation, Trajectory, retime, simulate

__version__ = version("iiwa-dnn")

__all__ = [
    "QP",
    "AccelerationLimits",
    "AdaptiveRungeKutta",
    "Agreement",
    "AxisTask",
    "BatchSolution",
    "CentreOfMassTask",
    "Circle",
    "Command",
    "Cone",
    "Configuration",
    "Controller",
    "Cost",
    "CrossCheck",
    "CyclicMotion",
    "DNNSolver",
    "DoubleIndicator",
    "DualNetwork",
    "ElbowAngleTask",
    "ExplicitEuler",
    "FileError",
    "Heart",
    "IiwaDnnError",
    "ImplicitEuler",
    "InvalidInputError",
    "JerkLimits",
    "JointCouplingTask",
    "JointLimits",
    "KineticEnergy",
    "Limit",
    "Line",
    "Lissajous",
    "Manipulability",
    "MissingDependencyError",
    "MovingTarget",
    "MujocoPlant",
    "Network",
    "NoSolutionError",
    "NotFoundError",
    "OnSurface",
    "OrientationTask",
    "PoseTask",
    "PositionTask",
    "PostureTask",
    "PrimalDualNetwork",
    "ProjectionNetwork",
    "PseudoInverse",
    "Record",
    "Reference",
    "RelativePoseTask",
    "RemoteCentreTask",
    "Residuals",
    "Robot",
    "Scheme",
    "Simulation",
    "Solution",
    "Status",
    "Step",
    "Target",
    "Task",
    "Tilting",
    "Trajectory",
    "Waypoints",
    "available_robots",
    "compute_metrics",
    "failures",
    "load_robot",
    "retime",
    "robot_from_dh",
    "simulate",
    "solve_batch",
    "solve_problem",
]
