"""Verdicts on moving worlds scored: each case is one that a person would judge the same way."""

import numpy as np
import pytest
from scipy.stats import beta

from armscope.core.inputs import InputError
from armscope.proof.motion.answers import claims_of
from armscope.proof.motion.rates import in_words, per_effect, summary
from armscope.proof.motion.reading import ALLOWED
from armscope.proof.motion.scoring import COLUMNS, held_out_ratio, score
from armscope.proof.reading import check_seal
from tests.proof.motion.cases import LEFT, ROWS, effect, link_side, said, verdict_of, world

HYSTERESIS = effect("unknown", "joint 2", shape="hysteresis")


def only(tables, table="worlds"):
    assert len(tables[table]) == 1
    return tables[table].iloc[0]


def test_the_right_name_at_the_right_place_is_exact_and_its_interval_counts():
    tables = score([world([effect(offset=2.0)], [said(offset=(2.1, 0.1))])])
    assert only(tables)["exact"]
    assert only(tables, "effects")["outcome"] == "named"
    assert only(tables, "intervals")["covered"]
    assert not only(score([world([effect(offset=2.0)], [said(offset=(2.3, 0.1))])]), "intervals")["covered"]


@pytest.mark.parametrize(
    ("answer", "exact", "outcome"),
    [
        (said("gravity_balance", "joint 2"), True, "acceptable"),
        (said("cable_torque", "joint 2"), False, "located"),
        (said("torque_offset", "joint 1"), False, "missed"),
        (said("cable_torque", "joint 2", [("torque_offset", "joint 2")]), False, "listed"),
    ],
)
def test_sealed_alternatives_are_right_and_other_names_are_not(answer, exact, outcome):
    tables = score([world([effect(alternatives=[("gravity_balance", "joint 2")])], [answer])])
    assert only(tables)["exact"] == exact
    assert only(tables, "effects")["outcome"] == outcome


@pytest.mark.parametrize("named", [True, False])
def test_what_another_concealed_cause_says_as_well_is_right_named_or_not(named):
    concealed = [effect(), effect("cable_torque", "joint 2")]
    for minor, exact in ((True, True), (False, named)):
        concealed[0]["minor"] = minor
        answers = [said("cable_torque", "joint 2"), *([said()] if named else [])]
        assert only(score([world(concealed, answers)]))["exact"] == exact


def test_a_name_too_many_or_an_unknown_beside_it_is_not_exact():
    assert not only(score([world([effect()], [said(), said("rotor_inertia", "joint 1")])]))["exact"]
    assert not only(score([world([effect()], [said()], unknown_at="joint 1")]))["exact"]


def test_clean_arms_are_silent_or_not():
    assert only(score([world(category="clean")]))["silent"]
    assert not only(score([world([], [said()], "clean")]))["silent"]
    assert not only(score([world(category="clean", unknown_at="joint 1")]))["silent"]
    assert not only(score([world(category="clean", failed=True)]))["silent"]


@pytest.mark.parametrize(
    ("answers", "unknown_at", "outcome"),
    [
        ([], "joint 2", "located"),
        ([], "joint 1", "elsewhere"),
        ([], None, "missed"),
        ([said("stribeck_friction", "joint 2")], None, "misnamed"),
        ([said("stribeck_friction", "joint 2")], "joint 2", "partly named"),
        ([said("stribeck_friction", "joint 1")], "joint 2", "misnamed"),
    ],
)
def test_physics_outside_the_library_is_located_without_a_name(answers, unknown_at, outcome):
    row = only(score([world([HYSTERESIS], answers, "outside", unknown_at)]))
    assert (row["outside"], row["outside_right"]) == (outcome, outcome == "located")


def test_held_out_error_counts_in_units_of_what_the_truth_leaves():
    right = world()
    assert held_out_ratio(right.truth, right.answer) == pytest.approx(1, abs=0.05)
    off = world(off=3.0)
    assert held_out_ratio(off.truth, off.answer) == pytest.approx(np.sqrt(1 + 9), rel=0.05)


