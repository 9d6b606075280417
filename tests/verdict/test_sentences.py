"""Causes as clauses: what is small everywhere is told with its worst place, and stays small errors in a headline."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.verdict.effects import Cause, Parameter
from armscope.verdict.schema import ANOTHER_MODEL, Background, HeldOut, Notice, Unexplained
from armscope.verdict.sentences import cause_in_words, headline
from armscope.verdict.wording import main_and_minor
from tests.report import verdicts
from tests.report.verdicts import compliance, found

GIVE = Background("elastic", present=True, size=0.4, rms_at_tool_mm=0.4, share=0.1)


def test_small_errors_everywhere_are_told_with_their_worst_place() -> None:
    assert cause_in_words("elastic", (), GIVE) == "all joints and links give way"
    assert cause_in_words("elastic", (), replace(GIVE, worst="joint 2")) == (
        "all joints and links give way, most at joint 2"
    )


def test_with_a_worst_place_they_are_still_what_a_headline_tells_last() -> None:
    said = cause_in_words("elastic", (), replace(GIVE, worst="joint 2"))
    zero = Cause("geometric", "effect", "joint 3", ("joint offset at joint 3",), False, False, 0.8, 0.1, "the zero", "")
    give = Cause("elastic", "family", "arm", (), True, False, 0.1, 0.1, said, "")
    told = headline(replace(verdicts.case(effects=(verdicts.compliance(),)).verdict, causes=(zero, give)))
    assert told.startswith("The zero – 80 % of the squared error. Small errors of stiffness in the whole arm (10 %)")


def test_the_first_sentence_names_cause_size_and_share():
    case = verdicts.single()
    assert headline(case.verdict) == (
        "Joint 2 gives way by 0.21 µrad per N m under gravity – 55 % of the squared error. "
        "Small errors of geometry in the whole arm (2.0 %); the 0.0276 mm that remain are noise."
    )


def test_that_it_is_another_model_of_the_arm_comes_before_any_cause():
    told = Notice(ANOTHER_MODEL, "Is this another model of the arm? A UR5 leaves 1 mm where this one leaves 15 mm.")
    said = headline(verdicts.case(effects=(compliance(),), notices=(told,)).verdict)
    assert said.startswith(told.text)
    assert "gives way" not in said


def test_many_effects_are_counted_not_recited():
    sentence = headline(verdicts.five().verdict)
    assert sentence.startswith("Joint 2 gives way")
    assert "Two smaller causes (7.4 %); small errors of geometry in the whole arm" in sentence
    assert "joint 6" not in sentence, "minor effects are no part of the story"


def test_causes_are_told_in_the_order_of_the_share_that_stands_beside_them():
    """Size at the tool and share differ where effects work against each other: the share decides everywhere."""
    large = compliance(share=0.2, rms_at_tool_mm=0.5)
    shared = found("joint_offset", "joint 3", Parameter("offset", "rad", 8.6e-4, 2e-5), share=0.4, rms_at_tool_mm=0.3)
    said = headline(verdicts.case(effects=(large, shared)).verdict)
    assert said.index("zero of joint 3") < said.index("joint 2 gives way")
    assert [effect.share for effect in main_and_minor((large, shared))[0]] == [0.4, 0.2]


def test_a_named_cause_of_a_few_percent_is_told_behind_what_counts():
    """Seen on a real arm: 1.3 % of the error made a headline of four lines; and nothing that has a name is lost."""
    large, small = (
        compliance(share=0.9),
        found("joint_offset", "joint 3", Parameter("offset", "rad", 1e-4, 2e-5), share=0.03),
    )
    first, _, then = headline(verdicts.case(effects=(large, small)).verdict).partition(". ")
    assert first == "Joint 2 gives way by 0.21 µrad per N m under gravity – 90 % of the squared error"
    assert then.startswith("The zero of joint 3 is off by +100 µrad – 3.0 %; ")
    first, _, then = headline(verdicts.case(effects=(small,)).verdict).partition(". ")
    assert first.startswith("The zero of joint 3"), "there is always a first"


def test_what_is_left_is_called_noise_only_where_it_is():
    told = Notice("model error", "What is left is more than noise, and no effect explains it.")
    assert "are noise" in headline(verdicts.single().verdict)
    for doubtful in ({"notices": (told,)}, {"unexplained": Unexplained(True, "base", "time", 0.05)}):
        said = headline(verdicts.case(effects=(compliance(),), **doubtful).verdict)
        assert "are noise" not in said
        assert "not yet explained" in said


def test_what_is_no_larger_than_noise_is_not_called_more_than_it():
    """It was: "0.0262 mm remain, more than noise", with 0.0277 mm of noise on the same page."""
    curve = found("unknown", "joint 2", Parameter("reaches", "rad", 7e-4, 1e-5), share=0.9)
    size = {"residual_after_mm": 0.026, "noise_mm": 0.028}
    left = {"unexplained": Unexplained(True, "joint 2", "angle of joint 2", 0.05)}
    assert headline(verdicts.case(effects=(curve,), **left, **size).verdict).endswith(
        "; the 0.026 mm that remain are noise."
    )
    told = Notice("model error", "What is left is more than noise, and no effect explains it.")
    said = headline(verdicts.case(effects=(curve,), notices=(told,), **left, **size).verdict)
    assert "no more than noise in size, yet with a pattern that is not yet explained" in said


def test_what_is_more_than_noise_stands_beside_what_noise_alone_would_leave():
    told = Notice("model error", "What is left is more than noise, and no effect explains it.")
    few = {"notices": (told,), "residual_after_mm": 0.034, "noise_mm": 0.012}
    said = headline(verdicts.case(effects=(compliance(),), noise_source="from residuals", **few).verdict)
    assert said.endswith(
        "0.034 mm remain, where noise alone would leave 0.012 mm at most: something is not yet explained."
    )
    scatter = found("unknown", "joint 5", Parameter("scatter", "rad", 2e-4, 1e-5), share=0.2)
    said = headline(verdicts.case(effects=(compliance(), scatter), noise_source="stated", **few).verdict)
    assert "0.034 mm remain, the scatter included, where noise alone would leave 0.012 mm: something" in said


def test_a_model_that_makes_other_rows_worse_says_so_before_anybody_acts_on_it():
    """Seen on a real arm: 0.17 mm promised on poses that took no part, which got worse from 1.3 to 6.8 mm."""
    said = headline(verdicts.case(effects=(compliance(),), held_out=HeldOut(1.32, 6.82)).verdict)
    assert said.endswith("took no part in the fit get worse by it, from 1.32 mm to 6.82 mm: do not act on it yet.")
    for fine in (HeldOut(1.32, 0.2), HeldOut(float("nan"), float("nan")), HeldOut(0.0301, 0.0302)):
        assert "get worse" not in headline(verdicts.case(effects=(compliance(),), held_out=fine).verdict)


def test_the_headline_never_says_more_than_the_tables_own_warning_allows():
    wrong = Notice("check", "The payload is up to 5000 kg, more than the arm weighs. Is it in grams?")
    said = headline(verdicts.case(effects=(compliance(),), notices=(wrong,)).verdict)
    assert said.startswith("These recordings cannot be relied on")
    assert "the payload is up to 5000 kg" in said
    assert "joint 2" not in said


def test_a_vague_name_stays_vague_and_says_its_best_reading():
    vague = compliance(named_as="region", title="elastic, around joints 1 and 2")
    sentence = headline(verdicts.case(effects=(vague,)).verdict)
    assert sentence.startswith(
        "Something gives way under load around joints 1 and 2, most likely joint compliance at joint 2 –"
    )
    mixed = compliance(named_as="region", title="joint compliance at joint 2 or unknown at joint 3")
    said = headline(verdicts.case(effects=(mixed,)).verdict)
    assert said.startswith("Either joint compliance at joint 2 or an unexplained curve at joint 3 –")


def everywhere(share=0.0, mm=0.0):
    return Background("elastic", present=True, size=mm, rms_at_tool_mm=mm, share=share)


@pytest.mark.parametrize(
    ("share", "size", "leads"), [(0.2, 0.1, True), (0.01, 0.1, False), (-0.05, 0.1, False), (-0.05, 0.6, True)]
)
def test_small_errors_everywhere_are_led_by_what_is_a_twentieth_of_them(share, size, leads):
    """By its share, or by what it does: one that hides what others do has no share."""
    said = cause_in_words("elastic", [compliance(share=share, rms_at_tool_mm=size)], everywhere(share=0.5, mm=1.0))
    assert ("most of all: joint 2 gives way" in said) == leads
    assert (said == "all joints and links give way") != leads


def test_a_cause_has_one_pair_of_brackets():
    vague = compliance(named_as="region", title="elastic, around joints 1 and 2")
    said = cause_in_words("elastic", [vague, compliance(location="joint 3")], everywhere())
    assert said.endswith("at joint 2 (also giving way: joint 3, and all others a little)")
    assert said.count("(") == 1
    assert cause_in_words("elastic", [compliance()], everywhere()).endswith("under gravity (all others a little)")
    worst = replace(everywhere(), worst="link 1")
    assert cause_in_words("elastic", [compliance()], worst).endswith("(all others a little, most at link 1)")
    there = replace(everywhere(), worst=compliance().location)
    assert cause_in_words("elastic", [compliance()], there).endswith("under gravity (all others a little)")


@pytest.mark.parametrize(("share", "nats", "leads"), [(0.3, 150.0, True), (0.1, 150.0, False), (0.3, 5.0, False)])
def test_what_has_a_sure_name_is_told_before_what_may_be_another(share, nats, leads):
    """Where it is about as much: half of an arm's give had a name, and stood in the brackets of a region."""
    vague = compliance(named_as="region", title="elastic, around joints 1 and 2", share=0.4, evidence_nats=13.0)
    said = cause_in_words("elastic", [vague, compliance(location="joint 3", share=share, evidence_nats=nats)])
    assert said.startswith("joint 3 gives way by") == leads
    assert said.endswith(f"(also giving way: joint {2 if leads else 3})")


