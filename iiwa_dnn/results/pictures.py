"""The arm at work, as a figure of five moments (the paper's Fig. 3) and as a video."""

from __future__ import annotations

import importlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.errors import FileError, MissingDependencyError
from iiwa_dnn.files import one_line, write_atomically
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.rendering import ArmRenderer, Image, View, sample_at
from iiwa_dnn.robot.robot import Robot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOMENTS = 5
"""Pictures in the figure: after each fifth of the run, so at 2, 4, 6, 8 and 10 s of the paper's."""

FRAME_RATE = 25
"""Pictures in a second of the video, which runs in real time."""

WIDTH, HEIGHT, INSET = 960, 540, 208  # of the video [pixel]
_MARGIN = 12


def save_moments(robot: Robot, record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Write ``moments.png`` and ``moments.pdf`` into a folder, made if need be; return the files.

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
        FileError: The folder cannot be written.
    """
    return write_figures({"moments": partial(moments_figure, robot, record)}, folder)


def moments_figure(robot: Robot, record: Record, pixels: int = 560) -> Figure:
    """Draw the arm at five moments, and below each the path so far, face on.

    Each picture is `pixels` wide and high.

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
    """
    samples = [sample_at(record, t) for t in moments(record)]
    figure = new_figure(DOUBLE_COLUMN, 2.0 * DOUBLE_COLUMN / MOMENTS + 0.2)
    layout: Any = figure.get_layout_engine()
    layout.set(w_pad=0.02, h_pad=0.02, wspace=0.0, hspace=0.0)
    views: tuple[View, View] = ("arm", "path")
    for panels, view in zip(figure.subplots(2, MOMENTS), views, strict=True):
        with ArmRenderer(robot, record, pixels, pixels, view) as renderer:
            for panel, sample in zip(panels, samples, strict=True):
                panel.imshow(renderer.draw(sample), interpolation="lanczos")
                panel.set_axis_off()
                if view == "arm":
                    panel.set_title(f"$t$ = {record.t[sample]:.3g} s", fontsize=8, pad=3)
    return figure


def moments(record: Record) -> list[float]:
    """Return the times that the figure shows [s]."""
    times: list[float] = np.linspace(record.t[0], record.t[-1], MOMENTS + 1)[1:].tolist()
    return times


def save_video(
    robot: Robot,
    record: Record,
    path: str | os.PathLike[str],
    progress: Callable[[int], object] | None = None,
) -> Path:
    """Write a video of the run in real time: MP4 (H.264), which browsers play.

    The old file stays until the new one is whole. `progress` is called after each picture with 1.

    Raises:
        MissingDependencyError: MuJoCo, an OpenGL library or the encoder is not installed.
        FileError: The file cannot be written.
    """
    encoder = import_encoder()
    options: dict[str, Any] = {
        "fps": FRAME_RATE, "codec": "libx264", "quality": None, "macro_block_size": 2,
        "ffmpeg_log_level": "error",
        # Good quality; the index at the front, so that a page can start to play it at once.
        "output_params": ["-crf", "20", "-preset", "fast", "-movflags", "+faststart"],
    }  # fmt: skip
    path = Path(path)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "video.mp4"
        writer = encoder.write_frames(str(file), (WIDTH, HEIGHT), **options)
        try:
            writer.send(None)
            for frame in frames(robot, record):
                writer.send(np.ascontiguousarray(frame))
                if progress is not None:
                    progress(1)
        except OSError as error:
            raise FileError(path, f"cannot be encoded ({one_line(error)})") from error
        finally:
            writer.close()
        write_atomically(path, lambda target: target.write(file.read_bytes()))
    return path


def import_encoder() -> Any:
    """Import imageio-ffmpeg, which brings ffmpeg in its wheel.

    Raises:
        MissingDependencyError: If it is not installed.
    """
    try:
        return importlib.import_module("imageio_ffmpeg")
    except ImportError as error:
        package = "the Python package imageio-ffmpeg"
        raise MissingDependencyError(package, "pip install 'iiwa-dnn[sim]'") from error


def frame_times(record: Record) -> list[float]:
    """Return the times of the video's pictures [s], the run's first and last among them."""
    count = max(1, round(float(record.t[-1] - record.t[0]) * FRAME_RATE)) + 1
    times: list[float] = np.linspace(record.t[0], record.t[-1], count).tolist()
    return times


def frames(robot: Robot, record: Record) -> Iterator[Image]:
    """Draw the video's pictures, (HEIGHT, WIDTH, 3): the arm, in a corner the path, the time."""
    with ExitStack() as stack:
        arm = stack.enter_context(ArmRenderer(robot, record, WIDTH, HEIGHT, "arm", smooth=False))
        path = stack.enter_context(ArmRenderer(robot, record, INSET, INSET, "path"))
        for t in frame_times(record):
            sample = sample_at(record, t)
            frame = arm.draw(sample).copy()
            top, right = _MARGIN, WIDTH - _MARGIN
            frame[top - 1 : top + INSET + 1, right - INSET - 1 : right + 1] = 96  # its border
            frame[top : top + INSET, right - INSET : right] = path.draw(sample)
            yield _captioned(frame, f"t = {t:5.2f} s")


def _captioned(frame: Image, text: str) -> Image:
    from PIL import Image as PillowImage
    from PIL import ImageDraw, ImageFont

    picture = PillowImage.fromarray(frame)
    font = ImageFont.load_default(22)
    ImageDraw.Draw(picture).text((_MARGIN + 4, _MARGIN), text, fill=(40, 40, 40), font=font)
    return np.asarray(picture)
