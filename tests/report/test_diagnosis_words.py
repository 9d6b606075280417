from dataclasses import replace

import numpy as np
import pytest

from armscope.errormodels.reference_models import held_out_rms
from armscope.physics.registry import EFFECTS
from armscope.report.figures.arm import location_shares
from armscope.report.html import unbroken
from armscope.report.sections.effect_cards import card, chosen_how_often, title_of, told_parameters
from armscope.robot import forward_kinematics
from armscope.verdict.effects import Alternative, Curve, Parameter
from armscope.verdict.schema import Background, HeldOut, Notice, Unexplained
from armscope.verdict.sentences import ANOTHER_MODEL, cause_in_words, exact_phrase, headline
from armscope.verdict.wording import main_and_minor, reach
from tests.report import verdicts
from tests.report.verdicts import compliance, found

LOCATIONS = {
    "link_geometry": "link 2", "link_bending": "link 2", "thermal_expansion": "link 2", "base_drift": "base",
    "base_shift": "base", "base_compliance": "base", "tool_shift": "tool", "instrument_scale": "instrument",
    "payload_error": "payload", "parallelogram_geometry": "parallelogram", "joint_coupling": "joint 6 from joint 5",
}  # fmt: skip
PARAMETERS = {
    "joint_offset": [("offset", "rad", 8.6e-4)],
    "gear_ratio": [("ratio", "rad/rad", -2e-4)],
    "gear_eccentricity": [("amplitude", "rad", 2.4e-4), ("phase", "rad", 1.0), ("per_turn", "1/turn", 2.0)],
    "gear_mesh": [("amplitude", "rad", 2.4e-5), ("phase", "rad", 1.0), ("per_turn", "1/turn", 37.0)],
    "axis_wobble": [("amplitude", "rad", 2.4e-4), ("phase", "rad", 1.0), ("direction", "rad", 1.0)],
    "backlash": [("gap", "rad", 3e-4)],
    "servo_lag": [("delay", "s", 0.004)],
    "joint_coupling": [("coupling", "rad/rad", 2e-4)],
    "joint_compliance": [("compliance", "rad/(N m)", 2.1e-7)],
    "bearing_compliance": [("compliance", "rad/(N m)", 2.1e-7)],
    "base_compliance": [("compliance", "rad/(N m)", 2.1e-7)],
    "link_bending": [("flexibility", "1/(N m^2)", 3e-7)],
    "thermal_expansion": [("coefficient", "1/K", 1.2e-5)],
    "link_geometry": [("a", "mm", 0.76), ("alpha", "rad", 7e-4), ("d", "mm", 0.001)],
    "base_drift": [(axis, "mm/h", 0.1) for axis in "xyz"],
    "base_shift": [("x", "mm", 0.3), ("y", "mm", 0.4), ("z", "mm", 0.0), ("time", "s", 4711.0)],
    "tool_shift": [("x", "mm", 0.3), ("y", "mm", 0.4), ("z", "mm", 0.0), ("row", "", 85.0)],
    "zero_shift": [("jump", "rad", -5e-4), ("time", "s", 4711.0)],
    "instrument_scale": [("scale", "m/m", -1.5e-5)],
    "payload_error": [("mass", "kg", 2.0)],
    "parallelogram_geometry": [("rod", "mm", 0.4), ("rocker", "mm", -0.2)],
}  # fmt: skip
SAID = {
    "joint_offset": "the zero of joint 2 is off by +0.86 mrad",
    "gear_ratio": "joint 2 turns 0.020 % too little",
    "gear_eccentricity": "the angle of joint 2 swings by ±240 µrad twice per turn",
    "gear_mesh": "the angle of joint 2 swings by ±24 µrad 37 times per turn",
    "axis_wobble": "the axis of joint 2 tilts by ±240 µrad once per turn",
    "backlash": "joint 2 has 300 µrad of play",
    "servo_lag": "joint 2 runs behind by 4.0 ms",
    "joint_coupling": "joint 6 turns by 200 µrad per rad of joint 5",
    "joint_compliance": "joint 2 gives way by 0.21 µrad per N m under gravity",
    "bearing_compliance": "the bearing of joint 2 tilts by 0.21 µrad per N m under gravity",
    "base_compliance": "the base tilts by 0.21 µrad per N m under the arm's moment",
    "link_bending": "link 2 bends under its load",
    "thermal_expansion": "link 2 grows by 12 millionths per K with temperature",
    "base_drift": "the base drifts by 0.17 mm per hour",
    "base_shift": "the base jumped by 0.50 mm at 4711 s",
    "tool_shift": "the tool jumped by 0.50 mm at row 85",
    "zero_shift": "the zero of joint 2 jumped by −0.50 mrad at 4711 s",
    "instrument_scale": "the instrument measures 15 millionths (ppm) too short",
}


