"""Options of every command: one dataclass a command, one line an option.

The comment behind a field is its help on the command line, its name is its key in a settings file,
and the first line of a class is the command's entry in the list of commands.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from tyro.conf import Positional, arg

from iiwa_dnn.control.controller import Mode
from iiwa_dnn.control.policies import Policy
from iiwa_dnn.references import Heart
from iiwa_dnn.references.turning import TILT
from iiwa_dnn.references.waypoints import SPEED
from iiwa_dnn.schemes.costs import Kinetic
from iiwa_dnn.schemes.double_indicator import Tracking
from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NoiseEntry
from iiwa_dnn.simulation.motion import Motion

Check = Literal["proxqp", "osqp", "both", "proof", "none"]
SHELLS = ("bash", "zsh", "tcsh")

# Options whose default, None or (), the help need not show.
_Float = Annotated[float | None, arg(metavar="FLOAT", help_behavior_hint="")]
_Floats = Annotated[tuple[float, ...], arg(metavar="FLOAT ...", help_behavior_hint="")]
_Int = Annotated[int | None, arg(metavar="INT", help_behavior_hint="")]
_Name = Annotated[str | None, arg(metavar="NAME", help_behavior_hint="")]
_Names = Annotated[tuple[str, ...], arg(metavar="NAME ...", help_behavior_hint="")]
_Path = Annotated[Path | None, arg(metavar="PATH", help_behavior_hint="")]
_Limit = Annotated[str | None, arg(metavar="FLOAT|NAME", help_behavior_hint="")]
_Quiet = Annotated[bool, arg(aliases=["-q"])]
_Verbose = Annotated[bool, arg(aliases=["-v"])]


@dataclass(frozen=True)
class RunOptions:
    """Options of every command that leaves a folder."""

    command: ClassVar[str]
    also_reads: ClassVar[tuple[str, ...]] = ()
    """Other commands whose settings files the command takes."""
    settings: _Path = None  # TOML file of options; those given here come first
    out: Path = Path("runs")  # folder of the results
    overwrite: bool = False  # write over a folder that holds another run or other files
    quiet: _Quiet = False  # print nothing but the reasons of a failure
    verbose: _Verbose = False  # print settings, written files and the traceback of an error too


@dataclass(frozen=True)
class TrackOptions(RunOptions):
    """Draw a path with a robot arm, every step checked; by default the paper's heart."""

    command: ClassVar[str] = "track"
    out: Path = Path("runs/heart")  # folder of the results
    robot: str = "iiwa7"  # robot, by its name or by its file: URDF, xacro
    tip: _Name = None  # frame that follows the path (none: the end of the chain)
    frames: _Names = ()  # further frames that draw the path, such as a second arm's
    lock: _Names = ()  # names of the joints that are held still
    tool: _Floats = ()  # pose of the tool frame in the tip frame: X Y Z R P Y [m, rad]
    q0: _Floats = ()  # joint positions at the start [rad] (none: the robot's start posture)
    joint_limit: _Limit = None  # position limit of all joints [rad], or datasheet (iiwa7: 2.5)
    reference: str = "heart"
    """path: heart, circle, line, lissajous, cone, tilting-circle, or a CSV file"""
    scale: float = Heart.scale  # factor a of the heart, whose width is 32 a [m]
    radius: float = 0.05  # radius of the circles [m]
    angle: float = TILT  # tilt of the tool on the cone and the tilting circle [rad]
    tool_speed: float = SPEED  # speed of the tip along a CSV file without times [m/s]
    stretch: float = 1.0  # ratio of the path's times to those in a CSV file with times [1]
    offset: tuple[float, ...] = (0.1, 0.0, 0.0)  # vector from the line's start to its far end [m]
    amplitudes: tuple[float, ...] = (0.05, 0.05, 0.0)  # amplitudes of the Lissajous figure [m]
    period: float = Heart.period  # time of one round on the path [s]; a CSV file has its own
    obstacles: _Path = None  # TOML file of obstacles; the arm avoids them and itself
    weight: float = 0.2  # weight xi of the kinetic index against the joint drift, in [0, 1]
    orientation: Orientation = "so3"  # form of the orientation task; block is the paper's
    dt: float = 1e-4  # control period [s]
    duration: _Float = None  # length of the run [s] (none: one round on the path)
    seed: int = 0  # seed of the random numbers
    check: Check = "proxqp"  # reference solvers that check every step, or a rigorous proof
    tolerance: float = 1e-6  # largest gap between the network and a checking solver [rad/s]
    speed: float = 1.0  # ratio of the velocity limits to the data sheet's [1]
    acceleration_limit: _Limit = None  # acceleration limit [rad/s^2], or robot: its own
    jerk_limit: _Limit = None  # jerk limit [rad/s^3], or robot: its own
    tip_speed_limit: _Float = None  # limit of the tip's speed [m/s], beside an acceleration limit
    mode: Mode = "converged"  # network at a step: settled, or lagging behind in continuous time
    kinetic: Kinetic = "identity"  # matrix G of the kinetic index; identity is the paper's
    gain: float = 10.2  # feedback gain of the position and the orientation error [1/s]
    tracking: Tracking = "paper"  # target of a step: at its time (paper) or at its end (next)
    next_gain: _Float = None  # feedback gain of --tracking next [1/s] (none: one over the period)
    policy: Policy = "slow"  # action at a step without a solution
    motion: Motion = "euler"  # integrator of the joint velocity
    noise: float = 0.0  # standard deviation of the noise: velocity [rad/s], measurement [rad]
    noise_at: NoiseEntry = "velocity"  # quantity that the noise is added to
    filter_window: int = 1  # number of samples in the moving average of the joint velocity
    csv: bool = False  # write every sample of the record as a table too, record.csv
    plots: bool = True  # draw the figures


