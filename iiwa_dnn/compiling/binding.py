"""C of the extension module that hands Python's arguments to the kernels."""

from __future__ import annotations

import json
from pathlib import Path

from .kinds import BOOL, FLOAT, INT, VOID, Array, Kind, Struct
from .sources import ENTRY
from .translator import Made, Translator, is_named

_READERS = {FLOAT: "read_double", INT: "read_int", BOOL: "read_bool"}
_MAKERS = {FLOAT: "PyFloat_FromDouble", INT: "PyLong_FromLongLong", BOOL: "PyBool_FromLong"}


def prelude(name: str) -> str:
    """Return a file of C beside this one."""
    return (Path(__file__).parent / name).read_text(encoding="utf-8")


def extension(translator: Translator) -> str:
    """Write the extension module of all kernels that a translator has translated."""
    made = list(translator.made.values())
    called = [own for own in made if _is_returned(own.result)]
    rows = [_row(own) for own in called]
    pointers = [own for own in made if own.decoration != ENTRY]
    table = [f'    {{"{own.name}", (void *){own.name}, "{own.code}"}},' for own in pointers]
    table += [f'    {{"{own.name}", NULL, "{own.code}"}},' for own in made if own not in pointers]
    parts = [
        prelude("binding.h"),
        prelude("kernels.h"),
        prelude("arena.h"),
        translator.text(),
        prelude("binding.c"),
        *map(_wrapper, called),
        "static PyMethodDef methods[] = {",
        '    {"scratch_peak", scratch_peak, METH_NOARGS, NULL},',
        *rows,
        "    {NULL, NULL, 0, NULL}\n};",
        "static const struct kernel kernels[] = {",
        *table,
        "    {NULL, NULL, NULL}\n};",
        prelude("module.c"),
    ]
    return "\n".join(parts) + "\n"


def _is_returned(kind: Kind) -> bool:
    """Test whether Python is handed a result of this type: no arrays, which are given back."""
    if isinstance(kind, Struct):
        return not kind.is_named and all(_is_returned(own) for _, own in kind.members)
    return not isinstance(kind, Array)


def _row(made: Made) -> str:
    """Write a kernel's row in the table of methods."""
    about = made.about.partition("\n")[0]
    text = json.dumps(f"{made.name}({', '.join(made.parameters)})\n--\n\n{about}")
    called = f"(PyCFunction)(void (*)(void))py_{made.name}"
    return f'    {{"{made.name}", {called}, METH_FASTCALL, {text}}},'


def _wrapper(made: Made) -> str:
    """Write the function that Python calls in place of a kernel."""
    head = (
        f"static PyObject *py_{made.name}(PyObject *self, PyObject *const *given, Py_ssize_t count)"
    )
    lines = [head, "{"]
    kinds = list(made.parameters.values())
    for i, kind in enumerate(kinds):
        lines.append(f"    {kind.tag} a{i};")
    lines.append(f'    if (!counted("{made.name}", count, {len(kinds)})')
    for i, kind in enumerate(kinds):
        _read(kind, f"a{i}", f"given[{i}]", lines, i in made.written)
    lines.append("    ) return NULL;")
    own = ", ".join(["arena_here()", *(f"{'&' * is_named(k)}a{i}" for i, k in enumerate(kinds))])
    result = made.result
    call = f"{made.name}({own});"
    if result is not VOID:
        lines.append(f"    {result.tag} result;")
        call = f"result = {call}"
    unlocked = made.decoration == "released"
    lines += ["    Py_BEGIN_ALLOW_THREADS"] * unlocked
    lines.append(f"    {call}")
    lines += ["    Py_END_ALLOW_THREADS"] * unlocked
    lines.append("    if (failed && raise_failure()) return NULL;")
    lines.append(f"    return {_object(result, 'result')};")
    return "\n".join([*lines, "}"])


def _read(kind: Kind, place: str, source: str, lines: list[str], writes: bool = False) -> None:
    """Write the conditions that fail unless an argument is read."""
    if isinstance(kind, Array):
        word = "read_doubles" if kind.element is FLOAT else "read_ints"
        rest = f"{kind.axes}, &{place}.size0, {str(writes).lower()}"
        lines.append(f"        || !(({place}.data = {word}({source}, {rest})))")
    elif isinstance(kind, Struct):
        lines.append(f"        || !is_tuple({source}, {len(kind.members)})")
        for i, (name, own) in enumerate(kind.members):
            _read(own, f"{place}.{name}", f"PyTuple_GET_ITEM({source}, {i})", lines)
    else:
        lines.append(f"        || !{_READERS[kind]}({source}, &{place})")


def _object(kind: Kind, place: str) -> str:
    """Return the object of Python for a result."""
    if kind is VOID:
        return "Py_NewRef(Py_None)"
    if not isinstance(kind, Struct):
        return f"{_MAKERS[kind]}({place})"
    items = [_object(own, f"{place}.{name}") for name, own in kind.members]
    return f'Py_BuildValue("({"N" * len(items)})", {", ".join(items)})'
