"""``track``, ``physics`` and ``export``: a run, or its controller, from words and tables.

The keys of the tables are the arguments of the package's functions and classes.
"""

import json
import sys
import warnings
from collections.abc import Callable, Collection, Mapping
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
from iiwa_dnn.app.words import TABLES, WORDS
from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.files import parse_toml, read_toml, write_text
from iiwa_dnn.results.pictures import save_moments, save_video
from iiwa_dnn.results.report import save_run, summary
from iiwa_dnn.robot.offscreen import prepare_renderer
from iiwa_dnn.simulation import Disturbances, IdealPlant, Push, count_steps
from iiwa_dnn.studies.paper import JOINT_LIMIT, published

Tables = dict[str, Any]
Choices = Mapping[str, Callable[..., Any]]

CHECKS = {"both": ("proxqp", "osqp"), "none": ()}
LIMITS: Choices = {
    "acceleration": AccelerationLimits,
    "jerk": JerkLimits,
    "tip_speed": TipSpeedLimit,
    "obstacles": CollisionAvoidance.from_toml,
}
BOUNDS = ("position", "speed", "lower", "upper", "velocity")
PATHS: Choices = {
    "heart": Heart,
    "circle": Circle,
    "line": Line,
    "lissajous": Lissajous,
    "cone": Cone,
    "tilting-circle": Tilting,
}
PLANTS: Choices = {"ideal": IdealPlant, "mujoco": MujocoPlant}


def track(options: Any) -> int:
    """Draw the path, check every step, write the run, and return the exit code."""
    return _draw(options, {})


def physics(options: Any) -> int:
    """Draw the path in MuJoCo, with pictures and a video, and return the exit code."""
    return _draw(options, {"plant": {"name": "mujoco"}})


def _draw(options: Any, more: Tables) -> int:
    """Carry out a run, write it into its folder, print its summary, and return the exit code."""
    tables = read_tables(options, more)
    arguments = build(tables)
    robot = arguments["robot"]
    steps = count_steps(arguments["reference"], arguments["dt"], arguments.get("duration"))
    name = "physics" if more else Path(tables["reference"]["name"]).stem
    folder = Path("runs") / name if options.config is None else options.config.parent
    folder = claim_folder(options.out or folder, tables, options.overwrite, "record.npz")
    pictured = options.plots and tables["plant"].get("name") == "mujoco"
    if pictured:  # before the run, what draws them is asked for
        prepare_renderer()
    try:
        # Hidden if standard error is no terminal.
        with tqdm(total=steps, unit="step", disable=True if options.quiet else None) as bar:
            record = simulate(**arguments, progress=bar.update, far_start=True)
        draw_more = partial(save_moments, robot) if pictured else None
        beside = published(record.settings)
        metrics = save_run(record, folder, plots=options.plots, more=draw_more, paper=beside)
        write_text(folder / SETTINGS_FILE, tomli_w.dumps(tables))
        if pictured:
            save_video(robot, record, folder / "video.mp4")
    finally:
        with suppress(OSError):  # it goes only if it is empty: the run was given up
            folder.rmdir()
    reasons = failures(metrics)
    if not options.quiet:
        print(summary(metrics), f"written to {folder}", sep="\n")
    elif reasons:
        print(*reasons, sep="\n", file=sys.stderr)
    return 1 if reasons else 0


def export(options: Any) -> int:
    """Write the controller of a run as C, and return 0."""
    tables = read_tables(options, {})
    arguments = build(tables)
    for name in ("filter_window", "motion"):
        if name in tables["run"]:
            raise InvalidInputError(name, "is no part of a controller and is not exported")
    known = signature(Controller).parameters
    controller = Controller(**{key: arguments[key] for key in arguments if key in known})
    folder = options.out or Path("controller")
    folder = claim_folder(folder, tables, options.overwrite, "controller.c")
    exports.c99(controller, folder, arguments["q0"])
    write_text(folder / SETTINGS_FILE, tomli_w.dumps(tables))
    if controller.robot.name == "iiwa7" and "position" not in tables["limits"]:
        line = "position limits of 2.5 rad are the paper's, wider than those of joints 2, 4 and 6"
        print(f"{line}; for a real arm take --joint-limit datasheet", file=sys.stderr)
    if not options.quiet:
        print(f"written to {folder}; to test it: make -C {folder}")
    return 0


def read_tables(options: Any, more: Tables) -> Tables:
    """Merge `more`, the settings file, the words, and ``--set``: of two values the later counts.

    Raises:
        FileError: The file cannot be read.
        NotFoundError: There is no table of a name.
        InvalidInputError: A setting cannot be read.
    """
    typical = asdict(Disturbances.typical()) if options.disturb else {}
    disturbances = {key: value for key, value in typical.items() if value is not None}
    words = [(word.place, getattr(options, name)) for name, word in WORDS.items()]
    tables: Tables = {name: {} for name in TABLES}
    for source in (
        more,
        {} if options.config is None else read_toml(options.config),
        {"plant": {"disturbances": disturbances}} if disturbances else {},
        *(_nested(place, value) for place, value in words if value is not None),
        *map(_read_setting, options.set),
    ):
        tables = _merge(tables, _checked(source))
    for table, key in (("robot", "name"), ("reference", "name"), ("limits", "obstacles")):
        if Path(tables[table].get(key, "")).suffix:
            tables[table][key] = str(Path(tables[table][key]).resolve())
    return tables


