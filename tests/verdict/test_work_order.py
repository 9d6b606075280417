"""A work order done to the letter must leave what it says: its numbers are read from its words and put to work."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.fitting.registration import fit_frames
from armscope.physics.effect import Part
from armscope.physics.freeform import UNKNOWN
from armscope.physics.registry import EFFECTS
from armscope.physics.scene import Scene
from armscope.physics.soft_start import hardening
from armscope.report.pages.diagnosis import write_report
from armscope.report.sections import locations
from armscope.report.sections import work_order as section
from armscope.robot.arm import build_arm
from armscope.verdict.contributions import contributions
from armscope.verdict.corrections import as_entered, corrected_rows, zero_offsets
from armscope.verdict.effects import Alternative, Cause, Parameter
from armscope.verdict.entries import angle, length
from armscope.verdict.family_cures import cure_of_family
from armscope.verdict.filenames import FILES
from armscope.verdict.files import write_verdict
from armscope.verdict.importance import expected
from armscope.verdict.schema import HeldOut
from armscope.verdict.tasks import task_of
from armscope.verdict.work_order import work_order
from tests.physics.test_cure import World
from tests.report import verdicts
from tests.robot.test_urdf import build as build_urdf
from tests.verdict.test_contributions import missed, verdict, world  # noqa: F401  (fixtures)


def test_every_effect_has_a_change() -> None:
    silent = [effect.name for effect in EFFECTS if not (effect.cure.change and effect.cure.instruction)]
    assert not silent


def test_an_angle_has_its_sign_in_degrees_and_in_mrad() -> None:
    assert angle(-1e-3) == "−0.0573° (−1.000 mrad)"
    assert angle(0.0) == "0.0000° (0.000 mrad)"


def test_what_is_entered_has_its_interval_and_no_digit_that_means_nothing() -> None:
    assert angle(-3.1034e-3, 2e-4) == "−0.178° (−3.10 mrad ± 0.39)"
    assert angle(-3.1034e-3, 5e-7) == "−0.1778° (−3.103 mrad ± 0.001)"
    assert length(0.5951, 0.009) == "+0.595 mm (± 0.018)"
    # known only together with another: what all of them do must survive the rounding of each, to 0.01 mm
    assert length(-0.1152, 1.7) == "−0.12 mm (± 3.33)"


def degrees(words: str) -> list[float]:
    return [float(number.replace("−", "-")) for number in re.findall(r"([+−][0-9.]+)°", words)]


def test_a_zero_set_as_worded_takes_its_error_away(world: World, verdict) -> None:  # noqa: F811
    worth = contributions(verdict)
    (task,) = [task for task in work_order(verdict, worth).tasks if task.change == "mastering"]
    assert task.place == "joint 3"
    (stands_at,) = degrees(task.instruction)
    # a controller that shows 0 there will show what the joint stands at: the same command then turns it less
    commanded = world.session.commanded.copy()
    commanded[:, 2] -= np.radians(stands_at)
    left = missed(world, world.readings(commanded))
    assert left == pytest.approx(task.alone_mm, rel=0.05, abs=2e-3)
    named = zero_offsets(verdict).set_index("joint")["actual_minus_commanded_deg"]
    assert named["joint 3"] == pytest.approx(stands_at, abs=1e-4)
    entered = as_entered(zero_offsets(verdict)).set_index("joint").loc["joint 3"]
    assert entered["actual_minus_commanded_deg"] == stands_at
    assert f"{entered['actual_minus_commanded_mrad']:+} mrad".replace("-", "−") in task.instruction


def test_a_corrected_row_in_the_controllers_model_explains_what_is_predicted(world: World, verdict) -> None:  # noqa: F811
    rows, worth = corrected_rows(verdict), contributions(verdict)
    assert rows is not None
    (task,) = [task for task in work_order(verdict, worth).tasks if task.change == "D-H row"]
    content = world.arm.description.model_dump()
    for stated, row in zip(content["dh"]["joints"], rows.to_dict("records"), strict=True):
        for name in ("a_mm", "alpha_deg", "d_mm", "theta_offset_deg"):
            assert row[f"stated_{name}"] == stated[name]
            stated[name] = row[f"corrected_{name}"]
    corrected = build_arm(type(world.arm.description).model_validate(content))
    table = world.table()
    fitted = fit_frames(corrected, table)
    error = fitted.to_base(table.positions, table.run) - fitted.posture(fitted.scene(table)).tool
    assert 1e3 * np.sqrt(np.mean(error**2)) == pytest.approx(task.alone_mm, rel=0.05, abs=2e-3)


def test_expectations_fall_from_task_to_task_and_stand_on_the_page(verdict, tmp_path: Path) -> None:  # noqa: F811
    done = work_order(verdict, contributions(verdict)).tasks
    then = [task.then_mm for task in done]
    assert then == sorted(then, reverse=True)
    assert then[0] == pytest.approx(done[0].alone_mm)
    assert then[-1] < 0.1 * verdict.residual_before_mm
    page = write_report(verdict, tmp_path).with_name("work-order.html").read_text()
    assert all(task.confirm in page for task in done)
    assert all(f"{task.alone_mm:.3g}" in page for task in done)


def test_files_of_a_verdict_are_those_that_are_asked_for_before(verdict, tmp_path: Path) -> None:  # noqa: F811
    write_verdict(verdict, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} <= set(FILES)


def test_steps_that_pay_less_unfold_and_go_on_counting(monkeypatch, verdict, tmp_path: Path) -> None:  # noqa: F811
    monkeypatch.setattr(section, "SHOWN", 1)
    done = work_order(verdict, contributions(verdict)).tasks
    assert len(done) > 2
    page = write_report(verdict, tmp_path).read_text()
    assert f"{len(done) - 1} further steps" in page
    assert f"expected RMS after 1 to {len(done)}" in page
    assert page.count('<div class="task">') == len(done)


def test_a_gear_that_turns_too_far_has_fewer_motor_turns_per_joint_turn() -> None:
    ratio = verdicts.found("gear_ratio", "joint 2", Parameter("ratio", "rad/rad", 2e-3, 1e-5))
    case = verdicts.case(effects=(ratio,))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    assert "0.998004" in task_of(model.scene(case.recordings), cause, ratio).instruction


@pytest.mark.parametrize(("size", "put"), [(4.07e-3, "Put −4.070 mrad per rad"), (-4.07e-3, "Put 4.070 mrad per rad")])
def test_a_coupling_says_what_is_put_into_the_table_with_its_sign_and_once(size: float, put: str) -> None:
    coupled = verdicts.found("joint_coupling", "joint 6 from joint 5", Parameter("coupling", "rad/rad", size, 1e-5))
    case = verdicts.case(effects=(coupled,))
    task = task_of(case.verdict.model.scene(case.recordings), contributions(case.verdict).causes[0], coupled)
    assert put in task.instruction
    assert "table" not in task.cure
    assert "commanded = wanted - coupling x other" in task.cure


def test_causes_that_work_against_each_other_are_commanded_away_together() -> None:
    """Each alone would make it worse; together they are all of the error."""
    against = [verdicts.found("joint_offset", f"joint {n}", Parameter("offset", "rad", 1e-3, 1e-5)) for n in (2, 3)]
    case = verdicts.case(effects=tuple(against))
    worth = contributions(case.verdict)
    large, error = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    first, second = worth.causes
    moved = (replace(first, moved=large), replace(second, moved=0.2 * error - large))
    worth = replace(worth, causes=moved, small={}, left=0.02 * worth.left)
    order = work_order(case.verdict, worth)
    assert [task.change for task in order.tasks] == ["corrected commands"]
    assert "joint 2" in order.tasks[0].instruction
    assert "joint 3" in order.tasks[0].instruction
    assert order.tasks[0].then_mm == pytest.approx(rms(worth.left))
    assert not order.besides


def test_what_pays_only_after_the_others_is_told_so_and_comes_after_them() -> None:
    """A cause that hides part of another: alone its cure makes the error larger."""
    two = [verdicts.found("joint_offset", f"joint {n}", Parameter("offset", "rad", 1e-3, 1e-5)) for n in (2, 3)]
    case = verdicts.case(effects=tuple(two))
    worth = contributions(case.verdict)
    large, first, second = np.random.default_rng(0).normal(0, 1, worth.left.shape), *worth.causes
    moved = (replace(first, moved=-0.3 * large), replace(second, moved=large))
    worth = replace(worth, causes=moved, smaller=None, small={}, left=0.02 * worth.left)
    done = work_order(case.verdict, worth).tasks
    assert [task.place for task in done] == ["joint 3", "joint 2"]
    assert [task.only_after for task in done] == [False, True]
    assert done[1].alone_mm > rms(worth.before) > done[0].then_mm > done[1].then_mm


def test_expectations_are_those_of_rows_that_took_no_part(verdict) -> None:  # noqa: F811
    worth = contributions(verdict)
    before, left = rms(worth.before), rms(worth.left)
    assert expected(verdict, worth, 0.2) == 0.2, "nothing was held out"
    held = replace(verdict, held_out=HeldOut(1.1 * before, 2 * left))
    assert expected(held, worth, before) == pytest.approx(1.1 * before)
    assert expected(held, worth, left) == pytest.approx(2 * left)
    between = [expected(held, worth, mm) for mm in np.linspace(left, before, 9)]
    assert between == sorted(between)


def test_a_cause_that_is_not_settled_is_settled_first() -> None:
    bends = verdicts.found("link_bending", "link 7", Parameter("bending", "rad/(N m)", 2e-6, 1e-7))
    vague = replace(bends, named_as="family", title="link bending at link 7 or payload")
    done = {}
    for effect in (bends, vague):
        case = verdicts.case(effects=(effect,))
        model, (cause,) = case.verdict.model, contributions(case.verdict).causes
        done[effect.named_as] = task_of(model.scene(case.recordings), cause, effect).instruction
    assert done["effect"].startswith("Put the bending of link 7")
    assert done["family"].startswith("First find out which it is: link bending at link 7 or payload. If")
    assert done["family"].endswith(done["effect"])


def test_what_a_vague_cause_could_be_is_told_by_its_rivals() -> None:
    """ "Geometric, around joint 5, joint 6" is nothing that one finds out."""
    vague = verdicts.compliance("joint 2", named_as="region", title="elastic, around joint 2, base")
    case = verdicts.case(effects=(vague,))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    told = task_of(model.scene(case.recordings), cause, vague, asked=True).instruction
    rivals = "joint compliance at joint 2, base compliance or link bending at link 2"
    assert told.startswith(f"First find out which it is: {rivals} (measure the poses in next_poses.csv). If")


def test_what_scatters_is_looked_for_and_not_corrected_by_a_curve_that_it_lacks() -> None:
    case = verdicts.case(effects=(verdicts.compliance("joint 2"),))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    loose = replace(
        cause.effects[0],
        effect="unknown",
        cure="Find what the scatter follows.",
        parameters=(Parameter("scatter", "rad", 1e-4, 1e-5),),
    )
    task = task_of(model.scene(case.recordings), cause, loose)
    assert (task.change, task.cure) == ("", "Find what the scatter follows.")
    assert "curve" not in task.instruction


def test_a_task_says_nothing_twice() -> None:
    """Of the cure's words stands beside an instruction what it does not say itself."""
    for effect in EFFECTS:
        said, rule = effect.cure.instruction.lower(), effect.cure.rule.lower()
        assert not (said and effect.cure.words.split(".")[0].lower() in rule and " or " in effect.cure.words[:90]), rule
    case = verdicts.case(effects=(verdicts.compliance("joint 2"),))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    task = task_of(model.scene(case.recordings), cause, cause.effects[0])
    assert "elastic model" in task.instruction
    assert task.cure.startswith("Or compensate for it in the command: commanded = wanted - compliance x load")


