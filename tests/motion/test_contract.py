"""verdict.json of a motion: what is written is what the published schema says, and is read back."""

from __future__ import annotations

import importlib.resources
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from armscope.core.files import as_json
from armscope.core.inputs import InputError
from armscope.motion import contract
from armscope.motion.verdict import MotionVerdict, read_motion_verdict

KEPT = Path(__file__).parents[1] / "fuzz" / "corpus" / "motion-verdict" / "moving-arm.json"


def published() -> Any:
    return json.loads((importlib.resources.files("armscope.motion") / "verdict.schema.json").read_text("utf-8"))


def test_the_published_schema_is_the_one_that_the_types_generate() -> None:
    told = "regenerate it: armscope schema motion-verdict > src/armscope/motion/verdict.schema.json"
    assert published() == contract.schema(), told


def test_what_the_clock_says_is_no_result() -> None:
    """The same command writes the same bytes; found by the campaign."""
    assert "seconds" not in published()["properties"]


def test_a_verdict_is_written_as_the_schema_says_and_read_back() -> None:
    verdict = read_motion_verdict(KEPT)
    nobody = replace(verdict.effects[0].parameters[0], stderr=math.nan)
    verdict = replace(verdict, effects=(replace(verdict.effects[0], parameters=(nobody,)), *verdict.effects[1:]))
    content = json.loads(as_json(verdict.to_json()))
    jsonschema.validate(content, published())
    assert content["effects"][0]["parameters"][0]["interval_95"] == [None, None]
    again = MotionVerdict.from_json(content)
    assert math.isnan(again.effects[0].parameters[0].stderr)
    assert as_json(again.to_json()) == as_json(content)
    assert again.unexplained == verdict.unexplained
    assert again.held_out.by_run == verdict.held_out.by_run


@pytest.mark.parametrize(
    ("changes", "named"), [({"format": "armscope verdict 2"}, "format"), ({"effects": [{"effect": 1}]}, "effects")]
)
def test_what_is_no_verdict_of_a_motion_is_refused_with_its_place(changes: dict[str, Any], named: str) -> None:
    content = json.loads(KEPT.read_text(encoding="utf-8")) | changes
    with pytest.raises(InputError, match=named):
        MotionVerdict.from_json(content)
