"""Where a stated load may be wrong, and the link that carries it has the name."""

from __future__ import annotations

from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary.unnamed_masses import is_of_masses
from armscope.verdict.schema import Notice


def load_or_link(selected: SelectedCauses) -> list[Notice]:
    """That what is told of the last link may be the stated load's: it moves with it, and no motion tells them apart.

    Seen: 2.4 kg that a load was lighter than stated were told of a link that weighs 4.6 kg and was right.
    """
    layout = selected.rows.layout
    load, last = layout.arm.description.tool_load, f"link {len(layout.arm.inertial) // 10}"
    placed = [layout.placed[number] for number in selected.best.candidates]
    if load is None or not any(is_of_masses(each) and each.location == last for each in placed):
        return []
    text = (
        f"robot.yaml states a load of {load.mass_kg:.3g} kg (`tool_load`). It moves with {last}, and no motion tells "
        f"one from the other: what is told of {last} may be the load's. Weigh the load, and correct it before {last}; "
        "their sum is right either way, and so is corrected.urdf."
    )
    return [Notice("stated load", text)]
