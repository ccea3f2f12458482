"""``track``, ``physics`` and ``export``: a run, or its controller, from words and tables.

The keys of the tables are the arguments of the package's functions and classes. What has no word is
set by its table and key.
"""

import sys
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, make_dataclass, replace
from functools import partial, reduce
from inspect import signature
from pathlib import Path
from typing import Annotated, Any, Literal

from tqdm import tqdm
from tyro.conf import Positional, UseAppendAction, arg

from iiwa_dnn import (
    AccelerationLimits,
    Circle,
    CollisionAvoidance,
    Cone,
    Configuration,
    Controller,
    CrossCheck,
    DoubleIndicator,
    Heart,
    InvalidInputError,
    JerkLimits,
    Line,
    Lissajous,
    MujocoPlant,
    NotFoundError,
    Robot,
    Tilting,
    TipSpeedLimit,
    Waypoints,
    checks,
    export as exports,
    failures,
    load_robot,
    simulate,
)
from iiwa_dnn.app.command_line import Flag, Folder, Quiet, check_folder, shown, write_settings
from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.errors import RunInterrupted
from iiwa_dnn.files import one_line, parse_toml, read_toml
from iiwa_dnn.results.pictures import save_pictures
from iiwa_dnn.results.plots import CAPTIONS
from iiwa_dnn.results.report import save_run, summary
from iiwa_dnn.robot.mujoco_model import prepare_renderer
from iiwa_dnn.robot.robot import model_limits
from iiwa_dnn.schemes.limits import RateLimits, own_rate_limits
from iiwa_dnn.simulation import Disturbances, IdealPlant, Push, count_steps
from iiwa_dnn.studies.paper import published

Tables = dict[str, Any]
Choices = Mapping[str, Callable[..., Any]]

TABLES = ("robot", "reference", "scheme", "limits", "run", "plant")
"""Tables of the settings file."""

BOUNDS = ("position", "speed", "lower", "upper", "velocity")
"""Keys of the table [limits] that change the robot's own limits; all others are parts."""

OUTPUTS = (
    "report.md",
    "video.mp4",
    *(f"{name}{suffix}" for name in CAPTIONS for suffix in (".png", ".pdf")),
)
"""Files of a run that another one in its folder may not write."""

CHECKS = {"both": ("proxqp", "osqp"), "none": ()}


def cross_check(solver: str = "proxqp", tolerance: float = 1e-6) -> CrossCheck:
    """Make the check of a run from the name of a solver, or a word of `CHECKS`."""
    return CrossCheck(CHECKS.get(str(solver), (solver,)), tolerance)


def rate_limit(kind: type[RateLimits], limit: Any) -> RateLimits:
    """Make a limit of a kind from a number, one number a joint, or ``"robot"`` or ``"none"``."""
    return kind({"robot": None, "none": float("inf")}.get(str(limit), limit))


PLANTS: Choices = {"ideal": IdealPlant, "mujoco": MujocoPlant}
PATHS: dict[str, Callable[..., Any]] = {
    "heart": Heart,
    "circle": Circle,
    "line": Line,
    "lissajous": Lissajous,
    "cone": Cone,
    "tilting-circle": Tilting,
}
PARTS: Choices = {
    "reference.along": Circle,
    "limits.acceleration": partial(rate_limit, AccelerationLimits),
    "limits.jerk": partial(rate_limit, JerkLimits),
    "limits.tip_speed": TipSpeedLimit,
    "limits.obstacles": CollisionAvoidance.from_toml,
    "run.check": cross_check,
    "run.estimator": NoiseModel,
    "plant.disturbances": Disturbances,
    "plant.disturbances.push": Push,
}
"""Settings that stand for objects, by table and key: what makes the object."""

