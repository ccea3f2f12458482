"""Arguments into settings, settings into a file and back, and what goes wrong into one line.

tyro reads the arguments and writes the help. What it says of an argument that is wrong fills a box
of many lines; here it is cut down to its first sentence and a hint.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import re
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from difflib import get_close_matches
from importlib.metadata import version
from pathlib import Path
from typing import Any, NoReturn, TypeVar

import tomli_w
import tyro
from tqdm import tqdm

from iiwa_dnn.app.interrupts import ended_by_signals
from iiwa_dnn.errors import FileError, IiwaDnnError, NoSolutionError, NotFoundError
from iiwa_dnn.files import one_line, write_text

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

S = TypeVar("S")

SETTINGS_FILE = "settings.toml"
"""Name of the settings in a run's folder."""

# They say how a run is shown and kept, not what it is, and stay out of a run's settings file.
_NOT_KEPT = ("settings", "out", "quiet", "verbose")


def parse(kind: type[S], prog: str, arguments: Sequence[str] | None = None) -> S:
    """Read a command's arguments, over those of the file that ``--settings`` names.

    Args:
        kind: One of the dataclasses of `iiwa_dnn.app.settings`.
        prog: What the command is called in messages.
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        The settings.

    Raises:
        SystemExit: After ``--help`` with code 0; with code 2 where an argument or the file is
            wrong, after one line on standard error.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    file = _settings_file(kind, given)
    if file is None:
        return _parse(kind, prog, given)
    try:
        from_file = _parse(kind, f"{prog}: error: {file}", tokens(kind, file))
    except IiwaDnnError as error:
        _exit(prog, error)
    return _parse(kind, prog, given, from_file)


def run_command(
    kind: type[S], prog: str, run: Callable[[S], int], arguments: Sequence[str] | None = None
) -> int:
    """Parse the arguments, run the command, and turn the package's errors into one line.

    Args:
        kind: The command's settings.
        prog: What the command is called in messages.
        run: Takes the settings and returns the exit code.
        arguments: As in `parse`.

    Returns:
        The exit code; after an error of the package 2, or 1 where a step had no solution.
        ``--verbose`` shows the error in full first.

    Raises:
        SystemExit: Ctrl-C or SIGTERM came (`iiwa_dnn.app.interrupts`), or as in `parse`.
    """
    settings = parse(kind, prog, arguments)
    try:
        with ended_by_signals():
            return run(settings)
    except IiwaDnnError as error:
        if getattr(settings, "verbose", False):
            traceback.print_exc()
        print(_error_line(prog, error), file=sys.stderr)
        return 1 if isinstance(error, NoSolutionError) else 2


def save_settings(settings: Any, folder: Path) -> Path:
    """Write ``settings.toml``, from which ``--settings`` repeats the run.

    Where the run went to and how much it said are left out. A path of a robot is made absolute.

    Args:
        settings: The command's settings.
        folder: The run's folder; it must exist.

    Returns:
        The file written.

    Raises:
        FileError: If it cannot be written.
    """
    values: dict[str, Any] = {}
    for field in fields(settings):
        value = getattr(settings, field.name)
        if field.name in _NOT_KEPT or value is None or value == ():
            continue
        if field.name == "robot" and (value.endswith(".urdf") or os.sep in value):
            value = str(Path(value).resolve())
        values[field.name] = list(value) if isinstance(value, tuple) else value
    head = f"# iiwa_dnn {version('iiwa-dnn')}; to repeat the run: --settings with this file\n\n"
    path = folder / SETTINGS_FILE
    write_text(path, head + tomli_w.dumps(values))
    return path


def tokens(kind: type[Any], path: Path) -> list[str]:
    """The command-line arguments that a settings file stands for.

    Args:
        kind: The command's settings.
        path: A TOML file whose keys are fields of `kind`.

    Returns:
        The arguments; what their values are worth is for the parser to say.

    Raises:
        FileError: The file cannot be read, is not TOML, or has a value that is no option's.
        NotFoundError: A key is not an option.
    """
    try:
        values: Mapping[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:  # ValueError: not TOML, not UTF-8, a NUL in the path
        raise FileError(path, f"cannot be read as TOML: {one_line(error)}") from error
    known = {field.name: field.default for field in fields(kind) if field.name != "settings"}
    found: list[str] = []
    for key, value in values.items():
        name = key.replace("-", "_")
        if name not in known:
            raise NotFoundError(f"setting in {path}", key, known)
        option = "--" + name.replace("_", "-")
        if isinstance(known[name], bool):
            if not isinstance(value, bool):
                raise FileError(path, f"{key} must be true or false, not {value!r}")
            if value != known[name]:
                found.append(option if value else f"--no-{option[2:]}")
        elif isinstance(value, list):
            found += [option, *map(str, value)]
        elif isinstance(value, dict | bool):
            raise FileError(path, f"{key} must be a text, a number or a list, not {value!r}")
        else:
            found.append(f"{option}={value}")
    return found


def list_files(folder: Path) -> None:
    """Print the files in a folder with their sizes, one a line."""
    for file in sorted(path for path in folder.iterdir() if path.is_file()):
        print(f"  {file.name:<28}{file.stat().st_size / 1000:10,.1f} kB")


def progress_bar(total: int, unit: str, quiet: bool) -> Any:
    """A progress bar; none where standard error is not a terminal, or all should be quiet."""
    return tqdm(
        total=total,
        unit=unit,
        unit_scale=unit == "step",
        dynamic_ncols=True,
        disable=True if quiet else None,
    )


def unknown_command(prog: str, name: str, available: Sequence[str]) -> NoReturn:
    """End the process with code 2 and a line that names the commands near to the one given."""
    _exit(prog, NotFoundError("command", name, available))


def _settings_file(kind: type[Any], arguments: list[str]) -> Path | None:
    """What ``--settings`` names; None where it is not given, or not as it should be."""
    if not any(field.name == "settings" for field in fields(kind)):
        return None
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False, exit_on_error=False)
    parser.add_argument("--settings", type=Path)
    try:
        found, _ = parser.parse_known_args(arguments)
    except argparse.ArgumentError:  # the whole parser says it better
        return None
    file: Path | None = found.settings
    return file


def _parse(kind: type[S], prog: str, arguments: list[str], default: S | None = None) -> S:
    said = io.StringIO()
    options: dict[str, Any] = {} if default is None else {"default": default}
    try:
        # Only what tyro says on standard error is an error; its help goes its own way.
        with contextlib.redirect_stderr(said):
            settings: S = tyro.cli(
                kind,
                prog=prog,
                args=arguments,
                config=(tyro.conf.HelptextFromCommentsOff,),
                **options,
            )
        return settings
    except SystemExit as end:
        if end.code:
            print(f"{_prefix(prog)}{_first_sentence(kind, said.getvalue())}", file=sys.stderr)
        raise


def _first_sentence(kind: type[Any], box: str) -> str:
    """What stands in tyro's box above its first rule, and a hint."""
    lines = [line.strip("│ ") for line in box.splitlines()]
    # The title is in the frame, or has a rule below it where the terminal cannot show frames.
    parts = "\n".join("" if line[:1] in "╭╰" else line for line in lines)
    texts = [" ".join(part.split()) for part in re.split(r"^[─-]{3,}$", parts, flags=re.MULTILINE)]
    text = next(iter(texts[0 if "╭" in box else 1 :]), "").rstrip(".") or "not understood"
    options = ["--" + field.name.replace("_", "-") for field in fields(kind)]
    wrong = [word.strip(",") for word in text.split() if word.startswith("--")]
    near = [match for word in wrong for match in get_close_matches(word, options, 1)]
    if text.startswith("Unrecognized") and near:
        return f"{text}; did you mean {' '.join(near)}? (--help lists the options)"
    return f"{text} (--help lists the options)"


def _prefix(prog: str) -> str:
    # A file's own errors come with their place in the prefix already.
    return f"{prog}: " if ": error: " in prog else f"{prog}: error: "


def _error_line(prog: str, error: IiwaDnnError) -> str:
    # One line, whatever stands in a file's name.
    return f"{prog}: error: {' '.join(str(error).split())}"


def _exit(prog: str, error: IiwaDnnError) -> NoReturn:
    print(_error_line(prog, error), file=sys.stderr)
    raise SystemExit(2)
