"""The words of one step: what to change, by how much, and what else could be done."""

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.freeform import UNKNOWN
from armscope.physics.geometric import LINK_GEOMETRY
from armscope.physics.registry import EFFECTS
from armscope.physics.scene import Scene
from armscope.physics.soft_start import hardening
from armscope.physics.thermal import THERMAL_EXPANSION
from armscope.physics.transmission import BACKLASH
from armscope.verdict.contributions import Repair, contributions
from armscope.verdict.effects import Alternative, Parameter
from armscope.verdict.family_cures import cure_of_family
from armscope.verdict.tasks import Task, task_of
from tests.report import verdicts
from tests.robot.test_urdf import build as build_urdf


def test_every_effect_has_a_change() -> None:
    silent = [effect.name for effect in EFFECTS if not (effect.cure.change and effect.cure.instruction)]
    assert not silent


def test_a_gear_that_turns_too_far_has_fewer_motor_turns_per_joint_turn() -> None:
    ratio = verdicts.found("gear_ratio", "joint 2", Parameter("ratio", "rad/rad", 2e-3, 1e-5))
    case = verdicts.case(effects=(ratio,))
    model, (cause,) = case.verdict.model, contributions(case.verdict).causes
    assert "0.998004" in task_of(model.scene(case.recordings), cause, ratio).instruction


@pytest.mark.parametrize(("size", "put"), [(4.07e-3, "Add −4.070 mrad per rad"), (-4.07e-3, "Add 4.070 mrad per rad")])
def test_a_coupling_says_what_is_put_into_the_table_with_its_sign_and_once(size: float, put: str) -> None:
    coupled = verdicts.found("joint_coupling", "joint 6 from joint 5", Parameter("coupling", "rad/rad", size, 1e-5))
    case = verdicts.case(effects=(coupled,))
    task = task_of(case.verdict.model.scene(case.recordings), contributions(case.verdict).causes[0], coupled)
    assert put in task.instruction
    assert "table" not in task.cure
    assert "commanded = wanted - coupling x other" in task.cure


def test_play_that_leads_its_command_is_a_sign_to_be_turned_and_no_gear_to_be_adjusted() -> None:
    """Seen twice: "-497 urad of play. Adjust the gear", where the column's sign was wrong."""
    play = verdicts.found(
        "backlash", "joint 2", Parameter("gap", "rad", -5e-4, 1e-5), driver="side of approach of joint 2"
    )
    case = verdicts.case(effects=(play,))
    table = replace(case.recordings, approach=np.sign(case.recordings.motor_angles))
    scene = case.verdict.model.scene(table)
    placed = next(p for p in BACKLASH.place(scene.arm, scene.recordings) if p.key == ("backlash", "joint 2"))
    cause = Repair("play", (play,), (Part(placed, np.array([-5e-4])),), np.zeros((1, 3)))
    task = task_of(scene, cause, play)
    assert "has 0.50 mrad of play, if its column of approach has the wrong sign" in task.what
    assert task.instruction.startswith("Turn the sign of joint 2's approach column")
    assert "commanded = wanted - approach x gap / 2" in task.cure
    assert task.needs.startswith("once the play is adjusted or commanded away")
    right = replace(cause, parts=(Part(placed, np.array([5e-4])),))
    told = task_of(scene, right, replace(play, parameters=(Parameter("gap", "rad", 5e-4, 1e-5),)))
    assert told.what == "Joint 2 has 0.50 mrad of play"
    assert "commanded = wanted + approach x gap / 2" in told.cure
    assert "gravity" not in told.cure
    assert not told.needs


def test_a_correction_is_no_error_said_with_the_same_verb() -> None:
    """What a joint does stood in the rows, what is to be done about it in the step, both as "joint 2 turns by"."""
    case, told = verdicts.case(effects=(verdicts.compliance("joint 2"),)), []
    scene = case.verdict.model.scene(case.recordings)
    placed = next(p for p in JOINT_COMPLIANCE.place(scene.arm, scene.recordings) if p.location == "joint 2")
    for value in (2e-6, -2e-6):
        part = Part(placed, np.array([value]))
        task = task_of(scene, Repair("gives", case.verdict.effects, (part,), np.zeros((1, 3))), case.verdict.effects[0])
        assert "or correct the command of joint 2 by " in task.instruction
        assert "turns by" not in task.instruction
        low = task.instruction.partition("command of joint 2 by ")[2][0]
        told.append((low, float(np.sign(scene.amounts((part,))[placed.terms[0].products[0].direction].max()))))
    assert ("−", 1.0) in told


