"""Translator of a package's kernels to C99, for sizes that are known at run time.

It reads source text alone. An array is a pointer and its sizes; what a kernel makes for itself
comes from an arena, and is given back where the kernel returns. What it does not know it refuses by
file and line.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .expressions import SIGNS, Expressions, Value, literal, number_text, product
from .kinds import ARRAYS, FLOAT, INT, NUMBERS, VOID, Kind, Kinds
from .sources import ENTRY, Module, Package, decoration


@dataclass
class Made:
    """A function of C.

    Attributes:
        name: Its name.
        about: Its docstring.
        parameters: Types of its parameters by their names in Python.
        result: Type of its result.
        decoration: The decorator that it has in Python.
        text: The function.
        written: Parameters, and members of parameters, that are arrays it writes into.
        done: Whether it is translated.
    """

    name: str
    about: str
    parameters: dict[str, Kind]
    result: Kind
    decoration: str
    text: str = ""
    written: set[str] = field(default_factory=set)
    done: bool = False

    @property
    def code(self) -> str:
        """Types of parameters and result as a text, one letter each."""
        own = "".join(kind.code for kind in self.parameters.values())
        return f"{own}:{self.result.code}"

    def head(self) -> str:
        """Return the declaration in C."""
        own = ["struct arena *arena"]
        for name, kind in self.parameters.items():
            own.append(f"const {kind.tag} *{name}" if kind.is_named else f"{kind.tag} {name}")
        inline = "inline " * (self.decoration == "inlined")
        return f"static {inline}{self.result.tag} {self.name}({', '.join(own)})"

    def written_out(self, about: str, lines: list[str]) -> str:
        """Return the function with a body; parameters that it does not read are said to be idle."""
        names = ["arena", *self.parameters]
        text = "\n".join(lines)
        idle = [own for own in names if not re.search(rf"(?<![.>\w]){own}\b", text)]
        idle = [f"    (void){name};" for name in idle]
        comment = about.replace("\n", "\n * ").replace(" \n", "\n")
        return "\n".join([f"/* {comment} */", self.head(), "{", *idle, *lines, "}", ""])


class Translator:
    """A translation of kernels that call each other into one text of C.

    Attributes:
        package: The package that they are in.
        kinds: Types of their variables.
        made: The functions, by module and name.
        parts: Functions that entries call by their numbers, from 1; None: by any address.
    """

    def __init__(self, folder: Path) -> None:
        """Take the folder of a package."""
        self.package = Package(folder)
        self.kinds = Kinds(self.package)
        self.made: dict[tuple[str, str], Made] = {}
        self.parts: list[Made] | None = None
        self._tables: dict[str, str] = {}

    def all(self) -> None:
        """Translate all kernels of the package."""
        for module in self.package.modules():
            for node in module.kernels():
                self.function(module, node)

    def text(self) -> str:
        """Return structs, tables and functions as one text."""
        own = self.parts
        functions = [
            each.text or (_entry(each) if own is None else _numbered(each, own))
            for each in self.made.values()
        ]
        heads = [f"{own.head()};" for own in self.made.values()]
        parts = (self.kinds.structs.values(), self._tables.values(), heads, functions)
        return "\n".join(text for part in parts for text in part) + "\n"

    def table(self, module: Module, name: str, found: Any) -> Value:
        """Return a table of numbers of a module."""
        values = getattr(found, "tolist", lambda: list(found))()
        element = INT if isinstance(values[0], int) else FLOAT
        tag = f"{module.name.rpartition('.')[2]}_{name}"
        numbers = ", ".join(map(number_text, values))
        self._tables[tag] = f"static const {element.tag} {tag}[] = {{{numbers}}};"
        kind = ARRAYS[element, 1]
        return Value(kind, literal(kind, f"({element.tag} *){tag}", str(len(values))))

    def function(self, module: Module, node: ast.FunctionDef) -> Made:
        """Return the translation of a function."""
        key = (module.name, node.name)
        if key not in self.made:
            kinds: dict[str, Kind] = {}
            own = Function(self, module, kinds)
            own.read_parameters(node)
            result = self.kinds.of(module, node.returns or ast.Constant(None))
            given = {own.name(name): kind for name, kind in kinds.items()}
            about = ast.get_docstring(node) or ""
            made = Made(c_name(*key), about, given, result, decoration(node))
            self.made[key] = made
            if made.decoration != ENTRY:
                own.translate(made, node)
            made.done = True
            self.made[key] = self.made.pop(key)  # after all that it calls
        return self.made[key]


def c_name(module: str, name: str) -> str:
    """Return the name in C of a function of a module."""
    return "_".join([*module.split(".")[1:][-2:], name.strip("_")])


class Function(Expressions):
    """Translation of one function; a variable has the type of what is first assigned to it."""

    def read_parameters(self, node: ast.FunctionDef) -> None:
        """Read the types of the parameters."""
        arguments = node.args
        plain = not (arguments.vararg or arguments.kwonlyargs or arguments.defaults)
        self.require(plain, node, "has other parameters than plain ones")
        for each in arguments.args:
            self.require(each.annotation, each, "has no annotation")
            assert each.annotation
            self.parameters[each.arg] = self.translator.kinds.of(self.module, each.annotation)
        self.kinds = dict(self.parameters)

    def translate(self, made: Made, node: ast.FunctionDef) -> None:
        """Translate the body."""
        self._result = made.result
        self._loops: list[str] = []
        self._takes = re.search(r"\bnp\.(empty|zeros)\(|\.copy\(\)", ast.unparse(node))
        self.block(node.body)
        if not isinstance(node.body[-1], ast.Return):
            self._leave()
        variables = {own: kind for own, kind in self.kinds.items() if own not in self.parameters}
        lines = [f"    {kind.tag} {self.name(own)};" for own, kind in variables.items()]
        lines += ["    const struct arena mark = *arena;"] if self._takes else []
        made.written = self.written
        place = f"{made.about}\n\n{self.module.path}: {node.name}"
        made.text = made.written_out(place, [*lines, *self.lines])

    def _leave(self) -> None:
        """Give back what the function has taken."""
        if self._takes:
            self.add("arena_leave(arena, &mark);")

    def block(self, statements: list[ast.stmt]) -> None:
        """Translate statements of a block."""
        for node in statements:
            self._statement(node)

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Pass() | ast.Expr(value=ast.Constant()):
                pass
            case ast.Break():
                self.add("break;")
            case ast.Continue():
                self.add("continue;")
            case ast.Expr(value=called):
                self.add(f"{self.value(called).text};")
            case ast.Return():
                self._return(node)
            case ast.If(test=test, body=body, orelse=orelse):
                self._nested(f"if {self.condition(test)}", body)
                if orelse:
                    self._nested("else", orelse)
            case ast.While(test=test, body=body, orelse=[]):
                self._nested(f"while {self.condition(test)}", body)
            case ast.For(orelse=[]):
                self._for(node)
            case ast.Assign(targets=[target], value=value):
                self._store(target, self.value(value))
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                self._store(target, self.value(value))
            case ast.AugAssign(target=target, op=op, value=value):
                self.require(type(op) in SIGNS, node)
                place = self._place(target)
                number = self.number(value)
                kind = self.joined(place.kind, number.kind, node)
                self.require(kind == place.kind, node, "changes a variable's type")
                self.add(f"{place.text} {SIGNS[type(op)]}= {number.text};")
            case _:
                self.require(False, node)

    def _nested(self, head: str, body: list[ast.stmt]) -> None:
        """Translate a block under a head."""
        self.add(f"{head} {{")
        self.depth += 1
        self.block(body)
        self.depth -= 1
        self.add("}")

    def _return(self, node: ast.Return) -> None:
        if node.value is None:
            self._leave()
            self.add("return;")
            return
        value = self.value(node.value)
        if value.items and self._result.members:
            value = self.tuple_of(list(value.items), self._result)
        numbers = {value.kind, self._result} <= set(NUMBERS)
        self.require(value.kind == self._result or numbers, node.value, "is not what is annotated")
        if self._takes:
            value = self.kept(Value(self._result, value.text))
        self._leave()
        self.add(f"return {value.text};")

    def _for(self, node: ast.For) -> None:
        """Translate a loop over a range; its variable is known inside of it alone."""
        called = node.iter
        self.require(isinstance(called, ast.Call) and ast.unparse(called.func) == "range", node)
        assert isinstance(called, ast.Call)
        *first, last = [self.number(each).text for each in called.args]
        own = ast.unparse(node.target)
        self.require(own == "_" or own not in self.kinds, node, "has a variable of that name")
        self.require(len(first) < 2, node, "has a step")
        self.kinds[own] = INT
        self._loops.append(own)
        i = self.name(own)
        start = f"int64_t {i} = {first[0] if first else 0}, end_{i} = {last}"
        self._nested(f"for ({start}; {i} < end_{i}; {i}++)", node.body)
        self.kinds.pop(own, None)
        self._loops.pop()

    def _place(self, target: ast.expr) -> Value:
        """Translate a variable, or an element or a part of an array, that is written."""
        if isinstance(target, ast.Subscript):
            self.written.add(ast.unparse(target.value))
        return self.value(target)

    def _store(self, target: ast.expr, value: Value) -> None:
        """Translate the writing of a value."""
        match target:
            case ast.Tuple(elts=targets):
                own = self.kept(value)
                members = own.kind.members
                for i, each in enumerate(targets):
                    if ast.unparse(each) != "_":
                        self._store(each, Value(members[i][1], f"{own.text}.{members[i][0]}"))
            case ast.Name(id=name):
                self.require(name not in self._loops, target, "is written in its own loop")
                kind = self.kinds.setdefault(name, value.kind)
                wider = self.joined(kind, value.kind, target)
                self.require(wider == kind, target, "changes a variable's type")
                self.add(f"{self.name(name)} = {value.text};")
            case _:
                self.require(value.kind in NUMBERS, target, "is written with an array")
                place = self._place(target)
                if place.kind.axes:  # all of it
                    own = self.kept(place)
                    self.add(f"for (int64_t k = 0, end = {product(own.sizes)}; k < end; k++)")
                    place = Value(FLOAT, f"    {own.text}.data[k]")
                self.add(f"{place.text} = {value.text};")


def _numbered(made: Made, parts: list[Made]) -> str:
    """Write the function that enters one of an exported text's parts by its number."""
    address, *names = made.parameters
    given = ", ".join(["arena", *names])
    back = "return " * (made.result is not VOID)
    own = [(n, part.name) for n, part in enumerate(parts, 1) if part.code == made.code[1:]]
    lines = [f"    if ({address} == {n}) {{ {back}{name}({given}); }}" for n, name in own]
    if back:
        lines += [f"    const {made.result.tag} none = {{0}};", "    return none;"]
    return made.written_out(made.about, lines)


