"""Statements of the subset of Python that compiled functions use, as C."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.export.expressions import Expressions
from iiwa_dnn.export.lines import identifier
from iiwa_dnn.export.values import (
    ATOM,
    DOUBLE,
    INT,
    Array,
    Object,
    Scalar,
    Storage,
    Value,
    integer,
)

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


class Body(Expressions):
    """Translation of a function's body.

    Attributes:
        result: Type of the result; None for none.
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
        self._wide = wide
        parameters = [argument.arg for argument in tree.args.args]
        self._stores = Counter([*parameters, *_stored(tree)])

    def take(self, parameters: dict[str, Value]) -> None:
        """Begin with parameters; one that is written later is not known."""
        for name, own in parameters.items():
            self.names[name] = own if self._stores[name] == 1 else replace(own, known=None)

    def block(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate statements; return whether the last of them leaves the block."""
        for statement in statements:
            translate = getattr(self, f"do_{type(statement).__name__.lower()}", None)
            self.require(translate, statement)
            if translate(statement):  # type: ignore[misc]
                return True
        return False

    def inner(self, statements: Sequence[ast.stmt]) -> None:
        """Translate the statements of a block of its own."""
        known = set(self.names)
        self.block(statements)
        for name in set(self.names) - known - self._wide:
            del self.names[name]

    def do_pass(self, node: ast.Pass) -> None:
        """Translate nothing."""

    def do_expr(self, node: ast.Expr) -> None:
        """Translate a call that C has too; a docstring is a comment above the function."""
        if isinstance(node.value, ast.Constant):
            return
        text = self.value(node.value).text
        if text:
            self.lines.add(f"{text};")

    def do_return(self, node: ast.Return) -> bool:
        """Translate ``return``."""
        if node.value is None:
            self.lines.add("return;")
            return True
        value = self.value(node.value)
        items = value.items or [value]
        for item in items:
            is_own = isinstance(item.kind, Array) and item.kind.storage.owner is self.function
            self.require(not is_own, node, "cannot be returned: the array is the function's own")
        if self.lines.only_declare and all(_is_known(item) for item in items):
            literals = [integer(item.known) for item in items]
            self.known_result = Value(value.kind, items=literals) if value.items else literals[0]
        self.result = value.kind if self.result is None else self.result
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
            return self.block(node.body if test.known else node.orelse)
        self.lines.open(f"if ({test.text})")
        self.inner(node.body)
        if node.orelse:
            self.lines.close("else")
            self.inner(node.orelse)
        self.lines.close()
        return False

    def do_while(self, node: ast.While) -> None:
        """Translate ``while``."""
        before = len(self.lines)
        test = self.condition(node.test)
        self.require(not node.orelse and len(self.lines) == before, node)
        self.lines.open(f"while ({test.text})")
        self.inner(node.body)
        self.lines.close()

    def do_for(self, node: ast.For) -> None:
        """Translate ``for`` over a range; one over a tuple or over functions is written out."""
        self.require(not node.orelse and isinstance(node.target, ast.Name), node)
        assert isinstance(node.target, ast.Name)
        name = node.target.id
        outer = self.names.get(name)
        if isinstance(node.iter, ast.Call):
            self._loop(node, node.iter, name)
        else:
            values = self.value(node.iter)
            if isinstance(values.kind, Array):
                self._over_array(node, values, name)
                return
            items = [self.constant(item, "") for item in getattr(values.kind, "value", ())]
            self._write_out(node, name, items or values.items)
        self.names.pop(name, None)
        if outer is not None:
            self.names[name] = outer

    def _loop(self, node: ast.For, call: ast.Call, name: str) -> None:
        """Translate a loop over a range."""
        start, stop, step = self._limits(node, call, name)
        if start.known is not None and stop.known is not None:
            values = range(start.known, stop.known, step)
            if not values:
                return
            if self._reads_table(node, name):
                self._write_out(node, name, [integer(value) for value in values])
                return
        own = "again" if name == "_" else identifier(name)
        sign = "<" if step > 0 else ">"
        move = {1: "++", -1: "--"}.get(step, f" += {step}")
        self.names[name] = Value(INT, own)
        self.lines.open(f"for (int {own} = {start.text}; {own} {sign} {stop.at(11)}; {own}{move})")
        self.inner(node.body)
        self.lines.close()

    def _limits(self, node: ast.For, call: ast.Call, name: str) -> tuple[Value, Value, int]:
        """Return start, stop and step of a range, which the loop leaves as they are."""
        self.require(self.value(call.func).kind == Object(range), node)
        changed = list(_stored(node))
        changed.remove(name)
        kept = _names(call) | {name}
        self.require(kept.isdisjoint(changed), node, "changes its own range")
        limits = [self.scalar(argument) for argument in call.args]
        if len(limits) == 1:
            limits.insert(0, integer(0))
        return limits[0], limits[1], limits[2].known if len(limits) > 2 else 1

    def _reads_table(self, node: ast.For, name: str) -> bool:
        """Test whether a loop reads a table that C does not have, at the loop's own variable."""
        for each in _subscripts(node):
            if name in _names(each.slice):
                is_here = _names(each.value) <= set(self.names)
                is_plain = isinstance(each.value, ast.Name | ast.Attribute)
                if is_here and is_plain and getattr(self.value(each.value).kind, "is_table", False):
                    return True
        return False

    def _over_array(self, node: ast.For, array: Value, name: str) -> None:
        """Translate a loop over the elements of an array."""
        own = Value(array.kind.element, identifier(name))
        index = f"{own.text}_index"
        self.lines.open(f"for (int {index} = 0; {index} < {array.kind.shape[0]}; {index}++)")
        self.lines.add(f"{own.declared()} = {array.at(ATOM)}[{index}];", own.text)
        self.names[name] = own
        self.inner(node.body)
        self.lines.close()
        del self.names[name]

    def _write_out(self, node: ast.For, name: str, values: list[Value]) -> None:
        """Write a loop's body once for each value."""
        jumps = [each for each in ast.walk(node) if isinstance(each, ast.Break | ast.Continue)]
        self.require(values and not jumps, node)
        for value in values:
            self.names[name] = value
            self.lines.open("")
            self.inner(node.body)
            self.lines.close()

    def do_annassign(self, node: ast.AnnAssign) -> None:
        """Translate an assignment with an annotation, which is not read."""
        assert node.value is not None
        self._assign(node.target, node.value)

    def do_assign(self, node: ast.Assign) -> None:
        """Translate an assignment."""
        for target in node.targets:
            self._assign(target, node.value)

    def _assign(self, target: ast.expr, source: ast.expr) -> None:
        if isinstance(target, ast.Tuple):
            self._unpack(target, source)
        elif not isinstance(target, ast.Name) or not self._allocate(target, source):
            self._store_at(target, self.value(source))

    def _store_at(self, target: ast.expr, value: Value) -> None:
        """Assign a value to a variable or to an element of an array."""
        if isinstance(target, ast.Subscript):
            self._write(target, "=", value)
        else:
            self.require(isinstance(target, ast.Name), target)
            assert isinstance(target, ast.Name)
            self._store(target, value)

    def _unpack(self, target: ast.Tuple, source: ast.expr) -> None:
        value = self.value(source)
        if isinstance(source, ast.Tuple):
            # A swap reads all before it writes.
            items = [self._kept(item) for item in value.items]
        else:
            items = value.items or self.temporary(value).parts()
        self.require(len(items) == len(target.elts), target, "has another number of values")
        for each, item in zip(target.elts, items, strict=True):
            if getattr(each, "id", "") != "_":
                self._store_at(each, item)

    def _kept(self, item: Value) -> Value:
        """Return a value that stays when its variable is written."""
        if item.known is not None:
            return item
        # In parentheses it is no name.
        return self.temporary(Value(item.kind, f"({item.text})", pointer=item.pointer))

    def _allocate(self, target: ast.Name, source: ast.expr) -> bool:
        """Declare an array if the source is one of ``np.empty`` or ``np.zeros``, or a copy."""
        if not isinstance(source, ast.Call):
            return False
        name = ast.unparse(source.func)
        element = INT if len(source.args) > 1 else DOUBLE
        if name in _ALLOCATORS:
            given = self.value(source.args[0])
            shape = tuple(size.known for size in given.items or [given])
            self._declare_array(target, element, shape, _ALLOCATORS[name])
            return True
        if not name.endswith(".copy"):
            return False
        assert isinstance(source.func, ast.Attribute)
        original = self.value(source.func.value)
        self._declare_array(target, original.kind.element, original.kind.shape, "")
        size = int(np.prod(original.kind.shape))
        copy = self.names[target.id].text
        self.lines.open(f"for (int k = 0; k < {size}; k++)")
        self.lines.add(f"{copy}[k] = {original.at(ATOM)}[k];")
        self.lines.close()
        return True

    def _declare_array(
        self, target: ast.Name, element: Scalar, shape: tuple[Any, ...], start: str
    ) -> None:
        """Declare an array of the function."""
        is_known = all(isinstance(size, int) for size in shape)
        self.require(is_known, target, "has a size that is not known")
        self.require(target.id not in self.names, target, "is allocated already")
        storage = Storage(self.function)
        storage.write()
        variable = Value(Array(element, shape, storage), identifier(target.id))
        self._note(target.id, variable)
        text = f"{element.tag} {variable.text}[{max(int(np.prod(shape)), 1)}]"
        self.lines.add(f"{text}{start};", variable.text)

    def _note(self, name: str, variable: Value) -> None:
        self.stored.add(name)
        self.names[name] = variable

    def _store(self, target: ast.Name, value: Value) -> None:
        """Assign a value to a variable, which is declared the first time."""
        name = target.id
        value = self.written(value)
        kind = value.kind
        self.require(not isinstance(kind, Object), target)
        own = self.names.get(name)
        if getattr(kind, "is_table", False):
            self._note(name, value)
        elif own is not None and not own.pointer:
            self._overwrite(target, own, value)
        else:
            # A struct that is handed in as a pointer stays: another one stands for it.
            is_once = self._stores[name] == 1
            known = value.known if is_once and kind is INT else None
            if isinstance(kind, Array) and not is_once:
                # It may point to something else later.
                kind = Array(kind.element, kind.shape, Storage(kind.storage.owner))
                kind.storage.pass_to(value.kind.storage)
            text = identifier(name) + "_" * (own is not None)
            variable = Value(kind, text, known=known, pointer=value.pointer)
            self._note(name, variable)
            self._declare(name, variable, value)

    def _declare(self, name: str, variable: Value, value: Value) -> None:
        start = variable.declared()
        if name not in self._wide:
            const = "const " * (variable.known is not None)
            self.lines.add(f"{const}{start} = {value.text};", variable.text)
            return
        zero = " = 0" * isinstance(variable.kind, Scalar)
        self.lines.add_first(f"{start}{zero};", variable.text)
        self.lines.add(f"{variable.text} = {value.text};", stored=variable.text)

    def _overwrite(self, target: ast.Name, own: Value, value: Value) -> None:
        kind = own.kind
        if value.text == own.text:
            return
        if isinstance(kind, Array) and isinstance(value.kind, Array):
            kind.storage.pass_to(value.kind.storage)
        is_narrow = kind is INT and value.kind is DOUBLE
        self.require(not is_narrow, target, "was an integer before: write it as a float")
        self.lines.add(f"{own.text} = {value.text};", stored=own.text)

    def do_augassign(self, node: ast.AugAssign) -> None:
        """Translate ``+=`` and the like."""
        self.require(type(node.op) in _SIGNS, node)
        sign = _SIGNS[type(node.op)]
        value = self.scalar(node.value)
        if isinstance(node.target, ast.Subscript):
            self._write(node.target, sign, value)
            return
        own = self.value(node.target)
        self.require(own.kind is not INT or value.kind is not DOUBLE, node)
        self.lines.add(f"{own.text} {sign} {value.text};", stored=own.text)

    def _write(self, target: ast.Subscript, sign: str, value: Value) -> None:
        self.require(isinstance(value.kind, Scalar), target, "is written with what is no number")
        owner = self.value(target.value)
        element = self.scalar(target)
        self.require(isinstance(owner.kind, Array), target)
        owner.kind.storage.write()
        self.lines.add(f"{element.text} {sign} {value.text};")


_ALLOCATORS = {"np.empty": "", "np.zeros": " = {0}"}
"""Functions that make an array, and how it begins."""


@lru_cache(maxsize=10_000)
def _stored(tree: ast.AST) -> list[str]:
    """List the names that are written in a tree."""
    names = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    return [node.id for node in names if isinstance(node.ctx, ast.Store)]


@lru_cache(maxsize=10_000)
def _names(tree: ast.AST) -> frozenset[str]:
    """Return the names in a tree."""
    return frozenset(each.id for each in ast.walk(tree) if isinstance(each, ast.Name))


@lru_cache(maxsize=10_000)
def _subscripts(tree: ast.AST) -> list[ast.Subscript]:
    """List the subscripts in a tree."""
    return [each for each in ast.walk(tree) if isinstance(each, ast.Subscript)]


def _is_known(value: Value) -> bool:
    return value.kind is INT and value.known is not None
