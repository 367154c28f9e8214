PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: help setup demo test test-fast lint format clean

help:
	@echo "make demo       from nothing to tracked, recorded object poses on this machine"
	@echo "make test       every test, as CI runs them"
	@echo "make test-fast  the tests without the long ones"
	@echo "make lint       ruff, mypy and the import rules"
	@echo "make setup      all that development needs, in $(VENV)"

demo: $(VENV)/run.stamp
	$(BIN)/inhand demo

test: setup
	$(BIN)/pytest

test-fast: setup
	$(BIN)/pytest -m "not long"

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: setup
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

setup: $(VENV)/dev.stamp

$(VENV)/run.stamp: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Inhand needs Python 3.11 or newer: make $(MAKECMDGOALS) PYTHON=python3.11"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable .
	@touch $@

$(VENV)/dev.stamp: $(VENV)/run.stamp
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	@touch $@

clean:
	rm -rf $(VENV) demo recordings
