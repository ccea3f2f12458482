"""Tables for papers: one table as Markdown, CSV and LaTeX."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from iiwa_dnn.files import write_text
from iiwa_dnn.results.markdown import markdown_table

_LATEX = str.maketrans(
    {"_": r"\_", "%": r"\%", "&": r"\&", "#": r"\#", "–": "--", "ξ": r"$\xi$", "^": r"\^{}"}
)


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

    def latex(self) -> str:
        """Lay the table out in LaTeX, with the rules of the package booktabs."""
        lines = [" & ".join(text.translate(_LATEX) for text in line) + r" \\" for line in self.rows]
        head = " & ".join(text.translate(_LATEX) for text in self.head) + r" \\"
        columns = "l" + "r" * (len(self.head) - 1)
        begin = rf"\begin{{tabular}}{{{columns}}}"
        body = "\n".join([begin, r"\toprule", head, r"\midrule", *lines, r"\bottomrule"])
        return f"% {self.caption}\n{body}\n\\end{{tabular}}\n"

    def save(self, folder: Path) -> None:
        """Write ``NAME.csv`` and ``NAME.tex`` into a folder; raises FileError."""
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([self.head, *self.rows])
        write_text(folder / f"{self.name}.csv", text.getvalue())
        write_text(folder / f"{self.name}.tex", self.latex())