WORDS: dict[str, tuple[str, Any, str, str]] = {
    "path": (
        "reference.name",
        Positional[str | None],  # type: ignore[misc] # an alias of Annotated
        "[PATH]",
        "heart, circle, line, lissajous, cone, tilting-circle or FILE.csv (heart)",
    ),
    "robot": ("robot.name", str | None, "NAME", "iiwa7, panda, ... or a URDF file (iiwa7)"),
    "tip": ("robot.tip", str | None, "FRAME", "frame that follows the path"),
    "lock": ("robot.locked", tuple[str, ...] | None, "JOINT ...", "joints held still; after PATH"),
    "q0": (
        "robot.q0",
        tuple[float, ...] | None,
        "X ...",
        "joint positions at the start [rad]; after PATH",
    ),
    "reference": ("reference.name", str | None, "NAME", "the path, as PATH"),
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
    "tracking": (
        "scheme.tracking",
        str | None,
        "WORD",
        "target of a step: paper, or next, at its end",
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
        "network at a step: converged or continuous (converged)",
    ),
    "dt": ("run.dt", float | None, "X", "control period [s] (1e-3; the paper's heart 1e-4)"),
    "duration": ("run.duration", float | None, "X", "length of the run [s] (one round)"),
    "policy": (
        "run.policy",
        str | None,
        "WORD",
        "at a step without solution: slow, relax or stop (slow)",
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
        "reference of a step: proxqp, osqp, both, proof, none, ...",
    ),
    "tolerance": (
        "run.check.tolerance",
        float | None,
        "X",
        "largest gap to the reference [rad/s] (1e-6)",
    ),
    "plant": ("plant.name", str | None, "NAME", "arm that moves: ideal or mujoco (ideal)"),
    "push": (
        "plant.disturbances.push.force",
        tuple[float, ...] | None,
        "X Y Z",
        "force on the tip at 5 s, in MuJoCo [N]",
    ),
}
"""Words of the commands with an arm: table and key, type, name of the value, and help."""


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


_FIELDS = [
    (name, Annotated[kind, shown(metavar, about)], None)
    for name, (_, kind, metavar, about) in WORDS.items()
]
Words: Any = Annotated[make_dataclass("Words", _FIELDS, bases=(Run,), frozen=True), arg(name="")]


def track(options: Words) -> int:
    """Draw a path with a robot arm, every step checked; by default the paper's heart.

    All further settings are arguments of the Python classes, given by --config or --set.
    Exit code 0: within limits and, unless continuous, solved and in agreement; 1: not so; 2: bad
    input.
    """
    tables = read_tables(options)
    arguments = build(tables)
    steps = count_steps(arguments["reference"], arguments["dt"], arguments.get("duration"))
    usual = Path("runs") / Path(tables["reference"]["name"]).stem
    folder = options.out or (usual if options.config is None else options.config.parent)
    draw_more = None
    if options.plots and tables["plant"].get("name") == "mujoco":
        prepare_renderer()  # what it needs is asked for before the run
        draw_more = partial(save_pictures, arguments["robot"])
    # Hidden if standard error is no terminal.
    with tqdm(total=steps, unit="step", disable=options.quiet or None) as bar:

        def proceed(done: int) -> None:
            """Check the folder once all arguments are found to be right; move the bar."""
            if done == 0:
                check_folder(folder, tables, options.overwrite)
            bar.update(done)

        interrupt = None
        try:
            record = simulate(**arguments, progress=proceed)
        except RunInterrupted as ended:
            interrupt = ended
            record = ended.record
    for name in OUTPUTS:  # those of an earlier run
        (folder / name).unlink(missing_ok=True)
    write_settings(folder, tables)
    plots = options.plots and interrupt is None
    metrics = save_run(record, folder, plots, draw_more, published(record.settings))
    reasons = failures(metrics)
    if not options.quiet:
        print(summary(metrics), f"written to {folder}", sep="\n")
    elif reasons:
        print(*reasons, sep="\n", file=sys.stderr)
    if interrupt is not None:
        raise interrupt
    return 1 if reasons else 0


def physics(options: Words) -> int:
    """Draw a path with an arm that has masses and motors, in MuJoCo, with pictures and a video."""
    usual = Path("runs") / "physics" if options.config is None else None
    return track(replace(options, plant=options.plant or "mujoco", out=options.out or usual))


