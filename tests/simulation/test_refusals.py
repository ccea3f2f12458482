"""Arguments of runs, noise, disturbances and physics that make no sense: each is named."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import UNCHECKED, heart, paper_robot
from iiwa_dnn.simulation.disturbances import Disturbances, Push
from iiwa_dnn.simulation.plants.torque_control import TorqueGains

TIP = paper_robot().tip
ELBOW = "iiwa7_link_4"


def simulate(scheme: Any = None, reference: Any = None, q: Any = PAPER_Q0, **options: Any) -> Any:
    scheme = scheme or d.DoubleIndicator()
    options = {"dt": 1e-3, "duration": 0.01, "check": UNCHECKED} | options
    return d.simulate(paper_robot(), scheme, reference or heart(), q, **options)


def physics(timestep: float, **options: Any) -> Any:
    pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")
    return simulate(plant=d.MujocoPlant(timestep=timestep), **options)


def tracking(*frames: str | None) -> d.Scheme:
    return d.Scheme([d.CyclicMotion()], [d.PositionTask(frame=name) for name in frames])


NUMBERS = (-1.0, np.nan, np.inf, None, "loud")
REFUSED: list[tuple[str, Callable[..., object], dict[str, Any]]] = [
    *[("dt", simulate, {"dt": bad}) for bad in (0.0, *NUMBERS)],
    ("dt", simulate, {"dt": 5e-324}),  # more steps than a number can hold
    *[("duration", simulate, {"duration": bad}) for bad in (0.0, -1.0, np.nan, np.inf, "long")],
    ("duration", simulate, {"duration": 1e300}),
    ("duration", simulate, {"duration": 1e-6}),  # not one step of 1e-3
    *[("mode", simulate, {"mode": bad}) for bad in ("discrete", None)],
    *[("motion", simulate, {"motion": bad}) for bad in ("heun", None, ["euler"])],
    ("motion", simulate, {"mode": "continuous", "motion": "rk4"}),
    ("motion", physics, {"timestep": 1e-3, "motion": "rk4"}),
    *[("noise", simulate, {"noise": bad}) for bad in NUMBERS],
    *[("filter_window", simulate, {"filter_window": bad}) for bad in (0, -3, 2.5, *NUMBERS[1:])],
    ("no setting of a run 'duratoin'; did you mean: duration", simulate, {"duratoin": 1.0}),
    *[("seed", simulate, {"seed": bad}) for bad in (-1, 1.5, None, "lucky")],
    *[("q", simulate, {"q": bad}) for bad in (np.zeros(6), np.full(7, np.nan), "home", None)],
    ("home", simulate, {"scheme": d.DoubleIndicator(home=(0.0,))}),
    (
        f"reference.*{ELBOW}",
        simulate,
        {"scheme": tracking(None, ELBOW), "reference": {TIP: heart()}},
    ),
    (
        f"reference.*no task tracks.*{ELBOW}",
        simulate,
        {"scheme": tracking(None), "reference": {TIP: heart(), ELBOW: heart()}},
    ),
    ("mass_error", Disturbances, {"mass_error": 1.0}),
    ("mass_error", Disturbances, {"mass_error": -0.1}),
    ("delay_periods", Disturbances, {"delay_periods": -1}),
    ("push", Push, {"force": (1.0, 0.0)}),
    ("push", Push, {"force": (1.0, np.nan, 0.0)}),
    ("push_at", Push, {"start": -1.0}),
    ("push_for", Push, {"duration": np.inf}),
    ("bandwidth", TorqueGains, {"bandwidth": 0.0}),
    ("observer_bandwidth", TorqueGains, {"observer_bandwidth": -1.0}),
    ("leash", TorqueGains, {"leash": np.inf}),
    ("physics_dt", physics, {"timestep": 0.0}),
    (".*at most 0.001 s", physics, {"timestep": 2e-3, "dt": 2e-3}),
    (".*must divide", physics, {"timestep": 3e-4}),
    (".*must divide", physics, {"timestep": 1e-3, "dt": 1e-4}),
]


@pytest.mark.parametrize(("name", "call", "arguments"), REFUSED)
def test_an_argument_that_makes_no_sense_is_named(name, call, arguments) -> None:
    with pytest.raises((d.InvalidInputError, d.NotFoundError), match=rf"^{name}\b"):
        call(**arguments)
