"""Claims: exact intervals, both methods, models that are missing, and outcomes recomputed here by a shorter way."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import beta

from armscope.errormodels.features import FDP_AI, FDP_CI
from armscope.errormodels.swarm_fit import fit_swarms
from armscope.paper.claims import AS_PRINTED, IMPROVED, Evidence, judge_claims, judges, summarise
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.claims.claim import GROUPS
from armscope.paper.claims.judges import arrival, cost_ratio
from armscope.paper.claims.table import DEPENDS, FAILS, HOLDS, OPEN, interval, under_assumptions, verdict
from armscope.paper.method import PRINTED_BASIS, PRINTED_LAYOUT, as_printed
from armscope.paper.outlook import outlook, sub_volumes
from armscope.swarm.settings import SwarmSettings
from tests.paper.conftest import ENSEMBLE, SPECS


@pytest.fixture(scope="module")
def printed_fits(study):
    problems = study.measurements.fit_problems(SPECS, list(study.measurements.robots))
    return fit_swarms(problems, [0], as_printed(SwarmSettings()), PRINTED_BASIS, layout=PRINTED_LAYOUT)


@pytest.fixture(scope="module")
def evidence(study, fits, printed_fits):
    extended = outlook(study.measurements)
    improved = Evidence.of(study.measurements, fits)
    improved = replace(improved, outlook=extended, sub_volumes=sub_volumes(study.measurements))
    return {AS_PRINTED: Evidence.of(study.measurements, printed_fits), IMPROVED: improved}


@pytest.fixture(scope="module")
def judged(evidence):
    table, _ = judge_claims(evidence)
    return table.set_index(["key", "method"])


def test_the_interval_is_that_of_the_beta_distribution():
    assert interval(7, 20) == pytest.approx((beta.ppf(0.025, 7, 14), beta.ppf(0.975, 8, 13)))
    assert interval(0, 20)[0] == 0
    assert interval(20, 20)[1] == 1


@pytest.mark.parametrize(
    ("true", "robots", "expected"),
    [
        (100, 100, HOLDS),
        (96, 101, OPEN),
        (71, 71, OPEN),
        (72, 72, HOLDS),
        (0, 100, FAILS),
        (50, 100, DEPENDS),
        (3, 6, DEPENDS),
    ],
)
def test_a_verdict_is_given_only_where_an_interval_supports_it(true, robots, expected):
    assert verdict(true, robots) == expected


def test_an_assumption_decides_where_its_change_turns_a_decisive_verdict():
    assert under_assumptions(HOLDS, [("rise", HOLDS), ("noise", OPEN)]) == ("holds under all", ())
    assert under_assumptions(DEPENDS, [("rise", DEPENDS)]) == (DEPENDS, ())
    assert under_assumptions(DEPENDS, [("rise", DEPENDS), ("theta6", FAILS)]) == (
        "depends on the assumption",
        ("theta6",),
    )
    assert under_assumptions(OPEN, [("rise", OPEN)]) == (OPEN, ())


def test_every_claim_has_its_place_and_the_papers_own_their_words():
    assert len({claim.key for claim in CLAIMS}) == len(CLAIMS)
    for claim in CLAIMS:
        assert claim.group in GROUPS
        assert claim.source.startswith("p. 9")
        if claim.group == GROUPS[0] and "Table 2 (not said" not in claim.source:
            assert claim.wording


def test_the_wording_is_the_papers():
    """Every quoted piece stands in the paper's text, where that is there."""
    from pathlib import Path

    text_file = Path(__file__).parents[2].parent / "shared" / "paper" / "alici2006.txt"
    if not text_file.is_file():
        pytest.skip("the paper's text is not beside the checkout")
    text = " ".join(text_file.read_text(encoding="utf-8").split())
    for claim in CLAIMS:
        for piece in claim.wording.split("[…]"):
            assert piece.strip(" ,") in text, claim.key


def test_shares_are_of_the_drawn_robots_without_the_anchored_one(judged, evidence):
    row = judged.loc["cartesian_1", IMPROVED]
    assert row["robots"] == ENSEMBLE
    cells = evidence[IMPROVED].cells
    ratio = np.minimum(*(cells[f"{d}(AI)", "test 1", "3D"] / cells[f"{d}(CI)", "test 1", "3D"] for d in ("FDP", "SDP")))
    assert row["true"] == int((ratio.drop("anchored") > 1).sum())
    assert row["number_anchored"] == pytest.approx(ratio["anchored"])
    assert row["anchored"] == ("yes" if ratio["anchored"] > 1 else "no")
    assert row["number_printed"] == pytest.approx(1.03, abs=0.01)


def test_cells_of_the_evidence_are_those_of_the_residual_table(evidence, residuals):
    row = residuals.query("robot == 'ensemble 2' and model == 'SDP(AI)' and trajectory == 'test 3' and axis == 'y'")
    expected = row[row["method"] == "swarm"]["rms_mm"].median()
    assert evidence[IMPROVED].cells.loc["ensemble 2", ("SDP(AI)", "test 3", "y")] == pytest.approx(expected)
    exact = row[row["method"] == "least squares"]["rms_mm"].iloc[0]
    assert evidence[IMPROVED].by_least_squares.loc["ensemble 2", ("SDP(AI)", "test 3", "y")] == pytest.approx(exact)