@pytest.mark.parametrize("robot", ["../../examples/seven-axes-modified-dh/robot", "six-axis"])
def test_a_link_moves_by_the_number_that_its_name_has(robot: str) -> None:
    """Of a modified row, a and alpha act in the frame of the row before: "link 5: ... link 4 along x moves"."""
    case = verdicts.case(robot, effects=(verdicts.compliance("joint 2"),))
    scene = case.verdict.model.scene(replace(case.recordings, temperature=np.linspace(10, 30, len(case.recordings))))
    for effect in (LINK_GEOMETRY, THERMAL_EXPANSION):
        placed = next(p for p in effect.place(scene.arm, scene.recordings) if p.location == "link 3")
        values = tuple(Parameter(t.name, t.unit, 1e-5, 1e-7) for t in placed.terms)
        found = verdicts.found(effect.name, "link 3", *values)
        part = Part(placed, np.full(len(placed.terms), 1e-5))
        task = task_of(scene, Repair("link", (found,), (part,), np.zeros((1, 3))), found)
        assert "link 2" not in task.motion
        assert "joint 3" not in task.motion
        assert task.motion.startswith("link 3 along") == (effect is THERMAL_EXPANSION)


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
    assert task.cure.startswith("commanded = wanted - compliance x load")
    for name in ("joint_compliance", "gear_eccentricity"):
        rule = next(effect.cure.rule for effect in EFFECTS if effect.name == name)
        assert not rule.startswith("Or ")


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
    assert numbers == "amplitude = +0.0344° (+0.600 mrad ± 0.002), per_turn = 2, phase = −40.11° (± 0.22)."


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
    # a payload gives the compliance itself, and the load is still one of masses that nobody stated
    told = replace(cause.effects[0], parameters=(*products, *cause.effects[0].parameters))
    arm = replace(case.arm, masses=np.zeros_like(case.arm.masses))
    table = replace(case.recordings, payload=np.linspace(0, 6, len(case.recordings)))
    (placed, *_) = [p for p in JOINT_COMPLIANCE.place(arm, table) if p.location == "joint 2"]
    part = Part(placed, np.full(len(placed.terms), 1e-7))
    assert "No masses are stated" in task_of(Scene(arm, table), replace(cause, parts=(part,)), told).cure


def test_a_urdf_is_corrected_at_the_joint_that_its_file_names() -> None:
    longer = verdicts.found("link_geometry", "link 3", Parameter("tx", "mm", 0.7, 0.01))
    case = verdicts.case(effects=(verdicts.compliance("joint 2"),))
    (cause,) = contributions(case.verdict).causes
    arm = build_urdf()
    table = replace(case.recordings, motor_angles=case.recordings.motor_angles[:, : arm.n_motors])
    task = task_of(Scene(arm, table), replace(cause, parts=()), longer)
    assert task.change == "joint origin"
    assert f"Correct link 3, joint {arm.joint_names[2]}'s origin, in the controller's model" in task.instruction
    assert '<origin xyz="' in task.instruction
    assert "along its parent link's axes; what is told along x, y and z is along the joint's own" in task.instruction


def test_a_heading_says_a_place_once() -> None:
    told = Task("", "payload", "payload data", "", "", "", "")
    assert told.headed(", ") == "Payload data"
    assert replace(told, place="instrument", change="instrument").headed(", ") == "Instrument"
    assert replace(told, place="joint 2", change="mastering").headed(": ") == "Joint 2: mastering"
    assert replace(told, place="whole arm", change="").headed(": ") == "Whole arm"


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


def test_growth_and_compliances_have_their_numbers_and_intervals_behind_their_formulas() -> None:
    """ "length = stated length x (1 + coefficient x ...)" stood without the coefficient."""
    told = {}
    for effect, place, parameter in (
        ("thermal_expansion", "link 3", Parameter("coefficient", "1/K", 61e-6, 1.2e-6)),
        ("joint_compliance", "joint 2", Parameter("compliance", "rad/(N m)", 6.18e-6, 4e-8)),
        ("payload_error", "payload", Parameter("mass", "kg", 2.43, 0.05)),
        ("payload_error", "payload", Parameter("com_z", "mm", 122.0, 8.0)),
    ):
        found = verdicts.found(effect, place, parameter)
        case = verdicts.case(effects=(found,))
        model, (cause,) = case.verdict.model, contributions(case.verdict).causes
        told[parameter.name] = task_of(model.scene(case.recordings), cause, found).cure.partition(" Here ")[2]
    assert told == {
        "coefficient": "coefficient = 61.0 millionths per K (± 2.4).",
        "compliance": "compliance = 6.180 µrad per N m (± 0.078).",
        "mass": "mass = 2.430 kg (± 0.098).",
        "com_z": "com z = 122.0 mm (± 15.7).",
    }
