"""Options of every command: one dataclass a command, one line an option.

The comment behind a field is its help on the command line, its name is its key in a settings file,
and the first line of a class is the command's entry in the list of commands.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from tyro.conf import FlagCreatePairsOff, Positional, arg

from iiwa_dnn.control.controller import Mode
from iiwa_dnn.control.policies import Policy
from iiwa_dnn.references import Heart
from iiwa_dnn.references.turning import TILT
from iiwa_dnn.references.waypoints import SPEED
from iiwa_dnn.schemes.costs import Kinetic
from iiwa_dnn.schemes.parts import Tracking
from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NoiseEntry
from iiwa_dnn.simulation.motion import Motion

Check = Literal["proxqp", "osqp", "both", "none"]
SHELLS = ("bash", "zsh", "tcsh")

# The words in capitals stand for the value in the help. An empty hint: there is no default to show.
_Flag = Annotated[bool, arg(help_behavior_hint=""), FlagCreatePairsOff]
_Quiet = Annotated[bool, arg(aliases=["-q"], help_behavior_hint=""), FlagCreatePairsOff]
_Verbose = Annotated[bool, arg(aliases=["-v"], help_behavior_hint=""), FlagCreatePairsOff]
_Numbers = tuple[float, ...]
_Vector = Annotated[_Numbers, arg(metavar="X Y Z")]
_Normal = Annotated[_Numbers, arg(metavar="X Y Z", help_behavior_hint="")]
_Pose = Annotated[_Numbers, arg(metavar="X Y Z R P Y", help_behavior_hint="")]
_Angle = Annotated[float, arg(metavar="RAD")]
_TipSpeed = Annotated[float, arg(metavar="M/S")]
_Push = Annotated[_Numbers | None, arg(metavar="FX FY FZ", help_behavior_hint="")]
_Angles = Annotated[_Numbers, arg(metavar="RAD", help_behavior_hint="")]
_Schemes = Annotated[tuple[str, ...], arg(metavar="NAME", help_behavior_hint="")]
_Counts = Annotated[tuple[int, ...], arg(metavar="N")]
_Names = Annotated[tuple[str, ...], arg(metavar="JOINT", help_behavior_hint="")]
_Frames = Annotated[tuple[str, ...], arg(metavar="FRAME", help_behavior_hint="")]
_Limit = Annotated[str | None, arg(metavar="RAD", help_behavior_hint="")]
_AnyLimit = Annotated[str | None, arg(metavar="X|robot", help_behavior_hint="")]
_Robot = Annotated[str, arg(metavar="NAME|URDF")]
_AnyRobot = Annotated[str | None, arg(metavar="NAME|URDF", help_behavior_hint="")]
_Frame = Annotated[str | None, arg(metavar="FRAME", help_behavior_hint="")]
_Path = Annotated[str, arg(metavar="PATH")]
_File = Annotated[Path | None, arg(metavar="FILE", help_behavior_hint="")]
_Form = Annotated[Orientation, arg(metavar="FORM")]
_Mode = Annotated[Mode, arg(metavar="MODE")]
_Matrix = Annotated[Kinetic, arg(metavar="G")]
_Tracking = Annotated[Tracking, arg(metavar="TARGET")]
_AnyGain = Annotated[float | None, arg(metavar="X", help_behavior_hint="")]
_Policy = Annotated[Policy, arg(metavar="POLICY")]
_Motion = Annotated[Motion, arg(metavar="METHOD")]
_Where = Annotated[NoiseEntry, arg(metavar="WHERE")]
_Run = Annotated[Path | None, arg(metavar="RUN", help_behavior_hint="")]
_Solver = Annotated[Check, arg(metavar="SOLVER")]
_AnyCount = Annotated[int | None, arg(metavar="N", help_behavior_hint="")]
_AnyTime = Annotated[float | None, arg(metavar="S", help_behavior_hint="")]
_AnyShare = Annotated[float | None, arg(metavar="SHARE", help_behavior_hint="")]
_AnyAngle = Annotated[float | None, arg(metavar="RAD", help_behavior_hint="")]
_Number = Annotated[float, arg(metavar="X")]
_Length = Annotated[float, arg(metavar="M")]
_Speed = Annotated[float, arg(metavar="RAD/S")]
Count = Annotated[int, arg(metavar="N")]
Folder = Annotated[Path, arg(metavar="DIR")]
Time = Annotated[float, arg(metavar="S")]


@dataclass(frozen=True)
class RunOptions:
    """Options of every command that leaves a folder."""

    command: ClassVar[str]
    settings: _File = None  # TOML file of options; those given here come first
    out: Folder = Path("runs")  # folder that the results are written to
    overwrite: _Flag = False  # write over a folder that holds another run or other files
    quiet: _Quiet = False  # print nothing but the reasons of a failure
    verbose: _Verbose = False  # print settings, written files and the traceback of an error too


@dataclass(frozen=True)
class TrackOptions(RunOptions):
    """Draw a path with a robot arm, every step checked; by default the paper's heart."""

    command: ClassVar[str] = "track"
    out: Folder = Path("runs/heart")  # folder that the results are written to
    robot: _Robot = "iiwa7"  # robot, by its name or by its file: URDF, xacro, MJCF
    tip: _Frame = None  # frame that follows the path (none: the end of the chain)
    frames: _Frames = ()  # names of further frames, such as a second arm's, that draw the path too
    lock: _Names = ()  # names of the joints that are held still
    tool: _Pose = ()  # pose of a tool in that frame, which takes its place [m, rad] (none: no tool)
    q0: _Angles = ()  # joint positions at the start [rad] (none: the robot's start posture)
    joint_limit: _Limit = None  # position limit of all joints [rad], or datasheet (iiwa7: 2.5)
    reference: _Path = "heart"
    """path: heart, circle, line, lissajous, cone, tilting-circle, plane-heart, sphere-heart, CSV"""
    scale: _Length = Heart.scale  # factor a of the hearts, whose width is 32 a [m]
    radius: _Length = 0.05  # radius of the circles [m]
    angle: _Angle = TILT  # tilt of the tool on the cone and the tilting circle [rad]
    sphere: _Length = 0.2  # radius of the sphere under the sphere-heart [m]
    normal: _Normal = ()  # outward normal at the start, of plane and sphere (none: the tool's axis)
    tool_speed: _TipSpeed = SPEED  # speed of the tip along a CSV file without times [m/s]
    offset: _Vector = (0.1, 0.0, 0.0)  # vector from the line's start to its far end [m]
    amplitudes: _Vector = (0.05, 0.05, 0.0)  # amplitudes of the Lissajous figure [m]
    period: Time = Heart.period  # time of one round on the path [s]; a CSV file has its own
    obstacles: _File = None  # TOML file of obstacles; the arm avoids them and itself
    weight: _Number = 0.2  # weight xi of the kinetic index against the joint drift, in [0, 1]
    orientation: _Form = "so3"  # form of the orientation task: so3, block (the paper's) or none
    dt: Time = 1e-4  # control period [s]
    duration: _AnyTime = None  # length of the run [s] (none: one round on the path)
    seed: Count = 0  # seed of the random numbers
    check: _Solver = "proxqp"  # solvers that check every step: proxqp, osqp, both or none
    tolerance: _Speed = 1e-6  # largest gap between the network and a checking solver [rad/s]
    speed: _Number = 1.0  # velocity limits, as a share of the data sheet's
    acceleration_limit: _AnyLimit = None  # acceleration limit of all joints [rad/s^2], or robot
    jerk_limit: _AnyLimit = None  # jerk limit of all joints [rad/s^3], or robot (its own)
    mode: _Mode = "converged"  # converged: network settled at every step; continuous: lagging
    kinetic: _Matrix = "identity"  # matrix G of the kinetic index: identity (the paper's), inertia
    gain: _Number = 10.2  # feedback gain of the position and the orientation error [1/s]
    tracking: _Tracking = "paper"  # target of a step: paper (at its time) or next (at its end)
    next_gain: _AnyGain = None  # feedback gain of --tracking next [1/s] (none: one over the period)
    integral_gain: _Number = 0.0  # feedback gain of the error's integral [1/s^2]
    policy: _Policy = "slow"  # action at a step without a solution: slow, relax, stop or raise
    motion: _Motion = "euler"  # integration of the joint velocity: euler, midpoint or rk4
    noise: _Speed = 0.0  # standard deviation of the noise [rad/s]; in the measurement [rad]
    noise_at: _Where = "velocity"  # noisy quantity: velocity, network (its state) or measurement
    filter_window: Count = 1  # number of samples in the moving average of the joint velocity
    plots: _Flag = True  # draw no figures


