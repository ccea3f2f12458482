"""``collisions``: the file that later runs read."""

from dataclasses import replace
from pathlib import Path

import pytest

import iiwa_dnn
from helpers_commands import call
from iiwa_dnn.robot.collision import collision_file, collision_model, make_collision_model


def test_pairs_are_written_once_and_read_by_every_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(iiwa_dnn.load_robot("fr3").urdf)
    assert call("collisions", str(file), "--lock", "joint2") == 0
    robot = iiwa_dnn.load_robot(file, locked="joint2")
    made = make_collision_model(robot)
    written = tmp_path / "arm.collisions.toml"
    assert collision_file(robot) == written
    count = len(made.pairs(robot))
    said = f"written to {written}: {len(made.bodies)} bodies, {count} pairs that may meet\n"
    assert capsys.readouterr().out == said
    assert replace(collision_model(robot), source="") == made
    before = written.read_bytes()
    assert call("collisions", str(file)) == 2
    assert "arm.collisions.toml: exists already" in capsys.readouterr().err
    assert written.read_bytes() == before
    file.write_text(file.read_text().replace('radius="0.06"', 'radius="0.09"', 1))
    other = iiwa_dnn.load_robot(file, locked="joint2")
    with pytest.warns(UserWarning, match=r"collisions\.toml was made of another .*arm\.urdf"):
        collision_model(other)