def test_the_formula_of_a_rule_has_its_numbers_behind_it() -> None:
    """Who stores a wave needs where it is largest, too; the number of waves has no unit in a formula."""
    wave = verdicts.found(
        "gear_eccentricity", "joint 2", Parameter("amplitude", "rad", 6e-4, 1e-6),
        Parameter("phase", "rad", -0.7, 2e-3), Parameter("per_turn", "1/turn", 2.0, 0.0),
    )  # fmt: skip
    case = verdicts.case(effects=(wave,))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    rule = task_of(model.scene(case.recordings), cause, wave).cure
    formula, _, numbers = rule.partition("commanded = wanted - ")[2].partition(". Here ")
    assert formula == "amplitude x cos(per_turn x wanted - phase)"
    assert numbers == "amplitude = +0.0344° (+0.600 mrad ± 0.002), per_turn = 2, phase = −40.11°."


def test_how_far_something_jumped_has_its_interval() -> None:
    """Seen on a real arm: a zero that jumped by −2.6598° (−46.422 mrad), known to ± 4.6 mrad."""
    slipped = verdicts.found(
        "zero_shift", "joint 2", Parameter("jump", "rad", -46.42e-3, 2.37e-3), Parameter("row", "1", 14.0, 0.0)
    )
    moved = verdicts.found(
        "tool_shift", "tool", Parameter("x", "mm", -1.4891, 0.17), Parameter("row", "1", 86.0, 0.0)
    )  # fmt: skip
    for effect, told in ((slipped, "jumped by −2.660° (−46.42 mrad ± 4.65)"), (moved, "jumped by x −1.49 mm (± 0.33)")):
        case = verdicts.case(effects=(effect,))
        model, (cause,) = case.verdict.model, contributions(case.verdict).causes
        assert told in task_of(model.scene(case.recordings), cause, effect).instruction


