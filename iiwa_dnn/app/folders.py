"""Folders of runs: each belongs to the run that its settings file describes.

That run may write it again, no other one may unasked.
"""

import os
from collections.abc import Collection, Sequence
from dataclasses import fields
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomli_w

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import read_settings
from iiwa_dnn.app.options import RunOptions, SweepOptions
from iiwa_dnn.errors import FileError, IiwaDnnError
from iiwa_dnn.files import one_line, prepare_folder, write_text
from iiwa_dnn.studies.sweeps import Settings, Sweep, Task

SETTINGS_FILE = "settings.toml"
"""Name of the settings in a run's folder."""

# Options of the output: they are not kept in the settings file.
_NOT_KEPT = {"settings", "out", "overwrite", "quiet", "verbose"}
# Options that are kept, though a run with other values is the same run.
_NOT_COMPARED = {"csv", "plots", "pictures", "video", "workers", "dask"}


def claim_folder(options: RunOptions, resumes: Collection[str] = ()) -> Path:
    """Prepare the folder of a run, unless it holds anything but an earlier pass of the same run.

    With ``overwrite`` it may hold anything, and in any case what is named in `resumes`: from there
    a sweep goes on, even one of another size, since its finished cells stay.

    Raises:
        FileError: The folder holds something else, or cannot be written to.
    """
    folder = options.out
    if folder.is_dir() and not options.overwrite:
        foreign = _names_in(folder) - set(resumes)
        file = options.settings
        if file is not None and file.parent.resolve() == folder.resolve():
            foreign -= {file.name} - {SETTINGS_FILE}
        kept = _kept_values(folder, options)
        is_own = kept is not None and (bool(resumes) or _is_same_run(kept, _values(options)))
        if foreign and not is_own:
            hint = "choose another --out, or --overwrite"
            raise FileError(folder, f"holds another run or other files: {hint}")
    return prepare_folder(folder)


def _names_in(folder: Path) -> set[str]:
    """Return the names of the files in a folder, without hidden ones."""
    try:
        return {path.name for path in folder.iterdir() if not path.name.startswith(".")}
    except OSError as error:
        raise FileError(folder, f"cannot be read ({one_line(error)})") from error


def save_settings(options: RunOptions, folder: Path) -> Path:
    """Write ``settings.toml`` into a run's folder, from which ``--settings`` repeats the run.

    Options of output and folder are left out. A file that describes the same run
    already is left as it is, since a person may have written it.

    Raises:
        FileError: If it cannot be written.
    """
    values = _values(options)
    if not _is_same_run(_kept_values(folder, options), values):
        head = f"# iiwa_dnn {version('iiwa-dnn')}; to repeat the run: --settings with this file"
        text = f"{head}\n\n{tomli_w.dumps({'command': options.command, **values})}"
        write_text(folder / SETTINGS_FILE, text)
    return folder / SETTINGS_FILE


def run_sweep(
    options: SweepOptions, task: Task, cells: Sequence[Settings], dask: str | None = None
) -> tuple[Sweep, list[dict[str, Any]]]:
    """Compute the cells of a sweep in a command's folder, and save the command's settings there.

    Finished cells stay in ``cells``, from where an interrupted sweep goes on; errors as of
    `claim_folder` and `Sweep.run`.
    """
    checks.integer("workers", 1 if options.workers is None else options.workers, 1)
    sweep = Sweep(task, claim_folder(options, resumes=("cells",)) / "cells")
    results = sweep.run(cells, workers=options.workers, dask=dask, quiet=options.quiet)
    save_settings(options, options.out)
    return sweep, results


def _kept_values(folder: Path, options: RunOptions) -> dict[str, Any] | None:
    """Return the values in a folder's settings file; None unless the same command wrote it."""
    try:
        return _values(read_settings(type(options), folder / SETTINGS_FILE))
    except IiwaDnnError:
        return None


def _is_same_run(kept: dict[str, Any] | None, values: dict[str, Any]) -> bool:
    """Compare kept values, None for none, with those of a run."""
    if kept is None:
        return False
    return all(kept.get(key) == values.get(key) for key in {*kept, *values} - _NOT_COMPARED)


def _values(options: RunOptions) -> dict[str, Any]:
    """Return the values of the options that a settings file keeps, with absolute paths."""
    values: dict[str, Any] = {}
    for field in fields(options):
        value = getattr(options, field.name)
        if field.name in _NOT_KEPT or value is None or value == ():
            continue
        names_file = field.name in ("robot", "reference") and (
            os.sep in value or value.endswith((".urdf", ".xacro", ".csv"))
        )
        if isinstance(value, Path) or names_file:
            value = str(Path(value).resolve())
        values[field.name] = list(value) if isinstance(value, tuple) else value
    return values
