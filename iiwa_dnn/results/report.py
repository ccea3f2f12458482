"""The texts about a run: the summary on the terminal, and a folder with its report."""

import os
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from iiwa_dnn.files import prepare_folder, write_json
from iiwa_dnn.naming import describe, unwatched
from iiwa_dnn.results.failures import INFEASIBLE, failures, programs_checked
from iiwa_dnn.results.markdown import bullets, markdown_table, save_markdown, show_figures
from iiwa_dnn.results.metrics import ACTIONS, PROOF, compute_metrics
from iiwa_dnn.results.plots import save_figures
from iiwa_dnn.results.record import Record

Row = tuple[str, ...]
Table = Sequence[tuple[str, str, str]]

# Names of the settings in the report; one that is not here keeps its own.
_SETTINGS = {
    "joints": "joints, in the order of their numbers",
    "locked": "locked joints, at [rad]",
    "q_lower": "lower joint limits [rad]",
    "q_upper": "upper joint limits [rad]",
    "dq_max": "velocity limits [rad/s]",
    "ddq_max": "acceleration limits [rad/s²]",
    "dddq_max": "jerk limits [rad/s³]",
    "q0": "initial joint positions [rad]",
    "dt": "time step [s]",
    "duration": "duration [s]",
    "check": "cross-check",
    "tol": "KKT tolerance",
    "rho": "network time constant [s]",
    "rows": "inequality rows",
    "noise": "noise, standard deviation [rad/s, or rad if at measurement]",
    "noise_at": "noise enters at",
    "filter_window": "filter window [steps]",
}
_CAPTIONS = {
    "overview": "Path, joint angles, joint velocities and position error, and the orientation "
    "error against a target that turns.",
    "path": "Desired and actual path.",
    "joint_velocities": "Joint velocities that moved the robot.",
    "torques": "Joint torques: of each step the largest.",
    "moments": "The arm, and below it the path so far, face on.",
    "position_error": "Position error, actual minus desired.",
    "frames": "Errors of all tracked frames.",
    "distance": "Distance of the nearest pair of bodies, and the least that is allowed.",
    "path_time": "The path's time over time, grey where it was slowed, and the limits in the way.",
    "convergence": "KKT residual of the network and gap to the reference: the line is the largest "
    "value, the band the range, of each short stretch of time.",
}
_KINETIC_UNITS = {"identity": "rad²/s²", "inertia": "J"}
_SUMMARY = {
    "run": "{robot}, {mode}, {steps} steps of {dt_s} s ({duration_s} s)",
    "position error": "max {max_position_error_m} m, mean square {mse_position_error_m2} m^2",
    "orientation error": "max {max_orientation_error_rad} {angle_unit}",
    "joint drift": "max {joint_drift_rad} rad",
    "kinetic index": "max {max_kinetic_index} {kinetic_unit}",
    "beyond limits": "{position_limit_violation_rad} rad, {velocity_limit_violation_rad_s} rad/s",
    "KKT residual": "max {max_kkt_residual}, tolerance {tol}",
    "difficulty": "{active_limit_steps} of {steps} steps with an active limit; "
    "{mean} {systems} a step, at most {max}",
    "cross-check": "{solver}: {programs}, {disagreements} disagreements, "
    "{reference_failures} failures{judged_by}\n"
    "largest gap {max_solution_gap} rad/s, tolerance {tolerance} rad/s",
    "wall time": "{wall_time_s} s, {realtime_factor} x real time",
}
_PROVEN = (
    "{proven} answers proven within {max_solution_gap} rad/s of the exact solution, "
    "{reference_failures} not proven"
)
_COMPARED = (
    "{solver}, {steps_checked} own programs compared, not judged; "
    "{reference_failures} of them it could not solve\n"
    "largest lag {max_solution_gap} rad/s"
)
_FRAME = "max {max_position_error_m} m, {max_orientation_error_rad} rad"
_NEAREST = "{least_distance_m} m, {second} and {first} at {time_s} s; allowed {allowed_m} m"
_SETTLED = "max {max_position_error_settled_m} m from {settled_after_s} s on"
_PUSHED = "error max {max_position_error_m} m, back within {recovered_below_m} m {recovery}"
_ACTED = {
    "active_bounds": "{name} for {time_s} s, multiplier up to {max_multiplier}",
    "active_rows": "{name} active for {time_s} s, multiplier up to {max_multiplier}",
}
_ON_AVERAGE = ", {mean_multiplier} on average ({steps} steps, from {first_s} s on)"
_BLOCKED = "{name} in the way for {time_s} s ({steps} steps, from {first_s} s on)"
_RESULTS: Table = (
    ("share of the path completed", "path_completed", ""),
    ("largest position error", "max_position_error_m", "m"),
    ("mean squared position error, over samples and axes", "mse_position_error_m2", "m²"),
    ("largest orientation error", "max_orientation_error_rad", "angle"),
    ("joint drift, start to end", "joint_drift_rad", "rad"),
    ("largest kinetic index", "max_kinetic_index", "kinetic"),
    ("largest KKT residual", "max_kkt_residual", ""),
    ("beyond position limits", "position_limit_violation_rad", "rad"),
    ("beyond velocity limits", "velocity_limit_violation_rad_s", "rad/s"),
    ("beyond acceleration limits", "acceleration_limit_violation_rad_s2", "rad/s²"),
    ("beyond jerk limits", "jerk_limit_violation_rad_s3", "rad/s³"),
    ("steps", "steps", ""),
    ("steps with an active bound or row", "active_limit_steps", ""),
    ("time step", "dt_s", "s"),
    ("time simulated", "duration_s", "s"),
    ("wall time", "wall_time_s", "s"),
    ("time simulated / wall time", "realtime_factor", ""),
)
_CROSSCHECK: Table = (
    ("reference solver", "solver", ""),
    ("own programs checked", "own", ""),
    ("scaled programs checked", "scaled", ""),
    ("softened programs checked", "softened", ""),
    ("steps held back, checked for their bounds alone", "held", ""),
    ("steps stopped, with nothing to check", "stopped", ""),
    ("steps that disagree", "disagreements", ""),
    ("reference answers not to be believed", "reference_failures", ""),
    ("largest gap in the solution", "max_solution_gap", "rad/s"),
    ("tolerance on it", "tolerance", "rad/s"),
    ("largest gap in the objective", "max_objective_gap", ""),
    ("largest residual of a reference", "max_reference_residual", ""),
    ("largest excess of a command over its step's bounds and rows", "max_excess", ""),
)
_PROOF: Table = (
    ("answers proven", "proven", ""),
    ("answers not proven", "reference_failures", ""),
    ("largest distance from the exact solution, at most", "max_solution_gap", "rad/s"),
    ("tolerance on it", "tolerance", "rad/s"),
)
_INCIDENTS: Table = (
    ("steps with a clipped command", "clipped_steps", ""),
    *((f"steps: {name}", f"{name}_steps", "") for name in ACTIONS.values()),
    ("path time reached", "path_time_s", "s"),
)
_PHYSICS: Table = (
    (
        "largest position error from {settled_after_s:g} s on",
        "max_position_error_settled_m",
        "m",
    ),
)
_PUSH: Table = (
    ("largest position error since the push", "max_position_error_m", "m"),
    (
        "time from the push's end until back within {recovered_below_m:g} m",
        "recovery_s",
        "s",
    ),
)
_HEAD = ("quantity", "value", "unit")
_WHY = {
    "adjacent": "joined to each other",
    "never": "never near each other",
    "always": "in touch in most postures",
    "start": "near each other in the start posture",
}
"""Reasons of a collision model to leave a pair of links out, in words."""


