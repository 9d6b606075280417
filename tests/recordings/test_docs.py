"""The mappings and the arm that the documentation shows can be used."""

import re
from pathlib import Path

import yaml

from armscope.core.inputs import validate
from armscope.recordings.importing.mapping import Columns, Mapping
from armscope.robot import RobotDescription

PAGE = Path(__file__).parents[2] / "docs" / "bring-your-recordings.md"


def test_every_mapping_on_the_page_is_valid_and_every_group_is_explained():
    text = PAGE.read_text()
    contents = [yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", text, flags=re.DOTALL)]
    arms = [content for content in contents if "urdf" in content]
    assert (len(contents), len(arms)) == (3, 1)
    for content in contents:
        validate(RobotDescription if content in arms else Mapping, content, PAGE)
    for group in Columns.model_fields:
        assert f"`{group}`" in text, group
