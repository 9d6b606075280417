"""Time stamps are drafted where they can be read and rise: without a time nothing that drifts is seen."""

import numpy as np
import pandas as pd
import pytest
import yaml

from armscope.recordings import read_recordings
from armscope.recordings.importing.draft import FORMATS, draft_mapping
from armscope.recordings.importing.formats import Time
from armscope.recordings.importing.tables import import_recordings
from tests.recordings.test_draft import ANGLES, POINTS, axes, names, written

STEP_S = 90.0
MOMENTS = pd.Timestamp("2026-03-13 08:15:00") + pd.to_timedelta(STEP_S * np.arange(len(ANGLES)), unit="s")


def drafted(folder, **more):
    file = written(folder, {**more, **names("J{}", np.degrees(ANGLES)), **axes("{}", POINTS)}, delimiter=";")
    return file, draft_mapping(file)


@pytest.mark.parametrize(
    ("name", "style"),
    [
        ("Zeit", "%d.%m.%Y %H:%M:%S"),
        ("Datum", "%Y-%m-%d %H:%M:%S"),
        ("Date/Time", "%m/%d/%Y %I:%M:%S %p"),
        ("timestamp", "%Y-%m-%dT%H:%M:%S.%f"),
        ("Uhrzeit", "%H:%M:%S"),
    ],
)
def test_stamps_that_rise_are_drafted_as_a_guess_and_become_seconds(name, style, tmp_path):
    file, text = drafted(tmp_path, **{name: MOMENTS.strftime(style)})
    line = next(line for line in text.splitlines() if line.startswith("  time: "))
    assert "guessed" in line
    assert "not used" not in text
    mapping = tmp_path / "mapping.yaml"
    mapping.write_text(text)
    import_recordings([file], mapping, tmp_path / "recordings.csv")
    assert np.allclose(read_recordings(tmp_path / "recordings.csv").time, STEP_S * np.arange(len(ANGLES)))


def test_a_day_beside_a_clock_that_rises_is_no_time(tmp_path):
    _, text = drafted(tmp_path, Datum=MOMENTS.strftime("%d.%m.%Y"), Zeit=MOMENTS.strftime("%H:%M:%S"))
    assert yaml.safe_load(text)["columns"]["time"] == {"column": "Zeit", "format": "%H:%M:%S"}


@pytest.mark.parametrize("cells", [MOMENTS[::-1].strftime("%H:%M:%S"), ["soon"] * len(ANGLES), [""] * len(ANGLES)])
def test_what_does_not_rise_or_is_no_stamp_is_not_taken(cells, tmp_path):
    _, text = drafted(tmp_path, Zeit=list(cells))
    assert "  time: " not in text


def test_every_format_that_is_tried_is_one_of_a_mapping_and_stands_once():
    assert all(Time(column="Zeit", format=each).unit is None for each in FORMATS)
    assert len(set(FORMATS)) == len(FORMATS)
