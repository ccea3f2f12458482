"""Translator of a package's kernels to C99, for sizes that are known at run time.

It reads source text alone. An array is a pointer and its sizes; what a kernel makes for itself
comes from an arena, and is given back where the kernel returns. What it does not know it refuses by
file and line.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .expressions import Expressions, Value, literal, table_kind
from .kinds import FLOAT, INT, VOID, Array, Kind, Kinds, Struct
from .sources import ENTRY, Module, Package, decoration

_SIGNS: dict[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_SIGNS |= {ast.RShift: ">>", ast.LShift: "<<"}


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
        written: Indices of the parameters that are arrays it writes into.
    """

    name: str
    about: str
    parameters: dict[str, Kind]
    result: Kind
    decoration: str
    text: str = ""
    written: set[int] = field(default_factory=set)

    @property
    def code(self) -> str:
        """Types of parameters and result as a text, one letter each."""
        own = "".join(kind.code for kind in self.parameters.values())
        return f"{own}:{self.result.code}"

    def head(self) -> str:
        """Return the declaration in C."""
        own = ["struct arena *arena"]
        for name, kind in self.parameters.items():
            own.append(f"const {kind.tag} *{name}" if is_named(kind) else f"{kind.tag} {name}")
        inline = "inline " * (self.decoration == "inlined")
        return f"static {inline}{self.result.tag} {self.name}({', '.join(own)})"


def is_named(kind: Kind) -> bool:
    """Test whether a type is a named tuple, which is handed on by its address."""
    return isinstance(kind, Struct) and kind.is_named


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
        functions = [own.text or _switch(own, self.parts or []) for own in self.made.values()]
        heads = [f"{own.head()};" for own in self.made.values()]
        parts = (self.kinds.structs.values(), self._tables.values(), heads, functions)
        return "\n".join(text for part in parts for text in part) + "\n"

    def table(self, module: Module, name: str, found: Any) -> Value:
        """Return a table of numbers of a module."""
        values = getattr(found, "tolist", lambda: list(found))()
        kind = table_kind(values)
        tag = f"{module.name.rpartition('.')[2]}_{name}"
        numbers = ", ".join(map(repr, values))
        self._tables[tag] = f"static const {kind.element.tag} {tag}[] = {{{numbers}}};"
        data = f"({kind.element.tag} *){tag}"
        return Value(kind, f"({literal(kind, data, str(len(values)))})")

    def function(self, module: Module, node: ast.FunctionDef) -> Made:
        """Return the translation of a function."""
        key = (module.name, node.name)
        if key not in self.made:
            own = Function(self, module, node)
            name = c_name(*key)
            about = ast.get_docstring(node) or ""
            result = self.kinds.of(module, node.returns)
            made = Made(name, about, own.given(), result, decoration(node))
            self.made[key] = made
            own.made = made
            if decoration(node) != ENTRY:
                made.text = own.translated(result)
            elif self.parts is None:
                made.text = own.entry(result)
            self.made[key] = self.made.pop(key)  # after all that it calls
        return self.made[key]


def c_name(module: str, name: str) -> str:
    """Return the name in C of a function of a module."""
    return "_".join([*module.split(".")[1:][-2:], name.strip("_")])


