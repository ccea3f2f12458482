"""Translator of compiled Python functions to C99.

It reads the small subset of Python in which this package's compiled functions are written, and
refuses by file and line what it does not know. A function is translated for the sizes of the arrays
that it is called with: lengths become constants, a loop that enters functions by their addresses is
written out, and an array that a function makes for itself becomes an array of fixed size.
"""

import ast
import inspect
import re
import textwrap
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.compiling.library import source_of
from iiwa_dnn.export.expressions import WideError
from iiwa_dnn.export.lines import identifier, wrapped
from iiwa_dnn.export.statements import Body
from iiwa_dnn.export.values import (
    DOUBLE,
    INT,
    Array,
    Scalar,
    Storage,
    Struct,
    Value,
    number,
    qualified,
)

_HELPERS = {
    "double_min": "double double_min(double a, double b)\n{\n    return b < a ? b : a;\n}",
    "double_max": "double double_max(double a, double b)\n{\n    return b > a ? b : a;\n}",
    "int_min": "int int_min(int a, int b)\n{\n    return b < a ? b : a;\n}",
    "int_max": "int int_max(int a, int b)\n{\n    return b > a ? b : a;\n}",
    "square_of": "double square_of(double a)\n{\n    return a * a;\n}",
    "cube_of": "double cube_of(double a)\n{\n    return a * (a * a);\n}",
    "quotient": "int quotient(int a, int b)\n{\n"
    "    return a / b - (a % b != 0 && (a < 0) != (b < 0));\n}",
    "remainder_of": "int remainder_of(int a, int b)\n{\n"
    "    return a % b + ((a % b != 0 && (a < 0) != (b < 0)) ? b : 0);\n}",
    "double_remainder": "double double_remainder(double a, double b)\n{\n"
    "    const double left = fmod(a, b);\n"
    "    return left != 0.0 && (left < 0.0) != (b < 0.0) ? left + b : left;\n}",
}
"""Operations of Python that C does not have as they are."""


@dataclass
class Made:
    """A function for arguments of certain types.

    Attributes:
        name: Its name in C.
        parameters: Types of its parameters, whose arrays are written into or not.
        result: Type of its result; None for none.
        constant: Its result, if that is known.
    """

    name: str
    parameters: list[Any]
    result: Any
    constant: Value | None