def test_a_cause_of_several_places_says_where_the_others_are():
    at = [compliance(), *(compliance(location=place) for place in ("joint 5", "link 3", "joint 4"))]
    assert cause_in_words("elastic", at).endswith("under gravity (also giving way: joints 4 and 5 and link 3)")
    many = [*at, compliance(location="base"), compliance(location="tool")]
    assert cause_in_words("elastic", many).endswith("(also giving way: five more places)")
    assert cause_in_words("elastic", [compliance(), compliance()]).endswith("(one more at the same place)")
    assert "(" not in cause_in_words("elastic", at[:1])
    base = found("base_compliance", "base", Parameter("compliance", "rad/(N m)", 1e-7, 1e-9))
    assert cause_in_words("elastic", [*at[:2], base]).endswith("(also giving way: joint 5 and base)")
    payload = found("payload_error", "payload", Parameter("mass", "kg", 2.0, 0.1))
    link = found("link_bending", "link 2", Parameter("flexibility", "1/(N m^2)", 1e-7, 1e-9))
    told = cause_in_words("elastic", [*at[:1], link, base, payload])
    assert told.endswith("(also giving way: link 2, base and payload error)")
    tilts = found("bearing_compliance", "joint 4", Parameter("compliance", "rad/(N m)", 1e-7, 1e-9))
    told = cause_in_words("elastic", [base, tilts, compliance()])
    assert told.endswith("(also giving way: joint 2 and bearing compliance at joint 4)")
    play = found("backlash", "joint 2", Parameter("gap", "rad", 3e-4, 1e-6))
    wave = found("gear_eccentricity", "joint 4", Parameter("amplitude", "rad", 3e-4, 1e-6))
    told = cause_in_words("transmission", [play, wave])
    assert told.endswith("of play (also off: gear eccentricity at joint 4)"), "joint 4 has no play"
    rare = replace(wave, inclusion=0.1)
    assert cause_in_words("transmission", [play, rare]).endswith("of play"), "nobody relies on it"


