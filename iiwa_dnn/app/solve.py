"""``solve``: one quadratic program out of a file, settled by the network."""

import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import qpsolvers
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.app.options import SolveOptions
from iiwa_dnn.app.track import CHECKS
from iiwa_dnn.errors import FileError, InvalidInputError, NotFoundError
from iiwa_dnn.files import one_line, write_atomically
from iiwa_dnn.networks.problems import solve_problem
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import QP

ARRAYS = ("P", "q", "G", "h", "A", "b", "lb", "ub")


def run(options: SolveOptions) -> int:
    """Solve the program, print or write its solution with the residuals; return the exit code."""
    if options.file is None:
        raise InvalidInputError("FILE", "is missing (--help lists the options)")
    if options.out is not None and options.out.resolve() == options.file.resolve():
        raise InvalidInputError("--out", f"is the program's own file {options.file}", options.out)
    checks.positive("tol", options.tol)
    qp = load_problem(options.file)
    solution = solve_problem(qp, tol=options.tol)
    if options.out is not None and solution.found:
        # The file's name is taken as it is; numpy would put .npz behind it.
        parts = {"x": solution.x, "y": solution.y, "z": solution.z, "z_box": solution.z_box}
        kept: dict[str, Any] = {
            k: value for k, value in parts.items() if value is not None and value.size
        }
        write_atomically(options.out, lambda file: np.savez(file, **kept))
    if not options.quiet:
        print("\n".join(_lines(qp, solution, options)))
    elif not solution.found:
        print(f"{solution.extras['status']}: {_residuals(solution)}", file=sys.stderr)
    return 0 if solution.found else 1


def load_problem(path: Path) -> QP:
    """Read a quadratic program from an .npz file of P and q and if need be G, h, A, b, lb, ub.

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


def _lines(qp: QP, solution: qpsolvers.Solution, options: SolveOptions) -> list[str]:
    n, m, p = qp.sizes
    extras = solution.extras
    lines = [
        f"program    {n} variables, {m} inequalities, {p} equalities",
        f"status     {extras['status']} after {extras['iterations']:,} linear systems",
        f"residuals  {_residuals(solution)}, tolerance {options.tol:.3g}",
    ]
    if not solution.found:
        return [*lines, f"last x     {_numbers(extras['last_x'])} (not an answer)"]
    lines += [f"objective  {solution.obj:.12g}", f"x          {_numbers(solution.x)}"]
    for name in ("y", "z", "z_box") if options.verbose else ():
        value = getattr(solution, name)
        if value is not None and value.size:
            lines.append(f"{name:<11}{_numbers(value)}")
    check = CrossCheck(CHECKS[options.check])
    agreement = check.check(qp, np.asarray(solution.x))
    for i, name in enumerate(check.solvers):
        gap, objective = agreement.solution_gap[0, i], agreement.objective_gap[0, i]
        told = f"gap {gap:.3g} in x, {objective:.3g} in the objective"
        lines.append(f"{name:<11}{told if np.isfinite(gap) else 'no answer to be believed'}")
    return lines


def _residuals(solution: qpsolvers.Solution) -> str:
    named = {"primal": "primal_residual", "dual": "dual_residual", "gap": "duality_gap"}
    return ", ".join(f"{name} {solution.extras[key]:.3g}" for name, key in named.items())


def _numbers(values: ArrayLike | None) -> str:
    return " ".join(f"{value:.12g}" for value in np.asarray(values))
