"""``collisions``: the capsules and pairs of a robot's links, beside its URDF."""

from dataclasses import replace
from typing import Annotated

from tyro.conf import Positional

from iiwa_dnn import FileError, load_robot
from iiwa_dnn.app.command_line import shown
from iiwa_dnn.naming import unguarded
from iiwa_dnn.robot.collision import collision_file, digest_of, make_collision_model


def collisions(
    robot: Annotated[Positional[str], shown("FILE")],
    *,
    tip: Annotated[str | None, shown("FRAME")] = None,
    lock: Annotated[tuple[str, ...], shown("JOINT ...")] = (),
    srdf: Annotated[str | None, shown("FILE")] = None,
) -> int:
    """Write the bodies and pairs of a robot's links beside its URDF, for all later runs.

    Args:
        robot: URDF file
        tip: frame that follows paths
        lock: joints to lock; after FILE
        srdf: SRDF file whose disabled pairs are left out; default: the one beside the URDF
    """
    loaded = load_robot(robot, tip, lock)
    file = collision_file(loaded)
    if file.exists():
        raise FileError(file, "exists already; it is made anew where it is removed")
    model = replace(make_collision_model(loaded, srdf=srdf), source=digest_of(loaded))
    model.save(file)
    pairs = len(model.pairs(loaded))
    print(f"written to {file}: {len(model.bodies)} bodies, {pairs} pairs that may meet")
    if model.unguarded:
        print(f"Beware: {unguarded(map(' and '.join, model.unguarded))}.")
    return 0
