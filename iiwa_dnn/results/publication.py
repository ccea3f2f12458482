"""Tables for papers: one table as Markdown, CSV and LaTeX."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tabulate import tabulate

from iiwa_dnn.files import write_text
from iiwa_dnn.results.markdown import markdown_table


class Table(NamedTuple):
    """A table of texts.

    Attributes:
        name: Name of its files.
        caption: Caption.
        head: Heads of the columns.
        rows: Rows, each as long as the head.
    """

    name: str
    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> str:
        """Lay the table out in Markdown, below its caption."""
        return f"## {self.caption}\n\n{markdown_table(self.head, self.rows)}"

    def save(self, folder: Path) -> None:
        """Write ``NAME.csv`` and, for the package booktabs, ``NAME.tex``; raises FileError."""
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([self.head, *self.rows])
        write_text(folder / f"{self.name}.csv", text.getvalue())
        sides = ["left", *["right"] * (len(self.head) - 1)]
        table = tabulate(
            self.rows, self.head, "latex_booktabs", disable_numparse=True, colalign=sides
        )
        table = table.replace("ξ", r"$\xi$").replace("–", "--")
        write_text(folder / f"{self.name}.tex", f"% {self.caption}\n{table}\n")
