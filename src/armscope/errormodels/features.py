"""The terms of the paper's models, and their names: ordinary polynomials (Eqs. 6-7, 9-20), Fourier series (Eqs. 4-5).

Both are sums of functions of one input each, without products between inputs, plus one constant: the constants Q_i
(K_i) of the single joints can't be told apart, and the paper prints one. Per axis that is

    1 + inputs x degree        terms of an ordinary polynomial:  4th degree, six joints: 1 + 6 x 4 = 25
    1 + inputs x 2 harmonics   terms of a Fourier series:        2 harmonics, six joints: 1 + 6 x 2 x 2 = 25

so 75 for x, y and z together, as the paper counts. Inputs that do not move have no terms, as theta4 and theta5 in
Eqs. (9)-(14). Units: rad (angular input) or mm (Cartesian input) in, and terms as they come.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from armscope.core.types import Array
from armscope.errormodels.basis import BasisKind, make_basis

FAMILIES = ("polynomial", "fourier")
SPACES = ("cartesian", "angular")
STILL = {"cartesian": 1e-6, "angular": 1e-9}  # an input with a smaller range (mm, rad) does not move
SHORT_SPACES = {"cartesian": "CI", "angular": "AI"}


@dataclass(frozen=True)
class ModelSpec:
    """Which model to fit.

    Args:
        family: "polynomial" or "fourier".
        order: the degree of the polynomial, or the number of harmonics; 1 or more.
        space: "cartesian" (nominal tool position, mm) or "angular" (commanded joint angles, rad).

    Raises:
        ValueError: a value outside these.
    """

    family: str
    order: int
    space: str

    def __post_init__(self) -> None:
        if self.family not in FAMILIES:
            raise ValueError(f"family = {self.family!r}: must be one of {', '.join(FAMILIES)}")
        if self.space not in SPACES:
            raise ValueError(f"space = {self.space!r}: must be one of {', '.join(SPACES)}")
        if isinstance(self.order, bool) or not isinstance(self.order, int) or self.order < 1:
            raise ValueError(f"order = {self.order!r}: must be a whole number, 1 or more")

    @property
    def name(self) -> str:
        """The paper's name where it has one ("FDP(CI)"), else like "4th-degree polynomial (AI)", "Fourier 2 (AI)"."""
        short = SHORT_SPACES[self.space]
        if self.family == "fourier":
            return f"Fourier {self.order} ({short})"
        if self.order <= 2:
            return f"{('FDP', 'SDP')[self.order - 1]}({short})"
        return f"{self.order}{'rd' if self.order == 3 else 'th'}-degree polynomial ({short})"

    def features(self, inputs: ArrayLike) -> FeatureSet:
        """The terms of this model for the identification rows ``inputs`` (N x k, mm or rad).

        Inputs that do not move there get no terms. A Fourier series in millimetres
        needs a wavelength, of which the paper says nothing: twice the range of the input, so that both ends of the
        workspace need not have equal errors (`assumed`).

        Raises:
            ValueError: no N x k table of finite numbers.
        """
        table = checked_inputs(inputs)
        names = input_names(self.space, table.shape[1])
        spread = np.ptp(table, axis=0)
        moving = tuple(bool(width > STILL[self.space]) for width in spread)
        wavelengths = None
        if self.family == "fourier" and self.space == "cartesian":
            wavelengths = tuple(2 * float(width) if moves else 0.0 for width, moves in zip(spread, moving, strict=True))
        return FeatureSet(self, names, moving, wavelengths)


FDP_CI = ModelSpec("polynomial", 1, "cartesian")
FDP_AI = ModelSpec("polynomial", 1, "angular")
SDP_CI = ModelSpec("polynomial", 2, "cartesian")
SDP_AI = ModelSpec("polynomial", 2, "angular")
POLYNOMIAL_4_AI = ModelSpec("polynomial", 4, "angular")
FOURIER_2_AI = ModelSpec("fourier", 2, "angular")
PAPER_MODELS = (FDP_CI, FDP_AI, SDP_CI, SDP_AI, POLYNOMIAL_4_AI, FOURIER_2_AI)


