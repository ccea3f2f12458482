"""The script that opens the page: which record, which robot, which address."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from iiwa_dnn.cli import Parser, limited, start_posture
from iiwa_dnn.exceptions import FileError, IiwaDnnError, InvalidInputError
from iiwa_dnn.live.page import Page, limits_of, scheme_of
from iiwa_dnn.qp import Vector
from iiwa_dnn.record import Record
from iiwa_dnn.robot import Robot, load_robot
from iiwa_dnn.viewer.server import HOST, PORT


def view(arguments: Sequence[str] | None = None, stop: Callable[[], bool] = lambda: False) -> int:
    """Open the page and keep it moving; the script ``view.py``.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        stop: Asked at every tick whether to end; Ctrl-C ends it too.

    Returns:
        The exit code: 0, or 2 for bad input or a missing package.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        record = None if options.run is None else load_run(options.run)
        robot, q0 = _robot(record, options.robot, options.tip, options.lock)
        scheme = None if record is None else scheme_of(record)
        page = Page(robot, q0, record, scheme, options.host, options.port)
    except IiwaDnnError as error:
        print(f"{parser.prog}: error: {error}", file=sys.stderr)
        return 2
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


def _parser() -> Parser:
    parser = Parser(
        prog="view",
        description="Replay a run in the browser, or drive the arm live: drag its target while the "
        "controller follows.",
        epilog="Exit code 0: ended by Ctrl-C; 2: bad input, or a package is missing.",
    )
    add = parser.add_argument
    add("run", nargs="?", type=Path, metavar="RUN", help="a run's folder or record (none: live)")
    add("--robot", metavar="NAME|URDF", help="robot (the record's, or iiwa7)")
    add("--tip", metavar="FRAME", help="frame that follows (the record's, or the chain's end)")
    add("--lock", nargs="+", default=(), metavar="JOINT", help="joints to hold still")
    add("--host", default=HOST, metavar="ADDRESS", help="0.0.0.0 lets others in (%(default)s)")
    add("--port", type=int, default=PORT, metavar="N", help="0 takes a free one (%(default)s)")
    return parser
