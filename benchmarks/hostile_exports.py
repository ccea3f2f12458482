"""Exported controllers under hostile targets: sanitizers, limits, and the linear systems of a step.

    python -m benchmarks.hostile_exports [steps of each] [--sanitize]

Each controller of `CHOSEN` takes so many steps (`loops/hostile_loop.c`). With ``--sanitize`` it is
compiled with gcc's address and undefined-behaviour sanitizers, which end the run at a finding. A
line in each function that factors a matrix counts the linear systems; the header states how many
there may be.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.exports import compiled
from benchmarks.report import environment, made_on, tabulate
from iiwa_dnn.export import c99
from tests.export_settings import SETTINGS

CHOSEN = (
    "heart",
    "without a solution: relax",
    "yielding to acceleration and jerk",
    "braking among balls",
    "two arms",
    "inertia",
    "obstacles that move",
)
QUICK = ("-std=c99", "-O2")
SANITIZED = (*QUICK, "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")

_FACTORS = re.compile(r"(static bool \w*cholesky_factor\w*\(double \*K\)\n\{\n)")
_NAMES = ("none", "fallback", "slow", "relax", "stop", "refused", "broken", "systems", "longest")
_COLUMNS = {
    "controller": "{controller}",
    "steps": "{steps:,}",
    "solved": "{none:,}",
    "fallback": "{fallback:,}",
    "slow": "{slow:,}",
    "relax": "{relax:,}",
    "stop": "{stop:,}",
    "refused": "{refused:,}",
    "limits broken": "{broken}",
    "most systems": "{systems}",
    "stated": "{stated}",
    "longest [us]": "{longest}",
}


def hostile_row(name: str, steps: int, flags: tuple[str, ...]) -> dict[str, object]:
    """Export one of `SETTINGS`, drive it so many steps and return its row of the table."""
    controller, q0 = SETTINGS[name]()
    with tempfile.TemporaryDirectory() as place:
        folder = c99(controller, Path(place) / "c", q0, verify=False)
        source = folder / "controller.c"
        text, found = _FACTORS.subn(r"\1    controller_systems++;\n", source.read_text())
        assert found
        source.write_text("long controller_systems;\n" + text)
        stated = re.search(r"CONTROLLER_SYSTEMS (\d+)", (folder / "controller.h").read_text())
        assert stated
        driver = Path(__file__).parent / "loops" / "hostile_loop.c"
        program = compiled(folder, Path(place) / "hostile", flags, driver, source)
        numbers = [*q0.tolist(), *controller.robot.dq_max.tolist()]
        words = [str(program), str(steps), "1", *map(repr, numbers)]
        said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    counts = dict(zip(_NAMES, map(float, said.split()), strict=True))
    row: dict[str, object] = {key: int(value) for key, value in counts.items()}
    return row | {"controller": name, "steps": steps, "stated": int(stated[1])}


def main(steps: int, flags: tuple[str, ...]) -> None:
    """Print the table."""
    print(made_on(environment()), "\n")
    print(tabulate(_COLUMNS, []), flush=True)
    for name in CHOSEN:
        row = tabulate(_COLUMNS, [hostile_row(name, steps, flags)])
        print(row.splitlines()[-1], flush=True)


if __name__ == "__main__":
    sanitize = "--sanitize" in sys.argv
    counts = [int(word) for word in sys.argv[1:] if word.isdigit()]
    main(counts[0] if counts else 100_000, SANITIZED if sanitize else QUICK)
