"""The OpenGL library that draws without a display, and what is said where there is none."""

from __future__ import annotations

import sys

import pytest

from helpers_physics import heart_without_physics, needs_opengl, papers_robot, run_python
from iiwa_dnn import MissingDependencyError
from iiwa_dnn.robot import offscreen

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="a matter of Linux")


@linux
def test_a_library_that_is_not_there_is_named_with_a_remedy(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "glfw_of_nobody")
    with pytest.raises(MissingDependencyError, match="apt-get install libegl1") as caught:
        offscreen.prepare_renderer()
    assert "glfw_of_nobody" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_without_mujoco_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingDependencyError, match=r"pip install 'iiwa-dnn\[sim\]'") as caught:
        offscreen.import_mujoco()
    assert isinstance(caught.value, ImportError)


@needs_opengl
@linux
@pytest.mark.parametrize("wanted", ["", "egl"])
def test_without_a_display_it_draws(wanted, tmp_path):
    record = tmp_path / "record.npz"
    heart_without_physics(papers_robot(), 50).save(record)
    result = run_python(
        "import os; os.environ['MUJOCO_GL'] or os.environ.pop('MUJOCO_GL')\n"
        "from iiwa_dnn import Record, load_robot\n"
        "from iiwa_dnn.results.pictures import ArmRenderer\n"
        f"robot = load_robot('iiwa7'); record = Record.load({str(record)!r})\n"
        "with ArmRenderer(robot, record, (80, 60)) as renderer: image = renderer.draw(9)\n"
        "print('spread', image.std())",
        MUJOCO_GL=wanted,
        PYOPENGL_PLATFORM="",
        DISPLAY="",
    )
    assert result.returncode == 0, result.stderr
    assert float(result.stdout.split()[-1]) > 5.0
