"""Settings of a run: tables whose keys are the arguments of the package's functions and classes."""

import json
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from inspect import signature
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.app.words import Track
from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.files import parse_toml, read_toml
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Circle, Cone, Heart, Line, Lissajous, Reference, Tilting, Waypoints
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.schemes import (
    AccelerationLimits,
    CollisionAvoidance,
    DoubleIndicator,
    JerkLimits,
    Limit,
    TipSpeedLimit,
)
from iiwa_dnn.simulation import Disturbances, MujocoPlant, Plant, Push, simulate
from iiwa_dnn.studies.paper import JOINT_LIMIT

Tables = dict[str, Any]

TABLES = ("robot", "reference", "scheme", "limits", "run", "plant")
CHECKS = {"both": ("proxqp", "osqp"), "none": ()}

LIMITS: dict[str, Callable[[Any], Limit]] = {
    "acceleration": AccelerationLimits,
    "jerk": JerkLimits,
    "tip_speed": TipSpeedLimit,
    "obstacles": CollisionAvoidance.from_toml,
}
BOUNDS = ("position", "speed", "lower", "upper", "velocity")


PATHS: dict[str, Callable[..., Reference]] = {
    "heart": Heart,
    "circle": Circle,
    "line": Line,
    "lissajous": Lissajous,
    "cone": Cone,
    "tilting-circle": Tilting,
}


def read_tables(options: Track, more: Tables) -> Tables:
    """Merge the settings file, `more`, the words, and ``--set``: of two values the later counts.

    Raises:
        FileError: The file cannot be read.
        NotFoundError: There is no table of a name.
        InvalidInputError: A setting cannot be read.
    """
    words = {name: _given(getattr(options, name)) for name in TABLES}
    if "path" in words["reference"]:
        words["reference"]["name"] = words["reference"].pop("path")
    file = {} if options.config is None else read_toml(options.config)
    tables: Tables = {name: {} for name in TABLES}
    for source in (file, more, words, *map(_read_setting, options.set)):
        for name, values in source.items():
            if name not in TABLES:
                raise NotFoundError("table of settings", name, TABLES)
            if not isinstance(values, dict):
                raise InvalidInputError(name, "must be a table with keys", values)
        tables = _merge(tables, source)
    for table, key in (("robot", "name"), ("reference", "name"), ("limits", "obstacles")):
        file_name = Path(tables[table].get(key, ""))
        if file_name.suffix:
            tables[table][key] = str(file_name.resolve())
    return tables


def _given(words: object) -> Tables:
    """Return the words that were given, by name."""
    return {name: value for name, value in vars(words).items() if value not in (None, ())}


def _read_setting(text: str) -> Tables:
    """Read ``TABLE.KEY=VALUE``, the value in TOML, or a text without quotation marks."""
    place, _, value = text.partition("=")
    for written in (value, json.dumps(value)):
        with suppress(ValueError):
            return parse_toml(f"{place} = {written}")
    raise InvalidInputError("--set", f"must be TABLE.KEY=VALUE, not {text!r}", text)


def _merge(first: Tables, second: Tables) -> Tables:
    """Return two tables as one; tables inside of both are merged too."""
    both = {key: second[key] for key in second if isinstance(first.get(key), dict)}
    inner = {key: _merge(first[key], table) for key, table in both.items()}
    return {**first, **second, **inner}