def test_the_method_as_printed_is_judged_by_its_own_fits(judged, printed_fits):
    row = judged.loc["alternative", AS_PRINTED]
    worst = {}
    for fit in printed_fits:
        if fit.name in ("FDP(CI)", "FDP(AI)", "SDP(CI)", "SDP(AI)"):
            worst[fit.label] = max(worst.get(fit.label, 0), float(fit.excess_percent.max()))
    assert row["number_anchored"] == pytest.approx(worst["anchored"])
    assert row["true"] == 0
    assert row["number"] > 10
    assert judged.loc["alternative", IMPROVED]["true"] == ENSEMBLE


def test_the_outlook_is_judged_by_its_table(judged, evidence):
    extended = evidence[IMPROVED].outlook
    rows = extended[(extended["robot"] == "anchored") & (extended["model"] == "Fourier 2 (AI)")]
    tests = rows[rows["trajectory"] != "identification"]
    by_kind = {kind: np.sqrt(np.mean(part["rms_mm"] ** 2)) for kind, part in tests.groupby("kind")}
    row = judged.loc["products_Fourier 2 (AI)", "least squares"]
    assert row["number_anchored"] == pytest.approx(by_kind["sums"] / by_kind["products"])
    sizes = extended[(extended["model"] == "FDP(CI)") & (extended["kind"] == "sub-volumes")].groupby("robot")["size"]
    assert judged.loc["called_for", "least squares"]["true"] == int((sizes.first().drop("anchored") > 1).sum())


def test_a_claim_turns_when_the_numbers_turn(evidence):
    """Negative control: with angular and Cartesian fits exchanged, the verdict on 'Cartesian beats angular' turns."""
    names = {"FDP(CI)": "FDP(AI)", "FDP(AI)": "FDP(CI)", "SDP(CI)": "SDP(AI)", "SDP(AI)": "SDP(CI)"}
    swapped = replace(evidence[IMPROVED], cells=evidence[IMPROVED].cells.rename(columns=names, level="model"))
    before = judge_claims(evidence)[0].set_index(["key", "method"]).loc["cartesian_1", IMPROVED]["share"]
    after = (
        judge_claims({**evidence, IMPROVED: swapped})[0]
        .set_index(["key", "method"])
        .loc["cartesian_1", IMPROVED]["share"]
    )
    assert before > 0.5 > after


def test_claims_whose_models_are_missing_are_skipped_with_a_reason(study):
    problems = study.measurements.fit_problems((FDP_CI,), list(study.measurements.robots))
    alone = Evidence.of(study.measurements, fit_swarms(problems, [0]))
    table = judge_claims({AS_PRINTED: alone, IMPROVED: alone})[0].set_index(["key", "method"])
    assert table.loc["cartesian_1", IMPROVED]["verdict"] == "skipped"
    assert table.loc["cartesian_1", IMPROVED]["why_skipped"] == "FDP(AI) not among the configured models"
    assert table.loc["smaller", IMPROVED]["verdict"] != "skipped"
    no_paper = study.measurements.fit_problems((replace(FDP_AI, order=3),), list(study.measurements.robots))
    other = Evidence.of(study.measurements, fit_swarms(no_paper, [0]))
    table = judge_claims({AS_PRINTED: other, IMPROVED: other})[0].set_index(["key", "method"])
    assert table.loc["smaller", IMPROVED]["why_skipped"] == "none of the paper's models is configured"


def test_the_summary_says_which_assumption_decides(evidence):
    table = judge_claims(evidence)[0]
    row = table[(table["key"] == "alternative") & (table["method"] == IMPROVED)].iloc[0]
    turned = {"scenario": "s1", "factor": "rise", "level": "0", "key": "alternative", "method": IMPROVED}
    base = table.assign(verdict=HOLDS, true=100, robots=100, share=1.0)
    scenario = pd.DataFrame([{**turned, "verdict": FAILS, "true": 0, "robots": 100, "share": 0.0}])
    found = summarise(base, scenario).set_index(["key", "method"]).loc["alternative", IMPROVED]
    assert found["under_assumptions"] == "depends on the assumption"
    assert found["depends_on"] == found["moved_by"] == "rise"
    assert (found["share_least"], found["share_most"]) == (0.0, 1.0)
    assert row["key"] == "alternative"


def test_arrival_is_the_first_iteration_close_to_least_squares(fits):
    fit = next(f for f in fits if f.name == "SDP(CI)")
    slowest = 0
    for seed in range(len(fit.seeds)):
        for axis in range(3):
            close = fit.history_mm[seed, axis] <= 1.01 * fit.least_squares_mm[axis]
            slowest = max(slowest, int(np.flatnonzero(close)[0]))
    assert arrival(fit) == slowest
    assert cost_ratio(fit) == pytest.approx((1 + slowest) * 100 / 7)


def _arriving(iterations: int, at: int) -> SimpleNamespace:
    """A fit whose only swarm is close to least squares from an iteration on; infinite: never."""
    history = np.where(np.arange(iterations + 1) >= at, 1.0, 2.0)[None, None, :]
    return SimpleNamespace(history_mm=history, optimum_mm=np.array([1.0]), label="r", name="FDP(CI)")


@pytest.mark.parametrize(
    ("iterations", "at", "holds"),
    [(200, 150, True), (200, 999, False), (300, 250, False), (80, 60, True), (80, 999, None)],
)
def test_swarms_stopped_sooner_do_not_say_that_200_iterations_fail(monkeypatch, iterations, at, holds) -> None:
    fit = _arriving(iterations, at)
    monkeypatch.setattr(judges, "_worst", lambda evidence, fits, number: np.array([number(each) for each in fits]))
    judged = judges.iterations_suffice(SimpleNamespace(fits=[fit]))
    assert (None if judged is None else bool(judged.per_robot.all())) is holds
