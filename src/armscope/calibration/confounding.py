"""What a parameter that poses cannot tell apart is imitated by: the few others that move the tool as it does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.constants import IDENTIFYING
from armscope.core.types import Array

TOOL_POINT = ("tool x", "tool y", "tool z")


@dataclass(frozen=True)
class Confounded:
    """Which fitted parameters do what a held one does."""

    name: str
    # fitted parameters that together move the tool as it does, the most alike first; none where it hardly moves the
    # tool. Those of all bases or tools count as one: "base rz"
    partners: tuple[str, ...]
    left: float  # share (0 to 1) of what it does to the tool that the partners leave

    def text(self) -> str:
        """In words; of many partners only the frames and joints that they belong to."""
        if not self.partners:
            return f"{self.name}: hardly moves the tool"
        told = self.partners
        if len(told) > IDENTIFYING.told_singly:
            told = tuple(dict.fromkeys(partner.rpartition(" ")[0] for partner in told))
        stated = "; kept as stated" if kind_of(self.name) in TOOL_POINT else ""
        return (
            f"{self.name}: as {' with '.join(told)}" + (" and more" if self.left > IDENTIFYING.alike else "") + stated
        )


def confounded_parameters(
    jacobian: Array, free: NDArray[np.bool_], scales: Array, names: tuple[str, ...]
) -> tuple[Confounded, ...]:
    """One per parameter that is not free.

    Greedy (orthogonal matching pursuit, Pati et al. 1993): the fitted column most alike to what is left enters, until
    next to nothing is left or `IDENTIFYING.partners` have entered. Columns of the same number of all bases, or of all
    tools, enter together: each stands for some of the rows.

    Args:
        jacobian: (M, P).
        free: (P,) which were fitted.
        scales: (P,) as for `identifiable`.
        names: (P,) of the parameters.

    Returns:
        Which fitted parameters it is made of, and how well.
    """
    triangular = np.linalg.qr(jacobian, mode="r") if len(jacobian) > jacobian.shape[1] else jacobian
    columns = triangular * scales / np.sqrt(len(jacobian) / 3)
    fitted = np.flatnonzero(free)
    unit = columns[:, fitted] / np.maximum(np.linalg.norm(columns[:, fitted], axis=0), 1e-300)
    kinds = np.array([kind_of(names[each]) for each in fitted])
    return tuple(_confounded(names[held], columns[:, held], unit, kinds) for held in np.flatnonzero(~free))


def kind_of(name: str) -> str:
    """Without the run or target: "base of monday rz" is "base rz"."""
    frame, _, rest = name.partition(" of ")
    return f"{frame} {rest.rpartition(' ')[2]}" if frame in ("base", "tool") and rest else name


def _confounded(name: str, column: Array, unit: Array, kinds: NDArray[np.str_]) -> Confounded:
    size = float(np.linalg.norm(column))
    if size < IDENTIFYING.smallest_trace:
        return Confounded(name, (), 1.0)
    left, partners = column, list[str]()
    every, number = np.unique(kinds, return_inverse=True)
    while len(partners) < IDENTIFYING.partners and np.linalg.norm(left) > IDENTIFYING.alike * size:
        # columns of different runs or targets share no row, so that their parts add up
        alike = np.sqrt(np.bincount(number, (left @ unit) ** 2))
        partners.append(str(every[int(np.argmax(alike))]))
        basis = unit[:, np.isin(kinds, partners)]
        left = column - basis @ np.linalg.lstsq(basis, column, rcond=None)[0]
    return Confounded(name, tuple(partners), float(np.linalg.norm(left)) / size)
