"""Translator of a package's kernels to C99, for sizes that are known at run time.

It reads source text alone. An array is a pointer and its sizes; what a kernel makes for itself
comes from an arena, and is given back where the kernel returns. What it does not know it refuses by
file and line; types that do not fit are refused by the compiler, which is told file and line too.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from .expressions import SIGNS, Expressions, Value, number_text
from .kinds import FLOAT, INT, VOID, Kinds
from .sources import ENTRY, Module, Package, decoration, fail, stored_names


class Translator:
    """A translation of kernels that call each other into one text of C.

    Attributes:
        package: The package that they are in.
        kinds: Types of their variables.
        functions: The functions, by module and name.
        tables: Tables of numbers, by their names in C.
        constants: Values of members of a named tuple that an exported text has one of, by its type.
        parts: Functions that entries call by their numbers, from 1; None: by any address.
    """

    def __init__(self, folder: Path) -> None:
        """Take the folder of a package."""
        self.package = Package(folder)
        self.kinds = Kinds(self.package)
        self.functions: dict[tuple[str, str], Function] = {}
        self.parts: list[Function] | None = None
        self.tables: dict[str, str] = {}
        self.constants: dict[str, dict[str, str]] = {}

    def all(self) -> None:
        """Translate all kernels of the package."""
        for module, node in self.package.kernels():
            self.function(module, node)

    def text(self) -> str:
        """Return structs, tables and functions as one text."""
        heads = [f"{own.head};" for own in self.functions.values()]
        enter = _entry if self.parts is None else partial(_numbered, parts=self.parts)
        bodies = [own.text or enter(own) for own in self.functions.values()]
        return "\n".join([*self.kinds.structs.values(), *self.tables.values(), *heads, *bodies])

    def table(self, tag: str, values: Sequence[float]) -> Value:
        """Write a table of numbers; return its place."""
        kind = INT if isinstance(values[0], int) else FLOAT
        numbers = ", ".join(map(number_text, values))
        self.tables[tag] = f"static const {kind.tag} {tag}[] = {{{numbers}}};"
        return Value(kind, f"({kind.tag} *){tag}")

    def function(self, module: Module, node: ast.FunctionDef) -> Function:
        """Return the translation of a function."""
        key = (module.name, node.name)
        if key not in self.functions:
            own = self.functions[key] = Function(self, module, node)
            if own.decoration != ENTRY:
                own.translate()
        return self.functions[key]


def c_name(module: str, name: str) -> str:
    """Return the name in C of a function of a module."""
    return "_".join([*module.split(".")[1:][-2:], name.strip("_")])


class Function(Expressions):
    """Translation of one function; a variable has the type of what is first assigned to it.

    Attributes:
        name: Its name in C.
        about: Its docstring.
        decoration: The decorator that it has in Python.
        types: Types in C of its parameters.
        result: Type of its result.
        head: Its declaration in C.
        text: The function in C.
    """

    def __init__(self, translator: Translator, module: Module, node: ast.FunctionDef) -> None:
        """Read name and types of a function."""
        of = translator.kinds.of
        kinds = {own.arg: of(module, own.annotation or own) for own in node.args.args}
        super().__init__(translator, module, kinds)
        self.name = c_name(module.name, node.name)
        self.about = ast.get_docstring(node) or ""
        self.decoration = decoration(node)
        self.result = of(module, node.returns or ast.Constant(None))
        self.types = [f"const {k.tag} *" if k.is_named else f"{k.tag} " for k in kinds.values()]
        own = ["struct arena *arena", *map("".join, zip(self.types, kinds, strict=True))]
        self.head = f"static {self.result.tag} {self.name}({', '.join(own)})"
        self.text = ""
        self._node = node
        self._lines: list[str] = []

    @property
    def code(self) -> str:
        """Types of parameters and result as a text, one letter each."""
        return f"{''.join(kind.code for kind in self.parameters.values())}:{self.result.code}"

    def translate(self) -> None:
        """Translate the body."""
        self._takes = re.search(r"\bnp\.(empty|zeros)\(|\.copy\(\)", ast.unparse(self._node))
        self._block(self._node.body)
        if self.result is VOID:
            self._return(None)
        variables = {own: kind for own, kind in self.kinds.items() if own not in self.parameters}
        declared = [f"{kind.tag} {own};" for own, kind in variables.items()]
        mark = ["const struct arena mark = *arena;"] if self._takes else []
        about = f"{self.about}\n\n{self.module.path}: {self._node.name}"
        self.text = self.written_out(about, [*declared, *mark, *self._lines])

    def written_out(self, about: str, lines: list[str]) -> str:
        """Return the function with a body; parameters that it does not read are said to be idle."""
        body = "\n    ".join(lines)
        names = ["arena", *self.parameters]
        idle = [own for own in names if not re.search(rf"(?<![.>\w]){own}\b", body)]
        body = "\n    ".join([*(f"(void){own};" for own in idle), body])
        comment = about.replace("\n", "\n * ").replace(" \n", "\n")
        return f"/* {comment} */\n{self.head}\n{{\n    {body}\n}}\n"

    def _block(self, statements: list[ast.stmt]) -> None:
        """Translate statements of a block."""
        for node in statements:
            if self.translator.parts is None:  # of a library, which nobody reads
                self._lines.append(f'#line {node.lineno} "{self.module.path}"')
            try:
                self._statement(node)
            except (AttributeError, LookupError, NameError, TypeError, ValueError) as error:
                fail(self.module, node, f"has no translation: {error}")

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Pass() | ast.Expr(value=ast.Constant()):
                pass
            case ast.Break() | ast.Continue():
                self._lines.append(f"{ast.unparse(node)};")
            case ast.Expr(value=called):
                self._lines.append(f"{self.value(called).text};")
            case ast.Return(value=value):
                self._return(value)
            case ast.If(test=test, body=body, orelse=orelse):
                self._nested(f"if {self.condition(test)}", body)
                if orelse:
                    self._nested("else", orelse)
            case ast.While(test=test, body=body, orelse=[]):
                self._nested(f"while {self.condition(test)}", body)
            case ast.For(iter=ast.Call(func=ast.Name(id="range"), args=args), orelse=[]):
                self._for(node, [self.value(each).text for each in args])
            case (
                ast.Assign(targets=[target], value=value)
                | ast.AnnAssign(target=target, value=ast.expr() as value)
            ):
                self._store(target, "=", self.value(value))
            case ast.AugAssign(target=target, op=op, value=value):
                self._store(target, f"{SIGNS[type(op)]}=", self.value(value))
            case _:
                fail(self.module, node, "has no translation")

    def _nested(self, head: str, body: list[ast.stmt]) -> None:
        """Translate a block under a head."""
        before = len(self._lines)
        self._block(body)
        self._lines[before:] = [f"{head} {{", *(f"    {own}" for own in self._lines[before:]), "}"]

    def _return(self, node: ast.expr | None) -> None:
        """Return a value, and give back what the function has taken."""
        text = f" {self.value(node).text}" if node else ""
        if self._takes and text:
            self._lines.append(f"const {self.result.tag} own_result ={text};")
            text = " own_result"
        if self._takes:
            self._lines.append("arena_leave(arena, &mark);")
        self._lines.append(f"return{text};")

    def _for(self, node: ast.For, ends: list[str]) -> None:
        """Translate a loop over a range; its variable is known inside of it alone."""
        name = ast.unparse(node.target)
        self.require(len(ends) < 3, node, "has a step")
        taken = {*self.kinds, *stored_names(ast.Module(node.body, []))}
        self.require(name == "_" or name not in taken, node, "writes another variable, or its own")
        self.kinds[name] = INT
        start = f"int64_t {name} = {ends[0] if len(ends) > 1 else 0}, end_{name} = {ends[-1]}"
        self._nested(f"for ({start}; {name} < end_{name}; {name}++)", node.body)
        self.kinds.pop(name, None)

    def _store(self, target: ast.expr, sign: str, value: Value) -> None:
        """Translate the writing of a value."""
        match target:
            case ast.Tuple(elts=targets):
                own = f"own_{len(self._lines)}"
                self._lines.append(f"const {value.kind.tag} {own} = {value.text};")
                assert value.kind.element
                for i, each in enumerate(targets):
                    if ast.unparse(each) != "_":
                        self._store(each, "=", Value(value.kind.element, f"{own}.at[{i}]"))
                return
            case ast.Name(id=name):
                self.kinds.setdefault(name, value.kind)
                place = name
            case ast.Subscript(value=owner):
                self.written.add(ast.unparse(owner))
                whole = self.value(target)
                place = whole.text
                if whole.kind.axes:
                    loop = (
                        f"for (int64_t own_k = 0, own_end = {whole.size}; own_k < own_end; own_k++)"
                    )
                    place = f"{loop} {whole.text}.data[own_k]"
        self._lines.append(f"{place} {sign} {value.text};")


def _numbered(own: Function, parts: list[Function]) -> str:
    """Write the function that enters one of an exported text's parts by its number."""
    address, *names = own.parameters
    given = ", ".join(["arena", *names])
    back = "return " * (own.result is not VOID)
    fitting = [(n, part) for n, part in enumerate(parts, 1) if part.code == own.code[1:]]
    lines = [f"if ({address} == {n}) {back}{part.name}({given});" for n, part in fitting]
    if back:
        lines += [f"const {own.result.tag} none = {{0}};", "return none;"]
    return own.written_out(own.about, lines)


