"""The replay's clock, and what it tells of a run that failed."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_records import make_record
from iiwa_dnn.app.viewer import readout
from iiwa_dnn.app.viewer.replay import Playback, policy_words


def test_it_stands_still_until_it_is_told_to_play():
    playback = Playback(0.0, 10.0)
    playback.advance(3.0)
    assert playback.time == 0.0
    playback.toggle()
    playback.advance(3.0)
    assert playback.time == 3.0
    playback.toggle()
    playback.advance(3.0)
    assert playback.time == 3.0


@pytest.mark.parametrize("speed", [0.1, 1.0, 5.0])
def test_speed(speed):
    playback = Playback(2.0, 10.0, 2.0, speed)
    playback.toggle()
    playback.advance(1.0)
    assert playback.time == pytest.approx(2.0 + speed)


def test_it_stops_at_the_end_and_starts_again():
    playback = Playback(1.0, 2.0)
    assert playback.time == 1.0
    playback.toggle()
    playback.advance(5.0)
    assert (playback.time, playback.playing) == (2.0, False)
    playback.toggle()
    assert (playback.time, playback.playing) == (1.0, True)
    playback.toggle()
    assert not playback.playing


def test_seeking_stays_inside_the_record():
    playback = Playback(1.0, 2.0)
    for asked, time in ((-5.0, 1.0), (1.5, 1.5), (9.0, 2.0)):
        playback.seek(asked)
        assert playback.time == time


def test_a_slowed_step_says_by_which_joint() -> None:
    blocking = np.zeros((10, 7), int)
    blocking[3, 3] = -2
    record = make_record(action=[0, 0, 0, 2, 3, 0, 0, 0, 0, 0], blocking=blocking)
    words = [policy_words(record, step) for step in (2, 3, 4)]
    assert words == ["-", "slowed, joint 4 lower velocity limit", "relaxed"]


def test_the_verdict_is_shown_and_harmless() -> None:
    assert "completed" in readout.verdict([])
    shown = readout.verdict(["path completed 12 %", "<b>"])
    assert "path completed 12 %" in shown
    assert "&lt;b&gt;" in shown
    assert readout.marks([(0.2, 0.3)]).count("left:20.00%") == 1
