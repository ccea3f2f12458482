r"""Networks on the residual of the KKT conditions: zeroing, gradient, noise-suppressing.

The residual E(s, t) of the KKT conditions is to vanish along
:math:`\rho\,\dot E = -\Phi(E)`. With W its derivative in s and :math:`\partial_t E` the program's
part of its rate, each evaluation solves one linear system:

.. math::

    \rho\,\dot s = -W^{-1}\Bigl((1 + (t/\rho)^{k})\,\Phi(E)
        + \kappa \int E\,\tfrac{dt}{\rho} + \rho\,\partial_t E\Bigr)

For a program that is known with its rate, E decays at the activation's rate though the program
moves; no other network here does so. The integral rejects a constant disturbance of
:math:`\dot E` and leaves :math:`\rho^2 c / \kappa` of a ramp c t. The power k makes the gain grow.

Sources: Y. Zhang, S. S. Ge, "Design and analysis of a general recurrent neural network model for
time-varying matrix inversion", IEEE Transactions on Neural Networks 16 (2005); L. Jin, Y. Zhang,
S. Li, "Integration-enhanced Zhang neural network for real-time-varying matrix inversion in the
presence of various kinds of noises", IEEE Transactions on Neural Networks and Learning Systems 27
(2016); Z. Zhang et al., "A varying-parameter convergent-differential neural network for solving
joint-angular-drift problems of redundant robot manipulators", IEEE/ASME Transactions on
Mechatronics 23 (2018).

**The gradient network** is steepest descent on half the squared residual:

.. math::  \rho\,\dot s = -W^T E(s), \qquad W = \partial E / \partial s

It needs one product where the zeroing network solves a linear system, and decays at the smallest
eigenvalue of :math:`W^T W`, the square of the program's condition; behind a program that moves at
a speed v it lags by about :math:`\rho\,v/\lambda_{min}`.

Source: Y. Zhang, K. Chen, H.-Z. Tan, "Performance analysis of gradient neural network exploited for
online time-varying matrix inversion", IEEE Transactions on Automatic Control 54 (2009).

**The noise-suppressing neural dynamics** are a zeroing network with bounded activations in series.

With the residual E of the KKT conditions in its ``"smooth"`` form, the perturbed Fischer-Burmeister
function as the NCP function, and n the noise,

.. math::

    \rho\,\dot E = -\eta\,\Phi(E) - \gamma\,\Phi\bigl(E + \eta\,\Phi(Z)\bigr) + n, \qquad
    \rho\,\dot Z = E, \qquad \Phi(e) = \min(\max(e, -1), 1) .

Near rest :math:`\Phi` is linear and the integral takes a constant noise out that is below
:math:`\gamma\,\min(1, \eta)`, with :math:`Z \to n/(\gamma\,\eta)`; it is the noise-tolerant
zeroing network with the gains :math:`\gamma + \eta` and :math:`\gamma\,\eta`.

Source: L. Wei, L. Jin et al., "Noise-suppressing neural dynamics for time-dependent constrained
nonlinear optimization with applications", IEEE Transactions on Systems, Man, and Cybernetics:
Systems, equation (12); the form above was read out of the authors' published programs
(docs/papers.md), not of the text.

**The residual.** Two forms of the complementarity, both with :math:`A x = b` as rows:

* ``"projected"``, s = [x | y | z], with :math:`g = P x + q + A^T y + G^T z`: the rows
  :math:`x - \Pi_{[lb,\,ub]}(x - g)` and :math:`[z + G x - h]_+ - z`;
* ``"smooth"``, s = [x | y | w], where bounds are rows too, :math:`C = [G; I; -I]`,
  :math:`d = [h; ub; -lb]`: the rows g (with :math:`C^T w`) and, with the slack
  :math:`\sigma = d - C x`, the perturbed Fischer-Burmeister function
  :math:`w + \sigma - \sqrt{w^2 + \sigma^2 + \varepsilon^2}`, which vanishes exactly where both are
  positive with :math:`w\,\sigma = \varepsilon^2/2`.

Source of the second: C. Kanzow, "Some noninterior continuation methods for linear complementarity
problems", SIAM Journal on Matrix Analysis and Applications 17 (1996).
"""

