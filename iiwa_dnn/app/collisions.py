"""``collisions``: the capsules and pairs of a robot's links, beside its URDF."""

from typing import Annotated

from tyro.conf import Positional

from iiwa_dnn import FileError, load_robot
from iiwa_dnn.app.command_line import shown
from iiwa_dnn.robot.collision import collision_file, make_collision_model


def collisions(
    robot: Annotated[Positional[str], shown("FILE")],
    *,
    tip: Annotated[str | None, shown("FRAME")] = None,
    lock: Annotated[tuple[str, ...], shown("JOINT ...")] = (),
) -> int:
    """Write the capsules and pairs of a robot's links beside its URDF, for all later runs.

    Args:
        robot: URDF file
        tip: frame that follows paths
        lock: joints to lock; after FILE
    """
    loaded = load_robot(robot, tip, lock)
    file = collision_file(loaded)
    if file.exists():
        raise FileError(file, "exists already; it is made anew where it is removed")
    model = make_collision_model(loaded)
    model.save(file)
    pairs = len(model.pairs(loaded))
    print(f"written to {file}: {len(model.capsules)} capsules, {pairs} pairs that may meet")
    return 0
