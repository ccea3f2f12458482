"""Rules of pseudo-transient continuation that the compiled and the generic settle loop share.

Each round first tries one linearly implicit step, very long at first: near the equilibrium that is
a Newton step, and a warm start in a control loop needs only that. Where it makes no `progress`, a
fully solved backward Euler step follows, whose length grows from round to round. Where rounding is
in the way, linearly implicit steps of other lengths are tried too.

Source: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998).
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.qp.layout import compiled

LAST_STEP = 1e6
"""Longest backward Euler step [rho]: beyond, the linear systems are singular to working precision.
"""
TRIALS = np.array([1.0, 1e-2, 1e2, 1e-4, 1e4])
"""Lengths of the linearly implicit steps, in units of the first: shorter ones have better
conditioned systems, longer ones bring nearly dependent rows to rest."""
STALLED = 30
"""Rounds with small rates and residuals above the tolerance, as large multipliers have them, after
which `settle` gives up."""
TRAVELLING = 3
"""Steps of length `LAST_STEP` in a row that do not halve the rates, after which `settle` gives up:
the state travels, since there is no solution or none that is near."""


@compiled
def near(rate: float, tol: float) -> bool:
    """Tell whether the rates are so near the tolerance that rounding is in the way."""
    return rate <= 1e4 * tol


@compiled
def progress(rate: float, new_rate: float, tol: float) -> bool:
    """Tell whether a step is kept: it halved the largest rate, or lowered it near rest."""
    return new_rate <= 0.5 * rate or (near(rate, tol) and new_rate <= 0.9 * rate)


@compiled
def within(primal: float, dual: float, gap: float, tol: float) -> bool:
    """Tell whether no residual is above the tolerance, and none NaN."""
    return primal <= tol and dual <= tol and gap <= tol


@compiled
def next_step(
    step: float, growth: float, before: float, rate: float, tol: float, travelling: int
) -> tuple[int, float]:
    """Count the longest steps that did not halve the rates, and choose the next step's length."""
    if step < LAST_STEP:
        return travelling, step * growth
    if rate <= 0.5 * before:
        return travelling, step
    # Not a long way to go, but rounding: shorter steps have better conditioned systems.
    return travelling + 1, 100.0 if near(rate, tol) else step
