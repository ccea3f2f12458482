"""Parts of one's own, named on the command line: ``module:NAME`` or ``path/to/file.py:NAME``."""

import hashlib
import runpy
import sys
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.files import one_line


def load_part(kind: str, name: str) -> Any:
    """Load a part from outside the package.

    Args:
        kind: Kind of the part in errors, for example ``"network"``.
        name: ``module:NAME``, or ``path/to/file.py:NAME``.

    Raises:
        NotFoundError: The module does not have the name.
        InvalidInputError: The module cannot be imported.
    """
    place, _, attribute = name.rpartition(":")
    own = _names_in(kind, place)
    if attribute not in own:
        raise NotFoundError(f"{kind} in {place}", attribute, [k for k in own if k[0] != "_"])
    return own[attribute]


def digest(kind: str, name: str) -> str:
    """Hash the file that a part from outside stands in."""
    place = name.rpartition(":")[0]
    file = _names_in(kind, place)["__file__"]
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()[:24]


@cache
def _names_in(kind: str, place: str) -> dict[str, Any]:
    """Return what a module, found from the current folder too, or a file defines."""
    try:
        if place.endswith(".py"):
            return runpy.run_path(place, run_name=Path(place).stem)
        if str(Path.cwd()) not in sys.path:
            sys.path.append(str(Path.cwd()))
        return vars(import_module(place))
    except Exception as error:  # whatever the file of others raises
        raise InvalidInputError(kind, f"{place} cannot be imported ({one_line(error)})") from error
