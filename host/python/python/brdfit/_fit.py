"""Scans, and their fits."""

from __future__ import annotations

import contextlib
import copyreg
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _brdfit, _options
from ._arrays import DEGREES, Angles, array, azimuth, broadcast, numbers, rows, together
from ._brdfit import Scan
from ._errors import Error
from ._needed import needed
from .results import Fit, Fits

if TYPE_CHECKING:
    from typing_extensions import Unpack


@contextlib.contextmanager
def told() -> Iterator[None]:
    """What the program says of its options is said in the words of Python."""
    try:
        yield
    except Error:
        raise
    except ValueError as error:
        raise ValueError(_options.in_python(str(error))) from None


def _again(file: str, table: str) -> Scan:
    return _brdfit.read_bytes(file, table.encode(), [])[0]


# A scan pickles as the program's own table: samples with their weights, and names.
copyreg.pickle(Scan, lambda scan: (_again, (scan.file, scan.table())))


def scan(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    brdf: ArrayLike,
    *,
    delta_phi: ArrayLike | None = None,
    sigma: ArrayLike | None = None,
    mask: ArrayLike | None = None,
    angles: Angles | None = None,
    drop_invalid: bool = False,
    name: str = "scan",
) -> Scan:
    """A scan from arrays.

    Parameters
    ----------
    theta_i : angles of incidence in degrees, 0 <= theta_i < 90; shape (samples,), or one number.
    theta_s : scattering angles in degrees, -90 < theta_s < 90, in plane positive forward; shape (samples,).
    brdf : measured BRDF in sr^-1, above 0; shape (samples,).
    delta_phi : azimuths of scattering less those of incidence in degrees, 180 is forward; shape (samples,), or one number; by default all is in plane.
    sigma : standard deviations of brdf in sr^-1, above 0, of which only the ratios count for the parameters; shape (samples,), or one number; by default all samples have the same relative one.
    mask : True where a sample is to be left out; shape (samples,). Masked arrays bring their own masks.
    angles : "deg" or "rad", for angles without a unit of their own; by default degrees, and refused where they may be radians.
    drop_invalid : leaves out samples that are not valid, such as NaN; `left_out` of the scan counts them.
    name : what messages and pages call it.

    Quantities of pint and astropy are taken in their units.

    Raises
    ------
    ValueError : a sample is not valid, or all are left out; one line that says which.
    """
    arrays, asked = together(theta_i, theta_s, brdf, delta_phi, sigma, mask, angles)
    shape = arrays["brdf"].shape
    if len(shape) != 1:
        raise ValueError(f"brdf has the shape {shape}; this takes one scan, fit_many several")
    with told():
        found = _brdfit.scan(rows(arrays, asked), _options.flag("drop_invalid", drop_invalid), str(name))
    if len(found) == 0:
        raise ValueError("all samples are left out")
    return found


def read(
    source: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | Any, **options: Unpack[_options.Reading]
) -> list[Scan]:
    """The scans in files, of every format that the program reads.

    Parameters
    ----------
    source : name of a file, or several; or a pandas.DataFrame with the columns of a table, such as theta_i_deg, theta_s_deg and brdf_per_sr.
    options : what the files hold and what is left out, as of `brdfit inspect --help`: column, quantity, angles, forward, mask_retro, max_angle, drop_invalid, ...

    Raises
    ------
    ValueError : a file is missing, not understood, or leaves a doubt about what was measured; one line with its place.
    """
    words = _options.reading(options, "read")
    with told():
        if hasattr(source, "to_csv"):
            return _brdfit.read_bytes("DataFrame", source.to_csv(index=False).encode(), words)
        if isinstance(source, (str, os.PathLike)):
            return _brdfit.read([source], words)
        return _brdfit.read(list(source), words)


