"""Controllers of many arms: each is a `Controller`, to the last bit given the same kinematics."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from iiwa_dnn.schemes import AccelerationLimits, JerkLimits

DT = 1e-3
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
SMOOTH = d.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
BALL = d.Sphere([0.36, 0.16, 0.64], 0.05)
HERE = d.Configuration(SMOOTH, START)
RATES = (AccelerationLimits(), JerkLimits())
MOVING = d.Sphere([0.36, 0.16, 0.8], 0.05, velocity=[0.0, 0.0, -0.05])


def made(*obstacles: d.Sphere, **own: Any) -> d.Controller:
    """A controller of a quick heart, beside obstacles that it comes near to."""
    limits = (*RATES, d.CollisionAvoidance(obstacles)) if obstacles else RATES
    heart = d.Heart(scale=6e-3, period=2.0).anchored(HERE)
    scheme = d.DoubleIndicator(home=START, extra_limits=limits)
    return d.Controller(SMOOTH, scheme, heart, **({"dt": DT} | own))


@pytest.mark.usefixtures("kernels_kinematics")
@pytest.mark.parametrize(
    ("obstacles", "own"),
    [
        ((), {}),
        ((BALL,), {}),
        ((MOVING,), {"longest_period": 3e-3}),
        ((), {"mode": "continuous"}),
        ((BALL,), {"policy": "relax"}),
    ],
)
def test_each_arm_is_a_controller(obstacles: tuple[d.Sphere, ...], own: dict[str, Any]) -> None:
    one = made(*obstacles, **own)
    many = d.Controllers(one, 3, threads=1)
    q, t = START.copy(), 0.0
    actions = set()
    for k in range(600):
        told = [{}, {"dt": 2e-3}, {"elapsed": 1.5e-3}][k % 3] if one.longest_period else {}
        with np.testing.suppress_warnings() as warned:
            warned.filter(UserWarning)
            command = one.step(q, t, **told)
            all_of_them = many.step(np.tile(q, (3, 1)), t, **told)
        for i in range(3):
            assert all_of_them.dq[i].tobytes() == command.dq.tobytes()
            assert all_of_them.next_q[i].tobytes() == command.next_q.tobytes()
        assert all_of_them.action.tolist() == [int(command.action)] * 3
        if k % 20 == 0:
            assert all_of_them.active_limits(1) == command.active_limits
            assert many.stopping_time(2) == many.stopping_time(0)
        actions.add(command.action)
        q = command.next_q.copy()
        t += told.get("dt", DT)
        if k == 300:
            q = q + 0.02
    assert len(actions) > 1 or one.mode == "continuous"
    assert np.isfinite(many.margin().distance).all() == bool(obstacles)


def test_arms_have_targets_clocks_and_halts_of_their_own() -> None:
    controller = made(BALL)
    many = d.Controllers(controller, 3)
    q = np.tile(START, (3, 1))
    there = np.array([controller.targets(0.0)] * 3)
    there[1, 0, :3] += [0.0, 0.0, 0.05]  # positions come first
    for k in range(200):
        command = many.step(q, k * DT, there)
        q = command.next_q
    ends = [d.Configuration(SMOOTH, each).position - HERE.position for each in q]
    assert np.linalg.norm(ends[0]) < 1e-6
    assert ends[1][2] > 0.01
    many.halt(np.array([False, True, False]))
    other = pickle.loads(pickle.dumps(copy.deepcopy(many)))
    for k in range(200, 1200):
        command = other.step(q, k * DT, there)
        q = command.next_q
    assert not command.dq[1].any()
    q[2, 0] = np.nan
    command = many.step(q, 0.0, there)
    assert command.action[2] == -1
    assert np.isfinite(command.dq).all()


def test_a_scheme_without_a_home_has_the_start_posture() -> None:
    start = SMOOTH.start_posture()
    heart = d.Heart(scale=6e-3, period=2.0).anchored(d.Configuration(SMOOTH, start))
    q = np.tile(start + 0.001, (2, 1))
    found = []
    for home in (None, tuple(start)):
        scheme = d.DoubleIndicator(home=home, extra_limits=RATES)
        many = d.Controllers(d.Controller(SMOOTH, scheme, heart, dt=DT), 2)
        for k in range(50):
            command = many.step(q, k * DT)
        found.append(command.dq)
    assert found[0].any()
    np.testing.assert_array_equal(*found)


def test_what_is_in_python_is_refused_by_its_name() -> None:
    controller = made(solver=d.DNNSolver(d.PrimalDualNetwork()))
    with pytest.raises(
        d.InvalidInputError, match="parts: are in Python: PrimalDualNetwork; take a Co"
    ):
        d.Controllers(controller, 2)
    controller = made()
    controller.reference = None
    with pytest.raises(d.InvalidInputError, match="targets: are needed"):
        d.Controllers(controller, 2).step(np.tile(START, (2, 1)), 0.0)
    with pytest.raises(d.InvalidInputError, match="targets: must have shape"):
        d.Controllers(controller, 2).step(np.tile(START, (2, 1)), 0.0, np.zeros((2, 18)))
