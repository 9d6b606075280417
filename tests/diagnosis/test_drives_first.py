"""Two soft springs and a beam that moves the tool much as both: columns that are no robot's."""

from __future__ import annotations

import numpy as np

from armscope.diagnosis.drives_first import GIVE, drives_first, little_give_instead
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import Candidate, ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import build_problem
from armscope.inference.search import Search
from armscope.physics.elastic import LINK_BENDING

ROWS, NOISE = 300, 0.1


def searched(beam_itself: bool, own_share: float = 0.5) -> tuple[Search, Hypothesis]:
    """What a search says of two springs; of the beam itself, whose own share is what no springs do."""
    rng = np.random.default_rng(11)
    base, one, other, rest, own = rng.normal(size=(5, ROWS))
    share = own_share if beam_itself else 0.03
    beam = (one + other) / np.sqrt(2) + share * own
    X = np.column_stack([np.ones(ROWS), one, other, beam, base, rest])
    y = (0.5 * beam if beam_itself else 0.35 * (one + other)) + rng.normal(0, NOISE, ROWS)
    candidates = tuple(
        Candidate(kind, name, np.array([column]), np.ones(1))
        for kind, name, column in (("spring", "1", 1), ("spring", "2", 2), (LINK_BENDING.name, "3", 3))
    )
    families = (
        ToleranceFamily("geometric", np.array([4]), np.ones(1), (0.0, 0.1), is_priced=False),
        ToleranceFamily("elastic", np.array([1, 2, 5]), np.full(3, 1.0), (0.0, 0.1, 0.3, 1.0)),
    )
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    problem = build_problem(ModelSpace(np.array([0]), families, candidates, starts=((1, 0),)), equations, 0.5 * NOISE)
    search = Search.on(problem)
    return search, search.best()


def test_two_soft_springs_may_stand_in_a_bending_beams_place() -> None:
    search, found = searched(beam_itself=False)
    assert found.candidates == {2}  # one name costs less than two
    little = little_give_instead(search, found, 2)
    assert little is not None
    assert not little.candidates
    assert little.background[GIVE]
    assert drives_first(search, found).candidates == little.candidates
    assert little_give_instead(search, little, 2) is None


def test_a_beam_that_bends_has_no_such_rival() -> None:
    search, found = searched(beam_itself=True)
    assert found.candidates == {2}
    assert little_give_instead(search, found, 2) is None
    assert drives_first(search, found) is found


def test_a_preference_that_rests_on_little_of_what_the_link_explains_is_none() -> None:
    def gap_and_worth(own_share: float) -> tuple[bool, float, float]:
        search, found = searched(True, own_share)
        rest = search.without(found, [2])
        gaps = [
            found.log_posterior - search.with_background(rest, GIVE, size).log_posterior
            for size in range(1, search.space.families[GIVE].sizes)
        ]
        return little_give_instead(search, found, 2, 0.03) is None, min(gaps), found.log_posterior - rest.log_posterior

    told, gap, worth = gap_and_worth(0.05)
    assert 3.0 < gap < 0.03 * worth
    assert not told
    told, gap, worth = gap_and_worth(0.1)
    assert gap > 0.03 * worth
    assert told
