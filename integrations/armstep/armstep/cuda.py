"""Shields of many arms on a GPU, one thread an arm, by cupy.

cupy compiles `shields.cu` at the first use, for the GPU at hand and the sizes of the arm, and keeps
it on disk; it exchanges arrays with torch, jax, warp and numba without a copy.
"""

from __future__ import annotations

from pathlib import Path as _Path
from typing import Any

import cupy
import numpy as np
from numpy.typing import ArrayLike

from armstep._library import LAID_OUT
from armstep.arms import Decisions
from armstep.errors import InputError, LibraryError
from armstep.shield import ShieldCommand, Shields
from armstep.tables import Array, Path, Tables

SOURCE = _Path(__file__).with_name("shields.cu")
"""The kernels."""

OPTIONS = ("-fmad=false", "--std=c++20")
"""Options of NVRTC beside cupy's own: products and sums are rounded one by one, as on the CPU."""

BLOCK = 32
"""Threads of a block, one warp: few arms are spread over all multiprocessors."""

CUDA = (2, 13)
"""Kinds of DLPack's devices: memory of a GPU, and managed memory."""

RUNNING: set[int] = set()
"""GPUs whose threads have their stack."""


def _array(name: str, value: Any, shape: tuple[int, ...], kinds: str) -> Any:
    """View an array on the GPU, of a shape and kinds of numbers."""
    found = value
    if not isinstance(value, cupy.ndarray):
        exchanges = hasattr(value, "__dlpack__") and value.__dlpack_device__()[0] in CUDA
        if not exchanges and not hasattr(value, "__cuda_array_interface__"):
            raise InputError(f"{name}: must be an array on the GPU, not {type(value).__name__}")
        found = cupy.from_dlpack(value) if exchanges else cupy.asarray(value)
    if found.dtype.kind not in kinds or found.shape != shape:
        raise InputError(f"{name}: must be of shape {shape}, not {found.dtype} {found.shape}")
    if found.device != cupy.cuda.Device():
        raise InputError(f"{name}: is on another GPU, {found.device}")
    return found


def _numbers(name: str, value: Any, shape: tuple[int, ...]) -> Any:
    return cupy.ascontiguousarray(_array(name, value, shape, "fiu"), dtype=np.float64)


