"""The study of means against noise, in small, and the two claims that it is for."""

from __future__ import annotations

import numpy as np
import pytest

from iiwa_dnn.studies import noise_study, paper


def values(kind: str, means: str, duration: float) -> dict[str, float]:
    cell = {"disturbance": kind, "countermeasure": means, "seed": 0, "duration": duration}
    return noise_study.measure(cell).values


def test_the_chosen_gain_cuts_the_papers_noise_at_little_roughness(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(noise_study, "SETTLED_AFTER", 0.3)  # three times 1 / gain
    kind = "white, the paper's"
    plain = values(kind, "none", duration=0.6)
    helped = values(kind, "gain", duration=0.6)
    assert helped["mse_m2"] < 0.1 * plain["mse_m2"]
    # Beside the noise's own roughness: sigma sqrt(4 / pi) / dt.
    assert helped["command_roughness"] < 0.02 * 0.01 * np.sqrt(4.0 / np.pi) / 1e-4


def test_a_constant_bias_is_gone_after_two_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(paper, "DT", 1e-3)
    assert values("constant", "none", duration=1.3)["last_error_m"] > 1e-3
    for means, dt in (("Kalman with bias", 2.5e-4),):
        monkeypatch.setattr(paper, "DT", dt)
        assert values("constant", means, duration=2.0)["last_error_m"] < 1e-6
