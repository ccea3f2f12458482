"""Dynamic neural networks that resolve the redundancy of robot arms, checked at every step."""

from importlib import import_module
from typing import TYPE_CHECKING

from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.errors import (
    FileError,
    IiwaDnnError,
    InvalidInputError,
    MissingDependencyError,
    NoSolutionError,
    NotFoundError,
)
from iiwa_dnn.networks import (
    ActivatedNetwork,
    DualNetwork,
    GradientNetwork,
    Network,
    OneLayerNetwork,
    PrimalDualNetwork,
    ProjectionNetwork,
    SimplifiedDualNetwork,
    ZeroingNetwork,
)
from iiwa_dnn.networks.integrators import ExplicitEuler, ImplicitEuler
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Residuals, Solution, Status
from iiwa_dnn.references import (
    Circle,
    Cone,
    FixedPose,
    Heart,
    Line,
    Lissajous,
    MovingTarget,
    Reference,
    Target,
    Tilting,
    Waypoints,
)
from iiwa_dnn.robot import Configuration, Robot, available_robots, load_robot, robot_from_dh
from iiwa_dnn.schemes import (
    AccelerationLimits,
    AxisTask,
    Box,
    Capsule,
    CollisionAvoidance,
    Cost,
    CyclicMotion,
    DoubleIndicator,
    HalfSpace,
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
    RemoteCenterTask,
    Scheme,
    Separation,
    Sphere,
    Step,
    Task,
    TipSpeedLimit,
    TorqueLimits,
)

if TYPE_CHECKING:
    from iiwa_dnn import export as export
    from iiwa_dnn.control.controllers import Controllers, ControllersCommand
    from iiwa_dnn.control.shields import Shields, ShieldsCommand
    from iiwa_dnn.networks.batch import BatchSolution, solve_batch
    from iiwa_dnn.networks.problems import solve_problem
    from iiwa_dnn.networks.tracking import TrackingSolver
    from iiwa_dnn.posing import PoseSolution, solve_pose
    from iiwa_dnn.qp.agreement import Agreement
    from iiwa_dnn.qp.crosscheck import CrossCheck
    from iiwa_dnn.qp.proof import Proof, prove
    from iiwa_dnn.results.failures import failures
    from iiwa_dnn.results.metrics import compute_metrics
    from iiwa_dnn.results.record import Record
    from iiwa_dnn.simulation import MujocoPlant, RunSettings, simulate

    __version__: str
else:

    def __getattr__(name: str) -> object:
        """Import a name, a room or the version at its first use."""
        if name in ("export", "results", "simulation"):
            return import_module(f"iiwa_dnn.{name}")
        if name == "__version__":
            return import_module("importlib.metadata").version("iiwa-dnn")
        for module, names in _LATER.items():
            if name in names.split():
                found = globals()[name] = getattr(import_module(f"iiwa_dnn.{module}"), name)
                return found
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})


_LATER = {
    "control.controllers": "Controllers ControllersCommand",
    "posing": "PoseSolution solve_pose",
    "control.shields": "Shields ShieldsCommand",
    "networks.batch": "BatchSolution solve_batch",
    "networks.problems": "solve_problem",
    "networks.tracking": "TrackingSolver",
    "qp.agreement": "Agreement",
    "qp.crosscheck": "CrossCheck",
    "qp.proof": "Proof prove",
    "results.failures": "failures",
    "results.metrics": "compute_metrics",
    "results.record": "Record",
    "simulation": "MujocoPlant RunSettings simulate",
}
"""Names that a shield does not need, by their modules, which are imported at their first use."""

__all__ = [
    "QP",
    "AccelerationLimits",
    "ActivatedNetwork",
    "Agreement",
    "AxisTask",
    "BatchSolution",
    "Box",
    "Capsule",
    "Circle",
    "CollisionAvoidance",
    "Command",
    "Cone",
    "Configuration",
    "Controller",
    "Controllers",
    "ControllersCommand",
    "Cost",
    "CrossCheck",
    "CyclicMotion",
    "DNNSolver",
    "DoubleIndicator",
    "DualNetwork",
    "ExplicitEuler",
    "FileError",
    "FixedPose",
    "GradientNetwork",
    "HalfSpace",
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
    "OneLayerNetwork",
    "OrientationTask",
    "PoseSolution",
    "PoseTask",
    "PositionTask",
    "PostureTask",
    "PrimalDualNetwork",
    "ProjectionNetwork",
    "Proof",
    "PseudoInverse",
    "Record",
    "Reference",
    "RelativePoseTask",
    "RemoteCenterTask",
    "Residuals",
    "Robot",
    "RunSettings",
    "Scheme",
    "Separation",
    "Shield",
    "Shields",
    "ShieldsCommand",
    "SimplifiedDualNetwork",
    "Solution",
    "Sphere",
    "Status",
    "Step",
    "Target",
    "Task",
    "Tilting",
    "TipSpeedLimit",
    "TorqueLimits",
    "TrackingSolver",
    "Waypoints",
    "ZeroingNetwork",
    "available_robots",
    "compute_metrics",
    "failures",
    "load_robot",
    "prove",
    "robot_from_dh",
    "simulate",
    "solve_batch",
    "solve_pose",
    "solve_problem",
]  # fmt: skip