def test_a_compliance_without_masses_has_no_number_to_enter_and_says_who_has_it() -> None:
    products = [Parameter(f"compliance_times_moment_{n}", "rad/(m/s^2)", 1e-5, 1e-6) for n in (1, 2)]
    soft = verdicts.found("joint_compliance", "joint 2", *products)
    case = verdicts.case(effects=(verdicts.compliance("joint 2"),))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    assert "armscope compensate" in task_of(model.scene(case.recordings), cause, soft).cure
    assert "armscope compensate" not in task_of(model.scene(case.recordings), cause, cause.effects[0]).cure


def test_a_urdf_is_corrected_at_the_joint_that_its_file_names() -> None:
    longer = verdicts.found("link_geometry", "link 3", Parameter("tx", "mm", 0.7, 0.01))
    case = verdicts.case(effects=(verdicts.compliance("joint 2"),))
    (cause,) = contributions(case.verdict).causes
    arm = build_urdf()
    table = replace(case.recordings, motor_angles=case.recordings.motor_angles[:, : arm.n_motors])
    task = task_of(Scene(arm, table), replace(cause, parts=()), longer)
    assert task.change == "joint origin"
    assert f"joint {arm.joint_names[2]}'s origin" in task.instruction
    assert '<origin xyz="' in task.instruction


