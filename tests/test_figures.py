"""The figures of the pages: each is drawn by docs/figures.py, and each of its functions draws."""

import importlib.util
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

import iiwa_dnn
from helpers_physics import needs_opengl

DOCS = Path(__file__).parents[1] / "docs"

NEEDS = {"shield": ("ruckig", "pylibfranka"), "push": ("mujoco",), "solvers": ("daqp",)}

_spec = importlib.util.spec_from_file_location("figures", DOCS / "figures.py")
assert _spec is not None
assert _spec.loader is not None
figures = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(figures)


def test_every_image_of_the_pages_has_its_script() -> None:
    made = {f"{name}.svg" for name in figures.FIGURES} | {
        f"{name}.webp" for name in figures.MOTIONS
    }
    made |= {f"{name}.png" for name in figures.SCREENS}
    assert {path.name for path in figures.IMAGES.iterdir()} == made
    pages = [DOCS.parent / "README.md", *DOCS.glob("*.md")]
    shown = {
        Path(image).name
        for page in pages
        for image in re.findall(r"images/([\w/.]+)", page.read_text(encoding="utf-8"))
    }
    assert shown == made


@pytest.mark.parametrize("name", figures.FIGURES)
def test_a_figure_is_drawn_in_the_readers_colors(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in NEEDS.get(name, ()):
        pytest.importorskip(module)
    monkeypatch.setattr(figures, "PAPER_DT", 2e-3)
    monkeypatch.setattr(figures, "WORKS", (1e4,))
    monkeypatch.setattr(figures, "FRACTIONS", (0.4,))
    monkeypatch.setattr(figures, "SIZES", (7, 14))
    monkeypatch.setattr(figures, "GAINS", (10.0, 100.0))
    monkeypatch.setattr(figures, "ARMS", (1, 16))
    monkeypatch.setattr(figures, "ROUNDS", 2)
    text = figures.save(name, tmp_path).read_text(encoding="utf-8")
    ElementTree.fromstring(text)
    assert "currentColor" in text
    assert "prefers-color-scheme:dark" in text
    assert not re.search(r"fill: #(000000|ffffff)|stroke: #(000000|ffffff)", text), "not for both"
    kept = (figures.IMAGES / f"{name}.svg").read_text(encoding="utf-8")
    size = re.compile(r'<svg [^>]*viewBox="([^"]*)"')
    assert size.search(text)[1] == size.search(kept)[1]  # type: ignore[index]


@needs_opengl
@pytest.mark.parametrize("name", figures.MOTIONS)
def test_a_motion_shows_a_robot(name: str, tmp_path: Path) -> None:
    if name == "robots" and not set(figures.ROBOTS) <= set(iiwa_dnn.available_robots()):
        pytest.skip("pip install 'iiwa-dnn[robots]'")
    path = figures.save_motion(name, tmp_path, most=8)
    with Image.open(path) as film:
        assert film.n_frames > 1 or name == "robots"
        picture = np.asarray(film.convert("RGB")).astype(int)
    orange = (picture[..., 0] > picture[..., 1] + 60) & (picture[..., 1] > picture[..., 2] + 40)
    assert orange.sum() > 200
    with Image.open(figures.IMAGES / path.name) as kept:
        assert kept.size == picture.shape[1::-1]
        assert kept.n_frames > 30 or name == "robots"


@pytest.mark.parametrize("name", figures.SCREENS)
def test_a_page_is_served_whose_picture_is_taken(name: str) -> None:
    """The photograph takes a minute without a graphics card; tests/app opens such a page."""
    pytest.importorskip("viser")
    page = figures.SCREENS[name]()
    assert page.server.get_port() > 0
    page.server.stop()
    with Image.open(figures.IMAGES / f"{name}.png") as kept:
        picture = np.asarray(kept.convert("RGB")).astype(int)
    assert picture.shape == (720, 1280, 3)
    orange = (picture[..., 0] > picture[..., 1] + 60) & (picture[..., 1] > picture[..., 2] + 40)
    assert orange.sum() > 1000, "the arm"
