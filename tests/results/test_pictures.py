"""Pictures and video of a run, judged by their pixels."""

from functools import partial

import numpy as np
import pytest
from PIL import Image

from helpers_physics import heart_without_physics, needs_opengl
from helpers_simulation import paper_robot
from iiwa_dnn import FileError

pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")
pytestmark = needs_opengl

from iiwa_dnn.results import pictures  # noqa: E402 - only where there is something to draw with


@pytest.fixture(scope="module")
def robot():
    return paper_robot()


@pytest.fixture(scope="module")
def record():
    return heart_without_physics()


def red(image: np.ndarray) -> np.ndarray:
    """Pixels of the drawn line; unlike the arm's orange it has no more green than blue."""
    image = image.astype(int)
    return (image[..., 0] > image[..., 2] + 80) & (image[..., 1] <= image[..., 2])


def orange(image: np.ndarray) -> np.ndarray:
    image = image.astype(int)
    return (image[..., 0] > image[..., 1] + 60) & (image[..., 1] > image[..., 2] + 40)


def test_the_figure_of_five_moments(robot, record, tmp_path, monkeypatch):
    # As many pixels as the file has: more would be thrown away.
    small = partial(pictures.moments_figure, pixels=280)
    monkeypatch.setattr(pictures, "moments_figure", small)
    monkeypatch.setattr(pictures, "save_video", lambda *_: None)
    written = pictures.save_pictures(robot, record, tmp_path)
    assert [path.name for path in written] == ["moments.png", "moments.pdf"]
    image = np.asarray(Image.open(tmp_path / "moments.png").convert("RGB"))
    width = image.shape[1]
    counts = []
    for part in range(5):
        column = image[:, width * part // 5 : width * (part + 1) // 5]
        assert orange(column).sum() > 300  # the arm
        counts.append(red(column).sum())  # the heart so far
    assert counts[0] < counts[1] < counts[4], counts
    assert (tmp_path / "moments.pdf").read_bytes().startswith(b"%PDF")


def decoded(path) -> tuple[dict[str, str], list[np.ndarray]]:
    """A video's own facts, and its pictures, as ffmpeg reads them."""
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="pip install 'iiwa-dnn[sim]'")
    reader = imageio_ffmpeg.read_frames(str(path))
    facts = next(reader)
    width, height = facts["size"]
    return facts, [np.frombuffer(raw, np.uint8).reshape(height, width, 3) for raw in reader]


# imageio-ffmpeg leaves the pipes of its reader to the garbage collector.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_the_video(robot, record, tmp_path, monkeypatch):
    monkeypatch.setattr(pictures, "FRAME_RATE", 2)  # fewer pictures to draw
    monkeypatch.setattr(pictures, "SIZE", (480, 272))
    path = tmp_path / "video.mp4"
    pictures.save_video(robot, record, path)
    facts, images = decoded(path)
    assert facts["codec"] == "h264"
    assert facts["fps"] == pictures.FRAME_RATE
    assert facts["duration"] == pytest.approx(10.0, abs=0.6)
    assert len(images) == 21
    counts = [red(image).sum() for image in images]
    assert all(image.std() > 20.0 and orange(image).sum() > 300 for image in images)
    assert counts[0] < counts[-1]
    # The arm moves.
    assert (np.abs(images[4].astype(int) - images[12]).max(axis=-1) > 30).sum() > 500
    assert list(tmp_path.iterdir()) == [path]  # no temporary file is left
    assert b"moov" in path.read_bytes()[:2000]  # the index at the front


def test_a_video_that_cannot_be_written_or_is_interrupted_leaves_the_old_one(
    robot, record, tmp_path, monkeypatch
):
    with pytest.raises(FileError, match="cannot be written"):
        pictures.save_video(robot, record, tmp_path / "missing" / "video.mp4")
    path = tmp_path / "video.mp4"
    path.write_bytes(b"old")

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(pictures, "_add_line", interrupt)
    with pytest.raises(KeyboardInterrupt):
        pictures.save_video(robot, record, path)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
