"""Friction that is not the same in all runs, and follows nothing that was recorded: gears that warm up, as a rule.

What is learned from other motion foretells no such thing (`armscope.motion.summary.lasting`), and evidence asks for no
law of it: it would count as noise, and nothing would be missing. But each run by itself tells its own friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.search import Search
from armscope.motion.fitting.consistency import combination_by_block
from armscope.motion.fitting.constants import CONSISTENCY
from armscope.motion.fitting.selected import SelectedCauses, coefficients_of
from armscope.motion.library.clauses import run_in_words
from armscope.motion.library.layout import NAMED_OF_OWN, OWN
from armscope.motion.samples.constants import FILTER
from armscope.motion.summary.constants import LASTING
from armscope.motion.summary.lasting import LastingTorque
from armscope.verdict.wording import percent

KINDS = {"viscous": "speed", "coulomb": "direction"}
"""Frictions, and what each follows, in words."""


@dataclass(frozen=True)
class _Departure:
    """By how much a joint's friction is another one in each block: (K,) N m; as a share of all, where it is most."""

    torque: Array
    most: float = 0.0
    block: int = 0


def friction_by_run(selected: SelectedCauses) -> tuple[LastingTorque, ...]:
    """Joints whose friction differs from run to run, or within a single one from part to part; largest share first.

    Args:
        selected: the selection.

    Returns:
        What of each joint's torque that is, by the friction that differs more.
    """
    rows, found = selected.rows, []
    ordinary = Search.on(selected.problem).perfect()
    before = rows.torque - rows.nominal - rows.modelled(coefficients_of(selected.problem, ordinary))
    where = "run" if len(set(rows.run.tolist())) > 1 else "part of the motion"
    for j in range(rows.torque.shape[1]):
        which = selected.weights.row[:, j] > 0
        if np.sum(which) < LASTING.least_rows:
            continue
        departs = {kind: _departing(selected, j, kind) for kind in KINDS}
        power, kind = max((float(np.mean(each.torque[which] ** 2)), kind) for kind, each in departs.items())
        share = power / max(float(np.mean(before[which, j] ** 2)), 1e-300)
        if share > LASTING.share and power > LASTING.repeats * float(np.mean(selected.residuals[which, j] ** 2)):
            rms, torque = float(np.sqrt(power)), float(np.sqrt(np.mean(rows.torque[which, j] ** 2)))
            words = f"{KINDS[kind]}, otherwise in each {where}: {_in_words(selected, departs[kind])}"
            found.append(LastingTorque(j, words, rms, rms / max(torque, 1e-300), share))
    return tuple(sorted(found, key=lambda each: -each.share))


def _departing(selected: SelectedCauses, joint: int, kind: str) -> _Departure:
    """Of one kind of a joint's friction; nothing where blocks agree."""
    rows, none = selected.rows, _Departure(np.zeros(len(selected.rows)))
    column = OWN * joint + NAMED_OF_OWN.index(kind)
    if column not in selected.best.columns:
        return none
    columns, weights = _in_all(selected, joint, column)
    fitted = float(weights @ selected.coefficients[columns])
    whole = fitted + float(np.nan_to_num(rows.layout.arm.stated_background[joint, column % OWN]))
    if whole <= 0:
        return none
    ordinary = [OWN * joint + NAMED_OF_OWN.index(each) for each in KINDS]
    free = np.intersect1d(ordinary, selected.best.columns)
    size, error = (each / whole for each in combination_by_block(selected, columns, weights, free))
    telling = np.flatnonzero(error < CONSISTENCY.telling)
    if len(telling) < 2:
        return none
    least, most = telling[np.argmin(size[telling])], telling[np.argmax(size[telling])]
    apart = size[most] - size[least]
    if apart < max(CONSISTENCY.tolerance, CONSISTENCY.widths * float(np.hypot(error[most], error[least]))):
        return none
    more = np.zeros(len(size))
    more[telling] = size[telling] - np.average(size[telling], weights=error[telling] ** -2)
    values = rows.columns[joint][:, np.searchsorted(rows.at[joint], column)].astype(np.float64)
    other = np.where(error < CONSISTENCY.telling, size - np.median(size[telling]), 0.0)
    block = int(np.argmax(np.abs(other)))
    return _Departure(np.asarray(whole * more[selected.block] * values), float(other[block]), block)


def _in_all(selected: SelectedCauses, joint: int, column: int) -> tuple[Indices, Array]:
    """(c,) columns of a joint's whole friction, and how much of one kind each of them has in it.

    A law over speed, or of the torque, takes part of dry friction and gives it back, in each run otherwise: the one
    number differs where friction is the same.
    """
    rows, best, at = selected.rows, selected.best, selected.rows.at[joint]
    own = [rows.layout.columns[n] for n in best.candidates if rows.layout.placed[n].joints == (joint,)]
    named = np.concatenate([OWN * joint + np.arange(OWN), *own])
    columns = np.intersect1d(np.intersect1d(named, at), best.columns)
    which = np.flatnonzero(selected.weights.row[:, joint] > 0)
    X = rows.columns[joint][which[:: -(-len(which) // LASTING.rows)]].astype(np.float64)
    plain = [OWN * joint + NAMED_OF_OWN.index(kind) for kind in NAMED_OF_OWN]
    basis = X[:, np.searchsorted(at, np.concatenate([plain, rows.layout.inertial]))]
    told = np.linalg.lstsq(basis, X[:, np.searchsorted(at, columns)], rcond=FILTER.single)[0]
    return columns, told[plain.index(column)]


def _in_words(selected: SelectedCauses, departs: _Departure) -> str:
    """Where friction is another one by most, and by how much."""
    run = selected.rows.run
    of_block = str(run[np.argmax(selected.block == departs.block)])
    where = run_in_words(of_block) if len(set(run.tolist())) > 1 else f"part {departs.block + 1}"
    more = f"{percent(abs(departs.most))} {'higher' if departs.most > 0 else 'lower'}"
    return f"friction is {more} in {where} than in the middle one (gears that warm up, or a brake that drags)"
