"""``view``: the page in the browser; which record, which robot, which address."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from iiwa_dnn.app.command_line import run_command
from iiwa_dnn.app.live.page import Page, limits_of, scheme_of
from iiwa_dnn.app.settings import ViewSettings
from iiwa_dnn.app.track import limited, start_posture
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Robot, load_robot


def view(
    arguments: Sequence[str] | None = None,
    stop: Callable[[], bool] = lambda: False,
    prog: str = "view",
) -> int:
    """Open the page and keep it moving; the script ``view.py``.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        stop: Asked at every tick whether to end; Ctrl-C ends it too.
        prog: What the command is called in messages.

    Returns:
        The exit code: 0, or 2 for bad input or a missing package.
    """
    return run_command(ViewSettings, prog, lambda settings: _view(settings, stop), arguments)


def _view(settings: ViewSettings, stop: Callable[[], bool]) -> int:
    record = None if settings.run is None else load_run(settings.run)
    robot, q0 = _robot(record, settings.robot, settings.tip, settings.lock)
    scheme = None if record is None else scheme_of(record)
    page = Page(robot, q0, record, scheme, settings.host, settings.port)
    print(f"open {page.address} in a browser; Ctrl-C ends it", flush=True)
    try:
        page.run(stop)
    except KeyboardInterrupt:
        print()
    finally:
        page.close()
    return 0


def load_run(path: Path) -> Record:
    """The record in a run's folder, or in a file.

    Raises:
        FileError: If there is none.
    """
    if path.is_dir():
        path = path / "record.npz"
        if not path.exists():
            raise FileError(path, "no such file: not the folder of a run")
    return Record.load(path)


def _robot(
    record: Record | None, name: str | None, tip: str | None, locked: Sequence[str]
) -> tuple[Robot, Vector]:
    """The robot to show and where it starts, once it is seen to fit the record."""
    if record is None:
        robot = load_robot(name or "iiwa7", tip=tip, locked=locked)
        is_papers = robot.name == "iiwa7"
        return limited(robot, None, is_papers), start_posture(robot, is_papers)
    recorded = str(record.settings["robot"])
    robot = load_robot(name or recorded, tip=tip or record.settings.get("tip"), locked=locked)
    if robot.dof != record.dof:
        problem = f"{robot.name} has {robot.dof} free joints, the record {record.dof}"
        raise InvalidInputError("--robot", problem, name)
    return limits_of(record, robot), record.q[0]