class Translator:
    """A translation of functions that call each other into one text of C."""

    def __init__(self) -> None:
        """Begin with nothing."""
        Storage.all.clear()
        self._structs: dict[str, str] = {}
        self._tables: dict[str, str] = {}
        self._helpers: dict[str, str] = {}
        self._functions: dict[str, str] = {}
        self._fields: dict[tuple[str, str], Storage] = {}
        self._made: dict[Any, Made | None] = {}
        self._bodies: dict[tuple[Any, str], str] = {}

    def text(self) -> str:
        """Return structs, tables and functions as one text."""
        kinds = (self._structs, self._tables, self._helpers, self._functions)
        return qualified("\n\n".join(text for kind in kinds for text in kind.values()))

    def helper(self, name: str, *arguments: str) -> str:
        """Call one of C's own small functions, which becomes a part of the text."""
        self._helpers[name] = f"static {_HELPERS[name]}"
        return f"{name}({', '.join(arguments)})"

    def table(self, name: str, values: Any) -> Value:
        """Return a table of numbers that are known, of any shape."""
        flat = np.ravel(values).tolist()
        kind = Array(INT if values.dtype.kind == "i" else DOUBLE, values.shape, content=tuple(flat))
        if not kind.is_table:
            numbers = wrapped(", ".join(map(number, flat)) or "0.0", "    ").replace(
                "\n        ", "\n    "
            )
            head = f"static const double {name}[{max(len(flat), 1)}]"
            self._tables[name] = f"{head} = {{\n{numbers}\n}};"
        return Value(kind, name)

    def named_tuple(self, kind: Any, values: list[Value]) -> Struct:
        """Return the struct of a named tuple with these values."""
        tag = re.sub("(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", kind.__name__).lower()
        fields = []
        for name, value in zip(kind._fields, values, strict=True):
            own = value.kind
            if isinstance(own, Array):
                storage = self._fields.setdefault((tag, name), Storage())
                storage.pass_to(own.storage)
                own = replace(own, storage=storage)
            fields.append((name, own))
        struct = Struct(tag, tuple(fields))
        self.define(struct, (inspect.getdoc(kind) or "").partition("\n")[0])
        return struct

    def define(self, kind: Any, about: str = "") -> None:
        """Write the struct of a type, once, after those of its fields."""
        if kind.tag in self._structs:
            return
        for _, own in kind.members:
            if not isinstance(own, Array | Scalar):
                self.define(own)
        fields = [f"    {Value(own, name).declared()};\n" for name, own in kind.members]
        comment = f"/* {about} */\n" if about else ""
        self._structs[kind.tag] = f"{comment}struct {kind.tag} {{\n{''.join(fields)}}};"

    def function(self, function: Any, arguments: list[Value]) -> Made | None:
        """Return a function for arguments of certain types; None while it is being translated."""
        plain = source_of(function)
        kinds = [(own.kind, own.known if own.kind is INT else None) for own in arguments]
        key = (plain, *kinds)
        if key not in self._made:
            self._made[key] = None
            self._made[key] = self._translated(plain, arguments)
        made = self._made[key]
        for parameter, argument in zip(made.parameters if made else (), arguments, strict=False):
            if isinstance(parameter, Array):
                parameter.storage.pass_to(argument.kind.storage)
        return made

    def _translated(self, function: Any, arguments: list[Value]) -> Made:
        file, tree = _source(function)
        names = [argument.arg for argument in tree.args.args]
        parameters = [_parameter(*each) for each in zip(names, arguments, strict=True)]
        body = self._body(function, file, tree, dict(zip(names, parameters, strict=True)))
        kinds = [own.kind for own in parameters]
        name = ""
        if body.known_result is None:
            name = self._write(function, file, body, parameters)
        return Made(name, kinds, body.result, body.known_result)

    def _body(
        self, function: Any, file: str, tree: ast.FunctionDef, names: dict[str, Value]
    ) -> Body:
        """Translate a body, anew for each variable that turns out to be used outside its block."""
        wide: frozenset[str] = frozenset()
        while True:
            body = Body(self, function, file, tree, wide)
            body.take(names)
            try:
                body.block(tree.body)
            except WideError as error:
                wide |= {str(error)}
            else:
                return body

    def _write(self, function: Any, file: str, body: Body, parameters: list[Value]) -> str:
        """Write a function, unless its text is there already; return its name."""
        lines, read = body.lines.used()
        given = [each for own in parameters for each in _declared(own)]
        idle = [f"    (void){own.text};" for own in given if own.text not in read]
        result = Value(body.result, "").declared() if body.result is not None else "void "
        head = f"({', '.join(own.declared() for own in given) or 'void'})"
        rest = "\n".join(["{", *idle, *lines, "}"])
        # For other sizes the text may come out the same.
        key = (function, result + re.sub("\0\\d+\0", "", head + rest))
        if key not in self._bodies:
            name = self._free_name(function)
            about = f"{(inspect.getdoc(function) or '').partition(chr(10))[0]} ({file})"
            comment = wrapped(f"/* {about.strip()} */").replace("\n    ", "\n   ")
            text = f"{comment}\n{wrapped(f'static {result}{name}{head}')}\n{rest}"
            self._functions[name] = text
            self._bodies[key] = name
        return self._bodies[key]

    def _free_name(self, function: Any) -> str:
        """Return a name in C that no other function has; a private one begins with its module."""
        module = function.__module__.split(".")[-1]
        own = function.__name__
        names = [f"{module}{own}" if own.startswith("_") else own, f"{module}_{own.strip('_')}"]
        names += [f"{names[-1]}_{count}" for count in range(2, len(self._functions) + 3)]
        return next(name for name in names if name not in self._functions)


@lru_cache(maxsize=1000)
def _source(function: Any) -> tuple[str, ast.FunctionDef]:
    """Return the file of a function, from the package's name on, and its syntax tree."""
    lines, first = inspect.getsourcelines(function)
    tree = ast.parse(textwrap.dedent("".join(lines))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    ast.increment_lineno(tree, first - 1)
    path = Path(inspect.getfile(function)).as_posix()
    folder = function.__module__.partition(".")[0]
    return re.sub(f"^.*/(?={folder}/)", "", path), tree


def _parameter(name: str, argument: Value) -> Value:
    """Return the parameter of a function for an argument.

    A length that is not known becomes a further parameter, by the name of the array.
    """
    kind = argument.kind
    own = identifier(name)
    if isinstance(kind, Array) and not kind.is_table:
        shape = [
            size if isinstance(size, int) else f"{own}_{'columns' if axis else 'rows'}"
            for axis, size in enumerate(kind.shape)
        ]
        kind = replace(kind, shape=tuple(shape), storage=Storage())
    known = argument.known if kind is INT else None
    return Value(kind, own, known=known, pointer=isinstance(kind, Struct))


def _declared(parameter: Value) -> list[Value]:
    """Return a parameter as those of C."""
    kind = parameter.kind
    if not isinstance(kind, Array):
        return [parameter]
    lengths = [Value(INT, size) for size in kind.shape if isinstance(size, str)]
    return [] if kind.is_table else [parameter, *lengths]
