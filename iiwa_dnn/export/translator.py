"""Translator of compiled Python functions to C99.

It reads the small subset of Python in which this package's compiled functions are written, and
refuses by file and line what it does not know. A function is translated for the sizes of the arrays
that it is called with: lengths become constants, a loop that enters functions by their addresses is
written out, and an array that a function makes for itself becomes an array of fixed size.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.lines import Variable, identifier, wrapped
from iiwa_dnn.export.statements import Body, translated
from iiwa_dnn.export.values import (
    DOUBLE,
    INT,
    Array,
    Known,
    Scalar,
    Storage,
    Struct,
    Tuple,
    Value,
    declaration,
    knowns,
    number,
    qualified,
    renewed,
    same,
    skeleton,
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
        known: What is known of its arguments; the code depends on those that were used.
        parameters: Its parameters, whose arrays are written into or not.
        result: Type of its result; None for none.
        constant: Its result, if that is known.
    """

    name: str
    known: list[Known]
    parameters: list[Any]
    result: Any
    constant: Value | None


class Translator:
    """A translation of functions that call each other into one text of C.

    Attributes:
        functions: Texts of the functions, those that are called before those that call.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        Storage.all.clear()
        self.functions: list[str] = []
        self._structs: dict[str, tuple[Any, str]] = {}
        self._tables: dict[str, tuple[Value, str]] = {}
        self._helpers: set[str] = set()
        self._fields: dict[tuple[str, str], Storage] = {}
        self._made: dict[tuple[int, str], list[Made]] = {}
        self._owners: dict[str, Any] = {}
        self._open: list[Any] = []

    def text(self) -> str:
        """Return structs, tables and functions as one text."""
        helpers = [f"static {_HELPERS[name]}" for name in _HELPERS if name in self._helpers]
        structs = [text for _, text in self._structs.values()]
        tables = [text for _, text in self._tables.values()]
        return qualified("\n\n".join([*structs, *tables, *helpers, *self.functions]))

    def helper(self, name: str) -> str:
        """Return the name of one of C's own small functions, which becomes a part of the text."""
        self._helpers.add(name)
        return name

    def table(self, name: str, values: Any) -> Value:
        """Return a table of numbers that are known, (k,)."""
        made = self._tables.get(name)
        flat = np.ravel(values)
        if made is None:
            content = Known(flat)
            shape = tuple(Known(size) for size in np.shape(values))
            element = INT if flat.dtype.kind == "i" else DOUBLE
            value = Value(Array(element, shape, Storage(), content), name)
            texts = [number(each) for each in flat.tolist()]
            numbers = wrapped(f"    {', '.join(texts) or '0.0'}")
            text = f"static const double {name}[{max(flat.size, 1)}] = {{\n{numbers}\n}};"
            self._tables[name] = (value, text)
            made = self._tables[name]
        return made[0]

    def named_tuple(self, kind: Any, values: dict[str, Value]) -> Struct:
        """Return the struct of a named tuple with these values."""
        tag = re.sub("(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", kind.__name__).lower()
        fields: dict[str, Any] = {}
        for name, value in values.items():
            own = value.kind
            if isinstance(own, Array) and not own.in_table:
                storage = self._fields.setdefault((tag, name), Storage())
                storage.passes_to(own.storage)
                own = Array(own.element, own.shape, storage, own.content)
            elif own is INT:
                own = DOUBLE if kind.__annotations__.get(name) in (float, "float") else INT
            fields[name] = own
        struct = Struct(tag, fields)
        about = (inspect.getdoc(kind) or "").splitlines()[:1]
        self.define(struct, *about)
        return struct

    def define(self, kind: Any, about: str = "") -> None:
        """Write the struct of a type, once."""
        if kind.tag in self._structs:
            return
        if isinstance(kind, Tuple):
            if not isinstance(kind.element, Scalar):
                self.define(kind.element)
            fields = [declaration(kind.element, f"at[{kind.length}]")]
        else:
            shown = {
                name: own
                for name, own in kind.fields.items()
                if not getattr(own, "in_table", False)
            }
            for own in shown.values():
                if isinstance(own, Struct | Tuple):
                    self.define(own)
            fields = [declaration(own, name) for name, own in shown.items()]
        lines = "".join(f"    {field};\n" for field in fields)
        comment = f"/* {about} */\n" if about else ""
        self._structs[kind.tag] = (kind, f"{comment}struct {kind.tag} {{\n{lines}}};")

    def function(
        self, function: Any, arguments: list[Value], refusal: Callable[[str], Exception]
    ) -> Made:
        """Return a function for arguments of certain types, translated if it is not yet."""
        plain = getattr(function, "py_func", function)
        key = (id(plain), ",".join(map(_form, arguments)))
        known = [each for argument in arguments for each in _known(argument)]
        for made in self._made.get(key, []):
            if all(
                not old.used or same(old, new) for old, new in zip(made.known, known, strict=True)
            ):
                break
        else:
            if plain in self._open:
                raise refusal(f"{plain.__name__} calls itself")
            self._open.append(plain)
            made = self._translate(plain, arguments, len(self._made.get(key, [])))
            self._open.pop()
            self._made.setdefault(key, []).append(made)
        for old, new in zip(made.known, known, strict=True):
            if old.used:
                new.use()
        for parameter, argument in zip(made.parameters, arguments, strict=True):
            if isinstance(parameter, Array):
                parameter.storage.passes_to(argument.kind.storage)
        return made

    def _translate(self, function: Any, arguments: list[Value], earlier: int) -> Made:
        file, tree = _source(function)
        if len(tree.args.args) != len(arguments):
            raise InvalidInputError(function.__name__, f"{file}: takes other arguments")
        parameters: list[Variable] = []

        def bind(body: Body) -> None:
            parameters.clear()
            for own, argument in zip(tree.args.args, arguments, strict=True):
                parameters.append(_parameter(own.arg, argument, body))

        body = translated(self, function, file, tree, bind)
        known = [each for own in parameters for each in _known_of(own)]
        lines, names = body.lines.used()
        kinds = [own.kind for own in parameters]
        if body.known_result is not None:
            return Made("", known, kinds, body.result, body.known_result)
        shown = [text for own in parameters if _shown(own) for text in _declared(own)]
        given = [re.findall("\\w+", text)[-1] for text in shown]
        idle = [f"    (void){own};" for own in given if own not in names]
        start = declaration(body.result, "") if body.result is not None else "void "
        head = f"({', '.join(shown) or 'void'})"
        rest = "\n".join(["{", *idle, *lines, "}"])
        # For other sizes the text may come out the same.
        name, is_new = self._name_of(function, start + re.sub("\0\\d+\0", "", head) + rest)
        if is_new:
            about = " ".join([*(inspect.getdoc(function) or "").splitlines()[:1], f"({file})"])
            comment = wrapped(f"/* {about} */").replace("\n    ", "\n   ")
            self.functions.append(f"{comment}\n{wrapped(f'static {start}{name}{head}')}\n{rest}")
        return Made(name, known, kinds, body.result, None)

    def _name_of(self, function: Any, text: str) -> tuple[str, bool]:
        """Return the name in C of a function with this text, and whether it is a new one."""
        module = function.__module__.split(".")[-1]
        own = function.__name__
        start = f"{module}{own}" if own.startswith("_") else own
        if start in self._owners and self._owners[start][0] is not function:
            start = f"{module}_{own.strip('_')}"
        name = start
        count = 1
        while name in self._owners:
            if self._owners[name] == (function, text):
                return name, False
            count += 1
            name = f"{start}_{count}"
        self._owners[name] = (function, text)
        return name, True