def _checked(tables: Tables) -> Tables:
    """Return the tables; raise NotFoundError or InvalidInputError if one is none of a run's."""
    for name, values in tables.items():
        if name not in TABLES:
            raise NotFoundError("table of settings", name, TABLES)
        if not isinstance(values, dict):
            raise InvalidInputError(name, "must be a table with keys", values)
    return tables


def _nested(place: str, value: Any) -> Tables:
    """Return tables in which a value stands at ``TABLE.KEY``."""
    table, _, key = place.partition(".")
    return {table: _nested(key, value)} if key else {table: value}


def _read_setting(text: str) -> Tables:
    """Read ``TABLE.KEY=VALUE``, the value in TOML, or a text without quotation marks."""
    place, _, value = text.partition("=")
    for written in (value, json.dumps(value)):
        with suppress(ValueError):
            return parse_toml(f"{place} = {written}")
    raise InvalidInputError("--set", f"must be TABLE.KEY=VALUE, not {text!r}", text)


def _merge(first: Tables, second: Tables) -> Tables:
    """Return two tables as one; tables inside of both are merged too."""
    inner = {
        key: _merge(first[key], value)
        for key, value in second.items()
        if isinstance(value, dict) and isinstance(first.get(key), dict)
    }
    return {**first, **second, **inner}


def build(tables: Tables) -> Tables:
    """Return the arguments of `simulate`, and write defaults that depend on others into the tables.

    Raises:
        IiwaDnnError: A setting is unknown or out of range.
    """
    robot_table = tables["robot"]
    limits = tables["limits"]
    run = tables["run"]
    sheet = load(robot_table)
    robot = limited(sheet, limits)
    q0 = checks.finite_array("q0", robot_table.get("q0", sheet.start_posture()), (robot.dof,))
    if "q0" in robot_table and (problem := robot.outside(q0)):
        raise InvalidInputError("q0", problem, q0)
    if "q0" not in robot_table and not robot.has_known_start:
        line = f"no start posture is known of {robot.name!r}: its joints begin near the middle"
        warnings.warn(f"{line} of their ranges; --q0 chooses another", stacklevel=2)
    path_name = tables["reference"].setdefault("name", "heart")
    is_file = path_name.lower().endswith(".csv")
    from_file = partial(Waypoints.from_csv, path_name if is_file else "FILE.csv")
    paths: Choices = {**PATHS, path_name if is_file else "FILE.csv": from_file}
    reference: Reference = choose(paths, "reference", tables["reference"])
    if getattr(reference, "quaternions", None) is None:
        reference = reference.anchored(Configuration(robot, q0))
    make_scheme = partial(DoubleIndicator, extra_limits=parts_of(limits))
    scheme = call(make_scheme, "scheme", tables["scheme"])
    plant = choose(PLANTS, "plant", {"name": "ideal", **_disturbed(tables["plant"])})
    is_paper = (robot.name, path_name, plant.exact) == ("iiwa7", "heart", True)
    robot_table |= {"name": robot_table.get("name", "iiwa7"), "q0": q0.tolist()}
    run.setdefault("dt", 1e-4 if is_paper else 1e-3)
    options = {key: value for key, value in run.items() if key not in ("check", "tolerance")}
    check_names(signature(simulate).parameters, "run", options)
    if "estimator" in run:
        options["estimator"] = call(NoiseModel, "run.estimator", run["estimator"])
    solver = run.get("check", "proxqp")
    check = CrossCheck(CHECKS.get(solver, (solver,)), run.get("tolerance", 1e-6))
    made = {"robot": robot, "scheme": scheme, "reference": reference, "q0": q0, "plant": plant}
    return {**made, "check": check, **options}


def _disturbed(table: Tables) -> Tables:
    """Return a table [plant] with its disturbances and their push made of their tables."""
    if "disturbances" not in table:
        return table
    inner = dict(table["disturbances"])
    if "push" in inner:
        inner["push"] = call(Push, "plant.disturbances.push", inner["push"])
    return {**table, "disturbances": call(Disturbances, "plant.disturbances", inner)}


def check_names(known: Collection[str], table: str, values: Tables) -> None:
    """Refuse a key of a table that is none of those known.

    Raises:
        NotFoundError: There is one.
    """
    for name in values:
        if name not in known:
            raise NotFoundError(f"setting in [{table}]", name, known)


def call(function: Callable[..., Any], table: str, values: Tables) -> Any:
    """Call a function with the values of a table; errors as of `check_names`."""
    check_names(signature(function).parameters, table, values)
    return function(**values)


def choose(choices: Choices, table: str, values: Tables) -> Any:
    """Call the function that the key ``name`` of a table chooses, with its other keys.

    Raises:
        NotFoundError: There is no choice of this name, or a key is no argument of it.
    """
    arguments = dict(values)
    name = arguments.pop("name")
    if name not in choices:
        raise NotFoundError(f"name in [{table}]", name, choices)
    return call(choices[name], table, arguments)


def load(table: Tables) -> Robot:
    """Load the robot of a table [robot], with the data sheet's limits."""
    arguments = {key: value for key, value in table.items() if key not in ("name", "q0")}
    robot: Robot = call(partial(load_robot, table.get("name", "iiwa7")), "robot", arguments)
    return robot


def parts_of(table: Tables) -> tuple[Any, ...]:
    """Make the limits of a table [limits] that are parts of the program."""
    check_names((*BOUNDS, *LIMITS), "limits", table)
    chosen = [(make, table[name]) for name, make in LIMITS.items() if name in table]
    return tuple(make(None if value == "robot" else value) for make, value in chosen)


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
