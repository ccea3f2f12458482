"""Options of ``track``, ``physics`` and ``export``: a table of settings, and further ones.

What has no word is set by its table and key.
"""

from dataclasses import dataclass, make_dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from tyro.conf import Positional, UseAppendAction, arg

from iiwa_dnn.app.command_line import Flag, Folder, Quiet, shown

WORDS: dict[str, tuple[str, Any, str, str]] = {
    "path": (
        "reference.name",
        Positional[str | None],  # type: ignore[misc] # an alias of Annotated
        "[PATH]",
        "heart, circle, line, lissajous, cone, tilting-circle or FILE.csv (heart)",
    ),
    "robot": ("robot.name", str | None, "NAME", "iiwa7, panda, ... or a URDF file (iiwa7)"),
    "tip": ("robot.tip", str | None, "FRAME", "frame that follows the path"),
    "lock": (
        "robot.locked",
        tuple[str, ...] | None,
        "JOINT ...",
        "joints to lock; after PATH",
    ),
    "q0": (
        "robot.q0",
        tuple[float, ...] | None,
        "X ...",
        "joint positions at the start [rad]; after PATH",
    ),
    "reference": ("reference.name", str | None, "NAME", "the same as PATH"),
    "scale": (
        "reference.scale",
        float | None,
        "X",
        "factor a of the heart, whose width is 32 a [m]",
    ),
    "period": ("reference.period", float | None, "X", "time of one round [s]"),
    "stretch": (
        "reference.stretch",
        float | None,
        "X",
        "ratio of the path's times to those in a file [1]",
    ),
    "smooth": (
        "reference.noise",
        float | None,
        "X",
        "standard deviation of the noise in a file's points, which is smoothed [m]",
    ),
    "weight": (
        "scheme.weight",
        float | None,
        "X",
        "weight xi of the kinetic index, in [0, 1] (0.2)",
    ),
    "orientation": (
        "scheme.orientation",
        str | None,
        "WORD",
        "orientation rows: so3, block or none (so3)",
    ),
    "sample": (
        "scheme.sample",
        str | None,
        "WORD",
        "target of a step: that at its start or at its end (start)",
    ),
    "joint_limit": (
        "limits.position",
        float | Literal["datasheet"] | None,
        "X",
        "position limit of all joints [rad], or datasheet (datasheet)",
    ),
    "speed": (
        "limits.speed",
        float | None,
        "X",
        "ratio of the velocity limits to the data sheet's [1]",
    ),
    "acceleration_limit": (
        "limits.acceleration",
        float | Literal["robot", "none"] | None,
        "X",
        "acceleration limit [rad/s^2], or none (the robot's own)",
    ),
    "jerk_limit": (
        "limits.jerk",
        float | Literal["robot", "none"] | None,
        "X",
        "jerk limit [rad/s^3], or none (the robot's own)",
    ),
    "obstacles": (
        "limits.obstacles",
        str | None,
        "FILE",
        "obstacles in TOML; the arm avoids them and itself",
    ),
    "mode": (
        "run.mode",
        str | None,
        "WORD",
        "network: converged at each step, or continuous (converged)",
    ),
    "dt": ("run.dt", float | None, "X", "control period [s] (1e-3; the paper's heart 1e-4)"),
    "duration": ("run.duration", float | None, "X", "length of the run [s] (one round)"),
    "policy": (
        "run.policy",
        str | None,
        "WORD",
        "action if a step has no solution: slow, relax or stop (slow)",
    ),
    "motion": (
        "run.motion",
        str | None,
        "WORD",
        "integrator of the motion: euler, midpoint or rk4 (euler)",
    ),
    "noise": (
        "run.noise",
        float | None,
        "X",
        "standard deviation of the joint velocity's noise [rad/s]",
    ),
    "filter_window": (
        "run.filter_window",
        int | None,
        "N",
        "samples in the moving average of the joint velocity",
    ),
    "seed": ("run.seed", int | None, "N", "seed of the random numbers (0)"),
    "check": (
        "run.check.solver",
        str | None,
        "NAME",
        "reference solver of each QP: proxqp, osqp, both, proof, none, ... (proxqp)",
    ),
    "tolerance": (
        "run.check.tolerance",
        float | None,
        "X",
        "largest gap to the reference solver [rad/s] (1e-6)",
    ),
    "plant": ("plant.name", str | None, "NAME", "arm that moves: ideal or mujoco (ideal)"),
    "push": (
        "plant.disturbances.push.force",
        tuple[float, ...] | None,
        "X Y Z",
        "force on the tip at 5 s, in MuJoCo [N]",
    ),
}
"""Options of the commands with an arm: table and key, type, name of the value, and help."""

OF_RUNS = frozenset(
    ("duration", "motion", "noise", "filter_window", "seed", "check", "tolerance", "plant", "push")
)
"""Options of a run that do not concern its controller."""


@dataclass(frozen=True)
class Common:
    """Options that are no settings."""

    config: Annotated[Path | None, shown("FILE")] = None
    """settings in TOML: tables robot, reference, scheme, limits, run, plant"""
    set: UseAppendAction[Annotated[tuple[str, ...], shown("KEY=VALUE")]] = ()
    """one further setting, as scheme.drift_gain=5"""
    out: Folder = None
    """folder of the results (runs/PATH, or that of --config; export: controller)"""
    overwrite: Flag = False
    """write over a folder that holds another run"""
    quiet: Quiet = False
    """print nothing but the reasons of a failure"""


@dataclass(frozen=True)
class OfRuns(Common):
    """Options of a run that are no settings."""

    disturb: Flag = False
    """apply errors of mass, friction, encoders and a delay, in MuJoCo"""
    plots: Flag = True
    """draw no figures, pictures or video"""


@dataclass(frozen=True)
class OfExports(Common):
    """Options of an export that are no settings."""

    tables: Annotated[Path | None, shown("FILE")] = None
    """write a shield of the robot as tables, a file of JSON that armstep loads"""
    controller: Flag = False
    """write the run's controller as those tables, in place of a shield"""


def _options(name: str, base: type[Common], without: frozenset[str] = frozenset()) -> Any:
    """Make the class of a command's options: `WORDS` without some of them, and those of a base."""
    fields = [
        (word, Annotated[kind, shown(metavar, about)], None)
        for word, (_, kind, metavar, about) in WORDS.items()
        if word not in without
    ]
    made = make_dataclass(name, fields, bases=(base,), frozen=True)
    return Annotated[made, arg(name="")]


RunWords: Any = _options("RunWords", OfRuns)
ExportWords: Any = _options("ExportWords", OfExports, OF_RUNS)