def save_run(
    record: Record,
    folder: str | os.PathLike[str],
    plots: bool = True,
    more: Callable[[Record, Path], list[Path]] | None = None,
) -> dict[str, Any]:
    """Write record.npz, metrics.json, figures and report.md into a folder, made if need be.

    Each file is written atomically, the record first; figures only with `plots`. `more` draws
    further figures into the folder and returns their files.

    Returns:
        The metrics, as in metrics.json.

    Raises:
        FileError: If the folder cannot be written.
    """
    folder = prepare_folder(folder)
    record.save(folder / "record.npz")
    metrics = compute_metrics(record)
    write_json(folder / "metrics.json", metrics)
    figures = save_figures(record, folder) if plots else []
    figures += more(record, folder) if more is not None else []
    write_report(record, metrics, folder, figures)
    return metrics


def write_report(
    record: Record,
    metrics: Mapping[str, Any],
    folder: str | os.PathLike[str],
    figures: Iterable[Path] = (),
) -> Path:
    """Write report.md into a folder that exists, and return the file.

    Every number in it is one of the metrics. It shows the PNG files among the figures, which lie in
    that folder.

    Raises:
        FileError: If it cannot be written.
    """
    settings = metrics["settings"]
    results = _rows(metrics, _RESULTS) + _iterations(metrics)
    results += _frames(metrics) + _physics(metrics.get("physics"))
    versions = [(name, _text(value)) for name, value in metrics["versions"].items()]
    lag = "Continuous mode: the gap is the network's lag, reported and not judged."
    parts = [
        f"# {settings['robot']}: {metrics['steps']:,} steps, {settings['mode']}",
        "## Verdict",
        bullets(failures(record) or [_success(metrics)]),
        "## Results",
        markdown_table(_HEAD, results),
        "## Cross-check",
        _checked(metrics["crosscheck"]),
        *_incidents(metrics.get("incidents")),
        *(f"Nearest pair: {pair}." for pair in _nearest_pair(metrics)),
        *_unwatched(settings),
        *_pairs(settings),
        *([lag] if settings["mode"] == "continuous" else []),
        "## Settings",
        markdown_table(("setting", "value"), _named(settings)),
        "## Versions",
        markdown_table(("package", "version"), versions),
        *show_figures(figures, _CAPTIONS),
    ]
    return save_markdown(folder, parts)


