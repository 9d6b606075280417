"""What a verdict puts right in a controller's model, as tables: zeros of the motors, and D-H rows."""

from __future__ import annotations

import math

import pandas as pd

from armscope.physics.geometric import JOINT_OFFSET, LINK_GEOMETRY
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import INTERVAL
from armscope.verdict.wording import implausible

NUMBERS = ("a_mm", "alpha_deg", "d_mm", "theta_offset_deg")
"""Of a D-H row, as robot.yaml calls them."""


def zero_offsets(verdict: Diagnosis) -> pd.DataFrame:
    """The zeros of all motors as found: actual angle minus commanded angle, with 95 % intervals (half width).

    Those that were not named stand as 0 with what the small errors in all joints say of them.
    """
    rows = []
    for j in range(1, verdict.model.arm.n_motors + 1):
        found = [p for e in verdict.effects if (e.effect, e.location) == (JOINT_OFFSET.name, f"joint {j}")
                 for p in e.parameters if p.name == "offset" and not implausible(p, e)]  # fmt: skip
        value, half = (found[0].value, INTERVAL * found[0].stderr) if found else (0.0, float("nan"))
        rows.append((f"joint {j}", math.degrees(value), 1e3 * value, 1e3 * half, "named" if found else "not named"))
    columns = ["joint", "actual_minus_commanded_deg", "actual_minus_commanded_mrad", "half_interval_95_mrad", "cause"]
    return pd.DataFrame(rows, columns=columns)


def corrected_rows(verdict: Diagnosis) -> pd.DataFrame | None:
    """The D-H rows as stated and as found, mm and degrees, without the zeros; None for an arm that has no D-H rows."""
    dh = verdict.model.arm.description.dh
    if dh is None:
        return None
    rows = []
    for j, stated in enumerate(dh.joints, start=1):
        found = {p.name: p for e in verdict.effects if (e.effect, e.location) == (LINK_GEOMETRY.name, f"link {j}")
                 for p in e.parameters if not implausible(p, e)}  # fmt: skip
        row: dict[str, object] = {"row": j, "convention": dh.convention}
        numbers = (stated.a_mm, stated.alpha_deg, stated.d_mm, stated.theta_offset_deg)
        for name, key, value in zip(NUMBERS, ("a", "alpha", "d", "theta"), numbers, strict=True):
            step = found[key].value if key in found else 0.0
            step = math.degrees(step) if name.endswith("deg") else step
            row |= {f"stated_{name}": value, f"correction_{name}": step, f"corrected_{name}": value + step}
        rows.append(row)
    return pd.DataFrame(rows)