def test_nothing_missing_and_cannot_tell_are_whole_answers():
    assert headline(verdicts.clean().verdict).startswith("Nothing is missing: once base and tool are placed")
    undecided = headline(verdicts.cannot_tell().verdict)
    assert undecided.startswith("Cannot tell: 40 rows are fewer")
    assert "would settle it" in undecided
    asked = replace(verdicts.cannot_tell().verdict, next_poses=None, notices=(Notice("check", "Is it another robot?"),))
    assert headline(asked) == "Cannot tell: is it another robot?"
    assert headline(replace(asked, notices=(Notice("check", "It is another."),))) == "Cannot tell: it is another."
    excess = verdicts.case(answer="cannot tell", mismatch=True).verdict
    assert "follow nothing that was recorded" in headline(excess)


def test_a_drift_that_follows_the_rows_is_not_told_per_hour():
    told = [Parameter(axis, "mm/1000 rows", 0.1, 0.01) for axis in "xyz"]
    drift = found("base_drift", "base", *told, driver="order of rows, with a pause before row 56")
    said = headline(verdicts.case(effects=(drift,)).verdict)
    assert said.startswith("The base drifts by 0.17 mm per 1000 rows, with a pause before row 56")


def test_a_share_above_the_whole_is_told_as_what_others_cancel() -> None:
    """Seen: "over 100 % of the squared error"."""
    case = verdicts.case(effects=(verdicts.compliance(share=1.6),))
    told = headline(case.verdict)
    assert "– more than the whole squared error, as others cancel a part of it" in told
    assert "over 100 %" not in told


