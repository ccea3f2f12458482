"""What a person reads of a run: the summary on the terminal, and a folder with its report."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from iiwa_dnn.files import prepare_folder, write_json, write_text
from iiwa_dnn.results.incidents import ACTIONS, describe
from iiwa_dnn.results.metrics import compute_metrics, failures
from iiwa_dnn.results.plots import save_figures
from iiwa_dnn.results.record import Record

# How the settings read in the report; one that is not named here keeps its own name.
_SETTINGS = {
    "q_lower": "lower joint limits [rad]",
    "q_upper": "upper joint limits [rad]",
    "dq_max": "velocity limits [rad/s]",
    "q0": "initial joint positions [rad]",
    "dt": "time step [s]",
    "duration": "duration [s]",
    "check": "cross-check",
    "tol": "KKT tolerance",
    "rho": "network time constant [s]",
    "noise": "noise, standard deviation [rad/s, or rad if at measurement]",
    "noise_at": "noise enters at",
    "filter_window": "filter window [steps]",
}
_CAPTIONS = {
    "overview": "Path, joint angles, joint velocities and position error.",
    "path": "Desired and actual path.",
    "joint_angles": "Joint angles.",
    "joint_velocities": "Joint velocities that moved the robot.",
    "torques": "Joint torques: of each step the largest.",
    "moments": "The arm, and below it the path so far, face on.",
    "position_error": "Position error, actual minus desired.",
    "convergence": "KKT residual of the network and gap to the reference: the line is the largest "
    "value, the band the range, of each short stretch of time.",
}
_KINETIC_UNITS = {"identity": "rad²/s²", "inertia": "J"}


def save_run(
    record: Record,
    folder: str | os.PathLike[str],
    plots: bool = True,
    more: Callable[[Record, Path], list[Path]] | None = None,
) -> dict[str, Any]:
    """Write all that a run leaves: record.npz, metrics.json, figures and report.md.

    Each file is written atomically, the record first.

    Args:
        record: The run.
        folder: Where to; made if need be.
        plots: Whether to draw the figures.
        more: Draws more figures into the folder and returns their files.

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
    """Write report.md: verdict, results, cross-check, settings, versions and figures.

    Args:
        record: The run.
        metrics: Its metrics; every number in the report is one of them.
        folder: Where to; it must exist.
        figures: The figures' files in that folder; the PNG ones are shown.

    Returns:
        The file written.

    Raises:
        FileError: If it cannot be written.
    """
    settings, check = metrics["settings"], metrics["crosscheck"]
    parts = [
        f"# {settings['robot']}: {metrics['steps']:,} steps, {settings['mode']}",
        "## Verdict",
        "\n".join(f"- {line}" for line in (failures(record) or [_success(metrics)])),
        "## Results",
        markdown_table(("quantity", "value", "unit"), _results(metrics)),
        "## Cross-check",
        markdown_table(("quantity", "value", "unit"), _crosscheck(check)),
        *_incidents(metrics.get("incidents")),
        *(["Continuous mode: the gap is the network's lag, reported and not judged."]
          if settings["mode"] == "continuous" else []),
        "## Settings",
        markdown_table(
            ("setting", "value"), [(name, _text(value)) for name, value in _named(settings)]
        ),
        "## Versions",
        markdown_table(
            ("package", "version"), [(k, _text(v)) for k, v in metrics["versions"].items()]
        ),
    ]  # fmt: skip
    shown = [path for path in figures if path.suffix == ".png"]
    if shown:
        parts.append("## Figures")
        parts += [f"![{_CAPTIONS.get(path.stem, path.stem)}]({path.name})" for path in shown]
    path = Path(folder) / "report.md"
    write_text(path, "\n\n".join(parts) + "\n")
    return path


def settings_lines(metrics: Mapping[str, Any]) -> str:
    """The settings of a run, one a line, as its report has them.

    Args:
        metrics: The metrics of the run.
    """
    return "\n".join(f"{name}: {_text(value)}" for name, value in _named(metrics["settings"]))


def _named(settings: Mapping[str, Any]) -> list[tuple[str, Any]]:
    return [(_SETTINGS.get(key, key.replace("_", " ")), value) for key, value in settings.items()]