@dataclass(frozen=True)
class PhysicsOptions(TrackOptions):
    """Draw a path with an arm that has masses and motors, in MuJoCo.

    A torque controller follows the network's joint velocities, and every step is checked. There
    are no disturbances unless asked for.
    """

    command: ClassVar[str] = "physics"
    out: Path = Path("runs/physics")  # folder of the results
    dt: float = 1e-3  # control period [s]
    physics_dt: float = 2.5e-4  # time step of the physics [s], at most 1e-3
    disturb: bool = False  # apply the next five disturbances, each of the size in brackets
    mass_error: _Float = None  # relative error of each link's mass [1] (0.1)
    friction: _Float = None  # ratio of the Coulomb friction to the torque limit [1] (0.01)
    encoder_noise: _Float = None  # standard deviation of the measured joint position [rad] (1e-05)
    encoder_bits: _Int = None  # resolution of an encoder [bits a turn] (18)
    delay: _Int = None  # delay of a velocity command [control periods] (1)
    push: _Floats = ()  # force X Y Z on the tip, along the world's axes [N]
    push_at: float = 5.0  # start time of the push [s]
    push_for: float = 0.2  # duration of the push [s]
    pictures: bool = True  # draw pictures of the arm
    video: bool = True  # make a video


@dataclass(frozen=True)
class ExportOptions(TrackOptions):
    """Write the controller of a run as C99: one file without dependencies, and its tests.

    It takes the settings file of a run; options that do not shape a controller have no effect.
    """

    command: ClassVar[str] = "export"
    also_reads: ClassVar[tuple[str, ...]] = ("track",)
    out: Path = Path("controller")  # folder of the C files


@dataclass(frozen=True)
class SweepOptions(RunOptions):
    """Options of every command that carries out many runs."""

    workers: _Int = None  # number of processes (one for each core)


@dataclass(frozen=True)
class PaperOptions(SweepOptions):
    """Run every experiment of the paper and put each number beside the paper's.

    An interrupted sweep resumes.
    """

    command: ClassVar[str] = "paper"
    out: Path = Path("runs/paper")  # folder of the results
    quick: bool = False  # run 1 s and 5 seeds only, to see that all works
    seeds: _Int = None  # number of noises in Table II (100)
    duration: _Float = None  # length of each run [s] (10)
    weight: _Float = None  # run the column of Table I of this weight xi, in [0, 1], alone
    dask: _Name = None  # address of a Dask scheduler, or local to start one here
    plots: bool = True  # draw the figures


