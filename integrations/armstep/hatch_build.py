"""Build hook: compile the library, by a C compiler or the one that ziglang brings.

CC names another compiler, ARMSTEP_PLATFORM the platform of a wheel that it compiles for.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

FLAGS = ("-std=c99", "-O2", "-fno-math-errno", "-shared", "-fPIC", "-s")
FOLDER = Path(__file__).parent / "armstep"


def compiler() -> list[str]:
    """Return the command of the environment's compiler, or of one that is installed, or none."""
    names = [*filter(None, [os.environ.get("CC")]), "cc", "gcc", "clang"]
    return next((name.split() for name in names if shutil.which(name.split()[0])), [])


class LibraryHook(BuildHookInterface):
    """Compilation of the library into a wheel that serves every Python."""

    def dependencies(self) -> list[str]:
        """Ask for ziglang if there is no compiler."""
        return [] if compiler() else ["ziglang"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile for a wheel, editable or not; an sdist takes the source."""
        source = FOLDER / "armstep.c"
        if not source.is_file():
            sys.exit("armstep.c is missing: .ci/core writes it in a checkout of iiwa_dnn")
        if self.target_name != "wheel":
            return
        words = compiler() or [sys.executable, "-m", "ziglang", "cc"]
        library = FOLDER / "_library.bin"
        done = subprocess.run(
            [*words, *FLAGS, str(source), "-o", str(library), "-lm"],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            sys.exit(f"armstep: {words[0]} does not compile the library: {done.stderr[:500]}")
        own = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["tag"] = f"py3-none-{os.environ.get('ARMSTEP_PLATFORM', own)}"
        build_data["pure_python"] = False
        build_data["artifacts"].append("armstep/_library.bin")
