"""Work shared among processes: the same results in the same order, errors where they are waited for, nothing left."""

import multiprocessing
import os
import signal

import numpy as np
import pytest

from armscope.core.parallel import each_piece, piece_by_piece, processes, shared_array

PIECES = [np.arange(k, k + 5.0) for k in range(7)]


def squares(piece):
    return os.getpid(), piece**2


@pytest.mark.parametrize("count", [1, 2, 3, 20])
def test_results_come_in_the_order_of_the_pieces(count):
    with processes(count):
        done = each_piece(PIECES, squares)
    assert all(np.array_equal(found, piece**2) for (_, found), piece in zip(done, PIECES, strict=True))
    assert len({pid for pid, _ in done} - {os.getpid()}) == (0 if count == 1 else min(count, len(PIECES)))
    assert not multiprocessing.active_children()


@pytest.mark.parametrize("count", [1, 2])
def test_a_result_need_not_wait_for_those_after_it(count):
    def only_the_first(piece):
        if piece[0] > 1:
            raise ValueError("too far")
        return squares(piece)

    with processes(count):
        results = piece_by_piece(PIECES, only_the_first)
        assert np.array_equal(next(results)[1], PIECES[0] ** 2)
        results.close()
    assert not multiprocessing.active_children()


@pytest.mark.parametrize("count", [1, 2])
def test_what_pieces_write_into_a_shared_array_is_there_afterwards(count):
    with processes(count):
        filled = shared_array((7, 5))
        assert not filled.any()

        def fill(number):
            filled[number] = PIECES[number]

        each_piece(range(7), fill)
    assert np.array_equal(filled, PIECES)


def test_outside_the_block_one_process_works():
    with processes(2):
        pass
    assert {pid for pid, _ in each_piece(PIECES, squares)} == {os.getpid()}


def test_an_error_is_raised_where_it_is_waited_for():
    def fails(piece):
        raise ValueError(f"piece {piece[0]:g}")

    with processes(2), pytest.raises(ValueError, match="piece 0"):
        each_piece(PIECES, fails)
    assert not multiprocessing.active_children()


def test_a_process_ended_from_outside_is_told_as_memory():
    def dies(piece):
        os.kill(os.getpid(), signal.SIGKILL)

    with processes(2), pytest.raises(MemoryError, match="ended from outside"):
        each_piece(PIECES, dies)
    assert not multiprocessing.active_children()
