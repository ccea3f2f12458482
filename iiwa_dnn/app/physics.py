"""``physics``: an arm with masses and motors draws a path, with disturbances, pictures, a video."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from iiwa_dnn.app.command_line import progress_bar
from iiwa_dnn.app.options import PhysicsOptions
from iiwa_dnn.app.track import arm, draw, simulation
from iiwa_dnn.results.pictures import frame_times, import_encoder, save_moments, save_video
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.offscreen import opengl_library
from iiwa_dnn.simulation import Disturbances, MujocoPlant, Push


def run(options: PhysicsOptions) -> int:
    """Draw the path in MuJoCo, write the run with its pictures, and return the exit code."""
    robot, q0 = arm(options)
    plant = MujocoPlant(disturbances(options), timestep=options.physics_dt)
    checked = simulation(options, robot, q0, plant)
    if options.pictures or options.video:
        opengl_library()
    if options.video:
        import_encoder()

    def pictures(record: Record, folder: Path) -> list[Path]:
        return save_moments(robot, record, folder) if options.pictures else []

    def video(record: Record, folder: Path) -> None:
        if options.video:
            with progress_bar(len(frame_times(record)), "frame", options.quiet) as bar:
                save_video(robot, record, folder / "video.mp4", bar.update)

    return draw(options, checked, pictures, video)


def disturbances(options: PhysicsOptions) -> Disturbances:
    """Return the disturbances by their options, over those of ``--disturb``."""
    base = Disturbances.typical() if options.disturb else Disturbances()
    names = ("mass_error", "friction", "encoder_noise", "encoder_bits", "delay")
    values: dict[str, Any] = {name: getattr(options, name) for name in names}
    if options.push:
        values["push"] = Push(options.push, options.push_at, options.push_for)  # type: ignore[arg-type]
    return replace(base, **{name: value for name, value in values.items() if value is not None})
