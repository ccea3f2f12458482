"""The controller's state: nothing that is set, interrupted, copied or pickled makes it forget."""

import copy
import pickle
import signal
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import driven, heart, paper_robot, paper_start
from iiwa_dnn.step.policies import ProgramKind

DT = 1e-3
ACCELERATION = 5.0
LIMITED = d.DoubleIndicator(extra_limits=(d.AccelerationLimits(ACCELERATION),), home=PAPER_Q0)


def fast_heart() -> d.Reference:
    return d.Heart(period=2.0).anchored(paper_start())


def moving() -> tuple[d.Controller, np.ndarray, int]:
    """A controller in motion, the joint positions and the number of the next step."""
    controller = d.Controller(paper_robot(), LIMITED, fast_heart(), dt=DT)
    path, _ = driven(controller, PAPER_Q0, 400)
    return controller, path[-1], 400


CHANGES: dict[str, Any] = {
    "policy": "relax",
    "reference": heart(),
    "scheme": replace(LIMITED, weight=0.9),
    "robot": paper_robot().with_limits(velocity=1.0),
    "solver": d.DNNSolver(),
    "dt": 0.9 * DT,
}


@pytest.mark.parametrize("name", CHANGES)
def test_an_attribute_that_is_set_in_motion_keeps_the_last_command(name: str) -> None:
    controller, q, k = moving()
    before = controller.step(q, k * DT).dq.copy()
    q = q + DT * before
    setattr(controller, name, CHANGES[name])
    after = controller.step(q, (k + 1) * DT).dq
    assert np.abs(before).max() > 0.02  # far more than one step of the limit
    assert np.abs(after - before).max() <= ACCELERATION * DT * (1.0 + 1e-9)


def test_interrupts_at_any_time_keep_the_acceleration_limit() -> None:
    controller, q, k = moving()
    sent = controller.step(q, k * DT).dq.copy()
    previous = signal.getsignal(signal.SIGALRM)

    def interrupt(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGALRM, interrupt)
    interrupted = 0
    rng = np.random.default_rng(2)
    try:
        for i in range(1500):
            t = (k + 1 + i) * DT
            command = None
            try:
                signal.setitimer(signal.ITIMER_REAL, float(rng.uniform(1e-6, 6e-5)))
                command = controller.step(q, t)
                signal.setitimer(signal.ITIMER_REAL, 0.0)
            except KeyboardInterrupt:
                interrupted += 1
            if command is not None:
                assert np.abs(command.dq - sent).max() <= ACCELERATION * DT * (1.0 + 1e-9)
                sent = command.dq.copy()
                q = q + DT * sent
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)
    assert interrupted > 50


@pytest.mark.parametrize("copied", [copy.copy, lambda each: pickle.loads(pickle.dumps(each))])
def test_a_copy_goes_its_own_way(copied: Any) -> None:
    controller, q, k = moving()
    twin = copied(controller)
    command = controller.step(q, k * DT)
    far = d.Target(paper_start().position + [0.1, 0.0, 0.0], paper_start().rotation)
    for _ in range(5):
        controller.step(q, k * DT, far)
    np.testing.assert_allclose(twin.step(q, k * DT).dq, command.dq, rtol=0, atol=1e-9)
    kept = copied(command)
    np.testing.assert_array_equal(kept.dq, command.dq)
    np.testing.assert_array_equal(kept.qp.data, command.qp.data)
    assert kept.solution.found
    assert kept.ok


def test_threads_keep_the_acceleration_limit_between_them() -> None:
    controller, q, k = moving()
    with ThreadPoolExecutor(2) as pool:
        commands = [*pool.map(lambda _: controller.step(q, k * DT), range(600))]
    for command in commands:
        change = np.abs(command.dq - command.log.last).max()
        assert change <= ACCELERATION * DT * (1.0 + 1e-9)


