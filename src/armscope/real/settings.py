"""What the concealment on real recordings is told by the configuration."""

from __future__ import annotations

from armscope.inputs import Strict


class PlantSettings(Strict):
    """`armscope real plant`: which rows of which arm, what is concealed in them, and how large."""

    seed: int
    title: str
    run: str | None
    first_id: int | None
    most_rows: int
    effects: tuple[str, ...]
    sizes: tuple[float, ...]
