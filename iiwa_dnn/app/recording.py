"""Judge what a shield has recorded on an arm: late cycles, limits, following error, lag, distances.

No judge is the shield's: finite differences judge the limits of what was commanded and measured,
coal the distances of what was measured.
"""

from __future__ import annotations

import json
import os
import zipfile
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

from iiwa_dnn.control.requests import REASONS
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line, write_text
from iiwa_dnn.results.plots import new_figure
from iiwa_dnn.results.report import markdown_table
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import coal_geometry, collision_model
from iiwa_dnn.robot.meetings import TOUCH
from iiwa_dnn.robot.obstacles import Capsule, make_obstacles

LATE = 1.5
"""Control periods from which on a cycle is late."""

ROUNDING = 1e-6
NOISE = 0.05
"""Fractions by which commanded and measured rates may be above a limit."""

FOLLOWING = 0.05
"""Following error that is a finding [rad]."""

GRID = 0.002
WINDOW = 2.0
SLOWEST = 0.25
SHORTEST = 0.02
"""Grid of times and window for the lag, the longest one, and the one that is a finding [s]."""

MOVING = 0.05
"""Range of a joint below which a window shows no lag [rad]."""

WHOLE = WINDOW + SLOWEST
"""Least length of a recording that is judged [s]."""

OUTSIDE = 1e-6
"""Way of a joint out of its range that is a finding [rad]."""

SPARSE = 0.01
LACK = 1e-4
"""Time between judged distances [s], and what they may lack [m]."""


JUDGED = ("request_cost", "motion_limits", "collision_avoidance")
"""Parts of tables that are judged, or limit nothing; the report names the others."""

COLUMNS = ("", "judged", "worst", "at most", "where", "samples beyond")
"""Columns of the report."""


class Series(NamedTuple):
    """Values of one judge along a recording.

    Attributes:
        name: What is judged, with its unit.
        time: Times [s], (k,).
        value: Values, (k,).
        words: The joint or the pair of each value, (k,).
        most: Value above which there is a finding.
    """

    name: str
    time: Any
    value: Any
    words: Any
    most: float

    def row(self) -> tuple[str, ...]:
        """Return the worst value and where it is, in the order of `COLUMNS`."""
        at = int(np.argmax(self.value))
        beyond = self.time[self.value > self.most]
        spans = f"{beyond.size}, {beyond[0]:.2f} to {beyond[-1]:.2f} s" if beyond.size else "none"
        return (
            "found" if beyond.size else "kept",
            self.name,
            f"{self.value[at]:.4g}",
            f"{self.most:.4g}",
            f"{self.time[at]:.2f} s {self.words[at]}",
            spans,
        )


def read_recording(folder: str | os.PathLike[str]) -> tuple[dict[str, Any], Any]:
    """Read a recording of `armstep.recorded`: what it is of, and its steps.

    Raises:
        FileError: The folder holds none, or a chunk cannot be read.
    """
    try:
        head = json.loads((Path(folder) / "head.json").read_text(encoding="utf-8"))
        chunks = [np.load(file)["rows"] for file in sorted(Path(folder).glob("*.npz"))]
        return head, np.concatenate(chunks)
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise FileError(folder, f"holds no recording: {one_line(error)}") from error


def judge(tables: dict[str, Any], rows: Any, robot: Robot) -> list[Series]:
    """Judge the steps of a recording, given the members of the shield's tables, and the arm.

    Raises:
        InvalidInputError: The recording is shorter than `WHOLE`.
    """
    dt = tables["dt"]
    joints = np.array(tables["joint_names"])
    time = rows["time"] - rows["time"][0]
    if time[-1] < WHOLE:
        problem = f"lasts {time[-1]:.2f} s, less than {WHOLE:g} s, which judging takes"
        raise InvalidInputError("recording", problem, time[-1])
    measured = rows["measured"]
    blind = np.isnan(measured).any(axis=1)
    periods = np.diff(time)
    late = 1 + round(tables["delay"] / dt)
    error = np.abs(measured[late:] - rows["next_q"][:-late])
    found = [
        Series("period [of the stated one]", time[1:], periods / dt, [""] * periods.size, LATE),
        Series("steps without positions", time, 1.0 * blind, np.full(time.size, ""), 0.0),
        Series("following error [rad]", time[late:], *_worst(error, joints), FOLLOWING),
        _lag(rows, time, dt, SHORTEST + tables["delay"]),
    ]
    limits = {name: np.array(own, float) for name, own in tables["limits"].items()}
    for name, own in (("commanded", rows["next_q"]), ("measured", measured)):
        outside = np.maximum(own - limits["upper"], limits["lower"] - own)
        values = _worst(outside, joints)
        found.append(Series(f"{name} position [rad outside]", time, *values, OUTSIDE))
    held = np.where(rows["dt"] > 0.0, rows["dt"], rows["elapsed"])
    held = np.where(held > 0.0, held, dt)[:, np.newaxis]
    far = max(1, round(SHORTEST / dt))
    seen = (measured[far:] - measured[:-far]) / (time[far:] - time[:-far])[:, np.newaxis]
    acceleration = np.diff(rows["dq"], axis=0) / held[1:]
    for name, own, most, slack in (
        ("commanded velocity", rows["dq"], limits["velocity"], ROUNDING),
        ("measured velocity", seen, limits["velocity"], NOISE),
        ("acceleration", acceleration, limits["acceleration"], ROUNDING),
        ("jerk", np.diff(acceleration, axis=0) / held[2:], limits["jerk"], ROUNDING),
    ):
        values = _worst(np.abs(own) / most, joints)
        found.append(Series(f"{name} [of the limit]", time[-len(own) :], *values, 1.0 + slack))
    if tables["scene"] is None:
        return found
    return [*found, _distances(tables, rows[~blind], time[~blind], robot)]