def example(name, **changes):
    parameters = [Parameter(n, unit, value, abs(value) / 50) for n, unit, value in PARAMETERS.get(name, [])]
    return found(name, LOCATIONS.get(name, "joint 2"), *parameters, **changes)


@pytest.mark.parametrize("name", [effect.name for effect in EFFECTS])
def test_every_effect_of_the_library_is_said_in_plain_words(name):
    clause = exact_phrase(example(name))
    assert LOCATIONS.get(name, "joint 2").split(" from ")[0] in clause
    assert "_" not in clause
    assert "{" not in clause
    assert clause == SAID.get(name, clause)


@pytest.mark.parametrize("name", [effect.name for effect in EFFECTS])
def test_an_effect_whose_parameters_are_unknown_still_has_a_sentence_and_a_card(name):
    bare = found(name, LOCATIONS.get(name, "joint 2"))
    assert exact_phrase(bare)
    assert card(bare, 1).readings == ()


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


def test_a_cause_of_several_places_says_where_the_others_are():
    at = [compliance(), *(compliance(location=place) for place in ("joint 5", "link 3", "joint 4"))]
    assert cause_in_words("elastic", at).endswith("under gravity (also giving way: joints 4 and 5 and link 3)")
    many = [*at, compliance(location="base"), compliance(location="tool")]
    assert cause_in_words("elastic", many).endswith("(also giving way: five more places)")
    assert cause_in_words("elastic", [compliance(), compliance()]).endswith("(one more at the same place)")
    assert "(" not in cause_in_words("elastic", at[:1])


def test_nothing_missing_and_cannot_tell_are_whole_answers():
    assert headline(verdicts.clean().verdict).startswith("Nothing is missing: once base and tool are placed")
    undecided = headline(verdicts.cannot_tell().verdict)
    assert undecided.startswith("Cannot tell: 40 rows are fewer")
    assert "would settle it" in undecided
    excess = verdicts.case(answer="cannot tell", mismatch=True).verdict
    assert "follow nothing that was recorded" in headline(excess)


def test_a_number_stays_with_its_unit_and_nothing_else_is_glued():
    assert unbroken("falls from 0.2 mm to 3 % of 4") == "falls from 0.2\u00a0mm to 3\u00a0% of 4"
    assert unbroken("by 3 µrad per N m under it") == "by 3\u00a0µrad per N\u00a0m under it"


def test_products_with_unknown_masses_are_not_told_as_numbers():
    parameters = [Parameter(f"compliance_times_moment_{n}", "rad/(m/s^2)", 1e-5, 1e-6) for n in (1, 2)]
    unknown_masses = card(found("joint_compliance", "joint 5", *parameters), 1)
    assert unknown_masses.readings == ()
    assert "known weight" in unknown_masses.remark


def test_a_free_curve_is_told_by_how_far_it_reaches():
    (told,) = told_parameters(verdicts.unknown_curve())
    assert told.value == pytest.approx(1.5e-4, rel=0.01)
    assert told.stderr == pytest.approx(1.2e-5)


def test_where_a_curve_is_not_known_its_height_is_not_quoted():
    at = np.linspace(0, 1, 5)
    curve = Curve("time", "h", at, np.array([0, 3.0, 9.0, 1.0, 0]), np.array([0.1, 0.1, 8.0, 0.1, 0.1]), "rad")
    assert reach(curve).value == 3.0


def test_rivals_too_close_to_tell_apart_are_marked():
    near, far = card(compliance(), 1).alternatives
    assert near.too_close
    assert not far.too_close


def test_the_papers_linear_model_finds_a_linear_error_and_nothing_in_noise():
    case = verdicts.case(rows=300)
    random = np.random.default_rng(0)
    noise = random.normal(0, 0.03, (300, 3))
    points = 1e3 * forward_kinematics(case.arm, case.recordings.motor_angles)
    linear = 1e-3 * points @ random.normal(size=(3, 3)) + noise
    found_rms = dict(held_out_rms(case.arm, case.recordings, linear))
    assert found_rms["FDP(CI)"] == pytest.approx(0.03, rel=0.1)
    assert found_rms["FDP(AI)"] > 3 * found_rms["FDP(CI)"]
    on_noise = dict(held_out_rms(case.arm, case.recordings, noise))
    assert on_noise["Fourier 2 (AI)"] > np.sqrt(np.mean(noise**2)), "held-out rows punish what only memorises"


