"""The arms of a fleet diagnosed one after the other, each as `armscope diagnose` would."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from armscope.core.files import new_folder, write_text
from armscope.core.inputs import InputError
from armscope.diagnosis import Settings, diagnose, write_verdict
from armscope.fleet.members import Member
from armscope.recordings import Recordings, read_recordings
from armscope.robot import Arm, load_arm

FAILURE = "failure.txt"


def diagnose_members(members: Iterable[Member], output: Path, settings: Settings) -> None:
    """Write each member's verdict into a folder of its name; what can't be read is written down there instead.

    Args:
        members: which.
        output: new folder.
        settings: of the diagnosis.
    """
    new_folder(output)
    for member in members:
        try:
            arm = load_arm(member.robot)
            write_verdict(diagnose(arm, _rows_of(member, arm), settings), output / member.name)
        except InputError as error:  # one arm's bad table must not lose the others' answers
            write_text(output / member.name / FAILURE, f"{error}\n")


def _rows_of(member: Member, arm: Arm) -> Recordings:
    """The rows of a member's run, or of all of them."""
    table = read_recordings(member.recordings, arm.n_motors)
    if not member.run:
        return table
    if not (table.run == member.run).any():
        raise InputError(member.recordings, "", f"no run {member.run}", "the fleet's table names it")
    return table.rows(table.run == member.run)
