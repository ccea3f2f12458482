"""The notebooks as they are kept: run in one go, without errors, small."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


def test_there_are_notebooks() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["quickstart", "solver_comparison"]
    assert sum(path.stat().st_size for path in NOTEBOOKS) < 900_000


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_kept_outputs_are_those_of_one_run_in_order(path: Path) -> None:
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    outputs = [output for cell in code for output in cell["outputs"]]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert not [output for output in outputs if output["output_type"] == "error"]
    # A warning would end up here.
    assert not [output for output in outputs if output.get("name") == "stderr"]
    # No path of the machine it ran on.
    assert "/home/" not in path.read_text(encoding="utf-8")
    if path.stem == "quickstart":
        assert len(code) == 10


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_cells_run(path: Path) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    for name in ("piqp", "daqp", "quadprog") if path.stem == "solver_comparison" else ():
        pytest.importorskip(name, reason="pip install 'iiwa-dnn[bench]'")
    pyplot.switch_backend("agg")
    names: dict[str, object] = {}
    with pyplot.rc_context():
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), path.name, "exec"), names)
    pyplot.close("all")