from dataclasses import dataclass, field
from typing import Literal, NamedTuple, get_args

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.activations import Activation, Linear
from iiwa_dnn.networks.base import Flow, Network, kkt_product
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP

Form = Literal["projected", "smooth"]

EPSILON = 1e-6
"""Perturbation of the smooth form, in the unit of multipliers and slacks."""

REGULAR = 1e-10
"""Entry of the rows' diagonal that keeps the matrix regular where rows are dependent."""


def system_size(qp: QP, form: Form) -> int:
    """Count the unknowns of a form."""
    n, m, p = qp.sizes
    return n + p + m + (2 * n if form == "smooth" else 0)


class KktResidual(NamedTuple):
    """The system at one point.

    Attributes:
        error: Residual E, (size,).
        drift: Its rate at a point that stays, (size,).
        matrix: Its derivative in s, (size, size).
    """

    error: Vector
    drift: Vector
    matrix: Matrix


def evaluate(qp: QP, form: Form, s: Vector, rate: QP | None = None) -> KktResidual:
    """Compute the residual at a point s (size,), its drift and its derivative.

    The rate of change of a program that moves is zero where a field is infinite.
    """
    if rate is None:
        rate = QP.from_data(np.zeros(qp.data.size), qp.sizes)
    n, _, p = qp.sizes
    matrix, offset = _linear_part(qp, form, 1.0)
    moving, moved = _linear_part(rate, form, 0.0)
    system = KktResidual(matrix @ s + offset, moving @ s + moved, matrix)
    matrix[range(n, s.size), range(n, s.size)] = -REGULAR
    if form == "smooth":
        _smooth(system, s, n + p)
    else:
        _project(system, s, qp, rate)
    return system


def _smooth(system: KktResidual, s: Vector, first: int) -> None:
    """Put the complementarity in place of the rows of C x - d, from the `first` on."""
    error, drift, matrix = system
    rows = np.arange(first, s.size)
    limited = np.isfinite(error[rows])
    w = s[rows]
    slack = np.where(limited, -error[rows], 0.0)
    root = np.sqrt(w**2 + slack**2 + EPSILON**2)
    slope = np.where(limited, slack / root - 1.0, 0.0)
    error[rows] = np.where(limited, w + slack - root, w)
    drift[rows] *= slope
    matrix[rows] *= slope[:, np.newaxis]
    matrix[rows, rows] = np.where(limited, 1.0 - w / root, 1.0)


def _project(system: KktResidual, s: Vector, qp: QP, rate: QP) -> None:
    """Put projections in place of rows at a bound and of idle rows."""
    error, drift, matrix = system
    n, _, p = qp.sizes
    eye = np.eye(s.size)
    aim = s[:n] - error[:n]
    idle = n + p + np.flatnonzero(~(s[n + p :] + error[n + p :] > 0.0))
    for reached, bound, moved in (
        (aim <= qp.lb, qp.lb, rate.lb),
        (aim >= qp.ub, qp.ub, rate.ub),
    ):
        at = np.flatnonzero(reached)
        error[at] = s[at] - bound[at]
        drift[at] = -moved[at]
        matrix[at] = eye[at]
    error[idle] = -s[idle]
    drift[idle] = 0.0
    matrix[idle] = -eye[idle]


