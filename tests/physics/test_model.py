"""A fitted model is a file of its own: written, read back, it predicts the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.inputs import InputError
from armscope.physics.backgrounds import backgrounds
from armscope.physics.drift import base_shift
from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, moves_the_set_up, predict
from armscope.physics.model_file import load_model, save_model
from armscope.physics.registry import library

from .scenes import ARMS, arm_named, full_table


def model_with_everything(name: str, seed: int) -> FittedModel:
    arm = arm_named(name)
    table = full_table(arm, 40, seed)
    rng = np.random.default_rng(seed)
    turns = Rotation.random(2, rng).as_matrix()
    parts = [
        Part(p, 1e-5 * rng.normal(size=len(p.terms)))
        for p in [*library(arm, table), base_shift(table, 10, 1)]
        if p.family not in ("elastic", "unknown") or p.variant == ""
    ]
    elastic = {"joint_compliance", "bearing_compliance", "base_compliance", "link_bending"}
    parts = [Part(p.placed, p.values * (1e-3 if p.placed.name in elastic else 1.0)) for p in parts]
    background = tuple(Part(p, 1e-6 * rng.normal(size=len(p.terms))) for p in backgrounds(arm, table)["geometric"])
    bases = {run: Base(turn, rng.normal(size=3)) for run, turn in zip(("1", "2"), turns, strict=True)}
    return FittedModel(arm, bases, (), tuple(parts), background)


@pytest.mark.parametrize("name", ARMS)
def test_a_model_read_back_predicts_the_same(name: str, tmp_path: Path) -> None:
    model = model_with_everything(name, seed=4)
    save_model(tmp_path / "model.yaml", model)
    table = full_table(model.arm, 25, seed=9)
    np.testing.assert_allclose(
        predict(load_model(tmp_path / "model.yaml"), table), predict(model, table), rtol=0, atol=1e-12
    )


@pytest.mark.parametrize("name", ARMS)
def test_whatever_can_be_fitted_can_be_read_back(name: str, tmp_path: Path) -> None:
    """Every variant of every effect and of the small errors; drivers of drivers among them."""
    arm = arm_named(name)
    table = full_table(arm, 40, 4)
    families = backgrounds(arm, table).values()
    all_of_them = [*library(arm, table), *(placed for family in families for placed in family)]
    parts = tuple(Part(placed, np.full(len(placed.terms), 1e-6)) for placed in all_of_them)
    save_model(tmp_path / "model.yaml", FittedModel(arm, {}, (), parts, ()))
    read = load_model(tmp_path / "model.yaml").parts
    assert [part.placed.terms for part in read] == [placed.terms for placed in all_of_them]


def test_effects_move_the_prediction_at_all(tmp_path: Path) -> None:
    model = model_with_everything("six-axis", seed=4)
    table = full_table(model.arm, 25, seed=9)
    moved = predict(model, table) - predict(replace(model, parts=()), table)
    assert np.linalg.norm(moved, axis=1).min() > 1e-6


def test_a_context_column_that_the_model_follows_is_asked_for() -> None:
    model = model_with_everything("six-axis", seed=4)
    table = replace(full_table(model.arm, 5, seed=9), temperature=None)
    with pytest.raises(InputError, match="temperature_c"):
        predict(model, table)


def test_a_file_that_is_no_model_is_refused(tmp_path: Path) -> None:
    (tmp_path / "model.yaml").write_text("name: x\n", encoding="utf-8")
    with pytest.raises(InputError, match="armscope model 1"):
        load_model(tmp_path / "model.yaml")


def test_models_move_alike_where_only_zeros_differ() -> None:
    model = model_with_everything("six-axis", 5)
    first, *others = model.parts
    nothing = Part(first.placed, np.zeros(len(first.values)))
    without = replace(model, parts=tuple(others))
    assert without.moves_like(replace(model, parts=(*others, nothing)))
    assert not without.moves_like(model)
    assert not model.moves_like(replace(model, parts=(Part(first.placed, 1.01 * first.values), *others)))
    assert not model.moves_like(replace(model, bases=dict(model.bases)))


def test_what_moves_the_set_up_is_what_moves_the_whole_base_in_time_or_between_runs() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 40, 1)
    placed = [*library(arm, table), base_shift(table, 10, 1), *(p for f in backgrounds(arm, table).values() for p in f)]
    moving = {p.name for p in placed if moves_the_set_up(p) and p.name != "unknown"}
    assert moving == {"base_drift", "base_shift", "base_wander", "loose_target"}
    assert "base_compliance" in {p.name for p in placed if p.location == "base"}
    own = model_with_everything("six-axis", 1).in_its_own_base()
    assert not {part.placed.name for part in own.everything} & moving
    assert "base_compliance" in {part.placed.name for part in own.parts}
