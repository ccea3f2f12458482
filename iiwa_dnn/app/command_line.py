"""A command from its call to its exit code, and the folder that it writes."""

import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NoReturn

import tomli_w
import tyro

from iiwa_dnn.errors import FileError, IiwaDnnError, NoSolutionError
from iiwa_dnn.files import one_line, prepare_folder

SETTINGS_FILE = "settings.toml"
"""Name of the settings in a run's folder."""


def guard(prog: str, run: Callable[[], int | None]) -> int:
    """Call a command; print errors of the package and warnings as one line each.

    Args:
        prog: Name of the command in messages.
        run: The command; it returns its exit code, None for 0.

    Returns:
        The exit code; after an error 2, or 1 if a step had no solution, 130 after Ctrl-C, and 141
        if a reader such as ``head`` has closed standard output.

    Raises:
        SystemExit: After ``--help`` or a wrong word, and after SIGTERM, with code 143.
    """
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _terminate)
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
        except KeyboardInterrupt:
            print("interrupted", file=sys.stderr)
            return 128 + signal.SIGINT
        except IiwaDnnError as error:
            print(f"{prog}: error: {one_line(error)}", file=sys.stderr)
            return 1 if isinstance(error, NoSolutionError) else 2


def _terminate(number: int, frame: object) -> NoReturn:
    """End the process in order: half-written files are removed, worker processes end."""
    warnings.simplefilter("ignore")  # of work that is given up
    sys.exit(128 + signal.SIGTERM)


def run_script(main: Callable[..., int | None]) -> int:
    """Call a script's function with the words of the command line, as `guard` does.

    Args:
        main: The function; tyro makes an option of each annotated parameter.
    """
    return guard(Path(sys.argv[0]).stem, lambda: tyro.cli(main))


def claim_folder(
    folder: Path, settings: Mapping[str, Any], overwrite: bool, product: str = SETTINGS_FILE
) -> Path:
    """Prepare the folder of a run with these settings, which leaves a file of the name `product`.

    Raises:
        FileError: The folder holds other files, or another run and `overwrite` is not set, or
            cannot be written to.
    """
    file = folder / SETTINGS_FILE
    is_same = file.is_file() and file.read_text(encoding="utf-8") == tomli_w.dumps(settings)
    mine = overwrite or (is_same and (folder / product).exists())
    if folder.is_dir() and any(folder.glob("[!.]*")) and not mine:
        problem = "holds another run or other files: choose another --out, or --overwrite"
        raise FileError(folder, problem)
    return prepare_folder(folder)