def settings_lines(metrics: Mapping[str, Any]) -> str:
    """List the settings among the metrics of a run, one a line, in the words of its report."""
    return "\n".join(f"{name}: {value}" for name, value in _named(metrics["settings"]))


def summary(metrics: Mapping[str, Any], reasons: Sequence[str] | None = None) -> str:
    """Sum up a run in about ten aligned lines of ASCII, for the terminal.

    An incomplete path is its first line, or that the path cannot be followed. The reasons of a
    failure are those of the metrics, or more detailed ones: `failures` of the record itself.
    """
    settings = metrics["settings"]
    check = metrics["crosscheck"]
    reasons = failures(metrics) if reasons is None else reasons
    more = {
        **metrics["network_iterations"],
        "systems": _systems(settings),
        "programs": programs_checked(check, ",\n"),
        "judged_by": _judged_by(check),
        "angle_unit": _angle_unit(settings),
        "kinetic_unit": _kinetic_unit(settings).replace("²", "^2"),
    }
    lines = {k: _fill(text, settings, check, metrics, more) for k, text in _SUMMARY.items()}
    if settings["mode"] == "continuous":
        lines["KKT residual"] = _fill("max {max_kkt_residual}, not judged", metrics)
        lines["cross-check"] = _fill(_COMPARED, check)
    if check["solver"] == "none":
        lines["cross-check"] = "not asked for"
    if check["solver"] == PROOF:
        lines["cross-check"] = _fill(_PROVEN, check)
    frames = metrics.get("frames", {}).items()
    lines |= {name: _fill(_FRAME, errors) for name, errors in frames}
    lines |= _physics_lines(metrics.get("physics"))
    lines |= _incident_lines(metrics.get("incidents", {}))
    for pair in _nearest_pair(metrics):
        lines["nearest pair"] = pair
    lines["wall time"] = lines.pop("wall time")
    verdict = reasons or [_success(metrics)]
    lines["verdict"] = "\n".join([*verdict, *_unwatched(metrics["settings"])])
    width = max(map(len, lines)) + 2
    aligned = (
        f"{name:<{width}}" + text.replace("\n", "\n" + " " * width) for name, text in lines.items()
    )
    first = [text for text in reasons[:1] if text.startswith(("path ", INFEASIBLE))]
    return "\n".join([*first, *aligned])


def _success(metrics: Mapping[str, Any]) -> str:
    """State the verdict on a run without failures, no stronger than the check."""
    check = metrics["crosscheck"]
    solver = check["solver"]
    if check["judged"]:
        steps = f"all {metrics['steps']:,} steps solved"
        if solver == PROOF:
            return f"{steps}, within all limits and proven"
        return f"{steps}, within all limits and in agreement with {solver}"
    if solver == "none":
        return "completed within all limits; no reference solver was asked"
    failed = check["reference_failures"]
    doubt = f"; {failed:,} reference answers not to be believed" if failed else ""
    return f"completed within all limits; the gap to {solver} is a lag, not judged{doubt}"