@dataclass(frozen=True)
class FeatureSet:
    """The terms of one model for a given set of inputs."""

    spec: ModelSpec
    inputs: tuple[str, ...]  # the names of all k inputs: px, py, pz, or theta1 ... thetak
    moving: tuple[bool, ...]  # which of them move in the identification rows and so have terms
    # of the first harmonic per input, for a Fourier series in millimetres; else None
    wavelengths_mm: tuple[float, ...] | None = None

    @property
    def term_names(self) -> tuple[str, ...]:
        """One name per term: "const", then input by input, as Eqs. (12) and (18): "theta1", "theta1^2", ..."""
        return ("const", *(name for k in self._moving_indices() for name in self._names_of(k)))

    @property
    def coefficients_per_axis(self) -> int:
        """The number of terms."""
        return 1 + sum(self.moving) * self.spec.order * (2 if self.spec.family == "fourier" else 1)

    def matrix(self, inputs: ArrayLike) -> Array:
        """The terms' values, N x terms, at ``inputs`` (N x k). Raises ValueError: not the number of inputs that the
        model was made for, or numbers that are not finite."""
        table = checked_inputs(inputs)
        if table.shape[1] != len(self.inputs):
            raise ValueError(
                f"{table.shape[1]} inputs per row: this model takes {len(self.inputs)} ({', '.join(self.inputs)})"
            )
        columns = [np.ones(len(table))]
        for k in self._moving_indices():
            columns += self._columns_of(k, table[:, k])
        return np.stack(columns, axis=1)

    def slopes(self, inputs: ArrayLike) -> Array:
        """The terms' derivatives by the inputs, N x terms x k, per mm or rad, at ``inputs`` (N x k). Raises
        ValueError: as `matrix`."""
        table = checked_inputs(inputs)
        slopes = np.zeros((len(table), self.coefficients_per_axis, len(self.inputs)))
        term = 1
        for k in self._moving_indices():
            for column in self._slopes_of(k, table[:, k]):
                slopes[:, term, k] = column
                term += 1
        return slopes

    def to_dict(self) -> dict[str, Any]:
        """Plain values, for YAML or JSON."""
        return {"model": asdict(self.spec), **{name: value for name, value in vars(self).items() if name != "spec"}}

    @staticmethod
    def from_dict(content: dict[str, Any]) -> FeatureSet:
        """The inverse of `to_dict`."""
        spec, waves = ModelSpec(**content["model"]), content["wavelengths_mm"]
        return FeatureSet(spec, tuple(content["inputs"]), tuple(content["moving"]), waves and tuple(waves))

    def _moving_indices(self) -> list[int]:
        return [k for k, moves in enumerate(self.moving) if moves]

    def _columns_of(self, k: int, values: Array) -> list[Array]:
        orders = range(1, self.spec.order + 1)
        if self.spec.family == "polynomial":
            return [values**power for power in orders]
        angle = values if self.wavelengths_mm is None else values * (2 * np.pi / self.wavelengths_mm[k])
        return [wave(harmonic * angle) for harmonic in orders for wave in (np.cos, np.sin)]

    def _slopes_of(self, k: int, values: Array) -> list[Array]:
        orders = range(1, self.spec.order + 1)
        if self.spec.family == "polynomial":
            return [power * values ** (power - 1) for power in orders]
        unit = 1.0 if self.wavelengths_mm is None else 2 * np.pi / self.wavelengths_mm[k]
        angle = values * unit
        return [
            slope
            for harmonic in orders
            for slope in (-harmonic * unit * np.sin(harmonic * angle), harmonic * unit * np.cos(harmonic * angle))
        ]

    def _names_of(self, k: int) -> list[str]:
        name, orders = self.inputs[k], range(1, self.spec.order + 1)
        if self.spec.family == "polynomial":
            return [name if power == 1 else f"{name}^{power}" for power in orders]
        return [f"{wave}({self._argument(k, harmonic)})" for harmonic in orders for wave in ("cos", "sin")]

    def _argument(self, k: int, harmonic: int) -> str:
        if self.wavelengths_mm is not None:
            return f"2 pi {self.inputs[k]} / {self.wavelengths_mm[k] / harmonic:.6g} mm"
        return self.inputs[k] if harmonic == 1 else f"{harmonic} {self.inputs[k]}"


def input_names(space: str, count: int) -> tuple[str, ...]:
    """The names of ``count`` inputs: px, py, pz, or theta1, theta2, ... Raises ValueError: Cartesian input that is
    not three numbers per row."""
    if space == "cartesian":
        if count != 3:
            raise ValueError(f"{count} Cartesian inputs per row: must be 3 (px, py, pz)")
        return ("px", "py", "pz")
    return tuple(f"theta{joint + 1}" for joint in range(count))


def checked_inputs(inputs: ArrayLike) -> Array:
    """``inputs`` as an N x k table of finite numbers. Raises ValueError: it is none."""
    table = np.asarray(inputs, dtype=float)
    if table.ndim != 2 or table.shape[0] == 0 or table.shape[1] == 0:
        raise ValueError(f"inputs of shape {table.shape}: must be rows x inputs, at least one of each")
    if not np.isfinite(table).all():
        row, column = np.argwhere(~np.isfinite(table))[0]
        raise ValueError(f"input {table[row, column]!r} in row {row}, column {column}: all must be finite")
    return table


def fit_least_squares(features: FeatureSet, inputs: Array, errors_mm: Array) -> tuple[Array, Array]:
    """Raw coefficients (axes x terms) and RMS residual (axes, mm) of the least-squares fit.

    Args:
        features: the model's terms.
        inputs: N x k, mm or rad.
        errors_mm: N x axes.

    Returns:
        Coefficients, axes x terms, in the terms' own units, and RMS residuals (axes,), mm.
    """
    columns = features.matrix(inputs)
    basis = make_basis(BasisKind.STANDARDISED, columns, features.term_names)
    # columns of similar size keep the SVD's cut-off away from terms like px^4, of 1e12 mm^4
    independent = columns @ basis.to_raw
    coordinates: Array = np.linalg.lstsq(independent, errors_mm, rcond=None)[0].astype(float)
    residuals = errors_mm - independent @ coordinates
    return basis.raw_coefficients(coordinates.T), np.sqrt(np.mean(np.square(residuals), axis=0))
