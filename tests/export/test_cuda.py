"""A shield's kernels over a grid, run on the CPU: the bits of its C."""

import copy
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_cuda import FREE, LOCAL, Device, on_grid, to_device
from helpers_export import needs, use_armstep
from hostile_arms import DT, START, compare, make_shield
from iiwa_dnn import export

pytestmark = needs("gcc", "g++")

COUNT = 45  # no multiple of a block


@pytest.fixture(scope="module")
def make(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return on_grid(make_shield(), tmp_path_factory.mktemp("cuda"))


def tiled(own: Any, count: int = COUNT) -> Any:
    return to_device(np.tile(own, (count, 1)))


def test_hostile_steps_over_a_grid_have_the_bits_of_the_cpu(make: Any) -> None:
    shields = make(COUNT), make(COUNT, device="cuda")
    differing, path = compare(*shields, 330, to_device, np.array)
    assert differing == 0
    assert np.abs(path[-1] - START).max() > 0.05
    for i in (0, COUNT - 1):
        a, b = ((s.active_limits(i), s.margin(i), s.stopping_time(i)) for s in shields)
        assert a == b
    # An arm is answered as alone.
    shields[0].halt()
    assert compare(*shields, 5, to_device, np.array)[0] > 0


def test_periods_moving_obstacles_and_numbers_of_other_types(make: Any) -> None:
    cpu, gpu = make(COUNT), make(COUNT, device="cuda")
    random = np.random.default_rng(1)
    q = np.tile(START, (COUNT, 1))
    near = np.array([0.36, 0.16, 0.64])
    for k in range(40):
        request = random.standard_normal((COUNT, 7)).astype(np.float32)
        places = near + 0.1 * random.standard_normal((COUNT, 1, 3) if k % 2 else (1, 3))
        own = {"dq": request, "obstacles": places, "dt": 0.5 * DT if k % 5 == 0 else None}
        expected = cpu.step(q, **own)
        wide = to_device(np.repeat(q, 2, axis=1))[:, ::2]
        own |= {"dq": to_device(request), "obstacles": to_device(places)}
        found = gpu.step(wide, **own)
        assert [np.array(a).tobytes() for a in found[:4]] == [b.tobytes() for b in expected[:4]]
        q = expected.next_q


def test_halt_reset_copies_and_pickles(make: Any) -> None:
    cpu, gpu = make(COUNT), make(COUNT, device="cuda")
    mask = np.arange(COUNT) % 3 == 0
    q, dq = np.tile(START, (COUNT, 1)), np.full((COUNT, 7), 0.2)

    def both() -> None:
        expected, found = cpu.step(q, dq), gpu.step(to_device(q), to_device(dq))
        assert np.array(found.dq).tobytes() == expected.dq.tobytes()
        assert np.array(found.reason).tolist() == expected.reason.tolist()

    both()
    cpu.halt(mask)
    gpu.halt(to_device(mask))
    both()
    assert np.array(gpu.step(to_device(q)).reason)[mask].all()
    cpu.step(q)
    gpu = pickle.loads(pickle.dumps(copy.deepcopy(gpu)))
    assert isinstance(gpu, use_armstep().Shields)
    assert gpu.device == "cuda"
    both()
    cpu.reset(mask, q + 0.001)
    gpu.reset(to_device(mask), to_device(q + 0.001))
    both()
    cpu.reset()
    gpu.reset()
    both()


def test_a_bad_row_has_its_reason_and_no_other_row_knows(make: Any) -> None:
    gpu, alone = make(3, device="cuda"), make(3)
    q, dq = np.tile(START, (3, 1)), np.full((3, 7), 0.2)
    places = np.tile([[0.36, 0.16, 0.64]], (3, 1, 1))
    places[0, 0, 1] = np.nan
    bad = q.copy()
    bad[2, 4] = np.nan
    found = gpu.step(to_device(bad), to_device(dq), obstacles=to_device(places))
    assert use_armstep().Reason(int(np.array(found.reason)[0])).name == "NOT_FINITE"
    assert use_armstep().Reason(int(np.array(found.reason)[2])).name == "Q_NOT_FINITE"
    expected = alone.step(q, dq)
    assert np.array(found.dq)[1].tobytes() == expected.dq[1].tobytes()
    assert not np.array(found.dq)[[0, 2]].any()


def test_place_and_saved_states_are_for_the_cpu(make: Any) -> None:
    gpu = make(2, device="cuda")
    for call in (lambda: gpu.place(np.zeros((1, 3))), gpu.save):
        with pytest.raises(ValueError, match="are for the CPU"):
            call()


@pytest.mark.parametrize(
    ("own", "said"),
    [
        ({"q": np.zeros((COUNT, 7))}, "q: must be an array on the GPU, not ndarray"),
        ({"q": tiled(START, 2)}, r"q: must be of shape \(45, 7\)"),
        ({"dq": tiled(START), "twist": tiled(np.zeros(6))}, "pass exactly one"),
        ({"given": tiled(START)}, "given: must be of shape"),
        ({"dt": -1.0}, "must be above 0 s"),
    ],
)
def test_wrong_input_is_an_error(make: Any, own: dict[str, Any], said: str) -> None:
    gpu = make(COUNT, device="cuda")
    with pytest.raises(ValueError, match=said):
        gpu.step(**{"q": tiled(START), **own})


def test_too_many_arms_are_refused_with_bytes_an_arm(make: Any) -> None:
    each = 8 * make(1).tables.memory + 16 * 7 + 5
    with pytest.raises(MemoryError, match=f"take {each} bytes each"):
        make(FREE // each + 1, device="cuda")


def test_the_stack_of_the_threads_counts_until_they_have_it(
    make: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Device, "mem_info", (LOCAL * 132 * 2048, 0))
    sys.modules["armstep.cuda"].RUNNING.clear()
    with pytest.raises(MemoryError, match="stack of the GPU's threads 10813 MB"):
        make(1, device="cuda")
    monkeypatch.undo()
    make(1, device="cuda").step(tiled(START, 1))
    monkeypatch.setattr(Device, "mem_info", (10**6, 0))
    make(1, device="cuda")


def test_what_is_missing_is_said_in_a_line(tmp_path: Path) -> None:
    path = export.tables(make_shield(), tmp_path / "arm.json")
    lines = "import sys; sys.modules['cupy'] = None; from armstep import Shields"
    lines += f"; Shields({str(path)!r}, 2, device='cuda')"
    folder = Path(use_armstep().__file__).parents[1]
    command = [sys.executable, "-c", lines]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert "no cupy: pip install 'armstep[cuda]'" in done.stderr.splitlines()[-1]
