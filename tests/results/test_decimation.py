"""Fewer points, no lost spike."""

from __future__ import annotations

import numpy as np

from iiwa_dnn.results.decimation import decimate, envelope


def test_decimate_keeps_every_extreme():
    rng = np.random.default_rng(1)
    path = rng.normal(size=(100_000, 3))
    path[54_321, 1], path[3, 2] = 99.0, -99.0
    chosen = decimate(path, buckets=100)
    assert len(chosen) <= 2 + 100 * 6
    assert (np.diff(chosen) > 0).all()
    assert {0, 3, 54_321, 99_999} <= set(chosen.tolist())
    np.testing.assert_array_equal(path[chosen].max(axis=0), path.max(axis=0))
    np.testing.assert_array_equal(path[chosen].min(axis=0), path.min(axis=0))


def test_decimate_leaves_short_curves_whole_and_looks_past_nan():
    np.testing.assert_array_equal(decimate(np.zeros(20), buckets=10), np.arange(20))
    assert decimate(np.zeros(0)).size == 0
    curve = np.sin(np.linspace(0.0, 9.0, 5000))
    curve[[7, 100, 4000]] = np.nan
    chosen = decimate(curve, buckets=50)
    assert np.nanmax(curve[chosen]) == np.nanmax(curve)
    assert np.nanmin(curve[chosen]) == np.nanmin(curve)


def test_envelope_of_a_ramp():
    t = np.arange(1000.0)
    times, mean, least, greatest = envelope(t, 2.0 * t, buckets=10)
    np.testing.assert_allclose(times, 49.5 + 100.0 * np.arange(10))
    np.testing.assert_allclose(mean, 2.0 * times)
    np.testing.assert_array_equal(least, 200.0 * np.arange(10))
    np.testing.assert_array_equal(greatest, 200.0 * np.arange(10) + 198.0)


def test_envelope_holds_every_sample():
    curve = np.random.default_rng(2).normal(size=12_345)
    t = np.linspace(0.0, 1.0, len(curve))
    times, mean, least, greatest = envelope(t, curve, buckets=700)
    assert len(times) == 700
    assert least.min() == curve.min()
    assert greatest.max() == curve.max()
    assert (least <= mean).all()
    assert (mean <= greatest).all()
    assert envelope(t[:5], curve[:5])[1] is not None
    np.testing.assert_array_equal(envelope(t[:5], curve[:5])[3], curve[:5])
