"""Tables, lists and pictures in Markdown, and tables for papers."""

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from tabulate import tabulate

from iiwa_dnn.files import write_text


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Lay out a table of texts in Markdown, its cells made fit to stand in one."""
    cells = [[" ".join(str(text).split()).replace("|", "\\|") for text in row] for row in rows]
    table = tabulate(cells, head, "pipe", disable_numparse=True)
    return re.sub("  +", " ", re.sub("--+", "---", table))  # without the padding


def save_markdown(folder: str | os.PathLike[str], parts: Iterable[str]) -> Path:
    """Write parts as report.md into a folder, and return the file; raises FileError."""
    path = Path(folder) / "report.md"
    write_text(path, "\n\n".join(parts) + "\n")
    return path


def number(value: float | None, form: str = ".4g", unknown: str = "unknown") -> str:
    """Write a number in a format, if there is one."""
    return unknown if value is None else format(value, form)


def bullets(lines: Iterable[str]) -> str:
    """Lay out a list in Markdown."""
    return "\n".join(f"- {line}" for line in lines)


def show_figures(figures: Iterable[Path], captions: Mapping[str, str]) -> list[str]:
    """Show the PNG files among some figures in Markdown, with captions by the files' stems."""
    shown = [path for path in figures if path.suffix == ".png"]
    named = ((path.stem.replace("_", " ").capitalize() + ".", path) for path in shown)
    pictures = [f"![{captions.get(path.stem, name)}]({path.name})" for name, path in named]
    return ["## Figures", *pictures] if shown else []
