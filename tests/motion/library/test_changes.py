"""What a scan found, placed: a load that is there, the same as one that is gone, and readings that jump with it."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.constants import LIBRARY
from armscope.motion.library.causes import Moment, PlacedCause, Seen
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.changes import Change, as_it_is_carried, gate_of, place_changes
from armscope.motion.library.changes_catalogue import LOAD_CHANGE, OFFSET_JUMP
from armscope.motion.library.clauses_of_changes import in_every_row, jump_clause, off_while_there
from armscope.motion.library.for_a_while import there
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.library.remedies import Fitted
from armscope.motion.samples.preparation import Signals
from armscope.motion.samples.timing import stretches
from armscope.motion.verdict import FoundCause
from armscope.robot.bodies import Bodies
from armscope.verdict.effects import Parameter
from tests.motion.moving import moved, robot

FOUND = Change("path 1", False, (4.0, 9.0), 0.01, np.array([2.0, 0.6, 0.1, -0.2]), 300)


def placed() -> tuple[Seen, list[PlacedCause]]:
    arm = robot()
    seen = seen_in(arm, list(stretches(moved(arm, 2))), LIBRARY.still_rad)
    return seen, list(place_changes(seen, FOUND, stated=0.5))


def moment(seen: Seen, run: str) -> Moment:
    time = np.linspace(0, 15, 60)
    q = np.column_stack([np.sin((j + 1) * time / 3) for j in range(3)])
    signals = Signals(run, 0, time, q, q, q, q[:0], None, None, np.arange(60))
    return Moment(signals, q, q, 4.0, Bodies(seen.arm, seen.arm.inertial, None))


def test_a_load_is_placed_as_there_and_as_gone_and_beside_it_what_jumps() -> None:
    seen, causes = placed()
    loads, jumps = ([each for each in causes if each.cause is kind] for kind in (LOAD_CHANGE, OFFSET_JUMP))
    assert [gate_of(each)[0] for each in loads] == [0.0, 0.0, 1.0, 1.0]
    assert all(gate_of(each)[1] == [4.0, 9.0] for each in causes)
    assert [each.location for each in jumps] == ["joint 1", "joint 2", "joint 3"]
    assert all(each.runs == ("path 1",) and each.multiplicity == 300**2 for each in causes)
    now = moment(seen, "path 1")
    come, gone = (each.columns_in(now) for each in (loads[1], loads[3]))
    always = come + gone
    assert np.abs(come[there(now.signals.time, 0.0, [4.0, 9.0]) == 0]).max() == 0
    at_tool = seen.arm.regressor(*now.motion) @ seen.arm.point_load()
    assert always[:, :, 0] == pytest.approx(at_tool)


def test_another_run_has_none_of_it() -> None:
    seen, causes = placed()
    for cause in causes:
        columns = cause.columns_in(moment(seen, "path 2"))
        assert columns.shape == (60, len(cause.joints), cause.width)
        assert not columns.any()


def test_its_inertia_goes_with_what_is_carried() -> None:
    seen, causes = placed()
    free = causes[0]
    values = np.array([dict(zip(("mass", "mx", "my", "mz"), (3.0, 1.2, 0.0, 0.3), strict=True))[name]
                       for name, _ in free.parameters])  # fmt: skip
    moved_on = as_it_is_carried(free, seen.arm, values)
    before, after = (each.columns_in(moment(seen, "path 1")) for each in (free, moved_on))
    assert np.abs(after - before).max() > 1e-3 * np.abs(before).max()
    nothing = as_it_is_carried(free, seen.arm, np.full(free.width, 0.5 * CHANGE.least_load_kg))
    assert nothing is free


def test_words_say_when() -> None:
    scanned = (Parameter("from", "s", 4.0, float("nan")), Parameter("unsure", "s", 0.01, float("nan")))
    jump = (Parameter("jump", "N m", -1.5, 0.05), *scanned)
    cause = FoundCause(
        "offset_jump", "joint 2", "drive", "time", "offset jump", False, jump, 1.0, "N m", "joint 2", 0.3, 9.0
    )
    said = jump_clause(cause, {each.name: each for each in jump})
    assert said == "from 4.00 s on the recorded torque of joint 2 reads 1.500 ± 0.098 N m too low"
    assert off_while_there(Fitted("", jump, robot())).startswith(
        "Take −1.500 ± 0.098 N m from the recorded torque from"
    )
    load = (Parameter("mass", "kg", 2.0, 0.1), *scanned)
    cure = in_every_row(Fitted(LOAD_CHANGE.cure, load, robot()))
    assert cure == "Record `payload_kg` in every row: stated +2.00 ± 0.20 kg from 4.00 s on, as stated at other times."
