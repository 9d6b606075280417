"""The arm coloured by what each place has of the mismatch."""

from __future__ import annotations

from collections.abc import Iterator

from armscope.report.figures.arm_picture import draw_arm
from armscope.report.sectioning import Drawn, Subject
from armscope.verdict.schema import Verdict


def arm_figure(subject: Subject) -> Iterator[Drawn]:
    """The arm in a recorded pose."""
    picture = draw_arm(subject.arm, subject.recordings.motor_angles, location_shares(subject.verdict))
    yield Drawn("arm", picture)


def location_shares(verdict: Verdict) -> dict[str, float]:
    """Share of the mismatch by location: of all effects found, and of what is left unexplained at a known place.

    What partly cancels other effects has a share below zero, and is there as much as if it did not.
    """
    shares: dict[str, float] = {}
    for effect in verdict.effects:
        shares[effect.location] = shares.get(effect.location, 0.0) + min(abs(effect.share), 1.0)
    left = verdict.unexplained
    told = any(effect.nameless and effect.location == left.location for effect in verdict.effects)
    if left.present and left.location and not told and verdict.residual_before_mm > 0:
        share = (left.rms_mm / verdict.residual_before_mm) ** 2
        shares[left.location] = shares.get(left.location, 0.0) + min(share, 1.0)
    return {location: min(share, 1.0) for location, share in shares.items()}
