import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from armscope.report.colours import SHARES, SIGNED, UNTOUCHED, between, page_variables, scale_end, share_colour
from armscope.report.figures.along_joints import draw_along_joints, running_mean
from armscope.report.figures.arm import location_shares
from armscope.report.figures.arm_picture import draw_arm
from armscope.report.figures.arm_shape import arm_shape, shares_by_place, typical_pose
from armscope.report.figures.atlas import atlas_map
from armscope.report.figures.effect_curve import draw_curves, drawn_curve
from armscope.report.figures.next_poses import draw_poses
from armscope.report.figures.waterfall import draw_waterfall, gathered, waterfall_steps
from armscope.report.svg import Drawing, nice, ticks
from armscope.robot import load_arm
from armscope.verdict.effects import Parameter
from tests.report import verdicts
from tests.report.verdicts import ROBOTS, found

SVG = "{http://www.w3.org/2000/svg}"


def shapes(figure, kind="path"):
    return list(ET.fromstring(figure.svg()).iter(f"{SVG}{kind}"))


def texts(figure):
    return [text.text for text in shapes(figure, "text")]


def points(path):
    return np.array([[float(n) for n in pair.split()] for pair in re.findall(r"-?[0-9.]+ -?[0-9.]+", path.get("d"))])


@pytest.fixture(scope="module")
def arm():
    return load_arm(ROBOTS / "six-axis.yaml")


@pytest.fixture(scope="module")
def angles(arm):
    return np.random.default_rng(3).uniform(-1, 1, (30, arm.n_motors))


def test_the_guilty_joint_has_the_darkest_face_and_says_its_share(arm, angles):
    figure = draw_arm(arm, angles, {"joint 2": 0.6, "link 3": 0.1})
    worst = [path for path in shapes(figure) if path.get("fill") == share_colour(1.0)]
    assert len(worst) == 2, "the side and the face of one disc"
    row, view = typical_pose(arm, angles)
    centres = view.flat(arm_shape(arm, angles[row]).centres) * [1, -1]
    faces = [points(path) for path in shapes(figure) if path.get("stroke-width") == "0.9" and len(points(path)) == 36]
    drawn = np.array([face.mean(axis=0) for face in faces])
    scale = np.ptp(drawn, axis=0).max() / np.ptp(centres, axis=0).max()
    at = points(worst[1]).mean(axis=0) - drawn.mean(axis=0)
    assert np.argmin(np.linalg.norm(scale * (centres - centres.mean(axis=0)) - at, axis=1)) == 1
    assert "J2  60 %" in texts(figure)
    assert "L3  10 %" in texts(figure)
    assert "J4" in texts(figure)


def test_an_arm_without_fault_is_drawn_without_colours_and_without_a_colour_bar(arm, angles):
    figure = draw_arm(arm, angles, {})
    assert not shapes(figure, "rect")
    assert not any("--s" in path.get("fill") for path in shapes(figure))
    assert any(path.get("fill") == UNTOUCHED for path in shapes(figure))
    assert not any("%" in text for text in texts(figure))


def test_a_joint_of_no_known_law_is_hatched_over_its_colour_and_the_legend_says_so(arm, angles):
    plain, hatched = (draw_arm(arm, angles, {"joint 2": 0.6}, nameless) for nameless in ((), {"joint 2"}))
    assert "no known" not in texts(plain)
    assert {"no known", "law", "J2  60 %"} <= set(texts(hatched))
    lines = [sum(path.get("stroke-width") == "1.1" for path in shapes(each)) for each in (plain, hatched)]
    assert lines[1] - lines[0] >= 2 + 2, "on the disc, and in the legend"
    assert any(path.get("fill") == share_colour(1.0) for path in shapes(hatched))


def test_what_is_no_part_of_the_arm_appears_only_when_it_is_to_blame(arm, angles):
    assert not any("instrument" in t or "payload" in t for t in texts(draw_arm(arm, angles, {"joint 1": 0.5})))
    blamed = texts(draw_arm(arm, angles, {"instrument": 0.5, "payload": 0.2}))
    assert "instrument  50 %" in blamed
    assert "payload  20 %" in blamed


def test_a_coupling_counts_with_the_joint_that_it_turns():
    shares = shares_by_place({"joint 6 from joint 5": 0.2, "joint 6": 0.1, "base": -0.01})
    assert shares["joint 6"] == pytest.approx(0.3)
    assert shares["base"] == 0


def test_colours_grow_darker_evenly():
    """Lightness must tell the share without hue, and fall monotonically."""
    colours = [between(SHARES, part) for part in np.linspace(0, 1, 50)]
    red, green, blue = np.array([[int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)] for colour in colours]).T
    lightness = 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    assert np.all(np.diff(lightness) < 0)


def test_the_scale_has_one_order_on_light_and_dark_pages():
    """Captions, and the error field beside, say that dark is large."""
    steps = re.findall(r"--s(\d+): (#\w+)", page_variables())
    assert [colour for _, colour in steps] == list(SHARES)
    assert [int(number) for number, _ in steps] == list(range(len(SHARES)))


