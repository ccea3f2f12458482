"""A command from its words, and its settings file, to its exit code."""

import io
import os
import re
import signal
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stderr
from dataclasses import fields
from difflib import get_close_matches
from functools import partial, wraps
from inspect import getdoc
from pathlib import Path
from typing import Any, TypeVar

import tyro
from tqdm import tqdm

from iiwa_dnn.app.interrupts import ended_by_signals
from iiwa_dnn.app.options import EXIT_CODES, RunOptions
from iiwa_dnn.errors import FileError, IiwaDnnError, NoSolutionError, NotFoundError
from iiwa_dnn.files import read_toml

S = TypeVar("S")


def run_command(
    kind: type[S], prog: str, run: Callable[[S], int], words: Sequence[str] | None = None
) -> int:
    """Read the words of a command, run it, and print an error of the package as one line.

    Args:
        kind: Dataclass of the options.
        prog: Name of the command in messages.
        run: Function that carries out the command and returns its exit code.
        words: Words of the command line; None: the words of the process.

    Returns:
        Exit code of `run`; after an error 2, or 1 if a step had no solution. With ``--verbose``
        the traceback is printed first.

    Raises:
        SystemExit: After ``--help``, Ctrl-C or SIGTERM (`iiwa_dnn.app.interrupts`).
    """
    options: S | None = None
    try:
        options = parse(kind, prog, sys.argv[1:] if words is None else words)
        with ended_by_signals(), warnings_in_one_line():
            code = run(options)
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # ``| head`` has read enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 128 + signal.SIGPIPE  # as of a shell
    except IiwaDnnError as error:
        if getattr(options, "verbose", False):
            traceback.print_exc()
        return fail(prog, error)


@contextmanager
def warnings_in_one_line() -> Iterator[None]:
    """Print each warning for the user as one line on standard error, without its place."""

    def show(message: Warning | str, *_: Any, **__: Any) -> None:
        print(message, file=sys.stderr)

    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = show
        yield


def run_script(main: Callable[..., int | None]) -> int:
    """Call a script's function with the words of the command line, as `run_command` does.

    Args:
        main: The function; tyro makes an option of each annotated parameter.

    Returns:
        Exit code of the function, 0 for None; after an error as in `run_command`.

    Raises:
        SystemExit: As in `run_command`.
    """

    @wraps(main)
    def bind(*values: Any, **named: Any) -> Callable[[], int | None]:
        return partial(main, *values, **named)

    try:
        call = _read(bind, sys.argv[1:])
        with ended_by_signals():
            return call() or 0
    except IiwaDnnError as error:
        return fail(Path(sys.argv[0]).stem, error)


def fail(prog: str, error: IiwaDnnError) -> int:
    """Print an error as one line, even if a file's name has several, and return its exit code."""
    print(f"{prog}: error: {' '.join(str(error).split())}", file=sys.stderr)
    return 1 if isinstance(error, NoSolutionError) else 2


def parse(kind: type[S], prog: str, words: Sequence[str]) -> S:
    """Read the words of a command over the options in the file that ``--settings`` names.

    Raises:
        IiwaDnnError: A word or the file is wrong.
        SystemExit: After ``--help``, with code 0.
    """
    options = _read_options(kind, prog, words, kind())
    file = getattr(options, "settings", None)
    if file is None:
        return options
    return _read_options(kind, prog, words, read_settings(kind, file))


def read_settings(kind: type[S], path: Path) -> S:
    """Read options from a TOML file; unless it sets ``out``, that is the file's folder.

    Raises:
        FileError: The file cannot be read, is not TOML, is another command's, or has a wrong value.
        NotFoundError: A key is not an option.
    """
    words = _words_of_file(kind, path)
    try:
        return _read_options(kind, "", words, kind())
    except IiwaDnnError as error:
        raise FileError(path, str(error)) from error


def _words_of_file(kind: type[Any], path: Path) -> list[str]:
    """Return the command line that is equivalent to a settings file."""
    values = read_toml(path)
    command = values.pop("command", kind.command)
    is_own = command == kind.command
    if not is_own and command not in getattr(kind, "also_reads", ()):
        raise FileError(path, f"holds settings of {command!r}, not of {kind.command!r}")
    # Only a person on the command line may ask for these.
    never = ("settings", "overwrite")
    defaults = {field.name: field.default for field in fields(kind) if field.name not in never}
    # Another command's folder holds another command's files.
    words = [f"--out={path.parent}"] if is_own else []
    for key, value in values.items():
        name = key.replace("-", "_")
        if name not in defaults:
            raise NotFoundError(f"setting in {path}", key, defaults)
        is_flag = isinstance(defaults[name], bool)
        if isinstance(value, bool) != is_flag or isinstance(value, dict):
            wanted = "true or false" if is_flag else "a text, a number or a list"
            raise FileError(path, f"{key} must be {wanted}, not {value!r}")
        words += _words_of_value(name, value)
    return words


def _words_of_value(name: str, value: Any) -> list[str]:
    """Return the words of the command line that set an option of this name."""
    if isinstance(value, bool):
        return [flag_of(name if value else f"no_{name}")]
    if isinstance(value, list):
        return [flag_of(name), *map(str, value)]
    return [f"{flag_of(name)}={value}"]


def flag_of(option: str) -> str:
    """Return an option as it is written on the command line."""
    return "--" + option.replace("_", "-")


def _read_options(kind: type[S], prog: str, words: Sequence[str], default: S) -> S:
    """Read words over default options; see `parse` for the errors."""
    about = f"{getdoc(kind)}\n\n{EXIT_CODES}"
    names = [flag_of(field.name) for field in fields(kind)]  # type: ignore[arg-type]
    options: S = _read(kind, words, names, prog=prog, description=about, default=default)
    return options


def _read(call: Any, words: Sequence[str], names: Sequence[str] = (), **settings: Any) -> Any:
    """Let tyro read words; raise an IiwaDnnError with its message in one line.

    An unknown option is named with the most similar one of `names`.
    """
    box = io.StringIO()
    try:
        with redirect_stderr(box):
            return tyro.cli(call, args=words, **settings)
    except SystemExit as end:
        if not end.code:
            raise
        # The title comes before the message, lines of the help behind it.
        paragraphs = re.split(r"[─-]{5,}|\n\s*\n", re.sub("[│╭╮╰╯]", "", box.getvalue()))
        message = " ".join("".join(paragraphs[1:2]).split())
        unknown = re.match("Unrecognized options: ([^=, ]+)", message)
        if unknown:
            near = get_close_matches(unknown[1], names, n=1)
            hint = f"; did you mean: {near[0]}" if near else ""
            message = f"no option {unknown[1]!r}{hint}"
        raise IiwaDnnError(f"{message} (--help lists the options)") from None


def print_lines(options: RunOptions, *lines: str) -> None:
    """Print lines unless the command is quiet; if it is verbose, the files in its folder too."""
    if options.quiet:
        return
    print(*lines, sep="\n")
    if options.verbose:
        for file in sorted(path for path in options.out.iterdir() if path.is_file()):
            print(f"  {file.name:<28}{file.stat().st_size / 1000:10,.1f} kB")


def progress_bar(total: int, unit: str, quiet: bool) -> Any:
    """Return a progress bar; it is hidden if standard error is not a terminal."""
    return tqdm(
        total=total,
        unit=unit,
        unit_scale=unit == "step",
        dynamic_ncols=True,
        disable=True if quiet else None,
    )
