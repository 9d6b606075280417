"""What all tests share: one BLAS thread, as the command line has it."""

import os
import signal

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")  # read when numpy is imported; small matrices only wait for more threads

# a run that a script starts in the background ignores Ctrl-C, and would hand that down to the commands under test
signal.signal(signal.SIGINT, signal.default_int_handler)
