"""What a claim is: words, place, criterion, and who judges it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from armscope.paper.claims.evidence import Evidence, Judged

OWN, TAUTOLOGY = "the paper's own claims", "true of every nested least-squares fit"
REGIONS, PRODUCT = "outlook: sub-volumes", "outlook: products"
GROUPS = (OWN, TAUTOLOGY, REGIONS, PRODUCT)

BY_SWARM, WITHOUT = "by swarm", "by least squares"
FIRST_FOUR = ("FDP(CI)", "SDP(CI)", "FDP(AI)", "SDP(AI)")
OVER_TESTS = "3D errors over trajectories I–III together"


@dataclass(frozen=True)
class Claim:
    """What is claimed, where and in which words, what counts as true of one robot, and who judges."""

    key: str  # short name in tables and files
    claim: str
    group: str  # one of `GROUPS`
    source: str
    wording: str  # of the paper; "" where the claim is read off Table 2
    criterion: str  # what counts as true of one robot
    # number_is, unit: the number that goes with it
    number_is: str
    unit: str
    judge: Callable[[Evidence], Judged | None]  # from evidence; None where the evidence for it was not gathered
    needs: tuple[str, ...] = ()  # models without which it can't be judged
    any_of: tuple[str, ...] = ()  # at least one of these models is needed
    fitted: str = BY_SWARM  # `BY_SWARM` (judged once per method) or `WITHOUT`
