"""The command ``export``: from a run's settings to a folder of C."""

from helpers_commands import call, track
from helpers_export import needs, run, use_armstep


@needs("gcc")
def test_the_settings_of_a_run_become_c(tmp_path, capsys) -> None:
    track(tmp_path / "run", "circle", "--check", "none", "--motion", "rk4")
    capsys.readouterr()
    folder = tmp_path / "controller"
    file = tmp_path / "run" / "settings.toml"
    words = ("export", "--config", file, "--out", folder, "--speed", "0.5", "--dt", "2e-3")
    assert call(*words) == 0
    captured = capsys.readouterr()
    assert f"written to {folder}; to test it: " in captured.out
    assert captured.err == ""
    assert ".dt = 0.002,\n" in (folder / "iiwa7.c").read_text(encoding="utf-8")
    assert "0 commands differ" in run("make", "-C", folder, "CFLAGS=-O0")
    assert "circle" in (folder / "README.md").read_text(encoding="utf-8")
    assert call(*words, "--set", "run.filter_window=5") == 2
    assert "is no part of a controller" in capsys.readouterr().err
    # A folder that holds another controller is not overwritten unasked.
    assert call(*words, "--weight", "0.5") == 2
    assert "--overwrite" in capsys.readouterr().err
    words += ("--weight", "0.5", "--overwrite", "--joint-limit", "datasheet", "-q")
    assert call(*words) == 0
    assert capsys.readouterr() == ("", "")
    assert call(*words, "--joint-limit", "2.5") == 0
    assert "--joint-limit datasheet" in capsys.readouterr().err
    assert call(*words, "--acceleration-limit", "none") == 0
    assert "--acceleration-limit robot" in capsys.readouterr().err


@needs("gcc")
def test_a_shield_of_the_settings_becomes_tables(tmp_path, capsys) -> None:
    path = tmp_path / "my_shield.json"
    words = ("export", "--tables", path, "--robot", "panda", "--dt", "2e-3")
    assert call(*words) == 0
    captured = capsys.readouterr()
    assert f"written to {path}; to test it: python -m armstep check {path}\n" == captured.out
    armstep = use_armstep()
    shield = armstep.Shield(path)
    assert shield.tables.joint_names[0] == "panda_joint1"
    assert (shield.dt, shield.tables.frame_names) == (2e-3, ("panda_hand_tcp",))
    assert call(*words, "--acceleration-limit", "2", "--jerk-limit", "300") == 0
    limits = armstep.load_tables(path).limits
    assert {*limits["acceleration"], *limits["jerk"]} == {2.0, 300.0}
    assert capsys.readouterr().err == ""
    assert call(*words, "--acceleration-limit", "none", "-q") == 0
    captured = capsys.readouterr()
    assert "accelerations are not limited" in captured.err
    assert captured.out == ""


@needs("gcc")
def test_a_controller_of_the_settings_becomes_tables(tmp_path, capsys) -> None:
    path = tmp_path / "drawing.json"
    words = ("export", "--tables", path, "--controller", "--reference", "circle")
    assert call(*words, "--dt", "2e-3", "--acceleration-limit", "none") == 0
    assert "accelerations are not limited" in capsys.readouterr().err
    controller = use_armstep().Controller(path)
    assert controller.dt == 2e-3
    assert controller.tables.has_reference
