"""A short, seeded part of the fuzzing; tests/fuzz_readers.py goes on for as long as one likes."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from fuzz_readers import SOURCES, case

CASES = 1200


# What a reader warns of, a number too large for example, is no error of its own.
@pytest.mark.filterwarnings("default")
def test_damaged_files_are_read_or_refused_and_nothing_else(tmp_path: Path) -> None:
    counts = Counter(case(number, tmp_path) for number in range(CASES))
    broken = [(name, outcome) for name, outcome in counts if outcome not in ("read", "refused")]
    assert not broken, "\n".join(f"{name}: {outcome}" for name, outcome in broken)
    # The damage is neither so small nor so large that one of the two never happens.
    for name in SOURCES:
        assert counts[name, "refused"] > CASES / 40
        if name != "npz":  # its check sums notice nearly everything
            assert counts[name, "read"] > CASES / 200
