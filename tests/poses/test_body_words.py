from pathlib import Path

import numpy as np

from armscope.poses.body_words import body_in_words, body_notes, surroundings_notes
from armscope.poses.obstacles import Surroundings
from armscope.robot import load_arm

ARM = load_arm(Path(__file__).parents[2] / "config" / "robots" / "sk120.yaml")


def test_pairs_that_have_less_room_than_their_radii_ask_for_are_told():
    (body, *less) = body_notes(ARM, Surroundings(radius=0.161))
    assert "161 mm" in body
    assert "links that share a joint are not checked" in body
    assert any("link 2 and link 4 within 125 mm" in note for note in less)
    assert len(body_notes(ARM, Surroundings(radius=0.01))) == 1


def test_what_was_not_looked_at_is_told():
    known = Surroundings(0.01, 0.0, np.array([4.0, 0, 1]))
    assert surroundings_notes(ARM, known) == body_notes(ARM, known)
    told = " ".join(surroundings_notes(ARM, Surroundings(0.01)))
    assert "no --tracker" in told
    assert "no --floor-mm" in told


def test_lines_are_told_from_shapes():
    assert "around the lines between their joints" in body_in_words(ARM, Surroundings())