def summary(metrics: Mapping[str, Any], reasons: Sequence[str] | None = None) -> str:
    """Sum up a run in about ten aligned lines of ASCII, for the terminal.

    Args:
        metrics: The metrics of the run.
        reasons: Why it failed, if that is known in more detail than the metrics tell: what
            `failures` says of the record itself.

    Returns:
        The text, without a newline at its end.
    """
    m, settings, check = metrics, metrics["settings"], metrics["crosscheck"]
    reasons = failures(metrics) if reasons is None else reasons
    kinetic_unit = _kinetic_unit(settings).replace("²", "^2")
    checked = "not asked for"
    if check["solver"] != "none":
        gap = f"largest {'gap' if check['judged'] else 'lag (not judged)'}"
        checked = (
            f"{check['solver']}, {check['steps_checked']:,} steps checked, "
            f"{check['disagreements']:,} disagreements, {check['reference_failures']:,} failures\n"
            f"{gap} {_short(check['max_solution_gap'])} rad/s, "
            f"tolerance {_short(check['tolerance'])} rad/s"
        )
    lines = {
        "run": f"{settings['robot']}, {settings['mode']}, {m['steps']:,} steps of "
        f"{_short(m['dt_s'])} s ({_short(m['duration_s'])} s)",
        "position error": f"max {_short(m['max_position_error_m'])} m, "
        f"mean square {_short(m['mse_position_error_m2'])} m^2",
        "orientation error": f"max {_short(m['max_orientation_error_rad'])} rad",
        "joint drift": f"max {_short(m['joint_drift_rad'])} rad",
        "kinetic index": f"max {_short(m['max_kinetic_index'])} {kinetic_unit}",
        "beyond limits": f"{_short(m['position_limit_violation_rad'])} rad, "
        f"{_short(m['velocity_limit_violation_rad_s'])} rad/s",
        **_physics_lines(m.get("physics")),
        **_incident_lines(m.get("incidents")),
        "KKT residual": f"max {_short(m['max_kkt_residual'])}, "
        f"tolerance {_short(settings['tol'])}",
        "cross-check": checked,
        "wall time": f"{_short(m['wall_time_s'])} s, "
        f"{_short(m['realtime_factor'])} x real time",
        "verdict": "\n".join(reasons) or _success(metrics),
    }  # fmt: skip
    width = max(map(len, lines)) + 2
    return "\n".join(
        f"{name:<{width}}" + text.replace("\n", "\n" + " " * width) for name, text in lines.items()
    )


def _physics_lines(physics: Mapping[str, Any] | None) -> dict[str, str]:
    """What a run in physics adds to the summary."""
    if physics is None:
        return {}
    lines = {
        "settled error": f"max {_short(physics['max_position_error_settled_m'])} m "
        f"from {_short(physics['settled_after_s'])} s on",
        "torque": f"max {physics['max_torque_share']:.0%} of a joint's limit",
    }
    push = physics["push"]
    if push is not None:
        recovery = push["recovery_s"]
        back = "never" if recovery is None else f"after {_short(recovery)} s"
        lines["push"] = (
            f"error max {_short(push['max_position_error_m'])} m, "
            f"back within {_short(push['recovered_below_m'])} m {back}"
        )
    return lines


def _incident_lines(incidents: Mapping[str, Any] | None) -> dict[str, str]:
    """What bounds and policies add to the summary."""
    if incidents is None:
        return {}
    lines = {}
    if incidents["active_bounds"]:
        lines["active bounds"] = "\n".join(
            f"{describe(bound)} for {_short(bound['time_s'])} s, "
            f"multiplier up to {_short(bound['max_multiplier'])}"
            for bound in incidents["active_bounds"]
        )
    if incidents["clipped_steps"]:
        lines["clipped commands"] = f"at {incidents['clipped_steps']:,} steps"
    return lines


def _success(metrics: Mapping[str, Any]) -> str:
    """The verdict on a run without failures, no stronger than what was checked."""
    check, steps = metrics["crosscheck"], f"{metrics['steps']:,}"
    if check["solver"] == "none":
        return "completed within all limits; no reference solver was asked"
    if not check["judged"]:
        failed = check["reference_failures"]
        doubt = f"; {failed:,} reference answers not to be believed" if failed else ""
        lag = f"the gap to {check['solver']} is a lag, not judged"
        return f"completed within all limits; {lag}{doubt}"
    return f"all {steps} steps solved, within all limits and in agreement with {check['solver']}"


def _results(metrics: Mapping[str, Any]) -> list[Sequence[str]]:
    rows = (
        ("largest position error", "max_position_error_m", "m"),
        ("mean squared position error, over samples and axes", "mse_position_error_m2", "m²"),
        ("largest orientation error", "max_orientation_error_rad", "rad"),
        ("joint drift, start to end", "joint_drift_rad", "rad"),
        ("largest kinetic index", "max_kinetic_index", _kinetic_unit(metrics["settings"])),
        ("largest KKT residual", "max_kkt_residual", ""),
        ("beyond position limits", "position_limit_violation_rad", "rad"),
        ("beyond velocity limits", "velocity_limit_violation_rad_s", "rad/s"),
        ("steps", "steps", ""),
        ("time step", "dt_s", "s"),
        ("time simulated", "duration_s", "s"),
        ("wall time", "wall_time_s", "s"),
        ("time simulated / wall time", "realtime_factor", ""),
    )
    return [
        *((name, _number(metrics[key]), unit) for name, key, unit in rows),
        *(_physics(metrics["physics"]) if "physics" in metrics else []),
    ]