def _entry(made: Made) -> str:
    """Write the function that enters one of several functions of its types by its address.

    A function of a user's has a negative one: it takes numbers as they are, an array as its pointer
    and its sizes, and a named tuple as its members; a tuple's numbers go to a last pointer.
    """
    address, *names = made.parameters
    given = ", ".join(["arena", *names])
    back = "return " * (made.result is not VOID)
    kinds = list(made.parameters.values())[1:]
    types = [f"const {kind.tag} *" if kind.is_named else kind.tag for kind in kinds]
    kernel = f"({made.result.tag} (*)({', '.join(['struct arena *', *types])}))(intptr_t){address}"
    flat: list[tuple[str, str]] = []
    for name, kind in zip(names, kinds, strict=True):
        flat += _flat(Value(kind, f"(*{name})" if kind.is_named else name))
    members = made.result.members
    flat += [("double *", "numbers")] if members else []
    answer = "double" if made.result is FLOAT else "void"
    called = f"(({answer} (*)({', '.join(kind for kind, _ in flat)}))(intptr_t)-{address})"
    values = ", ".join(text for _, text in flat)
    lines = [
        f"    if ({address} > 0) {{ {back}(({kernel})({given})); {'' if back else 'return;'} }}"
    ]
    call = f"    {'return ' * (answer == 'double')}{called}({values});"
    lines.append(call)
    if members:
        lines[-1:] = [f"    double numbers[{len(members)}] = {{0.0}};", call]
        numbers = [f"({kind.tag})numbers[{i}]" for i, (_, kind) in enumerate(members)]
        lines.append(f"    return {literal(made.result, *numbers)};")
    return made.written_out(made.about, lines)


def _flat(value: Value) -> Iterator[tuple[str, str]]:
    """Return the types and texts of the flat arguments for one argument."""
    if value.kind.element:
        yield f"{value.kind.element.tag} *", f"{value.text}.data"
        yield from (("int64_t", own.text) for own in value.sizes)
    elif value.kind.members:
        for name, kind in value.kind.members:
            yield from _flat(Value(kind, f"{value.text}.{name}"))
    else:
        yield value.kind.tag, value.text
