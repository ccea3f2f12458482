"""Tables in Markdown."""

import re
from collections.abc import Iterable, Sequence

from tabulate import tabulate


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Lay out a table of texts in Markdown, its cells made fit to stand in one."""
    cells = [[" ".join(str(text).split()).replace("|", "\\|") for text in row] for row in rows]
    table = tabulate(cells, head, "pipe", disable_numparse=True)
    return re.sub("  +", " ", re.sub("--+", "---", table))  # without the padding
