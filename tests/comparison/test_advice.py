"""What is advised about a zero is executed on the arm: no advice makes the arm worse, and what came is taken out.

The arm is moved with the zero as it is after the advice, base and tool are fitted anew, and what is left is compared
with what was left before. Seen: the cure of a zero that had been repaired, which undid the repair (0.82 to 0.97 mm).
"""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.comparison import compare
from armscope.comparison.remedies import _as_a_wave, remedy_of
from armscope.verdict.effects import Parameter
from tests.comparison.test_changes import ARM, session
from tests.comparison.test_remedies import CHANGE, FOUND
from tests.comparison.worlds import off, recorded
from tests.seeds import seeds

WORLDS = {
    "came": (0.0, 1e-3), "grew": (6e-4, 2e-3), "shrank": (2e-3, 6e-4), "went": (1e-3, 0.0), "other side": (5e-4, -1e-3)
}  # fmt: skip


def entered(told):
    """The zero that an instruction says, rad; 0 where it says none."""
    degrees = re.search(r"by ([+−]\d+\.\d+)°", told)
    return math.radians(float(degrees[1].replace("−", "-"))) if degrees else 0.0


@pytest.mark.parametrize("seed", seeds(1, 5))
@pytest.mark.parametrize("sign", seeds(1, -1))
@pytest.mark.parametrize("kind", WORLDS)
def test_no_advice_makes_the_arm_worse(kind, sign, seed):
    before, after = (sign * size for size in WORLDS[kind])
    rng, joint = np.random.default_rng(seed), 2 + seed % 2
    q = session(seed).motor_angles
    tables = {"before": recorded(q, {joint: before}, rng), "after": recorded(q, {joint: after}, rng)}
    found = compare(ARM, tables)
    (change,) = found.changes
    assert (change.effect, change.location) == ("joint_offset", f"joint {joint}")
    told = remedy_of(found, change)
    reset = entered(told.instruction)
    executed, untouched = off(q, {joint: after - reset}), off(q, {joint: after})
    if kind in ("shrank", "went"):
        assert told.instruction.startswith("Nothing is to be corrected: there is less of it in after")
        assert (told.confirm, told.rule, reset) == ("", "", 0.0)
        assert "the repair worked" in told.why
    else:
        assert told.instruction.startswith(f"Reset the zero of joint {joint}")
        assert executed < max(0.7 * untouched, 0.04), "and what came is gone"
        assert np.sign(reset) == np.sign(after)
    assert executed < 1.01 * untouched
    if kind == "came":
        assert executed < 1.1 * off(q, {})


def test_what_is_less_is_not_mended_though_the_poses_leave_open_how_large_it_is():
    """Then it must be known otherwise that there is less of it; what taking it back does is said beside."""
    open_yet = replace(CHANGE.parameters[0], values=(9e-4, 9e-4, 1.77e-3), stderrs=(1e-2,) * 3)
    repaired = replace(CHANGE, kind="changed", parameters=(open_yet,), left_mm=0.818, taken_back_mm=0.973)
    repaired = replace(repaired, sense="less", worse_sigmas=9.0)
    told = remedy_of(FOUND, repaired)
    assert told.instruction == (
        "Nothing is to be corrected: there is less of it in c than in a and b, and to take the change back would bring "
        "it again. Taken back, 0.973 mm in place of 0.818 mm per axis would be left in c."
    )
    assert "the repair worked" in told.why
    crashed = remedy_of(FOUND, replace(repaired, left_mm=0.973, taken_back_mm=0.818, sense="", worse_sigmas=-9.0))
    assert crashed.instruction.startswith("Reset the zero of joint 3: it moved by +0.0498°")
    assert crashed.instruction.endswith("Taken back, 0.818 mm in place of 0.973 mm per axis would be left in c.")
    assert "a crash" in crashed.why


def test_what_others_make_up_for_is_not_mended_alone():
    told = remedy_of(FOUND, replace(CHANGE, left_mm=0.818, taken_back_mm=0.973, worse_sigmas=9.0))
    assert told.instruction.startswith("Nothing is to be corrected by this alone. Taken back, 0.973 mm")
    assert told.instruction.endswith("diagnose c and mend all of it.")
    assert "a crash" in told.why


def test_a_zero_on_the_other_side_is_mended_by_what_it_is_now():
    """+1 mrad before and −0.5 mrad now: by its change it would be off by +1 mrad again."""
    number = replace(CHANGE.parameters[0], values=(1e-3, 1e-3, -5e-4), stderrs=(1e-4,) * 3, difference=-1.5e-3)
    beyond = replace(CHANGE, kind="changed", parameters=(number,), left_mm=0.2, taken_back_mm=0.4)
    told = remedy_of(FOUND, beyond)
    assert told.instruction.startswith("Reset the zero of joint 3: it is off by −0.0286° (−0.50 mrad ± 0.20)")
    assert "Taken back" not in told.instruction


@given(st.floats(-math.pi, math.pi), st.floats(1e-5, 1e-2), st.integers(1, 8))
def test_a_wave_that_changed_is_taken_off_by_the_numbers_that_its_formula_names(phase, size, count):
    """commanded = wanted - amplitude x cos(per_turn x wanted - phase): without them the formula said nothing."""
    parts = (f"cosine_{count}", size * math.cos(phase)), (f"sine_{count}", size * math.sin(phase))
    amplitude, per_turn, told = _as_a_wave([Parameter(name, "rad", value, 1e-6) for name, value in parts])
    angle = np.linspace(-3, 3, 40)
    wave = parts[0][1] * np.cos(count * angle) + parts[1][1] * np.sin(count * angle)
    assert amplitude.value * np.cos(per_turn.value * angle - told.value) == pytest.approx(wave, abs=1e-9 * size + 1e-15)
    assert amplitude.stderr == pytest.approx(1e-6)
    assert _as_a_wave([Parameter("cosine_rx", "rad", 1e-3, 1e-6)] * 2) == []


def test_a_chance_that_numbers_do_not_hold_is_not_told_as_none():
    assert "p < 1e-300" in replace(FOUND, p_nothing_changed=0.0).headline
