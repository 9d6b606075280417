"""What is changed at a parallelogram's bars: every bar that is off, and no other."""

from armscope.physics.registry import effect_named
from armscope.verdict.bars import ALL_OF_THEM, NOT_SURE, bars_set_right
from armscope.verdict.contributions import contributions
from armscope.verdict.effects import Parameter
from armscope.verdict.tasks import task_of
from tests.report import verdicts

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
