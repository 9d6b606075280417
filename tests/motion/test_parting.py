"""What takes no part is said: runs, and pieces of them, do not vanish."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.motion.parting import parted_in_two, refuse_unknown
from tests.motion.moving import moved, robot

MOTIONS = moved(robot(), 3, seconds=6.0)
SHORT = (MOTIONS.run == "path 1") | (MOTIONS.time < 1.5)
IN_PIECES = (MOTIONS.run == "path 1") | (MOTIONS.time < 3.0) | (MOTIONS.time % 2 < 1.0)


def test_a_run_that_is_too_short_to_be_held_out_is_refused() -> None:
    """It took no part in anything, and another motion was held out."""
    with pytest.raises(InputError, match="--held-out: found 'path 2'; a run that is held out moves for more than 2 s"):
        parted_in_two(robot(), MOTIONS.rows(SHORT), ("path 2",))


def test_a_run_that_takes_no_part_is_told() -> None:
    found = parted_in_two(robot(), MOTIONS.rows(SHORT), ())
    assert {each.run for each in found.train} == {"path 1"}
    (notice,) = found.notices
    assert notice.text.startswith("run path 2: it takes no part. Its longest motion without a gap is 1.5 s")


def test_pieces_that_are_left_out_are_told() -> None:
    found = parted_in_two(robot(), MOTIONS.rows(IN_PIECES), ("path 2",))
    assert [len(each) for each in found.test] == [600]
    (notice,) = found.notices
    assert notice.text.startswith("run path 2: pieces of 1 s together were left out (1)")


def test_whole_runs_need_no_word() -> None:
    found = parted_in_two(robot(), MOTIONS, ("path 1",))
    assert not found.notices
    assert np.array_equal([len(found.train), len(found.test)], [1, 1])


def test_a_run_that_is_not_there_can_not_be_held_out() -> None:
    with pytest.raises(InputError, match="has no such run"):
        refuse_unknown(("path 9",), MOTIONS)
