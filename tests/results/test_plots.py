"""The figures: all there, not blank, the same bytes each time, and fit for print."""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
import zlib
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import image

from helpers_records import draw_only, heart_record, make_record
from iiwa_dnn.errors import FileError
from iiwa_dnn.results.envelope import envelope, stretches
from iiwa_dnn.results.plots import (
    FIGURES,
    convergence_figure,
    overview_figure,
    path_figure,
    path_time_figure,
    save_figures,
)

NAMES = ["overview", "path", "joint_angles", "joint_velocities", "position_error", "convergence"]


@pytest.fixture(scope="module")
def heart():
    return heart_record(steps=20_000, noise=0.01, solvers=("proxqp", "osqp"))


@pytest.fixture(scope="module")
def drawn(heart, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    return folder, save_figures(heart, folder)


def test_every_figure_is_there_twice_and_nothing_else(drawn):
    folder, written = drawn
    assert written == [folder / f"{name}.{kind}" for name in NAMES for kind in ("png", "pdf")]
    assert sorted(written) == sorted(folder.iterdir())


@pytest.mark.parametrize("name", NAMES)
def test_png_is_not_blank_and_of_its_printed_size(drawn, name):
    pixels = image.imread(drawn[0] / f"{name}.png")[..., :3]
    assert pixels.shape[1] == (1400 if name == "overview" else 700)
    ink = (pixels < 0.95).any(axis=2).mean()
    assert 0.02 < ink < 0.6
    colours = (255 * pixels[::4]).astype(int) @ [65536, 256, 1]
    assert len(np.unique(colours)) > 50
    # Neither does ink touch the edge, where it would be cut off.
    edge = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
    assert (edge == 1.0).all()


@pytest.mark.parametrize("name", NAMES)
def test_pdf_is_small_and_embeds_truetype(drawn, name):
    content = (drawn[0] / f"{name}.pdf").read_bytes()
    assert content.startswith(b"%PDF")
    assert len(content) < 600_000
    assert b"CreationDate" not in content
    assert b"/Type3" not in content
    assert b"/FontFile2" in content


def test_same_bytes_elsewhere_whatever_the_users_style_and_without_pyplot(heart, drawn, tmp_path):
    heart.save(tmp_path / "record.npz")
    (tmp_path / "matplotlibrc").write_text("font.size: 30\nfigure.dpi: 37\naxes.facecolor: red\n")
    code = (
        "import sys, iiwa_dnn.results.plots as plots, iiwa_dnn.results.report\n"
        "assert 'matplotlib' not in sys.modules\n"
        "names = ('joint_velocities', 'convergence')  # bands, markers, maths; log scales\n"
        "plots.FIGURES = {name: plots.FIGURES[name] for name in names}\n"
        "record = iiwa_dnn.results.record.Record.load('record.npz')\n"
        "plots.save_figures(record, 'out')\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
        "assert sys.modules['matplotlib'].rcParams['font.size'] == 30\n"
    )
    # The current folder is where Matplotlib looks for a matplotlibrc first.
    paths = os.pathsep.join([str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    environment = os.environ | {"PYTHONPATH": paths, "PYTHONHASHSEED": "7"}
    for name in ("MPLBACKEND", "DISPLAY"):  # a person's shell may have neither
        environment.pop(name, None)
    command = [sys.executable, "-c", code]
    subprocess.run(command, check=True, cwd=tmp_path, env=environment)
    written = list((tmp_path / "out").iterdir())
    assert len(written) == 4
    for path in written:
        assert path.read_bytes() == (drawn[0] / path.name).read_bytes(), path.name


def test_the_callers_settings_are_left_alone(monkeypatch, tmp_path):
    monkeypatch.setattr("iiwa_dnn.results.plots.FIGURES", {"path": path_figure})
    with mpl.rc_context({"font.size": 30}):
        before = dict(mpl.rcParams)
        save_figures(make_record(), tmp_path)
        assert dict(mpl.rcParams) == before


def test_axes_say_quantity_and_unit(heart):
    labels = [axes.get_ylabel() for axes in overview_figure(heart).axes]
    assert labels == [
        "$y$ [m]",
        "Joint angle [rad]",
        "Joint velocity [rad/s]",
        "Position error [nm]",
    ]
    bottom = [axes.get_xlabel() for axes in overview_figure(heart).axes]
    assert bottom == ["$x$ [m]\n(a)", *(f"Time [s]\n({letter})" for letter in "bcd")]


def test_curves_are_told_apart_without_colour(heart):
    (axes,) = FIGURES["joint_angles"](heart).axes
    joints = [line for line in axes.lines if line.get_label().startswith("$q")]
    assert len(joints) == 7
    luminance = [np.dot(line.get_color()[:3], [0.2126, 0.7152, 0.0722]) for line in joints]
    assert (np.diff(luminance) > 0.03).all()
    assert len({(line.get_linestyle(), line.get_marker()) for line in joints}) == 7


def test_a_spike_of_one_sample_is_drawn(heart):
    position = np.array(heart.position)
    position[12_345, 0] += 2e-3
    (axes,) = FIGURES["position_error"](dataclasses.replace(heart, position=position)).axes
    assert axes.get_ylabel() == "Position error [mm]"
    assert axes.dataLim.y1 == pytest.approx(2.0, rel=1e-3)


def test_limits_are_drawn_where_they_are_near(heart):
    def limits(record):
        lines = FIGURES["joint_angles"](record).axes[0].lines
        return [line.get_ydata()[0] for line in lines if len(line.get_xdata()) == 2]

    far = heart.settings | {"q_lower": [-9.0] * 7, "q_upper": [9.0] * 7}
    none = heart.settings | {"q_lower": [None] * 7, "q_upper": [None] * 7}
    assert limits(heart) == [-2.5, 2.5]
    assert limits(dataclasses.replace(heart, settings=far)) == []
    assert limits(dataclasses.replace(heart, settings=none)) == []


def test_path_is_flat_or_in_space(heart):
    desired = np.array(heart.position_desired)
    assert path_figure(heart).axes[0].name == "rectilinear"
    desired[:, 2] += 0.02 * np.sin(heart.t)
    figure = path_figure(dataclasses.replace(heart, position_desired=desired))
    assert figure.axes[0].name == "3d"
    assert figure.axes[0].get_zlabel() == "$z$ [m]"


def test_convergence_shows_tolerances_only_where_they_judge(heart):
    def labels(record):
        return [axes.get_legend_handles_labels()[1] for axes in convergence_figure(record).axes]

    assert labels(heart) == [["network", "tolerance"], ["proxqp", "osqp", "tolerance"]]
    lag = dataclasses.replace(heart, settings=heart.settings | {"mode": "continuous"})
    assert labels(lag) == [["network"], ["proxqp", "osqp"]]
    assert labels(make_record(solvers=())) == [["network", "tolerance"]]


def test_convergence_marks_answers_that_never_came(heart):
    gap = np.array(heart.solution_gap)
    gap[50:60, 1] = np.inf
    figure = convergence_figure(dataclasses.replace(heart, solution_gap=gap))
    marks = {line.get_label(): line for line in figure.axes[1].lines}["osqp failed"]
    np.testing.assert_allclose(marks.get_xdata(), heart.t[50:60])


def odd_records():
    """Records and a figure that shows what is odd; these two figures hold every panel."""
    for name in ("overview", "convergence"):
        yield "no steps", make_record(steps=0), name
        yield "one step", make_record(steps=1), name
    nothing = {"kkt_residual": np.zeros(10), "solution_gap": np.full((10, 1), np.nan)}
    yield "nothing positive", make_record(**nothing), "convergence"
    single = {"kkt_residual": np.full(10, 1e-4), "settings": {"mode": "continuous"}}
    yield "a single value", make_record(**single), "convergence"
    broken = heart_record(steps=3000)
    position, dq = np.array(broken.position), np.array(broken.dq)
    position[1000:], dq[1000:] = np.nan, np.inf
    yield "not finite", dataclasses.replace(broken, position=position, dq=dq), "overview"
    position[1000:] = np.inf
    yield "infinite", dataclasses.replace(broken, position=position), "overview"
    yield "many solvers", make_record(solvers=("a", "b", "c", "d")), "convergence"


@pytest.mark.parametrize(
    ("record", "name"), [pytest.param(r, name, id=f"{i}-{name}") for i, r, name in odd_records()]
)
@pytest.mark.filterwarnings("error::UserWarning", "error::RuntimeWarning")
def test_odd_records_are_drawn_too(record, name, tmp_path):
    figure = FIGURES[name](record)
    figure.get_layout_engine().execute(figure)
    figure.set_layout_engine(None)  # with one, it would be drawn twice
    figure.savefig(tmp_path / "x.png")
    assert (tmp_path / "x.png").stat().st_size > 10_000  # axes and labels, not a blank page


def test_a_folder_that_cannot_be_written(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(FileError):
        save_figures(make_record(), tmp_path / "file")


def test_pdf_streams_are_whole(drawn):
    content = (drawn[0] / "path.pdf").read_bytes()
    start = content.index(b"stream\n") + len(b"stream\n")
    assert zlib.decompressobj().decompress(content[start:])


def test_envelope_of_a_ramp():
    t = np.arange(1000.0)
    times, mean, least, greatest = envelope(t, 2.0 * t, buckets=10)
    np.testing.assert_allclose(times, 49.5 + 100.0 * np.arange(10))
    np.testing.assert_allclose(mean, 2.0 * times)
    np.testing.assert_array_equal(least, 200.0 * np.arange(10))
    np.testing.assert_array_equal(greatest, 200.0 * np.arange(10) + 198.0)


def test_envelope_holds_every_sample():
    curve = np.random.default_rng(2).normal(size=12_345)
    t = np.linspace(0.0, 1.0, len(curve))
    times, mean, least, greatest = envelope(t, curve, buckets=700)
    assert len(times) == 700
    assert least.min() == curve.min()
    assert greatest.max() == curve.max()
    assert (least <= mean).all()
    assert (mean <= greatest).all()
    for values in envelope(t[:5], curve[:5])[1:]:
        np.testing.assert_array_equal(values, curve[:5])


def test_a_spike_of_the_path_is_drawn_and_a_gap_left_out(heart, tmp_path):
    """Of 20,000 samples one is off the heart: its ink is in the picture, a NaN is not."""

    def ink(position):
        path_figure(dataclasses.replace(heart, position=position)).savefig(tmp_path / "x.png")
        return (image.imread(tmp_path / "x.png")[..., :3].max(axis=2) < 0.5).sum()

    spike, gap = np.array(heart.position), np.array(heart.position)
    # Both on the inside, so that the axes stay the same.
    spike[12_345] = 0.5 * (heart.position[0] + heart.position[10_000])
    gap[5000:7000] = np.nan
    assert ink(spike) > ink(heart.position) + 50
    assert ink(gap) < ink(heart.position) - 50


def test_stretches_are_where_something_acts() -> None:
    action = np.zeros(1000, int)
    action[200:300] = 2
    action[990:] = 4
    for pieces in (10, 100, 1000, 5000):
        first, last = stretches(action, pieces)
        width = 1.0 / min(pieces, 1000)
        assert first == pytest.approx([0.2, 0.3], abs=1e-12)
        assert last == pytest.approx([min(0.99, 1.0 - width), 1.0], abs=1e-12)
    assert stretches(np.zeros(10)).shape == (0, 2)
    assert stretches([]).shape == (0, 2)


@pytest.fixture(scope="module")
def slowed():
    """A run of 1,000 steps, whose second quarter goes at half speed for joint 4 and row 2."""
    fraction = np.ones(1000)
    fraction[250:500] = 0.5
    blocking = np.zeros((1000, 7), int)
    blocking[250:500, 3] = -2
    rows = np.zeros((1000, 2), int)
    rows[400:500, 1] = 1
    return make_record(
        steps=1000,
        fraction=fraction,
        action=2 * (fraction < 1.0),
        blocking=blocking,
        blocking_rows=rows,
        settings={"rows": [{"part": "CollisionAvoidance", "row": row} for row in (1, 2)]},
    )


def test_the_paths_time_is_drawn_of_slowed_runs_alone(slowed, monkeypatch, tmp_path):
    draw_only(monkeypatch, "path_time")
    assert tmp_path / "path_time.png" in save_figures(slowed, tmp_path)
    assert tmp_path / "path_time.png" not in save_figures(make_record(), tmp_path)


def test_the_paths_time_lags_by_what_the_slowed_steps_cost(slowed):
    clock, limit = path_time_figure(slowed).axes
    curves = {line.get_label(): line.get_xydata() for line in clock.lines}
    dt = slowed.settings["dt"]
    assert curves["as planned"][-1].tolist() == pytest.approx([1000 * dt, 1000 * dt])
    assert curves["reached"][-1, 1] == pytest.approx(875 * dt, rel=1e-2)
    (shade,) = clock.patches
    assert shade.get_x() == pytest.approx(250 * dt, rel=1e-2)
    assert shade.get_width() == pytest.approx(250 * dt, rel=1e-2)
    named = [text.get_text() for text in limit.texts]
    assert named[0] == "joint 4 lower velocity limit"
    assert named[1] == "row 2 of CollisionAvoidance"
    starts = [bars.get_paths()[0].vertices[:, 0].min() for bars in limit.collections]
    assert starts == pytest.approx([250 * dt, 400 * dt], rel=1e-2)


def test_a_slowed_run_without_a_limit_in_the_way_is_at_a_singular_pose():
    limit = path_time_figure(make_record(fraction=np.full(10, 0.5))).axes[1]
    assert [text.get_text() for text in limit.texts] == ["no limit: a singular pose"]


def test_each_limit_is_named_after_its_joints(heart):
    upper = [2.5, *[9.0] * 5, 1.2]
    record = dataclasses.replace(heart, settings=heart.settings | {"q_upper": upper})
    axes = FIGURES["joint_angles"](record).axes[0]
    assert [text.get_text() for text in axes.texts] == ["all", "$q_{7}$", "$q_{1}$"]
    assert [text.xy[1] for text in axes.texts] == [-2.5, 1.2, 2.5]
    named = heart.settings | {"joints": [f"arm_{letter}_joint" for letter in "abcdefg"]}
    axes = FIGURES["joint_angles"](dataclasses.replace(heart, settings=named)).axes[0]
    assert axes.get_legend_handles_labels()[1] == [*"abcdefg", "limit"]
