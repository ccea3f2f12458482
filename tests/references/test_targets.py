"""Targets say what they hold."""

import numpy as np

from iiwa_dnn import Heart, Target


def test_a_target_says_what_it_holds() -> None:
    quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]  # about z
    shown = repr(Target([0.1, 0.2, 0.3], quarter, [0.0, 0.5, 0.0]))
    pose = "position=[0.1, 0.2, 0.3] m, turned by [0.0, 0.0, 1.5708] rad"
    assert shown == f"Target({pose}, moving at [0.0, 0.5, 0.0] m/s, [0.0, 0.0, 0.0] rad/s)"
    assert repr(Heart().sample(np.arange(5.0))) == "<5 targets>"
