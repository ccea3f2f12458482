"""Build of the extension module: source text to C, and C to a library beside the package."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from importlib.util import find_spec
from pathlib import Path

from .binding import extension
from .translator import Translator

FLAGS = ("-std=gnu11", "-O3", "-ffp-contract=off", "-fno-strict-aliasing", "-shared", "-fPIC")
"""Without contraction a result is that of Python's own arithmetic, to the last bit."""


def library(package: Path) -> Path:
    """Return the place of a package's library."""
    return package / f"_kernels{sysconfig.get_config_var('EXT_SUFFIX')}"


def digest(package: Path) -> str:
    """Return a digest of all that the library is made from."""
    sources = [*package.rglob("*.py"), *(package / "compiling").glob("*.[ch]")]
    return hashlib.sha256(b"".join(path.read_bytes() for path in sorted(sources))).hexdigest()


def is_current(package: Path) -> bool:
    """Test whether a package's library is made from the sources that stand beside it."""
    stamp = library(package).with_suffix(".digest")
    return stamp.is_file() and stamp.read_text().startswith(digest(package))


def build(package: Path) -> Path:
    """Translate the kernels of a package, compile them if they have changed; return the library.

    Raises:
        TranslationError: A kernel leaves the subset of Python that is translated.
        RuntimeError: There is no compiler, or it refuses the code.
    """
    made = library(package)
    stamp = made.with_suffix(".digest")
    now = digest(package)
    translator = Translator(package)
    translator.all()
    text = extension(translator)
    own = hashlib.sha256(" ".join([text, *FLAGS]).encode()).hexdigest()
    if not (made.is_file() and stamp.is_file() and own in stamp.read_text()):
        _compile(text, made)
    stamp.write_text(f"{now} {own}\n")
    return made


def compiler() -> list[str]:
    """Return the command of the C compiler: the environment's, the system's, or that of ziglang."""
    names = [*filter(None, [os.environ.get("CC")]), "cc", "gcc", "clang"]
    for name in names:
        if shutil.which(name.split()[0]):
            return name.split()
    if find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc", "-fno-sanitize=undefined"]
    raise RuntimeError("no C compiler: on Debian and Ubuntu apt-get install gcc libc6-dev")


def _compile(text: str, made: Path) -> None:
    import numpy as np

    paths = [sysconfig.get_paths()["include"], np.get_include()]
    folders = [word for path in paths for word in ("-I", path)]
    extra = os.environ.get("CFLAGS", "").split()
    if sys.platform == "darwin":
        extra += ["-undefined", "dynamic_lookup"]
    with tempfile.TemporaryDirectory(dir=made.parent) as place:
        source = Path(place) / "_kernels.c"
        source.write_text(text, encoding="utf-8")
        output = source.with_suffix(".so")
        words = [*compiler(), *FLAGS, "-w", *folders, str(source), "-o", str(output), "-lm", *extra]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{words[0]} refuses the kernels: {done.stderr[:2000]}")
        output.replace(made)
