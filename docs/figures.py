"""Draw the figures of these pages anew: ``python docs/figures.py``, or some of them by name.

A curve is an SVG that takes the reader's light or dark colors; a motion is an animated WebP, drawn
by MuJoCo (extra ``sim``); a page that is served is photographed in Chromium. Each function below
draws the file of its name; the tests call them all.
"""

import csv
import io
import re
import runpy
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from itertools import islice, pairwise
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.style
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch
from scipy.interpolate import CubicSpline

import iiwa_dnn
from iiwa_dnn.files import write_text
from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.studies import atlas, identify, paper
from iiwa_dnn.studies.runs import paper_robot

IMAGES = Path(__file__).parent / "images"
INK = "#0a0b0c"
"""Color of text and axes while a figure is drawn; in the file it is the reader's."""

BLUE = "#3b8bd6"
ORANGE = "#e8702a"
GREEN = "#2aa57a"
PURPLE = "#9a6cd8"
RED = "#d6404e"
GREY = "#8a9099"
WIDTH = 5.4
"""Width of a figure [in]: on a phone its text is 10 pixels high."""

STYLE = {
    "font.size": 10.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 10.0,
    "legend.fontsize": 9.0,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": GREY,
    "grid.alpha": 0.3,
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "path.simplify_threshold": 0.5,
    "svg.hashsalt": "iiwa_dnn",
    "savefig.transparent": True,
    **dict.fromkeys(("text.color", "axes.labelcolor", "axes.edgecolor"), INK),
    **dict.fromkeys(("xtick.color", "ytick.color"), INK),
}
_READER = "<style>svg{color:#24292f}@media(prefers-color-scheme:dark){svg{color:#d8dce2}}</style>"

Draw = Callable[[], Figure]
FIGURES: dict[str, Draw] = {}
"""Functions that draw a figure by the names of their files."""


def figure(draw: Draw) -> Draw:
    """Register a function by its name."""
    FIGURES[draw.__name__] = draw
    return draw


def save(name: str, folder: Path = IMAGES) -> Path:
    """Draw a figure and write it as an SVG whose ink follows the reader's color scheme."""
    path = folder / f"{name}.svg"
    raw = io.StringIO()
    with matplotlib.style.context(["default", STYLE]):
        FIGURES[name]().savefig(raw, format="svg", metadata={"Date": None, "Creator": None})
    text = raw.getvalue().replace(INK, "currentColor")
    write_text(path, re.sub(r"(<svg [^>]*>)", rf"\1{_READER}", text, count=1))
    return path


def panels(rows: int, height: float, **options: Any) -> tuple[Figure, Any]:
    """Make a figure of panels one above the other, each of this height [in]."""
    made = Figure(figsize=(WIDTH, rows * height + 0.3), layout="constrained")
    return made, made.subplots(rows, 1, **options)