QUERIES: dict[str, Any] = {
    "placement": lambda controller, q: controller.placement(q),
    "program_at": lambda controller, q: controller.program_at(q, controller.targets(0.1), 0.1),
    "is_clear": lambda controller, q: controller.is_clear(q, 0.1 * q),
    "pickle": lambda controller, q: pickle.dumps(controller),
}


@pytest.mark.parametrize("query", QUERIES.values(), ids=QUERIES)
def test_what_another_thread_asks_changes_no_command(query: Any) -> None:
    # It shared the kinematics: 1,445 of 5,000 commands were those of another posture.
    scheme = replace(LIMITED, extra_limits=(AWAY,))
    controller = d.Controller(paper_robot(), scheme, fast_heart(), dt=DT)
    settled = [controller.step(PAPER_Q0, 0.1).dq for _ in range(20)][-1]
    done = threading.Event()

    def ask() -> None:
        while not done.is_set():
            query(controller, np.array(PAPER_Q0) + 0.5)

    asking = threading.Thread(target=ask)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        asking.start()
        commands = np.array([controller.step(PAPER_Q0, 0.1).dq for _ in range(1500)])
    finally:
        done.set()
        asking.join()
        sys.setswitchinterval(interval)
    np.testing.assert_allclose(commands, np.tile(settled, (1500, 1)), rtol=0, atol=1e-9)


class Asking(d.MovingTarget):
    """A reference in Python that asks something of the controller which samples it."""

    asks: Any = staticmethod(lambda: None)

    def move(self, t: float, target: np.ndarray) -> None:
        super().move(t, target)
        self.asks()


def test_what_a_step_asks_may_read_the_controller_and_not_move_it() -> None:
    """It was a deadlock, or a command of another posture."""
    path = Asking(paper_start())
    controller = d.Controller(paper_robot(), LIMITED, path, dt=DT)
    first = controller.step(PAPER_Q0, 0.0).dq
    q = np.array(PAPER_Q0)
    path.asks = lambda: (controller.positions, controller.path_lag, controller.program.sizes)
    np.testing.assert_allclose(controller.step(q, 0.0).dq, first, rtol=0, atol=1e-9)
    for asks in (
        lambda: controller.step(q + 0.1, 0.0),
        lambda: controller.placement(q + 0.1),
        lambda: controller.send(q),
        lambda: setattr(controller, "policy", "stop"),
        controller.reset,
    ):
        path.asks = asks
        before = controller._motion.numbers.copy()
        with pytest.raises(d.InvalidInputError, match="controller: is within a step"):
            controller.step(q, 0.0)
        np.testing.assert_array_equal(controller._motion.numbers, before)
    path.asks = controller.halt
    controller.step(q, 0.0)
    assert controller.step(q, 0.0).kind is ProgramKind.STOPPED


def test_a_refused_step_leaves_nothing_behind() -> None:
    controller, q, k = moving()
    twin = copy.copy(controller)
    for seen, t in ((q * np.nan, k * DT), (q, np.inf)):
        with pytest.raises(d.InvalidInputError):
            controller.step(seen, t)
    np.testing.assert_array_equal(controller._motion.numbers, twin._motion.numbers)
    for each in (controller, twin):
        each.send(np.full(7, 0.01))
    np.testing.assert_array_equal(controller._motion.numbers, twin._motion.numbers)


def test_a_command_says_the_same_when_the_period_has_changed() -> None:
    controller, q, k = moving()
    far = d.Target(paper_start().position + [0.1, 0.0, 0.0], paper_start().rotation)
    command = controller.step(q, k * DT, far)
    said = command.active_limits
    assert any("acceleration" in name for name in said)
    controller.step(q, k * DT, far, dt=20.0 * DT)
    assert command.active_limits == said