class Function(Expressions):
    """Translation of one function."""

    made: Made

    def __init__(self, translator: Translator, module: Module, node: ast.FunctionDef) -> None:
        """Take a function of a module."""
        super().__init__(translator, module)
        self.node = node
        self._result: Kind = VOID
        self._makes = False

    def given(self) -> dict[str, Kind]:
        """Return the types of the parameters."""
        arguments = self.node.args
        plain = not (arguments.vararg or arguments.kwonlyargs or arguments.defaults)
        self.require(plain, self.node, "has other parameters than plain ones")
        own: dict[str, Kind] = {}
        for each in arguments.args:
            self.require(each.annotation, each, "has no annotation")
            own[each.arg] = self.translator.kinds.of(self.module, each.annotation)
        return own

    def translated(self, result: Kind) -> str:
        """Translate the body; the types of variables are those of the last of several rounds."""
        self._result = result
        self.parameters = set(self.made.parameters)
        self.written = {_base(each) for each in ast.walk(self.node) if _is_stored(each)}
        self.kinds = dict(self.made.parameters)
        self._makes = any(_makes(each) for each in ast.walk(self.node))
        before: dict[str, Kind] | None = None
        while before != self.kinds:
            before = dict(self.kinds)
            self.lines = []
            self._count = 0
            self.block(self.node.body)
        if self._makes and not isinstance(self.node.body[-1], ast.Return):
            self.add("arena_leave(arena, &mark);")
        variables = [own for own in self.kinds if own not in self.parameters]
        declared = [f"    {self.kinds[own].tag} {self.name(own)};" for own in variables]
        text = "\n".join(self.lines)
        given = ["arena", *map(self.name, self.parameters)]
        declared += [f"    (void){own};" for own in given if not is_read(own, text)]
        if self._makes:
            declared.insert(0, "    const struct arena mark = *arena;")
        self.made.written = {i for i, own in enumerate(self.made.parameters) if own in self.written}
        self.made.parameters = {self.name(own): kind for own, kind in self.made.parameters.items()}
        about = self.made.about.replace("*/", "* /").replace("\n", "\n * ").replace(" \n", "\n")
        comment = f"/* {about}\n *\n * {self.module.path}: {self.node.name} */"
        return "\n".join([comment, self.made.head(), "{", *declared, *self.lines, "}", ""])

    def block(self, statements: list[ast.stmt]) -> None:
        """Translate statements."""
        for each in statements:
            translate = getattr(self, f"do_{type(each).__name__.lower()}", None)
            self.require(translate, each)
            translate(each)  # type: ignore[misc]

    def do_pass(self, node: ast.Pass) -> None:
        """Do nothing."""

    def do_break(self, node: ast.Break) -> None:
        """Translate ``break``."""
        self.add("break;")

    def do_continue(self, node: ast.Continue) -> None:
        """Translate ``continue``."""
        self.add("continue;")

    def do_expr(self, node: ast.Expr) -> None:
        """Translate a call whose result is not used; a docstring is none."""
        if not isinstance(node.value, ast.Constant):
            self.add(f"{self.value(node.value).text};")

    def do_return(self, node: ast.Return) -> None:
        """Translate ``return``."""
        if node.value is None:
            self.add("arena_leave(arena, &mark);" if self._makes else "")
            self.add("return;")
            return
        text = self.cast(self._of_result(node.value), self._result)
        if self._makes:
            own = self.fresh()
            self.add(f"const {self._result.tag} {own} = {text};")
            self.add("arena_leave(arena, &mark);")
            text = own
        self.add(f"return {text};")

    def _of_result(self, node: ast.expr) -> Value:
        """Translate a result; a tuple that is written out takes the stated type."""
        value = self.value(node)
        if value.items and isinstance(self._result, Struct):
            value = self.tuple_of(value.items, self._result)
        numbers = isinstance(self._result, Array | Struct) or isinstance(value.kind, Array | Struct)
        self.require(value.kind == self._result or not numbers, node, "is not what is annotated")
        return value

    def do_if(self, node: ast.If) -> None:
        """Translate ``if``."""
        self.add(f"if ({self.condition(node.test).text}) {{")
        self.block(node.body)
        if node.orelse:
            self.add("}")
            self.add("else {")
            self.block(node.orelse)
        self.add("}")

    def do_while(self, node: ast.While) -> None:
        """Translate ``while``."""
        self.require(not node.orelse, node)
        self.add(f"while ({self.condition(node.test).text}) {{")
        self.block(node.body)
        self.add("}")

    def do_for(self, node: ast.For) -> None:
        """Translate a loop over numbers, or over the numbers of an array or a tuple."""
        self.require(not node.orelse, node)
        call = node.iter
        if isinstance(call, ast.Call) and ast.unparse(call.func) == "range":
            self._count_through(node, call)
        else:
            self._run_through(node, self.value(call))

    def _count_through(self, node: ast.For, call: ast.Call) -> None:
        """Translate a loop over a range; its variable is known inside of it alone."""
        limits = [self.number(each) for each in call.args]
        start = limits[0].text if len(limits) > 1 else "0"
        stop = limits[1 if len(limits) > 1 else 0].text
        step = limits[2].known if len(limits) > 2 else 1
        self.require(isinstance(node.target, ast.Name) and step, node, "has no known step")
        assert isinstance(node.target, ast.Name)
        own = self.fresh() if node.target.id == "_" else self.name(node.target.id)
        if not stop.replace("_", "").isalnum():
            end = self.fresh()
            self.add(f"const int64_t {end} = {stop};")
            stop = end
        turn = f"{own}++" if step == 1 else f"{own} += {step}"
        turn = f"{own}--" if step == -1 else turn
        sign = "<" if step > 0 else ">"
        self.add(f"for (int64_t {own} = {start}; {own} {sign} {stop}; {turn}) {{")
        self._inside(node, {node.target.id: INT})

    def _run_through(self, node: ast.For, values: Value) -> None:
        """Translate a loop over the numbers of an array, or of a tuple of one type."""
        kind = getattr(values.kind, "same", None) or getattr(values.kind, "element", None)
        self.require(kind, node)
        assert kind is not None
        items = self.fresh()
        at = self.fresh()
        is_array = isinstance(values.kind, Array)
        size = f"{items}.size0" if is_array else str(len(getattr(values.kind, "members", ())))
        self.add(f"const {values.kind.tag} {items} = {values.text};")
        self.add(f"for (int64_t {at} = 0; {at} < {size}; {at}++) {{")
        item = Value(kind, f"{items}.{'data' if is_array else 'at'}[{at}]")
        self._store(node.target, item)
        self.block(node.body)
        self.add("}")

    def _inside(self, node: ast.For, variables: dict[str, Kind]) -> None:
        """Translate the body of a loop with variables of its own."""
        inner = [each for part in node.body for each in ast.walk(part)]
        loops = [each.target for each in inner if isinstance(each, ast.For)]
        for each in inner:
            is_written = isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)
            if is_written and each not in loops and getattr(each, "id", "_") != "_":
                self.require(each.id not in variables, each, "is written in its own loop")  # type: ignore[attr-defined]
        outer = dict(self.kinds)
        self.kinds |= variables
        self.block(node.body)
        for own in variables:
            self.kinds.pop(own)
        self.kinds |= {own: outer[own] for own in variables if own in outer}
        self.add("}")

    def do_annassign(self, node: ast.AnnAssign) -> None:
        """Translate an assignment with a type."""
        self.require(node.value, node)
        assert node.value is not None
        if isinstance(node.target, ast.Name):
            self._note(node.target.id, self.translator.kinds.of(self.module, node.annotation), node)
        self._store(node.target, self.value(node.value))

    def do_assign(self, node: ast.Assign) -> None:
        """Translate an assignment; a tuple that is written out is evaluated first."""
        for target in node.targets:
            if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                kept = [self.kept(self.value(each)) for each in node.value.elts]
                for each, own in zip(target.elts, kept, strict=True):
                    self._store(each, own)
            else:
                self._store(target, self.value(node.value))

    def do_augassign(self, node: ast.AugAssign) -> None:
        """Translate ``+=`` and its like."""
        self.require(type(node.op) in _SIGNS, node)
        value = self.number(node.value)
        if isinstance(node.target, ast.Name):
            kind = FLOAT if isinstance(node.op, ast.Div) else value.kind
            self._note(node.target.id, INT if kind.tag == "bool" else kind, node)
        place = self.value(_read(node.target))
        self.require(place.kind in (INT, FLOAT), node)
        self.add(f"{place.text} {_SIGNS[type(node.op)]}= {value.text};")

    def _note(self, own: str, kind: Kind, node: ast.AST) -> None:
        """Note the type of a variable."""
        self.kinds[own] = self.joined(self.kinds.get(own), kind, node)
        given = self.made.parameters.get(own)
        self.require(given is None or given == self.kinds[own], node, "changes a parameter's type")

    def _store(self, target: ast.expr, value: Value) -> None:
        """Translate the writing of a value."""
        if isinstance(target, ast.Tuple):
            self._unpack(target, value)
        elif isinstance(target, ast.Name):
            self._note(target.id, value.kind, target)
            text = self.cast(value, self.kinds[target.id])
            self.add(f"{self.name(target.id)} = {text};")
        else:
            place = self.value(target)
            if isinstance(place.kind, Array):
                self._fill(place, value, target)
            else:
                self.add(f"{place.text} = {value.text};")

    def _fill(self, place: Value, value: Value, node: ast.AST) -> None:
        """Translate the writing of a whole array: one number, or an array of the same size."""
        own = self.kept(place)
        size = " * ".join(each.text for each in own.sizes())
        if value.kind in (INT, FLOAT):
            at = self.fresh()
            self.add(f"for (int64_t {at} = 0; {at} < {size}; {at}++) {{")
            self.add(f"{own.text}.data[{at}] = {value.text};")
            self.add("}")
        else:
            self.require(value.kind == place.kind, node, "is written with another type")
            other = self.kept(value)
            self.add(f"memmove({own.text}.data, {other.text}.data, 8 * {size});")

    def _unpack(self, target: ast.Tuple, value: Value) -> None:
        """Write the members of a tuple or the elements of an array."""
        value = value if value.pointer or value.text.isidentifier() else self.kept(value)
        for i, each in enumerate(target.elts):
            if isinstance(each, ast.Name) and each.id == "_":
                continue
            if isinstance(value.kind, Struct):
                self._store(each, value.member(*value.kind.members[i]))
            else:
                self.require(isinstance(value.kind, Array), target)
                element = getattr(value.kind, "element", VOID)
                self._store(each, Value(element, f"{value.text}.data[{i}]"))

    def entry(self, result: Kind) -> str:
        """Write the function that enters a kernel, or a function of a user's, by its address.

        A user's has a negative address. It takes numbers as they are, an array as its pointer and
        its sizes, and a named tuple as its members; a tuple's numbers go to a last pointer.
        """
        address, *own = self.made.parameters.items()
        kinds = [f"const {kind.tag} *" if is_named(kind) else kind.tag for _, kind in own]
        kernel = f"({result.tag} (*)(struct arena *, {', '.join(kinds)}))(intptr_t){address[0]}"
        given = ", ".join(["arena", *(name for name, _ in own)])
        flat: list[tuple[str, str]] = []
        for name, kind in own:
            _flatten(Value(kind, name, pointer=is_named(kind)), flat)
        lines = [f"    if ({address[0]} > 0) {{"]
        call = f"({kernel})({given});"
        lines += (
            [f"        return {call}"]
            if result is not VOID
            else [f"        {call}", "        return;"]
        )
        lines.append("    }")
        if isinstance(result, Struct):
            flat.append(("double *", "numbers"))
            lines.append(f"    double numbers[{len(result.members)}] = {{0.0}};")
        answer = "double" if result is FLOAT else "void"
        types = ", ".join(kind for kind, _ in flat)
        values = ", ".join(text for _, text in flat)
        called = f"(({answer} (*)({types}))(intptr_t)-{address[0]})({values})"
        lines.append(f"    {'return ' * (answer == 'double')}{called};")
        if isinstance(result, Struct):
            numbers = [f"({kind.tag})numbers[{i}]" for i, (_, kind) in enumerate(result.members)]
            lines.append(f"    return {literal(result, *numbers)};")
        return "\n".join([f"/* {self.made.about} */", self.made.head(), "{", *lines, "}", ""])


