"""``atlas``: every network, scheme and disturbance at equal work, with tables and verdicts."""

import time

from iiwa_dnn.app.command_line import run_sweep
from iiwa_dnn.app.words import SweepWords
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.studies import atlas
from iiwa_dnn.studies.atlas_report import report, tabulate


def run(words: SweepWords, size: atlas.Size) -> int:
    """Run the atlas, write tables and report, and return the exit code."""
    began = time.perf_counter()
    trials = atlas.gain_cells(size)
    gains = atlas.best_gains(trials, run_sweep(words, "atlas", atlas.measure, trials)[1])
    cells = atlas.cells(size, gains)
    folder, results = run_sweep(words, "atlas", atlas.measure, cells)
    rows = tabulate(cells, results)
    write_json(folder / "atlas.json", rows)
    runs = sum(cell.seeds for cell in cells) + len(trials)
    head = (
        f"{runs} runs of {atlas.DURATION:g} s in {time.perf_counter() - began:.0f} s; "
        f"{size.seeds} seeds with the first scheme, {size.others} with the others and at the other "
        "budgets, on heart, circle and Lissajous figure in turn; errors of each run's second half."
    )
    text = report(folder, size, rows, head)
    write_text(folder / "report.md", text)
    if not words.quiet:
        print(text)
    return 0
