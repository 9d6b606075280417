"""Numbers to enter in a controller's model: an arm built from them stands where the diagnosed one does."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml

from armscope.core.types import Array
from armscope.physics.effect import AXES
from armscope.physics.geometric import row_terms
from armscope.physics.registry import effect_named
from armscope.report.pages.diagnosis import write_work_order
from armscope.report.sectioning import Subject
from armscope.robot.arm import Arm, build_arm
from armscope.robot.kinematics import forward_kinematics
from armscope.robot.library import nominal_description
from armscope.verdict.contributions import contributions
from armscope.verdict.corrections import (
    ALL_OF_THEM,
    NOT_SURE,
    bars_set_right,
    corrected_origins,
    corrected_rows,
    corrected_table,
    corrected_ur_kinematics,
    unsettled,
    zero_offsets,
)
from armscope.verdict.diagnosis import NextPoses
from armscope.verdict.effects import FoundEffect, Parameter
from armscope.verdict.tasks import task_of
from tests.report import verdicts
from tests.report.verdicts import found
from tests.robot.test_controllers import tool_of, ur5e
from tests.robot.test_urdf import TORSO_ARM, build

ERRORS = {"tx": 0.7e-3, "ty": -0.2e-3, "tz": 0.4e-3, "rx": 6e-4, "ry": -9e-4, "rz": 7e-4}


def saying(arm: Arm, *effects: FoundEffect) -> Any:
    """As much of a verdict as corrections ask for."""
    return SimpleNamespace(model=SimpleNamespace(arm=arm), effects=effects, next_poses=None)


def another_shape(joint: int, errors: dict[str, float]) -> FoundEffect:
    """A link whose place in a URDF is off; errors in m and rad."""
    told = (
        Parameter(name, "mm" if name[0] == "t" else "rad", value * (1e3 if name[0] == "t" else 1), 1e-6)
        for name, value in errors.items()
    )
    return found("link_geometry", f"link {joint}", *told)


@pytest.mark.parametrize("joint", [1, 2, 3, 4, 5, 6])
def test_a_urdf_with_the_corrected_origin_stands_where_the_link_of_another_shape_does(joint: int, tmp_path) -> None:
    arm = build()
    angles = np.random.default_rng(joint).uniform(-1.5, 1.5, (20, arm.n_motors))
    terms = row_terms(arm, joint)
    errors = {name: ERRORS[name] for name in terms}  # all but the turn about the joint's own axis
    twist = np.zeros(6)
    for name, each in terms.items():
        for product in each.products:
            twist[AXES.index(product.direction.axis)] += product.factor * errors[name]
    off = forward_kinematics(arm, angles, {f"joint {joint}": twist})
    table = corrected_origins(saying(arm, another_shape(joint, errors)))
    assert table is not None
    assert table["changed"].tolist() == [j == joint for j in range(1, arm.n_joints + 1)]
    tree = ElementTree.parse(TORSO_ARM)
    for row in table.to_dict("records"):
        (element,) = [each for each in tree.getroot().findall("joint") if each.get("name") == row["joint"]]
        origin = element.find("origin")
        origin = ElementTree.SubElement(element, "origin") if origin is None else origin
        origin.set("xyz", " ".join(repr(row[f"corrected_{axis}_m"]) for axis in "xyz"))
        origin.set("rpy", " ".join(repr(row[f"corrected_{axis}_rad"]) for axis in ("roll", "pitch", "yaw")))
    tree.write(tmp_path / "corrected.urdf")
    mended = forward_kinematics(build(tmp_path / "corrected.urdf"), angles)
    np.testing.assert_allclose(mended, off, atol=1e-9)
    assert np.abs(off - forward_kinematics(arm, angles)).max() > 1e-4


def said_by_the_rest(drawn: Arm, built: Arm, angles: Array) -> bool:
    """Whether zeros of joints 1 and 2 and the other directions of joint 2 together move an arm to where another is."""
    step, stands = 1e-6, forward_kinematics(drawn, angles)
    moved = [forward_kinematics(drawn, angles + step * unit) for unit in np.eye(drawn.n_motors)[:2]]
    for each in row_terms(drawn, 2).values():
        twist = np.zeros(6)
        for product in each.products:
            twist[AXES.index(product.direction.axis)] += step * product.factor
        moved.append(forward_kinematics(drawn, angles, {"joint 2": twist}))
    columns = np.column_stack([(each - stands).ravel() / step for each in moved])
    wanted = (forward_kinematics(built, angles) - stands).ravel()
    numbers, *_ = np.linalg.lstsq(columns, wanted, rcond=None)
    return bool(np.abs(wanted - columns @ numbers).max() < 1e-2 * np.abs(wanted).max())


@pytest.mark.parametrize("axis", ["1 0 0", "0 1 0", "0 0 1", "0 0 -1", "0 -1 0"])
@pytest.mark.parametrize("shift", ["x", "y", "z"])
def test_a_shift_is_told_along_the_axes_of_the_file(axis: str, shift: str, tmp_path) -> None:
    """A joint that turns about x has no z along its own axis in its file, and nobody knows of ours."""
    file = ElementTree.parse(TORSO_ARM)
    joint = next(each for each in file.getroot().findall("joint") if each.get("name") == build().joint_names[1])
    turning, origin = joint.find("axis"), joint.find("origin")
    assert turning is not None
    assert origin is not None
    turning.set("xyz", axis)
    origin.set("rpy", "0 0 0")
    arms = []
    for name, by in (("as-drawn", 0.0), ("as-built", 1e-3)):
        place = [float(number) for number in origin.get("xyz", "0 0 0").split()]
        place["xyz".index(shift)] += by
        origin.set("xyz", " ".join(map(str, place)))
        file.write(tmp_path / f"{name}.urdf")
        arms.append(build(tmp_path / f"{name}.urdf"))
    drawn, built = arms
    angles = np.random.default_rng(1).uniform(-1.5, 1.5, (5, drawn.n_motors))
    name, terms, twist = f"t{shift}", row_terms(drawn, 2), np.zeros(6)
    if name not in terms:
        assert said_by_the_rest(drawn, built, angles)
        return
    for product in terms[name].products:
        twist[AXES.index(product.direction.axis)] += 1e-3 * product.factor
    told = forward_kinematics(drawn, angles, {"joint 2": twist})
    np.testing.assert_allclose(told, forward_kinematics(built, angles), atol=1e-12)


def test_an_origin_that_hardly_turns_keeps_its_stated_angles() -> None:
    arm = build()
    table = corrected_origins(saying(arm, another_shape(2, {"tx": 1e-3, "rx": 4e-6})))
    assert table is not None
    for axis in ("roll", "pitch", "yaw"):
        np.testing.assert_allclose(table[f"corrected_{axis}_rad"], table[f"stated_{axis}_rad"], atol=1e-15)


def test_what_is_one_reading_of_several_is_not_entered() -> None:
    """Seen: "Until then change nothing for it" above its corrected row and "Enter all of them together"."""
    arm = build_arm(nominal_description("ur5e"))
    link, zero = (
        found("link_geometry", "link 3", Parameter("alpha", "rad", -1e-3, 1e-5), Parameter("a", "mm", 0.5, 0.01)),
        found("joint_offset", "joint 2", Parameter("offset", "rad", 1e-3, 1e-5)),
    )
    for named_as, entered in (("effect", True), ("region", False)):
        told = saying(arm, *(replace(each, named_as=named_as) for each in (link, zero)))
        rows, zeros = corrected_rows(told), zero_offsets(told)
        assert rows is not None
        assert bool(rows.filter(like="correction_").any(axis=None)) == entered
        assert bool(zeros["actual_minus_commanded_mrad"].any()) == entered
        assert zeros["cause"][1] == ("named" if entered else "to be settled")
        assert len(unsettled(told)) == (0 if entered else 2)


def test_a_zero_that_jumped_stands_in_the_table_as_it_is_since_then() -> None:
    """It stood as zero there, beside a step that said "set its zero anew"."""
    jump = found("zero_shift", "joint 2", Parameter("jump", "rad", 1.5e-3, 3e-5))
    before = found("joint_offset", "joint 2", Parameter("offset", "rad", -1e-3, 4e-5))
    for effects, mrad, half in (((jump,), 1.5, 1.96 * 0.03), ((before, jump), 0.5, 1.96 * 0.05)):
        zeros = zero_offsets(saying(build_arm(nominal_description("ur5e")), *effects))
        assert zeros["actual_minus_commanded_mrad"][1] == pytest.approx(mrad)
        assert zeros["half_interval_95_mrad"][1] == pytest.approx(half, rel=0.01)
        assert zeros["cause"].tolist() == ["not named", "named", *["not named"] * 4]


def test_what_the_poses_to_measure_next_ask_about_is_not_entered() -> None:
    """Seen: "One question about a minor effect is open" in the report, and the row of that link among the corrected."""
    link = found("link_geometry", "link 3", Parameter("alpha", "rad", -1e-3, 1e-5), Parameter("a", "mm", 0.5, 0.01))
    told = saying(build_arm(nominal_description("ur5e")), link)
    none = np.empty(0)
    told.next_poses = NextPoses(none, none, none, "link_geometry at link 3", "axis_wobble at joint 3", 131.0)
    rows = corrected_rows(told)
    assert rows is not None
    assert not rows.filter(like="correction_").any(axis=None)
    assert unsettled(told) == [link]
    told.next_poses = replace(told.next_poses, first="link_geometry at link 4")
    assert not unsettled(told)


def test_axes_that_are_skew_have_a_number_of_their_own_among_the_rows_and_other_arms_do_not() -> None:
    arm = build_arm(nominal_description("ur5e"))
    skew = found("link_geometry", "link 2", Parameter("beta", "rad", 8e-4, 1e-5))
    twisted = found("link_geometry", "link 2", Parameter("alpha", "rad", 8e-4, 1e-5))
    rows = corrected_rows(saying(arm, skew))
    assert rows is not None
    assert rows["corrected_beta_deg"].tolist() == pytest.approx([0, np.degrees(8e-4), 0, 0, 0, 0])
    heads, cells = corrected_table(saying(arm, skew))
    assert heads == ["row", "a", "α", "d", "θ offset", "β"]
    assert cells[1][-1] == ("0", "0.0458 ± 0.0011")
    heads, cells = corrected_table(saying(arm, twisted))
    assert heads == ["row", "a", "α", "d", "θ offset"]
    assert [row[2].corrected for row in cells] == ["", "0.0458 ± 0.0011", "", "", "", ""]


def test_an_arm_has_rows_or_origins_never_both() -> None:
    urdf = saying(build())
    rows = saying(build_arm(nominal_description("irb120")))
    assert corrected_rows(urdf) is None
    assert corrected_origins(rows) is None
    assert corrected_rows(rows) is not None


def test_a_nominal_arm_is_not_offered_as_a_corrected_one() -> None:
    """On a real arm it would undo the maker's own calibration."""
    assert corrected_ur_kinematics(saying(ur5e())) is None


