"""The options that all commands share, their exit codes, and the folder that a command writes."""

import os
import signal
import sys
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any

import tomli_w
import tyro
from tyro.conf import arg

from iiwa_dnn.errors import FileError, IiwaDnnError, NoSolutionError
from iiwa_dnn.files import one_line, prepare_folder, write_text

SETTINGS_FILE = "settings.toml"
"""Name of the settings in a run's folder."""


def shown(metavar: str, about: str = "") -> Any:
    """Return tyro's description of an option without a default in the help."""
    return arg(metavar=metavar, help_behavior_hint="", help=about or None)


Number = Annotated[float | None, shown("X")]
Count = Annotated[int | None, shown("N")]
Flag = Annotated[bool, arg(help_behavior_hint="")]
Quiet = Annotated[bool, arg(aliases=["-q"], help_behavior_hint="")]
Folder = Annotated[Path | None, shown("FOLDER")]


def guard(prog: str, run: Callable[[], int | None]) -> int:
    """Call a command; print warnings, and errors of the package and the system, as one line each.

    Args:
        prog: Name of the command in messages.
        run: The command; it returns its exit code, None for 0.

    Returns:
        The exit code; after an error 2, or 1 if a step had no solution, 130 after Ctrl-C, 143 after
        SIGTERM, and 141 if a reader such as ``head`` has closed standard output.

    Raises:
        SystemExit: After ``--help`` or a wrong word.
    """
    signal.signal(signal.SIGTERM, _interrupt)
    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = lambda message, *_: print(f"{prog}: {message}", file=sys.stderr)
        try:
            try:
                return run() or 0
            finally:
                sys.stdout.flush()
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 128 + signal.SIGPIPE
        except KeyboardInterrupt as interrupt:
            print("interrupted", file=sys.stderr)
            return 128 + int(*interrupt.args or (signal.SIGINT,))
        except (IiwaDnnError, OSError) as error:
            print(f"{prog}: error: {one_line(error)}", file=sys.stderr)
            return 1 if isinstance(error, NoSolutionError) else 2


def _interrupt(number: int, _: object) -> None:
    """Raise KeyboardInterrupt for a signal, as Ctrl-C does."""
    raise KeyboardInterrupt(number)


def run_script(main: Callable[..., int | None]) -> int:
    """Call a script's function with the options of the command line, as `guard` does.

    Args:
        main: The function; tyro makes an option of each annotated parameter.
    """
    return guard(Path(sys.argv[0]).stem, lambda: tyro.cli(main))


def check_folder(folder: Path, settings: Mapping[str, Any], overwrite: bool) -> None:
    """Check that a run with these settings may be written into a folder; nothing is left there.

    Raises:
        FileError: The folder holds other files, or another run and `overwrite` is not set, or
            cannot be written to.
    """
    file = folder / SETTINGS_FILE
    is_same = file.is_file() and file.read_text(encoding="utf-8") == tomli_w.dumps(settings)
    if any(folder.glob("[!.]*")) and not (is_same or overwrite):
        problem = "holds another run or other files: choose another --out, or --overwrite"
        raise FileError(folder, problem)
    made = [each for each in (folder, *folder.parents) if not each.exists()]
    prepare_folder(folder)
    for each in made:
        each.rmdir()


def write_settings(folder: Path, settings: Mapping[str, Any]) -> None:
    """Write the settings of a run into its folder; raises FileError if it cannot be written."""
    write_text(prepare_folder(folder) / SETTINGS_FILE, tomli_w.dumps(settings))
