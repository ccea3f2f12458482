"""``view``: the page in the browser, for a run or live."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.app.folders import SETTINGS_FILE
from iiwa_dnn.app.options import ViewOptions
from iiwa_dnn.app.track import limited
from iiwa_dnn.app.viewer.page import Page
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import read_toml
from iiwa_dnn.results.metrics import limits
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Robot, load_robot
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.loading import package_robots
from iiwa_dnn.schemes import DoubleIndicator


def run(options: ViewOptions, stop: Callable[[], bool] = lambda: False) -> int:
    """Open the page and keep it moving until `stop` returns True, or Ctrl-C; return 0."""
    page = _open(options)
    print(f"open {page.address} in a browser; Ctrl-C ends it", flush=True)
    try:
        page.run(stop)
    except KeyboardInterrupt:
        print()
    finally:
        page.close()
    return 0


def _open(options: ViewOptions) -> Page:
    """Make the page of a run, or of an arm to be led."""
    if options.run is None:
        name = options.robot or "iiwa7"
        robot = load_robot(name, tip=options.tip, locked=options.lock, tool=options.tool or None)
        return Page(limited(robot), robot.start_posture(), host=options.host, port=options.port)
    record = load_run(options.run)
    kept = kept_settings(options.run)
    tool = options.tool or kept.get("tool")
    tip = options.tip or kept.get("tip")
    if not tool:  # else the record's tip may be that tool
        tip = tip or record.settings.get("tip")
    name = options.robot or robot_of(record, kept)
    locked = options.lock or kept.get("lock", ())
    robot = load_robot(name, tip=tip, locked=locked, tool=tool, frames=kept.get("frames", ()))
    if robot.dof != record.dof:
        problem = f"{robot.name} has {robot.dof} free joints, the record {record.dof}"
        raise InvalidInputError("--robot", problem, options.robot)
    robot = limits_of(record, robot)
    return Page(robot, record.q[0], record, scheme_of(record), options.host, options.port)


def load_run(path: Path) -> Record:
    """Load the record in a run's folder, or in a file.

    Raises:
        FileError: If there is none.
    """
    if path.is_dir():
        path = path / "record.npz"
        if not path.exists():
            raise FileError(path, "no such file: not the folder of a run")
    return Record.load(path)


def kept_settings(run: Path) -> dict[str, Any]:
    """Read the settings file beside a run's record; empty if there is none."""
    file = (run if run.is_dir() else run.parent) / SETTINGS_FILE
    return read_toml(file) if file.exists() else {}


def robot_of(record: Record, kept: Mapping[str, Any]) -> str:
    """Name the robot of a run: as the folder's settings file does, or else the record's settings.

    The record has the name alone of a robot that came from a file, the settings file its path.

    Raises:
        InvalidInputError: There is no robot of that name, and no file.
    """
    name = str({**record.settings, **kept}.get("robot", "iiwa7"))
    if name not in (*package_robots(), *ARMS) and not Path(name).exists():
        raise InvalidInputError(
            "--robot", f"{name!r} came from a file: add --robot FILE.urdf", name
        )
    return name


def scheme_of(record: Record) -> DoubleIndicator:
    """Return the scheme of a record without its home, or the default if it is of another kind."""
    settings = dict(record.settings.get("scheme") or {})
    if settings.pop("name", None) != DoubleIndicator().settings()["name"]:
        return DoubleIndicator()
    return DoubleIndicator(**{**settings, "home": None})


def limits_of(record: Record, robot: Robot) -> Robot:
    """Return the robot with the limits of a record, in which None stands for no limit."""
    return robot.with_limits(
        lower=limits(record, "q_lower", -np.inf),
        upper=limits(record, "q_upper"),
        velocity=limits(record, "dq_max"),
    )
