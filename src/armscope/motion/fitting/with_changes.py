"""The selection once more, with what a scan found to change within a run among what competes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from armscope.core.types import Progress
from armscope.motion.fitting.load_changes import load_changes
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import model_of, select_causes
from armscope.motion.library.causes import Seen
from armscope.motion.library.changes import place_changes
from armscope.motion.library.changes_catalogue import CHANGES
from armscope.motion.samples.preparation import Preparation
from armscope.motion.samples.timing import Stretch


def with_changes(
    selected: SelectedCauses,
    seen: Seen,
    stretches: Sequence[Stretch],
    how: Preparation,
    progress: Progress,
) -> SelectedCauses:
    """A selection in which loads that come and go compete, too, where a scan found any; the same where none has a name.

    Args:
        selected: without them.
        seen: of the table.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.
        progress: hears what is being done.

    Returns:
        The selection.
    """
    layout = selected.rows.layout
    changes = load_changes(selected, how.cutoff)
    placed = [
        cause
        for change in changes
        for cause in place_changes(seen, change, selected.rows.stated_payload((change.run,)))
    ]
    if not placed:
        return selected
    model = model_of(selected)
    wider = replace(layout, placed=(*layout.placed, *placed))
    wider_selected = select_causes(wider, stretches, how, seen.runs, progress, model)
    chosen = {wider_selected.rows.layout.placed[number].cause for number in wider_selected.best.candidates}
    return wider_selected if chosen & set(CHANGES) else selected
