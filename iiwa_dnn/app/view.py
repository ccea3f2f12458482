"""``view``: the page in the browser, for a run or live."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from iiwa_dnn.app.options import ViewOptions
from iiwa_dnn.app.track import limited
from iiwa_dnn.app.viewer.page import Page
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Robot, load_robot
from iiwa_dnn.schemes import DoubleIndicator


def run(options: ViewOptions, stop: Callable[[], bool] = lambda: False) -> int:
    """Open the page and keep it moving until `stop` returns True, or Ctrl-C; return 0."""
    record = None if options.run is None else load_run(options.run)
    settings = {} if record is None else record.settings
    tip = options.tip
    if not options.tool:  # else the record's tip may be that tool
        tip = tip or settings.get("tip")
    name = options.robot or settings.get("robot", "iiwa7")
    robot = load_robot(name, tip=tip, locked=options.lock, tool=options.tool or None)
    if record is None:
        page = Page(limited(robot), robot.start_posture(), host=options.host, port=options.port)
    elif robot.dof == record.dof:
        robot = limits_of(record, robot)
        page = Page(robot, record.q[0], record, scheme_of(record), options.host, options.port)
    else:
        problem = f"{robot.name} has {robot.dof} free joints, the record {record.dof}"
        raise InvalidInputError("--robot", problem, options.robot)
    print(f"open {page.address} in a browser; Ctrl-C ends it", flush=True)
    try:
        page.run(stop)
    except KeyboardInterrupt:
        print()
    finally:
        page.close()
    return 0


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


def scheme_of(record: Record) -> DoubleIndicator:
    """Return the scheme of a record without its home, or the default if it is of another kind."""
    settings = dict(record.settings.get("scheme") or {})
    if settings.pop("name", None) != DoubleIndicator().settings()["name"]:
        return DoubleIndicator()
    return DoubleIndicator(**{**settings, "home": None})


def limits_of(record: Record, robot: Robot) -> Robot:
    """Return the robot with the limits of a record, in which None stands for no limit."""
    keys = ("q_lower", "q_upper", "dq_max")
    lower, upper, velocity = (np.array(record.settings[key], dtype=float) for key in keys)
    return robot.with_limits(
        lower=np.where(np.isnan(lower), -np.inf, lower),
        upper=np.where(np.isnan(upper), np.inf, upper),
        velocity=np.where(np.isnan(velocity), np.inf, velocity),
    )