class CudaShields(Shields):
    """Shields of N arms on a GPU: the commands of `Shields`, to the last bit.

    Arrays in and out are of cupy, torch, jax, warp or numba, on the GPU. Nothing waits for the GPU
    but questions about one arm, and copies. An array that a step was given has to stay as it is
    until the stream has come past the step.
    """

    device: str

    def __init__(
        self,
        tables: Path | Tables,
        count: int,
        threads: int | None = None,
        own: Path | None = None,
        device: str = "cuda",
    ) -> None:
        """Begin with a number of arms, on ``"cuda"``, the current GPU, or ``"cuda:1"``."""
        one = Shields(tables, 1, own=own)
        if not count >= 1:
            raise InputError(f"count: must be at least 1, not {count!r}")
        memory = np.broadcast_to(one._memory, (count, one.tables.memory))
        self._begin(one.tables, memory, device)

    def _begin(self, tables: Tables, memory: Array, device: str) -> None:  # type: ignore[override]
        super()._begin(tables, memory[:1].copy(), 1)
        struct, parts, arrays = tables._kept
        if len(parts):
            raise LibraryError("device: the parts of a user's own are for the CPU alone")
        n = len(tables.joint_names)
        sizes = (n, len(tables.obstacle_names), tables.memory, tables.scratch)
        names = ("JOINTS", "OBSTACLES", "MEMORY", "SCRATCH")
        macros = [f"-DGRID_{name}={size}" for name, size in zip(names, sizes, strict=True)]
        options = (*OPTIONS, *macros)
        code = SOURCE.read_text(encoding="utf-8")
        module = cupy.RawModule(code=code, options=options, backend="nvrtc")
        vars(self).update(count=len(memory), device=device)
        self._many = (len(memory),)
        self._shape = (len(memory), n)
        self._kernels = {
            each: module.get_function(f"grid_{each}") for each in ("load", "step", "rest")
        }
        number = device.partition(":")[2]
        self._device = cupy.cuda.Device(int(number) if number else None)
        with self._device:
            self._check_memory()
            self._arm = cupy.empty((LAID_OUT,), np.dtype(np.float64))
            status = cupy.empty((1,), np.dtype(np.int32))
            own = (np.frombuffer(bytes(struct), np.uint8), *arrays)
            self._held = [cupy.asarray(each) for each in own]
            self._kernels["load"]((1,), (1,), (self._arm, *self._held, status))
            found = int(cupy.asnumpy(status)[0])
            if found:
                raise LibraryError(f"the tables do not load on the GPU: status {found}")
            self._memory = cupy.asarray(np.ascontiguousarray(memory.T))

    def _check_memory(self) -> None:
        """Raise a MemoryError if the arms and the stack of all threads have no room."""
        about = self._device.attributes
        free = self._device.mem_info[0] + cupy.get_default_memory_pool().free_bytes()
        each = 8 * self.tables.memory + 16 * self._shape[1] + 5
        stack = self._kernels["step"].local_size_bytes
        stack *= about["MultiProcessorCount"] * about["MaxThreadsPerMultiProcessor"]
        stack *= self._device.id not in RUNNING
        if self.count * each + stack > free:
            raise MemoryError(
                f"{self.count} shields take {each} bytes each, {self.count * each / 1e6:.0f} MB,"
                f" and the stack of the GPU's threads {stack / 1e6:.0f} MB;"
                f" {free / 1e6:.0f} MB are free"
            )

    def __getstate__(self) -> tuple[Any, ...]:
        with self._lock, self._device:
            return self.tables, np.ascontiguousarray(cupy.asnumpy(self._memory).T), self.device

    def _last(self, i: int = 0) -> ShieldCommand:
        """Return the decision of arm i's last step, without its velocities."""
        with self._lock, self._device:
            memory = np.ascontiguousarray(cupy.asnumpy(self._memory[:, i]))
        return ShieldCommand(np.empty(0), np.empty(0), False, 0, self.tables, memory)

    def _each(self, mask: ArrayLike | None = None) -> Any:
        raise InputError(
            "place, save, load: are for the CPU; step has obstacles=, and pickles the state"
        )

    def _launch(self, name: str, *arguments: Any) -> None:
        """Launch a kernel with a thread for each arm; None is a pointer to nothing."""
        given = [np.uintp(0) if each is None else each for each in arguments]
        grid = (-(-self.count // BLOCK),)
        own = (self._arm, self._memory, np.int64(self.count), *given)
        self._kernels[name](grid, (BLOCK,), own)

    def _mask(self, name: str, value: ArrayLike | None) -> Any:
        """Return which arms a mask (N,) chooses; None: all."""
        if value is None:
            return None
        return cupy.ascontiguousarray(_array(name, value, (self.count,), "b"))

    def step(
        self,
        q: Any,
        dq: Any = None,
        *,
        twist: Any = None,
        position: Any = None,
        time: Any = None,
        lead: Any = None,
        given: Any = None,
        obstacles: Any = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> Decisions:
        """Compute the commands that are closest to requests, as `Shields.step`, on the GPU.

        It works on cupy's current stream. Obstacles that are not finite stay where they were, and
        their arms brake. No row is refused: `reason` says -1 where a step was, and its arm brakes.

        Args:
            q: Measured joint positions [rad], (N, n).
            dq: Joint velocities that are requested [rad/s], (N, n).
            twist: Or twists of the frame, (N, 6).
            position: Or joint positions to reach [rad], (N, n).
            time: None, as `lead`: there are no streams.
            lead: None.
            given: Whether each arm has a new request, (N,); None: all have.
            obstacles: Where the obstacles' centres are [m], (k, 3) or (N, k, 3).
            dt: Period for which the commands will be held [s].
            elapsed: Time since the last step [s].

        Raises:
            InputError: An array has a wrong shape or is not on the GPU, or a period is wrong.
        """
        if not time is lead is None:
            self.follow()
        periods = map(np.float64, self._periods(dt, elapsed))
        with self._lock, self._device:
            joints = _numbers("q", q, self._shape)
            kind, request = self._request(dq, twist, position, read=_numbers)
            mask = self._mask("given", given)
            places: Any = None
            shape: tuple[int, ...] = (len(self.tables.obstacle_names), 3)
            if obstacles is not None:
                shape = (*self._many, *shape)[3 - obstacles.ndim :]
                places = _numbers("obstacles", obstacles, shape)
            stride = np.int64(np.prod(shape[1:]) if len(shape) > 2 else 0)
            shapes = (self._shape, self._shape, self._many, self._many)
            types = (np.float64, np.float64, np.bool_, np.int32)
            answers = [cupy.empty(*own) for own in zip(shapes, map(np.dtype, types), strict=True)]
            asked = (joints, np.int32(kind), request, mask, places, stride, *periods)
            self._launch("step", *asked, *answers)
            RUNNING.add(self._device.id)
        dq, next_q, clipped, reason = answers
        return Decisions(dq, next_q, clipped, reason, self)

    @property
    def time(self) -> float:
        """Refuse, as `follow`."""
        raise InputError("time: is not there on a GPU")

    def follow(self, *about: Any, **named: Any) -> None:
        """Refuse: the shields of a GPU follow no samples."""
        raise InputError("follow: is not there on a GPU")

    def reset(self, mask: Any = None, q: Any = None) -> None:
        """Let arms stand at joint positions q (N, n) [rad]; None: where they are measured next."""
        self._rest(mask, q, False)

    def halt(self, mask: Any = None) -> None:
        """Let arms brake from now on, whatever is requested, until `reset`."""
        self._rest(mask, None, True)

    def _rest(self, mask: Any, q: Any, halts: bool) -> None:
        with self._lock, self._device:
            joints = None if q is None else _numbers("q", q, self._shape)
            self._launch("rest", self._mask("mask", mask), joints, np.bool_(halts))
