PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# Tests start hundreds of processes: without this, each of them would compile our sources anew.
unexport PYTHONDONTWRITEBYTECODE

CONTRIB := .venv-contrib
ON_ALL_CORES := --numprocesses auto --dist loadfile --no-loadscope-reorder

.PHONY: help setup contrib demo demo-camera test test-exhaustive test-fast lint format clean

help:
	@echo "make demo         from nothing to tracked, recorded object poses on this machine"
	@echo "make demo-camera  the same as with a real camera: the person is found in the pictures"
	@echo "make test         the tests, as CI runs them"
	@echo "make test-fast    the tests without the long ones"
	@echo "make test-exhaustive   long checks of measures and training, which CI leaves out"
	@echo "make lint         ruff, mypy and the import rules"
	@echo "make contrib      OpenCV's contrib build in $(CONTRIB), for inhand recognise --contrib"
	@echo "make setup        all that development needs, in $(VENV)"

demo: $(VENV)/run.stamp
	$(BIN)/inhand demo

demo-camera: $(VENV)/pose.stamp
	$(BIN)/inhand models fetch
	$(BIN)/inhand demo --camera-like

test: setup
	$(BIN)/pytest $(ON_ALL_CORES) -m "not exhaustive"

test-exhaustive: setup
	$(BIN)/pytest $(ON_ALL_CORES) -m exhaustive

test-fast: setup
	$(BIN)/pytest $(ON_ALL_CORES) -m "not long and not exhaustive"

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: setup
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

setup: $(VENV)/dev.stamp

# Each of the stamps installs all that it stands for in one go, and stands for those below it too.
# CI compiles what is installed later, beside other work: make setup PIP_OPTIONS=--no-compile
PIP := $(BIN)/pip install $(PIP_OPTIONS) --quiet --disable-pip-version-check --constraint constraints.txt

$(BIN)/pip:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Inhand needs Python 3.11 or newer: make $(MAKECMDGOALS) PYTHON=python3.11"; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/run.stamp: pyproject.toml constraints.txt | $(BIN)/pip
	$(PIP) --editable '.[lab]'
	@touch $@

$(VENV)/pose.stamp: pyproject.toml constraints.txt | $(BIN)/pip
	$(PIP) --editable '.[lab,pose]'
	@touch $@ $(VENV)/run.stamp

$(VENV)/dev.stamp: pyproject.toml constraints.txt | $(BIN)/pip
	$(PIP) --editable '.[dev]'
	@touch $@ $(VENV)/pose.stamp $(VENV)/run.stamp

# The contrib build and the headless one are the same module cv2: they cannot share an environment.
contrib: $(CONTRIB)/run.stamp

$(CONTRIB)/run.stamp:
	$(PYTHON) -m venv $(CONTRIB)
	$(CONTRIB)/bin/pip install --quiet --disable-pip-version-check 'opencv-contrib-python-headless>=4.10'
	@touch $@

clean:
	rm -rf $(VENV) $(CONTRIB) demo recordings
