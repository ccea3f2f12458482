"""Settings files, and the folders of runs that they tell apart.

Every run keeps its options in its folder, in a TOML file that repeats it. A folder belongs to the
run that its settings file describes: that run may write it again, no other one may unasked.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Collection
from dataclasses import fields
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

import tomli_w

from iiwa_dnn.app.arguments import option, read
from iiwa_dnn.app.options import RunOptions
from iiwa_dnn.errors import FileError, IiwaDnnError, NotFoundError
from iiwa_dnn.files import one_line, prepare_folder, write_text

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

S = TypeVar("S")

SETTINGS_FILE = "settings.toml"
"""Name of the settings in a run's folder."""

# They say how a run is shown and kept, not what it is, and stay out of its settings file.
_NOT_KEPT = {"settings", "out", "overwrite", "quiet", "verbose"}
# They stand in the file, but a run with other values is still the same run.
_NOT_COMPARED = {"plots", "pictures", "video", "workers", "dask"}


def read_settings(kind: type[S], path: Path) -> S:
    """Read the options in a settings file.

    Args:
        kind: Dataclass of the command's options.
        path: A TOML file whose keys are options.

    Returns:
        The options; where the file does not set ``out``, it is the file's folder.

    Raises:
        FileError: The file cannot be read, is not TOML, is another command's, or has a wrong value.
        NotFoundError: A key is not an option.
    """
    words = _words(kind, path)
    try:
        return read(kind, "", words)
    except IiwaDnnError as error:
        raise FileError(path, str(error)) from error


def save_settings(options: RunOptions, folder: Path) -> Path:
    """Write ``settings.toml``, from which ``--settings`` repeats the run.

    A file that describes the same run already is left as it is, since a person may have written it.

    Args:
        options: Options of the run. Where it went to and how much it printed are left out.
        folder: The run's folder; it must exist.

    Returns:
        The file.

    Raises:
        FileError: If it cannot be written.
    """
    path = folder / SETTINGS_FILE
    values = _values(options)
    if not _same(_values_in(path, options), values):
        head = f"# iiwa_dnn {version('iiwa-dnn')}; to repeat the run: --settings with this file"
        write_text(path, f"{head}\n\n{tomli_w.dumps({'command': options.command, **values})}")
    return path


def claim_folder(options: RunOptions, resumes: Collection[str] = ()) -> Path:
    """Prepare the folder of a run, unless it holds anything but an earlier pass of the same run.

    Args:
        options: Options of the run; with ``overwrite`` the folder may hold anything.
        resumes: Names in the folder from which a sweep goes on. A sweep of another size may go on
            in the same folder, since its finished cells stay.

    Returns:
        The folder.

    Raises:
        FileError: The folder holds something else, or cannot be written to.
    """
    folder = options.out
    if folder.is_dir() and not options.overwrite:
        try:
            held = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
        except OSError as error:
            raise FileError(folder, f"cannot be read ({one_line(error)})") from error
        if options.settings is not None and options.settings.parent.resolve() == folder.resolve():
            held -= {options.settings.name} - {SETTINGS_FILE}
        there = _values_in(folder / SETTINGS_FILE, options)
        own = there is not None and (bool(resumes) or _same(there, _values(options)))
        if held - set(resumes) and not own:
            raise FileError(
                folder, "holds another run or other files: choose another --out, or --overwrite"
            )
    return prepare_folder(folder)


def _values_in(path: Path, options: RunOptions) -> dict[str, Any] | None:
    """Return the values in a settings file of the same command; None if there is no such file."""
    try:
        return _values(read_settings(type(options), path)) if path.is_file() else None
    except IiwaDnnError:
        return None


def _same(there: dict[str, Any] | None, here: dict[str, Any]) -> bool:
    """Whether two sets of values describe the same run."""
    if there is None:
        return False
    return all(there.get(key) == here.get(key) for key in {*there, *here} - _NOT_COMPARED)


def _values(options: RunOptions) -> dict[str, Any]:
    """Values of the options that a settings file keeps; paths are made absolute."""
    values: dict[str, Any] = {}
    for field in fields(options):
        value = getattr(options, field.name)
        if field.name in _NOT_KEPT or value is None or value == ():
            continue
        if field.name in ("robot", "reference") and (
            os.sep in value or value.endswith((".urdf", ".csv"))
        ):
            value = str(Path(value).resolve())
        values[field.name] = list(value) if isinstance(value, tuple) else value
    return values


def _words(kind: type[Any], path: Path) -> list[str]:
    """Return the command line that a settings file stands for."""
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:  # ValueError: not TOML, not UTF-8, a NUL in the path
        raise FileError(path, f"cannot be read as TOML: {one_line(error)}") from error
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
            words.append(option(name) if value else option(f"no_{name}"))
        elif isinstance(value, list):
            words += [option(name), *map(str, value)]
        elif isinstance(value, dict | bool):
            raise FileError(path, f"{key} must be a text, a number or a list, not {value!r}")
        else:
            words.append(f"{option(name)}={value}")
    return words
