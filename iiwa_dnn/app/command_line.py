"""A command from its words, and its settings file, to its exit code.

tyro reads the words and writes the help. It reports a wrong word in a box of many lines and ends
the process; here it is one line. So tyro hands an unknown option back unread, and lets a wrong
value through as a `_Wrong`; both are refused after it.
"""

import io
import sys
import traceback
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr
from dataclasses import Field, fields, replace
from difflib import get_close_matches
from functools import partial, wraps
from inspect import getdoc, signature
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar, get_args

import tyro
from tqdm import tqdm
from tyro.constructors import ConstructorRegistry, PrimitiveConstructorSpec, PrimitiveTypeInfo

from iiwa_dnn.app.interrupts import ended_by_signals
from iiwa_dnn.app.options import EXIT_CODES, RunOptions
from iiwa_dnn.errors import (
    FileError,
    IiwaDnnError,
    InvalidInputError,
    NoSolutionError,
    NotFoundError,
)
from iiwa_dnn.files import read_toml

S = TypeVar("S")


_HINT = "(--help lists the options)"


class _Wrong(str):
    """The reason why an option's words are not accepted, in the place of its value."""


def run_command(
    kind: type[S], prog: str, run: Callable[[S], int], words: Sequence[str] | None = None
) -> int:
    """Read the words of a command, run it, and turn the package's errors into one line.

    Messages call the command `prog`; no words are the process's own. Returns the exit code of
    `run`, after an error of the package 2, or 1 where a step had no solution; ``--verbose`` prints
    the error's traceback first.

    Raises:
        SystemExit: After ``--help``, or when Ctrl-C or SIGTERM came (`iiwa_dnn.app.interrupts`).
    """
    options: S | None = None
    try:
        options = parse(kind, prog, sys.argv[1:] if words is None else words)
        with ended_by_signals():
            return run(options)
    except IiwaDnnError as error:
        if getattr(options, "verbose", False):
            traceback.print_exc()
        return fail(prog, error)


def run_script(main: Callable[..., int | None]) -> int:
    """Call a script's function with the words of the command line, as `run_command` does.

    Args:
        main: The function, its parameters annotated as tyro wants them.

    Returns:
        The function's exit code, 0 for None; after an error of the package as `run_command`.

    Raises:
        SystemExit: As in `run_command`.
    """

    @wraps(main)
    def read(*values: Any, **named: Any) -> Callable[[], int | None]:
        for name, value in signature(main).bind(*values, **named).arguments.items():
            if isinstance(value, _Wrong):
                raise InvalidInputError(name, value)
        return partial(main, *values, **named)

    try:
        call = _read_quietly(read, sys.argv[1:])
        with ended_by_signals():
            return call() or 0
    except IiwaDnnError as error:
        return fail(Path(sys.argv[0]).stem, error)


def fail(prog: str, error: IiwaDnnError) -> int:
    """Print an error in one line, whatever stands in a file's name, and return its exit code."""
    print(f"{prog}: error: {' '.join(str(error).split())}", file=sys.stderr)
    return 1 if isinstance(error, NoSolutionError) else 2


def parse(kind: type[S], prog: str, words: Sequence[str]) -> S:
    """Read a command's words, over the options in the file that ``--settings`` names.

    Raises:
        IiwaDnnError: A word or the file is wrong.
        SystemExit: After ``--help``, with code 0.
    """
    options = _read(kind, prog, words)
    file = getattr(options, "settings", None)
    if file is None:
        return options
    start: Any = read_settings(kind, file)
    options = _read(kind, prog, words, replace(start, quiet=False, verbose=False))
    return replace(options, **{name: True for name in ("quiet", "verbose") if getattr(start, name)})


def read_settings(kind: type[S], path: Path) -> S:
    """Read the options in a TOML file; where it does not set ``out``, that is the file's folder.

    Raises:
        FileError: The file cannot be read, is not TOML, is another command's, or has a wrong value.
        NotFoundError: A key is not an option.
    """
    words = _words(kind, path)
    try:
        return _read(kind, "", words)
    except IiwaDnnError as error:
        raise FileError(path, str(error)) from error


