"""A log of time, angles and torques is drafted as a motion, and what is neither that nor points is told."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from armscope.core.inputs import InputError
from armscope.recordings.importing.draft_motions import draft_any_mapping
from armscope.recordings.importing.tables import import_recordings
from armscope.recordings.motions import read_motions

N = 40
GERMAN = "Zeit [ms];Bahn;Achse1 Ist [Grad];Achse2 Ist [Grad];M1 [Nm];M2 [Nm];Last [kg];Not-Aus"
PLAIN = "time;run;q1;q2;i1;i2;dq1;dq2"
WARM = "time;run;q1;q2;tau1;tau2;temp1;temp2"


def log(folder: Path, head: str) -> Path:
    rng = np.random.default_rng(1)
    rows = [
        ";".join([str(10 * n), f"B{n // 20}", *(f"{x:.3f}".replace(".", ",") for x in rng.uniform(10, 90, 6))])
        for n in range(N)
    ]
    (folder / "log.csv").write_text("\n".join([head, *rows]))
    return folder / "log.csv"


@pytest.mark.parametrize(
    ("head", "kind", "groups"),
    [
        (GERMAN, "torque", {"time", "positions", "torque", "run", "payload"}),
        (WARM, "torque", {"time", "positions", "torque", "run", "temperatures"}),
        (PLAIN, "current", {"time", "positions", "current", "run", "speeds"}),
    ],
)
def test_a_log_of_a_motion_is_drafted_and_imported(head, kind, groups, tmp_path):
    file = log(tmp_path, head)
    draft = draft_any_mapping(file)
    content = yaml.safe_load(draft)
    assert content["table"] == "motions"
    assert "--mapping mapping.yaml -o motions.csv\n" in draft
    assert set(content["columns"]) == groups
    assert content["columns"]["time"]["unit"] == "ms"
    assert content["columns"]["positions"]["unit"] == "deg"
    assert ("# not used: 'Not-Aus'" in draft) is (head == GERMAN)
    (tmp_path / "mapping.yaml").write_text(draft)
    import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "motions.csv")
    motions = read_motions(tmp_path / "motions.csv", 2)
    assert motions.kind == kind
    assert motions.runs == ("B0", "B1")


def test_angles_without_time_or_torques_are_told_to_be_neither(tmp_path):
    file = log(tmp_path, "n;run;q1;q2;w1;w2;h1;h2")
    with pytest.raises(InputError, match=r"no columns look like measured x, y, z, nor like time, .* of a motion"):
        draft_any_mapping(file)
    with pytest.raises(InputError, match="shows one of points and one of motions"):
        draft_any_mapping(file)