def test_zeros_and_rows_that_were_found_have_their_signs_in_the_file() -> None:
    arm = ur5e()
    row = found(
        "link_geometry", "link 2", Parameter("a", "mm", 0.8, 0.01), Parameter("alpha", "rad", 7e-4, 1e-5),
        Parameter("d", "mm", 0.3, 0.01), Parameter("beta", "rad", 5e-4, 1e-5),
    )  # fmt: skip
    zero = found("joint_offset", "joint 4", Parameter("offset", "rad", -3e-3, 1e-5))
    written = corrected_ur_kinematics(saying(arm, row, zero))
    assert written is not None
    content = arm.description.model_dump()
    stated = content["dh"]["joints"][1]
    stated |= {"a_mm": stated["a_mm"] + 0.8, "alpha_deg": np.degrees(7e-4), "d_mm": 0.3, "beta_deg": np.degrees(5e-4)}
    real = build_arm(type(arm.description).model_validate(content))
    for angles in np.random.default_rng(3).uniform(-2, 2, (8, 6)):
        actual = angles + np.array([0, 0, 0, -3e-3, 0, 0])
        np.testing.assert_allclose(tool_of(written, angles), forward_kinematics(real, actual[None])[0], atol=1e-9)
        assert np.linalg.norm(tool_of(written, angles) - forward_kinematics(arm, angles[None])[0]) > 1e-4


