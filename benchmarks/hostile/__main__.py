"""A benchmark of filters between requests and an arm: ``python -m benchmarks.hostile``.

``python -m benchmarks.hostile shield clamp`` runs two, ``my_filter.py`` one of your own;
``cbfpy=/path/to/python`` names the Python that has a contender's library. docs/hostile.md has the
tables. Each failure is printed with the words that play it again.
"""

import argparse
import json
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from benchmarks.hostile.arms import FOLDER, Arm
from benchmarks.hostile.contenders import ADAPTERS, Contender, drive
from benchmarks.hostile.families import FAMILIES
from benchmarks.hostile.judges import Score, judge

STEPS = 1000
"""Steps of a run, of 2 ms."""

MEDIANS = ("lag", "amplitude", "error", "away", "frozen", "p50", "p99")
"""Scores of which a table has the median of the runs."""


def main() -> int:
    """Run the contenders; print a table for each family. Returns 1 if one could not begin."""
    parser = argparse.ArgumentParser("python -m benchmarks.hostile", description=__doc__)
    known = sorted(file.stem for file in ADAPTERS.glob("*.py"))
    words = f"{', '.join(known)}, or a file; NAME=PYTHON: by another Python (default: all)"
    parser.add_argument("contenders", nargs="*", metavar="contender", help=words)
    parser.add_argument("--families", nargs="+", choices=FAMILIES, default=[*FAMILIES])
    arms = sorted(file.stem for file in FOLDER.glob("*.json"))
    parser.add_argument("--arms", nargs="+", choices=arms, default=arms)
    parser.add_argument("--seeds", nargs="+", type=int, default=[*range(10)])
    parser.add_argument("--steps", type=int, default=STEPS, help="steps of a run, of 2 ms")
    parser.add_argument("--json", type=Path, help="write all scores into this file")
    options = parser.parse_args()
    scores: dict[str, dict[str, list[Score]]] = {}
    for each in options.contenders or known:
        name, _, python = each.partition("=")
        file = Path(name) if name.endswith(".py") else ADAPTERS / f"{name}.py"
        if not file.exists():
            parser.error(f"there is no contender {name!r}; there are {', '.join(known)}")
        runs = measure(file.resolve(), python or sys.executable, options)
        if runs:
            scores[file.stem] = runs
    for family in options.families:
        show(family, {name: runs[family] for name, runs in scores.items()})
    summarize(scores, options.families)
    if options.json:
        plain = {
            name: {f: [s._asdict() for s in r] for f, r in x.items()} for name, x in scores.items()
        }
        options.json.write_text(json.dumps(plain), encoding="utf-8")
    return int(len(scores) < len(options.contenders or known))


def measure(file: Path, python: str, options: argparse.Namespace) -> dict[str, list[Score]]:
    """Run a contender through the families; print what breaks. Nothing if it cannot begin."""
    runs: dict[str, list[Score]] = {}
    contender = Contender(file, python)
    shown = file.stem if file.parent == ADAPTERS else str(file)
    for family in options.families:
        about = FAMILIES[family]
        runs[family] = []
        for name in options.arms:
            arm = Arm(name)
            for seed in options.seeds:
                try:
                    run = drive(contender, arm, about, seed, options.steps)
                except RuntimeError as error:
                    print(f"{file.stem} could not begin: {error}", file=sys.stderr)
                    contender.close()
                    return {}
                if run.problem:
                    print(f"{file.stem}: {run.problem}", file=sys.stderr)
                    contender.close()
                    contender = Contender(file, python)
                score = judge(arm, run, about.person, arm.data["payload"] * about.payload)
                runs[family].append(score)
                broken = score.broken(about.person, about.payload)
                if broken:
                    again = f"--families {family!r} --arms {name} --seeds {seed}"
                    again = f"{shown} {again} --steps {options.steps}"
                    print(f"{file.stem}: {', '.join(broken)}: {again}", file=sys.stderr)
    contender.close()
    return runs


def show(family: str, scores: dict[str, list[Score]]) -> None:
    """Print a family's table in Markdown."""
    about = FAMILIES[family]
    source = f" ({about.source})" if about.source else ""
    print(f"\n## {family}: {about.about}{source}\n")
    columns = ["contender", "runs broken", "worst", "lag, amplitude", "error"]
    columns += ["from the request", "frozen", "median", "p99"]
    print(f"| {' | '.join(columns)} |\n|{' --- |' * len(columns)}")
    for name, runs in scores.items():
        print(f"| {name} | {' | '.join(cells(runs, about.person, about.payload))} |")


def summarize(scores: dict[str, dict[str, list[Score]]], families: list[str]) -> None:
    """Print for all contenders in how many runs of each family something is broken."""
    print(f"\n## Runs in which something is broken\n\n| family | {' | '.join(scores)} |")
    print(f"|{' --- |' * (len(scores) + 1)}")
    for family in families:
        about = FAMILIES[family]
        row = [letters(runs[family], about.person, about.payload) for runs in scores.values()]
        print(f"| {family} | {' | '.join(row)} |")


def letters(runs: list[Score], has_person: bool, has_payload: bool) -> str:
    """Count the runs in which something is broken; name what by its first letter."""
    broken = [run.broken(has_person, has_payload) for run in runs]
    kinds = sorted({kind[0] for each in broken for kind in each})
    return f"{sum(map(bool, broken))} {' '.join(kinds)}".strip()


def cells(runs: list[Score], has_person: bool, has_payload: bool) -> Iterable[str]:
    """Yield the cells of a contender's row."""
    if not runs:
        yield from ["no run"] + [""] * 7
        return
    broken = [run.broken(has_person, has_payload) for run in runs]
    kinds = sorted({kind for each in broken for kind in each})
    yield f"{sum(map(bool, broken))} of {len(runs)}"
    yield ", ".join(worst(kind, runs) for kind in kinds)
    median = {name: np.median([getattr(run, name) for run in runs]) for name in MEDIANS}
    has_lag = np.isfinite(median["lag"])
    yield f"{median['lag']:.0f} ms, {median['amplitude']:.2f}" if has_lag else ""
    yield f"{median['error']:.1f} mrad" if has_lag else ""
    yield f"{median['away']:.2f}"
    yield f"{100 * median['frozen']:.0f} %"
    yield f"{median['p50']:.0f} us"
    yield f"{median['p99']:.0f} us"


def worst(kind: str, runs: list[Score]) -> str:
    """Say how much a limit of a kind is broken at most."""
    if kind == "position":
        return f"position by {max(run.position for run in runs):.2g} rad"
    if kind == "distance":
        return f"distance {1e3 * min(run.nearest for run in runs):.0f} mm"
    if kind == "contact":
        return f"contact in {sum(run.contacts for run in runs)} steps"
    if kind == "unasked motion":
        return f"motion unasked in {sum(run.unasked > 0 for run in runs)} runs"
    if kind == "no answer":
        return f"no answer in {sum(bool(run.problem) for run in runs)} runs"
    return f"{kind} {max(getattr(run, kind) for run in runs):.3g} of 1"


if __name__ == "__main__":
    sys.exit(main())