def test_a_model_with_more_terms_than_rows_is_not_compared():
    case = verdicts.case(rows=20)
    names = [name for name, _ in held_out_rms(case.arm, case.recordings, np.zeros((20, 3)))]
    assert "FDP(CI)" in names
    assert "Fourier 2 (AI)" not in names


def test_a_number_that_the_poses_leave_open_gets_no_digits():
    """d of a row between parallel axes: 40 mm of uncertainty in an effect of 0.2 mm is no measurement."""
    effect = found("link_geometry", "link 3", Parameter("a", "mm", 0.6, 0.02), Parameter("d", "mm", -0.01, 40.0))
    told = {reading.label: reading for reading in card(effect, 1).readings}
    assert told["length a"].value == "+0.600 mm"
    assert told["length d"].value == "undetermined"


def test_where_a_wave_is_largest_is_told_where_the_rows_know_it():
    """Half a radian of uncertainty is 29 degrees of a turn, and no shift of half a metre."""
    swing, known = Parameter("amplitude", "rad", 2.7e-4, 1e-5), Parameter("phase", "rad", 1.0, 0.5)
    for phase, told in ((known, "57°"), (Parameter("phase", "rad", 1.0, 1.7), "undetermined")):
        effect = found("axis_wobble", "joint 2", swing, phase, rms_at_tool_mm=0.1)
        readings = {reading.label: reading for reading in card(effect, 1).readings}
        assert readings["largest at"].value == told


def test_a_tilt_that_may_as_well_be_none_has_no_number_in_a_sentence():
    clear, open_ = (
        Parameter("compliance_y", "rad/(N m)", 1.9e-6, 2e-7),
        Parameter("compliance_x", "rad/(N m)", 9e-7, 8e-7),
    )
    assert exact_phrase(found("base_compliance", "base", open_, clear)) == (
        "the base tilts by 1.9 µrad per N m about its y under the arm's moment"
    )
    neither = replace(clear, name="compliance_y", stderr=1.5e-6)
    assert exact_phrase(found("base_compliance", "base", open_, neither)) == "the base tilts under the arm's moment"


def test_an_effect_that_resampling_rarely_finds_is_said_to_be_one_way_of_putting_it():
    assert "not as the cause" in chosen_how_often(0.2)
    assert chosen_how_often(0.9) == "chosen in 90 % of the resampled data sets"


def test_a_drift_that_follows_the_rows_is_not_told_per_hour():
    told = [Parameter(axis, "mm/1000 rows", 0.1, 0.01) for axis in "xyz"]
    drift = found("base_drift", "base", *told, driver="order of rows, with a pause before row 56")
    said = headline(verdicts.case(effects=(drift,)).verdict)
    assert said.startswith("The base drifts by 0.17 mm per 1000 rows, with a pause before row 56")


def test_a_jump_is_told_with_the_row_and_the_run_in_which_it_happened():
    shift = replace(
        found("base_shift", "base", Parameter("x", "mm", 1.0, 0.1), Parameter("row", "", 163.0, 0.5)),
        driver="order of rows, run monday", title="base shift at base",
    )  # fmt: skip
    assert title_of(shift) == "base shift at base, from row 163 of run monday"
    assert title_of(replace(shift, driver="order of rows")) == "base shift at base, from row 163"
    assert title_of(replace(shift, effect="base_drift")) == "base shift at base"


def test_a_rival_that_fits_alike_is_too_close_although_its_size_costs_it_evidence():
    """What made the title vague stands among the alternatives as the reason."""
    wave = Alternative("gear_eccentricity", "joint 2", "transmission", 5.2, "angle of joint 2", 0.4)
    far = Alternative("base_compliance", "base", "elastic", 5.2, "moment on the base", 5.2)
    shown = card(compliance(named_as="region", alternatives=(wave, far)), 1).alternatives
    assert [other.too_close for other in shown] == [True, False]
    assert "only because of its prior" in shown[0].gap
    assert shown[1].gap == "5.2 nats worse"


def test_no_place_has_more_than_all_of_the_mismatch():
    case = verdicts.case(effects=(compliance(share=53.0), compliance("joint 3", share=48.0)))
    assert location_shares(case.verdict) == {"joint 2": 1.0, "joint 3": 1.0}


def test_a_joint_that_turns_against_its_load_is_not_told_to_give_way():
    along, against = (Parameter("compliance", "rad/(N m)", value, 1e-8) for value in (3.2e-7, -3.2e-7))
    assert exact_phrase(found("joint_compliance", "joint 2", along)).startswith(
        "joint 2 gives way by 0.32 µrad per N m"
    )
    told = exact_phrase(found("joint_compliance", "joint 2", against))
    assert told == "joint 2 turns against gravity's pull, as no spring does, by 0.32 µrad per N m"
