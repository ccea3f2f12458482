"""Errors of the package: one tree, each error with its evidence."""

import copyreg
import os
import sys
import warnings
from collections.abc import Iterable
from difflib import get_close_matches
from importlib import import_module
from typing import Any


class IiwaDnnError(Exception):
    """Base of every error that this package raises on purpose."""

    def __reduce__(self) -> tuple[object, ...]:
        # Not by the constructor, whose arguments are others than the message.
        return copyreg.__newobj__, (type(self),), {**vars(self), "args": self.args}  # type: ignore[attr-defined]


class InvalidInputError(IiwaDnnError, ValueError):
    """An argument is outside what the function accepts.

    Attributes:
        argument: Name of the argument, as the caller wrote it.
        problem: Reason of the refusal, in a few words.
        value: The value that was refused.
    """

    def __init__(self, argument: str, problem: str, value: object = None) -> None:
        self.problem = " ".join(problem.split())  # an array takes many lines
        super().__init__(f"{argument}: {self.problem}")
        self.argument = argument
        self.value = value


class NotFoundError(IiwaDnnError, LookupError):
    """A name is not among those that exist.

    Attributes:
        kind: What was looked for, for example ``"robot"`` or ``"frame"``.
        name: The name that was given.
        available: The names that exist.
    """

    def __init__(self, kind: str, name: str, available: Iterable[str]) -> None:
        self.kind = kind
        self.name = name
        self.available = tuple(available)
        near = get_close_matches(name, self.available, n=3)
        shown = [repr(each) if ", " in each else each for each in near or self.available[:12]]
        listed = f"; {'did you mean' if near else 'there are'}: {', '.join(shown)}"
        more = "" if near or len(self.available) <= 12 else ", ..."
        super().__init__(f"no {kind} {name!r}{listed if shown else ''}{more}")


class RunInterrupted(KeyboardInterrupt):
    """A run is ended by Ctrl-C, or by a signal that counts as it.

    Attributes:
        record: `Record` of the steps that were taken, at least one.
    """

    def __init__(self, *args: object, record: Any = None) -> None:
        super().__init__(*args)
        self.record = record


class FileError(IiwaDnnError, OSError):
    """A file cannot be read, written or understood.

    Attributes:
        path: The file.
        reason: What is wrong with it, in a few words.
    """

    def __init__(self, path: str | os.PathLike[str], reason: str) -> None:
        self.path = str(path)
        self.reason = reason
        super().__init__(f"{self.path}: {reason}")


class NoSolutionError(IiwaDnnError):
    """A network's equations have no solution at a state, which the message names."""


class MissingDependencyError(IiwaDnnError, ImportError):
    """A part of the package needs something that is not installed.

    Attributes:
        missing: What is missing.
        remedy: How to get it, in a few words.
    """

    def __init__(self, missing: str, remedy: str) -> None:
        super().__init__(f"{missing} is missing: {remedy}")
        self.missing = missing
        self.remedy = remedy


def import_extra(module: str, remedy: str) -> Any:
    """Import a Python package that is not part of a plain install.

    Raises:
        MissingDependencyError: It is not installed; the remedy says how to install it.
    """
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise MissingDependencyError(f"the Python package {package}", remedy) from error


def warn_caller(message: str) -> None:
    """Warn of the line outside of this package that called it."""
    frame = sys._getframe()
    level = 1
    while frame.f_back is not None and frame.f_globals["__name__"].startswith("iiwa_dnn."):
        frame = frame.f_back
        level += 1
    warnings.warn(message, stacklevel=level)
