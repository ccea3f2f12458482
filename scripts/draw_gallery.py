"""Draw the pictures of docs/gallery.md: python scripts/draw_gallery.py [FOLDER].

Each scene is one of the worked examples or a run of the command line; one sees the arm at the end
of the run with the paths it drew, or the figure that tells most.
"""

import contextlib
import io
import runpy
import sys
from functools import partial
from pathlib import Path

import numpy as np
import tyro
from PIL import Image, ImageDraw
from scipy.spatial.transform import Rotation

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.app.main import main as command
from iiwa_dnn.files import prepare_folder
from iiwa_dnn.results import plots
from iiwa_dnn.results.pictures import ArmRenderer

HERE = Path(__file__).parent
PAGE = HERE.parent / "docs/images/viewer_live.png"
TILE = (256, 184)  # size of a picture on the sheet [pixel]
COLUMNS = 4  # pictures in a row
CSV = "t,x,y,z\n0,0,0,0\n2,0.06,0,0.04\n4,0.06,0.08,0\n6,0,0.08,0.04\n8,0,0,0\n"


def example(name, *arguments):
    """Run a worked example; return its records and the robot of the last one."""
    kept = []
    simulate = iiwa_dnn.simulate

    def keep(robot, *args, **options):
        kept.append((simulate(robot, *args, **options), robot))
        return kept[-1][0]

    iiwa_dnn.simulate, before, sys.argv = keep, sys.argv, [name, *arguments]
    try:
        with contextlib.suppress(SystemExit):
            runpy.run_path(str(HERE / name), run_name="__main__")
    finally:
        iiwa_dnn.simulate = simulate
        sys.argv = before
    return kept


def run(*arguments):
    """Run the command line; return its record and robot."""
    folder = Path("runs/gallery") / "-".join(Path(argument).name for argument in arguments)
    command([*arguments, "--dt", "1e-3", "--no-plots", "--overwrite", "-q", "--out", str(folder)])
    record = iiwa_dnn.Record.load(folder / "record.npz")
    return [(record, iiwa_dnn.load_robot(record.settings["robot"]))]


def arm(records, index=-1):
    """Draw the arm near the end of a run."""
    record, robot = records[index]
    with ArmRenderer(robot, record, (540, 340)) as renderer:
        return Image.fromarray(renderer.draw(round(0.93 * record.steps)))


def figure(draw, records):
    """Draw a figure of the last record in the package's style."""

    def drawn():
        empty = plots.new_figure(plots.COLUMN, 2.4)
        draw(empty.add_subplot(), records[-1][0])
        return empty

    files = plots.write_figures({"figure": drawn}, "runs/gallery")
    return Image.open(io.BytesIO(files[0].read_bytes())).convert("RGB")


def turned(axes, record):
    """Draw the angle by which the tool and its target have turned."""
    for name, rotations, line in (
        ("target", record.rotation_desired, {"color": "0.72", "linewidth": 3.2}),
        ("tool", record.rotation, {"color": "0.0", "linestyle": "--"}),
    ):
        vectors = Rotation.from_matrix(rotations @ rotations[0].T).as_rotvec()
        axes.plot(record.t, np.degrees(vectors[:, 0]), label=name, **line)
    plots.label_time(axes, record, "Nodding about $x$ [deg]")
    plots.legend_above(axes, 2)


def elbow(axes, record):
    """Draw the elbow's distance from the point that it avoids."""
    robot = iiwa_dnn.load_robot("iiwa7")
    point = [0.36, 0.16, 0.64]
    places = [iiwa_dnn.Configuration(robot, q).frame("iiwa7_link_4").position for q in record.q]
    axes.plot(record.t, np.linalg.norm(np.subtract(places, point), axis=1), label="elbow")
    axes.axhline(0.2, color="0.5", linestyle="--", label="limit")
    plots.label_time(axes, record, "Distance from the point [m]")
    plots.legend_above(axes, 2)


def pivot(axes, record):
    """Draw the tool's axis at forty moments, seen from the side."""
    for k in np.linspace(0, record.steps, 40).astype(int):
        ends = record.position[k] + np.outer([0.0, 0.25], record.rotation[k, :, 2])
        axes.plot(ends[:, 1], ends[:, 2], color="0.6", linestyle="-", linewidth=0.5)
    point = record.position[0] + 0.15 * record.rotation[0, :, 2]
    axes.plot(*record.position[:, 1:].T, color="#d6001c", linestyle="-", label="tip")
    axes.plot(*point[1:], "ko", label="remote centre")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="$y$ [m]", ylabel="$z$ [m]")
    plots.legend_above(axes, 2)


def residual(axes, record):
    """Draw the KKT residual of the network's answers."""
    plots.draw_log(axes, record.t[:-1], record.kkt_residual[:, None], ["own network"], 1e-9)
    plots.label_time(axes, record, "KKT residual")


def scenes(csv):
    """List name, picture and records of each scene, the latter to be made."""
    error = partial(figure, plots.draw_error)
    push = ("--push", "20", "0", "0")
    return (
        ("heart", arm, lambda: run("track")),
        ("csv", arm, lambda: run("track", csv)),
        ("turning", partial(figure, turned), lambda: example("own_orientation.py")),
        ("obstacle", arm, lambda: example("avoid_obstacle.py")),
        ("clearance", partial(figure, elbow), lambda: example("own_parts.py")[:1]),
        ("two_arms", partial(arm, index=0), lambda: example("two_arms.py")),
        ("network", partial(figure, residual), lambda: example("own_network.py", "1000")),
        ("noise", error, lambda: run("track", "--noise", "0.01")),
        ("push", error, lambda: run("physics", *push)),
        ("remote_centre", partial(figure, pivot), lambda: example("remote_centre.py")),
        ("live_drag", lambda _: Image.open(PAGE).convert("RGB"), lambda: None),
    )


def main(folder: tyro.conf.Positional[str] = "docs/images/gallery"):
    """Draw every scene and the contact sheet."""
    out = prepare_folder(folder)
    csv = prepare_folder("runs/gallery") / "path.csv"
    csv.write_text(CSV)
    drawn = scenes(str(csv))
    rows = -(-len(drawn) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * TILE[0], rows * (TILE[1] + 22)), "white")
    for i, (name, draw, make) in enumerate(drawn):
        print(f"-- {name}", flush=True)
        picture = draw(make())
        if name != "live_drag":  # a picture of the browser, taken by hand
            small = picture.quantize(128, Image.Quantize.MAXCOVERAGE)
            small.save(out / f"{name}.png", optimize=True)
        picture.thumbnail(TILE, Image.Resampling.LANCZOS)
        x = i % COLUMNS * TILE[0]
        y = i // COLUMNS * (TILE[1] + 22)
        sheet.paste(picture, (x + (TILE[0] - picture.width) // 2, y + 20))
        ImageDraw.Draw(sheet).text((x + 8, y + 4), name.replace("_", " "), fill="black")
    sheet.save(out / "contact.png", optimize=True)


if __name__ == "__main__":
    sys.exit(run_script(main))
