"""What all tests share: one BLAS thread, as the command line has it, and byte code that is kept."""

import os
import signal
import sys

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")  # read when numpy is imported; small matrices only wait for more threads

# commands under test start as a user's do, by byte code: they would compile the same sources some hundred times
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# a run that a script starts in the background ignores Ctrl-C, and would hand that down to the commands under test
signal.signal(signal.SIGINT, signal.default_int_handler)
