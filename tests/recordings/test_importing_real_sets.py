"""The real sets become the tables that others made of them."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.recordings.importing.fetching import fetch_recordings
from armscope.recordings.importing.tables import import_recordings

from .raw import TEXT

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "recordings"


@pytest.mark.shared
@pytest.mark.parametrize(
    "name", [pytest.param("ur10-ipa", marks=pytest.mark.long), "iiwa7-payload", "ma1400-leica", "irb120-offsets"]
)
def test_a_real_set_converts_to_the_reference_table_within_its_rounding(name, tmp_path):
    if not SHARED.is_dir():
        pytest.skip("../shared/recordings is not here, so there is nothing to compare with")
    folder = ROOT / "config" / "recordings" / name
    fetched = fetch_recordings(folder / "source.yaml", tmp_path / "raw", recordings_dir=SHARED)
    import_recordings(list(fetched.paths), folder / "mapping.yaml", tmp_path / "out.csv.gz")
    ours, theirs = (
        pd.read_csv(path, dtype=dict.fromkeys(TEXT, str))
        for path in (tmp_path / "out.csv.gz", SHARED / name / "recordings.csv.gz")
    )
    assert list(ours.columns) == list(theirs.columns)
    assert len(ours) == len(theirs)
    for column in theirs:
        if column in TEXT:
            assert (ours[column] == theirs[column]).all(), column
        else:
            # the reference prints 9 digits of angles, 5 decimals of mm and N m, 7 of quaternions, 4 of temperatures
            step = {"x": 1e-5, "y": 1e-5, "z": 1e-5, "t": 1e-5, "s": 1e-5}.get(column[0], 1e-7)
            tolerance = 1e-8 if column.endswith("_rad") else step
            np.testing.assert_allclose(ours[column], theirs[column], atol=0.51 * tolerance, rtol=0, err_msg=column)


@pytest.mark.parametrize("folder", sorted((ROOT / "config" / "recordings").iterdir()), ids=lambda path: path.name)
def test_every_real_set_has_an_arm_and_a_mapping_or_a_reason_for_none(folder):
    from armscope.recordings.importing.fetching import load_source
    from armscope.recordings.importing.motions import load_any_mapping
    from armscope.robot import load_arm

    arm, source = load_arm(folder / "robot.yaml"), load_source(folder / "source.yaml")
    if source.not_importable:
        assert not (folder / "mapping.yaml").exists()
    else:
        mapping = load_any_mapping(folder / "mapping.yaml")
        assert len(mapping.columns.angles.columns) == arm.n_motors
        mapped = {name for run in mapping.runs for name in (run.file, *(other.file for other in run.beside))}
        assert mapped == {file.name for file in source.files}


def test_the_panda_set_says_that_its_source_is_a_pickle(tmp_path):
    with pytest.raises(InputError, match="pickle"):
        fetch_recordings(ROOT / "config/recordings/panda-charuco/source.yaml", tmp_path)
