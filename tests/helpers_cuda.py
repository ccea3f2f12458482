"""A stand-in for cupy, whose GPU is the CPU: kernels of `shields.cu` run over a grid, in C++."""

from __future__ import annotations

import ctypes
import importlib
import sys
from functools import cache, partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from helpers_export import run, use_armstep
from iiwa_dnn import Shield
from iiwa_dnn.export import tables
from iiwa_dnn.export.cuda import cuda_code

FREE = 10**11
"""Bytes that are free on the stand-in."""

LOCAL = 40_000
"""Bytes of stack of a thread."""


class DeviceArray(np.ndarray):
    """An array on the GPU: whoever reads its numbers waits for the GPU."""

    device = 0

    def __dlpack_device__(self) -> tuple[int, int]:
        return 2, 0

    def __bool__(self) -> bool:
        raise AssertionError("waits for the GPU")

    __float__ = __int__ = __iter__ = tolist = __bool__  # type: ignore[assignment]


def to_device(value: Any) -> Any:
    return np.array(value).view(DeviceArray)


class Device:
    """The one GPU."""

    id = 0
    attributes = {"MultiProcessorCount": 132, "MaxThreadsPerMultiProcessor": 2048}  # noqa: RUF012
    mem_info = (FREE, FREE)

    def __init__(self, number: int | None = None) -> None:
        pass

    def __eq__(self, other: object) -> bool:
        return self.id == other

    __hash__ = None  # type: ignore[assignment]

    def __enter__(self) -> None:
        pass

    def __exit__(self, *about: object) -> None:
        pass


class Kernel:
    """A kernel, launched over a grid with its arguments in memory, as by CUDA's driver."""

    local_size_bytes = LOCAL

    def __init__(self, library: ctypes.CDLL, name: str) -> None:
        self._run = getattr(library, f"run_{name}")

    def __call__(self, grid: tuple[int], block: tuple[int], arguments: tuple[Any, ...]) -> None:
        cells = [
            np.uintp(each.ctypes.data) if isinstance(each, np.ndarray) else each
            for each in arguments
        ]
        stored = [ctypes.create_string_buffer(each.tobytes()) for each in cells]
        pointers = (ctypes.c_void_p * len(stored))(*map(ctypes.addressof, stored))
        self._run(ctypes.c_uint(grid[0]), ctypes.c_uint(block[0]), pointers)


def stand_in(folder: Path, flags: tuple[str, ...]) -> Any:
    """Return what armstep takes from cupy; kernels are compiled in a folder."""

    def compiled(code: str, options: tuple[str, ...], backend: str) -> Any:
        own = folder / f"grid{len([*folder.glob('grid*.so')])}.so"
        (folder / "shields.cu").write_text(code, encoding="utf-8")
        source = Path(__file__).with_name("cuda_grid.cpp")
        words = ["-std=c++20", "-O1", "-fno-math-errno", "-w", "-shared", "-fPIC", *flags]
        macros = [each for each in options if each.startswith("-D")]
        run("g++", *words, *macros, "-I", folder, source, "-o", own)
        library = ctypes.CDLL(str(own))
        return SimpleNamespace(get_function=lambda name: Kernel(library, name))

    return SimpleNamespace(
        RawModule=cache(compiled),
        ndarray=type("ndarray", (), {}),  # those of the tests are somebody else's
        from_dlpack=lambda value: value,
        asarray=to_device,
        ascontiguousarray=np.ascontiguousarray,
        asnumpy=np.array,
        empty=lambda shape, dtype: np.empty(shape, dtype).view(DeviceArray),
        get_default_memory_pool=lambda: SimpleNamespace(free_bytes=lambda: 0),
        cuda=SimpleNamespace(Device=Device),
    )


def on_grid(shield: Shield, folder: Path, *flags: str) -> Any:
    """Return a function that makes `armstep.Shields` of a shield, on the CPU or the stand-in."""
    armstep = use_armstep()
    sys.modules["cupy"] = stand_in(folder, flags)
    try:
        cuda = importlib.import_module("armstep.cuda")
    finally:
        del sys.modules["cupy"]
    cuda.SOURCE = folder / "armstep.cu"
    cuda.SOURCE.write_text(cuda_code(), encoding="utf-8")
    return partial(armstep.Shields, tables(shield, folder / "arm.json"))
