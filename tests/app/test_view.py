"""The script that opens the page: what it takes, what it refuses, how it ends."""

from __future__ import annotations

import re
import sys
import urllib.request
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from helpers_physics import heart_without_physics, papers_robot
from helpers_records import make_record
from iiwa_dnn import Configuration, DoubleIndicator, PseudoInverse, load_robot
from iiwa_dnn.app.command_line import run_command
from iiwa_dnn.app.options import ViewOptions
from iiwa_dnn.app.view import kept_settings, limits_of, robot_of, run, scheme_of
from iiwa_dnn.results.record import Record

needs_viser = pytest.mark.usefixtures("viser")


@pytest.fixture
def viser():
    return pytest.importorskip("viser", reason="pip install 'iiwa-dnn[view]'")


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    heart_without_physics(papers_robot(), 500).save(folder / "record.npz")
    return folder


def opened(capsys, *arguments: str) -> tuple[int, str, str]:
    """Open a page, ask for it once, and end; exit code, standard output and error."""
    asked: list[str] = []

    def stop() -> bool:
        if not asked:
            asked.append(capsys.readouterr().out)
            address = re.search(r"http://\S+", asked[0])
            assert address is not None
            with urllib.request.urlopen(address[0], timeout=10) as answer:
                assert b"<html" in answer.read()
        return len(asked) > 1 or bool(asked.append(""))

    try:
        code = run_command(
            ViewOptions, "view", lambda options: run(options, stop), (*arguments, "--port", "0")
        )
    except SystemExit as end:
        code = int(end.code or 0)
    out, err = capsys.readouterr()
    return code, (asked[0] if asked else "") + out, err


@needs_viser
def test_a_runs_folder_its_record_and_no_run_at_all(capsys, run_folder):
    for arguments in ((str(run_folder),), (str(run_folder / "record.npz"),), ()):
        code, out, err = opened(capsys, *arguments)
        assert (code, err) == (0, "")
        assert re.fullmatch(r"open http://127\.0\.0\.1:\d+ in a browser; Ctrl-C ends it\n", out)


@needs_viser
def test_a_robot_from_a_file_is_found_by_the_runs_settings(capsys, tmp_path, run_folder):
    record = Record.load(run_folder / "record.npz")
    replace(record, settings={**record.settings, "robot": "my_arm"}).save(tmp_path / "record.npz")
    code, _, err = opened(capsys, str(tmp_path))
    assert code == 2
    assert err.endswith("'my_arm' came from a file: add --robot FILE.urdf\n")
    urdf = Path(load_robot("iiwa7").path).resolve()
    (tmp_path / "settings.toml").write_text(f'robot = "{urdf}"\n')
    record = Record.load(tmp_path / "record.npz")
    for path in (tmp_path, tmp_path / "record.npz"):
        assert robot_of(record, kept_settings(path)) == str(urdf)
    code, _, err = opened(capsys, str(tmp_path))
    assert (code, err) == (0, "")


@needs_viser
def test_locked_joints_are_the_runs(capsys, tmp_path):
    make_record(dof=6, position_desired=np.ones((11, 3))).save(tmp_path / "record.npz")
    (tmp_path / "settings.toml").write_text('lock = ["iiwa7_joint_3"]\n')
    assert opened(capsys, str(tmp_path))[0] == 0


@needs_viser
def test_ctrl_c_ends_it(capsys, run_folder):
    def interrupt() -> bool:
        raise KeyboardInterrupt

    assert run(ViewOptions(run_folder, port=0), interrupt) == 0


@needs_viser
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nowhere",), "nowhere"),
        (("--robot", "iiwa8"), "iiwa7"),
        (("--tip", "nose"), "nose"),
        (("--host", "no such host"), "cannot listen"),
        (("--nonsense",), "--help"),
    ],
)
def test_bad_input_is_one_line_and_2(capsys, arguments, words):
    code, out, err = opened(capsys, *arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert err.count("\n") == 1


@needs_viser
def test_a_folder_without_a_run_and_a_robot_that_does_not_fit(capsys, tmp_path, run_folder):
    code, _, err = opened(capsys, str(tmp_path))
    assert code == 2
    assert "not the folder of a run" in err
    code, _, err = opened(capsys, str(run_folder), "--lock", "iiwa7_joint_3")
    assert code == 2
    assert "6 free joints, the record 7" in err


def test_without_the_extra_one_line_says_what_to_install(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    code, _, err = opened(capsys)
    assert code == 2
    assert "pip install 'iiwa-dnn[view]'" in err
    assert err.count("\n") == 1


def test_scheme_and_limits_are_the_records():
    robot = load_robot("iiwa7")
    scheme = DoubleIndicator(weight=0.7, orientation="block", limit_gain=5.0)
    anchored = scheme.anchored(Configuration(robot, np.zeros(7)))
    record = make_record(
        settings={
            "scheme": anchored.settings(),
            "q_lower": [None] * 7,
            "q_upper": [1.0] * 7,
            "dq_max": [None, *[2.0] * 6],
        }
    )
    assert scheme_of(record) == scheme
    limited = limits_of(record, robot)
    assert np.isneginf(limited.q_lower).all()
    np.testing.assert_array_equal(limited.q_upper, np.ones(7))
    np.testing.assert_array_equal(limited.dq_max, [np.inf, *[2.0] * 6])
    other = make_record(settings={"scheme": PseudoInverse().settings()})
    assert scheme_of(other) == DoubleIndicator()