@pytest.mark.parametrize("times", [1, 2])
def test_what_was_sent_in_place_of_a_command_is_what_the_jerk_is_counted_from(times: int) -> None:
    jerk = 200.0
    limits = (d.AccelerationLimits(5.0), d.JerkLimits(jerk))
    controller = d.Controller(paper_robot(), d.DoubleIndicator(extra_limits=limits), heart(), dt=DT)
    path, commands = driven(controller, PAPER_Q0, 100)
    last = commands[-1].dq
    sent = last + 5e-4
    for _ in range(times):  # twice the same: the acceleration is over
        controller.send(sent)
    with pytest.raises(d.InvalidInputError, match=r"^dq: "):
        controller.send(np.nan * sent)
    change = sent - last if times == 1 else 0.0
    jump = controller.step(path[-1], 0.1).dq - (sent + change)
    assert np.abs(jump).max() == pytest.approx(jerk * DT**2, rel=1e-6)


DISTURBED: dict[str, Any] = {
    "periods that differ": lambda k, random: {"dt": DT * random.uniform(0.7, 2.0)},
    "one long period": lambda k, random: {"dt": 0.02 if k == 100 else DT},
    "a jump that was sent": lambda k, random: {"sent": 0.5 * (k == 100)},
    "limits in motion": lambda k, random: {"scheme": RATED if k else LIMITED},
    "a halt, and periods that differ": lambda k, random: {
        "scheme": BESIDE,
        "halts": k == 300,
        "dt": DT * random.uniform(0.7, 1.3),
    },
    "single long periods beside a ball": lambda k, random: {
        "scheme": NEAR,
        "way": JUMPS[k // 150],
        "dt": 4.0 * DT * random.choice([0.1, 1.0, 10.0], p=[0.05, 0.9, 0.05]),
    },
    "less jerk in motion": lambda k, random: {"scheme": SMOOTH if k > 30 else RATED},
}
JUMPS = np.random.default_rng(2).uniform(-0.4, 0.4, (7, 3))
RATED, SMOOTH = (
    d.DoubleIndicator(extra_limits=(d.AccelerationLimits(10.0), d.JerkLimits(jerk)), home=PAPER_Q0)
    for jerk in (500.0, 20.0)
)
AWAY = d.CollisionAvoidance(d.Sphere((5.0, 0.0, 0.0), 0.1), self_collision=False)
BESIDE = d.DoubleIndicator(extra_limits=(d.AccelerationLimits(10.0), AWAY), home=PAPER_Q0)
BALL = d.Sphere(paper_start().position + [0.0, 0.2, 0.0], 0.05)
NEAR = replace(RATED, extra_limits=(*RATED.extra_limits, replace(AWAY, obstacles=BALL)))


@pytest.mark.parametrize("disturbed", DISTURBED.values(), ids=DISTURBED)
def test_velocity_and_acceleration_hold_whatever_comes_upon_a_loop(disturbed: Any) -> None:
    random = np.random.default_rng(0)
    controller = d.Controller(paper_robot(), RATED, dt=DT, policy="relax")
    start = paper_start()
    q = np.array(PAPER_Q0)
    last = np.zeros(7)
    time, rests = 0.0, np.inf
    rates, jerks = [np.zeros(7)], []
    for k in range(1000):
        asked = {"scheme": RATED, "sent": 0.0, "dt": DT, "halts": False, "way": [0.0, 0.2, 0.0]}
        asked |= disturbed(k, random)
        target = d.Target(start.position + asked["way"], start.rotation)
        controller.scheme = asked["scheme"]
        if asked["halts"]:
            controller.halt()
            rests = time + np.abs(last).max() / 10.0
        if asked["sent"]:
            last = last + asked["sent"]
            controller.send(last)
        dq = controller.step(q, 0.0, target, dt=asked["dt"]).dq
        assert (np.abs(dq) <= paper_robot().dq_max).all()
        assert np.abs(dq - last).max() <= 10.0 * asked["dt"] * (1.0 + 1e-9)
        assert time < rests or not dq.any()
        time += asked["dt"]
        rates.append((dq - last) / asked["dt"])
        jerks.append(np.abs(rates[-1] - rates[-2]).max() / asked["dt"])
        q = q + asked["dt"] * dq
        last = dq
    assert np.abs(q - PAPER_Q0).max() > 0.1
    assert max(jerks) < 2000.0 or {*disturbed(0, random)} != {"dt"}
