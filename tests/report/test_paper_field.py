"""The paper's error field: every number at its own point."""

import base64
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from armscope.compensation.closed_loop import NO_MODEL
from armscope.paper.measurements import pose_table
from armscope.report.pages.paper_field import error_field
from armscope.robot import forward_kinematics, load_arm

ARM = load_arm(Path(__file__).parents[2] / "config" / "robots" / "sk120.yaml")
POINTS = {"identification": 5, "test 1": 4}


def study():
    """Poses, and errors that say whose they are: model in hundreds, stage in tens, trajectory and point in the rest."""
    random, poses, rows = np.random.default_rng(1), [], []
    for n, (name, count) in enumerate(POINTS.items()):
        angles = random.uniform(-0.5, 0.5, (count, ARM.n_motors))
        poses.append(pose_table(name, angles, 1e3 * forward_kinematics(ARM, angles)))
        for m, model in enumerate((NO_MODEL, "FDP(CI)", "SDP(AI)")):
            for s, stage in enumerate(("fit" if n == 0 else "prediction", "closed loop")):
                if n == 0 and stage == "closed loop":
                    continue  # identification poses are no path
                rows += [(model, name, stage, k, 100 * m + 10 * s + n + k / 10, 0, 0) for k in range(1, count + 1)]
    columns = ["model", "trajectory", "stage", "point", "dx_mm", "dy_mm", "dz_mm"]
    left = pd.DataFrame(rows, columns=columns).sample(frac=1, random_state=0)  # the order of rows means nothing
    return pd.concat(poses, ignore_index=True), left


def test_before_after_and_compensated_stand_at_their_points():
    poses, left = study()
    html = error_field(ARM, poses, left)
    data = json.loads(re.search(r"<script[^>]*>(.*?)</script>", html, re.S)[1])
    fields = [np.frombuffer(base64.b64decode(text), "<f4").reshape(-1, 3)[:, 0] for text in data["fields"]]
    assert [model["name"] for model in data["models"]] == ["FDP(CI)", "SDP(AI)"]
    point = np.concatenate([np.arange(1, count + 1) / 10 for count in POINTS.values()])
    trajectory = np.repeat([0, 1], list(POINTS.values()))
    for m, model in enumerate(data["models"], start=1):
        before, after, compensated = (fields[at] for at in model["fields"])
        assert before == pytest.approx(trajectory + point, rel=1e-6)
        assert after == pytest.approx(100 * m + trajectory + point, rel=1e-6)
        assert np.isnan(compensated[trajectory == 0]).all()
        assert compensated[trajectory == 1] == pytest.approx((100 * m + 10 + trajectory + point)[5:], rel=1e-6)
    assert data["groups"] == list(POINTS)
    assert data["paths"] == [1]
