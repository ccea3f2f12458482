"""Write the C of an extension module that converts Python's arguments and calls the kernels."""

from __future__ import annotations

from pathlib import Path

from .expressions import Use
from .kinds import FLOAT, VOID, Kind
from .translator import Function, Translator

_READERS = {"double": "read_double", "int64_t": "read_int", "bool": "read_bool"}
_MAKERS = {
    "double": "PyFloat_FromDouble",
    "int64_t": "PyLong_FromLongLong",
    "bool": "PyBool_FromLong",
}

LARGE = 40
"""Conditions of a named tuple above which its last conversion is reused for the same tuple."""


def prelude(name: str) -> str:
    """Return the text of a file of C in this folder, by its file name."""
    return (Path(__file__).parent / name).read_text(encoding="utf-8")


def extension(translator: Translator) -> str:
    """Write one file of C: the functions of a translator, and a Python function for each."""
    functions = list(translator.functions.values())
    # Arrays are no results for Python: they are given back. A record of several sizes is viewed.
    called = [
        own
        for own in functions
        if not (own.result.axes or own.result.is_named)
        and all(kind.is_sized for kind in own.parameters.values())
    ]
    parts = [
        *map(prelude, ("binding.h", "kernels.h", "arena.h")),
        prelude("checked.h") * (translator.use is Use.CHECKED),
        translator.text(),
        prelude("binding.c"),
        *map(_wrapper, called),
        "static PyMethodDef methods[] = {",
        *map(_method, called),
        "    {NULL, NULL, 0, NULL}\n};",
        "static const struct kernel kernels[] = {",
        *map(_kernel, functions),
        "    {NULL, NULL, 0}\n};",
        prelude("module.c"),
    ]
    return "\n".join(parts) + "\n"


def _kernel(own: Function) -> str:
    """Write a kernel's row in the C table of names, type codes and, of parts, numbers."""
    number = own.translator.numbers.get(own.name, 0)
    return f'    {{"{own.name}", "{own.code}", {number}}},'


def _method(own: Function) -> str:
    """Write a kernel's row in the extension module's table of methods."""
    called = f"(PyCFunction)(void (*)(void))py_{own.name}"
    return f'    {{"{own.name}", {called}, METH_FASTCALL, NULL}},'


def _wrapper(own: Function) -> str:
    """Write the C function that converts Python arguments, calls a kernel, converts its result."""
    kinds = own.parameters
    given = ["arena_here()", *("&" * kinds[name].is_named + f"a_{name}" for name in kinds)]
    call = f"{own.name}({', '.join(given)});"
    read = [f'!counted("{own.name}", count, {len(kinds)})']
    kept = []
    for i, (name, kind) in enumerate(kinds.items()):
        conditions = _read(kind, name, f"given[{i}]", own.written)
        if len(conditions) > LARGE:
            kept.append(f"    static PyObject *seen_{name};\n    static {kind.tag} kept_{name};")
            place = f"given[{i}], &seen_{name}, &a_{name}, &kept_{name}, sizeof a_{name}"
            conditions = [f"(!is_seen({place}) && ({' || '.join(conditions)} || !keep({place})))"]
        read += conditions
    if own.result is not VOID:
        call = f"result = {call}"
    if own.translator.use is Use.CHECKED:
        call = f"BEGIN_CHECKED {call} END_CHECKED"
    elif own.decoration == "released":
        call = f"Py_BEGIN_ALLOW_THREADS {call} Py_END_ALLOW_THREADS"
    parameters = "PyObject *self, PyObject *const *given, Py_ssize_t count"
    lines = [
        f"static PyObject *py_{own.name}({parameters})\n{{",
        *kept,
        *(f"    {kind.tag} a_{name};" for name, kind in kinds.items()),
        f"    if ({' || '.join(read)}) return NULL;",
        f"    {own.result.tag} result;" * (own.result is not VOID),
        "    (void)self;",
        f"    {call}",
        "    if (failed && raise_failure()) return NULL;",
        f"    return {_object(own.result, 'result')};\n}}",
    ]
    return "\n".join(lines)


def _read(kind: Kind, place: str, source: str, written: set[str]) -> list[str]:
    """Return C conditions that convert an argument, each true if the argument is refused.

    Args:
        kind: Type of the argument.
        place: Name of the C variable that is written, without its prefix ``a_``.
        source: C expression of the Python object.
        written: Arrays, by their places, that the kernel writes: these must not be read-only.
    """
    if kind.axes:
        word = "read_doubles" if kind.element is FLOAT else "read_ints"
        rest = f"{kind.axes}, &a_{place}.size0, {str(place in written).lower()}"
        return [f"!((a_{place}.data = {word}({source}, {rest})))"]
    if kind.sizes:
        numbers = f"a_{place}.numbers"
        writes = str(any(each.startswith(f"{place}.") for each in written)).lower()
        fixed, *shared = kind.sizes.values()
        size = [f"({numbers}.size0 - {fixed}) / {own}" for own in shared]
        return [
            f"!(({numbers}.data = read_doubles({source}, 1, &{numbers}.size0, {writes})))",
            f'!has_size("{kind.tag}", {numbers}.size0, {fixed}, {sum(shared)})',
            f"((a_{place} = {kind.tag}_of({', '.join([numbers, *size])})), false)",
        ]
    if not kind.members:
        return [f"!{_READERS[kind.tag]}({source}, &a_{place})"]
    lines = [f"!is_tuple({source}, {len(kind.members)})"]
    for i, (name, own) in enumerate(kind.members.items()):
        lines += _read(own, f"{place}.{name}", f"PyTuple_GET_ITEM({source}, {i})", written)
    return lines


def _object(kind: Kind, place: str) -> str:
    """Return the C expression that makes a Python object of a kernel's result."""
    if kind is VOID:
        return "Py_NewRef(Py_None)"
    if not kind.members:
        return f"{_MAKERS[kind.tag]}({place})"
    items = [_object(own, f"{place}.{name}") for name, own in kind.members.items()]
    return f'Py_BuildValue("({"N" * len(items)})", {", ".join(items)})'