def _checked(check: Mapping[str, Any]) -> str:
    """Lay out the report's table on the cross-check, and the proof's line above its own."""
    kinds = {name: steps for name, steps in check["kinds"].items() if steps or name == "own"}
    if check["solver"] != PROOF:
        left_out = () if check["judged"] else ("disagreements", "tolerance")
        table = [row for row in _CROSSCHECK if row[1] not in left_out]
        judges = check.get("judged_by", {}).items()
        judged = [(f"answers judged by {name}", _number(count), "") for name, count in judges]
        return markdown_table(_HEAD, [*_rows({**kinds, **check}, table), *judged])
    return f"{_fill(_PROVEN, check)}.\n\n{markdown_table(_HEAD, _rows(check, _PROOF))}"


def _fill(text: str, *values: Mapping[str, Any]) -> str:
    """Fill a text's fields from mappings, numbers in four digits; later mappings come first."""
    return text.format_map({key: _short(value) for part in values for key, value in part.items()})


def _nearest_pair(metrics: Mapping[str, Any]) -> list[str]:
    """Name the nearest pair of bodies of a run that avoids collisions."""
    return [_fill(_NEAREST, metrics["collisions"])] if "collisions" in metrics else []


def _unwatched(settings: Mapping[str, Any]) -> list[str]:
    """Name the links of a run that nothing kept clear of obstacles."""
    links = settings.get("collisions", {}).get("unwatched")  # older records lack it
    return [f"Beware: {unwatched(links)}."] if links else []


def _pairs(settings: Mapping[str, Any]) -> list[str]:
    """State which pairs of bodies are watched, and which are not and why."""
    collisions = settings.get("collisions", {})
    groups = {"Watched pairs": [" and ".join(pair) for pair in collisions.get("pairs", ())]}
    for first, second, why in collisions.get("left_out", ()):
        groups.setdefault(f"Not watched, {_WHY.get(why, why)}", []).append(f"{first} and {second}")
    items = groups.items()
    return [f"{name} ({len(pairs)}): {'; '.join(pairs)}." for name, pairs in items if pairs]


def _judged_by(check: Mapping[str, Any]) -> str:
    """State how many answers each solver judged, if a second one had to."""
    judges = check.get("judged_by", {})
    if set(judges) <= set(check["solver"].split("+")) and len(judges) < 2:
        return ""
    return "\njudged by " + ", ".join(f"{name} {count:,}" for name, count in judges.items())


def _systems(settings: Mapping[str, Any]) -> str:
    """Return what an iteration of the network's integrator is called."""
    integrator = settings.get("integrator")
    name = integrator.get("name") if isinstance(integrator, Mapping) else None
    return "linear systems" if name == "ImplicitEuler" else "network iterations"


def _iterations(metrics: Mapping[str, Any]) -> list[Row]:
    """Lay out the report's rows on the work of each step."""
    name = f"{_systems(metrics['settings'])} a step"
    mean, most = (_number(metrics["network_iterations"][key]) for key in ("mean", "max"))
    return [(f"{name}, mean", mean, ""), (f"{name}, most", most, "")]


def _physics_lines(physics: Mapping[str, Any] | None) -> dict[str, str]:
    """Lay out the summary's lines on torques and recovery."""
    if physics is None:
        return {}
    torque = f"max {physics['max_torque_share']:.0%} of a joint's limit"
    lines = {"settled error": _fill(_SETTLED, physics), "torque": torque}
    push = physics["push"]
    if push is not None:
        recovery = (
            "never" if push["recovery_s"] is None else f"after {_short(push['recovery_s'])} s"
        )
        lines["push"] = _fill(_PUSHED, push, {"recovery": recovery})
    return lines


def _incident_lines(incidents: Mapping[str, Any]) -> dict[str, str]:
    """Lay out the summary's lines on active bounds, active rows and clipping."""
    found = {key: _spells(incidents, key, text) for key, text in _ACTED.items()}
    lines = {key.replace("_", " "): "\n".join(spells) for key, spells in found.items() if spells}
    if incidents.get("clipped_steps"):
        lines["clipped commands"] = f"at {incidents['clipped_steps']:,} steps"
    return lines