def test_who_loads_the_file_is_told_not_to_reset_zeros_as_well(tmp_path: Path) -> None:
    """Both were advised of one arm: 0.71 mm by the zeros alone, 1.25 mm by both, of 1.38."""
    case = verdicts.single()
    model = replace(case.verdict.model, arm=ur5e())
    zero = found("joint_offset", "joint 4", Parameter("offset", "rad", -3e-3, 1e-5))
    verdict = replace(case.verdict, model=model, effects=(*case.verdict.effects, zero))
    tables = write_work_order(Subject(verdict), tmp_path)
    assert tables == ("zero_offsets.csv", "corrected_dh.csv", "ur_kinematics.yaml")
    assert all((tmp_path / name).is_file() for name in tables)
    for name in ("ur_kinematics.yaml", "work-order.html"):
        assert "never as well" in (tmp_path / name).read_text()
    assert set(yaml.safe_load((tmp_path / "ur_kinematics.yaml").read_text())) == {"kinematics"}


ROCKER = Parameter("rocker", "m/m", -2.87e-4, 3e-6)


def test_both_bars_that_are_off_are_changed_together_each_by_minus_its_error() -> None:
    """A rod adjusted alone made an arm worse, 0.19 to 0.20 mm, where 0.04 was promised."""
    told = bars_set_right([Parameter("rod", "m/m", 5.2e-5, 2e-6), ROCKER, Parameter("crank_angle", "deg", 90, 0)])
    assert told.startswith("make the rocker longer by 287 ppm (± 6) of the rocker's length and make the rod shorter by")
    assert told.endswith(ALL_OF_THEM)
    lengths = bars_set_right([Parameter("rod", "mm", 0.2, 0.01), Parameter("rocker", "mm", -0.1, 0.01)])
    assert "make the rod shorter by 0.200 mm (± 0.020)" in lengths


def test_a_bar_within_its_interval_is_left_alone() -> None:
    one = bars_set_right([Parameter("rod", "m/m", 2.4e-6, 2.3e-6), ROCKER])
    assert "leave the rod as it is" in one
    assert ALL_OF_THEM not in one
    assert "ppm" not in one.partition(";")[2]
    assert bars_set_right([Parameter("rod", "mm", 0.1, 0.2), Parameter("rocker", "mm", 0.1, 0.2)]) == NOT_SURE
    assert bars_set_right([]) == "–"


def test_the_work_order_tells_both_bars() -> None:
    effect = verdicts.found("parallelogram_geometry", "parallelogram", Parameter("rod", "m/m", 5.2e-5, 2e-6), ROCKER)
    case = verdicts.case("parallelogram-120kg", (effect,))
    (cause,) = contributions(case.verdict).causes
    task = task_of(case.verdict.model.scene(case.recordings), cause, effect)
    assert "make the rocker longer by 287 ppm" in task.instruction
    assert "make the rod shorter by 52 ppm" in task.instruction
    definition = effect_named("parallelogram_geometry")
    assert definition
    assert "each bar that is off" in definition.cure.words
