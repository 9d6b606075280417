"""What may change within a run, in words: the load, or what a joint's torque reads."""

from __future__ import annotations

from armscope.motion.library import clauses_of_changes as said
from armscope.motion.library.causes import Cause

UNSURE = {"unsure": "moments known to ±"}

LOAD_CHANGE = Cause(
    "load_change",
    "masses",
    "The arm picks something up or puts it down while the recording goes on.",
    "Look what the gripper did at that time, and weigh what it took or gave.",
    "Record `payload_kg` in every row.",
    labels={f"m{axis}": f"mass × {axis}, in the joint's frame" for axis in "xyz"} | UNSURE,
    clause=said.load_clause,
    remedy=said.in_every_row,
)
OFFSET_JUMP = Cause(
    "offset_jump",
    "drive",
    "From a moment on the recorded torque is off by a constant: a sensor or a drive was set to zero anew.",
    "Compare what is read in one pose, unloaded, before and after that moment.",
    "Subtract the offset from the recorded torque while it is there.",
    labels=UNSURE,
    clause=said.jump_clause,
    remedy=said.off_while_there,
)
CHANGES = (LOAD_CHANGE, OFFSET_JUMP)
