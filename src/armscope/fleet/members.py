"""fleet.csv: which arms there are, of which type, the recordings of each, and a diagnosis of each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from armscope.core.files import new_folder, write_text
from armscope.core.inputs import InputError
from armscope.diagnosis import Settings, diagnose, write_verdict
from armscope.recordings import read_recordings
from armscope.recordings.textfile import read_text_table
from armscope.robot import load_arm

COLUMNS = ("arm", "type", "robot", "recordings")
OPTIONAL = ("date", "run")
FORBIDDEN = set("/\\") | {"\0"}


@dataclass(frozen=True)
class Member:
    """One diagnosis of a fleet."""

    arm: str  # its name, of a folder of its verdicts, too
    type: str  # arms of one type are compared
    robot: Path
    recordings: Path
    date: str = ""  # of the recordings, as the page orders them; may be empty
    run: str = ""  # of the recordings that is diagnosed alone; empty: all of them together

    @property
    def name(self) -> str:
        """The arm, and which of its diagnoses this is: a folder's name."""
        return "_".join(part for part in (self.arm, self.date, self.run) if part)


def read_fleet(path: Path) -> list[Member]:
    """The rows of a fleet.csv; files are looked for from where the command is run. Raises InputError: a column or a
    file is missing, or two rows would be one diagnosis."""
    table = read_text_table(path)
    for column in COLUMNS:
        if column not in table:
            raise InputError(path, "line 1", f"no column {column}", f"a fleet has {', '.join((*COLUMNS, *OPTIONAL))}")
    members: list[Member] = []
    known: dict[str, int] = {}
    for row, content in enumerate(table.astype(object).fillna("").astype(str).to_dict("records"), start=2):
        cells = {name: str(content.get(name, "")).strip() for name in (*COLUMNS, *OPTIONAL)}
        for name in COLUMNS:
            if not cells[name]:
                raise InputError(path, f"line {row}, column {name}", "nothing", "every row has one")
        member = Member(
            cells["arm"], cells["type"], Path(cells["robot"]), Path(cells["recordings"]), cells["date"], cells["run"]
        )
        if FORBIDDEN & set(member.name) or member.name.startswith("."):
            raise InputError(
                path, f"line {row}", member.name, "arm, date and run name a folder: no slash, no first dot"
            )
        if member.name in known:
            rule = f"one diagnosis per arm, date and run: line {known[member.name]} is the same"
            raise InputError(path, f"line {row}", member.name, rule)
        known[member.name] = row
        members.append(member)
    return members


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
