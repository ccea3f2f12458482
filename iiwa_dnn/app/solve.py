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
from iiwa_dnn.qp.proof import prove

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
        arrays = {"x": solution.x, **_multipliers(solution)}
        # numpy.savez with a name would put .npz behind it.
        write_atomically(options.out, lambda file: np.savez(file, **arrays))
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
            arrays = {name: archive[name] for name in archive.files}
    except AttributeError as error:
        raise FileError(path, "not an .npz archive") from error
    except ValueError as error:  # neither an archive nor an array; numpy speaks of pickles
        raise FileError(path, "cannot be read as .npz: not an archive of plain arrays") from error
    except (OSError, EOFError, zipfile.BadZipFile) as error:
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
        f"program    variables {n}, inequalities {m}, equalities {p}",
        f"status     {extras['status']} after {extras['iterations']:,} linear systems",
        f"residuals  {_residuals(solution)}, tolerance {options.tol:.3g}",
    ]
    check = CrossCheck(CHECKS[options.check])
    if not solution.found:
        if options.check == "proof":
            proven = "the status is proven by a certificate, rounding counted"
            lines.append(f"proof      {proven if 'certificate' in extras else 'none'}")
        else:
            lines += [f"{name:<11}{check.status(name, qp)}" for name in check.solvers]
        return [*lines, f"last x     {_text(extras['last_x'])} (not an answer)"]
    lines += [f"objective  {solution.obj:.12g}", f"x          {_text(solution.x)}"]
    if options.verbose:
        lines += [f"{name:<11}{_text(value)}" for name, value in _multipliers(solution).items()]
    if options.check == "proof":
        proof = prove(qp, solution)
        shown = f"within {proof.bound:.3g} of the exact solution in x"
        reason = f"; {proof.reason}" if proof.reason else ""
        return [*lines, f"proof      {shown if proof.bound < np.inf else 'none'}{reason}"]
    agreement = check.check(qp, np.asarray(solution.x))
    gaps = zip(agreement.solution_gap[0], agreement.objective_gap[0], strict=True)
    for name, (gap, objective) in zip(check.solvers, gaps, strict=True):
        found = f"gap {gap:.3g} in x, {objective:.3g} in the objective"
        lines.append(f"{name:<11}{found if np.isfinite(gap) else 'no accurate answer'}")
    return lines


def _multipliers(solution: qpsolvers.Solution) -> dict[str, Any]:
    """Return the multipliers by their names, without those of constraints that are missing."""
    values = {"y": solution.y, "z": solution.z, "z_box": solution.z_box}
    return {name: value for name, value in values.items() if value is not None and value.size}


def _residuals(solution: qpsolvers.Solution) -> str:
    named = {"primal": "primal_residual", "dual": "dual_residual", "gap": "duality_gap"}
    return ", ".join(f"{name} {solution.extras[key]:.3g}" for name, key in named.items())


def _text(values: ArrayLike | None) -> str:
    return " ".join(f"{value:.12g}" for value in np.asarray(values))
