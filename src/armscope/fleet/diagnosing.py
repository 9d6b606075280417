"""The arms of a fleet diagnosed one after the other, each as `armscope diagnose` would."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from armscope.core.files import new_folder, write_text
from armscope.core.inputs import InputError
from armscope.diagnosis import Settings, diagnose, write_verdict
from armscope.fleet.members import Member
from armscope.recordings import read_recordings
from armscope.robot import load_arm

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
            table = read_recordings(member.recordings, arm.n_motors)
            rows = table.of_runs([member.run]) if member.run else table
            write_verdict(diagnose(arm, rows, settings), output / member.name)
        except InputError as error:  # one arm's bad table must not lose the others' answers
            write_text(output / member.name / FAILURE, f"{error}\n")
