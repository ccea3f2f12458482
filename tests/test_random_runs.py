"""The first of the random runs; tests/random_runs.py does as many as one likes."""

from __future__ import annotations

from random_runs import ROBOTS, faults


def test_limits_hold_and_every_run_has_an_end() -> None:
    actions, clipped, robots = set(), 0, set()
    for number in range(45):
        record, _, found = faults(number)
        assert not found, f"run {number}: {found}"
        robots.add(record.settings["robot"])
        if record.action is not None:
            actions |= set(record.action.tolist())
        clipped += 0 if record.clipped is None else int(record.clipped.sum())
    # Otherwise nothing was tried.
    assert len(robots) == len(ROBOTS)
    assert {0, 2, 3, 4} <= actions
    assert clipped > 100
