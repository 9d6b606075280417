"""Scenes that several tests look at."""

from __future__ import annotations

import functools

import numpy as np

from armscope.robot.description_file import load_description
from armscope.world.kinds import Concealed, Scene
from armscope.world.session import random_session
from armscope.world.spec import KINDS, LARGEST_PAYLOAD_KG
from armscope.world.strength import make_scene
from tests.world.by_hand import ROBOTS


@functools.cache
def scene_of(arm: str, rule: str = "free", count: int = 12, seed: int = 3) -> tuple[Scene, np.ndarray]:
    """An arm in a short session, and its nominal tool points."""
    description = load_description(ROBOTS / f"{arm}.yaml")
    session = random_session(description, np.random.default_rng(seed), count, rule, LARGEST_PAYLOAD_KG[arm], 5.0)
    return make_scene(description, session)


def drawn(scene: Scene, kind: str, place: str, seed: int = 5) -> Concealed:
    """An effect of natural size at a place."""
    return Concealed(KINDS[kind], place, KINDS[kind].draw(np.random.default_rng(seed), scene, place))
