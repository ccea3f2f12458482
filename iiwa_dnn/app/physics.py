"""``physics``: an arm with masses and motors draws a path, with disturbances, pictures, a video."""

from pathlib import Path

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
    """Return the disturbances that are asked for by name, over those that ``--disturb`` means."""
    base = Disturbances.typical() if options.disturb else Disturbances()
    names = ("mass_error", "friction", "encoder_noise", "encoder_bits", "delay")
    asked = {name: getattr(options, name) for name in names}
    chosen = {k: getattr(base, k) if value is None else value for k, value in asked.items()}
    push = None
    if options.push is not None:
        push = Push(options.push, options.push_at, options.push_for)  # type: ignore[arg-type]
    return Disturbances(**chosen, push=push)
