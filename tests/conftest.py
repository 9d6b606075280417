"""What all tests share: one BLAS thread and rare searches for garbage, as the command line has it, and byte code."""

import functools
import gc
import os
import signal
import sys
from collections.abc import Iterator

import hypothesis
import pytest
import typer.testing

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")  # read when numpy is imported; small matrices only wait for more threads

# commands under test start as a user's do, by byte code: they would compile the same sources some hundred times
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# a run that a script starts in the background ignores Ctrl-C, and would hand that down to the commands under test
signal.signal(signal.SIGINT, signal.default_int_handler)

gc.set_threshold(20_000, 20, 20)

# no test fails by its time: the first example of a property may import what is slow to import
hypothesis.settings.register_profile("untimed", deadline=None)
hypothesis.settings.load_profile("untimed")

# a command line is made of its functions once in a process; typer's runner would make all of it again for every line
typer.testing._get_command = functools.cache(typer.testing._get_command)


def pytest_collection_finish() -> None:
    """Four thousand tests and all modules stay to the end: looking for garbage among them finds none."""
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True)
def closed_figures() -> Iterator[None]:
    """A test that draws leaves no figure open for the next ones."""
    yield
    if (pyplot := sys.modules.get("matplotlib.pyplot")) is not None:
        pyplot.close("all")
