"""A cause in doubt is told by kind and place, with every reading and how it shows itself; a sure one is left alone."""

from dataclasses import replace

from armscope.physics.registry import effect_named
from armscope.verdict.doubts import NEVER_AGAIN, alike_in_words, doubt_of, unless_confirmed
from armscope.verdict.effects import Alternative, Parameter
from armscope.verdict.family_cures import CONFIRM_FIRST
from tests.report import verdicts

LINK = Alternative("link_geometry", "link 6", "geometric", 1.5, "constant", 1.5, False)
ZERO = Alternative("joint_offset", "joint 6", "geometric", 2.0, "constant", 2.0, True)
VAGUE = verdicts.found(
    "axis_wobble", "joint 5", named_as="region", title="geometric, around joints 5 and 6", alternatives=(LINK, ZERO)
)


def test_a_doubt_tells_kind_place_and_how_each_reading_shows_itself() -> None:
    doubt = doubt_of(VAGUE)
    assert doubt
    assert doubt.what == "the geometry differs from what was stated around joints 5 and 6"
    assert doubt.place == "around joints 5 and 6"
    for name in ("axis_wobble", "link_geometry", "joint_offset"):
        known = effect_named(name)
        assert known
        assert known.confirm[1:] in doubt.confirm
    either = doubt_of(replace(VAGUE, title="axis wobble at joint 5 or link geometry at link 6"))
    assert either
    assert either.place == "joint 5 or link 6"
    assert "joint offset" not in either.confirm


def test_readings_that_are_confirmed_alike_stand_together() -> None:
    twice = replace(VAGUE, alternatives=(replace(ZERO, location="joint 5"), ZERO))
    doubt = doubt_of(twice)
    assert doubt
    assert "For joint offset at joint 5 and joint offset at joint 6: bring" in doubt.confirm


def test_a_sure_name_has_no_doubt_but_says_what_held_out_rows_do_not_exclude() -> None:
    sure = replace(VAGUE, named_as="effect")
    assert doubt_of(sure) is None
    assert unless_confirmed(sure).endswith("it could also be link geometry at link 6.")
    assert unless_confirmed(replace(sure, alternatives=(ZERO,))) == ""
    assert unless_confirmed(VAGUE) == "", "all its readings are told"
    seldom = replace(sure, alternatives=(), inclusion=0.2)
    assert unless_confirmed(seldom).startswith("Change nothing here before that shows it: ")
    assert "only 20 % of the tables" in unless_confirmed(seldom)
    assert unless_confirmed(replace(seldom, inclusion=0.6)) == unless_confirmed(replace(seldom, inclusion=None)) == ""


def test_a_size_that_may_be_zero_is_confirmed_before_anything_is_replaced() -> None:
    size = Parameter("compliance", "rad/(N m)", 9e-6, 1e-5)
    bearing = verdicts.found("bearing_compliance", "joint 6", size, named_as="region", title="elastic, around joint 6")
    doubt = doubt_of(bearing)
    assert doubt
    assert doubt.instruction.startswith(f"{CONFIRM_FIRST} If the bearing of joint 6")
    against = doubt_of(replace(bearing, alternatives=(LINK,)))
    assert against
    assert against.instruction.startswith(f"{CONFIRM_FIRST} First find out which it is: ")
    sure = doubt_of(replace(bearing, parameters=(replace(size, stderr=1e-6),)))
    assert sure
    assert CONFIRM_FIRST not in sure.instruction


def test_a_name_that_no_table_drawn_anew_has_is_confirmed_first_though_nothing_else_is_known() -> None:
    """It was "find out which it is: geometric, around joint 2"."""
    alone = replace(VAGUE, alternatives=(), title="geometric, around joint 5", inclusion=0.0)
    doubt = doubt_of(alone)
    assert doubt
    assert doubt.instruction.startswith(NEVER_AGAIN)
    assert "find out which" not in doubt.instruction
    both = doubt_of(replace(alone, alternatives=(LINK,)))
    assert both
    assert both.instruction.startswith(f"{NEVER_AGAIN} First find out which it is")


def test_where_nothing_else_is_known_no_choice_is_offered() -> None:
    """It was "first find out which it is: elastic, around joint 2"."""
    alone = replace(VAGUE, alternatives=(), title="elastic, around joint 2", family="elastic")
    doubt = doubt_of(alone)
    assert doubt
    assert "which" not in doubt.instruction
    assert doubt.instruction.startswith(
        "Confirm it first: that something gives way under load around joint 2 is sure, its name is not."
    )


def test_what_moves_the_tool_alike_in_every_pose_need_not_be_told_apart() -> None:
    """To correct the link waited for a dial gauge that was to tell it from a wobble that turns with its joint."""
    wobble = Alternative("axis_wobble", "joint 4", "geometric", 1.0, "angle of joint 4", 0.5, None, same_motion=True)
    link = verdicts.found("link_geometry", "link 4", named_as="region", title="a or b", alternatives=(wobble,))
    assert doubt_of(link) is None
    assert unless_confirmed(link) == ""
    assert alike_in_words(link).startswith("It may be axis wobble at joint 4: that moves the tool alike")
    other = replace(wobble, effect="bearing_compliance", same_motion=False)
    beside = replace(link, alternatives=(wobble, other))
    assert not beside.same_cure
    assert doubt_of(beside), "what another cure undoes is to be told apart"
    assert alike_in_words(replace(link, alternatives=(other,))) == ""