def export(options: Words) -> int:
    """Write the controller of a run as C99: one file without dependencies, and its tests."""
    tables = read_tables(options)
    arguments = build(tables)
    if "filter_window" in arguments:
        raise InvalidInputError("filter_window", "is no part of a controller and is not exported")
    known = signature(Controller).parameters
    controller = Controller(**{key: arguments[key] for key in arguments if key in known})
    folder = options.out or Path("controller")
    check_folder(folder, tables, options.overwrite)
    write_settings(folder, tables)
    exports.c99(controller, folder, arguments["q0"])
    robot = controller.robot
    lower, upper, _ = model_limits(robot.model)
    if (robot.q_lower < lower).any() or (robot.q_upper > upper).any():
        line = "position limits lie beyond the robot's own"
        print(f"{line}; for a real arm take --joint-limit datasheet", file=sys.stderr)
    if tables["limits"].get("acceleration") == "none":
        line = "accelerations are not limited; for a real arm take --acceleration-limit robot"
        print(line, file=sys.stderr)
    if not options.quiet:
        print(f"written to {folder}; to test it: make -C {folder}")
    return 0


def read_tables(options: Any) -> Tables:
    """Merge the settings file, the words, and ``--set``: of two values the later counts.

    Raises:
        FileError: The file cannot be read.
        InvalidInputError: There is no such table, or a table or a name is none.
    """
    typical = asdict(Disturbances.typical()) if options.disturb else {}
    words = [(f"plant.disturbances.{key}", value) for key, value in typical.items()]
    words += [(place, getattr(options, name)) for name, (place, *_) in WORDS.items()]
    empty: Tables = {name: {} for name in TABLES}
    sources = [
        empty,
        {} if options.config is None else read_toml(options.config),
        *(_nested(place, value) for place, value in words if value is not None),
        *map(_read_setting, options.set),
        empty,  # refuses what is no table by now
    ]
    tables = reduce(_merge, sources)
    for name in tables:
        checks.one_of("table", name, TABLES)
    for table, key in (("robot", "name"), ("reference", "name"), ("limits", "obstacles")):
        if key in tables[table]:
            tables[table][key] = _absolute(f"{table}.{key}", tables[table][key])
    return tables


def _absolute(place: str, value: Any) -> str:
    """Return a name as it is, a file by its whole path, or raise an InvalidInputError."""
    if not isinstance(value, str):
        raise InvalidInputError(place, f"must be a name or a file, not {value!r}", value)
    return str(Path(value).resolve()) if Path(value).suffix else value


def _read_setting(text: str) -> Tables:
    """Read ``TABLE.KEY=VALUE``, the value in TOML, or a text without quotation marks."""
    place, _, value = text.partition("=")
    with suppress(ValueError):
        value = parse_toml(f"value = {value}")["value"]
    return _nested(place, value)


def _nested(place: str, value: Any) -> Tables:
    """Return tables in which a value stands at ``TABLE.KEY``."""
    table, _, key = place.partition(".")
    return {table: _nested(key, value)} if key else {table: value}


def _merge(first: Tables, second: Tables, name: str = "") -> Tables:
    """Return two tables of this name as one; tables inside of both are merged too.

    Raises:
        InvalidInputError: The first, or a value that a table would replace, is no table.
    """
    if not isinstance(first, dict):
        raise InvalidInputError(name, f"must be a table, not {first!r}", first)
    inner = {
        key: _merge(first[key], value, key)
        for key, value in second.items()
        if isinstance(value, dict) and key in first
    }
    return {**first, **second, **inner}