def _words(kind: type[Any], path: Path) -> list[str]:
    """Return the command line that a settings file stands for."""
    values = read_toml(path)
    command = values.pop("command", kind.command)
    if command != kind.command:
        raise FileError(path, f"holds settings of {command!r}, not of {kind.command!r}")
    asked_for = ("settings", "overwrite")  # by a person, on the command line
    known = {field.name: field.default for field in fields(kind) if field.name not in asked_for}
    words = [f"--out={path.parent}"]
    for key, value in values.items():
        name = key.replace("-", "_")
        if name not in known:
            raise NotFoundError(f"setting in {path}", key, known)
        if isinstance(known[name], bool):
            if not isinstance(value, bool):
                raise FileError(path, f"{key} must be true or false, not {value!r}")
            words.append(_option(name) if value else _option(f"no_{name}"))
        elif isinstance(value, list):
            words += [_option(name), *map(str, value)]
        elif isinstance(value, dict | bool):
            raise FileError(path, f"{key} must be a text, a number or a list, not {value!r}")
        else:
            words.append(f"{_option(name)}={value}")
    return words


def _option(field: str) -> str:
    return "--" + field.replace("_", "-")


def _read(kind: type[S], prog: str, words: Sequence[str], default: S | None = None) -> S:
    """Read words over default options; see `parse` for the errors."""
    names: dict[str, Field[Any]] = {_option(field.name): field for field in fields(kind)}  # type: ignore[arg-type]
    many = (bool, tuple)
    for word, following in pairwise([*words, "--"]):
        takes_one = word in names and not isinstance(names[word].default, many)
        if takes_one and (following.startswith("--") or following in ("-q", "-v", "-h")):
            raise InvalidInputError(word, f"a value is missing {_HINT}")
    start: Any = kind() if default is None else default
    # tyro knows only the form of a switch that changes it: --no-plots, or --plots over a file.
    switches = {name: getattr(start, field.name) for name, field in names.items()}
    idle = {k if on else f"--no-{k[2:]}" for k, on in switches.items() if isinstance(on, bool)}
    about = f"{getdoc(kind)}\n\n{EXIT_CODES}"
    options: S
    given = [word for word in words if word not in idle]
    more = {"prog": prog, "description": about, "default": start, "return_unknown_args": True}
    options, unread = _read_quietly(kind, given, **more)
    for word in unread:
        if not word.startswith("-"):
            raise IiwaDnnError(f"one argument too many: {word!r} {_HINT}")
        near = get_close_matches(word.partition("=")[0][2:], [name[2:] for name in names], n=1)
        hint = f"; did you mean: --{near[0]}" if near else ""
        raise IiwaDnnError(f"no option {word!r}{hint} {_HINT}")
    for name, field in names.items():
        value = getattr(options, field.name)
        if isinstance(value, _Wrong):
            raise InvalidInputError(name, value)
    return options


def _read_quietly(kind: Any, words: Sequence[str], **more: Any) -> Any:
    """Let tyro read words, and put what it does not understand in one line."""
    try:
        with redirect_stderr(io.StringIO()):
            return tyro.cli(kind, args=words, registry=_registry, **more)
    except SystemExit as end:
        if not end.code:
            raise
        raise IiwaDnnError(f"not understood: {' '.join(words)} {_HINT}") from None


_registry = ConstructorRegistry()
_asking = False


@_registry.primitive_rule
def _lenient(info: PrimitiveTypeInfo) -> PrimitiveConstructorSpec[Any] | None:
    """Take tyro's own rule for a type, and let what it refuses through as a `_Wrong`."""
    global _asking
    if _asking or info.type is bool:
        return None
    _asking = True  # so that tyro's own rule is found, not this one again
    try:
        spec = ConstructorRegistry.get_primitive_spec(info)
    finally:
        _asking = False
    if not isinstance(spec, PrimitiveConstructorSpec):
        return None
    convert, parts = spec.instance_from_str, get_args(info.type) or (info.type,)
    wanted = "a whole number" if int in parts else "numbers" if ... in parts else "a number"
    if spec.choices is not None:
        wanted = f"one of {', '.join(spec.choices)}"

    def attempt(words: list[str]) -> Any:
        try:
            return convert(words)
        except ValueError:
            return _Wrong(f"must be {wanted}, not {' '.join(words)!r}")

    return replace(spec, choices=None, instance_from_str=attempt)


def tell(options: RunOptions, *lines: str) -> None:
    """Print lines unless the command is quiet; if it is verbose, the files in its folder too."""
    if not options.quiet:
        print(*lines, sep="\n")
        if options.verbose:
            list_files(options.out)


def list_files(folder: Path) -> None:
    """Print the files in a folder with their sizes, one a line."""
    for file in sorted(path for path in folder.iterdir() if path.is_file()):
        print(f"  {file.name:<28}{file.stat().st_size / 1000:10,.1f} kB")


def progress_bar(total: int, unit: str, quiet: bool) -> Any:
    """Return a progress bar; it is not shown where standard error is not a terminal."""
    hidden, in_thousands = True if quiet else None, unit == "step"
    return tqdm(total=total, unit=unit, unit_scale=in_thousands, dynamic_ncols=True, disable=hidden)
