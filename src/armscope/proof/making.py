"""Worlds made in batches: what may be seen in one tree, the truth sealed in an archive elsewhere."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import pandas as pd

from armscope.core.files import copy_file, new_folder, write_table
from armscope.proof.truth import seal
from armscope.recordings.columns import AXES_MM
from armscope.world.catalogue import catalogue
from armscope.world.folder import build
from armscope.world.spec import WorldSpec

TEST_POSES = "test_poses.csv"


def batch(proof_seed: int, size: Literal["small", "full"], fresh: bool) -> list[WorldSpec]:
    """The worlds with fixed, or with fresh seeds.

    Args:
        proof_seed: of the proof; fresh seeds follow from it.
        size: of the catalogue.
        fresh: whether the worlds with fresh seeds are wanted, or those with fixed ones.

    Returns:
        The worlds' specifications.
    """
    return [spec for spec in catalogue(proof_seed, size) if spec.fresh == fresh]


def make(specs: list[WorldSpec], robots: Path, visible: Path, sealed: Path) -> None:
    """Make worlds.

    Args:
        specs: which.
        robots: folder of the arms' descriptions.
        visible: new folder for robot.yaml, recordings.csv and test_poses.csv (poses without readings) of each world.
        sealed: archive for the truth.
    """
    with sealing(visible, sealed) as made:
        for spec in specs:
            home = build(spec, made, robots)
            test = pd.read_csv(home / "sealed" / "test.csv", dtype=str, keep_default_na=False)
            write_table(home / "visible" / TEST_POSES, test.drop(columns=AXES_MM))
            show(home, visible)


@contextlib.contextmanager
def sealing(visible: Path, sealed: Path) -> Iterator[Path]:
    """A folder for worlds, whose sealed files go into the archive in the end; the visible tree starts empty."""
    new_folder(visible)
    with tempfile.TemporaryDirectory() as made:
        yield Path(made)
        seal(Path(made), sealed)


def show(home: Path, visible: Path) -> None:
    """Put what may be seen of a world into the visible tree."""
    for file in sorted((home / "visible").iterdir()):
        copy_file(file, visible / home.name / file.name)
