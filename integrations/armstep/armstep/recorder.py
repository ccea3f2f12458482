"""A ring of the last minutes of an arm's steps on disk, which ``iiwa-dnn replay`` judges."""

from __future__ import annotations

import json
import platform
import threading
import time
from collections.abc import Callable
from pathlib import Path as _Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armstep.arms import TWIST
from armstep.shield import Shield, Shields
from armstep.tables import Path

SECONDS = 10.0
"""Time of one chunk [s]."""

HEAD = "head.json"
"""File of a recording that says of what it is."""


class Recorded:
    """A shield of one arm whose steps are recorded; all else is the shield's own.

    A step is kept with the time, the joint positions, the request, the stated period, the command
    and its reason. Chunks of 10 s are written by a thread, whole or not at all; the oldest go. The
    last one is written by `close`, at the end of a ``with`` block.

    Attributes:
        measured: Measured joint positions [rad], (n,), to be set before a step whose `q` are
            commanded ones; None: the step's `q`.
    """

    measured: ArrayLike | None = None

    def __init__(
        self,
        shield: Shield | Shields,
        folder: Path,
        minutes: float = 10.0,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        """Begin a recording.

        Args:
            shield: Shield of one arm.
            folder: The folder, which is made; it holds one recording.
            minutes: Time that is kept [min].
            now: The clock of the steps [s]; a simulation has its own.

        Raises:
            OSError: The folder cannot be written, or holds something.
        """
        self.shield = shield
        self.folder = _Path(folder)
        self._now = now
        self._most = round(60.0 * minutes / SECONDS)
        n = len(shield.tables.joint_names)
        k = len(shield.tables.obstacle_names)
        self._width = max(n, TWIST)
        times = [(each, float) for each in ("time", "took", "dt", "elapsed")]
        joints = [(each, float, n) for each in ("q", "measured", "dq", "next_q")]
        codes = [("kind", np.int8), ("reason", np.int8)]
        others = [("request", float, self._width), ("places", float, (k, 3))]
        self._rows = np.zeros(round(SECONDS / shield.dt), [*times, *joints, *codes, *others])
        self._count = 0
        self._places = np.reshape(shield.tables.members["numbers"].get("places", []), (k, 3))
        self._writer: threading.Thread | None = None
        self.folder.mkdir(parents=True)
        versions = {"python": platform.python_version(), "numpy": np.__version__}
        about = {"began": time.time(), "machine": platform.platform(), "versions": versions}
        text = json.dumps({**about, "tables": shield.tables.members}, indent=1)
        (self.folder / HEAD).write_text(text, encoding="utf-8")

    def __getattr__(self, name: str) -> Any:
        return getattr(self.shield, name)

    def __enter__(self) -> Recorded:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()

    def step(self, *arguments: Any, **given: Any) -> Any:
        """Take the shield's step, with its arguments, and keep it."""
        began = self._now()
        command = self.shield.step(*arguments, **given)
        own, said = self.shield._buffers, self.shield._input
        if given.get("obstacles") is not None:
            self._places = np.reshape(given["obstacles"], self._places.shape)
        seen = own.q[0] if self.measured is None else np.ravel(self.measured)
        joints = (own.q[0], seen, own.dq[0], own.next_q[0])
        times = (began, self._now() - began, said.dt, said.elapsed)
        others = (said.kind, own.results[0], own.asked[: self._width], self._places)
        self._rows[self._count] = (*times, *joints, *others)
        self._count += 1
        if self._count == len(self._rows):
            self._hand_over()
        return command

    def _hand_over(self) -> None:
        """Let a thread write the rows that are full, after those before, and begin new ones."""
        given = (self._rows[: self._count], self._writer)
        self._writer = threading.Thread(target=self._write, args=given)
        self._writer.start()
        self._rows = np.zeros_like(self._rows)
        self._count = 0

    def _write(self, rows: NDArray[Any], before: threading.Thread | None) -> None:
        """Write a chunk, whole or not at all, and let the oldest ones go."""
        if before is not None:
            before.join()
        file = self.folder / f"{rows['time'][0]:018.6f}.npz"
        part = file.with_suffix(".part")
        with part.open("wb") as opened:
            np.savez_compressed(opened, rows=rows)
        part.replace(file)
        for old in sorted(self.folder.glob("*.npz"))[: -self._most]:
            old.unlink()

    def close(self) -> None:
        """Write what is not yet written."""
        if self._count:
            self._hand_over()
        if self._writer is not None:
            self._writer.join()


def recorded(
    shield: Shield | Shields,
    folder: Path,
    minutes: float = 10.0,
    now: Callable[[], float] = time.monotonic,
) -> Recorded:
    """Record the steps of a shield of one arm in a folder, the last minutes of them."""
    return Recorded(shield, folder, minutes, now)