def _source(function: Any) -> tuple[str, ast.FunctionDef]:
    """Return the file of a function, from the package's name on, and its syntax tree."""
    lines, first = inspect.getsourcelines(function)
    tree = ast.parse(textwrap.dedent("".join(lines))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    ast.increment_lineno(tree, first - 1)
    path = Path(inspect.getfile(function))
    parts = path.parts
    package = function.__module__.split(".")[0]
    start = len(parts) - 1 - parts[::-1].index(package) if package in parts else -1
    return "/".join(parts[start:]), tree


def _form(argument: Value) -> str:
    return skeleton(argument.kind) + ("=" if argument.kind is INT and argument.known else "")


def _known(argument: Value) -> list[Known]:
    """List what is known of an argument."""
    own = [argument.known] if argument.kind is INT and argument.known is not None else []
    return [*own, *knowns(argument.kind)]


def _known_of(parameter: Variable) -> list[Known]:
    own = [parameter.known] if parameter.known is not None else []
    return [*own, *knowns(parameter.kind)]


def _parameter(name: str, argument: Value, body: Body) -> Variable:
    """Return the parameter of a function for an argument, and make it known to the body."""
    kind = renewed(argument.kind, identifier(name))
    known = Known(argument.known.value) if argument.kind is INT and argument.known else None
    pointer = isinstance(kind, Struct) and kind.holds_arrays
    variable = Variable(identifier(name), kind, known, pointer)
    body.names[name] = variable
    if getattr(kind, "in_table", False):
        body.names[name] = Value(kind, identifier(name))
    body._stored.add(name)
    return variable


def _shown(parameter: Variable) -> bool:
    return not getattr(parameter.kind, "in_table", False)


def _declared(parameter: Variable) -> list[str]:
    """Return the declarations in C of a parameter."""
    kind = parameter.kind
    further = []
    if isinstance(kind, Array):
        further = [f"int {length}" for length in kind.shape if isinstance(length, str)]
    return [declaration(kind, parameter.name, parameter.pointer), *further]
