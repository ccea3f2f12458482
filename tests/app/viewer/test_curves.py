"""Diagrams on the page: axes around the curves, also around those of an arm at rest."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("viser", reason="pip install 'iiwa-dnn[view]'")

from iiwa_dnn.app.viewer.curves import LEAST, Curves


class Gui:
    """A page that keeps what is put on it."""

    def add_uplot(self, data, series, **options):
        return SimpleNamespace(data=data, series=series, **options)


@pytest.mark.parametrize("value", [0.0, 1e-17, 1e-9, 1e-3, 1.0, 3.0])
def test_a_constant_curve_is_inside_its_axis(value):
    curves = Curves(Gui(), "error [m]", ("#000",), (0.0, 1.0))
    times = np.linspace(0.0, 1.0, 5)
    curves.show(times, np.full(5, value))
    _, shown, _ = curves.handle.data
    low, high = curves.handle.scales["y"]["range"]
    assert (shown == max(value, LEAST)).all()
    assert 3.0 * low < shown[0] < high / 3.0
    assert all(low <= tick <= high for tick in curves.handle.axes[1]["splits"])


def test_only_what_is_not_finite_is_left_out():
    curves = Curves(Gui(), "gap", ("#000", "#111"), (0.0, 1.0))
    values = np.array([[1e-3, np.nan], [np.inf, np.nan], [0.0, 1e-6], [-np.inf, np.inf]])
    curves.show(np.arange(4.0), values)
    times, first, second, _ = curves.handle.data
    assert times.tolist() == [0.0, 2.0]
    np.testing.assert_array_equal(first, [1e-3, LEAST])
    np.testing.assert_array_equal(second, [np.nan, 1e-6])
