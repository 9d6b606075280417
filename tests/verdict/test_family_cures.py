"""What mends several effects of a family at once, or its small errors in the whole arm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.thermal import all_links_growing
from armscope.verdict.effects import Parameter
from armscope.verdict.family_cures import cure_of_family, growth_in_words, mended_together
from tests.report import verdicts

from ..physics.scenes import arm_named, full_table


def test_a_single_effect_has_its_own_cure() -> None:
    alone = verdicts.compliance("joint 2")
    assert cure_of_family("elastic", [alone], everywhere=False) == alone.cure


def test_a_cure_of_a_size_that_may_be_zero_begins_with_its_confirmation() -> None:
    size = Parameter("offset", "rad", 1e-4, 1e-4)
    assert cure_of_family("geometric", [verdicts.found("joint_offset", "joint 2", size)], False).startswith(
        "Confirm it"
    )
    sizes = (replace(size, stderr=1e-5), Parameter("phase", "rad", 0.1, 0.2), Parameter("per_turn", "1/turn", 2, 0))
    sure = verdicts.found("joint_offset", "joint 2", *sizes)
    assert cure_of_family("geometric", [sure], everywhere=False) == sure.cure


def test_several_places_or_the_whole_arm_are_mended_as_a_family() -> None:
    first, second = verdicts.compliance("joint 2"), verdicts.compliance("joint 3")
    together = cure_of_family("elastic", [first, second], everywhere=False)
    assert together == cure_of_family("elastic", [first], everywhere=True)
    assert together != first.cure


@pytest.mark.parametrize("family", ["geometric", "elastic", "transmission", "drift", "unknown"])
def test_small_errors_of_every_family_have_words(family: str) -> None:
    assert cure_of_family(family, (), everywhere=True).endswith(".")


def test_a_family_without_words_of_its_own_is_mended_as_its_largest_effect() -> None:
    scale = verdicts.found("instrument_scale", "instrument")
    assert cure_of_family("instrument", [scale, scale], everywhere=False) == scale.cure


def test_a_link_that_warms_up_is_no_loose_base() -> None:
    """Somebody was told to fasten what was bolted down: the error stayed."""
    assert "temperature_c" in cure_of_family("drift", (), everywhere=True, worst="link 2")
    for worst in ("", "base"):
        assert cure_of_family("drift", (), everywhere=True, worst=worst).startswith("Fasten the instrument")


@pytest.mark.parametrize("family", ["elastic", "transmission"])
def test_small_errors_without_a_name_are_not_to_be_stored_by_hand(family: str) -> None:
    """Hundreds of waves that no page prints: only what is named has numbers to enter."""
    told = cure_of_family(family, (), everywhere=True)
    assert "No table" in told
    assert "(`armscope compensate`), in place of all other steps" in told
    pair = [verdicts.compliance("joint 2"), verdicts.compliance("joint 3")]
    assert "named" in cure_of_family(family, pair, everywhere=True)


def test_a_family_without_a_cure_of_its_own_tells_each_members() -> None:
    """A target that is loose is not mended by a scale."""
    scale = verdicts.found("instrument_scale", "instrument")
    loose = verdicts.found("loose_target", "tool")
    told = cure_of_family("instrument", [scale, loose], everywhere=False)
    assert scale.cure in told
    assert loose.cure in told


@pytest.mark.parametrize(("effect", "family"), [("axis_wobble", "geometric"), ("zero_shift", "drift")])
def test_what_no_calibration_mends_keeps_its_own_cure(effect: str, family: str) -> None:
    """Two axes that wobble were to be mended by zeros and D-H rows, two zeros that slipped by fastening the base."""
    pair = [verdicts.found(effect, f"joint {n}") for n in (1, 7)]
    assert cure_of_family(family, pair, everywhere=False) == pair[0].cure
    rows = [verdicts.found("joint_offset", f"joint {n}") for n in (1, 7)]
    assert cure_of_family("geometric", rows, everywhere=False).startswith("Calibrate the geometry")


def test_a_zero_that_jumped_is_not_fastened_with_the_base() -> None:
    jumped = verdicts.found("zero_shift", "joint 2")
    moved = verdicts.found("base_shift", "base")
    assert mended_together(jumped) == "zero_shift"
    assert mended_together(moved) == "drift"


def told_of(alike: float, first_besides: float) -> str:
    """What is said of links that grow alike, and the first one by something more."""
    arm = arm_named("six-axis")
    whole, first, *others = all_links_growing(arm, full_table(arm, 30, seed=1))
    parts = [Part(whole, np.array([alike])), Part(first, np.array([first_besides]))]
    return growth_in_words([*parts, *(Part(link, np.zeros(1)) for link in others)])


def test_all_links_that_grow_alike_have_one_number() -> None:
    formula = "length = stated length x (1 + coefficient x (temperature - 20 C))."
    assert told_of(2.2e-5, 0.0) == f"{formula} Here coefficient = 22 millionths per K."


def test_links_that_grow_otherwise_are_told_from_to_and_their_mean_by_length() -> None:
    assert "link by link 22 millionths per K to 28 millionths per K" in told_of(2.2e-5, 6e-6)


def test_nothing_is_said_of_links_that_do_not_grow() -> None:
    assert growth_in_words([]) == told_of(0.0, 0.0) == ""
