"""C of the extension module that hands Python's arguments to the kernels."""

from __future__ import annotations

import json
from pathlib import Path

from .kinds import BOOL, FLOAT, INT, VOID, Kind
from .sources import ENTRY
from .translator import Made, Translator

_READERS = {FLOAT: "read_double", INT: "read_int", BOOL: "read_bool"}
_MAKERS = {FLOAT: "PyFloat_FromDouble", INT: "PyLong_FromLongLong", BOOL: "PyBool_FromLong"}


def prelude(name: str) -> str:
    """Return a file of C beside this one."""
    return (Path(__file__).parent / name).read_text(encoding="utf-8")


def extension(translator: Translator) -> str:
    """Write the extension module of all kernels that a translator has translated."""
    made = list(translator.made.values())
    # Arrays are no results for Python: they are given back.
    called = [own for own in made if not (own.result.axes or own.result.is_named)]
    table = []
    for own in made:
        address = "NULL" if own.decoration == ENTRY else f"(void *){own.name}"
        table.append(f'    {{"{own.name}", {address}, "{own.code}"}},')
    parts = [
        *map(prelude, ("binding.h", "kernels.h", "arena.h")),
        translator.text(),
        prelude("binding.c"),
        *map(_wrapper, called),
        "static PyMethodDef methods[] = {",
        '    {"scratch_peak", scratch_peak, METH_NOARGS, NULL},',
        *map(_row, called),
        "    {NULL, NULL, 0, NULL}\n};",
        "static const struct kernel kernels[] = {",
        *table,
        "    {NULL, NULL, NULL}\n};",
        prelude("module.c"),
    ]
    return "\n".join(parts) + "\n"


def _row(made: Made) -> str:
    """Write a kernel's row in the table of methods."""
    about = made.about.partition("\n")[0]
    text = json.dumps(f"{made.name}({', '.join(made.parameters)})\n--\n\n{about}")
    called = f"(PyCFunction)(void (*)(void))py_{made.name}"
    return f'    {{"{made.name}", {called}, METH_FASTCALL, {text}}},'


def _wrapper(made: Made) -> str:
    """Write the function that Python calls in place of a kernel."""
    kinds = made.parameters
    own = ", ".join(["arena_here()", *(f"{'&' * kinds[k].is_named}a_{k}" for k in kinds)])
    lines = [
        f"static PyObject *py_{made.name}(",
        "    PyObject *self, PyObject *const *given, Py_ssize_t count)\n{",
        *(f"    {kind.tag} a_{name};" for name, kind in kinds.items()),
        f'    if (!counted("{made.name}", count, {len(kinds)})',
    ]
    for i, (name, kind) in enumerate(kinds.items()):
        lines += _read(kind, name, f"given[{i}]", made.written)
    lines.append("    ) return NULL;")
    call = f"{made.name}({own});"
    if made.result is not VOID:
        lines.append(f"    {made.result.tag} result;")
        call = f"result = {call}"
    if made.decoration == "released":
        call = f"Py_BEGIN_ALLOW_THREADS {call} Py_END_ALLOW_THREADS"
    lines += [
        f"    {call}",
        "    if (failed && raise_failure()) return NULL;",
        f"    return {_object(made.result, 'result')};",
        "}",
    ]
    return "\n".join(lines)


def _read(kind: Kind, place: str, source: str, written: set[str]) -> list[str]:
    """Return the conditions that fail unless an argument is read."""
    if kind in _READERS:
        return [f"        || !{_READERS[kind]}({source}, &a_{place})"]
    if kind.axes:
        word = "read_doubles" if kind.element is FLOAT else "read_ints"
        rest = f"{kind.axes}, &a_{place}.size0, {str(place in written).lower()}"
        return [f"        || !((a_{place}.data = {word}({source}, {rest})))"]
    lines = [f"        || !is_tuple({source}, {len(kind.members)})"]
    for i, (name, own) in enumerate(kind.members):
        lines += _read(own, f"{place}.{name}", f"PyTuple_GET_ITEM({source}, {i})", written)
    return lines


def _object(kind: Kind, place: str) -> str:
    """Return the object of Python for a result."""
    if kind is VOID:
        return "Py_NewRef(Py_None)"
    if kind in _MAKERS:
        return f"{_MAKERS[kind]}({place})"
    items = [_object(own, f"{place}.{name}") for name, own in kind.members]
    return f'Py_BuildValue("({"N" * len(items)})", {", ".join(items)})'