def _worst(values: Any, names: Any) -> tuple[Any, Any]:
    """Return the largest value of each row, and its name; what is not known is nothing found."""
    values = np.nan_to_num(values, nan=-np.inf, posinf=np.inf)
    return values.max(axis=1), names[values.argmax(axis=1)]


def _lag(rows: Any, time: Any, dt: float, most: float) -> Series:
    """Find the lag in each window by which measured joints follow commanded ones best."""
    step = max(1, round(GRID / dt))
    grid = step * dt
    asked, seen = rows["next_q"][:-1:step], rows["measured"][1::step]
    length = round(WINDOW / grid)
    shifts = range(round(SLOWEST / grid))
    begins = range(0, max(1, len(asked) - length - len(shifts)), length // 4)
    lags = []
    for k in begins:
        path = asked[k : k + length]
        misses = [np.abs(seen[k + s :][: len(path)] - path[: len(seen) - k - s]) for s in shifts]
        best = np.argmin([np.fmin(each, FOLLOWING).mean() for each in misses])  # but for jumps
        lags.append(grid * best * (np.ptp(path, axis=0).max() > MOVING))
    middles = time[::step][[k + length // 2 for k in begins]]
    return Series("lag [s]", middles, np.array(lags), np.full(len(lags), "all joints"), most)


def _distances(tables: dict[str, Any], rows: Any, time: Any, robot: Robot) -> Series:
    """Measure by coal how much nearer links are to each other and to obstacles than promised."""
    promised = tables["scene"]["distance"]
    model = collision_model(robot)
    obstacles = make_obstacles(tables["scene"]["obstacles"])
    names = [link for link, _ in model.bodies] + tables["obstacle_names"]
    first = len(model.bodies)
    beyond = max(0.0, promised - TOUCH)  # a close pair keeps no more than `TOUCH`
    pairs = [(i, k, overlap + beyond if overlap else 0.0) for i, k, overlap in model.pairs(robot)]
    geometry = coal_geometry(robot, model, pairs)
    rest = []
    # A box stands for a link beside another link alone: its corners are outside of it.
    moved = [
        i
        for i, (_, shape) in enumerate(model.bodies)
        if isinstance(shape, Capsule) and geometry.geometryObjects[i].parentJoint
    ]
    for k, each in enumerate(obstacles, first):
        shape, place = each.box.grown(each.thickness)
        rest.append(place)
        geometry.addGeometryObject(pin.GeometryObject(names[k], 0, place, shape))
        for i in moved:
            geometry.addCollisionPair(pin.CollisionPair(k, i))
            pairs.append((k, i, 0.0))
    stride = max(1, round(SPARSE / tables["dt"]))
    found = pin.GeometryData(geometry)
    data = robot.model.createData()
    lacks = []
    for row in rows[::stride]:
        for k, shift in enumerate(row["places"] - rows["places"][0]):
            moved = pin.SE3(rest[k].rotation, rest[k].translation + shift)
            geometry.geometryObjects[first + k].placement = moved
        pin.computeDistances(robot.model, data, geometry, found, row["measured"])
        lacks.append([promised - each.min_distance for each in found.distanceResults])
    words = np.array([f"{names[i]} and {names[k]}" for i, k, _ in pairs])
    lack = np.array(lacks) - [pair[2] for pair in pairs]
    return Series("lack of distance [m]", time[::stride], *_worst(lack, words), LACK)


def replayed(
    folder: str | os.PathLike[str], head: dict[str, Any], rows: Any, robot: Robot
) -> tuple[list[str], Path]:
    """Judge a recording; write `report.md`, `recording.png` and all of it as one ZIP file.

    Returns:
        A line for each finding, and the ZIP file, beside the folder.
    """
    tables = head["tables"]
    series = judge(tables, rows, robot)
    place = Path(folder)
    figure = new_figure(9.0, 1.6 * len(series))
    table = []
    for number, each in enumerate(series, 1):
        axes = figure.add_subplot(len(series), 1, number, xlabel="time [s]")
        axes.plot(each.time, each.value, linewidth=0.8)
        axes.axhline(each.most, color="tab:red", linewidth=0.8)
        axes.set_title(each.name, loc="left", fontsize=8)
        table.append(each.row())
    figure.savefig(place / "recording.png", dpi=120)
    findings = [" ".join(row) for row in table if row[0] == "found"]
    parts = tables["numbers"]["plan"]["step"]["arrays"]["constants"]
    others = [part.replace("_", " ") for part in parts if part not in JUDGED]
    reasons = Counter(REASONS[code] or "none" for code in rows["reason"])
    about = {
        "tables": f"{tables['name']}, {tables['digest']}, of {robot.name}",
        "steps": f"{len(rows)} in {rows['time'][-1] - rows['time'][0]:.1f} s",
        "reasons": ", ".join(f"{word} {count}" for word, count in reasons.most_common()),
        "not judged": ", ".join(others) or "none of its limits",
        "machine": f"{head['machine']}, {head['versions']}",
    }
    text = [f"# Recording of {tables['name']}", *(f"- {k}: {each}" for k, each in about.items())]
    text += [markdown_table(COLUMNS, table), "![what the judges found](recording.png)", ""]
    write_text(place / "report.md", "\n\n".join(text))
    file = place.with_suffix(".zip")
    with zipfile.ZipFile(file, "w") as opened:
        for own in sorted(place.iterdir()):
            opened.write(own, f"{place.name}/{own.name}")
    return findings, file
