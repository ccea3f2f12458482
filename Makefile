# The targets of a user: make setup, make heart, make test. ARGS="..." is handed on.

PYTHON ?= python3
VENV := .venv
VENV_PYTHON := $(VENV)/bin/python
PACKAGES := $(VENV)/.packages
ARGS ?=
# Where it is set, each process compiles the source of all that it imports.
unexport PYTHONDONTWRITEBYTECODE
EXTRAS ?= robots,sim,view,dev

.DEFAULT_GOAL := help
.PHONY: help force setup heart physics view test sanitize notebooks docs coverage lint format types clean

help:  ## list what can be made
	@echo 'usage: make TARGET [PYTHON=python3.12] [EXTRAS=view] [ARGS="..."]'
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  \1\t\2/p' $(MAKEFILE_LIST) | expand -t 14

setup: $(PACKAGES)  ## make .venv and install the package in it; EXTRAS= names some extras only

# A stamp comes last, so that a setup cut short is done again; other extras are installed anew.
$(PACKAGES): pyproject.toml constraints.txt $(if $(filter command,$(origin EXTRAS)),force)
	@command -v $(PYTHON) >/dev/null || \
		{ echo 'setup: $(PYTHON) not found; name a Python >= 3.10: make setup PYTHON=...' >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
		{ echo "setup: Python >= 3.10 is needed, $(PYTHON) is $$($(PYTHON) -c 'import platform; print(platform.python_version())'); name another: make setup PYTHON=..." >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
		{ echo 'setup: $(PYTHON) lacks its venv module; on Debian and Ubuntu: apt-get install python3-venv' >&2; exit 1; }
	@$(PYTHON) -c 'import os, sys, sysconfig; sys.exit(not os.path.isfile(os.path.join(sysconfig.get_paths()["include"], "Python.h")))' || \
		{ echo 'setup: $(PYTHON) lacks its C headers; on Debian and Ubuntu: apt-get install python3-dev' >&2; exit 1; }
	@$(PYTHON) -c 'import ctypes, sys; sys.platform == "linux" and ctypes.CDLL("libgomp.so.1")' 2>/dev/null || \
		{ echo 'setup: the OpenMP library that Pinocchio and ProxQP load is missing; on Debian and Ubuntu: apt-get install libgomp1' >&2; exit 1; }
	@echo 'setup: making $(VENV) with the extras $(EXTRAS)'
	@$(VENV_PYTHON) -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(VENV)
	@echo 'setup: 2.3 GB on disk with all extras, 1.0 GB with EXTRAS=view; the first time takes some minutes'
	@$(VENV_PYTHON) -m pip install -q --no-compile --disable-pip-version-check -c constraints.txt -e '.[$(EXTRAS)]' & \
		pip=$$!; seconds=0; while kill -0 $$pip 2>/dev/null; do \
		printf '\rsetup: %s s, %s MB in $(VENV) (pip downloads all before it installs)' $$seconds "$$(du -sm $(VENV) 2>/dev/null | cut -f1)"; \
		sleep 3; seconds=$$((seconds + 3)); done; echo; wait $$pip
	@touch $@

heart: $(PACKAGES)  ## draw the heart, every step checked; results in runs/heart
	$(VENV_PYTHON) scripts/track_heart.py $(ARGS)

physics: $(PACKAGES)  ## draw the heart in physics, with pictures and a video; in runs/physics
	$(VENV_PYTHON) -m iiwa_dnn physics $(ARGS)

view: $(PACKAGES)  ## replay a run in the browser: ARGS=runs/heart
	$(VENV_PYTHON) -m iiwa_dnn view $(ARGS)

# As many processes as cores: threads of theirs would only wait for each other.
test: $(PACKAGES)  ## run the tests
	OPENBLAS_NUM_THREADS=1 $(VENV_PYTHON) -m pytest -n auto --dist worksteal $(ARGS)

# Built anew afterwards. A sanitizer's own allocator reports what Python keeps until its end.
sanitize: $(PACKAGES)  ## run the tests on a library that checks addresses and undefined behaviour
	rm -f iiwa_dnn/_kernels.*
	CFLAGS='-g -fsanitize=address,undefined -fno-sanitize-recover=undefined' LD_PRELOAD="$$(cc -print-file-name=libasan.so) $$(cc -print-file-name=libstdc++.so)" \
		ASAN_OPTIONS=detect_leaks=0 $(VENV_PYTHON) -m pytest -q -m "not long" \
		tests/compiling tests/control tests/networks tests/qp tests/references tests/schemes; \
		code=$$?; rm -f iiwa_dnn/_kernels.*; exit $$code

notebooks: $(PACKAGES)  ## run the notebooks; what they print is not kept
	$(VENV_PYTHON) -m pytest --nbmake --nbmake-timeout=60 notebooks $(ARGS)

docs: $(PACKAGES)  ## build the documentation into site/, any warning an error
	$(VENV_PYTHON) -m sphinx -W --keep-going -q -b html docs site $(ARGS)

coverage: $(PACKAGES)  ## run the tests and show which lines of the package they reach
	$(VENV_PYTHON) -m pytest -n auto --cov --cov-report=term-missing $(ARGS)

lint: $(PACKAGES)  ## look for slips and for untidy layout
	$(VENV_PYTHON) -m ruff check .
	$(VENV_PYTHON) -m ruff format --check .

format: $(PACKAGES)  ## mend what can be mended by itself
	$(VENV_PYTHON) -m ruff check --fix .
	$(VENV_PYTHON) -m ruff format .

types: $(PACKAGES)  ## check the types of the package
	$(VENV_PYTHON) -m mypy

clean:  ## remove .venv, caches and what was built; runs/ stays
	rm -rf $(VENV) iiwa_dnn/_kernels.* build dist site jupyter_execute htmlcov .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find iiwa_dnn tests scripts benchmarks -name __pycache__ -prune -exec rm -rf {} +