def _linear_part(qp: QP, form: Form, unit: float) -> tuple[Matrix, Vector]:
    """Return matrix (size, size) and constant (size,) of the system without complementarity.

    The rows of the smooth form's bounds are plus and minus the `unit` times the identity.
    """
    eye = unit * np.eye(qp.q.size)
    smooth = form == "smooth"
    rows = np.vstack([qp.A, qp.G, eye, -eye] if smooth else [qp.A, qp.G])
    limits = [-qp.b, -qp.h, -qp.ub, qp.lb] if smooth else [-qp.b, -qp.h]
    matrix = np.block([[qp.P, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    return matrix, np.concatenate([qp.q, *limits])


@dataclass(frozen=True, kw_only=True)
class ZeroingNetwork(Network):
    """The zeroing network, with n + p + m states, and as many again with the integral.

    Attributes:
        rho: Time constant [s]; the literature's gain gamma is 1 / rho.
        activation: Phi.
        form: ``"projected"`` or ``"smooth"`` complementarity; the latter has 2 n states more.
        integral: kappa, the gain of the integral in units of 1 / rho^2; 0 for none.
        growth: k, the power of the growing gain; 0 for a constant gain.
    """

    rho: float = 1e-2
    activation: Activation = field(default_factory=Linear)
    form: Form = "projected"
    integral: float = 0.0
    growth: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters; raises InvalidInputError naming the one that is wrong."""
        super().__post_init__()
        checks.one_of("form", self.form, get_args(Form))
        checks.not_negative("integral", self.integral)
        checks.not_negative("growth", self.growth)

    def state_size(self, qp: QP) -> int:
        """Count the states: unknowns, their integrals, and a clock for the growing gain."""
        return system_size(qp, self.form) * (1 + (self.integral > 0.0)) + (self.growth > 0.0)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count, for each evaluation, residual, drift and a solved system; sizes are (n, m, p)."""
        size = sum(sizes) + (2 * sizes[0] if self.form == "smooth" else 0)
        return 0.0, 2.0 * kkt_product(sizes) + 2.0 * size**3 / 3.0 + 2.0 * size**2

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set a program and its rate of change [1/rho] up.

        Its rates raise NoSolutionError where the KKT conditions' derivative is singular.
        """
        size = system_size(qp, self.form)
        linear = isinstance(self.activation, Linear) and not (self.growth or self.integral)

        def rates(state: Vector) -> Vector:
            error, drift, matrix = evaluate(qp, self.form, state[:size], rate)
            wanted = self.removal(error, state) + drift
            result = np.ones(state.size)
            if self.integral:
                result[size : 2 * size] = error
            try:
                result[:size] = -np.linalg.solve(matrix, wanted)
            except np.linalg.LinAlgError:
                raise NoSolutionError("the derivative of the KKT conditions is singular") from None
            return result

        # Exact at rest; elsewhere it makes of a long implicit step Newton's.
        return Flow(rates, (lambda state: -np.eye(size)) if linear else None)

    def removal(self, error: Vector, state: Vector) -> Vector:
        """Return the rate (size,) at which a residual (size,) is removed at a state."""
        wanted = self.activation(error)
        if self.growth:
            wanted = (1.0 + abs(state[-1]) ** self.growth) * wanted
        if self.integral:
            wanted = wanted + self.integral * state[error.size : 2 * error.size]
        return wanted


@dataclass(frozen=True, kw_only=True)
class GradientNetwork(ZeroingNetwork):
    """The gradient network; the zeroing network's activation and form, no integral, no growth."""

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count, for each evaluation, the residual and a product with W^T; sizes are (n, m, p)."""
        return 0.0, 2.0 * kkt_product(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set a program up; its rate of change has no effect."""

        def rates(state: Vector) -> Vector:
            error, _, matrix = evaluate(qp, self.form, state)
            return np.asarray(-matrix.T @ self.activation(error))

        return Flow(rates)


@dataclass(frozen=True, kw_only=True)
class NoiseSuppressingNetwork(ZeroingNetwork):
    """The network with 2 (3 n + p + m) states: unknowns and the integrals of their residuals.

    Attributes:
        form: Form of the complementarity; ``"smooth"`` is the source's.
        integral: gamma, in units of 1 / rho.
        proportional: eta, in units of 1 / rho.
    """

    form: Form = "smooth"
    integral: float = 1.0
    proportional: float = 1.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        super().__post_init__()
        checks.positive("integral", self.integral)
        checks.positive("proportional", self.proportional)

    def removal(self, error: Vector, state: Vector) -> Vector:
        """Return the rate (size,) at which a residual (size,) is removed."""
        summed = state[error.size : 2 * error.size]
        aim = error + self.proportional * np.clip(summed, -1.0, 1.0)
        own = self.proportional * np.clip(error, -1.0, 1.0)
        return np.asarray(own + self.integral * np.clip(aim, -1.0, 1.0))