def put_legend(axes: Any, columns: int = 3) -> None:
    """Put the legend above a panel."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=0.1)


# A jump beside the limits ----------------------------------------------------------------------


def jump(dt: float, *rates: iiwa_dnn.Limit) -> np.ndarray:
    """Return the joint positions (k, 7) [rad] after a target has jumped by 15 cm."""
    robot = iiwa_dnn.load_robot("iiwa7")
    q = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q)
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=rates)
    controller = iiwa_dnn.Controller(robot, scheme, dt=dt)
    target = iiwa_dnn.Target(start.position + [0.0, -0.15, 0.0], start.rotation)
    path = [q] * 4
    for k in range(round(0.9 / dt)):
        path.append(controller.step(path[-1], k * dt, target).next_q)
    return np.array(path)


@figure
def limits() -> Figure:
    """Draw the response to a jump: velocity, acceleration and jerk beside their limits."""
    dt, jerk = 1e-3, 500.0
    robot = iiwa_dnn.load_robot("iiwa7")
    path = jump(dt, iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits(jerk))
    made, axes = panels(3, 1.35, sharex=True)
    rates = (
        ("velocity", 1, robot.dq_max),
        ("acceleration", 2, robot.ddq_max),
        ("jerk", 3, np.full(7, jerk)),
    )
    for panel, (name, order, limit) in zip(axes, rates, strict=True):
        fraction = 100.0 * np.diff(path, order, axis=0) / dt**order / limit
        fraction = fraction[3 - order :]
        for joint, curve in enumerate(fraction.T):
            color = matplotlib.colormaps["turbo"](0.1 + 0.8 * joint / 6)
            label = f"joint {joint + 1}"
            panel.plot(1e3 * dt * np.arange(len(curve)), curve, color=color, lw=1.2, label=label)
        for sign in (-100.0, 100.0):
            panel.axhline(sign, color=RED, lw=1.4, ls="--")
        panel.set(ylabel=f"{name} [%]", ylim=(-118, 118), yticks=(-100, 0, 100))
    axes[-1].set(xlabel="time after the jump [ms]", xlim=(0, 550))
    put_legend(axes[0], 4)
    return made


# Filters of commands ---------------------------------------------------------------------------


@figure
def shield() -> Figure:
    """Draw the same hostile requests through the shield, a clamp and Ruckig."""
    from benchmarks.hostile.arms import Arm
    from benchmarks.hostile.contenders import ADAPTERS, Contender, setup_of

    dt = 1e-3
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
    arm = Arm("iiwa7")
    arm.limits[3:5] = robot.limits[3:5]
    center, radius = np.array([0.4, 0.0, 0.75]), 0.1
    ball = iiwa_dnn.Sphere(center, radius)
    avoidance = iiwa_dnn.CollisionAvoidance([ball], False, distance=0.02)
    setup = setup_of(arm, dt, center[np.newaxis], np.array([radius]))
    random = np.random.default_rng(12)
    requests = np.repeat(random.uniform(-1.0, 1.0, (6, 7)), 500, axis=0) * robot.dq_max
    scene = avoidance.scene(robot)
    made, axes = panels(3, 1.5, sharex=True)
    filters = {"clamp": "clamp", "Ruckig": "ruckig", "Shield": "shield"}
    t = dt * np.arange(len(requests) + 1)
    for color, (name, file) in zip((ORANGE, PURPLE, BLUE), filters.items(), strict=True):
        contender = Contender(ADAPTERS / f"{file}.py")
        contender.tell(setup)
        path = [robot.start_posture()]
        last = [0.0] * robot.dof
        for dq in requests:
            state = {"q": path[-1].tolist(), "last": last}
            told = {"state": state, "request": {"velocity": dq.tolist()}, "dt": dt}
            last = contender.tell(told)["dq"]
            path.append(path[-1] + dt * np.array(last))
        contender.close()
        driven = np.array(path)
        middle, half = robot.q_upper + robot.q_lower, robot.q_upper - robot.q_lower
        position = 100.0 * np.abs((2.0 * driven - middle) / half).max(axis=1)
        acceleration = 100.0 * np.abs(np.diff(driven, 2, axis=0)).max(axis=1) / dt**2 / 10.0
        distance = 1e3 * scene.nearest(driven, t)[0]
        style = {"color": color, "label": name, "lw": 2.4 if name == "Shield" else 1.3}
        axes[0].plot(t, position, **style)
        axes[1].plot(t[2:], acceleration, **style)
        axes[2].plot(t, distance, **style)
    axes[1].set_yscale("log")
    floors = (("position [%]", 100.0), ("acceleration [%]", 100.0), ("distance [mm]", 20.0))
    for panel, (name, limit) in zip(axes, floors, strict=True):
        panel.axhline(limit, color=RED, ls="--", lw=1.4)
        panel.set_ylabel(name)
    axes[1].set_ylim(10.0, 1e5)
    axes[2].set_xlabel("time [s]")
    axes[2].set_xlim(0.0, 3.0)
    put_legend(axes[0])
    return made


# A visit ---------------------------------------------------------------------------------------


@figure
def visit() -> Figure:
    """Draw separation and speed of an arm while somebody comes, stands beside it and goes."""
    dt, frames, late, walk = 2e-3, 17, 50, 1.2  # a camera of 30 Hz, 0.1 s behind
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
    about: Any = {"people": 1, "field": 3.0, "people_speed": 1.6, "latency": 0.134}
    guard, alone = iiwa_dnn.Shield(robot, dt, [], **about), iiwa_dnn.Shield(robot, dt)
    ruler = iiwa_dnn.Shield(robot, dt, [], **about)
    t = dt * np.arange(3000)
    out = np.interp(t, [0.0, 1.5, 3.0, 5.5], [2.6, 0.85, 0.85, 2.6])  # [m]
    assert np.abs(np.diff(out)).max() <= walk * dt
    q = other = robot.start_posture()
    tip = iiwa_dnn.Configuration(robot, q).position
    x, y = tip[:2] / np.linalg.norm(tip[:2])
    person = lambda at: [([at * x, at * y, 0.3], [at * x, at * y, 1.6], 0.2)]  # noqa: E731
    request = np.sin(3.5 * t)[:, np.newaxis] * np.array([1.5, 0.9, 0.0, 0.9, 0.0, 0.9, 0.0])
    kept = []
    for k, own in enumerate(request):
        seen: Any = {} if k % frames else {"people": person(out[max(k - late, 0)]), "age": 0.1}
        command = guard.step(q, own, **seen)
        there = ruler.step(q, 0.0 * own, people=person(out[k]), age=0.0).margin.separation
        free = alone.step(other, own)
        speeds = []
        for posture, each in ((q, command), (other, free)):
            jacobian = iiwa_dnn.Configuration(robot, posture).jacobian
            speeds.append(np.linalg.norm(jacobian[:3] @ each.dq))
        kept.append((there + 0.02, command.margin.separation, *speeds))
        q, other = command.next_q, free.next_q
    apart, separation, speed, undisturbed = np.array(kept).T
    made, axes = panels(2, 1.7, sharex=True)
    axes[0].plot(t, apart, color=BLUE, label="nearest link from the person")
    axes[0].plot(t, separation, color=ORANGE, lw=1.1, label="margin.separation")
    axes[0].axhline(0.0, color=RED, lw=1.4, ls="--")
    axes[0].set(ylabel="distance [m]")
    axes[1].plot(t, undisturbed, color=GREY, lw=1.1, ls="--", label="nobody there")
    axes[1].plot(t, speed, color=BLUE, label="beside the person")
    axes[1].set(ylabel="tip [m/s]", xlabel="time [s]", xlim=(0.0, t[-1]))
    for panel in axes:
        put_legend(panel, 2)
    return made


# A policy's samples ----------------------------------------------------------------------------


@figure
def following() -> Figure:
    """Draw a second of each kind of request for the same samples of a policy at 30 Hz."""
    robot = iiwa_dnn.load_robot("so101").with_limits(acceleration=10.0, jerk=200.0)
    dt, sampling, joint = 0.01, 1.0 / 30.0, 1
    begin = robot.start_posture()
    swing = np.eye(robot.dof)[joint]
    wanted = lambda t: 0.12 * (1.0 - np.cos(7.0 * t)) * (t > 0.0)  # noqa: E731
    seams = 0.03 * np.random.default_rng(2).standard_normal(40)  # of chunks [rad]
    t = dt * np.arange(400)
    kinds = ("position=", "stream, lead=1", "stream, lead=2", "chunks", "chunks with seams")
    colors = (GREY, ORANGE, PURPLE, BLUE, GREEN)
    made, axes = panels(len(kinds), 1.05, sharex=True, sharey=True)
    for kind, color, panel in zip(kinds, colors, axes, strict=True):
        shield = iiwa_dnn.Shield(robot, dt, [])
        q, path, sample, samples = begin, [begin], -1, []
        for now in t:
            own: Any = {}
            if int(now / sampling + 1e-9) > sample:
                sample += 1
                due = sample * sampling
                seam = seams[sample // 8] if kind == kinds[-1] else 0.0
                samples.append((due, wanted(due) + seam))
                if kind.startswith("chunks") and sample % 8 == 0:
                    times = due + sampling * np.arange(16)
                    chunk = begin + np.outer(wanted(times) + seam, swing)
                    shield.follow(times, chunk, now=now)
                elif not kind.startswith("chunks"):
                    own = {"position": begin + wanted(due) * swing}
                    own |= {"time": due, "lead": int(kind[-1])} if kind[-1].isdigit() else {}
            q = shield.step(q, **own).next_q
            path.append(q)
        panel.plot(*np.transpose(samples), ".", color=RED, ms=4)
        panel.plot(t, np.array(path)[:-1, joint] - begin[joint], color=color, label=kind)
        put_legend(panel, 1)
    axes[0].set(xlim=(2.0, 3.0), ylim=(-0.06, 0.3))
    axes[2].set_ylabel("joint 2 [rad], samples red")
    axes[-1].set_xlabel("time [s]")
    return made


# Noise -----------------------------------------------------------------------------------------

GAINS = tuple(np.geomspace(2.0, 800.0, 9))
"""Gains of the figure [1/s]."""


@figure
def noise() -> Figure:
    """Draw error and roughness over the gain, for noise of the velocity and of the encoders."""
    dt = 1e-3
    robot = paper_robot()
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, paper.START))
    kinds = {
        "velocity, 0.01 rad/s": ({"noise": 0.01}, BLUE),
        "encoders, 1e-4 rad": ({"noise": 1e-4, "noise_at": "measurement"}, ORANGE),
    }
    made, axes = panels(2, 1.7, sharex=True)
    for label, (options, color) in kinds.items():
        error, rough = [], []
        for gain in GAINS:
            scheme = iiwa_dnn.DoubleIndicator(position_gain=gain, orientation_gain=gain)
            record = iiwa_dnn.simulate(
                robot, scheme, heart, paper.START, dt=dt, duration=2.0, seed=1,
                check=iiwa_dnn.CrossCheck(()), **options,
            )  # fmt: skip
            settled = record.t >= 1.0
            error.append(1e3 * np.sqrt(np.mean(position_error(record)[settled] ** 2)))
            motion = record.dq[settled[:-1]]
            rough.append(np.abs(np.diff(motion, axis=0)).sum() / 7)
        axes[0].loglog(GAINS, error, "o-", color=color, ms=4, label=label)
        axes[1].loglog(GAINS, rough, "o-", color=color, ms=4)
    axes[0].set_ylabel("RMS error [mm]")
    axes[1].set(ylabel="roughness [rad/s²]", xlabel="gain [1/s]")
    for panel in axes:
        panel.axvline(10.2, color=GREY, lw=1.0, ls=":")
    axes[1].annotate("the paper's", (10.2, axes[1].get_ylim()[0]), (3, 4), color=INK,
                     textcoords="offset points", fontsize=9)  # fmt: skip
    put_legend(axes[0], 2)
    return made


# Rows and splines ------------------------------------------------------------------------------


@figure
def waypoints() -> Figure:
    """Draw a path through four rows with a pause, beside the cubic spline."""
    times = np.array([0.0, 1.0, 6.0, 7.0])
    heights = np.array([0.0, -0.1, -0.1, 0.0])
    points = np.column_stack([np.zeros((4, 2)), heights])
    t = np.linspace(0.0, 7.0, 400)
    made, axes = panels(1, 2.2)
    cubic = CubicSpline(times, heights, bc_type="clamped")
    axes.plot(t, 1e2 * cubic(t), color=ORANGE, label="cubic spline")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # names the exchanged rows
        path = iiwa_dnn.Waypoints(times, points)
    axes.plot(t, 1e2 * path.sample(t).position[:, 2], color=BLUE, label="Waypoints")
    axes.plot(times, 1e2 * heights, "o", color=INK, label="rows")
    axes.set(xlabel="time [s]", ylabel="height [cm]")
    put_legend(axes)
    return made


@figure
def push() -> Figure:
    """Draw the position error of an arm in physics that is pushed."""
    from iiwa_dnn.simulation import Disturbances, Push

    robot = iiwa_dnn.load_robot("iiwa7")
    q = robot.start_posture()
    circle = iiwa_dnn.Circle(radius=0.05, period=4.0).anchored(iiwa_dnn.Configuration(robot, q))
    push = Push(force=(20.0, 0.0, 0.0), start=1.0, duration=0.2)
    plant = iiwa_dnn.MujocoPlant(Disturbances(push=push))
    record = iiwa_dnn.simulate(
        robot, iiwa_dnn.DoubleIndicator(), circle, q, plant=plant, dt=1e-3, duration=2.5,
        check=iiwa_dnn.CrossCheck(()),
    )  # fmt: skip
    made, axes = panels(1, 2.0)
    error = 1e3 * position_error(record)
    for name, color, curve in zip("xyz", (BLUE, GREEN, PURPLE), error.T, strict=True):
        axes.plot(record.t, curve, color=color, lw=1.3, label=name)
    axes.axvspan(1.0, 1.2, color=ORANGE, alpha=0.3, lw=0, label="20 N along x")
    axes.set(xlabel="time [s]", ylabel="position error [mm]")
    put_legend(axes, 4)
    return made


# The paper and the league ----------------------------------------------------------------------

PAPER_DT = 1e-4
"""Control period of the runs beside Table I [s]."""


@figure
def identified() -> Figure:
    """Draw the distance of the settings of the grid from each row of the paper.

    The distances are those of ``iiwa-dnn paper --identify``, of which identified.csv is a copy.
    """
    with (Path(__file__).parent / "identified.csv").open(encoding="utf-8", newline="") as file:
        table = [*csv.DictReader(file)]
    fits = [
        {
            "changes": row.pop("changes"),
            "rows": {title: float(value) for title, value in row.items()},
        }
        for row in table
    ]
    (inferred,) = (each for each in fits if each["changes"] == "none")
    return identify.draw(fits, inferred)


@figure
def table_one() -> Figure:
    """Draw the largest errors of Table I beside ours, in the paper's way and converged."""
    robot = paper_robot()
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, paper.START))

    def largest(weight: float, **options: Any) -> float:
        record = iiwa_dnn.simulate(
            robot, iiwa_dnn.DoubleIndicator(weight, orientation=options.pop("orientation", "so3")),
            heart, paper.START, check=iiwa_dnn.CrossCheck(()), **{"dt": PAPER_DT, **options},
        )  # fmt: skip
        return float(1e6 * iiwa_dnn.compute_metrics(record)["max_position_error_m"])

    printed = [1e6 * value for value in paper.TABLE1["max_position_error_m"] if value]
    rows = {
        "printed": (printed, GREY),
        "ours, the paper's way": (
            [largest(weight, mode="continuous", orientation="block") for weight in paper.WEIGHTS],
            BLUE,
        ),
        "ours, converged": ([largest(weight) for weight in paper.WEIGHTS], GREEN),
    }
    made, axes = panels(1, 2.6)
    places = np.arange(len(paper.WEIGHTS))
    for number, (label, (values, color)) in enumerate(rows.items()):
        axes.bar(places + 0.27 * (number - 1), values, 0.25, color=color, label=label)
    axes.set_xticks(places, [f"{weight:g}" for weight in paper.WEIGHTS])
    axes.set(xlabel="weight ξ", ylabel="largest position error [µm]", yscale="log")
    axes.grid(axis="x", visible=False)
    put_legend(axes)
    return made


