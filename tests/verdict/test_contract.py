"""verdict.json and model.yaml: what is written is read back, and both are what their published schemas say."""

from __future__ import annotations

import importlib.resources
import json
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.core.inputs import InputError
from armscope.diagnosis import Diagnosis, Settings, diagnose, write_verdict
from armscope.physics import model_file
from armscope.recordings import read_recordings
from armscope.robot import load_arm
from armscope.verdict import contract, filenames
from armscope.verdict.effects import Parameter
from armscope.verdict.files import read_verdict
from armscope.verdict.schema import Background, Notice, Orientations, Unexplained, Verdict, WaterfallStep
from tests.report.verdicts import CASES

EXAMPLES = Path(__file__).parents[2] / "examples"
PUBLISHED = {
    "verdict": importlib.resources.files("armscope.verdict") / "verdict.schema.json",
    "model": importlib.resources.files("armscope.physics") / "model.schema.json",
}


def published(name: str) -> Any:
    return json.loads(PUBLISHED[name].read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Diagnosis, Path]:
    """A real diagnosis and its folder."""
    folder, example = tmp_path_factory.mktemp("found"), EXAMPLES / "five-effects"
    arm = load_arm(example / "robot.yaml")
    table = read_recordings(example / "recordings.csv", arm.n_motors)
    verdict = diagnose(arm, table, Settings(resamples=0, cross_validation=False))
    write_verdict(verdict, folder)
    return verdict, folder


@pytest.mark.parametrize("name", ["verdict", "model"])
def test_the_published_schema_is_the_one_that_the_types_generate(name: str) -> None:
    generated = {"verdict": contract.schema, "model": model_file.schema}[name]()
    path = {"verdict": "src/armscope/verdict/verdict", "model": "src/armscope/physics/model"}[name]
    assert published(name) == generated, f"regenerate it: armscope schema {name} > {path}.schema.json"


def test_a_diagnosis_writes_no_file_that_was_not_announced(written: tuple[Diagnosis, Path]) -> None:
    """What an output can't be is told before the tables are read, by these names."""
    made = {path.name for path in written[1].iterdir() if not path.name.startswith(".")}
    assert filenames.VERDICT in made
    assert made <= set(filenames.FILES)


def test_what_a_diagnosis_writes_is_what_the_schemas_say(written: tuple[Diagnosis, Path]) -> None:
    folder = written[1]
    jsonschema.validate(json.loads((folder / "verdict.json").read_text(encoding="utf-8")), published("verdict"))
    jsonschema.validate(yaml.safe_load((folder / "model.yaml").read_text(encoding="utf-8")), published("model"))


def test_a_schema_refuses_what_lacks_a_key_or_has_a_word_for_a_number() -> None:
    content = plain(CASES["five"]().verdict)
    for key in contract.VerdictFile.model_fields:
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate({k: v for k, v in content.items() if k != key}, published("verdict"))
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(content | {"noise_mm": "small"}, published("verdict"))


def plain(verdict: Verdict) -> Any:
    """The content of verdict.json as a reader gets it."""
    return _null(verdict.to_json())


