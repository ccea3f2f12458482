"""Settings of a run: tables of TOML and options, merged, and the arguments that they define.

The keys of the tables are the arguments of the package's functions and classes.
"""

from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import asdict, fields
from functools import partial, reduce
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple

from iiwa_dnn import (
    AccelerationLimits,
    Circle,
    CollisionAvoidance,
    Cone,
    Configuration,
    CrossCheck,
    DoubleIndicator,
    Heart,
    InvalidInputError,
    JerkLimits,
    Line,
    Lissajous,
    MujocoPlant,
    Reference,
    Robot,
    RunSettings,
    Scheme,
    Tilting,
    TipSpeedLimit,
    Waypoints,
    checks,
    load_robot,
)
from iiwa_dnn.app.words import WORDS
from iiwa_dnn.checks import Array
from iiwa_dnn.files import one_line, parse_toml, read_toml
from iiwa_dnn.robot.obstacles import make_obstacles
from iiwa_dnn.schemes.joint_limits import RateLimits, own_rate_limits
from iiwa_dnn.simulation import Disturbances, IdealPlant, Push
from iiwa_dnn.simulation.estimation import NoiseModel

Tables = dict[str, Any]
Choices = Mapping[str, Callable[..., Any]]

TABLES = ("robot", "reference", "scheme", "limits", "run", "plant")
"""Tables of the settings file."""

BOUNDS = ("position", "speed", "lower", "upper", "velocity")
"""Keys of the table [limits] that change the robot's own limits; all others are parts."""

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
    "robot.tool_shapes": make_obstacles,
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
"""Factories of settings that define objects, by table and key."""


def read_tables(options: Any) -> Tables:
    """Merge the settings file, then the options, then ``--set``: a later value replaces an earlier.

    Raises:
        FileError: The file cannot be read.
        InvalidInputError: There is no such table, or a value is no table or no name.
    """
    disturb = getattr(options, "disturb", False)
    typical = asdict(Disturbances.typical()) if disturb else {}
    words = [(f"plant.disturbances.{key}", value) for key, value in typical.items()]
    words += [(place, getattr(options, name, None)) for name, (place, *_) in WORDS.items()]
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
    """Return a name unchanged, a file name as an absolute path; refuse what is no text."""
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
    """Return nested tables with a value at ``TABLE.KEY``."""
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


class Arguments(NamedTuple):
    """Arguments of `simulate`."""

    robot: Robot
    scheme: Scheme
    reference: Reference
    q0: Array
    settings: RunSettings


def build(tables: Tables) -> Arguments:
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
    known = [each.name for each in fields(RunSettings) if each.name != "plant"]
    settings = RunSettings(plant=plant, **objects(known, "run", run))
    return Arguments(robot, scheme, reference, q0, settings)


def call(
    function: Callable[..., Any], table: str, values: Tables, others: Collection[str] = ()
) -> Any:
    """Call a function with the values of a table, without the keys `others`.

    Raises what `objects` does.
    """
    given = objects((*others, *signature(function).parameters), table, values)
    arguments = {key: value for key, value in given.items() if key not in others}
    try:
        return function(**arguments)
    except (AttributeError, TypeError, ValueError) as error:  # an InvalidInputError is one too
        option = _option(table, getattr(error, "argument", ""))
        raise InvalidInputError(f"{table}{option}", one_line(error), given) from error


def _option(table: str, key: str) -> str:
    """Return the option of a table or of one of its keys, in brackets, or nothing."""
    places = (table, f"{table}.{key}")
    options = [word for word, (place, *_) in WORDS.items() if place in places]
    return f" (--{options[-1].replace('_', '-')})" if options else ""


def choose(choices: Choices, table: str, values: Tables) -> Any:
    """Call the function that the key ``name`` of a table chooses, with its other keys."""
    name = checks.one_of(table, values["name"], tuple(choices))
    return call(choices[name], table, values, ("name",))


def objects(known: Collection[str], table: str, values: Tables) -> Tables:
    """Return the values of a table, with an object for each key of `PARTS`.

    Raises:
        NotFoundError: A key is none of those known.
        InvalidInputError: A value is out of range.
    """
    for name in values:
        checks.known(f"setting in [{table}]{_option(table, name)}", [name], known)
    return {name: _made(f"{table}.{name}", value) for name, value in values.items()}


def _made(place: str, value: Any) -> Any:
    """Return the object of a setting if its place is in `PARTS`, else its value."""
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
    """Return a robot with the bounds of a table [limits], and the table's limits for a scheme.

    If the table gives no rate limit of a kind, it is the robot's own.
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