LEAGUE = {
    "projection, implicit Euler": (BLUE, "o-"),
    "simplified dual": (GREEN, "s-"),
    "zeroing, Taylor 5": (PURPLE, "^-"),
    "ADMM (OSQP)": (GREY, "d--"),
    "dual": (RED, "v-"),
    "projection (the paper's)": (ORANGE, "o-"),
    "primal-dual": ("#b08a2e", "x-"),
}
WORKS = (3e3, 1e4, 3e4, 1e5)
ONCE = ("zeroing, Taylor 5",)
FRACTIONS = (0.15, 0.95)
"""Networks of the figure, operations a period, those of which one evaluation a period is best, and
shares of the stable step that are tried."""


@figure
def league() -> Figure:
    """Draw the residual of the league's networks over the work of a control period."""
    made, axes = panels(1, 3.2)
    for name, (color, style) in LEAGUE.items():
        found = []
        for work in WORKS:
            cells = (
                atlas.Cell(name, work=work, fraction=fraction, most=1 if name in ONCE else None)
                for fraction in FRACTIONS
            )
            values = [atlas.measure(cell)["residual"][0] for cell in cells]
            found.append(min((each for each in values if each), default=np.nan))
        axes.loglog(WORKS, found, style, color=color, ms=5, label=name)
    axes.set(xlabel="operations a control period of 2 ms", ylabel="RMS KKT residual")
    put_legend(axes, 2)
    return made