def _null(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _null(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_null(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


def in_the_file(verdict: Verdict) -> dict[str, str]:
    """Every attribute that the file holds, comparable with NaN in it."""
    with np.printoptions(legacy="1.25"):  # numpy's numbers look like Python's
        return {field.name: repr(getattr(verdict, field.name)) for field in fields(Verdict) if field.name != "effects"}


@pytest.mark.parametrize("name", sorted(CASES))
def test_a_verdict_is_read_back_as_it_was_written(name: str) -> None:
    verdict = CASES[name]().verdict
    content = plain(verdict)
    jsonschema.validate(content, published("verdict"))
    again = Verdict.from_json(json.loads(json.dumps(content)))
    assert plain(again) == content
    assert in_the_file(again) == in_the_file(verdict)
    for effect, one in zip(again.effects, verdict.effects, strict=True):
        assert effect.parameters == one.parameters
        assert effect.alternatives == one.alternatives
        assert effect.description == (one.curve.description if one.curve else "")
        assert effect.curve is None


def test_a_real_verdict_is_read_back_from_its_file(written: tuple[Diagnosis, Path]) -> None:
    verdict, folder = written
    again = read_verdict(folder / "verdict.json")
    assert plain(again) == plain(verdict)
    assert [effect.evidence_nats for effect in again.effects] == [effect.evidence_nats for effect in verdict.effects]


words = st.text(max_size=12)
sizes = st.one_of(st.just(float("nan")), st.floats(-1e6, 1e6))


@settings(max_examples=40)
@given(
    noise=sizes,
    mismatch=st.sampled_from([None, True, False]),
    headline=words,
    unexplained=st.builds(Unexplained, st.booleans(), st.none() | words, st.none() | words, sizes, words),
    background=st.builds(Background, words, st.booleans(), sizes, sizes, sizes),
    steps=st.lists(st.builds(WaterfallStep, words, sizes, sizes, sizes, st.booleans()), max_size=3),
    notices=st.lists(st.builds(Notice, words, words), max_size=3),
    seen=st.none() | st.builds(Orientations, st.integers(0, 99), sizes, sizes, sizes),
)
def test_whatever_a_verdict_says_is_read_back(
    noise: float,
    mismatch: bool | None,
    headline: str,
    unexplained: Unexplained,
    background: Background,
    steps: list[WaterfallStep],
    notices: list[Notice],
    seen: Orientations | None,
) -> None:
    verdict = replace(
        BASE,
        noise_mm=noise,
        mismatch=mismatch,
        headline=headline,
        unexplained=unexplained,
        background=background,
        waterfall=tuple(steps),
        notices=tuple(notices),
        orientations=seen,
    )
    again = Verdict.from_json(json.loads(json.dumps(plain(verdict))))
    assert in_the_file(again) == in_the_file(verdict)


BASE = CASES["single"]().verdict


def test_the_95_percent_interval_is_the_parameters_own() -> None:
    (effect,) = BASE.to_json()["effects"]
    value = Parameter("compliance", "rad/(N m)", 2.1e-7, 1e-8)
    assert effect["parameters"][0]["interval_95"] == value.interval


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"format": None}, "format"),
        ({"format": "armscope verdict 1"}, "format"),
        ({"mismatch": "perhaps"}, "mismatch"),
        ({"effects": [{}]}, "effects[0]"),
        ({"held_out_rms_mm": {"before": "x"}}, "held_out_rms_mm.before"),
        ({"notices": "none"}, "notices"),
    ],
)
def test_a_file_that_is_no_verdict_is_refused_with_the_place_of_what_is_wrong(change: Any, place: str) -> None:
    with pytest.raises(InputError) as told:
        Verdict.from_json(plain(BASE) | change, "found/verdict.json")
    assert told.value.place.startswith(place)
    assert "found/verdict.json" in str(told.value)


@pytest.mark.parametrize("content", [None, [], "text", {}])
def test_what_is_no_mapping_is_no_verdict(content: Any) -> None:
    with pytest.raises(InputError, match="armscope verdict 2"):
        Verdict.from_json(content)


@pytest.mark.parametrize(
    ("edit", "place"),
    [
        (lambda m: m.pop("bases"), "bases"),
        (lambda m: m.pop("effects"), "effects"),
        (lambda m: m["effects"][0].update(effect="joint_complience"), "effect"),
        (lambda m: m["effects"][0].update(terms=3), "effects[0].terms"),
        (lambda m: m["effects"][0]["terms"][0].update(value="big"), "effects[0].terms[0].value"),
        (lambda m: m["effects"][0]["terms"][0].update(products=[[1]]), "effects[0].terms[0].products[0]"),
        (lambda m: next(iter(m["bases"].values())).update(rotation=[[1, 0], [0, 1]]), "bases."),
        (lambda m: m["robot"].pop("dh"), "robot"),
    ],
)
def test_an_edited_model_is_refused_with_the_place_of_the_edit(
    written: tuple[Diagnosis, Path], tmp_path: Path, edit: Any, place: str
) -> None:
    content = yaml.safe_load((written[1] / "model.yaml").read_text(encoding="utf-8"))
    edit(content)
    (tmp_path / "model.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    with pytest.raises(InputError) as told:
        model_file.load_model(tmp_path / "model.yaml")
    assert told.value.place.startswith(place)