def test_the_card_and_the_work_order_say_the_same_of_every_effect() -> None:
    """Beside its instruction a work order has the end of the card's sentence, never words of its own."""
    for effect in (*EFFECTS, hardening(12.345)):
        cure = effect.cure
        assert cure.words.lower().endswith(cure.rule.lower())
        assert cure.words == f"{cure.mend} {cure.otherwise}".strip()
        assert bool(cure.otherwise) == (cure.rule != cure.words), "what else can be done stands alone, all else whole"
        if cure.otherwise:  # one sentence with "or", or two
            assert cure.otherwise.startswith("or ") == (cure.mend[-1] in ",;")
            assert cure.otherwise.startswith("or ") or cure.mend.endswith(".")


def test_a_minor_effect_that_pays_once_all_else_is_cured_is_a_task() -> None:
    """What hides part of another is minor, and its cure may still be most of what is left in its turn."""
    size = Parameter("offset", "rad", 1e-3, 1e-5)
    hidden = verdicts.found("joint_offset", "joint 2", size, minor=True)
    case = verdicts.case(effects=(verdicts.found("joint_offset", "joint 3", size), hidden))
    worth = contributions(case.verdict)
    single = replace(worth.causes[0], effects=(hidden,))
    large, noise = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    moved = {"causes": (replace(worth.causes[0], moved=large),), "small": {}, "left": 0.02 * noise}
    tasks = {}
    for size in (-0.3, -1e-3):
        one = replace(single, moved=size * large)
        tasks[size] = work_order(case.verdict, replace(worth, smaller=one, single=(one,), **moved)).tasks
    assert [(task.place, task.only_after) for task in tasks[-0.3]] == [("joint 3", False), ("joint 2", True)]
    assert [task.place for task in tasks[-1e-3]] == ["joint 3"]


def test_what_moved_over_the_time_of_a_session_is_fastened_not_corrected_by_a_curve() -> None:
    """No later session has these times: a command corrected by them would carry one day's accident to every other."""
    case = verdicts.case(effects=(verdicts.found("unknown", "joint 3", driver="time"),))
    (cause,) = contributions(case.verdict).causes
    table = replace(case.recordings, time=np.linspace(0, 7200, len(case.recordings)))
    curves = {(p.location, p.variant): p for p in UNKNOWN.place(case.arm, table)}
    for variant, corrects in (("time", False), ("angle", True)):
        placed = curves["joint 3", variant]
        part = Part(placed, np.full(len(placed.terms), 1e-4))
        task = task_of(Scene(case.arm, table), replace(cause, parts=(part,)), cause.effects[0])
        assert re.search(r"by −[\d.]+ … \+[\d.]+ mrad", task.motion), "about its mean, which a zero takes up"
        assert (placed.effect.cure.commanded is not None) == corrects
        assert ("commanded = wanted - curve" in task.cure) == corrects
        assert ("correction table" in task.instruction) == corrects
        assert ("fasten it" in task.instruction) != corrects
    pair = [verdicts.found("unknown", place, driver="time") for place in ("joint 3", "joint 4")]
    assert "corrects nothing later" in cure_of_family("unknown", pair, everywhere=False)
    assert "later" not in cure_of_family("unknown", [replace(e, driver="angle of joint 3") for e in pair], False)