# Solver and network ----------------------------------------------------------------------------


@figure
def settling() -> Figure:
    """Draw the way of the paper's network to rest from multipliers that are far away."""
    made, axes = panels(1, 2.3)
    qp = iiwa_dnn.QP([[1.0]], [0.0], A=[[1.0]], b=[0.0], lb=[-1.0], ub=[1.0])
    rates = iiwa_dnn.ProjectionNetwork().flow(qp).rates
    for far, color in ((10.0, GREEN), (40.0, BLUE), (80.0, PURPLE)):
        state, step = np.array([0.0, -far, 0.0, 0.0]), 5e-3
        away = []
        for _ in range(round((far + 32.0) / step)):
            away.append(np.linalg.norm(state))
            state = state + step * rates(state)
        t = step * np.arange(len(away))
        axes.semilogy(t[::20], away[::20], color=color, label=f"D = {far:g}")
    axes.axhline(1e-6, color=GREY, lw=1.0, ls=":")
    axes.set(xlabel="time [ρ]", ylabel="distance from rest")
    put_legend(axes)
    return made


SIZES = (7, 14, 30, 50, 100)
"""Numbers of variables of the programs of a figure."""


def random_program(n: int, active: int, random: np.random.Generator) -> iiwa_dnn.QP:
    """Draw a program of n variables with so many active rows among n."""
    root = random.standard_normal((n, n))
    x, z = random.standard_normal(n), np.zeros(n)
    G = random.standard_normal((n, n))
    z[:active] = random.uniform(0.5, 2.0, active)
    h = G @ x + np.where(np.arange(n) < active, 0.0, random.uniform(0.5, 2.0, n))
    P = root @ root.T / n + np.eye(n)
    return iiwa_dnn.QP(P, -P @ x - G.T @ z, G=G, h=h)


def quickest(solve: Callable[[], Any]) -> float:
    """Measure the least of some times of a call [s]."""
    times = []
    for _ in range(7):
        began = time.perf_counter()
        solve()
        times.append(time.perf_counter() - began)
    return min(times)


@figure
def solvers() -> Figure:
    """Draw the time of a cold solution in units of DAQP's, over size and active rows."""
    import qpsolvers

    made, axes = panels(1, 2.4)
    for fraction, color in ((0.1, BLUE), (0.5, ORANGE)):
        direct, public = [], []
        for n in SIZES:
            random = np.random.default_rng(n)
            ratios = []
            for _ in range(5):
                qp = random_program(n, round(fraction * n), random)
                problem = qp.to_qpsolvers()
                others = quickest(lambda p=problem: qpsolvers.solve_problem(p, "daqp"))
                ours = quickest(lambda p=problem: iiwa_dnn.solve_problem(p))
                alone = quickest(lambda p=qp: iiwa_dnn.DNNSolver().solve(p))
                ratios.append((alone / others, ours / others))
            one, two = np.median(ratios, axis=0)
            direct.append(one)
            public.append(two)
        label = f"{100 * fraction:.0f} % active"
        axes.plot(SIZES, public, "o-", color=color, ms=5, label=f"solve_problem, {label}")
        axes.plot(SIZES, direct, "s--", color=color, ms=4, label=f"solve, {label}")
    axes.axhline(1.0, color=GREY, lw=1.0)
    axes.set(xlabel="variables, as many rows", ylabel="time, in DAQP's", xscale="log", ylim=0.0)
    axes.set_xticks(SIZES, [str(n) for n in SIZES])
    axes.minorticks_off()
    put_legend(axes, 2)
    return made


# Motions to rest -------------------------------------------------------------------------------


@figure
def stopping() -> Figure:
    """Draw the velocity bound before a position limit, and a joint that runs along it."""
    dt, most = 2e-2, 2.0
    robot = iiwa_dnn.robot_from_dh(
        [(0.5, 0.0, 0.0, 0.0)], lower=-2.0, upper=1.0, velocity=1.5
    ).with_limits(acceleration=most)
    made, axes = panels(1, 2.7)
    distance = np.linspace(0.0, 0.7, 400)
    rest = distance / (most * dt**2)
    m = np.floor(0.5 * (np.sqrt(1.0 + 8.0 * rest) - 1.0))
    bound = most * dt * (rest / (m + 1.0) + 0.5 * m)
    continuous = np.sqrt(2.0 * most * distance)
    axes.plot(distance, continuous, color=GREY, lw=1.2, ls="--", label=r"$\sqrt{2Ad}$, no periods")
    axes.plot(distance, np.minimum(bound, 1.5), color=RED, label="bound of the command")
    guard = iiwa_dnn.Shield(robot, dt=dt)
    q, states = np.array([0.2]), []
    for _ in range(60):
        dq = guard.step(q, np.array([1.5])).dq
        states.append((1.0 - q[0], dq[0]))
        q = q + dt * dq
    left, velocity = np.array(states).T
    axes.plot(left, velocity, "o", color=BLUE, ms=4, label="commands at 20 ms")
    axes.set(xlabel="distance from the position limit [rad]", ylabel="velocity [rad/s]")
    axes.set(xlim=(0.72, -0.02), ylim=(0.0, 1.7))
    put_legend(axes, 2)
    return made


@figure
def braking() -> Figure:
    """Draw the stopping motions that are kept ready on the way to an obstacle."""
    dt = 1e-2
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=4.0)
    ball = iiwa_dnn.Sphere([0.1, 0.95, 0.3], 0.12)
    guard = iiwa_dnn.Shield(robot, dt, [ball], 0.02)
    scene = iiwa_dnn.CollisionAvoidance([ball], distance=0.02).scene(robot)
    q = robot.start_posture()
    path, speeds, slowings = [q], [], []
    for k in range(170):
        command = guard.step(path[-1], twist=[-0.2, 0.4, 0.0, 0.0, 0.0, 0.0])
        dq = np.array(command.dq)
        speeds.append(np.abs(dq).max())
        if k % 16 == 8:
            count = max(1, round(command.stopping_time / dt))
            falling = np.linspace(1.0, 0.0, count + 1)[:-1]
            stretch = path[-1] + dt * np.cumsum(falling[:, np.newaxis] * dq, axis=0)
            slowings.append((k, speeds[-1] * falling, np.vstack([path[-1], stretch])))
        path.append(path[-1] + dt * dq)
    made, axes = panels(2, 1.7, sharex=True)
    nearest = lambda rows: 1e3 * scene.nearest(np.array(rows), np.zeros(len(rows)))[0]  # noqa: E731
    for number, (k, ramp, stretch) in enumerate(slowings):
        label = "stopping motion from one of them" if number == 0 else None
        t = dt * (k + np.arange(len(stretch)))
        axes[0].plot(t, np.append(ramp, 0.0), color=GREEN, lw=1.1, label=label)
        axes[1].plot(t, nearest(stretch), color=GREEN, lw=1.1)
    axes[0].plot(dt * np.arange(170), speeds, "o", color=BLUE, ms=3, label="commands")
    axes[1].plot(dt * np.arange(171), nearest(path), "o", color=BLUE, ms=3)
    axes[1].axhline(20.0, color=RED, ls="--", lw=1.4)
    axes[0].set_ylabel("fastest joint\n[rad/s]")
    axes[1].set(ylabel="distance [mm]", xlabel="time [s]", ylim=0.0)
    put_legend(axes[0], 2)
    return made


