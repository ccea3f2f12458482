"""Options of every command: one dataclass a command, one field an option.

The text under a field is its help on the command line, its name is its key in a settings file, and
the first line of a class is the command's entry in the list of commands.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from tyro.conf import FlagCreatePairsOff, Positional, arg

from iiwa_dnn.control.controller import Mode
from iiwa_dnn.control.policies import Policy
from iiwa_dnn.references import Heart
from iiwa_dnn.schemes.double_indicator import Kinetic
from iiwa_dnn.schemes.orientation import Orientation
from iiwa_dnn.simulation import NoiseEntry
from iiwa_dnn.simulation.motion import Motion

Check = Literal["proxqp", "osqp", "both", "none"]
SHELLS = ("bash", "zsh", "tcsh")


def _value(metavar: str) -> Any:
    """Describe an option whose help ends with its default."""
    return arg(metavar=metavar)


def _unset(metavar: str) -> Any:
    """Describe an option that is not set by default; its help says what holds then."""
    return arg(metavar=metavar, help_behavior_hint="")


Flag = Annotated[bool, arg(help_behavior_hint=""), FlagCreatePairsOff]
Quiet = Annotated[bool, arg(aliases=["-q"], help_behavior_hint=""), FlagCreatePairsOff]
Verbose = Annotated[bool, arg(aliases=["-v"], help_behavior_hint=""), FlagCreatePairsOff]
Folder = Annotated[Path, _value("DIR")]
Frame = Annotated[str | None, _unset("FRAME")]
Joints = Annotated[tuple[str, ...], _unset("JOINT")]
Solvers = Annotated[Check, _value("SOLVER")]
Count = Annotated[int, _value("N")]
MaybeCount = Annotated[int | None, _unset("N")]
Length = Annotated[float, _value("M")]
Seconds = Annotated[float, _value("S")]
MaybeSeconds = Annotated[float | None, _unset("S")]
Share = Annotated[float | None, _unset("SHARE")]
Numbers = tuple[float, ...]


@dataclass(frozen=True)
class RunOptions:
    """Options of every command that leaves a folder."""

    command: ClassVar[str]
    settings: Annotated[Path | None, _unset("FILE")] = None
    """TOML file of options, which the command line overrides; its folder is then --out"""
    out: Folder = Path("runs")
    """folder that the results are written to"""
    overwrite: Flag = False
    """write over a folder that holds another run or other files"""
    quiet: Quiet = False
    """print no progress, no summary, only why a run failed"""
    verbose: Verbose = False
    """print settings, written files and the traceback of an error too"""


@dataclass(frozen=True)
class ArmOptions(RunOptions):
    """Options of the commands that let an arm follow a path."""

    robot: Annotated[str, _value("NAME|URDF")] = "iiwa7"
    """robot, by its name or by its URDF file"""
    tip: Frame = None
    """frame that follows the path (none: the end of the chain)"""
    q0: Annotated[Numbers, _unset("RAD")] = ()
    """joint positions at the start [rad] (none: the robot's start posture)"""
    joint_limit: Annotated[str | None, _unset("RAD")] = None
    """position limit of every joint, up and down [rad], or datasheet (iiwa7: 2.5)"""
    reference: Annotated[str, _value("PATH")] = "heart"
    """path of the tip: heart, circle, line, lissajous or a CSV file of t [s] and x, y, z [m]"""
    scale: Length = Heart.scale
    """factor a of the heart, whose width is 32 a [m]"""
    radius: Length = 0.05
    """radius of the circle [m]"""
    offset: Annotated[Numbers, _value("X Y Z")] = (0.1, 0.0, 0.0)
    """vector from the line's start to its far end [m]"""
    amplitudes: Annotated[Numbers, _value("X Y Z")] = (0.05, 0.05, 0.0)
    """amplitudes of the Lissajous figure [m]"""
    period: Seconds = Heart.period
    """time of one round on the path [s]; a CSV file has its own"""
    weight: Annotated[float, _value("XI")] = 0.2
    """weight xi of the kinetic index against the joint drift, in [0, 1]"""
    orientation: Annotated[Orientation, _value("FORM")] = "so3"
    """form of the orientation task: so3, block (the paper's) or none"""
    dt: Seconds = 1e-4
    """control period [s]"""
    duration: MaybeSeconds = None
    """length of the run [s] (none: one round on the path)"""
    seed: Count = 0
    """seed of the random numbers"""
    check: Solvers = "proxqp"
    """solvers that check every step: proxqp, osqp, both or none"""
    tolerance: Annotated[float, _value("RAD/S")] = 1e-6
    """largest gap between the network and a checking solver [rad/s]"""
    plots: Flag = True
    """draw no figures"""


@dataclass(frozen=True)
class TrackOptions(ArmOptions):
    """Draw a path with a robot arm, every step checked; by default the paper's heart.

    Exit code 0: all checks agreed; 1: a step disagreed, was not solved or broke a limit; 2: bad
    input.
    """

    command: ClassVar[str] = "track"
    out: Folder = Path("runs/heart")
    lock: Joints = ()
    """names of the joints that are held still"""
    speed: Annotated[float, _value("SHARE")] = 1.0
    """velocity limits, as a share of the data sheet's"""
    mode: Annotated[Mode, _value("MODE")] = "converged"
    """network settled at every step (converged) or integrated once a step (continuous)"""
    kinetic: Annotated[Kinetic, _value("G")] = "identity"
    """matrix G of the kinetic index: identity (the paper's) or inertia"""
    gain: Annotated[float, _value("1/S")] = 10.2
    """feedback gain of the position and the orientation error [1/s]"""
    integral_gain: Annotated[float, _value("1/S^2")] = 0.0
    """feedback gain of the error's integral [1/s^2]"""
    policy: Annotated[Policy, _value("POLICY")] = "slow"
    """action at a step without a solution: slow, relax, stop or raise"""
    motion: Annotated[Motion, _value("METHOD")] = "euler"
    """integration of the joint velocity: euler, midpoint or rk4"""
    noise: Annotated[float, _value("RAD/S")] = 0.0
    """standard deviation of the noise [rad/s]; of noise in the measurement [rad]"""
    noise_at: Annotated[NoiseEntry, _value("WHERE")] = "velocity"
    """quantity that is noisy: velocity, network (its state) or measurement"""
    filter_window: Count = 1
    """number of samples in the moving average of the joint velocity"""


@dataclass(frozen=True)
class PhysicsOptions(ArmOptions):
    """Draw a path with an arm that has masses and motors, in MuJoCo.

    The network's velocities, a torque loop under them, every step checked; no disturbances by
    default. Exit code 0: all checks agreed; 1: a step disagreed, was not solved or broke a
    limit; 2: bad input, or a package is missing.
    """

    command: ClassVar[str] = "physics"
    out: Folder = Path("runs/physics")
    dt: Seconds = 1e-3
    physics_dt: Seconds = 2.5e-4
    """time step of the physics [s], at most 1e-3"""
    disturb: Flag = False
    """switch on the next five disturbances, each of the size in brackets"""
    mass_error: Share = None
    """error of each link's mass, as a share of it (0.1)"""
    friction: Share = None
    """Coulomb friction, as a share of the torque limit (0.01)"""
    encoder_noise: Annotated[float | None, _unset("RAD")] = None
    """standard deviation of an encoder's reading [rad] (1e-05)"""
    encoder_bits: MaybeCount = None
    """resolution of an encoder [bits a turn] (18)"""
    delay: MaybeCount = None
    """delay of a velocity command [control periods] (1)"""
    push: Annotated[Numbers | None, _unset("FX FY FZ")] = None
    """force that pushes the tip, along the world's axes [N]"""
    push_at: Seconds = 5.0
    """time at which the push begins [s]"""
    push_for: Seconds = 0.2
    """time that the push lasts [s]"""
    pictures: Flag = True
    """draw no pictures of the arm"""
    video: Flag = True
    """make no video"""


@dataclass(frozen=True)
class PaperOptions(RunOptions):
    """Run every experiment of the paper and put each number beside the paper's.

    A sweep that was cut short goes on where it was. Exit code 0: all runs completed; 1: one was
    not; 2: bad input.
    """

    command: ClassVar[str] = "paper"
    out: Folder = Path("runs/paper")
    quick: Flag = False
    """run 1 s and 5 seeds only, to see that all works"""
    seeds: MaybeCount = None
    """number of noises in Table II (100)"""
    duration: MaybeSeconds = None
    """length of each run [s] (10)"""
    workers: MaybeCount = None
    """number of processes (one for each core)"""
    dask: Annotated[str | None, _unset("ADDRESS")] = None
    """address of a Dask scheduler, or local to start one here"""
    plots: Flag = True
    """draw no figures"""


@dataclass(frozen=True)
class NoiseOptions(RunOptions):
    """Compare the countermeasures against noise of the joint velocity.

    Error against smoothness of the command. A sweep that was cut short goes on where it was. Exit
    code 0: all runs completed; 1: one was not; 2: bad input.
    """

    command: ClassVar[str] = "noise"
    out: Folder = Path("runs/noise")
    seeds: Count = 100
    """number of noises"""
    duration: Seconds = 2.0
    """length of each run [s]"""
    workers: MaybeCount = None
    """number of processes (one for each core)"""


@dataclass(frozen=True)
class ViewOptions:
    """Replay a run in the browser, or drive the arm live.

    Live, the controller follows a target that is dragged. Exit code 0: ended by Ctrl-C; 2: bad
    input, or a package is missing.
    """

    command: ClassVar[str] = "view"
    run: Positional[Annotated[Path | None, _unset("RUN")]] = None
    """folder or record of a run (none: live)"""
    robot: Annotated[str | None, _unset("NAME|URDF")] = None
    """robot, by its name or by its URDF file (none: the record's, or iiwa7)"""
    tip: Frame = None
    """frame that follows the target (none: the record's, or the chain's end)"""
    lock: Joints = ()
    """names of the joints that are held still"""
    host: Annotated[str, _value("ADDRESS")] = "127.0.0.1"
    """address to listen on; 0.0.0.0 lets other machines in"""
    port: Count = 8080
    """port to listen on; 0 takes a free one"""
    verbose: Verbose = False
    """print the traceback of an error too"""


@dataclass(frozen=True)
class SolveOptions:
    """Solve the quadratic program in an .npz file.

    The file holds the arrays P and q, and of G and h, A and b, lb, ub those that there are. Exit
    code 0: solved; 1: no answer within the tolerance; 2: bad input.
    """

    command: ClassVar[str] = "solve"
    file: Positional[Annotated[Path | None, _unset("FILE")]] = None
    """program, written with numpy.savez"""
    tol: Annotated[float, _value("TOL")] = 1e-9
    """largest residual of a solution, in the program's units"""
    check: Solvers = "none"
    """solvers that are asked too: proxqp, osqp or both"""
    out: Annotated[Path | None, _unset("FILE")] = None
    """.npz file that the solution is written to"""
    quiet: Quiet = False
    """print only why there is no solution"""
    verbose: Verbose = False
    """print the multipliers, and the traceback of an error too"""


@dataclass(frozen=True)
class WarmUpOptions:
    """Compile everything that a run needs, once for all later runs.

    Exit code 0: done.
    """

    command: ClassVar[str] = "warm-up"
    quiet: Quiet = False
    """print no progress"""


@dataclass(frozen=True)
class CompletionOptions:
    """Print completion for a shell: bash, zsh or tcsh."""

    command: ClassVar[str] = "completion"
    shell: Positional[Annotated[str, _unset("SHELL")]] = ""
    """shell that completes: bash, zsh or tcsh"""


COMMANDS: dict[str, type[Any]] = {
    kind.command: kind
    for kind in (
        TrackOptions, PaperOptions, NoiseOptions, PhysicsOptions, ViewOptions, SolveOptions,
        WarmUpOptions, CompletionOptions,
    )
}  # fmt: skip
"""Options of each command by its name; the module of that name holds its function ``run``."""
