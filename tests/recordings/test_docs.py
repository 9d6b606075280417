"""The mappings that the documentation shows are mappings."""

import re
from pathlib import Path

import yaml

from armscope.inputs import validate
from armscope.recordings.mapping import Columns, Mapping

PAGE = Path(__file__).parents[2] / "docs" / "bring-your-recordings.md"


def test_every_mapping_on_the_page_is_valid_and_every_group_is_explained():
    text = PAGE.read_text()
    blocks = re.findall(r"```yaml\n(.*?)```", text, flags=re.DOTALL)
    assert len(blocks) == 2
    for block in blocks:
        validate(Mapping, yaml.safe_load(block), PAGE)
    for group in Columns.model_fields:
        assert f"`{group}`" in text, group