# Speed -----------------------------------------------------------------------------------------


ARMS = (1, 4, 16, 64, 256, 1024, 4096)
ARM_STEPS = 5
"""Numbers of arms whose shields are timed, and steps of each."""

ROUNDS = 40
"""Times that steps are timed; the quietest round counts."""


def median_step(robot: iiwa_dnn.Robot, scheme: iiwa_dnn.Scheme, steps: int = 300) -> float:
    """Measure the median time of a step along a circle [µs], in the quietest round."""
    q = np.array(robot.start_posture())
    circle = iiwa_dnn.Circle(radius=0.02, period=4.0).anchored(iiwa_dnn.Configuration(robot, q))
    controller = iiwa_dnn.Controller(robot, scheme, circle, dt=1e-3)
    controller.warm_up(q)
    taken = np.empty((ROUNDS, steps))
    for k in range(taken.size):
        began = time.perf_counter_ns()
        command = controller.step(q, k * 1e-3)
        taken.flat[k] = time.perf_counter_ns() - began
        q = command.next_q
    return float(1e-3 * np.median(taken, axis=1).min())


def time_of_an_arm(count: int) -> float:
    """Measure the median time of a step of many shields, for each arm [µs], likewise."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(jerk=500.0)
    shields = iiwa_dnn.Shields(robot, count, dt=1e-3)
    q = np.tile(robot.start_posture(), (count, 1))
    requests = np.random.default_rng(0).uniform(-1.0, 1.0, q.shape)
    taken = np.empty((ROUNDS, ARM_STEPS))
    for k in range(taken.size):
        began = time.perf_counter_ns()
        command = shields.step(q, requests)
        taken.flat[k] = time.perf_counter_ns() - began
        q = command.next_q
    return float(1e-3 * np.median(taken, axis=1).min()) / count


@figure
def speed() -> Figure:
    """Draw the time of a step over joints, over pairs of bodies and over arms."""
    counts = (3, 5, 7, 9, 12, 14, 18, 21)
    turn = np.pi / 2
    times = []
    for n in counts:
        rows = [(0.1, turn if j % 2 else -turn, 0.15, 0.3) for j in range(n)]
        robot = iiwa_dnn.robot_from_dh(rows, lower=-2.5, upper=2.5, velocity=2.0)
        scheme = iiwa_dnn.Scheme(
            [iiwa_dnn.CyclicMotion()], [iiwa_dnn.PositionTask()], [iiwa_dnn.JointLimits()]
        )
        times.append(median_step(robot, scheme))
    made, axes = panels(3, 1.6)
    axes[0].plot(counts, times, "o-", color=BLUE)
    axes[0].set(xlabel="joints, position task", ylabel="step [µs]", ylim=0.0)
    robot = iiwa_dnn.load_robot("iiwa7")
    found = []
    for balls in range(7):
        spheres = [iiwa_dnn.Sphere([0.7, 0.4 - 0.15 * j, 0.9], 0.05) for j in range(balls)]
        avoid = iiwa_dnn.CollisionAvoidance(spheres, self_collision=False)
        extra = (avoid,) if balls else ()
        scheme = iiwa_dnn.DoubleIndicator(extra_limits=extra)
        pairs = len(avoid.scene(robot).pairs) if balls else 0
        found.append((pairs, median_step(robot, scheme)))
    axes[1].plot(*np.array(found).T, "o-", color=GREEN)
    axes[1].set(xlabel="watched pairs of an iiwa 7", ylabel="step [µs]", ylim=0.0)
    axes[2].plot(ARMS, [time_of_an_arm(count) for count in ARMS], "o-", color=ORANGE)
    axes[2].set(xlabel="arms of a Shields, on two cores", ylabel="for each [µs]", ylim=0.0)
    axes[2].set_xscale("log", base=4)
    axes[2].set_xticks(ARMS, [f"{count:,}" for count in ARMS])
    axes[2].minorticks_off()
    return made


# Diagrams --------------------------------------------------------------------------------------


def boxes(axes: Any, places: dict[str, tuple[float, float, float, str]], height: float) -> None:
    """Draw named boxes, each with its center, width and color."""
    for text, (x, y, width, color) in places.items():
        shape = FancyBboxPatch(
            (x - width / 2, y - height / 2), width, height, facecolor=color + "33",
            edgecolor=color, boxstyle="round,pad=0.02,rounding_size=0.08", linewidth=1.4,
        )  # fmt: skip
        axes.add_patch(shape)
        axes.text(x, y, text, ha="center", va="center", fontsize=9, color=INK)


def arrow(axes: Any, start: tuple[float, float], end: tuple[float, float], text: str = "",
          bend: float = 0.0, at: tuple[float, float] = (0.0, 0.1)) -> None:  # fmt: skip
    """Draw an arrow with a word beside its middle."""
    style = {"arrowstyle": "-|>", "mutation_scale": 10, "color": INK, "linewidth": 1.1}
    axes.add_patch(FancyArrowPatch(start, end, connectionstyle=f"arc3,rad={bend}", **style))
    x, y = 0.5 * (start[0] + end[0]) + at[0], 0.5 * (start[1] + end[1]) + at[1]
    axes.text(x, y, text, ha="center", va="center", fontsize=8.5, color=INK)


def diagram(height: float, top: float) -> tuple[Figure, Any]:
    """Make an empty figure with axes from 0 to 10 and from 0 to `top`."""
    made = Figure(figsize=(WIDTH, height), layout="constrained")
    axes = made.subplots()
    axes.set(xlim=(0, 10), ylim=(-0.3, top))
    axes.set_axis_off()
    return made, axes


@figure
def step() -> Figure:
    """Draw what happens in one step."""
    made, axes = diagram(3.6, 6.6)
    boxes(axes, {
        "measured joint\npositions": (1.5, 6.0, 2.6, GREY),
        "path, target or\nrequest": (1.5, 4.4, 2.6, GREY),
        "scheme: costs,\ntasks, limits": (5.2, 5.2, 2.4, BLUE),
        "quadratic\nprogram": (8.6, 5.2, 2.2, BLUE),
        "network solves it": (8.6, 3.2, 2.5, PURPLE),
        "no solution:\nthe path yields": (5.2, 3.2, 2.4, ORANGE),
        "can the arm\nstill stop?": (8.6, 1.0, 2.2, GREEN),
        "joint velocities\nto the drives": (1.5, 1.0, 2.6, GREY),
        "stopping motion\nof the last step": (5.2, 1.0, 2.5, RED),
    }, 1.0)  # fmt: skip
    arrow(axes, (2.85, 6.0), (4.0, 5.5))
    arrow(axes, (2.85, 4.4), (4.0, 4.9))
    arrow(axes, (6.45, 5.2), (7.5, 5.2))
    arrow(axes, (8.6, 4.65), (8.6, 3.75))
    arrow(axes, (7.3, 3.2), (6.45, 3.2))
    arrow(axes, (6.2, 3.8), (7.9, 4.65), at=(-0.55, 0.15))
    arrow(axes, (8.6, 2.65), (8.6, 1.55))
    arrow(axes, (7.45, 1.0), (6.5, 1.0), "no", at=(0.0, 0.2))
    arrow(axes, (3.9, 1.0), (2.85, 1.0))
    arrow(axes, (7.9, 0.45), (2.4, 0.45), "yes: the command itself", bend=-0.1, at=(0.0, -0.55))
    return made


@figure
def rooms() -> Figure:
    """Draw which part uses which."""
    made, axes = diagram(2.9, 5.4)
    boxes(axes, {
        "Robot": (1.2, 4.9, 1.8, GREY),
        "references:\npaths, targets": (3.7, 4.9, 2.3, GREY),
        "schemes: costs,\ntasks, limits": (6.3, 4.9, 2.4, BLUE),
        "networks,\nintegrators": (8.9, 4.9, 1.9, PURPLE),
        "Controller": (3.3, 3.1, 2.3, GREEN),
        "Shield": (6.9, 3.1, 2.3, GREEN),
        "simulate:\nplant, noise": (1.5, 1.3, 2.2, ORANGE),
        "your loop": (4.0, 1.3, 1.8, ORANGE),
        "export: C99": (6.3, 1.3, 2.0, ORANGE),
        "policy, joystick": (8.8, 1.3, 2.2, ORANGE),
    }, 0.95)  # fmt: skip
    for x in (1.2, 3.7, 6.3, 8.9):
        for end in (3.3, 6.9):
            if not (x == 3.7 and end == 6.9):
                arrow(axes, (x, 4.4), (end, 3.62))
    for start, end in ((3.3, 1.5), (3.3, 4.0), (3.3, 6.3), (6.9, 6.3), (6.9, 8.8), (6.9, 4.0)):
        arrow(axes, (start, 2.6), (end, 1.82))
    axes.text(1.5, 0.3, "Record, report, view", ha="center", fontsize=9, color=INK)
    arrow(axes, (1.5, 0.78), (1.5, 0.48))
    return made


# Motions ---------------------------------------------------------------------------------------

SIZE = (640, 400)
"""Width and height of a motion [pixel]."""

FRAME_RATE = 16
"""Pictures a second, in real time."""

Frames = Iterator[np.ndarray]
MOTIONS: dict[str, Callable[[], Frames]] = {}
"""Functions that draw the pictures of a motion by the names of their files."""

# A dark room, and a shadow map of the size of the picture.
_DUSK = {
    'rgb1="1 1 1" rgb2="1 1 1"': 'rgb1="0.13 0.15 0.19" rgb2="0.13 0.15 0.19"',
    "0.90 0.91 0.93": "0.24 0.27 0.32",
    "0.84 0.86 0.89": "0.19 0.21 0.26",
    'shadowsize="4096"': 'shadowsize="1024"',
}
TRACE = (0.25, 0.7, 1.0, 1.0)
GOAL = (1.0, 0.35, 0.3, 1.0)


def motion(draw: Callable[[], Frames]) -> Callable[[], Frames]:
    """Register a function by its name."""
    MOTIONS[draw.__name__] = draw
    return draw


def save_motion(name: str, folder: Path = IMAGES, most: int | None = None) -> Path:
    """Draw a motion, `most` pictures of it at most, and write it as an animated WebP."""
    from PIL import Image

    path = folder / f"{name}.webp"
    pictures = [Image.fromarray(picture) for picture in islice(MOTIONS[name](), most)]
    options = {"save_all": True, "loop": 0, "duration": 1000 // FRAME_RATE, "quality": 55}
    pictures[0].save(path, append_images=pictures[1:], method=4, **options)
    return path


class Stage:
    """A robot, obstacles and lines before a camera.

    The camera is at so many degrees of azimuth and elevation, a distance [m] from a point (3,) [m].
    """

    def __init__(self, robot: iiwa_dnn.Robot, obstacles: list[Any], view: tuple[Any, ...],
                 size: tuple[int, int] = SIZE) -> None:  # fmt: skip
        """Compile the scene."""
        from iiwa_dnn.results import pictures
        from iiwa_dnn.robot.mujoco_model import VISUAL_GROUP, import_mujoco, prepare_renderer

        self.mujoco = import_mujoco()
        prepare_renderer()
        scenery = pictures.SCENERY
        for bright, dark in _DUSK.items():
            scenery = scenery.replace(bright, dark)
        self.obstacles = obstacles
        self.model = pictures.build_scene(self.mujoco, robot, obstacles, scenery)
        self.data = self.mujoco.MjData(self.model)
        self.camera = self.mujoco.MjvCamera()
        self.camera.azimuth, self.camera.elevation, self.camera.distance = view[:3]
        self.camera.lookat[:] = view[3]
        self.options = self.mujoco.MjvOption()
        self.options.geomgroup[:] = np.arange(self.options.geomgroup.size) == VISUAL_GROUP
        self.renderer = self.mujoco.Renderer(self.model, size[1], size[0], self.model.ngeom + 900)

    def draw(self, q: np.ndarray, t: float = 0.0, lines: Any = (), balls: Any = ()) -> np.ndarray:
        """Draw joint positions, lines (points, radius, color) and balls (center, radius, color)."""
        mujoco = self.mujoco
        self.data.qpos[:] = q
        for i, obstacle in enumerate(self.obstacles):
            self.data.mocap_pos[i] = obstacle.shift(t)
        mujoco.mj_forward(self.model, self.data)
        self.renderer.update_scene(self.data, self.camera, self.options)
        for points, radius, color in lines:
            for start, end in pairwise(np.asarray(points)):
                geom = self._add(mujoco.mjtGeom.mjGEOM_CAPSULE, start, (radius, 0, 0), color)
                mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, start, end)
        for center, radius, color in balls:
            self._add(mujoco.mjtGeom.mjGEOM_SPHERE, center, (radius,) * 3, color)
        return self.renderer.render()

    def _add(self, kind: Any, place: Any, size: Any, color: Any) -> Any:
        scene = self.renderer.scene
        geom = scene.geoms[scene.ngeom]
        self.mujoco.mjv_initGeom(geom, kind, np.array(size, float), place, np.eye(3).ravel(), color)
        geom.emission = 0.6
        scene.ngeom += 1
        return geom


def write_on(picture: np.ndarray, *words: str) -> np.ndarray:
    """Write lines of words into the upper left corner of a picture."""
    from PIL import Image, ImageDraw, ImageFont

    image = Image.fromarray(picture)
    font = ImageFont.truetype(Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf", 17)
    ImageDraw.Draw(image).text((14, 10), "\n".join(words), (235, 238, 242), font=font, spacing=6)
    return np.asarray(image)


def thinned(path: np.ndarray, most: int = 120) -> np.ndarray:
    """Take at most so many points of a path."""
    return path[np.unique(np.linspace(0, len(path) - 1, most).astype(int))]


@motion
def heart() -> Frames:
    """Draw a heart of 22 cm."""
    robot = iiwa_dnn.load_robot("iiwa7")
    q = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q)
    path = iiwa_dnn.Heart(scale=7e-3, period=6.0).anchored(start)
    scheme = iiwa_dnn.DoubleIndicator()
    record = iiwa_dnn.simulate(robot, scheme, path, q, dt=2e-3, check=iiwa_dnn.CrossCheck(()))
    view = (165.0, -34.0, 1.3, [0.24, 0.2, 0.4])
    stage = Stage(robot, [], view, (2 * SIZE[0], 2 * SIZE[1]))  # the first picture that is seen
    for sample in range(0, record.steps + 1, round(1.0 / FRAME_RATE / 2e-3)):
        trace = record.position[: sample + 1]
        lines = [(thinned(record.position_desired), 0.0015, (0.6, 0.63, 0.7, 1.0))]
        if sample:
            lines.append((thinned(trace), 0.005, (1.0, 0.25, 0.35, 1.0)))
        yield stage.draw(record.q[sample], lines=lines)


@motion
def evade() -> Frames:
    """Draw an arm that keeps its tool where it is while a ball comes through its elbow."""
    dt = 2e-3
    robot = iiwa_dnn.load_robot("iiwa7")
    q = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q)
    elbow = start.frame("iiwa7_link_4").position
    ball = iiwa_dnn.Sphere(elbow + [0.36, -0.10, 0.0], 0.09, velocity=[-0.12, 0.0, 0.0])
    avoid = iiwa_dnn.CollisionAvoidance([ball], self_collision=False, distance=0.02)
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=(iiwa_dnn.AccelerationLimits(), avoid))
    still = iiwa_dnn.Target(start.position, start.rotation)
    controller = iiwa_dnn.Controller(robot, scheme, dt=dt, policy="relax")
    stage = Stage(robot, [ball], (285.0, -16.0, 1.3, [0.12, 0.15, 0.48]))
    for k in range(round(6.0 / dt)):
        if k % round(1.0 / FRAME_RATE / dt) == 0:
            tip = iiwa_dnn.Configuration(robot, q).position
            off = 1e3 * np.linalg.norm(tip - start.position)
            near = 1e3 * avoid.scene(robot).nearest(q[np.newaxis], np.array([k * dt]))[0][0]
            words = (f"tool off by {off:.2f} mm", f"ball {near:.0f} mm away, 20 asked")
            picture = stage.draw(q, k * dt, balls=[(start.position, 0.012, GOAL)])
            yield write_on(picture, *words)
        q = controller.step(q, k * dt, still).next_q


@motion
def joystick() -> Frames:
    """Draw a shield under a joystick that pushes the tool against a ball and out of reach."""
    dt = 2e-3
    robot = iiwa_dnn.load_robot("iiwa7")
    q = np.array(robot.start_posture())
    tip = iiwa_dnn.Configuration(robot, q).position
    ball = iiwa_dnn.Sphere(tip + [0.12, -0.28, 0.06], 0.09)
    guard = iiwa_dnn.Shield(robot, dt, [ball], 0.02)
    stage = Stage(robot, [ball], (240.0, -28.0, 1.35, [0.25, 0.2, 0.36]))
    pushes = ([0.1, -0.4, 0.0], [0.1, -0.4, 0.0], [0.0, 0.0, 0.4], [0.3, 0.4, 0.0], [0.4, 0.3, 0.0])
    command = None
    for k in range(round(5.5 / dt)):
        push = np.array(pushes[min(int(k * dt / 1.1), 4)])
        if k % round(1.0 / FRAME_RATE / dt) == 0:
            tip = iiwa_dnn.Configuration(robot, q).position
            reason = command.active_limits[0] if command and command.clipped else "nothing"
            reason = reason.partition("(")[2].rstrip(")") or reason  # the bodies of a pair
            arrow = ([tip, tip + 0.35 * push], 0.008, (1.0, 0.75, 0.2, 1.0))
            picture = stage.draw(q, k * dt, lines=[arrow])
            yield write_on(picture, "yellow: the stick", f"limited by {reason}")
        command = guard.step(q, twist=[*push, 0.0, 0.0, 0.0])
        q = q + dt * command.dq


@motion
def two_arms() -> Frames:
    """Draw two arms that carry one rod around."""
    robot = iiwa_dnn.load_robot("iiwa7_dual")
    both = iiwa_dnn.Configuration(robot, robot.start_posture())
    left, right = "left_iiwa7_flange", "right_iiwa7_flange"
    path = iiwa_dnn.Lissajous(amplitudes=(0.08, 0.06, 0.1), period=5.0)
    scheme = iiwa_dnn.Scheme(
        [iiwa_dnn.CyclicMotion()],
        [iiwa_dnn.PoseTask(frame=left), iiwa_dnn.RelativePoseTask(right, base=left)],
        [iiwa_dnn.JointLimits()],
    )
    record = iiwa_dnn.simulate(
        robot, scheme, {left: path.anchored(both.frame(left))}, both.q, dt=2e-3,
        check=iiwa_dnn.CrossCheck(()),
    )  # fmt: skip
    ends = [both.frame(name).position for name in (left, right)]
    stage = Stage(robot, [], (232.0, -24.0, 1.55, 0.5 * (ends[0] + ends[1]) + [0.0, 0.0, 0.12]))
    for sample in range(0, record.steps + 1, round(1.0 / FRAME_RATE / 2e-3)):
        now = iiwa_dnn.Configuration(robot, record.q[sample])
        rod = [now.frame(left).position, now.frame(right).position]
        lines = [(rod, 0.016, (1.0, 0.75, 0.2, 1.0))]
        lines.append((thinned(record.position[: sample + 2], 80), 0.003, TRACE))
        yield stage.draw(record.q[sample], lines=lines)


@motion
def jump_twice() -> Frames:
    """Draw a jump of the target without and with limits of acceleration and jerk."""
    from PIL import Image, ImageDraw

    dt = 1e-3
    rates = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits(500.0))
    names = ("velocity limits alone", "and acceleration, jerk")
    paths = [jump(dt), jump(dt, *rates)]
    robot = iiwa_dnn.load_robot("iiwa7")
    start = iiwa_dnn.Configuration(robot, paths[0][0])
    goal = start.position + [0.0, -0.15, 0.0]
    half = (SIZE[0] // 2, SIZE[1] - 110)
    stage = Stage(robot, [], (243.0, -25.0, 1.15, goal + [0.02, 0.0, 0.17]), half)
    speeds = [np.diff(path, axis=0) / dt / robot.dq_max for path in paths]
    samples = [0] * 6 + list(range(0, len(paths[0]) - 1, 10))  # five times slower than real
    for sample in samples:
        sides = []
        for path, speed, name in zip(paths, speeds, names, strict=True):
            picture = write_on(stage.draw(path[sample], balls=[(goal, 0.012, GOAL)]), name)
            strip = Image.new("RGB", (half[0], 110), (33, 38, 48))
            pen = ImageDraw.Draw(strip)
            pen.text((14, 4), "joint velocities", (170, 176, 186))
            for joint in range(7):
                x = np.arange(sample + 1) * (half[0] / len(speed))
                y = 62 - 40 * speed[: sample + 1, joint]
                color = tuple(int(255 * c) for c in matplotlib.colormaps["turbo"](0.1 + joint / 8))
                if sample:
                    pen.line(list(zip(x, y, strict=True)), color[:3], 2)
            sides.append(np.vstack([picture, np.asarray(strip)]))
        yield np.hstack(sides)


ROBOTS = {
    "iiwa7": 0.0, "panda": 0.0, "fr3": 0.0, "ur5": 0.0, "xarm7": 0.0, "kinova": 0.0,
    "baxter_left": -0.93, "tiago": 0.0, "talos_left": -1.0,
}  # fmt: skip
"""Robots of the picture, and the height of the floor in the frame of their base [m]."""


@motion
def robots() -> Frames:
    """Draw nine robots at the end of a heart of 22 cm, in one picture."""
    pictures = []
    for name, floor in ROBOTS.items():
        robot = iiwa_dnn.load_robot(name)
        q = robot.start_posture()
        path = iiwa_dnn.Heart(scale=7e-3, period=10.0).anchored(iiwa_dnn.Configuration(robot, q))
        scheme = iiwa_dnn.DoubleIndicator(orientation="none")
        record = iiwa_dnn.simulate(robot, scheme, path, q, dt=1e-2, check=iiwa_dnn.CrossCheck(()))
        middle = record.position_desired.mean(axis=0)
        azimuth = np.degrees(np.arctan2(middle[1], middle[0])) + 205.0
        view = (azimuth, -28.0, 1.2 if floor == 0.0 else 1.5, middle + [0.0, 0.0, 0.12])
        stage = Stage(robot, [], view, (360, 320))
        plane = int(np.flatnonzero(stage.model.geom_type == stage.mujoco.mjtGeom.mjGEOM_PLANE)[0])
        stage.model.geom_sameframe[plane] = 0
        stage.model.geom_pos[plane, 2] = floor
        line = (thinned(record.position), 0.005, (1.0, 0.25, 0.35, 1.0))
        pictures.append(write_on(stage.draw(record.q[-1], lines=[line]), name))
        stage.renderer.close()
    yield np.vstack([np.hstack(pictures[i : i + 3]) for i in (0, 3, 6)])


# Pages that are served -------------------------------------------------------------------------

SCREENS: dict[str, Callable[[], Any]] = {}
"""Functions that serve a page whose picture is taken, by the names of their files."""


def screen(serve: Callable[[], Any]) -> Callable[[], Any]:
    """Register a function by its name."""
    SCREENS[serve.__name__] = serve
    return serve


# The page warns of graphics without a card.
_DISMISS = "document.querySelector('.mantine-Notification-closeButton')?.click()"


def save_screen(name: str, folder: Path = IMAGES) -> Path:
    """Serve a page and take its picture in a browser once it has come to rest."""
    from PIL import Image

    from helpers_browser import open_browser, picture

    path = folder / f"{name}.png"
    server = SCREENS[name]().server
    with tempfile.TemporaryDirectory() as profile, open_browser(Path(profile)) as browser:
        size = {"width": 1280, "height": 720, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        browser.get(f"http://127.0.0.1:{server.get_port()}")
        before, shown = None, picture(browser)
        while len(np.unique(shown)) < 200 or not np.array_equal(before, shown):
            time.sleep(5.0)
            browser.execute_script(_DISMISS)
            before, shown = shown, picture(browser)
    server.stop()
    Image.fromarray(shown).quantize(256).save(path, optimize=True)
    return path


@screen
def viewer() -> Any:
    """Serve the replay of a heart that its velocity limits have slowed."""
    from iiwa_dnn.app.replay import Replay

    robot = paper_robot()
    robot = robot.with_limits(velocity=0.06 * robot.dq_max)
    q0 = robot.start_posture()
    heart = iiwa_dnn.Heart(0.005).anchored(iiwa_dnn.Configuration(robot, q0))
    record = iiwa_dnn.simulate(robot, iiwa_dnn.DoubleIndicator(), heart, q0, dt=5e-3)
    page = Replay(robot, record, port=0)
    page.clock.value = 4.5
    page.show()
    return page


@screen
def viewer_live() -> Any:
    """Serve the live page, its target dragged beside a ball."""
    script = runpy.run_path(str(IMAGES.parents[1] / "scripts" / "live.py"))
    page = script["Live"](iiwa_dnn.load_robot("iiwa7"), port=0)
    page.target.position = tuple(np.array(page.target.position) + [0.05, 0.15, 0.05])
    page.ball.position = tuple(page.center - [-0.08, 0.0, 0.22])
    for _ in range(23):
        page.tick()
    return page


def main(names: list[str]) -> int:
    """Draw all figures, or those of some names."""
    sys.path[:0] = [str(IMAGES.parents[1]), str(IMAGES.parents[1] / "tests")]
    makers = [(FIGURES, save), (MOTIONS, save_motion), (SCREENS, save_screen)]
    for made, saver in makers:
        for name in made:
            if not names or name in names:
                print(saver(name))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
