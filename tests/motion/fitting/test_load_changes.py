"""Where a load is there: the likeliest sequence, and cells judged by their sums, against all that there are."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from armscope.core.types import Array, unheard
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting.load_cells import Cells, JointRows
from armscope.motion.fitting.load_changes import as_likely, likeliest, load_changes
from armscope.motion.fitting.selection import select_causes
from armscope.motion.fitting.with_changes import with_changes
from armscope.motion.library.changes import Change
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import stretches
from tests.motion.moving import moved, robot

NO_LOAD = Change("path 2", False, (6.0,), 0.01, np.array([1.0, 0.3, 0.0, 0.0]), 300)


@pytest.mark.parametrize("price", [0.1, 0.7, 3.0])
def test_the_likeliest_sequence_is_the_best_of_all(price: float) -> None:
    worth = np.random.default_rng(3).normal(size=11)
    all_of_them = np.array(list(itertools.product((False, True), repeat=len(worth))))
    scores = all_of_them @ worth - price * np.sum(np.diff(all_of_them.astype(int), axis=1) != 0, axis=1)
    assert likeliest(worth, price).tolist() == all_of_them[np.argmax(scores)].tolist()


def test_rows_that_tell_nothing_leave_the_moment_open() -> None:
    """By all sequences whose one moment lies elsewhere: those within two nats."""
    rng = np.random.default_rng(5)
    true = np.arange(40) >= 18
    worth = np.where(true, 1.0, -1.0) * rng.uniform(2.5, 6.0, 40)
    worth[12:22] = rng.normal(0, 0.02, 10)
    found = likeliest(worth, 3.0)
    (k,) = np.flatnonzero(np.diff(found.astype(int)))
    nats = [float(worth[after + 1 :].sum()) for after in range(39)]
    as_good = [after for after in range(39) if nats[after] > nats[k] - 2]
    assert as_likely(worth, found, int(k)) == (min(as_good), max(as_good)) == (11, 21)
    goes_again = np.arange(40) < 30
    worth, found = np.where(goes_again, worth, -np.abs(worth)), found & goes_again
    assert as_likely(worth, found, int(k)) == (11, 21)
    assert as_likely(worth, found, 29) == (29, 29)


def made(rng: np.random.Generator, there: Array, load: Array) -> JointRows:
    X, L = rng.normal(size=(len(there), 3)), rng.normal(size=(len(there), 4))
    y = X @ [1.0, -2.0, 0.5] + there * (L @ load) + 0.3 * rng.normal(size=len(there))
    row = rng.uniform(0.5, 1.0, len(there))
    return JointRows(np.arange(3), X, L, y, row, X.T @ (row[:, None] * X), X.T @ (row * y))


def explained(joints: list[JointRows], there: Array, ridge: Array, prior: Array) -> float:
    """Nats by which the columns and a load in some rows explain more than the columns, by plain least squares."""

    def penalised(with_load: bool) -> float:
        blocks, right = [np.diag(np.sqrt(ridge))], [np.zeros(3)]
        if with_load:
            blocks = [np.block([[blocks[0], np.zeros((3, 4))], [np.zeros((4, 3)), np.diag(np.sqrt(prior))]])]
            right = [np.zeros(7)]
        for own in joints:
            columns = np.hstack([own.X, there[:, None] * own.L]) if with_load else own.X
            blocks.append(np.sqrt(own.row)[:, None] * columns)
            right.append(np.sqrt(own.row) * own.y)
        A, y = np.vstack(blocks), np.concatenate(right)
        return float(np.sum((y - A @ np.linalg.lstsq(A, y, rcond=None)[0]) ** 2))

    return (penalised(False) - penalised(True)) / 2


def test_a_spell_more_explains_what_plain_least_squares_say() -> None:
    rng, rows = np.random.default_rng(4), 80
    true = np.zeros(rows)
    true[8:24], true[48:64] = 1.0, 1.0
    joints = [made(rng, true, np.array([0.6, 0.2, -0.3, 0.1])) for _ in range(2)]
    cells, unit = Cells(joints, 3), np.ones(2)
    ridge, prior = np.full(3, 1e-3), np.full(4, 0.1)
    A, b = sum(own.A for own in joints), sum(own.b for own in joints)
    there = np.zeros(cells.count, dtype=bool)
    so_far = 0.0
    for _ in range(2):
        there, gained = cells.with_another_spell(there, unit, (A, b, ridge), prior)
        now = explained(joints, cells.rows(there).astype(float), ridge, prior)
        assert gained == pytest.approx(now - so_far, rel=1e-6)
        so_far = now
    assert cells.rows(there).astype(float).tolist() == true.tolist()
    _, more = cells.with_another_spell(there, unit, (A, b, ridge), prior)
    assert more < 3


@pytest.mark.long
@pytest.mark.parametrize("found", [(), (NO_LOAD,)])
def test_a_selection_stays_as_it_is_where_no_change_gets_a_name(
    found: tuple[Change, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another round from another start may end elsewhere: only a change that has a name is reason for that."""
    arm = robot()
    motions = moved(arm, 2, noise=0.005, seconds=10.0)
    laid = list(stretches(motions))
    seen = seen_in(arm, laid, LIBRARY.still_rad)
    layout = TorqueLayout(arm, tuple(place_causes(seen)), False)
    how = preparation(200.0, 10.0, "as asked")
    selected = select_causes(layout, laid, how, seen.runs, unheard)
    assert load_changes(selected, how.cutoff) == []
    monkeypatch.setattr("armscope.motion.fitting.with_changes.load_changes", lambda *_: list(found))
    assert with_changes(selected, seen, laid, how, unheard) is selected
