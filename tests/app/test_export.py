"""The command ``export``: from a run's settings to a folder of C."""

from helpers_commands import call, track
from helpers_export import compile_quickly, needs
from iiwa_dnn.export import load


@needs("gcc")
def test_the_settings_of_a_run_become_c(tmp_path, capsys, monkeypatch) -> None:
    compile_quickly(monkeypatch)
    track(tmp_path / "run", "circle", "--check", "none", "--motion", "rk4")
    capsys.readouterr()
    folder = tmp_path / "controller"
    file = tmp_path / "run" / "settings.toml"
    words = ("export", "--config", file, "--out", folder, "--speed", "0.5", "--dt", "2e-3")
    assert call(*words) == 0
    captured = capsys.readouterr()
    assert f"written to {folder}; to test it: " in captured.out
    assert captured.err == ""
    exported = load(folder)
    assert (exported.dof, exported.frames, exported.dt) == (7, 1, 2e-3)
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


def test_a_shield_of_the_settings_becomes_a_package(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    words = ("export", "--python", "my_shield", "--robot", "panda", "--dt", "2e-3")
    assert call(*words) == 0
    assert "pip install ./my_shield" in capsys.readouterr().out
    text = (tmp_path / "my_shield" / "my_shield" / "__init__.py").read_text(encoding="utf-8")
    assert 'ROBOT = "panda"' in text
    assert "DT = 0.002" in text
    assert call(*words, "--overwrite", "--acceleration-limit", "2", "--jerk-limit", "300") == 0
    package = (tmp_path / "my_shield" / "my_shield" / "__init__.py").read_text(encoding="utf-8")
    assert f"'acceleration': {[2.0] * 7}, 'jerk': {[300.0] * 7}" in package
    assert capsys.readouterr().err == ""
    assert call(*words, "--overwrite", "--acceleration-limit", "none") == 0
    assert "accelerations are not limited" in capsys.readouterr().err
    assert call(*words[:2], "my-shield", "--overwrite") == 2
    assert "name: must be" in capsys.readouterr().err
    assert call(*words[:2], "class", "--overwrite") == 2
    assert "no keyword of Python, as 'class' is" in capsys.readouterr().err
    assert not (tmp_path / "class").exists()
    assert call(*words, "--overwrite", "--platforms", "amiga") == 2
    assert "amiga" in capsys.readouterr().err


def test_a_controller_of_the_settings_becomes_a_package(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    words = ("export", "--python", "drawing", "--controller", "--reference", "circle")
    assert call(*words, "--dt", "2e-3", "--acceleration-limit", "none") == 0
    captured = capsys.readouterr()
    assert "pip install ./drawing" in captured.out
    assert "accelerations are not limited" in captured.err
    text = (tmp_path / "drawing" / "drawing" / "__init__.py").read_text(encoding="utf-8")
    assert "class Controller" in text
    assert "DT = 0.002" in text