def build(tables: Tables) -> Tables:
    """Return the arguments of `simulate`, and write defaults that depend on others into the tables.

    Raises:
        IiwaDnnError: A setting is unknown or out of range.
    """
    robot_table = tables["robot"]
    sheet = load(robot_table)
    robot = limited(sheet, tables["limits"])
    q0 = checks.finite_array("q0", robot_table.get("q0", sheet.start_posture()), (robot.dof,))
    if "q0" in robot_table and (problem := robot.outside(q0)):
        raise InvalidInputError("q0", problem, q0)
    if "q0" not in robot_table and not robot.has_known_start:
        line = f"no start posture is known of {robot.name!r}: its joints begin near the middle"
        warnings.warn(f"{line} of their ranges; --q0 chooses another", stacklevel=2)
    reference = path_of(tables["reference"])
    if getattr(reference, "quaternions", None) is None:
        reference = reference.anchored(Configuration(robot, q0))
    limits = tuple(limits_of(tables["limits"]))
    scheme = call(partial(DoubleIndicator, extra_limits=limits), "scheme", tables["scheme"])
    plant = plant_of(tables["plant"])
    robot_table |= {"name": robot_table.get("name", "iiwa7"), "q0": q0.tolist()}
    path_name = tables["reference"].setdefault("name", "heart")
    is_paper = (robot.name, path_name, plant) == ("iiwa7", "heart", None)
    run = tables["run"]
    run.setdefault("dt", 1e-4 if is_paper else 1e-3)
    options = {key: value for key, value in run.items() if key not in ("check", "tolerance")}
    check_names(simulate, "run", options)
    if "estimator" in run:
        options["estimator"] = call(NoiseModel, "run.estimator", run["estimator"])
    name = run.get("check", "proxqp")
    check = CrossCheck(CHECKS.get(name, (name,)), run.get("tolerance", 1e-6))
    made = {"robot": robot, "scheme": scheme, "reference": reference, "q0": q0}
    return {**made, "plant": plant, "check": check, **options}


def check_names(function: Callable[..., Any], table: str, values: Tables) -> None:
    """Refuse a key of a table that is no argument of a function.

    Raises:
        NotFoundError: There is one.
    """
    known = signature(function).parameters
    for name in values:
        if name not in known:
            raise NotFoundError(f"setting in [{table}]", name, known)


def call(function: Callable[..., Any], table: str, values: Tables) -> Any:
    """Call a function with the values of a table; errors as of `check_names`."""
    check_names(function, table, values)
    return function(**values)


def load(table: Tables) -> Robot:
    """Load the robot of a table [robot], with the data sheet's limits."""
    arguments = {key: value for key, value in table.items() if key not in ("name", "q0")}
    robot: Robot = call(partial(load_robot, table.get("name", "iiwa7")), "robot", arguments)
    return robot


def limited(robot: Robot, table: Tables) -> Robot:
    """Return the robot with the limits of a table [limits], the paper's for its arm."""
    position = table.get("position", JOINT_LIMIT if robot.name == "iiwa7" else "datasheet")
    bounds = {key: table[key] for key in ("lower", "upper") if key in table}
    if position != "datasheet":
        angle = checks.positive("joint-limit", position)
        bounds = {"lower": -angle, "upper": angle, **bounds}
    speed = checks.positive("speed", table.get("speed", 1.0))
    velocity = np.asarray(table.get("velocity", robot.dq_max), dtype=float)
    return robot.with_limits(velocity=speed * velocity, **bounds)


def limits_of(table: Tables) -> list[Limit]:
    """Return the limits of a table [limits] that are parts of the program."""
    for name in table:
        if name not in (*BOUNDS, *LIMITS):
            raise NotFoundError("setting in [limits]", name, (*BOUNDS, *LIMITS))
    values = {name: None if value == "robot" else value for name, value in table.items()}
    return [make(values[name]) for name, make in LIMITS.items() if name in values]


def path_of(table: Tables) -> Reference:
    """Return the path of a table [reference], before it is anchored."""
    name = table.get("name", "heart")
    make = PATHS.get(name)
    if name.lower().endswith(".csv"):
        make = partial(Waypoints.from_csv, name)
    if make is None:
        raise NotFoundError("path", name, (*PATHS, "FILE.csv"))
    arguments = {key: value for key, value in table.items() if key != "name"}
    path: Reference = call(make, "reference", arguments)
    return path


def plant_of(table: Tables) -> Plant | None:
    """Return the arm of a table [plant]; None for the ideal one."""
    name = table.get("name", "ideal")
    if name not in ("ideal", "mujoco"):
        raise NotFoundError("plant", name, ("ideal", "mujoco"))
    if name == "ideal":
        return None
    arguments = {key: value for key, value in table.items() if key != "name"}
    inner = dict(arguments.get("disturbances", {}))
    if "push" in inner:
        inner["push"] = call(Push, "plant.disturbances.push", inner["push"])
    arguments["disturbances"] = call(Disturbances, "plant.disturbances", inner)
    plant: Plant = call(MujocoPlant, "plant", arguments)
    return plant
