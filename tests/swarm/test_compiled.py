"""The compiled loops: their cache must not go stale."""

import pytest

pytest.importorskip("numba")


def test_all_compiled_loops_live_in_one_file():
    """A function's cache follows its own file only: what it calls must stand in the same one."""
    from numba.core.registry import CPUDispatcher

    from armscope.swarm import compiled

    loops = [each for each in vars(compiled).values() if isinstance(each, CPUDispatcher)]
    assert len(loops) > 5
    assert {loop.py_func.__module__ for loop in loops} == {compiled.__name__}
