"""Translate a package's kernels to C99, for arrays whose sizes are known at run time.

Source text alone is read. In C an array is a pointer and its sizes; memory for arrays that a kernel
makes comes from an arena, and is released when the kernel returns. A statement without translation
is refused by file and line; a wrong type is refused by the C compiler, by file and line too.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from pathlib import Path
from types import MappingProxyType

from .expressions import NUMBERS, SIGNS, Expressions, Rank, Translation, Use, Value
from .kinds import FLOAT, INT, VOID
from .sources import (
    ENTRY,
    Module,
    c_word,
    decoration,
    fail,
    stored_names,
)


class Translator(Translation):
    """Translation of kernels that call each other into one text of C.

    Attributes:
        functions: Translated functions by module and name, each after those that it calls.
    """

    def __init__(self, folder: Path, use: Use = Use.LIBRARY) -> None:
        """Take the folder of a package, and what the C is for."""
        super().__init__(folder, use)
        self.functions: dict[tuple[str, str], Function] = {}

    def all(self) -> None:
        """Translate all kernels of the package."""
        for module, node in self.package.kernels():
            self.function(module, node)

    def text(self, titles: Mapping[str, str] = MappingProxyType({})) -> str:
        """Return types, constants and functions as one text of C.

        Args:
            titles: Titles of the sections of functions, in their order, by subpackages; the title
                by an empty name is of functions from outside of the package.
        """
        self._number_parts()
        enter = _entry_of_own_parts if self.use.is_read else _entry
        ranks = {room: i for i, room in enumerate(titles)}
        functions = sorted(self.functions.values(), key=lambda own: ranks.get(own.room(titles), 0))
        defined: set[str] = set()
        early: set[str] = set()
        bodies = []
        for room, group in groupby(functions, key=lambda own: own.room(titles)):
            bodies += [f"\n/* ---- {titles[room]} ---- */\n"] if titles else []
            for own in group:
                body = own.text or enter(own)
                defined.add(own.name)
                early |= {*re.findall(r"\w+(?=\()", body)} - defined
                bodies.append(body)
        heads = [f"{own.head};" for own in functions if own.name in early]
        parts = ["\n\n".join(own.values()) for own in (self.kinds.structs, self.constants)]
        return "\n".join([*parts, *heads, *bodies])

    def _number_parts(self) -> None:
        """Number the parts, which are the kernels that have the types of an entry, from 1."""
        types = {own.code[1:] for own in self.functions.values() if own.decoration == ENTRY}
        parts = sorted(own.name for own in self.functions.values() if own.code in types)
        self.numbers = {name: number for number, name in enumerate(parts, 1)}

    def function(
        self, module: Module, node: ast.FunctionDef, like: Function | None = None
    ) -> Function:
        """Return the translation of a function; one without annotations has the types of `like`."""
        key = (module.name, node.name)
        if key not in self.functions:
            own = self.functions[key] = Function(self, module, node, like)
            if own.decoration != ENTRY:
                own.translate()
            self.functions[key] = self.functions.pop(key)  # after those that it calls
        return self.functions[key]


_LEFT = "return"
"""Mark of a block whose end is never reached, among the names of variables."""

_LASTING = r"\w+(\.size\d)?( [*+-] \w+(\.size\d)?)*"
"""Pattern of an end of a loop that changes only if one of its variables is assigned."""


class Function(Expressions):
    """Translation of one function; a variable has the type of the first value assigned to it.

    Attributes:
        text: The function in C; "" before `translate`, and for an entry.
    """

    def __init__(
        self,
        translator: Translator,
        module: Module,
        node: ast.FunctionDef,
        like: Function | None = None,
    ) -> None:
        """Read the types of a function; one without annotations has those of the entry `like`."""
        of = translator.kinds.of
        names = [own.arg for own in node.args.args]
        result = of(module, node.returns or ast.Constant(None))
        if like and not any(own.annotation for own in node.args.args):
            result = like.result
            kinds = dict(zip(names, [*like.parameters.values()][1:], strict=True))
        else:
            kinds = {own.arg: of(module, own.annotation or own) for own in node.args.args}
        super().__init__(translator, module, kinds)
        self.node = node
        self.result = result
        self.text = ""
        self.uses_arena |= self.decoration == ENTRY
        self._stored = Counter(stored_names(node))
        self._declared = dict.fromkeys(kinds, 0)
        self._is_const = [False]

    @property
    def others(self) -> Iterable[Function]:
        """All functions of the translation."""
        assert isinstance(self.translator, Translator)
        return self.translator.functions.values()

    @property
    def about(self) -> str:
        """Docstring of the function, "" without one."""
        return ast.get_docstring(self.node) or ""

    @property
    def decoration(self) -> str:
        """Name of the decorator that makes the function a kernel or an entry."""
        return decoration(self.node)

    @property
    def types(self) -> list[str]:
        """Types of the parameters in C; named tuples and records are pointers."""
        kinds = self.parameters.values()
        return [f"const {own.tag} *" if own.is_named else f"{own.tag} " for own in kinds]

    @property
    def head(self) -> str:
        """Head of the function in C, without its body."""
        names = map(c_word, self.parameters)
        own = ["struct arena *arena"] * self.uses_arena
        own += map("".join, zip(self.types, names, strict=True))
        return f"static inline {self.result.tag} {self.name}({', '.join(own) or 'void'})"

    @property
    def entry_name(self) -> str:
        """Name in C of an entry's kind."""
        return f"ARMSTEP_{self.node.name.removeprefix('enter_').upper()}"

    @property
    def code(self) -> str:
        """Code of the function's types: `Kind.code` of each parameter, a colon, the result's."""
        return f"{''.join(kind.code for kind in self.parameters.values())}:{self.result.code}"

    def room(self, rooms: Iterable[str]) -> str:
        """Return which of some subpackages the function is in; nothing if it is in none."""
        words = self.module.name.split(".")
        is_own = words[0] == self.translator.package.folder.name and words[1] in rooms
        return words[1] if is_own else ""

    def translate(self) -> None:
        """Translate the body into `text`."""
        self._takes = re.search(r"\bnp\.(empty|zeros)\(|\.copy\(\)", ast.unparse(self.node))
        if self._takes:
            self.lines.append("const struct arena mark = *arena;")
        self._block(self.node.body)
        left = self._assigns(self.node.body)
        self.require(self.result is VOID or _LEFT in left, self.node, "may end without a result")
        if self._takes and _LEFT not in left:
            self.lines.append("arena_leave(arena, &mark);")
        self.written = {own for place in self.written for own in self.sources(place)}
        about = f"{self.about}\n\n{self.module.path}: {self.node.name}"
        self.text = self.written_out(about, self.lines)

    def written_out(self, about: str, lines: list[str]) -> str:
        """Return the function in C.

        Args:
            about: Comment on the function.
            lines: Lines of the body; a zero character and a number before a declaration become
                ``const`` if the variable of that number is written once.
        """
        body = "\n    ".join(lines)
        # A variable that is never written again is constant.
        body = re.sub(r"\0(\d+) ", lambda own: "const " * self._is_const[int(own[1])], body)
        names = [*["arena"] * self.uses_arena, *map(c_word, self.parameters)]
        idle = [own for own in names if not re.search(rf"(?<![.>\w]){own}\b", body)]
        body = "\n    ".join([*(f"(void){own};" for own in idle), body])
        comment = about.replace("\n", "\n * ").replace(" \n", "\n")
        return f"/* {comment} */\n{self.head}\n{{\n    {body}\n}}\n"

    def _assigns(self, block: list[ast.stmt]) -> set[str]:
        """Return the variables that are assigned on every path to the end of a block.

        If no path leads to the end, return all variables of the function and `_LEFT`.
        """
        found: set[str] = set()
        for node in block:
            match node:
                case ast.Return() | ast.Break() | ast.Continue():
                    return {*self._stored, _LEFT}
                case ast.If(body=body, orelse=orelse):
                    found |= self._assigns(body) & self._assigns(orelse)
                case ast.Assign() | ast.AnnAssign():
                    found.update(stored_names(node))
        return found

    def _block(self, statements: list[ast.stmt]) -> None:
        """Translate statements one after another."""
        for node in statements:
            if not self.translator.use.is_read:
                self.lines.append(f'#line {node.lineno} "{self.module.path}"')
            try:
                self._statement(node)
            except (AttributeError, LookupError, NameError, TypeError, ValueError) as error:
                fail(self.module, node, f"has no translation: {error}")
            self.assigned |= self._assigns([node])

    def _statement(self, node: ast.stmt) -> None:
        """Translate one statement; raise a TranslationError if it has no translation."""
        match node:
            case ast.Pass() | ast.Expr(value=ast.Constant()):
                pass
            case ast.Break() | ast.Continue():
                self.lines.append(f"{ast.unparse(node)};")
            case ast.Expr(value=called):
                self.lines.append(f"{self.value(called).text};")
            case ast.Return(value=value):
                self._return(value)
            case ast.If():
                self._if(node)
            case ast.While(test=test, body=body, orelse=[]):
                self._nested(f"while ({self._uncertain(test).text})", body)
            case ast.For(iter=ast.Call(func=ast.Name(id="range"), args=args), orelse=[]):
                self._for(node, [self.value(each) for each in args])
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
        """Translate a block under a head of C; variables declared in it are unknown after it."""
        before = len(self.lines)
        declared = dict(self._declared)
        assigned = {*self.assigned}
        self._block(body)
        self._declared = declared
        self.assigned.intersection_update(assigned)
        self.lines[before:] = [f"{head} {{", *(f"    {own}" for own in self.lines[before:]), "}"]

    def _if(self, node: ast.If) -> None:
        """Translate an `if`; a variable that both branches assign is declared before it."""
        head = f"if ({self.value(node.test).text})"
        before = len(self.lines)
        found = self._assigns([node])
        shared = set() if _LEFT in found else found - self._declared.keys()
        self._declared |= dict.fromkeys(shared, 0)
        self._nested(head, node.body)
        if node.orelse:
            closed = len(self.lines)
            self._nested("else", node.orelse)
            self._join(closed, node.orelse)
        declared = [f"{self.kinds[own].tag} {c_word(own)};" for own in sorted(shared)]
        self.lines[before:before] = declared

    def _join(self, closed: int, orelse: list[ast.stmt]) -> None:
        """Join the lines of an `else` with the brace before them; an inner `if` becomes `else if`.

        Args:
            closed: Index of the first line of the `else`.
            orelse: Statements of the `else`.
        """
        first, *inner = self.lines[closed:]
        is_alone = isinstance(orelse[0], ast.If) and len(orelse) == 1
        if is_alone and inner[0].startswith("    if ("):
            first, *inner = [own[4:] for own in inner[:-1]]
            first = f"else {first}"
        self.lines[closed - 1 :] = [f"}} {first}", *inner]

    def _return(self, node: ast.expr | None) -> None:
        """Translate a `return`, before which memory that the function has taken is released."""
        own = self.value(node).converted(self.result) if node else Value(VOID, "")
        self.aliases.setdefault("return", set()).update(own.places)
        if self._takes and not re.fullmatch(r"[\w.-]*", own.text):
            self.lines.append(f"const {self.result.tag} own_result = {own.initializer};")
            own = Value(VOID, "own_result")
        if self._takes:
            self.lines.append("arena_leave(arena, &mark);")
        self.lines.append(f"return {own.text};" if own.text else "return;")

    def _for(self, node: ast.For, ends: list[Value]) -> None:
        """Translate a loop over a range with `ends`; its variable is known in the loop alone."""
        name = ast.unparse(node.target)
        self.require(len(ends) < 3, node, "has a step")
        stored = {*stored_names(ast.Module(node.body, []))}
        taken = {*self.kinds, *stored}
        self.require(name == "_" or name not in taken, node, "writes another variable, or its own")
        self.kinds[name] = INT
        start = f"int64_t {name} = {ends[0].text if len(ends) > 1 else 0}"
        end = ends[-1].text
        if not re.fullmatch(_LASTING, end) or stored & {*re.findall(r"\w+", end)}:
            start += f", end_{name} = {end}"
            end = f"end_{name}"
        self.assigned.add(name)
        self._nested(f"for ({start}; {name} < {end}; {name}++)", node.body)
        self.assigned.discard(name)
        self.kinds.pop(name, None)

    def _store(self, target: ast.expr, sign: str, value: Value) -> None:
        """Translate an assignment to a target by ``=``, or by an augmented sign such as ``+=``."""
        match target:
            case ast.Tuple(elts=targets):
                own = self._keep(value, target).text
                assert value.kind.element
                for i, each in enumerate(targets):
                    if ast.unparse(each) != "_":
                        self._store(each, "=", Value(value.kind.element, f"{own}.at[{i}]"))
            case ast.Name(id=name):
                self._write(name, target, sign, value)
            case ast.Subscript():
                whole = self.value(target)
                self.written |= whole.places
                text = value.converted(whole.kind.element or whole.kind).text
                if whole.kind.axes:
                    self.require(sign == "=", target, "is an array")
                    head = f"for (int64_t own_k = 0; own_k < {whole.size.text}; own_k++)"
                    first = whole.data.within(Rank.PRIMARY)
                    self.lines += [f"{head} {{", f"    {first}[own_k] = {text};", "}"]
                else:
                    self.lines.append(f"{whole.text} {sign} {text};")
            case ast.Attribute():
                number = self.value(target)
                is_number = self.value(target.value).kind.sizes and number.kind in NUMBERS
                self.require(bool(is_number), target, "is no number of a record")
                self.written |= number.places
                place = re.sub(r"^\(int64_t\)| != 0\.0$", "", number.text)
                self.lines.append(f"{place} {sign} {value.converted(FLOAT).text};")
            case _:
                fail(self.module, target, "has no translation")

    def _write(self, name: str, target: ast.expr, sign: str, value: Value) -> None:
        """Translate an assignment to a variable, which is declared at the first one."""
        kind = self.kinds.setdefault(name, value.kind)
        self.aliases.setdefault(name, set()).update(value.places)
        own = c_word(name)
        if sign != "=":
            self.value(target)
        if name in self._declared:
            self._is_const[self._declared[name]] = False
            self.lines.append(f"{own} {sign} {value.converted(kind).text};")
            return
        self._declared[name] = len(self._is_const)
        text = value.converted(kind).initializer
        self.lines.append(f"\0{len(self._is_const)} {kind.tag} {own} = {text};")
        self._is_const.append(True)


