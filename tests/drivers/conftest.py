"""The library that the tests use, of the kernels in this checkout."""

import shutil

from helpers_export import use_armstep

if shutil.which("gcc"):
    use_armstep()
else:
    collect_ignore_glob = ["test_*.py"]
