"""The configuration, its schema and its classes stay in step."""

import json
from pathlib import Path

import pytest

from armscope.core.config import Config, schema, stated_numbers
from armscope.core.inputs import InputError, load, read_yaml, validate

ROOT = Path(__file__).parents[2]
DEFAULT = ROOT / "config" / "config.yaml"


def test_the_default_configuration_is_valid():
    assert load(Config, DEFAULT).paper.swarm.particles == 100


def test_the_committed_schema_is_the_one_the_classes_generate():
    committed = json.loads((ROOT / "workflow" / "schemas" / "config.schema.json").read_text())
    assert committed == schema(), "regenerate it: armscope schema > workflow/schemas/config.schema.json"


def test_the_defaults_in_the_file_are_those_of_the_classes():
    content = read_yaml(DEFAULT)
    for section in ("swarm", "ensemble"):
        typed = type(getattr(load(Config, DEFAULT).paper, section))()
        assert content["paper"][section] == json.loads(typed.model_dump_json())


def test_every_assumed_number_has_a_source():
    rows = stated_numbers(load(Config, DEFAULT).paper)
    assert len(rows) > 15
    assert all("assumed" in row["source"] or "Sec." in row["source"] for row in rows)


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"paper": {"swarm": {"particles": 1}}}, "paper.swarm.particles"),
        ({"paper": {"swarm": {"update": "constricton"}}}, "paper.swarm.update"),
        ({"paper": {"swarm": {"partcles": 10}}}, "paper.swarm.partcles"),
        ({"paper": {"swarm": {"iterations": 0}}}, "paper.swarm.iterations"),
        ({"paper": {"identification": {"poses": {"value": 47}}}}, "paper.identification.poses.value"),
        ({"paper": {"identification": {"candidates": {"value": 84}}}}, "paper.identification.candidates"),
        ({"seed": -1}, "seed"),
        ({"results": "/tmp/with space"}, "results"),
        ({"results": "results/$HOME"}, "results"),
        ({"recordings_dir": "../it's"}, "recordings_dir"),
        ({"fleet": "a;b.csv"}, "fleet"),
        ({"sed": 1}, "sed"),
    ],
)
def test_a_wrong_key_type_or_range_is_named(change, place):
    content = read_yaml(DEFAULT)
    _merge(content, change)
    with pytest.raises(InputError) as caught:
        validate(Config, content, "config.yaml")
    assert caught.value.place == place


def test_a_folder_that_a_shell_would_cut_in_two_is_refused_with_what_is_allowed():
    content = read_yaml(DEFAULT) | {"results": "/tmp/with space"}
    with pytest.raises(InputError, match=r"results: found '/tmp/with space'; a path of letters.*no spaces.*link"):
        validate(Config, content, "config.yaml")
    for path in ("/tmp/Büro/süd-2", "results/seed=7", "../x.y/z_1"):
        assert validate(Config, content | {"results": path}, "config.yaml").results == path


def test_too_few_poses_are_refused_with_how_many_are_needed_and_why():
    """Two ended in a traceback, twenty in another one, or in an error that blamed the recordings."""
    content = read_yaml(DEFAULT)
    _merge(content, {"paper": {"identification": {"poses": {"value": 20}}}})
    with pytest.raises(
        InputError, match=r"found 20; 48 or more: the largest error model has 25 terms.*The paper has 85"
    ):
        validate(Config, content, "config.yaml")


def _merge(content, change):
    for key, value in change.items():
        if isinstance(value, dict):
            _merge(content[key], value)
        else:
            content[key] = value
