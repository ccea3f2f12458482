"""Words of the commands, each with its place in the tables of the settings file and its help.

What has no word is set by its table and key.
"""

from dataclasses import dataclass, make_dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from tyro.conf import Positional, UseAppendAction, arg


def shown(metavar: str, about: str = "") -> Any:
    """Describe a word whose default, None or (), the help need not show."""
    return arg(metavar=metavar, help_behavior_hint="", help=about or None)


Number = Annotated[float | None, shown("X")]
Count = Annotated[int | None, shown("N")]
Flag = Annotated[bool, arg(help_behavior_hint="")]
Quiet = Annotated[bool, arg(aliases=["-q"], help_behavior_hint="")]
Folder = Annotated[Path | None, shown("FOLDER")]

TABLES = ("robot", "reference", "scheme", "limits", "run", "plant")
"""Tables of the settings file."""


class Word(NamedTuple):
    """A word that stands for a setting.

    Attributes:
        place: Table and key of the setting.
        kind: Type of its value.
        metavar: Name of the value in the help.
        about: The setting, and its default.
    """

    place: str
    kind: Any
    metavar: str
    about: str


WORDS = {
    "path": Word(
        "reference.name",
        Positional[str | None],  # type: ignore[misc] # an alias of Annotated
        "[PATH]",
        "heart, circle, line, lissajous, cone, tilting-circle or FILE.csv (heart)",
    ),
    "robot": Word("robot.name", str | None, "NAME", "iiwa7, panda, ... or a URDF file (iiwa7)"),
    "tip": Word("robot.tip", str | None, "FRAME", "frame that follows the path"),
    "lock": Word("robot.locked", tuple[str, ...] | None, "JOINT ...", "joints held still"),
    "q0": Word("robot.q0", tuple[float, ...] | None, "X ...", "joint positions at the start [rad]"),
    "reference": Word("reference.name", str | None, "NAME", "the path, as PATH"),
    "scale": Word(
        "reference.scale", float | None, "X", "factor a of the heart, whose width is 32 a [m]"
    ),
    "period": Word("reference.period", float | None, "X", "time of one round [s]"),
    "stretch": Word(
        "reference.stretch", float | None, "X", "ratio of the path's times to those in a file [1]"
    ),
    "weight": Word(
        "scheme.weight", float | None, "X", "weight xi of the kinetic index, in [0, 1] (0.2)"
    ),
    "orientation": Word(
        "scheme.orientation", str | None, "WORD", "orientation rows: so3, block or none (so3)"
    ),
    "tracking": Word(
        "scheme.tracking", str | None, "WORD", "target of a step: paper, or next, at its end"
    ),
    "joint_limit": Word(
        "limits.position",
        float | Literal["datasheet"] | None,
        "X",
        "position limit of all joints [rad], or datasheet (iiwa7: 2.5)",
    ),
    "speed": Word(
        "limits.speed", float | None, "X", "ratio of the velocity limits to the data sheet's [1]"
    ),
    "acceleration_limit": Word(
        "limits.acceleration",
        float | Literal["robot"] | None,
        "X",
        "acceleration limit [rad/s^2], or robot: its own",
    ),
    "jerk_limit": Word(
        "limits.jerk",
        float | Literal["robot"] | None,
        "X",
        "jerk limit [rad/s^3], or robot: its own",
    ),
    "obstacles": Word(
        "limits.obstacles", str | None, "FILE", "obstacles in TOML; the arm avoids them and itself"
    ),
    "mode": Word(
        "run.mode", str | None, "WORD", "network at a step: converged or continuous (converged)"
    ),
    "dt": Word("run.dt", float | None, "X", "control period [s] (1e-3; the paper's heart 1e-4)"),
    "duration": Word("run.duration", float | None, "X", "length of the run [s] (one round)"),
    "policy": Word(
        "run.policy", str | None, "WORD", "at a step without solution: slow, relax or stop (slow)"
    ),
    "motion": Word(
        "run.motion", str | None, "WORD", "integrator of the motion: euler, midpoint or rk4 (euler)"
    ),
    "noise": Word(
        "run.noise", float | None, "X", "standard deviation of the joint velocity's noise [rad/s]"
    ),
    "filter_window": Word(
        "run.filter_window", int | None, "N", "samples in the moving average of the joint velocity"
    ),
    "seed": Word("run.seed", int | None, "N", "seed of the random numbers (0)"),
    "check": Word(
        "run.check", str | None, "NAME", "reference of a step: proxqp, osqp, both, proof, none, ..."
    ),
    "tolerance": Word(
        "run.tolerance", float | None, "X", "largest gap to the reference [rad/s] (1e-6)"
    ),
    "plant": Word("plant.name", str | None, "NAME", "arm that moves: ideal or mujoco (ideal)"),
    "push": Word(
        "plant.disturbances.push.force",
        tuple[float, ...] | None,
        "X Y Z",
        "force on the tip at 5 s, in MuJoCo [N]",
    ),
}
"""Words of the commands with an arm: each stands for one setting."""


@dataclass(frozen=True)
class Run:
    """Words of a command with an arm that stand for no setting."""

    config: Annotated[Path | None, shown("FILE")] = None
    """settings in TOML: tables robot, reference, scheme, limits, run, plant"""
    set: UseAppendAction[Annotated[tuple[str, ...], shown("KEY=VALUE")]] = ()
    """one further setting, as scheme.drift_gain=5"""
    disturb: Flag = False
    """apply errors of mass, friction, encoders and a delay, in MuJoCo"""
    out: Folder = None
    """folder of the results (runs/PATH, or that of --config; controller for export)"""
    overwrite: Flag = False
    """write over a folder that holds another run"""
    plots: Flag = True
    """draw no figures, pictures or video"""
    quiet: Quiet = False
    """print nothing but the reasons of a failure"""


def _options(about: str) -> Any:
    """Make the class of the options of a command with an arm, which does what `about` says."""
    words = [
        (name, Annotated[word.kind, shown(word.metavar, word.about)], None)
        for name, word in WORDS.items()
    ]
    return make_dataclass("Run", words, bases=(Run,), namespace={"__doc__": about}, frozen=True)


OPTIONS: dict[str, Any] = {
    "track": _options(
        "Draw a path with a robot arm, every step checked; by default the paper's heart.\n\n"
        "All further settings are arguments of the Python classes, given by --config or --set.\n"
        "Exit code 0: every step solved, within limits and in agreement; 1: not so; 2: bad input."
    ),
    "physics": _options(
        "Draw a path with an arm that has masses and motors, in MuJoCo, with pictures and a video."
    ),
    "export": _options(
        "Write the controller of a run as C99: one file without dependencies, and its tests."
    ),
}
"""Options of the commands with an arm."""


@dataclass(frozen=True)
class SweepWords:
    """Words of a command that carries out many runs, and goes on where it was interrupted."""

    out: Folder = None  # folder of the results (runs/ and the command's name)
    overwrite: Flag = False  # write over a folder that holds something else
    workers: Count = None  # number of processes (one for each core)
    dask: Annotated[str | None, shown("ADDRESS")] = None  # Dask scheduler that runs them
    quiet: Quiet = False  # print nothing but the reasons of a failure