def test_friction_of_a_standing_joint_counts_in_one_of_two_ratios():
    stuck = world()
    stuck.answer.predicted.loc[: ROWS // 20, "tau1_nm"] += 20 * LEFT[0]
    row = only(score([stuck]))
    assert row["held_out_ratio"] > 2
    assert row["held_out_moving"] == pytest.approx(1, abs=0.05)
    stuck.answer.predicted.loc[: ROWS // 20, "tau2_nm"] += 20 * LEFT[1]
    assert only(score([stuck]))["held_out_moving"] > 2


def test_a_path_without_prediction_is_infinitely_wrong_but_its_ends_may_be_lost():
    lost = world()
    lost.answer.predicted.iloc[: ROWS // 20] = np.nan
    assert held_out_ratio(lost.truth, lost.answer) == pytest.approx(1, abs=0.05)
    lost.answer.predicted.iloc[: ROWS // 2] = np.nan
    assert np.isinf(held_out_ratio(lost.truth, lost.answer))
    failed = world(failed=True)
    assert np.isinf(held_out_ratio(failed.truth, failed.answer))


def test_ordinary_friction_counts_where_nothing_is_concealed_at_the_joint():
    numbers = {"coulomb": (5.1, 0.1, "N m"), "viscous": (4.5, 0.1, "N m s/rad")}
    told = (("joint 1", numbers), ("joint 2", numbers))
    intervals = score([world([effect()], [said()], background=told)])["intervals"]
    assert list(intervals["location"]) == ["joint 1", "joint 1"]
    assert list(intervals["covered"]) == [True, False]
    assert score([world([effect()], [said()], background=told, stated=True)])["intervals"].empty


def test_what_lays_a_link_beside_its_motor_is_a_name_and_zeros_are_none():
    claims = claims_of(verdict_of([], links=(link_side([said("joint_play", "joint 1")]),)))
    assert [claim.name for claim in claims] == [("joint_play", "joint 1")]
    read = {"joint 1": (1.1e-3, 1e-4, "rad"), "joint 2": (0.0, 1e-4, "rad")}
    clean = score([world(category="clean", zeros=(1e-3, 1e-3), told_zeros=read)])
    assert only(clean)["silent"]
    assert clean["intervals"]["covered"].tolist() == [True, False]
    busy = [effect("joint_play", "joint 1", half=1e-4)]
    beside = score([world(busy, [], zeros=(1e-3, 1e-3), told_zeros=read)])["intervals"]
    assert beside[["location", "parameter"]].to_numpy().tolist() == [["joint 2", "zero"]]


def test_rates_have_exact_intervals_and_aims_are_judged():
    worlds = [world([effect()], [said()] if k else [], name=f"motion-{k:03d}", fresh=k % 2 == 1) for k in range(20)]
    cases = score(worlds)
    told = summary(cases).set_index(["aim", "seeds"])
    row = told.loc[("exact set of names, single causes at 3x the noise and above", "all")]
    assert (row["cases"], row["right"]) == (20, 19)
    # Clopper & Pearson (1934) by the beta distribution
    assert (row["low"], row["high"]) == pytest.approx((beta.ppf(0.025, 19, 2), beta.ppf(0.975, 20, 1)))
    assert row["verdict"] == "met"
    assert told.loc[("no name on clean arms", "all"), "verdict"] == "too few cases"
    assert "19" not in in_words(summary(score([])))
    assert "| 20 | 0.95 |" in in_words(summary(cases))
    found = per_effect(cases).set_index(["effect", "score"])
    assert found.loc[("torque_offset", "found"), "right"] == 19


def test_nothing_scored_is_empty_tables():
    for name, cases in score([]).items():
        assert tuple(cases.columns) == COLUMNS[name]
        assert cases.empty


def test_a_job_that_saw_the_truth_is_refused(tmp_path):
    seen = tmp_path / "seen.txt"
    seen.write_text("visible/motion-000/motions.csv\nvisible/motion-000/robot.yaml\n")
    check_seal(seen, ALLOWED)
    for wrong in ("sealed/motion-000/truth.yaml\n", ""):
        seen.write_text(wrong)
        with pytest.raises(InputError, match="diagnosing job"):
            check_seal(seen, ALLOWED)


SMALL = [effect("link_mass", "link 2") | {"strength": 1.0}, effect("stribeck_friction", "joint 1") | {"strength": 4.9}]


def case(answers, effects=(), allowed=()):
    return score([world(effects, answers, category="rough", rough=SMALL, also_allowed=allowed)])["worlds"].iloc[0]


def test_what_is_rough_is_right_named_or_not():
    cause = effect()
    assert case([said()], [cause])["right"]
    assert case([said(), said("link_mass", "link 2")], [cause])["right"]


def test_a_cause_that_is_missed_or_a_name_of_nothing_is_wrong():
    assert not case([said("link_mass", "link 2")], [effect()])["right"]
    found = case([said(), said("cable_torque", "joint 1")], [effect()])
    assert not found["right"]
    assert not found["nothing_false"]


def test_something_unknown_is_never_wrong_and_no_cause_needs_no_name():
    assert case([], [])["right"]
    assert case([said("unknown", "joint 1")], [])["right"]


@pytest.mark.parametrize(("first", "right"), [("link_mass", False), ("stribeck_friction", True)])
def test_the_first_name_is_a_causes_or_of_something_as_large(first, right):
    place = {"link_mass": "link 2", "stribeck_friction": "joint 1"}[first]
    found = case([said(first, place), said()], [effect()])
    assert found["first"] == found["right"] == right


def test_names_that_are_as_good_are_no_wrong_ones():
    answers = [said(), said("payload_error", "payload")]
    assert not case(answers, [effect()])["right"]
    assert case(answers, [effect()], allowed=(("payload_error", "payload"),))["right"]


def test_other_arms_are_not_judged_so():
    row = score([world([effect()], [said()])])["worlds"].iloc[0]
    assert row[["first", "nothing_false", "right"]].isna().all()
