"""What a headline says of a stand: its frequency, and the axis about which it gives way most."""

from __future__ import annotations

from types import SimpleNamespace

from armscope.motion.library.clauses_of_stands import rocking_clause
from armscope.verdict.effects import Parameter


def test_a_stand_is_told_about_the_axis_where_it_gives_way_most() -> None:
    """Equal turns about x and y, and as much between both: twice that about the axis halfway."""
    names = ("about_x", "about_both", "about_y")
    numbers = {name: Parameter(name, "rad/(N m)", 3e-5, 1e-6) for name in names}
    numbers["frequency"] = Parameter("frequency", "Hz", 7.02, 0.0)
    said = rocking_clause(SimpleNamespace(location="base"), numbers)  # type: ignore[arg-type]
    assert said == "the base rocks and rings at 7.02 Hz: its stand gives way by 60 µrad per N m"
