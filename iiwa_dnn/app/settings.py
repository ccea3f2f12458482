"""What each command can be told: one dataclass a command, its fields the options.

The text under a field is its help on the command line; its name is its key in a settings file.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from tyro.conf import FlagCreatePairsOff, Positional, arg

from iiwa_dnn.control.controller import Mode
from iiwa_dnn.control.policies import Policy
from iiwa_dnn.schemes.costs import Kinetic
from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NoiseEntry
from iiwa_dnn.simulation.motion import Motion

Check = Literal["proxqp", "osqp", "both", "none"]

SettingsFile = Annotated[Path | None, arg(metavar="FILE", help_behavior_hint="")]
Quiet = Annotated[bool, arg(aliases=["-q"], help_behavior_hint=""), FlagCreatePairsOff]
Verbose = Annotated[bool, arg(aliases=["-v"], help_behavior_hint=""), FlagCreatePairsOff]
Switch = Annotated[bool, arg(help_behavior_hint=""), FlagCreatePairsOff]
Text = Annotated[str | None, arg(metavar="NAME", help_behavior_hint="")]
Count = Annotated[int | None, arg(metavar="N", help_behavior_hint="")]
Names = Annotated[tuple[str, ...], arg(metavar="JOINT", help_behavior_hint="")]
Posture = Annotated[tuple[float, ...], arg(metavar="RAD", help_behavior_hint="")]
Limit = Annotated[str | None, arg(metavar="RAD", help_behavior_hint="")]
Share = Annotated[float | None, arg(metavar="SHARE", help_behavior_hint="")]
Rows = Annotated[Orientation, arg(metavar="ROWS")]
Reference = Annotated[Check, arg(metavar="SOLVER")]
Folder = Annotated[Path, arg(metavar="DIR")]


@dataclass(frozen=True)
class TrackSettings:
    """Draw the paper's heart with a robot arm; the network solves every step's quadratic
    program and other solvers check it. Defaults: the paper's experiment. Exit code 0: all
    checks agreed; 1: a step did not, or broke a limit; 2: bad input.
    """  # noqa: D205

    settings: SettingsFile = None
    """take what is not given here from a TOML file"""
    robot: Annotated[str, arg(metavar="NAME|URDF")] = "iiwa7"
    """robot"""
    tip: Annotated[str | None, arg(metavar="FRAME", help_behavior_hint="")] = None
    """frame that draws (the end of the chain)"""
    lock: Names = ()
    """joints to hold still"""
    q0: Posture = ()
    """start (the paper's for iiwa7)"""
    mode: Annotated[Mode, arg(metavar="MODE")] = "converged"
    """converged or continuous"""
    weight: Annotated[float, arg(metavar="XI")] = 0.2
    """xi in [0, 1]"""
    orientation: Rows = "so3"
    """so3, block, or none: position only"""
    kinetic: Annotated[Kinetic, arg(metavar="G")] = "identity"
    """identity or inertia"""
    joint_limit: Limit = None
    """of every joint, or datasheet (iiwa7: 2.5)"""
    speed: Annotated[float, arg(metavar="SHARE")] = 1.0
    """velocity limits, of the data sheet's"""
    policy: Annotated[Policy, arg(metavar="POLICY")] = "slow"
    """without a solution: slow, relax, stop, raise"""
    dt: Annotated[float, arg(metavar="S")] = 1e-4
    """control period"""
    duration: Annotated[float, arg(metavar="S")] = 10.0
    """length"""
    scale: Annotated[float, arg(metavar="M")] = 3.45e-3
    """heart's a"""
    motion: Annotated[Motion, arg(metavar="METHOD")] = "euler"
    """euler, midpoint or rk4"""
    noise: Annotated[float, arg(metavar="RAD/S")] = 0.0
    """standard deviation"""
    noise_at: Annotated[NoiseEntry, arg(metavar="WHERE")] = "velocity"
    """velocity, network or measurement [rad]"""
    filter_window: Annotated[int, arg(metavar="N")] = 1
    """moving average"""
    gain: Annotated[float, arg(metavar="1/S")] = 10.2
    """feedback of position and orientation"""
    integral_gain: Annotated[float, arg(metavar="1/S^2")] = 0.0
    """feedback of the error's integral"""
    seed: Annotated[int, arg(metavar="N")] = 0
    """of the noise"""
    check: Reference = "proxqp"
    """proxqp, osqp, both or none"""
    tolerance: Annotated[float, arg(metavar="RAD/S")] = 1e-6
    """gap to the reference"""
    out: Folder = Path("runs/heart")
    """where to"""
    plots: Switch = True
    """write no figures"""
    quiet: Quiet = False
    """no progress bar and no summary"""
    verbose: Verbose = False
    """tell what is run and written, and where an error is"""


@dataclass(frozen=True)
class PaperSettings:
    """Run every experiment of the paper and put each number beside the paper's. A run that was
    cut short goes on where it was. Exit code 0: all runs completed; 1: one was not; 2: bad
    input.
    """  # noqa: D205

    settings: SettingsFile = None
    """take what is not given here from a TOML file"""
    quick: Switch = False
    """1 s of motion and 5 seeds: to see that all works"""
    seeds: Count = None
    """noises in Table II (100)"""
    duration: Annotated[float | None, arg(metavar="S", help_behavior_hint="")] = None
    """length of each run (10)"""
    workers: Count = None
    """processes (one for each core)"""
    dask: Annotated[str | None, arg(metavar="ADDRESS", help_behavior_hint="")] = None
    """a Dask cluster, or local: start one here"""
    out: Folder = Path("runs/paper")
    """where to"""
    plots: Switch = True
    """write no figures"""
    quiet: Quiet = False
    """no progress bar and no summary"""
    verbose: Verbose = False
    """tell what is run and written, and where an error is"""


@dataclass(frozen=True)
class PhysicsSettings:
    """Draw the paper's heart with an arm that has masses and motors, in MuJoCo: the network's
    velocities, a torque loop under them, every step checked. Disturbances: none by default.
    Exit code 0: all checks agreed; 1: a step did not, or broke a limit; 2: bad input, or a
    package is missing.
    """  # noqa: D205

    settings: SettingsFile = None
    """take what is not given here from a TOML file"""
    robot: Annotated[str, arg(metavar="NAME|URDF")] = "iiwa7"
    """robot"""
    tip: Annotated[str | None, arg(metavar="FRAME", help_behavior_hint="")] = None
    """frame that draws (the end of the chain)"""
    q0: Posture = ()
    """start (the paper's for iiwa7)"""
    weight: Annotated[float, arg(metavar="XI")] = 0.2
    """xi in [0, 1]"""
    orientation: Rows = "so3"
    """so3, block, or none: position only"""
    joint_limit: Limit = None
    """of every joint, or datasheet (iiwa7: 2.5)"""
    dt: Annotated[float, arg(metavar="S")] = 1e-3
    """control period"""
    physics_dt: Annotated[float, arg(metavar="S")] = 2.5e-4
    """at most 1e-3"""
    duration: Annotated[float, arg(metavar="S")] = 10.0
    """length"""
    scale: Annotated[float, arg(metavar="M")] = 3.45e-3
    """heart's a"""
    seed: Annotated[int, arg(metavar="N")] = 0
    """of mass errors and encoder noise"""
    disturb: Switch = False
    """the next five at the size in brackets"""
    mass_error: Share = None
    """of each link, up or down (0.1)"""
    friction: Share = None
    """of the torque limit (0.01)"""
    encoder_noise: Annotated[float | None, arg(metavar="RAD", help_behavior_hint="")] = None
    """standard deviation (1e-05)"""
    encoder_bits: Count = None
    """a turn has 2^N (18)"""
    delay: Count = None
    """control periods, of a command (1)"""
    push: Annotated[
        tuple[float, float, float] | None, arg(metavar="FX FY FZ", help_behavior_hint="")
    ] = None
    """force on the tip, in the world's axes [N]"""
    push_at: Annotated[float, arg(metavar="S")] = 5.0
    """when"""
    push_for: Annotated[float, arg(metavar="S")] = 0.2
    """how long"""
    check: Reference = "proxqp"
    """proxqp, osqp, both or none"""
    tolerance: Annotated[float, arg(metavar="RAD/S")] = 1e-6
    """gap to the reference"""
    out: Folder = Path("runs/physics")
    """where to"""
    plots: Switch = True
    """draw no curves"""
    pictures: Switch = True
    """draw no arm"""
    video: Switch = True
    """make no video"""
    quiet: Quiet = False
    """no progress bar and no summary"""
    verbose: Verbose = False
    """tell what is run and written, and where an error is"""


@dataclass(frozen=True)
class NoiseSettings:
    """Compare what helps against noise and other disturbances of the joint velocity: error
    against smoothness of the command. A run that was cut short goes on where it was. Exit
    code 0: all runs completed; 1: one was not; 2: bad input.
    """  # noqa: D205

    settings: SettingsFile = None
    """take what is not given here from a TOML file"""
    seeds: Annotated[int, arg(metavar="N")] = 100
    """noises"""
    duration: Annotated[float, arg(metavar="S")] = 2.0
    """of each run"""
    workers: Count = None
    """processes (one for each core)"""
    out: Folder = Path("runs/noise")
    """where to"""
    quiet: Quiet = False
    """no progress bar and no table"""
    verbose: Verbose = False
    """tell what is written, and where an error is"""


@dataclass(frozen=True)
class ViewSettings:
    """Replay a run in the browser, or drive the arm live: drag its target while the controller
    follows. Exit code 0: ended by Ctrl-C; 2: bad input, or a package is missing.
    """  # noqa: D205

    run: Positional[Annotated[Path | None, arg(metavar="RUN", help_behavior_hint="")]] = None
    """a run's folder or record (none: live)"""
    robot: Annotated[str | None, arg(metavar="NAME|URDF", help_behavior_hint="")] = None
    """robot (the record's, or iiwa7)"""
    tip: Annotated[str | None, arg(metavar="FRAME", help_behavior_hint="")] = None
    """frame that follows (the record's, or the chain's end)"""
    lock: Names = ()
    """joints to hold still"""
    host: Annotated[str, arg(metavar="ADDRESS")] = "127.0.0.1"
    """0.0.0.0 lets others in"""
    port: Annotated[int, arg(metavar="N")] = 8080
    """0 takes a free one"""
    verbose: Verbose = False
    """tell where an error is"""


@dataclass(frozen=True)
class SolveSettings:
    """Solve the quadratic program in an .npz file of arrays: P and q, and of G and h, A and b,
    lb, ub those that there are. Exit code 0: solved; 1: no answer within the tolerance; 2: bad
    input.
    """  # noqa: D205

    file: Positional[Annotated[Path, arg(metavar="FILE")]]
    """the program, written with numpy.savez"""
    tol: Annotated[float, arg(metavar="TOL")] = 1e-9
    """largest residual that counts as solved"""
    check: Reference = "none"
    """also ask proxqp, osqp or both"""
    out: Annotated[Path | None, arg(metavar="FILE", help_behavior_hint="")] = None
    """write the answer there too, as .npz"""
    quiet: Quiet = False
    """print nothing but why there is no answer"""
    verbose: Verbose = False
    """print the multipliers too, and where an error is"""
