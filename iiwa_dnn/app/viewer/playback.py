"""The clock of a replay."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Playback:
    """Where a replay is, and how fast it runs.

    Attributes:
        start: First time of the record [s].
        end: Its last time [s].
        time: Where the replay is [s].
        speed: Record seconds in a second.
        playing: Whether it runs.
    """

    start: float
    end: float
    time: float = 0.0
    speed: float = 1.0
    playing: bool = False

    def __post_init__(self) -> None:
        self.seek(self.time)

    def play(self) -> None:
        """Run on; from the start again, if the end was reached."""
        if self.time >= self.end:
            self.time = self.start
        self.playing = True

    def pause(self) -> None:
        """Stand still."""
        self.playing = False

    def toggle(self) -> None:
        """Play where it stands still, pause where it runs."""
        (self.pause if self.playing else self.play)()

    def seek(self, time: float) -> None:
        """Go to a time [s], or to the end that is nearer."""
        self.time = min(max(time, self.start), self.end)

    def advance(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass; the replay stops at its end."""
        if self.playing:
            self.seek(self.time + self.speed * elapsed)
            self.playing = self.time < self.end
