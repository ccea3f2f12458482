"""Write a shield in CUDA C++: its C as a GPU kernel over a grid, one thread for each arm."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from iiwa_dnn.export.core import TEMPLATES, filled
from iiwa_dnn.files import write_text

OUT_OF_LINE = 8
"""Lines from which on a function is called, not inlined: it compiles in 17 s in place of 138."""

_REWRITTEN = {
    r"#include .*": "",  # NVRTC has no headers
    r"#pragma .*": "",  # and -fmad=false
    r"\(\s*(\w+)\)\{": r"\1{",  # C++ has no compound literals
    rf"static inline (?=[^;{{}}]*\n\{{\n(?:(?!\}}).*\n){{{OUT_OF_LINE}}})": "static __noinline__ ",
    r"\n(?=[\w ]+ armstep_(load|step|place|rest|halt)\([^;{]*\n\{)": "\n__noinline__ ",
}
"""What of C is written in another way in CUDA C++, as regular expressions."""


def write_cuda(package: Path, texts: dict[str, Any], sources: Sequence[str]) -> None:
    """Write the sources for a GPU into the package of a shield.

    Args:
        package: Folder of the package.
        texts: Texts by their names in the templates.
        sources: Texts of the core and of the tables.
    """
    code = "\n".join(sources)
    for pattern, text in _REWRITTEN.items():
        code = re.sub(pattern, text, code)
    for path in sorted((TEMPLATES / "cuda").iterdir()):
        text = filled(path, texts | {"sources": code})
        write_text(package / path.name.removesuffix(".in"), text)
