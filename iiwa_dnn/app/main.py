"""``iiwa-dnn COMMAND``: which command it is, and the list of them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Annotated, Any, NamedTuple, Union

import tyro

from iiwa_dnn.app.command_line import unknown_command
from iiwa_dnn.app.settings import (
    NoiseSettings,
    PaperSettings,
    PhysicsSettings,
    SolveSettings,
    TrackSettings,
    ViewSettings,
)

PROG = "iiwa-dnn"


class Entry(NamedTuple):
    """One command.

    Attributes:
        function: ``module.name`` in this package, imported when it is called; the function takes
            the arguments and ``prog``.
        settings: What it can be told.
        help: What it does, in a few words.
    """

    function: str
    settings: type[Any]
    help: str


# A new command is a line here, its dataclass in settings.py, and its function.
COMMANDS = {
    "track": Entry("track.track_heart", TrackSettings, "draw the heart, every step checked"),
    "paper": Entry("paper.reproduce_paper", PaperSettings, "run the paper's experiments"),
    "noise": Entry("noise.study_noise", NoiseSettings, "compare the means against noise"),
    "physics": Entry("physics.simulate_physics", PhysicsSettings, "draw the heart in MuJoCo"),
    "view": Entry("view.view", ViewSettings, "replay a run in the browser, or drive live"),
    "solve": Entry("solve.solve", SolveSettings, "solve the quadratic program in a file"),
}
SHELLS = ("bash", "zsh", "tcsh")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command that the arguments name.

    Args:
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        The command's exit code.

    Raises:
        SystemExit: With code 2, after one line on standard error, for an unknown command.
    """
    name, *rest = (sys.argv[1:] if arguments is None else arguments) or ["--help"]
    if name in ("-h", "--help"):
        print(_help())
        return 0
    if name == "--version":
        print(PROG, import_module("iiwa_dnn").__version__)
        return 0
    if name == "completion":
        return _completion(*rest)
    if name not in COMMANDS:
        unknown_command(PROG, name, (*COMMANDS, "completion"))
    module, _, function = COMMANDS[name].function.rpartition(".")
    run: Callable[..., int] = getattr(import_module(f"iiwa_dnn.app.{module}"), function)
    return run(rest, prog=f"{PROG} {name}")


def _help() -> str:
    rows = [(name, entry.help) for name, entry in COMMANDS.items()]
    rows.append(("completion", f"print completion for a shell: {', '.join(SHELLS)}"))
    listed = "\n".join(f"  {name:<12}{text}" for name, text in rows)
    return (
        f"usage: {PROG} COMMAND [OPTIONS]\n\nRobot arms driven by dynamic neural networks that "
        f"solve a quadratic program at\nevery control step.\n\n{listed}\n\n"
        f"{PROG} COMMAND --help lists the command's options."
    )


def _completion(*shell: str) -> int:
    if len(shell) != 1 or shell[0] not in SHELLS:
        unknown_command(f"{PROG} completion", " ".join(shell), SHELLS)
    kinds: Any = tuple(
        Annotated[entry.settings, tyro.conf.subcommand(name)] for name, entry in COMMANDS.items()
    )
    tyro.cli(Union[kinds], prog=PROG, args=["--tyro-print-completion", shell[0]])  # noqa: UP007
    return 0
