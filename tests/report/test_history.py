"""The history of a change has a row and a point per recording."""

import itertools
from dataclasses import replace

from armscope.comparison.result import Change, Comparison
from armscope.comparison.valued import Valued
from armscope.report.figures.history import LETTERS, LONGEST, history_figure, history_table
from armscope.report.pages.changes import write_changes

SINCE = (0.0, 3e-4, 3e-4), (0.0, 1e-5, 1e-5)
NUMBER = Valued("offset", "rad", (2e-3, 2.3e-3, 2.3e-3), (8e-3,) * 3, *SINCE, 3e-4, (2e-4, 4e-4))
CHANGE = Change(
    "joint_offset", "joint 3", "joint offset at joint 3", ("b", "c"), ("a",), "came", 0.2, 1e-9, (NUMBER,), ()
)
FOUND = Comparison("arm", ("a", "b", "c"), (9, 9, 9), 0.03, 1e-9, 0.05, 100, (CHANGE,))


def test_every_recording_has_its_row_and_its_point():
    assert history_table(FOUND)["recording"].tolist() == ["a", "b", "c"]
    (axes,) = history_figure(FOUND).axes
    low, high = axes.get_ylim()
    assert high - low < 1000, "a change known to 20 µrad is not drawn in bars of 16 mrad that all recordings share"
    assert [label.get_text() for label in axes.get_xticklabels()] == ["a", "b", "c"]
    assert 'came in "b" and "c"' in axes.get_title(loc="left")


def test_names_of_files_are_drawn_as_they_can_be_read():
    names = ("a", "\x1b[31mred", "a very long name of a recording, with its date")
    change = replace(CHANGE, where=names[1:], against=names[:1])
    (axes,) = history_figure(replace(FOUND, names=names, changes=(change,))).axes
    drawn = [label.get_text() for label in axes.get_xticklabels()]
    assert drawn[1] == "\\x1b[31mred"
    assert len(drawn[2]) == LONGEST
    assert axes.get_xticklabels()[0].get_rotation() > 0, "they would stand in each other"
    assert max(map(len, axes.get_title(loc="left").splitlines())) <= LETTERS
    assert "\x1b" not in axes.get_title(loc="left")


def test_arms_have_no_order_so_no_line_joins_them():
    (of_time,), (of_arms,) = (history_figure(replace(FOUND, of_arms=arms)).axes for arms in (False, True))
    assert len(of_time.lines) == len(of_arms.lines) + 1


def test_names_of_many_numbers_do_not_stand_in_each_other():
    names = ("turn of the middle of the link about x", "wave_twice_per_turn_sine", "least_load", "offset")
    many = replace(CHANGE, parameters=tuple(replace(NUMBER, name=name) for name in names))
    figure = history_figure(replace(FOUND, changes=(many, replace(many, location="joint 4"))))
    figure.canvas.draw()
    boxes = [axes.yaxis.label.get_window_extent() for axes in figure.axes]
    assert len(boxes) == 8
    assert all(above.y0 > below.y1 for above, below in itertools.pairwise(boxes))
    assert min(box.x0 for box in boxes) >= 0


def test_products_with_mass_moments_have_no_panel_beside_the_compliance_that_they_are_of(tmp_path):
    """Each of them is known to thousands of its unit, and was drawn as what differs."""
    moments = tuple(replace(NUMBER, name=f"compliance_times_moment_{n}", unit="rad/(m/s^2)") for n in (1, 2, 3))
    compliance = replace(NUMBER, name="compliance", unit="rad/(N m)")
    for parameters, panels in (((*moments, compliance), 1), (moments, 3)):
        found = replace(FOUND, changes=(replace(CHANGE, effect="joint_compliance", parameters=parameters),))
        assert len(history_figure(found).axes) == panels
        assert len(history_table(found)) == 3 * len(parameters), "the table keeps them"
        page = write_changes(found, tmp_path / str(panels)).read_text()
        assert ("3 further numbers are in the table" in page) == (panels == 1)


def test_the_page_has_words_where_the_table_has_names_of_columns(tmp_path):
    said = write_changes(FOUND, tmp_path).read_text()
    assert "difference from the first" in said
    assert "before (mean of these recordings)" in said
    assert "since_first" not in said
    assert "since_first" in (tmp_path / "history.csv").read_text()
