"""``iiwa-dnn COMMAND``: the command line of the package."""

import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Literal

from tyro.conf import FlagCreatePairsOff, OmitArgPrefixes, Positional, arg
from tyro.extras import subcommand_cli_from_dict

from iiwa_dnn.app.command_line import guard
from iiwa_dnn.app.words import OPTIONS, Count, Flag, Number, Run, SweepWords, shown

PROG = "iiwa-dnn"
CONFIG = (OmitArgPrefixes, FlagCreatePairsOff)
Names = Annotated[tuple[str, ...], shown("NAME ...")]
Sweeping = Annotated[SweepWords, arg(help="")]  # its title says enough
EVERY = SweepWords()


def paper(
    sweep: Sweeping = EVERY,
    *,
    quick: Flag = False,
    seeds: Count = None,
    duration: Number = None,
    table: Annotated[Literal["1", "2"] | None, shown("N")] = None,
    weights: Annotated[tuple[float, ...], shown("X ...")] = (),
) -> int:
    """Run every experiment of the paper, each number beside the paper's.

    Args:
        sweep: words of all sweeps
        quick: run 1 s and 5 seeds only, to see that all works
        seeds: number of noises in Table II (100)
        duration: length of each run [s] (10)
        table: table of the paper to run alone, 1 or 2 (everything)
        weights: weights xi in [0, 1] of the columns of Table I (all)
    """
    from iiwa_dnn.app import sweeps
    from iiwa_dnn.studies import runs

    scope = runs.QUICK if quick else runs.FULL
    given = {"seeds": seeds, "duration": duration, "weights": weights or None}
    changes: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    return sweeps.paper(sweep, replace(scope, **changes), f"table{table}" if table else None)


def atlas(
    sweep: Sweeping = EVERY,
    *,
    whole: Flag = False,
    seeds: Count = None,
    other_seeds: Count = None,
    networks: Names = (),
    schemes: Names = (),
    disturbances: Names = (),
    work: Annotated[float, shown("X")] = 1e4,
) -> int:
    """Compare the networks of the field, and yours, at equal work.

    A network of one's own is named as module:NAME or file.py:NAME.

    Args:
        sweep: words of all sweeps
        whole: run 100 seeds and all schemes: hours in place of minutes
        seeds: number of noises with the first scheme (5, whole: 100)
        other_seeds: number of noises with the other schemes (3)
        networks: networks (every one; beside your own too)
        schemes: schemes (the first; whole: every one)
        disturbances: disturbances beside the undisturbed runs (every one)
        work: work a control period [operations] (1e4)
    """
    from iiwa_dnn.app import sweeps
    from iiwa_dnn.studies.atlas import NETWORKS, SCHEMES, Size

    if NETWORKS.keys().isdisjoint(networks):  # one's own beside all others
        networks = (*NETWORKS, *networks)
    few = Size()
    size = Size(
        networks=networks,
        schemes=schemes or (tuple(SCHEMES) if whole else few.schemes),
        disturbances=disturbances or few.disturbances,
        work=work,
        seeds=(100 if whole else few.seeds) if seeds is None else seeds,
        others=few.others if other_seeds is None else other_seeds,
    )
    return sweeps.atlas(sweep, size)


def view(
    run: Positional[Path],
    *,
    robot: Annotated[str | None, shown("NAME")] = None,
    host: str = "127.0.0.1",
    port: int = 8080,
) -> int:
    """Replay a run in the browser.

    Args:
        run: folder or record of a run
        robot: robot of the run, by name or file, if its own is elsewhere now
        host: address of the page; 0.0.0.0 lets other machines in
        port: port of the page; 0 takes a free one
    """
    from iiwa_dnn.app.replay import open_replay

    replay = open_replay(run, robot, host, port)
    print(f"open http://{host}:{replay.server.get_port()} in a browser; Ctrl-C ends it", flush=True)
    while True:
        time.sleep(1 / 30)
        replay.tick(1 / 30)


COMMANDS: dict[str, Any] = {**OPTIONS, "paper": paper, "atlas": atlas, "view": view}


def main(words: Sequence[str] | None = None) -> int:
    """Run a command by its words; None: the words of the process.

    Returns:
        The command's exit code.

    Raises:
        SystemExit: As in `iiwa_dnn.app.command_line.guard`.
    """
    given = list(sys.argv[1:] if words is None else words) or ["--help"]
    if given == ["--version"]:
        print(PROG, version(PROG))
        return 0
    return guard(f"{PROG} {given[0]}", partial(_run, given))


def _run(words: Sequence[str]) -> int:
    """Read the words of a command and carry it out."""
    about = "Robot arms driven by dynamic neural networks that solve a program at every step."
    done: Any = subcommand_cli_from_dict(
        COMMANDS, prog=PROG, description=about, args=words, config=CONFIG
    )
    if isinstance(done, Run):
        done = getattr(import_module("iiwa_dnn.app.track"), words[0])(done)
    code: int = done
    return code
