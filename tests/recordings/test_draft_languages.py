"""Drafts of tables as they are written elsewhere: names, encodings, signs in and between numbers."""

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.recordings import read_recordings
from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.importing.tables import import_recordings
from tests.recordings.test_draft import ANGLES, POINTS, axes, names, written


@pytest.mark.parametrize(
    ("angle", "load"), [("Eje{}", "Carga útil (kg)"), ("Axe{}", "Charge (kg)"), ("关节{}", "负载")]
)
def test_names_in_other_languages_are_known(angle, load, tmp_path):
    file = written(
        tmp_path, names(angle, np.degrees(ANGLES)) | axes("{} [mm]", POINTS) | {load: 2.0 + ANGLES[:, 0] ** 2}
    )
    read = imported_by(file, draft_mapping(file), tmp_path)
    np.testing.assert_allclose(read.payload, 2 + ANGLES[:, 0] ** 2, atol=1e-6)
    np.testing.assert_allclose(read.motor_angles, ANGLES, atol=1e-6)


def imported_by(file, text, folder):
    (folder / "mapping.yaml").write_text(text, encoding="utf-8")
    import_recordings([file], folder / "mapping.yaml", folder / "recordings.csv")
    return read_recordings(folder / "recordings.csv")


def test_names_that_are_not_known_in_another_encoding_are_told_so(tmp_path):
    (tmp_path / "foreign.csv").write_bytes("Zapięście1,Zapięście2,X,Y,Z\n1,2,3,4,5\n".encode("cp1250"))
    with pytest.raises(InputError, match="not UTF-8: if names look wrong, save it as `CSV UTF-8`"):
        draft_mapping(tmp_path / "foreign.csv")


def test_quoted_decimal_commas_and_thousands_are_drafted_and_imported(tmp_path):
    columns = names("J{}", np.degrees(ANGLES)) | axes("{} [mm]", POINTS)
    for write, sign in ((german, "."), (english, ","), (french, " ")):
        file = tmp_path / "foreign.csv"
        rows = [",".join(f'"{write(value)}"' for value in row) for row in zip(*columns.values(), strict=True)]
        file.write_text("\n".join([",".join(columns), *rows]), encoding="utf-8")
        text = draft_mapping(file)
        assert f'thousands: "{sign}"' in text
        assert "drop_missing" not in text
        np.testing.assert_allclose(imported_by(file, text, tmp_path).positions * 1e3, POINTS, atol=1e-3)


def english(value):
    return f"{value:,.4f}"


def german(value):
    return english(value).translate(str.maketrans(",.", ".,"))


def french(value):
    return english(value).replace(",", "\u202f").replace(".", ",")
