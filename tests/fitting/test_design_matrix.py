"""Sums over rows by direction, against the columns written out."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.fitting import design_matrix
from armscope.fitting.design_matrix import StructuredDesign, component_rows, grouped_columns, structured_design
from armscope.fitting.registration import fit_frames
from armscope.measurement.channel import ORIENTATIONS, POSITIONS
from armscope.measurement.whitening import WhitenedPosture, Whitener
from armscope.physics.effect import Driver, Term, motor, term
from armscope.physics.registry import library
from tests.diagnosis.planted import planted

ROWS = 30
Seen = tuple[WhitenedPosture, tuple[Term, ...]]


@pytest.fixture(scope="module", params=[False, True], ids=["points", "with orientations"])
def seen(request: pytest.FixtureRequest) -> Seen:
    """An arm's posture under uneven weights, and the library's terms."""
    arm, table = planted("six-axis", {}, ROWS, 0.03, seed=2)
    model = fit_frames(arm, table)
    rng = np.random.default_rng(0)
    turns = ((ORIENTATIONS, rng.uniform(0.1, 2.0, ROWS)),) if request.param else ()
    whitener = Whitener(((POSITIONS, rng.normal(size=(ROWS, 3, 3))), *turns))
    terms = tuple(dict.fromkeys(t for placed in library(arm, table) for t in placed.terms))
    return WhitenedPosture(model.posture(model.scene(table)), whitener), terms


def written_out(posture: WhitenedPosture, terms: tuple[Term, ...]) -> np.ndarray:
    return component_rows(posture, terms).reshape(len(terms), -1)


def test_the_library_turns_motors_by_many_drivers(seen: Seen) -> None:
    column_order = grouped_columns(seen[1])
    assert {group.direction.axis for group in column_order.groups} == {"turn"}
    assert sorted(column_order.order) == list(range(len(seen[1])))
    assert len(column_order.others) < len(seen[1]) / 2


def test_products_of_columns_are_those_of_the_columns_written_out(
    seen: Seen,
) -> None:
    posture, terms = seen
    X, column_order = written_out(posture, terms), grouped_columns(terms)
    stack, size = structured_design(posture, column_order), np.abs(X).max() ** 2 * X.shape[1]
    total = np.zeros((len(terms), len(terms)))
    stack.add_products(total)
    np.testing.assert_allclose(column_order.whole(total), X @ X.T, atol=1e-12 * size)
    y = np.random.default_rng(1).normal(size=(posture.width, ROWS))
    np.testing.assert_allclose(stack.rmatvec(y)[column_order.back], X @ y.reshape(-1), atol=1e-12 * size)
    both = stack.with_responses(np.stack([y, y**2]))[column_order.back]
    np.testing.assert_allclose(both, X @ np.stack([y, y**2]).reshape(2, -1).T, atol=1e-12 * size)
    values = np.random.default_rng(2).normal(size=(2, len(terms)))
    combined = stack.matvec(values[:, column_order.order])
    np.testing.assert_allclose(combined.reshape(2, -1), values @ X, atol=1e-12 * size)


def test_products_with_other_columns(seen: Seen) -> None:
    posture, terms = seen
    waves = tuple(term(f"{n}", "", (motor(2), Driver("sine", (2, n)))) for n in range(1, 20))
    few = (*terms[:5], *waves)
    here, there = grouped_columns(terms), grouped_columns(few)
    assert there.groups
    products = structured_design(posture, here).products(structured_design(posture, there))[
        np.ix_(here.back, there.back)
    ]
    expected = written_out(posture, terms) @ written_out(posture, few).T
    np.testing.assert_allclose(products, expected, atol=1e-12 * np.abs(expected).max())


def test_products_within_blocks_of_one_direction_and_what_is_kept_of_it(seen: Seen) -> None:
    posture, _ = seen
    waves = tuple(term(f"{k} {n}", "", (motor(2), Driver(k, (2, n)))) for n in range(1, 20) for k in ("sine", "cosine"))
    order, X = grouped_columns(waves), written_out(posture, waves)
    assert order.is_one_group
    assert not grouped_columns((*waves, *seen[1])).is_one_group
    stack = structured_design(posture, order)
    expected = np.stack([X[at : at + 2] @ X[at : at + 2].T for at in range(0, len(waves), 2)])
    np.testing.assert_allclose(stack.within_blocks(19), expected, atol=1e-12 * np.abs(expected).max())
    assert structured_design(posture, order).drivers[0] is stack.drivers[0], "the waves are those of every posture"
    loads = tuple(term(f"{n}", "", (motor(2), Driver("gravity torque", (2,))), si=n) for n in range(1, 20))
    kept = [structured_design(posture, grouped_columns(loads)).drivers[0] for _ in range(2)]
    assert kept[0] is not kept[1]


def test_of_a_table_of_several_chunks_no_drivers_are_kept(seen: Seen, monkeypatch: pytest.MonkeyPatch) -> None:
    """They would take as much memory as all else does of 100,000 rows."""
    monkeypatch.setattr(design_matrix, "STEPS", replace(design_matrix.STEPS, chunk_rows=ROWS))
    waves = tuple(term(f"sine {n}", "", (motor(2), Driver("sine", (2, n)))) for n in range(40, 60))
    one, again = (structured_design(seen[0], grouped_columns(waves)).drivers[0] for _ in range(2))
    assert one is not again
    np.testing.assert_array_equal(one, again)


def test_some_rows_and_their_rest_make_all_rows(seen: Seen) -> None:
    posture, terms = seen
    stack = structured_design(posture, grouped_columns(terms))

    def products(part: StructuredDesign) -> np.ndarray:
        total = np.zeros((len(terms), len(terms)))
        part.add_products(total)
        return total

    parts = products(stack.at(slice(0, 7))) + products(stack.at(np.arange(7, ROWS)))
    whole = products(stack)
    np.testing.assert_allclose(parts, whole, atol=1e-12 * np.abs(whole).max())