def is_read(name: str, text: str) -> bool:
    """Test whether a variable, not a member of that name, stands in a text of C."""
    return re.search(rf"(?<![.>\w]){name}\b", text) is not None


def _switch(made: Made, parts: list[Made]) -> str:
    """Write the function that enters one of several functions of its types by their numbers."""
    names = ["arena", *made.parameters]
    given = f"({', '.join(['arena', *names[2:]])});"
    back = "return " * (made.result is not VOID)
    own = [(n, part.name) for n, part in enumerate(parts, 1) if part.code == made.code[1:]]
    lines = [f"    if ({names[1]} == {n}) {{ {back}{name}{given} }}" for n, name in own]
    if made.result is not VOID:
        lines += [f"    const {made.result.tag} none = {{0}};", "    return none;"]
    idle = [f"    (void){name};" for name in names if not is_read(name, "".join(lines))]
    return "\n".join([f"/* {made.about} */", made.head(), "{", *idle, *lines, "}", ""])


def _flatten(value: Value, flat: list[tuple[str, str]]) -> None:
    """Add the types and texts of the flat arguments for one argument."""
    if isinstance(value.kind, Struct):
        for name, kind in value.kind.members:
            _flatten(value.member(name, kind), flat)
    elif isinstance(value.kind, Array):
        flat.append((f"{value.kind.element.tag} *", f"{value.text}.data"))
        flat += [("int64_t", own.text) for own in value.sizes()]
    else:
        flat.append((value.kind.tag, value.text))


def _is_stored(node: ast.AST) -> bool:
    """Test whether a node is a part of an array that is written."""
    return isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store)


def _base(node: ast.AST) -> str:
    """Return the name of the array that a node is a part of; nothing if it is a tuple's."""
    while isinstance(node, ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _makes(node: ast.AST) -> bool:
    """Test whether a node takes memory from the arena."""
    if not isinstance(node, ast.Call):
        return False
    return ast.unparse(node.func) in ("np.empty", "np.zeros") or (
        isinstance(node.func, ast.Attribute) and node.func.attr == "copy"
    )


def _read(target: ast.expr) -> ast.expr:
    """Return a target as an expression that is read."""
    return ast.copy_location(ast.parse(ast.unparse(target), mode="eval").body, target)
