"""The script that draws in physics: what it writes, what it refuses, how it exits."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest

from helpers_physics import needs_opengl
from helpers_records import draw_only
from iiwa_dnn import Record
from iiwa_dnn.app.main import main
from iiwa_dnn.results import pictures

QUICK = ("--duration", "0.05", "--quiet", "--no-plots")
DRY = (*QUICK, "--no-pictures", "--no-video")

needs_mujoco = pytest.mark.usefixtures("mujoco")


@pytest.fixture
def mujoco():
    return pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")


def run(capsys, *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output and standard error."""
    try:
        code = main(["physics", *arguments])
    except SystemExit as end:
        code = int(end.code or 0)
    out, err = capsys.readouterr()
    return code, out, err


@needs_mujoco
@needs_opengl
def test_everything_is_written(capsys, tmp_path, monkeypatch):
    # What the pictures show is a matter of tests/results/test_pictures.py.
    draw_only(monkeypatch, "torques")
    monkeypatch.setattr(pictures, "MOMENTS", 2)
    monkeypatch.setattr(pictures, "FRAME_RATE", 10)
    for name, pixels in {"WIDTH": 480, "HEIGHT": 270, "SIDE": 210}.items():
        monkeypatch.setattr(pictures, name, pixels)
    arguments = ("--duration", "0.2", "--out", str(tmp_path), "--disturb", "--push", "0", "10", "0")
    code, out, err = run(capsys, *arguments, "--push-at", "0.1", "--push-for", "0.05")
    assert (code, err) == (0, "")
    for name in (
        "record.npz",
        "metrics.json",
        "report.md",
        "moments.png",
        "moments.pdf",
        "torques.png",
        "torques.pdf",
        "video.mp4",
    ):
        assert (tmp_path / name).stat().st_size > 1000, name
    assert "proxqp: 200 own programs checked, 0 disagreements, 0 failures" in out
    assert "largest torque, of its limit" in out
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    assert metrics["physics"]["push"]["force"] == [0.0, 10.0, 0.0]
    assert metrics["physics"]["max_torque_share"] < 0.5
    assert metrics["settings"]["physics"]["disturbances"]["encoder_bits"] == 18
    report = (tmp_path / "report.md").read_text()
    assert "(moments.png)" in report
    assert "(torques.png)" in report
    record = Record.load(tmp_path / "record.npz")
    assert record.torque is not None
    assert record.torque.shape == (200, 7)


@needs_mujoco
def test_disturbances_one_by_one(capsys, tmp_path):
    arguments = (*DRY, "--check", "none", "--out", str(tmp_path), "--seed", "3")
    chosen = ("--friction", "0.02", "--delay", "0", "--disturb")
    assert run(capsys, *arguments, *chosen)[0] == 0
    settings = Record.load(tmp_path / "record.npz").settings["physics"]["disturbances"]
    assert settings == {
        "mass_error": 0.1,
        "friction": 0.02,
        "encoder_noise": 1e-5,
        "encoder_bits": 18,
        "delay": 0,
        "push": None,
    }
    assert run(capsys, *arguments)[0] == 2  # another run lies there
    assert run(capsys, *arguments, "--overwrite")[0] == 0
    settings = Record.load(tmp_path / "record.npz").settings["physics"]["disturbances"]
    assert not any(settings.values())
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "metrics.json",
        "record.npz",
        "report.md",
        "settings.toml",
    ]


