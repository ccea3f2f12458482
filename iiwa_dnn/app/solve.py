"""``solve``: one quadratic program out of a file, settled by the network."""

from __future__ import annotations

import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import qpsolvers
from numpy.typing import ArrayLike

from iiwa_dnn.app.command_line import run_command
from iiwa_dnn.app.settings import SolveSettings
from iiwa_dnn.app.track import CHECKS
from iiwa_dnn.errors import FileError, InvalidInputError, NotFoundError
from iiwa_dnn.files import one_line, write_atomically
from iiwa_dnn.networks.solver import solve_problem
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import QP

ARRAYS = ("P", "q", "G", "h", "A", "b", "lb", "ub")


def solve(arguments: Sequence[str] | None = None, prog: str = "solve") -> int:
    """Solve the program in a file and print the answer with its residuals.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        0: solved. 1: no answer within the tolerance. 2: bad input, one line on standard error.
    """
    return run_command(SolveSettings, prog, _solve, arguments)


def load_problem(path: Path) -> QP:
    """Read a quadratic program from an .npz file of the arrays P, q, G, h, A, b, lb, ub.

    Args:
        path: The file; P and q must be there, G with h and A with b.

    Returns:
        The program.

    Raises:
        FileError: The file cannot be read, or is no .npz archive of plain arrays.
        NotFoundError: It holds an array of another name, or lacks P or q.
        InvalidInputError: The arrays do not make a convex program.
    """
    try:
        with path.open("rb") as file:
            archive = np.load(file, allow_pickle=False)
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise FileError(path, "not an .npz archive")
            arrays = {name: archive[name] for name in archive.files}
    except FileError:
        raise
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise FileError(path, f"cannot be read as .npz: {one_line(error)}") from error
    for name in arrays:
        if name not in ARRAYS:
            raise NotFoundError("such part of a program:", name, ARRAYS)
    for name in ("P", "q"):
        if name not in arrays:
            raise NotFoundError("array", name, arrays)
    qp = QP(**arrays)
    qp.check_values()
    return qp


def _solve(settings: SolveSettings) -> int:
    if settings.tol <= 0.0 or not np.isfinite(settings.tol):
        raise InvalidInputError("tol", f"must be a finite number above 0, not {settings.tol}")
    qp = load_problem(settings.file)
    solution = solve_problem(qp, tol=settings.tol)
    if settings.out is not None and solution.found:
        # The file's name is taken as it is; numpy would put .npz behind it.
        parts = {"x": solution.x, "y": solution.y, "z": solution.z, "z_box": solution.z_box}
        kept: dict[str, Any] = {
            k: value for k, value in parts.items() if value is not None and value.size
        }
        write_atomically(settings.out, lambda file: np.savez(file, **kept))
    if not settings.quiet:
        print("\n".join(_lines(qp, solution, settings)))
    elif not solution.found:
        said = f"{solution.extras['status']}: {_residuals(solution)}"
        print(said, file=sys.stderr)
    return 0 if solution.found else 1


def _lines(qp: QP, solution: qpsolvers.Solution, settings: SolveSettings) -> list[str]:
    n, m, p = qp.sizes
    extras = solution.extras
    lines = [
        f"program    {n} variables, {m} inequalities, {p} equalities",
        f"status     {extras['status']} after {extras['iterations']:,} linear systems",
        f"residuals  {_residuals(solution)}, tolerance {settings.tol:.3g}",
    ]
    if not solution.found:
        return [*lines, f"last x     {_numbers(extras['last_x'])} (not an answer)"]
    lines += [f"objective  {solution.obj:.12g}", f"x          {_numbers(solution.x)}"]
    if settings.verbose:
        for name in ("y", "z", "z_box"):
            value = getattr(solution, name)
            if value is not None and value.size:
                lines.append(f"{name:<11}{_numbers(value)}")
    check = CrossCheck(CHECKS[settings.check])
    agreement = check.check(qp, np.asarray(solution.x))
    for i, name in enumerate(check.solvers):
        gap, objective = agreement.solution_gap[0, i], agreement.objective_gap[0, i]
        told = f"gap {gap:.3g} in x, {objective:.3g} in the objective"
        lines.append(f"{name:<11}{told if np.isfinite(gap) else 'no answer to be believed'}")
    return lines


def _residuals(solution: qpsolvers.Solution) -> str:
    extras = solution.extras
    named = {"primal": "primal_residual", "dual": "dual_residual", "gap": "duality_gap"}
    return ", ".join(f"{name} {extras[key]:.3g}" for name, key in named.items())


def _numbers(values: ArrayLike | None) -> str:
    return " ".join(f"{value:.12g}" for value in np.asarray(values))