def test_commands_by_the_whole_model_stand_in_place_of_the_other_steps() -> None:
    """A zero that is set anew and then commanded away, too, is off by as much again: seen where orders were obeyed."""
    case = verdicts.case(effects=(verdicts.found("joint_offset", "joint 3", Parameter("offset", "rad", 1e-3, 1e-5)),))
    worth = contributions(case.verdict)
    moved, rest = np.random.default_rng(0).normal(0, 1, (2, *worth.left.shape))
    worth = replace(worth, causes=(replace(worth.causes[0], moved=3 * moved),), small={}, left=0.02 * rest)
    one = work_order(case.verdict, worth)
    assert [task.instead for task in one.tasks] == [False]
    assert not one.caution, "nothing stands beside it"
    both = work_order(case.verdict, replace(worth, smaller=replace(worth.causes[0], moved=rest)))
    assert [task.instead for task in both.tasks] == [False, True]
    assert both.tasks[1].instruction.startswith("In place of the steps above, compensate")
    assert "never on top" in both.caution


def test_a_cause_in_doubt_names_no_part_to_change_and_says_how_each_reading_shows_itself() -> None:
    """An engineer must not take a bearing out because of the best of three readings."""
    size = [Parameter("amplitude", "rad", 6e-3, 1e-3), Parameter("phase", "rad", 0.3, 0.1)]
    rivals = (
        Alternative("link_geometry", "link 6", "geometric", 1.5, "constant", 1.5),
        Alternative("joint_offset", "joint 6", "geometric", 2.0, "constant", 2.0),
    )
    vague = verdicts.found(
        "axis_wobble", "joint 5", *size,
        named_as="region", title="geometric, around joints 5 and 6", alternatives=rivals,
    )  # fmt: skip
    case = verdicts.case(effects=(vague,))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    task = task_of(model.scene(case.recordings), cause, vague)
    assert (task.what, task.place, task.change, task.motion) == (
        "The geometry differs from what was stated around joints 5 and 6", "around joints 5 and 6", "to be settled", "",
    )  # fmt: skip
    before, _, after = task.instruction.partition("If the axis of joint 5 tilts")
    assert "bearing" not in before
    assert "bearing" in after
    assert "whichever it is" in task.cure


def test_minor_curves_that_the_headline_tells_together_are_one_step() -> None:
    """21 % of a real arm's error stood in its headline and in no step of its work order."""
    zero = verdicts.found("joint_offset", "joint 2", Parameter("offset", "rad", 1e-3, 1e-5))
    curves = [verdicts.unknown_curve(f"joint {n}", minor=True) for n in (3, 5)]
    case = verdicts.case(effects=(zero, *curves))
    worth = contributions(case.verdict)
    large, some, noise = np.random.default_rng(0).normal(0, 1, (3, *worth.left.shape))
    single = tuple(replace(worth.causes[0], effects=(each,), moved=0.25 * some) for each in curves)
    worth = replace(
        worth, causes=(replace(worth.causes[0], moved=large),), small={}, left=0.02 * noise,
        smaller=replace(single[0], moved=0.5 * some), single=single,
    )  # fmt: skip
    told = Cause(
        "unknown", "family", "arm", tuple(each.as_member for each in curves), False, True, 0.2, 0.01,
        "something unexplained at joint 3 (also: joint 5)", cure_of_family("unknown", curves, everywhere=False),
    )  # fmt: skip
    tasks = work_order(replace(case.verdict, causes=(told,)), worth).tasks
    assert [task.place for task in tasks] == ["joint 2", "joints 3 and 5"]
    assert "commanded = wanted - curve" in tasks[1].instruction
    assert tasks[1].then_mm == pytest.approx(rms(worth.left))
    ranking = locations._ranking(replace(case.verdict, causes=(told,)))
    assert "Unexplained curves at joints 3 and 5" in [place.name for place in ranking]
    assert not [place for place in ranking if "minor effect" in place.name], "nothing stands twice"
    untold = work_order(replace(case.verdict, causes=(replace(told, share=0.01),)), worth).tasks
    assert "joints 3 and 5" not in [task.place for task in untold]
