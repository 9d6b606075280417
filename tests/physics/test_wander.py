"""A wander's waves: as large together as is plausible, slow, and at rest outside the time they were learned in."""

from dataclasses import replace

import numpy as np

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.form_constants import FORM
from armscope.physics.scene import Scene
from armscope.physics.wander import is_of_rows, link_wander, wander

from .scenes import arm_named, full_table

TABLE = full_table(arm_named("six-axis"), 90, seed=3)


def timed(time):
    return replace(TABLE, time=time)


def test_all_waves_together_are_as_large_as_is_plausible():
    waves = wander(timed(np.linspace(0.0, 3600.0, 90)), ())
    assert len(waves) == FORM.wander_waves
    assert not any(is_of_rows(wave) for wave in waves)
    sizes = np.array([wave.prior_scale for wave in waves])
    assert np.allclose(np.sqrt(np.sum(sizes**2, axis=0)), [PLAUSIBLE.wander_m] * 3 + [PLAUSIBLE.wander_rad] * 3)
    assert np.all(np.diff(sizes[:, 0]) < 0)


def test_long_links_grow_as_much_as_is_plausible_the_last_one_moving_the_tool_along_its_axis():
    waves = link_wander(arm_named("six-axis"), timed(np.linspace(0.0, 3600.0, 90)))
    assert {wave.location for wave in waves} == {f"link {j}" for j in (1, 2, 3, 4, 6)}
    for place in ("link 2", "link 6"):
        sizes = [wave.prior_scale for wave in waves if wave.location == place]
        assert len(sizes) == FORM.growth_waves
        assert np.isclose(np.sqrt(np.sum(np.square(sizes))), PLAUSIBLE.growth)
    (along,) = next(wave for wave in waves if wave.location == "link 6").terms[0].products
    assert (str(along.direction.axis), along.factor) == ("tz", 0.153)


def test_without_a_clock_it_follows_the_order_of_rows():
    assert all(is_of_rows(wave) for wave in wander(timed(None), ()))


def test_few_rows_have_few_waves():
    few = timed(None).rows(np.arange(25))
    assert len(wander(few, ())) == 2


def test_runs_of_one_set_up_stand_a_little_elsewhere():
    placed = wander(timed(None), (("a", "b"), ("c",)))
    assert [each.variant for each in placed[FORM.wander_waves :]] == ["run a", "run b"]


def test_a_wave_of_rows_leaves_each_runs_mean_to_the_run():
    """Other rows of a run are as far from home as the run is, though nobody knows where they stand in its order."""
    arm = arm_named("six-axis")
    runs = replace(timed(None), run=np.repeat(["a", "b", "c"], 30))
    scene = Scene(arm, runs)
    for placed in (*wander(runs, (("a", "b", "c"),)), *link_wander(arm, runs)):
        if placed.variant.startswith("wave"):
            term = placed.terms[0]
            first = term.products[0]
            along = [p for p in term.products if p.direction == first.direction]
            course = np.sum([p.factor / first.factor * scene.driver(p.driver) for p in along], axis=0)
            assert np.abs(course.reshape(3, 30).mean(axis=1)).max() < 1e-12
            assert np.std(course) > 0.1
    assert {each.variant for each in link_wander(arm, runs)} >= {"run a", "run b", "run c", "wave 1"}
