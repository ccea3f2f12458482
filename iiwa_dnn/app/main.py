"""``iiwa-dnn COMMAND``: the command line of the package."""

import sys
from collections.abc import Sequence
from functools import partial
from importlib.metadata import version
from typing import Any

from tyro.conf import FlagCreatePairsOff, OmitArgPrefixes
from tyro.extras import subcommand_cli_from_dict

from iiwa_dnn.app.collisions import collisions
from iiwa_dnn.app.command_line import guard
from iiwa_dnn.app.replay import replay, view
from iiwa_dnn.app.sweeps import atlas, paper
from iiwa_dnn.app.track import export, physics, track

PROG = "iiwa-dnn"
CONFIG = (OmitArgPrefixes, FlagCreatePairsOff)
COMMANDS: dict[str, Any] = {
    "track": track,
    "physics": physics,
    "export": export,
    "paper": paper,
    "atlas": atlas,
    "view": view,
    "replay": replay,
    "collisions": collisions,
}


def main(words: Sequence[str] | None = None) -> int:
    """Run a command with its arguments; None: those of the process.

    Returns:
        The command's exit code.

    Raises:
        SystemExit: As in `iiwa_dnn.app.command_line.guard`.
    """
    given = list(sys.argv[1:] if words is None else words) or ["--help"]
    if given == ["--version"]:
        print(PROG, version(PROG))
        return 0
    about = "Robot arms driven by dynamic neural networks that solve a program at every step."
    read = partial(subcommand_cli_from_dict, COMMANDS, prog=PROG, description=about)
    return guard(f"{PROG} {given[0]}", partial(read, args=given, config=CONFIG))
