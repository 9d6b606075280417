"""What to do about a change is told by what changed, and for every effect that there is."""

from dataclasses import replace

import pytest

from armscope.comparison import Change, Comparison, Valued
from armscope.comparison.remedies import difference_of, is_open, remedy_of
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


def test_a_bar_that_changed_is_set_back():
    rocker = replace(NUMBER, name="rocker", unit="m/m")
    told = remedy_of(FOUND, replace(CHANGE, effect="parallelogram_geometry", parameters=(rocker,)))
    assert "make the rocker shorter by 870 ppm" in told.instruction


def test_the_interval_is_kept():
    assert difference_of(NUMBER).interval == pytest.approx(NUMBER.interval_95)


def test_an_effect_that_is_not_installed_any_more_has_no_cure():
    told = remedy_of(FOUND, replace(CHANGE, effect="of_a_package_that_went"))
    assert told.instruction == told.rule == ""
    assert told.why


def test_whether_to_take_back_what_may_be_a_repair_is_left_to_the_log():
    number = replace(NUMBER, values=(9e-4, 9e-4, 1.77e-3), stderrs=(1e-2,) * 3)
    open_yet = replace(CHANGE, kind="changed", parameters=(number,), left_mm=1.14, taken_back_mm=1.14, worse_sigmas=0.4)
    told = remedy_of(FOUND, open_yet)
    assert is_open(open_yet)
    assert told.instruction == (
        "Whether there is more of it in c than in a and b or less is not known: it stays if it was repaired, and is "
        "taken back if it came with a crash. The log says which, or its mastering mark, or a diagnosis of each. After "
        "a crash: Reset the zero of joint 3: it moved by +0.0498° (+0.870 mrad ± 0.020)."
    )
    arms = replace(FOUND, of_arms=True)
    assert "diagnose each, and mend c only if it is the one with more" in remedy_of(arms, open_yet).instruction
    assert not is_open(replace(open_yet, sense="more"))
    assert not is_open(replace(open_yet, worse_sigmas=-9.0)), "the tool comes nearer, whichever it is"


def test_less_of_a_cause_is_no_cure_though_other_errors_come_out_by_it():
    stiffer = replace(CHANGE, kind="shrank", sense="less", left_mm=1.2, taken_back_mm=1.0, worse_sigmas=-9.0)
    told = remedy_of(FOUND, stiffer).instruction
    assert told.startswith("Nothing is to be corrected: there is less of it in c")
    assert told.endswith("Other errors of the arm come out by it: diagnose c.")


def test_a_zero_that_went_through_to_the_other_side_is_told_as_all_of_it_and_as_no_repair():
    """Seen: +0.25 mrad before and −0.75 now was a repair that worked, and its number stood under those of changes."""
    number = replace(NUMBER, values=(2.5e-4, 2.5e-4, -7.5e-4), stderrs=(1e-5,) * 3, difference=-1e-3)
    through = replace(CHANGE, kind="changed", parameters=(number,), sense="more")
    told = remedy_of(FOUND, through)
    assert told.instruction.startswith("Reset the zero of joint 3: it is off by −0.0430°")
    assert told.instruction.endswith(
        " That is all of it as it is now: it went through to the other side, by −1.0 mrad."
    )
    assert "repair worked" not in told.why
    assert "repair worked" not in remedy_of(FOUND, replace(through, sense="less")).why
