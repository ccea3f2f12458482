"""Which OpenGL library is taken, and what is said where there is none."""

from __future__ import annotations

import sys

import pytest

from helpers_physics import heart_without_physics, needs_opengl, papers_robot, run_python
from iiwa_dnn.errors import MissingDependencyError
from iiwa_dnn.robot import offscreen

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="a matter of Linux")


@linux
@pytest.mark.parametrize(
    ("egl", "osmesa", "wanted", "chosen"),
    [
        (True, True, "", "egl"),
        (True, False, "", "egl"),
        (False, True, "", "osmesa"),
        (True, True, "osmesa", "osmesa"),
        (True, True, "EGL", "egl"),
        (False, True, "glfw", "osmesa"),
        (False, False, "", None),
        (True, False, "osmesa", None),
    ],
)
def test_the_choice(monkeypatch, egl, osmesa, wanted, chosen):
    monkeypatch.delenv("PYOPENGL_PLATFORM", raising=False)
    monkeypatch.setenv("MUJOCO_GL", wanted)
    monkeypatch.setattr(offscreen, "opens", {"egl": egl, "osmesa": osmesa}.__getitem__)
    if chosen is not None:
        assert offscreen.opengl_library() == chosen
        return
    with pytest.raises(MissingDependencyError, match="apt-get install libosmesa6") as caught:
        offscreen.opengl_library()
    assert "libegl1" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_elsewhere_mujoco_chooses(monkeypatch):
    monkeypatch.setattr(sys, "platform", "darwin")
    assert offscreen.opengl_library() == "gl_context"


@linux
def test_a_library_that_is_not_there_does_not_open():
    assert not offscreen.opens("glfw_of_nobody")


def test_without_mujoco_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingDependencyError, match=r"pip install 'iiwa-dnn\[sim\]'") as caught:
        offscreen.import_mujoco()
    assert isinstance(caught.value, ImportError)


@needs_opengl
@linux
@pytest.mark.parametrize("library", ["egl", "osmesa"])
def test_each_library_that_is_there_draws(library, tmp_path):
    if not offscreen.opens(library):
        pytest.skip(f"no {library}: on Debian, apt-get install libosmesa6 libegl1 libgl1")
    record = tmp_path / "record.npz"
    heart_without_physics(papers_robot(), 50).save(record)
    result = run_python(
        "from iiwa_dnn import Record, load_robot\n"
        "from iiwa_dnn.results.pictures import ArmRenderer\n"
        f"robot = load_robot('iiwa7'); record = Record.load({str(record)!r})\n"
        "with ArmRenderer(robot, record, 80, 60) as renderer: image = renderer.draw(9)\n"
        "print('spread', image.std())",
        MUJOCO_GL=library,
        PYOPENGL_PLATFORM="",
        DISPLAY="",
    )
    assert result.returncode == 0, result.stderr
    assert float(result.stdout.split()[-1]) > 5.0


@linux
def test_an_opengl_library_that_is_asked_for_and_not_there(monkeypatch):
    def broken(name):
        raise AttributeError("'NoneType' object has no attribute 'glGetError'")

    monkeypatch.setattr(offscreen.importlib, "import_module", broken)
    monkeypatch.setenv("MUJOCO_GL", "egl")
    with pytest.raises(MissingDependencyError, match="MUJOCO_GL=egl asks for"):
        offscreen.import_mujoco()
    monkeypatch.delenv("MUJOCO_GL")
    with pytest.raises(AttributeError):
        offscreen.import_mujoco()