def test_waves_of_one_gear_are_told_together_as_far_as_both_are_sure() -> None:
    once, twice = (
        found(
            "gear_eccentricity",
            "joint 2",
            Parameter("amplitude", "rad", size, 1e-5),
            Parameter("phase", "rad", 0.4, 0.1),
            Parameter("per_turn", "", n, 0.0),
        )
        for size, n in ((4.5e-4, 1.0), (4e-4, 2.0))
    )
    said = "the angle of joint 2 swings by ±450 µrad once per turn and by ±400 µrad twice per turn"
    assert cause_in_words("transmission", (once, twice)) == said
    unsure = replace(twice, named_as="region", title="gear eccentricity at joint 2 or gear ratio at joint 2")
    assert cause_in_words("transmission", (once, unsure)).endswith("once per turn (one more at the same place)")
    assert cause_in_words("transmission", (unsure, once)).startswith("either ")


def test_the_share_of_a_family_stands_before_its_largest_member_which_has_only_a_part_of_it() -> None:
    text = cause_in_words("elastic", [compliance(share=0.1)], everywhere(share=0.8, mm=1.0))
    cause = Cause("elastic", "family", "arm", ("joint compliance at joint 2",), True, False, 0.9, 0.1, text, "")
    whole = replace(verdicts.case(effects=(compliance(share=0.1),)).verdict, causes=(cause,))
    assert headline(whole).startswith("All joints and links give way – 90 % of the squared error, most of all: joint 2")


def test_a_doubt_that_asks_ends_with_its_question_mark() -> None:
    asks = Notice("check", "Is it another robot, or is a zero far off? Compare both.")
    assert headline(replace(verdicts.case(effects=(compliance(),)).verdict, notices=(asks,))).count("?.") == 0


def test_a_name_that_no_table_drawn_anew_has_does_not_lead() -> None:
    """ "Link 2 differs from its drawing" led a page on which it was said that 0 % of the tables have this name."""
    never = found("joint_offset", "joint 3", Parameter("offset", "rad", 1e-3, 2e-5), share=0.5, inclusion=0.0)
    sure = found("joint_offset", "joint 5", Parameter("offset", "rad", 5e-4, 2e-5), share=0.2)
    assert cause_in_words("geometric", (never, sure)).startswith("the zero of joint 5")
    small = Background("geometric", present=True, size=0.4, rms_at_tool_mm=0.4, share=0.1)
    assert cause_in_words("geometric", (never,), small) == "small errors of geometry in all joints and links"
    usual = replace(never, inclusion=0.9)
    assert cause_in_words("geometric", (usual,), small).startswith("the zero of joint 3 is off")
