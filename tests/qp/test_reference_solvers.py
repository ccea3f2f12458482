"""Reference solvers: a workspace that serves many programs keeps nothing of those before."""

import numpy as np

from helpers_qp import known_qp
from iiwa_dnn.qp import QP
from iiwa_dnn.qp.reference_solvers import ProxQP


def test_proxqp_starts_each_program_cold_in_a_used_workspace() -> None:
    """A program without a solution, a badly scaled one and others lie between."""
    rng = np.random.default_rng(64)
    qps = [known_qp(rng, 7, 3, active, inequalities=4)[0] for active in range(6)]
    impossible = QP(np.eye(7), np.ones(7), np.vstack([np.eye(4, 7)]), -np.ones(4),
                    np.eye(3, 7), np.ones(3))  # fmt: skip
    steep = QP(1e6 * qps[0].P, qps[0].q, qps[0].G, qps[0].h, qps[0].A, qps[0].b)
    used = ProxQP(qps[0].sizes)
    for before in (qps[-1], impossible, steep):
        for qp in qps:
            used(before)
            own = used(qp)
            fresh = ProxQP(qp.sizes)
            np.testing.assert_allclose(own, fresh(qp), rtol=0, atol=1e-10)
            assert used.solver.results.info.iter == fresh.solver.results.info.iter
    assert np.isnan(used(impossible)).all()
