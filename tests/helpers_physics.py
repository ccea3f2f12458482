"""What the tests of physics and pictures share: the paper's heart, and what a machine lacks."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from helpers_kinematics import PAPER_Q0
from helpers_simulation import run
from iiwa_dnn import Record
from iiwa_dnn.simulation import Disturbances

ROOT = Path(__file__).parents[1]
START = np.array(PAPER_Q0)


def heart_in_physics(disturbances: Disturbances | None = None, **options: object) -> Record:
    """The paper's heart in physics, by default without a cross-check."""
    plant = iiwa_dnn.MujocoPlant(disturbances, timestep=2.5e-4)
    return run(plant=plant, **{"duration": None} | options)


def heart_without_physics(steps: int = 500) -> Record:
    """The paper's heart, quickly: for tests of what is drawn."""
    return run(dt=10.0 / steps, duration=10.0)


def distance(record: Record) -> np.ndarray:
    """Distance from the tip to where it should be [m], (N+1,)."""
    return np.linalg.norm(record.position - record.position_desired, axis=1)


def run_python(
    code: str, timeout: float = 300.0, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run a few lines in a Python of their own, the package found where it is."""
    return subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | environment, cwd=ROOT, capture_output=True, text=True, timeout=timeout,
    )  # fmt: skip


def _opengl_is_there() -> bool:
    from iiwa_dnn.robot import mujoco_model

    try:
        mujoco_model.prepare_renderer()
    except iiwa_dnn.MissingDependencyError:
        return False
    return True


needs_opengl = pytest.mark.skipif(
    not _opengl_is_there(),
    reason="no OpenGL without a display: on Debian, apt-get install libegl1 libgl1",
)
