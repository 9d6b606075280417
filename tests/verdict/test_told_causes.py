"""What dominates once the geometry is calibrated is told, however little it is beside the geometry."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from armscope.verdict.effects import Cause, Parameter
from armscope.verdict.importance import minor_and_told
from armscope.verdict.told_causes import is_spread, kind_and_place, told_and_rest, vague, with_share
from armscope.verdict.wording import SPREAD
from tests.report import verdicts


def cause(family: str, share: float, after: float = math.nan, text: str = "", everywhere: bool = False) -> Cause:
    text = text or f"something {family}"
    return Cause(family, "effect", "arm", (f"{family} at arm",), everywhere, False, share, 0.1, text, "", after)


ROWS = cause("geometric", 0.97, text=SPREAD["geometric"], everywhere=True)
GIVES = cause("elastic", 0.02, 0.3)
PLAY = cause("transmission", 0.004, 0.6)


def test_what_calibration_leaves_comes_in_its_own_order() -> None:
    told, rest = told_and_rest([ROWS, GIVES, PLAY])
    assert told == [ROWS, PLAY, GIVES]
    assert rest == []
    assert with_share(PLAY, first=False) == "something transmission – 0.4 % (60 % of what calibration leaves)"
    hidden = cause("transmission", -0.001, 0.6)
    assert with_share(hidden, first=False) == "something transmission – 60 % of what calibration leaves"


def test_a_share_that_is_the_same_either_way_is_told_once() -> None:
    assert with_share(cause("elastic", 0.8, 0.82), first=True) == "something elastic – 80 % of the squared error"
    assert with_share(cause("elastic", 0.8), first=False) == "something elastic – 80 %"
    assert with_share(cause("elastic", 0.18, 0.55), first=False) == "something elastic – 18 %", "nobody overlooks it"
    assert with_share(cause("elastic", 0.1, 0.55), first=False).endswith("10 % (55 % of what calibration leaves)")


def test_what_is_next_to_nothing_is_no_cause_at_all() -> None:
    nothing, little = cause("thermal", 0.0004), cause("drift", 0.003, 0.05)
    told, rest = told_and_rest([ROWS, little, nothing])
    assert told == [ROWS]
    assert rest == [little]


def test_members_that_stand_out_only_together_are_told() -> None:
    together = replace(cause("elastic", 0.01, 0.18), minor=True)
    assert told_and_rest([ROWS, together])[0] == [ROWS, together]
    assert minor_and_told([ROWS, together]) == [together]
    little = replace(together, share_after_calibration=0.05)
    assert told_and_rest([ROWS, little])[1] == [little]
    assert minor_and_told([ROWS, little]) == []


def test_three_are_told() -> None:
    five = [cause(f"kind {n}", 0.3 - 0.01 * n) for n in range(5)]
    told, rest = told_and_rest(five)
    assert (told, rest) == (five[:3], five[3:])
    assert is_spread(ROWS)
    assert not is_spread(PLAY)


def test_the_member_that_leads_is_not_credited_with_the_share_of_all() -> None:
    """It was: "The zero of joint 5 is off by +22 mrad (also off: joint 6 and link 6) – 79 %"; the zero had 35 %."""
    geometry = cause("geometric", 0.79, text="the zero of joint 5 is off by +22 mrad (also off: joint 6)")
    assert with_share(geometry, first=True, alone=0.35).endswith(
        "(also off: joint 6) – 35 % of the squared error, 79 % with the others"
    )
    assert with_share(geometry, first=False, alone=0.35).endswith("– 35 %, 79 % with the others")
    assert with_share(geometry, first=False, alone=0.78).endswith("– 79 %"), "the others are next to nothing"
    assert with_share(geometry, first=False, alone=-0.1).endswith("– 79 %"), "others cancel more than it has"


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
