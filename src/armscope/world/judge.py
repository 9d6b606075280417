"""What one who knows all else could see of an effect, and which answers explain it as well as the truth."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import orth

from armscope.core.types import Array
from armscope.world.kinds import Scene
from armscope.world.rivals import rivals
from armscope.world.strength import Sized, free_frames

ALTERNATIVE_NATS = 5.0  # A rival whose evidence falls short by less than this is an acceptable answer
D_H_VALUES = ("joint_offset", "link_geometry")  # Rivals that a geometric calibration fits
CURVE_COLUMNS = 3  # Columns charged for a free curve that stands for an effect outside the library


@dataclass(frozen=True)
class Alternative:
    """An answer as good as the truth, to within ``gap_nats`` of evidence."""

    effect: str
    location: str
    gap_nats: float


@dataclass(frozen=True)
class Visibility:
    """What is known about finding one effect among all that a world conceals."""

    # squared size of its displacement, in noise units, that frames and the other effects don't take
    noncentrality: float
    columns: int  # how many numbers an oracle that knows what to test would fit
    frame_numbers: int  # how many the free frames have: six per base, three of the tool point
    # the answers that are as good, best first; none where there is nothing to see
    alternatives: tuple[Alternative, ...]


class Judge:
    """Compares concealed effects with all rivals at the rows of a scene."""

    def __init__(self, scene: Scene, tool: Array) -> None:
        self.tool, self.tool_turn = tool, scene.tool_turn
        self.frames = free_frames(tool, scene.tool_turn)
        self.rivals = rivals(scene)
        self._matrix = np.concatenate([rival.columns for rival in self.rivals], axis=1)
        norms = np.linalg.norm(self._matrix, axis=0)
        self._matrix /= np.where(norms > 0, norms, 1.0)
        self._starts = np.cumsum([0] + [rival.columns.shape[1] for rival in self.rivals])

    def visibility(self, truth: Sized, others: list[Sized], sigma: float) -> Visibility:
        """How well ``truth`` can be found beside ``others`` at noise ``sigma`` (m per axis).

        Args:
            truth: the concealed effect.
            others: what is concealed beside it.
            sigma: noise per axis, m.

        Returns:
            Noncentrality, numbers of the effect and of the frames, and rivals that predict nearly the same.
        """
        nuisance, pattern = self._beyond(self.frames, truth, others, sigma)
        matrix = self._matrix - nuisance @ (nuisance.T @ self._matrix)
        gram, overlap = matrix.T @ matrix, matrix.T @ pattern
        energy = float(pattern @ pattern)
        own = self._columns_of(truth)
        if energy / 2 < ALTERNATIVE_NATS:
            return Visibility(energy, own, self.frames.shape[1], ())
        found: dict[tuple[str, str], float] = {}
        for number, rival in enumerate(self.rivals):
            name = (rival.effect, rival.location)
            if name == (truth.effect.kind.effect, truth.effect.location):
                continue
            span = slice(self._starts[number], self._starts[number + 1])
            explained = _explained(gram[span, span], overlap[span])
            price = 0.5 * (rival.columns.shape[1] - own) * np.log(len(pattern))
            gap = float(max(energy - explained, 0.0) / 2 + price)
            if gap < min(ALTERNATIVE_NATS, energy / 4):
                found[name] = min(gap, found.get(name, np.inf))
        ordered = sorted(found.items(), key=lambda item: item[1])
        alternatives = tuple(Alternative(*name, round(gap, 2)) for name, gap in ordered)
        return Visibility(energy, own, self.frames.shape[1], alternatives)

    def seen_in_runs(
        self, known: Visibility, truth: Sized, others: list[Sized], sigma: float, run: NDArray[np.int64]
    ) -> Visibility:
        """``known`` for an oracle who must fit a base in each run, as a table with runs, (N,) ``run``, asks for.

        The alternatives stay those in front of one base: what a free base per run hides besides is no further answer.

        Args:
            known: of `visibility`.
            truth: the concealed effect.
            others: what is concealed beside it.
            sigma: noise per axis, m.
            run: (N,) number of each row's run.

        Returns:
            As known, with another noncentrality and more numbers of frames.
        """
        frames = free_frames(self.tool, self.tool_turn, run)
        _, pattern = self._beyond(frames, truth, others, sigma)
        return replace(known, noncentrality=float(pattern @ pattern), frame_numbers=frames.shape[1])

    def _beyond(self, frames: Array, truth: Sized, others: list[Sized], sigma: float) -> tuple[Array, Array]:
        """Orthonormal (3 N, k) of what frames and other effects can do, and ``truth`` (3 N,) beyond it per noise."""
        taken = [frames / np.linalg.norm(frames, axis=0), *(self._spanned(other) for other in others)]
        nuisance = orth(np.concatenate(taken, axis=1), rcond=1e-9)
        pattern = truth.pattern.reshape(-1) / sigma
        return nuisance, pattern - nuisance @ (nuisance.T @ pattern)

    def _spanned(self, sized: Sized) -> Array:
        """The patterns that free numbers of a concealed effect can make, its own displacement among them."""
        name = (sized.effect.kind.effect, sized.effect.location)
        own = [rival.columns for rival in self.rivals if (rival.effect, rival.location) == name]
        exact = sized.pattern.reshape(-1, 1)
        columns = np.concatenate([exact, *own[:1]], axis=1)
        norms = np.linalg.norm(columns, axis=0)
        return columns / np.where(norms > 0, norms, 1.0)

    def _columns_of(self, sized: Sized) -> int:
        if sized.effect.kind.outside:
            return CURVE_COLUMNS
        name = (sized.effect.kind.effect, sized.effect.location)
        counts = [rival.columns.shape[1] for rival in self.rivals if (rival.effect, rival.location) == name]
        return counts[0] if counts else sum(parameter.scales for parameter in sized.effect.kind.parameters)


def _explained(gram: Array, overlap: Array) -> float:
    """Energy that patterns of a Gram matrix take of what they overlap with; dependent patterns count once."""
    values, vectors = np.linalg.eigh(gram)
    keep = values > 1e-9 * max(values[-1], 1e-12)
    along = vectors[:, keep].T @ overlap
    return float(np.sum(along**2 / values[keep]))
