"""Words of the commands with an arm, and the tables of the settings file that they stand in.

The comment behind a word is its help. What has no word is set by its table and key.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from tyro.conf import Positional, UseAppendAction, arg


def shown(metavar: str) -> Any:
    """Describe a word whose default, None or (), the help need not show."""
    return arg(metavar=metavar, help_behavior_hint="")


Number = Annotated[float | None, shown("X")]
Count = Annotated[int | None, shown("N")]
Flag = Annotated[bool, arg(help_behavior_hint="")]
Quiet = Annotated[bool, arg(aliases=["-q"], help_behavior_hint="")]
Name = Annotated[str | None, shown("NAME")]
Word = Annotated[str | None, shown("WORD")]

TABLES: dict[str, dict[str, str]] = {
    "robot": {"robot": "name", "tip": "tip", "lock": "locked", "q0": "q0"},
    "reference": {
        "path": "name",
        "reference": "name",
        "scale": "scale",
        "period": "period",
        "stretch": "stretch",
    },
    "scheme": {"weight": "weight", "orientation": "orientation", "tracking": "tracking"},
    "limits": {
        "joint_limit": "position",
        "speed": "speed",
        "acceleration_limit": "acceleration",
        "jerk_limit": "jerk",
        "obstacles": "obstacles",
    },
    "run": {
        "mode": "mode",
        "dt": "dt",
        "duration": "duration",
        "policy": "policy",
        "motion": "motion",
        "noise": "noise",
        "filter_window": "filter_window",
        "seed": "seed",
        "check": "check",
        "tolerance": "tolerance",
    },
    "plant": {"plant": "name"},
}
"""Tables of the settings file, each with the key of every word that stands in it."""


@dataclass(frozen=True)
class Track:
    """Draw a path with a robot arm, every step checked; by default the paper's heart.

    All further settings are arguments of the Python classes, given by --config or --set.
    Exit code 0: every step solved, within limits and in agreement; 1: not so; 2: bad input.
    """

    path: Positional[Annotated[str | None, shown("[PATH]")]] = None
    """heart, circle, line, lissajous, cone, tilting-circle or FILE.csv (heart)"""
    config: Annotated[Path | None, shown("FILE")] = None
    """settings in TOML: tables robot, reference, scheme, limits, run, plant"""
    set: UseAppendAction[Annotated[tuple[str, ...], shown("KEY=VALUE")]] = ()
    """one further setting, as scheme.drift_gain=5"""
    out: Annotated[Path | None, shown("FOLDER")] = None
    """folder of the results (runs/PATH, or the folder of --config)"""
    overwrite: Flag = False  # write over a folder that holds another run
    plots: Flag = True  # draw no figures, pictures or video
    quiet: Quiet = False  # print nothing but the reasons of a failure
    robot: Name = None  # iiwa7, panda, ... or a URDF file (iiwa7)
    tip: Annotated[str | None, shown("FRAME")] = None  # frame that follows the path
    lock: Annotated[tuple[str, ...], shown("JOINT ...")] = ()  # joints held still
    q0: Annotated[tuple[float, ...], shown("X ...")] = ()  # joint positions at the start [rad]
    reference: Name = None  # the path, as PATH
    scale: Number = None  # factor a of the heart, whose width is 32 a [m]
    period: Number = None  # time of one round [s]
    stretch: Number = None  # ratio of the path's times to those in a CSV file [1]
    weight: Number = None  # weight xi of the kinetic index, in [0, 1] (0.2)
    orientation: Word = None  # orientation rows: so3, the paper's block, or none (so3)
    tracking: Word = None  # target of a step: paper, at its time, or next, at its end (paper)
    joint_limit: Annotated[float | Literal["datasheet"] | None, shown("X")] = None
    """position limit of all joints [rad], or datasheet (iiwa7: 2.5)"""
    speed: Number = None  # ratio of the velocity limits to the data sheet's [1]
    acceleration_limit: Annotated[float | Literal["robot"] | None, shown("X")] = None
    """acceleration limit [rad/s^2], or robot: its own"""
    jerk_limit: Annotated[float | Literal["robot"] | None, shown("X")] = None
    """jerk limit [rad/s^3], or robot: its own"""
    obstacles: Annotated[str | None, shown("FILE")] = None
    """obstacles in TOML; the arm avoids them and itself"""
    mode: Word = None  # network at a step: converged, or continuous as the paper's (converged)
    dt: Number = None  # control period [s] (1e-3; the paper's heart 1e-4)
    duration: Number = None  # length of the run [s] (one round)
    policy: Word = None  # action at a step without a solution: slow, relax or stop (slow)
    motion: Word = None  # integrator of the joint velocity: euler, midpoint or rk4 (euler)
    noise: Number = None  # standard deviation of the joint velocity's noise [rad/s]
    filter_window: Count = None  # samples in the moving average of the joint velocity
    seed: Count = None  # seed of the random numbers (0)
    check: Name = None  # reference of each step: proxqp, osqp, both, ..., proof, none (proxqp)
    tolerance: Number = None  # largest gap to the reference [rad/s] (1e-6)
    plant: Name = None  # arm that moves: ideal or mujoco (ideal)


@dataclass(frozen=True)
class Physics(Track):
    """Draw a path with an arm that has masses and motors, in MuJoCo, with pictures and a video.

    A torque controller follows the network's joint velocities, and every step is checked.
    """

    disturb: Flag = False  # apply errors of mass, friction, encoders and a delay
    push: Annotated[tuple[float, ...], shown("X Y Z")] = ()  # force on the tip at 5 s [N]


@dataclass(frozen=True)
class Export(Track):
    """Write the controller of a run as C99: one file without dependencies, and its tests."""


@dataclass(frozen=True)
class SweepWords:
    """Words of a command that carries out many runs, and goes on where it was interrupted."""

    out: Annotated[Path | None, shown("FOLDER")] = None
    """folder of the results (runs/ and the command's name)"""
    overwrite: Flag = False  # write over a folder that holds something else
    workers: Count = None  # number of processes (one for each core)
    dask: Annotated[str | None, shown("ADDRESS")] = None  # Dask scheduler that runs them
    quiet: Quiet = False  # print nothing but the reasons of a failure