def test_a_colour_between_two_lies_between_them():
    assert between(SIGNED, 0) == SIGNED[0]
    assert between(SIGNED, 1) == SIGNED[-1]
    assert between(("#000000", "#646464"), 0.25) == "#191919"
    assert [scale_end(share) for share in (0, 0.03, 0.41, 2)] == [0, 0.05, 0.6, 2]


def test_a_curve_and_its_summary_are_not_counted_twice():
    case = verdicts.case(
        effects=(verdicts.unknown_curve("joint 4", share=0.2),),
        unexplained=verdicts.Unexplained(True, "joint 4", "angle of joint 4", 0.1),
    )
    assert location_shares(case.verdict) == {"joint 4": 0.2}


def test_what_is_left_unexplained_colours_its_place():
    case = verdicts.unknowns()
    shares = location_shares(case.verdict)
    assert shares["base"] == pytest.approx((0.05 / case.verdict.residual_before_mm) ** 2)


def test_the_atlas_takes_the_best_direction_and_leaves_out_what_does_not_exist():
    case = verdicts.single()
    share = np.full((2, 6, 3), np.nan)
    share[0, :, 0] = [0.1, 0.3, 0.2, 0, 0, 0]
    share[1, 4, 2] = 0.5
    atlas = verdicts.Atlas(("base", "joint 2"), ("tx",) * 6, ("constant", "speed", "gravity load"), share, share / 20)
    shown = atlas_map(atlas, case.verdict.effects)
    assert shown.drivers == ("constant", "gravity load")
    (base, before, _), (joint, loaded, left) = shown.rows
    assert (base, joint) == ("base", "joint 2")
    assert before[0].text == "30"
    assert before[1].level is None
    assert (loaded[1].text, loaded[1].named, loaded[1].level) == ("50", True, len(SHARES) - 1)
    assert (left[1].text, left[1].named) == ("", False), "numbers stand only where they matter"


@pytest.mark.parametrize(
    ("effect", "location", "cell"),
    [
        ("joint_offset", "joint 3", ("joint 3", "constant")),
        ("link_geometry", "link 2", ("link 2", "constant")),
        ("thermal_expansion", "link 6", ("link 6", "temperature")),
    ],
)
def test_named_effects_are_framed_where_the_atlas_shows_them(effect, location, cell):
    places = ("base", *(f"{kind} {j}" for kind in ("joint", "link") for j in range(1, 7)))
    share = np.full((len(places), 1, len(verdicts.DRIVERS)), 0.2)
    shown = atlas_map(verdicts.Atlas(places, ("rz",), verdicts.DRIVERS, share, share), [found(effect, location)])
    named = [
        (place, driver)
        for place, before, _ in shown.rows
        for driver, each in zip(shown.drivers, before, strict=True)
        if each.named
    ]
    assert named == [cell]
    assert not any(each.named for _, _, after in shown.rows for each in after)


def test_a_wave_of_unknown_count_is_framed_nowhere():
    atlas = verdicts.case(effects=()).verdict.atlas
    mesh = found("gear_mesh", "joint 1", Parameter("per_turn", "1/turn", 37, 0))
    assert not any(each.named for _, before, _ in atlas_map(atlas, [mesh]).rows for each in before)


def test_the_waterfall_ends_at_the_last_step_and_shows_the_noise():
    figure = draw_waterfall([("start", 0.8), ("+ a", 0.3), ("+ b", 0.04)], 0.03, [("poly", 0.5), ("wild", 40.0)])
    assert {"0.800 mm", "0.300 mm", "0.040 mm", "0.500 mm", "noise 0.030 mm", "40.00 mm →"} <= set(texts(figure))
    bars = [(float(bar.get("x")), float(bar.get("width"))) for bar in shapes(figure, "rect")]
    zero, scale = bars[0][0], bars[0][1] / 0.8
    ends = [(round((x - zero) / scale, 3), round((x + wide - zero) / scale, 3)) for x, wide in bars]
    assert np.allclose(ends[:5], [(0, 0.8), (0, 0.3), (0.3, 0.8), (0, 0.04), (0.04, 0.3)], atol=2e-3)
    (noise,) = (points(path) for path in shapes(figure) if path.get("stroke-dasharray"))
    assert (noise[0, 0] - zero) / scale == pytest.approx(0.03, abs=2e-3)
    assert max(x + wide for x, wide in bars) <= figure.width


def test_a_narrow_waterfall_has_its_names_above_the_bars_and_fits_a_telephone():
    steps = [("as stated", 60.0), ("+ asymmetric friction at joint 1", 3.0), ("+ a", 2.0)]
    figure, wide = (draw_waterfall(steps, None, narrow=narrow) for narrow in (True, False))
    (bars, left), (_, usual) = (
        (shapes(each, "rect"), float(shapes(each, "rect")[0].get("x"))) for each in (figure, wide)
    )
    assert figure.width < 500
    assert left < 10 < usual
    named = [float(each.get("y")) for each in shapes(figure, "text") if "".join(each.itertext()) in dict(steps)]
    tops = sorted({float(bar.get("y")) for bar in bars})
    assert all(name < top for name, top in zip(named, tops, strict=True))
    assert all(name > top for name, top in zip(named[1:], tops, strict=False))


