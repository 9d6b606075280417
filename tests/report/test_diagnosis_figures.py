import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgb

from armscope.core.sampling import spread_evenly
from armscope.report.figures.along_joints import draw_along_joints, running_mean
from armscope.report.figures.arm import location_shares
from armscope.report.figures.arm_picture import draw_arm, share_colours, shares_by_place
from armscope.report.figures.arm_shape import arm_shape, typical_pose
from armscope.report.figures.atlas import atlas_tables, draw_atlas
from armscope.report.figures.effect_curve import curve_of
from armscope.report.figures.next_poses import draw_poses
from armscope.report.figures.residual_vectors import draw_vectors, nice
from armscope.report.figures.waterfall import draw_waterfall, gathered, waterfall_steps
from armscope.robot import load_arm
from armscope.verdict.schema import Parameter
from tests.report import verdicts
from tests.report.verdicts import ROBOTS, found


@pytest.fixture(autouse=True)
def _close_figures():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def arm():
    return load_arm(ROBOTS / "six-axis.yaml")


@pytest.fixture(scope="module")
def angles(arm):
    return np.random.default_rng(3).uniform(-1, 1, (30, arm.n_motors))


def texts(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def faces(figure):
    return [tuple(np.round(patch.get_facecolor()[:3], 6)) for patch in figure.axes[0].patches]


def test_the_guilty_joint_is_the_darkest_patch_and_says_its_share(arm, angles):
    figure = draw_arm(arm, angles, {"joint 2": 0.6, "link 3": 0.1})
    darkest = tuple(np.round(to_rgb(share_colours()(1.0)), 6))
    (patch,) = [patch for patch, face in zip(figure.axes[0].patches, faces(figure), strict=True) if face == darkest]
    row, view = typical_pose(arm, angles)
    centres = view.flat(arm_shape(arm, angles[row]).centres)
    assert np.argmin(np.linalg.norm(centres - patch.get_xy().mean(axis=0), axis=1)) == 1
    assert "J2  60 %" in texts(figure)
    assert "L3  10 %" in texts(figure)
    assert "J4" in texts(figure)


def test_an_arm_without_fault_is_drawn_without_colours_and_without_a_colour_bar(arm, angles):
    figure = draw_arm(arm, angles, {})
    assert len(figure.axes) == 1
    assert not any("%" in text for text in texts(figure))


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
    red, green, blue = share_colours()(np.linspace(0, 1, 50))[:, :3].T
    lightness = 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2
    assert np.all(np.diff(lightness) < 0)


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


def test_the_atlas_writes_numbers_only_where_they_matter():
    shares = pd.DataFrame({"load": [0.42, 0.004], "angle": [np.nan, 0.07]}, index=["joint 1", "joint 2"])
    figure = draw_atlas(shares, marked=[("joint 1", "load"), ("joint 9", "load")])
    assert sorted(texts(figure)) == ["42", "7"]
    frames = [patch for patch in figure.axes[0].patches if not patch.get_fill()]
    assert [patch.get_xy() for patch in frames] == [(-0.5, -0.5)]


def test_the_atlas_takes_the_best_direction_and_leaves_out_what_does_not_exist():
    case = verdicts.single()
    share = np.full((2, 6, 3), np.nan)
    share[0, :, 0] = [0.1, 0.3, 0.2, 0, 0, 0]
    share[1, 4, 2] = 0.5
    atlas = verdicts.Atlas(("base", "joint 1"), ("tx",) * 6, ("constant", "speed", "gravity load"), share, share / 2)
    table, left, marked = atlas_tables(atlas, case.verdict.effects)
    assert list(table.columns) == ["constant", "gravity load"]
    assert table.loc["base", "constant"] == 0.3
    assert left.loc["joint 1", "gravity load"] == 0.25
    assert marked == [("joint 2", "gravity load")]


@pytest.mark.parametrize(
    ("effect", "location", "cell"),
    [
        ("joint_offset", "joint 3", ("joint 3", "constant")),
        ("link_geometry", "link 2", ("link 2", "constant")),
        ("thermal_expansion", "link 6", ("link 6", "temperature")),
    ],
)
def test_named_effects_are_framed_where_the_atlas_shows_them(effect, location, cell):
    atlas = verdicts.case(effects=()).verdict.atlas
    atlas = verdicts.Atlas(("base", *(f"joint {j}" for j in range(1, 7))), *list(vars(atlas).values())[1:3],
                           atlas.share[:7], atlas.left[:7])  # fmt: skip
    assert atlas_tables(atlas, [found(effect, location)])[2] == [cell]


def test_a_wave_of_unknown_count_is_framed_nowhere():
    atlas = verdicts.case(effects=()).verdict.atlas
    mesh = found("gear_mesh", "joint 1", Parameter("per_turn", "1/turn", 37, 0))
    assert atlas_tables(atlas, [mesh])[2] == []


def test_the_waterfall_ends_at_the_last_step_and_shows_the_noise():
    figure = draw_waterfall([("start", 0.8), ("+ a", 0.3), ("+ b", 0.04)], 0.03, [("poly", 0.5), ("wild", 40.0)])
    assert {"0.800 mm", "0.300 mm", "0.040 mm", "0.500 mm", "noise 0.030 mm", "40.00 mm →"} <= set(texts(figure))
    lines = [line.get_xdata()[0] for line in figure.axes[0].lines if line.get_linestyle() == "--"]
    assert lines == [0.03]
    assert figure.axes[0].get_xlim()[1] < 2


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


def test_arrows_have_the_stated_scale_and_long_tables_are_thinned():
    random = np.random.default_rng(0)
    points = random.uniform(-1, 1, (12_000, 3))
    before = random.normal(0, 0.1, points.shape)
    figure = draw_vectors(points, before, 0.1 * before)
    quivers = [c for axes in figure.axes[:4] for c in axes.collections if hasattr(c, "U")]
    assert [quiver.N for quiver in quivers] == [350] * 4
    rows = spread_evenly(12_000, 350)
    factor = float(figure.get_suptitle().split("drawn ")[1].split(" times")[0])
    assert np.allclose(quivers[0].U, factor * before[rows, 0])
    assert np.allclose(quivers[1].U, 0.1 * factor * before[rows, 0])


def test_the_side_view_shows_what_sags_as_pointing_down_and_what_stretches_as_pointing_out():
    points = np.array([[1.0, 0, 1], [0, 1, 1], [-1, 0, 1]])
    outwards_and_down = np.array([[0.2, 0, -0.5], [0, 0.2, -0.5], [-0.2, 0, -0.5]])
    figure = draw_vectors(points, outwards_and_down, outwards_and_down)
    side = next(c for c in figure.axes[2].collections if hasattr(c, "U"))
    assert np.ptp(side.U) < 1e-9
    assert side.U[0] > 0 > side.V[0]


def test_a_joints_own_error_shows_in_its_own_panel():
    random = np.random.default_rng(0)
    angles = random.uniform(-2, 2, (400, 2))
    jacobian = np.zeros((400, 3, 2))
    jacobian[:, 0, 0] = jacobian[:, 1, 1] = 0.7
    residual = np.zeros((400, 3))
    residual[:, 0] = np.sin(angles[:, 0])
    figure = draw_along_joints(angles, jacobian, residual, 0 * residual)
    curve = {line.get_label(): line for line in figure.axes[0].lines}["before"]
    assert np.allclose(curve.get_ydata(), np.sin(np.radians(curve.get_xdata())), atol=0.06)
    other = {line.get_label(): line for line in figure.axes[1].lines}["before"]
    assert np.abs(other.get_ydata()).max() < 0.3


def test_a_running_mean_is_the_mean_of_equal_groups():
    x, y = running_mean(np.arange(96.0), np.arange(96.0) ** 2)
    assert len(x) == 12
    assert y[0] == pytest.approx(np.mean(np.arange(8) ** 2))


@pytest.mark.parametrize(("value", "step"), [(7.3, 5), (2.0, 2), (0.019, 0.01), (1000, 1000), (499, 200)])
def test_nice_numbers_do_not_exceed_what_they_round(value, step):
    assert nice(value) == pytest.approx(step)


def test_poses_to_measure_are_drawn_up_to_eight(arm, angles):
    figure = draw_poses(arm, angles[:12])
    assert [axes.get_title() for axes in figure.axes] == [f"pose {n}" for n in range(1, 9)]


def test_a_curve_is_drawn_in_degrees_with_the_95_percent_band():
    effect = verdicts.unknown_curve()
    curve = curve_of(effect, effect.curve)
    assert curve.x[-1] == pytest.approx(180)
    assert curve.y_label == "joint 4 turns by (µrad)"
    assert np.allclose(curve.high - curve.value, 1.96 * 12, rtol=1e-3)
    assert curve.value.max() == pytest.approx(150, rel=0.01)
