"""``iiwa-dnn COMMAND``: the command line of the package."""

import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from importlib.metadata import version
from typing import Annotated, Any, Union

import tyro

from iiwa_dnn.app.command_line import fail, run_command
from iiwa_dnn.app.options import COMMANDS
from iiwa_dnn.errors import NotFoundError

PROG = "iiwa-dnn"


def main(words: Sequence[str] | None = None) -> int:
    """Run a command by its words; None: the words of the process.

    Returns:
        The command's exit code; 2 for an unknown command, after one line on standard error.

    Raises:
        SystemExit: As in `iiwa_dnn.app.command_line.run_command`.
    """
    name, *rest = (sys.argv[1:] if words is None else words) or ["--help"]
    if name in COMMANDS:
        return run(name, rest)
    if name == "--version":
        print(PROG, version(PROG))
    elif name in ("-h", "--help"):
        describe_commands("--help")
    else:
        return fail(PROG, NotFoundError("command", name, COMMANDS))
    return 0


def run(name: str, words: Sequence[str] | None = None, prog: str | None = None) -> int:
    """Run one of `COMMANDS`, the function ``run`` of the module of its name; as `run_command`."""
    module = import_module(f"iiwa_dnn.app.{name.replace('-', '_')}")
    return run_command(COMMANDS[name], prog or f"{PROG} {name}", module.run, words)


def describe_commands(*words: str) -> None:
    """Print the list of all commands, or their completion for a shell, by tyro's own options."""
    kinds: Any = tuple(
        Annotated[kind, tyro.conf.subcommand(name, description=str(kind.__doc__).splitlines()[0])]
        for name, kind in COMMANDS.items()
    )
    about = "Robot arms driven by dynamic neural networks that solve a program at every step."
    with suppress(SystemExit):
        tyro.cli(Union[kinds], prog=PROG, description=about, args=words)  # noqa: UP007
