"""What a fit found; plain data that pickles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

NAMES = ("rho_d", "rho_s", "rho_v", "m", "n", "kappa")
"""The parameters, all dimensionless, in the order of every `x`; those of absent terms are rho = 0, m = 1, n = 1, kappa = 0."""

MESSAGES = (
    "converged: no step promises less",
    "converged as far as rounding allows",
    "NOT converged: all passes were used",
    "FAILED: the model is not finite at the start",
    "FAILED: fewer valid samples than parameters",
)
"""How a fit ended, by its `status`; 0 and 1 are success."""


@dataclass(frozen=True, eq=False)
class Minimum:
    """One distinct minimum."""

    mse2: float
    """Sum of squared residuals of ln BRDF over samples squared (Eq. 17), dimensionless."""
    x: NDArray[np.float64]
    """Its parameters in the order of `NAMES`; shape (6,)."""
    hits: int
    """How many fits ended here."""

    @property
    def parameters(self) -> dict[str, float]:
        """The same by name."""
        return dict(zip(NAMES, self.x.tolist()))


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """The fit of one scan."""

    x: NDArray[np.float64]
    """The best parameters, dimensionless, in the order of `NAMES`; shape (6,)."""
    cov: NDArray[np.float64]
    """Their covariance by the scatter of the residuals, dimensionless, with those on a bound held there; 0 for what is held or absent, infinite where no sample depends on a parameter; shape (6, 6)."""
    stderr: NDArray[np.float64]
    """Their standard errors, the roots of its diagonal; shape (6,)."""
    fun: float
    """What is minimised: the sum of squared residuals of ln BRDF, dimensionless."""
    mse2: float
    """The same over samples squared (Eq. 17), dimensionless."""
    samples: int
    """Number of samples that were fitted."""
    status: int
    """How the best fit ended, see `MESSAGES`."""
    at_bound: tuple[str, ...]
    """Names of the parameters that ended on a bound."""
    minima: tuple[Minimum, ...]
    """The distinct minima that were met, best first."""
    table: dict[str, Any]
    """The fit as a row of the program's tables: columns by the names of its CSV; None where there is no value."""

    @classmethod
    def _of(cls, found: dict[str, Any]) -> Fit:
        minima = tuple(Minimum(*minimum) for minimum in found.pop("minima"))
        return cls(minima=minima, at_bound=tuple(found.pop("at_bound")), **found)

    @property
    def parameters(self) -> dict[str, float]:
        """The best parameters by name."""
        return dict(zip(NAMES, self.x.tolist()))

    @property
    def success(self) -> bool:
        """True if more passes would not lower `fun`."""
        return self.status < 2

    @property
    def message(self) -> str:
        """How the best fit ended, in words."""
        return MESSAGES[self.status]

    def __repr__(self) -> str:
        lines = [f"brdfit.Fit: {self.message}"]
        for name, value, error in zip(NAMES, self.x, self.stderr):
            known = "on a bound" if name in self.at_bound else "held" if error == 0 else f"+- {error:.2g}"
            lines.append(f"  {name:7}{value:14.6g}  {known}")
        lines.append(f"  mse2   {self.mse2:14.6g}  of {self.samples} samples")
        lines.append(f"  minima {len(self.minima):14}  distinct")
        return "\n".join(lines)


@dataclass(frozen=True, eq=False, repr=False)
class Fits:
    """The fits of many scans; `...` is the shape of the BRDF without its last axis, the samples."""

    x: NDArray[np.float64]
    """The best parameters of each scan, dimensionless, in the order of `NAMES`; shape (..., 6)."""
    cov: NDArray[np.float64]
    """Their covariance, as of a `Fit`; shape (..., 6, 6)."""
    stderr: NDArray[np.float64]
    """Their standard errors; shape (..., 6)."""
    fun: NDArray[np.float64]
    """What is minimised: the sum of squared residuals of ln BRDF, dimensionless; shape (...)."""
    mse2: NDArray[np.float64]
    """The same over samples squared (Eq. 17), dimensionless; shape (...)."""
    status: NDArray[np.uint8]
    """How the best fit of each scan ended, see `MESSAGES`; shape (...)."""
    minima: NDArray[np.uint8]
    """Number of distinct minima that were met; shape (...)."""
    table: dict[str, NDArray[Any]]
    """The fits as columns of numbers, by the names of the program's CSV; NaN where there is no value; each of shape (...)."""

    @classmethod
    def _of(cls, found: dict[str, Any], shape: tuple[int, ...]) -> Fits:
        table = {name: column.reshape(shape) for name, column in found.pop("table").items()}
        arrays = {name: array.reshape(shape + array.shape[1:]) for name, array in found.items()}
        return cls(table=table, **arrays)

    @property
    def parameters(self) -> dict[str, NDArray[np.float64]]:
        """The best parameters by name; each of shape (...)."""
        return {name: self.x[..., k] for k, name in enumerate(NAMES)}

    @property
    def success(self) -> NDArray[np.bool_]:
        """True where more passes would not lower `fun`; shape (...)."""
        return self.status < 2

    def __repr__(self) -> str:
        lines = [
            f"brdfit.Fits: {np.count_nonzero(self.success)} of {self.status.size} scans converged, shape {self.status.shape}"
        ]
        for status, message in enumerate(MESSAGES):
            count = np.count_nonzero(self.status == status)
            if count:
                lines.append(f"  {count:8}  {message}")
        for name, values in self.parameters.items():
            if np.isfinite(values).any():
                low, median, high = np.nanquantile(values, [0, 0.5, 1])
                lines.append(f"  {name:7}{low:14.6g}  to {high:.6g}, median {median:.6g}")
        return "\n".join(lines)
