"""What is not settled is told as what it is for sure, with its most likely reading and whether its size is known."""

from __future__ import annotations

from dataclasses import replace

import pytest

from armscope.verdict.effects import Parameter
from armscope.verdict.unsettled import kind_and_place, vague
from tests.report import verdicts

BASE = verdicts.compliance("joint 2", named_as="region", title="elastic, around joint 2, base")


def test_one_of_two_is_told_as_either() -> None:
    either = replace(BASE, title="base compliance at base or bearing compliance at joint 1")
    assert kind_and_place(either) == vague(either) == "either base compliance at base or bearing compliance at joint 1"


def test_a_region_is_told_with_what_is_likeliest_there() -> None:
    assert kind_and_place(BASE) == "something gives way under load around joint 2, base"
    assert vague(BASE) == f"{kind_and_place(BASE)}, most likely joint compliance at joint 2"
    assert kind_and_place(replace(BASE, location="payload")) == "the payload may not be as stated"


@pytest.mark.parametrize(("stderr", "is_open"), [(1e-7, False), (1e-5, True)])
def test_a_size_that_may_be_zero_is_said_to_be_open(stderr: float, is_open: bool) -> None:
    effect = replace(BASE, parameters=(Parameter("compliance", "rad/(N m)", 1e-6, stderr),))
    assert vague(effect).endswith("these rows do not determine") == is_open
