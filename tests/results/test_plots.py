"""The figures: all there, not blank, the same bytes each time, and fit for print."""

import dataclasses
import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib import image

from helpers_records import heart_record, make_record
from iiwa_dnn.results import plots
from iiwa_dnn.results.plots import (
    convergence_figure,
    draw_distance,
    draw_error,
    draw_joints,
    envelope,
    new_figure,
    overview_figure,
    save_figures,
)

NAMES = ["overview", "convergence"]


@pytest.fixture(scope="module")
def heart():
    return heart_record(steps=20_000, noise=0.01, solvers=("proxqp", "osqp"))


@pytest.fixture(scope="module")
def drawn(heart, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    return folder, save_figures(heart, folder)


def axes_of(draw, record, *arguments):
    axes = new_figure(3.5, 2.6).add_subplot()
    draw(axes, record, *arguments)
    return axes


def labels_of(record):
    return [axes.get_ylabel() for axes in overview_figure(record).axes]


def test_every_figure_is_there_twice_and_fit_for_print(drawn):
    folder, written = drawn
    assert written == [folder / f"{name}.{kind}" for name in NAMES for kind in ("png", "pdf")]
    assert sorted(written) == sorted(folder.iterdir())
    for name in NAMES:
        pixels = image.imread(folder / f"{name}.png")[..., :3]
        assert pixels.shape[1] == (1400 if name == "overview" else 700)
        assert 0.02 < (pixels < 0.95).any(axis=2).mean() < 0.6
        # Neither does ink touch the edge, where it would be cut off.
        edge = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
        assert (edge == 1.0).all()
        content = (folder / f"{name}.pdf").read_bytes()
        assert content.startswith(b"%PDF")
        assert len(content) < 600_000
        assert b"/Type3" not in content
        assert b"/FontFile2" in content


def test_same_bytes_elsewhere_whatever_the_users_style_and_without_pyplot(heart, drawn, tmp_path):
    heart.save(tmp_path / "record.npz")
    (tmp_path / "matplotlibrc").write_text("font.size: 30\nfigure.dpi: 37\naxes.facecolor: red\n")
    code = (
        "import sys, iiwa_dnn.results.plots as plots, iiwa_dnn.results.report\n"
        "assert 'matplotlib' not in sys.modules\n"
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


def test_a_run_has_the_panels_of_what_it_has(heart):
    always = [
        "$y$ [m]", "Joint angle [rad]", "Joint velocity [rad/s]", "Position error [nm]",
        "Orientation error [rad]", r"$\dot{q}^T G \dot{q}$ [rad²/s²]",
    ]  # fmt: skip
    assert labels_of(heart) == always
    frame = np.zeros((11, 1, 3))
    turn = np.tile(np.eye(3), (11, 1, 1, 1))
    record = make_record(
        distance=np.ones(11), nearest=np.zeros(11, int),
        frame_position=frame, frame_position_desired=frame + 1e-3,
        frame_rotation=turn, frame_rotation_desired=turn, torque=np.full((10, 7), 5.0),
        settings={
            "collisions": {"pairs": [["a", "b"]], "distance": 0.1},
            "tip": "hand", "frames": ["elbow"], "torque_max": [10.0] * 6 + [np.inf],
        },
    )  # fmt: skip
    further = ["Joint torque [N m]", "Position error [m]"]
    assert labels_of(record)[6:] == [*further, "Distance [m]"]
    assert axes_of(draw_distance, record).get_ylim()[0] == 0.0
    curves = axes_of(draw_joints, record, "torque").lines
    assert [curve.get_ydata()[0] for curve in curves[:7]] == [5.0] * 7
    desired = np.array(heart.position_desired)
    desired[:, 2] += 0.5 * np.sin(heart.t)  # wider than along y
    axes = overview_figure(dataclasses.replace(heart, position_desired=desired)).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("$y$ [m]", "$z$ [m]")


def test_rates_beyond_the_robots_limits_are_drawn_beside_them():
    dq = np.zeros((10, 7))
    dq[4:, 2] = 0.5
    own = {"robot_ddq_max": [2.0] * 7, "robot_dddq_max": [45.0] * 7}
    record = make_record(dq=dq, settings=own)
    assert labels_of(record)[6:] == ["Joint acceleration [rad/s²]", "Joint jerk [rad/s³]"]
    assert labels_of(make_record(dq=dq, settings=own | {"dddq_max": [40.0] * 7}))[7:] == []
    lines = axes_of(draw_joints, record, "acceleration").lines
    np.testing.assert_allclose(lines[2].get_ydata(), [0.0] * 4 + [5.0] + [0.0] * 5, atol=1e-12)
    assert {line.get_ydata()[0] for line in lines[7:]} == {2.0}  # near them


def test_curves_are_told_apart_without_colour_and_by_their_joints_names(heart):
    axes = axes_of(draw_joints, heart, "q")
    joints = axes.lines[:7]
    luminance = [np.dot(line.get_color()[:3], [0.2126, 0.7152, 0.0722]) for line in joints]
    assert (np.diff(luminance) > 0.03).all()
    dashes = [line.get_linestyle() for line in joints]
    assert all(one != other for one, other in pairwise(dashes))
    named = heart.settings | {"joints": [f"arm_{letter}_joint" for letter in "abcdefg"]}
    axes = axes_of(draw_joints, dataclasses.replace(heart, settings=named), "q")
    assert axes.get_legend_handles_labels()[1] == [*"abcdefg", "limit"]


def test_limits_that_differ_are_one_line_for_fractions_of_them():
    limit = np.array([320.0, 320, 176, 176, 110, 40, 40])
    torque = np.tile(0.9 * limit, (10, 1))
    torque[5, 1] = 42.0  # beyond what joint 7 may, far from what joint 2 may
    record = make_record(torque=torque, settings={"torque_max": limit.tolist()})
    axes = axes_of(draw_joints, record, "torque")
    assert axes.get_ylabel() == "Joint torque [% of limit]"
    curves = np.array([line.get_ydata() for line in axes.lines[:7]])
    assert curves[1].min() == pytest.approx(100 * 42 / 320)
    assert np.delete(curves, 1, axis=0) == pytest.approx(90.0)
    assert [line.get_ydata()[0] for line in axes.lines[7:]] == [100.0]
    figure = overview_figure(make_record(settings={"ddq_max": [1.0] * 7}))
    assert figure.get_suptitle() == "iiwa7, Heart; limits of position, velocity and acceleration"


def test_each_limit_near_the_curves_has_the_color_of_its_joint(heart):
    settings = {
        "q_lower": [*[None] * 3, -2.0, *[None] * 3],
        "q_upper": [2.5, 2.501, *[9.0] * 4, 1.2],
    }
    record = dataclasses.replace(heart, settings=heart.settings | settings)
    lines = axes_of(draw_joints, record, "q").lines
    drawn = [(line.get_ydata()[0], tuple(line.get_color())) for line in lines[7:]]
    expected = ((-2.0, 3), (2.5, 0), (2.501, 1), (1.2, 6))
    assert drawn == [(value, tuple(lines[joint].get_color())) for value, joint in expected]
    assert [line.get_label()[0] for line in lines[7:]] == [*"l___"]  # one entry for all


def test_a_spike_of_one_sample_is_drawn(heart):
    position = np.array(heart.position)
    position[12_345, 0] += 2e-3
    axes = axes_of(draw_error, dataclasses.replace(heart, position=position))
    assert axes.get_ylabel() == "Position error [mm]"
    assert axes.dataLim.y1 == pytest.approx(2.0, rel=1e-3)


def test_convergence_shows_tolerances_only_where_they_judge(heart):
    def labels(record):
        return [axes.get_legend_handles_labels()[1] for axes in convergence_figure(record).axes]

    assert labels(heart) == [["network", "tolerance"], ["proxqp", "osqp", "tolerance"]]
    lag = dataclasses.replace(heart, settings=heart.settings | {"mode": "continuous"})
    assert labels(lag) == [["network"], ["proxqp", "osqp"]]
    assert labels(make_record(solvers=())) == [["network", "tolerance"]]


def odd_records():
    yield "no steps", make_record(steps=0), NAMES
    yield "one step", make_record(steps=1), NAMES
    nothing = {"kkt_residual": np.zeros(10), "solution_gap": np.full((10, 1), np.nan)}
    yield "nothing positive", make_record(**nothing), NAMES[1:]
    broken = heart_record(steps=3000)
    position, dq = np.array(broken.position), np.array(broken.dq)
    position[1000:2000], position[2000:], dq[1000:] = np.nan, np.inf, np.inf
    yield "not finite", dataclasses.replace(broken, position=position, dq=dq), NAMES[:1]
    yield "many solvers", make_record(solvers=("a", "b", "c", "d")), NAMES[1:]


@pytest.mark.parametrize(
    ("record", "names"), [pytest.param(r, names, id=i) for i, r, names in odd_records()]
)
@pytest.mark.filterwarnings("error::UserWarning", "error::RuntimeWarning")
def test_odd_records_are_drawn_too(record, names, tmp_path):
    for name in names:
        figure = plots.FIGURES[name](record)
        figure.get_layout_engine().execute(figure)
        figure.set_layout_engine(None)  # with one, it would be drawn twice
        figure.savefig(tmp_path / "x.png")
        assert (tmp_path / "x.png").stat().st_size > 10_000  # axes and labels, not a blank page


def test_an_envelope_holds_every_sample():
    t = np.arange(1000.0)
    times, mean, least, greatest = envelope(t, 2.0 * t, buckets=10)
    np.testing.assert_allclose(times, 49.5 + 100.0 * np.arange(10))
    np.testing.assert_allclose(mean, 2.0 * times)
    np.testing.assert_array_equal(least, 200.0 * np.arange(10))
    np.testing.assert_array_equal(greatest, 200.0 * np.arange(10) + 198.0)
    for values in envelope(t[:5], t[:5])[1:]:
        np.testing.assert_array_equal(values, t[:5])