@dataclass(frozen=True)
class PhysicsOptions(TrackOptions):
    """Draw a path with an arm that has masses and motors, in MuJoCo.

    A torque controller follows the network's joint velocities, and every step is checked. There
    are no disturbances unless asked for.
    """

    command: ClassVar[str] = "physics"
    out: Folder = Path("runs/physics")  # folder that the results are written to
    dt: Time = 1e-3  # control period [s]
    physics_dt: Time = 2.5e-4  # time step of the physics [s], at most 1e-3
    disturb: _Flag = False  # switch on the next five, each of the size in brackets
    mass_error: _AnyShare = None  # error of each link's mass, as a share of it (0.1)
    friction: _AnyShare = None  # Coulomb friction, as a share of the torque limit (0.01)
    encoder_noise: _AnyAngle = None  # standard deviation of an encoder's reading [rad] (1e-05)
    encoder_bits: _AnyCount = None  # resolution of an encoder [bits a turn] (18)
    delay: _AnyCount = None  # delay of a velocity command [control periods] (1)
    push: _Push = None  # force that pushes the tip, along the world's axes [N]
    push_at: Time = 5.0  # time at which the push begins [s]
    push_for: Time = 0.2  # time that the push lasts [s]
    pictures: _Flag = True  # draw no pictures of the arm
    video: _Flag = True  # make no video


