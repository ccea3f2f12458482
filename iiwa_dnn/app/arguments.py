"""The words of a command line, read into one of the dataclasses of `iiwa_dnn.app.options`.

tyro reads the words and writes the help. It reports a wrong word in a box of many lines and ends
the process; here it is one line. So tyro hands an unknown option back unread, and lets a wrong
value through as a `_Wrong`; both are refused after it.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import redirect_stderr
from dataclasses import Field, fields, replace
from difflib import get_close_matches
from itertools import pairwise
from typing import Any, TypeVar, get_args

import tyro
from tyro.constructors import ConstructorRegistry, PrimitiveConstructorSpec, PrimitiveTypeInfo

from iiwa_dnn.errors import IiwaDnnError, InvalidInputError

S = TypeVar("S")

CONFIG = (tyro.conf.HelptextFromCommentsOff,)
_HINT = "(--help lists the options)"


class _Wrong(str):
    """The reason why an option's words are not accepted, in the place of its value."""


def read(kind: type[S], prog: str, words: Sequence[str], default: S | None = None) -> S:
    """Read the words of a command line.

    Args:
        kind: Dataclass of the options.
        prog: Name of the command in its help.
        words: The words, without the program's name.
        default: Values of the options that are not among the words; None takes those of `kind`.

    Returns:
        The options.

    Raises:
        IiwaDnnError: An option does not exist, or its value is missing or not acceptable.
        SystemExit: After ``--help``, with code 0.
    """
    _check_values_follow(kind, words)
    start: Any = kind() if default is None else default
    # tyro knows only the form of a switch that changes it: --no-plots, or --plots over a file.
    switches = {name: getattr(start, field.name) for name, field in _names(kind).items()}
    idle = {k if on else f"--no-{k[2:]}" for k, on in switches.items() if isinstance(on, bool)}
    words = [word for word in words if word not in idle]
    try:
        with redirect_stderr(io.StringIO()):
            options: S
            options, unread = tyro.cli(
                kind, prog=prog, args=words, default=start, return_unknown_args=True,
                registry=_registry, config=CONFIG,
            )  # fmt: skip
    except SystemExit as end:
        if not end.code:
            raise
        raise IiwaDnnError(f"not understood: {' '.join(words)} {_HINT}") from None
    for word in unread:
        if not word.startswith("-"):
            raise IiwaDnnError(f"one argument too many: {word!r} {_HINT}")
        near = get_close_matches(word.partition("=")[0][2:], [k[2:] for k in _names(kind)], n=1)
        hint = f"; did you mean: --{near[0]}" if near else ""
        raise IiwaDnnError(f"no option {word!r}{hint} {_HINT}")
    for name, field in _names(kind).items():
        value = getattr(options, field.name)
        if isinstance(value, _Wrong):
            raise InvalidInputError(name, value)
    return options


def option(field: str) -> str:
    """Return the option that a field stands for: ``--joint-limit`` for ``joint_limit``."""
    return "--" + field.replace("_", "-")


def _names(kind: Any) -> dict[str, Field[Any]]:
    return {option(field.name): field for field in fields(kind)}


def _check_values_follow(kind: type[Any], words: Sequence[str]) -> None:
    """Refuse an option that takes one value and is last, or before another option."""
    switches = (bool, tuple)
    valued = {k for k, field in _names(kind).items() if not isinstance(field.default, switches)}
    for word, following in pairwise([*words, "--"]):
        if word in valued and (following.startswith("--") or following in ("-q", "-v", "-h")):
            raise InvalidInputError(word, f"a value is missing {_HINT}")


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
