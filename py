#!/bin/bash
export PYTHONPATH=/work/wt/b:/work/wt/b/tests:$PYTHONPATH OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
exec /work/main/.venv/bin/python "$@"
