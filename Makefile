# Each target sets up its own .venv; all that is needed beforehand is python3 >= 3.11 and make.
PYTHON ?= python3
BIN := .venv/bin
export PATH := $(CURDIR)/$(BIN):$(PATH)

.PHONY: help reproduce test benchmark proof clean
help:
	@echo "make reproduce   the paper, end to end: Table 2, Figs 3-11, claims, report"
	@echo "make test        lint, types, unit tests, a small run of the whole workflow"
	@echo "make benchmark   speed beside other packages, as ratios from one run"
	@echo "make proof       the diagnosis on worlds with concealed effects"
	@echo "make clean       remove .venv and results"

reproduce: .venv/installed
	$(BIN)/snakemake -j2

test: .venv/installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/snakemake --lint
	$(BIN)/snakemake -j2 --configfile config/small.yaml --forceall
	$(BIN)/pytest -n 2

benchmark: .venv/installed-benchmark
	$(BIN)/python -m benchmarks

proof: .venv/installed
	$(BIN)/snakemake -j2 proof

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "armscope needs python 3.11 or newer: make PYTHON=/path/to/python3.11"; exit 1; }
	$(PYTHON) -m venv .venv

.venv/installed: .venv/bin/python requirements.txt pyproject.toml
	$(BIN)/pip install --quiet --disable-pip-version-check -r requirements.txt
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --editable .
	@touch $@

.venv/installed-test: .venv/installed requirements-test.txt
	$(BIN)/pip install --quiet --disable-pip-version-check -r requirements-test.txt
	@touch $@

.venv/installed-benchmark: .venv/installed requirements-benchmark.txt
	$(BIN)/pip install --quiet --disable-pip-version-check -r requirements-benchmark.txt
	@touch $@

clean:
	rm -rf .venv results .snakemake
