"""Numbers by which springs between links are looked for; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class LinkageRules(Constants):
    """Where a spring is mounted."""

    phases: int = 72
    """between its ends that are tried [angles]; judgement: steps of 5 degrees"""
    ratios: tuple[float, ...] = (0.1, 0.18, 0.26, 0.34, 0.42, 0.5, 0.58, 0.66, 0.74, 0.82, 0.9, 0.96)
    """of its ends' distances from the axis that are tried; judgement: below these it is a sine, above them its ends all
    but meet"""
    much: float = 1e-4
    """of what a spring explains that has no name, below which it stays where it is; measured: with a hundredth, two of
    eight planted gas springs stayed where the first scan put them, as cables"""
    moved_nats: float = 1.0
    """beyond which it never stays [nats]; judgement: three to one; set with planted gas springs hundreds of times the
    noise in view, of which a ten thousandth of what they explain was the name, and with the Panda, whose verdict three
    nats changed"""
    as_good_nats: float = 3.0
    """within which mounts are alike [nats]; derived: 95 % of two numbers"""
    growth: float = 0.3
    """of its force by which that may change along its stroke, RMS; convention: gas springs' force rises by 10 to 60 %
    over their stroke (catalogues' progression)"""
    least_rows: int = 20
    """that must tell its curve [rows]; judgement: fewer fit anything"""
    held: float = 0.02
    """of a row that forces of a pause may take; judgement: next to nothing"""
    sectors: int = 12
    """of the turn, in each of which the best is looked at; judgement: 30 degrees"""
    starts: int = 6
    """of these, from which finer ones are tried; judgement: time"""
    between: float = 0.08
    """two ratios that are tried; derived: the first scan's step"""
    rows: int = 2000
    """at which mounts are tried, at most; judgement: time; curves of the angle need few"""
    settled: float = 1e-4
    """rad, of the ratio, and nats, by which a mount still moves; steps of its slopes; judgement: less than any rows
    bear"""
    built_in: float = 1 / 3
    """of the joint's torque, that a spring or a counterweight takes off it as a rule where one is built in; judgement:
    it is built in to take most of what the joint carries; cables and hoses pull with some hundredths"""
    usual_torque: float = 3.0
    """of the joint's torque, that a spring's may be; judgement: wide; springs hold what gravity asks for"""
    largest_ratio: float = 0.98
    """at most; judgement: mounts are not at one radius to a hair"""
    least_ratio: float = 0.03
    """at least; judgement: below it is a sine"""
    shortest: float = 0.02
    """that a spring is, to its longer distance; judgement: no spring has no length"""

    @property
    def tried(self) -> int:
        """Mounts that compete."""
        return self.phases * len(self.ratios)


LINKAGE = LinkageRules()
