"""What to do about a change is told by what changed, and for every effect that there is."""

from dataclasses import replace

import pytest

from armscope.comparison import Change, Comparison, Valued
from armscope.comparison.remedies import difference_of, remedy_of
from armscope.physics.registry import effects

NUMBER = Valued("offset", "rad", (9e-4, 1.77e-3), (1e-4,) * 2, (0.0, 8.7e-4), (0.0, 1e-5), 8.7e-4, (8.5e-4, 8.9e-4))
CHANGE = Change(
    "joint_offset", "joint 3", "joint offset at joint 3", ("c",), ("a", "b"), "grew", 0.3, 1e-9, (NUMBER,), ()
)
NAMES = ("a", "b", "c")
FOUND = Comparison("arm", NAMES, (70,) * 3, 0.03, 1e-9, 0.05, 100, (CHANGE,), same_poses=(NAMES,))


def test_the_zero_is_set_by_the_change_and_not_by_all_that_is_off():
    told = remedy_of(FOUND, CHANGE)
    assert told.instruction == "Reset the zero of joint 3: it moved by +0.0498° (+0.870 mrad ± 0.020)."
    assert told.rule.endswith("Here offset = +0.0498° (+0.870 mrad ± 0.020).")
    assert 'between "b" and "c"' in told.why


def test_a_repair_that_worked_is_not_told_as_a_crash():
    assert "the repair worked" in remedy_of(FOUND, replace(CHANGE, kind="went")).why
    assert "repair worked" not in remedy_of(FOUND, CHANGE).why


def test_what_is_over_is_not_mended_again():
    told = remedy_of(FOUND, once := replace(CHANGE, where=("b",), against=("a", "c"), until="c"))
    assert 'between "a" and "b", and again before "c"' in told.why
    assert told.instruction == "Nothing is left to be done about what b alone had."
    assert (told.confirm, told.rule) == ("", "")
    assert found_text(once).startswith('Joint offset at joint 3 grew in "b" alone (p = 1e-09')
    assert " alone" not in found_text(CHANGE)
    first = replace(CHANGE, where=("b",), against=("a",))  # it lasts, and changed once more in c
    assert remedy_of(FOUND, first).instruction.startswith("Reset the zero")


def found_text(change):
    return replace(FOUND, changes=(change,)).text()


@pytest.mark.parametrize("effect", effects(), ids=lambda each: each.name)
def test_every_instruction_of_the_library_can_be_told_of_a_change(effect):
    told = remedy_of(FOUND, replace(CHANGE, effect=effect.name))
    assert "{" not in told.instruction + told.rule
    assert (told.physics, told.confirm) == (effect.physics, effect.confirm)


def test_what_turns_is_taken_back_by_what_it_gained():
    coupling = replace(NUMBER, name="coupling", unit="rad/rad")
    told = remedy_of(FOUND, replace(CHANGE, effect="joint_coupling", parameters=(coupling,)))
    assert "Add −870 µrad per rad to what the controller" in told.instruction


def test_the_interval_is_kept():
    assert difference_of(NUMBER).interval == pytest.approx(NUMBER.interval_95)


def test_an_effect_that_is_not_installed_any_more_has_no_cure():
    told = remedy_of(FOUND, replace(CHANGE, effect="of_a_package_that_went"))
    assert told.instruction == told.rule == ""
    assert told.why