def _spells(incidents: Mapping[str, Any], key: str, text: str) -> list[str]:
    return [_fill(text, spell, {"name": describe(spell)}) for spell in incidents.get(key, ())]


def _incidents(incidents: Mapping[str, Any] | None) -> list[str]:
    """Lay out the report's part on limits and policies."""
    if incidents is None:
        return []
    texts = {key: text + _ON_AVERAGE for key, text in _ACTED.items()}
    texts |= {"blocking": _BLOCKED, "blocking_rows": _BLOCKED}
    lines = [line for key, text in texts.items() for line in _spells(incidents, key, text)]
    counts = markdown_table(_HEAD, _rows(incidents, _INCIDENTS))
    return ["## Limits and policies", counts, *([bullets(lines)] if lines else [])]


def _frames(metrics: Mapping[str, Any]) -> list[Row]:
    """Lay out the report's rows on further frames and levels of priority."""
    rows = []
    for frame, errors in metrics.get("frames", {}).items():
        rows += [(f"{name}, {frame}", *cells) for name, *cells in _rows(errors, _RESULTS)]
    levels = enumerate(metrics.get("level_residual", ()), 1)
    return rows + [(f"largest residual, priority {k}", _number(left), "") for k, left in levels]


def _physics(physics: Mapping[str, Any] | None) -> list[Row]:
    """Lay out the report's rows on torques and recovery."""
    if physics is None:
        return []
    rows = _rows(physics, _PHYSICS)
    torques = zip(physics["max_torque_n_m"], physics["torque_limit_n_m"], strict=True)
    for joint, (torque, limit) in enumerate(torques, 1):
        name = f"largest torque of joint {joint}, limit {_number(limit)}"
        rows.append((name, _number(torque), "N m"))
    push = physics["push"]
    if push is None:
        return rows
    never = {"recovery_s": "never"} if push["recovery_s"] is None else {}
    return rows + _rows(push | never, _PUSH)


def _rows(values: Mapping[str, Any], table: Table) -> list[Row]:
    """Look up the numbers of a table; the units ``kinetic`` and ``angle`` depend on the scheme."""
    settings = values.get("settings", {})
    units = {"kinetic": _kinetic_unit(settings), "angle": _angle_unit(settings)}
    return [
        (name.format_map(values), _number(values[key]), units.get(unit, unit))
        for name, key, unit in table
        if key in values
    ]


def _kinetic_unit(settings: Mapping[str, Any]) -> str:
    """Return the unit of q̇ᵀ G q̇, none where the scheme does not say what G is."""
    scheme = settings.get("scheme")
    kinetic = scheme.get("kinetic") if isinstance(scheme, Mapping) else None
    return _KINETIC_UNITS.get(str(kinetic), "")


def _angle_unit(settings: Mapping[str, Any]) -> str:
    """Return the unit of the orientation error, with a remark where the scheme leaves it free."""
    scheme = settings.get("scheme")
    is_free = isinstance(scheme, Mapping) and scheme.get("orientation") == "none"
    return "rad (orientation free)" if is_free else "rad"


def _named(settings: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Put the settings in words, (name, value)."""
    named = {_SETTINGS.get(key, key.replace("_", " ")): value for key, value in settings.items()}
    if settings.get("rows"):
        counts = Counter(row["part"] for row in settings["rows"])
        named[_SETTINGS["rows"]] = ", ".join(f"{part}: {n}" for part, n in counts.items())
    return [(name, _text(value)) for name, value in named.items()]


def _text(value: object, digits: int = 6, unknown: str = "none") -> str:
    """Put a value in words: 'name = value' pairs, equal entries of a list said once."""
    if isinstance(value, Mapping):
        return ", ".join(f"{key} = {_text(item)}" for key, item in value.items())
    if isinstance(value, list):
        return _list_text(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.{digits}g}"
    if isinstance(value, int):
        return f"{value:,}"
    return unknown if value is None else str(value)


def _list_text(values: list[object]) -> str:
    if len(values) > 1 and all(value == values[0] for value in values):
        return f"{_text(values[0])} (all {len(values)})"
    texts = (f"({_text(v)})" if isinstance(v, Mapping) else _text(v) for v in values)
    return " ".join(texts) or "none"


_number = partial(_text, unknown="unknown")
_short = partial(_text, digits=4, unknown="unknown")