def fit(
    theta_i: ArrayLike | Scan,
    theta_s: ArrayLike | None = None,
    brdf: ArrayLike | None = None,
    *,
    delta_phi: ArrayLike | None = None,
    sigma: ArrayLike | None = None,
    mask: ArrayLike | None = None,
    angles: Angles | None = None,
    drop_invalid: bool = False,
    certify: float | None = None,
    proof_boxes: int | None = None,
    proof_seconds: float | None = None,
    **search: Unpack[_options.Search],
) -> Fit:
    """Fits one scan: the global minimum of the squared error of ln BRDF.

    Parameters
    ----------
    theta_i, theta_s, brdf, delta_phi, sigma, mask, angles, drop_invalid : the samples, as for `scan`; or a `Scan` in place of all of them.
    certify : proves that no parameters within the bounds have an MSE^2 lower by more than this part, such as 0.05, or finds them; of the default model. `certificate` of the result says what is proved.
    proof_boxes, proof_seconds : what the proof may take at most.
    search : model, terms, bounds, robust, prior, fit_offset, aperture_half_angle, scale_uncertainty, conserve_energy, method, starts, seed, precision, threads: see `Search`.

    Raises
    ------
    ValueError : a sample or an argument is not valid, or there are fewer samples than parameters.
    """
    if isinstance(theta_i, Scan):
        if not all(given is None for given in (theta_s, brdf, delta_phi, sigma, mask, angles)) or drop_invalid:
            raise TypeError("fit() takes a Scan alone, or arrays")
        subject = theta_i
    elif theta_s is None or brdf is None:
        raise TypeError("fit() takes a Scan, or theta_i, theta_s and brdf")
    else:
        subject = scan(
            theta_i,
            theta_s,
            brdf,
            delta_phi=delta_phi,
            sigma=sigma,
            mask=mask,
            angles=angles,
            drop_invalid=drop_invalid,
        )
    words = _options.search(search, "fit")
    claim = proof(certify, proof_boxes, proof_seconds)
    with told():
        return Fit._of(_brdfit.fit(subject, words, claim), subject, search)


def proof(
    part: float | None, boxes: int | None, seconds: float | None
) -> tuple[float, int | None, float | None] | None:
    """What is to be proved, if anything, and what that may take."""
    limits = {"proof_boxes": boxes, "proof_seconds": seconds}
    if part is None:
        for name, limit in limits.items():
            if limit is not None:
                raise ValueError(f"{name} is what a proof may take; give certify too, such as certify=0.05")
        return None
    part = _options.between("certify", part, 1, "a part above 0 and below 1, such as 0.05")
    if boxes is not None:
        boxes = _options.whole("proof_boxes", boxes, 1, 2**64 - 1)
    if seconds is not None:
        seconds = _options.between("proof_seconds", seconds, np.inf, "a number above 0")
    return part, boxes, seconds


def fit_many(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    brdf: ArrayLike,
    *,
    delta_phi: ArrayLike | None = None,
    sigma: ArrayLike | None = None,
    mask: ArrayLike | None = None,
    angles: Angles | None = None,
    drop_invalid: bool = False,
    each: Iterable[_options.Search] | None = None,
    progress: bool = False,
    **search: Unpack[_options.Search],
) -> Fits:
    """Fits many scans, on all cores and without the interpreter's lock; each as `fit` does it, to the bit.

    Parameters
    ----------
    theta_i, theta_s, delta_phi : angles in degrees, as for `fit`; any shape that broadcasts to that of `brdf`, such as (samples,).
    brdf : measured BRDF in sr^-1, above 0; shape (scans, samples), or (..., samples). An xarray.DataArray gives the result its axes.
    angles : as for `scan`.
    sigma, mask : as for `fit`; any shape that broadcasts to that of `brdf`.
    drop_invalid : leaves out samples that are not valid, such as NaN; a scan with too few others has NaN for a result and does not count as a success.
    each : keywords of the search for each scan, in C order, which go before those for all.
    progress : shows how far it is, with tqdm; where that is not installed, a warning says so.
    search : as for `fit`, for all scans.

    Raises
    ------
    ValueError : a sample of any scan or an argument is not valid; scans count from 0, in C order.
    """
    arrays, asked = together(theta_i, theta_s, brdf, delta_phi, sigma, mask, angles)
    shape = arrays["brdf"].shape
    if len(shape) < 2:
        raise ValueError(f"brdf has the shape {shape}; fit_many takes (scans, samples), fit takes one scan")
    count = int(np.prod(shape[:-1]))
    words = [_options.search(search, "fit_many")]
    if each is not None:
        each = list(each)
        for place, one in enumerate(each):
            if not isinstance(one, Mapping):
                raise ValueError(f'each[{place}] is {one!r}; give keywords of the search, such as {{"seed": 1}}')
        words = [_options.search({**search, **one, "threads": search.get("threads")}, "fit_many") for one in each]
        if len(words) != count:
            raise ValueError(f"each has options for {len(words)} scans, and brdf has {count}")
        if len(words) == 0:
            words = [_options.search(search, "fit_many")]
    drop_invalid = _options.flag("drop_invalid", drop_invalid)
    with told(), _bar(count, _options.flag("progress", progress)) as advance:
        found = _brdfit.fit_many(rows(arrays, asked), words, drop_invalid, advance)
    return Fits._of(found, shape[:-1], *_axes(brdf, len(shape) - 1))


