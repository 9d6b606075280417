"""Cards of the effects: numbers with their intervals, rivals, how often chosen."""

from dataclasses import replace

import pytest

from armscope.report.sections import locations
from armscope.report.sections.effect_cards import card, chosen_how_often, title_of, told_parameters
from armscope.verdict.effects import Alternative, Parameter
from armscope.verdict.wording import evidence_in_words
from tests.report import verdicts
from tests.report.verdicts import compliance, found


def test_products_with_unknown_masses_are_not_told_as_numbers():
    parameters = [Parameter(f"compliance_times_moment_{n}", "rad/(m/s^2)", 1e-5, 1e-6) for n in (1, 2)]
    unknown_masses = card(found("joint_compliance", "joint 5", *parameters), 1)
    assert unknown_masses.readings == ()
    assert "known weight" in unknown_masses.remark


def test_a_free_curve_is_told_by_how_far_it_reaches():
    (told,) = told_parameters(verdicts.unknown_curve())
    assert told.value == pytest.approx(1.5e-4, rel=0.01)
    assert told.stderr == pytest.approx(1.2e-5)


def test_a_command_in_a_cure_stands_without_the_marks_of_code():
    wobble = replace(found("axis_wobble", "joint 1"), cure="Let it compute the commands (`armscope compensate`).")
    assert card(wobble, 1).cure == "Let it compute the commands (armscope compensate)."


def test_rivals_too_close_to_tell_apart_are_marked():
    near, far = card(compliance(), 1).alternatives
    assert near.too_close
    assert not far.too_close


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


def test_an_effect_that_resampling_rarely_finds_is_said_to_be_one_way_of_putting_it():
    assert "not as the cause" in chosen_how_often(0.2)
    assert chosen_how_often(0.9) == "chosen in 90 % of the resampled data sets"


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


def test_the_weaker_of_evidence_and_choice_decides_what_a_card_calls_the_evidence() -> None:
    """Seen: "Overwhelming evidence" beside "Chosen in 60 % of the resampled data sets"."""
    assert evidence_in_words(37.0, 0.6).startswith("some evidence: odds far beyond a thousand to 1 on these rows, but")
    assert evidence_in_words(37.0, 0.97).startswith("overwhelming evidence")
    assert evidence_in_words(37.0).startswith("overwhelming evidence")
    assert card(verdicts.compliance(inclusion=0.6, evidence_nats=37.0), 1).evidence_words.startswith("some evidence")


def test_a_card_tells_the_share_of_what_calibration_leaves_where_geometry_hides_it() -> None:
    play = verdicts.found("backlash", "joint 2", Parameter("gap", "rad", 2e-4, 1e-6), share=0.01)
    assert card(play, 1).of_rest == ""
    assert card(replace(play, share_after_calibration=0.6), 1).of_rest == "60 % of what calibration leaves"
    case = verdicts.case(effects=(replace(play, share_after_calibration=0.6),))
    (place,) = (place for place in locations._ranking(case.verdict) if place.link)
    assert (place.told, place.of_rest) == ("1.0 %", "60 % of what calibration leaves")


@pytest.mark.parametrize(
    ("gap", "told"),
    [(-54.9, "fits 54.9 nats better here, but was struck out"), (-0.3, "fits as well"), (4.5, "4.5 nats worse")],
)
def test_what_was_struck_out_is_not_called_too_close(gap: float, told: str) -> None:
    """ "54.9 nats better – too close to tell apart" stood beside overwhelming evidence."""
    rival = Alternative("gear_mesh", "joint 4", "transmission", gap, "joint angle", gap)
    (shown,) = card(replace(compliance(), alternatives=(rival,)), 1).alternatives
    assert shown.gap.startswith(told)
    assert shown.too_close is (abs(gap) < 3)
