"""Build of the extension module: source text to C, and C to a library beside the package."""

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

from .binding import extension
from .translator import Translator

FLAGS = (
    *("-std=gnu11", "-O3", "-ffp-contract=off", "-fno-strict-aliasing", "-shared", "-fPIC"),
    *("-Wall", "-Wextra", "-Wconversion", "-Werror"),
)
"""Without contraction a result is that of Python's own arithmetic, to the last bit. No warning is
off: types that do not fit are warned of."""


def build(package: Path) -> Path:
    """Translate a package's kernels and compile them, if they have changed; return the library.

    With ``IIWA_DNN_CHECKED=1``, an index outside of its array raises an IndexError, one that counts
    from the end too.

    Raises:
        TranslationError: A kernel leaves the subset of Python that is translated.
        RuntimeError: The compiler refuses a kernel, by file and line.
        LookupError: There is no compiler.
    """
    made = package / f"_kernels{sysconfig.get_config_var('EXT_SUFFIX')}"
    stamp = made.with_suffix(".digest")
    sources = [*package.rglob("*.py"), *(package / "compiling").glob("*.[ch]")]
    is_checked = os.environ.get("IIWA_DNN_CHECKED") == "1"
    contents = [*(path.read_bytes() for path in sorted(sources)), b"checked" * is_checked]
    of_files = hashlib.sha256(b"".join(contents)).hexdigest()
    noted = stamp.read_text() if made.is_file() and stamp.is_file() else ""
    if noted.startswith(of_files):
        return made
    translator = Translator(package, is_checked)
    translator.all()
    text = extension(translator)
    unmarked = re.sub(r"#line.*", "", text)  # which a comment changes
    of_text = hashlib.sha256(" ".join([unmarked, *FLAGS]).encode()).hexdigest()
    if of_text not in noted:
        with tempfile.TemporaryDirectory(dir=package) as place:
            source = Path(place) / "_kernels.c"
            source.write_text(text, encoding="utf-8")
            output = source.with_suffix(".so")
            run_compiler(_flags(), [source], output)
            output.replace(made)
    stamp.write_text(f"{of_files} {of_text}\n")
    return made


def compiler() -> list[str]:
    """Return the command of the C compiler: the environment's, the system's, or that of ziglang."""
    names = [*filter(None, [os.environ.get("CC")]), "cc", "gcc", "clang"]
    for name in names:
        if shutil.which(name.split()[0]):
            return name.split()
    if find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc", "-fno-sanitize=undefined"]
    raise LookupError("there is no C compiler: on Debian and Ubuntu: apt-get install gcc libc6-dev")


def run_compiler(flags: Sequence[str], sources: Sequence[Path], output: Path) -> None:
    """Compile files of C; raises what `build` does."""
    words = [*compiler(), *flags, *map(str, sources), "-o", str(output), "-lm"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{words[0]} does not compile {sources[-1].name}: {done.stderr[:2000]}")


def _flags() -> list[str]:
    """Return the compiler's flags for an extension module, and those of the environment."""
    import numpy as np

    folders = [f"-isystem{path}" for path in (sysconfig.get_paths()["include"], np.get_include())]
    system = ["-undefined", "dynamic_lookup"] if sys.platform == "darwin" else []
    return [*FLAGS, *folders, *system, *os.environ.get("CFLAGS", "").split()]