def _axes(brdf: Any, count: int) -> tuple[list[str], dict[str, Any]]:
    dims = getattr(brdf, "dims", None)
    if not isinstance(dims, tuple) or len(dims) != count + 1:
        return [f"scan_{k}" if count > 1 else "scan" for k in range(count)], {}
    names = [str(dim) for dim in dims[:count]]
    coords = getattr(brdf, "coords", {})
    return names, {name: np.asarray(coords[name]) for name in names if name in coords}


@contextlib.contextmanager
def _bar(count: int, wanted: bool) -> Iterator[Any]:
    if not wanted:
        yield None
        return
    try:
        tqdm = needed("tqdm.auto", "progress=True").tqdm
    except ModuleNotFoundError as missing:
        warnings.warn(f"{missing}; it goes on without", stacklevel=4)
        yield None
        return
    with tqdm(total=count, unit="scan") as bar:
        yield lambda done: bar.update(done - bar.n)


def brdf(
    theta_i: ArrayLike,
    theta_s: ArrayLike,
    parameters: ArrayLike | Mapping[str, float] | Fit | Fits,
    *,
    delta_phi: ArrayLike | None = None,
    model: str = "beckmann",
    ln: bool = False,
) -> NDArray[np.float64]:
    """The BRDF of a model in sr^-1.

    Parameters
    ----------
    theta_i, theta_s, delta_phi : angles in degrees, as for `fit`; of shapes that broadcast together.
    parameters : a `Fit`, whose BRDF is the material's: `Fit.curve` has it as the instrument sees it, with the offset and the aperture of the fit; or parameters by name; or an array of shape (..., parameters) in the order of `NAMES`, or of the model's, whose leading shape broadcasts with that of the angles; or `Fits` of one model, whose shape gets an axis for the angles.
        By name, what is left out is absent: weights and kappa are 0, all else is 1.
    model : a name of `MODELS`; a `Fit` brings its own.
    ln : gives ln of the BRDF, which is right also where the BRDF itself is 0 because it underflows.

    Returns
    -------
    An array of the shape to which angles and parameters broadcast; NaN where a parameter is NaN.

    Raises
    ------
    ValueError : an angle is at or beyond the horizon, or a parameter is out of its domain.
    """
    if isinstance(parameters, Fit):
        model, parameters = parameters.model, parameters.x
    elif isinstance(parameters, Fits):
        models = np.unique(parameters.model[parameters.model != ""])
        if len(models) > 1:
            raise ValueError(f"these are fits of the models {', '.join(models)}; take those of one")
        model, parameters = str(models[0]) if len(models) else model, parameters.x[..., np.newaxis, :]
    about = _brdfit.names(model)
    names = [name for name, *_ in about]
    if isinstance(parameters, Mapping):
        values = {name: absent for name, _, _, absent in about}
        for name, value in parameters.items():
            if name not in values:
                raise ValueError(f"there is no parameter {name!r}; the parameters are {', '.join(names)}")
            values[name] = float(numbers(name, value))
        parameters = list(values.values())
    x = numbers("parameters", parameters)
    if x.ndim == 0 or x.shape[-1] != len(names):
        order = "NAMES" if model == "beckmann" else ", ".join(names)
        raise ValueError(f"parameters has the shape {x.shape}; its last axis takes the {len(names)} of {order}")
    found = {
        "theta_i": array("theta_i", theta_i, DEGREES),
        "theta_s": array("theta_s", theta_s, DEGREES),
        "delta_phi": azimuth(delta_phi),
    }
    # What is masked is NaN in the result, whatever number lies under the mask.
    masks = [mask for _, mask in found.values() if mask is not None and mask.any()]
    angles = {name: values if mask is None else np.where(mask, 0.0, values) for name, (values, mask) in found.items()}
    shape = broadcast([*angles, "parameters"], [*(angle.shape for angle in angles.values()), x.shape[:-1]])
    flat = {name: np.broadcast_to(angle, shape).reshape(-1) for name, angle in angles.items()}
    x = np.broadcast_to(x, (*shape, len(names))).reshape(-1, len(names))
    values_of = _brdfit.brdf(model, list(flat.values()), x, ln, (0.0, 0.0)).reshape(shape)
    for mask in masks:
        values_of = np.where(np.broadcast_to(mask, shape), np.nan, values_of)
    return values_of