def build(tables: Tables) -> Tables:
    """Return the arguments of `simulate`, and write defaults that depend on others into the tables.

    Raises:
        IiwaDnnError: A setting is unknown or out of range.
    """
    table = tables["robot"]
    sheet = load(table)
    robot, parts = bounded(sheet, tables["limits"])
    q0 = checks.finite_array("q0", table.get("q0", sheet.start_posture()), (robot.dof,))
    table |= {"name": table.get("name", "iiwa7"), "q0": q0.tolist()}
    name = tables["reference"].setdefault("name", "heart")
    file = name if str(name).lower().endswith(".csv") else "FILE.csv"
    paths = PATHS | {file: partial(Waypoints.from_csv, file)}
    reference = choose(paths, "reference", tables["reference"])
    if getattr(reference, "quaternions", None) is None:
        reference = reference.anchored(Configuration(robot, q0))
    scheme = call(partial(DoubleIndicator, extra_limits=tuple(parts)), "scheme", tables["scheme"])
    tables["plant"].setdefault("name", "mujoco" if tables["plant"] else "ideal")
    plant = choose(PLANTS, "plant", tables["plant"])
    run = tables["run"]
    is_paper = (robot.name, name, plant.exact) == ("iiwa7", "heart", True)
    run.setdefault("dt", 1e-4 if is_paper else 1e-3)
    made = {"robot": robot, "scheme": scheme, "reference": reference, "q0": q0, "plant": plant}
    known = [key for key in signature(simulate).parameters if key not in (*made, "progress")]
    return {**made, **objects(known, "run", run)}


def call(
    function: Callable[..., Any], table: str, values: Tables, others: Collection[str] = ()
) -> Any:
    """Call a function with the values of a table but some `others`; errors as of `objects`."""
    given = objects((*others, *signature(function).parameters), table, values)
    arguments = {key: value for key, value in given.items() if key not in others}
    try:
        return function(**arguments)
    except (AttributeError, TypeError, ValueError) as error:  # an InvalidInputError is one too
        raise InvalidInputError(table, one_line(error), given) from error


def choose(choices: Choices, table: str, values: Tables) -> Any:
    """Call the function that the key ``name`` of a table chooses, with its other keys."""
    name = checks.one_of(table, values["name"], tuple(choices))
    return call(choices[name], table, values, ("name",))


def objects(known: Collection[str], table: str, values: Tables) -> Tables:
    """Return the values of a table, those that stand for objects made into them.

    Raises:
        NotFoundError: A key is none of those known.
        InvalidInputError: A value is out of range.
    """
    for name in values:
        if name not in known:
            raise NotFoundError(f"setting in [{table}]", name, known)
    return {name: _made(f"{table}.{name}", value) for name, value in values.items()}


def _made(place: str, value: Any) -> Any:
    """Return what a setting stands for; errors as of `objects`."""
    if place not in PARTS:
        return value
    if not isinstance(value, dict):  # of the first argument
        first = next(iter(signature(PARTS[place]).parameters))
        value = {first: value}
    return call(PARTS[place], place, value)


def load(table: Tables) -> Any:
    """Load the robot of a table [robot], with the data sheet's limits."""
    return call(partial(load_robot, table.get("name", "iiwa7")), "robot", table, ("name", "q0"))


def bounded(sheet: Robot, table: Tables) -> tuple[Robot, list[Any]]:
    """Return a robot with the bounds of a table [limits], and its parts.

    Where the table gives no limit, the robot's own holds.
    """
    parts = [key.removeprefix("limits.") for key in PARTS if key.startswith("limits.")]
    own = {limit.quantity: "robot" for limit in own_rate_limits(sheet)}
    values = objects((*BOUNDS, *parts), "limits", own | table)
    bounds = {key: values[key] for key in ("lower", "upper", "velocity") if key in values}
    angle = values.get("position", "datasheet")
    if angle != "datasheet":
        upper = checks.positive("joint-limit", angle)
        bounds = {"lower": -upper, "upper": upper, **bounds}
    robot = sheet.with_limits(**bounds)
    speed = checks.positive("speed", values.get("speed", 1.0))
    limits = [values[key] for key in parts if key in values]
    return robot.with_limits(velocity=speed * robot.dq_max), limits
