"""What a planned motion is better by stands first; its condition number is a remark."""

from types import SimpleNamespace
from typing import Any

from armscope.cli.excite import _maximised
from armscope.poses.exciting.criterion import MotionScore


def test_what_was_maximised_is_told_of_both_motions() -> None:
    shown = SimpleNamespace(base=range(25))
    found: Any = SimpleNamespace(before=MotionScore(-53.4, 52.0), after=MotionScore(-45.2, 58.3), pairs=(), shown=shown)
    told = _maximised(found)
    assert told.startswith("log determinant of the information: -53.4 of the median random motion, -45.2 of this one: ")
    assert "1.18 times as surely" in told  # exp(8.2 / 50)
    assert told.endswith("condition number 52 and 58.3, which nothing maximises")
    found.before, found.after, found.pairs = MotionScore(0.1, 52.0), MotionScore(0.4, 58.3), ((),)
    told = _maximised(found)
    assert told.startswith("least share that can't be imitated: 10% of the median random motion, 40% of this one")