def _incidents(incidents: Mapping[str, Any] | None) -> list[str]:
    """Which bounds acted and at what cost, and what policies and clipping did."""
    if incidents is None:
        return []
    counts = [("steps with a clipped command", "clipped_steps", "")]
    counts += [(f"steps: {name}", f"{name}_steps", "") for name in ACTIONS.values()]
    counts += [("path time reached", "path_time_s", "s")]
    parts = [
        "## Limits and policies",
        markdown_table(
            ("quantity", "value", "unit"),
            [(name, _number(incidents[key]), unit) for name, key, unit in counts],
        ),
    ]
    for title, key in (("active bound", "active_bounds"), ("in the way", "blocking")):
        bounds = incidents[key]
        if not bounds:
            continue
        head = [title, "steps", "time [s]", "from [s]"]
        rows = [
            [describe(bound), *(_number(bound[part]) for part in ("steps", "time_s", "first_s"))]
            for bound in bounds
        ]
        if key == "active_bounds":
            head += ["largest multiplier", "mean multiplier"]
            for row, bound in zip(rows, bounds, strict=True):
                row += [_number(bound[part]) for part in ("max_multiplier", "mean_multiplier")]
        parts.append(markdown_table(head, rows))
    return parts


def _physics(physics: Mapping[str, Any]) -> list[Sequence[str]]:
    since = f"largest position error from {physics['settled_after_s']:g} s on"
    rows: list[Sequence[str]] = [
        (since, _number(physics["max_position_error_settled_m"]), "m"),
        *(
            (f"largest torque of joint {joint}, limit {_number(limit)}", _number(torque), "N m")
            for joint, (torque, limit) in enumerate(
                zip(physics["max_torque_n_m"], physics["torque_limit_n_m"], strict=True), 1
            )
        ),
    ]
    push = physics["push"]
    if push is not None:
        back = f"time from the push's end until back within {push['recovered_below_m']:g} m"
        recovery = "never" if push["recovery_s"] is None else _number(push["recovery_s"])
        rows += [
            ("largest position error since the push", _number(push["max_position_error_m"]), "m"),
            (back, recovery, "s"),
        ]
    return rows


def _crosscheck(check: Mapping[str, Any]) -> list[Sequence[str]]:
    rows = (
        ("steps checked", "steps_checked", ""),
        ("steps that disagree", "disagreements", ""),
        ("reference answers not to be believed", "reference_failures", ""),
        ("largest gap in the solution", "max_solution_gap", "rad/s"),
        ("tolerance on it", "tolerance", "rad/s"),
        ("largest gap in the objective", "max_objective_gap", ""),
        ("largest residual of a reference", "max_reference_residual", ""),
    )
    return [
        ("reference solver", check["solver"], ""),
        *((name, _number(check[key]), unit) for name, key, unit in rows),
    ]


def _kinetic_unit(settings: Mapping[str, Any]) -> str:
    """The unit of q̇ᵀ G q̇, which follows from what G is."""
    scheme = settings.get("scheme")
    kinetic = scheme.get("kinetic") if isinstance(scheme, Mapping) else None
    return _KINETIC_UNITS.get(str(kinetic), "")


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown, its cells made fit to stand in one."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(_cell(text) for text in line) + " |" for line in lines)


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _number(value: float | None) -> str:
    if value is None:
        return "unknown"
    return f"{value:,}" if isinstance(value, int) else f"{value:.6g}"


def _short(value: float | None) -> str:
    return _number(value) if value is None else f"{value:.4g}"


def _text(value: object) -> str:
    """A setting in words: 'name = value' pairs, and equal entries of a list said once."""
    if isinstance(value, Mapping):
        return ", ".join(f"{key} = {_text(item)}" for key, item in value.items())
    if isinstance(value, list):
        if len(value) > 1 and all(item == value[0] for item in value):
            return f"{_text(value[0])} (all {len(value)})"
        return " ".join(_text(item) for item in value) or "none"
    if isinstance(value, bool) or value is None:
        return "none" if value is None else str(value).lower()
    return _number(value) if isinstance(value, int | float) else str(value)