@needs_mujoco
def test_the_options_of_track_hold_in_physics_too(capsys, tmp_path):
    chosen = ("--lock", "iiwa7_joint_3", "--noise", "1e-3", "--filter-window", "2")
    path = ("--reference", "circle", "--radius", "0.01", "--policy", "relax", "--gain", "5")
    assert run(capsys, *DRY, *chosen, *path, "--check", "none", "--out", str(tmp_path))[0] == 0
    record = Record.load(tmp_path / "record.npz")
    assert record.dof == 6
    expected = {"noise": 1e-3, "filter_window": 2, "policy": "relax", "motion": "physics"}
    assert expected.items() <= record.settings.items()
    assert record.settings["reference"]["name"] == "circle"
    assert record.settings["scheme"]["position_gain"] == 5.0
    code, _, err = run(capsys, *DRY, "--motion", "rk4", "--out", str(tmp_path / "rk4"))
    assert code == 2
    assert err.startswith("iiwa-dnn physics: error: motion: must be euler")
    assert not (tmp_path / "rk4").exists()


@needs_mujoco
def test_the_check_can_fail(capsys, tmp_path):
    code, _, err = run(capsys, *DRY, "--tolerance", "1e-18", "--out", str(tmp_path))
    assert code == 1
    assert "proxqp differs by" in err


@needs_mujoco
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--physics-dt", "3e-4"), "must divide"),
        (("--encoder-bits", "99"), "encoder_bits"),
        (("--push", "nan", "0", "0"), "push"),
        (("--push", "1", "0", "0", "--push-for", "-1"), "push_for"),
        (("--push-at", "1"), "--push-at: has no effect but beside --push"),
        (("--nonsense",), "--nonsense"),
        (("--out", "/proc/nothing"), "/proc/nothing"),
    ],
)
def test_bad_input_is_one_line_and_2(capsys, tmp_path, arguments, words):
    out = () if "--out" in arguments else ("--out", str(tmp_path / "run"))
    code, out_text, err = run(capsys, *DRY, *out, *arguments)
    assert code == 2
    assert out_text == ""
    assert words in err
    assert err.count("\n") == 1
    assert "Traceback" not in err
    assert not (tmp_path / "run" / "record.npz").exists()


@needs_mujoco
def test_without_opengl_one_line_names_the_package_before_the_run(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("MUJOCO_GL", "of_nobody")
    code, _, err = run(capsys, *QUICK, "--out", str(tmp_path / "run"))
    assert code == 2
    assert "apt-get install libegl1" in err
    assert err.count("\n") == 1
    assert not (tmp_path / "run").exists()
    assert run(capsys, *DRY, "--out", str(tmp_path / "run"))[0] == 0  # physics needs none


@needs_opengl
@pytest.mark.parametrize(
    ("missing", "arguments"), [("mujoco", DRY), ("imageio_ffmpeg", (*QUICK, "--no-pictures"))]
)
def test_without_the_extra_one_line_says_what_to_install(
    capsys, tmp_path, monkeypatch, missing, arguments
):
    if missing == "imageio_ffmpeg":
        pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")
    monkeypatch.setitem(sys.modules, missing, None)
    code, _, err = run(capsys, *arguments, "--out", str(tmp_path))
    assert code == 2
    assert "pip install 'iiwa-dnn[sim]'" in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@needs_mujoco
def test_another_robot(capsys, tmp_path):
    """A made-up arm with other joints: nothing is taken from the iiwa."""
    links = "".join(
        f'<link name="l{i}"><inertial><origin xyz="0 0 0.1"/><mass value="1"/>'
        '<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        for i in range(8)
    )
    axes = ("0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1")
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="0 0 0.2"/><axis xyz="{axis}"/>'
        '<limit lower="-3" upper="3" velocity="3" effort="90"/></joint>'
        for i, axis in enumerate(axes)
    )
    path = tmp_path / "arm.urdf"
    path.write_text(f'<robot name="arm">{links}{joints}</robot>')
    q0 = ("--q0", "0.2", "0.6", "0.1", "0.9", "-0.1", "0.8", "0")
    arguments = ("--robot", str(path), *q0, "--out", str(tmp_path / "run"))
    assert run(capsys, *DRY, *arguments, "--check", "none")[0] == 0
    record = Record.load(tmp_path / "run" / "record.npz")
    np.testing.assert_array_equal(record.settings["torque_max"], np.full(7, 90.0))
