"""A command from its words to its exit code, and the words that all commands print."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from tqdm import tqdm

from iiwa_dnn.app.arguments import read
from iiwa_dnn.app.interrupts import ended_by_signals
from iiwa_dnn.app.settings import read_settings
from iiwa_dnn.errors import IiwaDnnError, NoSolutionError

S = TypeVar("S")


def parse(kind: type[S], prog: str, words: Sequence[str]) -> S:
    """Read a command's words, over the options in the file that ``--settings`` names.

    Args:
        kind: Dataclass of the command's options.
        prog: Name of the command in its help.
        words: The words, without the program's name.

    Returns:
        The options.

    Raises:
        IiwaDnnError: A word or the file is wrong.
        SystemExit: After ``--help``, with code 0.
    """
    options = read(kind, prog, words)
    file = getattr(options, "settings", None)
    if file is None:
        return options
    start: Any = read_settings(kind, file)
    options = read(kind, prog, words, replace(start, quiet=False, verbose=False))
    shown = {name: True for name in ("quiet", "verbose") if getattr(start, name)}
    return replace(options, **shown)


def run_command(
    kind: type[S], prog: str, run: Callable[[S], int], words: Sequence[str] | None = None
) -> int:
    """Parse the words, run the command, and turn the package's errors into one line.

    Args:
        kind: Dataclass of the command's options.
        prog: Name of the command in messages.
        run: The command; it takes the options and returns the exit code.
        words: Command line without the program's name; None takes the process's own.

    Returns:
        The exit code; after an error of the package 2, or 1 where a step had no solution.
        ``--verbose`` prints the error's traceback first.

    Raises:
        SystemExit: After ``--help``, or when Ctrl-C or SIGTERM came (`iiwa_dnn.app.interrupts`).
    """
    options: S | None = None
    try:
        options = parse(kind, prog, sys.argv[1:] if words is None else list(words))
        with ended_by_signals():
            return run(options)
    except IiwaDnnError as error:
        if getattr(options, "verbose", False):
            traceback.print_exc()
        return fail(prog, error)


def fail(prog: str, error: IiwaDnnError) -> int:
    """Print an error in one line, whatever stands in a file's name, and return its exit code."""
    print(f"{prog}: error: {' '.join(str(error).split())}", file=sys.stderr)
    return 1 if isinstance(error, NoSolutionError) else 2


def list_files(folder: Path) -> None:
    """Print the files in a folder with their sizes, one a line."""
    for file in sorted(path for path in folder.iterdir() if path.is_file()):
        print(f"  {file.name:<28}{file.stat().st_size / 1000:10,.1f} kB")


def progress_bar(total: int, unit: str, quiet: bool) -> Any:
    """Return a progress bar; it is not shown where standard error is not a terminal."""
    return tqdm(
        total=total,
        unit=unit,
        unit_scale=unit == "step",
        dynamic_ncols=True,
        disable=True if quiet else None,
    )
