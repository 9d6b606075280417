"""The set must keep the best model as often as it says, and drop what is clearly worse."""

from __future__ import annotations

import numpy as np

from armscope.inference.confidence_set import confidence_set


def losses(rng: np.random.Generator, extra: list[float], blocks: int = 30) -> np.ndarray:
    """Chi squared of ten numbers a block, much of it common to all models, with what each loses on average."""
    common = rng.chisquare(10, (blocks, 1))
    return common + rng.normal(0.0, 1.0, (blocks, len(extra))) + np.array(extra)


def test_the_best_of_equal_models_stays_as_often_as_promised() -> None:
    rng = np.random.default_rng(1)
    kept = [confidence_set(losses(rng, [0.0, 0.0, 0.0]), rng) for _ in range(300)]
    # any of the three is a best one: each must be kept in 95 % of the draws, less three standard errors
    assert np.mean(kept, axis=0).min() > 0.95 - 3 * np.sqrt(0.05 * 0.95 / 300)
    assert not np.all(kept)


def test_what_is_clearly_worse_leaves_and_what_is_hardly_worse_stays() -> None:
    rng = np.random.default_rng(2)
    assert confidence_set(losses(rng, [0.0, 0.02, 3.0, 0.0, 9.0]), rng).tolist() == [True, True, False, True, False]


def test_few_blocks_exclude_nothing_and_identical_models_both_stay() -> None:
    rng = np.random.default_rng(3)
    assert confidence_set(losses(rng, [0.0, 50.0], blocks=4), rng).all()
    same = losses(rng, [0.0])
    assert confidence_set(np.column_stack([same, same, same + 1.0]), rng).tolist() == [True, True, False]
