# make heart needs the package alone, make test all extras; ARGS="..." is handed on.

PYTHON ?= python3
EXTRAS ?= robots,sim,view,dev
ARGS ?=
VENV := .venv
VENV_PYTHON := $(VENV)/bin/python
PLAIN := $(VENV)/.plain
FULL := $(VENV)/.full
# Where it is set, each process compiles the source of all that it imports.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help force heart test setup lint docs figures notebooks ros franka cuda integrations clean

help:  ## list what can be made
	@echo 'usage: make TARGET [PYTHON=python3.12] [EXTRAS=view] [ARGS="..."]'
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  \1\t\2/p' $(MAKEFILE_LIST) | expand -t 14

heart: $(PLAIN)  ## install the package in .venv, draw the heart, every step checked; results in runs/heart
	$(VENV_PYTHON) scripts/track_heart.py $(ARGS)

# As many processes as cores: threads of theirs would only wait for each other.
test: $(FULL)  ## install all extras, run the tests
	OPENBLAS_NUM_THREADS=1 $(VENV_PYTHON) -m pytest -n auto --dist worksteal $(ARGS)

setup: $(FULL)  ## install all extras, or those that EXTRAS= names

lint: $(FULL)  ## check style, layout and types
	$(VENV_PYTHON) -m ruff check .
	$(VENV_PYTHON) -m ruff format --check .
	$(VENV_PYTHON) -m mypy

docs: $(FULL)  ## build the documentation into site/, any warning an error
	$(VENV_PYTHON) -m sphinx -W --keep-going -q -b html docs site $(ARGS)

figures: $(FULL)  ## draw the figures of the pages anew, minutes, and the two live pages, with clang and lld
	$(VENV_PYTHON) docs/figures.py $(ARGS)
	$(VENV_PYTHON) docs/browser/make_page.py

notebooks: $(FULL)  ## run the notebooks; what they print is not kept
	$(VENV_PYTHON) -m pytest --nbmake --nbmake-timeout=60 notebooks $(ARGS)

ros: $(FULL)  ## try the ROS 2 node in an environment of its own, build/ros2, 255 MB
	$(VENV_PYTHON) -m pytest integrations/ros2_shield $(ARGS)

cuda: $(FULL)  ## compile an exported shield for GPUs by NVRTC's wheel, build/cuda, 142 MB, no GPU needed
	@test -d build/cuda/nvidia || $(VENV_PYTHON) -m pip install -q --disable-pip-version-check --target build/cuda -c constraints.txt nvidia-cuda-nvrtc
	PYTHONPATH=build/cuda $(VENV_PYTHON) -m pytest tests/export/compile_cuda.py $(ARGS)

franka: $(FULL)  ## try the script for a Franka on franka-sim in an environment of its own, build/franka-sim
	$(VENV_PYTHON) -m pytest tests/scripts/test_franka.py $(ARGS)

integrations: ros franka  ## the same for LeRobot, 5 GB, Python >= 3.12 (PYTHON_OF_LEROBOT=)
	$(VENV_PYTHON) -m pytest integrations/lerobot_robot_shielded $(ARGS)

clean:  ## remove .venv, caches and what was built; runs/ stays
	rm -rf $(VENV) iiwa_dnn/_kernels.* build integrations/*/build dist site jupyter_execute htmlcov .coverage .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find iiwa_dnn tests scripts benchmarks integrations -name __pycache__ -prune -exec rm -rf {} +

# A stamp comes last, so that a set-up cut short is done again; named extras are not all of them.
$(PLAIN): pyproject.toml constraints.txt
	@$(call install,.,0.7 GB on disk)
	@touch $@

$(FULL): pyproject.toml constraints.txt $(if $(filter command,$(origin EXTRAS)),force)
	@$(call install,.[$(EXTRAS)],2.1 GB on disk with all extras)
	@touch $(PLAIN) $(if $(filter command,$(origin EXTRAS)),,$@)

# Beside the package, what Debian leaves out of its own Python is asked for by name.
define install
	fail() { echo "setup: $$1" >&2; exit 1; }; \
	command -v $(PYTHON) >/dev/null || fail '$(PYTHON) not found; name a Python >= 3.10: make PYTHON=...'; \
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
		fail "Python >= 3.10 is needed, $(PYTHON) is $$($(PYTHON) -c 'import platform; print(platform.python_version())'); name another: make PYTHON=..."; \
	$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
		fail '$(PYTHON) lacks its venv module; on Debian and Ubuntu: apt-get install python3-venv'; \
	$(PYTHON) -c 'import os, sysconfig; os.stat(sysconfig.get_paths()["include"] + "/Python.h")' 2>/dev/null || \
		fail '$(PYTHON) lacks its C headers; on Debian and Ubuntu: apt-get install python3-dev'; \
	$(PYTHON) -c 'import ctypes, sys; sys.platform == "linux" and ctypes.CDLL("libgomp.so.1")' 2>/dev/null || \
		fail 'the OpenMP library that Pinocchio and ProxQP load is missing; on Debian and Ubuntu: apt-get install libgomp1'; \
	echo 'setup: installing $(1) in $(VENV): $(2)'; \
	$(VENV_PYTHON) -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(VENV); \
	$(VENV_PYTHON) -m pip install -q --no-compile --disable-pip-version-check -c constraints.txt -e '$(1)' & \
	pip=$$!; seconds=0; while kill -0 $$pip 2>/dev/null; do \
		printf '\rsetup: %s s, %s MB in $(VENV) (pip downloads all before it installs)' $$seconds "$$(du -sm $(VENV) 2>/dev/null | cut -f1)"; \
		sleep 3; seconds=$$((seconds + 3)); done; echo; wait $$pip
endef
