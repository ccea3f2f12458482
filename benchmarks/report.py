"""Tables in Markdown, and the machine that the figures in them are of."""

import datetime
import os
import platform
import re
from collections.abc import Iterable, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from tabulate import tabulate

_PACKAGES = ("iiwa-dnn", "numpy", "pin", "daqp", "osqp", "piqp", "proxsuite", "pin-pink", "mink")


def machine() -> str:
    """Return date, processor, cores and versions in a sentence."""
    file = Path("/proc/cpuinfo")
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    found = re.search(r"(?m)^model name\s*:\s*(.+)$", text)
    processor = found[1].strip() if found else platform.machine()
    today = datetime.datetime.now(tz=datetime.timezone.utc).date()
    cores = f"{os.cpu_count()} cores, Python {platform.python_version()}"
    return ", ".join([f"{today}, {processor}", cores, *filter(None, map(_version, _PACKAGES))])


def _version(name: str) -> str:
    try:
        return f"{name} {version(name)}"
    except PackageNotFoundError:
        return ""


def show(title: str, columns: Mapping[str, str], rows: Iterable[Mapping[str, Any]]) -> None:
    """Print a table, each row when it is there: columns are formats of the rows' values."""
    print(f"\n## {title}\n")
    print(tabulate([], [*columns], "pipe"), flush=True)
    for row in rows:
        cells = [text.format_map(row) for text in columns.values()]
        print(f"| {' | '.join(cells)} |", flush=True)
