"""The page of an arm in motion shows what was found, where, and on which motion it was tested."""

from __future__ import annotations

import functools
import html
import math
import re
import shlex
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.types import Array
from armscope.inference.evidence import evaluate
from armscope.motion.export import write_motion
from armscope.motion.fitting.selected import coefficients_of
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.holding_out import folds
from armscope.report.motion_subject import MotionSubject, liveliest_piece
from armscope.report.pages.motion import write_motion_report
from armscope.report.sectioning import write_sections
from armscope.report.sections import motion_work
from armscope.report.sections.motion import (
    MOTION_SECTIONS,
    arm_of_motion,
    relative_steps,
    value_to_enter,
)
from armscope.report.sections.motion_cards import motion_card, signed
from armscope.report.sections.motion_work import IN_FULL, error_in_words, fitted_along_matters, motion_work_order
from armscope.verdict.effects import Alternative, Parameter
from tests.motion.moving import ROBOT, moved, robot

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


def cabled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A cable at joint 1 that no spring is like."""
    extra = np.zeros_like(q)
    extra[:, 0] = 4 * np.sin(3.1 * q[:, 0]) * (q[:, 0] > 0)
    return extra


@functools.cache
def of_a_cable() -> MotionDiagnosis:
    arm = robot()
    return diagnose_motion(arm, moved(arm, 7, cabled), MotionSettings(cutoff=10.0))


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    return of_a_cable()


@pytest.fixture(scope="module")
def page(found: MotionDiagnosis, tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("page")
    return write_motion_report(found, "motions <b>.csv", folder).read_text(encoding="utf-8")


def test_the_page_needs_no_network_and_obeys_no_name(page: str) -> None:
    assert not re.search(r"(src|href)=\"https?:", page)
    assert "motions &lt;b&gt;.csv" in page
    assert "<script" not in page


def test_masses_without_a_name_are_no_rest_that_follows_nothing(found: MotionDiagnosis, tmp_path: Path) -> None:
    verdict = replace(found.verdict, effects=(), masses_share=0.1)
    for answer, told in (("cannot tell", "masses that are off at all links"), ("nothing missing", "beyond ordinary")):
        unnamed = replace(found, verdict=replace(verdict, answer=answer), entered=found.entered[:2])
        page = write_motion_report(unnamed, "motions.csv", tmp_path).read_text(encoding="utf-8")
        assert f"No place stands out: {told}" in page


def test_every_section_and_every_joint_is_there(page: str, found: MotionDiagnosis) -> None:
    for section in MOTION_SECTIONS:
        assert (f'id="{section.name}"' in page) == section.applies(found.verdict)
    for joint in (1, 2, 3):
        assert page.count(f">joint {joint}</text>") == 5  # torque, friction, and what is left thrice
    assert found.how.words[:20] in page


def test_each_cause_has_a_card_with_its_confirmation_and_cure(page: str, found: MotionDiagnosis) -> None:
    main = [cause for cause in found.verdict.effects if not cause.minor]
    assert main
    for cause in main:
        assert cause.confirm in page
        assert cause.cure in page.replace("\u00a0", " ")
    assert page.count('<article class="effect"') == len(main)


def test_the_work_order_has_a_line_per_cause_with_its_cure_and_the_error_after_it(
    found: MotionDiagnosis, tmp_path: Path
) -> None:
    write_motion_report(found, "motions.csv", tmp_path)
    order = (tmp_path / "work-order.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    main = [cause for cause in found.verdict.effects if not cause.minor]
    assert order.count("Confirm first:") == len(main) <= IN_FULL
    assert f"{error_in_words(found.entered[0].whole)} after this" in order
    for number, (cause, error) in enumerate(zip(main, found.entered[2:], strict=False), start=2):
        assert cause.cure.replace("`", "") in order
        assert f"{error_in_words(error.whole)} after 1 to {number}" in order
    assert all(f"<td>{each.joint}</td>" in order for each in found.verdict.background)
    assert error_in_words(float("nan")) == "–"


def test_errors_to_expect_hold_for_the_numbers_that_are_entered(found: MotionDiagnosis) -> None:
    """Of one model, fitted once to the rest: friction alone, then masses and the cause; by hand."""
    selected = found.selected
    layout, (cause, *others) = selected.rows.layout, found.verdict.effects
    assert not others
    number = selected.best.chosen[0].candidate
    missed, torque = [], []
    for fold in folds(selected):
        again = evaluate(fold.problem, selected.best.chosen, selected.best.background, fold.found.noise)
        numbers = coefficients_of(fold.problem, again)
        numbers[[*layout.reversals.ravel(), *layout.response, *layout.own.reshape(3, -1)[:, 0]]] = 0
        left = set(range(layout.width)) - {*layout.own, *layout.inertial, *layout.columns[number]}
        assert not np.any(numbers[sorted(left)])
        moving = ~fold.rows.still[fold.which]
        said = fold.rows.nominal[fold.which] + fold.rows.modelled(numbers, fold.which)
        missed.append(moving * (fold.rows.torque[fold.which] - said))
        torque.append(moving * fold.rows.torque[fold.which])
    by_hand = np.linalg.norm(np.concatenate(missed)) / np.linalg.norm(np.concatenate(torque))
    assert found.entered[2].whole == pytest.approx(by_hand, rel=1e-6), cause.title
    assert found.entered[0].whole > 2 * found.entered[2].whole
    assert found.entered[2].whole < 3 * found.verdict.held_out.model


def many_tasks(found: MotionDiagnosis, close: Alternative) -> MotionDiagnosis:
    """The same with eleven causes, each hardly told from another."""
    effects, entered = found.verdict.effects, found.entered
    one = replace(effects[0], alternatives=(close,), minor=False)
    wanted = 11
    more = tuple(replace(one, title=f"cause {n}") for n in range(wanted))
    step = found.verdict.waterfall[-1]
    falling = (*found.verdict.waterfall[:2], *(replace(step, label=each.title) for each in more))
    verdict = replace(found.verdict, effects=more, waterfall=falling)
    return replace(found, verdict=verdict, entered=(*entered[:2], *entered[2:3] * wanted))


@pytest.mark.long
def test_the_command_that_is_printed_runs_as_it_is(
    found: MotionDiagnosis, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my robot.yaml").write_text(yaml.safe_dump(ROBOT))
    told = many_tasks(found, Alternative("gravity_balance", "joint 1", "springs", 1.0, "joint angle", 1.0))
    folder = Path("my out")
    write_motion(told, folder)
    write_motion_report(told, "motions.csv", folder, "my robot.yaml")
    order = (folder / "work-order.html").read_text(encoding="utf-8")
    command = shlex.split(html.unescape(re.findall(r"<code>(armscope [^<]*)</code>", order)[0]))
    assert command[:2] == ["armscope", "excite"]
    ended = CliRunner().invoke(app, [*command[1:], "--rounds", "3"])
    assert ended.exit_code == 0, ended.output
    assert "cable_torque at joint 1 and gravity_balance at joint 1" in ended.output
    assert (tmp_path / "trajectory.csv").is_file()


def test_causes_beyond_the_first_stand_in_a_line_each(found: MotionDiagnosis) -> None:
    close = Alternative("gravity_balance", "joint 1", "springs", 1.0, "joint angle", 1.0)
    told = motion_work_order(MotionSubject(many_tasks(found, close), "motions.csv"))
    assert len(told["tasks"]) == IN_FULL
    assert len(told["more"]) == 11 - IN_FULL


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_eleven_tasks_are_printed_on_one_page(found: MotionDiagnosis, tmp_path: Path) -> None:
    close = Alternative("gravity_balance", "joint 1", "springs", 1.0, "joint angle", 1.0)
    write_motion_report(many_tasks(found, close), "motions.csv", tmp_path)
    page, printed = tmp_path / "work-order.html", tmp_path / "order.pdf"
    flags = ("--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer", f"--print-to-pdf={printed}")
    subprocess.run([str(CHROMIUM), *flags, page.as_uri()], check=True, capture_output=True, timeout=120)
    assert len(re.findall(rb"/Type ?/Page\b", printed.read_bytes())) == 1


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")
def test_the_table_of_the_work_order_fits_a_telephone(found: MotionDiagnosis, tmp_path: Path) -> None:
    write_motion_report(found, "motions.csv", tmp_path)
    page = tmp_path / "work-order.html"
    measure = (
        "<script>for (const each of document.querySelectorAll('.scroll')) "
        "each.dataset.beyond = each.scrollWidth - each.clientWidth;</script></body>"
    )
    page.write_text(page.read_text(encoding="utf-8").replace("</body>", measure), encoding="utf-8")
    flags = ("--headless", "--no-sandbox", "--disable-gpu", "--window-size=420,1800", "--dump-dom")
    told = subprocess.run([str(CHROMIUM), *flags, page.as_uri()], check=True, capture_output=True, timeout=120).stdout
    beyond = re.findall(rb'data-beyond="(-?\d+)"', told)
    assert beyond
    assert all(int(each) <= 0 for each in beyond)


def test_masses_are_told_to_be_taken_along_where_they_matter(
    found: MotionDiagnosis, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    friction, masses, *rest = found.verdict.waterfall

    def with_masses_at(error: float) -> MotionSubject:
        steps = (replace(friction, held_out=0.16), replace(masses, held_out=error), *rest)
        return MotionSubject(replace(found, verdict=replace(found.verdict, waterfall=steps)), "motions.csv")

    assert not fitted_along_matters(with_masses_at(0.014))  # none were fitted
    monkeypatch.setattr(MotionSubject, "masses_fitted", True)
    assert fitted_along_matters(with_masses_at(0.014))
    assert not fitted_along_matters(with_masses_at(0.1601))
    told = motion_work_order(with_masses_at(0.014))
    assert told["apart"] == error_in_words(found.entered[1].whole), "a step of its own, before the causes"
    assert "corrected.urdf" not in told["tasks"][0].cure
    write_motion_report(with_masses_at(0.014).found, "motions.csv", tmp_path)
    order = (tmp_path / "work-order.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    step = f"they were fitted along. <b>Expect:</b> {told['apart']}"
    assert step in order
    assert f"{error_in_words(found.entered[2].whole)} after 1 to 3, masses included" in order
    assert not motion_work_order(with_masses_at(0.1601))["apart"]
    monkeypatch.setattr(motion_work, "_is_in_bodies", lambda cause: True)
    with_a_body = motion_work_order(with_masses_at(0.014))
    assert not with_a_body["apart"], "that file holds the cause's change, too"
    assert "corrected.urdf" in with_a_body["tasks"][0].cure


@pytest.mark.parametrize(
    ("name", "value", "error", "words"),
    [
        ("coulomb", 0.2, 0.01, "0.200 ± 0.020 N m"),
        ("coulomb", -0.02, 0.15, "not seen"),
        ("viscous", -0.02, math.nan, "not seen"),
        ("coulomb", -0.3, 0.05, "0 (fitted −0.300 ± 0.098 N m)"),
        ("inertia", -0.01, 0.02, "not seen"),
        ("inertia", -0.3, 0.05, "−0.300 ± 0.098 N m"),
        ("offset", -0.02, 0.15, "−0.02 ± 0.29 N m"),
    ],
)
def test_friction_below_zero_is_no_value_to_enter(name: str, value: float, error: float, words: str) -> None:
    assert value_to_enter(Parameter(name, "N m", value, error)) == words


def test_numbers_of_the_strip_and_the_waterfall_are_the_verdicts(found: MotionDiagnosis) -> None:
    steps = relative_steps(MotionSubject(found, "motions.csv"))
    assert steps[0][1] == pytest.approx(100 * found.verdict.held_out.stated)
    assert steps[-1][1] == pytest.approx(100 * found.verdict.waterfall[-1].held_out)


def test_departures_carry_their_sign_and_scanned_numbers_do_not() -> None:
    assert signed(Parameter("coulomb", "N m", 3.0, 0.1), {}).value.startswith("+3.0")
    assert signed(Parameter("coulomb", "N m", -3.0, 0.1), {}).value.startswith(("-3.0", "−3.0"))
    assert signed(Parameter("per_turn", "", 4.0, float("nan")), {}).value[0] == "4"


def test_numbers_of_a_curve_without_a_law_are_no_readings(found: MotionDiagnosis) -> None:
    """ "Over way 3: +0.0024 N m" is nothing that anybody can act on."""
    ways = tuple(Parameter(f"over way {n}", "N m", 0.01 * n, 1e-3) for n in (1, 2, 3))
    unknown = replace(found.verdict.effects[0], effect="unknown", family="unknown", parameters=ways)
    assert motion_card(unknown, 1).readings == ()
    assert motion_card(unknown, 1).figure == "curve_1", "its card was empty beside the cure"
    offset = replace(unknown, effect="torque_offset", family="drive", parameters=(replace(ways[0], name="offset"),))
    assert motion_card(offset, 1).readings


def test_a_curves_card_holds_its_picture(found: MotionDiagnosis, tmp_path: Path) -> None:
    effects = found.verdict.effects
    number, cable = next((n, c) for n, c in enumerate(effects, start=1) if c.effect == "cable_torque")
    assert motion_card(cable, number).figure == f"curve_{number}"
    sections = write_sections(MOTION_SECTIONS[1:2], MotionSubject(found, "motions.csv"), "motion", tmp_path)
    assert [path.name for path in (tmp_path / "figures").iterdir()] == [f"curve_{number}.svg"]
    assert "what joint 1 does over the joint angle" in sections[0].html


def test_the_atlas_frames_what_was_named(found: MotionDiagnosis) -> None:
    section = next(each for each in MOTION_SECTIONS if each.name == "atlas")
    shown = section.context(MotionSubject(found, "motions.csv"))["map"]
    framed = {
        (place, driver)
        for place, before, _ in shown.rows
        for driver, cell in zip(shown.drivers, before, strict=True)
        if cell.named
    }
    assert ("joint 1", "joint angle") in framed
    assert framed == {(cause.joint, cause.driver) for cause in found.verdict.effects}


def test_the_shown_piece_has_no_gap(found: MotionDiagnosis) -> None:
    part, piece = liveliest_piece(found.held, 50)
    assert piece.stop - piece.start == 50
    assert len(set(part.rows.stretch[part.which][piece].tolist())) == 1
    assert len(list(arm_of_motion(MotionSubject(found, "")))) == 1
