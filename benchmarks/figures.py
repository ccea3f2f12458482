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

JUDGES = (("controller",), ("shield",), ("controller", "--exported"), ("shield", "--exported"))
"""Words of tests/hostile.py, a judge of hostile motion whose last lines sum up."""


def report(steps: int) -> int:
    """Print all reports; returns 1 where a command failed or a judge found a limit broken."""
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for title, words in STUDIES.items():
            out = Path(folder) / words[0]
            failed |= run("-m", "iiwa_dnn", *words, "--out", str(out), "-q").returncode
            print(f"\n## {title}\n\n{(out / 'report.md').read_text(encoding='utf-8')}", flush=True)
    for kind, *words in JUDGES:
        done = run("tests/hostile.py", kind, str(10 * steps), *words)
        failed |= done.returncode
        print(f"\n## Hostile motion: {' '.join([kind, *words])}\n")
        print(*done.stdout.splitlines()[-8:], sep="\n", flush=True)
    return int(failed != 0)


def run(*words: str) -> "subprocess.CompletedProcess[str]":
    """Run Python with words."""
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False)
