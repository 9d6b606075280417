"""The frames are found without a first guess, wherever the instrument stands."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.calibration.calibrate import calibrate
from tests.calibration.worlds import far_away, measured, poses, ur_like
from tests.robot.arms import STANDARD, dh_arm


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), tool_m=st.floats(0, 0.8))
def test_any_frame_and_any_tool_are_found_from_clean_points(seed, tool_m):
    rng = np.random.default_rng(seed)
    arm, base = ur_like(), far_away(rng)
    tools = {"t1": rng.normal(size=3) * tool_m, "t2": rng.normal(size=3) * tool_m}
    calibration = calibrate(arm, measured(arm, poses(rng, 25, 6), base, tools), "nominal")
    assert calibration.rms_distance < 1e-8
    np.testing.assert_allclose(calibration.state.rotations[0], base[0], atol=1e-7)
    np.testing.assert_allclose(calibration.state.translations[0], base[1], atol=1e-7)


def test_each_run_has_a_base_of_its_own():
    rng = np.random.default_rng(3)
    arm = dh_arm(STANDARD)
    import pandas as pd

    from armscope.recordings import as_recordings

    bases = {"a": far_away(rng), "b": far_away(rng)}
    parts = []
    for run, base in bases.items():
        recordings = measured(arm, poses(rng, 15, 6), base, {"": [0.1, 0.2, 0.3]}, run=run)
        parts.append(
            pd.DataFrame(
                {"run": run, **{f"q{j + 1}_rad": recordings.motor_angles[:, j] for j in range(6)}}
                | {f"{axis}_m": recordings.positions[:, k] for k, axis in enumerate("xyz")}
            )
        )
    both = as_recordings(pd.concat(parts, ignore_index=True))
    calibration = calibrate(arm, both, "nominal")
    assert calibration.rms_distance < 1e-8
    assert calibration.set_up.base_names == ("a", "b")
    np.testing.assert_allclose(calibration.state.translations[1], bases["b"][1], atol=1e-7)
    # a single base can't serve both
    assert calibrate(arm, both, "nominal", one_base=True).rms_distance > 0.1
