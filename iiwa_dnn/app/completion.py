"""``completion``: a shell's completion of commands and options."""

from iiwa_dnn.app.main import describe_commands
from iiwa_dnn.app.options import SHELLS, CompletionOptions
from iiwa_dnn.errors import NotFoundError


def run(options: CompletionOptions) -> int:
    """Print the completion script for a shell; return the exit code."""
    if options.shell not in SHELLS:
        raise NotFoundError("shell", options.shell, SHELLS)
    describe_commands("--tyro-write-completion", options.shell, "-")
    return 0
