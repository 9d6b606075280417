"""The mappings and the arm that the documentation shows can be used."""

import re
from pathlib import Path

import yaml

from armscope.core.inputs import validate
from armscope.recordings.importing.mapping import Columns, Mapping
from armscope.recordings.importing.motions import MotionColumns, MotionMapping
from armscope.robot import RobotDescription

PAGE = Path(__file__).parents[2] / "docs" / "bring-your-recordings.md"


def test_every_mapping_on_the_page_is_valid_and_every_group_is_explained():
    text = PAGE.read_text()
    contents = [yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", text, flags=re.DOTALL)]
    arms = [content for content in contents if "urdf" in content]
    motions = [content for content in contents if "table" in content]
    assert (len(contents), len(arms), len(motions)) == (4, 1, 1)
    for content in contents:
        of_points = Mapping if content not in motions else MotionMapping
        validate(RobotDescription if content in arms else of_points, content, PAGE)
    for group in [*Columns.model_fields, *MotionColumns.model_fields]:
        assert f"`{group}`" in text, group