def _entry_of_own_parts(own: Function) -> str:
    """Write the body of an entry in C for readers: a call of a part, or of one of a user's.

    The result of a part that there is not is false, or NaN.
    """
    address, *names = map(c_word, own.parameters)
    types = ", ".join(["struct arena *", *map(str.strip, own.types[1:])])
    given = ", ".join(["arena", *names])
    call = f"(({own.result.tag} (*)({types}))own_part->function)({given});"
    lines = [
        *_choice(own),
        f"const struct armstep_own *own_part = own_part_of(arena, {address}, {own.entry_name});",
        "if (own_part != NULL) {",
        f"    {'return ' * (own.result is not VOID)}{call}",
        "}",
    ]
    if own.result.members:
        nothing = ", ".join(["NAN"] * len(own.result.members))
        lines += [f"const {own.result.tag} none = {{{{{nothing}}}}};", "return none;"]
    elif own.result is not VOID:
        lines.append("return 0;")
    return own.written_out(own.about, lines)


def _entry(own: Function) -> str:
    """Write the body of an entry in the library: a call of a part, or by a function pointer.

    A positive number is a part's. A negative one is, without its sign, the address of a function of
    C that takes an array as its pointer and sizes, a named tuple as its members, and a last pointer
    to which it writes the numbers of a resulting tuple.
    """
    address, *names = own.parameters
    flat = [each for name in names for each in _flat(own.value(ast.Name(name)))]
    answer = own.result.tag
    if own.result.members:
        flat.append(("double *", "numbers.at"))
        answer = "void"
    types = ", ".join(kind for kind, _ in flat)
    other = f"(({answer} (*)({types}))(intptr_t)-{address})({', '.join(text for _, text in flat)})"
    lines = [*_choice(own), f"return {other};"]
    if own.result.members:
        lines[-1:] = [f"{own.result.tag} numbers = {{{{0.0}}}};", f"{other};", "return numbers;"]
    return own.written_out(own.about, lines)


def _choice(own: Function) -> list[str]:
    """Write the statement by which an entry calls a part by its number, and returns."""
    address, *names = map(c_word, own.parameters)
    lines = [f"switch ({address}) {{"]
    for part in own.others:
        if part.code == own.code[1:]:
            given = ", ".join([*["arena"] * part.uses_arena, *names])
            lines.append(f"case {own.translator.numbers[part.name]}:")
            is_void = own.result is VOID
            call = f"{part.name}({given});"
            lines += [f"    {call}", "    return;"] if is_void else [f"    return {call}"]
    return [*lines, "default:", "    break;", "}"]


def _flat(value: Value) -> Iterator[tuple[str, str]]:
    """Return the C types and expressions of the flat arguments that stand for one value."""
    kind = value.kind
    if kind.element and kind.axes:
        yield f"{kind.element.tag} *", value.data.text
        yield from (("int64_t", size.text) for size in value.sizes)
    elif kind.sizes:
        yield from _flat(value.member("numbers", kind.members["numbers"]))
    elif kind.members:
        for name, own in kind.members.items():
            yield from _flat(value.member(name, own))
    else:
        yield kind.tag, value.text
