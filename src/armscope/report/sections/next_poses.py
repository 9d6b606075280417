"""What to measure next."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from armscope.report.figures.next_poses import next_poses_figure
from armscope.report.sectioning import Section, Subject
from armscope.report.sections.effects import findings
from armscope.verdict.diagnosis import NextPoses
from armscope.verdict.doubts import doubt_of
from armscope.verdict.wording import main_and_minor, places_in_words, plain


def _context(subject: Subject) -> dict[str, Any]:
    poses = subject.verdict.next_poses
    unknown = list(dict.fromkeys(each.location for each in subject.verdict.effects if each.nameless))
    main, _ = main_and_minor(subject.verdict.effects)
    left_open = [plain(each.title) for each in main if doubt_of(each) and each.alternatives]
    return {
        **findings(subject.verdict),
        "next_poses": None if poses is None else _next_poses(poses),
        "without_cause": places_in_words(unknown),
        "left_open": "; ".join(left_open),
    }


def _next_poses(poses: NextPoses) -> pd.DataFrame:
    degrees = np.degrees(poses.motor_angles)
    table = pd.DataFrame({"pose": np.arange(1, len(degrees) + 1)})
    for motor in range(degrees.shape[1]):
        table[f"q{motor + 1} (deg)"] = [f"{angle:.1f}" for angle in degrees[:, motor]]
    if np.any(np.nan_to_num(poses.payload_kg) != 0):
        table["payload (kg)"] = [f"{mass:g}" for mass in poses.payload_kg]
    table["the two differ by (mm)"] = poses.separation_mm
    return table


NEXT_POSES = Section(
    "next", "What to measure next", "What to measure next", _context, (next_poses_figure,), folded=True
)