def _entry(own: Function) -> str:
    """Write the function that enters one of several functions of its types by its address.

    A function of a user's has a negative one: it takes numbers as they are, an array as its pointer
    and its sizes, and a named tuple as its members; a tuple's numbers go to a last pointer.
    """
    address, *names = own.parameters
    tag = own.result.tag
    flat = [each for name in names for each in _flat(own.value(ast.Name(name)))]
    answer = tag
    if own.result.members:
        flat.append(("double *", "numbers.at"))
        answer = "void"
    types = ", ".join(["struct arena *", *own.types[1:]])
    kernel = f"(({tag} (*)({types}))(intptr_t){address})({', '.join(['arena', *names])})"
    types = ", ".join(kind for kind, _ in flat)
    other = f"(({answer} (*)({types}))(intptr_t)-{address})({', '.join(text for _, text in flat)})"
    lines = [f"if ({address} > 0) return {kernel};", f"return {other};"]
    if own.result.members:
        lines[1:] = [f"{tag} numbers = {{{{0.0}}}};", f"{other};", "return numbers;"]
    return own.written_out(own.about, lines)


def _flat(value: Value) -> Iterator[tuple[str, str]]:
    """Return the types and texts of the flat arguments for one argument."""
    kind = value.kind
    if kind.element and kind.axes:
        yield f"{kind.element.tag} *", f"{value.text}.data"
        yield from (("int64_t", size) for size in value.sizes)
    elif kind.members:
        for name, own in kind.members.items():
            yield from _flat(Value(own, f"{value.text}.{name}"))
    else:
        yield kind.tag, value.text
