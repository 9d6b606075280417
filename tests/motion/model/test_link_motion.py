"""A model that knows a drive's stiffness says where the link stands, and its torque, by the motor's place alone."""

from pathlib import Path

import numpy as np
import pytest

from armscope.motion.model.file import load_motion_model, save_motion_model
from armscope.motion.predicting import torque_table
from armscope.recordings.motions import as_motions
from tests.motion.two_inertias import recorded, spring, wound_up


@pytest.mark.long
def test_a_saved_model_foretells_the_link_and_the_torque_of_another_path(tmp_path: Path) -> None:
    found = wound_up()
    save_motion_model(tmp_path / "model.yaml", found.model)
    other = recorded(spring(3000.0), 3, 5, runs=1, noise=0.0)
    blind = as_motions(other.drop(columns=["q3_link_rad"]), "other.csv", 3)
    told, _ = torque_table(load_motion_model(tmp_path / "model.yaml"), blind)
    inside = slice(200, -200)
    beside, off = other["q3_link_rad"] - other["q3_rad"], told["q3_link_rad"] - other["q3_link_rad"]
    assert np.std(off[inside]) < 0.05 * np.std(beside[inside])
    seen, _ = torque_table(load_motion_model(tmp_path / "model.yaml"), as_motions(other, "other.csv", 3))
    wrong = [np.std((table["tau3_nm"] - other["tau3_nm"])[inside]) for table in (told, seen)]
    assert wrong[0] < 1.1 * wrong[1]  # the link's own encoder would tell hardly more
