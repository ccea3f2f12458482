"""The figures of the pages that are no times of steps: runs, studies and hostile motion."""

import subprocess
import sys
import tempfile
from pathlib import Path

STUDIES = {
    "The heart": ("track", "heart", "--dt", "1e-4"),
    "The paper's tables": ("paper",),
    "The league": ("atlas",),
}
"""Commands whose reports are quoted, by their titles."""

JUDGES = {
    "Hostile targets of controllers": ("tests/hostile.py", "controller", "{steps}"),
    "Hostile requests of shields": ("tests/hostile.py", "shield", "{steps}"),
    "Controllers in C": ("tests/hostile.py", "controller", "{steps}", "--exported"),
    "Shields in C": ("tests/hostile.py", "shield", "{steps}", "--exported"),
}
"""Judges of hostile motion by their titles; their last lines sum up."""


def report(steps: int) -> int:
    """Print all reports; returns 1 where a command failed or a judge found a limit broken."""
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for title, words in STUDIES.items():
            out = Path(folder) / words[0]
            failed |= run("-m", "iiwa_dnn", *words, "--out", str(out), "-q").returncode
            print(f"\n## {title}\n\n{(out / 'report.md').read_text(encoding='utf-8')}", flush=True)
    for title, words in JUDGES.items():
        done = run(*(word.format(steps=10 * steps) for word in words))
        failed |= done.returncode
        print(f"\n## {title}\n", *done.stdout.splitlines()[-8:], sep="\n", flush=True)
    return int(failed != 0)


def run(*words: str) -> "subprocess.CompletedProcess[str]":
    """Run Python with words."""
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False)
