"""``track``, ``physics`` and ``export``: a run, or its controller, from words and tables."""

import sys
from dataclasses import asdict
from functools import partial
from inspect import signature
from pathlib import Path

import tomli_w
from tqdm import tqdm

from iiwa_dnn.app.command_line import SETTINGS_FILE, claim_folder
from iiwa_dnn.app.settings import Tables, build, read_tables
from iiwa_dnn.app.words import Export, Physics, Track
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export import c99
from iiwa_dnn.files import write_text
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.pictures import import_encoder, save_moments, save_video
from iiwa_dnn.results.report import save_run, summary
from iiwa_dnn.robot.offscreen import prepare_renderer
from iiwa_dnn.simulation import Disturbances, count_steps, simulate
from iiwa_dnn.studies.paper import published


def track(options: Track) -> int:
    """Draw the path, check every step, write the run, and return the exit code."""
    return _draw(options, {}, False)


def physics(options: Physics) -> int:
    """Draw the path in MuJoCo, with pictures and a video, and return the exit code."""
    typical = asdict(Disturbances.typical()) if options.disturb else {}
    disturbances = {name: value for name, value in typical.items() if value is not None}
    if options.push:
        disturbances["push"] = {"force": list(options.push)}
    more = {"plant": {"name": "mujoco", "disturbances": disturbances}}
    return _draw(options, more, options.plots)


def _draw(options: Track, more: Tables, pictured: bool) -> int:
    """Carry out a run, write it into its folder, print its summary, and return the exit code."""
    tables = read_tables(options, more)
    arguments = build(tables)
    robot = arguments["robot"]
    steps = count_steps(arguments["reference"], arguments["dt"], arguments.get("duration"))
    name = "physics" if more else Path(tables["reference"]["name"]).stem
    folder = Path("runs") / name if options.config is None else options.config.parent
    folder = claim_folder(options.out or folder, tables, options.overwrite)
    if pictured:  # before the run, what draws them is asked for
        prepare_renderer()
        import_encoder()
    # Hidden if standard error is no terminal.
    with tqdm(total=steps, unit="step", disable=True if options.quiet else None) as bar:
        record = simulate(**arguments, progress=bar.update, far_start=True)
    draw_more = partial(save_moments, robot) if pictured else None
    beside = published(record.settings)
    metrics = save_run(record, folder, plots=options.plots, more=draw_more, paper=beside)
    write_text(folder / SETTINGS_FILE, tomli_w.dumps(tables))
    if pictured:
        save_video(robot, record, folder / "video.mp4")
    reasons = failures(metrics)
    if not options.quiet:
        print(summary(metrics, reasons), f"written to {folder}", sep="\n")
    elif reasons:
        print(*reasons, sep="\n", file=sys.stderr)
    return 1 if reasons else 0


def export(options: Export) -> int:
    """Write the controller of a run as C, and return 0."""
    tables = read_tables(options, {})
    arguments = build(tables)
    for name in ("filter_window", "motion"):
        if name in tables["run"]:
            raise InvalidInputError(name, "is no part of a controller and is not exported")
    known = signature(Controller).parameters
    controller = Controller(**{key: arguments[key] for key in arguments if key in known})
    folder = claim_folder(options.out or Path("controller"), tables, options.overwrite)
    c99(controller, folder, arguments["q0"])
    write_text(folder / SETTINGS_FILE, tomli_w.dumps(tables))
    if controller.robot.name == "iiwa7" and "position" not in tables["limits"]:
        hint = "for a real arm take --joint-limit datasheet"
        print(
            f"position limits of 2.5 rad are the paper's, wider than joint 4's; {hint}",
            file=sys.stderr,
        )
    if not options.quiet:
        lines = (folder / "controller.c").read_text(encoding="utf-8").count("\n")
        print(f"written to {folder}: {lines} lines of C; to test them: make -C {folder}")
    return 0
