"""What the concealment on real recordings is told by the configuration."""

from __future__ import annotations

from armscope.core.inputs import Strict


class PlantSettings(Strict):
    """`armscope real plant`: which rows of which arm, what is concealed in them, and how large."""

    seed: int
    title: str
    run: str | None
    first_id: int | None
    most_rows: int
    effects: tuple[str, ...]
    sizes: tuple[float, ...]


class PagedArm(Strict):
    """A set on the page of real arms."""

    name: str
    title: str
    folder: str
    reference: str
    run: str | None
    first_id: int | None


class PageSettings(Strict):
    """`armscope real page`: which arms."""

    arms: tuple[PagedArm, ...]


class ConcealedSettings(Strict):
    """`armscope real concealed`: the tables of the concealment, and what to call each arm."""

    proof: str
    titles: dict[str, str]
