# Each target sets up its own .venv; all that is needed beforehand is python3 >= 3.11 and make.
PYTHON ?= python3
BIN := .venv/bin
export PATH := $(CURDIR)/$(BIN):$(PATH)
# small matrices: threads of BLAS would only wait for each other
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
# a hundred jobs would compile the same sources
export PYTHONDONTWRITEBYTECODE :=

.PHONY: help install reproduce test checked small-run test-long benchmark proof fuzz campaign docs clean
help:
	@echo "make install     sets up .venv alone, with the command armscope in .venv/bin"
	@echo "make reproduce   the paper, end to end: Table 2, Figs 1-11, claims, report"
	@echo "make test        lint, types, unit tests, a small run of the whole workflow"
	@echo "make test-long   slower tests, and quick ones on more seeds; before a release, and after a change of the diagnosis"
	@echo "make benchmark   speed beside other packages, as ratios from one run"
	@echo "make proof       the diagnosis on worlds with concealed effects"
	@echo "make fuzz        an hour of bad files (SECONDS=60: a minute), and 3000 for every reader"
	@echo "make campaign    what happens when it is broken on purpose (TIMES=1: a few minutes)"
	@echo "make docs        the documentation as a site in site/, with a gallery of reports"
	@echo "make clean       remove .venv and results"

install: .venv/installed

reproduce: .venv/installed
	$(BIN)/snakemake -j2

test: .venv/installed-test
	$(MAKE) --no-print-directory -j2 checked small-run
	# what a module sets up for its tests is set up once: in one process
	$(BIN)/pytest -n 2 --dist loadscope -m "not long"

checked:
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/python workflow/lint.py
	$(BIN)/mypy

small-run:
	$(BIN)/snakemake -j2 all results/small/poses/seven_axis.csv --configfile config/small.yaml --forceall

# about a second or more each, or a quick claim again on more seeds; those of real arms need their recordings beside the project
test-long: .venv/installed-test
	$(BIN)/pytest -n 2 --dist loadscope -m long

# the packages compared with need older versions of ours, so they live in environments of their own
benchmark: .venv/installed .venv-peers/installed .venv-figaroh/installed .venv-sysid/installed .venv-aurt/installed
	$(BIN)/python -m benchmarks.kinematics
	$(BIN)/python -m benchmarks.diagnosis
	$(BIN)/python -m benchmarks.evidence
	$(BIN)/python -m benchmarks.motion --figaroh .venv-figaroh/bin/python --sysid .venv-sysid/bin/python --aurt .venv-aurt/bin/python
	$(BIN)/python -m benchmarks.poses
	$(BIN)/python -m benchmarks.compensation
	.venv-peers/bin/python -m benchmarks.swarm
	$(BIN)/python -m benchmarks.calibration --pybotics .venv-peers/bin/python --figaroh .venv-figaroh/bin/python

proof: .venv/installed
	$(BIN)/snakemake -j2 proof

# files that no reader may choke on: an hour of them; what fails is kept in tests/fuzz/cases and tested from then on
SECONDS ?= 3600
fuzz: .venv/installed-test
	$(BIN)/python -m tests.fuzz --seconds $(SECONDS)
	$(BIN)/python -m tests.fuzz --files 3000 --seconds 1e6

# a pip of its own: older ones, which come with older pythons, hold every file in the index against a thousand tags, which is
# half of the time that an installation takes
.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "armscope needs python 3.11 or newer: make PYTHON=/path/to/python3.11"; exit 1; }
	$(PYTHON) -m venv .venv
	$(BIN)/$(PIP_INSTALL) --require-hashes -r requirements-pip.lock

# what is installed must be, byte by byte, what was pinned (tools/lock.py), wherever it comes from
PIP_INSTALL := pip install --quiet --disable-pip-version-check
.venv/installed: .venv/bin/python requirements.lock pyproject.toml
	$(BIN)/$(PIP_INSTALL) --require-hashes -r requirements.lock
	$(BIN)/$(PIP_INSTALL) --no-deps --editable .
	$(BIN)/python -c "from armscope.swarm import kernel; kernel.compile_now()"
	@touch $@

# one call for all, since each looks through the index for every package; byte code is made of what is imported, which is the
# smaller part of it, and by whatever imports it first, beside other work
.venv/installed-test: .venv/bin/python requirements.lock requirements-test.lock pyproject.toml
	$(BIN)/$(PIP_INSTALL) --no-compile --require-hashes -r requirements-test.lock
	$(BIN)/$(PIP_INSTALL) --no-compile --no-deps --editable .
	$(BIN)/python -c "from armscope.swarm import kernel; kernel.compile_now()"
	@touch .venv/installed $@

.venv-peers/installed: requirements-benchmark.txt
	$(PYTHON) -m venv .venv-peers
	.venv-peers/bin/$(PIP_INSTALL) -r requirements-benchmark.txt
	.venv-peers/bin/$(PIP_INSTALL) --no-deps --editable .
	@touch $@

.venv-figaroh/installed .venv-sysid/installed .venv-aurt/installed: .venv-%/installed: benchmarks/peers/requirements-%.txt
	$(PYTHON) -m venv .venv-$*
	.venv-$*/bin/$(PIP_INSTALL) -r $<
	@touch $@

# kills, full disks, too little memory, two of everything, SLURM: prints a table, docs/trust.md is made from it
TIMES ?= 20
campaign: .venv/installed-test
	-$(BIN)/$(PIP_INSTALL) --require-hashes -r requirements-cluster.lock
	-$(BIN)/$(PIP_INSTALL) pip-audit
	$(BIN)/python -m tests.campaign --times $(TIMES) --page docs/trust.md

# works from files: open site/index.html
GALLERY := clean one-effect five-effects seven-axes-modified-dh
docs: .venv-docs/installed $(GALLERY:%=docs/gallery/%/report.html)
	.venv-docs/bin/mkdocs build --quiet

docs/gallery/%/report.html: examples/%/recordings.csv examples/%/robot.yaml | .venv/installed
	$(BIN)/armscope diagnose $< -r examples/$*/robot.yaml -o docs/gallery/$*

.venv-docs/installed: requirements-docs.txt
	$(PYTHON) -m venv .venv-docs
	.venv-docs/bin/pip install --quiet --disable-pip-version-check -r requirements-docs.txt
	@touch $@

clean:
	rm -rf site docs/gallery .venv .venv-docs .venv-peers .venv-figaroh .venv-sysid .venv-aurt results .snakemake
