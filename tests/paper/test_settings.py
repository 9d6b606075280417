"""Settings of a step: a small file, or its text; what is wrong with them is one clear error."""

import json

import pytest

from armscope.cli.paper_settings import FigureSettings
from armscope.cli.studies import parsed
from armscope.core.inputs import InputError

PLACE = {"value": [4000, 0, 1500], "source": "assumed"}
STATED = {"value": 1, "source": "assumed"}
NUMBERS = ("accuracy_ppm", "repeatability_ppm", "resolution_um", "readings")
TRACKER = {"position_mm": PLACE} | dict.fromkeys(NUMBERS, STATED)
GIVEN = {"tracker": TRACKER, "figures": ["fig01"]}


def test_a_file_and_its_text_say_the_same(tmp_path):
    file = tmp_path / "figure.json"
    file.write_text(json.dumps(GIVEN))
    assert parsed(FigureSettings, str(file)) == parsed(FigureSettings, json.dumps(GIVEN))


def test_what_is_wrong_is_named_with_its_file(tmp_path):
    with pytest.raises(InputError, match="a JSON file with the settings of this step is needed"):
        parsed(FigureSettings, str(tmp_path / "missing.json"))
    broken = tmp_path / "broken.json"
    broken.write_text('{"figures": [}')
    with pytest.raises(InputError, match=r"broken\.json: line 1, column \d+"):
        parsed(FigureSettings, str(broken))
    broken.write_text(json.dumps({**GIVEN, "figurs": []}))
    with pytest.raises(InputError, match="figurs"):
        parsed(FigureSettings, str(broken))
