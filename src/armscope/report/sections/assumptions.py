"""What was assumed, and what this cannot show."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.words import rounded
from armscope.recordings import Recordings
from armscope.recordings.motion import moving
from armscope.report.sectioning import Section, Subject
from armscope.robot import Arm
from armscope.verdict.schema import Verdict
from armscope.verdict.wording import millimetres


def _context(subject: Subject) -> dict[str, Any]:
    settings = [(str(key).replace("_", " "), str(value)) for key, value in subject.verdict.settings.items()]
    return {
        "assumptions": assumptions(subject.verdict, subject.arm, subject.recordings),
        "remarks": [notice.text for notice in subject.verdict.notices],
        "settings": pd.DataFrame(settings, columns=["setting", "value"]),
    }


def assumptions(verdict: Verdict, arm: Arm, recordings: Recordings) -> list[str]:
    """What the verdict rests on, in sentences.

    Args:
        verdict: the verdict.
        arm: the nominal arm.
        recordings: the rows as they were used.

    Returns:
        One sentence each.
    """
    loads = (
        "Gravity loads come from the recorded joint torques."
        if recordings.torque is not None
        else "Gravity loads come from the masses that robot.yaml states."
        if arm.has_masses
        else "robot.yaml states no masses: loads are known up to unknown mass moments, so compliances are products "
        "with them unless a known payload sets the scale."
    )
    context = {
        "side of approach (backlash)": recordings.approach,
        "joint speed (lag)": recordings.speed,
        "temperature (thermal expansion)": recordings.temperature,
        "time (drift)": recordings.time,
        "payload": recordings.payload,
    }
    missing = [name for name, values in context.items() if values is None]
    still = [f"joint {j + 1}" for j in np.flatnonzero(~moving(recordings.motor_angles))]
    sentences = [
        "The base's place in the measurement frame is free for each run, the tool point for each target; what they "
        "can absorb is not part of the mismatch.",
        "Every link, drive and bearing may have small errors, as in any real arm (assumed: of tolerance size, about 1 "
        "mm and 1 mrad, for the geometry); one of them is named only when the recordings call for it by itself.",
        loads,
        f"The noise per axis, {millimetres(verdict.noise_mm)}, is {verdict.noise_source}."
        if math.isfinite(verdict.noise_mm)
        else "The noise is not known.",
        "Joint angles are the commanded ones, lengths hold at 20 °C, the arm is at rest or moves slowly, and each "
        "effect is small: it is found in a linear model and then fitted exactly.",
    ]
    if verdict.orientations is not None:
        seen = verdict.orientations
        sentences.append(
            f"Measured orientations ({seen.rows} rows) take part: a turn of the tool counts as much as a shift at a "
            f"lever of {seen.lever_mm:.0f} mm, the ratio of what the model leaves of points and of orientations "
            f"({rounded(seen.noise_mrad)} mrad per axis). How the tool is turned on the flange is free. Sizes in mm, "
            "the atlas and the waterfall are about the tool point alone."
        )
        if seen.instrument_mrad > 0:
            sentences.append(
                f"The orientations err by {rounded(seen.instrument_mrad)} mrad (RMS per axis), smoothly with the side "
                "that the tool turns to the instrument. No point moves with it, so it was taken for the instrument's."
            )
    if missing:
        sentences.append(f"Not recorded, so nothing that follows it can be seen: {', '.join(missing)}.")
    if still:
        sentences.append(f"Never moved, so nothing that follows its angle can be seen: {', '.join(still)}.")
    sentences.extend(f"{note[:1].upper()}{note[1:]}." for note in recordings.notes)
    return sentences


ASSUMPTIONS = Section(
    "assumptions", "Assumptions", "What was assumed, and what this cannot show", _context, folded=True
)
