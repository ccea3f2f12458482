"""Make the README's animation out of a run: python scripts/animate_heart.py RUN [OUT.gif]."""

import sys
from itertools import islice
from pathlib import Path

import numpy as np
import tyro
from PIL import Image, ImageDraw

from iiwa_dnn import Record, load_robot
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.files import write_atomically
from iiwa_dnn.results.pictures import FRAME_RATE, frames

EVERY = 3  # pictures of the video for one here
SIZE = (480, 270)  # pixel
COLOURS = 160
REST = 1500  # how long the last picture stands [ms]


def path_so_far(record, sample):
    """Draw the desired path in grey and the drawn one in red, from above."""
    panel = Image.new("RGB", (SIZE[1], SIZE[1]), "white")
    draw = ImageDraw.Draw(panel)
    low = record.position_desired.min(axis=0)
    scale = 0.8 * SIZE[1] / np.ptp(record.position_desired, axis=0).max()
    for path, color in (
        (record.position_desired, "#b8b8b8"),
        (record.position[:sample], "#d6001c"),
    ):
        corners = 0.1 * SIZE[1] + scale * (path[::20] - low)
        draw.line([(x, SIZE[1] - y) for x, y, _ in corners], fill=color, width=3)
    return panel


def main(
    run: tyro.conf.Positional[str] = "runs/heart",
    out: tyro.conf.Positional[str] = "docs/images/heart.gif",
):
    """Draw and write."""
    record = Record.load(Path(run) / "record.npz")
    robot = load_robot(record.settings["robot"], tip=record.settings["tip"])
    pictures = []
    for i, frame in enumerate(islice(frames(robot, record), 0, None, EVERY)):
        picture = Image.new("RGB", (SIZE[0] + SIZE[1], SIZE[1]))
        picture.paste(Image.fromarray(frame).resize(SIZE, Image.Resampling.LANCZOS))
        sample = np.searchsorted(record.t, record.t[0] + i * EVERY / FRAME_RATE)
        picture.paste(path_so_far(record, sample + 1), (SIZE[0], 0))
        pictures.append(picture)
    # One palette for all, out of the last picture, which has every colour in it: no flicker.
    palette = pictures[-1].quantize(COLOURS)
    first, *rest = (p.quantize(palette=palette, dither=Image.Dither.NONE) for p in pictures)
    times = [1000 * EVERY // FRAME_RATE] * len(rest) + [REST]
    write_atomically(
        out,
        lambda file: first.save(
            file, "GIF", save_all=True, append_images=rest, duration=times, loop=0, optimize=True
        ),
    )
    print(f"{len(pictures)} pictures, {Path(out).stat().st_size / 1e6:.2f} MB, written to {out}")


if __name__ == "__main__":
    sys.exit(run_script(main))
