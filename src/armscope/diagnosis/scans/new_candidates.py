"""What does not compete yet, and promises something: meshes, nests, jumps, pauses, finer directions, odd turns."""

from __future__ import annotations

from collections.abc import Iterator

from armscope.diagnosis.scans.change_points import jumps
from armscope.diagnosis.scans.context import ScanContext
from armscope.diagnosis.scans.gear_mesh import mesh_lines
from armscope.diagnosis.scans.loose_nests import loose_nests
from armscope.diagnosis.scans.other_joints import turns_with_other_joints
from armscope.diagnosis.scans.pauses import pauses
from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search
from armscope.physics.backgrounds import DRIFT, FAMILIES
from armscope.physics.drift import BASE_DRIFT
from armscope.physics.effect import Placed
from armscope.physics.geometric import finer_bars
from armscope.physics.loose_target import LOOSE_TARGET
from armscope.physics.scene import Scene


def scanned_candidates(context: ScanContext, search: Search, best: Hypothesis, most: int) -> list[Placed]:
    """New candidates whose scanned numbers promise something, given the best hypothesis and given none.

    Args:
        context: the rows where the problem was linearised.
        search: of the problem.
        best: the best hypothesis, with names.
        most: periods per turn up to which a gear's lines are scanned.

    Returns:
        Each place and variant once.
    """
    known = {(candidate.key, candidate.variant) for candidate in context.space.candidates}
    new: dict[tuple[tuple[str, str], str], Placed] = {}
    given = (best, search.empty()) if best.chosen else (best,)
    # a jump is most of what a wander would be: it is looked for where none is allowed for
    steady = [search.with_background(each, FAMILIES.index(DRIFT), 0) for each in given]
    scene = Scene(context.model.arm, context.recordings)
    finer = [bars for c in sorted(best.candidates) for bars in finer_bars(scene, context.space.placed[c])]
    nests = [c for c in best.candidates if context.space.placed[c].effect is LOOSE_TARGET]
    loose = [search.without(each, nests) for each in given]
    scans = (
        mesh_lines(context, given, most), loose_nests(context, loose), jumps(context, steady),
        _paused(context, search, best), finer,
        turns_with_other_joints(context, given),
    )  # fmt: skip
    for found in scans:
        for placed in found:
            if (placed.key, placed.variant) not in known:
                new[(placed.key, placed.variant)] = placed
    return list(new.values())


def _paused(context: ScanContext, search: Search, best: Hypothesis) -> Iterator[Placed]:
    """Drifts with one pause more, where the best hypothesis has a drift by the order of rows."""
    chosen = {c: context.space.placed[c] for c in best.candidates}
    drifts = [c for c, placed in chosen.items() if placed.effect is BASE_DRIFT and placed.variant.startswith("rows")]
    if drifts:
        # what else moves the base may be the drift's pauses: all of it, or one of it beside a jump that is one
        beside = [c for c, placed in chosen.items() if placed.location == "base" and c not in drifts]
        for replaced in sorted({(), tuple(beside), *((one,) for one in beside)}):
            yield from pauses(context, search.without(best, replaced), drifts[0])
