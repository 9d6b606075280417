"""A deferred module is not read before something in it is asked for, and is whole then."""

from __future__ import annotations

import subprocess
import sys

ASKED_LATER = """
import numpy, sys
from armscope.core.deferral import defer
defer("numpy", "f2py", "testing", "no_such_module")
import scipy.linalg
assert "numpy.f2py.crackfortran" not in sys.modules and "unittest" not in sys.modules
numpy.testing.assert_allclose(1, 1)
from numpy.f2py import run_main
assert run_main and "numpy.f2py.crackfortran" in sys.modules and "unittest" in sys.modules
assert "numpy.no_such_module" not in sys.modules
"""
COMMAND = """
import sys
sys.argv = ["armscope", "--version"]
from armscope.__main__ import main
try:
    main()
except SystemExit:
    pass
import armscope.fitting.gauss_newton
assert "scipy.linalg" in sys.modules and "numpy.f2py.crackfortran" not in sys.modules
"""


def run(program: str) -> None:
    subprocess.run([sys.executable, "-c", program], check=True)


def test_a_deferred_module_is_read_when_it_is_asked_for() -> None:
    run(ASKED_LATER)


def test_a_command_that_needs_scipy_does_not_read_the_compiler_of_fortran() -> None:
    run(COMMAND)


def test_of_a_package_that_is_not_imported_nothing_is_deferred() -> None:
    deferred = "import sys; from armscope.core.deferral import defer; defer('numpy', 'f2py')"
    run(deferred + "; assert 'numpy' not in sys.modules")
