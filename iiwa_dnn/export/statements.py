"""Statements of the subset of Python that compiled functions use, as C."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.export.expressions import Expressions
from iiwa_dnn.export.lines import Variable, identifier
from iiwa_dnn.export.values import (
    DOUBLE,
    INT,
    Array,
    Known,
    Object,
    Scalar,
    Storage,
    Tuple,
    Value,
    integer,
    knowns,
    length,
    skeleton,
)
from iiwa_dnn.qp.compiling import Signature

if TYPE_CHECKING:
    from iiwa_dnn.export.translator import Translator

_SIGNS = {
    ast.Add: "+=",
    ast.Sub: "-=",
    ast.Mult: "*=",
    ast.Div: "/=",
    ast.RShift: ">>=",
    ast.LShift: "<<=",
}


class _Wide(Exception):
    """A variable is used outside of the block in which it is assigned first."""


class Body(Expressions):
    """Translation of a function's body.

    Attributes:
        result: Type of the result; None until it is known.
        known_result: The result itself if the function computes nothing but known integers.
    """

    def __init__(
        self,
        translator: Translator,
        function: Any,
        file: str,
        tree: ast.FunctionDef,
        wide: frozenset[str],
    ) -> None:
        """Begin a body.

        Args:
            translator: The translation that the function belongs to.
            function: The function.
            file: Its file, as messages name it.
            tree: Its syntax tree.
            wide: Variables that are declared at the beginning of the function.
        """
        super().__init__(translator, function, file)
        self.result: Any = None
        self.known_result: Value | None = None
        self._tree = tree
        self._wide = wide
        self._stored: set[str] = set()
        nodes = list(ast.walk(tree))
        names = [node for node in nodes if isinstance(node, ast.Name)]
        stores = [node.id for node in names if isinstance(node.ctx, ast.Store)]
        self._stores = Counter([*stores, *(argument.arg for argument in tree.args.args)])

    def on_name(self, node: ast.Name) -> Value:
        """Translate a variable, or a constant of the module."""
        if node.id not in self.names and node.id in self._stored:
            raise _Wide(node.id)
        return super().on_name(node)

    def block(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate statements; return whether the last of them leaves the block."""
        for statement in statements:
            name = f"do_{type(statement).__name__.lower()}"
            translate = getattr(self, name, None)
            if translate is None:
                raise self.refusal(statement)
            if translate(statement):
                return True
        return False

    def _inner(self, statements: Sequence[ast.stmt]) -> None:
        """Translate the statements of a block of its own."""
        known = set(self.names)
        self.block(statements)
        for name in set(self.names) - known - self._wide:
            del self.names[name]

    def do_pass(self, node: ast.Pass) -> None:
        """Translate nothing."""

    def do_expr(self, node: ast.Expr) -> None:
        """Translate a call; a docstring is a comment above the function."""
        if not isinstance(node.value, ast.Constant):
            self.lines.add(f"{self.value(node.value).text};")

    def do_return(self, node: ast.Return) -> bool:
        """Translate ``return``."""
        if node.value is None:
            self.lines.add("return;")
            return True
        value = self.value(node.value)
        if self.lines.only_declare and _is_known(value):
            self.known_result = _literal(value)
        for known in knowns(value.kind):
            known.use()
        for kind in [value.kind, *getattr(value.kind, "fields", {}).values()]:
            if isinstance(kind, Array) and kind.storage.local == self.function.__name__:
                raise self.refusal(node, "an array of the function itself cannot be returned")
        if self.result is None:
            self.result = value.kind
        if skeleton(self.result) != skeleton(value.kind) and self.result is not DOUBLE:
            raise self.refusal(node, "returns of different types")
        self.lines.add(f"return {self.written(value).text};")
        return True

    def do_break(self, node: ast.Break) -> bool:
        """Translate ``break``."""
        self.lines.add("break;")
        return True

    def do_continue(self, node: ast.Continue) -> bool:
        """Translate ``continue``."""
        self.lines.add("continue;")
        return True

    def do_if(self, node: ast.If) -> bool:
        """Translate ``if``; of a known condition, the branch that is taken."""
        test = self.condition(node.test)
        if test.known is not None:
            return self.block(node.body if test.known.use() else node.orelse)
        self.lines.open(f"if ({test.text})")
        self._inner(node.body)
        orelse = node.orelse
        while len(orelse) == 1 and isinstance(orelse[0], ast.If):
            before = len(self.lines)
            test = self.condition(orelse[0].test)
            if test.known is not None or len(self.lines) > before:
                break
            self.lines.close(f"else if ({test.text})")
            self._inner(orelse[0].body)
            orelse = orelse[0].orelse
        if orelse:
            self.lines.close("else")
            self._inner(orelse)
        self.lines.close()
        return False

    def do_while(self, node: ast.While) -> None:
        """Translate ``while``."""
        before = len(self.lines)
        test = self.condition(node.test)
        if node.orelse or len(self.lines) > before:
            raise self.refusal(node)
        self.lines.open(f"while ({test.text})")
        self._inner(node.body)
        self.lines.close()

    def do_for(self, node: ast.For) -> None:
        """Translate ``for`` over a range, or over a tuple of numbers."""
        if node.orelse or not isinstance(node.target, ast.Name):
            raise self.refusal(node)
        if isinstance(node.iter, ast.Tuple):
            self._over_tuple(node, node.target.id)
            return
        call = node.iter
        if not isinstance(call, ast.Call) or self.value(call.func).kind != Object(range):
            raise self.refusal(node)
        limits = [self.scalar(argument) for argument in call.args]
        start = limits[0] if len(limits) > 1 else self.value(ast.Constant(0))
        stop = limits[1] if len(limits) > 1 else limits[0]
        step = int(self.known(call.args[2]).use()) if len(limits) > 2 else 1
        if start.known is not None and stop.known is not None:
            values = range(start.known.value, stop.known.value, step)
            if self._enters(node) or not values:
                for known in (start.known, stop.known):
                    known.use()
                self._unrolled(node, node.target.id, values)
                return
        self._loop(node, node.target.id, (start, stop, step))

    def _loop(self, node: ast.For, name: str, limits: tuple[Value, Value, int]) -> None:
        start, stop, step = limits
        stored = {each.id for each in ast.walk(ast.Module(node.body, [])) if _is_store(each)}
        assert isinstance(node.iter, ast.Call)
        read = {each.id for each in ast.walk(node.iter) if isinstance(each, ast.Name)}
        if name in stored or read & stored:
            raise self.refusal(node, "the loop changes its own range")
        variable = Variable("_" if name == "_" else identifier(name), INT)
        if name == "_":
            variable.name = "again"
        outer = self.names.get(name)
        self.names[name] = variable
        move = {1: f"{variable.name}++", -1: f"{variable.name}--"}.get(
            step, f"{variable.name} += {step}"
        )
        sign = "<" if step > 0 else ">"
        head = f"int {variable.name} = {start.text}; {variable.name} {sign} {stop.at(11)}; {move}"
        self.lines.open(f"for ({head})")
        self._inner(node.body)
        self.lines.close()
        self._restore(name, outer)

    def _restore(self, name: str, outer: Variable | Value | None) -> None:
        del self.names[name]
        if outer is not None:
            self.names[name] = outer

    def _enters(self, node: ast.For) -> bool:
        """Test whether a loop enters functions by their addresses."""
        called = [each.func for each in ast.walk(node) if isinstance(each, ast.Call)]
        names = [each.id for each in called if isinstance(each, ast.Name)]
        own = self.function.__globals__
        return any(Signature.entered_by(own.get(name)) is not None for name in names)

    def _unrolled(self, node: ast.For, name: str, values: range) -> None:
        """Write a loop's body once for each value."""
        outer = self.names.get(name)
        for value in values:
            self.names[name] = Value(INT, str(value), known=Known(value))
            self.lines.open("")
            self._inner(node.body)
            self.lines.close()
        if values:
            self._restore(name, outer)

    def _over_tuple(self, node: ast.For, name: str) -> None:
        assert isinstance(node.iter, ast.Tuple)
        items = ", ".join(self.scalar(item).text for item in node.iter.elts)
        table = f"{identifier(name)}_values"
        self.lines.add(f"const double {table}[] = {{{items}}};")
        variable = Variable(identifier(name), DOUBLE)
        self.lines.open(f"for (int k = 0; k < {len(node.iter.elts)}; k++)")
        outer = self.names.get(name)
        self.names[name] = variable
        self.lines.declare(variable, f"{table}[k]")
        self._inner(node.body)
        self.lines.close()
        self._restore(name, outer)

    def do_annassign(self, node: ast.AnnAssign) -> None:
        """Translate an assignment with an annotation, which is not read."""
        assert node.value is not None
        self._assign(node.target, node.value)

    def do_assign(self, node: ast.Assign) -> None:
        """Translate an assignment."""
        for target in node.targets:
            self._assign(target, node.value)

    def _assign(self, target: ast.expr, source: ast.expr) -> None:
        if isinstance(target, ast.Name):
            if not self._allocated(target, source):
                self._store(target, self.value(source))
        elif isinstance(target, ast.Subscript):
            self._write(target, "=", self.scalar(source))
        elif isinstance(target, ast.Tuple):
            self._unpack(target, source)
        else:
            raise self.refusal(target)

    def _unpack(self, target: ast.Tuple, source: ast.expr) -> None:
        value = self.value(source)
        kind = value.kind
        items = value.items
        if items and isinstance(source, ast.Tuple):
            # A swap reads all before it writes.
            items = [self._kept(item) for item in items]
        elif isinstance(kind, Array):
            items = [self._element_of(value, k) for k in range(len(target.elts))]
        elif not items:
            whole = self.temporary(value)
            if isinstance(kind, Tuple):
                texts = [f"{whole.text}.at[{k}]" for k in range(kind.length)]
                items = [Value(kind.element, text) for text in texts]
            else:
                items = [whole.field(name) for name in kind.fields]
        if len(items) != len(target.elts):
            raise self.refusal(target, "another number of targets than of values")
        for name, item in zip(target.elts, items, strict=True):
            if not isinstance(name, ast.Name):
                raise self.refusal(target)
            if name.id != "_":
                self._store(name, item)

    def _element_of(self, array: Value, k: int) -> Value:
        known = array.kind.content
        value = None if known is None else Known(known.value[k], known)
        return Value(array.kind.element, f"{array.at(16)}[{k}]", known=value)

    def _kept(self, item: Value) -> Value:
        """Return a value that stays when its variable is written."""
        if not isinstance(item.kind, Array) or not item.text.isidentifier():
            return item
        self._temporaries += 1
        variable = Variable(f"{item.text}_{self._temporaries}", item.kind)
        self.lines.declare(variable, item.text)
        return variable.read()

    def _allocated(self, target: ast.Name, source: ast.expr) -> bool:
        """Translate the assignment of a new array, or of a copy."""
        if not isinstance(source, ast.Call) or _is_method(source, "reshape"):
            return False
        if _is_method(source, "copy"):
            assert isinstance(source.func, ast.Attribute)
            original = self.value(source.func.value)
            if not isinstance(original.kind, Array):
                raise self.refusal(source)
            self._allocate(target, original.kind.element, original.kind.shape, "")
            size = self._product([length(own) for own in original.kind.shape])
            copy = self.names[target.id]
            assert isinstance(copy, Variable)
            self.lines.open(f"for (int k = 0; k < {size.text}; k++)")
            self.lines.add(f"{copy.name}[k] = {original.at(16)}[k];")
            self.lines.close()
            return True
        function = self.value(source.func).kind
        if not isinstance(function, Object) or function.value not in (np.empty, np.zeros):
            return False
        given = self.value(source.args[0])
        lengths = given.items or [given]
        element = INT if len(source.args) > 1 else DOUBLE
        start = "{0}" if function.value is np.zeros else ""
        shape = tuple(own.known if own.known is not None else own.text for own in lengths)
        self._allocate(target, element, shape, start)
        return True

    def _allocate(
        self, target: ast.Name, element: Scalar, shape: tuple[Known | str, ...], start: str
    ) -> None:
        """Declare an array of the function."""
        if any(isinstance(own, str) for own in shape):
            raise self.refusal(target, "the size of an array is not known when the code is made")
        if self._stores[target.id] > 1 and target.id in self.names:
            raise self.refusal(target, "an array is allocated once")
        size = int(np.prod([own.use() for own in shape if isinstance(own, Known)]))
        storage = Storage(self.function.__name__)
        storage.write()
        variable = Variable(identifier(target.id), Array(element, shape, storage))
        self._stored.add(target.id)
        self.names[target.id] = variable
        text = f"{element.name} {variable.name}[{max(size, 1)}]"
        self.lines.add(f"{text} = {start};" if start else f"{text};", variable.name)

    def _store(self, target: ast.Name, value: Value) -> None:
        """Assign a value to a variable, which is declared the first time."""
        name = target.id
        known = value.known if self._stores[name] == 1 and value.kind is INT else None
        if isinstance(value.kind, Object):
            raise self.refusal(target)
        if getattr(value.kind, "in_table", False):
            self.names[name] = value
            return
        value = self.written(value)
        self._stored.add(name)
        own = self.names.get(name)
        if isinstance(own, Variable) and not own.pointer:
            self._overwrite(target, own, value)
            return
        # A struct that is handed in as a pointer is not overwritten: another one stands for it.
        variable = Variable(identifier(name) + "_" * isinstance(own, Variable), value.kind, known)
        if isinstance(value.kind, Array) and self._stores[name] > 1:
            # It may point to something else later.
            shape = value.kind.shape
            storage = Storage(value.kind.storage.local)
            storage.passes_to(value.kind.storage)
            variable.kind = Array(value.kind.element, shape, storage)
        if value.pointer:
            variable.pointer = True
        self.names[name] = variable
        if name in self._wide:
            self.lines.declare_first(variable)
            self._overwrite(target, variable, value)
        else:
            self.lines.declare(variable, value.text)

    def _overwrite(self, target: ast.Name, own: Variable, value: Value) -> None:
        kind = own.kind
        if value.text == own.name:
            return
        if isinstance(kind, Array) and isinstance(value.kind, Array):
            kind.storage.passes_to(value.kind.storage)
            shapes = [[_plain(size) for size in each.shape] for each in (kind, value.kind)]
            if shapes[0] != shapes[1]:
                raise self.refusal(target, "an array of another shape before")
        elif kind != value.kind and {kind, value.kind} != {INT, DOUBLE}:
            raise self.refusal(target, "a value of another type before")
        elif kind is INT and value.kind is DOUBLE:
            raise self.refusal(target, "an integer before: write it as a float")
        self.lines.add(f"{own.name} = {value.text};", stored=own.name)

    def do_augassign(self, node: ast.AugAssign) -> None:
        """Translate ``+=`` and the like."""
        sign = _SIGNS.get(type(node.op))
        if sign is None:
            raise self.refusal(node)
        value = self.scalar(node.value)
        if isinstance(node.target, ast.Subscript):
            self._write(node.target, sign, value)
            return
        if not isinstance(node.target, ast.Name):
            raise self.refusal(node)
        own = self.names.get(node.target.id)
        if own is None and node.target.id in self._stored:
            raise _Wide(node.target.id)
        if not isinstance(own, Variable) or own.kind is INT and value.kind is DOUBLE:
            raise self.refusal(node)
        self.lines.add(f"{own.name} {sign} {value.text};", stored=own.name)

    def _write(self, target: ast.Subscript, sign: str, value: Value) -> None:
        element = self.value(target)
        owner = self.value(target.value)
        if not isinstance(owner.kind, Array) or not isinstance(element.kind, Scalar):
            raise self.refusal(target)
        owner.kind.storage.write()
        self.lines.add(f"{element.text} {sign} {value.text};")


def _is_method(call: ast.Call, name: str) -> bool:
    return isinstance(call.func, ast.Attribute) and call.func.attr == name


def _is_store(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)


def _is_known(value: Value) -> bool:
    """Test whether a value is made of known integers."""
    if value.items:
        return all(map(_is_known, value.items))
    return value.kind is INT and value.known is not None


def _literal(value: Value) -> Value:
    """Return a value that is made of known integers without its names."""
    if value.known is not None:
        return integer(value.known)
    return Value(value.kind, items=[_literal(item) for item in value.items])


def _plain(size: Known | str) -> Any:
    return size.use() if isinstance(size, Known) else size


def translated(
    translator: Translator, function: Any, file: str, tree: ast.FunctionDef, bind: Any
) -> Body:
    """Translate a function's body.

    Args:
        translator: The translation that the function belongs to.
        function: The function.
        file: Its file, as messages name it.
        tree: Its syntax tree.
        bind: Function that gives a body its parameters.
    """
    wide: frozenset[str] = frozenset()
    while True:
        body = Body(translator, function, file, tree, wide)
        bind(body)
        try:
            body.block(tree.body)
        except _Wide as found:
            wide |= {str(found)}
        else:
            return body