@dataclass(frozen=True)
class SweepOptions(RunOptions):
    """Options of every command that carries out many runs."""

    workers: _AnyCount = None  # number of processes (one for each core)


@dataclass(frozen=True)
class PaperOptions(SweepOptions):
    """Run every experiment of the paper and put each number beside the paper's.

    An interrupted sweep resumes.
    """

    command: ClassVar[str] = "paper"
    out: Folder = Path("runs/paper")  # folder that the results are written to
    quick: _Flag = False  # run 1 s and 5 seeds only, to see that all works
    seeds: _AnyCount = None  # number of noises in Table II (100)
    duration: _AnyTime = None  # length of each run [s] (10)
    dask: Annotated[str | None, arg(metavar="ADDRESS", help_behavior_hint="")] = None
    """address of a Dask scheduler, or local to start one here"""
    plots: _Flag = True  # draw no figures


@dataclass(frozen=True)
class NoiseOptions(SweepOptions):
    """Compare the countermeasures against noise of the joint velocity.

    The report puts the error against the smoothness of the command. An interrupted sweep resumes.
    """

    command: ClassVar[str] = "noise"
    out: Folder = Path("runs/noise")  # folder that the results are written to
    seeds: Count = 100  # number of noises
    duration: Time = 2.0  # length of each run [s]


@dataclass(frozen=True)
class AtlasOptions(SweepOptions):
    """Compare the networks of the field at equal compute: tables, a figure and verdicts.

    An interrupted sweep resumes.
    """

    command: ClassVar[str] = "atlas"
    out: Folder = Path("runs/atlas")  # folder that the results are written to
    seeds: Count = 100  # number of noises with the first scheme
    other_seeds: Count = 10  # number of noises with the other schemes and budgets
    schemes: _Schemes = ()  # names of the schemes (none: all)
    networks: _Schemes = ()  # names of the networks (none: all)
    evaluations: _Counts = (1, 2, 4, 8, 16)  # budgets: evaluations of a network a control period
    plots: _Flag = True  # draw no figure


@dataclass(frozen=True)
class ViewOptions:
    """Replay a run in the browser, or let the arm follow a target that is dragged."""

    command: ClassVar[str] = "view"
    run: Positional[_Run] = None  # folder or record of a run (none: live)
    robot: _AnyRobot = None  # robot, by its name or by its URDF file (none: the record's, or iiwa7)
    tip: _Frame = None  # frame that follows the target (none: the record's, or the chain's end)
    lock: _Names = ()  # names of the joints that are held still
    tool: _Pose = ()  # pose of a tool in that frame, which takes its place [m, rad] (none: no tool)
    host: Annotated[str, arg(metavar="ADDRESS")] = "127.0.0.1"
    """address to listen on; 0.0.0.0 lets other machines in"""
    port: Count = 8080  # port to listen on; 0 takes a free one
    verbose: _Verbose = False  # print the traceback of an error too


@dataclass(frozen=True)
class SolveOptions:
    """Solve the quadratic program in an .npz file.

    The file holds the arrays P and q, and if need be G and h, A and b, lb, ub.
    """

    command: ClassVar[str] = "solve"
    file: Positional[_File] = None  # program, written with numpy.savez
    tol: _Number = 1e-9  # largest residual of a solution, in the program's units
    check: _Solver = "none"  # solvers that are asked too: proxqp, osqp or both
    out: _File = None  # .npz file that the solution is written to
    quiet: _Quiet = False  # print only the reason if there is no solution
    verbose: _Verbose = False  # print the multipliers, and the traceback of an error too


@dataclass(frozen=True)
class WarmUpOptions:
    """Compile everything that a run needs, once for all later runs."""

    command: ClassVar[str] = "warm-up"
    quiet: _Quiet = False  # print no progress


@dataclass(frozen=True)
class CompletionOptions:
    """Print completion for a shell: bash, zsh or tcsh."""

    command: ClassVar[str] = "completion"
    shell: Positional[Annotated[str, arg(metavar="SHELL", help_behavior_hint="")]] = ""
    """shell that completes: bash, zsh or tcsh"""


COMMANDS: dict[str, type[Any]] = {
    kind.command: kind
    for kind in (
        TrackOptions, PaperOptions, NoiseOptions, AtlasOptions, PhysicsOptions, ViewOptions,
        SolveOptions, WarmUpOptions, CompletionOptions,
    )
}  # fmt: skip
"""Options of each command by its name; the module of that name holds its function ``run``."""

EXIT_CODES = (
    "Exit code 0: done, and every check agreed; 1: a step or a check failed, or a run was not "
    "completed; 2: bad input, or a package is missing; 130, 143: ended by Ctrl-C, SIGTERM."
)
