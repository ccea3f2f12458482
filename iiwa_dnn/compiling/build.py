"""Build the extension module: translate the kernels to C and compile them into the package."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

from .sources import has_kernels

FLAGS = (
    *("-std=gnu11", "-O3", "-ffp-contract=off", "-fno-strict-aliasing", "-shared", "-fPIC"),
    *("-fno-math-errno", "-fno-trapping-math"),
    *("-Wall", "-Wextra", "-Wconversion", "-Werror"),
)
"""Without contraction a result is that of Python's own arithmetic, to the last bit; nobody reads
errno or the flags of exceptions. No warning is off: types that do not fit are warned of."""


def build(package: Path) -> Path:
    """Translate and compile a package's kernels if they have changed; return the library's path.

    With ``IIWA_DNN_CHECKED=1`` an index outside of its array, or below 0, raises an IndexError.
    With ``IIWA_DNN_DRAFT=1`` compiling takes a quarter of the time, and a control step several
    times as long.

    Raises:
        TranslationError: A kernel leaves the subset of Python that is translated.
        RuntimeError: The compiler refuses a kernel, by file and line.
        LookupError: There is no compiler.
    """
    made = package / f"_kernels{sysconfig.get_config_var('EXT_SUFFIX')}"
    stamp = made.with_suffix(".digest")
    is_checked = os.environ.get("IIWA_DNN_CHECKED") == "1"
    flags = [*FLAGS, *_environment_flags()]
    kind = " ".join([*flags, "checked" * is_checked])
    noted = stamp.read_text().split() if made.is_file() and stamp.is_file() else []
    if noted and noted[0] == _digest(package, noted[2:], kind):
        return made
    from .binding import extension  # not needed by an import after which nothing is compiled
    from .expressions import Use
    from .translator import Translator

    translator = Translator(package, Use.CHECKED if is_checked else Use.LIBRARY)
    translator.all()
    text = extension(translator)
    bare = re.sub(r"#line[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    of_text = hashlib.sha256(f"{bare} {kind}".encode()).hexdigest()
    if of_text not in noted[1:2]:
        with tempfile.TemporaryDirectory(dir=package) as build:
            source = Path(build) / "_kernels.c"
            source.write_text(text, encoding="utf-8")
            output = source.with_suffix(".so")
            run_compiler([*flags, *_system_flags()], [source], output)
            output.replace(made)
    read = [own.file.relative_to(package).as_posix() for own in translator.package.modules]
    stamp.write_text(" ".join([_digest(package, read, kind), of_text, *read]) + "\n")
    return made


def _digest(package: Path, read: Sequence[str], kind: str) -> str:
    """Hash the files that a library is made from, and its flags.

    Args:
        package: Folder of the package.
        read: Paths in it of the modules that the last translation has read.
        kind: Flags of the compiler, and whether indices are checked.
    """
    found = {package / name for name in read} | {*package.glob("compiling/*.[chp]*")}
    found |= {path for path in package.rglob("*.py") if has_kernels(path)}
    contents = [path.read_bytes() for path in sorted(found) if path.is_file()]
    return hashlib.sha256(b"".join([kind.encode(), *contents])).hexdigest()


def compiler() -> list[str]:
    """Return the words of the C compiler's command: ``CC``, a system compiler, or ziglang's.

    Raises:
        LookupError: There is no compiler.
    """
    names = [*filter(None, [os.environ.get("CC")]), "cc", "gcc", "clang"]
    for name in names:
        if shutil.which(name.split()[0]):
            return name.split()
    if find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc", "-fno-sanitize=undefined"]
    raise LookupError("there is no C compiler: on Debian and Ubuntu: apt-get install gcc libc6-dev")


def run_compiler(flags: Sequence[str], sources: Sequence[Path], output: Path) -> None:
    """Compile files of C into one output file.

    Raises:
        RuntimeError: The compiler refuses them; its messages are the error's.
        LookupError: There is no compiler.
    """
    words = [*compiler(), *flags, *map(str, sources), "-o", str(output), "-lm"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{words[0]} does not compile {sources[-1].name}: {done.stderr[:2000]}")


def _environment_flags() -> list[str]:
    """Return the compiler's flags for ``IIWA_DNN_DRAFT``, and those in ``CFLAGS``."""
    draft = ["-Og"] if os.environ.get("IIWA_DNN_DRAFT") == "1" else []
    return [*draft, *os.environ.get("CFLAGS", "").split()]


def _system_flags() -> list[str]:
    """Return the compiler's flags for including Python and numpy, and for linking on macOS."""
    import numpy as np

    folders = [f"-isystem{path}" for path in (sysconfig.get_paths()["include"], np.get_include())]
    system = ["-undefined", "dynamic_lookup"] if sys.platform == "darwin" else []
    return [*folders, *system]
