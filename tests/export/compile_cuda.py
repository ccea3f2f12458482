"""A shield's kernels compiled for GPUs by NVRTC's wheel: ``make cuda``, without a GPU.

The suite does not collect this file: the wheel has 142 MB.
"""

import ctypes
import re
from importlib.metadata import files
from pathlib import Path
from typing import Any

import pytest

from helpers_export import use_armstep
from iiwa_dnn.export.cuda import cuda_code


@pytest.fixture(scope="module")
def nvrtc() -> Any:
    found = [each for each in files("nvidia-cuda-nvrtc") or () if "libnvrtc.so" in each.name]
    return ctypes.CDLL(str(found[0].locate()))


def compiled(nvrtc: Any, source: str, architecture: str) -> dict[str, bytes]:
    """Compile the kernels with the options of the package and of cupy; return PTX and cubin."""
    page = Path(use_armstep().__file__).with_name("cuda.py").read_text(encoding="utf-8")
    options = re.search(r"^OPTIONS = \((.*)\)$", page, re.M)
    assert options
    words = [*re.findall(r'"(.+?)"', options[1]), "-ftz=true", f"-arch={architecture}"]
    words.append("--device-as-default-execution-space")
    words += ["-DGRID_JOINTS=7", "-DGRID_OBSTACLES=1", "-DGRID_MEMORY=536", "-DGRID_SCRATCH=9374"]
    program, size = ctypes.c_void_p(), ctypes.c_size_t()
    text = source.encode()
    nvrtc.nvrtcCreateProgram(ctypes.byref(program), text, b"shields.cu", 0, None, None)
    texts = (ctypes.c_char_p * len(words))(*map(str.encode, words))
    result = nvrtc.nvrtcCompileProgram(program, len(words), texts)

    def got(kind: str) -> bytes:
        getattr(nvrtc, f"nvrtcGet{kind}Size")(program, ctypes.byref(size))
        data = ctypes.create_string_buffer(size.value)
        getattr(nvrtc, f"nvrtcGet{kind}")(program, data)
        return data.raw

    log = got("ProgramLog").decode()
    assert (result, log.strip("\0\n ")) == (0, "")
    return {kind: got(kind) for kind in ("PTX", "CUBIN")}


def test_ptx_and_cubin_round_every_sum_and_product(nvrtc: Any) -> None:
    made = compiled(nvrtc, cuda_code(), "sm_90")
    assert made["CUBIN"].startswith(b"\x7fELF")
    text = made["PTX"].decode()
    found = re.split(r"^\.(?:func|visible \.entry) ", text, flags=re.MULTILINE)[1:]
    names = {kernel for kernel in ("grid_step", "grid_rest") if f".entry {kernel}(" in text}
    assert names == {"grid_step", "grid_rest"}
    # No sum with a product in one rounding, no elementary function, no double made shorter: but in
    # functions for feed-forward along a path and for a task's axis, which a shield has not.
    loose = re.compile(r"\bfma\.|\b(?:add|sub|mul)\.f64|\.approx|\.f32|\.ftz")
    others = [each.splitlines()[0] for each in found if loose.search(each)]
    unused = ("rotation_log", "tasks_axis_rows")
    assert all(any(word in each for word in unused) for each in others), others
    assert len(re.findall(r"\b(?:add|mul)\.rn\.f64", text)) > 1000
