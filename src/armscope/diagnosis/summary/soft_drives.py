"""What soft drives explain as well as a link that bends: most of what an arm gives way is theirs.

Two soft joints move the tool much as the bending of the link between them does, and one name for the link costs less
than one for each of them. So a link is asked whether all joints and links that give way a little, as in any arm, do as
well in its place: within odds of 20 to 1, or within what no part keeps of its law. The torques are computed from
stated masses, and no drive or beam is a spring exactly; a preference that rests on so little is no measurement.
"""

from __future__ import annotations

import numpy as np

from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.drives_first import GIVE, little_give_instead
from armscope.diagnosis.model_space import EffectSpace
from armscope.diagnosis.state import DiagnosisState
from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search
from armscope.physics.backgrounds import ELASTIC
from armscope.physics.elastic import JOINT_COMPLIANCE, LINK_BENDING
from armscope.verdict.effects import Alternative

LOOK_AT_DRIVES = "See first whether drives give way: load the arm, and measure at each joint how far it turns."
CURE_OF_DRIVES = "Only if no drive turns by what is told here:"


def told_by_drives(state: DiagnosisState) -> dict[int, Alternative]:
    """The drive that gives way most where all give way a little, as the alternative of links that bend; by candidate.

    Args:
        state: the finished selection.

    Returns:
        Alternatives; none where a little give everywhere is in the model anyway, or rows tell it from the link.
    """
    found = {}
    for effect in state.best.chosen:
        if state.space.placed[effect.candidate].effect is LINK_BENDING:
            little = little_give_instead(Search.on(state.problem), state.best, effect.candidate, NAMING.unlawful_give)
            drive = None if little is None else _softest(state.space, little)
            if little is not None and drive is not None:
                gap = float(state.best.log_posterior - little.log_posterior)
                name, place = JOINT_COMPLIANCE.name, state.space.placed[drive].location
                driver = state.space.placed[drive].driver
                found[effect.candidate] = Alternative(name, place, ELASTIC, gap, driver, max(gap, 0.0))
    return found


def _softest(space: EffectSpace, hypothesis: Hypothesis) -> int | None:
    """The candidate of the drive that moves the tool most in a hypothesis without names for drives."""
    family = set(space.families[GIVE].columns.tolist())
    drives = [
        n
        for n, placed in enumerate(space.placed)
        if placed.effect is JOINT_COMPLIANCE and set(space.candidates[n].columns.tolist()) <= family
    ]
    sizes = [float(np.abs(hypothesis.means(space.candidates[n].columns)).max()) for n in drives]
    return drives[int(np.argmax(sizes))] if drives else None
