"""Build hook: compile the kernels before the package is packed or installed."""

import os
import shutil
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

# Not through the package, which imports what a build has not: its own requirements.
sys.path.insert(0, str(Path(__file__).parent / "iiwa_dnn"))


class KernelHook(BuildHookInterface):
    """Compilation of the kernels into a library beside the package's modules."""

    def dependencies(self) -> list[str]:
        """Ask for the compiler in a wheel where the system has none."""
        names = [os.environ.get("CC"), "cc", "gcc", "clang"]
        return [] if any(name and shutil.which(name.split()[0]) for name in names) else ["ziglang"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile for a wheel, editable or not; an sdist takes the sources alone."""
        if self.target_name == "wheel":
            from compiling.build import build

            library = build(Path(self.root) / "iiwa_dnn")
            build_data["pure_python"] = False
            build_data["infer_tag"] = True
            build_data["artifacts"].append(f"iiwa_dnn/{library.name}")
