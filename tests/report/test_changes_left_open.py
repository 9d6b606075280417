"""What the poses leave open of a change has no digits on its page."""

from dataclasses import replace

from armscope.comparison import Valued
from armscope.report.pages.changes import LEFT_OPEN, UNKNOWN
from tests.report.test_changes_page import CHANGE, FOUND, NUMBER, words_of


def test_an_interval_of_decimetres_is_no_number_on_the_page(tmp_path):
    """Seen: "d: change -19 (-281518 ... 281481) µm"."""
    known = replace(NUMBER, name="alpha")
    wide = Valued("d", "m", (0.0, 1e-5), (0.14,) * 2, (0.0, 1e-5), (0.0, 0.14), 1e-5, (-0.28, 0.28))
    link = replace(CHANGE, effect="link_geometry", location="link 3", parameters=(known, wide))
    said = words_of(replace(FOUND, changes=(link,)), tmp_path)
    assert UNKNOWN in said
    assert "280" not in said
    assert "+0.870 mrad" in said


def test_a_number_that_the_poses_leave_open_is_told_without_digits(tmp_path):
    unknown = replace(NUMBER, stderrs=(8e-3, 8e-3))
    said = words_of(replace(FOUND, changes=(replace(CHANGE, parameters=(unknown,)),)), tmp_path)
    assert LEFT_OPEN in said
    assert "1.770" not in said
    assert "+0.870 mrad" in said
