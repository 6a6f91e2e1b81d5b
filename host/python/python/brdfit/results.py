"""What a fit found; plain data that pickles."""

from __future__ import annotations

import json as _json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _brdfit, _command, _draw
from ._arrays import DEGREES, broadcast, numbers
from ._needed import needed

if TYPE_CHECKING:
    import os

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    from ._brdfit import Scan

NAMES = ("rho_d", "rho_s", "rho_v", "m", "n", "kappa")
"""The parameters of the paper's model, all dimensionless, in the order of its `x`; those of absent terms are rho = 0, m = 1, n = 1, kappa = 0."""

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
    """Its parameters in the order of `names`; shape (parameters,)."""
    hits: int
    """How many fits ended here."""
    names: tuple[str, ...] = NAMES
    """The parameters of the model."""

    @property
    def parameters(self) -> dict[str, float]:
        """The same by name."""
        return dict(zip(self.names, self.x.tolist()))


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """The fit of one scan."""

    model: str
    """The model."""
    names: tuple[str, ...]
    """Its parameters, in the order of every `x` here."""
    x: NDArray[np.float64]
    """The best parameters, in their units (dimensionless in the paper's model); shape (parameters,)."""
    cov: NDArray[np.float64]
    """Their covariance by the scatter of the residuals, with those on a bound held there; 0 for what is held or absent, infinite where no sample depends on a parameter; shape (parameters, parameters)."""
    stderr: NDArray[np.float64]
    """Their standard errors, the roots of its diagonal; shape (parameters,)."""
    fun: float
    """What is minimised: the sum of squared residuals of ln BRDF, dimensionless."""
    mse2: float
    """The same over samples squared (Eq. 17), dimensionless."""
    samples: int
    """Number of samples that were fitted."""
    status: int
    """How the best fit ended, see `MESSAGES`."""
    residuals: NDArray[np.float64]
    """Model, as the instrument sees it, less measurement in ln BRDF, times the weight of the sample: what is squared in `fun`, with weights and ln BRDF as they were fitted, which standard deviations change; of every sample of the scan, outliers too; NaN beyond the horizon; shape (samples,)."""
    aperture_half_angle: float
    """Half-angle of the cone that the detector sees, degrees; 0 for a point."""
    offset: float
    """What the instrument reads for theta_s = 0, degrees, positive forward as the angles of the scan are; 0 if it was not fitted. The tables of a fit have it in the sign of the file (`offset_deg`)."""
    at_bound: tuple[str, ...]
    """Names of the parameters that ended on a bound."""
    minima: tuple[Minimum, ...]
    """The distinct minima that were met, best first."""
    outliers: tuple[int, ...]
    """Which samples of the scan a robust fit left out; from 0."""
    table: dict[str, Any]
    """The fit as a row of the program's tables: columns by the names of its CSV; None where there is no value."""
    json: str
    """All of the fit as `brdfit fit --format json` writes it."""
    scan: Scan
    """What was fitted."""
    options: dict[str, Any]
    """The keywords of the search."""

    @classmethod
    def _of(cls, found: dict[str, Any], scan: Scan, options: Mapping[str, Any]) -> Fit:
        names = tuple(found.pop("names"))
        minima = tuple(Minimum(mse2, x, hits, names) for mse2, x, hits in found.pop("minima"))
        found |= {name: tuple(found[name]) for name in ("at_bound", "outliers")}
        return cls(names=names, minima=minima, scan=scan, options=dict(options), **found)

    @property
    def parameters(self) -> dict[str, float]:
        """The best parameters by name."""
        return dict(zip(self.names, self.x.tolist()))

    @property
    def success(self) -> bool:
        """True if more passes would not lower `fun`."""
        return self.status < 2

    @property
    def message(self) -> str:
        """How the best fit ended, in words."""
        return MESSAGES[self.status]

    @property
    def details(self) -> dict[str, Any]:
        """All of the fit: the object that `brdfit fit --format json` writes."""
        details: dict[str, Any] = _json.loads(self.json)
        return details

    @property
    def derived(self) -> list[dict[str, Any]]:
        """What the fit determines at each angle of incidence, with errors: rho F of the lobes, the peak in sr^-1 and its width in degrees, the reflectance."""
        derived: list[dict[str, Any]] = self.details["derived"]
        return derived

    @property
    def undetermined(self) -> list[str]:
        """Which parameters the scan does not determine, and what it determines in their place; one sentence each."""
        return [one["sentence"] for one in self.details["uncertainty"]["undetermined"]]

    @property
    def certificate(self) -> dict[str, Any] | None:
        """What is proved of the optimum, if that was asked for and found: `eps`, `complete`, `boxes`, `better`; None else."""
        certificate: dict[str, Any] | None = self.details.get("certificate")
        return certificate

    @property
    def hints(self) -> list[str]:
        """What a person would say of the scan and its fit."""
        return [hint["text"] for hint in self.details.get("hints", [])]

    def curve(
        self,
        theta_s: ArrayLike | None = None,
        theta_i: ArrayLike | None = None,
        delta_phi: ArrayLike = 180.0,
    ) -> NDArray[np.float64]:
        """The fitted BRDF in sr^-1 at angles in degrees, as the instrument reads and sees it, with the offset and the aperture of the fit, which `brdfit.brdf` leaves out: by default at the angles of the scan; theta_i may be left out if the scan has only one. NaN where an offset leads beyond the horizon or out of the plane of incidence."""
        scan = self.scan
        if theta_s is None:
            return self._model(scan.theta_i, scan.theta_s, scan.delta_phi)
        if theta_i is None:
            angles = np.unique(scan.theta_i)
            if len(angles) > 1:
                raise ValueError(f"the scan has the angles of incidence {angles.tolist()}; give theta_i")
            theta_i = angles[0]
        return self._model(theta_i, theta_s, delta_phi)

    def _model(
        self, theta_i: ArrayLike, theta_s: ArrayLike, delta_phi: ArrayLike
    ) -> NDArray[np.float64]:
        given = {"theta_i": theta_i, "theta_s": theta_s, "delta_phi": delta_phi}
        angles = [numbers(name, angle, DEGREES) for name, angle in given.items()]
        shape = broadcast(given, [angle.shape for angle in angles])
        flat = [np.broadcast_to(angle, shape).reshape(-1) for angle in angles]
        x = np.broadcast_to(self.x, (flat[0].size, self.x.size))
        seen = (self.aperture_half_angle, self.offset)
        return _brdfit.brdf(self.model, flat, x, False, seen).reshape(shape)

    @overload
    def export(self, to: Literal["rgl"], path: str | os.PathLike[str] | None = None, **options: Any) -> bytes: ...
    @overload
    def export(self, to: str, path: str | os.PathLike[str] | None = None, **options: Any) -> str: ...
    def export(self, to: str, path: str | os.PathLike[str] | None = None, **options: Any) -> str | bytes:
        """The model for another program: what `brdfit export --to` writes, text or in the form `rgl` bytes, and into a file if `path` names one. Further keywords are its options, such as wavelength."""
        return _command.exported(self.json, to, path, **options)

    def svg(self, title: str = "") -> str:
        """The picture of the scan with its distinct minima that `brdfit fit --plot` draws."""
        minima = [minimum.x.tolist() for minimum in self.minima]
        return _brdfit.picture(self.scan, title, self.model, minima, list(self.outliers), self.offset)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws the scan and the best fit, log BRDF over the scattering angle, with Matplotlib."""
        return _draw.plot(self, ax)

    def to_pandas(self) -> pd.Series[Any]:
        """The row of the table as a pandas.Series."""
        row: pd.Series[Any] = needed("pandas", "to_pandas()").Series(self.table, dtype=object)
        return row

    def __repr__(self) -> str:
        model = "" if self.names == NAMES and self.model == "beckmann" else f" of {self.model}"
        lines = [f"brdfit.Fit{model}: {self.message}"]
        width = max(7, *(len(name) + 1 for name in self.names))
        for name, value, error in zip(self.names, self.x, self.stderr):
            lines.append(f"  {name:{width}}{value:14.6g}  {self._known(name, error)}")
        lines.append(f"  {'mse2':{width}}{self.mse2:14.6g}  of {self.samples} samples")
        lines.append(f"  {'minima':{width}}{len(self.minima):14}  distinct")
        return "\n".join(lines)

    def _known(self, name: str, error: float) -> str:
        if name in self.at_bound:
            return "on a bound"
        return "held" if error == 0 else "not determined" if np.isinf(error) else f"+- {error:.2g}"

    def _repr_html_(self) -> str:
        return _draw.html(self)


@dataclass(frozen=True, eq=False, repr=False)
class Fits:
    """The fits of many scans; `...` is the shape of the BRDF without its last axis, the samples."""

    names: tuple[str, ...]
    """The parameters of all models that were fitted, in the order of every `x`; NaN where the model of a scan has not one of them."""
    x: NDArray[np.float64]
    """The best parameters of each scan; shape (..., parameters)."""
    cov: NDArray[np.float64]
    """Their covariance, as of a `Fit`; shape (..., parameters, parameters)."""
    stderr: NDArray[np.float64]
    """Their standard errors; shape (..., parameters)."""
    fun: NDArray[np.float64]
    """What is minimised: the sum of squared residuals of ln BRDF, dimensionless; shape (...)."""
    mse2: NDArray[np.float64]
    """The same over samples squared (Eq. 17), dimensionless; shape (...)."""
    status: NDArray[np.uint8]
    """How the best fit of each scan ended, see `MESSAGES`; shape (...)."""
    minima: NDArray[np.uint8]
    """Number of distinct minima that were met; shape (...)."""
    model: NDArray[np.str_]
    """The model of each scan, empty without a fit; shape (...)."""
    terms: NDArray[np.str_]
    """The terms of each scan, with commas between; shape (...)."""
    table: dict[str, NDArray[Any]]
    """The fits as columns of numbers, by the names of the program's CSV; NaN where there is no value; each of shape (...)."""
    dims: tuple[str, ...]
    """Names of the axes of shape (...): those of the BRDF if that was an xarray.DataArray."""
    coords: dict[str, Any]
    """Coordinates along these axes, if it had some."""

    @classmethod
    def _of(cls, found: dict[str, Any], shape: tuple[int, ...], dims: Sequence[str], coords: dict[str, Any]) -> Fits:
        table = {name: column.reshape(shape) for name, column in found.pop("table").items()}
        names = tuple(found.pop("names"))
        found |= {name: np.array(found[name], dtype=np.str_) for name in ("model", "terms")}
        arrays: dict[str, Any] = {name: array.reshape(shape + array.shape[1:]) for name, array in found.items()}
        return cls(names=names, table=table, dims=tuple(dims), coords=coords, **arrays)

    @property
    def parameters(self) -> dict[str, NDArray[np.float64]]:
        """The best parameters by name; each of shape (...)."""
        return {name: self.x[..., k] for k, name in enumerate(self.names)}

    @property
    def success(self) -> NDArray[np.bool_]:
        """True where more passes would not lower `fun`; shape (...)."""
        return self.status < 2

    def _columns(self) -> dict[str, NDArray[Any]]:
        return {"model": self.model, "terms": self.terms, "status": self.status} | self.table

    def to_pandas(self) -> pd.DataFrame:
        """One row a scan, as a pandas.DataFrame: the table, and what was fitted; of several axes the index has a level each."""
        pandas = needed("pandas", "to_pandas()")
        levels = [self.coords.get(dim, range(length)) for dim, length in zip(self.dims, self.status.shape)]
        index = pandas.MultiIndex.from_product(levels, names=self.dims)
        if len(self.dims) == 1:
            index = index.get_level_values(0)
        columns = {name: column.reshape(-1) for name, column in self._columns().items()}
        frame: pd.DataFrame = pandas.DataFrame(columns, index=index)
        return frame

    def to_xarray(self) -> xr.Dataset:
        """The same as an xarray.Dataset with the axes and coordinates of the BRDF, and the covariance."""
        data: dict[str, Any] = {name: (self.dims, column) for name, column in self._columns().items()}
        data["cov"] = ((*self.dims, "parameter", "parameter_2"), self.cov)
        named = {"parameter": list(self.names), "parameter_2": list(self.names)}
        dataset: xr.Dataset = needed("xarray", "to_xarray()").Dataset(data, coords=self.coords | named)
        return dataset

    def __repr__(self) -> str:
        lines = [
            f"brdfit.Fits: {np.count_nonzero(self.success)} of {self.status.size} scans converged, shape {self.status.shape}"
        ]
        for status, message in enumerate(MESSAGES):
            count = np.count_nonzero(self.status == status)
            if count:
                lines.append(f"  {count:8}  {message}")
        width = max(7, *(len(name) + 1 for name in self.names))
        for name, values in self.parameters.items():
            if np.isfinite(values).any():
                low, median, high = np.nanquantile(values, [0, 0.5, 1])
                lines.append(f"  {name:{width}}{low:14.6g}  to {high:.6g}, median {median:.6g}")
        return "\n".join(lines)