def test_steps_are_in_words_and_a_step_that_nobody_asked_for_is_left_out():
    labels = ("free frames", "gear_mesh at joint 1 (per_turn 9)", "tolerances everywhere")
    steps = tuple(verdicts.WaterfallStep(label, 1.0, 1.0) for label in labels)
    clean = verdicts.case(effects=(), waterfall=steps).verdict
    assert [s.label for s in waterfall_steps(clean)] == [
        "base and tool placed, no effect", "+ gear mesh at joint 1 (waves per turn 9)",
    ]  # fmt: skip
    ordinary = verdicts.case(effects=(found("backlash", "joint 1"),), waterfall=steps).verdict
    assert len(waterfall_steps(ordinary)) == 3


def test_minor_steps_in_a_row_are_drawn_as_one():
    steps = [verdicts.WaterfallStep(f"+ {n}", 1.0, 1.0 - n / 10, minor=n in (2, 4, 5)) for n in range(7)]
    drawn = gathered(steps)
    assert [s.label for s in drawn] == ["+ 0", "+ 1", "+ 2", "+ 3", "+ 2 minor effects", "+ 6"]
    assert drawn[4].held_out_mm == 0.5


def test_a_joints_own_error_shows_in_its_own_panel():
    random = np.random.default_rng(0)
    angles = random.uniform(-2, 2, (400, 2))
    jacobian = np.zeros((400, 3, 2))
    jacobian[:, 0, 0] = jacobian[:, 1, 1] = 0.7
    residual = np.zeros((400, 3))
    residual[:, 0] = np.sin(angles[:, 0])
    figure = draw_along_joints(angles, jacobian, residual, 0 * residual)
    lines = [points(path) for path in shapes(figure) if path.get("stroke-width") == "2.2" and path.get("fill")]
    own, flat, other, _ = [line[:, 1] for line in lines[:4]]
    assert np.ptp(own) > 10 * np.ptp(flat)
    assert np.ptp(own) > 3 * np.ptp(other)
    assert np.argmin(own) > np.argmax(own), "up is positive: the sine is lowest at -90 and highest at +90 degrees"


def test_a_running_mean_is_the_mean_of_equal_groups():
    x, y = running_mean(np.arange(96.0), np.arange(96.0) ** 2)
    assert len(x) == 12
    assert y[0] == pytest.approx(np.mean(np.arange(8) ** 2))


@pytest.mark.parametrize(("value", "step"), [(7.3, 5), (2.0, 2), (0.019, 0.01), (1000, 1000), (499, 200)])
def test_nice_numbers_do_not_exceed_what_they_round(value, step):
    assert nice(value) == pytest.approx(step)


def test_poses_to_measure_are_drawn_up_to_eight(arm, angles):
    assert texts(draw_poses(arm, angles[:12])) == [f"pose {n}" for n in range(1, 9)]


def test_no_ones_name_ends_a_drawing():
    drawing = Drawing(10, 10, '"><script>')
    drawing.text((1, 1), "<b>&$")
    assert texts(drawing) == ["<b>&$"]
    assert "<script>" not in drawing.svg()


def test_ticks_are_round_and_within():
    assert ticks(-0.32, 0.29) == pytest.approx([-0.3, -0.2, -0.1, 0, 0.1, 0.2])
    assert ticks(0, float("nan")) == []
    assert ticks(-1e-9, 1e-9, 2) == pytest.approx([-1e-9, 0, 1e-9])  # of a figure of nothing
    assert ticks(0, 1e-320) == [] or max(ticks(0, 1e-320)) <= 1e-320


def test_a_curve_is_drawn_in_degrees_with_the_95_percent_band():
    effect = verdicts.unknown_curve()
    curve = drawn_curve(effect, effect.curve)
    assert curve.x[-1] == pytest.approx(180)
    assert curve.y_label == "joint 4 turns by (µrad)"
    assert np.allclose(curve.high - curve.value, 1.96 * 12, rtol=1e-3)
    assert curve.value.max() == pytest.approx(150, rel=0.01)


def test_a_curve_is_drawn_where_its_numbers_are():
    effect = verdicts.unknown_curve()
    figure = draw_curves([drawn_curve(effect, effect.curve)])
    (line,) = [points(path) for path in shapes(figure) if path.get("stroke-width") == "2"]
    top = line[np.argmin(line[:, 1]), 0]
    peak = np.interp(0.8, (-np.pi, np.pi), (line[0, 0], line[-1, 0]))
    assert top == pytest.approx(peak, abs=3)


def test_what_partly_cancels_another_cause_is_no_grey_joint():
    """ "Grey: none was found there", said the picture of a joint whose zero was a step of the work order."""
    case = verdicts.case(effects=(verdicts.unknown_curve("joint 4", share=-0.16),))
    assert location_shares(case.verdict) == {"joint 4": 0.16}
