"""Write armstep in CUDA C++: as GPU kernels over a grid, one thread for each shield."""

import re

from iiwa_dnn.export.core import TEMPLATES, core, filled

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


def cuda_code() -> str:
    """Return armstep with its kernels over a grid, `shields.cu` of the Python package."""
    code = f"{core().header}\n{core().code}"
    for pattern, text in _REWRITTEN.items():
        code = re.sub(pattern, text, code)
    return filled(TEMPLATES / "cuda" / "shields.cu", {"sources": code})
