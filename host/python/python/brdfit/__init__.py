"""Finds the parameters of a microfacet BRDF model from scatterometer scans.

The model is the modified Cook-Torrance model of Bishop, Butler and Marciniak (2021), their Eq. 14.
All angles are in degrees and the BRDF is in sr^-1, as in the files of the program `brdfit`, and results have the program's bits.

>>> result = brdfit.fit(45, theta_s, measured)
>>> curve = brdfit.brdf(45, theta_s, result.x)
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _brdfit
from .results import NAMES, Fit, Fits, Minimum

__all__ = ["NAMES", "Fit", "Fits", "Minimum", "brdf", "fit", "fit_many"]

Bounds = Mapping[str, float | tuple[float, float]]
Method = Literal["default", "paper"]


def fit(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    brdf: ArrayLike,
    *,
    delta_phi: ArrayLike | None = None,
    sigma: ArrayLike | None = None,
    terms: str | Iterable[str] = "all",
    bounds: Bounds | None = None,
    seed: int = 0,
    method: Method = "default",
    drop_invalid: bool = False,
) -> Fit:
    """Fits one scan: the global minimum of the squared error of ln BRDF.

    Parameters
    ----------
    theta_i : angles of incidence in degrees, 0 <= theta_i < 90; shape (samples,), or one number.
    theta_s : scattering angles in degrees, -90 < theta_s < 90, in plane positive forward; shape (samples,).
    brdf : measured BRDF in sr^-1, above 0; shape (samples,).
    delta_phi : azimuths of scattering less those of incidence in degrees, 180 is forward; shape (samples,), or one number; by default all is in plane.
    sigma : standard deviations of brdf in sr^-1, above 0, of which only the ratios count; shape (samples,), or one number; by default all samples have the same relative one.
    terms : "all", or some of "diffuse", "surface", "volume", "absorbing" (kappa is free).
    bounds : of parameters by name, `(least, largest)` or the number at which it is fixed, dimensionless; the others have those of the paper's Table 1.
    seed : of the search, 0 to 2^64 - 1; the same seed gives the same bits.
    method : "default", or "paper" for fits from 250 uniform starts, which list more minima.
    drop_invalid : leaves out samples whose angles or BRDF are not valid, such as NaN.

    Raises
    ------
    ValueError : a sample or an argument is not valid, or there are fewer samples than parameters.
    """
    arrays = _arrays(theta_i, theta_s, brdf, delta_phi, sigma)
    if arrays["brdf"].ndim != 1:
        raise ValueError(f"brdf has the shape {arrays['brdf'].shape}; fit takes one scan, fit_many several")
    return Fit._of(_brdfit.fit(_rows(arrays), _settings(terms, bounds, seed, method, drop_invalid)))


def fit_many(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    brdf: ArrayLike,
    *,
    delta_phi: ArrayLike | None = None,
    sigma: ArrayLike | None = None,
    terms: str | Iterable[str] = "all",
    bounds: Bounds | None = None,
    seed: int = 0,
    method: Method = "default",
    drop_invalid: bool = False,
    threads: int | None = None,
) -> Fits:
    """Fits many scans, on all cores and without the interpreter's lock; each as `fit` does it, to the bit.

    Parameters
    ----------
    theta_i, theta_s, delta_phi : angles in degrees, as for `fit`; any shape that broadcasts to that of `brdf`, such as (samples,).
    brdf : measured BRDF in sr^-1, above 0; shape (scans, samples), or (..., samples).
    sigma : standard deviations of brdf in sr^-1, as for `fit`; any shape that broadcasts to that of `brdf`.
    terms, bounds, seed, method : as for `fit`, the same for every scan.
    drop_invalid : leaves out samples that are not valid, such as NaN; a scan with too few others has NaN for a result and does not count as a success.
    threads : number of threads, which changes no bit; by default one for each core.

    Raises
    ------
    ValueError : a sample of any scan or an argument is not valid; scans count from 0, in C order.
    """
    arrays = _arrays(theta_i, theta_s, brdf, delta_phi, sigma)
    shape = arrays["brdf"].shape
    if len(shape) < 2:
        raise ValueError(f"brdf has the shape {shape}; fit_many takes (scans, samples), fit takes one scan")
    if threads is not None and operator.index(threads) < 1:
        raise ValueError(f"threads is {threads}; take a number from 1 on, or None for one for each core")
    found = _brdfit.fit_many(_rows(arrays), _settings(terms, bounds, seed, method, drop_invalid), threads or 0)
    return Fits._of(found, shape[:-1])


def brdf(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    parameters: ArrayLike | Mapping[str, float],
    *,
    delta_phi: ArrayLike | None = None,
    ln: bool = False,
) -> NDArray[np.float64]:
    """The BRDF of the model in sr^-1.

    Parameters
    ----------
    theta_i, theta_s, delta_phi : angles in degrees, as for `fit`; of shapes that broadcast together.
    parameters : dimensionless; by name, or an array of shape (..., 6) in the order of `NAMES`, whose leading shape broadcasts with that of the angles.
        By name, what is left out is absent: rho = 0, m = 1, n = 1, kappa = 0.
    ln : gives ln of the BRDF, which is right also where the BRDF itself is 0 because it underflows.

    Returns
    -------
    An array of the shape to which angles and parameters broadcast; NaN where a parameter is NaN.

    Raises
    ------
    ValueError : an angle is at or beyond the horizon, or a parameter is out of its domain.
    """
    if isinstance(parameters, Mapping):
        values = dict(zip(NAMES, (0.0, 0.0, 0.0, 1.0, 1.0, 0.0)))
        for name, value in parameters.items():
            if name not in values:
                raise ValueError(f"there is no parameter {name!r}; the parameters are {', '.join(NAMES)}")
            values[name] = value
        parameters = list(values.values())
    x = _array("parameters", parameters)
    if x.ndim == 0 or x.shape[-1] != len(NAMES):
        raise ValueError(f"parameters has the shape {x.shape}; its last axis takes the {len(NAMES)} of NAMES")
    angles = {
        "theta_i": _array("theta_i", theta_i),
        "theta_s": _array("theta_s", theta_s),
        "delta_phi": _azimuth(delta_phi),
    }
    shape = _broadcast([*angles, "parameters"], [*(angle.shape for angle in angles.values()), x.shape[:-1]])
    flat = {name: np.broadcast_to(angle, shape).reshape(-1) for name, angle in angles.items()}
    x = np.broadcast_to(x, (*shape, len(NAMES))).reshape(-1, len(NAMES))
    return _brdfit.brdf(**flat, x=x, ln=ln).reshape(shape)


def _array(name: str, value: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is not an array of numbers: {error}") from None


def _azimuth(delta_phi: ArrayLike | None) -> NDArray[np.float64]:
    return _array("delta_phi", 180.0 if delta_phi is None else delta_phi)


def _broadcast(names: Iterable[str], shapes: list[tuple[int, ...]]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        each = ", ".join(f"{name} {shape}" for name, shape in zip(names, shapes))
        raise ValueError(f"the shapes do not broadcast: {each}") from None


def _arrays(
    theta_i: ArrayLike, theta_s: ArrayLike, brdf: ArrayLike, delta_phi: ArrayLike | None, sigma: ArrayLike | None
) -> dict[str, NDArray[np.float64]]:
    measured = _array("brdf", brdf)
    arrays = {
        "theta_i": _array("theta_i", theta_i),
        "theta_s": _array("theta_s", theta_s),
        "delta_phi": _azimuth(delta_phi),
        "brdf": measured,
    }
    if sigma is not None:
        arrays["sigma"] = _array("sigma", sigma)
    shape = _broadcast(arrays, [array.shape for array in arrays.values()])
    if shape != measured.shape:
        raise ValueError(f"brdf has the shape {measured.shape}, the others ask for {shape}; give one BRDF a sample")
    return {name: np.broadcast_to(array, shape) for name, array in arrays.items()}


def _rows(arrays: dict[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64] | None]:
    samples = arrays["brdf"].shape[-1]
    return {"sigma": None} | {name: array.reshape(-1, samples) for name, array in arrays.items()}


def _settings(
    terms: str | Iterable[str], bounds: Bounds | None, seed: int, method: str, drop_invalid: bool
) -> dict[str, object]:
    if not 0 <= operator.index(seed) < 2**64:
        raise ValueError(f"seed is {seed}; take a whole number from 0 to 2^64 - 1")
    ranges = []
    for name, bound in (bounds or {}).items():
        limits = _array(f"bounds[{name!r}]", bound)
        if limits.shape not in ((), (2,)):
            raise ValueError(
                f"bounds[{name!r}] is {bound!r}; give (least, largest), or the number at which it is fixed"
            )
        lower, upper = np.broadcast_to(limits, 2).tolist()
        ranges.append((str(name), lower, upper))
    return {
        "terms": [terms] if isinstance(terms, str) else [str(term) for term in terms],
        "bounds": ranges,
        "seed": operator.index(seed),
        "method": str(method),
        "drop_invalid": bool(drop_invalid),
    }
