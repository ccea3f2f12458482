"""Parts of one's own, named on the command line: ``module:NAME`` or ``path/to/file.py:NAME``."""

import hashlib
import importlib
import importlib.util
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.files import one_line

T = TypeVar("T")


def find_part(kind: str, name: str, known: Mapping[str, T]) -> T:
    """Return a part by its name, or load it from outside the package if the name has a colon.

    Args:
        kind: Kind of the part in errors, for example ``"network"``.
        name: Name among `known`, or ``module:NAME``, or ``path/to/file.py:NAME``.
        known: Parts by name.

    Raises:
        NotFoundError: Neither `known` nor the module has the name.
        InvalidInputError: The module cannot be imported.
    """
    if name in known:
        return known[name]
    place, colon, attribute = name.rpartition(":")
    if not colon:
        raise NotFoundError(kind, name, known)
    module = _import(kind, place)
    if not hasattr(module, attribute):
        own = [each for each in vars(module) if not each.startswith("_")]
        raise NotFoundError(f"{kind} in {place}", attribute, own)
    found: T = getattr(module, attribute)
    return found


def digest(name: str) -> str:
    """Hash the file that a part from outside stands in."""
    file = _import("part", name.rpartition(":")[0]).__file__
    return hashlib.sha256(Path(str(file)).read_bytes()).hexdigest()[:24]


@cache
def _import(kind: str, place: str) -> ModuleType:
    """Import a module by its name, from the current folder too, or a file by its path."""
    try:
        if not place.endswith(".py"):
            if str(Path.cwd()) not in sys.path:
                sys.path.append(str(Path.cwd()))
            return importlib.import_module(place)
        path = Path(place).resolve()
        spec = importlib.util.spec_from_file_location(path.stem, path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules.setdefault(path.stem, module)  # a dataclass looks for its module there
        spec.loader.exec_module(module)
        return module
    except Exception as error:  # whatever the file of others raises
        raise InvalidInputError(kind, f"{place} cannot be imported ({one_line(error)})") from error
