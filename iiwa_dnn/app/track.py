"""``track``, ``physics`` and ``export``: a run, or its controller, from words and tables.

The keys of the tables are the arguments of the package's functions and classes.
"""

import json
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from inspect import signature
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from tqdm import tqdm

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
    Limit,
    Line,
    Lissajous,
    MujocoPlant,
    NotFoundError,
    Reference,
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
from iiwa_dnn.app.command_line import SETTINGS_FILE, claim_folder
from iiwa_dnn.app.words import TABLES, Export, Physics, Track
from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.files import parse_toml, read_toml, write_text
from iiwa_dnn.results.pictures import save_moments, save_video
from iiwa_dnn.results.report import save_run, summary
from iiwa_dnn.robot.offscreen import prepare_renderer
from iiwa_dnn.simulation import Disturbances, Plant, Push, count_steps
from iiwa_dnn.studies.paper import JOINT_LIMIT, published

Tables = dict[str, Any]

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


def track(options: Track) -> int:
    """Draw the path, check every step, write the run, and return the exit code."""
    return _draw(options, {}, False)


def physics(options: Physics) -> int:
    """Draw the path in MuJoCo, with pictures and a video, and return the exit code."""
    typical = asdict(Disturbances.typical()) if options.disturb else {}
    disturbances = {name: value for name, value in typical.items() if value is not None}
    if options.push:
        disturbances["push"] = {"force": list(options.push)}
    more = {"plant": {"name": "mujoco", "disturbances": disturbances}}
    return _draw(options, more, options.plots)


def _draw(options: Track, more: Tables, pictured: bool) -> int:
    """Carry out a run, write it into its folder, print its summary, and return the exit code."""
    tables = read_tables(options, more)
    arguments = build(tables)
    robot = arguments["robot"]
    steps = count_steps(arguments["reference"], arguments["dt"], arguments.get("duration"))
    name = "physics" if more else Path(tables["reference"]["name"]).stem
    folder = Path("runs") / name if options.config is None else options.config.parent
    folder = claim_folder(options.out or folder, tables, options.overwrite)
    if pictured:  # before the run, what draws them is asked for
        prepare_renderer()
    # Hidden if standard error is no terminal.
    with tqdm(total=steps, unit="step", disable=True if options.quiet else None) as bar:
        record = simulate(**arguments, progress=bar.update, far_start=True)
    draw_more = partial(save_moments, robot) if pictured else None
    beside = published(record.settings)
    metrics = save_run(record, folder, plots=options.plots, more=draw_more, paper=beside)
    write_text(folder / SETTINGS_FILE, tomli_w.dumps(tables))
    if pictured:
        save_video(robot, record, folder / "video.mp4")
    reasons = failures(metrics)
    if not options.quiet:
        print(summary(metrics), f"written to {folder}", sep="\n")
    elif reasons:
        print(*reasons, sep="\n", file=sys.stderr)
    return 1 if reasons else 0


def export(options: Export) -> int:
    """Write the controller of a run as C, and return 0."""
    tables = read_tables(options, {})
    arguments = build(tables)
    for name in ("filter_window", "motion"):
        if name in tables["run"]:
            raise InvalidInputError(name, "is no part of a controller and is not exported")
    known = signature(Controller).parameters
    controller = Controller(**{key: arguments[key] for key in arguments if key in known})
    folder = claim_folder(options.out or Path("controller"), tables, options.overwrite)
    exports.c99(controller, folder, arguments["q0"])
    write_text(folder / SETTINGS_FILE, tomli_w.dumps(tables))
    if controller.robot.name == "iiwa7" and "position" not in tables["limits"]:
        line = "position limits of 2.5 rad are the paper's, wider than joint 4's"
        print(f"{line}; for a real arm take --joint-limit datasheet", file=sys.stderr)
    if not options.quiet:
        print(f"written to {folder}; to test it: make -C {folder}")
    return 0


def read_tables(options: Track, more: Tables) -> Tables:
    """Merge the settings file, `more`, the words, and ``--set``: of two values the later counts.

    Raises:
        FileError: The file cannot be read.
        NotFoundError: There is no table of a name.
        InvalidInputError: A setting cannot be read.
    """
    given = {word: value for word, value in vars(options).items() if value not in (None, ())}
    words = {
        table: {keys[word]: given[word] for word in keys if word in given}
        for table, keys in TABLES.items()
    }
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
        if Path(tables[table].get(key, "")).suffix:
            tables[table][key] = str(Path(tables[table][key]).resolve())
    return tables


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
    return {**first, **second, **{key: _merge(first[key], table) for key, table in both.items()}}


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
    path_name = tables["reference"].setdefault("name", "heart")
    is_paper = (robot.name, path_name, plant) == ("iiwa7", "heart", None)
    robot_table |= {"name": robot_table.get("name", "iiwa7"), "q0": q0.tolist()}
    run = tables["run"]
    run.setdefault("dt", 1e-4 if is_paper else 1e-3)
    options = {key: value for key, value in run.items() if key not in ("check", "tolerance")}
    check_names(simulate, "run", options)
    if "estimator" in run:
        options["estimator"] = call(NoiseModel, "run.estimator", run["estimator"])
    made = {"robot": robot, "scheme": scheme, "reference": reference, "q0": q0}
    return {**made, "plant": plant, "check": check_of(run), **options}


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


def limits_of(table: Tables) -> Iterator[Limit]:
    """Make the limits of a table [limits] that are parts of the program."""
    for name in table:
        if name not in (*BOUNDS, *LIMITS):
            raise NotFoundError("setting in [limits]", name, (*BOUNDS, *LIMITS))
    for name, make in LIMITS.items():
        if name in table:
            yield make(None if table[name] == "robot" else table[name])


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


def check_of(table: Tables) -> CrossCheck:
    """Return the cross-check of a table [run]."""
    name = table.get("check", "proxqp")
    try:
        return CrossCheck(CHECKS.get(name, (name,)), table.get("tolerance", 1e-6))
    except InvalidInputError as error:
        if error.argument != "solvers":
            raise
        raise InvalidInputError("check", f"{error.problem}", name) from error


def plant_of(table: Tables) -> Plant | None:
    """Return the arm of a table [plant]; None for the ideal one."""
    arguments = {"name": "ideal", **table}
    name = arguments.pop("name")
    if name == "ideal":
        return None
    if name != "mujoco":
        raise NotFoundError("plant", name, ("ideal", "mujoco"))
    inner = dict(arguments.get("disturbances", {}))
    if "push" in inner:
        inner["push"] = call(Push, "plant.disturbances.push", inner["push"])
    arguments["disturbances"] = call(Disturbances, "plant.disturbances", inner)
    plant: Plant = call(MujocoPlant, "plant", arguments)
    return plant
