"""Moving worlds in batches: what may be seen in one tree, the truth sealed in an archive elsewhere."""

from __future__ import annotations

from pathlib import Path

from armscope.proof.making import sealing, show
from armscope.world.motion.catalogue import Size, catalogue
from armscope.world.motion.folder import build


def make(proof_seed: int, size: Size, robots: Path, visible: Path, sealed: Path) -> None:
    """Make the worlds of a proof.

    Args:
        proof_seed: from which half of the worlds' seeds come.
        size: small or full.
        robots: folder of the arms' descriptions.
        visible: new folder for robot.yaml, motions.csv and test_motions.csv (no torques) of each world.
        sealed: archive for the truth.
    """
    with sealing(visible, sealed) as made:
        for spec in catalogue(proof_seed, size):
            show(build(spec, made, robots), visible)
            print(spec.id, flush=True)  # progress; what is inside stays sealed
