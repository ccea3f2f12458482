"""Atomic writing of files: a reader sees the old one or the whole new one, never half of it."""

import contextlib
import json
import math
import os
import secrets
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any, BinaryIO

import numpy as np

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import FileError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

parse_toml: Callable[[str], dict[str, Any]] = tomllib.loads
"""Read TOML out of a text; what is not TOML is a ValueError."""


def write_atomically(path: str | os.PathLike[str], write: Callable[[BinaryIO], object]) -> None:
    """Write a file under a temporary name beside it, then rename it into place.

    If anything stops the writing (a full disk, an error in ``write``, Ctrl-C), the old file stays
    and the temporary one is removed.

    Args:
        path: The file to write; its folder must exist.
        write: Called once with the open binary file.

    Raises:
        FileError: If the file cannot be written. Errors of ``write`` itself are passed on.
    """
    path = Path(path)
    # In the same folder, because a rename is atomic only inside one file system.
    temporary = path.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        with temporary.open("xb") as file:
            write(file)
            file.flush()
            # Without it, a power cut may leave the new name on an empty file.
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        raise FileError(path, f"cannot be written ({one_line(error)})") from error
    finally:
        with contextlib.suppress(OSError):  # it is there only after an error
            temporary.unlink()


def prepare_folder(folder: str | os.PathLike[str]) -> Path:
    """Make a folder with its parents, unless it exists already, and return it.

    Raises:
        FileError: If it cannot be made, or not written to.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        TemporaryFile(dir=folder).close()
    except (OSError, ValueError) as error:  # ValueError: a name with a NUL in it
        raise FileError(folder, f"cannot be written to ({one_line(error)})") from error
    return folder


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a UTF-8 text file atomically, with Unix line ends on every system.

    Raises:
        FileError: If the file cannot be written.
    """
    write_atomically(path, lambda file: file.write(text.encode("utf-8")))


def write_csv(path: str | os.PathLike[str], head: Iterable[str], table: Array) -> None:
    """Write a table (k, columns) under a head as a CSV file, all digits kept, atomically.

    Raises:
        FileError: If the file cannot be written.
    """
    lines = (",".join(map(repr, row)) for row in table.tolist())
    write_text(path, "\n".join([",".join(head), *lines]) + "\n")


def write_json(path: str | os.PathLike[str], value: object) -> None:
    """Write plain JSON types atomically; see `plain`.

    Raises:
        FileError: If the file cannot be written.
        TypeError: If the value is not made of JSON types.
        ValueError: If the value holds NaN or an infinity.
    """
    write_text(path, json.dumps(value, indent=2, allow_nan=False) + "\n")


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read a TOML file.

    Raises:
        FileError: It cannot be read, or is not TOML.
    """
    try:
        return parse_toml(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:  # ValueError: not TOML, not UTF-8, a NUL in the path
        raise FileError(path, f"cannot be read as TOML: {one_line(error)}") from error


def plain(value: object) -> Any:
    """Return a value in the types that JSON has, as it would come back from a JSON file.

    NumPy arrays and scalars become lists and numbers, tuples become lists. JSON has neither NaN
    nor infinity: both become None, so an unlimited joint reads as "no limit".

    Raises:
        TypeError: If the value has no such form.
    """
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, str | int):
        return value
    raise TypeError(f"{type(value).__name__} is not a JSON type")


def one_line(error: BaseException) -> str:
    """Reduce an exception to its message in one line; an OSError to its cause alone."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return " ".join(str(error).split()) or type(error).__name__


def percent(fraction: float) -> str:
    """Show a fraction as ``12.3 %``; one below 1 never as 100.0 %."""
    return f"{min(100.0 * fraction, 100.0 if fraction >= 1.0 else 99.9):.1f} %"