@dataclass(frozen=True)
class NoiseOptions(SweepOptions):
    """Compare the countermeasures against noise of the joint velocity.

    The report puts the error against the smoothness of the command. An interrupted sweep resumes.
    """

    command: ClassVar[str] = "noise"
    out: Path = Path("runs/noise")  # folder of the results
    seeds: int = 100  # number of noises
    duration: float = 2.0  # length of each run [s]


@dataclass(frozen=True)
class AtlasOptions(SweepOptions):
    """Compare the networks of the field at equal work: tables, a figure, verdicts and cards.

    A part of one's own is named as module:NAME or file.py:NAME. An interrupted sweep resumes.
    """

    command: ClassVar[str] = "atlas"
    out: Path = Path("runs/atlas")  # folder of the results
    whole: bool = False  # run 100 seeds and all schemes: hours in place of minutes
    seeds: _Int = None  # number of noises with the first scheme (5, whole: 100)
    other_seeds: _Int = None  # number of noises with the other schemes and budgets (3)
    networks: _Names = ()  # names of the networks (none, or your own alone: all others too)
    schemes: _Names = ()  # names of the schemes (none: the first, whole: all)
    references: _Names = ()  # names of the paths (none: all)
    disturbances: _Names = ()  # names of the disturbances (none: all)
    work: tuple[float, ...] = (3e3, 1e4, 3e4)  # work a control period [operations]
    plots: bool = True  # draw the figure


@dataclass(frozen=True)
class ViewOptions:
    """Replay a run in the browser, or let the arm follow a target that is dragged."""

    command: ClassVar[str] = "view"
    run: Positional[Annotated[Path | None, arg(metavar="[RUN]", help_behavior_hint="")]] = None
    """folder or record of a run (none: live)"""
    robot: _Name = None  # robot, by its name or by its file (none: the record's, or iiwa7)
    tip: _Name = None  # frame that follows the target (none: the record's, or the chain's end)
    lock: _Names = ()  # names of the joints that are held still (none: the run's)
    tool: _Floats = ()  # tool frame in the tip frame: X Y Z R P Y [m, rad] (none: the run's)
    host: str = "127.0.0.1"  # address of the page; 0.0.0.0 lets other machines in
    port: int = 8080  # port of the page; 0 takes a free one
    verbose: _Verbose = False  # print the traceback of an error too


@dataclass(frozen=True)
class SolveOptions:
    """Solve the quadratic program in an .npz file.

    The file holds the arrays P and q, and if need be G and h, A and b, lb, ub.
    """

    command: ClassVar[str] = "solve"
    file: Positional[_Path] = None  # program, written with numpy.savez
    tol: float = 1e-9  # largest residual of a solution [program's units]
    check: Check = "none"  # reference solvers that check the solution, or a rigorous proof
    out: _Path = None  # .npz file of the solution
    quiet: _Quiet = False  # print nothing but the reason of a failure
    verbose: _Verbose = False  # print the multipliers, and the traceback of an error too


@dataclass(frozen=True)
class WarmUpOptions:
    """Compile everything that a run needs, once for all later runs."""

    command: ClassVar[str] = "warm-up"
    quiet: _Quiet = False  # hide the progress bar


@dataclass(frozen=True)
class CompletionOptions:
    """Print completion for a shell: bash, zsh or tcsh."""

    command: ClassVar[str] = "completion"
    shell: Positional[Annotated[str, arg(metavar="SHELL", help_behavior_hint="")]] = ""
    """shell that completes: bash, zsh or tcsh"""


_KINDS: tuple[Any, ...] = (
    TrackOptions,
    PaperOptions,
    NoiseOptions,
    AtlasOptions,
    PhysicsOptions,
    ExportOptions,
    ViewOptions,
    SolveOptions,
    WarmUpOptions,
    CompletionOptions,
)
COMMANDS: dict[str, type[Any]] = {kind.command: kind for kind in _KINDS}
"""Options of each command by its name; the module of that name holds its function ``run``."""

EXIT_CODES = (
    "Exit code 0: done, and every check agreed; 1: a step or a check failed, or a run was not "
    "completed; 2: bad input, or a package is missing; 130, 143: ended by Ctrl-C, SIGTERM."
)
