"""The history of a change has a row and a point per recording."""

from armscope.comparison.result import Change, Comparison, Valued
from armscope.report.figures.history import history_figure, history_table

NUMBER = Valued("offset", "rad", (0.0, 3e-4, 3e-4), (1e-5,) * 3, 3e-4, (2e-4, 4e-4))
CHANGE = Change("joint_offset", "joint 3", "joint offset at joint 3", ("b", "c"), "came", 0.2, 1e-9, (NUMBER,), ())
FOUND = Comparison("arm", ("a", "b", "c"), (9, 9, 9), 0.03, 1e-9, 0.05, 100, (CHANGE,))


def test_every_recording_has_its_row_and_its_point():
    assert history_table(FOUND)["recording"].tolist() == ["a", "b", "c"]
    (axes,) = history_figure(FOUND).axes
    assert [label.get_text() for label in axes.get_xticklabels()] == ["a", "b", "c"]
    assert "came in b, c" in axes.get_title(loc="left")
